"""Results of a finished fit: estimates, identifiability, remarks."""

from __future__ import annotations

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np

from calibration.campaign.grouped_findings import group_findings
from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest_sections import IN_WAVES
from calibration.campaign.records import Record
from calibration.campaign.wave_band import band_sentence
from calibration.decay_analysis.period_change import unexplained_period_change
from calibration.fitting.fit import Fit
from calibration.fitting.unit_hints import unit_hints
from calibration.formatting import listed, percent_span
from calibration.identifiability.findings import Identifiability
from calibration.identifiability.information import IDENTIFIABLE_DEVIATION
from calibration.identifiability.standard_deviations import Spread
from calibration.notes import Note, NoteKind, notes_of
from calibration.parameters.families import parameter_family
from calibration.parameters.space import ParameterSpace, slopes
from calibration.result import NOT_FOLLOWED_ERROR, Calibration, Estimate, TestFit
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.response import decay_cycles
from jaxhydro.dynamics.statics import natural_modes
from jaxhydro.environment import DOFS
from jaxhydro.platform.drag_laws import law_labels


def estimates(space: ParameterSpace, model: Model, x: np.ndarray, uncertainty: Spread) -> dict[str, Estimate]:
    """Estimates of the free parameters, by label.

    An estimate has a standard deviation only where the records determine the parameter.

    Args:
        space: The free parameters.
        model: A model with these parameters.
        x: Their coordinates (p,).
        uncertainty: Covariance of the coordinates.
    """
    deviation = uncertainty.deviation()
    slope = slopes(space, x)
    estimated = {}
    for i, parameter in enumerate(space.free):
        bound = parameter.transform.at_bound(x[i])
        value, small = float(parameter.transform.forward(jnp.asarray(x[i]))), float(abs(slope[i]) * deviation[i])
        # known to a quarter of its size, or known to be small
        clear = (
            bool(deviation[i] < IDENTIFIABLE_DEVIATION or small < IDENTIFIABLE_DEVIATION * abs(parameter.start)) and not bound
        )
        about = model.about(parameter.label)
        estimated[parameter.label] = Estimate(
            parameter.label,
            value,
            small if clear else None,
            about.unit,
            about.meaning,
            parameter.start,
            bound,
            clear,
        )
    return estimated


def source_of(records: Sequence[Record]) -> str:
    """Description of decays: their number by released motion."""
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
        uncertainty: Covariance of its coordinates, and the identifiability of the parameters.
        tests: Measured and simulated motions.
        seconds: Duration of the fit.
        kinds: Kinds of tests that were fitted.
        lost: Sentences on records that the model does not follow; with any, the fit did not converge.
        first: Remarks before those on the parameters.
        last: Remarks after these.
    """
    spread, identifiability = uncertainty
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
        (
            *notes_of(NoteKind.FIT, (*lost, *first)),
            *remarks(campaign, parameters, identifiability, kinds),
            *notes_of(NoteKind.FIT, last),
        ),
        campaign.platform.name,
        identifiability,
    )


def records_not_followed(tests: Sequence[TestFit], baseline: Model) -> list[str]:
    """Sentences on fitted tests that the model does not follow, one for each motion.

    Most often a unit, a scale or a mass is wrong.
    """
    lost: dict[str, list[TestFit]] = {}
    for test in tests:
        if test.use == "fit" and test.main.relative >= NOT_FOLLOWED_ERROR:
            lost.setdefault(test.main.channel, []).append(test)
    if not lost:
        return []
    modes = natural_modes(baseline)
    return [
        f"the model does not follow {listed([test.id for test in group])}: the RMSE is "
        f"{percent_span([test.main.relative for test in group])} of the motion's standard deviation. Period in {channel}: "
        f"measured {_periods(group)}, of the platform file {modes.of(channel):.3g} s. Check scale, units, mass and stiffness"
        for channel, group in lost.items()
    ]


def period_remarks(tests: Sequence[TestFit]) -> list[str]:
    """Sentences on fitted decays whose period changes with the amplitude otherwise than the model's."""
    sentences = []
    for test in tests:
        main = test.main
        if test.use != "fit" or test.kind != "decay" or main.relative >= NOT_FOLLOWED_ERROR:
            continue
        change = unexplained_period_change(test.time, main.measured, main.simulated, main.noise)
        if change is not None:
            sentences.append(
                f"{test.id}: the period of {main.channel} goes from {change.large:.4g} s at large amplitude to "
                f"{change.small:.4g} s at small, the model's from {change.simulated_large:.4g} "
                f"to {change.simulated_small:.4g} s. "
                "`jaxhydro diagnose` looks for what the model lacks"
            )
    return sentences


def _periods(tests: Sequence[TestFit]) -> str:
    """The smallest and the largest median period of some tests."""
    cycles = [decay_cycles(test.time, test.main.measured - test.main.measured.mean(), test.main.noise).period for test in tests]
    medians = sorted({f"{float(np.median(period)):.3g}" for period in cycles if len(period)}, key=float)
    return f"{' to '.join(dict.fromkeys((medians[0], medians[-1])))} s" if medians else "none seen"


def stated_zeros(campaign: Campaign) -> list[str]:
    """Labels of lumped coefficients of the released motions that the platform file states as 0."""
    digits = {str(DOFS.index(r.degree_of_freedom) + 1) for r in campaign.used("fit") if r.degree_of_freedom is not None}
    return [
        f"{name}.{key}"
        for name in ("linear_damping", "quadratic_damping", "added_mass")
        for key, value in getattr(campaign.platform, name).root.items()
        if value == 0 and set(key[-2:]) <= digits
    ]


def remarks(
    campaign: Campaign,
    parameters: dict[str, Estimate],
    identifiability: Identifiability,
    kinds: Sequence[str] = ("decay",),
) -> tuple[Note, ...]:
    """Remarks on the records, on tests left out, and on parameters that are not determined."""
    record_remarks = [str(finding) for finding in group_findings(campaign.findings)]
    left_out = [r.id for r in campaign.records if r.use != "ignore" and r.kind not in kinds]
    if left_out:
        record_remarks.append(f"only {' and '.join(kinds)} tests are fitted; left out: {', '.join(left_out)}")
    parameter_remarks = []
    if campaign.used("fit") and not any(
        parameter_family(label, law_labels(campaign.model)) == "damping" for label in parameters
    ):
        parameter_remarks.append(
            "no damping is fitted: the platform declares none or 0 for these motions, or calibrate.free leaves it out"
        )
    if zeros := stated_zeros(campaign):
        verb, them = ("is", "it") if len(zeros) == 1 else ("are", "them")
        parameter_remarks.append(
            f"{listed(zeros)} {verb} 0 in the platform file and {verb} not fitted. To fit {them}, state a value above 0"
        )
    band = band_sentence(campaign.manifest, campaign.model, campaign.records) if set(IN_WAVES) & set(kinds) else None
    record_remarks += [] if band is None else [band]
    vague = [label for label, p in parameters.items() if not p.identifiable]
    if vague:
        ends = "its value is no result" if len(vague) == 1 else "their values are not results"
        parameter_remarks.append(f"these records do not determine {', '.join(vague)}: {ends}")
    about = (*parameter_remarks, *unit_hints(parameters.values()), *identifiability.sentences())
    return (*notes_of(NoteKind.RECORDS, record_remarks), *notes_of(NoteKind.PARAMETERS, about))
