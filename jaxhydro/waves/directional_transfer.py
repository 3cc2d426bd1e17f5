"""Difference-frequency quadratic transfer functions over wave headings."""

from collections.abc import Sequence
from typing import Self, TypeAlias

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Complex, Float

from jaxhydro.quick_jit import on_device
from jaxhydro.waves.excitation import within
from jaxhydro.waves.heading_interpolation import HeadingInterpolation
from jaxhydro.waves.quadratic_transfer import Transfer


class DirectionalTransfer(eqx.Module):
    """Second-order force at difference frequencies of waves of any one heading of a table.

    Pairs of waves of two headings are not in it. In a sea of several headings it gives a force by Newman's approximation
    only: T_kl = (T_kk + T_ll) / 2, each at the heading of its own wave. Then F = Re(conj(a) b), with a the complex elevation
    and b the sum of T_kk A_k exp(i w_k t).

    Attributes:
        omega: Angular frequencies (rad/s), ascending, (n,).
        by_heading: T (N/m², N m/m²) over headings, (6, n, n) at each; by Newman's approximation its diagonal, (6, n).
        newman: Whether only the diagonal is used.

    References:
        Newman (1974), Second-order, slowly-varying forces on vessels in irregular waves; Marthinsen (1983), The effect of
            short crested seas on second order forces and motions, Int. Workshop on Ship and Platform Motions, Berkeley.
    """

    omega: Float[Array, " n"]
    by_heading: HeadingInterpolation
    newman: bool = eqx.field(static=True)

    @classmethod
    def of(
        cls,
        omega: Float[np.ndarray, " n"],
        heading: Float[np.ndarray, " d"],
        tables: Sequence[Complex[np.ndarray, "6 n n"]],
        newman: bool = False,
    ) -> Self:
        """Transfer function from tables of one heading each.

        Args:
            omega: Angular frequencies (rad/s), ascending, (n,).
            heading: Directions that the waves travel to (rad), (d,).
            tables: T of each heading, (6, n, n); its Hermitian part is used.
            newman: Use the diagonal alone.
        """
        values = np.stack([0.5 * (table + np.conj(np.swapaxes(table, 1, 2))) for table in tables])
        values = np.einsum("dikk->dik", values) if newman else values
        return cls(on_device(omega), HeadingInterpolation.of(heading, values), newman)

    def towards(self, heading: float) -> Transfer:
        """The transfer function of waves of one heading (rad); a plain number, not traced."""
        table = np.asarray(self.by_heading.at(heading))
        if self.newman:
            table = np.einsum("ik,kl->ikl", table, np.eye(table.shape[1]))
        return Transfer.of(np.asarray(self.omega), table, self.newman)

    def of_waves(
        self, omega: Float[Array, " w"], heading: Float[Array, " w"], amplitude: Complex[Array, " w"]
    ) -> Float[Array, "6"]:
        """Force (N, N m) of waves of frequencies (rad/s), headings (rad) and complex amplitudes (m).

        Raises:
            ValueError: Several waves, and the table is not used by Newman's approximation.
        """
        if not self.newman and omega.size > 1:
            raise ValueError(
                "the drift table has no pairs of waves of two headings: `approximation: newman` in the platform file, "
                "or a sea of one heading, expected"
            )
        lower, share, inside = within(self.omega, omega)
        index, offset = self.by_heading.locate(heading)
        cubic = self.by_heading.coefficient
        if not self.newman:
            cubic = jnp.einsum("pdikk->pdik", cubic)
        powers = jnp.stack([offset**3, offset**2, offset, jnp.ones_like(offset)], axis=1)
        below, above = (jnp.einsum("wpi,wp->iw", cubic[:, index, :, column], powers).real for column in (lower, lower + 1))
        drift = jnp.where(inside, (1 - share) * below + share * above, 0.0)
        return (jnp.conj(amplitude.sum()) * (drift @ amplitude)).real


AnyTransfer: TypeAlias = Transfer | DirectionalTransfer
