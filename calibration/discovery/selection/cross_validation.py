"""Cross-validation on a linear model: tests left out in turn.

References:
    Stone 1974, Journal of the Royal Statistical Society B 36, 111-147.
"""

from collections.abc import Sequence

import numpy as np

from calibration.discovery.selection.linear_model import LinearFit, LinearModel


def left_out_deviances(model: LinearModel, columns: Sequence[int], group: np.ndarray, begin: LinearFit) -> np.ndarray:
    """-2 ln L of every group of pools (g,), where columns are fitted to all others.

    A decay's own unknowns, such as its release, are fitted to the decay.

    Args:
        model: The linear model.
        columns: Columns that are fitted.
        group: Group of every pool (p,).
        begin: A fit of these columns to all groups.
    """
    deviances = np.zeros(group.max() + 1)
    for number in np.unique(group[model.used]):
        out = group == number
        rest = model.with_freedom(np.where(out, 0.0, model.freedom)).fit(columns, begin)
        held_out = model.with_freedom(np.where(out, model.freedom, 0.0)).fit((), start=model.steps_after(rest))
        deviances[number] = float(held_out.deviance.sum())
    return deviances


def held_out_gain(model: LinearModel, fitted: LinearFit, without: LinearFit, group: np.ndarray) -> np.ndarray:
    """Decrease of -2 ln L of every left-out group (g,), by columns that one of two fits lacks.

    Args:
        model: The linear model.
        fitted: The fit with them.
        without: The fit without them.
        group: Group of every pool (p,): its test.
    """
    before, after = (left_out_deviances(model, fit.columns, group, fit) for fit in (without, fitted))
    return before - after
