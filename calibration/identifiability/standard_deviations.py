"""Standard deviations of the parameters: sandwich covariance from the Jacobian."""

from typing import NamedTuple

import numpy as np

from calibration.identifiability.information import WEAK_PRIOR_ROUNDING, pseudo_inverse

# products, weight, variance, inflation: see `sandwich_covariance`
WeightedProducts = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


class Spread(NamedTuple):
    """Covariance of the coordinates of all unknowns: the shared parameters first, then every record's own."""

    covariance: np.ndarray
    shared: int

    def deviation(self) -> np.ndarray:
        """Standard deviations of the shared coordinates."""
        return np.sqrt(np.diag(self.covariance)[: self.shared])

    def correlation(self) -> np.ndarray:
        """Correlation matrix of the shared coordinates."""
        d = self.deviation()
        return self.covariance[: self.shared, : self.shared] / np.outer(d, d)


def gauss_newton_matrix(products: np.ndarray, shared: int) -> np.ndarray:
    """Gauss-Newton matrix of all unknowns, from the products of each record.

    Args:
        products: Products by record (r, k, k), whose last row and column are the residual's.
        shared: Number of shared unknowns, which come first.
    """
    records, size = products.shape[0], products.shape[1] - 1
    own_count = size - shared
    total = np.zeros((shared + records * own_count,) * 2)
    for i, block in enumerate(products[:, :-1, :-1]):
        own_rows = slice(shared + i * own_count, shared + (i + 1) * own_count)
        total[:shared, :shared] += block[:shared, :shared]
        total[:shared, own_rows] += block[:shared, shared:]
        total[own_rows, :shared] += block[shared:, :shared]
        total[own_rows, own_rows] += block[shared:, shared:]
    return total


def correlated_samples(residual: np.ndarray) -> float:
    """Integrated autocorrelation of a residual, at least 1: number of samples that count as one.

    Initial positive sequence of paired autocorrelations (Geyer 1992, Statistical Science 7, 473-483, section 3.3).
    """
    x = residual - residual.mean()
    n = len(x)
    if n < 8 or not np.any(x):
        return 1.0
    spectrum = np.abs(np.fft.rfft(x, 2 * n)) ** 2
    rho = np.fft.irfft(spectrum)[:n]
    rho = rho / rho[0]
    pairs = rho[0 : n - n % 2 : 2] + rho[1 : n - n % 2 + 1 : 2]
    stop = np.argmax(pairs <= 0) if (pairs <= 0).any() else len(pairs)
    return float(max(1.0, 2 * pairs[:stop].sum() - 1))


def sandwich_covariance(
    products: np.ndarray,
    weight: np.ndarray,
    variance: np.ndarray,
    inflation: np.ndarray,
    ridge: np.ndarray,
    width: np.ndarray,
) -> Spread:
    """Covariance of the estimates by the sandwich H^-1 S H^-1.

    Args:
        products: Products [J r]^T [J r] by record and channel, (r, c, k, k).
        weight: Weights of the squared residuals in the fit, (r, c).
        variance: Variances of the residuals, (r, c).
        inflation: Number of correlated samples that count as one, (r, c).
        ridge: Square roots of the priors' weights in the fit, (p,).
        width: Standard deviations of the priors, (p,). A parameter that no record touches is reported with this.

    References:
        White 1982, Econometrica 50, 1-25, theorem 3.2.
    """
    shared = len(ridge)
    hessian = gauss_newton_matrix(np.einsum("rckl,rc->rkl", products, weight), shared)
    scatter = gauss_newton_matrix(np.einsum("rckl,rc->rkl", products, weight**2 * variance * inflation), shared)
    zeros = np.zeros(len(hessian) - shared)
    square, wide = np.concatenate([ridge**2, zeros]), np.concatenate([width**2, zeros])
    bread = pseudo_inverse(hessian + np.diag(square), WEAK_PRIOR_ROUNDING)
    return Spread(bread @ (scatter + np.diag(wide * square**2)) @ bread, shared)
