"""Base class of effects on the water that the platform meets."""

from typing import ClassVar

from jaxtyping import Array, Float

from jaxhydro.parameters import AbstractEffect
from jaxhydro.waves.sea import AbstractSea


class AbstractWaterEffect(AbstractEffect):
    """Base class of effects that change the sea that the platform meets.

    Attributes:
        comes_last: Whether the effect changes the sea together with all that other effects make of it.
    """

    comes_last: ClassVar[bool] = False

    def current(self, height: Float[Array, " p"]) -> Float[Array, "3 p"] | None:
        """Steady current (m/s, earth axes) that is added to the water, (3, p), or None.

        Args:
            height: Heights over still water (m), (p,).
        """
        return None

    def through(self, sea: AbstractSea) -> AbstractSea:
        """The sea as changed by this effect; the same sea where it is not changed.

        Args:
            sea: The sea.
        """
        return sea
