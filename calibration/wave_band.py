"""The frequency band of a campaign's first-order waves."""

from collections.abc import Sequence

import numpy as np

from calibration.manifest import IN_WAVES, Manifest
from calibration.records import Record
from jaxhydro.model import Model
from jaxhydro.sea_options import CUTOFF, LOW, MOST, share_within

HALF = 0.5  # least share of a record's variance in the band of the hull's size, for that band to be taken


def wave_band(manifest: Manifest, model: Model, records: Sequence[Record]) -> tuple[float, float]:
    """Lowest and highest frequency (Hz, full scale) of the first-order waves.

    The manifest's `wave_band`. Else 0.03 to 0.3 Hz, unless the wave records lie elsewhere, and most of them in a band of the
    hull's size, by Froude's similarity with VolturnUS-S.
    """
    if manifest.wave_band is not None:
        low, cutoff = manifest.wave_band
        return low / manifest.scale**0.5, cutoff / manifest.scale**0.5
    low, cutoff = (float(f"{one / float(model.pace):.3g}") for one in (LOW, CUTOFF))
    ocean, own = (_share(records, *band) for band in ((LOW, CUTOFF), (low, cutoff)))
    return (low, cutoff) if ocean < MOST and own > max(ocean, HALF) else (LOW, CUTOFF)


def _share(records: Sequence[Record], low: float, cutoff: float) -> float:
    """Smallest share of a wave record's variance in a band; 1 where there are none."""
    waves = [r for r in records if r.kind in IN_WAVES and r.use != "ignore" and r.wave is not None]
    shares = [share_within(np.asarray(r.wave), float(np.median(np.diff(r.time))), low, cutoff) for r in waves]
    return min(shares, default=1.0)
