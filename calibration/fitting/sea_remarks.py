"""Remarks on a calibration in waves: constants of laws, short tests, held-out tests."""

import math
from collections.abc import Iterator, Sequence

from calibration.formatting import listed, number
from calibration.result import TestFit, error_of_energies
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.statics import natural_modes
from jaxhydro.platform.drag_laws import drag_laws_of
from jaxhydro.units import rounded_up

# natural periods: the energy of a random motion in fewer says little (its relative deviation is some 1/sqrt(n))
MIN_PERIODS = 10.0
WORSE_RATIO = 1.1  # of the error before, from which it is said


def sea_remarks(model: Model, tests: Sequence[TestFit]) -> tuple[str, ...]:
    """Remarks on a calibrated model and all tests in waves."""
    return (*_laws(model), *_short(model, tests), *_held_out(tests))


def _laws(model: Model) -> Iterator[str]:
    """Constants of drag laws, without which a coefficient means nothing."""
    for label, law in drag_laws_of(model).items():
        constants = law.model_dump(include={"reference", "window", "cutoff"}, exclude_none=True)
        units = {"reference": "", "window": " s", "cutoff": " Hz"}
        phrase = ", ".join(f"{key} {number(value, 3)}{units[key]}" for key, value in constants.items())
        if phrase:
            yield f"{label}: drag law {law.law}, {phrase}"


def _short(model: Model, tests: Sequence[TestFit]) -> Iterator[str]:
    modes = natural_modes(model)
    longest = 0.0
    alike: dict[str, list[str]] = {}
    for test in tests:
        if test.kind != "irregular" or test.use != "fit":
            continue
        length = float(test.time[-1] - test.time[0])
        periods = {channel: modes.of(channel) for channel in test.bands}
        few = [
            f"{length / period:.1f} of {channel}"
            for channel, period in periods.items()
            if math.isfinite(period) and length < MIN_PERIODS * period
        ]
        if few:
            longest = max(longest, *(MIN_PERIODS * period for period in periods.values() if math.isfinite(period)))
            alike.setdefault(f"{length:.0f} s are few natural periods ({', '.join(few)})", []).append(test.id)
    for short, ids in alike.items():
        yield (
            f"{listed(ids)}: {short}. How much energy a slow motion has in them is to a good part chance, and stated "
            f"deviations are too small. {rounded_up(longest):g} s or more after the transient would tell"
        )


def _held_out(tests: Sequence[TestFit]) -> Iterator[str]:
    for test in tests:
        pairs = [(band.before, band.after) for row in test.bands.values() for band in row.values()]
        if test.use != "holdout" or not pairs:
            continue
        before, after = map(error_of_energies, zip(*pairs, strict=True))
        if after > WORSE_RATIO * before:
            yield (
                f"held out, {test.id} is followed worse than before the fit: error of ln(energy) {number(before, 2)} "
                f"before, {number(after, 2)} after"
            )
