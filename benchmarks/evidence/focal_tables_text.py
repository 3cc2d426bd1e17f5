"""Text of the section on FOCAL campaign 2 by potential flow, nothing fitted."""

from typing import Any

from benchmarks.evidence.common import table
from benchmarks.evidence.focal_tables_runs import MOTIONS, TRACKED

MODELS = {
    "strips": "strips",
    "strips-second-order-forces": "strips, second-order forces",
    "tables-around-strips": "tables around strips",
    "tables-added-mass-of-members": "tables, added mass of members",
    "tables-added-mass-of-the-table": "tables, added mass of the table",
}


def mean_rows(results: dict[str, Any]) -> list[list[str]]:
    """Mean surge (m) by model and sea, measured and simulated."""
    return [
        [MODELS[name], *("{:.2f}, {:.2f}".format(*motions["surge"]["means"]) for motions in seas.values())]
        for name, seas in results.items()
    ]


def words(results: dict[str, Any]) -> str:
    """Text of the section."""
    lines = [
        "Potential flow and strips are judged by what was measured. Nothing is fitted. Coefficients are those of the platform "
        "file (drag 1 across columns, 1.5 across pontoons), and the tables are whole. The tracked point is that of the "
        f"section before (x = {TRACKED['sensor_reference.x']:g} m, z = {TRACKED['sensor_reference.z']:g} m).",
        "",
        "- *Second-order forces*: `second_order_forces: slender_body`.",
        "- *Around strips*: the same, and the table corrects the strips (`second_order: strips`); no drift table.",
        "- *Tables*: excitation and drift in place of the strips' inertial wave load.",
        "",
    ]
    for band, label in (("wave_frequency", "Wave frequency"), ("low_frequency", "Low frequency")):
        rows = []
        for name, seas in results.items():
            for sea, motions in seas.items():
                cells = [motions[dof][band] for dof in MOTIONS]
                rows.append([MODELS[name], sea, *(f"{100 * x['energy']:+.0f} %, {x['correlation']:.2f}" for x in cells)])
        lines += [f"{label}: error of the energy, and correlation in time.", ""]
        lines += [table(["model", "sea", *MOTIONS], rows).strip(), ""]
    means = ["model", *next(iter(results.values()))]
    lines += ["Mean surge, measured and simulated (m).", "", table(means, mean_rows(results)).strip()]
    return "\n".join(lines)
