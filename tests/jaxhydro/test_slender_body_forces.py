"""Second-order forces on slender members against Kirchhoff's equations, integrals of the pressure, and RAFT's results."""

import dataclasses
import json
from pathlib import Path

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import flow, one_program

import jaxhydro as jh
from benchmarks.raft_slender_body import CASES, FREQUENCY, motions
from jaxhydro.dynamics.model import Model
from jaxhydro.loads import EndInertia, SlenderBodyForces, StripInertia
from jaxhydro.water import WaveReflection
from jaxhydro.waves import Clock, Cylinders

RHO, G = 1025.0, 9.81
WATER = jh.Environment(RHO, 200.0, G)
BODY = {"mass": 8e6, "centre_of_mass": [0, 0, -8], "inertia": {"Ixx": 4e9, "Iyy": 5e9, "Izz": 6e9}}
SUBMERGED = (
    {"name": "tower", "group": "column", "shape": "circ", "d": 9.0, "rA": [2, 1, -60], "rB": [5, -3, -30]},
    {
        "name": "cone",
        "group": "column",
        "shape": "circ",
        "stations": [0, 1],
        "d": [8.0, 4.0],
        "rA": [-12, 1, -60],
        "rB": [-10, 3, -30],
    },
    {"name": "beam", "group": "pontoon", "shape": "rect", "d": [9.0, 5.0], "rA": [4, 2, -55], "rB": [45, 12, -52]},
)


def built(*members: dict, Ca_t: float = 0.9, Ca_z: float = 0.0, pontoon_z: float = 2.1, **keys) -> Model:
    groups = {member["group"] for member in members}
    rows = {"column": {"Ca_t": Ca_t, "Ca_z": Ca_z}, "pontoon": {"Ca_t": Ca_t, "Ca_z": pontoon_z}}
    coefficients = {group: row | {"Cd_t": 0.0, "Cd_z": 0.0} for group, row in rows.items() if group in groups}
    data = {"name": "slender", "water": {"density": RHO, "depth": 200.0, "gravity": G}, "rigid_body": BODY}
    data |= {"members": list(members), "coefficients": coefficients, "diffraction": "none"} | keys
    return jh.build(jh.Platform.model_validate(data))


def with_share(model: Model, share: float) -> Model:
    loads = tuple(load for load in model.loads if isinstance(load, StripInertia | EndInertia))
    return dataclasses.replace(model, loads=(*loads, SlenderBodyForces(jnp.asarray(share))))


@one_program
def wrench(model: Model, position, velocity, sea, time=0.0) -> tuple[jax.Array, jax.Array]:
    """Force (N, N m; body axes) and added mass about the reference point."""
    state = jh.State(jnp.asarray(position, float), jnp.asarray(velocity, float), model.rest().memory)
    now = model.instant(jnp.asarray(time, float), state, sea)
    total = model.sum_of_loads(now, state.memory)
    return total.force, total.added_mass + model.hull.moments @ total.masses


@pytest.mark.parametrize("which", [(0,), (1,), (2,), (0, 1, 2)])
def test_kirchhoff(which: tuple[int, ...]) -> None:
    """In still water the forces on members under water are those of a body with their added mass in an ideal fluid.

    They are -d/dt of the momenta A v in axes that turn with the body (Lamb 1932, article 124, equations 1; Fossen 2011,
    equation 6.43). The acceleration of the reference point is what the added mass multiplies.
    """
    model = with_share(built(*(SUBMERGED[i] for i in which)), 1.0)
    for seed in range(3):
        velocity = np.random.default_rng(seed).uniform(-1, 1, 6) * [2, 2, 2, 0.1, 0.1, 0.1]
        force, added = map(np.asarray, wrench(model, np.zeros(6), velocity, jh.StillWater()))
        linear, spin = velocity[:3], velocity[3:]
        momentum = added @ velocity
        turned = np.cross(spin, momentum[3:]) + np.cross(linear, momentum[:3])
        expected = -np.concatenate([np.cross(spin, momentum[:3]), turned])
        # the added mass takes the acceleration of the point, which has omega x v beyond the rate of v in body axes
        expected = expected + added @ np.concatenate([np.cross(spin, linear), np.zeros(3)])
        assert_allclose(force, expected, atol=1e-9 * np.abs(expected).max())
        plain, _ = wrench(with_share(model, 0.0), np.zeros(6), velocity, jh.StillWater())
        assert np.abs(plain - expected).max() > 0.05 * np.abs(expected).max()


def bichromatic(order: int = 1, heights=(1.0, 1.0), frequencies=(0.09, 0.115), heading: float = 0.5, **options) -> jh.WaveSea:
    """Two waves by direct summation, with the waves that they bind at difference frequencies where `order` is 2."""
    omega = 2 * np.pi * np.array(frequencies)
    waves = jh.waves.components(0.5 * np.array(heights), omega, WATER, heading=np.full(2, heading), phase=np.array([0.3, 1.1]))
    bound = jh.waves.bound_waves(waves, WATER, ("difference",)) if order == 2 else None
    return jh.WaveSea(jh.waves.PlaneWaves.free(waves, WATER), WATER, bound=bound, **options)


def short_crested() -> jh.WaveSea:
    omega = 2 * np.pi * np.array([0.08, 0.11, 0.14])
    heading, phase = np.array([0.5, -0.4, 1.3]), np.array([0.3, 1.1, 2.0])
    waves = jh.waves.components(np.array([1.0, 0.7, 0.6]), omega, WATER, heading=heading, phase=phase)
    return jh.WaveSea(jh.waves.PlaneWaves.free(waves, WATER), WATER)


CYLINDERS = Cylinders(jnp.array([4.0, 6.0]), (0, 1, -1))


def prepared(stretching: str = "vertical", order: int = 2) -> jh.waves.SupportSea:
    waves = jh.spectrum_components(lambda w: jh.jonswap(w, 6.0, 11.0), 200.0, WATER, low=0.04, cutoff=0.25, seed=3, heading=0.5)
    hull = np.array([[-30.0, 0, -20], [30.0, 20, 10]]).T
    return jh.IrregularSea(waves, WATER, order, stretching).prepared(hull, CYLINDERS, Clock(0.0, 0.25, 600, (0.0,)))


@one_program
def reflected(sea: jh.AbstractSea) -> jh.AbstractSea:
    return WaveReflection(jnp.asarray(0.2), jnp.asarray(21.0), jnp.asarray(0.4)).through(sea)


SEAS = {
    "two waves": bichromatic,
    "bound waves": lambda: bichromatic(2),
    "short-crested": short_crested,
    "prepared": prepared,
    "prepared, extrapolated": lambda: prepared("extrapolation"),
    "reflected": lambda: reflected(bichromatic()),
    "prepared and reflected": lambda: reflected(prepared()),
}


@pytest.mark.parametrize("name", SEAS)
def test_gradient_of_the_velocity(name: str) -> None:
    """Against differences of the velocity, at points under still water; no source, and no rotation."""
    sea, time, step = SEAS[name](), jnp.asarray(50.0), 1e-4
    points = np.array([[3.0, -2.0, -4.0], [11.0, 6.0, -12.0], [-8.0, 1.0, -18.0]]).T
    moved = np.concatenate([points + s * step * np.eye(3)[:, [j]] for j in range(3) for s in (1, -1)], axis=1)
    velocity = np.asarray(flow(sea, time, moved).velocity).reshape(3, 3, 2, 3)
    expected = (velocity[:, :, 0] - velocity[:, :, 1]) / (2 * step)
    cylinders = CYLINDERS if "prepared" in name else None
    gradient = np.asarray(flow(sea, time, points, cylinders, True).gradient)
    scale = np.abs(expected).max()
    assert scale > 0.005
    # a prepared sea is one of waves to 1e-5 only, so its difference quotients have that error too
    assert_allclose(gradient, expected, atol=(1e-3 if "prepared" in name else 1e-7) * scale)
    assert_allclose(np.einsum("iin->n", gradient), 0.0, atol=1e-9 * scale)
    assert_allclose(gradient, np.swapaxes(gradient, 0, 1), atol=1e-9 * scale)


def test_pressure_on_a_closed_body() -> None:
    """Without added mass, the forces on a thin body are the undisturbed pressure -rho (dphi/dt + v²/2) on its surface.

    Its integral is that of -grad p over the volume, here by Gauss quadrature over the box. The strips' own part, dphi/dt, is
    compared as well.
    """
    size, low, high = 1.5, -14.0, -4.0
    member = {"name": "box", "group": "column", "shape": "rect", "d": [size, size], "rA": [3, 0, low], "rB": [3, 0, high]}
    model, sea = built(member, Ca_t=0.0), bichromatic(frequencies=(0.1, 0.13), heights=(3.0, 2.0))
    nodes, weights = np.polynomial.legendre.leggauss(6)
    x, y = np.meshgrid(0.5 * size * nodes + 3.0, 0.5 * size * nodes)
    z = 0.5 * (low + high) + 0.5 * (high - low) * nodes
    points = np.stack([np.repeat(x.ravel(), 6), np.repeat(y.ravel(), 6), np.tile(z, 36)])
    share = (np.outer(np.outer(weights, weights), weights) / 8 * size * size * (high - low)).ravel()
    for time in (0.0, 3.0, 7.0):
        waves = flow(sea, time, points, None, True)
        for order, field in ((1, waves.acceleration), (2, np.einsum("ijn,jn->in", waves.gradient, waves.velocity))):
            push = RHO * np.asarray(field) * share
            expected = np.concatenate([push.sum(axis=1), np.cross(points, push, axis=0).sum(axis=1)])
            with_forces = wrench(with_share(model, 1.0), np.zeros(6), np.zeros(6), sea, time)[0]
            none = wrench(with_share(model, 0.0), np.zeros(6), np.zeros(6), sea, time)[0]
            acting_force = none if order == 1 else with_forces - none
            assert_allclose(acting_force, expected, atol=4e-3 * np.abs(expected).max())


def test_a_sphere_of_water() -> None:
    """Taylor's theorem: in a nonuniform stream a body has its displaced mass and its added mass times the convective term.

    A short upright circular cylinder across the flow, far from its ends' own added mass: force (rho + m) V (v . grad) v plus
    m V u dw/dz, m the added mass per volume (Rainey 1989, equation 5.4; Taylor 1928, Proceedings of the Royal Society A 120).
    """
    member = {"name": "rod", "group": "column", "shape": "circ", "d": 0.8, "rA": [0, 0, -6.0], "rB": [0, 0, -5.0]}
    sea, mass = bichromatic(frequencies=(0.1, 0.13), heights=(3.0, 2.0), heading=0.0), 0.7
    model = built(member, Ca_t=mass)
    volume = np.pi / 4 * 0.8**2
    for time in (1.0, 4.0):
        waves = flow(sea, time, np.array([[0.0], [0.0], [-5.5]]), None, True)
        (u, _, w), slope = np.asarray(waves.velocity)[:, 0], np.asarray(waves.gradient)[:, :, 0]
        on_strips = RHO * volume * ((1 + mass) * (slope @ [u, 0, w])[0] + mass * u * slope[2, 2])
        ends = [np.asarray(flow(sea, time, np.array([[0.0], [0.0], [z]])).velocity)[:, 0] for z in (-6.0, -5.0)]
        at_ends = RHO * mass * volume * (ends[0][0] * ends[0][2] - ends[1][0] * ends[1][2])
        with_forces = wrench(with_share(model, 1.0), np.zeros(6), np.zeros(6), sea, time)[0]
        none = wrench(with_share(model, 0.0), np.zeros(6), np.zeros(6), sea, time)[0]
        assert_allclose((with_forces - none)[0], on_strips + at_ends, rtol=3e-3)


def test_computed_excitation_takes_them_away() -> None:
    """A whole table has the second-order forces of its program beside it: strips have none."""
    from jaxhydro.loads import ComputedExcitation
    from jaxhydro.waves.excitation import Excitation

    table = Excitation.of(np.linspace(0.2, 2.0, 5), np.zeros((6, 5), complex))
    model = built(*SUBMERGED[:1])
    sea = bichromatic()
    differences = []
    for share in (0.0, 1.0):
        plain, whole = (
            with_share(model, second).with_effect(ComputedExcitation(table, jnp.asarray(share))) for second in (0.0, 1.0)
        )
        waves = whole.through(sea)
        velocity = np.array([0.3, -0.2, 0.4, 0.01, 0.02, -0.01])
        differences.append(
            wrench(whole, np.zeros(6), velocity, waves, 3.0)[0] - wrench(plain, np.zeros(6), velocity, waves, 3.0)[0]
        )
    assert np.abs(differences[0]).max() > 1e4
    assert_allclose(differences[1], 0.0, atol=1e-9 * float(np.abs(differences[0]).max()))


@pytest.mark.parametrize("name", CASES)
def test_raft(name: str) -> None:
    """Difference-frequency forces on a column are RAFT's, held or moving without rotation, within 0.3 %.

    RAFT expands about the mean position what here comes of strips that move and of their wetted length. It leaves out the
    pressure -rho v²/2 of the undisturbed waves on the end, which is added to its forces here.
    """
    stored = json.loads((Path(__file__).parents[2] / "benchmarks" / "raft" / "slender_body.json").read_text("utf-8"))
    row, case, small = stored["forces"][name], CASES[name], 0.02
    expected = np.array(row["real"]) + 1j * np.array(row["imaginary"])
    own = case["member"]
    member = {"name": "c", "group": "column", **{key: own[key] for key in ("shape", "d", "rA", "rB")}, "points": 4}
    model = with_share(built(member | {"elements": 8}, Ca_t=own["Ca"], Ca_z=own["CaEnd"]), 1.0)
    omega = 2 * np.pi * np.array(FREQUENCY)
    waves = jh.waves.components(np.full(2, small), omega, WATER, heading=0.0, phase=0.0)
    bound = jh.waves.bound_waves(waves, WATER, ("difference",), set_down=False)
    sea = jh.WaveSea(jh.waves.PlaneWaves.free(waves, WATER), WATER, bound=bound)
    amplitude = small * motions(case)
    time = np.arange(400) * 200.0 / 400  # a whole number of periods of both waves and of their sum and difference
    turn = np.exp(1j * np.outer(omega, time))
    position, velocity, acceleration = (((1j * omega) ** n * amplitude @ turn).real.T for n in range(3))
    wrenches = jax.vmap(wrench.__wrapped__, (None, 0, 0, None, 0))
    force, added = (np.asarray(x) for x in eqx.filter_jit(wrenches)(model, position, velocity, sea, time))
    force = force - np.einsum("tij,tj->ti", added, acceleration)
    bottom = np.array(own["rA"]) + position[:, :3]
    at_end = one_program(jax.vmap(lambda t, x: sea.flow(t, x[:, None]).velocity[:, 0]))(time, bottom)
    left_out = -0.5 * RHO * np.pi / 4 * own["d"] ** 2 * (np.asarray(at_end) ** 2).sum(axis=1)
    force[:, 2] -= left_out
    moment_arm = np.cross(np.array(own["rA"]), np.stack([0 * left_out, 0 * left_out, left_out], axis=1))
    force[:, 3:] -= moment_arm
    drift = 2 * np.mean(force * np.exp(-1j * (omega[0] - omega[1]) * time)[:, None], axis=0) / small**2
    for part in (slice(0, 3), slice(3, 6)):
        assert_allclose(drift[part], expected[part], atol=3e-3 * np.abs(expected[part]).max())
