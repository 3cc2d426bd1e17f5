"""HTML page of a diagnosis."""

from collections import Counter
from pathlib import Path

from calibration.formatting import counted, number
from calibration.report import diagnosis_tables, diagnosis_words
from calibration.report.effect_alternatives import describe_alternatives
from calibration.report.interactive import motion_view
from calibration.report.web_page import Image, images, inputs_table, render, written_on
from calibration.results.diagnosis_file import DiagnosisFile
from calibration.results.result_folder import DIAGNOSIS_FILE
from calibration.vocabulary import KINDS, USE

FIGURE_SECTIONS = {  # starts of figures' names, by section of the page; the last takes all others
    "anatomy": ("anatomy",),
    "latent": ("latent-force",),
    "effects": ("effect-",),
    "errors": ("before-after", "spectra-"),
    "scores": ("scores",),
    "others": ("",),
}


def page(saved: DiagnosisFile, folder: Path) -> str:
    """Text of the page of a diagnosis, whose figures are in a folder."""
    spent = [] if saved.seconds is None else [f"The diagnosis took {number(saved.seconds, 3)} s."]
    return render(
        "diagnosis",
        title=saved.campaign,
        by="Diagnosis",
        version=saved.jaxhydro,
        saved=saved,
        tables=diagnosis_tables,
        words=diagnosis_words,
        describe_alternatives=describe_alternatives,
        measured=_measured(saved),
        notes=[("", [*saved.notes, *spent])] if saved.notes or spent else [],
        images=_placed(saved, folder),
        motion=motion_view(folder),
        date=written_on(folder / DIAGNOSIS_FILE),
        inputs=inputs_table(saved.jaxhydro, campaign=saved.campaign, platform=saved.platform),
    )


def _placed(saved: DiagnosisFile, folder: Path) -> dict[str, list[Image]]:
    """Figures by section of the page, each once."""
    figures: dict[str, list[Image]] = {section: [] for section in FIGURE_SECTIONS}
    sections = {
        section: starts
        for section, starts in FIGURE_SECTIONS.items()
        if section != "latent" or saved.missing.unexplained.forces
    }
    for name, image in images(saved.figures, folder).items():
        figures[next(section for section, starts in sections.items() if name.startswith(starts))].append(image)
    return figures


def _measured(saved: DiagnosisFile) -> str:
    """How many tests of which kind, and how long together."""
    each = Counter((KINDS.get(test.kind, test.kind), test.use) for test in saved.tests.values())
    kinds = {kind: [f"{n} {USE.get(use, use)}" for (other, use), n in each.items() if other == kind] for kind, _ in each}
    seconds = sum(test.duration or 0.0 for test in saved.tests.values())
    span, unit = next((s, u) for s, u in ((3600, "hours"), (60, "minutes"), (1, "s")) if seconds >= 2 * s or s == 1)
    listing = "; ".join(f"{kind}: {', '.join(counts)}" for kind, counts in kinds.items())
    tests = counted(len(saved.tests), "test") + (f" of {saved.platform}" if saved.platform else "")
    return f"{tests}, {number(seconds / span, 2)} {unit} together at the platform file's scale ({listing})."
