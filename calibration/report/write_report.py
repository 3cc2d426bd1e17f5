"""Writing of report.html for the results in a folder."""

from os import PathLike
from pathlib import Path

from calibration.results.calibration_file import read_as, read_saved
from calibration.results.result_folder import DIAGNOSIS_FILE, REPORT_FILE, RESULT_FILE, UNCERTAINTY_FILE
from jaxhydro.errors import InputError, Problem
from jaxhydro.files import write_whole

SWEEP, RESULTS = "sweep.json", "results.zarr"


def write_report(folder: str | PathLike[str]) -> Path:
    """Write report.html into a result folder and give its path. Raises InputError where there are no results in it."""
    folder = Path(folder)
    try:
        there = [
            name
            for name in (DIAGNOSIS_FILE, RESULT_FILE, UNCERTAINTY_FILE, SWEEP)
            if folder.is_dir() and (folder / name).is_file()
        ]
    except (OSError, ValueError):
        there = []
    if not there and (folder / RESULTS).is_dir():
        found = "one that was stopped: the same `jaxhydro sweep` goes on"
        raise InputError(str(folder), [Problem("", "a sweep that is done", found)])
    if not there:
        found = "a file" if folder.is_file() else "no such folder"
        found = f"no {RESULT_FILE}, {DIAGNOSIS_FILE}, {UNCERTAINTY_FILE} or {SWEEP}" if folder.is_dir() else found
        expected = "a folder that `jaxhydro calibrate`, `diagnose`, `uncertainty` or `sweep` wrote"
        raise InputError(str(folder), [Problem("", expected, found)])
    if there[0] == DIAGNOSIS_FILE:
        from calibration.report.diagnosis_page import page as diagnosis_page
        from calibration.results.diagnosis_file import read_diagnosis

        text = diagnosis_page(read_diagnosis(folder / DIAGNOSIS_FILE), folder)
    elif there[0] == UNCERTAINTY_FILE:
        from calibration.report.uncertainty_page import page as uncertainty_page
        from calibration.results.uncertainty_file import UncertaintyFile

        text = uncertainty_page(read_as(UncertaintyFile, folder / UNCERTAINTY_FILE), folder)
    elif there[0] == SWEEP:
        from calibration.report.sweep_page import page as sweep_page
        from jaxhydro.sweep.sweep_results import SweepResults

        text = sweep_page(read_as(SweepResults, folder / SWEEP), folder)
    else:
        from calibration.report.calibration_page import page as calibration_page

        text = calibration_page(read_saved(folder / RESULT_FILE), folder)
    write_whole(folder / REPORT_FILE, text)
    return folder / REPORT_FILE
