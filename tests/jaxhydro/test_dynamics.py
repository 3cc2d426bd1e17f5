"""Motion in time: order of the schemes, exact motions, gradients, equilibrium and natural modes."""

import math
from functools import cache

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import one_program
from scipy.linalg import eigh
from scipy.spatial.transform import Rotation

import jaxhydro as jh
from jaxhydro.cli.model_messages import print_rest
from jaxhydro.dynamics.integrate import Grid, integrate
from jaxhydro.dynamics.natural_modes import _one_motion_each
from jaxhydro.dynamics.response import Response
from jaxhydro.dynamics.solve6 import accelerate, inverse6
from jaxhydro.dynamics.statics import stable_modes
from jaxhydro.integrators import runge_kutta
from jaxhydro.rotations import angular_velocity, attitude_rates, rotation

RHO, G = 1025.0, 9.81
STILL = jh.StillWater()
COLUMN = {"name": "column", "shape": "circ", "d": 12.0, "rA": [30, 0, -20], "rB": [30, 0, 15], "heading": [0, 120, 240]}
SPRINGS = {
    "kind": "linear_springs",
    "lines": [
        {"anchor": anchor, "fairlead": fairlead, "stiffness": 45e3, "pretension": 1.5e6}
        for anchor, fairlead in (
            ([150.0, 259.8, -14.0], [29.0, 50.2, -14.0]),
            ([-300.0, 0.0, -14.0], [-58.0, 0.0, -14.0]),
            ([150.0, -259.8, -14.0], [29.0, -50.2, -14.0]),
        )
    ],
}


def platform(**changes) -> jh.Platform:
    """A bare body: no members, held by its declared hydrostatics."""
    data = {
        "name": "body",
        "water": {"density": RHO, "depth": 200.0, "gravity": G},
        "rigid_body": {"mass": 8e6, "centre_of_mass": [0, 0, 0], "inertia": {"Ixx": 4e9, "Iyy": 5e9, "Izz": 6e9}},
    }
    return jh.Platform.model_validate(data | changes)


@cache
def smooth() -> jh.Model:
    """Nonlinear by its springs and its rotations, without anything that has a kink."""
    return jh.build(
        platform(
            mooring=SPRINGS,
            hydrostatics={"C33": 4e6, "C44": 4e8, "C55": 5e8},
            linear_damping={"B11": 5e4, "B33": 3e5, "B55": 1e8},
        )
    )


@cache
def hull() -> jh.Model:
    """Three columns with every strip load, on springs."""
    mass = RHO * 3 * math.pi * 36 * 20
    inertia = {"Ixx": 4e9, "Iyy": 4e9, "Izz": 6e9}
    return jh.build(
        platform(
            rigid_body={"mass": mass, "centre_of_mass": [0, 0, -3], "inertia": inertia},
            members=[COLUMN],
            coefficients={"column": {"Ca_t": 0.9, "Ca_z": 0.6, "Cd_t": 1.1, "Cd_z": 2.3}},
            linear_damping={"B11": 5e4, "B33": 3e5},
            mooring=SPRINGS,
        )
    )


START = jnp.array([12.0, -5.0, 2.0, 0.1, 0.25, -0.3])


@eqx.filter_jit
def run(model, position, velocity, step, capacity, method="tsit5", adjoint="forward", sea=STILL) -> Grid:
    """Motion from a position (m, rad) and a velocity in body axes."""
    state = jh.State(position, velocity, model.rest().memory)
    return integrate(model, sea, state, jnp.zeros(()), jnp.asarray(step), capacity, method, adjoint)


# schemes


@pytest.mark.parametrize("method, order, steps", [("rk4", 4, (48, 96, 192)), ("tsit5", 5, (24, 48, 96))])
def test_order_of_convergence(method: str, order: int, steps: tuple[int, ...]) -> None:
    """The error of a decay over 24 s falls with the step to the power of the scheme's order."""

    @eqx.filter_jit
    def final(model, count):
        state = jh.State(START, jnp.zeros(6), model.rest().memory)
        grid = integrate(model, STILL, state, jnp.zeros(()), 24.0 / count, 600, method, count=count)
        return grid.position[count]

    exact = final(smooth(), jnp.asarray(600))
    errors = [float(jnp.linalg.norm(final(smooth(), jnp.asarray(n)) - exact)) for n in steps]
    slope = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    # Tsitouras's error of fifth order is so small that a gentle motion shows the sixth as well
    assert order - 0.3 < slope < order + (0.3 if method == "rk4" else 1.1)


@pytest.mark.parametrize("method, order, steps", [("rk4", 4, (80, 160, 320)), ("tsit5", 5, (80, 160, 320))])
def test_order_of_the_schemes_themselves(method: str, order: int, steps: tuple[int, ...]) -> None:
    """y' = y cos t, y(0) = 1: exactly exp(sin t), with time in the right-hand side."""
    scheme, errors = runge_kutta.RK4 if method == "rk4" else runge_kutta.tsit5(), []
    options = {"rate": lambda _, t, y: (y * jnp.cos(t),), "scheme": scheme, "capacity": 320, "shown": 1}
    for count in steps:
        step = jnp.asarray(8.0 / count)
        path = runge_kutta.forward(None, jnp.ones(1), jnp.zeros(()), step, jnp.asarray(count), **options)
        times = np.linspace(0.0, 8.0, count + 1)
        errors.append(np.abs(np.asarray(path)[: count + 1, 0] - np.exp(np.sin(times))).max())
    slope = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert slope == pytest.approx(order, abs=0.3)


@pytest.mark.slow
def test_own_loop_against_diffrax() -> None:
    """The same scheme in this package's loop, either adjoint, and in diffrax, with drag and added mass: one motion."""
    own, checkpointed, by_diffrax = (
        run(hull(), START, jnp.zeros(6), 0.5, 40, *options) for options in (("tsit5",), ("tsit5", "reverse"), ("diffrax",))
    )
    for name in ("position", "rate", "acceleration"):
        exact = getattr(own, name)[:41]
        for two in (checkpointed, by_diffrax):
            assert_allclose(exact, getattr(two, name)[:41], rtol=1e-10, atol=1e-10 * float(jnp.abs(exact).max()))


@pytest.mark.slow
def test_output_at_recorded_times() -> None:
    """Irregular output times do not touch the integration, and the inner step shows with the scheme's error only."""
    times = np.sort(np.concatenate([[0.0, 40.0], np.random.default_rng(0).uniform(0, 40, 61)]))
    coarse, fine = (jh.simulate(smooth(), times, position=START, step=step) for step in (0.25, 0.05))
    for name, tolerance in (("position", 5e-6), ("rate", 2e-5), ("acceleration", 5e-4)):
        rough, exact = np.asarray(getattr(coarse, name)), np.asarray(getattr(fine, name))
        assert np.abs(rough - exact).max() < tolerance * np.abs(exact).max()
    selected = np.array([0, 7, 20, 62])
    few = jh.simulate(smooth(), times[selected], position=START, step=0.25)
    assert_allclose(few.position, coarse.position[selected], rtol=1e-12, atol=1e-12)


@one_program
def read(grid: Grid, times) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Position, rate and acceleration of sway."""
    return grid.at(times, (1,))


@one_program
def speed(grid: Grid, times) -> jax.Array:
    """Derivative of the position of sway by the times."""
    return jax.jvp(lambda times: grid.at(times, (1,))[0][:, 0], (times,), (jnp.ones_like(times),))[1]


def test_interpolation_is_of_sixth_order() -> None:
    """Quintic Hermite of a sine: error (h omega)^6 / (2^6 6!) at most, velocity and acceleration consistent with it."""
    errors = []
    for step in (0.4, 0.2):
        t = step * np.arange(60)
        curve = [np.tile(f(t)[:, None], 6) for f in (np.sin, np.cos, lambda t: -np.sin(t))]
        grid = Grid(np.zeros(()), np.asarray(step), np.asarray(59), *curve)
        at = np.linspace(0.3, 10.0, 197)
        x, v, a = (np.asarray(values)[:, 0] for values in read(grid, at))
        assert np.abs(v - np.cos(at)).max() < 3 * step**5 / 720
        assert np.abs(a + np.sin(at)).max() < 3 * step**4 / 24
        errors.append(np.abs(x - np.sin(at)).max())
        assert errors[-1] < step**6 / (64 * 720) * 1.01
        knots = np.asarray(read(grid, t[:-1])[0])
        assert_allclose(knots[:, 0], np.sin(t[:-1]), rtol=1e-14, atol=1e-14)
        # at a step's time as well: so begins a clock's delay
        assert_allclose(speed(grid, t[:-1]), np.cos(t[:-1]), rtol=0, atol=1e-12)
    assert math.log2(errors[0] / errors[1]) == pytest.approx(6, abs=0.2)


# gradients


LABELS = ("column.Ca_t", "column.Ca_z", "column.Cd_t", "column.Cd_z", "linear_damping.B33", "mooring.line2.stiffness")


def objective(unknowns, adjoint):
    """A scalar of a decay: a weighted square of the motion, by factors on six parameters and initial position."""
    factors, start = unknowns
    model = hull()
    values = {label: factor * model.values[label] for label, factor in zip(LABELS, factors, strict=True)}
    state = jh.State(start, jnp.zeros(6), model.rest().memory)
    step = jnp.asarray(0.5)
    grid = integrate(model.with_values(values), STILL, state, jnp.zeros(()), step, 60, "tsit5", adjoint)
    position, rate, acceleration = grid.at(jnp.linspace(0.0, 29.7, 37))
    weights = jnp.array([1.0, 2.0, 3.0, 50.0, 70.0, 60.0])
    return ((weights * position) ** 2).mean() + ((weights * rate) ** 2).mean() + ((weights * acceleration) ** 2).mean()


UNKNOWNS = (jnp.array([1.0, 1.1, 0.9, 1.2, 1.0, 1.0]), START)


@cache
def central_differences() -> np.ndarray:
    """Of the whole simulation, of fourth order."""
    value = jax.jit(lambda flat: objective((flat[:6], flat[6:]), "forward"))
    at, columns = jnp.concatenate(UNKNOWNS), []
    for i in range(12):
        h = 1e-3 * jnp.eye(12)[i] * jnp.maximum(jnp.abs(at[i]), 0.1)
        f = [float(value(at + k * h)) for k in (-2, -1, 1, 2)]
        columns.append((f[0] - 8 * f[1] + 8 * f[2] - f[3]) / (12 * float(h[i])))
    return np.array(columns)


@pytest.mark.slow
def test_gradients_through_a_simulation() -> None:
    """Reverse = forward, and both = central differences of the simulation, for parameters and initial state; under vmap
    the gradients of a batch are those of its members."""
    batch = [UNKNOWNS, jax.tree.map(lambda x: 1.2 * x, UNKNOWNS)]
    forward = jax.jit(jax.vmap(jax.jacfwd(lambda u: objective(u, "forward"))))(jax.tree.map(lambda *x: jnp.stack(x), *batch))
    forward = jnp.concatenate(forward, axis=1)
    reverse = jax.jit(jax.grad(lambda u: objective(u, "reverse")))
    for i, unknowns in enumerate(batch):
        single = jnp.concatenate(reverse(unknowns))
        assert_allclose(forward[i], single, rtol=1e-8, atol=1e-8 * float(jnp.abs(single).max()))
    assert_allclose(forward[0], central_differences(), rtol=1e-6, atol=1e-6)


@pytest.mark.validate
def test_gradient_by_diffrax_reverse() -> None:
    """diffrax's own checkpointed adjoint agrees with ours, at output times on the step grid and between."""

    def value(start, method, adjoint):
        grid = run.__wrapped__(smooth(), start, jnp.zeros(6), 0.5, 30, method, adjoint)
        return (grid.at(jnp.array([3.0, 7.3, 14.9]))[0] ** 2).sum()

    ours = jax.jit(jax.grad(lambda s: value(s, "tsit5", "reverse")))(START)
    by_diffrax = jax.jit(jax.grad(lambda s: value(s, "diffrax", "reverse")))(START)
    assert_allclose(ours, by_diffrax, rtol=1e-8, atol=1e-8 * float(jnp.abs(ours).max()))


# exact motions


body_velocity = one_program(jh.Model.body_velocity)


def test_free_body_keeps_its_momentum_and_energy() -> None:
    """Euler's equations: a tumbling body off its reference point, nothing acting on it (gravity 1e-12)."""
    body = {"mass": 8e6, "centre_of_mass": [3, -2, -8], "inertia": {"Ixx": 4e9, "Iyy": 5e9, "Izz": 7e9, "Ixz": 3e8}}
    model = jh.build(platform(rigid_body=body, water={"density": RHO, "depth": 200.0, "gravity": 1e-12}))
    velocity, position = np.array([0.7, -0.4, 0.2, 0.05, -0.08, 0.5]), np.array([1.0, 2.0, 3.0, 0.2, -0.3, 0.5])
    grid = run(model, position, velocity, 0.05, 600)
    inertia, centre = np.asarray(model.body.inertia), np.array([3.0, -2, -8])
    momentum, energy, drift = [], [], []
    for q, rate in zip(np.asarray(grid.position)[:601:20], np.asarray(grid.rate)[:601:20], strict=True):
        v = np.asarray(body_velocity(q, rate))
        matrix = Rotation.from_euler("ZYX", q[:2:-1]).as_matrix()
        velocity = v[:3] + np.cross(v[3:], centre)
        momentum.append(matrix @ inertia @ v[3:])
        drift.append(matrix @ velocity)
        energy.append(0.5 * 8e6 * velocity @ velocity + 0.5 * v[3:] @ inertia @ v[3:])
    assert np.ptp(np.array(grid.position)[:601, 5]) > 4.0  # it did turn
    for conserved in (momentum, energy, drift):
        conserved = np.array(conserved)
        assert_allclose(
            conserved, np.broadcast_to(conserved[0], conserved.shape), rtol=1e-7, atol=1e-7 * np.abs(conserved).max()
        )


@pytest.mark.parametrize("damping", [0.0, 3e5, 2e6])
def test_linear_oscillator(damping: float) -> None:
    """m x'' + b x' + c x = 0 from rest: A exp(-zeta w t) (cos wd t + zeta w/wd sin wd t)."""
    changes = {"linear_damping": {"B33": damping}} if damping else {}
    model = jh.build(platform(hydrostatics={"C33": 4e6}, added_mass={"A33": 2e6}, **changes))
    times = np.linspace(0.0, 60.0, 77)
    actual = np.asarray(jh.free_decay(model, {"heave": 3.0}, times, step=0.1)["heave"])
    omega = math.sqrt(4e6 / 1e7)
    zeta = damping / (2 * math.sqrt(4e6 * 1e7))
    damped = omega * math.sqrt(1 - zeta**2)
    exact = 3.0 * np.exp(-zeta * omega * times) * (np.cos(damped * times) + zeta * omega / damped * np.sin(damped * times))
    assert_allclose(actual, exact, atol=3e-8)


def test_initial_rate_by_name() -> None:
    """x = v/w sin wt, and what is not named is at rest."""
    model = jh.build(platform(hydrostatics={"C33": 4e6}))
    times = np.linspace(0.0, 20.0, 41)
    response = jh.simulate(model, times, rate={"heave": 0.5}, step=0.1)
    omega = math.sqrt(0.5)
    assert_allclose(response["heave"], 0.5 / omega * np.sin(omega * times), atol=1e-8)
    assert_allclose(response.rate[:, 2], 0.5 * np.cos(omega * times), atol=1e-7)
    assert_allclose(response.acceleration[:, 2], -0.5 * omega * np.sin(omega * times), atol=1e-5)
    assert_allclose(response["surge"], 0.0, atol=1e-12)


# rotations and the solver


def test_rotations_against_scipy() -> None:
    """R = Rz Ry Rx by scipy; body rates from dR/dt = R S(omega); attitude_rates and angular_velocity are inverse."""
    rng = np.random.default_rng(1)
    for _ in range(5):
        attitude, rates = jnp.asarray(rng.uniform(-1.2, 1.2, 3)), jnp.asarray(rng.normal(size=3))
        matrix, turning = jax.jvp(rotation, (attitude,), (rates,))
        assert_allclose(matrix, Rotation.from_euler("ZYX", attitude[::-1]).as_matrix(), atol=1e-14)
        spin = np.asarray(matrix).T @ np.asarray(turning)
        omega = angular_velocity(attitude, rates)
        assert_allclose([spin[2, 1], spin[0, 2], spin[1, 0]], omega, atol=1e-13)
        assert_allclose(attitude_rates(attitude, omega), rates, atol=1e-13)


def test_position_rate_and_its_inverse() -> None:
    """The two static methods of Model undo each other."""
    q, rates = START, jnp.array([1.0, -2.0, 0.5, 0.1, 0.2, -0.3])
    assert_allclose(jh.Model.position_rate(q, jh.Model.body_velocity(q, rates)), rates, atol=1e-14)


def positive_definite(rng) -> np.ndarray:
    root = rng.normal(size=(6, 6)) * np.array([1, 1, 1, 40, 40, 40])[:, None]
    return 1e6 * (root @ root.T + np.diag([1, 1, 1, 2e3, 2e3, 2e3]))


def test_inverse_against_numpy() -> None:
    """Mass matrices of a platform's scales: metres and radians, 1e6 and 1e10."""
    rng = np.random.default_rng(2)
    for _ in range(5):
        matrix = positive_definite(rng)
        scale = np.sqrt(np.diag(matrix))
        product = np.asarray(inverse6(jnp.asarray(matrix))) @ matrix
        assert_allclose(product * scale[:, None] / scale, np.eye(6), atol=1e-9)


def test_acceleration_and_its_derivatives() -> None:
    """The solution against numpy.linalg.solve; its derivatives against JAX's through jnp.linalg.solve."""
    rng = np.random.default_rng(3)
    lever = rng.normal(size=(6, 4)) * np.array([1, 1, 1, 30, 30, 30])[:, None]
    moments = np.einsum("ik,jk->ijk", lever, lever)
    mass, force, masses = positive_definite(rng), rng.normal(size=6), rng.uniform(0, 1e6, 4)
    arguments = (mass, force, masses, moments)

    def plain(mass, force, masses, moments):
        return jnp.linalg.solve(mass + moments @ masses, force)

    exact = np.asarray(one_program(plain)(*arguments))
    assert_allclose(one_program(accelerate)(*arguments), exact, rtol=1e-9)
    weights = rng.normal(size=6) / np.abs(exact)
    for differentiate in (jax.grad, jax.jacfwd):
        actual, expected = (
            one_program(differentiate(lambda *x, f=f: f(*x) @ weights, argnums=(0, 1, 2)))(*arguments)
            for f in (accelerate, plain)
        )
        for derivative, reference in zip(map(np.asarray, actual), map(np.asarray, expected), strict=True):
            reference = 0.5 * (reference + reference.T) if derivative.shape == (6, 6) else reference
            derivative = 0.5 * (derivative + derivative.T) if derivative.shape == (6, 6) else derivative
            assert_allclose(derivative, reference, rtol=1e-7, atol=1e-9 * np.abs(reference).max())


@pytest.mark.slow
@pytest.mark.parametrize("directions", ["body", "earth"])
def test_slope_of_the_rate_with_attitude(directions: str) -> None:
    """Forward derivatives against central differences, where the moments of the added mass turn as well."""
    model = hull().with_conventions(directions=directions)
    state = eqx.tree_at(lambda s: s.velocity, model.rest(), jnp.array([0.3, 0.1, 0.2, 0.01, 0.02, 0.01]))

    @eqx.filter_jit
    def rate(position):
        return model.rate(jnp.asarray(0.0), eqx.tree_at(lambda s: s.position, state, position), STILL).velocity

    position, size = np.array([0.5, 0.1, 0.2, 0.02, 0.05, 0.03]), 1e-5
    high, low = (np.stack([rate(position + sign * size * e) for e in np.eye(6)], axis=1) for sign in (1, -1))
    expected = (high - low) / (2 * size)
    assert_allclose(one_program(jax.jacfwd(rate))(position), expected, atol=1e-7 * np.abs(expected).max())


# statics


def test_a_platform_that_is_too_heavy_has_no_equilibrium() -> None:
    """Twice the mass that its columns can carry: the error names heave."""
    mass = 2 * RHO * 3 * math.pi * 36 * 35
    inertia = {"Ixx": 4e9, "Iyy": 4e9, "Izz": 6e9}
    model = jh.build(
        platform(
            rigid_body={"mass": mass, "centre_of_mass": [0, 0, -3], "inertia": inertia},
            members=[COLUMN],
            coefficients={"column": {}},
        )
    )
    with pytest.raises(jh.EquilibriumError, match="heave"):
        jh.equilibrium(model)
    with pytest.raises(jh.EquilibriumError, match="heave"):
        jh.simulate(model, [0.0, 1.0], step=0.5)


def test_equilibrium_of_a_lighter_platform() -> None:
    """It rises by the missing weight over rho g A; what nothing restrains stays where it is."""
    area = 3 * math.pi * 36
    inertia = {"Ixx": 4e9, "Iyy": 4e9, "Izz": 6e9}
    model = jh.build(
        platform(
            rigid_body={"mass": RHO * area * 18.5, "centre_of_mass": [0, 0, -3], "inertia": inertia},
            members=[COLUMN],
            coefficients={"column": {}},
        )
    )
    assert_allclose(jh.equilibrium(model), [0, 0, 1.5, 0, 0, 0], atol=1e-9)


@pytest.mark.slow
def test_equilibrium_is_differentiable() -> None:
    """d heave / d preload = 1/C33, by the implicit function theorem."""
    matrix = {"kind": "stiffness_matrix", "stiffness": {"C11": 5e4, "C33": 1e6}, "preload": [1e5, 0, 0, 0, 0, 0]}
    model = jh.build(platform(hydrostatics={"C33": 4e6, "C44": 4e8, "C55": 5e8}, mooring=matrix))
    assert float(jh.equilibrium(model)[0]) == pytest.approx(2.0, rel=1e-9)
    slope = jax.grad(lambda c: jh.equilibrium(model.with_values({"mooring.C11": c}))[0])(5e4)
    assert float(slope) == pytest.approx(-1e5 / 5e4**2, rel=1e-6)


def test_modes_of_one_frequency_are_of_one_motion_each() -> None:
    """Any mixture of them is a mode; a third mode stays as it is."""
    surge, sway, pitch, roll, heave = np.eye(6)[0], np.eye(6)[1], np.eye(6)[4], np.eye(6)[3], np.eye(6)[2]
    first, second = surge - 0.01 * pitch, sway + 0.01 * roll
    mixed = np.stack([0.8 * first + 0.6 * second, -0.6 * first + 0.8 * second, heave], axis=1)
    shapes = _one_motion_each(np.array([0.01, 0.01 * (1 + 1e-9), 0.2]), mixed, np.array([1, 1, 1, 50.0, 50.0, 50.0]))
    assert_allclose(shapes, np.stack([first, second, heave], axis=1), atol=1e-12)


def test_natural_modes() -> None:
    """T = 2 pi sqrt((m + a)/c) in heave, and of coupled surge and pitch by scipy's generalised eigenproblem."""
    stiffness = {"C11": 7e4, "C22": 5e4, "C15": 1e6, "C55": 3e8}
    body = {"mass": 8e6, "centre_of_mass": [0, 0, -3], "inertia": {"Ixx": 4e9, "Iyy": 5e9, "Izz": 6e9}}
    model = jh.build(
        platform(
            rigid_body=body,
            hydrostatics={"C33": 4e6, "C44": 4e8, "C55": 5e8},
            stiffness=stiffness,
            added_mass={"A33": 2e6},
        )
    )
    modes = jh.natural_modes(model)
    assert modes.of("heave") == pytest.approx(2 * math.pi * math.sqrt(1e7 / 4e6), rel=1e-9)
    lever = 8e6 * -3
    mass = np.array([[8e6, lever], [lever, 5e9 + 8e6 * 9]])
    square = eigh(np.array([[7e4, 1e6], [1e6, 8e8]]), mass, eigvals_only=True)
    assert_allclose([modes.of("surge"), modes.of("pitch")], 2 * np.pi / np.sqrt(square), rtol=1e-9)
    assert math.isnan(modes.of("yaw"))
    assert list(modes.period) == sorted(modes.period, reverse=True)
    assert_allclose(np.abs(modes.shape).max(axis=1), 1.0)
    assert modes.unstable == ()


def test_a_platform_that_falls_over() -> None:
    """A waterplane that does not hold it up: in which motion, and no run of it is begun."""
    body = {"mass": 8e6, "centre_of_mass": [0, 0, -3], "inertia": {"Ixx": 4e9, "Iyy": 5e9, "Izz": 6e9}}
    declared = platform(rigid_body=body, hydrostatics={"C33": 4e6, "C44": -4e8, "C55": 9e8}, added_mass={"A33": 2e6})
    model = jh.build(declared)
    assert jh.natural_modes(model).unstable == ("roll",)
    with pytest.raises(jh.EquilibriumError, match="unstable in roll"):
        print_rest(model, "made")


def test_a_motion_that_nothing_moves_may_be_unstable() -> None:
    """Of a platform file that says how it pitches, and not how it rolls: pitch does not bring roll with it, sway does."""
    body = {"mass": 8e6, "centre_of_mass": [0, 0, -3], "inertia": {"Ixx": 4e9, "Iyy": 5e9, "Izz": 6e9}}
    declared = platform(rigid_body=body, hydrostatics={"C33": 4e6, "C44": -4e8, "C55": 9e8}, added_mass={"A33": 2e6})
    model = jh.build(declared)
    assert stable_modes(model, ["pitch"]).unstable == stable_modes(model, ["heave", "surge"]).unstable == ("roll",)
    for moved in (["roll"], ["pitch", "sway"]):
        with pytest.raises(jh.EquilibriumError, match="unstable in roll"):
            stable_modes(model, moved)


# errors


@pytest.mark.parametrize("times", [[0.0], [0.0, 1.0, 1.0], [1.0, 0.0], [[0.0, 1.0]], []])
def test_times_must_increase(times: list) -> None:
    """A message, not a wrong motion."""
    with pytest.raises(ValueError, match="increasing"):
        jh.simulate(smooth(), times)


def test_unknown_names() -> None:
    """Every name is checked, and the message says what there is."""
    with pytest.raises(KeyError, match="surge"):
        jh.simulate(smooth(), [0.0, 1.0], position={"hieve": 1.0})
    with pytest.raises(KeyError, match="surge"):
        jh.simulate(smooth(), [0.0, 1.0], rate={"Surge": 1.0})
    with pytest.raises(KeyError, match="surge"):
        Response(*(jnp.zeros((2, 6)),) * 4)["hieve"]
    with pytest.raises(KeyError, match=r"column\.Ca_t"):
        hull().with_values({"column.Ca_x": 1.0})
    with pytest.raises(KeyError, match=r"column\.Ca_t"):
        hull().about("bogus")


def test_nan_times_are_refused() -> None:
    """nan compares false with everything."""
    with pytest.raises(ValueError):
        jh.simulate(smooth(), [0.0, float("nan"), 2.0])


def test_float64_is_needed() -> None:
    """Built in single precision, a model would be wrong quietly."""
    jax.config.update("jax_enable_x64", False)
    try:
        with pytest.raises(RuntimeError, match="float64"):
            jh.build(platform())
    finally:
        jax.config.update("jax_enable_x64", True)
