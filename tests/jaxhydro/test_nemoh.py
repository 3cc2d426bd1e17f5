"""Nemoh's results: WEC-Sim's ellipsoid against WAMIT, and other points, waters, units and bodies against arithmetic."""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from jaxhydro.errors import InputError
from jaxhydro.interop.nemoh_hydrostatics import read_nemoh_hydrostatics
from jaxhydro.interop.nemoh_tables import nemoh_headings, read_nemoh_excitation, read_nemoh_radiation
from jaxhydro.interop.wamit_excitation import read_excitation
from jaxhydro.interop.wamit_hydrostatics import read_hydrostatics
from jaxhydro.interop.wamit_radiation import read_wamit
from jaxhydro.platform.computed_hydrostatics import hydrostatics_of
from jaxhydro.platform.computed_loads import excitation_of
from jaxhydro.platform.schema import load_platform

DATA = Path(__file__).parents[1] / "data" / "ellipsoid"
DENSITY, GRAVITY = 1000.0, 9.81
RADIATION, FORCE = "results/RadiationCoefficients.tec", "results/ExcitationForce.tec"
VERSIONS = ["v2.3", "v3.0.2"]
LONG_WAVES = 2.5  # rad/s: above it Nemoh has irregular frequencies of this hull


@pytest.fixture
def case(tmp_path: Path) -> Path:
    """A copy of the case of v3, to change."""
    shutil.copytree(DATA / "nemoh-v3.0.2", tmp_path / "case")
    return tmp_path / "case"


def edit(path: Path, pattern: str, by: str) -> None:
    text, count = re.subn(pattern, by, path.read_text(), flags=re.MULTILINE)
    assert count
    path.write_text(text)


def about(case: Path, point: str) -> None:
    """Let Nemoh.cal say that rotations and moments are about a point."""
    edit(case / "Nemoh.cal", r"^(2 \d\. ?\d?\.?\s?\d\.) 0\. 0\. 0\.000000", rf"\1 {point}")


@pytest.mark.parametrize("version", VERSIONS)
def test_the_same_body_by_nemoh_and_by_wamit(version: str) -> None:
    """Coefficients, forces with their phases, and stiffness agree within 3 % of the largest: two meshes and two programs."""
    nemoh = read_nemoh_radiation(DATA / f"nemoh-{version}" / RADIATION)
    wamit = read_wamit(DATA / "wamit" / "ellipsoid.1", DENSITY)
    assert_allclose(nemoh.omega, wamit.omega, rtol=1e-5)
    low = nemoh.omega < LONG_WAVES
    for nemoh_value, wamit_value in ((nemoh.added_mass[low], wamit.added_mass[low]), (nemoh.damping[low], wamit.damping[low])):
        size = np.sqrt(np.abs(np.diagonal(wamit_value, axis1=1, axis2=2)).max(axis=0))
        unit = np.outer(size, size)
        unit[5, :] = unit[:, 5] = np.inf  # nothing but noise in yaw
        assert (np.abs(nemoh_value - wamit_value) <= 0.03 * unit).all()
    force = np.asarray(read_nemoh_excitation(DATA / f"nemoh-{version}" / FORCE).force)
    wamit_value = np.asarray(read_excitation(DATA / "wamit" / "ellipsoid.3", DENSITY, GRAVITY).force)
    for i in (0, 2, 4):
        assert_allclose(force[i], wamit_value[i], rtol=0, atol=0.02 * np.abs(wamit_value[i]).max())
    statics = read_nemoh_hydrostatics(DATA / f"nemoh-{version}" / "mesh/KH.dat", density=DENSITY, gravity=GRAVITY)
    stiffness = read_hydrostatics(DATA / "wamit" / "ellipsoid.hst", DENSITY, GRAVITY).stiffness
    assert_allclose(np.diag(statics.stiffness), np.diag(stiffness), rtol=2e-3, atol=1.0)
    assert statics.volume == pytest.approx(76.21, abs=0.01) and statics.centre_of_mass == 0.0


def test_coefficients_about_another_point(case: Path) -> None:
    """About (0, 0, z) pitch has M55 + 2 z M15 + z² M11 at the origin, and the moment My + z Fx."""
    before, notes = read_nemoh_radiation(case / RADIATION), list[str]()
    force = np.asarray(read_nemoh_excitation(case / FORCE).force)
    about(case, "0. 0. -5.")
    after = read_nemoh_radiation(case / RADIATION, notes=notes)
    assert "computed about (0, 0, -5) m: moved" in notes[0]
    mass = before.added_mass
    expected = mass[:, 4, 4] - 5 * (mass[:, 0, 4] + mass[:, 4, 0]) + 25 * mass[:, 0, 0]
    assert_allclose(after.added_mass[:, 4, 4], expected, rtol=1e-10)
    assert_allclose(after.damping[:, 2, 2], before.damping[:, 2, 2], rtol=1e-12)
    moved = np.asarray(read_nemoh_excitation(case / FORCE).force)
    assert_allclose(moved[4], force[4] - 5 * force[0], rtol=1e-10)
    assert_allclose(moved[:3], force[:3])


def test_another_origin_of_the_wave(case: Path) -> None:
    """Waves with phase 0 at x = 10 m have exp(i k 10) more there: X is turned by exp(-i k 10), k = w²/g in deep water."""
    before = read_nemoh_excitation(case / FORCE)
    edit(case / "Nemoh.cal", r"^0\.\t0\.(\s+! XEFF)", r"10. 3.\1")
    after = read_nemoh_excitation(case / FORCE)
    k = np.asarray(before.omega) ** 2 / GRAVITY
    assert_allclose(np.asarray(after.force)[2], np.asarray(before.force)[2] * np.exp(-10j * k), rtol=1e-6)


def test_another_water_and_unit(case: Path) -> None:
    """Forces are scaled to the platform's density; a first column in s has the same coefficients, in reverse."""
    notes: list[str] = []
    before, salt = read_nemoh_radiation(case / RADIATION), read_nemoh_radiation(case / RADIATION, density=1025.0, notes=notes)
    assert_allclose(salt.added_mass, 1.025 * before.added_mass)
    assert "computed for a density of 1000 kg/m3: forces are scaled to 1025 kg/m3" in notes[0]
    read_nemoh_excitation(case / FORCE, gravity=9.7, depth=20.0, notes=notes)
    assert "a gravity of 9.81 m/s2" in notes[1] and "a depth of inf m, the platform has 20 m" in notes[2]
    edit(case / RADIATION, r"w \(rad/s\)", "T (s)")
    lines = (case / RADIATION).read_text().splitlines()
    rows = [line.split() for line in lines]
    text = [
        " ".join([f"{2 * np.pi / float(row[0]):.10f}", *row[1:]]) if row[0][0].isdigit() else line
        for row, line in zip(rows, lines)
    ]
    (case / RADIATION).write_text("\n".join(text))
    reread = read_nemoh_radiation(case / RADIATION)
    assert_allclose(reread.omega, before.omega, rtol=1e-6)
    assert_allclose(reread.added_mass, before.added_mass)


def test_hydrostatics_of_a_version_with_a_fixed_density(case: Path) -> None:
    """KH(3,3) over the waterplane area tells the water; a centre off the axis is moved."""
    read = {"density": DENSITY, "gravity": GRAVITY}
    right = read_nemoh_hydrostatics(case / "mesh/KH.dat", **read)
    values = 1.025 * np.loadtxt(case / "mesh/KH.dat")
    np.savetxt(case / "mesh/KH.dat", values)
    notes: list[str] = []
    assert_allclose(read_nemoh_hydrostatics(case / "mesh/KH.dat", **read, notes=notes).stiffness, right.stiffness, rtol=1e-6)
    assert "of water of 10055 N/m3: scaled to 9810 N/m3" in notes[0]
    edit(case / "mesh/Hydrostatics.dat", r"XG =\s+0.000", "XG =   2.000")
    moved = read_nemoh_hydrostatics(case / "mesh/KH.dat", **read).stiffness
    assert moved[4, 4] == pytest.approx(right.stiffness[4, 4] + 4 * right.stiffness[2, 2], rel=1e-6)
    assert moved[2, 4] == pytest.approx(-2 * right.stiffness[2, 2], rel=1e-6)


PLATFORM = """
name: Ellipsoid
water: {density: 1000.0, depth: 400.0, gravity: 9.81}
rigid_body: {mass: 76213.8, centre_of_mass: [0, 0, -1], inertia: {Ixx: 3.0e5, Iyy: 3.0e5, Izz: 4.0e5}}
members: []
mooring: {kind: none}
hydrostatics: {file: case/mesh/KH.dat}
excitation: {file: case/results/ExcitationForce.tec}
radiation: {file: case/results/RadiationCoefficients.tec}
"""


def test_a_platform_file_names_them(case: Path) -> None:
    """C44 of KH is that of buoyancy where its centre of mass is the origin; the force of waves is that of the file."""
    file = case.parent / "platform.yaml"
    file.write_text(PLATFORM)
    platform = load_platform(file)
    assert {platform.hydrostatics.kind, platform.excitation.kind, platform.radiation.kind} == {"nemoh"}
    edit(case / "mesh/Hydrostatics.dat", r"ZG =\s+0.000", "ZG =  -1.000")
    statics = hydrostatics_of(platform.hydrostatics, platform.water).hydrostatics
    weight = 1000.0 * 9.81 * 76.21381
    assert statics.displaced_volume == pytest.approx(76.21381) and statics.C44 is None
    assert statics.C44_buoyancy == pytest.approx(2648637.8 - weight, rel=1e-4)
    load, remarks = excitation_of(platform.excitation, platform.water)
    assert not remarks
    assert_allclose(load.excitation.force, read_nemoh_excitation(case / FORCE).force)
    assert platform.of_other_waves(0.0) is None
    turned = platform.of_other_waves(30.0)
    assert turned is not None and turned.key == "headings of excitation.file"


@pytest.mark.parametrize(
    ("file", "pattern", "by", "expected"),
    [
        ("Nemoh.cal", r"^1 0\. 1\.", "1 0. 0.", "degrees of freedom: expected surge, sway, heave, roll, pitch, yaw"),
        ("Nemoh.cal", r"^2 0\. 1\. 0\. 0\. 0\. 0\.000000(\s+! Pitch)", r"2 0. 1. 0. 0. 0. 1.\1", "about one point"),
        ("Nemoh.cal", r"^1000\.000000", "heavy", "line 2: expected 1 numbers first"),
        (RADIATION, r"VARIABLES=.*", "TITLE", "VARIABLES="),
        (RADIATION, r"0\.9000000E\+00", "nought", "expected numbers"),
        (RADIATION, r"DoF   4", "DoF   9", "a zone of motion in roll of body 1"),
        (RADIATION, r"^  0\.9000000E\+00.*$", "  0.5", "rows of 13 finite numbers"),
    ],
)
def test_what_is_wrong_is_told(case: Path, file: str, pattern: str, by: str, expected: str) -> None:
    edit(case / file, pattern, by)
    with pytest.raises(InputError) as error:
        read_nemoh_radiation(case / RADIATION)
    assert expected in str(error.value) and Path(file).name in str(error.value)


def test_what_is_missing_is_told(case: Path) -> None:
    assert_allclose(nemoh_headings(case / FORCE), [0.0], atol=1e-9)
    with pytest.raises(InputError, match="waves of heading 30 deg, found 0 deg"):
        read_nemoh_excitation(case / FORCE, heading=30.0)
    with pytest.raises(InputError, match="body: expected six forces of body 2, found 0"):
        read_nemoh_radiation(case / RADIATION, body=2)
    (case / "mesh/Hydrostatics.dat").unlink()
    with pytest.raises(InputError, match=r"expected Hydrostatics\.dat beside it"):
        read_nemoh_hydrostatics(case / "mesh/KH.dat", density=DENSITY, gravity=GRAVITY)
    (case / "Nemoh.cal").unlink()
    with pytest.raises(InputError, match=r"expected Nemoh\.cal beside it or in the folder above"):
        read_nemoh_radiation(case / RADIATION)
