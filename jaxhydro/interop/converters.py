"""Readers of `jaxhydro convert`, by the ending of the file."""

from collections.abc import Callable
from importlib import import_module
from pathlib import Path

from jaxhydro.errors import InputError, Problem, suggest_path
from jaxhydro.interop.conversion import Conversion

RESULTS = "panel_results.results_folder"
LINES = ("a MoorDyn file", "mooring_source", "read_moordyn")
DESIGN = ("a RAFT design or a MoorPy system", "mooring_source", "read_yaml_model")
READERS = {  # ending -> what it is, module of this folder, its function of a path
    ".fst": ("an OpenFAST main file", "openfast_deck", "read_openfast_deck"),
    ".yaml": DESIGN,
    ".yml": DESIGN,
    ".dat": LINES,
    ".txt": LINES,
    ".cal": ("a Nemoh.cal", RESULTS, "read_nemoh_file"),
    ".nc": ("a dataset of Capytaine", RESULTS, "read_dataset"),
    ".1": ("WAMIT's radiation", RESULTS, "read_table"),
    ".3": ("WAMIT's wave forces", RESULTS, "read_table"),
    ".hst": ("WAMIT's hydrostatics", RESULTS, "read_table"),
}


def convert_file(path: Path, mooring: Path | None = None) -> Conversion:
    """Platform of another program's model.

    Args:
        path: The model's file, whose ending says which program it is of, or the folder of a panel program's results.
        mooring: File of the mooring lines, of MoorDyn or MoorPy, where the model has none.

    Returns:
        The platform. Of a file of mooring lines, its sections `water` and `mooring` alone.

    Raises:
        InputError: No program is known by the ending, or a file is missing or broken.
    """
    if mooring is None:
        return _reader_of(path)(path)
    reader = _reader_of(path)  # a source that is missing is told first
    lines = _function("mooring_file", "read_mooring_file")(mooring)
    conversion = reader(path, lines.system.depth) if reader.__module__.endswith(RESULTS) else reader(path)
    joined: Conversion = _function("mooring_source", "with_mooring")(conversion, lines, str(path))
    return joined


def readable() -> str:
    """What `convert` reads, in words: kinds of files with their endings, and folders."""
    endings: dict[str, list[str]] = {}
    for ending, (kind, _, _) in READERS.items():
        endings.setdefault(kind, []).append(ending)
    kinds = [f"{kind} ({', '.join(group)})" for kind, group in endings.items()]
    return f"{', '.join(kinds)}, or a folder of results"


def _reader_of(path: Path) -> Callable[..., Conversion]:
    if path.is_dir():
        return _function(RESULTS, "read_results_folder")
    suffix = path.suffix.lower()
    if suffix in READERS:
        kind, module, function = READERS[suffix]
        if not path.exists():
            raise InputError(str(path), [Problem("", kind, "no such file", suggest_path(path))])
        return _function(module, function)
    if path.exists() and _function("mooring_file", "is_mooring_text")(path):
        return _function(*LINES[1:])
    found = f"a file that ends in {path.suffix}" if path.suffix else "a name without an ending"
    raise InputError(str(path), [Problem("", readable(), found if path.exists() else f"{found}, and no such file")])


def _function(module: str, name: str) -> Callable:
    """A function of a module of this folder, imported when it is needed."""
    function: Callable = getattr(import_module(f"jaxhydro.interop.{module}"), name)
    return function
