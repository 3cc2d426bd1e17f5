"""Platforms that are tables and matrices alone, without members: irregular seas, sweeps."""

import json
import math
from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

import jaxhydro as jh
from jaxhydro.dynamics.irregular_simulation import excursion_of
from jaxhydro.platform.build import load_model
from jaxhydro.sweep.batch import setup_of
from jaxhydro.sweep.cases import plan_of
from jaxhydro.sweep.resources import supports_of
from jaxhydro.sweep.sweep_schema import Sweep
from jaxhydro.waves.irregular import spectrum_components
from jaxhydro.waves.spectra import jonswap
from jaxhydro.waves.supports import Box

RHO, G = 1025.0, 9.80665


def platform_in(folder: Path, excitation: bool = True) -> Path:
    """A buoy whose forces are a table of WAMIT's: surge i 400 k, heave 80 exp(-10 k), over rho g."""
    rows = []
    for omega in np.linspace(0.15, 2.2, 80):
        k = omega**2 / G
        for mode in range(1, 7):
            value = {1: 400j * k, 3: 80 * math.exp(-10 * k)}.get(mode, 0j)
            value = complex(value)
            period, phase = 2 * math.pi / omega, math.degrees(math.atan2(value.imag, value.real))
            rows.append(f"{period:.6e} 0.0 {mode} {abs(value):.6e} {phase:.6e} {value.real:.6e} {value.imag:.6e}")
    (folder / "buoy.3").write_text("\n".join(rows) + "\n")
    data = {
        "name": "buoy",
        "water": {"density": RHO, "depth": 200.0},
        "rigid_body": {"mass": 1.6e6, "centre_of_mass": [0, 0, -8.0], "inertia": {"Ixx": 2e8, "Iyy": 2e8, "Izz": 5e7}},
        "mooring": {"kind": "stiffness_matrix", "stiffness": {"C11": 5e4, "C22": 5e4, "C66": 1e7}},
        "hydrostatics": {"displaced_volume": 1561.0, "C33": 8e5, "C44": 2e8, "C55": 2e8},
        "linear_damping": {"B11": 1e5, "B22": 1e5, "B33": 2e5, "B44": 2e7, "B55": 2e7},
        "added_mass": {"A11": 1.6e6, "A22": 1.6e6, "A33": 5e5},
    } | ({"excitation": {"file": "buoy.3"}} if excitation else {})
    file = folder / "platform.yaml"
    file.write_text(json.dumps(data), encoding="utf-8")
    return file


def response_to(omega: np.ndarray) -> dict[str, np.ndarray]:
    """Surge and heave (m/m) by the equation of motion in the frequency domain."""
    k = omega**2 / G
    surge = RHO * G * 400j * k / (5e4 - omega**2 * 3.2e6 + 1j * omega * 1e5)
    heave = RHO * G * 80 * np.exp(-10 * k) / (8e5 - omega**2 * 2.1e6 + 1j * omega * 2e5)
    return {"surge": surge, "heave": heave}


@pytest.mark.slow
@pytest.mark.parametrize("order", [1, 2])
def test_an_irregular_sea(tmp_path: Path, order: int) -> None:
    """After the transient the motion is that of the frequency domain, of first order whatever the sea's."""
    model = load_model(platform_in(tmp_path))
    waves = spectrum_components(
        lambda omega: jonswap(omega, 3.0, 11.0, 2.0), 600.0, model.environment, low=0.05, cutoff=0.2, seed=2
    )
    times = np.arange(0.0, 600.0, 0.5)
    position = np.asarray(jh.simulate(model, times, jh.IrregularSea(waves, model.environment, order)).position)
    late, omega = times > 500, np.asarray(waves.omega)
    turn = np.exp(1j * np.outer(times[late], omega)) * np.asarray(waves.complex_amplitude())
    heave = (turn @ response_to(omega)["heave"]).real
    assert_allclose(position[late, 2] - position[late, 2].mean(), heave - heave.mean(), atol=0.03 * heave.std())


@pytest.mark.slow
def test_a_sea_without_any_force_of_waves(tmp_path: Path) -> None:
    """Nothing moves, and nothing fails."""
    model = load_model(platform_in(tmp_path, excitation=False))
    waves = spectrum_components(
        lambda omega: jonswap(omega, 3.0, 11.0, 2.0), 100.0, model.environment, low=0.05, cutoff=0.2, seed=2
    )
    position = jh.simulate(model, np.arange(0.0, 60.0, 0.5), jh.IrregularSea(waves, model.environment, 1)).position
    assert float(jnp.abs(position).max()) < 0.02


def test_a_sweep_can_be_set_up(tmp_path: Path) -> None:
    """Supports are counted for the box about the reference point."""
    platform = platform_in(tmp_path)
    sweep = Sweep.model_validate({"platform": "p", "scatter": [{"hs": 3, "tp": 12, "probability": 1}], "duration": 600})
    setup = setup_of(plan_of(sweep, "sweep")[0], platform, None)
    assert 8 <= supports_of(setup) <= 48


def test_the_box_is_about_the_reference_point(tmp_path: Path) -> None:
    model = load_model(platform_in(tmp_path))
    points = model.hull.extremities()
    assert_allclose(points, np.zeros((3, 1)))
    middle, box = Box.of(points, 0.3, 200.0, excursion_of(model))
    assert middle == 0 and box.half >= excursion_of(model)
