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
from calibration.uncertainty.bootstrap_draws import Bootstrap
from calibration.uncertainty.likelihood import Likelihood
from calibration.uncertainty.posterior_samples import Samples
from calibration.uncertainty.profile import Profile
from jaxhydro.files import safe_name, staged
from jaxhydro.result_model import finite_or_null, stated

MAX_END_DIFFERENCE = 0.25  # of half the width, by which intervals differ
Interval = tuple[float | None, float | None]
MAX_R_HAT = 1.05  # r-hat above which chains have not yet seen the same


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """Intervals of a calibration's parameters, found in several ways.

    Attributes:
        saved: The calibration.
        source: Its file.
        likelihood: Likelihood of its fit.
        level: Probability of the intervals.
        seed: Seed of the random numbers.
        profiles: Profile likelihoods by label.
        asked: Number of resamplings asked for.
        bootstraps: Bootstraps by method.
        samples: Draws from the posterior; None where there are none.
        sampled: Whether draws from the posterior were asked for.
    """

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
        """Intervals of a parameter beside the Laplace interval, by way.

        Those of draws are quantiles. Repeats may be as few as two, so their interval comes from the estimate and the
        draws' standard deviation.
        """
        intervals: dict[str, Interval] = {}
        if label in self.profiles:
            intervals["profile"] = self.profiles[label].interval
        for method, bootstrap in self.bootstraps.items():
            intervals[method] = bootstrap.interval(label, self.level, "normal" if method == "repeats" else "percentile")
        if self.samples is not None:
            intervals["nuts"] = self.samples.interval(label, self.level)
        return intervals

    def notes(self) -> tuple[str, ...]:
        """Warnings to be read before an interval is used."""
        return tuple(self._notes())

    def _notes(self) -> Iterator[str]:
        fitted = self.saved.best.parameters
        if lost := [label for label in self.likelihood.labels if not fitted[label].identifiable]:
            yield f"the records do not determine {', '.join(lost)}: the prior has a part in the interval"
        if bound := [label for label in self.likelihood.labels if fitted[label].at_bound]:
            yield f"at a bound: {', '.join(bound)}; the Laplace interval is not to be relied on there, a profile is"
        for method, bootstrap in self.bootstraps.items():
            draws = len(bootstrap.value)
            if draws < self.asked:
                lost_draws = f"{self.asked - draws} of {self.asked}"
                yield f"bootstrap over {method}: in {lost_draws} resamplings a motion ran away; left out"
            if bootstrap.unsettled:
                yield f"bootstrap over {method}: {bootstrap.unsettled} of {self.asked} resamplings had not come to rest"
            alone = [ids[0] for ids in bootstrap.groups.values() if isinstance(ids, tuple) and len(ids) == 1]
            if alone:
                yield f"bootstrap over repeats: {', '.join(alone)} without repeats; what differs there is not counted"
        for label, along in self.profiles.items():
            if _apart(along):
                profiled, laplace = interval(*along.interval), interval(*along.laplace)
                yield f"{label}: {profiled} by the profile, {laplace} by the covariance: quote the profile"
        if self.sampled and self.samples is None:
            yield "NUTS: stopped by the user before there were draws enough"
        if self.samples is not None:
            draws = self.samples.value.shape[1]
            if draws < self.samples.asked:
                yield f"NUTS: stopped by the user after {draws} of {self.samples.asked} draws of every chain"
            if self.samples.divergences:
                yield f"NUTS: {self.samples.divergences} steps went astray"
            apart = [k for k, x in zip(self.samples.labels, self.samples.r_hat, strict=True) if not x < MAX_R_HAT]
            if apart:
                yield f"NUTS: the chains do not agree yet on {', '.join(apart)}"


def _apart(profile: Profile) -> bool:
    """Whether a profile's interval differs from Laplace's.

    It does where an end is open, or differs by more than `MAX_END_DIFFERENCE` of half the width of Laplace's interval.
    """
    half = 0.5 * (profile.laplace[1] - profile.laplace[0])
    return any(
        a is None or abs(a - b) > MAX_END_DIFFERENCE * half for a, b in zip(profile.interval, profile.laplace, strict=True)
    )


def document(uncertainty: Uncertainty) -> UncertaintyFile:
    """Content of uncertainty.json without figures."""
    likely, saved = uncertainty.likelihood, uncertainty.saved
    excess = likely.excess()
    parameters = {}
    for label in likely.labels:
        parameter = saved.best.parameters[label]
        intervals = {
            "laplace": likely.interval(label, uncertainty.level),
            "white": likely.interval(label, uncertainty.level, white=True),
            **uncertainty.ways(label),
        }
        parameters[label] = ParameterIntervals(
            **parameter.model_dump(include={"value", "unit", "meaning", "identifiable", "at_bound"}),
            white_too_small_by=finite_or_null(excess[label]),
            **stated(**{way: tuple(map(finite_or_null, ends)) for way, ends in intervals.items()}),
        )
    return UncertaintyFile(
        campaign=saved.campaign,
        platform=saved.platform,
        jaxhydro=jaxhydro.__version__,
        calibration=uncertainty.source,
        level=uncertainty.level,
        seed=uncertainty.seed,
        converged=uncertainty.converged,
        parameters=parameters,
        profiles={label: _profile(profile) for label, profile in uncertainty.profiles.items()},
        bootstrap={method: _bootstrap(bootstrap, uncertainty.asked) for method, bootstrap in uncertainty.bootstraps.items()},
        nuts=None if uncertainty.samples is None else _samples(uncertainty.samples),
        notes=list(uncertainty.notes()),
    )


def _profile(profile: Profile) -> ProfileCurve:
    values, drop = ([finite_or_null(x) for x in column] for column in (profile.grid, profile.drop))
    return ProfileCurve(values=values, drop=drop, nu=finite_or_null(profile.nu))


def _bootstrap(bootstrap: Bootstrap, asked: int) -> BootstrapDraws:
    groups = {name: list(group) if isinstance(group, tuple) else float(group) for name, group in bootstrap.groups.items()}
    return BootstrapDraws(asked=asked, draws=len(bootstrap.value), unsettled=bootstrap.unsettled, groups=groups)


def _samples(samples: Samples) -> PosteriorDraws:
    chains, draws = samples.value.shape[:2]
    r_hat, effective = (
        {label: finite_or_null(x) for label, x in zip(samples.labels, values, strict=True)}
        for values in (samples.r_hat, samples.effective)
    )
    return PosteriorDraws(chains=chains, draws=draws, divergences=samples.divergences, r_hat=r_hat, effective=effective)


def write_uncertainty(uncertainty: Uncertainty, folder: Path, figures: bool = True) -> UncertaintyFile:
    """Write uncertainty.json and figures in place of earlier ones.

    Args:
        uncertainty: The intervals.
        folder: Folder of the results, made where absent.
        figures: Whether figures are drawn.

    Returns:
        The content of uncertainty.json.

    Raises:
        InputError: The folder cannot be written.
    """
    with staged(folder, lambda temporary: outdated(folder, temporary, UNCERTAINTY_FILE)) as temporary:
        drawn = draw(_figures(uncertainty), temporary) if figures else []
        content = document(uncertainty).model_copy(update={"figures": drawn})
        content.write(temporary / UNCERTAINTY_FILE)
    return content


def _figures(uncertainty: Uncertainty) -> Iterator[tuple[str, str, Any]]:
    from calibration.plots import uncertainty_figures as uncertainty_plot

    for label, profile in uncertainty.profiles.items():
        words = "rise of -2 ln L, all else refitted, its level, and the parabola of the covariance"
        yield f"profile-{safe_name(label)}.png", f"{label}: {words}", uncertainty_plot.profile_figure(profile)
    pair = most_correlated(uncertainty.likelihood)
    draws: dict[str, Bootstrap | Samples] = {
        **uncertainty.bootstraps,
        **({"nuts": uncertainty.samples} if uncertainty.samples else {}),
    }
    if pair is not None:
        for way, drawn in draws.items():
            shown = "draws of the two parameters that are tied most, and the ellipse of the covariance (95 %)"
            caption = f"{INTERVAL_METHODS[way]}: {shown}"
            yield f"draws-{way}.png", caption, uncertainty_plot.draws_figure(drawn, *pair)


def most_correlated(likelihood: Likelihood) -> tuple[str, str] | None:
    """The two parameters with the largest absolute correlation; None where there is one parameter."""
    labels, deviation = likelihood.labels, likelihood.deviation()
    if len(labels) < 2:
        return None
    p = len(labels)
    correlation = likelihood.covariance[:p, :p] / np.outer(deviation, deviation)
    first, second = np.triu_indices(p, 1)
    k = int(np.argmax(np.abs(correlation[first, second])))
    return labels[first[k]], labels[second[k]]
