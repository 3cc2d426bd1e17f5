"""Hydrostatics from WAMIT: stiffness of a .hst file, stiffness and volume of an .out file."""

import re
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxhydro.errors import InputError, Problem, shown

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][-+]?\d+)?"
VOLUMES = "Volumes (VOLX,VOLY,VOLZ)"
OUT_ROWS = {"C(3,3),C(3,4),C(3,5)": (2, (2, 3, 4)), "C(4,4),C(4,5),C(4,6)": (3, (3, 4, 5)), "C(5,5),C(5,6)": (4, (4, 5))}
MIRRORED = ((2, 3), (2, 4), (3, 4))  # entries that are the same on both sides of the diagonal
SYMMETRIC = 0.01  # of the geometric mean of two motions' own stiffness, by which mirrored entries may differ


class FileHydrostatics(NamedTuple):
    """Hydrostatics of a file; None for what it does not have.

    Attributes:
        stiffness: Hydrostatic stiffness (N/m, N, N m/rad), (6, 6).
        volume: Displaced volume (m³).
        centre_of_mass: Height (m) of the centre of mass whose weight the stiffness includes.
    """

    stiffness: Float[np.ndarray, "6 6"]
    volume: float | None = None
    centre_of_mass: float | None = None


def read_hydrostatics(
    path: str | PathLike[str], density: float, gravity: float, *, length: float = 1.0, body: int | None = None
) -> FileHydrostatics:
    """Read a WAMIT .hst file, rows I J C(I,J), or an .out file, by what it has in it.

    C_ij = rho g L^k C(I,J). k is 2 for heave alone, 3 for heave with roll or pitch, 4 between rotations. Volumes are in m3
    where the geometry file is in m.

    Args:
        path: The file.
        density: Of the water, rho, kg/m3.
        gravity: g, m/s2.
        length: The file's unit of length L, WAMIT's ULEN, m.
        body: Number of the body, from 1; None: the file has one.

    Raises:
        InputError: With the line that is wrong.

    References:
        WAMIT user manual, section 3.1.
    """
    try:
        text = Path(path).read_text(encoding="utf-8", errors="replace")
    except OSError as error:
        found = "no such file" if isinstance(error, FileNotFoundError) else str(error.strerror)
        raise InputError(str(path), [Problem("", "a WAMIT .hst or .out file", found)]) from None
    out = VOLUMES in text or Path(path).suffix.lower() == ".out"
    read = _out(str(path), text, body) if out else FileHydrostatics(_hst(str(path), text, body))
    power = np.array([[2 + (i > 2) + (j > 2) for j in range(6)] for i in range(6)])
    stiffness = read.stiffness * density * gravity * float(length) ** power
    scale = np.sqrt(np.abs(np.diag(stiffness)))
    for i, j in MIRRORED:
        if abs(stiffness[i, j] - stiffness[j, i]) > SYMMETRIC * scale[i] * scale[j]:
            entry, mirrored = f"C{i + 1}{j + 1}", f"C{j + 1}{i + 1}"
            values = f"{read.stiffness[i, j]:g} and {read.stiffness[j, i]:g}"
            raise InputError(str(path), [Problem(entry, f"the same number as {mirrored}", values)])
    return read._replace(stiffness=stiffness)


def _hst(source: str, text: str, body: int | None) -> Float[np.ndarray, "6 6"]:
    matrix = np.zeros((6, 6))
    pairs: set[tuple[int, int]] = set()
    before = 6 * ((body or 1) - 1)
    for number, line in enumerate(text.splitlines(), 1):
        words = line.replace("D", "E").replace("d", "e").split()
        if not words or (number == 1 and re.fullmatch(NUMBER, words[0]) is None):
            continue
        where, expected = f"line {number}", "3 numbers I J C(I,J)"
        if len(words) != 3 or not all(re.fullmatch(NUMBER, word) for word in words):
            raise InputError(source, [Problem(where, expected, shown(line.strip()))])
        if not (words[0].isdigit() and words[1].isdigit() and int(words[0]) > 0 and int(words[1]) > 0):
            raise InputError(source, [Problem(where, "motions I and J from 1", " ".join(words[:2]))])
        i, j = int(words[0]), int(words[1])
        if (i, j) in pairs:
            raise InputError(source, [Problem(where, "each pair once", f"{i} {j} again")])
        pairs.add((i, j))
        if body is None and max(i, j) > 6:
            count = -(-max(i, j) // 6)
            hint = f"A file of {count} or more bodies: say which, as `body: 1`."
            raise InputError(source, [Problem(where, "motions I and J of one body, 1 to 6", f"{i} {j}", hint)])
        if before < i <= before + 6 and before < j <= before + 6:
            matrix[i - 1 - before, j - 1 - before] = float(words[2])
            if (j, i) not in pairs and (i - 1 - before, j - 1 - before) in MIRRORED:
                matrix[j - 1 - before, i - 1 - before] = float(words[2])
    if not pairs:
        raise InputError(source, [Problem("", "rows of 3 numbers I J C(I,J)", "none")])
    if not matrix.any():
        raise InputError(source, [Problem("body" if body else "", "a hydrostatic stiffness that is not 0", "none")])
    return matrix


def _out(source: str, text: str, body: int | None) -> FileHydrostatics:
    """Hydrostatics that WAMIT prints, of the only body or of the one with a number."""
    parts = text.split(VOLUMES)[1:]
    if not parts:
        raise InputError(source, [Problem("", f"WAMIT's hydrostatics, {VOLUMES}", "none")])
    if body is None and len(parts) > 1:
        hint = f"A file of {len(parts)} bodies: say which, `body: 1` to `body: {len(parts)}`."
        raise InputError(source, [Problem("", "the hydrostatics of one body", f"{len(parts)}", hint)])
    if (body or 1) > len(parts):
        raise InputError(source, [Problem("body", f"the hydrostatics of body {body}", f"{len(parts)} bodies")])
    part = parts[(body or 1) - 1]

    def numbers(name: str, rest: str, count: int) -> list[float]:
        match = re.match(r"[^:]*:((?:\s+" + NUMBER + r"){" + str(count) + r"})", rest)
        if match is None:
            line = rest.partition("\n")[0].strip()
            raise InputError(source, [Problem(name, f"{count} numbers", shown(line[:60]))])
        return [float(word.replace("D", "E").replace("d", "e")) for word in match.group(1).split()]

    volume = float(np.median(numbers(VOLUMES, part, 3)))
    matrix = np.zeros((6, 6))
    for name, (row, columns) in OUT_ROWS.items():
        _, separator, rest = part.partition(name)
        if not separator:
            raise InputError(source, [Problem(name, "the hydrostatic coefficients", "none")])
        for column, value in zip(columns, numbers(name, rest, len(columns)), strict=True):
            matrix[row, column] = value
    for i, j in MIRRORED:
        matrix[j, i] = matrix[i, j]
    _, separator, rest = part.partition("Center of Gravity")
    centre = numbers("Center of Gravity", rest, 3)[2] if separator else None
    return FileHydrostatics(matrix, volume, centre)
