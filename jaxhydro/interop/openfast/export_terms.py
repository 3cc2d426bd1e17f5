"""HydroDyn's AddF0, AddCLin, AddBLin and AddBQuad from a model's loads.

F = F0 - C q - B v - Q |v| v. F0 and C are in earth axes, B and Q in body axes, as the loads have them.

References:
    OpenFAST v5.0.0 (2895884), HydroDyn.f90, HydroDyn_CalcOutput (F_PtfmAdd).
"""

import dataclasses
from dataclasses import dataclass, field

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from jaxhydro.dynamics.static_forces import forces_by_load, mooring_stiffness
from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.export_source import ExportSource
from jaxhydro.interop.openfast.export_text import row
from jaxhydro.loads import LinearDamping, MooringLines, QuadraticDamping, RotorThrust, Stiffness, TensionTableLines
from jaxhydro.loads.matrix import assemble

Matrix6 = Float[np.ndarray, "6 6"]


@dataclass
class ExportedTerms:
    """Rows of HydroDyn's additional terms.

    Attributes:
        preload: N, N m, (6,).
        stiffness: N/m, N, N m/rad.
        linear: N s/m, N s, N m s/rad.
        quadratic: N s²/m², N m s²/rad², on the diagonal.
        items: What became of the loads.
    """

    preload: Float[np.ndarray, "6"] = field(default_factory=lambda: np.zeros(6))
    stiffness: Matrix6 = field(default_factory=lambda: np.zeros((6, 6)))
    linear: Matrix6 = field(default_factory=lambda: np.zeros((6, 6)))
    quadratic: Matrix6 = field(default_factory=lambda: np.zeros((6, 6)))
    items: list[ConvertedItem] = field(default_factory=list)

    def rows(self) -> dict[str, list[str]]:
        """Rows of each key, as HydroDyn's file has them."""
        rows = {"AddF0": [row(float(value)) for value in self.preload]}
        matrices = {"AddCLin": self.stiffness, "AddBLin": self.linear, "AddBQuad": self.quadratic}
        return rows | {key: [row(*map(float, line)) for line in matrix] for key, matrix in matrices.items()}


def exported_terms(source: ExportSource) -> ExportedTerms:
    """Additional terms of a platform.

    Args:
        source: The platform.
    """
    terms = ExportedTerms()

    def say(key: str, treatment: Treatment, meaning: str) -> None:
        terms.items.append(ConvertedItem(key, treatment, meaning))

    for load in source.model.loads:
        if isinstance(load, Stiffness):
            terms.stiffness += np.asarray(assemble(load.entries))
            terms.preload += np.asarray(load.preload)
            say(load.name, Treatment.TAKEN, "AddCLin, and the preload as AddF0, in earth axes as here.")
        elif isinstance(load, MooringLines | TensionTableLines):
            lines, upright = dataclasses.replace(source.model, loads=(load,)), jnp.zeros(6)
            force = sum(forces_by_load(lines, upright).values(), np.zeros(6))
            stiffness = np.asarray(mooring_stiffness(lines, upright))
            terms.preload += force
            terms.stiffness += np.where(np.abs(stiffness) > 1e-12 * np.abs(stiffness).max(), stiffness, 0.0)
            kind = "springs" if isinstance(load, MooringLines) else "ropes, whose table OpenFAST has not,"
            text = f"AddF0 and AddCLin: the pull of the straight {kind} and its slope at the reference position."
            say("mooring", Treatment.APPROXIMATED, text)
        elif isinstance(load, LinearDamping):
            terms.linear += np.asarray(assemble(load.entries))
            say("linear_damping", Treatment.TAKEN, "AddBLin, in body axes as here.")
        elif isinstance(load, RotorThrust):
            force, damping = _rotor(load)
            terms.preload += force
            terms.linear += damping
            say(
                "rotor",
                Treatment.APPROXIMATED,
                "AddF0, which does not turn with the platform, and AddBLin. OpenFAST has no wind here.",
            )
        elif isinstance(load, QuadraticDamping):
            terms.quadratic += np.diag(np.diag(np.asarray(assemble(load.entries))))
            say("quadratic_damping", Treatment.TAKEN, "AddBQuad, in body axes as here.")
    return terms


def _rotor(load: RotorThrust) -> tuple[Float[np.ndarray, "6"], Matrix6]:
    """Force (N, N m) of a rotor at rest, upright, and its damping matrix."""
    axis = np.array([1.0, 0.0, 0.0])
    along = np.concatenate([axis, np.cross(np.asarray(load.hub), axis)])
    return float(load.thrust) * along, float(load.damping) * np.outer(along, along)
