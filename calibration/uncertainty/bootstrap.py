"""Bootstrap of a calibration, over repeats of tests or over blocks of residuals."""

from __future__ import annotations

import numpy as np

from calibration.identifiability.standard_deviations import correlated_samples
from calibration.uncertainty.bootstrap_draws import Bootstrap, Progress, refit_draws
from calibration.uncertainty.likelihood import Likelihood
from jaxhydro.errors import InputError
from jaxhydro.errors import Problem as Wrong

MIN_FREEDOM = 0.25  # a residual that a fit has taken three quarters of is raised twofold, and no more


def bootstrap_repeats(likelihood: Likelihood, draws: int = 200, seed: int = 0, progress: Progress | None = None) -> Bootstrap:
    """Bootstrap over repeated tests (`repeat_of` in the manifest).

    Of n repeats n - 1 are drawn with replacement, and weigh n / (n - 1) each. This has the right variance even for two or
    three repeats. A test without repeats is in every draw, so that its own scatter is not counted.

    Args:
        likelihood: Likelihood of a finished fit.
        draws: Number of draws.
        seed: Seed of the random numbers.
        progress: Function that is called with the number of draws done and asked for.

    Returns:
        The draws.

    Raises:
        InputError: If there are no repeats.

    References:
        Rao and Wu 1988, Journal of the American Statistical Association 83, 231-241, section 2.
    """
    records = likelihood.fit.decays.records
    groups = repeats({record.id: record.test.repeat_of for record in records})
    if not any(len(group) > 1 for group in groups.values()):
        ids = ", ".join(record.id for record in records)
        hint = "Say `repeat_of: <id>` in the manifest, or bootstrap over blocks."
        raise InputError("bootstrap", [Wrong("tests", "repeats of a fitted test", f"none among {ids}", hint)])
    order = {record.id: i for i, record in enumerate(records)}
    random, weight = np.random.default_rng(seed), np.ones((draws, len(records)))
    for group in groups.values():
        n = len(group)
        if n > 1:
            count = random.multinomial(n - 1, np.full(n, 1 / n), size=draws)
            weight[:, [order[id] for id in group]] = count * n / (n - 1)
    weights = weight[:, :, None] * np.asarray(likelihood.fit.decays.weight)

    def inputs(k: slice) -> tuple[np.ndarray, np.ndarray]:
        measured = np.asarray(likelihood.fit.decays.problem.data.measured)
        return np.broadcast_to(measured, (len(weights[k]), *measured.shape)), weights[k]

    return refit_draws(likelihood, "repeats", inputs, draws, seed, dict(groups), progress)


def repeats(repeat_of: dict[str, str | None]) -> dict[str, tuple[str, ...]]:
    """Ids of tests that repeat each other, by the id of the first one.

    An id that is not among the tests stands for the tests that repeat it.

    Args:
        repeat_of: `repeat_of` of every test, by its id.
    """
    groups: dict[str, tuple[str, ...]] = {}
    for id in repeat_of:
        first, visited = id, {id}
        while (original := repeat_of.get(first)) is not None and original not in visited:
            first = original
            visited.add(original)
        # a ring has no first: the least of its ids
        first = min(visited) if repeat_of.get(first) is not None else first
        groups[first] = (*groups.get(first, ()), id)
    return groups


def bootstrap_blocks(likelihood: Likelihood, draws: int = 200, seed: int = 0, progress: Progress | None = None) -> Bootstrap:
    """Bootstrap over moving blocks of the residuals, added to the fitted motion and fitted again.

    A block is as long as the released motion's period or twice the residual's correlation length, and at most a third of
    the record. The channels of a record are drawn together. The fit has made residuals near the decay's frequency too
    small. They are raised by (1 - h)^-1/2 at each frequency, with the leverage h there (HC2).

    Args:
        likelihood: Likelihood of a finished fit.
        draws: Number of draws.
        seed: Seed of the random numbers.
        progress: Function that is called with the number of draws done and asked for.

    Returns:
        The draws.

    References:
        Kuensch 1989, Annals of Statistics 17, 1217-1241 (moving blocks). MacKinnon and White 1985, Journal of Econometrics
        29, 305-325 (HC2).
    """
    fit = likelihood.fit
    raised, lengths = _raised(likelihood), {}
    for i, record in enumerate(fit.decays.records):
        n = len(record.time)
        step = float(record.time[-1] - record.time[0]) / (n - 1)
        period = 2 * np.pi / float(fit.decays.problem.data.pace[i]) / step
        size = max([period, *(2 * correlated_samples(raised[i, j, :n]) for k, j in likelihood.spectra if k == i)])
        lengths[record.id] = max(1, min(round(size), n // 3)), step
    random = np.random.default_rng(seed)
    fitted = np.asarray(fit.decays.problem.data.measured) + likelihood.residual
    weight = np.asarray(fit.decays.weight)

    def inputs(k: slice) -> tuple[np.ndarray, np.ndarray]:
        count = len(range(draws)[k])
        noise = np.zeros((count, *fitted.shape))
        for i, record in enumerate(fit.decays.records):
            n, length = len(record.time), lengths[record.id][0]
            first = random.integers(0, n - length + 1, size=(count, -(-n // length)))
            indices = (first[:, :, None] + np.arange(length)).reshape(count, -1)[:, :n]
            noise[:, i, :, :n] = np.moveaxis(raised[i][:, indices], 0, 1)
        present = np.asarray(fit.decays.problem.data.present)
        return (fitted - noise) * present, np.broadcast_to(weight, (count, *weight.shape))

    groups: dict[str, tuple[str, ...] | float] = {id: length * step for id, (length, step) in lengths.items()}
    return refit_draws(likelihood, "blocks", inputs, draws, seed, groups, progress)


def _raised(likelihood: Likelihood) -> np.ndarray:
    """Residuals (r, c, t) of mean zero, raised for the share that the fit has absorbed."""
    raised = np.zeros(likelihood.residual.shape)
    for (i, j), spectrum in likelihood.spectra.items():
        n = len(likelihood.fit.decays.records[i].time)
        wave = np.fft.rfft(likelihood.residual[i, j, :n]) / np.sqrt(np.maximum(spectrum.freedom, MIN_FREEDOM))
        wave[0] = 0.0
        raised[i, j, :n] = np.fft.irfft(wave, n)
    return raised
