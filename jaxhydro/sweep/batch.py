"""Simulation of the runs of a sweep, one after the other or several at once."""

import math
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Complex, Float

from jaxhydro.calibrated_model import UsedCalibration, with_calibration
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.requested_sea import RequestedSea
from jaxhydro.dynamics.sea_of_request import build_sea
from jaxhydro.dynamics.simulate import simulate
from jaxhydro.dynamics.statics import EquilibriumError
from jaxhydro.dynamics.time_steps import largest_step
from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError, Problem
from jaxhydro.loads import AbstractLines
from jaxhydro.platform.build import model_of
from jaxhydro.platform.schema import load_platform
from jaxhydro.rotations import rotation
from jaxhydro.sweep.at_once import shared_preparation, simulate_in_halves
from jaxhydro.sweep.cases import Plan, Run
from jaxhydro.sweep.run_statistics import RunResults, run_results
from jaxhydro.units import for_people
from jaxhydro.waves.irregular_sea import IrregularSea
from jaxhydro.waves.sea_state import state_of
from jaxhydro.waves.support_sea import SupportSea

PLATFORM, CALIBRATION, PLAN = "platform.yaml", "calibration.json", "plan.json"  # in a sweep's folder of inputs


class Setup(NamedTuple):
    """Model and options that all runs of a sweep share.

    Attributes:
        plan: Cases, seeds and options of the sweep.
        model: The platform.
        times: Times of the records (s), (t,).
        limit: Largest time step (s).
        calibrated: Part of a calibration that is used, or None.
    """

    plan: Plan
    model: Model
    times: Float[np.ndarray, " t"]
    limit: float
    calibrated: UsedCalibration | None

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the recorded channels: the wave, the motions asked for, and mooring lines."""
        return "wave", *self.plan.motions, *(f"line{i + 1}" for i in range(_line_count(self.model)))


def setup_of(plan: Plan, platform: str | Path, calibration: Path | None) -> Setup:
    """Setup from a plan, a platform's name or file, and a calibration's file.

    Raises:
        InputError: A file has mistakes, or a table was computed for waves of another heading.
        EquilibriumError: The platform has no static equilibrium.
    """
    description = load_platform(platform)
    for heading in sorted(set().union(*(case.towards for case in plan.cases))):
        if (mismatch := description.of_other_waves(heading)) is not None:
            expected = f"{heading:g} deg, as in the sweep's headings"
            raise InputError(str(platform), [Problem(mismatch.key, expected, f"{mismatch.words} deg")])
    model = model_of(description, plan.diffraction)
    used = None
    if calibration is not None:
        model, used = with_calibration(model, str(platform), description.name, calibration)
    times = plan.time_step * np.arange(math.floor(plan.duration / plan.time_step * (1 + 1e-12)) + 1)
    limit = largest_step(model, plan.cutoff) if plan.step is None else plan.step
    return Setup(plan, model, times, limit, used)


def pace_of_platform(platform: str | Path) -> float:
    """Time scale (-) of a platform relative to VolturnUS-S (`jaxhydro.scales`).

    Args:
        platform: Name or file of the platform.

    Raises:
        InputError: The file has mistakes.
    """
    return float(model_of(load_platform(platform)).pace)


def setup_in(inputs: Path) -> Setup:
    """Setup from a sweep's folder of inputs, cached while that is unchanged."""
    return _setup_in(inputs, (inputs / PLAN).stat().st_mtime_ns)


def plan_in(inputs: Path) -> Plan:
    """Plan from a sweep's folder of inputs."""
    return Plan.from_json((inputs / PLAN).read_text(encoding="utf-8"))


@lru_cache(maxsize=2)
def _setup_in(inputs: Path, stamp: int) -> Setup:
    calibration, plan = inputs / CALIBRATION, plan_in(inputs)
    return setup_of(plan, inputs / PLATFORM, calibration if calibration.is_file() else None)


def sea_of(setup: Setup, run: Run) -> IrregularSea:
    """Sea of a run, as `jaxhydro simulate` makes it.

    Raises:
        InputError: The sea is impossible.
    """
    plan, case = setup.plan, run.case
    kind = plan.spectrum.replace("_", "-")
    how: dict[str, Any] = {"seed": run.seed, "amplitudes": plan.amplitudes, "low": plan.low, "cutoff": plan.cutoff}
    how |= {"order": plan.order, "stretching": plan.stretching, "transient": plan.start}
    systems = case.state.systems(case.heading, kind, plan.spreading)
    if len(systems) == 1 and systems[0].spreading is None:
        asked = RequestedSea(case.hs, case.tp, case.gamma, kind, heading=case.heading, **how)
    else:
        asked = RequestedSea.of_systems(systems, **how)
    return build_sea(setup.model, asked, plan.duration).sea


def run_outcome(setup: Setup, run: Run) -> RunResults | str:
    """Results of one run, or the reason why it failed."""
    try:
        sea = sea_of(setup, run)
        position = np.asarray(
            simulate(setup.model, setup.times, sea, step=setup.limit, precision=setup.plan.precision).position
        )
        return _results(setup, run, sea, position, elevation(sea, setup.times))
    except Exception as error:  # whatever it is, it is this run's, and the others go on
        return failure_reason(error)


def run_outcomes(setup: Setup, runs: Sequence[Run]) -> list[RunResults | str]:
    """Results of several runs simulated at once, for GPUs.

    They differ from those of `run_outcome` by rounding.
    """
    outcomes: dict[int, RunResults | str] = {}
    seas = {}
    for run in runs:
        try:
            sea = sea_of(setup, run)
            if sea.long_crested:
                seas[run.number] = sea
            else:  # seas of several headings share no preparation
                outcomes[run.number] = run_outcome(setup, run)
        except Exception as error:
            outcomes[run.number] = failure_reason(error)
    shared = (setup.times, setup.limit)
    motions = simulate_in_halves(setup.model, list(seas.values()), *shared, precision=setup.plan.precision)
    every = dict(zip(seas, motions))
    for run in runs:
        if (moved := every.get(run.number)) is not None:
            sea = seas[run.number]
            try:
                outcomes[run.number] = _results(setup, run, sea, moved.position, elevation(sea, setup.times, moved.bound))
            except Exception as error:
                outcomes[run.number] = failure_reason(error)
        elif run.number in seas:  # out of the box that its sea was made for, or without equilibrium
            outcomes[run.number] = run_outcome(setup, run)
    return [outcomes[run.number] for run in runs]


def prepared_for(
    model: Model, sea: IrregularSea, times: Float[np.ndarray, " t"], limit: float
) -> tuple[SupportSea, float, int]:
    """Sea prepared for the model's hull, with size (s) and number of the steps, as in `simulate`."""
    shared, step, steps = shared_preparation(model, sea, times, limit)
    return shared.of(sea.components), step, steps


def _results(setup: Setup, run: Run, sea: IrregularSea, position: np.ndarray, wave: np.ndarray) -> RunResults:
    plan, times = setup.plan, setup.times
    if not (numbers := np.isfinite(position).all(axis=1)).all():
        raise ValueError(f"the motion grows beyond all bounds at {times[np.argmin(numbers)]:.4g} s: a smaller step, perhaps")
    channels = {"wave": wave} | {dof: for_people(dof, position[:, DOFS.index(dof)]) for dof in plan.motions}
    if _line_count(setup.model):
        model = setup.model.in_sea(state_of(sea.components))
        tension = np.asarray(_tensions(model, jnp.asarray(position)))
        channels |= {f"line{i + 1}": column for i, column in enumerate(tension.T)}
    results = run_results(times, plan.start, channels, run.case.state.peak_period, plan.exponents, plan.equivalent_frequency)
    return results if plan.time_series else results._replace(series=None)


def elevation(
    sea: IrregularSea, times: Float[np.ndarray, " t"], bound: Complex[np.ndarray, " b"] | None = None
) -> Float[np.ndarray, " t"]:
    """Wave elevation at the origin (m) at even times from 0 on, (t,).

    It is `IrregularSea.gauge`, by one Fourier transform where the times divide the period.

    Args:
        sea: The sea.
        times: Times (s), (t,).
        bound: Its `elevation_spectrum` (m), where known.
    """
    waves, step = sea.components, float(times[1] - times[0])
    period, (first, last) = float(waves.period), waves.harmonics
    count = round(period / step)
    if abs(count * step - period) > 1e-9 * period or count <= 4 * last:
        return sea.gauge(times)
    spectrum = np.zeros(count // 2 + 1, complex)
    spectrum[first : last + 1] = np.asarray(waves.complex_amplitude())
    if sea.order == 2:
        bound = np.asarray(sea.bound_elevation()) if bound is None else bound
        spectrum[: len(bound)] += bound
    spectrum[0] *= 2
    return np.resize(np.fft.irfft(spectrum, count) * (count / 2), len(times))


def _lines(model: Model) -> AbstractLines | None:
    return next((load for load in model.loads if isinstance(load, AbstractLines)), None)


def _line_count(model: Model) -> int:
    lines = _lines(model)
    return 0 if lines is None else lines.anchor.shape[1]


@eqx.filter_jit
def _tensions(model: Model, position: Float[Array, "t 6"]) -> Float[Array, "t l"]:
    """Tension of each mooring line (N) at every sample, (t, l)."""
    lines = _lines(model)
    assert lines is not None
    return jax.vmap(lambda q: lines.tension(q, rotation(q[3:]))[0])(position)


def failure_reason(error: Exception) -> str:
    """Reason why a run failed, in one line."""
    if isinstance(error, InputError):
        return "; ".join(f"expected {problem.expected}, found {problem.found}" for problem in error.problems)
    expected = isinstance(error, ValueError | EquilibriumError)
    message = " ".join(str(error).split())[:500]
    return message if expected and message else f"{type(error).__name__}: {message}"
