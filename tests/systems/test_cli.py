"""The command line: what it writes, its exit statuses, and an answer in words for every bad input."""

import json
import re
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from fake_calibration import DEMO, small
from typer.testing import CliRunner

import jaxhydro
from calibration.results.write_calibration import write_calibration
from jaxhydro.cli import app as cli
from jaxhydro.cli.campaign_commands import TRUTH
from jaxhydro.cli.options import new_folder

PLATFORM = DEMO / "platform.yaml"
RUNNER = CliRunner()


@pytest.fixture(autouse=True)
def cache(monkeypatch: pytest.MonkeyPatch, tmp_path_factory: pytest.TempPathFactory) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.getbasetemp() / "cache"))


def run(*words: object, status: int = 0) -> str:
    """The output of a command in one line, after a check of its exit status."""
    result = RUNNER.invoke(cli.app, [str(word) for word in words])
    text = " ".join(re.sub("[│╭╮╰╯─]", " ", result.output).split())
    assert result.exit_code == status, text
    assert isinstance(result.exception, SystemExit | None) and "Traceback" not in text
    return text


def result_with(folder: Path, **parameters: float) -> Path:
    folder.mkdir(exist_ok=True)
    path = folder / "calibration.json"
    entries = {label: {"value": value, "unit": "-"} for label, value in parameters.items()}
    baseline = {"parameters": entries, "error": {}, "objective": {"fit": 1.0}, "converged": True}
    path.write_text(json.dumps({"campaign": "a", "jaxhydro": "0.1.0", "baseline": baseline}))
    return path


# --- what it says


def test_help_and_version() -> None:
    text = run("--help")
    for words in ("jaxhydro demo --out demo", "jaxhydro simulate volturnus-s", "jaxhydro calibrate my-campaign"):
        assert words in text
    for command in ("simulate", "check", "calibrate", "diagnose", "report", "demo", "platforms", "schema"):
        assert command in text and "--help" in run(command, "--help")
    assert run("--version") == f"jaxhydro {jaxhydro.__version__}"
    assert "Usage" in run(status=2)


def test_it_starts_as_a_module_without_what_is_heavy() -> None:
    start = [sys.executable, "-X", "importtime", "-m", "jaxhydro", "--version"]
    done = subprocess.run(start, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == f"jaxhydro {jaxhydro.__version__}"
    imported = {line.rpartition("|")[2].strip() for line in done.stderr.splitlines()}
    assert "jaxhydro.cli.app" in imported and not {"matplotlib", "xarray", "calibration"} & imported


# --- simulate


def test_simulate_writes_a_free_decay(tmp_path: Path) -> None:
    release = ["--release", "surge=3", "--release", "pitch=2"]
    text = run("simulate", PLATFORM, *release, "--duration", 60, "--out", tmp_path / "o")
    assert "Natural periods" in text and "surge" in text and "Results are in" in text
    table = pd.read_csv(tmp_path / "o" / "motion.csv")
    assert list(table.columns) == [
        "time_s",
        "surge_m",
        "sway_m",
        "heave_m",
        "roll_deg",
        "pitch_deg",
        "yaw_deg",
    ]
    assert len(table) == 601 and table.time_s.iloc[-1] == pytest.approx(60.0)
    assert table.surge_m[0] == pytest.approx(3.0, abs=1e-3) and table.pitch_deg[0] == pytest.approx(2.0, abs=1e-3)
    with xr.open_dataset(tmp_path / "o" / "simulated.nc") as data:
        assert list(data.unit.values) == ["m", "m", "m", "deg", "deg", "deg"]
        np.testing.assert_allclose(data.simulated.sel(channel="pitch"), table.pitch_deg, atol=1e-7)
    assert (tmp_path / "o" / "figures" / "motion.png").stat().st_size > 1000


def test_a_campaign_has_no_further_format(tmp_path: Path) -> None:
    text = run("simulate", small_campaign(tmp_path / "a"), "--format", "outb", status=2)
    assert "--format: it goes with a platform" in text


def test_simulate_in_regular_waves_with_calibrated_values(tmp_path: Path) -> None:
    waves = ["--wave-height", 2, "--wave-period", 9, "--heading", 60, "--duration", 120]
    text = run("simulate", PLATFORM, *waves, "--format", "netcdf", "--format", "outb", "--out", tmp_path / "a")
    assert {"motion.csv", "motion.nc", "motion.outb"} <= {path.name for path in (tmp_path / "a").iterdir()}
    assert "Amplitude at 9 s" in text and "per m of wave amplitude" in text
    first = pd.read_csv(tmp_path / "a" / "motion.csv")
    assert first.wave_m.abs().max() == pytest.approx(1.0, rel=1e-2)
    assert first.sway_m.std() == pytest.approx(np.tan(np.pi / 3) * first.surge_m.std(), rel=0.02)  # by symmetry
    values = result_with(tmp_path, **{"column.Ca_t": 2.0})
    saved = json.loads(values.read_text())
    saved["baseline"]["converged"] = False
    values.write_text(json.dumps(saved))
    text = run("simulate", PLATFORM, *waves, "--calibration", values, "--out", tmp_path / "b")
    assert "Calibrated values used: column.Ca_t" in text and "calibration.json did not converge" in text
    second = pd.read_csv(tmp_path / "b" / "motion.csv")
    assert np.abs(second.sway_m - first.sway_m).max() > 0.05 * first.sway_m.std()


def test_a_motion_beyond_all_bounds_is_not_written(tmp_path: Path) -> None:
    options = ["--release", "heave=3", "--duration", 2000, "--step", 60, "--dt", 10]
    text = run("simulate", PLATFORM, *options, "--out", tmp_path / "o", status=3)
    assert "beyond all bounds" in text and "--step" in text and not (tmp_path / "o").exists()


BAD_OPTIONS = [
    (["--release", "surg=5"], "--release: a motion (surge, sway, heave, roll, pitch, yaw)"),
    (["--release", "surg=5"], "Did you mean 'surge'?"),
    (["--release", "surge"], "a number after surge= expected, found ''"),
    (["--release", "surge=five"], "found 'five'"),
    (["--release", "surge=nan"], "found 'nan'"),
    (["--release", "surge=1", "--release", "surge=2"], "surge is given twice"),
    (["--release", "pitch=120"], "less than 90 deg expected"),
    ([], "nothing moves: give --release"),
    (["--wave-height", "2"], "belong together"),
    (["--wave-height", "-2", "--wave-period", "9"], "--wave-height: a number > 0 expected, found -2"),
    (["--wave-height", "2", "--wave-period", "9", "--heading", "inf"], "a finite number expected"),
    (["--release", "surge=1", "--duration", "0"], "--duration: a number > 0 expected"),
    (["--release", "surge=1", "--duration", "nan"], "found nan"),
    (["--release", "surge=1", "--dt", "1e-9"], "for a duration of 600 s"),
    (["--release", "surge=1", "--dt", "700"], "found 700"),
    (["--release", "surge=1", "--step", "-1"], "--step"),
    (["--release", "surge=1", "--duration", "ten"], "Invalid value for '--duration'"),
    (["--hx", "3"], "No such option: --hx"),
]


@pytest.mark.parametrize(("options", "words"), BAD_OPTIONS, ids=[" ".join(o) or "none" for o, _ in BAD_OPTIONS])
def test_bad_options_are_told(tmp_path: Path, options: list[str], words: str) -> None:
    assert words in run("simulate", PLATFORM, *options, "--out", tmp_path / "o", status=2)
    assert not (tmp_path / "o").exists()


def test_bad_platforms_are_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def equilibrium(model):
        raise jaxhydro.EquilibriumError("no static equilibrium: heave is out of balance by 0.3 of the weight")

    monkeypatch.setattr("jaxhydro.cli.model_messages.equilibrium", equilibrium)
    broken = tmp_path / "broken.yaml"
    broken.write_text(PLATFORM.read_text().replace("density", "densty"))
    for name, words in (
        ("volturnus", "Did you mean 'volturnus-s'?"),
        (tmp_path / "none.yaml", "expected a YAML file, found no such file"),
        (broken, "water.densty: expected a known key"),
        (PLATFORM, "no static equilibrium: heave is out of balance"),
    ):
        text = run("simulate", name, "--release", "surge=1", "--out", tmp_path / "o", status=2)
        assert words in text and "jaxhydro:" in text
    assert not (tmp_path / "o").exists()


def test_a_wave_that_breaks_is_told(tmp_path: Path) -> None:
    text = run("simulate", PLATFORM, "--wave-height", 30, "--wave-period", 5, "--out", tmp_path / "o", status=2)
    assert "--wave-height: expected a wave that does not break" in text and "5.54 m" in text


def test_bad_calibrations_are_told(tmp_path: Path) -> None:
    broken = tmp_path / "broken.json"
    broken.write_text("{")
    unknown = result_with(tmp_path, **{"column.Ca_x": 1.0, "column.Cd_t": 1.0})
    out_of_range = result_with(tmp_path / "range", **{"column.Cd_t": -1.0})
    for path, words in (
        (tmp_path / "none.json", "found no such file"),
        (broken, "expected valid JSON"),
        (unknown, "expected parameters of"),
        (unknown, "found 'column.Ca_x'. Did you mean 'column.Ca_"),
        (out_of_range, "column.Cd_t.value: expected a number between 0 and 30, found -1"),
        (result_with(tmp_path / "empty"), "expected at least one calibrated parameter, found none"),
    ):
        options = ["--release", "surge=1", "--calibration", path, "--out", tmp_path / "o"]
        assert words in run("simulate", PLATFORM, *options, status=2)


@pytest.mark.parametrize("command", ["simulate", "calibrate", "demo"])
def test_folders_that_cannot_be_written_are_told_before_the_work(command, tmp_path, monkeypatch) -> None:
    for work in ("jaxhydro.cli.model_commands._model", "calibration.commands.calibrate_command.load_fitted"):
        monkeypatch.setattr(work, lambda *_: pytest.fail("the work began"))
    arguments = {"simulate": [PLATFORM, "--release", "surge=1"], "calibrate": [DEMO], "demo": []}[command]
    file = tmp_path / "file"
    file.write_text("keep")
    for out in (file, file / "below", tmp_path / ("x" * 300)):
        assert "--out: expected a folder" in run(command, *arguments, "--out", out, status=2)
    assert [path.name for path in tmp_path.iterdir()] == ["file"] and file.read_text() == "keep"


def test_results_without_a_folder_go_to_a_new_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is overwritten; a job that was stopped, which has no results yet, goes on in its folder."""
    monkeypatch.chdir(tmp_path)
    job = ("simulate", "volturnus-s", "--release", "surge=1", "--duration", 60, "--no-figures")  # a compiled size of above
    (tmp_path / "volturnus-s-simulation").mkdir()
    assert run(*job).endswith("Results are in volturnus-s-simulation")
    first = (tmp_path / "volturnus-s-simulation" / "motion.csv").read_text()
    assert run(*job).endswith("Results are in volturnus-s-simulation-2")
    assert (tmp_path / "volturnus-s-simulation" / "motion.csv").read_text() == first
    for source in ("basin", "basin/campaign.yaml", "basin/platform.yaml", "other/../basin.yaml"):
        assert new_folder(source, "diagnosis.json") == Path("basin-diagnosis")
    assert new_folder(".", "calibration.json") == Path(f"{tmp_path.name}-calibration")


def test_missing_and_unknown_words_are_usage_errors(tmp_path: Path) -> None:
    assert "Missing argument" in run("calibrate", "--out", tmp_path, status=2)
    assert "No such command 'calibrat'" in run("calibrat", status=2)


# --- calibrate, demo, report


@pytest.fixture
def fitted(monkeypatch: pytest.MonkeyPatch) -> None:
    """A fit that takes no time."""
    command = pytest.importorskip("calibration.commands.calibrate_command")
    progress_module = pytest.importorskip("calibration.fitting.progress")

    def calibrate(campaign, progress):
        for i in range(3):
            progress(progress_module.Progress("first cycles" if i < 2 else "whole records", i + 1, 3.0 / (i + 1), i / 3))
        return small()

    monkeypatch.setattr(command, "calibrate", calibrate)


def test_calibrate_prints_and_writes(fitted, tmp_path: Path) -> None:
    text = run("calibrate", DEMO, "--out", tmp_path / "o")
    for words in (
        "9 tests fitted",
        "first cycles: iteration 1, J = 3",
        "1.480 ± 0.015",
        "not determined",
        "at its bound",
        "held out",
        "converged after 12 iterations",
        "Note: linear_damping.B33",
        f"Results are in {tmp_path}",
    ):
        assert words in text, words
    assert re.search(r"2 decays followed to [^;]*; 1 held-out decay [^;]*; 9 of 11 .*at a bound: column\.Cd_z\.$", text.strip())
    assert {path.name for path in (tmp_path / "o").iterdir()} == {"calibration.json", "simulated.nc", "figures"}
    assert "report.html" in run("report", tmp_path / "o")
    assert (tmp_path / "o" / "report.html").exists()
    run("calibrate", small_campaign(tmp_path / "a") / "campaign.yaml", "--no-figures", "--out", tmp_path / "p")
    assert {path.name for path in (tmp_path / "p").iterdir()} == {"calibration.json", "simulated.nc"}


@pytest.mark.slow
def test_the_demo_compares_with_the_truth_and_makes_the_page(fitted, tmp_path: Path) -> None:
    text = run("demo", "--out", tmp_path / "o")
    assert "Against the true coefficients" in text and "-1.3 %" in text and "-1.4 sd" in text
    assert "Against the true coefficients" in (tmp_path / "o" / "report.html").read_text()
    sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
    from benchmarks.make_demo_campaign import TRUE_COEFFICIENTS, TRUE_DAMPING

    truth = {f"{group}.{name}": v for group, row in TRUE_COEFFICIENTS.items() for name, v in row.items()}
    assert truth | {f"linear_damping.{name}": v for name, v in TRUE_DAMPING.items()} == TRUTH


@pytest.mark.parametrize(
    ("outcome", "status", "words", "written"),
    [
        ("unconverged", 3, "not converged: the results are marked so", True),
        ("stopped", 3, "stopped by the user", True),
        ("stopped at once", 130, "nothing was written", False),
        ("killed", 130, "nothing was written", False),
        ("diverged", 3, "not finite; nothing was written", False),
    ],
)
def test_what_does_not_converge(outcome, status, words, written, monkeypatch, tmp_path) -> None:
    command = pytest.importorskip("calibration.commands.calibrate_command")
    good = small()
    first = good.tests[0]
    nowhere = replace(first, series=(replace(first.main, simulated=first.main.simulated * np.nan),))

    def calibrate(campaign, progress):
        if outcome == "unconverged":
            return replace(good, converged=False)
        if outcome == "diverged":
            return replace(good, tests=(nowhere,))
        raise KeyboardInterrupt if outcome == "killed" else command.Interrupted(good if outcome == "stopped" else None)

    monkeypatch.setattr(command, "calibrate", calibrate)
    campaign = small_campaign(tmp_path / "a")
    assert words in run("calibrate", campaign, "--no-figures", "--out", tmp_path / "o", status=status)
    assert (tmp_path / "o").exists() == written and not [p for p in tmp_path.iterdir() if p.name.startswith(".")]
    if written:
        assert json.loads((tmp_path / "o" / "calibration.json").read_text())["baseline"]["converged"] is False


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_stops_a_command(sent, monkeypatch, tmp_path) -> None:
    """Also one that comes in a callback that swallows it, or that an import in progress takes for a failure."""
    command = pytest.importorskip("calibration.commands.calibrate_command")
    before, campaign = signal.getsignal(sent), small_campaign(tmp_path / "a")

    def at_once(*_: object, **__: object) -> None:
        signal.raise_signal(sent)

    def importing(*_: object, **__: object) -> None:
        try:
            signal.raise_signal(sent)
        except KeyboardInterrupt:
            raise ImportError("numpy failed") from None

    def _xla_gc_callback() -> None:
        signal.raise_signal(sent)

    def collecting(*_: object, **__: object) -> None:
        _xla_gc_callback()
        time.sleep(5)

    for way in (at_once, importing, collecting):
        monkeypatch.setattr(command, "calibrate", way)
        text = run("calibrate", campaign, "--no-figures", "--out", tmp_path / "o", status=130)
        assert "stopped; nothing was written" in text and list(tmp_path.iterdir()) == [campaign]
    assert signal.getsignal(sent) is before


def small_campaign(folder: Path, tests: tuple[str, ...] = ("heave-1",), **changes: str) -> Path:
    """One heave decay of the embedded campaign, or some of its tests; two parameters free."""
    folder.mkdir()
    for name in ("platform.yaml", *(f"{test}.csv" for test in tests)):
        shutil.copy(DEMO / name, folder)
    lines = (DEMO / "campaign.yaml").read_text().splitlines()
    text = "\n".join(line for line in lines if "- {id" not in line or any(f"id: {test}," in line for test in tests))
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    (folder / "campaign.yaml").write_text(text + "\ncalibrate: {free: [pontoon.Ca_z, pontoon.Cd_z]}\n")
    return folder


def test_bad_campaigns_are_told(tmp_path: Path) -> None:
    pytest.importorskip("calibration.fitting.decay_fit")
    cases = [
        (tmp_path / "none", "expected a campaign's folder, or its campaign.yaml, found no such folder"),
        (small_campaign(tmp_path / "a", decay="decai"), "tests[0].kind: expected one of decay"),
        (small_campaign(tmp_path / "b", **{"heave-1.csv": "heave-2.csv"}), "Did you mean 'heave-1.csv'?"),
        (small_campaign(tmp_path / "c", **{"use: fit": "use: holdout"}), "at least one decay test marked `use: fit`"),
    ]
    for campaign, words in cases:
        assert words in run("calibrate", campaign, "--out", tmp_path / "o", status=2)
    assert not (tmp_path / "o").exists()


def test_results_do_not_replace_data_or_other_results(tmp_path: Path) -> None:
    pytest.importorskip("calibration.fitting.decay_fit")
    campaign = small_campaign(tmp_path / "a", **{"heave-1.csv": "simulated.nc"})
    table = pd.read_csv(campaign / "heave-1.csv")
    xr.Dataset({name: ("n", table[name]) for name in table}).to_netcdf(campaign / "simulated.nc", engine="h5netcdf")
    before = (campaign / "simulated.nc").read_bytes()
    assert "is the data of test heave-1" in run("calibrate", campaign, "--out", campaign, status=2)
    assert (campaign / "simulated.nc").read_bytes() == before
    folder = write_calibration(small(), tmp_path / "b", figures=False)
    text = run("simulate", PLATFORM, "--release", "surge=1", "--out", folder, status=2)
    assert "which has the results of a calibration" in text


def test_a_report_needs_results(tmp_path: Path) -> None:
    assert "found no calibration.json" in run("report", tmp_path, status=2)
    assert "found no such folder" in run("report", tmp_path / "none", status=2)
    (tmp_path / "calibration.json").write_text('{"campaign": "a", "jaxhydro": "b", "baseline": 3}')
    assert "baseline: expected a mapping" in run("report", tmp_path, status=2)


def test_platforms_are_listed() -> None:
    """Mass, draught, water depth: of a box, of a spar, of a model in a basin."""
    text = run("platforms")
    for row in ("ITI Energy barge 6149.5 4 150", "OC3-Hywind spar 8066 120 320", "VolturnUS-S 20093 20 200"):
        assert row in text
    assert "Ship section at model size 0.32 0.2 2.5" in text
