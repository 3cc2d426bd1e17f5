"""The platform file: good ones load and mean what they say, each mistake is told in one line."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from ruamel.yaml import YAML

from jaxhydro.errors import MAX_PRINTED_PROBLEMS, InputError
from jaxhydro.input_schema import read_yaml, validate
from jaxhydro.platform.catenary_schema import Catenary
from jaxhydro.platform.mooring_schema import Line, LinearSprings, StiffnessMatrix
from jaxhydro.platform.schema import Member, Platform, RigidBody, builtin_platforms, load_platform

SHARED = Path(__file__).parents[2].parent / "shared"
GOOD = """
name: VolturnUS-S
water: {density: 1025.0, depth: 200.0}
rigid_body:
  mass: 20054283.0
  centre_of_mass: [0.0, 0.0, -2.4]
  inertia: {Ixx: 4.42e10, Iyy: 4.42e10, Izz: 2.40e10}
members:
  - name: outer_column
    group: column
    shape: circ
    d: 12.5
    rA: [51.75, 0, -20]
    rB: [51.75, 0, 15]
    heading: [60, 180, 300]
    elements: 3
    maccamy_fuchs: true
  - {name: pontoon, shape: rect, d: [12.5, 7.0], rA: [5, 0, -16.5], rB: [45.5, 0, -16.5], heading: 60}
coefficients:
  column:  {Ca_t: 1.0, Ca_z: 0.5, Cd_t: 1.0, Cd_z: 2.0}
  pontoon: {Ca_t: 0.5, Ca_z: 1.5, Cd_t: 1.5, Cd_z: 3.0}
linear_damping: {B11: 5e4, B33: 2.0e+5, B55: 3.0e8}
mooring:
  kind: linear_springs
  lines:
    - {anchor: [150.0, 259.808, -14.0], fairlead: [29.0, 50.229, -14.0], stiffness: 45000.0, pretension: 1500000.0}
    - {anchor: [-300, 0, -14], fairlead: [-58, 0, -14], axial_stiffness: 33862500.0, unstretched_length: 268.75}
added_mass: {A44: 20.0}
quadratic_damping: {B44: 5.0}
stiffness: {C11: 0.0}
hydrostatics: {displaced_volume: 20206.0, C33: 4.45e6, C44_buoyancy: 2.19e9}
"""


def document() -> dict[str, Any]:
    return YAML(typ="safe", pure=True).load(GOOD)


def told(data: Any) -> InputError:
    with pytest.raises(InputError) as caught:
        validate(Platform, data, "platform.yaml")
    return caught.value


def put(data: Any, path: str, value: Any) -> None:
    """Set `value` at a path like `members.0.d`; `...` deletes."""
    *parents, last = [int(key) if key.isdigit() else key for key in path.split(".")]
    for key in parents:
        data = data[key]
    if value is ...:
        del data[last]
    else:
        data[last] = value


# --- good files


def test_contract_example_loads(tmp_path: Path) -> None:
    file = tmp_path / "platform.yaml"
    file.write_text(GOOD)
    platform = load_platform(file)
    assert platform.water.gravity == 9.80665
    assert platform.members[0].heading == (60.0, 180.0, 300.0)
    assert platform.members[1].heading == (60.0,)
    assert platform.members[1].group == "pontoon"
    assert platform.linear_damping.matrix()[0, 0] == 5e4
    assert platform.linear_damping.matrix()[2, 2] == 2e5
    assert platform.quadratic_damping.matrix()[3, 3] == 5.0
    assert platform.wetting == "instantaneous"
    assert platform.drag_speed == "vector"
    assert isinstance(platform.mooring, LinearSprings)
    assert platform.mooring.lines[1].spring() == (33862500.0 / 268.75, 268.75)


@pytest.mark.parametrize(
    "folder",
    ["measured/focal-c2", "measured/focal-c4", "measured/kvlcc2", "campaigns/with-umbilical"],
)
def test_shared_files_load(folder: str) -> None:
    file = SHARED / folder / "platform.yaml"
    if not file.exists():
        pytest.skip(f"{file} is not part of the project")
    assert load_platform(file).rigid_body.combined()[0] > 0.0


# relative, of weight and lines: mass, lines and geometry of these hulls are from several public sources
# of the tendons of the MIT/NREL TLP, their own weight, 0.5 %, is left out
IN_BALANCE = {"iti-barge": 0.035, "mit-nrel-tlp": 0.011, "oc3-hywind": 1e-3, "oc4-deepcwind": 1e-3}


@pytest.mark.parametrize("name", builtin_platforms())
def test_built_in_platforms_load_and_float(name: str) -> None:
    platform = load_platform(name)
    mass = platform.rigid_body.combined()[0]
    volume = sum(submerged_volume(member) for member in platform.members)
    weight = mass * platform.water.gravity
    if isinstance(platform.mooring, StiffnessMatrix):
        volume = platform.hydrostatics.displaced_volume or volume
        weight -= platform.mooring.preload[2]
    if isinstance(platform.mooring, Catenary):  # vertical tendons
        for line in platform.mooring.lines:
            axial = platform.mooring.line_types[line.segments[0].type].axial_stiffness
            weight += len(line.heading) * axial * (line.distance() / line.length() - 1.0)
    assert platform.water.density * platform.water.gravity * volume == pytest.approx(weight, rel=IN_BALANCE.get(name, 1e-8))


def submerged_volume(member: Member) -> float:
    """Volume under still water (m3), by slices across the member."""
    stations, sizes = member.profile()
    bottom, top = np.array(member.rA), np.array(member.rB)
    edges = np.unique([*np.linspace(0, 1, 2001), *stations, np.clip(bottom[2] / (bottom[2] - top[2] or 1.0), 0, 1)])
    middle, length = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges) * np.linalg.norm(top - bottom)
    width, height = (np.interp(middle, stations, sizes[:, i]) for i in range(2))
    depth = -(bottom[2] + middle * (top[2] - bottom[2]))
    if bottom[2] == top[2]:  # a level box, wet to still water
        height = np.clip(0.5 * height + depth, 0.0, height)
        depth = height
    area = np.pi / 4.0 * width**2 if member.shape == "circ" else width * height
    return float(np.where(depth > 0, area, 0.0) @ length) * len(member.heading)


def test_built_in_platforms_are_the_published_hull() -> None:
    kinds = ("iti-barge", "mit-nrel-tlp", "oc3-hywind", "oc3-monopile", "oc4-deepcwind", "ship-section")
    kinds = (*kinds, "volturnus-s", "volturnus-s-focal")
    assert builtin_platforms() == kinds
    platform = load_platform("VolturnUS-S")
    mass, centre, inertia = platform.rigid_body.combined()
    assert mass == 20093e3
    assert inertia[1, 1] + mass * centre[2] ** 2 == pytest.approx(4.26e10, rel=1e-5)
    assert isinstance(platform.mooring, StiffnessMatrix)
    stiffness = platform.mooring.matrix()
    assert stiffness[4, 0] == stiffness[0, 4] == -stiffness[3, 1] == -stiffness[1, 3] == 1.144e6
    springs = load_platform("volturnus-s-focal").mooring
    assert isinstance(springs, LinearSprings)
    for line in springs.lines:
        stiffness_, length = line.spring()
        assert stiffness_ * (242.0 - length) == pytest.approx(1.5e6, rel=1e-6)


def test_numbers_are_read_however_they_are_written(tmp_path: Path) -> None:
    file = tmp_path / "numbers.yaml"
    file.write_text("a: [1e6, 1E6, 1.0e+6, 1.e6, +1e6, 1000000, 1_000_000, 100000000e-2]\nno: yes\n")
    assert read_yaml(file) == {"a": [1e6] * 8, "no": "yes"}


# --- what the values mean


def test_parts_are_put_together() -> None:
    part = {"name": "a", "mass": 3.0, "centre_of_mass": [0, 0, 1]}
    own = {"Ixx": 1, "Iyy": 2, "Izz": 2, "Iyz": 0.5}
    second = {"name": "b", "mass": 1.0, "centre_of_mass": [0, 4, 1], "inertia": own}
    third = {**second, "centre_of_mass": [0, 4, 5]}
    mass, centre, inertia = RigidBody.model_validate({"parts": [part, second, third]}).combined()
    assert mass == 5.0
    np.testing.assert_allclose(centre, [0.0, 1.6, 1.8])
    points = np.array([[0, 0, 1], [0, 4, 1], [0, 4, 5]]) - centre
    expected = 2 * np.array([[1, 0, 0], [0, 2, 0.5], [0, 0.5, 2]])
    for m, r in zip([3.0, 1.0, 1.0], points):
        expected += m * (r @ r * np.eye(3) - np.outer(r, r))
    np.testing.assert_allclose(inertia, expected)


def test_products_of_inertia_stand_in_the_matrix_as_given() -> None:
    body = RigidBody.model_validate(
        {"mass": 1, "centre_of_mass": [0, 0, 0], "inertia": {"Ixx": 5, "Iyy": 5, "Izz": 5, "Ixy": 0.1, "Ixz": -0.2}}
    )
    np.testing.assert_array_equal(body.combined()[2], [[5, 0.1, -0.2], [0.1, 5, 0], [-0.2, 0, 5]])


def test_entries_mirror_only_what_is_left_out() -> None:
    data = document()
    data["added_mass"] = {"A15": -2.0, "A24": 1.0, "A42": 3.0}
    matrix = validate(Platform, data, "").added_mass.matrix()
    assert (matrix[0, 4], matrix[4, 0], matrix[1, 3], matrix[3, 1]) == (-2.0, -2.0, 1.0, 3.0)


def test_a_stiffness_matrix_is_rows_or_entries() -> None:
    data = document()
    rows = np.diag([1.0, 2, 3, 4, 5, 6])
    data["mooring"] = {"kind": "stiffness_matrix", "stiffness": rows.tolist(), "preload": [1, 0, 0, 0, 0, 0]}
    by_rows = validate(Platform, data, "").mooring
    data["mooring"]["stiffness"] = {f"C{i}{i}": i for i in range(1, 7)}
    by_entries = validate(Platform, data, "").mooring
    assert isinstance(by_rows, StiffnessMatrix)
    assert isinstance(by_entries, StiffnessMatrix)
    np.testing.assert_array_equal(by_rows.matrix(), rows)
    np.testing.assert_array_equal(by_entries.matrix(), rows)


def test_profiles() -> None:
    def member(**keys: Any) -> Member:
        return Member.model_validate({"name": "m", "rA": [0, 0, -9], "rB": [0, 0, 3], **keys})

    def check(m: Member, stations: list[float], sizes: list[list[float]]) -> None:
        np.testing.assert_allclose(m.profile()[0], stations)
        np.testing.assert_allclose(m.profile()[1], sizes)

    check(member(shape="circular", d=2), [0, 1], [[2, 2], [2, 2]])
    check(member(shape="circ", d=2, stations=[0, 35]), [0, 1], [[2, 2], [2, 2]])
    check(member(shape="circ", d=[2, 2, 4], stations=[-9, -6, 3]), [0, 0.25, 1], [[2, 2], [2, 2], [4, 4]])
    check(member(shape="rectangular", d=[2, 3], stations=[0, 1]), [0, 1], [[2, 3], [2, 3]])
    check(member(shape="rect", d=[[2, 3], [4, 5]], stations=[0, 1]), [0, 1], [[2, 3], [4, 5]])


def test_a_line_is_at_its_pretension_at_rest() -> None:
    line = Line.model_validate({"anchor": [0, 0, 0], "fairlead": [3, 4, 0], "stiffness": 2.0, "pretension": 1.0})
    assert line.spring() == (2.0, 4.5)
    assert line.spring(10.0) == (2.0, 9.5)


POINT = {"name": "a", "mass": 1, "centre_of_mass": [0, 0, 0]}
ZEROS = [[0] * 6] * 5
MATRIX = {"kind": "stiffness_matrix"}

# --- bad files: path of the value to change, the value (... deletes), and what the one line must hold

BROKEN: list[tuple[str, Any, str]] = [
    ("name", ..., "name: expected text, found nothing"),
    ("name", 2020, "name: expected text, found 2020 ... quotes"),
    ("name", "", "name: expected text that is not empty"),
    ("moring", {}, "moring: expected a known key ... Did you mean 'mooring'?"),
    ("water", ..., "water: expected a mapping with the keys density, depth, gravity, current, found nothing"),
    ("water", None, "water: expected a mapping ... found nothing"),
    ("water.density", True, "water.density: expected a number > 0, found true"),
    ("water.density", "1025", "water.density: expected a number > 0, found '1025' ... without quotes"),
    ("water.density", float("nan"), "water.density: expected a finite number > 0, found nan"),
    ("water.depth", float("inf"), "water.depth: expected a finite number > 0, found inf"),
    ("water.depth", -200.0, "water.depth: expected a number > 0, found -200.0"),
    ("water.gravity", 0, "water.gravity: expected a number > 0, found 0"),
    ("water.dpeth", 200.0, "water.dpeth: expected a known key ... found 'dpeth' ... Did you mean 'depth'?"),
    ("rigid_body.mass", ..., "rigid_body.mass: expected a number > 0, found nothing"),
    ("rigid_body.masss", 1.0, "rigid_body.masss: expected a known key ... Did you mean 'mass'?"),
    ("rigid_body", {}, "rigid_body: expected mass, centre_of_mass and inertia, or parts, found neither"),
    ("rigid_body.parts", [POINT], "rigid_body.mass: expected either parts"),
    ("rigid_body", {"parts": []}, "rigid_body.parts: expected a list of mappings ... 1 or more"),
    ("rigid_body", {"parts": [POINT]}, "parts: expected a positive definite"),
    ("rigid_body.inertia.Ixy", 1e11, "rigid_body.inertia: expected a positive definite inertia matrix ... -5.58e+10"),
    ("rigid_body.inertia.Izz", 9e10, "rigid_body.inertia: expected principal moments ... 9e+10"),
    ("rigid_body.centre_of_mass", [0, 0], "rigid_body.centre_of_mass: expected a list of 3 numbers, found [0, 0]"),
    ("rigid_body.centre_of_mass", {"z": 1}, "rigid_body.centre_of_mass: expected a list of 3 numbers, found {'z': 1}"),
    ("members", {"name": "a"}, "members: expected a list of mappings"),
    ("members.0", "column", "members[0]: expected a mapping with the keys name, group"),
    ("members.0.name", ..., "members[0].name: expected text, found nothing"),
    ("members.0.t", 0.05, "members[0].t: expected a known key ... found 't'"),
    ("members.0.shape", "square", "members[0].shape: expected one of circ, rect, found 'square'"),
    ("members.0.shape", "cirk", "members[0].shape: expected one of circ, rect ... Did you mean 'circ'?"),
    ("members.0.d", "abc", "members[0].d: expected a number > 0, found 'abc'"),
    ("members.0.d", ..., "members[0].d: expected a number > 0 or a list ... found nothing"),
    ("members.0.d", [], "members[0].d: expected a list of numbers > 0 (1 or more), found []"),
    ("members.0.d", [12.5, 0.0], "members[0].d[1]: expected a number > 0, found 0.0"),
    ("members.0.d", [12.5, 10.0], "members[0].d: expected a diameter, or `stations` with this list"),
    ("members.1.d", 7.0, "members[1].d: expected [width, height] ... found 7.0"),
    ("members.1.d", [[12.5, 7.0], [12.5]], "members[1].d[1]: expected a list of 2 numbers > 0, found [12.5]"),
    ("members.1.d", [[12.5, 7.0], [12.5, 6.0]], "members[1].d: expected [width, height], or `stations`"),
    ("members.0.stations", [0, 35, 30], "members[0].stations: expected numbers in ascending order"),
    ("members.0.stations", [0], "members[0].stations: expected a list of numbers (2 or more), found [0]"),
    ("members.0.rA", [51.75, 0, 15], "members[0].rB: expected an end B that is not end A, found [51.75, 0.0, 15.0]"),
    ("members.0.rA", [51.75, 0, -201], "members[0].rA: expected a point above the sea bed ... found z = -201 m"),
    ("members.0.rA", [51.75, 0, "x"], "members[0].rA[2]: expected a number, found 'x'"),
    ("members.0.rA", [51.75, 0, float("-inf")], "members[0].rA[2]: expected a finite number, found -inf"),
    ("members.0.heading", "north", "members[0].heading: expected a number, found 'north'"),
    ("members.0.heading", [60, None], "members[0].heading[1]: expected a number, found nothing"),
    ("members.0.heading", [], "members[0].heading: expected a list of numbers (1 or more)"),
    ("members.0.elements", 2.5, "members[0].elements: expected a whole number >= 1 ... found 2.5"),
    ("members.0.elements", 0, "members[0].elements: expected a whole number >= 1 ... found 0"),
    ("members.0.points", 0, "members[0].points: expected a whole number >= 1 ... found 0"),
    ("members.1.points", 1, "members[1].points: expected `elements` with it, found none"),
    ("members.0.maccamy_fuchs", "yes", "members[0].maccamy_fuchs: expected true or false, found 'yes'"),
    ("members.1.maccamy_fuchs", True, "members[1].maccamy_fuchs: expected false for a rectangular member"),
    ("members.0.group", "colum", "members[0].group: expected a group of ... (column, pontoon) ... mean 'column'?"),
    ("members.1.name", "x", "members[1].group: expected a group of `coefficients` ... found 'x'"),
    ("coefficients.colum", {}, "coefficients.colum: expected a group that members ... Did you mean 'column'?"),
    ("coefficients.column", None, "coefficients.column: expected a mapping with the keys Ca_t ... found nothing"),
    ("coefficients.column.Cd_t", -1.0, "coefficients.column.Cd_t: expected a number >= 0, found -1.0"),
    ("coefficients.column.cdt", 1.0, "coefficients.column.cdt: expected a known key ... Did you mean 'Cd_t'?"),
    ("linear_damping.B17", 1.0, "linear_damping.B17: expected a key among the entries B11 to B66, found 'B17'"),
    ("linear_damping.C11", 1.0, "linear_damping.C11: expected a key among the entries B11 to B66"),
    ("linear_damping.B11", -1.0, "linear_damping.B11: expected a number >= 0, found -1.0"),
    ("linear_damping.B11", [1.0], "linear_damping.B11: expected a number, found [1.0]"),
    ("quadratic_damping", {"B15": 1.0}, "quadratic_damping.B15: expected a key among the diagonal entries"),
    ("added_mass", 5.0, "added_mass: expected a mapping, found 5.0"),
    ("mooring", "none", "mooring: expected a mapping with `kind` ... found 'none'"),
    (
        "mooring.kind",
        ...,
        "mooring.kind: expected one of none, linear_springs, catenary, tension_table, stiffness_matrix, found nothing",
    ),
    ("mooring.kind", "linear_spring", "mooring.kind: expected one of ... Did you mean 'linear_springs'?"),
    ("mooring.lines", [], "mooring.lines: expected a list of mappings (1 or more), found []"),
    ("mooring.lines.0.pretension", ..., "mooring.lines[0].pretension: expected a number, since stiffness is given"),
    ("mooring.lines.0.axial_stiffness", 1.0, "mooring.lines[0]: expected either stiffness and pretension, or"),
    ("mooring.lines.0", {"anchor": [1, 0, 0], "fairlead": [0, 0, 0]}, "lines[0]: expected either ... found neither"),
    ("mooring.lines.1.fairlead", [-300, 0, -14], "mooring.lines[1].fairlead: expected a point that is not the anchor"),
    ("mooring", MATRIX, "mooring.stiffness: expected 6 rows of 6 numbers, or entries C11 to C66"),
    ("mooring", {**MATRIX, "stiffness": ZEROS}, "mooring.stiffness: expected 6 rows of 6 numbers"),
    ("mooring", {**MATRIX, "stiffness": [*ZEROS, [1]]}, "mooring.stiffness[5]: expected a list of 6"),
    ("mooring", {**MATRIX, "stiffness": {"C70": 1}}, "mooring.stiffness.C70: expected a key among"),
    ("mooring", {**MATRIX, "stiffness": {}, "preload": [1]}, "mooring.preload: expected a list of 6 numbers"),
    ("mooring", {"kind": "none", "lines": []}, "mooring.lines: expected a known key (kind)"),
    ("hydrostatics.C44", 1.0, "hydrostatics.C44: expected either C44 or C44_buoyancy, found both"),
    ("hydrostatics.C33", -1.0, "hydrostatics.C33: expected a number >= 0, found -1.0"),
    ("wetting", "dry", "wetting: expected one of mean, instantaneous, found 'dry'"),
    ("drag_speed", "vectors", "drag_speed: expected one of vector, component ... Did you mean 'vector'?"),
]


@pytest.mark.parametrize(("path", "value", "words"), BROKEN, ids=[f"{i}-{row[0]}" for i, row in enumerate(BROKEN)])
def test_one_mistake_is_one_line(path: str, value: Any, words: str) -> None:
    data = document()
    put(data, path, value)
    error = told(data)
    assert len(error.problems) == 1, str(error)
    assert str(error).startswith("platform.yaml: ")
    assert "\n" not in str(error)
    for word in words.split(" ... "):
        assert word in str(error)


def test_a_misspelt_required_key_is_one_mistake() -> None:
    for path, wrong in (("water.depth", "dpeth"), ("members.0.rA", "ra"), ("rigid_body.mass", "masss")):
        data = document()
        put(data, path, ...)
        put(data, f"{path.rpartition('.')[0]}.{wrong}", 1.0)
        assert len(told(data).problems) == 1
        assert f"Did you mean '{path.rpartition('.')[2]}'?" in str(told(data))


def test_every_mistake_is_told_at_once() -> None:
    data = document()
    put(data, "water.depth", "deep")
    put(data, "members.0.rB", [1])
    put(data, "members.1.d", -1)
    put(data, "mooring.lines.1.anchr", 1)
    put(data, "linear_damping.B99", 1)
    error = told(data)
    places = ["water.depth", "members[0].rB", "members[1].d", "linear_damping.B99", "mooring.lines[1].anchr"]
    assert [problem.where for problem in error.problems] == places
    lines = str(error).splitlines()
    assert lines[:2] == ["platform.yaml: 5 problems", "  water.depth: expected a number > 0, found 'deep'"]
    assert len(lines) == 6


def test_many_mistakes_are_counted_not_printed() -> None:
    error = told({**document(), "members": ["x"] * 100})
    assert len(error.problems) == 100
    assert len(str(error).splitlines()) == MAX_PRINTED_PROBLEMS + 2
    assert str(error).endswith("and 80 more")


def test_a_mistake_between_sections_is_told_beside_another() -> None:
    data = document()
    put(data, "members.0.rA", [0, 0, -300])
    put(data, "coefficients.hull", {})
    assert [p.where for p in told(data).problems] == ["members[0].rA", "coefficients.hull"]
