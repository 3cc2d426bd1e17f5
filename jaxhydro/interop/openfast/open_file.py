"""Opening one of OpenFAST's text files."""

from pathlib import Path

from jaxhydro.errors import InputError, Problem, suggest_path
from jaxhydro.interop.openfast.keyed_file import KeyedFile


def as_spelled(path: Path) -> Path:
    """Path of a file whose name may differ in upper and lower case, as in decks written on Windows.

    Args:
        path: The file, as a deck names it.

    Returns:
        The only file of that name in its folder, whatever its case; `path` itself where it exists or no such file does.
    """
    if path.exists() or not path.parent.is_dir():
        return path
    alike = [entry for entry in path.parent.iterdir() if entry.name.lower() == path.name.lower()]
    return alike[0] if len(alike) == 1 else path


def read_keyed_file(path: Path, description: str) -> KeyedFile:
    """Read one of OpenFAST's files.

    Args:
        path: The file.
        description: What it is, for messages.

    Raises:
        InputError: It cannot be read.
    """
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except FileNotFoundError:
        raise InputError(str(path), [Problem("", description, "no such file", suggest_path(path))]) from None
    except (OSError, ValueError) as error:
        reason = str(getattr(error, "strerror", None) or error)
        raise InputError(str(path), [Problem("", description, reason)]) from None
    if "\x00" in text:
        raise InputError(str(path), [Problem("", description, "binary content")])
    return KeyedFile(path, text.splitlines())
