"""Which panel program a file or folder of results is of, and its conversion."""

from pathlib import Path

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.conversion import Conversion
from jaxhydro.interop.mooring_file import is_mooring_text
from jaxhydro.interop.panel_results.capytaine_file import read_capytaine_file
from jaxhydro.interop.panel_results.hams_folder import control_file, read_hams_folder
from jaxhydro.interop.panel_results.nemoh_folder import case_file, read_nemoh_folder
from jaxhydro.interop.panel_results.platform_skeleton import platform_skeleton
from jaxhydro.interop.panel_results.wamit_folder import read_wamit_folder

TABLES = (".1", ".3", ".hst", ".12d")  # of WAMIT and HAMS
MODELS = (".fst", ".yaml", ".yml")  # of other programs, which are named as files
TEXTS = (".dat", ".txt")  # may be MoorDyn's, which is named as a file
EXPECTED = "results of WAMIT (.1, .3), HAMS (ControlFile.in), Nemoh (Nemoh.cal) or Capytaine (.nc)"


def read_results_folder(folder: Path, depth: float | None = None) -> Conversion:
    """Platform of a folder of results.

    Args:
        folder: The folder.
        depth: Of the water where the results state none, m, or None.

    Raises:
        InputError: It holds no results, or several datasets, or they cannot be used.
    """
    files = [path for path in sorted(folder.iterdir()) if path.is_file()]
    if case_file(folder) or (folder.name.lower() == "results" and case_file(folder.parent)):
        return platform_skeleton(read_nemoh_folder(folder), depth)
    if control_file(folder):
        return platform_skeleton(read_hams_folder(folder), depth)
    if any(path.suffix.lower() in TABLES for path in files):
        return platform_skeleton(read_wamit_folder(folder), depth)
    datasets = [path for path in files if path.suffix.lower() == ".nc"]
    if len(datasets) == 1:
        return platform_skeleton(read_capytaine_file(datasets[0]), depth)
    if datasets:
        found = ", ".join(path.name for path in datasets)
        raise InputError(str(folder), [Problem("", "one dataset of Capytaine", found, "Name the file in it.")])
    models = [path.name for path in files if path.suffix.lower() in MODELS]
    models = models or [path.name for path in files if path.suffix.lower() in TEXTS and is_mooring_text(path)]
    hint = "Name the file in it." if models else ""
    raise InputError(str(folder), [Problem("", EXPECTED, ", ".join(models) or "none of their files", hint)])


def read_table(path: Path, depth: float | None = None) -> Conversion:
    """Platform of the tables that share a file's name, in WAMIT's formats.

    Args:
        path: One of the tables.
        depth: Of the water where the results state none, m, or None.

    Raises:
        InputError: They cannot be used.
    """
    read = read_hams_folder if control_file(path.parent) else read_wamit_folder
    return platform_skeleton(read(path.parent, path.stem), depth)


def read_nemoh_file(path: Path, depth: float | None = None) -> Conversion:
    """Platform of the case of a Nemoh.cal.

    Args:
        path: Nemoh.cal.
        depth: Of the water where the results state none, m, or None.

    Raises:
        InputError: It cannot be used.
    """
    return platform_skeleton(read_nemoh_folder(path.parent), depth)


def read_dataset(path: Path, depth: float | None = None) -> Conversion:
    """Platform of a dataset of Capytaine.

    Args:
        path: The dataset.
        depth: Of the water where the results state none, m, or None.

    Raises:
        InputError: It cannot be used.
    """
    return platform_skeleton(read_capytaine_file(path), depth)
