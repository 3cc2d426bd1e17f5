"""Nonlinear hydrostatic restoring, and heave-dependent pitch stiffness."""

from collections.abc import Sequence
from typing import Any, ClassVar, Self

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.per_dof import about, all_dofs, both_units, dofs_of, dofs_only, entries, nulls
from jaxhydro.parameters import Parameter

PARAMETERS = {
    "even_quadratic": both_units("N/m2", "N m/rad2", "force in {dof} with the square of the displacement, always the same way"),
    "cubic": both_units("N/m3", "N m/rad3", "restoring in {dof} with the third power of the displacement"),
    "quintic": both_units("N/m5", "N m/rad5", "restoring in {dof} with the fifth power of the displacement"),
    "pitch_squared": both_units(
        "N/rad2", "", "pitch stiffness per metre of heave, and force in {dof} with the square of pitch"
    ),
}
HEAVE_ONLY_PARAMETERS = ("even_quadratic", "pitch_squared")


class NonlinearHydrostatics(AbstractLoad):
    """Nonlinear hydrostatic restoring in heave, roll and pitch.

    F_i = -(C2 x^2 + C3 x^3 + C5 x^5) in heave, roll, pitch, and from U = D z theta^2/2: F3 = -D theta^2/2, F5 = -D z theta.

    x is the displacement along earth axes (m, rad) from the reference position, z heave, theta pitch; C2 is for heave alone,
    where the waterplane grows or shrinks with draught. It is what the model's buoyancy lacks: members that are wetted
    instantaneously have their own geometry's share of it already, a stiffness matrix has none.

    D is the change of pitch stiffness per metre of heave, d(rho g V GM)/dz: heave at twice the natural frequency of pitch
    makes pitch grow, Mathieu's instability (Haslum and Faltinsen 1999, OTC 10953). Roll with C3 of a wall-sided hull, GZ =
    (GM + BM/2 tan^2) sin (Barrass and Derrett, Ship Stability for Masters and Mates, the wall-sided formula), has, by
    expansion and beyond rho g V GM x, C3 = rho g V (BM/2 - GM/6) and C5 = rho g V (BM/4 + GM/120): within 1 % of GZ at 30
    degrees where BM = 2 GM.

    Haslum and Faltinsen 1999, OTC 10953, for the coupling; polynomials are empirical, and good only within what they were
    fitted to. Labels are `nonlinear_hydrostatics.heave.even_quadratic`, `.heave.pitch_squared`, and `.cubic`, `.quintic` for
    all three.
    """

    values: dict[str, Float[Array, ""]]
    source: ClassVar[str] = "Haslum and Faltinsen 1999, OTC 10953"

    @classmethod
    def null(cls, dofs: Sequence[str] = ("heave", "roll", "pitch")) -> Self:
        """Load at its neutral value, in some of heave, roll and pitch."""
        if wrong := set(dofs) - {"heave", "roll", "pitch"}:
            raise ValueError(f"nonlinear hydrostatics are those of heave, roll and pitch, found {sorted(wrong)[0]!r}")
        every = nulls("nonlinear_hydrostatics", dofs, PARAMETERS)
        return cls({k: v for k, v in every.items() if "heave" in k or not k.endswith(HEAVE_ONLY_PARAMETERS)})

    def about(self, label: str) -> Parameter:
        return about(label, PARAMETERS)

    def act(self, now: Instant, memory: Any) -> Action:
        x = dofs_only(now.position, self.values)
        even, cubic, quintic = (entries(self.values, name, 0.0) for name in ("even_quadratic", "cubic", "quintic"))
        force = all_dofs(-(even + cubic * x + quintic * x**3) * x**2, self.values)
        if "heave" in dofs_of(self.values):
            heave, pitch = now.position[2], now.position[4]
            product = entries(self.values, "pitch_squared", 0.0)[0]  # heave is the first of the three
            zero = jnp.zeros_like(heave)
            force = force - product * jnp.stack([zero, zero, pitch**2 / 2, zero, heave * pitch, zero])
        return Action(force=force)
