"""Mooring lines at rest against MoorDyn: tension, length on the seabed and restoring force at offsets in surge."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmarks.evidence.common import Section, cached, fingerprint, say, table

if TYPE_CHECKING:
    from jaxhydro.platform.schema import Platform

TITLE = "Mooring lines at rest against MoorDyn"
MOORDYN = Path(__file__).parents[1] / "moordyn" / "statics.json"  # made by benchmarks.moordyn_statics
OFFSETS = (0.0, 10.0, 20.0)  # m, in surge
SEGMENTS = (20, 40, 80)  # of a line in MoorDyn
BED = 3.0e6  # Pa/m, MoorDyn's default stiffness of the bed
FINEST_RUN, STIFF_RUN = (20.0, 160, BED), (20.0, 40, 10 * BED)  # offset, segments, bed stiffness
RUNS = (*((offset, segments, BED) for segments in SEGMENTS for offset in OFFSETS), STIFF_RUN, FINEST_RUN)
GOAL = 1e-3  # of tensions, lengths and forces, with 80 segments
CHAIN = {"axial_stiffness": 3.27e9, "mass_per_length": 685.0, "diameter": 0.333}  # NREL/TP-5000-76773, table 8
LINE = {"anchor": [-837.6, 0.0, -200.0], "fairlead": [-58.0, 0.0, -14.0], "heading": [0.0, 120.0, 240.0]}
LENGTH = 850.0  # m, unstretched
STRETCHED, SLACKER = 0, 1  # by an offset in surge; the third line is as the second
QUANTITIES = {
    "fairlead": "tension at the fairlead (kN)",
    "anchor": "tension at the anchor (kN)",
    "on_seabed": "length on the seabed (m)",
}


def platform() -> Platform:
    """VolturnUS-S on the three chains of its report."""
    from jaxhydro.platform.schema import Platform, load_platform

    line = LINE | {"segments": [{"type": "chain", "length": LENGTH}]}
    mooring = {"kind": "catenary", "line_types": {"chain": CHAIN}, "lines": [line]}
    return Platform.model_validate(load_platform("volturnus-s").model_dump(exclude_unset=True) | {"mooring": mooring})


def weight(declared: Platform) -> float:
    """Weight of the chain in water (N/m)."""
    return float(declared.mooring.line_types["chain"].weight(declared.water.density, declared.water.gravity))


def worked_out() -> dict[str, Any]:
    """`weight` of the chain (N/m); by offset (m) the states of the `lines` (N, m) and their `force` (N), by jaxhydro.

    The tension at the anchor is that at the fairlead less what the suspended part weighs; there is no friction.
    """
    from jaxhydro.dynamics.static_forces import forces_by_load, line_states
    from jaxhydro.platform.build import build

    declared = platform()
    model, heavy = build(declared), weight(declared)
    found = []
    for offset in OFFSETS:
        position = np.array([offset, 0.0, 0.0, 0.0, 0.0, 0.0])
        lines = []
        for line in line_states(model, position):
            along, down = line.tension * math.cos(line.angle), line.tension * math.sin(line.angle)
            lifted = down - heavy * (LENGTH - line.on_seabed)
            lines.append({"fairlead": line.tension, "anchor": math.hypot(along, lifted), "on_seabed": line.on_seabed})
        force = forces_by_load(model, position)["catenary lines"]
        found.append({"offset": offset, "lines": lines, "force": force[:3].tolist()})
    return {"weight": heavy, "offsets": found}


def of_moordyn(run: dict[str, Any], heavy: float) -> dict[str, Any]:
    """The same of a run of MoorDyn.

    The seabed carries its nodes, and the anchor the half segment beside it: what they carry over the weight is the length.
    The tension at the fairlead is the force there, half a segment's weight included; that at the anchor the first segment's.
    """
    force, anchor = np.array(run["fairlead"]), np.array(run["anchor"])
    carried = (np.array(run["bed"]) + np.maximum(-anchor[:, 2], 0.0)) / heavy
    rows = zip(np.linalg.norm(force, axis=1).tolist(), run["anchor_segment"], carried.tolist(), strict=True)
    lines = [{"fairlead": top, "anchor": low, "on_seabed": length} for top, low, length in rows]
    return {"lines": lines, "force": force.sum(axis=0).tolist(), "printed": run["fairlead_segment"]}


def differences(ours: dict[str, Any], theirs: dict[str, Any]) -> dict[str, float]:
    """MoorDyn less jaxhydro, over jaxhydro, by quantity: of the stretched line, of a slacker one, and of the force of all."""
    found = {
        f"{quantity}, line {i + 1}": theirs["lines"][i][quantity] / ours["lines"][i][quantity] - 1
        for quantity in QUANTITIES
        for i in (STRETCHED, SLACKER)
    }
    found["vertical pull"] = theirs["force"][2] / ours["force"][2] - 1
    if ours["offset"]:
        found["restoring force"] = theirs["force"][0] / ours["force"][0] - 1
    return found


def percent(share: float) -> str:
    """A relative difference as people read it."""
    return f"{100 * share:+.3f} %" if abs(share) >= 5e-6 else "< 0.0005 %"


def run(figures: Path) -> Section:
    """Statics of the lines by jaxhydro, beside MoorDyn's."""
    results = cached("mooring_lines", fingerprint(Path(__file__)), "statics", worked_out)
    return text(results, json.loads(MOORDYN.read_text("utf-8")))


def value_rows(offset: float, ours: dict[str, Any], theirs: dict[str, Any]) -> list[tuple[str, ...]]:
    """Rows of the first table: one offset."""
    rows, apart = [], differences(ours, theirs)
    for quantity, words in QUANTITIES.items():
        scale, digits = (1.0, 2) if quantity == "on_seabed" else (1e-3, 1)
        for i in (STRETCHED, SLACKER) if offset else (STRETCHED,):
            pair = (f"{one['lines'][i][quantity] * scale:,.{digits}f}" for one in (ours, theirs))
            of_what = f"line {i + 1}" if offset else "each line"
            rows.append((f"{offset:g}", f"{of_what}, {words}", *pair, percent(apart[f"{quantity}, line {i + 1}"])))
    for axis, words in ((2, "vertical pull"), (0, "restoring force")):
        if words in apart:
            pair = (f"{-one['force'][axis] / 1e3:,.1f}" for one in (ours, theirs))
            rows.append((f"{offset:g}", f"all lines, {words} (kN)", *pair, percent(apart[words])))
    return rows


def text(results: dict[str, Any], runs: list[dict[str, Any]]) -> Section:
    """Section of the page from jaxhydro's results and MoorDyn's runs."""
    ours = {one["offset"]: one for one in results["offsets"]}
    theirs = {(r["offset"], r["segments"], r["bed_stiffness"]): of_moordyn(r, results["weight"]) for r in runs}
    apart = {key: differences(ours[key[0]], theirs[key]) for key in RUNS}
    fine, far = SEGMENTS[-1], OFFSETS[-1]
    largest = {n: {"all": max(abs(x) for offset in OFFSETS for x in apart[offset, n, BED].values())} for n in SEGMENTS}
    for n, found in largest.items():
        for words in (*QUANTITIES, "vertical pull", "restoring force"):
            every = (abs(x) for offset in OFFSETS for key, x in apart[offset, n, BED].items() if key.startswith(words))
            found[words] = max(every)
    shown = {key: words.split(" (")[0] for key, words in QUANTITIES.items()}
    by_count = [
        (shown.get(words, words), *(f"{100 * largest[n][words]:.3f} %" for n in SEGMENTS))
        for words in largest[fine]
        if words != "all"
    ]
    worst, finest = largest[fine]["all"], max(abs(x) for x in apart[FINEST_RUN].values())
    softer = theirs[*STIFF_RUN[:2], BED]["lines"]
    moved = max(abs(one[q] / other[q] - 1) for one, other in zip(theirs[STIFF_RUN]["lines"], softer, strict=True) for q in one)
    sunk = results["weight"] / (BED * CHAIN["diameter"])
    printed = theirs[far, fine, BED]["printed"][STRETCHED] / ours[far]["lines"][STRETCHED]["fairlead"] - 1
    changes, speed = max(r["changes"] for r in runs), max(r["speed"] for r in runs)
    say(f"  {100 * worst:.3f} % with {fine} segments, {100 * finest:.3f} % with {FINEST_RUN[1]} at {far:g} m")
    rows = [row for offset in OFFSETS for row in value_rows(offset, ours[offset], theirs[offset, fine, BED])]
    body = (
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
    short = (f"mooring lines differ from MoorDyn's by {100 * worst:.2g} % (goal {100 * GOAL:g} %)",) if worst >= GOAL else ()
    return Section(TITLE, body, (), short)
