"""Reader of files that hold mooring lines alone: MoorDyn's text, and MoorPy's YAML."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from jaxhydro.errors import InputError, Problem, shown
from jaxhydro.input_schema import read_yaml, validate
from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.mooring_system import Attachment, MooringSystem
from jaxhydro.interop.openfast.key_items import key_items
from jaxhydro.interop.openfast.keyed_file import KeyedFile
from jaxhydro.interop.openfast.moordyn_file import read_mooring_system, stated_depth
from jaxhydro.interop.openfast.moordyn_tables import is_moordyn
from jaxhydro.interop.openfast.open_file import read_keyed_file
from jaxhydro.interop.openfast.table_row import to_number
from jaxhydro.interop.raft_mooring import MooringSection

EXPECTED = "a MoorDyn file, or a MoorPy system (.yaml)"
YAML_ENDINGS = (".yaml", ".yml")
DENSITY = 1025.0  # kg/m3, where a file states none
DENSITY_KEYS, GRAVITY_KEYS = ("WtrDnsty", "rho", "rhoW"), ("g", "gravity")


@dataclass(frozen=True)
class MooringFile:
    """Contents of a file of mooring lines.

    Attributes:
        path: The file.
        system: Points, line types and lines.
        density: Of the water (kg/m³); None: not stated.
        gravity: Acceleration (m/s²); None: not stated.
        depth_stated: Whether the file states the water depth; else it is that of the deepest fixed point.
        items: What became of parts that are not in `system`.
    """

    path: Path
    system: MooringSystem
    density: float | None
    gravity: float | None
    depth_stated: bool
    items: tuple[ConvertedItem, ...]


def is_mooring_yaml(data: Mapping[Any, Any]) -> bool:
    """Whether the contents of a YAML file are a MoorPy system, and not a design of RAFT."""
    return "line_types" in data and "platform" not in data and "platforms" not in data


def is_mooring_text(path: Path) -> bool:
    """Whether a text file is MoorDyn's, whatever its ending.

    Raises:
        InputError: It cannot be read as text.
    """
    return is_moordyn(read_keyed_file(path, "a text file"))


def read_mooring_file(path: Path) -> MooringFile:
    """Read a file of mooring lines.

    Args:
        path: A MoorDyn file, or a MoorPy system in YAML.

    Raises:
        InputError: It is missing, broken, or of another kind.
    """
    if path.is_dir():
        raise InputError(str(path), [Problem("", EXPECTED, "a folder", "Name the file in it.")])
    if path.suffix.lower() in YAML_ENDINGS:
        return _of_moorpy(path)
    file = read_keyed_file(path, EXPECTED)
    if not is_moordyn(file):
        raise InputError(str(path), [Problem("", f"{EXPECTED} with sections LINE TYPES, POINTS and LINES", first_line(file))])
    system, items = read_mooring_system(file)
    density, gravity = _positive(file, DENSITY_KEYS), _positive(file, GRAVITY_KEYS)
    stated = stated_depth(file) is not None
    if file.has("SeafloorFile"):
        text = "A sea bed that is not level has no counterpart: it is level at the water depth."
        items.append(ConvertedItem(f"{file.name}: SeafloorFile", Treatment.LEFT_OUT, text, warning=True))
    return MooringFile(path, system, density, gravity, stated, (*items, *key_items(file)))


def first_line(file: KeyedFile) -> str:
    """What a text file begins with, for a message."""
    first = next((line.strip() for line in file.lines if line.strip()), "")
    return f"a file that begins with {shown(first)}" if first else "an empty file"


def _positive(file: KeyedFile, keys: tuple[str, ...]) -> float | None:
    """Value of the first of some keys that a file has, or None."""
    key = next((key for key in keys if file.has(key)), None)
    if key is None:
        return None
    if not to_number(word := file.word(key)) > 0.0:
        raise file.wrong(file.line_of(key), "a number > 0", shown(word), key=key)
    return file.number(key)


def _of_moorpy(path: Path) -> MooringFile:
    data = read_yaml(path)
    if not is_mooring_yaml(data):
        hint = ""
        if "mooring" in data:
            hint = (
                "A RAFT design is a source of its own." if "platform" in data else "Paste its `mooring` into the platform file."
            )
        found = f"the keys {', '.join(map(str, data))}" if data else "an empty file"
        raise InputError(str(path), [Problem("", "a MoorPy system with points, lines and line_types", found, hint)])
    section = validate(MooringSection, data, str(path))
    ground = [-point.location[2] for point in section.points if point.type is Attachment.GROUND]
    if section.water_depth is None and max(ground, default=0.0) <= 0.0:
        raise InputError(str(path), [Problem("water_depth", "a depth, or a fixed point under water", "neither")])
    density = section.rho or section.water_density
    system = section.system(max(ground, default=0.0), density or DENSITY)
    return MooringFile(path, system, density, None, section.water_depth is not None, tuple(_other_keys(path, section)))


def _other_keys(path: Path, section: MooringSection) -> Iterator[ConvertedItem]:
    """Item of the keys of a MoorPy system that are not used."""
    rows = (*section.points, *section.lines, *section.line_types)
    unused = dict.fromkeys(key for part in (section, *rows) for key in part.model_extra or ())
    if unused:
        yield ConvertedItem(f"{path.name}: other keys", Treatment.LEFT_OUT, f"Not used: {', '.join(map(str, unused))}.")
