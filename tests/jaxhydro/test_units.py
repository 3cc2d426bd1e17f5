"""Units written as text."""

import pytest

from jaxhydro.loads import LOADS
from jaxhydro.sensors import SENSOR_EFFECTS
from jaxhydro.units import UnknownUnit, parse_unit, split_quantity
from jaxhydro.water import WATER_EFFECTS


@pytest.mark.parametrize(
    ("text", "factor", "powers"),
    [
        ("-", 1.0, (0, 0, 0, 0)),
        ("m", 1.0, (1, 0, 0, 0)),
        ("cm", 0.01, (1, 0, 0, 0)),
        ("deg/s", 0.017453292519943295, (0, 0, -1, 1)),
        ("kN", 1e3, (1, 1, -2, 0)),
        ("kN/m^2", 1e3, (-1, 1, -2, 0)),
        ("N m s2/rad2", 1.0, (2, 1, 0, -2)),
        ("N·s²/m²", 1.0, (-1, 1, 0, 0)),
        ("N*s**2/m**2", 1.0, (-1, 1, 0, 0)),
        ("N s/(m rad)", 1.0, (0, 1, -1, -1)),
        ("m/s/s", 1.0, (1, 0, -2, 0)),
        ("1/s", 1.0, (0, 0, -1, 0)),
        ("Hz", 1.0, (0, 0, -1, 0)),
        ("t", 1e3, (0, 1, 0, 0)),
        ("m s^-1", 1.0, (1, 0, -1, 0)),
    ],
)
def test_a_unit_is_a_factor_and_powers(text, factor, powers):
    unit = parse_unit(text)
    assert unit.factor == pytest.approx(factor) and unit.powers == powers


@pytest.mark.parametrize("text", ["", "kM", "m/", "/m", "m//s", "m2.5", "%", "N m)x"])
def test_what_is_no_unit(text):
    with pytest.raises(UnknownUnit):
        parse_unit(text)


def test_a_quantity_is_a_number_and_a_unit():
    assert split_quantity("0.3 m") == (0.3, "m")
    assert split_quantity(" -2%") == (-2.0, "%")
    assert split_quantity("1.5e3 kN/m^2") == (1500.0, "kN/m^2")
    assert [split_quantity(text) for text in ("m", "3", "nan m", "inf m", "1e999 m", "")] == [None] * 6


def test_units_of_all_effects_can_be_read():
    """Of every parameter with a neutral load: else no stated size could be compared with it."""
    seen = 0
    for effect in {**LOADS, **WATER_EFFECTS, **SENSOR_EFFECTS}.values():
        try:
            load = effect.neutral(getattr(effect, "allowed", ("surge", "pitch"))) if hasattr(effect, "neutral") else effect()
        except (TypeError, ValueError):  # made of a body, of tables, of groups of members
            continue
        for label in load.values:
            parse_unit(load.about(label).unit)
            seen += 1
    assert seen > 30
