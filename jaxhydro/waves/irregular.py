"""Components of irregular seas, drawn from a spectrum.

Frequencies are successive harmonics of a period. These builders run once per sea, in NumPy; their results go into jitted
code.
"""

import math
from collections.abc import Callable

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.choices import check
from jaxhydro.environment import Environment
from jaxhydro.quick_jit import on_device
from jaxhydro.waves.components import Components, components
from jaxhydro.waves.dispersion import wavenumber
from jaxhydro.waves.wave_errors import BandError, BreakingError


def repeat_period(duration: float) -> float:
    """Repeat period (s): the least whole number from `duration` on with no prime factor above 5.

    Steps of 1, 0.5, 0.25, 0.2 or 0.1 s then give efficient Fourier transforms. The sea does not repeat within `duration`
    (s).
    """
    return float(fourier_length(duration))


def fourier_length(least: float) -> int:
    """Efficient length of Fourier transforms: the least from `least` on with no prime factor above 5."""
    count = max(math.ceil(least - 1e-9), 1)
    while (60 ** count.bit_length()) % count:  # 60 = 2^2 3 5: divides a high power of it only if 2, 3 and 5 are all it has
        count += 1
    return count


def spectrum_components(
    spectrum: Callable[[Float[Array, " w"]], Float[Array, " w"]],
    duration: float,
    environment: Environment,
    *,
    low: float,
    cutoff: float,
    seed: int,
    amplitudes: str = "deterministic",
    heading: float = 0.0,
    spreading: float | None = None,
) -> Components:
    """Draw a sea from a spectrum.

    Frequencies are the harmonics of `repeat_period(duration)` from `low` to `cutoff`. Energy of the spectrum outside is cut,
    and nothing is scaled to make up for it. Phases are uniform.

    Phases, heights and headings each have a random stream of their own, drawn by harmonic. Another band or another option
    leaves the other draws as they are.

    Args:
        spectrum: Spectral density S(omega), from rad/s to m² s/rad.
        duration: Time (s) within which the sea must not repeat.
        environment: Water depth and gravity.
        low: Lowest frequency (Hz).
        cutoff: Highest frequency (Hz).
        seed: Seed of the random numbers.
        amplitudes: "deterministic", sqrt(2 S d_omega), or "rayleigh", complex normal amplitudes of that mean square. Only
            with "rayleigh" is the energy of a sea random, as in nature.
        heading: Mean direction that the waves travel to (rad).
        spreading: Exponent s of `spreading.spreading`, or None for long-crested waves. Each component has one heading: with
            one direction per frequency, a mean over time is the same everywhere.

    Returns:
        The components.

    Raises:
        ValueError: A duration, option or spectrum is out of range.
        BandError: The band is out of range or holds no harmonic.
        BreakingError: A wave of height 4 sqrt(m0) and the zero-crossing period would break (Miche, as in `regular_wave`).

    References:
        Tucker, Challenor and Carter (1984), on random amplitudes; Jefferys (1987), on one direction per frequency.
    """
    if not (duration > 0 and math.isfinite(duration)):
        raise ValueError(f"duration is above 0 s, found {duration}")
    check(amplitudes=(amplitudes, ("deterministic", "rayleigh")))
    if spreading is not None and not (spreading >= 0 and math.isfinite(spreading)):
        raise ValueError(f"the exponent of a spreading is not negative, found {spreading}")
    period = repeat_period(duration)
    first, last = harmonics(low, cutoff, period)
    step = 2 * math.pi / period
    omega = step * np.arange(first, last + 1)
    density = np.broadcast_to(np.asarray(spectrum(on_device(omega)), float), omega.shape)
    if not (np.all(np.isfinite(density)) and np.all(density >= 0)):
        raise ValueError("a spectrum is finite and not negative, found values that are not")
    if not density.any():
        raise ValueError(f"the spectrum has no energy from {low:g} to {cutoff:g} Hz; is its frequency in rad/s?")
    _below_breaking(omega, density * step, environment)
    phases, heights, directions = np.random.default_rng(seed).spawn(3)
    drawn = slice(first - 1, last)  # of the harmonics 1, 2 ... last
    square = 2 * density * step
    if amplitudes == "rayleigh":
        square = square * heights.exponential(size=last)[drawn]
    headings = np.full(omega.shape, float(heading))
    if spreading is not None:  # sin^2 of half the angle is beta distributed; which side is a matter of chance
        sine = np.sqrt(directions.beta(0.5, spreading + 0.5, size=last))
        headings = headings + (2 * np.arcsin(sine) * np.sign(directions.random(size=last) - 0.5))[drawn]
    phase = phases.uniform(-math.pi, math.pi, size=last)[drawn]
    return harmonic_components(np.sqrt(square), omega, environment, headings, phase, first)


def harmonic_components(
    amplitude: np.ndarray, omega: np.ndarray, environment: Environment, heading: np.ndarray, phase: np.ndarray, first: int
) -> Components:
    """Components at successive harmonics from number `first` on: amplitude (m), frequency (rad/s), heading and phase (rad)."""
    a, w, towards, angle = (on_device(x) for x in (amplitude, omega, heading, phase))
    return components(a, w, environment, heading=towards, phase=angle, first=first)


def harmonics(low: float, cutoff: float, period: float) -> tuple[int, int]:
    """First and last harmonic of a period within a band, both limits included.

    Args:
        low: Lower limit (Hz).
        cutoff: Upper limit (Hz).
        period: Period (s).

    Raises:
        BandError: The band is out of range or holds no harmonic.
    """
    if not (0 <= low < cutoff and math.isfinite(cutoff)):
        raise BandError(f"a band has 0 <= low < cutoff, found {low} and {cutoff} Hz")
    first, last = max(math.ceil(low * period - 1e-6), 1), math.floor(cutoff * period + 1e-6)
    if last < first:
        raise BandError(f"a band wider than one over the period, {period:g} s, expected, found {low:g} to {cutoff:g} Hz")
    return first, last


def _below_breaking(omega: np.ndarray, energy: np.ndarray, environment: Environment) -> None:
    """Raise BreakingError where a wave of the significant height and the zero-crossing period would break."""
    m0 = energy.sum()
    crossing = math.sqrt((omega**2 * energy).sum() / m0)
    k = float(wavenumber(jnp.asarray(crossing), jnp.asarray(environment.depth), jnp.asarray(environment.gravity)))
    limit = 0.142 * 2 * math.pi / k * math.tanh(k * float(environment.depth))
    height, period = 4 * math.sqrt(m0), 2 * math.pi / crossing
    if height > limit:
        actual = f"found a significant height of {height:.3g} m"
        raise BreakingError(f"waves of zero-crossing period {period:.3g} s break above {limit:.3g} m, {actual}")
