"""The built-in tension-leg platform and monopile, against published stiffness and a beam on the published soil springs."""

import itertools

import jax.numpy as jnp
import numpy as np
import pytest
from scipy.linalg import eigh

import jaxhydro as jh
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.static_forces import mooring_stiffness
from jaxhydro.platform.schema import load_platform

# linearised tendons of the MIT/NREL TLP, N, N/m, N, N m: UserLine.f90 of FAST 8, "Use these values for the MIT/NREL TLP"
PULL, TENDONS = -30.69e6, {"C11": 197700.0, "C33": 79.09e6, "C44": 30.75e9, "C66": 144.1e6, "C15": -9.468e6}
# soil springs of OC3 phase II, kN/m2, every metre from the foot of the pile (-56 m) to the mudline: as in inputs of BModes
SOIL = """595318 1165208 1129400 1095553 1059931 1024493 989209 953643 918718 883287 847803 812541 777187 741870 706616 671440
636229 600957 565919 530470 495081 459574 385327 305479 280059 254125 227500 200112 171927 143115 114173 80184 52237 35561
20912 9000 1156"""
TOP, HEAD, FOOT = 87.6, -20.0, -56.0  # m: tower top, mudline, foot
CLAMPED = 0.2856  # Hz, fore-aft, clamped at the mudline, without water: pyBModes at 977b3d8, sample 02_nrel5mw_oc3monopile


@pytest.fixture(scope="module")
def tlp() -> Model:
    return jh.load_model("mit-nrel-tlp")


def test_tendons_are_the_published_ones(tlp: Model, recwarn: pytest.WarningsRecorder) -> None:
    """Weight of the tendons in water, which the published pull has, too, makes up 2 % of it."""
    assert not [remark.text for remark in tlp.remarks if remark.warning]  # taut vertical tendons are not slack
    stiffness = np.asarray(mooring_stiffness(tlp, jnp.zeros(6)))
    for key, value in TENDONS.items():
        assert stiffness[int(key[1]) - 1, int(key[2]) - 1] == pytest.approx(value, rel=0.005), key
    mooring = load_platform("mit-nrel-tlp").mooring
    tension = 1.5e9 * (152.11 / 151.73 - 1.0) + 0.5 * 151.73 * (116.027 - 1025 * np.pi / 4 * 0.127**2) * 9.80665
    assert mooring.kind == "catenary" and -8 * tension == pytest.approx(PULL, rel=0.002)


@pytest.mark.slow
def test_periods_follow_from_the_published_stiffness(tlp: Model) -> None:
    """Surge and yaw of the published matrix, and the heave of tendons and waterplane, with the added mass of strips.

    At the reference position, as the matrix. Masses of several sources leave 0.5 % of the buoyancy, which lifts it by 8 mm
    and tightens the tendons by 2 %.
    """
    modes = jh.natural_modes(tlp, jnp.zeros(6))
    mass, water = 8600410.0 + 347460.0 + 350000.0, 1025.0 * np.pi * 81.0
    across = 0.9 * water * 47.89
    yaw = 3.61408e8 + 2.24e6 + 2.616e7
    heave = mass + 0.64 * 1025.0 * 2 / 3 * np.pi * 9.0**3
    for dof, inertia, stiffness in (
        ("surge", mass + across, TENDONS["C11"]),
        ("heave", heave, TENDONS["C33"] + 9.80665 * water),
        ("yaw", yaw, TENDONS["C66"]),
    ):
        assert modes.of(dof) == pytest.approx(2 * np.pi * np.sqrt(inertia / stiffness), rel=0.01), dof
    assert modes.of("pitch") == pytest.approx(modes.of("roll"), rel=1e-3)  # the rotor's inertia is not the same in both


def section(z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Area (m2) and second moment (m4) of pile and tower at heights."""
    share = np.clip((z - 10.0) / 77.6, 0.0, 1.0)
    outer = np.where(z < 10.0, 6.0, 6.0 - 2.13 * share)
    inner = outer - 2 * np.where(z < 10.0, 0.06, 0.027 - 0.008 * share)
    return np.pi / 4 * (outer**2 - inner**2), np.pi / 64 * (outer**4 - inner**4)


def beam(z: np.ndarray, stiffer_above: float = 1.0, water: float = 1025.0) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and mass of pile, tower, soil, water and turbine: displacement and slope at every node.

    Euler-Bernoulli elements (Cook et al. 2002, Concepts and Applications of Finite Element Analysis, eq. 2.3-5, 11.3-6).
    """
    size, soil = 2 * len(z), np.array(SOIL.split(), float) * 1e3
    stiffness, mass = np.zeros((size, size)), np.zeros((size, size))
    for i, (low, high) in enumerate(itertools.pairwise(z)):
        length, middle = high - low, 0.5 * (low + high)
        area, second = section(np.array(middle))
        rigidity = 2.1e11 * second * (stiffer_above if middle > HEAD else 1.0)
        lateral = np.interp(middle, np.arange(FOOT, HEAD + 1), soil) if middle < HEAD else 0.0
        line = (8500.0 * area if middle > HEAD else 0.0) + (water * np.pi * 9 if HEAD < middle < 0 else 0.0)
        a, b = 6 * length, 2 * length**2
        bend = rigidity / length**3 * np.array([[12, a, -12, a], [a, 2 * b, -a, b], [-12, -a, 12, -a], [a, b, -a, 2 * b]])
        c, d, e = 22 * length, 13 * length, length**2
        spread = np.array([[156, c, 54, -d], [c, 4 * e, d, -3 * e], [54, d, 156, -c], [-d, -3 * e, -c, 4 * e]]) * length / 420
        part = slice(2 * i, 2 * i + 4)
        stiffness[part, part] += bend + lateral * spread
        mass[part, part] += line * spread
    turbine, arm = 350000.0, 89.55 - TOP
    mass[-2:, -2:] += [[turbine, turbine * arm], [turbine * arm, turbine * arm**2 + 2.616e7]]
    return stiffness, mass


def first_frequency(z: np.ndarray, stiffer_above: float = 1.0, clamped: bool = False) -> float:
    """First natural frequency (Hz)."""
    stiffness, mass = beam(z, stiffer_above, 0.0 if clamped else 1025.0)
    free = slice(2 if clamped else 0, None)
    massive = mass[free, free] + 1e-6 * np.eye(len(mass[free, free]))  # kg, kg m2: the embedded pile has no mass here
    return float(np.sqrt(eigh(stiffness[free, free], massive, eigvals_only=True)[0]) / (2 * np.pi))


def test_springs_of_the_monopile_are_the_condensed_soil_springs() -> None:
    z = np.linspace(FOOT, HEAD, 145)
    stiffness, _ = beam(z)
    inner, corner = stiffness[:-2, :-2], stiffness[:-2, -2:]
    head = stiffness[-2:, -2:] - corner.T @ np.linalg.solve(inner, corner)
    to_reference = np.array([[1.0, HEAD], [0.0, 1.0]])
    expected = to_reference.T @ head @ to_reference
    mooring = load_platform("oc3-monopile").mooring
    assert mooring.kind == "stiffness_matrix"
    matrix = mooring.matrix()
    assert matrix[np.ix_([0, 4], [0, 4])] == pytest.approx(expected, rel=1e-3)
    assert matrix[np.ix_([1, 3], [1, 3])] == pytest.approx(expected * [[1, -1], [-1, 1]], rel=1e-3)


NODES = np.concatenate([np.linspace(FOOT, HEAD, 37)[:-1], np.linspace(HEAD, TOP, 55)])


def test_bending_is_what_the_monopile_leaves_out() -> None:
    """The beam clamped at the mudline is the published one. On the soil it has half the frequency of a rigid one."""
    assert first_frequency(NODES[36:], clamped=True) == pytest.approx(CLAMPED, rel=0.025)
    assert first_frequency(NODES) / first_frequency(NODES, stiffer_above=1e4) == pytest.approx(0.49, abs=0.01)


@pytest.mark.slow
def test_period_of_the_monopile() -> None:
    own = jh.natural_modes(jh.load_model("oc3-monopile")).of("pitch")
    assert own * first_frequency(NODES, stiffer_above=1e4) == pytest.approx(1.0, abs=0.02)
