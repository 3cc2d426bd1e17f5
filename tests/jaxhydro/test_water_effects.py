"""What the water, the waves and the sensors do that a model may lack: closed forms, and double sums done here in NumPy."""

import dataclasses
import math
from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import drift, elevation, flow, one_program
from scipy.signal import hilbert
from scipy.spatial.transform import Rotation
from scipy.special import h1vp
from test_loads import COEFFICIENTS, COLUMN, PONTOON, RHO, SEA, G, build, force, model_of, only

import jaxhydro as jh
from jaxhydro.dynamics.observe import clock_lag, reading_at
from jaxhydro.environment import DOFS
from jaxhydro.loads import (
    AbstractLoad,
    MorisonDrag,
    WaveDrift,
    WaveDriftDamping,
    WaveExcitation,
)
from jaxhydro.loads.drag import SlowMotionLaw, SpeedPowerLaw
from jaxhydro.parameters import AbstractEffect
from jaxhydro.quick_jit import on_device
from jaxhydro.sensors import SensorLag, SensorReference
from jaxhydro.water import Current, WaveGaugePosition, WaveReflection
from jaxhydro.waves import Clock, PlaneWaves, WaveSea

WATER = jh.Environment(RHO, 200.0, G)
CD_T, CD_Z = COEFFICIENTS["Cd_t"], COEFFICIENTS["Cd_z"]
AREA = 10.0 * 20.0  # m2, of the column in the water
HULL = np.array([[-30.0, 0, -20], [45.0, 10, -20], [0, -10, 15.0]]).T
VELOCITY = np.array([1.1, -0.6, 0.7, 0.02, -0.03, 0.01])
POSITION = (3.0, -2.0, 1.0, 0.05, -0.1, 0.2)


def with_values(load: AbstractEffect, **values: float) -> AbstractEffect:
    """An effect with parameters of these last parts of their labels."""
    return load.at_values({label: values.get(label.rsplit(".", 1)[1], value) for label, value in load.values.items()})


def irregular(order: int = 1, heading: float = 0.0, ramp: float = 0.0) -> jh.IrregularSea:
    waves = jh.spectrum_components(
        lambda omega: jh.jonswap(omega, 5.0, 10.0), 100.0, WATER, low=0.05, cutoff=0.2, seed=3, heading=heading
    )
    return jh.IrregularSea(waves, WATER, order, ramp=ramp)


@eqx.filter_jit
def acting(model: jh.Model, position, velocity, memory, sea, time) -> tuple[jax.Array, tuple]:
    """Force of all loads in body axes, and the rates of their memories."""
    now = model.instant(time, jh.State(position, velocity, memory), sea)
    total = model.sum_of_loads(now, memory)
    return total.force, total.memory_rate


def acts(model: jh.Model, position, velocity, memory, sea, time: float = 0.0) -> tuple[np.ndarray, tuple]:
    """The same, of anything."""
    force, rates = acting(model, *(jnp.asarray(x, float) for x in (position, velocity)), memory, sea, jnp.asarray(time))
    return np.asarray(force), rates


@one_program
def through(load: AbstractEffect, sea: jh.AbstractSea) -> jh.AbstractSea:
    """The sea that the effect makes of another."""
    return load.through(sea)


@one_program
def seen(load: SensorReference, position) -> jax.Array:
    return load.seen(position)


@eqx.filter_jit
def water(sea: jh.AbstractSea, time, points, load: AbstractLoad | None = None) -> tuple:
    """Velocity, acceleration and pressure along earth axes, elevation, and what slow forces go with."""
    sea = sea if load is None else load.through(sea)
    flow = sea.flow(time, points).earth()
    return flow.velocity, flow.acceleration, flow.pressure, sea.elevation(time, points[:2]), sea.drift(time)


# current


def test_drag_in_a_current() -> None:
    """1/2 rho Cd D T |U| U on a column that is held, oblique; as much on one that is moved the other way in still water."""
    plain = only(build(COLUMN), MorisonDrag)
    flowing = plain.with_effect(with_values(Current(), x=0.9, y=-1.2))
    expected = 0.5 * RHO * CD_T * AREA * 1.5 * np.array([0.9, -1.2])
    assert_allclose(force(flowing)[:2], expected, rtol=1e-11)
    assert_allclose(force(plain, [-0.9, 1.2, 0, 0, 0, 0])[:2], expected, rtol=1e-11)


def test_a_current_is_galilean() -> None:
    """Whoever goes with the stream feels none; any motion in it is that of the difference, in an attitude, too."""
    plain = only(build(COLUMN, PONTOON), MorisonDrag)
    stream = np.array([0.9, -1.2, 0.0])
    flowing = plain.with_effect(with_values(Current(), x=0.9, y=-1.2))
    in_body = np.concatenate([Rotation.from_euler("ZYX", POSITION[:2:-1]).as_matrix().T @ stream, np.zeros(3)])
    assert_allclose(force(flowing, in_body, POSITION), 0.0, atol=1e-5)
    expected = force(plain, VELOCITY - in_body, POSITION)
    assert_allclose(force(flowing, VELOCITY, POSITION), expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


# sensors


def test_what_a_point_off_the_reference_reads() -> None:
    """p + R o - o with scipy's rotation, over any leading axes; at zero attitude, and at the neutral value, p to the bit."""
    position = np.random.default_rng(0).uniform(-0.5, 0.5, (2, 3, 6))
    load = with_values(SensorReference(), x=4.0, z=-6.0)
    offset = np.array([4.0, 0.0, -6.0])
    actual = np.asarray(seen(load, position))
    turned = Rotation.from_euler("ZYX", position[..., :2:-1].reshape(-1, 3)).apply(offset).reshape(2, 3, 3)
    assert_allclose(actual[..., :3], position[..., :3] + turned - offset, atol=1e-14)
    assert (actual[..., 3:] == position[..., 3:]).all()
    assert (np.asarray(seen(SensorReference(), position)) == position).all()
    upright = position * [1, 1, 1, 0, 0, 0]
    assert (np.asarray(seen(load, upright)) == upright).all()
    slope = one_program(jax.jacfwd(lambda z: dataclasses.replace(load, z=z).seen(jnp.array([0.0, 0, 0, 0, 0.1, 0]))))(0.0)
    assert_allclose(slope, [math.sin(0.1), 0, math.cos(0.1) - 1, 0, 0, 0], atol=1e-15)


def test_a_delay_is_late() -> None:
    """y_rec(t) = y(t - delay), through the model; None where no load is about clocks."""
    model = build(COLUMN)
    assert clock_lag(model) is None
    late = model.with_effect(with_values(SensorLag(), delay=0.7))
    assert float(clock_lag(late)) == 0.7
    assert (force(late, VELOCITY, POSITION) == force(model, VELOCITY, POSITION)).all()


# where the gauge stood


def test_a_gauge_further_along_by_hand() -> None:
    """It recorded a cos(omega t), was said to be at x = 12 m and stood at 12 + 30 m: there the sea is a cos(omega t)."""
    stated = jh.regular_wave(2.0, 8.0, WATER)
    k = float(np.asarray(stated.waves.vector)[0, 0])
    stated = jh.regular_wave(2.0, 8.0, WATER, phase=k * 12.0)
    t = 3.3
    recorded = math.cos(2 * math.pi / 8.0 * 3.3)
    assert float(elevation(stated, t, np.array([[12.0], [0.0]]))[0]) == pytest.approx(recorded, abs=1e-12)
    load = with_values(WaveGaugePosition(), distance=30.0)
    assert float(elevation(through(load, stated), t, np.array([[42.0], [5.0]]))[0]) == pytest.approx(recorded, abs=1e-12)


@pytest.mark.parametrize("order, heading", [(1, 0.0), (2, 0.6)])
def test_a_moved_sea_is_one_of_other_phases(order: int, heading: float) -> None:
    """Prepared, direct and by components, flow and surface, against the sea whose components have phases + k d."""
    sea = irregular(order, heading)
    waves = sea.components
    phase = on_device(np.asarray(waves.phase) + 9.0 * np.asarray(waves.wavenumber))
    expected = dataclasses.replace(sea, components=dataclasses.replace(waves, phase=phase))
    load = with_values(WaveGaugePosition(), distance=9.0)
    prepared = sea.prepared(HULL, None, Clock(10.0, 0.25, 100, (0.0,)))
    along = np.array([-20.0, 3.0, 25.0])
    points = on_device(np.stack([along * np.cos(heading), along * np.sin(heading), [-15.0, -4.0, 0.0]]))
    assert_allclose(through(load, sea).components.phase, expected.components.phase, atol=1e-12)
    expected = expected.direct()
    time = jnp.asarray(23.5)
    *exact, slow = water(expected, time, points)
    for unmoved, tolerance in ((prepared, 1e-5), (sea.direct(), 1e-12)):
        *actual, drifting = water(unmoved, time, points, load)
        for part, exact_part in zip(actual, exact, strict=True):
            assert_allclose(part, exact_part, atol=5 * tolerance * np.abs(exact_part).max())
        assert unmoved is prepared or np.abs(np.asarray(drifting) - np.asarray(slow)).max() < 1e-9
    same = zip(*(jax.tree.leaves(which) for which in (through(WaveGaugePosition(), prepared), prepared)), strict=True)
    assert all(np.array_equal(a, b) for a, b in same)
    assert isinstance(load.through(jh.StillWater()), jh.StillWater)


def test_a_moved_envelope_goes_with_the_group() -> None:
    """In a narrow band the squared envelope that passes 12 m further down is that of before, but for dispersion."""
    waves = jh.spectrum_components(lambda w: jh.jonswap(w, 5.0, 10.0), 400.0, WATER, low=0.085, cutoff=0.115, seed=3)
    sea, load = jh.IrregularSea(waves, WATER), with_values(WaveGaugePosition(), distance=12.0)
    prepared, direct = sea.prepared(HULL, None, Clock(10.0, 0.25, 1000, (0.0,))), sea.direct()
    times = np.linspace(20.0, 240.0, 60)
    seas = through(load, prepared), through(load, direct), direct
    drifts = one_program(lambda sea, times: jax.vmap(sea.drift)(times))
    actual, exact, still = (np.asarray(drifts(series, times)) for series in seas)
    missed, moved = (np.abs(series - exact).max(axis=0) for series in (actual, still))
    assert (missed[:3] < 0.1 * moved[:3]).all()
    assert_allclose(actual[:, 3], still[:, 3], rtol=1e-9)  # the mean is the same everywhere


# drift


def squares(sea: jh.IrregularSea, time: float) -> np.ndarray:
    """The four signals by a double sum over components."""
    waves = sea.components
    amplitude, omega = np.asarray(waves.complex_amplitude()), np.asarray(waves.omega)
    actual = np.zeros(4)
    for a, p in zip(amplitude, omega, strict=True):
        for b, q in zip(amplitude, omega, strict=True):
            pair = a * np.conj(b) * np.exp(1j * (p - q) * time)
            actual += pair.real, (-1j * np.sign(p - q) * pair).real, pair.real * (p**2 + q**2) / 2 / 0.36, pair.real * (p == q)
    return actual


@pytest.mark.parametrize("step", [0.25, 0.5])
def test_the_squared_envelope(step: float) -> None:
    """By double sums: direct, and prepared on the clock, beyond a period, and between its steps; by scipy's Hilbert."""
    sea = irregular(2)
    prepared, direct = sea.prepared(HULL, None, Clock(10.0, step, int(120 / step), (0.0, 0.5), 2)), sea.direct()
    for time, tolerance in ((10.0, 1e-9), (36.5, 1e-9), (10 + step / 2, 4e-3), (50 + step / 3, 4e-3), (125.5, 1e-9)):
        exact = squares(sea, time)
        assert_allclose(drift(direct, time), exact, atol=1e-9)
        assert_allclose(drift(prepared, time), exact, atol=tolerance * np.abs(exact).max())
    size = round(100 / step)
    series = np.asarray(prepared.envelope.series)[:size]
    assert_allclose(series[:, 1], hilbert(series[:, 0] - series[:, 0].mean()).imag, atol=1e-9)
    assert series[:, 0].mean() == pytest.approx(float((np.asarray(sea.components.amplitude) ** 2).sum()), rel=1e-9)
    assert series[:, 0].min() >= -1e-12


def test_the_envelope_grows_with_the_waves() -> None:
    """As the square of their height over the ramp; it is not that of second-order waves."""
    grown, whole = (irregular(1, ramp=ramp).prepared(HULL, None, Clock(0.0, 0.25, 100, (0.0,))) for ramp in (20.0, 0.0))
    share = 0.5 - 0.5 * math.cos(math.pi * 5.0 / 20.0)
    assert_allclose(drift(grown, 5.0), share**2 * np.asarray(drift(whole, 5.0)), rtol=1e-12)
    assert_allclose(drift(irregular(1, ramp=20.0), 5.0), drift(grown, 5.0), rtol=1e-9)


def test_wave_drift_is_its_transfer_function() -> None:
    """Double sum over A_k conj(A_l) T_kl with T of the docstring; Newman's mean in a regular wave; nothing in still water."""
    sea, (d0, d1, d2) = irregular(), (2e4, -7e3, 9e3)
    load = with_values(WaveDrift.neutral(("surge", "pitch")), envelope=d0, quadrature=d1, frequency_weighted=d2)
    model = model_of(build(COLUMN), load)
    waves = sea.components
    amplitude, omega, t = np.asarray(waves.complex_amplitude()), np.asarray(waves.omega), 36.5
    p, q = omega[:, None], omega[None]
    transfer = d0 - 1j * np.sign(p - q) * d1 + d2 * (p**2 + q**2) / (2 * 0.6**2)
    exact = (amplitude[:, None] * np.conj(amplitude) * np.exp(1j * (p - q) * t) * transfer).sum()
    assert abs(exact.imag) < 1e-9 * abs(exact)
    prepared = sea.prepared(HULL, None, Clock(10.0, 0.25, 200, (0.0,)))
    actual, _ = acts(model, np.zeros(6), np.zeros(6), (None,), prepared, t)
    assert_allclose(actual, exact.real * np.eye(6)[[0, 4]].sum(axis=0), rtol=1e-9)
    assert_allclose(force(model, sea=SEA)[0], (d0 + d2 * (2 * math.pi / 9.0 / 0.6) ** 2) * 1.5**2, rtol=1e-9)
    assert (force(model, VELOCITY) == 0).all()


def test_wave_drift_damping() -> None:
    """-alpha A^2 v in a regular wave of amplitude 1.5 m, in the degrees of freedom that it has; none in still water."""
    model = model_of(build(COLUMN), with_values(WaveDriftDamping.neutral(("surge", "pitch")), coefficient=3e4))
    expected = -3e4 * 1.5**2 * VELOCITY * [1, 0, 0, 0, 1, 0]
    assert_allclose(force(model, VELOCITY, POSITION, SEA), expected, rtol=1e-11, atol=1e-9)
    assert (force(model, VELOCITY) == 0).all()


@pytest.mark.parametrize("steady", [0.0, 0.3, 1.0])
def test_wave_drift_damping_of_a_sea_state_and_of_groups(steady: float) -> None:
    """In two waves, |a|^2 = a1^2 + a2^2 + 2 a1 a2 cos((w1 - w2) t + phase), of which the steady share has the mean."""
    waves = [jh.regular_wave(height, period, WATER).waves for height, period in ((2.0, 9.0), (3.0, 11.0))]
    model = model_of(build(COLUMN), with_values(WaveDriftDamping.neutral(("surge",)), coefficient=3e4, steady=steady))
    beat = 2 * math.pi * (1 / 9.0 - 1 / 11.0)
    mean, group = 1.0 + 1.5**2, 3.0 * math.cos(beat * 7.7)
    actual, _ = acts(model, np.zeros(6), VELOCITY, (None,), WaveSea(waves[0] + waves[1], WATER), 7.7)
    assert_allclose(actual[0], -3e4 * (mean + (1 - steady) * group) * VELOCITY[0], rtol=1e-9)


def test_a_prepared_sea_costs_nothing_more_where_nobody_drifts() -> None:
    """As many operations as without an envelope, and the same numbers."""
    sea = irregular().prepared(HULL, None, Clock(10.0, 0.25, 100, (0.0,)))
    plain = only(build(COLUMN), MorisonDrag)

    def cost(model: jh.Model, sea: jh.AbstractSea) -> tuple[float, np.ndarray]:
        leaves, shape = jax.tree.flatten(sea)
        run = jax.jit(lambda leaves: model.rate(jnp.asarray(12.5), model.rest(), jax.tree.unflatten(shape, leaves)).velocity)
        return run.lower(leaves).compile().cost_analysis()["flops"], np.asarray(run(leaves))

    bare, whole = (cost(plain, which) for which in (dataclasses.replace(sea, envelope=None), sea))
    assert bare[0] == whole[0] and (bare[1] == whole[1]).all()
    assert cost(plain.with_effect(WaveDrift.neutral(("surge", "heave", "pitch"))), sea)[0] > whole[0]


# reflection


def test_a_regular_wave_comes_back() -> None:
    """a cos(omega t - k x) + r a cos(omega (t - T) + k x), and its flow: along with the sign turned, up without."""
    sea = jh.regular_wave(2.0, 7.0, WATER, heading=0.5)
    load = with_values(WaveReflection(delay=13.0), coefficient=-0.2)
    omega, k = 2 * math.pi / 7.0, float(np.hypot(*np.asarray(sea.waves.vector)[:, 0]))
    x, z, t = 17.0, -4.0, 23.0
    points = np.array([[x * math.cos(0.5)], [x * math.sin(0.5)], [z]])
    incident, reflected = omega * t - k * x, omega * (t - 13.0) + k * x
    met = through(load, sea)
    assert_allclose(elevation(met, t, points[:2]), math.cos(incident) - 0.2 * math.cos(reflected), atol=1e-12)
    actual = flow(met, t, points)
    cosh, sinh = (f(k * (z + 200)) / math.cosh(k * 200) for f in (math.cosh, math.sinh))
    along = G * k / omega * cosh * (math.cos(incident) + 0.2 * math.cos(reflected))
    up = -G * k / omega * sinh * (math.sin(incident) - 0.2 * math.sin(reflected))
    assert_allclose(np.asarray(actual.velocity)[:, 0], [along * math.cos(0.5), along * math.sin(0.5), up], rtol=1e-9)
    assert_allclose(actual.pressure, G * cosh * (math.cos(incident) - 0.2 * math.cos(reflected)), rtol=1e-9)


def test_a_prepared_sea_comes_back() -> None:
    """Between the steps of its clock, too as the direct sum; nothing before the delay, and nothing at the neutral value."""
    sea = irregular(2, 0.3)
    prepared = sea.prepared(HULL, None, Clock(10.0, 0.25, 200, (0.0,), 3))
    load = with_values(WaveReflection(delay=8.1), coefficient=0.25)
    points = jnp.array([[-9.0, 21.0], [4.0, 7.0], [-12.0, -1.0]])
    met, exact = load.through(prepared), load.through(sea.direct())
    for part, exact_part in zip(*(water(which, jnp.asarray(40.5), points) for which in (met, exact)), strict=True):
        assert_allclose(part, exact_part, atol=2e-5 * np.abs(exact_part).max())
    for time, reflected in ((17.75, met), (10.125, met), (40.5, WaveReflection(delay=8.1).through(prepared))):
        actual, expected = (water(which, jnp.asarray(time), points) for which in (reflected, prepared))
        assert_allclose(actual[0], expected[0], rtol=1e-13)
    assert isinstance(load.through(jh.StillWater()), jh.StillWater)


def test_what_the_gauge_saw_come_back() -> None:
    """With r = 0.25, all of it in the record: the elevation at the origin is as measured, and the flow along the waves what
    r^2 leaves of sent and sent back."""
    sea = irregular(1, 0.3).direct()
    met = through(with_values(WaveReflection(delay=8.1), coefficient=0.25, seen=1.0), sea)
    time, origin, along = 40.5, np.array([[0.0], [0.0], [-4.0]]), np.asarray(one_program(lambda sea: sea.direction())(sea))
    assert_allclose(elevation(met, time, origin[:2]), elevation(sea, time, origin[:2]), atol=1e-12)
    back, now, then = flow(met, time, origin), flow(sea, time, origin), flow(sea, time - 8.1, origin)
    assert_allclose(back.pressure, now.pressure, rtol=1e-12)
    velocity, sent, returned = (along @ np.asarray(water_flow.velocity)[:2] for water_flow in (back, now, then))
    assert_allclose(velocity, sent - 0.5 * returned, rtol=1e-9)


@pytest.mark.slow
def test_slopes_of_a_prepared_sea_that_comes_back() -> None:
    """By the share, the delay, what the gauge saw and where it stood: those of the direct sum, and differences, on and above
    the surface."""
    sea = irregular(1, 0.3)
    model = model_of(only(build(COLUMN)), WaveGaugePosition(), WaveReflection())
    points = jnp.array([[-9.0, 21.0], [4.0, 7.0], [-12.0, 0.4]])
    labels = (*(f"wave_reflection.{name}" for name in ("coefficient", "delay", "seen")), "wave_gauge_position.distance")

    def met(which, x):  # unchecked: no share is negative, but its derivative at zero has two sides
        changed = model.at_values(dict(zip(labels, x))).through(which)
        return jnp.concatenate([jnp.ravel(column) for column in water(changed, jnp.asarray(40.5), points)[:4]])

    prepared = sea.prepared(HULL, None, Clock(10.0, 0.25, 200, (0.0,), 3))
    of_prepared, of_direct = partial(met, prepared), partial(met, sea.direct())
    value, forward, reverse, direct = map(
        one_program, (of_prepared, jax.jacfwd(of_prepared), jax.jacrev(of_prepared), jax.jacfwd(of_direct))
    )
    for x in (np.array([0.2, 8.1, 0.6, -1.5]), np.array([0.0, 8.1, 0.0, 0.0])):
        actual, exact = np.asarray(forward(x)), np.asarray(direct(x))
        apart = [np.asarray(value(x + e)) - np.asarray(value(x - e)) for e in 1e-5 * np.eye(4)]
        assert_allclose(actual, np.stack(apart, axis=1) / 2e-5, atol=1e-6 * np.abs(actual).max())
        for column, expected in zip(actual.T, exact.T, strict=True):
            assert_allclose(column, expected, atol=2e-4 * max(np.abs(expected).max(), 1e-3))
        assert_allclose(reverse(x), actual, atol=1e-10)


# all of them


def test_pressure_on_a_column_in_deep_water() -> None:
    """By integrals over a column: across it rho pi r^2 g a (1 - exp(-k d)), times what diffraction makes of it, 2 / (pi (k r)^2
    |H1'(k r)|) (MacCamy and Fuchs 1954), and on its end rho g a pi r^2 exp(-k d)."""
    deep, amplitude, draught, radius = jh.Environment(RHO, 2000.0, G), 0.01, 20.0, 5.0
    wave = jh.regular_wave(2 * amplitude, 9.0, deep, phase=0.7)
    k = (2 * np.pi / 9.0) ** 2 / G
    bare = only(build(COLUMN, water={"density": RHO, "depth": 2000.0, "gravity": G}))
    excited = model_of(bare, with_values(WaveExcitation({("column", kind): 1.0 for kind in "tz"}), Cp_t=1.4, Cp_z=0.7))
    actual = np.stack([acts(excited, np.zeros(6), np.zeros(6), (None,), wave, time)[0] for time in (0.0, 9.0 / 4)])
    area = np.pi * radius**2
    diffracted = 2 / (np.pi * (k * radius) ** 2 * abs(h1vp(1, k * radius)))
    across = 0.4 * RHO * area * G * amplitude * (1 - np.exp(-k * draught)) * diffracted
    upwards = -0.3 * RHO * G * amplitude * area * np.exp(-k * draught)
    size = np.linalg.norm(actual, axis=0)
    assert_allclose(size[[0, 2]], [across, abs(upwards)], rtol=1e-3)
    # pressure is in phase with the elevation
    crest = np.array([float(elevation(wave, t, np.zeros((2, 1)))[0]) for t in (0.0, 9.0 / 4)])
    assert_allclose(actual[:, 2] / upwards, crest / amplitude, atol=5e-3)


@pytest.mark.slow
def test_every_parameter_has_a_slope_at_its_null() -> None:
    """In two waves, moving: of force, flow or reading. The shapes of the low-pass and of what comes back alone have none."""
    first, second = (jh.regular_wave(2.0, period, WATER, phase=0.3).waves for period in (9.0, 11.0))
    sea = WaveSea(first + second, WATER)
    assert isinstance(sea.waves, PlaneWaves)
    plain = only(build(COLUMN, PONTOON), MorisonDrag)
    (drag,) = plain.loads
    kinds = (Current, SensorReference, SensorLag, WaveGaugePosition, WaveReflection)
    laws = [dataclasses.replace(drag, law=law) for law in (SpeedPowerLaw.neutral(drag.Cd), SlowMotionLaw())]
    laws += [WaveDrift.neutral(DOFS), WaveDriftDamping.neutral(DOFS)]
    model = model_of(plain, *plain.loads, *laws, *(kind() for kind in kinds))
    labels = [label for label in model.values if ".Cd_" not in label]
    memory = jax.tree.map(lambda leaf: jnp.asarray(VELOCITY[::-1].copy()), model.rest().memory)
    state = jh.State(jnp.asarray(POSITION), jnp.asarray(VELOCITY), memory)

    def look(x):
        changed = model.with_values(dict(zip(labels, x, strict=True)))
        total = changed.sum_of_loads(changed.instant(jnp.asarray(7.7), state, sea), memory).force
        return jnp.concatenate([total / 1e6, reading_at(changed, state.position), clock_lag(changed)[None]])

    x = np.array([float(model.about(label).neutral) for label in labels])
    assert (x == [float(model.values[label]) for label in labels]).all()
    slope = np.asarray(one_program(jax.jacfwd(look))(x))
    assert np.isfinite(slope).all()
    silent = {label for label, column in zip(labels, slope.T, strict=True) if not np.abs(column).max() > 1e-9}
    steady = {f"wave_drift_damping.{dof}.steady" for dof in DOFS}
    assert silent == {"sea_state_dependent_drag.cutoff", "wave_reflection.delay", "wave_reflection.seen", *steady}
