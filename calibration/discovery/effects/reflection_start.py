"""Starting point for reflected waves: delays to try."""

from collections.abc import Mapping

import numpy as np

from calibration.discovery.effects.peaks import highest_peaks
from calibration.discovery.eliminated_least_squares import row_weights
from calibration.discovery.linearisations import Linearisation
from calibration.discovery.study import Study
from jaxhydro.water.wave_reflection import DELAY, MAX_DELAY, SEEN

DELAY_SPACING = 0.05  # s, between the delays that are compared
# waves that the gauge did not measure, or did
ZERO_DELAY_GRID: tuple[Mapping[str, float], ...] = tuple({DELAY: 0.0, SEEN: measured} for measured in (0.0, 1.0))


def reflection_delays(
    study: Study, linearisation: Linearisation, slopes: np.ndarray, least: float
) -> tuple[Mapping[str, float], ...]:
    """The likeliest delays (s) for `WaveReflection`.

    Slopes at no delay, shifted in time, are correlated with the residual at frequencies of first-order waves. In a linear
    platform these are the slopes at that delay. A refit decides.

    Args:
        study: The study.
        linearisation: Linearisation with the residual.
        slopes: Slopes at no delay, in rows (n,).
        least: Shortest plausible delay (s).
    """
    later = np.arange(least, MAX_DELAY, DELAY_SPACING)
    weight = row_weights(study, linearisation.residual) * study.used[study.row_series]
    product, power, begin = np.zeros(later.size), 0.0, sum(2 * len(cut.take) for cut in study.cuts[: -len(study.seas)])
    for record, cut in zip(study.seas, study.cuts[-len(study.seas) :]):
        rows = slice(begin, begin := begin + 2 * len(cut.take))
        residual_lines, slope_lines = (values[rows].reshape(-1, 2) @ [1, 1j] for values in (linearisation.residual, slopes))
        duration = record.duration
        line = cut.take % cut.lines
        share = weight[rows][::2] * study.first_order[rows.start // 2 : rows.stop // 2]
        both = np.zeros(cut.lines, complex)
        np.add.at(both, line, share * np.conj(slope_lines) * residual_lines)
        for i in np.flatnonzero(both):
            product += (both[i] * np.exp(2j * np.pi * i / duration * later)).real
        power += float(share @ np.abs(slope_lines) ** 2)
    gain = product**2 / max(power, 1e-300)
    return tuple({DELAY: float(later[i])} for i in highest_peaks(gain))
