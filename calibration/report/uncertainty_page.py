"""HTML page of the intervals of a calibration's parameters."""

from collections.abc import Iterator
from pathlib import Path

from calibration.report.web_page import UNCONVERGED, figures, framed, images, listed, result_box, table, warning_box
from calibration.results.uncertainty_file import (
    INTERVAL_METHODS,
    UncertaintyFile,
    interval_sentence,
    intervals_table,
    other_intervals_table,
    summary_of,
)

_MEANING = """<p>What a {percent} interval means: were the same tests made and fitted again and again, about
{share} in 100 of the intervals would hold the value with which this model follows such tests best.</p>
<p>What it does not mean: that the model is right, that the value holds in what was not tested (waves, motions of another size),
or that all parameters lie in their intervals at once: each stands by itself. What is wrong in all tests alike, a scale or a
sensor, is in none of the intervals. Where the model's error rings at the natural period they are too narrow.</p>"""
_INTERVALS = """<p>The intervals are Laplace's, from the covariance of the fit. They allow for errors that last from sample to
sample, as the residuals of a fit mostly do. The last column is their width over that of intervals for white errors, every
sample independent of the others (1 time: no difference).</p>"""
_FOUND = {
    "profile": "all other parameters are fitted again at each value; where it differs from Laplace's, believe the profile",
    "blocks": "what is left of the fit is drawn anew in blocks and fitted again, {}",
    "repeats": "whole tests are drawn anew from those that repeat each other and fitted again, {}",
    "nuts": "draws from the posterior{}: where the parameter lies with that probability, given the model and what was "
    "assumed before the tests",
}


def page(saved: UncertaintyFile, folder: Path) -> str:
    """The page's text. Whatever comes from files is escaped; images are part of the page."""
    return framed(saved.campaign, f"Uncertainty by jaxhydro {saved.jaxhydro}", _parts(saved, folder), saved.jaxhydro)


def _parts(saved: UncertaintyFile, folder: Path) -> Iterator[str]:
    if not saved.converged:
        yield warning_box(UNCONVERGED.format("intervals of a calibration"))
    yield result_box(interval_sentence(summary_of(saved)))
    yield "<h2>Parameters</h2>"
    yield _parameters(saved)
    yield _INTERVALS
    heads, rows = other_intervals_table(saved)
    if rows:
        yield f"<h2>{saved.percent} intervals in other ways</h2>"
        yield listed(f"{INTERVAL_METHODS[way]}: {_how(saved, way)}." for way in saved.ways())
        yield table(heads, rows)
    yield f"<h2>What the intervals mean</h2>{_MEANING.format(share=f'{100 * saved.level:.4g}', percent=saved.percent)}"
    yield f"<h2>What was calibrated</h2>{listed(_calibrated(saved))}"
    if saved.notes:
        yield f"<h2>Notes</h2>{listed(saved.notes)}"
    if drawn := figures(images(saved.figures, folder).values()):
        yield f"<h2>Figures</h2>{drawn}"


def _calibrated(saved: UncertaintyFile) -> Iterator[str]:
    number = len(saved.parameters)
    yield f"Campaign: {saved.campaign}"
    if saved.platform:
        yield f"Platform: {saved.platform}"
    yield f"Calibration: {saved.calibration}, {number} parameter{'s' * (number != 1)} fitted to free decays"


def _parameters(saved: UncertaintyFile) -> str:
    (first, *heads, _), found = intervals_table(saved)
    several = list(saved.parameters.values())
    rows = [
        (label, "; ".join(filter(None, (one.meaning, flag))), *row)
        for (label, *row, flag), one in zip(found, several, strict=True)
    ]
    return table([first, "Meaning", *heads], rows, 2, 4, [i for i, one in enumerate(several) if not one.identifiable])


def _how(saved: UncertaintyFile, way: str) -> str:
    """How a way finds intervals, and from how many draws."""
    drawn = f"{saved.bootstrap[way].draws} times" if way in saved.bootstrap else "many times"
    if way == "nuts":
        drawn = f", {saved.nuts.chains} chains of {saved.nuts.draws}" if saved.nuts else ""
    return _FOUND[way].format(drawn)
