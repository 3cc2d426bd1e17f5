"""Every test runs in float64, with compiled programs kept between runs where JAX_COMPILATION_CACHE_DIR says so."""

import os
import sys
from pathlib import Path

import jax

# so that `benchmarks` and the tests' own helpers are found however pytest is started
for folder in (Path(__file__).resolve().parents[1], Path(__file__).resolve().parent):
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))

jax.config.update("jax_enable_x64", True)
if folder_of_cache := os.environ.get("JAX_COMPILATION_CACHE_DIR"):
    jax.config.update("jax_compilation_cache_dir", folder_of_cache)
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.2)
