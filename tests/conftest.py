"""Set up for all tests: `import jaxhydro` switches float64 and the compilation cache on."""

import gc
import os
import sys
from pathlib import Path

import jax
import pytest

MAPS = 20_000

# so that `benchmarks` and the tests' own helpers are found however pytest is started
TESTS = Path(__file__).resolve().parent
for folder in (TESTS.parent, *(TESTS / name for name in ("fixtures", "jaxhydro", "calibration", "systems", "benchmarks"))):
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))

import jaxhydro.exported_programs  # noqa: E402

# tests replace functions of the packages, and a program that was exported before has the functions themselves
jaxhydro.exported_programs.switched_on = False
os.environ.pop("COLUMNS", None)  # of a pytest worker: tables are as wide as where there is no terminal


def pytest_configure(config):
    """Programs of small tests run for less time than their optimisation takes. Slow tests run optimised programs."""
    flags = "--xla_cpu_parallel_codegen_split_count=1"  # the workers are as many as the cores
    if not {"slow", "validate"} & set(config.option.markexpr.replace("not slow", "").replace("not validate", "").split()):
        flags += (
            " --xla_backend_optimization_level=0 --xla_llvm_disable_expensive_passes=true --xla_cpu_use_fusion_emitters=false"
        )
    os.environ["XLA_FLAGS"] = f"{flags} {os.environ.get('XLA_FLAGS', '')}"


gc.freeze()  # what is imported stays
gc.set_threshold(100_000, 20, 100)  # compiled programs are millions of objects; going through them often took 7 % of the time
jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.2)  # tests compile thousands of small programs


@pytest.fixture(scope="module", autouse=True)
def programs_do_not_pile_up():
    """Every compiled program is a few memory maps of the process, of which Linux allows 65530; a worker of all tests would
    come there and crash. What was compiled comes back from the cache on disk."""
    yield
    maps = Path("/proc/self/maps")
    if maps.exists() and len(maps.read_bytes().splitlines()) > MAPS:
        jax.clear_caches()
        gc.collect()
