"""Records of a campaign gathered into a study: decays, seas, bands."""

from collections.abc import Sequence
from dataclasses import replace

import jax.numpy as jnp
import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest_sections import IN_WAVES
from calibration.campaign.records import Record
from calibration.campaign.runs import Run
from calibration.discovery.frequency_bands import Bands, FourierRows, band_powers, cut_into_bands, step_of
from calibration.discovery.linearisations import RELATIVE_FLOOR, MotionSeries
from calibration.discovery.residuals import SeaRecord
from calibration.discovery.study import Study
from calibration.fitting.decay_fit import STEPS_PER_PERIOD
from calibration.parameters.space import ParameterSpace
from calibration.residuals.decays import DecayProblem, crossing_period, gather_decays
from calibration.residuals.moving_channels import moving_channels
from calibration.residuals.padded_sizes import padded_size
from calibration.residuals.run_seas import sea_step, seas_of
from calibration.residuals.run_segments import samples_after_transient
from calibration.residuals.wave_options import Options
from jaxhydro.dynamics.integrate import clock
from jaxhydro.dynamics.irregular_simulation import excursion_of
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.statics import equilibrium, natural_modes
from jaxhydro.dynamics.time_steps import memory_step
from jaxhydro.environment import DOFS
from jaxhydro.waves.irregular import fourier_length
from jaxhydro.waves.irregular_sea import IrregularSea

BAND_COUNT = 14  # frequency bands of a record
EXCURSION_FACTOR = 1.5  # times the model's excursion, over which a sea is prepared
MIN_EXCURSION = 1.7  # lengths of the shortest wave, over which a sea is prepared at least
MAX_OFFSET_SHARE = 0.02  # of a decay's standard deviation: offset of a sensor's zero, beside noise
TAPERED_SHARE = 0.1  # of a test in waves, both ends together
MIN_FIRST_ORDER_SHARE = 0.01  # of a sea's variance: slower components are not first order
MAX_FREQUENCY_RATIO = 6.0  # times the highest natural frequency, up to which motions are compared


def study_of(
    model: Model,
    space: ParameterSpace,
    names: Sequence[str],
    directions: np.ndarray,
    campaign: Campaign,
    options: Options,
    width: int,
) -> Study:
    """Gather a campaign's records into a study.

    Args:
        model: The model, every candidate at its neutral value.
        space: All parameters.
        names: Names of the directions.
        directions: The directions (d, p).
        campaign: The campaign.
        options: How seas are reconstructed.
        width: Number of directions that are differentiated at a time.

    Raises:
        InputError: If records cannot be used.
    """
    records = [r for r in campaign.records if r.use in ("fit", "holdout")]
    decaying = tuple(r for r in records if r.kind == "decay")
    waving = {r.id for r in records if r.kind in IN_WAVES}
    highest = highest_frequency(model)
    from_rest = campaign.manifest.zero is not None
    series: list[MotionSeries] = []
    cuts: list[FourierRows] = []
    decays, own_width = None, np.zeros((0, 0))
    if decaying:
        shortest = min([MAX_FREQUENCY_RATIO / highest, *(crossing_period(r) for r in decaying)])
        step = min(shortest / STEPS_PER_PERIOD, memory_step(model))
        decays, new_series, own_width, rows = gather_decay_series(decaying, model, space, from_rest, step, highest)
        series += new_series
        cuts.append(rows)
    seas: list[SeaRecord] = []
    notes: list[str] = []
    order_hint = ""
    if waving:
        step = sea_step(model, options)
        for run, made in seas_of(campaign, model.environment, options):
            order_hint = order_hint or made.order_hint
            tests = [r for r in run.records if r.id in waving]
            if not tests:
                continue
            sea = _sea_record(run, made.sea, tests, model, space, from_rest, step)
            new_series, rows = gather_sea(sea, tests, highest)
            series += new_series
            cuts.append(rows)
            seas.append(sea)
            notes += [*run.notes, *made.notes]
    return Study(
        space,
        model,
        tuple(names),
        directions,
        min(width, len(names)),
        decays,
        tuple(seas),
        tuple(series),
        decaying,
        own_width,
        tuple(cuts),
        options,
        (0, 0) if decays is None else (padded_size(decays.data.time.shape[1]), decays.data.capacity),
        tuple(notes),
        order_hint,
    )


def highest_frequency(model: Model) -> float:
    """Highest frequency (Hz) of a model's motion that is compared."""
    periods = natural_modes(model).period
    return MAX_FREQUENCY_RATIO / float(periods.min()) if len(periods) else 1.0


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


def _sea_record(
    run: Run,
    made: IrregularSea,
    tests: Sequence[Record],
    model: Model,
    space: ParameterSpace,
    from_rest: bool,
    step: float,
) -> SeaRecord:
    """The tests of one run, and its sea for as long as they last."""
    times = run.time[: 1 + max(int(run.samples(r)[-1]) for r in tests)]
    period = float(made.components.period)
    dt = period / fourier_length(period / step)
    count = int(np.ceil((times[-1] - times[0]) / dt - 1e-9))
    instants = clock("ab4", float(times[0]), dt, count)
    hull, computed = (model.hull.extremities(), model.cylinders), (model.transfer, model.excitation)
    # a gauge that stood elsewhere shifts the waves, whatever the size of the hull
    shortest = 2 * np.pi * float(model.environment.gravity) / float(np.max(np.asarray(made.components.omega))) ** 2
    sea = made.prepared(*hull, instants, max(EXCURSION_FACTOR * excursion_of(model), MIN_EXCURSION * shortest), *computed)
    channels = [dof for dof in DOFS if all(dof in r.values for r in tests)]
    windows = [samples_after_transient(run, r) for r in tests]
    n = min(len(w) for w in windows)
    power = np.asarray(made.components.amplitude) ** 2
    order = np.argsort(np.asarray(made.components.omega))
    first = order[np.searchsorted(np.cumsum(power[order]), MIN_FIRST_ORDER_SHARE * power.sum())]
    slow = float(np.asarray(made.components.omega)[first]) / (2 * np.pi)
    fitted = [w[n - 1] for r, w in zip(tests, windows) if r.use == "fit"]
    last = int(np.ceil((times[max(fitted)] - times[0]) / dt - 1e-9)) if fitted else 0
    measured = [[np.interp(w[:n], run.samples(r), r.values[c]) for c in channels] for r, w in zip(tests, windows)]
    return SeaRecord(
        model,
        sea,
        jnp.asarray(times),
        jnp.asarray(dt),
        jnp.asarray(np.array(measured)),
        space,
        from_rest,
        count,
        last,
        tuple(int(w[0]) for w in windows),
        tuple(DOFS.index(c) for c in channels),
        tuple(r.id for r in tests),
        slow,
    )
