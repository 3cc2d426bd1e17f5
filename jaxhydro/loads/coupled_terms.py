"""Symmetric damping, stiffness and added mass between two degrees of freedom."""

from typing import Any, ClassVar

from jaxtyping import Array, Float

from jaxhydro.environment import DOFS
from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.matrix import Entries, assemble, row_and_column, unit
from jaxhydro.parameters import Parameter, parameters


def _coupling(symbol: str, quantity: str) -> Any:
    """Field of a load with one parameter for each pair of degrees of freedom, such as B15."""

    def about(load: Any, key: str) -> Parameter:
        i, j = row_and_column(key)
        return Parameter(unit(symbol, key), f"{quantity} that couples {DOFS[i]} and {DOFS[j]}")

    return parameters(about, "{prefix}.{key}")


def _symmetric(entries: Entries) -> Float[Array, "6 6"]:
    matrix = assemble(entries)
    return matrix + matrix.T


class CoupledDamping(AbstractLoad):
    """Symmetric linear damping between pairs of degrees of freedom.

    F_i = -B_ij v_j, F_j = -B_ij v_i along body axes: what velocity in one motion takes from another, the same both ways.

    Symmetry is that of potential damping, and of a damper at a height z: B15 = z B11. Beyond sqrt(B_ii B_jj) of all damping it
    gives energy. Labels are `coupled_damping.B15` and so on.

    References:
        Faltinsen 1990, Sea Loads on Ships and Offshore Structures, chapter 3.
    """

    entries: Entries = _coupling("B", "linear damping")
    source: ClassVar[str] = "Faltinsen 1990, chapter 3"

    def act(self, now: Instant, memory: Any) -> Action:
        return Action(body_force=-_symmetric(self.entries) @ now.velocity)


class CoupledStiffness(AbstractLoad):
    """Symmetric stiffness between pairs of degrees of freedom.

    F_i = -C_ij q_j, F_j = -C_ij q_i, q the displacement of the reference point in earth axes and roll, pitch, yaw: fairleads at
    another height, or a hull that is not symmetric. Labels are `coupled_stiffness.C15` and so on.

    References:
        Jonkman 2007, NREL/TP-500-41958: the linearised mooring system.
    """

    entries: Entries = _coupling("C", "stiffness")
    source: ClassVar[str] = "Jonkman 2007, NREL/TP-500-41958"

    def act(self, now: Instant, memory: Any) -> Action:
        return Action(force=-_symmetric(self.entries) @ now.position)


class CoupledAddedMass(AbstractLoad):
    """Symmetric added mass between pairs of degrees of freedom.

    F_i = -A_ij a_j, F_j = -A_ij a_i in body axes: added mass whose centre is at another height than the strips give. Labels are
    `coupled_added_mass.A15` and so on.

    References:
        Newman 1977, Marine Hydrodynamics, chapter 4, its quadratic terms left out.
    """

    entries: Entries = _coupling("A", "added mass")
    source: ClassVar[str] = "Newman 1977, chapter 4"

    def act(self, now: Instant, memory: Any) -> Action:
        return Action(added_mass=_symmetric(self.entries))
