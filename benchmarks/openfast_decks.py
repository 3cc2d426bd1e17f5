"""Exported decks in OpenFAST itself: messages, rest, decays and waves against this package.

    python -m benchmarks.openfast_decks OPENFAST [--only PLATFORM ...] [--again]

OPENFAST is an executable of OpenFAST 5, built in double precision. Each platform is exported as by `jaxhydro export` and run
unedited. Then it is released from offsets, and put into a regular wave and a sea of known components (WaveMod 7). Nothing else
of a deck is edited but its duration, time step, output format and, in still water, the size of SeaState's grid.

OpenFAST's motion is compared with two of this package: that of the platform itself, and that of the deck read back by
`jaxhydro convert`. The second has the forms of the loads that the deck has, so what is left of its difference is numerical.

Raw results go to benchmarks/results-openfast-decks.json after every platform; platforms that are in it are not run again
without `--again`. The text, benchmarks/results-openfast-decks.md, is made from the raw results alone.
"""

import argparse
import json
import shutil
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

import jaxhydro as jh
from benchmarks.openfast_decks_cases import CASES, HEIGHT, HS, TP, Case
from benchmarks.openfast_decks_export import read_back, written
from benchmarks.openfast_decks_run import TEXT_OUTPUT, Run, add_waves, edit, initial, run
from benchmarks.openfast_decks_text import text
from jaxhydro.dynamics.response import decay_cycles
from jaxhydro.waves.components import components
from jaxhydro.waves.irregular import spectrum_components

RAW, TEXT = (Path(__file__).with_name(f"results-openfast-decks.{ending}") for ending in ("json", "md"))
LINES = Path(__file__).with_name("results-openfast-lines.json")  # of benchmarks.openfast_lines
REPEAT = 1024.0  # s, after which the waves repeat
WAVE_HARMONIC = 100  # of that: a period of 10.24 s
BAND = (0.03, 0.25)  # Hz
CYCLES = 8  # half cycles of a decay, at most, of which the mean is taken
SMALL_GRID = {"NX": 2, "NY": 2, "NZ": 2}  # of SeaState in still water


def platform_of(case: Case) -> jh.Platform:
    """The platform of a case."""
    raw = jh.load_platform(case.platform).model_dump(exclude_unset=True)
    return jh.Platform.model_validate(raw | dict(case.changes))


def moved(models: Mapping[str, jh.Model], result: Run, start: Float[np.ndarray, "6"], sea: Any = None) -> dict[str, Any]:
    """Motions (m, rad) of each model at OpenFAST's times, (6, t)."""
    step = None if sea is None else 0.1
    return {
        key: np.asarray(jh.simulate(model, result.times, sea, position=jnp.asarray(start), step=step).position).T
        for key, model in models.items()
    }


def mean_cycle(times: Float[np.ndarray, " t"], motion: Float[np.ndarray, " t"]) -> tuple[float, float]:
    """Mean period (s) and decrement (-) of the first half cycles of a decay; not a number without two of them."""
    cycles = decay_cycles(times, motion)
    if len(cycles.period) < 2:
        return float("nan"), float("nan")
    return float(cycles.period[:CYCLES].mean()), float(cycles.decrement[:CYCLES].mean())


def decay(result: Run, motions: Mapping[str, Any], dof: str, offset: float, rest: float) -> dict[str, Any]:
    """Period, decrement and differences of a decay."""
    i = jh.DOFS.index(dof)
    period, decrement = mean_cycle(result.times, result.motion[i] - rest)
    compared: dict[str, Any] = {"offset": offset, "period": period, "decrement": decrement}
    for key, motion in motions.items():
        its_period, its_decrement = mean_cycle(result.times, motion[i] - rest)
        error = float(np.abs(motion[i] - result.motion[i]).max() / abs(offset))
        compared[key] = {"period": its_period, "decrement": its_decrement, "error": error}
    return compared


def in_waves(result: Run, motions: Mapping[str, Any], transient: float) -> dict[str, Any]:
    """Standard deviations (m, rad) of surge, heave and pitch, and of the differences, after the transient."""
    late = result.times > transient
    compared: dict[str, Any] = {}
    for dof in ("surge", "heave", "pitch"):
        i = jh.DOFS.index(dof)
        compared[dof] = {"openfast": float(result.motion[i, late].std()), "mean": float(result.motion[i, late].mean())}
        for key, motion in motions.items():
            difference = motion[i, late] - result.motion[i, late]
            values = {"std": float(motion[i, late].std()), "mean": float(motion[i, late].mean())}
            compared[dof][key] = values | {"difference": float(difference.std())}
    return compared


def waves_of(environment: jh.Environment) -> dict[str, jh.Components]:
    """Components of the regular wave and of the sea."""
    omega = 2 * np.pi * WAVE_HARMONIC / REPEAT
    regular = components(jnp.array([0.5 * HEIGHT]), jnp.array([omega]), environment, first=WAVE_HARMONIC)
    band = {"low": BAND[0], "cutoff": BAND[1], "seed": 1}
    return {"regular": regular, "sea": spectrum_components(lambda w: jh.jonswap(w, HS, TP, 2.0), REPEAT, environment, **band)}


def compared(executable: str, case: Case, folder: Path) -> dict[str, Any]:
    """Results of a platform: the unedited run, decays and waves."""
    platform = platform_of(case)
    results: dict[str, Any] = {"items": written(platform, folder / "deck")}
    model = jh.build(platform)
    models = {"own": model, "read_back": read_back(folder / "deck" / "main.fst", folder / "platform")}
    rest = np.asarray(jh.equilibrium(model))

    def deck(name: str, duration: float, start: Float[np.ndarray, "6"]) -> Path:
        copy = folder / name
        shutil.copytree(folder / "deck", copy)
        edit(copy, {"main.fst": TEXT_OUTPUT | {"TMax": duration} | ({} if case.step is None else {"DT": case.step})})
        edit(copy, initial(start))
        return copy

    def told(name: str, result: Run) -> dict[str, Any]:
        print(f"  {name}: status {result.status}", *result.messages, sep="\n    ", flush=True)
        return {"status": result.status, "messages": list(result.messages)}

    shutil.copytree(folder / "deck", folder / "unedited")
    calm = run(executable, folder / "unedited")
    results["unedited"] = told("unedited", calm)
    if not calm.status:
        results["unedited"] |= {"largest": np.abs(calm.motion).max(axis=1).tolist(), "seconds": float(calm.times[-1])}
        reference = moved({"own": model}, calm, np.zeros(6))["own"]
        results["unedited"]["difference"] = np.abs(reference - calm.motion).max(axis=1).tolist()
    results["decays"], results["waves"] = {}, {}
    for dof, offset in case.offsets.items():
        start = rest.copy()
        start[jh.DOFS.index(dof)] += offset
        path = deck(dof, case.duration, start)
        edit(path, {"seastate.dat": SMALL_GRID})
        result = run(executable, path)
        results["decays"][dof] = told(dof, result)
        if not result.status:
            motions = moved(models, result, start)
            results["decays"][dof] |= decay(result, motions, dof, offset, float(rest[jh.DOFS.index(dof)]))
    for kind, waves in waves_of(model.environment).items() if case.waves else ():
        path = deck(kind, case.duration_in_waves, rest)
        add_waves(path, waves)
        result = run(executable, path)
        results["waves"][kind] = told(kind, result)
        if not result.status:
            motions = moved(models, result, rest, jh.IrregularSea(waves, model.environment))
            elevation = np.asarray(waves.amplitude) @ np.cos(
                np.outer(waves.omega, result.times) + np.asarray(waves.phase)[:, None]
            )
            results["waves"][kind] |= in_waves(result, motions, case.transient)
            results["waves"][kind]["elevation_error"] = float(np.std(elevation - result.elevation) / np.std(elevation))
    return results


def main(arguments: list[str] | None = None) -> None:
    """Run the platforms that have no results yet; write raw results and text."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("openfast", help="executable of OpenFAST 5")
    parser.add_argument("--only", nargs="+", metavar="PLATFORM", choices=list(CASES), default=list(CASES))
    parser.add_argument("--again", action="store_true", help="run platforms that have results, too")
    given = parser.parse_args(arguments)
    results = json.loads(RAW.read_text("utf-8")) if RAW.exists() else {}
    for name in given.only:
        if name in results and not given.again:
            continue
        begin = time.monotonic()
        print(name, flush=True)
        with tempfile.TemporaryDirectory() as folder:
            results[name] = compared(shutil.which(given.openfast) or given.openfast, CASES[name], Path(folder))
        print(f"  {time.monotonic() - begin:.0f} s", flush=True)
        ordered = {key: results[key] for key in CASES if key in results}
        RAW.write_text(json.dumps(ordered, indent=1) + "\n", encoding="utf-8")
    TEXT.write_text(text(results, json.loads(LINES.read_text("utf-8"))), encoding="utf-8")
    print(TEXT)


if __name__ == "__main__":
    main()
