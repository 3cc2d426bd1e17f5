"""Damping of slow motion that goes with the waves' squared envelope."""

from collections.abc import Sequence
from typing import Any, ClassVar

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.environment import DOFS
from jaxhydro.loads.base import AbstractLoad, Action, Instant, Parameter


class WaveDriftDamping(AbstractLoad):
    """F_i = -alpha_i |a|^2 v_i along body axes, a the complex elevation of the undisturbed waves at the origin, eta = Re a.

    A slow velocity changes the mean second-order force, to first order in it a damping that goes with the square of the
    wave's amplitude (Faltinsen 1990, Sea Loads on Ships and Offshore Structures, chapter 5, section on viscous and
    wave-drift damping). Here one number per degree of freedom, whatever the frequency of the waves, and on the whole
    velocity where theory has the slow one: what it takes from wave-frequency motion is counted in alpha. |a|^2 holds
    differences of frequencies only; in an irregular sea its mean is Hs^2/8. Passive.
    """

    values: dict[str, Float[Array, ""]]
    source: ClassVar[str] = "Faltinsen 1990, chapter 5"

    @classmethod
    def null(cls, dofs: Sequence[str] = ("surge", "heave", "pitch")) -> "WaveDriftDamping":
        """No such damping, in some degrees of freedom."""
        return cls({f"wave_drift_damping.{dof}.coefficient": jnp.zeros(()) for dof in dofs})

    def about(self, label: str) -> Parameter:
        dof = label.split(".")[1]
        unit = "N s/m3" if DOFS.index(dof) < 3 else "N s/(m rad)"
        return Parameter(unit, f"damping in {dof} per squared wave envelope", 0.0)

    def act(self, now: Instant, memory: Any) -> Action:
        if now.drift is None or not self.values:
            return Action()
        dofs = np.array([DOFS.index(label.split(".")[1]) for label in self.values])
        coefficients = jnp.stack([jnp.asarray(value) for value in self.values.values()])
        return Action(body_force=(-coefficients * now.drift[0] * now.velocity[dofs]) @ np.eye(6)[dofs])
