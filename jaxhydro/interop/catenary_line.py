"""Elastic catenary of one line, with or without a part at rest on a frictionless sea bed."""

import math

import numpy as np
from jaxtyping import Float
from scipy.optimize import root

CLOSED = 1e-9  # of the line's length, up to which the two ends are where they belong
STARTS = (1.0, 10.0, 0.1, 100.0, 0.01, 1000.0)  # factors on the first guess of the horizontal tension
HIGHEST_RATIO = 1e-9  # of the horizontal over the vertical distance, below which a line is vertical


class CatenaryError(ValueError):
    """A line that the equations do not hold for; the message says why."""


def end_tension(
    horizontal: float, vertical: float, length: float, weight: float, axial_stiffness: float, on_bed: bool
) -> tuple[float, float]:
    """Horizontal and vertical tension at the upper end of a line.

    The two equations for the distances of the ends are Irvine's (1981, Cable Structures, section 1.3), as Jonkman has them
    (2007, NREL/TP-500-41958, eq. 2-35 and 2-36 for a line off the bed, eq. 2-37 and 2-38 with a part on the bed, here without
    friction, C_B = 0). The first guess is Jonkman's, eq. 2-41 to 2-43.

    Args:
        horizontal: Distance of the ends, m.
        vertical: Height of the upper end above the lower one, m.
        length: Unstretched, m.
        weight: In water, N/m.
        axial_stiffness: EA, N.
        on_bed: Whether the lower end is on the sea bed, so that a part of the line may be.

    Returns:
        Horizontal tension, and vertical tension at the upper end, N.

    Raises:
        CatenaryError: The line has no weight or is slack, or no solution was found.
    """
    if weight <= 0.0:
        raise CatenaryError("a line without weight in water")
    if horizontal < HIGHEST_RATIO * max(vertical, length):
        return 0.0, _vertical_line(vertical, length, weight, axial_stiffness)
    if on_bed and length >= horizontal + vertical:
        raise CatenaryError("a slack line: it is longer than from its anchor along the bed and straight up")
    scale = weight * length

    def gaps(unknown: Float[np.ndarray, "2"]) -> list[float]:
        across, up = math.exp(unknown[0]) * scale, unknown[1] * scale
        reach = _reach(across, up, length, weight, axial_stiffness, on_bed)
        return [(reach[0] - horizontal) / length, (reach[1] - vertical) / length]

    spare = (length**2 - vertical**2) / horizontal**2 - 1
    sag = math.sqrt(3 * spare) if spare > 0 else 0.2
    stretch = math.hypot(horizontal, vertical) / length - 1
    guess = max(weight * horizontal / (2 * sag), axial_stiffness * stretch)
    for factor in STARTS:
        across = guess * factor
        up = (
            0.5 * weight * (vertical / math.tanh(sag) + length) if stretch < 0 else across * vertical / horizontal + 0.5 * scale
        )
        with np.errstate(all="ignore"):
            try:
                found = root(gaps, [math.log(across / scale), up / scale], tol=1e-14)
                closed = max(map(abs, gaps(found.x))) < CLOSED
            except OverflowError:
                continue
        if closed:
            return math.exp(found.x[0]) * scale, float(found.x[1]) * scale
    raise CatenaryError("a line for which no catenary was found")


def _reach(across: float, up: float, length: float, weight: float, axial_stiffness: float, on_bed: bool) -> tuple[float, float]:
    """Horizontal and vertical distance (m) of the ends by the tensions (N) at the upper end."""
    a, b = up / across, (up - weight * length) / across
    if on_bed and b < 0.0:
        lying = length - up / weight
        x = lying + across / weight * math.asinh(a) + across * length / axial_stiffness
        return x, across / weight * (math.hypot(1.0, a) - 1.0) + up**2 / (2 * axial_stiffness * weight)
    x = across / weight * (math.asinh(a) - math.asinh(b)) + across * length / axial_stiffness
    z = across / weight * (math.hypot(1.0, a) - math.hypot(1.0, b))
    return x, z + (up * length - weight * length**2 / 2) / axial_stiffness


def _vertical_line(vertical: float, length: float, weight: float, axial_stiffness: float) -> float:
    """Tension (N) at the top of a taut vertical line: its own weight stretches it, too."""
    if (up := (vertical / length - 1) * axial_stiffness + weight * length / 2) < weight * length:
        raise CatenaryError("a slack vertical line")
    return up


def lowest_point(across: float, up: float, length: float, weight: float) -> float:
    """Depth (m) of a hanging line's lowest point below its lower end, without stretch; 0 if that end is the lowest.

    Args:
        across: Horizontal tension, N.
        up: Vertical tension at the upper end, N.
        length: Unstretched, m.
        weight: In water, N/m.
    """
    at_lower = up - weight * length
    return across / weight * (math.hypot(1.0, at_lower / across) - 1.0) if at_lower < 0.0 < across else 0.0
