"""Hydrostatics of other programs, from the file that a platform file names."""

from pathlib import Path
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.capytaine_waves import read_capytaine_hydrostatics
from jaxhydro.interop.nemoh_hydrostatics import read_nemoh_hydrostatics
from jaxhydro.interop.wamit_hydrostatics import FileHydrostatics, read_hydrostatics
from jaxhydro.loads import Buoyancy, HydrostaticCoupling
from jaxhydro.platform import schema as schema
from jaxhydro.platform.computed_tables_schema import Hydrostatics
from jaxhydro.quick_jit import quick_jit
from jaxhydro.remarks import Remark, as_warnings
from jaxhydro.rotations import rotation

COUPLED = ("C34", "C35", "C45")
CLEAR_RATIO = 5.0  # times nearer, for a doubt about the weight
MIN_NOTED_STIFFNESS = 1e-3  # of C44 and C55, from which C46 and C56 are worth a note


class FileStatics(NamedTuple):
    """Hydrostatics with the values of their file, its stiffness (N/m, N, N m/rad), and remarks.

    The stiffness is None without a file.
    """

    hydrostatics: Hydrostatics
    stiffness: np.ndarray | None
    remarks: tuple[Remark, ...]


def hydrostatics_of(hydrostatics: Hydrostatics, water: schema.Water) -> FileStatics:
    """Hydrostatics completed by the values of their file.

    Raises:
        InputError: The file is wrong.
    """
    if not hydrostatics.file:
        return FileStatics(hydrostatics, None, ())
    notes: list[str] = []
    if hydrostatics.kind == "wamit":
        assert not isinstance(hydrostatics.body, str)
        contents = read_hydrostatics(
            hydrostatics.file, water.density, water.gravity, length=hydrostatics.length or 1.0, body=hydrostatics.body
        )
    elif hydrostatics.kind == "nemoh":
        contents = read_nemoh_hydrostatics(hydrostatics.file, density=water.density, gravity=water.gravity, notes=notes)
    else:
        assert not isinstance(hydrostatics.body, int)
        contents = read_capytaine_hydrostatics(
            hydrostatics.file, body=hydrostatics.body, density=water.density, gravity=water.gravity, notes=notes
        )
    values, messages = _values(hydrostatics, contents, water)
    if values.get("C33", 0.0) < 0:
        raise InputError(hydrostatics.file, [Problem("C33", "a stiffness >= 0", f"{values['C33']:.4g} N/m")])
    filled = {key: value for key, value in values.items() if getattr(hydrostatics, key) is None}
    off = np.abs(contents.stiffness[[3, 4], 5]).max()
    if off > MIN_NOTED_STIFFNESS * np.abs(np.diag(contents.stiffness)).max():
        notes.append(f"{hydrostatics.file}: C46 and C56 are left out: they follow from mass and buoyancy off the centreline")
    told = tuple(map(Remark, [*notes, *messages]))
    return FileStatics(hydrostatics.model_copy(update=filled), contents.stiffness, told)


def _values(hydrostatics: Hydrostatics, contents: FileHydrostatics, water: schema.Water) -> tuple[dict[str, float], list[str]]:
    """Keys of `hydrostatics` and their values by a file, and notes."""
    values: dict[str, float] = {"C33": float(contents.stiffness[2, 2])}
    if contents.volume is not None:
        values["displaced_volume"] = contents.volume
    stiffness = {key: float(contents.stiffness[i, i]) for key, i in (("C44", 3), ("C55", 4))}
    wanted = [
        key for key in stiffness if getattr(hydrostatics, key) is None and getattr(hydrostatics, f"{key}_buoyancy") is None
    ]
    if not wanted:
        return values, []
    many = " and ".join(wanted)
    if contents.centre_of_mass is not None and contents.volume is not None:
        # the file's own weight, that of the displaced water, is taken out, and the platform's takes its place
        weight = water.density * water.gravity * contents.volume * contents.centre_of_mass
        return values | {f"{key}_buoyancy": stiffness[key] + weight for key in wanted}, []
    if hydrostatics.weight == "excluded":
        return values | {f"{key}_buoyancy": stiffness[key] for key in wanted}, []
    message = (
        f"{hydrostatics.file}: {many} are taken to include the weight, as WAMIT and Capytaine define them. In files made for "
        "OpenFAST they may not: `weight: excluded`"
    )
    return values | {key: stiffness[key] for key in wanted}, [] if hydrostatics.weight else [message]


def with_hydrostatics(
    platform: schema.Platform, members: Buoyancy
) -> tuple[schema.Platform, tuple[HydrostaticCoupling, ...], tuple[Remark, ...]]:
    """Platform with the hydrostatics of their file, its couplings beyond the members', and remarks.

    Raises:
        InputError: Where the file is wrong.
    """
    water = platform.water
    statics = hydrostatics_of(platform.hydrostatics, water)
    if statics.stiffness is None:
        return platform, (), ()
    of_members = hydrostatic_stiffness(members, water.density * water.gravity)
    mass, centre, _ = platform.rigid_body.combined()
    doubts = weight_doubt(platform.hydrostatics, statics.stiffness, of_members, mass * water.gravity * float(centre[2]))
    filled = platform.model_copy(update={"hydrostatics": statics.hydrostatics})
    return filled, coupling_of(statics.stiffness, of_members), (*as_warnings(doubts), *statics.remarks)


def hydrostatic_stiffness(load: Buoyancy, weight_density: float) -> np.ndarray:
    """Buoyancy stiffness (N/m, N, N m/rad) about the upright platform, without the weight's part."""
    return -np.asarray(_slope(load, jnp.asarray(weight_density)))


@quick_jit
def _slope(load: Buoyancy, weight_density: Float[Array, ""]) -> Float[Array, "6 6"]:
    return jax.jacfwd(lambda q: load.force(q, rotation(q[3:]), weight_density))(jnp.zeros(6))


def weight_doubt(hydrostatics: Hydrostatics, stiffness: np.ndarray, of_members: np.ndarray, weight: float) -> list[str]:
    """Warning where a .hst file seems to include the weight, or not, against the declaration.

    Args:
        hydrostatics: As in the platform file.
        stiffness: Of the file, N m/rad.
        of_members: Of the members, without the weight.
        weight: m g z of the centre of mass, N m.
    """
    if Path(hydrostatics.file).suffix.lower() == ".out" or hydrostatics.kind != "wamit" or not of_members[3, 3]:
        return []
    missed = {"included": abs(stiffness[3, 3] + weight - of_members[3, 3]), "excluded": abs(stiffness[3, 3] - of_members[3, 3])}
    taken = hydrostatics.weight or "included"
    opposite = "excluded" if taken == "included" else "included"
    if missed[taken] < CLEAR_RATIO * missed[opposite] or missed[taken] < 0.05 * abs(of_members[3, 3]):
        return []
    return [
        f"{hydrostatics.file}: C44 {stiffness[3, 3]:.4g} N m/rad fits the members with the weight {opposite}, not {taken}: see "
        "`hydrostatics.weight`"
    ]


def coupling_of(stiffness: np.ndarray, of_members: np.ndarray) -> tuple[HydrostaticCoupling, ...]:
    """Load of a file's stiffness couplings beyond those of the members (`of_members`), if any."""
    matrix = np.zeros((6, 6))
    for name in COUPLED:
        i, j = int(name[1]) - 1, int(name[2]) - 1
        matrix[i, j] = matrix[j, i] = stiffness[i, j] - of_members[i, j]
    size = np.sqrt(np.abs(np.diag(stiffness)))
    matrix[np.abs(matrix) <= 1e-9 * np.outer(size, size)] = 0.0
    return (HydrostaticCoupling(stiffness=jnp.asarray(matrix)),) if matrix.any() else ()
