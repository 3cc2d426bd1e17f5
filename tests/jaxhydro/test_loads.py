"""Every load under one contract, and each against closed forms, quadrature or brute force done here in NumPy."""

import dataclasses
import math
from functools import cache, reduce

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import one_program
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

import jaxhydro as jh
from benchmarks.reference_waves import WaveModel, Waves
from jaxhydro.environment import DOFS
from jaxhydro.loads import (
    LOADS,
    AbstractLoad,
    AddedMass,
    Buoyancy,
    CatenaryLines,
    ComputedAddedMass,
    ComputedExcitation,
    ComputedRadiation,
    CoulombFriction,
    CoupledAddedMass,
    CoupledDamping,
    CoupledStiffness,
    CoveredEnds,
    CubicDamping,
    DiffractionCorrection,
    DriftTransfer,
    EndInertia,
    HiddenOscillator,
    HydrostaticCoupling,
    Hysteresis,
    LinearDamping,
    MassError,
    MooringLines,
    MooringNonlinearity,
    MorisonDrag,
    NonlinearHydrostatics,
    QuadraticDamping,
    RadiationMemory,
    SlenderBodyForces,
    StaticForce,
    Stiffness,
    StripInertia,
    TensionTableLines,
    Umbilical,
    WaveDrift,
    WaveDriftDamping,
    WaveExcitation,
    Weight,
)
from jaxhydro.loads.drag import (
    DRAG_LAWS,
    ConstantLaw,
    HighPassLaw,
    KeuleganCarpenterLaw,
    SlowMotionLaw,
    SpeedPowerLaw,
    SuctionSideLaw,
)
from jaxhydro.parameters import AbstractEffect
from jaxhydro.platform.diffraction_correction_build import with_diffraction_correction
from jaxhydro.platform.tension_table_build import tension_table
from jaxhydro.sensors import SENSOR_EFFECTS, SensorLag, SensorReference
from jaxhydro.water import WATER_EFFECTS, Current, CurrentProfile, WaveGaugePosition, WaveReflection
from jaxhydro.waves.excitation import Excitation
from jaxhydro.waves.quadratic_transfer import Transfer

RHO, G = 1025.0, 9.81
BODY = {"mass": 8e6, "centre_of_mass": [0, 0, -8], "inertia": {"Ixx": 4e9, "Iyy": 5e9, "Izz": 6e9}}
COLUMN = {"name": "column", "shape": "circ", "d": 10.0, "rA": [0, 0, -20], "rB": [0, 0, 15]}
PONTOON = {"name": "pontoon", "shape": "rect", "d": [12.5, 7.0], "rA": [5, 0, -16.5], "rB": [45, 0, -16.5]}
COEFFICIENTS = {"Ca_t": 0.9, "Ca_z": 0.6, "Cd_t": 1.1, "Cd_z": 2.3}
SPRINGS = {
    "kind": "linear_springs",
    "lines": [
        {"anchor": anchor, "fairlead": fairlead, "stiffness": 45e3, "pretension": 1.5e6}
        for anchor, fairlead in (
            ([150.0, 259.80762, -14.0], [29.0, 50.22947, -14.0]),
            ([-300.0, 0.0, -14.0], [-58.0, 0.0, -14.0]),
            ([150.0, -259.80762, -14.0], [29.0, -50.22947, -14.0]),
        )
    ],
}
HIGH_PASS = {"law": "high_pass", "cutoff": 0.03, "low_share": 0.4}
KEULEGAN_CARPENTER = {"law": "keulegan_carpenter", "exponent": -1 / 3, "reference": 5.0, "window": 40.0}
LEG = {**COLUMN, "name": "leg", "d": 8.0, "rA": [30, 20, -20], "rB": [30, 20, 15]}
FOOT = {**COLUMN, "name": "foot", "d": 8.0, "rA": [30, -20, -20], "rB": [30, -20, 15]}
BEAM = {**PONTOON, "name": "beam", "rA": [-45, 0, -16.5], "rB": [-5, 0, -16.5]}
EVERYTHING = {
    "members": [COLUMN, PONTOON, LEG, FOOT, BEAM],
    "coefficients": {
        "column": COEFFICIENTS,
        "pontoon": COEFFICIENTS,
        "leg": COEFFICIENTS | {"drag_t": HIGH_PASS, "drag_z": HIGH_PASS | {"suction": 0.7}},
        "foot": COEFFICIENTS | {"drag_t": KEULEGAN_CARPENTER, "drag_z": {"law": "suction_side"}},
        "beam": COEFFICIENTS | {"drag_t": KEULEGAN_CARPENTER, "drag_z": HIGH_PASS},
    },
    "linear_damping": {"B11": 4e4, "B33": 1e5, "B55": 3e8, "B15": 1e5},
    "quadratic_damping": {"B22": 3e5, "B44": 1e9},
    "added_mass": {"A33": 2e6, "A15": 1e6},
    "guided_masses": [
        {"name": "rod", "mass": 2e5, "point": [2.0, -3.0, 5.0], "moves": ["z"], "weight": True},
        {"name": "carriage", "mass": 5e5, "point": [4.0, 1.0, -6.0], "moves": ["x", "y"]},
    ],
    "tuned_mass_dampers": [
        {"name": "top", "mass": 2e5, "point": [1.0, 2.0, 60.0], "direction": [1, 0.2, 0.1], "period": 9.0, "damping_ratio": 0.1}
    ],
    "liquid_column_dampers": [
        {"name": "tube", "point": [1.0, 2.0, -9.0], "direction": [1, 0.5, 0], "width": 20.0, "column": 5.0, "area": 2.0}
        | {"head_loss": 2.0, "density": 1025.0}
    ],
    "rotor": {"hub": [-5.0, 1.0, 150.0], "thrust": 2e6, "damping": 1.2e5},
    "stiffness": {"C11": 2e4, "C35": 4e5},
    "mooring": SPRINGS,
}


CATENARIES = CatenaryLines(  # one that rests on the seabed, of two types, and one between two points above it
    jnp.array([[-600.0, 90.0], [0.0, 40.0], [-200.0, -60.0]]),
    jnp.array([[-58.0, 20.0], [0.0, 10.0], [-14.0, -14.0]]),
    (("chain", "rope"), ("rope",)),
    (True, False),
    {"chain": 8e8, "rope": 6e7},
    {"chain": 1500.0, "rope": 60.0},
    {"line1.segment1": 300.0, "line1.segment2": 290.0, "line2": 94.0},
    {"line1": 2.0, "line2": -1.0},
    0.5,
)
ROPES = TensionTableLines(
    jnp.array([[-600.0, 90.0], [0.0, 40.0], [-100.0, -60.0]]),
    jnp.array([[-58.0, 20.0], [0.0, 10.0], [-14.0, -14.0]]),
    (
        tension_table(np.array([0.0, 0.01, 0.03, 0.1]), np.array([0.0, 1e5, 8e5, 9e6]), "pchip"),
        tension_table(np.array([0.0, 2.0, 4.0]), np.array([0.0, 1e5, 5e5]), "linear"),
    ),
    (True, False),
    (0, 1),
    {"rope1": 540.0, "rope2": 85.0},
    {"rope1": 1.0, "rope2": 0.8},
)
EXCITATION = Excitation.of(np.linspace(0.2, 2.0, 5), np.random.default_rng(4).normal(0, 1e6, (6, 5)) + 4e5j)
TRANSFER = Transfer.of(np.linspace(0.2, 2.0, 5), np.random.default_rng(3).normal(0, 2e4, (6, 5, 5)) + 3e4j * np.tri(5))


def data_of(*members: dict) -> dict:
    """A platform of these members, all with the same coefficients."""
    return {
        "name": "test",
        "water": {"density": RHO, "depth": 200.0, "gravity": G},
        "rigid_body": BODY,
        "members": members,
        "coefficients": {member["name"]: COEFFICIENTS for member in members},
    }


def build(*members: dict, **changes) -> jh.Model:
    """Of the same, or of a mapping's members, with what else it declares."""
    members = members or tuple(changes.pop("members", ()))
    return jh.build(jh.Platform.model_validate(data_of(*members) | changes))


FOUND = {  # what no platform file declares: effects that were found to be missing, by their labels' ends
    "umbilical": {"stiffness": 2e4, "pull": 1e5, "mass": 4e4, "height": 12.0},
    "coulomb_friction": {"force": 5e4, "speed": 0.01},
    "hysteresis": {"force": 8e4, "yield_displacement": 0.3},
    "mooring_nonlinearity": {"odd_quadratic": 800.0, "even_quadratic": -300.0, "cubic": 40.0},
    "radiation_memory": {"strength": 3e5, "frequency": 0.5, "damping_ratio": 0.3},
    "computed_radiation": {"share": 0.8},
    "hidden_oscillator": {"mass": 2e5, "period": 14.0, "damping_ratio": 0.05},
    "nonlinear_hydrostatics": {"even_quadratic": 3e4, "cubic": 5e3, "quintic": 200.0, "pitch_squared": 2e7},
    "cubic_damping": {"coefficient": 3e4},
    "mass_properties": {"mass": 3e5, "centre_x": 0.2, "centre_z": -0.4, "inertia_roll": 2e8},
    "static_offset": {"force": 6e4},
    # what changes the water that the others meet stays at its neutral value: the sum of all is that of each alone
    "sensor_reference": {"x": 4.0, "z": -6.0},
    "sensor_lag": {"delay": 0.4},
    "wave_drift": {"envelope": 2e4, "quadrature": -7e3, "frequency_weighted": 9e3},
    "wave_drift_damping": {"coefficient": 1e4},
    "drift_transfer": {"share": 0.8},
    "amplitude_dependent_drag": {"exponent": -0.3},
    "sea_state_dependent_drag": {"low_share": 1.4, "cutoff": 0.04},
    "coupled_damping": {"B15": 3e5},
    "covered_ends": {"share": 0.6},
    "wave_excitation": {"Cp_t": 0.8, "Cp_z": 1.3},
}


# states that the motions drive together
RADIATION = (np.kron(np.eye(6), [[-0.3, 0.7], [-0.7, -0.2]]), np.kron(np.eye(6) + 0.1, [[3.0], [2.0]]))
RADIATION += (1e3 * RADIATION[1].T,)


def effects(model: jh.Model, dofs: tuple[str, ...] = DOFS) -> tuple[AbstractLoad, ...]:
    """The loads that no platform file declares, at their neutral value."""
    return (
        Umbilical(),
        CATENARIES,
        ROPES,
        NonlinearHydrostatics.neutral(),
        MassError(model.body.mass, model.body.centre),
        ComputedRadiation(*map(jnp.asarray, RADIATION)),
        *(kind.neutral(dofs) for kind in (CoulombFriction, CubicDamping, StaticForce, MooringNonlinearity)),
        *(kind.neutral(dofs) for kind in (Hysteresis, RadiationMemory, HiddenOscillator)),
    )


def in_water(model: jh.Model) -> jh.Model:
    """With the effects of the water and the sensors at their neutral value; three drag coefficients get other laws."""
    column, other_keys = ("column", "t"), (("pontoon", "t"), ("column", "z"))
    laws = {(column,): SpeedPowerLaw.neutral([column]), other_keys: SlowMotionLaw(law=SpeedPowerLaw.neutral(other_keys))}
    taken = {key for keys in laws for key in keys}
    plain = [
        dataclasses.replace(load, Cd={k: v for k, v in load.Cd.items() if k not in taken})
        if isinstance(load, MorisonDrag) and isinstance(load.law, ConstantLaw)
        else load
        for load in model.loads
    ]
    drag = [MorisonDrag({key: COEFFICIENTS[f"Cd_{key[1]}"] for key in keys}, law) for keys, law in laws.items()]
    water_effects = (CoveredEnds, Current, CurrentProfile, SensorReference, SensorLag, WaveGaugePosition, WaveReflection)
    computed = (DriftTransfer(TRANSFER), ComputedExcitation(EXCITATION), ComputedAddedMass(jnp.eye(6)), SlenderBodyForces())
    drift = (
        CoupledDamping({"B15": 0.0}),
        CoupledStiffness({"C15": 0.0}),
        CoupledAddedMass({"A15": 0.0}),
        WaveDrift.neutral(DOFS),
        WaveDriftDamping.neutral(("surge", "heave", "pitch")),
        *computed,
    )
    pressed = WaveExcitation({(group, kind): 1.0 for group in EVERYTHING["coefficients"] for kind in "tz"})
    return model_of(model, *plain, *drag, *(kind() for kind in water_effects), *drift, pressed)


@cache
def everything() -> jh.Model:
    """One of every load."""
    model = build(**EVERYTHING)
    coupled = np.zeros((6, 6))
    coupled[2, 4] = coupled[4, 2] = 3e6  # N
    model = model.with_effect(HydrostaticCoupling(stiffness=jnp.asarray(coupled)))
    for load in effects(model):
        model = model.with_effect(load)
    model = in_water(model)
    parts = {label: label.split(".") for label in model.values}
    return model.with_values(
        {label: FOUND[part[0]][part[-1]] for label, part in parts.items() if part[-1] in FOUND.get(part[0], ())}
    )


def only(model: jh.Model, *kinds: type) -> jh.Model:
    """The model with some of its effects, by their type or that of their drag law."""
    return model_of(model, *(effect for effect in model.effects if types(effect) & set(kinds)))


def types(effect: AbstractEffect) -> set[type]:
    """The type of an effect, and of a drag's law."""
    return {type(effect), type(effect.law)} if isinstance(effect, MorisonDrag) else {type(effect)}


def model_of(model: jh.Model, *effects: AbstractEffect) -> jh.Model:
    """The model with these effects in place of its own."""
    bare = dataclasses.replace(model, loads=(), water=(), sensors=())
    return reduce(jh.Model.with_effect, effects, bare)


@eqx.filter_jit
def wrench(model: jh.Model, position, velocity, sea=None) -> tuple[jax.Array, jax.Array]:
    """Force (N, N m) of all loads in body axes, and their added mass about the reference point."""
    state = jh.State(jnp.asarray(position, float), jnp.asarray(velocity, float), model.rest().memory)
    now = model.instant(jnp.zeros(()), state, jh.StillWater() if sea is None else sea)
    total = model.sum_of_loads(now, state.memory)
    return total.force, total.added_mass + model.hull.moments @ total.masses


def force(model: jh.Model, velocity=(0.0,) * 6, position=(0.0,) * 6, sea=None) -> np.ndarray:
    return np.asarray(wrench(model, jnp.asarray(position, float), jnp.asarray(velocity, float), sea)[0])


@eqx.filter_jit
def at_rest(model: jh.Model, position=None) -> jax.Array:
    """Force (N, N m, earth axes) on the motionless platform in still water."""
    return model.force_at_rest(jnp.zeros(6) if position is None else position)


@eqx.filter_jit
def stiffness(model: jh.Model, position=None) -> jax.Array:
    """Minus the slope of the force at rest, in earth axes."""
    position = jnp.zeros(6) if position is None else position
    return -jax.jacfwd(model.force_at_rest)(position)


def sample(seed: int, n: int = 3) -> tuple[jax.Array, jax.Array]:
    """Positions with 15 degree rotations and lively velocities."""
    rng = np.random.default_rng(seed)
    position = rng.uniform(-1, 1, (n, 6)) * [8, 8, 3, 0.25, 0.25, 0.5]
    return jnp.asarray(position), jnp.asarray(rng.uniform(-1, 1, (n, 6)) * [2, 2, 2, 0.05, 0.05, 0.05])


# the contract

EFFECTS = {name: kind for name, kind in LOADS.items() if kind is not MorisonDrag} | DRAG_LAWS | WATER_EFFECTS | SENSOR_EFFECTS

SEA = jh.regular_wave(3.0, 9.0, jh.Environment(RHO, 200.0, G), heading=0.4, phase=0.3)


def test_the_example_has_every_registered_load() -> None:
    """Nothing escapes the contract below."""
    present = {kind for effect in everything().effects for kind in types(effect)}
    assert present | {DiffractionCorrection} == {MorisonDrag, *EFFECTS.values()}


def with_one_effect(name: str) -> jh.Model:
    """The example with one effect."""
    model = only(everything(), EFFECTS[name])
    if name == "diffraction_correction":  # a platform has one table of excitation, and the example has it whole
        model = with_diffraction_correction(only(everything(), StripInertia, EndInertia, ComputedExcitation))
        model = only(model, DiffractionCorrection)
    return model


wrenches = eqx.filter_vmap(wrench.__wrapped__, in_axes=(None, 0, 0, None))


@one_program
def in_waves_and_neutral(model, neutral, positions, velocities, sea):
    """Wrenches at some positions in waves, and at the first in still water with neutral values."""
    return wrenches(model, positions, velocities, sea), wrench.__wrapped__(neutral, positions[0], velocities[0])


@pytest.mark.parametrize("name", EFFECTS)
def test_contract(name: str) -> None:
    """The neutral value is silent in still water, float64 is kept, parameters within bounds."""
    model = with_one_effect(name)
    (load,) = model.effects
    for label, value in load.values.items():
        about = load.about(label)
        assert about.unit and about.meaning and about.lower <= about.neutral <= about.upper
        assert about.lower <= float(value) <= about.upper

    neutral = model.with_values({label: load.about(label).neutral for label in load.values})
    batch, silent = in_waves_and_neutral(model, neutral, *sample(1), SEA)
    assert all(part.dtype == np.float64 and np.isfinite(part).all() for part in map(np.asarray, batch))
    assert not load.values or all((np.asarray(part) == 0).all() for part in silent)


@pytest.mark.slow
@pytest.mark.parametrize("name", EFFECTS)
def test_compiled_or_not_and_one_by_one_or_together(name: str) -> None:
    """jit = eager, vmap = loop."""
    model, (positions, velocities) = with_one_effect(name), sample(1)
    loop = [wrench(model, q, v, SEA) for q, v in zip(positions, velocities, strict=True)]
    batch = eqx.filter_jit(wrenches)(model, positions, velocities, SEA)
    eager = wrench.__wrapped__(model, positions[0], velocities[0], SEA)
    for whole, uncompiled, *parts in zip(batch, eager, *loop, strict=True):
        whole, uncompiled, *parts = map(np.asarray, (whole, uncompiled, *parts))
        scale = np.abs(whole).max() + 1e-300
        assert_allclose(whole / scale, np.stack(parts) / scale, atol=1e-13)
        assert_allclose(uncompiled / scale, parts[0] / scale, atol=1e-13)


@pytest.mark.parametrize("name", WATER_EFFECTS)
def test_a_water_effect_at_its_neutral_value(name: str) -> None:
    """The sea is what it was, and there is no current; elsewhere it is another sea, or there is one."""
    effect, point = WATER_EFFECTS[name](), jnp.array([[12.0], [5.0], [-3.0]])
    time = jnp.asarray(7.3)
    alone, same = SEA.flow(time, point), effect.through(SEA).flow(time, point)
    assert all(bool((a == b).all()) for a, b in zip(jax.tree.leaves(alone), jax.tree.leaves(same), strict=True))
    assert effect.current(point[2]) is None or bool((effect.current(point[2]) == 0).all())
    changed_effect = effect.at_values({label: 0.2 for label in effect.values})
    changed, current = changed_effect.through(SEA).flow(time, point), changed_effect.current(point[2])
    assert bool((changed.velocity != alone.velocity).any()) or float(jnp.abs(current).max()) == 0.2


@pytest.mark.parametrize("name", SENSOR_EFFECTS)
def test_a_sensor_effect_at_its_neutral_value(name: str) -> None:
    """The reading is the motion, at once; elsewhere it is another, or later."""
    effect, position = SENSOR_EFFECTS[name](), jnp.array([3.0, 1.0, -2.0, 0.1, 0.2, -0.3])
    assert bool((effect.seen(position) == position).all()) and not effect.clock_lag()
    changed_effect = effect.at_values({label: 0.2 for label in effect.values})
    assert bool((changed_effect.seen(position) != position).any()) or float(changed_effect.clock_lag()) == 0.2


@pytest.mark.slow
def test_waves_at_the_reference_position() -> None:
    """They then do not tell where the platform has gone; where it leans they are those of its points upright, as the separate
    NumPy model has them."""
    waves = Waves(1.5, 2 * np.pi / 9.0, 0.4, 0.3, 200.0, G)
    sea = jh.regular_wave(3.0, 9.0, jh.Environment(RHO, 200.0, G), heading=0.4, phase=0.3, stretching="none")
    moved = np.array([30.0, -8.0, 1.0, 0.0, 0.0, 0.0])
    leaning = moved + np.array([0, 0, 0, 0.05, -0.1, 0.2])
    members = [{**member, "group": member["name"]} for member in (COLUMN, PONTOON, LEG)]
    data = data_of(*members) | {"diffraction": "none"}
    for waves_at, stays in (("mean", "z"), ("displaced", "xyz")):
        model = jh.build(jh.Platform.model_validate(data | {"waves_at": waves_at}))
        plain = WaveModel(data, waves, 0.1, 0.5, pontoon_ends=True, displaced=stays)
        for position in (moved, leaning):
            turn = Rotation.from_euler("ZYX", position[:2:-1]).as_matrix()
            actual = force(model, position=position, sea=sea) - force(model, position=position)
            actual = np.concatenate([turn @ actual[:3], turn @ actual[3:]])
            assert_allclose(actual, plain.wave_load(0.0, position), atol=2e-3 * np.abs(actual).max())
    model, displaced = jh.build(jh.Platform.model_validate(data | {"waves_at": "mean"})), moved * [1, 1, 0, 0, 0, 0]
    along = [force(model, position=x, sea=sea) - force(model, position=x) for x in (displaced, 0 * displaced)]
    assert_allclose(*along, atol=1e-9 * np.abs(along).max())


@pytest.mark.slow
def test_gradients_at_rest_are_finite() -> None:
    """sqrt(u^2) has no slope at zero by itself: forward = reverse, no nan by the state or by any array of the model."""
    weights = jnp.tile(jnp.array([1.0, -2.0, 0.5, 3.0, 1.5, -1.0]), 2)

    def scalar(y, model):
        rate = model.rate(jnp.zeros(()), jh.State(y[:6], y[6:], model.rest().memory), jh.StillWater())
        return jnp.concatenate([rate.position, rate.velocity]) @ weights

    @eqx.filter_jit
    def slopes(y, model):
        reverse = eqx.filter_grad(lambda state_and_model: scalar(*state_and_model))((y, model))
        return jax.jacfwd(scalar)(y, model), *reverse

    forward, reverse, by_model = slopes(jnp.zeros(12), everything())
    assert_allclose(forward, reverse, rtol=1e-10, atol=1e-12 * float(jnp.abs(forward).max()))
    assert all(bool(jnp.isfinite(leaf).all()) for leaf in jax.tree.leaves((forward, by_model)))


DISSIPATIVE = [ConstantLaw, HighPassLaw, KeuleganCarpenterLaw, SuctionSideLaw, SpeedPowerLaw]
DISSIPATIVE += [LinearDamping, QuadraticDamping, CoulombFriction, CubicDamping]


@pytest.mark.parametrize("kind", DISSIPATIVE)
def test_dissipative_loads_take_energy_out(kind: type) -> None:
    """Power <= 0 for any motion in still water; the damping matrix of the example is positive semidefinite. Memories are at
    rest: high-passed drag, which may give back energy that it remembers, is not passive at every instant."""
    model = only(everything(), kind)
    positions, velocities = sample(2, 64)
    wrenches = one_program(lambda *args: eqx.filter_vmap(wrench.__wrapped__, in_axes=(None, 0, 0))(*args))
    forces, _ = map(np.asarray, wrenches(model, positions, velocities))
    assert (forces * np.asarray(velocities)).sum(axis=1).max() < 0.0


@pytest.mark.slow
def test_all_loads_together_are_their_sum() -> None:
    """(M + sum A_k) dv/dt = sum F_k."""
    positions, velocities = sample(3)
    parts = [wrench(model_of(everything(), load), positions[0], velocities[0], SEA) for load in everything().loads]
    total = wrench(everything(), positions[0], velocities[0], SEA)
    for i, whole in enumerate(total):
        assert_allclose(sum(part[i] for part in parts), whole, rtol=1e-12, atol=1e-12 * float(jnp.abs(whole).max()))


# drag


def test_drag_of_a_column_in_surge() -> None:
    """1/2 rho Cd D T |u| u at mid-draught, by hand: D = 10 m, T = 20 m, u = 1.3 m/s."""
    actual = force(only(build(COLUMN), MorisonDrag), [1.3, 0, 0, 0, 0, 0])
    expected = -0.5 * RHO * 1.1 * 10 * 20 * 1.3**2
    assert_allclose(actual, [expected, 0, 0, 0, -10 * expected, 0], rtol=1e-11, atol=1e-4)


def test_drag_of_a_column_in_pitch() -> None:
    """Integral of 1/2 rho Cd D |q z| q z and of z times it, by quad."""
    q = 0.03
    actual = force(only(build(COLUMN), MorisonDrag), [0, 0, 0, 0, q, 0])
    per_length = lambda z: -0.5 * RHO * 1.1 * 10 * abs(q * z) * q * z  # noqa: E731
    assert_allclose(actual[0], quad(per_length, -20, 0)[0], rtol=1e-10)
    assert_allclose(actual[4], quad(lambda z: z * per_length(z), -20, 0)[0], rtol=1e-10)


def test_drag_of_an_oblique_flow_on_a_column() -> None:
    """A circle sees the flow's vector: the force is against it, with the square of its whole speed."""
    actual = force(only(build(COLUMN), MorisonDrag), [0.6, -0.8, 0, 0, 0, 0])
    assert_allclose(actual[:2], -0.5 * RHO * 1.1 * 200 * np.array([0.6, -0.8]), rtol=1e-11)


def test_drag_of_a_pontoon_in_pitch() -> None:
    """Vertical drag on the plan width, integral of 1/2 rho Cd B |q x| q x and its moment, by quad; w = -q x."""
    q = -0.02
    actual = force(only(build(PONTOON), MorisonDrag), [0, 0, 0, 0, q, 0])
    per_length = lambda x: 0.5 * RHO * 2.3 * 12.5 * abs(q * x) * q * x  # noqa: E731
    assert_allclose(actual[2], quad(per_length, 5, 45)[0], rtol=1e-10)
    assert_allclose(actual[4], quad(lambda x: -x * per_length(x), 5, 45)[0], rtol=1e-10)


@pytest.mark.parametrize("speed", ["vector", "component"])
def test_drag_of_a_rectangle_by_vector_or_component(speed: str) -> None:
    """Side area 7 x 40 with Cd_t, plan 12.5 x 40 with Cd_z; |.| of the vector (OpenFAST) or of the component."""
    v, w = 0.7, -0.4
    actual = force(only(build(PONTOON, drag_speed=speed), MorisonDrag), [0, v, w, 0, 0, 0])
    of = (math.hypot(v, w),) * 2 if speed == "vector" else (abs(v), abs(w))
    expected = [0, -0.5 * RHO * 1.1 * 7 * 40 * of[0] * v, -0.5 * RHO * 2.3 * 12.5 * 40 * of[1] * w]
    assert_allclose(actual[:3], expected, rtol=1e-11, atol=1e-4)


def test_no_strip_drag_along_a_member() -> None:
    """A column that heaves and a pontoon that runs along itself have end drag at most."""
    column = only(build(COLUMN), MorisonDrag).with_values({"column.Cd_z": 0.0})
    assert_allclose(force(column, [0, 0, 2.0, 0, 0, 0]), 0.0, atol=1e-3)
    assert_allclose(force(only(build(PONTOON), MorisonDrag), [2.0, 0, 0, 0, 0, 0]), 0.0, atol=1e-3)


def test_drag_turns_with_the_body() -> None:
    """Pitched by 20 degrees, a surge along earth's x meets a submerged column with its transverse part only."""
    model = only(build({**COLUMN, "rA": [0, 0, -60], "rB": [0, 0, -30]}), MorisonDrag).with_values({"column.Cd_z": 0.0})
    matrix = Rotation.from_euler("y", 20, degrees=True).as_matrix()
    body = matrix.T @ [1.0, 0, 0]
    actual = force(model, [*body, 0, 0, 0], [0, 0, 0, 0, math.radians(20), 0])
    across = math.cos(math.radians(20))
    assert_allclose(actual[:3], [-0.5 * RHO * 1.1 * 300 * across**2, 0, 0], rtol=1e-11, atol=1e-3)


def test_end_drag() -> None:
    """1/2 rho Cd pi/4 D^2 |w| w on the bottom that is in the water; the dry top adds nothing; its lever in pitch."""
    model = only(build({**COLUMN, "rA": [30, 0, -20], "rB": [30, 0, 15]}), MorisonDrag)
    area = math.pi * 25
    actual = force(model, [0, 0, -0.9, 0, 0, 0])
    assert_allclose(actual[[2, 4]], np.array([1, -30]) * 0.5 * RHO * 2.3 * area * 0.81, rtol=1e-11)
    assert_allclose(force(model, [0, 0, 0, 0, 0.02, 0])[2], 0.5 * RHO * 2.3 * area * 0.36, rtol=1e-11)
    sunk = only(build({**COLUMN, "rA": [30, 0, -60], "rB": [30, 0, -30]}), MorisonDrag)
    assert_allclose(force(sunk, [0, 0, -0.9, 0, 0, 0])[2], 2 * actual[2], rtol=1e-11)


# added mass


def added_mass(model: jh.Model) -> np.ndarray:
    return np.asarray(wrench(model, jnp.zeros(6), jnp.zeros(6))[1])


def test_added_mass_of_a_column() -> None:
    """a = rho Ca pi/4 D^2 per metre: a T, -a T^2/2 in surge-pitch, a T^3/3 about the waterline; both planes alike."""
    actual = added_mass(only(build(COLUMN), StripInertia))
    a, depth = RHO * 0.9 * math.pi / 4 * 100, 20.0
    expected = np.zeros((6, 6))
    expected[0, 0] = expected[1, 1] = a * depth
    expected[0, 4] = expected[4, 0] = -a * depth**2 / 2
    expected[1, 3] = expected[3, 1] = a * depth**2 / 2
    expected[3, 3] = expected[4, 4] = a * depth**3 / 3
    assert_allclose(actual, expected, rtol=1e-11, atol=1e-3)


def test_added_mass_of_a_pontoon() -> None:
    """rho Ca B H per metre: heave with Ca_z, sway with Ca_t, levers x and z = -16.5 m; nothing along itself."""
    actual = added_mass(only(build(PONTOON), StripInertia))
    vertical, side = RHO * 0.6 * 12.5 * 7 * 40, RHO * 0.9 * 12.5 * 7 * 40
    square = (45**3 - 5**3) / (3 * 40)
    assert_allclose(actual[2, [2, 4]], [vertical, -vertical * 25], rtol=1e-11)
    assert_allclose(actual[4, 4], vertical * square, rtol=1e-11)
    assert_allclose(actual[1, [1, 3, 5]], [side, side * 16.5, side * 25], rtol=1e-11)
    assert_allclose(actual[[3, 5], [3, 5]], [side * 16.5**2, side * square], rtol=1e-11)
    assert_allclose(actual[0], 0.0, atol=1e-4)


def test_added_mass_of_ends() -> None:
    """rho Ca 2/3 pi r^3 on the wet end, lever 30 m; a square end counts as the circle of its area."""
    ball = RHO * 0.6 * 2 / 3 * math.pi * 125
    actual = added_mass(only(build({**COLUMN, "rA": [30, 0, -20], "rB": [30, 0, 15]}), EndInertia))
    assert_allclose([actual[2, 2], actual[2, 4], actual[4, 4]], [ball, -30 * ball, 900 * ball], rtol=1e-11)
    box = {**COLUMN, "shape": "rect", "d": [8.0, 10.0]}
    radius = math.sqrt(80 / math.pi)
    assert_allclose(added_mass(only(build(box), EndInertia))[2, 2], ball * radius**3 / 125, rtol=1e-11)


def test_added_mass_of_a_tapered_column() -> None:
    """Volume of the frustum, pi L/12 (D^2 + D d + d^2), and its first moment by quad."""
    cone = {**COLUMN, "d": [12.0, 6.0], "stations": [0, 1], "rA": [0, 0, -50], "rB": [0, 0, -20]}
    actual = added_mass(only(build(cone), StripInertia))
    volume = math.pi * 30 / 12 * (144 + 72 + 36)
    first = quad(lambda z: z * math.pi / 4 * (12 - 6 * (z + 50) / 30) ** 2, -50, -20)[0]
    assert_allclose(actual[0, [0, 4]], RHO * 0.9 * np.array([volume, first]), rtol=1e-11)


def test_strips_follow_the_surface() -> None:
    """A column lifted by 3 m has 17 m in the water and is loaded there: instantaneous wetting; not so with mean."""
    for wetting, depth in (("instantaneous", 17.0), ("mean", 20.0)):
        model = only(build(COLUMN, wetting=wetting), MorisonDrag)
        actual = force(model, [1.0, 0, 0, 0, 0, 0], [0, 0, 3.0, 0, 0, 0])[0]
        assert_allclose(actual, -0.5 * RHO * 1.1 * 10 * depth, rtol=1e-11)
    leaning = only(build(COLUMN), MorisonDrag)
    actual = force(leaning, [0, 1.0, 0, 0, 0, 0], [0, 0, 0, 0, math.radians(15), 0])[1]
    assert_allclose(actual, -0.5 * RHO * 1.1 * 10 * 20, rtol=1e-11)  # along its axis, from -20 m to the surface


def test_centripetal_part_of_added_mass() -> None:
    """A pontoon turning about the vertical: its added mass along y at x feels no a_y, and none along itself."""
    model = only(build(PONTOON), StripInertia)
    assert_allclose(force(model, [0, 0, 0, 0, 0, 0.1]), 0.0, atol=1e-4)
    turned = only(build({**PONTOON, "rA": [20, -20, -16.5], "rB": [20, 20, -16.5]}), StripInertia)
    actual = force(turned, [0, 0, 0, 0, 0, 0.1])  # its x acceleration is -r^2 x
    assert_allclose(actual[0], RHO * 0.9 * 12.5 * 7 * 40 * 0.01 * 20, rtol=1e-10)
    without = only(build({**PONTOON, "rA": [20, -20, -16.5], "rB": [20, 20, -16.5]}, centripetal=False), StripInertia)
    assert_allclose(force(without, [0, 0, 0, 0, 0, 0.1]), 0.0, atol=1e-4)
    assert_allclose(added_mass(without), added_mass(turned), rtol=1e-14)


# lumped terms


def test_linear_damping_and_its_labels() -> None:
    """F_i = -B_ij v_j in body axes, row before column."""
    model = model_of(build(), LinearDamping({"B15": 3.0, "B22": 2.0}))
    assert_allclose(force(model, [0, 4, 0, 0, 5, 0], [0, 0, 0, 0.1, 0.2, 0.3]), [-15, -8, 0, 0, 0, 0], rtol=1e-14)
    assert model.about("linear_damping.B15").unit == "N s"
    assert model.about("linear_damping.B15").meaning == "linear damping: surge force from pitch velocity"
    assert model.about("linear_damping.B22").meaning == "linear damping in sway"


def test_quadratic_damping_and_its_labels() -> None:
    """F_i = -Q_ii |v_i| v_i."""
    model = model_of(build(), QuadraticDamping({"B33": 2.0, "B55": 7.0}))
    assert_allclose(force(model, [1, 0, -4, 0, 5, 0]), [0, 0, 32, 0, -175, 0], rtol=1e-12)
    assert model.about("quadratic_damping.B55").unit == "N m s2/rad2"
    assert model.about("quadratic_damping.B55").meaning == "quadratic damping in pitch"


def test_lumped_added_mass_and_its_labels() -> None:
    """A matrix of its labels, in body axes."""
    model = model_of(build(), AddedMass({"A15": 3.0, "A51": 3.0, "A66": 8.0}))
    expected = np.zeros((6, 6))
    expected[0, 4] = expected[4, 0] = 3.0
    expected[5, 5] = 8.0
    assert_allclose(added_mass(model), expected)
    assert model.about("added_mass.A15").unit == "kg m"
    meanings = [model.about(f"added_mass.{label}").meaning for label in ("A15", "A51", "A66")]
    assert meanings == [
        "added mass: surge force from pitch acceleration",
        "added mass: pitch moment from surge acceleration",
        "added mass in yaw",
    ]


def test_lumped_stiffness_acts_along_earth_axes() -> None:
    """F0 - C q on a platform that is turned: not turned with it."""
    preload = jnp.array([1.0, 0, -2.0, 0, 0, 4.0])
    model = model_of(build(), Stiffness({"C11": 5.0, "C15": 7.0}, preload, "mooring"))
    position = jnp.array([2.0, 1.0, 0, 0.1, 0.2, 0.5])
    assert_allclose(at_rest(model, position), [1 - 10 - 1.4, 0, -2, 0, 0, 4], rtol=1e-13, atol=1e-14)
    meanings = [
        Stiffness({label: 1.0}, preload, name).about(f"{name}.{label}").meaning
        for name in ("mooring", "stiffness")
        for label in ("C11", "C15")
    ]
    assert meanings == [
        "mooring stiffness in surge",
        "mooring stiffness: surge force from pitch displacement",
        "stiffness in surge",
        "stiffness: surge force from pitch displacement",
    ]
    assert CoupledDamping({"B15": 0.0}).about("coupled_damping.B15").meaning == "linear damping that couples surge and pitch"


def test_weight() -> None:
    """-m g at the displaced centre: R c x (0, 0, -m g), with scipy's rotation."""
    model = only(build(rigid_body=BODY | {"centre_of_mass": [1.0, -2.0, -8.0]}), Weight)
    position = jnp.array([5.0, 6.0, 1.0, 0.1, -0.3, 0.7])
    arm = Rotation.from_euler("ZYX", [0.7, -0.3, 0.1]).apply([1.0, -2.0, -8.0])
    down = np.array([0, 0, -8e6 * G])
    assert_allclose(at_rest(model, position), [*down, *np.cross(arm, down)], rtol=1e-12, atol=1e-6)


# buoyancy


def brute_force(position, x: float, y: float, diameter: float, bottom: float) -> np.ndarray:
    """Buoyancy (N, N m, earth axes about the reference point) of an upright column of a tilted body, by a polar grid
    over its section: the wet part of every line along its axis, up to the plane of still water."""
    matrix = Rotation.from_euler("ZYX", position[:2:-1]).as_matrix()
    node, weight = np.polynomial.legendre.leggauss(12)
    radius = 0.25 * diameter * (1 + node)
    angle = np.arange(24) * 2 * np.pi / 24
    px, py = x + np.outer(radius, np.cos(angle)), y + np.outer(radius, np.sin(angle))
    area = np.outer(0.25 * diameter * weight * radius, np.full(24, 2 * np.pi / 24))
    top = -(position[2] + matrix[2, 0] * px + matrix[2, 1] * py) / matrix[2, 2]
    volume = (area * (top - bottom)).sum()
    first = [(area * (top - bottom) * p).sum() for p in (px, py)] + [(area * 0.5 * (top**2 - bottom**2)).sum()]
    up = np.array([0.0, 0.0, RHO * G])
    return np.concatenate([volume * up, np.cross(matrix @ first, up)])


@pytest.mark.parametrize("heave", [-3.0, 0.0, 3.0])
@pytest.mark.parametrize("roll, pitch, yaw", [(0, 0, 0), (0, 5, 0), (0, 15, 0), (-15, 0, 0), (8, -12, 40)])
def test_buoyancy_of_an_inclined_column(heave: float, roll: float, pitch: float, yaw: float) -> None:
    """Force and moment of the displaced cylinder against numerical integration of its wet volume; off the centre."""
    position = np.array([4.0, -3.0, heave, *np.radians([roll, pitch, yaw])])
    model = only(build({**COLUMN, "rA": [12, 5, -20], "rB": [12, 5, 15]}), Buoyancy)
    expected = brute_force(position, 12.0, 5.0, 10.0, -20.0)
    actual = np.asarray(at_rest(model, jnp.asarray(position)))
    assert_allclose(actual, expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


def test_buoyancy_of_a_submerged_box() -> None:
    """rho g V at its centroid whatever its attitude."""
    position = np.array([0, 0, -4.0, 0.1, 0.2, 0.3])
    actual = np.asarray(at_rest(only(build(PONTOON), Buoyancy), jnp.asarray(position)))
    up = np.array([0, 0, RHO * G * 12.5 * 7 * 40])
    arm = Rotation.from_euler("ZYX", [0.3, 0.2, 0.1]).apply([25.0, 0, -16.5])
    assert_allclose(actual, [*up, *np.cross(arm, up)], rtol=1e-12, atol=1e-6 * up[2])


def test_buoyancy_of_a_frustum() -> None:
    """pi L/12 (D^2 + D d + d^2)."""
    cone = {**COLUMN, "d": [12.0, 6.0], "stations": [0, 1], "rA": [0, 0, -50], "rB": [0, 0, -20]}
    actual = at_rest(only(build(cone), Buoyancy))
    assert float(actual[2]) == pytest.approx(RHO * G * math.pi * 30 / 12 * (144 + 72 + 36), rel=1e-12)


def test_a_body_turned_upside_down_in_the_file_is_the_same() -> None:
    """rA above rB is the same column."""
    position = jnp.array([0, 0, 1.0, 0.1, 0.2, 0.0])
    upwards, downwards = (
        only(build({**COLUMN, "rA": a, "rB": b}), Buoyancy, MorisonDrag, StripInertia, EndInertia)
        for a, b in (([9, 0, -20], [9, 0, 15]), ([9, 0, 15], [9, 0, -20]))
    )
    velocity = jnp.array([1.0, 0.5, -0.4, 0.02, -0.03, 0.01])
    for a, b in zip(wrench(upwards, position, velocity, SEA), wrench(downwards, position, velocity, SEA), strict=True):
        assert_allclose(a, b, rtol=1e-11, atol=1e-11 * float(jnp.abs(a).max()))


def test_hydrostatic_stiffness_of_a_column() -> None:
    """C33 = rho g A, C44 = C55 = rho g (I + A x^2) + rho g V z_B - m g z_G, C35 = -rho g A x."""
    x, area, depth = 12.0, math.pi * 25, 20.0
    actual = np.asarray(stiffness(only(build({**COLUMN, "rA": [x, 0, -20], "rB": [x, 0, 15]}), Buoyancy, Weight)))
    second, volume = math.pi / 64 * 1e4, area * depth
    upright = RHO * G * (second + volume * -10) - 8e6 * G * -8
    assert_allclose(actual[2, 2], RHO * G * area, rtol=1e-11)
    assert_allclose(actual[2, 4], -RHO * G * area * x, rtol=1e-11)
    assert_allclose(actual[4, 4], upright + RHO * G * area * x**2, rtol=1e-11)
    assert_allclose(actual[3, 3], upright, rtol=1e-11)


HULL = [
    {**COLUMN, "rA": [r, 0, -20], "rB": [r, 0, 15], "heading": [60, 180, 300], "name": name}
    for name, r in (("outer", 40), ("inner", 25))
]


@pytest.mark.parametrize(
    "declared",
    [
        {"C33": 5e6},
        {"C44": 1.1e9},
        {"C55": 1.2e9},
        {"C44_buoyancy": 8e8, "C55_buoyancy": 9e8},
        {"displaced_volume": 12000.0},
        {"displaced_volume": 9000.0, "C33": 4e6, "C44": 1e9, "C55_buoyancy": 9e8},
    ],
    ids=lambda declared: "-".join(declared),
)
@pytest.mark.parametrize("members", [True, False], ids=["members", "bare"])
def test_declared_hydrostatics_come_out(declared: dict, members: bool) -> None:
    """What the file declares is force and stiffness about the upright platform; `_buoyancy` leaves the weight out."""
    hull = HULL if members else []
    plain = only(build(*hull), Buoyancy, Weight)
    model = only(build(*hull, hydrostatics=declared), Buoyancy, Weight)
    actual, own = np.asarray(stiffness(model)), np.asarray(stiffness(plain))
    lift = float(at_rest(model)[2]) + 8e6 * G
    own_lift = float(at_rest(plain)[2]) + 8e6 * G
    volume = declared.get("displaced_volume", own_lift / (RHO * G))
    assert lift == pytest.approx(RHO * G * volume, rel=1e-12)
    extra = (lift - own_lift) * (-10.0 if members else 0.0)  # volume without a place: at the members' centroid
    weight = -8e6 * G * -8
    for i, key in ((2, "C33"), (3, "C44"), (4, "C55")):
        expected = own[i, i] + (extra if i > 2 else 0.0)
        if f"{key}_buoyancy" in declared:
            expected = declared[f"{key}_buoyancy"] + weight
        assert actual[i, i] == pytest.approx(declared.get(key, expected), rel=1e-10), key
    off = actual - np.diag(np.diag(actual))
    assert np.abs(off).max() < 1e-8 * max(np.abs(own).max(), 1e9)


def test_a_bare_platform_floats_in_balance() -> None:
    """Without members the volume is what balances mass and mooring: no net force at the reference position."""
    model = build(mooring={"kind": "stiffness_matrix", "stiffness": {"C33": 1e4}, "preload": [0, 0, -5e6, 0, 0, 0]})
    assert abs(float(at_rest(model)[2])) < 1e-6 * 8e6
    springs = {**SPRINGS, "lines": [{**line, "anchor": [*line["anchor"][:2], -150.0]} for line in SPRINGS["lines"]]}
    assert abs(float(at_rest(build(mooring=springs))[2])) < 1e-6 * 8e6


# mooring


def moored() -> jh.Model:
    return only(build(mooring=SPRINGS), MooringLines)


def test_stiffness_of_pretensioned_springs() -> None:
    """K11 = sum k c^2 + T/l s^2, K33 = sum T/l; K55 from k u u' + T/l (1 - u u') at fairleads and turned pull."""
    actual = np.asarray(stiffness(moored()))
    length = math.hypot(150.0 - 29.0, 259.80762 - 50.22947)
    azimuth = np.arctan2([259.80762 - 50.22947, 0.0, -259.80762 + 50.22947], [121.0, -242.0, 121.0])
    tension = 1.5e6
    surge = sum(45e3 * np.cos(azimuth) ** 2 + tension / 242.0 * np.sin(azimuth) ** 2)
    assert length == pytest.approx(242.0, rel=1e-6)
    assert actual[0, 0] == pytest.approx(surge, rel=1e-6)
    assert actual[2, 2] == pytest.approx(3 * tension / 242.0, rel=1e-6)
    pitch, e = 0.0, np.array([0.0, 1.0, 0.0])
    for line in SPRINGS["lines"]:
        fairlead = np.array(line["fairlead"])
        way = np.array(line["anchor"]) - fairlead
        unit, span = way / np.linalg.norm(way), np.linalg.norm(way)
        matrix = 45e3 * np.outer(unit, unit) + tension / span * (np.eye(3) - np.outer(unit, unit))
        moved = np.cross(e, fairlead)
        pitch -= e @ (np.cross(moved, tension * unit) - np.cross(fairlead, matrix @ moved))
    assert actual[4, 4] == pytest.approx(pitch, rel=1e-10)


def test_springs_at_large_offsets_and_slack() -> None:
    """Geometric law line by line in NumPy; 50 m towards an anchor its line is slack and pulls nothing."""
    model = moored()
    for position in ([-50.0, 0, 0, 0, 0, 0], [30.0, -20.0, 4.0, 0.1, -0.2, 0.3]):
        matrix = Rotation.from_euler("ZYX", position[:2:-1]).as_matrix()
        expected, slack = np.zeros(6), 0
        for line in SPRINGS["lines"]:
            arm = matrix @ line["fairlead"]
            way = np.array(line["anchor"]) - position[:3] - arm
            length = np.linalg.norm(way)
            tension = max(0.0, 45e3 * (length - (242.0 - 1.5e6 / 45e3)))
            slack += tension == 0.0
            pull = tension * way / length
            expected += [*pull, *np.cross(arm, pull)]
        assert slack == (position[0] == -50.0)
        actual = np.asarray(at_rest(model, jnp.asarray(position)))
        assert_allclose(actual, expected, rtol=1e-6, atol=1e-6 * np.abs(expected).max())
        assert bool(jnp.isfinite(stiffness(model, jnp.asarray(position))).all())


def test_spring_by_axial_stiffness() -> None:
    """EA/l0 (l - l0): the two ways to declare a line agree."""
    unstretched = 242.0 - 1.5e6 / 45e3
    by_stiffness = [
        {key: line[key] for key in ("anchor", "fairlead")}
        | {"axial_stiffness": 45e3 * unstretched, "unstretched_length": unstretched}
        for line in SPRINGS["lines"]
    ]
    position = jnp.array([5.0, 3.0, 1.0, 0.05, 0.1, -0.2])
    model = only(build(mooring={"kind": "linear_springs", "lines": by_stiffness}), MooringLines)
    assert_allclose(at_rest(model, position), at_rest(moored(), position), rtol=1e-5, atol=10.0)
