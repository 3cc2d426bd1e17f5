"""An OpenFAST deck as a platform: conventions by hand, ballast, moorings, broken input."""

import math
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from jaxhydro.errors import InputError
from jaxhydro.interop.conversion import Conversion, Treatment
from jaxhydro.interop.openfast_deck import read_openfast_deck
from jaxhydro.platform.schema import Platform

DECK = Path(__file__).resolve().parents[1] / "fixtures" / "openfast_deck"
MEMBER_ROWS = {
    line.split()[0]: line for line in (DECK / "hydrodyn.dat").read_text(encoding="utf-8").splitlines() if line.endswith("FALSE")
}
Edited = Callable[..., Conversion]


@pytest.fixture
def edited(tmp_path: Path) -> Edited:
    """The deck with words of one of its files replaced."""

    def read(file: str = "", old: str = "", new: str = "", *further: str) -> Conversion:
        folder = tmp_path / f"deck{len(list(tmp_path.iterdir()))}"
        shutil.copytree(DECK, folder)
        changes = [(file, old, new), *zip(further[::3], further[1::3], further[2::3])] if file else []
        for name, before, after in changes:
            text = (folder / name).read_text(encoding="utf-8")
            assert before in text
            (folder / name).write_text(text.replace(before, after, 1), encoding="utf-8")
        return read_openfast_deck(folder / "main.fst")

    return read


def part(conversion: Conversion, name: str) -> dict:
    return next(entry for entry in conversion.platform["rigid_body"]["parts"] if entry["name"] == name)


def member(conversion: Conversion, name: str) -> dict:
    return next(entry for entry in conversion.platform["members"] if entry["name"] == name)


def group_of(conversion: Conversion, name: str) -> dict:
    return conversion.platform["coefficients"][member(conversion, name)["group"]]


def said(conversion: Conversion, source: str, treatment: Treatment) -> str:
    return " ".join(i.meaning for i in conversion.items if source in i.source and i.treatment is treatment)


# --- mass


def test_mass_of_every_part(edited: Edited) -> None:
    """Integrals of the distributed tower and blades; the rotor's places by OverHang and Twr2Shft."""
    deck = edited()
    # 2 x (600 to 400 kg/m) over 30 m
    tower = part(deck, "tower")
    assert tower["mass"] == pytest.approx(30000.0)
    assert tower["centre_of_mass"][2] == pytest.approx(10 + 30 * (0.5 * 600 - 200 / 3) / 500, rel=1e-3)
    # a uniform rod of 20 m beginning 1 m off the apex
    blades = [part(deck, f"blade {k}") for k in (1, 2, 3)]
    assert [blade["mass"] for blade in blades] == pytest.approx([1200.0] * 3)
    assert np.mean([blade["centre_of_mass"] for blade in blades], axis=0) == pytest.approx([-3.0, 0.0, 42.0])
    assert blades[0]["centre_of_mass"] == pytest.approx([-3.0, 0.0, 53.0])
    assert blades[0]["inertia"]["Ixx"] == pytest.approx(1200 * 20**2 / 12, rel=0.011)
    assert part(deck, "hub")["centre_of_mass"] == pytest.approx([-2.5, 0.0, 42.0])
    assert part(deck, "nacelle")["inertia"]["Izz"] == pytest.approx(90000 - 20000 * 1.0**2)
    assert part(deck, "platform")["mass"] == 1.9e6  # written as 1.900D+06


def test_ballast_is_added_to_the_mass(edited: Edited) -> None:
    """Cylinders of 7.8 m inside from -9 to -7 m, and a full box of 4.9 x 2.4 m inside."""
    deck = edited()
    first, second = part(deck, "ballast 1"), part(deck, "ballast 2")
    mass = 1000.0 * math.pi / 4 * 7.8**2 * 2.0
    assert first["mass"] == pytest.approx(2 * mass)
    assert first["centre_of_mass"] == pytest.approx([0.0, 0.0, -8.0])
    across = mass * (7.8**2 / 16 + 2.0**2 / 12)
    assert first["inertia"]["Ixx"] == pytest.approx(2 * across)
    assert first["inertia"]["Iyy"] == pytest.approx(2 * (across + mass * 15.0**2))
    assert first["inertia"]["Izz"] == pytest.approx(2 * (mass * 7.8**2 / 8 + mass * 15.0**2))
    box = 1500.0 * 4.9 * 2.4 * 22.0
    assert second["mass"] == pytest.approx(box)
    assert second["inertia"]["Ixx"] == pytest.approx(box / 12 * (4.9**2 + 2.4**2))
    assert second["inertia"]["Iyy"] == pytest.approx(box / 12 * (22.0**2 + 2.4**2))


def test_a_missing_blade_is_said(edited: Edited) -> None:
    deck = edited("elastodyn.dat", '"blade.dat"   BldFile2', '"gone.dat"   BldFile2')
    assert "gone.dat" in said(deck, "BldFile2", Treatment.LEFT_OUT)
    assert [item.source for item in deck.items if item.warning] == ["elastodyn.dat: BldFile2", "main.fst: AddF0"]
    assert "blade 2" not in [entry["name"] for entry in deck.platform["rigid_body"]["parts"]]


def test_heights_count_from_still_water(edited: Edited) -> None:
    """With still water 2 m above mean sea level all is 2 m lower, and the water 2 m deeper."""
    plain, raised = edited(), edited("main.fst", "0      MSL2SWL", "2.0    MSL2SWL")
    assert raised.platform["water"]["depth"] == plain.platform["water"]["depth"] + 2.0
    for name in ("member11", "member13"):
        assert member(raised, name)["rA"][2] == member(plain, name)["rA"][2] - 2.0
    for name in ("platform", "tower", "ballast 2"):
        assert part(raised, name)["centre_of_mass"][2] == pytest.approx(part(plain, name)["centre_of_mass"][2] - 2.0)


# --- members


def test_coefficients_of_this_program(edited: Edited) -> None:
    """Half of AxCd; CaA and CaB times pi/4 and a ratio of sides; the mean of what varies, under water."""
    deck = edited()
    assert group_of(deck, "member11") == {"Ca_t": 0.95, "Ca_z": 0.8, "Cd_t": 0.8, "Cd_z": 1.5}
    # from -9 m to the surface, of coefficients by depth from 0.6 to 1.0 and from 1.1 to 0.7 over 10 m
    second = group_of(deck, "member12")
    assert (second["Cd_t"], second["Ca_t"]) == (pytest.approx(0.78), pytest.approx(0.92))
    assert second["Cd_z"] == 2.5 and second["drag_z"] == {"law": "high_pass", "cutoff": 0.05, "low_share": 0.4}
    assert "mean" in said(deck, "members 12", Treatment.APPROXIMATED)
    box = group_of(deck, "member13")
    assert box["Ca_z"] == pytest.approx(1.6 * math.pi * 5.0 / (4 * 2.5))
    assert box["Ca_t"] == pytest.approx(0.5 * math.pi * 2.5 / (4 * 5.0))
    assert (box["Cd_t"], box["Cd_z"]) == (1.4, 2.2)


def test_lower_ends_come_first(edited: Edited) -> None:
    deck = edited()
    assert member(deck, "member12")["rA"] == [15.0, 0.0, -9.0]
    assert member(deck, "member15_lower")["rA"] == [0.0, 0.0, -10.0]
    rest = member(deck, "member15")
    assert rest["rA"][2] == pytest.approx(-9.88) and rest["rB"] == [0.0, 0.0, -6.0]
    assert rest["d"] == pytest.approx([5.94, 4.0]) and rest["stations"] == [0.0, 1.0]
    # the two that meet at -6 m have one diameter there: each has the coefficients of its free end
    assert (group_of(deck, "member14")["Cd_z"], group_of(deck, "member15_lower")["Cd_z"]) == (1.5, 2.5)


def test_a_member_with_two_free_ends_is_cut(edited: Edited) -> None:
    """Ends at -6 and -2 m with coefficients of their own, once nothing covers the lower one."""
    joint = "    9       0.0       0.0     -10.0         3           0"
    deck = edited(
        *("hydrodyn.dat", joint, joint.replace("  0.0       0.0 ", "  3.0       0.0 ").replace("-10.0", "-20.0")),
        *("hydrodyn.dat", "  15        9         7 ", "  15        9         5 "),
        *("hydrodyn.dat", "    7       0.0       0.0      -6.0         1 ", "    7       0.0       0.0      -6.0         3 "),
    )
    lower, upper = member(deck, "member14_lower"), member(deck, "member14_upper")
    assert (lower["rA"][2], lower["rB"][2], upper["rA"][2], upper["rB"][2]) == (-6.0, -4.0, -4.0, -2.0)
    assert (group_of(deck, "member14_lower")["Cd_z"], group_of(deck, "member14_upper")["Cd_z"]) == (2.5, 1.5)
    Platform.model_validate(deck.platform)


def test_spin_is_that_of_the_lower_end(edited: Edited) -> None:
    """HydroDyn turns the sign where it swaps the ends (FlipMemberNodeData)."""
    row, turned_row = MEMBER_ROWS["13"], "13 5 6 1 1 2 30 2.0 1 2 FALSE"
    turned = edited("hydrodyn.dat", row, turned_row)
    assert member(turned, "member13")["gamma"] == 30.0
    lowered = turned_row.replace("5 6", "6 5")
    joint = "    5     -11.0       0.0      -8.0"
    swapped = edited("hydrodyn.dat", row, lowered, "hydrodyn.dat", joint, joint.replace("-8.0", "-8.5"))
    assert member(swapped, "member13")["rA"] == [-11.0, 0.0, -8.5] and member(swapped, "member13")["gamma"] == -30.0


def test_diffraction_by_keyword(edited: Edited) -> None:
    deck = edited()
    assert deck.platform["diffraction"] == "maccamy_fuchs"
    assert [entry["name"] for entry in deck.platform["members"] if entry["maccamy_fuchs"]] == ["member11"]
    plain = edited("hydrodyn.dat", "MCF MCF MCF MCF", "1.0 1.0 1.0 1.0")
    assert plain.platform["diffraction"] == "none" and "maccamy_fuchs" not in plain.platform["members"][0]


def test_forms_of_the_loads_follow_the_deck(edited: Edited) -> None:
    deck = edited()
    assert [deck.platform[key] for key in ("wetting", "directions", "waves_at")] == ["instantaneous", "earth", "displaced"]
    still = edited("seastate.dat", "1   WaveStMod", "0   WaveStMod", "hydrodyn.dat", "1   WaveDisp", "0   WaveDisp")
    assert [still.platform[key] for key in ("wetting", "waves_at")] == ["mean", "mean"]


def test_waves_are_met_where_the_tables_have_them(tmp_path: Path) -> None:
    """ExctnDisp says it for tables, WaveDisp for strips; there is one key for both."""
    folder = shutil.copytree(DECK, tmp_path / "deck")
    for ending in (".1", ".3"):
        shutil.copyfile(DECK.parents[1] / "data" / "hams-cylinder" / f"Buoy{ending}", folder / f"zeros{ending}")
    text = (folder / "hydrodyn.dat").read_text(encoding="utf-8")
    for old, new in (("0   ExctnMod", "1   ExctnMod"), ("0   RdtnMod", "1   RdtnMod")):
        assert old in text
        text = text.replace(old, new, 1)
    (folder / "hydrodyn.dat").write_text(text, encoding="utf-8")
    deck = read_openfast_deck(folder / "main.fst")
    assert deck.platform["excitation"] == {"file": "zeros.3"} and deck.platform["directions"] == "earth"
    assert deck.platform["waves_at"] == "mean"
    assert "WaveDisp has the waves of strips elsewhere (displaced)" in said(deck, "ExctnDisp", Treatment.APPROXIMATED)


def test_the_older_format_is_read(edited: Edited) -> None:
    """Tables without Cb and rectangles, members without MSecGeom, keys of other names: as in OpenFAST 3."""
    new = " ".join(f"Simpl{name}{grown}" for name in ("Cd", "Ca", "Cp", "AxCd", "AxCa", "AxCp") for grown in ("", "MG"))
    rows = {  # 11 columns -> 9
        "11": "11 1 2 1 1 1.0 3 1 FALSE",
        "12": "12 3 4 1 1 1.0 1 1 FALSE",
        "13": "13 5 6 2 2 2.0 1 1 FALSE",
        "14": "14 7 8 2 2 1.0 1 1 FALSE",
        "15": "15 9 7 3 2 1.0 1 1 FALSE",
    }
    changes = [("hydrodyn.dat", MEMBER_ROWS[number], row) for number, row in rows.items()]
    changes += [
        ("hydrodyn.dat", f"{new} SimplCb SimplCbMG", new),
        ("hydrodyn.dat", " 0.0       0.0         0.0       0.0         1.0       1.0         1.0     1.0\n", " 0 0 0 0 1 1\n"),
        ("hydrodyn.dat", "MSecGeom MSpinOrient MDivSize MCoefMod", "MDivSize MCoefMod"),
        ("hydrodyn.dat", "NPropSetsCyl", "NPropSets"),
        ("hydrodyn.dat", "NCoefMembersCyl", "NCoefMembers"),
        (
            "hydrodyn.dat",
            "0.95 0.95 9 9 MCF MCF MCF MCF 0 0 0 0 0 0 0 0 1 1 1 1 1.0 1.0 1.0 1.0",
            "0.95 0.95 9 9 MCF MCF MCF MCF 0 0 0 0 0 0 0 0 1 1 1 1",
        ),
    ]
    deck = edited(*(word for change in changes for word in change))
    assert member(deck, "member13")["d"] == 4.0 and group_of(deck, "member12")["Cd_t"] == 0.7
    assert group_of(deck, "member11")["Ca_t"] == 0.95 and member(deck, "member11")["maccamy_fuchs"]


# --- additional terms, moorings, sea


def test_additional_terms(edited: Edited) -> None:
    deck = edited("main.fst", "3   CompMooring", "0   CompMooring")
    mooring = deck.platform["mooring"]
    assert mooring["preload"] == [0.0, 0.0, 2.0e5, 0.0, 0.0, 0.0]
    assert np.diag(mooring["stiffness"]).tolist() == [3e4, 3e4, 0, 0, 0, 6e6]
    assert deck.platform["linear_damping"]["B15"] == 1e5
    assert deck.platform["quadratic_damping"] == {"B11": 5e3, "B33": 8e4}
    assert "B15 7000" in said(deck, "AddBQuad, off", Treatment.LEFT_OUT)


def test_additional_terms_are_off_without_potential_flow(edited: Edited) -> None:
    deck = edited("hydrodyn.dat", "1   PotMod", "0   PotMod", "main.fst", "3   CompMooring", "0   CompMooring")
    assert not {"mooring", "linear_damping", "quadratic_damping"} & deck.platform.keys()
    assert "PotMod = 1 only" in said(deck, "AddBLin", Treatment.LEFT_OUT)


def test_additional_terms_of_another_point_are_moved(edited: Edited) -> None:
    """A stiffness in surge 4 m below the origin: a lever in pitch, and no preload lost."""
    deck = edited("hydrodyn.dat", "0   PtfmRefzt ", "-4.0   PtfmRefzt ", "main.fst", "3   CompMooring", "0   CompMooring")
    stiffness = np.array(deck.platform["mooring"]["stiffness"])
    assert stiffness[0, 4] == stiffness[4, 0] == pytest.approx(-4.0 * 3e4)
    assert stiffness[4, 4] == pytest.approx(16.0 * 3e4)
    assert deck.platform["mooring"]["preload"][2] == 2.0e5


def test_lines_are_catenaries_beside_hydrodyns_stiffness(edited: Edited) -> None:
    deck = edited()
    mooring = deck.platform["mooring"]
    assert mooring["kind"] == "catenary"
    assert mooring["line_types"] == {"chain": {"axial_stiffness": 1e8, "mass_per_length": 60.0, "diameter": 0.1}}
    assert [line["anchor"] for line in mooring["lines"]] == [[-220.0, 0.0, -80.0], [220.0, 0.0, -80.0]]
    assert mooring["lines"][1]["fairlead"] == [19.0, 0.0, -5.0]
    assert deck.platform["stiffness"] == {"C11": 3e4, "C22": 3e4, "C66": 6e6}
    assert "constant force" in said(deck, "AddF0", Treatment.LEFT_OUT)


def test_lines_that_meet_are_left_out(edited: Edited) -> None:
    deck = edited("moordyn.dat", "2    Fixed", "2    Free ")
    assert "mooring is left out" in said(deck, "LINES", Treatment.LEFT_OUT)
    assert deck.platform["mooring"]["preload"][2] == 2.0e5  # HydroDyn's own


def test_the_sea_is_a_command(edited: Edited) -> None:
    text = said(edited(), "WaveMod", Treatment.LEFT_OUT)
    assert "--hs 3.1 --tp 8.96 --low 0.0300001 --cutoff 0.3 --amplitudes rayleigh --order 1 --heading 30" in text
    assert "--wave-height 3.1 --wave-period 8.96" in said(
        edited("seastate.dat", "2   WaveMod", "1   WaveMod"), "WaveMod", Treatment.LEFT_OUT
    )


def test_versions_without_a_key(edited: Edited) -> None:
    deck = edited("elastodyn.dat", "          0   PtfmRefzt", "")
    assert "PtfmRefzt (0)" in said(deck, "elastodyn.dat: keys of other versions", Treatment.APPROXIMATED)
    moved = edited("elastodyn.dat", "0   PtfmRefzt", "-5   PtfmRefzt")
    assert "tracked_point: [0, 0, -5]" in said(moved, "PtfmRefxt", Treatment.APPROXIMATED)
    with_new_key = edited("hydrodyn.dat", "1   AMMod", "7 NewKey\n1   AMMod")
    assert "NewKey" in said(with_new_key, "hydrodyn.dat: other keys", Treatment.LEFT_OUT)


def test_restoring_of_ballast_in_old_decks(edited: Edited) -> None:
    """Without NBody, the weight of ballast does not move with the platform: AddCLin holds its restoring."""
    parts = [part(edited(), name) for name in ("ballast 1", "ballast 2")]
    restoring = -9.81 * sum(ballast["mass"] * ballast["centre_of_mass"][2] for ballast in parts)
    diagonal = (" 0  0  0  0  0  0\n" * 2, f" 0 0 0 {2 * restoring:.9g} 0 0\n 0 0 0 0 {restoring:.9g} 0\n")
    old = ("hydrodyn.dat", " 0  0  0  0  0  0\n" + diagonal[0], " 0  0  0  0  0  0\n" + diagonal[1])
    whole = edited(*old).platform["stiffness"]
    assert whole["C44"] == pytest.approx(2 * restoring) and whole["C55"] == pytest.approx(restoring)
    less = edited(*old, "hydrodyn.dat", "1   NBody", "1   NoBody")
    assert less.platform["stiffness"]["C44"] == pytest.approx(restoring) and "C55" not in less.platform["stiffness"]
    assert "ballast's restoring" in said(less, "AddCLin", Treatment.APPROXIMATED)


def test_file_names_of_another_case(edited: Edited) -> None:
    """Decks that were written on Windows name files in another case."""
    deck = edited("main.fst", '"hydrodyn.dat"', '"HydroDyn.DAT"')
    assert deck.platform == edited().platform | {"name": deck.platform["name"]}


def test_the_description_is_no_key(edited: Edited) -> None:
    """The second line of a file may hold any words, such as names of keys."""
    deck = edited("main.fst", "Made for the tests of jaxhydro", "Floating MHK turbine")
    assert member(deck, "member11")["shape"] == "circ"


# --- broken input


@pytest.mark.parametrize(
    "file, old, new, message",
    [
        ("main.fst", '"hydrodyn.dat"', '"hydrodin.dat"', "hydrodin.dat: expected the file that HydroFile names"),
        ("main.fst", "1   CompHydro", "one CompHydro", "main.fst: line 9, CompHydro: expected a number, found 'one'"),
        ("main.fst", "9.81   Gravity", "9.81   Gravitation", "Gravity: expected a line with a value and Gravity"),
        (
            "elastodyn.dat",
            "1.900D+06   PtfmMass",
            "heavy       PtfmMass",
            "line 36, PtfmMass: expected a number, found 'heavy'",
        ),
        ("elastodyn.dat", "PtfmMass ", "PlatMass ", "PtfmMass: expected a line with a value and PtfmMass"),
        ("elastodyn.dat", "90000   NacYIner", "9000   NacYIner", "NacYIner: expected NacMass"),
        ("tower.dat", "   1.0           400.0            1.0E9          1.0E9\n", "", "row 2 of 2 of NTwInpSt"),
        ("blade.dat", "60.0           1.0E8          1.0E8\n      1.0", "x  1 1\n 1.0", "a number for BMassDen, found 'x'"),
        ("hydrodyn.dat", "9   NJoints", "11   NJoints", "line 68: expected row 10 of 11 of NJoints, found '---"),
        ("hydrodyn.dat", "  11        1         2 ", "  11        1        77 ", "MJointID2: a JointID of the file (1, 2, 3"),
        ("hydrodyn.dat", "    4      15.0", "    4      east", "a number for Jointxi, found 'east'"),
        ("hydrodyn.dat", "    4      15.0", "    3      15.0", "each JointID once, found 3 again"),
        ("hydrodyn.dat", "-9.0         2 ", "-9.0         8 ", "JointAxID: a AxCoefID of the file (1, 2, 3), found 8"),
        (
            "hydrodyn.dat",
            " 11 0.8 0.8 9 9",
            " 17 0.8 0.8 9 9",
            "a row of MemberID 11 in the coefficients by member, found none",
        ),
        ("hydrodyn.dat", "1.0       1        1     FALSE", "1.0       4        1     FALSE", "MCoefMod 1, 2 or 3, found 4"),
        ("hydrodyn.dat", "    2     11  12 ", "    2     11  19 ", "members of the table of members, found 19"),
        ("hydrodyn.dat", " 0  3.0E4  0  0  0  0\n", " 0  3.0E4  0\n", "row 2 of 6 of AddCLin, 6 numbers"),
        ("hydrodyn.dat", "0   RdtnMod", "1   RdtnMod", "zeros.1: expected WAMIT's table, which RdtnMod"),
        ("hydrodyn.dat", "0   ExctnMod", "0   NewKey", "zeros.3: expected WAMIT's table, which ExctnMod"),
        ("hydrodyn.dat", "2        1     FALSE", "2        1     TRUE", ""),
        ("moordyn.dat", "1     chain     2", "1     rope      2", "a line type of the file (chain), found 'rope'"),
        ("moordyn.dat", "chain     2         1 ", "chain     2         9 ", "a point of the file (1, 2, 3, 4), found '9'"),
        ("moordyn.dat", "225.0     20        -\n2", "long      20        -\n2", "a number for Length, found 'long'"),
    ],
)
def test_broken_decks(edited: Edited, file: str, old: str, new: str, message: str) -> None:
    """One message with the file, the line or key, what was expected and what was found."""
    if not message:  # potential flow may stand for a member: that is no mistake
        assert group_of(edited(file, old, new), "member12")["Ca_t"] == 0.0
        return
    with pytest.raises(InputError) as error:
        edited(file, old, new)
    assert message in str(error.value) and len(error.value.problems) == 1


def test_a_member_of_potential_flow_needs_it(edited: Edited) -> None:
    with pytest.raises(InputError, match="PropPot FALSE, as PotMod is not 1"):
        edited("hydrodyn.dat", "2        1     FALSE", "2        1     TRUE", "hydrodyn.dat", "1   PotMod", "0   PotMod")
