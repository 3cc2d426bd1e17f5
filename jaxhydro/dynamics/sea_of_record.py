"""First-order waves of the record that a `RequestedSea` names, of one gauge or two."""

import math
from typing import Any

import numpy as np

from jaxhydro.analysis.sea_statistics import record_peak_period
from jaxhydro.dynamics.irregular_simulation import MAX_PAIRS, too_many_pairs
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.requested_sea import Record, RequestedSea, SecondGauge
from jaxhydro.errors import InputError, Problem
from jaxhydro.waves.components import Components
from jaxhydro.waves.irregular_sea import IrregularSea
from jaxhydro.waves.recorded_waves import separated_record
from jaxhydro.waves.two_gauges import IncidentAndReflected, incident_and_reflected
from jaxhydro.waves.wave_errors import BandError, GaugeSpacingError

MAX_RECORD_MISMATCH = 0.01  # of a record in the band, that first and second order may miss by root mean square
NOTED_SHARE = 0.95  # share of a spectrum's or a record's variance in the sea, below which a note says so


def from_record(model: Model, asked: RequestedSea, record: Record, notes: list[str]) -> tuple[Components, dict[str, Any]]:
    """First-order waves of a record, and their description.

    Args:
        model: The platform.
        asked: The request.
        record: Its record.
        notes: Notes on the sea, to which those on the record are added.

    Raises:
        InputError: The record has no sea that can be simulated; the option or the column is named.
    """
    low, cutoff = asked.band(float(model.pace))
    how: dict[str, Any] = {"heading": math.radians(asked.heading), "low": low, "cutoff": cutoff, "order": asked.order}
    second: dict[str, Any] = {}
    try:
        if record.second is None:
            given = record.times, record.elevation, model.environment
            waves, mismatch, _ = separated_record(*given, position=record.position, **how)
        else:
            separated = _of_two_gauges(model, record, record.second, how)
            waves, mismatch = separated.waves, separated.mismatch
            second = _about_reflection(record, record.second, separated, asked.order, notes)
    except GaugeSpacingError as error:
        raise InputError("--second-wave-position", [Problem("", error.expected, error.found)]) from None
    except ValueError as error:
        columns = record.column if record.second is None else f"{record.column} or {record.second.column}"
        option = "--cutoff" if isinstance(error, BandError) else f"{record.source}: column {columns}"
        raise impossible(option, error) from None
    if mismatch > MAX_RECORD_MISMATCH:
        missed = f"first and second order miss {mismatch:.1%} of the record in the band, and the nearest found is used"
        notes.append(f"{missed}: a --cutoff below {cutoff:g}, or --order 1, follows it")
    step = float(record.times[-1] - record.times[0]) / (len(record.times) - 1)
    return waves, {
        "record": record.source,
        "record_column": record.column,
        "wave_position": list(record.position),
        "significant_wave_height": 4 * float(np.std(record.elevation)),
        "peak_period": record_peak_period(record.elevation, step, low, cutoff),
        "mismatch": mismatch,
        **second,
    }


def _of_two_gauges(model: Model, record: Record, second: SecondGauge, how: dict[str, Any]) -> IncidentAndReflected:
    elevations, positions = (record.elevation, second.elevation), (record.position, second.position)

    def separated(order: int) -> IncidentAndReflected:
        return incident_and_reflected(
            record.times, elevations, model.environment, positions=positions, **(how | {"order": order})
        )

    linear = separated(1)
    if how["order"] == 1:
        return linear
    if (count := linear.waves.omega.size) ** 2 > MAX_PAIRS:
        raise InputError("--order", [Problem("", "1 with two wave gauges", f"2 ({too_many_pairs(count)})")])
    return separated(2)


def _about_reflection(
    record: Record, second: SecondGauge, separated: IncidentAndReflected, order: int, notes: list[str]
) -> dict[str, Any]:
    """Description of incident and reflected waves; the notes get what limits them."""
    low, high = separated.band
    incident, reflected = separated.significant_heights
    if separated.share_outside > 1 - NOTED_SHARE:
        notes.append(
            f"{separated.share_outside:.1%} of the waves' energy lies outside {low:.3g} to {high:.3g} Hz, where these gauges "
            "separate incident from reflected waves. Outside, reflected waves are uncertain and may be taken for incident ones"
        )
    if order == 1:
        notes.append(
            "with two wave gauges first order is the default: records are taken as linear. --order 2 takes up to 50 frequencies"
        )
    return {
        "second_wave_column": second.column,
        "second_wave_position": list(second.position),
        "incident_significant_wave_height": incident,
        "reflected_significant_wave_height": reflected,
        "reflection_coefficient": separated.reflection_coefficient,
        "separated_band": [low, high],
        "share_outside_separated_band": separated.share_outside,
    }


def add_shares(sea: IrregularSea, record: Record, about: dict[str, Any], notes: list[str]) -> None:
    """Add the fraction of each gauge's variance that the sea has to its description, and a note where it is small.

    Args:
        sea: The sea of the record.
        record: The record.
        about: The description.
        notes: The notes.
    """

    def share(elevation: np.ndarray, position: tuple[float, float]) -> float:
        residual = elevation - elevation.mean() - sea.gauge(record.times, position)
        return 1 - float(np.var(residual) / np.var(elevation))

    about["share_of_record"] = share(record.elevation, record.position)
    if about["share_of_record"] < NOTED_SHARE:
        notes.append(f"the sea has {about['share_of_record']:.1%} of the record's variance: see --low and --cutoff")
    if record.second is not None:
        about["share_of_second_record"] = share(record.second.elevation, record.second.position)
        if about["share_of_second_record"] < NOTED_SHARE:
            notes.append(f"the sea has {about['share_of_second_record']:.1%} of the second gauge's variance")


def impossible(option: str, error: ValueError) -> InputError:
    """Error of an option or a file that asks for a sea that cannot be simulated."""
    return InputError(option, [Problem("", "a sea that can be simulated", f"none ({error})")])
