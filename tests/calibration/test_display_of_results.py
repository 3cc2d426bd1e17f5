"""How campaigns and results are shown, and taken on to xarray, pandas, matplotlib and ArviZ."""

import math
import re
import sys
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from fake_calibration import DEMO, small
from fake_diagnosis import fake_diagnosis

import jaxhydro as jh
from calibration.campaign.load_campaign import Campaign, load_campaign
from calibration.display.arviz_draws import inference_data
from calibration.report.diagnosis_words import verdict_sentence
from calibration.report.summary import calibration_sentence, summary_of
from calibration.result import Calibration
from calibration.results.tests_dataset import dataset
from calibration.results.write_calibration import document
from calibration.results.write_diagnosis import document as document_of_diagnosis
from calibration.results.write_diagnosis import write_diagnosis
from calibration.uncertainty.bootstrap_draws import Bootstrap
from calibration.uncertainty.posterior_samples import Samples
from jaxhydro.choices import UnknownName

LABELS = ("column.Cd_t", "linear_damping.B11")


@pytest.fixture(scope="module")
def result() -> Calibration:
    return small()


@pytest.fixture(scope="module")
def campaign() -> Campaign:
    return load_campaign(DEMO)


def test_a_calibration_in_a_few_lines(result: Calibration) -> None:
    """Its verdict as the report has it, and every parameter with its deviation."""
    first, verdict, *rows = repr(result).splitlines()
    assert first == "Calibration to campaign volturnus-s-decays"
    assert verdict == calibration_sentence(summary_of(document(result)))
    assert rows[0].split() == ["column.Ca_t", "1.480", "±", "0.015"]
    assert [row.split()[0] for row in rows] == list(result.parameters)
    assert any(re.match(r"  linear_damping.B33  \([0-9.·⁰¹²³⁴⁵⁶⁷⁸⁹]+\) not determined N s/m$", row) for row in rows), rows


def test_many_parameters_are_counted(result: Calibration) -> None:
    estimate = result.parameters["column.Ca_t"]
    many = replace(result, platform="hull", parameters={f"p{i}": replace(estimate, label=f"p{i}") for i in range(30)})
    lines = repr(many).splitlines()
    assert len(lines) == 15 and lines[0] == "Calibration of hull to campaign volturnus-s-decays"
    assert lines[-1] == "  ... and 18 more parameters: `to_dataframe()`"


def test_a_calibration_that_ran_away_has_a_text(result: Calibration) -> None:
    lost = {"column.Ca_t": replace(result.parameters["column.Ca_t"], value=math.nan)}
    assert "The parameter column.Ca_t is not finite." in repr(replace(result, parameters=lost))
    test = replace(result.tests[0], series=tuple(replace(s, simulated=s.simulated * np.nan) for s in result.tests[0].series))
    assert "The simulated motion of a fitted test is not finite." in repr(replace(result, tests=(test,)))


def test_a_diagnosis_in_a_few_lines() -> None:
    diagnosis = fake_diagnosis()
    lines = repr(diagnosis).splitlines()
    assert lines[0] == "Diagnosis of campaign basin"
    assert lines[1] == verdict_sentence(document_of_diagnosis(diagnosis))
    assert lines[2] == "  Coulomb friction in surge: force (81.0 ± 2.1) kN (probability 97 %)"
    assert lines[3].startswith("4 % of the squared error above the noise") and len(lines) == 4


def test_a_campaign_in_a_few_lines(campaign: Campaign) -> None:
    assert repr(campaign).splitlines() == [
        "Campaign volturnus-s-decays: 9 tests of VolturnUS-S",
        "  free decay: 9 fitted (surge 3, heave 3, pitch 3), 1.1 h",
    ]
    held = replace(campaign, records=tuple(replace(r, use="holdout" if r.id == "pitch-1" else "fit") for r in campaign.records))
    assert "  free decay: 1 held out (pitch 1), 0.092 h" in repr(held)


def test_tables(result: Calibration, campaign: Campaign) -> None:
    parameters = result.to_dataframe()
    assert list(parameters.index) == list(result.parameters) and parameters.index.name == "parameter"
    assert parameters.loc["column.Ca_t", ["value", "unit", "identifiable"]].tolist() == [1.48, "-", True]
    assert np.isnan(parameters.loc["linear_damping.B33", "standard_deviation"])
    assert parameters["at_bound"].sum() == 1
    effects = fake_diagnosis().to_dataframe()
    assert effects.loc["coulomb_friction.surge.force", ["effect", "motion", "value", "unit"]].tolist() == [
        "coulomb_friction",
        "surge",
        81000.0,
        "N",
    ]
    assert effects["probability"].tolist() == [0.97] and effects["in_doubt"].tolist() == [False]
    none = fake_diagnosis(effects=()).to_dataframe()
    assert len(none) == 0 and list(none.columns) == list(effects.columns)
    tests = campaign.to_dataframe()
    assert tests.loc["heave-2", ["kind", "use", "released", "samples"]].tolist() == ["decay", "fit", "heave", 1201]
    assert tests.loc["heave-2", "duration_s"] == pytest.approx(240.0)


def test_tables_in_notebooks(result: Calibration, campaign: Campaign) -> None:
    for shown, word in ((result, "column.Ca_t"), (campaign, "pitch-3"), (fake_diagnosis(), "coulomb_friction.surge.force")):
        assert f"<td>{word}</td>" in shown._repr_html_()
    script = replace(result, campaign="<script>")
    assert "<script>" not in script._repr_html_() and "&lt;script&gt;" in script._repr_html_()


def test_data_sets_are_those_of_the_files(result: Calibration, tmp_path) -> None:
    xr.testing.assert_identical(result.to_xarray(), dataset(result))
    diagnosis = fake_diagnosis()
    dataset_made = diagnosis.to_xarray()
    assert dataset_made["before"].attrs["long_name"] == "motion of the baseline" and "half_width" in dataset_made
    with xr.open_dataset(write_diagnosis(diagnosis, tmp_path, figures=False) / "simulated.nc", engine="h5netcdf") as written:
        assert set(written.variables) == set(dataset_made.variables)
        np.testing.assert_allclose(written["simulated"], dataset_made["simulated"])


def test_axes_of_a_calibration(result: Calibration) -> None:
    """A panel for each motion that counts, in degrees, with the model before calibration."""
    axes = result.plot()
    assert [ax.get_ylabel() for ax in axes] == ["Surge (m)", "Heave (m)", "Pitch (deg)"]
    assert [ax.get_title(loc="left") for ax in axes] == ["surge-1 (fitted)", "heave-1 (fitted)", "pitch-1 (held out)"]
    measured, calibrated, before = (line.get_ydata() for line in axes[2].lines)
    main = result.tests[2].main
    np.testing.assert_allclose(measured, np.degrees(main.measured))
    np.testing.assert_allclose(calibrated, np.degrees(main.simulated))
    np.testing.assert_allclose(before, np.degrees(result.tests[2].start["pitch"]))
    assert len(result.plot(["heave-1"])) == 1


def test_axes_of_a_diagnosis() -> None:
    """Held-out tests first: two motions count in neither, three in each sea."""
    diagnosis = fake_diagnosis()
    titles = [ax.get_title(loc="left") for ax in diagnosis.plot()]
    held = [title.endswith("(held out)") for title in titles]
    assert held == sorted(held, reverse=True) and sum(held) == 4 and len(titles) == 11
    words = [text.get_text() for text in diagnosis.plot(["surge-3"])[0].figure.legends[0].get_texts()]
    assert words == ["measured", "after", "before"]


def test_axes_of_a_campaign(campaign: Campaign) -> None:
    axes = campaign.plot(["surge-1", "pitch-2"])
    assert [ax.get_ylabel() for ax in axes] == ["Surge (m)", "Pitch (deg)"]
    np.testing.assert_allclose(axes[1].lines[0].get_ydata(), np.degrees(campaign.record("pitch-2").values["pitch"]))
    assert len(campaign.plot()) == 9


def test_a_sea_is_shown_with_its_wave(campaign: Campaign) -> None:
    first = campaign.records[0]
    sea = replace(first, kind="irregular", degree_of_freedom=None, wave=np.sin(first.time), wave_position=(0.0, 0.0))
    labels = [ax.get_ylabel() for ax in replace(campaign, records=(sea,)).plot()]
    assert labels[0] == "Wave (m)" and "Surge (m)" in labels


def test_an_unknown_test_is_told(result: Calibration, campaign: Campaign) -> None:
    for shown in (result, campaign, fake_diagnosis()):
        with pytest.raises(UnknownName, match="surge-1"):
            shown.plot(["surge-11"])
        with pytest.raises(ValueError, match="no test to plot"):
            shown.plot([])


def draws_of(value: np.ndarray) -> Bootstrap | Samples:
    """Draws (d, p) of a bootstrap, or (c, d, p) of the posterior."""
    model = jh.load_model("volturnus-s")
    likely = SimpleNamespace(fit=SimpleNamespace(decays=SimpleNamespace(problem=SimpleNamespace(model=model))))
    if value.ndim == 2:
        return Bootstrap("blocks", LABELS, value, value, value[0], {}, 1, 7, likely)
    return Samples(LABELS, value, value, np.array([1.001, 1.02]), np.array([150.0, 90.0]), 2, 7, value.shape[1], likely)


def test_draws_in_a_line() -> None:
    values = np.ones((2, 50, 2))
    assert repr(draws_of(values[0])) == "Bootstrap over blocks: 50 draws of 2 parameters, 1 of them not converged"
    assert repr(draws_of(values)) == (
        "Samples: 2 chains of 50 draws of 2 parameters; R-hat at most 1.020, at least 90 effective draws; 2 divergent steps"
    )


def test_draws_for_arviz() -> None:
    """Every parameter by chain and draw with its unit; a bootstrap is one chain."""
    arviz = pytest.importorskip("arviz", reason="ArviZ is of the extra `arviz`")
    values = np.random.default_rng(0).normal(size=(2, 50, 2))
    posterior = draws_of(values).to_arviz()
    assert posterior.posterior.sizes == {"chain": 2, "draw": 50}
    np.testing.assert_array_equal(posterior.posterior["linear_damping.B11"], values[..., 1])
    assert posterior.posterior["linear_damping.B11"].attrs["units"] == "N s/m"
    assert posterior.posterior.attrs["method"] == "NUTS" and posterior.posterior.attrs["divergences"] == 2
    assert list(arviz.summary(posterior).index) == list(LABELS)
    once = draws_of(values[0]).to_arviz().posterior
    assert once.sizes == {"chain": 1, "draw": 50} and once.attrs["method"] == "bootstrap over blocks"


def test_without_arviz_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "arviz", None)
    with pytest.raises(ImportError, match=r"jaxhydro\[arviz\]"):
        inference_data(draws_of(np.ones((5, 2))))
