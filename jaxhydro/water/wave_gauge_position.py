"""Error of the stated wave gauge position along the waves."""

from typing import ClassVar

from jaxtyping import Array, Float

from jaxhydro.parameters import parameter
from jaxhydro.water.water_effect import AbstractWaterEffect
from jaxhydro.waves.sea import AbstractSea

MAX_OFFSET = 50.0  # m
DISTANCE = "how much further along the waves the gauge stood than was said"


class WaveGaugePosition(AbstractWaterEffect):
    """Shift of the sea along the waves by an error of the gauge position.

    eta(x, t) = eta_stated(x - d, t): the gauge stood d further along the waves (to where they travel) than was stated.

    The recorded waves belong d further down, so the whole sea of the record is moved by d along its direction. Every phase
    grows by k d, that of bound waves by their own wavenumber. That is so for linear and second-order waves of constant form
    (Sharma and Dean 1981, SPE Journal 21, 604-612). It is exact in any sea, but for `AbstractSea.drift` of a prepared one,
    which moves with the energy's group velocity. A prepared sea is good in a box about the hull, of which d takes its share.
    The waves of second order that were taken off the record do not depend on d.
    """

    distance: Float[Array, ""] = parameter("m", DISTANCE, -MAX_OFFSET, MAX_OFFSET, of_hull=False)
    comes_last: ClassVar[bool] = True
    source: ClassVar[str] = "Sharma and Dean 1981, SPE Journal 21 (the waves that are moved)"

    def through(self, sea: AbstractSea) -> AbstractSea:
        return sea.moved(self.distance)
