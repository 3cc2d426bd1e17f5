"""Section 5: the nine decays from far starting values."""

from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence.common import DEMO, TRUE, Section, fingerprint, parallel, say, table
from calibration.formatting import number

TITLE = "Far starts"
FACTOR, OFF, SEED = 3.0, 0.25, 2026  # of every coefficient, and of every natural period
MODES = ("surge", "heave", "pitch")
SAME = 1.01


def starts(count: int) -> list[dict[str, Any]]:
    """Starting values log-uniform within FACTOR of the truth, of those whose natural periods are within OFF of the true
    ones: values, and the natural periods over the true ones."""
    from calibration.campaign.load_campaign import load_campaign
    from jaxhydro import build, natural_modes

    model, random, drawn = build(load_campaign(DEMO).platform), np.random.default_rng(SEED), []

    def periods(values: dict[str, float]) -> np.ndarray:
        modes = natural_modes(model.with_values(values))
        return np.array([modes.of(dof) for dof in MODES])

    true = periods(TRUE)
    while len(drawn) < count:
        values = {label: value * FACTOR ** random.uniform(-1, 1) for label, value in TRUE.items()}
        ratio = periods(values) / true
        if np.abs(ratio - 1).max() <= OFF:
            drawn.append({"values": values, "ratio": ratio.tolist()})
    return drawn


def of_start(name: str) -> dict[str, Any]:
    """The calibration from one start; `name` is its number and how many there are."""
    from calibration.campaign.load_campaign import load_campaign
    from calibration.fitting.decay_calibration import calibrate

    index, count = map(int, name.split("-of-"))
    start = starts(count)[index - 1]
    result = calibrate(load_campaign(DEMO), start=start["values"])
    return start | {
        "objective": result.objective("fit"),
        "first": result.history[0],
        "iterations": result.iterations,
        "seconds": result.seconds,
        "converged": result.converged,
        "reached": {label: [p.value, p.standard_deviation] for label, p in result.parameters.items()},
    }


def key() -> str:
    """Key of the section's results."""
    return fingerprint(DEMO, f"{FACTOR} {OFF} {SEED}")


def outcomes(count: int = 20, processes: int = 2) -> list[dict[str, Any]]:
    """What all starts led to, from the cache where it has been worked out."""
    names, by_start = [f"{i + 1}-of-{count}" for i in range(count)], {}
    for name, result in parallel("starts", key(), names, of_start, processes):
        by_start[name] = result
        say(f"  start {name}: J {result['objective']:.6f}, {result['iterations']} iterations, {result['seconds']:.0f} s")
    return [by_start[name] for name in names if name in by_start]


def run(count: int, processes: int, figures: Path) -> Section:
    """Twenty random starts."""
    results, wanted = outcomes(count, processes), count
    count = len(results)
    best = min(result["objective"] for result in results)
    same = sum(result["objective"] < SAME * best for result in results)
    rows = []
    for i, result in enumerate(results):
        off = [f"{100 * (r - 1):+.0f} %" for r in result["ratio"]]
        factor = max(max(result["values"][k] / TRUE[k], TRUE[k] / result["values"][k]) for k in TRUE)
        rows.append(
            (
                i + 1,
                f"{factor:.1f}",
                *off,
                f"{result['objective']:.6f}",
                f"{100 * (result['objective'] / best - 1):.3f} %",
                result["iterations"],
                f"{result['seconds']:.0f}",
                "yes" if result["converged"] else "no",
            )
        )
    iterations = [result["iterations"] for result in results]
    worst = spread_of(results)
    text = (
        f"{same} of {count} reach J within {100 * (SAME - 1):.0f} % of the best ({number(best)}): "
        f"{verdict(same, count, wanted)}. Iterations: median {np.median(iterations):.0f}, at most {max(iterations)}. "
        f"{worst}\n\n"
        f"The built-in campaign is calibrated from {count} random starts. Each of its eleven coefficients is drawn log-uniform "
        f"within a factor of {FACTOR:g} of the truth. Draws whose natural periods are more than {100 * OFF:.0f} % off are left "
        "out. The table has the largest factor of any coefficient, and how far off the periods of surge, heave and pitch are. "
        f"It has also the J reached and how far it is from the best of all starts.\n\n"
        + table(("Start", "Factor", "Surge", "Heave", "Pitch", "J", "From best", "Iterations", "s", "Converged"), rows)
    )
    short = [] if same == count else [f"{count - same} of {count} far starts end elsewhere"]
    if count < wanted:
        short.append(f"only {count} of {wanted} far starts have been run")
    return Section(TITLE, text, (), tuple(short))


def verdict(same: int, count: int, wanted: int) -> str:
    """The goal is that all arrive."""
    if same < count:
        return "the goal is all of them: not met"
    return "the goal, all of them, is met" if count == wanted else f"the goal is all of {wanted}: the others have not been run"


def spread_of(results: list[dict[str, Any]]) -> str:
    """How far apart the coefficients are that different starts lead to, in their standard deviations."""
    apart = {}
    for label in TRUE:
        values = np.array([result["reached"][label][0] for result in results])
        sd = [result["reached"][label][1] for result in results if result["reached"][label][1] is not None]
        apart[label] = float(np.ptp(values) / np.median(sd)) if sd else float("nan")
    label = max(apart, key=lambda k: apart[k])
    return f"The coefficient that the starts leave furthest apart is `{label}`: {apart[label]:.2f} of its standard deviation."
