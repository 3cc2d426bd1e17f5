"""Reference quantities of a platform and its tests, of which plausible sizes are shares."""

import math
from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np

from calibration.campaign.manifest_sections import IN_WAVES
from calibration.campaign.records import Record
from calibration.discovery.effects.catalogue import REFERENCE_LENGTH
from calibration.discovery.effects.catalogue_builder import NoticeableScales
from calibration.discovery.effects.nearly_known import displaced_length
from jaxhydro.analysis.sea_statistics import record_peak_period
from jaxhydro.dynamics.model import Model
from jaxhydro.environment import DOFS
from jaxhydro.loads.matrix import row_and_column
from jaxhydro.waves.sea import DRIFT_REFERENCE_FREQUENCY

# largest excursion over the amplitude of a sine with the record's standard deviation: 1.3 in a ship's roll decay, 2 to 3.8 in
# decays and seas of semisubmersibles
LARGEST_OVER_SINE = 2.5
POWERS = {"odd_quadratic": 2, "even_quadratic": 2, "cubic": 3, "quintic": 5}  # of the displacement, by name of a coefficient
MIN_OFFSET, MIN_TILT = 0.02, math.radians(2.0)  # of the length, rad: offsets that may be overlooked however small the motion


class Seas(NamedTuple):
    """Waves of the tests, as far as plausible sizes depend on them.

    Attributes:
        peak_period: Peak period (s) of the highest sea.
    """

    peak_period: float

    @classmethod
    def of(cls, records: Iterable[Record], low: float = 0.0, cutoff: float = math.inf) -> "Seas | None":
        """The highest sea among tests that are not ignored; None without waves.

        Args:
            records: Records of the tests.
            low: Lowest frequency of first-order waves (Hz).
            cutoff: Highest frequency (Hz).
        """
        wavy = [(r.time, r.wave) for r in records if r.kind in IN_WAVES and r.use != "ignore" and r.wave is not None]
        if not wavy:
            return None
        time, wave = max(wavy, key=lambda series: float(np.var(series[1])))
        return cls(record_peak_period(wave, float(np.median(np.diff(time))), low, cutoff))


class Motion(NamedTuple):
    """Reference quantities of one motion, alone and undamped.

    Attributes:
        mass: Moving mass (kg, kg m²).
        stiffness: Restoring stiffness (N/m, N m/rad).
        excursion: Largest measured excursion (m, rad).
        speed: Velocity (m/s, rad/s) of free oscillation with that amplitude.
        critical: Critical damping (N s/m, N m s/rad).
    """

    mass: float
    stiffness: float
    excursion: float
    speed: float
    critical: float


class Case(NamedTuple):
    """A model with the motions and waves of its tests.

    Attributes:
        model: The model.
        scales: Noticeable sizes by motion.
        seas: The waves, or None.
    """

    model: Model
    scales: Mapping[str, NoticeableScales]
    seas: Seas | None

    @property
    def length(self) -> float:
        """Cube root of the displaced volume (m)."""
        return displaced_length(self.model)

    @property
    def size(self) -> float:
        """Length over that of a platform of 20 000 t."""
        return self.length / REFERENCE_LENGTH

    def motion(self, dof: str) -> Motion:
        """Reference quantities of a motion."""
        s = self.scales[dof]
        omega, excursion = s.rate / s.amplitude, LARGEST_OVER_SINE * s.amplitude
        return Motion(s.mass, s.mass * omega**2, excursion, omega * excursion, 2 * s.mass * omega)

    def waves(self) -> tuple[float, float]:
        """Density times gravity (N/m³), and peak frequency of the waves (rad/s)."""
        if self.seas is None:
            raise ValueError("sizes of effects in waves need the peak period of the waves")
        water = self.model.environment
        return float(water.density) * float(water.gravity), 2 * math.pi / self.seas.peak_period

    def hull_extent(self, axis: int) -> tuple[float, float]:
        """Lowest and highest coordinate (m) of the hull along an axis.

        Both are at least half the length from the reference point.
        """
        parts = self.model.hull.elements
        ends = [np.asarray(parts.start)[axis], np.asarray(parts.start + parts.axis * parts.length)[axis]]
        reach = np.concatenate([*ends, [-self.length / 2, self.length / 2]])
        return float(reach.min()), float(reach.max())


def dof_of(label: str) -> str:
    """Motion in a label such as hysteresis.surge.force."""
    return label.split(".")[1]


def is_rotation(label: str) -> bool:
    """Whether a label such as hysteresis.pitch.force is about a rotation."""
    return dof_of(label) in DOFS[3:]


def unity(case: Case, label: str) -> float:
    """1, of sizes that are shares."""
    return 1.0


def body_mass(case: Case, label: str) -> float:
    """Mass of the platform (kg)."""
    return float(case.model.body.mass)


def body_inertia(case: Case, label: str) -> float:
    """Declared moment of inertia (kg m²) in a label such as mass_properties.inertia_pitch."""
    i = DOFS.index(label.rsplit("_", 1)[1]) - 3
    return float(case.model.body.inertia[i, i])


def moving_mass(case: Case, label: str) -> float:
    """Moving mass (kg, kg m²) of a motion."""
    return case.motion(dof_of(label)).mass


def restoring_force(case: Case, label: str) -> float:
    """Restoring force (N, N m) at the largest excursion."""
    motion = case.motion(dof_of(label))
    return motion.stiffness * motion.excursion


def surge_stiffness(case: Case, label: str) -> float:
    """Stiffness in surge (N/m)."""
    return case.motion("surge").stiffness


def surge_force(case: Case, label: str) -> float:
    """Restoring force (N) at the largest excursion in surge."""
    return restoring_force(case, ".surge")


def offset_force(case: Case, label: str) -> float:
    """Force (N, N m) of an offset by the largest excursion, or by the smallest offset if that is more.

    The smallest offset is `MIN_OFFSET` of the length in translations, and `MIN_TILT` in rotations.
    """
    motion, least = case.motion(dof_of(label)), MIN_TILT if is_rotation(label) else MIN_OFFSET * case.length
    return motion.stiffness * max(motion.excursion, least)


def equal_polynomial(case: Case, label: str) -> float:
    """Coefficient with which a term is as large as the linear force at the largest excursion."""
    motion, name = case.motion(dof_of(label)), label.rsplit(".", 1)[1]
    if name == "pitch_squared":  # pitch stiffness per metre of heave
        return case.motion("pitch").stiffness / motion.excursion
    return motion.stiffness / motion.excursion ** (POWERS[name] - 1)


def _geometric_mean(case: Case, label: str, quantity: str) -> float:
    i, j = row_and_column(label)
    return math.sqrt(getattr(case.motion(DOFS[i]), quantity) * getattr(case.motion(DOFS[j]), quantity))


def entry_mass(case: Case, label: str) -> float:
    """Moving mass (kg, kg m, kg m²) of a matrix entry: geometric mean of both motions.

    The label names the entry, such as added_mass.A15.
    """
    return _geometric_mean(case, label, "mass")


def entry_stiffness(case: Case, label: str) -> float:
    """Stiffness (N/m, N, N m/rad) of a matrix entry: geometric mean of both motions.

    The label names the entry, such as stiffness.C35.
    """
    return _geometric_mean(case, label, "stiffness")


def entry_damping(case: Case, label: str) -> float:
    """Critical damping (N s/m, N s, N m s/rad) of a matrix entry: geometric mean of both motions.

    The label names the entry, such as coupled_damping.B15.
    """
    return _geometric_mean(case, label, "critical")


def quadratic_damping(case: Case, label: str) -> float:
    """Quadratic damping (N s²/m², N m s²/rad²) with critical damping's force at the largest speed."""
    return entry_damping(case, label) / _geometric_mean(case, label, "speed")


def cubic_damping(case: Case, label: str) -> float:
    """Cubic damping (N s³/m³, N m s³/rad³) with critical damping's force at the largest speed."""
    motion = case.motion(dof_of(label))
    return motion.critical / motion.speed**2


def radiation_damping(case: Case, label: str) -> float:
    """Scale of potential damping (N s/m, N m s/rad): moving mass times the frequency (g/L)^(1/2)."""
    return moving_mass(case, label) * math.sqrt(float(case.model.environment.gravity) / case.length)


def total_reflection(case: Case, label: str) -> float:
    """Drift coefficient (N/m², N m/m²) of waves that are all sent back over the platform's length."""
    weight, frequency = case.waves()
    lever = case.length / 2 if is_rotation(label) else 1.0
    weighted = (frequency / DRIFT_REFERENCE_FREQUENCY) ** 2 if label.endswith("frequency_weighted") else 1.0
    return 0.5 * weight * case.length * lever / weighted


def aranha_damping(case: Case, label: str) -> float:
    """Wave-drift damping (N s/m³, N s/(m rad)) of waves that are all sent back.

    It is 4 omega/g times the drift coefficient, and in rotations times the lever, half the length.
    """
    lever = case.length / 2 if is_rotation(label) else 1.0
    return 4 * case.waves()[1] / float(case.model.environment.gravity) * total_reflection(case, label) * lever
