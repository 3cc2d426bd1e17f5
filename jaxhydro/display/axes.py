"""Axes of models and motions, in the style of the package's figures; nothing is shown on a screen."""

from typing import TYPE_CHECKING

import numpy as np

from jaxhydro.display.data_frames import single
from jaxhydro.hull.outline import element_outlines
from jaxhydro.plots.hull_drawing import POINTS, drawing
from jaxhydro.plots.style import motion_figure, style
from jaxhydro.units import for_people

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from jaxhydro.dynamics.model import Model
    from jaxhydro.dynamics.response import Response


def response_axes(response: "Response", title: str = "Motion of the reference point") -> "list[Axes]":
    """Panels of all motions that move (m, deg) over time (s).

    Args:
        response: The motion, (t, 6).
        title: Title of the figure.

    Returns:
        Axes, one for each motion; `axes[0].figure` is the figure.

    Raises:
        ValueError: There are several motions in one, (..., t, 6).
    """
    motion = {dof: for_people(dof, values) for dof, values in single(response).items()}
    with style():
        return motion_figure(np.asarray(response.time), motion, None, title).axes


def model_axes(model: "Model", title: str = "Hull") -> "list[Axes]":
    """Load elements of the hull from the side, with still water, and from above.

    Args:
        model: The platform.
        title: Title of the figure.

    Returns:
        Axes of the view from the side and of that from above.

    Raises:
        ValueError: The platform has no members.
    """
    outlines = element_outlines(model.hull, POINTS)
    if not len(outlines):
        raise ValueError("this platform has no members to draw")
    with style():
        return drawing(list(outlines), title).axes
