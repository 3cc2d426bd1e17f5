"""Writing of report.html for the results in a folder."""

from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import Any

from calibration.report import calibration_page, comparison_page, diagnosis_page, simulation_page, sweep_page, uncertainty_page
from calibration.results.calibration_file import CalibrationFile, read_as
from calibration.results.comparison_file import ComparisonFile
from calibration.results.diagnosis_file import DiagnosisFile
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
    """Write report.html into a result folder and give its path. Raises InputError where there are no results in it."""
    folder = Path(folder)
    try:
        there = [name for name in PAGES if folder.is_dir() and (folder / name).is_file()]
    except (OSError, ValueError):
        there = []
    if not there and (folder / RESULTS).is_dir():
        found = "one that was stopped: the same `jaxhydro sweep` goes on"
        raise InputError(str(folder), [Problem("", "a sweep that is done", found)])
    if not there and all((folder / name).is_file() for name in (simulation_page.MOTIONS, MOTION_FILE)):
        write_whole(folder / REPORT_FILE, simulation_page.page(folder))
        return folder / REPORT_FILE
    if not there:
        found = "a file" if folder.is_file() else "no such folder"
        files = ", ".join((RESULT_FILE, DIAGNOSIS_FILE, UNCERTAINTY_FILE, COMPARISON_FILE, simulation_page.MOTIONS))
        found = f"no {files} or {SWEEP}" if folder.is_dir() else found
        expected = "a folder that `jaxhydro simulate`, `calibrate`, `diagnose`, `uncertainty` or `sweep` wrote"
        raise InputError(str(folder), [Problem("", expected, found)])
    model, page = PAGES[there[0]]
    write_whole(folder / REPORT_FILE, page(read_as(model, folder / there[0]), folder))
    return folder / REPORT_FILE
