"""Section: loads and motions in waves of the same strips in OpenFAST, and what this package's own conventions change."""

from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence.common import Absent, Section, cached, fingerprint, say, table
from benchmarks.evidence.openfast import FOLDER
from benchmarks.evidence.openfast_words import words

TITLE = "Waves against OpenFAST"
HELD = ("c1", "c2", "c1mcf", "c1st", "c3", "c1_fine")
FREE = ("free_comp_c1", "free_comp_c2", "free_comp_c3", "ss1_c1", "ss1_c2", "ss1_c3", "ss1_c4", "ss2_c1", "ss2_c2", "ss2s_c2")
SEAS = {"ss1": "ss1_c3", "ss2": "ss2_c1"}
DOFS = ("surge", "heave", "pitch")
OWN = {"directions": "body", "lag": True, "bound": True, "centre": True}
CHANGES: dict[str, tuple[dict[str, Any], dict[str, Any] | None]] = {  # options of the model and of the sea, None: OpenFAST's
    "directions turn with the platform": ({"directions": "body"}, None),
    "diffraction with its lag": ({"lag": True}, None),
    "bound waves accelerate diffracting columns": ({"bound": True}, None),
    "the centre column diffracts too": ({"centre": True}, None),
    "all difference waves": ({}, {}),
    "**all five: the default**": (OWN, {}),
    "default, coefficients kept in long waves (`ramp`)": (OWN | {"diffraction": "ramp"}, {}),
    "default, no diffraction": (OWN | {"diffraction": "none"}, {}),
    "default, Wheeler": (OWN, {"stretching": "wheeler"}),
    "default, extrapolation": (OWN, {"stretching": "extrapolation"}),
    "default, wetted to still water": (OWN, {"stretching": "none"}),
    "default, first order": (OWN, {"order": 1}),
}
TANK = "*potential flow (`ss1_nwt`)*"
DEFAULT = "**all five: the default**"
LOADS_GOAL, MOTION_GOAL = 0.02, 0.05


def energies(times: np.ndarray, motions: dict[str, np.ndarray], period: float) -> dict[str, float]:
    """Integrals of the spectrum (m2, deg2) in the paper's bands from 300 s on, and the mean surge (m)."""
    from jaxhydro.analysis.spectral import band_integral, bands, power_spectrum

    late = times >= (300 if times[-1] > 900 else 0)
    found = {"mean": float(motions["surge"][late].mean())}
    for dof in DOFS:
        spectrum = power_spectrum(times[late], motions[dof][late])
        for name, (low, high) in bands(dof, period).items():
            found[f"{dof} {name[:1]}"] = band_integral(spectrum, low, high)
    return found


def held(case: str) -> dict[str, Any]:
    """Forces of a `fixed` run by Gauss points and, where its elements are those of the other runs, by nodes."""
    from benchmarks.evidence import openfast_sea as of

    run = of.read(f"fixed_comp_{case}")
    found = {"gauss": of.loads(run)}
    return found if case == "c1_fine" else found | {"nodes": of.loads(run, nodes=True)}


def free(name: str) -> dict[str, Any]:
    """Motions of a run: differences with OpenFAST's conventions, and with its nodes and grid as well; energies."""
    from benchmarks.evidence import openfast_sea as of

    run = of.read(name)
    times, ours = of.motion(run, of.sea(run))
    theirs = {dof: run.table[channel][::2] for dof, channel in of.CHANNELS.items()}
    first = times <= 600
    _, half = of.motion(run, of.sea(run), step=0.125)
    found = {
        "until": float(times[-1]),
        "whole": of.missed(run, times, ours),
        "step": of.missed(run, times, half),
        "first": of.missed(run, times[first], {k: x[first] for k, x in ours.items()}),
        "ours": energies(times, ours, run.setup["Tp"]),
        "theirs": energies(times, theirs, run.setup["Tp"]),
        "others": max(float(np.abs(ours[k]).max()) for k in ("sway", "roll", "yaw")),
    }
    if run.case.order == 2 and not name.startswith("free"):
        times_of = times[times <= 600]
        pairs = of.plain(run).gauge(times_of, order=2)
        found["elevation"] = float((pairs - run.table["Wave1Elv2"][::2][: times_of.size]).std() / pairs.std())
    if not name.endswith("c4"):  # whose pontoons have elements of another length
        found["numerics"] = of.missed(run, *of.motion(run, of.sea(run, grid=True), nodes=True, step=0.125))
    return found


def changed(sea: str) -> dict[str, Any]:
    """Energies of case 3 in a sea with each of `CHANGES`; spectra for the figure; the set-down (m)."""
    from benchmarks.evidence import openfast_sea as of
    from jaxhydro.analysis.spectral import power_spectrum
    from jaxhydro.waves.second_order import elevation_spectrum

    run = of.read(SEAS[sea])._replace(case=of.CASES["c3"])
    found: dict[str, Any] = {"set-down": float(elevation_spectrum(run.waves, of.WATER, (0.0, 0.0))[0].real), "psd": {}}

    def note(label: str, times: np.ndarray, motions: dict[str, np.ndarray]) -> None:
        found[label] = energies(times, motions, run.setup["Tp"])
        late = times >= 300
        if label in ("base", DEFAULT, "OpenFAST"):
            spectra = {dof: power_spectrum(times[late], motions[dof][late]) for dof in DOFS}
            found["psd"][label] = {dof: (s.frequency.tolist(), s.density.tolist()) for dof, s in spectra.items()}

    note("base", *of.motion(run, of.sea(run)))
    for label, (options, waves) in CHANGES.items():
        note(label, *of.motion(run, of.sea(run) if waves is None else of.plain(run, **waves), **options))
    note("half", *of.motion(run, of.plain(run), step=0.125, **OWN))
    if sea == "ss1":
        for label, other in (("OpenFAST", run), ("tank", of.read("ss1_nwt"))):
            note(label, other.table["Time"][::2], {dof: other.table[channel][::2] for dof, channel in of.CHANNELS.items()})
    return found


def percent(value: float, digits: int = 2) -> str:
    return f"{100 * value:.{digits}f} %"


def of_loads(found: dict[str, Any]) -> str:
    """The table of the held platform."""
    rows = []
    for case, both in found.items():
        nodes = both.get("nodes")
        rows.append(
            (
                f"`fixed_comp_{case}`",
                *(percent(both["gauss"][x]["rms"], 3) for x in ("Fx", "Fz", "My")),
                *(percent(nodes[x]["rms"], 3) if nodes else "–" for x in ("Fx", "Fz", "My")),
            )
        )
    return table(("Run", "Fx", "Fz", "My", "by nodes: Fx", "Fz", "My"), rows)


def of_motions(found: dict[str, Any]) -> str:
    """The tables of the free platform: differences, then energies."""
    rows, energy = [], []
    for name, one in found.items():
        numerics = one.get("numerics")
        rows.append(
            (
                f"`{name}`",
                f"{one['until']:.0f}",
                *(percent(one["first"][d]) for d in DOFS),
                *(percent(one["whole"][d]) for d in DOFS),
                *(percent(numerics[d]) if numerics else "–" for d in DOFS),
            )
        )
        if one["until"] > 900:
            ours, theirs = one["ours"], one["theirs"]
            energy.append(
                (
                    f"`{name}`",
                    f"{theirs['mean']:.3f} ({ours['mean'] - theirs['mean']:+.3f})",
                    *(f"{theirs[key]:.3g} ({100 * (ours[key] / theirs[key] - 1):+.1f} %)" for key in theirs if key != "mean"),
                )
            )
    head = (
        "Run",
        "Until (s)",
        "first 600 s: surge",
        "heave",
        "pitch",
        "all of it: surge",
        "heave",
        "pitch",
        "its nodes and grid: surge",
        "heave",
        "pitch",
    )
    bands = tuple(f"{d}, {b}" for d in DOFS for b in ("low", "wave"))
    return table(head, rows) + "\n" + ENERGY + "\n\n" + table(("Run", "Mean surge (m)", *bands), energy)


ENERGY = (
    "Integrals of OpenFAST's spectra (m², deg²) in the paper's low and wave-frequency bands from 300 s on, and how far off "
    "this package's are:"
)


def of_changes(found: dict[str, Any]) -> str:
    """What each convention changes, a table per sea."""
    keys = tuple(f"{d} {b}" for d in DOFS for b in ("l", "w"))
    bands = tuple(f"{d}, {b}" for d in DOFS for b in ("low", "wave"))
    parts = []
    for sea, one in found.items():
        base = one["base"]
        rows = [("OpenFAST's, here", f"{base['mean']:.3f}", *(f"{base[key]:.3g}" for key in keys))]
        rows += [
            (label, f"{one[label]['mean']:.3f}", *(f"{100 * (one[label][k] / base[k] - 1):+.1f} %" for k in keys))
            for label in (*CHANGES, *(["tank"] if "tank" in one else []))
        ]
        rows = [(TANK, *row[1:]) if row[0] == "tank" else row for row in rows]
        title = {"ss1": "Hs 3.1 m, Tp 8.96 s (ss1):", "ss2": "Hs 8.1 m, Tp 12.8 s (ss2):"}[sea]
        parts.append(title + "\n\n" + table(("Conventions", "Mean surge (m)", *bands), rows))
    return "\n".join(parts)


def run(figures: Path) -> Section:
    """Held and free platform, then other conventions."""
    if not FOLDER.exists():
        raise Absent("OpenFAST's runs (../shared/reference/openfast) are not on this machine")
    beside = Path(__file__).with_name("openfast_sea.py")
    key = fingerprint(Path(__file__), beside, beside.with_name("openfast.py"), *sorted(FOLDER.glob("*_c[1-4]*")))
    loads, motions, seas = {}, {}, {}
    for case in HELD:
        loads[case] = cached("openfast_waves", key, f"held-{case}", lambda case=case: held(case))
        say(f"  held, {case}")
    for name in FREE:
        motions[name] = cached("openfast_waves", key, name, lambda name=name: free(name))
        say(f"  {name}: {', '.join(percent(motions[name]['whole'][d]) for d in DOFS)}")
    for sea in SEAS:
        seas[sea] = cached("openfast_waves", key, f"changed-{sea}", lambda sea=sea: changed(sea))
        say(f"  conventions, {sea}")
    worst = max(x["rms"] for one in loads.values() for x in one["gauss"].values())
    apart = max(one["whole"][d] for one in motions.values() for d in DOFS)
    path = figures / "openfast-waves.png"
    draw(seas["ss1"], path)
    short = [
        f"{what} in waves differ from OpenFAST's by up to {percent(value)} of their deviation (goal {100 * goal:g} %)"
        for what, value, goal in (("forces", worst, LOADS_GOAL), ("motions", apart, MOTION_GOAL))
        if value > goal
    ]
    energy = {
        f"{n}: {k}": one["ours"][k] / one["theirs"][k] - 1
        for n, one in motions.items()
        if one["until"] > 900
        for k in one["theirs"]
        if k != "mean"
    }
    far = max(energy, key=lambda k: abs(energy[k]))
    if abs(energy[far]) > MOTION_GOAL:
        where = far.replace(" l", ", low").replace(" w", ", wave")
        short.append(
            f"in waves the energy of {where} differs from OpenFAST's by {100 * energy[far]:+.1f} %. OpenFAST's lumping of "
            "loads at the waterline is the likely cause, but this was not shown"
        )
    text = words(loads, motions, seas, (of_loads(loads), of_motions(motions), of_changes(seas)))
    return Section(TITLE, text, (path,), tuple(short))


def draw(found: dict[str, Any], path: Path) -> None:
    """Spectra of ss1_c3 by OpenFAST and here, in its conventions and the default ones."""
    from jaxhydro.plots.style import BEFORE, MEASURED, SIMULATED, header, save, stack, style
    from jaxhydro.units import unit_of

    looks = {"OpenFAST": (MEASURED, 2.0), "base": (BEFORE, 1.0), DEFAULT: (SIMULATED, 1.0)}
    names = {"OpenFAST": "OpenFAST", "base": "the same here", DEFAULT: "default here"}
    with style():
        figure, axes = stack([1.1] * 3)
        for ax, dof in zip(axes, DOFS, strict=True):
            lines = {}
            for label, (colour, width) in looks.items():
                frequency, density = map(np.asarray, found["psd"][label][dof])
                shown = (frequency > 0) & (frequency <= 0.2)
                lines[names[label]] = ax.semilogy(frequency[shown], density[shown], color=colour, lw=width)[0]
            top = max(max(found["psd"][label][dof][1]) for label in looks)
            ax.set_ylim(2e-5 * top, 2 * top)
            ax.set_ylabel(f"{dof.capitalize()} ({unit_of(dof)}²/Hz)")
        axes[-1].set_xlabel("Frequency (Hz)")
        header(figure, "Spectra in case 3, Hs 3.1 m", lines)
        save(figure, path)
