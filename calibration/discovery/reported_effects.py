"""Effects that the model lacks, as a diagnosis reports them: sizes, evidence and reasons for doubt."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from calibration.result import Estimate

# reason for doubt in an effect: the effects increase the held-out error, in all or in the effect's motion
HELD_OUT_ERROR = "held_out_error"
# reason for doubt in an effect: its fitted size is at an end of its plausible range
IMPLAUSIBLE_SIZE = "implausible_size"
# reason for doubt in an effect: it goes with the square of the waves, whose second order the records lack
WAVE_ORDER = "wave_order"


@dataclass(frozen=True, eq=False)
class Evidence:
    """Evidence for an effect.

    Attributes:
        score: First-order decrease of -2 ln L of the fitted tests, beyond what the fitted parameters can explain.
        delta_bic: Decrease of BIC after the refit; positive values speak for the effect.
        holdout_gain: Fraction of the held-out squared error removed, where the effect acts most (1: all of it).
        clear: Parameters over their standard deviations.
        probability: Posterior probability among all candidates, or NaN.
        left_out: Decrease of -2 ln L summed over the fitted tests, each left out in turn in the linearised model, or NaN.
        left_out_better: Fraction of these tests that are predicted better with the effect, or NaN.
    """

    score: float
    delta_bic: float
    holdout_gain: float
    clear: float
    probability: float = math.nan
    left_out: float = math.nan
    left_out_better: float = math.nan


@dataclass(frozen=True, eq=False)
class PlausibleRange:
    """Sizes that a parameter of an effect can plausibly have.

    Attributes:
        lower: Lowest value (SI).
        upper: Highest value (SI).
        source: Where the range comes from, in a sentence.
        at_end: Whether the fitted value is at an end that is not its neutral value.
    """

    lower: float
    upper: float
    source: str
    at_end: bool


@dataclass(frozen=True, eq=False)
class Effect:
    """An effect that was found.

    Attributes:
        effect: Its name in the catalogue.
        degree_of_freedom: The motion it acts in, or None.
        meaning: Meaning of its amplitudes.
        source: Reference of its law.
        parameters: Estimates by label.
        evidence: Why it is accepted.
        share: Fraction of the unexplained error of the fitted tests that it explains.
        indistinguishable: Effects that the records cannot tell from it.
        telling_test: The test that would tell them apart, or None.
        in_doubt: A rejected effect that explains more beside it, `HELD_OUT_ERROR`, `IMPLAUSIBLE_SIZE` or `WAVE_ORDER`; None:
            no doubt.
        plausible: Plausible ranges of its amplitudes by label.
        trades_against: Correlation of its size with that of other effects found, by their names, where it is close to 1 or -1.
    """

    effect: str
    degree_of_freedom: str | None
    meaning: str
    source: str
    parameters: dict[str, Estimate]
    evidence: Evidence
    share: float
    indistinguishable: tuple[str, ...]
    telling_test: str | None
    in_doubt: str | None = None
    plausible: Mapping[str, PlausibleRange] = field(default_factory=dict)
    trades_against: Mapping[str, float] = field(default_factory=dict)
