"""Tuned mass dampers against conservation of energy, Den Hartog's frequencies, and a mass that is held."""

from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxhydro as jh
from jaxhydro.errors import InputError
from jaxhydro.input_schema import validate
from jaxhydro.loads import TunedMassDampers
from jaxhydro.platform.build import build
from jaxhydro.platform.schema import Platform
from jaxhydro.rotations import rotation

GRAVITY, MASS, PERIOD = 9.81, 2e5, 8.0
LINE = np.array([0.6, -0.48, 0.64])
DAMPER: dict[str, Any] = {"name": "tower", "mass": MASS, "point": [2.0, -3.0, 60.0], "direction": [1.0, 0.0, 0.0]}
TUNED = DAMPER | {"period": PERIOD, "damping_ratio": 0.1}
DATA: dict[str, Any] = {
    "name": "damped",
    "water": {"density": 1000.0, "depth": 200.0, "gravity": GRAVITY},
    "rigid_body": {"mass": 4e6, "centre_of_mass": [0, 0, 0], "inertia": {"Ixx": 5e8, "Iyy": 5e8, "Izz": 8e8}},
    "stiffness": {"C11": 2e6, "C22": 2e6, "C44": 3e9, "C55": 3e9, "C66": 1e9},
    "hydrostatics": {"C33": 4e6},
    "tuned_mass_dampers": [TUNED],
}


def damper(direction: Any, ratio: float = 0.0, point: Any = (2.0, -3.0, 60.0)) -> TunedMassDampers:
    points, lines = jnp.array([point], float), jnp.array([direction], float)
    return TunedMassDampers(("a",), points, lines, {"a": MASS}, {"a": PERIOD}, {"a": ratio})


def instant(turn: jax.Array, velocity: jax.Array) -> Any:
    return SimpleNamespace(rotation=turn, velocity=velocity, environment=SimpleNamespace(gravity=GRAVITY))


def test_energy_is_conserved_without_a_damper() -> None:
    """Whatever the hull does: what its forces do to the mass is the change of kinetic energy, spring and height."""
    load, frequency = damper(LINE), 2 * np.pi / PERIOD
    rng = np.random.default_rng(5)
    line, point = jnp.array(LINE), load.points[0]

    def energy(up: jax.Array, height: jax.Array, motion: jax.Array, state: jax.Array) -> jax.Array:
        displaced, speed = state
        position = point + displaced * line
        carried = motion[:3] + jnp.cross(motion[3:], position)
        velocity_of_mass = carried + (speed - line @ carried) * line
        kinetic = 0.5 * velocity_of_mass @ velocity_of_mass
        spring = 0.5 * frequency**2 * displaced**2 - GRAVITY * line[2] * displaced
        return MASS * (kinetic + spring + GRAVITY * (height + up @ position))

    @jax.jit
    def powers(
        angles: jax.Array, velocity: jax.Array, acceleration: jax.Array, memory: jax.Array
    ) -> tuple[jax.Array, jax.Array]:
        """Rate of the energy, and power of the forces on the hull (W)."""
        up = rotation(angles)[2]  # the earth's z axis in body axes turns against the hull
        action = load.act(instant(rotation(angles), velocity), memory)
        on_hull = action.body_force - action.added_mass @ acceleration
        at, rates = (up, jnp.zeros(()), velocity, memory[:, 0]), acceleration_in_body(velocity, acceleration)
        change = (jnp.cross(up, velocity[3:]), up @ velocity[:3], rates, action.memory_rate[:, 0])
        return jax.jvp(energy, at, change)[1], on_hull @ velocity

    for _ in range(3):
        change, power = powers(*(rng.uniform(-1, 1, n) for n in (3, 6, 6)), rng.uniform(-2, 2, (2, 1)))
        assert float(change) == pytest.approx(-float(power), rel=1e-10)


def acceleration_in_body(velocity: jax.Array, acceleration: jax.Array) -> jax.Array:
    """Rates of the components of velocity along body axes, which turn."""
    return acceleration - jnp.concatenate([jnp.cross(velocity[3:], velocity[:3]), jnp.zeros(3)])


def test_frequencies_of_den_hartog() -> None:
    """A hull on a spring in surge: g^4 - g^2 (1 + f^2 (1 + mu)) + f^2 = 0 (Den Hartog 1956, section 3.2)."""
    load, hull, stiffness = damper([1.0, 0.0, 0.0], point=(0.0, 0.0, 0.0)), 4e6, 2e6

    def rates(state: jax.Array) -> jax.Array:
        at, speed, displaced, absolute = state
        velocity = jnp.zeros(6).at[0].set(speed)
        action = load.act(instant(jnp.eye(3), velocity), jnp.array([[displaced], [absolute]]))
        pushed = (action.body_force[0] - stiffness * at) / (hull + action.added_mass[0, 0])
        return jnp.concatenate([jnp.stack([speed, pushed]), action.memory_rate[:, 0]])

    frequencies = np.sort(np.abs(np.linalg.eigvals(np.asarray(jax.jit(jax.jacfwd(rates))(jnp.zeros(4)))).imag))[::2]
    own, ratio = np.sqrt(stiffness / hull), MASS / hull
    tuning = 2 * np.pi / PERIOD / own
    expected = own * np.sqrt(np.sort(np.roots([1.0, -(1 + tuning**2 * (1 + ratio)), tuning**2])))
    assert frequencies == pytest.approx(expected, rel=1e-9)


def test_it_hangs_with_its_weight_where_it_rests() -> None:
    action = jax.jit(lambda memory: damper(LINE, 0.1).act(instant(jnp.eye(3), jnp.zeros(6)), memory))(jnp.zeros((2, 1)))
    weight = np.array([0.0, 0.0, -MASS * GRAVITY])
    expected = np.concatenate([weight, np.cross([2.0, -3.0, 60.0], weight)])
    assert np.asarray(action.body_force) == pytest.approx(expected, abs=1e-6)
    assert not np.asarray(action.memory_rate).round(9).any()


@pytest.mark.slow
def test_hull_periods_are_those_with_the_damper_held() -> None:
    """As with the mass in the rigid body; a note says so, and gives the damper's own period."""
    held = {key: value for key, value in DATA.items() if key != "tuned_mass_dampers"}
    point = DAMPER["point"]
    body = {"name": "hull"} | DATA["rigid_body"]
    mass = {"name": "mass", "mass": MASS, "centre_of_mass": point, "inertia": {"Ixx": 1e-3, "Iyy": 1e-3, "Izz": 1e-3}}
    held["rigid_body"] = {"parts": [body, mass]}
    damped, rigid = (build(validate(Platform, data, "damped")) for data in (DATA, held))
    ours, rigid_periods = (jh.natural_modes(variant, jnp.zeros(6)).period for variant in (damped, rigid))
    assert ours == pytest.approx(rigid_periods, rel=1e-6)
    assert any("tower" in remark.text and "8 s" in remark.text and not remark.warning for remark in damped.remarks)


MISTAKES: list[tuple[dict[str, Any], str]] = [
    ({"stiffness": 1e5}, "tuned_mass_dampers[0]: expected either period or stiffness, found both"),
    ({"damping_ratio": None}, "tuned_mass_dampers[0]: expected either damping_ratio or damping, found neither"),
    ({"direction": [0, 0, 0]}, "tuned_mass_dampers[0].direction: expected a vector that is not 0, found [0.0, 0.0, 0.0]"),
    ({"mass": 0.0}, "tuned_mass_dampers[0].mass: expected a number > 0, found 0.0"),
]


@pytest.mark.parametrize(("key", "expected"), MISTAKES)
def test_mistakes_are_told(key: dict[str, Any], expected: str) -> None:
    with pytest.raises(InputError) as error:
        validate(Platform, DATA | {"tuned_mass_dampers": [TUNED | key]}, "damped")
    assert expected in str(error.value)


def test_stiffness_and_damping_are_other_words_for_period_and_ratio() -> None:
    frequency = 2 * np.pi / PERIOD
    by_stiffness = DAMPER | {"stiffness": MASS * frequency**2, "damping": 0.2 * MASS * frequency}
    platform = validate(Platform, DATA | {"tuned_mass_dampers": [by_stiffness]}, "damped")
    assert platform.tuned_mass_dampers[0].tuning() == pytest.approx((PERIOD, 0.1), rel=1e-12)
    twice = DATA | {"tuned_mass_dampers": [TUNED, TUNED]}
    with pytest.raises(InputError, match=r"tuned_mass_dampers\[1\]\.name: expected a name of its own, found 'tower' again"):
        validate(Platform, twice, "damped")
