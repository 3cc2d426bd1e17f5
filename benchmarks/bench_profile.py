"""Where an hour of sea spends its time, part by part along its own path, and the floor that arithmetic and memory set."""

import re
from collections.abc import Callable, Iterator
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from benchmarks.bench_sea import STEP, Hour
from benchmarks.bench_timing import Row, contest, times
from jaxhydro import Model, State
from jaxhydro.dynamics.integrate import integrate
from jaxhydro.rotations import rotation, turned
from jaxhydro.waves.sea import AbstractSea

Part = Callable[[Model, AbstractSea, jax.Array, State], Any]
_NO_OPERATION = {"parameter", "constant", "get-tuple-element", "tuple", "bitcast"}
# name = stablehlo.operation ...; name = type[shape] operation(...); name = (types) operation(...)
_ASSIGNMENT = re.compile(r"\s*(?:ROOT )?%?[\w.:-]+ = (?:\(.*?\) |\w+\[\S* )?(?P<operation>[a-z][\w.-]*)")
SQUARE = 768  # of the matrices whose product says what arithmetic can be had
LARGE = 32_000_000  # float64 numbers that no cache holds


def waves(model: Model, sea: AbstractSea, time: jax.Array, state: State) -> Any:
    """Surface, and flow at all strips and ends, where the platform is."""
    matrix, origin, hull = rotation(state.position[3:]), state.position[:3], model.hull
    points = jnp.concatenate([hull.strips.start, hull.ends.position], axis=1)
    surface = sea.surface(time, origin[:2, None] + matrix[:2] @ hull.gauges)
    return surface, sea.flow(time, origin[:, None] + turned(matrix, points), model.cylinders)


def loads(model: Model, sea: AbstractSea, time: jax.Array, state: State) -> Any:
    """Their sum, and what they read."""
    return model.sum_of_loads(model.instant(time, state, sea), state.memory)


PARTS: dict[str, tuple[str, Part]] = {  # each contains those before it
    "waves": ("the waves at strips and ends", waves),
    "instant": ("wetting, and the flow past strips and ends", lambda model, sea, time, state: model.instant(time, state, sea)),
    "loads": ("the loads and their sum", loads),
    "rate": ("inertia, accelerations, rates", lambda model, sea, time, state: model.rate(time, state, sea)),
}


def along(hour: Hour, sea: AbstractSea, part: Part, path: State) -> Callable[[], Any]:
    """A compiled call of one part at every step of a path. All that it gives is summed, so that none of it is left out."""
    arrays, static = eqx.partition((hour.model, sea), eqx.is_array)
    instants = STEP * jnp.arange(hour.steps)

    def run(arrays, instants, path):
        model, sea = eqx.combine(arrays, static)

        def body(total, now):
            leaves = jax.tree.leaves(eqx.filter(part(model, sea, *now), eqx.is_inexact_array))
            return total + sum(jnp.sum(leaf) for leaf in leaves), None

        return jax.lax.scan(body, jnp.zeros(()), (instants, path))[0]

    compiled = jax.jit(run).lower(arrays, instants, path).compile()
    return lambda: jax.block_until_ready(compiled(arrays, instants, path))


def path_of(hour: Hour, sea: AbstractSea) -> State:
    """States at the beginnings of the hour's steps."""
    state = State(hour.rest, jnp.zeros(6), hour.model.rest().memory)
    run = eqx.filter_jit(lambda model, sea: integrate(model, sea, state, jnp.zeros(()), jnp.asarray(STEP), hour.steps, "ab4"))
    states = run(hour.model, sea)
    position, rate = states.position[: hour.steps], states.rate[: hour.steps]
    memory = jax.tree.map(lambda x: jnp.broadcast_to(x, (hour.steps, *x.shape)), state.memory)
    return State(position, jax.vmap(hour.model.body_velocity)(position, rate), memory)


def operations_of(text: str) -> int:
    """Number of operations in a program's text, StableHLO or HLO; what only joins or names values is not counted."""
    assignments = (_ASSIGNMENT.match(line) for line in text.splitlines())
    return sum(1 for match in assignments if match and match["operation"].rpartition(".")[2] not in _NO_OPERATION)


def launched_of(text: str) -> int:
    """Number of operations in the main computation of an optimised program: what is run one by one, fusions as one."""
    return operations_of(text.rpartition("\nENTRY ")[2])


def floor(hour: Hour, sea: Any, step: float, path: State, rounds: int) -> tuple[list[Row], list[str]]:
    """What arithmetic and memory of one step take at the rates that this core reaches; `step` (s) is what one takes."""
    arrays, static = eqx.partition((hour.model, sea), eqx.is_array)
    state = jax.tree.map(lambda x: x[hour.steps // 2], path)

    def rate(arrays, state):
        model, sea = eqx.combine(arrays, static)
        return model.rate(jnp.asarray(STEP * (hour.steps // 2)), state, sea)

    program = jax.jit(rate).lower(arrays, state)
    traced, compiled = operations_of(program.as_text()), program.compile()
    optimised, launched = operations_of(compiled.as_text()), launched_of(compiled.as_text())
    cost = compiled.cost_analysis()
    operations, exponentials = float(cost["flops"]), float(cost["transcendentals"])
    matrix = np.random.default_rng(0).standard_normal((SQUARE, SQUARE))
    few, exponential = jnp.linspace(-1.0, 0.0, 32768), jax.jit(jnp.exp)
    many = np.ones(LARGE)
    target = np.empty_like(many)
    turns = contest(
        {
            "product": lambda: matrix @ matrix,
            "exponentials": lambda: [exponential(few) for _ in range(50)][-1].block_until_ready(),
            "copy": lambda: np.copyto(target, many),
        },
        rounds,
    )
    speed = 2 * SQUARE**3 / turns["product"].median
    per_exponential = turns["exponentials"].median / (50 * few.size)
    bandwidth = 2 * many.nbytes / turns["copy"].median
    row = sea.series[0].nbytes + path.position[0].nbytes
    arithmetic, memory = operations / speed + exponentials * per_exponential, row / bandwidth
    rows = [
        Row("Arithmetic of a step at the core's speed", f"{1e6 * arithmetic:.3g} µs"),
        Row("Memory of a step at the core's bandwidth", f"{1e6 * memory:.3g} µs"),
        Row("HLO operations of a step: traced, optimised, run one by one", f"{traced}, {optimised}, {launched}"),
        Row("A step over that floor", times(step / max(arithmetic, memory))),
    ]
    notes = [
        f"The floor: XLA counts {operations:.3g} additions and multiplications and {exponentials:.3g} exponentials "
        f"and the like in a step; this core does {speed / 1e9:.3g}e9 of the former a second in a product of matrices of "
        f"{SQUARE}, and one of the latter in {1e9 * per_exponential:.2g} ns. What no cache holds are {row / 1e3:.3g} kB of the "
        f"sea's series and the path; a copy moves {bandwidth / 1e9:.3g} GB/s. HLO operations do not depend on the machine's "
        "load: they grow where the equation of motion does."
    ]
    return rows, notes


def profile(hour: Hour, rounds: int) -> Iterator[tuple[list[Row], list[str]]]:
    """Shares of a step of second order, all physics."""
    sea = hour.prepared(2)
    path = path_of(hour, sea)
    runs = {name: along(hour, sea, part, path) for name, (_, part) in PARTS.items()}
    runs["whole"] = hour.case(sea, "forward", lambda f: f)
    turns = contest(runs, rounds)
    whole, before, rows = turns["whole"].median, 0.0, []
    words = {name: label for name, (label, _) in PARTS.items()} | {"whole": "the scheme, and keeping the path"}
    for name, turn in turns.items():
        took = turn.median - before
        before = turn.median
        rows.append(Row(f"Of a step: {words[name]}", f"{1e6 * took / hour.steps:.3g} µs, {took / whole:.0%}"))
    note = (
        "Of a step: each part is run along the hour's own path together with those before it, and the difference is said; "
        "compiled alone they fuse otherwise than in the whole."
    )
    yield rows, [note]
    yield floor(hour, sea, whole / hour.steps, path, rounds)
