"""Greedy search: score all candidates, refit a shortlist, accept the best, repeat."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.discovery.acceptance import (
    MIN_BIC_GAIN,
    MIN_HELD_OUT_GAIN,
    MIN_LIKELIHOOD_GAIN,
    MIN_SIGNIFICANCE,
    FitState,
    ResidualSummary,
)
from calibration.discovery.candidate_scores import CandidateScoring
from calibration.discovery.candidate_trials import AcceptedEffect, RefittedCandidate, ScoredCandidate, in_order_of_belief
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.effects.effect_names import effect_in_words
from calibration.discovery.eliminated_least_squares import predict_gain, prior_residuals
from calibration.discovery.refusal import Refusal, RefusalKind
from calibration.discovery.set_up import StudySetup
from calibration.formatting import listed

MAX_EFFECTS = 10  # effects in a model
SHORTLIST = 5  # candidates refitted in a round
SHARED_NOTE = "{first} hardly matters beside {later}, yet explains more: they share what they explain, and may be one other law"
MASS_DEVIATIONS_ALLOWED = 2.0  # standard deviations by which weighed mass properties may be off
MIN_RELATIVE_PROMISE = 0.3  # of the best refit's gain: candidates that promise less are not refitted


class Search(CandidateScoring):
    """Greedy search for missing effects.

    Attributes:
        notes: Notes to report, in words.
        earlier: Computing time of earlier, stopped runs (s).
        alone: Residual of a calibration to decays alone, where there are seas too.
        found: Evidence of the accepted effects by name.
    """

    def __init__(self, campaign: Campaign, setup: StudySetup, say: Callable[[str, float], None]) -> None:
        super().__init__(campaign, setup, say)
        self.notes: list[str] = []
        self.earlier = 0.0  # s, that runs of it took which were stopped
        self.alone: ResidualSummary | None = None  # of a calibration to the decays, where there are seas, too
        self.found: dict[str, AcceptedEffect] = {}

    def fit_baseline(self) -> FitState:
        """Fit the declared model."""
        self.say("calibrating the declared model", 0.03)
        place = self.start
        self.anchor(place.x)
        if self.study.decays is not None and self.study.seas:
            self.alone = ResidualSummary.of(self.study, self.study.residual(place))
        if self.study.seas:
            self.weigh_by_expected(place)
        self.say("declared model: slopes", 0.08)
        return self.refit(self.study.linearise(place, self.base), (), "declared model", 0.1)

    def likelihood_gain(self, before: FitState, after: FitState) -> float:
        """Decrease of -2 ln L of the fitted tests from one state to another."""
        return float((before.likelihood - after.likelihood)[self.study.used].sum())

    def add_effect(self, state: FitState, number: int) -> tuple[FitState, FitState | None]:
        """One round: score candidates, refit a shortlist, accept the best.

        Returns:
            The state, better fitted where that was found on the way, and the state with a new effect or None.
        """
        done = 0.15 + 0.8 * (number - 1) / MAX_EFFECTS
        enough = 2 * math.log(self.count)
        ranked = [
            item._replace(starting_values=self.starting_values(item.candidate, state))
            for item in self.score(state, number, done)
        ]
        some = [item for item in ranked if item.promise > enough]
        for item in ranked:
            weak = item.promise <= enough
            kind = RefusalKind.WEAK_AT_FIRST_ORDER if weak else RefusalKind.OUTDONE_AT_FIRST_ORDER
            self.reject(item.candidate, Refusal(kind))
        known = [item for item in ranked if item.starting_values]  # worth a trial whatever they are at first order
        some = [item for item in some if not item.starting_values]
        state, after = self.best_of_shortlist(state, [*known, *some[:SHORTLIST]], number, done)
        if after is None and (others := self.best_by_motion(some[SHORTLIST:], enough)):
            state, after = self.best_of_shortlist(state, others, number, done + 0.1)
        return state, after

    def best_by_motion(self, rest: Sequence[ScoredCandidate], enough: float) -> list[ScoredCandidate]:
        """For every motion the candidate that explains most of it, among the rest."""
        found: dict[str, ScoredCandidate] = {}
        for channel in dict.fromkeys(one.channel for one in self.study.series) if rest else ():
            mine = self.study.used & np.array([one.channel == channel for one in self.study.series])
            gains = [float(item.predicted.gain[mine].sum()) for item in rest]
            if max(gains) > enough:
                best = rest[int(np.argmax(gains))]
                found[best.candidate.name] = best
        return list(found.values())

    def best_of_shortlist(
        self, state: FitState, short: Sequence[ScoredCandidate], number: int, done: float
    ) -> tuple[FitState, FitState | None]:
        """Refit a shortlist and accept its best candidate. See `add_effect`."""
        tried: list[RefittedCandidate] = []
        for item in short:
            highest = max((one.worth for one in tried if not one.verdict.refused), default=0.0)
            if item.promise < MIN_RELATIVE_PROMISE * highest and not item.starting_values:
                self.reject(item.candidate, Refusal(RefusalKind.FAR_WEAKER))
            else:
                tried.append(self.refit_candidate(state, item, number, done + 0.02 * (len(tried) + 1)))
        for one in tried:
            self.reject(one.candidate, one.verdict.refused)
        good = in_order_of_belief([one for one in tried if not one.verdict.refused])
        for best in good:
            new, chosen = best.candidate, best.state.chosen
            name = f"round {number}: {new.name}, to the end"
            # what is only nearly known was bent by what the model lacked
            effects = {label for one in chosen for label in one.labels}
            bent = [nuisance for nuisance in self.setup.nuisances if nuisance not in effects]
            after = self.refit(
                self.study.linearise(place := best.state.look.place, self.active(chosen)), chosen, name, done + 0.15
            )
            after = self.refitted_from(place := self.with_starting_values(place, bent), after, chosen, name, done + 0.15)
            if self.study.seas:  # ... and so were coefficients
                after = self.refitted_from(self.with_starting_values(place, self.setup.base), after, chosen, name, done + 0.15)
            state = self.refitted_without(state, after, new, done + 0.16)
            self.say(f"{name}: blocks left out in turn" if self.study.used.all() else name, done + 0.17)
            verdict = self.assess(state, after, new, last=True)
            self.reject(new, verdict.refused)
            if verdict.refused:
                continue
            rest = [one for one in good if one is not best]
            near = tuple(one.candidate.name for one in rest if one.indistinguishable_from(best))
            self.found[new.name] = AcceptedEffect(best.score, state, after, verdict, near)
            for one in rest:
                self.reject(one.candidate, Refusal(RefusalKind.OUTDONE, name=new.name))
            self.rejected.pop(new.name, None)
            return state, after
        return state, None

    def refitted_without(self, without: FitState, after: FitState, one: Candidate, fraction: float) -> FitState:
        """The model without an effect, refitted from the fit with it where that is far better.

        Any effect may help a fit over an obstacle, and is not to be accepted for that.
        """
        place, name = self.with_starting_values(after.look.place, one.labels), f"without {one.name}"
        other = self.refit(self.study.linearise(place, without.look.active), without.chosen, name, fraction)
        return other if self.likelihood_gain(without, other) > MIN_LIKELIHOOD_GAIN else without

    def without_needless_effects(self, state: FitState) -> FitState:
        """The model without effects that later ones made needless.

        Every effect but the last is removed on trial. One that gains more than the later effects stays, though it hardly
        matters beside them: they share what they explain.
        """
        spared: list[Candidate] = []
        for one in state.chosen[:-1]:
            rest = tuple(other for other in state.chosen if other is not one)
            look = self.study.linearise(self.with_starting_values(state.look.place, one.labels), self.active(rest))
            without = self.refit(look, rest, f"without {one.name}", 0.97)
            verdict, later = self.assess(without, state, one, last=True), state.chosen[state.chosen.index(one) + 1 :]
            negligible = verdict.refused is not None and verdict.refused.kind == RefusalKind.NEGLIGIBLE
            if negligible and verdict.worth > max(self.found[other.name].verdict.worth for other in later):
                verdict = verdict._replace(refused=None)
                spared.append(one)
            if verdict.refused is not None:
                self.reject(one, replace(verdict.refused, later=True), verdict)
                state = without
            else:
                self.found[one.name] = self.found[one.name]._replace(verdict=verdict)
        for one in spared:
            later = state.chosen[state.chosen.index(one) + 1 :]
            self.notes.append(
                SHARED_NOTE.format(
                    first=effect_in_words(one.name), later=listed([effect_in_words(other.name) for other in later])
                )
            )
        return state

    def with_mass_properties(self, state: FitState) -> FitState:
        """The model with mass properties as an effect, where they are further off than weighing usually is.

        They are free within their priors in every fit, so that no error shows that they are wrong.
        """
        one = next((one for one in self.setup.candidates if one.effect == "mass_properties"), None)
        if one is None or one in state.chosen:
            return state
        mine, width = self.study.index(one.amplitudes), self.setup.prior.width[self.study.index(one.amplitudes)]
        if np.abs(self.study.steps(state.look.place.x)[mine] / width).max() < 1:
            return state
        chosen = (*state.chosen, one)
        after = self.refit(self.study.linearise(state.look.place, self.active(chosen)), chosen, "mass properties let go", 0.98)
        prior = self.prior(chosen)
        deviation = predict_gain(self.study, after.look, prior).deviation[[after.look.active.index(i) for i in mine]]
        far = (np.abs(self.study.steps(after.look.place.x)[mine]) - MASS_DEVIATIONS_ALLOWED * width) / deviation
        squares = [
            float((prior_residuals(self.study, at.look.place, by)[0][mine] ** 2).sum())
            for at, by in ((state, self.prior(state.chosen)), (after, prior))
        ]
        gain = self.likelihood_gain(state, after) + squares[0] - squares[1]
        off = [label for label, beyond in zip(one.amplitudes, far) if beyond > MIN_SIGNIFICANCE]
        if not off or gain - len(off) * math.log(self.count) < MIN_BIC_GAIN:
            return state
        verdict = self.assess(state, after, one, last=True)
        if verdict.net < -MIN_HELD_OUT_GAIN:
            return state
        # scores and BIC are of errors, and none tells of it
        self.found[one.name] = AcceptedEffect(math.nan, state, after, verdict._replace(bic=math.nan, refused=None), ())
        self.rejected.pop(one.name, None)
        names = " and ".join(label.split(".")[1].replace("_", " ") for label in off)
        self.notes.append(
            f"{names} {'are' if len(off) > 1 else 'is'} further from what is declared than what was weighed usually is; the "
            "records are followed no better for it, as mass properties are free to move a little in every fit"
        )
        return after
