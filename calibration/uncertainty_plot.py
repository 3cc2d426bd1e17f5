"""Figures of uncertainty: a profile, draws of two parameters. Call within `jaxhydro.plot.style()`."""

import numpy as np
from matplotlib.figure import Figure
from scipy.stats import chi2

from calibration.bootstrap import Bootstrap
from calibration.profile import Profile
from calibration.sampling import Samples
from jaxhydro.plot import GREY, MEASURED, SIMULATED, WIDTH, header


def profile_figure(found: Profile) -> Figure:
    """Drop of -2 log likelihood along the parameter, its level and interval, and the parabola of the covariance."""
    figure = Figure(figsize=(WIDTH, 2.2), layout="constrained")
    ax = figure.subplots()
    limit, top = float(chi2.ppf(found.level, 1)), 1.6 * float(chi2.ppf(found.level, 1))
    artists = {"profile": ax.plot(found.grid, found.drop, "o-", ms=3, color=SIMULATED, mew=0)[0]}
    middle = found.coordinate[int(np.argmin(np.abs(found.grid - found.estimate)))]
    half = 0.5 * np.ptp(np.interp(found.laplace, found.grid, found.coordinate))
    if half > 0:
        parabola = limit * ((found.coordinate - middle) / half) ** 2
        artists["covariance"] = ax.plot(found.grid, parabola, "--", lw=0.8, color=MEASURED)[0]
    ax.axhline(limit, color=GREY, lw=0.6)
    for end in found.interval:
        if end is not None:
            ax.plot([end, end], [0, limit], color=SIMULATED, lw=0.6)
    ax.set_ylim(0, top)
    ax.set_xlabel(f"{found.label}" + ("" if found.unit == "-" else f" ({found.unit})"))
    ax.set_ylabel("Drop of\n$-2\\,\\ln L$ (-)")
    header(figure, str(found), artists)
    return figure


def draws_figure(found: Bootstrap | Samples, first: str, second: str) -> Figure:
    """Draws of two parameters, over the ellipse of 95 % of the covariance."""
    likely, width = found.likelihood, len(found.labels)
    at = [likely.index(first), likely.index(second)]
    points = found.value.reshape(-1, width)[:, at]
    angle = np.linspace(0, 2 * np.pi, 100)
    covariance = likely.covariance[np.ix_(at, at)]
    ring = np.linalg.cholesky(covariance) @ np.stack([np.cos(angle), np.sin(angle)]) * np.sqrt(chi2.ppf(0.95, 2))
    edge = [[likely.value(label, likely.estimate[i] + x) for x in row] for label, i, row in zip((first, second), at, ring)]
    figure = Figure(figsize=(WIDTH, 2.6), layout="constrained")
    ax = figure.subplots()
    artists = {"draws": ax.plot(*points.T, "o", ms=2, color=SIMULATED, mew=0, alpha=0.6)[0]}
    artists["covariance, 95 %"] = ax.plot(*edge, "--", lw=0.8, color=MEASURED)[0]
    ax.set_xlabel(first)
    ax.set_ylabel(second)
    header(figure, f"{len(points)} draws", artists)
    return figure
