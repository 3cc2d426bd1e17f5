"""Names of the files in a result folder, and helpers that write them."""

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from jaxhydro.files import REPORT_FILE, own_report
from jaxhydro.netcdf_file import COMPRESSION, DataSet, write_netcdf
from jaxhydro.result_model import ResultModel

RESULT_FILE, MOTION_FILE, FIGURES_FOLDER = "calibration.json", "simulated.nc", "figures"
COMPARISON_FILE = "comparison.json"  # of a campaign's seas
DIAGNOSIS_FILE = "diagnosis.json"  # of a calibration and what it lacks
UNCERTAINTY_FILE = "uncertainty.json"  # of a calibration's parameters
LAWS_FILE, TABLE_FILE = "sea_laws.json", "coefficients.csv"  # of a calibration with laws over the sea state


class Figure(ResultModel):
    """A figure: its file below the folder, and its caption."""

    file: str
    caption: str = ""


def draw(figures: Iterable[tuple[str, str, Any]], folder: Path) -> list[Figure]:
    """Save figures in the package's style.

    Args:
        figures: File name, caption and matplotlib figure of each; a generator, which draws when asked to.
        folder: Folder of the result.

    Returns:
        The figures as a result file lists them.
    """
    from jaxhydro.plots.style import save, style

    drawn = []
    with style():
        for name, caption, figure in figures:
            save(figure, folder / FIGURES_FOLDER / name)
            drawn.append(Figure(file=f"{FIGURES_FOLDER}/{name}", caption=caption))
    return drawn


def write_motion(motion: DataSet, folder: Path) -> None:
    """Write the series, packed, as simulated.nc."""
    packed = [name for name, (_, values, _) in motion.variables.items() if values.ndim > 1 and values.size]
    write_netcdf(motion, folder / MOTION_FILE, dict.fromkeys(packed, COMPRESSION))


def outdated(folder: Path, temporary: Path, result: str = RESULT_FILE) -> Iterable[str]:
    """Files that an earlier run wrote and the new one does not: the figures in its list, and its report."""
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
    if own_report(folder / REPORT_FILE):
        yield REPORT_FILE
