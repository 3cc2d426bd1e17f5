"""Transforms between a parameter's value and its unbounded coordinate."""

import abc
import math

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

EDGE_SHARE = 0.005  # a value nearer than this share of its range to a bound is taken from there: beyond, the map is flat
Scalar = Float[Array, ""]


class AbstractTransform(eqx.Module):
    """value = forward(x), x any real number; a unit step of x is a step that matters."""

    @abc.abstractmethod
    def forward(self, x: Scalar) -> Scalar:
        """The value at a coordinate."""

    @abc.abstractmethod
    def inverse(self, value: float) -> float:
        """The coordinate of a value, or of the nearest value inside the range."""

    @abc.abstractmethod
    def at_bound(self, x: float) -> bool:
        """Whether the value is against a bound, to one hundredth of the range."""


class LogInterval(AbstractTransform):
    """A positive value between bounds, on a logarithmic scale.

    value = lower (upper/lower)^s(x), with s the logistic function. It is scaled so that dx is d ln(value) in the middle of the
    range.
    """

    lower: float
    upper: float

    @property
    def span(self) -> float:
        return math.log(self.upper / self.lower)

    def forward(self, x: Scalar) -> Scalar:
        return self.lower * jnp.exp(self.span * jax.nn.sigmoid(4 * x / self.span))

    def inverse(self, value: float) -> float:
        share = math.log(max(value, 1e-300) / self.lower) / self.span
        share = min(max(share, EDGE_SHARE), 1 - EDGE_SHARE)
        return 0.25 * self.span * math.log(share / (1 - share))

    def at_bound(self, x: float) -> bool:
        share = 1 / (1 + math.exp(-4 * float(x) / self.span))
        return not 0.01 < share < 0.99


class Interval(AbstractTransform):
    """A value between bounds, of either sign.

    value = lower + (upper - lower) s(x), with s the logistic function.
    """

    lower: float
    upper: float

    def forward(self, x: Scalar) -> Scalar:
        return self.lower + (self.upper - self.lower) * jax.nn.sigmoid(x)

    def inverse(self, value: float) -> float:
        share = min(max((value - self.lower) / (self.upper - self.lower), EDGE_SHARE), 1 - EDGE_SHARE)
        return math.log(share / (1 - share))

    def at_bound(self, x: float) -> bool:
        return not 0.01 < 1 / (1 + math.exp(-float(x))) < 0.99


class Scaled(AbstractTransform):
    """Any value, in units of a scale about a centre."""

    centre: float
    scale: float

    def forward(self, x: Scalar) -> Scalar:
        return self.centre + self.scale * x

    def inverse(self, value: float) -> float:
        return (value - self.centre) / self.scale

    def at_bound(self, x: float) -> bool:
        return False
