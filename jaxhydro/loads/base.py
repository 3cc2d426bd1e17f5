"""Base class of loads, and their parameters."""

import abc
import math
from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.loads.instant import Instant
from jaxhydro.waves.excitation import Excitation
from jaxhydro.waves.sea import AbstractSea
from jaxhydro.waves.sea_state import SeaState
from jaxhydro.waves.transfer import Transfer


class Parameter(NamedTuple):
    """Unit, meaning, bounds and neutral value of a load's parameter.

    A `lower` bound of 0 or more means that the quantity cannot be negative, as drag, stiffness and times cannot (`check`). All
    other bounds only limit where a fit searches: published values beyond them, such as a Cd of 30 for a plate, are not wrong.

    Attributes:
        unit: Unit, "-" where there is none.
        meaning: What the parameter is, in words.
        lower: Lower bound.
        upper: Upper bound.
        null: Neutral value, at which the parameter has no effect.
        of_hull: Whether bounds that are lengths or times scale with the platform's size.
    """

    unit: str
    meaning: str
    lower: float = float("-inf")
    upper: float = float("inf")
    null: float = 0.0
    of_hull: bool = True  # bounds that are lengths or times follow the platform's size; not where a wave gauge may have stood

    def check(self, label: str, value: Any) -> None:
        """Raise ValueError for a value that is not finite, or is negative where it cannot be.

        Args:
            label: Label of the parameter, for the message.
            value: Number or array to check.

        Raises:
            ValueError: The value is not a finite number, or is negative although `lower` is 0 or more.
        """
        try:
            numbers = np.asarray(value, float)
        except (TypeError, ValueError):
            raise ValueError(f"{label}: expected a number ({self.unit}), found {value!r}") from None
        least = 0.0 if self.lower >= 0 else -math.inf
        if not (np.isfinite(numbers) & (numbers >= least)).all():
            expected = "a finite number" if least < 0 else "a finite number of 0 or more"
            found = ", ".join(f"{one:g}" for one in numbers.ravel()[:3])
            raise ValueError(f"{label}: expected {expected} ({self.unit}: {self.meaning}), found {found}")

    def sized(self, size: float, pace: float) -> "Parameter":
        """The parameter with bounds for a platform of another size.

        Args:
            size: Length scale (-) relative to VolturnUS-S (`jaxhydro.scales`).
            pace: Time scale (-) relative to VolturnUS-S.

        Returns:
            The same parameter; bounds in m, s, Hz or m/s are scaled where `of_hull` is set.
        """
        factor = {"m": size, "s": pace, "Hz": 1 / pace, "m/s": size / pace}.get(self.unit, 1.0)
        lower, upper = min(self.lower * factor, self.null), max(self.upper * factor, self.null)
        return self if factor == 1.0 or not self.of_hull else self._replace(lower=lower, upper=upper)


class Action(NamedTuple):
    """Forces, added mass and memory rate of a load at an instant; None for what it does not have.

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


class AbstractLoad(eqx.Module):
    """Base class of all loads: a differentiable force law with named, bounded parameters.

    A load knows nothing of batches, of the model around it or of calibration. Loads that are not forces override other methods:
    `stream` and `through` change the water, `seen` and `clock_lag` the sensors.

    Attributes:
        values: Parameters that may be calibrated, by label.
        source: Publication or program that the law was taken from.
        moves: Whether the load moves the sea, together with all that other loads make of it.
    """

    values: eqx.AbstractVar[Mapping[str, Float[Array, ""]]]
    source: ClassVar[str] = ""
    moves: ClassVar[bool] = False  # the sea, with all that others make of it

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

    def in_sea(self, state: SeaState) -> "AbstractLoad":
        """The load with the coefficients of a sea state; itself where it does not depend on the sea state."""
        return self

    def stream(self) -> Float[Array, "3"] | None:
        """Steady current (m/s, earth axes) that the load adds to the water everywhere, or None."""
        return None

    def through(self, sea: AbstractSea) -> AbstractSea:
        """The sea as changed by the load; the same sea where the load does not change it."""
        return sea

    def drifts(self) -> Transfer | None:
        """Difference-frequency transfer function with which an irregular sea is prepared, or None."""
        return None

    def excites(self) -> Excitation | None:
        """First-order excitation with which an irregular sea is prepared, or None."""
        return None

    def covers(self) -> tuple[str, float, float] | None:
        """Key in the platform file and frequency range (rad/s) of the load's table; None without one."""
        return None

    def replaces(self) -> Float[Array, ""] | None:
        """Fraction of the strips' inertial wave load that this load replaces (0 to 1), or None.

        The fraction applies to the accelerations and pressures of the water at strips and ends.
        """
        return None

    def seen(self, position: Float[Array, "... 6"]) -> Float[Array, "... 6"]:
        """Reading of the motion sensors at a position (m, rad), (..., 6)."""
        return position

    def clock_lag(self) -> Float[Array, ""] | None:
        """Lag (s) of the recorded motions behind the waves, or None.

        The record at t shows the motion at t - lag.
        """
        return None

    @abc.abstractmethod
    def about(self, label: str) -> Parameter:
        """Unit, meaning, bounds and neutral value of one parameter of this load."""

    def act(self, now: Instant, memory: Any) -> Action:
        """Forces, added mass and memory rate at an instant; empty for a load that is not a force.

        Args:
            now: Motion, geometry and flow at the instant.
            memory: The load's memory, as from `rest`.
        """
        return Action()
