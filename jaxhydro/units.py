"""Units of files, of stated quantities, and of printed motions (m and degrees)."""

import math
import re
from typing import NamedTuple

import numpy as np

from jaxhydro.environment import DOFS

SI = {  # units that files may state, by quantity, and what they are in SI
    "time": {"s": 1.0, "ms": 1e-3, "min": 60.0},
    "length": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "ft": 0.3048},
    "angle": {"rad": 1.0, "mrad": 1e-3, "deg": 0.017453292519943295},
}


def unit_of(channel: str) -> str:
    """Unit in which a channel is printed: m or deg."""
    return "deg" if channel in DOFS[3:] else "m"


def for_people(channel: str, values: np.ndarray | float) -> np.ndarray:
    """SI values of a channel in the unit in which it is printed."""
    return np.rad2deg(values) if unit_of(channel) == "deg" else np.asarray(values)


BASE = ("m", "kg", "s", "rad")  # units that all others are products of
_BASE_OF_QUANTITY = {"length": (1, 0, 0, 0), "time": (0, 0, 1, 0), "angle": (0, 0, 0, 1)}
_FORCE, _MASS = (1, 1, -2, 0), (0, 1, 0, 0)
SYMBOLS: dict[str, tuple[float, tuple[int, ...]]] = {
    **{name: (size, _BASE_OF_QUANTITY[quantity]) for quantity, units in SI.items() for name, size in units.items()},
    **{"N": (1.0, _FORCE), "kN": (1e3, _FORCE), "MN": (1e6, _FORCE), "GN": (1e9, _FORCE)},
    **{"g": (1e-3, _MASS), "kg": (1.0, _MASS), "t": (1e3, _MASS), "Hz": (1.0, (0, 0, -1, 0))},
}
"""Factor to SI and powers of `BASE` of every unit that a product of units may have."""
_SUPERSCRIPTS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻·*", "0123456789-  ")
_FACTOR = re.compile(r"([A-Za-z]+)(?:\^?(-?[0-9]))?")
_QUANTITY = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(\S.*)")


class Unit(NamedTuple):
    """Unit made of others.

    Attributes:
        factor: Value in SI of one such unit.
        powers: Powers of `BASE`.
    """

    factor: float
    powers: tuple[int, ...]


class UnknownUnit(ValueError):
    """A text that is no product of known units; its one argument is the part that is not known."""


def parse_unit(text: str) -> Unit:
    """Unit from a text such as "kN s2/m2", "N m/rad", "N·s²/m²" or "-".

    All that follows a slash is divided by, as in "N s/(m rad)".

    Raises:
        UnknownUnit: The text is no product of the units in `SYMBOLS`.
    """
    factor, powers = 1.0, [0] * len(BASE)
    parts = [part.strip("() ") for part in text.replace("**", "^").translate(_SUPERSCRIPTS).split("/")]
    for i, part in enumerate(parts):
        for name in [] if i == 0 and part in ("-", "1") else part.split() or [part]:
            match = _FACTOR.fullmatch(name)
            if match is None or match[1] not in SYMBOLS:
                raise UnknownUnit(match[1] if match else name)
            power = int(match[2] or 1) * (-1 if i else 1)
            size, base = SYMBOLS[match[1]]
            factor *= size**power
            powers = [total + power * exponent for total, exponent in zip(powers, base, strict=True)]
    return Unit(factor, tuple(powers))


def split_quantity(text: str) -> tuple[float, str] | None:
    """Number and unit of a text such as "0.3 m" or "2 %"; None where it is no finite number with a unit."""
    match = _QUANTITY.fullmatch(text.strip())
    return (float(match[1]), match[2]) if match and np.isfinite(float(match[1])) else None


def rounded_up(value: float, digits: int = 2) -> float:
    """The next number of so many significant digits: 1385 s become 1400 s."""
    digit = 10.0 ** (math.floor(math.log10(value)) + 1 - digits)
    return float(f"{math.ceil(value / digit - 1e-9) * digit:.10g}")
