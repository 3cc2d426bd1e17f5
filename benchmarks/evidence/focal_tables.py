"""FOCAL campaign 2 by its WAMIT tables with nothing fitted, beside strips as declared."""

import shutil
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence.common import CACHE, Absent, Section, cached, fingerprint, say, table, within
from benchmarks.evidence.focal_potential_flow import FOLDER

TITLE, NAME = "FOCAL campaign 2 by potential flow, nothing fitted", "focal_tables"
TRACKED = {"sensor_reference.x": 3.8, "sensor_reference.z": -16.7}  # m: section focal_laboratory
MOTIONS = ("surge", "heave", "pitch")
TABLES = ("excitation: {file: semi.3}", "drift: {file: semi.12d}")
VARIANTS = {
    "strips": (),
    "strips, second-order forces": ("second_order_forces: slender_body",),
    "tables around strips": (
        "radiation: {file: semi.1, added_mass: file}",
        "excitation: {file: semi.3, second_order: strips}",
        "second_order_forces: slender_body",
    ),
    "tables, added mass of members": ("radiation: {file: semi.1}", *TABLES),
    "tables, added mass of the table": ("radiation: {file: semi.1, added_mass: file}", *TABLES),
}


def campaign_with(lines: tuple[str, ...], name: str) -> Path:
    """The campaign's folder with lines added to its platform file."""
    folder = CACHE / "focal-tables" / name.replace(", ", "-").replace(" ", "-")
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
    from jaxhydro.analysis.spectral import bands

    campaign = load_campaign(campaign_with(lines, name))
    model = with_effects(campaign.model, TRACKED).with_values(TRACKED)
    found: dict[str, Any] = {}
    for test in compare(campaign, model, options_of(campaign)).tests:
        step, here = float(np.diff(test.fit.time[:2])[0]), {}
        for one in (one for one in test.fit.series if one.channel in MOTIONS):
            here[one.channel] = {"means": [float(one.measured.mean()), float(one.simulated.mean())]}
            for band, (low, high) in bands(one.channel, test.peak_period).items():
                there, ours = (within(x, low, high, step) for x in (one.measured, one.simulated))
                energy = float(np.var(ours) / np.var(there) - 1)
                here[one.channel][band] = {"energy": energy, "correlation": float(np.corrcoef(there, ours)[0, 1])}
        found[test.fit.id] = here
    return found


def run(figures: Path) -> Section:
    """The section; it has no figures."""
    if not (FOLDER / "focal-c2").exists():
        raise Absent("the measured records (../shared/measured) are not on this machine")
    key = fingerprint(FOLDER / "focal-c2", FOLDER / "focal-c4" / "wamit", Path(__file__))
    found = {
        name: cached(NAME, key, f"variant {i}", lambda lines=lines, name=name: compared(lines, name))
        for i, (name, lines) in enumerate(VARIANTS.items())
    }
    text = [
        "Potential flow and strips are judged by what was measured. Nothing is fitted. Coefficients are those of the platform "
        "file (drag 1 across columns, 1.5 across pontoons), and the tables are whole. The tracked point is that of the "
        f"section before (x = {TRACKED['sensor_reference.x']:g} m, z = {TRACKED['sensor_reference.z']:g} m).",
        "",
        "- *Second-order forces*: `second_order_forces: slender_body`.",
        "- *Around strips*: the same, and the table corrects the strips (`second_order: strips`); no drift table.",
        "- *Tables*: excitation and drift in place of the strips' inertial wave load.",
        "",
    ]
    for band, words in (("wave_frequency", "Wave frequency"), ("low_frequency", "Low frequency")):
        rows = []
        for name, seas in found.items():
            for sea, here in seas.items():
                cells = [here[dof][band] for dof in MOTIONS]
                rows.append([name, sea, *(f"{100 * x['energy']:+.0f} %, {x['correlation']:.2f}" for x in cells)])
        text += [f"{words}: error of the energy, and correlation in time.", ""]
        text += [table(["model", "sea", *MOTIONS], rows).strip(), ""]
    rows = [
        [name, *(f"{here['surge']['means'][0]:.2f}, {here['surge']['means'][1]:.2f}" for here in seas.values())]
        for name, seas in found.items()
    ]
    text += ["Mean surge, measured and simulated (m).", "", table(["model", *next(iter(found.values()))], rows).strip()]
    say("  " + "; ".join(f"{row[0]}: {row[-1]}" for row in rows))
    return Section(TITLE, "\n".join(text))
