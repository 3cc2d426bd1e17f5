"""The plain NumPy waves against closed forms, the free surface's own conditions and OpenFAST; no package's code here."""

import ast
import gzip
import json
import sys
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import brentq
from wall_pressure import COEFFICIENTS, wall_coefficient

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from benchmarks import reference_waves
from benchmarks.reference_model import ReferenceModel, rk4, state_of
from benchmarks.reference_waves import WaveModel, Waves, diffraction, march, wavenumber

ROOT = Path(__file__).resolve().parents[2]
OPENFAST = ROOT.parent / "shared" / "reference" / "openfast"
needs_openfast = pytest.mark.skipif(not OPENFAST.exists(), reason=f"OpenFAST's runs are not at {OPENFAST}")
RHO, G, DEPTH = 1025.0, 9.81, 200.0
STANDARD = 9.80665  # physics.md's numbers
SEA = [[1.2, 0.5, 0.3, 0.4], [0.9, 0.62, -0.5, 1.9], [0.7, 0.62, 0.8, -2.0], [0.5, 0.8, 2.0, 0.7]]  # a, omega, to, phase


def column(d=1.0, draught=20.0, top=10.0, x=0.0, coefficients=None, **options):
    """One heavy column upright in the water; coefficients Ca_t, Ca_z, Cd_t, Cd_z are zero but for those given."""
    zero = dict.fromkeys(("Ca_t", "Ca_z", "Cd_t", "Cd_z"), 0.0)
    return {
        "water": {"density": RHO, "depth": DEPTH, "gravity": G},
        "rigid_body": {"mass": 1e6, "centre_of_mass": [0, 0, 0], "inertia": {"Ixx": 1e8, "Iyy": 1e8, "Izz": 1e8}},
        "members": [
            {"name": "c", "group": "column", "shape": "circ", "d": d, "rA": [x, 0, -draught], "rB": [x, 0, top]} | options
        ],
        "coefficients": {"column": zero | (coefficients or {})},
    }


def read(path) -> dict:
    """Columns of an OpenFAST table, a line of units or none."""
    with gzip.open(path, "rt") as file:
        names, *rows = (line.strip().split(",") for line in file)
    rows = rows[1:] if rows[0][0].startswith("(") else rows
    return dict(zip(names, np.array(rows, float).T))


def test_shares_nothing_with_the_packages():
    for node in ast.walk(ast.parse((ROOT / "benchmarks" / "reference_waves.py").read_text())):
        imported = (
            [alias.name for alias in node.names]
            if isinstance(node, ast.Import)
            else ([node.module or ""] if isinstance(node, ast.ImportFrom) else [])
        )
        assert not {module.split(".")[0] for module in imported} & {"jaxhydro", "calibration", "jax"}


def test_dispersion():
    for depth in (5.0, 30.0, 200.0, 4000.0):
        omega = np.array([0.02, 0.2, 0.6, 1.0, 3.0, 6.0])
        exact = [brentq(lambda k, w=w, h=depth: k * np.tanh(k * h) - w * w / G, 1e-9, 10.0, xtol=1e-15) for w in omega]
        assert_allclose(wavenumber(omega, depth, G), exact, rtol=1e-10)


# physics.md: elevations per a1 a2 (two components) and per a^2 (one)
PAIRS = [
    (10, 12, 200, 0.0341086, -0.0062597),
    (10, 12, 30, 0.0805185, -0.0495613),
    (8, 9, 200, 0.0563005, -0.0066768),
    (8, 9, 30, 0.0749829, -0.0299645),
]


@pytest.mark.parametrize("t1, t2, depth, plus, minus", PAIRS)
def test_pairs(t1, t2, depth, plus, minus):
    omega = 2 * np.pi / np.array([t1, t2])
    waves = Waves([2.0, 3.0], omega, 0.0, [0.3, 1.1], depth, STANDARD, order=2)
    for sign, value in ((1, plus), (-1, minus)):
        at = waves.bound & np.isclose(waves.omega, omega[0] + sign * omega[1])
        assert waves.elevation[at] / 6 == pytest.approx([value], rel=2e-5)
        assert waves.phase[at] == pytest.approx([0.3 + sign * 1.1])


def test_stokes_and_set_down():
    for depth, second, down in ((200.0, 0.0201284, None), (30.0, 0.0374631, -0.0029486)):
        waves = Waves(1.0, 2 * np.pi / 10, depth=depth, gravity=STANDARD, order=2)
        k, kh = waves.k[0], waves.k[0] * depth
        assert waves.elevation[1] == pytest.approx(second, rel=1e-5)
        assert waves.elevation[1] == pytest.approx(k / 4 * np.cosh(kh) * (2 + np.cosh(2 * kh)) / np.sinh(kh) ** 3)
        assert waves.elevation[2] == pytest.approx(-k / (2 * np.sinh(2 * kh)))
        assert down is None or waves.elevation[2] == pytest.approx(down, rel=2e-5)
        assert waves.potential[1] == pytest.approx(3 / 8 * waves.omega[0] / np.sinh(kh) ** 4 * np.cosh(2 * kh), abs=1e-12)
        assert waves.potential[2] == 0 and len(Waves(1.0, 0.6, order=2, set_down=False)) == 2
    banded = Waves([1, 1, 1], [0.4, 0.5, 0.9], order=2, set_down=False, sum_band=(0.85, 1.1), difference_band=(0, 0.45))
    assert_allclose(np.sort(banded.omega[banded.bound]), [0.1, 0.4, 0.9, 1.0])


@pytest.mark.parametrize("depth", [15.0, 60.0])
def test_second_order_meets_the_free_surface(depth):
    """Four waves, four headings: the exact conditions at the exact surface are met but for the third order."""
    rng = np.random.default_rng(3)
    places = rng.uniform(-200, 200, (60, 3))

    def residuals(scale, order):
        a, omega, heading, phase = np.array(SEA).T
        w = Waves(scale * a, omega, heading, phase, depth, G, order=order)
        worst = np.zeros(2)
        for x, y, t in places:
            theta = w.omega * t - w.kx * x - w.ky * y + w.phase
            cos, sin = np.cos(theta), np.sin(theta)
            eta = w.elevation @ cos
            cosh = w.potential * np.cosh(w.k * (eta + depth)) / np.cosh(w.k * depth)
            sinh = w.potential * np.sinh(w.k * (eta + depth)) / np.cosh(w.k * depth)
            u, v, up = (w.kx * cosh) @ cos, (w.ky * cosh) @ cos, -(w.k * sinh) @ sin
            rise = -(w.elevation * w.omega) @ sin
            slope = (w.elevation * np.array([w.kx, w.ky])) @ sin
            dynamic = G * eta - (w.omega * cosh) @ cos + 0.5 * (u * u + v * v + up * up)
            worst = np.maximum(worst, np.abs([rise + u * slope[0] + v * slope[1] - up, dynamic]))
        return worst

    first, second = (np.log2(residuals(0.02, order) / residuals(0.01, order)) for order in (1, 2))
    assert np.abs(first - 2).max() < 0.05 and np.abs(second - 3).max() < 0.05


def test_kinematics_are_derivatives():
    a, omega, heading, phase = np.array(SEA).T
    waves, h, t = Waves(a, omega, heading, phase, 40.0, G, order=2), 1e-4, 3.0
    at = np.array([[4.0, -30.0], [9.0, 2.0], [-3.0, -17.0]])

    def potential(t, points):
        theta = waves.angle(slice(None), t, *points[:2])
        cosh = np.cosh(waves.k[:, None] * (points[2] + 40.0)) / np.cosh(waves.k[:, None] * 40.0)
        return -waves.potential @ (cosh * np.sin(theta))

    velocity, acceleration, pressure = waves.kinematics(t, at)
    steps = h * np.eye(3)[:, :, None]
    assert_allclose(velocity, [(potential(t, at + s) - potential(t, at - s)) / (2 * h) for s in steps], atol=1e-7)
    assert_allclose(pressure, -(potential(t + h, at) - potential(t - h, at)) / (2 * h), atol=1e-6)
    rate = (waves.kinematics(t + h, at)[0] - waves.kinematics(t - h, at)[0]) / (2 * h)
    assert_allclose(acceleration, rate, atol=1e-7)


def test_chunks_of_components_add_up(monkeypatch):
    rng = np.random.default_rng(5)
    waves = Waves(0.1, np.linspace(0.3, 1.5, 30), 0.2, rng.uniform(0, 6, 30), order=2, stretching="wheeler")
    points, factors = rng.uniform(-20, 2, (3, 7)), [(diffraction(6.0 * waves.k), np.array([1, 4]))]
    whole = waves.kinematics(1.0, points, factors)
    monkeypatch.setattr(reference_waves, "CHUNK", 300)
    for in_chunks, at_once in zip(waves.kinematics(1.0, points, factors), whole):
        assert_allclose(in_chunks, at_once, atol=1e-12)


def test_stretching_profiles():
    a, omega, depth, z = 2.0, 0.6, 50.0, np.array([-50.0, -10.0, 0.0, 1.0, 2.0])
    k = wavenumber(omega, depth, G)
    points = np.stack([0 * z, 0 * z, z])

    def along(stretching, t=0.0):  # t = 0 is the crest
        return Waves(a, omega, depth=depth, gravity=G, stretching=stretching).kinematics(t, points)[0][0]

    unit = a * omega / np.sinh(k * depth)
    assert_allclose(along(None), along("vertical"))
    assert_allclose(along("vertical"), unit * np.cosh(k * (np.minimum(z, 0) + depth)), rtol=1e-12)
    assert_allclose(along("wheeler"), unit * np.cosh(k * depth * (z + depth) / (a + depth)), rtol=1e-12)
    linear = np.cosh(k * (np.minimum(z, 0) + depth)) + np.maximum(z, 0) * k * np.sinh(k * depth)
    assert_allclose(along("extrapolation"), unit * linear, rtol=1e-12)


@pytest.mark.parametrize("stretching", [None, "vertical", "wheeler", "extrapolation"])
def test_drag_up_to_the_crest(stretching):
    """1/2 rho Cd D times the integral of u^2 up to the surface (still water without stretching), deep water."""
    a, omega, draught = 3.0, 0.8, 20.0
    k = omega**2 / G
    model = WaveModel(column(coefficients={"Cd_t": 1.2}), Waves(a, omega, gravity=G, depth=DEPTH, stretching=stretching), 0.13)
    squares = {None: (1 - np.exp(-2 * k * draught)) / (2 * k)}
    squares["vertical"] = squares[None] + a
    squares["extrapolation"] = squares[None] + ((1 + k * a) ** 3 - 1) / (3 * k)
    m = k * DEPTH / (DEPTH + a)
    squares["wheeler"] = (1 - np.exp(-2 * m * (draught + a))) / (2 * m)
    assert model.wave_load(0.0)[0] == pytest.approx(0.5 * RHO * 1.2 * (a * omega) ** 2 * squares[stretching], rel=1e-4)


def test_small_cylinder_in_a_long_wave():
    """rho V (1 + Ca) du/dt along x, p A + rho Ca 2/3 pi r^3 dw/dt along z; with the water's velocity no drag."""
    values = {"Ca_t": 0.9, "Ca_z": 0.4, "Cd_t": 1.0, "Cd_z": 2.0}
    waves = Waves(0.5, 0.02, depth=DEPTH, gravity=G, phase=-1.0)
    platform, area = column(coefficients=values), np.pi / 4
    model = WaveModel(platform, waves, 0.5)
    still = ReferenceModel(platform, 0.5)
    u, du, p = waves.kinematics(7.0, np.array([[0.0, 0.0], [0.0, 0.0], [-10.0, -20.0]]))
    y = state_of(np.zeros(6), [u[0, 0], 0, u[2, 1], 0, 0, 0])
    load = model.balance(7.0, y)[1] - still.balance(0.0, state_of(np.zeros(6)))[1]
    assert load[0] == pytest.approx(RHO * 20 * area * 1.9 * du[0, 0], rel=1e-4)
    assert load[4] == pytest.approx(load[0] * -10, rel=1e-3)
    assert load[2] == pytest.approx(RHO * (p[1] * area + 0.4 * 2 / 3 * np.pi / 8 * du[2, 1]), rel=1e-9)


def test_headings_turn_the_load():
    values = {"Ca_t": 0.9, "Ca_z": 0.4, "Cd_t": 1.0, "Cd_z": 2.0}
    a, omega, heading, phase = np.array(SEA).T
    for options in ({}, {"order": 2, "stretching": "vertical"}):
        loads = []
        for turn in (0.0, 1.1):
            waves = Waves(a, omega, heading + turn, phase, DEPTH, G, **options)
            loads.append(WaveModel(column(d=9.0, coefficients=values), waves, maccamy_fuchs=True).wave_load(4.0).reshape(2, 3))
        c, s = np.cos(1.1), np.sin(1.1)
        assert_allclose(loads[1], loads[0] @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]), rtol=1e-9, atol=1e-3)


def test_diffraction_factor():
    ka, modulus, lag = np.array(COEFFICIENTS).T
    factor = diffraction(ka)
    assert_allclose(np.abs(factor), modulus, atol=6e-6)
    assert_allclose(-np.degrees(np.angle(factor)), lag, atol=6e-4)
    assert diffraction(0.0) == pytest.approx(2.0, abs=1e-9)
    assert_allclose(factor, [wall_coefficient(x)[0] for x in ka], rtol=1e-10)


def test_diffraction_force():
    """A column's force in one wave, its integral over depth in closed form; moduli only; a bound wave by its own k."""
    d, omega, draught, t = 12.5, 1.0, 20.0, np.linspace(0.0, 12.0, 25)
    platform, k = column(d=d, x=7.0, coefficients={"Ca_t": 1.5}), wavenumber(omega, DEPTH, G)
    waves = Waves(0.8, omega, phase=0.4, depth=DEPTH, gravity=G)
    depth_sum = (np.sinh(k * DEPTH) - np.sinh(k * (DEPTH - draught))) / (k * np.cosh(k * DEPTH))
    unit = RHO * np.pi * d**2 / 4 * 1j * G * 0.8 * k * np.exp(1j * (omega * t - k * 7.0 + 0.4)) * depth_sum
    for phase, factor in ((True, diffraction(k * d / 2)), (False, np.abs(diffraction(k * d / 2)))):
        model = WaveModel(platform, waves, 0.5, maccamy_fuchs=True, diffraction_phase=phase)
        load = [model.wave_load(time)[0] for time in t]
        assert_allclose(load, (factor * unit).real, atol=1e-3 * np.abs(unit).max())
    plain = WaveModel(column(d=d, x=7.0, coefficients={"Ca_t": 1.5}, maccamy_fuchs=False), waves, 0.5, maccamy_fuchs=True)
    assert_allclose([plain.wave_load(time)[0] for time in t], (2.5 * unit).real, atol=2e-3 * np.abs(unit).max())
    pair = Waves([0.8, 0.8], [0.9, 1.1], depth=30.0, gravity=G, order=2)
    every_wave, first = (
        WaveModel(platform, pair, 1.0, maccamy_fuchs=True, diffraction_bound=bound_too) for bound_too in (True, False)
    )
    lone = WaveModel(platform, Waves([0.8, 0.8], [0.9, 1.1], depth=30.0, gravity=G), 1.0, maccamy_fuchs=True)
    assert first.wave_load(2.0)[0] == pytest.approx(lone.wave_load(2.0)[0])
    assert_allclose(every_wave.factors[0][0], diffraction(np.hypot(pair.kx, pair.ky) * d / 2))
    assert abs(every_wave.wave_load(2.0)[0] - first.wave_load(2.0)[0]) > 1e-3 * np.abs(unit).max()


def test_no_waves_is_still_water_and_the_order_of_the_steps():
    values = {"Ca_t": 0.9, "Ca_z": 0.4, "Cd_t": 1.0, "Cd_z": 2.0}
    platform = column(d=8.0, coefficients=values) | {"linear_damping": {"B33": 1e5}}
    q0, v0 = np.array([0, 0, 0.4, 0.02, 0.03, 0]), np.array([0.1, 0, 0.2, 0, 0.01, 0])
    flat = Waves(0.0, 0.6, depth=DEPTH, gravity=G, order=2, stretching="vertical")
    _, calm = rk4(ReferenceModel(platform, 1.0), q0, v0, 0.1, 3.0)
    for method, atol in (("rk4", 1e-13), ("ab4", 3e-5)):
        assert_allclose(march(WaveModel(platform, flat, 1.0), q0, v0, 0.1, 3.0, method)[1], calm, atol=atol)
    smooth = WaveModel(
        column(d=8.0, coefficients={"Ca_t": 0.9, "Ca_z": 0.4}),
        Waves([0.5, 0.4], [0.7, 1.2], 0.3, depth=DEPTH, gravity=G),
        1.0,
        wetting="mean",
        displaced="xy",
    )
    exact = march(smooth, q0, v0, 0.0125, 4.0, "rk4")[1][-1]
    for method in ("rk4", "ab4"):
        coarse, half = (np.abs(march(smooth, q0, v0, step, 4.0, method)[1][-1] - exact).max() for step in (0.1, 0.05))
        assert 11 < coarse / half < 22, method
    with pytest.raises(ValueError, match="method"):
        march(smooth, q0, v0, 0.1, 1.0, "heun")


def test_wrong_options_are_refused():
    with pytest.raises(ValueError, match="stretching"):
        Waves(1.0, 0.6, stretching="stokes")
    with pytest.raises(ValueError, match="wetting"):
        WaveModel(column(), Waves(1.0, 0.6, gravity=G, stretching="wheeler"), wetting="mean")
    with pytest.raises(ValueError, match="gravity"):
        WaveModel(column(), Waves(1.0, 0.6, gravity=9.7))


# ---- OpenFAST v5: its sea states, a fixed hull, a free hull


@needs_openfast
@pytest.mark.parametrize("name", ["reg", "comp"])
@pytest.mark.parametrize("order", [1, 2])
def test_sea_state_against_openfast(name, order):
    omega, amplitude, phase, k = np.loadtxt(
        OPENFAST / "seastate" / f"{name}_components.csv", delimiter=",", skiprows=1, ndmin=2
    ).T
    waves = Waves(amplitude, omega, 0.0, np.radians(phase), DEPTH, G, order=order, set_down=False)
    assert_allclose(waves.k[~waves.bound], k, rtol=1e-9)
    for x in (0.0, 50.0):
        table = {key: values[::40] for key, values in read(OPENFAST / "seastate" / f"{name}_o{order}_x{x:.0f}.csv.gz").items()}
        points = np.array([[x] * 5, [0.0] * 5, [0.0, -5.0, -10.0, -20.0, -50.0]])
        rows = [waves.kinematics(t, points) for t in table["Time"]]
        velocity, acceleration, pressure = (np.array(part) for part in zip(*rows))
        series_by_channel = {"Wave1Elev": np.array([waves.surface(t, x, 0.0)[0] for t in table["Time"]])}
        for j in range(5):
            series_by_channel |= {
                f"FVel{j + 1}xi": velocity[:, 0, j],
                f"FVel{j + 1}zi": velocity[:, 2, j],
                f"FAcc{j + 1}xi": acceleration[:, 0, j],
                f"FAcc{j + 1}zi": acceleration[:, 2, j],
                f"FDynP{j + 1}": RHO * pressure[:, j],
            }
        for key, series in series_by_channel.items():
            assert np.abs(series - table[key]).max() < 1e-5 * np.abs(table[key]).max(), key


def volturnus(setup) -> dict:
    """OpenFAST's strips; only the outer columns diffract (it takes one diameter)."""
    round_, around = {"group": "column", "shape": "circ"}, {"heading": [60, 180, 300]}
    return {
        "water": {"density": RHO, "depth": DEPTH, "gravity": G},
        "rigid_body": {
            "mass": setup["mass"],
            "centre_of_mass": [0, 0, setup["zcg"]],
            "inertia": {key: setup[key] for key in ("Ixx", "Iyy", "Izz")},
        },
        "members": [
            round_ | {"name": "centre", "d": 10.0, "rA": [0, 0, -20], "rB": [0, 0, 15], "maccamy_fuchs": False},
            round_ | around | {"name": "outer", "d": 12.5, "rA": [51.75, 0, -20], "rB": [51.75, 0, 15]},
            around
            | {
                "name": "pontoon",
                "group": "pontoon",
                "shape": "rect",
                "d": [12.5, 7.0],
                "rA": [3.778677, 0, -16.5],
                "rB": [46.721323, 0, -16.5],
            },
        ],
        "coefficients": {
            "column": {"Ca_t": 1.5, "Ca_z": 0.12, "Cd_t": 2.09, "Cd_z": 2.23},
            "pontoon": {"Ca_t": 0.11, "Ca_z": 1.87, "Cd_t": 1.84, "Cd_z": 4.96},
        },
        "linear_damping": {"B11": 4.4e4, "B22": 4.4e4, "B33": 1.6e5, "B44": 3.63e8, "B55": 3.63e8},
        "mooring": {"kind": "stiffness_matrix", "stiffness": setup["AddCLin"], "preload": [0, 0, setup["AddF0"][2], 0, 0, 0]},
    }


AS_OPENFAST = {"pontoon_ends": True, "diffraction_phase": False, "diffraction_bound": False, "fixed_directions": True}
CASES = {
    "c1": ({}, {}),
    "c2": ({"order": 2}, {}),
    "c1mcf": ({}, {"maccamy_fuchs": True}),
    "c1st": ({"stretching": "vertical"}, {}),
    "c3": ({"order": 2, "stretching": "vertical"}, {"maccamy_fuchs": True}),
}


def openfast(kind, case, **changes):
    """One run's table, static vertical force, and the model with the same waves."""
    folder = OPENFAST / f"{kind}_comp_{case}"
    setup, table = json.loads((folder / "setup.json").read_text()), read(folder / "out.csv.gz")
    _, omega, _, amplitude, phase = np.loadtxt(folder / "components.csv.gz", delimiter=",", skiprows=2).T
    waves = Waves(amplitude, omega, 0.0, phase, DEPTH, G, set_down=False, **CASES[case][0])
    placed = {"displaced": "xyz"} if waves.stretching else {"displaced": "xy", "wetting": "mean"}
    model = WaveModel(volturnus(setup), waves, 2.5, 4.3, **AS_OPENFAST | placed | CASES[case][1] | changes)
    return table, RHO * G * model.geometry_hydrostatics()["displaced_volume"] + setup["AddF0"][2], model


@needs_openfast
@pytest.mark.parametrize("case", CASES)
def test_fixed_hull_against_openfast(case):
    """Total loads within half a per cent of their deviation; what is left is nodes against strips (fine strips on both
    sides: 0.03 %)."""
    table, static, model = openfast("fixed", case)
    loads = np.array([model.wave_load(t) for t in table["Time"][::8]])
    loads[:, 2] += static
    for dof, channel in ((0, "HydroFxi"), (2, "HydroFzi"), (4, "HydroMyi")):
        series = table[channel][::8]
        share = np.sqrt(((loads[:, dof] - series) ** 2).mean()) / series.std()
        print(f"{case} {channel}: {100 * share:.2f} %")
        assert share < 5e-3, channel


@needs_openfast
def test_the_phase_of_diffraction_matters():
    """With it, surge forces differ from OpenFAST's, which has none, by several per cent."""
    table, _, model = openfast("fixed", "c1mcf", diffraction_phase=True)
    series = table["HydroFxi"][::20]
    surge = [model.wave_load(t)[0] for t in table["Time"][::20]]
    assert 0.05 < np.sqrt(((surge - series) ** 2).mean()) / series.std() < 0.09


@pytest.mark.slow
@needs_openfast
@pytest.mark.parametrize("case", ["c1", "c2", "c3"])
def test_free_hull_against_openfast(case):
    """600 s from rest. Case c3's mean surge, a small difference of large terms, is 2 % higher here (1 % with fine strips)."""
    table, _, model = openfast("free", case)
    t, q = march(model, np.zeros(6), np.zeros(6), 0.2, 600.0)
    assert_allclose(table["Time"][::2][[0, 1, -1]], t[[0, 1, -1]])
    limits = (0.04, 0.004, 0.01) if case == "c3" else (0.004, 0.004, 0.006)
    for (dof, channel, unit), limit in zip(((0, "Surge", 1), (2, "Heave", 1), (4, "Pitch", 180 / np.pi)), limits):
        series = table["Ptfm" + channel][::2]
        share = np.sqrt(((q[:, dof] * unit - series) ** 2).mean()) / series.std()
        print(f"{case} {channel}: {100 * share:.2f} %")
        assert share < limit, channel
