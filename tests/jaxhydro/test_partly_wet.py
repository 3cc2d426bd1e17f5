"""Horizontal and inclined members that still water cuts: right where they are level, refused where they are not."""

import copy
import math
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import flow, one_program

import jaxhydro as jh
from jaxhydro.dynamics.model import Model
from jaxhydro.errors import InputError
from jaxhydro.input_schema import validate
from jaxhydro.loads import Buoyancy
from jaxhydro.platform.build import build
from jaxhydro.platform.schema import Platform
from jaxhydro.rotations import rotation

RHO, G = 1025.0, 9.80665


def platform(**member: Any) -> Platform:
    data = {
        "name": "barge",
        "water": {"density": 1025.0, "depth": 100},
        "rigid_body": {"mass": 1e6, "centre_of_mass": [0, 0, 0.0], "inertia": {"Ixx": 1e8, "Iyy": 2e8, "Izz": 2e8}},
        "members": [{"name": "low", "shape": "circ", "d": 2.0, "rA": [0, 0, -9], "rB": [0, 9, -9]}, {"name": "box"} | member],
        "coefficients": {"box": {}, "low": {}},
        "mooring": {"kind": "none"},
    }
    return validate(Platform, copy.deepcopy(data), "barge")


BOX = {"shape": "rect", "d": [8.0, 3.0]}
TUBE = {"shape": "circ", "d": 3.0}


@pytest.mark.parametrize(
    "member, share",
    [
        (BOX | {"rA": [-20, 0, -0.5], "rB": [20, 0, -0.5], "gamma": 30.0}, "58%"),
        (BOX | {"rA": [-20, 0, -5.0], "rB": [20, 0, 0.5], "gamma": 30.0}, "69%"),
        (TUBE | {"rA": [10, 0, -2.0], "rB": [20, 0, 1.0], "heading": [0, 120, 240]}, "59%"),
    ],
    ids=["tilted", "brace", "three"],
)
def test_an_inclined_pontoon_that_still_water_cuts_is_refused(member: dict, share: str) -> None:
    """Once per member, with the way out."""
    with pytest.raises(InputError) as error:
        build(platform(**member))
    (problem,) = error.value.problems
    assert problem.where == "members[1]" and share in problem.found and "'box'" in problem.found
    assert "level or upright members" in problem.hint


@pytest.mark.parametrize(
    "member",
    [
        BOX | {"rA": [-20, 0, -1.55], "rB": [20, 0, -1.55]},
        BOX | {"rA": [-20, 0, 3.0], "rB": [20, 0, 3.0]},
        TUBE | {"rA": [-20, 0, -1.4], "rB": [20, 0, -1.4]},
        TUBE | {"rA": [-20, 0, -25.0], "rB": [20, 0, 0.0]},
        BOX | {"rA": [0, 0, -5.0], "rB": [0, 0, 5.0]},
        TUBE | {"rA": [-3, 0, -5.0], "rB": [3, 0, 5.0]},
    ],
    ids=["under", "above", "nearly under", "cut brace", "upright", "steep"],
)
def test_what_is_wet_or_dry_or_steep_is_not(member: dict) -> None:
    build(platform(**member))


def alone(**member: Any) -> Model:
    data = {
        "name": "barge",
        "water": {"density": RHO, "depth": 200.0},
        "rigid_body": {"mass": 1e6, "centre_of_mass": [0, 0, 0.0], "inertia": {"Ixx": 1e8, "Iyy": 2e8, "Izz": 2e8}},
        "members": [{"name": "box"} | member],
        "coefficients": {"box": {}},
        "mooring": {"kind": "none"},
    }
    return build(validate(Platform, copy.deepcopy(data), "barge"))


def load_of(model: Model) -> Buoyancy:
    return next(load for load in model.loads if isinstance(load, Buoyancy))


@one_program
def force_on(load: Buoyancy, position, weight) -> jax.Array:
    return load.force(position, rotation(position[3:]), weight)


LYING = BOX | {"d": [12.0, 5.0], "rA": [-30, 0, -0.5], "rB": [30, 0, -0.5]}  # wet to 3 m
STANDING = {"shape": "rect", "d": [60.0, 12.0], "rA": [0, 0, -3.0], "rB": [0, 0, 2.0]}


@pytest.mark.parametrize(
    "member", [LYING, LYING | {"d": [5.0, 12.0], "gamma": 90.0}, LYING | {"rA": LYING["rB"], "rB": LYING["rA"]}]
)
def test_statics_of_a_lying_box(member: dict) -> None:
    """Volume, centre, C33, C44 and C55 of 60 x 12 m at a draught of 3 m, and the force at finite angles of the upright box."""
    load, upright = load_of(alone(**member)), load_of(alone(**STANDING))
    statics, weight = load.upright(RHO * G), RHO * G
    volume = 60 * 12 * 3
    assert statics["displaced_volume"] == pytest.approx(volume, rel=1e-12)
    assert statics["centre_of_buoyancy"] == pytest.approx(-1.5, rel=1e-12)
    assert statics["C33"] == pytest.approx(weight * 720, rel=1e-12)
    assert statics["C44"] == pytest.approx(weight * (60 * 12**3 / 12 - volume * 1.5), rel=1e-9)
    assert statics["C55"] == pytest.approx(weight * (12 * 60**3 / 12 - volume * 1.5), rel=1e-9)
    for position in ([0, 0, 0.4, 0.1, 0.02, 0.3], [0, 0, -0.5, -0.08, -0.03, 0.0]):
        lying_force, upright_force = (np.asarray(force_on(part, np.array(position), weight)) for part in (load, upright))
        assert_allclose(lying_force, upright_force, atol=1e-9 * np.abs(upright_force).max())


@pytest.mark.parametrize("height", [-0.9, 0.0, 0.75])
def test_statics_of_a_lying_cylinder(height: float) -> None:
    """The segment of a circle, 3 m wide and 40 m long, its axis at a height over still water."""
    statics = load_of(alone(**TUBE, rA=[-20, 0, height], rB=[20, 0, height])).upright(RHO * G)
    y = np.linspace(-1.5, 1.5, 400001)
    half = np.sqrt(1.5**2 - y**2)
    wet = np.clip(-height + half, 0, 2 * half)
    area, step = wet.sum() * (y[1] - y[0]), y[1] - y[0]
    middle = ((height - half + 0.5 * wet) * wet).sum() * step / area
    wide = 2 * math.sqrt(1.5**2 - height**2)
    assert statics["displaced_volume"] == pytest.approx(40 * area, rel=1e-7)
    assert statics["centre_of_buoyancy"] == pytest.approx(middle, rel=1e-6)
    assert statics["C33"] == pytest.approx(RHO * G * 40 * wide, rel=1e-9)
    assert statics["C44"] == pytest.approx(RHO * G * 40 * (wide**3 / 12 + area * middle), rel=1e-6, abs=1e-6 * RHO * G * 40)
    assert statics["C55"] == pytest.approx(RHO * G * (wide * 40**3 / 12 + 40 * area * middle), rel=1e-6)


@eqx.filter_jit
def wave_force(model: Model, sea, time) -> jax.Array:
    return model.sum_of_loads(model.instant(time, model.rest(), sea), model.rest().memory).force


def wet_surface(sea, time: float) -> np.ndarray:
    """Minus the integrals of p n and r x p n over the wet sides, ends and bottom of the box (N, N m)."""
    total = np.zeros(6)
    grids = {n: (np.arange(n) + 0.5) / n for n in (60, 24, 12)}
    x, y, z = -30 + 60 * grids[60], -6 + 12 * grids[24], -3 + 3 * grids[12]
    faces = [(np.meshgrid(x, y, [-3.0]), [0, 0, -1.0], 1.0 * 0.5)]
    faces += [(np.meshgrid(x, [side], z), [0, np.sign(side), 0], 1.0 * 0.25) for side in (-6.0, 6.0)]
    faces += [(np.meshgrid([end], y, z), [np.sign(end), 0, 0], 0.5 * 0.25) for end in (-30.0, 30.0)]
    panels = [np.stack([part.reshape(-1) for part in grid]) for grid, _, _ in faces]
    whole = RHO * np.asarray(flow(sea, time, np.concatenate(panels, axis=1)).pressure)
    pressures = np.split(whole, np.cumsum([points.shape[1] for points in panels])[:-1])
    for points, pressure, (_, normal, area) in zip(panels, pressures, faces, strict=True):
        force = -pressure[:, None] * np.array(normal) * area
        total += np.concatenate([force.sum(axis=0), np.cross(points.T, force).sum(axis=0)])
    return total


@pytest.mark.parametrize("heading", [0.0, 90.0, 35.0])
def test_pressure_of_long_waves_on_a_lying_box(heading: float) -> None:
    """Surge, sway, heave, roll and pitch are those of the pressure over the wet surface, to wavenumber times draught."""
    model, period = alone(**LYING), 16.0
    sea = jh.regular_wave(2e-3, period, model.environment, heading=math.radians(heading))
    at = [0.0, 4.0]
    forces, expected = ([force_of(sea, t) for t in at] for force_of in (lambda s, t: force_in(model, s, t), wet_surface))
    for part, close in (([0, 1], 0.02), ([2], 0.02), ([3], 0.05), ([4], 0.03)):
        largest = np.abs(np.array(expected)[:, part]).max()
        if (part == [3] and heading == 0) or (part == [4] and heading == 90):
            largest = np.abs(expected).max()
        assert_allclose(np.array(forces)[:, part], np.array(expected)[:, part], atol=close * largest)


def force_in(model: Model, sea, time: float) -> np.ndarray:
    still = np.asarray(wave_force(model, jh.StillWater(), jnp.asarray(0.0)))
    return np.asarray(wave_force(model, sea, jnp.asarray(time))) - still


def test_a_lying_cylinder_follows_long_waves() -> None:
    """The heave force in a wave of 25 s is nearly the waterplane's stiffness times its elevation, in phase."""
    model = alone(**TUBE, rA=[-20, 0, 0.3], rB=[20, 0, 0.3])
    sea = jh.regular_wave(2e-3, 25.0, model.environment)
    stiffness = load_of(model).upright(RHO * G)["C33"]
    assert force_in(model, sea, 0.0)[2] / 1e-3 == pytest.approx(stiffness, rel=0.03)
    assert abs(force_in(model, sea, 6.25)[2]) / 1e-3 < 0.01 * stiffness


def test_statics_of_an_inclined_brace() -> None:
    """A cylinder at 30 degrees that still water cuts through its side: half of it is wet, its waterplane is A / sin 30."""
    length, d = 24.0, 2.0
    ends = [[-length / 2 * math.cos(math.pi / 6), 0, -6.0], [length / 2 * math.cos(math.pi / 6), 0, 6.0]]
    for a, b in (ends, ends[::-1]):
        statics = load_of(alone(shape="circ", d=d, rA=a, rB=b)).upright(RHO * G)
        area = math.pi / 4 * d**2
        assert statics["displaced_volume"] == pytest.approx(area * length / 2, rel=1e-9)
        assert statics["C33"] == pytest.approx(RHO * G * area / math.sin(math.pi / 6), rel=1e-6)


def wet_cylinder(sea, time: float, a: np.ndarray, b: np.ndarray, diameter: float) -> np.ndarray:
    """Minus the integrals of p n and r x p n over the wet side and lower end of a cylinder from a up to b (N, N m)."""
    length = np.linalg.norm(b - a)
    axis = (b - a) / length
    across = np.cross(axis, [0.0, 1.0, 0.0])
    across /= np.linalg.norm(across)
    angle = 2 * math.pi * (np.arange(48) + 0.5) / 48
    ring = np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * np.cross(axis, across)
    n, radius = 3000, 0.5 * diameter
    s = ((np.arange(n) + 0.5) / n * length)[:, None, None]
    side = (a + s * axis + radius * ring).reshape(-1, 3)
    normal = np.broadcast_to(ring * radius * (2 * math.pi / 48) * (length / n), (n, 48, 3)).reshape(-1, 3)
    r = ((np.arange(20) + 0.5) / 20 * radius)[:, None, None]
    bottom = (a + r * ring).reshape(-1, 3)
    down = np.broadcast_to(-axis * r * (2 * math.pi / 48) * (radius / 20), (20, 48, 3)).reshape(-1, 3)
    points, normals = np.concatenate([side, bottom]), np.concatenate([normal, down])
    wet = points[:, 2] < 0
    points, normals = points[wet], normals[wet]
    pressure = RHO * np.asarray(flow(sea, time, points.T).pressure)
    force = -pressure[:, None] * normals
    return np.concatenate([force.sum(axis=0), np.cross(points, force).sum(axis=0)])


@pytest.mark.parametrize("slope", [25.0, 50.0, 70.0])
def test_waves_on_a_leaning_cylinder_that_still_water_cuts(slope: float) -> None:
    """Force and moment are those of the pressure over the wet surface; the pontoon of 25 degrees as the columns."""
    angle = math.radians(slope)
    axis = np.array([math.cos(angle), 0.0, math.sin(angle)])
    a, b = np.array([5.0, 3.0, 0.0]) - 14.0 * axis, np.array([5.0, 3.0, 0.0]) + 9.0 * axis
    model = alone(shape="circ", d=2.0, rA=a.tolist(), rB=b.tolist(), maccamy_fuchs=False)
    sea = jh.regular_wave(2e-3, 10.0, model.environment, heading=0.5)
    for time in (0.0, 2.5):
        acting_force, expected = force_in(model, sea, time), wet_cylinder(sea, time, a, b, 2.0)
        for part in (slice(0, 3), slice(3, 6)):
            assert_allclose(acting_force[part], expected[part], atol=0.02 * np.linalg.norm(expected[part]))
