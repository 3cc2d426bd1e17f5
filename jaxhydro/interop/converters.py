"""Readers of `jaxhydro convert`, by the ending of the file."""

from collections.abc import Callable
from importlib import import_module
from pathlib import Path

from jaxhydro.errors import InputError, Problem, suggest_path
from jaxhydro.interop.conversion import Conversion

READERS = {  # ending -> what it is, module of this folder, its function of a path
    ".fst": ("an OpenFAST main file", "openfast_deck", "read_openfast_deck"),
    ".yaml": ("a RAFT design", "raft_design", "read_raft_design"),
    ".yml": ("a RAFT design", "raft_design", "read_raft_design"),
}


def convert_file(path: Path) -> Conversion:
    """Platform of another program's model.

    Args:
        path: The model's file; its ending says which program it is of.

    Raises:
        InputError: No program is known by the ending, or the file is missing or broken.
    """
    expected = ", ".join(f"{kind} ({ending})" for ending, (kind, _, _) in READERS.items())
    if path.is_dir():
        raise InputError(str(path), [Problem("", expected, "a folder", "Name the file in it.")])
    if path.suffix.lower() not in READERS:
        found = f"a file that ends in {path.suffix}" if path.suffix else "a name without an ending"
        raise InputError(str(path), [Problem("", expected, found)])
    if not path.exists():
        raise InputError(str(path), [Problem("", READERS[path.suffix.lower()][0], "no such file", suggest_path(path))])
    _, module, function = READERS[path.suffix.lower()]
    reader: Callable[[Path], Conversion] = getattr(import_module(f"jaxhydro.interop.{module}"), function)
    return reader(path)
