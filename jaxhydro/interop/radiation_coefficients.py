"""Added mass and radiation damping over frequency, as from potential theory."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float


class RadiationCoefficients(NamedTuple):
    """Added mass and radiation damping about the reference point of their file.

    Motions are surge ... yaw. Entry (i, j) is the force in i by the motion in j.

    Attributes:
        omega: Frequencies (rad/s), increasing from above 0, (n,).
        added_mass: Added mass (kg, kg m, kg m²) at these frequencies, (n, 6, 6).
        damping: Damping (N s/m, N s, N m s/rad) at these frequencies, (n, 6, 6).
        infinite: Added mass at infinite frequency, (6, 6); None where the file lacks it.
        zero: Added mass at frequency 0, (6, 6); None where the file lacks it.
    """

    omega: Float[np.ndarray, " n"]
    added_mass: Float[np.ndarray, "n 6 6"]
    damping: Float[np.ndarray, "n 6 6"]
    infinite: Float[np.ndarray, "6 6"] | None = None
    zero: Float[np.ndarray, "6 6"] | None = None
