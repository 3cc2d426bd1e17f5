"""Reading of result files, with one line for each mistake."""

import json
from os import PathLike
from pathlib import Path
from typing import TypeVar

from calibration.results.result_folder import DIAGNOSIS_FILE, RESULT_FILE
from jaxhydro.errors import InputError, Problem, suggest_path
from jaxhydro.input_schema import validate
from jaxhydro.result_model import ResultModel

S = TypeVar("S", bound=ResultModel)


def file_of(path: str | PathLike[str]) -> Path:
    """The diagnosis.json or calibration.json of a folder, or the file itself."""
    path = Path(path)
    try:
        return path / (DIAGNOSIS_FILE if (path / DIAGNOSIS_FILE).is_file() else RESULT_FILE) if path.is_dir() else path
    except (OSError, ValueError):
        return path  # reading it says what is wrong


def read_as(kind: type[S], path: str | PathLike[str]) -> S:
    """Read a result file, or the one in a folder, as a given model of its content.

    Raises:
        InputError: The file cannot be read or is invalid; the error lists all faults.
    """
    path = file_of(path)
    try:
        data = json.loads(path.read_bytes().decode("utf-8-sig"))
    except FileNotFoundError:
        missing = "no such file" if path.suffix else "no such folder"
        raise file_error(
            path, f"a {RESULT_FILE}, as `jaxhydro calibrate` writes it", missing, hint=suggest_path(path)
        ) from None
    except (json.JSONDecodeError, RecursionError) as error:
        position = f"line {error.lineno}, column {error.colno}" if isinstance(error, json.JSONDecodeError) else ""
        mistake = f"a mistake in it ({getattr(error, 'msg', 'lists nested too deeply')})"
        raise file_error(path, "valid JSON, as jaxhydro writes it", mistake, position) from None
    except UnicodeDecodeError:
        raise file_error(path, "text in UTF-8", "other bytes") from None
    except (OSError, ValueError) as error:
        raise file_error(path, "a file that can be read", str(getattr(error, "strerror", None) or error)) from None
    if not isinstance(data, dict):
        raise file_error(path, "a mapping of keys to values", type(data).__name__)
    return validate(kind, data, str(path))


def file_error(path: Path, expected: str, found: str, where: str = "", hint: str = "") -> InputError:
    """Error for one fault in a written result."""
    return InputError(str(path), [Problem(where, expected, found, hint)])
