"""The page of the study: the paper's four cases against the ratios that its Table 2 implies between them."""

from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence import study_figures, study_reasons
from benchmarks.evidence.common import ROOT, Section, cached, fingerprint, keep, say, table
from benchmarks.evidence.study import CASES, COLUMNS, CUTOFF, PLATFORM, SEAS, SEEDS, of_seed
from benchmarks.evidence.study_words import OPENFAST, PAIRS, implied, words

TITLE = "The paper's four cases in irregular seas"
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


def run(figures: Path) -> Section:
    """Four cases, two seas, ten seeds; what explains the differences; pontoon elements."""
    here = Path(__file__).parent
    key = fingerprint(ROOT / "jaxhydro" / "platforms" / f"{PLATFORM}.yaml", here / "study.py", here / "study_reasons.py")
    found: dict[str, list[dict[str, Any]]] = {}
    for sea in SEAS:
        found[sea] = []
        for seed in range(1, SEEDS + 1):
            name = f"{sea}-{seed}"
            result = cached("study", key, name)
            if result is None:
                result = keep("study", key, name, of_seed(sea, seed))
                say(f"  {name}")
            found[sea].append(result)
    return conclude(found, *study_reasons.run(key), figures)


def values(results: list[dict[str, Any]], case: str) -> np.ndarray:
    """Band integrals of a case: seed, column."""
    return np.array([result["integrals"][case] for result in results])


def band_table(results: list[dict[str, Any]]) -> str:
    """Mean and spread over the seeds by case."""
    rows = []
    for name, case in CASES.items():
        of_case = values(results, name)
        mean, spread = of_case.mean(axis=0), of_case.std(axis=0, ddof=1)
        cells = [f"{m:.3g} ± {100 * s / m:.0f} %" for m, s in zip(mean[:-1], spread[:-1], strict=True)]
        rows.append((f"{name} {case.name}", *cells, f"{mean[-1]:.2f}"))
    return table(("Case", *(f"{dof} {SHORT[band]}" for dof, band in COLUMNS), "mean surge (m)"), rows)


def ratio_table(found: dict[str, list[dict[str, Any]]]) -> tuple[str, dict[str, list[str]]]:
    """Ratios between cases: the paper's, ours, OpenFAST's; and by pair of cases those that no seed of ours reaches."""
    rows: list[tuple[str, ...]] = []
    outside: dict[str, list[str]] = {}
    for over, under in PAIRS:
        for column, (dof, band) in enumerate(COLUMNS):
            paper, least, most = implied(over, under, column)
            cells = []
            for sea in SEAS:
                ratio = values(found[sea], over)[:, column] / values(found[sea], under)[:, column]
                mean = values(found[sea], over)[:, column].mean() / values(found[sea], under)[:, column].mean()
                cells.append(f"{mean:.3g} ({ratio.min():.3g}–{ratio.max():.3g})")
                apart = abs(mean / paper - 1) > NEAR and (ratio.max() < least or ratio.min() > most)
                if sea == "moderate" and apart:
                    outside.setdefault(f"case {over} over {under}", []).append(f"{dof} {SHORT[band]} {mean:.2g} ({paper:.2g})")
            other = OPENFAST[over][column] / OPENFAST[under][column]
            label = f"{dof} {SHORT[band]}, case {over} over {under}"
            rows.append((label, f"{paper:.3g} ({least:.3g}–{most:.3g})", cells[0], f"{other:.3g}", cells[1]))
    head = ("Ratio", "Paper", "jaxhydro", "OpenFAST", "jaxhydro, Hs 8.1 m")
    return table(head, rows), outside


def conclude(found: dict[str, list[dict[str, Any]]], variants: dict[str, Any], cut: dict[str, Any], figures: Path) -> Section:
    """Tables, words and figures."""
    ratios, outside = ratio_table(found)
    of_bands = "\n".join(
        f"Hs {SEAS[sea][0]} m, Tp {SEAS[sea][1]} s:\n\n{band_table(results)}" for sea, results in found.items()
    )
    text = "\n".join([INTRO, of_bands, RATIOS, ratios, words(variants, cut)])
    drawn = (
        study_figures.elevation(found, SEAS, CUTOFF, figures / "study-elevation.png"),
        study_figures.densities(found, SEAS, figures / "study-spectra.png"),
        study_figures.bars(found, SEAS, figures / "study-bands.png"),
    )
    short: tuple[str, ...] = ()
    if outside:
        count = sum(len(ratios_off) for ratios_off in outside.values())
        each = ". ".join(f"Of {pair}: {', '.join(ratios_off)}" for pair, ratios_off in outside.items())
        short = (
            f"of the {len(PAIRS) * len(COLUMNS)} ratios between the paper's cases {count} are more than {100 * NEAR:.0f} % off "
            f"and reached by none of {SEEDS} seeds. They are listed with the paper's in brackets. {each}",
        )
    return Section(TITLE, text, drawn, short)
