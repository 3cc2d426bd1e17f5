"""Nemoh.cal: the water, the motions and the wave's origin that Nemoh's results are for."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError, Problem, shown
from jaxhydro.interop.reference_point import rigid_shift

CASE_FILE = "Nemoh.cal"
TRANSLATION, ROTATION = 1, 2  # kinds of motions and of forces


class NemohCase(NamedTuple):
    """Water, wave origin and reference point of a body's results, as Nemoh.cal states them.

    Attributes:
        density: Of the water (kg/m³).
        gravity: Acceleration (m/s²).
        depth: Depth of the water (m), infinity where it is deep.
        wave_origin: Point (x, y; m) at which the incident wave has phase 0.
        shift: Velocities of the reference point to those of the point that motions and moments are about, (6, 6).
        notes: What was moved.
    """

    density: float
    gravity: float
    depth: float
    wave_origin: Float[np.ndarray, "2"]
    shift: Float[np.ndarray, "6 6"]
    notes: tuple[str, ...]


def case_of(results: Path, body: int) -> NemohCase:
    """Read the Nemoh.cal of a file of results: it lies beside the file or in the folder above.

    Args:
        results: The file of results.
        body: Number of the body, from 1.

    Raises:
        InputError: There is none, it cannot be read, or the body's motions are not surge ... yaw about one point.

    References:
        Nemoh v3.0.2, doc/input-output.rst, "Main input file Nemoh.cal".
    """
    folders = (results.parent, results.parent.parent)
    path = next((folder / CASE_FILE for folder in folders if (folder / CASE_FILE).is_file()), None)
    if path is None:
        expected = f"{CASE_FILE} beside it or in the folder above, which says what its motions are about"
        raise InputError(str(results), [Problem("", expected, "none")])
    return _case(path, body)


def _case(path: Path, body: int) -> NemohCase:
    rows = _Rows(path)
    (density,), (gravity,), (depth,), origin = rows.take(1), rows.take(1), rows.take(1), rows.take(2)
    if min(density, gravity) <= 0:
        raise InputError(str(path), [Problem("", "a density and a gravity above 0", f"{density:g} and {gravity:g}")])
    bodies = rows.count()
    if body > bodies:
        raise InputError(str(path), [Problem("body", f"body {body}", f"{bodies} bodies")])
    centre = np.zeros(3)
    for number in range(1, bodies + 1):
        rows.skip(2)  # mesh file, sizes of the mesh
        tables = [np.array([rows.take(7) for _ in range(rows.count())]).reshape(-1, 7) for _ in ("motions", "forces")]
        rows.skip(rows.count())
        if number == body:
            centre = _centre(path, tables)
    coordinates = ", ".join(f"{x:g}" for x in centre)
    moved = f"{path}: computed about ({coordinates}) m: moved to the platform's reference point"
    deep = depth if depth > 0 else np.inf
    return NemohCase(density, gravity, deep, origin, rigid_shift(centre), (moved,) if centre.any() else ())


def _centre(path: Path, tables: list[np.ndarray]) -> Float[np.ndarray, "3"]:
    """The point that rotations and moments of a body are about."""
    expected = np.column_stack([[TRANSLATION] * 3 + [ROTATION] * 3, np.tile(np.eye(3), (2, 1))])
    for name, table in zip(("degrees of freedom", "generalised forces"), tables):
        if table.shape != (6, 7) or not np.array_equal(table[:, :4], expected):
            raise InputError(str(path), [Problem(name, f"{', '.join(DOFS)} in this order", f"{len(table)}, or others")])
    points = np.vstack([table[3:, 4:] for table in tables])
    if np.ptp(points, axis=0).any():
        found = "; ".join(", ".join(f"{x:g}" for x in point) for point in np.unique(points, axis=0))
        raise InputError(str(path), [Problem("", "rotations and moments about one point", found)])
    return points[0]


class _Rows:
    """Lines of Nemoh.cal that are no headings, one after the other, by the numbers that they begin with."""

    def __init__(self, path: Path) -> None:
        self.path = path
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
        data_lines = [(i, line) for i, line in enumerate(lines, 1) if line.strip() and not line.lstrip().startswith("---")]
        self.lines: Iterator[tuple[int, str]] = iter(data_lines)

    def take(self, count: int) -> Float[np.ndarray, " n"]:
        """The first numbers of the next line."""
        number, line = self._next()
        words = line.partition("!")[0].split()[:count]
        try:
            values = np.array([float(word.upper().replace("D", "E")) for word in words])
        except ValueError:
            values = np.zeros(0)
        if len(values) < count or not np.isfinite(values).all():
            raise InputError(str(self.path), [Problem(f"line {number}", f"{count} numbers first", shown(line.strip()[:60]))])
        return values

    def count(self) -> int:
        """The next line's number of things."""
        (value,) = self.take(1)
        return max(0, int(value))

    def skip(self, lines: int) -> None:
        """Leave lines out."""
        for _ in range(lines):
            self._next()

    def _next(self) -> tuple[int, str]:
        row = next(self.lines, None)
        if row is None:
            raise InputError(str(self.path), [Problem("", "water, bodies and their motions", "the end of the file")])
        return row
