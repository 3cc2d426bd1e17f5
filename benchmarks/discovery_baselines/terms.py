"""Terms that a reconstructed force may depend on, and the effects that they are taken for."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from benchmarks.discovery_baselines.reconstructed_forces import ForcedTest
from calibration.discovery.latent_force.term_library import lagged, quarter_period_later, squared_envelope

FRICTION_SPEED_OVER_RMS = 0.05  # v0 of tanh(v/v0) over the rms velocity
YIELD_OVER_RMS = 0.5  # yield displacement of the hysteretic term over the rms motion

# effect that a term is taken for: one in all motions, or by motion with "" for the others
EFFECT_OF: dict[str, str | dict[str, str]] = {
    "1": "umbilical",
    "x": {"surge": "umbilical", "": "mass_properties"},
    "v": {"surge": "current", "": ""},
    "|v| v": "amplitude_dependent_drag",
    "v^3": "amplitude_dependent_drag",
    "tanh(v/v0)": "coulomb_friction",
    "hysteretic": "hysteresis",
    "x |x|": {"surge": "mooring_nonlinearity", "": "nonlinear_hydrostatics"},
    "x^2": {"surge": "mooring_nonlinearity", "": "nonlinear_hydrostatics"},
    "x^3": {"surge": "mooring_nonlinearity", "": "nonlinear_hydrostatics"},
    "v lagged": {"pitch": "hidden_oscillator", "": "radiation_memory"},
    "x of another motion": "sensor_reference",
    "v of another motion": "coupled_damping",
    "eta": "wave_reflection",
    "eta, a quarter later": "sensor_lag",
    "eta^2 slow": "wave_drift",
    "eta^2 slow v": "wave_drift_damping",
    "v in waves": "sea_state_dependent_drag",
}


class Scales(NamedTuple):
    """Scales of a motion, over the fitted tests.

    Attributes:
        position: Root mean square (m, rad).
        velocity: Root mean square (m/s, rad/s).
    """

    position: float
    velocity: float


def scales_of(tests: Sequence[ForcedTest], motion: str) -> Scales:
    """Scales of a motion."""
    forces = [test.forces[motion] for test in tests if motion in test.forces]
    squares = [(np.var(force.position[force.inside]), np.var(force.velocity[force.inside])) for force in forces]
    return Scales(*np.sqrt(np.mean(squares, axis=0)).tolist())


def hysteretic(velocity: np.ndarray, step: float, limit: float) -> np.ndarray:
    """Bouc-Wen variable of exponent 1 along a motion: dz/dt = (v - |v| z) / limit, by implicit Euler."""
    z = np.zeros(len(velocity))
    for i in range(1, len(velocity)):
        moved = step * velocity[i] / limit
        z[i] = (z[i - 1] + moved) / (1 + abs(moved))
    return z


def terms_of(test: ForcedTest, motion: str, scales: Scales) -> dict[str, np.ndarray]:
    """Terms (n,) of a force in a motion, by name; terms of the wave are zero in still water.

    Acceleration is none of them: with position and velocity it is the force itself, by the equation of motion.
    """
    recovered = test.forces[motion]
    x, v, step, wave = recovered.position, recovered.velocity, recovered.test.step, recovered.test.wave
    rows = {
        "1": np.ones_like(x),
        "x": x,
        "v": v,
        "|v| v": np.abs(v) * v,
        "v^3": v**3,
        "tanh(v/v0)": np.tanh(v / (FRICTION_SPEED_OVER_RMS * scales.velocity)),
        "hysteretic": hysteretic(v, step, YIELD_OVER_RMS * scales.position),
        "x |x|": x * np.abs(x),
        "x^2": x**2,
        "x^3": x**3,
        "v lagged": lagged(v, step, scales.position / scales.velocity),
    }
    for motion_name, force in test.forces.items():
        if motion_name != motion:
            rows |= {f"x of {motion_name}": force.position, f"v of {motion_name}": force.velocity}
    still = np.zeros_like(x)
    if wave is None:
        return rows | dict.fromkeys(("eta", "eta, a quarter later", "eta^2 slow", "eta^2 slow v", "v in waves"), still)
    eta, square = wave - wave.mean(), squared_envelope(wave, step)
    return rows | {
        "eta": eta,
        "eta, a quarter later": quarter_period_later(eta),
        "eta^2 slow": square,
        "eta^2 slow v": square * v,
        "v in waves": v,
    }


def effect_of(term: str, motion: str) -> str:
    """Effect that a term of a motion's force is taken for; "" for none."""
    kind = f"{term[0]} of another motion" if term[1:5] == " of " else term
    effects = EFFECT_OF[kind]
    return effects.get(motion, effects[""]) if isinstance(effects, dict) else effects
