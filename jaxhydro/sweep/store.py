"""Store of a sweep: results.zarr and the inputs it was made of.

The store (zarr v3, for `xarray.open_zarr`) is whole from the beginning. Every variable has one chunk per run, so writers
never share one. A run's numbers are written first and its status last, each chunk by renaming a finished file. A process
killed at any moment leaves a run that is done or one to be repeated.
"""

import json
import shutil
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
import zarr
from filelock import FileLock, Timeout
from jaxtyping import Float

import jaxhydro
from jaxhydro.analysis.sea_statistics import bands_of
from jaxhydro.errors import InputError, Problem
from jaxhydro.files import staged
from jaxhydro.fingerprint import computed_with, content_hash, fingerprint
from jaxhydro.sweep.batch import CALIBRATION, PLAN, PLATFORM, Setup
from jaxhydro.sweep.cases import Plan, Run
from jaxhydro.sweep.run_statistics import BANDS, STATISTICS, RunResults, frequencies, unit
from jaxhydro.sweep.sea_states import UNITS

RESULTS, INPUTS, UNFINISHED, LOCK = "results.zarr", "inputs", ".results", ".lock"
TO_DO, DONE, FAILED = 0, 1, 2
FINGERPRINT_LENGTH = 16  # characters of a fingerprint in files
RESULT_VARIABLES = {  # variable: its dimensions after case and seed, and what it is
    "statistics": (("channel", "statistic"), "in units of the channel; skewness and kurtosis 1, zero_crossing_period s"),
    "density": (("channel", "frequency"), "one-sided power spectral density, unit of the channel squared per Hz"),
    "bands": (("channel", "band"), "integral of the density over the band, unit of the channel squared"),
    "ranges": (("channel", "exponent"), "damage-equivalent range, unit of the channel"),
    "series": (("channel", "time"), "records, unit of the channel, transient included"),
}


class Inputs(NamedTuple):
    """Inputs of a store, as text.

    Attributes:
        plan: Cases, seeds and options.
        platform: Platform file.
        calibration: Calibration file, or None.
    """

    plan: Plan
    platform: str
    calibration: str | None

    @property
    def fingerprint(self) -> str:
        """Hash of the inputs and of the program that computes them."""
        return fingerprint(self.plan.to_json(), self.platform, self.calibration)[:FINGERPRINT_LENGTH]


@contextmanager
def locked_folder(folder: Path) -> Iterator[None]:
    """Lock the folder, made where absent, against other sweeps.

    Where the file system has no locks nothing is checked.

    Raises:
        InputError: Another sweep writes to the folder.
    """
    folder.mkdir(parents=True, exist_ok=True)
    lock = FileLock(folder / LOCK, fallback_to_soft=False)  # a soft lock outlives a killed process
    try:
        lock.acquire(timeout=0)
    except Timeout:
        actual = f"{str(folder)!r}, which another sweep writes now"
        raise InputError("--out", [Problem("", "a folder of its own", actual)]) from None
    except (NotImplementedError, OSError):
        pass
    try:
        yield
    finally:
        lock.release()


def create(folder: Path, inputs: Inputs, setup: Setup, shares: Float[np.ndarray, " c"]) -> None:
    """Write the folder's inputs and its store, with all runs to do.

    Args:
        folder: Folder of the sweep.
        inputs: Plan, platform file and calibration file.
        setup: Model and options that all runs share.
        shares: Fraction of each case's spectrum within the band, (case,).

    Raises:
        InputError: They cannot be written.
    """
    discard(folder)
    with staged(folder) as temporary:
        made = temporary / INPUTS
        made.mkdir()
        (made / PLAN).write_text(inputs.plan.to_json(), encoding="utf-8")
        (made / PLATFORM).write_text(inputs.platform, encoding="utf-8")
        if inputs.calibration is not None:
            (made / CALIBRATION).write_text(inputs.calibration, encoding="utf-8")
    _arrays(folder / UNFINISHED, inputs, setup, shares)
    (folder / UNFINISHED).rename(folder / RESULTS)


def discard(folder: Path) -> None:
    """Remove a store, its inputs and its outputs."""
    shutil.rmtree(folder / UNFINISHED, ignore_errors=True)
    if (folder / RESULTS).is_dir():
        (folder / RESULTS).rename(folder / UNFINISHED)  # at once no store any more
    for name in (UNFINISHED, INPUTS):
        shutil.rmtree(folder / name, ignore_errors=True)
    for name in ("sweep.json", "lifetime.csv", "scatter.png", "exceedance.png", "report.html"):
        (folder / name).unlink(missing_ok=True)


def check_same(folder: Path, inputs: Inputs) -> None:
    """Raise InputError where the folder's store was made of other inputs or by another program."""
    inputs_folder = folder / INPUTS
    problems = []
    try:
        old = Inputs(
            Plan.from_json((inputs_folder / PLAN).read_text(encoding="utf-8")),
            (inputs_folder / PLATFORM).read_text(encoding="utf-8"),
            (inputs_folder / CALIBRATION).read_text(encoding="utf-8") if (inputs_folder / CALIBRATION).is_file() else None,
        )
    except (OSError, ValueError, TypeError, KeyError) as error:
        actual = f"{str(inputs_folder)!r}, which cannot be read ({error})"
        raise InputError("--out", [Problem("", "a folder with a sweep's inputs", actual, RESTART_HINT)]) from None
    for key, before, now in old.plan.differences(inputs.plan):
        problems.append(Problem(key, f"{before}, as in the runs that are there", now, RESTART_HINT))
    for name, noun in (("platform", "platform file"), ("calibration", "calibration")):
        if getattr(old, name) != getattr(inputs, name):
            problems.append(Problem(name, f"the {noun} of the runs that are there", "another", RESTART_HINT))
    try:
        group = zarr.open_group(folder / RESULTS, mode="r", zarr_format=3, use_consolidated=False)
        made_by: Any = group.attrs.get("computed_with")
    except (OSError, ValueError, KeyError):  # of another format
        made_by = None
    for name, now in computed_with().items():
        earlier = made_by.get(name) if isinstance(made_by, dict) else None
        if earlier != now:
            told = "another" if name == "source code" else now
            were = "that" if name == "source code" else f"{earlier or 'that'},"
            problems.append(Problem(name, f"{were} which made the runs that are there", told, RESTART_HINT))
    if problems:
        raise InputError(f"--out {folder}", problems[:1])


RESTART_HINT = "Another --out keeps both; --restart begins anew."


class Store:
    """Open store, to write runs to."""

    def __init__(self, folder: Path) -> None:
        self.group = zarr.open_group(folder / RESULTS, mode="r+", zarr_format=3, use_consolidated=False)
        self.arrays: dict[str, Any] = {name: array for name, array in self.group.arrays()}

    def status(self) -> np.ndarray:
        """Status of every run by number: TO_DO, DONE or FAILED."""
        return np.asarray(self.arrays["status"][:]).reshape(-1)

    def write(self, run: Run, outcome: RunResults | str) -> bool:
        """Write the results of a run, or the reason why it failed; whether it is done."""
        index = (run.row, run.column)
        if isinstance(outcome, str):
            self.arrays["reason"][index] = outcome
            self.arrays["status"][index] = FAILED
            return False
        if self.arrays["status"][index] == FAILED:
            self.arrays["reason"][index] = ""
        for name in RESULT_VARIABLES:
            values = getattr(outcome, name)
            if values is not None:
                self.arrays[name][index] = values
        self.arrays["status"][index] = DONE
        return True


def open_results(folder: Path) -> xr.Dataset:
    """Results of a sweep; variables are loaded from disk where used."""
    data = xr.open_zarr(folder / RESULTS, chunks=None, zarr_format=3)
    return data.assign_coords({name: coordinate.load() for name, coordinate in data.coords.items()})


def _arrays(path: Path, inputs: Inputs, setup: Setup, shares: Float[np.ndarray, " c"]) -> None:
    plan, channels = inputs.plan, setup.channels
    window = setup.times[setup.times >= plan.start]
    sizes: dict[str, Any] = {
        "case": np.arange(len(plan.cases)),
        "seed": np.array(plan.seeds),
        "channel": channels,
        "statistic": STATISTICS,
        "frequency": frequencies(window),
        "band": BANDS,
        "exponent": np.array(plan.exponents),
        "time": setup.times,
    }
    if not plan.time_series:
        del sizes["time"]
    units = {"frequency": "Hz", "time": "s"}
    limits = np.full((len(plan.cases), len(channels), len(BANDS), 2), np.nan)
    for i, case in enumerate(plan.cases):
        for j, channel in enumerate(channels):
            for band, edges in bands_of(channel, case.state.peak_period).items():
                limits[i, j, BANDS.index(band)] = edges
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of consolidated metadata, which xarray asks for
        group = zarr.create_group(path, zarr_format=3, attributes=_about(inputs, setup))
        for name, values in sizes.items():
            _coordinate(group, name, (name,), values, units.get(name, ""))
        for name, its in (("hs", "m"), ("tp", "s"), ("heading", "deg"), ("probability", "1")):
            _coordinate(group, name, ("case",), np.array([getattr(case, name) for case in plan.cases], float), its)
        gamma = np.array([np.nan if case.gamma is None else case.gamma for case in plan.cases])
        _coordinate(group, "gamma", ("case",), gamma, "1")
        for name, its in UNITS.items():
            column = np.array([getattr(case, name) for case in plan.cases], float)  # None: NaN
            if name not in ("hs", "tp") and not np.isnan(column).all():
                _coordinate(group, name, ("case",), column, its)
        _coordinate(group, "spectrum_share", ("case",), shares, "1")
        _coordinate(group, "unit", ("channel",), [unit(channel) for channel in channels], "")
        _coordinate(group, "band_limits", ("case", "channel", "band", "edge"), limits, "Hz")
        runs = (len(plan.cases), len(plan.seeds))
        flags: dict[str, Any] = {"flag_values": [TO_DO, DONE, FAILED], "flag_meanings": "to_do done failed"}
        reasons: dict[str, Any] = {"long_name": "why a run failed"}
        for name, dtype, fill, about in (("status", "u1", TO_DO, flags), ("reason", "string", "", reasons)):
            group.create_array(
                name,
                shape=runs,
                chunks=(1, 1),
                dtype=dtype,
                fill_value=fill,
                dimension_names=("case", "seed"),
                attributes=about,
            )
        for name, (dims, text) in RESULT_VARIABLES.items():
            if name == "series" and not plan.time_series:
                continue
            shape = tuple(len(sizes[dim]) for dim in dims)
            group.create_array(
                name,
                shape=runs + shape,
                chunks=(1, 1, *shape),
                dtype="f8",
                fill_value=np.nan,
                dimension_names=("case", "seed", *dims),
                attributes={"long_name": text},
            )
        zarr.consolidate_metadata(group.store)


def _coordinate(group: zarr.Group, name: str, dims: tuple[str, ...], values: Any, units: str) -> None:
    text = not isinstance(values, np.ndarray)
    data = np.array(list(values), dtype=np.dtypes.StringDType()) if text else values
    about: dict[str, Any] = {"units": units} if units else {}
    array = group.create_array(
        name,
        shape=data.shape,
        chunks=data.shape,
        dtype="string" if text else data.dtype,
        dimension_names=dims,
        attributes=about,
    )
    array[...] = data


def _about(inputs: Inputs, setup: Setup) -> dict[str, Any]:
    plan = json.loads(inputs.plan.to_json())
    options = {name: value for name, value in plan.items() if name not in ("cases", "seeds") and value is not None}
    about = {"diffraction": "none" if setup.model.cylinders is None else setup.model.conventions.diffraction}
    coordinates = "hs tp gamma heading probability spectrum_share unit band_limits"
    return (
        options
        | about
        | {
            "source": f"jaxhydro {jaxhydro.__version__}",
            "fingerprint": inputs.fingerprint,
            "fingerprint_platform": content_hash(inputs.platform)[:FINGERPRINT_LENGTH],
            "fingerprint_calibration": content_hash(inputs.calibration)[:FINGERPRINT_LENGTH]
            if inputs.calibration is not None
            else "",
            "computed_with": computed_with(),
            "units": "m, s, Hz, deg, N",
            "coordinates": coordinates,
        }
    )
