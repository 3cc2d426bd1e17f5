"""Uncertainty: spectra of residuals, profiles, bootstrap and sampling on problems whose answers are known."""

import math
import time
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.signal import lfilter
from test_calibration import MEASURED, SHIP, SHIP_NOISE, SHIP_TRUE, measured, roll_decay, write

from calibration.campaign.load_campaign import Campaign, load_campaign
from calibration.fitting.decay_calibration import calibrate
from calibration.identifiability.residual_spectra import NoiseColour, fit_colours, periodogram, score_covariance, whittle
from calibration.plots.uncertainty_figures import draws_figure, profile_figure
from calibration.uncertainty import nuts as sampling
from calibration.uncertainty.bootstrap import bootstrap_blocks, bootstrap_repeats, repeats
from calibration.uncertainty.likelihood import Likelihood
from calibration.uncertainty.likelihood_of_fit import likelihood
from calibration.uncertainty.nuts import potential_energy, sample, whitening
from calibration.uncertainty.profile import Profile, profile
from jaxhydro.errors import InputError
from jaxhydro.plots.style import style

pytestmark = pytest.mark.slow

FREE = ["added_mass.A44", "linear_damping.B44", "quadratic_damping.B44"]
N, STEP = 400, 0.1


# spectra of residuals


def noise(kind: str, random: np.random.Generator, n: int = N) -> tuple[np.ndarray, NoiseColour]:
    """(n,) of unit variance and its colour."""
    e = random.standard_normal(n + 4000)
    if kind == "white":
        return e[-n:], NoiseColour(1.0, 0.0, 0.0, 1.0)
    keep = math.exp(-STEP / 0.8)
    x = lfilter([math.sqrt(1 - keep**2)], [1.0, -keep], e)[-n:]
    width = 1 / (2 * math.pi * 0.8)
    return x, NoiseColour(0.0, (1 + keep) / (1 - keep) / 2, 1e-6, width)


@pytest.mark.parametrize("kind", ["white", "drifting"])
def test_the_colour_of_noise_is_found(kind: str) -> None:
    random = np.random.default_rng(1)
    rows = [noise(kind, random)[0] for _ in range(6)]
    colour, variance, _ = whittle([periodogram(x, np.zeros(N // 2 + 1), STEP) for x in rows])
    assert len(set(variance)) == 1 and variance[0] == pytest.approx(1.0, rel=0.3)
    true, frequency = noise(kind, random)[1], np.array([0.05, 0.2, 0.5])
    np.testing.assert_allclose(colour.density(frequency), true.density(frequency), rtol=0.35)


def test_records_of_unlike_noise_keep_their_own_variance() -> None:
    random = np.random.default_rng(6)
    rows = [size * random.standard_normal(N) for size in (1.0, 3.0)]
    colour, variance, _ = whittle([periodogram(x, np.zeros(N // 2 + 1), STEP) for x in rows])
    np.testing.assert_allclose(variance, [1.0, 9.0], rtol=0.2)
    assert colour.peak == 0


def test_groups_share_a_colour_unless_they_differ() -> None:
    random = np.random.default_rng(7)
    white, slow = (
        [periodogram(noise(kind, random)[0], np.zeros(N // 2 + 1), STEP) for _ in range(3)] for kind in ("white", "drifting")
    )
    (first, _), (second, _) = fit_colours([slow[:1], slow[1:]])
    assert first == second and first.peak > 1
    (first, _), (second, _) = fit_colours([white, slow])
    assert first.peak == 0 and second.peak > 1


def test_a_score_of_white_and_of_lasting_noise_has_its_own_variance() -> None:
    """J^T e over many draws of e, J a decay."""
    random, t = np.random.default_rng(2), STEP * np.arange(N)
    slope = np.exp(-0.02 * t[:, None]) * np.stack([np.cos(1.2 * t), np.sin(1.2 * t)], axis=1)
    for kind in ("white", "drifting"):
        draws = np.array([noise(kind, random)[0] @ slope for _ in range(3000)])
        predicted = score_covariance(slope, 1.0, noise(kind, random)[1], STEP)
        np.testing.assert_allclose(np.diag(predicted), draws.var(axis=0), rtol=0.15)


def test_what_a_fit_has_taken_from_its_residual_is_given_back() -> None:
    """Variance and colour of white noise, from residuals of a regression on a tenth of all frequencies."""
    random, t = np.random.default_rng(3), STEP * np.arange(N)
    waves = np.concatenate([[np.cos(k * 2 * np.pi * t / t[-1]), np.sin(k * 2 * np.pi * t / t[-1])] for k in range(2, 22)])
    basis = np.linalg.qr(waves.T)[0]
    leverage = (np.abs(np.fft.rfft(basis, axis=0)) ** 2).sum(axis=1) / N
    assert leverage.max() <= 1 + 1e-9
    colours = []
    for _ in range(20):
        e = random.standard_normal(N)
        colours.append(periodogram(e - basis @ (basis.T @ e), leverage, STEP))
    assert np.mean([colour.variance for colour in colours]) == pytest.approx(1.0, rel=0.05)
    assert whittle(colours)[0].density(np.array([0.3]))[0] == pytest.approx(1.0, rel=0.2)


# a small body's decays


def campaign_of(folder: Path, disturbed: float = 0.0, size: float = 1.0) -> Campaign:
    """Three roll decays of `size`, two of them repeats; `disturbed` (rad) is the deviation of noise that rings at the roll's
    period."""
    random, tests = np.random.default_rng(3), {}
    for name, degrees, of in (("roll-1", 12.0, None), ("roll-2", 6.0, None), ("roll-3", 12.0, "roll-1")):
        time, roll = roll_decay(size * degrees, 24.0)
        drive = random.standard_normal(len(time) + 2000)
        keep, turn = math.exp(-0.1 * 0.08 * 2.38), 0.08 * 2.38
        slow = lfilter([1.0], [1.0, -2 * keep * math.cos(turn), keep**2], drive)
        noisy = roll + SHIP_NOISE * random.standard_normal(len(time)) + disturbed * (slow / slow.std())[2000:]
        keys = {"kind": "decay", "degree_of_freedom": "roll", "use": "fit"} | ({"repeat_of": of} if of else {})
        tests[name] = (keys, time, {"roll": noisy})
    return load_campaign(write(folder, SHIP, tests, noise={"roll": SHIP_NOISE}, calibrate={"free": FREE}))


@pytest.fixture(scope="module")
def ship(tmp_path_factory: pytest.TempPathFactory) -> Likelihood:
    campaign = campaign_of(tmp_path_factory.mktemp("ship"))
    return likelihood(campaign, calibrate(campaign))


@pytest.fixture(scope="module")
def ringing(tmp_path_factory: pytest.TempPathFactory) -> Likelihood:
    campaign = campaign_of(tmp_path_factory.mktemp("ringing"), disturbed=10 * SHIP_NOISE)
    return likelihood(campaign, calibrate(campaign))


def test_the_fit_is_found_again(ship: Likelihood) -> None:
    assert ship.fit.converged
    for label, true in SHIP_TRUE.items():
        low, high = ship.interval(label, 0.999)
        assert low < true < high
    assert max(ship.excess().values()) < 1.2


def test_white_deviations_are_too_small_where_errors_last(ringing: Likelihood) -> None:
    assert min(ringing.excess().values()) > 3
    for label, true in SHIP_TRUE.items():
        low, high = ringing.interval(label, 0.999)
        assert low < true < high


@pytest.mark.parametrize("which", ["ship", "ringing"])
def test_the_profile_agrees_with_the_covariance_where_the_model_is_nearly_linear(which: str, request) -> None:
    likely: Likelihood = request.getfixturevalue(which)
    curve = profile(likely, "added_mass.A44")
    np.testing.assert_allclose(curve.interval, curve.laplace, rtol=1e-4)
    width = curve.laplace[1] - curve.laplace[0]
    assert curve.upper - curve.lower == pytest.approx(width, rel=0.03)
    assert curve.drop.min() == 0 and (curve.drop[[0, -1]] > 3.84).all() and (np.diff(curve.grid) > 0).all()
    assert curve.holds(curve.estimate) and not curve.holds(curve.lower - width)
    assert "between" in str(curve)


def test_the_other_unknowns_are_refitted(ship: Likelihood) -> None:
    """With the others held, the sum of squares would grow by the diagonal of the information: many times as much."""
    label = "linear_damping.B44"
    i, curve = ship.index(label), profile(ship, label)
    off = curve.coordinate - ship.estimate[i]
    alone = ship.information[i, i] * off[0] ** 2 / curve.nu
    assert alone > 5 * curve.drop[0] > 0


@measured
def test_a_profile_finds_its_way_where_the_others_follow_on_a_curve() -> None:
    """The roll of KVLCC2: linear damping takes over where quadratic damping goes, far beyond what the covariance says."""
    campaign = load_campaign(MEASURED / "kvlcc2")
    curve = profile(likelihood(campaign, calibrate(campaign)), "quadratic_damping.B44")
    below = curve.grid < curve.estimate
    assert curve.lower is None and (np.diff(curve.drop[below]) < 0).all() and curve.drop[below].max() < 3.84
    assert curve.upper is not None and curve.upper < curve.laplace[1]


def test_what_the_records_do_not_bound_is_open(tmp_path: Path) -> None:
    """Releases of half a degree: quadratic damping is at most so much, and may be nothing."""
    campaign = campaign_of(tmp_path, size=0.04)
    likely = likelihood(campaign, calibrate(campaign))
    curve = profile(likely, "quadratic_damping.B44")
    assert curve.lower is None and curve.upper is not None and curve.upper > SHIP_TRUE["quadratic_damping.B44"]
    assert "at most" in str(curve) and curve.holds(1e-3)


def test_an_unknown_label_is_told_what_there_is(ship: Likelihood) -> None:
    for wrong in (lambda: profile(ship, "linear_damping.B55"), lambda: ship.interval("B44")):
        with pytest.raises(InputError) as caught:
            wrong()
        assert all(label in str(caught.value) for label in FREE)


@pytest.mark.parametrize("which", ["ship", "ringing"])
def test_blocks_scatter_as_the_covariance_says(which: str, request) -> None:
    likely: Likelihood = request.getfixturevalue(which)
    bootstrap = bootstrap_blocks(likely, 96, seed=1)
    assert bootstrap.unsettled == 0 and bootstrap.value.shape == (96, 3)
    ratio = bootstrap.deviation() / likely.deviation()
    assert (ratio > 0.55).all() and (ratio < 1.6).all()
    for label in FREE:
        for kind in ("percentile", "basic", "normal"):
            low, high = bootstrap.interval(label, kind=kind)
            assert low < likely.value(label, likely.estimate[likely.index(label)]) < high


def test_the_same_seed_gives_the_same_draws_and_progress_is_told(ship: Likelihood) -> None:
    reports: list[tuple[int, int]] = []
    first = bootstrap_blocks(ship, 20, seed=4, progress=lambda *now: reports.append(now))
    same, third = bootstrap_blocks(ship, 20, seed=4), bootstrap_blocks(ship, 20, seed=5)
    np.testing.assert_array_equal(first.coordinate, same.coordinate)
    assert np.abs(first.coordinate - third.coordinate).max() > 0
    assert reports == [(16, 20), (20, 20)]


def test_repeats_are_drawn_anew(ship: Likelihood) -> None:
    bootstrap = bootstrap_repeats(ship, 32, seed=0)
    assert bootstrap.groups == {"roll-1": ("roll-1", "roll-3"), "roll-2": ("roll-2",)} and bootstrap.unsettled == 0
    # one of two repeats, twice: two outcomes, on either side of the estimate
    outcomes = np.unique(bootstrap.coordinate.round(7), axis=0)
    assert len(outcomes) == 2
    assert ((outcomes - bootstrap.estimate)[0] * (outcomes - bootstrap.estimate)[1] < 0).all()


def test_groups_of_repeats() -> None:
    assert repeats({"a": None, "b": "a", "c": "b", "d": None}) == {"a": ("a", "b", "c"), "d": ("d",)}
    assert repeats({"b": "a", "c": "a"}) == {"a": ("b", "c")}  # the first is held out
    assert repeats({"b": "a", "a": "b"}) == {"a": ("b", "a")}


def test_no_repeats_is_told(ship: Likelihood, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("calibration.uncertainty.bootstrap.repeats", lambda of: {id: (id,) for id in of})
    with pytest.raises(InputError) as caught:
        bootstrap_repeats(ship, 4)
    assert "repeat_of" in str(caught.value) and "roll-2" in str(caught.value)


# sampling


def test_the_energys_gradient_is_that_of_the_sum_of_squares(ship: Likelihood) -> None:
    root = whitening(ship, ship.scale())[0]
    z = jnp.asarray(ship.estimate + root @ np.random.default_rng(0).standard_normal(len(root)))
    energy_and_slope = jax.jit(jax.value_and_grad(potential_energy(ship, ship.scale())))
    value, slope = energy_and_slope(z)
    for direction in np.random.default_rng(1).standard_normal((2, len(root))) @ root.T:
        ends = [float(energy_and_slope(z + sign * 1e-3 * direction)[0]) for sign in (1, -1)]
        assert float(slope @ direction) == pytest.approx((ends[0] - ends[1]) / 2e-3, rel=1e-4, abs=1e-6)
    assert float(value) > float(energy_and_slope(jnp.asarray(ship.estimate))[0])


@pytest.mark.parametrize("which", ["ship", "ringing"])
def test_stretched_draws_have_the_sandwichs_covariance(which: str, request) -> None:
    likely: Likelihood = request.getfixturevalue(which)
    root, stretch = whitening(likely, likely.scale())
    wide = stretch @ root @ root.T @ stretch.T
    np.testing.assert_allclose(np.sqrt(np.diag(wide)[:3]), likely.deviation(), rtol=0.02)


@pytest.mark.parametrize("least", [1, 10**6])
def test_chains_that_are_stopped(monkeypatch: pytest.MonkeyPatch, least: int) -> None:
    """What all chains have is kept where it is enough; else the stop goes on up."""
    monkeypatch.setattr(sampling, "MIN_DRAWS", least)

    def step(state):
        time.sleep(0.002)
        return SimpleNamespace(z=state.z + 1, diverging=False)

    def stop(done: int, remark: str) -> None:
        if remark == "drawing":
            raise KeyboardInterrupt

    begun = [SimpleNamespace(z=np.full(2, 1000.0 * k), diverging=False) for k in range(3)]
    walk = partial(sampling._run_chains, step, begun, 5, 4000)
    if least > 1:
        with pytest.raises(KeyboardInterrupt):
            walk(stop)
        return
    rows = walk(stop)
    assert len({len(row) for row in rows}) == 1 and 1 <= len(rows[0]) < 4000
    for k, row in enumerate(rows):
        assert [at[0] for at, _ in row] == [1000 * k + 6 + i for i in range(len(row))]


def test_nuts_agrees_with_the_covariance(ship: Likelihood) -> None:
    samples = sample(ship, draws=100, warmup=40, chains=2, seed=3)
    assert samples.value.shape == (2, 100, 3) and samples.divergences == 0
    assert (samples.r_hat < 1.05).all() and (samples.effective > 80).all()
    np.testing.assert_allclose(samples.deviation(), ship.deviation(), rtol=0.25)
    low, high = samples.interval("added_mass.A44")
    assert low < SHIP_TRUE["added_mass.A44"] < high


def test_without_numpyro_the_extra_is_named(ship: Likelihood, monkeypatch: pytest.MonkeyPatch) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "numpyro.infer", None)
    monkeypatch.setitem(sys.modules, "numpyro.diagnostics", None)
    with pytest.raises(ImportError, match=r"jaxhydro\[nuts\]"):
        sample(ship)


def test_figures_are_drawn(ship: Likelihood) -> None:
    curve: Profile = profile(ship, "linear_damping.B44")
    with style():
        assert len(profile_figure(curve).axes) == 1
        draws = bootstrap_repeats(ship, 4)
        assert len(draws_figure(draws, *FREE[:2]).axes[0].lines) == 2
