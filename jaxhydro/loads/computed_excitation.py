"""First-order wave forces from a radiation-diffraction program, in place of the strips'."""

from typing import ClassVar

from jaxtyping import Array, Float

from jaxhydro.loads.abstract_excitation import AbstractExcitation
from jaxhydro.parameters import parameter


class ComputedExcitation(AbstractExcitation):
    """First-order wave force from tables, in place of that of the strips.

    F_i(t) = s Re sum_k X_i(w_k) A_k exp(i (w_k t - k x)), of the undisturbed first-order waves, along earth axes
    (`Excitation`; Newman 1977, Marine Hydrodynamics, section 6.15). The forces of the water's accelerations and pressures on
    strips and ends count 1 - s.

    x is where the platform is horizontally, its motion in the waves left out (`waves_at` of `Model`, "displaced"); at the
    origin with "mean". A force that follows the motion in the waves has a second-order part, which is in the quadratic
    transfer function, too: here it would count twice (Faltinsen 1990, chapter 5; OpenFAST HydroDyn, ExctnDisp 2). So the
    displacement passes a low-pass filter (`slow_displacement`).

    s is a share: 1 for the program's own excitation, with drag alone left to the strips, as OpenFAST HydroDyn has a
    potential-flow body; 0 for that of the strips. Effects that the program leaves out are left out of the strips, too:
    wetting, stretching and bound waves act by drag only. Added mass stays that of the members, unless `ComputedAddedMass`
    has it. A share s of it is that of the hull wet at rest: the effect of wetting by waves is in the quadratic transfer
    function. Reflected waves (`WaveReflection`) act on the strips alone. An irregular sea has to be prepared with
    `Model.excitation`.

    `corner` is the filter's corner frequency (rad/s). `DiffractionCorrection` leaves the strips their second-order forces.
    """

    share: Float[Array, ""] = parameter("-", "share of the computed excitation, in place of the strips'", -0.5, 2.0)
    source: ClassVar[str] = "Newman 1977, Marine Hydrodynamics, section 6.15; OpenFAST HydroDyn, WAMIT module (ExctnMod 1)"

    def replaces(self) -> Float[Array, ""]:
        return self.share
