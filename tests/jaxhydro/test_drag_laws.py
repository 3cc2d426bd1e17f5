"""Drag laws beside Morison's: neutral values, filters against scipy's, closed forms, whole simulations, platform files."""

import dataclasses
import math

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import one_program
from scipy.integrate import solve_ivp
from scipy.signal import lfilter
from test_loads import (
    BODY,
    COEFFICIENTS,
    COLUMN,
    HIGH_PASS,
    KEULEGAN_CARPENTER,
    PONTOON,
    RHO,
    SEA,
    G,
    build,
    force,
    model_of,
    only,
)

import jaxhydro as jh
from calibration.decay_analysis.model_damping import model_damping
from calibration.parameters.space import default_free, parameter_space
from jaxhydro.dynamics import integrate
from jaxhydro.errors import InputError
from jaxhydro.input_schema import validate
from jaxhydro.loads import MorisonDrag
from jaxhydro.loads.drag import (
    DRAG_LAWS,
    AbstractDragLaw,
    ConstantLaw,
    HighPassLaw,
    KeuleganCarpenterLaw,
    SlowMotionLaw,
    SpeedPowerLaw,
    SuctionSideLaw,
)
from jaxhydro.platform.drag_laws import drag_laws_of, plain_drag, surface_number, with_drag_laws
from jaxhydro.platform.schema import Platform
from jaxhydro.water import Current

CD_T, CD_Z = COEFFICIENTS["Cd_t"], COEFFICIENTS["Cd_z"]


def with_laws(t: dict | None = None, z: dict | None = None, *, members=(COLUMN, PONTOON), ends=True, **changes) -> jh.Model:
    """Members whose drag has these laws, `ends` False leaving those of groups without columns plain."""
    rows = {}
    for member in members:
        column = member["shape"] == "circ"
        laws = {"drag_t": t} if t else {}
        own = z if z is None or column else {key: value for key, value in z.items() if key != "suction"}
        laws |= {"drag_z": own} if own and (column or ends) else {}
        rows[member["name"]] = COEFFICIENTS | laws
    return build(*members, coefficients=rows, **changes)


def lively(model: jh.Model, seed: int = 0) -> tuple:
    """Memories that are not at rest."""
    rng = np.random.default_rng(seed)
    leaves, shape = jax.tree.flatten(model.rest().memory)
    return jax.tree.unflatten(shape, [jnp.asarray(rng.uniform(0.2, 2.0, leaf.shape)) for leaf in leaves])


@eqx.filter_jit
def acting(model: jh.Model, position, velocity, memory, sea) -> tuple[jax.Array, tuple]:
    """Force of all loads in body axes, and the rates of their memories."""
    now = model.instant(jnp.zeros(()), jh.State(jnp.asarray(position), jnp.asarray(velocity), memory), sea)
    total = model.sum_of_loads(now, memory)
    return total.force, total.memory_rate


POSITION = jnp.array([3.0, -2.0, 1.0, 0.05, -0.1, 0.2])
VELOCITY = jnp.array([1.1, -0.6, 0.7, 0.02, -0.03, 0.01])


# the contract of all laws


def law_of(name: str, model: jh.Model) -> AbstractDragLaw:
    """A law of each kind, not at its neutral value, on all coefficients of a model."""
    keys, hull, coupled = keys_of(model), model.hull, only(model, MorisonDrag).loads[0].coupled
    ends = dict.fromkeys(keys, 0.6)
    high_pass = {"cutoff": dict.fromkeys(keys, 0.03), "low_share": dict.fromkeys(keys, 0.4)}
    constants = {"reference": dict.fromkeys(keys, 5.0), "window": dict.fromkeys(keys, 40.0)}
    return {
        "constant": lambda: ConstantLaw(),
        "high_pass": lambda: HighPassLaw.of(hull, **high_pass, law=SuctionSideLaw(ends)),
        "keulegan_carpenter": lambda: KeuleganCarpenterLaw.of(hull, dict.fromkeys(keys, -0.3), **constants, coupled=coupled),
        "suction_side": lambda: SuctionSideLaw(ends),
        "speed_power": lambda: SpeedPowerLaw({group: -0.3 for group, _ in keys}),
        "slow_motion": lambda: SlowMotionLaw(low_share=1.4, cutoff=0.04, law=SpeedPowerLaw({"column": -0.3})),
    }[name]()


def at_neutral(law: AbstractDragLaw) -> AbstractDragLaw:
    return law.at_values({label: law.about(label).neutral for label in law.values})


@pytest.mark.parametrize("speed", ["vector", "component"])
@pytest.mark.parametrize("name", DRAG_LAWS)
def test_a_neutral_value_is_constant_coefficients(name: str, speed: str) -> None:
    """In waves, moving, and whatever is remembered: to the bit, but for the velocity that a filter takes apart."""
    plain = only(build(COLUMN, PONTOON, drag_speed=speed), MorisonDrag)
    changed = with_law(plain, at_neutral(law_of(name, plain)))
    for sea in (jh.StillWater(), SEA):
        actual, _ = acting(changed, POSITION, VELOCITY, lively(changed), sea)
        expected, _ = acting(plain, POSITION, VELOCITY, lively(plain), sea)
        assert_allclose(actual, expected, atol=1e-15 * np.abs(expected).max(), rtol=1e-14)
        moved, _ = acting(with_law(plain, law_of(name, plain)), POSITION, VELOCITY, lively(changed), sea)
        assert name == "constant" or not np.allclose(moved, expected, rtol=1e-3)


@pytest.mark.parametrize("name", DRAG_LAWS)
def test_labels_and_values_come_back(name: str) -> None:
    """Each label once, its value and its meaning; what is changed by label is what is read; a wrapped law's are there, too."""
    model = with_law(build(COLUMN, PONTOON), law_of(name, build(COLUMN, PONTOON)))
    (drag,) = model.loads
    assert set(drag.values) >= {"column.Cd_t", "column.Cd_z", "pontoon.Cd_t", "pontoon.Cd_z"} | set(drag.law.values)
    assert (name == "constant") == (drag.law.values == {}) and DRAG_LAWS[name] is type(drag.law) and drag.law.source
    new = {label: float(value) * 0.5 for label, value in model.values.items()}
    assert {label: float(value) for label, value in model.with_values(new).values.items()} == new
    assert all(model.about(label).meaning and "{" not in model.about(label).meaning for label in new)
    assert jax.tree.structure(model.with_values(new)) == jax.tree.structure(model)


@pytest.mark.slow
@pytest.mark.parametrize("name", DRAG_LAWS)
def test_gradients_are_finite_at_rest(name: str) -> None:
    """By state, memory and every parameter, on the motionless platform and on one that moves; vmap = loop."""
    model = with_law(build(COLUMN, PONTOON), law_of(name, build(COLUMN, PONTOON)))
    force = lambda y: acting.__wrapped__(model.at_values(y[2]), jnp.zeros(6), *y[:2], jh.StillWater())  # noqa: E731
    slopes = one_program(jax.jacrev(force))
    for velocity, memory in ((jnp.zeros(6), model.rest().memory), (VELOCITY, lively(model))):
        actual = slopes((velocity, memory, model.values))
        assert all(np.isfinite(leaf).all() for leaf in jax.tree.leaves(actual))
    memories = [lively(model, seed) for seed in range(3)]
    loop = [acting(model, POSITION, VELOCITY, memory, SEA) for memory in memories]
    stacked = jax.tree.map(lambda *leaves: np.stack(leaves), *memories)
    action = lambda memory, velocity: acting.__wrapped__(model, POSITION, velocity, memory, SEA)  # noqa: E731
    batch = eqx.filter_jit(jax.vmap(action))(stacked, np.stack(3 * [VELOCITY]))
    for whole, *parts in zip(*map(jax.tree.leaves, (batch, *loop)), strict=True):
        whole, *parts = map(np.asarray, (whole, *parts))
        assert whole.dtype == np.float64 and np.isfinite(whole).all()
        scale = np.abs(whole).max() + 1e-300
        assert_allclose(whole / scale, np.stack(parts) / scale, atol=1e-13)


def test_without_a_cutoff_there_is_no_filter() -> None:
    """fc = 0 is the other neutral value of the high-pass: what is remembered stays nothing."""
    changed = only(with_laws({**HIGH_PASS, "cutoff": 0.0}, {**HIGH_PASS, "cutoff": 0.0}), MorisonDrag)
    plain = only(build(COLUMN, PONTOON), MorisonDrag)
    actual, rate = acting(changed, POSITION, VELOCITY, changed.rest().memory, SEA)
    expected = acting(plain, POSITION, VELOCITY, plain.rest().memory, SEA)[0]
    assert_allclose(actual, expected, rtol=1e-13)
    assert all(bool((leaf == 0).all()) for leaf in jax.tree.leaves(rate))


def test_unchosen_laws_leave_no_trace() -> None:
    """Without the keys, and with the constant law: the same loads, and no memory in the state."""
    constant = with_laws({"law": "constant"}, {"law": "constant"})
    plain = build(COLUMN, PONTOON)
    assert [type(load) for load in constant.loads] == [type(load) for load in plain.loads]
    assert jax.tree.leaves(plain.rest().memory) == [] and sorted(constant.values) == sorted(plain.values)


# a column that is driven


def driven(model: jh.Model, speed, times: np.ndarray, direction=(1.0, 0.0)) -> tuple[np.ndarray, tuple]:
    """Surge and sway force, and memories, of an upright column that is moved at `speed`(t), by RK4 at even `times`."""
    way = jnp.array([*direction, 0.0, 0.0, 0.0, 0.0])
    step = float(times[1] - times[0])

    def at(memory, t):
        return acting.__wrapped__(model, jnp.zeros(6), speed(t) * way, memory, jh.StillWater())

    def advance(memory, t):
        total, first = at(memory, t)
        middle = at(_moved(memory, first, step / 2), t + step / 2)[1]
        middle_again = at(_moved(memory, middle, step / 2), t + step / 2)[1]
        last = at(_moved(memory, middle_again, step), t + step)[1]
        mean = jax.tree.map(lambda a, b, c, d: (a + 2 * b + 2 * c + d) / 6, first, middle, middle_again, last)
        return _moved(memory, mean, step), (total[:2], memory)

    _, (forces, memories) = jax.jit(lambda m: jax.lax.scan(advance, m, jnp.asarray(times)))(model.rest().memory)
    return np.asarray(forces), memories


def _moved(memory, rate, step):
    return jax.tree.map(lambda m, r: m + step * r, memory, rate)


def column(**law) -> jh.Model:
    return only(with_laws(law, members=(COLUMN,)), ConstantLaw, HighPassLaw, KeuleganCarpenterLaw)


UNIT = 0.5 * RHO * CD_T * 10 * 20  # N per (m/s)2 across the column


def test_the_filter_is_that_of_hydrodyn() -> None:
    """Morison_UpdateDiscState's recursion as a digital filter by scipy, at a step of 0.01 s, on a motion of three parts; the
    difference is of the first order in HydroDyn's step."""
    cutoff, share = 0.04, 0.3

    def speed(t, xp=jnp):
        return 1.2 * xp.sin(2 * math.pi * 0.012 * t) + 0.8 * xp.sin(2 * math.pi * 0.1 * t + 1.0) + 0.3 * xp.sin(0.9 * t)

    times = np.arange(0.0, 200.0, 0.1)
    actual = driven(column(law="high_pass", cutoff=cutoff, low_share=share), speed, times)[0][:, 0]
    errors = []
    for substeps in (10, 20):
        fine = np.arange(0, len(times) * substeps) * 0.1 / substeps
        alpha = math.exp(-2 * math.pi * cutoff * 0.1 / substeps)
        u = -speed(fine, np)
        high = lfilter([alpha, -alpha], [1.0, -alpha], u, zi=[alpha * 0.0])[0]
        expected = UNIT * ((1 - share) * np.abs(high) * high + share * np.abs(u) * u)
        errors.append(np.abs(actual - expected[::substeps]).max() / np.abs(expected).max())
    assert errors[1] < 0.002
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.05)


@pytest.mark.parametrize("frequency", [0.008, 0.03, 0.1])
def test_gain_phase_and_energy_of_the_filter(frequency: float) -> None:
    """Gain 1/(1 + (fc/f)^2)^0.5, ahead by atan(fc/f), and r + (1 - r) G^3 of the energy of plain drag, 4/3 ... V^3 T/pi."""
    cutoff, share, period = 0.03, 0.25, 1 / frequency
    times = np.linspace(0.0, 12 * period, 12 * 400, endpoint=False)
    omega = 2 * math.pi * frequency
    model = column(law="high_pass", cutoff=cutoff, low_share=share)
    forces, memory = driven(model, lambda t: 0.9 * jnp.cos(omega * t), times)
    v = 0.9 * np.cos(omega * times)
    (low,) = (np.asarray(leaf)[:, 0] for leaf in jax.tree.leaves(memory))
    last = slice(-400, None)
    high = 2 * np.mean((-v - low)[last] * np.exp(-1j * omega * times[last]))  # of a flow against the motion
    gain = 1 / math.sqrt(1 + (cutoff / frequency) ** 2)
    assert abs(high) / 0.9 == pytest.approx(gain, rel=1e-5)
    assert np.angle(-high) == pytest.approx(math.atan(cutoff / frequency), abs=1e-5)
    taken = -np.mean((forces[:, 0] * v)[last]) * period
    plain = UNIT * 4 / (3 * math.pi) * 0.9**3 * period
    assert taken == pytest.approx(plain * (share + (1 - share) * gain**3), rel=1e-4)


def test_slow_motion_in_waves_is_damped_as_theory_says() -> None:
    """A small slow motion on a large fast one: 1/2 rho A Cd (4/pi) V [r + (1 - r) G_w G^2] per slow velocity, G at the slow
    frequency, G_w at the fast one; 4 V/pi is the equivalent linear damping of plain drag."""
    cutoff, share, fast, slow, small, large = 0.03, 0.2, 0.1, 0.01, 0.02, 1.5
    times = np.linspace(0.0, 600.0, 600 * 40, endpoint=False)  # six slow periods, of ten fast ones each

    def speed(t, xp=jnp):
        return small * xp.cos(2 * math.pi * slow * t) + large * xp.cos(2 * math.pi * fast * t + 0.4)

    forces, _ = driven(column(law="high_pass", cutoff=cutoff, low_share=share), speed, times)
    last = times >= 400.0
    damping = -2 * np.mean(forces[last, 0] * np.cos(2 * math.pi * slow * times[last])) / small
    gain, gain_fast = (1 / math.sqrt(1 + (cutoff / f) ** 2) for f in (slow, fast))
    plain = UNIT * 4 / math.pi * large
    expected = plain * (share + (1 - share) * gain_fast * gain**2)
    assert damping == pytest.approx(expected, rel=2e-3)
    assert expected < 0.3 * plain


@pytest.mark.parametrize("law", [HIGH_PASS, KEULEGAN_CARPENTER], ids=lambda law: law["law"])
def test_a_circle_has_no_direction(law: dict) -> None:
    """Moved along a line at 37 degrees, a column feels what it feels along x, turned."""
    times, way = np.arange(0.0, 60.0, 0.25), np.array([math.cos(0.65), math.sin(0.65)])
    along, _ = driven(column(**law), lambda t: jnp.sin(0.3 * t), times)
    turned, _ = driven(column(**law), lambda t: jnp.sin(0.3 * t), times, tuple(way))
    assert_allclose(turned, along[:, :1] * way, atol=1e-11 * np.abs(along).max())


@pytest.mark.parametrize("period", [9.0, 60.0])
def test_keulegan_carpenter_number_of_a_harmonic_flow(period: float) -> None:
    """K = (U T/D)/(1 + (T/(2 pi W))^2)^0.5 in the mean of squares, its swing, and the force that goes with it."""
    window, speed, reference, exponent = 60.0, 1.4, 4.0, -1 / 3
    omega = 2 * math.pi / period
    count = 200 * round(900 / period)
    times = np.linspace(0.0, 900 // period * period, count, endpoint=False)
    law = {"law": "keulegan_carpenter", "exponent": exponent, "reference": reference, "window": window}
    forces, (*_, memory) = driven(column(**law), lambda t: speed * jnp.cos(omega * t), times)
    per = round(count / (900 // period))
    variance, last = np.asarray(memory.variance)[:, 0], slice(-per, None)
    number = 8 * math.pi**2 * variance / 100.0
    expected = (speed * period / 10) ** 2 / (1 + (period / (2 * math.pi * window)) ** 2)
    assert number[last].mean() == pytest.approx(expected, rel=1e-4)
    swing = 2 * np.abs(np.mean(number[last] * np.exp(-2j * omega * times[last])))
    assert swing / expected == pytest.approx(1 / math.sqrt(1 + (2 * omega * window) ** 2), rel=1e-3)
    coefficient = ((number + 0.01) / (reference**2 + 0.01)) ** (exponent / 2)
    v = speed * np.cos(omega * times)
    assert_allclose(forces[last, 0], -(UNIT * coefficient * np.abs(v) * v)[last], rtol=1e-9, atol=1e-3)


def test_the_amplitude_is_known_half_a_cycle_after_a_release() -> None:
    """A window that begins at the start and grows knows a decay's amplitude before it has seen a whole cycle of it."""
    period, far = 100.0, 8.0
    omega, times = 2 * math.pi / period, np.arange(0.0, 200.0, 0.25)
    _, (*_, memory) = driven(column(**KEULEGAN_CARPENTER), lambda t: -far * omega * jnp.sin(omega * t), times)
    amplitude = np.sqrt(2 * np.asarray(memory.variance)[:, 0])
    assert 0.8 * far < amplitude[times == 50.0][0] < 1.2 * far
    assert (np.abs(amplitude[times > 50.0] / far - 1) < 0.25).all()


# ends: heave decays against an equation of motion of our own


BUOY = {
    "rigid_body": BODY | {"centre_of_mass": [0, 0, -14]},
    "hydrostatics": {"displaced_volume": BODY["mass"] / RHO},
}


@pytest.mark.slow
@pytest.mark.parametrize(
    "law",
    [
        {"law": "constant"},
        {"law": "suction_side"},
        {"law": "high_pass", "cutoff": 0.05, "low_share": 0.3, "suction": 0.6},
        {"law": "keulegan_carpenter", "exponent": -0.5, "reference": 2.0, "window": 15.0},
    ],
    ids=lambda law: law["law"],
)
def test_heave_decay_of_a_buoy(law: dict) -> None:
    """(m + rho Ca 2/3 pi r^3) z'' = -rho g A z + 1/2 rho Cd A (...), the law written out here and solved by scipy."""
    model = with_laws(z=law, members=(COLUMN,), **BUOY)
    times = np.arange(0.0, 120.0, 0.5)
    heave = jh.free_decay(model, {"heave": 4.0}, times, step=0.25)["heave"]
    area = math.pi * 25
    mass, drag = BODY["mass"] + RHO * COEFFICIENTS["Ca_z"] * 2 / 3 * math.pi * 125, 0.5 * RHO * CD_Z * area
    suction, kind = law.get("suction", 1.0 if law["law"] == "suction_side" else 0.0), law["law"]

    def one_sided(w):
        return abs(w) * w - suction * w * w  # the end looks down: water that leaves it moves down

    def slope(t, y):
        z, v, low, swept, variance = y
        w, rates = -v, [0.0, 0.0, 0.0]
        push = one_sided(w)
        if kind == "high_pass":
            push = law["low_share"] * push + (1 - law["low_share"]) * one_sided(w - low)
            rates[0] = 2 * math.pi * law["cutoff"] * (w - low)
        if kind == "keulegan_carpenter":
            age = law["window"] * (1 - 29 / 30 * math.exp(-t / law["window"]))
            rates[1:] = w - swept / age, (swept**2 - variance) / age
            number = 2 * math.pi * math.sqrt(2 * max(variance, 0.0)) / 10.0
            push *= ((number**2 + 0.01) / (law["reference"] ** 2 + 0.01)) ** (law["exponent"] / 2)
        return [v, (-RHO * G * area * z + drag * push) / mass, *rates]

    expected = solve_ivp(slope, (0, 120), [4.0, 0, 0, 0, 0], t_eval=times, rtol=1e-10, atol=1e-12, method="DOP853").y[0]
    assert_allclose(heave, expected, atol=2e-4)


def test_suction_acts_where_the_flow_leaves() -> None:
    """AxFDMod = 1: a column that rises has twice the drag on its bottom, one that sinks has none; half-way at a half."""
    plain = only(build(COLUMN), ConstantLaw)
    for suction in (1.0, 0.5):
        model = only(with_laws(z={"law": "suction_side", "suction": suction}, members=(COLUMN,)), SuctionSideLaw)
        for heave, factor in ((0.9, 1 + suction), (-0.9, 1 - suction)):
            velocity = [0, 0, heave, 0, 0, 0]
            expected = factor * force(plain, velocity)
            assert_allclose(force(model, velocity), expected, rtol=1e-11, atol=1e-6)


# powers of the speed, and slow motion of the platform


def with_law(model: jh.Model, law: AbstractDragLaw) -> jh.Model:
    """Drag by another law, and nothing else."""
    (drag,) = only(model, MorisonDrag).loads
    return model_of(model, dataclasses.replace(drag, law=law))


def keys_of(model: jh.Model) -> list[tuple[str, str]]:
    return [key for load in only(model, MorisonDrag).loads for key in load.Cd]


def test_another_power_of_the_speed() -> None:
    """1/2 rho Cd D T |u|^(2+n) / U0^n on a column, and on its end; the coefficient is Cd at U0 = 0.5 m/s."""
    plain = only(build(COLUMN), MorisonDrag)
    model = with_law(plain, SpeedPowerLaw({"column": -1 / 3}))
    factor = ((0.8**2 + 4e-4) / (0.25 + 4e-4)) ** (-1 / 6)
    assert_allclose(force(model, [0.48, -0.64, 0, 0, 0, 0]), factor * force(plain, [0.48, -0.64, 0, 0, 0, 0]), atol=1e-4)
    assert_allclose(force(model, [0, 0, 0.8, 0, 0, 0]), factor * force(plain, [0, 0, 0.8, 0, 0, 0]), rtol=1e-9, atol=1e-4)
    assert_allclose(force(model, [0.5, 0, 0, 0, 0, 0]), force(plain, [0.5, 0, 0, 0, 0, 0]), rtol=1e-12, atol=1e-4)


SLOW = np.array([-0.4, 0.9, -0.2, 0.01, 0.015, -0.02])


@pytest.mark.parametrize("share", [0.0, 0.3, 2.0])
@pytest.mark.parametrize("powers", [{}, {"column": -0.4, "pontoon": 0.2}])
def test_slow_motion_has_a_coefficient_of_its_own(share: float, powers: dict[str, float]) -> None:
    """r = 0 is drag at the velocity less the slow one, in any motion of strips and ends; r between is the mixture; the
    memory is a first-order low-pass. So it is with a power of the speed for the square."""
    law = SpeedPowerLaw(powers)
    plain = with_law(build(COLUMN, PONTOON), law)
    whole, fast = force(plain, VELOCITY, POSITION), force(plain, VELOCITY - SLOW, POSITION)
    model = with_law(plain, SlowMotionLaw(low_share=share, cutoff=0.05, law=law))
    memory = jax.tree.map(lambda leaf: jnp.asarray(SLOW), model.rest().memory)
    actual, rate = acting(model, POSITION, VELOCITY, memory, jh.StillWater())
    expected = share * whole + (1 - share) * fast
    assert_allclose(actual, expected, rtol=1e-10, atol=1e-10 * np.abs(whole).max())
    assert_allclose(jax.tree.leaves(rate)[0], 2 * math.pi * 0.05 * (VELOCITY - SLOW), rtol=1e-13)


def test_slow_motion_in_a_current() -> None:
    """A platform that drifts slowly in it feels r of the whole, and of the current the rest: that is no slow motion."""
    model = with_law(build(COLUMN), SlowMotionLaw(low_share=0.3)).with_effect(Current(x=1.0))
    slow = jnp.array([0.4, 0, 0, 0, 0, 0])
    memory = jax.tree.map(lambda leaf: slow, model.rest().memory)
    actual, _ = acting(model, jnp.zeros(6), slow, memory, jh.StillWater())
    assert float(actual[0]) == pytest.approx(UNIT * (0.3 * 0.6**2 + 0.7 * 1.0**2), rel=1e-9)


# simulations, their gradients, and what is worked out at rest


def small(t: dict | None, z: dict | None) -> jh.Model:
    """A moored hull of few strips."""
    members = ({**COLUMN, "elements": 1}, {**PONTOON, "rA": [-20, 0, -16.5], "rB": [20, 0, -16.5], "elements": 1})
    springs = {"kind": "stiffness_matrix", "stiffness": {"C11": 8e4, "C22": 8e4, "C33": 4e5, "C66": 2e9}}
    return with_laws(t, z, members=members, mooring=springs, **BUOY)


@pytest.fixture(scope="module")
def sea() -> jh.IrregularSea:
    environment = jh.Environment(RHO, 200.0, G)
    waves = jh.spectrum_components(lambda w: jh.jonswap(w, 4.0, 9.0), 120.0, environment, low=0.04, cutoff=0.25, seed=2)
    return jh.IrregularSea(waves, environment)


@pytest.mark.slow
def test_in_an_irregular_sea(sea) -> None:
    """Adams-Bashforth and Tsit5, whose loop RK4 shares, agree with both memories in the state; the laws matter."""
    model, times = small(KEULEGAN_CARPENTER, HIGH_PASS), np.arange(0.0, 60.0, 0.5)
    tsit5, ab4 = (np.asarray(jh.simulate(model, times, sea, method=method, step=0.1).position) for method in ("tsit5", "ab4"))
    scale = np.abs(tsit5).max(axis=0) + 1e-3
    assert np.abs((ab4 - tsit5) / scale).max() < 1e-3
    plain = np.asarray(jh.simulate(small(None, None), times, sea, method="ab4", step=0.1).position)
    assert np.abs((plain - ab4) / scale).max() > 0.01


@pytest.mark.slow
@pytest.mark.parametrize("method", ["tsit5", pytest.param("ab4", marks=pytest.mark.validate)])
def test_gradients_through_a_memory(method: str) -> None:
    """Forward = reverse = differences, for coefficient, share, cut-off and exponent."""
    model, times = small(KEULEGAN_CARPENTER, HIGH_PASS), jnp.arange(0.0, 24.0, 0.5)
    labels = ("column.Cd_t", "column.drag_exponent_t", "pontoon.Cd_z", "pontoon.drag_low_share_z", "pontoon.drag_cutoff_z")
    start = jh.State(jnp.array([4.0, 0, 1.0, 0, 0.05, 0]), jnp.zeros(6), model.rest().memory)
    weights = jnp.asarray(np.random.default_rng(0).standard_normal((48, 6))) / 48

    def scalar(x, adjoint):
        changed = model.with_values(dict(zip(labels, x)))
        grid = integrate.integrate(changed, jh.StillWater(), start, times[0], jnp.asarray(0.25), 96, method, adjoint)
        return (grid.at(times)[0] * weights).sum()

    x = jnp.array([float(model.values[label]) for label in labels])
    assert sum(leaf.size for leaf in jax.tree.leaves(start)) > 12
    reverse = jax.jit(jax.grad(lambda x: scalar(x, "reverse")))(x)
    forward = jax.jit(jax.jacfwd(lambda x: scalar(x, "forward")))(x)
    assert_allclose(forward, reverse, rtol=1e-7, atol=1e-12)
    assert bool((jnp.abs(reverse) > 1e-7).all())
    if method == "ab4":
        return
    run = jax.jit(lambda x: scalar(x, "forward"))
    for i in range(len(labels)):
        h = 1e-4 * jnp.zeros(len(labels)).at[i].set(x[i])
        assert float(run(x + h) - run(x - h)) / float(2 * h[i]) == pytest.approx(float(reverse[i]), rel=1e-4, abs=1e-9)


@pytest.mark.slow
def test_what_is_worked_out_at_rest() -> None:
    """Equilibrium and natural modes are those of plain drag, whose laws do nothing to first order; a model's damping is that
    of fast motion where slow one is high-passed, and of K = 0 where it follows K."""
    plain, changed = small(None, None), small(HIGH_PASS, HIGH_PASS)
    equilibrium = jh.equilibrium(changed)
    assert_allclose(equilibrium, jh.equilibrium(plain), atol=1e-12)
    assert_allclose(jh.natural_modes(changed, equilibrium).period, jh.natural_modes(plain, equilibrium).period, rtol=1e-12)
    constant, filtered = (model_damping(model, "heave", equilibrium) for model in (plain, changed))
    assert filtered.quadratic == pytest.approx(constant.quadratic, rel=1e-9)
    powers = model_damping(small(KEULEGAN_CARPENTER, KEULEGAN_CARPENTER), "heave", equilibrium)
    most = ((0.1**2) / (5.0**2 + 0.1**2)) ** (-1 / 6)
    assert powers.quadratic == pytest.approx(most * constant.quadratic, rel=1e-9)


# the platform file


def test_parameters_have_labels_and_can_be_freed() -> None:
    """By group and direction, within bounds, each with a finite slope; a neutral value is not freed by itself where it is 0."""
    model = with_laws({**KEULEGAN_CARPENTER, "exponent": 0.0}, {**HIGH_PASS, "suction": 0.5}, ends=False)
    new = sorted(label for label in model.values if ".drag_" in label)
    assert new == [
        "column.drag_cutoff_z",
        "column.drag_exponent_t",
        "column.drag_low_share_z",
        "column.drag_suction_z",
        "pontoon.drag_exponent_t",
    ]
    assert not [label for label in default_free(model, ("surge",)) if "exponent" in label]
    space = parameter_space(model, new)
    values = space.values(space.start)
    for label in new:
        assert float(values[label]) == pytest.approx(float(model.values[label]), abs=1e-2)
        assert model.about(label).meaning and "{" not in model.about(label).meaning
    assert model.about("column.drag_cutoff_z").unit == "Hz"


def test_each_coefficient_is_in_one_load_of_the_strips_or_ends() -> None:
    """A pontoon with a law in one direction only: the other keeps plain drag, and |u| is still that of both."""
    model = only(with_laws(None, {**HIGH_PASS, "low_share": 1.0}), MorisonDrag)
    labels = [label for load in model.loads for label in load.values if ".Cd_" in label]
    assert sorted(labels) == ["column.Cd_t", "column.Cd_z", "pontoon.Cd_t", "pontoon.Cd_z"]
    assert_allclose(force(model, VELOCITY), force(only(build(COLUMN, PONTOON), MorisonDrag), VELOCITY), rtol=1e-14)


def test_laws_of_a_model_given_to_another() -> None:
    """Plain drag given the laws that a platform file declares is the same model; what has a law is given no other."""
    declared = with_laws(KEULEGAN_CARPENTER, {**HIGH_PASS, "suction": 0.5})
    laws = drag_laws_of(declared)
    assert {label: law.law for label, law in laws.items()} == {
        "column.Cd_t": "keulegan_carpenter",
        "pontoon.Cd_t": "keulegan_carpenter",
        "column.Cd_z": "high_pass",
        "pontoon.Cd_z": "high_pass",
    }
    assert laws["column.Cd_t"].model_dump() == {**KEULEGAN_CARPENTER, "window": 60.0} | KEULEGAN_CARPENTER
    given = with_drag_laws(build(COLUMN, PONTOON), laws)
    assert given.values.keys() == declared.values.keys()
    memory = lively(declared)
    actual, expected = (acting(model, POSITION, VELOCITY, memory, SEA) for model in (given, declared))
    jax.tree.map(lambda a, b: assert_allclose(a, b, rtol=1e-12), actual, expected)
    assert drag_laws_of(build(COLUMN, PONTOON)) == {} and plain_drag(declared) == []
    with pytest.raises(ValueError, match="expected a coefficient of plain Morison drag"):
        with_drag_laws(declared, laws)


def test_number_of_the_surface() -> None:
    """pi H/D with the column's diameter; of a pontoon's vertical motion D is its width."""
    hull = build(COLUMN, PONTOON).hull
    assert surface_number(hull, "column.Cd_t", 6.0) == pytest.approx(math.pi * 6.0 / COLUMN["d"])
    assert surface_number(hull, "column.Cd_z", 6.0) == pytest.approx(math.pi * 6.0 / COLUMN["d"])
    assert surface_number(hull, "pontoon.Cd_z", 6.0) == pytest.approx(math.pi * 6.0 / PONTOON["d"][0])


def told(row: dict, members=(COLUMN,)) -> str:
    data = {
        "name": "test",
        "water": {"density": RHO, "depth": 200.0},
        "rigid_body": BODY,
        "members": members,
        "coefficients": {member["name"]: COEFFICIENTS | row for member in members},
    }
    with pytest.raises(InputError) as caught:
        jh.build(validate(Platform, data, "platform.yaml"))
    return str(caught.value)


@pytest.mark.parametrize(
    "row, expected",
    [
        ({"drag_t": {"law": "high_pas"}}, "column.drag_t.law: expected one of constant, high_pass, keulegan_carpenter"),
        ({"drag_t": {"law": "high_pas"}}, "Did you mean 'high_pass'?"),
        ({"drag_t": {"law": "suction_side"}}, "found 'suction_side'"),
        ({"drag_t": {"law": "high_pass", "cutoff": 0.02}}, "coefficients.column.drag_t.low_share: expected a number"),
        ({"drag_t": HIGH_PASS | {"cutoff": 0.5}}, "expected a number >= 0 and <= 0.15, found 0.5"),
        ({"drag_t": HIGH_PASS | {"suction": 0.5}}, "coefficients.column.drag_t"),
        ({"drag_z": HIGH_PASS | {"low_shar": 0.5}}, "Did you mean 'low_share'?"),
        ({"drag_z": KEULEGAN_CARPENTER | {"reference": 0.0}}, "reference: expected a number > 0, found 0.0"),
        ({"drag_z": "high_pass"}, "expected a mapping with `law`: constant, high_pass, keulegan_carpenter or suction_side"),
        ({"drag": HIGH_PASS}, "expected a known key"),
    ],
)
def test_messages(row: dict, expected: str) -> None:
    assert expected in told(row)


def test_a_suction_side_needs_a_column() -> None:
    assert "coefficients.pontoon.drag_z: expected" in told({"drag_z": {"law": "suction_side"}}, (PONTOON,))
