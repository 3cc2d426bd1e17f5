"""Radiation damping without the small negative part that inaccurate tables have."""

import numpy as np
from jaxtyping import Float

from jaxhydro.interop.radiation_coefficients import RadiationCoefficients
from jaxhydro.interop.retardation import MAX_NEGATIVE_DAMPING

MAX_CHANGE = 0.15  # of two motions' own largest damping, up to which an entry is changed


def taking_energy(coefficients: RadiationCoefficients) -> tuple[RadiationCoefficients, float]:
    """Coefficients whose damping takes energy at every frequency, by leaving its negative eigenvalues out.

    Damping is compared with each motion's own largest. What is negative by less than `MAX_NEGATIVE_DAMPING` is left as it is,
    as state spaces allow for it. What is negative by much is left, too: it is no inaccuracy.

    Args:
        coefficients: Coefficients of a table.

    Returns:
        The coefficients, and the largest change of an entry over the geometric mean of the two motions' own (0: none).
    """
    damping = 0.5 * (coefficients.damping + coefficients.damping.transpose(0, 2, 1))
    own: Float[np.ndarray, 6] = np.abs(np.einsum("wii->wi", damping)).max(axis=0)
    size = np.sqrt(np.where(own > 0, own, 1.0))
    values, vectors = np.linalg.eigh(damping / np.outer(size, size))
    if values.min() >= -MAX_NEGATIVE_DAMPING * values.max():
        return coefficients, 0.0
    positive = np.einsum("wik,wk,wjk->wij", vectors, np.maximum(values, 0.0), vectors)
    change = float(np.abs(positive - damping / np.outer(size, size)).max())
    if change > MAX_CHANGE:
        return coefficients, 0.0
    return coefficients._replace(damping=positive * np.outer(size, size)), change
