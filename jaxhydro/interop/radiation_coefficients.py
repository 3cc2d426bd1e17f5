"""Added mass and radiation damping over frequency, as from potential theory."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float


class RadiationCoefficients(NamedTuple):
    """Added mass and radiation damping about the reference point of their file, surge ... yaw: force in i, motion in j.

    `omega` (rad/s) increases from above 0; `added_mass` (kg, kg m, kg m2) and `damping` (N s/m, N s, N m s/rad) are of these
    frequencies, `infinite` is the added mass at infinite frequency and `zero` at frequency zero, None where the file lacks it.
    """

    omega: Float[np.ndarray, " n"]
    added_mass: Float[np.ndarray, "n 6 6"]
    damping: Float[np.ndarray, "n 6 6"]
    infinite: Float[np.ndarray, "6 6"] | None = None
    zero: Float[np.ndarray, "6 6"] | None = None
