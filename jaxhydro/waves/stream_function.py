"""Steep regular waves by the stream function, with their flow up to the surface.

Their Fourier coefficients are those of raschii.
"""

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.waves.sea import stretched
from jaxhydro.waves.wave_errors import NoWaveError
from jaxhydro.waves.wave_sea import WaveSea

HINT = "stream-function waves need raschii: pip install 'jaxhydro[waves]'"


class StreamFunction(NamedTuple):
    """Fourier coefficients of a stream-function wave with a crest at x = 0 at time 0.

        eta = sum E_j cos j(kx - omega t),    u = sum j k Phi_j cosh jk(z + h) / cosh jkh cos j(kx - omega t)

    Attributes:
        wavenumber: k (rad/m).
        elevation: E_j (m), (n,).
        potential: Phi_j (m²/s), (n,).

    References:
        Rienecker and Fenton (1981), Journal of Fluid Mechanics 104, 119-137, equations 2.1 and 2.5.
    """

    wavenumber: float
    elevation: Float[np.ndarray, " n"]
    potential: Float[np.ndarray, " n"]


def stream_function(height: float, period: float, depth: float, gravity: float, order: int) -> StreamFunction:
    """Stream-function wave of a period, without a mean current in the earth's frame.

    Args:
        height: Height from trough to crest (m).
        period: Period (s).
        depth: Water depth (m).
        gravity: Acceleration of gravity (m/s²).
        order: Number of Fourier components.

    Raises:
        NoWaveError: No such wave is found: it breaks, or the series is too short or too long for it.
        ImportError: raschii is not installed.
    """
    try:
        from raschii import FentonWave, RaschiiError
    except ImportError:
        raise ImportError(HINT) from None
    try:
        with np.errstate(all="ignore"):
            wave = FentonWave(height, depth, period=period, N=order, g=gravity)
    except (RaschiiError, ArithmeticError, np.linalg.LinAlgError, ValueError) as error:
        raise NoWaveError(f"no stream-function wave of {height:g} m and {period:g} s is found: {error}") from None
    elevation = 2 * np.asarray(wave.E)[1:] / order
    elevation[-1] /= 2  # the last of a cosine series by the trapezoidal rule
    return StreamFunction(float(wave.k), elevation, np.asarray(wave.data["B"])[1:])


class SteepWave(WaveSea):
    """Stream-function wave: `WaveSea` with the flow of the theory up to the surface.

    Above the surface the flow is that of the surface. `waves` is the first harmonic, `bound` are the others.
    """

    def levels(
        self, time: Float[Array, ""], points: Float[Array, "3 n"]
    ) -> tuple[Float[Array, " n"], Float[Array, " n"] | None]:
        if self.stretching == "none":
            return stretched(self, self.stretching, time, points, self.environment.depth)
        surface = self.elevation(time, points[:2])
        return jnp.maximum(jnp.minimum(points[2], surface), -self.environment.depth), None
