"""A platform as a RAFT design, and back by the reader of designs."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from jaxhydro.cli.export_command import source_of
from jaxhydro.hull.member import Member
from jaxhydro.interop.conversion import Treatment
from jaxhydro.interop.export_source import ExportedModel
from jaxhydro.interop.raft_design import read_raft_design
from jaxhydro.interop.raft_export_design import DESIGN, export_design
from jaxhydro.loads import Buoyancy
from jaxhydro.platform.build import build
from jaxhydro.platform.catenary_schema import Catenary
from jaxhydro.platform.computed_tables_schema import Hydrostatics
from jaxhydro.platform.members_build import members_of
from jaxhydro.platform.schema import Platform, load_platform

SAME = 1e-9
CHAIN = {"axial_stiffness": 3.27e9, "mass_per_length": 685.0, "diameter": 0.333}
LINE = {"anchor": [837.6, 0.0, -180.0], "fairlead": [58.0, 0.0, -14.0], "heading": [60.0, 180.0, 300.0]}
LINE["segments"] = [{"type": "chain", "length": 600.0}, {"type": "rope", "length": 240.0}]
CATENARIES = {
    "kind": "catenary",
    "line_types": {"chain": CHAIN, "rope": {"axial_stiffness": 1.0e9, "submerged_weight": 900.0}},
    "lines": [LINE],
    "seabed": {"depth": 180.0, "friction": 0.5},
}
BOX = {"name": "box", "shape": "rect", "d": [[8.0, 6.0], [12.0, 9.0]], "stations": [0, 1], "gamma": 20.0}
BOX |= {"rA": [30.0, 0.0, 10.0], "rB": [30.0, 0.0, -15.0], "heading": [30.0, 150.0]}


@cache
def declared(name: str) -> Platform:
    """A built-in platform; `catenary`: one with lines, an upright box that runs down, and much that RAFT has not."""
    if name != "catenary":
        return load_platform(name)
    raw = load_platform("volturnus-s").model_dump(exclude_unset=True)
    raw |= {"mooring": CATENARIES, "quadratic_damping": {"B33": 5.0e6}, "hydrostatics": {}}
    raw["members"] = [*raw["members"], BOX]
    raw["coefficients"]["box"] = {"Ca_t": 0.9, "Ca_z": 0.7, "Cd_t": 1.3, "Cd_z": 2.1}
    raw["coefficients"]["column"]["drag_z"] = {"law": "high_pass", "cutoff": 0.05, "low_share": 0.4}
    return Platform.model_validate(raw)


@cache
def exported(name: str) -> ExportedModel:
    return export_design(source_of(declared(name), build(declared(name))))


def said(name: str, source: str, treatment: Treatment) -> str:
    return " ".join(item.meaning for item in exported(name).items if source in item.source and item.treatment is treatment)


def read_back(name: str, folder: Path) -> Platform:
    (folder / DESIGN).write_text(exported(name).texts[DESIGN], encoding="utf-8")
    return Platform.model_validate(read_raft_design(folder / DESIGN).platform)


def by_ends(members: list[Member]) -> list[tuple[np.ndarray, np.ndarray, np.ndarray, Member]]:
    """Ends, the lower one first for columns, and sizes at their stations along x, y or both directions."""
    rows = []
    for member in members:
        turn = member.column and member.a[2] > member.b[2]
        ends = np.stack([member.b, member.a] if turn else [member.a, member.b])
        stations, sizes = (1 - member.stations[::-1], member.sizes[::-1]) if turn else (member.stations, member.sizes)
        rows.append((ends, stations, sizes, member))
    return rows


@pytest.mark.parametrize("name", ["volturnus-s", "oc4-deepcwind", pytest.param("catenary", marks=pytest.mark.slow)])
def test_mass_members_and_coefficients_come_back(name: str, tmp_path: Path) -> None:
    before, after = declared(name), read_back(name, tmp_path)
    for written, read in zip(before.rigid_body.combined(), after.rigid_body.combined(), strict=True):
        assert np.abs(np.asarray(read) - written).max() <= SAME * np.abs(written).max()
    assert after.water == before.water
    for written, read in zip(by_ends(members_of(before)), by_ends(members_of(after)), strict=True):
        for k in range(3):
            assert read[k] == pytest.approx(written[k], rel=SAME, abs=1e-8)
        for ours, read_direction in zip(written[3].directions, read[3].directions, strict=True):
            assert read_direction == pytest.approx(ours, abs=SAME)
        own, returned = (p.coefficients[m.group].numbers() for p, m in ((before, written[3]), (after, read[3])))
        assert returned == pytest.approx(own, rel=SAME)
        assert bool(read[3].diffracts) == bool(written[3].diffracts)
    bare = [build(p.model_copy(update={"hydrostatics": Hydrostatics()})) for p in (before, after)]
    written, read = (next(load for load in model.loads if isinstance(load, Buoyancy)).upright(1.0) for model in bare)
    for key in ("displaced_volume", "centre_of_buoyancy", "C33", "C44", "C55"):
        assert read[key] == pytest.approx(written[key], rel=SAME), key


@pytest.mark.slow
def test_catenaries_come_back(tmp_path: Path) -> None:
    before, after = declared("catenary"), read_back("catenary", tmp_path)
    written, read, water = before.mooring, after.mooring, before.water
    assert isinstance(written, Catenary) and isinstance(read, Catenary)
    assert read.seabed.depth == 180.0
    for kind, line in written.line_types.items():
        weight = line.weight(water.density, water.gravity)
        assert read.line_types[kind].weight(water.density, water.gravity) == pytest.approx(weight, rel=SAME)
        assert read.line_types[kind].axial_stiffness == pytest.approx(line.axial_stiffness, rel=SAME)
    ends = [np.concatenate(copy) for line in written.lines for copy in line.copies()]
    assert np.array([[*line.anchor, *line.fairlead] for line in read.lines]) == pytest.approx(
        np.array(ends), rel=SAME, abs=1e-8
    )
    assert all([(s.type, s.length) for s in line.segments] == [("chain", 600.0), ("rope", 240.0)] for line in read.lines)


def test_what_raft_cannot_have_is_named_with_its_value() -> None:
    assert "quadratic_damping.B33 = 5e+06" in said("catenary", "quadratic_damping", Treatment.LEFT_OUT)
    assert "linear_damping.B44 = 3.63e+08" in said("catenary", "linear_damping", Treatment.LEFT_OUT)
    assert "cutoff 0.05" in said("catenary", "column.drag_z", Treatment.LEFT_OUT)
    assert "0.5" in said("catenary", "seabed.friction", Treatment.LEFT_OUT)
    assert "9.80665" in said("catenary", "mooring.line_types", Treatment.APPROXIMATED)
    dropped = next(item for item in exported("volturnus-s").items if item.source == "mooring.stiffness")
    assert dropped.warning and "mooring.C11 = 7.19e+04 N/m" in dropped.meaning and "C66" not in dropped.meaning
    assert "ends of the section exchanged" in said("catenary", "members: d, box", Treatment.APPROXIMATED)
    assert "no waterplane" in said("iti-barge", "members: buoyancy", Treatment.LEFT_OUT)


def test_numbers_as_raft_defines_them() -> None:
    """Read by PyYAML as RAFT reads it. By hand: a pontoon's Cd is [Cd_z, Cd_t]; the load is buoyancy less weight."""
    design: dict[str, Any] = yaml.safe_load(exported("volturnus-s").texts[DESIGN])
    platform = design["platform"]
    pontoon = next(entry for entry in platform["members"] if entry["name"] == "pontoon")
    assert pontoon["Cd"] == [[4.96, 1.84]] * 2 and pontoon["Ca"] == [[1.87, 0.11]] * 2 and pontoon["CdEnd"] == 0.0
    assert platform["yaw_stiffness"] == 2.524e8
    volume = np.pi / 4 * 20 * (10.0**2 + 3 * 12.5**2) + 3 * 40.5 * 12.5 * 7.0
    load = next(entry for entry in platform["additional_effects"] if entry["type"] == "mean_load")["load"]
    assert load[2] == pytest.approx((20093000.0 - 1025.0 * volume) * 9.80665, abs=1.0)


def test_drag_of_an_upright_box_is_the_same_force() -> None:
    """RAFT: along its first side 1/2 rho Cd side[0] length; here the side across the flow is side[1]."""
    members = yaml.safe_load(exported("catenary").texts[DESIGN])["platform"]["members"]
    box = next(member for member in members if member["name"] == "box")
    assert box["rA"][2] < box["rB"][2] and box["d"] == [[12.0, 9.0], [8.0, 6.0]] and box["gamma"] == 20.0
    drag = np.array(box["Cd"]) * np.array(box["d"])
    assert drag == pytest.approx(1.3 * np.array(box["d"])[:, ::-1], rel=SAME)


def test_springs_are_lines_of_next_to_no_weight() -> None:
    raw = declared("volturnus-s").model_dump(exclude_unset=True)
    line = {"anchor": [150.0, 0.0, -10.0], "fairlead": [50.0, 0.0, -10.0], "stiffness": 5.0e4, "pretension": 1.0e6}
    raw["mooring"] = {"kind": "linear_springs", "lines": [line]}
    platform = Platform.model_validate(raw)
    section = yaml.safe_load(export_design(source_of(platform, build(platform))).texts[DESIGN])["mooring"]
    (kind,), (spring,) = section["line_types"], section["lines"]
    assert spring["length"] == 80.0 and kind["stiffness"] == 4.0e6
    assert kind["mass_density"] * 9.81 * 80.0 == pytest.approx(1e-9 * 4.0e6)
    assert [point["type"] for point in section["points"]] == ["fixed", "vessel"]


def test_an_end_at_still_water_and_covered_ends() -> None:
    """A column that ends at z = 0 on a wider one: RAFT takes no end there, and the ring is what is free of the wider end."""
    raw = declared("volturnus-s").model_dump(exclude_unset=True)
    low = {"name": "low", "group": "column", "shape": "circ", "d": 10.0, "rA": [0, 0, -20], "rB": [0, 0, -10]}
    top = {"name": "top", "group": "column", "shape": "circ", "d": 6.0, "rA": [0, 0, -10], "rB": [0, 0, 0]}
    raw["members"] = [low, top, *raw["members"][1:]]
    platform = Platform.model_validate(raw)
    design = export_design(source_of(platform, build(platform)))
    members = {part["name"]: part for part in yaml.safe_load(design.texts[DESIGN])["platform"]["members"]}
    assert members["top"]["rB"] == [0.0, 0.0, 0.001]
    assert members["top"]["CdEnd"] == pytest.approx([0.0, 2.23])
    assert members["low"]["CdEnd"] == pytest.approx([2.23, 2.23 * (1 - 0.36)])
    assert members["low"]["CaEnd"] == pytest.approx([0.12, 0.12 * (1 - 0.216)])
    assert any("z = 0" in part.meaning for part in design.items)
