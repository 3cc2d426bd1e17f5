"""Text of the page of `benchmarks.openfast_decks`, from its raw results alone."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from benchmarks.openfast_decks_cases import CASES, HEIGHT, HS, TP
from benchmarks.openfast_decks_reasons import LINES, LINES_HEAD, ON_LINES, REASONS

UNITS = {"surge": (1.0, "m"), "heave": (1.0, "m"), "pitch": (180 / math.pi, "deg")}
KINDS = {"regular": f"regular, {HEIGHT:g} m, 10.24 s", "sea": f"sea, Hs {HS:g} m, Tp {TP:g} s"}
MOTIONS = ("own", "read_back")
MADE = (
    "Made by `python -m benchmarks.openfast_decks OPENFAST` with OpenFAST 5.0.0 (commit 2895884d2, double precision, gfortran "
    "12.2). Every deck is run as exported first. Then offsets, waves, duration, step and output are set."
)
COLUMNS = (
    "*Here* is the platform itself in this package. The *deck read back* is the platform that `jaxhydro convert` makes of the "
    "deck: its loads have the forms that the deck has. What differs between both is told in export.md."
)
ON_DECAYS = (
    "Errors are the largest over the record, over the initial offset. Periods and decrements are means of up to eight half "
    "cycles. After fifty periods, 0.25 % in period is a large error: see the TLP."
)
ON_WAVES = (
    "Waves are the same components in both programs, from the start without a ramp. Differences are those of the time series "
    "after the transient, over OpenFAST's standard deviation."
)
RUN_HEAD = ("platform", "run", "messages of OpenFAST", "largest motion (m, deg)", "largest difference (m, deg)")
DECAY_HEAD = (
    *("platform", "motion", "offset", "period in OpenFAST (s)", "decrement", "period here", "largest error"),
    *("period of the deck read back", "its largest error"),
)
WAVE_HEAD = (
    *("platform", "waves", "motion", "standard deviation in OpenFAST", "here", "rms of the difference"),
    *("deck read back", "its rms of the difference"),
)


def table(head: tuple[str, ...], rows: list[list[str]]) -> str:
    """A table in Markdown."""
    return "\n".join(f"| {' | '.join(row)} |" for row in (head, ["---"] * len(head), *rows))


def percent(share: float, signed: bool = False) -> str:
    """A share as people read it: to 0.01 %."""
    if not math.isfinite(share):
        return "-"
    if abs(share) < 5e-5:
        return "< 0.005 %"
    return f"{100 * share:{'+' if signed else ''}.2f} %"


def text(results: Mapping[str, Any], lines: Mapping[str, Any]) -> str:
    """The page.

    Args:
        results: Raw results by platform.
        lines: Raw results of `benchmarks.openfast_lines`.
    """
    parts = ["# Exported decks in OpenFAST", _summary(results), MADE, COLUMNS]
    parts += ["## Decks as exported, unedited", table(RUN_HEAD, list(_runs(results)))]
    parts += ["## Decays", ON_DECAYS, table(DECAY_HEAD, list(_decays(results)))]
    parts += ["## Waves", ON_WAVES, table(WAVE_HEAD, list(_waves(results)))]
    parts += ["## Reasons", REASONS]
    parts += ["## Slow motions on catenaries", ON_LINES, table(LINES_HEAD, list(_lines(lines)))]
    return "\n\n".join(parts) + "\n"


def _summary(results: Mapping[str, Any]) -> str:
    ran = sum(not result["unedited"]["status"] for result in results.values())
    parts = [f"{ran} of {len(results)} exported decks run in OpenFAST as they are."]
    for lines, moorings in ((False, "on moorings of a matrix"), (True, "on MoorDyn's lines")):
        decays = [
            decay
            for name, result in results.items()
            for decay in result["decays"].values()
            if not decay["status"] and CASES[name].lines is lines
        ]
        if decays:
            error = max(decay["own"]["error"] for decay in decays)
            period = max(abs(decay["own"]["period"] / decay["period"] - 1) for decay in decays)
            offset = "" if lines else f"{percent(error)} of the offset and "
            parts.append(
                f"{len(decays)} decays {moorings} differ from OpenFAST's by at most {offset}{percent(period)} in period."
            )
    motions = [
        result["waves"]["regular"][dof]
        for result in results.values()
        if not result["waves"].get("regular", {"status": 1})["status"]
        for dof in UNITS
    ]
    if motions:
        largest = [max(abs(motion[key]["std"] / motion["openfast"] - 1) for motion in motions) for key in MOTIONS]
        words = f"{len(motions)} motions in a regular wave differ by at most {percent(largest[0])} in standard deviation"
        parts.append(f"{words}; {_shared(motions)} of them differ by at most 1.5 % where the loads have the deck's forms.")
    return " ".join(parts)


def _shared(motions: list[dict[str, Any]]) -> int:
    return sum(abs(motion["read_back"]["std"] / motion["openfast"] - 1) <= 0.015 for motion in motions)


def _runs(results: Mapping[str, Any]) -> Iterator[list[str]]:
    for name, result in results.items():
        run = result["unedited"]
        if run["status"]:
            yield [CASES[name].title, f"stopped, status {run['status']}", "; ".join(run["messages"]), "-", "-"]
            continue
        sizes = [
            max(*values[:3], *(math.degrees(value) for value in values[3:])) for values in (run["largest"], run["difference"])
        ]
        yield [
            CASES[name].title,
            f"{run['seconds']:g} s",
            "; ".join(run["messages"]) or "none",
            *(f"{size:.2g}" for size in sizes),
        ]


def _decays(results: Mapping[str, Any]) -> Iterator[list[str]]:
    for name, result in results.items():
        for dof, decay in result["decays"].items():
            factor, unit = UNITS[dof]
            if decay["status"]:
                yield [CASES[name].title, dof, "-", "stopped", *["-"] * 5]
                continue
            row = [CASES[name].title, dof, f"{decay['offset'] * factor:.3g} {unit}"]
            row += [f"{decay['period']:.4g}", f"{decay['decrement']:.4f}"]
            for key in MOTIONS:
                row += [percent(decay[key]["period"] / decay["period"] - 1, signed=True), percent(decay[key]["error"])]
            yield row


def _waves(results: Mapping[str, Any]) -> Iterator[list[str]]:
    for name, result in results.items():
        for kind, waves in result["waves"].items():
            for dof, (factor, unit) in UNITS.items():
                if waves["status"]:
                    yield [CASES[name].title, KINDS[kind], dof, "stopped", *["-"] * 4]
                    continue
                motion = waves[dof]
                row = [CASES[name].title, KINDS[kind], dof, f"{motion['openfast'] * factor:.3g} {unit}"]
                for key in MOTIONS:
                    row += [percent(motion[key]["std"] / motion["openfast"] - 1, signed=True)]
                    row += [percent(motion[key]["difference"] / motion["openfast"])]
                yield row


def _lines(lines: Mapping[str, Any]) -> Iterator[list[str]]:
    for name, title in LINES.items():
        run = lines[name]
        yield [title, f"{run['mean_surge']:.3f}", *(f"{value:.3f}" for key in ("slow", "waves") for value in run[key])]
