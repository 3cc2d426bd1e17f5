"""Motions of a diagnosis: measured, and simulated without and with the effects found."""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
import xarray as xr

from calibration.discovery.diagnosis import Diagnosis
from calibration.result import BandError, Calibration, Series, TestFit
from calibration.results.tests_dataset import dataset
from jaxhydro.units import for_people


def motions(diagnosis: Diagnosis, compared: Calibration) -> xr.Dataset:
    """Content of simulated.nc: motions measured, and simulated without and with the effects found.

    Motions are in m and deg.

    Args:
        diagnosis: The diagnosis.
        compared: The two fits, `paired`.
    """
    motion = dataset(compared)
    motion.attrs["title"] = f"Diagnosis of {diagnosis.campaign}"
    motion["simulated"].attrs["long_name"] = "motion of the model with what was found missing"
    motion["before"].attrs["long_name"] = "motion of the baseline"
    return with_bands(motion, diagnosis) if diagnosis.predictions else motion


def with_bands(motion: xr.Dataset, diagnosis: Diagnosis) -> xr.Dataset:
    """Motions of the tests, with half the widths of the predictions' bands beside them."""
    widths = xr.full_like(motion["simulated"], np.nan)
    times = {test.id: test.time for test in diagnosis.augmented.tests}
    for prediction in diagnosis.predictions:
        time = times[prediction.test]
        half_width = for_people(prediction.channel, prediction.half_width)
        widths.loc[{"test": prediction.test, "channel": prediction.channel}] = np.interp(
            motion["time"], time - time[0], half_width, left=np.nan, right=np.nan
        )
    widths.attrs["long_name"] = "half the width of the band in which 95 % of a held-out test's samples are expected"
    return motion.assign(half_width=widths)


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
