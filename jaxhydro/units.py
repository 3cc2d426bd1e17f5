"""Units in which people read motions: m, and degrees where the program has radians."""

import numpy as np

from jaxhydro.environment import DOFS


def unit_of(channel: str) -> str:
    """The unit in which people read a channel: m or deg."""
    return "deg" if channel in DOFS[3:] else "m"


def for_people(channel: str, values: np.ndarray | float) -> np.ndarray:
    """SI values of a channel in the unit in which people read them."""
    return np.rad2deg(values) if unit_of(channel) == "deg" else np.asarray(values)
