"""Steady current of a profile: against the uniform one, quadrature over depth, and mistakes in the platform file."""

import math

import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad
from test_loads import COEFFICIENTS, COLUMN, PONTOON, RHO, G, build, force, only
from test_water_effects import POSITION, VELOCITY, irregular

import jaxhydro as jh
from jaxhydro.errors import InputError
from jaxhydro.input_schema import validate
from jaxhydro.loads import MorisonDrag
from jaxhydro.platform.current_schema import SteadyCurrent
from jaxhydro.water import Current, CurrentProfile

DEPTH = 200.0
DIAMETER, DRAUGHT = 10.0, 20.0  # m, of COLUMN in the water


def flowing(**current) -> jh.Model:
    water = {"density": RHO, "depth": DEPTH, "gravity": G, "current": current}
    return only(build({**COLUMN, "elements": 40}, water=water), MorisonDrag, CurrentProfile)


def test_a_uniform_profile_is_the_uniform_current() -> None:
    """At any position and velocity, with columns, pontoons and ends, in still water and in a sea."""
    plain = only(build(COLUMN, PONTOON), MorisonDrag)
    uniform = plain.with_effect(Current(jnp.asarray(0.9), jnp.asarray(-1.2)))
    profile = CurrentProfile(jnp.array([-100.0, 0.0]), jnp.array([[0.9, 0.9], [-1.2, -1.2]]), jnp.ones(()))
    for sea in (None, irregular()):
        expected = force(uniform, VELOCITY, POSITION, sea)
        assert_allclose(force(plain.with_effect(profile), VELOCITY, POSITION, sea), expected, rtol=1e-10, atol=1e-6)


@pytest.mark.parametrize(
    ("current", "speed"),
    [
        ({"speed": 1.5, "exponent": 1.0 / 7.0}, lambda z: 1.5 * (1 + z / DEPTH) ** (1 / 7)),
        ({"levels": [{"z": 0, "speed": 1.5}, {"z": -10, "speed": 0.5}, {"z": -40, "speed": 0.2}]}, lambda z: level(z)),
    ],
)
def test_drag_on_a_column_by_quadrature(current: dict, speed) -> None:
    """1/2 rho Cd D int U^2 dz, and its moment about the reference point."""
    drag = force(flowing(**current))
    scale = 0.5 * RHO * COEFFICIENTS["Cd_t"] * DIAMETER
    assert_allclose(drag[0], scale * quad(lambda z: speed(z) ** 2, -DRAUGHT, 0)[0], rtol=3e-4)
    assert_allclose(drag[4], scale * quad(lambda z: z * speed(z) ** 2, -DRAUGHT, 0)[0], rtol=1e-3)


def level(z: float) -> float:
    return 1.5 + 0.1 * z if z > -10 else 0.5 + 0.01 * (z + 10)


def test_the_heading_is_where_it_flows() -> None:
    drag = force(flowing(speed=1.0, heading=30.0))
    assert math.degrees(math.atan2(drag[1], drag[0])) == pytest.approx(30.0, abs=1e-6)
    assert np.hypot(drag[0], drag[1]) == pytest.approx(0.5 * RHO * COEFFICIENTS["Cd_t"] * DIAMETER * DRAUGHT, rel=1e-3)


@pytest.mark.parametrize(
    ("current", "words"),
    [
        ({}, "either `speed` or `levels`"),
        ({"speed": 1.0, "levels": [{"z": 0, "speed": 1.0}]}, "found both"),
        (
            {"levels": [{"z": -10, "speed": 1.0}, {"z": 0, "speed": 1.0}]},
            r"levels\[1\]\.z: expected levels from the surface",
        ),
        ({"levels": [{"z": 0, "speed": 1.0}], "exponent": 0.1}, "exponent: expected nothing beside `levels`"),
        ({"speed": -1.0}, "speed"),
    ],
)
def test_mistakes_are_told(current: dict, words: str) -> None:
    with pytest.raises(InputError, match=words):
        validate(SteadyCurrent, current, "current")
