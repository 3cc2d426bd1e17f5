"""Periodic continuation of a wave record, so that its Fourier components do not ring at its ends."""

import jax.numpy as jnp
import numpy as np
from jax.scipy.sparse.linalg import cg
from jaxtyping import Array, Float

RIDGE = 1e-4  # share of the continuation's energy that counts beside what is outside the band
ACCURACY, MAX_ITERATIONS = 1e-6, 1000  # of the equations, and of conjugate gradients
END_LENGTH = 3.0  # of the shortest waves: how far from an end a record rings most
MIN_RINGING = 2.0  # times what the components of a continued record miss there: a record whose own miss more is continued


def continued(record: Float[np.ndarray, " t"], step: float, low: float, cutoff: float, length: int) -> Float[np.ndarray, " n"]:
    """A wave record and its most likely continuation until it repeats.

    Of all continuations p it is the one with the least energy outside the band, and little energy of its own: it minimises
    |(1 - B)(x, p)|² + `RIDGE` |p|² with B the band-pass over record and continuation. So (1 - B)_pp p + RIDGE p = B_px x.
    Without a ridge it is Papoulis' limit, for a record whose noise and bound waves outside the band are left as they are.

    The record is returned alone where its end meets its start: where its content above the band is no larger there than
    elsewhere, or where the continuation would not improve its ends.

    Args:
        record: Elevation (m) at even steps, of mean 0, (t,).
        step: Sampling interval (s).
        low: Lower limit of the band (Hz).
        cutoff: Upper limit of the band (Hz).
        length: Number of samples after which the continued record repeats.

    Returns:
        The record continued to `length` samples (m), or the record.

    References:
        Papoulis (1975), IEEE Transactions on Circuits and Systems 22, 735-742.
    """
    count = len(record)
    edge = int(np.ceil(1 / (cutoff * step)))
    above = np.abs(record - _band_passed(record, step, 0.0, cutoff))
    if count <= 4 * edge or max(above[:edge].max(), above[-edge:].max()) <= above[edge:-edge].max():
        return record
    inside = jnp.asarray(_inside(length, step, low, cutoff))

    def passed(continuation: Float[Array, " p"], beside: Float[Array, " t"]) -> Float[Array, " p"]:
        whole = jnp.concatenate([beside, continuation])
        return jnp.fft.irfft(inside * jnp.fft.rfft(whole), length)[count:]

    none, nothing = jnp.zeros(length - count), jnp.zeros(count)
    extension = cg(
        lambda p: (1 + RIDGE) * p - passed(p, nothing), passed(none, jnp.asarray(record)), tol=ACCURACY, maxiter=MAX_ITERATIONS
    )[0]
    whole = np.concatenate([record, np.asarray(extension)])
    near = min(int(np.ceil(END_LENGTH / (cutoff * step))), count // 2)
    ends = np.r_[:near, count - near : count]
    missed = [float(np.linalg.norm((x - _band_passed(x, step, low, cutoff))[ends])) for x in (record, whole)]
    return whole if missed[0] > MIN_RINGING * missed[1] else record


def _inside(count: int, step: float, low: float, cutoff: float) -> np.ndarray:
    frequency, rounding = np.fft.rfftfreq(count, step), 1e-6 / (count * step)
    return ((frequency >= low - rounding) & (frequency <= cutoff + rounding)).astype(float)


def _band_passed(values: np.ndarray, step: float, low: float, cutoff: float) -> np.ndarray:
    return np.fft.irfft(_inside(len(values), step, low, cutoff) * np.fft.rfft(values), len(values))
