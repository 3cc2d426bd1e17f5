"""Numbers and units as readable text."""

import math
import re
from collections.abc import Sequence

LARGEST_PERCENT = 1e4  # beyond, a ratio says nothing but that it is large
_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def number(value: float | None, digits: int = 4) -> str:
    """A number with so many significant digits, powers of ten where it is large or small; a dash for none."""
    if value is None or not math.isfinite(value):
        return "–"
    if value == 0:
        return "0"
    if 1e-3 <= abs(value) < 1e5:
        return f"{value:.{max(0, digits - 1 - math.floor(math.log10(abs(value))))}f}"
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{mantissa}·10{_raised(int(exponent))}"


def with_deviation(value: float, deviation: float | None) -> str:
    """A value and its standard deviation, both to the latter's second digit.

    `1.512 ± 0.013`, `(3.63 ± 0.05)·10⁸`. Without a deviation, the value alone.
    """
    if deviation is None or not math.isfinite(deviation) or deviation <= 0:
        return number(value)
    size = max(abs(value), deviation)
    exponent = math.floor(math.log10(size)) if size >= 1e5 or size < 1e-3 else 0
    value, deviation = value / 10.0**exponent, deviation / 10.0**exponent
    places = min(max(0, 1 - math.floor(math.log10(deviation))), 9)
    text = f"{value:.{places}f} ± {deviation:.{places}f}"
    return f"({text})·10{_raised(exponent)}" if exponent else text


def bracketed(value: float | None) -> str:
    """A value that is no result, in brackets: `(1.12)`."""
    return f"({number(value, 3)})"


def to_width(value: float, width: float) -> str:
    """A number to the second digit of a width, and at least three digits of its own."""
    if not (value and width > 0 and math.isfinite(value) and math.isfinite(width)):
        return number(value)
    return number(value, min(max(math.floor(math.log10(abs(value))) - math.floor(math.log10(width)) + 2, 3), 9))


def interval(low: float | None, high: float | None) -> str:
    """The ends of an interval, to the second digit of its width: `1.49 to 1.54`.

    Where one end is open: `at least 1.49`, `at most 1.54`. Where both are: `not bounded`.
    """
    if low is not None and high is not None:
        return f"{to_width(low, high - low)} to {to_width(high, high - low)}"
    if low is None and high is None:
        return "not bounded"
    return f"at least {number(low, 3)}" if low is not None else f"at most {number(high, 3)}"


def percent(ratio: float | None) -> str:
    """A ratio in per cent, `> 10000 %` where it is larger; a dash where there is none, or it is infinite."""
    if ratio is None or not math.isfinite(ratio):
        return "–"
    if 100 * abs(ratio) >= LARGEST_PERCENT:
        return f"{'> ' if ratio > 0 else '< -'}{LARGEST_PERCENT:g} %"
    return f"{100 * ratio:.2g} %" if abs(ratio) < 0.995 else f"{100 * ratio:.0f} %"


def signed_percent(ratio: float | None) -> str:
    """A ratio in whole per cent with its sign; a dash for none."""
    if ratio is None or math.isnan(ratio):
        return "–"
    if 100 * ratio >= LARGEST_PERCENT:
        return f"> {LARGEST_PERCENT:g} %"
    return f"{whole:+d} %" if (whole := round(100 * ratio)) else "0 %"


def percent_span(ratios: Sequence[float]) -> str:
    """The smallest and the largest of some ratios in per cent: `0.4-1.7 %`.

    `1.7 %` where they read alike. The largest has two significant digits. The smallest has as many decimals, or one significant
    digit where that is none.
    """
    low, high = 100 * min(ratios), 100 * max(ratios)
    if not high < LARGEST_PERCENT:
        return f"more than {LARGEST_PERCENT:g} %"
    decimals = _decimals(high, 2)
    top, bottom = f"{high:.{decimals}f}", f"{low:.{max(decimals, _decimals(low, 1))}f}"
    return f"{top} %" if float(top) == float(bottom) else f"{bottom}-{top} %"


def _decimals(value: float, digits: int) -> int:
    """Decimals that show so many significant digits, at most 4."""
    return min(max(0, digits - 1 - math.floor(math.log10(value))), 4) if value > 0 else 0


def readable_unit(unit: str) -> str:
    """A unit with raised digits, `N s²/m²` for `N s2/m2`; nothing for "-", the unit of a plain number."""
    return "" if unit == "-" else re.sub(r"(?<=[a-z])([2-6])\b", lambda match: "²³⁴⁵⁶"[int(match[1]) - 2], unit)


def counted(count: int, noun: str) -> str:
    """`1 test`, `9 tests`."""
    return f"{count} {noun}{'' if count == 1 else 's'}"


def _raised(exponent: int) -> str:
    return str(exponent).translate(_RAISED)


def listed(words: Sequence[str]) -> str:
    """a, b and c."""
    return words[0] if len(words) == 1 else " and ".join(x for x in (", ".join(words[:-1]), *words[-1:]) if x)


PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"))


def quantity(value: float, deviation: float | None, unit: str) -> str:
    """A value with its standard deviation in a unit that people read: `81.0 ± 2.1 kN`.

    Degrees stand for radians.
    """
    largest = max(abs(value), deviation or 0.0)
    factor, unit = _readable(largest, unit)
    sure = deviation is not None and math.isfinite(deviation) and deviation > 0
    text = with_deviation(value / factor, deviation / factor) if sure and deviation else number(value / factor, 3)
    text = f"({text})" if unit and "±" in text and "(" not in text else text
    return f"{text} {unit}".strip()


def quantity_range(lower: float, upper: float, unit: str, beside: float | None = None) -> str:
    """A range in a unit that people read: `0 to 81.0 kN`, degrees for radians.

    Args:
        lower: Lower end.
        upper: Upper end.
        unit: Unit of both.
        beside: The value that it is shown beside, whose unit it gets; None: there is none.
    """
    factor, unit = _readable(beside or max(abs(lower), abs(upper)), unit)
    ends = [number(end / factor, 3) if end else "0" for end in (lower, upper)]
    return f"{ends[0]} to {ends[1]} {unit}".strip()


def _readable(largest: float, unit: str) -> tuple[float, str]:
    """What values are divided by, and the unit then."""
    if unit in ("-", "1"):
        return 1.0, ""
    if unit in ("rad", "rad/s"):
        return math.radians(1.0), unit.replace("rad", "deg")
    if re.match(r"N\b", unit):
        size, prefix = next(((size, prefix) for size, prefix in PREFIXES if largest >= size), (1.0, ""))
        return size, prefix + readable_unit(unit)
    if re.match(r"kg\b", unit) and largest >= 1e3:
        return 1e3, readable_unit("t" + unit[2:])
    return 1.0, readable_unit(unit)
