"""Cost, gradient and Gauss-Newton matrix of a fit, with each record's own unknowns eliminated."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import lineax as lx
import numpy as np
import optimistix as optx
from jax.flatten_util import ravel_pytree
from jaxtyping import Array, Float

from calibration.residuals.abstract_residual import AbstractResidual, Unknowns

OWN_ROUNDING = 1e-12  # of a diagonal entry, added to it: own unknowns of a channel without samples stay where they are


class ArrowMatrix(lx.AbstractLinearOperator):
    """Symmetric matrix of the shared unknowns and of each record's own unknowns.

    Its arrays are JAX's or NumPy's; `eliminated` keeps to them.

    Attributes:
        shared: Block of the shared unknowns (p, p).
        cross: Blocks between the shared and each record's own unknowns (r, p, o).
        own: Blocks of each record's own unknowns (r, o, o).
    """

    shared: Float[Any, "p p"]
    cross: Float[Any, "r p o"]
    own: Float[Any, "r o o"]

    def mv(self, vector: Unknowns) -> Unknowns:
        shared = self.shared @ vector.shared + jnp.einsum("rpo,ro->p", self.cross, vector.own)
        return Unknowns(shared, vector.shared @ self.cross + jnp.einsum("rok,rk->ro", self.own, vector.own))

    def as_matrix(self) -> Float[Any, "n n"]:
        zero, back = ravel_pytree(jax.tree.map(lambda leaf: jnp.zeros(leaf.shape), self.in_structure()))
        return jax.vmap(lambda row: ravel_pytree(self.mv(back(row)))[0])(jnp.eye(zero.size))

    def transpose(self) -> "ArrowMatrix":
        return self

    def in_structure(self) -> Unknowns:
        sizes = (self.shared.shape[:1], self.cross.shape[::2])
        return Unknowns(*(jax.ShapeDtypeStruct(size, self.shared.dtype) for size in sizes))  # type: ignore[arg-type]

    def out_structure(self) -> Unknowns:
        return self.in_structure()

    def eliminated(
        self, vector: Unknowns, ridge: Float[Any, "r o"], counted: Float[Any, " r"] | None = None
    ) -> tuple[Float[Any, "p p"], Float[Any, " p"], Float[Any, "r o p+1"]]:
        """Equations A z = vector of the shared unknowns alone, by the Schur complement of the own blocks.

        Args:
            vector: Right-hand side.
            ridge: What is added to the diagonals of the own blocks.
            counted: 1 for records that take part, 0 for those that only follow; None for all.

        Returns:
            Matrix and right-hand side of the shared unknowns, and for each record f, with own = f (-shared, 1).
        """
        xp = np if isinstance(self.own, np.ndarray) else jnp
        cross = self.cross if counted is None else self.cross * counted[:, None, None]
        columns = xp.concatenate([xp.swapaxes(self.cross, 1, 2), vector.own[..., None]], axis=-1)
        follow = xp.linalg.solve(self.own + xp.eye(self.own.shape[-1]) * ridge[..., None], columns)
        matrix = self.shared - xp.einsum("rpo,roq->pq", cross, follow[..., :-1])
        return matrix, vector.shared - xp.einsum("rpo,ro->p", cross, follow[..., -1]), follow

    def solve(self, vector: Unknowns, damping: Float[Any, ""] | float = 0.0) -> Unknowns:
        """(A + damping I)^-1 vector."""
        size = jnp.diagonal(self.own, axis1=1, axis2=2)
        ridge = damping + jnp.where(size > 0, OWN_ROUNDING * size, 1.0)
        matrix, right, follow = self.eliminated(vector, ridge)
        shared = jnp.linalg.solve(matrix + damping * jnp.eye(len(right)), right)
        return Unknowns(shared, own_of(follow, shared))


def own_of(follow: Float[Any, "r o p+1"], shared: Float[Any, " p"]) -> Float[Any, "r o"]:
    """The records' own unknowns that go with shared ones; `follow` is of `ArrowMatrix.eliminated`."""
    return follow[..., -1] - follow[..., :-1] @ shared


@lx.is_symmetric.register(ArrowMatrix)
def _(operator: ArrowMatrix) -> bool:
    return True


class LeastSquares(NamedTuple):
    """Objective of a fit: half the weighted squares of the residuals, and of the priors.

    Attributes:
        residuals: Residuals of some kinds; one of them at most has own unknowns.
        weights: Weights of the squares, by record and group (r, g), for each of `residuals`.
        mean: Means of the shared unknowns' priors (p,).
        ridge: Square roots of the priors' weights (p,).
    """

    residuals: tuple[AbstractResidual, ...]
    weights: tuple[Float[Array, "r g"], ...]
    mean: Float[Array, " p"]
    ridge: Float[Array, " p"]


Products = tuple[Float[Array, "r g k k"], ...]


def normal_equations(unknowns: Unknowns, fit: LeastSquares) -> tuple[Any, Products]:
    """Cost, gradient and Gauss-Newton matrix, and the products that they are made of.

    Returns:
        optimistix's `FunctionInfo.EvalGradHessian`, with an `ArrowMatrix`, and the products of each kind of residual.
    """
    p, (records, size) = len(unknowns.shared), unknowns.own.shape
    off = fit.ridge * (unknowns.shared - fit.mean)
    cost, gradient = 0.5 * jnp.sum(off**2), Unknowns(fit.ridge * off, jnp.zeros((records, size)))
    matrix = ArrowMatrix(jnp.diag(fit.ridge**2), jnp.zeros((records, p, size)), jnp.zeros((records, size, size)))
    products = tuple(residual.products(unknowns) for residual in fit.residuals)
    for part, weight in zip(products, fit.weights, strict=True):
        block = jnp.einsum("rgkl,rg->rkl", part, weight)
        cost += 0.5 * block[:, -1, -1].sum()
        gradient = gradient._replace(shared=gradient.shared + block[:, :p, -1].sum(axis=0))
        shared = matrix.shared + block[:, :p, :p].sum(axis=0)
        matrix = ArrowMatrix(shared, matrix.cross, matrix.own)
        if block.shape[-1] > p + 1:
            gradient = gradient._replace(own=gradient.own + block[:, p:-1, -1])
            matrix = ArrowMatrix(shared, matrix.cross + block[:, :p, p:-1], matrix.own + block[:, p:-1, p:-1])
    return optx.FunctionInfo.EvalGradHessian(cost, gradient, matrix), products


def cost_of(products: Sequence[np.ndarray], weights: Sequence[np.ndarray]) -> float:
    """Weighted sum of squares of the residuals, from their products."""
    return float(sum(np.sum(part[..., -1, -1] * weight) for part, weight in zip(products, weights, strict=True)))


def clipped(step: Unknowns, longest: float) -> Unknowns:
    """Step scaled to at most `longest` in its largest component, its direction unchanged."""
    largest = jnp.max(jnp.stack([jnp.max(jnp.abs(leaf), initial=0.0) for leaf in step]))
    return jax.tree.map(lambda leaf: jnp.minimum(1.0, longest / jnp.maximum(largest, 1e-300)) * leaf, step)
