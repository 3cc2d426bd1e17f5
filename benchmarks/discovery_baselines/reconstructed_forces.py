"""Reconstructed forces of a campaign: what its fitted baseline lacks, by motion and test, and what they do to motions."""

import pickle
import time
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from calibration.campaign.load_campaign import load_campaign
from calibration.discovery.baseline_fit import fit_baseline
from calibration.discovery.campaign_study import highest_frequency
from calibration.discovery.diagnosis_fits import calibration_of
from calibration.discovery.latent_force.recover_force import accelerations, forces_of, resampled_tests
from calibration.discovery.latent_force.recovered_force import RecoveredForce, ResampledTest
from calibration.discovery.search import Search
from calibration.discovery.study_set_up import set_up_study
from calibration.residuals.wave_options import options_of
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.statics import equilibrium, linearised
from jaxhydro.environment import DOFS

EVERY = 10  # samples of which one counts for the mean damping
RATE_STEP = 1e-4  # m/s, rad/s, of the derivative by velocity


class ForcedTest(NamedTuple):
    """Forces that the fitted baseline lacks in one test.

    Attributes:
        forces: Force by motion. Its test has no sea.
        mass: Mass matrix with added mass of the m motions (m, m).
        damping: Mean derivative of the force by velocity, negative (m, m).
        stiffness: Stiffness matrix (m, m).
        relative: RMSE over standard deviation by scored motion.
    """

    forces: dict[str, RecoveredForce]
    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    relative: dict[str, float]

    @property
    def test(self) -> ResampledTest:
        """The test."""
        return next(iter(self.forces.values())).test

    def motion_under(self, force: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
        """Steady linear response (m, rad) by motion to forces (N, N m; n,) by motion."""
        count = len(self.test.time)
        omega = 2 * np.pi * np.fft.rfftfreq(count, self.test.step)[:, None, None]
        lines = np.stack([np.fft.rfft(force.get(name, np.zeros(count))) for name in self.forces], axis=1)
        impedance = self.stiffness - omega**2 * self.mass + 1j * omega * self.damping
        response = np.linalg.solve(impedance, lines[..., None])[..., 0]
        return {name: np.fft.irfft(response[:, j], count) for j, name in enumerate(self.forces)}

    def errors_with(self, force: Mapping[str, np.ndarray]) -> dict[str, float]:
        """RMSE over standard deviation by scored motion, with forces (n,) by motion in the model.

        The residual's mean square falls by what the forces take of the motion that the reconstructed forces make. What those
        do not make of the residual stays: noise, and motion that is faster than is reconstructed.
        """
        count, errors = len(self.test.time), {}
        made = self.motion_under({name: recovered.force for name, recovered in self.forces.items()})
        remaining = self.motion_under(
            {name: recovered.force - force.get(name, np.zeros(count)) for name, recovered in self.forces.items()}
        )
        for name, relative in self.relative.items():
            inside, noise = self.forces[name].inside, self.test.noise[name]
            residual = self.test.measured[name] - self.test.simulated[name]
            squares = [float(np.mean(series[inside] ** 2)) for series in (residual, made[name], remaining[name])]
            unexplained = max(squares[0] - squares[1], noise**2)
            errors[name] = relative * ((squares[2] + unexplained) / (squares[1] + unexplained)) ** 0.5
        return errors


class Reconstruction(NamedTuple):
    """Reconstructed forces of a campaign.

    Attributes:
        tests: Forces by test.
        minutes: Time that the fit and the forces took (min).
    """

    tests: list[ForcedTest]
    minutes: float

    def of_use(self, use: str) -> list[ForcedTest]:
        """Tests of a use (fit, holdout)."""
        return [test for test in self.tests if test.test.use == use]

    def motions(self) -> list[str]:
        """Motions with a force above the noise in a fitted test."""
        return [name for name in DOFS if any(name in test.forces and test.forces[name].visible for test in self.of_use("fit"))]


def mean_damping(model: Model, test: ResampledTest, forces: Mapping[str, RecoveredForce], mass: np.ndarray) -> np.ndarray:
    """Mean over a test of the force's derivative by velocity, negative (6, 6); columns of other motions are zero."""
    time, equilibrium_position = test.time[::EVERY], np.asarray(equilibrium(model))
    position, rate = np.tile(equilibrium_position, (len(time), 1)), np.zeros((len(time), 6))
    for name, recovered in forces.items():
        j = DOFS.index(name)
        position[:, j] += recovered.simulated[0][::EVERY]
        rate[:, j] = recovered.simulated[1][::EVERY]
    damping = np.zeros((6, 6))
    for j in (DOFS.index(name) for name in forces):
        step = RATE_STEP * np.eye(6)[j]
        ahead, behind = (accelerations(model, test.sea, time, position, rate + sign * step) for sign in (1, -1))
        damping[:, j] = -mass @ (ahead - behind).mean(axis=0) / (2 * RATE_STEP)
    return damping


def reconstruct(folder: Path) -> Reconstruction:
    """Fit the baseline of a campaign as `diagnose` does, and reconstruct the forces that it lacks."""
    begun = time.monotonic()
    campaign = load_campaign(folder)
    search = Search.of(campaign, set_up_study(campaign, options_of(campaign)), lambda *_: None)
    fitted = calibration_of(campaign, search.fits, fit_baseline(search), None)
    model = fitted.model
    equilibrium_position = equilibrium(model)
    mass, stiffness = (np.asarray(matrix) for matrix in linearised(model, equilibrium_position))
    base = np.asarray(equilibrium_position) * (campaign.manifest.zero is not None)
    scored = {
        test.id: {series.channel: float(series.relative) for series in test.series if series.scored} for test in fitted.tests
    }
    tests = []
    for test in resampled_tests(search.fits, fitted):
        forces = forces_of(model, test, base, highest_frequency(model))
        block = np.ix_(*[[DOFS.index(name) for name in forces]] * 2)
        damping = mean_damping(model, test, forces, mass)
        bare = test._replace(sea=None)
        forces = {name: recovered._replace(test=bare) for name, recovered in forces.items()}
        tests.append(ForcedTest(forces, mass[block], damping[block], stiffness[block], scored[test.id]))
    return Reconstruction(tests, (time.monotonic() - begun) / 60)


def reconstructed(folder: Path, saved: Path) -> Reconstruction:
    """`reconstruct`, kept in a file: other methods take it from there."""
    if saved.exists():
        return pickle.loads(saved.read_bytes())
    reconstruction = reconstruct(folder)
    saved.parent.mkdir(parents=True, exist_ok=True)
    part = saved.with_suffix(".part")
    part.write_bytes(pickle.dumps(reconstruction))
    part.replace(saved)
    return reconstruction
