"""What a panel program's results say of a platform, whichever program they are of."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.radiation_coefficients import RadiationCoefficients
from jaxhydro.waves.excitation import Excitation

DENSITY, GRAVITY = 1025.0, 9.80665  # kg/m3, m/s2, where results do not say


@dataclass
class PanelCase:
    """Tables of one body, and what stands beside them.

    Attributes:
        program: Name of the program.
        name: Name of the platform.
        density: Of the water (kg/m³); None: not stated.
        gravity: Acceleration (m/s²); None: not stated.
        depth: Of the water (m), infinity where it is deep; None: not stated.
        keys: Entries of the platform file: `hydrostatics`, `radiation`, `excitation`, `drift`.
        files: Name beside the platform file -> file.
        coefficients: Contents of `radiation`, or None.
        force: Contents of `excitation` for one heading, or None.
        volume: Displaced volume (m³), or None.
        centre: Centre of mass (m), or None.
        mass: Mass matrix about the reference point (kg, kg m, kg m²), (6, 6), or None.
        linear: Linear damping that was stated beside the tables (N s/m, N s, N m s), (6, 6), or None.
        quadratic: Quadratic damping, likewise (N s²/m², N m s²), (6, 6), or None.
        stiffness: Stiffness of moorings and the like (N/m, N, N m), (6, 6), or None.
        items: What became of the source.
    """

    program: str
    name: str
    density: float | None = None
    gravity: float | None = None
    depth: float | None = None
    keys: dict[str, dict[str, Any]] = field(default_factory=dict)
    files: dict[str, Path] = field(default_factory=dict)
    coefficients: RadiationCoefficients | None = None
    force: Excitation | None = None
    volume: float | None = None
    centre: Float[np.ndarray, "3"] | None = None
    mass: Float[np.ndarray, "6 6"] | None = None
    linear: Float[np.ndarray, "6 6"] | None = None
    quadratic: Float[np.ndarray, "6 6"] | None = None
    stiffness: Float[np.ndarray, "6 6"] | None = None
    items: list[ConvertedItem] = field(default_factory=list)

    def say(self, source: str, treatment: Treatment, meaning: str, warning: bool = False) -> None:
        """Add what became of an item of the source."""
        self.items.append(ConvertedItem(source, treatment, meaning, warning))

    def water(self) -> tuple[float, float]:
        """Density (kg/m³) and gravity (m/s²), usual ones where results do not say."""
        return self.density or DENSITY, self.gravity or GRAVITY
