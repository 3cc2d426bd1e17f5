"""Hulls of `benchmarks.public_hulls`: their sources, what is published of them, and reasons of deviations."""

from collections.abc import Mapping
from typing import NamedTuple

from benchmarks.public_hulls_published import BARGE, IEA22, OC3, OC4, VOLTURNUS, Published, by_hand, of_raft, panels
from benchmarks.public_hulls_reasons import (
    AT_REFERENCE,
    DRAG,
    FAST,
    FLEXIBLE,
    INFINITE,
    NO_MOON_POOL,
    NO_TABLES,
    OTHER_STRIPS,
    OTHER_YAW,
    RM1,
    TAUT,
    in_sea,
    periods_of,
)

RELEASES = {"surge": 5.0, "heave": 1.0, "pitch": 3.0}  # m, m, deg


class Case(NamedTuple):
    """A hull.

    Attributes:
        title: What the page calls it.
        source: Its main file in the folder.
        what: What its source is, in words.
        published: What is published of it.
        edits: Values of the deck that are changed before it is read, by file and key.
        needs: Other files that have to be there.
        reasons: Why a value deviates by more than 2 %, by quantity such as `pitch period`, `mass`, `surge decay` or, by more
            than 5 %, `heave sea`.
        notes: What else is to be known of the hull.
        releases: Releases of decays (m, deg) by motion.
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
    releases: Mapping[str, float] = RELEASES
    step: float | None = None
    waves: bool = True


def moordyn(number: int, deck: str) -> dict[str, dict[str, str]]:
    """Edits that take a FAST 8 deck's MoorDyn file in place of its MAP++ or FEAMooring one."""
    return {f"Test{number}.fst": {"CompMooring": "3", "MooringFile": f'"5MW_Baseline/NRELOffshrBsline5MW_{deck}_MoorDyn.dat"'}}


OC4_DECK = "5MW_Baseline/NRELOffshrBsline5MW_OC4DeepCwindSemi_HydroDyn.dat"


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
        reasons=periods_of(NO_MOON_POOL, "heave"),
        notes=(FAST,),
    ),
    "fast-tlp": Case(
        "MIT/NREL TLP",
        "FAST/CertTest/Test23.fst",
        "FAST 8 deck",
        edits=moordyn(23, "MIT_NREL_TLP"),
        notes=(FAST, "no published natural periods were at hand."),
        releases={"surge": 5.0, "heave": 0.1, "pitch": 0.1},
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
        reasons=periods_of(NO_TABLES, "surge", "heave", "pitch", "yaw") | in_sea(DRAG),
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
        reasons=in_sea(DRAG),
        notes=(AT_REFERENCE,),
    ),
    "raft-rm1": Case(
        "RM1, floating",
        "RAFT/designs/RM1_Floating.yaml",
        "RAFT design",
        (of_raft("designs/RM1_Floating.yaml"),),
        reasons=periods_of(RM1, "surge", "heave", "pitch", "yaw")
        | {"displaced volume": RM1, "surge decay": TAUT}
        | in_sea(DRAG),
        notes=(AT_REFERENCE, "ROSCO's OpenFAST deck of it is refused: its tower hangs below the platform (MHK = 2)."),
    ),
    "raft-foctt": Case(
        "FOCTT example",
        "RAFT/designs/FOCTT_example.yaml",
        "RAFT design",
        (of_raft("designs/FOCTT_example.yaml"),),
        reasons=periods_of("RAFT has its lines, which float; they are left out here.", "surge", "heave", "pitch", "yaw"),
        notes=(
            AT_REFERENCE,
            "its lines float and are left out: it has no periods in surge, pitch and yaw, and no sea, as nothing holds it.",
        ),
        waves=False,
    ),
}
