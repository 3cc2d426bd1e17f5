"""Spectra of residuals, for standard deviations under coloured errors.

The standard deviation of an estimate rests on the scatter of its score J^T e, whose variance is that of the residual at the
frequencies of the slope J: of a decay, near its natural frequency. White noise of the same total variance has most of it
elsewhere; the integrated autocorrelation is the spectrum at frequency zero, and misses both a peak and its absence.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize

from calibration.identifiability.information import MIN_VARIANCE


class Periodogram(NamedTuple):
    """Periodogram of a residual of n samples.

    Attributes:
        frequency: Frequencies (Hz), (f,).
        power: |FFT|^2 / n, (f,); its mean over all n frequencies is the mean square.
        freedom: Fraction (0 to 1) of the power that the fit has left, (f,).
        number: How many of the n frequencies each stands for, (f,).
    """

    frequency: np.ndarray
    power: np.ndarray
    freedom: np.ndarray
    number: np.ndarray

    @property
    def variance(self) -> float:
        """Variance of the errors, from that of the residuals, of which the fit has taken away some."""
        return float(max((self.number * self.power).sum() / (self.number * self.freedom).sum(), MIN_VARIANCE))


class NoiseColour(NamedTuple):
    """Density, relative to the variance, of a flat floor and one resonance: g^2 / ((f - f0)^2 + g^2) and its mirror image.

    With f0 = 0 it is an autoregression of first order, of correlation time 1 / (2 pi g); with f0 > 0, noise that rings at f0
    with damping ratio g / f0; with `peak` 0, white.
    """

    floor: float
    peak: float
    centre: float
    width: float

    def density(self, frequency: np.ndarray) -> np.ndarray:
        """(f,) at `frequency` (Hz)."""
        sides = [self.width**2 / ((frequency - sign * self.centre) ** 2 + self.width**2) for sign in (1, -1)]
        return self.floor + self.peak * (sides[0] + sides[1])


def periodogram(residual: np.ndarray, leverage: np.ndarray, step: float) -> Periodogram:
    """Periodogram of a residual.

    Args:
        residual: The residual, (n,).
        leverage: Fraction of a unit power at each frequency that the fit absorbs, (n // 2 + 1,): the diagonal of its hat
            matrix there.
        step: Sampling interval (s).
    """
    n = len(residual)
    count = np.full(n // 2 + 1, 2.0)
    count[0] = 1.0
    count[-1] = 2.0 if n % 2 else 1.0
    power = np.abs(np.fft.rfft(residual)) ** 2 / n
    return Periodogram(np.fft.rfftfreq(n, step), power, np.clip(1 - leverage, 0.0, 1.0), count)


def fit_colours(groups: Sequence[Sequence[Periodogram]]) -> list[tuple[NoiseColour, np.ndarray]]:
    """Colour and variances of groups of residuals by `whittle`.

    All groups have one colour, as where a basin is not still, unless they differ by more than chance, as where a model's error
    is in the motion that was released.

    Args:
        groups: Periodograms by group.

    Returns:
        Colour and variances of each group.
    """
    whole, apart = whittle([one for group in groups for one in group]), [whittle(group) for group in groups]
    if len(groups) == 1 or sum(one.misfit for one in apart) < whole.misfit:
        return [(one.colour, one.variance) for one in apart]
    ends = np.cumsum([len(group) for group in groups])[:-1]
    return [(whole.colour, variance) for variance in np.split(whole.variance, ends)]


class SpectralFit(NamedTuple):
    """Colour and variances of residuals.

    Attributes:
        colour: Their colour.
        variance: Variance of each (m², rad²).
        misfit: Minus the log likelihood, and half the logarithm of the number of frequencies for each number fitted (Schwarz
            1978, Annals of Statistics 6, 461-464).
    """

    colour: NoiseColour
    variance: np.ndarray
    misfit: float


def whittle(found: Sequence[Periodogram]) -> SpectralFit:
    """Colour of residuals of one kind, and their variances, one for all unless they clearly differ.

    Largest of -sum over frequencies of (d ln S + I / S) (Whittle 1953, Arkiv foer Matematik 2, 423-434), in which I is the
    power and d the degrees of freedom that the fit has left of it: E[I] = d S, and a gamma density of shape d in place of the
    exponential one, as restricted likelihood has it. A fit takes away most of the residual at the very frequency of the decay,
    where the scatter matters: what is left beside it says how much it was.
    """
    count = np.array([(one.number * one.freedom).sum() for one in found])
    own = np.array([one.variance for one in found])
    common = np.full(len(found), float((count * own).sum() / count.sum()))
    tried = [_whittle(found, variance) for variance in ([common] if len(found) == 1 else [common, own])]
    price = 0.5 * float(np.log(0.5 * count.sum()))
    misfit = [one + price * numbers for (_, one), numbers in zip(tried, (1, len(found)))]
    best = int(np.argmin(misfit))
    return SpectralFit(tried[best][0], (common, own)[best], misfit[best])


def _whittle(found: Sequence[Periodogram], variance: np.ndarray) -> tuple[NoiseColour, float]:
    """The colour with given variances, and its misfit."""
    frequency = np.concatenate([one.frequency for one in found])
    power = np.concatenate([one.power / v for one, v in zip(found, variance, strict=True)])
    freedom = np.concatenate([one.freedom for one in found])
    half = 0.5 * np.concatenate([one.number for one in found])
    level = sum(float(np.log(v) * (0.5 * one.number * one.freedom).sum()) for one, v in zip(found, variance, strict=True))
    first, last = min(one.frequency[1] for one in found), float(frequency.max())

    def colour(z: np.ndarray) -> NoiseColour:
        return NoiseColour(*map(float, np.exp(z)))

    def misfit(z: np.ndarray) -> float:
        density = colour(z).density(frequency)
        return level + float(np.sum(half * (freedom * np.log(density) + power / density)))

    high = frequency > 0.5 * last
    floor = min(max(float((half * power)[high].sum() / (half * freedom)[high].sum()), 1e-9), 1.0)
    # starts at the largest of what stands out once its neighbours are taken together, and at low frequencies
    share = [np.convolve(one.power, np.ones(5), "same") / np.convolve(one.freedom, np.ones(5), "same") for one in found]
    tall = [float(x.max() / v) for x, v in zip(share, variance, strict=True)]
    at = int(np.argmax(tall))
    top, place = max(tall[at], 2 * floor), max(float(found[at].frequency[int(np.argmax(share[at]))]), first)
    limits = [
        (np.log(floor) - 7, 3.0),
        (np.log(floor) - 12, np.log(top) + 5),
        (np.log(0.05 * first), np.log(last)),
        (np.log(0.3 * first), np.log(last)),
    ]
    starts = [(place, 2 * first), (place, 0.3 * place), (0.1 * first, first), (0.1 * first, 0.1 * last)]
    tried = [minimize(misfit, np.log([floor, top, *start]), method="L-BFGS-B", bounds=limits) for start in starts]
    best, white = min(tried, key=lambda one: one.fun), NoiseColour(1.0, 0.0, 0.0, float(first))
    flat = level + float(np.sum(half * power))
    # three numbers more than white noise has, one of them searched for over all frequencies: among so many one stands out by
    # chance, and does not count until it pays for them
    cost = 1.5 * float(np.log(half.sum()))
    return (colour(best.x), float(best.fun) + cost) if best.fun + cost < flat else (white, flat)


def score_covariance(slope: np.ndarray, variance: float, colour: NoiseColour, step: float) -> np.ndarray:
    """Covariance (k, k) of J^T e for slopes J (n, k) and errors e of this colour: sum_f J^(f)* J^(f)^T S(f) / n."""
    n = len(slope)
    wave, frequency = np.fft.rfft(slope, axis=0), np.fft.rfftfreq(n, step)
    count = np.full(len(frequency), 2.0)
    count[0] = 1.0
    count[-1] = 2.0 if n % 2 else 1.0
    power = count * variance * colour.density(frequency) / n
    return np.asarray(np.einsum("fk,fl,f->kl", wave.conj(), wave, power).real)
