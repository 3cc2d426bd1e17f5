"""Expected information of a further test, and ranking of candidate tests."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from calibration.campaign.manifest_sections import Test
from calibration.campaign.records import Record
from calibration.fitting.decay_fit import STEPS_PER_PERIOD
from calibration.fitting.fit import Fit
from calibration.formatting import listed, percent
from calibration.identifiability.directions import active_parameters, weak_directions
from calibration.identifiability.findings import Identifiability
from calibration.identifiability.information import shared_information, submatrix
from calibration.identifiability.statements import Direction, Parameters
from calibration.parameters.space import ParameterSpace
from calibration.residuals.abstract_residual import Unknowns
from calibration.residuals.decays import DecayProblem, gather_decays
from calibration.result import TestFit
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.simulate import free_decay
from jaxhydro.dynamics.statics import equilibrium, natural_modes
from jaxhydro.dynamics.time_steps import memory_step
from jaxhydro.environment import DOFS


@dataclass(frozen=True, eq=False)
class ExpectedGain:
    """What a further test would add to a calibration.

    Attributes:
        name: Name of the test.
        parameters: The free parameters.
        before: (p,) standard deviations of the coordinates before the test.
        after: (p,) standard deviations of the coordinates after the test.
        gain: Decrease of the logarithm of the confidence region's volume.
        weak: Directions that would still not be determined.
        untouched: Labels of parameters that no record would respond to.
    """

    name: str
    parameters: Parameters
    before: np.ndarray
    after: np.ndarray
    gain: float
    weak: tuple[Direction, ...]
    untouched: tuple[str, ...]

    def sentence(self) -> str:
        """Sentence on the test, with the three parameters that gain most."""
        best = [i for i in np.argsort(self.after / self.before)[:3] if self.after[i] < 0.9 * self.before[i]]
        pairs = [f"{self.parameters.labels[i]} from {percent(self.before[i])} to {percent(self.after[i])}" for i in best]
        remaining = f"{len(self.weak)} weak direction{'' if len(self.weak) == 1 else 's'} left"
        return f"{self.name}: {listed(pairs) or 'nothing much better known'}; {remaining}; log-volume {-self.gain:+.2f}"


def expected_information(current: Identifiability, candidate: np.ndarray, name: str = "a further test") -> ExpectedGain:
    """Compute what a further test would add to a calibration.

    The gain is 0.5 ln det(1 + C F), C the posterior covariance and F the test's information. It is finite also where the
    records leave a direction open.

    Args:
        current: What the records determine so far.
        candidate: (p, p) information of the test, its own unknowns eliminated.
        name: Name of the test.

    Returns:
        Standard deviations before and after, and the gain.

    References:
        Chaloner and Verdinelli 1995, Statistical Science 10, 273-304 (Bayesian D-optimality).
    """
    candidate = submatrix(candidate, [i for i, label in enumerate(current.parameters.labels) if label not in current.at_bound])
    values, vectors = np.linalg.eigh(current.covariance)
    root = vectors * np.sqrt(np.maximum(values, 0)) @ vectors.T
    ratio = np.eye(len(root)) + root @ candidate @ root
    after = root @ np.linalg.solve(ratio, root)
    together = current.information + candidate
    active, untouched = active_parameters(current.parameters, together, current.at_bound)
    before, later = np.sqrt(np.diag(current.covariance)), np.sqrt(np.diag(after))
    weak = weak_directions(current.parameters, together, active)
    return ExpectedGain(name, current.parameters, before, later, float(0.5 * np.linalg.slogdet(ratio)[1]), weak, untouched)


def rank_tests(current: Identifiability, candidates: Mapping[str, np.ndarray]) -> tuple[ExpectedGain, ...]:
    """Rank candidate tests, the one that adds most first.

    Args:
        current: What the records determine so far.
        candidates: (p, p) information of each test, by its name.

    Returns:
        What each test would add, in order.
    """
    gains = [expected_information(current, matrix, name) for name, matrix in candidates.items()]
    return tuple(sorted(gains, key=lambda gain: -gain.gain))


def effective_noise(fit: Fit, tests: Sequence[TestFit]) -> dict[str, float]:
    """Estimate the independent noise that has the effect of a fit's residuals on the parameters.

    It stands for the errors of a further test's samples at the same rate.

    Args:
        fit: A finished fit.
        tests: Measured and simulated series of its records, as `series_of` returns them.

    Returns:
        Standard deviation of the noise (m, rad), by channel.
    """
    variance, inflation = fit.decays.left_errors(tests)
    present = np.asarray(fit.decays.problem.data.present).any(axis=-1)
    power = (variance * inflation * present).sum(axis=0) / np.maximum(present.sum(axis=0), 1)
    return {DOFS[dof]: float(np.sqrt(x)) for dof, x in zip(fit.decays.problem.data.dofs, power, strict=True)}


@eqx.filter_jit
def _products(problem: DecayProblem, unknowns: Unknowns):
    return problem.products(unknowns)


def decay_information(
    model: Model,
    space: ParameterSpace,
    dof: str,
    amplitude: float,
    noise: Mapping[str, float],
    *,
    cycles: float = 8.0,
    interval: float | None = None,
) -> np.ndarray:
    """Compute the information of a free decay on the parameters; release and offsets are eliminated.

    Args:
        model: The model.
        space: The p free parameters.
        dof: Degree of freedom that is released, at rest.
        amplitude: Release from the equilibrium (m, rad).
        noise: Standard deviation of a sample (m, rad) by measured motion, independent from sample to sample.
            `effective_noise` of a fit at the same rate stands for its errors.
        cycles: Duration, in natural periods.
        interval: Time between samples (s); None for a fortieth of the period.

    Returns:
        (p, p) information.

    Raises:
        ValueError: If `dof` is not measured, or the model does not oscillate in it.
    """
    if dof not in noise:
        raise ValueError(f"noise: expected one of {dof}, the motion released, found {', '.join(noise) or 'none'}")
    modes = natural_modes(model)
    period = modes.of(dof)
    if not np.isfinite(period):
        raise ValueError(f"dof: expected a motion with a natural period, found {dof}, which nothing restores")
    time = np.arange(0.0, cycles * period, period / 40 if interval is None else interval)
    rest = equilibrium(model)
    motion = free_decay(model, {dof: amplitude}, time)
    values = {name: np.asarray(motion[name]) - float(rest[DOFS.index(name)]) for name in noise}
    stated = {"id": f"{dof} decay", "kind": "decay", "file": "simulated", "degree_of_freedom": dof}
    test = Test.model_validate(stated)
    record = Record(test.id, test.kind, test.use, dof, time, values, None, None, dict(noise), True, 0.0, test, test.file)
    data = gather_decays([record], model, min(float(modes.period.min()) / STEPS_PER_PERIOD, memory_step(model)))
    problem = DecayProblem(model, space, data, True, None if space.moves_equilibrium else rest)
    release = np.zeros((3, len(data.dofs)))
    release[0] = [values[DOFS[i]][0] / float(unit) for i, unit in zip(data.dofs, data.unit[0], strict=True)]
    x = jnp.array([p.transform.inverse(float(model.values[p.label])) for p in space.free])
    products = np.asarray(_products(problem, Unknowns(x, jnp.asarray(release.reshape(1, -1)))))
    variance = np.array([[noise[DOFS[i]] ** 2 for i in data.dofs]])
    return shared_information(products, 1 / variance, variance, np.ones(variance.shape), len(x))
