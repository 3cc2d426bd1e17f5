"""Added mass at infinite frequency from a radiation-diffraction program, in place of the strips'."""

from typing import Any, ClassVar

from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import parameter


class ComputedAddedMass(AbstractLoad):
    """Added mass of potential theory at infinite frequency, in place of that of strips and ends.

    F = -s A(infinity) a, a the acceleration of the reference point along the axes of `AddedMass`, its quadratic terms left out;
    the added mass of strips and ends counts 1 - s.

    It is the part of Cummins' equation that the memory (`ComputedRadiation`) leaves: with s = 1 and the whole memory, the
    added mass at a frequency is that of the program. s is a share: 0 for the strips' own added mass, 1 for the program's. What
    water does to strips and ends in waves stays as it is: `ComputedExcitation` has its own share. The label is
    `computed_added_mass.share`.

    Attributes:
        matrix: A(infinity) (kg, kg m, kg m²) about the reference point.
        share: s (-).
    """

    matrix: Float[Array, "6 6"]
    share: Float[Array, ""] = parameter("-", "share of the computed added mass, in place of the strips'", -0.5, 2.0)
    source: ClassVar[str] = "Cummins 1962, Schiffstechnik 9, 101-109; Ogilvie 1964"

    def replaces_added_mass(self) -> Float[Array, ""]:
        return self.share

    def act(self, now: Instant, memory: Any) -> Action:
        return Action(added_mass=now.body_added_mass(self.share * self.matrix))
