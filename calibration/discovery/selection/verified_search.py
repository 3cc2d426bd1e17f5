"""Verification of a joint search by simulation: every effect is taken out in turn."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from calibration.discovery.acceptance import worsening
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.effects.effect_names import effect_in_words
from calibration.discovery.fit_state import FitState
from calibration.discovery.refusal import Refusal, RefusalKind
from calibration.discovery.search import AcceptedEffect
from calibration.discovery.selection.candidate_columns import candidate_columns
from calibration.discovery.selection.cross_validation import held_out_gain
from calibration.discovery.selection.held_out_prediction import supported_effects
from calibration.discovery.selection.joint_search import END, JointSearch
from calibration.discovery.selection.joint_selection import JointSelection
from calibration.fitting.cores import cores
from jaxhydro.interrupts import stoppable_threads

INDISTINGUISHABLE_SHARE = 0.1  # of an effect's log evidence: another that has all but this much is not told from it
VERIFIED = 0.95  # progress when every effect has been taken out once
MIN_PROBABILITY = 0.5  # of an effect and those that the records cannot tell from it


class VerifiedSearch(JointSearch):
    """Joint search whose effects are verified by simulation."""

    def verify(self, baseline: FitState, state: FitState) -> FitState:
        """Take every effect out in turn, simulate, and keep those that the records ask for.

        After an effect has gone, the others that were refused are tried again, and at the end all that are left, from a fit to
        convergence. The model that is kept follows no motion worse than the declared one, if an effect is the reason.

        Args:
            baseline: The fitted baseline.
            state: The last state of the search.
        """
        state = self.without_unsupported(baseline, state)
        tried, converged = state.chosen, True
        while tried:
            self.found.update(self.evidence(baseline, state, tried))
            if converged:
                self.refuse_worsening(baseline, state)
            refused = [one for one in tried if self.found[one.name].verdict.refused]
            if refused:
                least = min(refused, key=lambda one: self.found[one.name].verdict.worth)
                gone = self.found.pop(least.name)
                self.reject(least, gone.verdict.refused, gone.verdict)
                state, converged = gone.before, False
                tried = tuple(one for one in refused if one is not least)
            else:
                tried = ()
                if converged:
                    break
            if not tried and state.chosen:
                state, converged = self.refit_all(state), True
                tried = state.chosen
        self.reject_others(state)
        return replace(state, chosen=tuple(sorted(state.chosen, key=lambda one: -self.found[one.name].verdict.worth)))

    def without_unsupported(self, baseline: FitState, state: FitState) -> FitState:
        """A state without the effects that held-out tests, as the linear model predicts them, do not support.

        Args:
            baseline: The fitted baseline.
            state: The last state of the search.
        """
        study = self.study
        if not state.chosen or study.used.all():
            return state
        self.say("verification: held-out tests as the linear model predicts them", END)
        look = study.linearise(state.look.place, self.active(state.chosen), "all")
        columns = candidate_columns(self, look, state.chosen, ())
        selection = JointSelection(columns.model, columns.base, columns.variants, columns.series)
        subset, reasons = supported_effects(study, look, selection, range(len(state.chosen)))
        for i, why in reasons.items():
            self.reject(self.candidates[columns.variants[i].name], why)
        if not reasons:
            return state
        if not subset.variants:
            return baseline
        return self.refit_all(self.fit_subset(state, columns, subset, "verification", END))

    def refuse_worsening(self, baseline: FitState, state: FitState) -> None:
        """Refuse the effect that makes a motion of a test be followed worse than in the baseline, if there is one.

        Args:
            baseline: The fitted baseline.
            state: The fitted model, every effect's evidence in `found`.
        """
        worse = worsening(self.study, baseline.left, state.left)
        worst = int(np.argmax(worse))
        if worse[worst] <= 1 or any(one.verdict.refused for one in self.found.values()):
            return
        name = min(self.found, key=lambda name: self.found[name].before.left.error[worst])
        found, series = self.found[name], self.study.series[worst]
        if worsening(self.study, found.before.left, state.left)[worst] <= 1:
            return  # no single effect is the reason
        error = [float(some.left.error[worst]) / series.spread for some in (baseline, state)]
        refused = Refusal(RefusalKind.WORSE_TEST, tuple(error), f"{series.channel} of {series.test}")
        self.found[name] = found._replace(verdict=found.verdict._replace(refused=refused))

    def evidence(self, baseline: FitState, state: FitState, tried: Sequence[Candidate]) -> dict[str, AcceptedEffect]:
        """Evidence of effects in a model: by simulation without each, and tests left out in turn in the linear model.

        Args:
            baseline: The fitted baseline.
            state: The fitted model.
            tried: The effects.

        Returns:
            The evidence by name.
        """
        columns = candidate_columns(self, state.look, state.chosen, ())
        last = JointSelection(columns.model, columns.base, columns.variants, columns.series)
        whole = last.subset(range(len(state.chosen)))
        rest = {one.name: last.without(whole, state.chosen.index(one)) for one in tried}

        def without(one: Candidate) -> FitState:
            if not rest[one.name].variants:
                return baseline
            stage = f"verification: the model without {effect_in_words(one.name)}"
            share = END + (VERIFIED - END) * (1 + tried.index(one)) / (1 + len(tried))
            return self.fit_subset(state, columns, rest[one.name], stage, share)

        with stoppable_threads(cores()) as pool:
            before = list(pool.map(without, tried))
        evidence = {}
        for one, fitted in zip(tried, before, strict=True):
            verdict = self.assess(fitted, state, one, last=True)
            alike = self.look_alikes(state, one)
            probability = self.probability.get(one.name, 0.0)
            if (
                verdict.refused is None
                and probability + sum(self.probability.get(name, 0.0) for name in alike) < MIN_PROBABILITY
            ):
                verdict = verdict._replace(refused=Refusal(RefusalKind.IMPROBABLE, (probability,)))
            gains = [score.gain for score in self.scores if (score.effect, score.degree_of_freedom) == (one.effect, one.dof)]
            held = held_out_gain(columns.model, whole.fit, rest[one.name].fit, self.test_of_pool)
            evidence[one.name] = AcceptedEffect(max(gains, default=0.0), fitted, state, verdict, alike, probability, held)
        return evidence

    @property
    def test_of_pool(self) -> np.ndarray:
        """Number of the test of every pool (p,)."""
        tests = list(dict.fromkeys(one.test for one in self.study.series))
        return np.repeat([tests.index(one.test) for one in self.study.series], self.study.dof.shape[1])

    def look_alikes(self, state: FitState, one: Candidate) -> tuple[str, ...]:
        """Effects that would do nearly as well in the place of one, in the last selection.

        Args:
            state: The fitted model.
            one: The effect that is exchanged.
        """
        whole = self.selector.subset(self.columns.present(state.chosen))
        rest = self.selector.without(whole, *self.columns.present([one]))
        best: dict[str, float] = {}
        for i in self.selector.additions(rest):
            name = self.columns.variants[i].name
            other = self.selector.fitted.get(tuple(sorted((*rest.variants, i))))
            if name != one.name and other is not None and other.plausible:
                best[name] = max(best.get(name, -np.inf), other.evidence)
        asked = whole.evidence - INDISTINGUISHABLE_SHARE * (whole.evidence - rest.evidence)
        return tuple(name for name, evidence in best.items() if evidence > asked)

    def reject_others(self, state: FitState) -> None:
        """Record why the other candidates are not in the model: their probability is low, or most rounds do without them."""
        present = {one.name for one in state.chosen}
        for one in self.setup.candidates:
            if one.name not in present and one.name not in self.rejected:
                probability = self.probability.get(one.name, 0.0)
                kind = RefusalKind.IMPROBABLE if probability < MIN_PROBABILITY else RefusalKind.UNSETTLED
                self.reject(one, Refusal(kind, (probability,)))
        for name in present:
            self.rejected.pop(name, None)
