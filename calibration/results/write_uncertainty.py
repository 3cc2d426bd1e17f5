"""Writing of intervals: uncertainty.json, figures."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

import jaxhydro
from calibration.formatting import interval
from calibration.results.calibration_file import CalibrationFile
from calibration.results.result_folder import UNCERTAINTY_FILE, draw, outdated
from calibration.results.uncertainty_file import (
    INTERVAL_METHODS,
    BootstrapDraws,
    ParameterIntervals,
    PosteriorDraws,
    ProfileCurve,
    UncertaintyFile,
)
from calibration.uncertainty.bootstrap import Bootstrap
from calibration.uncertainty.likelihood import Likelihood
from calibration.uncertainty.nuts import Samples
from calibration.uncertainty.profile import Profile
from jaxhydro.files import safe_name, staged
from jaxhydro.result_model import finite_or_null, stated

MAX_END_DIFFERENCE = 0.25  # of half the width, by which intervals differ
Interval = tuple[float | None, float | None]
MAX_R_HAT = 1.05  # r-hat above which chains have not yet seen the same


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """Intervals of a calibration's parameters, found in several ways. `source` is its file, `asked` how many resamplings were
    asked for, `bootstraps` are by method; `sampled`, whether draws from the posterior were."""

    saved: CalibrationFile
    source: str
    likelihood: Likelihood
    level: float
    seed: int
    profiles: dict[str, Profile] = field(default_factory=dict)
    asked: int = 0
    bootstraps: dict[str, Bootstrap] = field(default_factory=dict)
    samples: Samples | None = None
    sampled: bool = False

    @property
    def converged(self) -> bool:
        return bool(self.likelihood.fit.converged)

    def ways(self, label: str) -> dict[str, Interval]:
        """A parameter's intervals beside the Laplace interval, by way: quantiles of draws; of repeats, which may be as few as
        two, the estimate and the draws' deviation."""
        found: dict[str, Interval] = {}
        if label in self.profiles:
            found["profile"] = self.profiles[label].interval
        for method, one in self.bootstraps.items():
            found[method] = one.interval(label, self.level, "normal" if method == "repeats" else "percentile")
        if self.samples is not None:
            found["nuts"] = self.samples.interval(label, self.level)
        return found

    def notes(self) -> tuple[str, ...]:
        """What is to be known before an interval is believed."""
        return tuple(self._notes())

    def _notes(self) -> Iterator[str]:
        fitted = self.saved.best.parameters
        if lost := [label for label in self.likelihood.labels if not fitted[label].identifiable]:
            yield f"the records do not determine {', '.join(lost)}: the prior has a part in the interval"
        if bound := [label for label in self.likelihood.labels if fitted[label].at_bound]:
            yield f"at a bound: {', '.join(bound)}; the Laplace interval is not to be relied on there, a profile is"
        for method, one in self.bootstraps.items():
            kept = len(one.value)
            if kept < self.asked:
                yield f"bootstrap over {method}: in {self.asked - kept} of {self.asked} resamplings a motion ran away; left out"
            if one.unsettled:
                yield f"bootstrap over {method}: {one.unsettled} of {self.asked} resamplings had not come to rest"
            alone = [ids[0] for ids in one.groups.values() if isinstance(ids, tuple) and len(ids) == 1]
            if alone:
                yield f"bootstrap over repeats: {', '.join(alone)} without repeats; what differs there is not counted"
        for label, along in self.profiles.items():
            if _apart(along):
                profiled, laplace = interval(*along.interval), interval(*along.laplace)
                yield f"{label}: {profiled} by the profile, {laplace} by the covariance: quote the profile"
        if self.sampled and self.samples is None:
            yield "NUTS: stopped by the user before there were draws enough"
        if self.samples is not None:
            kept = self.samples.value.shape[1]
            if kept < self.samples.asked:
                yield f"NUTS: stopped by the user after {kept} of {self.samples.asked} draws of every chain"
            if self.samples.divergences:
                yield f"NUTS: {self.samples.divergences} steps went astray"
            apart = [k for k, x in zip(self.samples.labels, self.samples.r_hat, strict=True) if not x < MAX_R_HAT]
            if apart:
                yield f"NUTS: the chains do not agree yet on {', '.join(apart)}"


def _apart(one: Profile) -> bool:
    """Whether an end of a profile's interval is open, or off Laplace's by more than `MAX_END_DIFFERENCE` of half its width."""
    half = 0.5 * (one.laplace[1] - one.laplace[0])
    return any(a is None or abs(a - b) > MAX_END_DIFFERENCE * half for a, b in zip(one.interval, one.laplace, strict=True))


def document(found: Uncertainty) -> UncertaintyFile:
    """Content of uncertainty.json without figures."""
    likely, saved = found.likelihood, found.saved
    excess = likely.excess()
    parameters = {}
    for label in likely.labels:
        one = saved.best.parameters[label]
        intervals = {
            "laplace": likely.interval(label, found.level),
            "white": likely.interval(label, found.level, white=True),
            **found.ways(label),
        }
        parameters[label] = ParameterIntervals(
            **one.model_dump(include={"value", "unit", "meaning", "identifiable", "at_bound"}),
            white_too_small_by=finite_or_null(excess[label]),
            **stated(**{way: tuple(map(finite_or_null, ends)) for way, ends in intervals.items()}),
        )
    return UncertaintyFile(
        campaign=saved.campaign,
        platform=saved.platform,
        jaxhydro=jaxhydro.__version__,
        calibration=found.source,
        level=found.level,
        seed=found.seed,
        converged=found.converged,
        parameters=parameters,
        profiles={label: _profile(one) for label, one in found.profiles.items()},
        bootstrap={method: _bootstrap(one, found.asked) for method, one in found.bootstraps.items()},
        nuts=None if found.samples is None else _samples(found.samples),
        notes=list(found.notes()),
    )


def _profile(one: Profile) -> ProfileCurve:
    values, drop = ([finite_or_null(x) for x in column] for column in (one.grid, one.drop))
    return ProfileCurve(values=values, drop=drop, nu=finite_or_null(one.nu))


def _bootstrap(one: Bootstrap, asked: int) -> BootstrapDraws:
    groups = {name: list(of) if isinstance(of, tuple) else float(of) for name, of in one.groups.items()}
    return BootstrapDraws(asked=asked, draws=len(one.value), unsettled=one.unsettled, groups=groups)


def _samples(one: Samples) -> PosteriorDraws:
    chains, draws = one.value.shape[:2]
    r_hat, effective = (
        {label: finite_or_null(x) for label, x in zip(one.labels, values, strict=True)} for values in (one.r_hat, one.effective)
    )
    return PosteriorDraws(chains=chains, draws=draws, divergences=one.divergences, r_hat=r_hat, effective=effective)


def write_uncertainty(found: Uncertainty, folder: Path, figures: bool = True) -> UncertaintyFile:
    """Write uncertainty.json and figures in place of earlier ones.

    Args:
        found: The intervals.
        folder: Folder of the results, made where absent.
        figures: Whether figures are drawn.

    Returns:
        The content of uncertainty.json.

    Raises:
        InputError: The folder cannot be written.
    """
    with staged(folder, lambda temporary: outdated(folder, temporary, UNCERTAINTY_FILE)) as temporary:
        drawn = draw(_figures(found), temporary) if figures else []
        content = document(found).model_copy(update={"figures": drawn})
        content.write(temporary / UNCERTAINTY_FILE)
    return content


def _figures(found: Uncertainty) -> Iterator[tuple[str, str, Any]]:
    from calibration.plots import uncertainty_figures as uncertainty_plot

    for label, one in found.profiles.items():
        words = "rise of -2 ln L, all else refitted, its level, and the parabola of the covariance"
        yield f"profile-{safe_name(label)}.png", f"{label}: {words}", uncertainty_plot.profile_figure(one)
    pair = most_correlated(found.likelihood)
    draws: dict[str, Bootstrap | Samples] = {**found.bootstraps, **({"nuts": found.samples} if found.samples else {})}
    if pair is not None:
        for way, drawn in draws.items():
            shown = "draws of the two parameters that are tied most, and the ellipse of the covariance (95 %)"
            caption = f"{INTERVAL_METHODS[way]}: {shown}"
            yield f"draws-{way}.png", caption, uncertainty_plot.draws_figure(drawn, *pair)


def most_correlated(likelihood: Likelihood) -> tuple[str, str] | None:
    """The two parameters whose correlation is farthest from none; None where there is one parameter."""
    labels, deviation = likelihood.labels, likelihood.deviation()
    if len(labels) < 2:
        return None
    p = len(labels)
    correlation = likelihood.covariance[:p, :p] / np.outer(deviation, deviation)
    first, second = np.triu_indices(p, 1)
    k = int(np.argmax(np.abs(correlation[first, second])))
    return labels[first[k]], labels[second[k]]
