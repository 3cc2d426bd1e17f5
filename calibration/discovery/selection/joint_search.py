"""Joint search: select effects on a linearised model, go there, linearise again."""

from collections.abc import Callable, Sequence

import numpy as np

from calibration.discovery.acceptance import (
    MIN_BIC_GAIN,
    MIN_HELD_OUT_SHARE,
    MIN_LIKELIHOOD_GAIN,
    HeldOutComparison,
)
from calibration.discovery.diagnosis import Score
from calibration.discovery.effect_fits import REFIT_TOLERANCE
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.effects.effect_names import effect_in_words
from calibration.discovery.eliminated_least_squares import minus_two_log_likelihood
from calibration.discovery.fit_state import FitState, ResidualSummary
from calibration.discovery.search import Search
from calibration.discovery.selection.candidate_columns import LABORATORY_EFFECTS, CandidateColumns, linearise_candidates
from calibration.discovery.selection.detection_limits import detection_limits
from calibration.discovery.selection.joint_selection import JointSelection
from calibration.discovery.selection.subset_fit import fit_subset
from calibration.discovery.selection.subsets import Subset

MAX_ROUNDS = 6  # linearisations along candidates
ROUND_SHARE = 0.3  # of the progress left to all rounds, that one round is reckoned with
FREE_ROUNDS = 3  # rounds after which what most sets have stays
WHOLE_ROUNDS = 2  # rounds along all candidates; later ones are along those that help, or are in probable sets
BEGIN, END = 0.2, 0.55  # progress of the rounds
FINAL_FIT = "final fit of all parameters"  # stage to report


class JointSearch:
    """Joint selection of effects on a linearised model.

    Attributes:
        fits: Study, candidates and priors, and the fits with them.
        record: What the search has come to so far.
        columns: The last linear model of all candidates.
        selector: The subsets that were compared on it.
        probability: Posterior probability of every effect in the last selection.
    """

    def __init__(self, search: Search) -> None:
        self.fits, self.record = search
        self.candidates = {candidate.name: candidate for candidate in self.fits.setup.candidates}
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
        among = self.record.shortlist if number > WHOLE_ROUNDS and self.record.shortlist else None
        count = len(self.fits.setup.candidates if among is None else {variant.name for variant in among})
        self.fits.say(f"round {number}: linearising along {count} effects", self.share(number - 1))
        self.columns = columns = linearise_candidates(self.fits, state, among)

        def report(count: int) -> None:
            self.fits.say(f"round {number}: comparing sets of effects", self.share(number - 0.6), count)

        report(0)
        self.selector = self.selection(columns, report, required=required)
        present = columns.present(state.chosen)
        selection = self.selector.run(present)
        self.probability = selection.probability()
        self.score(self.selector.subset(present), number)
        self.record.limits |= detection_limits(self.fits, columns, self.selector, selection.best)
        if among is None:
            probable = {i for subset in selection.subsets for i in subset.variants}
            self.record.shortlist += columns.listed(probable | self.selector.helpful(selection.best))
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
        study = self.fits.study

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
        self.record.scores = [score for score in self.record.scores if score.round != number]
        for name, gain in sorted(best.items(), key=lambda item: -item[1]):
            candidate = self.candidates[name]
            size = len(candidate.amplitudes)
            self.record.scores.append(Score(number, candidate.effect, candidate.dof, gain, size, float("nan"), None, None))

    def as_predicted(self, state: FitState, subset: Subset) -> bool:
        """Whether a state follows the fitted tests as the linear model said that a subset would."""
        predicted = minus_two_log_likelihood(self.fits.study, self.columns.model.residual_after(subset.fit))
        return abs(float((state.likelihood - predicted)[self.fits.study.used].sum())) < MIN_BIC_GAIN

    def with_shapes(self, names: frozenset[str]) -> Subset:
        """Effects with the shapes that they have in the most probable subset.

        Args:
            names: Names of the effects.
        """
        variants: dict[str, int] = {}
        for subset in sorted(self.selector.fitted.values(), key=lambda fitted: fitted.evidence):
            variants |= {name: i for i in subset.variants if (name := self.columns.variants[i].name) in names}
        return self.selector.subset(sorted(variants.values()))

    def run(self, states: list[FitState], reach: Callable[[FitState], None]) -> FitState:
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
                state = fit_subset(self.fits, state, self.columns, subset, f"round {number}", self.share(number))
                break
            visited.add(names)
            stage, share = f"round {number}", self.share(number - 0.5)
            before, state = state, fit_subset(self.fits, state, self.columns, best, stage, share, REFIT_TOLERANCE)
            if names <= {candidate.name for candidate in before.chosen} and self.as_predicted(state, best):
                break  # effects have gone; slopes elsewhere would tell nothing else
            reach(state)
        if state.chosen:
            state = self.fits.refit_from(state, state.chosen, FINAL_FIT, END)
        return state

    def with_split_modes(self, baseline: FitState) -> FitState | None:
        """Fit an oscillator that splits a mode of a decay, far from where slopes lead.

        Args:
            baseline: The fitted baseline.

        Returns:
            The likeliest model with such an oscillator, or None if none is likelier than the baseline by
            more than `MIN_LIKELIHOOD_GAIN`.
        """
        point = self.fits.with_starting_values(baseline.linearisation.point, self.fits.setup.base)
        base, width = self.fits.study.index(self.fits.setup.base), self.fits.setup.prior.width
        states = [baseline]
        for candidate in self.fits.setup.candidates:
            finder = candidate.starting_values_finder
            starts = () if finder is None else finder(self.fits.study, point, base, width)
            for values in starts:
                linearisation = self.fits.study.linearise(self.fits.with_values(point, values), self.fits.active((candidate,)))
                states.append(
                    self.fits.refit(linearisation, (candidate,), f"trial of {effect_in_words(candidate.name)}", BEGIN)
                )
        best = self.fits.likeliest(*states)
        return best if self.fits.likelihood_gain(baseline, best) > MIN_LIKELIHOOD_GAIN else None


def whole_sets(chosen: Sequence[Sequence[Candidate]]) -> list[frozenset[str]]:
    """Names of the effects that rounds selected, without a first round of laboratory mistakes alone."""
    sets = [frozenset(candidate.name for candidate in effects) for effects in chosen]
    partial = len(sets) > 1 and all(candidate.effect in LABORATORY_EFFECTS for candidate in chosen[0])
    return sets[1:] if partial else sets


def majority(sets: Sequence[frozenset[str]]) -> frozenset[str]:
    """The names that more than half of some sets have."""
    return frozenset(name for name in frozenset().union(*sets) if 2 * sum(name in names for names in sets) > len(sets))
