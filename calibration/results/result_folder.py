"""Folders of results: the names of what is in them, and how every kind is written."""

import json
import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import xarray as xr

RESULT, MOTION, FIGURES, REPORT = "calibration.json", "simulated.nc", "figures", "report.html"
COMPARISON = "comparison.json"  # of a campaign's seas
DIAGNOSIS = "diagnosis.json"  # of a calibration and what it lacks
UNCERTAINTY = "uncertainty.json"  # of a calibration's parameters
LAWS, TABLE = "sea_laws.json", "coefficients.csv"  # of a calibration with laws over the sea state
GENERATOR = '<meta name="generator" content="jaxhydro'  # in a report of ours


def draw(figures: Iterable[tuple[str, str, Any]], folder: Path) -> list[dict[str, str]]:
    """Save matplotlib figures, each with its file's name and its caption, below a folder, and list them as result files do.
    `figures` is a generator, which draws when asked to: in the package's style."""
    from jaxhydro.plots.style import save, style

    drawn = []
    with style():
        for name, caption, figure in figures:
            save(figure, folder / FIGURES / name)
            drawn.append({"file": f"{FIGURES}/{name}", "caption": caption})
    return drawn


def write_json(content: dict[str, Any], file: Path) -> None:
    """Write a result file. Raises ValueError for numbers that JSON does not have."""
    file.write_text(json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8")


def write_motion(motion: xr.Dataset, folder: Path) -> None:
    """Write the series, packed, as simulated.nc."""
    packed = {name: {"zlib": True, "complevel": 4} for name, one in motion.data_vars.items() if one.ndim > 1 and one.size}
    motion.to_netcdf(folder / MOTION, engine="h5netcdf", encoding=packed)


def or_null(value: float | None) -> float | None:
    """A number as JSON has it; null for what is none."""
    return float(value) if value is not None and math.isfinite(value) else None


def outdated(folder: Path, temporary: Path, result: str = RESULT) -> Iterable[str]:
    """What an earlier run wrote and the new one does not: its figures, by its own list, and its report."""
    try:
        listed = json.loads((folder / result).read_text(encoding="utf-8"))["figures"]
        names = [Path(figure["file"]).name for figure in listed]
    except (OSError, ValueError, KeyError, TypeError):
        names = []
    for name in names:
        if name.endswith(".png") and (folder / FIGURES / name).is_file() and not (temporary / FIGURES / name).exists():
            yield f"{FIGURES}/{name}"
    if result == RESULT and (folder / LAWS).is_file():
        yield from (name for name in (LAWS, TABLE) if (folder / name).is_file())
        yield from (f"{FIGURES}/{path.name}" for path in (folder / FIGURES).glob("sea-law-*.png"))
    report = folder / REPORT
    if report.is_file() and GENERATOR in report.read_text(encoding="utf-8", errors="replace")[:1000]:
        yield REPORT
