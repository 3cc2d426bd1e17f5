"""Sections of MoorDyn's file: their titles, their columns in versions 1 and 2, and their rows.

References:
    MoorDyn documentation, The MoorDyn input file, and MoorDyn2.cpp (FloatingArrayDesign/MoorDyn), ReadInFile (titles).
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from jaxhydro.errors import shown
from jaxhydro.interop.openfast.keyed_file import KeyedFile
from jaxhydro.interop.openfast.table_row import TableRow, bare_word, to_number


@dataclass(frozen=True)
class Section:
    """A section of the file.

    Attributes:
        titles: Words that its title begins with.
        columns: Name of a column -> how its header may call it, in lower case.
        optional: Columns that some versions lack.
    """

    titles: tuple[str, ...]
    columns: Mapping[str, tuple[str, ...]]
    optional: tuple[str, ...] = ()


_XYZ = {"X": ("x", "x0"), "Y": ("y", "y0"), "Z": ("z", "z0")}
TYPES = Section(
    ("LINE TYPES", "LINE TYPE", "LINE DICTIONARY"),
    {
        "Name": ("name", "typename", "linetype", "type"),
        "Diam": ("diam", "diameter", "d"),
        "Mass": ("massden", "massdeninair", "mass/m", "massperlength", "mass", "m"),
        "EA": ("ea",),
    },
)
POINTS = Section(
    ("POINTS", "POINT LIST", "POINT PROPERTIES", "CONNECTION PROPERTIES", "CONNECTIONS", "NODE PROPERTIES", "NODES"),
    {
        "ID": ("id", "node", "point", "num", "connection"),
        "Type": ("type", "attachment", "connection"),
        **_XYZ,
        "M": ("m", "mass"),
        "V": ("v", "vol", "volume"),
    },
    ("M", "V"),
)
LINES = Section(
    ("LINES", "LINE LIST", "LINE PROPERTIES"),
    {
        "ID": ("id", "line", "num"),
        "Name": ("linetype", "type", "typename", "name"),
        "A": ("attacha", "nodeanch", "nodea", "enda", "end-a"),
        "B": ("attachb", "nodefair", "nodeb", "endb", "end-b"),
        "Length": ("unstrlen", "length", "unstrchlen"),
    },
)
BODIES = Section(
    ("BODIES", "BODY LIST", "BODY PROPERTIES", "BODY"),
    {"ID": ("id", "body", "bodyid"), "Type": ("attachment", "type"), **_XYZ, "Roll": ("r0",), "Pitch": ("p0",), "Yaw": ("y0",)},
    ("Type",),
)
RODS = Section(("RODS", "ROD LIST", "ROD PROPERTIES"), {"ID": ("id", "rod", "rodid", "num")})
MEASURED = ("Diam", "X", "Length")  # columns of numbers with a unit
MAP_COLUMN = "cb"  # of MAP++'s line types: friction on the seabed; MoorDyn has none there


def is_moordyn(file: KeyedFile) -> bool:
    """Whether a file has a section of MoorDyn's: line types, points or lines."""
    return any(_title(file, section) is not None for section in (TYPES, POINTS, LINES))


def section_rows(file: KeyedFile, section: Section) -> list[TableRow]:
    """Rows of a section; none where the file has no such section.

    Args:
        file: The file.
        section: The section.

    Raises:
        InputError: A column is missing, or a row is cut short.
    """
    if (start := _title(file, section)) is None:
        return []
    header, count = start + 1, None
    if len(file.words(header)) > 1 and math.isfinite(to_number(file.words(header)[0])):
        header, count = header + 1, to_number(file.words(header)[0])  # version 1 has a count on top
    columns = _columns(file, section, header)
    needed = max(columns.values()) + 1
    _check_units(file, header + 1, columns)
    rows = []
    file.use(range(start, header + 2))
    for index in range(header + 2, len(file.lines)):
        line = file.lines[index].partition("#")[0]
        words = line.split()
        if line.lstrip().startswith("---") or (words and words[0].upper() == "END"):
            break
        if not words:
            continue
        file.use([index])
        if len(words) < needed:
            expected = f"{needed} columns as in the header of {section.titles[0]} (line {header + 1})"
            raise file.wrong(index, expected, f"{len(words)}: {shown(' '.join(words))}")
        rows.append(TableRow(str(file.path), index + 1, {name: bare_word(words[i]) for name, i in columns.items()}))
    if count is not None and count != len(rows):
        raise file.wrong(header - 1, f"the number of rows of {section.titles[0]}, {len(rows)}", f"{count:g}")
    return rows


def rows_by_id(rows: Sequence[TableRow], column: str = "ID") -> dict[str, TableRow]:
    """Rows by their identifier.

    Raises:
        InputError: One is there twice.
    """
    by_id: dict[str, TableRow] = {}
    for row in rows:
        if (name := row.cells[column]) in by_id:
            raise row.wrong(f"each {column} once", f"{shown(name)} again, as in line {by_id[name].line}")
        by_id[name] = row
    return by_id


def _title(file: KeyedFile, section: Section) -> int | None:
    """Index of the title of a section, or None."""
    for index, line in enumerate(file.lines):
        words = " ".join(line.strip(" -=\t").upper().split())
        if "---" in line and any(words == title or words.startswith(f"{title} ") for title in section.titles):
            return index
    return None


def _check_units(file: KeyedFile, index: int, columns: Mapping[str, int]) -> None:
    """Refuse a row of numbers where the units stand: MoorDyn skips that line, and the row would be lost."""
    words = dict(enumerate(file.lines[index].split() if index < len(file.lines) else ()))
    measured = [words.get(columns[name], "") for name in MEASURED if name in columns]
    if measured and all(math.isfinite(to_number(word)) for word in measured):
        raise file.wrong(index, "a row of units under the header", shown(file.lines[index].strip()))


def _columns(file: KeyedFile, section: Section, header: int) -> dict[str, int]:
    """Column of each name by the header of a section."""
    names = [word.lower() for word in (file.lines[header].split() if header < len(file.lines) else ())]
    if section is TYPES and MAP_COLUMN in names:
        raise file.wrong(header, "MoorDyn's columns of LINE TYPES", "CB, a column of MAP++", "Files of MAP++ are not read.")
    columns: dict[str, int] = {}
    for name, spellings in section.columns.items():
        free = [i for i in range(len(names)) if i not in columns.values()]  # y0 is a place, then an angle
        index = next((i for word in spellings for i in free if names[i] == word), None)
        if index is None and name not in section.optional:
            expected = f"the header of {section.titles[0]} with a column {spellings[0]}"
            found = shown(file.lines[header].strip()) if names else "nothing"
            raise file.wrong(header if header < len(file.lines) else None, expected, found)
        if index is not None:
            columns[name] = index
    return columns
