"""HydroDyn's additional preload, stiffness and damping: AddF0, AddCLin, AddBLin, AddBQuad.

F = F0 - C q - B v - Q |v| v. F0 and C are in earth axes, B and Q in body axes. HydroDyn applies them with PotMod = 1 only.

References:
    OpenFAST v5.0.0 (2895884), HydroDyn.f90, HydroDyn_CalcOutput (F_PtfmAdd).
"""

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.openfast.keyed_file import KeyedFile
from jaxhydro.interop.openfast.mass_parts import tidy

Matrix6 = Float[np.ndarray, "6 6"]


@dataclass
class AddedTerms:
    """Additional forces about the origin.

    Attributes:
        preload: N, N m, (6,).
        stiffness: N/m, N, N m/rad, (6, 6).
        linear: Entries of `linear_damping`.
        quadratic: Entries of `quadratic_damping`.
        items: What became of them.
    """

    preload: Float[np.ndarray, "6"] = field(default_factory=lambda: np.zeros(6))
    stiffness: Matrix6 = field(default_factory=lambda: np.zeros((6, 6)))
    linear: dict[str, float] = field(default_factory=dict)
    quadratic: dict[str, float] = field(default_factory=dict)
    items: list[ConvertedItem] = field(default_factory=list)


def matrix_entries(letter: str, matrix: Matrix6) -> dict[str, float]:
    """Entries of a matrix that are not 0; ij stands for ji too where both are equal."""
    entries = {}
    for i in range(6):
        for j in range(6):
            twin = j < i and matrix[i, j] == matrix[j, i]
            one_sided = matrix[i, j] == 0.0 and matrix[j, i] != 0.0
            if (matrix[i, j] != 0.0 or one_sided) and not twin:
                entries[f"{letter}{i + 1}{j + 1}"] = tidy(matrix[i, j])
    return entries


def to_origin(point: Float[np.ndarray, "3"]) -> Matrix6:
    """Motion of a point (m) from that of the origin: T in T' C T and T' F."""
    x, y, z = point
    transfer = np.eye(6)
    transfer[:3, 3:] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
    return transfer


def read_added_terms(file: KeyedFile, potential_flow: bool) -> AddedTerms:
    """Additional preload, stiffness and damping.

    Args:
        file: HydroDyn's file.
        potential_flow: Whether PotMod is 1.

    Raises:
        InputError: A matrix is broken, or about axes that are turned.
    """
    terms = AddedTerms()
    point = np.array([file.number(f"PtfmRef{axis}t", 0.0) for axis in "xyz"])
    preload = file.vector("AddF0", 6)
    stiffness, linear, quadratic = (file.matrix(key, 6, 6) for key in ("AddCLin", "AddBLin", "AddBQuad"))

    def say(key: str, treatment: Treatment, meaning: str) -> None:
        terms.items.append(ConvertedItem(f"{file.name}: {key}", treatment, meaning))

    arrays = {"AddF0": preload, "AddCLin": stiffness, "AddBLin": linear, "AddBQuad": quadratic}
    if not potential_flow:
        for key, value in arrays.items():
            if value.any():
                say(key, Treatment.LEFT_OUT, "HydroDyn applies it with PotMod = 1 only; it is off in this deck.")
        return terms
    if file.number("PtfmRefztRot", 0.0):
        raise file.wrong(file.line_of("PtfmRefztRot"), "0, axes that are not turned", file.word("PtfmRefztRot"))
    transfer = to_origin(point)
    moved = bool(point.any())
    where = f" It was moved there from ({', '.join(f'{value:g}' for value in point)}) m." if moved else ""
    terms.preload, terms.stiffness = transfer.T @ preload, transfer.T @ stiffness @ transfer
    terms.linear = matrix_entries("B", transfer.T @ linear @ transfer)
    if preload.any() and moved:
        say("AddF0", Treatment.APPROXIMATED, "Moved to the origin; what the preload adds to the stiffness there is left out.")
    elif preload.any():
        say("AddF0", Treatment.TAKEN, "`mooring.preload`.")
    if stiffness.any():
        say("AddCLin", Treatment.TAKEN, f"`mooring.stiffness`, or `stiffness` beside lines, about the origin.{where}")
    if linear.any():
        say("AddBLin", Treatment.TAKEN, f"`linear_damping`, in body axes as in HydroDyn.{where}")
    if quadratic.any() and moved:
        say("AddBQuad", Treatment.LEFT_OUT, "Quadratic damping about another point than the origin has no counterpart.")
    elif quadratic.any():
        diagonal = np.diag(quadratic)
        terms.quadratic = {f"B{i + 1}{i + 1}": tidy(value) for i, value in enumerate(diagonal) if value}
        say("AddBQuad, diagonal", Treatment.TAKEN, "`quadratic_damping`, in body axes as in HydroDyn.")
        if (rest := quadratic - np.diag(diagonal)).any():
            values = ", ".join(f"{key} {value:g}" for key, value in matrix_entries("B", rest).items())
            say("AddBQuad, off the diagonal", Treatment.LEFT_OUT, f"No counterpart: {values}.")
    return terms
