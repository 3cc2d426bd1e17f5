"""Computed radiation: readers, retardation function and its state space, the load; against closed forms and convolutions."""

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose
from scipy.integrate import quad
from scipy.optimize import brentq
from test_loads import BODY, COEFFICIENTS, COLUMN, build, model_of, only

import jaxhydro as jh
from calibration.discovery.effects.candidates import requested_table_labels, with_candidates
from calibration.discovery.effects.catalogue import catalogue
from calibration.discovery.effects.catalogue_builder import NoticeableScales
from jaxhydro.dynamics.statics import linearised, natural_modes
from jaxhydro.dynamics.time_steps import default_step, memory_step
from jaxhydro.errors import InputError
from jaxhydro.interop.capytaine_radiation import read_capytaine
from jaxhydro.interop.radiation_coefficients import RadiationCoefficients
from jaxhydro.interop.retardation import Damping, Realisation, realise
from jaxhydro.interop.wamit_radiation import read_wamit
from jaxhydro.loads import ComputedRadiation, RadiationMemory, Stiffness
from jaxhydro.platform.schema import load_platform
from jaxhydro.sweep.prepared_sweep import _platform_text

REFERENCE = Path(__file__).resolve().parents[3] / "shared" / "reference"
WAMIT = REFERENCE / "iea15-umaine" / "HydroData" / "IEA-15-240-RWT-UMaineSemi.1"

# the kernel exp(-p t) (1 + p t), even at t = 0, of transfer 1/(s + p) + p/(s + p)^2; less 2 p/(s + p)^3 p^2: nothing at s = 0
P = 0.5


def kernel(t: np.ndarray) -> np.ndarray:
    """exp(-p t) (1 + p t - (p t)^2): its integral over all time is 0, its slope at 0 too."""
    return np.exp(-P * t) * (1 + P * t - (P * t) ** 2)


def transfer(omega: np.ndarray) -> np.ndarray:
    """Its Fourier transform B + i omega (A - A of infinite frequency), closed."""
    s = 1j * omega + P
    return 1 / s + P / s**2 - 2 * P**2 / s**3


SHAPE = np.zeros((6, 6))  # N/m, N, N m/rad: surge and pitch coupled, heave alone; sway, roll and yaw do not radiate
SHAPE[0, 0], SHAPE[2, 2], SHAPE[4, 4] = 2e5, 1e5, 3e8
SHAPE[0, 4] = SHAPE[4, 0] = -4e6
OMEGA = np.arange(0.05, 12.01, 0.05)


def coefficients(omega: np.ndarray = OMEGA) -> RadiationCoefficients:
    """What a program would have computed for that kernel."""
    actual, infinite = transfer(omega), np.diag([1e7, 1e7, 2e7, 1e10, 1e10, 1e10])
    mass = infinite + (actual.imag / omega)[:, None, None] * SHAPE
    return RadiationCoefficients(omega, mass, actual.real[:, None, None] * SHAPE, infinite)


def test_the_closed_form_is_a_retardation_function() -> None:
    """By quad: the transform of the kernel is what the tests below take it for."""
    for w in (0.1, 0.5, 2.0):
        cosine, sine = (quad(kernel, 0, 80, weight=kind, wvar=w, limit=400)[0] for kind in ("cos", "sin"))
        assert_allclose(transfer(np.array(w)), cosine - 1j * sine, atol=1e-7)
    assert min(transfer(OMEGA).real) > 0


# retardation


def test_kernel_and_step_response() -> None:
    """2/pi int B cos and its integral against the kernel and its integral t exp(-p t) (1 + p t); cut off at 12 rad/s."""
    damping, time = Damping.of(coefficients()), np.linspace(0, 60, 241)
    step = time * np.exp(-P * time) * (1 + P * time)
    for actual, expected in ((damping.kernel(time), kernel(time)), (damping.step_response(time), step)):
        for i, j in ((0, 0), (2, 2), (4, 4), (0, 4)):
            assert_allclose(actual[:, i, j] / SHAPE[i, j], expected, atol=1e-3)


@pytest.mark.parametrize("last", [4.0, 12.0])
def test_a_state_space_has_the_kernel(last: float) -> None:
    """Of its own order, stable, passive; B as given, and A(omega) by Ogilvie's relation, which was not fitted."""
    given = coefficients(np.arange(0.05, last + 0.01, 0.05))
    space = realise(given, 0.001)
    assert space.misfit < 0.001 and space.order == 9  # three of heave, three by two of surge and pitch
    assert np.linalg.eigvals(space.rates).real.max() < 0 and space.least_damping > -0.01
    omega = np.array([0.01, 0.1, 0.3, 0.5, 1.0, 2.0])  # rad/s
    actual, expected = space.transfer(omega), transfer(omega)
    for i, j in ((0, 0), (2, 2), (4, 4), (0, 4), (4, 0)):
        peak = abs(SHAPE[i, j]) * np.abs(transfer(OMEGA)).max()
        assert_allclose(actual[:, i, j], SHAPE[i, j] * expected, atol=0.002 * peak)
    assert_allclose(space.transfer(np.zeros(1))[0], 0.0, atol=1e-9 * SHAPE.max())  # no force on what rests
    silent = [1, 3, 5]
    assert not np.abs(actual[:, silent]).any() and not np.abs(actual[:, :, silent]).any()


def test_tighter_tolerances_take_more_states_and_miss_less() -> None:
    loose, close = realise(coefficients(), 0.1), realise(coefficients(), 0.003)
    assert loose.order < close.order and close.misfit < 0.003 < loose.misfit < 0.1
    assert realise(coefficients(), 1e-9, order=4).order <= 4


def test_what_has_no_state_space_is_refused() -> None:
    given = coefficients()
    with pytest.raises(ValueError, match="no radiation damping"):
        realise(given._replace(damping=0 * given.damping))
    with pytest.raises(ValueError, match="stable and takes energy"):
        realise(given._replace(damping=-given.damping))


@pytest.mark.skipif(not WAMIT.is_file(), reason="../shared/reference has no iea15-umaine")
def test_volturnus_by_ogilvies_relation() -> None:
    """The published file's own added mass, which the state space never saw, below 1.2 rad/s: to 6 % of its largest
    departure from that at infinite frequency with 40 states, to 3 % with 60."""
    given = read_wamit(WAMIT, 1025.0)
    assert given.infinite is not None and given.zero is not None
    assert_allclose([given.infinite[0, 0], given.infinite[2, 2], given.infinite[4, 4]], [9.642e6, 2.482e7, 1.164e10], rtol=1e-3)
    assert_allclose([given.zero[0, 0], given.zero[0, 4]], [1.264e7, -1.202e8], rtol=1e-3)
    slow = given.omega < 1.2
    for order, close in ((40, 0.06), (60, 0.03)):
        space = realise(given, order=order)
        actual = space.transfer(given.omega)
        assert space.order <= order and space.misfit < 0.07 and space.least_damping > -0.01
        assert np.linalg.eigvals(space.rates).real.max() < -0.01
        for i in (0, 2, 4, 5):
            added = (given.added_mass - given.infinite)[:, i, i]
            assert np.abs(actual[slow, i, i].imag / given.omega[slow] - added[slow]).max() < close * np.abs(added).max()
            damping = given.damping[:, i, i]
            assert np.abs(actual[slow, i, i].real - damping[slow]).max() < 0.08 * damping.max()


# the load

M, C = 2e7, np.array([8e4, 0.0, 4e6, 2e9, 2e9, 0.0])


def platform(share: float = 1.0) -> jh.Model:
    """A mass on springs, its centre at the reference point, with the memory above."""
    springs = {f"C{i}{i}": C[i - 1] for i in (1, 3, 4, 5)}
    body = BODY | {"mass": M, "centre_of_mass": [0, 0, 0]}
    space = realise(coefficients(), 0.002)
    load = ComputedRadiation(*map(jnp.asarray, (space.rates, space.drive, space.output)), share)
    return model_of(build(COLUMN, rigid_body=body), Stiffness(springs), load)


def convolved(inertia: float, spring: float, size: float, start: float, times: np.ndarray) -> np.ndarray:
    """inertia x'' + int K(t - s) x'(s) ds + spring x = 0 from rest at `start`, by the trapezoidal rule on the closed kernel."""
    step = 0.05
    n = round(times[-1] / step) + 1
    memory = size * kernel(step * np.arange(n))
    x, v, a = np.zeros(n), np.zeros(n), np.zeros(n)
    x[0], a[0] = start, -spring * start / inertia
    below = inertia + 0.25 * step**2 * (2 * memory[0] + spring)
    for i in range(1, n):
        past = step * (memory[i:0:-1] @ v[:i] - 0.5 * memory[i] * v[0])
        half_v, whole_x = v[i - 1] + 0.5 * step * a[i - 1], x[i - 1] + step * v[i - 1] + 0.25 * step**2 * a[i - 1]
        a[i] = -(past + 0.5 * step * memory[0] * half_v + spring * whole_x) / below
        v[i], x[i] = half_v + 0.5 * step * a[i], whole_x + 0.25 * step**2 * a[i]
    return np.interp(times, step * np.arange(n), x)


def test_a_heave_decay_against_direct_convolution() -> None:
    """2 m released, at the default step: damped by memory alone, to 0.4 % of the release over eight periods."""
    times = np.linspace(0.0, 120.0, 481)
    motion = np.asarray(jh.free_decay(platform(), {"heave": 2.0}, times)["heave"])
    expected = convolved(M, C[2], SHAPE[2, 2], 2.0, times)
    assert np.abs(expected[times > 100]).max() < 1.7
    assert_allclose(motion, expected, atol=0.008)


def test_natural_periods_have_the_added_mass_of_their_own_frequency() -> None:
    """Heave: w^2 (M + (A(w) - A(infinity))) = C, by the closed transfer; not that of infinite frequency."""
    own = brentq(lambda w: w**2 * M + w * transfer(np.array(w)).imag * SHAPE[2, 2] - C[2], 0.2, 1.0)
    modes = natural_modes(platform(), jnp.zeros(6))
    assert modes.of("heave") == pytest.approx(2 * np.pi / own, rel=2e-4)
    assert abs(modes.of("heave") / (2 * np.pi * math.sqrt(M / C[2])) - 1) > 0.003
    without = natural_modes(platform(0.0), jnp.zeros(6))
    assert without.of("heave") == pytest.approx(2 * np.pi * math.sqrt(M / C[2]), rel=1e-9)


def test_retardation_of_the_memory_of_second_order() -> None:
    """Damping and added mass of its docstring."""
    b, w0, zeta, w = 3e5, 0.5, 0.3, 0.7
    load = RadiationMemory({"heave": b}, {"heave": w0}, {"heave": zeta})
    low = (w0**2 - w**2) ** 2 + (2 * zeta * w0 * w) ** 2
    expected = b * (2 * zeta * w0 * w) ** 2 / low + 1j * w * 2 * zeta * w0 * b * (w0**2 - w**2) / low
    actual = load.retardation(w)
    assert_allclose(actual[2, 2], expected, rtol=1e-12)
    assert np.abs(actual).sum() == pytest.approx(abs(expected))


@pytest.mark.slow
def test_steps_follow_the_fastest_memory() -> None:
    """Adams-Bashforth is stable at the default step in a sea and no more at four times it; halving the step changes little."""
    model = platform()
    fastest = np.abs(np.linalg.eigvals(np.asarray(model.loads[1].rates))).max()
    assert memory_step(model, "ab4") == pytest.approx(0.3 / fastest)
    assert default_step(model, "ab4") <= default_step(model) <= 1 / fastest + 1e-12
    assert memory_step(model_of(model, model.loads[0]), "ab4") == math.inf
    waves = jh.spectrum_components(lambda w: jh.jonswap(w, 3.0, 9.0), 120.0, model.environment, low=0.05, cutoff=0.2, seed=1)
    sea, times, start = jh.IrregularSea(waves, model.environment, order=1), np.linspace(0.0, 120.0, 241), {"heave": 1.0}
    actual, finer, coarse = (
        np.asarray(jh.simulate(model, times, sea, position=start, step=step)["heave"])
        for step in (None, 0.05, 4 * memory_step(model, "ab4"))
    )
    assert np.abs(actual - finer).max() < 2e-3
    assert not np.abs(coarse).max() < 10


@pytest.mark.slow
def test_gradients_by_the_share() -> None:
    """Forward = reverse = differences, of a decay; vmap over shares is a loop."""
    model, times = platform(), np.linspace(0.0, 30.0, 31)

    def motion(share, adjoint):
        with_share = model.with_values({"computed_radiation.share": share})
        state = jnp.array([0.5, 0.0, 1.0, 0.0, 0.02, 0.0])
        return jh.simulate(with_share, times, position=state, step=0.25, adjoint=adjoint).position

    def squared(share, adjoint="forward"):
        return (motion(share, adjoint) ** 2).sum()

    whole = jnp.asarray(1.0)
    forward = jax.jacfwd(squared)(whole)
    reverse = jax.grad(lambda share: squared(share, "reverse"))(whole)
    difference = (squared(1.01) - squared(0.99)) / 0.02
    assert_allclose([reverse, difference], [forward] * 2, rtol=1e-3)
    assert_allclose(reverse, forward, rtol=1e-9)


def test_power_is_taken() -> None:
    """Energy taken out since the start is never negative, of an irregular velocity in all motions."""
    model = only(platform(), ComputedRadiation)
    load, step, rng = model.loads[0], 0.05, np.random.default_rng(3)
    time = step * np.arange(4000)
    w, phase = rng.uniform(0.1, 1.5, (8, 1, 6)), rng.uniform(0, 2 * np.pi, (8, 1, 6))
    velocity = (np.sin(w * time[:, None] + phase).sum(axis=0) * [1, 1, 1, 0.02, 0.02, 0.02]) * (1 - np.exp(-time))[:, None]
    advance = np.asarray(jax.scipy.linalg.expm(load.rates * step))
    push = np.linalg.solve(np.asarray(load.rates), advance - np.eye(len(advance))) @ np.asarray(load.drive)
    memory, taken = np.zeros(len(advance)), []
    for v in velocity:
        taken.append(np.asarray(load.output) @ memory @ v * step)
        memory = advance @ memory + push @ v
    total = np.cumsum(taken)
    assert total.min() > -1e-3 * total.max() and total[-1] > 0


# readers


def wamit_text(given: RadiationCoefficients, length: float, density: float, drop: tuple[int, int] = (-1, -1)) -> str:
    """A `.1` file, zero rows left out, written from the definitions in the manual."""
    lines = [" WAMIT NUMHDR=1: title"]
    for period, mass, damping in [(-1.0, given.zero, None), (0.0, given.infinite, None)] + [
        (2 * math.pi / w, a, b) for w, a, b in zip(given.omega, given.added_mass, given.damping)
    ]:
        for i in range(6):
            for j in range(6):
                power = 3 + (i > 2) + (j > 2)
                if mass[i, j] and (i, j) != drop:
                    row = f"{period:.9E} {i + 1} {j + 1} {mass[i, j] / density / length**power:.9E}"
                    if damping is not None:
                        row += f" {damping[i, j] / density / length**power * period / (2 * math.pi):.9E}"
                    lines.append(row)
    return "\n".join(lines)


def test_wamit_files_are_made_dimensional(tmp_path: Path) -> None:
    given = coefficients(np.array([0.2, 0.5, 1.0, 2.0, 3.0]))
    given = given._replace(zero=1.2 * given.infinite)
    (file := tmp_path / "a.1").write_text(wamit_text(given, 12.5, 1010.0))
    for read, expected in zip(read_wamit(file, 1010.0, 12.5), given):
        assert_allclose(read, expected, rtol=1e-7, atol=1e-3)
    finite = [line for line in wamit_text(given, 1, 1).splitlines()[1:] if line[0] != "0"]
    (file := tmp_path / "b.1").write_text("\n".join(finite))
    assert read_wamit(file, 1.0).infinite is None


def rows(change: Callable[[list[str]], list[str]]) -> str:
    return "\n".join(change([f"{2.0 + k} 3 3 5.0 0.{k + 1}" for k in range(5)]))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (rows(lambda r: [*r[:3], "8.0 3 3 1.0", *r[3:]]), "line 4: expected 5 numbers PER I J A B, found 4"),
        (rows(lambda r: [*r, "0.0 7 1 1.0"]), "line 6: expected motions I and J of one body, 1 to 6, found 7 1"),
        (rows(lambda r: [*r, "0.0 1 x 1.0"]), "line 6: expected finite numbers PER I J A, found 'x'"),
        (rows(lambda r: [*r[:2], "9 3 3 nan 1", *r]), "line 3: expected finite numbers PER I J A B, found 'nan'"),
        (rows(lambda r: [*r, r[0]]), "line 6: expected each period and pair once, found period 2 s, 3 3 again"),
        (rows(lambda r: r[:3]), "expected added mass and damping at 4 periods or more, found 3"),
        ("", "4 periods or more, found 0"),
    ],
)
def test_broken_wamit_files_are_told(tmp_path: Path, text: str, words: str) -> None:
    (file := tmp_path / "a.1").write_text(text)
    with pytest.raises(InputError) as caught:
        read_wamit(file, 1025.0)
    assert str(caught.value).startswith(str(file)) and words in str(caught.value)
    with pytest.raises(InputError, match=r"expected a WAMIT .1 file, found no such file"):
        read_wamit(tmp_path / "none.1", 1025.0)


def dataset(given: RadiationCoefficients, names: list[str], dofs: list[int]) -> xr.Dataset:
    """As Capytaine's `assemble_dataset`: radiating before influenced motion, frequencies 0 and infinity among the others."""
    omega = np.concatenate([[np.inf], given.omega, [0.0]])
    mass = np.concatenate([given.infinite[None], given.added_mass, given.zero[None]])
    damping = np.concatenate([np.zeros((1, 6, 6)), given.damping, np.zeros((1, 6, 6))])
    dims = ("omega", "radiating_dof", "influenced_dof")
    pick = np.ix_(range(len(omega)), dofs, dofs)
    data = {"added_mass": (dims, mass.transpose(0, 2, 1)[pick]), "radiation_damping": (dims, damping.transpose(0, 2, 1)[pick])}
    return xr.Dataset(data, {"omega": omega, "radiating_dof": names, "influenced_dof": names, "rho": 1025.0, "g": 9.81})


def test_capytaine_datasets(tmp_path: Path) -> None:
    """Another order of motions, of frequencies, and a matrix that is not symmetric: force in i by motion in j."""
    given = coefficients(np.array([0.2, 0.5, 1.0, 2.0, 3.0]))
    given.added_mass[:, 0, 4] *= 2
    given = given._replace(zero=1.2 * given.infinite)
    file, names = tmp_path / "a.nc", ["Heave", "Surge", "Pitch"]
    made = dataset(given, names, [2, 0, 4])
    made.expand_dims("water_depth").to_netcdf(file)
    actual = read_capytaine(file)
    pick = np.ix_([0, 2, 4], [0, 2, 4])
    for read, expected in zip(actual[1:], given[1:]):
        assert_allclose(read[(..., *pick)], expected[(..., *pick)], rtol=1e-12)
    assert_allclose(actual.omega, given.omega)
    assert not actual.added_mass[:, 1].any() and not actual.added_mass[:, :, 3].any()
    made.drop_sel(omega=[0.0, np.inf]).to_netcdf(file)
    assert read_capytaine(file).infinite is None and read_capytaine(file).zero is None

    for broken, words in (
        (made.drop_vars("added_mass"), "added_mass: expected this variable, found"),
        (
            made.assign_coords(radiating_dof=["Heave", "Surge", "Pitsch"]),
            "radiating_dof: expected motions among Surge, Sway, Heave, Roll, Pitch, Yaw, found 'pitsch'. Did you mean 'pitch'?",
        ),
        (made.isel(omega=slice(1, 4)), "omega: expected 4 finite frequencies above 0 or more, found 3"),
        (made.where(~made.omega.isin([0.2, 0.5])), "omega: expected 4 finite frequencies above 0 or more, found 3"),
        (made.where((made.omega != 0.5) | (made.radiating_dof != "Heave")), "added_mass: expected finite numbers, found 3"),
        (made.isel(influenced_dof=0), "added_mass.influenced_dof: expected a dimension with names"),
        (made.assign_coords(omega=-made.omega), "omega: expected frequencies from 0 up, each once"),
        (xr.concat([made, made], "water_depth"), "added_mass.water_depth: expected one entry, found 2"),
    ):
        broken.to_netcdf(file)
        with pytest.raises(InputError) as caught:
            read_capytaine(file)
        assert words in str(caught.value)
    file.write_text("no NetCDF")
    with pytest.raises(InputError, match="expected a NetCDF file of Capytaine"):
        read_capytaine(file)
    with pytest.raises(InputError, match="found no such file"):
        read_capytaine(tmp_path / "none.nc")


# the platform file and the catalogue


def folder(path: Path, **keys: Any) -> Path:
    """A platform file beside the coefficients that it names."""
    given = coefficients(np.arange(0.05, 4.01, 0.05))
    given = given._replace(zero=given.infinite)
    (path / "hull.1").write_text(wamit_text(given, 2.0, 1025.0))
    dataset(given, ["Surge", "Heave", "Pitch"], [0, 2, 4]).to_netcdf(path / "hull.nc")
    springs = {f"C{i + 1}{i + 1}": float(c) for i, c in enumerate(C) if c}
    data = {
        "name": "rig",
        "water": {"density": 1025.0, "depth": 200.0},
        "rigid_body": BODY | {"mass": M},
        "members": [COLUMN],
        "coefficients": {"column": COEFFICIENTS},
        "stiffness": springs,
        "radiation": {"file": "hull.1", "length": 2.0} | keys,
    }
    (path / "platform.yaml").write_text(json.dumps(data))
    return path / "platform.yaml"


def test_a_platform_file_names_its_coefficients(tmp_path: Path) -> None:
    """Beside the file, wherever it is loaded from; both formats give one force; a candidate is at its neutral value."""
    models = [
        jh.load_model(folder(tmp_path, **keys))
        for keys in ({}, {"file": "hull.nc", "length": None}, {"use": "candidate", "order": 6, "tolerance": 0.2})
    ]
    loads = [next(load for load in model.loads if isinstance(load, ComputedRadiation)) for model in models]
    assert [float(model.values["computed_radiation.share"]) for model in models] == [1.0, 1.0, 0.0]
    assert loads[2].rates.shape[0] <= 6 < loads[0].rates.shape[0]
    omega = np.array([0.1, 0.5, 1.0])
    first, second = (Realisation(*map(np.asarray, (load.rates, load.drive, load.output)), 0.0, 0.0) for load in loads[:2])
    peak = np.abs(first.transfer(omega)).max(axis=0)
    assert_allclose(second.transfer(omega), first.transfer(omega), atol=1e-5 * peak.max(), rtol=1e-3)
    assert_allclose(first.transfer(omega)[:, 2, 2], transfer(omega) * SHAPE[2, 2], atol=0.03 * SHAPE[2, 2])


@pytest.mark.slow
def test_added_mass_of_the_file_takes_the_place_of_the_members_own(tmp_path: Path) -> None:
    """All, half or none of it; that of members goes with it. A file without it is refused where it is asked for."""

    def added(model: jh.Model) -> np.ndarray:
        return np.asarray(linearised(model, jnp.zeros(6))[0]) - np.asarray(model.body.mass_matrix())

    of_members, of_file = (jh.load_model(folder(tmp_path, added_mass=kind)) for kind in ("members", "file"))
    table = read_wamit(tmp_path / "hull.1", 1025.0, 2.0).infinite
    assert table is not None and np.abs(added(of_members) - table).max() > 0.1 * np.abs(table).max()
    small = {"atol": 1e-9 * np.abs(table).max()}
    assert_allclose(added(of_file), table, **small)
    half = of_file.with_values({"computed_added_mass.share": 0.5})
    assert_allclose(added(half), 0.5 * (table + added(of_members)), **small)
    candidate = jh.load_model(folder(tmp_path, use="candidate"))
    assert_allclose(added(candidate), added(of_members), **small)
    assert requested_table_labels(candidate) == {"computed_radiation.share", "computed_added_mass.share"}
    path = folder(tmp_path, added_mass="file")
    rows = (tmp_path / "hull.1").read_text().splitlines()
    (tmp_path / "hull.1").write_text("\n".join(row for row in rows if not row.lstrip().startswith("0.000000000E+00 ")))
    with pytest.raises(InputError, match=r"radiation\.added_mass: expected a file with added mass at infinite frequency"):
        jh.load_model(path)


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"file": "none.1"}, "none.1: expected a WAMIT .1 file, found no such file"),
        (
            {"file": "a.txt"},
            "format: expected wamit, capytaine or nemoh, as the file's ending is none of .1, .nc, .tec",
        ),
        ({"file": "hull.nc"}, "radiation.length: expected no length, as Capytaine's coefficients have dimensions, found 2.0"),
        ({"format": "aqwa"}, "radiation.format: expected"),
        ({"fiel": "a"}, "radiation.fiel: expected a known key"),
        ({"order": 3}, "radiation.order: expected enough states to follow the coefficients, found a misfit of"),
    ],
)
def test_wrong_declarations_are_told(tmp_path: Path, keys: dict, words: str) -> None:
    with pytest.raises(InputError) as caught:
        jh.load_model(folder(tmp_path, **keys))
    assert words in str(caught.value)


def test_a_declared_candidate_is_in_the_catalogue(tmp_path: Path) -> None:
    """Beside the lowest-order memory; not where the platform has it already. What was found is used without the catalogue."""
    scales = {"heave": NoticeableScales(1.0, 0.3, 1e5, 1e7)}
    for use, listed in (("candidate", True), ("load", False)):
        model = jh.load_model(folder(tmp_path, use=use))
        candidates, free, sizes = catalogue(model, scales, False, 1.0)
        names = [candidate.effect for candidate in candidates]
        assert "radiation_memory" in names and ("computed_radiation" in names) == listed == bool(requested_table_labels(model))
        if listed:
            candidate = candidates[names.index("computed_radiation")]
            assert (
                candidate.positive == candidate.amplitudes == ("computed_radiation.share",)
                and candidate.telling
                and candidate.source
            )
            assert free[candidate.amplitudes[0]].start == 0.0 and sizes[candidate.amplitudes[0]] > 0
            assert with_candidates(model, [candidate]) is model


def test_sweeps_find_the_coefficients_from_their_own_folder(tmp_path: Path) -> None:
    """The platform that a store keeps names the file where it is."""
    (elsewhere := tmp_path / "store").mkdir()
    (elsewhere / "platform.yaml").write_text(_platform_text(str(folder(tmp_path))))
    stored, declared = (load_platform(path / "platform.yaml").radiation for path in (elsewhere, tmp_path))
    assert stored == declared and Path(stored.file).is_file()
