"""What a finished sweep leaves beside its store: sweep.json, lifetime.csv and two figures."""

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
from jaxhydro.plot import save, style
from jaxhydro.sweep.lifetime import Lifetime, lifetime
from jaxhydro.sweep.plot import exceedance_figure, scatter_figure
from jaxhydro.sweep.store import DONE, FAILED

PANELS = ("surge", "heave", "pitch")  # whose maxima are drawn, where they move
FAILURES = 1000  # listed in sweep.json; all are in the store
STILL = 1e-6  # m, deg


class Summary(NamedTuple):
    """Runs in all, done and failed; lifetime statistics by channel; share of the time without a single run done; failures."""

    total: int
    done: int
    failed: int
    missing: float
    lifetimes: dict[str, Lifetime]
    units: dict[str, str]
    failures: list[dict[str, Any]]


def summary_of(data: xr.Dataset) -> Summary:
    """From the results of a sweep, finished or not."""
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
    failures = []
    for row, column in zip(*np.nonzero(status == FAILED)):
        case = {name: float(data[name].values[row]) for name in ("hs", "tp", "heading", "probability")}
        failures.append(case | {"seed": int(data.seed.values[column]), "reason": str(data.reason.values[row, column])})
    units = dict(zip(map(str, data.channel.values), map(str, data.unit.values)))
    missing = float(probability[~(status == DONE).any(axis=1)].sum())
    return Summary(status.size, int((status == DONE).sum()), len(failures), missing, lifetimes, units, failures)


def write_outputs(folder: Path, data: xr.Dataset, summary: Summary, about: dict[str, Any]) -> None:
    """Write the files, whole or not at all. `about` is what sweep.json says first."""
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
    document = about | {
        "source": f"jaxhydro {jaxhydro.__version__}", "fingerprint": data.attrs["fingerprint"], "runs": runs,
        "cases": data.sizes["case"], "seeds": data.seed.values.tolist(), "probability_without_runs": summary.missing,
        "lifetime": lifetimes, "failures": summary.failures[:FAILURES],
    }  # fmt: skip
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
    moving = {name: one for name, one in summary.lifetimes.items() if name in DOFS and one.standard_deviation > STILL}
    first = "surge" if "surge" in moving else next(iter(moving), "wave")
    square = found.sel(channel=first).values[..., names.index("standard_deviation")] ** 2
    count = np.isfinite(square).sum(axis=1)
    deviation = np.sqrt(np.nansum(square, axis=1) / np.where(count > 0, count, np.nan))
    label = f"{first.capitalize()}, standard deviation ({summary.units[first]})"
    figure = scatter_figure(data.hs.values, data.tp.values, probability, deviation, label, platform)
    save(figure, folder / "scatter.png")
    panels = [name for name in PANELS if name in moving] or list(moving)[:3] or ["wave"]
    maxima = [found.sel(channel=name).values[..., names.index("maximum")] for name in panels]
    labels = [f"{name} ({summary.units[name]})" for name in panels]
    duration = float(data.attrs["duration"]) - float(data.attrs["start"])
    save(exceedance_figure(labels, maxima, probability, duration, platform), folder / "exceedance.png")


def _plain(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
