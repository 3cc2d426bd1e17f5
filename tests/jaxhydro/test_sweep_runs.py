"""Sweeps that run: what a run is, results that do not depend on how they came about, kills, failures, derivatives."""

import contextlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import jax
import numpy as np
import pytest
import xarray as xr
import zarr
from fake_sweep import BREAKING, PLATFORM, SWEEP, written
from test_outputs import follows
from typer.testing import CliRunner

import jaxhydro as jh
from jaxhydro import fingerprint as fingerprints
from jaxhydro.cli import app as cli
from jaxhydro.sweep import cluster, lifetime_sensitivity, load_sweep, run_sweep
from jaxhydro.sweep.batch import run_outcome, run_outcomes, setup_in
from jaxhydro.sweep.cases import Plan
from jaxhydro.sweep.execute import opened
from jaxhydro.sweep.local import Worker
from jaxhydro.sweep.prepared_sweep import prepared
from jaxhydro.sweep.store import INPUTS, RESULTS, Store, locked_folder
from jaxhydro.sweep.store_layout import DONE, FAILED
from jaxhydro.sweep.sweep_remarks import shares_in_band
from jaxhydro.waves.sea_state import state_of

VARIABLES = ("statistics", "density", "bands", "ranges", "series")
RUNS = 24


@pytest.fixture(scope="module", autouse=True)
def compiled_once(tmp_path_factory):
    """Worker processes share compiled programs."""
    with pytest.MonkeyPatch.context() as patch:
        if "JAX_COMPILATION_CACHE_DIR" not in os.environ:
            patch.setenv("JAX_COMPILATION_CACHE_DIR", str(tmp_path_factory.mktemp("xla")))
        before = jax.config.jax_compilation_cache_dir
        yield
        jax.config.update("jax_compilation_cache_dir", before)


@pytest.fixture(scope="module")
def file(tmp_path_factory) -> Path:
    return written(tmp_path_factory.mktemp("sweep"))


@pytest.fixture(scope="module")
def whole(file) -> Path:
    """The sweep by one process without a break."""
    out = file.parent / "whole"
    run_sweep(file, out, workers=1)
    assert (out / "sweep.json").is_file()
    return out


@pytest.fixture(scope="module")
def stored(file) -> Path:
    """A finished sweep of which one run was simulated, here: the others are that one, larger, or fail."""
    out = file.parent / "stored"
    opened(out, prepared(load_sweep(file), "sweep"))
    setup, store = setup_in(out / INPUTS), Store(out)
    first = run_outcome(setup, setup.plan.run(0))
    assert not isinstance(first, str)
    for number in range(RUNS):
        run = setup.plan.run(number)
        larger = type(first)(*((1 + 0.01 * number) * values for values in first))
        store.write(run, run_outcome(setup, run) if number >= 16 else larger)
    return out


def command(*words: object, status: int) -> str:
    result = CliRunner().invoke(cli.app, [str(word) for word in words])
    assert result.exit_code == status, result.output
    assert isinstance(result.exception, SystemExit | None)
    return " ".join(re.sub("[│╭╮╰╯─]", " ", result.output).split())


def results(out: Path) -> dict[str, np.ndarray]:
    with xr.open_zarr(out / RESULTS) as data:
        return {name: data[name].values for name in (*VARIABLES, "status", "reason")}


def assert_bitwise(out: Path, reference: Path) -> None:
    first, second = results(out), results(reference)
    for name in (*VARIABLES, "status"):
        assert first[name].tobytes() == second[name].tobytes(), name
    assert (first["reason"] == second["reason"]).all()


def done_in(out: Path) -> list[Path]:
    """The status chunks that are there."""
    return sorted((out / RESULTS / "status" / "c").rglob("*[0-9]")) if (out / RESULTS).is_dir() else []


def chunks(out: Path) -> dict[Path, int]:
    return {path: path.stat().st_mtime_ns for path in done_in(out) if path.is_file()}


# --- what a run is


@pytest.mark.slow
def test_a_run_is_what_simulate_does_with_the_same_options(whole, tmp_path) -> None:
    """And with the coefficients of its sea state, Cd of its height and B of its period."""
    setup = setup_in(whole / INPUTS)
    waves = jh.spectrum_components(
        lambda w: jh.jonswap(w, 3.0, 9.0), 150.0, setup.model.environment, low=0.03, cutoff=0.15, seed=5
    )
    sea = jh.IrregularSea(waves, setup.model.environment, 1)
    (tmp_path / "plain.yaml").write_text(re.sub(r"sea_state_laws:\n(  .*\n)+", "", PLATFORM))
    height, period = 4 * float((waves.amplitude**2 / 2).sum()) ** 0.5, state_of(waves).peak_period
    values = {"column.Cd_t": (height / 2.0) ** -0.5, "linear_damping.B11": 2.0e5 * (period / 8.0) ** 1.5}
    plain = jh.load_model(tmp_path / "plain.yaml").with_values(values)
    moved = jh.simulate(plain, setup.times, sea, step=setup.limit)
    with xr.open_zarr(whole / RESULTS) as data:
        run = data.isel(case=1).sel(seed=5).load()
    np.testing.assert_allclose(run.series.sel(channel="surge"), moved["surge"], atol=1e-10)
    np.testing.assert_allclose(run.series.sel(channel="pitch"), np.rad2deg(moved["pitch"]), atol=1e-10)
    np.testing.assert_allclose(run.series.sel(channel="wave"), sea.gauge(setup.times), atol=1e-12)
    after_transient = run.series.where(run.time >= 37.5, drop=True)
    np.testing.assert_allclose(run.statistics.sel(statistic="standard_deviation"), after_transient.std("time"), rtol=1e-9)
    np.testing.assert_allclose(run.statistics.sel(statistic="maximum"), after_transient.max("time"))
    assert list(run.channel.values) == ["wave", "surge", "heave", "pitch", "line1", "line2", "line3"]
    assert list(run.unit.values) == ["m", "m", "m", "deg", "N", "N", "N"]
    # at rest the lines pull 1e6 N each, and the one that surge slackens pulls least when surge is largest
    line = after_transient.sel(channel="line1")
    assert float(line.mean()) == pytest.approx(1e6, rel=0.02)
    assert float(xr.corr(line, after_transient.sel(channel="surge"))) < -0.9


def test_the_store_says_what_it_holds(stored) -> None:
    with xr.open_zarr(stored / RESULTS) as data:
        assert dict(data.sizes) | {"case": 3, "seed": 8, "time": 301, "exponent": 3} == dict(data.sizes)
        assert data.hs.values.tolist() == [1.5, 3.0, BREAKING["hs"]] and data.hs.units == "m"
        assert data.probability.values == pytest.approx([0.6, 0.35, 0.05])
        assert np.isnan(data.gamma.values).all() and data.gamma.dims == ("case",)
        assert data.spectrum_share.values == pytest.approx(shares_in_band(setup_in(stored / INPUTS).plan))
        assert data.attrs["source"].startswith("jaxhydro") and len(data.attrs["fingerprint"]) == 16
        assert data.statistics.encoding["chunks"][:2] == (1, 1)


def test_a_run_that_cannot_be_is_recorded_and_the_others_go_on(stored) -> None:
    stored_results = results(stored)
    assert (stored_results["status"] == [[DONE], [DONE], [FAILED]]).all()
    assert all("break" in reason for reason in stored_results["reason"][2]) and not stored_results["reason"][:2].any()
    assert np.isfinite(stored_results["statistics"][:2, ..., :4]).all() and np.isnan(stored_results["statistics"][2]).all()


def test_the_command_writes_what_the_life_is(file, stored) -> None:
    """On a finished store: tables and figures, and nothing is simulated."""
    before = chunks(stored)
    text = command("sweep", file, "--out", stored, status=3)
    assert chunks(stored) == before
    assert "24 of 24 runs: nothing is left to do" in text and "8 of 24 runs failed" in text
    assert "no run is left have 5.00% of the life" in text
    assert text.count("break above") == 2  # noted before, and one line for all runs that failed alike
    assert "Hs 20 m, Tp 9 s, heading 0 deg, 8 seeds: expected a sea that does not break" in text
    document = json.loads((stored / "sweep.json").read_text())
    follows(document, "SweepResults")
    assert document["runs"] == {"total": 24, "done": 16, "failed": 8}
    (failure,) = document["failures"]
    assert "break" in failure["reason"] and failure["runs"] == 8 and failure["seeds"] == list(range(8))
    assert (document["sea_states"], document["cases"], document["headings"]) == (3, 3, [{"heading": 0.0, "probability": 1.0}])
    assert document["options"]["duration"] == 150.0 and document["options"]["order"] == 1
    with xr.open_zarr(stored / RESULTS) as data:
        deviation = data.statistics.sel(channel="surge", statistic="standard_deviation").values[:2]
    expected = np.sqrt((0.6 * (deviation[0] ** 2).mean() + 0.35 * (deviation[1] ** 2).mean()) / 0.95)
    assert document["lifetime"]["surge"]["standard_deviation"] == pytest.approx(expected)
    rows = (stored / "lifetime.csv").read_text().splitlines()
    assert rows[0].startswith("channel,unit,mean") and rows[2].startswith("surge,m,") and len(rows) == 8
    assert all((stored / name).stat().st_size > 5000 for name in ("scatter.png", "exceedance.png"))


# --- results do not depend on how they came about


@pytest.mark.slow
def test_a_killed_sweep_goes_on_and_is_bitwise_the_same(file, whole, tmp_path) -> None:
    out = tmp_path / "o"
    code = "from jaxhydro.cli.app import main; main()"
    words = ["sweep", str(file), "--out", str(out), "--workers", "1"]
    process = subprocess.Popen([sys.executable, "-c", code, *words], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 240
    while len(chunks(out)) < 3 and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.002)
    process.kill()
    process.wait()
    time.sleep(1.0)  # what was in flight ends, or is lost
    before = chunks(out)
    assert 3 <= len(before) < RUNS
    assert not (out / "sweep.json").exists()
    text = command("sweep", file, "--out", out, "--workers", 2, "--batch", 3, status=3)
    assert f"has {len(before)} of 24 runs: they stay" in text
    assert {path: at for path, at in chunks(out).items() if path in before} == before
    assert_bitwise(out, whole)


@pytest.mark.slow
def test_a_sweep_that_is_told_to_end_says_that_it_can_go_on(file, tmp_path) -> None:
    """SIGTERM, as SLURM sends it before a job's time is over."""
    words = ["sweep", str(file), "--out", str(tmp_path / "o"), "--workers", "1"]
    code = "from jaxhydro.cli.app import main; main()"
    process = subprocess.Popen(
        [sys.executable, "-c", code, *words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    )
    assert process.stderr is not None
    seen = ""
    for line in process.stderr:
        seen += line
        if "runs, " in line:  # the first is done
            process.terminate()
            break
    last_output = process.stderr.read()
    assert process.wait(timeout=60) == 130, seen + last_output
    assert "the same command goes on" in last_output and 1 <= len(chunks(tmp_path / "o")) < RUNS


def test_a_stop_at_any_time_says_what_is_there(file, stored, tmp_path, monkeypatch) -> None:
    """Before the runs and after them; also where a library's callback swallowed the signal."""

    def stop(*_) -> None:
        signal.raise_signal(signal.SIGTERM)

    def swallowed(*_) -> dict:
        with contextlib.suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        return {}

    with monkeypatch.context() as late:  # all is written: it is done
        late.setattr("jaxhydro.cli.sweep_command._print_results", stop)
        assert f"Results are in {stored}" in command("sweep", file, "--out", stored, status=3)
    monkeypatch.setattr("jaxhydro.cli.sweep_command.results_of", stop)
    assert f"stopped; what is done is in {stored / RESULTS}" in command("sweep", file, "--out", stored, status=130)
    before = signal.getsignal(signal.SIGINT)
    monkeypatch.setattr("jaxhydro.sweep.prepared_sweep.impossible", swallowed)
    assert "stopped; nothing was written" in command("sweep", file, "--out", tmp_path / "o", status=130)
    monkeypatch.setattr("jaxhydro.cli.sweep_command.load_sweep", stop)
    assert "stopped; nothing was written" in command("sweep", file, "--out", tmp_path / "o", status=130)
    assert not (tmp_path / "o").exists() and signal.getsignal(signal.SIGINT) is before


def test_two_sweeps_do_not_write_to_one_folder(file, stored) -> None:
    before = chunks(stored)
    with locked_folder(stored):
        text = command("sweep", file, "--out", stored, "--restart", status=2)
    assert "--out: expected a folder of its own" in text and "another sweep writes now" in text
    assert chunks(stored) == before


def test_a_scheduler_that_is_lost_is_told(file, tmp_path, monkeypatch) -> None:
    def lost(*_):
        raise ConnectionResetError("reset by peer")

    monkeypatch.setattr("jaxhydro.cli.sweep_command.workers_of", lambda scheduler: 2)
    monkeypatch.setattr("jaxhydro.cli.sweep_command.run_all", lost)
    text = command("sweep", file, "--out", tmp_path / "o", "--scheduler", "tcp://x:1", status=130)
    assert "the scheduler at tcp://x:1 was lost (reset by peer); what is done is in" in text


def test_a_platform_that_falls_over_is_not_swept(tmp_path) -> None:
    """Nor is a folder begun."""
    file = written(tmp_path)
    (tmp_path / "buoy.yaml").write_text(PLATFORM.replace("[0.0, 0.0, -12.0]", "[0.0, 0.0, 12.0]"))
    with pytest.raises(jh.EquilibriumError, match="unstable in roll and pitch"):
        run_sweep(file, tmp_path / "o", workers=1)
    assert not (tmp_path / "o").exists()


@pytest.mark.slow
def test_a_worker_that_is_killed_loses_nothing(file, whole, tmp_path) -> None:
    """Its run is done by the process in its place."""
    opened(tmp_path / "o", prepared(load_sweep(file), "sweep"))
    worker = Worker(tmp_path / "o", None)
    try:
        worker.process.kill()
        assert worker.ask([9]) == [(9, True)]
    finally:
        worker.end()
    status = Store(tmp_path / "o").status()
    assert status[9] == DONE and status.sum() == DONE
    assert results(tmp_path / "o")["series"][1, 1].tobytes() == results(whole)["series"][1, 1].tobytes()


@pytest.mark.slow
def test_a_cluster_that_loses_a_worker_gives_the_same(file, whole, tmp_path) -> None:
    distributed = pytest.importorskip("distributed")
    killed: list[int] = []
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, host="127.0.0.1"
    ) as local:

        def kill_one(now) -> None:
            if not killed:
                killed.append(next(iter(local.workers.values())).pid)
                os.kill(killed[0], signal.SIGKILL)
                assert now.done + now.failed < RUNS - 4

        assert cluster.workers_of(local.scheduler_address) == 2
        run_sweep(file, tmp_path / "o", scheduler=local.scheduler_address, progress=kill_one)
    assert killed
    assert_bitwise(tmp_path / "o", whole)


@pytest.mark.slow
@pytest.mark.parametrize("order", [1, 2])
def test_runs_at_once_are_runs_one_by_one(whole, order) -> None:
    """The way of GPUs, here on the CPU: to rounding. Those of another heading are a group of their own."""
    setup = setup_in(whole / INPUTS)
    setup = setup._replace(plan=replace(setup.plan, order=order))
    runs = [setup.plan.run(number) for number in (0, 9, 16, 10, 11)]
    runs[1] = runs[1]._replace(case=runs[1].case._replace(heading=30.0))
    for run, outcome in zip(runs, run_outcomes(setup, runs)):
        single = run_outcome(setup, run)
        if isinstance(single, str):
            assert outcome == single and run.number == 16
            continue
        for name in VARIABLES:
            scale = np.nan_to_num(np.abs(getattr(single, name))).max(axis=-1, keepdims=True) + 1e-12
            np.testing.assert_allclose(getattr(outcome, name) / scale, getattr(single, name) / scale, atol=1e-9, err_msg=name)


# --- resuming something else


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"duration": 160.0}, "duration: expected 150.0, as in the runs that are there, found 160.0"),
        ({"scatter": SWEEP["scatter"][:1]}, "scatter: expected 3 sea states, as in the runs that are there, found 1"),
    ],
)
def test_another_sweep_is_not_mixed_in(stored, tmp_path, changes, words) -> None:
    before = chunks(stored)
    text = command("sweep", written(tmp_path, **changes), "--out", stored, status=2)
    assert words in text and "--restart begins anew" in text
    assert chunks(stored) == before


def test_another_platform_is_not_mixed_in(stored, tmp_path) -> None:
    file = written(tmp_path)
    (tmp_path / "buoy.yaml").write_text((tmp_path / "buoy.yaml").read_text().replace("Cd_t: 1.0", "Cd_t: 1.1"))
    assert "the platform file of the runs that are there, found another" in command("sweep", file, "--out", stored, status=2)


def test_another_program_is_not_mixed_in(file, stored, monkeypatch) -> None:
    """Other source code of either package, or another version of what computes."""
    before, version_of = chunks(stored), fingerprints.version
    with monkeypatch.context() as patched:
        patched.setattr(fingerprints, "sources", lambda: "of a load that was changed")
        text = command("sweep", file, "--out", stored, status=2)
        assert "source code: expected that which made the runs that are there, found another. Another --out" in text
    monkeypatch.setattr(fingerprints, "version", lambda name: "99.0" if name == "diffrax" else version_of(name))
    text = command("sweep", file, "--out", stored, status=2)
    assert f"diffrax: expected {version_of('diffrax')}, which made the runs that are there, found 99.0" in text
    assert chunks(stored) == before


def test_a_store_of_an_earlier_format_is_refused(file, tmp_path) -> None:
    """Only zarr version 3 is read: version 2 knows a codec that reads pickles."""
    made, out = prepared(load_sweep(file), "sweep"), tmp_path / "o"
    assert not opened(out, made)
    shutil.rmtree(out / RESULTS)
    zarr.open_group(out / RESULTS, mode="w", zarr_format=2)
    assert "source code" in command("sweep", file, "--out", out, status=2)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"platform": "none.yaml"}, "sweep.yaml: platform: none.yaml: expected a YAML file"),
        ({"calibration": "none.json"}, "none.json: expected a calibration.json"),
        ({"calibration": "buoy.yaml"}, "buoy.yaml: line 2, column 1: expected valid JSON"),
        (
            {"scatter": [BREAKING]},
            "scatter: expected a sea state that can be, found none: Hs 20 m, Tp 9 s: expected a sea that",
        ),
        ({"cutoff": 3}, "cutoff: expected about 1"),
        ({"scatter": "none.csv"}, "there is none"),
        ({"seed": 1}, "Did you mean 'seeds'?"),
    ],
)
def test_bad_input_leaves_nothing_behind(tmp_path, changes, words) -> None:
    file = written(tmp_path / "in", **changes)
    assert words in command("sweep", file, "--out", tmp_path / "o", status=2)
    assert not (tmp_path / "o").exists()


def test_a_cluster_has_its_own_workers(file, tmp_path) -> None:
    text = command("sweep", file, "--out", tmp_path / "o", "--scheduler", "tcp://127.0.0.1:9", "--workers", 2, status=2)
    assert "--workers: expected none with --scheduler" in text


def test_a_scheduler_that_does_not_answer_leaves_nothing_behind(file, tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(cluster, "SCHEDULER_TIMEOUT", 0.5)
    words = ("sweep", file, "--out", tmp_path / "o", "--scheduler", "tcp://127.0.0.1:9")
    assert "--scheduler: expected a scheduler that answers" in command(*words, status=2)
    assert not (tmp_path / "o").exists()


def test_a_store_that_was_not_finished_being_made_is_made_anew(file, tmp_path) -> None:
    made, out = prepared(load_sweep(file), "sweep"), tmp_path / "o"
    assert not opened(out, made)
    (out / RESULTS).rename(out / ".results")
    (out / INPUTS / "plan.json").write_text("{")
    assert not opened(out, made) and opened(out, made)
    assert Plan.from_json((out / INPUTS / "plan.json").read_text()) == made.inputs.plan and not (out / ".results").exists()


# --- gradients


@pytest.mark.slow
def test_a_life_changes_with_drag_as_its_derivative_says(file) -> None:
    """Forward mode through the simulations, against central differences of whole sweeps."""
    sweep = load_sweep(file).model_copy(update={"seeds": 2, "scatter": load_sweep(file).scatter[:2]})
    label, step = "column.Cd_t", 0.02
    labels = [label, "linear_damping.B11"]
    sensitivity = lifetime_sensitivity(sweep, labels)

    def deviation(cd: float) -> float:
        moved = Path(sweep.platform).with_name(f"cd{cd}.yaml")
        moved.write_text(Path(sweep.platform).read_text().replace("Cd_t: 1.0", f"Cd_t: {cd}"))
        return lifetime_sensitivity(sweep.model_copy(update={"platform": str(moved)}), labels).value

    slope = (deviation(1.0 + step) - deviation(1.0 - step)) / (2 * step)
    assert sensitivity.gradient[label] == pytest.approx(slope, rel=2e-3)
    assert sensitivity.gradient[label] < 0 and sensitivity.gradient["linear_damping.B11"] < 0
    assert sensitivity.value == pytest.approx(np.sqrt(np.array([60, 35]) / 95 @ (sensitivity.deviation**2).mean(axis=1)))
