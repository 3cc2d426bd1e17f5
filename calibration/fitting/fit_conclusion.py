"""Results of a finished fit: estimates, measured and simulated series, remarks."""

from __future__ import annotations

from collections.abc import Sequence

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from calibration.campaign.grouped_findings import group_findings
from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest import IN_WAVES
from calibration.campaign.records import Record
from calibration.campaign.wave_band import band_sentence
from calibration.fitting.unit_hints import unit_hints
from calibration.formatting import listed, percent_span
from calibration.identifiability.directions import Identifiability, parameter_family
from calibration.identifiability.information import IDENTIFIABLE_DEVIATION
from calibration.identifiability.standard_deviations import Spread
from calibration.parameters.space import ParameterSpace, slopes
from calibration.residuals.decays import DecayProblem, Unknowns
from calibration.result import Estimate, Series, TestFit
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.response import decay_cycles
from jaxhydro.dynamics.statics import natural_modes
from jaxhydro.environment import DOFS

NOT_FOLLOWED_ERROR = 0.5  # RMSE over standard deviation beyond which a model does not follow its record


def estimates(space: ParameterSpace, model: Model, x: np.ndarray, uncertainty: Spread) -> dict[str, Estimate]:
    """The free parameters at coordinates: a standard deviation where the records determine them, none where not."""
    deviation = uncertainty.deviation()
    slope = slopes(space, x)
    found = {}
    for i, parameter in enumerate(space.free):
        bound = parameter.transform.at_bound(x[i])
        value, small = float(parameter.transform.forward(jnp.asarray(x[i]))), float(abs(slope[i]) * deviation[i])
        # known to a quarter of its size, or known to be small
        clear = (
            bool(deviation[i] < IDENTIFIABLE_DEVIATION or small < IDENTIFIABLE_DEVIATION * abs(parameter.start)) and not bound
        )
        about = model.about(parameter.label)
        found[parameter.label] = Estimate(
            parameter.label,
            value,
            small if clear else None,
            about.unit,
            about.meaning,
            parameter.start,
            bound,
            clear,
        )
    return found


@eqx.filter_jit
def _motions(problem: DecayProblem, unknowns: Unknowns, x):
    return jax.lax.map(lambda inputs: problem.motion(x, *inputs), (unknowns.own, problem.data))


def series_of(
    problem: DecayProblem, records: Sequence[Record], unknowns: Unknowns, before: DecayProblem | None = None
) -> list[TestFit]:
    """Every record measured against simulated. `before` is the same with the model that the calibration started from."""
    data = problem.data
    after = np.asarray(_motions(problem, unknowns, unknowns.shared))
    earlier = problem if before is None else before
    start = np.asarray(_motions(earlier, unknowns, earlier.space.start))
    offsets = np.asarray(unknowns.own).reshape(len(records), 3, -1)[:, 2] * np.asarray(data.unit)
    tests = []
    for i, record in enumerate(records):
        n, series, first = len(record.time), [], {}
        for j, dof in enumerate(data.dofs):
            channel = DOFS[dof]
            if channel not in record.values:
                continue
            offset = float(offsets[i, j])
            series.append(
                Series(
                    channel,
                    record.values[channel] - offset,
                    after[i, j, :n] - offset,
                    offset,
                    record.noise[channel],
                    channel == record.degree_of_freedom,
                )
            )
            first[channel] = start[i, j, :n] - offset
        tests.append(
            TestFit(
                record.id, record.use, record.kind, record.degree_of_freedom, record.time, tuple(series), first, record.file
            )
        )
    return tests


def records_not_followed(tests: Sequence[TestFit], declared: Model) -> list[str]:
    """Sentences on fitted tests that the model does not follow, one for each motion. Most often a unit, a scale or a mass is
    wrong."""
    lost: dict[str, list[TestFit]] = {}
    for test in tests:
        if test.use == "fit" and test.main.relative >= NOT_FOLLOWED_ERROR:
            lost.setdefault(test.main.channel, []).append(test)
    if not lost:
        return []
    modes = natural_modes(declared)
    return [
        f"the model does not follow {listed([test.id for test in some])}: the RMSE is "
        f"{percent_span([test.main.relative for test in some])} of the motion's standard deviation. Period in {channel}: "
        f"measured {_periods(some)}, declared model {modes.of(channel):.3g} s. Check scale, units, mass and stiffness"
        for channel, some in lost.items()
    ]


def _periods(tests: Sequence[TestFit]) -> str:
    """The smallest and the largest median period of some tests."""
    cycles = [decay_cycles(one.time, one.main.measured - one.main.measured.mean(), one.main.noise).period for one in tests]
    medians = sorted({f"{float(np.median(period)):.3g}" for period in cycles if len(period)}, key=float)
    return f"{' to '.join(dict.fromkeys((medians[0], medians[-1])))} s" if medians else "none seen"


def remarks(
    campaign: Campaign,
    parameters: dict[str, Estimate],
    found: Identifiability,
    kinds: Sequence[str] = ("decay",),
) -> tuple[str, ...]:
    """Findings in words: what was seen in the records, what was left out, and which parameters mean nothing."""
    said = [str(finding) for finding in group_findings(campaign.findings)]
    left = [r.id for r in campaign.records if r.use != "ignore" and r.kind not in kinds]
    if left:
        said.append(f"only {' and '.join(kinds)} tests are fitted; left out: {', '.join(left)}")
    if campaign.used("fit") and not any(parameter_family(label) == "damping" for label in parameters):
        said.append("no damping is fitted: the platform declares none or 0 for these motions, or calibrate.free leaves it out")
    band = band_sentence(campaign.manifest, campaign.model, campaign.records) if set(IN_WAVES) & set(kinds) else None
    said += [] if band is None else [band]
    vague = [label for label, p in parameters.items() if not p.identifiable]
    if vague:
        ends = "its value is no result" if len(vague) == 1 else "their values are not results"
        said.append(f"these records do not determine {', '.join(vague)}: {ends}")
    return (*said, *unit_hints(parameters.values()), *found.sentences())
