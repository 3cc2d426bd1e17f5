"""Result folders of WAMIT, HAMS, Nemoh and Capytaine as platforms."""

import os
import shutil
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

from jaxhydro.errors import InputError
from jaxhydro.interop.conversion import Conversion, Treatment
from jaxhydro.interop.converters import convert_file
from jaxhydro.interop.panel_results.infinite_added_mass import infinite_added_mass
from jaxhydro.interop.panel_results.rigid_mass import centre_of, inertia_of, is_rigid
from jaxhydro.interop.reference_point import rigid_shift
from jaxhydro.interop.wamit_radiation import read_wamit
from jaxhydro.platform.schema import Platform

DATA = Path(__file__).parents[1] / "data"
HULLS = Path(os.environ.get("PUBLIC_HULLS", "no folder"))  # as `benchmarks.public_hulls` takes it
VOLUME, MASS = 76.21, 7.0e4  # m3, kg: of the ellipsoid, and of a body that its moorings pull down

OUT = f"""
 Gravity:     9.81000                Length scale:        1.00000
 Water depth:        infinite        Water density:     1000.00000
 XBODY =    0.0000 YBODY =    0.0000 ZBODY =    0.0000 PHIBODY =   0.0
 Volumes (VOLX,VOLY,VOLZ):           {VOLUME}      {VOLUME}      {VOLUME}
 Center of Buoyancy (Xb,Yb,Zb):     0.000000     0.000000   -0.900000
 Hydrostatic and gravitational restoring coefficients:
 C(3,3),C(3,4),C(3,5):   63.60       0.0000      0.0000
 C(4,4),C(4,5),C(4,6):               70.0   0.0000       0.0000
        C(5,5),C(5,6):                            400.0   0.0000
 Center of Gravity  (Xg,Yg,Zg):     0.000000     0.000000    -0.500000

 Global body and external mass matrix:
   7.0E+04  0.0E+00  0.0E+00  0.0E+00 -3.5E+04  0.0E+00
   0.0E+00  7.0E+04  0.0E+00  3.5E+04  0.0E+00  0.0E+00
   0.0E+00  0.0E+00  7.0E+04  0.0E+00  0.0E+00  0.0E+00
   0.0E+00  3.5E+04  0.0E+00  3.0E+05  0.0E+00  0.0E+00
  -3.5E+04  0.0E+00  0.0E+00  0.0E+00  3.0E+05  0.0E+00
   0.0E+00  0.0E+00  0.0E+00  0.0E+00  0.0E+00  4.0E+05

 Global external stiffness matrix:
   1.0E+03  0.0E+00  0.0E+00  0.0E+00  2.0E+02  0.0E+00
   0.0E+00  1.0E+03  0.0E+00  0.0E+00  0.0E+00  0.0E+00
   0.0E+00  0.0E+00  5.0E+02  0.0E+00  0.0E+00  0.0E+00
   0.0E+00  0.0E+00  0.0E+00  3.0E+03  0.0E+00  0.0E+00
   4.0E+02  0.0E+00  0.0E+00  0.0E+00  3.0E+03  0.0E+00
   0.0E+00  0.0E+00  0.0E+00  0.0E+00  0.0E+00  3.0E+03
"""
CONTROL = """
   Waterdepth  10.D0      (a negative value denotes the infinite depth)
    Output_frequency_type       4
    Reference_body_center       0.000       0.000       0.000
    Reference_body_length   1.D0
"""
BODY = """
 Body Mass Matrix:
   0.16040E+04   0.0E+00   0.0E+00   0.0E+00  -0.60123E+03   0.0E+00
   0.0E+00   0.16040E+04   0.0E+00   0.60123E+03   0.0E+00   0.0E+00
   0.0E+00   0.0E+00   0.16040E+04   0.0E+00   0.0E+00   0.0E+00
   0.0E+00   0.60123E+03   0.0E+00   0.86185E+03   0.0E+00   0.0E+00
  -0.60123E+03   0.0E+00   0.0E+00   0.0E+00   0.86185E+03   0.0E+00
   0.0E+00   0.0E+00   0.0E+00   0.0E+00   0.0E+00   0.11931E+04
"""


@pytest.fixture
def wamit(tmp_path: Path) -> Path:
    """WAMIT's results for the ellipsoid, with an .out file."""
    folder = shutil.copytree(DATA / "ellipsoid" / "wamit", tmp_path / "wamit")
    (folder / "ellipsoid.out").write_text(OUT, encoding="utf-8")
    return folder


@pytest.fixture
def hams(tmp_path: Path) -> Path:
    """A case of HAMS: its cylinder."""
    shutil.copytree(DATA / "hams-cylinder", tmp_path / "Cylinder" / "Output" / "Wamit_format")
    (tmp_path / "Cylinder" / "Input").mkdir()
    (tmp_path / "Cylinder" / "Input" / "ControlFile.in").write_text(CONTROL, encoding="utf-8")
    (tmp_path / "Cylinder" / "Input" / "Hydrostatic.in").write_text(BODY, encoding="utf-8")
    return tmp_path / "Cylinder"


def to_fill_in(conversion: Conversion) -> set[str]:
    return {item.source for item in conversion.items if item.treatment is Treatment.TO_FILL_IN}


def said(conversion: Conversion, source: str) -> str:
    return " ".join(item.meaning for item in conversion.items if source in item.source)


def replaced(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")


def test_mass_of_a_mass_matrix() -> None:
    """About another point and back: mass, centre and inertia."""
    inertia, centre = np.array([[3.0, 0.1, 0.2], [0.1, 4.0, 0.3], [0.2, 0.3, 5.0]]), np.array([0.5, -0.2, -1.0])
    matrix = np.zeros((6, 6))
    matrix[:3, :3], matrix[3:, 3:] = 2.0 * np.eye(3), inertia
    moved = rigid_shift(centre).T @ matrix @ rigid_shift(centre)
    assert is_rigid(moved)
    assert_allclose(centre_of(moved), centre)
    assert_allclose(inertia_of(moved), inertia, atol=1e-12)
    assert not is_rigid(moved + np.diag([1.0, 0, 0, 0, 0, 0])) and not is_rigid(np.zeros((6, 6)))


def test_wamit(wamit: Path) -> None:
    conversion = convert_file(wamit)
    platform = conversion.platform
    assert platform["name"] == "ellipsoid" and platform["water"]["density"] == 1000.0 and platform["water"]["gravity"] == 9.81
    assert platform["rigid_body"]["mass"] == MASS and platform["rigid_body"]["centre_of_mass"] == [0.0, 0.0, -0.5]
    assert platform["rigid_body"]["inertia"]["Iyy"] == pytest.approx(3.0e5 - MASS * 0.25)
    assert platform["hydrostatics"] == {"file": "ellipsoid.out", "linear": True}
    assert platform["radiation"] == {"file": "ellipsoid.1", "added_mass": "file"}
    assert platform["mooring"]["preload"][2] == pytest.approx(9.81 * (MASS - 1000.0 * VOLUME))
    assert platform["mooring"]["stiffness"][0][4] == 300.0
    assert to_fill_in(conversion) == {"water.depth", "mooring", "quadratic_damping"}
    assert set(conversion.files) == {"ellipsoid.1", "ellipsoid.3", "ellipsoid.out"}
    Platform.model_validate(platform)


def test_wamit_without_an_out_file(wamit: Path) -> None:
    """What results do not say is assumed, and marked; a geometry and a control file say some of it."""
    (wamit / "ellipsoid.out").unlink()
    alone = convert_file(wamit / "ellipsoid.1")
    assert {"water.density", "water.gravity", "water.depth", "hydrostatics.weight", "rigid_body.mass"} <= to_fill_in(alone)
    (wamit / "ellipsoid.gdf").write_text("hull\n 1.0 9.81 ULEN GRAV\n0 0\n", encoding="utf-8")
    (wamit / "ellipsoid.pot").write_text("hull\n -1.0 HBOT\n", encoding="utf-8")
    told = convert_file(wamit)
    assert told.platform["water"]["gravity"] == 9.81 and "water.gravity" not in to_fill_in(told)
    assert "force of the longest wave" in said(told, "rigid_body.mass")
    assert told.platform["rigid_body"]["mass"] == pytest.approx(1025.0 * VOLUME, rel=0.03)


def test_the_first_column_by_the_configuration(wamit: Path) -> None:
    rows = [line.split() for line in (wamit / "ellipsoid.1").read_text(encoding="utf-8").splitlines()]
    turned = [" ".join([f"{2 * np.pi / float(row[0]):.9f}" if float(row[0]) > 0 else row[0], *row[1:]]) for row in rows[1:]]
    before = read_wamit(wamit / "ellipsoid.1", 1000.0)
    (wamit / "ellipsoid.1").write_text("\n".join(turned), encoding="utf-8")
    (wamit / "ellipsoid.3").unlink()
    (wamit / "run.cfg").write_text(" IPEROUT=2\n", encoding="utf-8")
    entry = convert_file(wamit).platform["radiation"]
    assert entry["by"] == "rad/s"
    assert_allclose(read_wamit(wamit / "ellipsoid.1", 1000.0, by="rad/s").omega, before.omega, rtol=1e-5)
    (wamit / "run.cfg").write_text(" IPEROUT=3\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"run\.cfg: IPEROUT: expected 1 .periods. or 2 .rad/s., found 3"):
        convert_file(wamit)


def test_hams(hams: Path) -> None:
    for folder in (hams, hams / "Output", hams / "Output" / "Wamit_format"):
        conversion = convert_file(folder)
        platform = conversion.platform
        assert platform["name"] == "Cylinder" and platform["water"] == {"density": 1025.0, "depth": 10.0, "gravity": 9.807}
        assert platform["rigid_body"]["mass"] == 1604.0
        assert platform["rigid_body"]["centre_of_mass"][2] == pytest.approx(-601.23 / 1604)
        assert platform["excitation"] == {"file": "Buoy.3"} and platform["hydrostatics"]["weight"] == "included"
        assert to_fill_in(conversion) == {"hydrostatics.weight", "mooring", "quadratic_damping"}


@pytest.mark.parametrize("version", ["v2.3", "v3.0.2"])
def test_nemoh(version: str, tmp_path: Path) -> None:
    folder = shutil.copytree(DATA / "ellipsoid" / f"nemoh-{version}", tmp_path / "Ellipsoid")
    (folder / "results" / "CA.dat").write_text("", encoding="utf-8")
    for source in (folder, folder / "results", folder / "Nemoh.cal"):
        conversion = convert_file(source)
        assert conversion.platform["name"] == "Ellipsoid"
        assert conversion.platform["rigid_body"]["mass"] == pytest.approx(1000 * VOLUME, rel=1e-3)
        assert conversion.platform["hydrostatics"] == {"file": "KH.dat", "linear": True}
        assert set(conversion.files) == {
            "Nemoh.cal",
            "RadiationCoefficients.tec",
            "ExcitationForce.tec",
            "KH.dat",
            "Hydrostatics.dat",
        }
    assert "fewer digits" in said(conversion, "CA.dat")
    assert "rigid_body.inertia" in to_fill_in(conversion) and "water.depth" in to_fill_in(conversion)
    theirs = read_wamit(DATA / "ellipsoid" / "wamit" / "ellipsoid.1", 1000.0).infinite
    assert theirs is not None and conversion.platform["added_mass"]["A33"] == pytest.approx(theirs[2, 2], rel=0.03)
    assert "A66" not in conversion.platform["added_mass"]


def test_nemoh_without_hydrostatics(tmp_path: Path) -> None:
    """The mass is that of the longest wave's force, and what is missing is said."""
    folder = shutil.copytree(DATA / "ellipsoid" / "nemoh-v3.0.2", tmp_path / "Ellipsoid")
    shutil.rmtree(folder / "mesh")
    conversion = convert_file(folder)
    assert conversion.platform["rigid_body"]["mass"] == pytest.approx(1000 * VOLUME, rel=0.03)
    assert "nothing restores heave" in said(conversion, "hydrostatics")


def test_infinite_frequency_by_the_damping() -> None:
    """Kramers and Kronig, against WAMIT's own value."""
    coefficients = read_wamit(DATA / "ellipsoid" / "wamit" / "ellipsoid.1", 1000.0)
    assert coefficients.infinite is not None
    matrix, spread = infinite_added_mass(coefficients, "ellipsoid.1")
    assert matrix[2, 2] == pytest.approx(coefficients.infinite[2, 2], rel=0.02) and spread < 0.1


def test_capytaine(tmp_path: Path) -> None:
    conversion = convert_file(DATA / "capytaine-cylinder.nc")
    assert conversion.platform["water"] == {"density": 1000.0, "depth": 50.0, "gravity": 9.81}
    assert conversion.platform["hydrostatics"] == {"file": "capytaine-cylinder.nc", "linear": True}
    assert {"rigid_body.mass", "rigid_body.inertia", "mooring"} <= to_fill_in(conversion)
    data = xr.load_dataset(DATA / "capytaine-cylinder.nc")
    names = list(data["influenced_dof"].values)
    six = ["Surge", "Sway", "Heave", "Roll", "Pitch", "Yaw"]
    matrix = np.diag([9000.0, 9000.0, 9000.0, 4e4, 4e4, 2e4])
    data = data.reindex(influenced_dof=six, radiating_dof=six, fill_value=0.0) if len(names) < 6 else data
    data["inertia_matrix"] = (("influenced_dof", "radiating_dof"), matrix)
    data.to_netcdf(tmp_path / "hull.nc", engine="h5netcdf")
    whole = convert_file(tmp_path)
    assert whole.platform["rigid_body"]["mass"] == 9000.0 and "rigid_body.mass" not in to_fill_in(whole)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "ZBODY =    0.0000",
            "ZBODY =   -2.0000",
            r"ellipsoid\.out: XBODY.*found 0, 0, -2, 0.*origin at still",
        ),
        ("7.0E+04  0.0E+00  0.0E+00  0.0E+00 -3.5E+04", "7.0E+04  x", r"ellipsoid\.out: line 14.*six rows"),
        (
            "Length scale:        1.00000",
            "Length scale:  long",
            r"line 2, Length scale: expected a number, found 'long'",
        ),
    ],
)
def test_broken_out_files(wamit: Path, old: str, new: str, message: str) -> None:
    replaced(wamit / "ellipsoid.out", old, new)
    with pytest.raises(InputError, match=message):
        convert_file(wamit)


def test_other_broken_folders(wamit: Path, hams: Path, tmp_path: Path) -> None:
    (wamit / "ellipsoid.out").write_text(OUT + OUT, encoding="utf-8")
    with pytest.raises(InputError, match=r"results of one body, found 2 bodies"):
        convert_file(wamit)
    shutil.copyfile(wamit / "ellipsoid.1", wamit / "other.1")
    (wamit / "ellipsoid.out").unlink()
    with pytest.raises(InputError, match=r"one file that ends in \.1, found ellipsoid\.1, other\.1\. Name one of them"):
        convert_file(wamit)
    control = hams / "Input" / "ControlFile.in"
    replaced(control, "Output_frequency_type       4", "Output_frequency_type       2")
    with pytest.raises(InputError, match=r"ControlFile\.in: Output_frequency_type: expected 3 .rad/s. or 4 .periods., found 2"):
        convert_file(hams)
    replaced(control, "type       2", "type       4")
    replaced(control, "center       0.000", "center       5.000")
    with pytest.raises(InputError, match=r"Reference_body_center: expected 0, 0, 0, found 5, 0, 0"):
        convert_file(hams)
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match=r"empty: expected results of WAMIT .*, found none of their files"):
        convert_file(tmp_path / "empty")
    (tmp_path / "empty" / "nemoh.cal").write_text("", encoding="utf-8")
    with pytest.raises(InputError, match=r"expected the name Nemoh\.cal, found nemoh\.cal"):
        convert_file(tmp_path / "empty")


@pytest.mark.skipif(not (HULLS / "IEA-15-240-RWT").is_dir(), reason="PUBLIC_HULLS names no copy of IEA-15-240-RWT")
def test_the_public_results_of_volturnus() -> None:
    """Mass, volume and pull of the moorings of the report (NREL/TP-5000-76773)."""
    folder = HULLS / "IEA-15-240-RWT" / "OpenFAST" / "IEA-15-240-RWT-UMaineSemi" / "HydroData"
    platform = convert_file(folder).platform
    assert platform["rigid_body"]["mass"] == pytest.approx(20.093e6, rel=1e-3)
    assert platform["mooring"]["preload"][2] == pytest.approx(-6.065e6, rel=0.02)
    assert platform["drift"] == {"file": "IEA-15-240-RWT-UMaineSemi.12d"}
