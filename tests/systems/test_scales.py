"""Froude's similarity: a hull and its model at 1:100 have the same numbers, in statics and in motion."""

import copy
import math
from functools import cache
from types import SimpleNamespace

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import one_program

import jaxhydro as jh
from calibration import calibrate
from calibration.campaign.manifest import Manifest
from calibration.campaign.records import load_records
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.statics import EquilibriumError, equilibrium, natural_modes
from jaxhydro.input_schema import validate
from jaxhydro.loads import Hysteresis
from jaxhydro.platform.build import build as built
from jaxhydro.platform.schema import Platform
from jaxhydro.scales import covered, entered
from jaxhydro.waves.irregular import spectrum_components
from jaxhydro.waves.spectra import jonswap
from jaxhydro.waves.supports import Box

RHO, G = 1000.0, 9.81
SMALL = 0.01
SHARE = np.array([1.0, 1, 1, 0, 0, 0])  # of the powers of the length that displacements have and rotations have not


@cache
def barge_platform(size: float) -> Platform:
    """A tapered barge with a bilge column, moored by springs: lengths times `size`."""
    n, point = size**3, lambda *x: [size * coordinate for coordinate in x]
    data = {
        "name": f"barge {size:g}",
        "water": {"density": RHO, "depth": 60.0 * size, "gravity": G},
        "rigid_body": {
            "mass": 5.57e6 * n,
            "centre_of_mass": point(0.0, 0.0, -3.0),
            "inertia": {"Ixx": 7e8 * size**5, "Iyy": 9e8 * size**5, "Izz": 1.2e9 * size**5},
        },
        "members": [
            {
                "name": "box",
                "group": "hull",
                "shape": "rect",
                "d": point(20.0, 25.0),
                "rA": point(0, 0, -8.0),
                "rB": point(0, 0, 4.0),
            },
            {
                "name": "skeg",
                "group": "hull",
                "shape": "circ",
                "stations": [0, 1],
                "d": point(14.0, 8.0),
                "rA": point(0, 0, -20.0),
                "rB": point(0, 0, -8.0),
            },
            {"name": "beam", "shape": "rect", "d": point(3.0, 2.0), "rA": point(-10, 0, -12.0), "rB": point(10, 0, -12.0)},
        ],
        "coefficients": {"hull": {"Ca_t": 0.8, "Ca_z": 0.5, "Cd_t": 1.0, "Cd_z": 1.2}, "beam": {"Ca_t": 1.0, "Cd_z": 2.0}},
        "linear_damping": {"B11": 1e5 * size**2.5, "B55": 1e8 * size**4.5},
        "mooring": {
            "kind": "linear_springs",
            "lines": [
                {
                    "anchor": point(120 * math.cos(a), 120 * math.sin(a), -60.0),
                    "fairlead": point(10 * math.cos(a), 10 * math.sin(a), -6.0),
                    "stiffness": 4e4 * size**2,
                    "pretension": 2e5 * n,
                }
                for a in (0.3, 0.3 + 2 * math.pi / 3, 0.3 + 4 * math.pi / 3)
            ],
        },
    }
    return validate(Platform, copy.deepcopy(data), data["name"])


def barge(size: float) -> Model:
    """The model of `barge_platform`."""
    return built(barge_platform(size))


@eqx.filter_jit
def stiffness_of(model: Model) -> jax.Array:
    return -jax.jacfwd(model.force_at_rest)(jnp.zeros(6))


def same(small: np.ndarray, large: np.ndarray, power: float | np.ndarray = 0.0) -> None:
    """To 1e-6 of the largest of its kind, in motions and rotations apart."""
    scaled = np.asarray(small) / SMALL**power
    for part in (slice(0, 3), slice(3, 6)):
        largest = np.abs(np.asarray(large)[..., part]).max()
        assert_allclose(scaled[..., part], np.asarray(large)[..., part], atol=1e-6 * max(largest, 1e-6), rtol=0)


@pytest.mark.slow
def test_statics_and_modes() -> None:
    small, large = barge(SMALL), barge(1.0)
    same(equilibrium(small), equilibrium(large), SHARE)
    stiff = [np.asarray(stiffness_of(model)) for model in (small, large)]
    power = 2 + (1 - SHARE)[:, None] + (1 - SHARE)[None]
    assert np.abs(stiff[0] / SMALL**power - stiff[1]).max() < 1e-6 * np.abs(stiff[1]).max()
    assert_allclose(np.diag(stiff[0] / SMALL**power)[:5], np.diag(stiff[1])[:5], rtol=1e-6)
    first, second = natural_modes(small), natural_modes(large)
    assert_allclose(first.period / SMALL**0.5, second.period, rtol=1e-6)
    assert_allclose(np.abs(first.shape), np.abs(second.shape), atol=1e-5)
    assert [first.of(dof) / SMALL**0.5 for dof in ("surge", "heave", "pitch")] == pytest.approx(
        [second.of(dof) for dof in ("surge", "heave", "pitch")], rel=1e-6, nan_ok=True
    )


def moved(model: Model, size: float, sea=None, **start: float) -> np.ndarray:
    times = np.arange(0.0, 150.0, 0.5) * size**0.5
    position = {dof: x * (size if dof in ("surge", "heave") else 1.0) for dof, x in start.items()}
    return np.asarray(jh.simulate(model, times, sea, position=position).position)


@pytest.mark.slow
def test_a_decay_and_a_regular_wave() -> None:
    responses = {}
    for size in (SMALL, 1.0):
        model = barge(size)
        sea = jh.regular_wave(3.0 * size, 9.0 * size**0.5, model.environment, heading=0.4, ramp=20.0 * size**0.5)
        responses[size] = (moved(model, size, surge=4.0, heave=1.0, pitch=0.05), moved(model, size, sea))
    for small, large in zip(responses[SMALL], responses[1.0]):
        same(small, large, SHARE)


@pytest.mark.slow
@pytest.mark.parametrize("order", [1, 2])
def test_an_irregular_sea(order: int) -> None:
    """The steps and the box that it is prepared for follow the hull."""
    responses = {}
    for size in (SMALL, 1.0):
        model, pace = barge(size), size**0.5
        waves = spectrum_components(
            lambda omega, s=size, p=pace: jonswap(omega, 2.0 * s, 9.0 * p, 2.0),
            300.0 * pace,
            model.environment,
            low=0.05 / pace,
            cutoff=0.22 / pace,
            seed=3,
        )
        responses[size] = moved(model, size, jh.IrregularSea(waves, model.environment, order))
    same(responses[SMALL], responses[1.0], SHARE)


def test_boxes_of_seas_are_of_one_shape() -> None:
    points = np.array([[-20.0, 25.0], [3.0, 4.0], [-21.0, 15.0]])
    for excursion in (20.0, 34.3):
        (middle, large), (small_middle, small) = (
            Box.of(size * points, 0.3, 200.0 * size, excursion * size) for size in (1.0, SMALL)
        )
        assert small_middle / SMALL == pytest.approx(middle, rel=1e-12)
        assert [x / SMALL for x in small] == pytest.approx(list(large), rel=1e-12)


def test_bounds_of_lengths_and_times_follow_the_hull() -> None:
    large, small = (
        model.with_effect(Hysteresis.neutral(["surge", "pitch"])).about("hysteresis.surge.yield_displacement")
        for model in (barge(1.0), barge(SMALL))
    )
    assert small.upper == pytest.approx(max(large.upper * SMALL, small.neutral))
    assert small.lower == pytest.approx(large.lower * SMALL)


def box(size: float, top: float, bottom: float = -4.0) -> Model:
    """100 x 30 m from `bottom` to `top`, afloat at that draught."""
    draught = -bottom
    data = {
        "name": "box",
        "water": {"density": RHO, "depth": 100 * size, "gravity": G},
        "rigid_body": {
            "mass": RHO * 100 * 30 * draught * size**3,
            "centre_of_mass": [0, 0, -0.5 * draught * size],
            "inertia": {"Ixx": 1e9 * size**5, "Iyy": 1e10 * size**5, "Izz": 1e10 * size**5},
        },
        "members": [
            {
                "name": "box",
                "shape": "rect",
                "d": [100 * size, 30 * size],
                "rA": [0, 0, bottom * size],
                "rB": [0, 0, top * size],
            }
        ],
        "coefficients": {"box": {}},
        "mooring": {"kind": "none"},
    }
    return built(validate(Platform, data, "box"))


@pytest.mark.slow
@pytest.mark.parametrize("top", [0.0, 0.05, 0.3])
@pytest.mark.parametrize("size", [1.0, SMALL])
def test_a_barge_that_ends_at_still_water(size: float, top: float) -> None:
    """It has the stiffness of its whole section, and rests where it is."""
    model = box(size, top)
    assert abs(float(equilibrium(model)[2])) < 1e-9 * size
    stiffness = np.asarray(stiffness_of(model))
    weight, area = RHO * G, 100 * 30 * size**2
    assert stiffness[2, 2] == pytest.approx(weight * area, rel=1e-9)
    second, volume, mass = np.array([100 * 30**3, 30 * 100**3]) / 12 * size**4, area * 4 * size, area * 4 * size
    expected = weight * second + weight * volume * -2 * size - weight * mass * -2 * size
    assert stiffness[[3, 4], [3, 4]] == pytest.approx(expected, rel=1e-6)
    assert natural_modes(model).of("heave") == pytest.approx(2 * math.pi * math.sqrt(4 * size / G), rel=1e-9)


def test_a_model_that_sinks_says_so() -> None:
    heavy = eqx.tree_at(lambda m: (m.body.mass, m.loads[0].mass), box(SMALL, 1.0), (jnp.asarray(50.0), jnp.asarray(50.0)))
    with pytest.raises(EquilibriumError):
        equilibrium(heavy)


def test_what_has_entered() -> None:
    """Nothing at the surface and above, the depth below, one smooth curve between; its slope is at most 1.6."""
    depth = np.linspace(-1.0, 2.0, 3001)
    value = np.asarray(one_program(entered)(depth, 0.5))
    slope = np.asarray(one_program(jax.vmap(jax.grad(lambda x: entered(x, 0.5))))(depth))
    assert (value[depth <= 0] == 0).all()
    assert_allclose(value[depth > 0.5], depth[depth > 0.5], rtol=1e-12)
    assert_allclose(np.gradient(value, depth), slope, atol=0.02)
    assert slope.min() >= 0 and slope.max() < 1.6
    share = one_program(covered)
    assert float(share(0.0, 0.5)) == 0 and float(share(0.6, 0.5)) == 1


@pytest.mark.slow
def test_a_calibration(tmp_path) -> None:
    """Coefficients fitted to a decay, begun from wrong ones: the same numbers, and damping by its power of the length."""
    estimates = []
    for size in (1.0, SMALL):
        model, folder = barge(size), tmp_path / f"{size:g}"
        folder.mkdir()
        period = natural_modes(model).of("heave")
        times = np.linspace(0.0, 8 * period, 500)
        heave = np.asarray(jh.free_decay(model, {"heave": 1.5 * size}, times, step=period / 60)["heave"])
        lines = (f"{t:.15g},{z:.15g}" for t, z in zip(times, heave))
        (folder / "heave.csv").write_text("\n".join(["t,heave", *lines]) + "\n")
        manifest = {
            "name": "barge",
            "platform": "volturnus-s",
            "noise": {"heave": 1e-4 * size},
            "channels": {"time": {"column": "t", "unit": "s"}, "heave": {"column": "heave", "unit": "m"}},
            "tests": [{"id": "heave", "kind": "decay", "degree_of_freedom": "heave", "file": "heave.csv"}],
        }
        records = load_records(Manifest.model_validate(manifest), folder)
        declared = model.with_values({"hull.Ca_z": 0.8, "hull.Cd_z": 2.0})
        campaign = SimpleNamespace(
            manifest=Manifest.model_validate(manifest),
            folder=folder,
            records=records,
            findings=(),
            model=declared,
            platform=barge_platform(size),
            used=lambda use, records=records: [r for r in records if r.use == use],
        )
        result = calibrate(campaign, free=["hull.Ca_z", "hull.Cd_z"])
        assert result.converged
        estimates.append(
            {label: (estimate.value, estimate.standard_deviation) for label, estimate in result.parameters.items()}
        )
    large, small = estimates
    assert large["hull.Ca_z"][0] == pytest.approx(0.5, rel=1e-3) and large["hull.Cd_z"][0] == pytest.approx(1.2, rel=1e-2)
    for label in large:
        assert small[label] == pytest.approx(large[label], rel=1e-6)
