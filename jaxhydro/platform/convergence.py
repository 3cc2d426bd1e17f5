"""Convergence of motions with the number of load elements."""

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import NamedTuple

import numpy as np
from jaxtyping import Array, Float

from jaxhydro.choices import unknown
from jaxhydro.dynamics.integrate import Method
from jaxhydro.dynamics.simulate import simulate
from jaxhydro.dynamics.statics import natural_modes
from jaxhydro.environment import DOFS
from jaxhydro.platform.build import build
from jaxhydro.platform.schema import Platform, load_platform
from jaxhydro.waves.sea import AbstractSea


class Convergence(NamedTuple):
    """Motions by number of load elements.

    Attributes:
        elements: Numbers of load elements, in the order asked for, (n,).
        integral: Band integral of the spectrum (m² or rad²) by degree of freedom and band of `analysis.bands`, (n,).
        difference: Root mean square difference from the finest, over the standard deviation (-), by degree of freedom, (n,).
        period: Undamped natural period (s) by degree of freedom, (n,).
    """

    elements: tuple[int, ...]
    integral: dict[str, dict[str, Float[np.ndarray, " n"]]]
    difference: dict[str, Float[np.ndarray, " n"]]
    period: dict[str, Float[np.ndarray, " n"]]

    def change(self, dof: str, band: str) -> Float[np.ndarray, " n"]:
        """Relative difference (-) of a band integral from that with most elements, (n,).

        Args:
            dof: Name of the motion.
            band: Name of the band.
        """
        values = self.integral[dof][band]
        return values / values[int(np.argmax(self.elements))] - 1


def with_elements(platform: Platform, group: str, elements: int, points: int = 2) -> Platform:
    """Platform description with other load elements for one group of members.

    Args:
        platform: Checked contents of a platform file.
        group: Group of members.
        elements: Load elements per member.
        points: Gauss points per load element.

    Raises:
        UnknownName: No member is in the group.
    """
    groups = {member.group for member in platform.members}
    if group not in groups:
        raise unknown("group of members", group, sorted(groups))
    cut = {"elements": elements, "points": points}
    members = tuple(m.model_copy(update=cut) if m.group == group else m for m in platform.members)
    return platform.model_copy(update={"members": members})


def convergence(
    platform: Platform | str | PathLike[str],
    sea: AbstractSea,
    times: Float[Array, " t"] | Float[np.ndarray, " t"],
    *,
    peak_period: float,
    elements: Sequence[int] = (1, 2, 3, 5, 10),
    group: str = "pontoon",
    points: int = 2,
    transient: float = 0.0,
    dofs: Sequence[str] = ("surge", "heave", "pitch"),
    position: Mapping[str, float] | Float[Array, "6"] | None = None,
    rate: Mapping[str, float] | Float[Array, "6"] | None = None,
    step: float | None = None,
    method: Method | None = None,
) -> Convergence:
    """Simulate a sea with several numbers of load elements, and compare the motions.

    Args:
        platform: Platform description, path of a file, or name of a built-in platform.
        sea: The sea.
        times: Output times (s), (t,), even.
        peak_period: Peak period (s), which chooses the frequency bands.
        elements: Numbers of load elements per member.
        group: Group of members that is refined.
        points: Gauss points per load element.
        transient: Time (s) at the start that is left out.
        dofs: Degrees of freedom to compare.
        position: Initial position (m, rad), as in `simulate`.
        rate: Initial rates (m/s, rad/s), as in `simulate`.
        step: Largest time step (s), as in `simulate`.
        method: Integration scheme, as in `simulate`.

    Returns:
        Band integrals, differences and natural periods by number of elements.

    Raises:
        ValueError: An unknown group, an unknown degree of freedom, or a number of elements that is not whole and at least 1.
    """
    from jaxhydro.analysis.motion_bands import bands
    from jaxhydro.analysis.spectral import band_integral, power_spectrum

    if not elements or any(n != int(n) or n < 1 for n in elements):
        raise ValueError(f"numbers of elements are whole and at least 1, found {tuple(elements)}")
    for dof in dofs:
        if dof not in DOFS:
            raise unknown("degree of freedom", dof, DOFS)
    platform = platform if isinstance(platform, Platform) else load_platform(platform)
    after_transient = np.asarray(times) >= float(times[0]) + transient
    time, motions, periods = np.asarray(times)[after_transient], [], []
    for number in elements:
        model = build(with_elements(platform, group, int(number), points))
        modes = natural_modes(model)
        periods.append([modes.of(dof) for dof in dofs])
        motion = simulate(model, times, sea, position=position, rate=rate, step=step, method=method)
        motions.append(np.asarray(motion.position)[after_transient])
    integral: dict[str, dict[str, np.ndarray]] = {}
    difference = {}
    finest = motions[int(np.argmax(elements))]
    for dof in dofs:
        i = DOFS.index(dof)
        spectra = [power_spectrum(time, motion[:, i]) for motion in motions]
        integral[dof] = {
            name: np.array([band_integral(spectrum, *band) for spectrum in spectra])
            for name, band in bands(dof, peak_period).items()
        }
        apart = [float(np.std(motion[:, i] - finest[:, i])) for motion in motions]
        difference[dof] = np.array(apart) / max(float(finest[:, i].std()), 1e-300)
    period = {dof: np.array([row[i] for row in periods], float) for i, dof in enumerate(dofs)}
    return Convergence(tuple(int(n) for n in elements), integral, difference, period)
