"""Layout of a sweep's store: its variables, coordinates and attributes."""

import json
import warnings
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import zarr
from jaxtyping import Float

import jaxhydro
from jaxhydro.analysis.sea_statistics import bands_of
from jaxhydro.fingerprint import computed_with, content_hash, fingerprint
from jaxhydro.sweep.batch import Setup
from jaxhydro.sweep.cases import Plan
from jaxhydro.sweep.run_statistics import BANDS, STATISTICS, frequencies, unit
from jaxhydro.sweep.sea_states import UNITS

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


def create_arrays(path: Path, inputs: Inputs, setup: Setup, shares: Float[np.ndarray, " c"]) -> None:
    """Create the store's arrays, all runs to do; `shares` is the fraction of each case's spectrum within the band."""
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
