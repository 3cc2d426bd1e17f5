"""Five public hulls: natural periods and one small regular wave, against published values and plain NumPy."""

import json
import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from one_program import one_program

import jaxhydro as jh
from benchmarks.evidence.hulls_cases import CASES, scaled, two_members
from benchmarks.evidence.hulls_published import PUBLISHED
from benchmarks.evidence.hulls_reference import Hull
from benchmarks.evidence.hulls_runs import model_of, motion, periods, platform_of
from calibration.decay_analysis.model_damping import motion_shape
from calibration.residuals.static import natural_period
from jaxhydro.dynamics.model import Model
from jaxhydro.platform.schema import load_platform

POTENTIAL = json.loads((Path(__file__).parents[2] / "benchmarks" / "hulls" / "potential-flow.json").read_text("utf-8"))
# relative, beyond the published rounding: what strips of one added mass coefficient and linearised lines leave
TOLERANCES = {
    "oc3-hywind": {"surge": 0.012, "heave": 0.002, "pitch": 0.012, "yaw": 0.002},
    "oc4-deepcwind": {
        "surge": 0.05,
        "heave": 0.007,
        "pitch": 0.047,
        "yaw": 0.001,
    },  # lines of the test; pitch alone, not coupled
    "volturnus-s": {"surge": 0.0, "heave": 0.07, "pitch": 0.04},  # coefficients tuned to another model of it
}
PANELS = {"iti-barge": {"surge": 0.005, "heave": 0.013, "pitch": 0.092}, "ship-section": {"sway": 0.001, "heave": 0.001}}


@cache
def model(name: str) -> Model:
    return model_of(platform_of(CASES[name]))


@cache
def reference(name: str) -> Hull:
    return Hull(platform_of(CASES[name]))


@cache
def own_periods(name: str) -> dict[str, float]:
    return periods(model(name))


@cache
def moved(name: str) -> dict[str, float]:
    return motion(model(name), CASES[name])


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name in ("oc3-hywind", "ship-section") else pytest.mark.slow) for name in CASES]
)
def test_natural_periods(name: str) -> None:
    periods_found = own_periods(name)
    own = reference(name).periods()
    assert periods_found == pytest.approx(own, rel=2e-4)
    for published in PUBLISHED.get(name, ()):
        for dof, frequency in published.frequency.items():
            within = TOLERANCES[name][dof] + published.rounding / frequency
            assert periods_found[dof] * frequency == pytest.approx(1.0, abs=within), (dof, published.source)
    for dof, within in PANELS.get(name, {}).items():
        assert periods_found[dof] == pytest.approx(POTENTIAL[name]["periods"][dof], rel=within)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name == "ship-section" else pytest.mark.slow) for name in CASES]
)
def test_a_small_regular_wave(name: str) -> None:
    """A strip afloat takes the waves as linear across its section, which shows in the ship section's roll."""
    case = CASES[name]
    expected = np.abs(reference(name).motion(case.period, math.radians(case.heading)))
    for dof in case.moved:
        within = 0.05 if (name, dof) == ("ship-section", "roll") else 0.002
        assert moved(name)[dof] == pytest.approx(expected[jh.DOFS.index(dof)], rel=within), dof


@pytest.mark.slow
def test_a_step_is_two_members() -> None:
    split = model_of(two_members(platform_of(CASES["oc4-deepcwind"])))
    assert periods(split) == pytest.approx(own_periods("oc4-deepcwind"), rel=1e-6)


@pytest.mark.slow
def test_a_step_is_two_members_in_waves() -> None:
    case = CASES["oc4-deepcwind"]
    split_motion, first = motion(model_of(two_members(platform_of(case))), case), moved("oc4-deepcwind")
    assert [split_motion[dof] for dof in case.moved] == pytest.approx([first[dof] for dof in case.moved], rel=1e-6)


def test_a_model_at_one_fiftieth() -> None:
    scale = 1 / 50
    small = periods(model_of(scaled(platform_of(CASES["oc4-deepcwind"]), scale)))
    assert small == pytest.approx({dof: x * scale**0.5 for dof, x in own_periods("oc4-deepcwind").items()}, rel=1e-8)


@pytest.mark.slow
def test_a_model_at_one_fiftieth_in_waves() -> None:
    case, scale = CASES["oc4-deepcwind"], 1 / 50
    scaled_motion, first = motion(model_of(scaled(platform_of(case), scale)), case, scale), moved("oc4-deepcwind")
    turned = {dof: scaled_motion[dof] * (scale if dof == "pitch" else 1.0) for dof in case.moved}
    assert turned == pytest.approx({dof: first[dof] for dof in case.moved}, rel=1e-6)


def test_closed_forms_of_the_ship_section() -> None:
    """Heave: T = 2 pi (m (1 + Ca) / rho g L B)^0.5."""
    platform: dict[str, Any] = platform_of(CASES["ship-section"])
    heavy = 320.0 * (1 + platform["coefficients"]["hull"]["Ca_z"])
    assert own_periods("ship-section")["heave"] == pytest.approx(
        2 * math.pi * math.sqrt(heavy / (1e3 * 9.80665 * 4 * 0.4)), rel=1e-9
    )


@pytest.mark.slow
def test_a_spar_pitches_about_a_point_far_below() -> None:
    """The mode moves the reference point by more than its angle: its strain energy is that of pitch."""
    spar, own = model("oc3-hywind"), reference("oc3-hywind").periods()
    modes = jh.natural_modes(spar)
    at = modes.number("pitch")
    assert at is not None and np.argmax(np.abs(modes.shape[at])) == jh.DOFS.index("surge")
    assert modes.motion.count("surge") == 1 and modes.of("pitch") == pytest.approx(own["pitch"], rel=1e-5)
    assert float(one_program(natural_period)(spar, jh.DOFS.index("pitch"))) == pytest.approx(modes.of("pitch"), rel=1e-8)
    shape = motion_shape(spar, "pitch")
    assert shape[4] == 1 and 60.0 < shape[0] < 90.0  # m/s of surge at still water by rad/s: about 75 m below


@pytest.mark.parametrize("name", [name for name in CASES if name != "volturnus-s"])
def test_platform_files_float_near_their_reference_position(name: str) -> None:
    """Published mass, geometry and pull of the lines balance; the barge's lines pull it 3.4 % of its draught down."""
    equilibrium = np.asarray(jh.equilibrium(model(name)))
    assert equilibrium[2] == pytest.approx(reference(name).heave, abs=1e-5)
    assert abs(equilibrium[2]) < (0.14 if name == "iti-barge" else 0.02)
    assert np.abs(equilibrium[[0, 1, 3, 4, 5]]).max() < 1e-6
    assert load_platform(CASES[name].path).name
