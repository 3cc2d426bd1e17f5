"""Calibration in measured waves: free parameters fitted to the motions of tests in irregular and regular waves."""

import math
import time as clock
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Literal

import jax.numpy as jnp
import numpy as np

from calibration.campaign import Campaign
from calibration.conclusion import estimates, remarks
from calibration.descent import descend
from calibration.directions import Identifiability, family, stated
from calibration.fit import Interrupted, Progress, labels_of, space_of
from calibration.identifiability import Spread, memory
from calibration.residuals import condensed_groups
from calibration.result import BandError, Calibration, TestFit
from calibration.runs import KINDS
from calibration.sea_residuals import Objective, SeaProblem, look, pose_in_waves
from calibration.seas import Options, Seas, SeaTest, compare, moving_channels, sea_step, seas_of, with_diffraction
from calibration.seas_results import in_bands
from calibration.stretches import sea_state
from jaxhydro.environment import DOFS
from jaxhydro.loads.sea_state_law import exponent_label, is_exponent, with_exponents
from jaxhydro.loads.sea_state_law import reference_of as law_reference
from jaxhydro.model import Model
from jaxhydro.platform import build
from jaxhydro.problems import InputError, Problem
from jaxhydro.waves.sea_state import SeaState

Over = Literal["significant_height", "peak_period"]

ROUNDS = 4  # times that the model's error is estimated anew
SETTLED = 0.05  # relative change of that estimate that is none
TOLERANCE = 1e-3  # relative decrease of the sum of squares that ends a round
PLAIN = 1.0  # standard deviation of the prior of an exponent about 0
FIRST = 1.0  # trust in a descent's first step (`descend`): logarithms of energies are far from linear in those of coefficients


def _objective(x, args):
    """Residuals of the tests and of the prior, for optimistix."""
    problem, mean, ridge = args
    rows, products = condensed_groups(x, problem, jnp.ones(len(problem.in_bands)))
    return (rows, ridge * (x - mean)), products


class SeaFit:
    """One calibration in waves under way. The prior of every parameter weighs as one observation beside the tests' own, whose
    error is that of the model: it is estimated from what is left of them, and the fit made anew, until both agree."""

    def __init__(self, pose: Callable[[Model], SeaProblem], declared: Model, report: Callable[..., None]) -> None:
        self.pose, self.report = pose, report
        self.problem = problem = pose(declared)
        self.mean, self.width = problem.space.prior
        self.x, self.products = problem.space.start, np.zeros(0)
        self.iterations, self.converged = 0, False
        self.history: list[float] = []
        self.groups: list[np.ndarray] = []
        self.error, _ = self.left()

    def left(self) -> tuple[float, bool]:
        """Root mean square of what is left of an observation, and whether the sea reaches as far as the hull goes."""
        groups, inside = look(self.problem, self.x)
        self.groups = [np.asarray(group) for group in groups]
        return math.sqrt(sum(float(np.sum(group**2)) for group in self.groups) / self.problem.observations), bool(inside)

    def run(self) -> None:
        """All rounds."""
        for number in range(ROUNDS):
            ridge = jnp.asarray(max(self.error, 1e-6) / self.width)
            for i, now in enumerate(descend(_objective, self.x, (self.problem, self.mean, ridge), TOLERANCE, FIRST)):
                self.x, self.products, self.converged = now.unknowns, np.asarray(now.aux), now.settled
                self.iterations += 1
                self.history.append(math.sqrt(float(self.products[:, -1, -1].sum()) / self.problem.observations))
                share = (number + min(1.0, i / 10)) / ROUNDS
                self.report(f"round {number + 1} in waves", self.iterations, self.history[-1], share)
            before = self.error
            self.error, inside = self.left()
            if not inside:
                self.problem = self.pose(self.problem.space.model(self.problem.model, self.x))
                self.converged = False
                self.error, _ = self.left()
            if self.converged and abs(self.error / before - 1) < SETTLED:
                return

    def identifiability(self) -> tuple[Spread, Identifiability]:
        """Covariance of the coordinates, and what it says. A motion's residual counts as many times as it is independent; bands
        once each, with the variance that is left after what the parameters and their prior took."""
        groups, ridge = self.groups, self.error / self.width
        whole = self.products[:, :-1, :-1].sum(axis=0)
        used = float(np.trace(np.linalg.solve(whole + np.diag(ridge**2), whole)))
        total = sum(len(g) if bands else len(g) / memory(g) for g, bands in zip(groups, self.problem.in_bands))
        variance = np.array([float(np.mean(g**2)) for g in groups]) * total / max(total - used, 1.0)
        inflation = np.array([1.0 if bands else memory(g) for g, bands in zip(groups, self.problem.in_bands)])
        parts = (self.products[None], np.ones((1, len(groups))), variance[None], inflation[None])
        space, model = self.problem.space, self.problem.model
        return stated(space, model, np.asarray(self.x), parts, ridge, self.width, "the tests in waves")


def calibrate_in_waves(
    campaign: Campaign,
    *,
    free: Sequence[str] | None = None,
    progress: Callable[[Progress], None] | None = None,
    start: dict[str, float] | None = None,
    objective: Objective = "bands",
    options: Options | None = None,
    over: Sequence[Over] = (),
    made: Seas | None = None,
) -> Calibration:
    """Fit the declared model's coefficients to the tests in waves marked `fit`, all together, in their measured waves.

    `objective` "bands": the logarithms of simulated over measured energy in the low and the wave-frequency band of every motion
    that matters, which a sensor's clock and the phase of slow drift do not touch; "spectrum": the same in narrow cells of these
    bands, up to eight of each, so that where a motion resonates and how sharply counts; "motion": simulated less measured,
    sample by sample, over the measured standard deviation; "both", bands and motion. Of regular waves always the motion. Every
    free parameter has a prior, a factor of 4.5 about where it starts unless the manifest says otherwise, weighed against the
    model's own error, which is estimated from the residuals: energies in a few bands do not determine many coefficients, and
    say so by their deviations.

    `free` are labels or patterns (the manifest's by default), `start` values to begin from in place of the platform's.
    `over`: free drag and damping coefficients become powers of significant height, peak period or both (`SeaStateLaw`), of
    exponents with a prior of 0 +- 1; every test is then simulated with the coefficients of its own measured sea state. `made`
    are the campaign's runs and seas (`seas_of`), where they are at hand.
    Raises InputError where there is nothing to fit, Interrupted with what was reached.
    """
    begun = clock.monotonic()
    source = str(campaign.folder / "campaign.yaml")
    options = Options() if options is None else options
    records = [record for record in campaign.used("fit") if record.kind in KINDS]
    if not records:
        found = ", ".join(sorted({f"{r.kind} marked {r.use}" for r in campaign.records})) or "no tests"
        raise InputError(source, [Problem("tests", "at least one test in waves marked `use: fit`", found)])
    declared = with_diffraction(build(campaign.platform), options)
    made = seas_of(campaign, declared.environment, options) if made is None else made
    moved = sorted({dof for r in records for dof in moving_channels({k: r.values[k] for k in DOFS if k in r.values})})
    labels = list(labels_of(campaign, declared, moved, free))
    if over:
        drag = [label for label in labels if family(label) == "damping"]
        declared = with_laws(declared, drag, over, law_reference(declared.loads) or reference_of(made, options))
    exponents = [label for label in declared.values if is_exponent(label) and label not in labels]
    # exponents of a law that is not asked for are left out
    begin = {label: value for label, value in (start or {}).items() if label in declared.values or not is_exponent(label)}
    declared = declared.with_values(begin)
    space = space_of(campaign, [*labels, *exponents], declared, {label: (0.0, PLAIN) for label in exponents})

    def report(stage: str, iteration: int, value: float, fraction: float) -> None:
        if progress is not None:
            progress(Progress(stage, iteration, value, fraction, "error"))

    report("simulating the measured seas", 0, math.nan, 0.0)

    def pose(model: Model) -> SeaProblem:
        return pose_in_waves(
            model, made, space, options, from_rest=campaign.manifest.zero is not None, scale=campaign.manifest.scale,
            step=sea_step(declared, options), objective=objective,
        )  # fmt: skip

    fit = SeaFit(pose, declared, report)
    try:
        fit.run()
    except KeyboardInterrupt:
        fit.converged = False
        if not fit.iterations:
            raise Interrupted(None) from None
        raise Interrupted(_conclude(campaign, declared, fit, options, made, clock.monotonic() - begun)) from None
    return _conclude(campaign, declared, fit, options, made, clock.monotonic() - begun)


def reference_of(made: Seas, options: Options) -> SeaState:
    """The geometric mean of the sea states of the tests that are fitted, to two digits."""
    states = [sea_state(run, r, options.low, options.cutoff) for run, _ in made for r in run.records if r.use == "fit"]
    return SeaState(*(float(f"{math.exp(value):.2g}") for value in np.log(states).mean(axis=0)))


def with_laws(model: Model, labels: Sequence[str], over: Sequence[Over], reference: SeaState) -> Model:
    """The model with powers of the sea state, of exponent 0, for some of its coefficients, where it has none of its own."""
    exponents = {label: 0.0 for one in labels for kind in over if (label := exponent_label(one, kind)) not in model.values}
    return replace(model, loads=with_exponents(model.loads, exponents, reference))


def _conclude(
    campaign: Campaign, declared: Model, fit: SeaFit, options: Options, made: Seas, seconds: float
) -> Calibration:
    """Parameters with their deviations, and all tests in waves before and after."""
    problem = fit.problem
    model = problem.space.model(problem.model, fit.x)
    uncertainty, known = fit.identifiability()
    parameters = estimates(problem.space, problem.model, np.asarray(fit.x), uncertainty)
    tests, warnings = tests_in_waves(campaign, declared, model, options, made)
    notes = (*remarks(campaign, parameters, known, KINDS), *warnings)
    return Calibration(
        campaign.manifest.name, model, parameters, tests, fit.converged, fit.iterations, seconds, tuple(fit.history),
        notes, campaign.platform.name, known,
    )  # fmt: skip


def tests_in_waves(
    campaign: Campaign, declared: Model, model: Model, options: Options, made: Seas
) -> tuple[tuple[TestFit, ...], tuple[str, ...]]:
    """All tests in waves with a calibrated model, and with that declared; and words of warning."""
    after, before = (compare(campaign, one, options, made=made) for one in (model, declared))
    return tuple(_test(*pair) for pair in zip(after.tests, before.tests, strict=True)), after.notes


def _test(after: SeaTest, before: SeaTest) -> TestFit:
    """A test with both motions, the errors of its bands, and its motions that matter counting in J."""
    counts = moving_channels({s.channel: s.measured for s in after.fit.series})
    series = tuple(replace(s, scored=s.channel in counts) for s in after.fit.series)
    start = {s.channel: s.simulated for s in before.fit.series}
    bands = {}
    if after.fit.kind == "irregular":
        earlier = in_bands(before)
        bands = {
            name: {k: BandError(band.error, earlier[name][k].error, band.low, band.high) for k, band in row.items()}
            for name, row in in_bands(after).items() if name in counts
        }  # fmt: skip
    return replace(after.fit, series=series, start=start, bands=bands)
