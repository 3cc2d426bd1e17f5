"""Spectra against closed forms and quadrature; components against the sums, statistics and records that they stand for."""

import math
from itertools import pairwise

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import complex_amplitude, one_program
from scipy.integrate import quad
from scipy.stats import kstest

from jaxhydro.environment import Environment
from jaxhydro.waves import spectra
from jaxhydro.waves.components import Components
from jaxhydro.waves.dispersion import wavenumber
from jaxhydro.waves.irregular import repeat_period, spectrum_components
from jaxhydro.waves.pair_sums import elevation_spectrum
from jaxhydro.waves.record_harmonics import sampling_interval
from jaxhydro.waves.recorded_waves import record_components, separated_record
from jaxhydro.waves.spectral_moments import moments
from jaxhydro.waves.spreading import spreading

WATER = Environment(1025.0, 200.0, 9.81)
BASIN = Environment(1025.0, 60.0, 9.81)
HS, TP = 3.1, 8.96  # the paper's sea
second_order = eqx.filter_jit(elevation_spectrum)


def sea(omega):
    return spectra.jonswap(omega, HS, TP)


def drawn(**options) -> Components:
    options = {"low": 0.03, "cutoff": 0.35, "seed": 1} | options
    return spectrum_components(options.pop("spectrum", sea), options.pop("duration", 1000.0), WATER, **options)


def elevation(waves: Components, times: np.ndarray, x: float = 0.0, y: float = 0.0) -> np.ndarray:
    """The direct sum, in NumPy."""
    a, omega, k, heading, phase = (np.asarray(v) for v in jax.tree.leaves(waves))
    shift = phase - k * (x * np.cos(heading) + y * np.sin(heading))
    return np.cos(np.outer(times, omega) + shift) @ a


# spectra


@pytest.mark.parametrize("gamma, error", [(1.0, 1e-9), (3.3, 0.0025), (5.0, 1e-5), (2.0, 0.0033), (7.0, 0.018)])
def test_energy_of_a_jonswap_spectrum(gamma: float, error: float) -> None:
    """m0 = Hs^2/16 by scipy's quad, as near as the docstring says."""
    peak = 2 * math.pi / TP
    spectrum = jax.jit(lambda w: spectra.jonswap(w, HS, TP, gamma))
    limits = (0.0, 0.5 * peak, peak, 2 * peak, 6 * peak)
    pieces = [quad(lambda w: float(spectrum(w)), a, b, epsabs=1e-12)[0] for a, b in pairwise(limits)]
    tail = HS**2 / 16 * (1 - 0.287 * math.log(gamma)) * -math.expm1(-1.25 / 6**4)
    assert sum(pieces) + tail == pytest.approx(HS**2 / 16, rel=error)


def test_the_normalisation_over_all_enhancements() -> None:
    """The docstring's -0.33 % to +0.29 % for gamma from 1 to 5."""
    x = np.linspace(0.2, 60.0, 600_001)
    ratio = []
    for gamma in (1.2, 1.4, 1.6, 2.0, 3.0, 3.5, 3.9, 4.2, 5.0):
        ratio.append(float(jnp.trapezoid(spectra.jonswap(jnp.asarray(x), 4.0, 2 * math.pi, gamma), x)))
    assert min(ratio) == pytest.approx(1 - 0.0033, abs=2e-4) and max(ratio) == pytest.approx(1 + 0.0029, abs=2e-4)


@pytest.mark.parametrize("gamma", [1.0, 3.3, None])
def test_the_peak_is_at_the_peak_period(gamma: float | None) -> None:
    """dS/domega = 0 at 2 pi/Tp, S falls on both sides; and PM = JONSWAP of gamma 1."""
    peak = 2 * math.pi / TP
    assert abs(float(jax.grad(lambda w: spectra.jonswap(w, HS, TP, gamma))(peak))) < 1e-10
    omega = jnp.linspace(0.1, 2.0, 1901)
    values = spectra.jonswap(omega, HS, TP, gamma)
    assert float(omega[jnp.argmax(values)]) == pytest.approx(peak, abs=1e-3)
    if gamma == 1.0:
        assert_allclose(values, spectra.pierson_moskowitz(omega, HS, TP), rtol=1e-14)


def test_pierson_moskowitz_in_closed_form() -> None:
    """Moments of A w^-5 exp(-B w^-4), B = 5/4 wp^4: m2 = A/4 sqrt(pi/B), m1 = A Gamma(3/4)/(4 B^(3/4)) ..."""
    peak = 2 * math.pi / TP
    a, b = 5 / 16 * HS**2 * peak**4, 1.25 * peak**4
    omega = jnp.linspace(0.0, 60.0, 600_001)
    spectral_moments = moments(omega, spectra.pierson_moskowitz(omega, HS, TP))
    assert float(spectral_moments.significant_height) == pytest.approx(HS, rel=1e-6)
    assert float(spectral_moments.two) == pytest.approx(a / 4 * math.sqrt(math.pi / b) - a / (2 * 60**2), rel=1e-7)
    assert float(spectral_moments.one) == pytest.approx(a / 4 * math.gamma(0.75) * b**-0.75, rel=1e-5)
    assert float(spectral_moments.minus_one) == pytest.approx(a / 4 * math.gamma(1.25) * b**-1.25, rel=1e-7)
    assert float(spectral_moments.zero_crossing_period) == pytest.approx(TP * (4 / (5 * math.pi)) ** 0.25, rel=2e-3)
    assert float(spectral_moments.energy_period) == pytest.approx(0.857 * TP, rel=1e-3)
    assert float(spectral_moments.mean_period) == pytest.approx(0.772 * TP, rel=1e-3)


def test_default_enhancement() -> None:
    """IEC: 5, exp(5.75 - 1.15 Tp/sqrt(Hs)), 1; FOCAL's sea, Tp/sqrt(Hs) = 5.09, is a Pierson-Moskowitz one."""
    assert float(spectra.peak_enhancement(9.0, 3.0 * 3.5)) == pytest.approx(5.0, rel=1e-15)
    assert float(spectra.peak_enhancement(9.0, 3.0 * 4.2)) == pytest.approx(math.exp(5.75 - 1.15 * 4.2))
    assert float(spectra.peak_enhancement(9.0, 3.0 * 5.5)) == 1.0
    assert float(spectra.peak_enhancement(HS, TP)) == 1.0


def test_spectra_are_differentiable_everywhere() -> None:
    """dS/dHs = 2 S/Hs at a given gamma; nothing undefined at omega = 0, nor in dS/dTp against central differences."""
    omega = np.array([0.0, 1e-9, 1e-3, 0.05, 0.4, 0.7, 1.3, 30.0])
    density = one_program(spectra.jonswap)
    slope = one_program(jax.jacfwd(spectra.jonswap, (1, 2)))(omega, HS, TP, 2.0)
    assert_allclose(slope[0], 2 * np.asarray(density(omega, HS, TP, 2.0)) / HS, rtol=1e-13)
    step = 1e-5
    high, low = (np.asarray(density(omega, HS, TP + sign * step, 2.0)) for sign in (1, -1))
    assert_allclose(slope[1], (high - low) / (2 * step), rtol=1e-6, atol=1e-10)
    assert np.isfinite(one_program(jax.vmap(jax.grad(spectra.jonswap)))(omega, np.full(8, HS), np.full(8, TP))).all()


def test_white_noise_and_tables() -> None:
    """m0 = Hs^2/16; straight lines between values, nothing outside."""
    omega = jnp.linspace(0.0, 2.0, 200_001)
    spectral_moments = moments(omega, spectra.white_noise(omega, 4.0, 0.3, 1.2))
    assert float(spectral_moments.significant_height) == pytest.approx(4.0, rel=1e-4)
    table = spectra.tabulated(jnp.array([0.1, 0.5, 0.75, 1.0, 1.1]), jnp.array([0.5, 1.0]), jnp.array([2.0, 4.0]))
    assert_allclose(table, [0, 2, 3, 4, 0])


@pytest.mark.parametrize("s", [0.0, 2.5, 30.0])
def test_spreading_integrates_to_one(s: float) -> None:
    """Periodic rectangle rule: integral 1, mean resultant s/(s + 1), mean heading as given."""
    heading = np.linspace(-math.pi, math.pi, 4001)[:-1]
    weight = np.asarray(spreading(heading, 0.4, s)) * (heading[1] - heading[0])
    assert weight.sum() == pytest.approx(1.0, rel=1e-12)
    assert_allclose(weight @ np.exp(1j * heading), s / (s + 1) * np.exp(0.4j), atol=1e-12)


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: spectra.jonswap(1.0, -1.0, 9.0), "significant_height is above 0 m, found -1"),
        (lambda: spectra.jonswap(1.0, 1.0, 0.0), "peak_period is above 0 s, found 0"),
        (lambda: spectra.pierson_moskowitz(1.0, float("nan"), 9.0), "significant_height is above 0 m"),
        (lambda: spectra.jonswap(1.0, 1.0, 9.0, 9.0), "peak_enhancement lies from 1 to 7, found 9"),
        (lambda: spectra.white_noise(1.0, 1.0, 0.5, 0.5), "0 <= low < high"),
        (lambda: spectra.tabulated(1.0, [1.0, 0.5], [1.0, 1.0]), "ascend"),
        (lambda: spectra.tabulated(1.0, [0.5, 1.0], [1.0, -1.0]), "not negative, found -1"),
        (lambda: spectra.tabulated(1.0, [0.5, 1.0], [1.0]), "shapes"),
        (lambda: spreading(0.0, 0.0, -1.0), "not negative"),
    ],
)
def test_spectra_that_cannot_be(call, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        call()


# components of a spectrum


@pytest.mark.parametrize("duration, period", [(10800, 10800), (3601, 3645), (0.3, 1), (4399.5, 4500), (2048, 2048)])
def test_repeat_period(duration: float, period: float) -> None:
    assert repeat_period(duration) == period


def test_harmonics_of_a_period() -> None:
    """Successive, both ends of the band included, wavenumbers of the dispersion relation; the period covers the duration."""
    waves = drawn(duration=990.0, low=0.05, cutoff=0.2)
    assert float(waves.period) == pytest.approx(1000.0, rel=1e-14)
    assert waves.first == 50 and waves.omega.shape == (151,)
    assert_allclose(waves.omega, 2 * math.pi * np.arange(50, 201) / 1000, rtol=1e-14)
    assert_allclose(waves.wavenumber, wavenumber(waves.omega, jnp.asarray(200.0), jnp.asarray(9.81)), rtol=1e-14)
    assert all(isinstance(leaf, jax.Array) for leaf in jax.tree.leaves(waves))


def test_variance_of_the_elevation() -> None:
    """Over a period the direct sum has the variance sum of S d_omega, to rounding: Hs less what lies outside the band."""
    waves = drawn()
    times = np.arange(0.0, 1000.0, 0.5)
    inside = float(jnp.sum(sea(waves.omega)) * 2 * math.pi / 1000)
    assert elevation(waves, times, 12.0, 5.0).var() == pytest.approx(inside, rel=1e-12)
    assert 0.97 * HS < 4 * math.sqrt(inside) < HS


def test_nothing_repeats_within_the_duration() -> None:
    """No later 100 s look like the first 100 s before a whole period has passed; then they are the same."""
    waves = drawn(duration=950.0)
    eta = elevation(waves, np.arange(0.0, 1060.0, 0.5))
    windows = np.lib.stride_tricks.sliding_window_view(eta, 200)
    likeness = windows @ eta[:200] / (np.linalg.norm(windows, axis=1) * np.linalg.norm(eta[:200]))
    assert likeness[20:1900].max() < 0.8
    assert_allclose(eta[1920:], eta[:200], atol=1e-9)  # 960 s = 2^6 3 5


def test_seeds() -> None:
    """The same seed gives the same sea, another another; bands and options leave each other's draws as they are."""
    sea = drawn()
    assert eqx.tree_equal(sea, drawn())
    assert not np.allclose(sea.phase, drawn(seed=2).phase)
    wider = drawn(low=0.02, cutoff=0.5)
    start = sea.first - wider.first
    assert_allclose(wider.phase[start : start + len(sea.phase)], sea.phase, rtol=0)
    varied = drawn(amplitudes="rayleigh", spreading=8.0)
    assert_allclose(varied.phase, sea.phase, rtol=0)
    assert_allclose(drawn(amplitudes="rayleigh").amplitude, varied.amplitude, rtol=0)
    assert np.abs(np.asarray(sea.phase)).max() <= math.pi


def test_phases_are_uniform_and_amplitudes_rayleigh() -> None:
    """Kolmogorov-Smirnov on 12,000 draws over seeds; mean square 2 S d_omega; energy of a sea scatters as it should."""
    mean_square = 2 * np.asarray(sea(drawn().omega)) * 2 * math.pi / 1000
    seas = [drawn(seed=seed, amplitudes="rayleigh") for seed in range(40)]
    phases = np.concatenate([waves.phase for waves in seas])
    assert kstest(phases, "uniform", args=(-math.pi, 2 * math.pi)).pvalue > 0.01
    strong = mean_square > 1e-12
    scaled = np.concatenate([(np.asarray(waves.amplitude) ** 2 / mean_square)[strong] for waves in seas])
    assert kstest(scaled, "expon").pvalue > 0.01
    energy = [0.5 * float(jnp.sum(waves.amplitude**2)) for waves in seas]
    expected = 0.5 * mean_square.sum()
    scatter = 0.5 * math.sqrt((mean_square**2).sum())
    assert np.mean(energy) == pytest.approx(expected, abs=4 * scatter / math.sqrt(40))
    assert np.std(energy) == pytest.approx(scatter, rel=0.4)


@pytest.mark.parametrize("s", [0.0, 3.0, 25.0])
def test_spread_headings(s: float) -> None:
    """One heading for each component: mean resultant s/(s + 1) about the mean heading, and cos^2s by Kolmogorov-Smirnov."""
    waves = drawn(heading=0.7, spreading=s, duration=20000.0)
    headings = np.asarray(waves.heading)
    resultant = np.exp(1j * (headings - 0.7)).mean()
    assert abs(resultant - s / (s + 1)) < 4 / math.sqrt(len(headings))
    grid = np.linspace(-math.pi, math.pi, 20001)
    cumulative = np.cumsum(np.asarray(spreading(grid, 0.0, s))) * (grid[1] - grid[0])
    assert kstest(headings - 0.7, lambda x: np.interp(x, grid, cumulative)).pvalue > 0.01
    assert np.all(np.asarray(drawn(heading=0.7).heading) == 0.7)


def test_a_spread_sea_is_the_same_everywhere() -> None:
    """Jefferys 1987: the variance over a period is the sum of S d_omega wherever the gauge stands."""
    waves = drawn(spreading=5.0)
    times = np.arange(0.0, 1000.0, 1.0)
    variances = [elevation(waves, times, *at).var() for at in ((0, 0), (80, -30), (-400, 900))]
    assert_allclose(variances, variances[0], rtol=1e-11)


@pytest.mark.parametrize(
    "options, message",
    [
        ({"duration": 0.0}, "duration is above 0 s, found 0"),
        ({"duration": float("inf")}, "duration"),
        ({"low": 0.3, "cutoff": 0.1}, "0 <= low < cutoff, found 0.3 and 0.1 Hz"),
        ({"low": -0.1}, "0 <= low"),
        ({"low": 0.1001, "cutoff": 0.1002}, "wider"),
        ({"amplitudes": "random"}, "'deterministic' or 'rayleigh', found 'random'"),
        ({"spreading": -1.0}, "not negative, found -1"),
        ({"spectrum": lambda w: -sea(w)}, "finite and not negative"),
        ({"spectrum": lambda w: 0 * w}, "no energy from 0.03 to 0.35 Hz"),
        ({"spectrum": lambda w: spectra.jonswap(w, 12.0, 6.0)}, r"break above .* found a significant height of 11\.8 m"),
    ],
)
def test_seas_that_cannot_be(options, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        drawn(**options)


# components of a record

TIMES = 35.0 + 0.5 * np.arange(2400)  # 1200 s, on a clock of its own
BAND = {"low": 0.04, "cutoff": 0.2}


def known(environment=WATER, heading: float = 0.5, height: float = HS) -> Components:
    """A sea whose period is the length of the record."""
    return spectrum_components(
        lambda w: spectra.jonswap(w, height, TP), 1200.0, environment, seed=5, heading=heading, amplitudes="rayleigh", **BAND
    )


def nonlinear(waves: Components, environment, at) -> np.ndarray:
    """Elevation of first and second order at `TIMES`."""
    spectrum = np.asarray(second_order(waves, environment, at))
    omega = 2 * math.pi / 1200 * np.arange(len(spectrum))
    return elevation(waves, TIMES, *at) + (np.exp(1j * np.outer(TIMES, omega)) @ spectrum).real


@pytest.mark.parametrize("count", [2400, 2399])
def test_a_linear_record_comes_back(count: float) -> None:
    """Record -> components -> the record less its mean, at a gauge off the origin: to 1e-10 m, odd lengths too."""
    at, times = (37.0, -12.0), TIMES[:count]
    source = spectrum_components(sea, 1200.0, WATER, seed=5, heading=0.5, **BAND)
    scale = 1200 / (count * 0.5)  # the source's harmonics moved to those of the record
    k = wavenumber(scale * source.omega, jnp.asarray(200.0), jnp.asarray(9.81))
    source = Components(source.amplitude, scale * source.omega, k, source.heading, source.phase, source.first)
    record = elevation(source, times, *at)
    waves = record_components(times, record + 0.3, WATER, position=at, heading=0.5, low=0.03, cutoff=0.25, order=1)
    assert_allclose(elevation(waves, times, *at), record, atol=1e-10)
    inner = slice(source.first - waves.first, source.first - waves.first + len(source.omega))
    assert_allclose(np.asarray(complex_amplitude(waves))[inner], complex_amplitude(source), atol=1e-10)
    assert_allclose(elevation(waves, times, 5.0, 6.0), elevation(source, times, 5.0, 6.0), atol=1e-9)


def test_a_band_of_a_record() -> None:
    """What lies outside the band is left out, whole; both limits belong to the band."""
    record = np.cos(2 * math.pi * 0.05 * TIMES) + np.cos(2 * math.pi * 0.1 * TIMES) + np.cos(2 * math.pi * 0.15 * TIMES)
    waves = record_components(TIMES, record, WATER, low=0.05, cutoff=0.1, order=1)
    assert waves.first == 60 and len(waves.omega) == 61
    assert_allclose(waves.amplitude[np.array([0, -1])], 1.0, rtol=1e-10)
    assert_allclose(waves.amplitude[1:-1], 0.0, atol=1e-10)


def test_a_record_that_ends_elsewhere_does_not_ring() -> None:
    """Cut from a longer sea, with noise: near both ends waves are within the noise, and accelerations within 10 %."""
    random = np.random.default_rng(1)
    source = spectrum_components(sea, 2880.0, WATER, seed=8, **BAND)

    def acceleration(waves: Components) -> np.ndarray:
        turn = np.exp(1j * np.outer(TIMES, waves.omega))
        return (turn @ (-(np.asarray(waves.omega) ** 2) * np.asarray(complex_amplitude(waves)))).real

    record = elevation(source, TIMES) + random.normal(0, 0.005, TIMES.size)
    waves = record_components(TIMES, record, WATER, order=1, **BAND)
    clock, true = TIMES - TIMES[0], acceleration(source)
    for ends in (clock < 30, clock > 1170, clock > 1197):
        assert np.std((elevation(waves, TIMES) - elevation(source, TIMES))[ends]) < 0.005
        assert np.std((acceleration(waves) - true)[ends]) < 0.1 * np.std(true)


def test_all_harmonics_give_the_record_whatever_its_ends() -> None:
    """No taper: a record that ends elsewhere than it began is given back at every sample, but for half the sampling rate."""
    record = np.random.default_rng(3).normal(size=301) + np.linspace(0.0, 3.0, 301)
    times = np.arange(301.0)
    waves = record_components(times, record, WATER, low=0.0, cutoff=0.5, order=1)
    assert_allclose(elevation(waves, times), record - record.mean(), atol=1e-10)


@pytest.mark.parametrize("environment", [WATER, BASIN], ids=["deep", "basin"])
def test_the_first_order_part_of_a_nonlinear_record(environment) -> None:
    """First-order amplitudes known beforehand, from a record of first and second order at a gauge off the origin."""
    at, waves = (30.0, 10.0), known(environment)
    record = nonlinear(waves, environment, at)
    separated = separated_record(TIMES, record, environment, position=at, heading=0.5, **BAND)
    size = np.linalg.norm(waves.amplitude)
    assert separated.mismatch < 1e-5 and separated.rounds <= 6
    assert np.linalg.norm(separated.waves.complex_amplitude() - waves.complex_amplitude()) < 1e-4 * size
    linear = record_components(TIMES, record, environment, position=at, heading=0.5, order=1, **BAND)
    assert np.linalg.norm(linear.complex_amplitude() - waves.complex_amplitude()) > 0.015 * size
    tight = record_components(TIMES, record, environment, position=at, heading=0.5, tolerance=1e-8, **BAND)
    assert_allclose(tight.complex_amplitude(), waves.complex_amplitude(), atol=1e-8 * size)


def test_a_record_too_steep_for_second_order() -> None:
    """Where the iteration finds no end it stops, gives its best as a value, and the builder says so."""
    record = 40 * elevation(known(), TIMES)
    separated = separated_record(TIMES, record, WATER, heading=0.5, **BAND)
    assert 1e-4 < separated.mismatch <= 1.5 and separated.rounds <= 30
    assert bool(jnp.isfinite(separated.waves.amplitude).all())
    with pytest.raises(ValueError, match=r"first and second order miss .* Take a cutoff below 0\.2 Hz"):
        record_components(TIMES, record, WATER, heading=0.5, **BAND)


def test_sampling_interval_of_rounded_times() -> None:
    """Times written with three decimals are even."""
    assert sampling_interval(np.round(0.1195 * np.arange(1000), 3)) == pytest.approx(0.1195, rel=1e-5)


@pytest.mark.parametrize(
    "options, message",
    [
        ({"times": np.delete(TIMES, 7)}, "evenly sampled times expected"),
        ({"times": TIMES[::-1]}, "evenly sampled"),
        ({"times": TIMES[:3]}, "four or more times"),
        ({"elevation": np.zeros(5)}, "an elevation for each of 2400 times expected, found shape"),
        ({"elevation": np.where(TIMES > 1000, np.nan, 1.0)}, "found 469 of 2400"),
        ({"elevation": np.ones(2400)}, "no waves from 0.04 to 0.2 Hz"),
        ({"cutoff": 1.2}, "half the sampling rate, 1 Hz, found 1.2 Hz"),
        ({"cutoff": 0.01}, "0 <= low < cutoff"),
        ({"order": 3}, "order: expected 1 or 2, found 3"),
    ],
)
def test_records_that_cannot_be(options, message: str) -> None:
    times, record = options.pop("times", TIMES), options.pop("elevation", None)
    record = np.cos(times) if record is None else record
    with pytest.raises(ValueError, match=message):
        record_components(times, record, WATER, **(BAND | options))
