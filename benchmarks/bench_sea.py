"""One hour of an irregular sea, all physics: against plain NumPy, its kinematics, its derivatives, what it takes to prepare."""

import time
from collections.abc import Callable, Iterator
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from ruamel.yaml import YAML

from benchmarks.bench_timing import Row, contest, times
from benchmarks.reference_model import matrix_of, state_of
from benchmarks.reference_waves import WaveModel, Waves, march
from jaxhydro import IrregularSea, Platform, State, build, equilibrium, jonswap, load_platform, spectrum_components
from jaxhydro.dynamics.integrate import clock, integrate
from jaxhydro.platform.convergence import with_elements
from jaxhydro.waves import Components

HEIGHT, PERIOD = 8.1, 12.8  # m, s
LOW, CUTOFF = 0.03, 0.3  # Hz
STEP = 0.25  # s
ELEMENTS = 11  # of a pontoon: some 100 strips with the columns'
PLATFORM = "volturnus-s-focal"
AWAY = np.array([15.0, 0.0, 1.0, 0.0, np.deg2rad(5.0), 0.0])  # where kinematics are compared
DIRECTIONS = 100  # of derivatives at once


class Hour:
    """A sea of `duration` s and the platform in it, as case 4 of the paper: second order, stretching, MacCamy and Fuchs.

    `platform` replaces that of the paper.
    """

    def __init__(self, duration: float, platform: Platform | None = None) -> None:
        self.platform = with_elements(load_platform(PLATFORM), "pontoon", ELEMENTS) if platform is None else platform
        self.model = build(self.platform)
        self.duration, self.steps = duration, round(duration / STEP)
        self.components: Components = spectrum_components(
            lambda omega: jonswap(omega, HEIGHT, PERIOD), duration, self.model.environment, low=LOW, cutoff=CUTOFF, seed=1
        )
        self.rest = equilibrium(self.model)
        labels = [label for label in self.model.values if label.split(".")[0] in ("column", "pontoon", "linear_damping")]
        self.labels = labels[:11]
        self.start = jnp.stack([self.model.values[label] for label in self.labels])

    def sea(self, order: int) -> IrregularSea:
        return IrregularSea(self.components, self.model.environment, 2 if order == 2 else 1, "vertical")

    def prepared(self, order: int) -> Any:
        sea = self.sea(order).prepared(self.model.hull.extremities(), self.model.cylinders, clock("ab4", 0.0, STEP, self.steps))
        return jax.block_until_ready(sea)

    def case(self, sea: Any, adjoint: str, differentiate: Callable[[Callable], Callable]) -> Callable[[], Any]:
        """A compiled call, and `memory` of it in bytes."""
        arrays, static = eqx.partition((self.model, sea), eqx.is_array)

        def position(arrays, x):
            model, sea = eqx.combine(arrays, static)
            model = model.with_values(dict(zip(self.labels, x, strict=True)))
            state = State(self.rest, jnp.zeros(6), model.rest().memory)
            zero, step = jnp.zeros(()), jnp.asarray(STEP)
            return integrate(model, sea, state, zero, step, self.steps, "ab4", adjoint).position[: self.steps + 1]

        def run(arrays, x):
            return differentiate(lambda x: position(arrays, x))(x)

        compiled = jax.jit(run).lower(arrays, self.start).compile()

        def call():
            return jax.block_until_ready(compiled(arrays, self.start))

        call.memory = compiled.memory_analysis().temp_size_in_bytes  # type: ignore[attr-defined]
        return call


def plain(hour: Hour, order: int) -> WaveModel:
    """The NumPy model of the same platform in the same components, with no more wet strips than the package has."""
    waves = hour.components
    same = Waves(
        *(np.asarray(x) for x in (waves.amplitude, waves.omega, waves.heading, waves.phase)),
        depth=float(hour.model.environment.depth),
        gravity=float(hour.model.environment.gravity),
        order=order,
        stretching="vertical",
    )
    raw = YAML(typ="safe").load(hour.platform.model_dump_json(exclude_none=True))
    own = len(hour.model.hull.strips.element)
    for strip in np.arange(1.0, 6.0, 0.125):
        model = WaveModel(raw, same, strip, 2.0, maccamy_fuchs=True, pontoon_ends=True)
        if np.count_nonzero(model.wetted(np.zeros(3), np.eye(3))[1]) <= own:
            return model
    raise AssertionError("no spacing makes so few strips")


def speed(hour: Hour, rounds: int, seconds: float) -> tuple[list[Row], list[str]]:
    """The hour against NumPy, real time and its own derivatives."""
    sea = {order: hour.prepared(order) for order in (1, 2)}
    runs = {f"order {order}": hour.case(sea[order], "forward", lambda f: f) for order in (1, 2)}
    model = plain(hour, 1)
    begin = np.asarray(hour.rest)
    runs["numpy"] = lambda: march(model, begin, np.zeros(6), STEP, seconds)
    turns = contest(runs, rounds)
    share = hour.duration / seconds
    hour_of = {name: turn.median * (share if name == "numpy" else 1.0) for name, turn in turns.items()}
    pairs = plain(hour, 2)
    pairs.rate(0.0, state := state_of(begin))
    begun = time.process_time()
    pairs.rate(1.0, state)
    per_step = time.process_time() - begun
    second = per_step * hour.steps
    count, strips = hour.components.omega.size, len(hour.model.hull.strips.element)
    ratio = share * turns["numpy"].over(turns["order 1"])
    rows = [
        Row("Sea of order 2, simulated time over CPU time", f"{hour.duration / hour_of['order 2']:.0f}", "3000", "5800"),
        Row("Sea of order 2 against NumPy, same scheme", times(second / hour_of["order 2"]), "250", ""),
        Row("Sea of order 1 against NumPy, same scheme", times(ratio), "250", "205"),
        Row("Sea of order 2 by this package", f"{1e6 * hour_of['order 2'] / hour.steps:.3g} µs per step", "", "38 µs"),
        Row("Sea of order 1 by this package", f"{1e6 * hour_of['order 1'] / hour.steps:.3g} µs per step"),
        Row("Sea of order 1 by NumPy", f"{1e6 * hour_of['numpy'] / hour.steps:.3g} µs per step", "", "8800 µs per step"),
        Row("Sea of order 2 by NumPy", f"{per_step:.3g} s per step (one step taken)"),
    ]
    notes = [
        f"A sea is JONSWAP Hs {HEIGHT} m, Tp {PERIOD} s, {count} components from {LOW} to {CUTOFF} Hz, {hour.duration:g} s, "
        f"with vertical stretching and MacCamy-Fuchs (the paper's case 4), on {PLATFORM} with {strips} strips, six degrees of "
        f"freedom, four-step Adams-Bashforth at {STEP} s in float64; {sea[2].wavenumber.size} support wavenumbers at order 2, "
        f"{sea[1].wavenumber.size} at order 1.",
        f"NumPy sums the same components directly, at order 2 with all {count * (count + 1)} bound ones, on "
        f"{np.count_nonzero(model.wetted(np.zeros(3), np.eye(3))[1])} wet strips; at order 1 it is timed over {seconds:g} s.",
    ]
    return rows, notes


def along_directions(position: Callable) -> Callable:
    """Derivatives along many random directions of the parameters, by one forward pass."""
    basis = jnp.asarray(np.random.default_rng(0).standard_normal((11, DIRECTIONS)))
    return lambda x: jax.jacfwd(lambda z: position(x + basis @ z))(jnp.zeros(DIRECTIONS))


def derivatives(hour: Hour, rounds: int) -> tuple[list[Row], list[str]]:
    """Jacobian and gradient in simulations of the same sea."""
    sea = hour.prepared(2)
    scale = jnp.array([1.0, 1.0, 1.0, 50.0, 50.0, 50.0])
    runs = {
        "one": hour.case(sea, "forward", lambda f: f),
        "jacobian": hour.case(sea, "forward", jax.jacfwd),
        "directions": hour.case(sea, "forward", along_directions),
        "gradient": hour.case(sea, "reverse", lambda f: jax.grad(lambda x: jnp.mean((f(x) * scale) ** 2))),
    }
    turns = contest(runs, rounds)

    def found(name: str) -> str:
        memory = runs[name].memory / 1e6  # type: ignore[attr-defined]
        return f"{turns[name].over(turns['one']):.3g} simulations, {memory:.3g} MB"

    rows = [
        Row("Jacobian of 11 parameters in a sea", found("jacobian"), "5", "5.7"),
        Row(f"Derivatives along {DIRECTIONS} directions in a sea", found("directions"), "25"),
        Row("Reverse gradient of a sea", found("gradient"), "3, 50 MB", "3.2, 55 MB"),
    ]
    return rows, ["Memory is XLA's temporary buffers beyond the sea's own series."]


def kinematics(hour: Hour) -> tuple[list[Row], list[str]]:
    """The package's fast evaluation against NumPy's direct sum at the displaced hull."""
    rows = []
    for order in (1, 2):
        sea = hour.prepared(order)
        model = plain(hour, order)
        attitude = matrix_of(state_of(AWAY)[3:7])
        points = AWAY[:3, None] + attitude @ np.asarray(hour.model.hull.strips.start)
        points[2] = np.minimum(points[2], 0.0)
        worst = np.zeros(2)
        for at in (0.0, 0.37, 0.81) if order == 1 else (0.37,):
            now = round(at * hour.steps) * STEP
            exact = model.waves.kinematics(now, points)[:2]
            flow = sea.flow(jnp.asarray(now), jnp.asarray(points)).earth()
            pairs = zip((flow.velocity, flow.acceleration), exact, strict=True)
            worst = np.maximum(worst, [np.abs(np.asarray(a) - b).max() / np.abs(b).max() for a, b in pairs])
        goal = ("1e-05", "1.6e-05") if order == 1 else ("", "")
        what = f"Error of velocity / acceleration at 15 m, 5 deg, order {order}"
        rows.append(Row(what, " / ".join(f"{value:.1e}" for value in worst), *goal))
    return rows, ["Errors of kinematics are the largest over the strips, relative to the largest value there, against NumPy."]


def preparing(hour: Hour) -> tuple[list[Row], list[str]]:
    """Time and memory of making a sea ready."""
    rows = []
    for order, goal, prototype in ((1, "", "0.15 s, 7-14 MB"), (2, "1.5 s, 200 MB", "2.1 s, 320 MB")):
        hour.prepared(order)
        begun = time.process_time()
        sea = hour.prepared(order)
        took = time.process_time() - begun
        what = f"Sea of order {order} made ready, N = {hour.components.omega.size}"
        rows.append(Row(what, f"{took:.2g} s, {sea.series.nbytes / 1e6:.3g} MB", goal, prototype))
    return rows, ["A sea made ready: its second order, its support wavenumbers and their series; the memory is what is kept."]


def measure(quick: bool) -> Iterator[tuple[list[Row], list[str]]]:
    """All of this file but derivatives, and `bench_profile`, part by part."""
    from benchmarks.bench_profile import profile

    hour = Hour(120.0 if quick else 3600.0)
    yield speed(hour, 2 if quick else 5, 2.0 if quick else 20.0)
    yield kinematics(hour)
    yield preparing(hour)
    yield from profile(hour, 2 if quick else 5)
