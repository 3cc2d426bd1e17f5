"""OpenFAST decks with tapered members: axial coefficients along them, by HydroDyn's integrals."""

import math
import shutil
from collections.abc import Callable
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from one_program import one_program
from ruamel.yaml import YAML
from test_openfast_export import round_trip

from jaxhydro.dynamics.state import State
from jaxhydro.errors import InputError
from jaxhydro.interop.conversion import Conversion, Treatment
from jaxhydro.interop.openfast_deck import read_openfast_deck
from jaxhydro.platform.build import build
from jaxhydro.platform.schema import Platform, load_platform
from jaxhydro.waves.sea import StillWater

DECK = Path(__file__).resolve().parents[1] / "fixtures" / "openfast_deck"
Edited = Callable[..., Conversion]


@pytest.fixture
def edited(tmp_path: Path) -> Edited:
    """The deck with words of HydroDyn's file replaced."""

    def read(*changes: tuple[str, str]) -> Conversion:
        folder = tmp_path / f"deck{len(list(tmp_path.iterdir()))}"
        shutil.copytree(DECK, folder)
        text = (folder / "hydrodyn.dat").read_text(encoding="utf-8")
        for before, after in changes:
            assert before in text
            text = text.replace(before, after, 1)
        (folder / "hydrodyn.dat").write_text(text, encoding="utf-8")
        return read_openfast_deck(folder / "main.fst")

    return read


def group_of(conversion: Conversion, name: str) -> dict:
    group = next(entry["group"] for entry in conversion.platform["members"] if entry["name"] == name)
    return conversion.platform["coefficients"][group]


def said(conversion: Conversion, source: str, treatment: Treatment) -> str:
    return " ".join(i.meaning for i in conversion.items if source in i.source and i.treatment is treatment)


JOINT = "    9       0.0       0.0     -10.0         "  # the lower end of member 15, which tapers from 6 to 4 m
LIKE_THE_END = (JOINT + "3", JOINT + "2")
SIMPLE_ROW = " 0.7     9.0       0.9     9.0       1.0     9.0       0.0       0.0         0.0       0.0 "
ALONG = (SIMPLE_ROW, SIMPLE_ROW[:-40] + "3.0       9.0         0.8       9.0 ")


def heave(conversion: Conversion, speed: float) -> tuple[float, float]:
    """Added mass (kg) and the force of a speed (m/s), in heave."""
    model = build(Platform.model_validate(conversion.platform))

    def load(velocity: jax.Array) -> tuple[jax.Array, jax.Array]:
        memory = model.rest().memory
        total = model.sum_of_loads(model.instant(jnp.zeros(()), State(jnp.zeros(6), velocity, memory), StillWater()), memory)
        return total.added_mass[2, 2] + total.moments[2, 2] @ total.masses, total.force[2]

    at_rest, moving = (one_program(load)(np.array([0, 0, v, 0, 0, 0.0])) for v in (0.0, speed))
    return float(at_rest[0]), float(moving[1] - at_rest[1])


def test_axial_coefficients_along_a_taper(edited: Edited) -> None:
    """HydroDyn's integrals along a circle from 6 to 4 m: 2 AxCa rho pi r² dr, and 1/2 AxCd rho pi r dr v²."""
    ends_alone, along = edited(LIKE_THE_END), edited(LIKE_THE_END, ALONG)
    assert group_of(along, "member15") == {"Ca_t": 0.9, "Ca_z": 0.8, "Cd_t": 0.7, "Cd_z": 1.5}
    assert "Cd_z = AxCd / 2 and Ca_z = AxCa" in said(along, "AxCd, AxCa of members", Treatment.TAKEN)
    names = [entry["name"] for entry in ends_alone.platform["members"]]
    assert "member15_lower" in names and group_of(ends_alone, "member15")["Ca_z"] == 0.0
    assert "slice of 3 % of the length" in said(ends_alone, "JointAxID", Treatment.APPROXIMATED)
    rho, speed = along.platform["water"]["density"], 2.0
    # the slice has the end's coefficients without those along the rest: its part of the taper is taken out
    lower = 3.0 - 0.03
    mass, force = np.subtract(heave(along, speed), heave(ends_alone, speed))
    assert mass == pytest.approx(0.8 * rho * 2 / 3 * math.pi * (lower**3 - 2.0**3), rel=1e-9)
    assert force == pytest.approx(-0.25 * 3.0 * rho * math.pi * (lower**2 - 2.0**2) * speed**2, rel=1e-9)


def test_what_has_no_place_along_a_taper_is_said(edited: Edited) -> None:
    """A flat tapered member has no axial coefficients; AxCp is 1."""
    row = SIMPLE_ROW + "        1.0"
    other = SIMPLE_ROW[:-40] + "3.0       9.0         0.8       9.0         0.5"
    assert "AxCp = 1, not 0.5" in said(edited((row, other)), "AxCp of members", Treatment.APPROXIMATED)
    flat = (JOINT, "    9       9.0       0.0      -7.0         ")
    deck = edited((row, other), flat)
    assert "wave pressure only" in said(deck, "AxCd, AxCa of members", Treatment.LEFT_OUT)
    negative = other.replace("3.0       9.0", "-3.0      9.0")
    with pytest.raises(InputError, match=r"coefficients >= 0, found -3"):
        edited((row, negative))


@pytest.mark.parametrize("shape", ["circ", "rect"])
def test_axial_coefficients_of_a_taper_come_back(shape: str, tmp_path: Path) -> None:
    """A leaning tapered column that ends under water, in a deck of this program and back."""
    raw = YAML(typ="safe").load(load_platform("oc3-hywind").model_dump_json(exclude_unset=True))
    size = [9.0, 6.0] if shape == "circ" else [[9.0, 5.0], [6.0, 4.0]]
    column = {"name": "column", "group": "column", "shape": shape, "stations": [0, 1], "d": size}
    column |= {"rA": [0.0, 0.0, -60.0], "rB": [10.0, 0.0, -5.0]}
    group = {"Ca_t": 0.9, "Cd_t": 0.7, "Ca_z": 0.65, "Cd_z": 0.6}
    platform = Platform.model_validate(raw | {"members": [column], "coefficients": {"column": group}})
    trip = round_trip(platform, tmp_path / "deck")
    numbers = {entry["name"]: trip.read.platform["coefficients"][entry["group"]] for entry in trip.read.platform["members"]}
    assert len(numbers) == 1
    for found in numbers.values():
        for key in ("Ca_z", "Cd_z"):
            assert found[key] == pytest.approx(group[key], rel=1e-9)
