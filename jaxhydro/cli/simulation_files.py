"""Output files of a simulation, in m and deg.

They are simulated.nc, motion.csv, motion.nc, motion.outb, statistics.json and figures.
"""

import json
from collections.abc import Callable, Collection, Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from jaxhydro.analysis.sea_statistics import in_order
from jaxhydro.environment import DOFS
from jaxhydro.files import REPORT_FILE, own_report, staged
from jaxhydro.hull.hull import Hull
from jaxhydro.hull.outline import hull_variable
from jaxhydro.interop.outb_file import write_outb
from jaxhydro.netcdf_file import COMPRESSION, DataSet, write_netcdf
from jaxhydro.units import for_people, unit_of

STATISTICS = "statistics.json"
OF_SEAS = (STATISTICS, "figures/motion.png", "figures/window.png", "figures/spectra.png")
FORMAT_FILES = {"netcdf": "motion.nc", "outb": "motion.outb"}  # by format, beside motion.csv
OPENFAST_MOTIONS = [f"Ptfm{dof.capitalize()}" for dof in DOFS]
OPENFAST_WAVE = "Wave1Elev"
MAX_PLOTTED_FREQUENCY = 0.2  # Hz, that spectra are drawn to


class Motion(NamedTuple):
    """Simulated motion in the units that people read.

    Attributes:
        time: Times (s), (t,).
        values: Surge ... yaw (m, deg), (t, 6).
        wave: Elevation (m), (t,), or None.
    """

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


class SeaState(NamedTuple):
    """Irregular sea, as it is written.

    Attributes:
        first_order: First order of the elevation (m), (t,).
        target: Spectrum that was asked for (Hz -> m²/Hz); None for a record.
        about: Properties of the sea: how it was made.
        results: Results of `summary`.
    """

    first_order: np.ndarray
    target: Callable[[np.ndarray], np.ndarray] | None
    about: Mapping[str, Any]
    results: Mapping[str, Any]


def write_motion(
    motion: Motion,
    folder: Path,
    title: str,
    source: str,
    sea: SeaState | None = None,
    figures: bool = True,
    hull: Hull | None = None,
    inputs: Mapping[str, Any] | None = None,
    formats: Collection[str] = (),
) -> None:
    """Write a motion's files into a folder.

    Without `figures`, those of an earlier simulation there are taken away.

    Args:
        motion: The motion.
        folder: The folder.
        title: Name of the platform.
        source: Program and version.
        sea: The irregular sea, if there is one.
        figures: Whether figures are drawn.
        hull: Hull of the model, written for drawings.
        inputs: Inputs beside the sea, written as attributes; None is left out.
        formats: Further files of the motion: of `FORMAT_FILES`.
    """
    names = ["time_s", *(f"{dof}_{unit_of(dof)}" for dof in DOFS)]
    columns = [motion.time, *motion.values.T]
    about = {"units": "m; deg for roll, pitch and yaw", "long_name": "motion of the reference point"}
    data: dict[str, Any] = {"simulated": (("channel", "time"), motion.values.T, about)}
    if motion.wave is not None:
        names.append("wave_m")
        columns.append(motion.wave)
        about = {"units": "m", "long_name": "wave elevation at the reference position"}
        data["wave"] = (("time",), motion.wave, about)
    if sea is not None:
        data["wave_first_order"] = (("time",), sea.first_order, {"units": "m", "long_name": "first order of the elevation"})
    coordinates = {
        "time": ("time", motion.time, {"units": "s", "long_name": "time"}),
        "channel": ("channel", np.array(DOFS, dtype=object), {"long_name": "motion"}),
        "unit": ("channel", np.array([unit_of(dof) for dof in DOFS], dtype=object), {"long_name": "unit of a channel"}),
    }
    if hull is not None:
        data |= hull_variable(hull)
    asked = {**(inputs or {}), **({} if sea is None else sea.about)}
    attributes = {name: value for name, value in asked.items() if value is not None}
    written = DataSet(data, coordinates, {"title": title, "source": source, **attributes})
    with staged(folder, lambda temporary: _stale(folder, temporary)) as temporary:
        rows, header = np.stack(columns, axis=1), ",".join(names)
        np.savetxt(temporary / "motion.csv", rows, fmt="%.9g", delimiter=",", header=header, comments="")
        write_netcdf(written, temporary / "simulated.nc", dict.fromkeys(data, COMPRESSION))
        if "netcdf" in formats:
            about = {"title": f"Motion of {title}", "source": source, "platform": title, **asked}
            _write_netcdf(motion, temporary / FORMAT_FILES["netcdf"], about)
        if "outb" in formats:
            _write_outb(motion, temporary / FORMAT_FILES["outb"], f"{title}, {source}")
        if sea is not None:
            _statistics(sea, temporary, title, source)
        if figures:
            _draw(motion, sea, temporary, title)


def _write_netcdf(motion: Motion, path: Path, about: Mapping[str, Any]) -> None:
    """Write motion.nc after the CF conventions, a variable for each motion."""
    from jaxhydro.display.motion_dataset import motion_dataset  # with xarray, which takes long to import

    moved = dict(zip(DOFS, motion.values.T, strict=True))
    dataset = motion_dataset(motion.time, moved, motion.wave, about)
    packed: dict[str, Any] = {"zlib": True, "complevel": COMPRESSION, "_FillValue": None}
    dataset.to_netcdf(path, engine="h5netcdf", encoding=dict.fromkeys(map(str, dataset.variables), packed))


def _write_outb(motion: Motion, path: Path, about: str) -> None:
    """Write motion.outb with the names of ElastoDyn's and SeaState's channels."""
    names, columns = list(OPENFAST_MOTIONS), list(motion.values.T)
    units = [unit_of(dof) for dof in DOFS]
    if motion.wave is not None:
        names.append(OPENFAST_WAVE)
        units.append("m")
        columns.append(motion.wave)
    interval = (motion.time[-1] - motion.time[0]) / max(1, len(motion.time) - 1)
    write_outb(path, float(motion.time[0]), float(interval), names, units, np.stack(columns, axis=1), about)


def _draw(motion: Motion, sea: SeaState | None, folder: Path, title: str) -> None:
    from jaxhydro.plots.style import motion_figure, save, style  # matplotlib is imported where figures are drawn

    with style():
        if sea is not None and motion.wave is not None:
            _sea_figures(motion, motion.wave, sea, folder, title)
        else:
            figure = motion_figure(motion.time, dict(zip(DOFS, motion.values.T, strict=True)), motion.wave, title)
            save(figure, folder / "figures" / "motion.png")


def _statistics(sea: SeaState, folder: Path, title: str, source: str) -> None:
    """Write statistics.json."""
    text = {"platform": title, "source": source, "sea": dict(sea.about), **sea.results}
    (folder / STATISTICS).write_text(json.dumps(text, indent=2, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8")


def _sea_figures(motion: Motion, wave: np.ndarray, sea: SeaState, folder: Path, title: str) -> None:
    from jaxhydro.plots import seas as sea_plot
    from jaxhydro.plots.style import save

    time, channels, start = motion.time, in_order(motion.values, wave), sea.results["window"][0]
    second = sea.first_order if sea.about["order"] == 2 else None
    windowed = {name: values[time >= start] for name, values in channels.items()}
    height, peak = sea.about["significant_wave_height"], sea.about["peak_period"]
    title += f"\nHs {height:.3g} m" + (f", Tp {peak:.3g} s" if peak else ", white")
    for name, figure in (
        ("motion", sea_plot.record_figure(time, channels, start, title)),
        ("window", sea_plot.window_figure(time, channels, second, start, title)),
        ("spectra", sea_plot.spectra_figure(time[time >= start], windowed, peak, MAX_PLOTTED_FREQUENCY, sea.target, title)),
    ):
        save(figure, folder / "figures" / f"{name}.png")


def _stale(folder: Path, temporary: Path) -> Iterable[str]:
    """Files of an earlier simulation that the new one does not write, and the report of it."""
    if (folder / "motion.csv").is_file():
        yield from (
            name for name in (*OF_SEAS, *FORMAT_FILES.values()) if (folder / name).is_file() and not (temporary / name).exists()
        )
        if own_report(folder / REPORT_FILE):
            yield REPORT_FILE
