"""Fits of a campaign's study with a given set of effects."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Protocol

import numpy as np

from calibration.campaign.load_campaign import Campaign
from calibration.discovery.acceptance import HeldOutComparison, Verdict, assess_effect
from calibration.discovery.broyden_fit import MIN_RELATIVE_GAIN, FitOutcome, fit
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.eliminated_least_squares import minus_two_log_likelihood
from calibration.discovery.expected_residuals import expected_rows
from calibration.discovery.fit_state import FitState, ResidualSummary
from calibration.discovery.held_out_blocks import HeldOutBlocks
from calibration.discovery.linearisations import Linearisation, Point, Prior
from calibration.discovery.study_set_up import StudySetup
from calibration.fitting.decay_fit import prepare_fit, run_fit
from calibration.residuals.decays import first_guess

MAX_ITERATIONS = 50  # iterations of a full refit
MAX_RELINEARISATIONS = 8  # new slopes in a full refit
REFIT_TOLERANCE = 3e-4  # of the cost: a step of a full refit that gains less ends it


class ReportStage(Protocol):
    """Report of the present stage of a diagnosis."""

    def __call__(self, stage: str, fraction: float, iteration: int = 0, cost: float = math.nan) -> None:
        """Report a stage.

        Args:
            stage: What is done.
            fraction: Estimated fraction of the diagnosis that is done (0 to 1).
            iteration: Iteration of a fit.
            cost: -2 ln L that the fit has reached.
        """


class EffectFits:
    """Fits of a campaign with some effects in the model, and their assessment.

    Attributes:
        campaign: The campaign.
        setup: Study, candidates, priors.
        study: The study, with the current weights.
        say: Called with every stage.
        begun: Parameter coordinates where the search began (p,).
        base: Directions that are free without any effect.
        count: Number of independent observations, for BIC.
    """

    def __init__(self, campaign: Campaign, setup: StudySetup, say: ReportStage) -> None:
        self.campaign, self.setup, self.study, self.say = campaign, setup, setup.study, say
        self.begun = np.asarray(self.study.space.start)  # coordinates where the search begins: of a calibration to the decays
        self.base = self.study.index([*setup.base, *setup.nuisances])
        # independent observations, for BIC: a quarter of the degrees of freedom, as most bands hold noise only
        self.count = max(2.0, float(self.study.dof[self.study.used].sum()) / 4)

    def active(self, chosen: Sequence[Candidate]) -> list[int]:
        """Directions that are free with some effects in the model."""
        return list(
            dict.fromkeys([*self.base, *self.study.index([label for candidate in chosen for label in candidate.labels])])
        )

    def prior(self, chosen: Sequence[Candidate]) -> Prior:
        """Priors with some effects in the model; their amplitudes have the priors of plausible sizes."""
        mean, width = self.setup.prior.mean.copy(), self.setup.prior.width.copy()
        for candidate in chosen:
            for label, i in zip(candidate.amplitudes, self.study.index(candidate.amplitudes), strict=True):
                mean[i], width[i] = self.setup.size_priors[label]
        return Prior(mean, width)

    @cached_property
    def start(self) -> Point:
        """Starting point: coefficients and releases of an ordinary calibration to the decays."""
        study = self.study
        x = np.asarray(study.space.start).copy()
        if study.decays is None:
            return Point(x, np.zeros((0, 0)))
        releases = np.asarray(first_guess(study.decay_records, study.decays.data)).copy()
        if study.fitted_decays.any():
            run_fit(plain := prepare_fit(self.campaign), near=True)
            for label, value in zip(plain.decays.problem.space.labels, np.asarray(plain.unknowns.shared)):
                x[study.labels.index(label)] = value
            rows = [r.id for r in study.decay_records]
            mine, theirs = np.asarray(study.decays.data.unit), np.asarray(plain.decays.problem.data.unit)
            for k, (record, values) in enumerate(zip(plain.decays.records, np.asarray(plain.unknowns.own))):
                i = rows.index(record.id)
                releases[i] = (values.reshape(3, -1) * theirs[k] / mine[i]).ravel()
        return Point(x, releases)

    def anchor(self, x: np.ndarray) -> None:
        """Set where the search begins, and in waves centre the coefficients' priors there.

        Otherwise coefficients would compensate for what the model lacks: linear damping for radiation, for instance.
        """
        self.begun = x
        if not self.study.seas:
            return
        stated = {parameter.label for parameter in self.study.space.free if math.isfinite(parameter.prior_deviation)}
        mine = self.study.index([name for name in self.setup.base if name not in stated])
        mean = self.setup.prior.mean.copy()
        mean[mine] = self.study.steps(x)[mine]
        self.setup = self.setup._replace(prior=Prior(mean, self.setup.prior.width))

    def weigh_by_expected(self, point: Point) -> None:
        """Weigh tests in waves by the residuals that unknown forces would leave, estimated at a point."""
        self.study = replace(self.study, expected=expected_rows(self.study, point))

    def refit(self, linearisation: Linearisation, chosen: Sequence[Candidate], name: str, fraction: float) -> FitState:
        """Fit all directions of a linearisation until nothing is gained."""
        reached = self.fit(linearisation, chosen, MAX_ITERATIONS, MAX_RELINEARISATIONS, name, fraction, REFIT_TOLERANCE)
        return self.state(chosen, reached)

    def refit_from(self, state: FitState, chosen: Sequence[Candidate], name: str, fraction: float) -> FitState:
        """Fit to convergence from a state on, with slopes of its own and the shapes of the effects free."""
        return self.refit(self.study.linearise(state.linearisation.point, self.active(chosen)), chosen, name, fraction)

    def fit(
        self,
        linearisation: Linearisation,
        chosen: Sequence[Candidate],
        iterations: int,
        relinearisations: int,
        name: str,
        fraction: float,
        relative_tolerance: float = MIN_RELATIVE_GAIN,
    ) -> FitOutcome:
        """Fit all directions of a linearisation for some iterations, reporting progress."""

        def report(i: int, cost: float) -> None:
            self.say(name, fraction, i, cost)

        prior = self.prior(chosen)
        return fit(
            self.study,
            linearisation,
            self.study.used,
            prior,
            iterations=iterations,
            relinearisations=relinearisations,
            tolerance=1.0,
            relative_tolerance=relative_tolerance,
            report=report,
        )

    def state(self, chosen: Sequence[Candidate], reached: FitOutcome) -> FitState:
        """The state that a fit reached; held-out decays' own unknowns are fitted with the parameters fixed."""
        study, linearisation = self.study, reached.linearisation
        if study.decays is not None and not study.fitted_decays.all():
            alone = fit(
                study, linearisation.restricted_to(()), ~study.used, self.prior(chosen), iterations=4, tolerance=0.5
            ).linearisation
            linearisation = replace(alone, active=linearisation.active, slopes=linearisation.slopes)
        residual, settled, taken = study.residual(linearisation.point, "all"), reached.settled, reached.iterations
        return FitState(
            tuple(chosen),
            linearisation,
            residual,
            settled,
            taken,
            minus_two_log_likelihood(study, residual),
            ResidualSummary.of(study, residual),
        )

    def with_values(self, point: Point, values: Mapping[str, float]) -> Point:
        """A point with some parameters (SI) as given."""
        x = point.x.copy()
        for label, value in values.items():
            i = self.study.labels.index(label)
            x[i] = self.study.space.free[i].transform.inverse(value)
        return Point(x, point.own)

    def with_starting_values(self, point: Point, names: Sequence[str]) -> Point:
        """A point with some directions set back to where the search began."""
        moved = np.abs(self.study.directions[self.study.index(names)]).sum(axis=0) > 0
        return replace(point, x=np.where(moved, self.begun, point.x))

    def likelihood_gain(self, before: FitState, after: FitState) -> float:
        """Decrease of -2 ln L of the fitted tests from one state to another."""
        return float((before.likelihood - after.likelihood)[self.study.used].sum())

    def likeliest(self, *states: FitState) -> FitState:
        """The state that follows the fitted tests best."""
        return min(states, key=lambda state: float(state.likelihood[self.study.used].sum()))

    def assess(self, before: FitState, after: FitState, candidate: Candidate, last: bool = False) -> Verdict:
        """Whether an effect is accepted, by the held-out tests.

        Without held-out tests the fitted ones decide, and at `last` blocks of them that are left out in turn.
        """
        study, prior = self.study, self.prior(after.chosen)
        grounds = HeldOutComparison(study, ~study.used, before.summary, after.summary, True)
        if study.used.all():
            grounds = grounds._replace(compared=study.used, unseen=False)
            if last and self.blocks is not None:
                without, with_it = (self.blocks.residual_summary(state, self.prior(state.chosen)) for state in (before, after))
                grounds = HeldOutComparison(self.blocks.study, np.ones(len(without.error), bool), without, with_it, True)
        return assess_effect(study, before, after, candidate, prior, self.count, grounds)

    @cached_property
    def blocks(self) -> HeldOutBlocks | None:
        """The fitted tests in blocks; None where none can be cut."""
        try:
            return HeldOutBlocks(self.study, self.campaign.records)
        except ValueError:
            return None
