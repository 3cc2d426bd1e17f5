"""Small campaigns for section coverage: four short decays of the separate NumPy model, its releases imperfect, its noise white
or with a disturbance that remembers."""

from functools import cache
from pathlib import Path

import numpy as np
from ruamel.yaml import YAML
from scipy.signal import lfilter

from benchmarks.make_demo_campaign import (
    CHANNELS,
    IN_PLANE,
    NOISE,
    PERIODS,
    PLATFORM,
    TRUE_COEFFICIENTS,
    TRUE_DAMPING,
    release,
    true_model,
)

RECORDS = (("heave", 1, 120.0), ("heave", 2, 120.0), ("pitch", 1, 160.0), ("pitch", 2, 160.0))
SAMPLING = 0.4  # s
RELEASES = 19  # sets of releases, in turn; prime to the kinds of noise
FREE = ("column.Ca_t", "column.Cd_t", "pontoon.Ca_z", "pontoon.Cd_z", "linear_damping.B33", "linear_damping.B55")
DISTURBED = 3.0  # standard deviation of a disturbance, in that of the sensor
MEMORY, RINGING = 5.0, 0.1  # s; damping ratio
KINDS = ("white", "white", "drifting", "ringing")  # of campaign i modulo 4: half of them white


def kind_of(number: int) -> str:
    """white; drifting: with noise of first order, correlation time MEMORY; ringing: with noise that rings at every channel's
    own natural period, as a platform in a basin that is not quite still."""
    return KINDS[number % len(KINDS)]


def disturbance(kind: str, channel: str, n: int, random: np.random.Generator) -> np.ndarray:
    """(n,) of unit variance, from long before the record begins."""
    lead = round(40 * PERIODS[channel] / SAMPLING)
    drive = random.standard_normal(lead + n)
    if kind == "drifting":
        keep = np.exp(-SAMPLING / MEMORY)
        return lfilter([np.sqrt(1 - keep**2)], [1.0, -keep], drive)[lead:]
    omega = 2 * np.pi / PERIODS[channel] * SAMPLING
    keep = np.exp(-RINGING * omega)
    back = [1.0, -2 * keep * np.cos(omega * np.sqrt(1 - RINGING**2)), keep**2]
    # variance of an autoregression of second order, Box and Jenkins 1976, equation 3.2.28
    a, b = -back[1], -back[2]
    power = (1 - b) / ((1 + b) * ((1 - b) ** 2 - a**2))
    return lfilter([1 / np.sqrt(power)], back, drive)[lead:]


def platform() -> dict:
    """The demo's platform file, off as it is in what is free, true in what is not."""
    document = YAML(typ="safe").load(PLATFORM)
    for group, values in TRUE_COEFFICIENTS.items():
        for name, value in values.items():
            if f"{group}.{name}" not in FREE:
                document["coefficients"][group][name] = value
    document["linear_damping"]["B11"] = TRUE_DAMPING["B11"]
    return document


@cache
def clean(name: str, index: int, duration: float, releases: int) -> tuple[np.ndarray, np.ndarray]:
    """Time (n,) in s, and surge, heave, pitch (n, 3) in m, m, deg, of a set of releases."""
    model = true_model()
    t, q = model.decay(*release(name, index, 1000 + releases), duration, SAMPLING, tolerance=1e-7)
    return t, (q - model.equilibrium())[:, IN_PLANE] * [1.0, 1.0, 180 / np.pi]


def make(folder: Path, number: int) -> Path:
    """Campaign `number` in `folder`; its noise and disturbance are its own."""
    folder.mkdir(parents=True, exist_ok=True)
    random, tests = np.random.default_rng([77, number]), []
    for name, index, duration in RECORDS:
        t, motion = clean(name, index, duration, number % RELEASES)
        motion = motion.copy()
        for column, channel in enumerate(CHANNELS):
            motion[:, column] += NOISE[channel] * random.standard_normal(len(t))
            if kind_of(number) != "white":
                motion[:, column] += DISTURBED * NOISE[channel] * disturbance(kind_of(number), channel, len(t), random)
        file = f"{name}-{index + 1}.csv"
        np.savetxt(
            folder / file, np.column_stack([t, motion]), fmt="%.6f", delimiter=",", comments="", header="time,surge,heave,pitch"
        )
        tests.append({"id": f"{name}-{index + 1}", "kind": "decay", "degree_of_freedom": name, "file": file, "use": "fit"})
    channels = {"time": {"column": "time", "unit": "s"}}
    channels |= {c: {"column": c, "unit": "deg" if c == "pitch" else "m"} for c in CHANNELS}
    manifest = {
        "name": f"coverage-{number}",
        "platform": "platform.yaml",
        "channels": channels,
        "noise": dict(NOISE),
        "tests": tests,
        "calibrate": {"free": list(FREE)},
    }
    for path, document in (("platform.yaml", platform()), ("campaign.yaml", manifest)):
        with open(folder / path, "w") as file:
            YAML(typ="safe").dump(document, file)
    return folder
