"""Ensemble SINDy on reconstructed forces: a sparse law by motion, each term taken for an effect.

Terms of one motion are nearly collinear. Thresholded least squares keeps them all; greedy orthogonal regression does not.

References:
    Billings 2013, Nonlinear System Identification, section 3.2.
    Brunton, Proctor and Kutz 2016, PNAS 113, 3932-3937, eq. 3.
    Fasel, Kutz, Brunton and Brunton 2022, Proc. R. Soc. A 478, 20210904, section 3.
"""

from collections.abc import Sequence

import numpy as np
from pysindy.optimizers import FROLS, EnsembleOptimizer

from benchmarks.discovery_baselines.law_answer import MotionLaw
from benchmarks.discovery_baselines.reconstructed_forces import ForcedTest, Reconstruction
from benchmarks.discovery_baselines.terms import Scales, effect_of, scales_of, terms_of

MAX_TERMS = 4  # of a law
SIMPLER_LAW_MARGIN = 0.02  # of the force's mean square: a sparser law may explain so much less of the held-out tests
MODELS = 50  # of the ensemble
MAX_CORRELATION = 1 - 1e-6  # of a term with an earlier one: with more it is left out
MIN_INCLUSION = 0.6  # fraction of the models that have a term
ROW_STEP = 2.0  # s between rows
SEED = 1


def columns_of(test: ForcedTest, motion: str, scales: Scales) -> dict[str, np.ndarray]:
    """Terms (n,) by name, through the filter that the force passed."""
    force = test.forces[motion]
    return {name: force.through_filter(row) for name, row in terms_of(test, motion, scales).items()}


def rows_of(tests: Sequence[ForcedTest], motion: str, scales: Scales) -> tuple[np.ndarray, np.ndarray]:
    """Terms (n, k) and force (n,) of some tests, away from their ends; every test has the same weight."""
    tables, targets = [], []
    for test in tests:
        force = test.forces[motion]
        stride = max(1, round(ROW_STEP / force.test.step))
        target = force.force[force.inside][::stride]
        table = np.stack(list(columns_of(test, motion, scales).values()), axis=1)[force.inside][::stride]
        tables.append(table / len(target) ** 0.5)
        targets.append(target / len(target) ** 0.5)
    return np.concatenate(tables), np.concatenate(targets)


def ensemble(unit: np.ndarray, target: np.ndarray, size: int) -> np.ndarray:
    """Fraction of the ensemble's laws of some size that have a term (k,).

    Args:
        unit: Terms of unit norm (n, k).
        target: Force of unit norm (n,).
        size: Number of terms of each law.
    """
    np.random.seed(SEED)  # noqa: NPY002 (pysindy draws by it)
    optimizer = EnsembleOptimizer(FROLS(max_iter=size), bagging=True, n_models=MODELS)
    optimizer.fit(unit, target[:, None])
    return (np.array(optimizer.coef_list)[:, 0] != 0).mean(axis=0)


def independent(unit: np.ndarray) -> np.ndarray:
    """Numbers of the terms (n, k), of unit norm or zero, that are neither zero nor like an earlier one."""
    alike = np.abs(np.triu(unit.T @ unit, 1)).max(axis=0) > MAX_CORRELATION
    return np.flatnonzero((np.linalg.norm(unit, axis=0) > 0) & ~alike)


def sindy_law(made: Reconstruction, motion: str) -> MotionLaw:
    """Sparse law of the force in a motion.

    Fitted tests give terms and coefficients, held-out tests the number of terms: the least that explains nearly most.

    Args:
        made: Reconstructed forces.
        motion: The motion.
    """
    fitted, held = (
        [test for test in made.of_use(use) if motion in test.forces and test.forces[motion].visible]
        for use in ("fit", "holdout")
    )
    scales = scales_of(fitted, motion)
    names = list(columns_of(fitted[0], motion, scales))
    table, target = rows_of(fitted, motion, scales)
    norm, height = np.linalg.norm(table, axis=0), float(np.linalg.norm(target))
    unit = np.divide(table, norm, out=np.zeros_like(table), where=norm > 0)
    distinct = independent(unit)
    held_table, held_target = rows_of(held or fitted, motion, scales)
    candidates = []
    for size in range(1, MAX_TERMS + 1):
        inclusion = ensemble(unit[:, distinct], target / height, size)
        included, coefficients = distinct[inclusion >= MIN_INCLUSION], np.zeros(len(names))
        if len(included):
            coefficients[included] = np.linalg.lstsq(unit[:, included], target, rcond=1e-9)[0] / norm[included]
        residual = held_target - held_table @ coefficients
        candidates.append((1 - float(residual @ residual / (held_target @ held_target)), inclusion, coefficients))
    best = max(share for share, *_ in candidates)
    _, inclusion, coefficients = next(candidate for candidate in candidates if candidate[0] >= best - SIMPLER_LAW_MARGIN)
    weights: dict[str, float] = {}
    probabilities: dict[str, float] = {}
    for i, fraction in zip(distinct, inclusion, strict=True):
        if effect := effect_of(names[i], motion):
            weights[effect] = weights.get(effect, 0.0) + float(abs(coefficients[i]) * norm[i] / height)
            probabilities[effect] = max(probabilities.get(effect, 0.0), float(fraction))

    def predicted(test: ForcedTest) -> np.ndarray:
        return np.stack(list(columns_of(test, motion, scales).values()), axis=1) @ coefficients

    return MotionLaw(motion, {effect: weight for effect, weight in weights.items() if weight > 0}, probabilities, {}, predicted)
