"""What a calibration leaves behind: files that are whole or absent, valid, escaped and readable without a network."""

import copy
import json
import os
import re
import shutil
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
import xarray as xr
from fake_calibration import small
from fake_diagnosis import fake_diagnosis
from PIL import Image

import calibration
from calibration.decay_analysis.linear_quadratic import classical
from calibration.fitting.fit_conclusion import records_not_followed
from calibration.formatting import number, percent, with_deviation
from calibration.plots import calibration_figures as plot
from calibration.report.write_report import write_report
from calibration.result import BandError, Calibration, Estimate
from calibration.results import schema
from calibration.results import write_calibration as outputs
from calibration.results.calibration_file import read_saved, read_values
from calibration.results.tests_dataset import dataset
from calibration.results.write_calibration import NotFinite, document, write_calibration
from calibration.results.write_diagnosis import document as document_of_diagnosis
from jaxhydro.errors import InputError
from jaxhydro.files import check_folder, staged

SCHEMAS = [
    Path(calibration.__file__).parent / "outputs.schema.json",
    Path(__file__).resolve().parents[3] / "shared" / "design" / "outputs.schema.json",
]


@pytest.fixture(scope="module")
def result() -> Calibration:
    return small()


@pytest.fixture(scope="module")
def written(result: Calibration, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_calibration(result, tmp_path_factory.mktemp("results") / "new" / "deep")


def follows(document: Any, model: str) -> None:
    """Raises unless a document is as outputs.schema.json says of a file, by the name of its model."""
    whole = json.loads(SCHEMAS[0].read_text())
    jsonschema.Draft202012Validator({"$ref": f"#/$defs/{model}", "$defs": whole["$defs"]}).validate(document)


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def changed(result: Calibration, test: int, **series) -> Calibration:
    """The result with the main series of one test changed."""
    tests = list(result.tests)
    rows = tuple(
        replace(series_of_test, **series) if series_of_test is tests[test].main else series_of_test
        for series_of_test in tests[test].series
    )
    tests[test] = replace(tests[test], series=rows)
    return replace(result, tests=tuple(tests))


# --- calibration.json


@pytest.mark.parametrize("contract", SCHEMAS, ids=["own", "shared"])
def test_the_document_follows_the_schema(written: Path, contract: Path) -> None:
    if not contract.exists():
        pytest.skip("no shared schema here")

    def refuse(name: str) -> None:
        raise AssertionError(f"{name} is no JSON")

    read = json.loads((written / "calibration.json").read_text(), parse_constant=refuse)
    jsonschema.Draft202012Validator(json.loads(contract.read_text())).validate(read)


def test_the_schema_is_that_of_the_models() -> None:
    """Renewed by `python -m calibration.results.schema`."""
    assert SCHEMAS[0].read_text(encoding="utf-8") == schema.text()


def required_keys(part: dict[str, Any], whole: dict[str, Any], document: Any, path: tuple[str | int, ...] = ()):
    """Paths of the keys that a schema requires of a document."""
    part = whole["$defs"][part["$ref"].rsplit("/", 1)[1]] if "$ref" in part else part
    if isinstance(document, list):
        for i, value in enumerate(document):
            yield from required_keys(part.get("items", {}), whole, value, (*path, i))
    if isinstance(document, dict):
        yield from ((*path, name) for name in part.get("required", ()))
        for name, value in document.items():
            default = part.get("additionalProperties", {})
            yield from required_keys(part.get("properties", {}).get(name, default), whole, value, (*path, name))


def test_a_document_without_a_key_of_the_contract_is_refused() -> None:
    """By the shared contract, and by the schema of the models: what is promised there is promised here."""
    if not SCHEMAS[1].exists():
        pytest.skip("no shared schema here")
    own, shared = (json.loads(path.read_text()) for path in SCHEMAS)
    document = document_of_diagnosis(fake_diagnosis()).model_dump(mode="json", exclude_unset=True)
    paths = list(required_keys(shared, shared, document))
    assert len(paths) > 100 and ("missing", "effects", 0, "evidence", "delta_bic") in paths
    for path in paths:
        lacking = copy.deepcopy(document)
        at: Any = lacking
        for step in path[:-1]:
            at = at[step]
        del at[path[-1]]
        # without `missing` it is a calibration.json
        assert not jsonschema.Draft202012Validator(shared).is_valid(lacking)
        assert not jsonschema.Draft202012Validator(own).is_valid(lacking) or path == ("missing",)


def test_keys_of_later_versions_are_taken(written: Path, tmp_path: Path) -> None:
    data = json.loads((written / "calibration.json").read_text())
    data["later"] = data["baseline"]["later"] = data["baseline"]["parameters"]["column.Ca_t"]["later"] = {"a": 1}
    (tmp_path / "calibration.json").write_text(json.dumps(data))
    assert read_saved(tmp_path) == read_saved(written)
    jsonschema.validate(data, json.loads(SCHEMAS[0].read_text()))


def test_the_document_says_what_the_contract_says(result: Calibration, written: Path) -> None:
    read = json.loads((written / "calibration.json").read_text())
    assert {"campaign", "jaxhydro", "baseline"} <= set(read)
    baseline = read["baseline"]
    assert baseline["converged"] is True
    assert baseline["objective"]["fit"] == pytest.approx(result.objective("fit"))
    assert baseline["objective"]["holdout"] == pytest.approx(result.objective("holdout"))
    parameter = baseline["parameters"]["column.Ca_t"]
    assert (parameter["value"], parameter["start"], parameter["unit"], parameter["identifiable"]) == (1.48, 1.0, "-", True)
    assert parameter["meaning"] and parameter["standard_deviation"] == pytest.approx(0.0148)
    lost = baseline["parameters"]["linear_damping.B33"]
    assert lost["standard_deviation"] is None and lost["identifiable"] is False and lost["unit"] == "N s/m"
    assert baseline["parameters"]["column.Cd_z"]["at_bound"] is True
    surge, pitch = baseline["error"]["surge-1"], baseline["error"]["pitch-1"]
    assert (surge["use"], surge["surge"]["unit"], surge["surge"]["in_objective"]) == ("fit", "m", True)
    assert (pitch["use"], pitch["pitch"]["unit"], pitch["surge"]["in_objective"]) == ("holdout", "deg", False)
    assert pitch["pitch"]["rmse"] == pytest.approx(np.rad2deg(result.tests[2].main.rmse))
    assert surge["surge"]["before"]["relative"] > surge["surge"]["relative"]
    assert read["tests"]["heave-1"]["kind"] == "decay"


def test_what_is_not_finite_is_null_or_left_out_or_refused(result: Calibration) -> None:
    lost = changed(result, 2, simulated=np.full_like(result.tests[2].main.simulated, np.nan))
    read = document(lost).model_dump(mode="json", exclude_unset=True)
    assert read["baseline"]["objective"]["holdout"] is None
    assert set(read["baseline"]["error"]["pitch-1"]) == {"use", "surge", "heave"}
    json.dumps(read, allow_nan=False)
    jsonschema.validate(read, json.loads(SCHEMAS[0].read_text()))
    with pytest.raises(NotFinite, match="fitted test"):
        document(changed(result, 0, simulated=np.full_like(result.tests[0].main.simulated, np.inf)))
    with pytest.raises(NotFinite, match=r"column\.Ca_t"):
        parameters = {**result.parameters, "column.Ca_t": replace(result.parameters["column.Ca_t"], value=np.nan)}
        document(replace(result, parameters=parameters))
    only = replace(result, tests=result.tests[:2])
    assert document(only).baseline.objective.holdout is None


def test_a_written_result_is_read_back(result: Calibration, written: Path) -> None:
    values = read_values(written / "calibration.json")
    assert values == {label: parameter.value for label, parameter in result.parameters.items()} == read_values(written)
    assert read_saved(written).baseline.error["surge-1"].channels["surge"].unit == "m"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{", "line 1, column 2: expected valid JSON"),
        ("[]", "expected a mapping of keys to values, found list"),
        ('{"campaign": "a", "jaxhydro": "0"}', "baseline: expected a mapping"),
        ('{"campaign": 1, "jaxhydro": "0", "baseline": {}}', "campaign: expected text, found 1"),
        ("[" * 100_000, "nested too deeply"),
    ],
)
def test_a_result_that_is_none_is_told(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "calibration.json").write_text(text)
    with pytest.raises(InputError) as caught:
        read_saved(tmp_path)
    assert words in str(caught.value) and "calibration.json" in str(caught.value)


# --- simulated.nc


def test_the_series_are_on_one_time_axis_with_units(result: Calibration, written: Path) -> None:
    with xr.open_dataset(written / "simulated.nc") as data:
        assert data.measured.dims == ("test", "channel", "time")
        assert list(data.test.values) == ["surge-1", "heave-1", "pitch-1"]
        assert list(data.unit.values) == ["m", "m", "deg"]
        assert data.time.attrs["units"] == "s" and all("long_name" in data[name].attrs for name in data.data_vars)
        for test in result.tests:
            for series in test.series:
                selection = {"test": test.id, "channel": series.channel}
                factor = 180 / np.pi if series.channel == "pitch" else 1.0
                for name, values in (
                    ("measured", series.measured),
                    ("simulated", series.simulated),
                    ("before", test.start[series.channel]),
                ):
                    got = data[name].sel(selection).values
                    np.testing.assert_allclose(got[: len(values)], factor * values, atol=1e-12)
                    assert np.isnan(got[len(values) :]).all()
        assert data.attrs["sampling"] == "as recorded" and list(data.use.values) == ["fit", "fit", "holdout"]
        assert data.in_objective.sel(test="heave-1").values.tolist() == [0, 1, 0]


def test_tests_sampled_differently_are_interpolated_and_start_times_kept(result: Calibration) -> None:
    first, second = result.tests[:2]
    shifted = replace(second, time=1000.0 + second.time * 0.37)
    data = dataset(replace(result, tests=(first, shifted)))
    assert data.attrs["sampling"].startswith("interpolated")
    assert data.start_time.values.tolist() == [0.0, 1000.0]
    steps = np.diff(data.time.values)
    np.testing.assert_allclose(steps, 0.2 * 0.37)
    values = data.simulated.sel(test="heave-1", channel="heave").dropna("time")
    np.testing.assert_allclose(values.time[-1], shifted.time[-1] - 1000.0, atol=0.1)
    np.testing.assert_allclose(values.values[:500], shifted.main.simulated[:500], atol=1e-9)


# --- figures


def test_every_figure_is_half_a_page_wide_and_named_in_the_document(written: Path) -> None:
    listed = json.loads((written / "calibration.json").read_text())["figures"]
    names = {figure["file"] for figure in listed}
    assert names == {f"figures/{path.name}" for path in (written / "figures").iterdir()}
    assert {"figures/parameters.png", "figures/decay-surge.png", "figures/test-pitch-1.png"} <= names
    for figure in listed:
        assert figure["caption"]
        with Image.open(written / figure["file"]) as image:
            assert image.width == 1005 and 500 < image.height < 3000


def test_figures_of_odd_results_can_be_drawn(result: Calibration, tmp_path: Path) -> None:
    """Nothing before, one channel, nothing that oscillates, parameters at zero and far apart, no parameters."""
    first = result.tests[0]
    still = replace(first, start={}, series=(replace(first.main, measured=0 * first.time),))
    values = [(0.0, 0.0, "N", 0.0), (1e-9, 1e-10, "m", 1e6), (-5.0, np.inf, "N/m", 3.0), (1e8, None, "N", 2e3)]
    odd = [Estimate(f"a.{i}", *value[:3], "", value[3], False, True) for i, value in enumerate(values)]
    strange = replace(result, tests=(still,), parameters={estimate.label: estimate for estimate in odd})
    write_calibration(strange, tmp_path / "a")
    assert not (tmp_path / "a" / "figures" / "decay-surge.png").exists()
    write_calibration(replace(result, tests=result.tests[1:2], parameters={}), tmp_path / "b")
    write_report(tmp_path / "b")


# --- whole or not at all


def failing(*_: object) -> None:
    raise RuntimeError("no ink")


@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt])
def test_an_old_result_stays_when_plotting_fails(result, tmp_path, monkeypatch, error) -> None:
    folder = write_calibration(result, tmp_path / "out", figures=False)
    (folder / "mine.txt").write_text("keep")
    before = contents(tmp_path)

    def figures(_: Calibration):
        yield "parameters.png", "", plot.parameters_figure(list(result.parameters.values()))
        raise error("no ink")

    monkeypatch.setattr(plot, "figures", figures)
    with pytest.raises(error, match="no ink"):
        write_calibration(replace(result, campaign="new"), folder)
    assert contents(tmp_path) == before
    with pytest.raises(error):
        write_calibration(result, tmp_path / "other")
    assert contents(tmp_path) == before and not (tmp_path / "other").exists()


def test_an_old_result_stays_when_the_last_move_fails(result, tmp_path, monkeypatch) -> None:
    folder = write_calibration(result, tmp_path / "out", figures=False)
    before, moved, real = contents(tmp_path), [], os.replace

    def move(source, target):
        moved.append(target)
        if len(moved) == 4:  # the old calibration.json aside, the new one in, the old simulated.nc aside, and then
            raise OSError(28, "No space left on device")
        return real(source, target)

    monkeypatch.setattr(os, "replace", move)
    with pytest.raises(InputError, match="No space left"):
        write_calibration(replace(result, campaign="new"), folder, figures=False)
    assert contents(tmp_path) == before


@pytest.mark.slow
def test_a_new_result_replaces_the_old_one_and_nothing_else(result: Calibration, written: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(written, tmp_path / "out")
    write_report(folder)
    (folder / "figures" / "mine.png").write_bytes(b"keep")
    (folder / "notes.txt").write_text("keep")
    write_calibration(replace(result, tests=result.tests[:1], campaign="second"), folder)
    assert json.loads((folder / "calibration.json").read_text())["campaign"] == "second"
    figures = {path.name for path in (folder / "figures").iterdir()}
    assert figures == {"parameters.png", "decay-surge.png", "test-surge-1.png", "mine.png"}
    assert (folder / "notes.txt").read_text() == "keep"
    assert not (folder / "report.html").exists()  # it told of the old one
    assert not [path for path in [*folder.iterdir(), *tmp_path.iterdir()] if path.name.startswith(".")]
    (folder / "report.html").write_text("<html>my own</html>")
    write_calibration(result, folder, figures=False)
    assert (folder / "report.html").read_text() == "<html>my own</html>"
    assert {path.name for path in (folder / "figures").iterdir()} == {"mine.png"}


def test_an_old_list_of_figures_cannot_reach_out_of_the_folder(result: Calibration, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    (folder / "figures").mkdir(parents=True)
    (tmp_path / "precious.png").write_bytes(b"keep")
    listed = [{"file": "../precious.png"}, {"file": "../../precious.png"}, {"file": str(tmp_path / "precious.png")}, 3]
    for figures in (listed[:3], listed, "x", None):
        (folder / "calibration.json").write_text(json.dumps({"figures": figures}))
        write_calibration(replace(result, tests=result.tests[1:2]), folder, figures=False)
    assert (tmp_path / "precious.png").read_bytes() == b"keep"


def test_folders_that_cannot_be_are_told(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("keep")
    (tmp_path / "gone").symlink_to(tmp_path / "nowhere")
    for folder in (file, file / "below", tmp_path / "gone", tmp_path / ("x" * 300), "a\0b"):
        with pytest.raises(InputError, match="--out: expected a folder"):
            check_folder(folder)
    check_folder(tmp_path / "new" / "er")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file", "gone"]
    (tmp_path / "out" / "a.txt").mkdir(parents=True)
    with pytest.raises(InputError, match=r"a\.txt is a folder"), staged(tmp_path / "out") as temporary:
        (temporary / "a.txt").write_text("new")
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["a.txt"]


# --- the report


class Page(HTMLParser):
    """Tags in balance, what is linked but within the page, and the text without that of scripts."""

    VOID = frozenset({"meta", "img", "br", "link", "wbr", "input"})

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[str] = []
        self.links: list[str] = []
        self.text = ""
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        links = [value for name, value in attrs if name in ("src", "href", "srcset", "action")]
        self.links += [value for value in links if not value.startswith("#part-")]
        assert not [name for name, _ in attrs if name.startswith("on")]
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if "script" not in self.open:
            self.text += data


def test_the_report_is_one_page_that_needs_nothing_else(written: Path) -> None:
    path = write_report(written)
    page = Page(path.read_text(encoding="utf-8"))
    assert path == written / "report.html"
    assert page.tags.count("img") == len(list((written / "figures").iterdir())) == page.tags.count("figure")
    assert all(link.startswith("data:image/png;base64,") for link in page.links)
    assert not {"link", "iframe", "object"} & set(page.tags) and page.tags.count("script") in (0, 3)
    assert "http" not in page.text and "url(" not in path.read_text() and "@import" not in path.read_text()
    passages = (
        "volturnus-s-decays",
        "2 decays followed to",
        "1 held-out decay",
        "9 of 11 coefficients determined",
        "not determined: linear_damping.B33; at a bound: column.Cd_z",
        "Parameters",
        "1.480 ± 0.015",
        "at its bound",
        "linear damping in surge",
        "not determined",
        "Tests",
        "surge-1",
        "free decay in heave",
        "held out",
        "Other motions, which do not count in the fit (6)",
        "Damping by classical analysis",
        "1/rad",
        "Notes",
        "stays near its starting value",
        "Figures",
    )
    places, at = [], 0
    for words in passages:
        at = page.text.find(words, at)
        places.append(at)
    assert -1 not in places, list(zip(passages, places))
    assert page.text.count("1.70·10⁵") == page.text.count("(1.70·10⁵)") == 1  # a value that the records do not determine
    assert page.tags.count("details") == 1 and "true coefficients" not in page.text


def test_the_page_has_the_classical_damping_and_the_truth_of_the_file(result: Calibration, tmp_path: Path) -> None:
    """Measured and simulated, as the analysis of the motions has them; schema and older files are none the worse for it."""
    folder = write_calibration(result, tmp_path / "out", figures=False, truth={"column.Ca_t": 1.5})
    read = json.loads((folder / "calibration.json").read_text())
    for path in SCHEMAS:
        if path.exists():
            jsonschema.Draft202012Validator(json.loads(path.read_text())).validate(read)
    test = result.tests[2]
    fits = [classical(test.time, x, test.main.noise).fit for x in (test.main.measured, test.main.simulated)]
    damping = read["tests"]["pitch-1"]["linear_quadratic"]
    assert damping["unit"] == "rad" and damping["period"] == pytest.approx(fits[0].period)
    assert damping["quadratic"]["measured"] == pytest.approx(fits[0].quadratic.value)
    assert damping["quadratic"]["simulated"] == pytest.approx(fits[1].quadratic.value)
    assert damping["linear"]["half_width"] == pytest.approx(fits[0].linear.upper - fits[0].linear.value)
    page = Page(write_report(folder).read_text(encoding="utf-8")).text
    assert with_deviation(damping["quadratic"]["measured"], damping["quadratic"]["half_width"]) in page
    assert "Against the true coefficients" in page and "0 of 1 coefficients lie" not in page and "-1.4 sd" in page
    read.pop("truth")
    read["tests"]["pitch-1"].pop("linear_quadratic")
    (folder / "calibration.json").write_text(json.dumps(read))
    page = Page(write_report(folder).read_text(encoding="utf-8")).text
    assert "true coefficients" not in page and "1/rad" not in page and "1/m" in page


def test_a_page_of_a_fit_in_waves_has_its_bands(result: Calibration, tmp_path: Path) -> None:
    """Errors of energy before and after; J is not called what was fitted; what is no number is told where."""
    bands = {"surge": {"low_frequency": BandError(0.21, -0.69, 0.005, 0.025)}}
    sea = replace(result.tests[0], kind="irregular", degree_of_freedom=None, bands=bands)
    folder = write_calibration(replace(result, tests=(sea, *result.tests[1:])), tmp_path / "out", figures=False)
    page = Page(write_report(folder).read_text(encoding="utf-8")).text
    assert "Errors of energy in bands" in page and "low frequency" in page and "-69 %" in page and "+21 %" in page
    assert "Objective J" not in page and "fitted by the objective that was asked for" in page
    data = json.loads((folder / "calibration.json").read_text())
    data["baseline"]["error"][sea.id]["bands"]["surge"]["low_frequency"] = "much"
    (folder / "calibration.json").write_text(json.dumps(data))
    with pytest.raises(InputError, match=f"baseline.error.{sea.id}.*surge.low_frequency"):
        write_report(folder)


def test_the_report_escapes_what_comes_from_files(result: Calibration, tmp_path: Path) -> None:
    evil = '<script>alert("1")</script><img src=x onerror=alert(1)>&amp; $title'
    first = result.parameters["column.Ca_t"]
    tests = (replace(result.tests[0], id=evil), result.tests[1])
    strange = replace(
        result,
        campaign=evil,
        tests=tests,
        notes=(evil,),
        converged=False,
        parameters={evil: replace(first, label=evil, unit=evil, meaning=evil)},
    )
    folder = write_calibration(strange, tmp_path / "out", figures=False)
    (folder / "figures").mkdir()
    Image.new("RGB", (3, 3)).save(folder / "figures" / "a&<b>.png")
    (folder / "figures" / "fake.png").write_bytes(b"<script>")
    page = Page(write_report(folder).read_text(encoding="utf-8"))
    assert page.tags.count("script") in (0, 3) and page.tags.count("img") == 1  # those of the page itself
    assert page.text.count(evil) >= 5 and "a&<b>.png" in page.text
    assert "did not converge" in page.text


def test_no_report_without_results(tmp_path: Path) -> None:
    for folder, words in ((tmp_path, "found no calibration.json"), (tmp_path / "none", "found no such folder")):
        with pytest.raises(InputError, match=words):
            write_report(folder)
    assert not list(tmp_path.iterdir())
    (tmp_path / "results.zarr").mkdir()
    with pytest.raises(InputError, match="the same `jaxhydro sweep` goes on"):
        write_report(tmp_path)


# --- notes


def test_decays_of_one_motion_that_are_not_followed_make_one_note(result: Calibration) -> None:
    first, heave = result.tests[:2]
    still = tuple(replace(series, simulated=np.zeros_like(series.simulated)) for series in first.series)
    lost = [replace(first, id=f"surge-{i}", series=still) for i in (1, 2)]
    (note,) = records_not_followed([*lost, heave, replace(lost[0], use="holdout")], result.model)
    assert note.startswith("the model does not follow surge-1 and surge-2: the RMSE is 100 % of the motion's standard")
    assert re.search(r"Period in surge: measured 13\d s, of the platform file 1\d\d s\. Check scale", note)
    assert records_not_followed([first, heave], result.model) == []


# --- numbers


def test_numbers_as_people_read_them() -> None:
    assert [number(x) for x in (0.0, 1.0, 43938.4, 2e5, -0.000123, None, np.nan)] == [
        "0",
        "1.000",
        "43938",
        "2.000·10⁵",
        "-1.230·10⁻⁴",
        "–",
        "–",
    ]
    assert with_deviation(1.5123, 0.0131) == "1.512 ± 0.013"
    assert with_deviation(3.6292e8, 5.3e5) == "(3.6292 ± 0.0053)·10⁸"
    assert with_deviation(0.2, 30.0) == "0 ± 30"
    assert with_deviation(2.0, None) == with_deviation(2.0, 0.0) == "2.000"
    assert [percent(x) for x in (0.0123, 2.5, 99.0, 1e9, -1e9)] == ["1.2 %", "250 %", "9900 %", "> 10000 %", "< -10000 %"]
    assert [percent(x) for x in (np.inf, np.nan, None)] == ["–", "–", "–"]
    assert outputs.RESULT_FILE == "calibration.json"
