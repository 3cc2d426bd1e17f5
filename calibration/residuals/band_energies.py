"""Energies of motions in bands, or in cells of a band."""

from collections.abc import Sequence
from itertools import pairwise

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from jaxhydro.analysis.spectral import SEGMENT, band_weights
from jaxhydro.quick_jit import on_device

CELLS_PER_BAND = 8  # at most
MIN_CELL_CYCLES = 10.0  # width of a cell times the length of the record
MIN_ENERGY_SHARE = 0.01  # of the energy of the largest cell


class BandEnergies(eqx.Module):
    """Integrals of a motion's spectrum over bands, as in `BandWeights`, and their measured values.

    Attributes:
        starts: First sample of each segment, (g,).
        window: Window, (s,).
        weight: Weight of each frequency from `first` on, a row for each band, (b, f).
        measured: Measured integrals (m2, rad2), (b,).
        first: Index of the first frequency that has a weight.
    """

    starts: Int[Array, " g"]
    window: Float[Array, " s"]
    weight: Float[Array, "b f"]
    measured: Float[Array, " b"]
    first: int = eqx.field(static=True)

    def of(self, x: Float[Array, " n"]) -> Float[Array, " b"]:
        """The integrals (m2, rad2) of a motion."""
        parts = x[self.starts[:, None] + jnp.arange(self.window.shape[0])]
        lines = jnp.fft.rfft((parts - parts.mean(axis=1, keepdims=True)) * self.window)
        inside = lines[:, self.first : self.first + self.weight.shape[1]]
        return self.weight @ (inside.real**2 + inside.imag**2).mean(axis=0)


def energies_of(x: Float[np.ndarray, " n"], step: float, low: float, high: float, cut: bool) -> BandEnergies:
    """Energy of a record in a band, or in equal cells of the band.

    The width of a cell times the record's length is at least `MIN_CELL_CYCLES`. A cell has at least two lines of the
    spectrum. There are at most `CELLS_PER_BAND` cells. Cells with less than `MIN_ENERGY_SHARE` of the largest one's energy are
    left out, since there the sensor's noise is most of the energy.

    Args:
        x: Record (m, rad), (n,).
        step: Sampling interval (s).
        low: Lower end of the band (Hz).
        high: Upper end of the band (Hz).
        cut: Whether the band is cut into cells.
    """
    line = 1 / min(SEGMENT, len(x) * step)
    narrowest = max(MIN_CELL_CYCLES / (len(x) * step), 2 * line)
    count = int(np.clip((high - low) / narrowest, 1, CELLS_PER_BAND)) if cut else 1
    edges = np.linspace(low, high, count + 1)
    made = [band_weights(len(x), step, *pair) for pair in pairwise(edges)]
    measured = np.array([weights.integral(x) for weights in made])
    cells = [i for i in range(count) if measured[i] >= MIN_ENERGY_SHARE * measured.max()]
    first = min(made[i].first for i in cells)
    weight = np.zeros((len(cells), max(made[i].first + len(made[i].weight) for i in cells) - first))
    for row, i in zip(weight, cells):
        row[made[i].first - first :][: len(made[i].weight)] = made[i].weight
    starts, taper = on_device(made[0].starts), on_device(made[0].window)
    return BandEnergies(starts, taper, on_device(weight), on_device(measured[cells]), first)


def joined_bands(parts: Sequence[BandEnergies]) -> BandEnergies:
    """Join bands of one motion."""
    first = min(part.first for part in parts)
    end = max(part.first + part.weight.shape[1] for part in parts)
    rows = [np.pad(part.weight, ((0, 0), (part.first - first, end - part.first - part.weight.shape[1]))) for part in parts]
    measured = np.concatenate([part.measured for part in parts])
    return BandEnergies(parts[0].starts, parts[0].window, on_device(np.concatenate(rows)), on_device(measured), first)
