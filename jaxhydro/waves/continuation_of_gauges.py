"""Periodic continuation of records of several gauges by waves that run past all of them."""

import jax
import jax.numpy as jnp
import numpy as np
from jax.scipy.sparse.linalg import cg
from jaxtyping import Array, Complex, Float, Int

RIDGE = 1e-4  # of each squared amplitude beside the squared errors: amplitudes that only the continuation has stay small
ACCURACY, MAX_ITERATIONS = 1e-5, 1000  # of the equations, and of conjugate gradients


def continued_together(
    records: Float[np.ndarray, "g t"],
    numbers: Int[np.ndarray, " w"],
    turn: Complex[np.ndarray, "w g 2"],
    prior: float,
    length: int,
) -> list[Float[np.ndarray, " n"]]:
    """Records of gauges in line with the waves, and their most likely continuation until they repeat.

    Incident and reflected waves on the harmonics of the longer period are fitted to the samples of all records: with x the
    amplitudes and E the elevations at the gauges, they minimise 2/t |records - E x|² + prior |x_R|² + RIDGE |x|². The
    continuation is E x after the records. Continued one by one, records would not belong to the same waves, and the
    difference would be taken for reflection.

    Args:
        records: Elevations (m) of mean 0 at even steps, (g, t).
        numbers: Numbers of the harmonics of the waves, successive, (w,).
        turn: Amplitude at each gauge of an incident and of a reflected wave of unit amplitude, (w, g, 2).
        prior: Weight of the squared reflected amplitudes.
        length: Number of samples after which the continued records repeat.

    Returns:
        The record of each gauge and its continuation (m), (n,) each.
    """
    count = records.shape[1]
    weight = jnp.asarray([RIDGE, RIDGE + prior])
    towards, back = jnp.asarray(turn), jnp.asarray(turn.conj())

    def elevation(x: Float[Array, "2 w 2"]) -> Float[Array, "g n"]:
        at_gauges = jnp.einsum("wgd,wd->gw", towards, jax.lax.complex(x[0], x[1]))
        spectrum = jnp.zeros((len(records), length // 2 + 1), complex).at[:, numbers].set(at_gauges)
        return jnp.fft.irfft(0.5 * length * spectrum, length)

    def adjoint(values: Float[Array, "g t"]) -> Float[Array, "2 w 2"]:
        lines = jnp.fft.rfft(values, length)[:, numbers]
        x = jnp.einsum("wgd,gw->wd", back, lines)
        return 2 / count * jnp.stack([x.real, x.imag])

    fitted = cg(
        lambda x: adjoint(elevation(x)[:, :count]) + weight * x,
        adjoint(jnp.asarray(records)),
        tol=ACCURACY,
        maxiter=MAX_ITERATIONS,
    )[0]
    return [np.concatenate([record, more]) for record, more in zip(records, np.asarray(elevation(fitted))[:, count:])]
