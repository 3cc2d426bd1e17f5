"""Throughput of seas simulated at once by a vectorised program: by batch, in both precisions, on the device at hand."""

import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np

from benchmarks.bench_sea import CUTOFF, ELEMENTS, HEIGHT, LOW, PERIOD, PLATFORM, STEP
from benchmarks.bench_timing import Row, contest
from jaxhydro import IrregularSea, State, build, equilibrium, jonswap, load_platform, spectrum_components
from jaxhydro.dynamics.integrate import Kernel, clock, integrate
from jaxhydro.dynamics.model import Model
from jaxhydro.environment import DOFS
from jaxhydro.platform.convergence import with_elements

SHORT, HOUR = 120.0, 3600.0  # s
DISTINCT = 8  # seas; larger batches repeat them
SIZES = {"cpu": (1, 2, 4, 8, 16, 32, 64, 128, 256, 512), "gpu": (1, 8, 64, 256, 1024, 4096)}
PRECISIONS = {"float64": np.float64, "float32": np.float32}
ROUNDS = 3
SEEN = ("surge", "heave", "pitch")


class Batch(NamedTuple):
    """Models in seas that are ready, along a first axis, and what they share: what is not an array, steps."""

    arrays: Any
    static: Any
    steps: int

    def of(self, size: int) -> "Batch":
        """So many of them, again and again."""
        seas = jax.tree.leaves(self.arrays)[0].shape[0]
        return self._replace(arrays=jax.tree.map(lambda x: x[np.arange(size) % seas], self.arrays))

    def as_(self, precision: str) -> "Batch":
        """Its numbers, made ready in float64, in another precision."""

        def cast(x):
            return x.astype(PRECISIONS[precision]) if jnp.issubdtype(x.dtype, jnp.floating) else x

        return self._replace(arrays=jax.tree.map(cast, self.arrays))

    def march(self, precision: str, kernel: Kernel = "off") -> jax.Array:
        """Positions (m, rad) in all seas after every step, by one kernel or by XLA's many."""
        # a GPU's products of float32 have eleven bits where nothing is said
        with warnings.catch_warnings(), jax.enable_x64(precision == "float64"), jax.default_matmul_precision("highest"):
            warnings.filterwarnings("ignore", "Explicitly requested dtype")  # that is what is asked for
            step = jnp.asarray(STEP, PRECISIONS[precision])
            return jax.block_until_ready(_march(self.arrays, self.static, step, self.steps, kernel))


@eqx.filter_jit
def _march(arrays, static, step, steps, kernel):
    def one(arrays):
        model, sea, start = eqx.combine(arrays, static)
        return integrate(model, sea, start, jnp.zeros_like(step), step, steps, "ab4", kernel=kernel).position

    return jax.vmap(one)(arrays)


def model_of(elements: int = ELEMENTS) -> Model:
    """The platform of `bench_sea`, its pontoons in so many elements."""
    return build(with_elements(load_platform(PLATFORM), "pontoon", elements))


def seas_of(model: Model, duration: float, count: int, order: int) -> list[IrregularSea]:
    """Seas of one spectrum and of as many seeds."""

    def spectrum(omega):
        return jonswap(omega, HEIGHT, PERIOD)

    return [
        IrregularSea(
            spectrum_components(spectrum, duration, model.environment, low=LOW, cutoff=CUTOFF, seed=seed),
            model.environment,
            2 if order == 2 else 1,
            "vertical",
        )
        for seed in range(count)
    ]


def prepared(model: Model, sea: IrregularSea, duration: float):
    """The sea for the model's hull."""
    steps = round(duration / STEP)
    return jax.block_until_ready(sea.prepared(model.hull.extremities(), model.cylinders, clock("ab4", 0.0, STEP, steps)))


def batch_of(model: Model, duration: float, count: int) -> Batch:
    """Seas of second order, ready, and the model at rest in each."""
    start = State(equilibrium(model), jnp.zeros(6), model.rest().memory)
    ready = [(model, prepared(model, sea, duration), start) for sea in seas_of(model, duration, count, 2)]
    parts = [eqx.partition(sea_run, eqx.is_array) for sea_run in ready]
    stacked = jax.tree.map(lambda *x: jnp.stack(x), *(arrays for arrays, _ in parts))
    return Batch(stacked, parts[0][1], round(duration / STEP))


def throughputs(
    batch: Batch, precision: str, sizes: Sequence[int], rounds: int, now: Callable[[], float], kernel: Kernel = "off"
) -> Iterator[tuple[int, float]]:
    """Numbers of seas at once, up to what the memory holds, each with the simulated seconds of sea per second."""
    own = batch.as_(precision)
    for size in sizes:
        try:
            sized = own.of(size)
            turns = contest({"march": lambda sized=sized: sized.march(precision, kernel)}, rounds, now)  # type: ignore[misc]
        except jax.errors.JaxRuntimeError:
            return  # out of memory
        yield size, size * batch.steps * STEP / turns["march"].median


def against_a_core(batch: Batch, best: dict[str, float], rounds: int) -> Iterator[Row]:
    """The GPU's best throughput over that of one core of the same machine, of one sea or `DISTINCT`."""
    core = jax.devices("cpu")[0]
    with jax.default_device(core):
        on_core = batch._replace(arrays=jax.device_put(batch.arrays, core))
        for precision, value in best.items():
            core_throughput = max(
                throughput for _, throughput in throughputs(on_core, precision, (1, DISTINCT), rounds, time.process_time)
            )
            yield Row(
                f"One core of the same machine, {precision}, simulated time over CPU time", f"{rounded(core_throughput):.0f}"
            )
            yield Row(f"The best batch against that core, {precision}", f"{value / core_throughput:.3g} times")


def error_of_float32(model: Model, duration: float) -> dict[str, float]:
    """The largest difference of a motion in float32 from that in float64, over the motion's standard deviation."""
    single = batch_of(model, duration, 1)
    exact, float32 = (np.asarray(single.as_(name).march(name), float)[0] for name in PRECISIONS)
    return {dof: float(np.abs(float32 - exact)[:, i].max() / exact[:, i].std()) for i, dof in enumerate(DOFS) if dof in SEEN}


def in_one_kernel(batch: Batch, sizes: Sequence[int], rounds: int, kernel: Kernel) -> Iterator[Row]:
    """Throughput with the time loop in one kernel, and its difference from XLA's program in the same precision."""
    for precision in PRECISIONS:
        try:
            exact, in_kernel = (np.asarray(batch.of(1).march(precision, how), float)[0] for how in ("off", kernel))
        except jax.errors.JaxRuntimeError as error:
            yield Row(f"The time loop in one kernel, {precision}", f"fails: {str(error).splitlines()[0][:200]}")
            continue
        apart = np.abs(in_kernel - exact).max(axis=0) / np.abs(exact).max(axis=0)
        off = ", ".join(f"{dof} {apart[i]:.1g}" for i, dof in enumerate(DOFS) if dof in SEEN)
        yield Row(f"Largest difference of one kernel from many, {precision}, over the largest motion", off)
        for size, value in throughputs(batch, precision, sizes, rounds, time.perf_counter, kernel):
            many = f"{size} sea{'s' * (size > 1)} at once in one kernel, {precision}, simulated time over time"
            yield Row(many, f"{rounded(value):.0f}", "1000000")


def rounded(value: float) -> float:
    """To three digits."""
    return float(f"{value:.3g}")


def draw(throughput: dict[str, dict[int, float]], device: str, path: Path) -> None:
    """Throughput against batch."""
    from jaxhydro.plots.style import BEFORE, SIMULATED, header, save, stack, style

    with style():
        figure, (ax,) = stack([1.6])
        artists = {}
        for (name, by_size), colour, marker in zip(throughput.items(), (SIMULATED, BEFORE), "os", strict=True):
            artists[name] = ax.plot(list(by_size), list(by_size.values()), marker + "-", color=colour, ms=3.5)[0]
        ax.set_xscale("log", base=2)
        ax.set_ylim(bottom=0.0)
        sizes = sorted({size for by_size in throughput.values() for size in by_size})
        ax.set_xticks(sizes, [str(size) for size in sizes])
        ax.minorticks_off()
        ax.set_xlabel("Seas at once")
        ax.set_ylabel("Simulated time over\ntime taken (-)")
        header(figure, f"Second-order seas by one program, {device}", artists, columns=2)
        save(figure, path)


def measure(quick: bool, figure: Path | None = None) -> Iterator[tuple[list[Row], list[str]]]:
    """All of this file; `figure`, where throughput is drawn."""
    device = jax.devices()[0]
    cpu = device.platform == "cpu"
    now, name = (time.process_time, "one core") if cpu else (time.perf_counter, device.device_kind)
    model, duration = model_of(), 30.0 if quick else SHORT
    sizes = (1, 2) if quick else SIZES["cpu" if cpu else "gpu"]
    batch = batch_of(model, duration, min(DISTINCT, max(sizes)))
    taken, rounds = "CPU time" if cpu else "time", 1 if quick else ROUNDS
    throughput: dict[str, dict[int, float]] = {precision: {} for precision in PRECISIONS}
    for precision, by_size in throughput.items():
        for size, value in throughputs(batch, precision, sizes, rounds, now):
            by_size[size] = value
            many = f"{size} sea{'s' * (size > 1)} at once, {precision}, simulated time over {taken}"
            yield [Row(many, f"{rounded(value):.0f}")], []
    best = {precision: max(by_size.values()) for precision, by_size in throughput.items()}
    rows = [
        Row(f"The best batch against one sea alone, {precision}", f"{best[precision] / by_size[1]:.3g} times")
        for precision, by_size in throughput.items()
    ]
    if not cpu:
        rows += against_a_core(batch, best, rounds)
        rows += in_one_kernel(batch, sizes, rounds, "gpu")
    bytes_per_sea = sum(x.nbytes for x in jax.tree.leaves(batch.of(1).arrays))
    rows.append(
        Row("Memory of a sea that is ready, float64", f"{bytes_per_sea / 1e6:.3g} MB for {duration:g} s of second order")
    )
    off = ", ".join(f"{dof} {value:.1g}" for dof, value in error_of_float32(model, 60.0 if quick else HOUR).items())
    rows.append(Row("Largest error of float32 over the motion's deviation", off))
    notes = [
        f"Seas at once: {duration:g} s of second order, {min(DISTINCT, max(sizes))} seeds again and again, made ready in "
        f"float64 beforehand, by one vectorised program on {name}{'' if cpu else ', wall time'}. In float32 are loads and "
        f"motion, {'a minute' if quick else 'an hour'} for its error; phases of waves are made in float64 in either case.",
    ]
    if figure is not None:
        draw(throughput, name, figure)
    yield rows, notes
