"""Directional distributions from the first two Fourier coefficients that a buoy measures."""

import numpy as np
from jaxtyping import Complex, Float
from scipy.optimize import minimize
from scipy.special import logsumexp

MAX_RESULTANT = 0.99  # size of the first coefficient that is kept: beyond it is one direction
MAX_SECOND = 0.95  # share of what the first coefficient leaves for the second: beyond it is noise
TOLERANCE = 1e-8  # of the coefficients


def maximum_entropy(first: Complex[np.ndarray, " n"], second: Complex[np.ndarray, " n"], bins: int) -> Float[np.ndarray, "n d"]:
    """Directional distribution D of greatest entropy with given Fourier coefficients.

    D = exp(l0 + l1 cos a + l2 sin a + l3 cos 2a + l4 sin 2a), constant over each bin. It is nowhere negative, and it does not
    split one wave system into two. A second coefficient that no distribution with the first one has, as noise gives, is
    moved towards c1².

    Args:
        first: Coefficient c1, the mean of exp(i a) over D, (n,).
        second: Coefficient c2, the mean of exp(2 i a) over D, (n,).
        bins: Number d of bins over the circle; the first has its middle at 0.

    Returns:
        D (1/rad), (n, d). Its sum times 2 pi / d is 1.

    References:
        K. Kobune and N. Hashimoto (1986), Estimation of directional spectra from the maximum entropy principle, OMAE.
    """
    width = 2 * np.pi / bins
    angle = np.arange(bins) * width
    c1 = first * np.minimum(1.0, MAX_RESULTANT / np.maximum(np.abs(first), 1e-300))
    off, limit = second - c1**2, MAX_SECOND * (1 - np.abs(c1) ** 2)
    c2 = c1**2 + off * np.minimum(1.0, limit / np.maximum(np.abs(off), 1e-300))
    basis = np.stack([np.cos(angle), np.sin(angle), np.cos(2 * angle), np.sin(2 * angle)])
    within1, within2 = np.sinc(width / (2 * np.pi)), np.sinc(width / np.pi)  # of exp(i a), exp(2 i a) over a bin
    targets = np.stack([c1.real / within1, c1.imag / within1, c2.real / within2, c2.imag / within2], axis=1)
    return np.stack([_shares(basis, target) for target in targets]) / width


def _shares(basis: Float[np.ndarray, "4 d"], target: Float[np.ndarray, "4"]) -> Float[np.ndarray, " d"]:
    """Shares of the bins, with sum 1, whose means of the basis are the target: the dual problem, which is convex."""

    def shares(x: np.ndarray) -> np.ndarray:
        return np.exp(x @ basis - logsumexp(x @ basis))

    def curvature(x: np.ndarray) -> np.ndarray:
        share = shares(x)
        centred = basis - (basis @ share)[:, None]
        return (centred * share) @ centred.T

    solution = minimize(
        lambda x: logsumexp(x @ basis) - x @ target,
        np.zeros(4),
        jac=lambda x: basis @ shares(x) - target,
        hess=curvature,
        method="trust-exact",
        options={"gtol": TOLERANCE},
    )
    return shares(solution.x)
