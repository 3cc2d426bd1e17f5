"""Section: intervals of 95 % against the truth, in many synthetic campaigns with white and with correlated errors."""

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import binomtest

from benchmarks.evidence.common import CACHE, ROOT, SHARED, TRUE, Section, cached, fingerprint, parallel, say, table
from benchmarks.evidence.coverage_campaigns import DISTURBED, FREE, MEMORY, RINGING, kind_of
from calibration.formatting import number, percent

TITLE = "Intervals that hold the truth"
LOW, HIGH = 0.90, 0.99
CAMPAIGNS = 100
PROFILED, BOOTSTRAPPED = 5, 92  # every fifth four campaigns are profiled in CLOSE; from this one on all are bootstrapped
CLOSE = ("column.Cd_t", "pontoon.Cd_z")  # what is profiled: damping, the least linear
DRAWS = 48
KINDS = ("white", "drifting", "ringing")
MEASURED = ("kvlcc2", "focal-c4")
METHODS = {
    "coloured": "Laplace, coloured errors",
    "stated": "as `calibrate` states",
    "white": "as if white",
    "profile": "profile",
    "blocks": "block bootstrap",
}


def of_campaign(name: str) -> dict[str, Any]:
    """Intervals of one campaign by method and label, as [lower, upper], None where open, and absent where there is none."""
    from benchmarks.evidence.coverage_campaigns import make
    from calibration.campaign.load_campaign import load_campaign
    from calibration.fitting.decay_calibration import conclude
    from calibration.fitting.decay_fit import prepare_fit, run_fit
    from calibration.uncertainty.bootstrap import bootstrap_blocks
    from calibration.uncertainty.likelihood_of_fit import likelihood_of
    from calibration.uncertainty.profile import profile

    index = int(name.removeprefix("campaign-"))
    folder = CACHE / "coverage-campaigns" / name
    if not (folder / "campaign.yaml").exists():  # written last
        make(folder, index)
    campaign = load_campaign(folder)
    fit = prepare_fit(campaign)
    run_fit(fit)
    result, likely = conclude(campaign, fit.decays.problem.model, fit, 0.0), likelihood_of(fit)
    identified = {k: p for k, p in result.parameters.items() if p.standard_deviation is not None}
    intervals: dict[str, dict[str, Any]] = {
        "coloured": {k: likely.interval(k) for k in identified},
        "white": {k: likely.interval(k, white=True) for k in identified},
        "stated": {k: [p.value + s * 1.96 * (p.standard_deviation or 0.0) for s in (-1, 1)] for k, p in identified.items()},
    }
    if index // 4 % PROFILED == 0:
        intervals["profile"] = {k: profile(likely, k).interval for k in CLOSE if k in identified}
    if index >= BOOTSTRAPPED:
        draws = bootstrap_blocks(likely, DRAWS, seed=index)
        intervals["blocks"] = {k: draws.interval(k, kind="normal") for k in identified}
        intervals["unsettled"] = {"draws": draws.unsettled}
    return {
        "intervals": intervals,
        "excess": likely.excess(),
        "converged": fit.converged,
        "iterations": fit.iterations,
        "value": {k: p.value for k, p in result.parameters.items()},
        "deviation": dict(zip(likely.labels, map(float, likely.deviation()), strict=True)),
    }


def of_measured(name: str) -> dict[str, list[float]]:
    """Of a measured decay: relative deviations with the residual as it is, as if it were white, and their ratio, by label."""
    from calibration.campaign.load_campaign import load_campaign
    from calibration.fitting.decay_calibration import conclude
    from calibration.fitting.decay_fit import prepare_fit, run_fit
    from calibration.uncertainty.likelihood_of_fit import likelihood_of

    campaign = load_campaign(SHARED / "measured" / name)
    fit = prepare_fit(campaign)
    run_fit(fit)
    likely, result = likelihood_of(fit), conclude(campaign, fit.decays.problem.model, fit, 0.0)
    identified = [k for k, p in result.parameters.items() if p.identifiable]
    rows = zip(likely.labels, likely.deviation(), likely.deviation(white=True), strict=True)
    return {k: [float(sd), float(white), float(sd / white)] for k, sd, white in rows if k in identified}


def key() -> str:
    """Key of the section's results."""
    sources = ("evidence/coverage_campaigns.py", "make_demo_campaign.py", "reference_model.py")
    return fingerprint(*(ROOT / "benchmarks" / name for name in sources))


def run(figures: Path, processes: int, campaigns: int = CAMPAIGNS) -> Section:
    """Campaigns that differ in releases, noise and disturbance."""
    sources = key()
    results: dict[int, dict[str, Any]] = {}
    for name, result in parallel("coverage", sources, [f"campaign-{i}" for i in range(campaigns)], of_campaign, processes):
        index = int(name.removeprefix("campaign-"))
        results[index] = result
        hits = [a <= TRUE[k] <= b for k, (a, b) in result["intervals"]["coloured"].items()]
        say(f"  {name} ({kind_of(index)}): {sum(hits)} of {len(hits)} ({len(results)} of {campaigns})")
    measured = {
        name: cached("coverage", sources, name, partial(of_measured, name))
        for name in MEASURED
        if (SHARED / "measured" / name).exists()
    }
    return conclude(results, measured, figures)


def hits_of(results: dict[int, dict[str, Any]], method: str, kind: str | None = None, label: str | None = None) -> list[bool]:
    """Whether each interval of a method holds the truth."""
    hits = []
    for index, result in results.items():
        if kind is None or kind_of(index) == kind:
            for coefficient, (low, high) in result["intervals"].get(method, {}).items():
                if label in (None, coefficient):
                    above = low is None or low <= TRUE[coefficient]
                    hits.append(above and (high is None or TRUE[coefficient] <= high))
    return hits


def share(hits: list[bool]) -> str:
    """Share and its own 95 % interval (Clopper and Pearson 1934)."""
    if not hits:
        return "–"
    low, high = binomtest(sum(hits), len(hits)).proportion_ci()
    return f"{100 * np.mean(hits):.0f} % ({100 * low:.0f}–{100 * high:.0f}) of {len(hits)}"


def conclude(results: dict[int, dict[str, Any]], measured: dict[str, dict[str, list[float]]], figures: Path) -> Section:
    """Tables, words and the figure."""
    methods = [m for m in METHODS if hits_of(results, m)]
    over = [(METHODS[m], *(share(hits_of(results, m, kind)) for kind in (None, *KINDS))) for m in methods]
    rows, excess = [], []
    for label in FREE:
        rows.append((f"`{label}`", *(share(hits_of(results, m, label=label)) for m in ("coloured", "profile", "blocks"))))
        times = [
            np.median([r["excess"][label] for i, r in results.items() if kind_of(i) == kind])
            for kind in KINDS
            if any(kind_of(i) == kind for i in results)
        ]
        excess.append((f"`{label}`", *(number(float(x), 2) for x in times)))
    real = [
        (name, f"`{label}`", percent(sd), percent(white), f"{number(ratio, 2)} times")
        for name, of in measured.items()
        for label, (sd, white, ratio) in of.items()
    ]
    heading = (
        (
            "\nThe same for decays measured in basins, where the model's own error is what is left. Deviations are of the "
            "coordinate, which makes them about relative. Identifiable coefficients only:\n\n"
        )
        if real
        else ""
    )
    by_label = {label: hits_of(results, "coloured", label=label) for label in FREE}
    shares = {label: float(np.mean(hits)) for label, hits in by_label.items() if hits}
    outside = [k for k, x in shares.items() if not LOW <= x <= HIGH]
    overall = float(np.mean(hits_of(results, "coloured")))
    count = {kind: sum(kind_of(i) == kind for i in results) for kind in KINDS}
    text = (
        f"{len(results)} campaigns of four short decays (heave twice 120 s, pitch twice 160 s) are made by the separate NumPy "
        "model. They have 19 sets of imperfect releases in turn. Noise and disturbance are each campaign's own. "
        f"{len(FREE)} coefficients are calibrated from values that are off by up to a factor of three.\n\n"
        f"- *White*, {count['white']} campaigns: the sensors' white noise only.\n"
        f"- *Drifting*, {count['drifting']} campaigns: every channel also has a disturbance of {DISTURBED:g} times the noise "
        f"with a correlation time of {MEMORY:g} s.\n"
        f"- *Ringing*, {count['ringing']} campaigns: the disturbance rings at the channel's own natural period with a "
        f"damping ratio of {RINGING:g}. This is the hardest case, because it looks like the decay itself.\n\n"
        "The table has the share of the 95 % intervals that hold the truth, all coefficients together. In brackets is the 95 % "
        "interval of that share, as for independent intervals; those of one campaign are not quite independent:\n\n"
        + table(("Interval", "All", *(kind.capitalize() for kind in KINDS)), over)
        + "\nBy coefficient, all campaigns:\n\n"
        + table(("Coefficient", METHODS["coloured"], METHODS["profile"], METHODS["blocks"]), rows)
        + "\nFactor by which the standard deviation is too small if the residual is taken as white (median):\n\n"
        + table(("Coefficient", *(kind.capitalize() for kind in KINDS)), excess)
        + heading
        + (table(("Campaign", "Coefficient", "Deviation", "As if white", "Too small by"), real) if real else "")
        + f"\n- Over all: {100 * overall:.1f} % of the intervals hold the truth; the goal is {100 * LOW:.0f} to "
        f"{100 * HIGH:.0f} %. {'Met.' if LOW <= overall <= HIGH else 'Not met.'}\n"
        f"- Coefficient by coefficient: from {100 * min(shares.values()):.0f} to {100 * max(shares.values()):.0f} %. "
        f"{'Met.' if not outside else 'Not met by ' + ', '.join(outside) + '.'}\n"
        f"- {sum(r['converged'] for r in results.values())} of {len(results)} fits converged, in "
        f"{np.median([r['iterations'] for r in results.values()]):.0f} iterations (median).\n"
    )
    short = [
        f"95 % intervals of {k} hold the truth in {100 * shares[k]:.0f} % of {len(by_label[k])} campaigns; the goal is "
        "90 to 99 %"
        for k in outside
    ]
    if not LOW <= overall <= HIGH:
        short.insert(0, f"95 % intervals hold the truth in {100 * overall:.1f} % of cases; the goal is 90 to 99 %")
    return Section(TITLE, text, (draw(results, figures / "coverage.png"),), tuple(short))


def draw(results: dict[int, dict[str, Any]], path: Path) -> Path:
    """Coverage by coefficient and method, with its binomial interval."""
    from matplotlib.figure import Figure

    from jaxhydro.plots.style import BEFORE, GREY, MEASURED, SIMULATED, WAVE, WIDTH, header, save, style

    looks = {"coloured": (SIMULATED, "o"), "profile": (MEASURED, "s"), "blocks": (WAVE, "^"), "white": (BEFORE, "D")}
    with style():
        figure = Figure(figsize=(1.5 * WIDTH, 3.4), layout="constrained")
        ax = figure.subplots()
        ax.axvspan(100 * LOW, 100 * HIGH, color="#e9ecf0", lw=0, zorder=0)
        ax.axvline(95, color=GREY, lw=0.6)
        artists = {}
        for rank, (method, (colour, marker)) in enumerate(looks.items()):
            for row, label in enumerate((None, *FREE)):
                hits = hits_of(results, method, label=label)
                if not hits:
                    continue
                low, high = binomtest(sum(hits), len(hits)).proportion_ci()
                y, x = row + 0.18 * (rank - 1.5), 100 * float(np.mean(hits))
                ax.plot([100 * low, 100 * high], [y, y], color=colour, lw=0.9)
                artists[METHODS[method]] = ax.plot(x, y, marker, ms=3.5, color=colour, mew=0, ls="")[0]
        ax.set_yticks(range(len(FREE) + 1), ["all", *FREE])
        ax.set_ylim(len(FREE) + 0.5, -0.5)
        ax.set_xlim(0, 101)
        ax.grid(visible=False, axis="y")
        ax.set_xlabel("95 % intervals that hold the truth (%)")
        header(figure, f"{len(results)} campaigns, half of them with correlated errors", artists)
        save(figure, path)
    return path
