"""Base class of loads, and their forces and added mass at an instant."""

import abc
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Array, Complex, Float

from jaxhydro.loads.forces_at_rest import ForcesAtRest
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import AbstractEffect
from jaxhydro.waves.directional_transfer import AnyTransfer
from jaxhydro.waves.excitation import AnyExcitation
from jaxhydro.waves.sea_state import SeaState


class Action(NamedTuple):
    """Forces, added mass and memory rate of a load at an instant; None for those it does not have.

    Attributes:
        force: Force and moment on the reference point, earth axes (N, N m).
        body_force: Force and moment on the reference point, body axes (N, N m).
        added_mass: Added mass at the reference point, body axes (kg, kg m, kg m²).
        strip_force: Force on each strip along its two directions (N).
        element_mass: Added mass of strips per displaced volume (kg/m³), by direction and load element.
        end_force: Force on each end along its axis (N).
        end_mass: Added mass of each end (kg).
        memory_rate: Time derivative of the load's memory.

    The added mass of strips and ends multiplies their whole acceleration, the centripetal part included.
    """

    force: Float[Array, "6"] | None = None
    body_force: Float[Array, "6"] | None = None
    added_mass: Float[Array, "6 6"] | None = None
    strip_force: Float[Array, "2 n"] | None = None
    element_mass: Float[Array, "2 e"] | None = None
    end_force: Float[Array, " m"] | None = None
    end_mass: Float[Array, " m"] | None = None
    memory_rate: Any = None


class AbstractLoad(AbstractEffect):
    """Base class of all loads: a differentiable force law with named, bounded parameters."""

    def rest(self) -> Any:
        """Memory before t = 0; None for a load without memory (not `()`, which diffrax cannot carry)."""
        return None

    def settled(self, displacement: Float[Array, "6"]) -> Any:
        """Memory after a slow displacement (m, rad, from rest) that is held."""
        return self.rest()

    def fastest(self) -> float:
        """Largest rate (1/s) of the memory alone, which a time step must resolve.

        0 for a load without memory, or with a slow one only.
        """
        return 0.0

    def retardation(self, omega: float) -> Complex[np.ndarray, "6 6"] | None:
        """Frequency response of a linear memory, or None.

        Args:
            omega: Frequency (rad/s).

        Returns:
            K in F = -K v, along body axes (N s/m, N s, N m s): damping, and i omega times added mass.
        """
        return None

    def in_sea(self, state: SeaState) -> "AbstractLoad":
        """The load with the coefficients of a sea state; itself where it does not depend on the sea state."""
        return self

    def excitation_table(self) -> AnyExcitation | None:
        """First-order forces that the load needs of a sea (`AbstractSea.with_tables`), or None."""
        return None

    def transfer_function(self) -> AnyTransfer | None:
        """Difference-frequency forces that the load needs of a sea (`AbstractSea.with_tables`), or None."""
        return None

    def covers(self) -> tuple[str, float, float] | None:
        """Key in the platform file and frequency range (rad/s) of the load's table; None without one."""
        return None

    def replaces(self) -> Float[Array, ""] | None:
        """Fraction of the strips' inertial wave load that this load replaces (0 to 1), or None.

        The fraction applies to the accelerations and pressures of the water at strips and ends.
        """
        return None

    def replaces_added_mass(self) -> Float[Array, ""] | None:
        """Fraction of the added mass of strips and ends that this load replaces (0 to 1), or None."""
        return None

    def forces_at_rest(self, excitation: Float[Array, " k"] | None) -> ForcesAtRest | None:
        """First-order forces at rest that strips and ends do not keep, or None.

        Args:
            excitation: The sea's value of `excitation_table` at the instant; None in still water.
        """
        return None

    def second_order_share(self) -> Float[Array, ""] | None:
        """Fraction of the second-order forces on slender members that strips and ends have, or None."""
        return None

    def fast_displacement(self, memory: Any) -> Float[Array, "2"] | None:
        """Part of the platform's displacement that computed wave forces do not follow, or None.

        Args:
            memory: The load's memory.

        Returns:
            Horizontal displacement (m, earth axes), (2,), or None.
        """
        return None

    @abc.abstractmethod
    def act(self, now: Instant, memory: Any) -> Action:
        """Forces, added mass and memory rate at an instant.

        Args:
            now: Motion, geometry and flow at the instant.
            memory: The load's memory, as from `rest`.
        """
