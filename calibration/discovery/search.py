"""The loop: fit, score every candidate, refit a shortlist, decide on what was not fitted, again; then take each out again."""

import math
import time as clock
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from calibration.campaign import Campaign
from calibration.discovery.anatomy import anatomy, signature
from calibration.discovery.catalogue import Candidate
from calibration.discovery.conclusion import calibration_of, effect_of
from calibration.discovery.descent import FLOOR, Reached, fit, normal, solve
from calibration.discovery.linear import Predicted, predict
from calibration.discovery.pose import WIDE, Posed, pose
from calibration.discovery.records import options_for
from calibration.discovery.result import Diagnosis, Effect, Rejected, Score
from calibration.discovery.study import Look, Place, Prior
from calibration.fit import Progress, prepare, run
from calibration.seas import Options

ROUNDS = 4  # effects at most
SHORTLIST = 4
ITERATIONS = 5  # of a refit
LAST = 15  # ... of what is let in
LEFT = {"decay": 0.03, "waves": 0.5}  # of a motion: what is left beyond it is not for noise, nor for a model's last digits
CHUNK = 12  # candidates' directions scored at a time
# thresholds, set by what they do on campaigns with nothing missing
LEAST_BIC = 30.0
LEAST_GAIN = 0.05  # share of the held-out error above noise
LEAST_CLEAR = 3.0  # standard deviations
ALIKE = 0.25  # of the winner's gain: what comes as near cannot be told from it


@dataclass
class State:
    """Where the diagnosis is: effects in the model, the fit, and its look at all tests."""

    chosen: tuple[Candidate, ...]
    reached: Reached
    fitted: float  # -2 ln L of the fitted tests
    held: float
    left: np.ndarray = field(default_factory=lambda: np.zeros(0))  # error above noise by series


class Search:
    """A diagnosis under way."""

    def __init__(self, campaign: Campaign, posed: Posed, say: Callable[[str, float], None]) -> None:
        self.campaign, self.posed, self.say = campaign, posed, say
        study = posed.study
        self.study = study
        self.base = study.index([*posed.base, *posed.nuisances])
        self.used = np.array([one.use == "fit" for one in study.series])
        self.scores: list[Score] = []
        self.rejected: dict[str, Rejected] = {}
        self.alike: dict[str, tuple[str, ...]] = {}
        self.verdicts: dict = {}
        # independent observations, for BIC: as many as there are degrees of freedom where a motion is above its noise
        self.count = 1.0

    def active(self, chosen: Sequence[Candidate]) -> list[int]:
        """Directions that are free with some effects in the model."""
        labels = [label for one in chosen for label in (*one.amplitudes, *one.shapes)]
        return list(dict.fromkeys([*self.base, *self.study.index(labels)]))

    def prior(self, chosen: Sequence[Candidate]) -> Prior:
        """Mass properties are nearly known unless they are what is looked for."""
        width = self.posed.prior.width.copy()
        for one in chosen:
            if one.effect == "mass_properties":
                width[self.study.index(one.amplitudes)] = WIDE
        return Prior(self.posed.prior.mean, width)

    def begin(self) -> Place:
        """Coefficients and releases of an ordinary calibration to the decays, which finds them from far away."""
        place = self.study.start()
        if self.study.decays is None or not any(r.kind == "decay" and r.use == "fit" for r in self.campaign.records):
            return place
        plain = prepare(self.campaign)
        run(plain)
        x = place.x.copy()
        for label, value in zip(plain.problem.space.labels, np.asarray(plain.unknowns.shared)):
            x[self.study.labels.index(label)] = value
        own = place.own.copy()
        rows = [r.id for r in self.study.decay_records]
        for record, mine in zip(plain.records, np.asarray(plain.unknowns.own)):
            i = rows.index(record.id)
            parts = mine.reshape(3, -1) * np.asarray(plain.problem.data.unit)[plain.records.index(record)]
            own[i] = (parts / np.asarray(self.study.decays.problem.data.unit)[i]).ravel()
        return Place(x, own)

    def refit(self, place: Place, chosen: Sequence[Candidate], iterations: int, name: str, fraction: float) -> State:
        """All that is free with some effects in the model, to the fitted tests; then the held-out tests' own releases.

        The decays first, alone: they cost less, and bring it near.
        """
        prior, active = self.prior(chosen), self.active(chosen)

        def report(i: int, cost: float) -> None:
            self.say(f"{name}: iteration {i}, -2 ln L {cost:.0f}", fraction)

        decaying = self.used & np.array([one.kind == "decay" for one in self.study.series])
        if decaying.any() and self.study.seas and not (chosen and chosen[-1].needs == "waves"):
            place = fit(
                self.study, place, active, decaying, prior, iterations=iterations, seas="none", tolerance=2.0, say=report
            ).look.place
        reached = fit(self.study, place, active, self.used, prior, iterations=iterations, tolerance=1.0, say=report)
        look = reached.look
        for _ in range(1 if iterations <= ITERATIONS else 4):
            look = self.settle(look, prior)
        if self.study.seas:
            look = self.study.look(look.place, look.active)
        return self.state(chosen, reached._replace(look=look))

    def settle(self, look: Look, prior: Prior) -> Look:
        """One step of the held-out decays' own unknowns, the shared ones as they are."""
        if not look.decays.size or self.used.all():
            return look
        q = len(look.active)
        sliced = Look(look.place, (), look.decays[..., q:, q:], tuple(one[..., q:, q:] for one in look.seas))
        _, step = solve(normal(self.study, sliced, ~self.used, prior), 1e-6)
        fitted = np.array([r.use == "fit" for r in self.study.decay_records])
        own = np.where(fitted[:, None], look.place.own, look.place.own + step)
        there = self.study.look(Place(look.place.x, own), look.active, seas="none")
        return replace(there, seas=look.seas)

    def state(self, chosen: Sequence[Candidate], reached: Reached) -> State:
        mean_square, dof = self.study.mean_squares(reached.look)
        each = (dof * np.log(np.maximum(mean_square, FLOOR))).sum(axis=1)
        left = (dof * np.maximum(mean_square - 1, 0)).sum(axis=1)
        return State(tuple(chosen), reached, float(each[self.used].sum()), float(each[~self.used].sum()), left)

    def score(self, state: State, number: int, fraction: float) -> list[tuple[Candidate, Predicted, dict[str, float]]]:
        """Every candidate that is not in the model, at its null, the fitted directions projected out."""
        open_ones = [one for one in self.posed.candidates if one not in state.chosen]
        base = self.active(state.chosen)
        grids = max((len(one.grid) for one in open_ones), default=1)
        best: dict[str, tuple[Candidate, Predicted, dict[str, float]]] = {}
        for g in range(max(grids, 1)):
            todo = [one for one in open_ones if (g < len(one.grid)) or (g == 0 and not one.grid)]
            place = self.shaped(state.reached.look.place, [(one, one.grid[g]) for one in todo if one.grid])
            for group in self.chunks(todo, base):
                columns = [i for one in group for i in self.study.index(one.amplitudes) if i not in base]
                look = self.study.look(place, [*base, *columns], seas="fit")
                for one in group:
                    mine = [look.active.index(i) for i in self.study.index(one.amplitudes)]
                    keep = list(dict.fromkeys([*range(len(base)), *mine]))
                    prior = self.prior([*state.chosen, one])
                    found = predict(self.study, look, keep, self.used, prior)
                    at = [keep.index(i) for i in mine]
                    found = found._replace(step=found.step[at], covariance=found.covariance[np.ix_(at, at)])
                    if self.wrong_sign(one, found.step, found.deviation, place):
                        found = found._replace(fitted=0.0, held=0.0)
                    name = one.name
                    shapes = dict(one.grid[g]) if one.grid else {}
                    if name not in best or found.fitted > best[name][1].fitted:
                        best[name] = (one, found, shapes)
                self.say(f"round {number}: scoring", fraction)
        ranked = sorted(best.values(), key=lambda item: -item[1].fitted)
        for one, found, _ in ranked:
            self.scores.append(Score(number, one.effect, one.dof, found.fitted, len(one.amplitudes), found.held, None, None))
        return ranked

    def chunks(self, candidates: Sequence[Candidate], base: Sequence[int]) -> list[list[Candidate]]:
        """Groups of candidates whose directions fit beside those of the base."""
        room, groups, size = self.study.width - len(base), [[]], 0  # type: ignore[var-annotated]
        for one in candidates:
            more = len([i for i in self.study.index(one.amplitudes) if i not in base])
            if size + more > room:
                groups.append([])
                size = 0
            groups[-1].append(one)
            size += more
        return [group for group in groups if group]

    def shaped(self, place: Place, shapes: Sequence[tuple[Candidate, Mapping[str, float]]]) -> Place:
        """A place with the shapes of some candidates as given."""
        x = place.x.copy()
        for _, values in shapes:
            for label, value in values.items():
                i = self.study.labels.index(label)
                x[i] = self.study.space.free[i].transform.inverse(value)
        return Place(x, place.own)

    def wrong_sign(self, one: Candidate, step: np.ndarray, deviation: np.ndarray, place: Place) -> bool:
        """Whether what physics wants above zero goes below it, and clearly so."""
        for label in one.positive:
            i = one.amplitudes.index(label)
            if step[i] < 0 and (len(one.amplitudes) == 1 or step[i] < -2 * deviation[i]):
                return True
        return False

    def values_of(self, one: Candidate, state: State) -> dict[str, float]:
        x = state.reached.look.place.x
        return {label: float(self.study.space.free[i].transform.forward(x[i]))
                for label in one.amplitudes for i in [self.study.labels.index(label)]}  # fmt: skip

    def judge(self, before: State, after: State, one: Candidate) -> tuple[float, float, float, str]:
        """Delta BIC, held-out gain, how clear the parameter is, and why it is refused ("": it is not)."""
        size = len(one.amplitudes) + len(one.shapes)
        bic = before.fitted - after.fitted - size * math.log(self.count)
        held, total = self.held_gain(before, after)
        clear = self.clearness(one, after)
        values = self.values_of(one, after)
        for label in one.positive:
            if values[label] < 0 and len(one.amplitudes) == 1:
                return bic, held, clear, f"{label} comes out as {values[label]:.3g}, which physics does not allow"
        if bic < LEAST_BIC:
            return bic, held, clear, f"it gains too little in the fitted tests (BIC {bic:+.0f})"
        if total and held < LEAST_GAIN:
            return bic, held, clear, f"the held-out tests' error above noise changes by {-100 * held:+.0f} % only"
        if clear < LEAST_CLEAR:
            return bic, held, clear, f"its parameters are no more than {clear:.1f} standard deviations from none"
        return bic, held, clear, ""

    def held_gain(self, before: State, after: State) -> tuple[float, bool]:
        """Mean share of the error above noise that is gone, over the held-out motions that have any; else the fitted."""
        held = ~self.used if (~self.used).any() else self.used
        dof = np.array([one.dof.sum() for one in self.study.series])
        some = held & (np.maximum(before.left, after.left) > 0.2 * dof)
        if not some.any():
            return 0.0, bool((~self.used).any())
        ratio = np.log((after.left[some] + 0.1 * dof[some]) / (before.left[some] + 0.1 * dof[some]))
        weight = np.array([self.weight(one) for one, s in zip(self.study.series, some) if s])
        return float(1 - math.exp(float((weight * ratio).sum() / weight.sum()))), True

    @staticmethod
    def weight(one) -> float:
        """Motions count by how much of them there is over their noise, up to a point."""
        return min(one.spread / one.noise, 50.0)

    def clearness(self, one: Candidate, state: State) -> float:
        """The effect's parameters over their standard deviations: of several together, as one normal variable would be."""
        look = state.reached.look
        columns = [look.active.index(i) for i in self.study.index(one.amplitudes)]
        found = predict(self.study, look, range(len(look.active)), self.used, self.prior(state.chosen))
        steps = self.study.steps(look.place.x)[[look.active[i] for i in columns]]
        wald = float(steps @ np.linalg.pinv(found.covariance[np.ix_(columns, columns)], hermitian=True) @ steps)
        return math.sqrt(max(wald - len(columns) + 1, 0.0))

    def grow(self, state: State, number: int) -> State | None:
        """The best effect let in; None where none survives."""
        done = 0.15 + 0.8 * (number - 1) / ROUNDS
        ranked = self.score(state, number, done)
        if not ranked:
            return None
        look = state.reached.look
        tried: list[tuple[float, Candidate, State, tuple[float, float, float, str], Predicted]] = []
        enough = 2 * math.log(self.count)
        short = [item for item in ranked if item[1].fitted > enough][:SHORTLIST]
        for k, (one, found, shapes) in enumerate(short):
            place = self.shaped(look.place, [(one, shapes)] if shapes else [])
            after = self.refit(place, [*state.chosen, one], ITERATIONS, f"round {number}: {one.name}", done + 0.03 * (k + 1))
            verdict = self.judge(state, after, one)
            gain = (state.fitted - after.fitted) + max(state.held - after.held, -1e3)
            tried.append((gain - len(one.amplitudes) * math.log(self.count), one, after, verdict, found))
            self.mark(number, one, state.fitted - after.fitted, verdict[1])
        for one, _, _ in ranked[len(short) :]:
            self.rejected.setdefault(one.name, Rejected(one.effect, one.dof, "explains too little at first order"))
        for item in tried:
            if item[3][3]:
                self.rejected[item[1].name] = Rejected(item[1].effect, item[1].dof, item[3][3])
        good = sorted((item for item in tried if not item[3][3]), key=lambda item: -item[0])
        if not good:
            return None
        best = good[0]
        self.alike[best[1].name] = tuple(item[1].name for item in good[1:] if best[0] - item[0] < ALIKE * abs(best[0]))
        self.verdicts[best[1].name] = (best[3], best[4].fitted, state)
        for item in good[1:]:
            self.rejected[item[1].name] = Rejected(item[1].effect, item[1].dof, f"{best[1].name} explains more")
        self.rejected.pop(best[1].name, None)
        last = f"round {number}: {best[1].name} it is"
        return self.refit(best[2].reached.look.place, best[2].chosen, LAST, last, done + 0.15)

    def mark(self, number: int, one: Candidate, gain: float, held: float) -> None:
        for i, score in enumerate(self.scores):
            if score.round == number and (score.effect, score.degree_of_freedom) == (one.effect, one.dof):
                self.scores[i] = replace(score, refitted=gain, refitted_holdout=held)


def diagnose(
    campaign: Campaign,
    *,
    progress: Callable[[Progress], None] | None = None,
    options: Options | None = None,
) -> Diagnosis:
    """What the declared model of a campaign lacks: found, added, judged by the tests marked `holdout`.

    Raises InputError where a campaign has nothing to diagnose.
    """
    begun = clock.monotonic()

    def say(stage: str, fraction: float) -> None:
        if progress is not None:
            progress(Progress(stage, 0, math.nan, fraction, "-2 ln L"))

    say("reading the records", 0.0)
    options, notes = options_for(campaign) if options is None else (options, ())
    posed = pose(campaign, options)
    search = Search(campaign, posed, say)
    say("calibrating the declared model", 0.03)
    place = search.begin()
    state = search.refit(place, (), LAST, "declared model", 0.08)
    search.count = max(2.0, float(sum(one.dof.sum() for one, u in zip(posed.study.series, search.used) if u)) / 4)
    before = state
    for number in range(1, ROUNDS + 1):
        after = search.grow(state, number)
        if after is None:
            break
        state = after
    return _conclude(campaign, search, before, state, notes, clock.monotonic() - begun)


def _conclude(
    campaign: Campaign, search: Search, before: State, after: State, notes: Sequence[str], seconds: float
) -> Diagnosis:
    baseline = calibration_of(campaign, search, before, None)
    augmented = calibration_of(campaign, search, after, before)
    effects: list[Effect] = [effect_of(search, one, before, after) for one in after.chosen]
    share, words = signature(search, before, after)
    rest = [one for one in anatomy(search, after) if one.use == "fit" and one.rms > 2 * one.noise]
    kinds = {one.test: "decay" if one.kind == "decay" else "waves" for one in search.study.series}
    much = any(one.relative > LEFT[kinds[one.test]] for one in rest)
    verdict = "found" if effects else ("unexplained" if much else "nothing_missing")
    wanted = [one.telling for one in after.chosen if one.telling]
    return Diagnosis(
        campaign.manifest.name, verdict, baseline, augmented, tuple(effects), tuple(search.rejected.values()),
        tuple(search.scores), anatomy(search, before), anatomy(search, after), share, words, wanted[0] if wanted else "",
        tuple(notes), seconds,
    )  # fmt: skip
