"""Figures of uncertainty: likelihood profiles, and draws of two parameters."""

import numpy as np
import scipy  # its parts are imported when they are used: that takes a second
from matplotlib.figure import Figure

from calibration.formatting import readable_unit
from calibration.uncertainty.bootstrap_draws import Bootstrap
from calibration.uncertainty.posterior_samples import Samples
from calibration.uncertainty.profile import Profile
from jaxhydro.plots.style import GREY, MEASURED, SIMULATED, WIDTH, header


def profile_figure(profile: Profile) -> Figure:
    """Rise of -2 log likelihood along a parameter, its level and interval, and the covariance's parabola."""
    figure = Figure(figsize=(WIDTH, 2.2), layout="constrained")
    ax = figure.subplots()
    limit, top = float(scipy.stats.chi2.ppf(profile.level, 1)), 1.6 * float(scipy.stats.chi2.ppf(profile.level, 1))
    artists = {"profile": ax.plot(profile.grid, profile.drop, "o-", ms=3, color=SIMULATED, mew=0)[0]}
    middle = profile.coordinate[int(np.argmin(np.abs(profile.grid - profile.estimate)))]
    half = 0.5 * np.ptp(np.interp(profile.laplace, profile.grid, profile.coordinate))
    if half > 0:
        parabola = limit * ((profile.coordinate - middle) / half) ** 2
        artists["covariance"] = ax.plot(profile.grid, parabola, "--", lw=0.8, color=MEASURED)[0]
    ax.axhline(limit, color=GREY, lw=0.6)
    for end in profile.interval:
        if end is not None:
            ax.plot([end, end], [0, limit], color=SIMULATED, lw=0.6)
    ax.set_ylim(0, top)
    ax.set_xlabel(_named(profile.label, profile.unit))
    ax.set_ylabel("Rise of\n$-2\\,\\ln L$ (-)")
    header(figure, str(profile).replace(": ", "\n", 1), artists)  # in one line it may be too wide
    return figure


def draws_figure(draws: Bootstrap | Samples, first: str, second: str) -> Figure:
    """Draws of two parameters, over the 95 % ellipse of the covariance as far as it is near them."""
    likely, width = draws.likelihood, len(draws.labels)
    indices = [likely.index(first), likely.index(second)]
    points = draws.value.reshape(-1, width)[:, indices]
    angle = np.linspace(0, 2 * np.pi, 100)
    covariance = likely.covariance[np.ix_(indices, indices)]
    ring = np.linalg.cholesky(covariance) @ np.stack([np.cos(angle), np.sin(angle)]) * np.sqrt(scipy.stats.chi2.ppf(0.95, 2))
    edge = [[likely.value(label, likely.estimate[i] + x) for x in row] for label, i, row in zip((first, second), indices, ring)]
    figure = Figure(figsize=(WIDTH, 2.6), layout="constrained")
    ax = figure.subplots()
    artists = {"draws": ax.plot(*points.T, "o", ms=2, color=SIMULATED, mew=0, alpha=0.6)[0]}
    artists["covariance, 95 %"] = ax.plot(*edge, "--", lw=0.8, color=MEASURED)[0]
    about = likely.fit.decays.problem.model.about
    ax.set_xlabel(_named(first, about(first).unit))
    ax.set_ylabel(_named(second, about(second).unit).replace(" (", "\n("))
    for values, ring_of, limit in ((points[:, 0], edge[0], ax.set_xlim), (points[:, 1], edge[1], ax.set_ylim)):
        low, high = values.min(), values.max()
        margin = 0.5 * (high - low)  # bounded in a coordinate, an ellipse may go far in values
        ends = max(low - margin, min(low, *ring_of)), min(high + margin, max(high, *ring_of))
        limit(ends[0] - 0.1 * margin, ends[1] + 0.1 * margin)
    ways = {"repeats": "repeated tests drawn anew", "blocks": "residuals drawn in blocks"}
    title = ways[draws.method] if isinstance(draws, Bootstrap) else "from the posterior"
    header(figure, f"{len(points)} draws, {title}", artists)
    return figure


def _named(label: str, unit: str) -> str:
    return f"{label} ({shown})" if (shown := readable_unit(unit)) else label
