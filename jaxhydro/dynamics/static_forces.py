"""Static forces on a platform: by load, by mooring line, and over an offset."""

import dataclasses
import re
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.newton_euler import sum_of_loads
from jaxhydro.dynamics.state import State
from jaxhydro.dynamics.statics import held_at
from jaxhydro.environment import DOFS
from jaxhydro.loads import AbstractLines
from jaxhydro.loads.catenary.catenary_lines import CatenaryLines
from jaxhydro.loads.mooring_lines import MooringLines
from jaxhydro.loads.stiffness import Stiffness
from jaxhydro.loads.tension_table_lines import TensionTableLines
from jaxhydro.quick_jit import quick_jit
from jaxhydro.rotations import rotation
from jaxhydro.waves.sea import StillWater


def forces_by_load(model: Model, position: Float[Array, "6"]) -> dict[str, np.ndarray]:
    """Static force of every load on the motionless platform in still water.

    Args:
        model: The platform.
        position: Position (m, rad), (6,).

    Returns:
        Force and moment about the reference point in earth axes (N, N m), (6,), by name of load, such as "mooring lines".
        Loads of one name are added. Loads without a static force are left out.
    """
    forces: dict[str, np.ndarray] = {}
    for load, force in zip(model.loads, np.asarray(_forces(model, jnp.asarray(position)))):
        if force.any():
            name = load.name if isinstance(load, Stiffness) else re.sub(r"(?<!^)(?=[A-Z])", " ", type(load).__name__).lower()
            forces[name] = forces.get(name, np.zeros(6)) + force
    return forces


@quick_jit
def _forces(model: Model, position: Float[Array, "6"]) -> Float[Array, "k 6"]:
    state = State(position, jnp.zeros(6), model.rest().memory)
    now = model.instant(jnp.zeros(()), state, StillWater())
    rows = []
    for load, memory in zip(model.loads, state.memory):
        total = sum_of_loads((load,), now, (memory,)).force
        rows.append(jnp.concatenate([now.rotation @ total[:3], now.rotation @ total[3:]]))
    return jnp.stack(rows)


@quick_jit
def mooring_stiffness(model: Model, position: Float[Array, "6"]) -> Float[Array, "6 6"]:
    """Stiffness matrix of the mooring lines alone, about a position.

    The negative slope of their force and moment about the reference point, earth axes. With lines that pull, it is not
    symmetric: a rotation moves the fairleads, and the moment is about a point that moves.

    Args:
        model: The platform.
        position: Position (m, rad), (6,).

    Returns:
        Stiffness (N/m, N, N m), (6, 6).
    """
    lines = dataclasses.replace(model, loads=tuple(load for load in model.loads if isinstance(load, AbstractLines)))
    return -jax.jacfwd(lines.force_at_rest)(position)


class LineState(NamedTuple):
    """Static state of a mooring line.

    Attributes:
        tension: Tension at the fairlead (N).
        angle: Angle of the line below the horizontal at the fairlead (rad).
        strain: Tension over axial stiffness at the fairlead (-); of a rope with a table, its stretch, 0 where it is slack.
        on_seabed: Unstretched length that rests on the seabed (m); 0 for a straight line.
    """

    tension: float
    angle: float
    strain: float
    on_seabed: float


def line_states(model: Model, position: Float[Array, "6"]) -> list[LineState]:
    """Static state of every mooring line at a position.

    Args:
        model: The platform.
        position: Position (m, rad), (6,).

    Returns:
        The lines, in the order of the platform file; copies of a line by heading follow each other.
    """
    matrix = rotation(jnp.asarray(position)[3:])
    states: list[LineState] = []
    for load in model.loads:
        if isinstance(load, AbstractLines):
            columns = [np.asarray(column) for column in _line_columns(load, jnp.asarray(position), matrix)]
            states += [LineState(*(float(x) for x in row)) for row in zip(*columns, strict=True)]
    return states


@quick_jit
def _line_columns(
    load: AbstractLines, position: Float[Array, "6"], matrix: Float[Array, "3 3"]
) -> tuple[Float[Array, " l"], Float[Array, " l"], Float[Array, " l"], Float[Array, " l"]]:
    """Tension, angle, strain and length on the seabed of lines."""
    tension, towards = load.tension(position, matrix)
    down = -(matrix @ towards)[2]
    angle = jnp.arcsin(jnp.clip(down, -1.0, 1.0))
    if isinstance(load, CatenaryLines):
        return tension, angle, tension / load.segments().stiffness[0], load.on_seabed(tension * down)
    if isinstance(load, TensionTableLines):
        return tension, angle, jnp.maximum(load.strain(position, matrix), 0.0), jnp.zeros_like(tension)
    assert isinstance(load, MooringLines)
    lines = [f"line{i + 1}" for i in range(load.anchor.shape[1])]
    axial = jnp.stack([load.stiffness[line] * load.unstretched_length[line] for line in lines])
    return tension, angle, tension / axial, jnp.zeros_like(tension)


class OffsetCurve(NamedTuple):
    """Static positions of a platform that is held at offsets in one motion; n offsets.

    Attributes:
        dof: The motion that is held.
        position: Position (m, rad), (n, 6).
        force: Force or moment that holds the platform, in the motion that is held (N or N m), (n,).
    """

    dof: str
    position: np.ndarray
    force: np.ndarray


def offset_curve(model: Model, dof: str, offsets: Float[Array, " n"]) -> OffsetCurve:
    """Force that holds a platform at offsets in one motion; the other motions are free.

    Args:
        model: The platform.
        dof: The motion, such as "surge".
        offsets: Offsets from the reference position (m or rad), (n,).

    Returns:
        Positions and forces; NaN where no balance was found.
    """
    position, force = (np.asarray(values) for values in _held(model, DOFS.index(dof), jnp.asarray(offsets, float)))
    return OffsetCurve(dof, position, force)


@quick_jit
def _held(model: Model, dof: int, offsets: Float[Array, " n"]) -> tuple[Float[Array, "n 6"], Float[Array, " n"]]:
    def held(offset: Float[Array, ""]) -> tuple[Float[Array, "6"], Float[Array, ""]]:
        position = held_at(model, dof, offset)
        return position, -model.force_at_rest(position)[dof]

    return jax.lax.map(held, offsets)
