"""Outputs of a finished sweep beside its store: sweep.json, lifetime.csv and two figures."""

import csv
import math
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

import jaxhydro
from jaxhydro.environment import DOFS
from jaxhydro.files import staged
from jaxhydro.plots.style import save, style
from jaxhydro.result_model import finite_or_null, stated
from jaxhydro.sweep.lifetime import lifetime
from jaxhydro.sweep.sea_states import State
from jaxhydro.sweep.store_layout import DONE, FAILED
from jaxhydro.sweep.sweep_figures import exceedance_figure, scatter_figure
from jaxhydro.sweep.sweep_results import Failure, Heading, LifetimeStatistics, RunCounts, SweepOptions, SweepResults

PANELS = ("surge", "heave", "pitch")  # whose maxima are drawn, where they move
MAX_LISTED_FAILURES = 1000  # listed in sweep.json; all are in the store
MIN_DEVIATION = 1e-6  # m, deg


def results_of(data: xr.Dataset, about: dict[str, Any]) -> SweepResults:
    """Content of sweep.json, of a sweep finished or not.

    Args:
        data: Results of the sweep.
        about: Its first entries: `sweep`, `platform`, `notes`, `calibration`.
    """
    status, statistics = data.status.values, data.statistics.load()
    probability, exponents = data.probability.values, data.exponent.values
    names = [str(name) for name in data.statistic.values]
    lifetimes = {}
    for channel, unit in zip(map(str, data.channel.values), map(str, data.unit.values)):
        values = statistics.sel(channel=channel).values
        mean, deviation, least, most = (
            values[..., names.index(name)] for name in ("mean", "standard_deviation", "minimum", "maximum")
        )
        ranges = data.ranges.sel(channel=channel).values
        channel_lifetime = lifetime(probability, mean, deviation, least, most, ranges, exponents)
        lifetimes[channel] = LifetimeStatistics(
            unit=unit,
            **{name: finite_or_null(value) for name, value in channel_lifetime._asdict().items() if name != "ranges"},
            damage_equivalent_range={f"{m:g}": finite_or_null(r) for m, r in zip(exponents, channel_lifetime.ranges)},
        )
    headings: dict[float, float] = {}
    for heading, share in zip(data.heading.values.tolist(), probability.tolist()):
        headings[heading] = headings.get(heading, 0.0) + share
    done, failed = (int((status == flag).sum()) for flag in (DONE, FAILED))
    return SweepResults(
        **about,
        source=f"jaxhydro {jaxhydro.__version__}",
        fingerprint=data.attrs["fingerprint"],
        runs=RunCounts(total=status.size, done=done, failed=failed),
        sea_states=len(set(_states(data))),
        cases=data.sizes["case"],
        headings=[Heading(heading=heading, probability=float(f"{share:.12g}")) for heading, share in headings.items()],
        seeds=data.seed.values.tolist(),
        options=SweepOptions.model_validate({k: data.attrs[k] for k in SweepOptions.model_fields if k in data.attrs}),
        probability_without_runs=float(probability[~(status == DONE).any(axis=1)].sum()),
        lifetime=lifetimes,
        failures=_failures(data),
    )


def _failures(data: xr.Dataset) -> list[Failure]:
    alike: dict[tuple[State, str], list[tuple[float, int]]] = {}
    states, headings, seeds, reasons = _states(data), data.heading.values, data.seed.values, data.reason.values
    for row, column in zip(*np.nonzero(data.status.values == FAILED)):
        key = states[row], str(reasons[row, column])
        alike.setdefault(key, []).append((float(headings[row]), int(seeds[column])))
    failures = []
    for (state, reason), runs in alike.items():
        towards, drawn = zip(*runs)
        failures.append(
            Failure(
                hs=state.hs,
                tp=state.tp,
                gamma=state.gamma,
                **stated(**dict(zip(State._fields[3:], state[3:]))),
                headings=sorted(set(towards)),
                seeds=sorted(set(drawn)),
                runs=len(runs),
                reason=reason,
            )
        )
    return failures


def _states(data: xr.Dataset) -> list[State]:
    """Sea state of every case."""
    names = [name for name in State._fields if name in data]
    rows = zip(*(data[name].values.tolist() for name in names))
    stated: list[dict[str, Any]] = [{n: None if math.isnan(value) else value for n, value in zip(names, row)} for row in rows]
    return [State(**entry) for entry in stated]


def write_outputs(folder: Path, data: xr.Dataset, results: SweepResults) -> None:
    """Write the output files, all or none.

    Args:
        folder: Folder of the sweep.
        data: Results of the sweep.
        results: Content of sweep.json.
    """
    with staged(folder) as temporary:
        listed = results.model_copy(update={"failures": results.failures[:MAX_LISTED_FAILURES]})
        listed.write(temporary / "sweep.json")
        with (temporary / "lifetime.csv").open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows(_table(results))
        if results.runs.done:
            with style():
                _figures(temporary, data, results)


def _table(results: SweepResults) -> list[list[str]]:
    fields = [name for name in LifetimeStatistics.model_fields if name not in ("unit", "damage_equivalent_range")]
    exponents = next(iter(results.lifetime.values())).damage_equivalent_range
    rows = [["channel", "unit", *fields, *(f"damage_equivalent_range_m{m}" for m in exponents)]]
    for channel, entry in results.lifetime.items():
        values = [getattr(entry, name) for name in fields] + list(entry.damage_equivalent_range.values())
        rows.append([channel, entry.unit, *("" if value is None else f"{value:.6g}" for value in values)])
    return rows


def _figures(folder: Path, data: xr.Dataset, results: SweepResults) -> None:
    names = [str(name) for name in data.statistic.values]
    statistics, probability, lifetimes, platform = data.statistics, data.probability.values, results.lifetime, results.platform
    moving = [name for name, entry in lifetimes.items() if name in DOFS and (entry.standard_deviation or 0.0) > MIN_DEVIATION]
    first = "surge" if "surge" in moving else next(iter(moving), "wave")
    square = statistics.sel(channel=first).values[..., names.index("standard_deviation")] ** 2
    count = np.isfinite(square).sum(axis=1)
    deviation = np.sqrt(np.nansum(square, axis=1) / np.where(count > 0, count, np.nan))
    label = f"{first.capitalize()}, standard deviation ({lifetimes[first].unit})"
    figure = scatter_figure(data.hs.values, data.tp.values, probability, deviation, label, platform)
    save(figure, folder / "scatter.png")
    panels = [name for name in PANELS if name in moving] or moving[:3] or ["wave"]
    minima, maxima = (
        [statistics.sel(channel=name).values[..., names.index(statistic)] for name in panels]
        for statistic in ("minimum", "maximum")
    )
    labels = [f"{name} ({lifetimes[name].unit})" for name in panels]
    duration = float(data.attrs["duration"]) - float(data.attrs["start"])
    save(exceedance_figure(labels, minima, maxima, probability, duration, platform), folder / "exceedance.png")
