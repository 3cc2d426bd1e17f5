"""Hulls of the section `hulls`: their files, a wave for each, and natural periods (s) published for them."""

from pathlib import Path
from typing import Any, NamedTuple

HULLS = Path(__file__).resolve().parents[1] / "hulls"
PLATFORMS = Path(__file__).resolve().parents[2] / "jaxhydro" / "platforms"
RAFT = "RAFT at e6cb69e, tests/test_model.py: its strips (OC4: WAMIT) and MoorPy's lines"
OC4_SOURCE = "NREL's forum, topic 1730, post 7, of Robertson et al. 2014 (OMAE2014-24040), figure 3"


class Published(NamedTuple):
    """Natural frequencies (Hz) by motion, half of their last digit (Hz), and where they stand."""

    frequency: dict[str, float]
    rounding: float
    source: str


class Case(NamedTuple):
    """A hull: its title, platform file, a wave's period (s), amplitude (m) and heading (deg), and what is published."""

    title: str
    path: Path
    period: float
    amplitude: float
    heading: float
    published: tuple[Published, ...] = ()

    @property
    def moved(self) -> tuple[str, ...]:
        """Motions that the wave makes."""
        return ("surge", "heave", "pitch") if self.heading == 0 else ("sway", "heave", "roll")


CASES = {
    "oc3-hywind": Case(
        "OC3-Hywind",
        PLATFORMS / "oc3-hywind.yaml",
        20.0,
        0.01,
        0.0,
        (
            Published({"pitch": 0.034}, 5e-4, "FAST, linearised: NREL's forum, topic 2422, post 6"),
            Published(
                {"surge": 0.0081183, "heave": 0.032428, "yaw": 0.12051},
                5e-6,
                "BModes' OC3Hywind.bmi, by pyBModes at 977b3d8, cases/ECOSYSTEM_FINDING.md",
            ),
            Published({"surge": 0.00796903, "heave": 0.03245079, "pitch": 0.03384323}, 1e-8, RAFT),
        ),
    ),
    "oc4-deepcwind": Case(
        "OC4-DeepCwind",
        PLATFORMS / "oc4-deepcwind.yaml",
        14.0,
        0.01,
        0.0,
        (
            Published({"surge": 0.0093, "heave": 0.0578, "pitch": 0.0373}, 5e-5, OC4_SOURCE),
            Published({"surge": 0.00884301, "heave": 0.05733308, "pitch": 0.04003508, "yaw": 0.01253087}, 1e-8, RAFT),
        ),
    ),
    "volturnus-s": Case(
        "VolturnUS-S",
        PLATFORMS / "volturnus-s.yaml",
        14.0,
        0.01,
        0.0,
        (Published({"surge": 0.007, "heave": 0.049, "pitch": 0.036}, 5e-4, "the report, NREL/TP-5000-76773"),),
    ),
    "iti-barge": Case("ITI Energy barge", PLATFORMS / "iti-barge.yaml", 20.0, 0.01, 0.0),
    "ship-section": Case("ship section, 0.4 m wide", PLATFORMS / "ship-section.yaml", 3.0, 2e-4, 90.0),
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
    others = [member for member in platform["members"] if member["name"] != "offset_column"]
    return platform | {"members": [*others, BASES | same, UPPER | same]}


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
