"""Stiffness matrix about the reference position, with a preload."""

from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.matrix import Entries, assemble, meaning, unit
from jaxhydro.parameters import Parameter, parameters


class Stiffness(AbstractLoad):
    """Linear stiffness about the reference position, with a preload.

    F = F0 - C q, q the displacement of the reference point in earth axes and roll, pitch, yaw; F0 the preload (N, N m).

    Labels are `mooring.C11` or `stiffness.C11` and so on.
    Jonkman 2007, NREL/TP-500-41958: the linearised mooring system.
    """

    entries: Entries = parameters(lambda load, key: load.about_entry(key), "{prefix}.{key}")
    preload: Float[Array, "6"] = eqx.field(default_factory=lambda: jnp.zeros(6))
    name: str = eqx.field(static=True, default="stiffness")
    source: ClassVar[str] = "Jonkman 2007, NREL/TP-500-41958, the linearised mooring system"

    @property
    def prefix(self) -> str:
        return self.name

    def about_entry(self, key: str) -> Parameter:
        """Unit and meaning of an entry such as C15."""
        quantity = self.name if self.name.endswith("stiffness") else f"{self.name} stiffness"
        return Parameter(unit("C", key), meaning(quantity, "displacement", key))

    def act(self, now: Instant, memory: Any) -> Action:
        return Action(force=self.preload - assemble(self.entries) @ now.position)
