"""Minimum of a quadratic form within bounds."""

import numpy as np
import scipy  # its parts are imported when they are used: that takes a second

RIDGE = 1e-12  # of the diagonal: dependent columns stay solvable
MAX_BOUND_EXCHANGES = 12  # where the bounds that hold do not settle, they are exchanged one by one


def bounded_minimum(matrix: np.ndarray, slope: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Minimum of x^T matrix x / 2 + slope^T x within bounds."""
    scale = 1 / np.sqrt(np.diag(matrix))
    both = matrix * np.outer(scale, scale)
    both[np.diag_indices_from(both)] += RIDGE
    step = -scale * np.linalg.solve(both, scale * slope)
    if (step >= low).all() and (step <= high).all():
        return step
    active = active_set(both, scale * slope, low / scale, high / scale)
    if active is not None:
        at_bound, step = active
        return np.where(at_bound > 0, high, np.where(at_bound < 0, low, np.clip(scale * step, low, high)))
    size, directions = np.linalg.eigh(both)
    roots = np.sqrt(np.maximum(size, RIDGE * size[-1]))  # rounding makes eigenvalues of dependent columns negative
    root = roots[:, None] * directions.T
    target = -(directions.T @ (scale * slope)) / roots
    solution = scipy.optimize.lsq_linear(root, target, (low / scale, high / scale), method="bvls", tol=1e-12)
    inside = np.clip(scale * solution.x, low, high)
    return np.where(solution.active_mask > 0, high, np.where(solution.active_mask < 0, low, inside))


def active_set(
    matrix: np.ndarray, slope: np.ndarray, low: np.ndarray, high: np.ndarray
) -> tuple[np.ndarray, np.ndarray] | None:
    """Bounds that hold at the minimum of x^T matrix x / 2 + slope^T x, all exchanged at a time.

    Args:
        matrix: Positive definite matrix (m, m).
        slope: Slope at zero (m,).
        low: Lower bounds (m,).
        high: Upper bounds (m,).

    Returns:
        By column -1 at the lower bound, 1 at the upper one and 0 elsewhere (m,), and the minimum (m,). None where the exchange
        does not settle.

    References:
        Judice and Pires 1994, Computers and Operations Research 21, 587-596: block principal pivoting.
    """
    at_bound = np.zeros(len(slope), int)
    for _ in range(MAX_BOUND_EXCHANGES):
        free, held = at_bound == 0, at_bound != 0
        x = np.where(at_bound < 0, low, high)
        x[free] = -np.linalg.solve(matrix[np.ix_(free, free)], slope[free] + matrix[np.ix_(free, held)] @ x[held])
        gradient = matrix @ x + slope
        wanted = np.where(free, (x > high).astype(int) - (x < low), np.where(at_bound * gradient <= 0, at_bound, 0))
        if (wanted == at_bound).all():
            return at_bound, x
        at_bound = wanted
    return None
