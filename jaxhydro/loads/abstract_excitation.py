"""Base of first-order wave forces from a table, where the platform is slowly displaced."""

from typing import Any

import equinox as eqx
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.slow_displacement import CORNER, memory_at_rest, memory_rate
from jaxhydro.parameters import parameter
from jaxhydro.waves.excitation import AnyExcitation


class AbstractExcitation(AbstractLoad):
    """Base class of first-order wave forces from a table.

    Their memory is the filter of `slow_displacement`: the forces follow the slow displacement of the platform.

    Attributes:
        excitation: The table; the first six rows are the force itself.
        share: Fraction of the force that acts (-).
        corner: Corner frequency of the filter (rad/s).
    """

    excitation: AnyExcitation
    share: Float[Array, ""] = parameter("-", "share of the computed excitation", -0.5, 2.0)
    corner: float = eqx.field(static=True, default=CORNER)

    def excitation_table(self) -> AnyExcitation:
        return self.excitation

    def covers(self) -> tuple[str, float, float]:
        return "excitation", float(self.excitation.omega[0]), float(self.excitation.omega[-1])

    def rest(self) -> Float[Array, "2 2"]:
        return memory_at_rest()

    def fast_displacement(self, memory: Float[Array, "2 2"]) -> Float[Array, "2"]:
        return memory[0]

    def act(self, now: Instant, memory: Any) -> Action:
        rate = memory_rate(memory, now.earth_velocity()[:2], self.corner)
        if now.end_flow.pressure is None:
            return Action(memory_rate=rate)
        if now.excitation is None:
            raise ValueError("the sea was made without the platform's excitation: prepare it with `Model.excitation`")
        return Action(force=self.share * now.excitation[:6], memory_rate=rate)
