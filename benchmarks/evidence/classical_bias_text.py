"""Text of the section on P-Q analysis against the fit in the time domain."""

from typing import Any

import numpy as np

from benchmarks.evidence.classical_bias_runs import DURATION, FACTORS, LABELS, NOISE, RELEASED
from benchmarks.evidence.common import table


def words(results: list[dict[str, Any]]) -> str:
    """Text of the section, from the results by factor."""

    def interval(triple: list[float]) -> str:
        return f"{triple[0]:.2f} [{triple[1]:.2f}, {triple[2]:.2f}]"

    rows = []
    for factor, row in zip(FACTORS, results, strict=True):
        fit = [f"{value:.3f} ± {deviation:.3f}" for value, deviation in (row["fit"][label] for label in reversed(LABELS))]
        if "pq" in row:
            pq = [f"{100 * row['first_ratio']:.0f} %", str(row["half_cycles"]), *map(interval, row["pq"])]
        else:
            pq = ["–", "–", "refused", "refused"]
        rows.append([f"{factor:g}", *pq, *fit])
    heads = (
        "Factor",
        "First half cycle's ratio",
        "Half cycles",
        "p / true [95 %]",
        "q / true [95 %]",
        "B33 / true ± sd",
        "`pontoon.Cd_z` / true ± sd",
    )
    return f"""
A heave decay of the NumPy model starts from {RELEASED:g} m and lasts {DURATION:g} s, with noise of {1000 * NOISE:g} mm. The
pontoon's drag is multiplied by a factor and B33 by its square. The P-Q analysis (`classical`) gives p and q. They should be
B_lin/M and B_quad/M of the model (`model_damping`). The fit in the time domain frees the two coefficients, begun 1.6 times too
small. Everything else stays as it is.

{table(heads, rows)}
P-Q assumes that an extreme is a turning point of an undamped oscillation, and that a half cycle's amplitude is constant. The
fit has no such assumption. {held(results)}
"""


def held(results: list[dict[str, Any]]) -> str:
    """How far P-Q is off, and how often its intervals hold the truth."""
    pairs = [result["pq"] for result in results if "pq" in result]
    inside = sum(low <= 1 <= high for pair in pairs for _, low, high in pair)
    off = [max((pair[i][0] - 1 for pair in pairs), key=abs) for i in (0, 1)]
    wide = [np.ptp(pairs[-1][i][1:]) / 2 for i in (0, 1)]
    linear, quadratic = (100 * results[-1]["fit"][label][1] for label in reversed(LABELS))
    return f"""At most p is {100 * off[0]:+.0f} % and q {100 * off[1]:+.0f} % off; {inside} of {2 * len(pairs)} intervals
hold the truth. For the strongest damping they reach {100 * wide[0]:.0f} and {100 * wide[1]:.0f} % either way, from
{results[-1].get("half_cycles")} half cycles. The fit's deviations are {linear:.1f} and {quadratic:.1f} % there."""


def shortcomings(results: list[dict[str, Any]]) -> tuple[str, ...]:
    """What falls short of a goal."""
    worst = max(abs(row["fit"][label][0] - 1) / max(row["fit"][label][1], 1e-9) for row in results for label in LABELS)
    return (f"a coefficient of the time-domain fit is {worst:.1f} of its deviations off",) if worst > 3.5 else ()
