"""Joint search: select effects on a linearised model, go there, linearise again."""

from collections.abc import Callable, Sequence

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.discovery.acceptance import (
    MIN_BIC_GAIN,
    MIN_HELD_OUT_SHARE,
    MIN_LIKELIHOOD_GAIN,
    HeldOutComparison,
)
from calibration.discovery.broyden_fit import MIN_RELATIVE_GAIN, far_step
from calibration.discovery.diagnosis import Score
from calibration.discovery.effect_fits import REFIT_TOLERANCE, ReportStage
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.effects.effect_names import effect_in_words
from calibration.discovery.eliminated_least_squares import minus_two_log_likelihood
from calibration.discovery.fit_state import FitState, ResidualSummary
from calibration.discovery.linearisations import Linearisation
from calibration.discovery.search import Search
from calibration.discovery.selection.candidate_columns import LABORATORY_EFFECTS, CandidateColumns, linearise_candidates
from calibration.discovery.selection.joint_selection import JointSelection
from calibration.discovery.selection.study_linear_model import step_of_decays
from calibration.discovery.selection.subsets import Subset
from calibration.discovery.set_up import StudySetup
from calibration.formatting import listed

MAX_ROUNDS = 6  # linearisations along candidates
STEP_ITERATIONS = 15  # iterations of a fit with the slopes at hand
USUAL_ROUNDS = 3  # for progress
FREE_ROUNDS = 3  # rounds after which what most sets have stays
WHOLE_ROUNDS = 2  # rounds along all candidates; later ones are along those that help, or are in probable sets
BEGIN, END = 0.25, 0.65  # progress of the rounds


class JointSearch(Search):
    """Joint selection of effects on a linearised model.

    Attributes:
        columns: The last linear model of all candidates.
        selector: The subsets that were compared on it.
        probability: Posterior probability of every effect in the last selection.
    """

    def __init__(self, campaign: Campaign, setup: StudySetup, say: ReportStage) -> None:
        super().__init__(campaign, setup, say)
        self.candidates = {one.name: one for one in setup.candidates}
        self.columns: CandidateColumns
        self.selector: JointSelection
        self.probability: dict[str, float] = {}

    def share(self, number: float) -> float:
        """Progress after so many rounds."""
        return BEGIN + (END - BEGIN) * min(number / USUAL_ROUNDS, 1.0)

    def select(self, state: FitState, number: int, required: frozenset[str]) -> Subset:
        """Linearise a state along all candidates, and select.

        The laboratory comes first: where mistakes of it are among the effects that the baseline lacks, those alone are
        selected, jointly. Real seas pull any law of physics to wherever it stands for them.

        Args:
            state: The fitted model.
            number: Number of the round.
            required: Names of effects that the subset has to have.

        Returns:
            The most probable subset.
        """
        among = self.shortlist if number > WHOLE_ROUNDS and self.shortlist else None
        count = len(self.setup.candidates if among is None else {one.name for one in among})
        self.say(f"round {number}: linearising along {count} effects", self.share(number - 1))
        self.columns = columns = linearise_candidates(self, state, among)

        def told(count: int) -> None:
            self.say(f"round {number}: comparing sets of effects", self.share(number - 0.6), count)

        told(0)
        self.selector = self.selection(columns, told, required=required)
        present = columns.present(state.chosen)
        found = self.selector.run(present)
        self.probability = found.probability()
        self.score(self.selector.subset(present), number)
        if among is None:
            probable = {i for one in found.subsets for i in one.variants}
            self.shortlist += columns.listed(probable | self.selector.helpful(found.best))
        best, laboratory = found.best, columns.laboratory
        mine = laboratory.intersection(best.variants)
        if state.chosen or not mine or mine == set(best.variants):
            return best
        alone = self.selection(columns, told, sorted(laboratory)).run().best
        return alone if alone.variants else best

    def selection(
        self,
        columns: CandidateColumns,
        told: Callable[[int], None],
        among: Sequence[int] | None = None,
        required: frozenset[str] = frozenset(),
    ) -> JointSelection:
        """Selection on a linear model, of effects that matter.

        Args:
            columns: The linear model.
            told: Called with the number of subsets that were fitted.
            among: Variants that may be selected; None: all.
            required: Names of effects that the subset has to have.
        """
        study = self.study

        def matters(before: np.ndarray, after: np.ndarray) -> bool:
            without, with_it = (ResidualSummary.of(study, residual) for residual in (before, after))
            share, some = HeldOutComparison(study, study.used, without, with_it, False).error_reduction()
            return not some or share >= MIN_HELD_OUT_SHARE

        return JointSelection(columns.model, columns.base, columns.variants, columns.series, told, matters, among, required)

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

    def fit_subset(
        self,
        state: FitState,
        columns: CandidateColumns,
        subset: Subset,
        stage: str,
        share: float,
        tolerance: float = MIN_RELATIVE_GAIN,
    ) -> FitState:
        """Fit the effects of a subset, from a state on, with the slopes of a linear model.

        Args:
            state: The state that was linearised.
            columns: The linear model.
            subset: The subset.
            stage: Stage to report.
            share: Progress to report (0 to 1).
            tolerance: Relative gain in cost of a step that ends the fit.
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
            moved = np.array(columns.directions)[list(subset.fit.columns)]  # nearly known properties have two columns
            step = np.array([subset.fit.step[moved == i].sum() for i in directions])
            own = step_of_decays(self.study, columns.look, subset.fit.own)
            look = far_step(self.study, look, self.study.used, self.prior(chosen), step, own)
        names = listed([effect_in_words(one.name) for one in chosen]) or "no effect"
        reached = self.fit(look, chosen, STEP_ITERATIONS, 0, f"{stage}: fit with {names}", share, tolerance)
        return self.state(chosen, reached)

    def as_predicted(self, state: FitState, subset: Subset) -> bool:
        """Whether a state follows the fitted tests as the linear model said that a subset would."""
        predicted = minus_two_log_likelihood(self.study, self.columns.model.residual_after(subset.fit))
        return abs(float((state.likelihood - predicted)[self.study.used].sum())) < MIN_BIC_GAIN

    def with_shapes(self, names: frozenset[str]) -> Subset:
        """Effects with the shapes that they have in the most probable subset.

        Args:
            names: Names of the effects.
        """
        variants: dict[str, int] = {}
        for subset in sorted(self.selector.fitted.values(), key=lambda one: one.evidence):
            variants |= {name: i for i in subset.variants if (name := self.columns.variants[i].name) in names}
        return self.selector.subset(sorted(variants.values()))

    def refit_all(self, state: FitState) -> FitState:
        """Fit a state to convergence with slopes of its own, the shapes of its effects free."""
        look = self.study.linearise(state.look.place, self.active(state.chosen))
        return self.refit(look, state.chosen, "final fit of all parameters", END)

    def search(self, states: list[FitState], reach: Callable[[FitState], None]) -> FitState:
        """Select and move until the selection stays.

        Where sets alternate, none is the answer: after `FREE_ROUNDS` every set has the effects that more than half of the sets
        before it have.

        Args:
            states: The fitted baseline, and what earlier rounds reached.
            reach: Called with the state after every round.

        Returns:
            The last state, its linear model in `columns`.
        """
        if len(states) == 1 and (better := self.with_split_modes(states[0])) is not None:
            states.append(better)
        state, visited = states[-1], {frozenset(one.name for one in some.chosen) for some in states}
        for number in range(len(states), MAX_ROUNDS + 1):
            sets = whole_sets([some.chosen for some in states[1:]])
            best = self.select(state, number, majority(sets) if number > FREE_ROUNDS else frozenset())
            names = frozenset(self.columns.variants[i].name for i in best.variants)
            if not names or names == {one.name for one in state.chosen}:
                break
            if names in visited or number == MAX_ROUNDS:
                kept = self.with_shapes(majority([*sets, names]))
                state = self.fit_subset(state, self.columns, kept, f"round {number}", self.share(number))
                break
            visited.add(names)
            stage, share = f"round {number}", self.share(number - 0.5)
            before, state = state, self.fit_subset(state, self.columns, best, stage, share, REFIT_TOLERANCE)
            if names <= {one.name for one in before.chosen} and self.as_predicted(state, best):
                break  # effects have gone; slopes elsewhere would tell nothing else
            reach(state)
        if state.chosen:
            state = self.refit_all(state)
        return state

    def with_split_modes(self, baseline: FitState) -> FitState | None:
        """The model with an oscillator that splits a mode of a decay, far from where slopes lead; None without one.

        Args:
            baseline: The fitted baseline.
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


def whole_sets(chosen: Sequence[Sequence[Candidate]]) -> list[frozenset[str]]:
    """Names of the effects that rounds selected, without a first round that took the laboratory's mistakes alone."""
    sets = [frozenset(one.name for one in some) for some in chosen]
    partial = len(sets) > 1 and all(one.effect in LABORATORY_EFFECTS for one in chosen[0])
    return sets[1:] if partial else sets


def majority(sets: Sequence[frozenset[str]]) -> frozenset[str]:
    """The names that more than half of some sets have."""
    return frozenset(name for name in frozenset().union(*sets) if 2 * sum(name in one for one in sets) > len(sets))
