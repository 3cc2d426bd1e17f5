"""Writing of a calibration: calibration.json, simulated.nc, figures."""

import math
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

import jaxhydro
from calibration.decay_analysis.linear_quadratic import classical
from calibration.notes import kind_of
from calibration.result import Calibration, Estimate, Series, TestFit
from calibration.results.calibration_file import (
    CalibrationFile,
    ChannelError,
    DampingTerm,
    FittedModel,
    LinearQuadraticDamping,
    MotionError,
    Objective,
    Parameter,
    ReferenceSeaState,
    TestDescription,
    TestErrors,
)
from calibration.results.result_folder import RESULT_FILE, draw, outdated, write_motion
from calibration.results.tests_dataset import motions_of_tests
from jaxhydro.dynamics.model import Model
from jaxhydro.files import staged
from jaxhydro.loads.sea_state_law import reference_of
from jaxhydro.platform.drag_laws import drag_laws_of
from jaxhydro.result_model import finite_or_null, stated
from jaxhydro.units import for_people, unit_of


class NotFinite(ValueError):
    """A result that is not finite, which no file can hold.

    The simulation of a fitted test grew beyond all bounds.
    """


def write_calibration(
    calibration: Calibration, folder: str | PathLike[str], figures: bool = True, truth: Mapping[str, float] | None = None
) -> Path:
    """Write all results of a calibration into a folder.

    The results of an earlier calibration there are replaced when the new ones are complete. Its report page is removed; other
    files stay. Angles are in degrees.

    Args:
        calibration: The calibration.
        folder: The folder, made where absent.
        figures: Whether figures are drawn.
        truth: Coefficients that a synthetic campaign was made with, by label. They are written for the report.

    Returns:
        The folder.

    Raises:
        NotFinite: A parameter or the objective of the fitted tests is not finite.
        InputError: The folder cannot be written.
    """
    folder = Path(folder)
    with staged(folder, lambda temporary: outdated(folder, temporary)) as temporary:
        drawn = []
        if figures:
            from calibration.plots import calibration_figures as plot

            drawn = draw(plot.figures(calibration), temporary)
        content = document(calibration).model_copy(update={**stated(truth=truth), "figures": drawn})
        content.write(temporary / RESULT_FILE)
        write_motion(motions_of_tests(calibration), temporary)
    return folder


def document(calibration: Calibration, damping: bool = True) -> CalibrationFile:
    """Content of calibration.json without figures.

    Args:
        calibration: The calibration.
        damping: Whether decays are analysed for linear and quadratic damping, which takes most of the time.

    Raises:
        NotFinite: A parameter or the objective of the fitted tests is not finite.
    """
    return CalibrationFile(
        campaign=calibration.campaign,
        platform=calibration.platform,
        jaxhydro=jaxhydro.__version__,
        baseline=fitted_model(calibration),
        tests={test.id: _about(test, damping) for test in calibration.tests},
    )


def fitted_model(calibration: Calibration) -> FittedModel:
    """Calibrated model as result files have it. Raises NotFinite."""
    # offsets and periods alone have no series
    fit = calibration.objective("fit") if any(test.use == "fit" for test in calibration.tests) else 0.0
    if fit is None or not math.isfinite(fit):
        raise NotFinite("the simulated motion of a fitted test is not finite")
    reference = reference_of(calibration.model.loads)
    return FittedModel(
        parameters={
            label: parameter(estimate, start=finite_or_null(estimate.start))
            for label, estimate in calibration.parameters.items()
        },
        error={test.id: _errors(test) for test in calibration.tests},
        objective=Objective(fit=fit, holdout=finite_or_null(calibration.objective("holdout"))),
        converged=bool(calibration.converged),
        iterations=int(calibration.iterations),
        seconds=finite_or_null(calibration.seconds),
        history=[finite_or_null(value) for value in calibration.history],
        notes=[str(note) for note in calibration.notes],
        notes_about=[kind_of(note) for note in calibration.notes],
        **stated(
            sea_state_reference=None if reference is None else ReferenceSeaState(**reference._asdict()),
            drag_laws=drag_laws(calibration.model),
        ),
    )


def parameter(estimate: Estimate, **more: Any) -> Parameter:
    """A calibrated parameter as result files have it, with more of its fields. Raises NotFinite."""
    if not math.isfinite(estimate.value):
        raise NotFinite(f"the parameter {estimate.label} is not finite")
    return Parameter(
        value=float(estimate.value),
        standard_deviation=finite_or_null(estimate.standard_deviation),
        unit=estimate.unit,
        at_bound=estimate.at_bound,
        identifiable=estimate.identifiable,
        meaning=estimate.meaning,
        **more,
    )


def drag_laws(model: Model) -> dict[str, dict[str, Any]]:
    """Drag laws other than plain drag, by coefficient, as a platform file has them."""
    return {label: law.model_dump(exclude_none=True) for label, law in drag_laws_of(model).items()}


def _errors(test: TestFit) -> TestErrors:
    """Errors of a test; what is not finite (a held-out test's motion that diverged) is left out."""
    channels: dict[str, Any] = {}
    for series in test.series:
        if math.isfinite(series.rmse) and math.isfinite(series.relative):
            error = _error(series.channel, series.rmse, series.relative).model_dump()
            channels[series.channel] = ChannelError(**error, in_objective=bool(series.scored), before=_before(test, series))
    return TestErrors(use=test.use, **channels, **stated(bands=_bands(test, "after")))


def _bands(test: TestFit, name: str) -> dict[str, dict[str, float]]:
    """Finite errors of energy of one model, `after` or `before`."""
    each = {
        channel: {band: value for band, error in row.items() if math.isfinite(value := float(getattr(error, name)))}
        for channel, row in test.bands.items()
    }
    return {channel: row for channel, row in each.items() if row}


def _error(channel: str, rmse: float, relative: float) -> MotionError:
    return MotionError(rmse=float(for_people(channel, rmse)), unit=unit_of(channel), relative=float(relative))


def _before(test: TestFit, series: Series) -> MotionError | None:
    start = test.start.get(series.channel)
    if start is None or not np.isfinite(start).all():
        return None
    rmse = float(np.sqrt(np.mean((series.measured - start) ** 2)))
    return _error(series.channel, rmse, rmse / max(float(np.std(series.measured)), 1e-300))


def _about(test: TestFit, damping: bool) -> TestDescription:
    return TestDescription(
        use=test.use,
        kind=test.kind,
        degree_of_freedom=test.degree_of_freedom,
        file=test.file,
        duration=float(test.time[-1] - test.time[0]),
        samples=len(test.time),
        **stated(
            bands_before=_bands(test, "before"),  # the contract's `error` has no place for it
            linear_quadratic=_linear_quadratic(test) if damping and test.kind == "decay" else None,
        ),
    )


def _linear_quadratic(test: TestFit) -> LinearQuadraticDamping | None:
    """Classical analysis of a decay, measured and simulated; None where it has too few cycles."""
    main = test.main
    try:
        measured, simulated = (classical(test.time, x, main.noise).fit for x in (main.measured, main.simulated))
        terms = {
            name: DampingTerm(
                measured=float(getattr(measured, name).value),
                half_width=0.5 * float(getattr(measured, name).upper - getattr(measured, name).lower),
                simulated=float(getattr(simulated, name).value),
            )
            for name in ("linear", "quadratic")
        }
    except ValueError:  # too few cycles, or a value that is not finite (pydantic's ValidationError is a ValueError)
        return None
    unit = "m" if unit_of(main.channel) == "m" else "rad"
    return LinearQuadraticDamping(period=measured.period, unit=unit, **terms)
