"""`jaxhydro convert`: what it writes, and the same motions as of a platform made by hand."""

import json
import shutil
from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pandas as pd
import pytest
from one_program import one_program
from test_cli import run

import jaxhydro as jh
from jaxhydro.dynamics.response import decay_cycles
from jaxhydro.input_schema import read_yaml
from jaxhydro.interop.openfast_deck import read_openfast_deck
from jaxhydro.loads import CatenaryLines
from jaxhydro.platform.catenary_build import catenary_lines
from jaxhydro.platform.catenary_schema import Catenary
from jaxhydro.platform.mooring_schema import StiffnessMatrix
from jaxhydro.platform.schema import Platform, load_platform
from jaxhydro.waves.components import Components

ELLIPSOID = Path(__file__).resolve().parents[1] / "data" / "ellipsoid" / "nemoh-v3.0.2"
DECK = Path(__file__).resolve().parents[1] / "fixtures" / "openfast_deck"
REFERENCE = Path(__file__).resolve().parents[3] / "shared" / "reference"
IEA15 = REFERENCE / "iea15-umaine" / "IEA-15-240-RWT-UMaineSemi.fst"
with_reference = pytest.mark.skipif(not REFERENCE.exists(), reason=f"OpenFAST's decks and runs are not at {REFERENCE}")


def test_it_writes_a_platform_and_says_what_became_of_the_deck(tmp_path: Path) -> None:
    text = run("convert", DECK / "main.fst", "--out", tmp_path / "new")
    assert sorted(path.name for path in (tmp_path / "new").iterdir()) == ["conversion.md", "platform.yaml"]
    conversion = read_openfast_deck(DECK / "main.fst")
    assert load_platform(tmp_path / "new" / "platform.yaml") == Platform.model_validate(conversion.platform)
    page = (tmp_path / "new" / "conversion.md").read_text(encoding="utf-8")
    assert page.count("\n| ") == len(conversion.items) + 3  # and a heading of each of three tables
    assert all(item.source in page for item in conversion.items)
    assert f"{len(conversion.items)} items" in page and "taken" in text and "moordyn.dat: LINES 1, 2" in text
    assert (tmp_path / "new" / "platform.yaml").read_text(encoding="utf-8").startswith("# Made by `jaxhydro convert`")


def test_a_folder_that_is_not_empty_is_refused(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    assert "a folder that is new or empty" in run("convert", DECK / "main.fst", "--out", tmp_path, status=2)
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]


def test_broken_input_writes_nothing(tmp_path: Path) -> None:
    deck = shutil.copytree(DECK, tmp_path / "deck")
    text = (deck / "hydrodyn.dat").read_text(encoding="utf-8")
    (deck / "hydrodyn.dat").write_text(text.replace("  11        1         2 ", "  11        1        77 "), encoding="utf-8")
    told = run("convert", deck / "main.fst", "--out", tmp_path / "new", status=2)
    assert "hydrodyn.dat: line" in told and "found 77" in told
    assert not (tmp_path / "new").exists() and [path.name for path in tmp_path.iterdir()] == ["deck"]


def test_a_deck_that_is_no_platform_writes_nothing(tmp_path: Path) -> None:
    """A damping that gives energy is read, but no platform file may have it."""
    deck = shutil.copytree(DECK, tmp_path / "deck")
    text = (deck / "hydrodyn.dat").read_text(encoding="utf-8")
    (deck / "hydrodyn.dat").write_text(text.replace(" 2.0E4  0  0  0  1.0E5", "-2.0E4  0  0  0  1.0E5"), encoding="utf-8")
    told = run("convert", deck / "main.fst", "--out", tmp_path / "new", status=2)
    assert "linear_damping" in told and "main.fst, as platform.yaml" in told and not (tmp_path / "new").exists()


def test_other_files_are_answered_in_words(tmp_path: Path) -> None:
    assert "OpenFAST main file (.fst)" in run("convert", DECK / "hydrodyn.dat", "--out", tmp_path / "a", status=2)
    assert "Did you mean" in run("convert", DECK / "mian.fst", "--out", tmp_path / "a", status=2)
    assert "Name the file in it" in run("convert", DECK, "--out", tmp_path / "a", status=2)


def test_results_of_a_panel_program(tmp_path: Path) -> None:
    """What has to be filled in stands on top of the platform file, which loads, and in conversion.md."""
    folder = shutil.copytree(ELLIPSOID, tmp_path / "Ellipsoid")
    text = run("convert", folder, "--out", tmp_path / "new")
    names = ["ExcitationForce.tec", "Hydrostatics.dat", "KH.dat", "Nemoh.cal", "RadiationCoefficients.tec"]
    assert sorted(path.name for path in (tmp_path / "new").iterdir()) == [*names, "conversion.md", "platform.yaml"]
    head = (tmp_path / "new" / "platform.yaml").read_text(encoding="utf-8").split("name:")[0]
    assert "# To be filled in by hand:\n" in head and "#   rigid_body.inertia: " in head and "to be filled in: mooring" in text
    assert "## To be filled in by hand" in (tmp_path / "new" / "conversion.md").read_text(encoding="utf-8")
    periods = jh.natural_modes(jh.build(load_platform(tmp_path / "new" / "platform.yaml"))).period
    assert np.isfinite(periods).all() and len(periods) == 3  # heave, roll, pitch: nothing holds it in the others


def test_broken_results_write_nothing(tmp_path: Path) -> None:
    folder = shutil.copytree(ELLIPSOID, tmp_path / "Ellipsoid")
    path = folder / "results" / "RadiationCoefficients.tec"
    path.write_text(path.read_text(encoding="utf-8").replace("E+", "X+", 1), encoding="utf-8")
    assert "RadiationCoefficients.tec: " in run("convert", folder, "--out", tmp_path / "new", status=2)
    path.unlink()
    (folder / "results" / "ExcitationForce.tec").unlink()
    told = run("convert", folder, "--out", tmp_path / "new", status=2)
    assert "Ellipsoid: expected results/RadiationCoefficients.tec or results/ExcitationForce.tec, found neither" in told
    assert sorted(path.name for path in tmp_path.iterdir()) == ["Ellipsoid"]


def test_mooring_lines_alone(tmp_path: Path) -> None:
    """mooring.yaml has the section of the deck's platform, its water, and the tensions are told."""
    text = run("convert", DECK / "moordyn.dat", "--out", tmp_path / "new")
    assert sorted(path.name for path in (tmp_path / "new").iterdir()) == ["conversion.md", "mooring.yaml"]
    written = read_yaml(tmp_path / "new" / "mooring.yaml")
    assert written["mooring"] == read_openfast_deck(DECK / "main.fst").platform["mooring"] and written["water"]["depth"] == 80.0
    assert "tension at the fairleads in the reference position (kN): " in text and "Paste `mooring` of" in text
    page = (tmp_path / "new" / "conversion.md").read_text(encoding="utf-8")
    assert "# moordyn.dat as mooring.yaml" in page and "80 m is assumed" in page


def test_mooring_lines_of_a_platform_without(tmp_path: Path) -> None:
    """What asked for a mooring is gone, and the platform is held in surge."""
    text = run("convert", ELLIPSOID, "--mooring", DECK / "moordyn.dat", "--out", tmp_path / "new")
    platform = load_platform(tmp_path / "new" / "platform.yaml")
    assert isinstance(platform.mooring, Catenary) and platform.mooring.seabed.depth == 80.0
    assert "fill in: mooring" not in text and "tension at the fairleads" in text
    assert "warning: moordyn.dat: sea bed" in text  # tables of deep water, lines in 80 m
    page = (tmp_path / "new" / "conversion.md").read_text(encoding="utf-8")
    assert "moordyn.dat: lines 1, 2" in page and "| mooring |" not in page


def test_mooring_lines_that_do_not_fit_write_nothing(tmp_path: Path) -> None:
    lines, new = DECK / "moordyn.dat", tmp_path / "new"
    told = run("convert", DECK / "main.fst", "--mooring", lines, "--out", new, status=2)
    assert "a source without a mooring, found a mooring of kind catenary" in told
    assert "a platform beside --mooring" in run("convert", lines, "--mooring", lines, "--out", new, status=2)
    assert "found a folder" in run("convert", ELLIPSOID, "--mooring", DECK, "--out", new, status=2)
    assert "no such file" in run("convert", ELLIPSOID, "--mooring", tmp_path / "a.dat", "--out", new, status=2)
    text = lines.read_text(encoding="utf-8")
    (tmp_path / "short.dat").write_text(text.replace("225.0", "100.0"), encoding="utf-8")
    told = run("convert", tmp_path / "short.dat", "--out", new, status=2)
    assert "short.dat, as mooring.yaml: 2 problems" in told and "the fairlead is " in told
    assert not new.exists() and [path.name for path in tmp_path.iterdir()] == ["short.dat"]
    shutil.copy(lines, tmp_path / "lines.txt")
    assert "found lines.txt, short.dat. Name the file in it." in run("convert", tmp_path, "--out", new, status=2)


@with_reference
def test_the_public_deck_of_the_15_mw_platform() -> None:
    """The catenaries' pull is that which balances the platform that is made by hand."""
    conversion = read_openfast_deck(IEA15)
    platform, mine = Platform.model_validate(conversion.platform), load_platform("volturnus-s")
    assert isinstance(platform.mooring, Catenary) and isinstance(mine.mooring, StiffnessMatrix)
    lines = catenary_lines(platform.mooring, platform.water)
    tension, direction = map(np.asarray, one_program(CatenaryLines.tension)(lines, np.zeros(6), np.eye(3)))
    assert float(tension @ direction[2]) == pytest.approx(mine.mooring.preload[2], rel=5e-3)
    assert np.asarray(tension) == pytest.approx(2437e3, rel=5e-3)  # N, NREL/TP-5000-76773
    assert platform.hydrostatics.displaced_volume == pytest.approx(mine.hydrostatics.displaced_volume, rel=1e-4)
    # the public deck has other masses than the report; its blade file is not there: three of 65 t
    mass, _, _ = platform.rigid_body.combined()
    assert mass + 3 * 65e3 == pytest.approx(20.24e6, rel=2e-3)
    assert set(conversion.files) == {f"{IEA15.stem}{ending}" for ending in (".hst", ".1", ".3", ".12d")}


@with_reference
def test_a_deck_is_the_platform_made_by_hand() -> None:
    platform = Platform.model_validate(read_openfast_deck(REFERENCE / "openfast" / "ss1_c1" / "main.fst").platform)
    mine = load_platform("volturnus-s")
    (mass, centre, inertia), (own_mass, own_centre, own_inertia) = platform.rigid_body.combined(), mine.rigid_body.combined()
    assert mass == own_mass and centre == pytest.approx(own_centre) and inertia == pytest.approx(own_inertia, rel=1e-5)
    for group in ("column", "pontoon"):
        assert platform.coefficients[group].numbers() == pytest.approx(mine.coefficients[group].numbers(), rel=2e-8)
    assert platform.linear_damping.matrix() == pytest.approx(mine.linear_damping.matrix())


@with_reference
@pytest.mark.slow
@pytest.mark.parametrize("dof, channel", [("heave", "PtfmHeave"), ("pitch", "PtfmPitch")])
def test_motions_of_a_converted_deck(dof: str, channel: str) -> None:
    """Decays as OpenFAST has them, as close as those of the platform made by hand (`test_openfast`)."""
    folder = REFERENCE / "openfast" / f"decay_{dof}_strip"
    table = pd.read_csv(folder / "out.csv.gz", skiprows=[1]).astype(float)
    start = np.array(json.loads((folder / "setup.json").read_text(encoding="utf-8"))["q0"], dtype=float)
    unit = np.pi / 180 if dof == "pitch" else 1.0
    start[3:] *= np.pi / 180
    times, motion = table["Time"].to_numpy(), table[channel].to_numpy() * unit
    reference = decay_cycles(times, motion)
    ten = times <= reference.time[0] + 10 * reference.period[0]
    times, motion = times[ten], motion[ten]
    platform = Platform.model_validate(read_openfast_deck(folder / "main.fst").platform)
    found = np.asarray(jh.simulate(jh.build(platform), times, position=jnp.asarray(start), step=0.5)[dof])
    assert np.abs(found - motion).max() < 2e-3 * np.abs(start).max()


@with_reference
@pytest.mark.slow
def test_waves_of_a_converted_deck_with_tables(tmp_path: Path) -> None:
    """Motions at wave frequencies as OpenFAST has them, with potential flow, catenaries and difference-frequency forces."""
    run_folder = REFERENCE / "openfast" / "ss1_nwt"
    for path in (*run_folder.iterdir(), *(IEA15.parent / "HydroData").iterdir()):
        if path.is_file():
            shutil.copyfile(path, tmp_path / path.name)
    conversion = read_openfast_deck(tmp_path / "main.fst")
    assert conversion.platform["directions"] == "earth" and conversion.platform["waves_at"] == "mean"
    run("convert", tmp_path / "main.fst", "--out", tmp_path / "new")
    model = jh.build(load_platform(tmp_path / "new" / "platform.yaml"))
    rows = pd.read_csv(run_folder / "components.csv.gz", comment="#")
    columns = (rows[key].to_numpy() for key in ("amp_m", "omega_rad_s", "k_1_m", "phase_rad"))
    amplitude, omega, wavenumber, phase = map(jnp.asarray, columns)
    waves = Components(amplitude, omega, wavenumber, jnp.zeros(len(rows)), phase, first=int(rows["index"][0]))
    times, record = np.arange(0.0, 3900.0, 0.5), pd.read_csv(run_folder / "out.csv.gz", skiprows=[1]).astype(float)
    motion = jh.simulate(model, times, jh.IrregularSea(waves, model.environment), position=jnp.zeros(6), step=0.2)
    frequency, late = np.fft.rfftfreq(np.count_nonzero(times >= 300.0), 0.5), times >= 300.0

    def size(values: np.ndarray) -> float:
        spectrum = np.abs(np.fft.rfft(values[late] - values[late].mean())) ** 2
        return float(np.sqrt(spectrum[(frequency > 0.05) & (frequency < 0.3)].sum()))

    for dof, channel, unit in (("surge", "PtfmSurge", 1.0), ("heave", "PtfmHeave", 1.0), ("pitch", "PtfmPitch", np.pi / 180)):
        theirs = np.interp(times, record["Time"], record[channel]) * unit
        assert size(np.asarray(motion[dof])) == pytest.approx(size(theirs), rel=0.04)
