"""The words and tables of the section on the numerical tank."""

import math
from typing import Any

from benchmarks.evidence.common import TRUE, table
from benchmarks.evidence.numerical_tank_runs import DECAYS, EVERY, FITTED, HALF, HELD, REST, SEA, TRANSIENT
from benchmarks.evidence.numerical_tank_truth import REACH
from calibration.discovery.doubts import MAX_DECAY_RESIDUAL, MAX_RESIDUAL_RATIO
from calibration.discovery.effects.effect_names import effect_in_words
from calibration.formatting import listed, number, percent, quantity
from calibration.report.diagnosis_words import plain_name

HALVES = {FITTED: "fitted", HELD: "held out"}
BANDS = {"low_frequency": "low", "wave_frequency": "wave"}
ONCE = {"wave_excitation": (None,), "mooring_nonlinearity": ("surge",)}
MISSING = [
    (effect, motion)
    for effect in ("wave_excitation", "wave_drift", "quadratic_damping", "mooring_nonlinearity", "radiation_memory")
    for motion in ONCE.get(effect, DECAYS)
]
MENDED = 0.3  # of a band's energy: what is further off with what was found is said to fall short
IN_TABLES = ("wave_excitation", "wave_drift")
OF_TABLES = [("potential_flow", None), *(pair for pair in MISSING if pair[0] not in IN_TABLES)]
STRIP_DRIFT = ("slender_body_forces", None)  # theory's form for members of the forces in the tank's difference-frequency QTF
IN_WAVES = (*IN_TABLES, "quadratic_damping")  # of decays alone the last is what drag of strips is


def stages(results: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """Errors by stage of the model."""
    return {
        "as declared": results["declared"]["errors"],
        "calibrated to decays": results["calibrated"]["errors"],
        "fitted to decays and sea": results["all"]["before"]["errors"],
        "with what was found": results["all"]["after"]["errors"],
        "with what was found, tables among candidates": results["tables"]["after"]["errors"],
    }


def decays_table(results: dict[str, Any]) -> str:
    """RMSE over the standard deviation of the released motion."""
    columns = stages(results) | {"decays alone, with what was found": results["decays"]["after"]["errors"]}
    rows = [(dof, *(percent(errors[dof]["relative"][dof]) for errors in columns.values())) for dof in DECAYS]
    return table(("Decay", *columns), rows)


def sea_table(results: dict[str, Any]) -> str:
    """Errors of energies in bands, of the mean of surge, and RMSE over the standard deviation."""
    columns, rows = stages(results), []
    for test, half in HALVES.items():
        for dof in DECAYS:
            for band, name in BANDS.items():
                cells = [f"{100 * errors[test]['bands'][dof][band]:+.0f} %" for errors in columns.values()]
                rows.append((f"{half}: {dof}, {name}", *cells))
        means = [errors[test]["mean"]["surge"] for errors in columns.values()]
        rows.append((f"{half}: mean surge, {means[0][0]:.2f} m", *(f"{simulated:.2f} m" for _, simulated in means)))
        for dof in DECAYS:
            rows.append((f"{half}: RMSE of {dof}", *(percent(errors[test]["relative"][dof]) for errors in columns.values())))
    return table(("Half of the sea", *columns), rows)


def effects_table(diagnosis: dict[str, Any]) -> str:
    """What was found, a row for every parameter."""
    rows = []
    for effect in diagnosis["effects"]:
        head = effect["effect"] + (f".{effect['motion']}" if effect["motion"] else "")
        evidence = (number(effect["bic"], 3), percent(effect["held"]), f"{effect['clear']:.0f}")
        for i, (label, (value, deviation, unit)) in enumerate(effect["parameters"].items()):
            size = quantity(value, deviation, unit) if deviation is not None else f"({quantity(value, None, unit)})"
            name = plain_name(label.removeprefix(f"{head}.").removeprefix(f"{effect['effect']}."))
            about, judged_by = (named(effect), evidence) if i == 0 else ("", ("", "", ""))
            rows.append((about, name, size, *judged_by))
    return table(("Effect", "Parameter", "Value ± 1 sd", "BIC falls by", "Held-out gain", "sd from none"), rows)


def named(effect: dict[str, Any]) -> str:
    """An effect that was found, and whether it is in doubt."""
    return effect_in_words(effect["effect"], effect["motion"]) + ("" if effect["in_doubt"] is None else " (in doubt)")


def said_of(diagnosis: dict[str, Any], effect: str, motion: str | None) -> str:
    """What became of an effect in a motion."""
    for claim in diagnosis["effects"]:
        if (claim["effect"], claim["motion"]) == (effect, motion):
            return "**found**"
    if effect == "wave_drift" and STRIP_DRIFT in ((claim["effect"], claim["motion"]) for claim in diagnosis["effects"]):
        return f"**found in part**, as {effect_in_words(*STRIP_DRIFT)}"
    for name, dof, reason in diagnosis["rejected"]:
        if (name, dof) == (effect, motion):
            return reason
    return "not tried"


def missing_table(results: dict[str, Any], tank: dict[str, Any]) -> str:
    """What the tank has and strips do not, its size, and what the diagnoses say of it."""
    rows = []
    for effect, motion in MISSING:
        alone = "–" if effect in IN_WAVES else said_of(results["decays"], effect, motion)
        outcome = said_of(results["all"], effect, motion)
        rows.append((effect_in_words(effect, motion), size_of(effect, motion, tank), outcome, alone))
    return table(("In the tank", "Its size", "Decays and sea", "Decays alone"), rows)


def excitation(tank: dict[str, Any]) -> str:
    """The strips' first-order excitation at the waves' peak beside WAMIT's."""
    loads = tank["excitation"]
    shares = listed([f"{100 * a / b:.0f} % in {motion}" for motion, (a, b, _) in loads.items()])
    ahead = sorted(-math.degrees(angle) for _, _, angle in loads.values())
    return f"strips have {shares} of WAMIT's, {ahead[0]:.0f} to {ahead[-1]:.0f} deg ahead of it"


def size_of(effect: str, motion: str | None, tank: dict[str, Any]) -> str:
    """How large an effect is in the tank."""
    if effect == "wave_excitation":
        return excitation(tank)
    if effect == "mooring_nonlinearity":
        moving, even, cubic = tank["mooring"]["static"]
        return f"{quantity(moving, None, 'N/m')}, even {number(even, 3)} N/m², cubic {number(cubic, 3)} N/m³"
    unit = "N" if motion != "pitch" else "N m"
    if effect == "wave_drift":
        force = tank["drift"][motion]
        return f"mean {quantity(force['mean'], None, unit)}, slow sd {quantity(force['slow'], None, unit)}"
    if effect == "quadratic_damping":
        per = "N s²/m²" if motion != "pitch" else "N m s²/rad²"
        return f"{quantity(tank['quadratic'][motion], None, per)}, by the platform's own velocity"
    radiation = tank["radiation"][motion]
    per = "N s/m" if motion != "pitch" else "N m s/rad"
    waves, natural = (quantity(radiation["damping"][k], None, per) for k in ("waves", "natural"))
    change = radiation["added"]["natural"] / radiation["added"]["waves"] - 1
    return f"damping {waves} at the waves' peak, {natural} at the natural period; added mass {100 * change:+.0f} %"


def coefficients_table(results: dict[str, Any]) -> str:
    """What the coefficients become."""
    fits = [results["calibrated"]["parameters"], *(results["all"][k]["parameters"] for k in ("before", "after"))]
    fits += [results["decays"]["after"]["parameters"]]
    rows = []
    for label in fits[0]:
        declared = TRUE[label]
        cells = [quantity(fit[label][0], fit[label][1], fit[label][2]) for fit in fits]
        cells = [cell if fit[label][1] is not None else f"({cell})" for cell, fit in zip(cells, fits)]
        rows.append((f"`{label}`", quantity(declared, None, fits[0][label][2]), *cells))
    heads = ("calibrated to decays", "fitted to decays and sea", "with what was found", "decays alone, with what was found")
    return table(("Coefficient", "declared", *heads), rows)


def drift_table(tank: dict[str, Any]) -> str:
    """Second-order forces of the tank against the laws found."""
    rows = []
    for motion, force in tank["drift"].items():
        unit = "N" if motion != "pitch" else "N m"
        law = [quantity(x, None, unit) for x in force["law"]] if force["law"] else ["–", "–"]
        alike = f"{force['correlation']:.2f}" if force["law"] else "–"
        rows.append((motion, quantity(force["mean"], None, unit), law[0], quantity(force["slow"], None, unit), law[1], alike))
    heads = ("Mean in the tank", "of the law found", "Slow sd in the tank", "of the law found", "Correlation")
    return table(("Second-order force", *heads), rows)


def words(results: dict[str, Any], tank: dict[str, Any], setup: dict[str, Any]) -> str:
    """Text of the section.

    Args:
        results: Results of the calibration and of the diagnoses.
        known: What is known of the tank.
        setup: Numbers of the strip model.
    """
    joint, alone = results["all"], results["decays"]
    lines, held = tank["mooring"], joint["objective"]["holdout"]
    surge = [percent(stages(results)[k][HELD]["relative"]["surge"]) for k in ("calibrated to decays", "with what was found")]
    stiff, at_rest = (quantity(x, None, "N/m") for x in (setup["AddCLin"][0][0], lines["static"][0]))
    return f"""
OpenFAST's runs with potential flow are given to `jaxhydro diagnose` as if they were measured.

- *Tank*: `decay_*_nwt` and `{SEA}` of the shared reference runs. They have radiation with memory, the full
difference-frequency QTF, catenary lines and quadratic damping. Waves are of first order, which the campaign states.
- *Records*: every {EVERY}th sample, with noise of 0.01 m in surge, 0.005 m in heave and 0.01 deg in pitch.
- *Baseline*: that of OpenFAST's runs by strips. It has the same rigid body, Table 1's coefficients, linear damping and a
linear mooring. Waves meet it at its mean position (`waves_at: mean`), as in the tank, where `ExctnDisp` is 0.
- *Fit*: three decays and the sea's first half, from {TRANSIENT:.0f} to {HALF:.0f} s. The second half is held out.
- *Mooring*: no run is a static pull-out (`{REST}` rests at zero). So the declared mooring is the tangent at rest, the stiffness
matrix of the runs by strips. It is {stiff} in surge, where catenaries of these lines give {at_rest}.

RMSE over the standard deviation of the released motion:

{decays_table(results)}
Errors of energies in the paper's bands, (simulated - measured) / measured; the mean of surge; RMSE over the standard
deviation, offset included:

{sea_table(results)}
**Decays and sea**: {verdict_of(joint)} J of the held-out half goes from {held[0]:.2f} to {held[1]:.2f}; RMSE of surge there is
{surge[1]} with what was found and {surge[0]} with the coefficients of the decays.

{effects_table(joint) if joint["effects"] else ""}
**The decays alone**, blocks left out in turn: {verdict_of(alone)}

{effects_table(alone) if alone["effects"] else ""}
**The tank's own tables among the candidates.** They are `radiation`, `excitation` and `drift` of the platform file, with
`use: candidate`. These are the WAMIT files that OpenFAST's forces are made of. A share of 1 is the truth.

The verdict: {verdict_of(results["tables"])} J of the
held-out half becomes {results["tables"]["objective"]["holdout"][1]:.2f}. Not in the tank:
{listed(not_there(results["tables"], OF_TABLES)) or "nothing of that"}. Beside the tables strips still have a drift, an
excitation by their drag and a viscous damping of their own.

{effects_table(results["tables"]) if results["tables"]["effects"] else ""}
What the tank has and the strips do not, and what becomes of it (*slow*: in the motion's low-frequency band):

{missing_table(results, tank)}
{drift_table(tank)}
Coefficients, in brackets those that the records do not determine:

{coefficients_table(results)}
{reasons(results, tank)}
"""


def reasons(results: dict[str, Any], tank: dict[str, Any]) -> str:
    """Why the diagnosis says what it says."""
    diagnosis = results["all"]
    fits = [results["calibrated"], diagnosis["before"], diagnosis["after"]]
    damping = [quantity(fit["parameters"]["linear_damping.B11"][0], None, "N s/m") for fit in fits]
    waves = [100 * fit["errors"][FITTED]["bands"]["surge"]["wave_frequency"] for fit in fits]
    decay = [percent(fit["errors"]["surge"]["relative"]["surge"]) for fit in fits]
    lines = tank["mooring"]
    settled = "" if all(diagnosis["converged"]) else " One of these fits had not settled when it was stopped."
    static, moving = lines["static"], lines["moving"]
    drifted, drifts = results["declared"]["errors"][FITTED]["mean"]["surge"]
    secants = [f"{quantity(lines['secant'][f'{x:+g}'], None, 'N/m')} ({x:+g} m)" for x in (-REACH, REACH)]
    gauge = said_of(diagnosis, "wave_gauge_position", None)
    return f"""
**First-order excitation.** At the waves' peak {excitation(tank)}. `wave_excitation` is a coefficient of pressure by group of
members and has no phase of its own. A wave gauge elsewhere would shift phases (here: {gauge}). The error of wave-frequency
surge is {waves[0]:+.0f} % with the decays' coefficients. It is {waves[1]:+.0f} % where these are fitted to the sea as well, and
{waves[2]:+.0f} % with what was found.

**Slow motion.** `linear_damping.B11` is {damping[0]} by the decays, {damping[1]} fitted to decays and sea, {damping[2]} with
what was found. Of the surge decay {decay[0]}, {decay[1]} and {decay[2]} are left.{settled} The tank's quadratic damping goes
with the platform's own velocity. Drag of strips goes with the velocity relative to the water, which in waves drifts them. Their
mean surge as declared is {drifts:.2f} m, the tank's {drifted:.2f} m. So a law of drift that is found beside this drag is no
estimate of the tank's force, as the table of their sizes shows.

**Radiation** damps motions at the waves' frequencies and is next to nothing at the natural periods. Decays cannot tell it.

**The lines'** stiffness in surge goes from {" to ".join(secants)}, secants of static catenaries. Where lines drag in the decay
its linear part is {quantity(moving[0], None, "N/m")} beside {quantity(static[0], None, "N/m")}.
"""


def verdict_of(diagnosis: dict[str, Any]) -> str:
    """The verdict in a sentence or two."""
    names = listed([named(effect) for effect in diagnosis["effects"]])
    share, signature = diagnosis["unexplained"]
    head = {"found": f"*found*, {names}", "nothing_missing": "*nothing missing*"}.get(diagnosis["verdict"], "*unexplained*")
    verdict = f"{head}. {percent(share)} of the error's energy is left: {signature.rstrip('.')}."
    return " ".join([verdict, *(f"{words.split(';')[0]}." for _, words in diagnosis["latent"])])


def not_there(diagnosis: dict[str, Any], present: list[tuple[str, str | None]]) -> list[str]:
    """Names of what was found and is not in the tank."""
    pairs = [(effect["effect"], effect["motion"]) for effect in diagnosis["effects"]]
    return [effect_in_words(*pair) for pair in pairs if pair not in present]


def shortcomings(results: dict[str, Any]) -> tuple[str, ...]:
    """What falls short."""
    errors = results["all"]["after"]["errors"]
    sea_errors = [
        f"{dof} {BANDS[band]} {100 * error:+.0f} %"
        for dof in DECAYS
        for band, error in errors[HELD]["bands"][dof].items()
        if abs(error) > MENDED
    ]
    lost = [pair for pair in MISSING if not any("**found" in said_of(results[k], *pair) for k in ("all", "decays"))]
    decay = [fit_errors["surge"]["relative"]["surge"] for fit_errors in (results["calibrated"]["errors"], errors)]
    short = []
    if sea_errors:
        short.append(f"numerical tank: with what was found, the held-out sea is off by {', '.join(sea_errors)}")
    if decay[1] > max(MAX_DECAY_RESIDUAL, MAX_RESIDUAL_RATIO * decay[0]):
        short.append(
            f"numerical tank: fitted with a sea, the surge decay is given up: {percent(decay[1])} of it is left with "
            f"what was found, {percent(decay[0])} where the decays are fitted alone"
        )
    for effect in dict.fromkeys(effect for effect, _ in lost):
        names = [effect_in_words(*pair) for pair in lost if pair[0] == effect]
        short.append(f"numerical tank: there and not found: {listed(names)}")
    if wrong := not_there(results["all"], [*MISSING, STRIP_DRIFT]):
        short.append(f"numerical tank: found and not there: {listed(wrong)}")
    if wrong := not_there(results["tables"], OF_TABLES):
        short.append(f"numerical tank: with its own tables as candidates. Found and not there: {listed(wrong)}")
    return tuple(short)
