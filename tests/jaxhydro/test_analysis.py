"""Analysis of records against signals whose spectra, transfer functions and statistics are known in closed form."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy import signal

from jaxhydro.analysis.motion_bands import BANDS, bands
from jaxhydro.analysis.record_statistics import exceedance, statistics
from jaxhydro.analysis.sea_statistics import bands_of, record_peak_period
from jaxhydro.analysis.spectral import PowerSpectrum, band_integral, band_pass, band_weights, power_spectrum
from jaxhydro.analysis.transfer_functions import transfer_function
from jaxhydro.environment import Environment
from jaxhydro.waves.irregular import spectrum_components
from jaxhydro.waves.irregular_sea import IrregularSea
from jaxhydro.waves.sea_state import peak_period
from jaxhydro.waves.spectra import jonswap

RNG = np.random.default_rng(20)
STEP = 0.25
TIMES = 100.0 + STEP * np.arange(4 * 3600)  # an hour
NOISE = RNG.normal(size=TIMES.size)


def narrow(count: int, seed: int, width: float) -> np.ndarray:
    """A periodic Gaussian process of about unit variance, white within `width` (Hz) of 0.1 Hz and nothing elsewhere."""
    frequency = np.fft.rfftfreq(count, STEP)
    inside = np.abs(frequency - 0.1) < width
    draws = np.random.default_rng(seed).normal(size=(2, inside.sum()))
    spectrum = np.zeros(frequency.shape, complex)
    spectrum[inside] = (draws[0] + 1j * draws[1]) * count / (2 * math.sqrt(inside.sum()))
    return np.fft.irfft(spectrum, count)


# spectra and bands


@pytest.mark.parametrize("count", [14400, 14399])
def test_parseval(count: int) -> None:
    """The raw periodogram of the whole record integrates to its variance exactly: even and odd lengths."""
    time, x = TIMES[:count], NOISE[:count] + 5.0
    spectrum = power_spectrum(time, x, segment=3600.0)
    assert spectrum.segments == 1 and spectrum.resolution == pytest.approx(1 / (count * STEP))
    assert spectrum.density.sum() * spectrum.frequency[1] == pytest.approx(x.var(), rel=1e-12)
    assert band_integral(spectrum, 0.0, 2.0) == pytest.approx(x.var(), rel=1e-12)
    pieces = [band_integral(spectrum, a, a + 0.1) for a in np.arange(20) * 0.1]
    assert sum(pieces) == pytest.approx(x.var(), rel=1e-12)


@pytest.mark.parametrize("count", [14400, 14399])
def test_a_band_is_taken_out_without_moving_it(count: int) -> None:
    """A wave of a whole number of periods in the band stays as it is, one outside goes; bands add up, and have the energy."""
    time, span = TIMES[:count], count * STEP
    slow, fast = (np.cos(2 * math.pi * cycles / span * time + 0.3) for cycles in (36, 360))
    assert_allclose(band_pass(time, 2.0 + slow + fast, 0.005, 0.025), slow, atol=1e-12)
    edge = 359.5 / span  # between two lines
    parts = [band_pass(time, NOISE[:count], low, high) for low, high in ((0.0, edge), (edge, 2.0))]
    assert_allclose(sum(parts), NOISE[:count], atol=1e-12)
    raw = power_spectrum(time, NOISE[:count], segment=3600.0)
    assert parts[1].var() == pytest.approx(band_integral(raw, edge, 2.0), rel=1e-9)
    with pytest.raises(ValueError, match=r"0 <= low < high, found 0\.2 and 0\.1 Hz"):
        band_pass(time, NOISE[:count], 0.2, 0.1)


def test_white_noise_is_flat() -> None:
    """Density 2 sigma^2 dt; the scatter of a mean over 6 half-overlapped Hann segments is about 1/sqrt(6 * 36/19 / 2).

    A seventh segment reaches the end of the record.
    """
    spectrum = power_spectrum(TIMES, NOISE)
    assert spectrum.segments == 7 and spectrum.frequency[1] == pytest.approx(0.001)
    assert spectrum.resolution == pytest.approx(0.0015, rel=1e-3)  # Hann: 1.5 bins
    level = spectrum.density[5:-5]
    assert level.mean() == pytest.approx(2 * STEP, rel=0.03)
    assert level.std() / level.mean() == pytest.approx(0.42, rel=0.1)


def test_a_short_record_has_one_segment() -> None:
    """Shorter than the default segment: its raw periodogram."""
    spectrum = power_spectrum(TIMES[:1000], NOISE[:1000])
    assert spectrum.segments == 1
    assert band_integral(spectrum, 0.0, 2.0) == pytest.approx(NOISE[:1000].var(), rel=1e-12)


@pytest.mark.parametrize("duration", [1000.5, 1250.0, 1499.0, 1700.0, 3600.0])
def test_segments_reach_the_end_of_the_record(duration: float) -> None:
    """A burst at the end is in the spectrum, and in its quadratic form alike."""
    count = round(duration / STEP)
    x = np.where(np.arange(count) > 0.97 * count, np.cos(2 * math.pi * 0.1 * STEP * np.arange(count)), 0.0)
    spectrum = power_spectrum(TIMES[:count], x)
    weights = band_weights(count, STEP, 0.05, 0.15)
    assert spectrum.segments == len(weights.starts)
    assert count - (weights.starts[-1] + len(weights.window)) < spectrum.segments
    energy = band_integral(spectrum, 0.05, 0.15)
    assert energy > 0 and weights.integral(x) == pytest.approx(energy, rel=1e-9)


def test_two_segments_that_are_almost_one_make_no_coherence() -> None:
    with pytest.raises(ValueError, match="two segments or more expected"):
        transfer_function(TIMES[:4800], NOISE[:4800], NOISE[4800:9600], segment=1000.0)


@pytest.mark.parametrize("segment, error", [(None, 1e-3), (300.0, 2e-3), (3600.0, 1e-3)])
def test_energy_of_a_sine(segment: float | None, error: float) -> None:
    """a^2/2 in the band that holds it, next to nothing in another."""
    x = 3.0 * np.cos(2 * math.pi * 0.1 * TIMES + 0.4) + 7.0
    spectrum = power_spectrum(TIMES, x, segment=segment)
    assert band_integral(spectrum, 0.06, 0.15) == pytest.approx(4.5, rel=error)
    assert band_integral(spectrum, 0.02, 0.055) < 1e-4


def test_fractions_of_cells() -> None:
    """A constant density: the integral is the width, wherever the limits fall among the frequencies."""
    spectrum = PowerSpectrum(np.arange(101) * 0.01, np.full(101, 2.0), 1, 0.01)
    for low, high in ((0.1, 0.3), (0.103, 0.1047), (0.0951, 0.5555), (0.02, 0.9)):
        assert band_integral(spectrum, low, high) == pytest.approx(2 * (high - low), rel=1e-12)


def test_bands_of_the_paper() -> None:
    """Surge 0.005 to 0.025, heave and pitch 0.02 to 0.055, waves 0.06 or, in the higher sea, 0.05 to 0.15 Hz."""
    assert bands("surge", 8.96) == {"low_frequency": (0.005, 0.025), "wave_frequency": (0.06, 0.15)}
    assert bands("heave", 8.96) == bands("pitch", 8.96) == bands("roll", 8.96)
    assert bands("pitch", 8.96)["low_frequency"] == BANDS["heave"] == (0.02, 0.055)
    assert bands("surge", 12.8)["wave_frequency"] == (0.05, 0.15)


# transfer functions


def oscillator() -> tuple[np.ndarray, np.ndarray, float, float]:
    """White force on x'' + 2 zeta w x' + w^2 x = w^2 f, solved exactly for a force linear between samples."""
    zeta, omega = 0.15, 2 * math.pi * 0.12
    system = signal.StateSpace([[0, 1], [-(omega**2), -2 * zeta * omega]], [[0], [omega**2]], [[1, 0]], [[0]])
    force = signal.sosfiltfilt(signal.butter(6, 0.5, fs=1 / STEP, output="sos"), NOISE)
    _, motion, _ = signal.lsim(system, force, TIMES - TIMES[0], interp=True)
    return force, motion, zeta, omega


def test_response_of_a_linear_oscillator() -> None:
    """1/(1 - r^2 + 2 i zeta r): amplitude and phase (a lag is negative), coherence 1, from one hour."""
    force, motion, zeta, omega = oscillator()
    transfer = transfer_function(TIMES, force, motion, segment=400.0)
    near = (transfer.frequency > 0.02) & (transfer.frequency < 0.3)
    r = 2 * math.pi * transfer.frequency[near] / omega
    exact = 1 / (1 - r**2 + 2j * zeta * r)
    measured = transfer.amplitude[near] * np.exp(1j * transfer.phase[near])
    assert np.abs(measured - exact).max() < 0.03 * np.abs(exact).max()
    assert transfer.coherence[near].min() > 0.99
    assert np.all(transfer.phase[near] < 0)


def test_noise_on_the_motion_lowers_coherence_and_not_the_estimate() -> None:
    """H1 is unbiased by noise on the motion; coherence falls to S_x/(S_x + S_n)."""
    force, motion, zeta, omega = oscillator()
    noise = np.random.default_rng(8).normal(size=TIMES.size) * 0.4
    transfer = transfer_function(TIMES, force, motion + noise, segment=100.0)
    near = (transfer.frequency > 0.05) & (transfer.frequency < 0.1)
    r = 2 * math.pi * transfer.frequency[near] / omega
    exact = 1 / np.abs(1 - r**2 + 2j * zeta * r)
    assert (transfer.amplitude[near] / exact).mean() == pytest.approx(1.0, abs=0.05)
    share = exact**2 / (exact**2 + 0.4**2)  # force and noise are white, of density 2 dt and 0.4^2 2 dt
    assert transfer.coherence[near].mean() == pytest.approx(share.mean(), abs=0.05)
    unrelated = transfer_function(TIMES, force, noise, segment=100.0)
    assert unrelated.coherence[near].mean() < 0.06


def test_a_wave_that_lags() -> None:
    """Motion a quarter of a period later than the wave: phase -pi/2. No wave at all: NaN, not a number made up."""
    wave = narrow(TIMES.size, 1, 0.004)
    motion = 2.0 * np.roll(wave, 10)
    transfer = transfer_function(TIMES, wave, motion)
    peak = np.argmin(np.abs(transfer.frequency - 0.1))
    assert transfer.amplitude[peak] == pytest.approx(2.0, rel=0.02)
    assert transfer.phase[peak] == pytest.approx(-math.pi / 2, abs=0.03)
    assert np.all(np.isnan(transfer_function(TIMES, 0 * wave, motion).amplitude))


# statistics


def test_statistics_of_a_sine() -> None:
    """Mean, a/sqrt(2), extremes, skewness 0, kurtosis 3/2, its period, its double amplitude."""
    x = 3.0 * np.cos(2 * math.pi * TIMES / 8.0) + 7.0
    result = statistics(TIMES, x)
    assert_allclose(result, [7.0, 3 / math.sqrt(2), 4.0, 10.0, 0.0, 1.5, 8.0, 6.0], rtol=1e-6, atol=1e-9)


def test_statistics_of_a_gaussian_process() -> None:
    """Skewness 0, kurtosis 3, a zero-crossing period of 1/frequency, and a significant double amplitude of 4.004 sigma."""
    times = STEP * np.arange(4 * 3600 * 30)
    result = statistics(times, narrow(times.size, 2, 0.01))
    assert abs(result.skewness) < 0.05 and result.kurtosis == pytest.approx(3.0, abs=0.2)
    assert result.zero_crossing_period == pytest.approx(10.0, rel=0.01)
    assert result.significant_double_amplitude == pytest.approx(4.004 * result.standard_deviation, rel=0.02)


def test_statistics_of_a_line() -> None:
    """No crossings: no waves; nothing varies: no shape."""
    result = statistics(TIMES, TIMES)
    assert result.skewness == pytest.approx(0.0, abs=1e-9) and result.kurtosis == pytest.approx(1.8, rel=1e-3)
    assert math.isnan(result.zero_crossing_period) and math.isnan(result.significant_double_amplitude)
    still = statistics(TIMES, np.full(TIMES.size, 2.0))
    assert still.mean == 2.0 and still.standard_deviation == 0.0 and math.isnan(still.kurtosis)
    assert exceedance(TIMES, TIMES).amplitude.size == 0


def test_exceedance_of_a_narrow_band_process() -> None:
    """Rayleigh: the share of peaks above each level within the scatter of 10,800 peaks; plotting position i/(n + 1)."""
    times = STEP * np.arange(4 * 3600 * 30)
    result = exceedance(times, narrow(times.size, 3, 0.01))
    n = len(result.amplitude)
    assert n == pytest.approx(10800, rel=0.01)
    assert np.all(np.diff(result.amplitude) >= 0) and result.amplitude[0] > 0
    assert_allclose(result.probability[[0, -1]], [n / (n + 1), 1 / (n + 1)])
    # neighbouring peaks are alike: of independent ones there are as many as the band has frequencies, a fifth
    assert np.abs(result.probability - result.rayleigh).max() < 1.6 / math.sqrt(n / 5)
    level = np.searchsorted(result.amplitude, 2.0)
    assert result.probability[level] == pytest.approx(math.exp(-2.0), rel=0.1)


def test_peaks_of_two_waves() -> None:
    """Crests of 1 and 3 m in turn, troughs of 2 m: one peak for each upward crossing."""
    x = np.tile(
        np.concatenate(
            [
                [1.0, 3.0][i] * np.sin(np.linspace(0, math.pi, 21)[:-1])
                if j == 0
                else -2.0 * np.sin(np.linspace(0, math.pi, 21)[:-1])
                for i in (0, 1)
                for j in (0, 1)
            ]
        ),
        20,
    )
    result = exceedance(np.arange(x.size), x)
    assert_allclose(np.unique(result.amplitude.round(9)), [1.0, 3.0])
    assert_allclose(np.unique(exceedance(np.arange(x.size), -x).amplitude.round(9)), [2.0])


# what cannot be


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: power_spectrum(np.delete(TIMES, 5), NOISE[1:]), "evenly sampled times expected"),
        (lambda: statistics(np.delete(TIMES, 5), NOISE[1:]), "evenly sampled times expected"),
        (lambda: power_spectrum(TIMES, NOISE[1:]), "a value for each of 14400 times expected"),
        (lambda: power_spectrum(TIMES, np.where(TIMES > 3690, np.nan, 1.0)), "values are numbers, found 39 of 14400"),
        (lambda: power_spectrum(TIMES, NOISE, segment=0.5), "a segment of 1 s or more, .* found 0.5 s"),
        (lambda: power_spectrum(TIMES, NOISE, overlap=1.0), "0 <= overlap < 1 expected, found .* and 1"),
        (lambda: transfer_function(TIMES, NOISE, NOISE, segment=3000.0), "two segments or more expected"),
        (lambda: transfer_function(TIMES, NOISE, NOISE[1:]), "a value for each"),
        (lambda: band_integral(power_spectrum(TIMES, NOISE), 0.2, 0.1), "0 <= low < high, found 0.2 and 0.1 Hz"),
        (lambda: bands("yaw", 9.0), "found 'yaw'"),
        (lambda: bands("wave", 9.0), "found 'wave'"),
        (lambda: bands("surge", 0.0), "peak_period is above 0 s, found 0"),
    ],
)
def test_errors_say_what_was_expected(call, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        call()


def test_peak_period_of_a_record() -> None:
    """That of the spectrum that a record was drawn from, within a band, and to a hundredth of a regular wave."""
    water, step = Environment(1025.0, 200.0, 9.81), 0.5
    waves = spectrum_components(lambda w: jonswap(w, 3.0, 10.0), 3600.0, water, low=0.03, cutoff=0.3, seed=2)
    sea = np.asarray(IrregularSea(waves, water, 1).gauge(np.arange(0.0, 3600.0, step)))
    frequency = np.arange(0.03, 0.3, 0.001)
    drawn = peak_period(frequency, np.asarray(jonswap(2 * np.pi * frequency, 3.0, 10.0)))
    assert record_peak_period(sea, step) == pytest.approx(drawn, rel=0.02) and drawn == pytest.approx(10.0, rel=0.06)
    regular = np.sin(2 * np.pi / 12.3 * step * np.arange(2000))
    assert record_peak_period(regular, step) == pytest.approx(12.3, rel=0.01)
    slow = 5 * np.sin(2 * np.pi / 100 * step * np.arange(2000))
    assert record_peak_period(slow, step) > 90
    assert record_peak_period(regular + slow, step, 0.03, 0.3) == pytest.approx(12.3, rel=0.01)
    with pytest.raises(ValueError, match="expected waves from 0 to inf Hz, found none"):
        record_peak_period(np.zeros(100), step)


def test_channels_with_bands() -> None:
    assert set(bands_of("wave", 9.0)) == {"wave_frequency"}
    assert set(bands_of("roll", 9.0)) == {"low_frequency", "wave_frequency"}
    assert bands_of("yaw", 9.0) == bands_of("line1", 9.0) == {}
