"""The tank of synthetic campaigns against the reference models, its files against the contract, its effects."""

import ast
import sys
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from ruamel.yaml import YAML

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
from benchmarks import tank, tank_effects
from benchmarks.reference_model import ReferenceModel
from benchmarks.reference_waves import WaveModel, Waves, march
from benchmarks.tank import CYCLE, UNITS, Sea, Setup, Spec, Tank, make_campaigns, release, simulate

ROOT = Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared" / "campaigns" / "nothing-missing"
IN_PLANE = [0, 2, 4]
SEED = 3


def read(path) -> dict:
    return YAML(typ="safe").load(Path(path))


def true_platform(setup) -> dict:
    """The platform file with the true values of a setup without effects."""
    platform, errors = YAML(typ="safe").load(tank.PLATFORM), setup.truth["errors"]
    platform["coefficients"] = {group: setup.truth[group] for group in ("column", "pontoon")}
    platform["linear_damping"] = setup.truth["damping"]
    platform["rigid_body"]["mass"] *= errors["mass"]
    platform["rigid_body"]["inertia"]["Iyy"] *= errors["inertia"]
    for line in platform["mooring"]["lines"]:
        line["stiffness"] *= errors["line_stiffness"]
        line["pretension"] *= errors["pretension"]
    return platform


@pytest.fixture
def short(monkeypatch):
    """Short tests for a while."""
    monkeypatch.setattr(tank, "DURATIONS", {"surge": 150.0, "heave": 60.0, "pitch": 80.0, "sea": 160.0})


@pytest.mark.parametrize("name", ["tank.py", "tank_effects.py"])
def test_shares_nothing_with_the_packages(name):
    for node in ast.walk(ast.parse((ROOT / "benchmarks" / name).read_text())):
        imported = (
            [alias.name for alias in node.names]
            if isinstance(node, ast.Import)
            else ([node.module or ""] if isinstance(node, ast.ImportFrom) else [])
        )
        assert not {module.split(".")[0] for module in imported} & {"jaxhydro", "calibration", "jax"}


@pytest.mark.parametrize("name", ["heave", "pitch"])
def test_decays_are_the_reference_models(name, monkeypatch):
    monkeypatch.setitem(tank.DURATIONS, name, 120.0)
    setup = Setup(Spec(seed=SEED))
    reference = ReferenceModel(true_platform(setup), 0.5, 2.0)
    offset, rates = np.zeros((2, 6))
    offset[IN_PLANE], rates[IN_PLANE] = release(SEED, name, 2)
    motion = reference.decay(offset, rates, 120.0, tank.STEP, tolerance=1e-6)[1][:, IN_PLANE]
    afloat = [0.0, Tank([setup], [(0, name, None, 0.0, 0.0)]).afloat[0], 0.0]
    record = simulate([setup], [f"{name}-3"])[0][f"{name}-3"]
    assert_allclose(record, (motion - afloat) * UNITS, atol=3e-3)


def test_waves_are_the_reference_models():
    setup, bins, amplitude = Setup(Spec(seed=SEED)), np.array([120, 164]), np.array([0.9 + 0.3j, -0.4 + 0.8j])
    omega = 2 * np.pi / CYCLE * bins
    free = np.abs(amplitude), omega, 0.0, np.angle(amplitude)
    waves = Waves(*free, order=2, set_down=False, stretching="vertical")
    sea = Sea(bins, amplitude)
    made = Tank([setup], [(0, "", sea, 3.0, 9.0)])
    points = np.array([[-50.3, -10.0, 5.5, 24.0], [0.0] * 4, [-19.0, -0.7, -5.0, 0.4]])
    v, a, p = waves.kinematics(31.4, points)
    flow = made.water.flow(made.water.at(31.4)[1], np.array([0]), points[[0]], points[[2]])[0]
    assert_allclose(flow[:, :5], np.stack([v[0], v[2], a[0], a[2], p], axis=1), atol=2e-3)
    level = sea.series(sea.elevation(points[0]), np.array([31.4]))[0]
    assert_allclose(level, waves.surface(31.4, *points[:2]), atol=1e-12)
    y = made.at_rest()
    start = np.zeros(6)
    start[IN_PLANE] = y[0, :3]
    model = WaveModel(true_platform(setup), waves, 0.5, 2.0, maccamy_fuchs=True, pontoon_ends=True)
    motion = march(model, start, np.zeros(6), tank.STEP, 60.0)[1][:, IN_PLANE]
    difference = np.abs(made.march(y, 60.0)[0] - motion).max(axis=0)
    assert (difference < 0.01 * motion.std(axis=0)).all()


def test_rests_and_keeps_its_energy():
    zero = {
        "column": dict(Ca_t=1.2, Ca_z=0.3, Cd_t=0.0, Cd_z=0.0),
        "pontoon": dict(Ca_t=0.3, Ca_z=1.8, Cd_t=0.0, Cd_z=0.0),
        "damping": dict(B11=0.0, B33=0.0, B55=0.0),
    }
    conservative = [None, "hidden_oscillator", "nonlinear_hydrostatics", "parametric_pitch", "mooring_nonlinearity", "end_stop"]
    tanks = [Setup(Spec(effect=effect, strength=1, coefficients=zero, seed=SEED)) for effect in conservative]
    for setup in tanks:
        for k, (name, variant, p) in enumerate(setup.effects):
            setup.effects[k] = name, variant, p | ({"damping": 0.0} if name == "hidden_oscillator" else {})
    all_tanks = Tank(tanks, [(c, "heave", None, 0.0, 0.0) for c in range(len(tanks))])
    y = all_tanks.at_rest()
    assert np.abs(all_tanks.rate(0.0, y)[:, 3:6]).max() < 1e-10
    y[:, 1] += 3.0
    heave = all_tanks.march(y, 200.0)[..., 1] - all_tanks.equilibrium[:, None, 1]
    crests = [x[1:-1][(x[1:-1] > x[:-2]) & (x[1:-1] >= x[2:])] for x in heave]
    for crest in crests:  # a sample is at most 0.05 % below its crest
        assert len(crest) >= 9
        assert_allclose(crest, 3.0, rtol=2e-3)


@pytest.mark.slow
def test_campaigns_files(monkeypatch, tmp_path):
    monkeypatch.setattr(tank, "DURATIONS", {"surge": 24.0, "heave": 16.0, "pitch": 20.0, "sea": 30.0})
    specs = [
        Spec(tmp_path / "null", None, 2, SEED),
        Spec(tmp_path / "two", ["umbilical", "coulomb_friction:pitch"], 2, SEED),
        Spec(tmp_path / "other", "umbilical", 3, SEED),
        Spec(tmp_path / "lag", "sensor_lag", 3, SEED),
    ]
    assert len(specs) <= tank.BATCH
    truths = make_campaigns(specs)
    manifest = read(tmp_path / "null" / "campaign.yaml")
    assert sorted(path.name for path in (tmp_path / "null").iterdir()) == sorted(
        ["campaign.yaml", "platform.yaml", *(test["file"] for test in manifest["tests"])]
    )
    for test in manifest["tests"]:
        path = tmp_path / "null" / test["file"]
        sea = test["kind"] == "irregular"
        assert path.read_text().splitlines()[0] == "time_s,surge_m,heave_m,pitch_deg" + (",wave_m" if sea else "")
        table = np.genfromtxt(path, delimiter=",", skip_header=1)
        length = tank.DURATIONS["sea" if sea else test["degree_of_freedom"]]
        assert_allclose(table[:, 0], np.arange(round(length / 0.2) + 1) * 0.2, atol=1e-9)
        assert np.isfinite(table).all()
        assert table.shape[1] == 4 + sea
    first = {name: (tmp_path / name / "sea-1.csv").read_text().splitlines()[1:] for name in ("null", "two", "other", "lag")}
    waves = {name: [line.split(",")[-1] for line in lines] for name, lines in first.items()}
    assert waves["null"] == waves["two"] == waves["other"] != waves["lag"]
    surges = {name: [line.split(",")[1] for line in lines] for name, lines in first.items()}
    assert surges["null"] == surges["lag"] != surges["two"]
    assert all(truth["coefficients"] == truths[0]["coefficients"] for truth in truths)
    assert [effect["effect"] for effect in truths[1]["effects"]] == ["umbilical", "coulomb_friction"]
    names = [word for name in tank_effects.EFFECTS for word in (name, name.split("_")[0] + " ")]
    for path in (tmp_path / "two").iterdir():
        assert not any(name in path.read_text() for name in names)
    make_campaigns([Spec(tmp_path / "again", "umbilical", 3, SEED)])  # alone or among others
    for path in (tmp_path / "other").iterdir():
        assert path.read_bytes() == (tmp_path / "again" / path.name).read_bytes()


@pytest.mark.skipif(not SHARED.exists(), reason=f"no campaign at {SHARED}")
def test_looks_like_the_shared_campaigns(tmp_path):
    records = {}
    for name, length in tank.DURATIONS.items():
        for j in range(2 if name == "sea" else 3):
            records[f"{name}-{j + 1}"] = np.zeros((round(length / tank.STEP) + 1, 4 if name == "sea" else 3))
    tank.write(Setup(Spec(seed=101)), records, tmp_path)
    shared, ours = read(SHARED / "campaign.yaml"), read(tmp_path / "campaign.yaml")
    assert shared == ours
    assert read(SHARED / "platform.yaml") == read(tmp_path / "platform.yaml")
    for test in ours["tests"]:
        their_lines, our_lines = ((folder / test["file"]).read_text().splitlines() for folder in (SHARED, tmp_path))
        assert their_lines[0] == our_lines[0]
        assert [line.split(",")[0] for line in their_lines] == [line.split(",")[0] for line in our_lines]


# where the motion (or the wave channel) is another one with the effect at strength 2, and where it is the very same;
# "decays" are surge-2, heave-2, pitch-2, each in its own motion
CHANGES = {
    "umbilical": ("surge heave pitch_surge sea", "wave"),
    "coulomb_friction:surge": ("surge sea", "wave"),
    "coulomb_friction:pitch": ("pitch", "wave"),
    "hysteresis": ("surge sea", "wave"),
    "mooring_nonlinearity:cubic": ("surge", "wave"),
    "mooring_nonlinearity:odd_quadratic": ("surge", "wave"),
    "mooring_nonlinearity:quadratic": ("surge", "wave"),
    "radiation_memory:surge": ("sea", "wave"),
    "radiation_memory:heave": ("heave sea", "wave"),
    "radiation_memory:pitch": ("pitch", "wave"),
    "current": ("surge sea", "wave"),
    "amplitude_dependent_drag:power": ("surge heave pitch sea", "wave"),
    "amplitude_dependent_drag:inverse": ("surge heave pitch sea", "wave"),
    "sea_state_dependent_drag": ("surge sea", "wave"),
    "wave_drift": ("sea", "surge heave pitch wave"),
    "wave_drift_damping": ("sea", "surge heave pitch wave"),
    "hidden_oscillator:pitch": ("pitch", "wave"),
    "hidden_oscillator:surge": ("surge", "wave"),
    "nonlinear_hydrostatics": ("heave", "wave"),
    "coupled_damping": ("surge pitch", "wave"),
    "cubic_damping:surge": ("surge", "wave"),
    "cubic_damping:pitch": ("pitch", "wave"),
    "quadratic_damping:surge": ("surge", "wave"),
    "quadratic_damping:pitch": ("pitch", "wave"),
    "mass_properties:inertia": ("pitch", "wave"),
    "mass_properties:centre_of_mass": ("pitch", "wave"),
    "mass_properties:mass": ("heave sea", "wave"),
    "sensor_reference": ("surge pitch_surge", "pitch wave"),
    "sensor_lag": ("wave", "surge heave pitch sea"),
    "wave_gauge_position": ("wave", "surge heave pitch sea"),
    "wave_reflection:incident": ("sea", "surge heave pitch wave"),
    "wave_reflection:measured": ("sea wave", "surge heave pitch"),
    "static_offset:surge": ("surge", "wave"),
    "static_offset:pitch": ("pitch", "wave"),
    "stiffness_drift": ("surge", "wave"),
    "end_stop": ("surge", "wave"),
    "cogging": ("pitch_surge", "wave"),
    "parametric_pitch": ("pitch", "wave"),
}


def parts(records) -> dict:
    """Channels by the names in CHANGES, in units of the noise."""
    scaled = {name: records[f"{name}-2"][:, j] / tank.NOISE[name] for j, name in enumerate(tank.CHANNELS)}
    scaled["pitch_surge"] = records["pitch-2"][:, 0] / tank.NOISE["surge"]
    scaled["sea"] = records["sea-2"][:, :3] / [tank.NOISE[name] for name in tank.CHANNELS]
    return scaled | {"wave": records["sea-2"][:, 3] / tank.NOISE["wave"]}


@pytest.mark.slow
def test_every_effect_acts_where_it_should(short):
    effects = {
        f"{name}:{variant}" if variant else name for name, law in tank_effects.EFFECTS.items() for variant in law.variants()
    }
    assert effects == set(CHANGES)
    records = simulate(
        [Setup(Spec(effect=effect, strength=2, seed=SEED)) for effect in (None, *CHANGES)],
        ["surge-2", "heave-2", "pitch-2", "sea-2"],
    )
    null = parts(records[0])
    for (effect, (changed, same)), record in zip(CHANGES.items(), records[1:]):
        difference = {name: np.abs(series - null[name]).max() for name, series in parts(record).items()}
        for name in changed.split():
            assert difference[name] > 2.0, (effect, name, difference)
        for name in same.split():
            assert difference[name] == 0.0, (effect, name, difference)


def test_what_cannot_be_made():
    for effect, strength, word in (
        ("gravity_waves", 2, "have umbilical"),
        ("umbilical:big", 2, "no variant"),
        (["umbilical", "umbilical"], 1, "twice"),
        (None, 4, "strength"),
    ):
        with pytest.raises(ValueError, match=word):
            Setup(Spec(effect=effect, strength=strength))
