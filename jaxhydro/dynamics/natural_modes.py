"""Undamped natural modes of a mass and a stiffness matrix: periods, shapes and dominant motions."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from jaxtyping import Array, Float

from jaxhydro.choices import unknown
from jaxhydro.environment import DOFS
from jaxhydro.loads.base import AbstractLoad
from jaxhydro.quick_jit import on_device, quick_jit

if TYPE_CHECKING:
    import pandas as pd

MODE_ITERATIONS, MODE_TOLERANCE = 30, 1e-10  # of squared frequencies
SAME_FREQUENCY = 1e-5  # of squared frequencies: modes closer than this are of one frequency


class Modes(NamedTuple):
    """Undamped natural modes of small motion.

    Attributes:
        period: Natural periods (s), longest first, (m,).
        shape: Mode shapes, (mode, dof); the largest entry is 1.
        unstable: Degrees of freedom in which the platform falls away from rest.
        motion: Degree of freedom with the largest strain energy in each mode.
    """

    period: np.ndarray
    shape: np.ndarray
    unstable: tuple[str, ...]
    motion: tuple[str, ...]

    def number(self, dof: str) -> int | None:
        """Index of the longest mode in which `dof` has the largest strain energy, or None."""
        return self.motion.index(dof) if dof in self.motion else None

    def of(self, dof: str) -> float:
        """Longest period (s) of a mode in which `dof` has the largest strain energy, or NaN.

        Raises:
            UnknownName: The name is not a degree of freedom.
        """
        if dof not in DOFS:
            raise unknown("degree of freedom", dof, DOFS)
        index = self.number(dof)
        return float("nan") if index is None else float(self.period[index])

    def __repr__(self) -> str:
        """Natural periods by motion."""
        from jaxhydro.display.summaries import modes_summary

        return modes_summary(self)

    def _repr_html_(self) -> str:
        from jaxhydro.display.data_frames import modes_html

        return modes_html(self)

    def to_dataframe(self) -> "pd.DataFrame":
        """Natural periods and mode shapes.

        Returns:
            One row for each mode: `motion`, `period_s`, and its shape in `surge` ... `yaw`, the largest entry 1.
        """
        from jaxhydro.display.data_frames import modes_frame

        return modes_frame(self)


def strain_energy(stiffness: Float[Array, "6 6"], vectors: Float[Array, "6 m"]) -> Float[Array, "6 m"]:
    """Fraction of each degree of freedom in the potential energy of modes, (6, m).

    It does not depend on units, and hardly on the height of the reference point. A spar that pitches about a point far below
    still water moves the reference point by more than its angle. Only the angle is restored.

    Args:
        stiffness: Stiffness matrix, (6, 6).
        vectors: Mode shapes, (6, m).
    """
    energy = abs(vectors * (stiffness @ vectors))
    return energy / energy.sum(axis=0)


_strain_energy = quick_jit(strain_energy)


def modes_of(
    mass: Float[np.ndarray, "6 6"],
    stiffness: Float[np.ndarray, "6 6"],
    memories: Sequence[AbstractLoad],
    scale: Float[np.ndarray, "6"],
) -> Modes:
    """Undamped natural modes of a mass and a stiffness matrix.

    Args:
        mass: Mass (kg, kg m, kg m²) with the added mass of infinite frequency, (6, 6).
        stiffness: Stiffness (N/m, N, N m), (6, 6).
        memories: Loads with a linear memory, which add mass that depends on the frequency.
        scale: Factors by which displacements and rotations are compared, (6,).

    Returns:
        Periods, shapes and dominant motions.
    """
    square, vectors = np.linalg.eig(np.linalg.solve(mass, stiffness))
    order = np.argsort(square.real)
    square, vectors = square.real[order], vectors.real[:, order]
    largest = np.abs(square).max()
    _with_memories(memories, scale, mass, stiffness, square, vectors)
    oscillates, falls = square > 1e-10 * largest, square < -1e-6 * largest
    vectors[:, oscillates] = _one_motion_each(square[oscillates], vectors[:, oscillates], scale)
    share = _strain_energy(on_device(stiffness), on_device(vectors[:, oscillates]))
    motion = tuple(DOFS[int(i)] for i in np.argmax(np.asarray(share), axis=0))
    vectors = vectors * scale[:, None]
    shape = vectors[:, oscillates].T
    shape = shape / np.abs(shape).max(axis=1, keepdims=True)
    unstable = sorted({int(np.argmax(np.abs(vector))) for vector in vectors[:, falls].T})
    return Modes(2 * np.pi / np.sqrt(square[oscillates]), shape, tuple(DOFS[i] for i in unstable), motion)


def _with_memories(
    memories: Sequence[AbstractLoad],
    scale: Float[np.ndarray, "6"],
    mass: Float[np.ndarray, "6 6"],
    stiffness: Float[np.ndarray, "6 6"],
    square: Float[np.ndarray, " m"],
    vectors: Float[np.ndarray, "6 m"],
) -> None:
    """Change each mode to that with the added mass of its own frequency; nothing without memories.

    A(omega) - A(infinity) is the imaginary part of the memory's frequency response over omega (Ogilvie 1964; see
    `ComputedRadiation`).

    Args:
        memories: Loads with a linear memory.
        scale: Factors by which displacements and rotations are compared.
        mass: Mass with the added mass of infinite frequency.
        stiffness: Stiffness.
        square: Squared frequencies, in order; those of modes are changed.
        vectors: Mode shapes; those of modes are changed.
    """
    if not memories:
        return
    for i in np.flatnonzero(square > 1e-10 * np.abs(square).max()):
        for _ in range(MODE_ITERATIONS):
            omega = float(np.sqrt(square[i]))
            response = sum(np.asarray(load.retardation(omega)) for load in memories)
            values, shapes = np.linalg.eig(np.linalg.solve(mass + response.imag / omega, stiffness))
            old, new = (
                scale[:, None] * shape / np.linalg.norm(scale[:, None] * shape, axis=0) for shape in (vectors, shapes.real)
            )
            alike = np.abs(old.T @ new)
            # of two modes with nearly one frequency, such as roll and pitch, each takes the shape that the other is less like
            closest = alike.argmax(axis=0) == i
            same = int(np.argmax(np.where(closest, alike[i], 0.0) if closest.any() else alike[i]))
            change = abs(values[same].real - square[i])
            square[i], vectors[:, i] = values[same].real, shapes[:, same].real
            if square[i] <= 0 or change < MODE_TOLERANCE * square[i]:
                break
    order = np.argsort(square)
    square[:], vectors[:] = square[order], vectors[:, order]


def _one_motion_each(
    square: Float[np.ndarray, " m"], vectors: Float[np.ndarray, "6 m"], scale: Float[np.ndarray, "6"]
) -> Float[np.ndarray, "6 m"]:
    """Mode shapes in which modes of one frequency are about one motion each.

    Any mixture of such modes is a mode, such as surge and sway of a symmetric hull.

    Args:
        square: Squared frequencies, in order.
        vectors: Mode shapes.
        scale: Factors by which displacements and rotations are compared.
    """
    shapes = np.array(vectors)
    begin = 0
    for end in range(1, len(square) + 1):
        if end < len(square) and square[end] - square[begin] < SAME_FREQUENCY * square[end]:
            continue
        if end - begin > 1:
            alike = shapes[:, begin:end]
            rest, motions = alike * scale[:, None], []
            for _ in range(end - begin):  # the motion that is largest in what others do not move
                motions.append(int(np.argmax((rest**2).sum(axis=1))))
                along = rest[motions[-1]] / np.linalg.norm(rest[motions[-1]])
                rest = rest - np.outer(rest @ along, along)
            shapes[:, begin:end] = alike @ np.linalg.inv(alike[sorted(motions)])
        begin = end
    return shapes
