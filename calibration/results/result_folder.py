"""Names of the files in a result folder, and helpers that write them."""

import json
import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import xarray as xr

RESULT_FILE, MOTION_FILE, FIGURES_FOLDER, REPORT_FILE = "calibration.json", "simulated.nc", "figures", "report.html"
COMPARISON_FILE = "comparison.json"  # of a campaign's seas
DIAGNOSIS_FILE = "diagnosis.json"  # of a calibration and what it lacks
UNCERTAINTY_FILE = "uncertainty.json"  # of a calibration's parameters
LAWS_FILE, TABLE_FILE = "sea_laws.json", "coefficients.csv"  # of a calibration with laws over the sea state
GENERATOR = '<meta name="generator" content="jaxhydro'  # in a report of ours


def draw(figures: Iterable[tuple[str, str, Any]], folder: Path) -> list[dict[str, str]]:
    """Save matplotlib figures, each with its file's name and its caption, below a folder, and list them as result files do.
    `figures` is a generator, which draws when asked to: in the package's style."""
    from jaxhydro.plots.style import save, style

    drawn = []
    with style():
        for name, caption, figure in figures:
            save(figure, folder / FIGURES_FOLDER / name)
            drawn.append({"file": f"{FIGURES_FOLDER}/{name}", "caption": caption})
    return drawn


def write_json(content: dict[str, Any], file: Path) -> None:
    """Write a result file. Raises ValueError for numbers that JSON does not have."""
    file.write_text(json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8")


def write_motion(motion: xr.Dataset, folder: Path) -> None:
    """Write the series, packed, as simulated.nc."""
    packed = {name: {"zlib": True, "complevel": 4} for name, one in motion.data_vars.items() if one.ndim > 1 and one.size}
    motion.to_netcdf(folder / MOTION_FILE, engine="h5netcdf", encoding=packed)


def finite_or_null(value: float | None) -> float | None:
    """A number as JSON has it; null for what is none."""
    return float(value) if value is not None and math.isfinite(value) else None


def outdated(folder: Path, temporary: Path, result: str = RESULT_FILE) -> Iterable[str]:
    """What an earlier run wrote and the new one does not: its figures, by its own list, and its report."""
    try:
        listed = json.loads((folder / result).read_text(encoding="utf-8"))["figures"]
        names = [Path(figure["file"]).name for figure in listed]
    except (OSError, ValueError, KeyError, TypeError):
        names = []
    for name in names:
        if (
            name.endswith(".png")
            and (folder / FIGURES_FOLDER / name).is_file()
            and not (temporary / FIGURES_FOLDER / name).exists()
        ):
            yield f"{FIGURES_FOLDER}/{name}"
    if result == RESULT_FILE and (folder / LAWS_FILE).is_file():
        yield from (name for name in (LAWS_FILE, TABLE_FILE) if (folder / name).is_file())
        yield from (f"{FIGURES_FOLDER}/{path.name}" for path in (folder / FIGURES_FOLDER).glob("sea-law-*.png"))
    report = folder / REPORT_FILE
    if report.is_file() and GENERATOR in report.read_text(encoding="utf-8", errors="replace")[:1000]:
        yield REPORT_FILE
