"""What a deck is written from, and what is written."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined

from jaxhydro.dynamics.model import Model
from jaxhydro.hull.strips import Member
from jaxhydro.interop.conversion import ConvertedItem
from jaxhydro.interop.openfast.mass_parts import tidy

TEMPLATES = Environment(
    loader=PackageLoader("jaxhydro.interop.openfast"),
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
    keep_trailing_newline=True,
    autoescape=False,
)


@dataclass(frozen=True)
class PotentialTable:
    """A table of potential flow that the platform file names.

    Attributes:
        path: The file.
        kind: Its format, `wamit` or `capytaine`.
        by: What its first column is; `period` is that of OpenFAST.
        length: ULEN, m.
        body: Number or name of one of several bodies, or None.
        approximation: Of drift: `full` or `newman`.
    """

    path: Path
    kind: str
    by: str = "period"
    length: float = 1.0
    body: int | str | None = None
    approximation: str = "full"


@dataclass(frozen=True)
class ExportSource:
    """A platform as a deck is written from it.

    Attributes:
        name: Its name.
        model: Its model, with calibrated values.
        members: Its members, each copied to its headings.
        drag_laws: Drag laws other than plain drag, as in the platform file, by label such as `column.Cd_z`.
        line_diameters: Declared diameters of line types, m.
        seabed_depth: Of the seabed under the lines, m.
        tables: Tables of `radiation`, `excitation` and `drift`, by that key.
    """

    name: str
    model: Model
    members: Sequence[Member]
    drag_laws: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    line_diameters: Mapping[str, float] = field(default_factory=dict)
    seabed_depth: float = 0.0
    tables: Mapping[str, PotentialTable] = field(default_factory=dict)

    def coefficient(self, member: Member, name: str) -> float:
        """Value of a member's coefficient such as Cd_t; 0 where the model has none."""
        return float(self.model.values.get(self.label(member, name), 0.0))

    @staticmethod
    def label(member: Member, name: str) -> str:
        """Label of a member's coefficient: that of the group that owns it."""
        return f"{member.shared.get(name, member.group)}.{name}"


@dataclass(frozen=True)
class ExportedDeck:
    """Files of a deck.

    Attributes:
        texts: Text of each file by its name.
        items: What became of each item of the platform.
        files: Files to copy: name in the deck -> file.
    """

    texts: Mapping[str, str]
    items: tuple[ConvertedItem, ...]
    files: Mapping[str, Path]


def filled(template: str, **values: Any) -> str:
    """Text of a template of this package."""
    return TEMPLATES.get_template(f"{template}.j2").render(**values)


def digits(value: Any) -> str:
    """A number with 12 digits, as Fortran reads it."""
    return repr(tidy(float(value)))


def row(*values: Any) -> str:
    """Numbers and words of a row of a table; whole numbers stay whole."""
    return " ".join(digits(value) if isinstance(value, float | np.floating) else str(value) for value in values)
