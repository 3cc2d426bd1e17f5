"""Law of few terms for a latent force, by sparse regression checked on other data.

The library and the regression follow Brunton, Proctor and Kutz, with at most three terms. All sets of terms are tried, which
orthogonal matching pursuit would look through one by one. Terms pass the filter that the force passed.

A force moves the body, so that terms of the measured motion correlate with it whatever its law. Coefficients are therefore
found by instrumental variables: the terms along the motion simulated without the force. Nothing is left then of a force that
does not depend on the motion.

References:
    Brunton, Proctor and Kutz 2016, PNAS 113, 3932-3937, eq. 3.
    Soderstrom and Stoica 1989, System Identification, chapter 8.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import combinations
from typing import NamedTuple

import numpy as np

from calibration.discovery.latent_force.recovered_force import RecoveredForce
from calibration.discovery.latent_force.term_library import LAGGED_TERMS, STILL_WATER_TERMS, WAVE_TERMS, columns_of
from calibration.discovery.reported_forces import Law, LawTerm

MAX_TERMS = 3  # terms of a law
MIN_SHARE_GAIN = 0.03  # increase of the held-out fraction that another term needs
MIN_EXPLAINED_SHARE = 0.2  # of the held-out force: with less there is no law
SIMPLER_LAW_MARGIN = 0.02  # of the smallest remainder: a simpler law may leave so much more
MAX_TERM_RATIO = 5.0  # of a term to the force: larger terms cancel each other
FRICTION_SPEED_OVER_RMS = 0.05  # v0 of friction over the rms velocity
BLOCK_COUNT = 4  # blocks of a test


class RegressionBlock(NamedTuple):
    """Data of a test, or of a block of it, for the regression.

    Attributes:
        force: Force (n,).
        terms: Terms along the measured motion (n, k).
        instruments: Terms along the simulated motion (n, k).
        weight: Weight; the same for all tests except those that are mostly noise.
    """

    force: np.ndarray
    terms: np.ndarray
    instruments: np.ndarray
    weight: float

    def products(self) -> np.ndarray:
        """Weighted [X F]^T [X F]."""
        both = np.column_stack([self.terms, self.force])
        return self.weight * both.T @ both

    def across(self) -> np.ndarray:
        """Weighted Z^T [X F], Z the instruments."""
        return self.weight * self.instruments.T @ np.column_stack([self.terms, self.force])


def best_terms(products: np.ndarray, size: int) -> tuple[tuple[int, ...], np.ndarray]:
    """The set of terms that leaves least of the force.

    Of sets that leave nearly as little, the simplest is taken.

    Args:
        products: Weighted [X F]^T [X F] (k + 1, k + 1).
        size: Number of terms.

    Returns:
        Numbers of the terms, and their coefficients.
    """
    scale = np.sqrt(np.maximum(np.diag(products), 1e-300))
    unit = products / np.outer(scale, scale)
    usable = [i for i in range(len(scale) - 1) if scale[i] > 1e-9 * scale[:-1].max()]
    sets = np.array([terms for terms in combinations(usable, size) if sum(i in LAGGED_TERMS for i in terms) < 2])
    if not len(sets):
        return (), np.zeros(0)
    gram = unit[sets[:, :, None], sets[:, None, :]] + 1e-9 * np.eye(size)
    onto = unit[sets, -1]
    solutions = np.linalg.solve(gram, onto[..., None])[..., 0]
    remainder = np.where(np.abs(solutions).max(axis=1) < MAX_TERM_RATIO, 1 - (solutions * onto).sum(axis=1), np.inf)
    if not np.isfinite(remainder).any():
        return (), np.zeros(0)
    i = int(np.flatnonzero(remainder <= (1 + SIMPLER_LAW_MARGIN) * remainder.min() + 1e-4)[0])
    return tuple(int(k) for k in sets[i]), solutions[i] * scale[-1] / scale[sets[i]]


def explained_share(parts: Iterable[RegressionBlock], chosen: Sequence[int], coefficients: np.ndarray) -> float:
    """Fraction of the force's mean square that a law explains; negative where it makes it larger."""
    remainder = total = 0.0
    for block in parts:
        remainder += block.weight * float(((block.force - block.terms[:, list(chosen)] @ coefficients) ** 2).sum())
        total += block.weight * float((block.force**2).sum())
    return 1 - remainder / total if total > 0 else 0.0


def law_of(motion: str, forces: Sequence[RecoveredForce]) -> Law:
    """A law of few terms for a latent force.

    Fitted tests give the terms and coefficients, held-out tests the number of terms. Without held-out tests with a visible
    force, blocks of the fitted ones are left out in turn.
    """
    fitted = [recovered for recovered in forces if recovered.test.use == "fit" and recovered.visible]
    waves = any(recovered.test.wave is not None for recovered in fitted)
    kinds = [*STILL_WATER_TERMS, *(WAVE_TERMS if waves else ())]
    if not fitted:
        return Law((), 0.0, 0.0, "")
    slow = FRICTION_SPEED_OVER_RMS * float(np.median([np.std(recovered.velocity[recovered.inside]) for recovered in fitted]))
    moved, moving = (
        sum(float(np.var(values(recovered)[recovered.inside])) for recovered in fitted)
        for values in (lambda recovered: recovered.position, lambda recovered: recovered.velocity)
    )
    pace = (moving / max(moved, 1e-300)) ** 0.5

    def part(recovered: RecoveredForce) -> RegressionBlock:
        force, terms = recovered.force[recovered.inside], columns_of(recovered, slow, pace)[:, : len(kinds)]
        instruments = columns_of(recovered, slow, pace, without=True)[:, : len(kinds)]
        return RegressionBlock(
            force, terms, instruments, 1 / (len(force) * (recovered.root_mean_square**2 + 9 * recovered.noise**2))
        )

    whole = [part(recovered) for recovered in fitted]
    every, across = (np.sum(products, axis=0) for products in zip(*((block.products(), block.across()) for block in whole)))
    held = [part(recovered) for recovered in forces if recovered.test.use == "holdout" and recovered.visible]
    folds = [(across, held)] if held else list(_left_out(whole))
    law = Law((), 0.0, 0.0, "held-out tests" if held else "blocks left out in turn")
    for size in range(1, MAX_TERMS + 1):
        chosen, _ = best_terms(every, size)
        if not chosen:
            continue
        coefficients = _solved(across, chosen)
        share = float(np.mean([explained_share(checked, chosen, _solved(training, chosen)) for training, checked in folds]))
        if share >= max(MIN_EXPLAINED_SHARE, law.share + MIN_SHARE_GAIN):
            terms = tuple(LawTerm(kinds[i].name, float(c), kinds[i].unit(motion), i) for i, c in zip(chosen, coefficients))
            law = replace(law, terms=terms, share=share, fitted=explained_share(whole, chosen, coefficients))
        elif not law.terms:
            law = replace(law, share=max(share, law.share, 0.0))
    return replace(law, v0=slow, pace=pace)


def _solved(across: np.ndarray, chosen: Sequence[int]) -> np.ndarray:
    """Coefficients of some terms by instrumental variables."""
    gram, onto = across[np.ix_(chosen, chosen)], across[list(chosen), -1]
    scale = np.sqrt(np.maximum(np.abs(np.diag(gram)), 1e-300))
    return np.linalg.lstsq(gram / np.outer(scale, scale), onto / scale, rcond=1e-9)[0] / scale


def _left_out(parts: Sequence[RegressionBlock]) -> Iterable[tuple[np.ndarray, list[RegressionBlock]]]:
    """Products over all blocks but one of every test, and the blocks left out."""
    for k in range(BLOCK_COUNT):
        blocks = [
            [
                RegressionBlock(f, x, z, part.weight)
                for f, x, z in zip(*(np.array_split(values, BLOCK_COUNT) for values in part[:3]))
            ]
            for part in parts
        ]
        training = np.sum([block.across() for rows in blocks for i, block in enumerate(rows) if i != k], axis=0)
        yield training, [rows[k] for rows in blocks]
