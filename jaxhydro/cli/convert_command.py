"""Command `convert`: a platform file from another program's model."""

import shutil
from collections.abc import Sequence
from pathlib import Path

import jax.numpy as jnp
import numpy as np

from jaxhydro.cli.console import complain, say
from jaxhydro.dynamics.model import Model
from jaxhydro.errors import InputError, Problem
from jaxhydro.files import check_new_folder, staged
from jaxhydro.input_schema import validate
from jaxhydro.interop.conversion import Conversion, ConvertedItem, Treatment
from jaxhydro.interop.converters import convert_file
from jaxhydro.interop.platform_text import conversion_page, counted, platform_text
from jaxhydro.platform.build import build
from jaxhydro.platform.catenary_build import catenary_lines
from jaxhydro.platform.catenary_schema import Catenary
from jaxhydro.platform.schema import Water, load_platform

PLATFORM_FILE, MOORING_FILE, PAGE = "platform.yaml", "mooring.yaml", "conversion.md"
MAX_TOLD = 12  # approximated items that are printed before the page is named


def convert_model(source: Path, folder: Path, mooring: Path | None = None) -> None:
    """Write platform.yaml, the files that it names and conversion.md, and print a summary.

    The platform is loaded and built before anything is written. Of a file of mooring lines, mooring.yaml takes its place.

    Args:
        source: The other program's file.
        folder: A new or an empty folder.
        mooring: File of the mooring lines, where the source has none.

    Raises:
        InputError: The folder is not empty, or the source cannot be used. Nothing is written.
    """
    check_new_folder(folder, "--out", "Name a new folder.")
    conversion = convert_file(source, mooring)
    sources = str(source) if mooring is None else f"{source} and {mooring}"
    name = PLATFORM_FILE if conversion.whole else MOORING_FILE
    with staged(folder) as temporary:
        (temporary / name).write_text(platform_text(conversion, sources), encoding="utf-8")
        (temporary / PAGE).write_text(conversion_page(conversion, source.resolve().name, name), encoding="utf-8")
        for copied, path in conversion.files.items():
            copy_whole(path, temporary / copied)
        if conversion.whole:
            remarks = _remarks(_built(temporary, sources), folder)
            remarks += [] if mooring is None else lines_in_words(conversion, f"{sources}, as {name}")
            steps = [f"Try it: jaxhydro simulate {folder / name} --release heave=1"]
            steps += [f"To calibrate it to records: jaxhydro init NEW_FOLDER DATA_FILES --platform {folder / name}"]
        else:
            remarks = lines_in_words(conversion, f"{sources}, as {name}")
            steps = [f"Paste `mooring` of {folder / name} into a platform file, whose `water` has the depth of its `water`."]
            steps += ["Or convert the platform with it: jaxhydro convert SOURCE --mooring " + f"{source} --out FOLDER"]
    _print(
        conversion,
        f"{folder} is made from {sources}",
        remarks,
        [f"Read {folder / PAGE}: it says what became of each item.", *steps],
    )


def _built(folder: Path, source: str) -> Model:
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


def lines_in_words(conversion: Conversion, source: str) -> list[str]:
    """Tensions of the lines of section `mooring` in the reference position, and their pull, in sentences.

    Args:
        conversion: Sections `water` and `mooring`.
        source: Name of the file, for messages.

    Raises:
        InputError: The section is not valid, or a line finds no balance.
    """
    water = validate(Water, conversion.platform["water"], source)
    mooring = validate(Catenary, conversion.platform["mooring"], source)
    if problems := list(mooring.water_faults(water.density, water.depth, water.gravity)):
        raise InputError(source, problems)
    tension, direction = map(np.asarray, catenary_lines(mooring, water).tension(jnp.zeros(6), jnp.eye(3)))
    if not np.isfinite(tension).all():
        lost = ", ".join(str(i + 1) for i in np.flatnonzero(~np.isfinite(tension)))
        raise InputError(source, [Problem("mooring.lines", "lines in static balance", f"none for line {lost}")])
    told = ", ".join(f"{force / 1e3:.5g}" for force in tension)
    down = float(-(tension * direction[2]).sum())
    pull = f"They pull {down / 1e3:.5g} kN down, the weight of {down / water.gravity:.5g} kg."
    return [f"tension at the fairleads in the reference position (kN): {told}. {pull}"]


def _remarks(model: Model, folder: Path) -> list[str]:
    return [f"warning: {remark.text.replace(str(folder.parent), '')}" for remark in model.remarks if remark.warning]


def _print(conversion: Conversion, made: str, remarks: Sequence[str], steps: Sequence[str]) -> None:
    say(f"{made}: {counted(conversion.items)}.", "bold")
    print_losses(conversion.items)
    for remark in remarks:
        say(remark)
    for number, step in enumerate(steps, 1):
        say(f"{number}. {step}")
