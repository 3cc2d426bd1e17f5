"""Section 9: global searches on the paper's problem, from anywhere within a factor of ten."""

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence.common import DEMO, Section, cached, fingerprint, parallel, say, table
from benchmarks.evidence.global_search_figure import draw
from benchmarks.population_search import POPULATIONS, fit_releases
from calibration.formatting import number

TITLE = "Global searches"
RECORDS = ("surge-2", "heave-2", "pitch-2")
SEEDS, BUDGET = 10, 60.0  # and CPU seconds of a search
CLOSE = 1.01
NAMES = {"multistart": "Multi-start LM", "cma-es": "CMA-ES", "de": "Differential evolution", "ga": "Genetic algorithm"}


def campaign():
    """The built-in campaign with one decay of each motion."""
    from calibration.campaign.load_campaign import load_campaign

    whole = load_campaign(DEMO)
    return dataclasses.replace(whole, records=tuple(whole.record(id) for id in RECORDS))


def of_seed(name: str) -> dict[str, Any]:
    """One search; `name` is its method and its seed."""
    from calibration.global_search.multistart import MultiStart
    from calibration.global_search.run_search import run as run_search
    from calibration.global_search.run_search import set_up_search
    from calibration.global_search.task import Budget, Task

    method, seed = name.rsplit("-", 1)
    task = Task(*set_up_search(campaign()), None, Budget(seconds=BUDGET))
    best = run_search(task, POPULATIONS.get(method, MultiStart)(), int(seed))
    return {
        "objective": best.objective,
        "simulations": best.simulations,
        "seconds": best.seconds,
        "ended": best.ended,
        "values": best.values,
        "history": [column.tolist() for column in best.history],
    }


def handicap(values: dict[str, float]) -> float:
    """J of the best coefficients with the releases that population searches are given."""
    import jax.numpy as jnp

    from calibration.global_search.run_search import set_up_search
    from calibration.global_search.task import Budget, Task

    problem, records = set_up_search(campaign())
    task = Task(problem, records, None, Budget())
    task.releases = fit_releases(task)
    x = [p.transform.inverse(values[p.label]) for p in problem.space.free]
    return float(task.simulate(np.asarray(jnp.array([x])))[0])


def key() -> str:
    """Key of the section's results."""
    return fingerprint(DEMO, f"{RECORDS} {BUDGET}")


def run(figures: Path, processes: int) -> Section:
    """Four methods by ten seeds."""
    sources = key()
    # turn by turn, so that what else the machine does falls on all alike
    names = [f"{method}-{seed}" for seed in range(1, SEEDS + 1) for method in NAMES]
    by_method: dict[str, dict[str, dict[str, Any]]] = {method: {} for method in NAMES}
    for name, result in parallel("global_search", sources, names, of_seed, processes):
        method, seed = name.rsplit("-", 1)
        by_method[method][seed] = result
        say(f"  {name}: J {result['objective']:.5f}, {result['simulations']:.0f} simulations, {result['seconds']:.0f} s CPU")
    results = {method: [runs[seed] for seed in sorted(runs, key=int)] for method, runs in by_method.items() if runs}
    best = min((search for runs in results.values() for search in runs), key=lambda search: search["objective"])
    floor = cached("global_search", sources, f"handicap-{best['objective']:.8g}", lambda: handicap(best["values"]))
    return conclude(results, best["objective"], floor, figures)


def reached(search: dict[str, Any], target: float) -> tuple[float, float] | None:
    """Simulations and CPU seconds when a search came down to a J; None if it never did."""
    simulations, seconds, objective = search["history"]
    close = np.flatnonzero(np.array(objective) <= target)
    return (simulations[close[0]], seconds[close[0]]) if len(close) else None


def conclude(results: dict[str, list[dict[str, Any]]], best: float, floor: float, figures: Path) -> Section:
    """The table, its words and its figure."""
    rows, medians, share = [], {}, {}
    for method, runs in results.items():
        j = np.array([search["objective"] for search in runs])
        near = [at for search in runs if (at := reached(search, CLOSE * best)) is not None]
        share[method] = len(near) / len(runs)
        medians[method] = np.median(near, axis=0) if near else None
        to = [f"{value:.{digits}f}" for value, digits in zip(np.median(near, axis=0), (0, 1))] if near else ["–", "–"]
        rows.append(
            (
                NAMES[method],
                number(float(np.median(j)), 3),
                f"{number(float(j.min()), 3)} to {number(float(j.max()), 3)}",
                f"{len(near)} of {len(runs)}",
                *to,
                f"{np.median([search['simulations'] for search in runs]):.0f}",
                f"{np.median([search['seconds'] for search in runs]):.0f}",
            )
        )
    seeds = max(len(runs) for runs in results.values())
    head = (
        "Method",
        "J, median",
        "J, range",
        "Within 1 %",
        "... simulations",
        "... CPU s",
        "Simulations in all",
        "CPU s in all",
    )
    text = (
        f"The paper's problem is one decay each of surge, heave and pitch ({', '.join(RECORDS)} of the built-in campaign). The "
        "platform's eleven coefficients are each anywhere from a tenth to ten times the value in the platform file, "
        "log-uniform. "
        f"Every method has the same bounds, coordinates, simulator and time step, and is run from {seeds} seeds. Each run has "
        f"{BUDGET:g} s of CPU time, compilation apart.\n\n"
        f"- *Within 1 %* is of the least J that any run found, {number(best)}. What it took to come there is the median over "
        "the seeds that did.\n"
        "- A simulation is one of one record; a part of a record counts as that part. An iteration of least squares counts as "
        "one for every unknown and one, as finite differences would take.\n\n"
        + table(head, rows)
        + "\n- *Multi-start LM* simulates 64 Sobol points over 1.25 cycles, in batches. It calibrates from the best four as "
        "`calibrate` does, one after the other as far as the budget goes. This fits the records' releases and the sensors' "
        "offsets too.\n"
        "- *CMA-ES* is Hansen's `cma` (population 11, doubled at a restart). *Differential evolution* is SciPy's (165). The "
        "*genetic algorithm* is pymoo's (99). Each has its defaults. Populations are simulated in batches of 11 or 33.\n"
        "- These three know nothing of releases, and are given them. Positions and rates come from least squares over the "
        "first 3.1 cycles, whose coefficients are thrown away. Its time and simulations are counted. Offsets are eliminated "
        "in J. Nine unknowns a record less is an advantage. What it costs: with these releases the best coefficients have J "
        f"{number(floor)}, {100 * (floor / best - 1):.2g} % above the least J.\n" + comparison(results, medians)
    )
    short = []
    if share.get("multistart", 1.0) < 1:
        short.append(f"multi-start least squares came within 1 % of the least J from {share['multistart']:.0%} of the seeds")
    if any(len(results.get(method, ())) < SEEDS for method in NAMES):
        done = ", ".join(f"{NAMES[method]} {len(results.get(method, ()))}" for method in NAMES)
        short.append(f"not all of {SEEDS} seeds of each global search have been run ({done})")
    return Section(TITLE, text, (draw(results, NAMES, best, figures / "global-search.png"),), tuple(short))


def comparison(results: dict[str, list[dict[str, Any]]], medians: dict[str, Any]) -> str:
    """How much more the population searches took than multi-start, or how much sooner it was where they ended."""
    ours, lines = results.get("multistart", []), []
    for method in POPULATIONS:
        if not ours or method not in results:
            continue
        if medians[method] is not None and medians["multistart"] is not None:
            many, long = medians[method] / medians["multistart"]
            lines.append(
                f"- {NAMES[method]} took {many:.1f} times the simulations and {long:.1f} times the CPU time of "
                "multi-start to come within 1 %, where it did."
            )
            continue
        ended = float(np.median([search["objective"] for search in results[method]]))
        sooner = [at for search in ours if (at := reached(search, ended)) is not None]
        spent = np.median([(search["simulations"], search["seconds"]) for search in results[method]], axis=0)
        multi_start_note = f" Multi-start did not come to its median J, {number(ended, 3)}, either."
        if sooner:
            simulations, seconds = np.median(sooner, axis=0)
            many, long = spent / (simulations, seconds)
            multi_start_note = (
                f" Its median J, {number(ended, 3)}, multi-start has after {simulations:.0f} simulations and "
                f"{seconds:.1f} s (medians): {many:.0f} times fewer and {long:.0f} times sooner."
            )
        lines.append(f"- {NAMES[method]} did not come within 1 % from any seed.{multi_start_note}")
    return "\n".join(lines) + "\n"
