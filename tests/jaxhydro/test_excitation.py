"""Computed excitation: against sums over components, strips' own force, WAMIT's file format, and OpenFAST's own force."""

import dataclasses
import math
from pathlib import Path

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose
from one_program import complex_amplitude, one_program, vector
from scipy.signal import butter, freqs
from test_loads import COLUMN, PONTOON, RHO, G, build, model_of, only
from test_water_effects import HULL, WATER, acts, irregular, with_values
from typer.testing import CliRunner

import jaxhydro as jh
from calibration.campaign.load_campaign import load_campaign
from calibration.discovery.effects.candidates import requested_table_labels
from calibration.discovery.effects.catalogue import catalogue
from calibration.discovery.effects.catalogue_builder import NoticeableScales
from jaxhydro.cli import app as cli
from jaxhydro.errors import InputError
from jaxhydro.interop.wamit_excitation import read_excitation
from jaxhydro.loads import ComputedExcitation, EndInertia, StripInertia
from jaxhydro.sweep import load_sweep
from jaxhydro.sweep.prepared_sweep import _platform_text, prepared
from jaxhydro.water import WaveGaugePosition
from jaxhydro.waves import Clock
from jaxhydro.waves.excitation import Excitation

GRID = np.linspace(0.2, 2.2, 9)  # rad/s
SHARED = Path(__file__).resolve().parents[3] / "shared" / "reference"
WAMIT = SHARED / "iea15-umaine" / "HydroData" / "IEA-15-240-RWT-UMaineSemi.3"
RUN = SHARED / "openfast" / "ss1_nwt"
REST = np.zeros(6)
rotation = one_program(jh.rotations.rotation)
AWAY = np.array([7.0, -3.0, 1.0, 0.02, -0.03, 0.4])


def forces(seed: int = 5) -> np.ndarray:
    """X of six motions (N/m, N m/m)."""
    rng = np.random.default_rng(seed)
    return rng.normal(0, 2e6, (6, 9)) + 1j * rng.normal(0, 1e6, (6, 9))


def by_sum(sea: jh.IrregularSea, time: float, table: np.ndarray, position=(0.0, 0.0)) -> np.ndarray:
    """The sum over components, X by NumPy's straight lines."""
    waves = sea.components
    omega, along = np.asarray(waves.omega), np.asarray(vector(waves))
    amplitudes = np.asarray(complex_amplitude(waves)) * np.exp(1j * (omega * time - np.asarray(position) @ along))
    at = [np.interp(omega, GRID, x.real, 0, 0) + 1j * np.interp(omega, GRID, x.imag, 0, 0) for x in table]
    return (np.array(at) @ amplitudes).real


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("heading", [0.0, 0.7])
def test_the_force_is_the_sum_over_components(order: int, heading: float) -> None:
    """Direct, and prepared on a clock that starts late, where the platform is; bound waves add nothing to it."""
    sea, table = irregular(order, heading), forces()
    model = model_of(build(COLUMN), ComputedExcitation(Excitation.of(GRID, table), share=0.7))
    prepared = sea.prepared(HULL, None, Clock(10.0, 0.25, 400, (0.0,)), exciting=model.excitation)
    direct = sea.direct()
    for position in (REST, AWAY * [1, 1, 1, 0, 0, 0]):
        for time in (10.0, 36.5, 107.25):
            exact = 0.7 * by_sum(sea, time, table, position[:2])
            for met, error in ((prepared, 2e-5), (sea, 1e-9), (direct, 1e-9)):
                actual, _ = acts(model, position, REST, model.rest().memory, met, time)
                assert_allclose(actual, exact, atol=error * np.abs(exact).max())


@pytest.mark.slow
def test_it_takes_the_place_of_the_strips_own() -> None:
    """Share s: s of the table's, 1 - s of what acceleration and pressure do to strips and ends; added mass is as it was."""
    strips = only(build(COLUMN, PONTOON), StripInertia, EndInertia)
    table = ComputedExcitation(Excitation.of(GRID, forces()), 0.0)
    sea = irregular(2).direct()
    model = strips.with_effect(table)
    own, _ = acts(strips, AWAY, REST, (None,) * 2, sea, 20.0)
    turn = np.asarray(rotation(AWAY[3:]))
    earth = by_sum(irregular(), 20.0, forces(), AWAY[:2])
    table_force = np.concatenate([turn.T @ earth[:3], turn.T @ earth[3:]])
    for share in (0.0, 0.4, 1.0):
        actual, _ = acts(model.with_values({"computed_excitation.share": share}), AWAY, REST, model.rest().memory, sea, 20.0)
        assert_allclose(actual, (1 - share) * own + share * table_force, atol=1e-9 * np.abs(table_force).max())
    still = [
        np.asarray(model_alone.rate(jnp.zeros(()), model_alone.rest(), jh.StillWater()).velocity)
        for model_alone in (
            build(COLUMN, PONTOON),
            build(COLUMN, PONTOON).with_effect(ComputedExcitation(table.excitation, 1.0)),
        )
    ]
    assert_allclose(still[1], still[0], rtol=1e-12, atol=1e-12)


@pytest.mark.slow
def test_what_strips_do_in_small_waves_is_their_excitation() -> None:
    """X taken from the strips' own force in small regular waves: in a small irregular sea the table's force is theirs."""
    strips = only(build(COLUMN, PONTOON, wetting="mean"), StripInertia, EndInertia)
    omega, none = np.linspace(0.3, 1.3, 201), (None,) * 2
    table = np.zeros((6, omega.size), complex)
    for k, w in enumerate(omega):
        for phase in (0.0, -0.5 * math.pi):  # Re X, and Re (-i X)
            sea = jh.regular_wave(0.02, 2 * math.pi / w, WATER, phase=phase)
            actual, _ = acts(strips, REST, REST, none, sea, 0.0)
            table[:, k] += actual / 0.01 * (1.0 if phase == 0 else 1j)
    sea = irregular()
    own = [acts(strips, REST, REST, none, sea.direct(), t)[0] for t in (5.0, 41.3)]
    load = ComputedExcitation(Excitation.of(omega, table), 1.0)
    actual = [acts(model_of(strips, load), REST, REST, (load.rest(),), sea.direct(), t)[0] for t in (5.0, 41.3)]
    assert_allclose(actual, own, atol=2e-3 * np.abs(own).max())


def test_a_motion_in_the_waves_does_not_move_the_force() -> None:
    """It is of the place where the platform is without its fast displacement; with waves at the mean place, of that alone."""
    sea, table = irregular(), forces()
    model = model_of(build(COLUMN), ComputedExcitation(Excitation.of(GRID, table), 1.0))
    fast = (jnp.array([[2.0, 1.0], [0.0, 0.0]]),)
    actual, _ = acts(model, AWAY * [1, 1, 1, 0, 0, 0], REST, fast, sea, 36.5)
    assert_allclose(actual, by_sum(sea, 36.5, table, (5.0, -4.0)), rtol=1e-9)
    mean = dataclasses.replace(model, conventions=dataclasses.replace(model.conventions, waves_at="mean"))
    actual, _ = acts(mean, AWAY * [1, 1, 1, 0, 0, 0], REST, fast, sea, 36.5)
    assert_allclose(actual, by_sum(sea, 36.5, table), rtol=1e-9)


@pytest.mark.parametrize("period", [12.0, 50.0, 200.0])
def test_the_slow_displacement_is_that_behind_a_butterworth_filter(period: float) -> None:
    """Of second order, low-pass, by scipy; from the rates of the memory."""
    load = ComputedExcitation(Excitation.of(GRID, forces()), 1.0, corner=0.1)
    model, omega = model_of(build(COLUMN), load), 2 * math.pi / period

    def rates(velocity: float, memory: np.ndarray) -> np.ndarray:
        turning = AWAY * [0, 0, 0, 1, 1, 1]  # velocities are in body axes
        along = np.asarray(rotation(turning[3:])).T @ [velocity, 0.0, 0.0]
        rate = acts(model, turning, [*along, 0, 0, 0], (jnp.asarray(memory),), irregular(), 0.0)[1]
        return np.asarray(rate[0])[:, 0]

    states = np.eye(2)[:, :, None] * [1.0, 0.0]
    matrix, drive = np.stack([rates(0.0, state) for state in states], axis=1), rates(1.0, np.zeros((2, 2)))
    response = np.linalg.solve(1j * omega * np.eye(2) - matrix, drive * 1j * omega)[0]
    _, exact = freqs(*butter(2, 0.1, analog=True), worN=[omega])
    assert_allclose(1 - response, exact[0], rtol=1e-9)


def test_added_mass_does_not_follow_the_wetting() -> None:
    """With a computed force, added mass is that of the hull wet at rest. Without one it follows waves and heave."""
    sea, heaved = irregular().direct(), np.array([0.0, 0, -2.0, 0, 0, 0])
    load = ComputedExcitation(Excitation.of(GRID, forces()), 1.0)
    still, wet = (build(COLUMN, PONTOON, wetting=wetting) for wetting in ("mean", "instantaneous"))

    @eqx.filter_jit
    def of(model: jh.Model, position: jax.Array) -> jax.Array:
        state = jh.State(position, jnp.zeros(6), model.rest().memory)
        return model.sum_of_loads(model.instant(jnp.asarray(20.0), state, sea), state.memory).masses

    def masses(model: jh.Model, position: np.ndarray) -> np.ndarray:
        return np.asarray(of(model, jnp.asarray(position)))

    expected = masses(still, heaved)
    with_force = wet.with_effect(load)
    assert_allclose(masses(with_force, heaved), expected, rtol=1e-12)
    half = masses(with_force.with_values({"computed_excitation.share": 0.5}), heaved)
    moved = masses(wet, heaved)
    assert (np.abs(moved - expected) > 0.02 * expected)[expected > 0].any()
    assert (np.minimum(moved, expected) <= half + 1e-6).all() and (half <= np.maximum(moved, expected) + 1e-6).all()


def test_it_moves_with_the_waves() -> None:
    """Where the gauge stood 4 m further along, so does the force: every component by its own wavenumber."""
    sea, table = irregular(), forces()
    gauge = with_values(WaveGaugePosition(), distance=4.0)
    model = model_of(build(COLUMN), gauge, ComputedExcitation(Excitation.of(GRID, table), 1.0))
    prepared = sea.prepared(HULL, None, Clock(10.0, 0.25, 400, (0.0,)), exciting=model.excitation)
    exact = by_sum(sea, 36.5, table, (-4.0, 0.0))
    for met, error in ((prepared, 2e-5), (sea, 1e-9)):
        actual, _ = acts(model, REST, REST, model.rest().memory, met, 36.5)
        assert_allclose(actual, exact, atol=error * np.abs(exact).max())


def test_a_sea_without_it_is_refused() -> None:
    model = model_of(build(COLUMN), ComputedExcitation(Excitation.of(GRID, forces()), 1.0))
    bare = irregular().prepared(HULL, None, Clock(10.0, 0.25, 40, (0.0,)))
    with pytest.raises(ValueError, match=r"prepare it with `Model\.excitation`"):
        acts(model, REST, REST, model.rest().memory, bare, 12.0)
    with pytest.raises(ValueError, match="two loads"):
        assert model.with_effect(ComputedExcitation(Excitation.of(GRID, forces()), 1.0)).excitation is None
    with pytest.raises(ValueError, match="two ascending frequencies or more"):
        Excitation.of(GRID[::-1], forces())


@pytest.mark.slow
def test_a_simulation_follows_it() -> None:
    """Share 1 of a table that is zero leaves drag alone, and without that nothing; at share 0 nothing changes."""
    model = jh.load_model("volturnus-s-focal")
    model = model.with_values({label: 0.0 for label in model.values if ".Cd_" in label})
    waves = jh.spectrum_components(lambda w: jh.jonswap(w, 3.0, 9.0), 300.0, model.environment, low=0.06, cutoff=0.18, seed=1)
    sea, times = jh.IrregularSea(waves, model.environment), np.arange(0.0, 300.0, 1.0)
    silent = ComputedExcitation(Excitation.of(GRID, 0 * forces()), 1.0)
    heave = [
        np.asarray(jh.simulate(simulated, times, sea)["heave"])
        for simulated in (model, model.with_effect(silent), model.with_effect(ComputedExcitation(silent.excitation)))
    ]
    assert heave[1].std() < 1e-6 * heave[0].std()
    assert_allclose(heave[2], heave[0], rtol=1e-9, atol=1e-12)


# files


def rows_of(table: np.ndarray, heading: float = 0.0, modes=range(6)) -> list[list[float]]:
    """As WAMIT writes them."""
    return [
        [2 * math.pi / w, heading, i + 1, abs(x := table[i, k]), np.degrees(np.angle(x)), x.real, x.imag]
        for k, w in enumerate(GRID)
        for i in modes
    ]


def written(folder: Path, rows: list[list[float]], name: str = "a.3") -> Path:
    path = folder / name
    np.savetxt(path, np.array(rows), fmt="%.9e")
    return path


def test_a_file_is_read_with_its_units(tmp_path: Path) -> None:
    """rho g L^2 for forces, rho g L^3 for moments; one heading of two, and modes that are left out are none."""
    path = written(tmp_path, rows_of(forces(1)) + rows_of(forces(2), 30.0, (0, 2, 4)))
    unit = RHO * G * np.array([4.0, 4, 4, 8, 8, 8])[:, None]
    table = read_excitation(path, RHO, G, length=2.0)
    assert_allclose(table.omega, GRID, rtol=1e-8)
    assert_allclose(table.force, unit * forces(1), atol=1e-7 * np.abs(unit * forces(1)).max())
    few = np.asarray(read_excitation(path, RHO, G, length=2.0, heading=390.0).force)
    assert_allclose(few[4], (unit * forces(2))[4], atol=1e-7 * np.abs(unit * forces(2)).max())
    assert not few[[1, 3, 5]].any()
    between = np.asarray(one_program(Excitation.at)(table, np.array([0.5 * (GRID[3] + GRID[4]), 0.1, 2.3])))
    force = np.asarray(table.force)
    assert_allclose(between[:, 0], 0.5 * (force[:, 3] + force[:, 4]), rtol=1e-9)
    assert not between[:, 1:].any()


def test_broken_files_are_told(tmp_path: Path) -> None:
    rows = rows_of(forces())
    for path, words in (
        (tmp_path / "none.3", "expected a .3 file, found no such file"),
        (written(tmp_path, [row[:6] for row in rows], "b"), "expected rows of 7 numbers PER BETA I MOD PHASE RE IM, found 6"),
        (written(tmp_path, [[-1.0, *rows[0][1:]], *rows[1:]], "c"), "row 1: expected periods above 0"),
        (written(tmp_path, [*rows, [*rows[0][:2], 7, *rows[0][3:]]], "d"), "row 55: expected a mode from 1 to 6"),
        (written(tmp_path, rows[1:], "e"), "surge: expected each period once, found 0 times 31.416 s"),
        (written(tmp_path, [*rows, rows[8]], "f"), "heave: expected each period once, found 2 times 13.963 s"),
        (written(tmp_path, rows[:6], "g"), "PER: expected two periods or more, found 1"),
    ):
        with pytest.raises(InputError) as caught:
            read_excitation(path, RHO, G)
        assert words in str(caught.value) and str(caught.value).startswith(str(path))
    with pytest.raises(InputError, match="BETA: expected waves of heading 45 deg, found 0 deg"):
        read_excitation(written(tmp_path, rows), RHO, G, heading=45.0)


def test_a_platform_file_names_one(tmp_path: Path) -> None:
    """All of it, found beside the platform file, by a sweep's copy too; as a candidate at its neutral value, and scored."""
    written(tmp_path, rows_of(forces()), "hull.3")
    text = (Path(jh.__path__[0]) / "platforms" / "volturnus-s-focal.yaml").read_text(encoding="utf-8")
    path = tmp_path / "a.yaml"
    path.write_text(text + "\nexcitation: {file: hull.3}\n", encoding="utf-8")
    model = jh.load_model(path)
    assert float(model.values["computed_excitation.share"]) == 1.0 and model.excitation.force.shape == (6, 9)
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "platform.yaml").write_text(_platform_text(str(path)), encoding="utf-8")
    assert jh.load_model(tmp_path / "b" / "platform.yaml").excitation is not None
    written(tmp_path, rows_of(0.9 * forces()), "hull.3")  # another file of that name makes another sweep
    assert _platform_text(str(path)) != (tmp_path / "b" / "platform.yaml").read_text(encoding="utf-8")
    path.write_text(text + "\nexcitation: {file: hull.3, use: candidate}\n", encoding="utf-8")
    model = jh.load_model(path)
    assert requested_table_labels(model) == {"computed_excitation.share"}
    scales = {"surge": NoticeableScales(5.0, 0.1, 1e5, 2e7)}
    effects = {waves: [candidate.effect for candidate in catalogue(model, scales, waves, 1.0)[0]] for waves in (True, False)}
    assert "computed_excitation" in effects[True] and "computed_excitation" not in effects[False]
    np.savetxt(tmp_path / "hull.12d", [[p, q, 0, 0, 1, 1.0, 0, 1.0, 0] for p in (8.0, 12.0) for q in (8.0, 12.0) if p <= q])
    tables = "\nexcitation: {file: hull.3, use: candidate}\ndrift: {file: hull.12d, use: candidate}\n"
    path.write_text(text + tables, encoding="utf-8")
    by_effect = {candidate.effect: candidate for candidate in catalogue(jh.load_model(path), scales, True, 1.0)[0]}
    assert by_effect["potential_flow"].amplitudes == (
        *by_effect["computed_excitation"].amplitudes,
        *by_effect["drift_transfer"].amplitudes,
    )
    path.write_text(text + "\nexcitation: {file: none.3}\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"none\.3: expected a \.3 file, found no such file"):
        jh.load_model(path)


def test_seas_of_another_heading_are_refused(tmp_path: Path) -> None:
    """By simulations, sweeps and campaigns; a whole turn is no other heading."""
    written(tmp_path, rows_of(forces()), "hull.3")
    text = (Path(jh.__path__[0]) / "platforms" / "volturnus-s-focal.yaml").read_text(encoding="utf-8")
    (path := tmp_path / "a.yaml").write_text(text + "\nexcitation: {file: hull.3, heading: 360}\n", encoding="utf-8")
    platform = jh.load_platform(path)
    assert [platform.of_other_waves(heading) for heading in (0.0, -360.0, 30.0)] == [None, None, ("excitation.heading", 360.0)]
    for waves in (("--hs", "2", "--tp", "9"), ("--wave-height", "2", "--wave-period", "9")):
        words = ["simulate", str(path), *waves, "--heading", "30", "--out", str(tmp_path / "out")]
        result = CliRunner().invoke(cli.app, words)
        assert result.exit_code == 2 and "360 (excitation.heading of the platform file)" in result.output, result.output
    file = tmp_path / "sweep.yaml"
    file.write_text("platform: a.yaml\nscatter: [{hs: 2.0, tp: 9.0}]\nheadings: [0, 30]\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"excitation.heading: expected 30 deg, as in the sweep's headings, found 360 deg"):
        prepared(load_sweep(file), str(file))
    np.savetxt(tmp_path / "sea.csv", np.zeros((100, 3)), delimiter=",", header="t,x,w", comments="")
    tests = "".join(f"  - {{id: sea-{i}, kind: irregular, file: sea.csv, sea: {{heading: {i}}}}}\n" for i in (0, 30))
    (tmp_path / "campaign.yaml").write_text(
        "name: c\nplatform: a.yaml\nchannels: {time: {column: t, unit: s}, surge: {column: x, unit: m}}\n"
        f"wave_channel: {{column: w, unit: m}}\ntests:\n{tests}",
        encoding="utf-8",
    )
    words = r"tests\[1\]\.sea\.heading: expected 360 deg, the excitation\.heading of a\.yaml, found 30 deg"
    with pytest.raises(InputError, match=words) as error:
        load_campaign(tmp_path)
    assert len(error.value.problems) == 1


@pytest.mark.skipif(not WAMIT.exists() or not RUN.exists(), reason="../shared/reference has no iea15-umaine or no openfast")
def test_openfast_has_the_same_force() -> None:
    """Its first-order excitation of the IEA 15 MW's .3 file, in a sea of 1038 components, at the mean position."""
    excitation = read_excitation(WAMIT, 1025.0, 9.81)
    waves = pd.read_csv(RUN / "components.csv.gz", comment="#")
    record = pd.read_csv(RUN / "out.csv.gz", skiprows=[1])
    omega, time = waves.omega_rad_s.to_numpy(), record.Time.to_numpy(float)[::16]
    amplitude = waves.amp_m.to_numpy() * np.exp(1j * waves.phase_rad.to_numpy())
    x = np.asarray(one_program(Excitation.at)(excitation, omega))
    for i, channel in ((0, "B1WvsF1xi"), (2, "B1WvsF1zi"), (4, "B1WvsM1yi")):
        ours = (np.exp(1j * np.outer(time, omega)) @ (x[i] * amplitude)).real
        openfast = record[channel].to_numpy(float)[::16]
        assert np.std(ours - openfast) < 5e-4 * np.std(openfast)
