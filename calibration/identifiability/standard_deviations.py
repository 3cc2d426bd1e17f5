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
    """Gauss-Newton matrix of all unknowns from the records' own (record, k, k), whose last row and column are the residual."""
    records, size = products.shape[0], products.shape[1] - 1
    own = size - shared
    total = np.zeros((shared + records * own,) * 2)
    for i, block in enumerate(products[:, :-1, :-1]):
        mine = slice(shared + i * own, shared + (i + 1) * own)
        total[:shared, :shared] += block[:shared, :shared]
        total[:shared, mine] += block[:shared, shared:]
        total[mine, :shared] += block[shared:, :shared]
        total[mine, mine] += block[shared:, shared:]
    return total


def correlated_samples(residual: np.ndarray) -> float:
    """Integrated autocorrelation of a residual: how many samples count as one. At least 1.

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
    """Covariance of the estimates by the sandwich H^-1 S H^-1 (White 1982, Econometrica 50, 1-25, theorem 3.2).

    `products` (record, channel, k, k) are the [J r]^T [J r], `weight` what multiplied their squares in the fit, `variance`
    that of the residuals, `inflation` how many of their samples count as one. `ridge` is the prior's row in the fit, `width`
    its standard deviation: a parameter that no record touches is reported with that.
    """
    shared = len(ridge)
    hessian = gauss_newton_matrix(np.einsum("rckl,rc->rkl", products, weight), shared)
    scatter = gauss_newton_matrix(np.einsum("rckl,rc->rkl", products, weight**2 * variance * inflation), shared)
    own = np.zeros(len(hessian) - shared)
    square, wide = np.concatenate([ridge**2, own]), np.concatenate([width**2, own])
    bread = pseudo_inverse(hessian + np.diag(square), WEAK_PRIOR_ROUNDING)
    return Spread(bread @ (scatter + np.diag(wide * square**2)) @ bread, shared)
