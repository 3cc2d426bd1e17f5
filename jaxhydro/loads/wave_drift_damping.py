"""Wave-drift damping, proportional to the squared wave height."""

from typing import Any, ClassVar

from jaxhydro.loads.base import Action
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.per_dof import AbstractLoadPerDof, PerDof, by_dof

STEADY = "share of it in {dof} that goes with the waves' mean square, not their envelope"


class WaveDriftDamping(AbstractLoadPerDof):
    """Damping of slow motion proportional to the squared wave height.

    F_i = -alpha_i (s_i Hs^2/8 + (1 - s_i) |a|^2) v_i along body axes. a is the complex elevation of the undisturbed waves at
    the origin, eta = Re a. Hs^2/8 is the mean of |a|^2.

    A slow velocity changes the mean second-order force. To first order in the velocity this is a damping that goes with the
    square of the wave's amplitude. Here it is one number per degree of freedom, whatever the frequency of the waves. It is
    on the whole velocity where theory has the slow one: alpha counts what it takes from wave-frequency motion.

    `steady` (s) is 1 where the damping is that of the sea state, as it is used in practice. It is 0 where the damping comes
    and goes with groups of waves, as Newman's argument for slow drift would have it. |a|^2 holds differences of frequencies
    only. Passive.

    Labels are `wave_drift_damping.surge.coefficient` (alpha; N s/m3, N s/(m rad)) and `.steady` (s; -).

    References:
        Wichers (1982), On the low-frequency surge motions of vessels moored in high seas, OTC 4437; Faltinsen (1990), Sea
        Loads on Ships and Offshore Structures, chapter 5, section on viscous and wave-drift damping.
    """

    coefficient: PerDof = by_dof("N s/m3", "N s/(m rad)", "damping in {dof} per squared wave amplitude", 0.0)
    steady: PerDof = by_dof("-", "-", STEADY, 0.0, 1.0, 1.0)
    source: ClassVar[str] = "Wichers 1982, OTC 4437; Faltinsen 1990, chapter 5"

    def act(self, now: Instant, memory: Any) -> Action:
        if now.drift is None or not self.dofs:
            return Action()
        coefficient, steady = self.entries(self.coefficient), self.entries(self.steady, 1.0)
        square = steady * now.drift[3] + (1 - steady) * now.drift[0]
        return Action(body_force=self.all_dofs(-coefficient * square * self.dofs_only(now.velocity)))
