"""Schema and reading of uncertainty.json, and its tables."""

from typing import Annotated, NamedTuple

from pydantic import Field

from calibration.formatting import counted, interval, listed, number, percent_span, readable_unit, to_width
from calibration.results.read_calibration import Figure, Parameter, ResultModel
from calibration.vocabulary import UNDETERMINED, Rows
from jaxhydro.errors import Number

INTERVAL_METHODS = {"profile": "Profile", "blocks": "Bootstrap, blocks", "repeats": "Bootstrap, repeats", "nuts": "NUTS"}
Interval = tuple[Number | None, Number | None]


class ParameterIntervals(Parameter):
    """One calibrated parameter and its intervals, None on a side that is open: that of the covariance, and those found in the
    ways that were asked for."""

    laplace: Interval
    white_too_small_by: Number | None = None
    profile: Interval | None = None
    blocks: Interval | None = None
    repeats: Interval | None = None
    nuts: Interval | None = None

    def ways(self) -> dict[str, Interval]:
        """The intervals beside the Laplace interval, by way."""
        found: dict[str, Interval | None] = {way: getattr(self, way) for way in INTERVAL_METHODS}
        return {way: ends for way, ends in found.items() if ends is not None}


class SavedBootstrap(ResultModel):
    """A bootstrap: how many resamplings are in its intervals."""

    draws: int


class SavedDraws(ResultModel):
    """NUTS: its chains, and the draws of each."""

    chains: int
    draws: int


class SavedUncertainty(ResultModel):
    """uncertainty.json."""

    campaign: str
    platform: str
    jaxhydro: str
    calibration: str
    level: Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, lt=1)]
    converged: bool
    parameters: dict[str, ParameterIntervals]
    bootstrap: dict[str, SavedBootstrap] = Field(default_factory=dict)
    nuts: SavedDraws | None = None
    notes: list[str] = Field(default_factory=list)
    figures: list[Figure] = Field(default_factory=list)

    @property
    def percent(self) -> str:
        """The level in words."""
        return f"{100 * self.level:.4g} %"

    def ways(self) -> list[str]:
        """The ways beside Laplace in which intervals of some parameter were found."""
        return [way for way in INTERVAL_METHODS if any(way in one.ways() for one in self.parameters.values())]


class IntervalSummary(NamedTuple):
    """What the sentence on intervals says: half widths over the value, by coefficient, and coefficients without any."""

    converged: bool
    level: str
    half_widths: dict[str, float]
    undetermined: tuple[str, ...]


def summary_of(saved: SavedUncertainty) -> IntervalSummary:
    """The summary of the Laplace intervals."""
    widths = {}
    for label, one in saved.parameters.items():
        low, high = one.laplace
        if one.identifiable and not one.at_bound and low is not None and high is not None and one.value:
            widths[label] = 0.5 * (high - low) / abs(one.value)
    rest = tuple(label for label in saved.parameters if label not in widths)
    return IntervalSummary(saved.converged, saved.percent, widths, rest)


def interval_sentence(summary: IntervalSummary) -> str:
    """The intervals in one sentence.

    "All 11 coefficients known to 0.03-10 % (95 % intervals), the least well pontoon.Cd_t."
    """
    widths, rest = summary.half_widths, summary.undetermined
    total = len(widths) + len(rest)
    said = "" if summary.converged else "The fit did not converge. "
    if not widths:
        return f"{said}None of {counted(total, 'coefficient')} has a {summary.level} interval that says anything."
    many = f"All {total} coefficients" if not rest and total > 1 else f"{len(widths)} of {counted(total, 'coefficient')}"
    said += f"{many} known to {percent_span(list(widths.values()))} ({summary.level} intervals)"
    said += f", the least well {max(widths, key=lambda label: widths[label])}" if len(widths) > 1 else ""
    return f"{said}; {UNDETERMINED}: {listed(rest)}." if rest else f"{said}."


def intervals_table(saved: SavedUncertainty) -> Rows:
    """Value, Laplace interval, and how much too small it would be as if errors were white."""
    rows = []
    for label, one in saved.parameters.items():
        low, high = one.laplace
        value = number(one.value) if low is None or high is None else to_width(one.value, high - low)
        excess = "–" if one.white_too_small_by is None else f"{number(one.white_too_small_by, 2)} times"
        flag = "at its bound" if one.at_bound else "" if one.identifiable else UNDETERMINED
        rows.append((label, value, interval(low, high), readable_unit(one.unit), excess, flag))
    return ("Parameter", "Value", f"{saved.percent} interval", "Unit", "Width over white-noise width", "Remark"), rows


def other_intervals_table(saved: SavedUncertainty) -> Rows:
    """The Laplace interval beside those found in other ways; no rows where none was asked for."""
    there = saved.ways()
    rows = []
    for label, one in saved.parameters.items():
        if found := one.ways():
            rows.append((label, interval(*one.laplace), *(interval(*found[way]) if way in found else "" for way in there)))
    return ("Parameter", "Laplace", *(INTERVAL_METHODS[way] for way in there)), rows
