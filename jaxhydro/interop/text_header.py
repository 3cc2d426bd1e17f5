"""Layout of a text table: header, row of units, and lines of a logger above and below."""

from __future__ import annotations

import csv
import re
from collections import Counter
from dataclasses import dataclass

from jaxhydro.interop.clocks import is_time

Row = tuple[int, str]  # its number in the file, as an editor counts, and its text
WHITESPACE = None
DELIMITERS = (";", "\t", ",", WHITESPACE)
COMMENTS = ("#", "%")
_SAMPLE = 200  # rows, by which delimiter and columns are judged
_WIDE = re.compile(r"\t|\s{2,}")  # between names that have single spaces in them
_TIMES, _ANGLES = "s sec secs second seconds ms msec min h hr", "deg degs degree degrees rad radian radians mrad °"
_LENGTHS = "m meter meters metre metres cm mm km ft feet in"
_OTHERS = "n kn mn nm n-m n*m kn-m kn*m nmm hz rad/s deg/s m/s m/s2 m/s^2 mm/s rpm v mv pa kpa bar kg g t 1 % none"
_UNIT_WORDS = frozenset(f"{_TIMES} {_ANGLES} {_LENGTHS} {_OTHERS}".split())
_BRACKETED = re.compile(r"[(\[{<].*[)\]}>]")
_EXPONENT = re.compile(r"(?<=[\d.])[dD](?=[+-]?\d)")  # Fortran's


@dataclass(frozen=True)
class Layout:
    """The parts of a text table: names and units where the file has them, and the rows of its body."""

    delimiter: str | None
    names: list[str] | None
    units: list[str] | None
    body: list[Row]
    misfit: str | None = None  # the line above the body, where it does not name every column


def plain(cell: str) -> str:
    """A number as Python writes it: decimal point, exponent e."""
    return _EXPONENT.sub("e", cell.replace(",", "."))


def is_number(cell: str, delimiter: str | None = WHITESPACE) -> bool:
    """Whether a cell is a number; with a comma for its decimals, unless commas delimit."""
    try:
        float(_EXPONENT.sub("e", cell) if delimiter == "," else plain(cell))
    except ValueError:
        return False
    return True


def split(line: str, delimiter: str | None) -> list[str]:
    """The cells of a line."""
    if delimiter is WHITESPACE:
        return [cell.strip('"') for cell in line.split()]
    return [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter, skipinitialspace=True))]


def widths(lines: list[str], delimiter: str | None) -> list[int]:
    """How many cells each line has."""
    if delimiter is WHITESPACE:
        return [len(line.split()) for line in lines]
    return [len(split(line, delimiter)) if '"' in line else line.count(delimiter) + 1 for line in lines]


def layout(rows: list[Row]) -> Layout:
    """Layout of the table in the non-empty lines of a file, of which one at least is no comment."""
    uncommented = [(number, line) for number, line in rows if not line.lstrip().startswith(COMMENTS)]
    delimiter = _delimiter([line for _, line in uncommented[len(uncommented) // 2 :][:_SAMPLE]])
    table = _layout(rows, uncommented, delimiter)
    if delimiter is WHITESPACE and table.names is None:  # a date and a time of day under one name
        stamp = re.compile(r"(\d{4}[-/]\d\d[-/]\d\d|\d{1,2}[-/.]\d{1,2}[-/.]\d{4})\s+(?=\d{1,2}:\d\d:\d\d)")
        joined = [(number, stamp.sub(r"\1T", line)) for number, line in rows]
        if joined != rows:
            uncommented = [(number, line) for number, line in joined if not line.lstrip().startswith(COMMENTS)]
            return _layout(joined, uncommented, delimiter)
    return table


def _layout(rows: list[Row], uncommented: list[Row], delimiter: str | None) -> Layout:
    lines = [line for _, line in uncommented]
    width = Counter(widths(lines, delimiter)).most_common(1)[0][0]
    numeric = _numeric_columns(lines, delimiter, width)
    if not numeric:  # text alone: nothing tells header from body
        names = names_of(lines[0], delimiter, width)
        return Layout(delimiter, names, None, uncommented[1:] if names else uncommented, None if names else lines[0])

    def measured(line: str) -> bool:
        cells = split(line, delimiter)
        values = [cells[i] for i in numeric if i < len(cells)]
        return len(cells) == width and any(values) and all(not cell or _is_value(cell, delimiter) for cell in values)

    first = next((i for i, line in enumerate(lines) if measured(line)), 0)
    last = next((i for i in reversed(range(len(lines))) if measured(lines[i])), len(lines) - 1)
    while last + 1 < len(lines) and not _is_sentence(lines[last + 1], delimiter, numeric):
        last += 1  # a damaged row, which is told
    if any(not _is_sentence(line, delimiter, numeric) for line in lines[last + 1 :]):
        last = len(lines) - 1
    top, body = uncommented[:first], uncommented[first : last + 1]
    header = next((i for i in reversed(range(len(top))) if names_of(top[i][1], delimiter, width)), None)
    if header is not None:
        names, units = names_of(top[header][1], delimiter, width) or [], None
        between = top[header + 1 :]
        above = names_of(top[header - 1][1], delimiter, width) if header else None
        cells = delimiter is not WHITESPACE and all(len(split(top[i][1], delimiter)) == width for i in (header - 1, header))
        if above and _are_units(names, cells) and sum(map(bool, above)) >= sum(map(bool, names)):
            names, units = above, names
        damaged = [row for row in between if not _is_sentence(row[1], delimiter, numeric)]
        return Layout(delimiter, names, units, damaged + body)
    if top:
        damaged = [row for row in top if _has_values(row[1], delimiter, width)]
        others = [row[1] for row in top if row not in damaged]
        return Layout(delimiter, None, None, damaged + body, others[-1] if others else None)
    return Layout(delimiter, *_from_comments(rows, body, delimiter, width), body)


def _from_comments(
    rows: list[Row], body: list[Row], delimiter: str | None, width: int
) -> tuple[list[str] | None, list[str] | None]:
    """Names and units in the comments right above the table, as numpy.savetxt and MATLAB users write them."""
    above = [line.lstrip("".join(COMMENTS) + " ") for number, line in rows if number < body[0][0]]
    if not above or body[0][0] - 1 not in [number for number, _ in rows]:
        return None, None
    names = names_of(above[-1], delimiter, width)
    before = names_of(above[-2], delimiter, width) if len(above) > 1 else None
    if names and before and _are_units(names, False):
        return before, names
    return names, None


def names_of(line: str, delimiter: str | None, width: int) -> list[str] | None:
    """Column names of a line, by the delimiter of the table or another; None where none fits."""
    others = [mark for mark in ("\t", ";", ",") if mark != delimiter and mark in line]
    ways = [split(line, mark) for mark in others]
    own_cells = split(line, delimiter)
    ways = [*ways, own_cells] if delimiter is WHITESPACE else [own_cells, *ways]
    ways += [_WIDE.split(line.strip()), re.findall(r'"[^"]*"|\S+', line), _with_units(line.split())]
    for cells in ways:
        names = [cell.strip().strip('"') for cell in cells]
        if len(names) == width and any(names) and not any(is_number(name) for name in names):
            return names
    short = delimiter is not WHITESPACE and width - len(own_cells) == 1  # every row ends with the delimiter
    return own_cells if short and len(own_cells) > 1 and not any(map(is_number, own_cells)) else None


def _with_units(words: list[str]) -> list[str]:
    """Words with the units in brackets that follow them: Time (s) Surge (m)."""
    names: list[str] = []
    for word in words:
        if names and _BRACKETED.fullmatch(word):
            names[-1] += f" {word}"
        else:
            names.append(word)
    return names


def _are_units(cells: list[str], anything_short: bool) -> bool:
    """Whether the row under the names has units: bracketed or common ones, or anything short."""
    filled = [cell for cell in cells if cell]
    unit_like = [
        cell for cell in filled if _BRACKETED.fullmatch(cell) or cell.lower() in _UNIT_WORDS or not re.search(r"\w", cell)
    ]
    if len(unit_like) > len(filled) / 2:
        return True
    return anything_short and bool(filled) and all(len(cell) <= 10 for cell in filled)


def _is_value(cell: str, delimiter: str | None) -> bool:
    return is_number(cell, delimiter) or is_time(cell)


def _has_values(line: str, delimiter: str | None, width: int) -> bool:
    """Whether a line is a damaged row of the table: as wide and with a number, or numbers alone."""
    cells = split(line, delimiter)
    values = [_is_value(cell, delimiter) for cell in cells]
    return (
        (len(cells) == width > 2 and sum(values) > 1)
        or (len(cells) == width <= 2 and values[0])
        or (len(cells) > 1 and all(values))
    )


def _is_sentence(line: str, delimiter: str | None, numeric: list[int]) -> bool:
    """Whether a line is words: it begins with one, and less than half of what should be numbers are."""
    cells = split(line, delimiter)
    values = [i < len(cells) and _is_value(cells[i], delimiter) for i in numeric]
    begins = cells[0] if cells else ""
    return bool(re.search(r"[^\W\d_]{2}", line)) and not _is_value(begins, delimiter) and sum(values) < len(numeric) / 2


def _numeric_columns(lines: list[str], delimiter: str | None, width: int) -> list[int]:
    """The columns of which most cells are numbers or times, judged in the middle of the file."""
    whole = [cells for line in lines[len(lines) // 2 :][:_SAMPLE] if len(cells := split(line, delimiter)) == width]
    whole = whole or [cells for line in lines[:_SAMPLE] if len(cells := split(line, delimiter)) == width]
    return [i for i in range(width) if sum(_is_value(row[i], delimiter) for row in whole) > len(whole) / 2]


def _delimiter(lines: list[str]) -> str | None:
    """Delimiter that makes most cells numbers, then most rows alike; None is white space."""

    def score(delimiter: str | None) -> tuple[float, int]:
        cells = [split(line, delimiter) for line in lines]
        width = Counter(map(len, cells)).most_common(1)[0][0]
        if width < 2:
            return 0.0, 0
        whole = [row for row in cells if len(row) == width]
        return sum(_is_value(cell, delimiter) for row in whole for cell in row) / sum(map(len, cells)), len(whole)

    return max(DELIMITERS, key=score)
