"""Spectra of residuals, for standard deviations under coloured errors.

The standard deviation of an estimate rests on the scatter of its score J^T e. The variance of the score is that of the residual
at the frequencies of the slope J, near the natural frequency of a decay. White noise of the same total variance has
most of its variance elsewhere. The integrated autocorrelation is the spectrum at frequency zero, and misses both a peak and its
absence.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import scipy  # its parts are imported when they are used: that takes a second

from calibration.identifiability.information import MIN_VARIANCE


class Periodogram(NamedTuple):
    """Periodogram of a residual of n samples.

    Attributes:
        frequency: Frequencies (Hz), (f,).
        power: |FFT|^2 / n, (f,); its mean over all n frequencies is the mean square.
        freedom: Fraction (0 to 1) of the power that the fit has left, (f,).
        number: Number of the n frequencies that each stands for, (f,).
    """

    frequency: np.ndarray
    power: np.ndarray
    freedom: np.ndarray
    number: np.ndarray

    @property
    def variance(self) -> float:
        """Variance of the errors: that of the residuals, raised for the share that the fit has absorbed."""
        return float(max((self.number * self.power).sum() / (self.number * self.freedom).sum(), MIN_VARIANCE))


class NoiseColour(NamedTuple):
    """Spectral density relative to the variance: a flat floor and one resonance.

    The resonance is g^2 / ((f - f0)^2 + g^2) and its mirror image. With f0 = 0 it is an autoregression of first order, of
    correlation time 1 / (2 pi g). With f0 > 0 it is noise that rings at f0 with damping ratio g / f0. With `peak` 0 the noise
    is white.

    Attributes:
        floor: Density of the floor.
        peak: Factor of the resonance.
        centre: Frequency f0 of the resonance (Hz).
        width: Half width g of the resonance (Hz).
    """

    floor: float
    peak: float
    centre: float
    width: float

    def density(self, frequency: np.ndarray) -> np.ndarray:
        """Density (f,) at `frequency` (Hz)."""
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

    All groups have one colour unless they differ by more than chance. One colour is that of a basin that is not still. Colours
    differ where a model's error is in the motion that was released.

    Args:
        groups: Periodograms by group.

    Returns:
        Colour and variances of each group.
    """
    whole, apart = whittle([spectrum for group in groups for spectrum in group]), [whittle(group) for group in groups]
    if len(groups) == 1 or sum(fit.misfit for fit in apart) < whole.misfit:
        return [(fit.colour, fit.variance) for fit in apart]
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


def whittle(spectra: Sequence[Periodogram]) -> SpectralFit:
    """Colour of residuals of one kind, and their variances, one for all unless they clearly differ.

    The colour S is that of the largest -sum over frequencies of (d ln S + I / S). I is the power, and d the degrees of freedom
    that the fit has left of it, so that E[I] = d S. I has a gamma density of shape d in place of the exponential one, as in
    restricted likelihood. A fit takes away most of the residual at the very frequency of the decay, where the scatter matters.
    The residual beside that frequency says how much it was.

    References:
        Whittle 1953, Arkiv foer Matematik 2, 423-434.
    """
    count = np.array([(spectrum.number * spectrum.freedom).sum() for spectrum in spectra])
    separate = np.array([spectrum.variance for spectrum in spectra])
    common = np.full(len(spectra), float((count * separate).sum() / count.sum()))
    tried = [_whittle(spectra, variance) for variance in ([common] if len(spectra) == 1 else [common, separate])]
    price = 0.5 * float(np.log(0.5 * count.sum()))
    misfit = [value + price * numbers for (_, value), numbers in zip(tried, (1, len(spectra)))]
    best = int(np.argmin(misfit))
    return SpectralFit(tried[best][0], (common, separate)[best], misfit[best])


def _whittle(spectra: Sequence[Periodogram], variance: np.ndarray) -> tuple[NoiseColour, float]:
    """Colour with given variances, and its misfit."""
    frequency = np.concatenate([spectrum.frequency for spectrum in spectra])
    power = np.concatenate([spectrum.power / v for spectrum, v in zip(spectra, variance, strict=True)])
    freedom = np.concatenate([spectrum.freedom for spectrum in spectra])
    half = 0.5 * np.concatenate([spectrum.number for spectrum in spectra])
    level = sum(
        float(np.log(v) * (0.5 * spectrum.number * spectrum.freedom).sum())
        for spectrum, v in zip(spectra, variance, strict=True)
    )
    first, last = min(spectrum.frequency[1] for spectrum in spectra), float(frequency.max())

    def colour(z: np.ndarray) -> NoiseColour:
        return NoiseColour(*map(float, np.exp(z)))

    def misfit(z: np.ndarray) -> float:
        density = colour(z).density(frequency)
        return level + float(np.sum(half * (freedom * np.log(density) + power / density)))

    high = frequency > 0.5 * last
    floor = min(max(float((half * power)[high].sum() / (half * freedom)[high].sum()), 1e-9), 1.0)
    # starts at the largest of what stands out once its neighbours are taken together, and at low frequencies
    share = [
        np.convolve(spectrum.power, np.ones(5), "same") / np.convolve(spectrum.freedom, np.ones(5), "same")
        for spectrum in spectra
    ]
    tall = [float(x.max() / v) for x, v in zip(share, variance, strict=True)]
    tallest = int(np.argmax(tall))
    top, centre = max(tall[tallest], 2 * floor), max(float(spectra[tallest].frequency[int(np.argmax(share[tallest]))]), first)
    limits = [
        (np.log(floor) - 7, 3.0),
        (np.log(floor) - 12, np.log(top) + 5),
        (np.log(0.05 * first), np.log(last)),
        (np.log(0.3 * first), np.log(last)),
    ]
    starts = [(centre, 2 * first), (centre, 0.3 * centre), (0.1 * first, first), (0.1 * first, 0.1 * last)]
    tried = [
        scipy.optimize.minimize(misfit, np.log([floor, top, *start]), method="L-BFGS-B", bounds=limits) for start in starts
    ]
    best, white = min(tried, key=lambda result: result.fun), NoiseColour(1.0, 0.0, 0.0, float(first))
    flat = level + float(np.sum(half * power))
    # three numbers more than white noise has, one of them searched for over all frequencies: among so many one stands out by
    # chance, and does not count until it pays for them
    cost = 1.5 * float(np.log(half.sum()))
    return (colour(best.x), float(best.fun) + cost) if best.fun + cost < flat else (white, flat)


def score_covariance(slope: np.ndarray, variance: float, colour: NoiseColour, step: float) -> np.ndarray:
    """Covariance (k, k) of J^T e, sum_f J^(f)* J^(f)^T S(f) / n.

    Args:
        slope: Slopes J (n, k).
        variance: Variance of the errors e.
        colour: Colour of the errors.
        step: Sampling interval (s).
    """
    n = len(slope)
    wave, frequency = np.fft.rfft(slope, axis=0), np.fft.rfftfreq(n, step)
    count = np.full(len(frequency), 2.0)
    count[0] = 1.0
    count[-1] = 2.0 if n % 2 else 1.0
    power = count * variance * colour.density(frequency) / n
    return np.asarray(np.einsum("fk,fl,f->kl", wave.conj(), wave, power).real)
