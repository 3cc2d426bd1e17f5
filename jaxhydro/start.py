"""How a process that computes sets JAX up: the command line and the workers of a sweep."""

import os
from pathlib import Path


def start() -> None:
    """Double precision, and a compilation cache that lasts, unless its folder cannot be written."""
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
