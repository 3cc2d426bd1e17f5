"""State of a joint calibration: sources, errors, weights, uncertainty."""

import math
from collections.abc import Callable
from typing import Any, Literal, NamedTuple, get_args

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from calibration.fitting.decay_fit import DecayFit, record_weights
from calibration.fitting.fit_conclusion import series_of
from calibration.fitting.levenberg_marquardt import descend
from calibration.identifiability.directions import Identifiability, identifiability_at
from calibration.identifiability.information import MIN_VARIANCE
from calibration.identifiability.standard_deviations import Spread, correlated_samples
from calibration.parameters.space import ParameterSpace
from calibration.residuals.decays import DecayProblem, Unknowns, condensed_decays, condensed_groups
from calibration.residuals.seas import SeaProblem, residuals_and_reach
from calibration.residuals.static import OffsetProblem, PeriodProblem
from calibration.result import TestFit
from jaxhydro.environment import DOFS

Kind = Literal["decays", "waves", "offsets", "periods"]
Loss = Literal["squares", "cauchy"]
MAX_ROUNDS = 6  # times that the errors of the kinds of data are estimated anew
ERROR_TOLERANCE = 0.1  # relative change of these that is none
TOLERANCE = 1e-4
INITIAL_TRUST = 1.0
# standard deviations: Cauchy's loss is then 95 % efficient on normal errors (Holland and Welsch 1977, table 1)
CAUCHY_SCALE = 2.385
MIN_ERROR = {"waves": 0.02, "offsets": 1e-3}  # error of ln(energy), share of the held motion: below, a fit proves nothing


class Sources(NamedTuple):
    """Data that are fitted together; None where there is nothing of a kind."""

    decays: DecayProblem | None
    waves: SeaProblem | None
    offsets: OffsetProblem | None
    periods: PeriodProblem | None


class Weights(NamedTuple):
    """Factors of squared residuals: of decays by record and channel, else by group."""

    decays: Float[Array, "r c"]
    waves: Float[Array, " g"]
    offsets: Float[Array, "1"]
    periods: Float[Array, "1"]


def _objective(unknowns: Unknowns, args):
    """Residuals in units of their standard deviations, and of the prior, for optimistix."""
    sources, weight, until, (mean, width) = args
    rows, products = [], []
    if sources.decays is not None:
        row, product = condensed_decays(unknowns, sources.decays, weight.decays, until)
        rows.append(row)
        products.append(product)
    for source, mine in zip(sources[1:], weight[1:], strict=True):
        if source is not None:
            row, product = condensed_groups(unknowns.shared, source, mine)
            rows.append(row)
            products.append(product)
    return (tuple(rows), (unknowns.shared - mean) / width), tuple(products)


class ResidualStatistics(NamedTuple):
    """Variance of residuals and how many of them count as one: of decays by record and channel, else by group."""

    variance: np.ndarray
    inflation: np.ndarray


class JointFit:
    """One calibration under way.

    The log-likelihood is the sum over records, motions and the bands taken together of -n/2 ln(mean square), n their
    independent observations: every kind's error is that of the model, estimated from what is left. Weights 1 / (variance times
    correlated samples) are renewed until both agree (iterated feasible least squares: Seber and Wild 1989, Nonlinear
    Regression, section 2.8.8). Stated periods have the standard deviation that is stated.
    """

    def __init__(
        self,
        sources: Sources,
        decays: DecayFit | None,
        space: ParameterSpace,
        x,
        report: Callable,
        loss: Loss,
        set_up: Callable[[Any], SeaProblem],
    ) -> None:
        self.set_up = set_up
        self.sources, self.decays, self.space, self.report, self.loss = sources, decays, space, report, loss
        self.mean, self.width = space.prior
        own = jnp.zeros((0, 0)) if decays is None else decays.unknowns.own
        self.unknowns = Unknowns(x, own)
        self.history: list[float] = []
        self.iterations, self.converged = 0, False
        self.products: dict[str, np.ndarray] = {}
        self.inside: Any = True  # whether the seas reach as far as the hull goes
        self.tests: list[TestFit] = []
        self.errors = self.estimate()
        self.weights = self.weigh()

    def estimate(self) -> dict[str, ResidualStatistics]:
        """Errors of every kind where the fit is."""
        found = {}
        x, sources = self.unknowns.shared, self.sources
        if sources.decays is not None:
            assert self.decays is not None
            found["decays"] = self.of_decays(sources.decays, self.decays)
        p = len(self.space.free)
        if sources.waves is not None:
            there, self.inside = residuals_and_reach(sources.waves, x)
            groups = [np.asarray(group) for group in there]
            self.lengths = np.array([float(len(group)) for group in groups])
            bands = sources.waves.in_bands
            independent = [len(g) if b else len(g) / correlated_samples(g) for g, b in zip(groups, bands)]
            spare = sum(independent) / max(sum(independent) - p, 0.5 * sum(independent))
            least = np.where(bands, MIN_ERROR["waves"] ** 2, MIN_VARIANCE)
            variance = np.maximum(spare * np.array([_mean_square(g, self.loss) for g in groups]), least)
            found["waves"] = ResidualStatistics(
                variance, np.array([1.0 if b else correlated_samples(g) for g, b in zip(groups, bands)])
            )
        if sources.offsets is not None:
            r = np.asarray(_offsets(sources.offsets, x))
            least_offset = max(2.0 * _mean_square(r, self.loss), MIN_ERROR["offsets"] ** 2)
            found["offsets"] = ResidualStatistics(np.array([least_offset]), np.ones(1))
        if sources.periods is not None:
            found["periods"] = ResidualStatistics(np.ones(1), np.ones(1))
        return found

    def of_decays(self, problem: DecayProblem, fit: DecayFit) -> ResidualStatistics:
        """Errors of every record's channels, not below their noise."""
        self.tests = series_of(problem, fit.records, self.unknowns)
        shape = fit.scored.shape
        variance, inflation = np.full(shape, MIN_VARIANCE), np.ones(shape)
        for i, (test, record) in enumerate(zip(self.tests, fit.records, strict=True)):
            for series in test.series:
                j = problem.data.dofs.index(DOFS.index(series.channel))
                r = series.simulated - series.measured
                n = len(r)
                variance[i, j] = max(_mean_square(r, self.loss) * n / max(n - 3, 1), record.noise[series.channel] ** 2)
                inflation[i, j] = correlated_samples(r)
        return ResidualStatistics(variance, inflation)

    def weigh(self) -> Weights:
        """Weights of all kinds by their errors."""
        none = jnp.ones(1)
        found = {kind: jnp.asarray(1 / (e.variance * e.inflation)) for kind, e in self.errors.items() if kind != "decays"}
        of_decays = jnp.ones((0, 0))
        if self.decays is not None and "decays" in self.errors:
            fit, (variance, inflation) = self.decays, self.errors["decays"]
            counts, spread = fit.scored, fit.spread
            samples = np.asarray(fit.problem.data.present).sum(axis=-1)
            stated = np.array([record.test.weight for record in fit.records])
            known = np.where(counts, samples * spread**2 / (variance * inflation), 0.0).sum(axis=1)
            of_decays = jnp.asarray(record_weights(fit.records, fit.problem.data, counts, spread, stated * known))
        return Weights(of_decays, *(found.get(kind, none) for kind in ("waves", "offsets", "periods")))

    def run(self) -> None:
        """Run all rounds of descent and error estimate."""
        for number in range(MAX_ROUNDS):
            sources = self.sources
            if self.loss == "cauchy":
                sources = _with_tails(sources, self.errors)
            until = jnp.zeros(0) if self.decays is None else self.decays.ends
            args = (sources, self.weights, until, (self.mean, jnp.asarray(self.width)))
            for i, now in enumerate(descend(_objective, self.unknowns, args, TOLERANCE, INITIAL_TRUST)):
                self.unknowns, self.converged = now.unknowns, now.settled
                there = [kind for kind, source in zip(get_args(Kind), sources, strict=True) if source is not None]
                self.products = {kind: np.asarray(one) for kind, one in zip(there, now.aux, strict=True)}
                self.iterations += 1
                self.history.append(self.level())
                self.report(f"round {number + 1}", self.iterations, self.history[-1], (number + min(1.0, i / 10)) / MAX_ROUNDS)
            before, self.errors = self.errors, self.estimate()
            if not bool(self.inside):
                assert self.sources.waves is not None
                model = self.space.model(self.sources.waves.model, self.unknowns.shared)
                self.sources, self.converged = self.sources._replace(waves=self.set_up(model)), False
                self.errors = self.estimate()
            self.weights = self.weigh()
            changes = [np.abs(np.log(self.errors[kind].variance / before[kind].variance)).max() for kind in self.errors]
            if self.converged and max(changes) < ERROR_TOLERANCE:
                return

    def level(self) -> float:
        """Geometric mean of what is left, over all groups, by their independent observations."""
        total, logs = 0.0, 0.0
        for kind, products in self.products.items():
            if kind == "periods":
                continue
            squares, inflation = products[..., -1, -1], self.errors[kind].inflation
            if kind == "decays":
                assert self.decays is not None
                samples = np.asarray(self.decays.problem.data.present).sum(axis=-1)
                mask = self.decays.scored
                mean, n = (squares / np.maximum(samples, 1) / self.decays.spread**2)[mask], (samples / inflation)[mask]
            elif kind == "offsets":
                assert self.sources.offsets is not None
                n = np.array([float(len(self.sources.offsets.compared))])
                mean = squares / n
            else:
                assert self.sources.waves is not None
                n = self.lengths / inflation
                # motions are scaled to the root of their number of samples
                mean = squares / np.where(self.sources.waves.in_bands, self.lengths, 1.0)
            logs += float(np.sum(n * np.log(np.maximum(mean, 1e-300))))
            total += float(np.sum(n))
        return math.exp(0.5 * logs / total) if total else math.nan

    def uncertainty(self, source: str) -> tuple[Spread, Identifiability]:
        """Covariance of the coordinates, and what it says."""
        p = len(self.space.free)
        own = self.unknowns.own.shape[1] if self.unknowns.own.size else 0
        blocks, rows = [], []
        for kind, products in self.products.items():
            weight = np.asarray(getattr(self.weights, kind))
            error = self.errors[kind]
            if kind == "decays":
                blocks += list(products)
                rows += list(zip(weight, error.variance, error.inflation))
            else:
                wide = np.zeros((len(products), p + own + 1, p + own + 1))
                keep = np.r_[0:p, p + own]
                wide[np.ix_(range(len(products)), keep, keep)] = products
                blocks.append(wide)
                rows.append((weight, error.variance, error.inflation))
        size = max(len(block) for block in blocks)

        def padded(values: np.ndarray, fill: float) -> np.ndarray:
            rest = [(0, size - len(values))] + [(0, 0)] * (np.ndim(values) - 1)
            return np.pad(values, rest, constant_values=fill)

        products = np.stack([padded(block, 0.0) for block in blocks])
        parts = [np.stack([padded(np.asarray(row[i]), 1.0 if i else 0.0) for row in rows]) for i in range(3)]
        ridge = 1 / self.width
        model = next(one for one in self.sources if one is not None).model
        x = np.asarray(self.unknowns.shared)
        return identifiability_at(self.space, model, x, (products, parts[0], parts[1], parts[2]), ridge, self.width, source)


@eqx.filter_jit
def _offsets(source: OffsetProblem, x: Float[Array, " p"]) -> Float[Array, " n"]:
    return source.residuals(x)


def _mean_square(residual: np.ndarray, loss: Loss) -> float:
    """Mean square about zero; with Cauchy's loss that of a normal distribution of the same median magnitude."""
    return float((1.4826 * np.median(np.abs(residual))) ** 2 if loss == "cauchy" else np.mean(residual**2))


def _with_tails(sources: Sources, errors: dict[str, ResidualStatistics]) -> Sources:
    """The sources with residuals that count by Cauchy's loss beyond `CAUCHY_SCALE` standard deviations."""

    def tailed(kind: str, source):
        if source is None or kind == "periods":
            return source
        tail = jnp.asarray(CAUCHY_SCALE * np.sqrt(errors[kind].variance))
        return eqx.tree_at(lambda s: s.tail, source, tail, is_leaf=lambda leaf: leaf is None)

    return Sources(*(tailed(kind, source) for kind, source in zip(get_args(Kind), sources, strict=True)))
