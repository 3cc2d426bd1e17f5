"""What the wave records themselves say before any model: whether they have the second order that waves ought to have."""

from dataclasses import replace

import numpy as np

from calibration.campaign import Campaign
from calibration.manifest import IN_WAVES
from calibration.runs import Run
from calibration.seas import Options, sea_of
from jaxhydro.environment import Environment

PRESENT = 0.4  # of what theory has: a record with less has none
SEEN = 3.0  # times the noise in the band, that theory's part has to be, to say anything
ABOVE = 1.35  # of the cutoff: how far above it sums of frequencies are looked for


def options_for(campaign: Campaign, options: Options | None = None) -> tuple[Options, tuple[str, ...]]:
    """Sea options by which the wave records of a campaign are to be read, and why, in words.

    Theory's sums and differences of a record's first-order waves are compared with what the record has at those frequencies
    where there are no first-order waves: a numerical tank's record may hold differences only, or be linear.
    """
    options = Options() if options is None else options
    if not any(r.kind in IN_WAVES and r.use != "ignore" for r in campaign.records):
        return options, ()
    from calibration.runs import runs

    environment = campaign.model.environment
    found = [_shares(run, environment, options) for run in runs(campaign)]
    kinds, words = list(options.kinds), []
    for i, kind in enumerate(("sum", "difference")):
        seen = [share for one in found if (share := one[i]) is not None]
        if seen and kind in kinds and float(np.median(seen)) < PRESENT:
            kinds.remove(kind)  # type: ignore[arg-type]
            percent = 100 * float(np.median(seen))
            words.append(f"the wave records have {percent:.0f} % of the second order at {kind}s of frequencies "
                         "that waves of their height bind: it is left out of the seas")  # fmt: skip
    if not kinds:
        return replace(options, order=1), tuple(words)
    return replace(options, kinds=tuple(kinds)), tuple(words)  # type: ignore[arg-type]


def _shares(run: Run, environment: Environment, options: Options) -> tuple[float | None, float | None]:
    """How much of theory's second-order elevation a record has above and below its first-order band; None: not to be seen."""
    made = sea_of(run, environment, options).sea
    first = made.gauge(run.time, run.position, order=1)
    second = made.gauge(run.time, run.position) - first
    left = run.wave - run.wave.mean() - first
    taper = np.hanning(len(left))
    frequency = np.fft.rfftfreq(len(left), run.step)
    measured, theory = (np.fft.rfft(taper * (x - x.mean())) for x in (left, second))
    noise = max(float(r.noise.get("wave", 0.0)) for r in run.records)
    found: list[float | None] = []
    for low, high in ((1.03 * options.cutoff, ABOVE * options.cutoff), (0.15 * options.low, 0.95 * options.low)):
        inside = (frequency > low) & (frequency < high)
        power = float((np.abs(theory[inside]) ** 2).sum())
        level = noise**2 * float((taper**2).sum()) * inside.sum()
        share = float((np.conj(theory[inside]) * measured[inside]).sum().real) / max(power, 1e-300)
        found.append(share if power > SEEN**2 * level and inside.sum() > 8 else None)
    return found[0], found[1]
