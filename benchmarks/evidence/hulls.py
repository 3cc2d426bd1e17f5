"""Section: natural periods of five public hulls and their motion in one regular wave, by other ways."""

import json
from pathlib import Path
from typing import Any

from benchmarks.evidence import hulls_cases
from benchmarks.evidence.common import Section, cached, fingerprint, say, table
from benchmarks.evidence.hulls_cases import CASES, HULLS, PLATFORMS, Case

TITLE = "Five public hulls"
POTENTIAL = HULLS / "potential-flow.json"
HEAD = ("Hull", "Quantity", "jaxhydro", "Published or independent", "Difference", "Source")
NUMPY = "plain NumPy, `evidence/hulls_reference.py`"
PANELS = "Capytaine, panels"
EXACT = 0.002  # goal for the difference of a period or a motion from those of the same strips in plain NumPy
UNITS = {"surge": "m/m", "sway": "m/m", "heave": "m/m", "roll": "rad/m", "pitch": "rad/m", "yaw": "rad/m"}


def percent(ratio: float) -> str:
    """A relative difference as people read it."""
    return f"{100 * ratio:+.2f} %" if abs(ratio) >= 5e-5 else "< 0.005 %"


def period_rows(name: str, case: Case, found: dict[str, Any], panels: dict[str, Any]) -> list[tuple[str, ...]]:
    """Natural periods (s) against what is published and against panels; of the same strips, the largest difference."""
    rows = []
    for published in case.published:
        for dof, frequency in published.frequency.items():
            period = 1 / frequency
            digits = 100 * published.rounding / frequency
            shown = f"{period:.2f}" if digits < 0.01 else f"{period:.4g} ± {digits:.1g} %"
            rows.append(
                (
                    case.title,
                    f"{dof} period (s)",
                    f"{found['periods'][dof]:.2f}",
                    shown,
                    percent(found["periods"][dof] / period - 1),
                    published.source,
                )
            )
    for dof, period in panels.get(name, {}).get("periods", {}).items():
        if name != "volturnus-s":
            rows.append(
                (
                    case.title,
                    f"{dof} period (s)",
                    f"{found['periods'][dof]:.4g}",
                    f"{period:.4g}",
                    percent(found["periods"][dof] / period - 1),
                    PANELS,
                )
            )
    dof = worst(found["periods"], found["reference"]["periods"])
    ours, theirs = found["periods"][dof], found["reference"]["periods"][dof]
    rows.append(
        (
            case.title,
            f"periods, largest difference: {dof} (s)",
            f"{ours:.4f}",
            f"{theirs:.4f}",
            percent(ours / theirs - 1),
            NUMPY,
        )
    )
    return rows


def worst(ours: dict[str, float], theirs: dict[str, float]) -> str:
    """Which of the values that both have differs most."""
    return max((dof for dof in ours if dof in theirs), key=lambda dof: abs(ours[dof] / theirs[dof] - 1))


def motion_rows(name: str, case: Case, found: dict[str, Any], panels: dict[str, Any]) -> list[tuple[str, ...]]:
    """Motion per metre of wave amplitude against the same strips in plain NumPy, and against panels."""
    rows = []
    for dof in case.moved:
        quantity = f"{dof} in waves of {case.period:g} s ({UNITS[dof]})"
        ours = found["motion"][dof]
        others = [(found["reference"]["motion"][dof], NUMPY)]
        if name in panels:
            others.append((panels[name]["wave"]["motion"][dof], PANELS))
        rows += [(case.title, quantity, f"{ours:.4g}", f"{x:.4g}", percent(ours / x - 1), source) for x, source in others]
    return rows


def two_members() -> dict[str, Any]:
    """OC4-DeepCwind with its step as two members, and at 1:50, over the stepped full-scale one, less 1."""
    from benchmarks.evidence.hulls_runs import model_of, motion, periods, platform_of

    case = CASES["oc4-deepcwind"]
    plain, found = platform_of(case), {}
    first = model_of(plain)
    whole, moving = periods(first), motion(first, case)
    for label, platform, scale in (
        ("two members", hulls_cases.two_members(plain), 1.0),
        ("1:50", hulls_cases.scaled(plain, 1 / 50), 1 / 50),
    ):
        model = model_of(platform)
        other, waves = periods(model), motion(model, case, scale)
        turned = {dof: waves[dof] * (scale if dof == "pitch" else 1.0) / moving[dof] - 1 for dof in case.moved}
        found[label] = {"periods": {dof: other[dof] / scale**0.5 / whole[dof] - 1 for dof in whole}, "motion": turned}
    return found


def run(figures: Path) -> Section:
    """All hulls, and the two variants of OC4-DeepCwind."""
    from benchmarks.evidence import hulls_runs

    beside = [Path(__file__).with_name(f"{part}.py") for part in ("hulls_cases", "hulls_runs", "hulls_reference")]
    key = fingerprint(HULLS, PLATFORMS, *beside)
    results = {name: cached("hulls", key, name, lambda case=case: hulls_runs.worked_out(case)) for name, case in CASES.items()}
    return text(results, cached("hulls", key, "variants", two_members), json.loads(POTENTIAL.read_text("utf-8")))


def text(results: dict[str, Any], variants: dict[str, Any], panels: dict[str, Any]) -> Section:
    """Section of the page from the results by hull, by variant, and by panel method."""
    rows_of_periods, rows_of_motion, short = [], [], []
    for name, case in CASES.items():
        found = results[name]
        rows_of_periods += period_rows(name, case, found, panels)
        rows_of_motion += motion_rows(name, case, found, panels)
        dof = worst({d: found["motion"][d] for d in case.moved}, found["reference"]["motion"])
        apart = found["motion"][dof] / found["reference"]["motion"][dof] - 1
        say(f"  {name}: {dof} in waves differs most from plain NumPy, {percent(apart)}")
        if abs(apart) > EXACT:
            short.append(
                f"{case.title}: {dof} in waves of {case.period:g} s differs by {percent(apart)} from the same strips "
                f"in plain NumPy (goal {100 * EXACT:g} %)"
            )
    largest = {label: max(abs(x) for kind in one.values() for x in kind.values()) for label, one in variants.items()}
    body = (
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
    return Section(TITLE, body, (), tuple(short))
