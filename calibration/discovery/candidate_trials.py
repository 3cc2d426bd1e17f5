"""What a search makes of candidates: scored at their nulls, tried by a refit, found; and in which order they are believed."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from calibration.discovery.acceptance import FitState, Verdict
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.effects.phase_shift_start import PhaseShiftStart
from calibration.discovery.eliminated_least_squares import FirstOrderGain
from calibration.discovery.linearisations import Linearisation

INDISTINGUISHABLE_SHARE = 0.1  # of the best one's gain: what comes as near cannot be told from it
SENSOR_EFFECTS = ("sensor_reference", "sensor_lag", "wave_gauge_position")


class ScoredCandidate(NamedTuple):
    """A candidate at its null, at the best of its shapes: what it would gain at first order, and the look that says so; where
    it may be, what it gains there, further off than first order tells; and values at which a refit begins, too, whatever is
    said at first order."""

    candidate: Candidate
    predicted: FirstOrderGain
    look: Linearisation
    phase_shift: PhaseShiftStart | None = None
    starting_values: tuple[Mapping[str, float], ...] = ()

    @property
    def promise(self) -> float:
        """What -2 ln L of the fitted tests may gain."""
        return max(self.predicted.fitted, self.phase_shift.gain if self.phase_shift else 0.0)


class RefittedCandidate(NamedTuple):
    """A refit: where it ended, what it says, and what that is worth beside others; `score` is the first-order gain."""

    candidate: Candidate
    score: float
    state: FitState
    verdict: Verdict
    worth: float

    def indistinguishable_from(self, best: "RefittedCandidate") -> bool:
        """Whether it cannot be told from another."""
        return best.worth - self.worth < INDISTINGUISHABLE_SHARE * abs(best.worth)


def in_order_of_belief(good: Sequence[RefittedCandidate]) -> list[RefittedCandidate]:
    """As they are to be believed: among those that cannot be told from the best one first what sensors make of a motion, then
    what has the fewest parameters; the others by what they are worth."""
    best = max(good, key=lambda one: one.worth, default=None)

    def rank(one: RefittedCandidate) -> tuple[float, ...]:
        if best is None or not one.indistinguishable_from(best):
            return 1, -one.worth
        return 0, one.candidate.effect not in SENSOR_EFFECTS, len(one.candidate.labels), -one.worth

    return sorted(good, key=rank)


class AcceptedEffect(NamedTuple):
    """An effect's evidence: its first-order gain, the states before it was let in and after, the verdict, and what the records
    cannot tell from it."""

    score: float
    before: FitState
    after: FitState
    verdict: Verdict
    alike: tuple[str, ...]
