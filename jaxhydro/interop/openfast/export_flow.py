"""Tables of potential flow beside HydroDyn's file: hydrostatics, radiation, excitation and drift.

The table of radiation has the added mass, too. HydroDyn opens `.hst`, `.1` and `.3` in any case. A table that the platform
has not is written as zeros.

References:
    OpenFAST v5.0.0 (2895884), WAMIT.f90, WAMIT_Init (files, PER <= 0, F_HS_Moment_Offset, SttcDim, RdtnDim), and HydroDyn
    modelling considerations (`.hst` without the weight). Dimensions: docs/conventions.md, Files with ULEN.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.statics import linearised
from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.export_source import ExportSource
from jaxhydro.interop.openfast.export_pieces import all_at_surface
from jaxhydro.interop.openfast.export_text import digits, row
from jaxhydro.interop.openfast.table_row import to_number
from jaxhydro.loads import (
    AddedMass,
    Buoyancy,
    ComputedAddedMass,
    ComputedExcitation,
    ComputedRadiation,
    DriftTransfer,
    EndInertia,
    HydrostaticCoupling,
    StripInertia,
)
from jaxhydro.loads.matrix import assemble
from jaxhydro.rotations import rotation

ROOT = "potential"
PERIODS = (5.0, 10.0)  # s, of tables of zeros
RESTORING = slice(2, 5)  # heave, roll, pitch
OF_TABLES = {"radiation": ComputedRadiation, "excitation": ComputedExcitation, "drift": DriftTransfer}


@dataclass
class ExportedFlow:
    """HydroDyn's keys of potential flow, and its tables.

    Attributes:
        volume: PtfmVol0, m3; 0 where HydroDyn computes the buoyancy of members.
        centre: PtfmCOBxt and PtfmCOByt, m.
        length: WAMITULEN, m.
        excitation: ExctnMod.
        radiation: RdtnMod.
        full: DiffQTF.
        newman: NewmanApp.
        root: PotFile.
        texts: Text of each table by its name.
        files: Tables to copy.
        items: What became of the platform's keys.
    """

    volume: str = "0.0"
    centre: tuple[str, str] = ("0.0", "0.0")
    length: float = 1.0
    excitation: int = 0
    radiation: int = 0
    full: int = 0
    newman: int = 0
    root: str = ROOT
    texts: dict[str, str] = field(default_factory=dict)
    files: dict[str, Path] = field(default_factory=dict)
    items: list[ConvertedItem] = field(default_factory=list)

    @property
    def buoyant(self) -> bool:
        """Whether HydroDyn computes the buoyancy of members."""
        return float(self.volume) == 0.0

    def say(self, key: str, treatment: Treatment, meaning: str) -> None:
        """Add an item."""
        self.items.append(ConvertedItem(key, treatment, meaning))


def exported_flow(source: ExportSource) -> ExportedFlow:
    """HydroDyn's potential flow for a platform.

    Args:
        source: The platform.

    Raises:
        InputError: A table cannot be read.
    """
    flow, model = ExportedFlow(), source.model
    tables = _usable(source, flow)
    flow.length = next(iter(tables.values())).length if tables else 1.0
    if "excitation" in tables:
        flow.excitation, flow.files[f"{ROOT}.3"] = 1, tables["excitation"].path
        flow.say(
            "excitation", Treatment.TAKEN, f"ExctnMod = 1 with {ROOT}.3, a copy. Members keep their drag alone (PropPot TRUE)."
        )
    if "drift" in tables:
        name = "NewmanApp" if tables["drift"].approximation == "newman" else "DiffQTF"
        flow.newman, flow.full = (12, 0) if name == "NewmanApp" else (0, 12)
        flow.files[f"{ROOT}.12d"] = tables["drift"].path
        how = Treatment.APPROXIMATED if flow.newman else Treatment.TAKEN
        more = " HydroDyn has Standing's variant; here it is the mean of T_kk and T_ll." if flow.newman else ""
        flow.say("drift", how, f"{name} = 12 with {ROOT}.12d, a copy.{more}")
    _hydrostatics(model, flow)
    rows = _rows(tables["radiation"].path) if "radiation" in tables else []
    if rows:
        flow.radiation = 1
        flow.say("radiation", Treatment.TAKEN, f"RdtnMod = 1 with {ROOT}.1: the rows of its damping. HydroDyn convolves it.")
    others = _rows(tables["excitation"].path) if "excitation" in tables else rows
    periods = list(dict.fromkeys(float(words[0]) for words in others if float(words[0]) > 0.0)) or list(PERIODS)
    finite = [" ".join(words) for words in rows if float(words[0]) != 0.0]
    finite = finite or [f"{period!r} {i} {i} 0.0 0.0" for period in periods for i in range(1, 7)]
    infinite = list(_infinite(model, flow, all_at_surface(source.members)))
    limits = [f"0.0 {entry}" for entry in infinite] + _zero_frequency(rows, infinite)
    flow.texts[f"{ROOT}.1"] = "\n".join([*limits, *finite]) + "\n"
    if "excitation" not in tables:
        zeros = [f"{period!r} 0.0 {i} 0.0 0.0 0.0 0.0" for period in periods for i in range(1, 7)]
        flow.texts[f"{ROOT}.3"] = "\n".join(zeros) + "\n"
    return flow


def _usable(source: ExportSource, flow: ExportedFlow) -> dict:
    """Tables that HydroDyn can read, all with one ULEN; the others are said to be left out."""
    usable: dict = {}
    for key, table in source.tables.items():
        loads = [load for load in source.model.loads if isinstance(load, OF_TABLES[key])]
        share = float(loads[0].values[f"{loads[0].prefix}.share"]) if loads else 0.0
        if share == 0.0:
            reason = "it is a candidate of `diagnose`, and no part of the model"
        elif table.kind != "wamit":
            reason = "HydroDyn reads WAMIT's tables"
        elif table.by != "period":
            reason = f"HydroDyn reads periods, and its first column is in {table.by}"
        elif table.body not in (None, 1):
            reason = "it is of another body than the first"
        elif any(other.length != table.length for other in usable.values()):
            reason = "HydroDyn has one ULEN for all tables"
        else:
            usable[key] = table
            if share != 1.0:
                flow.say(f"computed_{key}.share", Treatment.LEFT_OUT, f"The deck has the whole table, not {share:g} of it.")
            continue
        flow.say(key, Treatment.LEFT_OUT, f"{table.path.name} is left out: {reason}.")
    return usable


def _hydrostatics(model: Model, flow: ExportedFlow) -> None:
    """Write `.hst` and the displaced volume.

    They are 0 unless the platform file states hydrostatics or potential flow stands for the members.
    """
    load = next(load for load in model.loads if isinstance(load, Buoyancy))
    coupling = [term.stiffness for term in model.loads if isinstance(term, HydrostaticCoupling)]
    stated = bool(float(load.extra_force) or np.any(load.extra_stiffness) or coupling)
    matrix, weight = np.zeros((6, 6)), float(model.environment.density * model.environment.gravity)
    if stated or flow.excitation:
        force, slope = (np.asarray(array) for array in _at_rest(load, jnp.asarray(weight)))
        whole = -slope + sum((np.asarray(stiffness) for stiffness in coupling), np.zeros((6, 6)))
        matrix[RESTORING, RESTORING] = 0.5 * (whole + whole.T)[RESTORING, RESTORING]
        small = 1e-12 * np.abs(matrix).max()
        matrix[np.abs(matrix) <= small] = 0.0
        centre = np.array([-force[4], force[3]]) / force[2]
        centre[np.abs(centre) < 1e-9 * float(model.size)] = 0.0
        flow.volume, flow.centre = digits(force[2] / weight), (digits(centre[0]), digits(centre[1]))
        text = (
            f"PtfmVol0 = {force[2] / weight:.6g} m³ and {ROOT}.hst, without the weight; MHstLMod of members is 0. They are "
            "linear about the reference position; here the wetted length of members follows the motion."
        )
        flow.say("hydrostatics", Treatment.APPROXIMATED, text)
    else:
        flow.say("hydrostatics", Treatment.TAKEN, "That of members (MHstLMod 1 and 2); the tables hold zeros.")
    dimension = [[flow.length ** (2 + (i > 2) + (j > 2)) * weight for j in range(6)] for i in range(6)]
    entries = [row(i + 1, j + 1, float(matrix[i, j] / dimension[i][j])) for i in range(6) for j in range(6)]
    flow.texts[f"{ROOT}.hst"] = "\n".join(entries) + "\n"


@eqx.filter_jit
def _at_rest(load: Buoyancy, weight: Float[Array, ""]) -> tuple[Float[Array, "6"], Float[Array, "6 6"]]:
    """Force (N, N m) and its slope at the reference position."""

    def force(q: Float[Array, "6"]) -> Float[Array, "6"]:
        return load.force(q, rotation(q[3:]), weight)

    return force(jnp.zeros(6)), jax.jacfwd(force)(jnp.zeros(6))


def _infinite(model: Model, flow: ExportedFlow, afloat: bool) -> Iterator[str]:
    """Entries of the added mass of infinite frequency: row, column and value; `afloat`: that of members, too."""
    added = sum((np.asarray(assemble(load.entries)) for load in model.loads if isinstance(load, AddedMass)), np.zeros((6, 6)))
    if added.any():
        flow.say("added_mass", Treatment.TAKEN, f"Rows of PER = 0 in {ROOT}.1.")
    if flow.excitation or afloat:
        strips = tuple(load for load in model.loads if isinstance(load, StripInertia | EndInertia | ComputedAddedMass))
        strip_mass = np.asarray(linearised(replace(model, loads=strips), jnp.zeros(6))[0]) if strips else np.zeros((6, 6))
        strip_mass = strip_mass - np.asarray(model.body.mass_matrix()) if strips else strip_mass
        added = added + np.where(np.abs(strip_mass) > 1e-9 * np.abs(strip_mass).max(), strip_mass, 0.0)
        why = "PropPot TRUE leaves drag alone" if flow.excitation else "HydroDyn loads no section in part"
        text = f"Added mass of members, upright in still water, in rows of PER = 0 of {ROOT}.1: {why}."
        flow.say("coefficients: Ca_t, Ca_z", Treatment.APPROXIMATED, text)
    elif any(isinstance(load, ComputedAddedMass) and float(load.share) for load in model.loads):
        text = "Members keep their own added mass (Ca): without a table of excitation HydroDyn has no other place for it."
        flow.say("radiation: added_mass", Treatment.LEFT_OUT, text)
    density = float(model.environment.density)
    for i in range(6):
        for j in range(6):
            yield row(i + 1, j + 1, float(added[i, j] / (density * flow.length ** (3 + (i > 2) + (j > 2)))))


def _zero_frequency(rows: Sequence[Sequence[str]], infinite: Sequence[str]) -> list[str]:
    """Rows of the added mass at zero frequency, without which HydroDyn stops; it uses no number of them.

    Args:
        rows: Rows of the table of radiation. Its longest period stands for zero frequency where it has none.
        infinite: Row, column and value of the added mass at infinite frequency, for a platform without a table.
    """
    periods = {float(words[0]) for words in rows} - {0.0}
    if periods and min(periods) < 0.0:
        return []
    return [f"-1.0 {words[1]} {words[2]} {words[3]}" for words in rows if float(words[0]) == max(periods)] or [
        f"-1.0 {entry}" for entry in infinite
    ]


def _rows(path: Path) -> list[list[str]]:
    """Words of the rows of numbers of a table.

    Raises:
        InputError: It cannot be read.
    """
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError as error:
        raise InputError(str(path), [Problem("", "a table that can be read", error.strerror or str(error))]) from None
    rows = [line.split() for line in lines if line.strip()]
    return [words for words in rows if np.isfinite(to_number(words[0]))]
