"""Units that a data file states: Roll [rad], eta (mm), surge_m, a row of units."""

from __future__ import annotations

import re
from collections.abc import Mapping

from jaxhydro.units import SI

_SAME = {
    "second": "s",
    "sec": "s",
    "msec": "ms",
    "minute": "min",
    "meter": "m",
    "metre": "m",
    "feet": "ft",
    "foot": "ft",
    "degree": "deg",
    "°": "deg",
    "radian": "rad",
    "millimeter": "mm",
    "millimetre": "mm",
    "centimeter": "cm",
    "centimetre": "cm",
    "millisecond": "ms",
}
_KNOWN = {unit for units in SI.values() for unit in units}
_IN_BRACKETS = re.compile(r"[(\[{<]\s*([^()\[\]{}<>]+?)\s*[)\]}>]\s*$")
_AFTER = re.compile(r"(?:_|\s+in\s+|,\s*|/\s*)([A-Za-z°]+)$")


def stated_unit(column: str, units: Mapping[str, str]) -> str | None:
    """Unit that a file states for a column, as a manifest writes it.

    Args:
        column: the column's name.
        units: units by column from elsewhere in the file.

    Returns:
        The unit; None where the file states none that is known.
    """
    bracketed, after = _IN_BRACKETS.search(column), _AFTER.search(column)
    text = units.get(column) or (bracketed[1] if bracketed else after[1] if after else "")
    word = text.strip("()[]{}<> ").lower()
    word = _SAME.get(word.removesuffix("s") if len(word) > 2 else word, word)
    return word if word in _KNOWN else None
