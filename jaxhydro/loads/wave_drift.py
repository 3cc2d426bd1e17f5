"""Slow drift force from the squared envelope of the waves."""

from typing import Any, ClassVar

import jax.numpy as jnp

from jaxhydro.loads.base import Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.per_dof import AbstractLoadPerDof, PerDof, by_dof
from jaxhydro.parameters import Parameter
from jaxhydro.waves.sea import DRIFT_REFERENCE_FREQUENCY


def _about(way: str) -> tuple[Parameter, Parameter]:
    """Parameters of a translation and of a rotation, of a force that goes `way`."""
    force, moment = (f"second-order {quantity} in {{dof}}, {way}" for quantity in ("force", "moment"))
    return Parameter("N/m2", force), Parameter("N m/m2", moment)


WEIGHTED = f"in phase with the squared envelope weighted by (omega/{DRIFT_REFERENCE_FREQUENCY:g})^2"


class WaveDrift(AbstractLoadPerDof):
    """Slow drift force, linear in three squared envelopes of the waves.

    F_i(t) = sum_j D_ij s_j(t), of the undisturbed first-order waves at the origin, along earth axes.

    s_0 = |a|^2 with a the complex elevation, eta = Re a. s_1 is its Hilbert transform, out of phase and of no mean. s_2 =
    Re(a_w conj(a)), the components of a_w weighted by (omega/omega_0)^2, omega_0 = 0.6 rad/s. The law has three real numbers
    per degree of freedom that are fitted to data. The same by a difference-frequency transfer function T and the components'
    complex amplitudes A_k (Faltinsen 1990, Sea Loads on Ships and Offshore Structures, chapter 5):

        F = sum_k sum_l A_k conj(A_l) exp(i (omega_k - omega_l) t) T_kl,
        T_kl = D_i0 - i sign(omega_k - omega_l) D_i1 + D_i2 (omega_k^2 + omega_l^2) / (2 omega_0^2).

    D_i1 = 0 is Newman's approximation, T_kl = (T_kk + T_ll)/2 (Newman 1974, Second-order, slowly-varying forces on vessels
    in irregular waves). Its drift curve is linear in omega^2, T_kk = D_i0 + D_i2 (omega_k/omega_0)^2. The mean force in a
    regular wave of amplitude A is T_kk A^2.

    The platform's displacement from the origin and sums of frequencies are not in it. The velocity's drag up to the surface
    drifts, too, as Hs^3 (viscous drift). That is a look-alike, which the model has by its drag and its wetting. A sea
    without waves, or one that has no `drift`, gives no force.
    """

    envelope: PerDof = by_dof(*_about("in phase with the squared envelope |a|^2"))
    quadrature: PerDof = by_dof(*_about("a quarter of a beat behind the squared envelope"))
    frequency_weighted: PerDof = by_dof(*_about(WEIGHTED))
    source: ClassVar[str] = "Newman 1974; Faltinsen 1990, chapter 5"

    def act(self, now: Instant, memory: Any) -> Action:
        if now.drift is None or not self.dofs:
            return Action()
        parts = jnp.stack([self.entries(mapping, 0.0) for mapping in (self.envelope, self.quadrature, self.frequency_weighted)])
        return Action(force=self.all_dofs(now.drift[:3] @ parts))
