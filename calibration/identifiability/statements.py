"""Statements on identifiability, as values: directions, combinations, parameters to fix."""

from typing import NamedTuple

import numpy as np

from calibration.formatting import listed, number, percent, readable_unit, with_deviation
from calibration.parameters.space import VAGUE_DEVIATION

MIN_SHOWN_WEIGHT = 0.005  # weight of a combination, the largest 1, that is not told


class Parameters(NamedTuple):
    """The free parameters where the fit ended.

    Attributes:
        labels: Labels.
        value: Values (p,).
        slope: d value / d coordinate (p,).
        unit: Units.
        family: Families, by `parameter_family`.
    """

    labels: tuple[str, ...]
    value: np.ndarray
    slope: np.ndarray
    unit: tuple[str, ...]
    family: tuple[str, ...]

    def relative(self) -> np.ndarray:
        """d ln(value) / d coordinate; 1 for a value of zero."""
        return np.where(self.value == 0, 1.0, self.slope / np.where(self.value == 0, 1.0, np.abs(self.value)))


class Combination(NamedTuple):
    """Combination of parameters that the records determine.

    It is the sum of weight times value, or the product of values to the power of their weights. The largest weight is 1. In a
    sum of mixed units, the weight of the parameter that counts most is 1, and the sum has its unit.

    Attributes:
        weights: Weights by label.
        product: Whether it is a product.
        value: Value, in `unit`.
        standard_deviation: Standard deviation, in `unit` for a sum, relative for a product.
        unit: Unit of a sum.
    """

    weights: dict[str, float]
    product: bool
    value: float
    standard_deviation: float
    unit: str

    def __str__(self) -> str:
        if self.product:
            powers = " ".join(
                f"{label}^{weight:.2f}" for label, weight in self.weights.items() if abs(weight) >= MIN_SHOWN_WEIGHT
            )
            return f"the product {powers} is known to {percent(self.standard_deviation)}"
        terms = " ".join(
            f"{'-' if w < 0 else '+'} {number(abs(w), 3)} {label}"
            for label, w in self.weights.items()
            if abs(w) >= MIN_SHOWN_WEIGHT
        )
        unit = f" {readable_unit(self.unit)}".rstrip()
        value = with_deviation(self.value, self.standard_deviation)
        return f"their weighted sum {terms.removeprefix('+ ')} = {value}{unit} is known"


class Direction(NamedTuple):
    """Change of parameters that the records do not see.

    Attributes:
        movement: Relative changes by label, the largest 10 %.
        standard_deviation: Standard deviation in the coordinates, along the direction with unit length.
        known: Combination of these parameters that is known; None where there is none.
    """

    movement: dict[str, float]
    standard_deviation: float
    known: Combination | None

    def sentence(self, source: str, again: bool = False) -> str:
        """Sentence on the direction.

        Args:
            source: Description of the records.
            again: Whether the known combination was stated before, and is left out.
        """
        labels = list(self.movement)
        if len(labels) == 1:
            if self.standard_deviation > VAGUE_DEVIATION:
                return f"{source} cannot say what {labels[0]} is"
            return f"{source} can say {labels[0]} to {percent(self.standard_deviation)} only"
        verb = "cannot tell" if self.standard_deviation > 1 else "can hardly tell"
        apart = f"{labels[0]} from {labels[1]}" if len(labels) == 2 else f"{listed(labels)} from one another"
        moves = listed([f"{label} {100 * change:+.2g} %" for label, change in self.movement.items()])
        remark = str(self.known or "no combination of them is known either")
        sentence = f"{source} {verb} {apart}. Together {moves} leave the records as they are"
        return sentence if again else f"{sentence}. {remark[0].upper()}{remark[1:]}"


class Fix(NamedTuple):
    """Parameter of a weak direction to fix, or to give a prior.

    Attributes:
        label: Label of the parameter.
        reduction: Decrease of the summed variance of the others, in the coordinates.
        share: This decrease as a fraction of that variance.
        after: Standard deviations of the direction's other parameters once it is fixed, by label.
    """

    label: str
    reduction: float
    share: float
    after: dict[str, float]

    def __str__(self) -> str:
        deviations = listed([f"{label} to {percent(deviation)}" for label, deviation in self.after.items()])
        gain = f"The others are then known better: {deviations}" if deviations else "The others are then known better"
        ways = "fix it (`calibrate.fixed`) or give it a prior (`calibrate.priors`)"
        return f"if {self.label} is known from elsewhere, {ways}. {gain}"


class Collinear(NamedTuple):
    """Collinearity index of a group of parameters of one family."""

    labels: tuple[str, ...]
    gamma: float
