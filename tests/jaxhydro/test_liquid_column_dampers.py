"""Liquid column dampers against conservation of energy and the published equation."""

import itertools
from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxhydro.errors import InputError
from jaxhydro.input_schema import validate
from jaxhydro.loads import LiquidColumnDampers
from jaxhydro.platform.schema import Platform
from jaxhydro.rotations import rotation

GRAVITY, AREA, WIDTH, HEIGHT, DENSITY = 9.81, 2.5, 20.0, 6.0, 1025.0
LENGTH, LINE = WIDTH + 2 * HEIGHT, DENSITY * AREA
POINT, ALONG = (3.0, -4.0, -12.0), (0.8, 0.6, 0.0)
DAMPER: dict[str, Any] = {
    "name": "tank",
    "point": [0, 0, -10],
    "direction": [1, 0, 0],
    "width": WIDTH,
    "column": HEIGHT,
    "area": AREA,
    "head_loss": 3.0,
}
DATA: dict[str, Any] = {
    "name": "damped",
    "water": {"density": 1000.0, "depth": 200.0},
    "rigid_body": {"mass": 4e6, "centre_of_mass": [0, 0, 0], "inertia": {"Ixx": 5e8, "Iyy": 5e8, "Izz": 8e8}},
    "liquid_column_dampers": [DAMPER],
}


def damper(point: Any = POINT, along: Any = ALONG, loss: float = 0.0) -> LiquidColumnDampers:
    sizes = jnp.array([[WIDTH, HEIGHT, DENSITY]])
    return LiquidColumnDampers(("a",), jnp.array([point]), jnp.array([along]), sizes, {"a": AREA}, {"a": loss})


def instant(turn: jax.Array, velocity: jax.Array) -> Any:
    return SimpleNamespace(rotation=turn, velocity=velocity, environment=SimpleNamespace(gravity=GRAVITY))


def tube(n: int = 400) -> tuple[np.ndarray, np.ndarray]:
    """Middles and vectors (m) of short pieces of the tube, along the flow."""
    point, along, up = np.array(POINT), np.array(ALONG), np.array([0.0, 0.0, 1.0])
    low = [point - 0.5 * WIDTH * along, point + 0.5 * WIDTH * along]
    corners = [low[0] + HEIGHT * up, low[0], low[1], low[1] + HEIGHT * up]
    share = (np.arange(n) + 0.5) / n
    middles = [a + share[:, None] * (b - a) for a, b in itertools.pairwise(corners)]
    pieces = [np.tile((b - a) / n, (n, 1)) for a, b in itertools.pairwise(corners)]
    return np.concatenate(middles), np.concatenate(pieces)


def test_energy_is_conserved_without_losses() -> None:
    """Energy of the liquid, by pieces of the tube: velocity of the hull there and of the flow."""
    load, rng = damper(), np.random.default_rng(7)
    places, pieces = map(jnp.asarray, tube())
    lengths = jnp.linalg.norm(pieces, axis=1)
    along, up = jnp.array(ALONG), jnp.array([0.0, 0.0, 1.0])

    def energy(down: jax.Array, height: jax.Array, motion: jax.Array, state: jax.Array) -> jax.Array:
        rise, momentum = state
        hull = motion[:3] + jnp.cross(motion[3:], places)
        rising = (momentum - (hull * pieces).sum()) / LENGTH
        flow = hull + rising * pieces / lengths[:, None]
        kinetic = 0.5 * (lengths * (flow**2).sum(axis=1)).sum()
        moment = (lengths[:, None] * places).sum(axis=0) + rise * WIDTH * along + rise**2 * up
        return LINE * (kinetic + GRAVITY * (LENGTH * height + down @ moment))

    @jax.jit
    def powers(
        angles: jax.Array, velocity: jax.Array, acceleration: jax.Array, memory: jax.Array
    ) -> tuple[jax.Array, jax.Array]:
        """Rate of the energy, and power of the forces on the hull (W)."""
        zenith = rotation(angles)[2]  # the earth's z axis in body axes turns against the hull
        action = load.act(instant(rotation(angles), velocity), memory)
        on_hull = action.body_force - action.added_mass @ acceleration
        rates = acceleration - jnp.concatenate([jnp.cross(velocity[3:], velocity[:3]), jnp.zeros(3)])
        at = (zenith, jnp.zeros(()), velocity, memory[:, 0])
        change = (jnp.cross(zenith, velocity[3:]), zenith @ velocity[:3], rates, action.memory_rate[:, 0])
        return jax.jvp(energy, at, change)[1], on_hull @ velocity

    for _ in range(3):
        change, power = powers(*(rng.uniform(-1, 1, n) for n in (3, 6, 6)), rng.uniform(-2, 2, (2, 1)))
        assert float(change) == pytest.approx(-float(power), rel=1e-5)  # of the pieces: 400 to a rod


def test_the_published_equation() -> None:
    """Surge alone: L y'' + xi/2 |y'| y' + 2 g y = -B x'', and the hull's force is -(rho A L x'' + rho A B y'')."""
    load = damper(point=(0.0, 0.0, -10.0), along=(1.0, 0.0, 0.0), loss=3.0)
    rise, rising, speed, acceleration = 0.7, -0.4, 0.9, 0.3
    velocity = jnp.zeros(6).at[0].set(speed)
    memory = jnp.array([[rise], [WIDTH * speed + LENGTH * rising]])
    action = jax.jit(lambda memory: load.act(instant(jnp.eye(3), velocity), memory))(memory)
    assert np.asarray(action.memory_rate)[0, 0] == pytest.approx(rising, rel=1e-12)
    swing = (float(action.memory_rate[1, 0]) - WIDTH * acceleration) / LENGTH  # y'', as p = B x' + L y'
    expected = (-WIDTH * acceleration - 1.5 * abs(rising) * rising - 2 * GRAVITY * rise) / LENGTH
    assert swing == pytest.approx(expected, rel=1e-12)
    force = float(action.body_force[0] - action.added_mass[0, 0] * acceleration)
    assert force == pytest.approx(-LINE * (LENGTH * acceleration + WIDTH * swing), rel=1e-12)


def test_its_own_frequency_and_weight() -> None:
    """(2 g/L)^0.5 with the hull held; at rest the weight of the liquid, and its mass in heave."""
    load = damper(along=(1.0, 0.0, 0.0))
    still = instant(jnp.eye(3), jnp.zeros(6))
    rate = jax.jit(jax.jacfwd(lambda memory: load.act(still, memory[:, None]).memory_rate[:, 0]))
    slope = np.asarray(rate(jnp.full(2, 1e-9)))
    assert np.abs(np.linalg.eigvals(slope).imag) == pytest.approx([np.sqrt(2 * GRAVITY / LENGTH)] * 2, rel=1e-12)
    action = jax.jit(lambda memory: load.act(still, memory))(load.rest())
    assert float(action.body_force[2]) == pytest.approx(-LINE * LENGTH * GRAVITY, rel=1e-12)
    assert float(action.added_mass[2, 2]) == pytest.approx(LINE * LENGTH, rel=1e-12)
    held = np.asarray(action.added_mass) + load.retardation(0.5).imag / 0.5
    assert held[0, 0] == pytest.approx(LINE * LENGTH, rel=1e-12)


MISTAKES: list[tuple[dict[str, Any], str]] = [
    ({"direction": [1, 0, 0.1]}, "direction: expected a horizontal vector that is not 0, found [1.0, 0.0, 0.1]"),
    ({"area": 0.0}, "area: expected a number > 0, found 0.0"),
    ({"head_loss": -1.0}, "head_loss: expected a number >= 0, found -1.0"),
]


@pytest.mark.parametrize(("key", "expected"), MISTAKES)
def test_mistakes_are_told(key: dict[str, Any], expected: str) -> None:
    with pytest.raises(InputError) as error:
        validate(Platform, DATA | {"liquid_column_dampers": [DAMPER | key]}, "damped")
    assert f"liquid_column_dampers[0].{expected}" in str(error.value)
