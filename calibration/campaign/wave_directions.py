"""Directions of waves that one gauge measured, from a stated directional spectrum."""

import dataclasses
import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Array, Float

from calibration.campaign.stated_sea import Sea
from jaxhydro.quick_jit import as_data, on_device, quick_jit
from jaxhydro.waves.components import Components
from jaxhydro.waves.directional_spectrum import SystemsSpectrum, WaveSystem
from jaxhydro.waves.spreading import equal_energy_shares, spread_angle


@dataclass(frozen=True)
class StatedDirections:
    """Directions of the waves of a short-crested sea, or of several wave systems. At full scale.

    One gauge does not tell directions. They are drawn, one for each frequency component, from the stated directional spectrum.
    Amplitude and phase of each component are those of the record at the gauge. So the sea is the record at the gauge. Elsewhere
    it is one of many that have this record and this directional spectrum.

    Attributes:
        heading: Mean direction that the waves travel to (rad).
        spreading: Exponent s of `spreading.spreading` (-); None: `systems`, or long-crested.
        systems: Wave systems; empty: one, with the record's own spectrum.
        seed: Seed of the random directions.

    References:
        Jefferys (1987), Applied Ocean Research 9, 237-244, on one direction per frequency.
    """

    heading: float
    spreading: float | None
    systems: tuple[WaveSystem, ...]
    seed: int

    def headings(self, waves: Components) -> Float[np.ndarray, " w"]:
        """Directions (rad) of components on successive harmonics, (w,)."""
        shares = equal_energy_shares(*waves.harmonics, self.seed)
        if self.systems:
            return SystemsSpectrum(self.systems).headings(np.asarray(waves.omega), shares)
        if self.spreading is None:
            return np.full(shares.shape, self.heading)
        return self.heading + spread_angle(self.spreading, shares)

    def turned(self, waves: Components, position: tuple[float, float]) -> Components:
        """The waves in these directions, with the elevation at a gauge unchanged.

        Args:
            waves: First-order components of the record.
            position: Position of the gauge (m).
        """
        turned = dataclasses.replace(waves, heading=on_device(self.headings(waves)))
        return dataclasses.replace(turned, phase=_phase_at_gauge(waves, turned, as_data(position)))


@quick_jit
def _phase_at_gauge(waves: Components, turned: Components, gauge: Float[Array, "2"]) -> Float[Array, " w"]:
    """Phases (rad) with which turned waves have the elevation of the others at a gauge."""
    return waves.phase + gauge @ (turned.vector() - waves.vector())


def stated_directions(sea: Sea, scale: float) -> StatedDirections | None:
    """Directions that a test states, at full scale; None for long-crested waves."""
    if sea.long_crested:
        return None
    systems = tuple(
        WaveSystem(
            system.hs * scale, system.tp * math.sqrt(scale), system.gamma, system.heading, system.spreading, system.spectrum
        )
        for system in sea.systems
    )
    return StatedDirections(math.radians(sea.mean_heading), sea.spreading, systems, sea.seed)
