"""The study of a campaign: its decays and seas, prepared for a model and parameters."""

from collections.abc import Sequence

import jax.numpy as jnp
import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest_sections import IN_WAVES
from calibration.campaign.records import Record
from calibration.campaign.runs import Run
from calibration.discovery.frequency_bands import FourierRows
from calibration.discovery.linearisations import MotionSeries
from calibration.discovery.measured_series import gather_decay_series, gather_sea
from calibration.discovery.residual_slopes import SeaRecord
from calibration.discovery.study import Study
from calibration.fitting.decay_fit import STEPS_PER_PERIOD
from calibration.parameters.space import ParameterSpace
from calibration.residuals.decays import crossing_period
from calibration.residuals.padded_sizes import padded_size
from calibration.residuals.run_seas import sea_step, seas_of
from calibration.residuals.run_segments import samples_after_transient
from calibration.residuals.wave_options import Options
from jaxhydro.dynamics.integrate import clock
from jaxhydro.dynamics.irregular_simulation import excursion_of
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.statics import natural_modes
from jaxhydro.dynamics.time_steps import memory_step
from jaxhydro.environment import DOFS
from jaxhydro.waves.irregular import fourier_length
from jaxhydro.waves.irregular_sea import IrregularSea

EXCURSION_FACTOR = 1.5  # times the model's excursion, over which a sea is prepared
MIN_EXCURSION = 1.7  # lengths of the shortest wave, over which a sea is prepared at least
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
