"""Outputs of a finished sweep beside its store: sweep.json, lifetime.csv and two figures."""

import csv
import json
import math
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

import jaxhydro
from jaxhydro.environment import DOFS
from jaxhydro.files import staged
from jaxhydro.plots.style import save, style
from jaxhydro.sweep.cases import State, runs_in_words
from jaxhydro.sweep.lifetime import Lifetime, lifetime
from jaxhydro.sweep.store import DONE, FAILED
from jaxhydro.sweep.sweep_figures import exceedance_figure, scatter_figure

PANELS = ("surge", "heave", "pitch")  # whose maxima are drawn, where they move
MAX_LISTED_FAILURES = 1000  # listed in sweep.json; all are in the store
OPTIONS = (
    "duration",
    "start",
    "time_step",
    "step",
    "spectrum",
    "amplitudes",
    "low",
    "cutoff",
    "order",
    "stretching",
    "diffraction",
    "equivalent_frequency",
)
MIN_DEVIATION = 1e-6  # m, deg


class Failure(NamedTuple):
    """Runs of one sea state that failed for one reason.

    Attributes:
        hs: Significant wave height (m).
        tp: Peak period (s).
        gamma: Peak enhancement (-), or None.
        headings: Headings (deg) of these runs.
        seeds: Seeds of these runs.
        runs: Number of runs.
        reason: Why they failed.
    """

    hs: float
    tp: float
    gamma: float | None
    headings: list[float]
    seeds: list[int]
    runs: int
    reason: str

    @property
    def where(self) -> str:
        """The runs in words."""
        return runs_in_words(self[:3], self.headings, self.seeds)


class Summary(NamedTuple):
    """Summary of a sweep.

    Attributes:
        total: Number of runs.
        done: Number of runs done.
        failed: Number of runs that failed.
        missing: Probability of cases without a run done.
        lifetimes: Lifetime statistics by channel.
        units: Unit of each channel.
        failures: Failed runs, by sea state and reason.
    """

    total: int
    done: int
    failed: int
    missing: float
    lifetimes: dict[str, Lifetime]
    units: dict[str, str]
    failures: list[Failure]


def summary_of(data: xr.Dataset) -> Summary:
    """Summary of the results of a sweep, finished or not."""
    status, found = data.status.values, data.statistics.load()
    probability = data.probability.values
    names, exponents = [str(name) for name in data.statistic.values], data.exponent.values

    lifetimes = {}
    for channel in map(str, data.channel.values):
        values = found.sel(channel=channel).values
        mean, deviation, least, most = (
            values[..., names.index(name)] for name in ("mean", "standard_deviation", "minimum", "maximum")
        )
        ranges = data.ranges.sel(channel=channel).values
        lifetimes[channel] = lifetime(probability, mean, deviation, least, most, ranges, exponents)
    units = dict(zip(map(str, data.channel.values), map(str, data.unit.values)))
    missing = float(probability[~(status == DONE).any(axis=1)].sum())
    done, failed = (int((status == one).sum()) for one in (DONE, FAILED))
    return Summary(status.size, done, failed, missing, lifetimes, units, _failures(data))


def _failures(data: xr.Dataset) -> list[Failure]:
    alike: dict[tuple[State, str], list[tuple[float, int]]] = {}
    states, headings, seeds, reasons = _states(data), data.heading.values, data.seed.values, data.reason.values
    for row, column in zip(*np.nonzero(data.status.values == FAILED)):
        key = states[row], str(reasons[row, column])
        alike.setdefault(key, []).append((float(headings[row]), int(seeds[column])))
    found = []
    for ((hs, tp, gamma), reason), runs in alike.items():
        towards, drawn = zip(*runs)
        found.append(Failure(hs, tp, gamma, sorted(set(towards)), sorted(set(drawn)), len(runs), reason))
    return found


def _states(data: xr.Dataset) -> list[State]:
    """Sea state of every case."""
    columns = (data[name].values.tolist() for name in ("hs", "tp", "gamma"))
    return [(hs, tp, None if math.isnan(gamma) else gamma) for hs, tp, gamma in zip(*columns)]


def write_outputs(folder: Path, data: xr.Dataset, summary: Summary, about: dict[str, Any]) -> None:
    """Write the output files, all or none.

    Args:
        folder: Folder of the sweep.
        data: Results of the sweep.
        summary: Their summary.
        about: First entries of sweep.json.
    """
    with staged(folder) as temporary:
        (temporary / "sweep.json").write_text(_document(data, summary, about), encoding="utf-8")
        with (temporary / "lifetime.csv").open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows(_table(summary, data.exponent.values))
        if summary.done:
            with style():
                _figures(temporary, data, summary, str(about["platform"]))


def _document(data: xr.Dataset, summary: Summary, about: dict[str, Any]) -> str:
    runs = {"total": summary.total, "done": summary.done, "failed": summary.failed}
    lifetimes = {
        channel: {"unit": summary.units[channel]}
        | {name: _plain(value) for name, value in one._asdict().items() if name != "ranges"}
        | {"damage_equivalent_range": {f"{m:g}": _plain(r) for m, r in zip(data.exponent.values, one.ranges)}}
        for channel, one in summary.lifetimes.items()
    }
    headings: dict[float, float] = {}
    for heading, share in zip(data.heading.values.tolist(), data.probability.values.tolist()):
        headings[heading] = headings.get(heading, 0.0) + share
    document = about | {
        "source": f"jaxhydro {jaxhydro.__version__}",
        "fingerprint": data.attrs["fingerprint"],
        "runs": runs,
        "sea_states": len(set(_states(data))),
        "cases": data.sizes["case"],
        "headings": [{"heading": heading, "probability": float(f"{share:.12g}")} for heading, share in headings.items()],
        "seeds": data.seed.values.tolist(),
        "options": {name: data.attrs[name] for name in OPTIONS if name in data.attrs},
        "probability_without_runs": summary.missing,
        "lifetime": lifetimes,
        "failures": [one._asdict() for one in summary.failures[:MAX_LISTED_FAILURES]],
    }
    return json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _table(summary: Summary, exponents: np.ndarray) -> list[list[str]]:
    fields = [name for name in Lifetime._fields if name != "ranges"]
    rows = [["channel", "unit", *fields, *(f"damage_equivalent_range_m{m:g}" for m in exponents)]]
    for channel, one in summary.lifetimes.items():
        values = [getattr(one, name) for name in fields] + list(one.ranges)
        rows.append([channel, summary.units[channel], *(f"{value:.6g}" if math.isfinite(value) else "" for value in values)])
    return rows


def _figures(folder: Path, data: xr.Dataset, summary: Summary, platform: str) -> None:
    names = [str(name) for name in data.statistic.values]
    found, probability = data.statistics, data.probability.values
    moving = {name: one for name, one in summary.lifetimes.items() if name in DOFS and one.standard_deviation > MIN_DEVIATION}
    first = "surge" if "surge" in moving else next(iter(moving), "wave")
    square = found.sel(channel=first).values[..., names.index("standard_deviation")] ** 2
    count = np.isfinite(square).sum(axis=1)
    deviation = np.sqrt(np.nansum(square, axis=1) / np.where(count > 0, count, np.nan))
    label = f"{first.capitalize()}, standard deviation ({summary.units[first]})"
    figure = scatter_figure(data.hs.values, data.tp.values, probability, deviation, label, platform)
    save(figure, folder / "scatter.png")
    panels = [name for name in PANELS if name in moving] or list(moving)[:3] or ["wave"]
    minima, maxima = (
        [found.sel(channel=name).values[..., names.index(one)] for name in panels] for one in ("minimum", "maximum")
    )
    labels = [f"{name} ({summary.units[name]})" for name in panels]
    duration = float(data.attrs["duration"]) - float(data.attrs["start"])
    save(exceedance_figure(labels, minima, maxima, probability, duration, platform), folder / "exceedance.png")


def _plain(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
