"""Motions of a diagnosis: measured, and simulated without and with the effects found."""

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from calibration.discovery.diagnosis import Diagnosis
from calibration.result import BandError, Calibration, Series, TestFit
from calibration.results.tests_dataset import motions_of_tests
from jaxhydro.netcdf_file import DataSet
from jaxhydro.units import for_people

if TYPE_CHECKING:
    import xarray as xr

LONG_NAMES = {"simulated": "motion of the model with what was found missing", "before": "motion of the baseline"}
HALF_WIDTH = "half the width of the band in which 95 % of a held-out test's samples are expected"


def motions(diagnosis: Diagnosis, compared: Calibration) -> "xr.Dataset":
    """`motions_with_effects` as an xarray data set."""
    import xarray as xr  # where it is used: what is written alone does without

    return xr.Dataset(*motions_with_effects(diagnosis, compared))


def motions_with_effects(diagnosis: Diagnosis, compared: Calibration) -> DataSet:
    """Content of simulated.nc: motions measured, and simulated without and with the effects found.

    Motions are in m and deg. Half the widths of the predictions' bands are beside them.

    Args:
        diagnosis: The diagnosis.
        compared: The two fits, `paired`.
    """
    data = motions_of_tests(compared)
    variables = dict(data.variables)
    for name, words in LONG_NAMES.items():
        dimensions, values, about = variables[name]
        variables[name] = (dimensions, values, {**about, "long_name": words})
    if diagnosis.predictions:
        dimensions, values, about = variables["simulated"]
        variables["half_width"] = (dimensions, _half_widths(data, diagnosis), {**about, "long_name": HALF_WIDTH})
    return data._replace(variables=variables, attributes={**data.attributes, "title": f"Diagnosis of {diagnosis.campaign}"})


def _half_widths(data: DataSet, diagnosis: Diagnosis) -> np.ndarray:
    """Half the widths of the predictions' bands, (test, channel, time); nan where there is no prediction."""
    axis, tests, channels = (data.coordinates[name][1] for name in ("time", "test", "channel"))
    widths = np.full_like(data.variables["simulated"][1], np.nan)
    times = {test.id: test.time for test in diagnosis.augmented.tests}
    for prediction in diagnosis.predictions:
        time, row = times[prediction.test], (list(tests).index(prediction.test), list(channels).index(prediction.channel))
        half_width = for_people(prediction.channel, prediction.half_width)
        widths[row] = np.interp(axis, time - time[0], half_width, left=np.nan, right=np.nan)
    return widths


def paired(diagnosis: Diagnosis) -> Calibration:
    """Calibration of the augmented model, with motions and band errors of the baseline as those before."""
    first = {test.id: test for test in diagnosis.baseline.tests}
    tests = tuple(_paired(first[test.id], test) if test.id in first else test for test in diagnosis.augmented.tests)
    return replace(diagnosis.augmented, tests=tests)


def _paired(before: TestFit, after: TestFit) -> TestFit:
    return replace(
        after,
        start=dict(_motions(before.series, after.series)),
        bands={
            channel: {band: error._replace(before=_band(before, channel, band, error)) for band, error in row.items()}
            for channel, row in after.bands.items()
        },
    )


def _motions(before: Iterable[Series], after: Iterable[Series]) -> Iterable[tuple[str, np.ndarray]]:
    """Motions of the baseline on the sensor offsets of the augmented fit.

    Residuals stay what they were.
    """
    by_channel = {series.channel: series for series in before}
    for series in after:
        baseline = by_channel.get(series.channel)
        if baseline is not None and len(baseline.simulated) == len(series.measured):
            yield series.channel, baseline.simulated + (series.measured - baseline.measured)


def _band(before: TestFit, channel: str, band: str, error: BandError) -> float:
    earlier = before.bands.get(channel, {}).get(band)
    return error.before if earlier is None else earlier.after
