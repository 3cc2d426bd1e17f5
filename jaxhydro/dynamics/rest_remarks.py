"""Remarks on a platform's rest position, and on loads that waves do not reach."""

import math

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.static_forces import forces_by_load
from jaxhydro.dynamics.statics import linearised
from jaxhydro.environment import DOFS
from jaxhydro.loads.wave_drift import WaveDrift
from jaxhydro.remarks import Remark

MAX_REST_HEAVE = 0.1  # of the draught: heave at rest from which the platform does not rest as it was drawn
MAX_REST_TILT = math.radians(3.0)
RESTORING_KEYS = {"heave": "C33", "roll": "C44", "pitch": "C55"}  # of a platform file's `hydrostatics`
NO_STIFFNESS = 1e-9  # over the weight, per m or times m: a smaller stiffness is none


def rest_remarks(model: Model, rest: Float[Array, "6"]) -> list[Remark]:
    """Warning where the platform rests far above, below or aslant of its reference position.

    Args:
        model: The platform.
        rest: Position of rest (m, rad), (6,).
    """
    position = np.asarray(rest)
    lowest = float(np.min(np.asarray(model.hull.extremities())[2], initial=0.0))
    remarks = []
    if lowest < 0 and abs(position[2]) > -MAX_REST_HEAVE * lowest:
        vertical = {name: float(force[2]) / 1e6 for name, force in forces_by_load(model, jnp.zeros(6)).items() if force[2]}
        sums = ", ".join(f"{name} {value:+.5g} MN" for name, value in vertical.items())
        where = f"{abs(position[2]):.3g} m {'above' if position[2] > 0 else 'below'} the reference position"
        remarks.append(Remark(f"the platform rests {where}. Vertical forces there: {sums}", warning=True))
    for i in (3, 4):
        if abs(position[i]) > MAX_REST_TILT:
            angle = math.degrees(position[i])
            text = f"the platform rests with a {DOFS[i]} of {angle:.3g} deg: check centre of mass and ballast"
            remarks.append(Remark(text, warning=True))
    return remarks


def unrestored_motions(model: Model, rest: Float[Array, "6"]) -> dict[str, str]:
    """Heave, roll and pitch that nothing but the weight restores, where the platform has no members.

    Args:
        model: The platform.
        rest: Position of rest (m, rad), (6,).

    Returns:
        Key of a platform file that would state what restores, by motion.
    """
    if model.hull.strips.element:
        return {}
    stiffness = np.diagonal(np.asarray(linearised(model, rest)[1]))
    weight = float(model.body.mass * model.environment.gravity)
    of_weight = -weight * float(model.body.centre[2])
    others = {"heave": stiffness[2], "roll": stiffness[3] - of_weight, "pitch": stiffness[4] - of_weight}
    return {dof: RESTORING_KEYS[dof] for dof, other in others.items() if abs(other) <= NO_STIFFNESS * weight}


def restoring_remarks(model: Model, rest: Float[Array, "6"]) -> list[Remark]:
    """Warning on `unrestored_motions`, if there are any.

    Args:
        model: The platform.
        rest: Position of rest (m, rad), (6,).
    """
    bare = unrestored_motions(model, rest)
    motions, keys = " and ".join(bare), " or ".join(bare.values())
    text = f"buoyancy does not restore {motions}: the platform file has no members and no {keys}"
    return [Remark(text, warning=True)] if bare else []


def wave_remarks(model: Model) -> list[Remark]:
    """Warning where waves act on no load of the model.

    Such a model has no strips, and no excitation or drift table.
    """
    drifts = any(isinstance(load, WaveDrift) for load in model.loads)
    if model.hull.strips.element or drifts or model.excitation is not None or model.transfer is not None:
        return []
    text = "waves do not act on this platform: it has no members, and no excitation or drift table"
    return [Remark(text, warning=True)]
