"""Hulls of the section `hulls`: their platform files, and a regular wave for each."""

from pathlib import Path
from typing import Any, NamedTuple

HULLS = Path(__file__).resolve().parents[1] / "hulls"
PLATFORMS = Path(__file__).resolve().parents[2] / "jaxhydro" / "platforms"


class Case(NamedTuple):
    """A hull and a regular wave.

    Attributes:
        path: Platform file.
        period: Period of the wave (s).
        amplitude: Amplitude of the wave (m).
        heading: Direction that the wave runs to (deg).
    """

    path: Path
    period: float
    amplitude: float
    heading: float

    @property
    def moved(self) -> tuple[str, ...]:
        """Motions that the wave makes."""
        return ("surge", "heave", "pitch") if self.heading == 0 else ("sway", "heave", "roll")


CASES = {
    "oc3-hywind": Case(PLATFORMS / "oc3-hywind.yaml", 20.0, 0.01, 0.0),
    "oc4-deepcwind": Case(PLATFORMS / "oc4-deepcwind.yaml", 14.0, 0.01, 0.0),
    "volturnus-s": Case(PLATFORMS / "volturnus-s.yaml", 14.0, 0.01, 0.0),
    "iti-barge": Case(PLATFORMS / "iti-barge.yaml", 20.0, 0.01, 0.0),
    "ship-section": Case(PLATFORMS / "ship-section.yaml", 3.0, 2e-4, 90.0),
}
BASES = {
    "name": "base_column",
    "shape": "circ",
    "d": 24.0,
    "rA": [28.868, 0, -20],
    "rB": [28.868, 0, -14],
    "maccamy_fuchs": True,
}
UPPER = {"name": "upper_column", "shape": "circ", "d": 12.0, "rA": [28.868, 0, -14], "rB": [28.868, 0, 12]}


def two_members(platform: dict[str, Any]) -> dict[str, Any]:
    """OC4-DeepCwind with its offset columns as two members, a base and what is above.

    A base does not pierce the surface, so that it has to be told to diffract as the stepped column does.
    """
    same = {"group": "column", "heading": [60, 180, 300]}
    members = [member for member in platform["members"] if member["name"] != "offset_column"]
    return platform | {"members": [*members, BASES | same, UPPER | same]}


LENGTHS = {"d", "rA", "rB", "stations", "depth", "centre_of_mass", "displaced_volume"}
POWERS = {"mass": 3, "Ixx": 5, "Iyy": 5, "Izz": 5, "displaced_volume": 3, "C44_buoyancy": 4, "C55_buoyancy": 4}


def scaled(value: Any, length: float, key: str = "") -> Any:
    """A platform file at another length, by Froude's law, in the same water: 1/50 makes a model at 1:50."""
    if isinstance(value, dict):
        return {k: scaled(v, length, k) for k, v in value.items()}
    if key == "preload":
        return [x * length ** (3 if i < 3 else 4) for i, x in enumerate(value)]
    if isinstance(value, list):
        return [scaled(v, length, key) for v in value]
    if isinstance(value, bool) or not isinstance(value, int | float):
        return value
    if len(key) == 3 and key[0] in "BC" and key[1:].isdigit():
        turns = sum(int(digit) > 3 for digit in key[1:])
        return value * length ** ((2 if key[0] == "C" else 2.5) + turns)
    return value * length ** POWERS.get(key, 1 if key in LENGTHS else 0)
