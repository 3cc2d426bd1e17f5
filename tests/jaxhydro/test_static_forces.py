"""Static forces: balance, published mooring, curves of restoring forces, the command, and remarks on odd platforms."""

import copy
from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_catenary import VOLTURNUS, platform, volturnus
from test_no_members import platform_in
from typer.testing import CliRunner

import jaxhydro as jh
from jaxhydro.cli import app as cli
from jaxhydro.cli.options import platform_of
from jaxhydro.dynamics.rest_remarks import rest_remarks, wave_remarks
from jaxhydro.dynamics.static_forces import forces_by_load, line_states, offset_curve
from jaxhydro.dynamics.statics import equilibrium, linearised
from jaxhydro.files import embedded_campaigns
from jaxhydro.loads.static_force import StaticForce


def statics(*words: str) -> tuple[int, str]:
    result = CliRunner().invoke(cli.app, ["statics", *words])
    return result.exit_code, " ".join(result.output.split())


@pytest.mark.slow
def test_loads_are_in_balance_at_rest() -> None:
    model = volturnus()
    forces = forces_by_load(model, equilibrium(model))
    assert set(forces) == {"weight", "buoyancy", "catenary lines"}
    weight = float(model.body.mass * model.environment.gravity)
    assert_allclose(forces["weight"][2], -weight, rtol=1e-12)
    assert_allclose(sum(forces.values()) / weight, 0.0, atol=1e-9)


def test_lines_are_those_that_were_published() -> None:
    """Allen et al. 2020, NREL/TP-5000-76773, table 8: pretension 2437 kN, 56.4 deg at the fairlead."""
    lines = line_states(volturnus(), jnp.zeros(6))
    weight_per_length = (685.0 - 1025.0 * np.pi / 4 * 0.333**2) * 9.81
    for line in lines:
        assert_allclose(line.tension, 2437e3, rtol=1e-3)
        assert_allclose(np.degrees(line.angle), 56.4, atol=0.1)
        assert_allclose(line.strain, line.tension / 3.27e9, rtol=1e-12)
        assert_allclose(line.on_seabed, 850.0 - line.tension * np.sin(line.angle) / weight_per_length, rtol=2e-3)


@pytest.mark.slow
def test_a_force_moves_the_platform_along_its_curve() -> None:
    model = volturnus()
    curve = offset_curve(model, "surge", jnp.array([0.0, 6.0]))
    assert_allclose(curve.position[:, 0], [0.0, 6.0], atol=1e-12)
    pushed = equilibrium(model.with_effect(StaticForce(force={"surge": curve.force[1]})))
    assert_allclose(pushed, curve.position[1], atol=1e-7)
    slope = (curve.force[1] - curve.force[0]) / 6.0
    stiffness = np.asarray(linearised(model, jnp.zeros(6))[1])
    free = stiffness[0, 0] - stiffness[0, 4] * stiffness[4, 0] / stiffness[4, 4]
    assert free < slope < 1.5 * free  # the lines stiffen


@pytest.mark.slow
def test_what_the_command_prints() -> None:
    status, output = statics("volturnus-s-focal", "--offset", "surge=5", "--force", "surge=1e5")
    assert status == 0
    for words in (
        "Natural periods",
        "Forces at rest",
        "Mooring lines at rest",
        "mooring lines alone",
        "Held in surge",
        "Under a",
    ):
        assert words in output


def test_mistakes_name_the_option() -> None:
    for words, expected in (
        (("--force", "srge=1e5"), "Did you mean 'surge'?"),
        (("--force", "surge=much"), "a number after surge= expected"),
        (("--offset", "pitch=95"), "less than 90 deg expected, found pitch=95"),
    ):
        status, output = statics("volturnus-s", *words)
        assert status == 2 and expected in output.replace(" │ │ ", " ") and words[0] in output


def test_waves_that_nothing_takes_are_told(tmp_path: Path) -> None:
    (remark,) = wave_remarks(jh.load_model(platform_in(tmp_path, excitation=False)))
    assert remark.warning and "waves do not act on this platform" in remark.text
    assert wave_remarks(jh.load_model(platform_in(tmp_path))) == []
    assert wave_remarks(volturnus()) == []


@pytest.mark.slow
def test_a_platform_that_does_not_rest_as_it_was_drawn_is_told(tmp_path: Path) -> None:
    file = platform_in(tmp_path, excitation=False)
    assert rest_remarks(jh.load_model(file), jnp.zeros(6)) == []  # nothing is drawn
    model = volturnus()
    assert rest_remarks(model, equilibrium(model)) == []
    heave, tilt = rest_remarks(model, jnp.array([0.0, 0.0, -2.5, 0.0, 0.1, 0.0]))
    assert "rests 2.5 m below the reference position. Vertical forces there: weight -" in heave.text
    assert "pitch of 5.73 deg" in tilt.text


def test_a_line_that_is_stretched_by_much_is_told() -> None:
    short = copy.deepcopy(VOLTURNUS)
    short["lines"][0]["segments"][0]["length"] = 720.0  # of 801.5 m to the anchor
    (remark,) = [entry for entry in platform(short).remarks if "stretched" in entry.text]
    assert remark.warning and "line 1, 2, 3 is stretched by up to 11%" in remark.text
    assert not any("stretched" in remark.text for remark in volturnus().remarks)


def test_units_suit_the_platform(tmp_path: Path) -> None:
    """A model of a ship in N m, a wind platform in MN m; what is rounding is 0."""
    ship = tmp_path / "ship.yaml"
    ship.write_text(
        "{name: ship, water: {density: 1000.0, depth: 3.0}, members: [], mooring: {kind: none}, hydrostatics: {C44: 822.0},"
        "rigid_body: {mass: 994.0, centre_of_mass: [0, 0, -0.0324], inertia: {Ixx: 115.7, Iyy: 1376, Izz: 1376}}}"
    )
    status, small = statics(str(ship))
    assert status == 0 and "Stiffness at rest (N/m, N, N m)" in small and "heave (kN)" in small and "roll (N m)" in small
    assert " roll 0 0 0 822 0 0 " in small
    assert "buoyancy does not restore heave and pitch: the platform file has no members and no C33 or C55" in small
    assert "does not restore" not in statics("volturnus-s")[1]
    assert "Stiffness at rest (MN/m, MN, MN m)" in statics("volturnus-s")[1]


def test_a_campaign_stands_for_its_platform(tmp_path: Path) -> None:
    """By its folder, its file or its name; a folder without a campaign is told."""
    folder = embedded_campaigns()["volturnus-s-decays"]
    assert {platform_of(str(name)) for name in (folder, folder / "campaign.yaml", folder.name)} == {
        str(folder / "platform.yaml")
    }
    assert platform_of("oc3-hywind") == "oc3-hywind"
    code, text = statics(str(tmp_path))
    assert code == 2 and "a folder without campaign.yaml" in text
