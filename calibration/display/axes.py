"""Axes of campaigns and results, in the style of the package's figures; nothing is shown on a screen."""

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, TypeVar

from calibration.campaign.load_campaign import Campaign
from calibration.discovery.diagnosis import Diagnosis
from calibration.plots.overview_figures import comparison_figure, records_figure
from calibration.result import Calibration
from calibration.results.diagnosis_motions import paired
from jaxhydro.choices import unknown
from jaxhydro.plots.style import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Named = TypeVar("Named")
HELD_OUT_FIRST = ("holdout", "fit", "ignore")


def calibration_axes(calibration: Calibration, tests: Collection[str] | None = None) -> "list[Axes]":
    """Axes of `Calibration.plot`."""
    shown = selected({test.id: test for test in calibration.tests if test.series}, tests)
    with style():
        title = f"Calibration to {calibration.campaign}"
        return comparison_figure(shown, title, ("calibrated", "before")).axes


def diagnosis_axes(diagnosis: Diagnosis, tests: Collection[str] | None = None) -> "list[Axes]":
    """Axes of `Diagnosis.plot`."""
    every = sorted(paired(diagnosis).tests, key=lambda test: HELD_OUT_FIRST.index(test.use))
    shown = selected({test.id: test for test in every if test.series}, tests)
    with style():
        return comparison_figure(shown, f"Diagnosis of {diagnosis.campaign}", ("after", "before")).axes


def campaign_axes(campaign: Campaign, tests: Collection[str] | None = None) -> "list[Axes]":
    """Axes of `Campaign.plot`."""
    shown = selected({record.id: record for record in campaign.records}, tests)
    with style():
        return records_figure(shown, f"Records of {campaign.manifest.name}").axes


def selected(every: Mapping[str, Named], names: Collection[str] | None) -> list[Named]:
    """Tests of some names, in their own order; all where none are named.

    Raises:
        UnknownName: There is no such test.
        ValueError: There is no test.
    """
    for name in () if names is None else names:
        if name not in every:
            raise unknown("test", name, every)
    chosen = [test for name, test in every.items() if names is None or name in names]
    if not chosen:
        raise ValueError("there is no test to plot")
    return chosen
