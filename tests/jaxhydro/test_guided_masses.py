"""Masses that follow the platform in some directions only, against Lagrange's equations, a point mass and closed forms."""

import json
import math
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import one_program
from scipy.integrate import solve_ivp

import jaxhydro as jh
from calibration import calibrate, load_campaign
from calibration.parameters.families import parameter_family
from calibration.parameters.space import default_free, parameter_space
from calibration.results.applied_calibration import CAMPAIGN_PARAMETERS
from jaxhydro.dynamics.statics import equilibrium, natural_modes
from jaxhydro.errors import InputError
from jaxhydro.input_schema import validate
from jaxhydro.loads import GuidedMasses
from jaxhydro.platform.schema import Platform
from jaxhydro.rotations import rotation

MASS, TURNING, CARRIAGE = 9e5, 6e7, 2e5  # kg, kg m2, kg
SURGE, PITCH = 5e4, 3e7  # N/m, N m/rad
POINT = [3.0, 1.0, 8.0]  # m


def document(*guided: dict, **changes: Any) -> dict:
    """A body on springs with its centre of mass at the reference point."""
    return {
        "name": "on rails",
        "water": {"density": 1000.0, "depth": 200.0, "gravity": 9.81},
        "rigid_body": {"mass": MASS, "centre_of_mass": [0, 0, 0], "inertia": {"Ixx": 5e7, "Iyy": TURNING, "Izz": 8e7}},
        "stiffness": {"C11": SURGE, "C22": 2 * SURGE, "C44": PITCH, "C55": PITCH, "C66": PITCH},
        "hydrostatics": {"C33": 4e5},
        "guided_masses": list(guided),
    } | changes


def carriage(*moves: str, point: Any = POINT, **keys: Any) -> dict:
    return {"name": "carriage", "mass": CARRIAGE, "point": list(point), "moves": list(moves)} | keys


def build(*guided: dict, **changes: Any) -> jh.Model:
    return jh.build(validate(Platform, document(*guided, **changes), "platform.yaml"))


@one_program
def acceleration(model: jh.Model, position: Any, velocity: Any) -> jax.Array:
    return model.rate(jnp.zeros(()), jh.State(position, velocity, model.rest().memory), jh.StillWater()).velocity


def rates(model: jh.Model, position: Any, velocity: Any) -> np.ndarray:
    return np.asarray(acceleration(model, np.asarray(position, float), np.asarray(velocity, float)))


def samples(n: int = 4) -> tuple[np.ndarray, np.ndarray]:
    """Attitudes of up to 40 degrees and lively velocities."""
    rng = np.random.default_rng(3)
    return rng.uniform(-0.7, 0.7, (n, 6)), rng.uniform(-1, 1, (n, 6))


@pytest.mark.slow
@pytest.mark.parametrize("moves", [("x",), ("y",), ("z",), ("x", "z")])
def test_lagranges_equations(moves: tuple[str, ...]) -> None:
    """Finite rotations: the kinetic energy of body and carriage differentiated by position and rate. Springs are left out."""
    model = build(carriage(*moves))
    loads = tuple(load for load in model.loads if isinstance(load, GuidedMasses))
    free = jh.Model(model.environment, model.body, model.hull, loads)
    axes = np.array(["xyz".index(axis) for axis in moves])

    def energy(q: jax.Array, rate: jax.Array) -> jax.Array:
        body = jh.Model.body_velocity(q, rate)
        point = jax.jvp(lambda p: p[:3] + rotation(p[3:]) @ jnp.array(POINT), (q,), (rate,))[1]
        return 0.5 * body @ model.body.mass_matrix() @ body + 0.5 * CARRIAGE * (point[axes] ** 2).sum()

    for q, rate in zip(*map(jnp.asarray, samples()), strict=True):
        mass = jax.hessian(energy, 1)(q, rate)
        cross = jax.jacfwd(jax.grad(energy, 1), 0)(q, rate)
        acceleration = jnp.linalg.solve(mass, jax.grad(energy)(q, rate) - cross @ rate)
        velocity, expected = jax.jvp(jh.Model.body_velocity, (q, rate), (rate, acceleration))
        assert_allclose(rates(free, q, velocity), expected, rtol=1e-10, atol=1e-12)


def test_along_all_axes_it_is_a_point_of_the_body() -> None:
    """With its weight, which the platform carries then: another part of the rigid body."""
    rows = document()["rigid_body"]
    parts = [rows | {"name": "hull"}, {"name": "point", "mass": CARRIAGE, "centre_of_mass": POINT}]
    changes = {"hydrostatics": {"displaced_volume": 1100.0, "C33": 4e5}}
    guided = build(carriage("x", "y", "z", weight=True), **changes)
    rigid = build(**changes, rigid_body={"parts": parts})
    for position, velocity in zip(*samples(), strict=True):
        assert_allclose(rates(guided, position, velocity), rates(rigid, position, velocity), rtol=1e-10, atol=1e-12)


def test_two_bodies_by_hand() -> None:
    """Surge and pitch of a body and a carriage at (a, 0, c), from Lagrange's equations worked out on paper:
    (M + m) x'' + m s t'' + m s' t'^2 = -k x, (I + m s^2) t'' + m s x'' + m s s' t'^2 = -K t, s = c cos t - a sin t."""
    a, c = 3.0, 8.0
    model = build(carriage("x", point=[a, 0.0, c]))

    def rate(_: float, y: np.ndarray) -> list[float]:
        x, t, speed, turn = y
        s, slope = c * math.cos(t) - a * math.sin(t), -c * math.sin(t) - a * math.cos(t)
        matrix = [[MASS + CARRIAGE, CARRIAGE * s], [CARRIAGE * s, TURNING + CARRIAGE * s**2]]
        force = np.array([-SURGE * x, -PITCH * t]) - CARRIAGE * slope * turn**2 * np.array([1.0, s])
        return [speed, turn, *np.linalg.solve(matrix, force)]

    times = np.arange(0.0, 60.0, 1.0)
    expected = solve_ivp(rate, (0, 60), [4.0, 0.5, 0, 0], t_eval=times, rtol=1e-11, atol=1e-12).y
    motion = jh.free_decay(model, {"surge": 4.0, "pitch": 0.5}, times, step=0.02)
    assert_allclose(motion["surge"], expected[0], atol=1e-5)
    assert_allclose(motion["pitch"], expected[1], atol=1e-6)
    assert_allclose(motion["heave"], 0.0, atol=1e-9)


def periods_of(c: float) -> list[float]:
    """Of small motion: (k - w^2 (M + m)) (K - w^2 (I + m c^2)) = (w^2 m c)^2."""
    m, j, coupled = MASS + CARRIAGE, TURNING + CARRIAGE * c**2, CARRIAGE * c
    squares = np.roots([m * j - coupled**2, -(SURGE * j + PITCH * m), SURGE * PITCH])
    return sorted(2 * math.pi / np.sqrt(squares))


@pytest.mark.parametrize("c", [-6.0, 0.0, 8.0])
def test_natural_periods_in_closed_form(c: float) -> None:
    modes = natural_modes(build(carriage("x", point=[0, 0, c])))
    pitch, surge = sorted([modes.of("surge"), modes.of("pitch")])
    assert_allclose([pitch, surge], periods_of(c), rtol=1e-9)
    without = natural_modes(build())
    for dof in ("heave", "roll", "sway", "yaw"):
        assert modes.of(dof) == pytest.approx(without.of(dof), rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize(("axis", "entry"), [("x", "A11"), ("y", "A22"), ("z", "A33")])
def test_at_the_reference_point_it_is_added_mass(axis: str, entry: str) -> None:
    """Of an upright platform. Added mass turns with the body, a guide does not."""
    guided = build(carriage(axis, point=[0, 0, 0]))
    added = build(added_mass={entry: CARRIAGE})
    still, velocity = np.zeros(6), np.array([1.0, 2, 3, 0, 0, 0])  # m/s, rad/s
    position = np.array([3.0, 2.0, 1.0, 0, 0, 0])
    assert_allclose(rates(guided, position, velocity), rates(added, position, velocity), rtol=1e-14)
    for dof in ("surge", "sway", "heave"):
        assert natural_modes(guided).of(dof) == pytest.approx(natural_modes(added).of(dof), rel=1e-12)
    turned = still + np.array([3.0, 2, 1, 0, 0, math.pi / 2])
    if axis == "x":  # along the body's y then
        assert_allclose(rates(guided, turned, still), rates(build(added_mass={"A22": CARRIAGE}), turned, still), atol=1e-12)


def test_weight_is_carried_only_where_it_is_stated() -> None:
    """Its rails have it, else: the platform rests where it did. Stated, it goes down and leans by the closed form."""
    plain, rails = build(), build(carriage("z"))
    assert_allclose(equilibrium(rails), equilibrium(plain), atol=1e-12)
    volume = {"hydrostatics": {"displaced_volume": MASS / 1000.0, "C33": 4e5}}
    heavy = equilibrium(build(carriage("z", point=[3.0, 0, 0], weight=True), **volume))
    weight = CARRIAGE * 9.81
    assert heavy[2] == pytest.approx(-weight / 4e5, rel=1e-9)
    pitch = float(heavy[4])
    assert pitch * PITCH == pytest.approx(3.0 * math.cos(pitch) * weight, rel=1e-6)
    # a volume that nothing states balances it
    assert float(equilibrium(build(carriage("z", point=[0, 0, 0], weight=True)))[2]) == pytest.approx(0.0, abs=1e-9)


def test_size_and_balance_are_those_of_the_hull() -> None:
    """Froude's scale and the mass of the body do not know of it."""
    plain, rails = build(), build(carriage("x"))
    assert float(rails.size) == float(plain.size) and float(rails.body.mass) == MASS
    about = rails.about("guided_masses.carriage.mass")
    assert about.unit == "kg" and about.lower == 0 and "follows the platform along x" in about.meaning
    two_masses = build(carriage("x", "y"), {**carriage("z"), "name": "a rod", "mass": 5.0})
    assert "along x and y" in two_masses.about("guided_masses.carriage.mass").meaning
    assert float(two_masses.values["guided_masses.a rod.mass"]) == 5.0


def test_masses_keep_their_places_through_jax() -> None:
    """JAX sorts the keys of mappings; a mass is still that of its own point."""
    guided = ({**carriage("x"), "name": "b"}, {**carriage("z", point=[-9, 2, 1]), "name": "a", "mass": 7e4})
    (position, *_), (velocity, *_) = samples(1)
    model, reordered = build(*guided), build(*guided[::-1])
    sorted_keys = jax.tree.map(lambda x: x, model)
    assert_allclose(rates(model, position, velocity), rates(reordered, position, velocity), rtol=1e-12)
    assert_allclose(rates(sorted_keys, position, velocity), rates(reordered, position, velocity), rtol=1e-12)
    assert "along z" in sorted_keys.about("guided_masses.a.mass").meaning


@pytest.mark.slow
def test_a_decay_finds_the_mass(tmp_path: Path) -> None:
    """Calibrated where it is asked for, as any parameter; left alone where it is not."""
    label = "guided_masses.carriage.mass"
    damped = document(carriage("x"), linear_damping={"B11": 2e4, "B55": 4e6})
    model = jh.build(validate(Platform, damped, "platform.yaml"))
    assert (
        label not in default_free(model, ["surge"])
        and label.startswith(CAMPAIGN_PARAMETERS)
        and parameter_family(label, ()) == "inertia"
    )
    assert parameter_space(model, [label]).moves_equilibrium
    times = np.arange(0.0, 150.0, 0.5)
    motion = jh.free_decay(model.with_values({label: 3.3e5}), {"surge": 5.0}, times, step=0.1)
    np.savetxt(tmp_path / "surge.csv", np.stack([times, motion["surge"]], -1), "%.9g", ",", header="t,surge", comments="")
    (tmp_path / "platform.yaml").write_text(json.dumps(damped))
    manifest = {
        "name": "rails",
        "platform": "platform.yaml",
        "channels": {"time": {"column": "t", "unit": "s"}, "surge": {"column": "surge", "unit": "m"}},
        "tests": [{"id": "one", "kind": "decay", "degree_of_freedom": "surge", "file": "surge.csv"}],
        "calibrate": {"free": ["guided_masses.*", "linear_damping.B11"]},
    }
    (tmp_path / "campaign.yaml").write_text(json.dumps(manifest))
    result = calibrate(load_campaign(tmp_path))
    assert result.parameters[label].value == pytest.approx(3.3e5, rel=1e-3)


BROKEN = [
    ({"mass": 0.0}, "guided_masses[0].mass: expected a number > 0, found 0.0"),
    ({"mass": -1.0}, "guided_masses[0].mass: expected a number > 0, found -1.0"),
    ({"moves": []}, "guided_masses[0].moves: expected a list of one of x, y, z (1 or more), found []"),
    ({"moves": ["surge"]}, "guided_masses[0].moves[0]: expected one of x, y, z, found 'surge'"),
    ({"moves": ["x", "x"]}, "guided_masses[0].moves: expected each direction once, found ['x', 'x']"),
    ({"moves": None}, "guided_masses[0].moves: expected a list of"),
    ({"point": [1, 2]}, "guided_masses[0].point: expected a list of 3 numbers, found [1, 2]"),
    ({"weight": "no"}, "guided_masses[0].weight: expected true or false, found 'no'"),
    ({"weight": True}, "guided_masses[0].weight: expected false for a mass that does not move along z, found true. Its guides"),
    ({"name": ""}, "guided_masses[0].name: expected text that is not empty"),
    ({"direction": "x"}, "guided_masses[0].direction: expected a known key (name, mass, point, moves, weight)"),
]


@pytest.mark.parametrize(("change", "words"), BROKEN, ids=range(len(BROKEN)))
def test_one_mistake_is_one_line(change: dict, words: str) -> None:
    with pytest.raises(InputError) as caught:
        build(carriage("x") | change)
    (problem,) = caught.value.problems
    assert words in str(problem)


def test_two_of_one_name_are_told() -> None:
    with pytest.raises(InputError, match=r"guided_masses\[1\]\.name: expected a name of its own, found 'carriage' again"):
        build(carriage("x"), carriage("y"))
    assert build(carriage("x") | {"moves": "x"}).values.keys() == build(carriage("x")).values.keys()
