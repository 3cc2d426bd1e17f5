"""Times in seconds from ISO time stamps, dates with a time of day, or hours:minutes:seconds."""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import datetime

import numpy as np

DAY = 86400.0  # s
EXPECTED = "a time such as 2024-01-31T10:22:33.5 or 10:22:33.5"
_OF_DAY = r"(\d{1,4}):([0-5]\d):([0-5]\d(?:[.,]\d+)?)(?:\s*([AaPp][Mm]))?"
_ZONE = r"\s?(?:Z|[+-]\d\d(?::?\d\d)?)"
_TIME = re.compile(rf"(?:(\d{{4}}[-/]\d\d[-/]\d\d|\d{{8}}|\d{{1,2}}[-/.]\d{{1,2}}[-/.]\d{{4}})[T\s]\s*)?{_OF_DAY}({_ZONE})?")
_SHORT = re.compile(r"\d{1,4}:[0-5]\d([.,]\d+)?")  # minutes and seconds where these have decimals, else perhaps hours


def is_time(cell: str) -> bool:
    """Whether a cell is a time stamp, a time of day or an elapsed time."""
    return ":" in cell and bool(_TIME.fullmatch(cell) or _SHORT.fullmatch(cell))


def seconds(cells: Sequence[str | None]) -> tuple[np.ndarray, dict[int, str]]:
    """Convert written times to seconds.

    Time stamps and dates count from the first row. Elapsed times stay as written. A time of day goes on after midnight.

    Args:
        cells: the column as text, None where a cell is empty.

    Returns:
        (n,) seconds, NaN where empty or not understood, and what was expected in each cell that was not understood, by index.
    """
    values = np.full(len(cells), np.nan)
    wrong: dict[int, str] = {}
    days: list[str | None] = [None] * len(cells)
    stamped = np.zeros(len(cells), bool)
    for i, cell in enumerate(cells):
        if cell is None:
            continue
        short = _SHORT.fullmatch(cell.strip())
        match = _TIME.fullmatch(f"0:{cell.strip()}" if short and short[1] else cell.strip())
        if match is None:
            wrong[i] = "hours, minutes and seconds: these may be either two" if short else EXPECTED
            continue
        day, hours, minutes, rest, half, zone = match.groups()
        hour = int(hours)
        if (half and not 1 <= hour <= 12) or ((day or zone) and hour > 23):
            wrong[i] = "an hour of the day"
            continue
        hour = hour % 12 + 12 * (half.lower() == "pm") if half else hour
        values[i] = 3600.0 * hour + 60.0 * int(minutes) + float(rest.replace(",", ".")) - _offset(zone)
        days[i], stamped[i] = day, day is not None
    valid = np.flatnonzero(np.isfinite(values))
    if stamped[valid].any() and not stamped[valid].all():
        wrong |= {int(i): "a date, as the other rows have" for i in valid[~stamped[valid]]}
    elif len(valid) and stamped[valid[0]]:
        dates = {day: _date(day) for day in dict.fromkeys(days) if day is not None}
        if len(dates) > 1:
            wrong |= {
                i: "a date in the order year-month-day, since the dates differ"
                for i in map(int, valid)
                if dates[str(days[i])] is None
            }
            numbers = {day: 0.0 if date is None else date for day, date in dates.items()}
            first = numbers[str(days[valid[0]])]
            values[valid] += DAY * np.array([numbers[str(days[i])] - first for i in valid])
        values -= values[valid[0]] if not wrong else 0.0
    elif len(valid):  # midnight: a step back by more than half a day
        values[valid[1:]] += DAY * np.cumsum(np.diff(values[valid]) < -DAY / 2)
    return values, wrong


def _offset(zone: str | None) -> float:
    """Seconds by which a time zone is ahead of UTC."""
    digits = re.sub(r"[^\d]", "", zone or "").ljust(4, "0")
    size = 3600.0 * int(digits[:2]) + 60.0 * int(digits[2:])
    return -size if "-" in (zone or "") else size


def _date(day: str) -> float | None:
    """Date as a number of days; None where it is ambiguous or does not exist."""
    if re.fullmatch(r"\d{1,2}/\d{1,2}/\d{4}|\d{1,2}-\d{1,2}-\d{4}", day):
        return None
    order = "%d.%m.%Y" if "." in day else "%Y%m%d" if day.isdigit() else "%Y-%m-%d"
    try:
        return float(datetime.strptime(day.replace("/", "-"), order).toordinal())
    except ValueError:
        return None
