"""Schema of 6 x 6 matrices that a platform file states by their entries, such as B15."""

from typing import Annotated, ClassVar, Generic, Self, TypeVar

import numpy as np
from jaxtyping import Float
from pydantic import AfterValidator, RootModel, model_validator

from jaxhydro.errors import Faults, Problem, shown
from jaxhydro.input_schema import Number

Matrix6 = Float[np.ndarray, "6 6"]


def _key(letter: str, diagonal: bool = False) -> AfterValidator:
    keys = [f"{letter}{i}{j}" for i in range(1, 7) for j in range(1, 7) if i == j or not diagonal]

    def check(key: str) -> str:
        if key not in keys:
            kind = "diagonal entries" if diagonal else "entries"
            raise Faults(Problem("", f"a key among the {kind} {keys[0]} to {keys[-1]}", shown(key)))
        return key

    return AfterValidator(check)


Key = TypeVar("Key", bound=str)


class Entries(RootModel[dict[Key, Number]], Generic[Key], frozen=True):
    """Entries of a 6 x 6 matrix by name, such as B15 in row 1 and column 5; the others are 0."""

    root: dict[Key, Number] = {}
    dissipative: ClassVar[bool] = False

    @model_validator(mode="after")
    def _takes_energy(self) -> Self:
        negative = [key for key, value in self.root.items() if self.dissipative and key[1] == key[2] and value < 0.0]
        if negative:
            raise Faults(*(Problem(key, "a number >= 0", shown(self.root[key])) for key in negative))
        return self

    def matrix(self) -> Matrix6:
        """The matrix, (6, 6); where only one of ij and ji is given, the other is equal."""
        matrix = np.zeros((6, 6))
        named = {(int(key[1]) - 1, int(key[2]) - 1): value for key, value in self.root.items()}
        for (i, j), value in named.items():
            matrix[i, j] = value
            matrix[j, i] = named.get((j, i), value)
        return matrix


class Damping(Entries[Key], Generic[Key], frozen=True):
    """Entries of a damping matrix, not negative on the diagonal."""

    dissipative: ClassVar[bool] = True


LinearDamping = Damping[Annotated[str, _key("B")]]  # N s/m, N s, N m s/rad
QuadraticDamping = Damping[Annotated[str, _key("B", diagonal=True)]]  # N s2/m2, N m s2/rad2
AddedMass = Entries[Annotated[str, _key("A")]]  # kg, kg m, kg m2
Stiffness = Entries[Annotated[str, _key("C")]]  # N/m, N/rad, N m/rad


def entries_of(letter: str, matrix: Matrix6) -> dict[str, float]:
    """Entries of a matrix (6, 6) that are not 0, by name, such as B15 with the letter B."""
    return {f"{letter}{i + 1}{j + 1}": float(matrix[i, j]) for i in range(6) for j in range(6) if matrix[i, j] != 0.0}
