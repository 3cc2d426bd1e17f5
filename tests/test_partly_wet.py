"""Horizontal and inclined members that still water cuts."""

import copy
from typing import Any

import pytest

from jaxhydro.platform import build
from jaxhydro.platform_schema import Platform
from jaxhydro.problems import InputError, validate


def platform(**member: Any) -> Platform:
    data = {
        "name": "barge",
        "water": {"density": 1025.0, "depth": 100},
        "rigid_body": {"mass": 1e6, "centre_of_mass": [0, 0, 0.0], "inertia": {"Ixx": 1e8, "Iyy": 2e8, "Izz": 2e8}},
        "members": [{"name": "low", "shape": "circ", "d": 2.0, "rA": [0, 0, -9], "rB": [0, 9, -9]}, {"name": "box"} | member],
        "coefficients": {"box": {}, "low": {}},
        "mooring": {"kind": "none"},
    }
    return validate(Platform, copy.deepcopy(data), "barge")


BOX = {"shape": "rect", "d": [8.0, 3.0]}
TUBE = {"shape": "circ", "d": 3.0}


@pytest.mark.parametrize(
    "member, share",
    [
        (BOX | {"rA": [-20, 0, -0.5], "rB": [20, 0, -0.5]}, "67%"),
        (BOX | {"rA": [-20, 0, 0.0], "rB": [20, 0, 0.0], "gamma": 90.0}, "50%"),
        (TUBE | {"rA": [-20, 0, 0.75], "rB": [20, 0, 0.75]}, "25%"),
        (TUBE | {"rA": [-20, 0, -5.0], "rB": [20, 0, 5.0]}, "50%"),
        (TUBE | {"rA": [10, 0, 0.0], "rB": [20, 0, 0.0], "heading": [0, 120, 240]}, "50%"),
    ],
    ids=["box", "turned", "tube", "brace", "three"],
)
def test_a_pontoon_that_still_water_cuts_is_refused(member: dict, share: str) -> None:
    """Once per member, with the way out."""
    with pytest.raises(InputError) as error:
        build(platform(**member))
    (problem,) = error.value.problems
    assert problem.where == "members[1]" and share in problem.found and "'box'" in problem.found
    assert "upright members" in problem.hint


@pytest.mark.parametrize(
    "member",
    [
        BOX | {"rA": [-20, 0, -1.55], "rB": [20, 0, -1.55]},
        BOX | {"rA": [-20, 0, 3.0], "rB": [20, 0, 3.0]},
        TUBE | {"rA": [-20, 0, -1.4], "rB": [20, 0, -1.4]},
        TUBE | {"rA": [-20, 0, -25.0], "rB": [20, 0, 0.0]},
        BOX | {"rA": [0, 0, -5.0], "rB": [0, 0, 5.0]},
        TUBE | {"rA": [-3, 0, -5.0], "rB": [3, 0, 5.0]},
    ],
    ids=["under", "above", "nearly under", "cut brace", "upright", "steep"],
)
def test_others_are_not(member: dict) -> None:
    build(platform(**member))
