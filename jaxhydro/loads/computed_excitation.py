"""First-order wave forces from a radiation-diffraction program, in place of the strips'."""

from typing import Any, ClassVar

from jaxtyping import Array, Float

from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import parameter
from jaxhydro.waves.excitation import AnyExcitation


class ComputedExcitation(AbstractLoad):
    """First-order wave force from tables, in place of that of the strips.

    F_i(t) = s Re sum_k X_i(w_k) A_k exp(i (w_k t - k x)), of the undisturbed first-order waves where the platform is
    horizontally (`waves_at` of `Model`), along earth axes (`Excitation`; Newman 1977, Marine Hydrodynamics, section 6.15);
    what accelerations and pressures of the water do to strips and ends counts 1 - s.

    s is a share: 1 for the program's own excitation, with drag alone left to the strips, as OpenFAST HydroDyn has a
    potential-flow body (at the platform's mean position, unless ExctnDisp is 1); 0 for that of the strips. What the program
    leaves out the strips then leave out with it: wetting, stretching and bound waves act by drag only. Added mass stays that
    of the members. Of waves that are sent back (`WaveReflection`) the strips alone know. An irregular sea has to be prepared
    with `Model.excitation`.
    """

    excitation: AnyExcitation
    share: Float[Array, ""] = parameter("-", "share of the computed excitation, in place of the strips'", -0.5, 2.0)
    source: ClassVar[str] = "Newman 1977, Marine Hydrodynamics, section 6.15; OpenFAST HydroDyn, WAMIT module (ExctnMod 1)"

    def excitation_table(self) -> AnyExcitation:
        return self.excitation

    def covers(self) -> tuple[str, float, float]:
        return "excitation", float(self.excitation.omega[0]), float(self.excitation.omega[-1])

    def replaces(self) -> Float[Array, ""]:
        return self.share

    def act(self, now: Instant, memory: Any) -> Action:
        if now.end_flow.pressure is None:
            return Action()
        if now.excitation is None:
            raise ValueError("the sea was made without the platform's excitation: prepare it with `Model.excitation`")
        return Action(force=self.share * now.excitation)
