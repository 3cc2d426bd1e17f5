"""Programs that later processes load instead of tracing them again.

Python's part of a compilation (tracing and lowering) takes longer than loading the compiled program from JAX's cache. Here
the lowered program is kept too, in the folder `exported` of that cache. A program is found by a hash of the function, the
sources of both packages, the libraries' versions, and all arguments, of arrays their type and shape only.
"""

import hashlib
import importlib
import json
import os
import tempfile
from collections.abc import Callable, Hashable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from functools import wraps
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import equinox as eqx
import jax
import jax.numpy as jnp

from jaxhydro.fingerprint import PACKAGES, computed_with, installed_content_hash

FOLDER, SUFFIX = "exported", ".program"
ARRAY = {"array": None}
OWNERS = (*PACKAGES, "optimistix")  # packages whose modules and named tuples a result may have
P = ParamSpec("P")
R = TypeVar("R")

switched_on = True  # tests that replace functions switch it off: the program of a replaced function would be taken


def exported_jit(fun: Callable[P, R], compiler_options: Mapping[str, Any] | None = None) -> Callable[P, R]:
    """`equinox.filter_jit` whose programs later processes load.

    It is `equinox.filter_jit` and nothing more in these cases:

    - within another program that is traced
    - on other devices than CPUs, and without JAX's compilation cache
    - with an argument of a user's own class: that may have changed since its file was read
    - for programs that JAX cannot export, and results of classes from elsewhere

    Args:
        fun: The function, of a module.
        compiler_options: Options of XLA. Within another program, that one's hold.
    """
    plain: Callable[P, R] = eqx.filter_jit(fun)
    alone: Callable[P, R] = eqx.filter_jit(fun, compiler_options=compiler_options) if compiler_options else plain  # type: ignore[call-overload]
    programs: dict[Hashable, Callable[..., Any] | None] = {}  # None: it cannot be kept

    @wraps(fun)
    def call(*args: P.args, **kwargs: P.kwargs) -> R:
        leaves, structure = jax.tree.flatten((args, kwargs))
        fresh = jnp.zeros(())  # a tracer where a program is traced
        if any(isinstance(leaf, jax.core.Tracer) for leaf in (fresh, *leaves)):
            return plain(*args, **kwargs)
        if (folder := _folder()) is None:
            return alone(*args, **kwargs)
        key = (structure, *(jax.typeof(leaf) if eqx.is_array(leaf) else (type(leaf), leaf) for leaf in leaves))
        if key not in programs:
            programs[key] = _program(fun, (args, kwargs), folder, compiler_options or {})
        program = programs[key]
        if program is None:
            return alone(*args, **kwargs)
        result: R = program(*(leaf for leaf in leaves if eqx.is_array(leaf)))
        return result

    return call


def _folder() -> Path | None:
    """Folder of the programs; None where they are not kept."""
    folder: str | None = jax.config.jax_compilation_cache_dir  # type: ignore[attr-defined]
    kept = switched_on and folder and jax.config.jax_enable_compilation_cache  # type: ignore[attr-defined]
    plain = jax.config.jax_disable_jit or jax.config.jax_debug_nans  # type: ignore[attr-defined]
    return Path(folder) / FOLDER if folder and kept and not plain and jax.default_backend() == "cpu" else None


def _program(fun: Callable[..., Any], arguments: Any, folder: Path, options: Mapping[str, Any]) -> Callable[..., Any] | None:
    """Program of the arrays among some arguments, from the folder or made and kept there; None where that cannot be."""
    shapes = jax.tree.map(lambda leaf: f"array {jax.typeof(leaf)}" if eqx.is_array(leaf) else leaf, arguments)
    precision = jax.config.jax_default_matmul_precision  # type: ignore[attr-defined]
    try:
        path = folder / (installed_content_hash(computed_with(), fun, shapes, precision) + SUFFIX)
    except TypeError:  # of an argument that is of a user's own class, or has no content that can be told
        return None
    try:
        if (kept := _read(path)) is None:
            kept = _export(fun, arguments)
            _write(path, *kept)
    except (_NotKeptError, NotImplementedError, ValueError):
        return None  # JAX cannot export callbacks and some libraries' calls; an error of the function itself comes again
    result, content = kept
    exported = jax.export.deserialize(bytearray(content))  # of a new program, too: its results' types are slightly others

    def run(*arrays: jax.Array) -> list[jax.Array]:
        return exported.call(*arrays)  # type: ignore[no-any-return]

    run.__name__ = exported.fun_name
    compiled = jax.jit(run, compiler_options=dict(options))
    return lambda *arrays: _filled(result, iter(compiled(*arrays)))


class _NotKeptError(Exception):
    """A result is of a class from elsewhere."""


def _export(fun: Callable[..., Any], arguments: Any) -> tuple[Any, bytes]:
    """A function traced and lowered for some arguments: description of its result, and the program of arrays."""
    leaves, structure = jax.tree.flatten(arguments)
    described: list[Any] = []

    def of_arrays(*arrays: jax.Array) -> list[jax.Array]:
        left = iter(arrays)
        args, kwargs = jax.tree.unflatten(structure, [next(left) if eqx.is_array(leaf) else leaf for leaf in leaves])
        results: list[jax.Array] = []
        described.append(_described(fun(*args, **kwargs), results))
        return results

    of_arrays.__name__ = getattr(fun, "__name__", "program")
    program = jax.export.export(jax.jit(of_arrays))(*(leaf for leaf in leaves if eqx.is_array(leaf)))
    return described[-1], bytes(program.serialize())


def _described(value: Any, arrays: list[jax.Array]) -> Any:
    """A result as JSON, its arrays appended to a list."""
    if value is None or type(value) in (bool, int, float, str):
        return {"value": value}
    if eqx.is_array(value):
        arrays.append(value)
        return ARRAY
    if type(value) in (tuple, list):
        return {type(value).__name__: [_described(item, arrays) for item in value]}
    if type(value) is dict and all(isinstance(name, str) for name in value):
        return {"dict": [[name, _described(value[name], arrays)] for name in value]}
    kind = type(value)
    if kind.__module__.split(".")[0] in OWNERS and "<" not in kind.__qualname__:
        name = f"{kind.__module__}:{kind.__qualname__}"
        if isinstance(value, tuple):
            return {"named tuple": name, "items": [_described(item, arrays) for item in value]}
        if is_dataclass(value):
            return {"module": name, "fields": [[f.name, _described(getattr(value, f.name), arrays)] for f in fields(value)]}
    raise _NotKeptError


def _filled(described: Any, arrays: Iterator[jax.Array]) -> Any:
    """A result of its description and arrays."""
    if described == ARRAY:
        return next(arrays)
    if "value" in described:
        return described["value"]
    if "tuple" in described:
        return tuple(_filled(item, arrays) for item in described["tuple"])
    if "list" in described:
        return [_filled(item, arrays) for item in described["list"]]
    if "dict" in described:
        return {name: _filled(item, arrays) for name, item in described["dict"]}
    if "named tuple" in described:
        return _class(described["named tuple"])(*(_filled(item, arrays) for item in described["items"]))
    made: Any = object.__new__(_class(described["module"]))
    for name, item in described["fields"]:
        object.__setattr__(made, name, _filled(item, arrays))
    return made


def _class(name: str) -> type:
    """A class of `OWNERS` by its module and name."""
    module, _, qualname = name.partition(":")
    owner: Any = importlib.import_module(module)
    for part in qualname.split("."):
        owner = getattr(owner, part)
    return owner  # type: ignore[no-any-return]


def _read(path: Path) -> tuple[Any, bytes] | None:
    """What is kept in a file; None where there is none, or none that can be read."""
    try:
        checksum, described, program = path.read_bytes().split(b"\n", 2)
    except (OSError, ValueError):
        return None
    if checksum != _checksum(described + program):
        return None
    return json.loads(described), program


def _write(path: Path, described: Any, program: bytes) -> None:
    """Keep a program, unless the folder cannot be written."""
    text = json.dumps(described).encode()
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        file = tempfile.NamedTemporaryFile(dir=path.parent, delete=False)  # noqa: SIM115
    except OSError:
        return
    try:
        with file:
            file.write(b"\n".join([_checksum(text + program), text, program]))
        os.replace(file.name, path)
    except OSError:
        Path(file.name).unlink(missing_ok=True)


def _checksum(content: bytes) -> bytes:
    return hashlib.sha256(content).hexdigest().encode()
