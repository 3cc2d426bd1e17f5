"""The sketch of a campaign in docs/conventions.md: a platform in a tank from the side, with axes, motions and sensors.

    python -m benchmarks.campaign_figure

It needs no data. Nothing in it is to scale.
"""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Polygon, Rectangle

from jaxhydro.plots.style import GREY, MEASURED, SIMULATED, WAVE, save, style

PICTURE = Path(__file__).resolve().parents[1] / "docs" / "figures" / "campaign-sketch.png"
WATER, STEEL, EDGE, LINES = "#e8f2f3", "#d5d9de", "#6d737c", "#a0763c"
LEFT, RIGHT, BED, TOP = -11.0, 11.0, -5.2, 6.3
REFERENCE, TRACKED, GAUGE = (0.0, 0.0), (3.4, 1.5), -7.0  # (x, z), (x, z), x


def arrow(ax: Axes, start: tuple[float, float], end: tuple[float, float], colour: str, width: float = 1.6) -> None:
    """Draw an arrow from start to end."""
    style: dict[str, Any] = {
        "arrowstyle": "-|>",
        "color": colour,
        "lw": width,
        "shrinkA": 0,
        "shrinkB": 0,
        "mutation_scale": 11,
    }
    ax.annotate("", xy=end, xytext=start, arrowprops=style, zorder=8)


def elevation(x: np.ndarray) -> np.ndarray:
    """Height of the drawn wave above still water level."""
    return 0.42 * np.cos(2 * np.pi * (x - GAUGE - 0.2) / 5.6) * np.clip((9.0 - x) / 4.0, 0.0, 1.0)


def draw_tank(ax: Axes) -> None:
    """Draw the water, the still water level, the wavemaker and the beach."""
    x = np.linspace(LEFT, RIGHT, 600)
    ax.fill_between(x, BED, elevation(x), color=WATER, zorder=0)
    ax.plot(x, elevation(x), color=WAVE, lw=1.3, zorder=1)
    ax.plot([LEFT, RIGHT], [0, 0], color=WAVE, lw=0.8, ls=(0, (5, 3)), zorder=1)
    ax.plot([LEFT, LEFT, RIGHT, RIGHT], [1.6, BED, BED, 1.6], color=EDGE, lw=2.0, zorder=2)
    ax.add_patch(Rectangle((LEFT, BED), 0.35, 6.8, color=EDGE, zorder=2))
    ax.add_patch(Polygon([(8.1, BED), (RIGHT, 0.8), (RIGHT, BED)], color="#c9c3b6", zorder=2))
    ax.text(LEFT + 0.1, 1.8, "wavemaker", color=EDGE)
    ax.text(RIGHT, 1.8, "beach", color=EDGE, ha="right")
    ax.text(9.9, 0.15, "z = 0", color=WAVE, ha="center", va="bottom", zorder=9)
    ax.annotate(
        "still water level",
        xy=(7.4, 0.0),
        xytext=(6.7, -1.6),
        color=WAVE,
        ha="center",
        arrowprops={"arrowstyle": "-", "color": WAVE, "lw": 0.7},
        zorder=9,
    )
    arrow(ax, (-10.2, 3.35), (-7.9, 3.35), WAVE, 2.0)
    ax.text(-10.2, 3.65, "waves run to +x: heading 0", color=WAVE, va="bottom")


def draw_platform(ax: Axes) -> None:
    """Draw hull, tower and mooring lines."""
    for side in (-1, 1):
        x = np.linspace(4.1, 7.2, 60)
        sag = -1.9 + (BED + 1.95) * (1 - ((7.2 - x) / 3.1) ** 2)
        ax.plot(side * x, sag, color=LINES, lw=1.4, zorder=3)
        ax.plot([side * 7.2], [BED + 0.05], "s", color=LINES, ms=5, zorder=3)
    ax.text(5.6, -3.3, "mooring line", color=LINES)
    steel: dict[str, Any] = {"facecolor": STEEL, "edgecolor": EDGE, "lw": 1.0, "zorder": 4}
    ax.add_patch(Rectangle((-4.1, -2.1), 8.2, 0.55, **steel))  # pontoon
    for middle, width in ((-3.4, 1.4), (0.0, 1.2), (3.4, 1.4)):
        ax.add_patch(Rectangle((middle - width / 2, -2.1), width, 3.2, **steel))
    ax.add_patch(Polygon([(-0.4, 1.1), (0.4, 1.1), (0.22, 5.9), (-0.22, 5.9)], **steel))
    ax.add_patch(Rectangle((-0.55, 5.55), 1.3, 0.5, **steel))


def draw_axes(ax: Axes) -> None:
    """Draw the reference point, the axes and the positive senses of the motions."""
    arrow(ax, REFERENCE, (2.0, 0.0), SIMULATED, 2.0)
    arrow(ax, REFERENCE, (0.0, 2.9), SIMULATED, 2.0)
    ax.text(1.64, -0.55, "x, surge +", color=SIMULATED, fontweight="bold", zorder=9, va="top", ha="center")
    ax.text(-0.5, 2.35, "z, heave +", color=SIMULATED, fontweight="bold", zorder=9, ha="right")
    ax.add_patch(Arc(REFERENCE, 8.2, 8.2, theta1=62, theta2=84, color=SIMULATED, lw=1.8, zorder=8))
    end = np.radians(np.array([62.5, 60.0]))
    (x0, x1), (z0, z1) = 4.1 * np.cos(end), 4.1 * np.sin(end)
    arrow(ax, (x0, z0), (x1, z1), SIMULATED, 1.8)
    ax.text(1.55, 4.7, "pitch +", color=SIMULATED, fontweight="bold", va="bottom")
    ax.text(1.55, 4.2, "the top leans to +x", color=SIMULATED, va="bottom")
    ax.plot(*REFERENCE, "o", color="white", mec=SIMULATED, mew=1.8, ms=7, zorder=10)
    ax.annotate(
        "reference point: centreline,\nstill water level",
        xy=(-0.1, -0.12),
        xytext=(0.0, -3.0),
        color=SIMULATED,
        ha="center",
        va="top",
        arrowprops={"arrowstyle": "-", "color": SIMULATED, "lw": 0.9, "shrinkA": 1, "shrinkB": 4},
        zorder=9,
    )


def draw_sensors(ax: Axes) -> None:
    """Draw the wave gauge with its position, and the tracked point with its camera."""
    ax.plot([GAUGE, GAUGE], [-1.3, 2.0], color=MEASURED, lw=2.0, zorder=5)
    ax.text(GAUGE, 2.15, "wave gauge", color=MEASURED, ha="center", va="bottom", fontweight="bold")
    style: dict[str, Any] = {"arrowstyle": "<|-|>", "color": GREY, "lw": 0.9, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 8}
    ax.plot([0, 0], [-4.45, -4.05], color=GREY, lw=0.9, zorder=3)
    ax.plot([GAUGE, GAUGE], [-4.45, -1.3], color=GREY, lw=0.9, ls=":", zorder=3)
    ax.annotate("", xy=(GAUGE, -4.25), xytext=(0, -4.25), arrowprops=style, zorder=5)
    ax.text(-2.5, -4.4, "position [x, y], here x < 0", color=MEASURED, ha="center", va="top", zorder=9)
    ax.plot([TRACKED[0], TRACKED[0]], [1.1, 1.5], color=MEASURED, lw=1.2, zorder=5)
    ax.plot([TRACKED[0], 8.55], [TRACKED[1], 3.5], color=MEASURED, lw=0.8, ls=(0, (2, 2)), zorder=5)
    ax.plot(*TRACKED, "o", color=MEASURED, ms=7, zorder=10)
    ax.annotate(
        "", xy=TRACKED, xytext=REFERENCE, arrowprops={"arrowstyle": "-|>", "color": GREY, "lw": 1.0, "shrinkB": 4}, zorder=7
    )
    ax.text(4.35, 1.55, "tracked point", color=MEASURED, va="center", fontweight="bold")
    ax.text(4.35, 1.05, "[x, y, z] from the reference point", color=MEASURED, va="center")
    ax.add_patch(Rectangle((8.5, 3.3), 1.1, 0.65, facecolor=MEASURED, zorder=6))
    ax.add_patch(Polygon([(8.5, 3.55), (8.15, 3.25), (8.3, 3.85)], color=MEASURED, zorder=6))
    ax.text(9.05, 4.1, "camera", color=MEASURED, ha="center", va="bottom")


def draw(path: Path) -> None:
    """Draw the sketch.

    Args:
        path: The picture.
    """
    with style():
        figure = Figure(figsize=(7.0, 3.9))
        FigureCanvasAgg(figure)
        ax = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        draw_tank(ax)
        draw_platform(ax)
        draw_axes(ax)
        draw_sensors(ax)
        ax.set_xlim(LEFT - 0.3, RIGHT + 0.3)
        ax.set_ylim(BED - 0.2, TOP)
        ax.set_aspect("equal")
        ax.axis("off")
        save(figure, path)


if __name__ == "__main__":
    draw(PICTURE)
