"""What is published of the hulls of `benchmarks.public_hulls`, or worked out by other programs."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from benchmarks.evidence.hulls_published import PUBLISHED as BY_HAND
from benchmarks.evidence.hulls_published import RAFT

RAFT_STATICS = Path(__file__).with_name("raft") / "statics.json"
PANELS = Path(__file__).with_name("hulls") / "potential-flow.json"


class Published(NamedTuple):
    """Published values of a hull, and where they stand.

    Attributes:
        source: Report and table, or program and commit.
        periods: Natural periods (s) by motion.
        mass: Mass (kg) of the whole, or None.
        volume: Displaced volume (m3), or None.
        tension: Tension of a line at the fairlead at rest (N), or None.
        pull: Vertical pull of all lines at rest (N), or None.
        rounding: Half of the last digit of frequencies (Hz).
    """

    source: str
    periods: Mapping[str, float] = {}
    mass: float | None = None
    volume: float | None = None
    tension: float | None = None
    pull: float | None = None
    rounding: float = 0.0


def by_hand(name: str) -> tuple[Published, ...]:
    """Periods that the page of validation compares the built-in platform with, other than RAFT's."""
    kept = (one for one in BY_HAND[name] if one.source != RAFT)
    return tuple(Published(one.source, {dof: 1 / f for dof, f in one.frequency.items()}, rounding=one.rounding) for one in kept)


def of_raft(design: str, frequencies: Mapping[str, float] | None = None) -> Published:
    """Mass and volume of RAFT's own matrices, and periods of its test.

    Args:
        design: The design's path in RAFT.
        frequencies: Natural frequencies (Hz) that RAFT's test states, of the unloaded platform; None: those of RAFT's
            matrices at the reference position.
    """
    statics = json.loads(RAFT_STATICS.read_text("utf-8"))[design]
    mass, volume = statics["M_struc"][0][0], statics["volume"]
    if frequencies is not None:
        periods = {dof: 1 / frequency for dof, frequency in frequencies.items()}
        return Published("RAFT at e6cb69e, its matrices and tests/test_model.py", periods, mass, volume)
    from benchmarks.raft_designs import of_raft as periods_of

    periods = {dof: period for dof, period in periods_of(statics).items() if dof in ("surge", "heave", "pitch", "yaw")}
    return Published("RAFT at e6cb69e, its matrices at the reference position", periods, mass, volume)


def panels(name: str) -> Published:
    """Periods of a hull by a panel method, worked out for this project."""
    found = json.loads(PANELS.read_text("utf-8"))[name]["periods"]
    return Published("Capytaine's panels with linear moorings (benchmarks/hulls/potential-flow.json)", found)


VOLTURNUS = Published(
    "Allen et al. (2020), NREL/TP-5000-76773",
    {"surge": 1 / 0.007, "heave": 1 / 0.049, "pitch": 1 / 0.036, "yaw": 1 / 0.011},
    20.093e6,
    20206.0,
    tension=2.437e6,
    rounding=5e-4,
)
OC3 = Published("Jonkman (2010), NREL/TP-500-47535", {}, 8066.048e3, 8029.21, pull=1.607e6)
OC4 = Published("Robertson et al. (2014), NREL/TP-5000-60601", {}, 14072.718e3, 13917.0)
BARGE = Published(
    "Jonkman (2007), NREL/TP-500-41958, by doi 10.1155/2014/139752, table 3, and NREL's forum, topic 1044",
    {},
    6149.46e3,
    6000.0,
)
IEA22 = Published(
    "IEA-22-280-RWT at 57979ec, Documentation, tabular data: parts of the mass, displacement", {}, 24027.71e3, 24460.24
)
