"""Nonlinear mooring restoring in each degree of freedom."""

from typing import Any, ClassVar

import jax.numpy as jnp

from jaxhydro.loads.base import Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.per_dof import AbstractLoadPerDof, PerDof, by_dof

EVEN = "force in {dof} with the square of the displacement, always the same way"


class MooringNonlinearity(AbstractLoadPerDof):
    """Nonlinear restoring in each degree of freedom, beyond the model's stiffness.

    F_i = -(c2 x |x| + s2 x^2 + c3 x^3), x = x_i the displacement along earth axes (m, rad) from the reference position.

    It is the mooring's restoring beyond the stiffness that the model has. Each degree of freedom has its own potential, so
    no energy is lost, and surge does not stiffen by sway. c2 changes the period with the first power of the amplitude, c3
    with the second. s2 shifts the mean: a mooring with one line fore and two aft has it. Polynomials are good within the
    displacements that they were fitted to, and with a negative sign unstable beyond some. x counts from the reference
    position, not from the equilibrium: with a mean offset, all three change the stiffness there.

    Nayfeh and Mook 1979, Nonlinear Oscillations, chapter 2, systems with quadratic and cubic nonlinearities. Labels are
    `mooring_nonlinearity.surge.odd_quadratic` (c2), `.even_quadratic` (s2), `.cubic` (c3).
    """

    odd_quadratic: PerDof = by_dof("N/m2", "N m/rad2", "stiffening in {dof} with the distance from the reference position")
    even_quadratic: PerDof = by_dof("N/m2", "N m/rad2", EVEN)
    cubic: PerDof = by_dof("N/m3", "N m/rad3", "stiffening in {dof} with the square of the displacement")
    source: ClassVar[str] = "Nayfeh and Mook 1979, Nonlinear Oscillations, chapter 2"

    def act(self, now: Instant, memory: Any) -> Action:
        x = self.dofs_only(now.position)
        odd, even, cubic = (self.entries(mapping, 0.0) for mapping in (self.odd_quadratic, self.even_quadratic, self.cubic))
        return Action(force=self.all_dofs(-(odd * jnp.abs(x) + even * x + cubic * x**2) * x))
