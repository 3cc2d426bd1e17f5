"""Fits along a few parameters: the likelihood of residuals whose spectrum is not known, minimised by Levenberg-Marquardt.

-2 ln L = sum over motions and bands of n ln(mean square), n the band's degrees of freedom (Whittle 1953, Arkiv for Matematik 2,
423-434, with a spectrum that is constant over a band and estimated; noise is its least value), and the priors' squares. A fit
minimises n (m^p - 1) / p of the mean square m over the noise's in place of n ln m (Box and Cox 1964, Journal of the Royal
Statistical Society B 26, 211-252): near the noise the same, but a record that is not followed is not given up for others.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from calibration.discovery.study import Look, Place, Prior, Seen, Study

POWER = 0.2  # p: 0 is the logarithm
FLOOR = 1.0  # mean square over the noise's below which nothing is gained
LONGEST = 0.7  # largest step of a coordinate that is a logarithm


class Reached(NamedTuple):
    """Where a fit is: what was seen there, its cost, and the normal equations."""

    look: Look
    cost: float
    iterations: int
    settled: bool


def cost_of(study: Study, look: Look, used: np.ndarray, prior: Prior, share: np.ndarray | None = None) -> float:
    """What is minimised, of the `used` series and the priors."""
    mean_square, dof = study.mean_squares(look, share)
    value = float((used[:, None] * dof * (np.maximum(mean_square, FLOOR) ** POWER - 1)).sum()) / POWER
    at = list(look.active)
    value += float((((study.steps(look.place.x) - prior.mean) / prior.width)[at] ** 2).sum())
    return value + float(((look.place.own / study.own_width) ** 2).sum()) if look.place.own.size else value


class Normal(NamedTuple):
    """Gauss-Newton matrix and gradient of the parameters, and by decay the block of its own unknowns, the cross block and their
    gradient."""

    matrix: np.ndarray
    slope: np.ndarray
    inner: list[tuple[np.ndarray, np.ndarray, np.ndarray]]


def normal(study: Study, look: Look, used: np.ndarray, prior: Prior, share: np.ndarray | None = None) -> Normal:
    """Gauss-Newton matrix and gradient with the decays' own unknowns eliminated, and what gives those back."""
    mean_square, dof = study.mean_squares(look, share)
    noise = np.array([one.noise for one in study.series])[:, None]
    weight = used[:, None] * np.maximum(mean_square, FLOOR) ** (POWER - 1) / noise**2 * (dof > 0)
    q, at = len(look.active), 0
    active = list(look.active)
    width = prior.width[active]
    matrix = np.diag(1 / width**2)
    slope = (study.steps(look.place.x) - prior.mean)[active] / width**2
    inner = []
    if look.decays.size:
        r, c, b = look.decays.shape[:3]
        w = weight[: r * c].reshape(r, c, b)
        at = r * c
        summed = np.einsum("rcb,rcbkl->rkl", w, look.decays)
        for i, one in enumerate(summed):
            own = one[q:-1, q:-1] + np.diag(1 / study.own_width[i] ** 2)
            right = one[q:-1, -1] + look.place.own[i] / study.own_width[i] ** 2
            inner.append((own, one[q:-1, :q], right))
            matrix += one[:q, :q]
            slope = slope + one[:q, -1]
    for products in look.seas:
        n = products.shape[0] * products.shape[1]
        w = weight[at : at + n].reshape(products.shape[:3])
        at += n
        one = np.einsum("wcb,wcbkl->kl", w, products)
        matrix += one[:q, :q]
        slope = slope + one[:q, -1]
    return Normal(matrix, slope, inner)


def solve(equations: Normal, damping: float) -> tuple[np.ndarray, np.ndarray]:
    """A damped step of the parameters and of every decay's own unknowns (arrow-shaped equations, by Schur complements)."""
    matrix, slope, inner = equations
    reduced, right = matrix + damping * np.diag(np.diag(matrix)), slope.copy()
    kept = []
    for own, cross, force in inner:
        scaled = own + damping * np.diag(np.diag(own)) + 1e-12 * np.eye(len(own)) * np.trace(own) / len(own)
        back = np.linalg.solve(scaled, np.column_stack([cross, force]))
        reduced = reduced - cross.T @ back[:, :-1]
        right = right - cross.T @ back[:, -1]
        kept.append(back)
    scale = 1 / np.sqrt(np.maximum(np.diag(reduced), 1e-300))
    step = -scale * np.linalg.lstsq(reduced * np.outer(scale, scale), scale * right, rcond=1e-12)[0]
    own = np.array([-(back[:, -1] + back[:, :-1] @ step) for back in kept])
    return step, own


def fit(
    study: Study,
    place: Place,
    active: Sequence[int],
    used: np.ndarray,
    prior: Prior,
    *,
    until: np.ndarray | None = None,
    share: np.ndarray | None = None,
    iterations: int = 12,
    tolerance: float = 0.5,
    seas: Seen = "fit",
    say: Callable[[int, float], None] = lambda *_: None,
    first: Look | None = None,
) -> Reached:
    """Levenberg-Marquardt from a place along the active parameters, until one gains less than `tolerance` in -2 ln L."""
    active = tuple(active)
    look = study.look(place, active, until, seas) if first is None else first
    now = cost_of(study, look, used, prior, share)
    damping, settled, taken = 1e-3, False, 0
    for i in range(iterations):
        step, own = solve(normal(study, look, used, prior, share), damping)
        largest = np.abs(step[study.logarithmic[list(active)]]).max(initial=0.0)
        scale = min(1.0, LONGEST / max(largest, 1e-300))
        x = look.place.x + scale * study.directions[list(active)].T @ step
        there = Place(x, look.place.own + scale * own if look.place.own.size else look.place.own)
        candidate = study.look(there, active, until, seas)
        cost = cost_of(study, candidate, used, prior, share)
        taken += 1
        if np.isfinite(cost) and cost < now:
            gain, now, look = now - cost, cost, candidate
            damping = max(damping * 0.2, 1e-6) if scale == 1.0 else damping
            say(i + 1, now)
            if gain < tolerance:
                settled = True
                break
        else:
            damping = max(damping * 8, 1e-2)
            if damping > 1e6 or (np.isfinite(cost) and cost - now < 0.1 * tolerance):
                settled = True
                break
    return Reached(look, now, taken, settled)
