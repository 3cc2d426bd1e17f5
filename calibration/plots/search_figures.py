"""Figures of the search in a diagnosis: candidate scores, residuals, latent forces."""

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter

from calibration.discovery.diagnosis import Diagnosis, MotionResidual, Score
from calibration.discovery.reported_forces import LatentForce
from calibration.formatting import PREFIXES
from jaxhydro.plots.style import GREY, MEASURED, SIMULATED, WAVE, WIDTH, header, stack
from jaxhydro.units import for_people, unit_of

MAX_CANDIDATES, MAX_CANDIDATES_PER_ROUND = 8, 5  # candidates shown of a round; of more than two rounds
MIN_SHOWN_GAIN = 1.0  # of -2 ln L: what gains less is not worth a bar
COLOURS = "YlOrRd"
EXCERPT_LENGTH = 600.0  # s of a latent force in waves


def chosen_effects(diagnosis: Diagnosis) -> dict[int, Score]:
    """Effect that each round took into the model; an effect belongs to the last round that scored it."""
    effects = {(effect.effect, effect.degree_of_freedom) for effect in diagnosis.effects}
    last = {(score.effect, score.degree_of_freedom): score for score in sorted(diagnosis.scores, key=lambda score: score.round)}
    taken = [score for key, score in last.items() if key in effects and score.refitted is not None]
    return {score.round: score for score in taken}


def scores_figure(diagnosis: Diagnosis) -> Figure:
    """Gain of the candidates at first order, a panel for each round, with a dot for refitted ones."""
    took = chosen_effects(diagnosis)
    rounds = {n: _best(diagnosis, n, took.get(n)) for n in sorted({score.round for score in diagnosis.scores})}
    heights = [0.165 * len(rows) + 0.1 for rows in rounds.values()]
    figure = Figure(figsize=(WIDTH, sum(heights) + 0.27 * len(heights) + 0.8), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(len(heights), 1, sharex=True, squeeze=False, gridspec_kw={"height_ratios": heights})[:, 0]
    largest = max(
        [MIN_SHOWN_GAIN * 10, *(_gain(gain) for rows in rounds.values() for s in rows for gain in (s.gain, s.refitted))]
    )
    artists: dict[str, Artist] = {}
    for ax, (n, rows) in zip(axes, rounds.items()):
        for i, score in enumerate(rows):
            chosen = score is took.get(n)
            ax.barh(
                i,
                _gain(score.gain) - MIN_SHOWN_GAIN,
                left=MIN_SHOWN_GAIN,
                height=0.68,
                color=SIMULATED if chosen else "#c3c9d1",
            )
            if score.refitted is not None:
                dot = Line2D([_gain(score.refitted)], [i], marker="o", ms=3.5, color=MEASURED, ls="", clip_on=False)
                artists["refitted"] = ax.add_line(dot)
        _scores_axes(ax, [_named(score) for score in rows], 2.0 * largest)
        ax.set_title(f"Round {n}", pad=2)
    axes[-1].set_xlabel("Gain in −2 ln L of the fitted tests")
    legend: dict[str, Artist] = {"first order": Patch(color="#c3c9d1")}
    legend |= {"kept": Patch(color=SIMULATED)} if took else {}
    header(figure, "Candidates, round by round", legend | artists)
    return figure


def _best(diagnosis: Diagnosis, n: int, chosen: Score | None) -> list[Score]:
    """Candidates of a round, the largest gain first; the chosen and the refitted ones are among them."""
    rows = sorted((score for score in diagnosis.scores if score.round == n), key=lambda score: -_gain(score.gain))
    several = len({score.round for score in diagnosis.scores}) > 2
    shown = [score for score in rows if score.refitted is not None or _gain(score.gain) > MIN_SHOWN_GAIN] or rows[:1]
    wanted = sorted(shown, key=lambda score: (score is not chosen, score.refitted is None))[
        : MAX_CANDIDATES_PER_ROUND if several else MAX_CANDIDATES
    ]
    return [score for score in rows if any(score is choice for choice in wanted)]


def _gain(value: float | None) -> float:
    """Gain as a logarithmic axis can show it: at least `MIN_SHOWN_GAIN`."""
    return max(MIN_SHOWN_GAIN, value) if value is not None and np.isfinite(value) else MIN_SHOWN_GAIN


def _named(score: Score) -> str:
    motion = f" ({score.degree_of_freedom})" if score.degree_of_freedom else ""
    return f"{score.effect.replace('_', ' ').replace('coulomb', 'Coulomb')}{motion}"


def _scores_axes(ax: Axes, labels: list[str], highest: float) -> None:
    ax.set_xscale("log")
    ax.set_xlim(MIN_SHOWN_GAIN, highest)
    ax.minorticks_off()
    ax.set_ylim(len(labels) - 0.4, -0.6)
    ax.set_yticks(range(len(labels)), labels, fontsize=7)
    ax.tick_params(axis="y", length=0)
    ax.grid(visible=False, axis="y")


def anatomy_figure(before: tuple[MotionResidual, ...], after: tuple[MotionResidual, ...]) -> Figure:
    """Residual over noise in frequency bands, a row for every motion of every test, before beside after."""
    rows = sorted(before, key=lambda finding: (finding.use != "fit", before.index(finding)))
    after_by_motion = {(finding.test, finding.channel): finding for finding in after}
    pairs = [(finding, after_by_motion.get((finding.test, finding.channel))) for finding in rows]
    every = [band for pair in pairs for finding in pair if finding is not None for band in finding.bands]
    ratios = [ratio for *_, ratio in every if np.isfinite(ratio)]
    norm = LogNorm(1.0, max(10.0, max(ratios, default=10.0)))
    low = 0.6 * min((high for _, high, _ in every if high > 0), default=1e-3)
    end = max((high for _, high, _ in every), default=1.0)
    figure = Figure(figsize=(WIDTH, 0.165 * len(rows) + 1.35), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(1, 2, sharey=True)
    held = sum(finding.use == "fit" for finding in rows)
    for ax, column, title in zip(axes, (0, 1), ("Before", "After")):
        for i, pair in enumerate(pairs):
            _strip(ax, i, pair[column], low, norm)
        ax.set_xscale("log")
        ax.set_xlim(low, end)
        ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        ax.set_title(title, pad=3)
        ax.grid(visible=False)
        ax.tick_params(axis="y", length=0)
        ax.set_xlabel("Frequency (Hz)")
        ax.minorticks_off()
        if 0 < held < len(rows):
            ax.axhline(held - 0.5, color=MEASURED, lw=0.8)
    axes[0].set_yticks(range(len(rows)), [_row_name(finding) for finding in rows], fontsize=7)
    axes[0].set_ylim(len(rows) - 0.5, -0.5)
    bar = figure.colorbar(ScalarMappable(norm, COLOURS), ax=axes, location="bottom", aspect=40, pad=0.02)
    bar.set_label("Residual / noise (rms in the band)")
    bar.minorticks_off()
    bar.ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    header(figure, "Where the residual lives")
    return figure


def _strip(ax: Axes, row: int, finding: MotionResidual | None, low: float, norm: LogNorm) -> None:
    """Draw the bands of one motion, from the beginning of the axis on."""
    if finding is None or not finding.bands:
        ax.axhspan(row - 0.5, row + 0.5, color="#eef0f2", lw=0)
        return
    for begin, end, ratio in finding.bands:
        if end > low:
            colour = GREY if not np.isfinite(ratio) else ScalarMappable(norm, COLOURS).to_rgba(np.array([max(ratio, 1.0)]))[0]
            ax.fill_between([max(begin, low), end], row - 0.46, row + 0.46, color=colour, lw=0)


def _row_name(finding: MotionResidual) -> str:
    name = finding.test if finding.channel in finding.test else f"{finding.test}, {finding.channel}"
    return name if len(name) <= 20 else f"{name[:19]}…"


def latent_figure(force: LatentForce) -> Figure:
    """A latent force over time with its law, and below it the velocity or the wave.

    Of a test in waves, the part with the largest force is shown.
    """
    shown, samples = force.shown, slice(None)
    step = float(shown.time[1] - shown.time[0])
    if shown.beside == "wave" and (count := round(EXCERPT_LENGTH / step)) < len(shown.time):
        power = np.concatenate([[0.0], np.cumsum(shown.force**2)])
        samples = slice(begin := int(np.argmax(power[count:] - power[:-count])), begin + count)
    time, highest = shown.time[samples], float(np.abs(shown.force[samples]).max())
    factor, prefix = next(((size, name) for size, name in PREFIXES if highest >= size), (1.0, ""))
    figure, axes = stack([1.1, 0.8])
    artists: dict[str, Artist] = {"latent force": axes[0].plot(time, shown.force[samples] / factor, color=MEASURED)[0]}
    if len(shown.law):
        artists["law"] = axes[0].plot(time, shown.law[samples] / factor, color=SIMULATED, lw=0.8)[0]
    axes[0].set_ylabel(f"{'Moment' if force.unit == 'N m' else 'Force'}\n({prefix}{force.unit})")
    wave = shown.beside == "wave"
    values = shown.values[samples] if wave else for_people(force.motion, shown.values[samples])
    axes[1].plot(time, values, color=WAVE if wave else GREY, lw=0.8)
    axes[1].set_ylabel("Wave (m)" if wave else f"Velocity\n({unit_of(force.motion)}/s)")
    axes[1].set_xlabel("Time (s)")
    header(figure, f"What the model lacks in {force.motion}: {shown.test[:18]}", artists)
    return figure
