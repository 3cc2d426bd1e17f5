"""Platform as the source of another program's model, and the files of that model."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from jaxhydro.dynamics.model import Model
from jaxhydro.hull.member import Member
from jaxhydro.interop.conversion import ConvertedItem


@dataclass(frozen=True)
class PotentialTable:
    """A table of potential flow that the platform file names.

    Attributes:
        path: The file.
        kind: Its format, `wamit`, `capytaine` or `nemoh`.
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
    """A platform as another program's model is written from it.

    Attributes:
        name: Its name.
        model: Its model, with calibrated values.
        members: Its members, each copied to its headings.
        headings: Headings (deg) of the copies of each declared member, in the order of `members`.
        drag_laws: Drag laws other than plain drag, as in the platform file, by label such as `column.Cd_z`.
        line_diameters: Declared diameters of line types, m.
        seabed_depth: Of the seabed under the lines, m.
        tables: Tables of `radiation`, `excitation` and `drift`, by that key.
    """

    name: str
    model: Model
    members: Sequence[Member]
    headings: Sequence[tuple[float, ...]] = ()
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
class ExportedModel:
    """Files of another program's model.

    Attributes:
        texts: Text of each file by its name.
        items: What became of each item of the platform.
        files: Files to copy: name in the new folder -> file.
    """

    texts: Mapping[str, str]
    items: tuple[ConvertedItem, ...]
    files: Mapping[str, Path] = field(default_factory=dict)
