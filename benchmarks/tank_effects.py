"""Effects that a declared platform does not have, for the tank of benchmarks/tank.py: one small class each, three strengths.

It shares no code with jaxhydro or calibration. A class says its parameters by variant and strength (1 just visible,
2 middle, 3 strong) and acts in one or more of these ways:

    amend(setup, p)     changes what the tank is made with (rigid body, current, sensors, reflection): once per campaign
    force(now)          force on the hull (r, 3) in earth axes about the reference point: surge N, heave N, pitch N m
    drag(now, u, size)  what stands for |u| u in the drag of every direction, (r, k)
    rate(now), rest(q)  of `states` variables of its own, (r, states)

for all runs of a batch that have it at once: `now` has t (s), half (steps of HALF s), q and v (r, 3), s (r, states) and
first (False at a Runge-Kutta stage inside a step). Parameters self.p[name] are (r,), in SI units. An effect asked for
as "name:variant" takes that variant, else its first.
"""

import numpy as np
from scipy.signal import butter

SURGE, HEAVE, PITCH = 0, 1, 2
GRAVITY = 9.80665
DEG = np.pi / 180


class Effect:
    """Parameters by variant: name -> three values; what all variants share is under ""."""

    parameters: dict[str, dict[str, tuple[float, float, float]]] = {"": {}}
    states = 0
    catalogue = True
    source = ""

    def __init__(self, p: dict, runs: dict):
        """p: arrays (r,); runs: of each run `decay` (surge, heave, pitch or ""), `hs`, `tp`, `sea` (or None), `equilibrium`
        (r, 3, filled in later), all over the same r runs; and `step` (s) of the integration."""
        self.p, self.runs = p, runs
        self.begin()

    def begin(self):
        """What is worked out once."""

    @classmethod
    def values(cls, variant: str, strength: int) -> dict[str, float]:
        found = cls.parameters.get("", {}) | (cls.parameters[variant] if variant else {})
        return {name: float(three[strength - 1]) for name, three in found.items()}

    @classmethod
    def variants(cls) -> list[str]:
        return [name for name in cls.parameters if name] or [""]

    @classmethod
    def size(cls, variant: str) -> str:
        """The parameter that says how large the effect is: the first one that the strength changes."""
        found = cls.parameters.get("", {}) | (cls.parameters[variant] if variant else {})
        return next(name for name, three in found.items() if three[0] != three[2])

    @staticmethod
    def amend(setup, p):
        """Nothing, unless said."""

    def acts(self, method: str) -> bool:
        return getattr(type(self), method) is not getattr(Effect, method)

    def force(self, now):
        raise NotImplementedError

    def drag(self, now, u, size):
        raise NotImplementedError

    def rate(self, now):
        raise NotImplementedError

    def rest(self, q):
        return np.zeros((len(q), self.states))


def along(axis, value):
    """(r, 3) with `value` (r,) along one motion."""
    force = np.zeros((len(value), 3))
    force[:, axis] = value
    return force


def at_point(q, x, z):
    """Offset (r,), (r,) in earth axes from the reference point of the body's point (x, z)."""
    c, s = np.cos(q[:, 2]), np.sin(q[:, 2])
    return c * x + s * z, c * z - s * x


class Umbilical(Effect):
    """A spring, a mean pull and some mass where a cable leaves the hull (Bergdahl 2017; lumped as in basin reports)."""

    parameters = {
        "": {
            "stiffness": (200.0, 1500.0, 8000.0),
            "pull": (-1e3, -1e4, -7e4),
            "mass": (700.0, 6e3, 4e4),
            "x": (-8.0, -8.0, -8.0),
            "z": (9.0, 9.0, 9.0),
        }
    }

    @staticmethod
    def amend(setup, p):
        setup["lumps"].append((p["mass"], p["x"], p["z"]))

    def force(self, now):
        x, z = at_point(now.q, self.p["x"], self.p["z"])
        push = self.p["pull"] - self.p["stiffness"] * (now.q[:, 0] + x - self.p["x"])
        return np.stack([push, np.zeros_like(push), z * push], axis=1)


class CoulombFriction(Effect):
    """F tanh(v / v0) against the motion."""

    parameters = {
        "surge": {"force": (1e3, 5e3, 3e4), "v0": (0.01,) * 3, "axis": (SURGE,) * 3},
        "pitch": {"force": (2e5, 1e6, 4e6), "v0": (2e-4,) * 3, "axis": (PITCH,) * 3},
    }

    def force(self, now):
        r, axis = np.arange(len(now.v)), self.p["axis"].astype(int)
        force = np.zeros_like(now.v)
        force[r, axis] = -self.p["force"] * np.tanh(now.v[r, axis] / self.p["v0"])
        return force


class Hysteresis(Effect):
    """Bouc-Wen in surge, n = 1: z' = (v - |v| z / 2 - v |z| / 2) / x_y, F = -F_y z (Bouc 1967, Wen 1976)."""

    parameters = {"": {"force": (1e3, 5e3, 3e4), "x_y": (1.0,) * 3}}
    states = 1

    def force(self, now):
        return along(SURGE, -self.p["force"] * now.s[:, 0])

    def rate(self, now):
        v, z = now.v[:, 0], now.s[:, 0]
        return ((v - 0.5 * np.abs(v) * z - 0.5 * v * np.abs(z)) / self.p["x_y"])[:, None]


class MooringNonlinearity(Effect):
    """-c3 x^3, -c2 x |x| or -c2 x^2 in surge, beyond the lines' own geometry."""

    parameters = {
        "cubic": {"c3": (16.0, 70.0, 280.0)},
        "odd_quadratic": {"c2": (100.0, 400.0, 1600.0)},
        "quadratic": {"c2_even": (100.0, 400.0, 1400.0)},
    }

    def force(self, now):
        x, p = now.q[:, 0], self.p
        return along(SURGE, -p.get("c3", 0.0) * x**3 - p.get("c2", 0.0) * x * np.abs(x) - p.get("c2_even", 0.0) * x * x)


class RadiationMemory(Effect):
    """-int K(t - s) v(s) ds, K = K0 exp(-b t) (cos w t - b/w sin w t): no damping at zero frequency (Cummins 1962)."""

    parameters = {
        "surge": {"K0": (1e5, 5e5, 2e6), "decay": (0.2,) * 3, "omega": (0.6,) * 3, "axis": (SURGE,) * 3},
        "heave": {"K0": (6e4, 2e5, 8e5), "decay": (0.15,) * 3, "omega": (0.45,) * 3, "axis": (HEAVE,) * 3},
        "pitch": {"K0": (1e8, 3.5e8, 1.2e9), "decay": (0.15,) * 3, "omega": (0.5,) * 3, "axis": (PITCH,) * 3},
    }
    states = 2

    def begin(self):
        self.at = np.arange(len(self.p["axis"])), self.p["axis"].astype(int)

    def force(self, now):
        force = np.zeros_like(now.v)
        force[self.at] = -self.p["K0"] * (now.s[:, 0] - self.p["decay"] / self.p["omega"] * now.s[:, 1])
        return force

    def rate(self, now):
        b, w, (cos, sin) = self.p["decay"], self.p["omega"], now.s.T
        return np.stack([now.v[self.at] - b * cos - w * sin, w * cos - b * sin], axis=1)


class Current(Effect):
    """A steady uniform flow inside every drag term."""

    parameters = {"": {"speed": (0.004, 0.02, 0.12)}}

    @staticmethod
    def amend(setup, p):
        setup["current"] += p["speed"]


class AmplitudeDependentDrag(Effect):
    """Every Cd times (KC / KC0)^n or (1 + c / KC) / (1 + c / KC0), KC = 2 pi A / D by the cycle's amplitude A.

    A is that of the energy in a decay, sqrt(x^2 + (v / omega)^2) of each motion, put together at the columns' depth
    (horizontal) and the pontoons' radius (vertical); in a sea sqrt(2) standard deviations of the surface. n = -1/3
    at a sharp edge (Graham 1980).
    """

    parameters = {
        "power": {"exponent": (-0.04, -0.13, -0.33), "KC0": (2.0,) * 3, "c": (0.0,) * 3},
        "inverse": {"exponent": (0.0,) * 3, "KC0": (2.0,) * 3, "c": (0.05, 0.2, 0.8)},
    }
    OMEGA = 2 * np.pi / np.array([135.0, 20.4, 27.6])
    WIDTH = 12.5

    def drag(self, now, u, size):
        amplitude = np.hypot(now.q - self.runs["equilibrium"], now.v / self.OMEGA)
        waves = self.runs["hs"] / 4 * 2**0.5
        both = np.stack(
            [np.hypot(amplitude[:, 0], 12.0 * amplitude[:, 2]), np.hypot(amplitude[:, 1], 26.0 * amplitude[:, 2])], axis=1
        )
        both = np.where(waves[:, None] > 0, waves[:, None], both)
        kc = np.clip(2 * np.pi * both / self.WIDTH, 0.05, 20.0)
        p = {name: value[:, None] for name, value in self.p.items()}
        factor = (kc / p["KC0"]) ** p["exponent"] * (1 + p["c"] / kc) / (1 + p["c"] / p["KC0"])
        return np.where(now.vertical, factor[:, 1:], factor[:, :1]) * size * u


class SeaStateDependentDrag(Effect):
    """Drag share |u| u + (1 - share) |u_h| u_h, u_h the relative velocity above `corner` (Hz), a filter of first order: the law
    of HydroDyn's AxFDLoFSc and AxVnCOff, here in every direction."""

    parameters = {"": {"share": (0.93, 0.75, 0.4), "corner": (0.07,) * 3}}
    states = 0

    def begin(self):
        self.b, self.a = butter(1, self.p["corner"][0], "high", fs=1 / self.runs["step"])
        self.memory = None

    def drag(self, now, u, size):
        if self.memory is None:
            self.memory = np.zeros_like(u)
        high = self.b[0] * u + self.memory
        if now.first:  # transposed direct form, once a step
            self.memory = self.b[1] * u - self.a[1] * high
        share = self.p["share"][:, None]
        return share * size * u + (1 - share) * now.size_of(high) * high


class WaveDrift(Effect):
    """Newman (1974): F = |sum a sqrt(D) exp(i theta)|^2 at the undisplaced hull, D(omega) = rho g L R^2 / 2, with
    R = (w/w0)^2 / (1 + (w/w0)^2), plus `quadrature` (s) times its rate: the part out of phase with the envelope; arm (m)."""

    parameters = {"": {"length": (1.2, 5.0, 20.0), "omega0": (0.9,) * 3, "arm": (-6.0,) * 3, "quadrature": (1.5,) * 3}}

    def begin(self):
        self.series = {}
        for r, sea in enumerate(self.runs["sea"]):
            if sea is None:
                continue
            shape = (sea.first_omega / self.p["omega0"][r]) ** 2
            curve = 0.5 * 1025.0 * GRAVITY * self.p["length"][r] * (shape / (1 + shape)) ** 2
            t = np.arange(sea.half_steps) * HALF
            envelope = sea.sum_of(sea.first_amplitude * np.sqrt(curve), t)
            change = sea.sum_of(1j * sea.first_omega * sea.first_amplitude * np.sqrt(curve), t)
            squared, rate = np.abs(envelope) ** 2, 2 * (envelope.conj() * change).real
            self.series[r] = squared + self.p["quadrature"][r] * rate

    def force(self, now):
        force = np.zeros_like(now.q)
        for r, series in self.series.items() if not now.still else ():
            force[r, 0] = series[min(now.half, len(series) - 1)]
        force[:, 2] = self.p["arm"] * force[:, 0]
        return force


class WaveDriftDamping(Effect):
    """-alpha Hs^2 v in surge (Wichers 1982; Aranha 1994)."""

    parameters = {"": {"alpha": (800.0, 4000.0, 1.6e4)}}

    def force(self, now):
        return along(SURGE, -self.p["alpha"] * self.runs["hs"] ** 2 * now.v[:, 0])


class HiddenOscillator(Effect):
    """A second mass on a spring and a damper. "pitch": a part of the declared mass slides along the hull at height z, with
    its weight (slack tank, loose damper); "surge": a body of its own is tied to the hull there (a float in tow)."""

    parameters = {
        "pitch": {
            "mass": (1e3, 5e3, 5e4),
            "period": (24.0,) * 3,
            "damping": (0.02,) * 3,
            "z": (12.0,) * 3,
            "carried": (1.0,) * 3,
        },
        "surge": {
            "mass": (2.5e4, 1e5, 6e5),
            "period": (90.0,) * 3,
            "damping": (0.02,) * 3,
            "z": (0.0,) * 3,
            "carried": (0.0,) * 3,
        },
    }
    states = 2

    @staticmethod
    def amend(setup, p):
        setup["sliding"] = (p["carried"] * p["mass"], p["z"])

    def begin(self):
        omega = 2 * np.pi / self.p["period"]
        self.k, self.c = self.p["mass"] * omega**2, 2 * self.p["damping"] * omega * self.p["mass"]
        self.weight = self.p["carried"] * self.p["mass"] * GRAVITY

    def pull(self, now):
        """Force on the mass along x, its place from its rest on the hull, and its height above the reference point."""
        x, z = at_point(now.q, 0.0, self.p["z"])
        gap = now.s[:, 0] - now.q[:, 0] - x
        push = -self.k * gap - self.c * (now.s[:, 1] - now.v[:, 0] - now.v[:, 2] * z)
        return push + self.weight * np.sin(now.q[:, 2]), gap, z

    def force(self, now):
        push, gap, z = self.pull(now)
        return np.stack([-push, np.zeros_like(push), -z * push + self.weight * np.cos(now.q[:, 2]) * gap], axis=1)

    def rate(self, now):
        return np.stack([now.s[:, 1], self.pull(now)[0] / self.p["mass"]], axis=1)

    def rest(self, q):
        lean = self.weight * np.sin(q[:, 2]) / self.k
        return np.stack([q[:, 0] + at_point(q, 0.0, self.p["z"])[0] + lean, np.zeros(len(q))], axis=1)


class NonlinearHydrostatics(Effect):
    """-C3 z^3 in heave: hull sides that flare above and below still water alike."""

    parameters = {"": {"C3": (6e3, 3e4, 1.2e5)}}

    def force(self, now):
        return along(HEAVE, -self.p["C3"] * now.q[:, 1] ** 3)


class CoupledDamping(Effect):
    """B15 (and B51, the same), N s, of a damper at `height`, which adds B15 / height to B11 and B15 height to B55: alone a
    B15 above sqrt(B11 B55), some 4e6 N s here, would drive the hull."""

    parameters = {"": {"B15": (2e6, 7e6, 2e7), "height": (90.0,) * 3}}

    def force(self, now):
        b, z = self.p["B15"], self.p["height"]
        push = -b * (now.v[:, 0] / z + now.v[:, 2])
        return np.stack([push, 0.0 * b, z * push], axis=1)


class CubicDamping(Effect):
    """-b3 v^3."""

    parameters = {
        "surge": {"b3": (1e5, 5e5, 2e6), "axis": (SURGE,) * 3},
        "pitch": {"b3": (1e12, 5e12, 4e13), "axis": (PITCH,) * 3},
    }
    power = 3

    def force(self, now):
        r, axis = np.arange(len(now.v)), self.p["axis"].astype(int)
        v, force = now.v[r, axis], np.zeros_like(now.v)
        force[r, axis] = -self.p[f"b{self.power}"] * v * np.abs(v) ** (self.power - 1)
        return force


class QuadraticDamping(CubicDamping):
    """-b2 |v| v."""

    parameters = {
        "surge": {"b2": (1e5, 5e5, 2e6), "axis": (SURGE,) * 3},
        "pitch": {"b2": (1.2e10, 6e10, 2.4e11), "axis": (PITCH,) * 3},
    }
    power = 2


class MassProperties(Effect):
    """The declared inertia, centre of mass (its height) or mass is not the hull's."""

    parameters = {
        "inertia": {"inertia_factor": (1.01, 1.03, 1.08)},
        "centre_of_mass": {"rise": (0.1, 0.4, 1.2)},
        "mass": {"mass_factor": (1.004, 1.016, 1.05)},
    }

    @staticmethod
    def amend(setup, p):
        setup["mass"] *= p.get("mass_factor", 1.0)
        setup["inertia"] *= p.get("inertia_factor", 1.0)
        setup["centre"] += p.get("rise", 0.0)


class SensorReference(Effect):
    """The tracked point is (x, z) from the reference point."""

    parameters = {"": {"x": (0.7, 2.5, 8.0), "z": (2.5, 8.0, 25.0)}}

    @staticmethod
    def amend(setup, p):
        setup["tracked"] = (p["x"], p["z"])


class SensorLag(Effect):
    """What the wave channel says at t was so at t - lag."""

    parameters = {"": {"lag": (0.05, 0.25, 1.0)}}

    @staticmethod
    def amend(setup, p):
        setup["lag"] = p["lag"]


class WaveGaugePosition(Effect):
    """The gauge is at x, not at the reference point."""

    parameters = {"": {"x": (-1.5, -6.0, -20.0)}}

    @staticmethod
    def amend(setup, p):
        setup["gauge"] = p["x"]


class WaveReflection(Effect):
    """r eta(t - tau) comes back against the waves; the wave channel has the incident waves only, or also what comes back."""

    parameters = {
        "": {"share": (0.01, 0.04, 0.15), "delay": (90.0,) * 3},
        "incident": {"seen": (0.0,) * 3},
        "measured": {"seen": (1.0,) * 3},
    }

    @staticmethod
    def amend(setup, p):
        setup["reflection"], setup["seen"] = (p["share"], p["delay"]), p["seen"]


class StaticOffset(Effect):
    """A constant force, in surge or (as a moment) in pitch."""

    parameters = {"surge": {"Fx": (1e3, 5e3, 3e4), "My": (0.0,) * 3}, "pitch": {"Fx": (0.0,) * 3, "My": (4e5, 2e6, 1e7)}}

    def force(self, now):
        return np.stack([self.p["Fx"], 0.0 * self.p["Fx"], self.p["My"]], axis=1)


class StiffnessDrift(Effect):
    """Outside the catalogue: the mooring softens while a test runs, F = rate t x, N/m/s."""

    parameters = {"": {"rate": (0.6, 2.5, 10.0)}}
    catalogue = False

    def force(self, now):
        return along(SURGE, self.p["rate"] * now.t * now.q[:, 0])


class EndStop(Effect):
    """Outside the catalogue: the hull leans on something elastic beyond x_stop in surge, on one side."""

    parameters = {"": {"x_stop": (5.0, 3.0, 2.0), "stiffness": (3e3, 1e4, 4e4)}}
    catalogue = False

    def force(self, now):
        return along(SURGE, -self.p["stiffness"] * np.maximum(now.q[:, 0] - self.p["x_stop"], 0.0))


class Cogging(Effect):
    """Outside the catalogue: a force that goes with the place, F sin(2 pi x / length): a guide wheel out of round."""

    parameters = {"": {"force": (1e3, 5e3, 2.5e4), "length": (3.0,) * 3}}
    catalogue = False

    def force(self, now):
        return along(SURGE, self.p["force"] * np.sin(2 * np.pi * now.q[:, 0] / self.p["length"]))


class ParametricPitch(Effect):
    """Outside the catalogue: heave stiffens pitch, M = -gain z theta, and pitch pushes heave by gain theta^2 / 2."""

    parameters = {"": {"gain": (2.5e8, 8e8, 2e9)}}
    catalogue = False

    def force(self, now):
        z, theta = now.q[:, 1], now.q[:, 2]
        return np.stack([0.0 * z, -0.5 * self.p["gain"] * theta**2, -self.p["gain"] * z * theta], axis=1)


HALF = 0.1  # s, the unit of now.half

EFFECTS: dict[str, type[Effect]] = {
    "umbilical": Umbilical,
    "coulomb_friction": CoulombFriction,
    "hysteresis": Hysteresis,
    "mooring_nonlinearity": MooringNonlinearity,
    "radiation_memory": RadiationMemory,
    "current": Current,
    "amplitude_dependent_drag": AmplitudeDependentDrag,
    "sea_state_dependent_drag": SeaStateDependentDrag,
    "wave_drift": WaveDrift,
    "wave_drift_damping": WaveDriftDamping,
    "hidden_oscillator": HiddenOscillator,
    "nonlinear_hydrostatics": NonlinearHydrostatics,
    "coupled_damping": CoupledDamping,
    "cubic_damping": CubicDamping,
    "quadratic_damping": QuadraticDamping,
    "mass_properties": MassProperties,
    "sensor_reference": SensorReference,
    "sensor_lag": SensorLag,
    "wave_gauge_position": WaveGaugePosition,
    "wave_reflection": WaveReflection,
    "static_offset": StaticOffset,
    "stiffness_drift": StiffnessDrift,
    "end_stop": EndStop,
    "cogging": Cogging,
    "parametric_pitch": ParametricPitch,
}


def find(effect: str) -> tuple[type[Effect], str]:
    """Class and variant of "name" or "name:variant"."""
    name, _, variant = effect.partition(":")
    if name not in EFFECTS:
        raise ValueError(f"effect {name!r}: have {', '.join(EFFECTS)}")
    variants = EFFECTS[name].variants()
    if variant and variant not in variants:
        raise ValueError(f"effect {name!r} has no variant {variant!r}: have {', '.join(filter(None, variants)) or 'none'}")
    return EFFECTS[name], variant or variants[0]
