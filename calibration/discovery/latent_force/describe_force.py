"""Description of a latent force: size, frequencies, coherence, growth, sentence."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from scipy import signal

from calibration.campaign.signals import wave_height
from calibration.discovery.latent_force.force_law import LAG_RATIOS, LAGGED_TERMS, columns_of, squared_envelope
from calibration.discovery.latent_force.recovered_force import RecoveredForce
from calibration.discovery.reported_forces import ForceCoherence, ForceExcerpt, LatentForce, Law, LawTerm
from calibration.formatting import listed, number, percent, quantity, readable_unit
from jaxhydro.analysis.sea_statistics import bands_of, record_peak_period
from jaxhydro.analysis.spectral import SEGMENT
from jaxhydro.environment import DOFS

CYCLES_PER_SEGMENT = 4.0  # periods of a decay in a spectral segment
MIN_SEGMENTS = 4  # segments of a spectrum, and cycles of a decay
MIN_FORCE_OVER_NOISE = 3.0  # of a cycle's force, to count for its growth
MIN_SIZE_RATIO = {"decay": 1.5, "waves": 1.15}  # of the largest motion or wave to the smallest, to find an exponent
MIN_COHERENCE = 0.5  # fraction of the force, to be mentioned

QuantityOfForce = Callable[["RecoveredForce"], np.ndarray]
MOTION: dict[str, QuantityOfForce] = {
    "velocity": lambda one: one.velocity,
    "position": lambda one: one.position,
    "acceleration": lambda one: one.acceleration,
}


def test_kind(one: RecoveredForce) -> str:
    """decay or waves"""
    return "decay" if one.test.kind == "decay" else "waves"


def motion_frequency(one: RecoveredForce) -> float:
    """Frequency (Hz) of a motion: standard deviation of its velocity over that of its position, over 2 pi."""
    return float(np.std(one.velocity[one.inside]) / max(np.std(one.position[one.inside]), 1e-300)) / (2 * np.pi)


def bands_in(one: RecoveredForce) -> dict[str, tuple[float, float]]:
    """Frequency bands (Hz) of a force, by name.

    In a decay around the motion's own frequency, in waves around that of the waves.
    """
    if one.test.wave is None:
        own = motion_frequency(one)
        return {"slower": (0.0, 0.5 * own), "own": (0.5 * own, 1.5 * own), "higher": (1.5 * own, np.inf)}
    low, high = bands_of("wave", record_peak_period(one.test.wave, one.test.step))["wave_frequency"]
    return {"low_frequency": (0.0, low), "wave_frequency": (low, high), "higher": (high, np.inf)}


def in_bands(one: RecoveredForce) -> dict[str, float]:
    """Mean square of a force (N², (N m)²) in its mean and in bands."""
    force = one.force[one.inside]
    frequency, power = signal.periodogram(force, 1 / one.test.step, "hann", detrend="constant")
    power = power * float(np.var(force)) / max(float(power.sum()), 1e-300)
    bands = bands_in(one)
    within = {name: float(power[(frequency >= a) & (frequency < b)].sum()) for name, (a, b) in bands.items()}
    return {"mean": float(force.mean()) ** 2, **within}


def shares_of(forces: Sequence[RecoveredForce]) -> dict[str, float]:
    """Fractions of the mean square in the mean and in bands, over some tests."""
    each = [(len(one.force), in_bands(one)) for one in forces]
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
    cross, own, other, explained, segments = 0j, 0.0, 0.0, 0.0, 0
    for one in forces:
        count = len(one.force[one.inside])
        if one.test.wave is None:
            size = int(min(CYCLES_PER_SEGMENT / max(motion_frequency(one), 1e-9) / one.test.step, count))
        else:
            size = int(min(SEGMENT / one.test.step, count / 8))
        if size < 8 or count < 8:
            continue
        rows = (values(one)[one.inside], one.force[one.inside])
        options = {"fs": 1 / one.test.step, "window": "hann", "nperseg": size, "detrend": "constant"}
        frequency, both = signal.csd(*rows, **options)
        u, f = (signal.welch(row, **options)[1] for row in rows)
        low, high = limits(one)
        asked = (frequency >= low) & (frequency < high)
        inside = asked & (u > 1e-9 * u.max())
        cross, own, other = cross + both[inside].sum(), own + f[asked].sum(), other + u[inside].sum()
        explained += float((np.abs(both[inside]) ** 2 / u[inside]).sum())
        segments += 2 * count // size - 1
    if segments < MIN_SEGMENTS or not own > 0 or not other > 0:
        return None
    return ForceCoherence(explained / own, float(np.angle(cross)), float(cross.real / np.sqrt(own * other)))


def coherences(forces: Sequence[RecoveredForce]) -> dict[str, ForceCoherence]:
    """Relation of a force to the motion, and in waves to the elevation and its squared envelope."""
    coherence = {name: force_coherence(forces, values, lambda _: (0.0, np.inf)) for name, values in MOTION.items()}
    if (wavy := [one for one in forces if one.test.wave is not None]) and len(wavy) == len(forces):
        half = {test.id: 0.5 / record_peak_period(np.asarray(test.wave), test.step) for test in (one.test for one in wavy)}
        coherence["elevation"] = force_coherence(
            wavy, lambda one: np.asarray(one.test.wave), lambda one: (half[one.test.id], np.inf)
        )
        envelope: QuantityOfForce = lambda one: squared_envelope(np.asarray(one.test.wave), one.test.step)  # noqa: E731
        coherence["squared_envelope"] = force_coherence(wavy, envelope, lambda one: (0.0, half[one.test.id]))
    return {name: one for name, one in coherence.items() if one is not None}


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
    for one in forces:
        n = max(round(1 / max(motion_frequency(one), 1e-9) / one.test.step), 4)
        if test_kind(one) != "decay":
            continue
        motion, force = one.position[one.inside], one.force[one.inside]
        rows = [(float(np.std(motion[i : i + n])), float(np.std(force[i : i + n]))) for i in range(0, len(force) - n + 1, n)]
        cycles += [row for row in rows if row[1] > MIN_FORCE_OVER_NOISE * one.noise and row[0] > 0]
    if len(cycles) >= MIN_SEGMENTS and (power := _power(cycles, MIN_SIZE_RATIO["decay"])) is not None:
        exponents["amplitude"] = power
    seas = [
        (wave_height(one.test.wave, irregular=True), in_bands(one))
        for one in forces
        if one.test.kind == "irregular" and one.test.wave is not None
    ]
    for band in seas[0][1] if seas else ():
        pairs = [(height, row[band] ** 0.5) for height, row in seas if row[band] > 0 and height > 0]
        if (power := _power(pairs, MIN_SIZE_RATIO["waves"])) is not None:
            exponents[f"significant_height.{band}"] = power
    return exponents


def described(motion: str, forces: Sequence[RecoveredForce], law: Law) -> LatentForce:
    """Latent force of a motion over all tests; the largest one of a fitted test is plotted."""
    kinds = {name: [one for one in forces if test_kind(one) == name] for name in ("decay", "waves")}
    visible = {name: rows for name, rows in kinds.items() if any(one.visible for one in rows)}
    rms = {
        name: float(np.sqrt(np.mean(np.concatenate([one.force[one.inside] ** 2 for one in rows]))))
        for name, rows in visible.items()
    }
    fitted = [one for one in forces if one.test.use == "fit"] or list(forces)
    largest = max(fitted, key=lambda one: one.root_mean_square)
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


def _shown(one: RecoveredForce, law: Law) -> ForceExcerpt:
    names, some = [term.kind for term in law.terms], one.inside
    wave, follows = one.test.wave, np.zeros(0)
    if names:
        follows = columns_of(one, law.v0, law.pace)[:, names] @ np.array([term.coefficient for term in law.terms])
    beside, values = ("velocity", one.velocity) if wave is None else ("wave", wave)
    return ForceExcerpt(one.test.id, one.test.time[some], one.force[some], follows, beside, values[some])


BAND_WORDS = {
    "mean": "in the mean",
    "slower": "slower than the motion",
    "own": "at the motion's own frequency",
    "low_frequency": "slower than the waves",
    "wave_frequency": "at the waves' frequencies",
    "higher": "at higher frequencies",
}
WAVE_WORDS = {"elevation": "the wave elevation", "squared_envelope": "the squared wave envelope"}


def sentence(one: LatentForce) -> str:
    """A latent force in a sentence."""
    said, where = [], {"decay": "in decays", "waves": "in waves"}
    for name, rms in one.rms.items():
        band, share = max(one.shares[name].items(), key=lambda item: item[1])
        said.append(f"{quantity(rms, None, one.unit)} rms {where[name]}, {percent(share)} of its square {BAND_WORDS[band]}")
    with_what = []
    for name, rows in one.coherence.items():
        motion = max((k for k in MOTION if k in rows), key=lambda k: round(abs(rows[k].correlation), 1), default=None)
        named = [k for k in WAVE_WORDS if k in rows and rows[k].coherence > MIN_COHERENCE]
        if motion is not None and abs(rows[motion].correlation) > MIN_COHERENCE:
            against = "against" if rows[motion].correlation < 0 else "with"
            with_what.append(f"{where[name]} mostly {against} the {motion} (correlation {number(rows[motion].correlation, 2)})")
        with_what += [f"coherent with {WAVE_WORDS[k]} ({number(rows[k].coherence, 2)})" for k in named]
    main = max(one.shares["waves"].items(), key=lambda row: row[1])[0] if "waves" in one.shares else ""
    told = {name: p for name, p in one.growth.items() if name in ("amplitude", f"significant_height.{main}")}
    grows = [f"it grows as the power {number(p, 2)} of the {_size(name)}" for name, p in told.items()]
    parts = [f"{one.motion.capitalize()}: the model lacks a {'moment' if one.unit == 'N m' else 'force'} of {listed(said)}"]
    parts += [", ".join(with_what)] if with_what else []
    return "; ".join([*parts, *grows, law_in_words(one.law, one.unit)]) + "."


def _size(name: str) -> str:
    height, _, band = name.partition(".")
    return f"significant wave height {BAND_WORDS[band]}" if height == "significant_height" else "motion's amplitude"


def law_in_words(law: Law, unit: str) -> str:
    """A force law and what it explains, in words."""
    if not law.terms:
        return f"no law of up to three terms explains it (the best {percent(law.share)} of it in {law.checked or 'the tests'})"
    sizes = [(one, f"{number(one.coefficient, 3)} {readable_unit(one.unit)}") for one in law.terms]
    parts = [f"({size}) {_term(one, law)}".removesuffix(" 1") for one, size in sizes]
    text, speed = " + ".join(parts), "rad/s" if unit == "N m" else "m/s"
    v0 = f", v0 = {number(law.v0, 2)} {speed}" if any("v0" in term.name for term in law.terms) else ""
    return f"{text} explains {percent(law.share)} of it in {law.checked}{v0}"


def _term(one: LawTerm, law: Law) -> str:
    """Name of a term; for lagged velocity with its time constant."""
    if one.kind not in LAGGED_TERMS:
        return one.name
    return f"v lagged by a time constant of {number(LAG_RATIOS[one.kind - LAGGED_TERMS.start] / law.pace, 2)} s"
