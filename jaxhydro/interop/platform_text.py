"""Text of a platform file, and of the page that says what became of a source, from a conversion."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from jaxhydro.interop.conversion import Conversion, ConvertedItem, Treatment
from jaxhydro.interop.yaml_text import yaml_text

HEADINGS = {
    Treatment.TO_FILL_IN: "To be filled in by hand",
    Treatment.TAKEN: "Taken",
    Treatment.APPROXIMATED: "Approximated",
    Treatment.LEFT_OUT: "Left out",
}
_LINES_HEAD = """\
# Made by `jaxhydro convert` from {source}.
# Sections of a platform file: paste `mooring` into it. `water` is that of the lines; the platform file has its own.
# conversion.md says what was taken, what was approximated and what was left out. All keys: docs/formats.md.
# SI units. x, y horizontal, z up from still water. Fairleads are from the platform's reference point.
"""
_HEAD = """\
# Made by `jaxhydro convert` from {source}.
# conversion.md says what was taken, what was approximated and what was left out. All keys: docs/formats.md.
# SI units. x, y horizontal, z up from still water; inertia about the centre of mass.
"""


def platform_text(conversion: Conversion, source: str) -> str:
    """Text of the platform file of a conversion, or of the sections of one.

    Args:
        conversion: The conversion.
        source: Name of what was converted, for the header.
    """
    missing = [item for item in conversion.items if item.treatment is Treatment.TO_FILL_IN]
    lines = [f"#   {item.source}: {' '.join(item.meaning.split())}\n" for item in missing]
    told = "# To be filled in by hand:\n" + "".join(lines) if lines else ""
    head = _HEAD if conversion.whole else _LINES_HEAD
    return head.format(source=" ".join(source.split())) + told + yaml_text(conversion.platform)


def conversion_page(conversion: Conversion, source: str, name: str = "platform.yaml") -> str:
    """Page that says what became of each item of a source, in Markdown.

    Args:
        conversion: The conversion.
        source: Name of what was converted.
        name: Name of the file that was made of it.
    """
    return items_page(f"{source} as {name}", conversion.items, conversion.files)


def items_page(title: str, items: Sequence[ConvertedItem], files: Mapping[str, Path]) -> str:
    """Page of tables of what was taken, approximated and left out, in Markdown.

    Args:
        title: Its title.
        items: The items.
        files: Copied files: name -> file that it is a copy of.
    """
    lines = [f"# {_plain(title)}", "", f"{len(items)} items: {counted(items)}."]
    for kind, heading in HEADINGS.items():
        if rows := [_row(item) for item in items if item.treatment is kind]:
            lines += ["", f"## {heading}", "", "| source | meaning |", "|---|---|", *rows]
    if files:
        lines += ["", "## Copied files", "", "| file | from |", "|---|---|"]
        lines += [f"| {_plain(name)} | {_plain(str(path))} |" for name, path in files.items()]
    return "\n".join(lines) + "\n"


def counted(items: Sequence[ConvertedItem]) -> str:
    """Number of items by what became of them, in words."""
    counts = {kind: sum(item.treatment is kind for item in items) for kind in Treatment}
    return ", ".join(f"{count} {kind}" for kind, count in counts.items() if count or kind is not Treatment.TO_FILL_IN)


def _row(item: ConvertedItem) -> str:
    return f"| {_plain(item.source)} | {_plain(item.meaning)} |"


def _plain(text: str) -> str:
    """Text as it stands in a cell of a table."""
    return " ".join(text.split()).replace("|", "\\|")
