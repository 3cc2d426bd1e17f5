"""How far motions change with the number of load elements: one simulation for each number, in the same sea."""

from collections.abc import Sequence
from os import PathLike
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Array, Float

from jaxhydro.choices import unknown
from jaxhydro.dynamics.simulate import simulate
from jaxhydro.dynamics.statics import natural_modes
from jaxhydro.environment import DOFS
from jaxhydro.platform.build import build
from jaxhydro.platform.schema import Platform, load_platform
from jaxhydro.waves.sea import AbstractSea


class Convergence(NamedTuple):
    """By number of elements, in the order asked for; by motion, and band of `analysis.bands`.

    `integral` of the spectrum over a band (m2 or rad2), `difference` of the motion from that with most elements (root mean
    square over standard deviation), undamped natural `period` (s).
    """

    elements: tuple[int, ...]
    integral: dict[str, dict[str, Float[np.ndarray, " n"]]]
    difference: dict[str, Float[np.ndarray, " n"]]
    period: dict[str, Float[np.ndarray, " n"]]

    def change(self, dof: str, band: str) -> Float[np.ndarray, " n"]:
        """Band integral over that with most elements, less 1."""
        values = self.integral[dof][band]
        return values / values[int(np.argmax(self.elements))] - 1


def with_elements(platform: Platform, group: str, elements: int, points: int = 2) -> Platform:
    """The platform with the members of a group cut into so many load elements of `points` Gauss points each.

    Raises ValueError for a group that has no members.
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
    **options: Any,
) -> Convergence:
    """Motions in a sea with members of `group` in 1, 2, 3 ... load elements of `points` Gauss points.

    `platform` is one, a file, or a built-in's name; `peak_period` (s) chooses the bands; the first `transient` (s) of the even
    `times` (s) is left out; `options` are those of `simulate`. Raises ValueError for an unknown group or number.
    """
    from jaxhydro.analysis.spectral import band_integral, bands, power_spectrum

    if not elements or any(n != int(n) or n < 1 for n in elements):
        raise ValueError(f"numbers of elements are whole and at least 1, found {tuple(elements)}")
    for dof in dofs:
        if dof not in DOFS:
            raise unknown("degree of freedom", dof, DOFS)
    platform = platform if isinstance(platform, Platform) else load_platform(platform)
    kept = np.asarray(times) >= float(times[0]) + transient
    time, motions, periods = np.asarray(times)[kept], [], []
    for number in elements:
        model = build(with_elements(platform, group, int(number), points))
        modes = natural_modes(model)
        periods.append([modes.of(dof) for dof in dofs])
        motions.append(np.asarray(simulate(model, times, sea, **options).position)[kept])
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
