"""Section 6: measured waves: FOCAL campaign 2 under its own wave record, before anything is fitted to it."""

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence.common import TRUE, Absent, Section, cached, fingerprint, keep, parallel, say
from benchmarks.evidence.focal_potential_flow import FOLDER, interpolated, linear_motions
from benchmarks.evidence.measured_waves_text import (
    AT,
    CASES,
    FITTED,
    KEEL,
    MOTIONS,
    RESONANCE,
    TITLE,
    TUNED,
    UNITS,
    lacks,
    off,
    words,
)

NAME = "measured_waves"
SEGMENT = 400.0  # s, of transfer functions: 14 segments in a sea
HIGHEST = 0.2  # Hz, of the figure


def values_of(which: str, key: str) -> dict[str, float]:
    """Coefficients by label."""
    if which == FITTED:
        return cached(NAME, key, "coefficients")["values"]
    sideways = {"linear_damping.B22": TRUE["linear_damping.B11"], "linear_damping.B44": TRUE["linear_damping.B55"]}
    return TRUE | sideways


def fitted() -> dict[str, Any]:
    """What campaign 4's one surge decay says."""
    from calibration.campaign.load_campaign import load_campaign
    from calibration.fitting.decay_fit import calibrate

    found = calibrate(load_campaign(FOLDER / "focal-c4")).parameters
    return {"values": {k: p.value for k, p in found.items()}, "vague": [k for k, p in found.items() if not p.identifiable]}


def case(key: str, name: str) -> dict[str, Any]:
    """One set of coefficients and options against all three seas."""
    from calibration.campaign.load_campaign import load_campaign
    from calibration.residuals.measured_seas import compare
    from calibration.residuals.sea_errors import in_bands
    from calibration.residuals.wave_options import Options
    from jaxhydro.dynamics.statics import natural_modes
    from jaxhydro.platform.build import build

    which, order, diffraction, elements = CASES[name]
    campaign = load_campaign(FOLDER / "focal-c2")
    platform = campaign.platform
    if elements is not None:
        members = tuple(m.model_copy(update={"elements": elements}) if m.name == "pontoon" else m for m in platform.members)
        platform = platform.model_copy(update={"members": members})
    model = build(platform).with_values(values_of(which, key))
    found = compare(campaign, model, Options(order=order, diffraction=diffraction))
    modes = natural_modes(model)
    shape = modes.shape[int(np.argmax(np.abs(modes.shape[:, 4])))]  # rotations are times 50 m there
    seas: dict[str, Any] = {}
    for test in found.tests:
        seas[test.fit.id] = {
            "bands": {k: {b: [x.measured, x.simulated] for b, x in row.items()} for k, row in in_bands(test).items()},
            "stated": test.stated_height,
            "tp": test.peak_period,
            **spectra(test),
            **lower(test),
        }
    return {
        "seas": seas,
        "notes": list(found.notes),
        "mismatch": found.seas[0][1].mismatch,
        "rounds": found.seas[0][1].rounds,
        "inside": found.seas[0][1].inside,
        "components": found.seas[0][1].sea.components.omega.size,
        "arm": 50 * float(shape[0] / shape[4]),
        "periods": [modes.of(dof) for dof in MOTIONS],
    }


def lower(test: Any) -> dict[str, Any]:
    """Simulated surge `KEEL` above still water: band integrals, mean, transfer function; and what the point that was measured
    does in pitch's resonance, surge over pitch and sway over roll (m/rad, the real part), with coherence."""
    from calibration.residuals.sea_errors import channels, density
    from jaxhydro.analysis.spectral import band_integral, bands
    from jaxhydro.analysis.transfer_functions import transfer_function

    time, both = test.fit.time, channels(test)
    seen = both["surge"][1] + KEEL * np.radians(both["pitch"][1])
    limits = bands("surge", test.peak_period)
    h = transfer_function(time, test.wave, seen, SEGMENT)
    at = [int(np.argmin(np.abs(h.frequency - f))) for f in AT]
    arms = []
    for motion, angle in (("surge", "pitch"), ("sway", "roll")):
        turn = np.radians(both[angle][0])
        arm = transfer_function(time, turn, both[motion][0], 500.0)
        i = int(np.argmin(np.abs(arm.frequency - RESONANCE)))
        arms.append([float(arm.amplitude[i] * np.cos(arm.phase[i])), float(arm.coherence[i])])
    return {
        "keel": {
            "bands": {k: band_integral(density(test, seen), *band) for k, band in limits.items()},
            "response": [[float(h.amplitude[i]), float(h.phase[i])] for i in at],
            "mean": float(seen.mean()),
        },
        "arms": arms,
    }


def spectra(test: Any) -> dict[str, Any]:
    """Of measured and simulated: mean, standard deviation, spectra, and transfer functions from the measured wave."""
    from calibration.residuals.sea_errors import channels, density
    from jaxhydro.analysis.transfer_functions import transfer_function

    found: dict[str, Any] = {"mean": {}, "deviation": {}, "density": {}, "response": {}}
    time, both = test.fit.time, channels(test)
    for name in UNITS:
        found["mean"][name] = [float(x.mean()) for x in both[name]]
        found["deviation"][name] = [float(x.std()) for x in both[name]]
        each = [density(test, x) for x in both[name]]
        seen = (each[0].frequency > 0) & (each[0].frequency <= HIGHEST)
        found["frequency"] = each[0].frequency[seen].tolist()
        found["density"][name] = [one.density[seen].tolist() for one in each]
        if name != "wave":
            h = [transfer_function(time, test.wave, x, SEGMENT) for x in both[name]]
            at = [int(np.argmin(np.abs(h[0].frequency - f))) for f in AT]
            found["response"][name] = [[float(v[i]) for one in h for v in one[1:]] for i in at]
    return found


def potential() -> dict[str, list[list[float]]]:
    """Amplitude (m, deg per m) and phase (deg) at AT of linear motions by WAMIT, with campaign 2's mass and mooring."""
    frequency, motions = linear_motions()
    found: dict[str, list[list[float]]] = {}
    shown = {name: motions[:, dof] for name, dof in zip(MOTIONS, (0, 2, 4))}
    for name, values in {**shown, "keel": shown["surge"] + KEEL * shown["pitch"]}.items():
        at = interpolated(frequency, values, AT)
        scale = 180 / np.pi if name == "pitch" else 1.0
        found[name] = [[float(scale * abs(x)), float(np.degrees(np.angle(x)))] for x in at]
    return found


def run(figures: Path, processes: int = 2) -> Section:
    """All cases, and a figure of spectra."""
    if not (FOLDER / "focal-c2").exists():
        raise Absent("the measured records (../shared/measured) are not on this machine")
    key = fingerprint(FOLDER / "focal-c2", FOLDER / "focal-c4", Path(__file__), repr(CASES))
    if cached(NAME, key, "coefficients") is None:
        keep(NAME, key, "coefficients", fitted())
    found: dict[str, dict[str, Any]] = {}
    for name, result in parallel(NAME, key, list(CASES), partial(case, key), processes):
        found[name] = result
        say(
            f"  {name}: low-frequency surge "
            + ", ".join(f"{off(sea, 'surge', 'low_frequency'):+.0f} %" for sea in result["seas"].values())
        )
    drawn = figures / "measured-waves.png"
    draw(found, drawn)
    flow = cached(NAME, key, "potential", potential)
    text = words(found, cached(NAME, key, "coefficients")["vague"], flow)
    return Section(TITLE, text, (drawn,), lacks(found["tuned"]))


def draw(found: dict[str, dict[str, Any]], path: Path) -> None:
    """Spectra of all three seas: measured, and simulated with both sets of coefficients."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from jaxhydro.analysis.sea_statistics import bands_of
    from jaxhydro.plots.spectrum_axes import BAND_COLOURS
    from jaxhydro.plots.style import BEFORE, MEASURED, SIMULATED, header, save, style

    with style():
        figure = Figure(figsize=(6.9, 5.6), layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.subplots(len(UNITS), 3, sharex=True, sharey="row")
        artists: dict[str, Any] = {}
        for column, (name, sea) in enumerate(found["tuned"]["seas"].items()):
            other = found["fitted"]["seas"][name]
            for ax, (channel, unit) in zip(axes[:, column], UNITS.items(), strict=True):
                for band, (low, high) in bands_of(channel, sea["tp"]).items():
                    ax.axvspan(low, high, color=BAND_COLOURS[band], lw=0, zorder=0.5)
                f, (measured, simulated) = sea["frequency"], sea["density"][channel]
                artists["measured"] = ax.plot(f, measured, color=MEASURED, lw=1.3)[0]
                artists[f"simulated, {FITTED}"] = ax.plot(f, other["density"][channel][1], color=BEFORE, lw=0.8)[0]
                artists[f"simulated, {TUNED}"] = ax.plot(f, simulated, color=SIMULATED, lw=0.8)[0]
                ax.set_yscale("log")
                largest = max(max(s["density"][channel][0]) for s in found["tuned"]["seas"].values())
                ax.set_ylim(largest * 3e-6, largest * 3)
                ax.minorticks_off()
                ax.set_xlim(0, HIGHEST)
                if column == 0:
                    ax.set_ylabel(f"{channel.capitalize()}\n({unit}²/Hz)")
            axes[0, column].set_title(f"{name}: Hs {4 * sea['deviation']['wave'][0]:.1f} m, Tp {sea['tp']:g} s")
            axes[-1, column].set_xlabel("Frequency (Hz)")
        header(figure, "FOCAL campaign 2, second order, MacCamy-Fuchs; bands shaded", artists)
        save(figure, path)
