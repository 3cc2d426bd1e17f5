"""Natural frequencies that are published for the hulls of the section `hulls`."""

from typing import NamedTuple

RAFT = "RAFT at e6cb69e, tests/test_model.py: its strips (OC4: WAMIT) and MoorPy's lines"
OC4_SOURCE = "NREL's forum, topic 1730, post 7, of Robertson et al. 2014 (OMAE2014-24040), figure 3"


class Published(NamedTuple):
    """Published natural frequencies.

    Attributes:
        frequency: Frequencies (Hz) by motion.
        rounding: Half of their last digit (Hz).
        source: Where they are published.
    """

    frequency: dict[str, float]
    rounding: float
    source: str


PUBLISHED: dict[str, tuple[Published, ...]] = {
    "oc3-hywind": (
        Published({"pitch": 0.034}, 5e-4, "FAST, linearised: NREL's forum, topic 2422, post 6"),
        Published(
            {"surge": 0.0081183, "heave": 0.032428, "yaw": 0.12051},
            5e-6,
            "BModes' OC3Hywind.bmi, by pyBModes at 977b3d8, cases/ECOSYSTEM_FINDING.md",
        ),
        Published({"surge": 0.00796903, "heave": 0.03245079, "pitch": 0.03384323}, 1e-8, RAFT),
    ),
    "oc4-deepcwind": (
        Published({"surge": 0.0093, "heave": 0.0578, "pitch": 0.0373}, 5e-5, OC4_SOURCE),
        Published({"surge": 0.00884301, "heave": 0.05733308, "pitch": 0.04003508, "yaw": 0.01253087}, 1e-8, RAFT),
    ),
    "volturnus-s": (Published({"surge": 0.007, "heave": 0.049, "pitch": 0.036}, 5e-4, "the report, NREL/TP-5000-76773"),),
}
