"""Hulls of `benchmarks.public_hulls`: their sources, what is published of them, and reasons of deviations."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from benchmarks.evidence.hulls_published import PUBLISHED as BY_HAND
from benchmarks.evidence.hulls_published import RAFT

MOTIONS = ("surge", "sway", "heave", "roll", "pitch", "yaw")
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


class Case(NamedTuple):
    """A hull.

    Attributes:
        title: What the page calls it.
        source: Its main file in the folder.
        what: What its source is, in words.
        published: What is published of it.
        edits: Values of the deck that are changed before it is read, by file and key.
        needs: Other files that have to be there.
        reasons: Why a value deviates by more than 2 %, by quantity such as `pitch period` or `mass`.
        notes: What else is to be known of the hull.
        release: Release in heave (m).
        step: Largest time step (s), or None: the usual one.
        waves: Whether the hull has wave forces.
    """

    title: str
    source: str
    what: str
    published: tuple[Published, ...] = ()
    edits: Mapping[str, Mapping[str, str]] = {}
    needs: tuple[str, ...] = ()
    reasons: Mapping[str, str] = {}
    notes: tuple[str, ...] = ()
    release: float = 1.0
    step: float | None = None
    waves: bool = True


def moordyn(number: int, deck: str) -> dict[str, dict[str, str]]:
    """Edits that take a FAST 8 deck's MoorDyn file in place of its MAP++ or FEAMooring one."""
    return {f"Test{number}.fst": {"CompMooring": "3", "MooringFile": f'"5MW_Baseline/NRELOffshrBsline5MW_{deck}_MoorDyn.dat"'}}


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
AT_REFERENCE = "periods are those at the reference position, as RAFT's."
FAST = "MoorDyn's file of the deck is read in place of the one that the main file names."
OC4_DECK = "5MW_Baseline/NRELOffshrBsline5MW_OC4DeepCwindSemi_HydroDyn.dat"
INFINITE = "with the added mass of infinite frequency it is 107.4 s; with that of its own frequency RAFT has 113.1 s, too."
FLEXIBLE = "RAFT has 25.0 s and panels 24.9 s, with a rigid tower as here; towers are flexible in the figure's models."
NO_TABLES = "the design relies on WAMIT's tables (`hydroPath`), which are left out: it has too little added mass."
OTHER_STRIPS = (
    "the design has another mass, and its strips have less added mass than WAMIT's tables; RAFT has the same periods "
    "within 1 %."
)
OTHER_YAW = "RAFT's design has another stiffness in yaw than the report; RAFT's own test has the same period."
RM1 = "the nacelle's volume is not in RAFT's run; the rest is not explained yet (results-raft-designs.md)."


def periods_of(reason: str, *motions: str) -> dict[str, str]:
    """The same reason for the periods of several motions."""
    return {f"{motion} period": reason for motion in motions}


CASES: dict[str, Case] = {
    "iea-15": Case(
        "VolturnUS-S",
        "IEA-15-240-RWT/OpenFAST/IEA-15-240-RWT-UMaineSemi/IEA-15-240-RWT-UMaineSemi.fst",
        "OpenFAST deck",
        (VOLTURNUS,),
    ),
    "iea-22": Case(
        "IEA 22 MW semi-submersible",
        "IEA-22-280-RWT/OpenFAST/IEA-22-280-RWT-Semi/IEA-22-280-RWT-Semi.fst",
        "OpenFAST deck",
        (IEA22,),
        notes=("no published natural periods were at hand.",),
    ),
    "fast-oc3": Case(
        "OC3-Hywind",
        "FAST/CertTest/Test24.fst",
        "FAST 8 deck",
        (OC3, *by_hand("oc3-hywind")),
        moordyn(24, "OC3Hywind"),
        notes=(FAST,),
    ),
    "fast-oc4": Case(
        "OC4-DeepCwind",
        "FAST/CertTest/Test25.fst",
        "FAST 8 deck",
        (OC4, *by_hand("oc4-deepcwind")),
        {OC4_DECK: {"ExctnMod": "0"}},
        reasons=periods_of(INFINITE, "surge") | periods_of(FLEXIBLE, "pitch"),
        notes=(
            "its table of wave forces, marin_semi.3, was not at hand: it is read without wave forces, and has no sea here.",
        ),
        waves=False,
    ),
    "fast-barge": Case(
        "ITI Energy barge",
        "FAST/CertTest/Test22.fst",
        "FAST 8 deck",
        (BARGE, panels("iti-barge")),
        moordyn(22, "ITIBarge4"),
        notes=(FAST,),
    ),
    "fast-tlp": Case(
        "MIT/NREL TLP",
        "FAST/CertTest/Test23.fst",
        "FAST 8 deck",
        edits=moordyn(23, "MIT_NREL_TLP"),
        notes=(FAST, "no published natural periods were at hand."),
        release=0.1,
        step=0.1,
    ),
    "raft-oc3": Case(
        "OC3-Hywind",
        "RAFT/tests/test_data/OC3spar.yaml",
        "RAFT design",
        (
            of_raft(
                "tests/test_data/OC3spar.yaml",
                {"surge": 0.00796903, "heave": 0.03245079, "pitch": 0.03384323, "yaw": 0.15347415},
            ),
            *by_hand("oc3-hywind"),
        ),
        reasons=periods_of(OTHER_YAW, "yaw"),
    ),
    "raft-oc4": Case(
        "OC4-DeepCwind",
        "RAFT/tests/test_data/OC4semi-WAMIT_Coefs.yaml",
        "RAFT design",
        (
            of_raft(
                "tests/test_data/OC4semi-WAMIT_Coefs.yaml",
                {"surge": 0.00884301, "heave": 0.05733308, "pitch": 0.04003508, "yaw": 0.01253087},
            ),
        ),
        reasons=periods_of(NO_TABLES, "surge", "heave", "pitch", "yaw"),
    ),
    "raft-volturnus": Case(
        "VolturnUS-S",
        "RAFT/tests/test_data/VolturnUS-S.yaml",
        "RAFT design",
        (
            of_raft(
                "tests/test_data/VolturnUS-S.yaml",
                {"surge": 0.0078218, "heave": 0.06073036, "pitch": 0.03823218, "yaw": 0.01238992},
            ),
            VOLTURNUS,
        ),
        reasons=periods_of(OTHER_STRIPS, "surge", "heave", "pitch", "yaw")
        | {"mass": OTHER_STRIPS, "displaced volume": OTHER_STRIPS},
    ),
    "raft-oc4-strips": Case(
        "OC4-DeepCwind, strips alone",
        "RAFT/designs/OC4semi.yaml",
        "RAFT design",
        (of_raft("designs/OC4semi.yaml"), OC4),
        notes=(AT_REFERENCE,),
    ),
    "raft-rm1": Case(
        "RM1, floating",
        "RAFT/designs/RM1_Floating.yaml",
        "RAFT design",
        (of_raft("designs/RM1_Floating.yaml"),),
        reasons=periods_of(RM1, "surge", "heave", "pitch", "yaw") | {"displaced volume": RM1},
        notes=(AT_REFERENCE, "ROSCO's OpenFAST deck of it is refused: its tower hangs below the platform (MHK = 2)."),
    ),
    "raft-foctt": Case(
        "FOCTT example",
        "RAFT/designs/FOCTT_example.yaml",
        "RAFT design",
        (of_raft("designs/FOCTT_example.yaml"),),
        reasons=periods_of("RAFT has its lines, which float; they are left out here.", "surge", "heave", "pitch", "yaw"),
        notes=(AT_REFERENCE, "its lines float and are left out: it has no periods in surge, pitch and yaw."),
    ),
}
