"""Consistency of other programs' tables with each other and with their platform."""

import math
from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple, get_args

import numpy as np
from jaxtyping import Float

from jaxhydro.interop.radiation_coefficients import RadiationCoefficients
from jaxhydro.interop.retardation import Realisation, realise
from jaxhydro.interop.wamit_tables import By, to_omega

MAX_ASYMMETRY = 0.1  # of the geometric mean of two motions' own coefficients
LONG_HEAVE = (0.5, 1.3)  # heave force of the longest wave over C33, where that wave is long
NO_HEAVE, ALL_HEAVE = 0.5, (0.7, 1.3)  # the same of the longest and the shortest wave, where the column is turned around
LONG_SURGE = (0.25, 5.0)  # horizontal force of a long wave over mass times acceleration: 1 + Ca; less by tables of deeper water
NO_SURGE = (0.25, 8.0)  # outside: no body in long waves
MIN_VARIATION = 0.05  # of added mass: what varies less says nothing about its damping
# misfit of added mass and damping by Kramers and Kronig, over its variation
MIN_UNRELATED_MISFIT, MAX_RELATED_MISFIT = 0.8, 0.4
# of the largest drift: what the longest waves have, and the shortest have not, in a wrong column
MIN_LONG_WAVE_DRIFT, MAX_SHORT_WAVE_DRIFT = 0.3, 0.05
WORDS = {"period": "a period (s)", "rad/s": "a frequency in rad/s", "Hz": "a frequency in Hz"}
COLUMN_TOLERANCE = 1e-4  # of a number in the first column
KINDS: tuple[str, ...] = get_args(By)


class LongWaves(NamedTuple):
    """Platform properties that decide the forces of long waves.

    They are heave stiffness rho g A (N/m), mass (kg), water depth (m) and gravity (m/s²).
    """

    stiffness: float
    mass: float
    depth: float
    gravity: float


def as_column(omega: Float[np.ndarray, " n"], by: str) -> Float[np.ndarray, " n"]:
    """The first column (s, rad/s or Hz) of a file that has these frequencies (rad/s)."""
    return to_omega(omega, "period") if by == "period" else omega / (2 * math.pi if by == "Hz" else 1.0)


def excitation_column(
    omega: Float[np.ndarray, " n"], force: Float[np.ndarray, "6 n"], by: str, source: str, hull: LongWaves
) -> list[str]:
    """A warning where a table of wave forces has the long waves of another first column than stated.

    A long wave lifts by rho g A per metre of its amplitude. It pushes by the mass and added mass times the water's
    acceleration (Newman 1977, Marine Hydrodynamics, section 6.17). There is no warning where more than one column would do,
    or the stated one does.

    Args:
        omega: Frequencies as read, rad/s.
        force: X of the six motions, N/m and N m/m, complex.
        by: Stated quantity of the first column.
        source: The file.
        hull: The platform.
    """
    if by not in KINDS or hull.stiffness <= 0:
        return []
    column = as_column(omega, by)
    by_kind = {kind: _long_wave(to_omega(column, kind), force, hull) for kind in KINDS}
    heave, surge, shortest = by_kind[by]
    turned = heave < NO_HEAVE and ALL_HEAVE[0] < shortest < ALL_HEAVE[1]
    if not turned and (surge is None or NO_SURGE[0] < surge < NO_SURGE[1]):
        return []
    fits = [
        kind
        for kind, (lift, push, _) in by_kind.items()
        if kind != by and LONG_HEAVE[0] < lift < LONG_HEAVE[1] and (push is None or LONG_SURGE[0] < push < LONG_SURGE[1])
    ]
    if not fits:
        return []
    sentence = f"read by {by}, its longest wave lifts {heave:.2g} of rho g A"
    if surge is not None:
        sentence += f" and pushes {surge:.2g} of mass times acceleration"
    way = " or ".join(f"{kind!r}" if kind == "period" else kind for kind in fits).replace("'", "")
    probably = WORDS[fits[0]] if len(fits) == 1 else "a frequency"
    return [f"{source}: the first column is probably {probably}: {sentence}. See `excitation.by`: {way}"]


def _long_wave(
    omega: Float[np.ndarray, " n"], force: Float[np.ndarray, "6 n"], hull: LongWaves
) -> tuple[float, float | None, float]:
    """Forces of the longest and the shortest wave over those of theory.

    Returns:
        Heave force of the longest wave over C33.
        Horizontal force of the longest wave over mass times acceleration; None: it has none.
        Heave force of the shortest wave over C33.
    """
    longest, shortest = int(np.argmin(omega)), int(np.argmax(omega))
    lift = abs(force[2, longest]) / hull.stiffness
    push = math.hypot(abs(force[0, longest]), abs(force[1, longest]))
    deep = omega[longest] ** 2 / hull.gravity
    # g k, by the shallow or the deep limit of the dispersion relation, whichever is larger
    acceleration = hull.gravity * max(deep, math.sqrt(deep / hull.depth))
    return lift, push / (hull.mass * acceleration) if push > 0 else None, abs(force[2, shortest]) / hull.stiffness


def drift_column(curve: Float[np.ndarray, " n"], by: str, source: str) -> list[str]:
    """A warning where the drift of regular waves is that of another first column than stated.

    Long waves do not drift a body. Short ones do, as they are sent back (Faltinsen 1990, Sea Loads on Ships and Offshore
    Structures, chapter 5).

    Args:
        curve: Size of the horizontal force on the diagonal of the table, by ascending frequency as read.
        by: Stated quantity of the columns.
        source: The file.
    """
    largest = float(curve.max(initial=0.0))
    if not largest > 0 or curve[0] < MIN_LONG_WAVE_DRIFT * largest or curve[-1] > MAX_SHORT_WAVE_DRIFT * largest:
        return []
    way = "a frequency: `drift.by`: rad/s or Hz" if by == "period" else "a period: `drift.by`: period"
    return [f"{source}: the first column is probably {way}. Read by {by}, the longest waves drift most and the shortest not"]


def asymmetry(coefficients: RadiationCoefficients, source: str) -> list[str]:
    """Warning where added mass or damping is far from symmetric (Newman 1977, section 6.17).

    References:
        Newman (1977), Marine Hydrodynamics, section 6.17 (symmetric without forward speed).
    """
    warnings = []
    for name, cube in (("added mass", coefficients.added_mass), ("damping", coefficients.damping)):
        scale = np.sqrt(np.abs(np.einsum("wii->wi", cube)).max(axis=0))
        size = np.outer(scale, scale)
        off = np.abs(cube - cube.transpose(0, 2, 1)).max(axis=0) / np.where(size > 0, size, np.inf)
        if off.max() > MAX_ASYMMETRY:
            i, j = np.unravel_index(int(off.argmax()), off.shape)
            pair = f"({i + 1}, {j + 1}) and ({j + 1}, {i + 1})"
            warnings.append(f"{source}: {name} is not symmetric: {pair} differ by {off.max():.0%} of the motions' own")
    return warnings


def radiation_column(coefficients: RadiationCoefficients, space: Realisation, by: str | None, source: str) -> list[str]:
    """Warning where added mass and damping violate the Kramers-Kronig relations (Ogilvie 1964).

    The warning says where it does follow with the first column taken for a frequency in place of a period, or the other way
    round. Rad/s and Hz cannot be told apart so: the relations hold at any scale of frequency.

    Args:
        coefficients: The coefficients.
        space: A state space that follows their damping.
        by: Stated quantity of the first column; None: the file says it.
        source: The file.

    References:
        Ogilvie (1964), 5th Symposium on Naval Hydrodynamics.
    """
    misfit = _misfit(coefficients, space)
    if misfit is None or misfit < MIN_UNRELATED_MISFIT:
        return []
    apart = f"added mass does not follow from damping (Kramers-Kronig): it misses {min(misfit, 9.99):.0%} of its variation"
    plain = f"{source}: {apart}. Damping is used: see where the file is from"
    if by is None:
        return [plain]
    alternative = "rad/s" if by == "period" else "period"
    omega = to_omega(as_column(coefficients.omega, by), alternative)
    order = np.argsort(omega)
    damping = coefficients.damping / coefficients.omega[:, None, None] * omega[:, None, None]
    turned = RadiationCoefficients(omega[order], coefficients.added_mass[order], damping[order])
    try:
        turned_misfit = _misfit(turned, realise(turned, 0.05, 20))
    except ValueError:
        turned_misfit = None
    if turned_misfit is None or turned_misfit > MAX_RELATED_MISFIT:
        return [plain]
    way = "a frequency: `radiation.by`: rad/s or Hz" if alternative == "rad/s" else "a period: `radiation.by`: period"
    return [f"{source}: the first column is probably {way}. Read by {by}, {apart}"]


def _misfit(coefficients: RadiationCoefficients, space: Realisation) -> float | None:
    """Misfit of a state space's added mass, over its variation (median of motions), or None."""
    theirs = np.einsum("wii->wi", coefficients.added_mass)
    ours = np.einsum("wii->wi", space.transfer(coefficients.omega).imag) / coefficients.omega[:, None]
    varies = np.maximum(theirs.std(axis=0), ours.std(axis=0))
    used = varies > MIN_VARIATION * np.abs(theirs).mean(axis=0)
    used &= np.einsum("wii->wi", coefficients.damping).max(axis=0) > 0
    if not used.any():
        return None
    return float(np.median((theirs - ours).std(axis=0)[used] / varies[used]))


class Column(NamedTuple):
    """Frequencies (rad/s) of a file, and the stated quantity of its first column."""

    source: str
    omega: Float[np.ndarray, " n"]
    by: str


def same_columns(columns: Sequence[Column]) -> list[str]:
    """Warnings where two files have the same first column, stated to be different quantities."""
    warnings = []
    for first, second in combinations(columns, 2):
        few, many = sorted((as_column(first.omega, first.by), as_column(second.omega, second.by)), key=len)
        shared = np.abs(many[:, None] / few - 1).min(axis=0) < COLUMN_TOLERANCE
        if first.by != second.by and shared.all():
            files = f"{first.source} and {second.source} have the same first column"
            warnings.append(f"{files}, and are read by {first.by} and by {second.by}: see `by`")
    return warnings
