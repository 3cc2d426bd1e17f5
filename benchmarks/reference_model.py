"""A floating platform in still water, by the book, in plain NumPy: test data and the honest baseline for speed.

It shares no code with jaxhydro or calibration and solves the same laws another way. Earth axes, origin at still water
level, z up. State y = [position of the reference point (3), unit quaternion x y z w (4), its velocity (3), angular
velocity (3)], all in earth axes. At every evaluation the 6x6 mass matrix about the displaced reference point is put
together in earth axes,

    sum m_i [1; r x] (dv + dw x r + w x (w x r)) = forces ,

so there are no Euler-angle kinematics, no Coriolis matrix and no body-fixed velocities. Reported motions are
q = [surge, sway, heave, roll, pitch, yaw] of the reference point, R = Rz(yaw) Ry(pitch) Rx(roll), in m and rad.

Laws (reference sizes as in the campaign format): each strip below still water carries along its two transverse,
body-fixed directions e the forces -rho Ca V (e . a) and -1/2 rho Cd D dl |u| (e . u), |u| the length of the transverse
velocity; each free wet end of a column carries the like along its axis on 2/3 pi r^3 and pi r^2. Buoyancy is exact for
straight members cut by still water (a column's slanted waterplane included). Moorings are straight springs or a linear
matrix. A strip cut by still water counts with its wet part, at that part's centre. Waves: reference_waves.py.
"""

from pathlib import Path

import numpy as np
from ruamel.yaml import YAML
from scipy.integrate import solve_ivp
from scipy.optimize import root
from scipy.spatial.transform import Rotation

NOT_MODELLED = ("added_mass", "quadratic_damping", "stiffness")


class ReferenceModel:
    """A platform (the dictionary of a platform.yaml) cut into strips of at most `strip` and `pontoon_strip` metres."""

    def __init__(self, platform: dict, strip: float = 0.5, pontoon_strip: float = 2.0):
        if any(platform.get(key) for key in NOT_MODELLED) or "parts" in platform["rigid_body"]:
            raise NotImplementedError(f"the reference model has no {', '.join(NOT_MODELLED)} or rigid_body.parts")
        self.density = float(platform["water"]["density"])
        self.gravity = float(platform["water"].get("gravity", 9.80665))
        body = platform["rigid_body"]
        self.mass, self.centre_of_mass = float(body["mass"]), np.array(body["centre_of_mass"], float)
        self.inertia = symmetric(body["inertia"], 3, "I", "xyz")
        self.damping = symmetric(platform.get("linear_damping") or {}, 6, "B", "123456")
        self._read_members(platform, strip, pontoon_strip)
        self._read_mooring(platform.get("mooring") or {"kind": "none"})
        self._read_hydrostatics(platform.get("hydrostatics") or {})

    @classmethod
    def from_yaml(cls, path, strip: float = 0.5, pontoon_strip: float = 2.0) -> "ReferenceModel":
        return cls(YAML(typ="safe").load(Path(path)), strip, pontoon_strip)

    def _read_members(self, platform, strip, pontoon_strip):
        """Cuts the members; arrays over strips have the strip last, and those over directions [e1 | e2 | end axes]."""
        members = [turned for member in platform["members"] for turned in headings(member)]
        every_end = np.array([end for member in members for end in member["ends"]]).reshape(-1, 3)
        strips, ends, columns = [np.zeros((0, 19))], [np.zeros((0, 10))], [np.zeros((0, 18))]
        for number, member in enumerate(members):
            a, b, e1, e2, axis = member["vectors"]
            w, h = member["sides"]
            area = w * h * (np.pi / 4 if member["circular"] else 1.0)
            column = axis[2] >= np.sqrt(0.5)
            c = platform["coefficients"][member["group"]]
            second = "t" if column else "z"  # a pontoon's second direction is the vertical
            length = np.linalg.norm(b - a)
            n = int(np.ceil(length / (strip if column else pontoon_strip) - 1e-9))
            dl = length / n
            rho, volume = self.density, area * dl
            common = [
                *axis,
                *e1,
                *e2,
                dl,
                volume,
                rho * c["Ca_t"] * volume,
                rho * c["Ca_" + second] * volume,
                0.5 * rho * c["Cd_t"] * h * dl,
                0.5 * rho * c["Cd_" + second] * w * dl,
                number,
            ]
            strips.append(np.hstack([a + (np.arange(n)[:, None] + 0.5) * dl * axis, np.tile(common, (n, 1))]))
            if column:
                second_moments = [np.pi / 64 * w**4] * 2 if member["circular"] else [h * w**3 / 12, w * h**3 / 12]
                columns.append([[*a, *b, *e1, *e2, *axis, area, *second_moments]])
                loads = [rho * c["Ca_z"] * 2 / 3 * np.pi * (area / np.pi) ** 1.5, 0.5 * rho * c["Cd_z"] * area]
                ends += [
                    [[*end, *axis, *loads, push, number]]  # free: joined to no other member's end
                    for end, push in ((a, area), (b, -area))  # push: force along the axis per unit pressure
                    if (np.linalg.norm(every_end - end, axis=1) < 1e-6).sum() == 1
                ]

        table, end_table, column_table = (np.vstack(rows).T.copy() for rows in (strips, ends, columns))
        self.members, self.strip_member, self.end_member = members, table[18].astype(int), end_table[9].astype(int)
        self.end_push = end_table[8]
        self.node, self.axis, self.length, self.volume = table[:3], table[3:6], table[12], table[13]
        self.end_node = end_table[:3]
        self.directions = np.hstack([table[6:9], table[9:12], end_table[3:6]])
        self.direction_mass = np.concatenate([table[14], table[15], end_table[6]])
        self.direction_drag = np.concatenate([table[16], table[17], end_table[7]])
        self.column_vectors = column_table[:15].reshape(5, 3, -1)  # a, b, e1, e2, axis
        self.column_area, self.column_i1, self.column_i2 = column_table[15:]
        self.strips_count = self.length.size

    def _read_mooring(self, mooring):
        self.spring_matrix, self.preload = np.zeros((6, 6)), np.zeros(6)
        lines = mooring["lines"] if mooring["kind"] == "linear_springs" else []
        if mooring["kind"] == "stiffness_matrix":
            self.spring_matrix = np.array(mooring["stiffness"], float)
            self.preload = np.array(mooring.get("preload", np.zeros(6)), float)
        self.anchor, self.fairlead = (
            np.array([line[key] for line in lines], float).reshape(-1, 3).T for key in ("anchor", "fairlead")
        )
        spans = np.linalg.norm(self.anchor - self.fairlead, axis=0)
        self.spring = np.array(
            [
                line["stiffness"] if "stiffness" in line else line["axial_stiffness"] / line["unstretched_length"]
                for line in lines
            ],
            float,
        )
        self.slack_length = np.array(
            [
                line["unstretched_length"] if "unstretched_length" in line else span - line["pretension"] / line["stiffness"]
                for line, span in zip(lines, spans)
            ],
            float,
        )

    def _read_hydrostatics(self, declared):
        """What a declared volume or stiffness has more than the geometry: linear terms about the upright position."""
        own = self.geometry_hydrostatics()
        self.centre_of_buoyancy = own["centre_of_buoyancy"]
        self.extra_volume = declared.get("displaced_volume", own["displaced_volume"]) - own["displaced_volume"]
        self.extra_c33 = declared.get("C33", own["C33"]) - own["C33"]
        self.extra_tilt = np.zeros(2)
        lift = self.density * self.gravity * self.extra_volume * self.centre_of_buoyancy[2]
        weight = self.mass * self.gravity * self.centre_of_mass[2]
        for k, key in enumerate(("C44", "C55")):
            if key + "_buoyancy" in declared:
                self.extra_tilt[k] = declared[key + "_buoyancy"] - own[key + "_buoyancy"] - lift
            elif key in declared:
                self.extra_tilt[k] = declared[key] + weight - own[key + "_buoyancy"] - lift

    def wetted(self, position, turn, level=0.0):
        """Displaced strips: offsets (3, n) of the wet parts' centres from the reference point, and wet shares (n,), with
        the water's surface at `level` (), (n,)."""
        middle, axis = turn @ self.node, turn @ self.axis
        rise = self.length * axis[2]
        share = np.clip(0.5 - (position[2] + middle[2] - level) / np.maximum(np.abs(rise), 1e-9), 0.0, 1.0)
        return middle - axis * (0.5 * (1.0 - share) * self.length * np.sign(rise)), share

    def geometry_hydrostatics(self) -> dict:
        """Upright volume (m3), its centre (m), waterplane area (m2) and stiffness (N/m, N m/rad) of the members alone;
        `..._buoyancy` without the weight's share -m g z_G, C44 and C55 with it."""
        offset, share = self.wetted(np.zeros(3), np.eye(3))
        volume = (self.volume * share).sum()
        centre = self.first_moment(0.0, np.eye(3), offset, share) / volume if volume else np.zeros(3)
        a, b, e1, e2, axis = self.column_vectors
        cut = (a[2] < 0) & (b[2] >= 0)
        at = a - axis * a[2] / axis[2]
        h1, h2 = e1 - axis * e1[2] / axis[2], e2 - axis * e2[2] / axis[2]
        plane = cut * self.column_area / axis[2]
        second = plane * at**2 + cut / axis[2] * (self.column_i1 * h1**2 + self.column_i2 * h2**2)
        unit = self.density * self.gravity
        c44, c55 = (unit * (second[k].sum() + volume * centre[2]) for k in (1, 0))
        weight = self.mass * self.gravity * self.centre_of_mass[2]
        return {
            "displaced_volume": volume,
            "centre_of_buoyancy": centre,
            "waterplane_area": plane.sum(),
            "C33": unit * plane.sum(),
            "C44_buoyancy": c44,
            "C55_buoyancy": c55,
            "C44": c44 - weight,
            "C55": c55 - weight,
        }

    def first_moment(self, heave, turn, offset, share):
        """Wet volume times its centre's offset (3,) from the reference point: strips cut square, and the wedges at
        columns' slanted waterplanes (exact while still water cuts a column's side only)."""
        a, b, e1, e2, axis = turn @ self.column_vectors
        cut = (heave + a[2] < 0) & (heave + b[2] >= 0)
        wedge = -(self.column_i1 * e1[2] * e1 + self.column_i2 * e2[2] * e2) / axis[2]
        wedge += 0.5 * axis * (self.column_i1 * e1[2] ** 2 + self.column_i2 * e2[2] ** 2) / axis[2] ** 2
        return offset @ (self.volume * share) + wedge @ cut

    def static_load(self, position, turn, offset, share):
        """Force and moment (6,) about the displaced reference point: weight, buoyancy and mooring."""
        unit = self.density * self.gravity
        lever = turn @ np.stack([self.centre_of_mass, self.centre_of_buoyancy], axis=1)
        weight, extra = self.mass * self.gravity, unit * self.extra_volume
        first = unit * self.first_moment(position[2], turn, offset, share) - weight * lever[:, 0] + extra * lever[:, 1]
        tilt = turn[:2, 2]
        load = np.array(
            [
                0.0,
                0.0,
                unit * (self.volume @ share) - weight + extra - self.extra_c33 * position[2],
                first[1] + self.extra_tilt[0] * tilt[1],
                -first[0] - self.extra_tilt[1] * tilt[0],
                0.0,
            ]
        )
        if self.spring.size:
            arm = turn @ self.fairlead
            line = self.anchor - position[:, None] - arm
            span = np.sqrt((line * line).sum(axis=0))
            pull = line * (self.spring * np.maximum(span - self.slack_length, 0.0) / span)
            load[:3] += pull.sum(axis=1)
            load[3:] += cross(arm, pull).sum(axis=1)
        elif self.spring_matrix.any() or self.preload.any():
            angles = Rotation.from_matrix(turn).as_euler("ZYX")[::-1]
            load += self.preload - self.spring_matrix @ np.concatenate([position, angles])
        return load

    def fluid(self, t, position, turn, offset, share):
        """For every direction: where its load acts (3, k) from the reference point, its unit vector (3, k), its wet
        share (k,), and the water's velocity along it and the force by the water's acceleration and pressure (none)."""
        ends = turn @ self.end_node
        wet = np.concatenate([share, share, position[2] + ends[2] < 0])
        return np.hstack([offset, offset, ends]), turn @ self.directions, wet, 0.0, 0.0

    def balance(self, t, y):
        """Mass matrix (6, 6) about the displaced reference point, earth axes, and load (6,)."""
        position, speed, spin = y[:3], y[7:], y[10:]
        turn = matrix_of(y[3:7])
        offset, share = self.wetted(position, turn)
        at, along, wet, flow, push = self.fluid(t, position, turn, offset, share)
        reach = np.vstack([along, cross(at, along)])  # (6, k): unit generalised forces
        centripetal = (spin @ along) * (spin @ at) - (spin @ spin) * (along * at).sum(axis=0)
        through = speed @ reach - flow  # velocity along each direction, relative
        n = self.strips_count
        total = np.abs(through)
        total[:n] = total[n : 2 * n] = np.sqrt(through[:n] ** 2 + through[n : 2 * n] ** 2)
        added = self.direction_mass * wet
        damped = self.damping @ np.concatenate([speed[:3] @ turn, spin @ turn])  # along body axes
        load = self.static_load(position, turn, offset, share)
        load -= np.concatenate([turn @ damped[:3], turn @ damped[3:]])
        load -= reach @ (added * centripetal + self.direction_drag * wet * total * through - push)

        arm = turn @ self.centre_of_mass
        inertia = turn @ self.inertia @ turn.T + self.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        matrix = (reach * added) @ reach.T
        matrix[:3, :3] += self.mass * np.eye(3)
        matrix[3:, :3] += self.mass * skew(arm)
        matrix[:3, 3:] -= self.mass * skew(arm)
        matrix[3:, 3:] += inertia
        load[:3] -= self.mass * (spin * (spin @ arm) - arm * (spin @ spin))
        load[3:] -= skew(spin) @ (inertia @ spin)
        return matrix, load

    def rate(self, t, y):
        """dy/dt (13,); in still water `t` (s) does not matter."""
        x, scalar, spin = y[3:6], y[6], y[10:]
        turning = 0.5 * np.array([*(scalar * spin + skew(spin) @ x), -(spin @ x)])
        return np.concatenate([y[7:10], turning, np.linalg.solve(*self.balance(t, y))])

    def equilibrium(self) -> np.ndarray:
        """Motions q (6,) at rest; directions without stiffness stay at zero."""
        scale = self.mass * self.gravity * np.array([1, 1, 1, 10, 10, 10])

        def residual(q):
            y = state_of(q)
            turn = matrix_of(y[3:7])
            return self.static_load(y[:3], turn, *self.wetted(y[:3], turn)) / scale

        held = np.array([np.abs(residual(1e-3 * unit) - residual(np.zeros(6))).max() > 1e-10 for unit in np.eye(6)])
        spread = np.eye(6)[:, held]
        found = root(lambda x: residual(spread @ x), np.zeros(held.sum()), method="lm", options={"xtol": 1e-14})
        if np.abs(residual(spread @ found.x)).max() > 1e-9:
            raise RuntimeError(f"no static equilibrium: {found.message}")
        return spread @ found.x

    def decay(self, offset, velocity=np.zeros(6), duration=600.0, dt=0.2, method="dop853", step=0.1, tolerance=1e-9):
        """Free motion t (n,), q (n, 6) from the equilibrium plus `offset` (6,), every `dt` s for `duration` s.

        `velocity` (6,) is that of the reference point and the angular velocity, earth axes. method "rk4" takes the
        fixed `step` (a whole number of steps per `dt`), "dop853" the relative `tolerance`.
        """
        q0 = self.equilibrium() + np.asarray(offset, float)
        if method == "rk4":
            every = round(dt / step)
            if every < 1 or abs(every * step - dt) > 1e-9:
                raise ValueError(f"dt {dt} s is not a whole number of steps of {step} s")
            t, q = rk4(self, q0, velocity, step, duration)
            return t[::every], q[::every]
        t = np.arange(round(duration / dt) + 1) * dt
        done = solve_ivp(
            self.rate,
            (0.0, t[-1]),
            state_of(q0, velocity),
            method="DOP853",
            t_eval=t,
            rtol=tolerance,
            atol=tolerance * np.array([1.0] * 3 + [0.01] * 4 + [0.1] * 3 + [0.001] * 3),
        )
        if not done.success:
            raise RuntimeError(done.message)
        return t, motions_of(done.y.T)


def rk4(model: ReferenceModel, q0, v0, step: float, duration: float):
    """The classical fourth-order Runge-Kutta method: t (n,) and motions q (n, 6) at every step."""
    count = round(duration / step)
    states = np.empty((count + 1, 13))
    states[0] = y = state_of(q0, v0)
    for j in range(count):
        states[j + 1] = y = rk4_step(model, j * step, y, step, model.rate(j * step, y))
    return np.arange(count + 1) * step, motions_of(states)


def rk4_step(model, t, y, step, k1):
    k2 = model.rate(t + 0.5 * step, y + 0.5 * step * k1)
    k3 = model.rate(t + 0.5 * step, y + 0.5 * step * k2)
    k4 = model.rate(t + step, y + step * k3)
    return y + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def state_of(q, velocity=np.zeros(6)):
    """State (13,) of motions q (6,) and earth-axes velocities (6,)."""
    q = np.asarray(q, float)
    return np.concatenate([q[:3], Rotation.from_euler("ZYX", q[:2:-1]).as_quat(), velocity])


def motions_of(states):
    """Motions (n, 6) of states (n, 13)."""
    return np.hstack([states[:, :3], Rotation.from_quat(states[:, 3:7]).as_euler("ZYX")[:, ::-1]])


def matrix_of(quaternion):
    """Rotation matrix of a quaternion x y z w of any length."""
    x, y, z, w = (quaternion / np.sqrt(quaternion @ quaternion)).tolist()
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def skew(a):
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def cross(a, b):
    """Columns of a cross columns of b, (3, n)."""
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def symmetric(entries, size, letter, names):
    """Square matrix of entries such as Ixy or B15; an entry's mirror image is itself unless it is given too."""
    matrix = np.zeros((size, size))
    for i, first in enumerate(names):
        for j, second in enumerate(names):
            matrix[i, j] = entries.get(letter + first + second, entries.get(letter + second + first, 0.0))
    return matrix


def headings(member):
    """A member's copies turned about z: lower end first, axes (e1 horizontal, e2, axis) and sides along e1 and e2."""
    circular = member["shape"] == "circ"
    if "stations" in member:
        raise NotImplementedError(f"member {member['name']}: the reference model has no tapered members")
    a, b = sorted(np.array([member["rA"], member["rB"]], float), key=lambda end: end[2])
    sides = (float(member["d"]),) * 2 if circular else tuple(float(side) for side in member["d"])
    for heading in np.atleast_1d(member.get("heading", 0.0)):
        turn = Rotation.from_euler("z", heading, degrees=True).as_matrix()
        axis = turn @ (b - a) / np.linalg.norm(b - a)
        level = np.cross([0.0, 0.0, 1.0], axis)  # vertical: width along the heading
        e1 = level / np.linalg.norm(level) if np.linalg.norm(level) > 1e-6 else turn @ np.array([1.0, 0.0, 0.0])
        yield {
            "group": member["group"],
            "circular": circular,
            "sides": sides,
            "ends": [turn @ a, turn @ b],
            "vectors": (turn @ a, turn @ b, e1, np.cross(axis, e1), axis),
            "maccamy_fuchs": member.get("maccamy_fuchs", True),
        }
