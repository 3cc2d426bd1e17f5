"""Result folders, written whole or not at all."""

import os
import re
import secrets
import shutil
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from jaxhydro.choices import nearest
from jaxhydro.errors import InputError, Problem, suggest_path

MANIFEST = "campaign.yaml"
YAML = (".yaml", ".yml")
REPORT_FILE = "report.html"
GENERATOR = '<meta name="generator" content="jaxhydro'  # in a report of ours


def is_there(path: Path) -> bool:
    """Whether a file or folder exists; False for a name that no file can have."""
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


def embedded_campaigns() -> dict[str, Path]:
    """Folders of the campaigns that come with the package, by name."""
    folder = Path(__file__).parent / "campaigns"
    return {entry.name: entry for entry in sorted(folder.iterdir()) if (entry / MANIFEST).is_file()}


def campaign_file(path: str | os.PathLike[str]) -> Path:
    """Path of a campaign's campaign.yaml.

    Args:
        path: The campaign's folder, the file itself, or the name of an embedded campaign.

    Raises:
        InputError: The folder or file does not exist, or the folder has no campaign.yaml.
    """
    path = Path(path)
    expected = f"a campaign's folder, or its {MANIFEST}"
    if not is_there(path) and (embedded := embedded_campaigns().get(str(path))) is not None:
        return embedded / MANIFEST
    if not is_there(path):
        found = "no such file" if path.suffix in YAML else "no such folder"
        raise InputError(str(path), [Problem("", expected, found, suggest_path(path))])
    if not path.is_dir():
        return path
    if not (path / MANIFEST).is_file():
        others = {file.stem: file.name for file in path.iterdir() if file.suffix in YAML}
        near = nearest(Path(MANIFEST).stem, others)
        data = path / "*.csv" if any(path.glob("*.csv")) else "DATA_FILES"
        make = f"`jaxhydro init NEW_FOLDER {data}` makes one."
        hint = f"Did you mean '{path / others[near]}'?" if near else make
        raise InputError(str(path), [Problem("", expected, f"a folder without {MANIFEST}", hint)])
    return path / MANIFEST


def check_folder(folder: str | os.PathLike[str], option: str = "--out") -> Path:
    """Path of a folder into which results can be written; nothing is left behind.

    Raises:
        InputError: It is a file, or cannot be made or written; `option` is named.
    """
    folder = Path(folder)
    try:
        if os.path.lexists(folder) and not folder.is_dir():
            raise InputError(option, [Problem("", "a folder", f"{str(folder)!r}, which is a file")])
        trial = _beside(folder)
        trial.mkdir()
        # a name that the file system does not take shows here, before the work
        made = trial / (folder.resolve().name or "x")
        made.mkdir()
        made.rmdir()
        trial.rmdir()
    except (OSError, ValueError) as error:
        raise _unwritable(folder, error, option) from None
    return folder


def check_new_folder(folder: Path, option: str, hint: str) -> None:
    """Raise InputError where a folder is not empty, is a file, or cannot be made; `option` is named."""
    check_folder(folder, option)
    if is_there(folder) and any(folder.iterdir()):
        raise InputError(str(folder), [Problem("", "a folder that is new or empty", "a folder that is not empty", hint)])


@contextmanager
def staged(folder: Path, obsolete: Callable[[Path], Iterable[str]] | None = None) -> Iterator[Path]:
    """Temporary folder whose files are moved into `folder` when the block ends well.

    Otherwise `folder` stays as it is. Files of the same names are replaced. Files that `obsolete(temporary)` names are
    removed; all others stay.

    Raises:
        InputError: The files cannot be moved into place.
    """
    try:
        temporary = _beside(folder)
        temporary.mkdir()
    except OSError as error:
        raise _unwritable(folder, error) from None
    try:
        yield temporary
        stale = list(obsolete(temporary)) if obsolete else []
        try:
            _place(temporary, folder, stale)
        except OSError as error:
            raise _unwritable(folder, error) from None
    finally:
        shutil.rmtree(temporary, ignore_errors=True)


def write_whole(path: Path, text: str) -> None:
    """Write a text file (UTF-8), whole or not at all.

    Raises:
        InputError: It cannot be written.
    """
    with staged(path.parent) as temporary:
        (temporary / path.name).write_text(text, encoding="utf-8")


def own_report(path: Path) -> bool:
    """Whether a file is a report that jaxhydro made."""
    if not path.is_file():
        return False
    with path.open(encoding="utf-8", errors="replace") as file:
        return GENERATOR in file.read(1000)


def safe_name(name: str) -> str:
    """A user's name as part of a file name."""
    return re.sub(r"[^\w+=., ()@-]", "_", name)[:100] or "_"


def _beside(folder: Path) -> Path:
    """New name on the file system of `folder`, in it or in its nearest existing ancestor."""
    ancestor = folder.absolute()
    while not ancestor.exists():
        ancestor = ancestor.parent
    if not ancestor.is_dir():
        raise NotADirectoryError(20, f"{str(ancestor)!r} is a file")
    return ancestor / f".jaxhydro-{secrets.token_hex(6)}"


def _place(temporary: Path, folder: Path, stale: list[str]) -> None:
    if not folder.exists():
        folder.parent.mkdir(parents=True, exist_ok=True)
        os.rename(temporary, folder)
        return
    new = [path.relative_to(temporary) for path in sorted(temporary.rglob("*")) if path.is_file()]
    for name in new:
        if (folder / name).is_dir():
            raise IsADirectoryError(21, f"{name} is a folder there")
    old = _beside(folder)
    old.mkdir()
    undo: list[tuple[Path, Path]] = []

    def move(source: Path, target: Path) -> None:
        target.parent.mkdir(parents=True, exist_ok=True)
        os.replace(source, target)
        undo.append((target, source))

    try:
        for name in (*new, *(Path(name) for name in stale if Path(name) not in new)):
            if os.path.lexists(folder / name):
                move(folder / name, old / name)
            if name in new:
                move(temporary / name, folder / name)
    except BaseException:
        for target, source in reversed(undo):
            os.replace(target, source)
        raise
    finally:
        shutil.rmtree(old, ignore_errors=True)


def _unwritable(folder: Path, error: Exception, option: str = "") -> InputError:
    reason = str(getattr(error, "strerror", None) or error)
    found = f"{str(folder)!r}, which cannot be ({reason})"
    return InputError(option or "results", [Problem("", "a folder that can be written", found)])
