"""Motions of all tests of a calibration as one data set."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

import jaxhydro
from calibration.result import Calibration
from jaxhydro.environment import DOFS
from jaxhydro.hull.outline import hull_variable
from jaxhydro.netcdf_file import DataSet
from jaxhydro.units import for_people, unit_of

if TYPE_CHECKING:
    import xarray as xr

_EVEN = 1e-3  # of a step: times that differ by less are the same


def dataset(calibration: Calibration) -> "xr.Dataset":
    """`motions_of_tests` as an xarray data set."""
    import xarray as xr  # where it is used: what is written alone does without

    return xr.Dataset(*motions_of_tests(calibration))


def motions_of_tests(calibration: Calibration) -> DataSet:
    """Measured and simulated series of all tests (test, channel, time), in m and deg.

    Values are nan where there are none. `time` counts from every test's own start (`start_time`, on its file's axis). Tests
    sampled alike keep their samples; others are interpolated linearly to the finest sampling, which the attribute `sampling`
    says.
    """
    tests = calibration.tests
    channels = [dof for dof in DOFS if any(series.channel == dof for test in tests for series in test.series)]
    times = [test.time - test.time[0] for test in tests]
    axis, alike = common_axis(times)
    shape = (len(tests), len(channels), len(axis))
    motion = {name: np.full(shape, np.nan) for name in ("measured", "simulated", "before")}
    each = {name: np.full(shape[:2], np.nan) for name in ("noise", "sensor_offset")}
    scored = np.zeros(shape[:2], dtype="int8")
    for i, (test, time) in enumerate(zip(tests, times)):
        for series in test.series:
            j, name = channels.index(series.channel), series.channel
            values = {"measured": series.measured, "simulated": series.simulated, "before": test.start.get(name)}
            for key, column in values.items():
                if column is None:
                    continue
                column = for_people(name, column)
                if alike:
                    motion[key][i, j, : len(time)] = column
                else:
                    motion[key][i, j] = np.interp(axis, time, column, left=np.nan, right=np.nan)
            each["noise"][i, j] = for_people(name, series.noise)
            each["sensor_offset"][i, j] = for_people(name, series.offset)
            scored[i, j] = series.scored
    both = "m; deg for roll, pitch and yaw"
    long = {
        "measured": "measured motion of the reference point, still water at zero, sensor offset taken off",
        "simulated": "motion of the calibrated model",
        "before": "motion of the model before calibration",
        "noise": "standard deviation of the measurement noise",
        "sensor_offset": "sensor offset that was taken off the measured series",
    }
    dims, units = ("test", "channel", "time"), [unit_of(name) for name in channels]
    data: dict[str, Any] = {}
    for name, array in (motion | each).items():
        data[name] = (dims[: array.ndim], array, {"units": both, "long_name": long[name]})
    data["in_objective"] = (dims[:2], scored, {"units": "1", "long_name": "1 where the series counts in the objective"})
    data |= hull_variable(calibration.model.hull)
    text = {"use": "fit, holdout or ignore", "kind": "kind of test", "degree_of_freedom": "motion that was released"}
    coordinates: dict[str, Any] = {
        "time": ("time", axis, {"units": "s", "long_name": "time since the start of the test"}),
        "test": ("test", np.array([test.id for test in tests], dtype=object), {"long_name": "test"}),
        "channel": ("channel", np.array(channels, dtype=object), {"long_name": "motion"}),
        "unit": ("channel", np.array(units, dtype=object), {"long_name": "unit of the channel"}),
        "start_time": (
            "test",
            np.array([float(test.time[0]) for test in tests]),
            {"units": "s", "long_name": "start of the test on its file's time axis, at full scale"},
        ),
        **{
            name: ("test", np.array([getattr(test, name) or "" for test in tests], dtype=object), {"long_name": words})
            for name, words in text.items()
        },
    }
    about = {
        "title": f"Calibration of {calibration.campaign}",
        "source": f"jaxhydro {jaxhydro.__version__}",
        "converged": int(calibration.converged),
        "sampling": "as recorded" if alike else "interpolated linearly to the finest sampling",
    }
    return DataSet(data, coordinates, about)


def common_axis(times: list[np.ndarray]) -> tuple[np.ndarray, bool]:
    """One time axis, and whether every test's samples lie on it."""
    if not times:
        return np.zeros(0), True
    longest = max(times, key=len)
    step = min(float(np.median(np.diff(time))) for time in times)
    if all(np.abs(longest[: len(time)] - time).max() < _EVEN * step for time in times):
        return longest, True
    end = max(float(time[-1]) for time in times)
    return step * np.arange(math.floor(end / step * (1 + 1e-12)) + 1), False
