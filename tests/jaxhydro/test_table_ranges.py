"""Waves outside the frequencies of computed tables: refused, or told with their share of the energy."""

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_tables import CYLINDER, model_of
from typer.testing import CliRunner

import jaxhydro as jh
from calibration.campaign.load_campaign import load_campaign
from jaxhydro.cli import app as cli
from jaxhydro.cli.simulate_command import told_of_bed
from jaxhydro.dynamics.table_ranges import TableRange, outside_tables, table_ranges
from jaxhydro.sweep import load_sweep
from jaxhydro.sweep.prepared_sweep import prepared
from jaxhydro.waves.excitation import Excitation

PLATFORM = (Path(jh.__path__[0]) / "platforms" / "volturnus-s-focal.yaml").read_text(encoding="utf-8")


def excitation(folder: Path, low: float, high: float, heave: float = 4.5e6 / 1025 / 9.80665) -> None:
    """A .3 file of heave alone, in N/m over rho g."""
    rows = [[2 * math.pi / w, 0.0, 3, heave, 0.0, heave, 0.0] for w in np.linspace(low, high, 9)]
    np.savetxt(folder / "hull.3", rows, fmt="%.9e")


def drift(folder: Path, low: float, high: float) -> None:
    periods = 2 * math.pi / np.linspace(low, high, 4)
    np.savetxt(folder / "hull.12d", [[p, q, 0, 0, 1, 1.0, 0, 1.0, 0] for p in periods for q in periods if q <= p], fmt="%.9e")


def platform(folder: Path, *lines: str) -> Path:
    (folder / "a.yaml").write_text(PLATFORM + "\n" + "\n".join(lines) + "\n", encoding="utf-8")
    return folder / "a.yaml"


def run(*words: object) -> tuple[int, str]:
    result = CliRunner().invoke(cli.app, ["simulate", *map(str, words)])
    return result.exit_code, result.output


@pytest.mark.parametrize(
    ("line", "key", "band"),
    [
        ("excitation: {file: hull.3}", "excitation", r"0.5 to 1.2 rad/s \(periods 5.236 to 12.566 s\)"),
        ("drift: {file: hull.12d}", "drift", r"0.5 to 1.2 rad/s \(periods 5.236 to 12.566 s\)"),
        ("radiation: {file: CYLINDER}", "radiation", r"up to 5 rad/s \(periods from 1.2566 s\)"),
    ],
)
def test_a_regular_wave_outside_a_table_is_refused(tmp_path: Path, line: str, key: str, band: str) -> None:
    """By simulations in Python and by the command, with range and wave; one inside is not."""
    excitation(tmp_path, 0.5, 1.2)
    drift(tmp_path, 0.5, 1.2)
    model = model_of(tmp_path, line)
    outside, inside = (1.1, 7.0) if key == "radiation" else (20.0, 7.0)
    wave = jh.regular_wave(0.02, outside, model.environment)
    words = rf"a wave within the {key} table, which has {band}, found a period of {outside:g} s"
    with pytest.raises(ValueError, match=words):
        jh.simulate(model, np.arange(0.0, 10.0), wave)
    status, output = run(tmp_path / "platform.yaml", "--wave-height", 0.02, "--wave-period", outside, "--out", tmp_path / "o")
    assert status == 2 and f"--wave-period: expected a wave within the {key} table" in output
    assert not (tmp_path / "o" / "motion.csv").exists()
    shares = [table_range.share_outside(np.array([2 * math.pi / inside]), np.ones(1)) for table_range in table_ranges(model)]
    assert shares == [0.0]


def test_a_table_that_does_not_act_refuses_nothing(tmp_path: Path) -> None:
    """A candidate is at a share of 0; its table counts where a diagnosis may let it in."""
    excitation(tmp_path, 0.5, 1.2)
    model = model_of(tmp_path, "excitation: {file: hull.3, use: candidate}")
    assert table_ranges(model) == () and [table_range.key for table_range in table_ranges(model, candidates=True)] == [
        "excitation"
    ]


def test_the_ends_of_a_range_are_inside() -> None:
    limits = TableRange("excitation", 0.5, 1.2)
    table = Excitation.of(np.array([0.5, 1.2]), np.ones((6, 2)))
    printed = 2 * math.pi / np.array([5.236, 12.566])  # as messages have them
    assert not limits.outside(printed).any() and (np.abs(np.asarray(table.at(printed))) > 0.99).all()
    assert not np.asarray(table.at(np.array([0.49, 1.21]))).any()
    assert not limits.outside(np.array([0.5, 0.5 - 1e-8, 0.9, 1.2, 1.2 + 1e-8])).any()
    assert limits.outside(np.array([0.49, 1.21])).all()
    assert_allclose(limits.share_outside(np.array([0.4, 0.6, 1.0, 1.3]), np.array([1.0, 2.0, 3.0, 4.0])), 0.5)
    assert limits.remark(0.0) is None and limits.remark(1e-5) is None
    assert not limits.remark(0.009).warning and limits.remark(0.011).warning
    assert "1.10% of the energy of the sea lies outside the excitation table" in limits.remark(0.011).text


def test_a_sea_tells_its_share_outside(tmp_path: Path) -> None:
    """Against the integral of the spectrum."""
    excitation(tmp_path, 0.5, 1.2)
    model = jh.load_model(platform(tmp_path, "excitation: {file: hull.3}"))
    spectrum = lambda w: jh.jonswap(w, 3.0, 9.0)  # noqa: E731
    waves = jh.spectrum_components(spectrum, 600.0, model.environment, low=0.03, cutoff=0.3, seed=1)
    (share,) = outside_tables(model, waves).values()
    omega = np.linspace(2 * math.pi * 0.03, 2 * math.pi * 0.3, 4001)
    density = np.asarray(spectrum(omega))
    inside = (omega >= 0.5) & (omega <= 1.2)
    assert_allclose(share, 1 - density[inside].sum() / density.sum(), atol=0.005)


@pytest.mark.slow
def test_the_warning_of_a_sea_leads(tmp_path: Path) -> None:
    """Above 1 % before everything else, with its share in the files; a sea inside says nothing."""
    for low, high, warned in ((0.5, 0.9, True), (0.1, 2.0, False)):
        excitation(tmp_path, low, high)
        out = tmp_path / f"o{high}"
        status, output = run(
            platform(tmp_path, "excitation: {file: hull.3}"),
            "--hs",
            3,
            "--tp",
            9,
            "--duration",
            60,
            "--transient",
            20,
            "--order",
            1,
            "--no-figures",
            "--out",
            out,
        )
        assert status == 0, output
        lines = [line for line in output.splitlines() if line.strip() and "Building the sea" not in line]
        assert lines[0].startswith("jaxhydro: warning:") == warned
        assert ("% of the energy of the sea lies outside the excitation table, which has 0.5 to 0.9" in lines[0]) == warned
        assert '"share_outside_excitation": 0.' in (out / "statistics.json").read_text(encoding="utf-8")
        assert not list(out.glob("figures/*"))


@pytest.mark.slow
def test_a_sweep_tells_its_worst_sea_state(tmp_path: Path) -> None:
    excitation(tmp_path, 0.5, 1.2)
    platform(tmp_path, "excitation: {file: hull.3}")
    text = "platform: a.yaml\nscatter: [{hs: 2.0, tp: 8.0}, {hs: 2.0, tp: 16.0}]\nduration: 300\n"
    (tmp_path / "sweep.yaml").write_text(text, encoding="utf-8")
    made = prepared(load_sweep(tmp_path / "sweep.yaml"), "sweep.yaml")
    (remark,) = [entry for entry in made.remarks if "outside" in entry.text]
    assert remark.warning and "of the energy of Hs 2 m, Tp 16 s lies outside the excitation table" in remark.text
    assert made.about["notes"][0] == remark.text


def campaign(folder: Path, kind: str, period: float) -> None:
    time = np.arange(0.0, 600.0, 0.5)
    wave = np.cos(2 * math.pi / period * time) + (0.3 * np.cos(2 * math.pi / 8 * time) if kind == "irregular" else 0.0)
    np.savetxt(folder / "sea.csv", np.stack([time, 0.1 * wave, wave], axis=1), delimiter=",", header="t,x,w", comments="")
    (folder / "campaign.yaml").write_text(
        "name: c\nplatform: a.yaml\nchannels: {time: {column: t, unit: s}, surge: {column: x, unit: m}}\n"
        f"wave_channel: {{column: w, unit: m}}\ntests: [{{id: sea-1, kind: {kind}, file: sea.csv}}]\n",
        encoding="utf-8",
    )


@pytest.mark.slow
def test_a_campaign_tells_waves_outside(tmp_path: Path) -> None:
    """A regular test outside is an error, an irregular one a warning, also for a candidate's table; one inside is none."""
    excitation(tmp_path, 0.5, 1.2)
    platform(tmp_path, "excitation: {file: hull.3, use: candidate}")
    campaign(tmp_path, "irregular", 20.0)
    outside = [finding for finding in load_campaign(tmp_path).findings if "excitation table" in finding.message]
    assert len(outside) == 1 and outside[0].test == "sea-1" and "% of the energy of the sea lies outside" in outside[0].message
    campaign(tmp_path, "irregular", 9.0)
    assert not [finding for finding in load_campaign(tmp_path).findings if "excitation table" in finding.message]
    campaign(tmp_path, "regular", 20.0)
    assert any("is outside the excitation table, a candidate" in str(finding) for finding in load_campaign(tmp_path).findings)
    platform(tmp_path, "excitation: {file: hull.3}")
    with pytest.raises(jh.InputError, match=r"expected a wave within the excitation table, .* found a regular wave of 20"):
        load_campaign(tmp_path)
    campaign(tmp_path, "regular", 9.0)
    load_campaign(tmp_path)


@pytest.mark.slow
def test_remarks_on_files_are_a_campaigns_warnings(tmp_path: Path) -> None:
    (tmp_path / "hull.nc").write_bytes(CYLINDER.read_bytes())
    platform(tmp_path, "excitation: {file: hull.nc, use: candidate}")
    campaign(tmp_path, "irregular", 9.0)
    texts = [str(finding) for finding in load_campaign(tmp_path).findings]
    assert any(
        text.startswith("a.yaml: ") and "frequency left out, at which nothing was computed (NaN)" in text for text in texts
    )


def test_a_hull_in_the_sea_bed_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    model = jh.load_model("volturnus-s-focal")
    depth, times = float(model.environment.depth), np.array([0.0, 1.0, 2.0])
    position = np.zeros((3, 6))
    told_of_bed(model, times, position)
    assert not capsys.readouterr().err
    position[:, 2] = [0.0, -depth + 10.0, -depth]
    told_of_bed(model, times, position)
    assert "through the sea bed, first at 1 s: nothing holds it there" in capsys.readouterr().err
