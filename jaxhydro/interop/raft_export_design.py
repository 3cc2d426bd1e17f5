"""A RAFT design file of a platform: the counterpart of `raft_design`, which reads it back.

RAFT works in the frequency domain, linear about the mean position. Mass and inertia are one point inertia. A constant load
(`mean_load`) has what pulls at the platform beside members, weight and lines.

References:
    RAFT at e6cb69e, raft_fowt.py, FOWT.__init__ (additional_effects, yaw_stiffness, dlsMax) and raft_model.py,
    Model.__init__ (settings, cases).
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from jaxtyping import Float

from jaxhydro.environment import DOFS
from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.export_effects import effects_left_out, plain_load, told_values
from jaxhydro.interop.export_source import ExportedModel, ExportSource
from jaxhydro.interop.openfast.mass_parts import tidy
from jaxhydro.interop.raft_export_members import raft_members
from jaxhydro.interop.raft_export_mooring import catenary_mooring, spring_mooring
from jaxhydro.interop.raft_export_notes import RaftNotes
from jaxhydro.interop.yaml_text import yaml_text
from jaxhydro.loads import (
    Buoyancy,
    CatenaryLines,
    EndInertia,
    MooringLines,
    MorisonDrag,
    SlenderBodyForces,
    Stiffness,
    StripInertia,
    Weight,
)

TAKEN, APPROXIMATED, LEFT_OUT = Treatment.TAKEN, Treatment.APPROXIMATED, Treatment.LEFT_OUT
DESIGN = "design.yaml"
STRIP = 1.0  # m times the size of the hull, of RAFT's longest strip: RAFT loads each at its middle
YAW = "C66"
WRITTEN = (Buoyancy, CatenaryLines, EndInertia, MooringLines, MorisonDrag, SlenderBodyForces, Stiffness, StripInertia, Weight)
SECOND_ORDER_BAND = {"min_freq2nd": 0.01, "max_freq2nd": 0.25}  # Hz, at the size of VolturnUS-S
SETTINGS = {"min_freq": 0.005, "max_freq": 0.4, "XiStart": 0.1, "nIter": 15}
CASES = {  # an example, which RAFT needs for a run
    "keys": [
        *("wind_speed", "wind_heading", "turbulence", "turbine_status", "yaw_misalign"),
        *("wave_spectrum", "wave_period", "wave_height", "wave_heading"),
    ],
    "data": [[0.0, 0.0, 0.0, "parked", 0.0, "JONSWAP", 10.0, 2.0, 0.0]],
}


@dataclass
class _Added:
    """Loads and lines of a design, beside members and mass.

    Attributes:
        load: Constant load at the reference point, N, N m, (6,).
        yaw_stiffness: N m/rad.
        mooring: Section of lines.
        items: What became of the loads.
    """

    load: Float[np.ndarray, "6"] = field(default_factory=lambda: np.zeros(6))
    yaw_stiffness: float = 0.0
    mooring: dict[str, Any] | None = None
    items: list[ConvertedItem] = field(default_factory=list)


def export_design(source: ExportSource) -> ExportedModel:
    """RAFT's design file of a platform, and what became of each item.

    Args:
        source: The platform.

    Returns:
        Text of design.yaml, in SI units and degrees.
    """
    water, notes = source.model.environment, RaftNotes()
    site = {"water_depth": water.depth, "rho_water": water.density, "g": water.gravity}
    members = raft_members(source, notes)
    added, inertia = _added(source), _point_inertia(source)
    effects: list[dict[str, Any]] = [inertia]
    if added.load.any():
        load = [tidy(value) for value in added.load]
        effects.append({"type": "mean_load", "location": [0.0, 0.0, 0.0], "load": load})
    platform: dict[str, Any] = {"potModMaster": 1, "dlsMax": tidy(STRIP * float(source.model.size))}
    second = [load for load in source.model.loads if isinstance(load, SlenderBodyForces) and float(load.share)]
    if second:
        platform |= {"potSecOrder": 1} | {
            key: tidy(frequency / float(source.model.pace)) for key, frequency in SECOND_ORDER_BAND.items()
        }
        share = float(second[0].share)
        addition = "" if share == 1.0 else f", a whole share in place of {share:.3g}"
        text = f"potSecOrder 1{addition}. RAFT has the difference frequencies, and leaves out the waves' own rho u^2/2 on ends."
        added.items.append(ConvertedItem("second_order_forces", APPROXIMATED, text))
    if added.yaw_stiffness:
        platform["yaw_stiffness"] = tidy(added.yaw_stiffness)
    design = {
        "type": "input file for RAFT",
        "name": source.name,
        "settings": SETTINGS,
        "site": {key: tidy(float(value)) for key, value in site.items()},
        "cases": CASES,
        "platform": platform | {"members": members, "additional_effects": effects},
    }
    if added.mooring is not None:
        design["mooring"] = added.mooring
    items = [*_taken(source, inertia["mass"]), *notes.items(), *added.items, *_conventions(source)]
    omitted = effects_left_out(source, WRITTEN, "The design")
    return ExportedModel({DESIGN: yaml_text(design)}, (*items, *_drag_laws(source), *omitted))


def _point_inertia(source: ExportSource) -> dict[str, Any]:
    """The rigid body: its inertia about its centre, in RAFT's order."""
    body = source.model.body
    inertia = np.asarray(body.inertia, float)
    entries = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    return {
        "type": "point_inertia",
        "location": [tidy(value) for value in np.asarray(body.centre, float)],
        "mass": tidy(float(body.mass)),
        "moments_of_inertia": [tidy(inertia[index]) for index in entries],
    }


def _added(source: ExportSource) -> _Added:
    """Stiffness, lines and constant loads."""
    added = _Added()

    def say(key: str, treatment: Treatment, meaning: str, warning: bool = False) -> None:
        added.items.append(ConvertedItem(key, treatment, meaning, warning))

    for load in map(plain_load, source.model.loads):
        if isinstance(load, CatenaryLines):
            added.mooring, items = catenary_mooring(source, load)
            added.items += items
        elif isinstance(load, MooringLines):
            added.mooring, items = spring_mooring(source, load)
            added.items += items
        elif isinstance(load, Stiffness):
            _stiffness(load, added, say)
        elif isinstance(load, Buoyancy):
            _declared_hydrostatics(load, added, say)
    return added


def _stiffness(load: Stiffness, added: _Added, say: Any) -> None:
    """Yaw stiffness and preload of a stiffness matrix."""
    label = f"{load.name}.{YAW}"
    yaw = float(load.values.get(label, 0.0))
    if yaw > 0.0:
        added.yaw_stiffness += yaw
        say(label, TAKEN, f"yaw_stiffness, {yaw:.6g} N m/rad.")
    if (preload := np.asarray(load.preload, float)).any():
        added.load += preload
        say(f"{load.name}.preload", TAKEN, f"mean_load, a constant load: {_told_load(preload)}.")
    others = [key for key in load.values if float(load.values[key]) and not (key == label and yaw > 0.0)]
    if others:
        text = f"RAFT has no stiffness matrix: {told_values(load, others)}."
        held = " Nothing else holds the platform in the design: add lines to its mooring section."
        mooring = load.name == "mooring"
        say(f"{load.name}.stiffness" if mooring else load.name, LEFT_OUT, text + held * mooring, mooring)


def _declared_hydrostatics(load: Buoyancy, added: _Added, say: Any) -> None:
    """Declared buoyancy beyond that of the members."""
    if force := float(load.extra_force):
        added.load[2] += force
        text = f"Buoyancy beyond that of the members: mean_load, a constant load of {force:.6g} N in heave."
        say("hydrostatics.displaced_volume", APPROXIMATED, text)
    names = dict(zip(("C33", "C44", "C55"), np.asarray(load.extra_stiffness, float), strict=True))
    if told := ", ".join(f"{key} {value:+.4g} {'N/m' if key == 'C33' else 'N m/rad'}" for key, value in names.items() if value):
        say("hydrostatics", LEFT_OUT, f"RAFT has the stiffness of the members; the declared one differs from it by {told}.")


def _told_load(load: Float[np.ndarray, "6"]) -> str:
    units = ["N"] * 3 + ["N m"] * 3
    return ", ".join(f"{name} {value:.6g} {unit}" for name, value, unit in zip(DOFS, load, units, strict=True) if value)


def _taken(source: ExportSource, mass: float) -> Iterator[ConvertedItem]:
    water = source.model.environment
    told = f"{float(water.density):g} kg/m³, {float(water.depth):g} m, {float(water.gravity):g} m/s²"
    yield ConvertedItem("water", TAKEN, f"rho_water, water_depth and g: {told}.")
    text = f"A point inertia of {mass:.6g} kg at the centre of mass; shells of members have no thickness. There is no turbine."
    yield ConvertedItem("rigid_body", TAKEN, text)
    if source.members:
        text = (
            f"{len(source.headings)} members with stations and headings: {len(source.members)} with their copies. Ca and Cd by "
            "direction, CaEnd and CdEnd of columns; ends of other members have none."
        )
        yield ConvertedItem("members, coefficients", TAKEN, text)
        text = f"RAFT's strips are at most dlsMax = {STRIP * float(source.model.size):.3g} m; here strips are at Gauss points."
        yield ConvertedItem("members: elements, points", APPROXIMATED, text)
    yield ConvertedItem("sea", TAKEN, "A JONSWAP sea of 2 m and 10 s is an example. Set `settings` and `cases`.")


def _conventions(source: ExportSource) -> Iterator[ConvertedItem]:
    chosen = source.model.conventions
    text = (
        "RAFT is linear about the mean position: hull up to still water, axes and waves there. Here wetting is "
        f"{chosen.wetting}, directions {chosen.directions}, waves_at {chosen.waves_at}."
    )
    yield ConvertedItem("wetting, directions, waves_at, centripetal", APPROXIMATED, text)
    text = "RAFT linearises drag over the sea state: of circles by the vector of the flow, of boxes by each component."
    yield ConvertedItem("drag", APPROXIMATED, text)


def _drag_laws(source: ExportSource) -> Iterator[ConvertedItem]:
    for label, law in source.drag_laws.items():
        if law.get("law", "constant") != "constant":
            told = ", ".join(f"{key} {value}" for key, value in law.items())
            text = f"RAFT has constant coefficients: {told}."
            yield ConvertedItem(label.replace(".Cd_", ".drag_"), LEFT_OUT, text)
