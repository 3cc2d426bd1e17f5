"""Members whose section changes along their axis: pressure, added mass, drag and buoyancy, against other ways to find them."""

import copy
import math
from functools import partial

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import flow, one_program
from scipy.spatial.transform import Rotation

import jaxhydro as jh
from jaxhydro.dynamics.model import Model
from jaxhydro.errors import InputError
from jaxhydro.input_schema import validate
from jaxhydro.loads import Buoyancy, EndInertia, MorisonDrag
from jaxhydro.platform.build import build as built
from jaxhydro.platform.schema import Platform
from jaxhydro.waves.components import PlaneWaves, components
from jaxhydro.waves.dispersion import wavenumber
from jaxhydro.waves.second_order import bound_waves

RHO, G, DEPTH = 1025.0, 9.80665, 320.0
WATER = jh.Environment(RHO, DEPTH, G)
SPAR = {"name": "hull", "shape": "circ", "stations": [-80, -12, -4, 10], "d": [10, 10, 6, 6]}
SPAR |= {"rA": [0, 0, -80], "rB": [0, 0, 10]}
STEP = {**SPAR, "stations": [-80, -8, -8, 10]}


def model_of(*members: dict, coefficients: dict | None = None, **keys) -> Model:
    groups = {member.get("group", member["name"]) for member in members}
    data = {
        "name": "taper",
        "water": {"density": RHO, "depth": DEPTH},
        "rigid_body": {"mass": 6e6, "centre_of_mass": [0, 0, -60.0], "inertia": {"Ixx": 5e9, "Iyy": 5e9, "Izz": 1e8}},
        "members": list(members),
        "coefficients": {group: coefficients or {} for group in groups},
        "mooring": {"kind": "none"},
        **keys,
    }
    return built(validate(Platform, copy.deepcopy(data), "taper"))


@eqx.filter_jit
def wave_force(model: Model, sea, time) -> jnp.ndarray:
    at, still = (model.instant(time, model.rest(), sea_met) for sea_met in (sea, jh.StillWater()))
    return model.sum_of_loads(at, model.rest().memory).force - model.sum_of_loads(still, model.rest().memory).force


def excitation(model: Model, sea, time: float) -> np.ndarray:
    """Force (N, N m) of the waves on the platform held at its reference position."""
    return np.asarray(wave_force(model, sea, jnp.asarray(time)))


def amplitude(model: Model, period: float) -> np.ndarray:
    """Amplitude (N/m, N m/m) of the force in a regular wave of first order, from two instants a quarter of it apart."""
    sea = jh.regular_wave(2e-3, period, model.environment)
    return np.hypot(*(excitation(model, sea, at * period) for at in (0.0, 0.25))) / 1e-3


def closed_form(pairs: list[tuple[float, float]], period: float) -> float:
    """Heave force (N/m) of the pressure on areas (m2) that look down, less those that look up, at depths z (m)."""
    k = float(wavenumber(jnp.asarray(2 * math.pi / period), jnp.asarray(DEPTH), jnp.asarray(G)))
    return abs(sum(RHO * G * math.cosh(k * (z + DEPTH)) / math.cosh(k * DEPTH) * area for z, area in pairs))


def disc(diameter: float) -> float:
    return math.pi / 4 * diameter**2


@pytest.mark.slow
@pytest.mark.parametrize("elements", [None, 5])
@pytest.mark.parametrize("period", [10.0, 20.0])
def test_heave_force_on_a_cone_and_on_a_step(period: float, elements: int | None) -> None:
    """Pressure on the bottom and on all that faces up, with stations, with `elements` that miss them, with two members."""
    z = np.linspace(-12, -4, 4001)
    side = np.diff(disc(10 - 4 * (z + 12) / 8))
    cone = [(-80.0, disc(10)), *zip(0.5 * (z[1:] + z[:-1]), side)]
    step = [(-80.0, disc(10)), (-8.0, disc(6) - disc(10))]
    two = [
        {**SPAR, "name": "low", "group": "hull", "stations": [0, 1], "d": [10, 10], "rB": [0, 0, -8]},
        {**SPAR, "name": "top", "group": "hull", "stations": [0, 1], "d": [6, 6], "rA": [0, 0, -8]},
    ]
    near = {**SPAR, "stations": [-80, -8.001, -8, 10]}
    keys = {"maccamy_fuchs": False} | ({} if elements is None else {"elements": elements})
    for members, expected in (([SPAR], cone), ([STEP], step), ([near], step), (two, step)):
        force = amplitude(model_of(*({**member, **keys} for member in members)), period)
        assert force[2] == pytest.approx(closed_form(expected, period), rel=3e-4)


def surface_pressure(member: dict, phi, count: int = 800) -> np.ndarray:
    """Minus the integral of p n over the surface of a frustum from rA to rB, and that of r x p n (N, N m)."""
    a, b = np.array(member["rA"], float), np.array(member["rB"], float)
    length = np.linalg.norm(b - a)
    axis = (b - a) / length
    across = np.cross(axis, [0.0, 1.0, 0.0])
    across /= np.linalg.norm(across)
    third = np.cross(axis, across)
    low, high = (0.5 * d for d in member["d"])
    slope = (high - low) / length
    angle = 2 * math.pi * (np.arange(48) + 0.5) / 48
    ring = np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * third
    total = np.zeros(6)

    def add(point: np.ndarray, normal: np.ndarray) -> None:  # normal times area
        force = -RHO * phi(point)[:, None] * normal
        total[:3] += force.sum(axis=0)
        total[3:] += np.cross(point, force).sum(axis=0)

    at = (np.arange(count) + 0.5) / count * length
    s, r = at[:, None, None], (low + slope * at)[:, None, None]
    point = a + s * axis + r * ring
    normal = (ring - slope * axis) * r * (2 * math.pi / 48) * (length / count)
    add(point.reshape(-1, 3), normal.reshape(-1, 3))
    for centre, radius, way in ((a, low, -1.0), (b, high, 1.0)):
        r = ((np.arange(40) + 0.5) / 40 * radius)[:, None, None]
        point = centre + r * ring
        add(
            point.reshape(-1, 3),
            np.broadcast_to(way * axis * r * (2 * math.pi / 48) * (radius / 40), point.shape).reshape(-1, 3),
        )
    return total


def pressure_of(sea, time: float, points: np.ndarray) -> np.ndarray:
    """Pressure over density (m2/s2) at points (n, 3)."""
    return np.asarray(flow(sea, time, points.T).pressure)


INCLINED = [
    {"rA": [5.0, 2.0, -40.0], "rB": [15.0, -6.0, -12.0], "d": [4.0, 1.5]},  # a brace, counted as a column
    {"rA": [5.0, 2.0, -40.0], "rB": [15.0, -6.0, -12.0], "d": [1.5, 4.0]},
    {"rA": [-10.0, 0.0, -20.0], "rB": [10.0, 12.0, -14.0], "d": [3.0, 1.5]},  # counted as a pontoon
]


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("shape", INCLINED)
def test_pressure_on_an_inclined_taper(shape: dict, order: int) -> None:
    """Force and moment without added mass are those of the undisturbed pressure, integrated over the surface."""
    member = {"name": "brace", "shape": "circ", "stations": [0, 1], **shape}
    model = model_of(member)
    two = components(
        np.array([1.0, 1.0]),
        2 * math.pi / np.array([9.0, 12.0]),
        WATER,
        heading=np.array([0.4, 0.4]),
        phase=np.array([0.3, 1.0]),
    )
    bound = bound_waves(two, WATER) if order == 2 else None
    sea = jh.WaveSea(PlaneWaves.free(two, WATER), WATER, bound=bound)
    for time in (0.0, 2.0):
        expected = surface_pressure(member, partial(pressure_of, sea, time))
        acting_force = excitation(model, sea, time)
        assert_allclose(acting_force[:3], expected[:3], atol=4e-3 * np.linalg.norm(expected[:3]))
        assert_allclose(acting_force[3:], expected[3:], atol=4e-3 * np.linalg.norm(expected[3:]))


def test_heave_of_a_cone_spar_as_capytaine_has_it() -> None:
    """Excitation in long waves of Capytaine 3.0.0, and its part by pressure of the undisturbed wave.

    From a mesh of 1568 panels by revolution, 28 to a ring of equal area, bottom (0.01, -80), (5, -80), side (5, -12), (3, -4),
    (3, 0), depth 320 m: `DiffractionProblem(body=body, omega=2*pi/T, wave_direction=0, water_depth=320, rho=1025, g=9.80665)`,
    `BEMSolver().solve`, `airy_waves.froude_krylov_force`; `RadiationProblem(radiating_dof="Heave")` has A33 of 3.37e5 kg,
    0.7 of the half sphere and the ring.
    """
    for period, whole, pressure in ((16.0, 237914.1, 218738.0), (20.0, 127485.4, 110421.5)):
        bare = amplitude(model_of({**SPAR, "maccamy_fuchs": False}), period)[2]
        assert bare == pytest.approx(pressure, rel=5e-3)
        heave = amplitude(model_of(SPAR, coefficients={"Ca_z": 0.7}), period)[2]
        assert heave == pytest.approx(whole, rel=0.04)


def test_ring_of_a_heave_plate() -> None:
    """A step has the added mass of 2/3 pi (R^3 - r^3) and the drag of pi (R^2 - r^2), by stations and by two members."""
    coefficients = {"Ca_z": 0.6, "Cd_z": 1.5}
    plate = {**SPAR, "stations": [-20, -18, -18, 10], "d": [12, 12, 6, 6], "rA": [0, 0, -20]}
    low = {**plate, "name": "plate", "group": "hull", "stations": [0, 1], "d": [12, 12], "rB": [0, 0, -18]}
    top = {**plate, "name": "top", "group": "hull", "stations": [0, 1], "d": [6, 6], "rA": [0, 0, -18]}
    ball, area = 2 / 3 * math.pi, math.pi
    mass = RHO * 0.6 * ball * (6**3 + 6**3 - 3**3)
    drag = 0.5 * RHO * 1.5 * area * (6**2 + 6**2 - 3**2)
    for members in ([plate], [low, top], [top, low]):
        model = model_of(*members, coefficients=coefficients)
        ends, force = axial(model)
        assert float(ends.sum()) == pytest.approx(mass, rel=1e-5)
        assert -float(force.sum()) == pytest.approx(drag, rel=1e-5)


@eqx.filter_jit
def axial(model: Model) -> tuple[jnp.ndarray, jnp.ndarray]:
    """Added mass (kg) of ends and faces, and the drag (N) on them, of a platform that rises by 1 m/s."""
    state = model.rest()
    moving = type(state)(state.position, jnp.array([0, 0, 1.0, 0, 0, 0]), state.memory)
    now = model.instant(jnp.asarray(0.0), moving, jh.StillWater())
    inertia, drag = (next(load for load in model.loads if isinstance(load, kind)) for kind in (EndInertia, MorisonDrag))
    return inertia.act(now, None).end_mass, drag.act(now, None).end_force


def test_a_column_in_two_members_is_one_column() -> None:
    """Ends that cover each other have no added mass and no drag."""
    whole = {**SPAR, "stations": [0, 1], "d": [6, 6]}
    halves = [
        {**whole, "name": "low", "group": "hull", "rB": [0, 0, -30]},
        {**whole, "name": "up", "group": "hull", "rA": [0, 0, -30]},
    ]
    whole_column, two = (model_of(*members, coefficients={"Ca_z": 0.6, "Cd_z": 1.5}) for members in ([whole], halves))
    assert float(two.hull.ends.volume.sum()) == pytest.approx(float(whole_column.hull.ends.volume.sum()), rel=1e-12)
    assert float(two.hull.ends.facing.sum()) == pytest.approx(float(whole_column.hull.ends.facing.sum()), rel=1e-12)


def wet_volume(member: dict, position: np.ndarray, n: int = 90) -> np.ndarray:
    """Buoyancy (N, N m about the reference point, earth axes) of an upright cone at a displacement, by counting fine cells."""
    matrix = Rotation.from_euler("ZYX", position[5:2:-1]).as_matrix()
    low, high = member["rA"][2], member["rB"][2]
    z = low + (np.arange(40 * n) + 0.5) / (40 * n) * (high - low)
    radius = 0.5 * np.interp(z, [low, high], member["d"])
    r = (np.arange(n) + 0.5) / n
    angle = 2 * math.pi * (np.arange(96) + 0.5) / 96
    unit = np.stack([np.outer(r, np.cos(angle)), np.outer(r, np.sin(angle))]).reshape(2, -1)
    share = np.outer(r, np.ones(96)).reshape(-1) * (2 * math.pi / 96) / n
    volume, first = 0.0, np.zeros(3)
    for level, size in zip(z, radius):
        points = np.stack([size * unit[0] + member["rA"][0], size * unit[1], np.full(unit.shape[1], level)])
        wet = share * size**2 * (position[2] + matrix[2] @ points < 0)
        volume, first = volume + wet.sum(), first + points @ wet
    scale = (high - low) / z.size
    up = np.array([0.0, 0.0, RHO * G])
    return np.concatenate([volume * scale * up, np.cross(matrix @ first * scale, up)])


def test_buoyancy_of_a_frustum_is_exact() -> None:
    """pi h/12 (D^2 + D d + d^2) and its centroid, upright and leaning, under water; up to the waterline where it is cut."""
    cone = {**SPAR, "stations": [0, 1], "d": [12, 6], "rA": [3, 0, -50], "rB": [3, 0, -20]}
    load = next(load for load in model_of(cone).loads if isinstance(load, Buoyancy))
    statics = load.upright(RHO * G)
    volume = math.pi * 30 / 12 * (144 + 72 + 36)
    first = math.pi / 4 * 30**2 * (144 / 2 - 2 * 12 * 6 / 3 + 36 / 4)  # int s (12 - 6 s/30)^2 ds
    assert statics["displaced_volume"] == pytest.approx(volume, rel=1e-13)
    assert statics["centre_of_buoyancy"] == pytest.approx(-50 + first / volume, rel=1e-12)
    cut = {**cone, "rB": [3, 0, 10]}
    load = next(load for load in model_of(cut).loads if isinstance(load, Buoyancy))
    statics, wide = load.upright(RHO * G), 12 - 6 * 50 / 60
    volume = math.pi * 50 / 12 * (144 + 12 * wide + wide**2)
    assert statics["displaced_volume"] == pytest.approx(volume, rel=1e-13)
    assert statics["C33"] == pytest.approx(RHO * G * disc(wide), rel=1e-12)
    second = RHO * G * math.pi / 64 * wide**4
    assert statics["C44"] == pytest.approx(second + RHO * G * volume * statics["centre_of_buoyancy"], rel=1e-9)
    assert statics["C55"] == pytest.approx(statics["C44"] + RHO * G * disc(wide) * 9, rel=1e-9)


def test_buoyancy_of_a_cut_frustum_that_leans() -> None:
    """Second order in the lean: 2e-4 of the buoyancy at 8 degrees in roll and pitch."""
    cone = {**SPAR, "stations": [0, 1], "d": [16, 6], "rA": [3, 0, -20], "rB": [3, 0, 10]}
    position = np.array([0, 0, 0.7, math.radians(8), math.radians(-8), 0.2])
    matrix = Rotation.from_euler("ZYX", position[5:2:-1]).as_matrix()
    load = next(load for load in model_of(cone).loads if isinstance(load, Buoyancy))
    body = np.asarray(one_program(Buoyancy.force)(load, position, matrix, RHO * G))
    expected = wet_volume(cone, position)
    assert_allclose(matrix @ body[:3], expected[:3], atol=2e-4 * expected[2])
    assert_allclose(matrix @ body[3:], expected[3:], atol=2e-4 * expected[2] * 10.0)


def test_stations_named_twice_are_a_step() -> None:
    """As RAFT has it; a step at an end, or three times the same, is none."""
    model = model_of(STEP)
    volume = disc(10) * 72 + disc(6) * 8
    load = next(load for load in model.loads if isinstance(load, Buoyancy))
    assert load.upright(1.0)["displaced_volume"] == pytest.approx(volume, rel=1e-6)
    for stations in ([-80, -80, -8, 10], [-8, -8, -8, 10], [-80, -8, 10, 10]):
        with pytest.raises(InputError, match="ascending order"):
            model_of({**STEP, "stations": stations})
