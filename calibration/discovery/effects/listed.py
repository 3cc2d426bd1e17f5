"""What a catalogue lists: candidates, their parameters, and what is noticeable of each of these."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from calibration.discovery.effects.candidates import Candidate
from calibration.parameters.space import Free
from calibration.parameters.transforms import LogInterval, Scaled
from jaxhydro.environment import DOFS


@dataclass(frozen=True)
class NoticeableScales:
    """What is noticeable in one motion: displacement (m, rad), rate, force (N, N m), and moving mass (kg, kg m2)."""

    amplitude: float
    rate: float
    force: float
    mass: float

    @property
    def period(self) -> float:
        """Natural period (s) of the motion alone, to a tenth of its octave: programs compiled for one campaign serve others."""
        return 2.0 ** (round(10 * math.log2(2 * math.pi * self.amplitude / self.rate)) / 10)


def noticeable_scales(
    mass: np.ndarray, stiffness: np.ndarray, spread: Mapping[str, float], fraction: float = 0.02
) -> dict[str, NoticeableScales]:
    """What is noticeable by motion, from the linear model's matrices and the largest standard deviation measured."""
    found = {}
    for dof, size in spread.items():
        i = DOFS.index(dof)
        m, c = float(mass[i, i]), float(stiffness[i, i])
        omega = math.sqrt(c / m) if c > 0 else 0.1
        amplitude = math.sqrt(2) * size
        found[dof] = NoticeableScales(amplitude, omega * amplitude, fraction * max(c, m * omega**2) * amplitude, m)
    return found


@dataclass(frozen=True)
class CatalogueBuilder:
    """What is listed so far: candidates, their parameters, and what is noticeable of each of these. `length` is the platform's
    over that of one of 20 000 t, for which lengths and frequencies are stated: Froude's law has them of another, or of a model
    that is declared at its own scale."""

    length: float = 1.0
    candidates: list[Candidate] = field(default_factory=list)
    free: dict[str, Free] = field(default_factory=dict)
    noticeable: dict[str, float] = field(default_factory=dict)

    @property
    def time(self) -> float:
        """Times over those of a platform of 20 000 t, and speeds."""
        return math.sqrt(self.length)

    def add_linear(self, label: str, scale: float, null: float = 0.0) -> str:
        self.free[label] = Free(label, null, Scaled(null, 1.0), 0.0, math.inf)
        self.noticeable[label] = float(scale)
        return label

    def add_shape(self, label: str, start: float, lower: float, upper: float) -> str:
        transform = LogInterval(lower, upper)
        self.free[label] = Free(label, start, transform, transform.inverse(start), 0.7)
        return label

    def add(self, effect: str, dof: str | None, amplitudes: Sequence[str], **more: Any) -> None:
        positive = more.pop("positive", tuple(amplitudes) if more.pop("passive", False) else ())
        self.candidates.append(Candidate(effect, dof, tuple(amplitudes), positive=tuple(positive), **more))
