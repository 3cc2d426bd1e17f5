"""Acceptance of an effect: BIC, held-out error, significance and relevance."""

import math
from typing import NamedTuple

import numpy as np

from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.fit_state import FitState, ResidualSummary
from calibration.discovery.linearisations import RELATIVE_FLOOR, Prior
from calibration.discovery.refusal import ComparedData, Refusal, RefusalKind
from calibration.discovery.score_covariance import deviations_of, dispersion_of, parameter_covariance
from calibration.discovery.study import Study
from calibration.identifiability.information import pseudo_inverse

# thresholds, chosen so that nothing is found in campaigns with nothing missing
MIN_BIC_GAIN = 6.0  # strong evidence (Kass and Raftery 1995)
MIN_LIKELIHOOD_GAIN = 30.0  # BIC and held-out -2 ln L together; BIC alone without such data
MIN_HELD_OUT_SHARE = 0.15  # fraction of the squared held-out error above the floor
MIN_HELD_OUT_GAIN = 10.0  # decrease of held-out -2 ln L: very strong evidence (Kass and Raftery 1995)
MIN_SIGNIFICANCE = 3.0  # standard deviations
MIN_MOTION_SHARE = 0.015  # of a motion: smallest change of its error that matters ...
MIN_FLOOR_MULTIPLE = 3.0  # ... or this many times the floor, if less


class HeldOutComparison(NamedTuple):
    """Residuals without and with an effect, in the series that decide on it.

    Attributes:
        study: The study whose series are compared.
        compared: Which of its series (s,) count.
        before: Residual without the effect.
        after: Residual with the effect.
        unseen: Whether the compared series were not fitted.
    """

    study: Study
    compared: np.ndarray
    before: ResidualSummary
    after: ResidualSummary
    unseen: bool

    def error_reduction(self) -> tuple[float, bool]:
        """Fraction of the squared error above the floor that the effect removes, where it removes most.

        Motions and frequency regions are compared one by one; tests are averaged geometrically. An effect acts in one motion
        and some frequencies: an unchanged error elsewhere does not count against it, and a larger one counts in
        `likelihood_gain`.

        Returns:
            The fraction (1: all of it), and whether there was an error to reduce.
        """
        dof = self.study.by_region(self.study.pooled)
        before, after = self.before.squares, self.after.squares
        selected = self.compared[:, None] & (np.maximum(before, after) > 0.2 * dof) & (dof > 0)
        if not selected.any():
            return 0.0, self.unseen
        ratio = np.log(np.where(selected, after + 0.1 * dof, 1.0) / np.where(selected, before + 0.1 * dof, 1.0))
        weight = np.array([series.weight for series in self.study.series])
        log_ratios = []
        for channel in dict.fromkeys(series.channel for series in self.study.series):
            mine = selected & np.array([[series.channel == channel] for series in self.study.series])
            log_ratios += [float(weight[m] @ r[m] / weight[m].sum()) for m, r in zip(mine.T, ratio.T) if m.any()]
        return 1 - math.exp(min(log_ratios)), True

    @property
    def likelihood_gain(self) -> float:
        """Decrease of -2 ln L summed over the compared series."""
        return float((self.before.likelihood - self.after.likelihood)[self.compared].sum())

    def relevance(self) -> float:
        """Largest decrease of a motion's error in a region, divided by the smallest decrease that matters.

        Fitted tests count beside the compared ones: they may be the only ones in which the effect is large. In motions other
        than a decay's own, only the noise floor sets what matters.
        """
        study = self.study
        samples = np.array([[series.samples] for series in study.series])
        squares = study.by_region(study.dof * study.floor**2) / samples
        noise = study.by_region(study.dof) * np.array([[series.noise**2] for series in study.series]) / samples
        of_floor = np.array([[RELATIVE_FLOOR[series.kind]] for series in study.series])
        decay = np.array([[series.kind == "decay"] for series in study.series])
        spread, floor_rms = np.array([[(series.spread, series.floor_rms)] for series in study.series]).transpose(2, 0, 1)
        motion = np.where(decay, spread, np.sqrt(np.maximum(squares - noise, 0.0)) / of_floor)
        asked = np.where(study.main[:, None], MIN_MOTION_SHARE * motion, math.inf)
        least = np.minimum(asked, MIN_FLOOR_MULTIPLE * np.where(decay, floor_rms, np.sqrt(squares)))
        counted = study.used | self.compared
        fallen = (self.before.parts - self.after.parts)[counted]
        return float((fallen / np.maximum(least[counted], 1e-300)).max(initial=0.0))


class Verdict(NamedTuple):
    """Outcome of the tests that an effect has to pass.

    Attributes:
        bic: Decrease of BIC in the fitted tests.
        held: Fraction of the squared error that the effect removes.
        unseen: Whether `held` is of data that were not fitted.
        net: Decrease of -2 ln L of these data.
        clear: Parameters over their standard deviations.
        matters: Largest decrease of an error over the smallest that matters.
        refused: Why the effect is rejected; None where it is accepted.
    """

    bic: float
    held: float
    unseen: bool
    net: float
    clear: float
    matters: float
    refused: Refusal | None

    @property
    def worth(self) -> float:
        """Gain in fitted and held-out tests together."""
        return self.bic + self.net


def assess_effect(
    study: Study,
    before: FitState,
    after: FitState,
    candidate: Candidate,
    prior: Prior,
    count: float,
    grounds: HeldOutComparison,
) -> Verdict:
    """Whether an effect is accepted.

    Args:
        study: The study.
        before: Fit without the effect.
        after: Fit with the effect.
        candidate: The effect.
        prior: Priors of the fit with the effect.
        count: Number of independent observations, for BIC.
        grounds: Residuals without and with the effect, in the series that decide.

    Returns:
        The verdict, with the reason where the effect is rejected.
    """
    dispersion = dispersion_of(study, after.linearisation, prior)
    gain = float((before.likelihood - after.likelihood)[study.used].sum()) / dispersion
    bic = gain - len(candidate.labels) * math.log(count)
    held, told = grounds.error_reduction()
    net, clear = grounds.likelihood_gain / dispersion, significance(study, candidate, after, prior)
    matters = grounds.relevance()
    values = {label: study.value(label, after.linearisation.point.x) for label in candidate.positive}
    wrong = [label for label, value in values.items() if value < 0 and is_significant(study, label, candidate, after, prior)]
    where = ComparedData.HELD_OUT if grounds.study is study else ComparedData.BLOCKS
    where = where if grounds.unseen else ComparedData.FITTED
    impossible = Refusal(RefusalKind.IMPOSSIBLE_VALUE, (float(values[wrong[0]]),), wrong[0]) if wrong else None
    refused = impossible or reason_to_reject(bic, held if told else None, net, clear, matters, where)
    # that it hardly matters is said where nothing else speaks against it
    if refused is None or refused.kind == RefusalKind.NEGLIGIBLE:
        refused = worsened_motion(study, candidate.dof, before.summary, after.summary) or refused
    return Verdict(bic, held, grounds.unseen, net, clear, matters, refused)


def reason_to_reject(
    bic: float, held: float | None, net: float, clear: float, matters: float, where: ComparedData
) -> Refusal | None:
    """Reason why an effect is rejected, or None.

    Args:
        bic: Decrease of BIC in the fitted tests.
        held: Fraction of the squared error removed; None where there was no error to reduce.
        net: Decrease of -2 ln L of the compared data.
        clear: Parameters over their standard deviations.
        matters: Largest decrease of an error over the smallest that matters.
        where: Which data were compared.
    """
    apart = held is not None and where == ComparedData.HELD_OUT
    if bic < (least := MIN_BIC_GAIN if apart else MIN_LIKELIHOOD_GAIN):
        # blocks and fitted tests alike are no tests that were held out
        compared = ComparedData.HELD_OUT if apart else ComparedData.FITTED
        return Refusal(RefusalKind.LITTLE_BIC_GAIN, (bic, least), compared=compared)
    if held is not None and held < MIN_HELD_OUT_SHARE:
        return Refusal(RefusalKind.HELD_OUT_ERROR, (float(held),), compared=where)
    if held is not None and net < MIN_HELD_OUT_GAIN:
        return Refusal(RefusalKind.HELD_OUT_LIKELIHOOD, (float(net),), compared=where)
    if apart and bic + net < MIN_LIKELIHOOD_GAIN:
        return Refusal(RefusalKind.LITTLE_TOTAL_GAIN, (bic, float(net)), compared=where)
    if clear < MIN_SIGNIFICANCE:
        return Refusal(RefusalKind.INSIGNIFICANT, (clear,), compared=where)
    return Refusal(RefusalKind.NEGLIGIBLE, compared=where) if matters < 1 else None


def worsened_motion(study: Study, dof: str | None, before: ResidualSummary, after: ResidualSummary) -> Refusal | None:
    """Reason to reject an effect with which its own motion is followed worse, or None.

    The objective (sum of RMSE / standard deviation) is compared over all tests and over the held-out ones. Likelihoods give
    slow motion little weight, since unknown forces could cause it (`Study.expected`); engineers ask for it.

    Args:
        study: The study.
        dof: The motion that the effect acts in; None: all motions.
        before: Residual without the effect.
        after: Residual with the effect.
    """
    mine = study.main & np.array([series.channel == (dof or series.channel) and series.spread > 0 for series in study.series])
    spread = np.array([series.spread if series.spread > 0 else 1.0 for series in study.series])
    for selected, where in ((mine, ComparedData.ALL), (mine & ~study.used, ComparedData.HELD_OUT)):
        was, now = (float((summary.error / spread)[selected].sum()) for summary in (before, after))
        if now > was + MIN_MOTION_SHARE:
            return Refusal(RefusalKind.WORSE_MOTION, (was, now), dof or "", where)
    return None


def worsening(study: Study, before: ResidualSummary, after: ResidualSummary) -> np.ndarray:
    """Growth of each motion's error from one fit to another, over the smallest growth that matters (s,).

    Growth within the floor does not matter. Motions that a test is not about have zero.

    Args:
        study: The study.
        before: Residual of the first fit.
        after: Residual of the second fit.
    """
    least = np.array([max(MIN_MOTION_SHARE * series.spread, series.floor_rms) for series in study.series])
    return np.where(study.main, (after.error - before.error) / least, 0.0)


def is_significant(study: Study, label: str, candidate: Candidate, state: FitState, prior: Prior) -> bool:
    """Whether a parameter differs from zero beyond doubt.

    The only amplitude of an effect always does; one of several has to be two standard deviations away.
    """
    i = study.names.index(label)
    linearisation = state.linearisation
    deviation = float(deviations_of(study, linearisation, prior)[linearisation.active.index(i)])
    return len(candidate.amplitudes) == 1 or abs(float(study.steps(linearisation.point.x)[i])) > 2 * deviation


def significance(study: Study, candidate: Candidate, state: FitState, prior: Prior) -> float:
    """An effect's amplitudes over their standard deviations.

    Several amplitudes together are expressed as one normal variable (Wald statistic less the extra degrees of freedom).
    """
    linearisation = state.linearisation
    columns = [linearisation.active.index(i) for i in study.index(candidate.amplitudes)]
    covariance = parameter_covariance(study, linearisation, prior)[np.ix_(columns, columns)]
    steps = study.steps(linearisation.point.x)[study.index(candidate.amplitudes)]
    wald = float(steps @ pseudo_inverse(covariance) @ steps)
    return math.sqrt(max(wald - len(columns) + 1, 0.0))
