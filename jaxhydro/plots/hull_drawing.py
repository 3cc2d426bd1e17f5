"""Figure of a hull: its members, or the load elements of a model, from the side and from above."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from scipy.spatial import ConvexHull

from jaxhydro.hull.member import Member
from jaxhydro.hull.outline import CORNERS, circle
from jaxhydro.plots.style import GREY, MEASURED, WAVE, header, stack

POINTS = 48  # of the outline of a circular section
AXES_WIDTH, MAX_HEIGHT = 2.7, 5.0  # inches
MARGIN = 0.06  # of the hull's size, about a drawing
SIDE, ABOVE = (0, 2), (0, 1)  # coordinates of the two views


def outline(member: Member) -> np.ndarray:
    """Points on a member's surface, section by section.

    Args:
        member: The member.

    Returns:
        Points (m) of every section, (sections, points, 3).
    """
    section = circle(POINTS) if member.circular else CORNERS
    first, second = (np.asarray(direction) for direction in member.directions)
    middles = member.a + np.asarray(member.stations)[:, None] * (member.b - member.a)
    across = section[None] * np.asarray(member.sizes)[:, None]
    return middles[:, None] + across[..., :1] * first + across[..., 1:] * second


def hull_figure(members: Sequence[Member], title: str) -> Figure:
    """Members from the side, with still water, and from above. Call within `style`.

    Args:
        members: The members.
        title: Title of the figure.
    """
    return drawing([outline(member) for member in members], title)


def drawing(outlines: Sequence[np.ndarray], title: str) -> Figure:
    """Outlines of `outline` or `element_outlines` as a figure. Call within `style`.

    Args:
        outlines: Points (m) of the sections of each part, (sections, points, 3).
        title: Title of the figure.
    """
    every = np.concatenate([points.reshape(-1, 3) for points in outlines])
    low, high = every.min(axis=0), every.max(axis=0)
    margin = MARGIN * float((high - low).max())
    width, depth, height = high - low + 2 * margin
    scale = min(AXES_WIDTH / width, MAX_HEIGHT / (height + depth))
    figure, (side, above) = stack([scale * height, scale * depth])
    views = (
        (side, SIDE, "z (m)", lambda points: -points[..., 1].mean()),
        (above, ABOVE, "y (m)", lambda points: points[..., 2].max()),
    )
    for ax, view, name, toward in views:  # what is nearer is drawn over what is behind
        for points in sorted(outlines, key=toward):
            for pair in pairwise(points):
                flat = np.concatenate(pair)[:, view]
                corners = flat[ConvexHull(flat).vertices]
                ax.add_patch(Polygon(corners, facecolor="#cfd6df", edgecolor=MEASURED, lw=0.6))
        ax.plot(0.0, 0.0, "+", color=GREY, ms=6)
        ax.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[view[1]] - margin, high[view[1]] + margin))
        ax.set(aspect="equal", ylabel=name)
    above.set_xlabel("x (m)")
    water = side.axhline(0.0, color=WAVE, lw=1.0)
    header(figure, title, {"still water": water})
    return figure
