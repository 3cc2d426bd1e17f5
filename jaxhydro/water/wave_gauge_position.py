"""Error of the stated wave gauge position along the waves."""

from typing import ClassVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.parameters import Parameter
from jaxhydro.water.water_effect import AbstractWaterEffect
from jaxhydro.waves.sea import AbstractSea

MAX_OFFSET = 50.0  # m


class WaveGaugePosition(AbstractWaterEffect):
    """Shift of the sea along the waves by an error of the gauge position.

    eta(x, t) = eta_said(x - d, t): the gauge stood d further along the waves (to where they travel) than was said.

    What it recorded belongs d further down, so the whole sea of the record is moved by d along its direction: every phase
    grows by k d, bound waves' by their own wavenumber (linear and second-order waves of constant form, Sharma and Dean 1981,
    SPE Journal 21, 604-612). Exact in any sea, but for `AbstractSea.drift` of a prepared one, which moves with the energy's
    group velocity. A prepared sea is good in a box about the hull, of which d takes its share. The waves of second order
    that were taken off the record do not depend on d.
    """

    values: dict[str, Float[Array, ""]]
    comes_last: ClassVar[bool] = True
    source: ClassVar[str] = "Sharma and Dean 1981, SPE Journal 21 (the waves that are moved)"

    @classmethod
    def null(cls) -> "WaveGaugePosition":
        """Effect at its neutral value: the gauge where it was stated."""
        return cls({"wave_gauge_position.distance": jnp.zeros(())})

    def about(self, label: str) -> Parameter:
        words = "how much further along the waves the gauge stood than was said"
        return Parameter("m", words, -MAX_OFFSET, MAX_OFFSET, of_hull=False)

    def through(self, sea: AbstractSea) -> AbstractSea:
        return sea.moved(jnp.asarray(self.values["wave_gauge_position.distance"]))
