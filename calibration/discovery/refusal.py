"""Reasons why a candidate effect is not in the model, as values."""

from dataclasses import dataclass
from enum import StrEnum


class ComparedData(StrEnum):
    """Data on which the model with an effect is compared with the model without it."""

    FITTED = "fitted"
    HELD_OUT = "held_out"
    BLOCKS = "blocks"
    ALL = "all"


class RefusalKind(StrEnum):
    """Kind of a reason; comments state the numbers in `Refusal.values`."""

    IMPOSSIBLE_VALUE = "impossible_value"  # value of the parameter `name`
    LITTLE_BIC_GAIN = "little_bic_gain"  # decrease of BIC, and the least that is asked
    HELD_OUT_ERROR = "held_out_error"  # fraction of the squared error removed
    HELD_OUT_LIKELIHOOD = "held_out_likelihood"  # decrease of -2 ln L
    LITTLE_TOTAL_GAIN = "little_total_gain"  # decreases of BIC and of -2 ln L
    INSIGNIFICANT = "insignificant"  # parameters over their standard deviations
    NEGLIGIBLE = "negligible"
    WORSE_MOTION = "worse_motion"  # objective of the motion `name`, or "" for all, without and with the effect
    WORSE_TEST = "worse_test"  # error of the motion of a test `name` over the motion, in the baseline and with the effect
    IMPROBABLE = "improbable"  # posterior probability
    UNSETTLED = "unsettled"  # posterior probability, which is high; most rounds, or a smaller set, do without the effect


@dataclass(frozen=True)
class Refusal:
    """Reason why an effect is not in the model.

    Attributes:
        kind: Kind of the reason.
        values: Numbers of that kind.
        name: A parameter, motion or effect, where the kind has one.
        compared: Data that the reason refers to.
    """

    kind: RefusalKind
    values: tuple[float, ...] = ()
    name: str = ""
    compared: ComparedData = ComparedData.FITTED
