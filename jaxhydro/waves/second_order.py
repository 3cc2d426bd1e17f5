"""Second-order waves bound by pairs of first-order components, at sums and differences of frequencies.

Sharma and Dean (1981), SPE Journal 21, 604-612, equations for E and Phi below; written out for offshore wind by Agarwal and
Manuel (2011), Engineering Structures 33, 1246-1257. The mean flow of equal frequencies, which the theory leaves free, is
zero.
"""

import dataclasses
import math
from collections.abc import Callable, Sequence
from typing import Any, Literal

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Complex, Float, Int, PyTree

from jaxhydro.choices import check
from jaxhydro.environment import Environment
from jaxhydro.quick_jit import as_data, quick_jit
from jaxhydro.waves.components import Components, PlaneWaves

Kind = Literal["sum", "difference"]
Wave = tuple[Float[Array, " n"], Float[Array, "2 n"]]
"""Angular frequencies (rad/s) and wavenumber vectors (rad/m)."""
Reduce = Callable[[Float[Array, " n"], Float[Array, "2 n"], Complex[Array, " n"], Complex[Array, " n"]], PyTree]
"""From the four fields of `PlaneWaves` of some pairs to sums over them, linear in the last two."""

KINDS: tuple[Kind, ...] = ("sum", "difference")
SIGN = {"sum": 1.0, "difference": -1.0}
MIN_BEAT = 1e-9  # beats slower than this part of their frequencies are those of equal frequencies, but for rounding
TILE = 128  # pairs at a time in `sum_over_pairs`: long enough for the overhead of a step, short enough for the cache


def transfer(first: Wave, second: Wave, environment: Environment, kind: Kind) -> tuple[Float[Array, " n"], Float[Array, " n"]]:
    """Quadratic transfer functions of bound waves: elevation E (1/m) and potential Phi (1/s) of pairs.

    Waves A_i exp(i theta_i) and A_j exp(i theta_j) bind one entry of `PlaneWaves`. Its frequency is omega_i ± omega_j, its
    vector k_i ± k_j, its elevation E A_i A_j (sum) or E A_i conj(A_j) (difference), and its potential alike. That is the
    whole of the pair, (i, j) and (j, i) together; a wave with itself has half. A wave of frequency 0 binds nothing.

    Args:
        first: Angular frequencies (rad/s), (n,), and wavenumber vectors (rad/m), (2, n), of waves i.
        second: The same of waves j.
        environment: Water depth and gravity.
        kind: "sum" or "difference".

    Returns:
        E and Phi, (n,) each.

    References:
        Sharma and Dean (1981), SPE Journal 21, 604-612.
    """
    check(kind=(kind, KINDS))
    return _transfer(first, second, environment, SIGN[kind])


def _transfer(
    first: Wave, second: Wave, environment: Environment, sign: Float[Array, ""] | float
) -> tuple[Float[Array, " n"], Float[Array, " n"]]:
    """`transfer`, by the sign of the second frequency.

    At z = 0, with s the sign, omega = omega_i + s omega_j, k = k_i + s k_j,

        K = g k . (k_i / omega_i + k_j / omega_j) / 2                              from -div(eta grad phi)
        D = (omega_i^2 + omega_j^2 + s omega_i omega_j - g^2 k_i . k_j / (omega_i omega_j)) / 2
                                                                                   from -eta phi_tz - |grad phi|^2 / 2
        omega E - |k| tanh(|k|h) Phi = K,    g E - omega Phi = D:

    Sharma and Dean's D+- and B+- solved for, in a form that neither overflows nor cancels where k -> 0.
    """
    (omega_i, k_i), (omega_j, k_j) = first, second
    g = environment.gravity
    exist = (omega_i > 0) & (omega_j > 0)
    inverse_i, inverse_j = 1 / jnp.where(exist, omega_i, 1.0), 1 / jnp.where(exist, omega_j, 1.0)
    omega, k = omega_i + sign * omega_j, k_i + sign * k_j
    kinematic = 0.5 * g * (k * (k_i * inverse_i + k_j * inverse_j)).sum(axis=0)
    dynamic = 0.5 * (
        omega_i**2 + omega_j**2 + sign * omega_i * omega_j - g**2 * inverse_i * inverse_j * (k_i * k_j).sum(axis=0)
    )
    square = (k**2).sum(axis=0)
    size = jnp.sqrt(jnp.where(square > 0, square, 1.0))
    # equal frequencies: K = 0 whatever the headings, and of one heading nothing but a constant is left
    moving = exist & (square > 0) & (jnp.abs(omega) > MIN_BEAT * (omega_i + omega_j))
    detuning = jnp.where(moving, omega**2 - g * size * jnp.tanh(size * environment.depth), 1.0)
    potential = jnp.where(moving, (g * kinematic - omega * dynamic) / detuning, 0.0)
    return jnp.where(exist, (dynamic + omega * potential) / g, 0.0), potential


def bound_waves(
    waves: Components,
    environment: Environment,
    kinds: Sequence[Kind] = KINDS,
    set_down: bool = True,
    highest_difference: float | None = None,
) -> PlaneWaves:
    """Second-order waves of all pairs of components: exact, one entry per pair.

    A difference is ordered so that its frequency is not negative. Equal frequencies of two headings leave a standing pattern
    of elevation, omega = 0 with k not 0, without flow.

    Args:
        waves: First-order components.
        environment: Water depth and gravity.
        kinds: "sum", "difference" or both.
        set_down: Whether differences include those of components with themselves (one entry).
        highest_difference: Highest difference frequency (Hz); None: all.

    Returns:
        The bound waves.

    Raises:
        UnknownName: Another kind.
    """
    for kind in kinds:
        check(kinds=(kind, KINDS))
    water = jax.tree.map(as_data, environment)
    return _bound_waves(dataclasses.replace(waves, first=None), water, tuple(kinds), set_down, highest_difference)


@quick_jit
def _bound_waves(
    waves: Components, environment: Environment, kinds: Sequence[Kind], set_down: bool, highest_difference: float | None
) -> PlaneWaves:
    """Bound waves of some kinds, in one compiled program."""
    omega, vector, amplitude = waves.omega, waves.vector(), waves.complex_amplitude()
    bound = []
    if "sum" in kinds:
        i, j = np.tril_indices(omega.size)
        weight = jnp.where(i == j, 0.5, 1.0) * amplitude[i] * amplitude[j]
        e, phi = transfer((omega[i], vector[:, i]), (omega[j], vector[:, j]), environment, "sum")
        bound.append(PlaneWaves(omega[i] + omega[j], vector[:, i] + vector[:, j], weight * e, weight * phi))
    if "difference" in kinds:
        i, j = np.tril_indices(omega.size, -1)
        e, phi = transfer((omega[i], vector[:, i]), (omega[j], vector[:, j]), environment, "difference")
        weight = amplitude[i] * jnp.conj(amplitude[j])
        beat = omega[i] - omega[j]
        if highest_difference is not None:
            weight = jnp.where(_binds(jnp.abs(beat), highest_difference), weight, 0.0)
        turn = jnp.where(beat < 0, -1.0, 1.0)  # Re of the conjugate: i phi changes its sign
        weight = jnp.where(beat < 0, jnp.conj(weight), weight)
        bound.append(PlaneWaves(turn * beat, turn * (vector[:, i] - vector[:, j]), weight * e, turn * weight * phi))
        if set_down:
            e, _ = transfer((omega, vector), (omega, vector), environment, "difference")
            mean = 0.5 * (amplitude * jnp.conj(amplitude) * e).sum()[None]
            bound.append(PlaneWaves(jnp.zeros(1), jnp.zeros((2, 1)), mean, jnp.zeros(1, complex)))
    return sum(bound[1:], bound[0])


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


def _binds(beat: Float[Array, "..."], highest: float) -> Bool[Array, "..."]:
    """Whether difference frequencies (rad/s) are at most `highest` (Hz), up to rounding."""
    return beat <= 2 * math.pi * highest * (1 + 1e-9)


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
        ValueError: The components are not successive harmonics of a period.
    """
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
        e, phi = _transfer((wave_i[1], wave_i[2:]), (wave_j[1], wave_j[2:]), environment, tile.sign)
        weight = jnp.where(wave_i[0] == wave_j[0], 0.5, 1.0) * jax.lax.complex(a[0], a[1])
        weight = weight * jax.lax.complex(b[0], tile.sign * b[1])
        omega = jnp.broadcast_to(tile.harmonic * fundamental, (width,))
        if highest_difference is not None:
            weight = jnp.where((tile.sign > 0) | _binds(omega, highest_difference), weight, 0.0)
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
    moved = Components(waves.amplitude, waves.omega, waves.wavenumber, waves.heading, phase, waves.first)

    def reduce(*pairs: Any) -> Complex[Array, ""]:
        return pairs[2].sum()

    return sum_over_pairs(moved, environment, reduce, kinds, highest_difference)
