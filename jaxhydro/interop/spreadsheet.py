"""Tables from Excel workbooks: the one sheet with numbers."""

from __future__ import annotations

import datetime
from pathlib import Path
from typing import Any

import pandas as pd

from jaxhydro.interop.delimited_text import parse, reason, wrong

_LEAST = 2  # numbers in a column, from which on a sheet has a table


def workbook(path: Path) -> pd.DataFrame:
    """Return the table of an .xlsx or .xlsm file; rows count as in Excel.

    Raises:
        InputError: openpyxl is not installed, the file is damaged, or not exactly one sheet has numbers.
    """
    with path.open("rb"):  # a missing file is told as such
        pass
    try:
        import openpyxl  # noqa: F401
    except ImportError as error:
        raise wrong(
            path,
            "file",
            "the library openpyxl, which reads Excel workbooks",
            "it is not installed",
            'pip install "jaxhydro[excel]", or save the sheet as CSV.',
        ) from error
    try:
        sheets = pd.read_excel(path, sheet_name=None, header=None, dtype=object, engine="openpyxl")
    except Exception as error:  # openpyxl has many
        raise wrong(path, "file", "an Excel workbook (.xlsx)", reason(error)) from error
    full = {str(name): sheet for name, sheet in sheets.items() if _has_numbers(sheet)}
    if len(full) != 1:
        raise wrong(
            path,
            "file",
            "one sheet with numbers",
            ", ".join(full) or f"none in {', '.join(map(str, sheets))}",
            "Save the sheet of this test as CSV." if full else "",
        )
    (sheet,) = full.values()
    return parse(path, ["\t".join(map(_written, row)) for row in sheet.itertuples(index=False)])


def _has_numbers(sheet: pd.DataFrame) -> bool:
    return any(sum(isinstance(cell, int | float) and not pd.isna(cell) for cell in sheet[name]) >= _LEAST for name in sheet)


def _written(cell: Any) -> str:
    """A cell as text that `parse` reads."""
    if cell is None or (not isinstance(cell, str) and pd.isna(cell)):
        return ""
    if isinstance(cell, datetime.timedelta):
        minutes, rest = divmod(cell.total_seconds(), 60)
        return f"{int(minutes // 60)}:{int(minutes % 60):02d}:{rest:09.6f}"
    if isinstance(cell, datetime.datetime | datetime.time):
        return str(cell.isoformat())
    return str(float(cell)) if isinstance(cell, int | float) else " ".join(str(cell).split())
