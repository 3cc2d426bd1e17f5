"""Calibration: small campaigns written by the package's own simulator, whose coefficients are known."""

import dataclasses
import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from ruamel.yaml import YAML

import jaxhydro as jh
from calibration.campaign.load_campaign import Campaign, load_campaign
from calibration.fitting.decay_calibration import calibrate
from calibration.fitting.decay_fit import fit_of_decays, run_fit, set_up_decays
from calibration.fitting.fit import Fit
from calibration.fitting.fit_conclusion import stated_zeros
from calibration.fitting.normal_equations import LeastSquares, cost_of, normal_equations
from calibration.fitting.progress import Interrupted, Progress
from calibration.identifiability.standard_deviations import correlated_samples, sandwich_covariance
from calibration.parameters.space import default_free, match_free_labels, parameter_space, slopes
from calibration.parameters.transforms import Interval, LogInterval, Scaled
from calibration.residuals.abstract_residual import Unknowns
from calibration.residuals.decays import DecayProblem, crossing_period, first_guess
from calibration.result import Calibration
from jaxhydro.dynamics.response import decay_cycles
from jaxhydro.dynamics.statics import linearised
from jaxhydro.errors import InputError

ROOT = Path(__file__).resolve().parents[2]
DEMO = ROOT / "jaxhydro" / "campaigns" / "volturnus-s-decays"
MEASURED = ROOT.parent / "shared" / "measured"
measured = pytest.mark.skipif(not MEASURED.exists(), reason="the measured data in ../shared are not on this machine")
UNITS = {"surge": "m", "sway": "m", "heave": "m", "roll": "rad", "pitch": "rad", "yaw": "rad"}

# a ship in roll: no members, lumped terms only
SHIP = {
    "name": "a ship",
    "water": {"density": 1000.0, "depth": 5.0, "gravity": 9.81},
    "rigid_body": {
        "mass": 994.0,
        "centre_of_mass": [0.0, 0.0, -0.0324],
        "inertia": {"Ixx": 115.7, "Iyy": 1376.0, "Izz": 1376.0},
    },
    "members": [],
    "added_mass": {"A44": 20.0},
    "linear_damping": {"B44": 3.0},
    "quadratic_damping": {"B44": 15.0},
    "hydrostatics": {"C44": 822.0},
    "mooring": {"kind": "none"},
}
SHIP_TRUE = {"added_mass.A44": 26.0, "linear_damping.B44": 1.8, "quadratic_damping.B44": 24.0}
SHIP_NOISE, SHIP_OFFSET = 2e-4, 3e-3  # rad
# the made campaign's semi-submersible, floating 0.2 m deeper than drawn
SEMI_TRUE = {"pontoon.Ca_z": 1.87, "pontoon.Cd_z": 4.96, "linear_damping.B33": 1.6e5}
SEMI_NOISE = 0.004  # m


def semi() -> dict:
    """The made campaign's platform file, 0.45 % heavier: it floats some 0.2 m deeper."""
    document = YAML(typ="safe").load((DEMO / "platform.yaml").read_text())
    document["rigid_body"]["mass"] *= 1.0045
    return document


def model_of(document: dict, values: dict[str, float] | None = None) -> jh.Model:
    return jh.build(jh.Platform.model_validate(document)).with_values(values or {})


def write(folder: Path, platform: dict | str, tests: dict, scale: float = 1.0, **options) -> Path:
    """A campaign of SI full-scale records, test id -> (test's keys, time, channel -> values), stored at its own scale."""
    folder.mkdir(parents=True, exist_ok=True)
    yaml, entries, channels = YAML(typ="safe"), [], {}
    for name, (keys, time, values) in tests.items():
        columns = [time / math.sqrt(scale)]
        columns += [v / (scale if UNITS[c] == "m" else 1.0) for c, v in values.items()]
        np.savetxt(
            folder / f"{name}.csv",
            np.column_stack(columns),
            fmt="%.12g",
            delimiter=",",
            comments="",
            header=",".join(["time", *values]),
        )
        channels |= {c: {"column": c, "unit": UNITS[c]} for c in values}
        entries.append({"id": name, "file": f"{name}.csv", **keys})
    if isinstance(platform, dict):
        with open(folder / "platform.yaml", "w") as file:
            yaml.dump(platform, file)
        platform = "platform.yaml"
    channels["time"] = {"column": "time", "unit": "s"}
    manifest = {"name": "made", "platform": platform, "scale": scale, "channels": channels, "tests": entries, **options}
    with open(folder / "campaign.yaml", "w") as file:
        yaml.dump(manifest, file)
    return folder


def roll_decay(degrees: float, duration: float = 40.0, values: dict[str, float] | None = None):
    """Time and roll (rad) of the true ship."""
    time = np.arange(0.0, duration, 0.08)
    model = model_of(SHIP, SHIP_TRUE if values is None else values)
    return time, np.asarray(jh.free_decay(model, {"roll": np.radians(degrees)}, time)["roll"])


@pytest.fixture(scope="module")
def ship_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three noisy roll decays: one from a sensor that is off, one held out."""
    random, tests = np.random.default_rng(3), {}
    for name, degrees, offset, use in (
        ("roll-1", 12.0, 0.0, "fit"),
        ("roll-2", 6.0, SHIP_OFFSET, "fit"),
        ("roll-3", 9.0, 0.0, "holdout"),
    ):
        time, roll = roll_decay(degrees)
        noisy = roll + offset + SHIP_NOISE * random.standard_normal(len(time))
        tests[name] = ({"kind": "decay", "degree_of_freedom": "roll", "use": use}, time, {"roll": noisy})
    return write(tmp_path_factory.mktemp("ship"), SHIP, tests, noise={"roll": SHIP_NOISE})


@pytest.fixture(scope="module")
def ship_campaign(ship_folder: Path) -> Campaign:
    return load_campaign(ship_folder)


@pytest.fixture(scope="module")
def ship(ship_campaign: Campaign) -> tuple[Calibration, list[Progress]]:
    """The ship's calibration and what it reported."""
    reports: list[Progress] = []
    return calibrate(ship_campaign, progress=reports.append), reports


def posed(campaign: Campaign, labels: tuple[str, ...] | None = None) -> tuple[DecayProblem, tuple]:
    """The problem that `calibrate` poses, and its records."""
    records = campaign.used("fit")
    declared = jh.build(campaign.platform)
    chosen = match_free_labels(declared, [str(r.degree_of_freedom) for r in records], labels)
    return set_up_decays(declared, campaign, records, parameter_space(declared, chosen)), records


# transforms


@pytest.mark.parametrize(
    ("transform", "values"),
    [
        (LogInterval(0.01, 100.0), (0.02, 0.5, 1.0, 7.0, 90.0)),
        (LogInterval(3e5, 3e11), (4e5, 3.63e8, 2e11)),
        (Interval(-2.0, 5.0), (-1.9, 0.0, 4.9)),
        (Scaled(-3.0, 0.5), (-100.0, -3.0, 0.0, 12.0)),
    ],
)
def test_transforms_are_undone_by_their_inverse(transform, values) -> None:
    for value in values:
        x = transform.inverse(value)
        assert float(transform.forward(jnp.asarray(x))) == pytest.approx(value, rel=1e-10, abs=1e-12)
    for x in np.linspace(-3, 3, 7):
        assert transform.inverse(float(transform.forward(jnp.asarray(x)))) == pytest.approx(x, abs=1e-9)


@pytest.mark.parametrize("transform", [LogInterval(0.5, 8.0), Interval(0.5, 8.0)])
def test_transforms_keep_to_their_bounds(transform) -> None:
    ends = [float(transform.forward(jnp.asarray(x))) for x in (-1e3, 1e3)]
    assert ends == pytest.approx([0.5, 8.0])
    for value in (-1.0, 0.5, 8.0, 100.0):  # the nearest inside
        x = transform.inverse(value)
        assert math.isfinite(x) and transform.at_bound(x)
    assert not transform.at_bound(transform.inverse(2.0))
    assert not Scaled(0.0, 1.0).at_bound(1e9)


def test_a_step_of_a_logarithmic_coordinate_is_a_relative_change() -> None:
    transform = LogInterval(1e-3, 1e3)
    slope = float(jax.grad(lambda x: jnp.log(transform.forward(x)))(jnp.asarray(0.0)))
    assert slope == pytest.approx(1.0)


# parameters


def test_default_parameters_of_a_body_without_members() -> None:
    model = model_of(SHIP)
    assert set(default_free(model, ["roll"])) == {"added_mass.A44", "linear_damping.B44", "quadratic_damping.B44"}
    assert default_free(model, ["heave"]) == ()


def test_default_parameters_of_a_semi_submersible() -> None:
    model = model_of(semi() | {"stiffness": {"C11": 1e3}, "second_order_forces": "slender_body"})
    members = {f"{g}.{c}" for g in ("column", "pontoon") for c in ("Ca_t", "Ca_z", "Cd_t", "Cd_z")} & set(model.values)
    assert len(members) == 8
    assert set(default_free(model, ["surge", "heave", "pitch"])) == members | {
        f"linear_damping.{b}" for b in ("B11", "B33", "B55")
    }
    assert set(default_free(model, ["heave"])) == members | {"linear_damping.B33"}
    left_alone = {"mooring.line1.stiffness", "stiffness.C11", "slender_body_forces.share"}
    assert left_alone <= set(model.values)


def test_what_is_declared_as_zero_is_not_free_unless_asked_for() -> None:
    document = semi()
    document["coefficients"]["column"]["Cd_z"] = 0.0
    model = model_of(document)
    assert "column.Cd_z" not in match_free_labels(model, ["heave"])
    assert "column.Cd_z" in match_free_labels(model, ["heave"], free=["column.*"])


def test_patterns_say_what_is_free_and_what_is_fixed() -> None:
    model = model_of(semi())
    assert set(match_free_labels(model, ["surge"], free=["column.Cd_*", "linear_damping.B11"])) == {
        "column.Cd_t",
        "column.Cd_z",
        "linear_damping.B11",
    }
    assert "pontoon.Ca_t" not in match_free_labels(model, ["surge"], fixed=["pontoon.*"])
    assert match_free_labels(model, ["surge"], free=["mooring.line?.stiffness"]) == tuple(
        f"mooring.line{i}.stiffness" for i in (1, 2, 3)
    )


def test_bounds_and_priors_of_the_manifest() -> None:
    model = model_of(semi())
    labels = ("column.Ca_t", "pontoon.Cd_z", "linear_damping.B33")
    space = parameter_space(model, labels, {"column.Ca_t": (0.8, 2.0)}, {"pontoon.Cd_z": (4.0, 0.2)})
    free = {p.label: p for p in space.free}
    transform = free["column.Ca_t"].transform
    assert isinstance(transform, LogInterval) and (transform.lower, transform.upper) == (0.8, 2.0)
    prior = free["pontoon.Cd_z"]
    assert float(prior.transform.forward(jnp.asarray(prior.prior_mean))) == pytest.approx(4.0)
    x = np.array([0.0, prior.prior_mean, 0.0])
    assert prior.prior_deviation * slopes(space, x)[1] == pytest.approx(0.2, rel=0.01)
    assert math.isinf(free["column.Ca_t"].prior_deviation)
    values = space.values(space.start)
    assert {k: float(v) for k, v in values.items()} == pytest.approx({k: float(model.values[k]) for k in labels})


def test_mistakes_in_the_manifest_are_told() -> None:
    model = model_of(semi())
    for make, words in (
        (lambda: match_free_labels(model, ["surge"], free=["colum.Ca_t"]), "Did you mean 'column.Ca_t'?"),
        (lambda: match_free_labels(model, ["surge"], fixed=["rudder.*"]), "calibrate.fixed"),
        (lambda: parameter_space(model, ["column.Ca_t"], {"column.Ca_z": (0.1, 1.0)}), "calibrate.bounds.column.Ca_z"),
        (lambda: parameter_space(model, ["column.Ca_t"], {"column.Ca_t": (-1.0, 2.0)}), "two numbers between 0 and"),
        (lambda: parameter_space(model, ["column.Ca_t"], {"column.Ca_t": (2.0, 1.0)}), "[2, 1]"),
        (lambda: parameter_space(model, ["column.Ca_t"], priors={"colum.Ca_t": (1.0, 0.1)}), "Did you mean"),
    ):
        with pytest.raises(InputError) as caught:
            make()
        assert words in str(caught.value)


# residuals


@pytest.mark.slow
def test_normal_equations_are_those_of_the_plain_residuals(ship_campaign: Campaign) -> None:
    """Cost, gradient and Gauss-Newton matrix, and a damped step, against the Jacobian of all residuals in a window."""
    problem, records = posed(ship_campaign)
    data = problem.data
    unknowns = Unknowns(problem.space.start, first_guess(records, data))
    weight = jnp.asarray([[2.0], [5.0]])
    until = jnp.asarray([15.0, 30.0])
    shape = unknowns.own.shape
    p = len(unknowns.shared)
    ridge, mean = 0.1 + jnp.arange(p) / p, unknowns.shared - 0.3

    def plain(z):
        def of_record(inputs):
            own, record, until = inputs
            motion = problem.motion(z[:p], own, record)
            return (motion - record.measured) * record.present * (record.time <= until)

        r = jax.lax.map(of_record, (z[p:].reshape(shape), data, until))
        return jnp.concatenate([(jnp.sqrt(weight)[..., None] * r).ravel(), ridge * (z[:p] - mean)])

    z = jnp.concatenate([unknowns.shared, unknowns.own.ravel()])
    value_and_slope = jax.jit(jax.jacfwd(lambda z: (plain(z),) * 2, has_aux=True))
    slope, r = value_and_slope(z)
    fit = LeastSquares((problem.up_to(until),), (weight,), mean, ridge)
    equations, (products,) = jax.jit(normal_equations)(unknowns, fit)
    assert float(equations.f) == pytest.approx(0.5 * float(r @ r), rel=1e-9)
    assert cost_of((np.asarray(products),), (np.asarray(weight),)) == pytest.approx(float(r[:-p] @ r[:-p]), rel=1e-9)
    gradient, matrix = np.concatenate([equations.grad.shared, equations.grad.own.ravel()]), equations.hessian.as_matrix()
    scale = np.abs(slope.T @ slope).max()
    np.testing.assert_allclose(matrix, slope.T @ slope, atol=1e-9 * scale)
    np.testing.assert_allclose(gradient, slope.T @ r, atol=1e-9 * np.abs(slope.T @ r).max())
    step = equations.hessian.solve(equations.grad, 0.01 * scale)
    expected = np.linalg.solve(matrix + 0.01 * scale * np.eye(len(z)), gradient)
    np.testing.assert_allclose(np.concatenate([step.shared, step.own.ravel()]), expected, rtol=1e-8, atol=1e-12)
    h = 1e-5
    for i in range(len(z)):
        column = (value_and_slope(z.at[i].add(h))[1] - value_and_slope(z.at[i].add(-h))[1]) / (2 * h)
        np.testing.assert_allclose(column, slope[:, i], atol=1e-6 * np.abs(slope).max())


def test_the_dominant_period_and_the_first_guess(ship_campaign: Campaign) -> None:
    problem, records = posed(ship_campaign)
    period = jh.natural_modes(model_of(SHIP, SHIP_TRUE)).of("roll")
    for record in records:
        assert crossing_period(record) == pytest.approx(period, rel=0.02)
    own = np.asarray(first_guess(records, problem.data)).reshape(2, 3, 1)
    start = own[:, 0, 0] * np.asarray(problem.data.unit)[:, 0]
    np.testing.assert_allclose(np.degrees(start), [12.0, 6.0 + np.degrees(SHIP_OFFSET)], atol=0.3)
    assert not own[:, 2].any()


# identifiability


def test_memory_of_white_and_of_coloured_noise() -> None:
    random = np.random.default_rng(0)
    white = [correlated_samples(random.standard_normal(4000)) for _ in range(10)]
    assert np.mean(white) == pytest.approx(1.0, abs=0.15) and min(white) >= 1
    for rho in (0.5, 0.9):  # integrated autocorrelation (1 + rho) / (1 - rho)
        memories = []
        for _ in range(10):
            x, e = np.zeros(20000), random.standard_normal(20000)
            for i in range(1, len(x)):
                x[i] = rho * x[i - 1] + e[i]
            memories.append(correlated_samples(x))
        assert np.mean(memories) == pytest.approx((1 + rho) / (1 - rho), rel=0.15)
    assert correlated_samples(np.zeros(100)) == correlated_samples(np.ones(5)) == 1.0


def regression(random, n: int = 200):
    """Two records of one channel, two shared unknowns and one own each: slopes (2, n, 3), and noise that differs."""
    return random.standard_normal((2, n, 3)) * [1.0, 0.3, 2.0], np.array([[0.1], [0.4]])


def products_of(a, r):
    full = np.concatenate([a, r[..., None]], axis=-1)
    return np.einsum("rtk,rtl->rkl", full, full)[:, None]


def test_spread_is_the_covariance_of_a_linear_regression() -> None:
    a, sigma = regression(np.random.default_rng(1))
    products = products_of(a, np.zeros(a.shape[:2]))
    ridge = np.full(2, 1e-9)
    full = np.zeros((400, 4))
    full[:200, [0, 1, 2]], full[200:, [0, 1, 3]] = a
    noise = np.repeat(sigma[:, 0] ** 2, 200)
    # weighed by their noise: (A^T W A)^-1
    best = sandwich_covariance(products, 1 / sigma**2, sigma**2, np.ones((2, 1)), ridge, np.ones(2))
    np.testing.assert_allclose(best.covariance, np.linalg.inv(full.T @ (full / noise[:, None])), rtol=1e-8)
    # weighed otherwise: the sandwich, here with every fourth sample counting
    bread = np.linalg.inv(full.T @ full)
    inflated = sandwich_covariance(products, np.ones((2, 1)), sigma**2, np.full((2, 1), 4.0), ridge, np.ones(2))
    expected = 4 * bread @ (full.T @ (full * noise[:, None])) @ bread
    np.testing.assert_allclose(inflated.covariance, expected, rtol=1e-8)
    np.testing.assert_allclose(inflated.deviation(), np.sqrt(np.diag(expected)[:2]), rtol=1e-8)
    assert np.diag(inflated.correlation()) == pytest.approx([1.0, 1.0])


def test_what_no_record_touches_is_as_wide_as_its_prior() -> None:
    a, sigma = regression(np.random.default_rng(2))
    a[..., 1] = 0.0
    ridge, width = 1 / (np.array([1.5, 0.7]) * 20), np.array([1.5, 0.7])
    covariance = sandwich_covariance(
        products_of(a, np.zeros(a.shape[:2])), 1 / sigma**2, sigma**2, np.ones((2, 1)), ridge, width
    )
    assert covariance.deviation()[1] == pytest.approx(0.7, rel=1e-6)
    assert covariance.deviation()[0] < 0.01


# fits: the ship


@pytest.mark.slow
def test_the_truth_is_within_three_standard_deviations(ship) -> None:
    result, _ = ship
    assert result.converged and set(result.parameters) == set(SHIP_TRUE)
    for label, true in SHIP_TRUE.items():
        parameter = result.parameters[label]
        assert parameter.identifiable and parameter.standard_deviation is not None and not parameter.at_bound
        assert abs(parameter.value - true) < 3 * parameter.standard_deviation
        assert parameter.standard_deviation < 0.05 * true
        assert parameter.start == float(model_of(SHIP).values[label])
    for test in result.tests:
        assert test.main.rmse == pytest.approx(SHIP_NOISE, rel=0.15)
    assert result.objective("fit") == pytest.approx(sum(t.main.relative for t in result.tests if t.use == "fit"))


@pytest.mark.slow
def test_a_sensors_offset_is_found_and_taken_off(ship) -> None:
    tests = {test.id: test for test in ship[0].tests}
    # its standard error is some 1e-5 rad
    assert tests["roll-2"].main.offset == pytest.approx(SHIP_OFFSET, abs=5e-5)
    assert tests["roll-1"].main.offset == pytest.approx(0.0, abs=5e-5)
    main = tests["roll-2"].main
    assert main.measured[0] == pytest.approx(np.radians(6.0), abs=5 * SHIP_NOISE)


@pytest.mark.slow
def test_held_out_records_are_judged_with_the_fitted_coefficients(ship, ship_campaign: Campaign) -> None:
    result, _ = ship
    held = next(test for test in result.tests if test.id == "roll-3")
    assert held.use == "holdout" and result.objective("holdout") == pytest.approx(held.main.relative)
    assert held.main.rmse == pytest.approx(SHIP_NOISE, rel=0.15)
    for label, parameter in result.parameters.items():
        assert float(result.model.values[label]) == parameter.value
    # as if it were not there
    alone = dataclasses.replace(ship_campaign, records=ship_campaign.used("fit"))
    without = calibrate(alone)
    assert without.objective("holdout") is None
    for label, parameter in result.parameters.items():
        assert without.parameters[label].value == parameter.value


@pytest.mark.slow
def test_progress_is_reported_iteration_by_iteration(ship) -> None:
    result, reports = ship
    assert [p.iteration for p in reports] == list(range(1, result.iterations + 1))
    assert [p.objective for p in reports] == list(result.history)
    assert all(0 <= p.fraction <= 1 and p.stage for p in reports)
    assert reports[-1].objective == pytest.approx(result.objective("fit"), rel=1e-3)
    assert reports[-1].objective < 0.1 * reports[0].objective


@pytest.mark.slow
def test_interruption_gives_what_was_reached(ship_campaign: Campaign) -> None:
    def stop(p: Progress) -> None:
        if p.iteration == 7:
            raise KeyboardInterrupt

    with pytest.raises(Interrupted) as caught:
        calibrate(ship_campaign, progress=stop)
    partial = caught.value.partial
    assert partial is not None and not partial.converged and partial.iterations == 7
    assert set(partial.parameters) == set(SHIP_TRUE) and {t.id for t in partial.tests} == {"roll-1", "roll-2", "roll-3"}
    assert all(math.isfinite(p.value) for p in partial.parameters.values())


def test_interruption_before_the_first_iteration(ship_campaign: Campaign, monkeypatch: pytest.MonkeyPatch) -> None:
    def stop(_: Fit) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("calibration.fitting.decay_calibration.run_fit", stop)
    with pytest.raises(Interrupted) as caught:
        calibrate(ship_campaign)
    assert caught.value.partial is None


@pytest.mark.slow
def test_twenty_far_starts_all_arrive(ship_campaign: Campaign, ship) -> None:
    problem, records = posed(ship_campaign)
    random, objectives = np.random.default_rng(11), []
    inertia = 115.7 + 994.0 * 0.0324**2
    for _ in range(20):
        # natural period off by up to 25 % (no less than the body's own inertia allows), damping by up to a factor of 5
        ratio = random.uniform(0.95, 1.25)
        values = {
            "added_mass.A44": (inertia + SHIP_TRUE["added_mass.A44"]) * ratio**2 - inertia,
            "linear_damping.B44": SHIP_TRUE["linear_damping.B44"] * 5 ** random.uniform(-1, 1),
            "quadratic_damping.B44": SHIP_TRUE["quadratic_damping.B44"] * 5 ** random.uniform(-1, 1),
        }
        x = jnp.array([p.transform.inverse(values[p.label]) for p in problem.space.free])
        fit = fit_of_decays(problem, records, x)
        fit.mean = x
        run_fit(fit)
        objectives.append(fit.decays.objective())
    assert max(objectives) < 1.01 * min(objectives)
    assert min(objectives) == pytest.approx(ship[0].objective("fit"), rel=0.01)


@pytest.mark.slow
def test_a_model_that_is_too_stiff_arrives(tmp_path: Path) -> None:
    """The roll stiffness half too large: the period is 18 % too short, and the inertia cannot help."""
    time, roll = roll_decay(10.0)
    noisy = roll + SHIP_NOISE * np.random.default_rng(8).standard_normal(len(time))
    test = ({"kind": "decay", "degree_of_freedom": "roll", "use": "fit"}, time, {"roll": noisy})
    document = SHIP | {"hydrostatics": {"C44": 822.0 - 300.0}, "stiffness": {"C44": 300.0}}
    free = ["stiffness.C44", "linear_damping.B44"]
    document |= {"added_mass": {"A44": SHIP_TRUE["added_mass.A44"]}, "quadratic_damping": {"B44": 24.0}}
    campaign = load_campaign(write(tmp_path, document, {"roll": test}, calibrate={"free": free}))
    result = calibrate(campaign, start={"stiffness.C44": 700.0})
    assert result.parameters["stiffness.C44"].value == pytest.approx(300.0, rel=0.005)
    assert result.parameters["linear_damping.B44"].value == pytest.approx(1.8, rel=0.05)


# fits: a semi-submersible in heave, from an equilibrium that is not the reference position


def heave_tests() -> dict:
    """A zero test and a noisy heave decay; the sensor reads -1.3 m in still water."""
    random, model = np.random.default_rng(5), model_of(semi(), SEMI_TRUE)
    mean_heave = float(jh.equilibrium(model)[2])
    assert abs(mean_heave) > 0.1
    time = np.arange(0.0, 160.0, 0.5)
    heave = np.asarray(jh.free_decay(model, {"heave": 2.5}, time)["heave"]) - mean_heave

    def read(x):
        return x - 1.3 + SEMI_NOISE * random.standard_normal(len(x))

    return {
        "rest": ({"kind": "static", "use": "ignore"}, time, {"heave": read(np.zeros(len(time)))}),
        "heave": ({"kind": "decay", "degree_of_freedom": "heave", "use": "fit"}, time, {"heave": read(heave)}),
    }


@pytest.fixture(scope="module")
def heave(tmp_path_factory: pytest.TempPathFactory) -> tuple[Calibration, Calibration]:
    """The calibration at full scale, and of its twin that is stored at 1:70."""
    tests, folder = heave_tests(), tmp_path_factory.mktemp("heave")
    rules = {"zero": {"test": "rest"}, "calibrate": {"free": list(SEMI_TRUE)}}
    twins = [
        write(folder / str(scale), semi(), tests, scale, noise={"heave": SEMI_NOISE / scale}, **rules) for scale in (1.0, 70.0)
    ]
    return calibrate(load_campaign(twins[0])), calibrate(load_campaign(twins[1]))


@pytest.mark.slow
def test_a_zeroed_record_is_measured_from_the_equilibrium(heave) -> None:
    result, _ = heave
    test = result.tests[0]
    assert test.main.rmse == pytest.approx(SEMI_NOISE, rel=0.15)
    assert test.main.offset == pytest.approx(0.0, abs=3 * SEMI_NOISE)
    for label, true in SEMI_TRUE.items():
        parameter = result.parameters[label]
        if parameter.identifiable:
            assert abs(parameter.value - true) < 3 * parameter.standard_deviation
    assert result.parameters["pontoon.Ca_z"].value == pytest.approx(1.87, rel=0.01)


@pytest.mark.slow
def test_what_is_not_free_stays_exactly_as_it_was(heave) -> None:
    result, _ = heave
    declared = model_of(semi())
    assert set(result.parameters) == set(SEMI_TRUE)
    for label, value in declared.values.items():
        assert (float(result.model.values[label]) == float(value)) == (label not in SEMI_TRUE)


@pytest.mark.slow
def test_a_standard_deviation_is_given_where_identifiable(heave, ship) -> None:
    for result in (heave[0], ship[0]):
        for parameter in result.parameters.values():
            assert (parameter.standard_deviation is None) == (not parameter.identifiable)


@pytest.mark.slow
def test_froude_scaled_records_give_the_same_coefficients(heave) -> None:
    full, scaled = heave
    for label, parameter in full.parameters.items():
        scaled_parameter = scaled.parameters[label]
        assert scaled_parameter.value == pytest.approx(parameter.value, rel=1e-5)
        if parameter.identifiable:
            assert scaled_parameter.standard_deviation == pytest.approx(parameter.standard_deviation, rel=1e-3)
    assert scaled.objective("fit") == pytest.approx(full.objective("fit"), rel=1e-6)
    np.testing.assert_allclose(scaled.tests[0].time, full.tests[0].time, atol=1e-9)


# what one surge decay does not tell


@pytest.mark.slow
def test_one_surge_decay_knows_the_sum_of_two_added_masses_and_neither(tmp_path: Path) -> None:
    true = {"column.Ca_t": 1.50, "column.Cd_t": 2.09, "pontoon.Ca_t": 0.11, "pontoon.Cd_t": 1.84, "linear_damping.B11": 4.4e4}
    document = YAML(typ="safe").load((DEMO / "platform.yaml").read_text())
    model = model_of(document, true)
    time = np.arange(0.0, 540.0, 2.0)
    surge = np.asarray(jh.free_decay(model, {"surge": 8.0}, time)["surge"]) - float(jh.equilibrium(model)[0])
    noisy = surge + 0.01 * np.random.default_rng(4).standard_normal(len(time))
    test = ({"kind": "decay", "degree_of_freedom": "surge", "use": "fit"}, time, {"surge": noisy})
    rules = {"noise": {"surge": 0.01}, "calibrate": {"free": list(true)}}
    result = calibrate(load_campaign(write(tmp_path, document, {"surge": test}, **rules)))
    for label in ("column.Ca_t", "pontoon.Ca_t"):
        assert not result.parameters[label].identifiable
    assert any("do not determine" in note and "column.Ca_t" in note for note in result.notes)
    mass, fitted = (float(linearised(m, jnp.zeros(6))[0][0, 0]) for m in (model, result.model))
    assert fitted == pytest.approx(mass, rel=0.005)
    declared = float(linearised(model_of(document), jnp.zeros(6))[0][0, 0])
    assert abs(declared / mass - 1) > 0.02  # it had something to find


# what cannot be calibrated


def test_a_campaign_without_decays_is_told(tmp_path: Path) -> None:
    time = np.arange(0.0, 20.0, 0.1)
    tests = {"rest": ({"kind": "static", "use": "fit"}, time, {"roll": 1e-4 * np.sin(time)})}
    with pytest.raises(InputError) as caught:
        calibrate(load_campaign(write(tmp_path, SHIP, tests)))
    assert "at least one decay test marked `use: fit`" in str(caught.value)
    assert "static marked fit" in str(caught.value)


def test_nothing_free_is_told(ship_campaign: Campaign) -> None:
    with pytest.raises(InputError) as caught:
        calibrate(ship_campaign, free=[])
    assert "at least one free parameter" in str(caught.value)


# measured data


@pytest.mark.slow
@measured
def test_the_measured_roll_of_kvlcc2() -> None:
    result = calibrate(load_campaign(MEASURED / "kvlcc2"))
    assert result.converged and result.objective("fit") < 0.03
    assert result.parameters["added_mass.A44"].identifiable
    test = result.tests[0]
    period = float(np.median(decay_cycles(test.time, test.main.measured, test.main.noise).period))
    assert 2.53 < period < 2.55
    assert jh.natural_modes(result.model).of("roll") == pytest.approx(period, rel=0.005)


@pytest.mark.slow
@measured
def test_the_measured_surge_of_focal_campaign_4() -> None:
    result = calibrate(load_campaign(MEASURED / "focal-c4"))
    assert result.converged
    main = result.tests[0].main
    assert main.channel == "surge" and main.relative < 0.04
    assert jh.natural_modes(result.model).of("surge") == pytest.approx(81.5, rel=0.015)
    cycles = decay_cycles(result.tests[0].time, main.measured, main.noise)
    assert np.median(cycles.period) == pytest.approx(81.5, rel=0.015)


@pytest.mark.validate
def test_twenty_far_starts_of_the_platform_all_arrive() -> None:
    from benchmarks.evidence.starts import outcomes

    objectives = [outcome["objective"] for outcome in outcomes(20, processes=2)]
    assert len(objectives) == 20 and max(objectives) < 1.01 * min(objectives)


def test_coefficients_that_the_platform_file_states_as_0_are_named() -> None:
    """Only those of released motions; they are not fitted."""
    parts = {
        "linear_damping": {"B44": 0.0, "B33": 0.0},
        "quadratic_damping": {"B44": 5.0},
        "added_mass": {"A44": 0.0, "A24": 0.0},
    }
    platform = SimpleNamespace(**{name: SimpleNamespace(root=values) for name, values in parts.items()})
    released = [SimpleNamespace(degree_of_freedom="roll"), SimpleNamespace(degree_of_freedom=None)]
    campaign: Any = SimpleNamespace(platform=platform, used=lambda use: released)
    assert stated_zeros(campaign) == ["linear_damping.B44", "added_mass.A44"]
