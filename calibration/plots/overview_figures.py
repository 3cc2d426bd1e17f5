"""Figures of all tests at once: records of a campaign; measured against simulated motion."""

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure

from calibration.campaign.records import Record
from calibration.plots.calibration_figures import compare_motions
from calibration.result import Series, TestFit
from calibration.vocabulary import USE
from jaxhydro.plots.seas import moving
from jaxhydro.plots.style import MEASURED, WAVE, header, stack
from jaxhydro.units import for_people, unit_of

PANEL_HEIGHT = 0.8  # inches
MAX_WORDS = 22  # letters of a test's name on an axis


def shown_series(test: TestFit) -> list[Series]:
    """Motions of a test that count in the objective, or the main one where none does."""
    return [series for series in test.series if series.scored] or ([test.main] if test.series else [])


def comparison_figure(tests: Sequence[TestFit], title: str, labels: tuple[str, str]) -> Figure:
    """Measured and simulated motions (m, deg) over time (s), a panel for each. Call within `style`.

    Args:
        tests: The tests, in the order of the panels.
        title: Title of the figure.
        labels: What the simulated motions are called: `TestFit.series`, and `TestFit.start`.
    """
    rows = [(test, series) for test in tests for series in shown_series(test)]
    figure, axes = stack([PANEL_HEIGHT] * len(rows), shared=False)
    artists: dict[str, Artist] = {}
    for ax, (test, series) in zip(axes, rows, strict=True):
        lines = compare_motions(ax, test.time - test.time[0], series, test.start.get(series.channel), 0.7)
        names = {"measured": "measured", "calibrated": labels[0], "before": labels[1]}
        artists |= {names[name]: line for name, line in lines.items()}
        ax.set_ylabel(f"{series.channel.capitalize()} ({unit_of(series.channel)})")
        ax.set_title(f"{_shortened(test.id)} ({USE[test.use]})", fontsize=7)
    axes[-1].set_xlabel("Time (s)")
    header(figure, title, artists)
    return figure


def records_figure(records: Sequence[Record], title: str) -> Figure:
    """Records (m, deg) over time (s), a panel for each channel. Call within `style`.

    Of a decay the released motion is shown, of other tests the wave and the moving channels.

    Args:
        records: The records.
        title: Title of the figure.
    """
    rows = [(record, name, values) for record in records for name, values in _channels(record).items()]
    figure, axes = stack([PANEL_HEIGHT] * len(rows), shared=False)
    for ax, (record, name, values) in zip(axes, rows, strict=True):
        colour, width = (WAVE if name == "wave" else MEASURED), (0.8 if record.kind == "decay" else 0.4)
        ax.plot(record.time - record.time[0], values, color=colour, lw=width)
        ax.set_ylabel(f"{name.capitalize()} ({unit_of(name)})")
        ax.set_title(f"{_shortened(record.id)} ({USE[record.use]})", fontsize=7)
    axes[-1].set_xlabel("Time (s)")
    header(figure, title)
    return figure


def _channels(record: Record) -> dict[str, np.ndarray]:
    """Channels of a record that are shown (m, deg)."""
    released = record.degree_of_freedom
    motions = record.values if released not in record.values else {released: record.values[released]}
    channels = {name: for_people(name, values) for name, values in motions.items()}
    if record.wave is not None and released not in record.values:
        channels = {"wave": record.wave, **channels}
    return {name: channels[name] for name in moving(channels)}


def _shortened(text: str) -> str:
    return text if len(text) <= MAX_WORDS else f"{text[: MAX_WORDS - 1]}…"
