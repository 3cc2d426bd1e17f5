"""The plain NumPy reference model against closed forms and conservation laws; it knows nothing of the package."""

import ast
import copy
import sys
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from ruamel.yaml import YAML
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from benchmarks import make_demo_campaign as demo
from benchmarks.reference_model import ReferenceModel, matrix_of, motions_of, state_of

ROOT = Path(__file__).resolve().parents[2]
RHO, G = 1025.0, 9.80665
RADII, XY = (
    np.array([5.0, 6.25, 6.25, 6.25]),
    np.array([[0.0, 0.0], *(51.75 * np.array([np.cos(a), np.sin(a)]) for a in np.deg2rad([60, 180, 300]))]),
)
AREAS, PONTOONS = np.pi * RADII**2, 3 * 40.5 * 12.5 * 7.0
VOLUME = 20 * AREAS.sum() + PONTOONS
MASS_OF_ENDS = RHO * 2 / 3 * np.pi * (RADII**3).sum()
NO_LOADS = {group: dict.fromkeys(("Ca_t", "Ca_z", "Cd_t", "Cd_z"), 0.0) for group in ("column", "pontoon")}


def platform(**changes):
    """The demo platform; keyword arguments replace its top-level keys."""
    return copy.deepcopy(YAML(typ="safe").load(demo.PLATFORM) | changes)


def model_of(**changes):
    return ReferenceModel(platform(**{"mooring": {"kind": "none"}, "linear_damping": {}, **changes}))


def coefficients(**values):
    """All zero but those given as column_Ca_t=..."""
    groups = copy.deepcopy(NO_LOADS)
    for name, value in values.items():
        group, key = name.split("_", 1)
        groups[group][key] = value
    return groups


def static(model, q):
    y = state_of(q)
    turn = matrix_of(y[3:7])
    return model.static_load(y[:3], turn, *model.wetted(y[:3], turn))


def stiffness(model, dof, h=1e-4):
    q = np.zeros(6)
    q[dof] = h
    return -(static(model, q) - static(model, -q))[dof] / (2 * h)


def states(model, y0, times):
    return solve_ivp(model.rate, (0.0, times[-1]), y0, method="DOP853", t_eval=times, rtol=1e-11, atol=1e-11).y.T


def test_shares_nothing_with_the_packages():
    for name in ("reference_model.py", "make_demo_campaign.py"):
        for node in ast.walk(ast.parse((ROOT / "benchmarks" / name).read_text())):
            imported = (
                [alias.name for alias in node.names]
                if isinstance(node, ast.Import)
                else ([node.module or ""] if isinstance(node, ast.ImportFrom) else [])
            )
            assert not {module.split(".")[0] for module in imported} & {"jaxhydro", "calibration", "jax"}


def test_angles():
    q = np.array([1.0, 2.0, 3.0, 0.2, -0.3, 0.4])
    assert_allclose(motions_of(state_of(q)[None])[0], q, rtol=1e-13)
    assert matrix_of(state_of([0, 0, 0, 0, 0.1, 0])[3:7])[0, 2] == pytest.approx(np.sin(0.1))  # leans to +x
    turn = Rotation.from_euler("xyz", q[3:]).as_matrix()  # extrinsic: Rz Ry Rx
    assert_allclose(matrix_of(state_of(q)[3:7]), turn, atol=1e-14)


def test_hydrostatics_closed_form():
    model = model_of()
    hydrostatics = model.geometry_hydrostatics()
    z_b = (20 * AREAS.sum() * -10 + PONTOONS * -16.5) / VOLUME
    assert hydrostatics["displaced_volume"] == pytest.approx(VOLUME, rel=1e-12)
    assert hydrostatics["C33"] == pytest.approx(RHO * G * AREAS.sum(), rel=1e-12)
    for k, dof, name in ((1, 3, "C44"), (0, 4, "C55")):
        buoyancy = RHO * G * ((AREAS * XY[:, k] ** 2 + np.pi * RADII**4 / 4).sum() + VOLUME * z_b)
        assert hydrostatics[name + "_buoyancy"] == pytest.approx(buoyancy, rel=1e-12)
        assert hydrostatics[name] == pytest.approx(buoyancy + demo.MASS * G * 2.4, rel=1e-12)
        assert stiffness(model, dof) == pytest.approx(hydrostatics[name], rel=1e-6)  # of the moment itself
    assert stiffness(model, 2) == pytest.approx(hydrostatics["C33"], rel=1e-9)


def test_inclined_and_rectangular_waterplanes():
    members = [
        {"name": "leg", "group": "column", "shape": "circ", "d": 6.0, "rA": [10, 2, -20], "rB": [20, 4, 12]},
        {"name": "box", "group": "column", "shape": "rect", "d": [8.0, 5.0], "rA": [-9, 0, -15], "rB": [-9, 1, 9]},
    ]
    model = model_of(
        members=members, rigid_body={"mass": 1e5, "centre_of_mass": [0, 0, -5], "inertia": {"Ixx": 1e9, "Iyy": 1e9, "Izz": 1e9}}
    )
    hydrostatics = model.geometry_hydrostatics()
    weight = np.array([0, 0, RHO * G * hydrostatics["displaced_volume"] - 1e5 * G])
    for dof, name in ((2, "C33"), (3, "C44"), (4, "C55")):
        assert stiffness(model, dof) == pytest.approx(hydrostatics[name], rel=1e-6)
    assert_allclose(static(model, np.zeros(6))[:3], weight, atol=1e-6)


def test_declared_hydrostatics():
    declared = {"displaced_volume": 20206.0, "C33": 4.453e6, "C44_buoyancy": 2.194e9}
    model = model_of(hydrostatics=declared)
    weight = demo.MASS * G
    assert static(model, np.zeros(6))[2] == pytest.approx(RHO * G * 20206.0 - weight)
    assert stiffness(model, 2) == pytest.approx(4.453e6, rel=1e-9)
    assert stiffness(model, 3) == pytest.approx(2.194e9 + weight * 2.4, rel=1e-6)
    own = model.geometry_hydrostatics()
    lift = RHO * G * (20206.0 - VOLUME) * own["centre_of_buoyancy"][2]
    assert stiffness(model, 4) == pytest.approx(own["C55"] + lift, rel=1e-6)
    total = model_of(hydrostatics={"C55": 2.5e9})
    assert stiffness(total, 4) == pytest.approx(2.5e9, rel=1e-6)


def test_mooring():
    springs = platform()["mooring"]
    model, free = model_of(mooring=springs), model_of()
    span = 242.0
    horizontal = 1.5 * (45000.0 + 1.5e6 / span)
    assert stiffness(model, 0) == pytest.approx(horizontal, rel=1e-5)
    assert stiffness(model, 2) - stiffness(free, 2) == pytest.approx(3 * 1.5e6 / span, rel=1e-5)
    assert stiffness(model, 5) == pytest.approx(3 * 1.5e6 * 58.0 * 300.0 / span, rel=1e-5)
    for line in springs["lines"]:  # the same springs said in another way
        length = np.linalg.norm(np.subtract(line["anchor"], line["fairlead"]))
        line["unstretched_length"] = length - line.pop("pretension") / line["stiffness"]
        line["axial_stiffness"] = line.pop("stiffness") * line["unstretched_length"]
    q = np.array([3.0, 1.0, 0.5, 0.02, 0.05, 0.1])
    assert_allclose(static(model_of(mooring=springs), q), static(model, q), rtol=1e-9)
    matrix, preload = np.diag([7e4, 7e4, 6e4, 2e8, 2e8, 1e8]), [1e4, 0, -6e6, 0, 0, 0]
    linear = model_of(mooring={"kind": "stiffness_matrix", "stiffness": matrix.tolist(), "preload": preload})
    assert_allclose(static(linear, q) - static(free, q), preload - matrix @ q, atol=1e-4)


def test_equilibrium_is_at_rest():
    body = platform()["rigid_body"] | {"centre_of_mass": [0.3, 0.1, -2.4]}
    model = ReferenceModel(platform(rigid_body=body))
    q = model.equilibrium()
    assert q[4] > 0.01 and q[3] < -0.003
    assert np.abs(model.rate(0.0, state_of(q))).max() < 1e-9
    assert np.abs(ReferenceModel(platform()).equilibrium()).max() < 1e-4  # by symmetry; fairleads are rounded


def test_heave_is_the_analytic_oscillator():
    """Vertical columns: exactly linear in heave without drag, and one quadratic equation with it."""
    model = model_of(coefficients=coefficients(pontoon_Ca_z=1.87, column_Ca_z=0.12))
    mass = demo.MASS + RHO * 1.87 * PONTOONS + 0.12 * MASS_OF_ENDS
    omega = np.sqrt(RHO * G * AREAS.sum() / mass)
    equilibrium = (demo.MASS / RHO - VOLUME) / AREAS.sum()
    t, q = model.decay([0, 0, 2.0, 0, 0, 0], duration=10 * 2 * np.pi / omega, tolerance=1e-11)
    assert_allclose(q[:, 2], 2.0 * np.cos(omega * t) - equilibrium, atol=1e-6)
    assert np.abs(np.delete(q, 2, axis=1)).max() < 1e-9

    model = model_of(
        linear_damping={"B33": 1.6e5},
        coefficients=coefficients(pontoon_Ca_z=1.87, column_Ca_z=0.12, pontoon_Cd_z=4.96, column_Cd_z=2.23),
    )
    drag = 0.5 * RHO * (4.96 * 3 * 40.5 * 12.5 + 2.23 * AREAS.sum())

    def oscillator(t, y):
        return [y[1], -(omega**2) * y[0] - (1.6e5 * y[1] + drag * abs(y[1]) * y[1]) / mass]

    t, q = model.decay([0, 0, 3.0, 0, 0, 0], duration=100.0, tolerance=1e-10)
    exact = solve_ivp(oscillator, (0, 100), [3.0, 0.0], method="DOP853", t_eval=t, rtol=1e-11, atol=1e-11).y[0]
    assert_allclose(q[:, 2] - q[0, 2] + 3.0, exact, atol=1e-6)


def test_surge_drag_by_hand():
    body = platform()["rigid_body"] | {"centre_of_mass": [0.0, 0.0, 0.0]}
    y, speed = state_of(np.zeros(6)), np.array([0.8, 0.0, 0.3])
    model = model_of(rigid_body=body, coefficients=coefficients(column_Cd_t=2.0, pontoon_Cd_t=1.5, pontoon_Cd_z=4.0))
    y[7:10] = speed
    force = (model.rate(0.0, y) - model.rate(0.0, state_of(np.zeros(6))))[7:10] * demo.MASS
    expected = np.zeros(3)
    expected[0] = -0.5 * RHO * 2.0 * 2 * RADII.sum() * 20 * 0.8**2
    for angle in np.deg2rad([60, 180, 300]):
        across = np.array([-np.sin(angle), np.cos(angle), 0.0])
        length = np.hypot(across @ speed, 0.3)
        expected -= 0.5 * RHO * 40.5 * length * (1.5 * 7.0 * (across @ speed) * across + [0, 0, 4.0 * 12.5 * 0.3])
    assert_allclose(force, expected, rtol=1e-9, atol=1e-3)


def test_equations_of_motion_by_momentum():
    """d/dt of linear and angular momentum about the earth's origin = loads, with finite differences of positions."""
    model = ReferenceModel(
        platform(
            coefficients=coefficients(column_Ca_t=1.5, column_Ca_z=0.4, pontoon_Ca_t=0.3, pontoon_Ca_z=1.9), linear_damping={}
        )
    )
    y0, h = state_of([3.0, 1.0, 0.6, 0.05, 0.1, 0.2], [0.5, -0.4, 0.3, 0.05, -0.04, 0.06]), 0.02
    track = [solve_ivp(model.rate, (0, end), y0, "DOP853", rtol=1e-12, atol=1e-12).y[:, -1] for end in (-h, 0, h)]

    def momentum(y):
        turn = matrix_of(y[3:7])
        arm = turn @ model.centre_of_mass
        linear = model.mass * (y[7:10] + np.cross(y[10:], arm))
        return np.hstack([linear, np.cross(y[:3] + arm, linear) + turn @ model.inertia @ turn.T @ y[10:]])

    turn = matrix_of(y0[3:7])
    offset, share = model.wetted(y0[:3], turn)
    load = model.static_load(y0[:3], turn, offset, share)
    load[3:] += np.cross(y0[:3], load[:3])
    body_points = np.hstack([turn.T @ offset, turn.T @ offset, model.end_node])
    before, at, after = (y[:3, None] + matrix_of(y[3:7]) @ body_points for y in track)
    wet = np.concatenate([share, share, at[2, 2 * share.size :] < 0])
    acceleration, along = (before - 2 * at + after) / h**2, turn @ model.directions
    force = -model.direction_mass * wet * (along * acceleration).sum(axis=0) * along
    load += np.hstack([force.sum(axis=1), np.cross(at.T, force.T).sum(axis=0)])
    rate = (momentum(track[2]) - momentum(track[0])) / (2 * h)
    scale = np.abs(load).reshape(2, 3).max(axis=1).repeat(3)
    assert_allclose(rate / scale, load / scale, atol=2e-5)


def test_energy_is_conserved():
    """All six motions, large, without added mass and damping: ten heave cycles with exact potential energies."""
    model = ReferenceModel(platform(coefficients=NO_LOADS, linear_damping={}))
    lines = platform()["mooring"]["lines"]

    def energy(y):
        turn, position = Rotation.from_quat(y[3:7]).as_matrix(), y[:3]
        arm = turn @ [0.0, 0.0, -2.4]
        speed = y[7:10] + np.cross(y[10:], arm)
        spin = turn.T @ y[10:]
        total = 0.5 * demo.MASS * speed @ speed + 0.5 * spin @ (np.array([4.42e10, 4.42e10, 2.40e10]) * spin)
        total += demo.MASS * G * (position + arm)[2]
        for line in lines:
            slack = np.linalg.norm(np.subtract(line["anchor"], line["fairlead"])) - 1.5e6 / 45000.0
            span = np.linalg.norm(line["anchor"] - position - turn @ line["fairlead"])
            total += 0.5 * 45000.0 * (span - slack) ** 2
        for (x, y_), radius, area in zip(XY, RADII, AREAS):  # -rho g times the integral of z, slanted top
            bottom, lean = (position + turn @ [x, y_, -20.0])[2], turn[2, 2]
            total += RHO * G * (area * bottom**2 / (2 * lean) + np.pi * radius**4 / 8 * (1 - lean**2) / lean)
        for x, y_ in XY[1:]:
            middle = (position + turn @ [x * 25.25 / 51.75, y_ * 25.25 / 51.75, -16.5])[2]
            total -= RHO * G * PONTOONS / 3 * middle
        return total

    start = state_of([8.0, 2.0, 2.5, 0.06, 0.1, 0.08], [0.0, 0.2, 0.0, 0.0, 0.0, 0.005])
    energies = np.array([energy(y) for y in states(model, start, np.linspace(0.0, 130.0, 40))])
    swing = energy(start) - energy(state_of(model.equilibrium()))
    assert np.abs(energies - energies[0]).max() < 1e-7 * swing


def test_pitch_amplitude_is_kept_with_added_mass():
    masses_only = {group: values | {"Cd_t": 0.0, "Cd_z": 0.0} for group, values in demo.TRUE_COEFFICIENTS.items()}
    model = ReferenceModel(platform(coefficients=masses_only, linear_damping={}))
    t, q = model.decay([0, 0, 0, 0, np.deg2rad(3.0), 0], duration=300.0, tolerance=1e-9)
    early, late = np.ptp(q[t < 150.0][:, [0, 4]], axis=0), np.ptp(q[t > 150.0][:, [0, 4]], axis=0)
    assert_allclose(late, early, rtol=0.01)  # both halves hold cycles of both modes


def test_rk4_is_of_fourth_order():
    model = ReferenceModel(
        platform(coefficients=coefficients(pontoon_Ca_z=1.87, pontoon_Ca_t=0.1), linear_damping=demo.TRUE_DAMPING),
        strip=5.0,
        pontoon_strip=10.0,
    )
    offset = [4.0, 1.0, 1.0, 0.02, 0.05, 0.03]
    exact = model.decay(offset, duration=48.0, dt=4.0, tolerance=1e-13)[1]
    errors = [
        np.abs(model.decay(offset, duration=48.0, dt=4.0, method="rk4", step=step)[1] - exact).max() for step in (2.0, 1.0, 0.5)
    ]
    assert 12 < errors[0] / errors[1] < 22 and 12 < errors[1] / errors[2] < 22
    with pytest.raises(ValueError, match="whole number"):
        model.decay(offset, method="rk4", dt=0.2, step=0.15)


@pytest.mark.slow
def test_strips_and_tolerance_are_fine_enough():
    offset, velocity = demo.release("pitch", 2, 0)
    _, q = demo.true_model().decay(offset, velocity, duration=120.0, tolerance=1e-8)
    _, better = demo.true_model().decay(offset, velocity, duration=120.0, method="rk4", step=0.1)
    unit = np.array([1, 1, 1, *[180 / np.pi] * 3])
    assert (np.abs(q - better) * unit).max() < 2e-5
    finer = ReferenceModel(platform(coefficients=demo.TRUE_COEFFICIENTS, linear_damping=demo.TRUE_DAMPING), 0.25, 1.0)
    _, finer = finer.decay(offset, velocity, duration=120.0, tolerance=1e-8)
    assert (np.abs(q - finer) * unit).max() < 5e-3


def test_what_is_not_modelled_is_refused():
    for changes in ({"added_mass": {"A44": 20.0}}, {"rigid_body": {"parts": []}}):
        with pytest.raises(NotImplementedError):
            ReferenceModel(platform(**changes))


@pytest.mark.slow
def test_shipped_campaign_is_what_the_script_makes(tmp_path):
    made = demo.make_campaign(tmp_path, seed=1)
    assert {path.name for path in made} == {path.name for path in demo.FOLDER.iterdir()}
    manifest = YAML(typ="safe").load(demo.FOLDER / "campaign.yaml")
    for test in manifest["tests"]:
        new, shipped = (np.loadtxt(folder / test["file"], delimiter=",", skiprows=1) for folder in (tmp_path, demo.FOLDER))
        assert_allclose(new, shipped, atol=1e-4)
        clean = demo.clean_motion(test["degree_of_freedom"], int(test["id"][-1]) - 1, demo.RELEASE_SEED)[1]
        assert_allclose((shipped[:, 1:] - clean).std(axis=0), list(manifest["noise"].values()), rtol=0.1)
    assert (tmp_path / "platform.yaml").read_text() == (demo.FOLDER / "platform.yaml").read_text()
