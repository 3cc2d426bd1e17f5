"""Channels recorded with the wrong sign, found from motions in waves.

Measured motions are compared with the platform file's model at wave frequencies, before anything is fitted in waves.
There motions follow from the waves by first-order theory. A phase of 180 degrees in every test has no physical cause.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest_sections import IN_WAVES, WAVE
from calibration.discovery.diagnosis_fits import test_fits_at
from calibration.discovery.effect_fits import EffectFits
from calibration.discovery.reported_effects import Effect, Evidence
from calibration.formatting import listed
from calibration.result import Estimate
from jaxhydro.analysis.sea_statistics import bands_of, record_peak_period

MAX_REVERSED_CORRELATION = -0.6  # of measurement and model, in every fitted test of a reversed channel
MIN_MOTION_OVER_NOISE = 5.0  # of a motion that is compared


class SignComparison(NamedTuple):
    """Measured motion compared with the platform file's model in one test, at wave frequencies.

    Attributes:
        channel: The motion.
        use: Use of the test (fit, holdout).
        correlation: Correlation of measurement and model (-1 to 1).
        error: Squared error as recorded.
        reversed_error: Squared error with the sign reversed.
    """

    channel: str
    use: str
    correlation: float
    error: float
    reversed_error: float


def reversed_channels(campaign: Campaign, fits: EffectFits) -> dict[str, Effect]:
    """Channels whose sign is wrong, as effects by channel (a motion, or `wave`).

    Where all motions are reversed, it is the wave.
    """
    if not fits.study.seas:
        return {}
    met = _met(campaign, fits)
    fitted = [comparison for comparison in met if comparison.use == "fit"]
    told = list(dict.fromkeys(comparison.channel for comparison in fitted))
    wrong = [
        name
        for name in told
        if all(comparison.correlation < MAX_REVERSED_CORRELATION for comparison in fitted if comparison.channel == name)
    ]
    if wrong == told and len(told) > 1:
        return {WAVE: _effect(WAVE, met, ())}
    alike = (f"sensor_sign ({WAVE})",) if wrong == told else ()
    return {name: _effect(name, [comparison for comparison in met if comparison.channel == name], alike) for name in wrong}


def with_signs_reversed(campaign: Campaign, channels: Sequence[str]) -> Campaign:
    """The campaign with the signs of these channels changed."""
    manifest = campaign.manifest.turned(channels)
    tests = {test.id: test for test in manifest.tests}
    records = []
    for record in campaign.records:
        values = {name: -row if name in channels else row for name, row in record.values.items()}
        wave = -record.wave if record.wave is not None and WAVE in channels else record.wave
        records.append(replace(record, values=values, wave=wave, test=tests[record.id]))
    return replace(campaign, manifest=manifest, records=tuple(records))


def reversal_note(channels: Sequence[str]) -> str:
    """Note on reversed channels and how to correct the campaign file."""
    are, signs = ("is", "its sign") if len(channels) == 1 else ("are", "their signs")
    hint = " It is as if the waves came from the other side." if {"surge", "pitch"} <= set(channels) else ""
    return (
        f"{listed(list(channels))} {are} recorded with the other sign, and {are} turned round for all that follows.{hint} "
        f"Mend {signs} in campaign.yaml (sign: -1, or 1 where it is -1)"
    )


def _met(campaign: Campaign, fits: EffectFits) -> list[SignComparison]:
    comparisons = []
    for test in test_fits_at(campaign, fits, fits.start):
        wave = campaign.record(test.id).wave
        if test.kind not in IN_WAVES or wave is None:
            continue
        step, taper = float(test.time[1] - test.time[0]), np.hanning(len(test.time))
        low, high = bands_of(WAVE, record_peak_period(wave, step))["wave_frequency"]
        frequency = np.fft.rfftfreq(len(test.time), step)
        inside = (frequency >= low) & (frequency < high)
        for series in test.series:
            measured, model = (np.fft.rfft(taper * (x - x.mean()))[inside] for x in (series.measured, series.simulated))
            measured_energy, model_energy = (float((np.abs(x) ** 2).sum()) for x in (measured, model))
            noise = series.noise**2 * float((taper**2).sum()) * inside.sum()
            if series.scored and min(measured_energy, model_energy) > MIN_MOTION_OVER_NOISE**2 * noise:
                both = float((np.conj(model) * measured).sum().real)
                error, reversed_error = measured_energy + model_energy - 2 * both, measured_energy + model_energy + 2 * both
                comparisons.append(
                    SignComparison(
                        series.channel, test.use, both / float(np.sqrt(measured_energy * model_energy)), error, reversed_error
                    )
                )
    return comparisons


def _effect(channel: str, met: Sequence[SignComparison], alike: tuple[str, ...]) -> Effect:
    def gone(use: str) -> float:
        """Share of the squared error, motion by motion alike."""
        shares = [1 - comparison.reversed_error / comparison.error for comparison in met if comparison.use == use]
        return float(np.mean(shares)) if shares else float("nan")

    label, meaning = f"sensor_sign.{channel}", f"sign of the recorded {channel}, by that which is declared"
    return Effect(
        "sensor_sign",
        channel,
        meaning,
        "",
        {label: Estimate(label, -1.0, None, "-", meaning, 1.0, False, True)},
        Evidence(float("nan"), float("nan"), gone("holdout"), float("nan")),
        max(0.0, gone("fit")),
        alike,
        "still water, the platform pushed by hand along every axis",
    )
