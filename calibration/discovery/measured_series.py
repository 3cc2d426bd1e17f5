"""Measured motions of decays and runs in waves as series: their frequency bands, noise floors and rows."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from calibration.campaign.records import Record
from calibration.discovery.frequency_bands import Bands, FourierRows, band_powers, cut_into_bands, step_of
from calibration.discovery.linearisations import RELATIVE_FLOOR, MotionSeries
from calibration.discovery.residual_slopes import SeaRecord
from calibration.parameters.space import ParameterSpace
from calibration.residuals.decays import DecayProblem, gather_decays
from calibration.residuals.moving_channels import moving_channels
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.statics import equilibrium
from jaxhydro.environment import DOFS

BAND_COUNT = 14  # frequency bands of a record
MAX_OFFSET_SHARE = 0.02  # of a decay's standard deviation: offset of a sensor's zero, beside noise
TAPERED_SHARE = 0.1  # of a test in waves, both ends together


def gather_decay_series(
    records: Sequence[Record], model: Model, space: ParameterSpace, from_rest: bool, step: float, highest: float
) -> tuple[DecayProblem, list[MotionSeries], np.ndarray, FourierRows]:
    """Decays in arrays, with their series and rows.

    Args:
        records: The decays.
        model: The model.
        space: All parameters.
        from_rest: Whether motions count from the static equilibrium.
        step: Largest time step (s).
        highest: Highest frequency (Hz).

    Returns:
        The problem, series, standard deviations of the decays' own unknowns (r, o), and rows.
    """
    data = gather_decays(records, model, step, exact=True)
    decays = DecayProblem(model, space, data, from_rest, None if from_rest else equilibrium(model))
    pairs, own_width = _decay_series(records, data, highest)
    return decays, [series for series, _ in pairs], own_width, FourierRows.of([cut for _, cut in pairs], data.time.shape[1])


def gather_sea(sea: SeaRecord, records: Sequence[Record], highest: float) -> tuple[list[MotionSeries], FourierRows]:
    """Series and rows of all tests of a run in waves, up to `highest` (Hz).

    A motion that is small beside others of its unit has no degrees of freedom. Otherwise a model that sways too much in head
    waves would be damped until it does not, and surge with it.
    """
    measured, step = np.asarray(sea.measured), float(sea.times[1] - sea.times[0])
    n = measured.shape[-1]
    cut = cut_into_bands(n * step, step, n, BAND_COUNT, highest)
    names = [DOFS[dof] for dof in sea.dofs]
    turns = np.array(sea.dofs) >= 3
    series = []
    for record, rows in zip(records, measured):
        motions, moves = (
            np.stack([band_powers(cut, values, TAPERED_SHARE) for values in rows]),
            moving_channels(dict(zip(names, rows))),
        )
        for name, values, turn in zip(names, rows, turns):
            # sway is no more to be followed than to what surge is
            motion = _series(record, name, values, cut, motions[turns == turn].max(axis=0), sea.slow)
            series.append(motion if name in moves else replace(motion, dof=0 * motion.dof))
    return series, FourierRows.of([cut] * len(series), n, TAPERED_SHARE)


def _series(
    record: Record, channel: str, values: np.ndarray, cut: Bands, motion: np.ndarray, slow: float = 0.0
) -> MotionSeries:
    """Series of one motion of a test, with its floor.

    Args:
        record: Record of the test.
        channel: The motion.
        values: Measured values (m, rad; t,).
        cut: Frequency bands.
        motion: Mean square by band (b,) of the motion that the test is about, in the channel's unit.
        slow: Frequency (Hz) below which bands are one pool.
    """
    noise, spread = record.noise[channel], float(np.std(values))
    floor = np.sqrt(noise**2 + RELATIVE_FLOOR[record.kind] ** 2 * motion)
    return MotionSeries(
        record.id, record.kind, record.use, channel, noise, spread, 2 * cut.lines, cut.low, cut.high, len(values), floor, slow
    )


def _decay_series(records: Sequence[Record], data, highest: float) -> tuple[list[tuple[MotionSeries, Bands]], np.ndarray]:
    """Series of every decay, and standard deviations of the decays' own unknowns."""
    series = []
    width = np.full((len(records), 3, len(data.dofs)), np.inf)
    for i, record in enumerate(records):
        n, dt = len(record.time), step_of(record.time)
        cut = cut_into_bands(n * dt, dt, data.time.shape[1], BAND_COUNT, highest)
        main = data.dofs.index(DOFS.index(record.degree_of_freedom))
        motion = band_powers(cut, np.asarray(data.measured[i, main])) / float(data.unit[i, main]) ** 2
        for j, dof in enumerate(data.dofs):
            channel = DOFS[dof]
            if channel in record.values:
                channel_series = _series(record, channel, record.values[channel], cut, motion * float(data.unit[i, j]) ** 2)
                series.append((channel_series, cut))
            else:  # a row of nothing keeps the arrays' shape
                nothing = cut._replace(member=np.zeros_like(cut.member))
                none = np.ones(BAND_COUNT)
                channel_series = MotionSeries(
                    record.id, record.kind, record.use, channel, 1.0, 1.0, 0 * none, cut.low, cut.high, n, none
                )
                series.append((channel_series, nothing))
            width[i, 2, j] = (MAX_OFFSET_SHARE * channel_series.spread + 3 * channel_series.noise / np.sqrt(n)) / float(
                data.unit[i, j]
            )
    return series, width.reshape(len(records), -1)
