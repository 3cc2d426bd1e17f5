"""Pairs of successive extremes of a decay, and their logarithmic decrements."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from jaxhydro.dynamics.response import extremes


@dataclass(frozen=True, eq=False)
class Decrements:
    """Pairs of successive extremes of a decay, half a cycle or a whole one apart.

    Attributes:
        extreme_times: (m,) times of the extremes (s).
        heights: (m,) absolute values of the extremes (m or rad).
        first: (n,) index of the first extreme of each pair.
        second: (n,) index of the second extreme of each pair.
        cycles: Cycles between the two: 0.5 or 1.
    """

    extreme_times: np.ndarray
    heights: np.ndarray
    first: np.ndarray
    second: np.ndarray
    cycles: float

    @property
    def time(self) -> np.ndarray:
        """(n,) middle of each pair (s)."""
        return 0.5 * (self.extreme_times[self.first] + self.extreme_times[self.second])

    @property
    def amplitude(self) -> np.ndarray:
        """(n,) mean height of each pair (m or rad)."""
        return 0.5 * (self.heights[self.first] + self.heights[self.second])

    @property
    def period(self) -> np.ndarray:
        """(n,) damped period (s)."""
        return (self.extreme_times[self.second] - self.extreme_times[self.first]) / self.cycles

    @property
    def decrement(self) -> np.ndarray:
        """(n,) logarithmic decrement per whole cycle (Den Hartog 1985, Mechanical Vibrations, chapter 2)."""
        return np.log(self.heights[self.first] / self.heights[self.second]) / self.cycles

    @property
    def damping_ratio(self) -> np.ndarray:
        """(n,) zeta = delta/(4 pi^2 + delta^2)^0.5, of critical: exact for linear damping."""
        return self.decrement / np.sqrt(4 * math.pi**2 + self.decrement**2)


def decrements(time: np.ndarray, motion: np.ndarray, noise: float = 0.0) -> tuple[Decrements, Decrements, Decrements]:
    """Find the pairs of extremes of a decay that oscillates about zero.

    Half cycles are those of `decay_cycles`.

    Args:
        time: (k,) times (s).
        motion: (k,) motion (m or rad).
        noise: Standard deviation of the noise on `motion` (m or rad).

    Returns:
        Half cycles, whole cycles between crests, whole cycles between troughs.
    """
    when, value = extremes(np.asarray(time), np.asarray(motion), noise)
    turn = np.sign(value[1:]) != np.sign(value[:-1])
    half, whole = np.flatnonzero(turn), np.flatnonzero(turn[1:] & turn[:-1])
    crest = value[whole] > 0
    return (
        Decrements(when, np.abs(value), half, half + 1, 0.5),
        Decrements(when, np.abs(value), whole[crest], whole[crest] + 2, 1.0),
        Decrements(when, np.abs(value), whole[~crest], whole[~crest] + 2, 1.0),
    )
