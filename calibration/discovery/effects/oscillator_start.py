"""Starting point for a hidden oscillator: periods and damping ratios to try."""

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from calibration.discovery.effects.peaks import MAX_PEAKS, highest_peaks
from calibration.discovery.eliminated_least_squares import projected_products

if TYPE_CHECKING:
    from calibration.discovery.linearisations import Linearisation
    from calibration.discovery.study import Study

ShapeFinder = Callable[["Study", "Linearisation", np.ndarray], tuple[Mapping[str, float], ...]]

PERIOD_SPACING = 1.03  # ratio of one period to the next: half a resonance's width
NEUTRAL_DAMPING_RATIO = 0.03  # damping ratio at the neutral value
TRIED_DAMPING_RATIOS = (NEUTRAL_DAMPING_RATIO, 0.2)  # damping ratios that are tried


def response(omega: np.ndarray, period: float, ratio: float) -> np.ndarray:
    """Force of an oscillator of unit mass per acceleration of its support, with the sign reversed.

    Args:
        omega: Circular frequencies (rad/s).
        period: Its own period (s).
        ratio: Its damping ratio.

    References:
        Den Hartog 1956, Mechanical Vibrations, chapter 3.
    """
    own_frequency = 2 * math.pi / period
    spring = own_frequency**2 + 2j * ratio * own_frequency * omega
    return spring / (spring - omega**2)


def oscillator_period_finder(dof: str, shortest: float, longest: float) -> ShapeFinder:
    """A search for the likeliest periods of `HiddenOscillator` in a motion, between two periods (s).

    In a linear hull, slopes scale with the oscillator's response. So one linearisation at the shortest period gives the gain at
    all periods. The part of it that the fitted directions can explain is projected out. A refit decides.
    """

    def periods_to_try(study: "Study", linearisation: "Linearisation", slopes: np.ndarray) -> tuple[Mapping[str, float], ...]:
        tried = shortest * PERIOD_SPACING ** np.arange(int(math.log(longest / shortest, PERIOD_SPACING)) + 1)
        omega = 2 * math.pi * study.frequency
        per_response = slopes.reshape(-1, 2) @ [1, 1j] / response(omega, shortest, NEUTRAL_DAMPING_RATIO)
        columns = np.stack(
            [per_response * response(omega, period, ratio) for ratio in TRIED_DAMPING_RATIOS for period in tried], axis=1
        )
        rows = np.stack([columns.real, columns.imag], axis=1).reshape(len(slopes), -1)
        along, size = projected_products(study, linearisation, rows)
        gain = np.where(along < 0, along**2 / np.maximum(size, 1e-300), 0.0)  # a mass is not negative
        best = [
            (float(of_ratio[i]), float(tried[i]), ratio)
            for ratio, of_ratio in zip(TRIED_DAMPING_RATIOS, gain.reshape(len(TRIED_DAMPING_RATIOS), -1))
            for i in highest_peaks(np.pad(of_ratio, 1)) - 1
        ]
        prefix = f"hidden_oscillator.{dof}."
        return tuple(
            {f"{prefix}period": period, f"{prefix}damping_ratio": ratio} for _, period, ratio in sorted(best)[::-1][:MAX_PEAKS]
        )

    return periods_to_try
