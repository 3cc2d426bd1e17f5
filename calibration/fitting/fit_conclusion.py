"""Results of a finished fit: estimates, identifiability, remarks."""

from __future__ import annotations

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np

from calibration.campaign.grouped_findings import group_findings
from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest import IN_WAVES
from calibration.campaign.records import Record
from calibration.campaign.wave_band import band_sentence
from calibration.decay_analysis.period_change import unexplained_period_change
from calibration.fitting.fit import Fit
from calibration.fitting.unit_hints import unit_hints
from calibration.formatting import listed, percent_span
from calibration.identifiability.directions import Identifiability
from calibration.identifiability.information import IDENTIFIABLE_DEVIATION
from calibration.identifiability.standard_deviations import Spread
from calibration.notes import Note, NoteKind, notes_of
from calibration.parameters.families import parameter_family
from calibration.parameters.space import ParameterSpace, slopes
from calibration.result import Calibration, Estimate, TestFit
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.response import decay_cycles
from jaxhydro.dynamics.statics import natural_modes
from jaxhydro.platform.drag_laws import law_labels

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


def source_of(records: Sequence[Record]) -> str:
    """Decays in words: how many, of which motions."""
    released = [str(record.degree_of_freedom) for record in records]
    counts = [(dof, released.count(dof)) for dof in dict.fromkeys(released)]
    return listed([f"{n} {dof} decay{'' if n == 1 else 's'}" for dof, n in counts])


def identifiability_of(fit: Fit) -> Identifiability:
    """Identifiability of the parameters of a finished fit to decays.

    Args:
        fit: The finished fit.

    Returns:
        Which parameters, and which combinations of them, the records determine.
    """
    return fit.uncertainty(source_of(fit.decays.records))[1]


def calibration_of(
    campaign: Campaign,
    fit: Fit,
    uncertainty: tuple[Spread, Identifiability],
    tests: Sequence[TestFit],
    seconds: float,
    *,
    kinds: Sequence[str] = ("decay",),
    lost: Sequence[str] = (),
    first: Sequence[str] = (),
    last: Sequence[str] = (),
) -> Calibration:
    """Result of a finished fit.

    Args:
        campaign: The campaign.
        fit: The fit.
        uncertainty: Covariance of its coordinates, and what it says.
        tests: Measured and simulated motions.
        seconds: Duration of the fit.
        kinds: Kinds of tests that were fitted.
        lost: Sentences on records that the model does not follow; with any, the fit did not converge.
        first: Remarks before those on the parameters.
        last: Remarks after these.
    """
    spread, found = uncertainty
    parameters = estimates(fit.space, fit.parts[0].problem.model, np.asarray(fit.x), spread)
    return Calibration(
        campaign.manifest.name,
        fit.model,
        parameters,
        tuple(tests),
        fit.converged and not lost,
        fit.iterations,
        seconds,
        tuple(fit.history),
        (*notes_of(NoteKind.FIT, (*lost, *first)), *remarks(campaign, parameters, found, kinds), *notes_of(NoteKind.FIT, last)),
        campaign.platform.name,
        found,
    )


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
        f"measured {_periods(some)}, of the platform file {modes.of(channel):.3g} s. Check scale, units, mass and stiffness"
        for channel, some in lost.items()
    ]


def period_remarks(tests: Sequence[TestFit]) -> list[str]:
    """Sentences on fitted decays whose period changes with the amplitude otherwise than the model's."""
    said = []
    for test in tests:
        main = test.main
        if test.use != "fit" or test.kind != "decay" or main.relative >= NOT_FOLLOWED_ERROR:
            continue
        found = unexplained_period_change(test.time, main.measured, main.simulated, main.noise)
        if found is not None:
            said.append(
                f"{test.id}: the period of {main.channel} goes from {found.large:.4g} s at large amplitude to "
                f"{found.small:.4g} s at small, the model's from {found.simulated_large:.4g} to {found.simulated_small:.4g} s. "
                "`jaxhydro diagnose` looks for what the model lacks"
            )
    return said


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
) -> tuple[Note, ...]:
    """Findings in words: what was seen in the records, what was left out, and which parameters mean nothing."""
    seen = [str(finding) for finding in group_findings(campaign.findings)]
    left = [r.id for r in campaign.records if r.use != "ignore" and r.kind not in kinds]
    if left:
        seen.append(f"only {' and '.join(kinds)} tests are fitted; left out: {', '.join(left)}")
    said = []
    if campaign.used("fit") and not any(
        parameter_family(label, law_labels(campaign.model)) == "damping" for label in parameters
    ):
        said.append("no damping is fitted: the platform declares none or 0 for these motions, or calibrate.free leaves it out")
    band = band_sentence(campaign.manifest, campaign.model, campaign.records) if set(IN_WAVES) & set(kinds) else None
    seen += [] if band is None else [band]
    vague = [label for label, p in parameters.items() if not p.identifiable]
    if vague:
        ends = "its value is no result" if len(vague) == 1 else "their values are not results"
        said.append(f"these records do not determine {', '.join(vague)}: {ends}")
    about = (*said, *unit_hints(parameters.values()), *found.sentences())
    return (*notes_of(NoteKind.RECORDS, seen), *notes_of(NoteKind.PARAMETERS, about))
