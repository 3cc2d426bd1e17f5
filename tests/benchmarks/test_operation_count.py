"""Count of a program's operations, as the benchmark of speed prints it."""

import jax
import jax.numpy as jnp

from benchmarks.bench_profile import launched_of, operations_of


def test_operations_are_counted_before_and_after_fusion():
    program = jax.jit(lambda x: jnp.sin(x) * x + jnp.cos(x)).lower(jnp.ones(8))
    assert operations_of(program.as_text()) == 4  # sine, product, cosine, sum
    text = program.compile().as_text()
    assert operations_of(text) >= 4
    assert launched_of(text) == 1  # all fused


def test_growth_of_a_program_is_seen():
    def count(terms: int) -> int:
        return operations_of(jax.jit(lambda x: sum(jnp.sin(k * x) for k in range(1, terms + 1))).lower(jnp.ones(8)).as_text())

    assert count(9) > count(3)
