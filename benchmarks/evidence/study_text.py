"""Text of the section on the paper's four cases."""

from typing import Any

import numpy as np

from benchmarks.evidence.common import table
from benchmarks.evidence.study_reasons_text import OPENFAST, PAIRS, implied
from benchmarks.evidence.study_reasons_text import words as reasons
from benchmarks.evidence.study_runs import COLUMNS, SEAS, SEEDS

NAMES = {
    "1": "first order",
    "2": "second order",
    "3": "and stretching, MacCamy-Fuchs",
    "4": "and pontoon elements",
}
NEAR = 0.03  # of a ratio, within which it is the paper's
SHORT = {"low_frequency": "LF", "wave_frequency": "WF"}
INTRO = """\
The four cases of the paper (IFAC MECC 2025) are simulated on the built-in `volturnus-s-focal`, with the coefficients of the
paper's Table 1. The JONSWAP seas are cut off at 0.3 Hz and last 9000 s each. The first 500 s are left out. Peak enhancement is
IEC's default (1 and 1.78); the paper's is not known here. One seed is the same waves in all cases.

- Cases 1 and 2: loads act up to still water on the hull as when upright (`wetting: mean`). The flow is that at the displaced
horizontal position.
- The alternative is the wetted length of the displaced hull under a flat surface. Then the hull's own motion past still water
makes loads of second order, but the wave's motion does not. The wave's would be as large and mostly oppose them. This
alternative is a row of the third table.
- Cases 3 and 4: loads act up to the surface at the displaced hull (`instantaneous`), with vertical stretching and MacCamy-Fuchs
on all four columns.
- A pontoon is one element lumped at its middle in cases 1 to 3. It is three elements in case 4 (13.5 m each here, 11.5 m in the
paper).

Integrals over the bands (m², deg²), mean ± standard deviation over ten seeds:
"""
RATIOS = """\
Ratios between cases:

- Paper: its Table 2 has errors against one experiment, so (1 + e) / (1 + e') needs no experiment. In brackets is what the
rounding allows.
- Ours are ratios of means. In brackets is the range of the ten seeds, paired.
- OpenFAST: one realisation of another sea of the same Hs and Tp. It has other moorings and several strips per pontoon in all
cases. MacCamy-Fuchs is without its lag and not on the centre column.
"""


def words(results: dict[str, list[dict[str, Any]]], variants: dict[str, Any], elements: dict[str, Any]) -> str:
    """Text of the section.

    Args:
        results: Results of the seeds, by sea.
        variants: Band integrals with one thing changed, by variant.
        elements: Band integrals with the pontoons in more elements.
    """
    of_bands = "\n".join(
        f"Hs {SEAS[sea][0]} m, Tp {SEAS[sea][1]} s:\n\n{band_table(of_sea)}" for sea, of_sea in results.items()
    )
    return "\n".join([INTRO, of_bands, RATIOS, ratio_table(results)[0], reasons(variants, elements)])


def shortcomings(results: dict[str, list[dict[str, Any]]]) -> tuple[str, ...]:
    """Ratios of the paper that are not reached."""
    outside = ratio_table(results)[1]
    if not outside:
        return ()
    count = sum(len(ratios_off) for ratios_off in outside.values())
    listed_ratios = ". ".join(f"Of {pair}: {', '.join(ratios_off)}" for pair, ratios_off in outside.items())
    return (
        f"of the {len(PAIRS) * len(COLUMNS)} ratios between the paper's cases {count} are more than {100 * NEAR:.0f} % off "
        f"and reached by none of {SEEDS} seeds. They are listed with the paper's in brackets. {listed_ratios}",
    )


def values(results: list[dict[str, Any]], case: str) -> np.ndarray:
    """Band integrals of a case: seed, column."""
    return np.array([result["integrals"][case] for result in results])


def band_table(results: list[dict[str, Any]]) -> str:
    """Mean and spread over the seeds by case."""
    rows = []
    for name, label in NAMES.items():
        of_case = values(results, name)
        mean, spread = of_case.mean(axis=0), of_case.std(axis=0, ddof=1)
        cells = [f"{m:.3g} ± {100 * s / m:.0f} %" for m, s in zip(mean[:-1], spread[:-1], strict=True)]
        rows.append((f"{name} {label}", *cells, f"{mean[-1]:.2f}"))
    return table(("Case", *(f"{dof} {SHORT[band]}" for dof, band in COLUMNS), "mean surge (m)"), rows)


def ratio_table(results: dict[str, list[dict[str, Any]]]) -> tuple[str, dict[str, list[str]]]:
    """Ratios between cases.

    Returns:
        Table of the paper's, ours and OpenFAST's ratios. Ratios of the paper that no seed of ours reaches, by pair of cases.
    """
    rows: list[tuple[str, ...]] = []
    outside: dict[str, list[str]] = {}
    for over, under in PAIRS:
        for column, (dof, band) in enumerate(COLUMNS):
            paper, least, most = implied(over, under, column)
            cells = []
            for sea in SEAS:
                ratio = values(results[sea], over)[:, column] / values(results[sea], under)[:, column]
                mean = values(results[sea], over)[:, column].mean() / values(results[sea], under)[:, column].mean()
                cells.append(f"{mean:.3g} ({ratio.min():.3g}–{ratio.max():.3g})")
                apart = abs(mean / paper - 1) > NEAR and (ratio.max() < least or ratio.min() > most)
                if sea == "moderate" and apart:
                    outside.setdefault(f"case {over} over {under}", []).append(f"{dof} {SHORT[band]} {mean:.2g} ({paper:.2g})")
            openfast = OPENFAST[over][column] / OPENFAST[under][column]
            label = f"{dof} {SHORT[band]}, case {over} over {under}"
            rows.append((label, f"{paper:.3g} ({least:.3g}–{most:.3g})", cells[0], f"{openfast:.3g}", cells[1]))
    head = ("Ratio", "Paper", "jaxhydro", "OpenFAST", "jaxhydro, Hs 8.1 m")
    return table(head, rows), outside
