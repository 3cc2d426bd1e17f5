"""Calibration to decays: the fit, its result, and the decays that were held out."""

import time as clock
from collections.abc import Callable, Sequence

import jax.numpy as jnp
import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.fitting.decay_fit import fit_of_decays, minimise_window, prepare_fit, run_fit, set_up_decays
from calibration.fitting.decay_part import series_of
from calibration.fitting.fit import Fit
from calibration.fitting.fit_conclusion import calibration_of, period_remarks, records_not_followed, source_of
from calibration.fitting.progress import Progress, run_interruptibly
from calibration.parameters.space import ParameterSpace
from calibration.result import Calibration, TestFit
from jaxhydro.dynamics.model import Model


def calibrate(
    campaign: Campaign,
    *,
    free: Sequence[str] | None = None,
    progress: Callable[[Progress], None] | None = None,
    start: dict[str, float] | None = None,
    begin: dict[str, float] | None = None,
) -> Calibration:
    """Fit the baseline model's coefficients to all decay records marked `fit`.

    The objective is J, the sum of RMSE / standard deviation over the records' released degrees of freedom. It is minimised
    by least squares, with weights renewed from the errors reached, so that the sum of RMSE is stationary. The fitted window
    grows from a little over one cycle to the whole record: natural periods are found before the phase of late cycles
    matters. Where the error comes down to the noise everywhere, a last pass weighs every sample by its noise (maximum
    likelihood). Initial position, initial rate and sensor offset of every record and channel are free.

    Args:
        campaign: The campaign.
        free: Labels or patterns of the free parameters; None for those of the manifest.
        progress: Function that is called with the progress after every iteration.
        start: Values in place of the platform's, by label. The fit begins there, and vague priors are centred there.
        begin: Values where the fit begins, by label, without effect on priors. Those of a search, for example.

    Returns:
        The calibrated model, its parameters with their uncertainty, and all decay tests.

    Raises:
        InputError: If there is nothing to fit.
        Interrupted: If the user stops the fit (a KeyboardInterrupt); it holds what was reached.
    """
    begun = clock.monotonic()

    def report(stage: str, iteration: int, objective: float, fraction: float) -> None:
        if progress is not None:
            progress(Progress(stage, iteration, objective, fraction))

    fit = prepare_fit(campaign, free=free, start=start, begin=begin, report=report)

    def finish() -> Calibration:
        return conclude(campaign, fit.decays.problem.model, fit, clock.monotonic() - begun)

    return run_interruptibly(fit, lambda: run_fit(fit), finish)


def conclude(campaign: Campaign, baseline: Model, fit: Fit, seconds: float) -> Calibration:
    """Result of a fit: parameters with standard deviations, and all decay tests with the fitted model."""
    uncertainty = fit.uncertainty(source_of(fit.decays.records))
    lost = records_not_followed(fit.decays.tests, baseline)
    tests = [*fit.decays.tests, *held_out(campaign, baseline, fit.model)]
    return calibration_of(campaign, fit, uncertainty, tests, seconds, lost=lost, first=period_remarks(tests))


def held_out(campaign: Campaign, baseline: Model, model: Model) -> list[TestFit]:
    """Decays marked `holdout`, simulated with the model after and before the fit.

    Releases and offsets of sensors are fitted to each record; coefficients stay.

    Args:
        campaign: The campaign.
        baseline: The model before the fit.
        model: The calibrated model.
    """
    held = [record for record in campaign.used("holdout") if record.kind == "decay"]
    if not held:
        return []
    empty = ParameterSpace(())
    problem = set_up_decays(model, campaign, held, empty)
    judge = fit_of_decays(problem, held, jnp.zeros(0))
    weight = judge.decays.record_weights(np.ones(len(held)))
    minimise_window(judge, "held-out records", weight, judge.decays.ends, 1e-4, (1.0, 1.0))
    return series_of(problem, held, judge.unknowns, set_up_decays(baseline, campaign, held, empty))
