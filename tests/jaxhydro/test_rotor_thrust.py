"""Rotor thrust: against a damping matrix, a static force and the power that it takes."""

import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_loads import COLUMN, SPRINGS, build, force, only

import jaxhydro as jh
from jaxhydro.dynamics.statics import equilibrium
from jaxhydro.errors import InputError
from jaxhydro.input_schema import validate
from jaxhydro.loads import LinearDamping, RotorThrust, StaticForce

HUB, THRUST, DAMPING = (-5.0, 1.0, 150.0), 2e6, 1.2e5
VELOCITY = np.array([0.7, -0.3, 0.2, 0.01, -0.02, 0.015])
ALONG = np.array([1.0, 0.0, 0.0, 0.0, 150.0, -1.0])  # e_x, and hub x e_x: speed of the hub is along . velocity


def moored(**changes) -> jh.Model:
    return build(COLUMN, mooring=SPRINGS, **changes)


def test_it_is_a_force_and_a_damping_matrix() -> None:
    """F = T along - b along along' v in body axes, at any position."""
    model = only(moored(rotor={"hub": HUB, "thrust": THRUST, "damping": DAMPING}), RotorThrust)
    for position in (np.zeros(6), np.array([3.0, 1.0, 0.5, 0.1, -0.2, 0.3])):
        acting_force = force(model, VELOCITY, position)
        assert_allclose(acting_force, THRUST * ALONG - DAMPING * ALONG * (ALONG @ VELOCITY), rtol=1e-12, atol=1e-6)


def test_damping_is_that_of_a_matrix() -> None:
    entries = {f"B{i + 1}{j + 1}": DAMPING * ALONG[i] * ALONG[j] for i in range(6) for j in range(6) if ALONG[i] * ALONG[j]}
    rotor = only(moored(rotor={"hub": HUB, "damping": DAMPING}), RotorThrust)
    matrix = only(moored().with_effect(LinearDamping(entries)), LinearDamping)
    assert_allclose(force(rotor, VELOCITY) - force(rotor), force(matrix, VELOCITY) - force(matrix), rtol=1e-12)


@pytest.mark.slow
def test_thrust_moves_the_platform_as_its_force_and_moment() -> None:
    """With a small thrust the platform stays upright, and a force fixed to the earth does the same."""
    small = jnp.asarray(1e3)
    model = jh.load_model("volturnus-s-focal")
    at_rest, thrust = equilibrium(model), equilibrium(model.with_effect(RotorThrust(jnp.array(HUB), small, jnp.zeros(()))))
    fixed = {"surge": small, "pitch": small * HUB[2], "yaw": -small * HUB[1]}
    same = equilibrium(model.with_effect(StaticForce(force=fixed)))
    assert float(thrust[0] - at_rest[0]) > 0
    assert_allclose(thrust - at_rest, same - at_rest, rtol=1e-3, atol=1e-7)  # thrust turns with yaw


def test_the_hub_is_named() -> None:
    data = {"name": "r", "water": {"density": 1025, "depth": 100}, "rigid_body": {"mass": 1.0}, "rotor": {"thrust": 1.0}}
    with pytest.raises(InputError, match=r"rotor\.hub"):
        validate(jh.Platform, data, "r")
    model = moored(rotor={"hub": HUB})
    assert set(jnp.asarray(value).item() for label, value in model.values.items() if label.startswith("rotor.")) == {0.0}
