"""HydroDyn's potential flow: which of WAMIT's files the platform file refers to.

References:
    OpenFAST v5.0.0 (2895884), WAMIT.f90 (units, PER = 0 and the added mass of infinite frequency), HydroDyn modelling
    considerations (`.hst` without the weight).
"""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from jaxhydro.errors import InputError, Problem
from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.openfast.added_terms import matrix_entries
from jaxhydro.interop.openfast.deck_files import beside
from jaxhydro.interop.openfast.keyed_file import KeyedFile
from jaxhydro.interop.openfast.open_file import as_spelled
from jaxhydro.interop.openfast.table_row import to_number

QTF = 12  # of DiffQTF and NewmanApp: WAMIT's .12d


@dataclass
class PotentialFlow:
    """Keys of the platform file that refer to WAMIT's files.

    Attributes:
        keys: Entries of the platform file.
        files: Name beside the platform file -> file.
        items: What became of HydroDyn's keys.
    """

    keys: dict[str, Any] = field(default_factory=dict)
    files: dict[str, Path] = field(default_factory=dict)
    items: list[ConvertedItem] = field(default_factory=list)


def read_potential_flow(file: KeyedFile, density: float, strips: bool) -> PotentialFlow:
    """Keys of the platform file for HydroDyn's potential flow (PotMod = 1).

    Args:
        file: HydroDyn's file.
        density: Of the water, kg/m3.
        strips: Whether wet members are outside potential flow (PropPot FALSE).

    Raises:
        InputError: A table that is in use is not there, or of several bodies or about another point.
    """
    flow, root = PotentialFlow(), beside(file, "PotFile")
    length, volume = file.number("WAMITULEN"), file.number("PtfmVol0")

    def say(key: str, treatment: Treatment, meaning: str) -> None:
        flow.items.append(ConvertedItem(f"{file.name}: {key}", treatment, meaning))

    def table(ending: str, key: str) -> Path:
        path = as_spelled(root.with_name(root.name + ending))
        if not path.is_file():
            raise InputError(str(path), [Problem("", f"WAMIT's table, which {key} of {file.name} asks for", "no such file")])
        flow.files[path.name] = path
        return path

    def entry(path: Path, **more: Any) -> dict[str, Any]:
        return {"file": path.name} | ({"length": length} if length != 1.0 else {}) | more

    modes = {key: file.whole(key, 0) for key in ("RdtnMod", "DiffQTF", "NewmanApp", "MnDrift", "SumQTF")}
    modes["ExctnMod"] = file.whole("ExctnMod", 1)  # FAST 8 has no such key and always takes .3
    hydrostatic = as_spelled(root.with_name(f"{root.name}.hst"))
    stiff = hydrostatic.is_file() and bool(_numbers(hydrostatic)[:, 2:].any())
    used = volume != 0.0 or stiff or any(modes.values())
    if used:
        _one_body_at_origin(file)
    if volume or stiff:
        path = table(".hst", "PotMod")
        stated = {"displaced_volume": volume} if volume else {}
        flow.keys["hydrostatics"] = entry(path, weight="excluded", linear=True) | stated
        text = f"`hydrostatics` by {path.name}, linear and without the weight, and the displaced volume."
        say("PtfmVol0, .hst", Treatment.TAKEN, text)
        _centre_of_buoyancy(file, say)
        if strips:
            text = "Hydrostatics are those of the table alone: the buoyancy of members with PropPot FALSE is not added."
            say("PropPot", Treatment.APPROXIMATED, text)
    else:
        say(
            "PotFile",
            Treatment.LEFT_OUT,
            f"PtfmVol0 is 0, and {hydrostatic.name} is not there or holds zeros: buoyancy is that of members.",
        )
    radiation = as_spelled(root.with_name(f"{root.name}.1"))
    if modes["RdtnMod"]:
        flow.keys["radiation"] = entry(table(".1", "RdtnMod"))
        how = "" if modes["RdtnMod"] == 1 else " It is fitted anew, not from .ss."
        say("RdtnMod, .1", Treatment.TAKEN, f"`radiation` by {radiation.name}: the memory of its damping.{how}")
    if radiation.is_file() and (added := _infinite(radiation, density, length)).any():
        flow.keys["added_mass"] = matrix_entries("A", added)
        say(".1, PER = 0", Treatment.TAKEN, "`added_mass`: the added mass of infinite frequency.")
    elif modes["RdtnMod"]:
        text = f"{radiation.name} has no row with PER = 0: the added mass of infinite frequency is missing. Give `added_mass`."
        say(".1, PER = 0", Treatment.LEFT_OUT, text)
    if modes["ExctnMod"]:
        flow.keys["excitation"] = entry(table(".3", "ExctnMod"))
        say("ExctnMod, .3", Treatment.TAKEN, f"`excitation` by {root.name}.3, for all its headings.")
        if file.whole("ExctnDisp", 0) == 2:
            say("ExctnDisp", Treatment.APPROXIMATED, "Waves are met where the platform is, without a filter of its motion.")
        if strips:
            text = "`excitation` stands for the waves' forces on all members: those with PropPot FALSE have drag alone."
            say("PropPot", Treatment.APPROXIMATED, text)
    _second_order(modes, root, table, entry, flow, say)
    return flow


def _second_order(modes: dict[str, int], root: Path, table: Any, entry: Any, flow: PotentialFlow, say: Any) -> None:
    for key, approximation in (("DiffQTF", "full"), ("NewmanApp", "newman")):
        if modes[key] == QTF and "drift" not in flow.keys:
            flow.keys["drift"] = entry(table(".12d", key), approximation=approximation)
            newman = approximation == "newman"
            more = " HydroDyn has Standing's variant; here it is the mean of T_kk and T_ll." if newman else ""
            treatment = Treatment.APPROXIMATED if newman else Treatment.TAKEN
            say(f"{key}, .12d", treatment, f"`drift` by {root.name}.12d, approximation {approximation}.{more}")
        elif modes[key]:
            say(key, Treatment.LEFT_OUT, f"Tables .{modes[key]} are not read; .12d is.")
    for key, effect in (("MnDrift", "Mean drift alone"), ("SumQTF", "Forces at sum frequencies")):
        if modes[key]:
            say(key, Treatment.LEFT_OUT, f"{effect} have no counterpart.")


def _one_body_at_origin(file: KeyedFile) -> None:
    if (bodies := file.whole("NBody", 1)) != 1:
        raise file.wrong(file.line_of("NBody"), "1 body", f"{bodies}", key="NBody")
    for key in ("PtfmRefxt", "PtfmRefyt", "PtfmRefzt", "PtfmRefztRot"):
        if value := file.number(key, 0.0):
            hint = "WAMIT's tables have to be about the origin at still water."
            raise file.wrong(file.line_of(key), "0", f"{value:g}", hint, key)


def _centre_of_buoyancy(file: KeyedFile, say: Any) -> None:
    offset = [file.number(key, 0.0) for key in ("PtfmCOBxt", "PtfmCOByt")]
    if any(offset):
        say("PtfmCOBxt, PtfmCOByt", Treatment.LEFT_OUT, "No key: buoyancy acts in the vertical through the origin.")


def _numbers(path: Path) -> Float[np.ndarray, "n m"]:
    """Rows of numbers of one of WAMIT's tables; a row of words on top is passed over."""
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError as error:
        raise InputError(str(path), [Problem("", "a table that can be read", error.strerror or str(error))]) from None
    rows = []
    for i, words in enumerate(map(str.split, lines)):
        values = [to_number(word) for word in words]
        if not words or (i == 0 and np.isnan(values[0])):
            continue
        if not np.isfinite(values).all() or len(values) < 3:
            raise InputError(str(path), [Problem(f"line {i + 1}", "3 numbers or more", " ".join(words)[:50])])
        rows.append((values + [0.0] * 5)[:5])
    return np.array(rows).reshape(-1, 5)


def _infinite(path: Path, density: float, length: float) -> Float[np.ndarray, "6 6"]:
    """Added mass (kg, kg m, kg m2) of the rows with PER = 0."""
    added = np.zeros((6, 6))
    for period, i, j, value, _ in _numbers(path):
        if period == 0.0 and max(i, j) <= 6:
            power = 3 + (i > 3) + (j > 3)
            added[int(i) - 1, int(j) - 1] = density * length**power * value
    return added
