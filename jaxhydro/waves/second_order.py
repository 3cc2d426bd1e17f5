"""Second-order waves bound by pairs of first-order components, at sums and differences of frequencies.

Sharma and Dean (1981), SPE Journal 21, 604-612, equations for E and Phi below; written out for offshore wind by Agarwal and
Manuel (2011), Engineering Structures 33, 1246-1257. The mean flow of equal frequencies, which the theory leaves free, is
zero.
"""

import dataclasses
import math
from collections.abc import Sequence
from typing import Literal

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from jaxhydro.choices import check
from jaxhydro.environment import Environment
from jaxhydro.quick_jit import as_data, quick_jit
from jaxhydro.waves.components import Components, PlaneWaves

Kind = Literal["sum", "difference"]
Wave = tuple[Float[Array, " n"], Float[Array, "2 n"]]
"""Angular frequencies (rad/s) and wavenumber vectors (rad/m)."""

KINDS: tuple[Kind, ...] = ("sum", "difference")
SIGN = {"sum": 1.0, "difference": -1.0}
MIN_BEAT = 1e-9  # beats slower than this part of their frequencies are those of equal frequencies, but for rounding


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
    return transfer_of_sign(first, second, environment, SIGN[kind])


def transfer_of_sign(
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


def below_highest(beat: Float[Array, "..."], highest: float) -> Bool[Array, "..."]:
    """Whether difference frequencies (rad/s) are at most `highest` (Hz), up to rounding."""
    return beat <= 2 * math.pi * highest * (1 + 1e-9)


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
            weight = jnp.where(below_highest(jnp.abs(beat), highest_difference), weight, 0.0)
        turn = jnp.where(beat < 0, -1.0, 1.0)  # Re of the conjugate: i phi changes its sign
        weight = jnp.where(beat < 0, jnp.conj(weight), weight)
        bound.append(PlaneWaves(turn * beat, turn * (vector[:, i] - vector[:, j]), weight * e, turn * weight * phi))
        if set_down:
            e, _ = transfer((omega, vector), (omega, vector), environment, "difference")
            mean = 0.5 * (amplitude * jnp.conj(amplitude) * e).sum()[None]
            bound.append(PlaneWaves(jnp.zeros(1), jnp.zeros((2, 1)), mean, jnp.zeros(1, complex)))
    return sum(bound[1:], bound[0])
