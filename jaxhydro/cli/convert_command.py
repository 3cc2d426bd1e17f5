"""Command `convert`: a platform file from another program's model."""

import shutil
from collections.abc import Sequence
from pathlib import Path

from jaxhydro.cli.console import complain, say
from jaxhydro.dynamics.model import Model
from jaxhydro.errors import InputError, Problem
from jaxhydro.files import check_new_folder, staged
from jaxhydro.interop.conversion import Conversion, ConvertedItem, Treatment
from jaxhydro.interop.converters import convert_file
from jaxhydro.interop.platform_text import conversion_page, counted, platform_text
from jaxhydro.platform.build import build
from jaxhydro.platform.schema import load_platform

PLATFORM_FILE, PAGE = "platform.yaml", "conversion.md"
MAX_TOLD = 12  # approximated items that are printed before the page is named


def convert_model(source: Path, folder: Path) -> None:
    """Write platform.yaml, the files that it names and conversion.md, and print a summary.

    The platform is loaded and built before anything is written.

    Args:
        source: The other program's file.
        folder: A new or an empty folder.

    Raises:
        InputError: The folder is not empty, or the source cannot be used. Nothing is written.
    """
    check_new_folder(folder, "--out", "Name a new folder.")
    conversion = convert_file(source)
    with staged(folder) as temporary:
        (temporary / PLATFORM_FILE).write_text(platform_text(conversion, str(source)), encoding="utf-8")
        (temporary / PAGE).write_text(conversion_page(conversion, source.resolve().name), encoding="utf-8")
        for name, path in conversion.files.items():
            copy_whole(path, temporary / name)
        model = _built(temporary, source)
    _print(conversion, model, source, folder)


def _built(folder: Path, source: Path) -> Model:
    """The model of the platform file that was written, to see that it can be used."""
    try:
        return build(load_platform(folder / PLATFORM_FILE))
    except InputError as error:
        inside = str(folder)
        problems = [Problem(p.where, p.expected, p.found.replace(inside, ""), p.hint) for p in error.problems]
        raise InputError(f"{source}, as {PLATFORM_FILE}", problems) from None


def copy_whole(source: Path, target: Path) -> None:
    """Copy a file. Raises InputError where it cannot be read."""
    try:
        shutil.copyfile(source, target)
    except OSError as error:
        raise InputError(str(source), [Problem("", "a file that can be copied", error.strerror or str(error))]) from None


def print_losses(items: Sequence[ConvertedItem]) -> None:
    """Print warnings, what was approximated, and the names of what else was left out."""
    for item in items:
        if item.warning:
            complain(f"warning: {item.source}: {item.meaning}")
    close = [item for item in items if item.treatment is Treatment.APPROXIMATED]
    for item in close[:MAX_TOLD]:
        say(f"approximated: {item.source}: {item.meaning}")
    if len(close) > MAX_TOLD:
        say(f"and {len(close) - MAX_TOLD} more.")
    for item in items:
        if item.treatment is Treatment.TO_FILL_IN and not item.warning:
            say(f"to be filled in: {item.source}: {item.meaning}")
    if left_out := [item.source for item in items if item.treatment is Treatment.LEFT_OUT and not item.warning]:
        say(f"left out: {'; '.join(left_out)}.")


def _print(conversion: Conversion, model: Model, source: Path, folder: Path) -> None:
    say(f"{folder} is made from {source}: {counted(conversion.items)}.", "bold")
    print_losses(conversion.items)
    for remark in model.remarks:
        if remark.warning:
            say(f"warning: {remark.text.replace(str(folder.parent), '')}")
    say(f"1. Read {folder / PAGE}: it says what became of each item.")
    say(f"2. Try it: jaxhydro simulate {folder / PLATFORM_FILE} --release heave=1")
    say(f"3. To calibrate it to records: jaxhydro init NEW_FOLDER DATA_FILES --platform {folder / PLATFORM_FILE}")
