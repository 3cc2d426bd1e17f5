"""Readers of `jaxhydro convert`, by the ending of the file."""

from collections.abc import Callable
from importlib import import_module
from pathlib import Path

from jaxhydro.errors import InputError, Problem, suggest_path
from jaxhydro.interop.conversion import Conversion

RESULTS = "panel_results.results_folder"
READERS = {  # ending -> what it is, module of this folder, its function of a path
    ".fst": ("an OpenFAST main file", "openfast_deck", "read_openfast_deck"),
    ".yaml": ("a RAFT design", "raft_design", "read_raft_design"),
    ".yml": ("a RAFT design", "raft_design", "read_raft_design"),
    ".cal": ("a Nemoh.cal", RESULTS, "read_nemoh_file"),
    ".nc": ("a dataset of Capytaine", RESULTS, "read_dataset"),
    ".1": ("WAMIT's radiation", RESULTS, "read_table"),
    ".3": ("WAMIT's wave forces", RESULTS, "read_table"),
    ".hst": ("WAMIT's hydrostatics", RESULTS, "read_table"),
}


def convert_file(path: Path) -> Conversion:
    """Platform of another program's model.

    Args:
        path: The model's file, whose ending says which program it is of, or the folder of a panel program's results.

    Raises:
        InputError: No program is known by the ending, or the file is missing or broken.
    """
    expected = ", ".join(f"{kind} ({ending})" for ending, (kind, _, _) in READERS.items())
    if path.is_dir():
        return _reader(RESULTS, "read_results_folder")(path)
    if path.suffix.lower() not in READERS:
        found = f"a file that ends in {path.suffix}" if path.suffix else "a name without an ending"
        raise InputError(str(path), [Problem("", expected, found)])
    if not path.exists():
        raise InputError(str(path), [Problem("", READERS[path.suffix.lower()][0], "no such file", suggest_path(path))])
    _, module, function = READERS[path.suffix.lower()]
    return _reader(module, function)(path)


def _reader(module: str, function: str) -> Callable[[Path], Conversion]:
    """A function of a module of this folder, imported when it is needed."""
    reader: Callable[[Path], Conversion] = getattr(import_module(f"jaxhydro.interop.{module}"), function)
    return reader
