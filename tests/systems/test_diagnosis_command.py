"""`jaxhydro diagnose`: what it prints and writes, its exit statuses; and its values used in a simulation."""

import json
import re
import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fake_diagnosis import fake_diagnosis
from test_cli import small_campaign
from test_outputs import Page, changed
from typer.testing import CliRunner

import jaxhydro as jh
from calibration.discovery.diagnosis import Diagnosis
from calibration.fitting.progress import Interrupted, Progress
from calibration.report.write_report import write_report
from calibration.residuals.measured_seas import Diverged
from calibration.residuals.wave_options import Options
from calibration.results.applied_calibration import apply_calibration
from calibration.results.calibration_file import read_saved
from calibration.results.diagnosis_file import read_diagnosis
from calibration.results.strip_conventions import DEFAULT_STRIPS, StripConventions
from calibration.results.write_calibration import write_calibration
from calibration.results.write_diagnosis import write_diagnosis
from jaxhydro.cli import app as cli
from jaxhydro.cli import model_commands
from jaxhydro.errors import InputError, Problem

DEMO = Path(jh.__file__).parent / "campaigns" / "volturnus-s-decays"
FORCE = "coulomb_friction.surge.force"


@pytest.fixture(scope="module")
def result() -> Diagnosis:
    return fake_diagnosis()


@pytest.fixture(scope="module")
def written(result: Diagnosis, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_diagnosis(result, tmp_path_factory.mktemp("results"), figures=False)


@pytest.fixture(scope="module")
def one_decay(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A campaign that is soon read."""
    return small_campaign(tmp_path_factory.mktemp("small") / "campaign")


# --- the command


def run(*arguments: object, status: int = 0) -> str:
    result = CliRunner().invoke(cli.app, [str(word) for word in arguments])
    text = " ".join(re.sub("[│╭╮╰╯─]", " ", result.output).split())
    assert result.exit_code == status and "Traceback" not in text, text
    return text


@pytest.fixture
def searching(monkeypatch: pytest.MonkeyPatch, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """What `diagnose` gives or raises is set by the test."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.getbasetemp() / "cache"))
    outcome: dict[str, Any] = {}

    def diagnose(model, campaign, *, progress=None, options=None, checkpoint=None):
        progress(Progress("reading the records", 0, float("nan"), 0.0, "-2 ln L"))
        progress(Progress("scoring", 1, 812.0, 0.4, "-2 ln L"))
        if isinstance(outcome["it"], BaseException):
            raise outcome["it"]
        return outcome["it"]

    monkeypatch.setitem(sys.modules, "calibration.discovery.diagnose", SimpleNamespace(diagnose=diagnose))
    return outcome


@pytest.mark.slow
def test_diagnose_prints_and_writes(searching, result: Diagnosis, tmp_path: Path) -> None:
    searching["it"] = result
    text = run("diagnose", DEMO, "--out", tmp_path / "o")
    for passage in (
        "9 tests fitted",
        "reading the records scoring: iteration 1, -2 ln L = 812",
        "The model lacks Coulomb friction in surge",
        "(81.0 ± 2.1) kN",
        "very strong",
        "hysteresis in surge improbable (2 %)",
        "surge-3 held out surge 12 % 1.9 %",
        "Note: surge-2 repeats",
        "sea-1 fitted surge low frequency -24 % -3 %",
        "Next test: a static pull-out",
    ):
        assert passage in text, passage
    assert {path.name for path in (tmp_path / "o").iterdir()} == {"diagnosis.json", "simulated.nc", "figures"}
    assert "report.html" in run("report", tmp_path / "o")
    run("diagnose", DEMO / "campaign.yaml", "--no-figures", "--out", tmp_path / "p")
    assert {path.name for path in (tmp_path / "p").iterdir()} == {"diagnosis.json", "simulated.nc"}


@pytest.mark.parametrize(
    ("outcome", "status", "expected", "written"),
    [
        ("unconverged", 3, "not converged: the results are marked so", True),
        ("stopped", 3, "the same command goes on from what was reached", True),
        ("stopped at once", 130, "nothing was written", False),
        ("stopped in the first fit", 130, "nothing was written", False),
        ("killed", 130, "nothing was written", False),
        ("not finite", 3, "not finite; nothing was written", False),
        ("diverged", 3, "surge grows; nothing was written", False),
        ("bad", 2, "tests: expected at least one, found none", False),
    ],
)
def test_what_does_not_converge(searching, one_decay, outcome, status, expected, written, tmp_path) -> None:
    good = fake_diagnosis()
    stopped = Interrupted(None)
    stopped.partial = good  # type: ignore[assignment]
    searching["it"] = {
        "unconverged": fake_diagnosis(converged=False),
        "stopped": stopped,
        "stopped at once": Interrupted(None),
        "stopped in the first fit": Interrupted(good.baseline),
        "killed": KeyboardInterrupt(),
        "diverged": Diverged("surge grows"),
        "not finite": replace(good, baseline=changed(good.baseline, 0, simulated=np.full(2400, np.nan))),
        "bad": InputError("campaign.yaml", [Problem("tests", "at least one", "none")]),
    }[outcome]
    assert expected in run("diagnose", one_decay, "--no-figures", "--out", tmp_path / "o", status=status)
    assert (tmp_path / "o").exists() == written and not [path for path in tmp_path.iterdir() if path.name.startswith(".")]
    if written:
        content = json.loads((tmp_path / "o" / "diagnosis.json").read_text())
        assert content["augmented"]["converged"] is False and content["complete"] is (outcome != "stopped")
        marked = "Stopped by the user before it was done" if outcome == "stopped" else "did not converge"
        assert marked in Page(write_report(tmp_path / "o").read_text()).text


def test_a_stopped_search_does_not_say_that_nothing_is_missing(searching, one_decay, result: Diagnosis, tmp_path: Path) -> None:
    """Only a whole one does; what a stopped one had found stays found."""
    run_with = {"nothing_missing": replace(result, verdict="nothing_missing", effects=()), "found": result}
    for verdict, partial in run_with.items():
        stopped = Interrupted(None)
        stopped.partial = partial  # type: ignore[assignment]
        searching["it"] = stopped
        text = run("diagnose", one_decay, "--no-figures", "--out", tmp_path / verdict, status=3)
        saved = read_diagnosis(tmp_path / verdict)
        assert not saved.complete and saved.missing.verdict == ("found" if verdict == "found" else "unexplained")
        ended = "found until the search was stopped" if verdict == "found" else "The search did not come to its end"
        assert ended in text and "nothing that the model lacks" not in text
    searching["it"] = result
    run("diagnose", one_decay, "--no-figures", "--out", tmp_path / "whole")
    assert read_diagnosis(tmp_path / "whole").complete


def test_results_do_not_replace_those_of_other_commands(searching, one_decay, result: Diagnosis, tmp_path: Path) -> None:
    searching["it"] = result
    diagnosis_folder = write_diagnosis(result, tmp_path / "mine", figures=False)
    calibration_folder = write_calibration(result.baseline, tmp_path / "theirs", figures=False)
    assert "which has the results of a diagnosis" in run("calibrate", one_decay, "--out", diagnosis_folder, status=2)
    assert "which has the results of a calibration" in run("diagnose", one_decay, "--out", calibration_folder, status=2)
    (calibration_folder / "simulated.nc").unlink()
    assert "which has the results of a calibration" in run("diagnose", one_decay, "--out", calibration_folder, status=2)
    run("diagnose", one_decay, "--no-figures", "--out", diagnosis_folder)
    assert "no such folder" in run("diagnose", tmp_path / "none", "--out", tmp_path / "o", status=2)
    assert not (tmp_path / "o").exists()


# --- its values in a simulation


def saved_with(written: Path, folder: Path, values: dict[str, float], platform: str) -> Path:
    """The diagnosis with other augmented values and another platform."""
    content = json.loads((written / "diagnosis.json").read_text()) | {"platform": platform}
    content["augmented"]["parameters"] = {label: {"value": value, "unit": "-"} for label, value in values.items()}
    (folder / "diagnosis.json").write_text(json.dumps(content))
    return folder / "diagnosis.json"


def test_simulations_have_the_effects_that_were_found(written: Path, tmp_path: Path, capsys) -> None:
    model = jh.load_model(str(DEMO / "platform.yaml"))
    platform = "VolturnUS-S"
    path = saved_with(written, tmp_path, {"column.Ca_t": 1.5, FORCE: 81000.0, "mass_properties.mass": 1e5}, platform)
    used = apply_calibration(path, model, platform)
    assert float(used.model.values[FORCE]) == 81000.0 and float(used.model.values["column.Ca_t"]) == 1.5
    assert len(used.model.loads) == len(model.loads) + 2 and read_saved(tmp_path).key == "augmented"
    elsewhere = apply_calibration(path, model, "another")
    assert elsewhere.not_used == ("mass_properties.mass",) and FORCE in elsewhere.values
    fitted = model_commands._model(str(DEMO / "platform.yaml"), path, None, None)
    assert float(fitted.values["mass_properties.mass"]) == 1e5 and FORCE in capsys.readouterr().out


@pytest.mark.slow
def test_simulations_have_the_strips_and_seas_that_were_taken(
    result: Diagnosis, one_decay, tmp_path, capsys, monkeypatch
) -> None:
    """In words of a platform file, and said where it says otherwise; seas are a campaign's."""
    simpler, seas = (
        StripConventions(directions="earth", drag_speed="component", centripetal=False),
        Options(acting="at the origin"),
    )
    write_diagnosis(replace(result, seas=seas), tmp_path, figures=False)
    model, path = jh.load_model(str(DEMO / "platform.yaml")), tmp_path / "diagnosis.json"
    content = json.loads(path.read_text()) | {"strips": simpler.model_dump()}  # as files of earlier versions have it
    content["augmented"]["parameters"] = {"column.Ca_t": {"value": 1.5, "unit": "-"}}
    path.write_text(json.dumps(content))
    used = apply_calibration(path, model, "VolturnUS-S")
    assert (
        (used.strips, used.seas) == (simpler, seas)
        and StripConventions.of(used.model) == simpler
        and StripConventions.of(model) == DEFAULT_STRIPS
    )
    assert (
        apply_calibration(path, used.model, "VolturnUS-S").strips is None
        and StripConventions.of(DEFAULT_STRIPS.applied_to(used.model)) == DEFAULT_STRIPS
    )
    assert StripConventions.of(model_commands._model(str(DEMO / "platform.yaml"), path, None, None)) == simpler
    assert "directions: earth, drag_speed: component, centripetal: false" in capsys.readouterr().out
    begun: list[Any] = []
    monkeypatch.setattr(
        "calibration.commands.calibrate_command.calibrate", lambda _, **how: begun.append(how["start"]) or result.baseline
    )
    assert "has directions: earth" in run("calibrate", one_decay, "--start", path, "--out", tmp_path / "o")
    assert begun == [{"column.Ca_t": 1.5}]
    wrong = {"strips": content["strips"] | {"directions": "up"}, "seas": content["seas"] | {"acting": "there"}}
    path.write_text(json.dumps(content | wrong))
    with pytest.raises(InputError, match=r"expected one of body, earth, found .up.\n  seas.acting: expected one of every"):
        read_saved(path)


def test_effects_are_added_for_what_the_model_has_not(written: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    requests = []

    def with_effects(model, labels):
        requests.append(list(labels))
        return model

    monkeypatch.setattr("calibration.discovery.effects.candidates.with_effects", with_effects)
    model = jh.load_model(str(DEMO / "platform.yaml"))
    path = saved_with(written, tmp_path, {"column.Ca_t": 1.5, FORCE: 81000.0}, "VolturnUS-S")
    with pytest.raises(InputError, match=r"augmented\.parameters: expected parameters of this hull .* found 'coulomb_friction"):
        apply_calibration(path, model, "this hull")
    assert requests == [[FORCE]]


def test_effects_of_another_version_are_told(written: Path, tmp_path: Path) -> None:
    path = saved_with(written, tmp_path, {"ghosts.surge": 1.0}, "VolturnUS-S")
    model = jh.load_model(str(DEMO / "platform.yaml"))
    with pytest.raises(InputError, match=r"this version knows, found no effect with the parameter 'ghosts\.surge'"):
        apply_calibration(path, model, "VolturnUS-S")
