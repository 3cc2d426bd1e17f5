"""Linear motions of the hull of FOCAL campaign 2 in head waves, by WAMIT's coefficients."""

from collections.abc import Sequence

import numpy as np

from benchmarks.evidence.common import SHARED

FOLDER = SHARED / "measured"
DAMPED = (2e5, 2e5, 8e5, 6e8, 6e8, 1e8)  # N s/m, N m s/rad, beside radiation in potential flow: off resonance it is nothing


def linear_motions() -> tuple[np.ndarray, np.ndarray]:
    """Motions in a wave of unit amplitude at the gauge, with the mass and mooring of campaign 2.

    Returns:
        Frequencies (Hz; f,), and motions (complex; f, 6), a positive phase leading the wave.
    """
    import jax.numpy as jnp

    from jaxhydro.dynamics.statics import equilibrium, linearised
    from jaxhydro.platform.build import load_model
    from jaxhydro.waves.dispersion import wavenumber

    model = load_model(FOLDER / "focal-c2" / "platform.yaml")
    water, body = model.environment, np.asarray(model.body.mass_matrix())
    mean = np.asarray(equilibrium(model))
    stiffness = np.asarray(linearised(model, jnp.asarray(mean))[1])
    added: dict[float, np.ndarray] = {}
    forces: dict[float, np.ndarray] = {}
    for line in (FOLDER / "focal-c4" / "wamit" / "semi.1").read_text().splitlines():
        row = [float(cell) for cell in line.split()]
        if row[0] > 0:  # zero and infinite frequency are told by a period that is not
            i, j, omega = int(row[1]) - 1, int(row[2]) - 1, 2 * np.pi / row[0]
            entry = added.setdefault(row[0], np.zeros((6, 6), complex))
            entry[i, j] = water.density * (-(omega**2) * row[3] + 1j * omega**2 * row[4])
    for row in np.loadtxt(FOLDER / "focal-c4" / "wamit" / "semi.3"):
        if abs(row[1]) < 1e-6:
            force = forces.setdefault(row[0], np.zeros(6, complex))
            force[int(row[2]) - 1] = float(water.density * water.gravity) * (row[5] + 1j * row[6])
    periods = sorted(set(added) & set(forces), reverse=True)
    motions = []
    for period in periods:
        omega = 2 * np.pi / period
        impedance = added[period] - omega**2 * body + 1j * omega * np.diag(DAMPED) + stiffness
        k = float(wavenumber(jnp.asarray(omega), water.depth, water.gravity))
        motions.append(np.linalg.solve(impedance, forces[period]) * np.exp(-1j * k * mean[0]))  # it rests behind the gauge
    return 1 / np.array(periods), np.array(motions)


def interpolated(frequency: np.ndarray, values: np.ndarray, points: Sequence[float]) -> np.ndarray:
    """Complex values at other frequencies (Hz)."""
    return np.interp(points, frequency, values.real) + 1j * np.interp(points, frequency, values.imag)
