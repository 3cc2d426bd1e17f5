"""The page of the study: the paper's four cases against the ratios that its Table 2 implies between them."""

from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.evidence import study_figures, study_reasons
from benchmarks.evidence.common import ROOT, Section, cached, fingerprint, keep, say, table
from benchmarks.evidence.study import CASES, COLUMNS, CUTOFF, PLATFORM, SEAS, SEEDS, of_seed
from benchmarks.evidence.study_words import OPENFAST, PAIRS, implied, joined, words

TITLE = "The paper's four cases in irregular seas"
NEAR = 0.03  # of a ratio, within which it is the paper's
SHORT = {"low_frequency": "LF", "wave_frequency": "WF"}
INTRO = """\
The four cases of the paper (IFAC MECC 2025) on the built-in `volturnus-s-focal`, coefficients of its Table 1, JONSWAP seas cut
off at 0.3 Hz, 9000 s each, the first 500 s left out. Peak enhancement is IEC's default (1 and 1.78): the paper's is not known
here. Cases 1 and 2: loads up to still water on the hull as when upright (`wetting: mean`), in the flow at the displaced
horizontal position. The alternative, the wetted length of the displaced hull under a flat surface, lets the hull's own
motion past still water make loads of second order but not the wave's, which is as large and mostly opposes it; it is a row of
the third table. Cases 3 and 4: up to the surface at the displaced hull (`instantaneous`), vertical stretching, MacCamy-Fuchs
on all four columns. A pontoon is one element lumped at its middle in cases 1 to 3, three in case 4 (13.5 m each here, 11.5 m in
the paper). One seed is the same waves in all cases. Integrals over the bands (m², deg²), mean ± standard deviation over ten
seeds:
"""
RATIOS = """\
Ratios between cases: the paper's Table 2 has errors against one experiment, so (1 + e) / (1 + e') needs no experiment; in
brackets what its rounding allows. Ours are ratios of means, in brackets the range of the ten seeds, paired. OpenFAST: one
realisation of another sea of the same Hs and Tp, other moorings, several strips per pontoon in all cases, no lag in
MacCamy-Fuchs and none on the centre column.
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


def ratio_table(found: dict[str, list[dict[str, Any]]]) -> tuple[str, list[str]]:
    """Ratios between cases: the paper's, ours, OpenFAST's; and those of the paper that no seed of ours reaches."""
    rows, outside = [], []
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
                    outside.append(f"{dof} {SHORT[band]} {over}/{under} ({mean:.2g}, the paper {paper:.2g})")
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
    text = "\n".join([joined(INTRO) + "\n", of_bands, joined(RATIOS) + "\n", ratios, words(variants, cut)])
    drawn = (
        study_figures.elevation(found, SEAS, CUTOFF, figures / "study-elevation.png"),
        study_figures.densities(found, SEAS, figures / "study-spectra.png"),
        study_figures.bars(found, SEAS, figures / "study-bands.png"),
    )
    short = ()
    if outside:
        many = f"of the {len(PAIRS) * len(COLUMNS)} ratios between the paper's cases {len(outside)} are more than"
        short = (f"{many} {100 * NEAR:.0f} % off and reached by none of {SEEDS} seeds: {', '.join(outside)}",)
    return Section(TITLE, text, drawn, short)
