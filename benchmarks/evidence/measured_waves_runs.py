"""FOCAL campaign 2 simulated in its measured waves, with nothing fitted to them."""

from typing import Any

import numpy as np

from benchmarks.evidence.common import TRUE, cached
from benchmarks.evidence.focal_potential_flow import FOLDER, interpolated, linear_motions

NAME = "measured_waves"
FITTED, TUNED = "focal-c4", "table-1"  # sets of coefficients: fitted to campaign 4's decay, and published
# coefficients, order, diffraction, elements along a pontoon (None: as the platform file says, 3)
CASES = {
    "fitted": (FITTED, 2, "maccamy_fuchs", None),
    "fitted-1": (FITTED, 1, "maccamy_fuchs", None),
    "fitted-morison": (FITTED, 2, "none", None),
    "fitted-1-morison": (FITTED, 1, "none", None),
    "tuned": (TUNED, 2, "maccamy_fuchs", None),
    "tuned-1": (TUNED, 1, "maccamy_fuchs", None),
    "tuned-morison": (TUNED, 2, "none", None),
    "tuned-1-morison": (TUNED, 1, "none", None),
    "tuned-ramp": (TUNED, 2, "ramp", None),
    "tuned-twelve": (TUNED, 2, "maccamy_fuchs", 12),
}
SEGMENT = 400.0  # s, of transfer functions: 14 segments in a sea
HIGHEST = 0.2  # Hz, of the spectra that are kept
KEEL = -20.37  # m: what heave reads in still water, as recorded
RESONANCE = 0.035  # Hz, of pitch
MOTIONS = ("surge", "heave", "pitch")
UNITS = {"wave": "m", "surge": "m", "heave": "m", "pitch": "deg"}
AT = (0.06, 0.08, 0.10, 0.12)  # Hz, of the transfer functions


def values_of(coefficients: str, key: str) -> dict[str, float]:
    """Values of a set of coefficients, by label."""
    if coefficients == FITTED:
        return cached(NAME, key, "coefficients")["values"]
    sideways = {"linear_damping.B22": TRUE["linear_damping.B11"], "linear_damping.B44": TRUE["linear_damping.B55"]}
    return TRUE | sideways


def fitted() -> dict[str, Any]:
    """Coefficients calibrated to campaign 4's surge decay, and those that it does not determine."""
    from calibration.campaign.load_campaign import load_campaign
    from calibration.fitting.decay_calibration import calibrate

    parameters = calibrate(load_campaign(FOLDER / "focal-c4")).parameters
    vague = [k for k, p in parameters.items() if not p.identifiable]
    return {"values": {k: p.value for k, p in parameters.items()}, "vague": vague}


def case(key: str, name: str) -> dict[str, Any]:
    """One set of coefficients and options against all three seas."""
    from calibration.campaign.load_campaign import load_campaign
    from calibration.residuals.measured_seas import compare
    from calibration.residuals.sea_errors import in_bands
    from calibration.residuals.wave_options import Options
    from jaxhydro.dynamics.statics import natural_modes
    from jaxhydro.platform.build import build

    coefficients, order, diffraction, elements = CASES[name]
    campaign = load_campaign(FOLDER / "focal-c2")
    platform = campaign.platform
    if elements is not None:
        members = tuple(m.model_copy(update={"elements": elements}) if m.name == "pontoon" else m for m in platform.members)
        platform = platform.model_copy(update={"members": members})
    model = build(platform).with_values(values_of(coefficients, key))
    comparison = compare(campaign, model, Options(order=order, diffraction=diffraction))
    modes = natural_modes(model)
    shape = modes.shape[int(np.argmax(np.abs(modes.shape[:, 4])))]  # rotations are times 50 m there
    seas: dict[str, Any] = {}
    for test in comparison.tests:
        seas[test.fit.id] = {
            "bands": {k: {b: [x.measured, x.simulated] for b, x in row.items()} for k, row in in_bands(test).items()},
            "stated": test.stated_height,
            "tp": test.peak_period,
            **spectra(test),
            **lower(test),
        }
    return {
        "seas": seas,
        "notes": list(comparison.notes),
        "mismatch": comparison.seas[0][1].mismatch,
        "rounds": comparison.seas[0][1].rounds,
        "inside": comparison.seas[0][1].inside,
        "components": comparison.seas[0][1].sea.components.omega.size,
        "arm": 50 * float(shape[0] / shape[4]),
        "periods": [modes.of(dof) for dof in MOTIONS],
    }


def lower(test: Any) -> dict[str, Any]:
    """Motion of a point `KEEL` above still water, and of the measured point in pitch's resonance.

    Returns:
        `keel`: band integrals, transfer function and mean of simulated surge there. `arms`: surge over pitch and sway over
        roll of the measured point (m/rad, the real part), each with its coherence.
    """
    from calibration.residuals.sea_errors import channels, density
    from jaxhydro.analysis.motion_bands import bands
    from jaxhydro.analysis.spectral import band_integral
    from jaxhydro.analysis.transfer_functions import transfer_function

    time, motions = test.fit.time, channels(test)
    surge = motions["surge"][1] + KEEL * np.radians(motions["pitch"][1])
    limits = bands("surge", test.peak_period)
    h = transfer_function(time, test.wave, surge, SEGMENT)
    lines = [int(np.argmin(np.abs(h.frequency - f))) for f in AT]
    arms = []
    for motion, angle in (("surge", "pitch"), ("sway", "roll")):
        turn = np.radians(motions[angle][0])
        arm = transfer_function(time, turn, motions[motion][0], 500.0)
        i = int(np.argmin(np.abs(arm.frequency - RESONANCE)))
        arms.append([float(arm.amplitude[i] * np.cos(arm.phase[i])), float(arm.coherence[i])])
    return {
        "keel": {
            "bands": {k: band_integral(density(test, surge), *band) for k, band in limits.items()},
            "response": [[float(h.amplitude[i]), float(h.phase[i])] for i in lines],
            "mean": float(surge.mean()),
        },
        "arms": arms,
    }


def spectra(test: Any) -> dict[str, Any]:
    """Mean, standard deviation, spectra and transfer functions, measured and simulated."""
    from calibration.residuals.sea_errors import channels, density
    from jaxhydro.analysis.transfer_functions import transfer_function

    results: dict[str, Any] = {"mean": {}, "deviation": {}, "density": {}, "response": {}}
    time, motions = test.fit.time, channels(test)
    for name in UNITS:
        results["mean"][name] = [float(x.mean()) for x in motions[name]]
        results["deviation"][name] = [float(x.std()) for x in motions[name]]
        both_spectra = [density(test, x) for x in motions[name]]
        inside = (both_spectra[0].frequency > 0) & (both_spectra[0].frequency <= HIGHEST)
        results["frequency"] = both_spectra[0].frequency[inside].tolist()
        results["density"][name] = [spectrum.density[inside].tolist() for spectrum in both_spectra]
        if name != "wave":
            h = [transfer_function(time, test.wave, x, SEGMENT) for x in motions[name]]
            lines = [int(np.argmin(np.abs(h[0].frequency - f))) for f in AT]
            results["response"][name] = [[float(v[i]) for spectrum in h for v in spectrum[1:]] for i in lines]
    return results


def potential() -> dict[str, list[list[float]]]:
    """Amplitude (m, deg per m) and phase (deg) of linear motions by WAMIT, at the frequencies AT.

    Mass and mooring are those of campaign 2.
    """
    frequency, motions = linear_motions()
    results: dict[str, list[list[float]]] = {}
    shown = {name: motions[:, dof] for name, dof in zip(MOTIONS, (0, 2, 4))}
    for name, values in {**shown, "keel": shown["surge"] + KEEL * shown["pitch"]}.items():
        response = interpolated(frequency, values, AT)
        scale = 180 / np.pi if name == "pitch" else 1.0
        results[name] = [[float(scale * abs(x)), float(np.degrees(np.angle(x)))] for x in response]
    return results
