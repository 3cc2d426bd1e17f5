"""Tables from delimited text: comma, semicolon, tab or white space; decimal points or commas.

The delimiter is found by trying. A line that starts with # or % is a comment, and the header may stand in the last of them.
Lines of a logger above the header or below the last row are left out. The header may have another delimiter than the rows.
Times such as 10:22:33.5 become seconds. Empty cells and `nan` become NaN. Anything else that is not a number is reported by
its row, counted as an editor does.
"""

from __future__ import annotations

import gzip
import io
import struct
import zlib
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.clocks import is_time, seconds
from jaxhydro.interop.text_header import COMMENTS, WHITESPACE, layout, plain, split, widths

_SHOWN = 5  # of one kind of mistake


def wrong(path: Path, where: str, expected: str, found: str, hint: str = "") -> InputError:
    """One problem of one file."""
    return InputError(str(path), [Problem(where, expected, found, hint)])


def reason(error: BaseException) -> str:
    """Why a library gave up, in one line."""
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return f"{type(error).__name__}: {' '.join(str(error).split())[:200]}"


def decoded(path: Path) -> str:
    """A text file's content, unzipped where it is gzip or its name ends in .gz, with \\n at the line ends."""
    raw = path.read_bytes()
    if path.name.lower().endswith(".gz") or raw[:2] == b"\x1f\x8b":
        try:
            raw = gzip.decompress(raw)
        except (OSError, EOFError, zlib.error, struct.error) as error:
            raise wrong(path, "file", "a whole gzip file", str(error) or "a damaged one") from error
    encoding = "utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
    try:
        text = raw.decode(encoding)
    except UnicodeDecodeError:
        text = raw.decode("latin-1")  # degree signs and names from older loggers
    controls = sum(text.count(chr(code)) for code in range(32) if code not in (9, 10, 12, 13, 26))
    if controls:
        raise wrong(path, "file", "text with delimiters", f"binary content ({controls} control characters)")
    return text.replace("\x1a", "").replace("\u2212", "-").replace("\r\n", "\n").replace("\r", "\n")


def parse(path: Path, lines: list[str], first: int = 1) -> pd.DataFrame:
    """Return the table in the lines of a file.

    Its `attrs` have `units`, the units of columns that the file states in a row of their own; `times`, the names of
    columns that were written as times and are seconds; `row`, the number of the first row, if the others follow it one by one;
    `not_numbers`, by column number the mistakes of a column of numbers with text among them. Such a column stays text.

    Args:
        path: the file, for messages.
        lines: its lines.
        first: the row number of the first of them in the file.

    Raises:
        InputError: no rows, torn rows, or a header that does not fit.
    """
    rows = [(number, line) for number, line in enumerate(lines, first) if line.strip()]
    if not any(not line.lstrip().startswith(COMMENTS) for _, line in rows):
        raise wrong(path, "file", "a table with a header", "an empty file" if not rows else "comments only")
    parts = layout(rows)
    if not parts.body:
        raise wrong(path, "file", "rows of numbers under the header", "a header only")
    body, numbers = [line for _, line in parts.body], [number for number, _ in parts.body]
    counts = widths(body, parts.delimiter)
    stated = split(parts.misfit, parts.delimiter) if parts.misfit is not None else parts.names
    width = len(stated) if stated and len(stated) in counts else Counter(counts).most_common(1)[0][0]
    torn = [i for i, count in enumerate(counts) if count != width]
    if torn:
        raise InputError(
            str(path),
            [
                Problem(
                    f"row {numbers[i]}",
                    f"{width} columns",
                    f"{counts[i]} columns",
                    "a line cut short" if i == len(body) - 1 else "",
                )
                for i in torn[:_SHOWN]
            ],
        )
    commas = parts.delimiter == "," and width == 2 * len(stated or ())
    hint = "If numbers have decimal commas, columns have to be separated by semicolons or tabs." if commas else ""
    found = f"{len(stated or ())}: " + ", ".join((stated or [])[:10])
    misfit = wrong(path, "header", f"{width} names, one for each column", found, hint)
    if parts.misfit is not None or len(parts.names or ()) > width:
        raise misfit
    names = [str(i) for i in range(width)] if parts.names is None else parts.names
    table = _numbers(path, body, numbers, parts.delimiter, names + [""] * (width - len(names)))
    if not table.columns[-1] and table.iloc[:, -1].isna().all():  # every line ends with the delimiter
        table = table.iloc[:, :-1]
    if parts.names is not None and len(names) < len(table.columns):
        raise misfit
    table.attrs["units"] = dict(zip(names, parts.units or ()))
    if numbers[-1] - numbers[0] == len(numbers) - 1:
        table.attrs["row"] = numbers[0]
    return table


def _numbers(path: Path, lines: list[str], rows: list[int], delimiter: str | None, names: list[str]) -> pd.DataFrame:
    """Body of a table as float columns; a column with text stays text.

    Mistakes in a column that is mostly numbers are kept in the table's `attrs`.
    """
    body = "\n".join(lines)
    options: dict[str, Any] = {
        "sep": r"\s+" if delimiter is WHITESPACE else delimiter,
        "decimal": "," if delimiter != "," and "," in body else ".",
    }
    try:
        raw = pd.read_csv(
            io.StringIO(body),
            header=None,
            names=range(len(names)),
            index_col=False,
            low_memory=False,
            skip_blank_lines=False,
            skipinitialspace=True,
            **options,
        )
    except (ValueError, OverflowError) as error:
        raise wrong(path, "file", "a delimited table", " ".join(str(error).split())) from error
    if len(raw) != len(lines):
        raise wrong(path, "file", f"{len(lines)} rows", f"{len(raw)} after splitting", "look for an unpaired quote")
    columns: list[pd.Series] = []
    not_numbers: dict[int, list[Problem]] = {}
    times: list[str] = []
    for i, name in enumerate(names):
        cells = raw.iloc[:, i]
        if cells.dtype.kind in "iuf":
            columns.append(cells.astype(float))
            continue
        text = cells.astype(object).map(lambda cell: cell.strip() if isinstance(cell, str) else cell)
        text = text.where(cells.notna() & (text != ""), None)
        expected: dict[int, str]
        if sum(is_time(cell) for cell in text if isinstance(cell, str)) > len(text) / 2:
            elapsed, expected = seconds([None if cell is None else str(cell) for cell in text])
            values = pd.Series(elapsed)
            times.append(name)
        else:
            as_written = text.map(lambda cell: plain(cell) if isinstance(cell, str) else cell)
            values = pd.to_numeric(as_written, errors="coerce").astype(float)
            expected = {int(row): "a number" for row in np.flatnonzero((values.isna() & text.notna()).to_numpy())}
            if cells.dtype.kind == "b" or len(expected) > len(cells) / 2:
                columns.append(cells.astype(object))
                continue
        more = f"{len(expected)} such cells in this column" if len(expected) > _SHOWN else ""
        if expected:
            not_numbers[i] = [
                Problem(f"row {rows[row]}, column {name or i}", required, repr(cells.iloc[row]), more)
                for row, required in sorted(expected.items())[:_SHOWN]
            ]
        columns.append(cells.astype(object) if expected else values)
    table = pd.concat(columns, axis=1)
    table.columns = pd.Index(names)
    table.attrs |= {"times": times, "not_numbers": not_numbers}
    return table
