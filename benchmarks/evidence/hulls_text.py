"""Text of the section on five public hulls."""

from typing import Any

from benchmarks.evidence.common import table
from benchmarks.evidence.hulls_cases import CASES, Case
from benchmarks.evidence.hulls_published import PUBLISHED

TITLES = {
    "oc3-hywind": "OC3-Hywind",
    "oc4-deepcwind": "OC4-DeepCwind",
    "volturnus-s": "VolturnUS-S",
    "iti-barge": "ITI Energy barge",
    "ship-section": "ship section, 0.4 m wide",
}
HEAD = ("Hull", "Quantity", "jaxhydro", "Published or independent", "Difference", "Source")
NUMPY = "plain NumPy, `evidence/hulls_reference.py`"
PANELS = "Capytaine, panels"
EXACT = 0.002  # goal for the difference of a period or a motion from those of the same strips in plain NumPy
UNITS = {"surge": "m/m", "sway": "m/m", "heave": "m/m", "roll": "rad/m", "pitch": "rad/m", "yaw": "rad/m"}


def percent(ratio: float) -> str:
    """A relative difference as people read it."""
    return f"{100 * ratio:+.2f} %" if abs(ratio) >= 5e-5 else "< 0.005 %"


def period_rows(name: str, results: dict[str, Any], panels: dict[str, Any]) -> list[tuple[str, ...]]:
    """Natural periods (s) against published ones, panels, and the same strips where these differ most."""
    rows = []
    for published in PUBLISHED.get(name, ()):
        for dof, frequency in published.frequency.items():
            period = 1 / frequency
            digits = 100 * published.rounding / frequency
            shown = f"{period:.2f}" if digits < 0.01 else f"{period:.4g} ± {digits:.1g} %"
            rows.append(
                (
                    TITLES[name],
                    f"{dof} period (s)",
                    f"{results['periods'][dof]:.2f}",
                    shown,
                    percent(results["periods"][dof] / period - 1),
                    published.source,
                )
            )
    for dof, period in panels.get(name, {}).get("periods", {}).items():
        if name != "volturnus-s":
            rows.append(
                (
                    TITLES[name],
                    f"{dof} period (s)",
                    f"{results['periods'][dof]:.4g}",
                    f"{period:.4g}",
                    percent(results["periods"][dof] / period - 1),
                    PANELS,
                )
            )
    dof = worst(results["periods"], results["reference"]["periods"])
    ours, reference = results["periods"][dof], results["reference"]["periods"][dof]
    rows.append(
        (
            TITLES[name],
            f"periods, largest difference: {dof} (s)",
            f"{ours:.4f}",
            f"{reference:.4f}",
            percent(ours / reference - 1),
            NUMPY,
        )
    )
    return rows


def worst(ours: dict[str, float], reference: dict[str, float]) -> str:
    """Which of the values that both have differs most."""
    return max((dof for dof in ours if dof in reference), key=lambda dof: abs(ours[dof] / reference[dof] - 1))


def motion_rows(name: str, case: Case, results: dict[str, Any], panels: dict[str, Any]) -> list[tuple[str, ...]]:
    """Motion per metre of wave amplitude against the same strips in plain NumPy, and against panels."""
    rows = []
    for dof in case.moved:
        quantity = f"{dof} in waves of {case.period:g} s ({UNITS[dof]})"
        ours = results["motion"][dof]
        references = [(results["reference"]["motion"][dof], NUMPY)]
        if name in panels:
            references.append((panels[name]["wave"]["motion"][dof], PANELS))
        rows += [(TITLES[name], quantity, f"{ours:.4g}", f"{x:.4g}", percent(ours / x - 1), source) for x, source in references]
    return rows


def furthest(name: str, results: dict[str, Any]) -> tuple[str, float]:
    """Motion of a hull that differs most from the same strips in plain NumPy, and the relative difference."""
    motion, reference = results[name]["motion"], results[name]["reference"]["motion"]
    dof = worst({dof: motion[dof] for dof in CASES[name].moved}, reference)
    return dof, motion[dof] / reference[dof] - 1


def words(results: dict[str, Any], variants: dict[str, Any], panels: dict[str, Any]) -> str:
    """Text of the section.

    Args:
        results: Periods and motion by hull.
        variants: Relative differences of the two variants of OC4-DeepCwind.
        panels: Periods and motion by panel method, by hull.
    """
    rows_of_periods, rows_of_motion = [], []
    for name, case in CASES.items():
        rows_of_periods += period_rows(name, results[name], panels)
        rows_of_motion += motion_rows(name, case, results[name], panels)
    largest = {label: max(abs(x) for kind in variant.values() for x in kind.values()) for label, variant in variants.items()}
    return (
        "The platforms are built in (`jaxhydro platforms`); their files have the source of every number. Mass, "
        "geometry and linearised mooring are published. Added mass is that of strips. The strips' coefficients follow from "
        "published or computed added mass in surge and heave. Periods of pitch, roll and yaw are predictions. Waves are small: "
        "1 cm high amplitudes, 0.2 mm for the ship section.\n\n"
        "**Natural periods**, undamped and coupled:\n\n"
        + table(HEAD, rows_of_periods)
        + "\nWhat explains the larger differences:\n\n"
        "- OC4-DeepCwind's published surge period belongs to other lines or another added mass. RAFT, with WAMIT's added mass "
        "and the same data of lines, has this page's.\n"
        "- OC4-DeepCwind's published pitch period is longer than RAFT's, this page's and that of panels, which "
        "agree to 3 %.\n"
        "- VolturnUS-S has Table 1's coefficients, tuned to another model of it ([see "
        "above](#volturnus-s-against-its-published-data)).\n"
        "- The barge's strips have the added mass of heave all over their length. Panels have less of it near the edges.\n"
        "- The ship section's strip has no added inertia of rolling about its own axis.\n\n"
        "**Motion in one regular wave**, per metre of wave amplitude:\n\n"
        + table(HEAD, rows_of_motion)
        + "\nThe same strips in plain NumPy share no code with jaxhydro. What differs by more than "
        f"{100 * EXACT:g} %:\n\n"
        "- The ship section rolls by the difference of two large moments. A floating strip takes the waves as linear across "
        "its section. Plain NumPy integrates them.\n\n"
        "Panels diffract and radiate waves, strips do not. Heave of OC4-DeepCwind in waves of 14 s is what is left of "
        "pressures that nearly cancel.\n\n"
        f"OC4-DeepCwind with every offset column as two members differs by {largest['two members']:.1g} from the one "
        "with a step in `stations`, in all periods and motions. "
        f"A model at 1:50 has the Froude-scaled values to {largest['1:50']:.1g}.\n"
    )


def shortcomings(results: dict[str, Any]) -> tuple[str, ...]:
    """Motions that differ from those of the same strips in plain NumPy."""
    short = []
    for name, case in CASES.items():
        dof, apart = furthest(name, results)
        if abs(apart) > EXACT:
            short.append(
                f"{TITLES[name]}: {dof} in waves of {case.period:g} s differs by {percent(apart)} from the same strips "
                f"in plain NumPy (goal {100 * EXACT:g} %)"
            )
    return tuple(short)
