"""Mooring systems of other programs as the platform file's catenaries."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from one_program import one_program

from jaxhydro.interop.mooring_system import (
    Attachment,
    LineType,
    MooringLine,
    MooringPoint,
    MooringSystem,
    NoCatenaries,
    catenary_section,
)
from jaxhydro.loads import CatenaryLines
from jaxhydro.platform.catenary_build import catenary_lines
from jaxhydro.platform.catenary_schema import Catenary

DEPTH, DENSITY, GRAVITY = 200.0, 1025.0, 9.81
POINTS = [
    MooringPoint("anchor", Attachment.GROUND, (-800.0, 0.0, -200.0)),
    MooringPoint("link", Attachment.FREE, (-400.0, 0.0, -190.0)),
    MooringPoint("fairlead", Attachment.PLATFORM, (-50.0, 0.0, -14.0)),
    MooringPoint("other", Attachment.PLATFORM, (50.0, 0.0, -14.0)),
]
TYPES = [LineType("chain", 0.3, 600.0, 3e9), LineType("rope", 0.0, 50.0, 3e8)]
LINES = [MooringLine("low", ("link", "anchor"), 420.0, "chain"), MooringLine("high", ("link", "fairlead"), 400.0, "rope")]


def system(points=POINTS, types=TYPES, lines=LINES, depth=DEPTH) -> MooringSystem:
    return MooringSystem(depth, *({named.name: named for named in parts} for parts in (points, types, lines)))


def section(mooring: MooringSystem) -> dict:
    return catenary_section(mooring, DEPTH, DENSITY, GRAVITY)


def test_parts_between_free_points_are_segments_from_the_anchor() -> None:
    written = section(system())
    (line,) = written["lines"]
    assert line["anchor"] == [-800.0, 0.0, -200.0] and line["fairlead"] == [-50.0, 0.0, -14.0]
    assert line["segments"] == [{"type": "chain", "length": 420.0}, {"type": "rope", "length": 400.0}]
    assert written["line_types"]["chain"] == {"axial_stiffness": 3e9, "mass_per_length": 600.0, "diameter": 0.3}
    assert written["line_types"]["rope"]["submerged_weight"] == pytest.approx(50.0 * GRAVITY)


def test_a_seabed_that_is_not_the_waters_is_stated() -> None:
    assert "seabed" not in section(system())
    assert section(system(depth=210.0))["seabed"] == {"depth": 210.0}


def test_it_is_a_mooring_of_the_platform_file() -> None:
    """OC3's line: tension and pull as MoorPy 1.3.0 has them (tests/data/catenary-moorpy.json has more)."""
    points = [
        MooringPoint("a", Attachment.GROUND, (853.87, 0.0, -320.0)),
        MooringPoint("f", Attachment.PLATFORM, (5.2, 0.0, -70.0)),
    ]
    oc3 = system(points, [LineType("main", 0.09, 77.7066, 384.243e6)], [MooringLine("1", ("a", "f"), 902.2, "main")], 320.0)
    made = Catenary.model_validate(catenary_section(oc3, DEPTH, DENSITY, GRAVITY))
    load = catenary_lines(made, SimpleNamespace(density=DENSITY, depth=DEPTH, gravity=GRAVITY))
    tension, direction = map(np.asarray, one_program(CatenaryLines.tension)(load, np.zeros(6), np.eye(3)))
    assert float(tension[0]) == pytest.approx(911.4e3, rel=1e-4)
    assert float(3 * tension[0] * direction[2, 0]) == pytest.approx(-1.607716e6, rel=1e-5)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"points": [*POINTS[:1], replace(POINTS[1], mass=1e4), *POINTS[2:]]}, "point link between two lines has a mass"),
        ({"types": [TYPES[0], replace(TYPES[1], diameter=0.3)]}, "lines of type rope float"),
        ({"lines": LINES[:1]}, "line from point anchor ends at point link"),
        ({"lines": LINES[1:]}, "line high does not run from the ground"),
        (
            {"lines": [*LINES, MooringLine("bridle", ("link", "other"), 400.0, "rope")]},
            "line from point anchor ends at point link",
        ),
        (
            {"points": [*POINTS[:2], replace(POINTS[2], attachment=Attachment.OTHER)]},
            "line from point anchor ends at point fairlead",
        ),
    ],
)
def test_what_the_platform_file_cannot_have_is_told(change, reason) -> None:
    with pytest.raises(NoCatenaries, match=reason):
        section(system(**change))
