"""Tests in waves cut into blocks, for multiple shooting."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from calibration.residuals.seas import SeaRun, TestMotion
from jaxhydro.dynamics.model import State

PERIODS_PER_BLOCK = 3.0  # periods in a block, of the slowest natural motion that is fitted
MIN_BLOCKS = 2  # blocks of a test
INITIAL_STATE_DEVIATION = 0.5  # standard deviation of the prior of an initial position or rate, over that of the motion's
SMOOTHING_SHARE = 0.125  # share of the mean period of a motion's rate, either way, over which its record is smoothed
MIN_SMOOTHING_SAMPLES = 5  # samples there


class Blocks(eqx.Module):
    """Blocks of one run in arrays of one shape: block first, then channel or sample. SI."""

    begin: Int[Array, " b"]  # step of the run's clock
    span: Int[Array, " b"]  # steps to where the test's next block begins; 0: there is none
    state: State  # of the continuous run there
    times: Float[Array, "b t"]  # s; beyond the last sample the last one again
    measured: Float[Array, "b c t"]
    factor: Float[Array, "b c t"]  # what makes a difference a residual; 0 where there is no sample
    smooth: Float[Array, "b 2 c"]  # position and rate by the record
    loose: Float[Array, "b 2 c"]  # what a coordinate of 1 stands for in these; 0 where a motion is not fitted
    piece: Int[Array, "b c"]  # whose constant is in it: one beyond the last for none
    steps: int = eqx.field(static=True)


class RunInBlocks(NamedTuple):
    """A run while it is cut into blocks.

    Attributes:
        run: The run.
        path: State of the continuous run at every step of its clock.
        dofs: Numbers of the fitted motions.
        blocks: Blocks that were cut so far.
        lag: Time (s) by which recorded motions are late; blocks begin that much before their samples.
    """

    run: SeaRun
    path: State
    dofs: tuple[int, ...]
    blocks: list[tuple]
    lag: float = 0.0

    def step_of(self, samples: np.ndarray) -> np.ndarray:
        """Last step of the clock at or before the motion that samples of the run show, within the run."""
        off = (np.asarray(self.run.times)[samples] - self.lag - float(self.run.times[0])) / float(self.run.step)
        return np.clip(np.floor(off + 1e-6).astype(int), 0, self.run.steps)

    def cut(self, pieces: Sequence[TestMotion], numbers: Sequence[int], period: float, none: int) -> None:
        """Cut the motions of one test, of these numbers, into equal blocks."""
        times = np.asarray(self.run.times)
        between, count = float(times[1] - times[0]), pieces[0].measured.shape[0]
        samples = np.arange(count)
        parts = np.array_split(samples, max(MIN_BLOCKS, round(count * between / (PERIODS_PER_BLOCK * period))))
        begins = [int(self.step_of(pieces[0].begin + part[:1])[0]) for part in parts]
        for i, part in enumerate(parts):
            span = begins[i + 1] - begins[i] if i + 1 < len(parts) else 0
            shape = (len(self.dofs), len(part))
            measured, factor = np.zeros(shape), np.zeros(shape)
            smooth, loose = np.zeros((2, shape[0])), np.zeros((2, shape[0]))
            piece = np.full(shape[0], none)
            start = float(times[0]) + begins[i] * float(self.run.step)
            for motion, number in zip(pieces, numbers, strict=True):
                j, x = self.dofs.index(motion.dof), np.asarray(motion.measured)
                measured[j], piece[j] = x[part], number
                factor[j] = math.sqrt(motion.weight / count) / x.std()
                smooth[:, j], loose[:, j] = smoothed(times[motion.begin + samples], x, start + self.lag)
            sample_times = times[pieces[0].begin + part]
            needed = math.ceil((sample_times[-1] - self.lag - start) / float(self.run.step) - 1e-6)
            self.blocks.append((begins[i], span, sample_times, measured, factor, smooth, loose, piece, max(needed, span)))

    def stacked(self) -> Blocks:
        """The blocks in arrays of one shape."""
        begin, span, times, measured, factor, smooth, loose, piece, steps = zip(*self.blocks, strict=True)
        longest = max(map(len, times))

        def padded(values: Sequence[np.ndarray], mode: str = "constant") -> Array:
            rest = [[(0, 0)] * (x.ndim - 1) + [(0, longest - x.shape[-1])] for x in values]
            return jnp.asarray(np.stack([np.pad(x, r, mode=mode) for x, r in zip(values, rest, strict=True)]))  # type: ignore[call-overload]

        state = jax.tree.map(lambda leaf: leaf[np.array(begin)], self.path)
        whole = [jnp.asarray(np.stack(values)) for values in (smooth, loose, piece)]
        padding = [padded(times, "edge"), padded(measured), padded(factor)]
        return Blocks(jnp.array(begin), jnp.array(span), state, *padding, *whole, steps=max(steps))  # type: ignore[misc, arg-type]


def smoothed(times: np.ndarray, x: np.ndarray, time: float) -> tuple[np.ndarray, np.ndarray]:
    """Position and rate of a record at a time, and the widths of their priors.

    Position and rate are those of a quadratic through the samples near the time. The widths combine a share of the standard
    deviations of position and rate with the scatter about the quadratic.

    Args:
        times: Sample times (s), (t,).
        x: Record (m, rad), (t,).
        time: The time (s).

    Returns:
        Position and rate (2,), and their widths (2,).
    """
    rates = np.gradient(x, times)
    deviation, rate = float(x.std()), float(rates.std())
    pace = float(np.gradient(rates, times).std()) / rate
    near = np.abs(times - time) <= SMOOTHING_SHARE * 2 * math.pi / pace
    near[np.argsort(np.abs(times - time))[:MIN_SMOOTHING_SAMPLES]] = True
    coefficients = np.polyfit(times[near] - time, x[near], 2)
    scatter = float(np.std(x[near] - np.polyval(coefficients, times[near] - time)))
    loose = np.array(
        [math.hypot(INITIAL_STATE_DEVIATION * deviation, scatter), math.hypot(INITIAL_STATE_DEVIATION * rate, pace * scatter)]
    )
    return coefficients[:0:-1], loose
