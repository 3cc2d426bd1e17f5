"""Waves outside the frequency range of the tables that a platform's loads come from."""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import jax
import numpy as np
from jaxtyping import Float

from jaxhydro.dynamics.model import Model
from jaxhydro.loads.base import AbstractLoad
from jaxhydro.remarks import Remark
from jaxhydro.waves.components import Components
from jaxhydro.waves.excitation import TABLE_END_TOLERANCE
from jaxhydro.waves.sea import AbstractSea
from jaxhydro.waves.wave_sea import WaveSea

WARNING_SHARE = 0.01  # of a sea's energy outside a table, from which it is a warning
NOTE_SHARE = 5e-5  # of a sea's energy outside a table, from which it is said at all
WHAT = {
    "excitation": "these waves do not excite the platform",
    "drift": "these waves do not make it drift",
    "radiation": "its damping there is extrapolated",
}


class TableRange(NamedTuple):
    """Frequency range (rad/s) of a load's table; `key` is its key in the platform file."""

    key: str
    low: float
    high: float

    @property
    def words(self) -> str:
        """Range in rad/s and in s, in words."""
        if self.low <= 0:
            return f"up to {self.high:.5g} rad/s (periods from {2 * math.pi / self.high:.5g} s)"
        periods = f"{2 * math.pi / self.high:.5g} to {2 * math.pi / self.low:.5g} s"
        return f"{self.low:.5g} to {self.high:.5g} rad/s (periods {periods})"

    def outside(self, omega: Float[np.ndarray, " w"]) -> Float[np.ndarray, " w"]:
        """Whether each frequency (rad/s) is outside the table."""
        return (omega < self.low * (1 - TABLE_END_TOLERANCE)) | (omega > self.high * (1 + TABLE_END_TOLERANCE))

    def share_outside(self, omega: Float[np.ndarray, " w"], energy: Float[np.ndarray, " w"]) -> float:
        """Fraction of the energy (any unit) at frequencies (rad/s) outside the table."""
        total = float(np.sum(energy))
        return float(np.sum(energy[self.outside(omega)])) / total if total > 0 else 0.0

    def remark(self, share: float, where: str = "the sea") -> Remark | None:
        """Remark on a fraction of a sea's energy outside the table; None where it is negligible."""
        if share < NOTE_SHARE:
            return None
        outside = f"{share:.2%} of the energy of {where} lies outside the {self.key} table"
        return Remark(f"{outside}, which has {self.words}: {WHAT[self.key]}", warning=share > WARNING_SHARE)


def table_ranges(model: Model, candidates: bool = False) -> tuple[TableRange, ...]:
    """Frequency ranges of the tables that act in a model.

    Args:
        model: The platform.
        candidates: Include tables that a diagnosis may add.
    """
    ranges = []
    for load in model.loads:
        covers = load.covers()
        if covers is None or not (candidates or any(_acts(value) for value in load.values.values())):
            continue
        ranges.append(TableRange(*covers))
    return tuple(ranges)


def _acts(value: object) -> bool:
    """Whether a share is not 0; one that is being differentiated is taken to act."""
    return isinstance(value, jax.core.Tracer) or float(value) != 0.0  # type: ignore[arg-type]


def outside_tables(model: Model, waves: Components) -> dict[TableRange, float]:
    """Fraction of the first-order energy of an irregular sea outside each table of the model."""
    omega, energy = np.asarray(waves.omega), np.asarray(waves.amplitude) ** 2
    return {table: table.share_outside(omega, energy) for table in table_ranges(model)}


def regular_fault(model: Model, period: float) -> tuple[str, str] | None:
    """Expected range and found period of a regular wave outside a table, in words, or None."""
    omega = np.array([2 * math.pi / period])
    for table in table_ranges(model):
        if table.outside(omega)[0]:
            return f"a wave within the {table.key} table, which has {table.words}", f"{period:g} s ({omega[0]:.4g} rad/s)"
    return None


def heading_fault(model: Model, headings: Float[np.ndarray, " w"]) -> tuple[str, str] | None:
    """Reason why a model's tables are not for a sea of several headings, or None.

    A table that the platform file gives one `heading` is for waves of that heading alone. A drift table has no pairs of two
    headings: in such a sea it is used by Newman's approximation only.

    Args:
        model: The platform.
        headings: Directions that the waves travel to (rad), (w,).

    Returns:
        What is expected and what is found, in words, or None.
    """
    acting = [load for load in model.loads if any(_acts(value) for value in load.values.values())]
    for key, table in ((k, t) for load in acting for k, t in _tables(load)):
        by_heading = getattr(table, "by_heading", None)
        if by_heading is None:
            wanted = f"{key}.file with several wave headings, and no {key}.heading, for a sea of several headings"
            return f"{wanted} (or no {key})", "a table of one heading"
        outside = ~by_heading.covers(headings)
        if outside.any():
            limits = f"{math.degrees(float(by_heading.heading[0])):g} to {math.degrees(float(by_heading.heading[-1])):g} deg"
            fraction = f"{outside.mean():.1%} of the waves outside them"
            return f"waves of the headings of the {key} table, {limits}", fraction
        if not getattr(table, "newman", True):
            return f"`approximation: newman` of the {key} table in a sea of several headings", "the full table"
    return None


def _tables(load: AbstractLoad) -> Iterator[tuple[str, Any]]:
    for key, table in (("excitation", load.excitation_table()), ("drift", load.transfer_function())):
        if table is not None:
            yield key, table


def check_waves(model: Model, sea: AbstractSea) -> None:
    """Raise ValueError for regular waves outside a table of the model.

    Irregular seas are for `outside_tables`.

    Raises:
        ValueError: With the table's range and the wave.
    """
    if isinstance(sea, WaveSea) and not isinstance(sea.waves.omega, jax.core.Tracer):
        for omega in np.asarray(sea.waves.omega):
            if omega > 0 and (fault := regular_fault(model, 2 * math.pi / float(omega))) is not None:
                raise ValueError(f"expected {fault[0]}, found a period of {fault[1]}")
