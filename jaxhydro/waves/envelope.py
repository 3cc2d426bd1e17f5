"""Squared envelope of first-order waves over time, for slow second-order forces."""

import math

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.environment import Environment
from jaxhydro.exported_programs import exported_jit
from jaxhydro.waves.components import Components
from jaxhydro.waves.quadratic_transfer import Transfer


class Envelope(eqx.Module):
    """`AbstractSea.drift` at the steps of a clock.

    Attributes:
        series: Squared envelopes (m²) and forces (N, N m) by step, (t, d).
        slowness: Inverse of the group velocity (s/m), weighted by energy.
        lead: Time (s) by which the series is read ahead.
    """

    series: Float[Array, "t d"]
    slowness: Float[Array, ""]
    lead: Float[Array, ""]

    def at(self, steps: Float[Array, ""]) -> Float[Array, " d"]:
        """Values at a fractional number of steps after the first, by cubic interpolation.

        Beyond the ends they are constant.
        """
        last = self.series.shape[0] - 1
        clipped = jnp.clip(steps, 0.0, last)
        base = jnp.clip(jnp.floor(clipped).astype(int) - 1, 0, max(last - 3, 0))
        t = clipped - base
        share = jnp.stack(
            [
                (1 - t) * (t - 2) * (t - 3) / 6,
                t * (t - 2) * (t - 3) / 2,
                t * (1 - t) * (t - 3) / 2,
                t * (t - 1) * (t - 2) / 6,
            ]
        )
        return share @ self.series[jnp.minimum(base + jnp.arange(4), last)]


@exported_jit
def envelope(
    waves: Components,
    environment: Environment,
    weight: Float[Array, " w"],
    share: Float[Array, " t"],
    size: int,
    start: Float[Array, ""],
    transfer: Transfer | None = None,
) -> Envelope:
    """Squared envelopes, and difference-frequency forces, of first-order waves at the origin.

    With a the complex elevation and a_w that of components times `weight`, the rows are: |a|², its Hilbert transform, Re(a_w
    conj(a)), the mean of |a|², and the six forces of `transfer`. They are products over one period at so many times that
    every difference of frequencies is resolved.

    Args:
        waves: Components on successive harmonics of a period.
        environment: Water depth and gravity.
        weight: Weight of each component, (w,).
        share: Factor at each step, (t,).
        size: Number of steps in a period.
        start: Time of the first step (s).
        transfer: Difference-frequency transfer function, or None.
    """
    n, amplitude = waves.omega.size, waves.complex_amplitude()
    count = 1 << (2 * n - 1).bit_length()
    elevation, weighted = jnp.fft.ifft(jnp.stack([amplitude, weight * amplitude]), n=count) * count
    products = jnp.stack([elevation * elevation.conj(), weighted * elevation.conj()]).real
    if transfer is not None:
        filtered = jnp.fft.ifft(transfer.at(waves.omega) * amplitude, n=count) * count
        products = jnp.concatenate([products, transfer.force(filtered)])
    spectra = jnp.fft.rfft(products)[:, :n] / count
    beats = spectra * jnp.where(jnp.arange(n) > 0, 2.0, 1.0)
    shifted, mean = (-1j * beats[0]).at[0].set(0.0), (0.0 * beats[0]).at[0].set(beats[0, 0])
    turn = jnp.exp(1j * 2 * math.pi / waves.period * jnp.arange(n) * start)
    rows = jnp.concatenate([jnp.stack([beats[0], shifted, beats[1], mean]), beats[2:]])
    series = (jnp.fft.ifft(rows * turn, n=size) * size).real
    depths = waves.wavenumber * environment.depth
    tanh = jnp.tanh(depths)
    slow = 2 * waves.omega / (environment.gravity * (tanh + depths * (1 - tanh**2)))
    energy = waves.amplitude**2
    total = jnp.where(energy.sum() > 0, energy.sum(), 1.0)
    index = np.arange(share.shape[0]) % size
    return Envelope(share[:, None] * series[:, index].T, (energy * slow).sum() / total, jnp.zeros(()))
