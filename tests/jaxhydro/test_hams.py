"""HAMS's files in WAMIT's format: conventions, units, and the limits of frequency."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import brentq

from jaxhydro.interop.damping_that_takes_energy import taking_energy
from jaxhydro.interop.retardation import realise
from jaxhydro.interop.wamit_excitation import read_directional_excitation, read_excitation
from jaxhydro.interop.wamit_hydrostatics import read_hydrostatics
from jaxhydro.interop.wamit_radiation import read_wamit

DATA = Path(__file__).parents[1] / "data" / "hams-cylinder"
DENSITY, GRAVITY, DEPTH = 1025.0, 9.807, 10.0
RADIUS, DRAFT = 1.0, 0.5
RESOLVED = 2.5  # rad/s: shorter waves meet the steps of the mesh, 276 panels of 0.2 m
MASS, CENTRE = 1604.0, -0.3748  # kg, m: of HAMS's Hydrostatic.in, 601.23 / 1604


def waves(omega: float) -> tuple[float, float]:
    """Wavenumber (1/m) and group velocity (m/s)."""
    k = brentq(lambda k: GRAVITY * k * np.tanh(k * DEPTH) - omega**2, 1e-6, 1e3)
    return k, 0.5 * omega / k * (1 + 2 * k * DEPTH / np.sinh(min(2 * k * DEPTH, 500.0)))


def test_damping_is_that_of_the_forces() -> None:
    """B = k / (8 pi rho g c_g) of the integral of |X|² over headings: units of both files, and which is which.

    Newman (1962), The exciting forces on fixed bodies in waves, J. Ship Research 6(3); of a body of revolution.
    """
    radiation = read_wamit(DATA / "Buoy.1", DENSITY)
    force = np.asarray(read_excitation(DATA / "Buoy.3", DENSITY, GRAVITY).force)
    for i, omega in enumerate(radiation.omega):
        if omega > RESOLVED:
            continue
        k, speed = waves(float(omega))
        whole = k / (8 * np.pi * DENSITY * GRAVITY * speed)
        assert radiation.damping[i, 2, 2] == pytest.approx(whole * 2 * np.pi * abs(force[2, i]) ** 2, rel=0.01)
        assert radiation.damping[i, 0, 0] == pytest.approx(whole * np.pi * abs(force[0, i]) ** 2, rel=0.03)


def test_damping_that_gives_energy_is_taken_without_that() -> None:
    """The cylinder's roll damping is below zero at some frequencies; what is left can be followed."""
    table = read_wamit(DATA / "Buoy.1", DENSITY)
    assert table.damping[:, 3, 3].min() < 0
    mended, change = taking_energy(table)
    assert 0.0 < change < 0.15 and np.linalg.eigvalsh(mended.damping).min() > -1e-9 * mended.damping.max()
    assert_allclose(mended.damping[:, 2, 2], table.damping[:, 2, 2], rtol=0.01)
    assert realise(table).misfit > 0.9 and realise(mended).misfit < 0.02
    assert taking_energy(mended)[1] == 0.0
    assert taking_energy(table._replace(damping=-table.damping))[1] == 0.0  # a wrong sign is no inaccuracy


def test_phases_and_headings_are_wamits() -> None:
    """Of long waves: heave with the elevation, surge with its slope, a quarter ahead; heading 90 goes to +y."""
    table = read_directional_excitation(DATA / "Buoy.3", DENSITY, GRAVITY)
    ahead, across = (np.asarray(table.towards(np.radians(heading)).force)[:, 0] for heading in (0.0, 90.0))
    assert abs(np.angle(ahead[2])) < 0.02 and np.angle(ahead[0], deg=True) == pytest.approx(90.0, abs=1.0)
    assert across[1] == pytest.approx(ahead[0], rel=0.02) and abs(across[0]) < 0.02 * abs(ahead[0])


def test_limits_and_hydrostatics() -> None:
    """PER -1 is frequency zero and 0 an infinite one; C33 is rho g pi R², C44 has the weight."""
    radiation = read_wamit(DATA / "Buoy.1", DENSITY)
    assert radiation.zero is not None and radiation.infinite is not None
    assert radiation.zero[2, 2] == pytest.approx(radiation.added_mass[0, 2, 2], rel=0.02)
    assert radiation.infinite[2, 2] < radiation.added_mass[0, 2, 2]
    stiffness = read_hydrostatics(DATA / "Buoy.hst", DENSITY, GRAVITY).stiffness
    weight = DENSITY * GRAVITY * np.pi * RADIUS**2
    assert_allclose(stiffness[2, 2], weight, rtol=0.005)
    tilt = weight * (RADIUS**2 / 4 - DRAFT**2 / 2) - MASS * GRAVITY * CENTRE
    assert_allclose(np.diag(stiffness)[3:5], tilt, rtol=0.02)
