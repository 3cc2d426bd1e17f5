"""Writing of a comparison in waves: comparison.json, simulated.nc, figures."""

import dataclasses
import math
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

import jaxhydro
from calibration.campaign.signals import wave_height
from calibration.residuals.measured_seas import Comparison, SeaTest
from calibration.residuals.sea_errors import WELCH, amplitude, channels, in_bands, moving
from calibration.residuals.wave_options import Options
from calibration.results.applied_calibration import AppliedCalibration
from calibration.results.calibration_file import ChannelError, TestErrors
from calibration.results.comparison_file import (
    BandEnergies,
    ChannelStatistics,
    ComparisonFile,
    Moments,
    Pair,
    SeaTestResults,
    SimulatedOptions,
    SimulatedSea,
    UsedCoefficients,
)
from calibration.results.result_folder import COMPARISON_FILE, draw, outdated, write_motion
from calibration.results.tests_dataset import common_axis
from jaxhydro.environment import DOFS
from jaxhydro.files import staged
from jaxhydro.hull.outline import hull_variable
from jaxhydro.netcdf_file import DataSet
from jaxhydro.result_model import stated
from jaxhydro.units import for_people, unit_of


def write_comparison(
    comparison: Comparison, content: ComparisonFile, folder: str | PathLike[str], figures: bool = True
) -> ComparisonFile:
    """Write all results; they replace those of an earlier comparison.

    Args:
        comparison: The comparison.
        content: Content of comparison.json without figures.
        folder: Folder of the results, made where absent.
        figures: Whether figures are drawn.

    Returns:
        The content of comparison.json.

    Raises:
        InputError: The folder cannot be written.
    """
    folder = Path(folder)
    with staged(folder, lambda temporary: outdated(folder, temporary, COMPARISON_FILE)) as temporary:
        drawn = []
        if figures:
            from calibration.plots import comparison_figures as seas_plot

            drawn = draw(seas_plot.figures(comparison.tests), temporary)
        content = content.model_copy(update={"figures": drawn})
        content.write(temporary / COMPARISON_FILE)
        write_motion(_series(comparison, content.campaign), temporary)
    return content


def document(
    comparison: Comparison,
    options: Options,
    *,
    campaign: str,
    platform: str,
    calibration: str | None,
    applied: AppliedCalibration | None,
) -> ComparisonFile:
    """Content of comparison.json without figures.

    Args:
        comparison: The comparison.
        options: Options of the waves.
        campaign: Name of the campaign.
        platform: Name of the platform.
        calibration: File of the calibration, or None.
        applied: The calibration as it was used, or None.
    """
    coefficients = UsedCoefficients(source="platform", values={}, not_identifiable=[], left_out=[])
    if applied is not None:
        coefficients = UsedCoefficients(
            source=f"calibration of {applied.campaign}",
            values=applied.values,
            not_identifiable=list(applied.undetermined),
            left_out=list(applied.not_used),
            **stated(strips=applied.strips and applied.strips.model_dump()),
        )
    seas = [
        SimulatedSea(
            file=run.file,
            tests=[record.id for record in run.records],
            duration=float(run.time[-1] - run.time[0]),
            components=int(made.sea.components.omega.size),
            gauge=tuple(map(float, run.position)),
            heading=math.degrees(run.heading),
            mismatch=made.mismatch,
            rounds=made.rounds,
            variance_in_band=made.inside,
        )
        for run, made in comparison.seas
    ]
    return ComparisonFile(
        campaign=campaign,
        platform=platform,
        calibration=calibration,
        jaxhydro=jaxhydro.__version__,
        options=SimulatedOptions(**dataclasses.asdict(options), step=comparison.step, spectra=WELCH),
        coefficients=coefficients,
        seas=seas,
        error={test.fit.id: _errors(test) for test in comparison.tests},
        tests={test.fit.id: _about(test) for test in comparison.tests},
        warnings=list(comparison.notes),
    )


def _errors(test: SeaTest) -> TestErrors:
    errors: dict[str, Any] = {}
    for s in test.fit.series:
        rmse = float(for_people(s.channel, s.rmse))
        errors[s.channel] = ChannelError(rmse=rmse, unit=unit_of(s.channel), relative=s.relative)
    if test.fit.kind == "irregular":
        each = {name: {k: b.error for k, b in row.items() if math.isfinite(b.error)} for name, row in in_bands(test).items()}
        errors["bands"] = {name: row for name, row in each.items() if name in DOFS and row}
    return TestErrors(use=test.fit.use, **errors)


def _about(test: SeaTest) -> SeaTestResults:
    """Sea of a test, and statistics of its channels in m and deg."""
    both, worth = channels(test), {"wave", *moving(test)}
    statistics = {
        name: ChannelStatistics(
            unit=unit_of(name),
            moving=name in worth,
            measured=Moments(mean=float(pair[0].mean()), standard_deviation=float(pair[0].std())),
            simulated=Moments(mean=float(pair[1].mean()), standard_deviation=float(pair[1].std())),
        )
        for name, pair in both.items()
    }
    irregular = test.fit.kind == "irregular"
    heights = Pair(**dict(zip(("measured", "simulated"), (wave_height(x, irregular) for x in both["wave"]))))
    more: dict[str, Any] = {"significant_wave_height" if irregular else "wave_height": heights}
    if irregular:
        more["bands"] = {
            name: {k: BandEnergies(band=(b.low, b.high), measured=b.measured, simulated=b.simulated) for k, b in row.items()}
            for name, row in in_bands(test).items()
        }
    else:
        amplitudes = {name: [amplitude(test, x) for x in pair] for name, pair in both.items()}
        more["amplitude"] = {name: Pair(measured=a, simulated=b) for name, (a, b) in amplitudes.items()}
    return SeaTestResults(
        kind=test.fit.kind,
        file=test.fit.file,
        start=float(test.fit.time[0]),
        end=float(test.fit.time[-1]),
        peak_period=test.peak_period,
        stated_height=test.stated_height,
        heading=math.degrees(test.heading),
        statistics=statistics,
        **more,
    )


def _series(comparison: Comparison, campaign: str) -> DataSet:
    """Measured and simulated motions (test, channel, time) and waves (test, time), in m and deg.

    Values are nan where there are none. `time` counts from where every test's comparison begins, after its transient
    (`start_time`, on its file's axis).
    """
    tests = comparison.tests
    names = [dof for dof in DOFS if any(s.channel == dof for test in tests for s in test.fit.series)]
    times = [test.fit.time - test.fit.time[0] for test in tests]
    axis, alike = common_axis(times)
    motion = {key: np.full((len(tests), len(names), len(axis)), np.nan) for key in ("measured", "simulated")}
    wave = {key: np.full((len(tests), len(axis)), np.nan) for key in ("measured", "simulated")}
    for i, (test, time) in enumerate(zip(tests, times)):
        for name, pair in channels(test).items():
            for key, values in zip(("measured", "simulated"), pair):
                row = wave[key][i] if name == "wave" else motion[key][i, names.index(name)]
                row[:] = (
                    np.pad(values, (0, len(axis) - len(time)), constant_values=np.nan)
                    if alike
                    else np.interp(axis, time, values, left=np.nan, right=np.nan)
                )
    both = {"units": "m; deg for roll, pitch and yaw"}
    words = {"measured": "measured motion of the reference point, still water at zero", "simulated": "motion of the model"}
    wave_words = {"measured": "measured elevation at the gauge", "simulated": "elevation of the simulated sea at the gauge"}
    data: dict[str, Any] = {
        key: (("test", "channel", "time"), motion[key], both | {"long_name": words[key]}) for key in motion
    } | {f"wave_{key}": (("test", "time"), wave[key], {"units": "m", "long_name": wave_words[key]}) for key in wave}
    data |= hull_variable(comparison.hull)
    starts = np.array([float(test.fit.time[0]) for test in tests])
    coordinates: dict[str, Any] = {
        "time": ("time", axis, {"units": "s", "long_name": "time since the start of the comparison"}),
        "test": ("test", np.array([test.fit.id for test in tests], dtype=object), {"long_name": "test"}),
        "channel": ("channel", np.array(names, dtype=object), {"long_name": "motion"}),
        "unit": ("channel", np.array([unit_of(name) for name in names], dtype=object), {"long_name": "unit of the channel"}),
        "start_time": ("test", starts, {"units": "s", "long_name": "on the file's time axis, at full scale"}),
        "use": ("test", np.array([test.fit.use for test in tests], dtype=object), {"long_name": "fit or holdout"}),
        "kind": ("test", np.array([test.fit.kind for test in tests], dtype=object), {"long_name": "kind of test"}),
    }
    about = {
        "title": f"Tests in waves of {campaign}",
        "source": f"jaxhydro {jaxhydro.__version__}",
        "sampling": "as recorded" if alike else "interpolated linearly to the finest sampling",
    }
    return DataSet(data, coordinates, about)
