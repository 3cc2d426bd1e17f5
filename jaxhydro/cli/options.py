"""Checks of command-line options; errors name the option."""

import itertools
import math
from pathlib import Path

import typer

from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError, Problem, suggest, suggest_path
from jaxhydro.files import MANIFEST, YAML, check_folder, embedded_campaigns, is_there
from jaxhydro.platform.schema import builtin_platforms

MAX_STEPS = 5_000_000  # samples or steps of one simulation


def wrong(option: str, message: str) -> typer.BadParameter:
    """The error of an option."""
    return typer.BadParameter(message, param_hint=option)


def positive(value: float, option: str, key: str = "") -> float:
    """A finite number > 0.

    Args:
        value: The number.
        option: The option.
        key: Words before the message, such as `hs: `.

    Raises:
        BadParameter: It is none.
    """
    if not (math.isfinite(value) and value > 0):
        raise wrong(option, f"{key}a number > 0 expected, found {value:g}")
    return value


def finite(value: float, option: str) -> float:
    """A finite number."""
    if not math.isfinite(value):
        raise wrong(option, f"a finite number expected, found {value:g}")
    return value


def interval(value: float, option: str, duration: float) -> float:
    """A time step that divides a duration into a number of steps that fits into memory."""
    if not 1 <= duration / positive(value, option) <= MAX_STEPS:
        limits = f"from {duration / MAX_STEPS:g} to {duration:g} s expected, for a duration of {duration:g} s"
        raise wrong(option, f"{limits}; found {value:g}")
    return value


def regular(height: float | None, period: float | None) -> tuple[float, float] | None:
    """Height (m) and period (s) of regular waves, or None."""
    if height is None and period is None:
        return None
    if height is None or period is None:
        raise wrong("--wave-height", "--wave-height and --wave-period belong together")
    return positive(height, "--wave-height"), positive(period, "--wave-period")


def by_motion(texts: list[str], option: str, meaning: str) -> dict[str, float]:
    """Numbers by motion, of texts such as `surge=5`.

    Args:
        texts: Values of the option.
        option: The option, for messages.
        meaning: Meaning of the number, with an example: "its offset expected, as surge=5".
    """
    values: dict[str, float] = {}
    for text in texts:
        name, _, number = (part.strip() for part in text.partition("="))
        if name not in DOFS:
            expected = f"a motion ({', '.join(DOFS)}) and {meaning}"
            raise wrong(option, f"{expected}; found {text!r}. {suggest(name, DOFS)}".strip())
        try:
            value = float(number)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise wrong(option, f"a number after {name}= expected, found {number!r}")
        if name in values:
            raise wrong(option, f"{name} is given twice")
        values[name] = value
    return values


def releases(texts: list[str], option: str = "--release") -> dict[str, float]:
    """Offsets by motion (m, rad) of `surge=5` and the like (m, deg)."""
    offsets = by_motion(texts, option, "its offset expected, as surge=5")
    for name, value in offsets.items():
        if name in ("roll", "pitch") and abs(value) >= 90:
            raise wrong(option, f"less than 90 deg expected, found {name}={value:g}")
    return {name: math.radians(value) if name in DOFS[3:] else value for name, value in offsets.items()}


RESULTS = {  # file of results: how folders with it are called, and what it is of
    "motion.csv": ("simulation", "a simulation"),
    "calibration.json": ("calibration", "a calibration"),
    "diagnosis.json": ("diagnosis", "a diagnosis"),
    "comparison.json": ("seas", "a campaign's seas"),
    "uncertainty.json": ("uncertainty", "an uncertainty"),
    "sweep.json": ("sweep", "a sweep"),
}


def new_folder(source: str | Path, result_file: str) -> Path:
    """Folder in the working folder for a command without `--out`.

    It is called after what is computed, such as my-campaign-calibration. If there are such results already, it gets a number:
    nothing is overwritten. A job that was stopped has no results yet, and goes on in its folder.

    Args:
        source: Input of the command: a campaign's folder or file, a platform, a sweep file.
        result_file: File of results that the command writes last.
    """
    path = Path(source)
    named = path.parent if path.name in ("campaign.yaml", "platform.yaml") else path
    name = f"{named.resolve().name.removesuffix('.yaml')}-{RESULTS[result_file][0]}"
    candidates = (name if i == 1 else f"{name}-{i}" for i in itertools.count(1))
    return next(Path(candidate) for candidate in candidates if not (Path(candidate) / result_file).exists())


def results_folder(out: Path | None, result_file: str, source: str | Path) -> Path:
    """Folder that can be written and has no results of another command.

    Some files of different commands have the same name: those of the other command would be lost.

    Args:
        out: The folder; None: a new one.
        result_file: File of results that the command writes.
        source: Input of the command.

    Raises:
        InputError: The folder cannot be written, or has results of another command.
    """
    out = check_folder(new_folder(source, result_file) if out is None else out)
    for name, (_, computation) in RESULTS.items():
        # a motion.csv may be anybody's
        ours = (out / name).exists() and (name != "motion.csv" or (out / "simulated.nc").exists())
        if name != result_file and ours:
            raise InputError("--out", [Problem("", "another folder", f"{str(out)!r}, which has the results of {computation}")])
    return out


def platforms_like(incomplete: str) -> list[str]:
    """Built-in platforms whose names begin so, for the shell to complete.

    Where there is none, the shell completes names of files.
    """
    return [name for name in builtin_platforms() if name.startswith(incomplete)]


def check_platform(name: str, or_campaign: bool = False) -> None:
    """Raise InputError where a platform's argument is neither a built-in name nor a file.

    The contents of a file are not checked.

    Args:
        name: The argument.
        or_campaign: Whether the command takes a campaign's folder too.
    """
    builtin = builtin_platforms()
    if name.lower() in builtin or is_there(Path(name)) or Path(name).suffix in YAML:
        return
    file, known = "a platform file", f"a built-in platform ({', '.join(builtin)})"
    expected = f"{file}, {known}, or a campaign's folder" if or_campaign else f"{file} or {known}"
    raise InputError(name, [Problem("", expected, "no such file or folder", suggest(name, builtin) or suggest_path(name))])


def is_campaign(name: str) -> bool:
    """Whether the first argument is a campaign, not a platform."""
    return Path(name).is_dir() or Path(name).name == MANIFEST or name in embedded_campaigns()


def platform_of(name: str) -> str:
    """The platform that an argument names: a built-in name, a platform file, or that of a campaign.

    Args:
        name: The argument: a platform, or a campaign's folder or file.

    Raises:
        InputError: There is no such platform or campaign, or the campaign's file has mistakes.
    """
    if not is_campaign(name):
        check_platform(name, or_campaign=True)
        return name
    from calibration.campaign.manifest import platform_source, read_manifest

    return platform_source(*read_manifest(name))


def check_results(folder: Path) -> None:
    """Raise InputError where a folder of results does not exist."""
    if not is_there(folder):
        expected = "a folder that `jaxhydro simulate`, `calibrate`, `diagnose`, `uncertainty` or `sweep` wrote"
        raise InputError(str(folder), [Problem("", expected, "no such folder", suggest_path(folder))])
