"""Force tables that loads need from the sea, and strip forces that loads replace."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, NamedTuple, cast

from jaxtyping import Array, Float

from jaxhydro.dynamics.newton_euler import at_most_one, optional_sum
from jaxhydro.loads.base import AbstractLoad
from jaxhydro.loads.forces_at_rest import ForcesAtRest
from jaxhydro.waves.directional_transfer import AnyTransfer
from jaxhydro.waves.excitation import AnyExcitation


def transfer_of(loads: Sequence[AbstractLoad]) -> AnyTransfer | None:
    """Difference-frequency transfer function that one of the loads has, or None; ValueError for two."""
    tables = [load.transfer_function() for load in loads]
    return cast(AnyTransfer | None, at_most_one("difference-frequency transfer function", tables))


def excitation_of(loads: Sequence[AbstractLoad]) -> AnyExcitation | None:
    """First-order excitation that one of the loads has, or None; ValueError for two."""
    tables = [load.excitation_table() for load in loads]
    return cast(AnyExcitation | None, at_most_one("computed excitation", tables))


def forces_at_rest_of(loads: Sequence[AbstractLoad], excitation: Float[Array, " k"] | None) -> ForcesAtRest | None:
    """First-order forces at rest that strips and ends do not keep, or None; ValueError for two.

    Args:
        loads: The loads.
        excitation: The sea's computed excitation (N, N m).
    """
    return at_most_one("correction of diffraction", [load.forces_at_rest(excitation) for load in loads])


class StripChanges(NamedTuple):
    """What loads change together in the forces of strips and ends at an instant.

    Attributes:
        replaced: Fraction of the strips' inertial wave load that other loads replace.
        fast_displacement: Part of the horizontal displacement (m) that those other loads do not follow.
        second_order: Fraction of the second-order forces on slender members that strips and ends have.
        excited: Whether any load needs the sea's computed excitation.
        mass_replaced: Whether other loads replace added mass of strips and ends.
        forces_at_rest: First-order forces at rest that strips and ends do not keep, from that excitation.
    """

    replaced: Float[Array, ""] | None
    fast_displacement: Float[Array, "2"] | None
    second_order: Float[Array, ""] | None
    excited: bool
    mass_replaced: bool
    forces_at_rest: Callable[[Float[Array, " k"] | None], ForcesAtRest | None]

    @classmethod
    def of(cls, loads: Sequence[AbstractLoad], memory: tuple[Any, ...]) -> "StripChanges":
        """Changes that loads make.

        Args:
            loads: The loads.
            memory: Memory of each load.
        """
        return cls(
            replaced=optional_sum([load.replaces() for load in loads]),
            fast_displacement=optional_sum(
                [load.fast_displacement(remembered) for load, remembered in zip(loads, memory, strict=True)]
            ),
            second_order=optional_sum([load.second_order_share() for load in loads]),
            excited=excitation_of(loads) is not None,
            mass_replaced=any(load.replaces_added_mass() is not None for load in loads),
            forces_at_rest=partial(forces_at_rest_of, loads),
        )
