"""Command `uncertainty`: intervals of the parameters of a finished calibration."""

import fnmatch
from collections.abc import Iterator, Sequence
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.commands.loaded_campaign import load
from calibration.fitting.decay_fit import run_fit
from calibration.fitting.progress import Progress
from calibration.formatting import number
from calibration.results.applied_calibration import unknown_values_error
from calibration.results.calibration_file import CalibrationFile, read_saved
from calibration.results.result_folder import RESULT_FILE
from calibration.results.uncertainty_file import (
    interval_sentence,
    intervals_table,
    other_intervals_table,
    summary_of,
)
from calibration.results.write_uncertainty import Uncertainty, write_uncertainty
from calibration.uncertainty.bootstrap import bootstrap_blocks, bootstrap_repeats, repeats
from calibration.uncertainty.bootstrap_draws import Bootstrap
from calibration.uncertainty.likelihood import Likelihood
from calibration.uncertainty.likelihood_of_fit import likelihood_of, restored_fit
from calibration.uncertainty.nuts import sample
from calibration.uncertainty.posterior_samples import Samples
from calibration.uncertainty.profile import Profile, profile
from jaxhydro.cli.console import complain, counting, progress, say, table
from jaxhydro.errors import InputError, Problem, suggest
from jaxhydro.interrupts import stopping

MAX_REFIT_SHIFT = 0.1  # standard deviations by which a refit may miss the file's values; of the same fit it is some 1e-8
CHAINS, WARMUP, DRAWS = 4, 150, 350  # of NUTS
REFIT_TIME_SHARE = 0.5  # its share of the time, where profiles follow


def quantify(
    path: Path,
    calibration: Path,
    out: Path,
    *,
    profiles: Sequence[str] = (),
    draws: int | None = None,
    nuts: bool = False,
    level: float = 0.95,
    seed: int = 0,
    figures: bool = True,
) -> bool:
    """Find, write and print intervals of a calibration's parameters.

    What does not fit together is refused before anything takes time, where that can be seen.

    Args:
        path: Folder or manifest of the campaign.
        calibration: The calibration's file or folder.
        out: Folder of the results.
        profiles: Labels or patterns of the parameters whose profiles are made.
        draws: Number of resamplings; None: no bootstrap.
        nuts: Whether the posterior is sampled.
        level: Probability of an interval (-).
        seed: Seed of resamplings and samples.
        figures: Whether figures are written.

    Returns:
        False where the refit of the calibration's records did not converge. The result is then marked so.

    Raises:
        InputError: Arguments or files do not fit together.
    """
    _check(draws, nuts, level)
    campaign = load(path, out)
    calibration = calibration / RESULT_FILE if calibration.is_dir() else calibration
    saved = read_finished_calibration(campaign, calibration)
    labels = match_labels(profiles, saved)
    likely, along = _likelihood(campaign, saved, calibration, labels, level)
    bootstraps = {} if draws is None else _run_bootstrap(likely, draws, seed)
    samples = _run_nuts(likely, seed) if nuts else None
    uncertainty = Uncertainty(saved, str(calibration), likely, level, seed, along, draws or 0, bootstraps, samples, nuts)
    written = write_uncertainty(uncertainty, out, figures)
    table(f"Parameters, {written.percent} intervals by Laplace, with coloured errors", *intervals_table(written))
    if (rows := other_intervals_table(written))[1]:
        table(f"{written.percent} intervals in other ways", *rows)
    for note in written.notes:
        say(f"Note: {note}")
    say(f"Results are in {out}; `jaxhydro report {out}` makes a page of them")
    if not written.converged:
        complain("not converged: the results are marked so")
    say(interval_sentence(summary_of(written)), "bold")
    return written.converged


def _check(draws: int | None, nuts: bool, level: float) -> None:
    """Raises InputError for options that make no sense by themselves."""
    if not 0 < level < 1:
        hint = f"For {level:g} % say {level / 100:g}." if 1 < level < 100 else ""
        raise InputError("--level", [Problem("", "a number between 0 and 1", f"{level:g}", hint)])
    # a quantile beyond the outermost draw is none
    least = int(np.ceil(2 / (1 - level) - 1e-9))
    if draws is not None and draws < least:
        raise InputError("--bootstrap", [Problem("", f"{least} resamplings or more, for {100 * level:.4g} %", str(draws))])
    if nuts and find_spec("numpyro") is None:
        raise InputError("--nuts", [Problem("", "numpyro", "that it is not installed", "pip install 'jaxhydro[nuts]'")])


def read_finished_calibration(campaign: Campaign, path: Path) -> CalibrationFile:
    """Read a finished calibration of the campaign's decays from a calibration.json.

    Raises:
        InputError: The file has no such calibration.
    """
    saved = read_saved(path)
    for fault in _faults(saved, campaign):
        raise InputError(str(path), [fault])
    model = campaign.model
    if unknown := [label for label in saved.values() if label not in model.values]:
        raise unknown_values_error(saved, unknown, model, campaign.platform.name, path)
    return saved


def _faults(saved: CalibrationFile, campaign: Campaign) -> Iterator[Problem]:
    if saved.augmented is not None:
        yield Problem("", f"a {RESULT_FILE}, as `jaxhydro calibrate` writes it", "a diagnosis")
    if saved.campaign != campaign.manifest.name:
        yield Problem("campaign", repr(campaign.manifest.name), repr(saved.campaign), "It is another campaign's calibration.")
    if saved.platform and saved.platform != campaign.platform.name:
        yield Problem("platform", repr(campaign.platform.name), repr(saved.platform), "Calibrate this platform first.")
    used = {id: test.kind for id, test in saved.tests.items() if test.use == "fit"}
    if others := sorted({kind for kind in used.values() if kind != "decay"}):
        expected = "a calibration to free decays alone (`jaxhydro calibrate --tests decays`)"
        ids = [id for id, kind in used.items() if kind != "decay"]
        yield Problem("tests", expected, f"fitted tests that are {' and '.join(others)} ({', '.join(ids)})")
    decays = [record.id for record in campaign.used("fit") if record.kind == "decay"]
    if set(used) != set(decays):
        hint = "The campaign has changed since: calibrate again."
        yield Problem("tests", f"the decays marked fit ({', '.join(decays) or 'none'})", ", ".join(used) or "none", hint)
    if not saved.baseline.parameters:
        yield Problem("baseline.parameters", "at least one calibrated parameter", "none")
    if not saved.baseline.converged:
        yield Problem("baseline.converged", "true, a finished calibration", "false")
    for label, parameter in saved.baseline.parameters.items():
        if parameter.start is None:
            yield Problem(f"baseline.parameters.{label}.start", "the value that the fit began from", "nothing")


def match_labels(profiles: Sequence[str], saved: CalibrationFile) -> list[str]:
    """Parameters that labels or patterns (`column.*`) name, each once.

    Raises:
        InputError: A label or pattern names no parameter.
    """
    labels = list(saved.values())
    for pattern in profiles:
        if not fnmatch.filter(labels, pattern):
            expected = f"a calibrated parameter ({', '.join(labels)})"
            raise InputError("--profile", [Problem("", expected, repr(pattern), suggest(pattern, labels))])
    return [label for label in labels if any(fnmatch.fnmatch(label, pattern) for pattern in profiles)]


def _likelihood(
    campaign: Campaign, saved: CalibrationFile, path: Path, labels: Sequence[str], level: float
) -> tuple[Likelihood, dict[str, Profile]]:
    """The calibration's likelihood, and profiles along parameters."""
    share, parameters = REFIT_TIME_SHARE if labels else 1.0, saved.baseline.parameters
    with progress() as show:

        def report(stage: str, iteration: int, objective: float, fraction: float) -> None:
            show(Progress(f"fitting again: {stage}", iteration, objective, share * fraction))

        began = {label: parameter.start for label, parameter in parameters.items()}
        fit = restored_fit(campaign, began, saved.values(), report)
        point = np.asarray(fit.unknowns.shared)
        run_fit(fit)
        show(Progress("information and colour of the errors", 0, float("nan"), share))
        likely = likelihood_of(fit)
        _check_same_fit(likely, point, saved, path)
        along = {}
        for i, label in enumerate(labels):
            show(Progress(f"profile of {label}", 0, float("nan"), share + (1 - share) * i / len(labels)))
            along[label] = profile(likely, label, level)
    return likely, along


def _check_same_fit(likely: Likelihood, point: np.ndarray, saved: CalibrationFile, path: Path) -> None:
    """Raise InputError where a fit to the campaign's decays does not end at the file's values."""
    p = len(likely.labels)
    moved = np.abs(likely.estimate[:p] - point) / likely.deviation()
    worst = int(np.argmax(moved))
    if moved[worst] < MAX_REFIT_SHIFT:
        return
    label = likely.labels[worst]
    end, value = likely.value(label, likely.estimate[worst]), saved.values()[label]
    expected = f"{number(end)}, where a fit to this campaign's decays ends"
    actual = f"{number(value)}, {number(float(moved[worst]), 2)} standard deviations away"
    hint = "Has the campaign changed since, or were other tests fitted too (--tests all)? Calibrate its decays again."
    raise InputError(str(path), [Problem(f"baseline.parameters.{label}.value", expected, actual, hint)])


def _run_bootstrap(likely: Likelihood, draws: int, seed: int) -> dict[str, Bootstrap]:
    """Bootstrap over blocks, and over repeats where there are any."""
    bootstraps = {}
    with counting(draws, 0, "resamplings") as count:
        bootstraps["blocks"] = bootstrap_blocks(likely, draws, seed, lambda done, _: count(done, "of the residuals in blocks"))
    groups = repeats({record.id: record.test.repeat_of for record in likely.fit.decays.records})
    if any(len(group) > 1 for group in groups.values()):
        with counting(draws, 0, "resamplings") as count:
            bootstraps["repeats"] = bootstrap_repeats(likely, draws, seed, lambda done, _: count(done, "of repeated tests"))
    return bootstraps


def _run_nuts(likely: Likelihood, seed: int) -> Samples | None:
    """Samples of NUTS; None where the user stops it before there are enough."""
    with counting(CHAINS * (WARMUP + DRAWS), 0, f"draws of {CHAINS} chains, {WARMUP} of each to find its step") as count:
        try:
            return sample(likely, draws=DRAWS, warmup=WARMUP, chains=CHAINS, seed=seed, progress=count)
        except KeyboardInterrupt:
            stopping()
            return None
