"""Writing of laws over the sea state: sea_laws.json, coefficients.csv, a figure."""

import csv
import io
from os import PathLike
from pathlib import Path
from typing import Any

from calibration.fitting.law_choice import SeaLaws
from calibration.result import Calibration
from calibration.results.result_folder import FIGURES_FOLDER, LAWS_FILE, TABLE_FILE
from calibration.results.write_calibration import drag_laws
from jaxhydro.files import safe_name, staged
from jaxhydro.loads.sea_state_law import reference_of
from jaxhydro.result_model import finite_or_null, write_json


def write_laws(found: SeaLaws, folder: str | PathLike[str], figures: bool = True) -> None:
    """Write into a folder (that of the chosen calibration, most often). Raises InputError where it cannot be written."""
    with staged(Path(folder)) as temporary:
        write_json(document(found), temporary / LAWS_FILE)
        (temporary / TABLE_FILE).write_text(table_text(found), encoding="utf-8")
        if figures and found.seas:
            _draw(found, temporary / FIGURES_FOLDER)


def _draw(found: SeaLaws, folder: Path) -> None:
    from calibration.plots import law_figures as sea_laws_plot
    from jaxhydro.plots.style import save, style

    with style():
        for label in found.labels():
            save(sea_laws_plot.coefficient_figure(found, label), folder / f"sea-law-{safe_name(label)}.png")


def document(found: SeaLaws) -> dict[str, Any]:
    """The content of sea_laws.json."""
    laws = {}
    for law in found.laws:
        reference = reference_of(law.calibration.model.loads)
        laws[law.name] = {
            "fitted_error": law.fitted,
            "held_out_error": law.held_out,
            "reference": None if reference is None else reference._asdict(),
            "drag_laws": drag_laws(law.calibration.model),
            "parameters": _parameters(law.calibration),
        }
    seas = {sea.id: {"use": sea.use, **sea.state._asdict(), "parameters": _parameters(sea.calibration)} for sea in found.seas}
    return {
        "finished": found.finished,
        "chosen": found.chosen.name,
        "judged_by": list(found.judged_by),
        "left_out_one_by_one": found.left_out,
        "laws": laws,
        "sea_states": seas,
    }


def _parameters(calibration: Calibration) -> dict[str, Any]:
    return {
        label: {"value": one.value, "standard_deviation": finite_or_null(one.standard_deviation), "unit": one.unit}
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
