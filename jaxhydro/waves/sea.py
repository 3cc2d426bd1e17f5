"""Seas: what gives the flow at any time and place. `AbstractSea.flow` is all that the simulator asks for."""

import abc
import math

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.environment import Environment
from jaxhydro.waves.dispersion import wavenumber
from jaxhydro.waves.flow import Flow


class AbstractSea(eqx.Module):
    """A sea. Points are in earth axes, the origin at still water level under or above the platform's rest position."""

    @abc.abstractmethod
    def flow(self, time: Float[Array, ""], points: Float[Array, "3 n"]) -> Flow | None:
        """Water at `points` (m) and `time` (s); None means still water everywhere, which costs nothing."""

    @abc.abstractmethod
    def elevation(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> Float[Array, " n"] | None:
        """Surface elevation (m) at horizontal `points` (m) and `time` (s), None in still water."""


class StillWater(AbstractSea):
    """No waves and no current."""

    def flow(self, time: Float[Array, ""], points: Float[Array, "3 n"]) -> None:
        return None

    def elevation(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> None:
        return None


class AirySea(AbstractSea):
    """First-order waves: eta = sum a cos(omega t - k (x cos heading + y sin heading) + phase).

    Airy theory in finite depth (Dean and Dalrymple 1991, chapters 3 and 4), u = a omega cosh k(z+h) / sinh kh, with p/rho = a g
    cosh k(z+h) / cosh kh. Kinematics are those at the point's own position; above still water they are those of z = 0.
    Waves grow from rest over the first `ramp` seconds by a half cosine (0: at full height from the start).
    """

    amplitude: Float[Array, " w"]  # m
    omega: Float[Array, " w"]  # rad/s
    wavenumber: Float[Array, " w"]  # rad/m
    heading: Float[Array, " w"]  # rad, where the waves travel to, from x towards y
    phase: Float[Array, " w"]  # rad
    environment: Environment
    ramp: Float[Array, ""] | float = 0.0

    def flow(self, time: Float[Array, ""], points: Float[Array, "3 n"]) -> Flow:
        depth = self.environment.depth
        k, omega = self.wavenumber[:, None], self.omega[:, None]
        along = jnp.stack([jnp.cos(self.heading), jnp.sin(self.heading)], axis=1)
        z = jnp.clip(points[2], -depth, 0.0)
        angle = omega * time - self.wavenumber[:, None] * (along @ points[:2]) + self.phase[:, None]
        amplitude = (self.amplitude * self.growth(time))[:, None]
        cos, sin = amplitude * jnp.cos(angle), amplitude * jnp.sin(angle)
        # cosh k(z+h) / cosh kh and sinh k(z+h) / cosh kh without overflow
        down, up = jnp.exp(k * z), jnp.exp(-k * (z + 2 * depth))
        scale = 1 / (1 + jnp.exp(-2 * k * depth))
        c, s = (down + up) * scale, (down - up) * scale
        gk = self.environment.gravity * k / omega  # = omega / tanh kh
        u, w = gk * c * cos, -gk * s * sin
        au, aw = -omega * gk * c * sin, -omega * gk * s * cos
        velocity = jnp.concatenate([along.T @ u, w.sum(axis=0)[None]])
        acceleration = jnp.concatenate([along.T @ au, aw.sum(axis=0)[None]])
        return Flow(velocity, acceleration, self.environment.gravity * (c * cos).sum(axis=0))

    def elevation(self, time: Float[Array, ""], points: Float[Array, "2 n"]) -> Float[Array, " n"]:
        along = jnp.stack([jnp.cos(self.heading), jnp.sin(self.heading)], axis=1)
        angle = self.omega[:, None] * time - self.wavenumber[:, None] * (along @ points) + self.phase[:, None]
        return self.growth(time) * (self.amplitude @ jnp.cos(angle))

    def growth(self, time: Float[Array, "..."]) -> Float[Array, "..."]:
        duration = jnp.asarray(self.ramp)
        progress = jnp.clip(time / jnp.where(duration > 0, duration, 1.0), 0.0, 1.0)
        return jnp.where(duration > 0, 0.5 - 0.5 * jnp.cos(math.pi * progress), 1.0)


def regular_wave(
    height: float,
    period: float,
    environment: Environment,
    *,
    heading: float = 0.0,
    phase: float = 0.0,
    ramp: float = 0.0,
) -> AirySea:
    """A regular wave of first order: height (m, crest to trough), period (s), heading and phase (rad), ramp (s).

    Raises ValueError for a period or height out of range, or a wave steeper than breaking (Miche 1944: H k / (2 tanh kh) <=
    0.142 pi).
    """
    if not (period > 0 and height >= 0):
        raise ValueError(f"a regular wave needs period > 0 s and height >= 0 m, found {period} s and {height} m")
    omega = jnp.asarray([2 * math.pi / period])
    k = wavenumber(omega, jnp.asarray(environment.depth), jnp.asarray(environment.gravity))
    limit = 0.142 * 2 * math.pi / float(k[0]) * math.tanh(float(k[0]) * float(environment.depth))
    if height > limit:
        raise ValueError(f"a wave of period {period:g} s breaks above a height of {limit:.3g} m, found {height:g} m")
    one = jnp.ones(1)
    return AirySea(0.5 * height * one, omega, k, heading * one, phase * one, environment, ramp)
