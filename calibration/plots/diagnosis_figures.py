"""Figures of a diagnosis: errors, residuals and spectra before and after."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from calibration.discovery.diagnosis import Diagnosis
from calibration.discovery.effects.effect_names import effect_in_words
from calibration.discovery.reported_effects import Effect
from calibration.formatting import percent
from calibration.plots.calibration_figures import MAX_FREQUENCY, motion_density
from calibration.plots.search_figures import MIN_SHOWN_GAIN, anatomy_figure, latent_figure, scores_figure
from calibration.result import Calibration, Series, TestFit
from calibration.vocabulary import USE
from jaxhydro.environment import DOFS
from jaxhydro.files import safe_name
from jaxhydro.plots.spectrum_axes import draw_densities, shade_bands
from jaxhydro.plots.style import BEFORE, MEASURED, SIMULATED, WIDTH, header, stack
from jaxhydro.units import for_people, unit_of

EXCERPT_LENGTHS = {"surge": 1200.0, "sway": 1200.0, "yaw": 1200.0}  # s of a record in waves that are shown
SHORT_EXCERPT = 600.0  # of the other motions


def figures(diagnosis: Diagnosis, compared: Calibration) -> Iterator[tuple[str, str, Figure]]:
    """File name, caption and figure, one after the other. Call within `plots.style.style()`.

    Args:
        diagnosis: The diagnosis.
        compared: The augmented calibration, with the baseline's motions as those before.
    """
    rows = compared_series(compared)
    if rows:
        yield "before-after.png", _BEFORE_AFTER, before_after_figure(rows)
    if diagnosis.anatomy_before:
        yield "anatomy.png", _ANATOMY, anatomy_figure(diagnosis.anatomy_before, diagnosis.anatomy_after)
    shown: set[tuple[str, str]] = set()
    for effect in diagnosis.effects:
        row = clearest_row([row for row in rows if (row.test.id, row.series.channel) not in shown], effect)
        if row is not None:
            shown.add((row.test.id, row.series.channel))
            name = "-".join(filter(None, ("effect", effect.effect, effect.degree_of_freedom)))
            title = effect_in_words(effect.effect, effect.degree_of_freedom)
            yield f"{safe_name(name)}.png", _EFFECT.format(title=title, id=row.test.id), effect_figure(row, title)
    if any(max(score.gain, score.refitted or 0.0) > MIN_SHOWN_GAIN for score in diagnosis.scores):
        yield "scores.png", _SCORES, scores_figure(diagnosis)
    if diagnosis.latent:
        largest = max(diagnosis.latent, key=lambda force: force.relative)
        yield "latent-force.png", _LATENT.format(motion=largest.motion, id=largest.shown.test), latent_figure(largest)
    for test in compared.tests:
        if test.kind == "irregular" and series_with_spectra(test):
            yield f"spectra-{safe_name(test.id)}.png", _SPECTRA.format(id=test.id), spectra_figure(test)


_BEFORE_AFTER = "RMSE over the motion's standard deviation of every test, without what was missing and with it, both fitted."
_ANATOMY = "The residual over the noise by test and frequency, before and after; held-out tests below the line."
_EFFECT = (
    "With {title}, test {id}: the measured motion, and what the model leaves of it without what was missing and with "
    "it. Grey: two standard deviations of the noise."
)
_SCORES = (
    "How much better the fitted tests are with every candidate, in −2 ln L, the best of every round. Bars are at first "
    "order, dots refitted."
)
_LATENT = (
    "Test {id}: the force in {motion} that would have to act on the model for it to follow the record. Beside it the "
    "law of few terms that explains it, if there is one, and what may drive it."
)
_SPECTRA = "Test {id}: spectra of the motions, measured and simulated without what was missing and with it; bands shaded."


class MotionRow(NamedTuple):
    """One motion of one test that counts, and its simulation before."""

    test: TestFit
    series: Series
    before: np.ndarray

    @property
    def residuals(self) -> tuple[np.ndarray, np.ndarray]:
        """Measured less simulated, before and after (m, rad)."""
        return self.series.measured - self.before, self.series.measured - self.series.simulated

    @property
    def errors(self) -> tuple[float, float]:
        """RMSE over the standard deviation, before and after."""
        spread = max(float(np.std(self.series.measured)), 1e-300)
        first, second = (float(np.sqrt(np.mean(r**2))) / spread for r in self.residuals)
        return first, second


def compared_series(compared: Calibration) -> list[MotionRow]:
    """Motions that count in J, or the main motion of a test without any; fitted tests first."""
    rows = []
    for use in USE:
        for test in compared.tests:
            counted = [s for s in test.series if s.scored] or ([test.main] if test.series else [])
            rows += [MotionRow(test, s, test.start[s.channel]) for s in counted if test.use == use and s.channel in test.start]
    return [row for row in rows if np.isfinite(row.errors).all()]


def before_after_figure(rows: list[MotionRow]) -> Figure:
    """Two bars for every motion of every test, held-out tests apart."""
    positions, labels, heads, height = [], [], [], 0.0
    for i, row in enumerate(rows):
        if i == 0 or row.test.use != rows[i - 1].test.use:
            heads.append((height, USE[row.test.use]))
            height += 0.85
        positions.append(height)
        channel = "" if row.series.channel in row.test.id else f", {row.series.channel}"
        labels.append(f"{_shortened(row.test.id)}{channel}")
        height += 1.0
    figure = Figure(figsize=(WIDTH, 0.26 * height + 0.85), layout="constrained")
    FigureCanvasAgg(figure)
    ax = figure.subplots()
    errors = np.array([row.errors for row in rows])
    for column, colour, shift in ((0, BEFORE, -0.2), (1, SIMULATED, 0.2)):
        ax.barh(np.array(positions) + shift, 100 * errors[:, column], height=0.37, color=colour)
        for position, error in zip(positions, errors[:, column]):
            ax.annotate(
                percent(error),
                (100 * error, position + shift),
                (2, 0),
                textcoords="offset points",
                va="center",
                fontsize=6.5,
                color="#555a62",
            )
    for position, text in heads:
        ax.text(0.0, position, f" {text}", fontweight="bold", va="center")
    ax.set_yticks(positions, labels)
    ax.tick_params(axis="y", length=0)
    ax.grid(visible=False, axis="y")
    ax.set_ylim(height - 0.4, -0.6)
    ax.set_xlim(0.0, 113 * max(float(errors.max()), 1e-6))
    ax.set_xlabel("RMSE / standard deviation of the motion (%)")
    header(figure, "Error before and after", {"before": Patch(color=BEFORE), "after": Patch(color=SIMULATED)})
    return figure


def _shortened(text: str, most: int = 18) -> str:
    return text if len(text) <= most else f"{text[: most - 1]}…"


def clearest_row(rows: list[MotionRow], effect: Effect) -> MotionRow | None:
    """Motion of a test in which an effect shows best: that with the largest fall of the error.

    The effect's own motion is preferred, if its error falls in any test. None where no error falls.
    """

    def fall(row: MotionRow) -> float:
        before, after = row.errors
        return before - after

    falling = [row for row in rows if fall(row) > 0]
    same_motion = [row for row in falling if row.series.channel == effect.degree_of_freedom]
    return max(same_motion or falling, key=fall, default=None)


def excerpt(row: MotionRow) -> slice:
    """Samples that are shown: all of a decay, or the part of a test in waves with the largest gain."""
    time, (before, after) = row.test.time, row.residuals
    count = int(np.searchsorted(time - time[0], EXCERPT_LENGTHS.get(row.series.channel, SHORT_EXCERPT)))
    if row.test.kind == "decay" or count >= len(time):
        return slice(0, len(time))
    gained = np.concatenate([[0.0], np.cumsum(before**2 - after**2)])
    begin = int(np.argmax(gained[count:] - gained[:-count]))
    return slice(begin, begin + count)


def effect_figure(row: MotionRow, title: str) -> Figure:
    """Measured motion, and below it the residuals before and after on one scale."""
    name, samples = row.series.channel, excerpt(row)
    time = row.test.time[samples] - row.test.time[0]
    figure, axes = stack([0.95, 0.8, 0.8])
    measured = for_people(name, row.series.measured[samples])
    artists: dict[str, Artist] = {"measured": axes[0].plot(time, measured, color=MEASURED)[0]}
    axes[0].set_ylabel(f"{name.capitalize()}\n({unit_of(name)})")
    noise = 2 * float(for_people(name, row.series.noise))
    both = [for_people(name, residual[samples]) for residual in row.residuals]
    limit = 1.08 * max(float(np.abs(residual).max()) for residual in both)
    for ax, residual, label, colour in zip(axes[1:], both, ("before", "after"), (BEFORE, SIMULATED)):
        artists["noise"] = ax.axhspan(-noise, noise, color="#d3d8df", lw=0, zorder=0.5)
        artists[label] = ax.plot(time, residual, color=colour, lw=0.8)[0]
        ax.set_ylim(-max(limit, 1.2 * noise), max(limit, 1.2 * noise))
        ax.set_ylabel(f"Left {label}\n({unit_of(name)})")
    axes[-1].set_xlabel("Time (s)")
    order = ("measured", "before", "after", "noise")
    words = f"{_shortened(title[:1].upper() + title[1:], 30)}: {_shortened(row.test.id)} ({USE[row.test.use]})"
    header(figure, words, {label: artists[label] for label in order})
    return figure


def series_with_spectra(test: TestFit) -> list[Series]:
    """The motions whose spectra are shown: those with bands, or surge, heave and pitch."""
    names = [dof for dof in DOFS if dof in test.bands] or ["surge", "heave", "pitch"]
    return [series for series in test.series if series.channel in names]


def spectra_figure(test: TestFit) -> Figure:
    """Spectral densities measured, before and after; the bands of slow motion and of waves shaded."""
    shown = series_with_spectra(test)
    figure, axes = stack([1.1] * len(shown))
    artists: dict[str, Artist] = {}
    for ax, series in zip(axes, shown):
        channel, before = series.channel, test.start.get(series.channel)
        bands = test.bands.get(channel, {})
        artists |= shade_bands(ax, {name: (band.low, band.high) for name, band in bands.items()})
        densities = [motion_density("measured", test, channel, series.measured, MEASURED, 1.6)]
        if before is not None:
            densities.append(motion_density("before", test, channel, before, BEFORE, 1.0))
        densities.append(motion_density("after", test, channel, series.simulated, SIMULATED, 0.8))
        artists |= draw_densities(ax, channel, densities, MAX_FREQUENCY)
    axes[-1].set_xlabel("Frequency (Hz)")
    order = ["measured", "low frequency", "before", "wave frequency", "after"]  # a legend is filled column by column
    told = {name: artists[name] for name in order if name in artists}
    header(figure, f"{_shortened(test.id, 30)} ({USE[test.use]})", told, 3)
    return figure
