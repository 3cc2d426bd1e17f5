"""The squared envelope of first-order waves on a clock: what slow second-order forces go with."""

import math

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.environment import Environment
from jaxhydro.waves.components import Components
from jaxhydro.waves.transfer import Transfer


class Envelope(eqx.Module):
    """`AbstractSea.drift` on a clock: `series` (m2; N, N m) step by step, read `lead` (s) ahead; `slowness` (s/m) is the
    inverse of the group velocity, by energy."""

    series: Float[Array, "t d"]
    slowness: Float[Array, ""]
    lead: Float[Array, ""]

    def at(self, steps: Float[Array, ""]) -> Float[Array, " d"]:
        """`steps` after the first, of any fraction, by the cubic through four of them; held beyond both ends."""
        last = self.series.shape[0] - 1
        place = jnp.clip(steps, 0.0, last)
        base = jnp.clip(jnp.floor(place).astype(int) - 1, 0, max(last - 3, 0))
        t = place - base
        share = jnp.stack(
            [
                (1 - t) * (t - 2) * (t - 3) / 6,
                t * (t - 2) * (t - 3) / 2,
                t * (1 - t) * (t - 3) / 2,
                t * (t - 1) * (t - 2) / 6,
            ]
        )
        return share @ self.series[jnp.minimum(base + jnp.arange(4), last)]


@eqx.filter_jit
def envelope(
    waves: Components,
    environment: Environment,
    weight: Float[Array, " w"],
    share: Float[Array, " t"],
    size: int,
    start: Float[Array, ""],
    transfer: Transfer | None = None,
) -> Envelope:
    """|a|^2, its Hilbert transform, Re(a_w conj(a)) and the mean of |a|^2, a the complex elevation at the origin and a_w that
    with components times `weight`, and the six forces of a `transfer`, times `share`, at steps from `start` (s) on of which
    `size` are a period.

    By products over one period at so many times that every difference of frequencies has a place of its own.
    """
    n, amplitude = waves.omega.size, waves.complex_amplitude()
    count = 1 << (2 * n - 1).bit_length()
    one, weighted = jnp.fft.ifft(jnp.stack([amplitude, weight * amplitude]), n=count) * count
    products = jnp.stack([one * one.conj(), weighted * one.conj()]).real
    if transfer is not None:
        filtered = jnp.fft.ifft(transfer.at(waves.omega) * amplitude, n=count) * count
        products = jnp.concatenate([products, transfer.force(filtered)])
    found = jnp.fft.rfft(products)[:, :n] / count
    beats = found * jnp.where(jnp.arange(n) > 0, 2.0, 1.0)
    shifted, mean = (-1j * beats[0]).at[0].set(0.0), (0.0 * beats[0]).at[0].set(beats[0, 0])
    turn = jnp.exp(1j * 2 * math.pi / waves.period * jnp.arange(n) * start)
    rows = jnp.concatenate([jnp.stack([beats[0], shifted, beats[1], mean]), beats[2:]])
    series = (jnp.fft.ifft(rows * turn, n=size) * size).real
    depths = waves.wavenumber * environment.depth
    tanh = jnp.tanh(depths)
    slow = 2 * waves.omega / (environment.gravity * (tanh + depths * (1 - tanh**2)))
    energy = waves.amplitude**2
    total = jnp.where(energy.sum() > 0, energy.sum(), 1.0)
    kept = np.arange(share.shape[0]) % size
    return Envelope(share[:, None] * series[:, kept].T, (energy * slow).sum() / total, jnp.zeros(()))
