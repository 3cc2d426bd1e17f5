"""What a simulation leaves behind: simulated.nc, motion.csv and a figure, in m and deg, whole or not at all."""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from jaxhydro.environment import DOFS
from jaxhydro.files import staged
from jaxhydro.plot import for_people, motion_figure, save, style, unit_of


class Motion(NamedTuple):
    """A simulated motion as people read it: time (s), surge ... yaw (m, deg; sample, dof), elevation (m) or None."""

    time: np.ndarray
    values: np.ndarray
    wave: np.ndarray | None

    @classmethod
    def of(cls, time: np.ndarray, position: np.ndarray, wave: np.ndarray | None = None) -> "Motion":
        """From positions in m and rad."""
        columns = [for_people(dof, position[:, i]) for i, dof in enumerate(DOFS)]
        return cls(np.asarray(time), np.stack(columns, axis=1), wave)

    def amplitude(self, period: float) -> np.ndarray:
        """(6,) amplitude at a period (s), by least squares over the last half of the record in whole periods."""
        span = self.time[-1] - self.time[0]
        whole = max(1.0, np.floor(0.5 * span / period)) * period
        keep = self.time >= self.time[-1] - whole - 1e-9
        phase = 2 * np.pi / period * self.time[keep]
        basis = np.stack([np.ones(keep.sum()), np.cos(phase), np.sin(phase)], axis=1)
        solution = np.linalg.lstsq(basis, self.values[keep], rcond=None)[0]
        return np.hypot(solution[1], solution[2])


def write_motion(motion: Motion, folder: Path, title: str, source: str) -> None:
    """Write a motion's files into a folder."""
    names = ["time_s", *(f"{dof}_{unit_of(dof)}" for dof in DOFS)]
    columns = [motion.time, *motion.values.T]
    about = {"units": "m; deg for roll, pitch and yaw", "long_name": "motion of the reference point"}
    data: dict[str, Any] = {"simulated": (("channel", "time"), motion.values.T, about)}
    if motion.wave is not None:
        names.append("wave_m")
        columns.append(motion.wave)
        about = {"units": "m", "long_name": "wave elevation at the reference position"}
        data["wave"] = (("time",), motion.wave, about)
    coordinates = {
        "time": ("time", motion.time, {"units": "s", "long_name": "time"}),
        "channel": ("channel", np.array(DOFS, dtype=object), {"long_name": "motion"}),
        "unit": ("channel", np.array([unit_of(dof) for dof in DOFS], dtype=object), {"long_name": "unit of a channel"}),
    }
    dataset = xr.Dataset(data, coordinates, {"title": title, "source": source})
    with staged(folder) as temporary:
        rows, header = np.stack(columns, axis=1), ",".join(names)
        np.savetxt(temporary / "motion.csv", rows, fmt="%.9g", delimiter=",", header=header, comments="")
        packed = {name: {"zlib": True, "complevel": 4} for name in data}
        dataset.to_netcdf(temporary / "simulated.nc", engine="h5netcdf", encoding=packed)
        with style():
            figure = motion_figure(motion.time, dict(zip(DOFS, motion.values.T, strict=True)), motion.wave, title)
            save(figure, temporary / "figures" / "motion.png")
