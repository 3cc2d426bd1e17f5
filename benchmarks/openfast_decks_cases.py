"""Platforms of `benchmarks.openfast_decks`: offsets of their decays, durations, and whether they are run in waves."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

HEIGHT, HS, TP = 4.0, 3.0, 10.0  # m of the regular wave; m and s of the sea
OFFSETS = {"surge": 10.0, "heave": 3.0, "pitch": math.radians(5.0)}  # m, m, rad
CHAIN = {"axial_stiffness": 3.27e9, "mass_per_length": 685.0, "diameter": 0.333}
LINE = {"anchor": [837.6, 0.0, -200.0], "fairlead": [58.0, 0.0, -14.0], "heading": [60.0, 180.0, 300.0]}
CATENARIES = {
    "kind": "catenary",
    "line_types": {"chain": CHAIN},
    "lines": [LINE | {"segments": [{"type": "chain", "length": 850.0}]}],
}


class Case(NamedTuple):
    """A platform.

    Attributes:
        title: What the page calls it.
        platform: Its built-in name.
        offsets: Offsets (m, rad) from rest, by motion.
        duration: Of a decay, s.
        waves: Whether it is run in waves.
        duration_in_waves: Duration in waves, s.
        transient: Of that, left out, s.
        lines: Whether MoorDyn has its mooring lines.
        step: Time step of OpenFAST in decays and waves (s), or None: that of the deck.
        changes: Sections of the platform file that replace the platform's own.
    """

    title: str
    platform: str
    offsets: Mapping[str, float] = OFFSETS
    duration: float = 250.0
    waves: bool = True
    duration_in_waves: float = 500.0
    transient: float = 150.0
    lines: bool = False
    step: float | None = 0.05
    changes: Mapping[str, Any] = {}


CASES: dict[str, Case] = {
    "oc3-hywind": Case("OC3-Hywind", "oc3-hywind"),
    "volturnus-s": Case("VolturnUS-S", "volturnus-s"),
    "oc4-deepcwind": Case("OC4-DeepCwind", "oc4-deepcwind"),
    "volturnus-s-catenaries": Case(
        "VolturnUS-S with catenaries", "volturnus-s", waves=False, lines=True, step=None, changes={"mooring": CATENARIES}
    ),
    "mit-nrel-tlp": Case(
        "MIT/NREL TLP",
        "mit-nrel-tlp",
        {"surge": 5.0, "heave": 0.1, "pitch": 0.002},
        duration=120.0,
        waves=False,
        lines=True,
        step=None,
    ),
    "oc3-monopile": Case(
        "OC3 monopile",
        "oc3-monopile",
        {},
        waves=False,
        step=None,
    ),
}
