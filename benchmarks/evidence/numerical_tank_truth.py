"""Sizes of what OpenFAST's potential-flow runs have and strips on a linear mooring lack."""

import json
from typing import Any

import numpy as np
from scipy.optimize import fsolve
from scipy.signal import hilbert, savgol_filter

from benchmarks.evidence.common import within
from benchmarks.evidence.numerical_tank_runs import (
    DECAYS,
    END,
    FOLDER,
    HYDRO,
    PERIOD,
    REST,
    SEA,
    TRANSIENT,
    columns,
    platform,
    setup,
)
from jaxhydro.analysis.motion_bands import BANDS
from jaxhydro.interop.wamit_radiation import read_wamit

DENSITY, GRAVITY = 1025.0, 9.81
# MoorDyn's md.dat: three lines at 120 deg
ANCHOR, FAIRLEAD, DROP, LENGTH = 837.6, 58.0, 186.0, 850.0  # m
WEIGHT, AXIAL = (685.0 - DENSITY * np.pi / 4 * 0.333**2) * GRAVITY, 3.27e9  # N/m, N
REACH = 8.0  # m: of offsets that are compared
DOF = {"surge": 1, "heave": 3, "pitch": 5}
NATURAL = {"surge": 131.5, "heave": 20.6, "pitch": 27.4}  # s: at small amplitudes, as the runs' README has them


def line(distance: float) -> tuple[float, float]:
    """Horizontal and vertical tension (N) at the fairlead of an elastic catenary.

    A part of the line lies on the bottom, without friction.

    Args:
        distance: Horizontal distance of anchor and fairlead (m).
    """

    def missed(logs: np.ndarray) -> list[float]:
        h, v = np.exp(logs)
        slope = v / h
        along = LENGTH - v / WEIGHT + h / WEIGHT * np.arcsinh(slope) + h * LENGTH / AXIAL
        down = h / WEIGHT * (np.hypot(1, slope) - 1) + v**2 / (2 * AXIAL * WEIGHT)
        return [along - distance, down - DROP]

    h, v = np.exp(fsolve(missed, np.log([1.4e6, 1.5e6])))
    return float(h), float(v)


def pulled(offset: float) -> float:
    """Surge force (N) of the three lines at a static offset (m)."""
    total = 0.0
    for angle in np.radians([180.0, 60.0, -60.0]):
        way = (ANCHOR - FAIRLEAD) * np.array([np.cos(angle), np.sin(angle)]) - [offset, 0.0]
        distance = float(np.hypot(*way))
        total += line(distance)[0] * way[0] / distance
    return total


def mooring() -> dict[str, Any]:
    """Stiffness of the lines in surge.

    In the surge decay it is that of mass times acceleration less HydroDyn's force. There the lines drag through the water, too.

    Returns:
        Stiffness (N/m), its even quadratic (N/m2) and cubic (N/m3) part: `static` and, in the decay, `moving`, where `missed`
        is the rest over the force. `secant` stiffness by offset (N/m). `tension` at rest (N), here and by OpenFAST.
    """
    offsets = np.linspace(-REACH, REACH, 41)
    static = np.linalg.lstsq(np.stack([offsets, offsets**2, offsets**3], axis=1), -np.array([pulled(x) for x in offsets]))[0]
    table = columns("decay_surge_nwt")
    setup = json.loads((FOLDER / "decay_surge_nwt" / "setup.json").read_text())
    time, surge = table["Time"], table["PtfmSurge"]
    centre = surge + setup["zcg"] * np.sin(np.radians(table["PtfmPitch"]))
    step = float(time[1] - time[0])
    force = setup["mass"] * savgol_filter(centre, 41, 3, deriv=2, delta=step) - table["HydroFxi"]
    speed = savgol_filter(surge, 41, 3, deriv=1, delta=step)
    inside = slice(200, -200)
    terms = np.stack([surge, surge**2, surge**3, speed, speed * np.abs(speed), np.ones(len(surge))], axis=1)[inside]
    moving = np.linalg.lstsq(terms, -force[inside])[0]
    missed = force[inside] + terms @ moving
    return {
        "static": static.tolist(),
        "moving": moving.tolist(),
        "missed": float(missed.std() / force[inside].std()),
        "secant": {f"{x:+g}": -pulled(x) / x for x in (-REACH, -0.1, 0.1, REACH)},
        "tension": [float(np.hypot(*line(ANCHOR - FAIRLEAD))), float(columns(REST)["FAIRTEN1"][-100:].mean())],
    }


def radiation() -> dict[str, Any]:
    """Added mass and radiation damping (SI) of WAMIT, by motion.

    Frequencies are infinite, the natural one, that of the waves' peak, and that of the largest damping.
    """
    file = read_wamit(HYDRO, DENSITY)
    assert file.infinite is not None
    results: dict[str, Any] = {}
    for motion, dof in DOF.items():
        added, damping = file.added_mass[:, dof - 1, dof - 1], file.damping[:, dof - 1, dof - 1]
        frequencies = {"natural": 2 * np.pi / NATURAL[motion], "waves": 2 * np.pi / PERIOD}
        peak = int(np.argmax(np.where(file.omega < 1.9, damping, 0.0)))
        results[motion] = {
            "infinite": float(file.infinite[dof - 1, dof - 1]),
            "added": {k: float(np.interp(w, file.omega, added)) for k, w in frequencies.items()},
            "damping": {k: float(np.interp(w, file.omega, damping)) for k, w in frequencies.items()},
            "largest": [float(damping[peak]), float(file.omega[peak])],
        }
    return results


def drift(law: dict[str, dict[str, float]]) -> dict[str, Any]:
    """Second-order force by motion (N, N m), and that of a law on the same waves.

    Args:
        law: Coefficients of the squared envelope, by motion and way.

    Returns:
        By motion: `mean` and standard deviation (`slow`) of the force in the motion's low-frequency band; both of the `law`;
        and their `correlation` in the band.
    """
    table = columns(SEA)
    time = table["Time"]
    inside = (time >= TRANSIENT) & (time <= END)
    _, omega, _, amplitude, phase = np.loadtxt(FOLDER / SEA / "components.csv.gz", delimiter=",", skiprows=2, ndmin=2).T
    parts = amplitude * np.exp(1j * phase)
    turning = np.exp(1j * np.outer(time[::5], omega))
    plain, weighed = turning @ parts, turning @ (parts * (omega / 0.6) ** 2)
    envelope = np.abs(plain) ** 2
    ways = {
        "envelope": envelope,
        "quadrature": np.imag(hilbert(envelope - envelope.mean())),
        "frequency_weighted": np.real(weighed * np.conj(plain)),
    }
    results = {}
    for motion, channel in zip(DECAYS, ("B1WvsF2xi", "B1WvsF2zi", "B1WvsM2yi")):
        force = table[channel][::5][inside[::5]]
        coefficients = {k: float(v) for k, v in law.get(motion, {}).items()}
        made = sum((value * ways[way] for way, value in coefficients.items()), np.zeros(len(envelope)))[inside[::5]]
        slow, of_law = (within(x, *BANDS[motion], float(time[5] - time[0])) for x in (force, made))
        results[motion] = {
            "mean": float(force.mean()),
            "slow": float(slow.std()),
            "law": [float(made.mean()), float(of_law.std())] if coefficients else None,
            "correlation": float(np.corrcoef(slow, of_law)[0, 1]) if coefficients else None,
        }
    return results


def quadratic() -> dict[str, float]:
    """Quadratic damping (N s2/m2, N m s2/rad2) by the platform's own velocity, not by the water's."""
    matrix = json.loads((FOLDER / SEA / "setup.json").read_text())["AddBQuad"]
    return {motion: float(matrix[dof - 1][dof - 1]) for motion, dof in DOF.items()}


def excitation() -> dict[str, list[float]]:
    """First-order excitation at the waves' peak, by motion.

    Returns:
        Amplitude (N/m, N m/m) by strips without drag on the platform held upright; that of WAMIT; and the phase by which
        WAMIT's is ahead (rad).
    """
    import jax.numpy as jnp

    import jaxhydro as jh
    from benchmarks.evidence.openfast_sea import WATER, _loads
    from jaxhydro.waves.components import PlaneWaves, components

    rows = [row for row in np.loadtxt(HYDRO.with_suffix(".3")) if abs(row[1]) < 1e-6]
    period = min({row[0] for row in rows}, key=lambda period: abs(period - PERIOD))
    height = 0.05
    wave = components(jnp.array([height]), jnp.array([2 * np.pi / period]), WATER, phase=jnp.zeros(1))
    model = jh.build(jh.Platform.model_validate(platform(setup())))
    model = model.with_values({label: 0.0 for label in model.values if ".Cd_" in label})
    times = period * np.arange(64) / 64
    loads = np.array(_loads(model, jh.WaveSea(PlaneWaves.free(wave, WATER), WATER, 0.0, "none"), jnp.asarray(times)))
    turning = np.exp(-2j * np.pi * times / period)
    results = {}
    for motion, dof in DOF.items():
        strip_load = 2 * (loads[:, dof - 1] * turning).mean() / height
        wamit_load = DENSITY * GRAVITY * next(complex(row[5], row[6]) for row in rows if (row[0], row[2]) == (period, dof))
        results[motion] = [float(abs(strip_load)), float(abs(wamit_load)), float(np.angle(wamit_load / strip_load))]
    return results
