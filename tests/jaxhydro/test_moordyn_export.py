"""MoorDyn's file of a platform's catenaries, and back by the reader of MoorDyn files."""

from pathlib import Path

import numpy as np
import pytest
from test_openfast_export import with_catenaries

from jaxhydro.cli.export_command import source_of
from jaxhydro.errors import InputError
from jaxhydro.interop.conversion import Treatment
from jaxhydro.interop.mooring_system import catenary_section
from jaxhydro.interop.openfast.export_moordyn import ALONE, export_lines
from jaxhydro.interop.openfast.moordyn_file import read_mooring_system
from jaxhydro.interop.openfast.open_file import read_keyed_file
from jaxhydro.platform.build import build
from jaxhydro.platform.catenary_schema import Catenary
from jaxhydro.platform.schema import load_platform


def test_lines_come_back(tmp_path: Path) -> None:
    platform = with_catenaries()
    original, water = platform.mooring, platform.water
    assert isinstance(original, Catenary)
    exported = export_lines(source_of(platform, build(platform)))
    path = tmp_path / ALONE
    path.write_text(exported.texts[ALONE], encoding="utf-8")
    system, remarks = read_mooring_system(read_keyed_file(path, "MoorDyn"), 0.0, water.depth)
    assert not remarks and system.depth == 180.0
    read = Catenary.model_validate(catenary_section(system, water.depth, water.density, water.gravity))
    for kind, line_type in original.line_types.items():
        weight = line_type.weight(water.density, water.gravity)
        assert read.line_types[kind].weight(water.density, water.gravity) == pytest.approx(weight, rel=1e-9)
    ends = [np.concatenate(copy) for line in original.lines for copy in line.copies()]
    assert np.array([[*line.anchor, *line.fairlead] for line in read.lines]) == pytest.approx(
        np.array(ends), rel=1e-9, abs=1e-8
    )
    assert all([s.length for s in line.segments] == [600.0, 240.0] for line in read.lines)
    assert "9.80665   g" in exported.texts[ALONE] and "1025.0   WtrDnsty" in exported.texts[ALONE]
    assert any(item.source == "all but the mooring" and item.treatment is Treatment.LEFT_OUT for item in exported.items)


def test_a_platform_without_catenaries_is_refused() -> None:
    platform = load_platform("oc3-hywind")
    with pytest.raises(InputError, match="lines of `kind: catenary`"):
        export_lines(source_of(platform, build(platform)))
