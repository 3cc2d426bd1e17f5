"""Opening one of OpenFAST's text files."""

from pathlib import Path

from jaxhydro.errors import InputError, Problem, suggest_path
from jaxhydro.interop.openfast.keyed_file import KeyedFile


def read_keyed_file(path: Path, what: str) -> KeyedFile:
    """Read one of OpenFAST's files.

    Args:
        path: The file.
        what: What it is, for messages.

    Raises:
        InputError: It cannot be read.
    """
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except FileNotFoundError:
        raise InputError(str(path), [Problem("", what, "no such file", suggest_path(path))]) from None
    except (OSError, ValueError) as error:
        said = str(getattr(error, "strerror", None) or error)
        raise InputError(str(path), [Problem("", what, said)]) from None
    if "\x00" in text:
        raise InputError(str(path), [Problem("", what, "binary content")])
    return KeyedFile(path, text.splitlines())
