"""Section: P-Q analysis against the fit in the time domain, on synthetic decays of rising damping."""

from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence import classical_bias_runs as runs
from benchmarks.evidence.classical_bias_text import shortcomings, words
from benchmarks.evidence.common import Section, fingerprint, parallel, say

NAME = "classical_bias"
TITLE = "P-Q against the time domain"


def key() -> str:
    """Key of the section's results."""
    return fingerprint(Path(runs.__file__), Path(__file__).parents[1] / "reference_model.py")


def run(figures: Path, processes: int) -> Section:
    """All factors of the damping."""
    by_name: dict[str, dict[str, Any]] = {}
    names = tuple(f"{factor:g}" for factor in runs.FACTORS)
    for name, result in parallel(NAME, key(), names, runs.of_factor, processes):
        say(f"  damping times {name}")
        by_name[name] = result
    results = [by_name[name] for name in names]
    figure = draw(results, figures / "classical-bias.png")
    return Section(TITLE, words(results), (figure,), shortcomings(results))


def draw(results: list[dict[str, Any]], path: Path) -> Path:
    """Ratios to the truth against damping."""
    from jaxhydro.plots.style import MEASURED, SIMULATED, header, save, stack, style

    with style():
        figure, axes = stack([1.2, 1.2])
        artists = {}
        for ax, i, label, name in zip(axes, (0, 1), reversed(runs.LABELS), ("linear", "quadratic")):
            ax.axhline(1.0, color="0.6", lw=0.7)
            pairs = [(f, r["pq"][i]) for f, r in zip(runs.FACTORS, results) if "pq" in r]
            x, triples = [f for f, _ in pairs], np.array([t for _, t in pairs])
            bars = np.abs(triples[:, 1:].T - triples[:, 0])
            artists["P-Q, 95 %"] = ax.errorbar(x, triples[:, 0], bars, fmt="o", color=MEASURED, ms=3, lw=0.8, capsize=2)[0]
            fit = np.array([r["fit"][label] for r in results])
            beside, wide = 0.1 + np.array(runs.FACTORS), 2 * np.nan_to_num(fit[:, 1])
            artists["time domain, 2 sd"] = ax.errorbar(
                beside, fit[:, 0], wide, fmt="s", color=SIMULATED, ms=3, lw=0.8, capsize=2
            )[0]
            ax.set_xlim(0, 6)
            ax.set_ylim(0, 2)
            ax.set_ylabel(f"{name.capitalize()}\nover truth")
        axes[-1].set_xlabel("Factor of drag (of B33: its square)")
        header(figure, "Heave decays of rising damping", artists, 2)
        save(figure, path)
    return path
