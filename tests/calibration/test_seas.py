"""Measured waves: a run made by the reference model comes back; what is wrong with a wave record is told; FOCAL campaign 2."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from ruamel.yaml import YAML
from test_outputs import follows

from benchmarks.reference_waves import WaveModel, Waves, march
from calibration.campaign.load_campaign import load_campaign
from calibration.campaign.runs import Run, on_even_clock, runs
from calibration.commands.simulate_campaign_command import simulate_campaign
from calibration.fitting.decay_calibration import calibrate
from calibration.residuals.run_seas import MAX_MISMATCH, sea_of
from calibration.residuals.wave_options import Options
from calibration.results.applied_calibration import apply_calibration
from jaxhydro.analysis.sea_statistics import bands_of
from jaxhydro.cli.options import results_folder
from jaxhydro.environment import Environment
from jaxhydro.errors import InputError
from jaxhydro.platform.build import load_model

ROOT = Path(__file__).resolve().parents[2]
HULL = ROOT / "jaxhydro" / "campaigns" / "volturnus-s-decays" / "platform.yaml"
FOCAL = ROOT.parent / "shared" / "measured" / "focal-c2"
SCALE = 50.0
GAUGE = (-100.0, 20.0)  # m, full scale
PERIOD, STEP = 400.0, 0.5  # s, full scale
OFFSETS = {"x": 0.31, "z": -0.4, "p": 1.2, "w": 0.02}  # of the sensors: m and deg at the scale of the files
HEADER = "t,w,x,z,p"


def document(**changes):
    time = SCALE**0.5
    return {
        "name": "made",
        "platform": "platform.yaml",
        "scale": SCALE,
        "channels": {
            "time": {"column": "t", "unit": "s"},
            "surge": {"column": "x", "unit": "m"},
            "heave": {"column": "z", "unit": "m"},
            "pitch": {"column": "p", "unit": "deg", "sign": -1},
        },
        "wave_channel": {"column": "w", "unit": "m", "position": [GAUGE[0] / SCALE, GAUGE[1] / SCALE]},
        "zero": {"test": "rest"},
        "tests": [
            {"id": "rest", "kind": "static", "file": "rest.csv", "use": "ignore"},
            {
                "id": "sea-a",
                "kind": "irregular",
                "file": "sea.csv",
                "window": [0, 200 / time],
                "transient": 40 / time,
                "peak_period": 11 / time,
                "significant_wave_height": 5 / SCALE,
            },
            {"id": "sea-b", "kind": "irregular", "file": "sea.csv", "window": [200 / time, 400 / time], "use": "holdout"},
            {"id": "wave", "kind": "regular", "file": "sea.csv", "window": [100 / time, 300 / time], "period": 10 / time},
        ],
        **changes,
    }


def write(folder, text=None, sea=None, **changes):
    """A campaign's folder; `sea` is the text of sea.csv."""
    (folder / "platform.yaml").write_text(HULL.read_text() if text is None else text)
    (folder / "campaign.yaml").write_text(json.dumps(document(**changes)))
    at_rest = np.random.default_rng(1).normal(scale=1e-5, size=(200, 4)) + [OFFSETS[c] for c in "wxzp"]
    (folder / "rest.csv").write_text(rows(np.arange(200) * 0.05, at_rest))
    (folder / "sea.csv").write_text(plain() if sea is None else sea)
    return folder


def rows(time, columns):
    lines = (f"{t:.2f}," + ",".join(f"{value:.7f}" for value in row) for t, row in zip(time, columns))
    return "\n".join([HEADER, *lines]) + "\n"


def plain(change=lambda time, columns: (time, columns)):
    """A sea.csv that moves, and means nothing."""
    time = np.arange(800) * STEP / SCALE**0.5
    columns = [0.02 * np.cos(2 * np.pi * k * time / 1.4 + k) for k in (1.0, 1.1, 0.9, 1.2)]
    return rows(*change(time, np.stack(columns, axis=1)))


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A run of the reference model in a sea of second order, its record seen by a gauge that is not at the platform."""
    platform = YAML(typ="safe").load(HULL)
    first = np.arange(round(0.055 * PERIOD), round(0.13 * PERIOD), 3)  # harmonics
    phase = np.random.default_rng(4).uniform(-np.pi, np.pi, first.size)
    height = 1.0 / (1 + (first / first.mean() - 0.95) ** 2 * 20)
    waves = Waves(height, 2 * np.pi / PERIOD * first, 0.0, phase, platform["water"]["depth"], order=2, stretching="vertical")
    model = WaveModel(platform, waves, strip=1.0, pontoon_strip=4.0, pontoon_ends=True)
    time, motion = march(model, np.zeros(6), np.zeros(6), STEP, PERIOD - STEP)
    elevation = np.array([waves.surface(t, GAUGE[0], GAUGE[1])[0] for t in time])
    seen = np.stack([elevation / SCALE, motion[:, 0] / SCALE, motion[:, 2] / SCALE, -np.rad2deg(motion[:, 4])], axis=1)
    return write(tmp_path_factory.mktemp("made"), sea=rows(time / SCALE**0.5, seen + [OFFSETS[c] for c in "wxzp"]))


@pytest.fixture(scope="module")
def results(made, tmp_path_factory):
    out = tmp_path_factory.mktemp("results")
    options = {"order": 2, "stretching": "vertical", "diffraction": "none", "cutoff": 0.2}
    assert simulate_campaign(made, out, calibration=None, asked=options) is True
    return out


@pytest.mark.slow
def test_a_made_run_comes_back(results):
    """Scale, gauge off the origin, sensors' offsets, an axis turned round, rounded times, windows of one run."""
    comparison = json.loads((results / "comparison.json").read_text())
    follows(comparison, "ComparisonFile")
    assert set(comparison["error"]) == {"sea-a", "sea-b", "wave"}
    for id, errors in comparison["error"].items():
        assert max(errors[dof]["relative"] for dof in ("surge", "heave", "pitch")) < 0.02, id
        for band in errors.get("bands", {}).values():
            assert max(map(abs, band.values())) < 0.02, id
    assert "bands" not in comparison["error"]["wave"] and comparison["error"]["sea-b"]["use"] == "holdout"
    assert set(comparison["error"]["sea-a"]["bands"]["surge"]) == {"low_frequency", "wave_frequency"}
    amplitudes = comparison["tests"]["wave"]["amplitude"]
    for pair in amplitudes.values():
        assert pair["simulated"] == pytest.approx(pair["measured"], rel=0.02)
    about = comparison["tests"]["sea-a"]
    assert about["peak_period"] == pytest.approx(11) and about["stated_height"] == pytest.approx(5)
    heights = about["significant_wave_height"]
    assert heights["simulated"] == pytest.approx(heights["measured"], rel=1e-3)
    assert about["start"] == pytest.approx(40, abs=STEP)
    (sea,) = comparison["seas"]
    assert sea["mismatch"] < MAX_MISMATCH and sea["gauge"] == pytest.approx(GAUGE) and comparison["warnings"] == []


@pytest.mark.slow
def test_what_is_written(results):
    with xr.open_dataset(results / "simulated.nc") as motion:
        assert motion["measured"].dims == ("test", "channel", "time") and motion["time"].attrs["units"] == "s"
        pair = [motion[name].sel(test="sea-b", channel="pitch").dropna("time").values for name in ("measured", "simulated")]
        wave = [motion[f"wave_{name}"].sel(test="sea-b").dropna("time").values for name in ("measured", "simulated")]
        assert str(motion["unit"].sel(channel="pitch").values) == "deg"
        assert list(motion["use"].values) == ["fit", "holdout", "fit"]
    assert np.std(pair[0] - pair[1]) < 0.03 * np.std(pair[0])
    assert np.std(wave[0] - wave[1]) < 0.01 * np.std(wave[0])
    listed = {figure["file"] for figure in json.loads((results / "comparison.json").read_text())["figures"]}
    named = {f"figures/{kind}-{id}.png" for kind in ("spectra", "excerpt") for id in ("sea-a", "sea-b", "wave")}
    assert listed == named | {f"figures/rao-{id}.png" for id in ("sea-a", "sea-b")}
    assert all((results / name).is_file() for name in listed)


def test_results_of_other_commands_stay_apart(tmp_path):
    """No command spoils another's folder, where files are called alike; a motion.csv alone may be anybody's."""
    results, tmp_path = tmp_path / "results", tmp_path / "other"
    for folder in (results, tmp_path):
        folder.mkdir()
    for name in ("comparison.json", "simulated.nc"):
        (results / name).write_text("{}")
    with pytest.raises(InputError, match="the results of a campaign's seas"):
        results_folder(results, "calibration.json", "a-campaign")
    assert results_folder(results, "comparison.json", "a-campaign") == results
    (tmp_path / "motion.csv").write_text("")
    assert results_folder(tmp_path, "comparison.json", "a-campaign") == tmp_path
    (tmp_path / "uncertainty.json").write_text("{}")
    with pytest.raises(InputError, match="the results of an uncertainty"):
        results_folder(tmp_path, "comparison.json", "a-campaign")
    (tmp_path / "uncertainty.json").rename(tmp_path / "simulated.nc")
    with pytest.raises(InputError, match="the results of a simulation"):
        results_folder(tmp_path, "comparison.json", "a-campaign")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["motion.csv", "simulated.nc"]


# wrong input


def failure(folder, work=lambda folder: runs(load_campaign(folder))) -> str:
    with pytest.raises(InputError) as caught:
        work(folder)
    return str(caught.value)


def with_test(**changes):
    zero_test, first, *_ = document()["tests"]
    return {"tests": [zero_test, {**first, **changes}]}


def test_no_wave_channel(tmp_path):
    text = failure(write(tmp_path, wave_channel=None))
    assert "tests[1].kind" in text and "wave_channel" in text
    text = failure(write(tmp_path, **with_test(channels={"wave": None})))
    assert "sea.csv" in text and "sea-a" in text and "a wave channel" in text


def test_no_wave_column(tmp_path):
    text = failure(write(tmp_path, wave_channel={"column": "eta", "unit": "m"}))
    assert "sea.csv" in text and "channel wave" in text and "'eta'" in text


def test_a_window_outside_the_record(tmp_path):
    text = failure(write(tmp_path, **with_test(window=[0, 9000])))
    assert "sea.csv" in text and "sea-a" in text and "9000" in text


def test_nothing_in_waves(tmp_path):
    text = failure(write(tmp_path, **with_test(use="ignore")))
    assert "campaign.yaml" in text and "irregular or regular" in text and "irregular marked ignore" in text


def uneven(time, columns):
    return time + 0.02 * np.sin(np.arange(len(time)) / 30), columns


def gap(time, columns):
    selected = np.r_[0:600, 620:800]
    return time[selected], columns[selected]


@pytest.mark.parametrize("change, pattern", [(uneven, "even sampling"), (gap, "19 missing"), (gap, "in a row")])
def test_a_wave_record_without_an_even_clock(change, pattern, tmp_path):
    """Also where the windows are sound: a sea is made of the whole record."""
    changes = with_test(window=[0, 30], transient=0) if change is gap else {}
    text = failure(write(tmp_path, sea=plain(change), **changes))
    assert "sea.csv, channel wave" in text and pattern.replace("19", "20") in text


def test_a_cutoff_beyond_the_sampling(tmp_path):
    campaign = load_campaign(write(tmp_path))
    (run,) = runs(campaign)
    with pytest.raises(InputError, match="half the sampling rate"):
        sea_of(run, Environment(1025.0, 200.0, 9.81), Options(cutoff=1.5))


def test_the_clock_behind_rounded_times():
    """Six digits of 0.83666 s steps, as in FOCAL campaign 2's file; three samples missing are drawn straight."""
    true = 9000 + 0.83666 * np.arange(2000)
    written = np.round(true, 1)
    selected = np.delete(np.arange(2000), [700, 701, 702])
    time, values, missing = on_even_clock(written[selected], 2.0 * selected, "f", "s")
    assert missing == 3 and len(time) == 2000
    np.testing.assert_allclose(time, true, atol=0.01)
    np.testing.assert_allclose(values, 2.0 * np.arange(2000))


def test_a_record_that_second_order_does_not_follow():
    """The nearest found is used, with the mismatch in words."""
    time = np.arange(1200) * 0.5
    wave = 4.5 * np.cos(2 * np.pi * 40 / 600 * time) + 1.2 * np.cos(2 * np.pi * 290 / 600 * time + 1)
    run = Run("steep.csv", time, wave, (0.0, 0.0), 0.0, (), ())
    made = sea_of(run, Environment(1025.0, 200.0, 9.81), Options(cutoff=0.6))
    assert made.mismatch > MAX_MISMATCH
    assert any("steep.csv" in note and f"{100 * made.mismatch:.2g} %" in note for note in made.notes)
    made = sea_of(run, Environment(1025.0, 200.0, 9.81), Options(order=1, cutoff=0.1))
    assert made.mismatch == 0 and any("of the wave record's variance" in note for note in made.notes)


def test_decays_are_wanted_where_only_waves_are(tmp_path):
    """One message, and what else there is to do."""
    text = failure(write(tmp_path), lambda folder: calibrate(load_campaign(folder)))
    assert "irregular marked fit" in text and "--tests waves" in text


# calibrated values


def saved(folder, **values_beside):
    values = {"column.Ca_t": 1.4, "mooring.line1.stiffness": 3.3e4}
    parameters = {
        k: {"value": v, "unit": "-", "identifiable": k != "column.Ca_t"} for k, v in {**values, **values_beside}.items()
    }
    content = {
        "campaign": "other",
        "jaxhydro": "0",
        "platform": "another hull",
        "baseline": {"parameters": parameters, "error": {}, "objective": {"fit": 1.0}, "converged": True},
    }
    (folder / "calibration.json").write_text(json.dumps(content))
    return folder / "calibration.json"


def test_values_of_another_campaign(tmp_path):
    """Hull and damping are taken, its mooring is not; what its records did not determine is named."""
    model = load_model(HULL)
    used = apply_calibration(saved(tmp_path), model, "this hull")
    assert used.values == {"column.Ca_t": 1.4} and used.not_used == ("mooring.line1.stiffness",)
    assert used.undetermined == ("column.Ca_t",) and float(used.model.values["column.Ca_t"]) == 1.4
    assert used.model.values["mooring.line1.stiffness"] == model.values["mooring.line1.stiffness"]
    assert not apply_calibration(saved(tmp_path), model, "another hull").not_used
    with pytest.raises(InputError, match=r"hul\.Ca_t"):
        apply_calibration(saved(tmp_path, **{"hul.Ca_t": 1.0}), model, "this hull")


def test_bands():
    """The paper's; the wave has one, yaw none; from 11.7 s on the wave band begins at 0.05 Hz."""
    assert bands_of("surge", 9.0) == {"low_frequency": (0.005, 0.025), "wave_frequency": (0.06, 0.15)}
    assert bands_of("wave", 12.5) == {"wave_frequency": (0.05, 0.15)} and bands_of("yaw", 9.0) == {}


# measured


@pytest.mark.slow
@pytest.mark.skipif(not FOCAL.is_dir(), reason=f"{FOCAL} is not on this machine")
def test_focal_campaign_2():
    """The first sea's run from the record's first 1600 s: signs, clock and gauge are right."""
    import dataclasses

    from calibration.residuals.measured_seas import compare

    campaign = load_campaign(FOCAL)
    record = campaign.record("sea-3m")
    early = record.time < 1100
    short = dataclasses.replace(record, time=record.time[early], values={k: v[early] for k, v in record.values.items()})
    comparison = compare(dataclasses.replace(campaign, records=(short,)), load_model(FOCAL / "platform.yaml"), Options(order=1))
    (test,) = comparison.tests
    assert 4 * np.std(test.simulated_wave) == pytest.approx(4 * np.std(test.wave), rel=0.02)
    for series in test.fit.series:
        if series.channel in ("surge", "heave", "pitch"):
            assert np.corrcoef(series.measured, series.simulated)[0, 1] > 0.5, series.channel
    assert math.isclose(comparison.seas[0][0].step, 0.83666, rel_tol=1e-5)
