"""Nonlinear mooring restoring in each degree of freedom."""

from collections.abc import Sequence
from typing import Any, ClassVar, Self

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.per_dof import about, all_dofs, both_units, dofs_only, entries, nulls
from jaxhydro.parameters import Parameter

PARAMETERS = {
    "odd_quadratic": both_units("N/m2", "N m/rad2", "stiffening in {dof} with the distance from the reference position"),
    "even_quadratic": both_units("N/m2", "N m/rad2", "force in {dof} with the square of the displacement, always the same way"),
    "cubic": both_units("N/m3", "N m/rad3", "stiffening in {dof} with the square of the displacement"),
}


class MooringNonlinearity(AbstractLoad):
    """Nonlinear restoring in each degree of freedom, beyond the model's stiffness.

    F_i = -(c2 x |x| + s2 x^2 + c3 x^3), x = x_i the displacement along earth axes (m, rad) from the reference position.

    What a mooring's tension does beyond the stiffness that the model has. Each degree of freedom has its own potential, so
    no energy is lost, and surge does not stiffen by sway. c2 and c3 change the period with amplitude (by the first power and
    the second), s2 shifts the mean and is what a mooring with one line fore and two aft has. Polynomials: good within the
    displacements that they were fitted to, and with a negative sign unstable beyond some. x counts from the reference
    position, not from the equilibrium: with a mean offset, all three change the stiffness there.

    Nayfeh and Mook 1979, Nonlinear Oscillations, chapter 2, systems with quadratic and cubic nonlinearities. Labels are
    `mooring_nonlinearity.surge.odd_quadratic` (c2), `.even_quadratic` (s2), `.cubic` (c3).
    """

    values: dict[str, Float[Array, ""]]
    source: ClassVar[str] = "Nayfeh and Mook 1979, Nonlinear Oscillations, chapter 2"

    @classmethod
    def null(cls, dofs: Sequence[str]) -> Self:
        """Load at its neutral value, in some degrees of freedom."""
        return cls(nulls("mooring_nonlinearity", dofs, PARAMETERS))

    def about(self, label: str) -> Parameter:
        return about(label, PARAMETERS)

    def act(self, now: Instant, memory: Any) -> Action:
        x = dofs_only(now.position, self.values)
        odd, even, cubic = (entries(self.values, name, 0.0) for name in PARAMETERS)
        return Action(force=all_dofs(-(odd * jnp.abs(x) + even * x + cubic * x**2) * x, self.values))
