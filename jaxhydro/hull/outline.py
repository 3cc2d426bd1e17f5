"""Outlines of load elements: the surface of the hull, for drawings in three dimensions."""

from typing import Any

import numpy as np
from jaxtyping import Float

from jaxhydro.hull.hull import Hull

POINTS = 16  # of the outline of a section
CORNERS = np.array([(1, 1), (1, -1), (-1, -1), (-1, 1)]) / 2  # of a rectangle, over its sizes
HULL_DIMENSIONS = ("hull_element", "hull_end", "hull_point", "axis")


def circle(points: int) -> Float[np.ndarray, "p 2"]:
    """Points of a circular section over its two diameters."""
    angle = np.linspace(0.0, 2 * np.pi, points, endpoint=False)
    return np.column_stack([np.cos(angle), np.sin(angle)]) / 2


def element_outlines(hull: Hull, points: int = POINTS) -> Float[np.ndarray, "e 2 p 3"]:
    """Points (m) on both end sections of every load element, in body axes about the reference point.

    Args:
        hull: The hull.
        points: Number of points of a section, a multiple of four.

    Returns:
        (elements, lower and upper end, points of the section, x y z); no elements where the hull has no members.
    """
    strips, elements = hull.strips, hull.elements
    first = {element: strip for strip, element in reversed(list(enumerate(strips.element)))}
    first_strip = [first[i] for i in range(elements.length.size)]
    rectangle = np.repeat(CORNERS, points // len(CORNERS), axis=0)
    round_ = np.asarray(strips.shape)[first_strip] < 1
    section = np.where(round_[:, None, None], circle(points), rectangle)
    along = np.stack([np.zeros(len(first_strip)), np.asarray(elements.length)], axis=1)
    size, taper = (np.asarray(extent)[:, first_strip].T[:, None] for extent in (strips.size, strips.taper))
    sizes = size + taper * along[..., None]
    middle = np.asarray(elements.start).T[:, None] + along[..., None] * np.asarray(elements.axis).T[:, None]
    across = section[:, None] * sizes[:, :, None]
    directions = np.asarray(strips.directions)[:, :, first_strip]
    return middle[:, :, None] + np.einsum("ejpk,ike->ejpi", across, directions)


def hull_variable(hull: Hull) -> dict[str, Any]:
    """Variable `hull` of a data set, as xarray takes it; none where the hull has no members."""
    outlines = element_outlines(hull)
    about = {"units": "m", "long_name": "end sections of the hull's elements, body axes from the reference point"}
    return {"hull": (HULL_DIMENSIONS, outlines, about)} if len(outlines) else {}
