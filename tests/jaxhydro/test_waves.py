"""Linear waves against the equations that they solve, and their forces against integrals done elsewhere."""

import dataclasses
import math

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import elevation, one_program
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import jvp, yvp

import jaxhydro as jh
from jaxhydro.loads import EndInertia, StripInertia
from jaxhydro.waves import PlaneWaves, WaveSea, components, wavenumber

WATER = jh.Environment(1025.0, 200.0, 9.81)
SHALLOW = jh.Environment(1025.0, 12.0, 9.81)


def wave(environment=WATER, period=10.0, height=4.0, **options) -> WaveSea:
    return jh.regular_wave(height, period, environment, **options)


@jax.jit
def at_point(sea: WaveSea, time, point):
    kinematics = sea.flow(time, point[:, None])
    return kinematics.velocity[:, 0], kinematics.acceleration[:, 0], kinematics.pressure[0]


def flow(sea: WaveSea, time, point) -> tuple[np.ndarray, ...]:
    """Velocity, acceleration and pressure at one point."""
    return tuple(map(np.asarray, at_point(sea, time, point)))


POINTS = [np.array(point) for point in ([3.0, -2.0, -1.0], [-40.0, 25.0, -11.0], [7.0, 9.0, -0.3])]


# dispersion

number = one_program(wavenumber)
FORWARD, REVERSE = one_program(jax.jacfwd(wavenumber, (0, 1, 2))), one_program(jax.grad(wavenumber, (0, 1, 2)))


@pytest.mark.parametrize("depth", [0.5, 12.0, 200.0, 4000.0])
def test_dispersion_against_root_finding(depth: float) -> None:
    """omega^2 = g k tanh kh by scipy's brentq, from swell of an hour to capillary-sized ripples."""
    omega = np.geomspace(2 * np.pi / 3600, 30.0, 60)
    wavenumbers = number(omega, depth, 9.81)
    for w, k in zip(omega, np.asarray(wavenumbers), strict=True):
        lower, upper = w**2 / 9.81, max(w**2 / 9.81, w / math.sqrt(9.81 * depth)) * 1.5
        exact = brentq(lambda k, w=w: 9.81 * k * math.tanh(k * depth) - w**2, 0.99 * lower, upper, xtol=1e-300, rtol=1e-15)
        assert k == pytest.approx(exact, rel=1e-13)


def test_deep_and_shallow_limits() -> None:
    """k = omega^2/g where kh is large, omega/sqrt(gh) where it is small: the limits of tanh."""
    assert float(number(2.0, 500.0, 9.81)) == pytest.approx(4 / 9.81, rel=1e-14)
    slow = float(number(1e-3, 10.0, 9.81))
    assert slow == pytest.approx(1e-3 / math.sqrt(98.1), rel=1e-6)


@pytest.mark.parametrize("omega", [0.05, 0.4, 1.2, 6.0])
def test_derivatives_of_the_wavenumber(omega: float) -> None:
    """All three derivatives against central differences, forward and reverse."""
    at = (omega, 30.0, 9.81)
    forward, reverse = (np.asarray(slopes(*at)) for slopes in (FORWARD, REVERSE))
    assert_allclose(forward, reverse, rtol=1e-14)
    for i in range(3):
        step = 1e-5 * at[i]
        high, low = (float(number(*(x + sign * step * (i == j) for j, x in enumerate(at)))) for sign in (1, -1))
        assert forward[i] == pytest.approx((high - low) / (2 * step), rel=1e-6, abs=1e-10)


def test_no_wave_at_zero_frequency() -> None:
    """omega = 0 gives k = 0 with the slope 1/sqrt(gh) of long waves: nothing is undefined."""
    at = (0.0, 30.0, 9.81)
    assert float(number(*at)) == 0.0
    assert_allclose(REVERSE(*at), [1 / math.sqrt(30 * 9.81), 0.0, 0.0], rtol=1e-14)


# kinematics


@pytest.mark.parametrize("sea", [wave(heading=0.7, phase=0.4), wave(SHALLOW, 9.0, 1.0, heading=-2.0)], ids=["deep", "shallow"])
@pytest.mark.parametrize("point", POINTS)
def test_the_flow_is_a_potential_flow(sea: WaveSea, point: np.ndarray) -> None:
    """Continuity and irrotationality, the Jacobian by central differences."""
    step = 1e-4
    slope = np.stack(
        [(flow(sea, 3.0, point + step * e)[0] - flow(sea, 3.0, point - step * e)[0]) / (2 * step) for e in np.eye(3)],
        axis=1,
    )
    size = np.abs(slope).max()
    assert abs(np.trace(slope)) < 1e-8 * size
    assert_allclose(slope, slope.T, atol=1e-8 * size)


@pytest.mark.parametrize("sea", [wave(heading=0.7, phase=0.4), wave(SHALLOW, 9.0, 1.0, heading=-2.0)], ids=["deep", "shallow"])
def test_boundary_conditions_and_bernoulli(sea: WaveSea) -> None:
    """w = eta_t and p/rho = g eta on the surface, w = 0 on the bottom, acceleration = -grad p/rho = u_t: Airy."""
    step, point = 1e-4, np.array([3.0, -2.0, 0.0])
    up, down = (float(elevation(sea, 5.0 + s, point[:2, None])[0]) for s in (step, -step))
    velocity, acceleration, pressure = flow(sea, 5.0, point)
    assert float(velocity[2]) == pytest.approx((up - down) / (2 * step), rel=1e-7)
    assert float(pressure) == pytest.approx(9.81 * float(elevation(sea, 5.0, point[:2, None])[0]), rel=1e-12)
    bottom = flow(sea, 5.0, np.array([3.0, -2.0, -float(sea.environment.depth)]))[0]
    assert abs(float(bottom[2])) < 1e-14
    for point in POINTS:
        _, acceleration, _ = flow(sea, 5.0, point)
        size = np.abs(acceleration).max()
        later, earlier = flow(sea, 5.0 + step, point)[0], flow(sea, 5.0 - step, point)[0]
        assert_allclose(acceleration, (later - earlier) / (2 * step), atol=1e-7 * size)
        push = [(flow(sea, 5.0, point - step * e)[2] - flow(sea, 5.0, point + step * e)[2]) / (2 * step) for e in np.eye(3)]
        assert_allclose(acceleration, push, atol=1e-7 * size)


def test_kinematics_in_plain_numbers() -> None:
    """u = a omega cosh k(z+h)/sinh kh at a crest, down-wave and along the heading; worked out with math.cosh."""
    sea = wave(SHALLOW, 9.0, 1.0, heading=math.radians(30))
    omega, k = 2 * math.pi / 9, float(np.linalg.norm(sea.waves.vector))
    velocity, _, pressure = flow(sea, 0.0, np.array([0.0, 0.0, -4.0]))
    speed = 0.5 * omega * math.cosh(k * 8) / math.sinh(k * 12)
    assert_allclose(velocity, [speed * math.cos(math.pi / 6), speed / 2, 0.0], rtol=1e-12, atol=1e-15)
    assert float(pressure) == pytest.approx(0.5 * 9.81 * math.cosh(k * 8) / math.cosh(k * 12), rel=1e-12)


def test_above_still_water_the_flow_is_that_of_the_surface() -> None:
    """The docstring's rule; below the bottom nothing blows up either."""
    sea = wave()
    for a, b in ((0.0, 3.0), (-200.0, -230.0)):
        for upper, lower in zip(flow(sea, 1.0, np.array([2.0, 0, a])), flow(sea, 1.0, np.array([2.0, 0, b])), strict=True):
            assert_allclose(upper, lower, rtol=1e-14)


def test_nothing_overflows_in_deep_water() -> None:
    """k h = 700, near the end of double precision's exponent: deep-water values, finite, with finite gradients."""
    k = 3.5
    omega = math.sqrt(9.81 * k)
    sea = WaveSea(PlaneWaves.free(components([0.01], [omega], WATER), WATER), WATER)
    velocity, acceleration, pressure = flow(sea, 0.0, np.array([0.0, 0.0, -0.5]))
    assert_allclose(velocity, [0.01 * omega * math.exp(-0.5 * k), 0, 0], rtol=1e-12, atol=1e-15)
    assert float(pressure) == pytest.approx(0.0981 * math.exp(-0.5 * k), rel=1e-12)
    assert np.isfinite(acceleration).all()
    slope = one_program(jax.jacfwd(lambda p: at_point(sea, 0.0, p)[0]))(np.array([0.0, 0.0, -150.0]))
    assert np.isfinite(slope).all()


def test_waves_grow_from_rest() -> None:
    """Half a cosine: 0, a half, 1 at the start, the middle and the end; at full height at once without a ramp."""
    sea, full = wave(ramp=40.0), wave()
    share = sea.growth(np.array([-1.0, 0.0, 10.0, 20.0, 40.0, 99.0]))
    assert_allclose(share, [0, 0, 0.5 - math.sqrt(0.125), 0.5, 1, 1], atol=1e-15)
    assert float(full.growth(jnp.asarray(0.0))) == 1.0
    point = np.array([1.0, 2.0, -3.0])
    for ramped, whole in zip(flow(sea, 20.0, point), flow(full, 20.0, point), strict=True):
        assert_allclose(ramped, 0.5 * whole, rtol=1e-13)
    assert np.isfinite(one_program(jax.grad(lambda t: full.growth(t)))(0.0))


def test_components_add_up() -> None:
    """Linear waves superpose: two components together are the sum of each alone."""
    first, second = wave(phase=0.3), wave(period=7.0, height=2.0, heading=1.0)
    superposed = WaveSea(first.waves + second.waves, WATER)
    for a, b, total in zip(*(flow(sea, 2.0, POINTS[1]) for sea in (first, second, superposed)), strict=True):
        assert_allclose(a + b, total, rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize("height, period", [(1.0, 0.0), (-1.0, 10.0), (23.0, 10.0), (float("nan"), 10.0), (1.0, float("nan"))])
def test_waves_that_cannot_be(height: float, period: float) -> None:
    """Miche's limit in deep water is 0.142 g T^2/(2 pi) = 22.17 m at 10 s; periods and heights have a range."""
    with pytest.raises(ValueError):
        wave(height=height, period=period)


def test_breaking_height_in_deep_water() -> None:
    """0.142 g T^2/(2 pi), and the message says it."""
    limit = 0.142 * 9.81 * 100 / (2 * math.pi)
    wave(height=0.999 * limit)
    with pytest.raises(ValueError, match=r"breaks above a height of 22\.2 m"):
        wave(height=1.001 * limit)


# forces


def platform(x: float = 0.0, **changes) -> jh.Platform:
    data = {
        "name": "a column",
        "water": {"density": 1025.0, "depth": 200.0, "gravity": 9.81},
        "rigid_body": {"mass": 1e6, "centre_of_mass": [0, 0, -5], "inertia": {"Ixx": 1e8, "Iyy": 1e8, "Izz": 1e8}},
        "members": [{"name": "c", "shape": "circ", "d": 10.0, "rA": [x, 0, -20], "rB": [x, 0, 15]}],
        "coefficients": {"c": {"Ca_t": 0.9, "Ca_z": 0.5, "Cd_t": 1.0, "Cd_z": 2.0}},
        "wetting": "mean",
    }
    return jh.Platform.model_validate(data | changes)


def only(model: jh.Model, *kinds: type) -> jh.Model:
    """The model with some of its loads."""
    loads = tuple(load for load in model.loads if isinstance(load, kinds))
    return dataclasses.replace(model, loads=loads)


@one_program
def held(model: jh.Model, position, sea: jh.AbstractSea | None) -> jax.Array:
    return model.force_at_rest(position, sea)


def force_at_rest(model: jh.Model, sea: jh.AbstractSea | None = None, pitch: float = 0.0) -> np.ndarray:
    """Force on the platform held at its reference position, or leaning about it, at t = 0."""
    return np.asarray(held(model, np.array([0.0, 0.0, 0.0, 0.0, pitch, 0.0]), sea))


@pytest.mark.parametrize("x, phase", [(0.0, 0.0), (0.0, math.pi / 2), (35.0, 0.8)])
def test_inertia_force_on_a_fixed_column(x: float, phase: float) -> None:
    """-rho A (1 + Ca) a omega^2 sin(...) times the integral of cosh k(z+h)/sinh kh, closed; its moment by quad.

    The force leads the elevation by a quarter of a period: zero under a crest.
    """
    model, sea = only(jh.build(platform(x, diffraction="none")), StripInertia), wave(phase=phase)
    k, omega = float(np.linalg.norm(sea.waves.vector)), 2 * math.pi / 10
    scale = -1025 * math.pi / 4 * 100 * 1.9 * 2.0 * omega**2 * math.sin(phase - k * x)
    force = force_at_rest(model, sea)
    depth_integral = (math.sinh(k * 200) - math.sinh(k * 180)) / (k * math.sinh(k * 200))
    moment = quad(lambda z: z * math.cosh(k * (z + 200)) / math.sinh(k * 200), -20, 0)[0]
    assert_allclose(force[0], scale * depth_integral, rtol=1e-9, atol=1e-3)
    assert_allclose(force[4], scale * moment, rtol=1e-9, atol=1e-2)
    assert_allclose(np.asarray(force)[[1, 2, 3, 5]], 0.0, atol=1e-6)


def test_diffraction_by_a_fixed_column() -> None:
    """The force of the test above with MacCamy and Fuchs' factor by SciPy's Bessel functions in place of 1 + Ca: less in size,
    and later; "ramp" adds (Ca - 1) exp(-(ka / 0.3)^2), and without its lag it is the modulus."""
    period = 6.0
    omega = 2 * math.pi / period
    forces = {}
    for name in ("maccamy_fuchs", "ramp", "none"):
        model = only(jh.build(platform(diffraction=name)), StripInertia)
        forces[name] = np.array([force_at_rest(model, wave(period=period, phase=p))[0] for p in (0.0, math.pi / 2)])
    sea = wave(period=period)
    k = float(np.linalg.norm(sea.waves.vector))
    ka = 5 * k
    factor = 4 * (yvp(1, ka) - 1j * jvp(1, ka)) / (math.pi * ka**2 * (jvp(1, ka) ** 2 + yvp(1, ka) ** 2))
    integral = (math.sinh(k * 200) - math.sinh(k * 180)) / (k * math.sinh(k * 200))
    size = 1025 * math.pi / 4 * 100 * 2.0 * omega**2 * integral
    for name, coefficient in (("maccamy_fuchs", factor), ("ramp", factor - 0.1 * math.exp(-((ka / 0.3) ** 2))), ("none", 1.9)):
        expected = [(size * coefficient * 1j * np.exp(1j * phase)).real for phase in (0.0, math.pi / 2)]
        assert_allclose(forces[name], expected, rtol=1e-9, err_msg=name)
    modulus = only(jh.build(platform()), StripInertia).with_conventions(lag=False)
    assert_allclose(force_at_rest(modulus, wave(period=period, phase=math.pi / 2))[0], -size * abs(factor), rtol=1e-9)


def test_diffraction_by_a_leaning_column() -> None:
    """MacCamy and Fuchs' factor multiplies the whole acceleration, of which a column takes what is across it.

    By Airy's formulas and quad along a column that leans by 12 degrees.
    """
    angle, omega = math.radians(12.0), 2 * math.pi / 6.0
    model, sea = only(jh.build(platform()), StripInertia), wave(period=6.0)
    k = float(np.linalg.norm(sea.waves.vector))
    ka = 5 * k
    factor = 4 * (yvp(1, ka) - 1j * jvp(1, ka)) / (math.pi * ka**2 * (jvp(1, ka) ** 2 + yvp(1, ka) ** 2))

    def across(z: float) -> complex:
        size = 2.0 * omega**2 * np.exp(-1j * k * z * math.sin(angle)) / math.sinh(k * 200)
        return size * (1j * math.cos(angle) * math.cosh(k * (z + 200)) + math.sin(angle) * math.sinh(k * (z + 200)))

    integral = complex(*(quad(lambda z, part=part: getattr(across(z), part), -20, 0)[0] for part in ("real", "imag")))
    size = (1025 * math.pi / 4 * 100 * factor * integral).real
    acting_force = force_at_rest(model, sea, angle)
    assert_allclose(acting_force[:3], [size * math.cos(angle), 0.0, -size * math.sin(angle)], rtol=1e-7, atol=1e-3)


def test_end_of_a_fixed_column() -> None:
    """Pressure on the bottom's area plus rho Ca 2/3 pi r^3 times the water's acceleration, by Airy's formulas."""
    model, sea = only(jh.build(platform()), EndInertia), wave(phase=0.6)
    k, omega = float(np.linalg.norm(sea.waves.vector)), 2 * math.pi / 10
    pressure = 1025 * 9.81 * 2.0 * math.cosh(k * 180) / math.cosh(k * 200) * math.cos(0.6)
    acceleration = -2.0 * omega**2 * math.sinh(k * 180) / math.sinh(k * 200) * math.cos(0.6)
    expected = pressure * math.pi * 25 + 1025 * 0.5 * 2 / 3 * math.pi * 125 * acceleration
    assert float(force_at_rest(model, sea)[2]) == pytest.approx(expected, rel=1e-12)


def volturnus(**changes) -> jh.Model:
    return jh.build(jh.load_platform("volturnus-s-focal").model_copy(update=changes))


@pytest.mark.parametrize("heading", [0.0, 0.9])
def test_surge_force_on_the_fixed_platform(heading: float) -> None:
    """Sum over columns and pontoons of rho (1 + Ca) A a' in closed form and by quad along the pontoons."""
    model = only(volturnus(wetting="mean", diffraction="none"), StripInertia)
    sea = jh.regular_wave(3.0, 9.0, model.environment, heading=heading, phase=0.4)
    k, omega = float(np.linalg.norm(sea.waves.vector)), 2 * math.pi / 9
    towards = np.array([math.cos(heading), math.sin(heading)])

    def acceleration(x, y, z):
        angle = 0.4 - k * (towards @ [x, y])
        return -1.5 * omega**2 * math.cosh(k * (z + 200)) / math.sinh(k * 200) * math.sin(angle) * towards

    column = (math.sinh(k * 200) - math.sinh(k * 180)) / (k * math.cosh(k * 200))  # over that of the surface
    total = np.zeros(2)
    for diameter, radius, azimuths in ((10.0, 0.0, [0]), (12.5, 51.75, [60, 180, 300])):
        for azimuth in np.radians(azimuths):
            at = radius * math.cos(azimuth), radius * math.sin(azimuth)
            total += 1025 * math.pi / 4 * diameter**2 * 2.5 * acceleration(*at, 0.0) * column
    for azimuth in np.radians([60, 180, 300]):
        c, s = math.cos(azimuth), math.sin(azimuth)
        across = np.array([-s, c])
        along = quad(lambda r, c=c, s=s, across=across: across @ acceleration(r * c, r * s, -16.5), 5.0, 45.5)[0]
        total += 1025 * 12.5 * 7.0 * 1.11 * along * across
    assert_allclose(force_at_rest(model, sea)[:2], total, rtol=1e-8, atol=1e-3)


def test_mirrored_and_turned_waves() -> None:
    """The hull is symmetric about the x axis and under a third of a turn: so are the wave forces on it."""
    model = volturnus()
    still = np.asarray(force_at_rest(model))

    def force(heading):
        sea = jh.regular_wave(3.0, 9.0, model.environment, heading=heading, phase=0.4)
        return np.asarray(force_at_rest(model, sea)) - still

    size = np.abs(force(0.5))
    scale = np.array([size[:3].max()] * 3 + [size[3:].max()] * 3)
    assert_allclose(force(-0.5) / scale, np.array([1, -1, 1, -1, 1, -1]) * force(0.5) / scale, atol=1e-9)
    turn = 2 * math.pi / 3
    c, s = math.cos(turn), math.sin(turn)
    matrix = np.kron(np.eye(2), np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]))
    assert_allclose(force(0.5 + turn) / scale, matrix @ force(0.5) / scale, atol=1e-6)


@pytest.mark.slow
def test_a_very_long_wave_lifts_the_platform_with_it() -> None:
    """Heave over wave amplitude tends to 1/(1 - (T_heave/T)^2), near 1: a cork. T = 200 s, waves of 10 cm."""
    model = volturnus()
    sea = jh.regular_wave(0.1, 200.0, model.environment, ramp=200.0)
    times = np.arange(0.0, 1001.0, 2.0)
    heave = np.asarray(jh.simulate(model, times, sea, step=1.0)["heave"]) - float(jh.equilibrium(model)[2])
    late = times > 600.0
    basis = np.stack([np.cos(2 * np.pi * times / 200), np.sin(2 * np.pi * times / 200)], axis=1)[late]
    (cos, sin), *_ = np.linalg.lstsq(basis, heave[late], rcond=None)
    natural = jh.natural_modes(model).of("heave")
    assert cos / 0.05 == pytest.approx(1 / (1 - (natural / 200) ** 2), rel=0.02)
    assert abs(sin / 0.05) < 0.03
