"""Waves on the reference model, in plain NumPy: every component summed at every strip at every evaluation.

It shares no code with jaxhydro or calibration. A sea is a list of plane waves, free ones and, to second order, the
bound ones of all their pairs, each with its own elevation E and potential amplitude P:

    theta = omega t - k . x + phase,    eta = E cos(theta),    phi = -P cosh |k|(z + h) / cosh |k|h sin(theta),

for a free wave P = E g / omega. Velocity grad phi, acceleration d/dt grad phi at the point (not convective), dynamic
pressure -rho dphi/dt (no velocity squared). Sources: dispersion and profiles, Dean and Dalrymple (1991) ch. 3; pairs,
Sharma and Dean (1981), Agarwal and Manuel (2011); stretching, Wheeler (1970); diffraction, MacCamy and Fuchs (1954).

Loads: on strips rho V (1 + Ca) e . du/dt along their transverse directions e, and drag by the relative velocity; on
columns' free ends dynamic pressure times area, added mass times the water's axial acceleration, drag by the relative
axial velocity. Buoyancy stays up to still water; without stretching so do the strips' loads and added mass, with it
those of columns go up to the surface where the column's axis meets still water.
"""

import numpy as np
from scipy.special import jvp, yvp

from benchmarks.reference_model import ReferenceModel, matrix_of, motions_of, rk4, rk4_step, state_of

STRETCHING = (None, "vertical", "wheeler", "extrapolation")
CHUNK = 16_000  # components times points at once, to stay in cache
UPRIGHT = np.cos(np.deg2rad(10.0))  # diffraction: columns less oblique than that


class Waves:
    """Components (n,) as plain arrays: amplitude (m), omega (rad/s), heading (rad, where to), phase (rad).

    order 2 adds the bound waves of all pairs; the bands (rad/s) keep those sums and differences only. Without
    `set_down` each component's own difference, a constant elevation, is left out (as OpenFAST does).
    """

    def __init__(
        self,
        amplitude,
        omega,
        heading=0.0,
        phase=0.0,
        depth=200.0,
        gravity=9.80665,
        *,
        order=1,
        set_down=True,
        sum_band=(0.0, np.inf),
        difference_band=(0.0, np.inf),
        stretching=None,
    ):
        if stretching not in STRETCHING or order not in (1, 2):
            raise ValueError(f"stretching {stretching!r}, order {order!r}: have {STRETCHING}, 1 or 2")
        amplitude, omega, heading, phase = np.broadcast_arrays(*np.atleast_1d(amplitude, omega, heading, phase))
        self.depth, self.gravity, self.stretching = float(depth), float(gravity), stretching
        k = wavenumber(omega, depth, gravity)
        free = np.stack([omega, k * np.cos(heading), k * np.sin(heading), phase, amplitude, amplitude * gravity / omega])
        table = [free]
        if order == 2:
            sums, differences = bound(*free[:5], self.depth, self.gravity, set_down)
            table += [
                part[:, (low <= part[0]) & (part[0] <= high)]
                for part, (low, high) in ((sums, sum_band), (differences, difference_band))
            ]
        self.omega, self.kx, self.ky, self.phase, self.elevation, self.potential = np.hstack(table).copy()
        self.k = np.hypot(self.kx, self.ky)
        self.bound = np.arange(self.k.size) >= omega.size

    def __len__(self):
        return self.k.size

    def chunks(self, points):
        size = max(1, CHUNK // max(points, 1))
        return (slice(i, i + size) for i in range(0, len(self), size))

    def angle(self, part, t, x, y):
        """theta (components, points)."""
        theta = np.outer(-self.kx[part], x)
        if self.ky[part].any():
            theta -= np.outer(self.ky[part], y)
        return theta + (self.omega[part] * t + self.phase[part])[:, None]

    def surface(self, t, x, y):
        """Elevation (points,) of all components."""
        x, y = np.broadcast_arrays(*np.atleast_1d(x, y))
        return sum(self.elevation[part] @ np.cos(self.angle(part, t, x, y)) for part in self.chunks(x.size))

    def profiles(self, part, z):
        """cosh and sinh |k|(z + h) over cosh |k|h, (components, points); above still water that of still water, or on
        along its tangent ("extrapolation")."""
        k, twice = self.k[part, None], np.exp(-2.0 * self.depth * self.k[part, None])
        down = np.exp(np.maximum(k * np.minimum(z, 0.0), -600.0))
        up, scale = twice / down, 1.0 / (1.0 + twice)
        cosh, sinh = (down + up) * scale, (down - up) * scale
        if self.stretching == "extrapolation" and (z > 0).any():
            rise = k * np.maximum(z, 0.0)
            cosh, sinh = cosh + rise * sinh, sinh + rise * cosh
        return cosh, sinh

    def level(self, t, points):
        """Heights (points,) at which the profiles are taken: Wheeler's bed-to-surface map, else the points' own."""
        if self.stretching != "wheeler":
            return points[2]
        eta = self.surface(t, *points[:2])
        return self.depth * (points[2] - eta) / (self.depth + eta)

    def kinematics(self, t, points, factors=()):
        """Velocity (3, p), acceleration (3, p) and pressure over density (p,) at points (3, p). Of `factors`, pairs of
        complex numbers (n,) and points' indices (q,), each multiplies the accelerations there by component."""
        z = self.level(t, points)
        velocity, acceleration, pressure = np.zeros((3, z.size)), np.zeros((3, z.size)), np.zeros(z.size)
        for part in self.chunks(z.size):
            theta = self.angle(part, t, *points[:2])
            cos, sin = np.cos(theta), np.sin(theta)
            cosh, sinh = self.profiles(part, z)
            flat = self.potential[part] * np.stack([self.kx[part], self.ky[part], self.omega[part]])
            steep = self.potential[part] * self.k[part]
            push, lift = self.omega[part] * flat[:2], self.omega[part] * steep
            even, odd, rising, sinking = cosh * cos, cosh * sin, sinh * cos, sinh * sin
            level = flat @ even
            velocity += [*level[:2], -steep @ sinking]
            pressure += level[2]
            change = np.array([*(-push @ odd), -lift @ rising])
            for factor, where in factors:
                real, imag = factor[part].real, factor[part].imag
                change[:2, where] = -(push * real) @ odd[:, where] - (push * imag) @ even[:, where]
                change[2, where] = -(lift * real) @ rising[:, where] + (lift * imag) @ sinking[:, where]
            acceleration += change
        return velocity, acceleration, pressure


def wavenumber(omega, depth, gravity):
    """Positive k (1/m) of omega^2 = g k tanh(k h), by Newton's method from Eckart's guess."""
    y = np.asarray(omega, float) ** 2 * depth / gravity
    x = y / np.sqrt(np.tanh(y))
    for _ in range(20):
        tanh = np.tanh(x)
        step = (x * tanh - y) / (tanh + x * (1.0 - tanh**2))
        x = x - step
        if np.all(np.abs(step) <= 4e-16 * x):
            break
    return x / depth


def bound(omega, kx, ky, phase, amplitude, depth, gravity, set_down=True):
    """Second-order waves of all pairs, sums and differences: rows omega >= 0, kx, ky, phase, elevation, potential.

    Sharma and Dean (1981), with R = omega^2 / g and D the kernels of the potential. A pair of two is
    written once and so counts twice; a component with itself counts once: Stokes' second harmonic, and the set-down,
    where D- = 0 (the potential's constant is taken as zero). Two of one frequency and different headings have no
    potential either, and a standing elevation.
    """
    m, n = np.tril_indices(omega.size)
    m, n = np.where(omega[m] >= omega[n], m, n), np.where(omega[m] >= omega[n], n, m)
    twice = np.where(m == n, 0.25, 0.5) * amplitude[m] * amplitude[n]
    w_m, w_n, k_m, k_n = omega[m], omega[n], np.hypot(kx, ky)[m], np.hypot(kx, ky)[n]
    r_m, r_n = w_m**2 / gravity, w_n**2 / gravity
    root_m, root_n = np.sqrt(r_m), np.sqrt(r_n)
    dot = kx[m] * kx[n] + ky[m] * ky[n]
    found = []
    for sign in (1, -1):
        kept = np.ones(m.size, bool) if sign == 1 or set_down else m != n
        x, y, root = kx[m] + sign * kx[n], ky[m] + sign * ky[n], root_m + sign * root_n
        k = np.hypot(x, y)
        force = root * (root_n * (k_m**2 - r_m**2) + sign * root_m * (k_n**2 - r_n**2))
        force += 2.0 * root**2 * (dot - sign * r_m * r_n)
        moving = w_m + sign * w_n > 0
        kernel = np.where(moving, force / np.where(moving, root**2 - k * np.tanh(k * depth), 1.0), 0.0)
        elevation = twice * ((kernel - (dot - sign * r_m * r_n)) / (root_m * root_n) + r_m + r_n)
        speed = np.where(moving, w_m + sign * w_n, 1.0)
        potential = twice * gravity**2 / (w_m * w_n) * kernel / speed
        found.append(np.stack([w_m + sign * w_n, x, y, phase[m] + sign * phase[n], elevation, potential])[:, kept])
    return found


def diffraction(ka):
    """Complex factor on the acceleration of exp(i omega t) that gives the force per rho V on a circular cylinder.

    MacCamy and Fuchs (1954): outgoing waves are H1(2) here, so F = -4i / (pi (ka)^2 H1(2)'(ka)); it lags and goes to 2.
    """
    x = np.maximum(np.asarray(ka, float), 1e-6)
    j, y = jvp(1, x), yvp(1, x)
    return 4.0 * (y - 1j * j) / (np.pi * x**2 * (j * j + y * y))


class WaveModel(ReferenceModel):
    """A platform in `waves`: strips and loads of the reference model, in moving water.

    maccamy_fuchs: upright circular columns through still water take `diffraction` in place of 1 + Ca in the exciting
      force (a member's own `maccamy_fuchs: false` keeps it out); diffraction_phase False takes its modulus only, and
      diffraction_bound False leaves the bound waves' acceleration out there (both as OpenFAST).
    pontoon_ends: pressure also on both ends of every member that is not a column (closed and submerged).
    wetting "mean": strips wet as in the undisplaced platform, without stretching only; else "displaced".
    fixed_directions: loads along the undisplaced platform's directions; displaced: which coordinates of the points
      where the water is sampled follow the platform (OpenFAST: "xy", with stretching "xyz").
    """

    def __init__(
        self,
        platform: dict,
        waves: Waves,
        strip: float = 0.5,
        pontoon_strip: float = 2.0,
        *,
        maccamy_fuchs: bool = False,
        diffraction_phase: bool = True,
        diffraction_bound: bool = True,
        pontoon_ends: bool = False,
        wetting: str = "displaced",
        fixed_directions: bool = False,
        displaced: str = "xyz",
    ):
        super().__init__(platform, strip, pontoon_strip)
        if wetting not in ("displaced", "mean") or (wetting == "mean" and waves.stretching):
            raise ValueError(f"wetting {wetting!r} with stretching {waves.stretching!r}")
        if waves.gravity != self.gravity:
            raise ValueError(f"the waves' gravity is {waves.gravity}, the platform's {self.gravity}")
        self.waves, self.fixed_directions = waves, fixed_directions
        self.stays = [axis for axis in range(3) if "xyz"[axis] not in displaced]
        self.mean = self.wetted(np.zeros(3), np.eye(3)) if wetting == "mean" else None
        if pontoon_ends:
            self._close([number for number, member in enumerate(self.members) if member["vectors"][4][2] < np.sqrt(0.5)])
        self._columns(maccamy_fuchs, diffraction_phase, diffraction_bound)
        n = np.arange(self.strips_count)
        self.place = np.concatenate([n, n, n.size + np.arange(self.end_push.size)])  # of each direction
        self.force_mass = self.direction_mass + np.concatenate([self.density * self.volume] * 2 + [0.0 * self.end_push])
        taken = np.isin(self.place, np.concatenate([np.zeros(0, int), *(where for _, where in self.factors)]))
        self.force_mass[taken] -= self.direction_mass[taken]

    def _columns(self, maccamy_fuchs, diffraction_phase, diffraction_bound):
        a, b, axis = (np.array([member["vectors"][i] for member in self.members]).reshape(-1, 3).T for i in (0, 1, 4))
        self.column = np.flatnonzero(axis[2] >= np.sqrt(0.5))
        self.column_ends = a[:, self.column], b[:, self.column]
        self.factors = []
        for member in np.flatnonzero((axis[2] >= UPRIGHT) & (a[2] < 0) & (b[2] > 0)) if maccamy_fuchs else ():
            if self.members[member]["circular"] and self.members[member]["maccamy_fuchs"]:
                factor = diffraction(self.waves.k * self.members[member]["sides"][0] / 2)
                factor = factor if diffraction_phase else np.abs(factor)
                factor = np.where(diffraction_bound | ~self.waves.bound, factor, 0.0)
                self.factors.append((factor, np.flatnonzero(self.strip_member == member)))

    def _close(self, numbers):
        """Adds the ends of members as places of pressure without added mass and drag."""
        for number in numbers:
            a, b, _, _, axis = self.members[number]["vectors"]
            w, h = self.members[number]["sides"]
            area = w * h * (np.pi / 4 if self.members[number]["circular"] else 1.0)
            self.end_node = np.hstack([self.end_node, a[:, None], b[:, None]])
            self.directions = np.hstack([self.directions, axis[:, None], axis[:, None]])
            self.end_push, self.end_member = np.append(self.end_push, [area, -area]), np.append(self.end_member, [number] * 2)
            self.direction_mass, self.direction_drag = (
                np.append(x, [0.0, 0.0]) for x in (self.direction_mass, self.direction_drag)
            )

    def levels(self, t, position, turn):
        """Surface (members,): a column's where its axis meets still water, within its length; else still water."""
        a, b = (position[:, None] + turn @ end for end in self.column_ends)
        share = np.clip(-a[2] / np.maximum(b[2] - a[2], 1e-9), 0.0, 1.0)
        found = np.zeros(len(self.members))
        if self.column.size:
            found[self.column] = self.waves.surface(t, *(a + share * (b - a))[:2])
        return found

    def fluid(self, t, position, turn, offset, share):
        """The reference model's, in waves."""
        ends = turn @ self.end_node
        if self.mean:
            offset, share, end_wet = turn @ self.mean[0], self.mean[1], self.end_node[2] < 0
        elif self.waves.stretching:
            level = self.levels(t, position, turn)
            offset, share = self.wetted(position, turn, level[self.strip_member])
            end_wet = position[2] + ends[2] < level[self.end_member]
        else:
            end_wet = position[2] + ends[2] < 0
        at = np.hstack([offset, ends])
        points = position[:, None] + at
        if self.stays:
            points[self.stays] = (turn.T @ at)[self.stays]
        wet = np.concatenate([share, end_wet])
        live = np.flatnonzero(wet)  # water is asked for at wet places only
        rank = np.cumsum(wet > 0) - 1
        factors = [(factor, rank[where[wet[where] > 0]]) for factor, where in self.factors]
        velocity, acceleration, pressure = np.zeros_like(at), np.zeros_like(at), np.zeros(wet.size)
        velocity[:, live], acceleration[:, live], pressure[live] = self.waves.kinematics(t, points[:, live], factors)
        along = self.directions if self.fixed_directions else turn @ self.directions
        flow = (along * velocity[:, self.place]).sum(axis=0)
        push = self.force_mass * (along * acceleration[:, self.place]).sum(axis=0)
        push[2 * self.strips_count :] += self.density * self.end_push * pressure[self.strips_count :]
        return at[:, self.place], along, wet[self.place], flow, push * wet[self.place]

    def wave_load(self, t, q=np.zeros(6)):
        """Force and moment (6,), about the reference point and earth axes, of the waves on the platform held at q (6,)."""
        y = state_of(q)
        turn = matrix_of(y[3:7])
        return self.balance(t, y)[1] - self.static_load(y[:3], turn, *self.wetted(y[:3], turn))


def march(model: ReferenceModel, q0, v0, step: float, duration: float, method: str = "ab4"):
    """Fixed steps, "rk4" or "ab4" (Adams-Bashforth of fourth order, three steps of Runge-Kutta first): t (n,), q (n, 6)."""
    if method == "rk4":
        return rk4(model, q0, v0, step, duration)
    if method != "ab4":
        raise ValueError(f"method {method!r}: have rk4, ab4")
    count = round(duration / step)
    states = np.empty((count + 1, 13))
    states[0] = state_of(q0, v0)
    rates = []
    for j in range(count):
        rates = [model.rate(j * step, states[j]), *rates[:3]]
        if j < 3:
            states[j + 1] = rk4_step(model, j * step, states[j], step, rates[0])
        else:
            states[j + 1] = states[j] + step / 24 * (55 * rates[0] - 59 * rates[1] + 37 * rates[2] - 9 * rates[3])
    return np.arange(count + 1) * step, motions_of(states)
