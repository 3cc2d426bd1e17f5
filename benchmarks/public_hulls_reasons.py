"""Why values of `benchmarks.public_hulls` deviate from published or expected ones, and notes on hulls."""

MOTIONS = ("surge", "sway", "heave", "roll", "pitch", "yaw")
AT_REFERENCE = "periods are those at the reference position, as RAFT's."
FAST = "MoorDyn's file of the deck is read in place of the one that the main file names."
INFINITE = "with the added mass of infinite frequency it is 107.4 s; with that of its own frequency RAFT has 113.1 s, too."
FLEXIBLE = "RAFT has 25.0 s and panels 24.9 s, with a rigid tower as here; towers are flexible in the figure's models."
NO_TABLES = "the design relies on WAMIT's tables (`hydroPath`), which are left out: it has too little added mass."
OTHER_STRIPS = (
    "the design has another mass, and its strips have less added mass than WAMIT's tables; RAFT has the same periods "
    "within 1 %."
)
OTHER_YAW = "RAFT's design has another stiffness in yaw than the report; RAFT's own test has the same period."
RM1 = (
    "the nacelle's volume is not in RAFT's run. RAFT takes two braces as if their upper ends were under water, and counts the "
    "tops of the heave plates under the columns (results-raft-designs.md)."
)
NO_MOON_POOL = (
    "WAMIT's model of the deck covers the moon pool (NREL's forum, topic 1044): its waterplane is 1600 m², that of the panels "
    "1500 m²."
)


DRAG = (
    "drag's wave force, which linear theory leaves out. Without drag, with 5 % of critical damping, in a sea of 0.1 m, the "
    "simulation has linear theory's values within 0.5 %."
)
TAUT = "its lines are taut: from 0.3 m instead of 5 m the period is 26.6 s (-1.1 %)."


def periods_of(reason: str, *motions: str) -> dict[str, str]:
    """The same reason for the periods of several motions."""
    return {f"{motion} period": reason for motion in motions}


def in_sea(reason: str) -> dict[str, str]:
    """The same reason for the standard deviations of all motions in the sea."""
    return {f"{motion} sea": reason for motion in MOTIONS}
