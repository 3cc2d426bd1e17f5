"""A wave tank in plain NumPy: campaigns in the contract's format with one effect (or more) that their platform file lacks.

    python -m benchmarks.tank --effect umbilical --strength 2 --seed 3 --out DIR [--truth FILE]

It shares no code with jaxhydro or calibration. The hull moves in the plane (surge, heave, pitch; finite pitch) in waves
along +x; members are taken in three dimensions, mirror images about the plane together. State: place, pitch and rates of the
reference point, and what effects remember; a leading axis over runs: all tests of all campaigns of a batch march at once.

Laws as in benchmarks/reference_model.py and reference_waves.py, whose kernels of second order, dispersion and diffraction are
used here; discretised another way. Columns carry `column_strips` strips over what is wet of them at the moment (up to the
surface in waves), pontoons strips of about `pontoon_strip` m. Water: first order and all that it binds at second order
(without set-down), vertical stretching, MacCamy-Fuchs with phase on columns; Fourier sums at every step on a grid over x and
depth (3 m, cubic in x; ten levels, cubic in the logarithm of the depth). Adams-Bashforth of fourth order, 0.2 s.

Sensors are zeroed where the hull floats before it is moored; runs begin at rest where its loads leave it (decays: released
from there, imperfectly), in the full sea. The campaign folder says nothing of the effect; the truth is given back.
"""

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from time import process_time
from types import SimpleNamespace

import numpy as np
from ruamel.yaml import YAML
from scipy.sparse import csr_array

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from benchmarks.reference_model import headings
from benchmarks.reference_waves import bound, diffraction, wavenumber
from benchmarks.tank_effects import DEG, EFFECTS, HALF, find

PLATFORM = """\
name: VolturnUS-S
water: {density: 1025.0, depth: 200.0}
rigid_body:
  mass: 20054283.0
  centre_of_mass: [0.0, 0.0, -2.4]
  inertia: {Ixx: 44200000000.0, Iyy: 44200000000.0, Izz: 24000000000.0}
members:
- {name: centre_column, group: column, shape: circ, d: 10.0, rA: [0, 0, -20], rB: [0, 0, 15]}
- {name: outer_column, group: column, shape: circ, d: 12.5, rA: [51.75, 0, -20], rB: [51.75, 0, 15], heading: [60, 180, 300]}
- name: pontoon
  group: pontoon
  shape: rect
  d: [12.5, 7.0]
  rA: [5.0, 0, -16.5]
  rB: [45.5, 0, -16.5]
  heading: [60, 180, 300]
  elements: 3
coefficients:
  column: {Ca_t: 1.0, Ca_z: 0.5, Cd_t: 1.0, Cd_z: 2.0}
  pontoon: {Ca_t: 0.5, Ca_z: 1.5, Cd_t: 1.5, Cd_z: 3.0}
linear_damping: {B11: 50000.0, B33: 200000.0, B55: 300000000.0}
mooring:
  kind: linear_springs
  lines:
  - {anchor: [150.0, 259.808, -14.0], fairlead: [29.0, 50.229, -14.0], stiffness: 45000.0, pretension: 1500000.0}
  - {anchor: [-300.0, 0.0, -14.0], fairlead: [-58.0, 0.0, -14.0], stiffness: 45000.0, pretension: 1500000.0}
  - {anchor: [150.0, -259.808, -14.0], fairlead: [29.0, -50.229, -14.0], stiffness: 45000.0, pretension: 1500000.0}
"""

STEP = 0.2  # s, of the records and of the integration
CHANNELS = ("surge", "heave", "pitch")
AMPLITUDES = {"surge": (4.0, 8.0, 12.0), "heave": (1.5, 3.0, 4.5), "pitch": (2.0, 4.0, 6.0)}  # m, m, deg
DURATIONS = {"surge": 700.0, "heave": 260.0, "pitch": 320.0, "sea": 1600.0}  # s
PERIODS = {"surge": 135.0, "heave": 20.0, "pitch": 27.0}  # s, only to size the releases' rates
SEAS = {"sea-1": (3.1, 8.96), "sea-2": (5.5, 11.0)}  # Hs m, Tp s
TRANSIENT = 400.0
NOISE = {"surge": 0.01, "heave": 0.005, "pitch": 0.01, "wave": 0.01}  # m, m, deg, m
UNITS = np.array([1.0, 1.0, 1 / DEG])
RANGES = {
    "column": {"Ca_t": (1.0, 1.6), "Ca_z": (0.1, 0.5), "Cd_t": (1.5, 2.5), "Cd_z": (1.5, 3.0)},
    "pontoon": {"Ca_t": (0.1, 0.6), "Ca_z": (1.4, 2.0), "Cd_t": (1.5, 2.2), "Cd_z": (4.0, 5.2)},
}
DAMPING = {"B11": (4e4, 7e4), "B33": (1.5e5, 2.2e5), "B55": (3.3e8, 5e8)}
ERRORS = {"mass": 0.002, "inertia": 0.005, "line_stiffness": 0.01, "pretension": 0.01}  # one standard deviation, of one
PEAKEDNESS = 2.0  # of JONSWAP
LOW, CUTOFF = 0.03, 0.3  # Hz, of the free waves
CYCLE = 1638.4  # s, after which a sea repeats itself
REACH = 20.0  # m, excursion of the hull that the grid covers
SPACING, LEVELS, DEEPEST, STRETCH = 3.0, 10, 28.0, 2.5  # m, -, m, -
CHUNK = 160  # steps whose water is worked out at once
BATCH = 12  # campaigns at once
TRUTH, RELEASE, WAVES, SENSORS = range(4)  # streams of random numbers


@dataclass
class Spec:
    """A campaign to make: `effect` a name, "name:variant", several of them or None; strength 1, 2 or 3."""

    folder: Path | str | None = None
    effect: str | Sequence[str] | None = None
    strength: int = 2
    seed: int = 0
    coefficients: dict = field(default_factory=dict)  # group or "damping" or "errors" -> values instead
    scale: float = 1.0  # of the effect's sizes, for studies
    name: str = ""  # of the campaign in its manifest (default: campaign-SEED)

    @property
    def effects(self) -> list[str]:
        return [] if self.effect is None else [self.effect] if isinstance(self.effect, str) else list(self.effect)


def true_values(seed: int) -> dict:
    """Coefficients, linear damping and factors on what the platform file declares, of a seed."""
    random = np.random.default_rng([seed, TRUTH])
    truth = {group: {name: float(random.uniform(*limits)) for name, limits in names.items()} for group, names in RANGES.items()}
    truth["damping"] = {name: float(random.uniform(*limits)) for name, limits in DAMPING.items()}
    truth["errors"] = {name: float(1 + deviation * random.standard_normal()) for name, deviation in ERRORS.items()}
    return truth


class Setup:
    """What a campaign's tank is made with: true values, then what its effects amend."""

    def __init__(self, spec: Spec):
        self.spec, self.truth = spec, true_values(spec.seed)
        for group, values in spec.coefficients.items():
            self.truth[group] = self.truth[group] | values
        if spec.strength not in (1, 2, 3):
            raise ValueError(f"strength {spec.strength!r}: 1, 2 or 3")
        self.platform = YAML(typ="safe").load(PLATFORM)
        body, errors = self.platform["rigid_body"], self.truth["errors"]
        self.values = {
            "mass": body["mass"] * errors["mass"],
            "inertia": body["inertia"]["Iyy"] * errors["inertia"],
            "centre": body["centre_of_mass"][2],
            "lumps": [],
            "sliding": (0.0, 0.0),
            "current": 0.0,
            "tracked": (0.0, 0.0),
            "lag": 0.0,
            "gauge": 0.0,
            "reflection": (0.0, 0.0),
            "seen": 0.0,
        }
        self.effects = []
        for effect in spec.effects:
            law, variant = find(effect)
            name = effect.partition(":")[0]
            if name in [other[0] for other in self.effects]:
                raise ValueError(f"effect {name!r} is asked for twice")
            p = law.values(variant, spec.strength)
            if spec.scale != 1.0:
                p = {key: value * spec.scale if key == law.size(variant) else value for key, value in p.items()}
            law.amend(self.values, p)
            self.effects.append((name, variant, p))

    def record(self) -> dict:
        """The truth, as written to JSON."""
        return {
            "seed": self.spec.seed,
            "strength": self.spec.strength,
            "effects": [{"effect": name, "variant": variant, "parameters": p} for name, variant, p in self.effects],
            "coefficients": {group: self.truth[group] for group in RANGES},
            "linear_damping": self.truth["damping"],
            "factors_on_declared": self.truth["errors"],
        }


class Sea:
    """A long-crested sea along +x on the frequencies n / CYCLE: complex amplitudes `first` (m) of elevation at x = 0 in
    `bins`; reflection (share, delay in s). Coefficients c of a series say Re sum c exp(i omega t)."""

    def __init__(self, bins, first, depth=200.0, gravity=9.80665, reflection=(0.0, 0.0), order=2):
        self.depth, self.gravity, self.reflection = depth, gravity, reflection
        self.bins, self.first_amplitude = np.asarray(bins), np.asarray(first, complex)
        self.first_omega = 2 * np.pi / CYCLE * self.bins
        self.k = wavenumber(self.first_omega, depth, gravity)
        self.half_steps = round(DURATIONS["sea"] / HALF) + 1
        self.bound = None
        if order == 2:
            amplitude, phase = np.abs(first), np.angle(first)
            found = np.hstack(bound(self.first_omega, self.k, 0.0 * self.k, phase, amplitude, depth, gravity, False))
            number = np.rint(found[0] * CYCLE / (2 * np.pi)).astype(int)
            kept = np.argsort(number, kind="stable")
            self.bound = number[kept], *found[[1, 3, 4, 5]][:, kept]  # k, phase, elevation, potential

    @classmethod
    def jonswap(cls, hs, tp, random, **more):
        bins = np.arange(round(LOW * CYCLE), round(CUTOFF * CYCLE) + 1)
        ratio = bins / CYCLE * tp
        width = np.where(ratio <= 1, 0.07, 0.09)
        shape = ratio**-5.0 * np.exp(-1.25 * ratio**-4.0) * PEAKEDNESS ** np.exp(-0.5 * ((ratio - 1) / width) ** 2)
        amplitude = hs / 4 * np.sqrt(2 * shape / shape.sum())
        return cls(bins, amplitude * np.exp(2j * np.pi * random.random(bins.size)), **more)

    @property
    def size(self):
        """Frequencies 1 ... size have coefficients."""
        return int(self.bins.max() if self.bound is None else 2 * self.bins.max())

    def sum_of(self, coefficients, t):
        """Complex sum of coefficients (n,) on the first-order frequencies at even times from 0 (HALF s)."""
        n = round(CYCLE / HALF)
        spectrum = np.zeros(n, complex)
        spectrum[self.bins] = coefficients
        return (np.fft.ifft(spectrum) * n)[: t.size]

    def elevation(self, x, reflected=True):
        """Coefficients (size, x) of the surface, to second order."""
        x = np.atleast_1d(np.asarray(x, float))
        found = np.zeros((self.size + 1, x.size), complex)
        for sign, amplitude in self.trains(reflected):
            found[self.bins] += amplitude[:, None] * np.exp(-1j * sign * np.outer(self.k, x))
        for number, part, wave in self.pairs(x):
            found[number] += self.bound[3][part] @ wave
        return found[1:]

    def series(self, coefficients, t):
        """Values (t, ...) of coefficients (size, ...)."""
        angle = np.outer(t, 2 * np.pi / CYCLE * np.arange(1, len(coefficients) + 1))
        return np.cos(angle) @ coefficients.real - np.sin(angle) @ coefficients.imag

    def trains(self, reflected=True):
        """Direction and complex amplitudes of the free waves."""
        yield 1, self.first_amplitude
        share, delay = self.reflection
        if share and reflected:
            yield -1, share * self.first_amplitude * np.exp(-1j * self.first_omega * delay)

    def pairs(self, x):
        """Number, slice of the pairs and exp(i (phase - k x)) of every frequency that pairs bind."""
        if self.bound is None:
            return
        number, k, phase = self.bound[:3]
        edges = np.flatnonzero(np.diff(number, prepend=-1, append=-1))
        wave = np.exp(1j * (phase[:, None] - np.outer(k, x)))
        for begin, end in pairwise(edges):
            yield number[begin], slice(begin, end), wave[begin:end]

    def fields(self, x, z, radii):
        """Coefficients (size, x, z, 5 + radii): u, w, du/dt, dw/dt, pressure / density; du/dt diffracted by each radius."""
        found = np.zeros((self.size + 1, x.size, z.size, 5 + len(radii)), complex)
        cosh, sinh = self.profiles(self.k, z)
        for sign, amplitude in self.trains():
            wave = (amplitude * self.gravity / self.first_omega)[:, None] * np.exp(-1j * sign * np.outer(self.k, x))
            even, odd = wave[:, :, None] * cosh[:, None], wave[:, :, None] * sinh[:, None]
            omega, k = self.first_omega[:, None, None], self.k[:, None, None]
            u, w = sign * k * even, 1j * k * odd
            parts = [u, w, 1j * omega * u, 1j * omega * w, omega * even]
            parts += [parts[2] * diffraction(k * radius) for radius in radii]
            for q, part in enumerate(parts):
                found[self.bins, ..., q] += part
        if self.bound is not None:
            k, potential = self.bound[1], self.bound[4]
            cosh, sinh = self.profiles(np.abs(k), z)
            push, rise, level = potential * k, 1j * potential * np.abs(k), potential
            weights = [push[:, None] * cosh, rise[:, None] * sinh, level[:, None] * cosh]
            weights += [weights[0] * diffraction(np.abs(k) * radius)[:, None] for radius in radii]
            for number, part, wave in self.pairs(x):
                u, w, p, *diffracted = (wave.T @ weight[part] for weight in weights)
                omega = 2 * np.pi / CYCLE * number
                for q, value in enumerate(
                    (u, w, *(1j * omega * part for part in (u, w)), omega * p, *(1j * omega * part for part in diffracted))
                ):
                    found[number, ..., q] += value
        return found[1:]

    def profiles(self, k, z):
        """cosh and sinh k(z + h) over cosh k h, (k, z)."""
        down, far = np.exp(np.outer(k, z)), np.exp(-2 * self.depth * k)[:, None]
        return tuple((down + sign * far / np.maximum(down, 1e-300)) / (1 + far) for sign in (1, -1))


class Water:
    """Seas (a list) on the grid: flow at points by cubic interpolation, chunk after chunk of time steps."""

    def __init__(self, seas, left, right, radii, step):
        self.x0 = left - REACH - SPACING
        self.nx = int(np.ceil((right + REACH + SPACING - self.x0) / SPACING)) + 1
        x = self.x0 + SPACING * np.arange(self.nx)
        self.top = np.expm1(STRETCH)
        z = -DEEPEST * np.expm1(STRETCH * np.arange(LEVELS) / (LEVELS - 1)) / self.top
        self.q, self.count, self.step = 5 + len(radii), len(seas), step
        size = max(sea.size for sea in seas)
        self.omega = 2 * np.pi / CYCLE * np.arange(1, size + 1)
        self.table = np.zeros((len(seas), 2 * size, self.nx * (1 + LEVELS * self.q)), np.float32)
        for table, sea in zip(self.table, seas):
            both = np.concatenate([sea.elevation(x), sea.fields(x, z, radii).reshape(sea.size, -1)], axis=1)
            table[: sea.size], table[size : size + sea.size] = both.real, -both.imag
        self.begin = self.end = 0
        self.four = np.arange(4)
        self.corner = (self.four[:, None] * LEVELS + self.four).ravel()

    def at(self, t):
        """Surface (seas, nx) and flow (seas nx levels, q) at t, a whole number of steps, or halfway between two."""
        n = t / self.step
        if abs(n - round(n)) > 1e-6:
            before, after = self.at((n - 0.5) * self.step), self.at((n + 0.5) * self.step)
            return tuple(0.5 * (a + b) for a, b in zip(before, after))
        n = round(n)
        if not self.begin <= n < self.end:
            self.begin, self.end = max(n - 1, 0), max(n - 1, 0) + CHUNK
            angle = np.outer(np.arange(self.begin, self.end) * self.step, self.omega)
            wave = np.concatenate([np.cos(angle), np.sin(angle)], axis=1).astype(np.float32)
            self.values = np.stack([wave @ table for table in self.table], axis=1)
        now = self.values[n - self.begin]
        return now[:, : self.nx], np.ascontiguousarray(now[:, self.nx :]).reshape(-1, self.q)

    def across(self, x):
        """First of four grid points and their weights (..., 4)."""
        place = (x - self.x0) / SPACING
        first = np.clip(place.astype(int) - 1, 0, self.nx - 4)
        return first, lagrange(place - first)

    def surface(self, values, sea, x):
        """Elevation at x (r, n) in seas (r,)."""
        first, weight = self.across(x)
        return (values[sea[:, None, None], first[..., None] + self.four] * weight).sum(axis=-1)

    def flow(self, values, sea, x, z):
        """(r, n, q) at points (r, n); above still water as at it."""
        first, across = self.across(x)
        place = np.log1p(np.maximum(-z, 0.0) * (self.top / DEEPEST)) * ((LEVELS - 1) / STRETCH)
        level = np.clip(place.astype(int) - 1, 0, LEVELS - 4)
        down = lagrange(place - level)
        start = (sea[:, None] * self.nx + first) * LEVELS + level
        index = (start[..., None] + self.corner).astype(np.int32).ravel()
        weight = (across[..., :, None] * down[..., None, :]).astype(np.float32).ravel()
        rows = np.arange(0, index.size + 1, 16, dtype=np.int32)
        return (csr_array((weight, index, rows), shape=(x.size, len(values))) @ values).reshape(*x.shape, self.q)


def lagrange(r):
    """Weights (..., 4) of values at 0, 1, 2, 3 for the cubic at r."""
    a, b, c = r - 1, r - 2, r - 3
    return np.stack([a * b * c / -6, r * b * c / 2, r * a * c / -2, r * a * b / 6], axis=-1)


class Tank:
    """Runs of several setups, one batch: `runs` are (setup's index, decay or "", Sea or None, Hs, Tp)."""

    def __init__(self, setups, runs, step=STEP, column_strips=20, pontoon_strip=2.5):
        self.setups, self.step = setups, step
        self.campaign = np.array([run[0] for run in runs])
        platform = setups[0].platform
        self.density, self.gravity = platform["water"]["density"], platform["water"].get("gravity", 9.80665)
        self._hull(platform, column_strips, pontoon_strip)
        self._body(platform)
        seas = list({id(run[2]): run[2] for run in runs if run[2] is not None}.values())
        self.water = None
        if seas:
            if len(runs) != sum(run[2] is not None for run in runs):
                raise ValueError("runs in waves and runs in still water do not go together")
            self.water = Water(seas, self.bx.min(), self.bx.max(), self.radii, step)
            self.sea = np.array([next(i for i, sea in enumerate(seas) if sea is run[2]) for run in runs])
        self._effects(runs)

    def _hull(self, platform, column_strips, pontoon_strip):
        """Points and directions, one array each; mirror images about y = 0 are one member of weight two."""
        kept: dict[tuple, list] = {}
        for member in (turned for one in platform["members"] for turned in headings(one)):
            a, b = member["vectors"][:2]
            key = (*np.round(a[[0, 2]], 6), *np.round(b[[0, 2]], 6), *np.round(np.abs([a[1], b[1]]), 6), *member["sides"])
            kept.setdefault(key, [member, 0])[1] += 1
        columns = [(m, w) for m, w in kept.values() if m["vectors"][4][2] > 1 - 1e-9]
        pontoons = [(m, w) for m, w in kept.values() if abs(m["vectors"][4][2]) < 1e-9]
        if len(columns) + len(pontoons) != len(kept) or not all(m["circular"] for m, _ in columns):
            raise NotImplementedError("upright circular columns and level pontoons only")
        n = self.column_strips = column_strips
        self.column_count = len(columns)
        ends = np.array([[*m["vectors"][0][[0, 2]], m["vectors"][1][2] - m["vectors"][0][2]] for m, _ in columns])
        self.column_x, self.column_z, self.column_length = ends.T
        self.column_area = np.array([w * np.pi / 4 * m["sides"][0] ** 2 for m, w in columns])
        self.column_second = np.array([w * np.pi / 64 * m["sides"][0] ** 4 for m, w in columns])
        radius = [m["sides"][0] / 2 for m, _ in columns]
        self.radii = sorted(set(radius))
        self.radius_of = np.repeat([self.radii.index(r) for r in radius], n)
        bx, bz = list(np.repeat(self.column_x, n)), [0.0] * (n * len(columns))
        rows = []  # place, ex, ez, added volume, push volume, area, ...
        for c, (m, w) in enumerate(columns):
            d, length = m["sides"][0], self.column_length[c]
            full = w * np.pi / 4 * d * d * length / n
            rows += [(c * n + j, 1.0, 0.0, full, full, w * d * length / n, 0.0, m["group"], "t", -1) for j in range(n)]
        flat, upright, sides = [], [], []
        self.pontoon_volume = self.pontoon_x = self.pontoon_z = 0.0
        for m, w in pontoons:
            a, b, e1, _, axis = m["vectors"]
            width, height = m["sides"]
            length = np.linalg.norm(b - a)
            count = int(np.ceil(length / pontoon_strip - 1e-9))
            volume, dl = w * width * height * length / count, length / count
            self.pontoon_volume += volume * count
            self.pontoon_x += volume * count * 0.5 * (a + b)[0]
            self.pontoon_z += volume * count * 0.5 * (a + b)[2]
            for j in range(count):
                point = a + (j + 0.5) * dl * axis
                bx.append(point[0])
                bz.append(point[2])
                level = (len(bx) - 1, e1[0], 0.0, volume, volume, w * height * dl, 0.0, m["group"], "t")
                if abs(e1[0]) > 1e-9:
                    flat.append((*level, len(upright)))
                upright.append((len(bx) - 1, 0.0, 1.0, volume, volume, w * width * dl, 0.0, m["group"], "z", -1))
            sides += [(end, axis, s * w * width * height, m["group"]) for end, s in ((a, 1.0), (b, -1.0))]
        start = len(rows) + len(flat)  # of the pontoons' vertical directions
        rows += [(*row[:9], start + row[9]) for row in flat] + upright
        for c, (m, w) in enumerate(columns):
            r = m["sides"][0] / 2
            bx.append(self.column_x[c])
            bz.append(self.column_z[c])
            rows.append(
                (
                    len(bx) - 1,
                    0.0,
                    1.0,
                    w * 2 / 3 * np.pi * r**3,
                    None,
                    w * np.pi * r * r,
                    w * np.pi * r * r,
                    m["group"],
                    "z",
                    -1,
                )
            )
        for end, axis, area, group in sides:
            bx.append(end[0])
            bz.append(end[2])
            rows.append((len(bx) - 1, axis[0], axis[2], 0.0, None, 0.0, area, group, "t", -1))
        self.bx, self.bz = np.array(bx), np.array(bz)
        place, ex, ez, added, pushed, area, face, group, kind, mate = zip(*rows)
        self.place, self.ex, self.ez = np.array(place), np.array(ex), np.array(ez)
        self.first_column, self.first_end = n * len(columns), start + len(upright)
        self.pairs = np.array([k for k in range(len(rows)) if mate[k] >= 0])
        self.mates = np.array([mate[k] for k in self.pairs])
        self.vertical = np.abs(self.ez) > 0.5

        def of(prefix):
            return np.array([[s.truth[g][prefix + "_" + k] for g, k in zip(group, kind)] for s in self.setups])[self.campaign]

        self.added = self.density * np.array(added) * of("Ca")
        self.drag = 0.5 * self.density * np.array(area) * of("Cd")
        body = self.density * np.array([volume or 0.0 for volume in pushed])
        self.forced = self.added + body
        self.forced[:, : self.first_column] = body[: self.first_column]  # diffraction stands for 1 + Ca
        self.face = self.density * np.array(face)

    def _body(self, platform):
        """Rigid body, damping and mooring, (r, ...)."""
        value = {
            key: np.array([s.values[key] for s in self.setups])[self.campaign]
            for key in ("mass", "inertia", "centre", "current", "tracked", "sliding")
        }
        self.current, self.tracked, (self.sliding, self.sliding_z) = value["current"], value["tracked"], value["sliding"].T
        self.mass, self.first = value["mass"], np.stack([0 * value["mass"], value["mass"] * value["centre"]])
        self.about = value["inertia"] + value["mass"] * value["centre"] ** 2
        volume = (-self.column_area * self.column_z).sum() + self.pontoon_volume
        self.afloat = (volume - self.mass / self.density) / self.column_area.sum()  # heave before it is moored
        for r, c in enumerate(self.campaign):
            for m, x, z in self.setups[c].values["lumps"]:
                self.mass[r] += m
                self.first[:, r] += m * x, m * z
                self.about[r] += m * (x * x + z * z)
        damping = [[s.truth["damping"][name] for name in ("B11", "B33", "B55")] for s in self.setups]
        self.damping = np.array(damping)[self.campaign]
        lines = platform["mooring"]["lines"]
        self.anchor, self.fairlead = (np.array([line[key] for line in lines], float).T for key in ("anchor", "fairlead"))
        errors = [s.truth["errors"] for s in self.setups]
        stiffness, pull = (
            [[line[key] * e[name] for line in lines] for e in errors]
            for key, name in (("stiffness", "line_stiffness"), ("pretension", "pretension"))
        )
        self.spring = np.array(stiffness)[self.campaign]
        self.slack = np.linalg.norm(self.anchor - self.fairlead, axis=0) - np.array(pull)[self.campaign] / self.spring

    def _effects(self, runs):
        """Laws of all campaigns, one object for those of a kind; each with its columns of the remembered states."""
        self.laws, self.states = [], 0
        self.equilibrium = np.zeros((len(runs), 3))
        for name, law in EFFECTS.items():
            of = [next((p for other, _, p in s.effects if other == name), None) for s in self.setups]
            index = np.array([r for r, c in enumerate(self.campaign) if of[c] is not None], int)
            if not index.size:
                continue
            every = {key for p in of if p for key in p}
            p = {key: np.array([of[self.campaign[r]].get(key, 0.0) for r in index]) for key in every}
            about = {
                "decay": [runs[r][1] for r in index],
                "sea": [runs[r][2] for r in index],
                "step": self.step,
                "hs": np.array([runs[r][3] for r in index]),
                "tp": np.array([runs[r][4] for r in index]),
                "equilibrium": np.zeros((index.size, 3)),
            }
            one = law(p, about)
            one.index, one.columns = index, slice(self.states, self.states + law.states)
            self.states += law.states
            self.laws.append(one)

    def size_of(self, u):
        """Size of the transverse velocity for every direction, from velocities (r, k) along them."""
        size = np.abs(u)
        if self.pairs.size:
            both = np.sqrt(u[:, self.pairs] ** 2 + u[:, self.mates] ** 2)
            size[:, self.pairs] = size[:, self.mates] = both
        return size

    def rate(self, t, y, first=True, still=False):
        """dy/dt (r, 6 + states) of y = [x, z, pitch, their rates, remembered]; `still`: without waves."""
        q, v, n, cols = y[:, :3], y[:, 3:6], self.column_strips, self.first_column
        c, s = np.cos(q[:, 2:3]), np.sin(q[:, 2:3])
        waves = self.water is not None and not still
        foot = q[:, 1:2] - s * self.column_x + c * self.column_z  # of columns
        rise = self.column_length * c
        wet0 = np.clip(-foot / rise, 0.0, 1.0)  # up to still water
        wet = wet0
        if waves:
            surface, flow = self.water.at(t)
            along = self.column_z + self.column_length * wet0
            level = self.water.surface(surface, self.sea, q[:, :1] + c * self.column_x + s * along)
            wet = np.clip((level - foot) / rise, 0.0, 1.0)
        bz = np.empty((len(y), self.bx.size))
        bz[:, cols:] = self.bz[cols:]
        share = (np.arange(n) + 0.5) / n
        bz[:, :cols] = (self.column_z[:, None] + (self.column_length * wet)[..., None] * share).reshape(len(y), -1)
        ax, az = c * self.bx + s * bz, c * bz - s * self.bx
        ex, ez = c * self.ex + s * self.ez, c * self.ez - s * self.ex
        px, pz = ax[:, self.place], az[:, self.place]
        arm = pz * ex - px * ez
        u = v[:, :1] * ex + v[:, 1:2] * ez + v[:, 2:3] * arm - self.current[:, None] * ex
        wetness = np.ones_like(u)
        wetness[:, :cols] = np.repeat(wet, n, axis=1)
        added = self.added * wetness
        if waves:
            water = self.water.flow(flow, self.sea, q[:, :1] + ax, q[:, 1:2] + az)
            accx, accz = water[..., 2].astype(float), water[..., 3].astype(float)
            for i in range(len(self.radii)):
                these = self.radius_of == i
                accx[:, :cols][:, these] = water[:, :cols][:, these, 5 + i]
            accz[:, :cols] *= 2.0  # of diffraction too, but for its phase
            u -= water[:, self.place, 0] * ex + water[:, self.place, 1] * ez
            push = self.forced * wetness * (accx[:, self.place] * ex + accz[:, self.place] * ez)
            ends = self.first_end
            push[:, ends:] += self.face[ends:] * water[:, self.place[ends:], 4]
        spin = v[:, 2:3] ** 2
        product = self.size_of(u) * u
        laws = []
        for law in self.laws:
            i = law.index
            now = SimpleNamespace(
                t=t,
                half=round(t / HALF),
                q=q[i],
                v=v[i],
                s=y[i, 6:][:, law.columns],
                first=first,
                still=still,
                size_of=self.size_of,
                vertical=self.vertical,
            )
            laws.append((law, i, now))
            if law.acts("drag"):
                product[i] = law.drag(now, u[i], self.size_of(u[i]))
        f = added * spin * (px * ex + pz * ez) - self.drag * wetness * product
        if waves:
            f += push
        load = np.stack([(f * ex).sum(axis=1), (f * ez).sum(axis=1), (f * arm).sum(axis=1)], axis=1)
        load += self.static(q, c[:, 0], s[:, 0], wet0)
        c, s, w = c[:, 0], s[:, 0], v[:, 2]
        b = self.damping * np.stack([c * v[:, 0] - s * v[:, 1], s * v[:, 0] + c * v[:, 1], w], axis=1)
        load -= np.stack([c * b[:, 0] + s * b[:, 1], c * b[:, 1] - s * b[:, 0], b[:, 2]], axis=1)
        gx, gz = c * self.first[0] + s * self.first[1], c * self.first[1] - s * self.first[0]
        height = c * self.sliding_z
        load[:, 0] += w * w * (gx - self.sliding * s * self.sliding_z)  # the sliding mass is not along in x
        load[:, 1] += w * w * gz
        load[:, 2] -= height * self.sliding * w * w * s * self.sliding_z
        out = np.zeros_like(y)
        out[:, :3] = v
        for law, i, now in laws:
            if law.acts("force"):
                load[i] += law.force(now)
            if law.states:
                out[i, 6 + law.columns.start : 6 + law.columns.stop] = law.rate(now)
        matrix = np.empty((len(y), 3, 3))
        matrix[:, 0, 0] = self.mass - self.sliding + (added * ex * ex).sum(axis=1)
        matrix[:, 1, 1] = self.mass + (added * ez * ez).sum(axis=1)
        matrix[:, 2, 2] = self.about - self.sliding * height**2 + (added * arm * arm).sum(axis=1)
        matrix[:, 0, 1] = matrix[:, 1, 0] = (added * ex * ez).sum(axis=1)
        matrix[:, 0, 2] = matrix[:, 2, 0] = gz - self.sliding * height + (added * ex * arm).sum(axis=1)
        matrix[:, 1, 2] = matrix[:, 2, 1] = -gx + (added * ez * arm).sum(axis=1)
        out[:, 3:6] = np.linalg.solve(matrix, load[..., None])[..., 0]
        return out

    def static(self, q, c, s, wet):
        """Weight, buoyancy and mooring (r, 3); c, s cosine and sine of pitch, wet (r, columns) up to still water."""
        volume = self.column_area * self.column_length * wet
        middle = self.column_z + 0.5 * self.column_length * wet
        c1, s1 = c[:, None], s[:, None]
        cut = (wet > 0) & (wet < 1)
        wedge = self.column_second * cut * (s1 + 0.5 * s1**3 / c1**2)
        unit = self.density * self.gravity
        first = (volume * (c1 * self.column_x + s1 * middle) + wedge).sum(axis=1) + c * self.pontoon_x + s * self.pontoon_z
        weight = self.gravity * (c * self.first[0] + s * self.first[1])
        load = np.stack(
            [
                np.zeros_like(c),
                unit * (volume.sum(axis=1) + self.pontoon_volume) - self.gravity * self.mass,
                weight - unit * first,
            ],
            axis=1,
        )
        fx, fy, fz = self.fairlead
        ax, az = c1 * fx + s1 * fz, c1 * fz - s1 * fx
        line = np.stack(
            [self.anchor[0] - q[:, :1] - ax, np.broadcast_to(self.anchor[1] - fy, ax.shape), self.anchor[2] - q[:, 1:2] - az]
        )
        span = np.sqrt((line * line).sum(axis=0))
        pull = line * (self.spring * np.maximum(span - self.slack, 0.0) / span)
        load[:, 0] += pull[0].sum(axis=1)
        load[:, 1] += pull[2].sum(axis=1)
        load[:, 2] += (az * pull[0] - ax * pull[2]).sum(axis=1)
        return load

    def at_rest(self):
        """State (r, 6 + states) where the loads leave the hull in still water (and its current)."""
        q = np.zeros((len(self.campaign), 3))

        def residual(q):
            return self.rate(0.0, self.resting(q), still=True)[:, 3:6]

        for _ in range(12):
            now, slope = residual(q), np.empty((len(q), 3, 3))
            for j, small in enumerate((1e-4, 1e-4, 1e-6)):
                shift = small * np.eye(3)[j]
                slope[:, :, j] = (residual(q + shift) - residual(q - shift)) / (2 * small)
            step = np.linalg.solve(slope, now[..., None])[..., 0]
            q = q - step
            if np.abs(step).max() < 1e-10:
                break
        else:
            raise RuntimeError("no equilibrium was found")
        self.equilibrium = q
        for law in self.laws:
            law.runs["equilibrium"] = q[law.index]
        return self.resting(q)

    def resting(self, q):
        y = np.zeros((len(q), 6 + self.states))
        y[:, :3] = q
        for law in self.laws:
            y[law.index, 6 + law.columns.start : 6 + law.columns.stop] = law.rest(q[law.index])
        return y

    def march(self, y, duration):
        """Motions (r, n, 3) at every step, by Adams-Bashforth; three steps of Runge-Kutta first."""
        h, count = self.step, round(duration / self.step)
        out = np.empty((len(y), count + 1, 3))
        out[:, 0] = y[:, :3]
        rates = []
        for j in range(count):
            t = j * h
            rates = [self.rate(t, y), *rates[:3]]
            if j < 3:
                k2 = self.rate(t + h / 2, y + h / 2 * rates[0], False)
                k3 = self.rate(t + h / 2, y + h / 2 * k2, False)
                k4 = self.rate(t + h, y + h * k3, False)
                y = y + h / 6 * (rates[0] + 2 * k2 + 2 * k3 + k4)
            else:
                y = y + h / 24 * (55 * rates[0] - 59 * rates[1] + 37 * rates[2] - 9 * rates[3])
            out[:, j + 1] = y[:, :3]
            if j % 100 == 0 and not (np.abs(y[:, 0]) < REACH).all():  # not a number too
                raise RuntimeError(f"a hull left the tank: surge {y[:, 0]} m at {t:.0f} s")
        return out

    def sensed(self, motion):
        """What the sensors see of motions (r, n, 3): the tracked point, from where it was before mooring; m, m, rad."""
        x, z = self.tracked.T[:, :, None]
        c, s = np.cos(motion[..., 2]), np.sin(motion[..., 2])
        return np.stack(
            [motion[..., 0] + c * x + s * z - x, motion[..., 1] + c * z - s * x - z - self.afloat[:, None], motion[..., 2]],
            axis=-1,
        )


def release(seed: int, name: str, index: int):
    """Offset and rates (3,), (3,) at the start of a decay: 0.5 % and 1.5 % of the like-numbered amplitudes in the released
    and the other motions (one standard deviation), and 1 % of the amplitudes of their rates."""
    random = np.random.default_rng([seed, RELEASE, CHANNELS.index(name), index])
    offset, rates = np.zeros(3), np.zeros(3)
    for j, channel in enumerate(CHANNELS):
        amplitude = AMPLITUDES[channel][index] / UNITS[j]
        main, (one, other) = channel == name, random.standard_normal(2)
        offset[j] = amplitude * (main + (0.005 if main else 0.015) * one)
        rates[j] = amplitude * 2 * np.pi / PERIODS[channel] * 0.01 * other
    return offset, rates


def sea_of(setup: Setup, name: str, known: dict) -> Sea:
    """The sea of a setup's test; `known` keeps those that were made."""
    reflection = setup.values["reflection"]
    key = (setup.spec.seed, name, reflection)
    if key not in known:
        random = np.random.default_rng([setup.spec.seed, WAVES, list(SEAS).index(name)])
        known[key] = Sea.jonswap(*SEAS[name], random, depth=setup.platform["water"]["depth"], reflection=reflection)
    return known[key]


def simulate(setups: Sequence[Setup], tests: Sequence[str] | None = None, step: float = STEP, **fineness) -> list[dict]:
    """Clean records of each setup: test's id -> (n, 3) surge m, heave m, pitch deg, and in seas a fourth column, the wave
    channel (m). Sampled every STEP s. `fineness`: column_strips, pontoon_strip."""
    found: list[dict] = [{} for _ in setups]
    every, known = round(STEP / step), {}
    for name in (*CHANNELS, "sea"):
        ids = [f"{name}-{j + 1}" for j in range(2 if name == "sea" else 3)]
        ids = [i for i in ids if tests is None or i in tests]
        if not ids:
            continue
        seas = {(c, i): sea_of(setup, i, known) if name == "sea" else None for c, setup in enumerate(setups) for i in ids}
        order = [(c, i) for c in range(len(setups)) for i in ids]
        runs = [(c, "" if name == "sea" else name, seas[c, i], *SEAS.get(i, (0.0, 0.0))) for c, i in order]
        tank = Tank(setups, runs, step, **fineness)
        y = tank.at_rest()
        if name != "sea":
            for r, (c, i) in enumerate(order):
                offset, rates = release(setups[c].spec.seed, name, int(i[-1]) - 1)
                y[r, :3] += offset
                y[r, 3:6] += rates
        motion = tank.sensed(tank.march(y, DURATIONS[name]))[:, ::every] * UNITS
        for r, (c, i) in enumerate(order):
            record = motion[r]
            if name == "sea":
                values, t = setups[c].values, np.arange(len(record)) * STEP
                level = seas[c, i].elevation(values["gauge"], reflected=bool(values["seen"]))
                record = np.column_stack([record, seas[c, i].series(level, t - values["lag"])])
            found[c][i] = record
    return found


def write(setup: Setup, records: dict, folder) -> None:
    """The contract's files, with noise."""
    folder, seed = Path(folder), setup.spec.seed
    folder.mkdir(parents=True, exist_ok=True)
    tests = []
    for number, (name, clean) in enumerate(records.items()):
        kind, index = name.split("-")
        sea = kind == "sea"
        channels = [*CHANNELS, "wave"][: clean.shape[1]]
        random = np.random.default_rng([seed, SENSORS, number])
        noisy = clean + random.standard_normal(clean.shape) * [NOISE[channel] for channel in channels]
        header = "time_s,surge_m,heave_m,pitch_deg" + ",wave_m" * sea
        row = ",".join(["%.5f"] * (1 + len(channels)))
        table = np.column_stack([np.arange(len(clean)) * STEP, noisy])
        lines = "\n".join([row] * len(table)) % tuple(table.ravel().tolist())
        (folder / f"{name}.csv").write_text(f"{header}\n{lines}\n")
        last = index == ("2" if sea else "3")
        test = {"id": name, "kind": "irregular" if sea else "decay", "file": f"{name}.csv", "use": "holdout" if last else "fit"}
        hs, tp = SEAS.get(name, (0.0, 0.0))
        tests.append(
            test
            | (
                {"significant_wave_height": hs, "peak_period": tp, "transient": TRANSIENT}
                if sea
                else {"degree_of_freedom": kind}
            )
        )
    manifest = {
        "name": setup.spec.name or f"campaign-{seed}",
        "platform": "platform.yaml",
        "scale": 1.0,
        "channels": {
            "time": {"column": "time_s", "unit": "s"},
            "surge": {"column": "surge_m", "unit": "m"},
            "heave": {"column": "heave_m", "unit": "m"},
            "pitch": {"column": "pitch_deg", "unit": "deg"},
        },
        "wave_channel": {"column": "wave_m", "unit": "m", "position": [0.0, 0.0]},
        "noise": {channel: NOISE[channel] for channel in CHANNELS},
        "tests": tests,
    }
    yaml = YAML(typ="safe", pure=True)
    yaml.default_flow_style, yaml.sort_base_mapping_type_on_output = False, False
    yaml.dump(manifest, folder / "campaign.yaml")
    yaml.dump(setup.platform, folder / "platform.yaml")


def make_campaigns(specs: Sequence[Spec], batch: int = BATCH) -> list[dict]:
    """Writes the campaigns of specs that name a folder; their truths. Those of one seed share seas: keep them together."""
    truths = []
    for start in range(0, len(specs), batch):
        setups = [Setup(spec) for spec in specs[start : start + batch]]
        for setup, records in zip(setups, simulate(setups)):
            if setup.spec.folder is not None:
                write(setup, records, setup.spec.folder)
            truths.append(setup.record())
    return truths


def make_campaign(folder, effect: str | Sequence[str] | None, strength: int, seed: int) -> dict:
    """Writes one campaign into `folder`; its truth."""
    return make_campaigns([Spec(folder, effect, strength, seed)])[0]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--effect", action="append", help=f"{', '.join(EFFECTS)}; NAME:VARIANT; again for two (default: none)")
    parser.add_argument("--strength", type=int, default=2, choices=(1, 2, 3))
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, required=True, help="campaign folder to write")
    parser.add_argument("--truth", type=Path, help="JSON file for what was in the tank")
    arguments = parser.parse_args()
    start = process_time()
    try:
        truth = make_campaign(arguments.out, arguments.effect, arguments.strength, arguments.seed)
    except ValueError as error:
        parser.error(str(error))
    if arguments.truth:
        arguments.truth.write_text(json.dumps(truth, indent=2) + "\n")
    print(f"{arguments.out}: {len(list(arguments.out.iterdir()))} files in {process_time() - start:.1f} s of processor time")


if __name__ == "__main__":
    main()
