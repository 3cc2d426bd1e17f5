"""What a diagnosis leaves behind, the page made of it, the command, and its values used in a simulation."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
import xarray as xr
from fake_diagnosis import fake_diagnosis
from PIL import Image
from test_outputs import SCHEMAS, Page, changed, contents

import jaxhydro as jh
from calibration.commands.diagnose_command import show_diagnosis
from calibration.discovery.diagnosis import Diagnosis
from calibration.discovery.refusal import Refusal, RefusalKind
from calibration.discovery.reported_effects import IMPLAUSIBLE_SIZE, PlausibleRange
from calibration.plots import diagnosis_figures as plots
from calibration.report import diagnosis_tables as tables
from calibration.report import diagnosis_words as words
from calibration.report.effect_alternatives import describe_alternatives, effect_in_three_lines
from calibration.report.write_report import write_report
from calibration.results.calibration_file import Parameter
from calibration.results.diagnosis_file import read_diagnosis
from calibration.results.diagnosis_motions import paired
from calibration.results.write_calibration import NotFinite
from calibration.results.write_diagnosis import document, write_diagnosis
from jaxhydro.errors import InputError
from jaxhydro.units import for_people

DEMO = Path(jh.__file__).parent / "campaigns" / "volturnus-s-decays"
FORCE = "coulomb_friction.surge.force"


@pytest.fixture(scope="module")
def result() -> Diagnosis:
    return fake_diagnosis()


@pytest.fixture(scope="module")
def written(result: Diagnosis, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_diagnosis(result, tmp_path_factory.mktemp("results") / "new" / "deep")


# --- diagnosis.json, simulated.nc, figures


@pytest.mark.parametrize("schema", SCHEMAS, ids=["own", "shared"])
def test_the_document_follows_the_schema(written: Path, schema: Path) -> None:
    if not schema.exists():
        pytest.skip("no shared schema here")
    read = json.loads((written / "diagnosis.json").read_text(), parse_constant=lambda name: pytest.fail(f"{name} is no JSON"))
    jsonschema.Draft202012Validator(json.loads(schema.read_text())).validate(read)


def test_the_document_says_what_the_contract_says(result: Diagnosis, written: Path) -> None:
    read = json.loads((written / "diagnosis.json").read_text())
    assert {"campaign", "platform", "jaxhydro", "baseline", "missing", "augmented"} <= set(read)
    missing = read["missing"]
    assert missing["verdict"] == "found" and missing["unexplained"] == {"share": 0.04, "signature": result.signature}
    effect = missing["effects"][0]
    assert (effect["effect"], effect["degree_of_freedom"]) == ("coulomb_friction", "surge")
    force = effect["parameters"]["force"]
    assert (force["value"], force["standard_deviation"], force["unit"]) == (81000.0, 2100.0, "N")
    numbers = {"score": 812.0, "delta_bic": 604.0, "holdout_gain": 0.61, "clear": 38.6}
    assert effect["evidence"] == numbers | {"probability": 0.97, "left_out": 512.0, "left_out_better": 0.75}
    assert effect["share_of_residual_explained"] == 0.93 and effect["indistinguishable_from"] == ["hysteresis (surge)"]
    reason = "the squared error of the held-out tests grows by 2 %"
    assert missing["rejected"][0] == {"effect": "current", "degree_of_freedom": None, "reason": reason}
    assert FORCE in read["augmented"]["parameters"] and FORCE not in read["baseline"]["parameters"]
    for key, fitted in (("baseline", result.baseline), ("augmented", result.augmented)):
        assert read[key]["objective"]["fit"] == pytest.approx(fitted.objective("fit")) and read[key]["converged"] is True
        low = fitted.tests[4].bands["surge"]["low_frequency"]
        assert read[key]["error"]["sea-1"]["bands"]["surge"]["low_frequency"] == low.after
    first = read["augmented"]["error"]["pitch-1"]["pitch"]
    assert first["unit"] == "deg" and first["before"] == pytest.approx(
        {key: read["baseline"]["error"]["pitch-1"]["pitch"][key] for key in ("rmse", "unit", "relative")}
    )
    assert read["tests"]["sea-2"]["bands_before"] == read["baseline"]["error"]["sea-2"]["bands"]
    assert len(read["scores"]) == len(result.scores) and read["scores"][0]["refitted_gain"] == 640.0
    assert read["anatomy"]["before"][3]["rms"] == pytest.approx(np.rad2deg(result.anatomy_before[3].rms))
    assert len(read["anatomy"]["after"][0]["bands"]) == 10 and read["next_test"] and read["seconds"] == 321.0


def test_the_series_before_have_the_residual_they_had(result: Diagnosis, written: Path) -> None:
    """Sensor offsets differ between the two fits: what is measured is on the later one's."""
    with xr.open_dataset(written / "simulated.nc") as data:
        for before, after in zip(result.baseline.tests, result.augmented.tests):
            of_test = data.sel(test=after.id, channel=after.main.channel)
            n, factor = len(after.time), 180 / np.pi if after.main.channel == "pitch" else 1.0
            np.testing.assert_allclose(of_test.simulated[:n], factor * after.main.simulated, atol=1e-12)
            residual = factor * (before.main.measured - before.main.simulated)
            np.testing.assert_allclose(of_test.measured[:n] - of_test.before[:n], residual, atol=1e-12)
        assert data.attrs["title"] == "Diagnosis of basin" and "baseline" in data.before.attrs["long_name"]
    test = result.baseline.tests[0]
    short = replace(test, series=tuple(replace(s, measured=s.measured[1:], simulated=s.simulated[1:]) for s in test.series))
    odd = replace(result, baseline=replace(result.baseline, tests=(short, *result.baseline.tests[2:])))
    assert not paired(odd).tests[0].start and len(paired(odd).tests) == len(result.augmented.tests)


def test_every_figure_is_half_a_page_wide_and_named_in_the_document(written: Path) -> None:
    listed = json.loads((written / "diagnosis.json").read_text())["figures"]
    names = [figure["file"].removeprefix("figures/") for figure in listed]
    assert names == [
        "before-after.png",
        "anatomy.png",
        "effect-coulomb_friction-surge.png",
        "scores.png",
        "spectra-sea-1.png",
        "spectra-sea-2.png",
    ]
    assert set(names) == {path.name for path in (written / "figures").iterdir()}
    for figure in listed:
        assert figure["caption"]
        with Image.open(written / figure["file"]) as image:
            assert image.width == 1005 and 500 < image.height < 3000


def test_an_effect_in_doubt_is_said_to_be(result: Diagnosis, tmp_path: Path) -> None:
    """In the verdict, beside the effect, and in the file; all of them, or one beside another that is sure."""
    doubtful = replace(result.effects[0], indistinguishable=(), in_doubt="amplitude_dependent_drag")
    current = replace(result.effects[0], effect="current", degree_of_freedom=None, indistinguishable=())
    for effects, verdict, start in (
        ((doubtful,), "unexplained", "The model lacks something, and no effect"),
        ((current, doubtful), "found", "The model lacks a current. "),
    ):
        write_diagnosis(replace(result, verdict=verdict, effects=effects), tmp_path / verdict, figures=False)
        saved = read_diagnosis(tmp_path / verdict)
        assert words.verdict_sentence(saved).startswith(start)
        assert " Coulomb friction in surge may stand for " in words.verdict_sentence(saved)
        sentence = describe_alternatives(saved.missing.effects[-1])
        assert sentence.startswith("Amplitude dependent drag explains more of the fitted tests beside it than it does, and is")
        assert sentence in Page(write_report(tmp_path / verdict).read_text()).text
        raising = saved.missing.effects[-1].model_copy(update={"in_doubt": "held_out_error"})
        assert describe_alternatives(raising).startswith("With all that was found in the model, the tests that were not")
        lacking = saved.missing.effects[-1].model_copy(update={"in_doubt": "wave_order"})
        assert describe_alternatives(lacking).startswith("The model is driven with the second-order waves of theory")
        unordered = saved.missing.model_copy(update={"effects": [*saved.missing.effects[:-1], lacking]})
        verdict = words.verdict_sentence(saved.model_copy(update={"missing": unordered}))
        assert verdict == f"{words.WAVES_FIRST} {words.verdict_sentence(saved)}"
        trading = saved.missing.effects[-1].model_copy(update={"trades_against": {"sensor_lag": -0.974}})
        assert "Its size trades against that of a sensor lag (correlation -0.97)" in (describe_alternatives(trading))
        if current in effects:
            assert describe_alternatives(saved.missing.effects[0]).startswith("No other effect that was tried does as well.")


def test_a_gain_is_called_after_what_it_was_found_on(result: Diagnosis, written: Path, tmp_path: Path) -> None:
    """Held-out tests; where nothing was held out, blocks of the fitted tests."""
    held = read_diagnosis(written)
    assert tables.effects(held)[0][-1] == "Gain over held-out tests"
    less = {
        key: replace(getattr(result, key), tests=tuple(test for test in getattr(result, key).tests if test.use == "fit"))
        for key in ("baseline", "augmented")
    } | {"predictions": ()}
    saved = read_diagnosis(write_diagnosis(replace(result, **less), tmp_path, figures=False))
    assert not tables.predictions(saved)[1]
    assert tables.effects(saved)[0][-1] == "Gain over blocks of the fitted tests left out in turn"
    text = " ".join(words.describe_certainty(saved, saved.missing.effects[0]))
    assert "squared error of blocks of the fitted tests left out in turn falls by 61 %" in text
    assert "held" not in text.lower() and "not fitted" not in text


def test_the_terminal_tells_each_effect_in_three_lines(written: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Name and size; how sure; what else it could be."""
    saved = read_diagnosis(written)
    show_diagnosis(saved, [])
    lines_printed = capsys.readouterr().out.splitlines()
    for effect in saved.missing.effects:
        lines = effect_in_three_lines(saved, effect)
        at = lines_printed.index(lines[0])
        assert [line for line in lines_printed[at : at + 3]] == list(lines)
    first = effect_in_three_lines(saved, saved.missing.effects[0])
    assert first[0].startswith("Coulomb friction in surge: force (81.0 ± ") and first[0].endswith(" kN")
    assert first[1].startswith("  How sure: probability ") and "squared error of held-out tests falls by 61 %" in first[1]
    assert first[2].startswith("  What else it could be: ")
    bare = saved.missing.effects[0].model_copy(update={"parameters": {}})
    assert effect_in_three_lines(saved, bare)[0] == "Coulomb friction in surge"


def nothing(**changes: Any) -> Diagnosis:
    """Nothing was found."""
    less = {
        "verdict": "nothing_missing",
        "effects": (),
        "rejected": (),
        "scores": (),
        "anatomy_before": (),
        "anatomy_after": (),
        "unexplained_share": np.nan,
        "next_test": "",
        "notes": (),
        "signature": "",
    }
    return replace(fake_diagnosis(), **{**less, **changes})


@pytest.mark.slow
def test_odd_results_can_be_written_and_made_a_page_of(result: Diagnosis, tmp_path: Path) -> None:
    """Nothing missing; no tests at all; numbers that are none; effects twice, of nothing that moves; many rounds."""
    read_diagnosis(write_diagnosis(nothing(), tmp_path / "a"))
    page = Page(write_report(tmp_path / "a").read_text())
    assert "nothing that the model lacks" in page.text and "No effect." in page.text
    assert json.loads((tmp_path / "a" / "diagnosis.json").read_text())["missing"]["unexplained"]["share"] == 0.0
    less = {key: replace(getattr(result, key), tests=()) for key in ("baseline", "augmented")} | {"predictions": ()}
    write_diagnosis(replace(nothing(verdict="unexplained", signature="at 0.01 Hz, as Hs^2"), **less), tmp_path / "b")
    assert "at 0.01 Hz, as Hs^2" in Page(write_report(tmp_path / "b").read_text()).text
    stopped = nothing(verdict="unexplained", scores=result.scores[:1], augmented=replace(result.augmented, converged=False))
    write_diagnosis(stopped, tmp_path / "stopped")
    assert "did not come to its end" in Page(write_report(tmp_path / "stopped").read_text()).text
    quiet = replace(stopped, scores=tuple(replace(score, gain=0.5, refitted=None) for score in result.scores))
    write_diagnosis(quiet, tmp_path / "quiet")
    assert (tmp_path / "stopped" / "figures" / "scores.png").exists()
    assert not (tmp_path / "quiet" / "figures" / "scores.png").exists()
    friction = result.effects[0]
    unsure = replace(friction.evidence, score=np.nan, delta_bic=np.inf, holdout_gain=np.nan, clear=np.nan)
    unnamed = replace(friction, effect="new", degree_of_freedom="yaw", parameters={}, telling_test=None)
    twice = (friction, replace(friction, evidence=unsure), unnamed)
    many = tuple(replace(s, round=n, gain=np.nan if n == 3 else s.gain) for n in range(1, 6) for s in result.scores[:6])
    findings = tuple(replace(f, noise=0.0, bands=((0.0, 1.0, np.nan),)) for f in result.anatomy_before[:3])
    odd = replace(result, effects=twice, scores=many, anatomy_before=findings, anatomy_after=findings[:1], seconds=np.inf)
    write_diagnosis(odd, tmp_path / "c")
    jsonschema.validate(json.loads((tmp_path / "c" / "diagnosis.json").read_text()), json.loads(SCHEMAS[0].read_text()))
    text = Page(write_report(tmp_path / "c").read_text()).text
    assert "No test was held out" in text and "Coulomb friction in surge, Coulomb friction in surge and new in yaw" in text


def test_bands_of_held_out_tests_are_written_and_told(result: Diagnosis, written: Path) -> None:
    """Their widths at every sample beside the motions, in people's units, and how many samples they hold."""
    prediction = next(
        prediction for prediction in result.predictions if prediction.channel == "pitch" or prediction.test == "surge-3"
    )
    saved = next(p for p in read_diagnosis(written).predictions if (p.test, p.channel) == (prediction.test, prediction.channel))
    assert saved.samples == len(prediction.half_width) and saved.inside == prediction.inside
    assert saved.half_width == pytest.approx(float(for_people(prediction.channel, prediction.half_width[0])))
    with xr.open_dataset(written / "simulated.nc") as data:
        held = data["half_width"].sel(test=prediction.test, channel=prediction.channel).values
        assert np.nanmax(held) == pytest.approx(saved.half_width)
        assert (
            np.isfinite(held).sum()
            == np.isfinite(data["simulated"].sel(test=prediction.test, channel=prediction.channel)).sum()
        )
        assert np.isnan(data["half_width"].sel(test="surge-1")).all()
    assert "Samples inside" in Page(write_report(written).read_text()).text


@pytest.mark.slow
def test_a_size_at_the_end_of_what_is_plausible_is_told(result: Diagnosis, tmp_path: Path) -> None:
    """With the range and where it comes from; the effect is in doubt, and its probability is beside it."""
    at_limit = replace(
        result.effects[0],
        in_doubt=IMPLAUSIBLE_SIZE,
        plausible={FORCE: PlausibleRange(0.0, 81000.0, "engineering judgement: a tenth of the largest restoring force.", True)},
    )
    write_diagnosis(replace(result, effects=(at_limit, *result.effects[1:])), tmp_path)
    saved = read_diagnosis(tmp_path)
    assert saved.missing.effects[0].plausible["force"].at_end
    sentence = describe_alternatives(saved.missing.effects[0])
    assert "at the end of what is plausible: force, plausible from 0 to 81.0 kN (engineering judgement" in sentence
    text = Page(write_report(tmp_path).read_text()).text
    assert "97 %" in text and "75 % are predicted better with it" in text and "acts like it" in text


def test_what_is_not_finite_is_refused(result: Diagnosis) -> None:
    force = {FORCE: replace(result.effects[0].parameters[FORCE], value=np.nan)}
    with pytest.raises(NotFinite, match=r"coulomb_friction\.surge\.force is not finite"):
        document(replace(result, effects=(replace(result.effects[0], parameters=force),)))
    with pytest.raises(NotFinite, match="fitted test"):
        document(replace(result, augmented=changed(result.augmented, 0, simulated=np.full(2400, np.nan))))


# --- whole or not at all


@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt])
def test_an_old_result_stays_when_plotting_fails(result, tmp_path, monkeypatch, error) -> None:
    folder = write_diagnosis(result, tmp_path / "out", figures=False)
    before = contents(tmp_path)

    def broken(*_: object) -> None:
        raise error("no ink")

    monkeypatch.setattr(plots, "figures", broken)
    for out in (folder, tmp_path / "other"):
        with pytest.raises(error, match="no ink"):
            write_diagnosis(replace(result, campaign="new"), out)
    assert contents(tmp_path) == before and not (tmp_path / "other").exists()


@pytest.mark.slow
def test_a_new_result_replaces_the_old_one_and_nothing_else(result: Diagnosis, tmp_path: Path) -> None:
    folder = write_diagnosis(result, tmp_path / "out")
    write_report(folder)
    (folder / "figures" / "mine.png").write_bytes(b"keep")
    write_diagnosis(nothing(campaign="second"), folder, figures=False)
    assert {path.name for path in (folder / "figures").iterdir()} == {"mine.png"}
    assert {path.name for path in folder.iterdir()} == {"diagnosis.json", "simulated.nc", "figures"}
    assert read_diagnosis(folder).campaign == "second"


# --- the page


def test_the_page_tells_it_in_order_and_needs_nothing_else(written: Path) -> None:
    path = write_report(written)
    page = Page(path.read_text(encoding="utf-8"))
    assert path == written / "report.html" and page.tags.count("img") == len(list((written / "figures").iterdir()))
    assert all(link.startswith("data:image/png;base64,") for link in page.links) and "http" not in page.text
    assert not {"link", "iframe", "object"} & set(page.tags) and page.tags.count("script") in (0, 3)
    passages = (
        "The model lacks Coulomb friction in surge",
        "falls by 69 %",
        "force (81.0 ± 2.1) kN",
        "Very strong evidence",
        "squared error of held-out tests falls by 61 %",
        "cannot tell it from hysteresis in surge",
        "A test that would tell: a static pull-out",
        "left unexplained. What is left: white",
        "The test to run next",
        "Coefficients fitted without",
        "91000 ± 3000",
        "44000 ± 1500",
        "-52 %",
        "free decay: 4 fitted, 1 held out",
        "in phase with velocity",
        "RMSE after",
        "low frequency",
        "-24 %",
        "error of the held-out tests grows by 2 %",
        "surge-2 repeats surge-1",
        "321 s",
        "Page by",
    )
    places = [page.text.find(text) for text in passages]
    assert -1 not in places and places == sorted(places), list(zip(passages, places))
    assert "did not converge" not in page.text and "not determined" in page.text


def test_the_page_escapes_what_comes_from_files(result: Diagnosis, tmp_path: Path) -> None:
    evil = '<script>alert("1")</script>&amp; $title'
    friction = result.effects[0]
    force = replace(friction.parameters[FORCE], label=evil, unit=evil)
    effect = replace(
        friction,
        effect=evil,
        degree_of_freedom=evil,
        meaning=evil,
        source=evil,
        parameters={evil: force},
        telling_test=evil,
        indistinguishable=(evil,),
    )
    rejected = tuple(
        replace(r, effect=evil, reason=Refusal(RefusalKind.IMPOSSIBLE_VALUE, (-1.0,), evil)) for r in result.rejected
    )
    anatomy = tuple(replace(f, test=evil, words=evil) for f in result.anatomy_before)
    strange = replace(
        result,
        campaign=evil,
        effects=(effect,),
        rejected=rejected,
        anatomy_before=anatomy,
        signature=evil,
        next_test=evil,
        notes=(evil,),
        augmented=replace(result.augmented, converged=False, parameters={evil: replace(force, label=evil)}),
    )
    page = Page(write_report(write_diagnosis(strange, tmp_path / "out", figures=False)).read_text(encoding="utf-8"))
    assert page.tags.count("script") in (0, 3) and page.text.count(evil) >= 15 and "did not converge" in page.text


def test_broken_results_are_told(written: Path, tmp_path: Path) -> None:
    good = json.loads((written / "diagnosis.json").read_text())
    friction = good["missing"]["effects"][0]
    missing, augmented = good["missing"], good["augmented"]
    cases = [
        ({key: good[key] for key in good if key != "augmented"}, "augmented: expected a mapping"),
        (good | {"missing": missing | {"verdict": "maybe"}}, "missing.verdict: expected one of"),
        (good | {"missing": missing | {"effects": [friction | {"parameters": 3}]}}, "missing.effects[0].parameters"),
        (good | {"augmented": augmented | {"error": {"a": {"use": "fit", "surge": 3}}}}, "augmented.error.a.surge"),
        ("{", "line 1, column 2: expected valid JSON"),
    ]
    for content, expected in cases:
        (tmp_path / "diagnosis.json").write_text(content if isinstance(content, str) else json.dumps(content))
        with pytest.raises(InputError) as caught:
            write_report(tmp_path)
        assert expected in str(caught.value) and "diagnosis.json" in str(caught.value)
        assert [path.name for path in tmp_path.iterdir()] == ["diagnosis.json"]


def test_sizes_and_names_as_people_read_them() -> None:
    assert words.quantity(81000.0, 2100.0, "N") == "(81.0 ± 2.1) kN"
    assert words.quantity(-2.5e9, None, "N m") == "-2.50 GN m"
    assert words.quantity(3.6e8, 5e5, "N m s2/rad2") == "(360.00 ± 0.50) MN m s²/rad²"
    assert words.quantity(np.deg2rad(2.0), np.deg2rad(0.1), "rad") == "(2.00 ± 0.10) deg"
    assert words.quantity(-3.1e5, 2e4, "kg") == "(-310 ± 20) t"
    assert words.quantity(0.33, 0.01, "-") == "0.330 ± 0.010"
    assert words.quantity(0.12, np.nan, "m/s") == "0.120 m/s"
    sure, small, lost = (
        Parameter(value=value, standard_deviation=sd, unit="N m/rad3", start=start, identifiable=sd is not None)
        for value, sd, start in ((29e3, 9.9e3, 0.0), (201.0, 286.0, 0.0), (201.0, None, 0.0))
    )
    assert words.describe_parameter("quintic", sure) == "quintic (29.0 ± 9.9) kN m/rad³"
    assert words.describe_parameter("cubic", small) == "cubic not determined: fitted (201 ± 286) N m/rad³"
    assert words.describe_parameter("cubic", lost) == "cubic not determined"
    assert [name for name, _ in words.sorted_by_certainty({"a": small, "b": sure, "c": lost})] == ["b", "a", "c"]
    assert words.is_determined(small.model_copy(update={"start": 2000.0}))  # known to be small
    near = sure.model_copy(update={"standard_deviation": 20e3})
    assert words.describe_parameter("quintic", near).endswith("kN m/rad³, less than 2 standard deviations from zero")
    assert (
        words.effect_in_words("hysteresis (surge)") == "hysteresis in surge" and words.effect_in_words("current") == "a current"
    )
    assert words.listed(["a"]) == "a" and words.listed(["a", "b", "c"]) == "a, b and c" and words.listed([]) == ""
    assert words.describe_change(0.5, 0.6) == "grows by 20 % (J from 0.500 to 0.600)"
