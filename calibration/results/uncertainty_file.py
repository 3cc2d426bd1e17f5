"""Model of uncertainty.json, and its tables."""

from typing import Annotated, NamedTuple

from pydantic import Field

from calibration.formatting import bracketed, counted, interval, listed, number, percent_span, readable_unit, to_width
from calibration.results.calibration_file import Parameter
from calibration.results.result_folder import Figure
from calibration.vocabulary import UNDETERMINED, Rows
from jaxhydro.input_schema import Number
from jaxhydro.result_model import ResultModel

INTERVAL_METHODS = {"profile": "Profile", "blocks": "Bootstrap, blocks", "repeats": "Bootstrap, repeats", "nuts": "NUTS"}
Interval = tuple[Number | None, Number | None]


class ParameterIntervals(Parameter):
    """A calibrated parameter and its intervals; an end is None where the interval is open.

    Attributes:
        laplace: Interval of the covariance, with coloured errors.
        white: The same as if errors were white.
        white_too_small_by: Width of `laplace` over that of `white`.
        profile: Interval of the profile likelihood.
        blocks: Interval of a bootstrap over blocks of the residuals.
        repeats: Interval of a bootstrap over repeated tests.
        nuts: Interval of draws from the posterior.
    """

    laplace: Interval
    white: Interval = (None, None)
    white_too_small_by: Number | None = None
    profile: Interval | None = None
    blocks: Interval | None = None
    repeats: Interval | None = None
    nuts: Interval | None = None

    def ways(self) -> dict[str, Interval]:
        """The intervals beside the Laplace interval, by way."""
        intervals: dict[str, Interval | None] = {way: getattr(self, way) for way in INTERVAL_METHODS}
        return {way: ends for way, ends in intervals.items() if ends is not None}


class ProfileCurve(ResultModel):
    """Profile likelihood of a parameter.

    Attributes:
        values: Values of the parameter.
        drop: Rise of -2 ln L there.
        nu: Degrees of freedom of Student's t.
    """

    values: list[Number | None]
    drop: list[Number | None]
    nu: Number | None = None


class BootstrapDraws(ResultModel):
    """A bootstrap.

    Attributes:
        asked: Number of resamplings asked for.
        draws: Number of resamplings in the intervals.
        unsettled: Number of refits that did not converge.
        groups: Length of blocks (s) by test; or repeated tests by the first of them.
    """

    asked: int | None = None
    draws: int
    unsettled: int = 0
    groups: dict[str, Number | list[str]] = Field(default_factory=dict)


class PosteriorDraws(ResultModel):
    """Draws by NUTS.

    Attributes:
        chains: Number of chains.
        draws: Number of draws of each chain.
        divergences: Number of divergent steps.
        r_hat: Convergence diagnostic, by parameter.
        effective: Effective number of draws, by parameter.
    """

    chains: int
    draws: int
    divergences: int = 0
    r_hat: dict[str, Number | None] = Field(default_factory=dict)
    effective: dict[str, Number | None] = Field(default_factory=dict)


class UncertaintyFile(ResultModel):
    """Content of uncertainty.json. Values are in the parameters' units, angles in rad.

    Attributes:
        campaign: Name of the campaign.
        platform: Name of the platform.
        jaxhydro: Version of jaxhydro.
        calibration: File of the calibration.
        level: Probability of the intervals.
        seed: Seed of the draws.
        converged: Whether the refit of the records converged.
        parameters: Intervals by label.
        profiles: Profile likelihoods by label.
        bootstrap: Bootstraps by method.
        nuts: Draws from the posterior.
        notes: What is to be known before an interval is used, as sentences.
        figures: Figures.
    """

    campaign: str
    platform: str
    jaxhydro: str
    calibration: str
    level: Annotated[float, Field(strict=True, allow_inf_nan=False, gt=0, lt=1)]
    seed: int = 0
    converged: bool
    parameters: dict[str, ParameterIntervals]
    profiles: dict[str, ProfileCurve] = Field(default_factory=dict)
    bootstrap: dict[str, BootstrapDraws] = Field(default_factory=dict)
    nuts: PosteriorDraws | None = None
    notes: list[str] = Field(default_factory=list)
    figures: list[Figure] = Field(default_factory=list)

    @property
    def percent(self) -> str:
        """The level as text (%)."""
        return f"{100 * self.level:.4g} %"

    def ways(self) -> list[str]:
        """The ways beside Laplace in which intervals of some parameter were found."""
        return [way for way in INTERVAL_METHODS if any(way in parameter.ways() for parameter in self.parameters.values())]


class IntervalSummary(NamedTuple):
    """Content of the sentence on intervals.

    Attributes:
        converged: Whether the fit converged.
        level: Probability of the intervals (%), as text.
        half_widths: Half width over the value, by coefficient.
        undetermined: Coefficients without an interval.
    """

    converged: bool
    level: str
    half_widths: dict[str, float]
    undetermined: tuple[str, ...]


def summary_of(saved: UncertaintyFile) -> IntervalSummary:
    """Summary of the Laplace intervals."""
    widths = {}
    for label, parameter in saved.parameters.items():
        low, high = parameter.laplace
        if parameter.identifiable and not parameter.at_bound and low is not None and high is not None and parameter.value:
            widths[label] = 0.5 * (high - low) / abs(parameter.value)
    rest = tuple(label for label in saved.parameters if label not in widths)
    return IntervalSummary(saved.converged, saved.percent, widths, rest)


def interval_sentence(summary: IntervalSummary) -> str:
    """The intervals in one sentence.

    "All 11 coefficients known to 0.03-10 % (95 % intervals), the least well pontoon.Cd_t."
    """
    widths = {label: width for label, width in summary.half_widths.items() if width <= 1}
    wide, rest = [label for label in summary.half_widths if label not in widths], summary.undetermined
    total = len(summary.half_widths) + len(rest)
    sentence = "" if summary.converged else "The fit did not converge. "
    if not widths:
        return f"{sentence}None of {counted(total, 'coefficient')} has a {summary.level} interval that says anything."
    many = f"All {total} coefficients" if len(widths) == total > 1 else f"{len(widths)} of {counted(total, 'coefficient')}"
    sentence += f"{many} known to {percent_span(list(widths.values()))} ({summary.level} intervals)"
    sentence += f", the least well {max(widths, key=lambda label: widths[label])}" if len(widths) > 1 else ""
    sentence += f"; intervals wider than twice the value: {listed(wide)}" if wide else ""
    return f"{sentence}; {UNDETERMINED}: {listed(rest)}." if rest else f"{sentence}."


def intervals_table(saved: UncertaintyFile) -> Rows:
    """Value, Laplace interval, and how much too small it would be as if errors were white."""
    rows = []
    for label, parameter in saved.parameters.items():
        low, high = parameter.laplace
        value = number(parameter.value) if low is None or high is None else to_width(parameter.value, high - low)
        value = value if parameter.identifiable else bracketed(parameter.value)
        excess = "–" if parameter.white_too_small_by is None else f"{number(parameter.white_too_small_by, 2)} times"
        flag = "at its bound" if parameter.at_bound else "" if parameter.identifiable else UNDETERMINED
        rows.append((label, value, interval(low, high), readable_unit(parameter.unit), excess, flag))
    return ("Parameter", "Value", f"{saved.percent} interval", "Unit", "Width over white-noise width", "Remark"), rows


def other_intervals_table(saved: UncertaintyFile) -> Rows:
    """The Laplace interval beside those found in other ways; no rows where none was asked for."""
    ways = saved.ways()
    rows = []
    for label, parameter in saved.parameters.items():
        if intervals := parameter.ways():
            rows.append(
                (label, interval(*parameter.laplace), *(interval(*intervals[way]) if way in intervals else "" for way in ways))
            )
    return ("Parameter", "Laplace", *(INTERVAL_METHODS[way] for way in ways)), rows
