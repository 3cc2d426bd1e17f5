"""Regular waves: first order (Airy), second order (Stokes), and steep ones (stream function)."""

import math

import jax.numpy as jnp
import numpy as np

from jaxhydro.environment import Environment
from jaxhydro.quick_jit import on_device
from jaxhydro.remarks import Remark
from jaxhydro.waves.components import PlaneWaves, components
from jaxhydro.waves.sea import Stretching
from jaxhydro.waves.sea_limits import MICHE
from jaxhydro.waves.second_order import bound_waves
from jaxhydro.waves.stream_function import SteepWave, StreamFunction, stream_function
from jaxhydro.waves.wave_errors import BreakingError, StretchingError
from jaxhydro.waves.wave_sea import WaveSea

MAX_LENGTHENING = 1.2  # length of the steepest wave over that of linear theory, of one period: 1.193 in deep water
MAX_LAST_HARMONIC = 1e-3  # of the first harmonic of the elevation, that the last one of a whole series has at most


def regular_wave(
    height: float,
    period: float,
    environment: Environment,
    *,
    heading: float = 0.0,
    phase: float = 0.0,
    ramp: float = 0.0,
    stretching: Stretching = "vertical",
    order: int = 1,
) -> WaveSea:
    """Regular wave.

    - Order 1: Airy's linear wave.
    - Order 2: Stokes' wave of second order in finite depth. The wavenumber is that of linear theory. With k = 2 pi / L and
      T = tanh kh, the bound wave has the elevation H² k (3 - T²) / (16 T³). Its potential is 3 H² omega / (32 sinh⁴ kh)
      times cosh 2k(z + h). Both are at twice the phase.
    - Order 3 or more: stream-function wave of so many Fourier components, by raschii (`pip install 'jaxhydro[waves]'`). Its
      flow is that of the theory up to the surface.

    Heights count from the mean level. Accelerations are the local ones, du/dt at a fixed point, and pressures -dphi/dt over
    density, as in all seas.

    Args:
        height: Height from trough to crest (m).
        period: Period (s).
        environment: Water depth and gravity.
        heading: Direction that the wave travels to (rad).
        phase: Phase (rad): the crest is at the origin at time -phase / omega.
        ramp: Time (s) over which the wave grows from rest.
        stretching: Kinematics above still water, as in `WaveSea`. From order 3 on "vertical", the default, means those of the
            theory.
        order: 1, 2, or the number of Fourier components.

    Returns:
        The sea.

    Raises:
        ValueError: Height, period or order is out of range.
        BreakingError: The wave would break, H / L > 0.142 tanh kh.
        StretchingError: A steep wave is asked for with a stretching of linear theory.
        NoWaveError: No steep wave is found.
        ImportError: From order 3 on, raschii is not installed.

    References:
        Miche (1944), breaking limit; Dean and Dalrymple (1991), Water Wave Mechanics for Engineers and Scientists, equations
        11.10 and 11.11, second order; Rienecker and Fenton (1981), Journal of Fluid Mechanics 104, 119-137, stream function.
    """
    if not (period > 0 and height >= 0):
        raise ValueError(f"a regular wave needs period > 0 s and height >= 0 m, found {period} s and {height} m")
    if order < 1:
        raise ValueError(f"the order of a regular wave is 1 or more, found {order}")
    omega = 2 * math.pi / period
    wave = components(jnp.array([0.5 * height]), on_device([omega]), environment, heading=heading, phase=phase)
    k, depth = float(np.asarray(wave.wavenumber)[0]), float(environment.depth)
    _check_breaking(height, period, k, depth, 1.0 if order <= 2 else MAX_LENGTHENING)
    if order > 2:
        if stretching not in ("vertical", "none"):
            raise StretchingError(f"a stream-function wave has its own flow above still water: no stretching by {stretching}")
        solution = stream_function(height, period, depth, float(environment.gravity), order)
        _check_breaking(height, period, solution.wavenumber, depth)
        return _steep(solution, omega, environment, heading, phase, ramp, stretching)
    waves = PlaneWaves.free(wave, environment)
    bound = bound_waves(wave, environment, ("sum",)) if order == 2 else None
    return WaveSea(waves, environment, ramp, stretching, bound)


def _check_breaking(height: float, period: float, k: float, depth: float, share: float = 1.0) -> None:
    """Raise BreakingError where a wave is higher than a share of Miche's limit."""
    limit = share * MICHE * 2 * math.pi / k * math.tanh(k * depth)
    if height > limit:
        raise BreakingError(f"a wave of period {period:g} s breaks above a height of {limit:.3g} m, found {height:g} m")


def _steep(
    solution: StreamFunction,
    omega: float,
    environment: Environment,
    heading: float,
    phase: float,
    ramp: float,
    stretching: Stretching,
) -> SteepWave:
    number = np.arange(1, len(solution.elevation) + 1)
    turn = np.exp(1j * phase * number)
    along = np.array([[math.cos(heading)], [math.sin(heading)]])
    fields = number * omega, along * number * solution.wavenumber, solution.elevation * turn, solution.potential * turn
    waves, bound = (PlaneWaves(*(on_device(field[..., part]) for field in fields)) for part in (slice(1), slice(1, None)))
    return SteepWave(waves, environment, ramp, stretching, bound)


def series_remarks(sea: WaveSea, order: int) -> list[Remark]:
    """Remark on a stream-function wave whose Fourier series is cut short."""
    if not isinstance(sea, SteepWave) or sea.bound is None:
        return []
    last = float(jnp.abs(sea.bound.elevation[-1]) / jnp.abs(sea.waves.elevation[0]))
    if last <= MAX_LAST_HARMONIC:
        return []
    text = f"the last of {order} harmonics of the elevation has {last:.1%} of the first: a higher --order would follow the wave"
    return [Remark(text, warning=True)]
