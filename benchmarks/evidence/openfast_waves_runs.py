"""Loads and motions of OpenFAST's strips in waves, and how this package's own conventions change them."""

from typing import Any

import numpy as np
from scipy.special import h1vp

from jaxhydro.waves.diffraction import maccamy_fuchs

HELD = ("c1", "c2", "c1mcf", "c1st", "c3", "c1_fine")
FREE = ("free_comp_c1", "free_comp_c2", "free_comp_c3", "ss1_c1", "ss1_c2", "ss1_c3", "ss1_c4", "ss2_c1", "ss2_c2", "ss2s_c2")
SEAS = {"ss1": "ss1_c3", "ss2": "ss2_c1"}
DOFS = ("surge", "heave", "pitch")
OWN = {"directions": "body", "lag": True, "bound": True, "centre": True}
# options of the model and of the sea, None: OpenFAST's
CHANGES: dict[str, tuple[dict[str, Any], dict[str, Any] | None]] = {
    "directions": ({"directions": "body"}, None),
    "lag": ({"lag": True}, None),
    "bound": ({"bound": True}, None),
    "centre": ({"centre": True}, None),
    "pairs": ({}, {}),
    "default": (OWN, {}),
    "ramp": (OWN | {"diffraction": "ramp"}, {}),
    "undiffracted": (OWN | {"diffraction": "none"}, {}),
    "wheeler": (OWN, {"stretching": "wheeler"}),
    "extrapolation": (OWN, {"stretching": "extrapolation"}),
    "still_water": (OWN, {"stretching": "none"}),
    "first_order": (OWN, {"order": 1}),
}
DEFAULT = "default"
SLENDERNESS = (0.1, 0.3, 0.5, 1.0)  # wavenumber times radius (-), at which mean drift forces are compared


def energies(times: np.ndarray, motions: dict[str, np.ndarray], period: float) -> dict[str, float]:
    """Integrals of the spectrum (m2, deg2) in the paper's bands from 300 s on, and the mean surge (m)."""
    from jaxhydro.analysis.motion_bands import bands
    from jaxhydro.analysis.spectral import band_integral, power_spectrum

    late = times >= (300 if times[-1] > 900 else 0)
    results = {"mean": float(motions["surge"][late].mean())}
    for dof in DOFS:
        spectrum = power_spectrum(times[late], motions[dof][late])
        for name, (low, high) in bands(dof, period).items():
            results[f"{dof} {name[:1]}"] = band_integral(spectrum, low, high)
    return results


def held(case: str) -> dict[str, Any]:
    """Differences of the forces of a `fixed` run, by Gauss points and by nodes.

    Those by nodes are there where the run has the elements of the other runs.
    """
    from benchmarks.evidence import openfast_sea as of

    run = of.read(f"fixed_comp_{case}")
    results = {"gauss": of.loads(run)}
    return results if case == "c1_fine" else results | {"nodes": of.loads(run, nodes=True)}


def free(name: str) -> dict[str, Any]:
    """Differences of a run's motions with OpenFAST's conventions, and with its nodes and grid; energies."""
    from benchmarks.evidence import openfast_sea as of

    run = of.read(name)
    times, ours = of.motion(run, of.sea(run))
    openfast = {dof: run.table[channel][::2] for dof, channel in of.CHANNELS.items()}
    first = times <= 600
    _, half = of.motion(run, of.sea(run), step=0.125)
    results = {
        "until": float(times[-1]),
        "whole": of.missed(run, times, ours),
        "step": of.missed(run, times, half),
        "first": of.missed(run, times[first], {k: x[first] for k, x in ours.items()}),
        "ours": energies(times, ours, run.setup["Tp"]),
        "theirs": energies(times, openfast, run.setup["Tp"]),
        "others": max(float(np.abs(ours[k]).max()) for k in ("sway", "roll", "yaw")),
    }
    if run.case.order == 2 and not name.startswith("free"):
        times_of = times[times <= 600]
        pairs = of.plain(run).gauge(times_of, order=2)
        results["elevation"] = float((pairs - run.table["Wave1Elv2"][::2][: times_of.size]).std() / pairs.std())
    if not name.endswith("c4"):  # whose pontoons have elements of another length
        results["numerics"] = of.missed(run, *of.motion(run, of.sea(run, grid=True), nodes=True, step=0.125))
    return results


def changed(sea: str) -> dict[str, Any]:
    """Energies of case 3 in a sea with each of `CHANGES`; spectra for the figure; the set-down (m)."""
    from benchmarks.evidence import openfast_sea as of
    from jaxhydro.analysis.spectral import power_spectrum
    from jaxhydro.waves.pair_sums import elevation_spectrum

    run = of.read(SEAS[sea])._replace(case=of.CASES["c3"])
    results: dict[str, Any] = {"set-down": float(elevation_spectrum(run.waves, of.WATER, (0.0, 0.0))[0].real), "psd": {}}

    def note(label: str, times: np.ndarray, motions: dict[str, np.ndarray]) -> None:
        results[label] = energies(times, motions, run.setup["Tp"])
        late = times >= 300
        if label in ("base", DEFAULT, "OpenFAST"):
            spectra = {dof: power_spectrum(times[late], motions[dof][late]) for dof in DOFS}
            results["psd"][label] = {dof: (s.frequency.tolist(), s.density.tolist()) for dof, s in spectra.items()}

    note("base", *of.motion(run, of.sea(run)))
    for label, (options, waves) in CHANGES.items():
        note(label, *of.motion(run, of.sea(run) if waves is None else of.plain(run, **waves), **options))
    note("half", *of.motion(run, of.plain(run), step=0.125, **OWN))
    if sea == "ss1":
        for label, reference in (("OpenFAST", run), ("tank", of.read("ss1_nwt"))):
            motions = {dof: reference.table[channel][::2] for dof, channel in of.CHANNELS.items()}
            note(label, reference.table["Time"][::2], motions)
    return results


def cylinder_drift(ka: float) -> float:
    """Mean drift force over rho g a A^2 on a vertical cylinder in deep water.

    By MacCamy and Fuchs's potential: integral of the mean pressure of second order over the side and the waterline;
    5 pi^2/16 (ka)^3 in long waves.
    """
    angle = np.linspace(0.0, 2 * np.pi, 2000, endpoint=False)
    m = np.arange(30)
    share = np.where(m == 0, 1, 2) * 1j**m * 2j / (np.pi * ka * h1vp(m, ka))
    wave, slope = share @ np.cos(np.outer(m, angle)), -(share * m) @ np.sin(np.outer(m, angle))
    pressure = 0.25 * (np.abs(slope / ka) ** 2 + np.abs(wave) ** 2) - 0.5 * np.abs(wave) ** 2
    return float(np.pi * (pressure * np.cos(angle)).mean())


def strip_drift(ka: float) -> float:
    """Mean drift force over rho g a A^2 by strips under vertical stretching.

    It is the mean of the surface times the force on the strip at z = 0.
    """
    return float(-0.5 * np.pi * ka * np.asarray(maccamy_fuchs(np.array(ka))).imag)


def drift_shares() -> dict[str, float]:
    """Mean drift force of strips over that of the diffraction potential (-), by wavenumber times radius."""
    return {f"{ka:g}": strip_drift(ka) / cylinder_drift(ka) for ka in SLENDERNESS}
