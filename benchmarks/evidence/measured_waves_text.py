"""Text of the section on measured waves."""

import math
from typing import Any

import numpy as np

from benchmarks.evidence.common import table
from benchmarks.evidence.measured_waves_runs import AT, CASES, FITTED, KEEL, MOTIONS, RESONANCE, TUNED, UNITS
from calibration.formatting import number

SETS = {FITTED: "campaign 4", TUNED: "Table 1"}
WORDS = {"maccamy_fuchs": "MacCamy-Fuchs", "none": "1 + Ca", "ramp": "ramp"}
BANDS = ("low_frequency", "wave_frequency")
SEA = "sea-6m"  # of the transfer functions


def off(sea: dict[str, Any], channel: str, band: str) -> float:
    """(simulated - measured) / measured of a band integral, in per cent."""
    measured, simulated = sea["bands"][channel][band]
    return 100 * (simulated / measured - 1)


def off_keel(sea: dict[str, Any], band: str) -> float:
    """`off` of surge as it is at the keel."""
    return 100 * (sea["keel"]["bands"][band] / sea["bands"]["surge"][band][0] - 1)


def power(seas: dict[str, Any], index: int, channel: str = "surge", band: str = "low_frequency") -> float:
    """Power of the significant height with which a band's standard deviation grows, by least squares.

    Args:
        seas: Results by sea.
        index: 0 for the measured motion, 1 for the simulated one.
        channel: Motion.
        band: Band of the spectrum.
    """
    heights = [math.log(4 * sea["deviation"]["wave"][0]) for sea in seas.values()]
    return float(np.polyfit(heights, [0.5 * math.log(sea["bands"][channel][band][index]) for sea in seas.values()], 1)[0])


def shortcomings(result: dict[str, Any]) -> tuple[str, ...]:
    """What the model with the paper's coefficients misses."""
    deviations = [
        f"{c} {', '.join(f'{off(s, c, band):+.0f}' for s in result['seas'].values())} %" for band in BANDS for c in MOTIONS
    ]
    low, wave = "; ".join(deviations[:3]), "; ".join(deviations[3:])
    return (
        f"focal-c2 in its three seas, Table 1's coefficients, unfitted. Low-frequency energy: {low}. "
        f"Wave-frequency energy: {wave}",
    )


def words(results: dict[str, dict[str, Any]], vague: list[str], potential: dict[str, list[list[float]]]) -> str:
    """Text of the section.

    Args:
        results: Results by case.
        vague: Coefficients that campaign 4's decay does not determine.
        potential: Amplitude and phase of linear motions by potential flow.
    """
    tables = [*errors(results), *means(results), *responses(results, potential)]
    return "\n".join([*intro(results, vague), *conclusions(results, potential), *tables])


def intro(results: dict[str, dict[str, Any]], vague: list[str]) -> list[str]:
    """What was done."""
    base = results["tuned"]
    seas = ", ".join(f"{name} {height(s):.2f} ({s['stated']:g})" for name, s in base["seas"].items())
    periods = {w: ", ".join(f"{p:.1f}" for p in results[n]["periods"]) for w, n in ((FITTED, "fitted"), (TUNED, "tuned"))}
    return [
        "FOCAL campaign 2 (University of Maine, 1:70, full-scale values) is one run of 10 700 s in head waves of three steps "
        "of severity. Nothing is fitted to these seas. Mass, mooring and hydrostatics are those of the campaign's own platform "
        "file.\n\n"
        "- The sea is made once from the whole wave record. First order: 0.03 to 0.3 Hz, "
        f"{100 * base['inside']:.1f} % of its variance, {base['components']} waves. Order 2: the waves that these bind are "
        f"subtracted. Together both orders miss {100 * base['mismatch']:.1g} % of the band after {base['rounds']} rounds.\n"
        "- The platform starts at rest in its equilibrium with the record. Motions count from the still water before the "
        "wavemaker. The first 500 s of every step are left out.\n"
        "- Errors are (simulated - measured) / measured of the integral of the spectrum (Welch, Hann segments of 1000 s, half "
        "overlapped).\n"
        "- The low band is 0.005-0.025 Hz in surge, 0.02-0.055 Hz in heave and pitch. The wave band is 0.06-0.15 Hz, in the "
        "third sea from 0.05 Hz.",
        "",
        f"There are two sets of coefficients:\n\n"
        f"- *{SETS[FITTED]}*: `jaxhydro calibrate` on focal-c4, the same hull's release in surge on another mooring. That one "
        f"record determines little, and only `linear_damping.B11` is a result. Near what its platform file starts from stay "
        f"{', '.join(f'`{x}`' for x in vague)}. Natural periods in surge, heave and pitch: {periods[FITTED]} s.\n"
        f"- *{SETS[TUNED]}*: Table 1 of the paper this package started from, tuned there to decays in surge, heave and pitch. "
        f"Natural periods: {periods[TUNED]} s.\n\n"
        "`MacCamy-Fuchs` replaces 1 + Ca in the wave load on columns. `ramp` keeps 1 + Ca in long waves.",
        "",
        f"Significant heights of the windows, in brackets as stated in the manifest (m): {seas}.",
        "",
    ]


def height(sea: dict[str, Any]) -> float:
    """Significant height (m) as measured."""
    return 4 * sea["deviation"]["wave"][0]


def peak(sea: dict[str, Any], channel: str, kind: int) -> float:
    """Period (s) of the highest line of a spectrum between 0.02 and 0.055 Hz."""
    f, density = np.array(sea["frequency"]), np.array(sea["density"][channel][kind])
    inside = (f >= 0.02) & (f <= 0.055)
    return float(1 / f[inside][np.argmax(density[inside])])


def conclusions(results: dict[str, dict[str, Any]], potential: dict[str, list[list[float]]]) -> list[str]:
    """What the tables say."""
    base, seas = results["tuned"], list(results["tuned"]["seas"].values())
    mid = base["seas"][SEA]

    def row(name: str, channel: str, band: str) -> str:
        return ", ".join(f"{off(s, channel, band):+.0f}" for s in results[name]["seas"].values()) + " %"

    mean = ", ".join(f"{100 * (s['mean']['surge'][1] / s['mean']['surge'][0] - 1):+.0f}" for s in seas)
    spread = max(
        abs(results["tuned"]["seas"][k]["response"][c][i][0] / mid["response"][c][i][0] - 1)
        for k in base["seas"]
        for c in MOTIONS
        for i in (1, 2, 3)
    )
    ratio = {c: [f"{mid['response'][c][i][3] / mid['response'][c][i][0]:.2f}" for i in (1, 2, 3)] for c in MOTIONS}
    flow = {c: [f"{potential[c][i][0] / mid['response'][c][i][0]:.2f}" for i in (1, 2, 3)] for c in MOTIONS}
    keel = {
        n: {b: ", ".join(f"{off_keel(s, b):+.0f}" for s in results[n]["seas"].values()) + " %" for b in BANDS}
        for n in ("tuned", "fitted")
    }
    arms = [", ".join(f"{s['arms'][i][0]:+.1f}" for s in seas) for i in (0, 1)]
    least = min(arm[1] for s in seas for arm in s["arms"])
    read = ", ".join(f"{potential['keel'][i][0] / mid['response']['surge'][i][0]:.2f}" for i in (1, 2, 3))
    finer = max(
        abs(off(results["tuned-twelve"]["seas"][k], c, b) - off(base["seas"][k], c, b))
        for k in base["seas"]
        for c in MOTIONS
        for b in BANDS
    )

    def amounts(amounts_by_motion: dict[str, list[str]]) -> str:
        return ", ".join(f"{c} {', '.join(amounts_by_motion[c])}" for c in MOTIONS)

    return [
        "What it shows, with Table 1's coefficients, order 2 and MacCamy-Fuchs unless said:",
        "",
        "- **Signs, units, clock and gauge hold.** Measured and simulated waves agree at the gauge. Coherence with the wave is "
        "0.96 to 1.00 at 0.08 to 0.12 Hz in all three motions. Phases have the same signs and agree within 15 degrees in surge "
        "and 25 in heave and pitch. Linear potential flow on the same hull is as near in phase, and has the measured "
        "amplitudes of heave and pitch. It has WAMIT's coefficients in focal-c4, mass and mooring of this campaign, and no "
        "drag, at the place where the platform rests.",
        "- **The point that was measured seems to be at the keel**, not at still water as the campaign format has it. In "
        f"pitch's resonance, {RESONANCE} Hz, the model's reference point moves {base['arm']:+.1f} m per rad of pitch. The "
        f"measured point moves {arms[0]} m in the three seas, and {arms[1]} m of sway per rad of roll (coherence "
        f"{least:.2f} or more). Both say some 20 m lower. Heave as recorded also reads {KEEL} m in still water. "
        f"Surge of potential flow at that height has {read} of the measured amplitude at 0.08, 0.10 and 0.12 Hz. "
        "The rows *at the keel* are simulated surge at that height, all others as the manifest has it. At the keel errors in "
        "surge become "
        f"{keel['tuned'][BANDS[0]]} (low) and {keel['tuned'][BANDS[1]]} (wave). With {SETS[FITTED]}'s coefficients they become "
        f"{keel['fitted'][BANDS[0]]} and {keel['fitted'][BANDS[1]]}.",
        "- **The wave-frequency motion is too small, by much the same factor in every sea.** Errors of energy: surge "
        f"{row('tuned', 'surge', BANDS[1])}, heave {row('tuned', 'heave', BANDS[1])}, pitch "
        f"{row('tuned', 'pitch', BANDS[1])}. The measured transfer functions differ by at most {100 * spread:.0f} % between "
        "the seas: this is linear. Simulated over measured amplitude at 0.08, 0.10 and 0.12 Hz: "
        f"{amounts(ratio)}. For potential flow it is: {amounts(flow)}. With 1 + Ca for MacCamy-Fuchs surge becomes "
        f"{row('tuned-morison', 'surge', BANDS[1])}.",
        f"- **Low-frequency surge has the wrong growth.** Its errors are {row('tuned', 'surge', BANDS[0])} from the lowest sea "
        f"to the highest. With order 1 they are {row('tuned-1', 'surge', BANDS[0])}, with {SETS[FITTED]}'s coefficients "
        f"{row('fitted', 'surge', BANDS[0])}. The standard deviation grows with the significant height to the power "
        f"{power(base['seas'], 0):.2f} measured, {power(base['seas'], 1):.2f} simulated. Surge is too little excited, or too "
        "much damped, in the lowest sea, and the reverse in the highest.",
        f"- **Mean surge** is off by {mean} %. It counts from still water: where the platform rests does not matter.",
        f"- **Low-frequency heave and pitch are missing**: {row('tuned', 'heave', BANDS[0])} and "
        f"{row('tuned', 'pitch', BANDS[0])}. The measured peaks in {SEA} are at {peak(mid, 'heave', 0):.1f} s (heave) and "
        f"{peak(mid, 'pitch', 0):.1f} s (pitch); the model's natural periods are {base['periods'][1]:.1f} and "
        f"{base['periods'][2]:.1f} s. Heave's natural period is too short, so its added mass is too small. The rest, and what "
        "is missing in pitch, can be missing excitation or too much damping. This comparison does not say which.",
        f"- Twelve elements along every pontoon instead of three change no error by more than {finer:.2f} points.",
        "",
    ]


def errors(results: dict[str, dict[str, Any]]) -> list[str]:
    """A table for every motion."""
    lines: list[str] = []
    seas = results["tuned"]["seas"]
    heads = ["Coefficients", "Order", "Columns", *(f"low, {name}" for name in seas), *(f"wave, {name}" for name in seas)]
    for channel in MOTIONS:
        measured = [number(s["bands"][channel][band][0], 3) for band in BANDS for s in seas.values()]
        rows = [("*measured*", "", f"{UNITS[channel]}²", *measured)]
        for name, (coefficients, order, diffraction, elements) in CASES.items():
            if elements is None:
                cells = [f"{off(s, channel, band):+.0f} %" for band in BANDS for s in results[name]["seas"].values()]
                rows.append((SETS[coefficients], str(order), WORDS[diffraction], *cells))
            if channel == "surge" and name in ("tuned", "fitted"):
                cells = [f"{off_keel(s, band):+.0f} %" for band in BANDS for s in results[name]["seas"].values()]
                rows.append((f"{SETS[coefficients]}, at the keel", str(order), WORDS[diffraction], *cells))
        lines += [f"#### Energy of {channel} in bands", "", table(heads, rows)]
    return lines


def means(results: dict[str, dict[str, Any]]) -> list[str]:
    """Mean offsets and growth with the sea."""
    names = ("fitted", "fitted-1", "tuned", "tuned-1")
    rows = []
    for name in results["tuned"]["seas"]:
        mean_surges = [results[n]["seas"][name]["mean"]["surge"] for n in names]
        rows.append((f"mean surge in {name} (m)", number(mean_surges[0][0], 3), *(number(x[1], 3) for x in mean_surges)))
    for c in MOTIONS:
        for b in BANDS:
            grown = [f"{power(results[n]['seas'], 1, c, b):.2f}" for n in names]
            rows.append((f"power of Hs, {c}, {b.split('_')[0]}", f"{power(results['tuned']['seas'], 0, c, b):.2f}", *grown))
    heads = ("", "measured", *(f"{w}, order {o}" for w in SETS.values() for o in (2, 1)))
    return ["#### Mean surge, and how standard deviations in a band grow with the significant height", "", table(heads, rows)]


def responses(results: dict[str, dict[str, Any]], potential: dict[str, list[list[float]]]) -> list[str]:
    """Transfer functions: is the convention right?"""
    rows = []
    for channel in MOTIONS:
        pairs = [results[name]["seas"][SEA]["response"][channel] for name in ("tuned", "fitted")]
        for i, f in enumerate(AT):
            (a, p, c, a2, p2, _), (*_, a3, p3, _) = (pair[i] for pair in pairs)
            flow = potential[channel][i]
            rows.append(
                (
                    f"{channel} ({UNITS[channel]}/m)",
                    f"{f:.2f}",
                    f"{c:.2f}",
                    *(f"{x:.3f}" for x in (a, a2, a3, flow[0])),
                    *(f"{x:.0f}" for x in (math.degrees(p), math.degrees(p2), math.degrees(p3), flow[1])),
                )
            )
        if channel == "surge":
            for i, f in enumerate(AT):
                keels = [results[name]["seas"][SEA]["keel"]["response"][i] for name in ("tuned", "fitted")]
                amounts, angles = [x[0] for x in keels], [math.degrees(x[1]) for x in keels]
                flow = potential["keel"][i]
                rows.append(
                    (
                        "surge at the keel (m/m)",
                        f"{f:.2f}",
                        "",
                        "",
                        *(f"{x:.3f}" for x in (*amounts, flow[0])),
                        "",
                        *(f"{x:.0f}" for x in (*angles, flow[1])),
                    )
                )
    sets = ("", f" {SETS[TUNED]}", f" {SETS[FITTED]}", " potential flow")
    heads = ("Motion", "f (Hz)", "Coherence", *(f"Amplitude{x}" for x in sets), *(f"Phase{x} (deg)" for x in sets))
    return [
        f"#### Transfer functions from the measured wave in {SEA}, order 2, MacCamy-Fuchs",
        "",
        "This checks signs, units and the gauge's place before an error is believed. A phase above 0 leads the wave.",
        "",
        table(heads, rows),
    ]
