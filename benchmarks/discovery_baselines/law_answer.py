"""Answer from laws of reconstructed forces: which motions' laws help in held-out tests, which effects they stand for."""

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from benchmarks.discovery.answer_file import Answer, ClaimedEffect, HeldOutErrors
from benchmarks.discovery.cases import MOTION_OF
from benchmarks.discovery_baselines.reconstructed_forces import ForcedTest, Reconstruction

MIN_ERROR_FALL = 0.05  # of the held-out error, by a motion's law, for the law to count
# a fitted test's motion with a larger residual, over its standard deviation and over the noise, is unexplained
MAX_RESIDUAL_SHARE = {"decay": 0.03, "irregular": 0.05}
MAX_RESIDUAL_OVER_NOISE = 2.0


class MotionLaw(NamedTuple):
    """Law of the force in one motion.

    Attributes:
        motion: The motion.
        weights: Size of the effects' terms over that of the force, by effect that the law names.
        probabilities: Probabilities by effect, also of those not named.
        alike: Effects that the law cannot tell from another, by effect.
        predicted: Function that gives the force (N, N m; n,) in a test, through the reconstruction's filter.
    """

    motion: str
    weights: Mapping[str, float]
    probabilities: Mapping[str, float]
    alike: Mapping[str, Sequence[str]]
    predicted: Callable[[ForcedTest], np.ndarray]


def held_out_error(made: Reconstruction, laws: Sequence[MotionLaw]) -> float:
    """Sum of RMSE over standard deviation of the held-out tests, with laws in the model."""
    return sum(
        sum(test.errors_with({law.motion: law.predicted(test) for law in laws if law.motion in test.forces}).values())
        for test in made.of_use("holdout")
    )


def not_followed_motions(test: ForcedTest) -> list[str]:
    """Scored motions of a test with a residual that is neither noise nor small."""
    rms = {name: float(np.std(test.test.measured[name] - test.test.simulated[name])) for name in test.relative}
    return [
        name
        for name, relative in test.relative.items()
        if relative > MAX_RESIDUAL_SHARE[test.test.kind] and rms[name] > MAX_RESIDUAL_OVER_NOISE * test.test.noise[name]
    ]


def answer_of_laws(made: Reconstruction, laws: Sequence[MotionLaw]) -> Answer:
    """Answer of a method, without its time.

    A motion's law counts if it alone lowers the held-out error by `MIN_ERROR_FALL`. Effects are ordered by the fall of the
    error in their motion, times their part of the force.

    Args:
        made: Reconstructed forces.
        laws: Laws by motion.
    """
    baseline = held_out_error(made, [])
    fall = {law.motion: baseline - held_out_error(made, [law]) for law in laws}
    helpful = [law for law in laws if law.weights and fall[law.motion] > MIN_ERROR_FALL * baseline]
    worth: dict[str, float] = {}
    claims: dict[str, ClaimedEffect] = {}
    for law in helpful:
        total = sum(law.weights.values())
        for effect, weight in law.weights.items():
            value = fall[law.motion] * weight / total
            if value > worth.get(effect, 0.0):
                claims[effect] = _claim(law, effect)
            worth[effect] = worth.get(effect, 0.0) + value
    considered: dict[str, ClaimedEffect] = {}
    for law in helpful:
        for effect, probability in law.probabilities.items():
            previous = considered.get(effect)
            if effect not in claims and (previous is None or probability > (previous.probability or 0.0)):
                considered[effect] = _claim(law, effect)
    not_followed = any(not_followed_motions(test) for test in made.of_use("fit"))
    return Answer(
        verdict="found" if claims else "unexplained" if not_followed else "nothing_missing",
        effects=[claims[effect] for effect in sorted(claims, key=lambda effect: -worth[effect])],
        considered=list(considered.values()),
        held_out_error=HeldOutErrors(baseline=baseline, final=held_out_error(made, helpful)),
    )


def _claim(law: MotionLaw, effect: str) -> ClaimedEffect:
    motion = law.motion if effect in MOTION_OF else None  # stated for effects that act in one
    probability = min(max(float(law.probabilities.get(effect, 0.0)), 0.0), 1.0)
    return ClaimedEffect(
        effect=effect, motion=motion, probability=probability, indistinguishable_from=list(law.alike.get(effect, ()))
    )
