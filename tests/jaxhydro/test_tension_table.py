"""Ropes whose tension is a table: against plain springs, by hand, and in statics, files and exports."""

import copy
from functools import cache
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from one_program import one_program

import jaxhydro as jh
from jaxhydro.dynamics.static_forces import line_states, mooring_stiffness
from jaxhydro.errors import InputError
from jaxhydro.input_schema import validate
from jaxhydro.loads import MooringLines, TensionTableLines
from jaxhydro.loads.tension_table_lines import TensionTable
from jaxhydro.platform.build import build
from jaxhydro.platform.schema import Platform
from jaxhydro.platform.tension_table_build import tension_table
from jaxhydro.rotations import rotation

ANCHOR, FAIRLEAD = [500.0, 0.0, -100.0], [20.0, 0.0, -10.0]
LENGTH = 480.0
DATA: dict[str, Any] = {
    "name": "buoy",
    "water": {"density": 1025.0, "depth": 100},
    "rigid_body": {"mass": 4.0e5, "centre_of_mass": [0, 0, -4.0], "inertia": {"Ixx": 1e7, "Iyy": 1e7, "Izz": 5e6}},
    "members": [],
    "hydrostatics": {"C33": 8e5, "C44": 5e7, "C55": 5e7},
    "added_mass": {"A11": 1e5},
    "mooring": {
        "kind": "tension_table",
        "ropes": {"polyester": {"strain": [0.0, 0.01, 0.03], "tension": [0.0, 2e5, 1e6], "interpolation": "linear"}},
        "lines": [
            {
                "rope": "polyester",
                "anchor": ANCHOR,
                "fairlead": FAIRLEAD,
                "unstretched_length": LENGTH,
                "heading": [0, 120, 240],
            }
        ],
    },
}


def changed(**rope: Any) -> dict[str, Any]:
    data = copy.deepcopy(DATA)
    data["mooring"]["ropes"]["polyester"] |= rope
    return data


def model(data: dict[str, Any]) -> jh.Model:
    return build(validate(Platform, data, "buoy"))


@cache
def buoy() -> jh.Model:
    return model(DATA)


def ropes(of: jh.Model) -> TensionTableLines:
    return next(load for load in of.loads if isinstance(load, TensionTableLines))


@pytest.mark.parametrize("interpolation", ["linear", "pchip"])
def test_a_straight_table_is_a_spring(interpolation: str) -> None:
    stiffness = 3e4
    stretch = np.array([0.0, 1.0, 3.0, 8.0])
    table = tension_table(stretch, stiffness * stretch, interpolation)
    anchor, fairlead = jnp.array(ANCHOR)[:, None], jnp.array(FAIRLEAD)[:, None]
    rope = TensionTableLines(anchor, fairlead, (table,), (False,), (0,), {"rope1": 488.0}, {"rope1": 1.0})
    spring = MooringLines(anchor, fairlead, {"line1": stiffness}, {"line1": 488.0})
    offsets = jnp.array([-30.0, -5.0, 0.0, 2.0, 30.0])  # beyond the table, within it, slack

    def pulls(load: TensionTableLines | MooringLines) -> np.ndarray:
        def at(offset: jax.Array) -> jax.Array:
            def pull(q: jax.Array) -> jax.Array:
                tension, towards = load.tension(q, rotation(q[3:]))
                return jnp.concatenate([tension, towards[:, 0]])

            q = jnp.array([0.0, 1.0, -2.0, 0.02, -0.1, 0.05]).at[0].set(offset)
            return jnp.concatenate([pull(q)[None], jax.jacfwd(pull)(q).T])

        return np.asarray(jax.jit(jax.vmap(at))(offsets))

    ours, spring_pulls = pulls(rope), pulls(spring)
    assert ours == pytest.approx(spring_pulls, rel=1e-12, abs=1e-12 * np.abs(spring_pulls).max())
    assert (ours == 0).sum() > 0


@one_program
def tensions(table: TensionTable, stretch) -> jax.Array:
    return table.tension(stretch)


def test_a_table_by_hand() -> None:
    """488.3646 m to the anchor, 480 m unstretched: strain 0.0174263; 2e5 + (0.0174263 - 0.01)/0.02 8e5 = 497 052 N."""
    rope = ropes(buoy())
    tension, towards = one_program(TensionTableLines.tension)(rope, np.zeros(6), np.eye(3))
    assert np.asarray(tension) == pytest.approx([497051.7] * 3, abs=1.0)
    assert np.asarray(towards)[:, 0] == pytest.approx(np.array([480.0, 0.0, -90.0]) / np.hypot(480.0, 90.0), rel=1e-12)
    beyond = tensions(rope.tables[0], np.array([0.04, -0.01, 0.03, 0.01, 0.005]))
    assert np.asarray(beyond) == pytest.approx([1.4e6, 0.0, 1e6, 2e5, 1e5], rel=1e-12)


def test_a_monotone_cubic_by_hand() -> None:
    """Slope at the middle entry: the weighted harmonic mean of 2e7 and 4e7 N over intervals of 0.01 and 0.02.

    Fritsch and Butland 1984: (w1 + w2)/(w1/d1 + w2/d2) with w1 = 2 h2 + h1 = 0.05 and w2 = h2 + 2 h1 = 0.04.
    """
    table = ropes(model(changed(interpolation="pchip"))).tables[0]
    slopes = one_program(jax.vmap(jax.grad(lambda s: table.tension(s[None])[0])))
    slope = slopes(np.array([0.01 - 1e-12, 0.01 + 1e-12]))
    assert np.asarray(slope) == pytest.approx([0.09 / (0.05 / 2e7 + 0.04 / 4e7)] * 2, rel=1e-8)
    assert (np.diff(np.asarray(tensions(table, np.linspace(0.0, 0.05, 200)))) > 0).all()
    assert np.asarray(tensions(table, np.array([0.0, 0.01, 0.03]))) == pytest.approx([0.0, 2e5, 1e6], rel=1e-12)


def test_statics_see_the_ropes() -> None:
    """Surge stiffness of three ropes (Faltinsen 1990, chapter 8): 3/2 (k cos^2 + T/l (1 - cos^2) + T/l)."""
    model = buoy()
    states = line_states(model, jnp.zeros(6))
    assert [state.tension for state in states] == pytest.approx([497051.7] * 3, abs=1.0)
    assert states[0].strain == pytest.approx(0.0174263, abs=1e-7)
    assert states[0].angle == pytest.approx(np.arctan(90.0 / 480.0), rel=1e-9)
    length, tension, stiffness = np.hypot(480.0, 90.0), states[0].tension, 4e7 / LENGTH
    level = (480.0 / length) ** 2
    expected = 1.5 * (stiffness * level + tension / length * (1 - level) + tension / length)
    assert float(mooring_stiffness(model, jnp.zeros(6))[0, 0]) == pytest.approx(expected, rel=1e-9)
    assert float(model.values["mooring.rope2.unstretched_length"]) == LENGTH


MISTAKES: list[tuple[dict[str, Any], str]] = [
    ({"strain": [0.0, 0.02, 0.01]}, "strain[2]: expected a number > 0.02, the one before, found 0.01"),
    ({"tension": [0.0, 2e5, 1e5]}, "tension[2]: expected a number >= 200000, the one before, found 100000.0"),
    ({"tension": [1.0, 2e5, 1e6]}, "tension[0]: expected 0, where the rope begins to pull, found 1.0"),
    ({"tension": [0.0, 2e5]}, "tension: expected 3 numbers, as strain has, found 2 numbers"),
    ({"stretch": [0.0, 1.0, 2.0]}, "polyester: expected either strain or stretch, found both"),
    ({"strain": None}, "polyester: expected either strain or stretch, found neither"),
    ({"interpolation": "spline"}, "interpolation: expected one of linear, pchip, found 'spline'"),
]


@pytest.mark.parametrize(("rope", "expected"), MISTAKES)
def test_mistakes_are_told(rope: dict[str, Any], expected: str) -> None:
    with pytest.raises(InputError) as error:
        validate(Platform, changed(**rope), "buoy")
    assert f"mooring.ropes.{'polyester.' * (not expected.startswith('polyester'))}{expected}" in str(error.value)


def test_unknown_ropes_are_told() -> None:
    data = copy.deepcopy(DATA)
    data["mooring"]["lines"][0]["rope"] = "polester"
    with pytest.raises(InputError, match=r"lines\[0\]\.rope: expected a rope of `ropes` \(polyester\), found 'polester'"):
        validate(Platform, data, "buoy")


def test_slack_ropes_and_short_tables_are_told() -> None:
    slack, short = copy.deepcopy(DATA), changed(strain=[0.0, 0.005, 0.01])
    slack["mooring"]["lines"][0] |= {"unstretched_length": 500.0, "heading": [0]}
    (text,) = (remark.text for remark in model(slack).remarks)
    assert "rope 1: 488.4 m to its anchor, 500 m unstretched" in text
    (text,) = (remark.text for remark in model(short).remarks)
    assert "rope 3: 0.01743, and 0.01 at the table's end" in text
