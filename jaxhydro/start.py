"""How a process that computes sets JAX up: the command line and the workers of a sweep."""

import os
from importlib.metadata import version
from pathlib import Path

# XLA's newer emitters take twice as long to compile these programs for a CPU, and the programs are no faster
QUICK = "--xla_cpu_use_fusion_emitters=false"
KNOWN = ("0.10.",)  # versions of jaxlib that have this option: one that XLA does not know ends the process


def quick_compilation() -> None:
    """Ask XLA for what compiles soonest, before its first compilation. What XLA_FLAGS says of it already stays."""
    flags = os.environ.get("XLA_FLAGS", "")
    if version("jaxlib").startswith(KNOWN) and "xla_cpu_use_fusion_emitters" not in flags:
        os.environ["XLA_FLAGS"] = f"{flags} {QUICK}".strip()


def start() -> None:
    """Double precision, quick compilation, and a compilation cache that lasts, unless its folder cannot be written."""
    quick_compilation()
    import jax

    jax.config.update("jax_enable_x64", True)
    home = os.environ.get("XDG_CACHE_HOME") or Path("~/.cache")
    try:
        default = Path(home).expanduser() / "jaxhydro" / "xla"
        folder = Path(os.environ.get("JAX_COMPILATION_CACHE_DIR") or default)
        folder.mkdir(parents=True, exist_ok=True)
    except (OSError, RuntimeError):
        return
    if os.access(folder, os.W_OK):
        jax.config.update("jax_compilation_cache_dir", str(folder))
        jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
        jax.config.update("jax_persistent_cache_min_entry_size_bytes", -1)
