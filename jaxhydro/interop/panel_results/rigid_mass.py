"""Mass, centre and inertia from a mass matrix, or estimates where results do not have them."""

import math

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from jaxhydro.interop.computed_water import INFINITE_DEPTH
from jaxhydro.interop.panel_results.panel_case import PanelCase
from jaxhydro.waves.dispersion import wavenumber

Matrix6 = Float[np.ndarray, "6 6"]
MAX_RATIO = 10.0  # of displaced and added mass in surge, either way, of an estimate that is taken
MAX_ASYMMETRY = 0.01  # of the geometric mean of two motions' own, by which mirrored entries may differ


def centre_of(matrix: Matrix6) -> Float[np.ndarray, "3"]:
    """Centre of mass (m) of a mass matrix about the reference point."""
    mass = matrix[0, 0]
    return np.array([matrix[1, 5] - matrix[2, 4], matrix[2, 3] - matrix[0, 5], matrix[0, 4] - matrix[1, 3]]) / (2 * mass)


def inertia_of(matrix: Matrix6) -> Float[np.ndarray, "3 3"]:
    """Inertia (kg m²) about the centre of mass of a mass matrix about the reference point."""
    c, about = centre_of(matrix), 0.5 * (matrix[3:, 3:] + matrix[3:, 3:].T)
    return about - matrix[0, 0] * ((c @ c) * np.eye(3) - np.outer(c, c))


def is_rigid(matrix: Matrix6) -> bool:
    """Whether a matrix is that of a rigid body: one mass, symmetric, with an inertia that a body can have."""
    if not np.isfinite(matrix).all() or (np.diag(matrix) <= 0).any():
        return False
    size = np.sqrt(np.diag(matrix))
    if (np.abs(matrix - matrix.T) > MAX_ASYMMETRY * np.outer(size, size)).any():
        return False
    if np.ptp(np.diag(matrix)[:3]) > MAX_ASYMMETRY * matrix[0, 0]:
        return False
    principal = np.linalg.eigvalsh(inertia_of(matrix))
    return bool(principal[0] > 0 and principal[2] <= (1 + MAX_ASYMMETRY) * (principal[0] + principal[1]))


def long_wave_mass(case: PanelCase) -> float | None:
    """Displaced mass (kg) by the longest wave's horizontal force, less added mass; None where results do not tell it.

    A long wave pushes by the displaced mass and the added mass, times the water's acceleration g k A. So the depth has to be
    known, and the mass is not to be far from the added mass.

    References:
        Newman (1977), Marine Hydrodynamics, section 6.17.
    """
    if case.force is None or case.coefficients is None or case.depth is None:
        return None
    _, gravity = case.water()
    omega, force = float(case.force.omega[0]), np.asarray(case.force.force)[:, 0]
    k = float(wavenumber(jnp.asarray(omega), min(case.depth or math.inf, INFINITE_DEPTH), gravity))
    push = np.abs(force[:2])
    added = float(np.diag(case.coefficients.added_mass[0])[int(np.argmax(push))])
    mass = math.hypot(*push) / (gravity * k) - added
    return mass if math.isfinite(mass) and added / MAX_RATIO < mass < MAX_RATIO * added else None
