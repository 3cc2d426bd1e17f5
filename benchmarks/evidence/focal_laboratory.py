"""Where the gauge of FOCAL campaign 2 stood and which point was tracked, by linear potential flow in place of strips."""

from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence.common import Absent, Section, cached, fingerprint, say, table
from benchmarks.evidence.focal_potential_flow import FOLDER, interpolated, linear_motions

TITLE, NAME = "The laboratory of FOCAL campaign 2, by other evidence", "focal_laboratory"
SEGMENT = 400.0  # s, of transfer functions
BAND = (0.06, 0.14)  # Hz, of the lines that are compared
MIN_COHERENCE = 0.95  # of a line, in all motions
OTHER_MASS = 2.0498e7  # kg: the other published mass matrix (../shared/measured/SOURCE.md)


def gauge_and_point(run: Any, record: Any, water: Any, frequency: np.ndarray, motions: np.ndarray) -> dict[str, float]:
    """Where the gauge stood (m, along the waves) and the point that was tracked (m), by one sea.

    Args:
        run: The run that the record is a part of.
        record: The record.
        water: The water.
        frequency: Frequencies of potential flow (Hz; f,).
        motions: Its motions in a wave of unit amplitude (complex; f, 6).
    """
    import jax.numpy as jnp
    from scipy.optimize import least_squares

    from jaxhydro.analysis.transfer_functions import transfer_function
    from jaxhydro.waves.dispersion import wavenumber

    samples = run.samples(record)
    time, wave = run.time[samples], run.wave[samples]
    responses = [transfer_function(time, wave, record.values[name], SEGMENT) for name in ("surge", "heave", "pitch")]
    at = responses[0].frequency
    coherent = np.min([response.coherence for response in responses], axis=0) > MIN_COHERENCE
    inside = coherent & (at >= BAND[0]) & (at <= BAND[1])
    at = at[inside]
    surge, heave, pitch = (response.amplitude[inside] * np.exp(1j * response.phase[inside]) for response in responses)
    flow = {name: interpolated(frequency, motions[:, dof], at) for name, dof in (("surge", 0), ("heave", 2))}
    k = np.asarray(wavenumber(jnp.asarray(2 * np.pi * at), water.depth, water.gravity))

    def left(unknown: np.ndarray) -> np.ndarray:
        distance, height, ahead = unknown
        shift = np.exp(1j * k * distance)
        both = np.concatenate(
            [
                (flow["surge"] * shift + height * pitch) / surge - 1,
                (flow["heave"] * shift - ahead * pitch) / heave - 1,
            ]
        )
        return np.concatenate([both.real, both.imag])

    distance, height, ahead = least_squares(left, np.zeros(3)).x
    return {"distance": float(distance), "height": float(height), "ahead": float(ahead), "lines": float(len(at))}


def all_seas() -> dict[str, Any]:
    """All three seas."""
    from calibration.campaign.load_campaign import load_campaign
    from calibration.campaign.runs import runs

    frequency, motions = linear_motions()
    campaign = load_campaign(FOLDER / "focal-c2")
    water = campaign.model.environment
    return {
        "seas": {
            record.id: gauge_and_point(run, record, water, frequency, motions)
            for run in runs(campaign)
            for record in run.records
        },
        "mass": float(campaign.model.body.mass),
    }


def run(figures: Path) -> Section:
    """The section; it has no figures."""
    if not (FOLDER / "focal-c2").exists():
        raise Absent("the measured records (../shared/measured) are not on this machine")
    key = fingerprint(FOLDER / "focal-c2", FOLDER / "focal-c4" / "wamit", Path(__file__))
    result = cached(NAME, key, "seas", all_seas)
    rows = {
        "gauge, further along the waves (m)": "distance",
        "tracked point, height (m)": "height",
        "tracked point, along the waves (m)": "ahead",
    }
    seas = list(result["seas"])
    body = []
    for words, which in rows.items():
        values = np.array([result["seas"][name][which] for name in seas])
        body.append([words, *(f"{v:.1f}" for v in values), f"{values.mean():.1f} ± {values.std(ddof=1):.1f}"])
    say("  " + "; ".join(f"{row[0]}: {row[-1]}" for row in body))
    text = [
        "This is to judge what `jaxhydro diagnose` names. No strip of this project takes part.",
        "",
        "- Measured transfer functions are compared with linear potential flow on the same hull: WAMIT's coefficients in "
        "focal-c4, the mass and mooring of campaign 2.",
        "- Surge of a point at height z is S e^(ikd) + z P. S is surge by potential flow. P is pitch as measured. The "
        "wavenumber is k. The gauge stood further along the waves by d.",
        "- Heave of a point at x is H e^(ikd) - x P. H is heave by potential flow.",
        "- d, z and x minimise the relative errors of both surge and heave. All lines from "
        f"{BAND[0]} to {BAND[1]} Hz with a coherence above {MIN_COHERENCE} in all three motions count. "
        "The last column has the mean of the seas and their standard deviation.",
        "",
        table(["", *seas, "mean"], body).strip(),
        "",
        "Two more things say that the keel was tracked, 20 m below still water (section *Measured waves*). They are heave as "
        "recorded in still water, and how far surge moves with pitch in its resonance.",
        "",
        f"Mass: the campaign's own numbers say {result['mass'] / 1e3:.0f} t. Another published mass matrix of the hull says "
        f"{OTHER_MASS / 1e3:.0f} t, {100 * (OTHER_MASS / result['mass'] - 1):+.1f} %.",
    ]
    return Section(TITLE, "\n".join(text))
