"""Fits with slopes that are kept from step to step, against SciPy on the same cost."""

from types import SimpleNamespace

import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import minimize

from calibration.discovery.broyden_fit import MIN_RELATIVE_GAIN, broyden_update, fit
from calibration.discovery.eliminated_least_squares import cost_of, linear_residual, minus_two_log_likelihood, predict_gain
from calibration.discovery.frequency_bands import FourierRows, cut_into_bands
from calibration.discovery.linearisations import Linearisation, MotionSeries, Point, Prior
from calibration.discovery.study import Study

SAMPLES, NOISE = 201, 0.05
TIME = np.linspace(0.0, 20.0, SAMPLES)


class Oscillations(Study):
    """Three records, the last held out: x = a exp(-z t) cos(w t) + offset, w and z shared, a and offset each record's own."""

    def values(self, point: Point) -> np.ndarray:
        rate, decay = point.x
        return np.stack([a * np.exp(-decay * TIME) * np.cos(rate * TIME) + offset for a, offset in point.own])

    def residual(self, point: Point, seas="fit") -> np.ndarray:
        return self.cuts[0](self.values(point) - self.measured)

    def linearise(self, point: Point, active) -> Linearisation:
        self.linearisations.append(point)
        steps = 1e-6 * np.eye(4)

        def slope(x, own):
            ahead, behind = (self.residual(Point(point.x + s * x, point.own + s * own)) for s in (1, -1))
            return (ahead - behind) / 2e-6

        slopes = np.stack([slope(one_step[:2], 0) for one_step in steps[:2]], axis=1)[:, list(active)]
        own = np.stack([slope(0, one_step[2:]) for one_step in steps[2:]], axis=1)
        return Linearisation(point, tuple(active), self.residual(point), slopes, own)


@pytest.fixture
def study():
    cut = cut_into_bands(TIME[-1] + 0.1, 0.1, SAMPLES, 12, 6.0)
    noise = np.random.default_rng(1).normal(0, NOISE, (3, SAMPLES))
    uses = ("fit", "fit", "holdout")
    series = tuple(
        MotionSeries(f"r{i}", "decay", use, "surge", NOISE, 1.0, 2 * cut.lines, cut.low, cut.high, SAMPLES, np.full(12, NOISE))
        for i, use in enumerate(uses)
    )
    free = tuple(SimpleNamespace(label=name, transform=None) for name in ("rate", "decay"))
    space = SimpleNamespace(labels=("rate", "decay"), start=jnp.array([1.0, 0.1]), free=free)
    oscillations = Oscillations(
        space,
        None,
        ("rate", "decay"),
        np.eye(2),
        8,
        SimpleNamespace(data=SimpleNamespace(dofs=(0,))),
        (),
        series,
        tuple(SimpleNamespace(use=use) for use in uses),
        np.full((3, 2), np.inf),
        (FourierRows.of([cut] * 3, SAMPLES),),
        None,
    )
    truth = Point(np.array([1.3, 0.06]), np.array([[1.0, 0.1], [2.0, -0.2], [0.5, 0.0]]))
    object.__setattr__(oscillations, "linearisations", [])
    object.__setattr__(oscillations, "measured", oscillations.values(truth) + noise)
    return oscillations


PRIOR = Prior(np.zeros(2), np.full(2, 10.0))


def best(study: Study, begin: Point) -> np.ndarray:
    """By SciPy, of the fitted records."""
    linearisation = study.linearise(begin, (0, 1))

    def cost(z):
        point = Point(z[:2], np.vstack([z[2:].reshape(2, 2), begin.own[2:]]))
        return cost_of(study, linearisation, study.residual(point), point, study.used, PRIOR)

    start = np.concatenate([begin.x, begin.own[:2].ravel()])
    return minimize(cost, start, method="Nelder-Mead", options={"xatol": 1e-8, "fatol": 1e-10, "maxiter": 8000}).x


@pytest.mark.parametrize(("linearisations", "close"), [(0, 0.01), (3, 2e-4)], ids=["slopes of the start", "slopes anew"])
def test_a_fit_ends_where_scipy_does(study, linearisations, close):
    """From slopes far from the end's: nearly so with these alone, mended; exactly with slopes taken anew. The held-out record's
    own unknowns stay."""
    begin = Point(np.array([1.25, 0.1]), np.array([[0.9, 0.0], [1.8, 0.0], [0.4, 0.0]]))
    expected = best(study, begin)
    study.linearisations.clear()
    reached = fit(
        study, study.linearise(begin, (0, 1)), study.used, PRIOR, iterations=60, relinearisations=linearisations, tolerance=1e-6
    )
    assert reached.settled
    assert len(study.linearisations) <= 1 + linearisations + 1
    assert_allclose(reached.linearisation.point.x, expected[:2], atol=close)
    assert_allclose(reached.linearisation.point.own[:2].ravel(), expected[2:], atol=10 * close)
    assert_allclose(reached.linearisation.point.own[2], begin.own[2])


def test_a_fit_stays_where_its_parameters_make_sense(study):
    """What would leave is at the end of its range, and all others where SciPy has them with it there."""
    begin = Point(np.array([1.25, 0.1]), np.array([[0.9, 0.0], [1.8, 0.0], [0.4, 0.0]]))
    study.__dict__["limits"] = np.array([[-np.inf, np.inf], [-0.02, np.inf]])
    linearisation = study.linearise(begin, (0, 1))

    def cost(z):
        point = Point(np.array([z[0], 0.08]), np.vstack([z[1:].reshape(2, 2), begin.own[2:]]))
        return cost_of(study, linearisation, study.residual(point), point, study.used, PRIOR)

    options = {"xatol": 1e-8, "fatol": 1e-10, "maxiter": 8000}
    expected = minimize(cost, [1.25, *begin.own[:2].ravel()], method="Nelder-Mead", options=options).x
    reached = fit(study, linearisation, study.used, PRIOR, iterations=60, relinearisations=3, tolerance=1e-6)
    assert_allclose(reached.linearisation.point.x, [expected[0], 0.08], atol=2e-4)
    assert_allclose(reached.linearisation.point.own[:2].ravel(), expected[1:], atol=2e-3)


def test_held_out_records_are_fitted_with_parameters_as_they_are(study):
    """No directions: only the own unknowns of what is asked for move."""
    begin = Point(np.array([1.3, 0.06]), np.array([[1.0, 0.1], [2.0, -0.2], [0.1, 0.3]]))
    reached = fit(study, study.linearise(begin, ()), ~study.used, PRIOR, iterations=10, tolerance=1e-6)
    assert_allclose(reached.linearisation.point.own[2], [0.5, 0.0], atol=0.02)
    assert_allclose(reached.linearisation.point.own[:2], begin.own[:2])
    assert_allclose(reached.linearisation.point.x, begin.x)


def test_mended_slopes_give_the_step_that_was_taken(study):
    """The secant equation, record by record."""
    begin = Point(np.array([1.25, 0.1]), np.array([[0.9, 0.0], [1.8, 0.0], [0.4, 0.0]]))
    linearisation = study.linearise(begin, (0, 1))
    step, own = np.array([0.03, -0.02]), np.array([[0.1, 0.05], [0.2, -0.1], [0.0, 0.0]])
    moved = begin.moved(study.directions, step, own)
    residual = study.residual(moved)
    after = broyden_update(study, linearisation, moved, residual, step, own)
    assert_allclose(linear_residual(study, after, -step, -own), linearisation.residual, atol=1e-10)


def test_a_prediction_is_exact_where_the_model_is_linear(study):
    """Along the own unknowns alone the model is linear: what is predicted is what a fit gains, held-out tests too."""
    begin = Point(np.array([1.3, 0.06]), np.array([[0.9, 0.0], [1.8, 0.0], [0.4, 0.1]]))
    linearisation = study.linearise(begin, ())
    predicted = predict_gain(study, linearisation, PRIOR)
    for used, gain in ((study.used, predicted.fitted), (~study.used, predicted.held)):
        reached = fit(study, linearisation, used, PRIOR, iterations=20, tolerance=1e-9)
        now = minus_two_log_likelihood(study, linearisation.residual) - minus_two_log_likelihood(
            study, reached.linearisation.residual
        )
        assert now[used].sum() > 10
        assert_allclose(gain, now[used].sum(), rtol=0.01)


@pytest.mark.parametrize("far", [1.0, 1e2, 1e4, 1e6])
def test_a_fit_is_converged_to_the_tolerance_of_where_it_ends(study, far):
    """However large what is minimised was at first: releases may begin far off. The least is SciPy's, from near the truth."""
    begin = Point(np.array([1.25, 0.1]), far * np.array([[0.9, 0.3], [-1.8, 0.3], [0.4, 0.0]]))
    costs = []
    reached = fit(
        study,
        study.linearise(begin, (0, 1)),
        study.used,
        PRIOR,
        iterations=200,
        relinearisations=20,
        tolerance=1e-6,
        report=lambda _, cost: costs.append(cost),
    )
    near = Point(np.array([1.3, 0.06]), np.array([[1.0, 0.1], [2.0, -0.2], [0.5, 0.0]]))
    expected = best(study, near)
    z = np.concatenate([reached.linearisation.point.x, reached.linearisation.point.own[:2].ravel()])
    point = Point(expected[:2], np.vstack([expected[2:].reshape(2, 2), begin.own[2:]]))
    least = cost_of(study, reached.linearisation, study.residual(point), point, study.used, PRIOR)
    assert reached.settled and costs[-1] - least < 2 * MIN_RELATIVE_GAIN * abs(least)
    assert_allclose(z, expected, atol=2e-3)
