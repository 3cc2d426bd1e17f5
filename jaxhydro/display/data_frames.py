"""Motions, natural modes and parameters as pandas data frames, and as HTML tables for notebooks."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from markupsafe import Markup

from jaxhydro.display.summaries import has_numbers, model_summary, span
from jaxhydro.environment import DOFS
from jaxhydro.units import for_people, unit_of

if TYPE_CHECKING:
    from jaxhydro.dynamics.model import Model
    from jaxhydro.dynamics.natural_modes import Modes
    from jaxhydro.dynamics.response import Response

DIGITS = 4  # significant digits of a number in an HTML table
MAX_ROWS = 60  # of an HTML table


def response_frame(response: "Response") -> pd.DataFrame:
    """Motions (m, deg) over time, with the column names of motion.csv.

    Args:
        response: The motion, (t, 6).

    Returns:
        Columns `surge_m` ... `yaw_deg`, index `time_s`.

    Raises:
        ValueError: There are several motions in one, (..., t, 6).
    """
    columns = {f"{dof}_{unit_of(dof)}": for_people(dof, values) for dof, values in single(response).items()}
    return pd.DataFrame(columns, index=pd.Index(np.asarray(response.time), name="time_s"))


def single(response: "Response") -> dict[str, np.ndarray]:
    """Position (m, rad) by motion, (t,).

    Raises:
        ValueError: There are several motions in one, (..., t, 6).
    """
    position = np.asarray(response.position)
    if position.ndim != 2:
        raise ValueError(f"expected one motion, (t, 6), found an array {position.shape}: take one with jax.tree.map")
    return dict(zip(DOFS, position.T, strict=True))


def statistics_frame(response: "Response") -> pd.DataFrame:
    """Minimum, maximum, mean and standard deviation of each motion (m, deg)."""
    frame = response_frame(response)
    sizes = {"minimum": frame.min(), "maximum": frame.max(), "mean": frame.mean(), "standard deviation": frame.std(ddof=0)}
    statistics = pd.DataFrame(sizes).round(6) + 0.0  # no -0
    statistics.insert(0, "motion", list(DOFS))
    statistics["unit"] = [unit_of(dof) for dof in DOFS]
    return statistics


def modes_frame(modes: "Modes") -> pd.DataFrame:
    """Natural periods and mode shapes.

    Args:
        modes: The natural modes.

    Returns:
        One row for each mode: `motion`, `period_s`, and its shape in `surge` ... `yaw`, the largest entry 1.
    """
    shape = pd.DataFrame(np.reshape(modes.shape, (-1, len(DOFS))), columns=list(DOFS))
    return pd.concat([pd.DataFrame({"motion": modes.motion, "period_s": modes.period}), shape], axis=1)


def parameters_frame(model: "Model") -> pd.DataFrame:
    """Value, unit and meaning of every parameter of a model, by label."""
    rows = {label: (float(value), (about := model.about(label)).unit, about.meaning) for label, value in model.values.items()}
    return pd.DataFrame.from_dict(rows, orient="index", columns=["value", "unit", "meaning"]).rename_axis("parameter")


def html(heading: str, frame: pd.DataFrame, index: bool = False) -> str:
    """HTML of a heading, line by line, and a table; all text is escaped.

    Args:
        heading: Text above the table.
        frame: The table.
        index: Whether the index is shown.
    """
    shown = frame.reset_index() if index else frame
    table = shown.to_html(index=False, escape=True, na_rep="", max_rows=MAX_ROWS, float_format=f"{{:.{DIGITS}g}}".format)
    lines = Markup("<br>").join(line.strip() for line in heading.splitlines())
    return str(Markup("<p>{}</p>\n{}").format(lines, Markup(table)))


def response_html(response: "Response") -> str:
    """Duration and step of a motion, and a table of its statistics."""
    return html(f"Response: {span(response)}", statistics_frame(response))


def modes_html(modes: "Modes") -> str:
    """Table of natural periods."""
    unstable = f"; unstable in {', '.join(modes.unstable)}" if modes.unstable else ""
    return html(f"Natural modes{unstable}", modes_frame(modes)[["motion", "period_s"]])


def model_html(model: "Model") -> str | None:
    """Summary of a model, and a table of its parameters; None where its numbers are not computed yet."""
    return None if not has_numbers(model) else html(model_summary(model), parameters_frame(model), index=True)
