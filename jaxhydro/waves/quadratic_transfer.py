"""Difference-frequency quadratic transfer functions, as squared envelopes of filtered waves."""

from typing import Self

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Complex, Float

from jaxhydro.quick_jit import on_device
from jaxhydro.waves.excitation import within

MIN_EIGENVALUE = 1e-6  # of the largest eigenvalue: what is less adds nothing


class Transfer(eqx.Module):
    """Second-order force at difference frequencies, from a quadratic transfer function T.

    F_i = Re sum_kl A_k conj(A_l) exp(i (w_k - w_l) t) T_i(w_k, w_l). A_k are the complex amplitudes of first-order waves at
    the origin, eta = Re sum A_k exp(i w_k t). T is Hermitian, so that T = sum_m e_m u_m conj(u_m)^T and

        F_i(t) = sum_m e_im |sum_k u_im(w_k) A_k exp(i w_k t)|²,

    which costs a Fourier transform per eigenvalue in place of all pairs. Between the frequencies of the table T is bilinear
    in both, outside them zero.

    Attributes:
        omega: Angular frequencies (rad/s), ascending, (n,).
        eigenvalue: e (N/m², N m/m²) of surge ... yaw about the origin, earth axes, (6, m).
        filters: u at the frequencies of the table, (6, m, n).

    References:
        Faltinsen (1990), Sea Loads on Ships and Offshore Structures, chapter 5; Pinkster (1980), Low frequency second order
        wave exciting forces on floating structures, section 2.
    """

    omega: Float[Array, " n"]
    eigenvalue: Float[Array, "6 m"]
    filters: Complex[Array, "6 m n"]

    @classmethod
    def of(cls, omega: Float[np.ndarray, " n"], table: Complex[np.ndarray, "6 n n"], newman: bool = False) -> Self:
        """Transfer function from a table at all pairs of frequencies; its Hermitian part is used.

        Args:
            omega: Angular frequencies (rad/s), ascending, (n,).
            table: T (N/m², N m/m²), (6, n, n).
            newman: Use the diagonal alone, the drift in regular waves: T_kl = (T_kk + T_ll) / 2.

        References:
            Newman (1974), Second-order, slowly-varying forces on vessels in irregular waves.
        """
        table = 0.5 * (table + np.conj(np.swapaxes(table, 1, 2)))
        if newman:
            curve = np.einsum("ikk->ik", table).real
            table = 0.5 * (curve[:, :, None] + curve[:, None, :]).astype(complex)
        value, vector = np.linalg.eigh(table)  # columns
        size = np.abs(value)
        count = max(1, int((size > MIN_EIGENVALUE * size.max(axis=1, keepdims=True)).sum(axis=1).max()))
        largest = np.argsort(-size, axis=1)[:, :count]
        vector = np.take_along_axis(vector, largest[:, None, :], axis=2)
        value = np.take_along_axis(value, largest, axis=1)
        return cls(on_device(omega), on_device(value), on_device(np.swapaxes(vector, 1, 2)))

    def at(self, omega: Float[Array, " w"]) -> Complex[Array, "6 m w"]:
        """Filters at other frequencies (rad/s), (6, m, w)."""
        lower, share, inside = within(self.omega, omega)
        filters = (1 - share) * self.filters[..., lower] + share * self.filters[..., lower + 1]
        return jnp.where(inside, filters, 0.0)

    def towards(self, heading: float) -> "Transfer":
        """The same: a table of one heading."""
        return self

    def of_waves(
        self, omega: Float[Array, " w"], heading: Float[Array, " w"], amplitude: Complex[Array, " w"]
    ) -> Float[Array, "6"]:
        """Force (N, N m) of first-order waves, (6,).

        Args:
            omega: Angular frequencies (rad/s), (w,).
            heading: Ignored: the table is of one heading, whatever theirs.
            amplitude: Complex amplitudes (m), (w,).
        """
        return self.force(self.at(omega) @ amplitude)

    def force(self, filtered: Complex[Array, "6 m ..."]) -> Float[Array, "6 ..."]:
        """Force (N, N m), (6, ...), of filtered waves, (6, m, ...)."""
        square = (filtered * filtered.conj()).real
        return jnp.einsum("im,im...->i...", self.eigenvalue, square)
