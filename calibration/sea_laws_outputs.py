"""What laws over the sea state leave behind: sea_laws.json, coefficients.csv and a figure, beside the chosen calibration."""

import csv
import io
from collections.abc import Iterator
from os import PathLike
from pathlib import Path
from typing import Any

from calibration.folder import FIGURES, LAWS, TABLE, or_null, write_json
from calibration.formatting import number, percent, with_deviation
from calibration.outputs import drag_laws
from calibration.result import Calibration
from calibration.sea_laws import SeaLaws
from calibration.tables import Rows
from jaxhydro.files import safe_name, staged
from jaxhydro.loads.sea_state_law import reference_of
from jaxhydro.waves.sea_state import SeaState

NAMES = {
    "constant": "constant", "significant_height": "power of Hs", "peak_period": "power of Tp", "both": "powers of Hs and Tp",
    "keulegan_carpenter": "power of KC", "high_pass": "slow motion apart",
}  # fmt: skip


def write_laws(found: SeaLaws, folder: str | PathLike[str], figures: bool = True) -> None:
    """Write into a folder (that of the chosen calibration, most often). Raises InputError where it cannot be written."""
    with staged(Path(folder)) as temporary:
        write_json(document(found), temporary / LAWS)
        (temporary / TABLE).write_text(table_text(found), encoding="utf-8")
        if figures and found.seas:
            _draw(found, temporary / FIGURES)


def _draw(found: SeaLaws, folder: Path) -> None:
    from calibration import sea_laws_plot
    from jaxhydro.plot import save, style

    with style():
        for label in found.labels():
            save(sea_laws_plot.coefficient(found, label), folder / f"sea-law-{safe_name(label)}.png")


def document(found: SeaLaws) -> dict[str, Any]:
    """The content of sea_laws.json."""
    laws = {}
    for law in found.laws:
        reference = reference_of(law.calibration.model.loads)
        laws[law.name] = {
            "fitted_error": law.fitted, "held_out_error": law.held_out,
            "reference": None if reference is None else reference._asdict(),
            "drag_laws": drag_laws(law.calibration.model),
            "parameters": _parameters(law.calibration),
        }  # fmt: skip
    seas = {
        sea.id: {"use": sea.use, **sea.state._asdict(), "parameters": _parameters(sea.calibration)} for sea in found.seas
    }
    return {"finished": found.finished, "chosen": found.chosen.name,
            "judged_by": list(found.judged_by), "left_out_one_by_one": found.left_out,
            "laws": laws, "sea_states": seas}  # fmt: skip


def _parameters(calibration: Calibration) -> dict[str, Any]:
    return {
        label: {"value": one.value, "standard_deviation": or_null(one.standard_deviation), "unit": one.unit}
        for label, one in calibration.parameters.items()
    }


def table_text(found: SeaLaws) -> str:
    """coefficients.csv: one row for every coefficient in every sea state, alone and by every law."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    heads = ("test", "use", "significant_height_m", "peak_period_s", "coefficient", "unit", "source", "value")
    writer.writerow((*heads, "relative_standard_deviation"))
    for sea in found.seas:
        for label in found.labels():
            alone = sea.calibration.parameters[label]
            sources: list[tuple[str, float, float | None]] = [
                ("this sea alone", alone.value, alone.standard_deviation and alone.standard_deviation / alone.value),
                *((law.name, *law.coefficient(label, sea.state)) for law in found.laws),
            ]
            for source, value, deviation in sources:
                known = "" if deviation is None else f"{deviation:.4g}"
                height, period = (f"{x:.4g}" for x in sea.state)
                writer.writerow((sea.id, sea.use, height, period, label, alone.unit, source, f"{value:.6g}", known))
    return text.getvalue()


def laws_table(found: SeaLaws) -> Rows:
    """Errors of every law, the chosen one marked."""
    rows = [
        (NAMES[law.name], str(len(law.added())), number(law.fitted, 3), number(law.held_out, 3),
         "chosen" if law is found.chosen else "") for law in found.laws
    ]  # fmt: skip
    judged = "left out in turn" if found.left_out else "held out"
    return ("Coefficients", "Added", "Error, fitted", f"Error, {judged}", ""), rows


def states_table(found: SeaLaws) -> Rows:
    """Coefficients of every sea alone, and by the chosen law."""

    def cells(label: str) -> Iterator[str]:
        for sea in found.seas:
            one = sea.calibration.parameters[label]
            value, deviation = found.chosen.coefficient(label, sea.state)
            alone = with_deviation(one.value, one.standard_deviation) if one.identifiable else f"({number(one.value, 2)})"
            yield f"{alone} | {number(value, 3)} ± {percent(deviation)}"

    heads = [f"{sea.id}: {state_words(sea.state)}" for sea in found.seas]
    return ("Coefficient", *heads), [(label, *cells(label)) for label in found.labels()]


def state_words(state: SeaState) -> str:
    """In figures: Hs 2.7 m, Tp 9 s."""
    return f"Hs {number(state.significant_height, 2)} m, Tp {number(state.peak_period, 3)} s"


def sentence(found: SeaLaws) -> str:
    """Which law, and what it gains."""
    chosen, plain = found.chosen, found.laws[0]
    if not found.finished:
        return f"Stopped by the user: of {', '.join(NAMES[law.name] for law in found.laws)} the best is {NAMES[chosen.name]}"
    by = f"{', '.join(found.judged_by)} {'left out in turn' if found.left_out else 'held out'}"
    if chosen is plain:
        return f"No law does better than {NAMES[plain.name]} coefficients on {by} (error {number(plain.held_out, 3)})"
    gain = f"error {number(plain.held_out, 3)} of {NAMES[plain.name]} coefficients to {number(chosen.held_out, 3)}"
    return f"Chosen by {by}: {NAMES[chosen.name]}, {gain}"
