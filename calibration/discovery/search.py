"""A search for missing effects: its fits, and what it has come to so far."""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.discovery.acceptance import Verdict
from calibration.discovery.diagnosis import DetectionLimit, Rejected, Score
from calibration.discovery.effect_fits import EffectFits, ReportStage
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.fit_state import FitState, ResidualSummary
from calibration.discovery.refusal import Refusal
from calibration.discovery.study_set_up import StudySetup


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


@dataclass
class SearchRecord:
    """What a search has come to so far.

    Attributes:
        scores: First-order gains of the candidates in every round.
        rejected: Why candidates are not in the model, by name.
        notes: Notes to report, in words.
        earlier: Computing time of earlier, stopped runs (s).
        alone: Residual of a calibration to decays alone, where there are seas too.
        accepted: Evidence of the accepted effects by name.
        shortlist: Candidates that helped in the rounds along all candidates, or were in probable sets.
        limits: Detection limits of the amplitudes of candidates by name, in the last round along them.
    """

    scores: list[Score] = field(default_factory=list)
    rejected: dict[str, Rejected] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    earlier: float = 0.0
    alone: ResidualSummary | None = None
    accepted: dict[str, AcceptedEffect] = field(default_factory=dict)
    shortlist: list[ListedVariant] = field(default_factory=list)
    limits: dict[str, tuple[DetectionLimit, ...]] = field(default_factory=dict)

    def reject(self, candidate: Candidate, why: Refusal | None, taken_out: Verdict | None = None) -> None:
        """Record why a candidate is not in the model.

        Args:
            candidate: The candidate.
            why: The reason; None records nothing.
            taken_out: The verdict that removed it, where it was in the model.
        """
        if why is not None:
            self.rejected[candidate.name] = Rejected(candidate.effect, candidate.dof, why, taken_out)


class Search(NamedTuple):
    """A search for missing effects.

    Attributes:
        fits: Study, candidates and priors, and the fits with them.
        record: What the search has come to so far.
    """

    fits: EffectFits
    record: SearchRecord

    @classmethod
    def of(cls, campaign: Campaign, setup: StudySetup, say: ReportStage) -> "Search":
        """A search that has not begun.

        Args:
            campaign: The campaign.
            setup: Study, candidates, priors.
            say: Called with every stage.
        """
        return cls(EffectFits(campaign, setup, say), SearchRecord())
