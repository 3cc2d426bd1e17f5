"""Difference-frequency transfer functions: against double sums, WAMIT's file format, and OpenFAST's own force."""

import math
from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose
from scipy.interpolate import RegularGridInterpolator
from test_loads import COLUMN, build, model_of
from test_water_effects import HULL, WATER, acts, irregular

import jaxhydro as jh
from calibration.discovery.effects.candidates import requested_table_labels
from calibration.discovery.effects.catalogue import catalogue
from calibration.discovery.effects.catalogue_builder import NoticeableScales
from jaxhydro.dynamics.statics import linearised
from jaxhydro.errors import InputError
from jaxhydro.interop.wamit_drift import COLUMNS, read_transfer
from jaxhydro.loads import DriftTransfer
from jaxhydro.sweep.prepared_sweep import _platform_text
from jaxhydro.waves.integration_clock import Clock
from jaxhydro.waves.quadratic_transfer import Transfer

GRID = np.linspace(0.2, 2.2, 9)  # rad/s
SHARED = Path(__file__).resolve().parents[3] / "shared" / "reference"
WAMIT = SHARED / "iea15-umaine" / "HydroData" / "IEA-15-240-RWT-UMaineSemi.12d"
RUN = SHARED / "openfast" / "ss1_nwt"


def table(seed: int = 5) -> np.ndarray:
    """A Hermitian table of six modes."""
    rng = np.random.default_rng(seed)
    values = rng.normal(0, 2e4, (6, 9, 9)) + 1j * rng.normal(0, 1e4, (6, 9, 9))
    return 0.5 * (values + np.conj(np.swapaxes(values, 1, 2)))


def by_pairs(sea: jh.IrregularSea, time: float, tables: np.ndarray) -> np.ndarray:
    """The double sum, T by SciPy's bilinear interpolation."""
    waves = sea.components
    amplitudes = np.asarray(waves.complex_amplitude()) * np.exp(1j * np.asarray(waves.omega) * time)
    omega = np.asarray(waves.omega)
    pairs = np.stack(np.meshgrid(omega, omega, indexing="ij"), axis=-1)
    parts = [RegularGridInterpolator((GRID, GRID), t, bounds_error=False, fill_value=0.0)(pairs) for t in tables]
    return np.array([(np.outer(amplitudes, amplitudes.conj()) * part).sum().real for part in parts])


@pytest.mark.parametrize("newman", [False, True])
def test_the_force_is_the_double_sum_over_pairs(newman: bool) -> None:
    """Direct, and prepared on a clock that starts late; Newman's from the diagonal alone."""
    sea, whole = irregular(), table()
    load = DriftTransfer(Transfer.of(GRID, whole, newman), share=0.7)
    if newman:
        curve = np.einsum("ikk->ik", whole).real
        whole = 0.5 * (curve[:, :, None] + curve[:, None, :])
    model = model_of(build(COLUMN), load)
    prepared = sea.prepared(HULL, None, Clock(10.0, 0.25, 400, (0.0,)), transfer=model.transfer)
    for time in (10.0, 36.5, 107.25):
        exact = 0.7 * by_pairs(sea, time, whole)
        for met in (prepared, sea, sea.direct()):
            actual, _ = acts(model, np.zeros(6), np.zeros(6), (None,), met, time)
            assert_allclose(actual, exact, atol=1e-8 * np.abs(exact).max())


def test_in_a_regular_wave_it_is_the_drift_curve() -> None:
    """T_kk a^2, and nothing at frequencies that the table has not."""
    whole = table()
    model = model_of(build(COLUMN), DriftTransfer(Transfer.of(GRID, whole), 1.0))
    for k, omega in enumerate(GRID):
        sea = jh.regular_wave(0.8, 2 * math.pi / omega, WATER, phase=0.4)
        actual, _ = acts(model, np.zeros(6), np.zeros(6), (None,), sea, 7.7)
        assert_allclose(actual, 0.4**2 * whole[:, k, k].real, rtol=1e-9)
    actual, _ = acts(model, np.zeros(6), np.zeros(6), (None,), jh.regular_wave(0.8, 2 * math.pi / 2.5, WATER), 7.7)
    assert not actual.any()


def test_a_sea_without_the_transfer_function_is_refused() -> None:
    model = model_of(build(COLUMN), DriftTransfer(Transfer.of(GRID, table()), 1.0))
    bare = irregular().prepared(HULL, None, Clock(10.0, 0.25, 40, (0.0,)))
    with pytest.raises(ValueError, match=r"prepare it with `Model\.transfer`"):
        acts(model, np.zeros(6), np.zeros(6), (None,), bare, 12.0)
    with pytest.raises(ValueError, match="two loads"):
        assert model.with_effect(DriftTransfer(Transfer.of(GRID, table()), 1.0)).transfer is None


@pytest.mark.slow
def test_a_simulation_drifts_by_it() -> None:
    """The slow surge of a platform on soft springs, share 1 against 0, is the force over the stiffness."""
    mean = np.zeros((6, 9, 9), complex)
    mean[0] = 3e4
    model = jh.load_model("volturnus-s-focal")
    waves = jh.spectrum_components(lambda w: jh.jonswap(w, 3.0, 9.0), 400.0, model.environment, low=0.06, cutoff=0.18, seed=1)
    sea, times = jh.IrregularSea(waves, model.environment), np.arange(0.0, 400.0, 1.0)
    load = DriftTransfer(Transfer.of(GRID, mean), 1.0)
    surge = [np.asarray(jh.simulate(simulated, times, sea)["surge"]) for simulated in (model, model.with_effect(load))]
    stiffness = float(np.asarray(linearised(model, jh.equilibrium(model))[1])[0, 0])
    expected = 3e4 * float((np.asarray(waves.amplitude) ** 2).sum()) / stiffness
    assert (surge[1] - surge[0])[200:].mean() == pytest.approx(expected, rel=0.15)


# files


def written(folder: Path, rows: list[list[float]], name: str = "a.12d") -> Path:
    path = folder / name
    np.savetxt(path, np.array(rows), fmt="%.9e")
    return path


def rows_of(whole: np.ndarray, heading: float = 0.0, modes=range(6)) -> list[list[float]]:
    """Half of a table, as WAMIT writes it: the longer period first."""
    rows = []
    for k, p in enumerate(2 * math.pi / GRID):
        for j, q in enumerate(2 * math.pi / GRID):
            if j >= k:
                rows += [
                    [p, q, heading, heading, i + 1, abs(t := whole[i, k, j]), np.degrees(np.angle(t)), t.real, t.imag]
                    for i in modes
                ]
    return rows


def dense(transfer: Transfer) -> np.ndarray:
    """T again at the frequencies of the table."""
    u = np.asarray(transfer.filters)
    return np.einsum("im,imk,iml->ikl", np.asarray(transfer.eigenvalue), u, u.conj())


def test_a_file_is_read_with_its_units(tmp_path: Path) -> None:
    """rho g L for forces, rho g L^2 for moments; one heading of two, and modes that are left out are none."""
    first, second = table(1), table(2)
    path = written(tmp_path, rows_of(first) + rows_of(second, 30.0, (0, 2, 4)))
    unit = 1025 * 9.81 * np.array([2.0, 2, 2, 4, 4, 4])[:, None, None]
    transfer = read_transfer(path, 1025.0, 9.81, length=2.0)
    assert_allclose(transfer.omega, GRID, rtol=1e-8)
    # eta = Re A exp(i omega t): the first period's amplitude is not the conjugate one
    assert_allclose(dense(transfer), unit * first, atol=1e-6 * np.abs(unit * first).max())
    few = dense(read_transfer(path, 1025.0, 9.81, length=2.0, heading=390.0))
    assert_allclose(few[4], (unit * second)[4], atol=1e-6 * np.abs(unit * second).max())
    assert not few[[1, 3, 5]].any()


def test_broken_files_are_told(tmp_path: Path) -> None:
    rows = rows_of(table())
    for path, words in (
        (tmp_path / "none.12d", "expected a .12d file, found no such file"),
        (written(tmp_path, [row[:8] for row in rows], "b"), f"expected rows of 9 numbers {COLUMNS}, found 8"),
        (written(tmp_path, [[-1.0, *rows[0][1:]], *rows[1:]], "c"), "row 1: expected periods above 0"),
        (written(tmp_path, [*rows, [*rows[0][:4], 7, *rows[0][5:]]], "d"), "row 271: expected a mode from 1 to 6"),
        (written(tmp_path, rows[:-6], "e"), "surge: expected all pairs of 9 periods, found none at 2.856 s and 2.856 s"),
        (written(tmp_path, rows[:6], "f"), "PER1: expected two periods or more, found 1"),
    ):
        with pytest.raises(InputError) as caught:
            read_transfer(path, 1025.0, 9.81)
        assert words in str(caught.value) and str(caught.value).startswith(str(path))
    with pytest.raises(InputError, match="expected waves of heading 45 deg, found 0 deg"):
        read_transfer(written(tmp_path, rows), 1025.0, 9.81, heading=45.0)
    (tmp_path / "g").write_text("PER1 PER2\n1 2\n")
    with pytest.raises(InputError, match=r"expected rows of 9 numbers .*, found 2"):
        read_transfer(tmp_path / "g", 1025.0, 9.81)
    text = written(tmp_path, rows).read_text()
    (tmp_path / "h").write_text("WAMIT Numeric Output -- Filename a.12d\n" + text)
    assert_allclose(read_transfer(tmp_path / "h", 1025.0, 9.81).omega, GRID, rtol=1e-8)


def test_a_platform_file_names_one(tmp_path: Path) -> None:
    """All of it, found beside the platform file, by a sweep's copy too; as a candidate at its neutral value, and scored."""
    written(tmp_path, rows_of(table()), "hull.12d")
    text = (Path(jh.__path__[0]) / "platforms" / "volturnus-s-focal.yaml").read_text(encoding="utf-8")
    path = tmp_path / "a.yaml"
    path.write_text(text + "\ndrift: {file: hull.12d, approximation: newman}\n", encoding="utf-8")
    model = jh.load_model(path)
    assert float(model.values["drift_transfer.share"]) == 1.0 and model.transfer.eigenvalue.shape == (6, 2)
    (tmp_path / "b").mkdir()
    (tmp_path / "b" / "platform.yaml").write_text(_platform_text(str(path)), encoding="utf-8")
    assert jh.load_model(tmp_path / "b" / "platform.yaml").transfer is not None
    path.write_text(text + "\ndrift: {file: hull.12d, use: candidate}\n", encoding="utf-8")
    model = jh.load_model(path)
    assert requested_table_labels(model) == {"drift_transfer.share"}
    scales = {"surge": NoticeableScales(5.0, 0.1, 1e5, 2e7)}
    effects = {waves: [candidate.effect for candidate in catalogue(model, scales, waves, 1.0)[0]] for waves in (True, False)}
    assert "drift_transfer" in effects[True] and "drift_transfer" not in effects[False]
    path.write_text(text + "\ndrift: {file: none.12d}\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"none\.12d: expected a \.12d file, found no such file"):
        jh.load_model(path)


@pytest.mark.skipif(not WAMIT.exists() or not RUN.exists(), reason="../shared/reference has no iea15-umaine or no openfast")
def test_openfast_has_the_same_force() -> None:
    """Its 2nd-order difference-frequency load of the IEA 15 MW's .12d file in a sea of 1038 components, cut at 0.75 rad/s."""
    transfer = read_transfer(WAMIT, 1025.0, 9.81)
    waves = pd.read_csv(RUN / "components.csv.gz", comment="#")
    record = pd.read_csv(RUN / "out.csv.gz", skiprows=[1])
    omega = jnp.asarray(waves.omega_rad_s.to_numpy())
    amplitude = jnp.asarray(waves.amp_m.to_numpy() * np.exp(1j * waves.phase_rad.to_numpy()))
    times, step = np.linspace(0.0, 4096.0, 4096, endpoint=False), 1.0
    turned = [jnp.exp(1j * omega[:, None] * part) * amplitude[:, None] for part in np.array_split(times, 16)]
    force = np.concatenate([np.asarray(transfer.force(transfer.at(omega) @ part)) for part in turned], axis=1)
    spectrum = np.fft.rfft(force, axis=1)
    spectrum[:, 2 * math.pi * np.fft.rfftfreq(len(times), step) > 0.75] = 0.0
    slow = np.fft.irfft(spectrum, axis=1)
    for i, channel in ((0, "B1WvsF2xi"), (2, "B1WvsF2zi"), (4, "B1WvsM2yi")):
        openfast = np.interp(times[:3900], record.Time.to_numpy(float), record[channel].to_numpy(float))
        assert np.std(slow[i, :3900] - openfast) < 2e-3 * np.std(openfast)
        assert abs((slow[i, :3900] - openfast).mean()) < 1e-3 * np.std(openfast)
