"""Catenary lines against MoorPy, closed forms, finite differences and published moorings."""

import copy
import dataclasses
import json
import math
from functools import cache
from pathlib import Path
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import one_program
from ruamel.yaml import YAML

import jaxhydro as jh
from jaxhydro.dynamics.static_forces import mooring_stiffness
from jaxhydro.errors import InputError
from jaxhydro.input_schema import validate
from jaxhydro.loads import CatenaryLines
from jaxhydro.loads.catenary.catenary_profile import Segments, reach
from jaxhydro.loads.catenary.catenary_tension import end_tension
from jaxhydro.platform.build import build
from jaxhydro.platform.schema import builtin_text
from jaxhydro.quick_jit import on_device

MOORPY = json.loads((Path(__file__).parents[1] / "data" / "catenary-moorpy.json").read_text())
CHAIN = {"axial_stiffness": 3.27e9, "mass_per_length": 685.0, "diameter": 0.333}
VOLTURNUS: dict[str, Any] = {  # NREL/TP-5000-76773, table 8
    "kind": "catenary",
    "line_types": {"chain": CHAIN},
    "lines": [
        {
            "anchor": [-837.6, 0.0, -200.0],
            "fairlead": [-58.0, 0.0, -14.0],
            "segments": [{"type": "chain", "length": 850.0}],
            "heading": [0, 120, 240],
        }
    ],
}


def platform(mooring: dict[str, Any], name: str = "volturnus-s") -> jh.Model:
    data = YAML(typ="safe", pure=True).load(builtin_text(name))
    return build(validate(jh.Platform, data | {"mooring": mooring}, name))


@cache
def volturnus() -> jh.Model:
    return platform(VOLTURNUS)


def lines_of(model: jh.Model) -> CatenaryLines:
    return next(load for load in model.loads if isinstance(load, CatenaryLines))


def moored(model: jh.Model) -> jh.Model:
    """The model with its lines alone."""
    return dataclasses.replace(model, loads=(lines_of(model),))


def segments(*rows, friction=0.0, grounded=True) -> Segments:
    """One line: lengths, weights and stiffnesses from the fairlead down."""
    length, weight, stiffness = (jnp.asarray(row, float)[:, None] for row in zip(*rows))
    return Segments(length, weight, stiffness, jnp.array([friction]), jnp.array([grounded]))


@eqx.filter_jit
def solved(x, z, parts: Segments) -> jax.Array:
    return jnp.stack(end_tension(jnp.asarray(x), jnp.asarray(z), parts))


@eqx.filter_jit
def slopes(x, z, parts: Segments) -> jax.Array:
    """Change of horizontal and vertical tension (rows) with the distances (columns)."""
    unit, zero = jnp.ones_like(x), jnp.zeros_like(x)
    force = lambda a, b: jnp.stack(end_tension(a, b, parts))  # noqa: E731
    return jnp.stack([jax.jvp(force, (x, z), along)[1] for along in ((unit, zero), (zero, unit))], axis=1)


@cache
def with_moorpy() -> tuple[np.ndarray, np.ndarray]:
    """Tension and stiffness of all of MoorPy's single lines, solved together."""
    case = np.array([row["case"] for row in MOORPY["lines"].values()], float)
    length, stiffness, weight = (jnp.asarray(case[None, :, k]) for k in (2, 3, 4))
    parts = Segments(length, weight, stiffness, jnp.asarray(case[:, 5]), jnp.asarray(case[:, 6] > 0))
    x, z = jnp.asarray(case[:, 0]), jnp.asarray(case[:, 1])
    return np.asarray(solved(x, z, parts)), np.asarray(slopes(x, z, parts))


@pytest.mark.parametrize("name", MOORPY["lines"])
def test_tension_and_stiffness_are_those_of_moorpy(name: str) -> None:
    """MoorPy's stiffness is by differences of its tension, to about 1e-7."""
    i, row = list(MOORPY["lines"]).index(name), MOORPY["lines"][name]
    tension, stiffness = with_moorpy()
    assert_allclose(tension[:, i], row["tension"], rtol=1e-9, atol=1e-6)
    assert_allclose(stiffness[:, :, i], row["stiffness"], atol=1e-6 * np.abs(row["stiffness"]).max())


@pytest.mark.parametrize("name", MOORPY["chains"])
def test_lines_of_several_types_are_those_of_moorpy(name: str) -> None:
    row = MOORPY["chains"][name]
    x, z, parts = row["case"]
    rows = [(length, weight, stiffness) for length, stiffness, weight in reversed(parts)]
    actual = solved(jnp.array([x]), jnp.array([z]), segments(*rows))
    assert_allclose(actual[:, 0], row["tension"], rtol=1e-6)


def test_segments_of_one_type_are_one_segment() -> None:
    whole, parts = (
        solved(jnp.array([779.6]), jnp.array([186.0]), segments(*rows, friction=0.7))
        for rows in ([(850.0, 5800.0, 3e9)], [(250.0, 5800.0, 3e9), (400.0, 5800.0, 3e9), (200.0, 5800.0, 3e9)])
    )
    assert_allclose(whole, parts, rtol=1e-12)


def test_random_lines_are_in_balance() -> None:
    """What was found reaches the distance, taut to deep, on the seabed or not."""
    rng = np.random.default_rng(5)
    n = 3000
    z = rng.uniform(5.0, 400.0, n)
    x = z * 10 ** rng.uniform(-0.5, 1.0, n)
    length = np.hypot(x, z) * rng.uniform(0.97, 1.4, n)
    weight = 10 ** rng.uniform(1.5, 4, n)
    stiffness = weight * length * 10 ** rng.uniform(1, 4, n)
    grounded, friction = rng.random(n) < 0.7, rng.uniform(0, 1, n)
    parts = jax.tree.map(on_device, Segments(length[None], weight[None], stiffness[None], friction, grounded))
    horizontal, vertical = np.asarray(solved(x, z, parts))
    tight = np.asarray(horizontal) > 0
    assert 0.5 < tight.mean() < 1
    actual = np.stack(one_program(reach)(np.where(tight, horizontal, 1.0), vertical, parts))
    assert_allclose(actual[:, tight], np.stack([x, z])[:, tight], rtol=1e-9)


def test_without_weight_it_is_the_straight_spring() -> None:
    """EA (D / l0 - 1) along the chord."""
    x, z, stiffness, length = 800.0, 600.0, 2e8, 990.0
    actual = solved(jnp.array([x]), jnp.array([z]), segments((length, 1e-9, stiffness), grounded=False))
    assert_allclose(actual[:, 0], stiffness * (1000 / length - 1) * np.array([0.8, 0.6]), rtol=1e-9)


def test_an_inextensible_line_on_the_seabed() -> None:
    """With catenary parameter a = H / w: s = sqrt(z² + 2 z a), x = l - s + a asinh(s / a), V = w s (Faltinsen 1990, 8.20)."""
    a, z, length, weight = 300.0, 150.0, 900.0, 1000.0
    hanging = math.sqrt(z**2 + 2 * z * a)
    x = length - hanging + a * math.asinh(hanging / a)
    actual = solved(jnp.array([x]), jnp.array([z]), segments((length, weight, 1e18)))
    assert_allclose(actual[:, 0], [a * weight, weight * hanging], rtol=1e-9)


@pytest.mark.slow
def test_force_and_stiffness_are_continuous() -> None:
    """Where a line gets slack, lifts off the seabed, and where friction holds the anchor's tension at zero."""
    parts = segments((850.0, 5800.0, 3e9), friction=0.3)
    many = jax.tree.map(lambda part: on_device(np.repeat(part, 4001, axis=-1)), parts)
    x = np.linspace(640.0, 860.0, 4001)
    z = np.full_like(x, 186.0)
    tension, stiffness = np.asarray(solved(x, z, many))[0], np.asarray(slopes(x, z, many))[0, 0]
    assert float(tension[0]) == 0.0 and float(tension[-1]) > 1e6
    assert np.isfinite(stiffness).all() and (stiffness >= 0).all()
    # the trapezoidal rule over the stiffness gives back the tension: no jump is hidden between the points
    area = np.cumsum(0.5 * (stiffness[1:] + stiffness[:-1])) * (x[1] - x[0])
    assert_allclose(area, tension[1:] - tension[0], rtol=2e-3, atol=2e3)


@pytest.mark.slow
def test_volturnus_s_as_published() -> None:
    """Pretension 2437 kN (NREL/TP-5000-76773), the pull that balances the platform, stiffness of the WAMIT data to 0.5 %."""
    model = volturnus()
    tension, _ = one_program(CatenaryLines.tension)(lines_of(model), np.zeros(6), np.eye(3))
    assert_allclose(tension, 2437e3, rtol=2e-3)
    alone = moored(model)
    force = np.asarray(jax.jit(lambda q: alone.force_at_rest(q))(jnp.zeros(6)))
    assert force[2] == pytest.approx(-6061.98e3, rel=4e-3) and np.abs(np.delete(force, 2)).max() < 1e-3
    actual = np.asarray(mooring_stiffness(model, jnp.zeros(6)))
    published = {(0, 0): 7.19e4, (2, 2): 6.07e4, (3, 3): 2.586e8, (4, 4): 2.586e8, (5, 5): 2.524e8, (0, 4): 1.144e6}
    for (i, j), value in published.items():
        assert actual[i, j] == pytest.approx(value, rel=5e-3)


PARAMETERS = {
    "mooring.chain.axial_stiffness": 1e-3,
    "mooring.chain.submerged_weight": 1e-5,
    "mooring.line1.unstretched_length": 1e-6,
    "mooring.line2.anchor_shift": 1e-3,
    "mooring.seabed_friction": 1e-3,
}


@pytest.mark.slow
def test_gradients_of_the_force() -> None:
    """Forward = reverse = central differences, by every kind of parameter."""
    model = moored(volturnus()).with_values({"mooring.seabed_friction": 0.4})
    values = {label: model.values[label] for label in PARAMETERS}
    at, weights = jnp.array([6.0, -3.0, 1.0, 0.03, -0.05, 0.1]), jnp.array([1.0, 2.0, -1.0, 0.01, 0.02, -0.01])
    force = jax.jit(lambda values: model.at_values(values).force_at_rest(at) @ weights)
    forward, reverse = (jax.jit(of(force))(values) for of in (jax.jacfwd, jax.grad))
    for label, step in PARAMETERS.items():
        h = step * max(abs(float(values[label])), 1.0)
        difference = (force(values | {label: values[label] + h}) - force(values | {label: values[label] - h})) / (2 * h)
        assert abs(float(difference)) > 0
        assert_allclose(forward[label], difference, rtol=1e-5)
        assert_allclose(reverse[label], forward[label], rtol=1e-9)


@pytest.mark.slow
def test_gradients_of_a_motion() -> None:
    """Of a decay in surge by axial stiffness, length and anchor: forward = reverse = central differences."""
    model, times = volturnus(), np.arange(0.0, 10.1, 0.5)
    labels = [label for label in PARAMETERS if "friction" not in label and "weight" not in label]
    values = {label: model.values[label] for label in labels}

    def end(values, adjoint="forward"):
        motion = jh.simulate(model.at_values(values), times, position={"surge": 12.0}, step=0.5, method="rk4", adjoint=adjoint)
        return motion.position[-1, 0] + 10 * motion.position[-1, 2]

    forward = jax.jacfwd(end)(values)
    reverse = jax.grad(lambda values: end(values, "reverse"))(values)
    for label in labels:
        h = PARAMETERS[label] * max(abs(float(values[label])), 1.0)
        difference = (end(values | {label: values[label] + h}) - end(values | {label: values[label] - h})) / (2 * h)
        assert_allclose(forward[label], difference, rtol=2e-4)
        assert_allclose(reverse[label], forward[label], rtol=1e-7)


@pytest.mark.slow
def test_natural_periods_follow_the_lines() -> None:
    """Their derivative by the length, through a derivative of second order, is that of central differences."""
    model, label = moored(volturnus()), "mooring.line1.unstretched_length"

    @jax.jit
    def surge(length):
        return -jax.jacfwd(lambda q: model.at_values({label: length}).force_at_rest(q))(jnp.zeros(6))[0, 0]

    at, h = model.values[label], 1e-3
    difference = (surge(at + h) - surge(at - h)) / (2 * h)
    assert_allclose(jax.jit(jax.jacfwd(surge))(at), difference, rtol=1e-5)
    assert_allclose(jax.jit(jax.grad(surge))(at), difference, rtol=1e-5)


SCHEMA_FAULTS = [
    (("lines", 0, "segments", 0, "type"), "chian", "lines[0].segments[0].type: expected a type", "Did you mean 'chain'?"),
    (("lines", 0, "segments", 0, "length"), 500.0, "lines[0].segments: expected at least 641", "found 500 m"),
    (("lines", 0, "anchor"), [-837.6, 0, -210.0], "lines[0].anchor: expected a point on or above the sea bed", "z = -210 m"),
    (("line_types", "chain", "diameter"), 1.0, "line_types.chain: expected a line that sinks", "in water"),
    (("line_types", "chain", "submerged_weight"), 5e3, "line_types.chain: expected either submerged_weight", "diameter"),
    (("line_types", "rope"), CHAIN, "line_types.rope: expected a type that a line has (chain)", "'rope'"),
    (("line_types", "chain", "axial_stiffness"), -1.0, "line_types.chain.axial_stiffness: expected a number > 0", "-1"),
    (("lines", 0, "anchor"), [-600.0, 0, -190.0], "lines[0].anchor: expected an anchor at z = -200 m", "a sag to"),
]


@pytest.mark.parametrize(("path", "value", "start", "end"), SCHEMA_FAULTS)
def test_mistakes_in_the_file(path: tuple, value: Any, start: str, end: str) -> None:
    mooring = copy.deepcopy(VOLTURNUS)
    section: Any = mooring
    for key in path[:-1]:
        section = section[key]
    section[path[-1]] = value
    with pytest.raises(InputError) as caught:
        platform(mooring)
    assert f"mooring.{start}" in str(caught.value) and end in str(caught.value)


def test_a_line_that_hangs_straight_down_is_told() -> None:
    mooring = copy.deepcopy(VOLTURNUS)
    mooring["lines"][0]["segments"][0]["length"] = 1000.0
    (remark,) = platform(mooring).remarks
    assert remark.warning and "every line hangs straight down" in remark.text
