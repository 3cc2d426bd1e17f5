"""Makes benchmarks/moordyn/statics.json: what MoorDyn gives for the lines of VolturnUS-S at rest, held at offsets in surge.

    python -m benchmarks.moordyn_statics [--out FILE]

MoorDyn, which is no dependency of the project, is needed: `pip install moordyn==2.7.2` (MoorDyn-C). Runs that FILE has are
not repeated; all take about 10 minutes.
The lines are those of the file that `jaxhydro export --format moordyn` writes. Other than there are the numerics: number of
segments, time step, stiffness of the bed, drag and damping of the lines. Drag and damping do nothing at rest; much drag brings
the lines to rest sooner.
"""

import argparse
import json
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence.mooring_lines_runs import MOORDYN, RUNS, platform
from jaxhydro.cli.export_command import source_of
from jaxhydro.interop.openfast.export_moordyn import ALONE, export_lines
from jaxhydro.platform.build import build
from jaxhydro.platform.catenary_schema import Catenary

DRAG, DAMPING = "1000.0", "-0.3"  # Cd; BA/-zeta: 0.3 of the critical damping
STEP = 0.24  # s, of time, over the number of segments
DURATION, LAST = 200.0, 50.0  # s after MoorDyn's own static solution, and of these the last ones, over which changes are told


def exported() -> tuple[str, Catenary]:
    """Text of lines.txt, and the lines that it is of."""
    declared = platform()
    assert isinstance(declared.mooring, Catenary)
    return export_lines(source_of(declared, build(declared))).texts[ALONE], declared.mooring


def with_numerics(text: str, segments: int, bed: float) -> str:
    """Lines.txt with a number of segments and a bed stiffness (Pa/m), `STEP`, `DRAG` and `DAMPING`, without output channels."""
    options = {"dtM": STEP / segments, "kbot": bed, "TmaxIC": 60.0, "threshIC": 1e-9}
    table, lines = "", []
    for line in text.splitlines():
        words = line.split()
        if " OUTPUTS " in line:
            lines.append("1 disableOutTime")
            break
        table = line if line.startswith("---") else table
        if "LINE TYPES" in table and len(words) == 10 and words[1][0].isdigit():
            words[4], words[6] = DAMPING, DRAG
        elif " LINES " in table and len(words) == 7 and words[0].isdigit():
            words[5] = str(segments)
        elif len(words) == 2 and words[1] in options:
            words[0] = repr(options[words[1]])
        else:
            words = [line]
        lines.append(" ".join(words))
    return "\n".join([*lines, "-" * 20, ""])


def at_rest(text: str, fairleads: np.ndarray, segments: int) -> dict[str, Any]:
    """Static state of lines whose upper ends are held; forces in N, earth axes.

    Args:
        text: Text of lines.txt.
        fairleads: Positions of the fairleads (m), (l, 3).
        segments: Number of each line's segments.

    Returns:
        `fairlead`: force on each fairlead, (l, 3), and on each `anchor`. `fairlead_segment`, `anchor_segment`: tension of
        the segment there, as the channel FairTen has it. `bed`: lift of the bed on each line's inner nodes. `speed`: the
        largest of a node (m/s). `changes`: the largest change of a fairlead's force in the last `LAST` seconds, over it.
    """
    import moordyn

    points, still = fairleads.ravel().tolist(), [0.0] * fairleads.size
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / ALONE
        path.write_text(text, encoding="utf-8")
        system = moordyn.Create(str(path))
        moordyn.SetVerbosity(system, moordyn.LEVEL_ERR)
        moordyn.Init(system, points, still)
        lines = [moordyn.GetLine(system, i + 1) for i in range(len(fairleads))]
        time, forces = 0.0, []
        while time < DURATION - 1e-6:
            moordyn.Step(system, points, still, time, 5.0)
            time += 5.0
            if time >= DURATION - LAST:
                forces.append([moordyn.GetLineNodeForce(line, segments) for line in lines])
        inner = range(1, segments)
        state = {
            "fairlead": np.array(forces[-1]).tolist(),
            "anchor": [list(moordyn.GetLineNodeForce(line, 0)) for line in lines],
            "fairlead_segment": [moordyn.GetLineFairTen(line) for line in lines],
            "anchor_segment": [float(np.linalg.norm(moordyn.GetLineNodeTen(line, 0))) for line in lines],
            "bed": [sum(moordyn.GetLineNodeSeabedForce(line, k)[2] for k in inner) for line in lines],
            "speed": max(float(np.linalg.norm(moordyn.GetLineNodeVel(line, k))) for line in lines for k in inner),
        }
        moordyn.Close(system)
    size = np.linalg.norm(forces[-1], axis=-1)
    changes = np.linalg.norm(np.array(forces) - np.array(forces[-1]), axis=-1) / size
    return state | {"changes": float(changes.max())}


def main() -> None:
    """Write the results of all runs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=MOORDYN)
    given = parser.parse_args()
    text, mooring = exported()
    fairleads = np.array([fairlead for line in mooring.lines for _, fairlead in line.copies()])
    results: list[dict[str, Any]] = json.loads(given.out.read_text("utf-8")) if given.out.exists() else []
    done = {(result["offset"], result["segments"], result["bed_stiffness"]) for result in results}
    for offset, segments, bed in (case for case in RUNS if case not in done):
        state = at_rest(with_numerics(text, segments, bed), fairleads + np.array([offset, 0.0, 0.0]), segments)
        results.append({"offset": offset, "segments": segments, "bed_stiffness": bed} | state)
        total = np.sum(state["fairlead"], axis=0)
        print(f"{offset:g} m, {segments} segments: {total[0] / 1e3:.2f} kN, changes {state['changes']:.1e}", flush=True)
        given.out.parent.mkdir(exist_ok=True)
        given.out.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    print(f"{given.out}: {len(results)} runs")


if __name__ == "__main__":
    main()
