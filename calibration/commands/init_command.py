"""Command `init`: a new campaign folder, with what can be guessed from data files."""

import re
import shutil
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from calibration.campaign.manifest_sections import WAVE
from calibration.formatting import counted
from calibration.new_campaign.campaign_draft import CampaignDraft, TestDraft, example_draft
from calibration.new_campaign.column_guesses import ColumnGuess
from calibration.new_campaign.draft_of_files import draft_of_files
from calibration.new_campaign.draft_text import campaign_text
from jaxhydro.cli.console import say, table
from jaxhydro.errors import InputError, Problem
from jaxhydro.files import MANIFEST, check_new_folder, staged
from jaxhydro.input_schema import read_yaml
from jaxhydro.platform.schema import Platform, builtin_platforms, builtin_text, load_platform

PLATFORM_FILE = "platform.yaml"
GUESSED_UNIT = "?"  # behind a unit that no file states
SAME = "as above"  # columns of a file, where the one before has the same


def init_campaign(folder: Path, platform: str, scale: float | None, files: Sequence[Path]) -> CampaignDraft:
    """Make a campaign folder, print what was guessed and what to do next.

    Args:
        folder: Folder to make; it may exist if it is empty.
        platform: Built-in platform, or path of a platform file.
        scale: Froude length scale of the records, or None.
        files: Data files, one per test, which are copied.

    Raises:
        InputError: The folder is not empty, or the platform or a data file cannot be used. Nothing is written.
    """
    check_new_folder(folder, "FOLDER", "Name a new folder; data files are copied into it.")
    description = load_platform(platform)
    source = Path(platform)
    text, beside = _platform_text(platform), [] if _is_builtin(platform) else list(_files_beside(source, description))
    stated = (folder.resolve().name or "campaign", platform, not _is_builtin(platform), scale)
    draft = draft_of_files(*stated, files, _length(description)) if files else example_draft(*stated)
    _check_names(files, [path for path, _ in beside])
    draft = replace(draft, sizes=_sizes(description))
    with staged(folder) as temporary:
        (temporary / MANIFEST).write_text(campaign_text(draft), encoding="utf-8")
        (temporary / PLATFORM_FILE).write_text(text, encoding="utf-8")
        for relative, path in beside:
            (temporary / relative).parent.mkdir(parents=True, exist_ok=True)
            _copy(path, temporary / relative)
        for file in files:
            _copy(file, temporary / file.name)
    _print(draft, folder)
    return draft


def _is_builtin(platform: str) -> bool:
    return platform.lower() in builtin_platforms()


def _platform_text(platform: str) -> str:
    if _is_builtin(platform):
        return builtin_text(platform.lower())
    return Path(platform).read_bytes().decode("utf-8-sig")


def _files_beside(platform: Path, description: Platform) -> Iterator[tuple[str, Path]]:
    """Files that a platform file names: path relative to it, and where it is."""
    stated = read_yaml(platform, "platform")
    for key, path in description.files().items():
        relative = str(stated[key]["file"])
        if Path(relative).is_absolute():
            continue  # found from anywhere
        if ".." in Path(relative).parts:
            raise InputError(str(platform), [Problem(f"{key}.file", "a file in the folder of the platform file", relative)])
        if not Path(path).is_file():
            raise InputError(
                str(platform), [Problem(f"{key}.file", f"a file in {platform.parent}", f"no such file: {relative}")]
            )
        yield relative, Path(path)


def _length(description: Platform) -> float:
    """Length (m) of a cube of water as heavy as the platform."""
    return float((description.rigid_body.combined()[0] / description.water.density) ** (1 / 3))


def _sizes(description: Platform) -> dict[str, float]:
    """Coefficients of a platform that are not 0: of members, then lumped ones."""
    lumped = {key: getattr(description, key) for key in ("linear_damping", "quadratic_damping", "added_mass")}
    return {
        f"{group}.{name}": float(value)
        for group, coefficients in (description.coefficients | lumped).items()
        for name, value in coefficients.model_dump().items()
        if isinstance(value, float | int) and value
    }


def _check_names(files: Sequence[Path], beside: Sequence[str]) -> None:
    taken = {MANIFEST, PLATFORM_FILE, *(name.lower() for name in beside)}
    if clash := [file for file in files if file.name.lower() in taken]:
        expected = "a name that no file of the campaign has"
        raise InputError("data files", [Problem(str(file), expected, file.name) for file in clash])


def _copy(source: Path, target: Path) -> None:
    try:
        shutil.copyfile(source, target)
    except OSError as error:
        raise InputError(str(source), [Problem("", "a file that can be copied", error.strerror or str(error))]) from None


def _print(draft: CampaignDraft, folder: Path) -> None:
    manifest = folder / MANIFEST
    if not draft.from_files:
        say(f"{folder} is ready for your records.", "bold")
        say(f"1. Put one data file per test into {folder}, such as {', '.join(test.file for test in draft.tests)}.")
        say(f"2. Edit {manifest}: columns, units and tests are examples, marked CHECK.")
        say(f"3. {_about_platform(draft, folder)}")
        say(f"4. Run: jaxhydro check {folder}")
        return
    used = sum(test.use != "ignore" for test in draft.tests)
    say(f"{folder} is made: {used} of {counted(len(draft.tests), 'file')} can be used as guessed.", "bold")
    rows = [_row(test) for test in draft.tests]
    rows = [(*row[:-1], SAME) if i and row[-1] == rows[i - 1][-1] else row for i, row in enumerate(rows)]
    table("What was guessed", ("File", "Kind", "Motion", "Use", "Columns"), rows, left=5)
    if any(guess.unit_by != "file" for test in draft.tests for guess in test.columns.values()):
        say(f"{GUESSED_UNIT}: the file states no unit.")
    if out := sorted({f"{channel} ({guess.column})" for test in draft.tests for channel, guess in test.left_out.items()}):
        say(f"Left out, since angles are beyond 90 deg: {', '.join(out)}.")
    if draft.still is not None:
        say("Taken as still water: {:g} to {:g} s of each file, before the platform is pushed (`zero`).".format(*draft.still))
    say(f"1. Check what is marked CHECK in {manifest}.")
    say(f"2. {_about_platform(draft, folder)}")
    say(f"3. Run: jaxhydro check {folder}")


def _about_platform(draft: CampaignDraft, folder: Path) -> str:
    path = folder / PLATFORM_FILE
    return (
        f"Check {path}: it is a copy of {draft.platform}."
        if draft.own_platform
        else (
            f"Edit {path}: it describes {draft.platform}. Put your platform in, or begin with another (jaxhydro platforms). "
            'A ship in roll needs no members: docs/formats.md, "The smallest platform".'
        )
    )


def _row(test: TestDraft) -> tuple[str, ...]:
    columns = (_column(name, guess) for name, guess in test.columns.items() if name != WAVE or not test.guess.still_wave)
    return test.file, test.guess.kind, test.guess.degree_of_freedom or "-", test.use, "; ".join(columns)


def _column(channel: str, guess: ColumnGuess) -> str:
    name = str(guess.column)
    if guess.unit_by != "file":
        return f"{channel}: {name}, {guess.unit}{GUESSED_UNIT}"
    named = re.search(rf"[^a-z]{guess.unit}[^a-z]*$", name, re.IGNORECASE)
    return f"{channel}: {name}" if named else f"{channel}: {name}, {guess.unit}"
