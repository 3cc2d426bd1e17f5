"""Coefficients of the evaluations of the four-step Adams-Bashforth scheme, whose first steps are Runge-Kutta's."""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Int

from jaxhydro.integrators.runge_kutta import RK4

START_STEPS = 3  # steps by RK4, of four evaluations each
STORED_SLOPES = 4 * START_STEPS + 1  # slopes that are remembered


def _nonzero(table: np.ndarray, most: int) -> tuple[np.ndarray, np.ndarray]:
    """Columns and values of the entries of every row that are not zero, which are so many at most."""
    columns = np.argsort(table == 0, axis=1, kind="stable")[:, :most]
    return columns, np.take_along_axis(table, columns, axis=1)


class EvaluationCoefficients:
    """Coefficients of each evaluation: its point y + h `point` . slopes, and the update h `add` . slopes.

    Slopes are counted backwards from the newest, which `add` includes and `point` does not.
    """

    def __init__(self) -> None:
        rows = 4 * START_STEPS + 4  # the last one repeats
        self.point, self.add = np.zeros((rows, STORED_SLOPES)), np.zeros((rows, STORED_SLOPES))
        self.time, self.step = np.zeros(rows), np.zeros(rows, int)
        table = RK4.coefficients()
        for i in range(4 * START_STEPS):
            stage, self.step[i] = i % 4, i // 4
            self.point[i, :stage] = table[stage, :stage][::-1]
            self.time[i] = i // 4 + RK4.nodes[stage]
            if stage == 3:
                self.add[i, :4] = RK4.weights[::-1]
        for i in range(4 * START_STEPS, rows):
            step = i - 4 * START_STEPS + START_STEPS
            self.time[i] = self.step[i] = step
            for back, weight in enumerate((55 / 24, -59 / 24, 37 / 24, -9 / 24)):
                taken = step - back
                self.add[i, i - (4 * taken if taken < START_STEPS else 4 * START_STEPS + taken - START_STEPS)] = weight
        # the same without zeros: how many evaluations ago, and coefficients
        self.point_back, self.point_weight = _nonzero(self.point, 1)
        self.point_back += 1
        self.add_back, self.add_weight = _nonzero(self.add, 4)


EVALUATIONS = EvaluationCoefficients()


def row_of(index: Int[Array, ""]) -> Int[Array, ""]:
    """Row of an evaluation in `EVALUATIONS`, by its number."""
    return jnp.minimum(index, len(EVALUATIONS.time) - 1)


def coefficients_of(index: Int[Array, ""]) -> tuple[Array, Array, Array, Array]:
    """Coefficients `point` and `add` of an evaluation, its time (in steps) and its step, by its number."""
    row = row_of(index)
    later = index - row
    table = EVALUATIONS
    time, step = jnp.array(table.time)[row] + later.astype(float), jnp.array(table.step)[row] + later
    return jnp.array(table.point)[row], jnp.array(table.add)[row], time, step
