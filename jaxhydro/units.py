"""Units of files and of printed motions (m and degrees)."""

import numpy as np

from jaxhydro.environment import DOFS

SI = {  # units that files may state, by quantity, and what they are in SI
    "time": {"s": 1.0, "ms": 1e-3, "min": 60.0},
    "length": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "ft": 0.3048},
    "angle": {"rad": 1.0, "mrad": 1e-3, "deg": 0.017453292519943295},
}


def unit_of(channel: str) -> str:
    """Unit in which a channel is printed: m or deg."""
    return "deg" if channel in DOFS[3:] else "m"


def for_people(channel: str, values: np.ndarray | float) -> np.ndarray:
    """SI values of a channel in the unit in which it is printed."""
    return np.rad2deg(values) if unit_of(channel) == "deg" else np.asarray(values)
