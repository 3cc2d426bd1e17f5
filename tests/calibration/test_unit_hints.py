"""Coefficients that a mistaken unit or sign explains."""

import math

import pytest

from calibration.fitting.unit_hints import unit_hints
from calibration.result import Estimate


def hints(value: float, start: float, deviation: float | None = None, identifiable: bool = True) -> list[str]:
    deviation = 0.01 * abs(value) if deviation is None else deviation
    return list(unit_hints([Estimate("quadratic_damping.B44", value, deviation, "-", "damping", start, False, identifiable)]))


@pytest.mark.parametrize(
    ("ratio", "expected"),
    [
        (180 / math.pi, "57.3 times the declared value: are degrees and radians mixed up"),
        (math.pi / 180, "1/57.3 of the declared value: are degrees and radians mixed up"),
        (1010.0, "times the declared value: are millimetres and metres mixed up"),
        (-1.02, "has the declared size and the other sign"),
    ],
)
def test_what_is_told(ratio: float, expected: str) -> None:
    (hint,) = hints(5.0 * ratio, 5.0)
    assert expected in hint


@pytest.mark.parametrize(
    ("value", "start", "deviation", "identifiable"),
    [
        (5.0, 5.0, None, True),
        (40.0, 1.0, None, True),
        (-2.0, 1.0, None, True),  # no ratio of units
        (57.3, 1.0, 10.0, True),
        (57.3, 1.0, None, False),  # not known well enough
        (57.3, 0.0, None, True),
        (0.0, 1.0, 0.1, True),  # no ratio at all
    ],
)
def test_what_is_not(value: float, start: float, deviation: float | None, identifiable: bool) -> None:
    assert hints(value, start, deviation, identifiable) == []
