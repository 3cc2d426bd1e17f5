"""Model of a platform file."""

import warnings
from dataclasses import replace
from os import PathLike

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from jaxhydro.dynamics.conventions import Conventions
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.rigid_body import RigidBody
from jaxhydro.environment import Environment
from jaxhydro.errors import InputError, Problem, suggest
from jaxhydro.hull.ends import Ends
from jaxhydro.hull.hull import Hull
from jaxhydro.hull.member import COLUMN_SLOPE
from jaxhydro.hull.strips import Elements
from jaxhydro.jax_settings import need_float64
from jaxhydro.loads import (
    AbstractLoad,
    AddedMass,
    Buoyancy,
    EndInertia,
    GuidedMasses,
    LinearDamping,
    MorisonDrag,
    QuadraticDamping,
    RotorThrust,
    SlenderBodyForces,
    Stiffness,
    StripInertia,
    Weight,
)
from jaxhydro.loads.hydrostatics import buoyancy
from jaxhydro.loads.sea_state_law import with_exponents
from jaxhydro.parameters import strongly_typed
from jaxhydro.platform import schema as schema
from jaxhydro.platform.computed_hydrostatics import with_hydrostatics
from jaxhydro.platform.computed_loads import tables_of
from jaxhydro.platform.damper_build import damper_loads, damper_mass, damper_remarks
from jaxhydro.platform.diffraction_correction_build import with_diffraction_correction
from jaxhydro.platform.drag_laws import DragLaw, plain_drag, with_drag_laws
from jaxhydro.platform.matrix_schema import entries_of
from jaxhydro.platform.members_build import check_wetting, members_of
from jaxhydro.platform.mooring_build import line_pull, mooring_loads, mooring_remarks
from jaxhydro.quick_jit import on_device
from jaxhydro.scales import size_of
from jaxhydro.water import AbstractWaterEffect, CurrentProfile
from jaxhydro.waves.sea_state import SeaState


def load_model(path_or_name: str | PathLike[str]) -> Model:
    """Model of a platform file, or of a built-in platform.

    Warnings among the model's `remarks` are also given as Python warnings.

    Args:
        path_or_name: Path of a YAML file, or name of a built-in platform.

    Returns:
        The model.

    Raises:
        InputError: The file has mistakes; all of them are listed.
    """
    model = build(schema.load_platform(path_or_name))
    for remark in model.remarks:
        if remark.warning:
            warnings.warn(remark.text, stacklevel=2)
    return model


def build(platform: schema.Platform) -> Model:
    """Model of a platform description.

    Args:
        platform: Checked contents of a platform file.

    Returns:
        The model, with remarks on the files that the platform names.

    Raises:
        Float64Error: JAX does not compute in float64 (a RuntimeError).
        InputError: The members or coefficients do not fit together.
    """
    need_float64()
    water = platform.water
    environment = Environment(water.density, water.depth, water.gravity)
    mass, centre, inertia = platform.rigid_body.combined()
    body = RigidBody(on_device(mass), on_device(centre), on_device(inertia))
    members = members_of(platform)
    check_wetting(members, platform)
    size = size_of(mass, water.density)
    hull = Hull.of(members, size)
    geometry = buoyancy(() if platform.hydrostatics.linear else members, size)
    platform, coupling, remarks = with_hydrostatics(platform, geometry)
    buoyancy_load = _with_file_values(geometry, platform, mass, float(centre[2]))
    loads: list[AbstractLoad] = [Weight(mass=body.mass, centre=body.centre), buoyancy_load, *coupling]
    loads += mooring_loads(platform)
    for name, matrix, load in (
        ("linear_damping", platform.linear_damping.matrix(), LinearDamping),
        ("quadratic_damping", platform.quadratic_damping.matrix(), QuadraticDamping),
        ("added_mass", platform.added_mass.matrix(), AddedMass),
    ):
        letter = "A" if name == "added_mass" else "B"
        if values := entries_of(letter, matrix):
            loads.append(load(values))
    loads += _guided(platform) + damper_loads(platform)
    if (rotor := platform.rotor) is not None:
        loads.append(RotorThrust(on_device(rotor.hub), on_device(rotor.thrust), on_device(rotor.damping)))
    computed, table_remarks = tables_of(platform, buoyancy_load)
    loads += computed
    if values := entries_of("C", platform.stiffness.matrix()):
        loads.append(Stiffness(values))
    if members:
        coupled = platform.drag_speed == "vector"
        loads += [
            StripInertia(_coefficients(platform, "Ca", hull.elements)),
            EndInertia(_coefficients(platform, "Ca", hull.ends)),
            MorisonDrag(_coefficients(platform, "Cd", hull.elements, hull.ends), coupled=coupled),
        ]
        if platform.second_order_forces == "slender_body":
            loads.append(SlenderBodyForces(on_device(1.0)))
    conventions = Conventions(
        platform.wetting, platform.diffraction, platform.directions, platform.waves_at, platform.centripetal
    )
    all_remarks = (*mooring_remarks(platform), *damper_remarks(platform), *remarks, *table_remarks)
    flowing: tuple[AbstractWaterEffect, ...] = ()
    if water.current is not None:
        height, velocity = water.current.profile(water.depth)
        flowing = (CurrentProfile(on_device(height), on_device(velocity), on_device(1.0)),)
    model = Model(environment, body, hull, tuple(loads), flowing, conventions=conventions, remarks=all_remarks)
    if platform.excitation is not None and platform.excitation.second_order == "strips":
        model = with_diffraction_correction(model)
    model = with_drag_laws(model, _chosen_drag(platform, model))
    return strongly_typed(replace(model, loads=_in_seas(model, platform)))


def model_of(platform: schema.Platform, diffraction: str | None = None, elements: int | None = None) -> Model:
    """Model of a platform description, with another diffraction or other load elements.

    Args:
        platform: Checked contents of a platform file.
        diffraction: Diffraction in place of that in the file.
        elements: Number of load elements of every pontoon in place of those in the file.
    """
    if elements is not None:
        members = []
        for member in platform.members:
            axis = np.subtract(member.rB, member.rA)
            column = abs(axis[2]) > COLUMN_SLOPE * np.linalg.norm(axis)
            members.append(member if column else member.model_copy(update={"elements": elements}))
        platform = platform.model_copy(update={"members": tuple(members)})
    model = build(platform)
    return model if diffraction is None else model.with_conventions(diffraction=str(diffraction))


def _in_seas(model: Model, platform: schema.Platform) -> tuple[AbstractLoad, ...]:
    """Loads of a model with the sea-state laws of the platform file for their coefficients."""
    laws, labels = platform.sea_state_laws, list(model.values)
    if laws is None:
        return model.loads
    if unknown := [label for label in laws.exponents if label not in labels]:
        where = f"sea_state_laws.exponents.{unknown[0]}"
        labels = [label for label in labels if not label.startswith(("mooring.", "stiffness."))]
        expected, hint = f"a coefficient ({', '.join(labels)})", model.shared_hint(unknown[0]) or suggest(unknown[0], labels)
        raise InputError(platform.name, [Problem(where, expected, repr(unknown[0]), hint)])
    exponents = {
        (label, over): value
        for label, row in laws.exponents.items()
        for over, value in row.model_dump(exclude_none=True).items()
    }
    return with_exponents(model.loads, exponents, SeaState(**laws.reference.model_dump()))


def _chosen_drag(platform: schema.Platform, model: Model) -> dict[str, DragLaw]:
    """Drag laws of the platform file for the drag coefficients of its hull, by label."""
    problems = [
        Problem(f"coefficients.{group}.drag_z", "no suction side, which the ends of columns have", "a group of pontoons")
        for group, row in platform.coefficients.items()
        if (group, "z") not in model.hull.ends.owners("Cd") and getattr(row.drag_z, "suction", None) is not None
    ]
    if problems:
        raise InputError(platform.name, problems)
    rows = platform.coefficients.items()
    laws = {f"{group}.Cd_{kind}": law for group, row in rows for kind, law in (("t", row.drag_t), ("z", row.drag_z))}
    return {label: law for label, law in laws.items() if label in plain_drag(model)}


def _coefficients(platform: schema.Platform, symbol: str, *parts: Elements | Ends) -> dict[tuple[str, str], float]:
    """Coefficients of elements and ends by group and kind, in the order of the platform file."""
    numbers = {group: row.numbers() for group, row in platform.coefficients.items()}
    keys, used = [(group, kind) for group in numbers for kind in "tz"], {key for part in parts for key in part.owners(symbol)}
    return {(group, kind): numbers[group][f"{symbol}_{kind}"] for group, kind in keys if (group, kind) in used}


def _guided(platform: schema.Platform) -> list[AbstractLoad]:
    if not (masses := platform.guided_masses):
        return []
    points, along = jnp.asarray(np.array([mass.point for mass in masses], float)), tuple(mass.axes() for mass in masses)
    names = tuple(mass.name for mass in masses)
    return [
        GuidedMasses(names, points, along, tuple(mass.weight for mass in masses), {mass.name: mass.mass for mass in masses})
    ]


def _with_file_values(load: Buoyancy, platform: schema.Platform, mass: float, centre: float) -> Buoyancy:
    """Buoyancy with the values of the platform file in place of those of the members' geometry.

    Without members, the volume balances the weight and the mooring's pull at the reference position.
    """
    hydrostatics, water = platform.hydrostatics, platform.water
    weight_density = water.density * water.gravity
    geometry = load.upright(weight_density)
    volume = hydrostatics.displaced_volume
    if volume is None:
        pull = sum(float(m.preload[2]) if isinstance(m, Stiffness) else line_pull(m) for m in mooring_loads(platform))
        borne = mass + sum(guided.mass for guided in platform.guided_masses if guided.weight)
        borne += damper_mass(platform)
        volume = (
            geometry["displaced_volume"]
            if platform.members and not hydrostatics.linear
            else borne / water.density - pull / weight_density
        )
    force = weight_density * (volume - geometry["displaced_volume"])
    weight_share = mass * water.gravity * centre  # of C44 and C55, with the sign of -m g z_G
    stiffness = []
    for name, value, buoyant in (
        ("C33", hydrostatics.C33, hydrostatics.C33),
        ("C44", hydrostatics.C44, hydrostatics.C44_buoyancy),
        ("C55", hydrostatics.C55, hydrostatics.C55_buoyancy),
    ):
        if name != "C33" and value is not None:
            buoyant = value + weight_share
        # volume that the members do not have is at the centre of buoyancy of those that they have
        extra = 0.0 if name == "C33" else force * geometry["centre_of_buoyancy"]
        stiffness.append(extra if buoyant is None else buoyant - geometry[name])
    changed = (on_device(force), on_device(stiffness))
    return eqx.tree_at(lambda b: (b.extra_force, b.extra_stiffness), load, changed)
