"""What the paper's eleven coefficients can be told from: nine decays, and nine decays with one sea."""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence.common import SHARED, Absent, Section, fingerprint, parallel, say, table

NAME = "identified"
TITLE = "What nine decays tell of eleven coefficients, and a sea beside them"
FOLDER = SHARED / "campaigns" / "nothing-missing"
CASES = {
    "nine decays": (("decays",), "bands"),
    "and one sea, its energies": (("decays", "waves"), "bands"),
    "and one sea, its motion": (("decays", "waves"), "motion"),
}
VAGUE = 0.25  # a deviation, of the value, from which a coefficient is not known


def of_case(sea: str, name: str) -> dict[str, Any]:
    """One calibration and its statement."""
    from calibration import calibrate_jointly, load_campaign
    from calibration.campaign.manifest import Recording

    campaign, (kinds, objective) = load_campaign(FOLDER), CASES[name]
    linear = campaign.manifest.model_copy(update={"records": Recording(order=1)})  # as the README of the campaigns says
    records = tuple(
        replace(r, use="fit" if r.kind == "decay" or (r.id == sea and "waves" in kinds) else "ignore") for r in campaign.records
    )
    found = calibrate_jointly(replace(campaign, manifest=linear, records=records), kinds=kinds, objective=objective)  # type: ignore[arg-type]
    known = found.identifiability
    assert known is not None
    deviation = np.sqrt(np.diag(known.covariance)) * np.abs(known.parameters.relative())
    return {
        "deviation": dict(zip(known.parameters.labels, map(float, deviation), strict=True)),
        "value": {label: one.value for label, one in found.parameters.items()},
        "spectrum": np.sort(known.spectrum).tolist(),
        "said": list(known.sentences()),
        "seconds": found.seconds,
    }


def run(figures: Path, processes: int) -> Section:
    """Both, side by side."""
    from calibration import load_campaign

    if not FOLDER.is_dir():
        raise Absent("../shared/campaigns has no nothing-missing")
    records = load_campaign(FOLDER).records
    decays = [r.id for r in records if r.kind == "decay"]
    sea = next(r for r in records if r.kind == "irregular")
    results = {}
    for name, found in parallel(NAME, fingerprint(FOLDER, TITLE), tuple(CASES), partial(of_case, sea.id), processes):
        say(f"  {name}: {found['seconds']:.0f} s")
        results[name] = found
    return Section(TITLE, words({name: results[name] for name in CASES}, len(decays), sea))


def words(results: dict[str, dict[str, Any]], decays: int, sea: Any) -> str:
    """The section."""
    from calibration.formatting import percent

    first = next(iter(results.values()))
    rows = [
        [f"`{label}`", *(_cell(found["value"][label], found["deviation"][label]) for found in results.values())]
        for label in first["value"]
    ]
    spectra = table(
        ["Principal directions, deviation", *(str(i + 1) for i in range(len(first["spectrum"])))],
        [[name, *(percent(x) for x in found["spectrum"])] for name, found in results.items()],
    )
    said = "\n\n".join(
        f"From nine decays {name}:\n\n".replace("decays nine decays", "decays")
        + "\n".join(f"- {sentence}." for sentence in found["said"][:8])
        for name, found in results.items()
    )
    state = f"Hs {sea.test.significant_wave_height:g} m, Tp {sea.test.peak_period:g} s"
    return f"""
The shared campaign `nothing-missing` is made by a NumPy model that shares nothing with the package. Its {decays} decays are
fitted alone, and then together with its test {sea.id} in irregular waves ({state}, {np.ptp(sea.time):.0f} s).
Of that test either the energies in the low and the wave-frequency band are fitted, or the motion sample by sample.
Value and standard deviation with coloured errors; in brackets what is known to no better than {100 * VAGUE:.0f} %:

{table(["Coefficient", *results], rows)}
Standard deviations along the principal directions of the coordinates, best known first:

{spectra}
In the words of the package:

{said}
"""


def _cell(value: float, deviation: float) -> str:
    from calibration.formatting import number, percent

    return f"{number(value, 3)} ± {percent(deviation)}" if deviation < VAGUE else f"({number(value, 2)})"
