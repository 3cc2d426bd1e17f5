"""Second-order content of wave records, seen before any model is fitted."""

import math
from dataclasses import replace

import numpy as np
from scipy.ndimage import uniform_filter1d

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest import IN_WAVES
from calibration.campaign.runs import Run
from calibration.residuals.measured_seas import Options, Seas, options_of, sea_of
from jaxhydro.environment import Environment
from jaxhydro.waves.irregular_sea import IrregularSea

MIN_SECOND_ORDER_SHARE = 0.4  # of theory: a record with less has no second order
NEIGHBOURING_LINES = 9  # Fourier lines over which the level is averaged
MIN_THEORY_OVER_NOISE = 3.0  # of theory's part in a band that is compared
MAX_CUTOFF_RATIO = 1.35  # times the cutoff: up to there sums are compared
MIN_CUT_GAIN = 5.0  # decrease of -2 ln L that a cut of differences needs to be tried


def options_for(campaign: Campaign, options: Options | None = None) -> tuple[Options, tuple[str, ...]]:
    """Choose how seas are reconstructed from the wave records of a campaign.

    Second-order sums and differences by theory are compared with the record, at frequencies without first-order waves. The
    record of a numerical tank may have differences only, or be linear. A campaign that
    states the order of its waves is taken at its word.

    Returns:
        The options, and the reasons in words.
    """
    options = options_of(campaign) if options is None else options
    stated = campaign.manifest.records.order is not None
    if stated or not any(r.kind in IN_WAVES and r.use != "ignore" for r in campaign.records):
        return options, ()
    from calibration.campaign.runs import runs

    environment = campaign.model.environment
    found = [_shares(run, environment, options) for run in runs(campaign)]
    kinds, words = list(options.kinds), []
    for i, kind in enumerate(("sum", "difference")):
        seen = [share for one in found if (share := one[i]) is not None]
        if seen and kind in kinds and float(np.median(seen)) < MIN_SECOND_ORDER_SHARE:
            kinds.remove(kind)  # type: ignore[arg-type]
            percent = 100 * max(0.0, float(np.median(seen)))
            words.append(
                f"the wave records have {percent:.0f} % of the second order at {kind}s of frequencies "
                "that waves of their height bind: it is left out of the seas"
            )
    if not kinds:
        return replace(options, order=1), tuple(words)
    return replace(options, kinds=tuple(kinds)), tuple(words)  # type: ignore[arg-type]


def simulated_by_program(options: Options) -> bool:
    """Whether a program made the records: in real water, second-order differences come with sums."""
    return options.order == 2 and options.kinds == ("difference",)


def highest_difference(recorded: Seas) -> float | None:
    """Frequency (Hz) above which records have no second-order differences; None: they seem to have all.

    With Fourier lines X, theory's part T and a level s^2 from the neighbouring lines, -2 ln L is |X - T|^2 / s^2 below the cut
    and |X|^2 / s^2 above. The cut minimises their sum. First-order waves hide what is close to them, so that motions have to
    confirm it.
    """
    found = [_gains(run, made.sea) for run, made in recorded]
    grid = np.unique(np.concatenate([frequency for frequency, _ in found]))
    gain = np.sum([np.interp(grid, frequency, np.cumsum(each)) for frequency, each in found], axis=0)
    best = int(np.argmax(gain))
    return float(grid[best]) if gain[best] - gain[-1] > MIN_CUT_GAIN else None


def _gains(run: Run, made: IrregularSea) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (Hz) of the first-order band, and gain (-2 ln L) by second-order differences there."""
    second = made.gauge(run.time, run.position, order=2)
    taper = np.hanning(len(second))
    frequency = np.fft.rfftfreq(len(second), run.step)
    first, last = np.asarray(made.components.omega)[[0, -1]] / (2 * math.pi)
    inside = (frequency > first) & (frequency < last)
    measured, theory = (np.fft.rfft(taper * (x - x.mean()))[inside] for x in (run.wave, second))
    with_it, without = np.abs(measured - theory) ** 2, np.abs(measured) ** 2
    # by their logarithms, lines may rise steeply: of Gaussian ones that mean is lower by Euler's constant
    logarithms = (np.log(np.maximum(each, 1e-300)) for each in (with_it, without))
    level = np.exp(
        np.euler_gamma + np.minimum(*(uniform_filter1d(each, NEIGHBOURING_LINES, mode="nearest") for each in logarithms))
    )
    # of neighbouring lines a taper leaves two of three
    return frequency[inside], (without - with_it) / level * 2 / 3


def _shares(run: Run, environment: Environment, options: Options) -> tuple[float | None, float | None]:
    """Fraction of theory's second-order elevation that a record has.

    Returns:
        The fractions above and below the first-order band; None: not visible.
    """
    made = sea_of(run, environment, options).sea
    first = made.gauge(run.time, run.position, order=1)
    second = made.gauge(run.time, run.position) - first
    left = run.wave - run.wave.mean() - first
    taper = np.hanning(len(left))
    frequency = np.fft.rfftfreq(len(left), run.step)
    measured, theory = (np.fft.rfft(taper * (x - x.mean())) for x in (left, second))
    noise = max(float(r.noise.get("wave", 0.0)) for r in run.records)
    found: list[float | None] = []
    for low, high in ((1.03 * options.cutoff, MAX_CUTOFF_RATIO * options.cutoff), (0.15 * options.low, 0.95 * options.low)):
        inside = (frequency > low) & (frequency < high)
        power = float((np.abs(theory[inside]) ** 2).sum())
        level = noise**2 * float((taper**2).sum()) * inside.sum()
        share = float((np.conj(theory[inside]) * measured[inside]).sum().real) / max(power, 1e-300)
        found.append(share if power > MIN_THEORY_OVER_NOISE**2 * level and inside.sum() > 8 else None)
    return found[0], found[1]
