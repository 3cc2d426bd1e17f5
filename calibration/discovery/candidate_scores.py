"""Scores of candidate effects: first-order gain at the neutral value, and gain of a refit."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import count

from calibration.campaign.load_campaign import Campaign
from calibration.discovery.acceptance import FitState, Verdict
from calibration.discovery.candidate_trials import RefittedCandidate, ScoredCandidate
from calibration.discovery.diagnosis import Rejected, Score
from calibration.discovery.effect_fits import EffectFits
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.effects.phase_shift_start import phase_shift_start
from calibration.discovery.eliminated_least_squares import FirstOrderGain, predict_gain
from calibration.discovery.linearisations import Linearisation
from calibration.discovery.refusal import Refusal
from calibration.discovery.set_up import StudySetup

REFIT_ITERATIONS = 8  # iterations of a candidate's refit


class CandidateScoring(EffectFits):
    """Fits of a campaign, scores of all candidates, and reasons of rejections."""

    def __init__(self, campaign: Campaign, setup: StudySetup, say: Callable[[str, float], None]) -> None:
        super().__init__(campaign, setup, say)
        self.scores: list[Score] = []
        self.rejected: dict[str, Rejected] = {}

    def score(self, state: FitState, number: int, fraction: float) -> list[ScoredCandidate]:
        """Rank all candidates that are not in the model by their first-order gain.

        Every candidate is linearised at its neutral value; what the fitted directions can explain is projected out.

        Args:
            state: The fit so far.
            number: Number of the round.
            fraction: Progress to report (0 to 1).

        Returns:
            Scored candidates, the most promising first.
        """
        self.say(f"round {number}: scoring", fraction)
        self.scores = [one for one in self.scores if one.round != number]  # of a fit that was bettered on the way
        there = {label for one in state.chosen for label in one.labels}
        others = [one for one in self.setup.candidates if not set(one.labels) <= there]
        best: dict[str, ScoredCandidate] = {}
        grids = {one.name: one.grid or ({},) for one in others}
        for g in count():
            if not (todo := [one for one in others if g < len(grids[one.name])]):
                break
            place = self.with_values(state.look.place, {k: v for one in todo for k, v in grids[one.name][g].items()})
            columns = dict.fromkeys(i for one in todo for i in self.study.index(one.amplitudes) if i not in state.look.active)
            seen = self.study.linearise(place, list(columns))
            for one in todo:
                self.say(f"round {number}: scoring {one.name}", fraction)
                mine = [i for i in self.study.index(one.amplitudes) if i not in state.look.active]
                look = replace(
                    state.look.joined_with(seen.restricted_to(mine)),
                    place=self.with_values(state.look.place, grids[one.name][g]),
                )
                found = predict_gain(self.study, look, self.prior([*state.chosen, one]))
                if one.shape_finder is not None and g < len(one.grid):
                    found_at = one.shape_finder(self.study, state.look, seen.restricted_to(mine[:1]).slopes[:, 0])
                    grids[one.name] += tuple({**one.grid[g], **shape} for shape in found_at)
                if self.wrong_sign(one, look, found):
                    found = found._replace(gain=0 * found.gain)
                if one.name not in best or found.fitted > best[one.name].predicted.fitted:
                    far = (
                        None
                        if one.phase_per_unit is None
                        else phase_shift_start(self.study, look, one.amplitudes[0], one.phase_per_unit)
                    )
                    best[one.name] = ScoredCandidate(one, found, look, far)
        ranked = sorted(best.values(), key=lambda item: -item.promise)
        for item in ranked:
            one, found = item.candidate, item.predicted
            self.scores.append(Score(number, one.effect, one.dof, found.fitted, len(one.amplitudes), found.held, None, None))
        return ranked

    def starting_values(self, one: Candidate, state: FitState) -> tuple[Mapping[str, float], ...]:
        """Further values at which a candidate's refit begins: from another program, or from the decays."""
        place = self.with_starting_values(state.look.place, self.setup.base)
        base, width = self.study.index(self.setup.base), self.setup.prior.width
        said = () if one.starting_values_finder is None else one.starting_values_finder(self.study, place, base, width)
        return (*([one.starting_values] if one.starting_values else ()), *said)

    def wrong_sign(self, one: Candidate, look: Linearisation, found: FirstOrderGain) -> bool:
        """Whether an amplitude that physics requires to be positive is clearly negative."""
        for label in one.positive:
            i = look.active.index(self.study.names.index(label))
            if found.step[i] < 0 and (len(one.amplitudes) == 1 or found.step[i] < -2 * found.deviation[i]):
                return True
        return False

    def reject(self, one: Candidate, why: Refusal | None, taken_out: Verdict | None = None) -> None:
        """Record why a candidate is not in the model.

        Args:
            one: The candidate.
            why: The reason; None records nothing.
            taken_out: The verdict that removed it, where it was in the model.
        """
        if why is not None:
            self.rejected[one.name] = Rejected(one.effect, one.dof, why, taken_out)

    def refit_candidate(self, state: FitState, scored: ScoredCandidate, number: int, fraction: float) -> RefittedCandidate:
        """Refit the model with one candidate, everything else free; its shape is freed in a second step."""
        one = scored.candidate
        chosen = (*state.chosen, one)
        name = f"round {number}: {one.name}"
        reached = self.fit(scored.look, chosen, REFIT_ITERATIONS, 0, name, fraction)
        if one.shapes:
            look = self.study.linearise(reached.look.place, self.active(chosen))
            reached = self.fit(look, chosen, REFIT_ITERATIONS, 0, name, fraction)
        after = self.state(chosen, reached)
        for values in (*scored.starting_values, *([scored.phase_shift.values] if scored.phase_shift else ())):
            place = self.with_values(self.with_starting_values(state.look.place, self.setup.base), values)
            other = self.refit(self.study.linearise(place, self.active(chosen)), chosen, f"{name}, from afar", fraction)
            after = self.likeliest(after, other)
        verdict = self.assess(state, after, one)
        gains = state.likelihood - after.likelihood
        fitted, held = float(gains[self.study.used].sum()), float(gains[~self.study.used].sum())
        for i, score in enumerate(self.scores):
            if score.round == number and (score.effect, score.degree_of_freedom) == (one.effect, one.dof):
                held_out = verdict.held if verdict.unseen else None
                self.scores[i] = replace(score, refitted=fitted, refitted_holdout=held_out, verdict=verdict)
        worth = fitted + max(held, -1e3) - len(one.labels) * math.log(self.count)
        return RefittedCandidate(one, scored.predicted.fitted, after, verdict, worth)
