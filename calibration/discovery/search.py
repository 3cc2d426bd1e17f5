"""Base of a search: scores, accepted and rejected effects, fit of the baseline, mass properties."""

import math
from typing import NamedTuple

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.discovery.acceptance import MIN_BIC_GAIN, MIN_HELD_OUT_GAIN, MIN_SIGNIFICANCE, Verdict
from calibration.discovery.diagnosis import Rejected, Score
from calibration.discovery.effect_fits import EffectFits, ReportStage
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.eliminated_least_squares import predict_gain, prior_residuals
from calibration.discovery.fit_state import FitState, ResidualSummary
from calibration.discovery.refusal import Refusal
from calibration.discovery.set_up import StudySetup
from jaxhydro.interrupts import stoppable_threads

MASS_DEVIATIONS_ALLOWED = 2.0  # standard deviations by which weighed mass properties may be off


class AcceptedEffect(NamedTuple):
    """Evidence of an effect in the model.

    Attributes:
        score: First-order decrease of -2 ln L.
        before: Fit without the effect.
        after: Fit with the effect.
        verdict: Outcome of the acceptance tests.
        alike: Names of effects that the records cannot tell from it.
        probability: Posterior probability; NaN where none was computed.
        held_out: Decrease of -2 ln L of every test that was left out in turn (t,).
    """

    score: float
    before: FitState
    after: FitState
    verdict: Verdict
    alike: tuple[str, ...]
    probability: float
    held_out: np.ndarray


class ListedVariant(NamedTuple):
    """A candidate at values of its shapes.

    Attributes:
        name: Name of the candidate.
        values: Values of its shapes (SI).
    """

    name: str
    values: dict[str, float]


class Search(EffectFits):
    """Search for missing effects.

    Attributes:
        scores: First-order gains of the candidates in every round.
        rejected: Why candidates are not in the model, by name.
        notes: Notes to report, in words.
        earlier: Computing time of earlier, stopped runs (s).
        alone: Residual of a calibration to decays alone, where there are seas too.
        accepted: Evidence of the accepted effects by name.
        shortlist: Candidates that helped in the rounds along all candidates, or were in probable sets.
    """

    def __init__(self, campaign: Campaign, setup: StudySetup, say: ReportStage) -> None:
        super().__init__(campaign, setup, say)
        self.scores: list[Score] = []
        self.rejected: dict[str, Rejected] = {}
        self.notes: list[str] = []
        self.earlier = 0.0
        self.alone: ResidualSummary | None = None
        self.accepted: dict[str, AcceptedEffect] = {}
        self.shortlist: list[ListedVariant] = []

    def fit_baseline(self) -> FitState:
        """Fit the baseline."""
        self.say("fitting the baseline", 0.03)
        with stoppable_threads(1) as beside:
            beside.submit(self.study.simulations.compile_decays, self.begun)
            point = self.start
        self.anchor(point.x)
        if self.study.decays is not None and self.study.seas:
            self.alone = ResidualSummary.of(self.study, self.study.residual(point))
        if self.study.seas:
            self.weigh_by_expected(point)
        self.say("baseline: slopes", 0.1)
        return self.refit(self.study.linearise(point, self.base), (), "baseline", 0.15)

    def likelihood_gain(self, before: FitState, after: FitState) -> float:
        """Decrease of -2 ln L of the fitted tests from one state to another."""
        return float((before.likelihood - after.likelihood)[self.study.used].sum())

    def reject(self, candidate: Candidate, why: Refusal | None, taken_out: Verdict | None = None) -> None:
        """Record why a candidate is not in the model.

        Args:
            candidate: The candidate.
            why: The reason; None records nothing.
            taken_out: The verdict that removed it, where it was in the model.
        """
        if why is not None:
            self.rejected[candidate.name] = Rejected(candidate.effect, candidate.dof, why, taken_out)

    def with_mass_properties(self, state: FitState) -> FitState:
        """The model with mass properties as an effect, where they are further off than weighing usually is.

        They are free within their priors in every fit, so that no error shows that they are wrong.
        """
        candidate = next((candidate for candidate in self.setup.candidates if candidate.effect == "mass_properties"), None)
        if candidate is None or candidate in state.chosen:
            return state
        mine, width = self.study.index(candidate.amplitudes), self.setup.prior.width[self.study.index(candidate.amplitudes)]
        if np.abs(self.study.steps(state.linearisation.point.x)[mine] / width).max() < 1:
            return state
        chosen = (*state.chosen, candidate)
        after = self.refit(
            self.study.linearise(state.linearisation.point, self.active(chosen)), chosen, "mass properties let go", 0.98
        )
        prior = self.prior(chosen)
        deviation = predict_gain(self.study, after.linearisation, prior).deviation[
            [after.linearisation.active.index(i) for i in mine]
        ]
        far = (np.abs(self.study.steps(after.linearisation.point.x)[mine]) - MASS_DEVIATIONS_ALLOWED * width) / deviation
        squares = [
            float((prior_residuals(self.study, fitted.linearisation.point, by)[0][mine] ** 2).sum())
            for fitted, by in ((state, self.prior(state.chosen)), (after, prior))
        ]
        gain = self.likelihood_gain(state, after) + squares[0] - squares[1]
        off = [label for label, beyond in zip(candidate.amplitudes, far) if beyond > MIN_SIGNIFICANCE]
        if not off or gain - len(off) * math.log(self.count) < MIN_BIC_GAIN:
            return state
        verdict = self.assess(state, after, candidate, last=True)
        if verdict.net < -MIN_HELD_OUT_GAIN:
            return state
        # scores and BIC are of errors, and none tells of it
        self.accepted[candidate.name] = AcceptedEffect(
            math.nan, state, after, verdict._replace(bic=math.nan, refused=None), (), math.nan, np.zeros(0)
        )
        self.rejected.pop(candidate.name, None)
        names = " and ".join(label.split(".")[1].replace("_", " ") for label in off)
        self.notes.append(
            f"{names} {'are' if len(off) > 1 else 'is'} further from the platform file's values than what was weighed usually "
            "is. The records are followed no better for it: mass properties are free to move a little in every fit"
        )
        return after
