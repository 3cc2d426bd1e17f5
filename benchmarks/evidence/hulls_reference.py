"""A hull in small regular waves in the frequency domain, in plain NumPy: what the section `hulls` is compared with.

It shares no code with jaxhydro. From the dictionary of a platform file it adds up pressure on areas and Morison's inertia
on thin slices (Faltinsen 1990, Sea Loads, sections 3.3 and 7.2), at the draught where the hull rests, and solves

    (C - omega^2 (M + A) + i omega B) X = F ,

for a wave eta = Re a exp(i (omega t - k . x)). Drag, of second order in the wave's amplitude, is left out. Members are upright
or inclined cylinders and boxes, and level ones that are wholly wet or lie at the surface.
"""

import itertools
import math
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq
from scipy.special import jvp, yvp

SLICES = 400  # of a member
UPRIGHT = math.cos(math.radians(10.0))


class Loads(NamedTuple):
    """What acts on slices: `lever` (6, n) of a unit force, added mass (kg) and what the water's acceleration (kg) and
    pressure (m2) along it do. `diffracts` (n,) is the radius (m) of a column that diffracts waves, or 0."""

    point: np.ndarray
    lever: np.ndarray
    added: np.ndarray
    inertia: np.ndarray
    area: np.ndarray
    diffracts: np.ndarray


def copies(platform: dict[str, Any]) -> list[dict[str, Any]]:
    """Members, turned about z by each heading, with their ends as arrays (m)."""
    members = []
    for member in platform["members"]:
        for heading in np.radians(np.atleast_1d(member.get("heading", 0.0))):
            c, s = math.cos(heading), math.sin(heading)
            turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
            members.append(member | {"rA": turn @ np.array(member["rA"], float), "rB": turn @ np.array(member["rB"], float)})
    return members


def across(axis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two unit vectors across an axis: the first horizontal."""
    first = (
        np.array([1.0, 0, 0])
        if abs(axis[2]) > 1 - 1e-9
        else np.cross([0, 0, 1], axis) / np.linalg.norm(np.cross([0, 0, 1], axis))
    )
    return first, np.cross(axis, first)


def sections(member: dict[str, Any], share: np.ndarray) -> np.ndarray:
    """Width and height (2, n), m, at shares of the length from rA to rB."""
    sizes = np.array(member["d"], float)
    if "stations" not in member:
        return np.tile(np.broadcast_to(sizes, 2)[:, None], len(share))
    at = np.array(member["stations"], float)
    at = (at - at[0]) / (at[-1] - at[0])
    # a station named twice: what lies at it belongs to the piece above
    piece = np.clip(np.searchsorted(at, share, side="right") - 1, 0, len(at) - 2)
    size = sizes[piece] + (sizes[piece + 1] - sizes[piece]) * (share - at[piece]) / np.maximum(
        at[piece + 1] - at[piece], 1e-300
    )
    return np.stack([size, size])


def pieces(member: dict[str, Any], heave: float) -> list[tuple[float, float]]:
    """Shares of the length between stations that are under water with the hull raised by `heave` (m)."""
    at = np.array(member.get("stations", [0.0, 1.0]), float)
    at = (at - at[0]) / (at[-1] - at[0])
    low, high = member["rA"][2] + heave, member["rB"][2] + heave
    cut = np.interp(0.0, sorted((low, high)), (0.0, 1.0) if low < high else (1.0, 0.0)) if high != low else 1.0
    first, last = (0.0, cut) if low < high else (cut, 1.0)
    if high == low:
        first, last = 0.0, 1.0
    return [(max(a, first), min(b, last)) for a, b in itertools.pairwise(at) if min(b, last) > max(a, first)]


def loads_of(platform: dict[str, Any], heave: float, afloat_too: bool = True) -> tuple[Loads, np.ndarray]:
    """Slices, ends and steps of all members; and volume (m3), waterplane (m2, m4 about x and y) and the moment of the volume
    (m4) about the reference point, which is at z = `heave` (m). Without boxes `afloat_too` for their form alone."""
    rho = platform["water"]["density"]
    rows: list[tuple] = []
    form = np.zeros(5)
    for member in copies(platform):
        a, b = member["rA"], member["rB"]
        if b[2] < a[2]:
            a, b, member = b, a, member | {"rA": b, "rB": a}
        along = b - a
        length = float(np.linalg.norm(along))
        axis = along / length
        column = axis[2] > math.sqrt(0.5)
        c = platform["coefficients"][member.get("group", member["name"])]
        shape = math.pi / 4 if member["shape"] == "circ" else 1.0
        e1, e2 = across(axis)
        at_surface = member.get("maccamy_fuchs", shape < 1 and axis[2] > UPRIGHT and a[2] <= 0 <= b[2])
        second = "t" if column else "z"
        wet, lowered = 1.0, np.zeros(3)
        if not column and abs(axis[2]) < 1e-9:
            height = float(sections(member, np.array([0.5]))[1, 0])
            wet = min(1.0, max(0.0, 0.5 - (a[2] + heave) / height))
            lowered = np.array([0, 0, -0.5 * (1 - wet) * height])
            if shape < 1 and 0 < wet < 1:
                raise NotImplementedError("a level cylinder at the surface")
            if wet == 0.0:
                continue
        elif a[2] + heave >= 0:
            continue

        wetted = pieces(member, heave)
        afloat = 0 < wet < 1 and not column
        closed = 0.0 if afloat else 1.0  # the body's own volume in the waves
        for first, last in wetted:
            share = first + (np.arange(SLICES) + 0.5) / SLICES * (last - first)
            size = sections(member, share)
            volumes = shape * size[0] * size[1] * wet * length * (last - first) / SLICES
            points = a[:, None] + along[:, None] * share + lowered[:, None]
            if afloat and afloat_too:
                rows += box_afloat(a, along, e1, e2, np.array(sections(member, share)[:, 0]), wet, lowered, heave, rho)
            for i in range(SLICES):
                radius = 0.5 * size[0, i] if at_surface else 0.0
                rows.append(
                    (points[:, i], e1, rho * c["Ca_t"] * volumes[i], rho * (closed + c["Ca_t"]) * volumes[i], 0.0, radius)
                )
                rows.append(
                    (
                        points[:, i],
                        e2,
                        rho * c["Ca_" + second] * volumes[i],
                        rho * (closed + c["Ca_" + second]) * volumes[i],
                        0.0,
                        radius,
                    )
                )
            form += [volumes.sum(), 0, 0, 0, volumes @ points[2]]
            edges = sections(member, np.linspace(first + 1e-12, last - 1e-12, SLICES + 1))
            surface, radii = shape * edges[0] * edges[1], 0.5 * edges[0]
            for i in range(SLICES):  # a side that looks along the axis
                if (grown := surface[i + 1] - surface[i]) != 0.0:
                    mass = rho * c["Ca_z"] * 2 / 3 * math.pi * abs(radii[i + 1] ** 3 - radii[i] ** 3) if column else 0.0
                    rows.append((points[:, i], axis, mass, mass, grown, 0.0))
        ends = [
            (wetted[0][0], wetted[0][0], 1.0),
            *((u[1], v[0], 0.0) for u, v in itertools.pairwise(wetted)),
            (wetted[-1][1], wetted[-1][1], -1.0),
        ]
        for below, above, way in ends:  # bottom, steps, top
            sizes = [
                sections(member, np.array([max(below - 1e-12, 0.0)])),
                sections(member, np.array([min(above + 1e-12, 1.0)])),
            ]
            surface = [shape * float(s[0, 0] * s[1, 0]) * wet for s in sizes]
            radius = [0.5 * float(s[0, 0]) if shape < 1 else math.sqrt(float(s[0, 0] * s[1, 0]) / math.pi) for s in sizes]
            point = a + along * below + lowered
            pushed, size = (
                (surface[1] - surface[0], radius[0] ** 3 - radius[1] ** 3) if way == 0.0 else (way * surface[0], radius[0] ** 3)
            )
            if way == -1.0 and column and point[2] + heave > -1e-9:
                tilt = 1 / axis[2]  # the waterplane of a leaning column
                own = shape * float(sizes[0][0, 0] * sizes[0][1, 0]) * tilt
                w, h = float(sizes[0][0, 0]), float(sizes[0][1, 0])
                bend = own * (w * h / 16 if shape < 1 else 1 / 12) * (np.ones(2) if shape < 1 else np.array([h**2, w**2]))
                form[1:4] += [own, own * point[1] ** 2 + bend[0], own * point[0] ** 2 + bend[1]]
                rows.append((point, np.array([0, 0, tilt]) - axis, 0.0, 0.0, surface[0], 0.0))  # nothing of an upright one
                continue
            mass = rho * c["Ca_z"] * 2 / 3 * math.pi * abs(size) if column else 0.0
            if pushed != 0.0 and not afloat:
                rows.append((point, axis, mass, mass, pushed, 0.0))
        if afloat:
            width = float(sections(member, np.array([0.5]))[0, 0])
            middle, own = 0.5 * (a + b), width * length
            about = width**2 / 12 * e1**2 + length**2 / 12 * axis**2
            form[1:4] += [own, own * (middle[1] ** 2 + about[1]), own * (middle[0] ** 2 + about[0])]
    point, direction, added, inertia, area, radius = (np.array(x) for x in zip(*rows))
    lever = np.concatenate([direction, np.cross(point, direction)], axis=1).T
    return Loads(point.T + np.array([[0], [0], [heave]]), lever, added, inertia, area, radius), form


def box_afloat(a, along, e1, e2, size, wet, lowered, heave, rho) -> list[tuple]:
    """Rows of the pressure on a box afloat: that of the water's acceleration in its wet volume, and on its waterplane."""
    (n, across_, deep), (width, height) = (32, 24, 8), size
    s, y, z = ((np.arange(count) + 0.5) / count for count in (n, across_, deep))
    lid = 1 / (n * across_) * width * np.linalg.norm(along)
    rows = []
    for u in s:
        for v in y:
            middle = a + along * u + e1 * width * (v - 0.5)
            surface = middle.copy()
            surface[2] = -heave
            rows.append((surface, e2, 0.0, 0.0, lid, 0.0))
            for w in z:
                point = middle + lowered + e2 * wet * height * (w - 0.5)
                mass = rho * lid * wet * height / deep
                rows += [(point, np.eye(3)[j], 0.0, mass, 0.0, 0.0) for j in range(3)]
    return rows


def square(entries: dict[str, float], letter: str) -> np.ndarray:
    """A 6 by 6 matrix of entries by name; where one of ij and ji is given, the other is its mirror."""
    matrix = np.zeros((6, 6))
    for key, value in entries.items():
        i, j = int(key[1]) - 1, int(key[2]) - 1
        matrix[i, j], matrix[j, i] = value, entries.get(f"{letter}{j + 1}{i + 1}", value)
    return matrix


class Hull:
    """Mass, added mass, damping and stiffness of a platform file about where the hull rests."""

    def __init__(self, platform: dict[str, Any]) -> None:
        self.water = {"gravity": 9.80665} | platform["water"]
        weight = self.water["density"] * self.water["gravity"]
        body = platform["rigid_body"]
        self.mass, lean = np.zeros((6, 6)), 0.0
        for part in body.get("parts", [body]):
            m, (x, y, z) = part["mass"], part["centre_of_mass"]
            arm = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]], float)
            inertia = np.diag([part["inertia"][k] for k in ("Ixx", "Iyy", "Izz")])
            self.mass += np.block([[m * np.eye(3), -m * arm], [m * arm, inertia - m * arm @ arm]])
            lean -= m * self.water["gravity"] * z
        mooring = platform["mooring"]
        lines, pull = square(mooring["stiffness"], "C"), mooring.get("preload", np.zeros(6))[2]
        given = platform.get("hydrostatics", {})

        def lift(heave: float) -> float:
            volume = (
                given["displaced_volume"] - given["C33"] / weight * heave if given else loads_of(platform, heave, False)[1][0]
            )
            return weight * volume - self.mass[0, 0] * self.water["gravity"] + pull - lines[2, 2] * heave

        reach = 0.1 * self.mass[0, 0] / (self.water["density"] * loads_of(platform, 0.0, False)[1][1])
        self.heave = brentq(lift, -reach, reach, xtol=1e-12) if abs(lift(0.0)) > 1e-9 * weight else 0.0
        self.loads, form = loads_of(platform, self.heave)
        self.volume = float(form[0])
        self.added = (self.loads.lever * self.loads.added) @ self.loads.lever.T
        pressure = [form[1], form[2] + form[4], form[3] + form[4]]
        restoring = weight * np.array([0, 0, *pressure, 0])
        if given:
            restoring[2:5] = given["C33"], given["C44_buoyancy"], given["C55_buoyancy"]
        self.stiffness = np.diag(restoring) + np.diag([0, 0, 0, lean, lean, 0]) + lines
        self.damping = square(platform.get("linear_damping", {}), "B")

    def periods(self) -> dict[str, float]:
        """Natural periods (s), each by the motion that has most of its strain energy."""
        values, vectors = np.linalg.eig(np.linalg.solve(self.mass + self.added, self.stiffness))
        energy = np.abs(vectors * (self.stiffness @ vectors)).real
        share = energy / energy.sum(axis=0)
        names = ("surge", "sway", "heave", "roll", "pitch", "yaw")
        return {
            dof: float(2 * math.pi / math.sqrt(values.real[np.argmax(share[i])]))
            for i, dof in enumerate(names)
            if self.stiffness[i, i] > 0
        }

    def motion(self, period: float, heading: float) -> np.ndarray:
        """Complex motion (m, rad) per metre of wave amplitude, in a wave that runs to a `heading` (rad)."""
        omega, depth, g = 2 * math.pi / period, self.water["depth"], self.water["gravity"]
        k = brentq(lambda k: g * k * math.tanh(k * depth) - omega**2, 1e-9, 1e3)
        x, y, z = self.loads.point
        phase = np.exp(-1j * k * (x * math.cos(heading) + y * math.sin(heading)))
        level, upright = np.cosh(k * (z + depth)) / math.sinh(k * depth), np.sinh(k * (z + depth)) / math.sinh(k * depth)
        pressure = self.water["density"] * g * np.cosh(k * (z + depth)) / math.cosh(k * depth) * phase
        flow = 1j * omega**2 * phase * np.stack([level * math.cos(heading), level * math.sin(heading), 1j * upright])
        direction = self.loads.lever[:3]
        inertia = self.loads.inertia.astype(complex)
        for radius in set(self.loads.diffracts) - {0.0}:
            ka, own = k * radius, self.loads.diffracts == radius
            first, second = jvp(1, ka), yvp(1, ka)
            law = 4 * (second - 1j * first) / (math.pi * ka**2 * (first**2 + second**2))
            inertia[own] = (self.loads.inertia - self.loads.added)[own] * law
        force = self.loads.lever @ (inertia * (direction * flow).sum(axis=0) + self.loads.area * pressure)
        dynamic = self.stiffness - omega**2 * (self.mass + self.added) + 1j * omega * self.damping
        held = np.abs(dynamic).sum(axis=1) > 0
        motions = np.zeros(6, complex)
        motions[held] = np.linalg.solve(dynamic[np.ix_(held, held)], force[held])
        return motions
