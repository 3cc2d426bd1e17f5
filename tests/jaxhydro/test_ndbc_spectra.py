"""Spectra of NDBC's buoys: densities, times, directions by maximum entropy, and what is told of broken files."""

import gzip
import math
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

from jaxhydro.dynamics.requested_sea import MeasuredDirections
from jaxhydro.errors import InputError
from jaxhydro.interop.buoy_directions import maximum_entropy
from jaxhydro.interop.directional_file import read_directional_spectrum, read_sea_file
from jaxhydro.interop.ndbc_spectra import is_ndbc, read_ndbc
from jaxhydro.waves.spreading import spreading
from jaxhydro.waves.tabulated_sea import TabulatedDirections, TabulatedFrequencies

FREQUENCY = np.array([0.02, 0.0325, 0.0375, 0.0625, 0.0775, 0.1, 0.11, 0.12, 0.15, 0.2, 0.3, 0.485])  # Hz, uneven as NDBC's
DENSITY = np.array([0.0, 0.0, 0.01, 0.02, 0.16, 1.78, 5.8, 4.74, 1.42, 0.24, 0.08, 0.01])  # m2/Hz
ALPHA1, ALPHA2, R1, R2 = 22.0, 27.0, 0.85, 0.6
FIRST, SECOND = datetime(2019, 2, 6, 0, 40), datetime(2019, 2, 6, 1, 40)
HEADER = "#YY  MM DD hh mm" + "".join(f"  {f:.4f}".replace(" 0.", "  .") for f in FREQUENCY) + "\n"


def historical(path: Path, *rows: np.ndarray, header: str = HEADER) -> Path:
    lines = [f"2019 02 06 {i:02d} 40 " + " ".join(f"{value:6.2f}" for value in row) for i, row in enumerate(rows)]
    path.write_text(header + "\n".join(lines) + "\n", encoding="utf-8")
    return path


def recent(path: Path, title: str, row: np.ndarray, separation: str = "") -> Path:
    pairs = " ".join(f"{value:.3f} ({f:.4f})" for value, f in zip(row, FREQUENCY))
    header = f"#YY  MM DD hh mm {title} ({title}) ... >\n"
    path.write_text(header + f"2019 02 06 00 40 {separation} {pairs}\n", encoding="utf-8")
    return path


def directions(folder: Path) -> Path:
    """Five historical files, r1 and r2 in hundredths."""
    every = np.ones(len(FREQUENCY))
    for letter, value in (("d", ALPHA1), ("i", ALPHA2), ("j", 100 * R1), ("k", 100 * R2)):
        historical(folder / f"41010{letter}2019.txt", value * every)
    return historical(folder / "41010w2019.txt", DENSITY)


def area(x: np.ndarray, y: np.ndarray) -> float:
    """Trapezoids, one by one."""
    return sum(0.5 * (y[i] + y[i + 1]) * (x[i + 1] - x[i]) for i in range(len(x) - 1))


def height(spectrum: TabulatedDirections | TabulatedFrequencies) -> float:
    return MeasuredDirections("", spectrum, 0.0).summary()[0]


def test_maximum_entropy_has_the_coefficients() -> None:
    """Integrals over its bins are c1 and c2; no bin is negative; noise is moved to what can be."""
    c1 = np.array([0.3 * np.exp(1j), 0.9 * np.exp(-2j), 0.0, 0.85])
    c2 = np.array([0.2 * np.exp(2.5j), 0.75 * np.exp(-4.1j), 0.4j, -0.9])
    found = maximum_entropy(c1, c2, 72)
    width = 2 * np.pi / 72
    fine = (np.arange(7200) + 0.5) * width / 100 - width / 2  # 100 points in each bin
    density = np.repeat(found, 100, axis=1) * width / 100
    assert (found >= 0).all()
    assert_allclose(density.sum(axis=1), 1.0)
    assert_allclose((density * np.exp(1j * fine)).sum(axis=1), c1, atol=1e-6)
    assert_allclose((density * np.exp(2j * fine)).sum(axis=1)[:3], c2[:3], atol=1e-4)
    assert_allclose(maximum_entropy(np.zeros(1), np.zeros(1), 36), 1 / (2 * np.pi))


@pytest.mark.parametrize("s", [3.0, 10.0, 40.0])
def test_maximum_entropy_of_a_known_sea(s: float) -> None:
    """Near cos^2s, from which its coefficients are taken, and with one peak."""
    angle = np.arange(72) * 2 * np.pi / 72
    c1, c2 = s / (s + 1), s * (s - 1) / ((s + 1) * (s + 2))
    exact, found = np.asarray(spreading(angle, 0.0, s)), maximum_entropy(np.array([c1]), np.array([c2]), 72)[0]
    assert_allclose(found, exact, atol=0.04 * exact.max())
    assert (np.diff(found[:37]) <= 1e-12).all()


@pytest.mark.parametrize("kind", ["historical", "packed", "old", "recent"])
def test_a_spectrum_without_directions(tmp_path: Path, kind: str) -> None:
    """Hs of each format is 4 sqrt(m0) of the file's numbers."""
    if kind == "recent":
        path = recent(tmp_path / "41010.data_spec", "Sep_Freq  < spec_1", DENSITY, "0.225")
    elif kind == "old":
        path = historical(tmp_path / "41010w1998.txt", DENSITY, header=HEADER.replace("#YY  MM DD hh mm", "YY MM DD hh"))
        path.write_text(path.read_text(encoding="utf-8").replace("2019 02 06 00 40", "98 02 06 00"), encoding="utf-8")
    else:
        path = historical(tmp_path / "41010w2019.txt", DENSITY)
    if kind == "packed":
        with gzip.open(tmp_path / "packed.txt.gz", "wt", encoding="utf-8") as file:
            file.write(path.read_text(encoding="utf-8"))
        path = tmp_path / "packed.txt.gz"
    spectrum = read_sea_file(path, time=datetime(1998, 2, 6) if kind == "old" else None)
    assert isinstance(spectrum, TabulatedFrequencies) and spectrum.long_crested
    assert height(spectrum) == pytest.approx(4 * math.sqrt(area(FREQUENCY, DENSITY)), rel=1e-12)
    assert_allclose(spectrum.omega, 2 * math.pi * FREQUENCY, rtol=1e-9)
    assert_allclose(spectrum.headings(spectrum.omega, 0.9 * np.ones(12)), 0.0)


@pytest.mark.parametrize("kind", ["historical", "recent"])
def test_a_spectrum_with_directions(tmp_path: Path, kind: str) -> None:
    """The variance is the file's at every frequency; waves from 22 deg run to 202 deg by compass."""
    path = directions(tmp_path)
    if kind == "recent":
        path = recent(tmp_path / "41010.data_spec", "Sep_Freq  < spec_1", DENSITY, "0.225")
        gaps = np.where(DENSITY == 0, 999.0, 1.0)  # no directions where there is no energy
        for key, value in (("swdir", ALPHA1), ("swdir2", ALPHA2), ("swr1", R1), ("swr2", R2)):
            recent(tmp_path / f"41010.{key}", f"{key}_1", np.where(gaps > 1, gaps, value))
    spectrum = read_sea_file(path, 30.0)
    assert isinstance(spectrum, TabulatedDirections)
    assert_allclose(2 * math.pi * spectrum.table, DENSITY, rtol=1e-9, atol=1e-12)
    assert height(spectrum) == pytest.approx(4 * math.sqrt(area(FREQUENCY, DENSITY)), rel=1e-9)
    assert math.degrees(spectrum.mean_heading) == pytest.approx(30 - ALPHA1 - 180 + 360, abs=0.05) or math.degrees(
        spectrum.mean_heading
    ) == pytest.approx(30 - ALPHA1 - 180, abs=0.05)
    row = spectrum.values[6]
    first = abs((row * np.exp(1j * spectrum.heading)).sum() / row.sum())
    assert first == pytest.approx(R1, abs=2e-3)


def test_the_time_is_chosen(tmp_path: Path) -> None:
    path = historical(tmp_path / "buoy.swden", DENSITY, 4 * DENSITY)
    assert is_ndbc(path) and not is_ndbc(tmp_path / "none.txt")
    found = {time: height(read_sea_file(path, time=time)) for time in (FIRST, SECOND)}
    assert found[SECOND] == pytest.approx(2 * found[FIRST])
    words = "time: expected one spectrum, found 2, from 2019-02-06T00:40 to 2019-02-06T01:40. --sea-time says which"
    with pytest.raises(InputError, match=words):
        read_sea_file(path)
    with pytest.raises(InputError, match=r"one spectrum of 2019-02-06T03:00, found 0 of 2, .*the nearest is 2019-02-06T01:40"):
        read_sea_file(path, time=datetime(2019, 2, 6, 3))


def test_the_time_of_a_netcdf_file(tmp_path: Path) -> None:
    table = np.tile(DENSITY[:, None] / 360, (1, 36))
    coords = {"time": [FIRST, SECOND], "freq": FREQUENCY, "dir": np.arange(0.0, 360.0, 10.0)}
    xr.Dataset({"efth": (("time", "freq", "dir"), np.stack([table, 4 * table]))}, coords).to_netcdf(tmp_path / "sea.nc")
    found = height(read_sea_file(tmp_path / "sea.nc", time=SECOND))
    assert found == pytest.approx(8 * math.sqrt(area(FREQUENCY, DENSITY)))
    with pytest.raises(InputError, match=r"time: expected one spectrum, found 2, from 2019-02-06T00:40 to 2019-02-06T01:40"):
        read_directional_spectrum(tmp_path / "sea.nc")


@pytest.mark.parametrize(
    ("name", "old", "new", "words"),
    [
        ("41010w2019.txt", "  5.80", "  x.80", r"41010w2019\.txt: line 2: expected numbers, found 'x\.80'"),
        ("41010w2019.txt", "  5.80", "", r"line 2: expected 12 values, found 11"),
        ("41010w2019.txt", "  5.80", "999.00", r"line 2: expected densities .m²/Hz., found 1 that are missing"),
        ("41010w2019.txt", "  5.80", " -5.80", r"expected densities that are not negative, with energy, found -5\.8"),
        (
            "41010w2019.txt",
            "2019 02 06",
            "2019 02 36",
            r"line 2: expected year, month, day, hour, minute, found '2019 02 36 00 40'",
        ),
        ("41010j2019.txt", "85.00", "185.00", r"41010j2019\.txt: line 2: expected r1 from 0 to 1, or to 100 .*, found 1\.85"),
        ("41010d2019.txt", "22.00", "422.00", r"line 2: expected alpha1 from 0 to 360 deg, found 422"),
        ("41010k2019.txt", "  .1100", "  .1150", r"41010k2019\.txt: line 2: expected the 12 frequencies of 41010w2019\.txt"),
    ],
)
def test_broken_files(tmp_path: Path, name: str, old: str, new: str, words: str) -> None:
    path = directions(tmp_path)
    text = (tmp_path / name).read_text(encoding="utf-8")
    assert old in text
    (tmp_path / name).write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(InputError, match=words):
        read_sea_file(path)


def test_files_of_directions_that_lack(tmp_path: Path) -> None:
    path = directions(tmp_path)
    (tmp_path / "41010k2019.txt").unlink()
    with pytest.raises(InputError, match=r"all files of directions beside it: 41010d2019\.txt, .* none named 41010k2019\.txt"):
        read_sea_file(path)
    historical(tmp_path / "41010k2019.txt", np.where(FREQUENCY == 0.11, 999.0, 60.0))
    with pytest.raises(InputError, match=r"line 2: expected directions for 95% of the energy, found none for \d+% of it"):
        read_ndbc(path)


def test_swan_s_spectra_by_an_optional_program(tmp_path: Path) -> None:
    """A spectrum that wavespectra writes in SWAN's format is read as it was."""
    pytest.importorskip("wavespectra")
    direction = np.arange(0.0, 360.0, 10.0)
    efth = DENSITY[:, None] * np.asarray(spreading(np.radians(direction), 1.0, 5.0)) * math.radians(1)
    coords = {"time": [FIRST], "freq": FREQUENCY, "dir": direction, "lat": ("site", [0.0]), "lon": ("site", [0.0])}
    data = xr.Dataset({"efth": (("time", "site", "freq", "dir"), efth[None, None])}, coords)
    data.spec.to_swan(str(tmp_path / "sea.spec"))
    assert height(read_sea_file(tmp_path / "sea.spec")) == pytest.approx(
        4 * math.sqrt(area(FREQUENCY, efth.sum(axis=1) * 10)), rel=1e-3
    )


def test_without_wavespectra_a_message_says_what_to_install(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "wavespectra", None)
    (tmp_path / "sea.spec").write_text("SWAN   1\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"wavespectra installed, found SWAN's text\. pip install 'jaxhydro\[spectra\]'"):
        read_sea_file(tmp_path / "sea.spec")
