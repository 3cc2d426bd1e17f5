"""Hints on signs and units from measured and simulated motions."""

import math
from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from calibration.campaign.campaign_hints import DEGREES_PER_RADIAN, UNITY_TOLERANCE
from calibration.campaign.manifest_sections import quantity

MIN_CORRELATION = 0.7  # correlation of measured and simulated motion, of either sign, from which their ratio says something


def motion_hints(tests: Iterable[Mapping[str, tuple[np.ndarray, np.ndarray]]]) -> Iterator[str]:
    """Yield what all tests in waves tell together of a channel, measured and simulated in the same waves.

    Args:
        tests: of each, channel -> measured and simulated motion (n,), of what moves in the simulation.
    """
    ratios: dict[str, list[tuple[float, float]]] = {}
    for channels in tests:
        for name, (measured, simulated) in channels.items():
            a, b = measured - np.mean(measured), simulated - np.mean(simulated)
            deviations = math.sqrt(float(a @ a)), math.sqrt(float(b @ b))
            if min(deviations) > 0:
                correlation = float(a @ b) / (deviations[0] * deviations[1])
                ratios.setdefault(name, []).append((math.log(deviations[0] / deviations[1]), correlation))
    followed = [name for name, pairs in ratios.items() if all(abs(correlation) > MIN_CORRELATION for _, correlation in pairs)]
    turned = [
        name
        for name in followed
        if all(correlation < 0 and abs(size) < 2 * UNITY_TOLERANCE for size, correlation in ratios[name])
    ]
    if turned:
        every = len(turned) == len(followed) > 1
        key = "`wave_channel.sign` or its `position`" if every else ", ".join(f"`channels.{name}.sign`" for name in turned)
        yield f"of the other sign than simulated in all tests in waves: {', '.join(turned)}. An axis reversed ({key})?"
    for name, values in ratios.items():
        units, factor = (
            ("degrees and radians", DEGREES_PER_RADIAN) if quantity(name) == "angle" else ("millimetres and metres", 1000.0)
        )
        for sign, word in ((1, "large"), (-1, "small")):
            if all(abs(size - sign * math.log(factor)) < 2 * UNITY_TOLERANCE for size, _ in values):
                yield (
                    f"{name} is {factor:.4g} times too {word}, against that simulated in all {len(values)} tests in waves: "
                    f"{units} mixed up (`channels.{name}.unit`)?"
                )
