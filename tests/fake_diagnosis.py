"""A diagnosis without a search: decays and a sea of formulas, one with friction that the declared model lacks."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np

from calibration.discovery.diagnosis import Diagnosis, Effect, Evidence, Finding, Rejected, Score
from calibration.result import BandError, Calibration, Estimate, Series, TestFit


def estimate(label: str, value: float, sd: float | None, unit: str, start: float, meaning: str = "a coefficient") -> Estimate:
    return Estimate(label, value, sd, unit, meaning, start, False, sd is not None)


def series(channel: str, measured: np.ndarray, left: np.ndarray, noise: float, scored: bool, offset: float = 0.0) -> Series:
    return Series(channel, measured, measured - left, offset, noise, scored)


def decay(id: str, use: str, channel: str, period: float, amplitude: float, left: float) -> TestFit:
    """`left`: size of the residual over the amplitude."""
    rng = np.random.default_rng(len(id) + ord(id[-1]))
    time = np.arange(0.0, 12 * period, 0.5)
    angle = 2 * np.pi * time / period
    measured = amplitude * (np.exp(-0.03 * angle) - 0.01) * np.cos(angle)
    noise = 0.004 * amplitude
    white = noise * rng.standard_normal((2, len(time)))
    wrong = left * amplitude * np.sin(angle) * np.exp(-0.02 * angle)
    rows = (series(channel, measured + white[0], wrong + white[0], noise, True, 0.1 * left),
            series("heave" if channel != "heave" else "pitch", 0.05 * measured + white[1], white[1], noise, False))  # fmt: skip
    start = {one.channel: one.measured - 4 * wrong for one in rows}
    return TestFit(id, use, "decay", channel, time, rows, start, f"{id}.csv")


def sea(id: str, use: str, left: float) -> TestFit:
    rng = np.random.default_rng(ord(id[-1]))
    time = np.arange(0.0, 3600.0, 0.5)
    frequency = np.fft.rfftfreq(len(time), 0.5)

    def coloured(peak: float, width: float) -> np.ndarray:
        lines = rng.standard_normal((2, len(frequency))) * np.exp(-(((frequency - peak) / width) ** 2))
        x = np.fft.irfft(lines[0] + 1j * lines[1], len(time))
        return x / x.std()

    rows, bands = [], {}
    for channel, size, low in (("surge", 2.0, 0.012), ("heave", 0.6, 0.04), ("pitch", 0.02, 0.035)):
        slow, fast = coloured(low, 0.006), coloured(0.1, 0.02)
        noise = 0.01 * size
        white = noise * rng.standard_normal(len(time))
        measured = size * (slow + 0.5 * fast) + white
        rows.append(series(channel, measured, left * size * slow + 0.05 * size * fast + white, noise, True))
        slower, faster = BandError(-2 * left, -0.6, 0.5 * low, 2 * low), BandError(-0.1, -0.3, 0.06, 0.15)
        bands[channel] = {"low_frequency": slower, "wave_frequency": faster}
    start = {one.channel: 0.5 * one.measured for one in rows}
    return TestFit(id, use, "irregular", None, time, tuple(rows), start, f"{id}.csv", bands)


def calibrated(parameters: list[Estimate], left: float, converged: bool) -> Calibration:
    tests = (
        decay("surge-1", "fit", "surge", 100.0, 8.0, left), decay("surge-2", "fit", "surge", 100.0, 3.0, 1.6 * left),
        decay("heave-1", "fit", "heave", 17.0, 2.0, 0.003), decay("pitch-1", "fit", "pitch", 26.0, 0.05, 0.3 * left),
        sea("sea-1", "fit", 1.5 * left), decay("surge-3", "holdout", "surge", 100.0, 5.0, 1.2 * left),
        sea("sea-2", "holdout", 1.8 * left),
    )  # fmt: skip
    model: Any = SimpleNamespace(loads=())
    found = {one.label: one for one in parameters}
    return Calibration("basin", model, found, tests, converged, 9, 12.0, (2.0, 0.9), ("a note of the fit",), "hull")


def findings(fitted: Calibration, size: float) -> tuple[Finding, ...]:
    found, rng = [], np.random.default_rng(0)
    for test in fitted.tests:
        edges = np.concatenate([[0.0], np.geomspace(2 / test.time[-1], 0.3, 10)])
        for one in test.series:
            if one.scored:
                peak = size * np.exp(-((np.log(edges[1:] / 0.012)) ** 2)) * (one.channel == "surge")
                ratios = 1 + peak + 0.2 * rng.random(10)
                bands = tuple(zip(edges[:-1].tolist(), edges[1:].tolist(), ratios.tolist()))
                rms = float(np.std(one.measured - one.simulated))
                words = f"{one.channel} at 0.01 Hz, in phase with velocity" if one.channel == "surge" else "white at the noise"
                found.append(Finding(test.id, test.use, one.channel, rms, one.noise, one.relative, bands, words))
    return tuple(found)


def fake_diagnosis(converged: bool = True, **changes: Any) -> Diagnosis:
    """Friction in surge is found; one coefficient is not determined before."""
    force = estimate("coulomb_friction.surge.force", 81000.0, 2100.0, "N", 0.0, "dry friction in surge, whatever the speed")
    damping = [estimate("linear_damping.B11", v, sd, "N s/m", 5e4) for v, sd in ((9.1e4, 3e3), (4.4e4, 1.5e3))]
    lost = estimate("column.Cd_z", 2.0, None, "-", 2.0)
    before = calibrated([estimate("column.Ca_t", 1.21, 0.04, "-", 1.0), damping[0], lost], 0.08, True)
    after = calibrated([estimate("column.Ca_t", 1.48, 0.03, "-", 1.0), damping[1], lost, force], 0.01, converged)
    effect = Effect(
        "coulomb_friction", "surge", "Dry friction: the same force at all speeds", "Den Hartog 1931", {force.label: force},
        Evidence(812.0, 604.0, 0.61, 38.6), 0.93, ("hysteresis (surge)",), "a static pull-out in surge",
    )  # fmt: skip
    names = [("coulomb_friction", "surge"), ("hysteresis", "surge"), ("quadratic_damping", "surge"), ("cubic_damping", "pitch"),
             ("mass_properties", None), ("nonlinear_hydrostatics", "heave"), ("sensor_reference", None),
             ("radiation_memory", "surge"), ("umbilical", None), ("current", None)]  # fmt: skip
    scores = tuple(
        Score(n, *name, gain=(812.0 if n == 1 else 9.0) * 0.5**i - (i == 9) * 5, size=1, holdout=100.0 * 0.5**i,
              refitted=(640.0 if n == 1 else 7.0) * 0.5**i if i - n < 1 else None, refitted_holdout=50.0 if i < 2 else None)
        for n in (1, 2) for i, name in enumerate(names) if not (n == 2 and i == 0)
    )  # fmt: skip
    made = Diagnosis(
        "basin", "found", before, after, (effect,),
        (Rejected("current", None, "held-out error grew by 2 %"),
         Rejected("hysteresis", "surge", "explains no more than friction")),
        scores, findings(before, 40.0), findings(after, 2.0), 0.04, "white at the declared noise level",
        "a static pull-out in surge", ("surge-2 repeats surge-1 to 3 %",), 321.0,
    )  # fmt: skip
    return replace(made, **changes)
