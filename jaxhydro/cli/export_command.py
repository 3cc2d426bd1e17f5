"""Command `export`: another program's model from a platform file."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from jaxhydro.cli.arguments import DeckFormat
from jaxhydro.cli.console import say
from jaxhydro.cli.convert_command import copy_whole, print_losses
from jaxhydro.dynamics.model import Model
from jaxhydro.files import check_new_folder, staged
from jaxhydro.interop.openfast.export_deck import export_deck
from jaxhydro.interop.openfast.export_source import ExportedDeck, ExportSource, PotentialTable
from jaxhydro.interop.platform_text import counted, items_page
from jaxhydro.platform.build import build, members_of
from jaxhydro.platform.catenary_schema import Catenary
from jaxhydro.platform.drag_laws import drag_laws_of
from jaxhydro.platform.schema import Platform, load_platform

PAGE, MAIN = "export.md", "main.fst"
WRITERS = {DeckFormat.openfast: export_deck}


def export_model(platform: str, folder: Path, kind: DeckFormat, calibration: Path | None) -> None:
    """Write a deck and export.md, and print a summary.

    Args:
        platform: A platform file, or a built-in name.
        folder: A new or an empty folder.
        kind: The program.
        calibration: A calibration's folder or file, whose values are taken.

    Raises:
        InputError: The folder is not empty, or the platform or the calibration cannot be used. Nothing is written.
    """
    check_new_folder(folder, "--out", "Name a new folder.")
    declared = load_platform(platform)
    model = build(declared)
    if calibration is not None:
        from jaxhydro.cli.simulate_command import calibrated

        model = calibrated(model, platform, declared.name, calibration)
    deck = WRITERS[kind](source_of(declared, model))
    with staged(folder) as temporary:
        for name, text in deck.texts.items():
            (temporary / name).write_text(text, encoding="utf-8")
        for name, path in deck.files.items():
            copy_whole(path, temporary / name)
        page = items_page(f"{declared.name} as an OpenFAST 5 deck", deck.items, deck.files)
        (temporary / PAGE).write_text(page, encoding="utf-8")
    _print(deck, declared.name, folder)


def source_of(declared: Platform, model: Model) -> ExportSource:
    """What a deck is written from.

    Args:
        declared: Contents of the platform file.
        model: Its model, with calibrated values.
    """
    mooring = declared.mooring
    lines = mooring.line_types if isinstance(mooring, Catenary) else {}
    return ExportSource(
        declared.name,
        model,
        members_of(declared),
        drag_laws={label: law.model_dump(exclude_none=True) for label, law in drag_laws_of(model).items()},
        line_diameters={kind: one.diameter for kind, one in lines.items() if one.diameter is not None},
        seabed_depth=mooring.seabed_depth(declared.water.depth) if isinstance(mooring, Catenary) else declared.water.depth,
        tables=_tables(declared),
    )


def _tables(declared: Platform) -> Mapping[str, PotentialTable]:
    found: dict[str, PotentialTable] = {}
    for key in ("radiation", "excitation", "drift"):
        if (one := getattr(declared, key)) is None:
            continue
        values: dict[str, Any] = {"by": one.by, "length": one.length or 1.0, "body": one.body}
        if key == "drift":
            values["approximation"] = one.approximation
        found[key] = PotentialTable(Path(one.file), getattr(one, "kind", None) or "wamit", **values)
    return found


def _print(deck: ExportedDeck, name: str, folder: Path) -> None:
    say(f"{folder} is made from {name}: {counted(deck.items)}.", "bold")
    print_losses(deck.items)
    say(f"1. Read {folder / PAGE}: it says what became of each item.")
    say(f"2. Run it: openfast {folder / MAIN}")
    say("3. To release it: set PtfmSurge to PtfmYaw in elastodyn.dat. For waves: set WaveMod in seastate.dat.")
