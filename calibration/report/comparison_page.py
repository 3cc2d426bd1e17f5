"""HTML page of a campaign's tests in waves, simulated in the waves that were measured."""

from pathlib import Path

from calibration.formatting import listed, number
from calibration.report import sea_tables
from calibration.report.interactive import motion_view
from calibration.report.summary import Agreement, agreement_phrase
from calibration.report.web_page import images, inputs_table, render, written_on
from calibration.results.comparison_file import ComparisonFile
from calibration.results.result_folder import COMPARISON_FILE
from calibration.vocabulary import Rows


def agreements(saved: ComparisonFile) -> list[Agreement]:
    """How well the tests of each kind and use are followed, in the motions that are large."""
    groups: dict[tuple[str, str], list[str]] = {}
    for id, test in saved.tests.items():
        groups.setdefault((saved.error[id].use, test.kind), []).append(id)
    group_agreements = []
    for (use, kind), ids in sorted(groups.items()):
        errors: list[float] = []
        bands: dict[str, list[float]] = {}
        for id in ids:
            moving = [name for name, statistics in saved.tests[id].statistics.items() if statistics.moving]
            errors += [channel.relative for name, channel in saved.error[id].channels.items() if name in moving]
            for name, row in saved.error[id].bands.items():
                for band, error in row.items() if name in moving else ():
                    bands.setdefault(band, []).append(abs(error))
        group_agreements.append(
            Agreement(kind, use, len(ids), tuple(errors), {band: tuple(values) for band, values in bands.items()})
        )
    return group_agreements


def comparison_sentence(group_agreements: list[Agreement]) -> str:
    """How the tests are followed.

    "4 tests in irregular waves: low-frequency energy off by 2-14 % and wave-frequency energy off by 3-9 %."
    """
    return " ".join(f"{agreement_phrase(agreement)}." for agreement in group_agreements) or "No test in waves was simulated."


def page(saved: ComparisonFile, folder: Path) -> str:
    """Text of the page of a comparison, whose figures are in a folder."""
    return render(
        "comparison",
        title=saved.campaign,
        by="Simulation of tests in waves",
        version=saved.jaxhydro,
        date=written_on(folder / COMPARISON_FILE),
        saved=saved,
        sentence=comparison_sentence(agreements(saved)),
        tables=sea_tables,
        coefficients=_coefficients(saved),
        undetermined=[i for i, label in enumerate(saved.coefficients.values) if label in saved.coefficients.not_identifiable],
        motion=motion_view(folder),
        images=images(saved.figures, folder).values(),
        inputs=inputs_table(
            saved.jaxhydro,
            campaign=saved.campaign,
            platform=saved.platform,
            calibration=saved.calibration,
            records=listed([sea.file for sea in saved.seas]) if saved.seas else None,
            waves=_waves(saved),
        ),
    )


def _coefficients(saved: ComparisonFile) -> Rows:
    """Calibrated values that were used, and whether its records determine them."""
    used = saved.coefficients
    rows: list[tuple[str, ...]] = [(label, number(value)) for label, value in used.values.items()]
    if not used.not_identifiable:
        return ("Parameter", "Value (SI)"), rows
    remarks = ("not determined by its records" if label in used.not_identifiable else "" for label in used.values)
    return ("Parameter", "Value (SI)", "Remark"), [(*row, remark) for row, remark in zip(rows, remarks, strict=True)]


def _waves(saved: ComparisonFile) -> str:
    how = saved.options
    words = [f"order {how.order}", f"first order from {how.low:g} to {how.cutoff:g} Hz", f"stretching {how.stretching}"]
    if how.diffraction:
        words.append(f"diffraction {how.diffraction.replace('_', ' ')}")
    return ", ".join([*words, f"steps of {number(how.step, 3)} s"])
