"""What other programs computed for a platform, read from the files that its platform file names and made into loads."""

from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro import platform_schema as schema
from jaxhydro.interop.capytaine import read_capytaine
from jaxhydro.interop.capytaine_waves import read_capytaine_excitation, read_capytaine_hydrostatics
from jaxhydro.interop.coefficients import RadiationCoefficients
from jaxhydro.interop.excitation import read_excitation
from jaxhydro.interop.hydrostatics import FileHydrostatics, read_hydrostatics
from jaxhydro.interop.quadratic_transfer import read_transfer
from jaxhydro.interop.wamit import read_wamit
from jaxhydro.loads import AbstractLoad, Buoyancy, ComputedExcitation, ComputedRadiation, DriftTransfer, HydrostaticCoupling
from jaxhydro.problems import InputError, Problem
from jaxhydro.remarks import Remark
from jaxhydro.retardation import Realisation, realise
from jaxhydro.rotations import rotation
from jaxhydro.table_checks import LongWaves, asymmetry, excitation_column, radiation_column, same_column

POOR = 0.25  # misfit from which on a state space is none of the coefficients
COUPLED = ("C34", "C35", "C45")
CLEARLY = 5.0  # times nearer, for a doubt about the weight
ASIDE = 1e-3  # of C44 and C55, from which C46 and C56 are worth a note


class Realised(NamedTuple):
    """A file's radiation: its coefficients, a state space for them, and what is to be known of it."""

    coefficients: RadiationCoefficients
    space: Realisation
    remarks: tuple[Remark, ...]


def radiation_of(declared: schema.Radiation, density: float) -> tuple[ComputedRadiation, Realised]:
    """The radiation that a platform file declares, and what it was made from.

    Raises:
        InputError: Where the file is wrong, or no state space of the declared order comes near its coefficients.
    """
    file = Path(declared.file)
    stamp = file.stat().st_mtime_ns if file.is_file() else 0
    found = _realised(declared, stamp, density)
    share, highest = float(declared.use == "load"), float(found.coefficients.omega[-1])
    space = found.space
    return ComputedRadiation.of(space.rates, space.drive, space.output, share, highest), found


@lru_cache(maxsize=8)
def _realised(declared: schema.Radiation, stamp: int, density: float) -> Realised:
    source, notes = declared.file, list[str]()
    if declared.kind == "wamit":
        assert not isinstance(declared.body, str)
        found = read_wamit(source, density, declared.length or 1.0, declared.by, declared.body)
    else:
        assert not isinstance(declared.body, int)
        found = read_capytaine(source, body=declared.body, density=density, notes=notes)
    try:
        space = realise(found, declared.tolerance, declared.order)
    except ValueError as error:
        expected = "radiation damping that takes energy, and that a state space can follow"
        raise InputError(source, [Problem("", expected, str(error), _column(declared))]) from None
    doubts = radiation_column(found, space, declared.by if declared.kind == "wamit" else None, source)
    if space.misfit > POOR:
        wrong = f"a misfit of {100 * space.misfit:.0f} % with {space.order}"
        hint = doubts[0].removeprefix(f"{source}: ") if doubts else _column(declared)
        raise InputError(source, [Problem("radiation.order", "enough states to follow the coefficients", wrong, hint)])
    doubts += asymmetry(found, source)
    return Realised(found, space, (*_warnings(doubts), *map(Remark, notes)))


def _column(declared: schema.Radiation) -> str:
    """A hint for a file that makes no sense: what its first column was taken to be."""
    return f"Its first column is read by {declared.by}: see `by`." if declared.kind == "wamit" else ""


def _warnings(texts: list[str]) -> tuple[Remark, ...]:
    return tuple(Remark(text, warning=True) for text in texts)


def excitation_of(declared: schema.Excitation, water: schema.Water) -> tuple[ComputedExcitation, tuple[Remark, ...]]:
    """The excitation that a platform file declares, and what is to be known of it. Raises InputError."""
    notes, doubts = list[str](), list[str]()
    if declared.kind == "wamit":
        assert not isinstance(declared.body, str)
        table = read_excitation(
            declared.file, water.density, water.gravity, length=declared.length or 1.0, heading=declared.heading,
            by=declared.by, body=declared.body, warnings=doubts,
        )  # fmt: skip
        if declared.body is not None:
            notes.append(f"{declared.file}: phases of body {declared.body} are those of waves at the file's own origin")
    else:
        assert not isinstance(declared.body, int)
        table = read_capytaine_excitation(
            declared.file, heading=declared.heading, body=declared.body, density=water.density, gravity=water.gravity,
            depth=water.depth, notes=notes,
        )  # fmt: skip
    load = ComputedExcitation.of(table, share=float(declared.use == "load"))
    return load, (*_warnings(doubts), *map(Remark, notes))


def drift_of(declared: schema.Drift, water: schema.Water) -> tuple[DriftTransfer, tuple[Remark, ...]]:
    """The slow drift that a platform file declares, and what is to be known of it. Raises InputError."""
    doubts: list[str] = []
    transfer = read_transfer(
        declared.file, water.density, water.gravity, length=declared.length, heading=declared.heading,
        newman=declared.approximation == "newman", by=declared.by, body=declared.body, warnings=doubts,
    )  # fmt: skip
    return DriftTransfer.of(transfer, share=float(declared.use == "load")), _warnings(doubts)


class StaticsOfFile(NamedTuple):
    """Hydrostatics with what their file says, its stiffness (N/m, N, N m/rad; None: no file), and what is to be known."""

    declared: schema.Hydrostatics
    stiffness: np.ndarray | None
    remarks: tuple[Remark, ...]


def hydrostatics_of(declared: schema.Hydrostatics, water: schema.Water) -> StaticsOfFile:
    """Fill hydrostatics with what their file has and the platform file does not say itself. Raises InputError."""
    if not declared.file:
        return StaticsOfFile(declared, None, ())
    notes: list[str] = []
    if declared.kind == "wamit":
        assert not isinstance(declared.body, str)
        found = read_hydrostatics(
            declared.file, water.density, water.gravity, length=declared.length or 1.0, body=declared.body
        )
    else:
        assert not isinstance(declared.body, int)
        found = read_capytaine_hydrostatics(
            declared.file, body=declared.body, density=water.density, gravity=water.gravity, notes=notes
        )
    values, said = _values(declared, found, water)
    if values.get("C33", 0.0) < 0:
        raise InputError(declared.file, [Problem("C33", "a stiffness >= 0", f"{values['C33']:.4g} N/m")])
    given = {key: value for key, value in values.items() if getattr(declared, key) is None}
    off = np.abs(found.stiffness[[3, 4], 5]).max()
    if off > ASIDE * np.abs(np.diag(found.stiffness)).max():
        notes.append(f"{declared.file}: C46 and C56 are left out: they follow from mass and buoyancy off the centreline")
    told = tuple(map(Remark, [*notes, *said]))
    return StaticsOfFile(declared.model_copy(update=given), found.stiffness, told)


def _values(
    declared: schema.Hydrostatics, found: FileHydrostatics, water: schema.Water
) -> tuple[dict[str, float], list[str]]:
    """Keys of `hydrostatics` and their values by a file, and notes."""
    values: dict[str, float] = {"C33": float(found.stiffness[2, 2])}
    if found.volume is not None:
        values["displaced_volume"] = found.volume
    own = {key: float(found.stiffness[i, i]) for key, i in (("C44", 3), ("C55", 4))}
    wanted = [key for key in own if getattr(declared, key) is None and getattr(declared, f"{key}_buoyancy") is None]
    if not wanted:
        return values, []
    many = " and ".join(wanted)
    if found.centre_of_mass is not None and found.volume is not None:
        # the file's own weight, that of the displaced water, is taken out, and the platform's takes its place
        weight = water.density * water.gravity * found.volume * found.centre_of_mass
        return values | {f"{key}_buoyancy": own[key] + weight for key in wanted}, []
    if declared.weight == "excluded":
        return values | {f"{key}_buoyancy": own[key] for key in wanted}, []
    said = (
        f"{declared.file}: {many} are taken to include the weight, as WAMIT and Capytaine define them; in files made for "
        "OpenFAST they may not: `weight: excluded`"
    )
    return values | {key: own[key] for key in wanted}, [] if declared.weight else [said]


def with_hydrostatics(
    platform: schema.Platform, members: Buoyancy
) -> tuple[schema.Platform, tuple[HydrostaticCoupling, ...], tuple[Remark, ...]]:
    """The platform with the hydrostatics of their file, couplings beyond those of its members, and what is to be known.

    Raises:
        InputError: Where the file is wrong.
    """
    water = platform.water
    statics = hydrostatics_of(platform.hydrostatics, water)
    if statics.stiffness is None:
        return platform, (), ()
    own = hydrostatic_stiffness(members, water.density * water.gravity)
    mass, centre, _ = platform.rigid_body.combined()
    doubts = weight_doubt(platform.hydrostatics, statics.stiffness, own, mass * water.gravity * float(centre[2]))
    filled = platform.model_copy(update={"hydrostatics": statics.declared})
    return filled, coupling_of(statics.stiffness, own), (*_warnings(doubts), *statics.remarks)


def hydrostatic_stiffness(load: Buoyancy, weight_density: float) -> np.ndarray:
    """Stiffness (N/m, N, N m/rad) of buoyancy about the upright platform, without the weight's share."""
    return -np.asarray(_slope(load, jnp.asarray(weight_density)))


@eqx.filter_jit
def _slope(load: Buoyancy, weight_density: Float[Array, ""]) -> Float[Array, "6 6"]:
    return jax.jacfwd(lambda q: load.force(q, rotation(q[3:]), weight_density))(jnp.zeros(6))


def weight_doubt(declared: schema.Hydrostatics, stiffness: np.ndarray, own: np.ndarray, weight: float) -> list[str]:
    """A warning where the members say that a .hst file has the weight, or has it not, against what was declared.

    Args:
        declared: As in the platform file.
        stiffness: Of the file, N m/rad.
        own: Of the members, without the weight.
        weight: m g z of the centre of mass, N m.
    """
    if Path(declared.file).suffix.lower() == ".out" or declared.kind != "wamit" or not own[3, 3]:
        return []
    missed = {"included": abs(stiffness[3, 3] + weight - own[3, 3]), "excluded": abs(stiffness[3, 3] - own[3, 3])}
    taken = declared.weight or "included"
    other = "excluded" if taken == "included" else "included"
    if missed[taken] < CLEARLY * missed[other] or missed[taken] < 0.05 * abs(own[3, 3]):
        return []
    return [f"{declared.file}: C44 {stiffness[3, 3]:.4g} N m/rad fits the members with the weight {other}, not {taken}: see "
            "`hydrostatics.weight`"]  # fmt: skip


def coupling_of(stiffness: np.ndarray, own: np.ndarray) -> tuple[HydrostaticCoupling, ...]:
    """The couplings of a file's stiffness beyond those that members have (`own`); none where there are none."""
    matrix = np.zeros((6, 6))
    for name in COUPLED:
        i, j = int(name[1]) - 1, int(name[2]) - 1
        matrix[i, j] = matrix[j, i] = stiffness[i, j] - own[i, j]
    size = np.sqrt(np.abs(np.diag(stiffness)))
    matrix[np.abs(matrix) <= 1e-9 * np.outer(size, size)] = 0.0
    return (HydrostaticCoupling(stiffness=jnp.asarray(matrix), values={}),) if matrix.any() else ()


def tables_of(platform: schema.Platform, buoyancy: Buoyancy) -> tuple[list[AbstractLoad], list[Remark]]:
    """Loads of the radiation, excitation and drift that a platform file names, and what is to be known of them.

    Args:
        platform: The platform.
        buoyancy: Its buoyancy, whose heave stiffness tells the force of long waves.

    Raises:
        InputError: Where a file is wrong.
    """
    water, loads, remarks = platform.water, list[AbstractLoad](), list[Remark]()
    radiated: Realised | None = None
    if platform.radiation is not None:
        radiation, radiated = radiation_of(platform.radiation, water.density)
        loads.append(radiation)
        remarks += radiated.remarks
    if platform.excitation is not None:
        excitation, said = excitation_of(platform.excitation, water)
        loads.append(excitation)
        doubts: list[str] = []
        if (declared := platform.excitation).kind == "wamit":
            table = excitation.excitation
            heave = hydrostatic_stiffness(buoyancy, water.density * water.gravity)[2, 2]
            hull = LongWaves(float(heave), platform.rigid_body.combined()[0], water.depth, water.gravity)
            doubts += excitation_column(np.asarray(table.omega), np.asarray(table.force), declared.by, declared.file, hull)
            other = platform.radiation
            if radiated is not None and other is not None and other.kind == "wamit" and same_column(
                radiated.coefficients.omega, other.by, np.asarray(table.omega), declared.by
            ):
                files = f"{declared.file} and {other.file}"
                doubts.append(f"{files} have the same first column, and are read by {declared.by} and by {other.by}: see `by`")
        remarks += [*_warnings(doubts), *said]
    if platform.drift is not None:
        drift, said = drift_of(platform.drift, water)
        loads.append(drift)
        remarks += said
    return loads, remarks
