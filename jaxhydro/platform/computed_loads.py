"""Radiation, excitation and drift loads from other programs' files."""

from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.capytaine_radiation import read_capytaine
from jaxhydro.interop.capytaine_waves import read_capytaine_directions, read_capytaine_excitation
from jaxhydro.interop.nemoh_tables import read_nemoh_directions, read_nemoh_excitation, read_nemoh_radiation
from jaxhydro.interop.radiation_coefficients import RadiationCoefficients
from jaxhydro.interop.retardation import Realisation, realise
from jaxhydro.interop.wamit_drift import read_directional_transfer, read_transfer
from jaxhydro.interop.wamit_excitation import read_directional_excitation, read_excitation
from jaxhydro.interop.wamit_radiation import read_wamit
from jaxhydro.loads import AbstractLoad, Buoyancy, ComputedAddedMass, ComputedExcitation, ComputedRadiation, DriftTransfer
from jaxhydro.loads.computed_excitation import CORNER
from jaxhydro.platform import schema as schema
from jaxhydro.platform.computed_hydrostatics import hydrostatic_stiffness
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


def radiation_of(declared: schema.Radiation, density: float) -> tuple[ComputedRadiation, RealisedRadiation]:
    """Radiation load that a platform file declares, and what it was made from.

    Raises:
        InputError: The file is wrong, or no state space of the declared order comes near its coefficients.
    """
    file = Path(declared.file)
    stamp = file.stat().st_mtime_ns if file.is_file() else 0
    found = _realised(declared, stamp, density)
    share, highest = float(declared.use == "load"), float(found.coefficients.omega[-1])
    space = found.space
    rates, drive, output = map(jnp.asarray, (space.rates, space.drive, space.output))
    return ComputedRadiation(rates, drive, output, jnp.asarray(share), highest), found


def added_mass_of(declared: schema.Radiation, found: RadiationCoefficients) -> ComputedAddedMass | None:
    """Added mass of a file at infinite frequency, where the platform file takes it or `diagnose` may; else None.

    Raises:
        InputError: It is to be taken, and the file lacks it.
    """
    taken = declared.use == "load" and declared.added_mass == "file"
    if found.infinite is None and declared.added_mass == "file":
        expected = "a file with added mass at infinite frequency (in WAMIT's .1 the rows with PER = 0)"
        raise InputError(declared.file, [Problem("radiation.added_mass", expected, "none in it")])
    if found.infinite is None or not (taken or declared.use == "candidate"):
        return None
    symmetric = 0.5 * (found.infinite + found.infinite.T)
    return ComputedAddedMass(jnp.asarray(symmetric), jnp.asarray(float(taken)))


@lru_cache(maxsize=8)
def _realised(declared: schema.Radiation, stamp: int, density: float) -> RealisedRadiation:
    source, notes = declared.file, list[str]()
    if declared.kind == "wamit":
        assert not isinstance(declared.body, str)
        found = read_wamit(source, density, declared.length or 1.0, declared.by, declared.body)
    elif declared.kind == "nemoh":
        assert not isinstance(declared.body, str)
        found = read_nemoh_radiation(source, body=declared.body, density=density, notes=notes)
    else:
        assert not isinstance(declared.body, int)
        found = read_capytaine(source, body=declared.body, density=density, notes=notes)
    try:
        space = realise(found, declared.tolerance, declared.order)
    except ValueError as error:
        expected = "radiation damping that takes energy, and that a state space can follow"
        raise InputError(source, [Problem("", expected, str(error), _column(declared))]) from None
    doubts = radiation_column(found, space, declared.by if declared.kind == "wamit" else None, source)
    if space.misfit > MAX_MISFIT:
        wrong = f"a misfit of {100 * space.misfit:.0f} % with {space.order}"
        hint = doubts[0].removeprefix(f"{source}: ") if doubts else _column(declared)
        raise InputError(source, [Problem("radiation.order", "enough states to follow the coefficients", wrong, hint)])
    doubts += asymmetry(found, source)
    return RealisedRadiation(found, space, (*as_warnings(doubts), *map(Remark, notes)))


def _column(declared: schema.Radiation) -> str:
    """A hint for a file that makes no sense: what its first column was taken to be."""
    return f"Its first column is read by {declared.by}: see `by`." if declared.kind == "wamit" else ""


def excitation_of(
    declared: schema.Excitation, water: schema.Water, corner: float = CORNER
) -> tuple[ComputedExcitation, tuple[Remark, ...]]:
    """Excitation load that a platform file declares, and remarks.

    Args:
        declared: The key `excitation`.
        water: The key `water`.
        corner: Corner frequency (rad/s) of the load's filter.

    Raises:
        InputError: The file is wrong.
    """
    notes, doubts = list[str](), list[str]()
    if declared.kind == "wamit":
        assert not isinstance(declared.body, str)
        wamit: Any = {"length": declared.length or 1.0, "by": declared.by, "body": declared.body, "warnings": doubts}
        fluid = (declared.file, water.density, water.gravity)
        if declared.heading is None:
            table: AnyExcitation = _simplest(read_directional_excitation(*fluid, **wamit))
        else:
            table = read_excitation(*fluid, heading=declared.heading, **wamit)
        if declared.body is not None:
            notes.append(f"{declared.file}: phases of body {declared.body} are those of waves at the file's own origin")
    elif declared.kind == "nemoh":
        assert not isinstance(declared.body, str)
        own: Any = {"body": declared.body, "density": water.density, "gravity": water.gravity, "depth": water.depth}
        if declared.heading is None:
            table = _simplest(read_nemoh_directions(declared.file, notes=notes, **own))
        else:
            table = read_nemoh_excitation(declared.file, heading=declared.heading, notes=notes, **own)
    else:
        assert not isinstance(declared.body, int)
        own = {"body": declared.body, "density": water.density, "gravity": water.gravity, "depth": water.depth}
        if declared.heading is None:
            table = _simplest(read_capytaine_directions(declared.file, notes=notes, **own))
        else:
            table = read_capytaine_excitation(declared.file, heading=declared.heading, notes=notes, **own)
    load = ComputedExcitation(table, share=jnp.asarray(float(declared.use == "load")), corner=float(corner))
    return load, (*as_warnings(doubts), *map(Remark, notes))


def drift_of(declared: schema.Drift, water: schema.Water) -> tuple[DriftTransfer, tuple[Remark, ...]]:
    """Drift load that a platform file declares, and remarks.

    Raises:
        InputError: The file is wrong.
    """
    doubts: list[str] = []
    how: Any = {"length": declared.length, "newman": declared.approximation == "newman", "by": declared.by}
    how |= {"body": declared.body, "warnings": doubts}
    fluid = (declared.file, water.density, water.gravity)
    if declared.heading is None:
        transfer: AnyTransfer = _simplest(read_directional_transfer(*fluid, **how))
    else:
        transfer = read_transfer(*fluid, heading=declared.heading, **how)
    return DriftTransfer(transfer, share=jnp.asarray(float(declared.use == "load"))), as_warnings(doubts)


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
        excitation, said = excitation_of(excites, water, CORNER / pace_of(size_of(mass, water.density), water.gravity))
        loads.append(excitation)
        remarks += said
        if excites.kind == "wamit":
            of_one = _one_heading(excitation.excitation)
            omega, force = np.asarray(of_one.omega), np.asarray(of_one.force)
            heave = hydrostatic_stiffness(buoyancy, water.density * water.gravity)[2, 2]
            hull = LongWaves(float(heave), mass, water.depth, water.gravity)
            remarks += as_warnings(excitation_column(omega, force, excites.by, excites.file, hull))
            columns.append(Column(excites.file, omega, excites.by))
    if (drifts := platform.drift) is not None:
        drift, said = drift_of(drifts, water)
        loads.append(drift)
        table = _one_heading(drift.transfer)
        of_regular_waves = np.einsum("im,imk->ik", np.asarray(table.eigenvalue), np.abs(np.asarray(table.filters)) ** 2)
        remarks += [*said, *as_warnings(drift_column(np.hypot(*of_regular_waves[:2]), drifts.by, drifts.file))]
        columns.append(Column(drifts.file, np.asarray(table.omega), drifts.by))
    return loads, [*remarks, *as_warnings(same_columns(columns))]
