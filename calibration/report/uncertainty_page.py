"""HTML page of the intervals of a calibration's parameters."""

from pathlib import Path

from calibration.formatting import counted
from calibration.report.web_page import images, inputs_table, render, written_on
from calibration.results.result_folder import UNCERTAINTY_FILE
from calibration.results.uncertainty_file import (
    INTERVAL_METHODS,
    UncertaintyFile,
    interval_sentence,
    intervals_table,
    other_intervals_table,
    summary_of,
)
from calibration.vocabulary import Rows


def page(saved: UncertaintyFile, folder: Path) -> str:
    """Text of the page of intervals, whose figures are in a folder."""
    return render(
        "uncertainty",
        title=saved.campaign,
        by="Uncertainty",
        version=saved.jaxhydro,
        saved=saved,
        sentence=interval_sentence(summary_of(saved)),
        parameters=_parameters(saved),
        undetermined=[i for i, parameter in enumerate(saved.parameters.values()) if not parameter.identifiable],
        others=other_intervals_table(saved),
        methods=INTERVAL_METHODS,
        times=lambda way: f"{saved.bootstrap[way].draws} times" if way in saved.bootstrap else "many times",
        share=f"{100 * saved.level:.4g}",
        images=images(saved.figures, folder).values(),
        date=written_on(folder / UNCERTAINTY_FILE),
        inputs=inputs_table(
            saved.jaxhydro,
            campaign=saved.campaign,
            platform=saved.platform,
            calibration=f"{saved.calibration}, {counted(len(saved.parameters), 'parameter')} fitted to free decays",
            seed=str(saved.seed) if saved.bootstrap or saved.nuts else None,
        ),
    )


def _parameters(saved: UncertaintyFile) -> Rows:
    """The table of intervals with the meaning of each parameter."""
    (first, *heads, _), intervals = intervals_table(saved)
    rows = [
        (label, "; ".join(filter(None, (parameter.meaning, flag))), *row)
        for (label, *row, flag), parameter in zip(intervals, saved.parameters.values(), strict=True)
    ]
    return (first, "Meaning", *heads), rows
