"""Plausible sizes of effects, stated in campaign.yaml: keys, quantities, units."""

import math
from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from typing import Any, NamedTuple

from jaxhydro.choices import nearest
from jaxhydro.errors import Faults, Problem, shown, suggest
from jaxhydro.units import SYMBOLS, Unit, UnknownUnit, parse_unit, split_quantity

SHARE = "%"
EXPECTED = "a quantity greater than 0 with its unit, such as 0.3 m or 50 kN, or a share, such as 2 %"
_FORCES = ("N", "N m", SHARE)
STATED_SIZES: dict[str, tuple[str, tuple[str, ...]]] = {
    "mass": ("mass_properties.mass", ("kg", SHARE)),
    "inertia": ("mass_properties.inertia_*", ("kg m2", SHARE)),
    "centre": ("mass_properties.centre_*", ("m",)),
    "tracked_point": ("sensor_reference.*", ("m",)),
    "wave_gauge": ("wave_gauge_position.*", ("m",)),
    "clock": ("sensor_lag.*", ("s",)),
    "current": ("current.*", ("m/s",)),
    "coulomb_friction": ("coulomb_friction.*", _FORCES),
    "hysteresis": ("hysteresis.*", _FORCES),
    "static_offset": ("static_offset.*", _FORCES),
    "umbilical": ("umbilical.*", ("N/m", "N", "kg", SHARE)),
    "linear_damping": ("linear_damping.*", ("N s/m", "N s", "N m s/rad", SHARE)),
    "coupled_damping": ("coupled_damping.*", ("N s/m", "N s", "N m s/rad", SHARE)),
    "coupled_stiffness": ("coupled_stiffness.*", ("N/m", "N", "N m/rad", SHARE)),
    "coupled_added_mass": ("coupled_added_mass.*", ("kg", "kg m", "kg m2", SHARE)),
    "quadratic_damping": ("quadratic_damping.*", ("N s2/m2", "N m s2/rad2", SHARE)),
    "cubic_damping": ("cubic_damping.*", ("N s3/m3", "N m s3/rad3", SHARE)),
    "radiation_memory": ("radiation_memory.*", ("N s/m", "N m s/rad", SHARE)),
    "hidden_oscillator": ("hidden_oscillator.*", ("kg", "kg m2", SHARE)),
    "stiffness": ("stiffness.*", ("N/m", "N", "N m/rad", SHARE)),
    "added_mass": ("added_mass.*", ("kg", "kg m", "kg m2", SHARE)),
    "mooring_nonlinearity": ("mooring_nonlinearity.*", (SHARE,)),
    "nonlinear_hydrostatics": ("nonlinear_hydrostatics.*", (SHARE,)),
    "wave_drift": ("wave_drift.*", ("N/m2", "N m/m2", SHARE)),
    "wave_drift_damping": ("wave_drift_damping.*", ("N s/m3", "N s/(m rad)", SHARE)),
    "wave_excitation": ("wave_excitation.*", (SHARE,)),
    "wave_reflection": ("wave_reflection.*", (SHARE,)),
    "amplitude_dependent_drag": ("amplitude_dependent_drag.*", ("-",)),
    "sea_state_dependent_drag": ("sea_state_dependent_drag.*", (SHARE,)),
    "slender_body_forces": ("slender_body_forces.*", (SHARE,)),
    "computed_excitation": ("computed_excitation.*", (SHARE,)),
    "computed_radiation": ("computed_radiation.*", (SHARE,)),
    "computed_added_mass": ("computed_added_mass.*", (SHARE,)),
    "diffraction_correction": ("diffraction_correction.*", (SHARE,)),
    "drift_transfer": ("drift_transfer.*", (SHARE,)),
}
"""Short keys: the labels that each is about, and the units that it may have."""
STATED_EFFECTS = frozenset(labels.split(".")[0] for labels, _ in STATED_SIZES.values())


class StatedSize(NamedTuple):
    """A stated size.

    Attributes:
        value: Its value in SI, or a fraction where it was stated in per cent.
        unit: Its unit; None: a fraction, or a bare number in the SI unit of the label.
        share: Whether it was stated in per cent.
    """

    value: float
    unit: Unit | None
    share: bool


def read_stated_size(value: Any) -> StatedSize:
    """Stated size from "0.3 m", "2 %" or a bare number in SI.

    Raises:
        Faults: It is neither, or not greater than 0.
    """
    if isinstance(value, str):
        number, unit = split_quantity(value) or (0.0, "")
        try:
            parsed = Unit(0.01, ()) if unit == SHARE else parse_unit(unit or "-")
        except UnknownUnit as error:
            expected = f"a unit of {', '.join(SYMBOLS)} or {SHARE}, and products of these such as N s2/m2"
            raise Faults(Problem("", expected, shown(value), suggest(error.args[0], SYMBOLS))) from None
        size = StatedSize(number * parsed.factor, None if unit == SHARE else parsed, unit == SHARE)
    else:
        number = float(value) if isinstance(value, int | float) and not isinstance(value, bool) else math.nan
        size = StatedSize(number, None, False)
    if not 0 < size.value < math.inf:
        raise Faults(Problem("", EXPECTED, shown(value)))
    return size


def check_stated_size(value: Any) -> str | float:
    """The value as it was stated, once it can be read. Raises Faults."""
    read_stated_size(value)
    return value  # type: ignore[no-any-return]


def stated_size_problems(stated: Mapping[str, str | float]) -> Iterator[Problem]:
    """Keys that are no size, and units that a key cannot have."""
    for key, value in stated.items():
        where = f"plausible.{key}"
        if key in STATED_SIZES:
            units = STATED_SIZES[key][1]
            if not _has_unit(read_stated_size(value), units):
                yield Problem(where, f"a quantity in {' or '.join(units)}", shown(value))
            continue
        effect, dot, rest = key.partition(".")
        if effect not in STATED_EFFECTS:
            near = nearest(effect, STATED_EFFECTS if dot else {*STATED_SIZES, *STATED_EFFECTS})
            expected = f"a size ({', '.join([*STATED_SIZES][:10])}, ...), or an effect's parameter, such as umbilical.pull"
            yield Problem(where, expected, repr(key), f"Did you mean '{near}{dot}{rest}'?" if near else "")
        elif not dot and not isinstance(value, str):
            yield Problem(where, EXPECTED, shown(value))


def _has_unit(size: StatedSize, units: Sequence[str]) -> bool:
    """Whether a size is in one of some units; a bare number is one without a unit."""
    if size.share:
        return SHARE in units
    powers = size.unit.powers if size.unit else parse_unit("-").powers
    return powers in [parse_unit(unit).powers for unit in units if unit != SHARE]


def is_about(key: str, label: str) -> bool:
    """Whether a key of `plausible` is about the parameter of a label."""
    pattern = STATED_SIZES[key][0] if key in STATED_SIZES else key
    return fnmatchcase(label, pattern) or label.startswith(f"{key}.")
