"""Content of comparison.json: errors in waves by test, motion and band."""

import dataclasses
import math
from typing import Any

import jaxhydro
from calibration.campaign.signals import wave_height
from calibration.residuals.measured_seas import Comparison, Options, SeaTest
from calibration.residuals.sea_errors import WELCH, amplitude, channels, in_bands
from calibration.results.applied_calibration import AppliedCalibration
from jaxhydro.environment import DOFS
from jaxhydro.units import for_people, unit_of


def document(found: Comparison, options: Options, about: dict[str, Any], applied: AppliedCalibration | None) -> dict[str, Any]:
    """The content of comparison.json; `error` is the contract's."""
    coefficients = (
        {"source": "platform", "values": {}, "not_identifiable": [], "left_out": []}
        if applied is None
        else {
            "source": f"calibration of {applied.campaign}",
            "values": applied.values,
            "not_identifiable": list(applied.undetermined),
            "left_out": list(applied.not_used),
            **({} if applied.strips is None else {"strips": applied.strips.model_dump()}),
        }
    )
    return {
        **about,
        "jaxhydro": jaxhydro.__version__,
        "options": {**dataclasses.asdict(options), "step": found.step, "spectra": WELCH},
        "coefficients": coefficients,
        "seas": [
            {
                "file": run.file,
                "tests": [record.id for record in run.records],
                "duration": float(run.time[-1] - run.time[0]),
                "components": int(made.sea.components.omega.size),
                "gauge": list(run.position),
                "heading": math.degrees(run.heading),
                "mismatch": made.mismatch,
                "rounds": made.rounds,
                "variance_in_band": made.inside,
            }
            for run, made in found.seas
        ],
        "error": {test.fit.id: _errors(test) for test in found.tests},
        "tests": {test.fit.id: _about(test) for test in found.tests},
        "warnings": list(found.notes),
    }


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
        "kind": test.fit.kind,
        "file": test.fit.file,
        "start": float(test.fit.time[0]),
        "end": float(test.fit.time[-1]),
        "peak_period": test.peak_period,
        "stated_height": test.stated_height,
        "heading": math.degrees(test.heading),
        "statistics": {
            name: {"unit": unit_of(name)}
            | {
                key: {"mean": float(x.mean()), "standard_deviation": float(x.std())}
                for key, x in zip(("measured", "simulated"), pair)
            }
            for name, pair in both.items()
        },
    }
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
