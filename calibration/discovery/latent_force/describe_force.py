"""Description of a latent force: size, frequencies, coherence, growth."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import scipy  # its parts are imported when they are used: that takes a second

from calibration.campaign.signals import wave_height
from calibration.discovery.latent_force.force_words import sentence
from calibration.discovery.latent_force.recovered_force import RecoveredForce
from calibration.discovery.latent_force.term_library import columns_of, squared_envelope
from calibration.discovery.reported_forces import ForceCoherence, ForceExcerpt, LatentForce, Law
from jaxhydro.analysis.sea_statistics import bands_of, record_peak_period
from jaxhydro.analysis.spectral import SEGMENT
from jaxhydro.environment import DOFS

CYCLES_PER_SEGMENT = 4.0  # periods of a decay in a spectral segment
MIN_SEGMENTS = 4  # segments of a spectrum, and cycles of a decay
MIN_FORCE_OVER_NOISE = 3.0  # of a cycle's force, to count for its growth
MIN_SIZE_RATIO = {"decay": 1.5, "waves": 1.15}  # of the largest motion or wave to the smallest, to find an exponent

QuantityOfForce = Callable[["RecoveredForce"], np.ndarray]
MOTION: dict[str, QuantityOfForce] = {
    "velocity": lambda recovered: recovered.velocity,
    "position": lambda recovered: recovered.position,
    "acceleration": lambda recovered: recovered.acceleration,
}


def test_kind(recovered: RecoveredForce) -> str:
    """Kind of a force's test: decay or waves."""
    return "decay" if recovered.test.kind == "decay" else "waves"


def motion_frequency(recovered: RecoveredForce) -> float:
    """Frequency (Hz) of a motion: standard deviation of its velocity over that of its position, over 2 pi."""
    inside = recovered.inside
    return float(np.std(recovered.velocity[inside]) / max(np.std(recovered.position[inside]), 1e-300)) / (2 * np.pi)


def bands_in(recovered: RecoveredForce) -> dict[str, tuple[float, float]]:
    """Frequency bands (Hz) of a force, by name.

    In a decay around the motion's own frequency, in waves around that of the waves.
    """
    if recovered.test.wave is None:
        own_frequency = motion_frequency(recovered)
        return {
            "slower": (0.0, 0.5 * own_frequency),
            "own": (0.5 * own_frequency, 1.5 * own_frequency),
            "higher": (1.5 * own_frequency, np.inf),
        }
    low, high = bands_of("wave", record_peak_period(recovered.test.wave, recovered.test.step))["wave_frequency"]
    return {"low_frequency": (0.0, low), "wave_frequency": (low, high), "higher": (high, np.inf)}


def in_bands(recovered: RecoveredForce) -> dict[str, float]:
    """Mean square of a force (N², (N m)²) in its mean and in bands."""
    force = recovered.force[recovered.inside]
    frequency, power = scipy.signal.periodogram(force, 1 / recovered.test.step, "hann", detrend="constant")
    power = power * float(np.var(force)) / max(float(power.sum()), 1e-300)
    bands = bands_in(recovered)
    within = {name: float(power[(frequency >= a) & (frequency < b)].sum()) for name, (a, b) in bands.items()}
    return {"mean": float(force.mean()) ** 2, **within}


def shares_of(forces: Sequence[RecoveredForce]) -> dict[str, float]:
    """Fractions of the mean square in the mean and in bands, over some tests."""
    each = [(len(recovered.force), in_bands(recovered)) for recovered in forces]
    sums = {name: sum(n * row[name] for n, row in each) for name in each[0][1]}
    total = sum(sums.values())
    return {name: value / total if total > 0 else 0.0 for name, value in sums.items()}


def force_coherence(
    forces: Sequence[RecoveredForce], values: QuantityOfForce, limits: Callable[[RecoveredForce], tuple[float, float]]
) -> ForceCoherence | None:
    """Relation of a force to another quantity in a frequency band, by cross-spectra.

    Args:
        forces: The force by test.
        values: The other quantity, as a function of the force.
        limits: Lower and upper frequency (Hz), as a function of the force.

    Returns:
        Coherence, phase and correlation; None where there are too few segments.

    References:
        Bendat and Piersol 2010, Random Data, section 6.1.
    """
    cross, force_power, quantity_power, explained, segments = 0j, 0.0, 0.0, 0.0, 0
    for recovered in forces:
        count = len(recovered.force[recovered.inside])
        if recovered.test.wave is None:
            size = int(min(CYCLES_PER_SEGMENT / max(motion_frequency(recovered), 1e-9) / recovered.test.step, count))
        else:
            size = int(min(SEGMENT / recovered.test.step, count / 8))
        if size < 8 or count < 8:
            continue
        rows = (values(recovered)[recovered.inside], recovered.force[recovered.inside])
        options = {"fs": 1 / recovered.test.step, "window": "hann", "nperseg": size, "detrend": "constant"}
        frequency, both = scipy.signal.csd(*rows, **options)
        u, f = (scipy.signal.welch(row, **options)[1] for row in rows)
        low, high = limits(recovered)
        asked = (frequency >= low) & (frequency < high)
        inside = asked & (u > 1e-9 * u.max())
        cross += both[inside].sum()
        force_power += f[asked].sum()
        quantity_power += u[inside].sum()
        explained += float((np.abs(both[inside]) ** 2 / u[inside]).sum())
        segments += 2 * count // size - 1
    if segments < MIN_SEGMENTS or not force_power > 0 or not quantity_power > 0:
        return None
    return ForceCoherence(
        explained / force_power, float(np.angle(cross)), float(cross.real / np.sqrt(force_power * quantity_power))
    )


def coherences(forces: Sequence[RecoveredForce]) -> dict[str, ForceCoherence]:
    """Relation of a force to the motion, and in waves to the elevation and its squared envelope."""
    coherence = {name: force_coherence(forces, values, lambda _: (0.0, np.inf)) for name, values in MOTION.items()}
    if (wavy := [recovered for recovered in forces if recovered.test.wave is not None]) and len(wavy) == len(forces):
        half = {
            test.id: 0.5 / record_peak_period(np.asarray(test.wave), test.step)
            for test in (recovered.test for recovered in wavy)
        }
        coherence["elevation"] = force_coherence(
            wavy, lambda recovered: np.asarray(recovered.test.wave), lambda recovered: (half[recovered.test.id], np.inf)
        )
        envelope: QuantityOfForce = lambda recovered: squared_envelope(np.asarray(recovered.test.wave), recovered.test.step)  # noqa: E731
        coherence["squared_envelope"] = force_coherence(wavy, envelope, lambda recovered: (0.0, half[recovered.test.id]))
    return {name: relation for name, relation in coherence.items() if relation is not None}


def _power(pairs: Sequence[tuple[float, float]], ratio: float) -> float | None:
    """Exponent p of force ~ size^p; None where sizes are too similar."""
    if len(pairs) < 2:
        return None
    size, force = np.log(np.array(pairs)).T
    return float(np.polyfit(size, force, 1)[0]) if np.ptp(size) > np.log(ratio) else None


def growth_of(forces: Sequence[RecoveredForce]) -> dict[str, float]:
    """Exponents of a force's growth.

    With the motion's amplitude over cycles of decays; with significant wave height over tests, in every band.
    """
    cycles, exponents = [], {}
    for recovered in forces:
        n = max(round(1 / max(motion_frequency(recovered), 1e-9) / recovered.test.step), 4)
        if test_kind(recovered) != "decay":
            continue
        motion, force = recovered.position[recovered.inside], recovered.force[recovered.inside]
        rows = [(float(np.std(motion[i : i + n])), float(np.std(force[i : i + n]))) for i in range(0, len(force) - n + 1, n)]
        cycles += [row for row in rows if row[1] > MIN_FORCE_OVER_NOISE * recovered.noise and row[0] > 0]
    if len(cycles) >= MIN_SEGMENTS and (power := _power(cycles, MIN_SIZE_RATIO["decay"])) is not None:
        exponents["amplitude"] = power
    seas = [
        (wave_height(recovered.test.wave, irregular=True), in_bands(recovered))
        for recovered in forces
        if recovered.test.kind == "irregular" and recovered.test.wave is not None
    ]
    for band in seas[0][1] if seas else ():
        pairs = [(height, row[band] ** 0.5) for height, row in seas if row[band] > 0 and height > 0]
        if (power := _power(pairs, MIN_SIZE_RATIO["waves"])) is not None:
            exponents[f"significant_height.{band}"] = power
    return exponents


def described(motion: str, forces: Sequence[RecoveredForce], law: Law) -> LatentForce:
    """Latent force of a motion over all tests; the largest one of a fitted test is plotted."""
    kinds = {name: [recovered for recovered in forces if test_kind(recovered) == name] for name in ("decay", "waves")}
    visible = {name: rows for name, rows in kinds.items() if any(recovered.visible for recovered in rows)}
    rms = {
        name: float(np.sqrt(np.mean(np.concatenate([recovered.force[recovered.inside] ** 2 for recovered in rows]))))
        for name, rows in visible.items()
    }
    fitted = [recovered for recovered in forces if recovered.test.use == "fit"] or list(forces)
    largest = max(fitted, key=lambda recovered: recovered.root_mean_square)
    measured = largest.test.measured[motion]
    made = LatentForce(
        motion,
        "N m" if DOFS.index(motion) > 2 else "N",
        rms,
        {name: shares_of(rows) for name, rows in visible.items()},
        {name: coherences(rows) for name, rows in visible.items()},
        growth_of(forces),
        law,
        "",
        _shown(largest, law),
        float(np.std(measured - largest.test.simulated[motion]) / max(np.std(measured), 1e-300)),
    )
    return replace(made, words=sentence(made))


def _shown(recovered: RecoveredForce, law: Law) -> ForceExcerpt:
    names, inside = [term.kind for term in law.terms], recovered.inside
    wave, follows = recovered.test.wave, np.zeros(0)
    if names:
        follows = columns_of(recovered, law.v0, law.pace)[:, names] @ np.array([term.coefficient for term in law.terms])
    beside, values = ("velocity", recovered.velocity) if wave is None else ("wave", wave)
    return ForceExcerpt(
        recovered.test.id, recovered.test.time[inside], recovered.force[inside], follows, beside, values[inside]
    )
