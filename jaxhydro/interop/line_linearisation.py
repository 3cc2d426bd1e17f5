"""Linear stiffness and pull of elastic catenaries that may lie on the sea bed.

x = H/w (asinh(V/H) - asinh((V - w L)/H)) + H L/EA, z = H/w (sqrt(1 + (V/H)^2) - sqrt(1 + ((V - w L)/H)^2)) + (V L - w L^2/2)/EA
for a line that is off the bed; x = L - V/w + H/w asinh(V/H) + H L/EA, z = H/w (sqrt(1 + (V/H)^2) - 1) + V^2/(2 EA w) for one
that lies on it in part, without friction. H and V are the pull at the upper end, w the weight in water per length.

References:
    Jonkman 2007, Dynamics Modeling and Loads Analysis of an Offshore Floating Wind Turbine, NREL/TP-500-41958, equations
    2-35 to 2-38.
"""

import math
from collections.abc import Iterator

import numpy as np
from jaxtyping import Float
from scipy.optimize import root

from jaxhydro.interop.moordyn_system import Attachment, MooringLine, MooringSystem

_BED = 1e-3  # m above the bed, up to which an anchor lies on it
_STEPS = (1e-2, 1e-2, 1e-2, 1e-4, 1e-4, 1e-4)  # m and rad of the differences
_TOLERANCE = 1e-9  # of a line's length


class NoCatenary(Exception):
    """A mooring that is no set of single lines from the ground to the platform, or a line without an equilibrium."""


def catenary_pull(
    span: float, rise: float, length: float, weight: float, axial_stiffness: float, on_bed: bool
) -> tuple[float, float]:
    """Horizontal and vertical pull (N) of a line on its upper end, towards the anchor and down.

    Args:
        span: Horizontal distance of its ends, m.
        rise: Height of the upper end above the lower, m.
        length: Unstretched, m.
        weight: In water per length, N/m.
        axial_stiffness: EA, N.
        on_bed: Whether the lower end lies on the sea bed.

    Raises:
        NoCatenary: There is no such line, as where it hangs straight down.
    """

    def ends(unknown: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
        across, down = math.exp(min(unknown[0], 60.0)), unknown[1] * weight * length
        stretched = across * length / axial_stiffness
        ratio = down / across
        if on_bed and down < weight * length:
            lying = length - down / weight
            x = lying + across / weight * math.asinh(ratio) + stretched
            z = across / weight * (math.hypot(1.0, ratio) - 1.0) + down**2 / (2 * axial_stiffness * weight)
        else:
            low = (down - weight * length) / across
            x = across / weight * (math.asinh(ratio) - math.asinh(low)) + stretched
            z = across / weight * (math.hypot(1.0, ratio) - math.hypot(1.0, low))
            z += (down * length - 0.5 * weight * length**2) / axial_stiffness
        return np.array([x - span, z - rise]) / length

    for across, down in _guesses(span, rise, length, weight, axial_stiffness):
        found = root(ends, [math.log(across), down / (weight * length)], method="hybr", options={"xtol": 1e-13})
        if np.abs(found.fun).max() < _TOLERANCE:
            return math.exp(found.x[0]), float(found.x[1] * weight * length)
    raise NoCatenary(f"no equilibrium of a line of {length:g} m between ends {span:.4g} m apart and {rise:.4g} m in height")


def _guesses(span: float, rise: float, length: float, weight: float, axial_stiffness: float) -> Iterator[tuple[float, float]]:
    """Pulls (N) to begin with: of a spring, where the line is stretched, then of catenaries of several sags."""
    straight, least = math.hypot(span, rise), 1e-3 * weight * length
    if straight > length:
        tension = axial_stiffness * (straight / length - 1)
        yield max(tension * span / straight, least), tension * rise / straight + 0.5 * weight * length
    sag = math.sqrt(max(3 * ((length**2 - rise**2) / max(span, 1e-9) ** 2 - 1), 1e-4))
    for ratio in (sag, 0.2, 1.0, 0.05):
        yield max(0.5 * weight * span / ratio, least), 0.5 * weight * (rise / math.tanh(ratio) + length)


def linearised(
    system: MooringSystem, density: float, depth: float, gravity: float
) -> tuple[Float[np.ndarray, "6"], Float[np.ndarray, "6 6"]]:
    """Pull (N, N m) and stiffness (N/m, N, N m/rad) of a mooring at the reference position, about the origin, in earth axes.

    Args:
        system: The mooring.
        density: Of the water, kg/m3.
        depth: Of the water, m.
        gravity: m/s2.

    Raises:
        NoCatenary: Lines meet at a point between ground and platform, or one has no equilibrium.
    """
    lines = [_line_of(system, line) for line in system.lines.values()]

    def force(motion: Float[np.ndarray, "6"]) -> Float[np.ndarray, "6"]:
        turn = _turned(motion[3:])
        total = np.zeros(6)
        for anchor, fairlead, length, (diameter, mass, stiffness) in lines:
            arm = turn @ fairlead
            away = anchor - (motion[:3] + arm)
            weight = (mass - density * math.pi / 4 * diameter**2) * gravity
            if weight <= 0.0:
                raise NoCatenary("a line that is lighter than water")
            span = float(np.hypot(away[0], away[1]))
            on_bed = bool(anchor[2] <= -depth + _BED)
            across, down = catenary_pull(span, -float(away[2]), length, weight, stiffness, on_bed)
            pull = np.array([across * away[0] / span, across * away[1] / span, -down])
            total += np.concatenate([pull, np.cross(arm, pull)])
        return total

    stiffness = np.zeros((6, 6))
    for j, step in enumerate(_STEPS):
        offset = np.zeros(6)
        offset[j] = step
        stiffness[:, j] = -(force(offset) - force(-offset)) / (2 * step)
    return force(np.zeros(6)), stiffness


def _line_of(
    system: MooringSystem, line: MooringLine
) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"], float, tuple[float, float, float]]:
    ends = [system.points[name] for name in line.ends]
    ends.sort(key=lambda point: point.attachment is Attachment.PLATFORM)
    if [point.attachment for point in ends] != [Attachment.GROUND, Attachment.PLATFORM]:
        kinds = " and ".join(point.attachment for point in ends)
        raise NoCatenary(f"line {line.name} does not go from the ground to the platform ({kinds})")
    kind = system.types[line.kind]
    anchor, fairlead = (np.array(point.place) for point in ends)
    return anchor, fairlead, line.unstretched_length, (kind.diameter, kind.mass, kind.axial_stiffness)


def _turned(angles: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3 3"]:
    """R = Rz Ry Rx of roll, pitch and yaw (rad)."""
    (cx, cy, cz), (sx, sy, sz) = np.cos(angles), np.sin(angles)
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x
