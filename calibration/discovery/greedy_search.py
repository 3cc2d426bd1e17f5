"""The loop: fit, score every candidate at its null, refit a shortlist, decide on what was not fitted; until none is left."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.discovery.acceptance import (
    MIN_BIC_GAIN,
    MIN_HELD_OUT_GAIN,
    MIN_LIKELIHOOD_GAIN,
    MIN_SIGNIFICANCE,
    NEGLIGIBLE,
    FitState,
    ResidualSummary,
)
from calibration.discovery.candidate_scores import REFIT_ITERATIONS, CandidateScoring
from calibration.discovery.candidate_trials import AcceptedEffect, RefittedCandidate, ScoredCandidate, in_order_of_belief
from calibration.discovery.effect_fits import SecondOrderTreatment
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.effects.effect_names import effect_in_words
from calibration.discovery.eliminated_least_squares import minus_two_log_likelihood, predict_gain, prior_residuals
from calibration.discovery.set_up import StudySetup
from calibration.formatting import listed

MAX_EFFECTS = 10  # effects at most
SHORTLIST = 5
FIRST_ORDER_NOTE = (
    "waves act as of first order: what theory binds to them at second order is in the records, but with it the motions are "
    "followed worse"
)
SIMPLER_SEA_NOTES = {
    "cut": "differences of frequencies above {highest:.3g} Hz bind nothing, as where a program cuts them off",
    "origin": "waves act at second order by their horizontal flow at the origin, on all of the platform, as in some programs",
}
SHARED_NOTE = "{first} hardly matters beside {later}, yet explains more: they share what they explain, and may be one other law"
TREATMENTS_TRIED: tuple[SecondOrderTreatment, ...] = (
    "cut, origin",
    "origin",
    "cut",
    "first",
)  # a program's as it may be, then what it may be in part
MAX_UNFITTED_LOSS = 300.0  # of -2 ln L, by which waves of another order may be worse, not fitted, and yet be fitted
MASS_DEVIATIONS_ALLOWED = 2.0  # standard deviations of what is nearly known: a mass property beyond them was weighed wrongly
MIN_RELATIVE_PROMISE = 0.3  # of what a refitted effect gains: what gains less at first order is not refitted beside it


class Search(CandidateScoring):
    """A diagnosis under way: the study, and what was seen of the candidates."""

    def __init__(self, campaign: Campaign, setup: StudySetup, say: Callable[[str, float], None]) -> None:
        super().__init__(campaign, setup, say)
        self.notes: list[str] = []
        self.earlier = 0.0  # s, that runs of it took which were stopped
        self.alone: ResidualSummary | None = None  # of a calibration to the decays, where there are seas, too
        self.found: dict[str, AcceptedEffect] = {}
        self.declared_in_second_order: FitState | None = None  # where waves of first order were taken in place of theirs

    def fit_baseline(self) -> FitState:
        """The declared model, fitted."""
        self.say("calibrating the declared model", 0.03)
        place = self.start
        self.anchor(place.x)
        if self.study.decays is not None and self.study.seas:
            self.alone = ResidualSummary.of(self.study, self.study.residual(place))
        if self.study.seas:
            self.weigh_by_expected(place)
        self.say("declared model: slopes", 0.08)
        state = self.refit(self.study.linearise(place, self.base), (), "declared model", 0.1)
        best, taken, name = state, self.order, "declared model"
        for order in TREATMENTS_TRIED:
            stage = "declared model in waves of " + ("first order" if order == "first" else f"another kind ({order})")
            other = self.fitted_in_seas(order, best, stage, 0.12) if order in self.study.other_seas else None
            simpler = set(order.split(", ")) < set(taken.split(", "))  # of what is taken a part, which may be enough
            if other is not None and self.likelihood_gain(best, other) >= (
                -MIN_LIKELIHOOD_GAIN if simpler else MIN_LIKELIHOOD_GAIN
            ):
                best, taken, name = other, order, stage
        self.take_seas(taken)
        if best is state:
            return state
        better = f"(by {self.likelihood_gain(state, best):.0f} in -2 ln L)"
        if taken == "first":
            self.declared_in_second_order = state
            self.notes.append(f"{FIRST_ORDER_NOTE} {better}")
        else:
            highest = self.study.options[taken].highest_difference
            said = "; ".join(SIMPLER_SEA_NOTES[part] for part in taken.split(", ")).format(highest=highest)
            self.notes.append(f"{said}: motions are followed better so {better}, and the records have no sums of frequencies")
            self.weigh_by_expected(best.look.place)  # what other seas left is none of it
        return self.refit(self.study.linearise(best.look.place, self.base), (), name, 0.14)

    def second_order_again(self, state: FitState, number: int) -> tuple[FitState, FitState] | None:
        """The declared model and a state in waves with the second order of their records, where those of first order were taken
        and follow the motions no better any more: what the model lacked then may have made the second order look wrong."""
        if (declared := self.declared_in_second_order) is None:
            return None
        name, done = f"round {number}: waves of second order again", 0.15 + 0.8 * (number - 1) / MAX_EFFECTS
        second = self.fitted_in_seas("second", state, name, done)
        if second is None or self.likelihood_gain(second, state) > MIN_LIKELIHOOD_GAIN:
            self.take_seas("first")
            return None
        self.notes = [note for note in self.notes if not note.startswith(FIRST_ORDER_NOTE)]
        self.declared_in_second_order = None
        look = self.study.linearise(second.look.place, self.active(state.chosen))
        return declared, self.refit(look, state.chosen, name, done)

    def fitted_in_seas(self, order: SecondOrderTreatment, state: FitState, name: str, fraction: float) -> FitState | None:
        """A state fitted a little in the seas of an order, which are the search's from then on; None where they make it so much
        worse, not fitted, that it is left at that."""
        self.take_seas(order)
        there = minus_two_log_likelihood(self.study, self.study.residual(state.look.place))
        if float((there - state.likelihood)[self.study.used].sum()) > MAX_UNFITTED_LOSS:
            return None
        look = self.study.linearise(state.look.place, self.active(state.chosen))
        return self.state(state.chosen, self.fit(look, state.chosen, REFIT_ITERATIONS, 0, name, fraction))

    def likelihood_gain(self, before: FitState, after: FitState) -> float:
        """By how much the fitted tests are followed better by another state (-2 ln L)."""
        return float((before.likelihood - after.likelihood)[self.study.used].sum())

    def add_effect(self, state: FitState, number: int) -> tuple[FitState, FitState | None]:
        """The state, fitted better where that was found on the way, and the best effect let in; None where none survives."""
        done = 0.15 + 0.8 * (number - 1) / MAX_EFFECTS
        enough = 2 * math.log(self.count)
        ranked = [
            item._replace(starting_values=self.starting_values(item.candidate, state))
            for item in self.score(state, number, done)
        ]
        some = [item for item in ranked if item.promise > enough]
        for item in ranked:
            weak = item.promise <= enough
            self.reject(item.candidate, f"{'explains too little' if weak else 'others explain more'} at first order")
        known = [item for item in ranked if item.starting_values]  # worth a trial whatever they are at first order
        some = [item for item in some if not item.starting_values]
        state, after = self.best_of_shortlist(state, [*known, *some[:SHORTLIST]], number, done)
        if after is None and (others := self.best_by_motion(some[SHORTLIST:], enough)):
            state, after = self.best_of_shortlist(state, others, number, done + 0.1)
        return state, after

    def best_by_motion(self, rest: Sequence[ScoredCandidate], enough: float) -> list[ScoredCandidate]:
        """What explains the most of one motion, among those that do not explain the most of all."""
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
        """The same of a shortlist."""
        tried: list[RefittedCandidate] = []
        for item in short:
            highest = max((one.worth for one in tried if not one.verdict.refused), default=0.0)
            if item.promise < MIN_RELATIVE_PROMISE * highest and not item.starting_values:
                self.reject(item.candidate, "explains far less than others")
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
                self.reject(one.candidate, f"{new.name} explains more")
            self.rejected.pop(new.name, None)
            return state, after
        return state, None

    def refitted_without(self, without: FitState, after: FitState, one: Candidate, fraction: float) -> FitState:
        """A model without an effect; where that is better by far, fitted from where it is with it: any effect may help a fit
        over what held it up, and is not to be believed for that."""
        place, name = self.with_starting_values(after.look.place, one.labels), f"without {one.name}"
        other = self.refit(self.study.linearise(place, without.look.active), without.chosen, name, fraction)
        return other if self.likelihood_gain(without, other) > MIN_LIKELIHOOD_GAIN else without

    def without_needless_effects(self, state: FitState) -> FitState:
        """The model without what later effects have made needless: every effect but the last is tried to be taken out. What
        gains more than any of these is not needless where it only hardly matters beside them: they share it."""
        spared: list[Candidate] = []
        for one in state.chosen[:-1]:
            rest = tuple(other for other in state.chosen if other is not one)
            look = self.study.linearise(self.with_starting_values(state.look.place, one.labels), self.active(rest))
            without = self.refit(look, rest, f"without {one.name}", 0.97)
            verdict, later = self.assess(without, state, one, last=True), state.chosen[state.chosen.index(one) + 1 :]
            if verdict.refused == NEGLIGIBLE and verdict.worth > max(self.found[other.name].verdict.worth for other in later):
                verdict = verdict._replace(refused="")
                spared.append(one)
            if verdict.refused:
                self.reject(one, f"with what was found after it, {verdict.refused}", verdict)
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
        """The model with mass properties among the effects, where records put one further from what is declared than
        laboratories are wrong by: they move with every fit, nearly known, so that no error tells that they are not known."""
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
        self.found[one.name] = AcceptedEffect(math.nan, state, after, verdict._replace(bic=math.nan, refused=""), ())
        self.rejected.pop(one.name, None)
        names = " and ".join(label.split(".")[1].replace("_", " ") for label in off)
        self.notes.append(
            f"{names} {'are' if len(off) > 1 else 'is'} further from what is declared than what was weighed usually is; the "
            "records are followed no better for it, as mass properties are free to move a little in every fit"
        )
        return after
