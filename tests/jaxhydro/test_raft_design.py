"""RAFT's designs read as platform files: masses, coefficients, moorings, and what is told of a broken file."""

import copy
import math
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from one_program import one_program
from ruamel.yaml import YAML

import jaxhydro as jh
from jaxhydro.errors import InputError
from jaxhydro.interop.conversion import Conversion, Treatment
from jaxhydro.interop.frustum import hollow_frustum, solid_frustum
from jaxhydro.interop.mooring_system import Attachment, MooringSystem, catenary_section
from jaxhydro.interop.raft_design import read_raft_design
from jaxhydro.interop.raft_masses import member_axes, moments_of
from jaxhydro.interop.raft_member import RaftMember
from jaxhydro.interop.raft_mooring import MooringSection
from jaxhydro.platform.body import RigidBody
from jaxhydro.platform.catenary_build import catenary_lines
from jaxhydro.platform.catenary_schema import Catenary
from jaxhydro.rotations import cross, rotation

DESIGN = Path(__file__).parents[1] / "fixtures" / "raft_design.yaml"


def contents() -> dict[str, Any]:
    return YAML(typ="safe").load(DESIGN)


def converted(tmp_path: Path, change: Callable[[dict[str, Any]], object] = lambda data: None) -> Conversion:
    """The design after a change."""
    data, path = contents(), tmp_path / "design.yaml"
    change(data)
    YAML().dump(data, path)
    return read_raft_design(path)


def member(**keys: Any) -> RaftMember:
    usual = {"name": "m", "shape": "circ", "rA": [0, 0, -20], "rB": [0, 0, 15], "stations": [0, 35], "d": 9.85}
    return RaftMember.model_validate(usual | {"t": 0.05, "rho_shell": 7850, "rho_fill": 5000} | keys)


# ------------------------------------------------------------------------------------------------- masses


def quadrature(first: np.ndarray, last: np.ndarray, length: float, circular: bool) -> np.ndarray:
    """Volume, its first and second moment along z, and second moments across, by sums over points of the body itself."""
    node, weight = np.polynomial.legendre.leggauss(8)
    s, ws = 0.5 * (1 + node), 0.5 * weight
    a, b = (first[k] + (last[k] - first[k]) * s for k in (0, 1))
    if circular:  # r dr dphi
        angle = np.linspace(0, 2 * math.pi, 17)[:-1]
        x = 0.5 * a[:, None, None] * s[:, None] * np.cos(angle)
        y = 0.5 * b[:, None, None] * s[:, None] * np.sin(angle)
        dv = (ws * 0.25 * a * b)[:, None, None] * (ws * s)[:, None] * np.full(16, 2 * math.pi / 16) * length
    else:
        x = 0.5 * a[:, None, None] * node[:, None] * np.ones(8)
        y = 0.5 * b[:, None, None] * node * np.ones((8, 1))
        dv = (ws * a * b)[:, None, None] * ws[:, None] * ws * length
    z = (length * s)[:, None, None]
    return np.array([(f * dv).sum() for f in (np.ones_like(x), z, z**2, x**2, y**2)])


@pytest.mark.parametrize("circular", [True, False])
@pytest.mark.parametrize("last", [(3.0, 2.0), (7.0, 1.0), (5.0, 4.0), (0.0, 0.0)])
def test_solid_frustum_against_quadrature(circular: bool, last: tuple[float, float]) -> None:
    first = np.array([5.0, 5.0 if circular else 4.0])
    end = np.array([last[0], last[0] if circular else last[1]])
    moments = solid_frustum(first, end, 7.0, circular)
    values = [moments.mass, moments.first, moments.second, *moments.across]
    np.testing.assert_allclose(values, quadrature(first, end, 7.0, circular), rtol=1e-12)


def test_hollow_frustum_about_its_centre() -> None:
    """A straight tube: the closed forms of textbooks, m (3 (R^2 + r^2) + L^2) / 12 across and m (R^2 + r^2) / 2 along."""
    tube = hollow_frustum((4, 4), (4, 4), (3, 3), (3, 3), 10.0, circular=True).times(2.0).shifted(5.0)
    mass, radii = 2.0 * math.pi * (2.0**2 - 1.5**2) * 10.0, 2.0**2 + 1.5**2
    across = mass * (3 * radii + 100.0) / 12
    assert tube.mass == pytest.approx(mass, rel=1e-13)
    assert tube.centre == pytest.approx(10.0, rel=1e-13)
    np.testing.assert_allclose(tube.inertia(), [across, across, mass * radii / 2], rtol=1e-12)


INCLINED = {"rA": [-12.5, 4.3301, -15.0], "rB": [9.375, -3.2476, 11.25]}


@pytest.mark.parametrize(
    ("keys", "mass", "centre"),
    [  # RAFT at e6cb69e, tests/test_member.py, desired_inertiaBasic: shell and ballast (kg), centre (m)
        ({"l_fill": 6.19}, (4.22944765e05, 2.310786205e06), (0.0, 0.0, -14.67635)),
        ({"l_fill": 6.19, **INCLINED}, (4.22944707e05, 2.310785885e06), (-9.172721, 3.1775, -11.00727)),
        ({"l_fill": 6.19, "d": [9.85, 4]}, (2.96708699e05, 2.074252114e06), (0.0, 0.0, -15.51393)),
        (
            {"l_fill": 2.71, "shape": "rect", "d": [9.85, 6], **INCLINED},
            (4.3273125e05, 7.7946375e05),
            (-8.050958, 2.788911, -9.66115),
        ),
    ],
    ids=["cylinder", "inclined cylinder", "cone", "inclined box"],
)
def test_mass_of_members_against_raft(keys: dict[str, Any], mass: tuple[float, float], centre: tuple[float, ...]) -> None:
    whole, empty = member(**keys), member(**(keys | {"l_fill": 0.0}))
    moments = moments_of(whole)
    np.testing.assert_allclose(
        [moments_of(empty).mass, moments.mass], [mass[0], sum(mass)], rtol=2e-7
    )  # the ends' coordinates have six digits
    at = np.array(whole.rA) + moments.centre * member_axes(whole)[:, 2]
    np.testing.assert_allclose(at, centre, atol=2e-5)


def test_inertia_of_an_upright_box_against_raft() -> None:
    """RAFT at e6cb69e, tests/test_member.py, desired_inertiaMatrix, about the reference point."""
    box = member(shape="rect", d=[9.85, 6], l_fill=2.71)
    moments, axes = moments_of(box), member_axes(box)
    own = axes @ np.diag(moments.inertia()) @ axes.T
    z = box.rA[2] + moments.centre
    np.testing.assert_allclose(
        np.diag(own) + moments.mass * z**2 * np.array([1, 1, 0]), [3.23452553e8, 3.30580956e8, 1.73816357e7], rtol=1e-7
    )


@pytest.mark.parametrize("gamma", [0.0, 30.0, 90.0])
def test_inertia_of_a_level_box_has_its_width_level(gamma: float) -> None:
    box = member(shape="rect", d=[6.0, 2.0], rA=[0, 0, -10], rB=[0, 35, -10], gamma=gamma)
    axes, (first, second, _) = member_axes(box), moments_of(box).inertia()
    assert first < second  # about the long side, the mass is near
    lean = math.radians(gamma)
    np.testing.assert_allclose(np.abs(axes[:, 0] @ [0, 0, 1]), math.sin(lean), atol=1e-12)


def test_a_cap_at_an_end_lies_within_and_one_between_about_its_station() -> None:
    plain = moments_of(member())
    for station, middle in ((0, 0.25), (35, 34.75), (10, 10.0)):
        capped = moments_of(member(cap_stations=[station], cap_t=[0.5], cap_d_in=[2.0]))
        mass = capped.mass - plain.mass
        assert mass == pytest.approx(7850 * math.pi / 4 * (9.75**2 - 2.0**2) * 0.5, rel=1e-9)
        assert (capped.first - plain.first) / mass == pytest.approx(middle, rel=1e-9)


def test_without_cap_stations_there_is_no_cap() -> None:
    assert moments_of(member(cap_t=[0.5, 0.5], cap_d_in=[2.0])) == moments_of(member())


def test_caps_at_a_step_have_the_inner_sizes_of_their_sides(tmp_path: Path) -> None:
    """By hand: base of 12 m, column of 6 m, walls of 20 mm, two plates of 20 mm at the step, one with a hole of 1 m."""
    steel, quarter = 7850.0, math.pi / 4
    shell = quarter * ((12**2 - 11.96**2) * 4 + (6**2 - 5.96**2) * 16)
    caps = quarter * (11.96**2 * 0.03 + 11.96**2 * 0.02 + (5.96**2 - 1.0) * 0.02)
    mass = steel * (shell + caps) + 1025.0 * quarter * 11.96**2 * 2.0
    parts = {part["name"]: part for part in converted(tmp_path).platform["rigid_body"]["parts"]}
    assert {"column 1", "column 2", "column 3", "hub", "pontoon 2", "tower", "rotor and nacelle", "point inertia 1"} <= set(
        parts
    )
    assert [parts[f"column {i}"]["mass"] for i in (1, 2, 3)] == pytest.approx([mass] * 3, rel=1e-9)
    turned = parts["column 2"]["centre_of_mass"]
    assert turned[:2] == pytest.approx([25 * math.cos(math.radians(120)), 25 * math.sin(math.radians(120))])


def test_copies_about_the_axis_leave_a_symmetric_body(tmp_path: Path) -> None:
    parts = converted(tmp_path, lambda d: d.pop("turbine") and d["platform"].pop("additional_effects")).platform["rigid_body"][
        "parts"
    ]
    _, centre, inertia = RigidBody.model_validate({"parts": parts}).combined()
    np.testing.assert_allclose(centre[:2], 0.0, atol=1e-8)
    assert inertia[0, 0] == pytest.approx(inertia[1, 1], rel=1e-9)
    np.testing.assert_allclose(inertia - np.diag(np.diag(inertia)), 0.0, atol=1e-6 * inertia[0, 0])


def test_rotor_and_nacelle_lie_on_the_shaft(tmp_path: Path) -> None:
    """A shaft that rises by 6 deg towards the wind: q = (cos 6, 0, -sin 6); the hub, 4 m before the tower, at 60 m."""
    part = next(p for p in converted(tmp_path).platform["rigid_body"]["parts"] if p["name"] == "rotor and nacelle")
    c, s = math.cos(math.radians(6)), math.sin(math.radians(6))
    assert part["centre_of_mass"] == pytest.approx([-c, 0.0, 60.0 - 4 * s + s])
    assert part["inertia"]["Ixx"] == pytest.approx(4e6 * c**2 + 3e6 * s**2)
    assert part["inertia"]["Ixz"] == pytest.approx(-1e6 * c * s)


def test_point_inertia_keeps_its_matrix(tmp_path: Path) -> None:
    part = next(p for p in converted(tmp_path).platform["rigid_body"]["parts"] if p["name"] == "point inertia 1")
    assert part["inertia"] == {"Ixx": 1e5, "Iyy": 2e5, "Izz": 3e5, "Ixy": 10.0, "Ixz": 20.0, "Iyz": 30.0}


# ------------------------------------------------------------------------------------------- coefficients


def test_coefficients(tmp_path: Path) -> None:
    """A pontoon's first direction is vertical. A column's CaEnd is the mean over its wet bottom and ring, by volume."""
    platform = converted(tmp_path).platform
    assert platform["coefficients"]["pontoon"] == {"Ca_t": 0.6, "Ca_z": 1.4, "Cd_t": 1.5, "Cd_z": 2.2}
    bottom, ring = 12**3, 12**3 - 6**3
    assert platform["coefficients"]["column"]["Ca_z"] == pytest.approx((0.5 * bottom + 0.7 * ring) / (bottom + ring))
    assert platform["coefficients"]["column"]["Cd_z"] == 2.0
    assert platform["coefficients"]["hub"] == {"Ca_t": 0.8, "Ca_z": 0.5, "Cd_t": 0.7, "Cd_z": 2.0}
    assert platform["drag_speed"] == "component"
    assert [m["maccamy_fuchs"] for m in platform["members"] if m["shape"] == "circ"] == [False, False]


def test_members_of_equal_coefficients_share_a_group(tmp_path: Path) -> None:
    platform = converted(tmp_path, lambda d: d["platform"]["members"][2].update(CaEnd=[0.5, 0.5], name="a")).platform
    assert "group" not in platform["members"][2]
    platform = converted(tmp_path, lambda d: d["platform"]["members"][0].update(CaEnd=0.5)).platform
    assert platform["members"][2]["group"] == "column" and set(platform["coefficients"]) == {"column", "pontoon"}


def test_a_box_end_keeps_its_added_mass(tmp_path: Path) -> None:
    """RAFT: rho pi/12 ((a + b)/2)^3 CaEnd; here rho 2/3 pi r^3 Ca_z with pi r^2 = a b."""
    box = {"shape": "rect", "d": [6.0, 4.0], "CaEnd": 0.5}
    coefficients = converted(tmp_path, lambda d: d["platform"]["members"][2].update(box)).platform["coefficients"]["hub"]
    ours = coefficients["Ca_z"] * 2 / 3 * math.pi * (24 / math.pi) ** 1.5
    assert ours == pytest.approx(0.5 * math.pi / 12 * 5.0**3)


def test_treatment_of_what_the_platform_file_does_not_have(tmp_path: Path) -> None:
    def change(data: dict[str, Any]) -> None:
        data["platform"] |= {"potModMaster": 0, "hydroPath": "wamit/hull"}
        data["platform"]["members"][0] |= {"Cd": [0.7, 0.8, 0.9, 1.0], "potMod": True, "Cd_q": 0.1, "colour": "red"}
        data["platform"]["members"][1] |= {"CaEnd": 0.4, "type": "beam", "E": 2e11, "G": 8e10}

    conversion = converted(tmp_path, change)
    treatments = {item.source.removeprefix("design.yaml: "): (item.treatment, item.meaning) for item in conversion.items}
    assert treatments["platform.members[0].potMod"][0] is Treatment.APPROXIMATED
    assert treatments["platform.members[1].type"][0] is Treatment.APPROXIMATED
    for key in ("platform.members[0].Cd_q", "platform.members[0].colour", "platform.members[1].CaEnd", "platform.hydroPath"):
        assert treatments[key][0] is Treatment.LEFT_OUT, key
    assert treatments["platform.additional_effects[1]"][0] is Treatment.LEFT_OUT
    assert treatments["turbine: Fthrust"][0] is Treatment.LEFT_OUT and treatments["settings"][0] is Treatment.LEFT_OUT
    assert conversion.platform["coefficients"]["column"]["Cd_t"] == 0.75  # RAFT's first two numbers are the two directions
    assert any("first two of 4 numbers" in item.meaning for item in conversion.items)
    assert "maccamy_fuchs" not in conversion.platform["members"][0]
    assert conversion.platform["stiffness"] == {"C66": 1e6}


# ------------------------------------------------------------------------------------------------ moorings


def moorings(change: Callable[[dict[str, Any]], object] = lambda section: None) -> MooringSystem:
    section = contents()["mooring"]
    change(section)
    return MooringSection.model_validate(section).system(80.0, 1025.0)


def test_mooring_section_is_read() -> None:
    mooring = moorings(lambda s: s["points"][3].update(type="Coupled1") or s["points"][0].update(type="Anchor"))
    assert mooring.depth == 80.0 and len(mooring.points) == 6 and len(mooring.lines) == 3
    assert (
        mooring.points["fairlead1"].attachment is Attachment.PLATFORM
        and mooring.points["anchor1"].attachment is Attachment.GROUND
    )
    chain = mooring.line_types["chain"]
    assert chain.weight_in_water(1025.0, 9.81) == pytest.approx((120.0 - 1025.0 * math.pi / 4 * 0.01) * 9.81)
    assert mooring.lines["line2"].ends == ("anchor2", "fairlead2")


def test_lines_weigh_the_same_in_water_of_another_density() -> None:
    """RAFT gives the section's density to MoorPy; the platform file has the site's."""
    same_water, fresh_water = moorings(), moorings(lambda s: s.update(rho=1000.0))
    weight = fresh_water.line_types["chain"].weight_in_water(1025.0, 9.81)
    assert weight == pytest.approx(same_water.line_types["chain"].weight_in_water(1000.0, 9.81), rel=1e-12)


OC3_POINTS = [(853.87, 0.0), (-426.935, 739.47311), (-426.935, -739.47311)], [(5.2, 0.0), (-2.6, 4.5033), (-2.6, -4.5033)]


def test_linear_mooring_of_oc3_against_moorpy() -> None:
    """By `python -m benchmarks.raft_statics RAFT_FOLDER tests/test_data/OC3spar.yaml` (RAFT at e6cb69e, MoorPy 1.3.0)."""
    section: dict[str, Any] = {"water_depth": 320.0, "points": [], "lines": []}
    for i, (anchor, fairlead) in enumerate(zip(*OC3_POINTS)):
        section["points"] += [{"name": f"a{i}", "type": "fixed", "location": [*anchor, -320.0]}]
        section["points"] += [{"name": f"f{i}", "type": "vessel", "location": [*fairlead, -70.0]}]
        section["lines"] += [{"endA": f"a{i}", "endB": f"f{i}", "type": "main", "length": 902.2}]
    section["line_types"] = [{"name": "main", "diameter": 0.09, "mass_density": 77.7066, "stiffness": 384.243e6}]
    system = MooringSection.model_validate(section).system(200.0, 1025.0)
    water = SimpleNamespace(density=1025.0, depth=320.0, gravity=9.81)
    load = catenary_lines(Catenary.model_validate(catenary_section(system, 320.0, 1025.0, 9.81)), water)

    def pull(motion):
        tension, direction = load.tension(motion, rotation(motion[3:]))
        body = tension * direction
        turned = rotation(motion[3:])
        force, moment = turned @ body.sum(axis=1), turned @ cross(load.fairlead, body).sum(axis=1)
        return jnp.concatenate([force, moment])

    stiffness, preload = -np.asarray(one_program(jax.jacfwd(pull))(np.zeros(6))), np.asarray(one_program(pull)(np.zeros(6)))
    expected = {(0, 0): 4.119314e4, (1, 1): 4.119318e4, (2, 2): 1.194528e4, (3, 3): 3.108803e8, (5, 5): 1.157033e7}
    expected |= {(0, 4): -2.816249e6, (4, 0): -2.816249e6, (1, 3): 2.816252e6}
    for at, value in expected.items():
        # MoorPy's own stiffness is symmetric; the moment's change as its arm turns with a preload is not, by at most 2e-3
        assert stiffness[at] == pytest.approx(value, rel=3e-3 if at[1] > 2 else 1e-4), at
    assert preload[2] == pytest.approx(-1.607716e6, rel=1e-5)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda s: s["points"][3].update(type="free"), "the line from point anchor1 ends at point fairlead1"),
        (lambda s: s["line_types"][0].update(diameter=0.5), "lines of type chain float"),
    ],
)
def test_moorings_that_are_left_out_say_why(tmp_path: Path, change: Callable[[dict[str, Any]], object], reason: str) -> None:
    conversion = converted(tmp_path, lambda d: change(d["mooring"]))
    item = next(item for item in conversion.items if item.source.endswith(": mooring"))
    assert item.treatment is Treatment.LEFT_OUT and reason in item.meaning
    assert "mooring" not in conversion.platform


def test_mooring_of_another_file_is_left_out(tmp_path: Path) -> None:
    conversion = converted(tmp_path, lambda d: d.update(mooring={"file": "lines.dat", "water_depth": 80}))
    assert any(item.source.endswith("mooring.file") and item.treatment is Treatment.LEFT_OUT for item in conversion.items)


# -------------------------------------------------------------------------------------------- whole design


@pytest.mark.slow
def test_the_platform_file_loads_builds_and_floats_as_the_design_says(tmp_path: Path) -> None:
    conversion = converted(tmp_path)
    path = tmp_path / "platform.yaml"
    YAML().dump(conversion.platform, path)
    platform = jh.load_platform(path)
    model = jh.build(platform)
    volume = 3 * math.pi / 4 * (12**2 * 4 + 6**2 * 8) + 3 * 16 * 18.0 + math.pi / 4 * 6**2 * 12
    buoyancy = next(load for load in model.loads if isinstance(load, jh.loads.Buoyancy))
    assert buoyancy.upright(1025.0 * 9.81)["displaced_volume"] == pytest.approx(volume, rel=1e-6)
    assert float(model.environment.gravity) == 9.81
    mass = sum(part["mass"] for part in conversion.platform["rigid_body"]["parts"])
    assert float(model.body.mass) == pytest.approx(mass)
    assert model.values["mooring.line2.unstretched_length"] == 385.0
    assert all(item.source.startswith("design.yaml: ") for item in conversion.items)


# ---------------------------------------------------------------------------------------------- broken files

MEMBER = ("platform", "members", 0)


def put(path: tuple[Any, ...], value: Any) -> Callable[[dict[str, Any]], None]:
    def change(data: Any) -> None:
        for key in path[:-1]:
            data = data[key]
        if value is KeyError:
            del data[path[-1]]
        else:
            data[path[-1]] = value

    return change


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        ((*MEMBER, "d"), KeyError, "platform.members[0].d: expected a number or a list of numbers"),
        (("site", "water_depth"), KeyError, "site.water_depth: expected a number > 0, found nothing"),
        (("turbine", "mRNA"), KeyError, "turbine.mRNA: expected a number or a list of numbers, found nothing"),
        (("turbine", "hHub"), KeyError, "turbine.hHub: expected the height of the hub, found nothing"),
        (("platform",), KeyError, "platform: expected a mapping"),
        (
            (*MEMBER, "t"),
            [0.02, 0.02],
            "platform.members[0].t: expected a number, or 4 numbers for 4 stations, found 2 numbers",
        ),
        (
            (*MEMBER, "l_fill"),
            [2.0],
            "platform.members[0].l_fill: expected a number, or 3 numbers for 3 sections between stations",
        ),
        (
            (*MEMBER, "cap_t"),
            [0.1],
            "platform.members[0].cap_t: expected a number, or 3 numbers for 3 cap_stations, found 1 numbers",
        ),
        ((*MEMBER, "Ca"), [1, 2, 3], "platform.members[0].Ca: expected a number, two for two directions, or a pair"),
        ((*MEMBER, "d"), [1.0, 2.0], "platform.members[0].d: expected a diameter, or 4 of these in a list, found [1.0, 2.0]"),
        ((*MEMBER, "rho_shell"), "steel", "platform.members[0].rho_shell: expected a number >= 0, found 'steel'"),
        ((*MEMBER, "shape"), "triangle", "platform.members[0].shape: expected one of circ, rect, found 'triangle'"),
        ((*MEMBER, "t"), -0.02, "platform.members[0].t: expected thicknesses >= 0, found -0.02"),
        ((*MEMBER, "t"), 4.0, "platform.members[0].t: expected thicknesses up to half the size of the section, found 4.0"),
        (
            (*MEMBER, "l_fill"),
            [5.0, 0, 0],
            "platform.members[0].l_fill[0]: expected a fill between 0 and the length of its section, 4, found 5",
        ),
        ((*MEMBER, "cap_stations"), [-12, -8, 7.995], "platform.members[0].cap_stations[2]: expected a cap within the member"),
        ((*MEMBER, "stations"), [-12, -8, -9, 8], "platform.members[0].stations: expected numbers in ascending order"),
        ((*MEMBER, "rB"), [25, 0, -12], "platform.members[0].rB: expected an end B that is not end A"),
        (("platform", "members", 1, "name"), "column", "platform.members[1].name: expected each name once, found 'column'"),
        (
            ("mooring", "lines", 0, "type"),
            "chian",
            "mooring.lines[0].type: expected the name of a line type (chain), found 'chian'",
        ),
        (
            ("mooring", "points", 0, "type"),
            "buoy",
            "mooring.points[0].type: expected one of fixed, fairlead, free, found 'buoy'",
        ),
        (("mooring", "line_types", 0, "stiffness"), 0, "mooring.line_types[0].stiffness: expected a number > 0, found 0"),
    ],
)
def test_mistakes_are_told_with_key_expected_and_found(tmp_path: Path, path: tuple[Any, ...], value: Any, message: str) -> None:
    with pytest.raises(InputError) as error:
        converted(tmp_path, put(path, value))
    assert len(error.value.problems) == 1, str(error.value)
    assert error.value.source.endswith("design.yaml") and message in str(error.value)


def test_all_mistakes_are_told_at_once(tmp_path: Path) -> None:
    with pytest.raises(InputError) as error:
        converted(tmp_path, lambda d: (put((*MEMBER, "t"), -1.0)(d), put(("site", "g"), "9.81")(d)))
    assert {problem.where for problem in error.value.problems} == {"platform.members[0].t", "site.g"}


def test_a_farm_and_a_body_without_mass_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="expected one platform"):
        converted(tmp_path, lambda d: d.update(platforms=[d.pop("platform")]))

    def weightless(data: dict[str, Any]) -> None:
        del data["turbine"], data["platform"]["additional_effects"]
        for row in data["platform"]["members"]:
            row |= {"t": 0.0, "l_fill": 0.0, "cap_stations": []}
            row.pop("cap_t", None), row.pop("cap_d_in", None)

    with pytest.raises(InputError, match="no mass at all"):
        converted(tmp_path, weightless)


def test_a_design_is_not_changed_by_reading(tmp_path: Path) -> None:
    before = copy.deepcopy(contents())
    first, second = converted(tmp_path).platform, converted(tmp_path).platform
    assert first == second and contents() == before
