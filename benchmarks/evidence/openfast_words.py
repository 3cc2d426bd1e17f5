"""The text of the section on waves against OpenFAST, and the mean drift of one cylinder that it quotes."""

from typing import Any

import numpy as np
from scipy.special import h1vp

from jaxhydro.waves.diffraction import maccamy_fuchs

DOFS = ("surge", "heave", "pitch")


def cylinder_drift(ka: float) -> float:
    """Mean drift force over rho g a A^2 on a vertical cylinder in deep water, by MacCamy and Fuchs's potential.

    Integral of the mean pressure of second order over the side and the waterline; 5 pi^2/16 (ka)^3 in long waves.
    """
    angle = np.linspace(0.0, 2 * np.pi, 2000, endpoint=False)
    m = np.arange(30)
    share = np.where(m == 0, 1, 2) * 1j**m * 2j / (np.pi * ka * h1vp(m, ka))
    wave, slope = share @ np.cos(np.outer(m, angle)), -(share * m) @ np.sin(np.outer(m, angle))
    pressure = 0.25 * (np.abs(slope / ka) ** 2 + np.abs(wave) ** 2) - 0.5 * np.abs(wave) ** 2
    return float(np.pi * (pressure * np.cos(angle)).mean())


def strip_drift(ka: float) -> float:
    """The same by strips under vertical stretching: the mean of the surface times the force on the strip at z = 0."""
    return float(-0.5 * np.pi * ka * np.asarray(maccamy_fuchs(np.array(ka))).imag)


def words(loads: dict[str, Any], motions: dict[str, Any], seas: dict[str, Any], tables: tuple[str, str, str]) -> str:
    """The section's text around its three tables."""

    def largest(part: str, key: str, names: Any = tuple(motions)) -> str:
        return f"{100 * max(motions[n][part][key] for n in names if part in motions[n]):.2g} %"

    smooth = [n for n in motions if not n.endswith(("c3", "c4"))]
    held = max(one["gauss"][x]["rms"] for one in loads.values() for x in ("Fx", "Fz", "My"))
    plain = max(loads[c]["nodes"][x]["rms"] for c in ("c1", "c2", "c1mcf") for x in ("Fx", "Fz"))
    fine = max(x["rms"] for x in loads["c1_fine"]["gauss"].values())
    moment = max(one["nodes"]["My"]["rms"] for one in loads.values() if "nodes" in one)
    left_out = max(one["elevation"] for one in motions.values() if "elevation" in one)
    step = max(abs(one["step"][d] - one["whole"][d]) for one in motions.values() for d in DOFS)
    ss1, ss2 = seas["ss1"], seas["ss2"]
    own, lag, base, tank = (ss1[k] for k in ("**all five: the default**", "diffraction with its lag", "base", "tank"))
    own_step = max(abs(one["half"][k] / one["**all five: the default**"][k] - 1) for one in seas.values() for k in base)
    ratios = ", ".join(f"{100 * strip_drift(ka) / cylinder_drift(ka):.0f} % at ka = {ka:g}" for ka in (0.1, 0.3, 0.5, 1.0))
    met = {True: "met", False: "not met"}
    motions_met = met[all(one["whole"][d] <= 0.05 for one in motions.values() for d in DOFS)]
    ours, theirs = motions["ss1_c3"]["ours"], motions["ss1_c3"]["theirs"]
    stretched = largest("whole", "surge", ("free_comp_c3", "ss1_c3", "ss1_c4"))
    return (
        "OpenFAST v5.0.0 and this package have the same strips. The waves are five components (`comp`) or a JONSWAP sea: "
        "ss1 (Hs 3.1 m, Tp 8.96 s) and ss2 (Hs 8.1 m, Tp 12.8 s). The cases are:\n\n"
        "- c1: first order\n"
        "- c2: second order\n"
        "- c3: second order with vertical stretching and MacCamy-Fuchs on the outer columns\n"
        "- c4: as c3 with shorter pontoon elements\n\n"
        "The first comparisons use OpenFAST's conventions here too:\n\n"
        "- Loads act in the directions of the undisplaced platform.\n"
        "- Without stretching, loads act on what is wet of the upright platform.\n"
        "- Diffraction is without its lag, of free waves only, and not on the centre column.\n"
        "- There is no set-down. Of the difference waves only those below OpenFAST's limit of 0.75 rad/s are there.\n\n"
        "**Loads on the platform held upright**: root mean square of the difference over OpenFAST's standard deviation "
        f"(goal 2 %: {met[held <= 0.02]}).\n\n"
        + tables[0]
        + "\nWhat is left is OpenFAST's lumping of loads at nodes 2.5 m apart, where this package integrates by Gauss points. "
        f"With strips at its nodes forces differ by at most {100 * plain:.2g} % where the waterline stays. From its run with "
        f"elements of 1 m forces and moments differ by {100 * fine:.2g} %. With nodes moments stay {100 * moment:.2g} % apart, "
        "probably by the arms that its end nodes give to their half elements.\n\n"
        "**Motions** from rest in the same waves, by four-step Adams-Bashforth at 0.25 s. The table has the root mean square "
        f"of the difference over the standard deviation (goal 5 %: {motions_met}). In the last three columns the strips are at "
        "OpenFAST's nodes. The kinematics are on its grid, 5 m apart (2.5 m in `comp`), interpolated by a cubic, at 0.125 s. "
        f"Sway, roll and yaw stay below {max(one['others'] for one in motions.values()):.0e} m or deg.\n\n"
        + tables[1]
        + f"\nWithout stretching surge differs by up to {largest('whole', 'surge', smooth)}, slowly. This is OpenFAST's grid: "
        f"with it {largest('numerics', 'surge', smooth)} are left. With stretching surge differs by up to {stretched}, and its "
        f"low-frequency energy in `ss1_c3` by {100 * (ours['surge l'] / theirs['surge l'] - 1):+.1f} %. Neither grid nor nodes "
        "explain this. OpenFAST puts the load on the element at the waterline on the two nodes below, 2.5 m apart. The mean "
        "and slow surge are small differences of large loads there. That was not shown to be the cause. Half the time "
        f"step changes these differences by at most {100 * step:.1g} % of a deviation.\n\n"
        "**What OpenFAST leaves out.** Its elevation of second order misses "
        f"{100 * left_out:.0f} % (root mean square) of that of all pairs. The missing part is the difference waves above 0.75 "
        "rad/s, the limit with which this data set was made (*all difference waves* below). The set-down does not matter: "
        f"{1e3 * ss1['set-down']:.1g} mm in ss1 and {1e3 * ss2['set-down']:.1g} mm in ss2.\n\n"
        "**What this package's own conventions change** in case 3: one at a time, then all, relative to OpenFAST's conventions "
        f"in this package. (At half the step the default's figures change by at most {100 * own_step:.1g} %.) The last row of "
        "the first sea is OpenFAST's potential-flow model of the hull. It has full difference-frequency loads, radiation and "
        "catenary lines. Its mooring and added mass are different, but it has the loads that strips lack.\n\n"
        + tables[2]
        + "\nThe lag of diffraction matters most; OpenFAST drops it. Under a stretched surface the lag gives the force on the "
        "wet part above still water a mean. Mean surge and low-frequency energy of surge in ss1 are:\n\n"
        f"- with OpenFAST's conventions here {base['mean']:.2f} m and {base['surge l']:.2f} m²\n"
        f"- with the lag {lag['mean']:.2f} m and {lag['surge l']:.2f} m²\n"
        f"- with all the default conventions {own['mean']:.2f} m and {own['surge l']:.2f} m²\n"
        f"- by potential flow {tank['mean']:.2f} m and {tank['surge l']:.2f} m²\n\n"
        "The force from the lag is nearly the drift force of a cylinder. MacCamy and Fuchs's potential gives the mean force on "
        f"one column in deep water. Strips give this share of it: {ratios}. Without the lag strips give nothing. In the long "
        "waves of ss2 the lag matters less.\n\n"
        "Wheeler's stretching moves the whole profile, at the keel too. With pontoons that makes slow vertical loads of "
        "the order of those of second order. Second-order waves have these loads already.\n"
    )
