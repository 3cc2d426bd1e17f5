"""Radiation, excitation and drift loads from other programs' files."""

from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.capytaine_radiation import read_capytaine
from jaxhydro.interop.capytaine_waves import read_capytaine_directions, read_capytaine_excitation
from jaxhydro.interop.damping_that_takes_energy import taking_energy
from jaxhydro.interop.nemoh_tables import read_nemoh_directions, read_nemoh_excitation, read_nemoh_radiation
from jaxhydro.interop.radiation_coefficients import RadiationCoefficients
from jaxhydro.interop.retardation import Realisation, realise
from jaxhydro.interop.wamit_drift import read_directional_transfer, read_transfer
from jaxhydro.interop.wamit_excitation import read_directional_excitation, read_excitation
from jaxhydro.interop.wamit_radiation import read_wamit
from jaxhydro.loads import AbstractLoad, Buoyancy, ComputedAddedMass, ComputedExcitation, ComputedRadiation, DriftTransfer
from jaxhydro.loads.slow_displacement import CORNER
from jaxhydro.platform import schema as schema
from jaxhydro.platform.computed_hydrostatics import hydrostatic_stiffness
from jaxhydro.platform.computed_tables_schema import Drift, Excitation, Radiation
from jaxhydro.platform.table_checks import (
    Column,
    LongWaves,
    asymmetry,
    drift_column,
    excitation_column,
    radiation_column,
    same_columns,
)
from jaxhydro.remarks import Remark, as_warnings
from jaxhydro.scales import pace_of, size_of
from jaxhydro.waves.directional_transfer import AnyTransfer
from jaxhydro.waves.excitation import AnyExcitation

MAX_MISFIT = 0.25  # misfit from which on a state space is none of the coefficients


class RealisedRadiation(NamedTuple):
    """Radiation of a file: its coefficients, a state space for them, and remarks."""

    coefficients: RadiationCoefficients
    space: Realisation
    remarks: tuple[Remark, ...]


def radiation_of(radiation: Radiation, density: float) -> tuple[ComputedRadiation, RealisedRadiation]:
    """Radiation load of a platform file, with its coefficients and state space.

    Raises:
        InputError: The file is wrong, or no state space of the declared order comes near its coefficients.
    """
    file = Path(radiation.file)
    stamp = file.stat().st_mtime_ns if file.is_file() else 0
    realised = _realised(radiation, stamp, density)
    share, highest = float(radiation.use == "load"), float(realised.coefficients.omega[-1])
    space = realised.space
    rates, drive, output = map(jnp.asarray, (space.rates, space.drive, space.output))
    return ComputedRadiation(rates, drive, output, jnp.asarray(share), highest), realised


def added_mass_of(radiation: Radiation, coefficients: RadiationCoefficients) -> ComputedAddedMass | None:
    """Added mass of a file at infinite frequency, or None where nothing takes it.

    The platform file takes it, or `diagnose` may.

    Raises:
        InputError: It is to be taken, and the file lacks it.
    """
    taken = radiation.use == "load" and radiation.added_mass == "file"
    if coefficients.infinite is None and radiation.added_mass == "file":
        expected = "a file with added mass at infinite frequency (in WAMIT's .1 the rows with PER = 0)"
        raise InputError(radiation.file, [Problem("radiation.added_mass", expected, "none in it")])
    if coefficients.infinite is None or not (taken or radiation.use == "candidate"):
        return None
    symmetric = 0.5 * (coefficients.infinite + coefficients.infinite.T)
    return ComputedAddedMass(jnp.asarray(symmetric), jnp.asarray(float(taken)))


@lru_cache(maxsize=8)
def _realised(radiation: Radiation, stamp: int, density: float) -> RealisedRadiation:
    source, notes = radiation.file, list[str]()
    if radiation.kind == "wamit":
        assert not isinstance(radiation.body, str)
        coefficients = read_wamit(source, density, radiation.length or 1.0, radiation.by, radiation.body)
    elif radiation.kind == "nemoh":
        assert not isinstance(radiation.body, str)
        coefficients = read_nemoh_radiation(source, body=radiation.body, density=density, notes=notes)
    else:
        assert not isinstance(radiation.body, int)
        coefficients = read_capytaine(source, body=radiation.body, density=density, notes=notes)
    coefficients, change = taking_energy(coefficients)
    if change:
        text = f"an entry is changed by up to {change:.0%} of the two motions' own"
        notes.append(f"{source}: damping gives energy at some frequencies. It is taken without that: {text}")
    try:
        space = realise(coefficients, radiation.tolerance, radiation.order)
    except ValueError as error:
        expected = "radiation damping that takes energy, and that a state space can follow"
        raise InputError(source, [Problem("", expected, str(error), _column(radiation))]) from None
    doubts = radiation_column(coefficients, space, radiation.by if radiation.kind == "wamit" else None, source)
    if space.misfit > MAX_MISFIT:
        wrong = f"a misfit of {100 * space.misfit:.0f} % with {space.order}"
        hint = doubts[0].removeprefix(f"{source}: ") if doubts else _column(radiation)
        raise InputError(source, [Problem("radiation.order", "enough states to follow the coefficients", wrong, hint)])
    doubts += asymmetry(coefficients, source)
    return RealisedRadiation(coefficients, space, (*as_warnings(doubts), *map(Remark, notes)))


def _column(radiation: Radiation) -> str:
    """Hint for a file that makes no sense: the quantity of its first column, as stated."""
    return f"Its first column is read by {radiation.by}: see `by`." if radiation.kind == "wamit" else ""


def excitation_of(
    excitation: Excitation, water: schema.Water, corner: float = CORNER
) -> tuple[ComputedExcitation, tuple[Remark, ...]]:
    """Excitation load of a platform file, and remarks.

    Args:
        excitation: The key `excitation`.
        water: The key `water`.
        corner: Corner frequency (rad/s) of the load's filter.

    Raises:
        InputError: The file is wrong.
    """
    notes, doubts = list[str](), list[str]()
    if excitation.kind == "wamit":
        assert not isinstance(excitation.body, str)
        wamit: Any = {"length": excitation.length or 1.0, "by": excitation.by, "body": excitation.body, "warnings": doubts}
        fluid = (excitation.file, water.density, water.gravity)
        if excitation.heading is None:
            table: AnyExcitation = _simplest(read_directional_excitation(*fluid, **wamit))
        else:
            table = read_excitation(*fluid, heading=excitation.heading, **wamit)
        if excitation.body is not None:
            notes.append(f"{excitation.file}: phases of body {excitation.body} are those of waves at the file's own origin")
    elif excitation.kind == "nemoh":
        assert not isinstance(excitation.body, str)
        options: Any = {"body": excitation.body, "density": water.density, "gravity": water.gravity, "depth": water.depth}
        if excitation.heading is None:
            table = _simplest(read_nemoh_directions(excitation.file, notes=notes, **options))
        else:
            table = read_nemoh_excitation(excitation.file, heading=excitation.heading, notes=notes, **options)
    else:
        assert not isinstance(excitation.body, int)
        options = {"body": excitation.body, "density": water.density, "gravity": water.gravity, "depth": water.depth}
        if excitation.heading is None:
            table = _simplest(read_capytaine_directions(excitation.file, notes=notes, **options))
        else:
            table = read_capytaine_excitation(excitation.file, heading=excitation.heading, notes=notes, **options)
    load = ComputedExcitation(table, share=jnp.asarray(float(excitation.use == "load")), corner=float(corner))
    return load, (*as_warnings(doubts), *map(Remark, notes))


def drift_of(drift: Drift, water: schema.Water) -> tuple[DriftTransfer, tuple[Remark, ...]]:
    """Drift load of a platform file, and remarks.

    Raises:
        InputError: The file is wrong.
    """
    doubts: list[str] = []
    how: Any = {"length": drift.length, "newman": drift.approximation == "newman", "by": drift.by}
    how |= {"body": drift.body, "warnings": doubts}
    fluid = (drift.file, water.density, water.gravity)
    if drift.heading is None:
        transfer: AnyTransfer = _simplest(read_directional_transfer(*fluid, **how))
    else:
        transfer = read_transfer(*fluid, heading=drift.heading, **how)
    return DriftTransfer(transfer, share=jnp.asarray(float(drift.use == "load"))), as_warnings(doubts)


def _simplest(table: Any) -> Any:
    """A table over headings; that of its one heading where it has no other."""
    knots = table.by_heading.heading
    return table.towards(float(knots[0])) if knots.size == 1 else table


def _one_heading(table: Any) -> Any:
    """A table at one of its headings: 0 where it has that, else its first."""
    by_heading = getattr(table, "by_heading", None)
    return table.towards(0.0 if by_heading is None or by_heading.covers(0.0) else float(by_heading.heading[0]))


def tables_of(platform: schema.Platform, buoyancy: Buoyancy) -> tuple[list[AbstractLoad], list[Remark]]:
    """Radiation, excitation and drift loads that a platform file names, and remarks.

    Args:
        platform: The platform.
        buoyancy: Its buoyancy, whose heave stiffness tells the force of long waves.

    Raises:
        InputError: Where a file is wrong.
    """
    water, loads, remarks = platform.water, list[AbstractLoad](), list[Remark]()
    columns: list[Column] = []
    if (radiates := platform.radiation) is not None:
        radiation, realised = radiation_of(radiates, water.density)
        loads.append(radiation)
        if (added := added_mass_of(radiates, realised.coefficients)) is not None:
            loads.append(added)
        remarks += realised.remarks
        if radiates.kind == "wamit":
            columns.append(Column(radiates.file, realised.coefficients.omega, radiates.by))
    if (excites := platform.excitation) is not None:
        mass = platform.rigid_body.combined()[0]
        excitation, notes = excitation_of(excites, water, CORNER / pace_of(size_of(mass, water.density), water.gravity))
        loads.append(excitation)
        remarks += notes
        if excites.kind == "wamit":
            of_one = _one_heading(excitation.excitation)
            omega, force = np.asarray(of_one.omega), np.asarray(of_one.force)
            heave = hydrostatic_stiffness(buoyancy, water.density * water.gravity)[2, 2]
            hull = LongWaves(float(heave), mass, water.depth, water.gravity)
            remarks += as_warnings(excitation_column(omega, force, excites.by, excites.file, hull))
            columns.append(Column(excites.file, omega, excites.by))
    if (drifts := platform.drift) is not None:
        drift, notes = drift_of(drifts, water)
        loads.append(drift)
        table = _one_heading(drift.transfer)
        of_regular_waves = np.einsum("im,imk->ik", np.asarray(table.eigenvalue), np.abs(np.asarray(table.filters)) ** 2)
        remarks += [*notes, *as_warnings(drift_column(np.hypot(*of_regular_waves[:2]), drifts.by, drifts.file))]
        columns.append(Column(drifts.file, np.asarray(table.omega), drifts.by))
    return loads, [*remarks, *as_warnings(same_columns(columns))]
