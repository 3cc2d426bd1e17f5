"""Added mass and radiation along the axes of the body or of the earth, by `directions`."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

import jaxhydro as jh
from jaxhydro.dynamics.statics import linearised
from jaxhydro.loads import ComputedRadiation
from jaxhydro.platform.schema import Platform
from jaxhydro.rotations import rotation
from jaxhydro.waves.sea import StillWater

ADDED = np.diag([1e6, 2e6, 2e7, 1e9, 2e9, 5e8])  # kg, kg m2: a barge's, whose heave has twenty times surge's
ADDED[0, 4] = ADDED[4, 0] = 3e6
ATTITUDE = np.array([0.0, 0.0, 0.0, 0.1, 0.3, 0.2])


def model(directions: str) -> jh.Model:
    """A body without members, which added mass and radiation alone tell from a rigid one."""
    inertia = {"Ixx": 7e8, "Iyy": 7e8, "Izz": 1e9}
    platform = {
        "name": "box",
        "water": {"density": 1025.0, "depth": 150.0},
        "rigid_body": {"mass": 6e6, "centre_of_mass": [0.0, 0.0, 0.0], "inertia": inertia},
        "added_mass": {"A11": 1e6, "A22": 2e6, "A33": 2e7, "A44": 1e9, "A55": 2e9, "A66": 5e8, "A15": 3e6},
        "hydrostatics": {"C33": 1.6e7, "C44": 5e8, "C55": 5e8, "linear": True},
        "mooring": {"kind": "none"},
        "directions": directions,
    }
    built = jh.build(Platform.model_validate(platform))
    drive = jnp.asarray(np.eye(6)[:1])  # one state, driven by the velocity in surge
    memory = ComputedRadiation(-jnp.ones((1, 1)), drive, 1e5 * jnp.asarray(np.eye(6)[:, :1]), jnp.asarray(1.0))
    return built.with_effect(memory)


def turn() -> np.ndarray:
    return np.kron(np.eye(2), np.asarray(rotation(jnp.asarray(ATTITUDE[3:]))))


@pytest.mark.parametrize("directions", ["body", "earth"])
def test_added_mass_of_a_leaning_body(directions: str) -> None:
    """Along earth axes it turns against the body: T^T A T in body axes."""
    box = model(directions)
    mass, _ = linearised(box, jnp.asarray(ATTITUDE))
    expected = ADDED if directions == "body" else turn().T @ ADDED @ turn()
    assert_allclose(np.asarray(mass - box.body.mass_matrix()), expected, atol=1e-9 * ADDED.max())


@pytest.mark.parametrize("directions", ["body", "earth"])
def test_radiation_of_a_leaning_body(directions: str) -> None:
    """The memory is driven by the velocity along its axes, and pushes along them."""
    box, velocity = model(directions), np.array([1.0, 2.0, 3.0, 0.0, 0.0, 0.0])
    rest = box.rest()
    filled = tuple(jnp.ones(1) if isinstance(load, ComputedRadiation) else own for load, own in zip(box.loads, rest.memory))
    state = eqx.tree_at(lambda s: (s.position, s.velocity, s.memory), rest, (jnp.asarray(ATTITUDE), velocity, filled))
    now = box.instant(jnp.zeros(()), state, StillWater())
    index = next(i for i, load in enumerate(box.loads) if isinstance(load, ComputedRadiation))
    action = box.loads[index].act(now, filled[index])
    along = np.eye(6) if directions == "body" else turn()
    assert_allclose(np.asarray(action.body_force), along.T @ (-1e5 * np.eye(6)[0]), atol=1e-6)
    assert float(action.memory_rate[0]) == pytest.approx(-1.0 + (along @ velocity)[0], rel=1e-12)


def test_earth_axes_do_not_drift_a_barge() -> None:
    """The added mass of heave pushes a leaning body sideways along body axes only, by A33 a3 times the lean."""
    pushed = {}
    for directions in ("body", "earth"):
        box = model(directions)
        state = eqx.tree_at(lambda s: s.position, box.rest(), jnp.array([0.0, 0.0, 1.0, 0.0, 0.1, 0.0]))
        rate = np.asarray(box.rate(jnp.zeros(()), state, StillWater()).velocity)
        earth = np.asarray(rotation(jnp.array([0.0, 0.1, 0.0]))) @ rate[:3]
        pushed[directions] = abs(earth[0] / earth[2])
    assert pushed["earth"] < 0.2 * pushed["body"]
