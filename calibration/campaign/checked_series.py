"""Series of a test as its checks see it: rows without faults, their step and period."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from calibration.campaign.finding import Finding, Severity
from calibration.campaign.manifest import Manifest
from calibration.campaign.manifest_sections import IN_WAVES, WAVE
from calibration.campaign.series import Series
from calibration.campaign.signals import dominant_period

MIN_SAMPLES = 20  # in a window
GAP_STEPS = 3.5  # median steps
MAX_SHOWN = 5  # of one kind in one channel


class CheckedSeries:
    """Series of a test, in the file's own units, and its rows without faults.

    Attributes:
        manifest: The manifest of the campaign.
        series: The series, with all rows.
        others: All series of the campaign.
        test: The test.
        unit: Unit of the times.
        time: (n,) times of the rows without faults.
        values: Channel -> (n,) values of these rows.
        step: Mean time step without gaps; 0 without rows.
        compared: (n,) bool, rows after the transient.
        driven: Channel of the waves or of the released motion, or "".
    """

    def __init__(self, manifest: Manifest, series: Series, others: tuple[Series, ...]) -> None:
        self.manifest, self.series, self.others, self.test = manifest, series, others, series.test
        self.unit = series.channels["time"].unit
        good = series.good
        self.time = series.time[good]
        self.values = {name: values[good] for name, values in series.values.items()}
        steps = np.diff(self.time)
        self.step = float(np.mean(steps[steps <= GAP_STEPS * np.median(steps)])) if np.any(steps > 0) else 0.0
        self.compared = self.time >= self.time[0] + self.test.transient if len(self.time) else good[:0]
        self.driven = WAVE if self.test.kind in IN_WAVES else self.test.degree_of_freedom or ""

    @cached_property
    def period(self) -> float | None:
        """Dominant period of the driven channel, in the unit of the times; None without the channel. Needs increasing times."""
        return dominant_period(self.time, self.values[self.driven]) if self.driven in self.values else None

    def finding(self, severity: Severity, channel: str, time: float | None, message: str, expected: str = "") -> Finding:
        """Finding on this series."""
        return Finding(severity, self.test.file, self.test.id, channel, time, message, expected)

    def at(self, time: float) -> str:
        """A time in words, with its unit."""
        return f"{time:.6g} {self.unit}"
