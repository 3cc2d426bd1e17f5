"""Simulated motion over time, and decrement and period of decays."""

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.choices import unknown
from jaxhydro.environment import DOFS

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes

    from jaxhydro.waves.sea import AbstractSea

MIN_DISTANCE_FROM_END = (
    0.2  # of a half cycle: an extreme nearer than this to an end of the record may be the record's, not the motion's
)


class Response(eqx.Module):
    """Motion of the reference point over time; the degree of freedom is the last axis.

    Attributes:
        time: Times (s), (t,).
        position: Surge, sway, heave (m), roll, pitch, yaw (rad), (t, 6).
        rate: Time derivative of the position (m/s, rad/s), (t, 6).
        acceleration: Second derivative of the position (m/s², rad/s²), (t, 6).
    """

    time: Float[Array, " t"]
    position: Float[Array, "t 6"]
    rate: Float[Array, "t 6"]
    acceleration: Float[Array, "t 6"]

    def __getitem__(self, dof: str) -> Float[Array, " t"]:
        """Position of one degree of freedom (m or rad), (t,).

        Args:
            dof: Name, such as "surge".

        Raises:
            UnknownName: The name is not a degree of freedom.
        """
        if dof not in DOFS:
            raise unknown("degree of freedom", dof, DOFS)
        return self.position[..., DOFS.index(dof)]

    def __repr__(self) -> str:
        """Duration, step and range of each motion.

        Shapes where there are several motions, or none is computed yet.
        """
        from jaxhydro.display.summaries import response_summary

        return response_summary(self) if self._is_motion() else eqx.Module.__repr__(self)

    def _repr_html_(self) -> str | None:
        from jaxhydro.display.data_frames import response_html

        return response_html(self) if self._is_motion() else None

    def _is_motion(self) -> bool:
        """Whether it holds the numbers of one motion, and not shapes, tracers or several motions."""
        from jaxhydro.display.summaries import are_numbers

        return are_numbers((self.time, self.position)) and np.ndim(self.position) == 2

    def to_xarray(self, *, platform: str | None = None, sea: "AbstractSea | None" = None) -> "xr.Dataset":
        """Motions (m, degree) over time (s) as a data set after the CF conventions.

        Args:
            platform: Name of the platform, for the attribute `platform`.
            sea: The sea, whose elevation at the reference position becomes the variable `wave` (m).

        Returns:
            Variables `surge` ... `yaw` with `units`, `long_name` and `standard_name`, over the coordinate `time`.

        Raises:
            ValueError: There are several motions in one, (..., t, 6).
        """
        from jaxhydro.display.motion_dataset import response_dataset

        return response_dataset(self, platform, sea)

    def to_dataframe(self) -> "pd.DataFrame":
        """Motions (m, deg) over time (s), with the column names of motion.csv.

        Returns:
            Columns `surge_m` ... `yaw_deg`, index `time_s`.

        Raises:
            ValueError: There are several motions in one, (..., t, 6).
        """
        from jaxhydro.display.data_frames import response_frame

        return response_frame(self)

    def plot(self) -> "list[Axes]":
        """Plot the motions that move (m, deg) over time (s).

        Returns:
            Axes, one for each motion; `axes[0].figure` is the figure.

        Raises:
            ValueError: There are several motions in one, (..., t, 6).
        """
        from jaxhydro.display.axes import response_axes

        return response_axes(self)


class Cycles(NamedTuple):
    """Half cycles of a decay.

    Attributes:
        time: Middle of each half cycle (s), (n,).
        amplitude: Mean amplitude of its two extremes (unit), (n,).
        period: Period (s), twice the half cycle, (n,).
        decrement: Logarithmic decrement per whole cycle (-), (n,).
    """

    time: np.ndarray
    amplitude: np.ndarray
    period: np.ndarray
    decrement: np.ndarray


def extremes(time: np.ndarray, motion: np.ndarray, noise: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Successive crests and troughs of a decay about its own mean level.

    There is one extreme between two crossings that clear the noise by six standard deviations. It is the vertex of a
    parabola fitted over an eighth of a cycle around the tip, so that noise does not enlarge it.

    Args:
        time: Times (s), (t,).
        motion: Motion about its mean level (unit), (t,).
        noise: Standard deviation of the noise (unit).

    Returns:
        Times (s) and values (unit) of the extremes.
    """
    quiet = 6 * noise
    sign = np.zeros(len(motion), dtype=int)
    sign[motion > quiet] = 1
    sign[motion < -quiet] = -1
    clear = np.flatnonzero(sign)
    if len(clear) == 0:
        return np.zeros(0), np.zeros(0)
    starts = np.concatenate([[0], np.flatnonzero(np.diff(sign[clear])) + 1, [len(clear)]])
    times, values = [], []
    for first, last in pairwise(starts):
        span = slice(clear[first], clear[last - 1] + 1)
        t, x = time[span], motion[span]
        tip = int(np.argmax(np.abs(x)))
        clearance = MIN_DISTANCE_FROM_END * (t[-1] - t[0])
        at_end = t[tip] - time[0] < clearance or time[-1] - t[tip] < clearance
        if len(t) < 5 or at_end or tip in (0, len(t) - 1):
            continue  # cut off by an end of the record, or too short to be a half cycle
        near = np.abs(t - t[tip]) <= 0.125 * max(t[-1] - t[0], 1e-300)
        if near.sum() < 4:
            near = np.abs(np.arange(len(t)) - tip) <= 2
        a, b, c = np.polyfit(t[near] - t[tip], x[near], 2)
        shift = -b / (2 * a) if a != 0 else 0.0
        inside = abs(shift) <= 0.25 * (t[-1] - t[0])
        times.append(t[tip] + (shift if inside else 0.0))
        values.append(c - b * b / (4 * a) if inside and a != 0 else x[tip])
    return np.asarray(times), np.asarray(values)


def decay_cycles(time: np.ndarray, motion: np.ndarray, noise: float = 0.0) -> Cycles:
    """Decrement and period against amplitude, of a decay that oscillates about zero.

    From successive extremes A_i, A_i+1 half a period apart: amplitude (A_i + A_i+1)/2, period 2 (t_i+1 - t_i), decrement
    2 ln(A_i / A_i+1) per cycle.

    Args:
        time: Times (s), (t,).
        motion: Motion (unit), (t,).
        noise: Standard deviation of the noise (unit).

    Returns:
        One entry per half cycle.

    References:
        Den Hartog (1985), Mechanical Vibrations, chapter 2 (logarithmic decrement).
    """
    times, values = extremes(np.asarray(time), np.asarray(motion), noise)
    size = np.abs(values)
    pair = np.sign(values[1:]) != np.sign(values[:-1])
    first, second = size[:-1][pair], size[1:][pair]
    span = np.diff(times)[pair]
    return Cycles(
        (times[:-1][pair] + 0.5 * span), 0.5 * (first + second), 2 * span, 2 * np.log(first / np.maximum(second, 1e-300))
    )
