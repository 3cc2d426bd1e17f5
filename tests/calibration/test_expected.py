"""What a residual is expected to be where a force is missing: a model's tangents, and the spectrum of a force that is known."""

import math
from dataclasses import replace
from types import SimpleNamespace

import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_water_effects import irregular

import jaxhydro as jh
from calibration.discovery.effect_fits import EffectFits
from calibration.discovery.eliminated_least_squares import deviances, row_weights
from calibration.discovery.expected_residuals import expected_over_floor, force_spectrum, impedance
from calibration.discovery.frequency_bands import FourierRows, cut_into_bands
from calibration.discovery.linearisations import MotionSeries, Prior
from calibration.discovery.residual_slopes import SeaRecord
from calibration.discovery.study import Study
from calibration.discovery.study_set_up import COEFFICIENT_PRIOR_WIDTH, DAMPING_PRIOR_WIDTH, StudySetup, prior_width_of
from calibration.parameters.space import VAGUE_DEVIATION, FreeParameter, ParameterSpace
from calibration.parameters.transforms import Scaled
from jaxhydro.waves.integration_clock import Clock

MASS, STIFFNESS, B11 = 8e6, 2e5, 3e5
AFLOAT = {
    "name": "two springs",
    "water": {"density": 1025.0, "depth": 200.0, "gravity": 9.81},
    "rigid_body": {"mass": MASS, "centre_of_mass": [0, 0, 0], "inertia": {"Ixx": 4e9, "Iyy": 5e9, "Izz": 6e9}},
    "members": [],
    "linear_damping": {"B11": B11, "B55": 1e8},
    "stiffness": {"C11": STIFFNESS, "C22": STIFFNESS, "C33": 8e4, "C44": 1e8, "C55": 1e8, "C66": 1e8},
    "mooring": {"kind": "none"},
}


@pytest.mark.slow
def test_the_impedance_of_springs() -> None:
    """Of a body in springs, per unit of mass: K/m - omega^2 + i omega B/m, and nothing of one motion in the other."""
    model = jh.build(jh.Platform.model_validate(AFLOAT))
    step, steps = 0.25, 40
    prepared = irregular().prepared(np.array([[-1.0, 0, 0], [1.0, 0, 0]]).T, None, Clock(0.0, step, steps, (0.0,)))
    record = SeaRecord(
        model,
        prepared,
        jnp.arange(10.0),
        jnp.asarray(step),
        jnp.zeros((1, 2, 10)),
        ParameterSpace(()),
        True,
        steps,
        steps,
        (0,),
        (0, 4),
        ("sea",),
        0.04,
    )
    frequency = np.array([0.0, 0.02, 0.1])
    omega = 2 * np.pi * frequency
    matrix = impedance(record, np.zeros(0), frequency)
    assert_allclose(matrix[:, 0, 0], STIFFNESS / MASS - omega**2 + 1j * omega * B11 / MASS, rtol=1e-9)
    assert_allclose(matrix[:, 1, 1], 1e8 / 5e9 - omega**2 + 1j * omega * 1e8 / 5e9, rtol=1e-9)
    assert_allclose(matrix[:, 0, 1], 0, atol=1e-12)


def coupled(frequency: np.ndarray) -> np.ndarray:
    """Of two coupled motions, lightly damped at 0.011 and 0.036 Hz."""
    omega = 2 * np.pi * frequency
    own = [w**2 - omega**2 + 0.1j * w * omega for w in (2 * np.pi * 0.011, 2 * np.pi * 0.036)]
    return np.stack([[own[0], 3e-3 + 0j * omega], [1e-3 + 0j * omega, own[1]]]).transpose(2, 0, 1)


def test_what_a_white_force_leaves() -> None:
    """Averaged over many records, squares are what was expected of each: at resonances, between them and at the floor."""
    frequency, floor = np.arange(1, 180) / 3600, np.full((2, 179), 2e-2)
    stiffness, pool = coupled(frequency), np.zeros(179, int)
    random, squares, expected = np.random.default_rng(0), 0.0, 0.0
    deviation = np.array([[4e-4], [1e-3]])
    for _ in range(300):
        force, noise = (random.normal(size=(2, 179, 2)) @ [1, 1j] for _ in "ab")
        lines = np.einsum("fij,jf->if", np.linalg.inv(stiffness), deviation * force) + floor * noise
        squares = squares + np.abs(lines) ** 2 / 2 / 300
        expected = expected + (expected_over_floor(lines, floor, pool, stiffness) * floor) ** 2 / 300
    assert expected.max() > 1e3 * expected.min()
    assert_allclose(expected / squares, 1, atol=0.35)
    assert_allclose(np.log(expected / squares).mean(axis=1), 0, atol=0.02)


def test_noise_alone_is_no_force() -> None:
    """Where all is floor, nothing is missing."""
    random, floor = np.random.default_rng(1), np.full((2, 179), 2e-2)
    lines = floor * (random.normal(size=(2, 179, 2)) @ [1, 1j])
    over_floor = expected_over_floor(lines, floor, np.zeros(179, int), coupled(np.arange(1, 180) / 3600))
    assert over_floor.max() < 1.8 and np.median(over_floor) < 1.1
    assert force_spectrum(np.zeros(9), np.ones(9), np.zeros(9, int)).max() == 0


@pytest.fixture
def study() -> Study:
    """One motion in a sea of an hour, slow to 0.05 Hz."""
    n = 3600
    cut = cut_into_bands(n, 1.0, n, 14, 0.2)
    series = MotionSeries(
        "sea", "irregular", "fit", "surge", 0.01, 1.0, 2 * cut.lines, cut.low, cut.high, n, np.full(14, 0.02), 0.05
    )
    space = SimpleNamespace(labels=(), start=jnp.zeros(0), free=())
    return Study(
        space,
        None,
        (),
        np.zeros((0, 0)),
        8,
        None,
        (),
        (series,),
        (),
        np.zeros((0, 0)),
        (FourierRows.of([cut], n, 0.1),),
        None,
    )  # type: ignore[arg-type]


def test_pools(study: Study) -> None:
    """Slow bands are one, the mean and every band among the waves are their own; degrees of freedom stay."""
    (pooled_series,) = study.series
    slow = (pooled_series.low > 0) & (pooled_series.high <= 0.05)
    assert slow.sum() > 5 and set(pooled_series.pool[slow]) == {1} and pooled_series.pool[0] == 0
    assert_allclose(pooled_series.pool[~slow], np.arange(14)[~slow])
    assert study.pooled[0, 1] == pytest.approx(pooled_series.dof[slow].sum()) and study.pooled.sum() == pytest.approx(
        study.dof.sum()
    )


def test_a_resonance_counts_as_what_it_is(study: Study) -> None:
    """Weighed by what is expected, levels of such a residual are 1, and a resonance damped away gains what its lines are worth,
    not the logarithm of what was there."""
    rows = study.row_series.size
    frequency = study.cuts[0].take / 3600
    beyond = np.repeat(1 + 300 / (1 + ((frequency - 0.011) / 0.001) ** 2), 2)
    residual = 0.02 * beyond * np.random.default_rng(2).normal(size=rows)
    informed = replace(study, expected=beyond)
    many = informed.pooled > 20
    assert_allclose(informed.levels(residual)[many] / informed.levels(0.02 * beyond)[many], 1, atol=0.3)
    damped = np.where(np.repeat(np.abs(frequency - 0.011) < 0.003, 2), residual / 10, residual)
    blind, seen = (float((deviances(s, residual, 0.0) - deviances(s, damped, 0.0)).sum()) for s in (study, informed))
    assert 0 < seen < 0.3 * blind
    # weights are the slopes of what is minimised
    step = 1e-6 * residual
    change = float((deviances(informed, residual + step, 0.2) - deviances(informed, residual, 0.2)).sum())
    assert change == pytest.approx(2 * float((row_weights(informed, residual) * residual * step).sum()), rel=1e-4)


def test_how_well_coefficients_are_known() -> None:
    """In waves about where decays have them, linear damping best; vaguely without waves, and where declared as none."""
    model = jh.build(jh.Platform.model_validate(AFLOAT | {"linear_damping": {"B11": B11, "B55": 1e-300}}))
    model = model.with_values({"linear_damping.B55": 0.0})
    assert prior_width_of("linear_damping.B11", model, True) == DAMPING_PRIOR_WIDTH < COEFFICIENT_PRIOR_WIDTH < VAGUE_DEVIATION
    assert (
        prior_width_of("linear_damping.B11", model, False)
        == prior_width_of("linear_damping.B55", model, True)
        == VAGUE_DEVIATION
    )


@pytest.mark.parametrize("seas", [(), ("a sea",)])
def test_coefficients_are_anchored_where_the_search_begins(seas: tuple[str, ...]) -> None:
    """In waves, and but for those whose priors the manifest states; effects and nuisances stay where they were."""
    names = ("linear_damping.B11", "column.Ca_t", "mass", "effect")
    free = [FreeParameter(name, 1.0, Scaled(0.0, 1.0), 0.3, 0.1 if name == "column.Ca_t" else math.inf) for name in names]
    study = SimpleNamespace(
        seas=seas,
        space=ParameterSpace(tuple(free)),
        index=lambda labels: [names.index(name) for name in labels],
        steps=lambda x: x,
    )
    prior = Prior(np.array([0.0, 0.3, 0.0, 0.0]), np.ones(4))
    fits = EffectFits.__new__(EffectFits)
    fits.study, fits.setup = study, StudySetup(study, (), None, names[:2], names[2:3], prior, (), {}, {})  # type: ignore[arg-type]
    fits.anchor(np.array([1.0, 2.0, 3.0, 4.0]))
    assert_allclose(fits.begun, [1.0, 2.0, 3.0, 4.0])
    assert_allclose(fits.setup.prior.mean, [1.0 if seas else 0.0, 0.3, 0.0, 0.0])
