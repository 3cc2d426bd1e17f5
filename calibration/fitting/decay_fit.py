"""Calibration to decays: least squares on all decay records together."""

import time as clock
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import jax.numpy as jnp
import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest import IN_WAVES
from calibration.campaign.records import Record
from calibration.fitting.fit_conclusion import estimates, records_not_followed, remarks, series_of
from calibration.fitting.fit_uncertainty import uncertainty_of
from calibration.fitting.levenberg_marquardt import descend
from calibration.parameters.space import ParameterSpace, match_free_labels, parameter_space
from calibration.residuals.decays import (
    DecayData,
    DecayProblem,
    Unknowns,
    condensed_decays,
    dominant_period,
    first_guess,
    gather_decays,
)
from calibration.result import Calibration, TestFit
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.simulate import memory_step
from jaxhydro.dynamics.statics import equilibrium, natural_modes
from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError
from jaxhydro.errors import Problem as Wrong
from jaxhydro.interrupts import stopping

# weight of a record's other channels against the released one, both in metres of the hull
SIDE_CHANNEL_WEIGHT = 0.1
WINDOW_GROWTH = 2.5  # the window grows by this factor, from FIRST_WINDOW_CYCLES cycles to the whole record
FIRST_WINDOW_CYCLES = 1.25
STEPS_PER_PERIOD = 16  # of the shortest natural period: an error of some 1e-7 in the period


@dataclass(frozen=True)
class Progress:
    """Progress of a calibration.

    Attributes:
        stage: Name of the current stage.
        iteration: Number of iterations so far.
        objective: Value of the objective.
        fraction: Estimated fraction done, 0 to 1.
        name: Name of the objective.
    """

    stage: str
    iteration: int
    objective: float
    fraction: float
    name: str = "J"


class Interrupted(KeyboardInterrupt):
    """Interruption of a calibration by the user (Ctrl-C).

    Attributes:
        partial: Result that was reached; None if there is none.
    """

    def __init__(self, partial: Calibration | None):
        super().__init__("stopped; nothing was written")
        self.partial = partial


def _objective(unknowns: Unknowns, args):
    """Residuals of the records and of the prior, for optimistix."""
    problem, weight, until, prior = args
    mean, precision = prior
    rows, products = condensed_decays(unknowns, problem, weight, until)
    return (rows, precision * (unknowns.shared - mean)), products


class DecayFit:
    """One calibration under way: the problem, the unknowns reached so far, and how it reports."""

    def __init__(self, problem: DecayProblem, records: Sequence[Record], unknowns: Unknowns, report) -> None:
        self.problem, self.records, self.unknowns, self.report = problem, records, unknowns, report
        space = problem.space
        mean, width = space.prior
        self.prior = (mean, 1 / jnp.asarray(width))
        self.iterations, self.converged = 0, True
        self.history: list[float] = []
        self.ridge: np.ndarray = np.zeros(len(space.free))
        self.ends = jnp.array([record.time[-1] for record in records])
        self.scored, self.spread = scored_channels(records, problem.data)
        self.weight, self.samples = np.ones(self.scored.shape), np.ones(self.scored.shape)
        self.products: np.ndarray | None = None

    def minimise(
        self,
        stage: str,
        weight,
        until,
        tolerance: float,
        fraction: tuple[float, float],
        samples: float | None = None,
    ) -> bool:
        """Levenberg-Marquardt from where the fit is, to a relative decrease below `tolerance`.

        Every free parameter has a prior about where it started, of VAGUE_DEVIATION unless the manifest says otherwise. It
        weighs as one observation among `samples` independent ones: what the records do not determine stays where it was.
        """
        # in units of the cost so far, so that damping and ridge mean the same in every stage
        weight = np.asarray(weight) / self.cost(weight)
        self.weight = weight
        mean, precision = self.prior
        self.ridge = precision / np.sqrt(self.information(until) if samples is None else samples)
        prior = (mean, self.ridge)
        self.samples = samples_until(self.problem.data, until)
        weight, until = jnp.asarray(weight), jnp.asarray(until)
        args = (self.problem, weight, until, prior)
        settled = False
        for i, now in enumerate(descend(_objective, self.unknowns, args, tolerance)):
            self.unknowns, self.products, settled = now.unknowns, np.asarray(now.aux), now.settled
            self.iterations += 1
            objective = self.objective()
            self.history.append(objective)
            self.report(stage, self.iterations, objective, fraction[0] + (fraction[1] - fraction[0]) * min(1.0, i / 15))
        return settled

    def window(self, cycles: float) -> np.ndarray:
        """The end (s) of the first so many cycles of the released motion, by record."""
        data = self.problem.data
        return np.minimum(np.asarray(data.time[:, 0]) + cycles * 2 * np.pi / np.asarray(data.pace), np.asarray(self.ends))

    def information(self, until) -> float:
        """Number of `independent_observations` in all records."""
        return float(np.sum(independent_observations(self.problem.data, until)))

    def cost(self, weight: np.ndarray) -> float:
        """Weighted sum of squares where the fit is; 1 before it has begun."""
        if self.products is None:
            return 1.0
        return float(np.sum(self.products[..., -1, -1] * weight))

    def mean_squares(self) -> np.ndarray:
        """Mean square residual by record and channel over the window of the last stage (m2, rad2)."""
        assert self.products is not None, "nothing has been minimised yet"
        return self.products[..., -1, -1] / np.maximum(self.samples, 1)

    def objective(self) -> float:
        """J = sum of RMSE / standard deviation over the scored series."""
        return float(np.sum(np.where(self.scored, np.sqrt(self.mean_squares()) / self.spread, 0.0)))


def independent_observations(data: DecayData, until) -> np.ndarray:
    """How many independent observations each record stands for when the model's error, not noise, is what is left: four for
    every cycle of the released motion."""
    return 4 * (np.asarray(until) - np.asarray(data.time[:, 0])) / (2 * np.pi / np.asarray(data.pace))


def scored_channels(records: Sequence[Record], data: DecayData) -> tuple[np.ndarray, np.ndarray]:
    """Which record's which channel counts in J, and the standard deviation of every measured series (record, channel)."""
    counts = np.zeros((len(records), len(data.dofs)), dtype=bool)
    spread = np.ones((len(records), len(data.dofs)))
    for i, record in enumerate(records):
        for j, dof in enumerate(data.dofs):
            if DOFS[dof] in record.values:
                spread[i, j] = max(float(np.std(record.values[DOFS[dof]])), 1e-300)
                counts[i, j] = DOFS[dof] == record.degree_of_freedom
    return counts, spread


def samples_until(data: DecayData, until) -> np.ndarray:
    """How many samples every record and channel has up to `until` (s, by record)."""
    return (np.asarray(data.present) * (np.asarray(data.time) <= np.asarray(until)[:, None])[:, None]).sum(axis=-1)


def record_weights(
    records: Sequence[Record], data: DecayData, counts: np.ndarray, spreads: np.ndarray, factor: np.ndarray, until=None
) -> np.ndarray:
    """What multiplies the squares, by record and channel: with `factor` 1 the sum over records of (RMSE / spread)^2.

    The other channels of a record count on the same footing as its scored one, in metres of the hull (an angle times the
    radius of gyration): they say how it was released, and are not judged by their own small spread.
    """
    samples = samples_until(data, data.time[:, -1] if until is None else until)
    scale = np.where(counts, spreads, np.asarray(data.unit))
    return np.where(counts, 1.0, SIDE_CHANNEL_WEIGHT) * factor[:, None] / (np.maximum(samples, 1) * scale**2)


def calibrate(
    campaign: Campaign,
    *,
    free: Sequence[str] | None = None,
    progress: Callable[[Progress], None] | None = None,
    start: dict[str, float] | None = None,
    begin: dict[str, float] | None = None,
) -> Calibration:
    """Fit the baseline model's coefficients to all decay records marked `fit`.

    The objective is J, the sum of RMSE / standard deviation over the records' released degrees of freedom. It is minimised
    by least squares, with weights renewed from the errors reached, so that the sum of RMSE is stationary. The fitted window
    grows from a little over one cycle to the whole record: natural periods are found before the phase of late cycles
    matters. Where the error comes down to the noise everywhere, a last pass weighs every sample by its noise (maximum
    likelihood). Initial position, initial rate and sensor offset of every record and channel are free.

    Args:
        campaign: The campaign.
        free: Labels or patterns of the free parameters; None for those of the manifest.
        progress: Function that is called with the progress after every iteration.
        start: Values in place of the platform's, by label. The fit begins there, and vague priors are centred there.
        begin: Values where the fit begins, by label, without effect on priors. Those of a search, for example.

    Returns:
        The calibrated model, its parameters with their uncertainty, and all decay tests.

    Raises:
        InputError: If there is nothing to fit.
        Interrupted: If the user stops the fit (a KeyboardInterrupt); it holds what was reached.
    """
    begun = clock.monotonic()

    def report(stage: str, iteration: int, objective: float, fraction: float) -> None:
        if progress is not None:
            progress(Progress(stage, iteration, objective, fraction))

    fit = prepare_fit(campaign, free=free, start=start, begin=begin, report=report)

    def finish() -> Calibration:
        return conclude(campaign, fit.problem.model, fit, clock.monotonic() - begun)

    try:
        run_fit(fit)
    except KeyboardInterrupt:
        stopping()
        fit.converged = False
        raise Interrupted(finish() if fit.iterations else None) from None
    return finish()


def prepare_fit(
    campaign: Campaign,
    *,
    free: Sequence[str] | None = None,
    start: dict[str, float] | None = None,
    begin: dict[str, float] | None = None,
    report: Callable[[str, int, float, float], None] = lambda *_: None,
) -> DecayFit:
    """A calibration to the decays before its first step. Arguments and InputError are those of `calibrate`."""
    source = str(campaign.folder / "campaign.yaml")
    records = [record for record in campaign.used("fit") if record.kind == "decay"]
    if not records:
        found = ", ".join(sorted({f"{r.kind} marked {r.use}" for r in campaign.records})) or "no tests"
        waves = any(r.kind in IN_WAVES and r.use == "fit" for r in campaign.records)
        hint = "Tests in waves are fitted by `jaxhydro calibrate --tests waves`, `calibrate_in_waves`." if waves else ""
        raise InputError(source, [Wrong("tests", "at least one decay test marked `use: fit`", found, hint)])
    for record in records:
        for channel in set(record.values) & set(DOFS[3:]):
            if (largest := float(np.abs(record.values[channel]).max())) > np.pi / 2:
                where, found = f"tests, {record.id}, channel {channel}", f"{np.degrees(largest):.3g} deg"
                raise InputError(source, [Wrong(where, "angles below 90 deg", found, "Is the unit right?")])
    declared = campaign.model
    labels = labels_of(campaign, declared, [str(record.degree_of_freedom) for record in records], free)
    first = declared.with_values(start or {})
    problem = set_up_decays(first, campaign, records, space_of(campaign, labels, first))
    x = jnp.array([p.transform.inverse((begin or {}).get(p.label, p.start)) for p in problem.space.free])
    return DecayFit(problem, records, Unknowns(x, first_guess(records, problem.data)), report)


def labels_of(campaign: Campaign, declared: Model, moved: Sequence[str], free: Sequence[str] | None) -> tuple[str, ...]:
    """The free parameters: those that `moved` motions are about, or the labels and patterns asked for. Raises InputError where
    there are none."""
    source, wish = str(campaign.folder / "campaign.yaml"), campaign.manifest.calibrate
    labels = match_free_labels(declared, moved, wish.free if free is None else free, wish.fixed, source)
    if not labels:
        none = f"none: the platform declares nothing that acts on {', '.join(sorted(set(moved)))}"
        raise InputError(source, [Wrong("calibrate.free", "at least one free parameter", none)])
    return labels


def space_of(
    campaign: Campaign, labels: Sequence[str], begin: Model, priors: Mapping[str, tuple[float, float]] | None = None
) -> ParameterSpace:
    """Free parameters begun from a model's values, with the manifest's bounds and priors, and `priors` for others. Raises
    InputError for what makes no sense."""
    wish = campaign.manifest.calibrate
    stated = {label: (prior.value, prior.standard_deviation) for label, prior in wish.priors.items()}
    source = str(campaign.folder / "campaign.yaml")
    return parameter_space(begin, labels, dict(wish.bounds), {**(priors or {}), **stated}, source)


def conclude(campaign: Campaign, declared: Model, fit: "DecayFit", seconds: float) -> Calibration:
    """The result of a fit: parameters with their standard deviations, and all decay tests with the fitted model."""
    space, x = fit.problem.space, fit.unknowns.shared
    model = space.model(fit.problem.model, x)
    tests = series_of(fit.problem, fit.records, fit.unknowns)
    uncertainty, found = uncertainty_of(fit, tests)
    parameters = estimates(space, fit.problem.model, np.asarray(x), uncertainty)
    lost = records_not_followed(tests, declared)
    tests += held_out(campaign, declared, model)
    return Calibration(
        campaign.manifest.name,
        model,
        parameters,
        tuple(tests),
        fit.converged and not lost,
        fit.iterations,
        seconds,
        tuple(fit.history),
        (*lost, *remarks(campaign, parameters, found)),
        campaign.platform.name,
        found,
    )


def held_out(campaign: Campaign, declared: Model, model: Model) -> list[TestFit]:
    """The decays marked `holdout` with a calibrated model, and with that declared. The coefficients stay; releases and sensors'
    offsets are each record's own."""
    held = [record for record in campaign.used("holdout") if record.kind == "decay"]
    if not held:
        return []
    empty = ParameterSpace(())
    other = set_up_decays(model, campaign, held, empty)
    judge = DecayFit(other, held, Unknowns(jnp.zeros(0), first_guess(held, other.data)), lambda *_: None)
    weight = record_weights(held, other.data, judge.scored, judge.spread, np.ones(len(held)))
    judge.minimise("held-out records", weight, judge.ends, 1e-4, (1.0, 1.0))
    return series_of(other, held, judge.unknowns, set_up_decays(declared, campaign, held, empty))


def set_up_decays(model: Model, campaign: Campaign, records: Sequence[Record], space: ParameterSpace) -> DecayProblem:
    """The fixed part of a calibration of `model` to decay records."""
    periods = natural_modes(model).period
    step = float(periods.min()) / STEPS_PER_PERIOD
    # a model that starts with periods far too long would step too far for the true ones
    step = min([step, memory_step(model), *(dominant_period(record) / STEPS_PER_PERIOD for record in records)])
    data = gather_decays(records, model, step)
    rest = None if space.moves_equilibrium else equilibrium(model)
    return DecayProblem(model, data, space, campaign.manifest.zero is not None, rest)


def run_fit(fit: DecayFit, near: bool = False) -> None:
    """The stages of a fit; where `near`, no more than brings it near."""
    data, records = fit.problem.data, fit.records
    period, start = 2 * np.pi / np.asarray(data.pace), np.asarray(data.time[:, 0])
    length = (np.asarray(fit.ends) - start) / period
    even, cycles = np.array([record.test.weight for record in records]), FIRST_WINDOW_CYCLES
    windows = max(1, int(np.ceil(np.log(length.max() / FIRST_WINDOW_CYCLES) / np.log(WINDOW_GROWTH))))
    done = 0
    while cycles < length.max():
        until = fit.window(cycles)
        weight = record_weights(records, data, fit.scored, fit.spread, even, until)
        fit.minimise(f"first {cycles:.3g} cycles", weight, until, 1e-2, (0.4 * done / windows, 0.4 * (done + 1) / windows))
        cycles, done = cycles * WINDOW_GROWTH, done + 1
    weight = record_weights(records, data, fit.scored, fit.spread, even)
    fit.minimise("whole records", weight, fit.ends, 1e-3, (0.4, 0.6))
    if near:
        return
    noise = np.array([[r.noise.get(DOFS[dof], np.inf) for dof in data.dofs] for r in records])
    measured = np.isfinite(noise) & (np.asarray(data.present).sum(axis=-1) > 0)
    for _ in range(3):
        error = np.sqrt(fit.mean_squares())
        if (error[measured] < 1.2 * noise[measured]).all():
            weight = np.where(measured, 1 / noise**2, 0.0)
            fit.converged = fit.minimise("noise level", weight, fit.ends, 2e-6, (0.8, 1.0), fit.samples.sum())
            return
        main = np.where(fit.scored, np.maximum(error, noise) / fit.spread, 0).sum(axis=1)
        renewed = record_weights(records, data, fit.scored, fit.spread, even / main)
        settled = np.allclose(renewed / renewed.max(), weight / weight.max(), rtol=0.02)
        weight = renewed
        fit.converged = fit.minimise("sum of RMSE", weight, fit.ends, 1e-5, (0.6, 0.9))
        if settled:
            break
