"""Hint on wave records that lack the second-order waves of theory."""

from collections.abc import Sequence

import numpy as np

from calibration.campaign.runs import Run
from jaxhydro.waves.irregular_sea import IrregularSea
from jaxhydro.waves.second_order import KINDS

MIN_SECOND_ORDER_SHARE = 0.4  # of theory: a record with less has no second order
MIN_THEORY_OVER_NOISE = 3.0  # of theory's part in a band that is compared
MAX_CUTOFF_RATIO = 1.35  # times the cutoff: up to there sums are compared
MIN_LINES = 8  # Fourier lines in a band that is compared


def second_order_hint(recorded: Sequence[tuple[Run, IrregularSea]], band: tuple[float, float]) -> tuple[str, ...]:
    """Remark that wave records lack second-order waves of theory, and how a campaign states that.

    Sums and differences of frequencies are compared above and below the band of first-order waves, where no others are.

    Args:
        recorded: Runs in waves, and their seas at second order.
        band: Lowest and highest frequency (Hz) of first-order waves.

    Returns:
        The remark; empty where the records have the visible part of theory's waves.
    """
    shares = np.array([_shares(run, sea, *band) for run, sea in recorded])
    visible = [shares[np.isfinite(shares[:, i]), i] for i in range(2)]
    lacking = [kind for kind, values in zip(KINDS, visible) if values.size and np.median(values) < MIN_SECOND_ORDER_SHARE]
    if not lacking:
        return ()
    present = [kind for kind, values in zip(KINDS, visible) if values.size and kind not in lacking]
    percent = " and ".join(
        f"{100 * max(0.0, float(np.median(values))):.0f} % at {kind}s"
        for kind, values in zip(KINDS, visible)
        if kind in lacking
    )
    key = f"{{kinds: [{present[0]}]}}" if present else "{order: 1}"
    return (
        f"of the second-order waves that theory gives for waves of this height the records have {percent} of frequencies. "
        f"State in campaign.yaml `records: {key}` if the waves lack them, too; `records: {{order: 2}}` if only records do",
    )


def _shares(run: Run, sea: IrregularSea, low: float, cutoff: float) -> tuple[float, float]:
    """Fractions of theory's second-order elevation that a record has.

    Returns:
        The fractions above and below the first-order band (-); NaN: not visible.
    """
    first = sea.gauge(run.time, run.position, order=1)
    second = sea.gauge(run.time, run.position) - first
    taper = np.hanning(len(first))
    frequency = np.fft.rfftfreq(len(first), run.step)
    measured, theory = (np.fft.rfft(taper * (x - x.mean())) for x in (run.wave - first, second))
    noise = max(float(r.noise.get("wave", 0.0)) for r in run.records)

    def share(low: float, high: float) -> float:
        inside = (frequency > low) & (frequency < high)
        power = float((np.abs(theory[inside]) ** 2).sum())
        level = noise**2 * float((taper**2).sum()) * inside.sum()
        if inside.sum() <= MIN_LINES or power <= MIN_THEORY_OVER_NOISE**2 * level:
            return float("nan")
        return float((np.conj(theory[inside]) * measured[inside]).sum().real) / power

    return share(1.03 * cutoff, MAX_CUTOFF_RATIO * cutoff), share(0.15 * low, 0.95 * low)
