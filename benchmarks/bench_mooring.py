"""An hour of the same sea on three catenaries, on springs, and on a stiffness matrix: what mooring lines cost."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from benchmarks.bench_sea import CUTOFF, HEIGHT, LOW, PERIOD, STEP, Hour
from benchmarks.bench_timing import Row, contest, times
from benchmarks.openfast_decks_cases import CATENARIES
from jaxhydro import Platform, load_platform

PLATFORM = "volturnus-s"
HEADINGS = (60.0, 180.0, 300.0)  # deg, of the lines
FAIRLEAD, DEPTH, RADIUS = -14.0, 200.0, 58.0  # m: height of the fairleads, of the water, and radius of the fairleads
TENSION, PULL = 2.437e6, 6.062e6  # N: of each chain at its fairlead at rest, and of the three downwards
SPRING = 7.0e4  # N/m, near the chains' stiffness in surge and heave


def springs() -> dict[str, Any]:
    """Section `mooring`: three straight springs with the tension and the angle of the chains at their fairleads."""
    sine = PULL / (3 * TENSION)
    across = RADIUS + (DEPTH + FAIRLEAD) * math.sqrt(1 - sine**2) / sine
    lines = []
    for heading in np.radians(HEADINGS):
        way = np.array([math.cos(heading), math.sin(heading)])
        fairlead, anchor = [*(RADIUS * way).tolist(), FAIRLEAD], [*(across * way).tolist(), -DEPTH]
        lines.append({"anchor": anchor, "fairlead": fairlead, "stiffness": SPRING, "pretension": TENSION})
    return {"kind": "linear_springs", "lines": lines}


def moored(mooring: dict[str, Any] | None) -> Platform:
    """The platform with a section `mooring` in place of its stiffness matrix; None: as it is."""
    raw = load_platform(PLATFORM).model_dump(exclude_unset=True)
    return Platform.model_validate(raw if mooring is None else raw | {"mooring": mooring})


def measure(quick: bool) -> Iterator[tuple[list[Row], list[str]]]:
    """Time of the hour with each mooring, in turns."""
    sections = {"catenaries": CATENARIES, "springs": springs(), "matrix": None}
    hours = {name: Hour(120.0 if quick else 3600.0, moored(section)) for name, section in sections.items()}
    sea = hours["springs"].prepared(2)
    turns = contest({name: hour.case(sea, "forward", lambda f: f) for name, hour in hours.items()}, 2 if quick else 9)
    steps = hours["springs"].steps
    rows = [
        Row("Sea with three catenaries over springs", times(turns["catenaries"].over(turns["springs"])), "1.5"),
        Row("Sea with springs over a stiffness matrix", times(turns["springs"].over(turns["matrix"]))),
        *(Row(f"Sea on {name}", f"{1e6 * turn.median / steps:.3g} µs per step") for name, turn in turns.items()),
    ]
    count, strips = hours["springs"].components.omega.size, len(hours["springs"].model.hull.strips.element)
    notes = [
        f"Moorings: {PLATFORM} with {strips} strips, JONSWAP Hs {HEIGHT} m, Tp {PERIOD} s, {count} components from {LOW} to "
        f"{CUTOFF} Hz, order 2, {hours['springs'].duration:g} s, four-step Adams-Bashforth at {STEP} s. The catenaries are "
        "three chains of 850 m. The springs have their tension and angle at the fairleads. The matrix is the platform's own.",
    ]
    yield rows, notes
