"""Bootstrap of a calibration, over repeats of tests or over blocks of residuals.

The draws go through one compiled program in one process, CHUNK_SIZE of them side by side in every operation. For a body without
members that halves the time of a refit. For a hull of hundreds of strips it takes as long as one after the other.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float
from scipy.stats import norm

from calibration.fitting.normal_equations import LeastSquares, clipped, normal_equations
from calibration.identifiability.information import WEAK_PRIOR_ROUNDING, pseudo_inverse
from calibration.identifiability.standard_deviations import correlated_samples
from calibration.residuals.abstract_residual import Unknowns
from calibration.residuals.decays import DecayProblem
from calibration.uncertainty.likelihood import DEFAULT_LEVEL, Likelihood
from jaxhydro.choices import check
from jaxhydro.errors import InputError
from jaxhydro.errors import Problem as Wrong
from jaxhydro.interrupts import stop_if_asked

if TYPE_CHECKING:
    from arviz import InferenceData

CHUNK_SIZE = 16
MAX_STEPS = 12  # Gauss-Newton at most
MAX_STEP = 0.7  # step of a coordinate
MAX_LAST_STEP = 0.03  # standard deviations that the last step moves at most
MIN_FREEDOM = 0.25  # a residual that a fit has taken three quarters of is raised twofold, and no more

Progress = Callable[[int, int], None]
Prior = tuple[Float[Array, " p"], Float[Array, " p"]]


@dataclass(frozen=True, eq=False)
class Bootstrap:
    """Bootstrap draws of the free parameters.

    Attributes:
        method: "repeats" or "blocks".
        labels: Names of the p parameters.
        coordinate: (d, p) coordinates of the draws.
        value: (d, p) values of the draws, in the parameters' units.
        estimate: (p,) coordinates of the fit.
        groups: Names of repeated tests by the first one's; or length of a block (s) by record.
        unsettled: Number of draws that had not converged; these are kept unless they diverged.
        seed: Seed of the random numbers.
        likelihood: Likelihood of the fit.
    """

    method: Literal["repeats", "blocks"]
    labels: tuple[str, ...]
    coordinate: np.ndarray
    value: np.ndarray
    estimate: np.ndarray
    groups: dict[str, tuple[str, ...] | float]
    unsettled: int
    seed: int
    likelihood: Likelihood

    def deviation(self) -> np.ndarray:
        """Standard deviations (p,) of the coordinates."""
        return np.asarray(self.coordinate.std(axis=0, ddof=1))

    def interval(
        self, label: str, level: float = DEFAULT_LEVEL, kind: Literal["percentile", "basic", "normal"] = "percentile"
    ) -> tuple[float, float]:
        """Confidence interval of a parameter, in its own unit.

        Args:
            label: Label of the parameter.
            level: Probability of the interval.
            kind: "percentile": quantiles of the draws. "basic": these mirrored at the estimate, which takes a bias off.
                "normal": the estimate and the draws' standard deviation, for which 50 draws are enough.

        Returns:
            Lower and upper end.

        Raises:
            InputError: The label is unknown.
            UnknownName: The kind is unknown.

        References:
            Davison and Hinkley 1997, chapter 5.
        """
        check(kind=(kind, ("percentile", "basic", "normal")))
        i, sides = self.likelihood.index(label), [0.5 - 0.5 * level, 0.5 + 0.5 * level]
        ends = np.quantile(self.coordinate[:, i], sides)
        if kind == "normal":
            ends = self.estimate[i] + norm.ppf(sides) * self.deviation()[i]
        if kind == "basic":
            ends = (2 * self.estimate[i] - ends)[::-1]
        low, high = sorted(self.likelihood.value(label, float(x)) for x in ends)
        return low, high

    def __repr__(self) -> str:
        """Method, and numbers of draws and parameters."""
        draws, count = self.value.shape
        return f"Bootstrap over {self.method}: {draws} draws of {count} parameters, {self.unsettled} of them not converged"

    def to_arviz(self) -> InferenceData:
        """Draws as ArviZ's inference data (an extra: pip install jaxhydro[arviz]).

        Returns:
            Inference data whose group `posterior` has a variable for each parameter, by chain and draw, in its own unit. The
            draws are one chain. They are a sampling distribution, not a posterior: the attribute `method` says so.

        Raises:
            ImportError: ArviZ is not installed.
        """
        from calibration.display.arviz_draws import inference_data

        return inference_data(self)


@eqx.filter_jit
def _steps(
    problem: DecayProblem,
    unknowns: Unknowns,
    measured: Float[Array, "d r c t"],
    weight: Float[Array, "d r c"],
    prior: Prior,
) -> Unknowns:
    """One Gauss-Newton step of many draws at once, none longer than MAX_STEP."""

    def stepped(unknowns, measured, weight):
        resampled = eqx.tree_at(lambda q: q.data.measured, problem, measured)
        info, _ = normal_equations(unknowns, LeastSquares((resampled,), (weight,), *prior))
        step = clipped(info.hessian.solve(info.grad), MAX_STEP)
        return Unknowns(unknowns.shared - step.shared, unknowns.own - step.own)

    return jax.vmap(stepped)(unknowns, measured, weight)


def bootstrap_repeats(likelihood: Likelihood, draws: int = 200, seed: int = 0, progress: Progress | None = None) -> Bootstrap:
    """Bootstrap over repeated tests (`repeat_of` in the manifest).

    Of n repeats n - 1 are drawn with replacement, and weigh n / (n - 1) each. This has the right variance even for two or
    three repeats. A test without repeats is in every draw, so that its own scatter is not counted.

    Args:
        likelihood: Likelihood of a finished fit.
        draws: Number of draws.
        seed: Seed of the random numbers.
        progress: Function that is called with the number of draws done and asked for.

    Returns:
        The draws.

    Raises:
        InputError: If there are no repeats.

    References:
        Rao and Wu 1988, Journal of the American Statistical Association 83, 231-241, section 2.
    """
    records = likelihood.fit.decays.records
    groups = repeats({record.id: record.test.repeat_of for record in records})
    if not any(len(group) > 1 for group in groups.values()):
        ids = ", ".join(record.id for record in records)
        hint = "Say `repeat_of: <id>` in the manifest, or bootstrap over blocks."
        raise InputError("bootstrap", [Wrong("tests", "repeats of a fitted test", f"none among {ids}", hint)])
    order = {record.id: i for i, record in enumerate(records)}
    random, weight = np.random.default_rng(seed), np.ones((draws, len(records)))
    for group in groups.values():
        n = len(group)
        if n > 1:
            count = random.multinomial(n - 1, np.full(n, 1 / n), size=draws)
            weight[:, [order[id] for id in group]] = count * n / (n - 1)
    weights = weight[:, :, None] * np.asarray(likelihood.fit.decays.weight)

    def inputs(k: slice) -> tuple[np.ndarray, np.ndarray]:
        measured = np.asarray(likelihood.fit.decays.problem.data.measured)
        return np.broadcast_to(measured, (len(weights[k]), *measured.shape)), weights[k]

    return _drawn(likelihood, "repeats", inputs, draws, seed, dict(groups), progress)


def repeats(repeat_of: dict[str, str | None]) -> dict[str, tuple[str, ...]]:
    """Ids of tests that repeat each other, by the id of the first one.

    An id that is not among the tests stands for the tests that repeat it.

    Args:
        repeat_of: `repeat_of` of every test, by its id.
    """
    groups: dict[str, tuple[str, ...]] = {}
    for id in repeat_of:
        first, visited = id, {id}
        while (original := repeat_of.get(first)) is not None and original not in visited:
            first = original
            visited.add(original)
        # a ring has no first: the least of its ids
        first = min(visited) if repeat_of.get(first) is not None else first
        groups[first] = (*groups.get(first, ()), id)
    return groups


def bootstrap_blocks(likelihood: Likelihood, draws: int = 200, seed: int = 0, progress: Progress | None = None) -> Bootstrap:
    """Bootstrap over moving blocks of the residuals, added to the fitted motion and fitted again.

    A block is as long as the released motion's period or twice the residual's correlation length, and at most a third of
    the record. The channels of a record are drawn together. The fit has made residuals near the decay's frequency too
    small. They are raised by (1 - h)^-1/2 at each frequency, with the leverage h there (HC2).

    Args:
        likelihood: Likelihood of a finished fit.
        draws: Number of draws.
        seed: Seed of the random numbers.
        progress: Function that is called with the number of draws done and asked for.

    Returns:
        The draws.

    References:
        Kuensch 1989, Annals of Statistics 17, 1217-1241 (moving blocks). MacKinnon and White 1985, Journal of Econometrics
        29, 305-325 (HC2).
    """
    fit = likelihood.fit
    raised, lengths = _raised(likelihood), {}
    for i, record in enumerate(fit.decays.records):
        n = len(record.time)
        step = float(record.time[-1] - record.time[0]) / (n - 1)
        period = 2 * np.pi / float(fit.decays.problem.data.pace[i]) / step
        size = max([period, *(2 * correlated_samples(raised[i, j, :n]) for k, j in likelihood.spectra if k == i)])
        lengths[record.id] = max(1, min(round(size), n // 3)), step
    random = np.random.default_rng(seed)
    fitted = np.asarray(fit.decays.problem.data.measured) + likelihood.residual
    weight = np.asarray(fit.decays.weight)

    def inputs(k: slice) -> tuple[np.ndarray, np.ndarray]:
        count = len(range(draws)[k])
        noise = np.zeros((count, *fitted.shape))
        for i, record in enumerate(fit.decays.records):
            n, length = len(record.time), lengths[record.id][0]
            first = random.integers(0, n - length + 1, size=(count, -(-n // length)))
            indices = (first[:, :, None] + np.arange(length)).reshape(count, -1)[:, :n]
            noise[:, i, :, :n] = np.moveaxis(raised[i][:, indices], 0, 1)
        present = np.asarray(fit.decays.problem.data.present)
        return (fitted - noise) * present, np.broadcast_to(weight, (count, *weight.shape))

    groups: dict[str, tuple[str, ...] | float] = {id: length * step for id, (length, step) in lengths.items()}
    return _drawn(likelihood, "blocks", inputs, draws, seed, groups, progress)


def _raised(likelihood: Likelihood) -> np.ndarray:
    """Residuals (r, c, t) of mean zero, raised for the share that the fit has absorbed."""
    raised = np.zeros(likelihood.residual.shape)
    for (i, j), spectrum in likelihood.spectra.items():
        n = len(likelihood.fit.decays.records[i].time)
        wave = np.fft.rfft(likelihood.residual[i, j, :n]) / np.sqrt(np.maximum(spectrum.freedom, MIN_FREEDOM))
        wave[0] = 0.0
        raised[i, j, :n] = np.fft.irfft(wave, n)
    return raised


def _linear(likelihood: Likelihood, measured: np.ndarray, weight: np.ndarray) -> Unknowns:
    """Unknowns of the draws by the slopes at the estimate.

    This needs no simulation, and is exact for a model that is linear in its unknowns.
    """
    fit, slope = likelihood.fit, likelihood.slope
    data, p = fit.decays.problem.data, len(fit.decays.problem.space.free)
    residual = likelihood.residual + (np.asarray(data.measured) - measured) * np.asarray(data.present)
    score = np.einsum("rctk,drct,drc->drk", slope, residual, weight)
    mean, ridge = map(np.asarray, (fit.mean, fit.ridge))
    shared = score[..., :p].sum(axis=1) + ridge**2 * (likelihood.estimate[:p] - mean)
    step = -np.concatenate([shared, score[..., p:].reshape(len(score), -1)], axis=1) @ pseudo_inverse(
        likelihood.hessian, WEAK_PRIOR_ROUNDING
    )
    step *= np.minimum(1.0, MAX_STEP / np.maximum(np.abs(step).max(axis=1, keepdims=True), 1e-300))
    own = fit.unknowns.own
    return Unknowns(fit.unknowns.shared + step[:, :p], own + step[:, p:].reshape(-1, *own.shape))


def _drawn(
    likelihood: Likelihood,
    method: Literal["repeats", "blocks"],
    inputs: Callable[[slice], tuple[np.ndarray, np.ndarray]],
    draws: int,
    seed: int,
    groups: dict[str, tuple[str, ...] | float],
    progress: Progress | None,
) -> Bootstrap:
    """Refit all draws, CHUNK_SIZE at once."""
    fit = likelihood.fit
    prior = (jnp.asarray(fit.mean), jnp.asarray(fit.ridge))
    scale, coordinates, unsettled = likelihood.deviation(), [], 0
    for begin in range(0, draws, CHUNK_SIZE):
        series, weights = inputs(slice(begin, min(begin + CHUNK_SIZE, draws)))
        count = len(weights)
        # the last chunk is filled up, so that one compilation serves all
        fill = [(0, CHUNK_SIZE - count), (0, 0), (0, 0)]
        measured = jnp.asarray(np.pad(series, [*fill, (0, 0)], mode="edge"))
        weight = jnp.asarray(np.pad(weights, fill, mode="edge"))
        unknowns, change = _linear(likelihood, np.asarray(measured), np.asarray(weight)), np.full((CHUNK_SIZE, 1), np.inf)
        for _ in range(MAX_STEPS):
            stop_if_asked()
            before, unknowns = unknowns, _steps(fit.decays.problem, unknowns, measured, weight, prior)
            change = np.abs(np.asarray(unknowns.shared - before.shared)) / scale
            if (change < MAX_LAST_STEP).all() or not np.isfinite(change).any():
                break
        coordinates.append(np.asarray(unknowns.shared)[:count])
        unsettled += int((~np.asarray((change < MAX_LAST_STEP).all(axis=1))[:count]).sum())
        if progress is not None:
            progress(begin + count, draws)
    coordinate = np.concatenate(coordinates)
    coordinate = coordinate[np.isfinite(coordinate).all(axis=1)]  # a motion that ran away
    forward = [jax.vmap(p.transform.forward) for p in fit.decays.problem.space.free]
    value = np.stack([np.asarray(f(jnp.asarray(x))) for f, x in zip(forward, coordinate.T, strict=True)], axis=1)
    estimate = likelihood.estimate[: len(scale)]
    return Bootstrap(method, likelihood.labels, coordinate, value, estimate, groups, unsettled, seed, likelihood)
