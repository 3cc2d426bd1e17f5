"""JAX settings at import: float64, quick compilation, compilation cache on disk."""

import os
from pathlib import Path
from typing import Any

# XLA's newer emitters take twice as long to compile these programs for a CPU, and the programs are no faster
QUICK = "--xla_cpu_use_fusion_emitters=false"
KNOWN = ("0.10.",)  # versions of jaxlib that have this option: one that XLA does not know ends the process
X64, CACHE = "JAXHYDRO_X64", "JAXHYDRO_COMPILATION_CACHE"  # environment variables that switch a step off
OFF = ("0", "false", "off", "no")
LEAST_TIME, LEAST_SIZE = "jax_persistent_cache_min_compile_time_secs", "jax_persistent_cache_min_entry_size_bytes"
UNTOUCHED = {LEAST_TIME: 1.0, LEAST_SIZE: 0}  # JAX's defaults, which keep short compilations out of the cache
EVERYTHING = {LEAST_TIME: 0.0, LEAST_SIZE: -1}


class Float64Error(RuntimeError):
    """A model was requested while JAX computes in float32."""


def quick_compilation() -> None:
    """Ask XLA for its quicker CPU compiler, by XLA_FLAGS. A choice that XLA_FLAGS has already stays.

    It has no effect once JAX has compiled a program.
    """
    import jaxlib

    flags = os.environ.get("XLA_FLAGS", "")
    if jaxlib.__version__.startswith(KNOWN) and "xla_cpu_use_fusion_emitters" not in flags:
        os.environ["XLA_FLAGS"] = f"{flags} {QUICK}".strip()


def start() -> None:
    """Switch on float64, quick compilation and the compilation cache. `import jaxhydro` calls it.

    A setting that the user made before has precedence: JAX's own environment variables, and the cache's settings in
    `jax.config`. JAXHYDRO_X64=0 leaves the precision alone, JAXHYDRO_COMPILATION_CACHE=0 the cache.
    """
    quick_compilation()
    import jax

    if not _off(X64) and "JAX_ENABLE_X64" not in os.environ:
        jax.config.update("jax_enable_x64", True)
    if not _off(CACHE):
        _keep_programs()


def need_float64() -> None:
    """Raise Float64Error unless JAX computes in float64."""
    if not _setting("jax_enable_x64"):
        ways = "Remove JAX_ENABLE_X64=0 and JAXHYDRO_X64=0 from the environment"
        raise Float64Error(f"jaxhydro needs float64. {ways}, or call jax.config.update('jax_enable_x64', True).")


def _setting(name: str) -> Any:
    """A setting of JAX as it is now, `with jax.enable_x64(True)` too."""
    import jax

    return getattr(jax.config, name)


def _off(variable: str) -> bool:
    return os.environ.get(variable, "").strip().lower() in OFF


def _keep_programs() -> None:
    """Keep compiled programs on disk, unless their folder cannot be written.

    It is the folder of JAX's own setting, else `jaxhydro/xla` in the user's cache folder (~/.cache).
    """
    import jax

    if not _setting("jax_enable_compilation_cache"):
        return
    if not _setting("jax_compilation_cache_dir"):
        home = os.environ.get("XDG_CACHE_HOME") or "~/.cache"
        try:
            # JAX reads the variable itself, but only when it is imported
            chosen = os.environ.get("JAX_COMPILATION_CACHE_DIR")
            folder = Path(chosen or Path(home).expanduser() / "jaxhydro" / "xla")
            folder.mkdir(parents=True, exist_ok=True)
        except (OSError, RuntimeError):  # RuntimeError: there is no home folder
            return
        if not os.access(folder, os.W_OK | os.X_OK):
            return
        jax.config.update("jax_compilation_cache_dir", str(folder))
    for setting, value in EVERYTHING.items():
        if setting.upper() not in os.environ and _setting(setting) == UNTOUCHED[setting]:
            jax.config.update(setting, value)
