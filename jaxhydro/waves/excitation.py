"""First-order forces of waves on a platform as a radiation-diffraction program computed them."""

from typing import Self

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Complex, Float, Int

CLOSE = 1e-4  # of a table's first and last frequency, by which waves may be outside it


class Excitation(eqx.Module):
    """F_i = Re sum_k X_i(w_k) A_k exp(i w_k t), A_k the complex amplitudes of first-order waves at the reference point,
    eta = Re sum A_k exp(i w_k t) (Newman 1977, Marine Hydrodynamics, section 6.15; Faltinsen 1990, Sea Loads on Ships and
    Offshore Structures, chapter 3).

    `omega` (n,) in rad/s, ascending; `force` (6, n) is X in N/m and N m/m, of surge, sway, heave, roll, pitch and yaw about the
    reference point, along earth axes. Between the table's frequencies X is linear, real and imaginary parts apart; outside them
    waves do not excite.
    """

    omega: Float[Array, " n"]
    force: Complex[Array, "6 n"]

    @classmethod
    def of(cls, omega: Float[np.ndarray, " n"], force: Complex[np.ndarray, "6 n"]) -> Self:
        """From tables. Raises ValueError for fewer than two frequencies, or where they do not ascend."""
        omega, force = np.asarray(omega, float), np.asarray(force, complex)
        if omega.ndim != 1 or force.shape != (6, omega.size) or omega.size < 2 or not (np.diff(omega) > 0).all():
            raise ValueError(f"two ascending frequencies or more and six forces of each, found {omega.shape}, {force.shape}")
        return cls(jnp.asarray(omega), jnp.asarray(force))

    def at(self, omega: Float[Array, " w"]) -> Complex[Array, "6 w"]:
        """X at other frequencies (rad/s)."""
        place, share, inside = within(self.omega, omega)
        return jnp.where(inside, (1 - share) * self.force[:, place] + share * self.force[:, place + 1], 0.0)


def within(
    table: Float[Array, " n"], omega: Float[Array, " w"]
) -> tuple[Int[Array, " w"], Float[Array, " w"], Bool[Array, " w"]]:
    """Place of frequencies in a table (rad/s): number of the entry before, share of the way to the next, and whether inside.

    What is outside by less than `CLOSE` is at the end: periods are written with few digits.
    """
    inside = (omega >= table[0] * (1 - CLOSE)) & (omega <= table[-1] * (1 + CLOSE))
    place = jnp.clip(jnp.searchsorted(table, omega, side="right") - 1, 0, len(table) - 2)
    share = (omega - table[place]) / (table[place + 1] - table[place])
    return place, jnp.clip(share, 0.0, 1.0), inside
