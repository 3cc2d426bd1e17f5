"""Excitation and drift tables between their headings: exact solutions, WAMIT's own finer table, short-crested seas."""

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import complex_amplitude, drift, one_program, vector
from scipy.special import jv

import jaxhydro as jh
from jaxhydro.environment import Environment
from jaxhydro.interop.table_headings import covers, spoken
from jaxhydro.interop.wamit_drift import read_directional_transfer, read_transfer
from jaxhydro.interop.wamit_excitation import read_directional_excitation, read_excitation
from jaxhydro.waves.directional_spectrum import SystemsSpectrum, WaveSystem, directional_components
from jaxhydro.waves.directional_transfer import DirectionalTransfer
from jaxhydro.waves.excitation import DirectionalExcitation, Excitation
from jaxhydro.waves.heading_interpolation import HeadingInterpolation

WATER = Environment(1025.0, 200.0)
SHARED = Path(__file__).resolve().parents[3] / "shared" / "reference"
WAMIT = SHARED / "iea15-umaine" / "HydroData" / "IEA-15-240-RWT-UMaineSemi.3"
GRID = np.linspace(0.1, 2.0, 11)  # rad/s


def cylinder(heading: float) -> np.ndarray:
    """Force of a slender vertical cylinder away from the origin, in waves of a wavenumber of 0.1 rad/m, (6,)."""
    c, s = math.cos(heading), math.sin(heading)
    phase = np.exp(-0.1j * (40.0 * c + 25.0 * s))
    return np.array([c, s, 0.3, -10 * s, 10 * c, 40.0 * s - 25.0 * c]) * phase


@pytest.mark.parametrize("step", [10.0, 20.0])
def test_round_the_circle_headings_are_exact_up_to_their_harmonics(step: float) -> None:
    """36 headings resolve 18 harmonics, 18 headings 9; the others are at most counted twice, once where they alias to.

    cos b exp(-i k R cos b) has harmonics (J(m-1) ± J(m+1)) / 2 of k R = 4.7 (Jacobi and Anger).
    """
    m = np.arange(round(180.0 / step), 60)
    reach = 0.1 * math.hypot(40.0, 25.0)
    limit = 2 * float((np.abs(jv(m - 1, reach)) + np.abs(jv(m + 1, reach))).sum()) + 1e-6  # and the spline between
    headings = np.radians(np.arange(-180.0, 180.0 + step, step))
    actual = HeadingInterpolation.of(headings, np.stack([cylinder(b) for b in headings]))
    assert actual.wraps and actual.covers(np.array([7.0, -9.0])).all()
    for heading in np.linspace(-7.0, 7.0, 37):
        error = np.abs(np.asarray(actual.at(heading)) - cylinder(heading)) / np.array([1, 1, 1, 10, 10, 47])
        assert error.max() < limit, heading
    for heading in headings:  # of the table itself, and a whole turn on: without rounding
        assert_allclose(np.asarray(actual.at(heading)), cylinder(heading), atol=1e-13)


def test_part_of_the_circle_is_interpolated_and_not_left() -> None:
    headings = np.radians([330.0, 340.0, 350.0, 0.0, 10.0, 20.0, 30.0])
    actual = HeadingInterpolation.of(headings, np.stack([cylinder(b) for b in headings]))
    inside = np.radians([-30.0, -5.0, 30.0, 390.0])
    assert actual.covers(inside).all() and not actual.covers(np.radians([-31.0, 31.0, 180.0])).any()
    for heading in inside:
        assert np.abs(np.asarray(actual.at(heading)) - cylinder(heading)).max() < 0.02 * 47
    assert covers(np.array([0.0, 90.0]), 45.0) and not covers(np.array([0.0, 90.0]), -10.0)
    assert covers(np.arange(0.0, 360.0, 30.0), -10.0) and spoken(np.degrees(headings)) == "330 to 390"


@pytest.mark.skipif(not WAMIT.exists(), reason="../shared/reference has no iea15-umaine")
def test_every_second_heading_of_wamit_is_found_from_the_others(tmp_path: Path) -> None:
    """Of the IEA 15 MW's semi-submersible, 20 deg for 10 deg: 1 % of the largest force at the most, up to 0.15 Hz."""
    rows = np.loadtxt(WAMIT)
    rows = rows[rows[:, 0] > 1 / 0.15]
    np.savetxt(tmp_path / "whole.3", rows)
    np.savetxt(tmp_path / "half.3", rows[rows[:, 1] % 20 == 0])
    half = read_directional_excitation(tmp_path / "half.3", 1025.0, 9.81)
    size = np.abs(np.asarray(half.by_heading.coefficient)[3]).max(axis=0)  # over headings
    worst = 0.0
    for heading in (10.0, 50.0, 90.0, -130.0):
        own = read_excitation(tmp_path / "whole.3", 1025.0, 9.81, heading=heading)
        interpolated = half.towards(math.radians(heading))
        worst = max(worst, float((np.abs(np.asarray(interpolated.force) - np.asarray(own.force)) / size).max()))
    assert 1e-5 < worst < 0.01
    own = read_excitation(tmp_path / "half.3", 1025.0, 9.81, heading=-140.0)
    assert_allclose(np.asarray(half.towards(math.radians(-140)).force), np.asarray(own.force), rtol=1e-9, atol=1e-6)


def axisymmetric() -> DirectionalExcitation:
    """Excitation of a body of revolution: surge as cos, sway as sin, heave alike."""
    headings = np.radians(np.arange(0.0, 360.0, 15.0))
    shape = np.linspace(1.0, 2.0, 11) * np.exp(0.3j)
    parts = [np.array([math.cos(b), math.sin(b), 0.5, -math.sin(b), math.cos(b), 0.0])[:, None] * shape for b in headings]
    return DirectionalExcitation.of(headings, [Excitation.of(GRID, part) for part in parts])


@pytest.mark.parametrize("s", [1.0, 8.0])
def test_an_axisymmetric_body_heaves_as_in_a_long_crested_sea(s: float) -> None:
    """Forces at the origin: heave alike, surge and sway by the mean of cos² and sin², (1 ± r2 cos 2 mean) / 2."""
    spectrum = {"low": 0.03, "cutoff": 0.3, "seed": 2}
    long_crested, short_crested = (
        directional_components(SystemsSpectrum((WaveSystem(3.0, 9.0, 2.0, 25.0, spread),)), 3600.0, WATER, **spectrum)
        for spread in (None, s)
    )
    forces = one_program(lambda table, waves: table.at(waves.omega, waves.heading) * waves.complex_amplitude())
    long, short = (np.abs(np.asarray(forces(axisymmetric(), waves))) ** 2 for waves in (long_crested, short_crested))
    variance, crossing = long.sum(axis=1), short.sum(axis=1)
    assert crossing[2] == pytest.approx(variance[2], rel=1e-7)
    assert crossing[:2].sum() == pytest.approx(variance[:2].sum(), rel=1e-7)
    second = s * (s - 1) / ((s + 1) * (s + 2))  # second Fourier coefficient of D
    expected = 0.5 * (1 + second * math.cos(2 * math.radians(25)))
    assert crossing[0] / crossing[:2].sum() == pytest.approx(expected, abs=0.015)


def test_a_sea_has_the_force_of_every_component_at_its_heading() -> None:
    """`WaveSea.excitation`, against a plain sum; and a table of one heading where it goes that way."""
    system = (WaveSystem(3.0, 9.0, 2.0, 25.0, 6.0),)
    waves = directional_components(SystemsSpectrum(system), 300.0, WATER, low=0.05, cutoff=0.2, seed=2)
    table, position, time = axisymmetric(), np.array([4.0, -7.0]), 33.0
    sea = jh.IrregularSea(waves, WATER, 1).direct().with_tables(table, None)
    omega, heading = np.asarray(waves.omega), np.asarray(waves.heading)
    turn = np.exp(1j * (omega * time - position @ np.asarray(vector(waves))))
    towards = one_program(lambda table, heading, omega: table.towards(heading).at(omega))
    parts = [np.asarray(towards(table, b, omega[i : i + 1]))[:, 0] for i, b in enumerate(heading.tolist())]
    expected = (np.array(parts).T @ (np.asarray(complex_amplitude(waves)) * turn)).real
    actual = one_program(lambda sea, time, position: sea.excitation(time, position))(sea, time, position)
    assert_allclose(actual, expected, atol=1e-9)


def quadratic(seed: int = 1, n: int = 11) -> np.ndarray:
    rng = np.random.default_rng(seed)
    table = rng.normal(size=(6, n, n)) + 1j * rng.normal(size=(6, n, n))
    return table + np.conj(np.swapaxes(table, 1, 2))


def test_drift_of_several_headings_is_newmans_sum_over_pairs() -> None:
    """(T_kk + T_ll) / 2, each at its own heading, by the double sum; the full table is refused there."""
    headings = np.radians(np.arange(0.0, 360.0, 30.0))
    tables = [quadratic() * (2 + math.cos(b)) for b in headings]
    table = DirectionalTransfer.of(GRID, headings, tables, newman=True)
    system = (WaveSystem(3.0, 9.0, 2.0, 25.0, 6.0),)
    waves = directional_components(SystemsSpectrum(system), 200.0, WATER, low=0.05, cutoff=0.2, seed=2)
    sea = jh.IrregularSea(waves, WATER, 1).direct()
    a = np.asarray(complex_amplitude(waves)) * np.exp(1j * np.asarray(waves.omega) * 12.0)
    curve = np.einsum("ikk->ik", quadratic()).real
    at = np.array([np.interp(np.asarray(waves.omega), GRID, row) for row in curve]) * (2 + np.cos(np.asarray(waves.heading)))
    expected = [np.einsum("k,l,kl->", a, a.conj(), 0.5 * (row[:, None] + row)).real for row in at]
    actual = np.asarray(drift(sea.with_tables(None, table), 12.0))[4:]
    assert_allclose(actual, expected, rtol=1e-4)
    full = DirectionalTransfer.of(GRID, headings, tables)
    with pytest.raises(ValueError, match="no pairs of waves of two headings"):
        drift(sea.with_tables(None, full), 12.0)
    wave = jh.regular_wave(2.0, 9.0, WATER, heading=0.4).with_tables(None, full)
    omega = 2 * math.pi / 9.0
    mean = [np.interp(omega, GRID, row) * (2 + math.cos(0.4)) for row in curve]
    assert_allclose(np.asarray(drift(wave, 1.0))[4:], mean, rtol=1e-4)


def test_drift_tables_are_read_for_all_headings(tmp_path: Path) -> None:
    """Each as `read_transfer` has it; pairs of two headings are left out."""
    table, rows = quadratic(n=3), []
    for beta in (0.0, 30.0):
        for k in range(3):
            for j in range(3):
                value = table[0, k, j] * (1 + beta)
                size, angle = abs(value), math.degrees(np.angle(value))
                rows.append([8.0 + k, 8.0 + j, beta, beta, 1, size, angle, value.real, value.imag])
    rows.append([8.0, 8.0, 0.0, 30.0, 1, 1.0, 0.0, 1.0, 0.0])
    np.savetxt(tmp_path / "hull.12d", rows)
    actual = read_directional_transfer(tmp_path / "hull.12d", 1025.0, 9.81, length=2.0)
    for beta in (0.0, 30.0):
        own, by_heading = (
            read_transfer(tmp_path / "hull.12d", 1025.0, 9.81, length=2.0, heading=beta),
            actual.towards(math.radians(beta)),
        )
        force = one_program(lambda table: table.force(table.filters @ np.array([1.0, 0.3j, -0.2])))
        assert_allclose(force(by_heading), force(own), rtol=1e-9)
