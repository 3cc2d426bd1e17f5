"""Static equilibrium, and the natural modes of a platform about it."""

from collections.abc import Collection
from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.choices import unknown
from jaxhydro.dynamics.model import Model, State
from jaxhydro.dynamics.natural_modes import Modes, modes_of
from jaxhydro.dynamics.newton_euler import body_acceleration
from jaxhydro.environment import DOFS
from jaxhydro.quick_jit import quick_jit
from jaxhydro.waves.sea import StillWater

NEWTON_TOLERANCE = 1e-12  # of the position: the last step
ITERATIONS = 64
MIN_COUPLING = 1e-9  # of two motions' own mass or stiffness: what is below goes with rounding
MOMENT_ARM = 10.0  # m times the platform's size: lever that turns a moment out of balance into a force
MAX_HEAVE = 20.0  # the same: heave in which a platform does not float, if it is not less deep
ROTATION_LENGTH = 50.0  # the same: VolturnUS-S's half width, by which modes compare rotations with displacements
MIN_RESTORING = 1e-12  # of the stiffest motion's restoring: what is below is none


class EquilibriumError(RuntimeError):
    """The platform has no static equilibrium near its reference position."""


def _balance(position: Float[Array, "6"], model: Model) -> Float[Array, "6"]:
    """Net force over weight, net moment over weight times `MOMENT_ARM`."""
    weight = model.body.mass * model.environment.gravity
    arm = jnp.ones(6).at[3:].set(MOMENT_ARM * model.size)
    return model.force_at_rest(position) / (weight * arm)


class _HeldMotion(NamedTuple):
    """A degree of freedom that is held.

    Attributes:
        mask: 1 for the degree of freedom, else 0, (6,).
        value: Where it is held (m or rad).
    """

    mask: Float[Array, "6"]
    value: Float[Array, ""]


def _unbalanced(position: Float[Array, "6"], model: Model, held: _HeldMotion | None) -> Float[Array, "6"]:
    """Residual of the equilibrium: `_balance`, and for a held motion its distance from where it is held."""
    residual = _balance(position, model)
    return residual if held is None else jnp.where(held.mask > 0, position - held.value, residual)


@eqx.filter_custom_jvp
def _root(model: Model, held: _HeldMotion | None) -> tuple[Float[Array, "6"], Float[Array, "6"]]:
    """Equilibrium, and the residual one step of Newton's method before it."""
    # Newton's iteration is written out: tracing a library's takes longer than all the rest of a command's start, and programs
    # with the library's implicit derivative cannot be kept compiled

    def balance(q: Float[Array, "6"]) -> tuple[Float[Array, "6"], Float[Array, "6"]]:
        residual = _unbalanced(q, model, held)
        return residual, residual

    def going(state: tuple[Array, Array, Array, Array]) -> Array:
        root, step, count, _ = state
        return (jnp.abs(step).max() > NEWTON_TOLERANCE * (1 + jnp.abs(root).max())) & (count < ITERATIONS)

    def newton(state: tuple[Array, Array, Array, Array]) -> tuple[Array, Array, Array, Array]:
        root, _, count, _ = state
        slopes, residual = jax.jacfwd(balance, has_aux=True)(root)
        # the least-norm step lets a motion that nothing restrains (a ship's surge, a free heave) stay where it is
        step = jnp.linalg.pinv(slopes, rtol=MIN_RESTORING) @ residual
        return root - step, step, count + 1, residual

    never = jnp.full(6, jnp.inf)
    root, _, _, unbalanced = jax.lax.while_loop(going, newton, (jnp.zeros(6), never, jnp.asarray(0), never))
    return root, unbalanced


@_root.def_jvp
def _root_jvp(primals, tangents):
    """By the implicit function theorem."""
    root, unbalanced = _root(*primals)
    _, balance = eqx.filter_jvp(lambda *arguments: _unbalanced(root, *arguments), primals, tangents)
    change = -jnp.linalg.pinv(jax.jacfwd(_unbalanced)(root, *primals), rtol=MIN_RESTORING) @ balance
    return (root, unbalanced), (change, jnp.zeros(6))


@quick_jit
def _solve(model: Model) -> tuple[Float[Array, "6"], Float[Array, "6"]]:
    return _root(model, None)


@quick_jit
def _balance_upright(model: Model) -> Float[Array, "6"]:
    return _balance(jnp.zeros(6), model)


def equilibrium(model: Model) -> Float[Array, "6"]:
    """Static equilibrium in still water, by Newton's method; differentiable in the model.

    Motions without restoring stay at zero.

    Args:
        model: The platform.

    Returns:
        Surge, sway, heave (m), roll, pitch, yaw (rad) from the reference position.

    Raises:
        EquilibriumError: No balance to 1e-8 of the weight was found, or the platform sinks, rises out of the water or lies
            on its side.
    """
    position, residual = _solve(model)
    if isinstance(position, jax.core.Tracer):
        return position
    rest = np.asarray(position)
    worst = int(np.argmax(np.abs(np.nan_to_num(np.asarray(residual), nan=np.inf))))
    if not (np.abs(np.asarray(residual)).max() < 1e-8 and np.isfinite(rest).all()):
        off = float(np.asarray(_balance_upright(model))[worst]) * (1 if worst < 3 else MOMENT_ARM * float(model.size))
        raise EquilibriumError(
            f"no static equilibrium: {DOFS[worst]} is out of balance by {off:.3g} of the weight"
            f"{'' if worst < 3 else ' times 1 m'} at the reference position; check mass, volume and mooring"
        )
    draught = np.abs(np.asarray(model.hull.elements.start)[2]).max(initial=0.0)
    if abs(rest[2]) > max(draught, MAX_HEAVE * float(model.size)) or (np.abs(rest[3:5]) > 1.0).any():
        where = ", ".join(f"{dof} {x:.3g} {unit}" for dof, x, unit in zip(DOFS[2:5], rest[2:5], ("m", "rad", "rad")))
        raise EquilibriumError(f"the platform only balances at {where}: check mass, centre of mass, volume and mooring")
    return position


def held_at(model: Model, dof: int, value: Float[Array, ""]) -> Float[Array, "6"]:
    """Static equilibrium (m, rad) of the other five motions while one is held; differentiable.

    Motions without restoring stay at zero.

    Args:
        model: The platform.
        dof: Number of the motion that is held.
        value: Where it is held (m or rad).
    """
    return _root(model, _HeldMotion(jnp.zeros(6).at[dof].set(1.0), jnp.asarray(value, float)))[0]


@quick_jit
def linearised(model: Model, position: Float[Array, "6"]) -> tuple[Float[Array, "6 6"], Float[Array, "6 6"]]:
    """Mass matrix with added mass, and stiffness matrix, of small motion about a position of rest.

    The loads' memories stay at rest. That is exact for drag laws, whose force is of second order in motion and memory
    together. A force proportional to a memory would add to both matrices.

    Args:
        model: The platform.
        position: Position of rest (m, rad), (6,).

    Returns:
        Mass (kg, kg m, kg m²) and stiffness (N/m, N, N m), (6, 6) each.
    """
    rest = model.rest()

    def acceleration(q: Float[Array, "6"]) -> tuple[Float[Array, "6"], Float[Array, "6 6"]]:
        now = model.instant(jnp.zeros(()), State(q, jnp.zeros(6), rest.memory), StillWater())
        total = model.sum_of_loads(now, rest.memory)
        mass = model.body.mass_matrix() + total.added_mass + total.moments @ total.masses
        return body_acceleration(model.body, jnp.zeros(6), total, model.conventions.directions == "earth"), mass

    slopes, mass = jax.jacfwd(acceleration, has_aux=True)(position)
    return mass, -mass @ slopes


def widths(model: Model) -> np.ndarray:
    """Factors by which displacements (1) and rotations (m) are compared, (6,)."""
    return np.array([1.0, 1.0, 1.0, *3 * [ROTATION_LENGTH * float(model.size)]])


def natural_modes(model: Model, position: Float[Array, "6"] | None = None) -> Modes:
    """Undamped natural modes about a position of rest.

    Motions without restoring have no mode. Where radiation has a memory, each mode has the added mass of its own frequency. In
    mode shapes, rotations are multiplied by `widths`, so that metres and radians
    can be compared.

    Args:
        model: The platform.
        position: Position of rest (m, rad), (6,); None: the static equilibrium.

    Returns:
        Periods, shapes and dominant motions.

    Raises:
        EquilibriumError: The platform has no static equilibrium.
    """
    position = equilibrium(model) if position is None else position
    mass, stiffness = (np.asarray(matrix) for matrix in linearised(model, position))
    memories = tuple(load for load in model.loads if load.retardation(1.0) is not None)
    return modes_of(mass, stiffness, memories, widths(model))


def _coupled(model: Model, moved: Collection[str]) -> set[str]:
    """Degrees of freedom coupled with some in small motion, directly or through others."""
    both = [np.abs(np.asarray(matrix)) for matrix in linearised(model, equilibrium(model))]
    scales = [np.sqrt(np.maximum(np.diag(matrix), MIN_COUPLING * matrix.max())) for matrix in both]
    goes = np.any([matrix > MIN_COUPLING * np.outer(s, s) for matrix, s in zip(both, scales)], axis=0)
    reached = np.linalg.matrix_power(goes | np.eye(6, dtype=bool), 6)
    return {dof for i, dof in enumerate(DOFS) if any(reached[DOFS.index(name), i] for name in moved)}


def stable_modes(model: Model, moved: Collection[str] = DOFS) -> Modes:
    """Natural modes about the equilibrium of a platform that stays there.

    Args:
        model: The platform.
        moved: Degrees of freedom that are displaced. Others that are not coupled with them may be unstable.

    Raises:
        EquilibriumError: The platform has no equilibrium, or is unstable in it.
        UnknownName: A name is not a degree of freedom.
    """
    for dof in moved:
        if dof not in DOFS:
            raise unknown("degree of freedom", dof, DOFS)
    modes = natural_modes(model)
    if set(modes.unstable) & (set(DOFS) if set(moved) == set(DOFS) else _coupled(model, moved)):
        motions = " and ".join(modes.unstable)
        raise EquilibriumError(f"the platform is unstable in {motions}: check mass, centre of mass, hydrostatics and mooring")
    return modes


def characteristic_length(model: Model) -> float:
    """Radius of gyration (m) in roll and pitch, by which an angle is compared with a displacement."""
    mass, (x, y, z), inertia = float(model.body.mass), np.asarray(model.body.centre), np.asarray(model.body.inertia)
    roll, pitch = inertia[0, 0] + mass * (y**2 + z**2), inertia[1, 1] + mass * (x**2 + z**2)  # parallel-axis theorem
    return float(np.sqrt(0.5 * (roll + pitch) / mass))
