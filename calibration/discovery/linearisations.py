"""Data classes of a diagnosis: parameter point, linearised residual, prior, measured motion with its noise floor."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

SeaSelection = Literal["all", "fit"]
# of the motion that a test is about, in every band: what strips with constant coefficients, and a measured wave, are not asked
# to follow, however quiet the sensors are
# smallest error over the motion that a model of strips can reach, by kind of test
RELATIVE_FLOOR = {"decay": 0.005, "regular": 0.02, "irregular": 0.02}


@dataclass(frozen=True)
class MotionSeries:
    """One motion of one test, with the noise and floor that its residual is compared with.

    Attributes:
        test: Name of the test.
        kind: Kind of the test (decay, regular, irregular).
        use: Use of the test (fit, holdout).
        channel: The motion.
        noise: Sensor noise (m, rad).
        spread: Standard deviation of the motion (m, rad).
        dof: Degrees of freedom by band (b,).
        low: Lower edges of the bands (Hz; b,).
        high: Upper edges of the bands (Hz; b,).
        samples: Number of samples.
        floor: Noise and unavoidable model error by band (m, rad; b,).
        slow: Bands below this frequency (Hz) are one pool (see `calibration.discovery.expected_residuals`).
    """

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
        """Number of every band's pool (b,), which is its first band; the mean is a pool of its own."""
        bands = np.arange(len(self.low))
        return np.where((bands > 0) & (self.high <= self.slow), 1, bands)

    @property
    def region(self) -> np.ndarray:
        """Number of every band's region (b,). See `Study.by_region`."""
        return 0 * self.pool if self.kind == "decay" else np.minimum(self.pool, 2)

    @property
    def floor_rms(self) -> float:
        """Root mean square of the floor over all bands (m, rad)."""
        return float(np.sqrt(self.noise**2 + (self.dof * (self.floor**2 - self.noise**2)).sum() / self.samples))

    @property
    def weight(self) -> float:
        """Weight of the motion in averages: its size over its floor, limited."""
        return min(self.spread / self.floor_rms, 50.0)


@dataclass(frozen=True)
class Point:
    """A point of a fit.

    Attributes:
        x: Coordinates of all parameters (p,).
        own: The decays' own unknowns (r, o).
    """

    x: np.ndarray
    own: np.ndarray

    def moved(self, directions: np.ndarray, step: np.ndarray, own_step: np.ndarray) -> "Point":
        """The point after a step along directions, and of the decays' own unknowns."""
        return Point(self.x + step @ directions, self.own + own_step)


@dataclass(frozen=True)
class Linearisation:
    """Residual and slopes at a point, in rows (`FourierRows`), the decays' rows before the seas'.

    Attributes:
        point: The point.
        active: Numbers of the directions.
        residual: Residual (n,).
        slopes: Slopes along the directions (n, q).
        own: Slopes of the decays' rows along their own unknowns (m, o).
    """

    point: Point
    active: tuple[int, ...]
    residual: np.ndarray
    slopes: np.ndarray
    own: np.ndarray

    def joined_with(self, added: "Linearisation") -> "Linearisation":
        """The directions of another linearisation appended."""
        return replace(self, active=(*self.active, *added.active), slopes=np.hstack([self.slopes, added.slopes]))

    def restricted_to(self, active: Sequence[int]) -> "Linearisation":
        """Some of the directions only."""
        columns = [self.active.index(i) for i in active]
        return replace(self, active=tuple(active), slopes=self.slopes[:, columns])


@dataclass(frozen=True)
class Prior:
    """Gaussian priors of steps along directions, from where the study starts.

    Attributes:
        mean: Means (d,).
        width: Standard deviations (d,).
    """

    mean: np.ndarray
    width: np.ndarray
