"""A calibration's result without a fit: the declared model, and one with some values changed, against a campaign."""

from functools import cache
from pathlib import Path

import numpy as np

import jaxhydro as jh
from calibration.campaign.load_campaign import load_campaign
from calibration.campaign.records import Record
from calibration.result import Calibration, Estimate, Series, TestFit

DEMO = Path(jh.__file__).parent / "campaigns" / "volturnus-s-decays"
NEAR_TRUTH = {
    "column.Ca_t": 1.48, "column.Ca_z": 0.12, "column.Cd_t": 2.05, "column.Cd_z": 2.30,
    "pontoon.Ca_t": 0.14, "pontoon.Ca_z": 1.87, "pontoon.Cd_t": 1.80, "pontoon.Cd_z": 4.90,
    "linear_damping.B11": 4.5e4, "linear_damping.B33": 1.7e5, "linear_damping.B55": 3.6e8,
}  # fmt: skip
FEW = ("surge-1", "heave-1", "pitch-1")


def motion(model: jh.Model, record: Record, samples: int) -> dict[str, np.ndarray]:
    """The model's motion from the record's first sample, at rest, still water at zero.

    So many samples are simulated whatever the record's length: records sampled alike share one compilation.
    """
    first = {name: float(values[0]) for name, values in record.values.items()}
    n, step = len(record.time), record.time[1] - record.time[0]
    times = np.concatenate([record.time, record.time[-1] + step * np.arange(1, samples - n + 1)])
    response = jh.simulate(model, times, position=first)
    still = np.asarray(jh.equilibrium(model))
    return {name: np.asarray(response[name])[:n] - still[jh.DOFS.index(name)] for name in record.values}


def fake_calibration(
    folder: Path = DEMO,
    fitted: dict[str, float] | None = None,
    only: tuple[str, ...] | None = None,
    holdout: tuple[str, ...] = (),
    converged: bool = True,
) -> Calibration:
    """A result on the tests `only` of a campaign with the values `fitted`; one label is made not identifiable, one at a
    bound."""
    campaign = load_campaign(folder)
    declared = jh.build(campaign.platform)
    fitted = NEAR_TRUTH if fitted is None else fitted
    model = declared.with_values(fitted)
    parameters = {}
    for i, (label, value) in enumerate(fitted.items()):
        about, lost = declared.about(label), len(fitted) > 3 and i == len(fitted) - 2
        parameters[label] = Estimate(
            label=label, value=value, standard_deviation=None if lost else abs(value) * (0.01 + 0.03 * (i % 4)),
            unit=about.unit, meaning=about.meaning, start=float(declared.values[label]),
            at_bound=len(fitted) > 3 and i == 3, identifiable=not lost,
        )  # fmt: skip
    tests: list[TestFit] = []
    longest = max(len(record.time) for record in campaign.records)
    for record in campaign.records:
        if record.use == "ignore" or record.kind != "decay" or (only and record.id not in only):
            continue
        after, before = motion(model, record, longest), motion(declared, record, longest)
        series = tuple(
            Series(name, values, after[name], 0.0, record.noise[name], name == record.degree_of_freedom)
            for name, values in record.values.items()
        )
        use = "holdout" if record.id in holdout else record.use
        dof = record.degree_of_freedom
        tests.append(TestFit(record.id, use, record.kind, dof, record.time, series, before, record.file))
    notes = ("linear_damping.B33 is not determined by these records: it stays near its starting value",)
    return Calibration(
        campaign.manifest.name, model, parameters, tuple(tests), converged, 12, 34.5, (3.2, 1.1, 0.42), notes
    )


@cache
def small() -> Calibration:
    """Three decays of the embedded campaign, one of each motion, the pitch held out; made once per process."""
    return fake_calibration(only=FEW, holdout=("pitch-1",))
