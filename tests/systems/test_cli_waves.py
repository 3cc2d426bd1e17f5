"""`jaxhydro simulate` in irregular seas: what it writes and prints, its options, an answer in words for every bad input."""

import json
import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from fake_calibration import DEMO
from test_cli import cache, run  # noqa: F401

import jaxhydro as jh
from calibration.commands import simulate_campaign_command as of_campaigns
from jaxhydro.analysis.sea_statistics import bands_of, summary, tables
from jaxhydro.cli import option_choices, sea_command, sea_options
from jaxhydro.cli.exit_status import NOT_CONVERGED
from jaxhydro.dynamics.irregular_simulation import CarriedAwayError
from jaxhydro.dynamics.requested_sea import usual_transient
from jaxhydro.platform.build import model_of
from jaxhydro.plots import seas as sea_plot
from jaxhydro.waves.irregular import spectrum_components
from jaxhydro.waves.wave_errors import ShortWavesError

PLATFORM = DEMO / "platform.yaml"
SEA = ("--hs", 3.1, "--tp", 8.96)
SIZE = ("--duration", 299.5, "--dt", 0.5, "--cutoff", 0.2)  # one compiled size for all


@pytest.fixture(scope="module")
def model() -> jh.Model:
    return jh.load_model(PLATFORM)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """A sea of five minutes, and what was printed."""
    out = tmp_path_factory.mktemp("sea") / "o"
    return out, run("simulate", PLATFORM, *SEA, *SIZE, "--seed", 4, "--out", out)


# --- what it writes


def test_a_sea_is_written(written, model) -> None:
    out, text = written
    assert {str(path.relative_to(out)) for path in out.rglob("*") if path.is_file()} == {
        "motion.csv",
        "simulated.nc",
        "statistics.json",
        "figures/motion.png",
        "figures/window.png",
        "figures/spectra.png",
    }
    for words in (
        "Natural periods",
        "Components 52",
        "Repeat period 300 s",
        "Building the sea",
        "Simulating 299.5 s",
        "Statistics, from 75 to 299.5 s",
        "Energy by band",
        "0.005-0.025",
    ):
        assert words in text, words
    spectrum = spectrum_components(lambda w: jh.jonswap(w, 3.1, 8.96), 299.5, model.environment, low=0.03, cutoff=0.2, seed=4)
    sea = jh.IrregularSea(spectrum, model.environment, order=2)
    table = pd.read_csv(out / "motion.csv")
    np.testing.assert_allclose(table.wave_m, sea.gauge(table.time_s.to_numpy()), atol=1e-8)
    with xr.open_dataset(out / "simulated.nc") as data:
        np.testing.assert_allclose(data.wave_first_order, sea.gauge(data.time.values, order=1), atol=1e-12)
        np.testing.assert_allclose(data.simulated.sel(channel="pitch"), table.pitch_deg, atol=1e-7)
        assert data.wave.units == data.wave_first_order.units == "m"
        attributes = {
            name: data.attrs[name] for name in ("seed", "order", "stretching", "diffraction", "cutoff", "peak_period")
        }
    assert attributes == {
        "seed": 4,
        "order": 2,
        "stretching": "vertical",
        "diffraction": "maccamy_fuchs",
        "cutoff": 0.2,
        "peak_period": 8.96,
    }


def test_statistics_are_those_of_the_series(written) -> None:
    out, text = written
    statistics = json.loads((out / "statistics.json").read_text())
    table = pd.read_csv(out / "motion.csv")
    after_transient = table[table.time_s >= 0.25 * 299.5]
    assert statistics["window"] == [after_transient.time_s.iloc[0], 299.5] and statistics["sea"]["transient"] == 0.25 * 299.5
    for channel, column in {"wave": "wave_m", "surge": "surge_m", "pitch": "pitch_deg"}.items():
        summary, values = statistics["statistics"][channel], after_transient[column]
        assert summary["mean"] == pytest.approx(values.mean(), rel=1e-6)
        assert summary["standard_deviation"] == pytest.approx(values.std(ddof=0), rel=1e-6)
        assert (summary["minimum"], summary["maximum"]) == pytest.approx((values.min(), values.max()), rel=1e-6)
        assert f"{summary['standard_deviation']:.4g}" in text
    assert statistics["statistics"]["sway"]["standard_deviation"] == 0 and statistics["statistics"]["sway"]["skewness"] is None
    pitch = statistics["bands"]["pitch"]
    assert pitch["low_frequency"]["band"] == [0.02, 0.055] and pitch["wave_frequency"]["band"] == [0.06, 0.15]
    assert 0 < pitch["low_frequency"]["integral"] < statistics["statistics"]["pitch"]["standard_deviation"] ** 2
    assert set(statistics["bands"]["wave"]) == {"wave_frequency"} and "yaw" not in statistics["bands"]


@pytest.mark.slow
def test_a_record_gives_back_its_sea(written, tmp_path) -> None:
    """The wave of one run, as a record of 300 s, moves the platform as that run's sea did: first orders are told apart."""
    first = pd.read_csv(written[0] / "motion.csv")
    moved = pd.DataFrame({"t": first.time_s + 20.0, "probe 1": first.wave_m})
    moved.to_csv(tmp_path / "tank.csv", index=False)
    options = ["--wave-time-column", 0, "--wave-column", "probe 1", "--dt", 0.5, "--cutoff", 0.2]
    text = run("simulate", PLATFORM, "--wave", tmp_path / "tank.csv", *options, "--out", tmp_path / "o")
    assert "Share of record" in text and "Significant wave height" in text
    second = pd.read_csv(tmp_path / "o" / "motion.csv")
    assert second.time_s.iloc[0] == 20.0 and len(second) == len(first)
    for name in ("surge_m", "heave_m", "pitch_deg"):
        assert np.abs(second[name] - first[name]).max() < 2e-3 * first[name].std(), name
    with xr.open_dataset(tmp_path / "o" / "simulated.nc") as data:
        assert data.attrs["mismatch"] < 1e-3 and data.attrs["record_column"] == "probe 1"


def test_nothing_of_an_earlier_sea_is_left(written, tmp_path) -> None:
    import shutil

    out = shutil.copytree(written[0], tmp_path / "o")
    (out / "figures" / "mine.png").write_text("mine")
    run("simulate", PLATFORM, "--release", "heave=1", "--duration", 20, "--out", out)
    remaining = {path.name for path in out.rglob("*") if path.is_file()}
    assert remaining == {"motion.csv", "simulated.nc", "motion.png", "mine.png"}


def test_results_of_a_campaign_are_not_spoilt(tmp_path) -> None:
    for name in ("comparison.json", "simulated.nc"):
        (tmp_path / name).write_text("{}")
    text = run("simulate", PLATFORM, *SEA, "--out", tmp_path, status=2)
    assert "another folder" in text and "the results of a campaign's seas" in text


# --- how the sea is built


def built(model: jh.Model, duration: float = 600.0, **options):
    given = {f"--{name.replace('_', '-')}": value for name, value in options.items()}
    requested = sea_options.asked(given, 0.0)
    assert requested is not None
    return sea_command.build_sea(model, requested, duration)


def test_spectra_and_their_notes(model) -> None:
    jonswap = built(model, hs=3.1, tp=8.96)
    assert jonswap.about["peak_enhancement"] == pytest.approx(1.0) and not jonswap.notes
    assert jonswap.about["significant_wave_height_of_components"] == pytest.approx(3.1, rel=0.02)
    omega = np.asarray(jonswap.sea.components.omega)
    assert jonswap.target is not None
    density = jonswap.target(omega / (2 * math.pi))
    assert (density.sum() / 600.0) == pytest.approx(0.5 * float((jonswap.sea.components.amplitude**2).sum()))
    white = built(model, hs=2.0, spectrum="white", order=1)
    assert np.ptp(white.sea.components.amplitude) < 1e-12 and white.sea.order == 1 and white.about["peak_period"] is None
    assert white.about["significant_wave_height_of_components"] == pytest.approx(2.0, rel=0.01)
    assert np.ptp(built(model, hs=2.0, spectrum="white", amplitudes="rayleigh").sea.components.amplitude) > 0.01
    assert "sqrt(2 g / Hs), --cutoff 0.24" in built(model, hs=9.0, tp=13.0).notes[0]
    assert "of the spectrum lies from 0.1 to 0.3 Hz" in built(model, hs=3.0, tp=12.0, low=0.1).notes[0]


def test_elements_and_diffraction_in_place_of_the_platforms() -> None:
    platform = jh.load_platform(PLATFORM)
    coarse, fine = (model_of(platform, elements=count) for count in (1, 4))
    pontoons = sum(len(member.heading) for member in platform.members if member.group == "pontoon")
    assert len(fine.hull.elements.length) - len(coarse.hull.elements.length) == 3 * pontoons
    assert model_of(platform).conventions.diffraction == "maccamy_fuchs"
    none = model_of(platform, option_choices.Diffraction.none)  # as the command line gives it
    assert none.conventions.diffraction == "none" and type(none.conventions.diffraction) is str and none.cylinders is None


def test_bands_and_tables() -> None:
    assert bands_of("surge", None)["wave_frequency"] == (0.06, 0.15) and bands_of("heave", 12.0)["wave_frequency"][0] == 0.05
    assert bands_of("yaw", 9.0) == {}
    time = np.arange(0, 1000, 0.5)
    channels = {"wave": np.sin(0.2 * math.pi * time), "sway": 3e-8 * np.sin(0.1 * time), "yaw": 0.1 * np.sin(0.01 * time)}
    document = summary(time, channels, 10.0)
    assert document["statistics"]["wave"]["zero_crossing_period"] == pytest.approx(10.0)
    assert document["bands"]["wave"]["wave_frequency"]["integral"] == pytest.approx(0.5, rel=0.01)
    (_, rows), (_, energy) = tables(document)
    assert [row[0] for row in rows] == ["wave (m)", "sway (m)", "yaw (deg)"] and len(energy) == 1
    assert rows[1][1:] == ("0", "0", "0", "0", "0", "-")  # sway of rounding
    assert sea_plot.moving(channels | {"sway": 0 * time + 1e-15}) == ["wave", "yaw"]


# --- what it says


def test_help_teaches() -> None:
    text = run("simulate", "--help")
    for words in ("--hs", "--wave-position", "--stretching", "--hs 3.1 --tp 8.96 --duration 3600", "IEC 61400-3-1", "(0.3)"):
        assert words in text, words


TANK = ("--wave", "tank.csv", "--wave-time-column", 0)
BAD = [
    (["--hs", 3.1], "--tp: a peak period expected with --hs"),
    (["--tp", 9], "--tp: a significant wave height expected with it: --hs 3.1"),
    (["--seed", 1], "--seed: a significant wave height expected with it"),
    (["--order", 1], "--order: a sea expected with it"),
    (["--hs", -1, "--tp", 9], "--hs: a number > 0 expected, found -1"),
    (["--hs", 3.1, "--tp", 0], "--tp: a number > 0 expected, found 0"),
    ([*SEA, "--gamma", 9], "--gamma: from 1 to 7 expected, found 9"),
    ([*SEA, "--gamma", 2, "--spectrum", "pierson-moskowitz"], "--gamma: a JONSWAP spectrum expected"),
    ([*SEA, "--spectrum", "white"], "--tp: white noise has no peak"),
    ([*SEA, "--spectrum", "jonswop"], "'jonswop' is not one of 'jonswap'"),
    ([*SEA, "--cutoff", 0.02], "--cutoff: a number above --low, 0.03 Hz, expected, found 0.02"),
    ([*SEA, "--low", -0.1], "--low: a number from 0 on expected"),
    ([*SEA, "--cutoff", "inf"], "--cutoff: a finite number expected"),
    ([*SEA, "--order", 3], "--order: 1 or 2 expected in irregular waves, found 3"),
    ([*SEA, "--stretching", "delta"], "'delta' is not one of 'none', 'vertical'"),
    ([*SEA, "--duration", 0], "--duration: a number > 0 expected, found 0"),
    ([*SEA, "--duration", 300, "--transient", 300], "--transient: from 0 to less than the duration, 300 s, expected"),
    ([*SEA, "--duration", 4], "--duration: expected 14 s or more, for 100 samples after the transient of 1 s"),
    ([*SEA, "--wave", "tank.csv"], "--hs: --wave takes the sea from a record: not both"),
    ([*SEA, "--wave-height", 2, "--wave-period", 9], "regular waves or an irregular sea, not both"),
    ([*SEA, "--wave-column", "a"], "--wave-column: a record expected with it"),
    (["--hs", 12, "--tp", 6], "--hs: expected a sea that does not break, found one too steep"),
    ([*SEA, "--cutoff", 0.0301, "--duration", 300], "--cutoff: expected a band, here 0.03 to 0.0301 Hz, with waves in it"),
    ([*SEA, "--cutoff", 0.0301, "--duration", 30], "--cutoff: expected a sea that can be simulated, found none (a band wider"),
    (["--wave", "none.csv"], "none.csv: file: expected a file that can be read, found No such file"),
    (["--wave", "tank.csv"], "tank.csv: expected a column 'time_s', found t, eta, gap, name. --wave-time-column says which"),
    (["--wave", "tank.csv", "--wave-time-column", "t", "--wave-column", "et"], "Did you mean 'eta'?"),
    ([*TANK, "--wave-column", "gap"], "column gap: expected numbers without gaps, found 1"),
    ([*TANK, "--wave-column", "name"], "column name: expected numbers, found text"),
    (["--wave", "tank.csv", "--wave-time-column", "eta", "--wave-column", 1], "column eta: expected even sampling"),
    ([*TANK, "--wave-column", 1, "--duration", 900], "at most the record's length, 299.5 s"),
    ([*TANK, "--wave-column", 1, "--cutoff", 2], "at most half the sampling rate, 1 Hz"),
    ([*TANK, "--wave-column", 1, "--wave-position", "nan", 0], "--wave-position"),
]


@pytest.mark.parametrize(("options", "words"), BAD, ids=[" ".join(map(str, options)) for options, _ in BAD])
def test_bad_seas_are_told(options, words, tmp_path, monkeypatch) -> None:
    time = np.arange(600) * 0.5
    table = pd.DataFrame({"t": time, "eta": np.sin(0.7 * time), "gap": time, "name": "a"})
    table.loc[7, "gap"] = np.nan
    table.to_csv(tmp_path / "tank.csv", index=False)
    monkeypatch.chdir(tmp_path)
    assert words in run("simulate", PLATFORM, *options, "--out", "o", status=2)
    assert not Path("o").exists()


@pytest.mark.parametrize(
    ("outcome", "status", "words"),
    [
        (np.nan, 3, "beyond all bounds at 0 s"),
        (CarriedAwayError("the platform is carried 99 m along the waves"), 3, "carried 99 m"),
        (ShortWavesError("waves need more than 96 support wavenumbers"), 2, "--cutoff: expected a sea"),
        (ValueError("a step of 2 s is too long for waves of 0.6 Hz"), 2, "--step: expected a sea that can be simulated"),
    ],
)
def test_what_cannot_be_simulated_is_told(outcome, status, words, tmp_path, monkeypatch) -> None:
    def free_decay(model, offset, times, **options):
        if isinstance(outcome, ValueError):
            raise outcome
        return jh.Response(times, np.full((len(times), 6), outcome), None, None)

    monkeypatch.setattr(sea_command, "free_decay", free_decay)
    assert words in run("simulate", PLATFORM, *SEA, *SIZE, "--out", tmp_path / "o", status=status)
    assert not (tmp_path / "o").exists()


# --- campaigns


def test_a_campaign_is_handed_on(tmp_path, monkeypatch) -> None:
    calls = []

    def simulate_campaign(campaign, out, **options):
        calls.append((campaign, out, options))
        return len(calls) < 2

    monkeypatch.setattr(of_campaigns, "simulate_campaign", simulate_campaign, raising=False)
    run("simulate", DEMO, "--out", tmp_path)
    options = ["--order", 1, "--stretching", "wheeler", "--diffraction", "none", "--cutoff", 0.2, "--no-figures"]
    run("simulate", DEMO / "campaign.yaml", *options, "--calibration", "c.json", "--out", tmp_path, status=NOT_CONVERGED)
    usual = {"asked": {}, "calibration": None, "figures": True}
    how = {"order": 1, "stretching": "wheeler", "diffraction": "none", "cutoff": 0.2}
    expected_options = {"asked": how, "calibration": Path("c.json"), "figures": False}
    assert calls == [(DEMO, tmp_path, usual), (DEMO / "campaign.yaml", tmp_path, expected_options)]
    for option in ("--hs", "--wave-height", "--duration", "--transient", "--wave", "--elements", "--heading", "--dt"):
        text = run("simulate", DEMO, option, 3, "--out", tmp_path, status=2)
        assert f"{option}: it goes with a platform, not with a campaign" in text


@pytest.mark.parametrize(
    ("counted", "transient", "pace"), [(1385.0, None, 1.0), (10.1, None, 1.0), (3000.0, None, 1.0), (100.0, 600.0, 1.0)]
)
def test_a_duration_that_is_advised_is_enough(counted: float, transient: float | None, pace: float) -> None:
    advised = sea_command.duration_of(counted, transient, pace)
    left_out = usual_transient(advised, pace) if transient is None else transient
    assert counted <= advised - left_out < 1.15 * counted + 0.1 * left_out
    assert "e" not in f"{advised:g}" and len(f"{advised:g}".strip("0").replace(".", "")) <= 2  # short enough to type
