"""Text of the section on mooring lines at rest against MoorDyn."""

from typing import Any

import numpy as np

from benchmarks.evidence.common import table
from benchmarks.evidence.mooring_lines_runs import BED, CHAIN, FINEST_RUN, LENGTH, OFFSETS, RUNS, SEGMENTS, STIFF_RUN

Run = tuple[float, int, float]  # offset (m), segments, stiffness of the bed (Pa/m)
STRETCHED, SLACKER = 0, 1  # by an offset in surge; the third line is as the second
QUANTITIES = {
    "fairlead": "tension at the fairlead (kN)",
    "anchor": "tension at the anchor (kN)",
    "on_seabed": "length on the seabed (m)",
}
GOAL = 1e-3  # of tensions, lengths and forces, with 80 segments


def of_moordyn(run: dict[str, Any], heavy: float) -> dict[str, Any]:
    """States of the lines in a run of MoorDyn.

    The seabed carries its nodes, and the anchor the half segment beside it: what they carry over the weight is the length.
    The tension at the fairlead is the force there, half a segment's weight included; that at the anchor the first segment's.
    """
    force, anchor = np.array(run["fairlead"]), np.array(run["anchor"])
    carried = (np.array(run["bed"]) + np.maximum(-anchor[:, 2], 0.0)) / heavy
    rows = zip(np.linalg.norm(force, axis=1).tolist(), run["anchor_segment"], carried.tolist(), strict=True)
    lines = [{"fairlead": top, "anchor": low, "on_seabed": length} for top, low, length in rows]
    return {"lines": lines, "force": force.sum(axis=0).tolist(), "printed": run["fairlead_segment"]}


def differences(ours: dict[str, Any], moordyn: dict[str, Any]) -> dict[str, float]:
    """Relative differences of MoorDyn from jaxhydro: a stretched line, a slacker one, the total force."""
    apart = {
        f"{quantity}, line {i + 1}": moordyn["lines"][i][quantity] / ours["lines"][i][quantity] - 1
        for quantity in QUANTITIES
        for i in (STRETCHED, SLACKER)
    }
    apart["vertical pull"] = moordyn["force"][2] / ours["force"][2] - 1
    if ours["offset"]:
        apart["restoring force"] = moordyn["force"][0] / ours["force"][0] - 1
    return apart


def percent(share: float) -> str:
    """A relative difference as people read it."""
    return f"{100 * share:+.3f} %" if abs(share) >= 5e-6 else "< 0.0005 %"


def compared(results: dict[str, Any], runs: list[dict[str, Any]]) -> tuple[dict, dict, dict[Run, dict[str, float]]]:
    """States of the lines by both programs, and their relative differences.

    Returns:
        States by jaxhydro, by offset; states by MoorDyn, by run; and relative differences, by run.
    """
    ours = {state["offset"]: state for state in results["offsets"]}
    moordyn = {(r["offset"], r["segments"], r["bed_stiffness"]): of_moordyn(r, results["weight"]) for r in runs}
    return ours, moordyn, {run: differences(ours[run[0]], moordyn[run]) for run in RUNS}


def largest_differences(apart: dict[Run, dict[str, float]], segments: int) -> dict[str, float]:
    """Largest relative difference at any offset, of `all` quantities and by quantity.

    Args:
        apart: Relative differences, by run.
        segments: Number of segments of the runs.
    """
    pairs = [pair for offset in OFFSETS for pair in apart[offset, segments, BED].items()]
    quantities = (*QUANTITIES, "vertical pull", "restoring force")
    largest = {quantity: max(abs(x) for name, x in pairs if name.startswith(quantity)) for quantity in quantities}
    return {"all": max(abs(x) for _, x in pairs)} | largest


def value_rows(offset: float, ours: dict[str, Any], moordyn: dict[str, Any]) -> list[tuple[str, ...]]:
    """Rows of the first table: one offset."""
    rows, apart = [], differences(ours, moordyn)
    for quantity, label in QUANTITIES.items():
        scale, digits = (1.0, 2) if quantity == "on_seabed" else (1e-3, 1)
        for i in (STRETCHED, SLACKER) if offset else (STRETCHED,):
            pair = (f"{state['lines'][i][quantity] * scale:,.{digits}f}" for state in (ours, moordyn))
            of_what = f"line {i + 1}" if offset else "each line"
            rows.append((f"{offset:g}", f"{of_what}, {label}", *pair, percent(apart[f"{quantity}, line {i + 1}"])))
    for axis, label in ((2, "vertical pull"), (0, "restoring force")):
        if label in apart:
            pair = (f"{-state['force'][axis] / 1e3:,.1f}" for state in (ours, moordyn))
            rows.append((f"{offset:g}", f"all lines, {label} (kN)", *pair, percent(apart[label])))
    return rows


def words(results: dict[str, Any], runs: list[dict[str, Any]]) -> str:
    """Text of the section, from jaxhydro's results and MoorDyn's runs."""
    ours, moordyn, apart = compared(results, runs)
    fine, far = SEGMENTS[-1], OFFSETS[-1]
    largest = {n: largest_differences(apart, n) for n in SEGMENTS}
    labels = {key: label.split(" (")[0] for key, label in QUANTITIES.items()}
    by_count = [
        (labels.get(quantity, quantity), *(f"{100 * largest[n][quantity]:.3f} %" for n in SEGMENTS))
        for quantity in largest[fine]
        if quantity != "all"
    ]
    worst, finest = largest[fine]["all"], max(abs(x) for x in apart[FINEST_RUN].values())
    softer = moordyn[*STIFF_RUN[:2], BED]["lines"]
    pairs = zip(moordyn[STIFF_RUN]["lines"], softer, strict=True)
    moved = max(abs(stiff[q] / soft[q] - 1) for stiff, soft in pairs for q in stiff)
    sunk = results["weight"] / (BED * CHAIN["diameter"])
    printed = moordyn[far, fine, BED]["printed"][STRETCHED] / ours[far]["lines"][STRETCHED]["fairlead"] - 1
    changes, speed = max(r["changes"] for r in runs), max(r["speed"] for r in runs)
    rows = [row for offset in OFFSETS for row in value_rows(offset, ours[offset], moordyn[offset, fine, BED])]
    return (
        f"Tensions, lengths on the seabed and forces are within {100 * worst:.2g} % of those of MoorDyn with {fine} "
        f"segments in each line (goal {100 * GOAL:g} %: {'met' if worst < GOAL else 'not met'}). With {SEGMENTS[0]} "
        f"segments they are within {100 * largest[SEGMENTS[0]]['all']:.2g} %.\n\n"
        "VolturnUS-S on the three chains of its report (NREL/TP-5000-76773, table 8) is held at offsets in surge, upright. "
        "MoorDyn (MoorDyn-C 2.7.2) has the lines of the file that `jaxhydro export --format moordyn` writes, and runs until "
        "they are still. "
        "`python -m benchmarks.moordyn_statics` makes its results, `benchmarks/moordyn/statics.json`. "
        f"In the table each line has {fine} segments of {LENGTH / fine:.4g} m. The offset stretches line 1; lines 2 and 3 are "
        "alike.\n\n"
        + table(("Offset (m)", "Quantity", "jaxhydro", "MoorDyn", "Difference"), rows)
        + "\nLargest difference at any offset, by the number of MoorDyn's segments:\n\n"
        + table(("Quantity", *(str(n) for n in SEGMENTS)), by_count)
        + "\n- MoorDyn's lines are straight segments between lumped masses. The differences depend on where between "
        "two masses a line touches down, too: their signs change from line to line.\n"
        f"- With {FINEST_RUN[1]} segments everything is within {100 * finest:.2g} % at {far:g} m, the only offset of that "
        f"run. With {fine} it is {100 * max(abs(x) for x in apart[far, fine, BED].values()):.2g} % there: "
        "the differences fall unevenly.\n"
        f"- MoorDyn's seabed is a spring: what lies on it sinks by {1e3 * sunk:.1f} mm. A bed ten times as stiff changes "
        f"tensions and lengths by {100 * moved:.1g} % at most ({STIFF_RUN[1]} segments, {far:g} m).\n"
        "- Both programs have the same weight in water and axial stiffness, and no friction.\n"
        "- Tension at the fairlead is the force on the platform there. MoorDyn's channel `FairTen` is the tension in the "
        f"middle of the last segment, which is {percent(printed)} off at {far:g} m in line 1.\n"
        f"- Rest: over the last 50 s no fairlead's force changed by more than {changes:.1g} of itself. No mass moved by "
        f"more than {1e3 * speed:.1g} mm/s.\n"
    )


def shortcomings(results: dict[str, Any], runs: list[dict[str, Any]]) -> tuple[str, ...]:
    """What falls short of a goal."""
    worst = largest_differences(compared(results, runs)[2], SEGMENTS[-1])["all"]
    return (f"mooring lines differ from MoorDyn's by {100 * worst:.2g} % (goal {100 * GOAL:g} %)",) if worst >= GOAL else ()
