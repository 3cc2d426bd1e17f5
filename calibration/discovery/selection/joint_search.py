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
ROUND_SHARE = 0.3  # of the progress left to all rounds, that one round is reckoned with
FREE_ROUNDS = 3  # rounds after which what most sets have stays
WHOLE_ROUNDS = 2  # rounds along all candidates; later ones are along those that help, or are in probable sets
BEGIN, END = 0.2, 0.55  # progress of the rounds


class JointSearch(Search):
    """Joint selection of effects on a linearised model.

    Attributes:
        columns: The last linear model of all candidates.
        selector: The subsets that were compared on it.
        probability: Posterior probability of every effect in the last selection.
    """

    def __init__(self, campaign: Campaign, setup: StudySetup, say: ReportStage) -> None:
        super().__init__(campaign, setup, say)
        self.candidates = {candidate.name: candidate for candidate in setup.candidates}
        self.columns: CandidateColumns
        self.selector: JointSelection
        self.probability: dict[str, float] = {}

    def share(self, number: float) -> float:
        """Progress after so many rounds."""
        return BEGIN + (END - BEGIN) * (1 - (1 - ROUND_SHARE) ** number)

    def select(self, state: FitState, number: int, required: frozenset[str]) -> Subset:
        """Linearise a state along all candidates, and select.

        Mistakes of the laboratory come first. If the baseline lacks some of them, they alone are selected, jointly.
        In real seas, any law of physics would otherwise be pulled to where it stands for them.

        Args:
            state: The fitted model.
            number: Number of the round.
            required: Names of effects that the subset has to have.

        Returns:
            The most probable subset.
        """
        among = self.shortlist if number > WHOLE_ROUNDS and self.shortlist else None
        count = len(self.setup.candidates if among is None else {variant.name for variant in among})
        self.say(f"round {number}: linearising along {count} effects", self.share(number - 1))
        self.columns = columns = linearise_candidates(self, state, among)

        def report(count: int) -> None:
            self.say(f"round {number}: comparing sets of effects", self.share(number - 0.6), count)

        report(0)
        self.selector = self.selection(columns, report, required=required)
        present = columns.present(state.chosen)
        selection = self.selector.run(present)
        self.probability = selection.probability()
        self.score(self.selector.subset(present), number)
        if among is None:
            probable = {i for subset in selection.subsets for i in subset.variants}
            self.shortlist += columns.listed(probable | self.selector.helpful(selection.best))
        best, laboratory = selection.best, columns.laboratory
        mine = laboratory.intersection(best.variants)
        if state.chosen or not mine or mine == set(best.variants):
            return best
        alone = self.selection(columns, report, sorted(laboratory)).run().best
        return alone if alone.variants else best

    def selection(
        self,
        columns: CandidateColumns,
        report: Callable[[int], None],
        among: Sequence[int] | None = None,
        required: frozenset[str] = frozenset(),
    ) -> JointSelection:
        """Selection on a linear model, of effects that matter.

        Args:
            columns: The linear model.
            report: Called with the number of subsets that were fitted.
            among: Variants that may be selected; None: all.
            required: Names of effects that the subset has to have.
        """
        study = self.study

        def matters(before: np.ndarray, after: np.ndarray) -> bool:
            without, with_it = (ResidualSummary.of(study, residual) for residual in (before, after))
            share, reducible = HeldOutComparison(study, study.used, without, with_it, False).error_reduction()
            return not reducible or share >= MIN_HELD_OUT_SHARE

        return JointSelection(columns.model, columns.base, columns.variants, columns.series, report, matters, among, required)

    def score(self, subset: Subset, number: int) -> None:
        """Record the first-order gain of every candidate beside a subset, in a round."""
        best: dict[str, float] = {}
        for i, gain in self.selector.first_order_gains(subset).items():
            name = self.columns.variants[i].name
            best[name] = max(best.get(name, 0.0), gain)
        self.scores = [score for score in self.scores if score.round != number]
        for name, gain in sorted(best.items(), key=lambda item: -item[1]):
            candidate = self.candidates[name]
            size = len(candidate.amplitudes)
            self.scores.append(Score(number, candidate.effect, candidate.dof, gain, size, float("nan"), None, None))

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
        point = state.linearisation.point
        chosen = tuple(self.candidates[columns.variants[i].name] for i in subset.variants)
        present = {candidate.name for candidate in state.chosen}
        gone = [label for candidate in state.chosen if candidate not in chosen for label in candidate.labels]
        point, anew = self.with_starting_values(point, gone) if gone else point, False
        for i, candidate in zip(subset.variants, chosen, strict=True):
            if candidate.name not in present:
                point = self.with_values(point, columns.values[i])
                anew |= any(label in candidate.amplitudes for label in columns.values[i])
        mine = [i for i in subset.fit.columns if i in columns.base or columns.directions[i] not in self.base]
        directions = tuple(columns.directions[i] for i in mine)
        if anew:  # far from where slopes were taken
            linearisation = self.study.linearise(point, directions)
        else:
            residual = self.study.residual(point) if gone else columns.linearisation.residual
            slopes = columns.model.slopes[:, mine]
            linearisation = Linearisation(point, directions, residual, slopes, columns.linearisation.own)
            moved = np.array(columns.directions)[list(subset.fit.columns)]  # nearly known properties have two columns
            step = np.array([subset.fit.step[moved == i].sum() for i in directions])
            own_step = step_of_decays(self.study, columns.linearisation, subset.fit.own)
            linearisation = far_step(self.study, linearisation, self.study.used, self.prior(chosen), step, own_step)
        names = listed([effect_in_words(candidate.name) for candidate in chosen]) or "no effect"
        reached = self.fit(linearisation, chosen, STEP_ITERATIONS, 0, f"{stage}: fit with {names}", share, tolerance)
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
        for subset in sorted(self.selector.fitted.values(), key=lambda fitted: fitted.evidence):
            variants |= {name: i for i in subset.variants if (name := self.columns.variants[i].name) in names}
        return self.selector.subset(sorted(variants.values()))

    def refit_all(self, state: FitState) -> FitState:
        """Fit a state to convergence with slopes of its own, the shapes of its effects free."""
        linearisation = self.study.linearise(state.linearisation.point, self.active(state.chosen))
        return self.refit(linearisation, state.chosen, "final fit of all parameters", END)

    def search(self, states: list[FitState], reach: Callable[[FitState], None]) -> FitState:
        """Select and move until the selection stays.

        Where sets alternate, none of them is the answer. After `FREE_ROUNDS` every set has the effects that more than half of
        the sets before it have.

        Args:
            states: The fitted baseline, and what earlier rounds reached.
            reach: Called with the state after every round.

        Returns:
            The last state, its linear model in `columns`.
        """
        if len(states) == 1 and (better := self.with_split_modes(states[0])) is not None:
            states.append(better)
        state, visited = states[-1], {frozenset(candidate.name for candidate in earlier.chosen) for earlier in states}
        for number in range(len(states), MAX_ROUNDS + 1):
            sets = whole_sets([earlier.chosen for earlier in states[1:]])
            best = self.select(state, number, majority(sets) if number > FREE_ROUNDS else frozenset())
            names = frozenset(self.columns.variants[i].name for i in best.variants)
            if not names or names == {candidate.name for candidate in state.chosen}:
                break
            if names in visited or number == MAX_ROUNDS:
                subset = self.with_shapes(majority([*sets, names]))
                state = self.fit_subset(state, self.columns, subset, f"round {number}", self.share(number))
                break
            visited.add(names)
            stage, share = f"round {number}", self.share(number - 0.5)
            before, state = state, self.fit_subset(state, self.columns, best, stage, share, REFIT_TOLERANCE)
            if names <= {candidate.name for candidate in before.chosen} and self.as_predicted(state, best):
                break  # effects have gone; slopes elsewhere would tell nothing else
            reach(state)
        if state.chosen:
            state = self.refit_all(state)
        return state

    def with_split_modes(self, baseline: FitState) -> FitState | None:
        """Fit an oscillator that splits a mode of a decay, far from where slopes lead.

        Args:
            baseline: The fitted baseline.

        Returns:
            The likeliest model with such an oscillator, or None if none is likelier than the baseline by
            more than `MIN_LIKELIHOOD_GAIN`.
        """
        point = self.with_starting_values(baseline.linearisation.point, self.setup.base)
        base, width = self.study.index(self.setup.base), self.setup.prior.width
        states = [baseline]
        for candidate in self.setup.candidates:
            finder = candidate.starting_values_finder
            starts = () if finder is None else finder(self.study, point, base, width)
            for values in starts:
                linearisation = self.study.linearise(self.with_values(point, values), self.active((candidate,)))
                states.append(self.refit(linearisation, (candidate,), f"trial of {effect_in_words(candidate.name)}", BEGIN))
        best = self.likeliest(*states)
        return best if self.likelihood_gain(baseline, best) > MIN_LIKELIHOOD_GAIN else None


def whole_sets(chosen: Sequence[Sequence[Candidate]]) -> list[frozenset[str]]:
    """Names of the effects that rounds selected, without a first round of laboratory mistakes alone."""
    sets = [frozenset(candidate.name for candidate in effects) for effects in chosen]
    partial = len(sets) > 1 and all(candidate.effect in LABORATORY_EFFECTS for candidate in chosen[0])
    return sets[1:] if partial else sets


def majority(sets: Sequence[frozenset[str]]) -> frozenset[str]:
    """The names that more than half of some sets have."""
    return frozenset(name for name in frozenset().union(*sets) if 2 * sum(name in names for names in sets) > len(sets))
