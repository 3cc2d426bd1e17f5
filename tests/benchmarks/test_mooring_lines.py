"""Mooring lines against MoorDyn: the section follows from the raw results, and today's lines still agree with MoorDyn."""

import json
import math

import pytest

from benchmarks import validate
from benchmarks.evidence import mooring_lines_runs, mooring_lines_text
from benchmarks.evidence.common import EVIDENCE, ROOT
from benchmarks.evidence.mooring_lines_runs import BED, MOORDYN, OFFSETS, RUNS, SEGMENTS
from benchmarks.evidence.mooring_lines_text import GOAL, differences, of_moordyn
from benchmarks.moordyn_statics import exported, with_numerics

RUN = {
    "fairlead": [[-3.0e5, 0.0, -4.0e5]],
    "anchor": [[3.0e5, 0.0, -1.0e4]],
    "fairlead_segment": [4.9e5],
    "anchor_segment": [3.0e5],
    "bed": [9.0e4],
}


def test_the_section_is_made_of_the_results() -> None:
    results = json.loads((EVIDENCE / "mooring_lines.json").read_text("utf-8"))["statics"]["result"]
    text = mooring_lines_text.words(results, json.loads(MOORDYN.read_text("utf-8")))
    page = " ".join((ROOT / "docs" / "validation.md").read_text("utf-8").split())
    assert " ".join(validate.wrapped(text.strip()).split()) in page


def test_lines_agree_with_moordyn() -> None:
    """As the package is today, with the finest segments of all offsets."""
    results = mooring_lines_runs.worked_out()
    runs = {(r["offset"], r["segments"], r["bed_stiffness"]): r for r in json.loads(MOORDYN.read_text("utf-8"))}
    assert set(runs) == set(RUNS)
    for ours in results["offsets"]:
        moordyn = of_moordyn(runs[ours["offset"], SEGMENTS[-1], BED], results["weight"])
        apart = differences(ours, moordyn)
        assert len(apart) == (8 if ours["offset"] else 7) and max(map(abs, apart.values())) < GOAL
    assert [state["offset"] for state in results["offsets"]] == list(OFFSETS)


def test_length_on_the_seabed_of_a_run() -> None:
    """What the bed and a pressed-down anchor carry; an anchor that is lifted carries nothing."""
    flat = of_moordyn(RUN, 1000.0)
    assert flat["lines"] == [{"fairlead": pytest.approx(5.0e5), "anchor": 3.0e5, "on_seabed": pytest.approx(100.0)}]
    lifted = of_moordyn(RUN | {"anchor": [[3.0e5, 0.0, 2.0e4]], "bed": [0.0]}, 1000.0)
    assert lifted["lines"][0]["on_seabed"] == 0.0 and math.hypot(*flat["force"]) == pytest.approx(5.0e5)


def test_only_the_numerics_of_the_exported_file_change() -> None:
    text, mooring = exported()
    before, after = text.splitlines(), with_numerics(text, 80, BED).splitlines()
    inputs = before[: next(i for i, line in enumerate(before) if " OUTPUTS " in line)]
    changed = [(a.split(), b.split()) for a, b in zip(inputs, after) if a.split() != b.split()]
    of_type = [pair for pair in changed if pair[0][0] == "chain"]
    of_line = [pair for pair in changed if pair[0][1] == "chain"]
    options = {pair[0][1] for pair in changed if len(pair[0]) == 2}
    assert [[i for i in range(10) if a[i] != b[i]] for a, b in of_type] == [[4, 6]]
    assert len(of_line) == len(mooring.lines[0].copies()) and all(a[:5] == b[:5] and b[5] == "80" for a, b in of_line)
    assert options == {"dtM", "kbot", "TmaxIC", "threshIC"} and len(changed) == len(of_type) + len(of_line) + len(options)
    assert not any("FairTen" in line for line in after)
