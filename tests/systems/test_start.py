"""`import jaxhydro` sets JAX up, and what the user has set before stays."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jax
import pytest
from test_cli import run

import jaxhydro as jh
from jaxhydro import jax_settings as module
from jaxhydro.jax_settings import QUICK, need_float64, quick_compilation, start

ROOT = Path(__file__).resolve().parents[2]
SETTINGS = {
    "jax_enable_x64": False,
    "jax_compilation_cache_dir": None,
    "jax_enable_compilation_cache": True,
    "jax_persistent_cache_min_compile_time_secs": 1.0,
    "jax_persistent_cache_min_entry_size_bytes": 0,
}
VARIABLES = (
    "JAXHYDRO_X64",
    "JAXHYDRO_COMPILATION_CACHE",
    "XLA_FLAGS",
    "XDG_CACHE_HOME",
    *(name.upper() for name in SETTINGS),
)
SHOW = f"""
import json, os, sys, jax
from jax._src.xla_bridge import backends_are_initialized
settings = {{name: getattr(jax.config, name) for name in {list(SETTINGS)!r}}}
print(json.dumps(settings | {{"flags": os.environ.get("XLA_FLAGS", ""), "begun": backends_are_initialized()}}))
"""


def settings() -> dict[str, Any]:
    return {name: getattr(jax.config, name) for name in SETTINGS}


@pytest.fixture
def untouched(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[pytest.MonkeyPatch]:
    """JAX as it is before the import, and a cache folder of the user that is empty."""
    before = settings()
    for name in VARIABLES:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    for name, value in SETTINGS.items():
        jax.config.update(name, value)
    yield monkeypatch
    for name, value in before.items():
        jax.config.update(name, value)


def process(code: str, folder: Path, **variables: str) -> dict[str, Any]:
    """What a new process prints last, as JSON."""
    clean = {name: value for name, value in os.environ.items() if name not in VARIABLES}
    env = clean | {"XDG_CACHE_HOME": str(folder), "PYTHONPATH": str(ROOT), "JAX_PLATFORMS": "cpu"} | variables
    done = subprocess.run([sys.executable, "-c", code], env=env, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0 and not done.stderr, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


@pytest.mark.slow
@pytest.mark.parametrize("package", ["jaxhydro", "calibration"])
def test_the_import_is_enough(package: str, tmp_path: Path) -> None:
    """Nothing is computed by it, so that the user can still choose devices and flags."""
    state = process(f"import {package}\n{SHOW}", tmp_path)
    assert state["jax_enable_x64"] and state["jax_compilation_cache_dir"] == str(tmp_path / "jaxhydro" / "xla")
    assert QUICK in state["flags"] and not state["begun"]


@pytest.mark.slow
def test_the_next_process_finds_the_programs_compiled(tmp_path: Path) -> None:
    """Also where JAX computed before the import."""
    code = """
import jax, jax.numpy as jnp
jnp.ones(3).sum()
hits = []
jax.monitoring.register_event_listener(lambda event, **_: hits.append(event) if event.endswith("cache_hits") else None)
import jaxhydro
jax.jit(lambda x: jnp.sin(x) ** 2)(jnp.ones(3)).block_until_ready()
import json
print(json.dumps({"hits": len(hits), "x64": jnp.ones(3).dtype == "float64"}))
"""
    assert process(code, tmp_path) == {"hits": 0, "x64": True}
    assert list((tmp_path / "jaxhydro" / "xla").iterdir())
    second = process(code, tmp_path)
    assert second["hits"] > 0


def test_each_step_can_be_switched_off(untouched: pytest.MonkeyPatch, tmp_path: Path) -> None:
    untouched.setenv("JAXHYDRO_X64", "0")
    start()
    assert not jax.config.jax_enable_x64 and jax.config.jax_compilation_cache_dir
    jax.config.update("jax_compilation_cache_dir", None)
    untouched.setenv("JAXHYDRO_X64", "1")
    untouched.setenv("JAXHYDRO_COMPILATION_CACHE", "0")
    for name in ("jax_persistent_cache_min_compile_time_secs", "jax_persistent_cache_min_entry_size_bytes"):
        jax.config.update(name, SETTINGS[name])
    start()
    assert settings() == SETTINGS | {"jax_enable_x64": True}


def test_programs_are_kept_however_short_their_compilation(untouched: pytest.MonkeyPatch, tmp_path: Path) -> None:
    start()
    assert settings() == {
        "jax_enable_x64": True,
        "jax_compilation_cache_dir": str(tmp_path / "cache" / "jaxhydro" / "xla"),
        "jax_enable_compilation_cache": True,
        "jax_persistent_cache_min_compile_time_secs": 0.0,
        "jax_persistent_cache_min_entry_size_bytes": -1,
    }


def test_the_users_own_settings_stay(untouched: pytest.MonkeyPatch, tmp_path: Path) -> None:
    untouched.setenv("JAX_ENABLE_X64", "0")
    untouched.setenv("JAX_PERSISTENT_CACHE_MIN_ENTRY_SIZE_BYTES", "0")
    untouched.setenv("JAX_COMPILATION_CACHE_DIR", str(tmp_path / "not this"))
    own = {
        "jax_compilation_cache_dir": str(tmp_path / "own"),
        "jax_persistent_cache_min_compile_time_secs": 2.5,
    }
    for name, value in own.items():
        jax.config.update(name, value)
    start()
    assert settings() == SETTINGS | own
    assert not list(tmp_path.iterdir())


def test_a_cache_folder_named_after_jax_was_imported_is_used(untouched: pytest.MonkeyPatch, tmp_path: Path) -> None:
    untouched.setenv("JAX_COMPILATION_CACHE_DIR", str(tmp_path / "own"))
    start()
    assert jax.config.jax_compilation_cache_dir == str(tmp_path / "own")


def test_a_cache_that_jax_has_switched_off_stays_off(untouched: pytest.MonkeyPatch, tmp_path: Path) -> None:
    jax.config.update("jax_enable_compilation_cache", False)
    start()
    assert settings() == SETTINGS | {"jax_enable_x64": True, "jax_enable_compilation_cache": False}
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("why", ["no folder can be made", "not writable", "no home"])
def test_without_a_folder_there_is_no_cache(why: str, untouched: pytest.MonkeyPatch, tmp_path: Path) -> None:
    if why == "no folder can be made":
        untouched.setenv("XDG_CACHE_HOME", "/dev/null/cache")
    elif why == "not writable":
        untouched.setattr(module.os, "access", lambda path, mode: False)  # root may write everywhere
    else:
        untouched.delenv("XDG_CACHE_HOME")
        untouched.setattr(Path, "expanduser", no_home)
    start()
    assert settings() == SETTINGS | {"jax_enable_x64": True}


def no_home(path: Path) -> Path:
    raise RuntimeError("Could not determine home directory.")


def test_xla_flags_of_the_user_stay(untouched: pytest.MonkeyPatch) -> None:
    quick_compilation()
    assert os.environ["XLA_FLAGS"] == QUICK
    quick_compilation()
    assert os.environ["XLA_FLAGS"] == QUICK
    own = "--xla_cpu_use_fusion_emitters=true --xla_dump_to=x"
    untouched.setenv("XLA_FLAGS", own)
    quick_compilation()
    assert os.environ["XLA_FLAGS"] == own
    untouched.setenv("XLA_FLAGS", "--xla_dump_to=x")
    untouched.setattr("jaxlib.__version__", "0.99.0")
    quick_compilation()
    assert os.environ["XLA_FLAGS"] == "--xla_dump_to=x"


def test_float32_is_told(untouched: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A model in single precision would be wrong quietly."""
    with pytest.raises(RuntimeError, match="JAX_ENABLE_X64=0 and JAXHYDRO_X64=0"):
        jh.load_model("volturnus-s")
    text = run("simulate", "volturnus-s", "--release", "heave=1", "--out", tmp_path / "decay", status=2)
    assert text.startswith("jaxhydro: jaxhydro needs float64. Remove JAX_ENABLE_X64=0")
    jax.config.update("jax_enable_x64", True)
    need_float64()


@pytest.mark.slow
def test_a_command_imports_what_it_needs(tmp_path: Path) -> None:
    """A simulation without figures needs no matplotlib and no data frames; of scipy JAX takes LAPACK."""
    sea = ["--hs", "3", "--tp", "9", "--duration", "100", "--no-figures"]
    words = ["simulate", "volturnus-s", *sea, "--out", str(tmp_path / "sea")]
    others = ["matplotlib", "scipy.signal", "scipy.stats", "scipy.special", "pandas", "xarray", "dask", "calibration"]
    code = f"""
import contextlib, io, json, sys
from jaxhydro.cli.app import main
sys.argv = ["jaxhydro", *{words!r}]
with contextlib.suppress(SystemExit), contextlib.redirect_stderr(io.StringIO()):
    main()
print(json.dumps([name for name in {others!r} if name in sys.modules]))
"""
    assert process(code, tmp_path) == []
    assert (tmp_path / "sea" / "simulated.nc").is_file()
