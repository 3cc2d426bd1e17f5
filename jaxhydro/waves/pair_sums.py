"""Sums over all pairs of first-order components, harmonic by harmonic, without a table of the pairs.

Components are successive harmonics of a period: pairs of one sum or difference fall on one harmonic.
"""

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Complex, Float, Int, PyTree

from jaxhydro.choices import check
from jaxhydro.environment import Environment
from jaxhydro.waves.components import Components
from jaxhydro.waves.second_order import KINDS, Kind, below_highest, bound_waves, transfer_of_sign

Reduce = Callable[[Float[Array, " n"], Float[Array, "2 n"], Complex[Array, " n"], Complex[Array, " n"]], PyTree]
"""From the four fields of `PlaneWaves` of some pairs to sums over them, linear in the last two."""
TILE = 128  # pairs at a time in `sum_over_pairs`: long enough for the overhead of a step, short enough for the cache


class _Tiles(eqx.Module):
    """First indices in `_padded` of runs of pairs of one frequency, with their sign and harmonic."""

    i: Int[Array, " t"]
    j: Int[Array, " t"]
    sign: Float[Array, " t"]
    harmonic: Int[Array, " t"]


def _tiles(n: int, first: int, kinds: Sequence[Kind], width: int) -> _Tiles:
    """Pairs i >= j of n harmonics from `first` on, in runs of `width` pairs of one frequency.

    Runs go along anti-diagonals for sums, along diagonals for differences.
    """
    parts = []
    for kind in kinds:
        check(kinds=(kind, KINDS))
    if "sum" in kinds:
        lag = np.arange(2 * n - 1)
        high, low = (lag + 1) // 2, lag // 2  # outwards from the diagonal
        parts.append((high, n + width + n - 1 - low, np.minimum(n - 1 - high, low) + 1, 2 * first + lag, 1.0))
    if "difference" in kinds:
        lag = np.arange(n)
        parts.append((lag, 0 * lag, n - lag, lag, -1.0))
    blocks = []
    for i, j, count, harmonic, sign in parts:
        runs = -(-count // width)
        lag = np.repeat(np.arange(count.size), runs)
        begin = width * (np.arange(lag.size) - np.repeat(np.cumsum(runs) - runs, runs))
        blocks.append((i[lag] + begin, j[lag] + begin, np.full(lag.size, sign), harmonic[lag]))
    return _Tiles(*(jnp.asarray(np.concatenate(column)) for column in zip(*blocks, strict=True)))


def _padded(rows: Float[Array, "r n"], width: int) -> Float[Array, "r m"]:
    """Rows forwards and backwards, each followed by `width` zeros (waves that bind nothing)."""
    zeros = jnp.zeros((rows.shape[0], width))
    return jnp.concatenate([rows, zeros, rows[:, ::-1], zeros], axis=1)


def sum_over_pairs(
    waves: Components,
    environment: Environment,
    reduce: Reduce,
    kinds: Sequence[Kind] = KINDS,
    highest_difference: float | None = None,
) -> PyTree:
    """Sums over the pairs of each frequency b 2 pi / period, stacked for b = 0 ... 2 last.

    `reduce(omega, vector, elevation, potential)` gets up to `TILE` pairs of one frequency at a time and returns a pytree of
    arrays summed over them. Some of these pairs are empty and have no amplitude. `reduce` must be linear in elevation and
    potential, and finite where omega and vector are 0. There b = 0 is the set-down; the vector of empty pairs has no
    meaning. Memory is that of the result, also for gradients.

    Args:
        waves: First-order components on successive harmonics.
        environment: Water depth and gravity.
        reduce: Sum over some pairs.
        kinds: "sum", "difference" or both.
        highest_difference: Highest difference frequency (Hz), as OpenFAST's `WvHiCOffD`; None: all.

    Returns:
        The pytree of `reduce`, with a leading axis over b.

    Raises:
        ValueError: The components are not successive harmonics of a period, or are several wave trains.
    """
    if waves.trains > 1:
        raise ValueError(f"components of one wave train expected, found {waves.trains}: see `bound_waves`")
    n, (first, last) = waves.omega.size, waves.harmonics
    width = min(n, TILE)
    amplitude, index = waves.complex_amplitude(), jnp.arange(n, dtype=float)
    # apart, so that derivatives by amplitudes leave the transfer functions alone
    tables = (
        _padded(jnp.stack([index, waves.omega, *waves.vector()]), width),
        _padded(jnp.stack([amplitude.real, amplitude.imag]), width),
    )
    fundamental = waves.omega[-1] / last

    def sums(tables: tuple[Float[Array, "4 m"], Float[Array, "2 m"]], tile: _Tiles) -> PyTree:
        (wave_i, a), (wave_j, b) = (
            [jax.lax.dynamic_slice_in_dim(table, start, width, axis=1) for table in tables] for start in (tile.i, tile.j)
        )
        e, phi = transfer_of_sign((wave_i[1], wave_i[2:]), (wave_j[1], wave_j[2:]), environment, tile.sign)
        weight = jnp.where(wave_i[0] == wave_j[0], 0.5, 1.0) * jax.lax.complex(a[0], a[1])
        weight = weight * jax.lax.complex(b[0], tile.sign * b[1])
        omega = jnp.broadcast_to(tile.harmonic * fundamental, (width,))
        if highest_difference is not None:
            weight = jnp.where((tile.sign > 0) | below_highest(omega, highest_difference), weight, 0.0)
        return reduce(omega, wave_i[2:] + tile.sign * wave_j[2:], weight * e, weight * phi)

    def step(total: PyTree, tile: _Tiles) -> tuple[PyTree, None]:
        # pairs are worked out again for gradients: kept, they are the square of the components
        partial = jax.checkpoint(sums, prevent_cse=False)(tables, tile)
        return jax.tree.map(lambda t, f: t.at[tile.harmonic].add(f), total, partial), None

    tiles = _tiles(n, first, kinds, width)
    shapes = jax.eval_shape(sums, tables, jax.tree.map(lambda x: x[0], tiles))
    empty = jax.tree.map(lambda s: jnp.zeros((2 * last + 1, *s.shape), s.dtype), shapes)
    return jax.lax.scan(step, empty, tiles)[0]


def elevation_spectrum(
    waves: Components,
    environment: Environment,
    position: tuple[float, float] | Float[Array, "2"],
    kinds: Sequence[Kind] = KINDS,
    highest_difference: float | None = None,
) -> Complex[Array, " b"]:
    """Second-order elevation at a horizontal position, by harmonic.

    eta = Re sum c_b exp(i b 2 pi t / period).

    Args:
        waves: First-order components on successive harmonics.
        environment: Water depth and gravity.
        position: Horizontal position (m, earth axes).
        kinds: "sum", "difference" or both.
        highest_difference: Highest difference frequency (Hz); None: all.

    Returns:
        c_b (m) for b = 0 ... 2 last; c_0 is the set-down.

    Raises:
        ValueError: The components are not successive harmonics of a period.
    """
    phase = waves.phase - jnp.asarray(position, float) @ waves.vector()  # phases move with the components: nothing per pair
    moved = dataclasses.replace(waves, phase=phase)
    if waves.trains > 1:  # few components: all pairs are summed
        last = waves.harmonics[1]
        bound = bound_waves(moved, environment, kinds, highest_difference=highest_difference)
        harmonic = jnp.rint(bound.omega / waves.omega[0] * waves.harmonics[0]).astype(int)
        return jnp.zeros(2 * last + 1, complex).at[harmonic].add(bound.elevation)

    def reduce(*pairs: Any) -> Complex[Array, ""]:
        return pairs[2].sum()

    return sum_over_pairs(moved, environment, reduce, kinds, highest_difference)
