"""Motions and forces about another point of a rigid body."""

import numpy as np
from jaxtyping import Float


def rigid_shift(point: Float[np.ndarray, "3"]) -> Float[np.ndarray, "6 6"]:
    """H that maps velocities of the reference point to those of a point (m) from it: v + omega x r.

    A matrix about the point is H^T A H about the reference point, a force H^T F.

    Args:
        point: The point from the reference point (m).

    References:
        Fossen (2011), Handbook of Marine Craft Hydrodynamics and Motion Control, section 7.3.
    """
    x, y, z = point
    shift = np.eye(6)
    shift[:3, 3:] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
    return shift
