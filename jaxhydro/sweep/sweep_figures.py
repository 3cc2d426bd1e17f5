"""Figures of a sweep: scatter diagram and exceedance of extremes."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from jaxtyping import Float
from matplotlib.ticker import FuncFormatter

from jaxhydro.plots.style import GREY, MEASURED, SIMULATED, stack
from jaxhydro.sweep.lifetime import Runs, exceedance

MAX_LABELLED_STATES = 16  # sea states, up to which their probability is written into the diagram
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
    """Scatter diagram of sea states, with area by probability and colour by a standard deviation.

    A hollow mark has no result. Cases of one sea state share a mark: probabilities add up, and the deviation is the root of
    their weighted mean square.

    Args:
        hs: Significant wave heights (m), (case,).
        tp: Peak periods (s), (case,).
        probability: Probabilities, (case,).
        deviation: Standard deviations, NaN where unknown, (case,).
        label: Label of the colours.
        title: Title of the figure.
    """
    states, state_index = np.unique(np.stack([hs, tp], axis=1), axis=0, return_inverse=True)
    state_index = state_index.reshape(-1)
    finite = np.isfinite(deviation)
    share = np.bincount(state_index, probability, len(states))
    known_share = np.bincount(state_index, probability * finite, len(states))
    square = np.bincount(state_index, probability * np.where(finite, deviation, 0.0) ** 2, len(states))
    colour = np.sqrt(square / np.where(known_share > 0, known_share, np.nan))
    figure, (ax,) = stack([2.3])
    size = np.clip(420 * share / share.max(), 18, None) * min(1.0, 30 / len(states))
    solid = np.isfinite(colour)
    order = np.argsort(-size)
    order = order[solid[order]]
    marks = ax.scatter(
        states[order, 1],
        states[order, 0],
        s=size[order],
        c=colour[order],
        cmap=COLOURS,
        lw=0.4,
        edgecolors="white",
        zorder=2,
        clip_on=False,
    )
    if not solid.all():
        hollow = states[~solid]
        ax.scatter(hollow[:, 1], hollow[:, 0], s=size[~solid], fc="none", ec=SIMULATED, lw=0.9, zorder=3, clip_on=False)
    if len(states) <= MAX_LABELLED_STATES:
        for (height, period), fraction, area in zip(states, share, size):
            percent = "100" if fraction > 0.995 else f"{100 * fraction:.2g}"
            ax.annotate(
                f"{percent} %",
                (period, height),
                textcoords="offset points",
                xytext=(0, np.sqrt(area / np.pi) + 2),
                ha="center",
                fontsize=6.5,
                color=MEASURED,
            )
    ax.margins(0.16)
    ax.set_ylim(0, ax.get_ylim()[1])
    ax.set_xlabel("Peak period (s)")
    ax.set_ylabel("Significant wave height (m)")
    bar = figure.colorbar(marks, ax=ax, pad=0.02, aspect=28)
    bar.set_label(label)
    bar.outline.set_visible(False)
    ring = "" if solid.all() else "; ring: no run is done"
    figure.suptitle(f"{title}, areas by probability{ring}", x=0.015, ha="left", fontsize=8, fontweight="bold")
    return figure


def exceedance_figure(
    names: Sequence[str],
    minima: Sequence[Runs],
    maxima: Sequence[Runs],
    probability: Float[np.ndarray, " case"],
    duration: float,
    title: str,
) -> Figure:
    """Probability that a run of a random case goes beyond a value.

    Minima are to the left, maxima to the right. There is one line per seed and one for all seeds.

    Args:
        names: Panels, with units.
        minima: Minima of each panel's channel, NaN where a run failed, (case, seed).
        maxima: Maxima, likewise.
        probability: Probabilities, (case,).
        duration: Duration of a run (s).
        title: Title of the figure.
    """
    figure, axes = stack([1.15] * len(names), shared=False)
    artists: dict[str, Any] = {}
    for ax, name, least, most in zip(axes, names, minima, maxima, strict=True):
        lowest = 0.1
        for sign, values in ((-1, -least), (1, most)):
            for column in values.T if values.shape[1] > 1 else ():
                x, p = exceedance(probability, column)
                if len(x):
                    (artists["one seed"],) = ax.step(sign * _begun(x), [1.0, *p], where="pre", color=GREY, lw=0.5, alpha=0.7)
            x, p = exceedance(np.repeat(probability, values.shape[1]), values.reshape(-1))
            if len(x):
                (artists["all seeds"],) = ax.step(sign * _begun(x), [1.0, *p], where="pre", color=SIMULATED, lw=1.1)
                lowest = min(lowest, 0.5 * float(p.min()))
        ax.set_yscale("log")
        ax.set_ylim(lowest, 1.15)
        ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        ax.minorticks_off()
        ax.set_xlabel(f"Minimum and maximum of {name}")
        ax.set_ylabel("Probability beyond")
    legend = figure.legend(
        list(artists.values()),
        list(artists),
        loc="outside upper left",
        ncols=2,
        alignment="left",
        title=f"{title}, runs of {duration:g} s after the transient",
    )
    legend.get_title().set_fontweight("bold")
    return figure


def _begun(x: Float[np.ndarray, " n"]) -> Float[np.ndarray, " m"]:
    """Values of `exceedance` with the first repeated, where the probability is 1."""
    return np.concatenate([x[:1], x])
