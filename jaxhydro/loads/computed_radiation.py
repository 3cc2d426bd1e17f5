"""Radiation memory (Cummins) from computed damping, all motions coupled."""

import math
from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Complex, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import parameter


class ComputedRadiation(AbstractLoad):
    """Radiation memory force by Cummins' equation, as a state space.

    F = -s int_0^inf K(u) v(t - u) du along body axes, K(t) = 2/pi int_0^inf B(omega) cos(omega t) d omega (Cummins 1962). With
    `directions` "earth" of the model's conventions it is along earth axes, as in OpenFAST.

    v is the velocity of the reference point (m/s) and the angular velocity (rad/s). B is the radiation damping of potential
    theory, all 36 entries, about the same point. s is the share of the force, complete at 1. K is that of a state space
    (`retardation.realise`):

        dr/dt = A r + B v,  F = -s C r.

    It gives damping B(omega), and added mass A(omega) - A(infinity) = -1/omega int_0^inf K sin(omega t) dt (Ogilvie 1964).
    Added mass at infinite frequency is not here: it stays the strips' own, or is that of `ComputedAddedMass`. With this load
    `Ca` means added mass at infinite frequency: a `Ca` that was tuned to slow motion counts part of it twice. The law is
    linear: memory of the mean wetted hull, moving with the body. Before t = 0 the platform was at rest.

    Its label is `computed_radiation.share`. A, B and C are constants: another hull has others. `highest` (rad/s) is the last
    frequency that the coefficients were computed at.
    """

    rates: Float[Array, "n n"]
    drive: Float[Array, "n 6"]
    output: Float[Array, "6 n"]
    share: Float[Array, ""] = parameter("-", "share of the computed radiation memory, which at 1 is complete", 0.0, 2.0)
    highest: float = eqx.field(static=True, default=math.inf)
    source: ClassVar[str] = "Cummins 1962, Schiffstechnik 9, 101-109"

    def rest(self) -> Float[Array, " n"]:
        return jnp.zeros(self.rates.shape[-1])

    def fastest(self) -> float:
        return float(np.abs(np.linalg.eigvals(np.asarray(self.rates))).max())

    def covers(self) -> tuple[str, float, float] | None:
        return None if math.isinf(self.highest) else ("radiation", 0.0, self.highest)  # B(0) = 0 is known

    def retardation(self, omega: float) -> Complex[np.ndarray, "6 6"]:
        rates, drive, output = (np.asarray(x) for x in (self.rates, self.drive, self.output))
        return float(self.share) * output @ np.linalg.solve(1j * omega * np.eye(len(rates)) - rates, drive)

    def act(self, now: Instant, memory: Any) -> Action:
        force = now.body_force(-self.share * (self.output @ memory))
        return Action(body_force=force, memory_rate=self.rates @ memory + self.drive @ now.matrix_velocity())
