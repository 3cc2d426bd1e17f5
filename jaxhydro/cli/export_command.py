"""Command `export`: another program's model from a platform file."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from jaxhydro.cli.console import say
from jaxhydro.cli.convert_command import copy_whole, print_losses
from jaxhydro.cli.option_choices import DeckFormat
from jaxhydro.dynamics.model import Model
from jaxhydro.files import check_new_folder, staged
from jaxhydro.interop.export_source import ExportedModel, ExportSource, PotentialTable
from jaxhydro.interop.openfast.export_deck import export_deck
from jaxhydro.interop.openfast.export_moordyn import ALONE, export_lines
from jaxhydro.interop.platform_text import counted, items_page
from jaxhydro.interop.raft_export_design import DESIGN, export_design
from jaxhydro.platform.build import build
from jaxhydro.platform.catenary_schema import Catenary
from jaxhydro.platform.drag_laws import drag_laws_of
from jaxhydro.platform.members_build import members_of
from jaxhydro.platform.schema import Platform, load_platform

PAGE = "export.md"


@dataclass(frozen=True)
class Writer:
    """Writer of a format.

    Attributes:
        write: Makes the files of a platform.
        title: What they are, for the title of the page.
        steps: What to do with them, after the page was read; {folder} stands for the new folder.
    """

    write: Callable[[ExportSource], ExportedModel]
    title: str
    steps: tuple[str, ...]


WRITERS = {
    DeckFormat.openfast: Writer(
        export_deck,
        "an OpenFAST 5 deck",
        (
            "Run it: openfast {folder}/main.fst",
            "To release it: set PtfmSurge to PtfmYaw in elastodyn.dat. For waves: set WaveMod in seastate.dat.",
        ),
    ),
    DeckFormat.raft: Writer(
        export_design,
        "a RAFT design",
        (
            "Set the frequencies in `settings` and the seas in `cases`.",
            f"Run it in Python: raft.Model(yaml.safe_load(open('{{folder}}/{DESIGN}'))).analyzeCases()",
        ),
    ),
    DeckFormat.moordyn: Writer(
        export_lines,
        "a MoorDyn 2 file",
        (f"Name {{folder}}/{ALONE} in the program that moves the fairleads.",),
    ),
}


def export_model(platform: str, folder: Path, kind: DeckFormat, calibration: Path | None) -> None:
    """Write another program's model and export.md, and print a summary.

    Args:
        platform: A platform file, or a built-in name.
        folder: A new or an empty folder.
        kind: The program.
        calibration: A calibration's folder or file, whose values are taken.

    Raises:
        InputError: The folder is not empty, the platform or the calibration cannot be used, or the format cannot have the
            platform. Nothing is written.
    """
    check_new_folder(folder, "--out", "Name a new folder.")
    contents = load_platform(platform)
    model = build(contents)
    if calibration is not None:
        from jaxhydro.cli.model_messages import calibrated

        model = calibrated(model, platform, contents.name, calibration)
    writer = WRITERS[kind]
    exported = writer.write(source_of(contents, model))
    with staged(folder) as temporary:
        for name, text in exported.texts.items():
            (temporary / name).write_text(text, encoding="utf-8")
        for name, path in exported.files.items():
            copy_whole(path, temporary / name)
        page = items_page(f"{contents.name} as {writer.title}", exported.items, exported.files)
        (temporary / PAGE).write_text(page, encoding="utf-8")
    _print(exported, writer, contents.name, folder)


def source_of(platform: Platform, model: Model) -> ExportSource:
    """Source from which another program's model is written.

    Args:
        platform: Contents of the platform file.
        model: Its model, with calibrated values.
    """
    mooring = platform.mooring
    lines = mooring.line_types if isinstance(mooring, Catenary) else {}
    return ExportSource(
        platform.name,
        model,
        members_of(platform),
        headings=[member.heading for member in platform.members],
        drag_laws={label: law.model_dump(exclude_none=True) for label, law in drag_laws_of(model).items()},
        line_diameters={kind: line_type.diameter for kind, line_type in lines.items() if line_type.diameter is not None},
        seabed_depth=mooring.seabed_depth(platform.water.depth) if isinstance(mooring, Catenary) else platform.water.depth,
        tables=_tables(platform),
    )


def _tables(platform: Platform) -> Mapping[str, PotentialTable]:
    tables: dict[str, PotentialTable] = {}
    for key in ("radiation", "excitation", "drift"):
        if (table := getattr(platform, key)) is None:
            continue
        values: dict[str, Any] = {"by": table.by, "length": table.length or 1.0, "body": table.body}
        if key == "drift":
            values["approximation"] = table.approximation
        tables[key] = PotentialTable(Path(table.file), getattr(table, "kind", None) or "wamit", **values)
    return tables


def _print(exported: ExportedModel, writer: Writer, name: str, folder: Path) -> None:
    say(f"{folder} is made from {name}: {counted(exported.items)}.", "bold")
    print_losses(exported.items)
    say(f"1. Read {folder / PAGE}: it says what became of each item.")
    for number, step in enumerate(writer.steps, 2):
        say(f"{number}. {step.format(folder=folder)}")
