"""Frequency band of a campaign's first-order waves."""

from collections.abc import Sequence

import numpy as np

from calibration.campaign.manifest import Manifest
from calibration.campaign.manifest_sections import IN_WAVES
from calibration.campaign.records import Record
from jaxhydro.dynamics.model import Model
from jaxhydro.waves import wave_bands


def band_sentence(manifest: Manifest, model: Model, records: Sequence[Record]) -> str | None:
    """Describe the band of first-order waves and where it is from.

    Args:
        manifest: The manifest of the campaign.
        model: Model of the platform file.
        records: Records of the campaign.

    Returns:
        The description; None for a campaign without tests in waves.
    """
    if not any(record.kind in IN_WAVES and record.use != "ignore" for record in records):
        return None
    band = wave_band(manifest, model, records)
    source = "as `wave_band` states" if manifest.wave_band is not None else "`wave_band` in campaign.yaml sets another band"
    return f"first-order waves are from {band[0]:.3g} to {band[1]:.3g} Hz at full scale: {source}"


def wave_band(manifest: Manifest, model: Model, records: Sequence[Record]) -> tuple[float, float]:
    """Return the lowest and highest frequency (Hz, full scale) of the first-order waves.

    The manifest's `wave_band`, else what `jaxhydro.waves.wave_bands` finds for the wave records that are used.
    """
    if manifest.wave_band is not None:
        low, cutoff = manifest.wave_band
        return low / manifest.scale**0.5, cutoff / manifest.scale**0.5
    waves = [record for record in records if record.kind in IN_WAVES and record.use != "ignore" and record.wave is not None]
    steps = [float(np.median(np.diff(record.time))) for record in waves]
    return wave_bands.of_records([(np.asarray(r.wave), step) for r, step in zip(waves, steps)], float(model.pace))
