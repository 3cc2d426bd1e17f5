"""Hints on fitted coefficients that are off by a ratio of units or by a sign."""

import math
from collections.abc import Iterable, Iterator

from calibration.result import Estimate

UNIT_RATIOS = {180 / math.pi: "degrees and radians", 1000.0: "millimetres and metres"}
RATIO_TOLERANCE = 0.05  # of a ratio's logarithm to base e, by which a coefficient may miss it
MAX_RELATIVE_DEVIATION = 0.1  # of a coefficient: a larger standard deviation says nothing of its ratio


def unit_hints(parameters: Iterable[Estimate]) -> Iterator[str]:
    """Hints on coefficients that a mistaken unit or sign would explain.

    A coefficient is compared with the value that its fit began from. A damping that goes with the square of the motion takes up
    the unit of the motion. A coupling takes up the sign of an axis.
    """
    for estimate in parameters:
        deviation = estimate.standard_deviation
        if (
            not estimate.identifiable
            or estimate.start == 0
            or estimate.value == 0
            or deviation is None
            or deviation > MAX_RELATIVE_DEVIATION * abs(estimate.value)
        ):
            continue
        ratio = estimate.value / estimate.start
        if abs(math.log(abs(ratio))) < RATIO_TOLERANCE and ratio < 0:
            yield (
                f"{estimate.label} has the declared size and the other sign: "
                "is an axis reversed in a record or the platform file?"
            )
        for factor, units in UNIT_RATIOS.items():
            if ratio > 0 and abs(abs(math.log(ratio)) - math.log(factor)) < RATIO_TOLERANCE:
                times = f"{ratio:.3g} times" if ratio > 1 else f"1/{1 / ratio:.3g} of"
                yield f"{estimate.label} is {times} the declared value: are {units} mixed up, in a record or the platform file?"
