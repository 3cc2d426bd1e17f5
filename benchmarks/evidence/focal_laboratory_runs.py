"""Gauge and tracked point of FOCAL campaign 2, from its records and linear potential flow."""

from typing import Any

import numpy as np

from benchmarks.evidence.focal_potential_flow import FOLDER, interpolated, linear_motions

SEGMENT = 400.0  # s, of transfer functions
BAND = (0.06, 0.14)  # Hz, of the lines that are compared
MIN_COHERENCE = 0.95  # of a line, in all motions


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
    lines = responses[0].frequency
    coherent = np.min([response.coherence for response in responses], axis=0) > MIN_COHERENCE
    inside = coherent & (lines >= BAND[0]) & (lines <= BAND[1])
    lines = lines[inside]
    surge, heave, pitch = (response.amplitude[inside] * np.exp(1j * response.phase[inside]) for response in responses)
    flow = {name: interpolated(frequency, motions[:, dof], lines) for name, dof in (("surge", 0), ("heave", 2))}
    k = np.asarray(wavenumber(jnp.asarray(2 * np.pi * lines), water.depth, water.gravity))

    def errors(unknown: np.ndarray) -> np.ndarray:
        distance, height, ahead = unknown
        shift = np.exp(1j * k * distance)
        misfits = np.concatenate(
            [
                (flow["surge"] * shift + height * pitch) / surge - 1,
                (flow["heave"] * shift - ahead * pitch) / heave - 1,
            ]
        )
        return np.concatenate([misfits.real, misfits.imag])

    distance, height, ahead = least_squares(errors, np.zeros(3)).x
    return {"distance": float(distance), "height": float(height), "ahead": float(ahead), "lines": float(len(lines))}


def all_seas() -> dict[str, Any]:
    """Gauge and tracked point by each of the three seas, and the platform's mass (kg)."""
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
