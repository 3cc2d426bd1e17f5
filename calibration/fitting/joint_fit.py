"""Joint calibration to decays, tests in waves, static offsets and natural periods."""

import time as clock
from collections.abc import Callable, Sequence
from typing import get_args

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest_sections import IN_WAVES
from calibration.fitting.decay_calibration import held_out
from calibration.fitting.decay_fit import labels_of, prepare_fit, run_fit, space_of
from calibration.fitting.decay_part import DecayPart
from calibration.fitting.fit import Fit
from calibration.fitting.fit_conclusion import calibration_of, records_not_followed
from calibration.fitting.progress import Progress, run_interruptibly
from calibration.fitting.sea_fit import tests_in_waves
from calibration.fitting.sea_part import SeaPart
from calibration.fitting.static_parts import OffsetPart, PeriodPart
from calibration.fitting.weighted_residuals import AbstractPart, Kind, Loss
from calibration.formatting import listed, number, percent, with_deviation
from calibration.notes import NoteKind, notes_of
from calibration.residuals.abstract_residual import parameters_only
from calibration.residuals.moving_channels import moving_channels
from calibration.residuals.run_seas import Seas, sea_step, seas_of, with_diffraction
from calibration.residuals.seas import Objective, SeaProblem, set_up_waves
from calibration.residuals.static import set_up_offsets, set_up_periods
from calibration.residuals.wave_options import Options, options_of
from calibration.result import Calibration
from jaxhydro.choices import check
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.statics import natural_modes
from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError, Problem

MAX_ROUNDS = 6  # times that the errors of the kinds of data are estimated anew
TOLERANCE = 1e-4  # relative decrease of the sum of squares that ends a round


def calibrate_jointly(
    campaign: Campaign,
    *,
    kinds: Sequence[Kind] = get_args(Kind),
    free: Sequence[str] | None = None,
    progress: Callable[[Progress], None] | None = None,
    start: dict[str, float] | None = None,
    begin: dict[str, float] | None = None,
    objective: Objective = "bands",
    loss: Loss = "squares",
    options: Options | None = None,
) -> Calibration:
    """Fit the baseline model's coefficients to decays, tests in waves, static offsets and natural periods.

    Decays and tests in waves enter as in `calibrate` and `calibrate_in_waves`. Static tests marked `fit` need a
    `degree_of_freedom`: an unknown force holds that motion, and the motions that go with it are fitted. Natural periods are
    those stated in the manifest. Each kind is weighed by its own error, estimated from its residuals, times the `weight` of
    a test (see `Fit.run_rounds`). The decays are fitted first, alone; the joint fit begins there.

    Args:
        campaign: The campaign.
        kinds: Kinds of data to be fitted.
        free: As in `calibrate`.
        progress: Function that is called with the progress after every iteration.
        start: As in `calibrate`.
        begin: As in `calibrate`.
        objective: Objective of tests in waves, as in `calibrate_in_waves`.
        loss: "squares", or "cauchy", with which large residuals (outliers, stretches not followed) hardly count.
        options: How waves are made and act, as in `calibrate_in_waves`.

    Returns:
        The calibrated model, its parameters with their uncertainty, and all tests.

    Raises:
        InputError: If there is nothing to fit.
        Interrupted: If the user stops the fit; it holds what was reached.
    """
    begun = clock.monotonic()
    options = options_of(campaign) if options is None else options
    source = str(campaign.folder / "campaign.yaml")
    for kind in kinds:
        check(kinds=(kind, get_args(Kind)))
    check(objective=(objective, get_args(Objective)), loss=(loss, get_args(Loss)))

    def report(stage: str, iteration: int, value: float, fraction: float, name: str = "error") -> None:
        if progress is not None:
            progress(Progress(stage, iteration, value, fraction, name))

    if objective == "blocks":
        raise InputError("--objective", [Problem("", "--tests waves beside blocks", "--tests all")])
    fitted = campaign.used("fit")
    decays = [record for record in fitted if record.kind == "decay" and "decays" in kinds]
    waves = [record for record in fitted if record.kind in IN_WAVES and "waves" in kinds]
    held = [r for r in fitted if r.kind == "static" and r.degree_of_freedom is not None and "offsets" in kinds]
    stated_periods = campaign.manifest.calibrate.natural_periods if "periods" in kinds else {}
    if not (decays or waves or held or stated_periods):
        expected = f"at least one test marked `use: fit`, or a natural period, among {', '.join(kinds)}"
        raise InputError(source, [Problem("tests", expected, "none")])
    baseline = with_diffraction(campaign.model, options)
    moved = {str(record.degree_of_freedom) for record in [*decays, *held]} | set(stated_periods)
    for record in waves:
        moved |= set(moving_channels({k: record.values[k] for k in DOFS if k in record.values}))
    labels = labels_of(campaign, baseline, sorted(moved), free)
    first_model = baseline.with_values(start or {})
    space = space_of(campaign, labels, first_model)
    from_rest, scale = campaign.manifest.zero is not None, campaign.manifest.scale
    parts: list[AbstractPart] = []
    unknowns = parameters_only(space.start)
    if decays:

        def first(stage: str, iteration: int, value: float, fraction: float) -> None:
            report(stage, iteration, value, 0.3 * fraction, "J")

        alone = prepare_fit(campaign, free=labels, start=start, begin=begin, report=first)
        run_fit(alone)
        unknowns = alone.unknowns
        parts.append(DecayPart(alone.decays.problem, alone.decays.records, loss))
    made: Seas = seas_of(campaign, baseline.environment, options) if waves else ()

    def problem_in_waves(model: Model) -> SeaProblem:
        step = sea_step(baseline, options)
        return set_up_waves(model, made, space, options, from_rest=from_rest, scale=scale, step=step, objective=objective)

    if waves:
        parts.append(SeaPart(problem_in_waves, space.model(first_model, unknowns.shared), pooled=False, loss=loss))
    if held:
        parts.append(OffsetPart(set_up_offsets(first_model, held, space, from_rest), loss))
    if stated_periods:
        parts.append(PeriodPart(set_up_periods(first_model, stated_periods, space, scale)))
    later = 0.3 if decays else 0.0

    def now(stage: str, iteration: int, value: float, share: float) -> None:
        report(stage, iteration, value, later + (1 - later) * share)

    joint = Fit(parts, unknowns, now)
    counts = {"decay{}": decays, "test{} in waves": waves, "static offset{}": held, "natural period{}": stated_periods}
    words = listed([f"{len(items)} {name.format('s' * (len(items) != 1))}" for name, items in counts.items() if items])

    def finish() -> Calibration:
        uncertainty = joint.uncertainty(words)
        tests = [*joint.decays.tests] if decays else []
        # outliers are no sign of a wrong model
        lost = records_not_followed(tests, first_model) if loss == "squares" else []
        tests += held_out(campaign, first_model, joint.model) if decays else []
        in_waves, warnings = tests_in_waves(campaign, first_model, joint.model, options, made) if made else ((), ())
        kind_remarks = _of_kinds(campaign, joint, loss)
        kinds, seconds = ("decay", *IN_WAVES, "static"), clock.monotonic() - begun
        return calibration_of(
            campaign,
            joint,
            uncertainty,
            [*tests, *in_waves],
            seconds,
            kinds=kinds,
            lost=lost,
            first=kind_remarks,
            last=notes_of(NoteKind.RECORDS, warnings),
        )

    return run_interruptibly(joint, lambda: joint.run_rounds("round {}", MAX_ROUNDS, TOLERANCE), finish)


def _of_kinds(campaign: Campaign, joint: Fit, loss: Loss) -> tuple[str, ...]:
    """Remarks on the error of each kind, on fitted against stated periods, and on tests left out."""
    sentences = []
    if loss != "squares":
        sentences.append("residuals count by Cauchy's loss: outliers hardly do")
    for part in joint.parts:
        assert part.errors is not None
        error = np.sqrt(part.errors.variance[0])
        if isinstance(part, SeaPart):
            bands = [float(e) for e, b in zip(error, part.problem.in_bands, strict=True) if b]
            sentences += [f"estimated error of ln(simulated / measured energy): {number(value, 2)}" for value in bands]
        elif isinstance(part, OffsetPart):
            sentences.append(f"estimated error of a static offset: {percent(float(error[0]))} of the motion that was held")
    if any(isinstance(part, PeriodPart) for part in joint.parts):
        fitted, scale = natural_modes(joint.model), campaign.manifest.scale**0.5
        for dof, period in campaign.manifest.calibrate.natural_periods.items():
            stated = with_deviation(period.value * scale, period.standard_deviation * scale)
            sentences.append(f"natural period in {dof}: {number(fitted.of(dof), 4)} s, stated {stated} s")
    idle = [r.id for r in campaign.used("fit") if r.kind == "static" and r.degree_of_freedom is None]
    if idle:
        sentences.append(
            f"static tests without a `degree_of_freedom`, the motion that was held, are left out: {', '.join(idle)}"
        )
    return tuple(sentences)
