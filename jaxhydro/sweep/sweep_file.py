"""Sweep file (YAML) and scatter table (CSV, one sea state per row)."""

import codecs
import csv
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

from jaxhydro.errors import InputError, Problem, shown, suggest
from jaxhydro.input_schema import MAX_SPREADING, read_yaml, validate
from jaxhydro.sweep.sea_states import UNITS as UNITS_OF_STATES
from jaxhydro.sweep.sea_states import swell_problems
from jaxhydro.sweep.sweep_schema import COLUMNS, SeaState, Sweep

UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)  # of "Unicode text" of spreadsheets
UNITS = {"heading": "deg", **UNITS_OF_STATES}  # that a header may state; probability may be in any
ABOVE_ZERO, ENHANCEMENT = (5e-324, math.inf, "a number > 0"), (1.0, 7.0, "a number from 1 to 7")
EXPONENT, ANY = (0.0, MAX_SPREADING, f"a number from 0 to {MAX_SPREADING:g}"), (-math.inf, math.inf, "a number")
LIMITS = {"hs": ABOVE_ZERO, "tp": ABOVE_ZERO, "probability": (0.0, math.inf, "a number >= 0"), "gamma": ENHANCEMENT}
LIMITS |= {"heading": ANY, "spreading": EXPONENT, "swell_hs": ABOVE_ZERO, "swell_tp": ABOVE_ZERO}
LIMITS |= {"swell_gamma": ENHANCEMENT, "swell_heading": ANY, "swell_spreading": EXPONENT}


def load_sweep(path: str | Path) -> Sweep:
    """Checked contents of a sweep file, with its scatter table read.

    Args:
        path: YAML file; paths in it are relative to it.

    Returns:
        The sweep.

    Raises:
        InputError: The file has mistakes, all of which are listed, or its scatter table has.
    """
    path = Path(path)
    sweep = validate(Sweep, read_yaml(path, "sweep"), str(path))
    changed: dict[str, Any] = {}
    if isinstance(sweep.scatter, str):
        changed["scatter"] = read_scatter(path.parent / sweep.scatter, f"{path}: scatter")
        if sweep.spectrum != "jonswap" and any(state.gamma is not None for state in changed["scatter"]):
            raise InputError(str(path), [Problem("spectrum", "jonswap, for a table with gamma", sweep.spectrum)])
        if problems := [in_row(problem) for problem in sweep.faults_of_states(changed["scatter"])]:
            raise InputError(f"{path}: scatter: {path.parent / sweep.scatter}", problems)
    if (near := path.parent / sweep.platform).is_file():
        changed["platform"] = str(near)
    if sweep.calibration is not None:
        changed["calibration"] = str(path.parent / sweep.calibration)
    return sweep.model_copy(update=changed)


def in_row(problem: Problem) -> Problem:
    """A problem at `[2].heading` as one of row 3, column heading."""
    number, _, key = problem.where.removeprefix("[").partition("].")
    return replace(problem, where=f"row {int(number) + 1}, column {key}")


def read_scatter(path: Path, asked: str) -> tuple[SeaState, ...]:
    """Sea states of a scatter table, in the order of its rows.

    Args:
        path: CSV file.
        asked: Key that names the file, for errors.

    Raises:
        InputError: The file is missing, a column is unknown or missing, or a cell is not a number.
    """
    try:
        content = path.read_bytes()
        text = content.decode("utf-16" if content.startswith(UTF_16) else "utf-8-sig")
    except FileNotFoundError:
        raise InputError(asked, [Problem("", "a CSV file", f"{str(path)!r}, and there is none")]) from None
    except UnicodeDecodeError:
        raise InputError(asked, [Problem("", "a CSV file in UTF-8", f"{str(path)!r}, which is in another encoding")]) from None
    except (OSError, ValueError) as error:
        reason = str(getattr(error, "strerror", None) or error)
        raise InputError(asked, [Problem("", "a CSV file", f"{str(path)!r}, which cannot be read ({reason})")]) from None
    # as blank lines, so that lines keep their numbers: comments, and what spreadsheets say of the delimiter
    lines = ["" if re.match(r"\s*#|\ufeff?sep=.\s*$", line, re.IGNORECASE) else line for line in text.splitlines()]
    head = next(filter(str.strip, lines), "")
    delimiter = next((mark for mark in ";\t" if mark in head), ",")
    read = enumerate(csv.reader(lines, delimiter=delimiter), 1)
    rows = [(number, row) for number, row in read if any(cell.strip() for cell in row)]
    commas = delimiter != "," and any("," in cell for _, row in rows[1:] for cell in row)  # decimal ones
    if not rows:
        raise InputError(str(path), [Problem("", f"a header {','.join(COLUMNS[:3])} and rows", "an empty file")])
    while not any(row[-1].strip() for _, row in rows) and len({len(row) for _, row in rows}) == 1:
        rows = [(number, row[:-1]) for number, row in rows]  # what a delimiter at the end of all lines makes
    where, heads = f"line {rows[0][0]}", [cell.strip() for cell in rows[0][1]]
    names = [_column(head) for head in heads]
    problems = []
    for head, name in zip(heads, names):
        if name not in COLUMNS or names.count(name) > 1:
            actual = shown(head) if name not in COLUMNS else f"{name} twice"
            units = "Hs in m, Tp in s" if re.match(r"(swell_)?(hs|tp)\b", name) else ""
            hint = units or suggest(name, COLUMNS)
            problems.append(Problem(where, f"columns among {', '.join(COLUMNS)}", actual, hint))
    missing = [name for name in COLUMNS[:3] if name not in names]
    if missing and not problems:
        problems.append(Problem(where, f"a column {missing[0]}", ", ".join(heads)))
    if problems:
        raise InputError(str(path), dict.fromkeys(problems))
    states = []
    for number, row in rows[1:]:
        if len(row) != len(names):
            problems.append(Problem(f"line {number}", f"{len(names)} cells", str(len(row))))
            continue
        values = {}
        for head, name, cell in zip(heads, names, row):
            if name not in COLUMNS[:3] and not cell.strip():
                continue
            if commas and "." in cell:  # of thousands, perhaps
                expected = "a number with a decimal comma, as others in the file, and no point"
                problems.append(Problem(f"line {number}, column {head}", expected, shown(cell.strip())))
                continue
            value = _number(cell.replace(",", ".") if commas else cell)
            least, most, expected = LIMITS[name]
            if not least <= value <= most:
                problems.append(Problem(f"line {number}, column {head}", expected, shown(cell.strip())))
            values[name] = value
        problems += [replace(problem, where=f"line {number}, column {problem.where}") for problem in swell_problems(values)]
        if not problems:
            states.append(SeaState(**values))
    if problems:
        raise InputError(str(path), problems)
    if not states:
        raise InputError(str(path), [Problem("", "one row or more under the header", "none")])
    return tuple(states)


def _column(head: str) -> str:
    """Header without its case and its unit, `Hs (m)` or `Tp [s]`, where that is the right unit."""
    name, unit = re.fullmatch(r"(.*?)\s*(?:[(\[](.*?)[)\]])?", head.lower(), re.DOTALL).groups()  # type: ignore[union-attr]
    return name if unit is None or unit.strip() == UNITS.get(name, unit.strip()) else head.lower()


def _number(cell: str) -> float:
    try:
        value = float(cell)
    except ValueError:
        return math.nan
    return value if math.isfinite(value) else math.nan
