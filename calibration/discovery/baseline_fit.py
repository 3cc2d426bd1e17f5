"""Fit of the baseline: the platform's model without any effect."""

from calibration.discovery.fit_state import FitState, ResidualSummary
from calibration.discovery.search import Search
from jaxhydro.interrupts import stoppable_threads


def fit_baseline(search: Search) -> FitState:
    """Fit the baseline, from a calibration to the decays on.

    Args:
        search: The search. Its fits are anchored there, and its record gets the residual of the decays alone.

    Returns:
        The fitted baseline.
    """
    fits, record = search
    fits.say("fitting the baseline", 0.03)
    with stoppable_threads(1) as beside:
        baseline, decays = fits.study.baseline_simulations, fits.study.simulations.decays
        if baseline is not None:
            beside.submit(baseline.compile_decays, fits.begun)
        elif decays is not None:
            beside.submit(decays.compile, fits.begun)
        point = fits.start
    fits.anchor(point.x)
    if fits.study.decays is not None and fits.study.seas:
        record.alone = ResidualSummary.of(fits.study, fits.study.residual(point))
    if fits.study.seas:
        fits.weigh_by_expected(point)
    fits.say("baseline: slopes", 0.1)
    return fits.refit(fits.study.linearise(point, fits.base), (), "baseline", 0.15)
