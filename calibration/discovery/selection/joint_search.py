"""Joint search: select effects on a linearised model, go there, linearise again, verify by simulation."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.discovery.acceptance import MIN_LIKELIHOOD_GAIN, worsening
from calibration.discovery.diagnosis import Score
from calibration.discovery.effects.effect_names import effect_in_words
from calibration.discovery.fit_state import FitState
from calibration.discovery.linearisations import Linearisation
from calibration.discovery.refusal import Refusal, RefusalKind
from calibration.discovery.search import AcceptedEffect, Search
from calibration.discovery.selection.candidate_columns import CandidateColumns, candidate_columns, linearise_candidates
from calibration.discovery.selection.cross_validation import held_out_gain
from calibration.discovery.selection.joint_selection import JointSelection, Subset
from calibration.discovery.set_up import StudySetup
from calibration.formatting import listed

INDISTINGUISHABLE_SHARE = 0.1  # of an effect's log evidence: another that has all but this much is not told from it
MIN_PROBABILITY = 0.5  # of an effect and those that the records cannot tell from it
MAX_ROUNDS = 6  # linearisations along all candidates
STEP_ITERATIONS = 15  # iterations of a fit with the slopes at hand
BEGIN, END = 0.2, 0.9  # progress of the rounds


class JointSearch(Search):
    """Joint selection of effects on a linearised model.

    Attributes:
        columns: The last linear model of all candidates.
        selector: The subsets that were compared on it.
        probability: Posterior probability of every effect in the last selection.
    """

    def __init__(self, campaign: Campaign, setup: StudySetup, say: Callable[[str, float], None]) -> None:
        super().__init__(campaign, setup, say)
        self.candidates = {one.name: one for one in setup.candidates}
        self.columns: CandidateColumns
        self.selector: JointSelection
        self.probability: dict[str, float] = {}

    def share(self, number: float) -> float:
        """Progress after so many rounds."""
        return BEGIN + (END - BEGIN) * number / MAX_ROUNDS

    def select(self, state: FitState, number: int) -> Subset:
        """Linearise a state along all candidates, and select.

        Args:
            state: The fitted model.
            number: Number of the round.

        Returns:
            The most probable subset.
        """
        name = f"round {number}: comparing sets of effects"
        self.say(f"round {number}: linearising along {len(self.setup.candidates)} effects", self.share(number - 1))
        self.columns = columns = linearise_candidates(self, state)

        def told(count: int) -> None:
            self.say(f"{name} ({count})", self.share(number - 0.6))

        told(0)
        self.selector = JointSelection(columns.model, columns.base, columns.variants, columns.series, told)
        present = columns.present(state.chosen)
        found = self.selector.run(present)
        self.probability = found.probability()
        self.score(self.selector.subset(present), number)
        return found.best

    def score(self, subset: Subset, number: int) -> None:
        """Record the first-order gain of every candidate beside a subset, in a round."""
        best: dict[str, float] = {}
        for i, gain in self.selector.first_order_gains(subset).items():
            name = self.columns.variants[i].name
            best[name] = max(best.get(name, 0.0), gain)
        self.scores = [one for one in self.scores if one.round != number]
        for name, gain in sorted(best.items(), key=lambda item: -item[1]):
            one = self.candidates[name]
            self.scores.append(Score(number, one.effect, one.dof, gain, len(one.amplitudes), float("nan"), None, None))

    def fit_subset(self, state: FitState, columns: CandidateColumns, subset: Subset, stage: str, share: float) -> FitState:
        """Fit the effects of a subset, from a state on, with the slopes of a linear model.

        Args:
            state: The state that was linearised.
            columns: The linear model.
            subset: The subset.
            stage: Stage to report.
            share: Progress to report (0 to 1).
        """
        place = state.look.place
        chosen = tuple(self.candidates[columns.variants[i].name] for i in subset.variants)
        present = {one.name for one in state.chosen}
        gone = [label for one in state.chosen if one not in chosen for label in one.labels]
        place, anew = self.with_starting_values(place, gone) if gone else place, False
        for i, one in zip(subset.variants, chosen, strict=True):
            if one.name not in present:
                place = self.with_values(place, columns.values[i])
                anew |= any(label in one.amplitudes for label in columns.values[i])
        mine = [i for i in subset.fit.columns if i in columns.base or columns.directions[i] not in self.base]
        directions = tuple(columns.directions[i] for i in mine)
        if anew:  # far from where slopes were taken
            look = self.study.linearise(place, directions)
        else:
            residual = self.study.residual(place) if gone else columns.look.residual
            slopes = columns.model.slopes[:, mine]
            look = Linearisation(place, directions, residual, slopes, columns.look.own)
        names = listed([effect_in_words(one.name) for one in chosen]) or "no effect"
        reached = self.fit(look, chosen, STEP_ITERATIONS, 0, f"{stage}: fit with {names}", share)
        return self.state(chosen, reached)

    def refit_all(self, state: FitState) -> FitState:
        """Fit a state to convergence with slopes of its own, the shapes of its effects free."""
        look = self.study.linearise(state.look.place, self.active(state.chosen))
        return self.refit(look, state.chosen, "final fit of all parameters", END)

    def search(self, states: list[FitState], reach: Callable[[FitState], None]) -> FitState:
        """Select and move until the selection stays.

        Args:
            states: The fitted declared model, and what earlier rounds reached.
            reach: Called with the state after every round.

        Returns:
            The last state, its linear model in `columns`.
        """
        if len(states) == 1 and (better := self.with_split_modes(states[0])) is not None:
            states.append(better)
        state, visited = states[-1], {frozenset(one.name for one in some.chosen) for some in states}
        for number in range(len(states), MAX_ROUNDS + 1):
            best = self.select(state, number)
            names = frozenset(self.columns.variants[i].name for i in best.variants)
            if names in visited or number == MAX_ROUNDS:
                break
            visited.add(names)
            state = self.fit_subset(state, self.columns, best, f"round {number}", self.share(number - 0.5))
            reach(state)
        if state.chosen:
            state = self.refit_all(state)
        return state

    def with_split_modes(self, baseline: FitState) -> FitState | None:
        """The model with an oscillator that splits a mode of a decay, far from where slopes lead; None without one.

        Args:
            baseline: The fitted declared model.
        """
        place = self.with_starting_values(baseline.look.place, self.setup.base)
        base, width = self.study.index(self.setup.base), self.setup.prior.width
        found = [baseline]
        for one in self.setup.candidates:
            starts = () if one.starting_values_finder is None else one.starting_values_finder(self.study, place, base, width)
            for values in starts:
                look = self.study.linearise(self.with_values(place, values), self.active((one,)))
                found.append(self.refit(look, (one,), f"trial of {effect_in_words(one.name)}", BEGIN))
        best = self.likeliest(*found)
        return best if self.likelihood_gain(baseline, best) > MIN_LIKELIHOOD_GAIN else None

    def verify(self, baseline: FitState, state: FitState) -> FitState:
        """Take every effect out in turn, simulate, and keep those that the records ask for.

        The model that is kept follows no motion worse than the declared one, if an effect is the reason.

        Args:
            baseline: The fitted declared model.
            state: The last state of the search.
        """
        while state.chosen:
            columns = candidate_columns(self, state.look, state.chosen, ())
            for i, one in zip(self.columns.present(state.chosen), state.chosen, strict=True):
                self.say(f"verification: the model without {effect_in_words(one.name)}", END)
                self.found[one.name] = self.evidence(baseline, state, columns, i)
            self.refuse_worsening(baseline, state)
            refused = [one for one in state.chosen if self.found[one.name].verdict.refused]
            if not refused:
                break
            least = min(refused, key=lambda one: self.found[one.name].verdict.worth)
            gone = self.found.pop(least.name)
            self.reject(least, gone.verdict.refused, gone.verdict)
            state = self.refit_all(gone.before) if len(state.chosen) > 1 else baseline
            self.select(state, MAX_ROUNDS)
        self.reject_others(state)
        return replace(state, chosen=tuple(sorted(state.chosen, key=lambda one: -self.found[one.name].verdict.worth)))

    def refuse_worsening(self, baseline: FitState, state: FitState) -> None:
        """Refuse the effect that makes a motion of a test be followed worse than in the declared model, if there is one.

        Args:
            baseline: The fitted declared model.
            state: The fitted model, every effect's evidence in `found`.
        """
        worse = worsening(self.study, baseline.left, state.left)
        worst = int(np.argmax(worse))
        if worse[worst] <= 1 or any(one.verdict.refused for one in self.found.values()):
            return
        name = min(self.found, key=lambda name: self.found[name].before.left.error[worst])
        found, series = self.found[name], self.study.series[worst]
        if worsening(self.study, found.before.left, state.left)[worst] <= 1:
            return  # no single effect is the reason
        error = [float(some.left.error[worst]) / series.spread for some in (baseline, state)]
        refused = Refusal(RefusalKind.WORSE_TEST, tuple(error), f"{series.channel} of {series.test}")
        self.found[name] = found._replace(verdict=found.verdict._replace(refused=refused))

    def evidence(self, baseline: FitState, state: FitState, columns: CandidateColumns, out: int) -> AcceptedEffect:
        """Evidence of one effect in a model: by simulation without it, and tests left out in turn in the linear model.

        Args:
            baseline: The fitted declared model.
            state: The fitted model.
            columns: Linear model of its effects alone, at the fitted point.
            out: Variant of the effect in the last selection.
        """
        one = self.candidates[self.columns.variants[out].name]
        last = JointSelection(columns.model, columns.base, columns.variants, columns.series)
        whole = last.subset(range(len(state.chosen)))
        rest = last.subset([i for i in whole.variants if columns.variants[i].name != one.name], whole)
        held = held_out_gain(columns.model, whole.fit, rest.fit, self.test_of_pool)
        without = self.fit_subset(state, columns, rest, "verification", END) if rest.variants else baseline
        verdict = self.assess(without, state, one, last=True)
        gains = [score.gain for score in self.scores if (score.effect, score.degree_of_freedom) == (one.effect, one.dof)]
        alike = self.look_alikes(self.selector.subset(self.columns.present(state.chosen)), out)
        probability = self.probability.get(one.name, 0.0)
        if verdict.refused is None and probability + sum(self.probability.get(name, 0.0) for name in alike) < MIN_PROBABILITY:
            verdict = verdict._replace(refused=Refusal(RefusalKind.IMPROBABLE, (probability,)))
        return AcceptedEffect(max(gains, default=0.0), without, state, verdict, alike, probability, held)

    @property
    def test_of_pool(self) -> np.ndarray:
        """Number of the test of every pool (p,)."""
        tests = list(dict.fromkeys(one.test for one in self.study.series))
        return np.repeat([tests.index(one.test) for one in self.study.series], self.study.dof.shape[1])

    def look_alikes(self, whole: Subset, out: int) -> tuple[str, ...]:
        """Effects that would do nearly as well in the place of one of a subset.

        Args:
            whole: The subset.
            out: Variant of the effect that is exchanged.
        """
        rest = self.selector.subset([i for i in whole.variants if i != out], whole)
        mine = self.columns.variants[out].name
        best: dict[str, float] = {}
        for i in self.selector.additions(rest):
            name = self.columns.variants[i].name
            other = self.selector.fitted.get(tuple(sorted((*rest.variants, i))))
            if name != mine and other is not None and other.plausible:
                best[name] = max(best.get(name, -np.inf), other.evidence)
        asked = whole.evidence - INDISTINGUISHABLE_SHARE * (whole.evidence - rest.evidence)
        return tuple(name for name, evidence in best.items() if evidence > asked)

    def reject_others(self, state: FitState) -> None:
        """Record why the other candidates are not in the model: their probability is low."""
        present = {one.name for one in state.chosen}
        for one in self.setup.candidates:
            if one.name not in present and one.name not in self.rejected:
                self.reject(one, Refusal(RefusalKind.IMPROBABLE, (self.probability.get(one.name, 0.0),)))
        for name in present:
            self.rejected.pop(name, None)
