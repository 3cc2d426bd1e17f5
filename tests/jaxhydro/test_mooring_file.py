"""Mooring lines of MoorDyn's and MoorPy's files as section `mooring`: spellings, tensions, bodies, broken files."""

import math
from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest
from one_program import one_program

from jaxhydro.errors import InputError
from jaxhydro.interop.conversion import Conversion, ConvertedItem, Treatment
from jaxhydro.interop.converters import convert_file
from jaxhydro.interop.mooring_file import read_mooring_file
from jaxhydro.interop.mooring_source import with_mooring
from jaxhydro.interop.openfast_deck import read_openfast_deck
from jaxhydro.loads import CatenaryLines
from jaxhydro.platform.catenary_build import catenary_lines
from jaxhydro.platform.catenary_schema import Catenary
from jaxhydro.platform.schema import Water

DECK = Path(__file__).resolve().parents[1] / "fixtures" / "openfast_deck"
VERSION_2 = """\
MoorDyn v2 Input File
Made by hand
---------------------- LINE TYPES ----------------------------------
TypeName  Diam  Mass/m  EA     BA/-zeta  EI  Cd   Ca   CdAx  CaAx
(name)    (m)   (kg/m)  (N)    (N-s/-)   (-) (-)  (-)  (-)   (-)
chain     0.10  60.0    1.0E8  -1.0      0   2.0  0.8  0.4   0.2
---------------------- POINTS --------------------------------------
ID  Attachment  X       Y    Z      Mass  Volume  CdA  Ca
(#)  (-)        (m)     (m)  (m)    (kg)  (m^3)   (m^2) (-)
1   Coupled    -19.0    0.0  -5.0   0     0       0    0
2   Fixed      -220.0   0.0  -80.0  0     0       0    0   # on the bed

3   Coupled     19.0    0.0  -5.0   0     0       0    0
4   Fixed       220.0   0.0  -80.0  0     0       0    0
---------------------- LINES ---------------------------------------
ID  LineType  AttachA  AttachB  UnstrLen  NumSegs  LineOutputs
(#) (name)    (#)      (#)      (m)       (-)      (-)
1   chain     2        1        225.0     20       p
2   chain     3        4        225.0     20       p
---------------------- OPTIONS -------------------------------------
80.0    WtrDpth   water depth (m)
1020    WtrDnsty  water density
9.81    g
0.001   dtM
---------------------- need this line ------------------------------
"""
VERSION_1 = """\
--------------------- MoorDyn Input File ---------------------------
Made by hand
---------------------- LINE DICTIONARY -----------------------------
1   NTypes  - number of line types
LineType  Diam  MassDenInAir  EA     BA/-zeta  Can  Cat  Cdn  Cdt
(-)       (m)   (kg/m)        (N)    (Pa-s/-)  (-)  (-)  (-)  (-)
chain     0.10  60.0          1.0D8  -0.8      1.0  0.0  1.6  0.05
---------------------- CONNECTION PROPERTIES -----------------------
4   NConnects
Node  Type    X       Y    Z      M  V  FX FY FZ CdA CA
(-)   (-)     (m)     (m)  (m)    (kg) (m^3) (kN) (kN) (kN) (m^2) (-)
1     Vessel  -19.0   0.0  -5.0   0  0  0  0  0  0   0
2     Fixed   -220.0  0.0  -80.0  0  0  0  0  0  0   0
3     Vessel  19.0    0.0  -5.0   0  0  0  0  0  0   0
4     Fixed   220.0   0.0  -80.0  0  0  0  0  0  0   0
---------------------- LINE PROPERTIES -----------------------------
2   NLines
Line  LineType  UnstrLen  NumSegs  NodeAnch  NodeFair  Flags
(-)   (-)       (m)       (-)      (-)       (-)       (-)
1     chain     225.0     20       2         1         p
2     chain     225.0     20       4         3         p
---------------------- SOLVER OPTIONS ------------------------------
80     WtrDpth
---------------------- need this line ------------------------------
"""
MOORPY = """\
water_depth: 80
line_types: [{name: chain, diameter: 0.10, mass_density: 60.0, stiffness: 1.0e8}]
points:
  - {name: f1, type: vessel, location: [-19, 0, -5]}
  - {name: a1, type: fixed, location: [-220, 0, -80]}
  - {name: f2, type: vessel, location: [19, 0, -5]}
  - {name: a2, type: fixed, location: [220, 0, -80]}
lines:
  - {name: l1, endA: a1, endB: f1, type: chain, length: 225}
  - {name: l2, endA: a2, endB: f2, type: chain, length: 225}
"""


def converted(folder: Path, text: str, name: str = "lines.txt") -> Conversion:
    (folder / name).write_text(text, encoding="utf-8")
    return convert_file(folder / name)


def changed(old: str, new: str, text: str = VERSION_2) -> str:
    assert old in text
    return text.replace(old, new, 1)


def said(conversion: Conversion, source: str, treatment: Treatment) -> str:
    return " ".join(item.meaning for item in conversion.items if source in item.source and item.treatment is treatment)


@pytest.mark.parametrize(
    "text, name",
    [
        (VERSION_2, "lines.txt"),
        (VERSION_1, "MoorDyn.DAT"),
        (VERSION_2, "lines"),
        (VERSION_2.replace(" -80.0 ", " seabed "), "lines.dat"),
        (VERSION_2.replace("AttachA  AttachB", "NodeA  NodeB"), "a.dat"),
        (VERSION_2.replace("2        1        225.0", "Point2   P1       225.0"), "a.dat"),
        (VERSION_2.replace("- LINE TYPES -", "- LINE TYPES studless chain -"), "a.dat"),
        (MOORPY, "system.yaml"),
    ],
)
def test_spellings_give_the_lines_of_a_deck(tmp_path: Path, text: str, name: str) -> None:
    """MoorDyn 1 and 2, MoorPy's YAML and a file of any ending, against the same lines in a deck."""
    conversion = converted(tmp_path, text, name)
    assert conversion.platform["mooring"] == read_openfast_deck(DECK / "main.fst").platform["mooring"]
    assert conversion.platform["water"]["depth"] == 80.0 and not conversion.whole


def test_water_and_what_became_of_the_file(tmp_path: Path) -> None:
    conversion = converted(tmp_path, VERSION_2)
    assert conversion.platform["water"] == {"density": 1020.0, "depth": 80.0, "gravity": 9.81}
    assert said(conversion, "points", Treatment.TAKEN) == "2 fixed, 2 on the platform."
    assert "drag, inertia, damping" in said(conversion, "lines 1, 2", Treatment.APPROXIMATED)
    assert said(conversion, "other keys", Treatment.LEFT_OUT) == "Not used: dtM."
    assert not any(item.warning for item in conversion.items)


def test_tension_is_that_of_the_elastic_catenary(tmp_path: Path) -> None:
    """A line of 600 m, 190 m of it on the bed; its ends by the closed form (Jonkman 2007, equations 2-39 and 2-40)."""
    stiffness, mass, diameter, length, hanging, horizontal = 2.0e7, 120.0, 0.12, 600.0, 410.0, 6.0e5
    weight = (mass - 1020.0 * math.pi / 4 * diameter**2) * 9.81
    vertical = weight * hanging
    x = length - hanging + horizontal / weight * math.asinh(vertical / horizontal) + horizontal * length / stiffness
    z = horizontal / weight * (math.hypot(1, vertical / horizontal) - 1) + vertical**2 / (2 * stiffness * weight)
    text = changed("chain     0.10  60.0    1.0E8", f"chain {diameter} {mass} {stiffness}")
    text = changed("2   Fixed      -220.0   0.0  -80.0", f"2   Fixed {-19 - x!r} 0.0 {-5 - z!r}", text)
    text = changed("4   Fixed       220.0   0.0  -80.0", f"4   Fixed {19 + x!r} 0.0 {-5 - z!r}", text)
    conversion = converted(tmp_path, changed("80.0    WtrDpth", f"{5 + z!r}  WtrDpth", text.replace(" 225.0 ", f" {length} ")))
    water = Water.model_validate(conversion.platform["water"])
    lines = catenary_lines(Catenary.model_validate(conversion.platform["mooring"]), water)
    tension, direction = map(np.asarray, one_program(CatenaryLines.tension)(lines, jnp.zeros(6), jnp.eye(3)))
    assert tension == pytest.approx(np.full(2, math.hypot(horizontal, vertical)), rel=1e-6)
    assert tension * direction[2] == pytest.approx(np.full(2, -vertical), rel=1e-6)


def test_points_of_a_coupled_body_are_on_the_platform(tmp_path: Path) -> None:
    """The body is turned by 90 deg about z: its x axis is the platform's y axis."""
    bodies = """\
---------------------- BODIES --------------------------------------
ID  Attachment  X0   Y0   Z0    r0  p0  y0  Mass  CG*  I*  Volume  CdA*  Ca*
(#) (-)         (m)  (m)  (m)   (deg) (deg) (deg) (kg) (m) (-) (m^3) (m^2) (-)
1   coupled     1.0  2.0  -0.5  0   0   90  0     0    0   0       0|0   0
---------------------- POINTS --------------------------------------
"""
    text = changed("---------------------- POINTS --------------------------------------\n", bodies)
    text = changed("3   Coupled     19.0    0.0  -5.0", "3   Body1       4.0    -18.0 -4.5", text)
    conversion = converted(tmp_path, text)
    assert conversion.platform["mooring"]["lines"][1]["fairlead"] == pytest.approx([19.0, 6.0, -5.0])
    assert "coupled body are on the platform" in said(conversion, "BODIES", Treatment.LEFT_OUT)
    with pytest.raises(InputError, match=r"expected a body of the file \(1\), found 'Body2'"):
        converted(tmp_path, text.replace("Body1 ", "Body2 "))
    with pytest.raises(InputError, match="which is not on the platform"):
        converted(tmp_path, text.replace("1   coupled ", "1   free "))
    with pytest.raises(InputError, match="at most one angle of r0, p0 and y0 that is not 0, found 0, 5, 90"):
        converted(tmp_path, text.replace("0   0   90", "0   5   90"))


def test_a_body_whose_number_and_attachment_are_one_word(tmp_path: Path) -> None:
    """As in OpenFAST's own tests of 2020; words of the header have commas."""
    bodies = """\
---------------------- BODIES --------------------------------------
BodyID  X0 Y0 Z0 r0 p0 y0 Xcg Ycg Zcg M V IX IY IZ CdA-x,y,z Ca-x,y,z
(-)     (m) (m) (m) (deg) (deg) (deg) (m) (m) (m) (kg) (m^3) (-) (-) (-) (m^2) (-)
1coupled 0 0 0  0  0  0  0   0   0   0 0 0  0  0  0         0
---------------------- POINTS --------------------------------------
"""
    text = changed("---------------------- POINTS --------------------------------------\n", bodies)
    conversion = converted(tmp_path, text.replace("Coupled ", "Body1   "))
    assert conversion.platform["mooring"] == converted(tmp_path, VERSION_2).platform["mooring"]


def test_a_matrix_of_panel_results_is_replaced(tmp_path: Path) -> None:
    """Not that of a source whose mooring is complete."""
    (tmp_path / "lines.txt").write_text(VERSION_2, encoding="utf-8")
    water = {"density": 1025.0, "depth": 80.0, "gravity": 9.80665}
    items = [
        ConvertedItem("external stiffness", Treatment.APPROXIMATED, "`mooring`: the stiffness."),
        ConvertedItem("mooring", Treatment.TO_FILL_IN, "It is linear."),
        ConvertedItem("water", Treatment.TAKEN, "Kept."),
    ]
    platform = {"water": water, "mooring": {"kind": "stiffness_matrix"}}
    conversion = with_mooring(Conversion(platform, tuple(items)), read_mooring_file(tmp_path / "lines.txt"), "hull.out")
    assert conversion.platform["mooring"] == converted(tmp_path, VERSION_2).platform["mooring"]
    assert said(conversion, "mooring", Treatment.TO_FILL_IN) == "" and said(conversion, "water", Treatment.TAKEN) == "Kept."
    assert "is replaced by the lines of lines.txt" in said(conversion, "external stiffness", Treatment.LEFT_OUT)
    assert said(conversion, "external stiffness", Treatment.APPROXIMATED) == ""
    assert "1020 kg/m³ is left out" in said(conversion, "lines.txt: density", Treatment.LEFT_OUT)
    with pytest.raises(InputError, match="a source without a mooring, found a mooring of kind stiffness_matrix"):
        with_mooring(Conversion(platform, tuple(items[2:])), read_mooring_file(tmp_path / "lines.txt"), "main.fst")


def test_panel_results_without_a_depth_take_that_of_the_lines(tmp_path: Path) -> None:
    """With a depth the longest wave's force tells the displaced mass, that of the ellipsoid."""
    (tmp_path / "lines.txt").write_text(VERSION_2, encoding="utf-8")
    results = DECK.parents[1] / "data" / "ellipsoid" / "wamit"
    alone, conversion = convert_file(results), convert_file(results, tmp_path / "lines.txt")
    assert alone.platform["water"]["depth"] > 500.0 and conversion.platform["water"]["depth"] == 80.0
    assert said(conversion, "water.depth", Treatment.TO_FILL_IN).endswith("80 m is taken, the depth of the mooring lines.")
    assert "longest wave" in said(conversion, "rigid_body.mass", Treatment.TO_FILL_IN)
    assert "seabed" not in conversion.platform["mooring"] and not any("sea bed" in item.source for item in conversion.items)


def test_a_depth_that_is_not_stated_is_that_of_the_deepest_fixed_point(tmp_path: Path) -> None:
    conversion = converted(tmp_path, changed("80.0    WtrDpth   water depth (m)\n", ""))
    assert conversion.platform["water"]["depth"] == 80.0
    assert "80 m is assumed" in said(conversion, "water depth", Treatment.APPROXIMATED)


def test_points_above_the_bed_are_warned_of(tmp_path: Path) -> None:
    conversion = converted(tmp_path, changed("80.0    WtrDpth", "90.0    WtrDpth"))
    (warning,) = [item for item in conversion.items if item.warning]
    assert "Fixed points 2, 4 are above the sea bed at 90 m" in warning.meaning


def test_points_without_a_line_are_warned_of(tmp_path: Path) -> None:
    conversion = converted(tmp_path, changed("2   chain     3        4        225.0     20       p\n", ""))
    (warning,) = [item for item in conversion.items if item.warning]
    assert warning.meaning == "No line is at points 3, 4." and len(conversion.platform["mooring"]["lines"]) == 1


def test_the_static_stiffness_of_several_is_taken(tmp_path: Path) -> None:
    conversion = converted(tmp_path, changed("1.0E8  -1.0 ", "1.0E8|2.0E8 -1.0|1e6 "))
    assert conversion.platform["mooring"]["line_types"]["chain"]["axial_stiffness"] == 1e8
    assert "static stiffness, 1.0E8 N" in said(conversion, "EA of chain", Treatment.APPROXIMATED)


def test_rods_that_hold_no_line_are_left_out(tmp_path: Path) -> None:
    rods = "--- RODS ---\nID RodType Attachment Xa Ya Za Xb Yb Zb NumSegs Outputs\n(#) (-)\n1 can Coupled 0 0 0 0 0 -5 4 -\n"
    rods += "--- POINTS ---\n"
    conversion = converted(tmp_path, changed("---------------------- POINTS --------------------------------------\n", rods))
    assert "rods have no counterpart" in said(conversion, "RODS", Treatment.LEFT_OUT)


def test_the_bed_of_a_deck_is_below_still_water(tmp_path: Path) -> None:
    """Still water 2 m above mean sea level: points and bed are both 2 m deeper."""
    for path in DECK.iterdir():
        text = path.read_text(encoding="utf-8")
        if path.name == "moordyn.dat":
            text = changed("0.005    dtM", "80.0 WtrDpth\n0.005    dtM", text)
        (tmp_path / path.name).write_text(changed("0      MSL2SWL", "2.0    MSL2SWL", text) if path.suffix == ".fst" else text)
    platform = read_openfast_deck(tmp_path / "main.fst").platform
    assert platform["mooring"]["lines"][0]["anchor"][2] == -82.0 and platform["water"]["depth"] == 82.0
    assert "seabed" not in platform["mooring"]  # it is the water's


def section_without(title: str) -> str:
    start = VERSION_2.index(f"---------------------- {title} -")
    return VERSION_2[:start] + VERSION_2[VERSION_2.index("\n---", start) + 1 :]


@pytest.mark.parametrize(
    "text, message",
    [
        (section_without("LINE TYPES"), "expected a section LINE TYPES with a row, found none"),
        (section_without("POINTS"), "expected a section POINTS with a row, found none"),
        (section_without("LINES"), "expected a section LINES with a row, found none"),
        (
            changed("1   chain     2        1        225.0     20       p", "1   chain     2        1"),
            "line 18: expected 5 columns",
        ),
        (changed("-19.0    0.0  -5.0   0     0       0    0", "-19.0  # later"), "line 10: expected 7 columns"),
        (changed("1   chain ", "1   chian "), "line 18: expected a line type of the file (chain), found 'chian'. Did you mean"),
        (changed("2        1   ", "2        9   "), "line 18: expected a point of the file (1, 2, 3, 4), found '9'"),
        (changed("2        1   ", "2        2   "), "line 18: expected two different points, found '2' twice"),
        (changed("225.0", "-225.0"), "line 18: expected an unstretched length > 0, found -225"),
        (changed("-220.0", "-22O.0"), "line 11: expected a number for X, found '-22O.0'"),
        (changed("-220.0", "-220,0"), "line 11: expected a number for X, found '-220,0'"),
        (
            changed("80.0    WtrDpth", "80.0 dtIC").replace("-80.0", "seabed"),
            "line 11: expected a number for Z, as the file states no",
        ),
        (changed("-220.0", "nan"), "line 11: expected a number for X, found 'nan'"),
        (changed("60.0    1.0E8", "60.0    1.0E8N"), "line 6: expected a number for EA, found '1.0E8N'"),
        (changed("60.0    1.0E8", "60.0    rope.txt"), "found 'rope.txt'. For a rope with a table see `kind: tension_table`"),
        (changed("60.0    1.0E8", "60.0    0"), "line 6: expected a number > 0 for EA, found 0"),
        (changed("chain     0.10", "chain     -0.1"), "line 6: expected a number >= 0 for Diam, found -0.1"),
        (
            changed("chain     0.10", "chain     0.40"),
            "line 6: expected lines that sink and run from fixed points to the platform",
        ),
        (
            changed("2   Fixed ", "2   Fxed  "),
            "line 11: expected Fixed, Vessel, Coupled, Free, Connect, or Body and its number",
        ),
        (changed("2   Fixed ", "2   Free  "), "line 18: expected lines that sink and run from fixed points to the platform"),
        (changed("2   Fixed ", "2   Turbine1"), "found line 1 does not run from the ground to the platform"),
        (changed("3   Coupled ", "3   Free  "), "the line from point 4 ends at point 3, which is not on the platform"),
        (changed("3   Coupled ", "3   Body1 "), "line 13: expected a body of the file (it has none), found 'Body1'"),
        (changed("2        1   ", "2        R1A "), "ends at point R1A, which is not on the platform"),
        (changed("3   Coupled", "1   Coupled"), "line 13: expected each ID once, found '1' again, as in line 10"),
        (changed("80.0    WtrDpth", "70.0    WtrDpth"), "line 11: expected a fixed point on or above the sea bed, z = -70 m"),
        (
            changed("80.0    WtrDpth", "-80.0   WtrDpth"),
            "line 21, WtrDpth: expected a depth of more than 0 and at most 11000 m",
        ),
        (
            changed("80.0    WtrDpth", "8e9     WtrDpth"),
            "line 21, WtrDpth: expected a depth of more than 0 and at most 11000 m",
        ),
        (changed("80.0    WtrDpth", "bed.txt WtrDpth"), "WtrDpth: expected a depth in m, found 'bed.txt'. Files of a sea bed"),
        (changed("1020    WtrDnsty", "10z0    WtrDnsty"), "line 22, WtrDnsty: expected a number > 0, found '10z0'"),
        (
            changed("80.0    WtrDpth", "80.0    dtIC").replace("Fixed", "Free "),
            "expected a water depth (WtrDpth), or a fixed point",
        ),
        (changed("EA     BA/-zeta", "stiff  BA/-zeta"), "line 4: expected the header of LINE TYPES with a column ea"),
        (
            changed("EA     BA/-zeta", "EA     CB"),
            "line 4: expected MoorDyn's columns of LINE TYPES, found CB, a column of MAP++",
        ),
        (
            changed("(#) (name)    (#)      (#)      (m)       (-)      (-)\n", ""),
            "line 17: expected a row of units under the header",
        ),
        (changed("2   NLines", "3   NLines", VERSION_1), "line 17: expected the number of rows of LINES, 2, found 3"),
        (VERSION_2[: VERSION_2.index("TypeName")], "expected the header of LINE TYPES with a column name, found nothing"),
        ("", "found an empty file"),
        ("title\nvalues\n", "a MoorDyn file (.dat, .txt)"),
        ("\x00\x01", "expected a MoorDyn file, found binary content"),
    ],
)
def test_broken_files(tmp_path: Path, text: str, message: str) -> None:
    """One message with the file, the row, what was expected and what was found."""
    with pytest.raises(InputError) as error:
        converted(tmp_path, text)
    assert message in str(error.value) and len(error.value.problems) == 1
    assert error.value.source == str(tmp_path / "lines.txt")


@pytest.mark.parametrize(
    "old, new, message",
    [
        (
            "type: fixed, location: [-220, 0, -80]",
            "type: wall, location: [-220, 0, -80]",
            "one of fixed, fairlead, free, found 'wall'",
        ),
        ("endB: f1", "endB: f9", "lines[0].endB: expected the name of a point (f1, a1, f2, a2), found 'f9'"),
        (
            "type: vessel, location: [-19",
            "type: free, mass: 9, location: [-19",
            "ends at point f1, which is not on the platform",
        ),
        ("water_depth: 80", "water_depth: deep", "water_depth: expected a"),
        ("line_types", "types", "platform"),
    ],
)
def test_broken_systems_of_moorpy(tmp_path: Path, old: str, new: str, message: str) -> None:
    with pytest.raises(InputError) as error:
        converted(tmp_path, changed(old, new, MOORPY), "system.yaml")
    assert message in str(error.value)


def test_keys_of_moorpy_that_are_not_used_are_told(tmp_path: Path) -> None:
    text = changed("stiffness: 1.0e8}", "stiffness: 1.0e8, breaking_load: 1.0e6}", MOORPY)
    assert said(converted(tmp_path, text, "a.yml"), "other keys", Treatment.LEFT_OUT) == "Not used: breaking_load."


def test_other_yaml_files_are_no_lines(tmp_path: Path) -> None:
    """The section that convert wrote is for the platform file; a RAFT design is a source."""
    (tmp_path / "mooring.yaml").write_text("water: {depth: 80}\nmooring: {kind: catenary}\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"found the keys water, mooring\. Paste its `mooring` into the platform file"):
        read_mooring_file(tmp_path / "mooring.yaml")
    with pytest.raises(InputError, match="A RAFT design is a source of its own"):
        read_mooring_file(DECK.parent / "raft_design.yaml")


def test_a_mass_between_lines_of_moorpy_is_refused(tmp_path: Path) -> None:
    text = changed("endB: f1, type: chain, length: 225", "endB: m, type: chain, length: 100", MOORPY)
    text += "  - {name: l3, endA: m, endB: f1, type: chain, length: 125}\n"
    text = text.replace("lines:\n", "  - {name: m, type: free, mass: 1000, location: [-100, 0, -60]}\nlines:\n")
    with pytest.raises(InputError, match="point m between two lines has a mass"):
        converted(tmp_path, text, "system.yaml")
    segments = converted(tmp_path, text.replace("mass: 1000", "mass: 0"), "system.yaml").platform["mooring"]["lines"][0]
    assert [segment["length"] for segment in segments["segments"]] == [100, 125]


def test_sources_that_cannot_be_read_are_answered_with_a_list(tmp_path: Path) -> None:
    (tmp_path / "model.xyz").write_text("title\n", encoding="utf-8")
    with pytest.raises(InputError) as error:
        convert_file(tmp_path / "model.xyz")
    for kind in ("OpenFAST main file (.fst)", "RAFT design or a MoorPy system (.yaml, .yml)", "MoorDyn file (.dat, .txt)"):
        assert kind in str(error.value)
    assert "a folder of results, found a file that ends in .xyz" in str(error.value)
    with pytest.raises(InputError, match="found a name without an ending, and no such file"):
        convert_file(tmp_path / "model")
    with pytest.raises(InputError, match=r"Of an OpenFAST deck name the main file, main\.fst"):
        convert_file(DECK / "hydrodyn.dat")
