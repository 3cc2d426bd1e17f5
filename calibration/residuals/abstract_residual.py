"""Contract of residuals: unknowns in, products of residuals and slopes out.

Least squares needs only [J r]^T [J r] of a residual r with slopes J. A record of thousands of samples becomes one small matrix.
A fit is any set of residuals, their weights, and priors (`calibration.fitting`).
"""

import abc
from collections.abc import Callable
from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from calibration.parameters.space import ParameterSpace
from jaxhydro.dynamics.model import Model


class Unknowns(NamedTuple):
    """Coordinates of all unknowns of a fit.

    Attributes:
        shared: (p,) coordinates of the parameters.
        own: (r, o) those that each record has to itself, such as position, rate and offset of every channel.
    """

    shared: Float[Array, " p"]
    own: Float[Array, "r o"]


def parameters_only(x: Float[Array, " p"]) -> Unknowns:
    """Unknowns of residuals that depend on the parameters alone."""
    return Unknowns(x, jnp.zeros((0, 0)))


class AbstractResidual(eqx.Module):
    """Residuals of one kind of measurement against a model with free parameters.

    Attributes:
        model: The model at the start of the fit.
        space: The free parameters.
    """

    model: eqx.AbstractVar[Model]
    space: eqx.AbstractVar[ParameterSpace]

    @abc.abstractmethod
    def products(self, unknowns: Unknowns) -> Float[Array, "r g k k"]:
        """Products [J r]^T [J r] by record and group, of k - 1 unknowns and the residual.

        The unknowns are the shared ones, then the record's own. Residuals without own unknowns are one record.
        """


class AbstractGroupedResidual(AbstractResidual):
    """Residuals that depend on the parameters alone, in groups.

    Attributes:
        tail: (g,) residuals beyond which `cauchy_residual` is used; None: squares everywhere.
    """

    tail: eqx.AbstractVar[Float[Array, " g"] | None]

    @abc.abstractmethod
    def residuals(self, x: Float[Array, " p"]) -> tuple[Float[Array, " _"], ...]:
        """Residuals by group."""

    def products(self, unknowns: Unknowns) -> Float[Array, "1 g k k"]:
        """Products [J r]^T [J r] of every group."""
        return group_products(self.residuals, unknowns.shared, self.tail)[None]


def cauchy_residual(r: Float[Array, "..."], tail: Float[Array, "..."] | None) -> Float[Array, "..."]:
    """The residual whose square is Cauchy's loss c^2 ln(1 + (r/c)^2), c the `tail`; r itself without one.

    References:
        Holland and Welsch 1977, Communications in Statistics A6, 813-827, table 1.
    """
    if tail is None:
        return r
    square = (r / tail) ** 2
    small = square < 1e-6  # the series there: log1p(u) / u is 0 / 0 at rest
    safe = jnp.where(small, 1.0, square)
    return r * jnp.where(small, 1 - 0.25 * square, jnp.sqrt(jnp.log1p(safe) / safe))


def group_products(
    residuals: Callable[[Float[Array, " p"]], tuple[Float[Array, " _"], ...]],
    x: Float[Array, " p"],
    tails: Float[Array, " g"] | None,
) -> Float[Array, "g k k"]:
    """Products [J r]^T [J r] of every group of residuals; k is the number of parameters plus one.

    Args:
        residuals: Function from coordinates (p,) to residuals by group.
        x: Coordinates of the parameters (p,).
        tails: Residuals beyond which `cauchy_residual` is used (g,); None: squares everywhere.
    """

    def both(x):
        groups = residuals(x)
        limits = [None] * len(groups) if tails is None else tails
        values = tuple(cauchy_residual(r, tail) for r, tail in zip(groups, limits, strict=True))
        return values, values

    slopes, values = jax.jacfwd(both, has_aux=True)(x)
    full = [jnp.concatenate([slope, r[:, None]], axis=1) for slope, r in zip(slopes, values, strict=True)]
    return jnp.stack([matrix.T @ matrix for matrix in full])
