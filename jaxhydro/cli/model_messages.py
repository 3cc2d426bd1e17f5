"""Printed messages on a model: remarks, calibrated values, equilibrium and natural periods."""

from collections.abc import Collection, Iterable
from pathlib import Path

import numpy as np

from jaxhydro.calibrated_model import UsedCalibration, with_calibration
from jaxhydro.cli.console import complain, say, table
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.natural_modes import Modes
from jaxhydro.dynamics.rest_remarks import rest_remarks, restoring_remarks
from jaxhydro.dynamics.statics import equilibrium, stable_modes
from jaxhydro.environment import DOFS
from jaxhydro.remarks import Remark
from jaxhydro.units import for_people, unit_of


def calibrated(model: Model, asked: str, name: str, source: Path) -> Model:
    """Model with the values, laws and effects of a calibration.json or diagnosis.json.

    Remarks on them are printed.

    Args:
        model: The model.
        asked: The platform as it was asked for.
        name: The platform's own name.
        source: The calibration's file or folder.

    Raises:
        InputError: The calibration cannot be used.
    """
    model, used = with_calibration(model, asked, name, source)
    print_used(used)
    return model


def print_used(used: UsedCalibration) -> None:
    """Print the labels of the calibrated values that are used, and remarks on them."""
    counted = ""
    if used.reference is not None:
        hs, tp = used.reference
        counted = f"; exponents count from Hs {hs:.3g} m, Tp {tp:.3g} s"
    say(f"Calibrated values used: {', '.join(used.values)}{counted}")
    if of_sensors := sorted({label.split(".")[0] for label in used.values if label.startswith("sensor_")}):
        say(f"{' and '.join(of_sensors)}: of that campaign's sensors; the motions here are those of the reference point")
    if used.strips is not None:
        say(f"Strips as they were when these were found: {used.strips}")
    for warning in used.warnings:
        complain(f"warning: {warning}")


def print_remarks(remarks: Iterable[Remark]) -> None:
    """Print remarks on what was read, warnings first."""
    remarks = list(remarks)
    for remark in remarks:
        if remark.warning:
            complain(f"warning: {remark.text}")
    for remark in remarks:
        if not remark.warning:
            say(f"Note: {remark.text}")


def print_position(title: str, position: np.ndarray) -> None:
    """Print a position (m, rad; 6), angles in degrees."""
    shown = [(dof, float(np.round(for_people(dof, q), 4)) + 0.0) for dof, q in zip(DOFS, position)]  # no -0.0000
    table(title, ("Motion", "Position"), [(f"{dof} ({unit_of(dof)})", f"{value:.4f}") for dof, value in shown])


def print_rest(model: Model, platform: str, moved: Collection[str] = DOFS) -> Modes:
    """Print where the platform rests, and its natural periods, which are returned.

    Raises EquilibriumError where it does not stay there once it is `moved`.
    """
    at_rest, modes = equilibrium(model), stable_modes(model, moved)
    print_remarks([*rest_remarks(model, at_rest), *restoring_remarks(model, at_rest)])
    if modes.unstable:
        complain(f"warning: the platform is unstable in {' and '.join(modes.unstable)}, which nothing moves here")
    print_position(f"{platform}: at rest", np.asarray(at_rest))
    rows = []
    for period, shape in zip(modes.period, modes.shape):
        shares = sorted(((abs(share), dof) for share, dof in zip(shape, DOFS) if abs(share) > 0.2), reverse=True)
        rows.append((" and ".join(dof for _, dof in shares), f"{period:.2f} s"))
    table("Natural periods, undamped", ("Mode", "Period"), rows)
    return modes
