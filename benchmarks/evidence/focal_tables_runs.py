"""FOCAL campaign 2 simulated with strips and with its WAMIT tables, nothing fitted."""

import shutil
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence.common import CACHE, within
from benchmarks.evidence.focal_potential_flow import FOLDER

TRACKED = {"sensor_reference.x": 3.8, "sensor_reference.z": -16.7}  # m: by `focal_laboratory_runs`
MOTIONS = ("surge", "heave", "pitch")
TABLES = ("excitation: {file: semi.3}", "drift: {file: semi.12d}")
VARIANTS = {  # lines that are added to the platform file
    "strips": (),
    "strips-second-order-forces": ("second_order_forces: slender_body",),
    "tables-around-strips": (
        "radiation: {file: semi.1, added_mass: file}",
        "excitation: {file: semi.3, second_order: strips}",
        "second_order_forces: slender_body",
    ),
    "tables-added-mass-of-members": ("radiation: {file: semi.1}", *TABLES),
    "tables-added-mass-of-the-table": ("radiation: {file: semi.1, added_mass: file}", *TABLES),
}


def campaign_with(lines: tuple[str, ...], name: str) -> Path:
    """The campaign's folder with lines added to its platform file."""
    folder = CACHE / "focal-tables" / name
    folder.mkdir(parents=True, exist_ok=True)
    for path in [*(FOLDER / "focal-c2").iterdir(), *(FOLDER / "focal-c4" / "wamit").glob("semi.*")]:
        shutil.copyfile(path, folder / path.name)
    with open(folder / "platform.yaml", "a", encoding="utf-8") as platform:
        platform.write("\n" + "\n".join(lines) + "\n")
    return folder


def compared(lines: tuple[str, ...], name: str) -> dict[str, Any]:
    """Simulated over measured motion in every sea: energies and correlation by band, and mean surge (m)."""
    from calibration.campaign.load_campaign import load_campaign
    from calibration.discovery.effects.candidates import with_effects
    from calibration.residuals.measured_seas import compare
    from calibration.residuals.wave_options import options_of
    from jaxhydro.analysis.motion_bands import bands

    campaign = load_campaign(campaign_with(lines, name))
    model = with_effects(campaign.model, TRACKED).with_values(TRACKED)
    seas: dict[str, Any] = {}
    for test in compare(campaign, model, options_of(campaign)).tests:
        step, motions = float(np.diff(test.fit.time[:2])[0]), {}
        for series in (series for series in test.fit.series if series.channel in MOTIONS):
            motions[series.channel] = {"means": [float(series.measured.mean()), float(series.simulated.mean())]}
            for band, (low, high) in bands(series.channel, test.peak_period).items():
                measured, simulated = (within(x, low, high, step) for x in (series.measured, series.simulated))
                energy = float(np.var(simulated) / np.var(measured) - 1)
                motions[series.channel][band] = {"energy": energy, "correlation": float(np.corrcoef(measured, simulated)[0, 1])}
        seas[test.fit.id] = motions
    return seas
