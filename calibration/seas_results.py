"""Errors in waves: band integrals of spectra, measured and simulated, as JSON and as tables."""

import dataclasses
import math
from typing import Any

import numpy as np

import jaxhydro
from calibration.applied import Applied
from calibration.campaign import Campaign
from calibration.formatting import number, percent
from calibration.manifest import IN_WAVES
from calibration.seas import Compared, Options, SeaTest, moving_channels
from calibration.signals import wave_height
from calibration.tables import Rows
from jaxhydro.analysis import BANDS, LONG, SEGMENT, PowerSpectrum, band_integral, bands, power_spectrum
from jaxhydro.environment import DOFS
from jaxhydro.plot import for_people, unit_of

OVERLAP, WINDOW = 0.5, "hann"
WELCH = f"Welch, {WINDOW} segments of {SEGMENT:g} s that overlap by {OVERLAP:.0%}; a shorter record is one, not windowed"
NAMES = {"low_frequency": "low", "wave_frequency": "wave"}


@dataclasses.dataclass(frozen=True)
class Band:
    """Integrals of the spectra (m2 or deg2) from `low` to `high` (Hz)."""

    low: float
    high: float
    measured: float
    simulated: float

    @property
    def error(self) -> float:
        """(simulated - measured) / measured; NaN where nothing was measured."""
        return self.simulated / self.measured - 1 if self.measured > 0 else math.nan


def bands_of(channel: str, peak_period: float) -> dict[str, tuple[float, float]]:
    """Bands (Hz) of a motion or of the wave, which has no low one; none of yaw."""
    if channel == "wave":
        return {"wave_frequency": BANDS["wave, long" if peak_period >= LONG else "wave"]}
    return {} if channel == "yaw" else bands(channel, peak_period)


def channels(test: SeaTest) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Measured and simulated, the wave first, then motions, in m and deg."""
    motions = {s.channel: (for_people(s.channel, s.measured), for_people(s.channel, s.simulated)) for s in test.fit.series}
    return {"wave": (test.wave, test.simulated_wave), **motions}


def density(test: SeaTest, x: np.ndarray) -> PowerSpectrum:
    """Spectrum of a channel."""
    return power_spectrum(test.fit.time, x, SEGMENT, OVERLAP, WINDOW)


def in_bands(test: SeaTest) -> dict[str, dict[str, Band]]:
    """channel -> low_frequency, wave_frequency -> integrals."""
    found: dict[str, dict[str, Band]] = {}
    for name, pair in channels(test).items():
        spectra = [density(test, x) for x in pair]
        limits = bands_of(name, test.peak_period)
        found[name] = {k: Band(*band, *(band_integral(s, *band) for s in spectra)) for k, band in limits.items()}
    return found


def moving(test: SeaTest) -> list[str]:
    """The motions that are worth a line."""
    return moving_channels({series.channel: series.measured for series in test.fit.series})


def amplitude(test: SeaTest, x: np.ndarray) -> float:
    """Amplitude at the period of regular waves, by least squares over whole periods."""
    time = test.fit.time
    whole = max(1.0, math.floor((time[-1] - time[0]) / test.peak_period)) * test.peak_period
    kept = time >= time[-1] - whole
    phase = 2 * math.pi / test.peak_period * time[kept]
    basis = np.stack([np.ones(kept.sum()), np.cos(phase), np.sin(phase)], axis=1)
    return float(np.hypot(*np.linalg.lstsq(basis, x[kept], rcond=None)[0][1:]))


def document(found: Compared, options: Options, about: dict[str, Any], applied: Applied | None) -> dict[str, Any]:
    """The content of comparison.json; `error` is the contract's."""
    coefficients = {"source": "platform", "values": {}, "not_identifiable": [], "left_out": []} if applied is None else {
        "source": f"calibration of {applied.campaign}", "values": applied.values, "not_identifiable": list(applied.vague),
        "left_out": list(applied.left),
        **({} if applied.strips is None else {"strips": applied.strips.model_dump()})}  # fmt: skip
    return {
        **about,
        "jaxhydro": jaxhydro.__version__,
        "options": {**dataclasses.asdict(options), "step": found.step, "spectra": WELCH},
        "coefficients": coefficients,
        "seas": [
            {"file": run.file, "tests": [record.id for record in run.records], "duration": float(run.time[-1] - run.time[0]),
             "components": int(made.sea.components.omega.size), "gauge": list(run.position),
             "heading": math.degrees(run.heading), "mismatch": made.mismatch, "rounds": made.rounds,
             "variance_in_band": made.inside}
            for run, made in found.seas
        ],
        "error": {test.fit.id: _errors(test) for test in found.tests},
        "tests": {test.fit.id: _about(test) for test in found.tests},
        "warnings": list(found.notes),
    }  # fmt: skip


def _errors(test: SeaTest) -> dict[str, Any]:
    errors: dict[str, Any] = {"use": test.fit.use}
    for s in test.fit.series:
        rmse = float(for_people(s.channel, s.rmse))
        errors[s.channel] = {"rmse": rmse, "unit": unit_of(s.channel), "relative": s.relative}
    if test.fit.kind == "irregular":
        each = {name: {k: b.error for k, b in row.items() if math.isfinite(b.error)} for name, row in in_bands(test).items()}
        errors["bands"] = {name: row for name, row in each.items() if name in DOFS and row}
    return errors


def _about(test: SeaTest) -> dict[str, Any]:
    """What the sea was, and what errors are made of, in m and deg."""
    both = channels(test)
    about: dict[str, Any] = {
        "kind": test.fit.kind, "file": test.fit.file, "start": float(test.fit.time[0]), "end": float(test.fit.time[-1]),
        "peak_period": test.peak_period, "stated_height": test.stated_height, "heading": math.degrees(test.heading),
        "statistics": {
            name: {"unit": unit_of(name)}
            | {key: {"mean": float(x.mean()), "standard_deviation": float(x.std())}
               for key, x in zip(("measured", "simulated"), pair)}
            for name, pair in both.items()
        },
    }  # fmt: skip
    if test.fit.kind == "irregular":
        heights = {key: wave_height(x, irregular=True) for key, x in zip(("measured", "simulated"), both["wave"])}
        about["significant_wave_height"] = heights
        about["bands"] = {
            name: {k: {"band": [b.low, b.high], "measured": b.measured, "simulated": b.simulated} for k, b in row.items()}
            for name, row in in_bands(test).items()
        }
    else:
        about["amplitude"] = {
            name: dict(zip(("measured", "simulated"), (amplitude(test, x) for x in pair))) for name, pair in both.items()
        }
    return about


def counted(campaign: Campaign) -> str:
    """How many tests there are to be simulated, and how many others."""
    waves = sum(test.kind in IN_WAVES and test.use != "ignore" for test in campaign.manifest.tests)
    others = len(campaign.manifest.tests) - waves
    return f"{waves} {'test' if waves == 1 else 'tests'} in waves" + (f"; left aside: {others}" if others else "")


def seas_table(found: Compared) -> Rows:
    """Height of every sea as stated, measured and simulated at the gauge."""
    rows = []
    for test in found.tests:
        irregular = test.fit.kind == "irregular"
        heights = [number(wave_height(x, irregular), 3) for x in (test.wave, test.simulated_wave)]
        stated = number(test.stated_height, 3)
        rows.append((test.fit.id, test.fit.kind, test.fit.use, stated, *heights, number(test.peak_period, 3)))
    return ("Test", "Waves", "Use", "Height stated (m)", "Measured (m)", "Simulated (m)", "Period (s)"), rows


def motions_table(found: Compared) -> Rows:
    """Mean, standard deviation and RMSE of the motions that matter."""
    rows = []
    for test in found.tests:
        both, relative = channels(test), {s.channel: s.relative for s in test.fit.series}
        for name in moving(test):
            cells = [number(float(f(x)), 3) for f in (np.mean, np.std) for x in both[name]]
            rows.append((test.fit.id, f"{name} ({unit_of(name)})", *cells, percent(relative[name])))
    heads = ("Test", "Motion", "Mean measured", "Mean simulated", "SD measured", "SD simulated", "RMSE / SD")
    return heads, rows


def bands_table(found: Compared) -> Rows:
    """Band integrals per sea state and motion; of regular waves amplitudes."""
    rows = []
    for test in found.tests:
        if test.fit.kind == "regular":
            for name, pair in channels(test).items():
                if name == "wave" or name in moving(test):
                    a, b = (amplitude(test, x) for x in pair)
                    rows.append((test.fit.id, f"{name} ({unit_of(name)})", "amplitude", *_cells(a, b)))
            continue
        for name, row in in_bands(test).items():
            if name == "wave" or name in moving(test):
                for key, band in row.items():
                    limits = f"{NAMES[key]}, {band.low:g}-{band.high:g} Hz"
                    rows.append((test.fit.id, f"{name} ({unit_of(name)}²)", limits, *_cells(band.measured, band.simulated)))
    return ("Test", "Channel", "Band", "Measured", "Simulated", "Error"), rows


def _cells(measured: float, simulated: float) -> tuple[str, str, str]:
    off = 100 * (simulated / measured - 1) if measured > 0 else math.nan
    return number(measured, 3), number(simulated, 3), f"{round(off) or 0:+d} %" if math.isfinite(off) else "–"
