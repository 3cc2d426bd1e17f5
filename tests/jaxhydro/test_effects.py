"""Effects that a model may lack, against closed forms, energies and equations of motion written and solved anew with SciPy."""

import math
from functools import cache

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax.flatten_util import ravel_pytree
from numpy.testing import assert_allclose
from one_program import one_program
from scipy.integrate import quad, solve_ivp
from scipy.linalg import eigvals
from scipy.signal import fftconvolve
from scipy.spatial.transform import Rotation
from test_loads import BODY, COLUMN, at_rest, build, force, model_of, only, sample

import jaxhydro as jh
from jaxhydro.environment import DOFS
from jaxhydro.loads import (
    AbstractLoad,
    Buoyancy,
    CoulombFriction,
    CubicDamping,
    HiddenOscillator,
    Hysteresis,
    MassError,
    MooringNonlinearity,
    NonlinearHydrostatics,
    RadiationMemory,
    StaticForce,
    Stiffness,
    Umbilical,
    Weight,
)
from jaxhydro.quick_jit import on_device

M, C = 8e6, 9e4  # kg, N/m: a surge period of 59 s
INERTIA, TILT, LIFT = 5e9, 4e8, 3e6  # kg m2, N m/rad, N/m
KINDS = (CoulombFriction, CubicDamping, StaticForce, MooringNonlinearity, Hysteresis, RadiationMemory, HiddenOscillator)


@cache
def rig() -> jh.Model:
    """A mass on springs with all effects at their neutral value: one program for all that follows."""
    springs = dict.fromkeys(("C11", "C22"), C) | {"C33": LIFT, "C44": TILT, "C55": TILT, "C66": TILT}
    effects = (*(kind.neutral(("surge",)) for kind in KINDS), NonlinearHydrostatics.neutral())
    body = BODY | {"centre_of_mass": [0, 0, 0]}
    return model_of(build(rigid_body=body), Stiffness(springs), *effects)


TIMES = np.linspace(0.0, 240.0, 481)


def response(values: dict[str, float], **start: float) -> jh.Response:
    """The rig released from a place, at `TIMES`."""
    position = jnp.array([start.get(dof, 0.0) for dof in DOFS])
    return jh.simulate(rig().with_values(values), TIMES, position=position, step=0.05)


def motion(values: dict[str, float], **start: float) -> np.ndarray:
    """Position (m, rad) of the `response`."""
    return np.asarray(response(values, **start).position)


def solved(rate, start: list[float]) -> np.ndarray:
    """First component of an equation of motion, by another program."""
    return solve_ivp(rate, (0, TIMES[-1]), start, t_eval=TIMES, rtol=1e-9, atol=1e-10, max_step=0.5).y[0]


def wen(t: float, y: np.ndarray) -> list[float]:
    """Bouc and Wen's law as in the paper, A = 1, n = 1."""
    x, v, z = y
    return [v, (-C * x - 9e4 * z) / M, (1.0 * v - 0.5 * abs(v) * z - 0.5 * v * abs(z)) / 0.4]


def convolved(t: float, y: np.ndarray) -> list[float]:
    """Kernel exp(-zeta w0 t) (...) as the real part of one complex exponential, w0 = 0.5, zeta = 0.3, b = 4e5."""
    x, v, real, imaginary = y
    damped = 0.5 * math.sqrt(1 - 0.09)
    root, weight = complex(-0.15, damped), 4e5 * 0.3 * complex(1, 0.15 / damped)
    tail = complex(real, imaginary)
    rate = root * tail + v
    return [v, (-C * x - (weight * tail).real) / M, rate.real, rate.imag]


def two_masses(t: float, y: np.ndarray) -> list[float]:
    """Hull and 9e5 kg on a spring of period 30 s, zeta = 0.04, in absolute coordinates."""
    x, v, swinging_mass, w = y
    k, c = 9e5 * (2 * math.pi / 30) ** 2, 2 * 0.04 * 9e5 * (2 * math.pi / 30)
    pull = k * (swinging_mass - x) + c * (w - v)
    return [v, (-C * x + pull) / M, w, -pull / 9e5]


SURGE = {
    "coulomb": ({"coulomb_friction.surge.force": 5e4}, lambda t, y: [y[1], (-C * y[0] - 5e4 * np.tanh(y[1] / 0.01)) / M], 2),
    "cubic": ({"cubic_damping.surge.coefficient": 2e6}, lambda t, y: [y[1], (-C * y[0] - 2e6 * y[1] ** 3) / M], 2),
    "static": ({"static_offset.surge.force": 7e4}, lambda t, y: [y[1], (-C * y[0] + 7e4) / M], 2),
    "mooring": (
        {f"mooring_nonlinearity.surge.{k}": v for k, v in {"odd_quadratic": 5e3, "even_quadratic": -3e3, "cubic": 800}.items()},
        lambda t, y: [y[1], (-C * y[0] - 5e3 * abs(y[0]) * y[0] + 3e3 * y[0] ** 2 - 800 * y[0] ** 3) / M],
        2,
    ),
    "hysteresis": ({"hysteresis.surge.force": 9e4, "hysteresis.surge.yield_displacement": 0.4}, wen, 3),
    "radiation": (
        {f"radiation_memory.surge.{k}": v for k, v in {"strength": 4e5, "frequency": 0.5, "damping_ratio": 0.3}.items()},
        convolved,
        4,
    ),
    "oscillator": (
        {f"hidden_oscillator.surge.{k}": v for k, v in {"mass": 9e5, "period": 30.0, "damping_ratio": 0.04}.items()},
        two_masses,
        4,
    ),
}


@pytest.mark.parametrize("name", SURGE)
def test_a_free_decay_with_one_effect(name: str) -> None:
    """Released from 5 m of surge, by the simulator and by SciPy from an equation written here."""
    values, rate, states = SURGE[name]
    start = [5.0, *(0.0,) * (states - 1)]
    if name == "oscillator":
        start[2] = 5.0  # in absolute coordinates; it rests in the hull
    assert_allclose(motion(values, surge=5.0)[:, 0], solved(rate, start), atol=2e-5)


@pytest.mark.slow
def test_nulls_are_silent_and_their_derivatives_are_not() -> None:
    """At neutral values the rig is its spring alone, and the motion moves with every strength; slopes are differences."""
    assert_allclose(motion({}, surge=5.0)[:, 0], 5 * np.cos(np.sqrt(C / M) * TIMES), atol=2e-6)
    effects = [label for label in rig().values if not label.startswith("stiffness")]
    neutral = {label: jnp.zeros(()) for label in effects if rig().about(label).neutral == 0.0}
    released = {"surge": 5.0, "heave": 2.0, "roll": 0.1, "pitch": 0.2}
    start = jnp.array([released.get(dof, 0.0) for dof in DOFS])
    times = TIMES[:121]  # a cycle of surge

    def run(strengths: dict) -> jax.Array:  # unchecked: no friction is negative, but its derivative at zero has two sides
        return jh.simulate(rig().at_values(strengths), times, position=start, step=0.25).position

    slopes = jax.jacfwd(run)(neutral)
    assert len(slopes) == 17
    for label, slope in slopes.items():
        size = {"surge": 1e3, "heave": 1e3}.get(label.split(".")[1], 1e8)
        assert bool(jnp.isfinite(slope).all()) and float(jnp.abs(slope * size).max()) > 1e-6, label
    label = "coulomb_friction.surge.force"
    ends = [np.asarray(run({label: force_}))[:, 0] for force_ in (500.0, -500.0)]
    change = (ends[0] - ends[1]) / 1000
    assert_allclose(slopes[label][:, 0], change, atol=1e-2 * np.abs(change).max())


def test_dry_friction_takes_the_same_from_every_cycle() -> None:
    """4 f/C per cycle, whatever the amplitude (Den Hartog); the sign is resolved to 0.01 m/s in 0.5 m/s."""
    surge = motion({"coulomb_friction.surge.force": 2e4}, surge=5.0)[:, 0]
    inside = (surge[1:-1] > surge[:-2]) & (surge[1:-1] > surge[2:]) & (surge[1:-1] > 0)
    places = np.flatnonzero(inside) + 1
    slope, bend = surge[places + 1] - surge[places - 1], surge[places + 1] + surge[places - 1] - 2 * surge[places]
    peaks = np.array([5.0, *(surge[places] - slope**2 / (8 * bend))])  # of parabolas
    assert len(peaks) >= 4
    assert_allclose(-np.diff(peaks), 4 * 2e4 / C, rtol=5e-3)


# memories, driven


@eqx.filter_jit
def driven(load: AbstractLoad, memory, velocity: jax.Array, step: float) -> tuple[jax.Array, jax.Array]:
    """Force in surge (N) and memory under a surge velocity (m/s) given every half step, by the classical Runge-Kutta scheme."""
    model = model_of(rig(), load)

    def act(memory, v):
        state = jh.State(jnp.zeros(6), jnp.zeros(6).at[0].set(v), (memory,))
        action = load.act(model.instant(jnp.zeros(()), state, jh.StillWater()), memory)
        given = [part for part in (action.force, action.body_force) if part is not None]
        return given[0][0], action.memory_rate

    def advance(memory, v):
        out, k1 = act(memory, v[0])
        k2 = act(memory + 0.5 * step * k1, v[1])[1]
        k3 = act(memory + 0.5 * step * k2, v[1])[1]
        k4 = act(memory + step * k3, v[2])[1]
        return memory + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4), (out, memory)

    stages = jnp.stack([velocity[:-2:2], velocity[1::2], velocity[2::2]], axis=1)
    return jax.lax.scan(advance, memory, stages)[1]


def hysteresis() -> Hysteresis:
    return Hysteresis({"surge": 9e4}, {"surge": 0.4})


@pytest.mark.parametrize("amplitude", [0.05, 0.6, 4.0])
def test_energy_of_a_hysteresis_loop(amplitude: float) -> None:
    """Over x from -a to a the law integrates to z_m = 1 - exp(-(2 a/Y - z_m)) and a loss 2 f (2 a - 2 Y z_m - Y z_m^2/2); the
    same at 0.01 Hz and at 0.1 Hz."""
    share = 2 * amplitude / 0.4
    peak = 0.5
    for _ in range(200):
        peak += 0.2 * (1 - math.exp(-(share - peak)) - peak)
    expected = 2 * 9e4 * (2 * amplitude - 2 * 0.4 * peak - 0.2 * peak**2)
    points = 4000
    phase = np.pi * np.arange(4 * points + 1) / points  # two cycles from -a, where z = -z_m
    displaced = -amplitude * np.cos(phase[:-2:2])
    for frequency in (0.01, 0.1):
        velocity = jnp.asarray(2 * np.pi * frequency * amplitude * np.sin(phase))
        force_, memory = driven(hysteresis(), jnp.full(1, -peak), velocity, 1 / frequency / points)
        assert_allclose(np.abs(memory).max(), peak, rtol=1e-3)
        assert_allclose(-np.trapezoid(force_, displaced) / 2, expected, rtol=3e-3)


def test_memory_of_a_platform_held_off_its_rest() -> None:
    """`settled` is where a slow pull ends, odd, of slope 1/Y at 0; other loads are at rest, whatever the place."""
    position, settles = np.array([-0.7, 0, 0, 0, 0, 0.0]), one_program(Hysteresis.settled)
    settled = np.asarray(settles(hysteresis(), position))
    slow = jnp.full(4001, -0.7 / 2000.0)
    assert_allclose(np.asarray(driven(hysteresis(), jnp.zeros(1), slow, 1.0)[1])[-1], settled, rtol=2e-3)
    assert_allclose(settled, [-(1 - math.exp(-0.7 / 0.4))], rtol=1e-12)
    assert_allclose(settles(hysteresis(), -position), -settled, rtol=1e-12)
    slope = one_program(jax.jacfwd(lambda q: hysteresis().settled(q)))(np.zeros(6))
    assert_allclose(slope, [[1 / 0.4, 0, 0, 0, 0, 0]], rtol=1e-12)
    memory, undisturbed = jax.tree.map(np.asarray, (rig().settled(on_device(position)), rig().rest().memory))
    for load, held, unheld in zip(rig().loads, memory, undisturbed, strict=True):
        if isinstance(load, Hysteresis):
            assert held.shape == unheld.shape and (held != unheld).all()
        else:
            assert jax.tree.all(jax.tree.map(np.array_equal, held, unheld))


def test_nothing_leaks_from_a_memory_at_rest() -> None:
    """Held still for an hour, a hysteretic force stays."""
    _, memory = driven(hysteresis(), jnp.array([0.8]), jnp.zeros(4001), 1.8)
    assert_allclose(memory, 0.8, rtol=1e-14)


RADIATION = {"strength": 4e5, "frequency": 0.5, "damping_ratio": 0.3}


def radiation() -> RadiationMemory:
    return RadiationMemory(**{name: {"surge": value} for name, value in RADIATION.items()})


def kernel(t: np.ndarray) -> np.ndarray:
    """Inverse Laplace transform of b 2 zeta w0 s/(s^2 + 2 zeta w0 s + w0^2)."""
    decay, damped = 0.15, 0.5 * math.sqrt(1 - 0.09)
    return 4e5 * 0.3 * np.exp(-decay * t) * (np.cos(damped * t) - decay / damped * np.sin(damped * t))


def test_radiation_damping_and_added_mass() -> None:
    """B + i w A is the Fourier transform of the kernel: by quad, and in closed form; B is largest, and b, at w0."""
    model = model_of(rig(), radiation())

    def flow(y):  # memory and velocity -> memory's rate and force
        state = jh.State(jnp.zeros(6), jnp.zeros(6).at[0].set(y[2]), (y[:2, None],))
        action = radiation().act(model.instant(jnp.zeros(()), state, jh.StillWater()), y[:2, None])
        return jnp.concatenate([action.memory_rate[:, 0], action.body_force[:1]])

    system = np.asarray(one_program(jax.jacfwd(flow))(np.zeros(3)))
    for w in (0.05, 0.3, 0.5, 0.9, 3.0):
        actual = -(system[2, :2] @ np.linalg.solve(1j * w * np.eye(2) - system[:2, :2], system[:2, 2]) + system[2, 2])
        cosine, sine = (quad(kernel, 0, 150, weight=kind, wvar=w, limit=400)[0] for kind in ("cos", "sin"))
        assert_allclose([actual.real, actual.imag], [cosine, -sine], atol=1e-6 * 4e5)
        below = (0.25 - w**2) ** 2 + (0.3 * w) ** 2
        damping, mass = 4e5 * (0.3 * w) ** 2 / below, 0.3 * 4e5 * (0.25 - w**2) / below
        assert_allclose([actual.real, actual.imag], [damping, w * mass], atol=1e-9 * 4e5)
        assert actual.real <= 4e5 * (1 + 1e-12) and (w != 0.5 or actual.real == pytest.approx(4e5))


def test_radiation_memory_is_a_convolution_and_passive() -> None:
    """An irregular velocity: force by convolution with the kernel, energy taken since the start never negative."""
    step, rng = 0.05, np.random.default_rng(5)
    time = 0.5 * step * np.arange(8001)
    w, phase = rng.uniform(0.05, 1.5, 12), rng.uniform(0, 2 * np.pi, 12)
    velocity = (np.sin(np.outer(time, w) + phase) - np.sin(phase) * np.exp(-time)[:, None]).sum(axis=1)
    force_, _ = driven(radiation(), jnp.zeros((2, 1)), jnp.asarray(velocity), step)
    whole = fftconvolve(velocity, kernel(time))[: time.size] * 0.5 * step
    ends = 0.5 * 0.5 * step * (kernel(time) * velocity[0] + kernel(time[:1]) * velocity)  # of the trapezoid rule
    expected = -(whole - ends)[:-2:2]
    assert_allclose(force_, expected, atol=2e-4 * np.abs(expected).max())
    taken = np.cumsum(-np.asarray(force_) * velocity[:-2:2]) * step
    assert taken.min() > -1e-3 * taken.max() and taken[-1] > 0


def test_eigenfrequencies_with_a_hidden_oscillator() -> None:
    """Those of two masses on two springs and a damper, from (K + s B + s^2 M) by its companion matrix."""
    values, _, _ = SURGE["oscillator"]
    oscillator = next(load for load in rig().with_values(values).loads if isinstance(load, HiddenOscillator))
    model = model_of(rig(), rig().loads[0], oscillator)
    flat, shape = ravel_pytree(model.rest())
    slope = jax.jit(jax.jacfwd(lambda y: ravel_pytree(model.rate(jnp.zeros(()), shape(y), jh.StillWater()))[0]))(flat)
    states = np.array([0, 6, 12, 13])  # surge, its rate, the memory
    eigenvalues = np.linalg.eigvals(np.asarray(slope)[np.ix_(states, states)])
    m, w = 9e5, 2 * math.pi / 30
    k, c = m * w**2, 2 * 0.04 * m * w
    mass, damping = np.diag([M, m]), c * np.array([[1, -1], [-1, 1]])
    spring = np.array([[C + k, -k], [-k, k]])
    nothing, unit = np.zeros((2, 2)), np.eye(2)
    expected = eigvals(np.block([[nothing, unit], [-spring, -damping]]), np.block([[unit, nothing], [nothing, mass]]))
    assert_allclose(eigenvalues[np.argsort(eigenvalues.imag)], expected[np.argsort(expected.imag)], rtol=1e-9)


# conservative laws


def test_nonlinear_hydrostatics_have_a_potential() -> None:
    """Heave and pitch exchange energy and none is lost; forces are the slopes of U, written here."""
    label = "nonlinear_hydrostatics.{}.{}".format
    coefficients = {
        ("heave", "even_quadratic"): 2e5,
        ("heave", "cubic"): 3e4,
        ("heave", "quintic"): 2e3,
        ("heave", "pitch_squared"): 5e7,
        ("pitch", "cubic"): 2e9,
        ("pitch", "quintic"): 3e9,
        ("roll", "cubic"): 1e9,
        ("roll", "quintic"): 2e9,
    }
    values = {label(*names): value for names, value in coefficients.items()}

    def potential(z, roll, pitch):
        own = 2e5 * z**3 / 3 + 3e4 * z**4 / 4 + 2e3 * z**6 / 6 + 5e7 * z * pitch**2 / 2
        return own + 2e9 * pitch**4 / 4 + 3e9 * pitch**6 / 6 + 1e9 * roll**4 / 4 + 2e9 * roll**6 / 6

    model = only(rig().with_values(values), NonlinearHydrostatics)
    position, h = np.array([1.3, -0.2, 0.15]), 1e-5
    steps = h * np.eye(3)
    slopes = [(potential(*(position + d)) - potential(*(position - d))) / (2 * h) for d in steps]
    actual = at_rest(model, jnp.array([0, 0, *position, 0.4]))
    assert_allclose(actual, [0, 0, *(-np.array(slopes)), 0], rtol=1e-7, atol=1e-6)

    actual = response(values, heave=2.0, pitch=0.2)
    z, pitch, rate = actual.position[:, 2], actual.position[:, 4], actual.rate
    kinetic = 0.5 * M * rate[:, 2] ** 2 + 0.5 * INERTIA * rate[:, 4] ** 2
    energy = kinetic + potential(z, 0, pitch) + LIFT * z**2 / 2 + TILT * pitch**2 / 2
    assert_allclose(energy, energy[0], rtol=1e-5)


def test_wall_sided_roll() -> None:
    """GZ = (GM + BM/2 tan^2) sin of a box, by the third and fifth powers, to 1 % at 30 degrees."""
    weight, gm, bm, angle = 8e7, 2.0, 4.0, math.radians(30)
    values = {
        "nonlinear_hydrostatics.roll.cubic": weight * (bm / 2 - gm / 6),
        "nonlinear_hydrostatics.roll.quintic": weight * (bm / 4 + gm / 120),
    }
    moment = at_rest(only(rig().with_values(values), NonlinearHydrostatics), jnp.zeros(6).at[3].set(angle))[3]
    lever = (gm + bm / 2 * math.tan(angle) ** 2) * math.sin(angle)
    assert_allclose(weight * gm * angle - moment, weight * lever, rtol=1e-2)


def test_the_spring_and_pull_of_a_cable_have_a_potential() -> None:
    """U = k/2 (x^2 + y^2) - p x of the point, by differences: in surge, sway and a turn about any axis."""
    model = model_of(rig(), Umbilical(stiffness=3e4, pull=2e5, mass=0.0, height=14.0))

    def potential(q: np.ndarray, turn: np.ndarray) -> float:
        attitude = Rotation.from_rotvec(turn) * Rotation.from_euler("ZYX", q[:2:-1])
        x, y, _ = q[:3] + attitude.apply([0, 0, 14.0])
        return 0.5 * 3e4 * (x**2 + y**2) - 2e5 * x

    q, h = np.array([2.0, -1.0, 0.5, 0.1, -0.2, 0.6]), 1e-4
    slopes = [(potential(q + d, np.zeros(3)) - potential(q - d, np.zeros(3))) / (2 * h) for d in h * np.eye(6)[:3]]
    slopes += [(potential(q, d) - potential(q, -d)) / (2 * h) for d in h * np.eye(3)]
    assert_allclose(at_rest(model, jnp.asarray(q)), -np.array(slopes), rtol=1e-7, atol=1e-3)


# mass


@eqx.filter_jit
def rates(model: jh.Model, position: jax.Array, velocity: jax.Array) -> jax.Array:
    rate = model.rate(jnp.zeros(()), jh.State(position, velocity, model.rest().memory), jh.StillWater())
    return jnp.concatenate([rate.position, rate.velocity])


def floating() -> jh.Model:
    """A column with weight and buoyancy."""
    return only(build(COLUMN, rigid_body=BODY | {"centre_of_mass": [1.5, -0.5, -8]}), Weight, Buoyancy)


def changed(model: jh.Model, mass: float, centre: np.ndarray, inertia: np.ndarray) -> jh.Model:
    """The model with another rigid body and its weight."""
    body = type(model.body)(jnp.asarray(mass), jnp.asarray(centre), jnp.asarray(inertia))
    buoyancy = next(load for load in model.loads if isinstance(load, Buoyancy))
    return eqx.tree_at(lambda m: m.body, model_of(model, Weight(body.mass, body.centre), buoyancy), body)


def assert_alike(first: jh.Model, second: jh.Model) -> None:
    """The same rates in lively motion."""
    for q, v in zip(*sample(4), strict=True):
        expected = rates(second, q, v)
        assert_allclose(rates(first, q, v), expected, rtol=1e-11, atol=1e-12 * float(jnp.abs(expected).max()))


def test_a_wrong_mass_is_another_body() -> None:
    """The load makes of the declared body exactly the one with the other mass, centre and inertia."""
    model = floating()
    body = model.body
    error = MassError(body.mass, body.centre)
    errors = {"mass": 7e5, "centre_x": 0.8, "centre_z": -1.1, "inertia_roll": 3e8, "inertia_pitch": -4e8, "inertia_yaw": 2e8}
    wrong = model.with_effect(error).with_values({f"mass_properties.{name}": value for name, value in errors.items()})
    inertia = np.asarray(body.inertia) + np.diag([3e8, -4e8, 2e8])
    assert_alike(wrong, changed(model, 8.7e6, np.asarray(body.centre) + np.array([0.8, 0, -1.1]), inertia))


def test_a_cable_that_is_carried_is_a_point_of_the_body() -> None:
    """Its mass alone: the body with a point mass at the height, by parallel axes."""
    model = floating()
    carried = model.with_effect(Umbilical(height=20.0)).with_values({"umbilical.mass": 5e5})
    centre, point = np.asarray(model.body.centre), np.array([0, 0, 20.0])
    joint = (8e6 * centre + 5e5 * point) / 8.5e6

    def away(mass: float, r: np.ndarray) -> np.ndarray:
        return mass * (r @ r * np.eye(3) - np.outer(r, r))

    inertia = np.asarray(model.body.inertia) + away(8e6, centre - joint) + away(5e5, point - joint)
    assert_alike(carried, changed(model, 8.5e6, joint, inertia))


# along which axes, and what is refused


def test_forces_along_earth_axes_and_body_axes() -> None:
    """Turned by a quarter in yaw: a constant force stays, damping turns with the hull."""
    quarter = (2.0, 0, 0, 0, 0, math.pi / 2)
    constant = model_of(rig(), StaticForce({"surge": 3.0}))
    assert_allclose(force(constant, position=quarter), [0, -3, 0, 0, 0, 0], atol=1e-15)
    spring = model_of(rig(), MooringNonlinearity({"surge": 3.0}))
    assert_allclose(force(spring, position=quarter), [0, 12, 0, 0, 0, 0], atol=1e-14)
    damping = model_of(rig(), CubicDamping({"pitch": 2.0}))
    assert_allclose(force(damping, (1, 2, 3, 4, 3, 5), quarter), [0, 0, 0, 0, -54, 0], rtol=1e-14)
    friction = model_of(rig(), CoulombFriction({"yaw": 7.0}, {"yaw": 2e-4}))
    assert_allclose(force(friction, (0, 0, 0, 0, 0, -0.02), quarter), [0, 0, 0, 0, 0, 7], rtol=1e-14)


def test_what_is_refused_and_what_labels_mean() -> None:
    """Wrong names are told with the right ones; units by degree of freedom; neutral shapes as given."""
    with pytest.raises(ValueError, match="no degree of freedom 'surgee'; there are: surge"):
        CoulombFriction.neutral(["surgee"])
    with pytest.raises(ValueError, match="no degree of freedom 'surge'; there are: heave, roll, pitch"):
        NonlinearHydrostatics.neutral(["surge"])
    load = Hysteresis.neutral(["pitch", "surge"])
    assert load.about("hysteresis.pitch.force").unit == "N m" and load.about("hysteresis.surge.force").unit == "N"
    assert {label: float(value) for label, value in load.values.items()} == {
        "hysteresis.surge.force": 0.0,
        "hysteresis.surge.yield_displacement": 0.5,
        "hysteresis.pitch.force": 0.0,
        "hysteresis.pitch.yield_displacement": 0.01,
    }
    assert float(Hysteresis.neutral(["surge"], yield_displacement=2.0).values["hysteresis.surge.yield_displacement"]) == 2.0
    assert float(RadiationMemory.neutral(["heave"], frequency=1.0).values["radiation_memory.heave.frequency"]) == 1.0
