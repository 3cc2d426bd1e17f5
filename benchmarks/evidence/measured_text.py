"""Text of the section on measured decays."""

from typing import Any

import numpy as np

from benchmarks.evidence.common import table
from calibration.formatting import number, percent, with_deviation

CAPTIONS = {
    "focal-c4": "FOCAL campaign 4, release from a static surge offset, 1:70, full-scale values; fitted from its platform file",
    "kvlcc2": "KVLCC2 roll decay at zero speed, 1:68, model-scale values (Alexandersson and Kjellberg 2021, run 21337)",
}


def words(results: dict[str, dict[str, Any]]) -> str:
    """Text of the section, from the results by campaign."""
    return "\n\n".join(words_of(name, CAPTIONS[name], numbers) for name, numbers in results.items())


def shortcomings(results: dict[str, dict[str, Any]]) -> tuple[str, ...]:
    """What the fitted models do not follow."""
    return tuple(shortcoming(name, numbers) for name, numbers in results.items())


def shortcoming(name: str, numbers: dict[str, Any]) -> str:
    """What the fitted model does not follow."""
    cycles = np.array(numbers["cycles"])
    changes = [100 * (third(cycles, i, True) / third(cycles, i, False) - 1) for i in (1, 2, 3, 4)]
    noises = numbers["rmse"] / numbers["noise"]
    return (
        f"{name}: RMSE is {noises:.0f} times the sensor's noise. From small to large amplitudes the "
        f"period changes by {changes[0]:+.2f} % measured and {changes[1]:+.2f} % simulated. The decrement changes by "
        f"{changes[2]:+.0f} % and {changes[3]:+.0f} %"
    )


def third(cycles: np.ndarray, column: int, large: bool) -> float:
    """Mean of a column over the third of the half cycles with the largest, or smallest, amplitudes."""
    order = np.argsort(cycles[:, 0])
    n = max(1, len(order) // 3)
    return float(cycles[order[-n:] if large else order[:n], column].mean())


def words_of(name: str, caption: str, numbers: dict[str, Any]) -> str:
    """One campaign's part of the page."""
    unit = "deg" if numbers["channel"] in ("roll", "pitch", "yaw") else "m"
    rows = [
        (f"`{label}`", number(start, 3), with_deviation(value, sd) if sd is not None else "not identifiable", unit_of)
        for label, (start, value, sd, unit_of) in numbers["parameters"].items()
    ]
    cycles = np.array(numbers["cycles"])
    picks = sorted({int(i) for i in np.linspace(0, len(cycles) - 1, min(8, len(cycles)))})
    shown = [(f"{c[0]:.3g}", f"{c[1]:.3f}", f"{c[2]:.3f}", f"{c[3]:.4f}", f"{c[4]:.4f}") for c in cycles[picks]]
    noises = numbers["rmse"] / numbers["noise"]
    vague = [label for label, p in numbers["parameters"].items() if p[2] is None]
    lines = [
        f"### {name}",
        "",
        f"{caption}.",
        "",
        f"RMSE {number(numbers['rmse'], 2)} {unit}, {percent(numbers['relative'])} of the record's standard deviation, "
        f"{noises:.0f} times the sensor's noise. What is left is the model's error, not noise. Natural "
        f"period of {numbers['channel']} of the fitted model: {numbers['natural_period']:.3f} s. "
        f"{'Converged' if numbers['converged'] else 'Not converged'} in {numbers['iterations']} iterations.",
        "",
        table(("Coefficient", "Start", "Calibrated", "Unit"), rows),
        f"This one record does not determine {', '.join(f'`{x}`' for x in vague)}.\n" if vague else "",
        f"Half cycles against amplitude ({unit}): period (s) and logarithmic decrement per cycle, measured and simulated:",
        "",
        table(("Amplitude", "Period", "simulated", "Decrement", "simulated"), shown),
        "From the largest third of the amplitudes to the smallest:\n\n"
        f"- The period goes from {third(cycles, 1, True):.3f} to {third(cycles, 1, False):.3f} s measured, "
        f"{third(cycles, 2, True):.3f} to {third(cycles, 2, False):.3f} s simulated.\n"
        f"- The decrement goes from {third(cycles, 3, True):.3f} to {third(cycles, 3, False):.3f} measured, "
        f"{third(cycles, 4, True):.3f} to {third(cycles, 4, False):.3f} simulated.",
    ]
    return "\n".join(lines)
