"""HTML page of a calibration."""

from pathlib import Path

from calibration.campaign.manifest_sections import IN_WAVES
from calibration.formatting import listed
from calibration.report import tables
from calibration.report.interactive import motion_view
from calibration.report.summary import calibration_sentence, summary_of
from calibration.report.web_page import images, inputs_table, notes_by_kind, render, written_on
from calibration.results.calibration_file import CalibrationFile
from calibration.results.result_folder import RESULT_FILE


def page(saved: CalibrationFile, folder: Path) -> str:
    """Text of the page of a calibration, whose figures are in a folder."""
    summary = summary_of(saved)
    return render(
        "calibration",
        title=saved.campaign,
        by="Calibration",
        version=saved.jaxhydro,
        saved=saved,
        fitted=saved.baseline,
        tables=tables,
        summary=summary,
        sentence=calibration_sentence(summary),
        in_waves=any(test.use == "fit" and test.kind in IN_WAVES for test in saved.tests.values()),
        undetermined=[i for i, parameter in enumerate(saved.baseline.parameters.values()) if not parameter.identifiable],
        images=images(saved.figures, folder).values(),
        motion=motion_view(folder),
        notes=notes_by_kind(saved.baseline.notes, saved.baseline.notes_about),
        date=written_on(folder / RESULT_FILE),
        inputs=inputs_table(
            saved.jaxhydro,
            campaign=saved.campaign,
            platform=saved.platform,
            records=listed(list(dict.fromkeys(test.file for test in saved.tests.values()))) if saved.tests else None,
        ),
    )
