"""First-order wave forces from a table, around strips that keep their second-order forces.

The table is that of a radiation-diffraction program.
"""

from typing import ClassVar

import equinox as eqx
from jaxtyping import Array, Float

from jaxhydro.loads.abstract_excitation import AbstractExcitation
from jaxhydro.loads.forces_at_rest import ForcesAtRest, Part
from jaxhydro.parameters import parameter

Key = tuple[Part, str, str]
"""Part of `ForcesAtRest`, group and kind (t, z) of a coefficient."""


class DiffractionCorrection(AbstractExcitation):
    """Difference between a table's first-order wave force and that of the strips at rest.

    F_i(t) = s Re sum_k (X_i(w_k) - S_i(w_k)) A_k exp(i (w_k t - k x)), in earth axes (Newman 1977, section 6.15). X is that
    of the table. S is that of strips and ends of the upright platform in still water up to its waterline. With s = 1 the
    first-order force is the table's, whatever the added-mass coefficients are. The strips' second-order forces stay: strips
    move with the platform, are wet up to the surface, and may have `SlenderBodyForces`. So no table of drift belongs beside
    it.

    S is linear in coefficients c_j, which are Ca of strips and ends, and the share of covered ends: S = S_0 + sum_j c_j S_j.
    The `excitation` has the rows of X - S_0, then those of S_j for all `coefficients`. The load itself is s (X - S_0); strips
    and ends take s c_j S_j off.

    x is where the platform is horizontally, its motion in the waves left out, as for `ComputedExcitation`.
    """

    share: Float[Array, ""] = parameter("-", "share of the correction of the strips' excitation by computed forces", -0.5, 2.0)
    coefficients: tuple[Key, ...] = eqx.field(static=True, default=())
    source: ClassVar[str] = "Newman 1977, Marine Hydrodynamics, section 6.15; strips at rest subtracted: the package's own"

    def forces_at_rest(self, excitation: Float[Array, " k"] | None) -> ForcesAtRest | None:
        if excitation is None:
            return None
        rows = self.share * excitation.reshape(-1, 6)[1:]
        parts: dict[str, dict[tuple[str, str], Array]] = {part: {} for part in ForcesAtRest._fields}
        for (part, group, kind), row in zip(self.coefficients, rows, strict=True):
            parts[part][group, kind] = row
        return ForcesAtRest(**parts)
