"""YAML text of plain values: short mappings, and lists without further ones, stand in one line."""

from io import StringIO
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap, CommentedSeq
from ruamel.yaml.nodes import ScalarNode
from ruamel.yaml.representer import RoundTripRepresenter

WIDTH = 160  # characters of a line


class _Representer(RoundTripRepresenter):
    """Writes 1e-05 as 1.0e-05: PyYAML takes a number without a point for a word."""


def _represent_float(representer: RoundTripRepresenter, value: float) -> ScalarNode:
    node: ScalarNode = RoundTripRepresenter.represent_float(representer, value)
    if "e" in node.value and "." not in node.value:
        node.value = node.value.replace("e", ".0e")
    return node


_Representer.add_representer(float, _represent_float)


def yaml_text(value: Any) -> str:
    """YAML text of mappings, lists, numbers and words.

    Args:
        value: The outermost mapping.

    Returns:
        Text that YAML 1.1 (PyYAML) and 1.2 (ruamel.yaml) read alike.
    """
    yaml, out = YAML(), StringIO()
    yaml.Representer = _Representer
    yaml.width = WIDTH
    yaml.dump(_laid_out(value), out)
    return out.getvalue()


def _laid_out(value: Any) -> Any:
    if isinstance(value, dict):
        mapping = CommentedMap({key: _laid_out(item) for key, item in value.items()})
        flat = not any(isinstance(item, dict) or _nested(item) for item in value.values())
        if flat and len(str(value)) <= WIDTH:
            mapping.fa.set_flow_style()
        return mapping
    if isinstance(value, list | tuple):
        row = CommentedSeq([_laid_out(item) for item in value])
        if not _nested(value):
            row.fa.set_flow_style()
        return row
    return value


def _nested(value: Any) -> bool:
    return isinstance(value, list | tuple) and any(isinstance(item, dict | list | tuple) for item in value)
