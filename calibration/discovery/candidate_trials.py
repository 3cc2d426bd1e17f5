"""Candidates scored at first order, refitted, accepted; order of acceptance."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from calibration.discovery.acceptance import FitState, Verdict
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.effects.phase_shift_start import PhaseShiftStart
from calibration.discovery.eliminated_least_squares import FirstOrderGain
from calibration.discovery.linearisations import Linearisation

INDISTINGUISHABLE_SHARE = 0.1  # of the best gain: a smaller difference does not tell candidates apart
SENSOR_EFFECTS = ("sensor_reference", "sensor_lag", "wave_gauge_position")  # effects of sensors, tried first


class ScoredCandidate(NamedTuple):
    """A candidate with its first-order gain.

    Attributes:
        candidate: The candidate.
        predicted: First-order gain at the neutral value, at the best of its shapes.
        look: The linearisation that gives this gain.
        phase_shift: For a phase shift too large for first order: where it may be, and its gain there.
        starting_values: Further values at which a refit begins, whatever the first-order gain.
    """

    candidate: Candidate
    predicted: FirstOrderGain
    look: Linearisation
    phase_shift: PhaseShiftStart | None = None
    starting_values: tuple[Mapping[str, float], ...] = ()

    @property
    def promise(self) -> float:
        """Largest predicted decrease of -2 ln L of the fitted tests."""
        return max(self.predicted.fitted, self.phase_shift.gain if self.phase_shift else 0.0)


class RefittedCandidate(NamedTuple):
    """A candidate after its refit.

    Attributes:
        candidate: The candidate.
        score: First-order gain of -2 ln L.
        state: The refitted model.
        verdict: Outcome of the acceptance tests.
        worth: Gain in fitted and held-out tests less the BIC penalty, to compare candidates by.
    """

    candidate: Candidate
    score: float
    state: FitState
    verdict: Verdict
    worth: float

    def indistinguishable_from(self, best: "RefittedCandidate") -> bool:
        """Whether its gain is so close to the best one's that the records cannot tell them apart."""
        return best.worth - self.worth < INDISTINGUISHABLE_SHARE * abs(best.worth)


def in_order_of_belief(good: Sequence[RefittedCandidate]) -> list[RefittedCandidate]:
    """Accepted candidates in the order in which they are tried.

    Among those indistinguishable from the best one, sensor effects come first, then those with the fewest parameters. The
    others follow by their gain.
    """
    best = max(good, key=lambda one: one.worth, default=None)

    def rank(one: RefittedCandidate) -> tuple[float, ...]:
        if best is None or not one.indistinguishable_from(best):
            return 1, -one.worth
        return 0, one.candidate.effect not in SENSOR_EFFECTS, len(one.candidate.labels), -one.worth

    return sorted(good, key=rank)


class AcceptedEffect(NamedTuple):
    """Evidence of an effect in the model.

    Attributes:
        score: First-order gain of -2 ln L.
        before: Fit without the effect.
        after: Fit with the effect.
        verdict: Outcome of the acceptance tests.
        alike: Names of effects that the records cannot tell from it.
    """

    score: float
    before: FitState
    after: FitState
    verdict: Verdict
    alike: tuple[str, ...]
