"""Calibration to the motions of tests in irregular and regular waves."""

import math
import time as clock
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import get_args

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest_sections import IN_WAVES
from calibration.fitting.block_part import BlockPart
from calibration.fitting.decay_fit import labels_of, space_of
from calibration.fitting.fit import Fit
from calibration.fitting.fit_conclusion import calibration_of
from calibration.fitting.law_parameters import (
    EXPONENT_DEVIATION,
    Drag,
    Over,
    reference_sea_state,
    with_drag_law,
    with_sea_state_laws,
)
from calibration.fitting.progress import Progress, run_interruptibly
from calibration.fitting.sea_part import SeaPart
from calibration.fitting.sea_remarks import sea_remarks
from calibration.notes import NoteKind, notes_of
from calibration.parameters.families import parameter_family
from calibration.residuals.abstract_residual import parameters_only
from calibration.residuals.measured_seas import SeaTest, compare
from calibration.residuals.moving_channels import moving_channels
from calibration.residuals.run_seas import Seas, sea_step, seas_of, with_diffraction
from calibration.residuals.sea_errors import in_bands
from calibration.residuals.seas import Objective, SeaProblem, set_up_waves
from calibration.residuals.wave_options import Options, options_of
from calibration.result import BandError, Calibration, TestFit
from jaxhydro.choices import check
from jaxhydro.dynamics.model import Model
from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError, Problem
from jaxhydro.loads.sea_state_law import exponents_of
from jaxhydro.loads.sea_state_law import reference_of as law_reference
from jaxhydro.platform.drag_laws import law_labels

MAX_ROUNDS = 4  # times that the model's error is estimated anew
TOLERANCE = 1e-3  # relative decrease of the sum of squares that ends a round


def calibrate_in_waves(
    campaign: Campaign,
    *,
    free: Sequence[str] | None = None,
    progress: Callable[[Progress], None] | None = None,
    start: dict[str, float] | None = None,
    objective: Objective = "bands",
    options: Options | None = None,
    over: Sequence[Over] = (),
    drag: Drag | None = None,
    made: Seas | None = None,
) -> Calibration:
    """Fit the baseline model's coefficients to all tests in waves marked `fit`, in their measured waves.

    Objectives:
        "bands": ln(simulated / measured energy) in the low-frequency and the wave-frequency band of every motion that
            matters. A sensor's clock and the phase of slow drift have no effect on it.
        "spectrum": the same in up to eight narrow cells of each band. Frequency and sharpness of a resonance count.
        "motion": simulated less measured over the measured standard deviation, sample by sample.
        "both": bands and motion.
        "blocks": the motion in blocks of three of the slowest natural periods, each from an initial state of its own
            (multiple shooting, see `shooting`). For long tests, in which a slightly wrong natural period puts slow motions
            out of phase.

    In regular waves the motion is always the objective. Every free parameter has a prior: by default a factor of 4.5 about
    where it starts. The prior is weighed against the model's own error, which is estimated from the residuals.

    Args:
        campaign: The campaign.
        free: Labels or patterns of the free parameters; None for those of the manifest.
        progress: Function that is called with the progress after every iteration.
        start: Values to begin from in place of the platform's, by label.
        objective: The objective, see above.
        options: How waves are made and act; None for the campaign's band of frequencies and defaults otherwise.
        over: Sea-state variables. Free drag and damping coefficients become powers of these (`SeaStateLaw`), of exponents
            with a prior of 0 +- 1. Every test is simulated with the coefficients of its own measured sea state.
        drag: Law for free coefficients of plain drag, see `with_drag_law`. It is a power of the Keulegan-Carpenter number
            (`KeuleganCarpenterDrag`), or a share of their own in motion slower than the waves (`HighPassDrag`).
        made: Runs and seas of the campaign (`seas_of`), where they are at hand.

    Returns:
        The calibrated model, its parameters with their uncertainty, and all tests in waves.

    Raises:
        InputError: If there is nothing to fit.
        Interrupted: If the user stops the fit; it holds what was reached.
    """
    begun = clock.monotonic()
    check(objective=(objective, get_args(Objective)), drag=(drag, (*get_args(Drag), None)))
    for variable in over:
        check(over=(variable, get_args(Over)))
    source = str(campaign.folder / "campaign.yaml")
    options = options_of(campaign) if options is None else options
    records = [record for record in campaign.used("fit") if record.kind in IN_WAVES]
    if not records:
        uses = ", ".join(sorted({f"{r.kind} marked {r.use}" for r in campaign.records})) or "no tests"
        raise InputError(source, [Problem("tests", "at least one test in waves marked `use: fit`", uses)])
    baseline = with_diffraction(campaign.model, options)
    made = seas_of(campaign, baseline.environment, options) if made is None else made
    moved = sorted({dof for r in records for dof in moving_channels({k: r.values[k] for k in DOFS if k in r.values})})
    labels, laws = list(labels_of(campaign, baseline, moved, free)), law_labels(baseline)
    if over:
        damping = [label for label in labels if parameter_family(label, laws) == "damping"]
        baseline = with_sea_state_laws(
            baseline, damping, over, law_reference(baseline.loads) or reference_sea_state(made, options)
        )
    exponent_labels = exponents_of(baseline.loads) - set(labels)
    added = [label for label in baseline.values if label in exponent_labels]
    if drag is not None:
        state = reference_sea_state(made, options)
        baseline, drag_labels = with_drag_law(baseline, labels, drag, state, options.low)
        if not drag_labels:
            raise InputError(source, [Problem("calibrate.free", "a coefficient of plain drag", ", ".join(labels))])
        added += drag_labels
    # what a law adds that is not asked for is left out
    begin = {label: value for label, value in (start or {}).items() if label in baseline.values or label not in laws}
    baseline = baseline.with_values(begin)
    exponents = {label: (0.0, EXPONENT_DEVIATION) for label in added if baseline.about(label).neutral == 0}
    space = space_of(campaign, [*labels, *added], baseline, exponents)

    def report(stage: str, iteration: int, value: float, fraction: float) -> None:
        if progress is not None:
            progress(Progress(stage, iteration, value, fraction, "error"))

    report("simulating the measured seas", 0, math.nan, 0.0)

    def set_up(model: Model) -> SeaProblem:
        return set_up_waves(
            model,
            made,
            space,
            options,
            from_rest=campaign.manifest.zero is not None,
            scale=campaign.manifest.scale,
            step=sea_step(baseline, options),
            objective=objective,
        )

    part: SeaPart | BlockPart
    if objective == "blocks":
        part = BlockPart(set_up, baseline)
        unknowns = part.problem.begin()
    else:
        part = SeaPart(set_up, baseline, pooled=True)
        unknowns = parameters_only(space.start)
    fit = Fit([part], unknowns, report)

    def finish() -> Calibration:
        source = "the tests in waves by blocks" if objective == "blocks" else "the tests in waves"
        uncertainty = fit.uncertainty(source)
        tests, warnings = tests_in_waves(campaign, baseline, fit.model, options, made)
        remarks = notes_of(NoteKind.PARAMETERS, sea_remarks(fit.model, tests))
        last = (*remarks, *part.notes(), *notes_of(NoteKind.RECORDS, warnings))
        return calibration_of(campaign, fit, uncertainty, tests, clock.monotonic() - begun, kinds=IN_WAVES, last=last)

    return run_interruptibly(fit, lambda: fit.run_rounds("round {} in waves", MAX_ROUNDS, TOLERANCE), finish)


def tests_in_waves(
    campaign: Campaign, baseline: Model, model: Model, options: Options, made: Seas
) -> tuple[tuple[TestFit, ...], tuple[str, ...]]:
    """All tests in waves with a calibrated model and with the baseline, and warnings."""
    after, before = (compare(campaign, candidate, options, made=made) for candidate in (model, baseline))
    tests = tuple(_test(*pair) for pair in zip(after.tests, before.tests, strict=True))
    return tests, tuple(dict.fromkeys(before.notes + after.notes))


def _test(after: SeaTest, before: SeaTest) -> TestFit:
    """A test with both motions and the errors of its bands; its large motions count in J."""
    counts = moving_channels({s.channel: s.measured for s in after.fit.series})
    series = tuple(replace(s, scored=s.channel in counts) for s in after.fit.series)
    start = {s.channel: s.simulated for s in before.fit.series}
    bands = {}
    if after.fit.kind == "irregular":
        earlier = in_bands(before)
        bands = {
            name: {k: BandError(band.error, earlier[name][k].error, band.low, band.high) for k, band in row.items()}
            for name, row in in_bands(after).items()
            if name in counts
        }
    return replace(after.fit, series=series, start=start, bands=bands)
