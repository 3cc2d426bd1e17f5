"""Algebra of information matrices: elimination, principal directions, collinearity."""

import numpy as np

MIN_VARIANCE = 1e-20  # m2, rad2: a record made without noise is not known to better than a sensor's last digit

IDENTIFIABLE_DEVIATION = 0.25  # a coordinate known to better than this (25 % of a positive parameter) is identifiable

# eigenvalues of scaled matrices, over the largest, that are rounding
ROUNDING = 1e-13
WEAK_PRIOR_ROUNDING = 1e-14  # of all unknowns with their priors: a weak prior that is all there is of a coordinate is more


def shared_information(
    products: np.ndarray, weight: np.ndarray, variance: np.ndarray, inflation: np.ndarray, shared: int
) -> np.ndarray:
    """Information (p, p) of the shared coordinates, with the records' own unknowns eliminated.

    Each record's unknowns are eliminated by a Schur complement. The information is H S^-1 H, the inverse of the sandwich of
    `sandwich_covariance` without the prior. It is J^T J / sigma^2 where every record was weighed by its noise.

    Args:
        products: Products [J r]^T [J r] by record and channel, (r, c, k, k).
        weight: As in `sandwich_covariance`, (r, c).
        variance: As in `sandwich_covariance`, (r, c).
        inflation: As in `sandwich_covariance`, (r, c).
        shared: Number p of shared coordinates.

    References:
        Godambe 1960, Annals of Mathematical Statistics 31, 1208-1211.
    """
    hessian, scatter = np.zeros((shared, shared)), np.zeros((shared, shared))
    power = weight**2 * np.maximum(variance, MIN_VARIANCE) * inflation
    for block, w, s in zip(products[..., :-1, :-1], weight, power, strict=True):
        bread, meat = np.einsum("ckl,c->kl", block, w), np.einsum("ckl,c->kl", block, s)
        # the shared unknowns, with the record's own at their best for each
        follow = np.concatenate([np.eye(shared), -pseudo_inverse(bread[shared:, shared:]) @ bread[shared:, :shared]])
        hessian += follow.T @ bread @ follow
        scatter += follow.T @ meat @ follow
    return hessian @ pseudo_inverse(scatter) @ hessian


def principal_directions(information: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Standard deviations along the principal directions, ascending, and these as columns."""
    values, axes = np.linalg.eigh(information)
    return deviations_of(values[::-1], values.max(initial=0.0)), axes[:, ::-1]


def collinearity(information: np.ndarray) -> float:
    """Collinearity index of parameters: 1 for orthogonal columns, inf for dependent ones.

    gamma = 1 / sqrt(lambda_min of the information scaled to a unit diagonal).

    References:
        Brun, Reichert and Kuensch 2001, Water Resources Research 37, 1015-1030.
    """
    scale = np.sqrt(np.diag(information))
    least = np.linalg.eigvalsh(information / np.outer(scale, scale))[0]
    return float(1 / np.sqrt(least)) if least > 1e-14 else np.inf


def submatrix(matrix: np.ndarray, keep: list[int]) -> np.ndarray:
    """The matrix with all rows and columns zero but those in `keep`."""
    mask = np.isin(np.arange(len(matrix)), list(keep))
    return np.where(np.outer(mask, mask), matrix, 0.0)


def pseudo_inverse(matrix: np.ndarray, rcond: float = ROUNDING) -> np.ndarray:
    """Pseudo-inverse of a positive semi-definite matrix, whatever the units of its rows.

    The matrix is scaled to a unit diagonal. Eigenvalues of no more than `rcond` of the largest are taken for rounding. Rows
    with a zero diagonal stay zero.
    """
    d = np.diag(matrix)
    scale = np.where(d > 0, 1 / np.sqrt(np.where(d > 0, d, 1.0)), 0.0)
    both = np.outer(scale, scale)
    return np.linalg.pinv(matrix * both, rcond=rcond, hermitian=True) * both


def deviations_of(values: np.ndarray, largest: float) -> np.ndarray:
    """Standard deviations 1 / sqrt(information); inf where the information is no more than rounding."""
    significant = values > 16 * np.finfo(float).eps * len(values) * largest
    return np.where(significant, 1 / np.sqrt(np.where(significant, values, 1.0)), np.inf)


def varimax(axes: np.ndarray) -> np.ndarray:
    """Orthonormal basis (p, k) of the same space with the largest variance of squared entries.

    It is found by fixed-point steps. With columns of unit length that is the largest sum of fourth powers, a convex function:
    no step makes it smaller.
    """
    size = axes.shape[1]
    if size < 2:
        return axes
    # a start without symmetry: an even mixture of two sparse directions is a stationary point
    turn = np.linalg.qr(np.random.default_rng(0).standard_normal((size, size)))[0]
    for _ in range(200):
        u, _, v = np.linalg.svd(axes.T @ (axes @ turn) ** 3)
        turn = u @ v
    return axes @ turn
