"""Tables and verdict of `jaxhydro check`: content of the records, and whether the model fits them."""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from calibration.campaign.grouped_findings import group_findings
from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest_sections import IN_WAVES
from calibration.campaign.records import Record
from calibration.campaign.signals import dominant_period, wave_height
from calibration.formatting import counted, listed, number, signed_percent
from calibration.vocabulary import KINDS, USE, Rows
from jaxhydro.analysis.sea_statistics import record_peak_period
from jaxhydro.dynamics.natural_modes import Modes
from jaxhydro.dynamics.statics import equilibrium
from jaxhydro.units import unit_of

MAX_HEAVE = 0.02  # of the draught: a platform that rests further off is not in balance as declared
MAX_LEAN = 1.0  # deg
MAX_PERIOD_DIFFERENCE = 0.2  # of the measured period: a fit of added mass seldom mends more


class PeriodComparison(NamedTuple):
    """Natural period of one motion, measured in decays and of the model.

    Attributes:
        motion: The motion.
        tests: Number of decays with a clear period.
        measured: Their median period (s).
        model: Period of the model (s).
    """

    motion: str
    tests: int
    measured: float
    model: float

    @property
    def difference(self) -> float:
        """Model less measured period, over the measured one."""
        return self.model / self.measured - 1


def compare_periods(records: Sequence[Record], modes: Modes) -> list[PeriodComparison]:
    """Natural periods of all motions that have a decay with a clear period.

    Args:
        records: The records.
        modes: Natural modes of the model.
    """
    measured: dict[str, list[float]] = {}
    for record in records:
        if record.kind == "decay" and record.use != "ignore" and record.degree_of_freedom is not None:
            period = dominant_period(record.time, record.values[record.degree_of_freedom])
            if period is not None:
                measured.setdefault(record.degree_of_freedom, []).append(period)
    return [
        PeriodComparison(motion, len(values), float(np.median(values)), modes.of(motion)) for motion, values in measured.items()
    ]


def tests(campaign: Campaign) -> Rows:
    """Kind, use, length, step and content of every record."""
    rows = []
    for record in campaign.records:
        step = float(np.median(np.diff(record.time)))
        about = (record.id, KINDS.get(record.kind, record.kind), USE[record.use], record.file)
        rows.append((*about, _content(record, step), number(record.time[-1] - record.time[0], 4), number(step, 3)))
    return ("Test", "Kind", "Use", "File", "Content", "Length (s)", "Step (s)"), rows


def _content(record: Record, step: float) -> str:
    """Release of a decay, height and period of waves."""
    if record.kind == "decay" and record.degree_of_freedom is not None:
        unit = unit_of(record.degree_of_freedom)
        start = float(record.values[record.degree_of_freedom][0])
        return f"{record.degree_of_freedom} from {number(np.degrees(start) if unit == 'deg' else start, 3)} {unit}"
    if record.kind in IN_WAVES and record.wave is not None:
        sea = record.kind == "irregular"
        later = record.wave[record.time - record.time[0] >= record.transient]
        height, period = ("Hs", "Tp") if sea else ("H", "T")
        return f"{height} {number(wave_height(later, sea), 2)} m, {period} {number(record_peak_period(later, step), 3)} s"
    return listed(list(record.values))


def periods(compared: Sequence[PeriodComparison]) -> Rows:
    """Natural periods, measured and of the model."""
    rows = [
        (
            comparison.motion,
            str(comparison.tests),
            number(comparison.measured, 3),
            number(comparison.model, 3),
            signed_percent(comparison.difference),
        )
        for comparison in compared
    ]
    return ("Motion", "Decays", "Measured (s)", "Model (s)", "Difference"), rows


def doubts(campaign: Campaign, compared: Sequence[PeriodComparison]) -> Iterator[str]:
    """What to look at before a fit, in sentences."""
    warnings = len(group_findings(campaign.findings))
    if warnings:
        yield f"{counted(warnings, 'warning')} above"
    yield from _at_rest(campaign)
    for comparison in compared:
        if math.isnan(comparison.model):
            yield f"{comparison.motion}: the model has no natural period in it, measured {number(comparison.measured, 3)} s"
        elif abs(comparison.difference) > MAX_PERIOD_DIFFERENCE:
            yield (
                f"{comparison.motion}: the model's natural period is {number(comparison.model, 3)} s, measured "
                f"{number(comparison.measured, 3)} s (mass, mooring, unit or `scale`)"
            )


def _at_rest(campaign: Campaign) -> Iterator[str]:
    """Whether the declared platform rests where it is declared."""
    model = campaign.model
    rest = np.asarray(equilibrium(model))
    draught = float(np.abs(np.asarray(model.hull.elements.start)[2]).max(initial=0.0))
    if abs(rest[2]) > MAX_HEAVE * draught > 0:
        side = "high" if rest[2] > 0 else "low"
        yield (
            f"the declared platform floats {number(abs(rest[2]), 2)} m too {side}, draught {number(draught, 3)} m "
            "(mass against displaced volume and mooring)"
        )
    for name, angle in zip(("roll", "pitch"), np.degrees(rest[3:5]), strict=True):
        if abs(angle) > MAX_LEAN:
            yield f"the declared platform rests at {number(angle, 2)} deg of {name} (centre of mass, mooring)"


def verdict(campaign: Campaign, sentences: Sequence[str]) -> str:
    """The answer in one sentence, with the `doubts` that there are."""
    read = f"{counted(len(campaign.records), 'test')} read"
    return f"{read}. Look at this first: {'; '.join(sentences)}." if sentences else f"{read}: nothing looks wrong."
