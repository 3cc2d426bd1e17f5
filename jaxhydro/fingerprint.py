"""Hash of the inputs and programs of a result, compared before earlier results are resumed."""

import dataclasses
import functools
import hashlib
import inspect
import sys
from collections.abc import Callable, Iterator, Mapping, Set
from enum import Enum
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path, PurePath
from types import CodeType
from typing import Any

import numpy as np

PACKAGES = ("jaxhydro", "calibration")
NO_FILE = "no file"
LIBRARIES = ("jaxhydro", "jax", "jaxlib", "numpy", "scipy", "equinox", "diffrax", "optimistix", "lineax")


@functools.cache  # as imported: what is changed on disk later is not what computes
def sources() -> str:
    """Hash of all Python files of both packages, with their names."""
    digest = hashlib.sha256()
    for name in PACKAGES:
        spec = find_spec(name)
        for folder in map(Path, (spec and spec.submodule_search_locations) or ()):
            for path in sorted(folder.rglob("*.py")):
                digest.update(f"{name}/{path.relative_to(folder).as_posix()}\0".encode() + path.read_bytes() + b"\0")
    return digest.hexdigest()


def computed_with() -> dict[str, str]:
    """Hash of the packages' sources, versions of Python and the libraries, and precision."""
    import jax

    versions = {"source code": sources(), "Python": f"{sys.version_info.major}.{sys.version_info.minor}"}
    for name in LIBRARIES:
        try:
            versions[name] = version(name)
        except PackageNotFoundError:
            versions[name] = "none"
    return versions | {"precision": "float64" if jax.config.jax_enable_x64 else "float32"}  # type: ignore[attr-defined]


def fingerprint(*inputs: Any) -> str:
    """Hash of `computed_with` and of inputs, as in `content_hash`."""
    return content_hash(computed_with(), *inputs)


def content_hash(*inputs: Any) -> str:
    """Hash of numbers, text, arrays, files, and what is made of them.

    A path stands for the content of its file, wherever that is. Of classes and functions that are not the packages' own the
    source is taken, too. Raises TypeError for what has no content that can be told.
    """
    digest, source_files = _digest(inputs)
    for path in source_files:
        if path != NO_FILE:
            digest.update(Path(path).read_bytes() + b"\0")
    return digest.hexdigest()


def installed_content_hash(*inputs: Any) -> str:
    """`content_hash` of what the packages and installed libraries alone define.

    Raises TypeError where a class or function is a user's own: in a running process it may be older than its file.
    """
    digest, source_files = _digest(inputs)
    if source_files:
        raise TypeError(f"a class or function is defined in {', '.join(source_files)}")
    return digest.hexdigest()


def _digest(inputs: tuple[Any, ...]) -> "tuple[hashlib._Hash, dict[str, None]]":
    """Digest of inputs, and the files that classes and functions of a user's own are written in."""
    digest, source_files = hashlib.sha256(), dict[str, None]()
    for part in _content(inputs, source_files, ()):
        digest.update(part + b"\0")
    return digest, source_files


def _content(value: Any, source_files: dict[str, None], within: tuple[int, ...]) -> Iterator[bytes]:
    """The content of a value, piece by piece.

    Args:
        value: The value.
        source_files: Takes the files that classes and functions from elsewhere are written in.
        within: Ids of what holds the value.
    """
    if value is None or type(value) in (bool, int, float, complex, str, bytes):
        yield f"{type(value).__name__} {value!r}".encode()
        return
    if id(value) in within:
        yield b"itself"
        return
    within = (*within, id(value))
    yield _named(type(value), source_files)
    if isinstance(value, PurePath):
        yield Path(value).read_bytes() if Path(value).is_file() else b"no file"
    elif isinstance(value, np.ndarray | np.generic) or _is_array(value):
        array = np.asarray(value)
        yield f"{array.dtype.str} {array.shape}".encode()
        if array.dtype == object:
            yield from _content(array.tolist(), source_files, within)
        else:
            yield np.ascontiguousarray(array).tobytes()
    elif isinstance(value, Enum | np.dtype | slice | int | float | complex | str | bytes):
        yield repr(value).encode()
    elif isinstance(value, Mapping):
        for key, item in value.items():
            yield from _content(key, source_files, within)
            yield from _content(item, source_files, within)
    elif isinstance(value, list | tuple):
        for item in value:
            yield from _content(item, source_files, within)
    elif isinstance(value, Set):
        yield from sorted(b"\1".join(_content(item, source_files, within)) for item in value)
    elif isinstance(value, functools.partial):
        yield from _content((value.func, value.args, value.keywords), source_files, within)
    elif isinstance(value, type):
        yield _named(value, source_files)
    elif inspect.ismethod(value):
        yield from _content((value.__func__, value.__self__), source_files, within)
    elif inspect.isroutine(value) or inspect.isfunction(inspect.unwrap(value) if callable(value) else value):
        yield from _of_function(value, source_files, within)
    elif dataclasses.is_dataclass(value):
        yield from _content({f.name: getattr(value, f.name, None) for f in dataclasses.fields(value)}, source_files, within)
    elif hasattr(value, "__dict__"):
        yield from _content(vars(value), source_files, within)
    else:
        raise TypeError(f"the content of {type(value).__qualname__} cannot be told: {value!r:.80}")


def _is_array(value: Any) -> bool:
    import jax

    return isinstance(value, jax.Array)


def _of_function(value: Callable[..., Any], source_files: dict[str, None], within: tuple[int, ...]) -> Iterator[bytes]:
    """A function by its name, its source where that is not the packages', and what it remembers."""
    inner = inspect.unwrap(value)
    yield _named(inner, source_files)
    if (code := getattr(inner, "__code__", None)) is not None:
        yield from _code(code)
        for cell in getattr(inner, "__closure__", None) or ():
            yield from _content(cell.cell_contents, source_files, within)
        yield from _content((inner.__defaults__, inner.__kwdefaults__), source_files, within)


def _code(code: CodeType) -> Iterator[bytes]:
    """What a function does, comments and line numbers aside."""
    yield code.co_code + repr(code.co_names).encode()
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _code(constant)
        else:
            yield repr(sorted(constant, key=repr) if isinstance(constant, frozenset) else constant).encode()


def _named(definition: Any, source_files: dict[str, None]) -> bytes:
    """Name of a class or function.

    Its file is noted in `source_files` where it is neither a library's nor the packages' own.
    """
    module = str(getattr(definition, "__module__", "") or "")
    root = module.split(".")[0]
    if root not in PACKAGES and root not in sys.stdlib_module_names:
        try:
            file = inspect.getsourcefile(definition)
        except (TypeError, OSError):  # OSError: of a notebook or a console
            file = None
        if file and "site-packages" not in Path(file).parts and Path(file).is_file():
            source_files[file] = None
        elif root == "__main__" or not getattr(sys.modules.get(module), "__file__", None):  # of a notebook, or a console
            source_files[NO_FILE] = None
    return f"{module}.{getattr(definition, '__qualname__', definition)}".encode()
