"""Slow drift force from a computed quadratic transfer function."""

from typing import Any, ClassVar

from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import parameter
from jaxhydro.waves.directional_transfer import AnyTransfer
from jaxhydro.waves.sea import DRIFT_ENTRIES


class DriftTransfer(AbstractLoad):
    """Difference-frequency second-order force from a computed transfer function.

    F_i(t) = s Re sum_kl A_k conj(A_l) exp(i (w_k - w_l) t) T_i(w_k, w_l), of the undisturbed first-order waves at the
    origin, along earth axes: the difference-frequency second-order force of a radiation-diffraction program (`Transfer`).

    s is a share, 1 for the program's own, 0 for none. Beside strips: their relative velocities, wetting and second-order
    waves have second-order forces of their own, which the program's have in part, too (Faltinsen 1990, chapter 5); how much
    of T a model of strips lacks is a question for its records. The platform is taken to be at the origin, as the program has
    it; waves that are `moved` along carry the force with their energy. An irregular sea has to be prepared with
    `Model.transfer`.
    """

    transfer: AnyTransfer
    share: Float[Array, ""] = parameter("-", "share of the computed difference-frequency force", 0.0, 3.0)
    source: ClassVar[str] = "Faltinsen 1990, Sea Loads on Ships and Offshore Structures, chapter 5; Newman 1974"

    def transfer_function(self) -> AnyTransfer:
        return self.transfer

    def covers(self) -> tuple[str, float, float]:
        return "drift", float(self.transfer.omega[0]), float(self.transfer.omega[-1])

    def act(self, now: Instant, memory: Any) -> Action:
        if now.drift is None:
            return Action()
        if now.drift.shape[0] == DRIFT_ENTRIES:
            raise ValueError("the sea was made without the platform's transfer function: prepare it with `Model.transfer`")
        return Action(force=self.share * now.drift[DRIFT_ENTRIES:])
