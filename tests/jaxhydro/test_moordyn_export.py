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
    mine, water = platform.mooring, platform.water
    assert isinstance(mine, Catenary)
    found = export_lines(source_of(platform, build(platform)))
    path = tmp_path / ALONE
    path.write_text(found.texts[ALONE], encoding="utf-8")
    system, left = read_mooring_system(read_keyed_file(path, "MoorDyn"), 0.0, water.depth)
    assert not left and system.depth == 180.0
    read = Catenary.model_validate(catenary_section(system, water.depth, water.density, water.gravity))
    for kind, one in mine.line_types.items():
        weight = one.weight(water.density, water.gravity)
        assert read.line_types[kind].weight(water.density, water.gravity) == pytest.approx(weight, rel=1e-9)
    ends = [np.concatenate(copy) for one in mine.lines for copy in one.copies()]
    assert np.array([[*one.anchor, *one.fairlead] for one in read.lines]) == pytest.approx(np.array(ends), rel=1e-9, abs=1e-8)
    assert all([s.length for s in one.segments] == [600.0, 240.0] for one in read.lines)
    assert "9.80665   g" in found.texts[ALONE] and "1025.0   WtrDnsty" in found.texts[ALONE]
    assert any(one.source == "all but the mooring" and one.treatment is Treatment.LEFT_OUT for one in found.items)


def test_a_platform_without_catenaries_is_refused() -> None:
    platform = load_platform("oc3-hywind")
    with pytest.raises(InputError, match="lines of `kind: catenary`"):
        export_lines(source_of(platform, build(platform)))
