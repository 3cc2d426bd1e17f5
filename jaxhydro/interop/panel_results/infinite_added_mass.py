"""Added mass of infinite frequency, where a table of radiation lacks it."""

import numpy as np
from jaxtyping import Float

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.damping_that_takes_energy import taking_energy
from jaxhydro.interop.radiation_coefficients import RadiationCoefficients
from jaxhydro.interop.retardation import realise


def infinite_added_mass(coefficients: RadiationCoefficients, source: str) -> tuple[Float[np.ndarray, "6 6"], float]:
    """Added mass of infinite frequency (kg, kg m, kg m²) by the relations of Kramers and Kronig.

    It is the median over frequency of A(omega) less the part that the memory of the damping gives.

    Args:
        coefficients: Added mass and damping by frequency.
        source: The file, for messages.

    Returns:
        The matrix, symmetric, (6, 6), and the largest standard deviation over frequency of an entry of its diagonal, relative.

    Raises:
        InputError: No state space follows the damping.

    References:
        Ogilvie (1964), 5th Symposium on Naval Hydrodynamics.
    """
    coefficients, _ = taking_energy(coefficients)
    try:
        memory = realise(coefficients).transfer(coefficients.omega)
    except ValueError as error:
        expected = "radiation damping that takes energy, and that a state space can follow"
        raise InputError(source, [Problem("", expected, str(error))]) from None
    left = coefficients.added_mass - memory.imag / coefficients.omega[:, None, None]
    middle, own = np.median(left, axis=0), np.einsum("wii->wi", left)
    size = np.abs(np.diag(middle))
    spread = own.std(axis=0)[size > 0] / size[size > 0]
    return 0.5 * (middle + middle.T), float(spread.max(initial=0.0))
