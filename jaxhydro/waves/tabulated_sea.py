"""Spectra in tables, as measured or from a wave model: over frequency and direction, or over frequency alone."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Array, Float

from jaxhydro.quick_jit import on_device
from jaxhydro.waves.directional_spectrum import AbstractDirectionalSpectrum
from jaxhydro.waves.spectra import tabulated
from jaxhydro.waves.spreading import circular_moments, spread_angle


@dataclass(frozen=True, eq=False)
class TabulatedDirections(AbstractDirectionalSpectrum):
    """Directional spectrum in a table, as measured or from a wave model.

    Between frequencies E is linear; beyond them it is 0. Each direction stands for an even part of its bin.

    Attributes:
        omega: Angular frequencies (rad/s), ascending, (n,).
        heading: Middles of the bins (rad), evenly ascending, (d,).
        values: E (m² s/rad per rad), (n, d).
    """

    omega: Float[np.ndarray, " n"]
    heading: Float[np.ndarray, " d"]
    values: Float[np.ndarray, "n d"]

    @property
    def bin_width(self) -> float:
        """Width of a bin of directions (rad)."""
        return float(self.heading[1] - self.heading[0])

    @property
    def table(self) -> Float[np.ndarray, " n"]:
        """Spectral density S over all directions (m² s/rad) at the frequencies of the table, (n,)."""
        return self.values.sum(axis=1) * self.bin_width

    @property
    def mean_heading(self) -> float:
        """Mean direction that the waves travel to (rad), weighted by energy."""
        return circular_moments(self.heading, np.trapezoid(self.values, self.omega, axis=0)).mean

    def density(self, omega: Float[Array, " w"]) -> Float[Array, " w"]:
        return tabulated(omega, on_device(self.omega), on_device(self.table))

    @property
    def long_crested(self) -> bool:
        return False

    def headings(self, omega: Float[np.ndarray, " w"], share: Float[np.ndarray, " w"]) -> Float[np.ndarray, " w"]:
        edges = np.r_[self.heading - 0.5 * self.bin_width, self.heading[-1] + 0.5 * self.bin_width]
        headings = np.empty(np.shape(omega))
        for i, (w, part) in enumerate(zip(np.asarray(omega), share)):
            energy = np.array([np.interp(w, self.omega, column, 0.0, 0.0) for column in self.values.T])
            whole = energy.sum()
            cumulative = np.r_[0.0, np.cumsum(energy) / whole] if whole > 0 else np.linspace(0, 1, len(edges))
            headings[i] = np.interp(part, cumulative, edges)
        return headings


@dataclass(frozen=True, eq=False)
class TabulatedFrequencies(AbstractDirectionalSpectrum):
    """Spectrum in a table over frequency, as of a buoy without directions, with one heading and spreading.

    Between frequencies S is linear; beyond them it is 0.

    Attributes:
        omega: Angular frequencies (rad/s), ascending, (n,).
        table: S (m² s/rad), (n,).
        mean_heading: Mean direction that the waves travel to (rad).
        spreading: Exponent s of `spreading.spreading` (-); None: long-crested.
    """

    omega: Float[np.ndarray, " n"]
    table: Float[np.ndarray, " n"]
    mean_heading: float = 0.0
    spreading: float | None = None

    def density(self, omega: Float[Array, " w"]) -> Float[Array, " w"]:
        return tabulated(omega, on_device(self.omega), on_device(self.table))

    @property
    def long_crested(self) -> bool:
        return self.spreading is None

    def headings(self, omega: Float[np.ndarray, " w"], share: Float[np.ndarray, " w"]) -> Float[np.ndarray, " w"]:
        if self.spreading is None:
            return np.full(np.shape(omega), self.mean_heading)
        return self.mean_heading + spread_angle(self.spreading, share)
