"""Linear and quadratic damping of a model in one motion, by drag coefficient.

The equation is M x'' + B_lin x' + B_quad x'|x'| + C x = 0, M with added mass. So p = B_lin/M and q = B_quad/M of `classical`.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.dynamics.model import Model, State
from jaxhydro.dynamics.statics import equilibrium, linearised, natural_modes, widths
from jaxhydro.environment import DOFS
from jaxhydro.exported_programs import exported_jit
from jaxhydro.waves.sea import StillWater

# m/s, rad/s, times size over pace of the platform: two give both coefficients, the third shows that there is nothing but these
SPEEDS = (0.5, 1.0, 2.0)


@dataclass(frozen=True, eq=False)
class ModelDamping:
    """Damping of a model in one motion.

    Attributes:
        inertia: Mass or moment of inertia with added mass (kg, kg m2).
        linear: B_lin (N s/m, N m s).
        quadratic: B_quad (N s2/m2, N m s2).
        per_coefficient: B_quad per unit of a drag or quadratic damping coefficient, by label. B_quad is linear in them.
    """

    inertia: float
    linear: float
    quadratic: float
    per_coefficient: Mapping[str, float]

    @property
    def rates(self) -> tuple[float, float]:
        """p = B_lin/M (1/s) and q = B_quad/M (1/m, 1/rad), to compare with a fit."""
        return self.linear / self.inertia, self.quadratic / self.inertia


def motion_shape(model: Model, dof: str, position: Float[Array, "6"] | None = None) -> np.ndarray:
    """Find the natural mode with the largest strain energy in a degree of freedom.

    A platform released in pitch also surges: its decay has the inertia and damping of the mode.

    Args:
        model: The model.
        dof: Degree of freedom, such as `pitch`.
        position: (6,) position about which the mode is taken (m, rad); None for the equilibrium.

    Returns:
        (6,) rates of surge ... yaw (m/s, rad/s), 1 for `dof`.

    Raises:
        KeyError: If the degree of freedom is unknown.
        ValueError: If no mode is mainly of `dof`.
    """
    if dof not in DOFS:
        raise KeyError(f"no degree of freedom {dof!r}; there are: {', '.join(DOFS)}")
    modes, index = natural_modes(model, position), DOFS.index(dof)
    if (number := modes.number(dof)) is not None:
        rates = modes.shape[number] / widths(model)
        return rates / rates[index]
    raise ValueError(f"expected a natural mode mainly of {dof}, found none: nothing restores it")


def _resistance(model: Model, position: Array, rates: Array, speeds: Array) -> Array:
    """(k,) generalised force against the motion, its part that is odd in the velocity.

    The rest does no work in a cycle.
    """

    def force(speed: Array) -> Array:
        velocity = model.body_velocity(position, speed * rates)
        rest = model.rest().memory
        now = model.instant(jnp.zeros(()), State(position, velocity, rest), StillWater())
        return model.sum_of_loads(now, rest).force @ model.body_velocity(position, rates)

    return jax.vmap(lambda speed: 0.5 * (force(-speed) - force(speed)))(speeds)


@exported_jit
def _damping(model: Model, position: Array, rates: Array) -> tuple[Array, Array, Array, dict[str, Array]]:
    speeds = jnp.array(SPEEDS) * model.size / model.pace

    def split(values: dict[str, Array]) -> tuple[Array, tuple[Array, Array]]:
        resistance = _resistance(model.with_values(values), position, rates, speeds)
        over = resistance / speeds  # B_lin + B_quad v
        quadratic = (over[2] - over[0]) / (speeds[2] - speeds[0])
        return quadratic, (over[0] - quadratic * speeds[0], over)

    (quadratic, (linear, over)), slopes = jax.value_and_grad(split, has_aux=True)(model.values)
    mass, _ = linearised(model, position)
    body = model.body_velocity(position, rates)
    misfit = jnp.abs(over[1] - linear - quadratic * speeds[1]) / jnp.maximum(jnp.max(jnp.abs(over)), 1e-300)
    return jnp.stack([body @ mass @ body, linear, quadratic]), misfit, over, slopes


def model_damping(
    model: Model, dof: str, position: Float[Array, "6"] | None = None, shape: np.ndarray | None = None
) -> ModelDamping:
    """Compute inertia, linear and quadratic damping of a model in one degree of freedom or shape.

    The force against the motion is taken at three speeds, about and wetted as at `position`. With S = `shape`, M = S M S
    and S F(S v) = B_lin v + B_quad v|v|, generalised to the rate of `dof`. So p = B_lin/M and q = B_quad/M of a small
    decay.

    Radiation damping with a memory is left out, since memories are at rest. High-passed drag therefore counts as that of
    fast motion. Drag that follows the Keulegan-Carpenter number counts as that of a very small number.

    Args:
        model: The model.
        dof: Degree of freedom, such as `pitch`.
        position: (6,) position (m, rad); None for the equilibrium.
        shape: (6,) rates of surge ... yaw where that of `dof` is 1; None: the others are 0.

    Returns:
        Inertia with added mass, B_lin and B_quad.

    Raises:
        KeyError: If the degree of freedom is unknown.
        ValueError: If `shape` does not move `dof`, or damping is neither linear nor quadratic.
    """
    if dof not in DOFS:
        raise KeyError(f"no degree of freedom {dof!r}; there are: {', '.join(DOFS)}")
    rates = np.eye(6)[DOFS.index(dof)] if shape is None else np.asarray(shape, dtype=float)
    if rates.shape != (6,) or rates[DOFS.index(dof)] != 1:
        raise ValueError(f"expected a shape of six rates with 1 for {dof}, found {rates}")
    position = equilibrium(model) if position is None else position
    numbers, misfit, over, slopes = _damping(model, jnp.asarray(position), jnp.asarray(rates))
    if misfit > 1e-6:
        ratios = ", ".join(f"{float(b):.6g} at {v:g}" for b, v in zip(over, SPEEDS))
        raise ValueError(f"expected linear and quadratic damping in {dof}, found force over speed {ratios} m/s or rad/s")
    inertia, linear, quadratic = (float(number) for number in numbers)
    drag = {k: float(b) for k, b in slopes.items() if ".Cd_" in k or k.startswith("quadratic_damping.")}
    return ModelDamping(inertia, linear, quadratic, drag)


def drag_coefficient(model: Model, damping: ModelDamping, label: str, quadratic: float) -> float:
    """Compute the drag coefficient with which a model has a given quadratic damping, all others kept.

    Args:
        model: The model.
        damping: Damping of this model, by `model_damping`.
        label: Name of the drag coefficient.
        quadratic: B_quad (N s2/m2, N m s2), that is q M of a fit.

    Returns:
        The value of the coefficient.

    Raises:
        KeyError: If the label is no drag coefficient.
        ValueError: If the coefficient has no part in the motion.
    """
    if label not in damping.per_coefficient:
        raise KeyError(f"no drag coefficient {label!r}; there are: {', '.join(damping.per_coefficient)}")
    slope = damping.per_coefficient[label]
    if abs(slope) <= 1e-9 * max(map(abs, damping.per_coefficient.values())):
        raise ValueError(f"expected a coefficient that damps this motion, found none of its damping from {label}")
    return float(model.values[label]) + (quadratic - damping.quadratic) / slope
