"""Hints on wrong units, scales and signs that all records of a campaign share."""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from calibration.campaign.manifest_sections import quantity
from calibration.campaign.records import Record
from calibration.campaign.signals import dominant_period
from jaxhydro.dynamics.natural_modes import Modes
from jaxhydro.environment import DOFS

RATIO_TOLERANCE = 0.15  # of a logarithm: a ratio that is a factor
SAME_RATIO_TOLERANCE = 0.1  # of a logarithm: ratios of different motions that are one and the same
MIN_COMMON_RATIO = math.log(2.0)  # a smaller common ratio may be the model's own error
MIN_COUPLED_MOTION = 0.05  # of the released motion, in metres of the hull: a smaller motion beside it is not the mode's alone
MAX_PHASE_RATIO = 0.3  # imaginary over real part: a motion further out of phase is not the mode's
UNITY_TOLERANCE = 0.25  # of a logarithm: a ratio that is 1, or 1 of the other sign
LARGEST_RELEASE, SMALLEST_RELEASE = 1.0, 1e-3  # of the radius of gyration: releases beyond are no platform's
USUAL_RELEASES = (0.003, 0.6)  # of the radius of gyration, or rad: releases as they are
LARGEST_RELEASE_ANGLE, SMALLEST_RELEASE_ANGLE = math.radians(60.0), 4e-3
DEGREES_PER_RADIAN = 180 / math.pi
SAME_SCALE = "If records and platform file are at one scale, `scale` is 1"


class Hint(NamedTuple):
    """Remark that several records of a campaign support together.

    Attributes:
        record: The first of these records.
        channel: Its channel that the remark is about.
        message: The remark in words.
    """

    record: Record
    channel: str
    message: str


def campaign_hints(
    records: Sequence[Record], modes: Modes, widths: Float[np.ndarray, "6"], length: float, scale: float
) -> tuple[Hint, ...]:
    """Return what all decays tell together about units, scale and signs.

    Args:
        records: the decays that are used, SI at full scale.
        modes: natural modes of the model of the platform file.
        widths: (6,) what rotations are times in their shapes.
        length: m, its radius of gyration.
        scale: the manifest's.
    """
    times = tuple(_period_hints(records, modes, scale))
    # lengths go with times, by the scale
    sizes = tuple(_release_size_hints(records, length, scale, {"length"} if times else set()))
    wrong_quantities = {quantity(hint.channel) for hint in (*times, *sizes)}
    return (*times, *sizes, *_coupling_hints(records, modes, widths, length, scale, wrong_quantities))


def _period_hints(records: Sequence[Record], modes: Modes, scale: float) -> Iterator[Hint]:
    """Are all natural periods off by one factor?"""
    ratios: dict[str, list[float]] = {}
    for record in records:
        dof = str(record.degree_of_freedom)
        period = dominant_period(record.time, record.values[dof])
        if period is not None and np.isfinite(model_period := modes.of(dof)):
            ratios.setdefault(dof, []).append(math.log(period / model_period))
    if sum(map(len, ratios.values())) < 2:
        return
    every = [value for values in ratios.values() for value in values]
    ratio = float(np.median(every))
    first, dofs = records[0], " and ".join(ratios)
    times = f"{math.exp(ratio):.3g} times" if ratio > 0 else f"1/{math.exp(-ratio):.3g} of"
    sentence = f"all measured periods, of {dofs}, are {times} the model's"
    for factor, why in _time_factors(scale):
        if all(abs(value - math.log(factor)) < RATIO_TOLERANCE for value in every):
            yield Hint(first, "time", f"{sentence}: {why}")
            return
    if (
        scale == 1
        and len(ratios) > 1
        and abs(ratio) > MIN_COMMON_RATIO
        and max(abs(value - ratio) for value in every) < SAME_RATIO_TOLERANCE
        and ratio < 0
    ):
        yield Hint(
            first, "time", f"{sentence}, as those of a model at 1:{math.exp(-2 * ratio):.3g} would be. Is `scale` left out?"
        )


def _time_factors(scale: float) -> Iterator[tuple[float, str]]:
    if scale != 1:
        root = f"the square root of `scale`, {scale**0.5:.3g}"
        yield scale**0.5, f"longer by {root}. {SAME_SCALE}" if scale > 1 else f"shorter by {root}. Is `scale` turned round?"
        yield scale**-0.5, f"off by {root}. Were times scaled down before?"
        turned = f"is `scale` turned round (1:{1 / scale:.3g} is `scale: {1 / scale:.3g}`)?"
        yield scale, "longer by `scale`. Times go with its square root: were they scaled before?" if scale > 1 else turned
        yield 1 / scale, f"{'shorter' if scale > 1 else 'longer'} by `scale` itself: were times scaled down before?"
    for unit, factor in (("milliseconds", 1000.0), ("minutes", 60.0)):
        yield factor, f"`channels.time.unit`: {unit} and seconds mixed up?"
        yield 1 / factor, f"`channels.time.unit`: {unit} and seconds mixed up?"


def _release_size_hints(records: Sequence[Record], length: float, scale: float, wrong_quantities: set[str]) -> Iterator[Hint]:
    """Are all released displacements, all angles, or all of one motion of a size that no release has?"""
    told: set[str] = set()
    for name, dofs in {"displacement": DOFS[:3], "angle": DOFS[3:], **{dof: (dof,) for dof in DOFS}}.items():
        released = [record for record in records if record.degree_of_freedom in dofs]
        if len(released) < 2 or told & set(dofs) or quantity(dofs[0]) in wrong_quantities:
            continue
        turns = quantity(dofs[0]) == "angle"
        sizes = [_size(record) / (1.0 if turns else length) for record in released]
        lowest, highest = (SMALLEST_RELEASE_ANGLE, LARGEST_RELEASE_ANGLE) if turns else (SMALLEST_RELEASE, LARGEST_RELEASE)
        if not (max(sizes) < lowest or min(sizes) > highest):
            continue
        large = min(sizes) > highest
        fitting = [
            (f"{factor:.4g}", units)
            for factor, units in _size_factors(turns, scale)
            if all(USUAL_RELEASES[0] < (size / factor if large else size * factor) < USUAL_RELEASES[1] for size in sizes)
        ]
        if fitting:
            told |= set(dofs)
            times, units = (" or ".join(words) for words in zip(*fitting, strict=True))
            keys = ", ".join(f"`channels.{dof}.unit`" for dof in dict.fromkeys(r.degree_of_freedom for r in released))
            message = f"all releases in {name} are as if {times} times too {'large' if large else 'small'}"
            yield Hint(released[0], str(released[0].degree_of_freedom), f"{message}. Are {units} mixed up ({keys})?")


def _size_factors(turns: bool, scale: float) -> Iterator[tuple[float, str]]:
    if turns:
        yield from ((DEGREES_PER_RADIAN, "degrees and radians"), (1000.0, "milliradians and radians"))
        return
    yield from ((1000.0, "millimetres and metres"), (100.0, "centimetres and metres"))
    if scale > 1:
        yield scale, "lengths at the model's and at full scale (`scale`)"


def _coupling_hints(
    records: Sequence[Record],
    modes: Modes,
    widths: Float[np.ndarray, "6"],
    length: float,
    scale: float,
    wrong_quantities: set[str],
) -> Iterator[Hint]:
    """Do two motions of a mode go together as the model's do?

    Quantities in `wrong_quantities` are left aside.
    """
    ratios: dict[tuple[str, str], list[float]] = {}
    first_records: dict[tuple[str, str], Record] = {}
    for record in records:
        dof = str(record.degree_of_freedom)
        if not np.isfinite(modes.of(dof)):
            continue
        mode = min(range(len(modes.period)), key=lambda i: abs(modes.period[i] - modes.of(dof)))
        shape = dict(zip(DOFS, map(float, modes.shape[mode] / widths), strict=True))
        for other in record.values:
            expected = shape[other] / shape[dof]
            if other == dof or abs(expected) * _arm(other, length) / _arm(dof, length) < MIN_COUPLED_MOTION:
                continue
            ratio = _ratio(record, dof, other)
            if ratio is not None:
                pair = tuple(sorted((dof, other), key=DOFS.index))
                value = ratio / expected if pair[0] == other else expected / ratio
                ratios.setdefault((pair[0], pair[1]), []).append(value)
                first_records.setdefault((pair[0], pair[1]), record)
    for (first, second), values in ratios.items():
        message = _factor_in_words(first, second, values, scale, wrong_quantities)
        if message is not None:
            yield Hint(
                first_records[first, second], second, f"in {len(values)} {'decay' if len(values) == 1 else 'decays'} {message}"
            )


def _factor_in_words(first: str, second: str, values: Sequence[float], scale: float, wrong_quantities: set[str]) -> str | None:
    """Describe the factor by which all ratios of two motions miss the model's.

    Args:
        first: Name of one motion.
        second: Name of the other motion.
        values: Ratio of `first` to `second` over the model's ratio, one for each record (-).
        scale: The manifest's scale.
        wrong_quantities: Quantities that are off by themselves: time, length, angle.

    Returns:
        The description with what may explain the factor; None where nothing does.
    """
    if all(value < 0 for value in values) and all(abs(math.log(-value)) < UNITY_TOLERANCE for value in values):
        keys = f"(`channels.{first}.sign` or `channels.{second}.sign`)"
        return (
            f"{first} and {second} go together as the model's do, with the other sign. Is an axis reversed {keys}, or were "
            "they recorded at another point (`tracked_point`)?"
        )
    turns = quantity(first) != quantity(second)
    if {quantity(first), quantity(second)} & wrong_quantities or (turns and "time" in wrong_quantities):
        return None
    sizes = [math.log(abs(value)) for value in values]
    larger, smaller = (first, second) if sizes[0] > 0 else (second, first)
    factors = [(1000.0, f"millimetres and metres mixed up (`channels.{first}.unit`)")]
    if turns:
        factors.append((DEGREES_PER_RADIAN, f"degrees and radians mixed up (`channels.{second}.unit`)"))
        factors += [(max(scale, 1 / scale), "lengths not at the scale that `scale` states")] if scale != 1 else []
    reasons = [
        why
        for factor, why in factors
        if all(abs(size - math.copysign(math.log(factor), sizes[0])) < UNITY_TOLERANCE for size in sizes)
    ]
    times = f"{math.exp(abs(float(np.median(sizes)))):.3g} times"
    return f"{larger} is {times} too large beside {smaller}, by the model. Are {' or '.join(reasons)}?" if reasons else None


def _size(record: Record) -> float:
    values = record.values[str(record.degree_of_freedom)]
    return float(np.percentile(np.abs(values - np.median(values)), 99))


def _arm(dof: str, length: float) -> float:
    return length if quantity(dof) == "angle" else 1.0


def _ratio(record: Record, dof: str, other: str) -> float | None:
    """Motion `other` over `dof` at the period of `dof`; None where they are out of phase."""
    period = dominant_period(record.time, record.values[dof])
    if period is None:
        return None
    time = np.linspace(record.time[0], record.time[-1], len(record.time))
    wave = np.hanning(len(time)) * np.exp(-2j * np.pi * time / period)

    def part(name: str) -> complex:
        values = np.interp(time, record.time, record.values[name])
        return complex(((values - values.mean()) * wave).sum())

    ratio = part(other) / part(dof)
    return ratio.real if abs(ratio.imag) < MAX_PHASE_RATIO * abs(ratio.real) else None
