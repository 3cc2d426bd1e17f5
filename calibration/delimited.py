"""Delimited text to a table: comma, semicolon, tab or white space, found by trying; decimal points or commas.

A line that starts with # or % is a comment, and the header may stand in the last of them. What a logger wrote above
the header, and a row of units under it, are left out. Empty cells and `nan` become NaN; what else is not a number is
told by its row, counted as an editor does.
"""

from __future__ import annotations

import csv
import gzip
import io
import struct
import zlib
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from jaxhydro.problems import InputError, Problem

_COMMENTS = ("#", "%")
_WHITESPACE = None
_SHOWN = 5               # of one kind of mistake
_TOP = 200               # lines, in which delimiter and header are looked for


def wrong(path: Path, where: str, expected: str, found: str, hint: str = "") -> InputError:
    """One problem of one file."""
    return InputError(str(path), [Problem(where, expected, found, hint)])


def reason(error: BaseException) -> str:
    """Why a library gave up, in one line."""
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return f"{type(error).__name__}: {' '.join(str(error).split())[:200]}"


def decoded(path: Path) -> str:
    """A text file's content, unzipped where its name ends in .gz, with \\n at the line ends."""
    raw = path.read_bytes()
    if path.name.lower().endswith(".gz"):
        try:
            raw = gzip.decompress(raw)
        except (OSError, EOFError, zlib.error, struct.error) as error:
            raise wrong(path, "file", "a whole gzip file", str(error) or "a damaged one") from error
    encoding = "utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
    try:
        text = raw.decode(encoding)
    except UnicodeDecodeError:
        text = raw.decode("latin-1")             # degree signs and names from older loggers
    controls = sum(text.count(chr(code)) for code in range(32) if code not in (9, 10, 12, 13, 26))
    if controls:
        raise wrong(path, "file", "text with delimiters", f"binary content ({controls} control characters)")
    return text.replace("\x1a", "").replace("\r\n", "\n").replace("\r", "\n")


def parse(path: Path, lines: list[str], first: int = 1) -> pd.DataFrame:
    """The table in `lines`; `first` is the row number of the first of them in the file, `path` serves the messages.

    Raises InputError for no rows, torn rows, text among numbers, a header that does not fit.
    """
    rows = [(number, line) for number, line in enumerate(lines, first) if line.strip()]
    kept = [(number, line) for number, line in rows if not line.lstrip().startswith(_COMMENTS)]
    if not kept:
        raise wrong(path, "file", "a table with a header", "an empty file" if not rows else "comments only")
    delimiter = _delimiter([line for _, line in kept[:_TOP]])
    kept = kept[_above([line for _, line in kept], delimiter) :]
    header, fields = None, _split(kept[0][1], delimiter)
    if not any(map(_is_number, fields)):
        header, kept = fields, kept[1:]
        if kept and _is_units(_split(kept[0][1], delimiter)):
            kept = kept[1:]
    elif (above := next((line for number, line in rows if number == kept[0][0] - 1), None)) is not None:
        header = _split(above.lstrip("".join(_COMMENTS) + " "), delimiter)      # numpy.savetxt puts it in a comment
    if not kept:
        raise wrong(path, "file", "rows of numbers under the header", "a header only")

    body, numbers = [line for _, line in kept], [number for number, _ in kept]
    widths = _widths(body, delimiter)
    width = len(header) if header and len(header) in widths else Counter(widths).most_common(1)[0][0]
    torn = [i for i, found in enumerate(widths) if found != width]
    if torn:
        raise InputError(str(path), [Problem(f"row {numbers[i]}", f"{width} columns", f"{widths[i]} columns",
                                             "a line cut short" if i == len(body) - 1 else "") for i in torn[:_SHOWN]])
    names = header if header is not None and width - len(header) in (0, 1) else [str(i) for i in range(width)]
    table = _numbers(path, body, numbers, delimiter, names + [""] * (width - len(names)))
    if not table.columns[-1] and table.iloc[:, -1].isna().all():                # every line ends with the delimiter
        table = table.iloc[:, :-1]
    if header is fields and len(fields) != len(table.columns):
        raise wrong(path, "header", f"{width} names, one for each column", f"{len(fields)}: " + ", ".join(fields[:10]))
    return table


def _numbers(path: Path, lines: list[str], rows: list[int], delimiter: str | None, names: list[str]) -> pd.DataFrame:
    """The body as float columns; a column that is text throughout stays text, one that is partly text is a mistake."""
    body = "\n".join(lines)
    options: dict[str, Any] = {"sep": r"\s+" if delimiter is _WHITESPACE else delimiter,
                               "decimal": "," if delimiter != "," and "," in body else "."}
    try:
        raw = pd.read_csv(io.StringIO(body), header=None, names=range(len(names)), index_col=False, low_memory=False,
                          skip_blank_lines=False, skipinitialspace=True, **options)
    except (ValueError, OverflowError) as error:
        raise wrong(path, "file", "a delimited table", " ".join(str(error).split())) from error
    if len(raw) != len(lines):
        raise wrong(path, "file", f"{len(lines)} rows", f"{len(raw)} after splitting", "look for an unpaired quote")
    columns: list[pd.Series] = []
    problems: list[Problem] = []
    for i, name in enumerate(names):
        cells = raw.iloc[:, i]
        if cells.dtype.kind in "iuf":
            columns.append(cells.astype(float))
            continue
        text = cells.astype(object).map(lambda cell: cell.strip().replace(",", ".") if isinstance(cell, str) else cell)
        values = pd.to_numeric(text.where(text != "", None), errors="coerce").astype(float)
        bad = np.flatnonzero((values.isna() & cells.notna() & (text != "")).to_numpy())
        if cells.dtype.kind == "b" or len(bad) > len(cells) / 2:
            columns.append(cells.astype(object))
            continue
        more = f"{len(bad)} such cells in this column" if len(bad) > _SHOWN else ""
        problems += [Problem(f"row {rows[row]}, column {name or i}", "a number", repr(cells.iloc[row]), more)
                     for row in bad[:_SHOWN]]
        columns.append(values)
    if problems:
        raise InputError(str(path), problems)
    table = pd.concat(columns, axis=1)
    table.columns = pd.Index(names)
    return table


def _delimiter(lines: list[str]) -> str | None:
    """The delimiter that makes most cells numbers, then most rows alike; None is white space. The first wins a tie."""
    def score(delimiter: str | None) -> tuple[float, int]:
        cells = [_split(line, delimiter) for line in lines]
        width = Counter(map(len, cells)).most_common(1)[0][0]
        if width < 2:
            return 0.0, 0
        whole = [row for row in cells if len(row) == width]
        return sum(_is_number(cell, delimiter) for row in whole for cell in row) / sum(map(len, cells)), len(whole)
    return max((";", "\t", ",", _WHITESPACE), key=score)


def _above(lines: list[str], delimiter: str | None) -> int:
    """How many lines stand above the header: the last line without numbers that is as wide as the table, or, if that has units,
    the one before it. 0 where there is none such."""
    cells = [_split(line, delimiter) for line in lines[:_TOP]]
    width = Counter(_widths(lines, delimiter)).most_common(1)[0][0]

    def of_numbers(row: list[str]) -> bool:
        numbers = [_is_number(cell) for cell in row]
        return any(numbers) and (len(row) == width or (len(row) > 1 and all(numbers)))

    first = next((i for i, row in enumerate(cells) if of_numbers(row)), 0)
    names = [len(row) == width and not any(map(_is_number, row)) and sum(map(bool, row)) for row in cells[:first]]
    if first > 1 and _is_units(cells[first - 1]) and names[-2] >= names[-1]:
        return first - 2
    return first - 1 if first > 1 and names[-1] else 0


def _split(line: str, delimiter: str | None) -> list[str]:
    if delimiter is _WHITESPACE:
        return [cell.strip('"') for cell in line.split()]
    return [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter, skipinitialspace=True))]


def _widths(lines: list[str], delimiter: str | None) -> list[int]:
    if delimiter is _WHITESPACE:
        return [len(line.split()) for line in lines]
    return [len(_split(line, delimiter)) if '"' in line else line.count(delimiter) + 1 for line in lines]


def _is_number(cell: str, delimiter: str | None = None) -> bool:
    try:
        float(cell if delimiter == "," else cell.replace(",", "."))
    except ValueError:
        return False
    return True


def _is_units(cells: list[str]) -> bool:
    """Whether a row under the header holds units: no number, every entry short, such as (s), [deg], -, N m."""
    return not any(map(_is_number, cells)) and any(cells) and all(len(cell) <= 10 for cell in cells)
