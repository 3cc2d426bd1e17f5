"""MoorDyn's file: line types, points and lines of versions 1 and 2.

References:
    MoorDyn documentation, The MoorDyn input file (sections LINE TYPES, POINTS, LINES; in version 1 LINE DICTIONARY, NODE or
    CONNECTION PROPERTIES, LINE PROPERTIES), and OpenFAST v5.0.0 (2895884), MoorDyn.f90.
"""

import math
from collections.abc import Sequence

from jaxhydro.errors import shown
from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.mooring_system import Attachment, LineType, MooringLine, MooringPoint, MooringSystem
from jaxhydro.interop.openfast.keyed_file import KeyedFile
from jaxhydro.interop.openfast.table_row import TableRow, to_number

ATTACHMENTS = {
    **dict.fromkeys(("vessel", "coupled", "ves", "cpld", "fairlead"), Attachment.PLATFORM),
    **dict.fromkeys(("fixed", "fix", "anchor", "anch"), Attachment.GROUND),
    **dict.fromkeys(("free", "connect", "con", "point", "p", "pin"), Attachment.FREE),
}
NAMES = {  # of a column -> how its header may call it
    "Name": ("Name", "TypeName", "LineType"),
    "Diam": ("Diam", "Diameter", "D"),
    "Mass": ("MassDen", "MassDenInAir", "Mass/m", "MassPerLength", "m"),
    "EA": ("EA",),
    "ID": ("ID", "Node", "Point", "Line", "Num", "Connection"),
    "Type": ("Type", "Attachment", "Connection"),
    "X": ("X",),
    "Y": ("Y",),
    "Z": ("Z",),
    "M": ("M", "Mass"),
    "V": ("V", "Volume"),
    "Length": ("UnstrLen", "Length", "UnstrchLen"),
    "A": ("AttachA", "NodeAnch", "EndA", "End-A"),
    "B": ("AttachB", "NodeFair", "EndB", "End-B"),
}
SECTIONS = {  # words of a section's title -> the section
    "types": ("LINE TYPES", "LINE DICTIONARY"),
    "points": ("POINTS", "POINT PROPERTIES", "CONNECTION PROPERTIES", "CONNECTIONS", "NODE PROPERTIES", "NODES"),
    "lines": ("LINES", "LINE PROPERTIES", "LINE LIST"),
    "bodies": ("BODIES", "BODY"),
    "rods": ("RODS", "ROD LIST", "ROD PROPERTIES"),
}


def read_mooring_system(file: KeyedFile, level: float, depth: float) -> tuple[MooringSystem, list[ConvertedItem]]:
    """Points, line types and lines of MoorDyn's file, and what was left out of it.

    Args:
        file: The file.
        level: Still water above mean sea level, m.
        depth: Of the water below still water, m.

    Raises:
        InputError: A section is missing or broken, or a line names a point or type that is not there.
    """
    sections = {name: _section(file, titles) for name, titles in SECTIONS.items()}
    for name in ("types", "points", "lines"):
        if not sections[name]:
            raise file.wrong(None, f"a section {SECTIONS[name][0]} with a row", "none")
    types = {row.cells["Name"]: _line_type(row) for row in sections["types"]}
    points = {row.cells["ID"]: _point(row, level) for row in sections["points"]}
    lines = {}
    for row in sections["lines"]:
        kind = row.cells["Name"]
        if kind not in types:
            raise row.wrong(f"a line type of the file ({', '.join(types)})", shown(kind))
        ends = (row.cells["A"], row.cells["B"])
        if unknown := [end for end in ends if end not in points]:
            raise row.wrong(f"a point of the file ({', '.join(points)})", shown(unknown[0]))
        if (length := row.number("Length")) <= 0.0:
            raise row.wrong("an unstretched length > 0", f"{length:g}")
        name = row.cells["ID"]
        lines[name] = MooringLine(name, ends, length, kind)
    items = [
        ConvertedItem(f"{file.name}: {SECTIONS[name][0]}", Treatment.LEFT_OUT, f"MoorDyn's {name} have no counterpart.")
        for name in ("bodies", "rods")
        if sections[name]
    ]
    bed = file.number("WtrDpth") - level if file.has("WtrDpth") else depth
    return MooringSystem(bed, points, types, lines), items


def _section(file: KeyedFile, titles: Sequence[str]) -> list[TableRow]:
    """Rows of the section with one of these titles."""
    titled = [line.lstrip().startswith("---") and line.strip(" -=\t").upper() in titles for line in file.lines]
    if True not in titled:
        return []
    start = titled.index(True)
    header = start + 1
    if len(file.words(header)) > 1 and math.isfinite(to_number(file.words(header)[0])):
        header += 1  # version 1 has a count on top
    names = file.words(header)
    columns = {name: i for name, spellings in reversed(NAMES.items()) for i, column in enumerate(names) if column in spellings}
    if "Name" not in columns and "ID" not in columns:
        raise file.wrong(header, f"the header of {titles[0]}", shown(file.lines[header].strip() if names else "nothing"))
    rows = []
    file.use(range(start, header + 2))
    for index in range(header + 2, len(file.lines)):
        words = file.words(index)
        if not words or file.lines[index].lstrip().startswith("---") or words[0].upper() == "END":
            break
        file.use([index])
        most = max(columns.values())
        if len(words) <= most:
            raise file.wrong(index, f"{most + 1} columns as in the header of {titles[0]}", f"{len(words)}")
        rows.append(TableRow(str(file.path), index + 1, {name: words[i] for name, i in columns.items()}))
    return rows


def _line_type(row: TableRow) -> LineType:
    values = {key: row.number(key) for key in ("Diam", "Mass", "EA")}
    for key, value in values.items():
        if value <= 0.0 and key != "Diam":
            raise row.wrong(f"a number > 0 for {key}", f"{value:g}")
    return LineType(row.cells["Name"], values["Diam"], values["Mass"], values["EA"])


def _point(row: TableRow, level: float) -> MooringPoint:
    position = (row.number("X"), row.number("Y"), row.number("Z") - level)
    attachment = ATTACHMENTS.get(row.cells["Type"].lower(), Attachment.OTHER)
    return MooringPoint(row.cells["ID"], attachment, position, row.number("M", 0.0), row.number("V", 0.0))
