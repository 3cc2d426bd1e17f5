"""The README's picture, of numbers in docs/validation.md: `python -m benchmarks.readme_figure`."""

import re
from pathlib import Path

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from benchmarks.evidence.lacking import CASES, DRAWN, MOTIONS, PAPER
from jaxhydro.plots.style import BEFORE, GREY, SIMULATED, save, style

DOCS = Path(__file__).resolve().parents[1] / "docs"
LOW_BEFORE, LOW_AFTER = 3, 4  # columns of the table of seas
ROW = re.compile(r"\| sea-8m \| holdout \|.*\|")


def low_frequency_errors(text: str) -> dict[str, tuple[float, float]]:
    """Errors (%) of low-frequency energy before and after, by motion, in the sea that was not fitted."""
    section = text.split(f"### {CASES[DRAWN]}")[1].split("\n### ")[0]
    rows = [[cell.strip() for cell in row.strip("|").split("|")] for row in ROW.findall(section)]
    return {row[2]: (float(row[LOW_BEFORE].rstrip(" %")), float(row[LOW_AFTER].rstrip(" %"))) for row in rows}


def draw(errors: dict[str, tuple[float, float]], path: Path) -> None:
    """Bars by motion: the published model, the fitted one, and the one with what was found."""
    looks = (
        ("best published case, tuned to decays (Sarker et al. 2025)", GREY),
        ("strips fitted to two lower seas", BEFORE),
        ("the same with what jaxhydro found missing", SIMULATED),
    )
    published = dict(zip(MOTIONS, (100 * error for error in PAPER["low_frequency"]), strict=True))
    with style():
        figure = Figure(figsize=(6.0, 2.7), layout="constrained")
        FigureCanvasAgg(figure)
        ax = figure.subplots()
        for i, (label, colour) in enumerate(looks):
            values = [(published[motion], *errors[motion])[i] for motion in MOTIONS]
            places = [k + 0.27 * (i - 1) for k in range(len(MOTIONS))]
            bars = ax.bar(places, values, 0.25, color=colour, label=label)
            ax.bar_label(bars, [f"{value:+.0f} %" for value in values], padding=2)
        ax.axhline(0.0, color="#30343b", lw=1.0)
        ax.set_xticks(range(len(MOTIONS)), [f"slow {motion}" for motion in MOTIONS])
        ax.tick_params(axis="x", length=0)
        ax.set_ylabel("Error of energy (0: as measured)")
        ax.set_yticks([-100, 0, 100], ["-100 %", "0", "+100 %"])
        ax.set_ylim(-105, 150)
        ax.grid(axis="x", visible=False)
        title = "Slow motion of a 1:70 floating-wind platform in a sea that was not fitted"
        legend = figure.legend(loc="outside upper left", title=title, alignment="left", ncols=1)
        legend.get_title().set_fontweight("bold")
        save(figure, path)


if __name__ == "__main__":
    draw(low_frequency_errors((DOCS / "validation.md").read_text(encoding="utf-8")), DOCS / "figures" / "closed-loop.png")
