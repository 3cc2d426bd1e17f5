"""OpenFAST's runs in waves, and this package with OpenFAST's conventions."""

import contextlib
import dataclasses
import json
from collections.abc import Iterator
from typing import Any, NamedTuple
from unittest import mock

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pandas as pd

import jaxhydro as jh
from benchmarks.evidence.openfast_runs import FOLDER, platform
from jaxhydro.waves import SupportSea, pair_sums, second_order, shared_preparation
from jaxhydro.waves.components import PlaneWaves, components
from jaxhydro.waves.flow import Cylinders, Flow

WATER = jh.Environment(1025.0, 200.0, 9.81)
CHANNELS = {"surge": "PtfmSurge", "heave": "PtfmHeave", "pitch": "PtfmPitch"}
LOADS = {"Fx": (0, "HydroFxi"), "Fz": (2, "HydroFzi"), "My": (4, "HydroMyi")}


class Case(NamedTuple):
    """Order of the waves, stretching, and whether the outer columns diffract."""

    order: int
    stretching: str
    diffraction: str


CASES = {
    "c1": Case(1, "none", "none"),
    "c2": Case(2, "none", "none"),
    "c1mcf": Case(1, "none", "maccamy_fuchs"),
    "c1st": Case(1, "vertical", "none"),
    "c3": Case(2, "vertical", "maccamy_fuchs"),
    "c4": Case(2, "vertical", "maccamy_fuchs"),
}


class Run(NamedTuple):
    """One of OpenFAST's runs: its case, numbers, table, and its waves on all harmonics of a period."""

    case: Case
    setup: dict[str, Any]
    table: dict[str, np.ndarray]
    waves: jh.Components


def read(name: str) -> Run:
    """`ss1_c3`, say. Components that are not in the file have no amplitude."""
    folder = FOLDER / name
    setup = json.loads((folder / "setup.json").read_text())
    columns = pd.read_csv(folder / "out.csv.gz", skiprows=[1]).astype(float)
    index, omega, _, amplitude, phase = np.loadtxt(folder / "components.csv.gz", delimiter=",", skiprows=2, ndmin=2).T
    first = int(index[0])
    bins = np.zeros((2, int(index[-1]) - first + 1))
    bins[:, index.astype(int) - first] = amplitude, phase
    period = round(2 * np.pi * index[-1] / omega[-1])
    harmonics = jnp.asarray(2 * np.pi / period * np.arange(first, first + bins.shape[1]))
    waves = components(jnp.asarray(bins[0]), harmonics, WATER, phase=jnp.asarray(bins[1]), first=first)
    case = CASES[next((part for part in name.split("_") if part in CASES), "c3")]
    return Run(case, setup, {key: columns[key].to_numpy() for key in columns}, waves)


def model(run: Run, *, centre: bool = False, nodes: bool = False, **changes: Any) -> jh.Model:
    """The platform with OpenFAST's conventions, but for `changes`.

    Strips up to still water as they are on the upright platform unless the waves are stretched, directions of the undisplaced
    platform, diffraction without its lag and of free waves only; of the `centre` column not at all. `nodes`: strips lumped at
    the ends of its elements, of 2.5 m in the columns and 4.3 m in the pontoons.
    """
    wetting = "mean" if run.case.stretching == "none" else "instantaneous"
    options = {"wetting": wetting, "directions": "earth", "diffraction": run.case.diffraction, "lag": False, "bound": False}
    file = platform(run.setup)
    file["members"][0]["maccamy_fuchs"] = centre
    with mock.patch("numpy.polynomial.legendre.leggauss", _nodes) if nodes else contextlib.nullcontext():
        return jh.build(jh.Platform.model_validate(file)).with_conventions(**options | changes)


def _nodes(order: int) -> tuple[np.ndarray, np.ndarray]:
    """Trapezoidal rule of OpenFAST's number of strips.

    Where the package takes 8 strips below still water and 9 along a pontoon, OpenFAST has 8 and 10.
    """
    count = {8: 8, 9: 10}[order]
    weight = np.full(count + 1, 2 / count)
    weight[[0, -1]] /= 2
    return np.linspace(-1, 1, count + 1), weight


class OpenFASTSea(jh.IrregularSea):
    """As OpenFAST's: without set-down.

    `grid` (m) is that of its kinematics along the waves, which it takes from four grid points by a cubic (0: exact).
    """

    grid: float = eqx.field(static=True, default=0.0)

    def prepared(self, *arguments: Any, **options: Any) -> Any:
        with _without_set_down():
            sea = super().prepared(*arguments, **options)
        return GridSea(sea, self.grid) if self.grid else sea


@contextlib.contextmanager
def _without_set_down() -> Iterator[None]:
    """Second order without the differences of components and themselves.

    Such pairs are pointed to waves that bind nothing.
    """
    tiles, spectrum = pair_sums._tiles, shared_preparation._spectrum.__wrapped__

    def fewer(n: int, *arguments: Any) -> Any:
        pairs = tiles(n, *arguments)
        return eqx.tree_at(lambda t: t.i, pairs, jnp.where((pairs.sign < 0) & (pairs.harmonic == 0), n, pairs.i))

    anew = eqx.filter_jit(lambda *a: spectrum(*a))  # nothing that was traced with all pairs
    with mock.patch.object(pair_sums, "_tiles", fewer), mock.patch.object(shared_preparation, "_spectrum", anew):
        yield


class GridSea(jh.AbstractSea):
    """A sea whose flow and surface come from a grid along x, by Catmull and Rom's cubic."""

    inner: SupportSea
    spacing: float = eqx.field(static=True)

    @property
    def along(self) -> jax.Array:
        return self.inner.along

    @property
    def middle(self) -> jax.Array:
        return self.inner.middle

    @property
    def half(self) -> float:
        return self.inner.half

    def _around(self, points: jax.Array) -> tuple[jax.Array, list[jax.Array]]:
        position = points[0] / self.spacing
        low = jnp.floor(position)
        s = position - low
        inner = [1 + s**2 * (1.5 * s - 2.5), 0.5 * s * (1 + s * (4 - 3 * s))]
        weights = [0.5 * s * (s * (2 - s) - 1), *inner, 0.5 * s**2 * (s - 1)]
        neighbours = [jnp.concatenate([((low + i) * self.spacing)[None], points[1:]]) for i in (-1, 0, 1, 2)]
        return jnp.concatenate(neighbours, axis=1), weights

    def _mixed(self, field: jax.Array, weights: list[jax.Array]) -> jax.Array:
        return sum(part * weight for part, weight in zip(jnp.split(field, 4, axis=-1), weights, strict=True))

    def elevation(self, time: jax.Array, points: jax.Array) -> jax.Array:
        neighbours, weights = self._around(points)
        return self._mixed(self.inner.elevation(time, neighbours), weights)

    def surface(self, time: jax.Array, points: jax.Array) -> jax.Array | None:
        return None if self.inner.stretching == "none" else self.elevation(time, points)

    def flow(self, time: jax.Array, points: jax.Array, cylinders: Cylinders | None = None) -> Flow:
        neighbours, weights = self._around(points)
        four = None if cylinders is None else dataclasses.replace(cylinders, radius_index=cylinders.radius_index * 4)
        return jax.tree.map(lambda field: self._mixed(field, weights), self.inner.flow(time, neighbours, four).earth())


def sea(run: Run, grid: bool = False) -> OpenFASTSea:
    """OpenFAST's sea; the `grid` is that of its file."""
    width = run.setup["XH"] / (run.setup["NX"] - 1)
    options = {"highest_difference": run.setup["whiD"] / (2 * np.pi), "grid": width if grid else 0.0}
    return OpenFASTSea(run.waves, WATER, run.case.order, run.case.stretching, **options)


def plain(run: Run, order: int = 2, stretching: str = "vertical") -> jh.IrregularSea:
    """The same components in a sea of this package's own: all pairs and the set-down."""
    return jh.IrregularSea(run.waves, WATER, order, stretching)


def direct(run: Run) -> jh.WaveSea:
    """The few components of its `comp` sea and their pairs, summed."""
    present = np.flatnonzero(np.asarray(run.waves.amplitude))
    waves = run.waves
    few = components(waves.amplitude[present], waves.omega[present], WATER, phase=waves.phase[present])
    bound = second_order.bound_waves(few, WATER, set_down=False) if run.case.order == 2 else None
    return jh.WaveSea(PlaneWaves.free(few, WATER), WATER, 0.0, run.case.stretching, bound)


@eqx.filter_jit
def _loads(held: jh.Model, waves: jh.AbstractSea, times: jax.Array) -> jax.Array:
    def one(time: jax.Array) -> jax.Array:
        state = held.rest()
        return held.sum_of_loads(held.instant(time, state, waves), state.memory).force

    return jax.lax.map(one, times, batch_size=64)


def loads(run: Run, every: int = 2, waves: jh.AbstractSea | None = None, **options: Any) -> dict[str, dict[str, float]]:
    """Forces on the platform held upright against OpenFAST's.

    Returns:
        By force: `rms` and `mean` of the difference over the deviation of OpenFAST's force, and the `slope`.
    """
    forces = np.array(_loads(model(run, **options), direct(run) if waves is None else waves, run.table["Time"][::every]))
    forces[:, 2] += run.setup["mass"] * WATER.gravity  # HydroDyn's loads are without the weight
    result = {}
    for name, (i, channel) in LOADS.items():
        series = run.table[channel][::every]
        missed = forces[:, i] - series
        size = series.std()
        result[name] = {
            "rms": float(np.sqrt((missed**2).mean()) / size),
            "mean": float(missed.mean() / size),
            "slope": float(np.polyfit(series, forces[:, i], 1)[0]),
        }
    return result


def motion(run: Run, waves: jh.AbstractSea, until: float = np.inf, step: float | None = None, **options: Any) -> Any:
    """Times (s) and motions (m, deg) from rest at the origin, at every second of OpenFAST's times."""
    times = run.table["Time"][::2]
    times = times[times <= until]
    motions = jh.simulate(model(run, **options), times, waves, position=jnp.zeros(6), step=step)
    return times, {dof: np.asarray(motions[dof]) * (1 if dof in jh.DOFS[:3] else 180 / np.pi) for dof in jh.DOFS}


def missed(run: Run, times: np.ndarray, motions: dict[str, np.ndarray]) -> dict[str, float]:
    """Root mean square difference of each motion over OpenFAST's standard deviation (-)."""
    openfast = {dof: run.table[channel][::2][: times.size] for dof, channel in CHANNELS.items()}
    return {dof: float(np.sqrt(((motions[dof] - x) ** 2).mean()) / x.std()) for dof, x in openfast.items()}
