"""Entries of `rigid_body.parts`: points, and rows of points."""

from typing import Any

import numpy as np
from jaxtyping import Float

Matrix3 = Float[np.ndarray, "3 3"]


def point_mass(name: str, mass: float, centre: Float[np.ndarray, "3"], inertia: Matrix3 | None = None) -> dict[str, Any] | None:
    """A part with its centre of mass (m) and the inertia about it (kg m2); None without mass (kg)."""
    if mass <= 0.0:
        return None
    small = 1e-12 * float(np.abs(centre).max())
    position = [tidy(value) if abs(value) > small else 0.0 for value in centre]
    part: dict[str, Any] = {"name": name, "mass": tidy(mass), "centre_of_mass": position}
    if inertia is not None and np.any(inertia):
        part["inertia"] = inertia_entries(inertia)
    return part


def rod(name: str, masses: Float[np.ndarray, " n"], points: Float[np.ndarray, "n 3"]) -> dict[str, Any] | None:
    """Rigid part of point masses (kg) at points (m)."""
    mass = float(masses.sum())
    if mass <= 0.0:
        return None
    centre = masses @ points / mass
    return point_mass(name, mass, centre, spread_inertia(masses, points - centre))


def spread_inertia(masses: Float[np.ndarray, " n"], arms: Float[np.ndarray, "n 3"]) -> Matrix3:
    """Inertia (kg m2) of point masses (kg) about a point, by their distances from it (m)."""
    squares = np.einsum("n,ni,ni->", masses, arms, arms)
    return squares * np.eye(3) - np.einsum("n,ni,nj->ij", masses, arms, arms)


def inertia_entries(inertia: Matrix3) -> dict[str, float]:
    """Entries Ixx to Iyz of an inertia matrix; products that are no more than rounding are left out."""
    small = 1e-12 * float(np.abs(inertia).max())
    entries = {f"I{name}{name}": max(0.0, tidy(inertia[i, i])) for i, name in enumerate("xyz")}
    pairs = {"Ixy": (0, 1), "Ixz": (0, 2), "Iyz": (1, 2)}
    return entries | {key: tidy(inertia[index]) for key, index in pairs.items() if abs(inertia[index]) > small}


def tidy(value: float) -> float:
    """A number without what rounding adds beyond 12 digits."""
    return float(f"{value:.12g}") + 0.0
