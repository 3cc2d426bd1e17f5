"""Builder of the catalogue, and noticeable sizes by motion."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from calibration.discovery.effects.candidates import Candidate
from calibration.parameters.space import FreeParameter
from calibration.parameters.transforms import LogInterval, Scaled
from jaxhydro.environment import DOFS


@dataclass(frozen=True)
class NoticeableScales:
    """Noticeable sizes in one motion.

    Attributes:
        amplitude: Displacement (m, rad).
        rate: Velocity (m/s, rad/s).
        force: Force (N, N m).
        mass: Moving mass (kg, kg m²).
    """

    amplitude: float
    rate: float
    force: float
    mass: float

    @property
    def period(self) -> float:
        """Natural period (s) of the motion alone, rounded so that compiled programs serve many campaigns."""
        return 2.0 ** (round(10 * math.log2(2 * math.pi * self.amplitude / self.rate)) / 10)


def noticeable_scales(
    mass: np.ndarray, stiffness: np.ndarray, spread: Mapping[str, float], fraction: float = 0.02
) -> dict[str, NoticeableScales]:
    """Noticeable sizes by motion.

    Args:
        mass: Mass matrix of the linear model (6, 6).
        stiffness: Stiffness matrix of the linear model (6, 6).
        spread: Largest measured standard deviation by motion (m, rad).
        fraction: Noticeable fraction of the restoring force.
    """
    scales = {}
    for dof, size in spread.items():
        i = DOFS.index(dof)
        m, c = float(mass[i, i]), float(stiffness[i, i])
        omega = math.sqrt(c / m) if c > 0 else 0.1
        amplitude = math.sqrt(2) * size
        scales[dof] = NoticeableScales(amplitude, omega * amplitude, fraction * max(c, m * omega**2) * amplitude, m)
    return scales


@dataclass(frozen=True)
class CatalogueBuilder:
    """A catalogue in the making.

    Lengths and times are stated for a platform of 20 000 t and scaled by Froude's law.

    Attributes:
        length: Length of the platform over that of one of 20 000 t.
        candidates: Candidates so far.
        free: Their parameters by label.
        noticeable: Noticeable sizes by label.
    """

    length: float = 1.0
    candidates: list[Candidate] = field(default_factory=list)
    free: dict[str, FreeParameter] = field(default_factory=dict)
    noticeable: dict[str, float] = field(default_factory=dict)

    @property
    def time(self) -> float:
        """Ratio of times, and of velocities, to a platform of 20 000 t."""
        return math.sqrt(self.length)

    def add_linear(self, label: str, scale: float, neutral: float = 0.0) -> str:
        """Add a parameter on a linear scale, with its noticeable size; returns the label."""
        self.free[label] = FreeParameter(label, neutral, Scaled(neutral, 1.0), 0.0, math.inf)
        self.noticeable[label] = float(scale)
        return label

    def add_shape(self, label: str, start: float, lower: float, upper: float) -> str:
        """Add a shape parameter on a logarithmic interval; returns the label."""
        transform = LogInterval(lower, upper)
        self.free[label] = FreeParameter(label, start, transform, transform.inverse(start), 0.7)
        return label

    def add(self, effect: str, dof: str | None, amplitudes: Sequence[str], **more: Any) -> None:
        """Add a candidate.

        Args:
            effect: Name of the effect.
            dof: The motion that it acts in, or None.
            amplitudes: Labels of its amplitudes.
            more: Other fields of `Candidate`; `passive=True` requires all amplitudes to be positive.
        """
        positive = more.pop("positive", tuple(amplitudes) if more.pop("passive", False) else ())
        self.candidates.append(Candidate(effect, dof, tuple(amplitudes), positive=tuple(positive), **more))
