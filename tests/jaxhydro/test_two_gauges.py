"""Incident and reflected waves from two gauges, against synthetic records made in plain NumPy."""

import dataclasses

import numpy as np
import pytest

import jaxhydro as jh
from jaxhydro.waves.irregular_sea import IrregularSea
from jaxhydro.waves.two_gauges import IncidentAndReflected, incident_and_reflected
from jaxhydro.waves.wave_errors import GaugeSpacingError

WATER = jh.load_model("volturnus-s").environment
STEP, DURATION, HEIGHT, PEAK = 0.5, 1200.0, 3.0, 9.0
TIMES = STEP * np.arange(int(DURATION / STEP))
GAUGES = ((-110.0, 0.0), (-90.0, 0.0))
BAND = {"low": 0.04, "cutoff": 0.25}


class Synthetic:
    """Incident JONSWAP waves and reflected ones, a fixed part of them in height, as sums of cosines.

    `harmonic` False: their frequencies are no harmonics of the record, as in a basin.
    """

    def __init__(self, reflection: float, heading: float = 0.0, harmonic: bool = True) -> None:
        random = np.random.default_rng(3)
        frequency = np.arange(50, 288) / DURATION
        if not harmonic:
            frequency = frequency + random.uniform(0, 1 / DURATION, frequency.size)
        omega, peak = 2 * np.pi * frequency, 2 * np.pi / PEAK
        width = np.where(omega > peak, 0.09, 0.07)
        density = omega**-5.0 * np.exp(-1.25 * (peak / omega) ** 4) * 2.0 ** np.exp(-0.5 * ((omega / peak - 1) / width) ** 2)
        self.amplitude = np.sqrt(density) * HEIGHT / 4 / np.sqrt(0.5 * density.sum())
        self.reflected = reflection * self.amplitude
        self.phase, self.reflected_phase = random.uniform(-np.pi, np.pi, (2, omega.size))
        g, depth, k = float(WATER.gravity), float(WATER.depth), omega**2 / float(WATER.gravity)
        for _ in range(300):
            k = omega**2 / (g * np.tanh(k * depth))
        self.omega, self.k, self.heading = omega, k, heading

    def elevation(self, position: tuple[float, float], times: np.ndarray = TIMES) -> np.ndarray:
        along = position[0] * np.cos(self.heading) + position[1] * np.sin(self.heading)
        angle = np.outer(times, self.omega)
        incident = np.cos(angle - self.k * along + self.phase) @ self.amplitude
        return incident + np.cos(angle + self.k * along + self.reflected_phase) @ self.reflected


def separated(waves: Synthetic, noise: float = 0.0, gauges=GAUGES, **options) -> IncidentAndReflected:
    random = np.random.default_rng(7)
    records = tuple(waves.elevation(at) + noise * random.standard_normal(TIMES.size) for at in gauges)
    how = {"positions": gauges, "heading": waves.heading} | BAND | options
    return incident_and_reflected(TIMES, records, WATER, **how)


def of_train(found: IncidentAndReflected, train: int, synthetic: Synthetic) -> np.ndarray:
    """Complex amplitudes of incident (0) or reflected (1) waves at the frequencies of synthetic ones."""
    amplitude = np.asarray(found.waves.complex_amplitude()).reshape(2, -1)[train]
    index = np.rint(synthetic.omega * DURATION / (2 * np.pi)).astype(int) - found.waves.harmonics[0]
    return amplitude[index]


@pytest.mark.parametrize("heading", [0.0, 0.6])
def test_incident_and_reflected_waves_are_recovered(heading) -> None:
    synthetic = Synthetic(0.2, heading)
    found = separated(synthetic, noise=0.02, gauges=((-110.0, 8.0), (-90.0, -3.0)))
    assert found.significant_heights == pytest.approx((HEIGHT, 0.2 * HEIGHT), rel=0.02)
    assert found.reflection_coefficient == pytest.approx(0.2, rel=0.02)
    incident, reflected = (of_train(found, train, synthetic) for train in (0, 1))
    true_incident = synthetic.amplitude * np.exp(1j * synthetic.phase)
    true_reflected = synthetic.reflected * np.exp(1j * synthetic.reflected_phase)
    frequency = synthetic.omega / (2 * np.pi)
    inside = (frequency >= found.band[0]) & (frequency <= found.band[1])
    assert np.linalg.norm(incident - true_incident) < 0.04 * np.linalg.norm(true_incident)
    assert np.linalg.norm((reflected - true_reflected)[inside]) < 0.1 * np.linalg.norm(true_reflected)
    large = synthetic.amplitude > 0.5 * synthetic.amplitude.max()
    assert np.abs(np.angle(incident / true_incident))[large].max() < np.deg2rad(3.0)
    assert np.abs(np.angle(reflected / true_reflected))[large].max() < np.deg2rad(10.0)
    headings = np.asarray(found.waves.heading).reshape(2, -1)
    assert np.allclose(headings[0], heading) and np.allclose(headings[1], heading + np.pi)


def test_elevation_at_a_third_point_is_predicted() -> None:
    synthetic, third = Synthetic(0.2), (0.0, 0.0)
    expected = synthetic.elevation(third)
    predicted = IrregularSea(separated(synthetic, noise=0.02).waves, WATER).gauge(TIMES, third)
    assert np.std(predicted - expected) < 0.05 * np.std(expected)
    one = jh.record_components(TIMES, synthetic.elevation(GAUGES[0]), WATER, position=GAUGES[0], order=1, **BAND)
    assert np.std(IrregularSea(one, WATER).gauge(TIMES, third) - expected) > 0.2 * np.std(expected)


def test_without_reflection_there_is_none() -> None:
    exact = separated(Synthetic(0.0))
    assert exact.significant_heights[1] < 1e-10 and exact.reflection_coefficient < 1e-10
    noise = 0.05
    noisy = separated(Synthetic(0.0), noise)
    # white noise in the band, amplified by the spacing: a_R = sum exp(-iks) e / (2 sin^2 k ds) without a prior
    k = np.asarray(noisy.waves.wavenumber).reshape(2, -1)[0]
    sine = np.sin(k * 20.0) ** 2
    variance = noise**2 * 2 * STEP / DURATION * (2 * sine / (2 * sine + 0.01) ** 2)
    expected = 4 * np.sqrt(variance.sum())
    assert noisy.significant_heights[1] == pytest.approx(expected, rel=0.1)
    assert noisy.significant_heights[0] == pytest.approx(HEIGHT, rel=0.01)


def test_ends_of_a_record_are_no_reflection() -> None:
    """Frequencies between the harmonics: the records are continued together, and nothing is taken for reflection."""
    synthetic = Synthetic(0.0, harmonic=False)
    found = separated(synthetic, cutoff=0.3)
    assert float(found.waves.period) > DURATION and found.significant_heights[1] < 0.005 * HEIGHT
    assert found.significant_heights[0] == pytest.approx(4 * np.std(synthetic.elevation(GAUGES[0])), rel=0.002)
    middle = slice(int(120 / STEP), -int(120 / STEP))
    predicted = IrregularSea(found.waves, WATER).gauge(TIMES, (0.0, 0.0))
    expected = synthetic.elevation((0.0, 0.0))
    assert np.std((predicted - expected)[middle]) < 2e-3 * np.std(expected)
    reflected = separated(Synthetic(0.2, harmonic=False), cutoff=0.3)
    assert reflected.reflection_coefficient == pytest.approx(0.2, rel=0.1)


def test_band_and_share_outside() -> None:
    synthetic = Synthetic(0.1)
    found = separated(synthetic)
    k = np.array([2 * np.pi * share / 20.0 for share in (0.05, 0.45)])
    limits = np.sqrt(float(WATER.gravity) * k * np.tanh(k * float(WATER.depth))) / (2 * np.pi)
    assert found.band == pytest.approx(tuple(limits))
    frequency = synthetic.omega / (2 * np.pi)
    outside = (synthetic.amplitude**2)[(frequency < limits[0]) | (frequency > limits[1])].sum() / (synthetic.amplitude**2).sum()
    assert found.share_outside == pytest.approx(outside, rel=0.1)


def test_reflected_waves_drive_the_platform_against_the_heading() -> None:
    """Motions in the separated waves are those in the waves that were made, with phases and headings of their own."""
    model, synthetic, band = jh.load_model("volturnus-s"), Synthetic(0.2), {"low": 0.09, "cutoff": 0.12}
    found = separated(synthetic, **band).waves
    frequency = synthetic.omega / (2 * np.pi)
    inside = (frequency >= 0.09 - 1e-9) & (frequency <= 0.12 + 1e-9)
    made = dataclasses.replace(
        found,
        amplitude=np.concatenate([synthetic.amplitude[inside], synthetic.reflected[inside]]),
        phase=np.concatenate([synthetic.phase[inside], synthetic.reflected_phase[inside]]),
        heading=np.repeat([0.0, np.pi], inside.sum()),
    )
    incident = dataclasses.replace(made, amplitude=np.where(np.asarray(made.heading) == 0.0, made.amplitude, 0.0))
    assert np.asarray(found.omega)[: inside.sum()] == pytest.approx(synthetic.omega[inside])
    times = np.arange(0.0, 120.0, 0.5)
    motions = [jh.simulate(model, times, IrregularSea(waves, WATER)) for waves in (found, made, incident)]
    for name in ("surge", "heave", "pitch"):
        of_found, of_made, of_incident = (np.asarray(motion[name]) for motion in motions)
        assert np.abs(of_found - of_made).max() < 0.02 * np.std(of_made), name
        assert np.abs(of_incident - of_made).max() > 0.1 * np.std(of_made), name


@pytest.mark.parametrize(
    ("gauges", "words"),
    [
        (((-90.0, 0.0), (-90.0, 0.0)), "two gauges apart along the waves expected, found 0 m between them"),
        (((-90.0, 0.0), (-90.0, 30.0)), "found 0 m between them"),
        (((-150.0, 0.0), (-90.0, 0.0)), "60 m between them, for 0.0319 to 0.108 Hz, with 24% of the energy"),
        (((-90.5, 0.0), (-90.0, 0.0)), "0.5 m between them, for 0.395 to 1.19 Hz, with 0% of the energy"),
    ],
)
def test_gauges_that_do_not_separate_are_refused(gauges, words) -> None:
    with pytest.raises(GaugeSpacingError) as error:
        separated(Synthetic(0.2), gauges=gauges)
    assert words in str(error.value)


def test_bound_waves_of_both_directions_are_subtracted() -> None:
    """Second order of a few waves: their record at two gauges gives them back."""
    known = separated(Synthetic(0.2), low=0.08, cutoff=0.12).waves
    few = dataclasses.replace(known, amplitude=known.amplitude * 0.8)
    sea = IrregularSea(few, WATER, order=2)
    direct = sea.direct()
    some = TIMES[100:110]
    expected = [float(direct.elevation(time, np.array([[-110.0], [0.0]]))[0]) for time in some]
    np.testing.assert_allclose(sea.gauge(some, (-110.0, 0.0)), expected, atol=1e-9)
    records = tuple(sea.gauge(TIMES, at) for at in GAUGES)
    how = {"positions": GAUGES, "low": 0.08, "cutoff": 0.12}
    second = incident_and_reflected(TIMES, records, WATER, order=2, **how)
    # the prior holds the reflected waves down by the factor that it has without noise
    linear = incident_and_reflected(TIMES, tuple(IrregularSea(few, WATER).gauge(TIMES, at) for at in GAUGES), WATER, **how)
    np.testing.assert_allclose(second.waves.complex_amplitude(), linear.waves.complex_amplitude(), atol=1e-4)
    assert second.rounds > 0 and second.mismatch < 1e-4
