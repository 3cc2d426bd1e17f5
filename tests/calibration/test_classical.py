"""Classical decay analysis against decays whose damping is known, and against the loads of a model."""

import math
from functools import cache

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

import jaxhydro as jh
from calibration.decay_analysis.decrements import Decrements, decrements
from calibration.decay_analysis.linear_quadratic import Classical, classical, equivalent_damping, linear_quadratic
from calibration.decay_analysis.model_damping import drag_coefficient, model_damping, motion_shape
from calibration.decay_analysis.period_change import unexplained_period_change
from calibration.fitting.fit_conclusion import period_remarks
from calibration.result import Series, TestFit
from jaxhydro.dynamics.response import decay_cycles
from jaxhydro.dynamics.statics import linearised
from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.parameters import parameter

PERIOD = 20.0
OMEGA = 2 * math.pi / PERIOD
TIMES = np.arange(0.0, 300.0, 0.1)


def test_a_period_that_changes_with_the_amplitude_is_noticed():
    """x'' + 0.02 x' + w² sin(x) = 0, a pendulum: its period grows by A²/16, that of a linear model does not."""

    def swing(restoring) -> np.ndarray:
        sizes = {"rtol": 1e-9, "atol": 1e-12, "t_eval": TIMES}
        return solve_ivp(lambda _, y: [y[1], -0.02 * y[1] - OMEGA**2 * restoring(y[0])], (0, 300), [0.3, 0.0], **sizes).y[0]

    pendulum, linear = swing(np.sin), swing(lambda x: x)
    noisy = pendulum + np.random.default_rng(1).normal(0, 2e-4, len(TIMES))
    change = unexplained_period_change(TIMES, noisy, linear, 2e-4)
    assert change is not None
    assert change.large - change.small > 0.02 > abs(change.simulated_large - change.simulated_small)
    assert unexplained_period_change(TIMES, noisy, pendulum, 2e-4) is None
    fit = TestFit("d", "fit", "decay", "roll", TIMES, (Series("roll", noisy, linear, 0.0, 2e-4, True),), {}, "d.csv")
    remarks = period_remarks([fit])
    assert len(remarks) == 1 and remarks[0].startswith("d: the period of roll goes from") and "jaxhydro diagnose" in remarks[0]


def linear_decay(zeta: float, times: np.ndarray = TIMES) -> np.ndarray:
    """exp(-zeta w t) sin(w_d t), its damped period PERIOD: p = 2 zeta w = 2 zeta OMEGA/(1 - zeta^2)^0.5.

    Half cycles are whole, and sampled alike, so that the parabola through a tip is as wrong at every tip.
    """
    times = times + 0.05
    return 5 * np.exp(-zeta * OMEGA / math.sqrt(1 - zeta**2) * times) * np.sin(OMEGA * times)


@cache
def decay(p: float, q: float) -> np.ndarray:
    """x'' + p x' + q x'|x'| + OMEGA^2 x = 0 from 5 at rest, at TIMES."""
    return solve_ivp(
        lambda t, y: [y[1], -p * y[1] - q * y[1] * abs(y[1]) - OMEGA**2 * y[0]],
        (0, TIMES[-1]),
        [5.0, 0.0],
        t_eval=TIMES,
        rtol=1e-10,
        atol=1e-12,
    ).y[0]


def fitted(p: float, q: float) -> Classical:
    return classical(TIMES, decay(p, q), noise=1e-3)


@pytest.mark.parametrize("zeta", [0.005, 0.05, 0.2])
def test_linear_decay_is_exact(zeta: float) -> None:
    """Of exp(-zeta w t): p = 2 zeta w, q = 0, the ratio zeta at every amplitude and on either side, however strong it is."""
    analysis = classical(TIMES, linear_decay(zeta), noise=0.0)
    p = 2 * zeta * OMEGA / math.sqrt(1 - zeta**2)
    assert analysis.fit.linear.value == pytest.approx(p, rel=1e-6)
    assert abs(analysis.fit.quadratic.value) * 5 * 8 / 3 < 1e-6
    assert analysis.fit.period == pytest.approx(PERIOD, rel=1e-6)
    assert analysis.positive_fit is not None and analysis.positive_fit.linear.value == pytest.approx(p, rel=1e-6)
    for pairs in (analysis.half_cycles, analysis.positive, analysis.negative):
        assert len(pairs.first) >= 12
        assert_allclose(pairs.damping_ratio, zeta, rtol=1e-5)


def test_quadratic_coefficient_of_a_linear_decay_is_zero_within_its_interval() -> None:
    """Noise of 1 % of the release: 0 lies in the interval of q, and p in its own."""
    rng = np.random.default_rng(5)
    fit = classical(TIMES, linear_decay(0.02) + rng.normal(0, 0.05, len(TIMES)), noise=0.05).fit
    assert fit.quadratic.lower < 0 < fit.quadratic.upper
    assert fit.linear.lower < 2 * 0.02 * OMEGA < fit.linear.upper


def test_half_cycles_are_those_of_decay_cycles_and_sides_their_mean() -> None:
    """One peak finder: the same cycles, a whole cycle's decrement being the mean of its two halves'."""
    half, positive, negative = decrements(TIMES, decay(0.01, 0.05), 1e-3)
    cycles = decay_cycles(TIMES, decay(0.01, 0.05), 1e-3)
    for actual, expected in zip((half.time, half.amplitude, half.period, half.decrement), cycles, strict=True):
        assert_allclose(actual, expected, rtol=1e-12)
    mean = 0.5 * (half.decrement[1:] + half.decrement[:-1])  # the first extreme is the trough half a period after release
    assert_allclose(negative.decrement, mean[::2], rtol=1e-12)
    assert_allclose(positive.decrement, mean[1::2], rtol=1e-12)


def test_sides_apart_show_a_wrong_zero() -> None:
    """0.1 m off zero: at 1 m, crests seem to lose a tenth less and troughs a tenth more; without, both lose the same."""
    for offset, order in ((0.0, 1e-3), (0.1, 0.1)):
        analysis = classical(TIMES, linear_decay(0.02) + offset, noise=1e-3)
        sides = (analysis.positive, analysis.negative)
        crests, troughs = (float(np.interp(-1.0, -side.amplitude, side.decrement)) for side in sides)
        assert (troughs - crests) / (2 * math.pi * 0.02) == pytest.approx(2 * offset, abs=order / 2)


@pytest.mark.parametrize(("p", "q"), [(0.0, 0.02), (0.004, 0.01), (0.02, 0.03)])
def test_linear_and_quadratic_damping_of_a_solution(p: float, q: float) -> None:
    """Half-cycle decrements up to 0.25: q within 0.5 %, p within 2e-4 w; over whole cycles within 2.5 % and 8e-4 w."""
    analysis = fitted(p, q)
    assert analysis.half_cycles.decrement.max() / 2 < 0.25
    assert analysis.fit.quadratic.value == pytest.approx(q, rel=5e-3)
    assert analysis.fit.linear.value == pytest.approx(p, abs=2e-4 * OMEGA)
    for fit in (analysis.positive_fit, analysis.negative_fit):
        assert fit is not None and fit.quadratic.value == pytest.approx(q, rel=2.5e-2)
        assert fit.linear.value == pytest.approx(p, abs=8e-4 * OMEGA)


@pytest.mark.parametrize("p", [0.0, 0.02])
def test_bias_grows_with_the_square_of_damping(p: float) -> None:
    """The docstring's bias: q low by 0.045 to 0.06 L^2, p high by up to 0.005 L^2 w, worse by the damping; over
    whole cycles q low by 0.15 to 0.65 L^2, p high by up to 0.02 L^2 w."""
    q_bias, p_bias = [], []
    for q in (0.0375, 0.075, 0.15, 0.3):
        fit = fitted(p, q)
        largest = fit.half_cycles.decrement.max() / 2
        q_bias.append(fit.fit.quadratic.value / q - 1)
        p_bias.append((fit.fit.linear.value - p) / OMEGA)
        assert -0.06 < q_bias[-1] / largest**2 < -0.045
        assert 0 < p_bias[-1] / largest**2 < 0.005
        assert fit.positive_fit is not None
        assert -0.65 < (fit.positive_fit.quadratic.value / q - 1) / largest**2 < -0.15
        assert 0 < (fit.positive_fit.linear.value - p) / OMEGA / largest**2 < 0.02
    assert np.all(np.diff(q_bias) < 0) and np.all(np.diff(p_bias) > 0)
    assert q_bias[-1] < -0.01


def test_intervals_cover_and_covariance_is_that_of_the_estimates() -> None:
    """100 seeds of noise, 1 % of the release, on one solution: 95 % intervals hold the noise-free fit 89 to 99 times, the
    covariance is that of the estimates within a third, and p and q fall together less than they each vary."""
    clean, rng = decay(0.01, 0.02), np.random.default_rng(1)
    window = TIMES < 125.0  # the last extreme stays clear of the noise, so that all fits are of the same extremes
    truth = classical(TIMES[window], clean[window], noise=0.05).fit
    fits = [classical(TIMES[window], clean[window] + rng.normal(0, 0.05, window.sum()), noise=0.05).fit for _ in range(100)]
    for name in ("linear", "quadratic"):
        inside = sum(getattr(f, name).lower < getattr(truth, name).value < getattr(f, name).upper for f in fits)
        assert 89 <= inside <= 99, name
    spread = np.cov([[f.linear.value for f in fits], [f.quadratic.value for f in fits]])
    assert_allclose(np.mean([f.covariance for f in fits], axis=0), spread, rtol=0.35)
    amplitude = np.array([1.0, 3.0])
    target = equivalent_damping(truth, amplitude, 2.0).value
    bands = [equivalent_damping(f, amplitude, 2.0) for f in fits]
    assert np.all(np.abs(np.mean([(b.lower < target) & (target < b.upper) for b in bands], axis=0) - 0.95) <= 0.06)


def test_scatter_is_that_of_the_extremes() -> None:
    """Extremes of an exact decay, each with an error of 0.02 m: the fit's scatter is 0.02 m, in the mean over seeds."""
    n, rng = 20, np.random.default_rng(2)
    heights = 5 * np.exp(-0.05 * np.arange(n))
    pairs = [
        Decrements(0.5 * PERIOD * np.arange(n), heights + rng.normal(0, 0.02, n), np.arange(n - 1), np.arange(1, n), 0.5)
        for _ in range(50)
    ]
    assert np.sqrt(np.mean([linear_quadratic(p).scatter ** 2 for p in pairs])) == pytest.approx(0.02, rel=0.1)


def test_equivalent_damping_dissipates_what_the_quadratic_one_does() -> None:
    """B_eq pi w a^2 is the work of M (p x' + q x'|x'|) over a cycle of a cos wt, by quadrature; M doubles both bounds."""
    fit, a, angle = fitted(0.004, 0.01).fit, 3.0, np.linspace(0, 2 * math.pi, 2001)
    velocity, omega = -a * 2 * math.pi / fit.period * np.sin(angle), 2 * math.pi / fit.period
    work = np.trapezoid((fit.linear.value + fit.quadratic.value * abs(velocity)) * velocity**2, angle / omega)
    single, twice = equivalent_damping(fit, a, 1.0), equivalent_damping(fit, a, 2.0)
    assert single.value * math.pi * omega * a**2 == pytest.approx(work, rel=1e-5)
    assert single.lower < single.value < single.upper
    assert_allclose(np.array(twice), 2 * np.array(single))
    assert_allclose([b.value for b in fit.damping(2.0)], [2 * fit.linear.value, 2 * fit.quadratic.value])
    record = classical(TIMES, decay(0.004, 0.01), noise=1e-3, inertia=2.0)
    assert record.equivalent is not None
    assert_allclose(record.equivalent.value, equivalent_damping(fit, record.half_cycles.amplitude, 2.0).value)


def test_negative_damping_is_warned_of() -> None:
    """Decrements that fall with amplitude have a negative q, one that settles to a cycle a negative p; others neither."""
    assert fitted(0.004, 0.01).fit.warnings == ()
    friction = np.interp(TIMES, [0, 300], [5, 0.5]) * np.cos(OMEGA * TIMES)  # loses the same height every cycle
    warnings = classical(TIMES, friction, noise=1e-3).fit.warnings
    assert any(text.startswith("quadratic damping is negative") for text in warnings)
    fit = fitted(-0.004, 0.01).fit
    assert fit.linear.value == pytest.approx(-0.004, abs=1e-4)
    assert [text for text in fit.warnings if text.startswith("linear") and text.endswith("beyond its uncertainty")]


def test_skip_leaves_out_the_start() -> None:
    """Two half cycles less in all, those of the largest amplitude, on the sides too."""
    whole, late = (classical(TIMES, decay(0.01, 0.05), noise=1e-3, skip=skip) for skip in (0, 2))
    assert_allclose(late.half_cycles.amplitude, whole.half_cycles.amplitude[2:])
    assert_allclose(np.concatenate([late.positive.time, late.negative.time]).min(), whole.negative.time[1])


@pytest.mark.parametrize(
    ("time", "motion", "message"),
    [
        (TIMES[:200], linear_decay(0.02)[:200], "at least 3 half cycles .* found 1"),
        (TIMES, np.zeros(len(TIMES)), "at least 3 half cycles .* found 0"),
        (TIMES, TIMES[1:], "of one length, found shapes"),
        (TIMES[::-1], linear_decay(0.02), "increasing times"),
        (TIMES, np.where(TIMES > 100, np.nan, TIMES), "finite numbers"),
        (TIMES, np.cos(OMEGA * TIMES), "amplitudes between"),
    ],
)
def test_what_is_no_decay_is_refused(time: np.ndarray, motion: np.ndarray, message: str) -> None:
    """One sentence, what was expected and what was found."""
    with pytest.raises(ValueError, match=message):
        classical(time, motion, noise=1e-3)


# a model's damping


@cache
def platform() -> jh.Model:
    return jh.load_model("volturnus-s")


@pytest.mark.slow
def test_heave_damping_of_volturnus_by_hand() -> None:
    """Heave: 1/2 rho Cd A of three pontoons in plan and of four column bottoms; B33; mass and added mass by hand."""
    damping, half = model_damping(platform(), "heave"), 0.5 * 1025.0
    plan, bottoms = 3 * 40.5 * 12.5, math.pi / 4 * (10.0**2 + 3 * 12.5**2)
    assert damping.per_coefficient["pontoon.Cd_z"] == pytest.approx(half * plan, rel=1e-9)
    assert damping.per_coefficient["column.Cd_z"] == pytest.approx(half * bottoms, rel=1e-9)
    assert damping.quadratic == pytest.approx(half * (4.96 * plan + 2.23 * bottoms), rel=1e-9)
    assert damping.linear == pytest.approx(1.6e5, rel=1e-6)
    ends = 2 / 3 * math.pi * (5.0**3 + 3 * 6.25**3)
    mass = 20093000.0 + 1025.0 * (1.87 * plan * 7.0 + 0.12 * ends)
    assert damping.inertia == pytest.approx(mass, rel=1e-9)
    assert damping.rates == pytest.approx((1.6e5 / mass, damping.quadratic / mass), rel=1e-6)


@pytest.mark.parametrize("dof", ["surge", "pitch", "yaw"])
def test_groups_add_up_and_a_fit_goes_back_to_a_coefficient(dof: str) -> None:
    """B_quad is the sum over coefficients of Cd times its share; a Cd found from a B_quad gives that B_quad."""
    model, damping = platform(), model_damping(platform(), dof)
    total = sum(float(model.values[label]) * slope for label, slope in damping.per_coefficient.items())
    assert damping.quadratic == pytest.approx(total, rel=1e-9)
    cd = drag_coefficient(model, damping, "column.Cd_t", 1.3 * damping.quadratic)
    assert cd > float(model.values["column.Cd_t"])
    changed = model_damping(model.with_values({"column.Cd_t": cd}), dof)
    assert changed.quadratic == pytest.approx(1.3 * damping.quadratic, rel=1e-9)
    assert changed.linear == pytest.approx(damping.linear, rel=1e-6, abs=1.0)


def test_pitch_in_its_mode_has_the_modes_inertia() -> None:
    """S K S over S M S is the square of the mode's frequency, as the single degree of freedom's is not."""
    model, position = platform(), jh.equilibrium(platform())
    shape = motion_shape(model, "pitch")
    mass, stiffness = (np.asarray(m) for m in linearised(model, position))
    damping = model_damping(model, "pitch", shape=shape)
    assert damping.inertia == pytest.approx(shape @ mass @ shape, rel=1e-9)
    period = 2 * math.pi * math.sqrt(damping.inertia / (shape @ stiffness @ shape))
    assert period == pytest.approx(jh.natural_modes(model).of("pitch"), rel=1e-6)
    assert damping.inertia != pytest.approx(model_damping(model, "pitch").inertia, rel=0.01)


@pytest.mark.parametrize(("dof", "released"), [("heave", 3.0), ("pitch", math.radians(5.0))])
def test_decay_of_a_model_has_its_coefficients(dof: str, released: float) -> None:
    """P-Q of a simulated decay, let go in the shape of a mode: B_quad/M within 1 %, B_lin/M within 3e-4 w."""
    times, shape = np.arange(0.0, 400.0, 0.2), motion_shape(platform(), dof)
    motion = np.asarray(jh.free_decay(platform(), jnp.asarray(released * shape), times)[dof])
    fit, (p, q) = classical(times, motion, noise=1e-4 * released).fit, model_damping(platform(), dof, shape=shape).rates
    assert fit.quadratic.value == pytest.approx(q, rel=0.01)
    assert fit.linear.value == pytest.approx(p, abs=3e-4 * 2 * math.pi / fit.period)


class Friction(AbstractLoad):
    """F = -F0 tanh(v/0.1) in heave: neither linear nor quadratic."""

    size: jax.Array = parameter("N", "friction", neutral=1e6)

    def act(self, now, memory) -> Action:
        return Action(body_force=-self.size * jnp.tanh(now.velocity / 0.1) * jnp.eye(6)[2])


def test_wrong_requests_are_refused() -> None:
    """Damping of another law, an unknown degree of freedom or label, a shape without it, a drag that does not act."""
    with pytest.raises(ValueError, match="linear and quadratic damping in heave"):
        model_damping(platform().with_effect(Friction()), "heave")
    with pytest.raises(KeyError, match="heeve"):
        model_damping(platform(), "heeve")
    with pytest.raises(KeyError, match="heeve"):
        motion_shape(platform(), "heeve")
    with pytest.raises(ValueError, match="1 for heave"):
        model_damping(platform(), "heave", shape=np.eye(6)[0])
    heave = model_damping(platform(), "heave")
    with pytest.raises(KeyError, match=r"column\.Cd_q"):
        drag_coefficient(platform(), heave, "column.Cd_q", 1e6)
    with pytest.raises(ValueError, match=r"column\.Cd_t"):
        drag_coefficient(platform(), heave, "column.Cd_t", 1e6)
