"""Verification of selected effects by simulation: every effect is taken out in turn."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from calibration.discovery.acceptance import worsening
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.effects.effect_names import effect_in_words
from calibration.discovery.fit_state import FitState
from calibration.discovery.refusal import Refusal, RefusalKind
from calibration.discovery.search import AcceptedEffect, Search
from calibration.discovery.selection.candidate_columns import candidate_columns
from calibration.discovery.selection.cross_validation import held_out_gain
from calibration.discovery.selection.held_out_prediction import supported_effects
from calibration.discovery.selection.joint_search import END, FINAL_FIT, JointSearch
from calibration.discovery.selection.joint_selection import JointSelection
from calibration.discovery.selection.subset_fit import fit_subset
from calibration.fitting.cores import cores
from jaxhydro.interrupts import stoppable_threads

INDISTINGUISHABLE_SHARE = 0.1  # of an effect's log evidence: another that has all but this much is not told from it
VERIFIED = 0.95  # progress when every effect has been taken out once
MIN_PROBABILITY = 0.5  # of an effect and those that the records cannot tell from it


class Verification:
    """Verification of the effects that a joint search selected.

    Attributes:
        fits: Study, candidates and priors, and the fits with them.
        record: What the search has come to so far.
        joint: The joint search, its last linear model and selection.
    """

    def __init__(self, search: Search, joint: JointSearch) -> None:
        self.fits, self.record = search
        self.joint = joint

    def run(self, baseline: FitState, state: FitState) -> FitState:
        """Take every effect out in turn, simulate, and keep the effects that the records support.

        After an effect has gone, the others that were refused are tried again. At the end all that are left are tried, from a
        fit to convergence. The final model follows no motion worse than the baseline, if an effect is the reason.

        Args:
            baseline: The fitted baseline.
            state: The last state of the search.
        """
        state = self.without_unsupported(baseline, state)
        tried, converged = state.chosen, True
        while tried:
            self.record.accepted.update(self.evidence(baseline, state, tried))
            if converged:
                self.refuse_worsening(baseline, state)
            refused = [candidate for candidate in tried if self.record.accepted[candidate.name].verdict.refused]
            if refused:
                least = min(refused, key=lambda candidate: self.record.accepted[candidate.name].verdict.worth)
                gone = self.record.accepted.pop(least.name)
                self.record.reject(least, gone.verdict.refused, gone.verdict)
                state, converged = gone.before, False
                tried = tuple(candidate for candidate in refused if candidate is not least)
            else:
                tried = ()
                if converged:
                    break
            if not tried and state.chosen:
                state, converged = self.refit_all(state), True
                tried = state.chosen
        self.reject_others(state)
        return replace(
            state, chosen=tuple(sorted(state.chosen, key=lambda candidate: -self.record.accepted[candidate.name].verdict.worth))
        )

    def refit_all(self, state: FitState) -> FitState:
        """Fit a state to convergence."""
        return self.fits.refit_from(state, state.chosen, FINAL_FIT, END)

    def without_unsupported(self, baseline: FitState, state: FitState) -> FitState:
        """A state without the effects that held-out tests, as the linear model predicts them, do not support.

        Args:
            baseline: The fitted baseline.
            state: The last state of the search.
        """
        study = self.fits.study
        if not state.chosen or study.used.all():
            return state
        self.fits.say("verification: held-out tests as the linear model predicts them", END)
        linearisation = study.linearise(state.linearisation.point, self.fits.active(state.chosen), "all")
        columns = candidate_columns(self.fits, linearisation, state.chosen, ())
        selection = JointSelection(columns.model, columns.base, columns.variants, columns.series)
        subset, reasons = supported_effects(study, linearisation, selection, range(len(state.chosen)))
        for i, why in reasons.items():
            self.record.reject(self.joint.candidates[columns.variants[i].name], why)
        if not reasons:
            return state
        if not subset.variants:
            return baseline
        return self.refit_all(fit_subset(self.fits, state, columns, subset, "verification", END))

    def refuse_worsening(self, baseline: FitState, state: FitState) -> None:
        """Refuse the effect with which a motion of a test is followed worse than in the baseline.

        Nothing is refused where another effect is refused already, or where no single effect is the reason.

        Args:
            baseline: The fitted baseline.
            state: The fitted model, every effect's evidence in `accepted`.
        """
        worse = worsening(self.fits.study, baseline.summary, state.summary)
        worst = int(np.argmax(worse))
        if worse[worst] <= 1 or any(effect.verdict.refused for effect in self.record.accepted.values()):
            return
        name = min(self.record.accepted, key=lambda name: self.record.accepted[name].before.summary.error[worst])
        accepted, series = self.record.accepted[name], self.fits.study.series[worst]
        if worsening(self.fits.study, accepted.before.summary, state.summary)[worst] <= 1:
            return  # no single effect is the reason
        error = [float(fitted.summary.error[worst]) / series.spread for fitted in (baseline, state)]
        refused = Refusal(RefusalKind.WORSE_TEST, tuple(error), f"{series.channel} of {series.test}")
        self.record.accepted[name] = accepted._replace(verdict=accepted.verdict._replace(refused=refused))

    def evidence(self, baseline: FitState, state: FitState, tried: Sequence[Candidate]) -> dict[str, AcceptedEffect]:
        """Evidence of effects in a model, by simulation without each of them.

        In the linear model tests are left out in turn, too.

        Args:
            baseline: The fitted baseline.
            state: The fitted model.
            tried: The effects.

        Returns:
            The evidence by name.
        """
        columns = candidate_columns(self.fits, state.linearisation, state.chosen, ())
        last = JointSelection(columns.model, columns.base, columns.variants, columns.series)
        whole = last.subset(range(len(state.chosen)))
        rest = {candidate.name: last.without(whole, state.chosen.index(candidate)) for candidate in tried}

        def without(candidate: Candidate) -> FitState:
            if not rest[candidate.name].variants:
                return baseline
            stage = f"verification: the model without {effect_in_words(candidate.name)}"
            share = END + (VERIFIED - END) * (1 + tried.index(candidate)) / (1 + len(tried))
            return fit_subset(self.fits, state, columns, rest[candidate.name], stage, share)

        with stoppable_threads(cores()) as pool:
            before = list(pool.map(without, tried))
        evidence = {}
        for candidate, fitted in zip(tried, before, strict=True):
            verdict = self.fits.assess(fitted, state, candidate, last=True)
            alike = self.look_alikes(state, candidate)
            probability = self.joint.probability.get(candidate.name, 0.0)
            if (
                verdict.refused is None
                and probability + sum(self.joint.probability.get(name, 0.0) for name in alike) < MIN_PROBABILITY
            ):
                verdict = verdict._replace(refused=Refusal(RefusalKind.IMPROBABLE, (probability,)))
            gains = [
                score.gain
                for score in self.record.scores
                if (score.effect, score.degree_of_freedom) == (candidate.effect, candidate.dof)
            ]
            held = held_out_gain(columns.model, whole.fit, rest[candidate.name].fit, self.test_of_pool)
            evidence[candidate.name] = AcceptedEffect(max(gains, default=0.0), fitted, state, verdict, alike, probability, held)
        return evidence

    @property
    def test_of_pool(self) -> np.ndarray:
        """Number of the test of every pool (p,)."""
        tests = list(dict.fromkeys(series.test for series in self.fits.study.series))
        return np.repeat([tests.index(series.test) for series in self.fits.study.series], self.fits.study.dof.shape[1])

    def look_alikes(self, state: FitState, candidate: Candidate) -> tuple[str, ...]:
        """Effects that would do nearly as well in the place of one, in the last selection.

        Args:
            state: The fitted model.
            candidate: The effect that is exchanged.
        """
        whole = self.joint.selector.subset(self.joint.columns.present(state.chosen))
        rest = self.joint.selector.without(whole, *self.joint.columns.present([candidate]))
        best: dict[str, float] = {}
        for i in self.joint.selector.additions(rest):
            name = self.joint.columns.variants[i].name
            exchanged = self.joint.selector.fitted.get(tuple(sorted((*rest.variants, i))))
            if name != candidate.name and exchanged is not None and exchanged.plausible:
                best[name] = max(best.get(name, -np.inf), exchanged.evidence)
        asked = whole.evidence - INDISTINGUISHABLE_SHARE * (whole.evidence - rest.evidence)
        return tuple(name for name, evidence in best.items() if evidence > asked)

    def reject_others(self, state: FitState) -> None:
        """Record why the other candidates are not in the model.

        Their probability is low, or most rounds do without them.
        """
        present = {candidate.name for candidate in state.chosen}
        for candidate in self.fits.setup.candidates:
            if candidate.name not in present and candidate.name not in self.record.rejected:
                probability = self.joint.probability.get(candidate.name, 0.0)
                kind = RefusalKind.IMPROBABLE if probability < MIN_PROBABILITY else RefusalKind.UNSETTLED
                self.record.reject(candidate, Refusal(kind, (probability,)))
        for name in present:
            self.record.rejected.pop(name, None)
