"""Joint calibration to decays, tests in waves, static offsets and natural periods."""

import time as clock
from collections.abc import Callable, Sequence
from typing import get_args

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest import IN_WAVES
from calibration.fitting.decay_fit import Interrupted, Progress, held_out, labels_of, prepare_fit, run_fit, space_of
from calibration.fitting.fit_conclusion import estimates, records_not_followed, remarks
from calibration.fitting.joint_state import JointFit, Kind, Loss, Sources
from calibration.fitting.sea_fit import tests_in_waves
from calibration.formatting import listed, number, percent, with_deviation
from calibration.residuals.measured_seas import Options, Seas, moving_channels, options_of, sea_step, seas_of, with_diffraction
from calibration.residuals.seas import Objective, SeaProblem, set_up_waves
from calibration.residuals.static import set_up_offsets, set_up_periods
from calibration.result import Calibration
from jaxhydro.choices import check
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.statics import natural_modes
from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError, Problem
from jaxhydro.interrupts import stopping


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
    a test (see `JointFit`). The decays are fitted first, alone; the joint fit begins there.

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
    declared = with_diffraction(campaign.model, options)
    moved = {str(record.degree_of_freedom) for record in [*decays, *held]} | set(stated_periods)
    for record in waves:
        moved |= set(moving_channels({k: record.values[k] for k in DOFS if k in record.values}))
    labels = labels_of(campaign, declared, sorted(moved), free)
    first_model = declared.with_values(start or {})
    space = space_of(campaign, labels, first_model)
    from_rest, scale = campaign.manifest.zero is not None, campaign.manifest.scale
    fit = None
    x = space.start
    if decays:

        def first(stage: str, iteration: int, value: float, fraction: float) -> None:
            report(stage, iteration, value, 0.3 * fraction, "J")

        fit = prepare_fit(campaign, free=labels, start=start, begin=begin, report=first)
        run_fit(fit)
        x = fit.unknowns.shared
    made: Seas = seas_of(campaign, declared.environment, options) if waves else ()
    reached = space.model(first_model, x)

    def problem_in_waves(model: Model) -> SeaProblem:
        step = sea_step(declared, options)
        return set_up_waves(model, made, space, options, from_rest=from_rest, scale=scale, step=step, objective=objective)

    sources = Sources(
        None if fit is None else fit.problem,
        problem_in_waves(reached) if waves else None,
        set_up_offsets(first_model, held, space, from_rest) if held else None,
        set_up_periods(first_model, stated_periods, space, scale) if stated_periods else None,
    )
    later = 0.3 if decays else 0.0

    def now(stage: str, iteration: int, value: float, share: float) -> None:
        report(stage, iteration, value, later + (1 - later) * share)

    joint = JointFit(sources, fit, space, x, now, loss, problem_in_waves)
    counts = {"decay{}": decays, "test{} in waves": waves, "static offset{}": held, "natural period{}": stated_periods}
    words = listed([f"{len(there)} {name.format('s' * (len(there) != 1))}" for name, there in counts.items() if there])

    def finish() -> Calibration:
        return _conclude(campaign, first_model, joint, options, made, words, clock.monotonic() - begun)

    try:
        joint.run()
    except KeyboardInterrupt:
        stopping()
        joint.converged = False
        raise Interrupted(finish() if joint.iterations else None) from None
    return finish()


def _conclude(
    campaign: Campaign, declared: Model, joint: JointFit, options: Options, made: Seas, words: str, seconds: float
) -> Calibration:
    """Parameters with their deviations, and all tests before and after."""
    x = np.asarray(joint.unknowns.shared)
    model = joint.space.model(declared, joint.unknowns.shared)
    spread, known = joint.uncertainty(words)
    parameters = estimates(joint.space, declared, x, spread)
    tests = list(joint.tests)
    lost = records_not_followed(tests, declared) if joint.loss == "squares" else []  # outliers are no sign of a wrong model
    notes: tuple[str, ...] = ()
    if tests:
        tests += held_out(campaign, declared, model)
    if made:
        in_waves, notes = tests_in_waves(campaign, declared, model, options, made)
        tests += in_waves
    said = remarks(campaign, parameters, known, ("decay", *IN_WAVES, "static"))
    said = (*_of_kinds(campaign, model, joint), *said)
    return Calibration(
        campaign.manifest.name,
        model,
        parameters,
        tuple(tests),
        joint.converged and not lost,
        joint.iterations,
        seconds,
        tuple(joint.history),
        (*lost, *said, *notes),
        campaign.platform.name,
        known,
    )


def _of_kinds(campaign: Campaign, model: Model, joint: JointFit) -> tuple[str, ...]:
    """How far off each kind is, periods fitted against stated, and what could not take part."""
    said = []
    if joint.loss != "squares":
        said.append("residuals count by Cauchy's loss: outliers hardly do")
    for kind, (variance, _) in joint.errors.items():
        error = np.sqrt(variance)
        if kind == "waves":
            assert joint.sources.waves is not None
            bands = [float(e) for e, b in zip(error, joint.sources.waves.in_bands, strict=True) if b]
            said += [f"estimated error of ln(simulated / measured energy): {number(one, 2)}" for one in bands]
        elif kind == "offsets":
            said.append(f"estimated error of a static offset: {percent(float(error[0]))} of the motion that was held")
    if joint.sources.periods is not None:
        fitted, scale = natural_modes(model), campaign.manifest.scale**0.5
        for dof, one in campaign.manifest.calibrate.natural_periods.items():
            stated = with_deviation(one.value * scale, one.standard_deviation * scale)
            said.append(f"natural period in {dof}: {number(fitted.of(dof), 4)} s, stated {stated} s")
    idle = [r.id for r in campaign.used("fit") if r.kind == "static" and r.degree_of_freedom is None]
    if idle:
        said.append(f"static tests without a `degree_of_freedom`, the motion that was held, are left out: {', '.join(idle)}")
    return tuple(said)
