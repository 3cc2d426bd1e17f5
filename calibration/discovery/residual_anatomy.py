"""Residuals by motion, test and frequency, relative to noise."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from calibration.campaign.manifest_sections import WAVE
from calibration.discovery.diagnosis import MotionResidual
from calibration.discovery.effect_fits import EffectFits
from calibration.discovery.fit_state import FitState
from calibration.formatting import listed, number

MIN_RESIDUAL_OVER_NOISE = 1.3  # rms; a smaller residual is at the noise


def anatomy(fits: EffectFits, state: FitState) -> tuple[MotionResidual, ...]:
    """Residual of every motion and test, in numbers and words."""
    study = fits.study
    noise = np.array([[series.noise] for series in study.series])
    mean_square, dof = study.mean_squares(state.residual) * study.floor**2 / noise**2, study.dof
    findings = []
    for series, squares, freedom in zip(study.series, mean_square, dof):
        if series.channel not in fits.setup.motions or not freedom.sum():
            continue
        ratio = math.sqrt(float((squares * freedom).sum() / freedom.sum()))
        # noise is in all bands, what is above it in those that are looked at
        above = max(ratio**2 - 1, 0.0) * float(freedom.sum()) / series.samples
        rms = series.noise * math.sqrt(above + 1)
        bands = tuple(
            (float(a), float(b), float(math.sqrt(s))) for a, b, s, f in zip(series.low, series.high, squares, freedom) if f > 0
        )
        words = _words(ratio, rms / series.noise, bands)
        findings.append(
            MotionResidual(series.test, series.use, series.channel, rms, series.noise, rms / series.spread, bands, words)
        )
    return tuple(findings)


def _words(within: float, over: float, bands: Sequence[tuple[float, float, float]]) -> str:
    """A residual in words; rms over noise `within` the compared bands and `over` all."""
    if within < MIN_RESIDUAL_OVER_NOISE:
        return "at the noise"
    worst = max(bands, key=lambda b: b[2])
    where = "in the mean" if worst[0] == 0 else f"from {worst[0]:.3g} to {worst[1]:.3g} Hz"
    return f"{number(over, 2)} times the noise, most of it {where}"


def signature(fits: EffectFits, before: FitState, after: FitState) -> tuple[float, str]:
    """Fraction of the error's energy that is left, and the remaining residual in words.

    Every motion that a test is about counts, relative to its own size and above its floor.
    """
    study = fits.study
    told = study.main & np.array([series.channel in fits.setup.motions for series in study.series])
    spread = np.array([series.spread for series in study.series])
    total, remaining = (float(((state.summary.error / spread)[told] ** 2).sum()) for state in (before, after))
    share = remaining / total if total > 0 else 0.0
    if not (after.summary.squares.sum(axis=1) > (MIN_RESIDUAL_OVER_NOISE**2 - 1) * np.maximum(study.dof.sum(axis=1), 1.0))[
        told
    ].any():
        fitted = [record for record in fits.campaign.records if record.use == "fit"]
        noise_declared = all(set(record.noise) - {WAVE} <= set(fits.campaign.manifest.noise) for record in fitted)
        return share, f"white at the {'declared noise level' if noise_declared else 'level of the noise, which was estimated'}"
    by_motion: dict[tuple[str, str], float] = {}
    for series, relative in zip(study.series, np.where(told, after.summary.error / spread, 0.0)):
        key = (series.channel, "decays" if series.kind == "decay" else "waves")
        by_motion[key] = max(by_motion.get(key, 0.0), float(relative))
    rows = sorted(by_motion.items(), key=lambda item: -item[1])[:3]
    shares = [f"{100 * value:.0f} % of {channel} in {kind}" for (channel, kind), value in rows if value > 0.005]
    i = int(np.argmax(np.where(told, after.summary.error / spread, 0.0)))
    series = study.series[i]
    k = int(np.argmax((study.mean_squares(after.residual)[i] - 1) * series.dof * series.floor**2))
    where = f"{series.channel} of the test {series.test}, from {series.low[k]:.3g} to {series.high[k]:.3g} Hz"
    return share, f"{listed(shares) or 'small in every motion'}. The error is largest in {where}"
