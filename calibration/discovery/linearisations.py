"""What a study is made of: the motions of tests, places where a fit is, and what is seen from there."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

SeaSelection = Literal["all", "fit"]
# of the motion that a test is about, in every band: what strips with constant coefficients, and a measured wave, are not asked
# to follow, however quiet the sensors are
RELATIVE_FLOOR = {"decay": 0.005, "regular": 0.02, "irregular": 0.02}


@dataclass(frozen=True)
class MotionSeries:
    """One motion of one test: what the residual of it is compared with. `noise` is the sensor's; `floor` (b,), by band, has
    beside it what no model of strips is asked to follow. `dof` (b,) are degrees of freedom by band, `samples` how many there
    are. Bands slower than `slow` (Hz) are one pool: see `calibration.discovery.expected_residuals`."""

    test: str
    kind: str
    use: str
    channel: str
    noise: float
    spread: float
    dof: np.ndarray
    low: np.ndarray
    high: np.ndarray
    samples: int
    floor: np.ndarray
    slow: float = 0.0

    @property
    def pool(self) -> np.ndarray:
        """Number of every band's pool (b,): that of its first band. The mean is one of its own."""
        bands = np.arange(len(self.low))
        return np.where((bands > 0) & (self.high <= self.slow), 1, bands)

    @property
    def region(self) -> np.ndarray:
        """Number of every band's region (b,): see `Study.by_region`."""
        return 0 * self.pool if self.kind == "decay" else np.minimum(self.pool, 2)

    @property
    def floor_rms(self) -> float:
        """The floor over all bands (m, rad)."""
        return float(np.sqrt(self.noise**2 + (self.dof * (self.floor**2 - self.noise**2)).sum() / self.samples))

    @property
    def weight(self) -> float:
        """Motions count by how much of them there is over their floor, up to a point."""
        return min(self.spread / self.floor_rms, 50.0)


@dataclass(frozen=True)
class Point:
    """Where a fit is: coordinates of all parameters, and every decay's own unknowns."""

    x: np.ndarray
    own: np.ndarray

    def moved(self, directions: np.ndarray, step: np.ndarray, own: np.ndarray) -> "Point":
        """A step along directions, and of the decays' unknowns."""
        return Point(self.x + step @ directions, self.own + own)


@dataclass(frozen=True)
class Linearisation:
    """What is seen from a place, in rows (`Rows`), the decays' before the seas': the residual (n,), its slopes (n, q) along the
    `active` directions, and those of the decays' rows (m, o) along their own unknowns."""

    place: Point
    active: tuple[int, ...]
    residual: np.ndarray
    slopes: np.ndarray
    own: np.ndarray

    def joined_with(self, other: "Linearisation") -> "Linearisation":
        """The directions of another look too, as seen from there."""
        return replace(self, active=(*self.active, *other.active), slopes=np.hstack([self.slopes, other.slopes]))

    def restricted_to(self, active: Sequence[int]) -> "Linearisation":
        """Some of the directions."""
        at = [self.active.index(i) for i in active]
        return replace(self, active=tuple(active), slopes=self.slopes[:, at])


@dataclass(frozen=True)
class Prior:
    """Gaussian priors of the steps along directions from where the study starts: mean and standard deviation by direction."""

    mean: np.ndarray
    width: np.ndarray
