"""Calibration in measured waves: residuals, their Jacobian, coefficients of a made run found back, messages."""

import json

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import one_program
from test_cli import cache, run  # noqa: F401
from test_seas import made  # noqa: F401  (a fixture: a run of the NumPy model)

from calibration import Interrupted, calibrate, calibrate_in_waves, load_campaign
from calibration.parameters.space import parameter_space
from calibration.residuals.abstract_residual import parameters_only
from calibration.residuals.band_energies import CELLS_PER_BAND, MIN_ENERGY_SHARE, BandEnergies, energies_of, joined_bands
from calibration.residuals.measured_seas import compare
from calibration.residuals.run_seas import seas_of, with_diffraction
from calibration.residuals.sea_errors import in_bands
from calibration.residuals.seas import set_up_waves
from calibration.residuals.wave_options import Options
from calibration.results.write_calibration import document, write_calibration
from jaxhydro.analysis.spectral import band_integral, band_weights, power_spectrum
from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError
from jaxhydro.platform.build import build

OPTIONS = Options(order=2, diffraction="none", cutoff=0.2)
LABELS = ("column.Cd_t", "pontoon.Cd_z")


@pytest.fixture(scope="module")
def campaign(made):  # noqa: F811
    return load_campaign(made)


@pytest.fixture(scope="module")
def problem(campaign):
    """From two drag coefficients that are off by factors; one set of shapes, so that it is compiled once."""
    model = with_diffraction(build(campaign.platform), OPTIONS).with_values(start_of(campaign))
    seas, space = seas_of(campaign, model.environment, OPTIONS), parameter_space(model, LABELS)
    scale = campaign.manifest.scale
    return set_up_waves(model, seas, space, OPTIONS, from_rest=True, scale=scale, step=0.25, objective="both")


def start_of(campaign) -> dict[str, float]:
    true = build(campaign.platform).values
    return {label: factor * float(true[label]) for label, factor in zip(LABELS, (0.4, 2.0))}


@pytest.mark.parametrize("count, segment", [(4001, None), (12_000, 1000.0), (12_345, 500.0)])
def test_energy_in_a_band_as_a_quadratic_form(count: int, segment: float | None) -> None:
    """Against Welch by SciPy and its integral, of records of one segment and of many, to rounding; the ends cut cells."""
    step = 0.25
    x = np.random.default_rng(1).normal(size=count).cumsum()
    spectrum = power_spectrum(step * np.arange(count), x, segment)
    for low, high in ((0.005, 0.025), (0.0, 3.0), (0.0503, 0.1511)):
        weights = band_weights(count, step, low, high, segment)
        assert weights.integral(x) == pytest.approx(band_integral(spectrum, low, high), rel=1e-12)
    with pytest.raises(ValueError, match="0 <= low < high"):
        band_weights(count, step, 0.2, 0.1)


@pytest.mark.parametrize("duration, cells", [(9000.0, CELLS_PER_BAND), (3600.0, 7), (2000.0, 4), (500.0, 1)])
def test_cells_of_a_band_are_as_narrow_as_the_record_allows(duration: float, cells: int) -> None:
    """White noise has energy in all of them: together that of the band; ten periods of the record at least in a cell."""
    step = 0.5
    x = np.random.default_rng(3).normal(size=int(duration / step))
    whole, parts = (energies_of(x, step, 0.005, 0.025, cut) for cut in (False, True))
    assert parts.measured.shape == (cells,)
    assert np.asarray(parts.measured).sum() == pytest.approx(np.asarray(whole.measured)[0], rel=1e-12)
    second = energies_of(x, step, 0.06, 0.15, True)
    joined = one_program(BandEnergies.of)(joined_bands([parts, second]), x)
    assert_allclose(joined, np.concatenate([parts.measured, second.measured]), rtol=1e-12)


def test_cells_without_energy_are_left_out() -> None:
    """Of a motion with one frequency and a sensor's noise one cell is left, that of the frequency."""
    step, time = 0.5, np.arange(0.0, 3600.0, 0.5)
    x = np.sin(2 * np.pi * 0.0064 * time) + 1e-3 * np.random.default_rng(3).normal(size=time.size)
    whole, with_cut = (energies_of(x, step, 0.005, 0.025, cut) for cut in (False, True))
    assert with_cut.measured.shape == (1,)
    assert float(with_cut.measured[0]) == pytest.approx(float(whole.measured[0]), rel=MIN_ENERGY_SHARE)


@pytest.mark.slow
def test_residuals_are_what_the_comparison_says(campaign, problem) -> None:
    """ln(1 + error) of every band, and the motions' RMSE over their deviations, by another path: compare, SciPy's Welch."""
    groups = [np.asarray(g) for g in eqx.filter_jit(lambda p: p.residuals(p.space.start))(problem)]
    assert problem.in_bands == (True, False, False, False, False, False, False)  # three motions of two tests
    tests = {test.fit.id: test for test in compare(campaign, problem.model, OPTIONS).tests if test.fit.use == "fit"}
    pieces = [piece for run in problem.runs for piece in run.pieces]
    expected = [np.log1p(in_bands(tests[p.test])[DOFS[p.dof]][band].error) for p in pieces for band in p.names]
    assert len(expected) == 6  # of the irregular test
    assert_allclose(groups[0], expected, atol=2e-3)
    for piece, group in zip(pieces, groups[1:], strict=True):
        series = next(s for s in tests[piece.test].fit.series if s.channel == DOFS[piece.dof])
        off = np.std(series.simulated - series.measured) / np.std(series.measured)
        assert np.linalg.norm(group) == pytest.approx(off, rel=0.02)


@pytest.mark.slow
def test_gradient_through_a_sea_and_its_spectra(problem) -> None:
    """Gradient and Gauss-Newton matrix of all residuals against central differences."""
    stacked = eqx.filter_jit(lambda p, x: jnp.concatenate(p.residuals(x)))
    x = problem.space.start + jnp.array([0.2, -0.3])
    products = np.asarray(eqx.filter_jit(lambda p, x: p.products(parameters_only(x)))(problem, x)).sum(axis=(0, 1))
    pairs = [(stacked(problem, x + d), stacked(problem, x - d)) for d in 1e-4 * np.eye(2)]
    slopes = np.stack([np.asarray(ahead - behind) / 2e-4 for ahead, behind in pairs], axis=1)
    r = np.asarray(stacked(problem, x))
    assert_allclose(products[:2, 2], slopes.T @ r, rtol=1e-4)
    assert_allclose(products[:2, :2], slopes.T @ slopes, rtol=1e-4)
    assert products[2, 2] == pytest.approx(r @ r, rel=1e-9)


@pytest.fixture(scope="module")
def fitted(campaign):
    reports = []
    result = calibrate_in_waves(
        campaign, free=LABELS, start=start_of(campaign), objective="both", options=OPTIONS, progress=reports.append
    )
    return result, reports, build(campaign.platform).values


@pytest.mark.slow
def test_coefficients_of_a_made_run_are_found_back(fitted) -> None:
    """Two drag coefficients of the NumPy model, within 3 % or two of their deviations; the held-out sea is met too."""
    result, reports, true = fitted
    assert result.converged and reports[-1].name == "error" and reports[-1].objective < 0.3 * reports[1].objective
    for label in LABELS:
        estimate = result.parameters[label]
        assert estimate.identifiable
        assert abs(estimate.value - float(true[label])) < max(0.03 * float(true[label]), 2 * estimate.standard_deviation), label
    tests = {test.id: test for test in result.tests}
    assert set(tests) == {"sea-a", "sea-b", "wave"} and result.objective("holdout") < 0.1
    for band in tests["sea-b"].bands["surge"].values():
        assert abs(band.after) < 0.03
    assert max(abs(b.before) for row in tests["sea-a"].bands.values() for b in row.values()) > 0.1


@pytest.mark.slow
def test_spectra_find_them_back_too(campaign) -> None:
    result = calibrate_in_waves(campaign, free=LABELS, start=start_of(campaign), objective="spectrum", options=OPTIONS)
    true = build(campaign.platform).values
    for label in LABELS:
        estimate = result.parameters[label]
        assert estimate.identifiable
        assert abs(estimate.value - float(true[label])) < max(0.03 * float(true[label]), 2 * estimate.standard_deviation), label


@pytest.mark.slow
def test_what_is_written(fitted, tmp_path) -> None:
    result, _, _ = fitted
    content = document(result).model_dump(exclude_unset=True)
    errors = content["baseline"]["error"]
    assert set(errors["sea-a"]["bands"]) == set(content["tests"]["sea-a"]["bands_before"]) == {"surge", "heave", "pitch"}
    assert "bands" not in errors["wave"]
    write_calibration(result, tmp_path / "o")
    saved = json.loads((tmp_path / "o" / "calibration.json").read_text())
    assert {figure["file"] for figure in saved["figures"]} >= {"figures/spectra-sea-a.png", "figures/test-wave.png"}


@pytest.mark.slow
def test_messages(campaign, made, tmp_path) -> None:  # noqa: F811
    with pytest.raises(InputError, match="--tests waves"):
        calibrate(campaign)
    with pytest.raises(InputError, match="a parameter of this platform"):
        calibrate_in_waves(campaign, free=["colunm.Cd_t"], options=OPTIONS)
    message = run("calibrate", made, "--tests", "decays", "--out", tmp_path / "o", status=2)
    assert "at least one decay test" in message

    def stop(now) -> None:
        if now.iteration == 2:
            raise KeyboardInterrupt

    with pytest.raises(Interrupted) as stopped:
        calibrate_in_waves(campaign, free=LABELS, start=start_of(campaign), objective="both", options=OPTIONS, progress=stop)
    assert stopped.value.partial is not None and not stopped.value.partial.converged
