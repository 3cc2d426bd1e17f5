"""Programs that the next process loads: the same results without tracing, and never those of another program."""

from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

import jaxhydro as jh
from jaxhydro import exported_programs
from jaxhydro.dynamics.irregular_simulation import simulate_steps
from jaxhydro.exported_programs import exported_jit
from jaxhydro.fingerprint import content_hash, installed_content_hash

traced: list[str] = []


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(exported_programs, "_folder", lambda: tmp_path)
    monkeypatch.setattr(exported_programs, "installed_content_hash", content_hash)  # else these functions are a user's own
    traced.clear()
    return tmp_path


class Elsewhere(NamedTuple):
    """A result of a class that is not the packages'."""

    value: jax.Array


def results(state, factor, name="plain"):
    traced.append(name)
    moved = eqx.tree_at(lambda s: s.position, state, factor * state.position)
    plain = {"moved": moved, "weak": jnp.where(factor > 0, 1.0, 2.0), "list": [None, True, 2, 0.5, name]}
    return plain, (moved.position.sum(), jh.StillWater())


def elsewhere(value):
    return Elsewhere(2 * value)


def square(x):
    traced.append("square")
    return jnp.sum(x**2)


STATE = jh.State(jnp.arange(6.0), jnp.ones(6), {"memory": jnp.array(3.0)})


def test_the_next_process_does_not_trace(folder):
    """Modules, named tuples, containers and plain values come back."""
    first = exported_jit(results)(STATE, jnp.array(2.0))
    assert traced == ["plain"] and len(list(folder.iterdir())) == 1
    second = exported_jit(results)(STATE, jnp.array(3.0))  # another function of the same name is what another process has
    assert traced == ["plain"]
    assert jax.tree.structure(first) == jax.tree.structure(second)
    for first_leaf, second_leaf in zip(jax.tree.leaves(first), jax.tree.leaves(second), strict=True):
        assert jax.typeof(first_leaf) == jax.typeof(second_leaf) if eqx.is_array(first_leaf) else first_leaf == second_leaf
    assert type(second[0]["moved"]) is jh.State and second[0]["list"] == [None, True, 2, 0.5, "plain"]
    assert_allclose(second[0]["moved"].position, 3 * np.arange(6.0), rtol=1e-15)
    assert float(second[1][0]) == 45.0 and float(second[0]["moved"].memory["memory"]) == 3.0


@pytest.mark.parametrize(
    "arguments",
    [
        (STATE, jnp.array(2.0), "other"),
        (STATE, jnp.array(2.0, jnp.float32)),
        (STATE, 2.0),
        (STATE, 2),
        (STATE, True),
        (eqx.tree_at(lambda s: s.memory, STATE, {"memory": jnp.ones(1)}), jnp.array(2.0)),
        (eqx.tree_at(lambda s: s.memory, STATE, {"other": jnp.array(3.0)}), jnp.array(2.0)),
    ],
)
def test_other_arguments_are_another_program(folder, arguments):
    exported_jit(results)(STATE, jnp.array(2.0))
    expected = results(*arguments)
    traced.clear()
    returned = exported_jit(results)(*arguments)
    assert len(traced) == 1 and len(list(folder.iterdir())) == 2
    assert eqx.tree_equal(expected, returned, rtol=1e-7)


def test_other_sources_are_another_program(folder, monkeypatch):
    exported_jit(results)(STATE, jnp.array(2.0))
    monkeypatch.setattr(exported_programs, "computed_with", lambda: {"source code": "changed"})
    exported_jit(results)(STATE, jnp.array(2.0))
    assert len(traced) == len(list(folder.iterdir())) == 2


def damages(content: bytes) -> list[bytes]:
    return [b"", content[:-9], content[: len(content) // 2] + b"x" + content[len(content) // 2 + 1 :], b"\n\n", b"{}\n[]"]


@pytest.mark.parametrize("which", range(5))
def test_a_damaged_file_is_made_anew(folder, which):
    exported_jit(results)(STATE, jnp.array(2.0))
    (file,) = folder.iterdir()
    whole = file.read_bytes()
    file.write_bytes(damages(whole)[which])
    assert float(exported_jit(results)(STATE, jnp.array(2.0))[1][0]) == 30.0
    assert len(traced) == 2 and [path.name for path in folder.iterdir()] == [file.name]
    exported_jit(results)(STATE, jnp.array(2.0))
    assert len(traced) == 2


def test_derivatives_and_other_programs_have_it_traced(folder):
    fun = exported_jit(square)
    x = jnp.arange(3.0)
    assert_allclose(jax.grad(fun)(x), 2 * x)
    assert_allclose(jax.vmap(fun)(x[:, None]), x**2)
    assert float(jax.jit(lambda: fun(jnp.ones(3)))()) == 3.0
    assert not list(folder.iterdir())


def test_a_result_from_elsewhere_is_not_kept(folder):
    fun = exported_jit(elsewhere)
    assert [float(fun(jnp.array(value)).value) for value in (1.0, 2.0)] == [2.0, 4.0]
    assert not list(folder.iterdir())


def test_a_program_with_a_class_of_the_users_is_not_kept(folder, monkeypatch):
    """A law that was changed and not imported again would be taken for the changed one; a notebook's has no file."""
    monkeypatch.setattr(exported_programs, "installed_content_hash", installed_content_hash)
    notebook = {"__name__": "__main__"}
    exec("class Law:\n    factor = 2.0\n    def __eq__(self, other): return True\n    __hash__ = object.__hash__", notebook)
    for own, where in ((Elsewhere(jnp.ones(())), __file__), (notebook["Law"](), "no file")):
        with pytest.raises(TypeError, match=f"is defined in {where}"):
            installed_content_hash(own)
        assert float(jnp.sum(exported_jit(jh.State)(jnp.ones(6), jnp.ones(6), own).position)) == 6.0
    assert not list(folder.iterdir())
    exported_jit(jh.State)(jnp.ones(6), jnp.ones(6), None)
    assert len(list(folder.iterdir())) == 1


def with_a_callback(x):
    return 2 * jax.pure_callback(np.sin, jax.ShapeDtypeStruct((), float), x)


def refused(x):
    if x.ndim == 0:
        raise ValueError("expected an array of one axis")
    return x


def test_what_jax_cannot_export_runs_all_the_same(folder):
    assert float(exported_jit(with_a_callback)(jnp.array(0.5))) == 2 * np.sin(0.5)
    assert not list(folder.iterdir())


def test_errors_are_the_functions_own(folder):
    for _ in range(2):
        with pytest.raises(ValueError, match="of one axis"):
            exported_jit(refused)(jnp.array(0.5))
    assert not list(folder.iterdir())


def test_it_is_off_without_the_compilation_cache(folder, monkeypatch):
    monkeypatch.setattr(exported_programs, "_folder", lambda: None)
    assert [float(exported_jit(square)(jnp.ones(2))) for _ in range(2)] == [2.0, 2.0]
    assert traced and not list(folder.iterdir())


def test_a_folder_that_cannot_be_written(folder, monkeypatch):
    (folder / "file").write_text("no folder")
    monkeypatch.setattr(exported_programs, "_folder", lambda: folder / "file")
    assert float(exported_jit(square)(jnp.ones(2))) == 2.0


def test_a_decay_is_the_same(folder):
    """A simulation of a whole platform, by both ways."""
    model = jh.load_model("volturnus-s")
    start = jh.State(jnp.zeros(6).at[0].set(8.0), jnp.zeros(6), model.rest().memory)
    times = jnp.arange(0.0, 20.0, 0.5)
    arguments = (model, jh.StillWater(), start, times, jnp.array(0.25), 80, "ab4", "forward")
    plain, _ = eqx.filter_jit(simulate_steps.__wrapped__)(*arguments)
    exported, grid = simulate_steps(*arguments)
    assert type(exported) is jh.Response and type(grid).__name__ == "Grid"
    assert any(path.stat().st_size > 10_000 for path in folder.iterdir())
    for plain_leaf, exported_leaf in zip(jax.tree.leaves(plain), jax.tree.leaves(exported), strict=True):
        assert_allclose(plain_leaf, exported_leaf, rtol=1e-11, atol=1e-11)
