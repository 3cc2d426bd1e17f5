"""Wave pressure removed from pontoon ends that water does not reach."""

from typing import Any, ClassVar

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.forces_at_rest import COVERED, taken_off
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import parameter


class CoveredEnds(AbstractLoad):
    """Removal of the wave pressure on pontoon ends that are covered by a column.

    f = c p A on every end of a pontoon, along it: takes the share c of the dynamic pressure there away again.

    A pontoon's end that meets a column is not wet. Pressure on it is still right where the column is loaded as if it were
    whole. The two then make up the Froude-Krylov force of the volume that both fill. That is c = 0, the default, as in
    OpenFAST HydroDyn for members that end in no common joint. Strip models that load members only across their axes
    have c = 1. The difference is the force along the pontoons: some 15 % of the surge excitation of a VolturnUS-S in long
    waves.
    """

    share: Float[Array, ""] = parameter("-", "share of the waves' pressure on the ends of pontoons that is not there", 0.0, 1.0)
    source: ClassVar[str] = "OpenFAST HydroDyn, Morison module, loads on member ends (what this takes away)"

    def act(self, now: Instant, memory: Any) -> Action:
        flow, ends = now.end_flow, now.hull.ends
        if flow.pressure is None:
            return Action()
        area = jnp.where(ends.radius > 0, 0.0, ends.area)  # 0 on the faces of tapered pontoons
        pressure = now.environment.density * flow.pressure * area * ends.outward * flow.wet
        off = None if now.at_rest is None else taken_off({COVERED: self.share}, now.at_rest.covered_ends)
        return Action(off, end_force=self.share * pressure)
