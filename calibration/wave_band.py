"""The frequency band of a campaign's first-order waves."""

from calibration.manifest import Manifest
from jaxhydro.model import Model

LOW, CUTOFF = 0.03, 0.3  # Hz, for a hull of the size of VolturnUS-S


def wave_band(manifest: Manifest, model: Model) -> tuple[float, float]:
    """Lowest and highest frequency (Hz, full scale) of the first-order waves.

    The manifest's `wave_band`; else 0.03 to 0.3 Hz for a hull of the size of VolturnUS-S, by Froude's similarity for others.
    """
    if manifest.wave_band is not None:
        low, cutoff = manifest.wave_band
        return low / manifest.scale**0.5, cutoff / manifest.scale**0.5
    low, cutoff = (float(f"{one / float(model.pace):.3g}") for one in (LOW, CUTOFF))
    return low, cutoff
