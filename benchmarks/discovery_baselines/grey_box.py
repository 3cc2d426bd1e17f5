"""Grey-box residual model: a Gaussian process of the reconstructed force over motion, lagged motion and wave.

The features that matter most, by permutation, are taken for effects. One feature may stand for several effects.

References:
    Rasmussen and Williams 2006, Gaussian Processes for Machine Learning, eq. 2.25 and section 5.1.
    Breiman 2001, Machine Learning 45, 5-32, section 10.
"""

import warnings

import numpy as np
from sklearn.exceptions import ConvergenceWarning
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel
from sklearn.inspection import permutation_importance

from benchmarks.discovery_baselines.law_answer import MotionLaw
from benchmarks.discovery_baselines.reconstructed_forces import ForcedTest, Reconstruction
from benchmarks.discovery_baselines.terms import Scales, scales_of, terms_of

SAMPLES = 400  # instants that the process is fitted to
REPEATS = 20  # permutations of a feature
MIN_IMPORTANCE = 0.3  # of the largest importance, for another feature to be named
SEED = 1

DAMPING = ("coulomb_friction", "hysteresis", "amplitude_dependent_drag", "current")
# effects that a feature is taken for, the first one named, by motion with "" for the others
EFFECTS_OF: dict[str, dict[str, tuple[str, ...]]] = {
    "x": {"surge": ("mooring_nonlinearity", "umbilical"), "": ("nonlinear_hydrostatics", "mass_properties")},
    "v": {"surge": DAMPING, "": ("amplitude_dependent_drag",)},
    "v lagged": {"pitch": ("hidden_oscillator", "radiation_memory"), "": ("radiation_memory", "hysteresis")},
    "x of another motion": {"": ("sensor_reference", "mass_properties")},
    "v of another motion": {"": ("coupled_damping",)},
    "eta": {"": ("wave_reflection", "wave_gauge_position")},
    "eta, a quarter later": {"": ("sensor_lag", "wave_gauge_position")},
    "eta^2 slow": {"": ("wave_drift", "wave_drift_damping", "sea_state_dependent_drag")},
}


def features_of(test: ForcedTest, motion: str, scales: Scales) -> dict[str, np.ndarray]:
    """Features (n,) by name."""
    terms = terms_of(test, motion, scales)
    return {name: row for name, row in terms.items() if _kind(name) in EFFECTS_OF}


def _kind(feature: str) -> str:
    return f"{feature[0]} of another motion" if feature[1:5] == " of " else feature


def grey_box_law(made: Reconstruction, motion: str) -> MotionLaw:
    """Gaussian process of the force in a motion, and the effects that its features stand for.

    Every fitted test gives the same number of instants, drawn at random away from the ends.

    Args:
        made: Reconstructed forces.
        motion: The motion.
    """
    tests = [test for test in made.of_use("fit") if motion in test.forces and test.forces[motion].visible]
    scales, random = scales_of(tests, motion), np.random.default_rng(SEED)
    rows, target = [], []
    for test in tests:
        force = test.forces[motion]
        inside = np.arange(len(force.force))[force.inside]
        drawn = random.choice(inside, min(SAMPLES // len(tests), len(inside)), replace=False)
        rows.append(np.stack(list(features_of(test, motion, scales).values()), axis=1)[drawn])
        target.append(force.force[drawn])
    table, force_drawn = np.concatenate(rows), np.concatenate(target)
    names = list(features_of(tests[0], motion, scales))
    middle, width = table.mean(axis=0), table.std(axis=0)
    varying = np.flatnonzero(width > 1e-12 * width.max())

    def scaled(values: np.ndarray) -> np.ndarray:
        return (values[:, varying] - middle[varying]) / width[varying]

    kernel = ConstantKernel() * RBF(np.full(len(varying), 3.0), (0.1, 1e4)) + WhiteKernel(0.1, (1e-6, 1e1))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)  # a length at its bound: a feature that does not matter
        process = GaussianProcessRegressor(kernel, normalize_y=True, random_state=SEED).fit(scaled(table), force_drawn)
    permuted = permutation_importance(process, scaled(table), force_drawn, n_repeats=REPEATS, random_state=SEED)
    importance = np.maximum(permuted.importances_mean, 0.0)
    weights: dict[str, float] = {}
    probabilities: dict[str, float] = {}
    alike: dict[str, tuple[str, ...]] = {}
    for i in np.argsort(-importance):
        options = EFFECTS_OF[_kind(names[varying[i]])]
        first, *alternatives = options.get(motion, options.get("", ()))
        share = float(importance[i] / max(importance.sum(), 1e-300))
        probabilities[first] = probabilities.get(first, 0.0) + share
        if importance[i] > 0 and importance[i] >= MIN_IMPORTANCE * importance.max():
            weights[first] = weights.get(first, 0.0) + share
            alike[first] = tuple(alternatives)

    def predicted(test: ForcedTest) -> np.ndarray:
        values = np.stack(list(features_of(test, motion, scales).values()), axis=1)
        return test.forces[motion].through_filter(process.predict(scaled(values)))

    return MotionLaw(motion, weights, probabilities, alike, predicted)
