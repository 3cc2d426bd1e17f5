"""Stiffness and pull of catenary moorings at the reference position, for the platform file."""

from dataclasses import dataclass

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from jaxhydro.interop.catenary_line import CatenaryError, end_tension, lowest_point
from jaxhydro.interop.raft_mooring import MooringLine, MooringSystem, PointKind
from jaxhydro.rotations import rotation

STEP = (0.05, 0.05, 0.05, 5e-4, 5e-4, 5e-4)  # m and rad, of central differences
BED = 1e-3  # of the depth, within which an anchor lies on the sea bed


@dataclass(frozen=True)
class LinearMooring:
    """Moorings about the reference position: force and moment = preload - stiffness @ motion.

    Attributes:
        stiffness: N/m, N, N m/rad, (6, 6), in earth axes about the reference point.
        preload: N, N m, (6,).
        tensions: At the fairlead of each line, N.
    """

    stiffness: Float[np.ndarray, "6 6"]
    preload: Float[np.ndarray, "6"]
    tensions: tuple[float, ...]


def linearised(system: MooringSystem, density: float, gravity: float) -> LinearMooring:
    """Stiffness and preload of moorings, by central differences of the catenaries' pull.

    Args:
        system: Lines from fixed points to fairleads.
        density: Of the water, kg/m³, unless the system has one.
        gravity: m/s².

    Returns:
        The linear mooring.

    Raises:
        CatenaryError: A line is no catenary between a fixed point and a fairlead, or has no solution.
    """
    density = system.density or density
    preload = pull(system, np.zeros(6), density, gravity)
    stiffness = np.zeros((6, 6))
    for j, step in enumerate(STEP):
        moved = np.zeros(6)
        moved[j] = step
        ahead, behind = (pull(system, sign * moved, density, gravity) for sign in (1.0, -1.0))
        stiffness[:, j] = -(ahead - behind) / (2 * step)
    tensions = [float(np.linalg.norm(_line_force(system, line, np.zeros(6), density, gravity)[0])) for line in system.lines]
    return LinearMooring(stiffness, preload, tuple(tensions))


def pull(system: MooringSystem, motion: Float[np.ndarray, "6"], density: float, gravity: float) -> Float[np.ndarray, "6"]:
    """Force (N) on the platform and moment (N m) about its reference point, in earth axes, at a motion (m, rad)."""
    total = np.zeros(6)
    for line in system.lines:
        force, arm = _line_force(system, line, motion, density, gravity)
        total += np.concatenate([force, np.cross(arm, force)])
    return total


def _line_force(
    system: MooringSystem, line: MooringLine, motion: np.ndarray, density: float, gravity: float
) -> tuple[np.ndarray, np.ndarray]:
    """Force (N) of a line on the platform, and its fairlead from the displaced reference point (m)."""
    ends = {system.points[name].kind: system.points[name] for name in line.ends}
    if set(ends) != {PointKind.FIXED, PointKind.FAIRLEAD}:
        raise CatenaryError(f"line {line.name}, which does not run from a fixed point to a fairlead")
    arm = np.asarray(rotation(jnp.asarray(motion[3:]))) @ np.array(ends[PointKind.FAIRLEAD].position)
    fairlead, fixed = arm + motion[:3], np.array(ends[PointKind.FIXED].position)
    kind = system.line_types[line.line_type]
    weight = kind.weight_in_water(density, gravity)
    floats = weight < 0.0  # a buoyant line is the mirror image of a heavy one
    mirror = np.array([1.0, 1.0, -1.0 if floats else 1.0])
    top, bottom = (fairlead, fixed) if (fairlead - fixed)[2] * mirror[2] >= 0.0 else (fixed, fairlead)
    at_top = top is fairlead
    on_bed = at_top and not floats and abs(fixed[2] + system.depth) < BED * system.depth
    between = (top - bottom) * mirror
    horizontal, vertical = float(np.hypot(between[0], between[1])), float(between[2])
    try:
        across, pull_up = end_tension(horizontal, vertical, line.length, abs(weight), kind.axial_stiffness, on_bed)
    except CatenaryError as error:
        raise CatenaryError(f"line {line.name}, {error}") from None
    sag = 0.0 if on_bed else lowest_point(across, pull_up, line.length, abs(weight))
    if floats and bottom[2] + sag > 0.0:
        raise CatenaryError(f"line {line.name}, a buoyant one that comes to the surface between its ends")
    if not floats and bottom[2] - sag < -system.depth * (1 + BED):
        raise CatenaryError(f"line {line.name}, which hangs down to the sea bed between its ends")
    along = between[:2] / horizontal if horizontal > 0.0 else np.zeros(2)
    if at_top:  # the line pulls the fairlead towards the fixed point, and down
        return mirror * np.array([*(-across * along), -pull_up]), arm
    return mirror * np.array([*(across * along), pull_up - abs(weight) * line.length]), arm
