"""HTML page of a diagnosis."""

from collections import Counter
from collections.abc import Iterator
from html import escape
from pathlib import Path

from calibration.formatting import number
from calibration.report import diagnosis_tables as tables
from calibration.report import diagnosis_words as words
from calibration.report.web_page import UNCONVERGED, figures, framed, images, listed, result_box, table, warning_box
from calibration.results.diagnosis_file import DiagnosisFile, FoundEffect
from calibration.vocabulary import KINDS, USE

_ANATOMY = """<p>The residual of the declared model after its coefficients are fitted, the largest first: its root mean
square, its share of the motion, and its ratio to the noise before and after the effects that were found are added. A ratio
of 1 is noise alone.</p>"""
_LATENT = """<p>The force that would have to act on the model beside all that it has, for it to follow the records:</p>"""
_BANDS = """<p>Tests in irregular waves: error of the energy in the band of slow motion and of waves, (simulated - measured) /
measured.</p>"""
_COEFFICIENTS = """<p>Coefficients fitted without the effects that were found (before) and with them (after), ± 1 standard
deviation. Coefficients that move had stood in for these effects. Mass properties and moorings move a little here, so added mass
is known less well than by <code>jaxhydro calibrate</code>.</p>"""


def page(saved: DiagnosisFile, folder: Path) -> str:
    """The page's text. Whatever comes from files is escaped; images are part of the page."""
    return framed(saved.campaign, f"Diagnosis by jaxhydro {saved.jaxhydro}", _parts(saved, folder), saved.jaxhydro)


def _parts(saved: DiagnosisFile, folder: Path) -> Iterator[str]:
    drawn = images(saved.figures, folder)

    def taken(*starts: str) -> str:
        """The figures whose names begin so, each shown once."""
        return figures([drawn.pop(name) for name in list(drawn) if name.startswith(starts)])

    if words.STOPPED in saved.notes:
        yield warning_box(f"{words.capitalised(words.STOPPED)}.")
    elif not saved.converged:
        yield warning_box(UNCONVERGED.format("a diagnosis"))
    yield result_box(words.verdict_sentence(saved))
    yield "<h2>What was measured</h2>"
    yield f"<p>{escape(_measured(saved))}</p>"
    yield table(*tables.tests(saved), 4)
    yield "<h2>What the model missed</h2>"
    if saved.anatomy.before:
        yield _ANATOMY
        yield table(*tables.anatomy(saved), 4)
    yield taken("anatomy")
    yield "<h2>What was found</h2>"
    for one in saved.missing.effects:
        yield from _effect(saved, one)
    if not saved.missing.effects:
        yield "<p>No effect.</p>"
    yield f"<p>{escape(words.describe_unexplained(saved))}</p>"
    if forces := saved.missing.unexplained.forces:
        yield _LATENT
        yield listed([one.words for one in forces])
        yield taken("latent-force")
    if saved.next_test:
        yield f"<p><b>The test to run next:</b> {escape(saved.next_test)}</p>"
    yield taken("effect-")
    yield "<h2>Error before and after</h2>"
    yield f"<p>{escape(_objectives(saved))}</p>"
    yield table(*tables.errors(saved), 3)
    if (rows := tables.bands(saved))[1]:
        yield _BANDS
        yield table(*rows, 4)
    yield taken("before-after", "spectra-")
    yield "<h2>Fitted coefficients</h2>"
    yield _COEFFICIENTS
    yield table(*tables.coefficients(saved), 1, 4)
    if (rows := tables.nearly_known(saved))[1]:
        yield f"<p>{tables.VARIED}.</p>"
        yield table(*rows, 1, 4)
    yield "<h2>What was rejected, and why</h2>"
    yield table(*rows, 9) if (rows := tables.rejected(saved))[1] else "<p>Nothing.</p>"
    yield taken("scores")
    if saved.notes or saved.seconds is not None:
        yield "<h2>Notes</h2>"
        spent = [f"The diagnosis took {number(saved.seconds, 3)} s."] if saved.seconds is not None else []
        yield listed([*saved.notes, *spent])
    if rest := taken(""):
        yield f"<h2>More figures</h2>{rest}"


def _measured(saved: DiagnosisFile) -> str:
    """How many tests of which kind, and how long together."""
    each = Counter((KINDS.get(one.kind, one.kind), one.use) for one in saved.tests.values())
    kinds = {kind: [f"{n} {USE.get(use, use)}" for (other, use), n in each.items() if other == kind] for kind, _ in each}
    seconds = sum(one.duration or 0.0 for one in saved.tests.values())
    span, unit = next((s, u) for s, u in ((3600, "hours"), (60, "minutes"), (1, "s")) if seconds >= 2 * s or s == 1)
    said = "; ".join(f"{kind}: {', '.join(counts)}" for kind, counts in kinds.items())
    platform = f" of {saved.platform}" if saved.platform else ""
    tests = f"{len(saved.tests)} {'test' if len(saved.tests) == 1 else 'tests'}"
    return f"{tests}{platform}, {number(seconds / span, 2)} {unit} together at the platform file's scale ({said})."


def _effect(saved: DiagnosisFile, one: FoundEffect) -> Iterator[str]:
    name = words.effect_in_words(one.effect, one.degree_of_freedom)
    yield f"<h3>{escape(words.capitalised(name))}</h3>"
    sizes = "; ".join(words.describe_parameter(key, value) for key, value in words.sorted_by_certainty(one.parameters))
    yield f'<p class="size"><b>Size:</b> {escape(sizes)}.</p>' if sizes else ""
    if one.meaning:
        source = f" ({one.source})" if one.source else ""
        yield f"<p>{escape(words.capitalised(one.meaning.rstrip('.')) + source)}.</p>"
    yield f"<p><b>How sure:</b> {escape(' '.join(words.describe_certainty(saved, one)))}</p>"
    yield f"<p><b>What else it could be:</b> {escape(words.describe_alternatives(one))}</p>"


def _objectives(saved: DiagnosisFile) -> str:
    """J before and after, fitted and held out."""
    before, after = saved.baseline.objective, saved.augmented.objective
    said = f"The error of the fitted tests {words.describe_change(before.fit, after.fit)}"
    if before.holdout is not None and after.holdout is not None:
        said += f", that of the held-out tests {words.describe_change(before.holdout, after.holdout)}"
    return f"{said}. J is the sum of RMSE over the motion's standard deviation; the table has every part of it."
