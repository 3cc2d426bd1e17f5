"""Text of the section on the laboratory of FOCAL campaign 2."""

from typing import Any

import numpy as np

from benchmarks.evidence.common import table
from benchmarks.evidence.focal_laboratory_runs import BAND, MIN_COHERENCE

OTHER_MASS = 2.0498e7  # kg: the other published mass matrix (../shared/measured/SOURCE.md)
QUANTITIES = {
    "gauge, further along the waves (m)": "distance",
    "tracked point, height (m)": "height",
    "tracked point, along the waves (m)": "ahead",
}


def rows_of(results: dict[str, Any]) -> list[list[str]]:
    """Quantities by sea, then their mean and standard deviation over the seas."""
    rows = []
    for label, quantity in QUANTITIES.items():
        values = np.array([sea[quantity] for sea in results["seas"].values()])
        rows.append([label, *(f"{v:.1f}" for v in values), f"{values.mean():.1f} ± {values.std(ddof=1):.1f}"])
    return rows


def words(results: dict[str, Any]) -> str:
    """Text of the section."""
    lines = [
        "This is to judge what `jaxhydro diagnose` names. No strip of this project takes part.",
        "",
        "- Measured transfer functions are compared with linear potential flow on the same hull: WAMIT's coefficients in "
        "focal-c4, the mass and mooring of campaign 2.",
        "- Surge of a point at height z is S e^(ikd) + z P. S is surge by potential flow. P is pitch as measured. The "
        "wavenumber is k. The gauge stood further along the waves by d.",
        "- Heave of a point at x is H e^(ikd) - x P. H is heave by potential flow.",
        "- d, z and x minimise the relative errors of both surge and heave. All lines from "
        f"{BAND[0]} to {BAND[1]} Hz with a coherence above {MIN_COHERENCE} in all three motions count. "
        "The last column has the mean of the seas and their standard deviation.",
        "",
        table(["", *results["seas"], "mean"], rows_of(results)).strip(),
        "",
        "Two more things say that the keel was tracked, 20 m below still water (section *Measured waves*). They are heave as "
        "recorded in still water, and how far surge moves with pitch in its resonance.",
        "",
        f"Mass: the campaign's own numbers say {results['mass'] / 1e3:.0f} t. Another published mass matrix of the hull says "
        f"{OTHER_MASS / 1e3:.0f} t, {100 * (OTHER_MASS / results['mass'] - 1):+.1f} %.",
    ]
    return "\n".join(lines)
