"""Tables of other programs: Capytaine's datasets, WAMIT's columns and halves, hydrostatics; against closed forms."""

import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose
from typer.testing import CliRunner

import jaxhydro as jh
from jaxhydro.cli import app as cli
from jaxhydro.dynamics.statics import linearised
from jaxhydro.errors import InputError
from jaxhydro.interop.capytaine_radiation import read_capytaine
from jaxhydro.interop.capytaine_waves import read_capytaine_excitation, read_capytaine_hydrostatics
from jaxhydro.interop.retardation import realise
from jaxhydro.interop.wamit_drift import read_transfer
from jaxhydro.interop.wamit_excitation import read_excitation
from jaxhydro.interop.wamit_hydrostatics import read_hydrostatics
from jaxhydro.interop.wamit_radiation import read_wamit
from jaxhydro.loads import Buoyancy
from jaxhydro.platform.computed_hydrostatics import hydrostatic_stiffness
from jaxhydro.platform.table_checks import LongWaves, asymmetry, excitation_column
from jaxhydro.sweep.prepared_sweep import _platform_text
from jaxhydro.waves.dispersion import wavenumber

CYLINDER = Path(__file__).parents[1] / "data" / "capytaine-cylinder.nc"  # by Capytaine 3.0: radius 1 m, draught 3 m, 50 m deep
RHO, G, RADIUS, DRAUGHT = 1000.0, 9.81, 1.0, 3.0
AREA, VOLUME = math.pi * RADIUS**2, math.pi * RADIUS**2 * DRAUGHT
REFERENCE = Path(__file__).resolve().parents[3] / "shared" / "reference" / "iea15-umaine" / "HydroData"
WAMIT = REFERENCE / "IEA-15-240-RWT-UMaineSemi.1"


def changed(folder: Path, change, name: str = "hull.nc") -> Path:
    with xr.open_dataset(CYLINDER) as data:
        change(data.load()).to_netcdf(folder / name, engine="h5netcdf")
    return folder / name


# Capytaine


def test_frequencies_that_capytaine_skipped_are_left_out() -> None:
    """k h < 0.1 at 0.02 rad/s: Capytaine 3.0 itself left NaN there."""
    notes: list[str] = []
    coefficients = read_capytaine(CYLINDER, notes=notes)
    assert_allclose(coefficients.omega, np.r_[0.2, np.arange(0.6, 5.01, 0.4)])
    assert np.isfinite(coefficients.added_mass).all() and np.isfinite(coefficients.damping).all()
    assert any("1 frequency left out, at which nothing was computed (NaN): omega 0.02 rad/s" in note for note in notes)
    notes = []
    assert read_capytaine_excitation(CYLINDER, notes=notes).omega[0] == 0.2 and any("omega 0.02 rad/s" in n for n in notes)


def test_a_frequency_that_is_partly_missing_is_told(tmp_path: Path) -> None:
    def heave_only(data):
        data["added_mass"].loc[{"omega": 1.0, "influenced_dof": "Heave"}] = np.nan
        return data

    def one_variable(data):
        data["radiation_damping"].loc[{"omega": 1.0}] = np.nan
        return data

    def excited(data):
        data["excitation_force"].loc[{"omega": 1.0, "influenced_dof": "Heave"}] = np.nan
        return data

    with pytest.raises(InputError, match=r"added_mass: expected finite numbers, found 3 that are not, at omega 1 rad/s"):
        read_capytaine(changed(tmp_path, heave_only))
    with pytest.raises(InputError, match=r"numbers for both at each frequency, found one alone at omega 1 rad/s"):
        read_capytaine(changed(tmp_path, one_variable))
    with pytest.raises(InputError, match=r"excitation_force: expected finite numbers, found \d that are not, at omega 1 rad/s"):
        read_capytaine_excitation(changed(tmp_path, excited))


def test_long_waves_lift_by_the_waterplane_and_push_by_the_acceleration() -> None:
    """X3 -> rho g A in phase with the crest; X1 -> i rho V (1 + Ca) g k, a quarter period ahead; X5 = z X1 at mid-draught."""
    table = read_capytaine_excitation(CYLINDER)
    omega, force = np.asarray(table.omega), np.asarray(table.force)
    mass = read_capytaine(CYLINDER).added_mass
    assert_allclose(force[2, 0], RHO * G * AREA, rtol=0.04)
    k = float(wavenumber(omega[0], 50.0, G))
    surge = 1j * G * k * (RHO * VOLUME + mass[0, 0, 0])
    assert abs(force[0, 0] / surge - 1) < 0.08
    assert abs(force[4, 0] / (-0.5 * DRAUGHT * force[0, 0]) - 1) < 0.1
    slanted = np.asarray(read_capytaine_excitation(CYLINDER, heading=30.0).force)
    assert_allclose(slanted[0], force[0] * math.cos(math.pi / 6), rtol=1e-3, atol=1e-2 * abs(force[0]).max())
    with pytest.raises(InputError, match=r"waves of heading 45 deg, found 0, 30 deg \(in the file in rad\)"):
        read_capytaine_excitation(CYLINDER, heading=45.0)


def test_froude_krylov_and_diffraction_add_up(tmp_path: Path) -> None:
    """Where a dataset has no excitation_force; complex numbers may also be the file's own."""
    whole = np.asarray(read_capytaine_excitation(CYLINDER).force)
    parts = changed(tmp_path, lambda data: data.drop_vars("excitation_force"))
    assert_allclose(read_capytaine_excitation(parts).force, whole, rtol=1e-9, atol=1e-6)
    lone = changed(tmp_path, lambda data: data.drop_vars(["excitation_force", "diffraction_force"]), "lone.nc")
    with pytest.raises(InputError, match="excitation_force: expected this variable, or Froude_Krylov_force and diffraction"):
        read_capytaine_excitation(lone)
    swapped = changed(tmp_path, lambda data: data.isel(complex=[1, 0]), "swapped.nc")
    assert_allclose(read_capytaine_excitation(swapped).force, whole, rtol=1e-9)


def test_motions_about_another_point_are_moved_to_the_reference_point() -> None:
    """The dataset's are about z = -1.5 m: about the surface A15 = -1.5 A11 + a part of its own, A55 by both (parallel axes)."""
    notes: list[str] = []
    coefficients = read_capytaine(CYLINDER, notes=notes)
    with xr.open_dataset(CYLINDER) as data:
        own = data.added_mass.sel(omega=1.0).transpose("influenced_dof", "radiating_dof").values
    moved = coefficients.added_mass[list(coefficients.omega).index(1.0)]
    assert_allclose(moved[0, 4], own[0, 2] - 1.5 * own[0, 0], rtol=1e-9)
    assert_allclose(moved[4, 4], own[2, 2] - 1.5 * (own[0, 2] + own[2, 0]) + 2.25 * own[0, 0], rtol=1e-9)
    assert_allclose(moved[2, 2], own[1, 1])
    assert any("computed about (0, 0, -1.5) m: moved" in note for note in notes)


def test_forces_are_scaled_to_the_platforms_water() -> None:
    notes: list[str] = []
    assert_allclose(read_capytaine(CYLINDER, density=1025.0, notes=notes).damping, 1.025 * read_capytaine(CYLINDER).damping)
    assert any("computed for a density of 1000 kg/m3" in note for note in notes)
    scaled = read_capytaine_excitation(CYLINDER, density=1025.0).force
    assert_allclose(scaled, 1.025 * np.asarray(read_capytaine_excitation(CYLINDER).force))


def two_bodies(data: xr.Dataset) -> xr.Dataset:
    """The cylinder and one at x = 10 m with twice its coefficients, as Capytaine names motions of several bodies."""

    def named(dataset: xr.Dataset, name: str, factor: float) -> xr.Dataset:
        dofs = {dim: [f"{name}__{dof}" for dof in data[dim].values] for dim in ("radiating_dof", "influenced_dof")}
        return (factor * dataset).assign_coords(dofs)

    names = ["added_mass", "radiation_damping", "excitation_force", "hydrostatic_stiffness"]
    data = data[names].drop_vars(["body", "center_of_mass", "rotation_center"], errors="ignore")
    merged = xr.merge([named(data, "buoy", 1.0), named(data, "float", 2.0)], join="outer").fillna(0.0)
    for name in names[:3]:
        merged[name] = merged[name].where(merged.omega != 0.02)
    centres = (("body", "space_coordinate"), [[0.0, 0, 0], [10.0, 0, 0]])
    return merged.assign_coords(body=["buoy", "float"], rotation_center=centres, rho=1000.0, g=9.81, water_depth=50.0)


def test_one_of_several_bodies_is_chosen_by_its_name(tmp_path: Path) -> None:
    path = changed(tmp_path, two_bodies)
    for read in (read_capytaine, read_capytaine_excitation, read_capytaine_hydrostatics):
        with pytest.raises(InputError, match=r"expected the name of a body in `body`, found none\. The dataset has buoy,"):
            read(path)
        with pytest.raises(InputError, match=r"body: expected one of buoy, float, found 'floot'\. Did you mean 'float'\?"):
            read(path, body="floot")
    first, second = (read_capytaine(path, body=name) for name in ("buoy", "float"))
    assert_allclose(second.added_mass, 2 * first.added_mass)
    assert_allclose(first.added_mass[:, 2, 2], read_capytaine(CYLINDER).added_mass[:, 2, 2])
    assert_allclose(read_capytaine_hydrostatics(path, body="float").stiffness[2, 2], 2 * RHO * G * AREA, rtol=0.02)
    # waves reach the second body k 10 m later; its reference point is its own
    near, far = (np.asarray(read_capytaine_excitation(path, body=name).force)[2] for name in ("buoy", "float"))
    k = np.asarray(wavenumber(read_capytaine(path, body="buoy").omega, 50.0, 9.81))
    assert_allclose(far, 2 * near * np.exp(10j * k), rtol=1e-9)


def test_hydrostatics_of_a_dataset() -> None:
    """C33 = rho g A, C55 = rho g (I + V z_b) - weight, V: of a cylinder of 1 m and 3 m (flat panels have 1 % less)."""
    hydrostatics = read_capytaine_hydrostatics(CYLINDER)
    assert_allclose(hydrostatics.stiffness[2, 2], RHO * G * AREA, rtol=0.015)
    assert_allclose(hydrostatics.volume, VOLUME, rtol=0.015)
    own = RHO * G * (math.pi / 4 * RADIUS**4 - 1.5 * VOLUME)
    assert_allclose(hydrostatics.stiffness[4, 4] + RHO * G * hydrostatics.volume * hydrostatics.centre_of_mass, own, rtol=0.015)


PLATFORM = """
name: cylinder
water: {{density: 1000.0, depth: 50.0, gravity: 9.81}}
rigid_body: {{mass: {mass}, centre_of_mass: [0, 0, {centre}], inertia: {{Ixx: 9.0e3, Iyy: 9.0e3, Izz: 5.0e3}}}}
mooring: {{kind: stiffness_matrix, stiffness: {{C11: 100.0, C22: 100.0, C66: 1.0e4, C44: 1.0e5, C55: 1.0e5}}}}
"""


def model_of(folder: Path, *lines: str, centre: float = -1.5, mass: float = 9317.0, name: str = "platform.yaml") -> jh.Model:
    text = PLATFORM.format(mass=mass, centre=centre) + "\n".join(lines)
    (folder / name).write_text(text.replace("CYLINDER", str(CYLINDER)), encoding="utf-8")
    return jh.load_model(folder / name)


def restoring(model: jh.Model) -> np.ndarray:
    """C33, C44, C55 at rest, without the mooring's."""
    stiffness = np.asarray(linearised(model, np.zeros(6))[1])
    return np.diag(stiffness)[2:5] - [0.0, 1e5, 1e5]


@pytest.mark.slow
def test_a_platform_of_one_dataset_moves_as_potential_theory_has_it(tmp_path: Path) -> None:
    """Heave by time simulation: |X3 / (C33 - omega^2 (M + A33) + i omega B33)|, all of the dataset."""
    lines = [f"{key}: {{file: CYLINDER}}" for key in ("hydrostatics", "radiation", "excitation")]
    data = read_capytaine(CYLINDER)
    i = list(data.omega.round(3)).index(1.4)
    omega, rises = data.omega[i], realise(data).transfer(data.omega)[:, 2, 2].imag / data.omega
    infinite = float((data.added_mass[:, 2, 2] - rises).mean())
    model = model_of(tmp_path, *lines, f"added_mass: {{A33: {infinite}, A11: 5000, A22: 5000, A44: 1.0e4, A55: 1.0e4}}")
    sea = jh.regular_wave(0.02, 2 * math.pi / omega, model.environment, ramp=60.0)
    motion = jh.simulate(model, np.arange(0.0, 400.0, 0.1), sea)
    amplitude = 0.5 * np.ptp(np.asarray(motion["heave"])[-200:])
    x = np.asarray(read_capytaine_excitation(CYLINDER).force)[2, i]
    c = read_capytaine_hydrostatics(CYLINDER).stiffness[2, 2]
    expected = abs(x / (c - omega**2 * (9317.0 + data.added_mass[i, 2, 2]) + 1j * omega * data.damping[i, 2, 2]))
    assert_allclose(amplitude / 0.01, expected, rtol=0.03)
    assert {remark.warning for remark in model.remarks} == {False} and len(model.remarks) >= 3


def test_hydrostatics_follow_the_platforms_own_weight(tmp_path: Path) -> None:
    """A file's C44 has the weight where its own mass was; a platform with another centre of mass has its own."""
    own = read_capytaine_hydrostatics(CYLINDER)
    for centre in (-1.5, -2.0):
        model = model_of(tmp_path, "hydrostatics: {file: CYLINDER}", centre=centre, mass=RHO * own.volume)
        expected = [own.stiffness[2, 2], *[own.stiffness[4, 4] - RHO * G * own.volume * (centre + 1.5)] * 2]
        assert_allclose(restoring(model)[[0, 2]], np.array(expected)[[0, 2]], rtol=1e-6)
    model = model_of(tmp_path, "hydrostatics: {file: CYLINDER, C33: 12345.0}")
    assert_allclose(restoring(model)[0], 12345.0, rtol=1e-6)


# hydrostatics of WAMIT


def hst(folder: Path, entries: dict[tuple[int, int], float], name: str = "hull.hst") -> Path:
    rows = [f"{i} {j} {entries.get((i, j), 0.0):.6E}" for i in range(1, 7) for j in range(1, 7)]
    (folder / name).write_text("\n".join(rows) + "\n", encoding="utf-8")
    return folder / name


OUT = """
   Volumes (VOLX,VOLY,VOLZ):        9.31700       9.31800       9.31900
   Center of Buoyancy (Xb,Yb,Zb):     0.000000     0.000000    -1.500000
   Hydrostatic and gravitational restoring coefficients:
   C(3,3),C(3,4),C(3,5):   3.1000         0.0000         0.2000
               C(4,4),C(4,5),C(4,6):                5.0000         0.0000        0.0000
                             C(5,5),C(5,6):                      6.0000         0.0000
   Center of Gravity  (Xg,Yg,Zg):     0.000000     0.000000    -2.000000
"""


def test_a_hst_file_is_made_dimensional(tmp_path: Path) -> None:
    """rho g L^2 for heave, L^3 for heave with pitch, L^4 for rotations."""
    path = hst(tmp_path, {(3, 3): 3.0, (4, 4): 5.0, (5, 5): 6.0, (3, 5): -0.5, (5, 3): -0.5})
    hydrostatics = read_hydrostatics(path, RHO, G, length=2.0)
    assert_allclose(np.diag(hydrostatics.stiffness), RHO * G * np.array([0, 0, 3.0 * 4, 5.0 * 16, 6.0 * 16, 0]))
    assert_allclose([hydrostatics.stiffness[2, 4], hydrostatics.stiffness[4, 2]], RHO * G * -0.5 * 8)
    assert hydrostatics.volume is None


def test_a_platform_takes_its_stiffness_from_a_hst_file(tmp_path: Path) -> None:
    """With the weight, as WAMIT defines C44; without, as files for OpenFAST have it; couplings as well."""
    hst(tmp_path, {(3, 3): 3.0, (4, 4): 15.0, (5, 5): 16.0, (3, 5): -0.5, (5, 3): -0.5})
    model = model_of(tmp_path, "hydrostatics: {file: hull.hst}")
    assert_allclose(restoring(model), RHO * G * np.array([3.0, 15.0, 16.0]), rtol=1e-6)
    assert_allclose(np.asarray(linearised(model, np.zeros(6))[1])[2, 4], RHO * G * -0.5, rtol=1e-6)
    assert any("to include the weight" in remark.text for remark in model.remarks)
    model = model_of(tmp_path, "hydrostatics: {file: hull.hst, weight: excluded}")
    weight = -9317.0 * G * -1.5
    assert_allclose(restoring(model), RHO * G * np.array([3.0, 15.0, 16.0]) + [0.0, weight, weight], rtol=1e-6)
    assert not model.remarks


def test_an_out_file_has_the_volume_and_its_own_weight(tmp_path: Path) -> None:
    """C44 about the platform's weight: C44 + rho g V z_g of the file is buoyancy's."""
    (tmp_path / "hull.out").write_text(OUT, encoding="utf-8")
    hydrostatics = read_hydrostatics(tmp_path / "hull.out", RHO, G)
    assert hydrostatics.volume == 9.318 and hydrostatics.centre_of_mass == -2.0
    assert_allclose(hydrostatics.stiffness[2, 4], 0.2 * RHO * G)
    model = model_of(tmp_path, "hydrostatics: {file: hull.out}", mass=9318.0)
    weights = RHO * G * 9.318 * (-2.0 + 1.5)
    assert_allclose(restoring(model), [3.1 * RHO * G, 5.0 * RHO * G + weights, 6.0 * RHO * G + weights], rtol=1e-6)


def test_a_sweeps_copy_finds_the_file_of_hydrostatics(tmp_path: Path) -> None:
    hst(tmp_path, {(3, 3): 3.0, (4, 4): 15.0, (5, 5): 16.0})
    own = model_of(tmp_path, "hydrostatics: {file: hull.hst}")
    (store := tmp_path / "store").mkdir()
    (store / "platform.yaml").write_text(_platform_text(str(tmp_path / "platform.yaml")), encoding="utf-8")
    assert_allclose(restoring(jh.load_model(store / "platform.yaml")), restoring(own))


def test_members_tell_whether_a_hst_file_has_the_weight(tmp_path: Path) -> None:
    members = (
        "members: [{name: column, shape: circ, d: 2.0, rA: [0, 0, -3], rB: [0, 0, 2]}]",
        "coefficients: {column: {Ca_t: 1.0}}",
    )
    own = model_of(tmp_path, *members)
    buoyancy = next(load for load in own.loads if isinstance(load, Buoyancy))
    c44 = hydrostatic_stiffness(buoyancy, RHO * G)[3, 3] / (RHO * G)
    hst(tmp_path, {(3, 3): math.pi, (4, 4): c44, (5, 5): c44})
    warned = [remark for remark in model_of(tmp_path, *members, "hydrostatics: {file: hull.hst}").remarks if remark.warning]
    assert "fits the members with the weight excluded, not included: see `hydrostatics.weight`" in warned[0].text
    fine = model_of(tmp_path, *members, "hydrostatics: {file: hull.hst, weight: excluded}")
    assert not fine.remarks
    assert_allclose(restoring(fine), restoring(own), rtol=1e-3)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("1 1 0.0\n3 3 x\n", "line 2: expected 3 numbers I J C(I,J), found '3 3 x'"),
        ("3 3 1.0\n3 3 1.0\n", "line 2: expected each pair once, found 3 3 again"),
        ("3 3 1.0\n9 9 1.0\n", "line 2: expected motions I and J of one body, 1 to 6, found 9 9. A file of 2 or more bodies"),
        ("3 3 1.0\n5 5 1.0\n3 5 0.5\n5 3 -0.5\n", "C35: expected the same number as C53, found 0.5 and -0.5"),
        ("", "expected rows of 3 numbers I J C(I,J), found none"),
        ("3 3 -1.0\n", "C33: expected a stiffness >= 0"),
    ],
)
def test_broken_hst_files_are_told(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "hull.hst").write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        model_of(tmp_path, "hydrostatics: {file: hull.hst}")
    assert words in str(caught.value)


# the first column of WAMIT's files


def wamit_files(folder: Path, by: str, column: np.ndarray | None = None) -> None:
    """The cylinder's coefficients as .1 and .3, the first column by period, rad/s or Hz."""
    data, waves = read_capytaine(CYLINDER), read_capytaine_excitation(CYLINDER)
    first = {"period": 2 * math.pi / data.omega, "rad/s": data.omega, "Hz": data.omega / (2 * math.pi)}[by]
    rows_1, rows_3 = [], []
    for k, w in enumerate(data.omega):
        for i in range(6):
            for j in range(6):
                if (i + j) % 2 == 0:
                    a, b = data.added_mass[k, i, j] / RHO, data.damping[k, i, j] / RHO / w
                    rows_1.append(f"{first[k]:.6E} {i + 1} {j + 1} {a:.6E} {b:.6E}")
            x = complex(waves.force[i, k]) / (RHO * G)
            rows_3.append(f"{first[k]:.6E} 0.0 {i + 1} {abs(x):.6E} {np.degrees(np.angle(x)):.4f} {x.real:.6E} {x.imag:.6E}")
    (folder / "hull.1").write_text("\n".join(rows_1) + "\n", encoding="utf-8")
    (folder / "hull.3").write_text("\n".join(rows_3) + "\n", encoding="utf-8")


@pytest.mark.parametrize("by", ["period", "rad/s", "Hz"])
def test_files_by_period_or_frequency_are_one(tmp_path: Path, by: str) -> None:
    data, waves = read_capytaine(CYLINDER), read_capytaine_excitation(CYLINDER)
    wamit_files(tmp_path, by)
    radiation = read_wamit(tmp_path / "hull.1", RHO, by=by)
    assert_allclose(radiation.omega, data.omega, rtol=1e-5)
    assert_allclose(radiation.damping[:, 2, 2], data.damping[:, 2, 2], rtol=1e-4)
    force = read_excitation(tmp_path / "hull.3", RHO, G, by=by)
    assert_allclose(force.omega, data.omega, rtol=1e-5)
    assert_allclose(force.force, waves.force, atol=1e-5 * np.abs(waves.force).max())
    omega = np.array([0.4, 0.7, 1.0])
    first = {"period": 2 * math.pi / omega, "rad/s": omega, "Hz": omega / (2 * math.pi)}[by]
    rows = [[p, q, 0, 0, 1, abs(i + j), 0, i + j, 0] for i, p in enumerate(first) for j, q in enumerate(first) if i <= j]
    np.savetxt(tmp_path / "hull.12d", rows, fmt="%.9e")
    assert_allclose(read_transfer(tmp_path / "hull.12d", RHO, G, by=by).omega, omega, rtol=1e-6)


@pytest.mark.parametrize(("true", "declared"), [(a, b) for a in ("period", "rad/s", "Hz") for b in ("period", "rad/s", "Hz")])
def test_a_column_that_is_another_is_told(tmp_path: Path, true: str, declared: str) -> None:
    """By the force of long waves; nothing where the column is what was declared."""
    wamit_files(tmp_path, true)
    table = read_excitation(tmp_path / "hull.3", RHO, G, by=declared)
    hull = LongWaves(RHO * G * AREA, RHO * VOLUME, 50.0, G)
    remarks = excitation_column(np.asarray(table.omega), np.asarray(table.force), declared, "hull.3", hull)
    assert bool(remarks) == (true != declared)
    if remarks:
        assert "the first column is probably" in remarks[0] and remarks[0].endswith(f"See `excitation.by`: {true}")


def test_a_column_by_frequency_of_deeper_water() -> None:
    """Forces of deep water, k = omega^2 / g, for a platform in 50 m, whose long waves are shorter and push more."""
    omega = np.linspace(0.2, 6.0, 30)
    k = omega**2 / G
    force = np.zeros((6, 30), complex)
    force[0], force[2] = 1j * k * RHO * G * VOLUME * np.exp(-k), RHO * G * AREA * np.exp(-k * DRAUGHT)
    as_read = 2 * np.pi / omega
    hull = LongWaves(RHO * G * AREA, RHO * VOLUME, 50.0, G)
    (remark,) = excitation_column(as_read, force, "period", "hull.3", hull)
    assert remark.endswith("See `excitation.by`: rad/s")


@pytest.mark.slow
def test_a_wrong_column_leads_the_output(tmp_path: Path) -> None:
    """The warning comes before everything else; with the key there is none, and heave is right."""
    wamit_files(tmp_path, "rad/s")
    outputs = []
    for key in ("", ", by: rad/s"):
        model_of(tmp_path, "hydrostatics: {file: CYLINDER}", f"excitation: {{file: hull.3{key}}}", "added_mass: {A33: 2000}")
        words = ["simulate", str(tmp_path / "platform.yaml"), "--wave-height", "0.1", "--wave-period", "3", "--duration", "20"]
        result = CliRunner().invoke(cli.app, [*words, "--out", str(tmp_path / f"out{len(outputs)}")])
        assert result.exit_code == 0, result.output
        outputs.append(result.output)
    assert outputs[0].lstrip().startswith("jaxhydro: warning:") and "by`: rad/s" in outputs[0]
    assert "warning" not in outputs[1]


def test_radiation_tells_a_period_from_a_frequency(tmp_path: Path) -> None:
    """Added mass follows from damping by Kramers and Kronig in the right column only; one column under two names is told."""
    wamit_files(tmp_path, "period")
    fine = model_of(tmp_path, "radiation: {file: hull.1}")
    assert not fine.remarks
    wamit_files(tmp_path, "rad/s")
    with pytest.raises(InputError, match=r"the first column is probably a frequency: `radiation\.by`: rad/s or Hz"):
        model_of(tmp_path, "radiation: {file: hull.1}")
    mixed = model_of(tmp_path, "radiation: {file: hull.1, by: rad/s}", "excitation: {file: hull.3, by: Hz}")
    assert any("have the same first column, and are read by rad/s and by Hz" in remark.text for remark in mixed.remarks)


def test_drift_tells_a_period_from_a_frequency(tmp_path: Path) -> None:
    """Short waves drift, long ones do not; a coarser table that has some of the other's numbers is of their column, too."""
    omega = np.linspace(0.4, 3.2, 8)
    curve = 0.5 * omega**4 / (1 + omega**4)
    pairs = [(p, q, 0.5 * (a + b)) for p, a in zip(omega, curve) for q, b in zip(omega, curve) if p <= q]
    rows = [[p, q, 0, 0, 1, t, 0, t, 0] for p, q, t in pairs]
    np.savetxt(tmp_path / "hull.12d", rows, fmt="%.9e")
    for by, expected in (("period", "the first column is probably a frequency: `drift.by`: rad/s or Hz"), ("rad/s", "")):
        model = model_of(tmp_path, f"drift: {{file: hull.12d, by: {by}}}")
        assert [remark.text.partition(": ")[2].partition(". ")[0] for remark in model.remarks] == (
            [expected] if expected else []
        )
    fine = np.linspace(0.4, 3.2, 15)
    np.savetxt(tmp_path / "hull.3", [[w, 0, 3, 1.0, 0.0, 1.0, 0.0] for w in fine], fmt="%.9e")
    model = model_of(tmp_path, "drift: {file: hull.12d, by: rad/s}", "excitation: {file: hull.3, by: Hz}")
    assert any("have the same first column, and are read by Hz and by rad/s" in remark.text for remark in model.remarks)


def test_coefficients_that_are_not_symmetric_are_told() -> None:
    coefficients = read_capytaine(CYLINDER)
    assert not asymmetry(coefficients, "hull.1")
    coefficients.damping[:, 0, 4] *= 1.5
    assert asymmetry(coefficients, "hull.1")[0].startswith("hull.1: damping is not symmetric: (1, 5) and (5, 1) differ by")


@pytest.mark.skipif(not WAMIT.is_file(), reason="../shared/reference has no iea15-umaine")
def test_a_published_hull_has_nothing_to_tell() -> None:
    """VolturnUS-S by its WAMIT files, by periods: its heave and surge are those of long waves."""
    table = read_excitation(WAMIT.with_suffix(".3"), 1025.0, G)
    hull = LongWaves(4.45e6, 20.2e6, 200.0, G)
    assert not excitation_column(np.asarray(table.omega), np.asarray(table.force), "period", "x", hull)
    statics = read_hydrostatics(WAMIT.with_suffix(".hst"), 1025.0, G)
    assert_allclose([statics.stiffness[2, 2], statics.stiffness[3, 3]], [4.455e6, 2.194e9], rtol=1e-3)


# bodies and halves in WAMIT's files


def test_one_of_several_bodies_of_a_wamit_file_is_chosen_by_its_number(tmp_path: Path) -> None:
    wamit_files(tmp_path, "period")
    lines = (tmp_path / "hull.1").read_text(encoding="utf-8").splitlines()
    three = (tmp_path / "hull.3").read_text(encoding="utf-8").splitlines()
    moved = [line.split() for line in lines]
    second = [" ".join([p, str(int(i) + 6), str(int(j) + 6), str(3 * float(a)), b]) for p, i, j, a, b in moved]
    cross = [" ".join([p, i, str(int(j) + 6), a, b]) for p, i, j, a, b in moved]
    (tmp_path / "hull.1").write_text("\n".join([*lines, *second, *cross]) + "\n", encoding="utf-8")
    second_body = [" ".join([p, beta, str(int(i) + 6), *numbers]) for p, beta, i, *numbers in (line.split() for line in three)]
    (tmp_path / "hull.3").write_text("\n".join([*three, *second_body]) + "\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"motions I and J of one body, 1 to 6, found 7 7. A file of 2 bodies: say which"):
        read_wamit(tmp_path / "hull.1", RHO)
    with pytest.raises(InputError, match=r"a mode from 1 to 6, .* A file of 2 bodies: say which, `body: 1` to `body: 2`"):
        read_excitation(tmp_path / "hull.3", RHO, G)
    first, body_2 = (read_wamit(tmp_path / "hull.1", RHO, body=body) for body in (1, 2))
    assert_allclose(body_2.added_mass, 3 * first.added_mass, rtol=1e-6)
    assert_allclose(
        read_excitation(tmp_path / "hull.3", RHO, G, body=2).force, read_excitation(tmp_path / "hull.3", RHO, G, body=1).force
    )
    with pytest.raises(InputError, match="body: expected rows of body 3"):
        read_wamit(tmp_path / "hull.1", RHO, body=3)
    with pytest.raises(InputError, match="body: expected rows of body 3"):
        read_excitation(tmp_path / "hull.3", RHO, G, body=3)


def test_halves_that_contradict_each_other_are_told(tmp_path: Path) -> None:
    """Both halves have to be conjugate, a pair given twice one value, and the diagonal real."""
    fine = [[8, 8, 1, 0], [8, 9, 1, 2], [9, 8, 1, -2], [9, 9, 1.5, 0]]

    def read(rows: list[list[float]]) -> None:
        table = [[p, q, 0, 0, 1, abs(x + 1j * y), np.degrees(np.angle(x + 1j * y)), x, y] for p, q, x, y in rows]
        np.savetxt(tmp_path / "hull.12d", table, fmt="%.9e")
        read_transfer(tmp_path / "hull.12d", RHO, G)

    read(fine)
    for rows, pair in (
        ([*fine[:2], [9, 8, 1, 2], fine[3]], "9 s and 8 s"),
        ([*fine[:2], [9, 8, 1.2, -2], fine[3]], "9 s and 8 s"),
        ([*fine, [8, 9, 3, 2]], "9 s and 8 s"),
        ([[8, 8, 1, 0.5], *fine[1:]], "8 s and 8 s"),
    ):
        with pytest.raises(InputError, match=f"surge: expected one value for {pair}, given twice"):
            read(rows)
    read([*fine[:2], [9, 8, 1.0001, -2], fine[3]])


def test_polar_columns_that_contradict_are_told(tmp_path: Path) -> None:
    warnings: list[str] = []
    wamit_files(tmp_path, "period")
    read_excitation(tmp_path / "hull.3", RHO, G, warnings=warnings)
    assert not warnings
    rows = np.loadtxt(tmp_path / "hull.3")
    rows[:, 4] = -rows[:, 4]  # phases as lags
    np.savetxt(tmp_path / "hull.3", rows)
    read_excitation(tmp_path / "hull.3", RHO, G, warnings=warnings)
    assert "MOD and PHASE contradict RE and IM in" in warnings[0]


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("excitation: {file: CYLINDER, by: Hz}", "excitation.by: expected no by, as Capytaine's files say it, found 'Hz'"),
        ("excitation: {file: CYLINDER, body: 2}", "excitation.body: expected a body's name in quotes, found 2"),
        ("excitation: {file: hull.3, body: buoy}", "excitation.body: expected a number, as WAMIT's files have no names"),
        ("excitation: {file: hull.3, by: s}", "excitation.by: expected one of period, rad/s, Hz, found 's'"),
        (
            "excitation: {file: hull.dat}",
            "excitation.format: expected wamit, capytaine or nemoh, as the file's ending",
        ),
        ("hydrostatics: {weight: excluded}", "hydrostatics.weight: expected a `file` with it, found none"),
        ("hydrostatics: {file: a.out, weight: excluded}", "hydrostatics.weight: expected no weight"),
        ("hydrostatics: {file: CYLINDER, length: 2.0}", "hydrostatics.length: expected no length"),
        (
            "hydrostatics: {file: hull.stiff}",
            "hydrostatics.format: expected wamit, capytaine or nemoh, as the file's ending",
        ),
        ("hydrostatics: {file: none.hst}", "none.hst: expected a WAMIT .hst or .out file, found no such file"),
    ],
)
def test_wrong_keys_are_told(tmp_path: Path, line: str, words: str) -> None:
    with pytest.raises(InputError) as caught:
        model_of(tmp_path, line)
    assert words in str(caught.value)


# what else programs write


def test_other_layouts_of_a_dataset_are_one(tmp_path: Path) -> None:
    """Frequencies by period with omega beside them, radiating before influenced motion, a dimension of one density, infinite
    depth: as other versions and other test matrices of Capytaine have it."""

    def by_period(data: xr.Dataset) -> xr.Dataset:
        data = data.assign_coords(period=("omega", 2 * np.pi / data.omega.values)).swap_dims(omega="period").reset_coords()
        data = data.set_coords([name for name in ("omega", "rho", "g", "wave_direction") if name in data])
        return data.transpose(..., "radiating_dof", "influenced_dof").assign(water_depth=np.inf)

    path = changed(tmp_path, by_period)
    assert_allclose(read_capytaine(path).damping, read_capytaine(CYLINDER).damping)
    assert_allclose(read_capytaine_excitation(path, depth=50.0).force, read_capytaine_excitation(CYLINDER).force)
    several = changed(tmp_path, lambda data: data.drop_vars("rho").expand_dims(rho=[1000.0]), "several.nc")
    assert_allclose(read_capytaine(several).damping, read_capytaine(CYLINDER).damping)


def test_another_depth_and_gravity_are_noted() -> None:
    notes: list[str] = []
    read_capytaine_excitation(CYLINDER, depth=20.0, gravity=1.62, notes=notes)
    assert any("a depth of 50 m, the platform has 20 m" in note for note in notes)
    assert any("a gravity of 9.81 m/s2, the platform has 1.62 m/s2" in note for note in notes)


def test_fortrans_exponents_and_headers_are_read(tmp_path: Path) -> None:
    """In all of WAMIT's files."""
    wamit_files(tmp_path, "period")
    rows = [f"{p} {q} 0 0 1 1.0E+00 0 1.0E+00 0" for p, q in ((8, 8), (8, 9), (9, 9))]
    (tmp_path / "hull.12d").write_text("\n".join(rows), encoding="utf-8")
    hst(tmp_path, {(3, 3): 3.0})
    readers = {
        "hull.1": lambda path: read_wamit(path, RHO).damping,
        "hull.3": lambda path: read_excitation(path, RHO, G).force,
        "hull.12d": lambda path: read_transfer(path, RHO, G).eigenvalue,
        "hull.hst": lambda path: read_hydrostatics(path, RHO, G).stiffness,
    }
    for name, read in readers.items():
        path = tmp_path / name
        before, text = np.asarray(read(path)), path.read_text(encoding="utf-8")
        path.write_text(f" WAMIT Numeric Output {name}\n{text.replace('E+', 'D+').replace('E-', 'D-')}", encoding="utf-8")
        assert_allclose(np.asarray(read(path)), before)
