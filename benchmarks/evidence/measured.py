"""Section 4: measured decays: a semi-submersible's surge and a ship's roll."""

from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence import common
from benchmarks.evidence.common import SHARED, Absent, Section, cached, fingerprint, keep, say, table
from calibration.formatting import number, percent, with_deviation

TITLE = "Measured decays"
FOLDER = SHARED / "measured"
CASES = {
    "focal-c4": "FOCAL campaign 4, release from a static surge offset, 1:70, full-scale values; fitted from its platform file",
    "kvlcc2": "KVLCC2 roll decay at zero speed, 1:68, model-scale values (Alexandersson and Kjellberg 2021, run 21337)",
}


def work(name: str, figures: Path) -> dict[str, Any]:
    """One campaign calibrated; its figures written."""
    from calibration.campaign.load_campaign import load_campaign
    from calibration.fitting.decay_fit import calibrate
    from calibration.plots.calibration_figures import test_figure
    from calibration.plots.decay_figures import decay_figure
    from jaxhydro import natural_modes
    from jaxhydro.dynamics.response import decay_cycles
    from jaxhydro.plots.style import save, style
    from jaxhydro.units import for_people

    result = calibrate(load_campaign(FOLDER / name))
    test = result.tests[0]
    main = test.main
    with style():
        save(test_figure(test), figures / f"{name}-record.png")
        cycles = decay_figure(main.channel, [test])
        if cycles is not None:
            save(cycles, figures / f"{name}-cycles.png")
    measured, simulated = (decay_cycles(test.time, x, main.noise) for x in (main.measured, main.simulated))
    n = min(len(measured.period), len(simulated.period))
    return {
        "channel": main.channel,
        "relative": main.relative,
        "rmse": float(for_people(main.channel, main.rmse)),
        "noise": float(for_people(main.channel, main.noise)),
        "scale": float(np.std(main.measured)),
        "iterations": result.iterations,
        "converged": result.converged,
        "seconds": result.seconds,
        "parameters": {k: [p.start, p.value, p.standard_deviation, p.unit] for k, p in result.parameters.items()},
        "natural_period": natural_modes(result.model).of(main.channel),
        "cycles": [
            [
                float(for_people(main.channel, measured.amplitude[i])),
                measured.period[i],
                simulated.period[i],
                measured.decrement[i],
                simulated.decrement[i],
            ]
            for i in range(n)
        ],
    }


def run(figures: Path) -> Section:
    """Both campaigns, each with a figure of its record and one of its cycles."""
    if not FOLDER.exists():
        raise Absent("the measured records (../shared/measured) are not on this machine")
    texts, drawn, short = [], [], []
    for name, words in CASES.items():
        key = fingerprint(FOLDER / name, Path(__file__))
        made = [figures / f"{name}-{kind}.png" for kind in ("record", "cycles")]
        found = cached("measured", key, name) if common.text_only or all(path.exists() for path in made) else None
        found = keep("measured", key, name, work(name, figures)) if found is None else found
        say(f"  {name}: relative error {found['relative']:.4f}, {found['iterations']} iterations")
        texts.append(words_of(name, words, found))
        short.append(lack(name, found))
        drawn += made
    return Section(TITLE, "\n\n".join(texts), tuple(drawn), tuple(short))


def lack(name: str, found: dict[str, Any]) -> str:
    """What the fitted model does not follow."""
    cycles = np.array(found["cycles"])
    changes = [100 * (third(cycles, i, True) / third(cycles, i, False) - 1) for i in (1, 2, 3, 4)]
    return (
        f"{name}: RMSE is {found['rmse'] / found['noise']:.0f} times the sensor's noise. From small to large amplitudes the "
        f"period changes by {changes[0]:+.2f} % measured and {changes[1]:+.2f} % simulated. The decrement changes by "
        f"{changes[2]:+.0f} % and {changes[3]:+.0f} %"
    )


def third(cycles: np.ndarray, column: int, large: bool) -> float:
    """Mean of a column over the third of the half cycles with the largest, or smallest, amplitudes."""
    order = np.argsort(cycles[:, 0])
    n = max(1, len(order) // 3)
    return float(cycles[order[-n:] if large else order[:n], column].mean())


def words_of(name: str, words: str, found: dict[str, Any]) -> str:
    """One campaign's part of the page."""
    unit = "deg" if found["channel"] in ("roll", "pitch", "yaw") else "m"
    rows = [
        (f"`{label}`", number(start, 3), with_deviation(value, sd) if sd is not None else "not identifiable", unit_of)
        for label, (start, value, sd, unit_of) in found["parameters"].items()
    ]
    cycles = np.array(found["cycles"])
    picks = sorted({int(i) for i in np.linspace(0, len(cycles) - 1, min(8, len(cycles)))})
    seen = [(f"{c[0]:.3g}", f"{c[1]:.3f}", f"{c[2]:.3f}", f"{c[3]:.4f}", f"{c[4]:.4f}") for c in cycles[picks]]
    lost = [label for label, p in found["parameters"].items() if p[2] is None]
    lines = [
        f"### {name}",
        "",
        f"{words}.",
        "",
        f"RMSE {number(found['rmse'], 2)} {unit}, {percent(found['relative'])} of the record's standard deviation, "
        f"{found['rmse'] / found['noise']:.0f} times the sensor's noise. What is left is the model's error, not noise. Natural "
        f"period of {found['channel']} of the fitted model: {found['natural_period']:.3f} s. "
        f"{'Converged' if found['converged'] else 'Not converged'} in {found['iterations']} iterations.",
        "",
        table(("Coefficient", "Start", "Calibrated", "Unit"), rows),
        f"This one record does not determine {', '.join(f'`{x}`' for x in lost)}.\n" if lost else "",
        f"Half cycles against amplitude ({unit}): period (s) and logarithmic decrement per cycle, measured and simulated:",
        "",
        table(("Amplitude", "Period", "simulated", "Decrement", "simulated"), seen),
        "From the largest third of the amplitudes to the smallest:\n\n"
        f"- The period goes from {third(cycles, 1, True):.3f} to {third(cycles, 1, False):.3f} s measured, "
        f"{third(cycles, 2, True):.3f} to {third(cycles, 2, False):.3f} s simulated.\n"
        f"- The decrement goes from {third(cycles, 3, True):.3f} to {third(cycles, 3, False):.3f} measured, "
        f"{third(cycles, 4, True):.3f} to {third(cycles, 4, False):.3f} simulated.",
    ]
    return "\n".join(lines)
