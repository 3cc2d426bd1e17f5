"""First-order wave forces from tables of a radiation-diffraction program."""

from collections.abc import Sequence
from typing import Self, TypeAlias

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Complex, Float, Int

from jaxhydro.quick_jit import on_device
from jaxhydro.waves.heading_interpolation import HeadingInterpolation

TABLE_END_TOLERANCE = 1e-4  # of a table's first and last frequency, by which waves may be outside it


class Excitation(eqx.Module):
    """First-order wave force on a platform, F_i = Re sum_k X_i(w_k) A_k exp(i w_k t).

    A_k are the complex amplitudes of first-order waves at the reference point, eta = Re sum A_k exp(i w_k t). Between the
    table's frequencies X is linear, real and imaginary parts apart. Outside them X is zero.

    Attributes:
        omega: Angular frequencies (rad/s), ascending, (n,).
        force: X of surge, sway, heave (N/m), roll, pitch, yaw (N m/m) about the reference point, earth axes, (6, n); of
            several tables one after the other, (6 m, n).

    References:
        Newman (1977), Marine Hydrodynamics, section 6.15; Faltinsen (1990), Sea Loads on Ships and Offshore Structures,
            chapter 3.
    """

    omega: Float[Array, " n"]
    force: Complex[Array, "k n"]

    @classmethod
    def of(cls, omega: Float[np.ndarray, " n"], force: Complex[np.ndarray, "k n"]) -> Self:
        """Excitation from a table.

        Args:
            omega: Angular frequencies (rad/s), (n,).
            force: Forces per wave amplitude (N/m, N m/m), (6, n) or (6 m, n).

        Raises:
            ValueError: Fewer than two frequencies, or frequencies that do not ascend.
        """
        omega, force = np.asarray(omega, float), np.asarray(force, complex)
        rows = len(force) if force.ndim == 2 and len(force) % 6 == 0 else 6
        if omega.ndim != 1 or force.shape != (rows, omega.size) or omega.size < 2 or not (np.diff(omega) > 0).all():
            raise ValueError(f"two ascending frequencies or more and six forces of each, found {omega.shape}, {force.shape}")
        return cls(on_device(omega), on_device(force))

    def towards(self, heading: float) -> "Excitation":
        """The same: a table of one heading."""
        return self

    def at(self, omega: Float[Array, " w"], heading: Float[Array, " w"] | None = None) -> Complex[Array, "6 w"]:
        """X at other frequencies (rad/s), (6, w). It is of one heading, whatever `heading` (rad) is."""
        lower, share, inside = within(self.omega, omega)
        return jnp.where(inside, (1 - share) * self.force[:, lower] + share * self.force[:, lower + 1], 0.0)


class DirectionalExcitation(eqx.Module):
    """First-order wave force on a platform by frequency and heading.

    Between its frequencies it is as `Excitation`.

    Attributes:
        omega: Angular frequencies (rad/s), ascending, (n,).
        by_heading: X (N/m, N m/m) over headings, (6, n) at each (`HeadingInterpolation`).
    """

    omega: Float[Array, " n"]
    by_heading: HeadingInterpolation

    @classmethod
    def of(cls, heading: Float[np.ndarray, " d"], tables: Sequence[Excitation]) -> Self:
        """Excitation from tables of one heading each.

        Args:
            heading: Directions that the waves travel to (rad), (d,).
            tables: A table of each heading, all of the same frequencies.

        Raises:
            ValueError: Frequencies differ.
        """
        omega = np.asarray(tables[0].omega)
        if any(table.omega.shape != omega.shape or not np.allclose(table.omega, omega, rtol=1e-6, atol=0) for table in tables):
            raise ValueError("the same frequencies for all headings expected, found others")
        return cls(tables[0].omega, HeadingInterpolation.of(heading, np.stack([np.asarray(table.force) for table in tables])))

    def towards(self, heading: float) -> Excitation:
        """The table of waves of one heading (rad)."""
        return Excitation(self.omega, self.by_heading.at(heading))

    def at(self, omega: Float[Array, " w"], heading: Float[Array, " w"]) -> Complex[Array, "6 w"]:
        """X of waves of some frequencies (rad/s) and headings (rad), one heading each, (6, w)."""
        lower, share, inside = within(self.omega, omega)
        index, offset = self.by_heading.locate(heading)

        def column(row: Int[Array, " w"]) -> Complex[Array, "6 w"]:
            cubic = self.by_heading.coefficient[:, index, :, row]  # (w, 4, 6)
            powers = jnp.stack([offset**3, offset**2, offset, jnp.ones_like(offset)], axis=1)
            return jnp.einsum("wpi,wp->iw", cubic, powers)

        return jnp.where(inside, (1 - share) * column(lower) + share * column(lower + 1), 0.0)


AnyExcitation: TypeAlias = Excitation | DirectionalExcitation


def within(
    table: Float[Array, " n"], omega: Float[Array, " w"]
) -> tuple[Int[Array, " w"], Float[Array, " w"], Bool[Array, " w"]]:
    """Place of frequencies in a table: index below, fraction of the way to the next, and whether inside.

    A frequency outside by less than `TABLE_END_TOLERANCE` counts as the end of the table: periods are written with few digits.

    Args:
        table: Frequencies of the table (rad/s), ascending, (n,).
        omega: Frequencies to look up (rad/s), (w,).
    """
    inside = (omega >= table[0] * (1 - TABLE_END_TOLERANCE)) & (omega <= table[-1] * (1 + TABLE_END_TOLERANCE))
    lower = jnp.clip(jnp.searchsorted(table, omega, side="right") - 1, 0, len(table) - 2)
    share = (omega - table[lower]) / (table[lower + 1] - table[lower])
    return lower, jnp.clip(share, 0.0, 1.0), inside
