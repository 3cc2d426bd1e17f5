"""HTML page of a calibration."""

from collections.abc import Iterator
from html import escape
from pathlib import Path

from calibration.campaign.manifest import IN_WAVES
from calibration.report import tables
from calibration.report.summary import calibration_sentence, summary_of
from calibration.report.web_page import UNCONVERGED, figures, folded, framed, images, listed, result_box, table, warning_box
from calibration.results.calibration_file import CalibrationFile

_ERRORS = """<p>RMSE of the simulated motion over the standard deviation of the measured motion, before and after the
calibration.</p>"""
_ENERGIES = """<p>(simulated - measured) / measured energy in a band of the motion's spectrum.</p>"""
_DAMPING = """<p>x'' + p x' + q x'|x'| + w² x = 0, fitted to the decrements of each decay alone (Faltinsen 1990, Sea Loads on
Ships and Offshore Structures, chapter 7). Measured and simulated decays should agree.</p>"""


def page(saved: CalibrationFile, folder: Path) -> str:
    """The page's text."""
    parts = _parts(saved, folder)
    return framed(saved.campaign, f"Calibration by jaxhydro {saved.jaxhydro}", parts, saved.jaxhydro)


def _parts(saved: CalibrationFile, folder: Path) -> Iterator[str]:
    fitted = saved.baseline
    summary = summary_of(saved)
    sentence = calibration_sentence(summary)
    yield result_box(sentence) if summary.sound else warning_box(sentence)
    if not fitted.converged:
        lost = "The values below are where the fit ended, not a calibration."
        yield f"<p>{escape(lost if summary.not_followed else UNCONVERGED.format('a calibration'))}</p>"
    yield f"<p>{escape(_how(saved))}</p>"
    yield "<h2>Parameters</h2>"
    vague = [i for i, one in enumerate(fitted.parameters.values()) if not one.identifiable]
    yield table(*tables.parameters(saved), 2, 4, vague)
    if saved.truth:
        yield f"<h2>Against the true coefficients</h2><p>{escape(tables.agreement_with_truth(saved))}</p>"
        heads, rows = tables.comparison_with_truth(saved)
        yield table(heads, rows, 1)
    yield f"<h2>Tests</h2>{_ERRORS}"
    yield table(*tables.errors(saved), 5)
    heads, rows = tables.other_motions(saved)
    if rows:
        yield folded(f"Other motions, which do not count in the fit ({len(rows)})", table(heads, rows, 3))
    if (found := tables.bands(saved))[1]:
        yield f"<h2>Errors of energy in bands</h2>{_ENERGIES}{table(*found, 4)}"
    if (found := tables.linear_quadratic(saved))[1]:
        yield f"<h2>Damping by classical analysis</h2>{_DAMPING}{table(*found, 1, 6)}"
    if fitted.notes:
        yield f"<h2>Notes</h2>{listed(fitted.notes)}"
    if drawn := figures(images(saved.figures, folder).values()):
        yield f"<h2>Figures</h2>{drawn}"


def _how(saved: CalibrationFile) -> str:
    """The objective, and how it was reached."""
    said = f"{tables.outcome_sentence(saved)}."
    if any(test.use == "fit" and test.kind in IN_WAVES for test in saved.tests.values()):
        said += " Tests in waves are fitted by the objective that was asked for, by default energy in bands."
    return said
