"""Nonlinear hydrostatic restoring, and heave-dependent pitch stiffness."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any, ClassVar, Self

import jax.numpy as jnp

from jaxhydro.loads.base import Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.per_dof import AbstractLoadPerDof, PerDof, by_dof

EVEN = "force in {dof} with the square of the displacement, always the same way"
PITCH_SQUARED = "pitch stiffness per metre of heave, and force in {dof} with the square of pitch"


class NonlinearHydrostatics(AbstractLoadPerDof):
    """Nonlinear hydrostatic restoring in heave, roll and pitch.

    F_i = -(C2 x^2 + C3 x^3 + C5 x^5) in heave, roll, pitch, and from U = D z theta^2/2: F3 = -D theta^2/2, F5 = -D z theta.

    x is the displacement along earth axes (m, rad) from the reference position, z heave, theta pitch; C2 is for heave alone,
    where the waterplane grows or shrinks with draught. It is what the model's buoyancy lacks: members that are wetted
    instantaneously have their own geometry's share of it already, a stiffness matrix has none.

    D is the change of pitch stiffness per metre of heave, d(rho g V GM)/dz. Heave at twice the natural frequency of pitch
    makes pitch grow: Mathieu's instability (Haslum and Faltinsen 1999, OTC 10953).

    Roll of a wall-sided hull has GZ = (GM + BM/2 tan^2) sin (Barrass and Derrett, Ship Stability for Masters and Mates, the
    wall-sided formula). By expansion, and beyond rho g V GM x, it has C3 = rho g V (BM/2 - GM/6) and C5 = rho g V (BM/4 +
    GM/120). That is within 1 % of GZ at 30 degrees where BM = 2 GM.

    Haslum and Faltinsen 1999, OTC 10953, for the coupling; polynomials are empirical, and good only within what they were
    fitted to. Labels are `nonlinear_hydrostatics.heave.even_quadratic`, `.heave.pitch_squared`, and `.cubic`, `.quintic` for
    all three.
    """

    even_quadratic: PerDof = by_dof("N/m2", "N m/rad2", EVEN)
    cubic: PerDof = by_dof("N/m3", "N m/rad3", "restoring in {dof} with the third power of the displacement")
    quintic: PerDof = by_dof("N/m5", "N m/rad5", "restoring in {dof} with the fifth power of the displacement")
    pitch_squared: PerDof = by_dof("N/rad2", "", PITCH_SQUARED)
    allowed: ClassVar[tuple[str, ...]] = ("heave", "roll", "pitch")
    source: ClassVar[str] = "Haslum and Faltinsen 1999, OTC 10953"

    @classmethod
    def neutral(cls, dofs: Iterable[str] = ("heave", "roll", "pitch"), **values: float | None) -> Self:
        """Load at its neutral value in some of heave, roll and pitch.

        The parameters of heave alone are given to no other.

        Args:
            dofs: Degrees of freedom that it acts in.
            values: Values of parameters, by name, in place of neutral ones; None is ignored.
        """
        load = super().neutral(dofs, **values)
        heave_only = {name: getattr(load, name) for name in ("even_quadratic", "pitch_squared")}
        return replace(
            load, **{name: {k: v for k, v in mapping.items() if k == "heave"} for name, mapping in heave_only.items()}
        )

    def act(self, now: Instant, memory: Any) -> Action:
        x = self.dofs_only(now.position)
        even, cubic, quintic = (self.entries(mapping, 0.0) for mapping in (self.even_quadratic, self.cubic, self.quintic))
        force = self.all_dofs(-(even + cubic * x + quintic * x**3) * x**2)
        if "heave" in self.pitch_squared:
            heave, pitch = now.position[2], now.position[4]
            product = self.pitch_squared["heave"]
            zero = jnp.zeros_like(heave)
            force = force - product * jnp.stack([zero, zero, pitch**2 / 2, zero, heave * pitch, zero])
        return Action(force=force)
