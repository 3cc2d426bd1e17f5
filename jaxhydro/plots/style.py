"""Style of the figures, and the figure of a simulated motion (no pyplot, no global state)."""

from collections.abc import Mapping
from contextlib import AbstractContextManager
from pathlib import Path
from types import MappingProxyType
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from PIL import Image

from jaxhydro.units import unit_of

WIDTH = 3.35  # inches: half a page, where the text is 8 points
MEASURED, SIMULATED, BEFORE, WAVE, GREY = "#30343b", "#d1495b", "#8fb4d9", "#2f7f86", "#8a9099"
STYLE: Any = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "mathtext.default": "regular",
    "font.size": 8.0,
    "axes.titlesize": 8.0,
    "axes.titlelocation": "left",
    "axes.labelsize": 8.0,
    "axes.linewidth": 0.6,
    "axes.edgecolor": "#555a62",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.unicode_minus": True,
    "grid.color": "#e4e6ea",
    "grid.linewidth": 0.5,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "legend.handlelength": 1.4,
    "legend.columnspacing": 0.9,
    "legend.handletextpad": 0.5,
    "legend.borderaxespad": 0.2,
    "lines.linewidth": 1.0,
    "lines.solid_capstyle": "round",
    "savefig.dpi": 300,
}


def stack(heights: list[float], shared: bool = True) -> tuple[Figure, list[Axes]]:
    """Half-page figure of stacked panels, heights in inches; call within STYLE."""
    figure = Figure(figsize=(WIDTH, sum(heights) + (0.75 if shared else 0.45 * (len(heights) + 1))), layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.subplots(len(heights), 1, sharex=shared, squeeze=False, gridspec_kw={"height_ratios": heights})
    axes = list(grid[:, 0])
    for ax, height in zip(axes, heights, strict=True):
        ax.yaxis.set_major_locator(MaxNLocator(5 if height > 1 else 3, steps=[1, 2, 2.5, 5, 10]))
        ax.xaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 2.5, 5, 10]))
        ax.margins(x=0.01)
    figure.align_ylabels(axes)
    return figure, axes


def header(figure: Figure, title: str, artists: Mapping[str, Artist] = MappingProxyType({}), columns: int = 4) -> None:
    """The title, and under it the legend, above all axes, where it hides nothing."""
    if not artists:
        figure.suptitle(title, x=0.015, ha="left", fontsize=8, fontweight="bold")
        return
    legend = figure.legend(
        list(artists.values()), list(artists), loc="outside upper left", ncols=columns, title=title, alignment="left"
    )
    legend.get_title().set_fontweight("bold")


def save(figure: Figure, path: Path) -> None:
    """Write a PNG of few colours, a third of the size of one of all. Call within STYLE.

    The canvas is drawn once. `Figure.savefig` would draw it a second time after its axes are laid out, and write a PNG that
    would have to be read again.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.set_dpi(STYLE["savefig.dpi"])
    canvas = FigureCanvasAgg(figure)
    if (layout := figure.get_layout_engine()) is not None:
        layout.execute(figure)
        figure.set_layout_engine("none")
    for ax in figure.axes:  # before the labels are drawn, which are aligned with those of the other axes
        ax.apply_aspect()
    canvas.draw()
    drawn = Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")
    few = drawn.quantize(64, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    few.save(path, dpi=(STYLE["savefig.dpi"],) * 2)


def motion_figure(time: np.ndarray, motion: dict[str, np.ndarray], wave: np.ndarray | None, title: str) -> Figure:
    """Figure of moving motions (m, deg) over time (s), below the wave elevation (m) if given."""
    size = {name: float(np.ptp(values)) for name, values in motion.items()}
    largest = {unit: max(size[n] for n in size if unit_of(n) == unit) for unit in ("m", "deg")}
    moving = [name for name in motion if size[name] > max(1e-3, 1e-4 * largest[unit_of(name)])] or list(motion)[:1]
    figure, axes = stack([0.8] * (len(moving) + (wave is not None)))
    rows = [("wave", wave, WAVE)] if wave is not None else []
    rows += [(name, motion[name], SIMULATED) for name in moving]
    for ax, (name, values, colour) in zip(axes, rows, strict=True):
        ax.plot(time, values, color=colour, lw=0.8)
        ax.set_ylabel(f"{name.capitalize()} ({unit_of(name)})")
    axes[-1].set_xlabel("Time (s)")
    header(figure, title)
    return figure


def style() -> AbstractContextManager[None]:
    """The context in which figures are made and saved."""
    return mpl.rc_context(STYLE)
