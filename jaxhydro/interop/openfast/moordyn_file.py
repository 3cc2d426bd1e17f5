"""MoorDyn's file: line types, points and lines of versions 1 and 2.

References:
    MoorDyn documentation, The MoorDyn input file (sections LINE TYPES, POINTS, LINES, BODIES, OPTIONS), and OpenFAST v5.0.0
    (2895884), MoorDyn.f90.
"""

import math
import re
from collections.abc import Mapping

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from jaxhydro.errors import shown, suggest
from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.mooring_system import ON_BED, Attachment, LineType, MooringLine, MooringPoint, MooringSystem
from jaxhydro.interop.openfast.keyed_file import KeyedFile
from jaxhydro.interop.openfast.moordyn_tables import BODIES, LINES, POINTS, RODS, TYPES, rows_by_id, section_rows
from jaxhydro.interop.openfast.table_row import TableRow, to_number
from jaxhydro.rotations import rotation

ATTACHMENTS = {
    **dict.fromkeys(("vessel", "coupled", "ves", "cpld", "fairlead"), Attachment.PLATFORM),
    **dict.fromkeys(("fixed", "fix", "anchor", "anch"), Attachment.GROUND),
    **dict.fromkeys(("free", "connect", "con", "point", "p", "pin"), Attachment.FREE),
}
ATTACHMENT_WORDS = "Fixed, Vessel, Coupled, Free, Connect, or Body and its number"
DEPTH_KEYS = ("WtrDpth", "WtrDepth", "depth")
ON_BED_WORD = "seabed"  # in place of a height
MAX_DEPTH = 11_000.0  # m, of the deepest sea
_ON_BODY = re.compile(r"body(\d+)\w*", re.IGNORECASE)
_ON_TURBINE = re.compile(r"(turbine|t)(\d+)", re.IGNORECASE)
_ROD_END = re.compile(r"r(od)?(\d+)[ab]", re.IGNORECASE)
_POINT_PREFIX = re.compile(r"^(point|connection|con|node|p|c|n)(?=\d+$)", re.IGNORECASE)
_BODY_ID = re.compile(r"(?:body)?(\d+)(\w*)", re.IGNORECASE)


def read_mooring_system(
    file: KeyedFile, level: float = 0.0, depth: float | None = None
) -> tuple[MooringSystem, list[ConvertedItem]]:
    """Points, line types and lines of MoorDyn's file, and what was left out of it.

    Args:
        file: The file.
        level: Still water above mean sea level, from which the file's heights count, m.
        depth: Of the water below still water, where the file states none, m. None: that of the deepest fixed point.

    Raises:
        InputError: A section is missing or broken, or a line names a point or type that is not there.
    """
    sections = {section.titles[0]: section_rows(file, section) for section in (TYPES, POINTS, LINES)}
    for name, rows in sections.items():
        if not rows:
            raise file.wrong(None, f"a section {name} with a row", "none")
    bodies, rods = section_rows(file, BODIES), section_rows(file, RODS)
    items: list[ConvertedItem] = []
    types = {name: _line_type(row, file.name, items) for name, row in rows_by_id(sections["LINE TYPES"], "Name").items()}
    stated = _stated_depth(file)
    point_rows = {name: _with_height(row, stated) for name, row in rows_by_id(sections["POINTS"]).items()}
    numbered = _by_number(bodies)
    points = {name: _point(row, level, numbered) for name, row in point_rows.items()}
    lines = {name: _line(row, points, types) for name, row in rows_by_id(sections["LINES"]).items()}
    if bodies:
        text = "Points on a coupled body are on the platform. Mass, volume and drag of bodies are left out."
        items.append(ConvertedItem(f"{file.name}: BODIES", Treatment.LEFT_OUT, text))
    if rods:
        items.append(ConvertedItem(f"{file.name}: RODS", Treatment.LEFT_OUT, "MoorDyn's rods have no counterpart."))
    bed = _depth(file, depth, points) if stated is None else stated + level
    for name, point in points.items():
        if point.attachment is Attachment.GROUND and point.position[2] < -bed * (1 + ON_BED):
            raise point_rows[name].wrong(
                f"a fixed point on or above the sea bed, z = {-bed:g} m", f"z = {point.position[2]:g} m"
            )
    return MooringSystem(bed, points, types, lines), items


def stated_depth(file: KeyedFile) -> str | None:
    """Key of the water depth that a file has, or None."""
    return next((key for key in DEPTH_KEYS if file.has(key)), None)


def _stated_depth(file: KeyedFile) -> float | None:
    """Depth of the bed that a file states, m, below the level from which its heights count; None where it states none."""
    if (key := stated_depth(file)) is None:
        return None
    if not math.isfinite(to_number(file.word(key))):
        hint = "Files of a sea bed that is not level are not read."
        raise file.wrong(file.line_of(key), "a depth in m", shown(file.word(key)), hint, key=key)
    depth = file.number(key)
    if not 0.0 < depth <= MAX_DEPTH:
        raise file.wrong(file.line_of(key), f"a depth of more than 0 and at most {MAX_DEPTH:g} m", f"{depth:g}", key=key)
    return depth


def _depth(file: KeyedFile, depth: float | None, points: Mapping[str, MooringPoint]) -> float:
    """Depth of the bed below still water, m, where the file states none: `depth`, or that of the deepest fixed point."""
    if depth is None:
        fixed = [point.position[2] for point in points.values() if point.attachment is Attachment.GROUND]
        if not fixed or min(fixed) >= 0.0:
            raise file.wrong(None, f"a water depth ({DEPTH_KEYS[0]}), or a fixed point under water", "neither")
        depth = -min(fixed)
    return depth


def _with_height(row: TableRow, depth: float | None) -> TableRow:
    """A point whose height is a number: MoorPy takes the word seabed as well."""
    if row.cells["Z"].lower() != ON_BED_WORD:
        return row
    if depth is None:
        raise row.wrong("a number for Z, as the file states no water depth", shown(row.cells["Z"]))
    return TableRow(row.source, row.line, {**row.cells, "Z": f"{-depth!r}"})


def _line_type(row: TableRow, name: str, items: list[ConvertedItem]) -> LineType:
    static, _, dynamic = row.cells["EA"].partition("|")
    if dynamic and math.isfinite(to_number(static)):
        text = (
            f"EA is the static stiffness, {static} N, of {row.cells['EA']}. Stiffer behaviour at wave frequencies is left out."
        )
        items.append(ConvertedItem(f"{name}: EA of {row.cells['Name']}", Treatment.APPROXIMATED, text))
        row = TableRow(row.source, row.line, {**row.cells, "EA": static})
    elif not math.isfinite(to_number(static)):
        hint = "For a rope with a table see `kind: tension_table` in docs/formats.md." if "." in static or ":" in static else ""
        raise row.wrong("a number for EA", shown(row.cells["EA"]), hint)
    values = {key: row.number(key) for key in ("Diam", "Mass", "EA")}
    for key, value in values.items():
        if value < 0.0 or (value == 0.0 and key != "Diam"):
            raise row.wrong(f"a number {'>=' if key == 'Diam' else '>'} 0 for {key}", f"{value:g}")
    return LineType(row.cells["Name"], values["Diam"], values["Mass"], values["EA"], row.line)


def _point(row: TableRow, level: float, bodies: Mapping[str, TableRow]) -> MooringPoint:
    word, name = row.cells["Type"], row.cells["ID"]
    attachment = ATTACHMENTS.get(word.lower())
    position = np.array([row.number("X"), row.number("Y"), row.number("Z")])
    if (on_body := _ON_BODY.fullmatch(word)) is not None:
        if (body := bodies.get(on_body[1])) is None:
            raise row.wrong(f"a body of the file ({', '.join(bodies) or 'it has none'})", shown(word))
        attachment = _attachment_of_body(body)
        position = _earth_fixed(body, position)
    elif _ON_TURBINE.fullmatch(word):
        attachment = Attachment.OTHER
    if attachment is None:
        raise row.wrong(
            ATTACHMENT_WORDS, shown(word), suggest(word, ("Fixed", "Vessel", "Coupled", "Free", "Connect", "Anchor"))
        )
    position[2] -= level
    x, y, z = (float(value) for value in position)
    return MooringPoint(name, attachment, (x, y, z), row.number("M", 0.0), row.number("V", 0.0), row.line)


def _earth_fixed(body: TableRow, position: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    """Position (m) of a point that is stated in the axes of a body."""
    angles = np.radians([body.number(key) for key in ("Roll", "Pitch", "Yaw")])
    if np.count_nonzero(angles) > 1:  # their order differs between versions of MoorDyn
        found = ", ".join(f"{angle:g}" for angle in np.degrees(angles))
        raise body.wrong("at most one angle of r0, p0 and y0 that is not 0", found)
    place = np.array([body.number(key) for key in "XYZ"])
    return place + np.asarray(rotation(jnp.asarray(angles))) @ position if angles.any() else place + position


def _by_number(bodies: list[TableRow]) -> dict[str, TableRow]:
    """Bodies by the number in their identifier, which old files write with the attachment, as 1coupled."""
    numbered = {}
    for row in bodies:
        if (match := _BODY_ID.fullmatch(row.cells["ID"])) is None:
            raise row.wrong("the number of a body", shown(row.cells["ID"]))
        numbered[match[1]] = TableRow(row.source, row.line, {"Type": match[2], **row.cells})
    return numbered


def _attachment_of_body(body: TableRow) -> Attachment:
    """What points on a body are fixed to: a coupled body is the platform, a free one moves by itself."""
    attachment = ATTACHMENTS.get(body.cells["Type"].lower(), Attachment.OTHER)
    return Attachment.OTHER if attachment is Attachment.FREE else attachment


def _line(row: TableRow, points: dict[str, MooringPoint], types: Mapping[str, LineType]) -> MooringLine:
    """A line; rods' ends that it names are added to the points."""
    kind = row.cells["Name"]
    if kind not in types:
        raise row.wrong(f"a line type of the file ({', '.join(types)})", shown(kind), suggest(kind, types))
    ends = []
    for end in (row.cells["A"], row.cells["B"]):
        name = end if end in points else _POINT_PREFIX.sub("", end)
        if _ROD_END.fullmatch(end):
            points.setdefault(end, MooringPoint(end, Attachment.OTHER, (0.0, 0.0, 0.0)))
            name = end
        if name not in points:
            raise row.wrong(f"a point of the file ({', '.join(points)})", shown(end))
        ends.append(name)
    if ends[0] == ends[1]:
        raise row.wrong("two different points", f"{shown(ends[0])} twice")
    if (length := row.number("Length")) <= 0.0:
        raise row.wrong("an unstretched length > 0", f"{length:g}")
    return MooringLine(row.cells["ID"], (ends[0], ends[1]), length, kind, row.line)
