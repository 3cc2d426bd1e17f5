"""Writing of report.html for the results in a folder."""

from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import Any

from calibration.report import calibration_page, comparison_page, diagnosis_page, simulation_page, sweep_page, uncertainty_page
from calibration.results.calibration_file import CalibrationFile
from calibration.results.comparison_file import ComparisonFile
from calibration.results.diagnosis_file import DiagnosisFile
from calibration.results.read_result import read_as
from calibration.results.result_folder import COMPARISON_FILE, DIAGNOSIS_FILE, MOTION_FILE, RESULT_FILE, UNCERTAINTY_FILE
from calibration.results.uncertainty_file import UncertaintyFile
from jaxhydro.errors import InputError, Problem
from jaxhydro.files import REPORT_FILE, write_whole
from jaxhydro.sweep.sweep_results import SweepResults

SWEEP, RESULTS = sweep_page.SWEEP_FILE, "results.zarr"
PAGES: dict[str, tuple[type[Any], Callable[[Any, Path], str]]] = {  # model and page of a result file
    DIAGNOSIS_FILE: (DiagnosisFile, diagnosis_page.page),
    RESULT_FILE: (CalibrationFile, calibration_page.page),
    UNCERTAINTY_FILE: (UncertaintyFile, uncertainty_page.page),
    COMPARISON_FILE: (ComparisonFile, comparison_page.page),
    SWEEP: (SweepResults, sweep_page.page),
}


def write_report(folder: str | PathLike[str]) -> Path:
    """Write report.html into a result folder.

    Returns:
        Path of the page.

    Raises:
        InputError: The folder has no results.
    """
    folder = Path(folder)
    try:
        present = [name for name in PAGES if folder.is_dir() and (folder / name).is_file()]
    except (OSError, ValueError):
        present = []
    if not present and (folder / RESULTS).is_dir():
        actual = "one that was stopped: the same `jaxhydro sweep` goes on"
        raise InputError(str(folder), [Problem("", "a sweep that is done", actual)])
    if not present and all((folder / name).is_file() for name in (simulation_page.MOTIONS, MOTION_FILE)):
        write_whole(folder / REPORT_FILE, simulation_page.page(folder))
        return folder / REPORT_FILE
    if not present:
        actual = "a file" if folder.is_file() else "no such folder"
        files = ", ".join((RESULT_FILE, DIAGNOSIS_FILE, UNCERTAINTY_FILE, COMPARISON_FILE, simulation_page.MOTIONS))
        actual = f"no {files} or {SWEEP}" if folder.is_dir() else actual
        expected = "a folder that `jaxhydro simulate`, `calibrate`, `diagnose`, `uncertainty` or `sweep` wrote"
        raise InputError(str(folder), [Problem("", expected, actual)])
    model, page = PAGES[present[0]]
    write_whole(folder / REPORT_FILE, page(read_as(model, folder / present[0]), folder))
    return folder / REPORT_FILE
