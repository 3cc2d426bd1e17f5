"""Water of another program's results: phases of its waves, and differences from the platform's water."""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Complex, Float

from jaxhydro.waves.dispersion import wavenumber

MAX_DENSITY_MISMATCH = 1e-3  # of the density, without a note
MAX_GRAVITY_MISMATCH = 0.005  # of the gravity, without a note
MAX_DEPTH_MISMATCH = 0.02  # of the depth, without a note
INFINITE_DEPTH = 1e5  # m, in place of an infinite depth
DEEP_WATER_KH = np.pi  # k h from which on the bed does not matter


def wave_phase(
    omega: Float[np.ndarray, " w"], point: Float[np.ndarray, "2"], heading: float, depth: float, gravity: float
) -> Complex[np.ndarray, " w"]:
    """exp(-i k r): waves Re A exp(i (omega t - k x)) at a point r over those at the origin.

    Args:
        omega: Frequencies (rad/s).
        point: The point (m).
        heading: Where the waves run to (deg).
        depth: Depth of the water (m), infinite where it is deep.
        gravity: Acceleration (m/s²).
    """
    if not point.any():
        return np.ones(len(omega), complex)
    k = np.asarray(wavenumber(jnp.asarray(omega), min(depth, INFINITE_DEPTH), gravity))
    return np.exp(-1j * k * (point @ [np.cos(np.radians(heading)), np.sin(np.radians(heading))]))


def density_scale(source: str, file_density: float | None, density: float | None, notes: list[str]) -> float:
    """Factor from forces in a file's water to forces in the platform's water.

    A note is appended where it is not 1.

    Args:
        source: The file.
        file_density: Density of its water (kg/m³); None where it does not say.
        density: Of the platform's water (kg/m³); None where it is not asked for.
        notes: Notes.
    """
    if density is None or file_density is None or abs(density / file_density - 1) < MAX_DENSITY_MISMATCH:
        return 1.0
    notes.append(f"{source}: computed for a density of {file_density:g} kg/m3: forces are scaled to {density:g} kg/m3")
    return density / file_density


def water_notes(
    source: str, file_water: tuple[float | None, float | None], gravity: float | None, depth: float | None, lowest: float
) -> list[str]:
    """Notes where gravity and depth are not the platform's, and matter.

    Args:
        source: The file.
        file_water: Its gravity (m/s²) and depth (m); None where it does not say.
        gravity: Of the platform (m/s²).
        depth: Of the platform's water (m).
        lowest: Lowest frequency of the file (rad/s).
    """
    file_gravity, file_depth = file_water
    notes = []
    if gravity is not None and file_gravity is not None and abs(file_gravity / gravity - 1) > MAX_GRAVITY_MISMATCH:
        notes.append(f"{source}: computed for a gravity of {file_gravity:g} m/s2, the platform has {gravity:g} m/s2")
    if depth is None or file_depth is None:
        return notes
    shallow = lowest**2 / (file_gravity or 9.81) * min(file_depth, depth) < DEEP_WATER_KH
    if abs(min(file_depth, 1e9) / depth - 1) > MAX_DEPTH_MISMATCH and shallow:
        depths = f"computed for a depth of {file_depth:g} m, the platform has {depth:g} m"
        notes.append(f"{source}: {depths}, and its longest waves feel the bed")
    return notes
