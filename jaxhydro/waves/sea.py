"""Base of all seas: water flow and surface elevation at any time and position; still water.

The simulator asks for `AbstractSea.flow` and `AbstractSea.surface` only.
"""

import abc
import math
from typing import Literal

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax.typing import ArrayLike
from jaxtyping import Array, Float

from jaxhydro.quick_jit import on_device
from jaxhydro.waves.directional_transfer import AnyTransfer
from jaxhydro.waves.excitation import AnyExcitation
from jaxhydro.waves.flow import Cylinders, Flow

Stretching = Literal["none", "vertical", "wheeler", "extrapolation"]
DRIFT_REFERENCE_FREQUENCY = 0.6  # rad/s at which `AbstractSea.drift` weighs a wave by one
DRIFT_ENTRIES = 4  # entries of `AbstractSea.drift` without a transfer function


class AbstractSea(eqx.Module):
    """Base class of all seas: water flow and surface elevation over time and position.

    Points are in earth axes. The origin is at still water level, on the vertical of the platform's reference position.
    """

    @abc.abstractmethod
    def flow(
        self,
        time: Float[Array, ""],
        points: Float[Array, "3 n"],
        cylinders: Cylinders | None = None,
        gradient: bool = False,
    ) -> Flow | None:
        """Water velocity, acceleration and pressure at points.

        Args:
            time: Time (s).
            points: Positions (m), (3, n).
            cylinders: Which points diffract the waves.
            gradient: Whether the slopes of the velocity are computed too (`Flow.gradient`).

        Returns:
            The flow; None: still water everywhere, at no cost.
        """

    @abc.abstractmethod
    def elevation(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> Float[Array, " n"] | None:
        """Surface elevation (m), (n,), at a time (s) and horizontal points (m), (2, n); None in still water."""

    def surface(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> Float[Array, " n"] | None:
        """Elevation (m), (n,), up to which the platform is wetted; None: still water level."""
        return self.elevation(time, points)

    def drift(self, time: Float[Array, ""]) -> Float[Array, " d"] | None:
        """Squared wave envelopes (m²) at the origin, for slow second-order forces; None: not known.

        With a the complex elevation of first-order waves, eta = Re a, the entries are:

        - the squared envelope |a|²;
        - its Hilbert transform, which turns cos into sin and a mean into 0;
        - Re(a_w conj(a)), a_w the waves weighted by (omega / `DRIFT_REFERENCE_FREQUENCY`)²;
        - the mean of |a|², Hs²/8.

        They contain difference frequencies only. A sea made with a platform's transfer function appends its six forces (N, N
        m) to these `DRIFT_ENTRIES` entries.
        """
        return None

    def excitation(self, time: Float[Array, ""], position: Float[Array, "2"]) -> Float[Array, " k"] | None:
        """First-order force of a table on a platform (N, N m, earth axes), (6,), or None.

        It is None for a sea made without a table. Of several tables, the forces are one after the other.

        Args:
            time: Time (s).
            position: Horizontal position of the platform (m), (2,).
        """
        return None

    def with_tables(self, exciting: AnyExcitation | None, transfer: AnyTransfer | None) -> "AbstractSea":
        """The sea with a platform's computed first-order and difference-frequency forces, by direct summation.

        A prepared sea was made with them, and is returned as it is; so is still water.
        """
        return self

    def direction(self) -> Float[Array, "2"]:
        """Unit vector that the waves travel along, weighted by energy (earth axes), (2,)."""
        raise NotImplementedError(f"{type(self).__name__} does not tell where its waves travel to")

    def moved(self, distance: Float[Array, ""]) -> "AbstractSea":
        """The sea shifted along its direction: what was at x is then at x + `distance` (m)."""
        raise NotImplementedError(f"{type(self).__name__} cannot be moved along its waves")


class StillWater(AbstractSea):
    """Still water: no waves and no current."""

    def flow(
        self,
        time: Float[Array, ""],
        points: Float[Array, "3 n"],
        cylinders: Cylinders | None = None,
        gradient: bool = False,
    ) -> None:
        return None

    def elevation(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> None:
        return None

    def moved(self, distance: Float[Array, ""]) -> "StillWater":
        return self


def direction(vector: Float[Array, "2 w"], energy: Float[Array, " w"]) -> Float[Array, "2"]:
    """Unit vector of the energy-weighted mean of wavenumber vectors; zero where there is none.

    Args:
        vector: Wavenumber vectors (rad/m), (2, w).
        energy: Weights, (w,).
    """
    mean = vector @ energy
    square = (mean**2).sum()
    return jnp.where(square > 0, mean / jnp.sqrt(jnp.where(square > 0, square, 1.0)), 0.0)


@jax.jit
def growth(time: Float[Array, "..."], ramp: Float[Array, ""] | float) -> Float[Array, "..."]:
    """Half cosine from 0 to 1 over the first `ramp` (s); 1 where `ramp` is 0."""
    duration = jnp.asarray(ramp)
    progress = jnp.clip(time / jnp.where(duration > 0, duration, 1.0), 0.0, 1.0)
    return jnp.where(duration > 0, 0.5 - 0.5 * jnp.cos(math.pi * progress), 1.0)


def stretched(
    sea: AbstractSea,
    stretching: Stretching,
    time: Float[Array, ""],
    points: Float[Array, "3 n"],
    depth: Float[Array, ""] | float,
) -> tuple[Float[Array, " n"], Float[Array, " n"] | None]:
    """Level at which profiles are read (m, at most 0), and height of extrapolation (m) or None."""
    z = points[2]
    if stretching == "wheeler" and (eta := sea.elevation(time, points[:2])) is not None:
        z = depth * (z - eta) / (depth + eta)
    above = jnp.maximum(z, 0.0) if stretching == "extrapolation" else None
    return jnp.clip(z, -depth, 0.0), above


def profiles(
    k: Float[Array, "w 1"], z: Float[Array, " n"], depth: Float[Array, ""] | float
) -> tuple[Float[Array, "w n"], Float[Array, "w n"]]:
    """cosh k(z+h) / cosh kh and sinh k(z+h) / cosh kh, without overflow, (w, n) each."""
    down, up = jnp.exp(k * z), jnp.exp(-k * (z + 2 * depth))
    scale = 1 / (1 + jnp.exp(-2 * k * depth))
    return (down + up) * scale, (down - up) * scale


def elevation_at_origin(sea: AbstractSea, times: ArrayLike) -> np.ndarray | None:
    """Surface elevation (m) at the reference position, (t,); None in still water.

    Args:
        sea: The sea.
        times: Times (s), (t,).
    """

    def at(time: Float[Array, ""]) -> Float[Array, ""] | None:
        elevation = sea.elevation(time, jnp.zeros((2, 1)))
        return None if elevation is None else elevation[0]

    elevation = jax.jit(jax.vmap(at))(on_device(np.asarray(times, float)))
    return None if elevation is None else np.asarray(elevation)
