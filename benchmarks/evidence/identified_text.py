"""Text of the section on what decays and a sea tell of the coefficients."""

from typing import Any

from benchmarks.evidence.common import table
from calibration.formatting import number, percent

CASES = {
    "decays": "nine decays",
    "energies": "and one sea, its energies",
    "motion": "and one sea, its motion",
}
VAGUE = 0.25  # a deviation, of the value, from which a coefficient is not known


def words(by_case: dict[str, dict[str, Any]], facts: dict[str, Any]) -> str:
    """Text of the section.

    Args:
        by_case: Results by case.
        facts: Number of decays, and the sea, as `identified_runs.facts` has them.
    """
    results = {label: by_case[name] for name, label in CASES.items()}
    first = next(iter(results.values()))
    rows = [
        [f"`{label}`", *(_cell(result["value"][label], result["deviation"][label]) for result in results.values())]
        for label in first["value"]
    ]
    spectra = table(
        ["Principal directions, deviation", *(str(i + 1) for i in range(len(first["spectrum"])))],
        [[name, *(percent(x) for x in result["spectrum"])] for name, result in results.items()],
    )
    sentences = "\n\n".join(
        f"From nine decays {name}:\n\n".replace("decays nine decays", "decays")
        + "\n".join(f"- {sentence}." for sentence in result["said"][:8])
        for name, result in results.items()
    )
    decays, sea, duration = (facts[key] for key in ("decays", "sea", "duration"))
    state = f"Hs {facts['height']:g} m, Tp {facts['period']:g} s"
    return f"""
The shared campaign `nothing-missing` is made by a NumPy model that shares nothing with the package. Its {decays} decays are
fitted alone, and then together with its test {sea} in irregular waves ({state}, {duration:.0f} s).
Of that test either the energies in the low and the wave-frequency band are fitted, or the motion sample by sample.
Value and standard deviation with coloured errors; in brackets what is known to no better than {100 * VAGUE:.0f} %:

{table(["Coefficient", *results], rows)}
Standard deviations along the principal directions of the coordinates, best known first:

{spectra}
In the words of the package:

{sentences}
"""


def _cell(value: float, deviation: float) -> str:
    return f"{number(value, 3)} ± {percent(deviation)}" if deviation < VAGUE else f"({number(value, 2)})"
