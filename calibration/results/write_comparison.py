"""Writing of a comparison in waves: comparison.json, simulated.nc, figures."""

from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

import jaxhydro
from calibration.residuals.measured_seas import Comparison, SeaTest
from calibration.residuals.sea_errors import channels
from calibration.results.result_folder import COMPARISON_FILE, draw, outdated, write_json, write_motion
from calibration.results.write_calibration import common_axis
from jaxhydro.environment import DOFS
from jaxhydro.files import staged
from jaxhydro.units import unit_of


def write_comparison(found: Comparison, content: dict[str, Any], folder: str | PathLike[str], figures: bool = True) -> Path:
    """Write all results into `folder` (made where absent); gives the folder. Those of an earlier comparison there are replaced
    when the new ones are complete. Raises InputError where the folder cannot be written."""
    folder = Path(folder)
    with staged(folder, lambda temporary: outdated(folder, temporary, COMPARISON_FILE)) as temporary:
        drawn = []
        if figures:
            from calibration.plots import sea_figures as seas_plot

            drawn = draw(seas_plot.figures(found.tests), temporary)
        write_json({**content, "figures": drawn}, temporary / COMPARISON_FILE)
        write_motion(dataset(found.tests, str(content["campaign"])), temporary)
    return folder


def dataset(tests: tuple[SeaTest, ...], campaign: str) -> xr.Dataset:
    """Measured and simulated motions (test, channel, time) and waves (test, time), nan where there is none; m and deg.

    `time` counts from where every test's comparison begins, after its transient (`start_time`, on its file's axis).
    """
    names = [dof for dof in DOFS if any(s.channel == dof for test in tests for s in test.fit.series)]
    times = [test.fit.time - test.fit.time[0] for test in tests]
    axis, alike = common_axis(times)
    motion = {key: np.full((len(tests), len(names), len(axis)), np.nan) for key in ("measured", "simulated")}
    wave = {key: np.full((len(tests), len(axis)), np.nan) for key in ("measured", "simulated")}
    for i, (test, time) in enumerate(zip(tests, times)):
        for name, pair in channels(test).items():
            for key, values in zip(("measured", "simulated"), pair):
                row = wave[key][i] if name == "wave" else motion[key][i, names.index(name)]
                row[:] = (
                    np.pad(values, (0, len(axis) - len(time)), constant_values=np.nan)
                    if alike
                    else np.interp(axis, time, values, left=np.nan, right=np.nan)
                )
    both = {"units": "m; deg for roll, pitch and yaw"}
    words = {"measured": "measured motion of the reference point, still water at zero", "simulated": "motion of the model"}
    at = {"measured": "measured elevation at the gauge", "simulated": "elevation of the simulated sea at the gauge"}
    data: dict[str, Any] = {
        key: (("test", "channel", "time"), motion[key], both | {"long_name": words[key]}) for key in motion
    } | {f"wave_{key}": (("test", "time"), wave[key], {"units": "m", "long_name": at[key]}) for key in wave}
    starts = np.array([float(test.fit.time[0]) for test in tests])
    coordinates: dict[str, Any] = {
        "time": ("time", axis, {"units": "s", "long_name": "time since the start of the comparison"}),
        "test": ("test", np.array([test.fit.id for test in tests], dtype=object), {"long_name": "test"}),
        "channel": ("channel", np.array(names, dtype=object), {"long_name": "motion"}),
        "unit": ("channel", np.array([unit_of(name) for name in names], dtype=object), {"long_name": "unit of the channel"}),
        "start_time": ("test", starts, {"units": "s", "long_name": "on the file's time axis, at full scale"}),
        "use": ("test", np.array([test.fit.use for test in tests], dtype=object), {"long_name": "fit or holdout"}),
        "kind": ("test", np.array([test.fit.kind for test in tests], dtype=object), {"long_name": "kind of test"}),
    }
    about = {
        "title": f"Tests in waves of {campaign}",
        "source": f"jaxhydro {jaxhydro.__version__}",
        "sampling": "as recorded" if alike else "interpolated linearly to the finest sampling",
    }
    return xr.Dataset(data, coordinates, about)
