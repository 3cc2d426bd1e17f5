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


def write_laws(sea_laws: SeaLaws, folder: str | PathLike[str], figures: bool = True) -> None:
    """Write sea_laws.json, coefficients.csv and figures.

    Args:
        sea_laws: The laws.
        folder: The folder; most often that of the chosen calibration.
        figures: Whether figures are drawn.

    Raises:
        InputError: The folder cannot be written.
    """
    with staged(Path(folder)) as temporary:
        write_json(document(sea_laws), temporary / LAWS_FILE)
        (temporary / TABLE_FILE).write_text(table_text(sea_laws), encoding="utf-8")
        if figures and sea_laws.seas:
            _draw(sea_laws, temporary / FIGURES_FOLDER)


def _draw(sea_laws: SeaLaws, folder: Path) -> None:
    from calibration.plots import law_figures as sea_laws_plot
    from jaxhydro.plots.style import save, style

    with style():
        for label in sea_laws.labels():
            save(sea_laws_plot.coefficient_figure(sea_laws, label), folder / f"sea-law-{safe_name(label)}.png")


def document(sea_laws: SeaLaws) -> dict[str, Any]:
    """The content of sea_laws.json."""
    laws = {}
    for law in sea_laws.laws:
        reference = reference_of(law.calibration.model.loads)
        laws[law.name] = {
            "fitted_error": law.fitted,
            "held_out_error": law.held_out,
            "reference": None if reference is None else reference._asdict(),
            "drag_laws": drag_laws(law.calibration.model),
            "parameters": _parameters(law.calibration),
        }
    seas = {
        sea.id: {"use": sea.use, **sea.state._asdict(), "parameters": _parameters(sea.calibration)} for sea in sea_laws.seas
    }
    return {
        "finished": sea_laws.finished,
        "chosen": sea_laws.chosen.name,
        "judged_by": list(sea_laws.judged_by),
        "left_out_one_by_one": sea_laws.left_out,
        "laws": laws,
        "sea_states": seas,
    }


def _parameters(calibration: Calibration) -> dict[str, Any]:
    return {
        label: {
            "value": estimate.value,
            "standard_deviation": finite_or_null(estimate.standard_deviation),
            "unit": estimate.unit,
        }
        for label, estimate in calibration.parameters.items()
    }


def table_text(sea_laws: SeaLaws) -> str:
    """coefficients.csv: one row for every coefficient in every sea state, alone and by every law."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    heads = ("test", "use", "significant_height_m", "peak_period_s", "coefficient", "unit", "source", "value")
    writer.writerow((*heads, "relative_standard_deviation"))
    for sea in sea_laws.seas:
        for label in sea_laws.labels():
            alone = sea.calibration.parameters[label]
            sources: list[tuple[str, float, float | None]] = [
                ("this sea alone", alone.value, alone.standard_deviation and alone.standard_deviation / alone.value),
                *((law.name, *law.coefficient(label, sea.state)) for law in sea_laws.laws),
            ]
            for source, value, deviation in sources:
                relative = "" if deviation is None else f"{deviation:.4g}"
                height, period = (f"{x:.4g}" for x in sea.state)
                writer.writerow((sea.id, sea.use, height, period, label, alone.unit, source, f"{value:.6g}", relative))
    return text.getvalue()
