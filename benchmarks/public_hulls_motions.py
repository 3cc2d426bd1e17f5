"""Decays and one sea of a public hull, with the natural periods and the linear theory that they are compared with.

Standard deviations are those at the frequencies of the waves, `BAND`: below them a hull without linear damping in surge still
rings from the start, and slow drift acts. Linear theory is a solution in frequency of mass, added mass, damping, stiffness and
wave forces, for the components of the same sea. Where a hull has tables, added mass, damping and forces are the tables' own
numbers. Elsewhere the force is that on the held hull in regular waves of next to no height. Drag is linearised for its damping:
the mean slope of the force with velocity, in the sea and at the velocities of the linear motion. Its wave force is left out.
"""

import dataclasses
import math
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Complex, Float

import jaxhydro as jh
from benchmarks.public_hulls_cases import Case
from jaxhydro.dynamics.requested_sea import RequestedSea
from jaxhydro.dynamics.response import decay_cycles
from jaxhydro.dynamics.sea_of_request import build_sea
from jaxhydro.dynamics.statics import linearised
from jaxhydro.dynamics.time_steps import largest_step
from jaxhydro.interop.radiation_coefficients import RadiationCoefficients
from jaxhydro.loads import ComputedExcitation, DriftTransfer

HS, TP, DURATION, TRANSIENT, INTERVAL = 3.0, 10.0, 3600.0, 900.0, 0.1  # m, s, s, s, s: the sea, and its samples
BAND = (0.05, 0.3)  # Hz
DECAY = 600.0  # s
HALF_CYCLES = 6  # of a decay, of which the mean is taken
MIN_HALF_CYCLES = 2  # of a decay that has a period
HEIGHT = 1e-4  # m, of the waves that tell the force on a held hull
FREQUENCIES = 80  # of that force
SAMPLES, LINEARISATIONS = 150, 12  # times at which slopes are taken, and steps to the damping
SHOWN = ("surge", "heave", "pitch")


class Linear(NamedTuple):
    """Linear equation of motion about rest.

    Attributes:
        mass: Mass with added mass of infinite frequency (kg, kg m, kg m2), (6, 6).
        stiffness: Stiffness (N/m, N, N m), (6, 6).
        damping: Damping that is linear or linearised (N s/m, N s, N m s), (6, 6).
        omega: Frequencies (rad/s) of memory and force, (n,).
        memory: Radiation damping and i omega times the added mass beyond that of infinite frequency, (n, 6, 6).
        force: Wave force by amplitude (N/m, N m/m), (6, n).
    """

    mass: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    omega: Float[np.ndarray, " n"]
    memory: Complex[np.ndarray, "n 6 6"]
    force: Complex[np.ndarray, "6 n"]

    def response(self, omega: Float[np.ndarray, " k"]) -> Complex[np.ndarray, "6 k"]:
        """Motions by wave amplitude (m/m, rad/m) at frequencies (rad/s)."""
        motions = np.zeros((6, len(omega)), complex)
        for k, w in enumerate(omega):
            memory = [[np.interp(w, self.omega, self.memory[:, i, j]) for j in range(6)] for i in range(6)]
            force = [np.interp(w, self.omega, row) for row in self.force]
            motions[:, k] = np.linalg.solve(-(w**2) * self.mass + 1j * w * (self.damping + memory) + self.stiffness, force)
        return motions


def linear_equation(model: jh.Model, radiation: RadiationCoefficients | None) -> Linear:
    """Linear equation of motion of a hull.

    Args:
        model: The hull.
        radiation: Coefficients of its table, or None.
    """
    rest = jh.equilibrium(model)
    mass, stiffness = (np.asarray(matrix) for matrix in linearised(model, rest))
    omega = 2 * math.pi * np.linspace(0.5 * BAND[0], 1.1 * BAND[1], FREQUENCIES)
    memory = np.zeros((FREQUENCIES, 6, 6), complex)
    if radiation is not None:
        infinite = np.zeros((6, 6)) if radiation.infinite is None else radiation.infinite
        for k, w in enumerate(omega):
            for i, j in np.ndindex(6, 6):
                added, damped = (
                    np.interp(w, radiation.omega, table[:, i, j]) for table in (radiation.added_mass, radiation.damping)
                )
                memory[k, i, j] = damped + 1j * w * (added - infinite[i, j])
    return Linear(mass, stiffness, np.zeros((6, 6)), omega, memory, wave_force(model, rest, omega))


def linear_motion(
    model: jh.Model, radiation: RadiationCoefficients | None, sea: jh.IrregularSea, times: Float[np.ndarray, " t"]
) -> Float[np.ndarray, "t 6"]:
    """Motions (m, rad) about rest by linear theory, with damping that follows from them.

    Args:
        model: The hull.
        radiation: Coefficients of its table, or None.
        sea: The sea.
        times: Times (s).

    References:
        Roberts and Spanos (2003), Random Vibration and Statistical Linearization, chapter 5: the matrix is the mean slope.
    """
    omega, amplitude, phase = (np.asarray(getattr(sea.components, key)) for key in ("omega", "amplitude", "phase"))
    wave, linear = amplitude * np.exp(1j * phase), linear_equation(model, radiation)
    rest = jh.equilibrium(model)
    dry = dataclasses.replace(
        model, loads=tuple(load for load in model.loads if not isinstance(load, ComputedExcitation | DriftTransfer))
    )

    @eqx.filter_jit
    def slope(dry: jh.Model, sea: Any, at: Any) -> Any:
        def force(velocity: Any, time: Any) -> Any:
            state = jh.State(rest, velocity, dry.rest().memory)
            return dry.sum_of_loads(dry.instant(time, state, sea), state.memory).force

        return jax.lax.map(lambda moment: jax.jacfwd(force)(moment[1], moment[0]), at).mean(axis=0)

    samples = times[:: max(1, len(times) // SAMPLES)]
    turning = np.exp(1j * np.outer(omega, samples))
    for _ in range(LINEARISATIONS):
        motion = linear.response(omega) * wave
        velocity = np.real((1j * omega * motion) @ turning).T
        mean = -np.asarray(slope(dry, sea, (jnp.asarray(samples), jnp.asarray(velocity))))
        linear = linear._replace(damping=0.5 * (linear.damping + mean))  # half a step, as more damping is less motion
    return np.real((linear.response(omega) * wave) @ np.exp(1j * np.outer(omega, times))).T


def wave_force(model: jh.Model, rest: Any, omega: Float[np.ndarray, " n"]) -> Complex[np.ndarray, "6 n"]:
    """Wave force by amplitude (N/m, N m/m): of the hull's table, or on the hull held at rest."""
    for load in model.loads:
        if isinstance(load, ComputedExcitation):
            table = load.excitation.towards(0.0) if hasattr(load.excitation, "towards") else load.excitation
            return np.array([np.interp(omega, np.asarray(table.omega), row) for row in np.asarray(table.force)])

    @eqx.filter_jit
    def held(model: jh.Model, sea: Any) -> Any:
        return model.force_at_rest(rest, sea)

    calm, force = np.asarray(model.force_at_rest(rest)), np.zeros((6, len(omega)), complex)
    for k, w in enumerate(omega):
        for phase, part in ((0.0, 1.0), (-0.5 * math.pi, 1j)):  # Re X, and Re (-i X)
            sea = jh.regular_wave(HEIGHT, 2 * math.pi / w, model.environment, phase=phase)
            force[:, k] += part * (np.asarray(held(model, sea)) - calm) / (0.5 * HEIGHT)
    return force


def in_band(motion: Float[np.ndarray, "t 6"]) -> Float[np.ndarray, "6"]:
    """Standard deviations of motions at the frequencies of `BAND`, by a Hann window."""
    window = np.hanning(len(motion))[:, None]
    frequency = np.fft.rfftfreq(len(motion), INTERVAL)
    power = np.abs(np.fft.rfft(window * (motion - motion.mean(axis=0)), axis=0)) ** 2
    inside = (frequency >= BAND[0]) & (frequency <= BAND[1])
    return np.sqrt(2 * power[inside].sum(axis=0) / (window**2).sum() / len(motion))


def decays(model: jh.Model, case: Case, step: float) -> dict[str, Any]:
    """Periods of decays in surge, heave and pitch: the mean of the first half cycles (s)."""
    times, rest = np.arange(0.0, DECAY + INTERVAL / 2, INTERVAL), np.asarray(jh.equilibrium(model))
    periods = {}
    for dof, release in case.releases.items():
        start = {dof: math.radians(release) if dof == "pitch" else release}
        motion = np.asarray(jh.free_decay(model, start, times, step=step)[dof]) - rest[jh.DOFS.index(dof)]
        cycles = decay_cycles(times, motion)
        count = len(cycles.period)
        period = float(np.mean(cycles.period[:HALF_CYCLES])) if count >= MIN_HALF_CYCLES else None
        periods[dof] = {"release": release, "half_cycles": count, "period": period}
    return periods


def in_sea(model: jh.Model, radiation: RadiationCoefficients | None, step: float | None) -> dict[str, Any]:
    """Standard deviations (m, deg) in the sea, simulated and by linear theory, with mean positions (m, deg)."""
    how: dict[str, Any] = {"gamma": None, "spectrum": "jonswap", "seed": 0, "amplitudes": "deterministic", "low": None}
    how |= {"cutoff": None, "order": 1, "stretching": "none", "heading": 0.0, "transient": None}
    asked = RequestedSea(hs=HS, tp=TP, **how)
    sea, cutoff = build_sea(model, asked, DURATION).sea, asked.band(float(model.pace))[1]
    step = step or float(largest_step(model, cutoff))
    times = np.arange(0.0, DURATION + INTERVAL / 2, INTERVAL)
    late = times >= TRANSIENT
    moved = np.asarray(jh.free_decay(model, {"heave": 0.0}, times, sea=sea, step=step).position)[late]
    linear = linear_motion(model, radiation, sea, times[late])
    unit = np.array([1.0, 1.0, 1.0, *3 * [math.degrees(1.0)]])
    values = {"simulated": in_band(moved) * unit, "linear": in_band(linear) * unit, "mean": moved.mean(axis=0) * unit}
    values["all"] = moved.std(axis=0) * unit
    shown = {key: {dof: float(row[jh.DOFS.index(dof)]) for dof in SHOWN} for key, row in values.items()}
    return shown | {"cutoff": cutoff, "step": step}


def motions(model: jh.Model, radiation: RadiationCoefficients | None, case: Case) -> dict[str, Any]:
    """Decays and the sea of a hull.

    Args:
        model: The hull.
        radiation: Coefficients of its table, or None.
        case: The hull's case.
    """
    sea = in_sea(model, radiation, case.step) if case.waves else None
    step = case.step or float(largest_step(model, 0.3))
    return {"decays": decays(model, case, step), "sea": sea}
