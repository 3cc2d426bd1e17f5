"""Hydrostatics from Nemoh's KH.dat, and Hydrostatics.dat beside it.

References:
    Nemoh v2.03, Mesh/mesh.f90 and Mesh/hydre.f90 (VOLELMT).
"""

import re
from os import PathLike
from pathlib import Path

import numpy as np
from jaxtyping import Float

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.reference_point import rigid_shift
from jaxhydro.interop.wamit_hydrostatics import NUMBER, FileHydrostatics

MAX_WEIGHT_MISMATCH = 1e-3  # of density times gravity, without a note


def read_nemoh_hydrostatics(
    path: str | PathLike[str], *, density: float, gravity: float, notes: list[str] | None = None
) -> FileHydrostatics:
    """Read KH.dat or KH_0.dat (N/m, N, N m/rad), with Hydrostatics.dat beside it.

    Beside KH_0.dat that is Hydrostatics_0.dat. KH includes the weight of the displaced water at (XG, YG, ZG). Its rotations are
    about the vertical axis through that point. Its water is told by KH(3,3) over the waterplane area: there are versions of
    Nemoh that take 1025 kg/m³ and 9.81 m/s² whatever Nemoh.cal says. From there the stiffness is scaled to the platform's
    density and gravity.

    Args:
        path: The file KH.dat.
        density: Of the platform's water (kg/m³).
        gravity: Of the platform (m/s²).
        notes: What is scaled or moved is appended here.

    Raises:
        InputError: With the file and what is wrong.
    """
    path = Path(path)
    stiffness = _matrix(path)
    beside = path.with_name(path.name.replace("KH", "Hydrostatics").replace("Kh", "Hydrostatics"))
    if beside == path or not beside.is_file():
        expected = "Hydrostatics.dat beside it, which has the centre of mass, the volume and the waterplane area"
        raise InputError(str(path), [Problem("", expected, "none")])
    text = beside.read_text(encoding="utf-8", errors="replace")
    x, y, z = (_value(beside, text, f"{axis}G") for axis in "XYZ")
    volume, area = _value(beside, text, "Displacement"), _value(beside, text, "Waterplane area")
    if volume <= 0:
        raise InputError(str(beside), [Problem("Displacement", "a volume above 0", f"{volume:g}")])
    specific_weight = stiffness[2, 2] / area if area > 0 else density * gravity
    remarks = []
    if abs(density * gravity / specific_weight - 1) > MAX_WEIGHT_MISMATCH:
        remarks.append(f"{path}: of water of {specific_weight:.5g} N/m3: scaled to {density * gravity:.5g} N/m3")
    if x or y:
        remarks.append(f"{path}: computed about ({x:g}, {y:g}) m: moved to the platform's reference point")
    shift = rigid_shift(np.array([x, y, 0.0]))
    if notes is not None:
        notes += remarks
    return FileHydrostatics(density * gravity / specific_weight * shift.T @ stiffness @ shift, volume, z)


def _matrix(path: Path) -> Float[np.ndarray, "6 6"]:
    try:
        words = path.read_text(encoding="utf-8", errors="replace").upper().replace("D", "E").split()
    except (OSError, ValueError) as error:
        found = "no such file" if isinstance(error, FileNotFoundError) else str(getattr(error, "strerror", None) or error)
        raise InputError(str(path), [Problem("", "Nemoh's KH.dat", found)]) from None
    try:
        values = np.array([float(word) for word in words])
    except ValueError as error:
        raise InputError(str(path), [Problem("", "36 numbers", str(error))]) from None
    if values.shape != (36,) or not np.isfinite(values).all():
        raise InputError(str(path), [Problem("", "36 finite numbers, six rows of six", f"{values.size} numbers")])
    return values.reshape(6, 6)


def _value(path: Path, text: str, name: str) -> float:
    """The number after a name and an equals sign."""
    match = re.search(rf"\b{name}\s*=\s*({NUMBER})", text)
    if match is None:
        raise InputError(str(path), [Problem(name, f"{name} = a number", "none")])
    return float(match[1].upper().replace("D", "E"))
