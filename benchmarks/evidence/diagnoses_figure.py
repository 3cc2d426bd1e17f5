"""Figure of the section on diagnoses: what is said first, of what is missing."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from benchmarks.discovery.answer_file import Answer
from benchmarks.discovery.cases import EFFECTS, OUTSIDE, STRENGTHS, Case
from benchmarks.discovery.outcomes import named_effects


def draw(answers: Mapping[Case, Answer], path: Path) -> Path:
    """What was said first, of what is missing, by strength."""
    from matplotlib.figure import Figure

    from jaxhydro.plots.style import GREY, WIDTH, header, save, style

    first_answers = {
        case: named_effects(answer)[0] if answer.verdict == "found" else answer.verdict
        for case, answer in answers.items()
        if len(case.effects) < 2
    }
    last = ("nothing_missing", "unexplained")
    unlisted = sorted({*first_answers.values()} - {*EFFECTS, *last})
    columns = (*EFFECTS, *unlisted, *last)
    rows = [effect for effect in (*EFFECTS, *OUTSIDE, "") if any(case.effect == effect for case in first_answers)]
    strengths = [k for k in STRENGTHS if any(case.effect and case.strength == k for case in first_answers)]
    with style():
        figure = Figure(figsize=((0.9 + 0.75 * len(strengths)) * WIDTH, 0.14 * len(rows) + 1.9), layout="constrained")
        for ax, strength in zip(np.atleast_1d(figure.subplots(1, len(strengths), sharey=True)), strengths, strict=True):
            counts = np.zeros((len(rows), len(columns)))
            for case, answered in first_answers.items():
                if not case.effect or case.strength == strength:
                    counts[rows.index(case.effect), columns.index(answered)] += 1
            of = counts.sum(axis=1, keepdims=True)
            ax.imshow(np.where(of > 0, counts / np.maximum(of, 1), np.nan), cmap="Blues", vmin=0, vmax=1, aspect="auto")
            for i, j in zip(*np.nonzero(counts), strict=True):
                dark = counts[i, j] > 0.6 * of[i, 0]
                ax.text(j, i, f"{counts[i, j]:.0f}", ha="center", va="center", fontsize=5.5, color="white" if dark else "black")
            ax.set_xticks(range(len(columns)), [name.replace("_", " ") for name in columns], rotation=90, fontsize=6)
            ax.set_yticks(range(len(rows)), [name.replace("_", " ") or "(nothing)" for name in rows], fontsize=6)
            ax.axhline(len(rows) - 1.5, color=GREY, lw=0.6)
            ax.axvline(len(columns) - 2.5, color=GREY, lw=0.6)
            ax.grid(visible=False)
            ax.set_xlabel("said first")
            ax.set_title(f"{STRENGTHS[strength]} strength", loc="left")
        figure.axes[0].set_ylabel("missing in the tank")
        header(figure, f"{len(first_answers)} campaigns: what is missing, and what a diagnosis says first")
        save(figure, path)
    return path
