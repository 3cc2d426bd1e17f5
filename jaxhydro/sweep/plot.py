"""The figures of a sweep: the scatter diagram, and how often maxima are exceeded."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from jaxtyping import Float
from matplotlib.ticker import FuncFormatter

from jaxhydro.plot import GREY, MEASURED, SIMULATED, stack
from jaxhydro.sweep.lifetime import exceedance

WRITTEN = 16  # sea states, up to which their probability is written into the diagram
COLOURS = "viridis"
Figure = Any


def scatter_figure(
    hs: Float[np.ndarray, " case"],
    tp: Float[np.ndarray, " case"],
    probability: Float[np.ndarray, " case"],
    deviation: Float[np.ndarray, " case"],
    label: str,
    title: str,
) -> Figure:
    """Sea states over Tp (s) and Hs (m), as large as they are probable and coloured by a standard deviation; hollow: none is
    known.

    Cases of one sea state are one mark: its probability is their sum, its deviation the root of their weighted mean square.
    """
    states, of = np.unique(np.stack([hs, tp], axis=1), axis=0, return_inverse=True)
    of = of.reshape(-1)
    there = np.isfinite(deviation)
    share = np.bincount(of, probability, len(states))
    known = np.bincount(of, probability * there, len(states))
    square = np.bincount(of, probability * np.where(there, deviation, 0.0) ** 2, len(states))
    colour = np.sqrt(square / np.where(known > 0, known, np.nan))
    figure, (ax,) = stack([2.3])
    size = np.clip(420 * share / share.max(), 18, None) * min(1.0, 30 / len(states))
    solid = np.isfinite(colour)
    order = np.argsort(-size)
    order = order[solid[order]]
    marks = ax.scatter(
        states[order, 1], states[order, 0], s=size[order], c=colour[order], cmap=COLOURS, lw=0.4, edgecolors="white", zorder=2
    )
    if not solid.all():
        ax.scatter(states[~solid, 1], states[~solid, 0], s=size[~solid], fc="none", ec=SIMULATED, lw=0.9, zorder=3)
    if len(states) <= WRITTEN:
        for (height, period), one, area in zip(states, share, size):
            said = "100" if one > 0.995 else f"{100 * one:.2g}"
            ax.annotate(
                f"{said} %", (period, height), textcoords="offset points", xytext=(0, np.sqrt(area / np.pi) + 2),
                ha="center", fontsize=6.5, color=MEASURED,
            )  # fmt: skip
    ax.margins(0.16)
    ax.set_ylim(0, ax.get_ylim()[1])
    ax.set_xlabel("Peak period (s)")
    ax.set_ylabel("Significant wave height (m)")
    bar = figure.colorbar(marks, ax=ax, pad=0.02, aspect=28)
    bar.set_label(label)
    bar.outline.set_visible(False)
    figure.suptitle(f"{title}, areas by probability", x=0.015, ha="left", fontsize=8, fontweight="bold")
    return figure


def exceedance_figure(
    names: Sequence[str],
    maxima: Sequence[Float[np.ndarray, "case seed"]],
    probability: Float[np.ndarray, " case"],
    duration: float,
    title: str,
) -> Figure:
    """Probability that a run of a random case, `duration` (s) long, has a larger maximum: one line per seed, and all of them.

    `names` are those of the panels, with units; `maxima` are NaN where a run failed.
    """
    figure, axes = stack([1.15] * len(names), shared=False)
    artists: dict[str, Any] = {}
    for ax, name, values in zip(axes, names, maxima, strict=True):
        for column in values.T if values.shape[1] > 1 else ():
            x, p = exceedance(probability, column)
            if len(x):
                (artists["one seed"],) = ax.step([x[0], *x], [1.0, *p], where="pre", color=GREY, lw=0.5, alpha=0.7)
        x, p = exceedance(np.repeat(probability, values.shape[1]), values.reshape(-1))
        if len(x):
            (artists["all seeds"],) = ax.step([x[0], *x], [1.0, *p], where="pre", color=SIMULATED, lw=1.1)
        ax.set_yscale("log")
        ax.set_ylim(min(0.5 * float(p.min(initial=0.1)), 0.1), 1.15)
        ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        ax.minorticks_off()
        ax.set_xlabel(f"Maximum of {name}")
        ax.set_ylabel("Share of runs above")
    legend = figure.legend(
        list(artists.values()), list(artists), loc="outside upper left", ncols=2, alignment="left",
        title=f"{title}, runs of {duration:g} s",
    )  # fmt: skip
    legend.get_title().set_fontweight("bold")
    return figure
