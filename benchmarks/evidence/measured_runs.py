"""Measured decays calibrated: a semi-submersible's surge and a ship's roll."""

from typing import Any

import numpy as np

from benchmarks.evidence.common import SHARED

FOLDER = SHARED / "measured"
CASES = ("focal-c4", "kvlcc2")


def calibrated(name: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """One campaign calibrated.

    Args:
        name: Folder of the campaign.

    Returns:
        Errors, parameters and cycles; and the motions of its decay, measured and simulated, as `motions_of` has them.
    """
    from calibration.campaign.load_campaign import load_campaign
    from calibration.fitting.decay_calibration import calibrate
    from jaxhydro import natural_modes
    from jaxhydro.dynamics.response import decay_cycles
    from jaxhydro.units import for_people

    result = calibrate(load_campaign(FOLDER / name))
    test = result.tests[0]
    main = test.main
    measured, simulated = (decay_cycles(test.time, x, main.noise) for x in (main.measured, main.simulated))
    n = min(len(measured.period), len(simulated.period))
    numbers = {
        "channel": main.channel,
        "relative": main.relative,
        "rmse": float(for_people(main.channel, main.rmse)),
        "noise": float(for_people(main.channel, main.noise)),
        "scale": float(np.std(main.measured)),
        "iterations": result.iterations,
        "converged": result.converged,
        "seconds": result.seconds,
        "parameters": {k: [p.start, p.value, p.standard_deviation, p.unit] for k, p in result.parameters.items()},
        "natural_period": natural_modes(result.model).of(main.channel),
        "cycles": [
            [
                float(for_people(main.channel, measured.amplitude[i])),
                measured.period[i],
                simulated.period[i],
                measured.decrement[i],
                simulated.decrement[i],
            ]
            for i in range(n)
        ],
    }
    return numbers, motions_of(test)


def motions_of(test: Any) -> dict[str, Any]:
    """A `TestFit` as JSON has it, without its file."""
    return {
        "id": test.id,
        "use": test.use,
        "kind": test.kind,
        "degree_of_freedom": test.degree_of_freedom,
        "time": test.time.tolist(),
        "series": [
            {
                "channel": series.channel,
                "measured": series.measured.tolist(),
                "simulated": series.simulated.tolist(),
                "offset": float(series.offset),
                "noise": float(series.noise),
                "scored": bool(series.scored),
            }
            for series in test.series
        ],
        "start": {channel: np.asarray(values).tolist() for channel, values in test.start.items()},
    }


def test_of(motions: dict[str, Any]) -> Any:
    """The `TestFit` that `motions_of` gave."""
    from calibration.result import Series, TestFit

    series = tuple(
        Series(**channel | {kind: np.array(channel[kind], float) for kind in ("measured", "simulated")})
        for channel in motions["series"]
    )
    arrays = {
        "time": np.array(motions["time"], float),
        "series": series,
        "start": {channel: np.array(values, float) for channel, values in motions["start"].items()},
    }
    return TestFit(**motions | arrays, file="")
