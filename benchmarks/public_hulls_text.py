"""Page of `benchmarks.public_hulls`, from its raw results."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from benchmarks.public_hulls_cases import CASES, Case, Published
from benchmarks.public_hulls_motions_text import UNEXPLAINED, motion_reasons, motion_sections, motions_summary
from benchmarks.public_hulls_reasons import MOTIONS

GOAL = 0.02  # deviation that needs no reason
HEAD = ("Hull", "Quantity", "Converted", "Published", "Deviation", "Source")


class Comparison(NamedTuple):
    """A value of a converted hull beside a published one.

    Attributes:
        quantity: Such as "heave period".
        unit: Its unit.
        ours: The converted hull's value.
        published: The published value.
        rounding: Half of the published value's last digit, relative.
        source: Where it is published.
    """

    quantity: str
    unit: str
    ours: float
    published: float
    rounding: float
    source: str

    @property
    def deviation(self) -> float:
        """Relative deviation from the published value."""
        return self.ours / self.published - 1

    @property
    def within(self) -> bool:
        """Whether the deviation is within 2 % or the published rounding."""
        return abs(self.deviation) <= max(GOAL, self.rounding)


def compared(result: Mapping[str, Any], published: Published) -> list[Comparison]:
    """Values of a converted hull beside those of one source."""
    rows = [
        ("mass", "t", result["mass"] / 1e3, published.mass and published.mass / 1e3),
        ("displaced volume", "m³", result["volume"], published.volume),
        (
            "line tension",
            "kN",
            sum(result["tensions"]) / max(len(result["tensions"]), 1) / 1e3,
            published.tension and published.tension / 1e3,
        ),
        ("vertical pull of lines", "kN", (result["pull"] or 0.0) / 1e3, published.pull and published.pull / 1e3),
    ]
    listed = [Comparison(name, unit, ours, value, 0.0, published.source) for name, unit, ours, value in rows if value and ours]
    for dof, period in published.periods.items():
        ours = result["periods"].get(dof, math.nan)
        listed.append(Comparison(f"{dof} period", "s", ours, period, published.rounding * period, published.source))
    return listed


def percent(comparison: Comparison) -> str:
    """A deviation as people read it."""
    if not math.isfinite(comparison.deviation):
        return "-"
    shown = f"{100 * comparison.deviation:+.2f} %"
    rounded = comparison.rounding >= 1e-3
    return f"{shown} (rounding ± {100 * comparison.rounding:.1f} %)" if rounded else shown


def figures(value: float) -> str:
    """A number with four or more significant digits."""
    return "-" if not math.isfinite(value) else f"{value:.0f}" if abs(value) >= 1000 else f"{value:.4g}"


def table(head: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    """A table in Markdown."""
    return "\n".join(f"| {' | '.join(row)} |" for row in (head, ("---",) * len(head), *rows))


def title_of(case: Case) -> str:
    """Hull and kind of its source."""
    return f"{case.title}, {case.what}"


def rest_words(rest: list[float] | None) -> str:
    """Surge, heave and pitch at rest; None: not worked out."""
    if rest is None:
        return "-"
    return f"{rest[0]:+.2f} m, {rest[2]:+.2f} m, {math.degrees(rest[4]):+.2f}°"


def summary_row(case: Case, result: Mapping[str, Any]) -> tuple[str, ...]:
    """Mass, volume, rest and lines of a hull."""
    still = result["statics"]
    tensions = [tension / 1e3 for tension in still["tensions"]]
    return (
        title_of(case),
        f"{still['mass'] / 1e3:.1f}",
        f"{still['volume']:.1f}",
        rest_words(still["rest"]),
        f"{min(tensions):.0f} to {max(tensions):.0f}" if tensions else "-",
    )


def period_row(case: Case, still: Mapping[str, Any]) -> tuple[str, ...]:
    """Natural periods of a hull, and that of heave with the added mass of infinite frequency."""
    listed, infinite = (still[key] for key in ("periods", "periods_infinite"))
    last = figures(infinite.get("heave", math.nan)) if infinite != listed else "the same"
    return (title_of(case), *(figures(listed.get(dof, math.nan)) for dof in MOTIONS), last)


def read_row(case: Case, result: Mapping[str, Any]) -> tuple[str, ...]:
    """What became of a source's items."""
    counts = result["items"]
    numbers = (str(counts.get(word, 0)) for word in ("taken", "approximated", "left out"))
    return (title_of(case), f"`{case.source}`", *numbers, "; ".join(result["warnings"]) or "-")


def text(results: Mapping[str, Any]) -> str:
    """The page, from the raw results alone."""
    done = {name: (CASES[name], result) for name, result in results.items() if "statics" in result}
    rows, reasons, within, total = [], [], 0, 0
    for case, result in done.values():
        given: dict[str, list[str]] = {}
        for published in case.published:
            for comparison in compared(result["statics"], published):
                finite = math.isfinite(comparison.deviation)
                total, within = total + finite, within + (finite and comparison.within)
                rows.append(
                    (
                        title_of(case),
                        f"{comparison.quantity} ({comparison.unit})",
                        figures(comparison.ours),
                        figures(comparison.published),
                        percent(comparison),
                        comparison.source,
                    )
                )
                if not finite or not comparison.within:
                    reason = case.reasons.get(comparison.quantity, UNEXPLAINED)
                    given.setdefault(reason, []).append(f"{comparison.quantity} {percent(comparison)}")
        reasons += [f"- {title_of(case)}: {', '.join(what)}: {reason}" for reason, what in given.items()]
    notes = [f"- {title_of(case)}: {note}" for case, _ in done.values() for note in case.notes]
    periods = [period_row(case, result["statics"]) for case, result in done.values()]
    parts = [
        "# Public hulls and decks, converted",
        f"{len(done)} public hulls and decks were converted by `jaxhydro convert`. "
        f"{within} of {total} values agree with published ones, or with the source program's own, within 2 % or the rounding. "
        "Each larger deviation has its reason below. " + motions_summary([result for _, result in done.values()]),
        "Made by `python -m benchmarks.public_hulls FOLDER`. The sources are copies of public repositories and are not kept "
        "here. "
        "Natural periods are undamped, at rest, with rigid towers. Where a source has radiation tables, each period has the "
        "added mass of its own frequency.",
        "## Statics",
        table(
            (
                "Hull",
                "Mass (t)",
                "Displaced volume (m³)",
                "At rest: surge, heave, pitch",
                "Line tensions (kN)",
            ),
            [summary_row(case, result) for case, result in done.values()],
        ),
        "Tensions are those at the fairleads, at rest, of the lines with the least and the most.",
        "## Natural periods (s)",
        table(("Hull", *MOTIONS, "heave, added mass of infinite frequency"), periods),
        "`natural_modes` and `jaxhydro statics` have the added mass of each period's own frequency, too.",
        *motion_sections({title_of(case): result for case, result in done.values()}, table),
        "## Against published values",
        table(HEAD, rows),
        "## Reasons of deviations above 2 %",
        "\n".join([*reasons, *motion_reasons([(title_of(case), case.reasons, result) for case, result in done.values()])])
        or "- None.",
        "## Notes",
        "\n".join(notes) or "- None.",
        "## What was read",
        table(
            ("Hull", "Source", "Taken", "Approximated", "Left out", "Warnings"),
            [read_row(case, result) for case, result in done.values()],
        ),
    ]
    faults = [f"- {title_of(CASES[name])}: {result['fault']}." for name, result in results.items() if "fault" in result]
    parts += ["## What failed", "\n".join(faults)] if faults else []
    absent = [title_of(case) for name, case in CASES.items() if name not in results]
    if absent:
        parts.append(f"Not run, as their sources or results are absent: {'; '.join(absent)}.")
    return "\n\n".join(parts) + "\n"
