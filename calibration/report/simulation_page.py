"""HTML page of a simulation: of an irregular sea, of regular waves, or of a free decay."""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from calibration.formatting import listed, number, percent
from calibration.report.interactive import motion_view
from calibration.report.web_page import embedded, inputs_table, render, written_on
from calibration.results.read_result import file_error
from calibration.results.result_folder import FIGURES_FOLDER, MOTION_FILE
from calibration.vocabulary import Rows
from jaxhydro.analysis.sea_statistics import MIN_RANGE, moves, summary, tables
from jaxhydro.environment import DOFS

MOTIONS, STATISTICS = "motion.csv", "statistics.json"
FIGURES = {
    "spectra.png": "Spectra of the wave and of the motions; bands shaded.",
    "window.png": "The wave and the motions about the highest crest.",
    "motion.png": "The whole record.",
}
MIN_SHARE = 1e-2  # of the largest motion of its unit: a smaller one is in the tables, not in the sentence
SEA_PROPERTIES = {
    "spectrum": ("Spectrum", ""),
    "significant_wave_height": ("Significant wave height", "m"),
    "peak_period": ("Peak period", "s"),
    "peak_enhancement": ("Peak enhancement", ""),
    "record": ("Wave record", ""),
    "record_column": ("Column of the wave record", ""),
    "mismatch": ("Waves less the record, of the record", "%"),
    "share_of_record": ("Variance of the record that the waves have", "%"),
    "wave_height": ("Wave height", "m"),
    "wave_period": ("Wave period", "s"),
    "heading": ("Heading of the waves", "deg"),
    "seed": ("Seed", ""),
    "amplitudes": ("Amplitudes", ""),
    "lowest_frequency": ("Lowest frequency", "Hz"),
    "cutoff": ("Highest frequency", "Hz"),
    "components": ("Wave components", ""),
    "repeat_period": ("Waves repeat after", "s"),
    "order": ("Order of the waves", ""),
    "stretching": ("Wave stretching", ""),
    "diffraction": ("Diffraction", ""),
    "transient": ("Left out at the start", "s"),
    "ramp": ("Waves grow over the first", "s"),
    "step_at_most": ("Steps of at most", "s"),
}


class MotionSummary(NamedTuple):
    """Facts for the sentence on a simulation.

    Attributes:
        conditions: Sea or waves that the platform was in, such as "a sea of Hs 3.1 m, Tp 8.96 s".
        largest: Largest distance from zero (m, deg), standard deviation and unit of every motion that matters.
    """

    conditions: str
    largest: dict[str, tuple[float, float, str]]


def summary_of(attributes: Mapping[str, Any], statistics: Mapping[str, Any]) -> MotionSummary:
    """Summary of a simulation.

    Args:
        attributes: Attributes of simulated.nc.
        statistics: Statistics by channel, as in statistics.json.
    """
    sizes = {
        name: (max(abs(channel["minimum"]), abs(channel["maximum"])), channel["standard_deviation"], channel["unit"])
        for name, channel in statistics.items()
        if name in DOFS
    }
    most = {
        unit: max((size for size, _, size_unit in sizes.values() if size_unit == unit), default=0.0) for unit in ("m", "deg")
    }
    largest = {name: row for name, row in sizes.items() if row[0] > max(MIN_SHARE * most[row[2]], 1e-9)}
    return MotionSummary(_conditions(attributes), largest)


def _conditions(about: Mapping[str, Any]) -> str:
    height, period = about.get("significant_wave_height"), about.get("peak_period")
    if "record" in about:
        waves = f"the waves of {about['record']}"
        return f"{waves} (Hs {number(height, 3)} m)" if height else waves
    if height is not None:
        peak = f", Tp {number(period, 3)} s" if period else ", white noise"
        return f"a sea of Hs {number(height, 3)} m{peak}"
    if "wave_height" in about:
        return f"regular waves of {number(about['wave_height'], 3)} m, {number(about['wave_period'], 3)} s"
    return "still water"


def simulation_sentence(motion_summary: MotionSummary) -> str:
    """A simulation in one sentence.

    "In a sea of Hs 3.1 m, Tp 8.96 s the platform moves up to 2.1 m in surge and 1.4 deg in pitch (standard deviations 0.5 m
    and 0.4 deg)."
    """
    if not motion_summary.largest:
        return f"In {motion_summary.conditions} the platform does not move."
    most = listed([f"{number(size, 3)} {unit} in {name}" for name, (size, _, unit) in motion_summary.largest.items()])
    spread = listed([f"{number(deviation, 2)} {unit}" for _, deviation, unit in motion_summary.largest.values()])
    noun = "standard deviation" if len(motion_summary.largest) == 1 else "standard deviations"
    return f"In {motion_summary.conditions} the platform moves up to {most} ({noun} {spread})."


def page(folder: Path) -> str:
    """Text of the page of the simulation in a folder. Raises InputError where its files cannot be read."""
    try:
        with xr.open_dataset(folder / MOTION_FILE, engine="h5netcdf") as opened:
            data = opened.load()
        results = _results(data, folder)
        statistics, bands = tables(results)
        motion_summary = summary_of(data.attrs, results["statistics"])
        version = str(data.attrs["source"]).removeprefix("jaxhydro ")
        response = regular_response(data)
        title, window = str(data.attrs["title"]), results["window"]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise file_error(folder / MOTION_FILE, "series, as `jaxhydro simulate` writes them", f"others ({error})") from None
    about = dict(data.attrs)
    return render(
        "simulation",
        title=title,
        by="Simulation",
        version=version,
        date=written_on(folder / MOTION_FILE),
        sentence=response_sentence(motion_summary.conditions, response) if response else simulation_sentence(motion_summary),
        span=f"{window[0]:g} to {window[1]:g} s",
        statistics=(statistics[0], [row for row in statistics[1] if moves(results, row[0].split(" ")[0])]),
        still=listed(still) if (still := [name for name in results["statistics"] if not moves(results, name)]) else "",
        bands=bands,
        response=_response_table(response),
        conditions=(("Property", "Value"), list(_properties(about, data))),
        motion=motion_view(folder),
        images=embedded({folder / FIGURES_FOLDER / name: caption for name, caption in FIGURES.items()}).values(),
        inputs=inputs_table(version, platform=title, calibration=about.get("calibration")),
    )


def _results(data: xr.Dataset, folder: Path) -> dict[str, Any]:
    """Statistics as statistics.json has them; of the whole record where there is none."""
    path = folder / STATISTICS
    if path.is_file():
        statistics: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        return statistics
    values = {str(name): data["simulated"].sel(channel=name).values for name in data["channel"].values}
    waves = {"wave": data["wave"].values} if "wave" in data else {}
    return summary(data["time"].values, {**waves, **values}, None) | {"bands": {}}


class RegularResponse(NamedTuple):
    """Mean and amplitude (m, deg) of a motion in regular waves, and amplitude per m of wave amplitude."""

    unit: str
    mean: float
    amplitude: float
    per_metre: float


def regular_response(data: xr.Dataset) -> dict[str, RegularResponse]:
    """Response of every motion at the period of regular waves, by least squares.

    The last half of the record is used, in whole periods.

    Args:
        data: Content of simulated.nc.

    Returns:
        Responses of the motions that move; none where there are no regular waves.
    """
    if "wave_period" not in data.attrs:
        return {}
    time, period = data["time"].values, float(data.attrs["wave_period"])
    whole = max(1.0, np.floor(0.5 * (time[-1] - time[0]) / period)) * period
    keep = time >= time[-1] - whole - 1e-9
    phase = 2 * np.pi / period * time[keep]
    basis = np.stack([np.ones_like(phase), np.cos(phase), np.sin(phase)], axis=1)
    responses = {}
    for name, unit in zip(map(str, data["channel"].values), map(str, data["unit"].values), strict=True):
        values = data["simulated"].sel(channel=name).values[keep]
        mean, cosine, sine = map(float, np.linalg.lstsq(basis, values, rcond=None)[0])
        amplitude = float(np.hypot(cosine, sine))
        if np.ptp(values) > MIN_RANGE:
            responses[name] = RegularResponse(unit, mean, amplitude, amplitude / (0.5 * float(data.attrs["wave_height"])))
    return responses


def response_sentence(conditions: str, responses: Mapping[str, RegularResponse]) -> str:
    """The response to regular waves in one sentence.

    "In regular waves of 3 m, 10 s the amplitudes are 0.37 m in surge (0.25 m per m of wave amplitude) ..."
    """
    most = {
        unit: max((response.amplitude for response in responses.values() if response.unit == unit), default=0.0)
        for unit in ("m", "deg")
    }
    large = {name: response for name, response in responses.items() if response.amplitude > MIN_SHARE * most[response.unit]}
    amplitudes = [f"{number(response.amplitude, 3)} {response.unit} in {name}" for name, response in large.items()]
    each = [f"{number(response.per_metre, 2)} {response.unit}" for response in large.values()]
    return f"In {conditions} the amplitudes are {listed(amplitudes)} ({listed(each)} per m of wave amplitude)."


def _response_table(responses: Mapping[str, RegularResponse]) -> Rows:
    rows = [(name, response.unit, *(number(x, 3) for x in response[1:])) for name, response in responses.items()]
    return ("Motion", "Unit", "Mean", "Amplitude", "Per m of wave amplitude"), rows


def _properties(about: Mapping[str, Any], data: xr.Dataset) -> Iterator[tuple[str, str]]:
    time = data["time"].values
    for dof in DOFS:
        if (offset := about.get(f"release_{dof}")) is not None:
            yield f"Released in {dof} at", f"{number(float(offset), 4)} {'m' if dof in DOFS[:3] else 'deg'} from rest"
    yield "Duration, samples every", f"{number(time[-1] - time[0], 4)} s, {number(time[1] - time[0], 3)} s"
    for name, (words, unit) in SEA_PROPERTIES.items():
        value = about.get(name)
        if value is None:
            continue
        if unit == "%":
            yield words, percent(float(value))
        elif isinstance(value, str):
            yield words, value.replace("_", " ") if name != "record" else value
        else:
            yield words, f"{float(value):.4g} {unit}".strip()
