"""Seas of several headings: closed forms of spreading, variance per frequency, systems together, files, second order."""

import math
from pathlib import Path

import jax
import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose
from one_program import complex_amplitude, elevation, vector

import jaxhydro as jh
from jaxhydro.environment import Environment
from jaxhydro.errors import InputError
from jaxhydro.input_schema import validate
from jaxhydro.interop.directional_file import read_directional_spectrum
from jaxhydro.sweep.batch import Setup, sea_of
from jaxhydro.sweep.cases import Plan, plan_of
from jaxhydro.sweep.sweep_schema import Sweep
from jaxhydro.waves import spectra
from jaxhydro.waves.components import Components, components
from jaxhydro.waves.directional_spectrum import SystemsSpectrum, WaveSystem, directional_components
from jaxhydro.waves.irregular import spectrum_components
from jaxhydro.waves.spreading import (
    circular_moments,
    equal_energy_shares,
    exponent_of_cosine,
    exponent_of_width,
    spread_angle,
    spreading,
)

WATER = Environment(1025.0, 200.0)
BAND = {"low": 0.03, "cutoff": 0.3, "seed": 4}
HOUR = 3600.0


def drawn(*systems: WaveSystem, **options) -> Components:
    return directional_components(SystemsSpectrum(systems), HOUR, WATER, **{**BAND, **options})


def energy(waves: Components) -> np.ndarray:
    return 0.5 * np.asarray(waves.amplitude) ** 2


@pytest.mark.parametrize("s", [0.0, 0.7, 4.0, 25.0])
def test_angles_have_the_law_of_spreading(s: float) -> None:
    """The share of the energy below an angle is the integral of D."""
    share = np.array([0.01, 0.2, 0.5, 0.77, 0.999])
    for part, angle in zip(share, spread_angle(s, share)):
        grid = np.linspace(-math.pi, angle, 20001)
        assert float(np.trapezoid(np.asarray(spreading(grid, 0.0, s)), grid)) == pytest.approx(part, abs=2e-5)


@pytest.mark.parametrize("s", [2.0, 10.0, 40.0])
def test_direction_and_width_are_those_of_closed_forms(s: float) -> None:
    """Mean resultant s / (s + 1), width sqrt(2 / (s + 1)), over many equally high waves and in a sea."""
    share = equal_energy_shares(1, 20000, 3)
    moments = circular_moments(math.radians(170) + spread_angle(s, share), np.ones(20000))
    assert moments.mean == pytest.approx(math.radians(170), abs=1e-3)
    assert moments.resultant == pytest.approx(s / (s + 1), abs=1.5e-3)  # two standard errors at s = 2
    assert moments.width == pytest.approx(math.sqrt(2 / (s + 1)), rel=3e-3)
    waves = drawn(WaveSystem(3.0, 9.0, 2.0, 170.0, s))
    of_sea = circular_moments(np.asarray(waves.heading), energy(waves))
    assert abs(of_sea.mean - math.radians(170)) < 0.02 and of_sea.width == pytest.approx(math.sqrt(2 / (s + 1)), rel=0.05)


def test_every_narrow_band_has_all_directions() -> None:
    """One share of each sixteenth among 16 successive harmonics; another band leaves them as they are."""
    share = equal_energy_shares(1, 160, 7)
    assert all(sorted((16 * run).astype(int)) == list(range(16)) for run in share.reshape(-1, 16))
    assert (equal_energy_shares(30, 99, 7) == share[29:99]).all()


@pytest.mark.parametrize("n", [1.0, 2.0, 4.0, 12.0])
def test_exponents_convert_by_circular_width(n: float) -> None:
    """cos^n of the whole angle over half the circle, by its integral; the rule of thumb 2 n + 1 is near."""
    grid = np.linspace(-0.5 * math.pi, 0.5 * math.pi, 20001)
    resultant = np.trapezoid(np.cos(grid) ** (n + 1), grid) / np.trapezoid(np.cos(grid) ** n, grid)
    assert exponent_of_cosine(n) == pytest.approx(resultant / (1 - resultant), rel=1e-6)
    assert exponent_of_width(math.sqrt(2 * (1 - resultant))) == pytest.approx(exponent_of_cosine(n), rel=1e-6)
    assert 2 * n + 1 < exponent_of_cosine(n) < 2 * n + 1.7


def test_openfast_spreading_is_the_same_law() -> None:
    """cos^(2 S) of pi angle / range: s = S for 360 degrees, n = 2 S for 180 degrees."""
    angle = np.linspace(-0.49 * math.pi, 0.49 * math.pi, 50)
    whole = np.abs(np.cos(math.pi * angle / math.radians(360))) ** (2 * 3.0)
    ours = np.asarray(spreading(angle, 0.0, 3.0))
    assert_allclose(whole / whole[25], ours / ours[25], rtol=1e-12)
    assert_allclose(np.cos(math.pi * angle / math.radians(180)) ** (2 * 3.0), np.cos(angle) ** 6, rtol=1e-12)


@pytest.mark.parametrize("amplitudes", ["deterministic", "rayleigh"])
def test_without_spreading_it_is_the_long_crested_sea(amplitudes: str) -> None:
    """Bit for bit; and spreading changes headings alone: the variance at each frequency stays."""
    plain = spectrum_components(
        lambda w: spectra.jonswap(w, 3.0, 9.0, 2.0), HOUR, WATER, heading=math.radians(30), amplitudes=amplitudes, **BAND
    )
    for long_crested, spread in zip(
        jax.tree.leaves(plain), jax.tree.leaves(drawn(WaveSystem(3, 9, 2, 30.0), amplitudes=amplitudes))
    ):
        assert (np.asarray(long_crested) == np.asarray(spread)).all()
    short = drawn(WaveSystem(3, 9, 2, 30.0, 5.0), amplitudes=amplitudes)
    assert (np.asarray(short.amplitude) == np.asarray(plain.amplitude)).all() and np.ptp(np.asarray(short.heading)) > 1
    assert (np.asarray(short.phase) == np.asarray(plain.phase)).all()


def test_two_systems_of_one_direction_are_the_sum_of_their_spectra() -> None:
    swell, wind = WaveSystem(2.0, 14.0, 5.0, 40.0), WaveSystem(1.5, 7.0, 1.5, 40.0)
    waves = drawn(swell, wind)
    summed = sum(np.asarray(spectra.jonswap(waves.omega, system.hs, system.tp, system.gamma)) for system in (swell, wind))
    assert_allclose(energy(waves), summed * 2 * math.pi / float(waves.period), rtol=1e-12)
    assert (np.asarray(waves.heading) == math.radians(40)).all() and SystemsSpectrum((swell, wind)).long_crested


def test_each_system_has_its_energy_and_its_heading() -> None:
    """Also where they overlap."""
    waves = drawn(WaveSystem(2.0, 11.0, 2.0, 60.0), WaveSystem(1.5, 8.0, 2.0, -50.0))
    headings = np.degrees(np.asarray(waves.heading))
    assert set(headings.round(9)) == {60.0, -50.0}
    assert energy(waves)[headings > 0].sum() == pytest.approx(2.0**2 / 16, rel=0.05)
    assert energy(waves)[headings < 0].sum() == pytest.approx(1.5**2 / 16, rel=0.05)


def table(s: float = 8.0, hs: float = 2.0, source: float = 300.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """freq (Hz), dir (deg, from) and efth (m2/Hz/deg) of a JONSWAP sea with cos^2s spreading."""
    f, direction = np.linspace(0.04, 0.4, 73), np.arange(0.0, 360.0, 10.0)
    s_f = 2 * math.pi * np.asarray(spectra.jonswap(2 * math.pi * f, hs, 9.0, 2.0))
    d = np.asarray(spreading(np.radians(direction), math.radians(source), s)) * math.radians(1)
    return f, direction, s_f[:, None] * d


def as_csv(path: Path, f, direction, efth, header: str = "freq,dir,efth") -> Path:
    rows = [[a, b, efth[i, j]] for i, a in enumerate(f) for j, b in enumerate(direction)]
    np.savetxt(path, rows, delimiter=",", header=header, comments="")
    return path


def test_a_measured_spectrum_comes_from_csv_and_netcdf(tmp_path: Path) -> None:
    """Waves from 300 deg run to 120 deg by compass; of an x axis that points to 30 deg they run to -90 deg."""
    f, direction, efth = table()
    read = read_directional_spectrum(as_csv(tmp_path / "sea.csv", f, direction, efth), 30.0)
    data = xr.Dataset({"efth": (("time", "dir", "freq"), efth.T[None, ::-1])}, {"freq": f, "dir": direction[::-1]})
    data["efth"].attrs["units"] = "m2 s degree-1"
    data.to_netcdf(tmp_path / "sea.nc")
    from_netcdf = read_directional_spectrum(tmp_path / "sea.nc", 30.0)
    assert_allclose(from_netcdf.values, read.values, rtol=1e-12)
    assert_allclose(from_netcdf.heading, read.heading, rtol=1e-12)
    waves = directional_components(read, HOUR, WATER, **BAND)
    s_f = np.interp(np.asarray(waves.omega) / (2 * math.pi), f, efth.sum(axis=1) * 10.0, 0.0, 0.0)
    assert_allclose(energy(waves), s_f / float(waves.period), rtol=1e-9)
    moments = circular_moments(np.asarray(waves.heading), energy(waves))
    assert abs(math.remainder(moments.mean + 0.5 * math.pi, 2 * math.pi)) < 0.02
    # even parts of bins of 10 deg take sinc(5 deg) of the resultant
    bins = math.sin(math.radians(5)) / math.radians(5)
    assert moments.resultant == pytest.approx(8 / 9 * bins, abs=0.01)


def test_wavespectra_has_the_same_height_and_direction(tmp_path: Path) -> None:
    """An optional program: its Hs and mean direction of the same table."""
    pytest.importorskip("wavespectra")
    f, direction, efth = table()
    data = xr.Dataset({"efth": (("freq", "dir"), efth)}, {"freq": f, "dir": direction})
    read = read_directional_spectrum(as_csv(tmp_path / "sea.csv", f, direction, efth))
    m0 = float(np.trapezoid(read.values.sum(axis=1) * read.bin_width, read.omega))
    assert 4 * math.sqrt(m0) == pytest.approx(float(data.efth.spec.hs(tail=False)), rel=5e-3)
    mean = circular_moments(read.heading, read.values.sum(axis=0)).mean
    from_north = (-math.degrees(mean) - 180) % 360
    assert from_north == pytest.approx(float(data.efth.spec.dm()), abs=0.05)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"header": "freq,direction,efth"}, "a column dir, beside freq and efth, found freq, direction, efth"),
        ({"efth": -table()[2]}, "densities that are not negative"),
        ({"efth": 0 * table()[2]}, "with energy, found zeros only"),
        ({"direction": table()[1] ** 1.02}, "dir: expected even steps"),
    ],
)
def test_a_broken_file_is_told_in_one_message(tmp_path: Path, change: dict, words: str) -> None:
    f, direction, efth = table()
    parts = {"f": f, "direction": direction, "efth": efth, **change}
    with pytest.raises(InputError) as error:
        read_directional_spectrum(as_csv(tmp_path / "sea.csv", **parts))
    assert words in str(error.value) and len(error.value.problems) == 1
    with pytest.raises(InputError, match=r"none\.nc: expected a CSV, NetCDF, NDBC or SWAN file, found no such file"):
        read_directional_spectrum(tmp_path / "none.nc")
    data = xr.Dataset({"efth": (("freq",), f)}, {"freq": f})
    data.to_netcdf(tmp_path / "flat.nc")
    with pytest.raises(InputError, match="efth: expected a dimension dir with its values, found freq"):
        read_directional_spectrum(tmp_path / "flat.nc")


def test_a_negative_exponent_is_refused() -> None:
    with pytest.raises(ValueError, match="not negative, found -1"):
        WaveSystem(2.0, 9.0, spreading=-1.0)


def double_sum(waves: Components, depth: float, gravity: float) -> np.ndarray:
    """Second-order elevation by harmonic at the origin, but for the mean: Sharma and Dean's own D and B, term by term."""
    a = np.asarray(complex_amplitude(waves))
    k, kv, r = np.asarray(waves.wavenumber), np.asarray(vector(waves)).T, np.asarray(waves.omega) ** 2 / gravity
    first, last = waves.harmonics
    elevation = np.zeros(2 * last + 1, complex)
    for n in range(a.size):
        for m in range(n + 1):
            for sign in (1, -1):
                if n == m and sign < 0:
                    continue
                root_n, root_m, dot = math.sqrt(r[n]), math.sqrt(r[m]), float(kv[n] @ kv[m])
                size = float(np.linalg.norm(kv[n] + sign * kv[m]))
                beat = root_n + sign * root_m
                top = beat * (root_m * (k[n] ** 2 - r[n] ** 2) + sign * root_n * (k[m] ** 2 - r[m] ** 2))
                top += 2 * beat**2 * (dot - sign * r[n] * r[m])
                d = top / (beat**2 - size * math.tanh(size * depth))
                b = 0.25 * ((d - (dot - sign * r[n] * r[m])) / (root_n * root_m) + r[n] + r[m])
                pair = a[n] * (a[m] if sign > 0 else a[m].conj())
                elevation[(first + n) + sign * (first + m)] += (1 if n == m else 2) * b * pair
    return elevation


@pytest.mark.parametrize("depth", [200.0, 25.0])
def test_second_order_takes_each_pair_at_its_own_headings(depth: float) -> None:
    rng, n, first = np.random.default_rng(2), 14, 6
    omega = 2 * math.pi / 120.0 * np.arange(first, first + n)
    heading, phase = rng.normal(0.3, 0.8, n), rng.uniform(-3, 3, n)
    water = Environment(1025.0, depth)
    waves = components(rng.uniform(0.1, 1, n), omega, water, heading=heading, phase=phase, first=first)
    sea = jh.IrregularSea(waves, water, 2)
    expected = double_sum(waves, depth, float(water.gravity))
    bound = np.array(sea.bound_elevation())
    assert not sea.long_crested
    assert np.abs(bound - expected)[1:].max() < 1e-9 * np.abs(expected).max()
    times = np.linspace(0.0, 120.0, 7)
    exact = sea.direct()
    direct = [float(elevation(exact, t, np.zeros((2, 1)))[0]) for t in times.tolist()]
    assert_allclose(direct, sea.gauge(times), atol=1e-9)


def test_a_sweep_has_the_sea_of_simulate() -> None:
    """The same components; second order with spreading is refused by the schema."""
    made = {"platform": "oc3-hywind", "scatter": [{"hs": 3.0, "tp": 9.0, "gamma": 2.0}], "spreading": 5.0, "headings": [30]}
    with pytest.raises(InputError, match="order: expected 1 with spreading"):
        validate(Sweep, made, "sweep")
    plan, _ = plan_of(validate(Sweep, {**made, "order": 1, "low": 0.03, "cutoff": 0.3, "seeds": [4]}, "sweep"), "sweep")
    assert Plan.from_json(plan.to_json()) == plan
    setup = Setup(plan, jh.load_model("oc3-hywind"), np.arange(3.0), 0.2, None)
    sea, own = sea_of(setup, plan.run(0)), drawn(WaveSystem(3.0, 9.0, 2.0, 30.0, 5.0))
    assert (np.asarray(sea.components.heading) == np.asarray(own.heading)).all() and not sea.long_crested


def test_second_order_of_too_many_pairs_is_refused() -> None:
    """By one message, before anything is simulated."""
    sea = jh.IrregularSea(drawn(WaveSystem(3.0, 9.0, 2.0, 0.0, 10.0)), WATER, 2)
    with pytest.raises(ValueError, match=r"100 components at most, found 973\. Take order 1"):
        jh.simulate(jh.load_model("oc3-hywind"), np.arange(0.0, 10.0, 1.0), sea)
