"""WAMIT's .mmx file: volume, centres, mass matrix, external damping and stiffness."""

import math
import shutil
from pathlib import Path

import jax
import numpy as np
import pytest
from numpy.testing import assert_allclose

import jaxhydro as jh
from jaxhydro.errors import InputError
from jaxhydro.interop.conversion import Conversion, Treatment
from jaxhydro.interop.converters import convert_file
from jaxhydro.interop.panel_results.rigid_mass import centre_of
from jaxhydro.interop.panel_results.wamit_mass_file import read_mass_file
from jaxhydro.interop.reference_point import rigid_shift
from jaxhydro.interop.wamit_hydrostatics import read_hydrostatics
from jaxhydro.platform.schema import Platform

DATA = Path(__file__).parents[1] / "data"
VOLUME, CENTRE = 76.2139, -0.674509  # m3, m: of the ellipsoid, by WAMIT
RADIUS, WEIGHT_AT = 1.5, -0.5  # m: of gyration, and height of the centre of mass
HEADER = """ WAMIT -- Force Output File -- ellipsoid.mmx              06-Dec-2016  12:55:04

 Gravity:     9.81000                Length scale:        1.00000

 NBODY =     1       IALTFRC = {form}

 WAMIT  Ouputs for body N =     1    IALTFRCN = {form}
 Volumes (VOLX,VOLY,VOLZ):           76.2139      76.2139      76.2136
 Center of Buoyancy (Xb,Yb,Zb):     0.000000     0.000000    -0.674509
 Center of Gravity:  (Xg,Yg,Zg)     0.000000     0.000000    {centre:.6f}

"""
NORMALIZED = " Normalized mass matrix: \n     I     J     MASS(I,J)/RHO\n"
EXTERNAL = " External force matrices:\n     I     J      MASS(I,J)      DAMP(I,C)      STIF(I,J)\n"


def rigid(mass: float) -> np.ndarray:
    """Mass matrix about the origin of a body with its centre at WEIGHT_AT."""
    about = np.diag([mass] * 3 + [mass * RADIUS**2] * 3)
    shift = rigid_shift(np.array([0.0, 0.0, WEIGHT_AT]))
    return shift.T @ about @ shift


def rows(*matrices: np.ndarray) -> str:
    """Table of I, J and the entries of matrices."""
    pairs = [(i, j) for i in range(6) for j in range(6)]
    return "".join(f"{i + 1:6d}{j + 1:6d}" + "".join(f"{m[i, j]:15.6E}" for m in matrices) + "\n" for i, j in pairs)


def normalized(mass: np.ndarray, centre: float = WEIGHT_AT) -> str:
    return HEADER.format(form=1, centre=centre) + NORMALIZED + rows(mass)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """WAMIT's results for the ellipsoid with an .mmx file of IALTFRC 1."""
    copied = shutil.copytree(DATA / "ellipsoid" / "wamit", tmp_path / "wamit")
    (copied / "ellipsoid.mmx").write_text(normalized(rigid(VOLUME)), encoding="utf-8")
    return copied


def treatments(conversion: Conversion, source: str) -> list[Treatment]:
    return [item.treatment for item in conversion.items if source in item.source]


def said(conversion: Conversion, source: str) -> str:
    return " ".join(item.meaning for item in conversion.items if source in item.source)


def test_the_file_agrees_with_the_stiffness(folder: Path) -> None:
    """A circular waterplane of area A has a second moment of A²/(4 pi): .mmx and .hst of WAMIT are of one hull."""
    (folder / "ellipsoid.mmx").write_text(normalized(rigid(VOLUME), 0.0), encoding="utf-8")  # as in the public file
    file = read_mass_file(folder / "ellipsoid.mmx")
    stiffness = read_hydrostatics(folder / "ellipsoid.hst", 1.0, 1.0).stiffness
    moment = stiffness[3, 3] - file.volume * file.buoyancy[2]  # C44 = rho g (moment + V z_b) with the weight at 0
    assert moment == pytest.approx(stiffness[2, 2] ** 2 / (4 * math.pi), rel=2e-3)
    assert file.normalized and file.volume == VOLUME and file.buoyancy[2] == CENTRE and file.damping is None


def test_mass_of_the_displaced_water(folder: Path) -> None:
    conversion = convert_file(folder)
    body = conversion.platform["rigid_body"]
    assert body["mass"] == pytest.approx(1025.0 * VOLUME) and body["centre_of_mass"][2] == pytest.approx(WEIGHT_AT)
    assert [body["inertia"][key] for key in ("Ixx", "Iyy", "Izz")] == pytest.approx([1025 * VOLUME * RADIUS**2] * 3)
    assert conversion.platform["water"]["gravity"] == 9.81 and treatments(conversion, "water.gravity") == []
    assert treatments(conversion, "rigid_body.mass") == [Treatment.TO_FILL_IN]
    assert "pull of the moorings" in said(conversion, "rigid_body.mass")
    assert treatments(conversion, "rigid_body.inertia") == treatments(conversion, "hydrostatics.weight") == []
    Platform.model_validate(conversion.platform)


def test_the_weight_is_replaced(folder: Path) -> None:
    """C44 of the model is that of the .hst file, as WAMIT had the platform's own mass and centre."""
    written = convert_file(folder).platform
    assert written["hydrostatics"]["displaced_volume"] == VOLUME and "weight" not in written["hydrostatics"]
    of_file = {"file": str(folder / "ellipsoid.hst")}
    still = {key: written[key] for key in ("name", "water", "rigid_body", "mooring", "directions")}
    model = jh.build(Platform.model_validate(still | {"hydrostatics": written["hydrostatics"] | of_file}))
    stiffness = -np.asarray(jax.jacfwd(model.force_at_rest)(np.zeros(6)))
    wanted = read_hydrostatics(folder / "ellipsoid.hst", 1025.0, 9.81).stiffness
    assert_allclose(np.diag(stiffness)[2:5], np.diag(wanted)[2:5], rtol=1e-9)


def test_matrices_of_the_force_control_file(folder: Path) -> None:
    """IALTFRC 2: mass, damping and stiffness in their own units; beside an .out file's density."""
    mass, damping = rigid(7.0e4), np.diag([1e3, 1e3, 2e3, 3e4, 3e4, 0.0])
    stiffness = np.diag([1e4, 1e4, 5e3, 0.0, 0.0, 2e5])
    text = HEADER.format(form=2, centre=WEIGHT_AT) + EXTERNAL + rows(mass, damping, stiffness)
    (folder / "ellipsoid.mmx").write_text(text, encoding="utf-8")
    conversion = convert_file(folder)
    assert conversion.platform["rigid_body"]["mass"] == 7.0e4
    assert conversion.platform["linear_damping"] == {"B11": 1e3, "B22": 1e3, "B33": 2e3, "B44": 3e4, "B55": 3e4}
    assert_allclose(np.diag(conversion.platform["mooring"]["stiffness"]), np.diag(stiffness))
    pull = conversion.platform["mooring"]["preload"][2]
    assert pull == pytest.approx(9.81 * (7.0e4 - 1025.0 * VOLUME)) and treatments(conversion, "rigid_body.mass") == []
    assert_allclose(centre_of(read_mass_file(folder / "ellipsoid.mmx").mass), [0, 0, WEIGHT_AT], atol=1e-12)


def test_a_matrix_without_inertia(folder: Path) -> None:
    """Public examples state no radii of gyration: volume and centre are taken, the inertia is estimated."""
    point = rigid(VOLUME)
    point[3:, 3:] = 0.0
    (folder / "ellipsoid.mmx").write_text(normalized(point), encoding="utf-8")
    conversion = convert_file(folder)
    assert conversion.platform["rigid_body"]["mass"] == pytest.approx(1025.0 * VOLUME)
    assert conversion.platform["rigid_body"]["centre_of_mass"][2] == WEIGHT_AT
    assert "It has no inertia" in said(conversion, "mass matrix")
    assert treatments(conversion, "rigid_body.inertia") == [Treatment.TO_FILL_IN]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("NBODY =     1", "NBODY =     2", r"ellipsoid\.mmx: expected results of one body, found 2 bodies"),
        ("     1     2   0.000000E+00\n", "     1     2\n", r"line 15: expected numbers I J MASS\(I,J\)/RHO, found '1 2'"),
        ("     1     2   0.000000E+00\n", "     1     2   none\n", r"line 15: expected numbers I J MASS"),
        (
            "     1     2   0.000000E+00\n",
            "     1     1   0.000000E+00\n",
            r"line 15: expected each pair I J once, found 1 1 again",
        ),
        ("     1     2   0.000000E+00\n", "", r"MASS\(I,J\)/RHO: expected 36 rows, I and J from 1 to 6, found 35 rows"),
        (
            "     1     2   0.000000E+00\n",
            "     1     7   0.000000E+00\n",
            r"line 15: expected motions I and J from 1 to 6.*modes",
        ),
        (" Normalized mass matrix: \n", "", r"expected a table Normalized mass matrix or External force matrices, found none"),
        ("Length scale:        1.00000", "Length scale:  long", r"line 3, Length scale: expected a number, found 'long'"),
        ("Length scale:        1.00000", "Length scale:  0.0", r"Length scale: expected a number above 0, found 0"),
        (
            "(VOLX,VOLY,VOLZ):           76.2139      76.2139",
            "(VOLX,VOLY,VOLZ): 70.0 70.0",
            r"MASS\(1,1\)/RHO: .*found 76\.2139",
        ),
        ("-0.674509", "0.126361", r"Zb: expected a centre of buoyancy below 0, found 0\.126361.*axes are below still water"),
        (" Center of Buoyancy (Xb,Yb,Zb)", " Centre", r"expected a line with \(Xb,Yb,Zb\), found none"),
    ],
)
def test_broken_files(folder: Path, old: str, new: str, message: str) -> None:
    path = folder / "ellipsoid.mmx"
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(InputError, match=message):
        convert_file(folder)


def test_files_of_two_runs(folder: Path) -> None:
    """Another volume than the .out file's, or masses in other units, are refused."""
    text = HEADER.format(form=2, centre=WEIGHT_AT) + EXTERNAL + rows(rigid(VOLUME), np.zeros((6, 6)), np.zeros((6, 6)))
    (folder / "ellipsoid.mmx").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=r"MASS\(1,1\): expected a mass near that of the displaced water, .*RHO of the \.frc"):
        convert_file(folder)
    out = """ Gravity:  9.81  Length scale:  1.0
 Water depth:  infinite  Water density:  1000.0
 XBODY =  0.0 YBODY =  0.0 ZBODY =  0.0 PHIBODY =  0.0
 Volumes (VOLX,VOLY,VOLZ):  80.0  80.0  80.0
 C(3,3),C(3,4),C(3,5):  63.6  0.0  0.0
 C(4,4),C(4,5),C(4,6):  270.0  0.0  0.0
 C(5,5),C(5,6):  270.0  0.0
 Center of Gravity  (Xg,Yg,Zg):  0.0  0.0  -0.5
"""
    (folder / "ellipsoid.mmx").write_text(normalized(rigid(VOLUME)), encoding="utf-8")
    (folder / "ellipsoid.out").write_text(out, encoding="utf-8")
    with pytest.raises(InputError, match=r"ellipsoid\.mmx: volume .m³.: expected that of the \.out file, 80, found 76\.2139"):
        convert_file(folder)
    (folder / "ellipsoid.out").write_text(out.replace("80.0", "76.21"), encoding="utf-8")
    conversion = convert_file(folder)
    assert conversion.platform["rigid_body"]["mass"] == pytest.approx(1000.0 * VOLUME)
    assert conversion.platform["hydrostatics"] == {"file": "ellipsoid.out", "linear": True}
