"""The loop: fit, score every candidate at its null, refit a shortlist, decide on what was not fitted; until none is left."""

import math
import time as clock
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import count
from pathlib import Path

import numpy as np

from calibration.campaign import Campaign
from calibration.discovery.blocks import Blocks
from calibration.discovery.candidates import Candidate
from calibration.discovery.conclusion import conclude
from calibration.discovery.descent import Reached, fit
from calibration.discovery.expected import expected
from calibration.discovery.judgement import LEAST_TOGETHER, Grounds, Left, State, Verdict, given_up, judge
from calibration.discovery.kept import keep, resumed
from calibration.discovery.linear import Predicted, likelihoods, predict
from calibration.discovery.pose import WIDE, Posed, pose
from calibration.discovery.records import options_for
from calibration.discovery.result import Diagnosis, Rejected, Score
from calibration.discovery.signs import in_words, reversed_channels, turned
from calibration.discovery.study import Look, Place, Prior
from calibration.discovery.trials import Found, Scored, Tried, in_order
from calibration.fit import Progress, prepare, run
from calibration.residuals import first_guess
from calibration.seas import NO_ZERO, Options
from jaxhydro.model import Model

ROUNDS = 6  # effects at most
SHORTLIST = 5
FAR = 0.3  # of what a refitted effect gains: what gains less at first order is not refitted beside it
ITERATIONS = 8  # of a refit
LAST = 50  # ... of what is let in
LOOKS = 8  # slopes taken anew in that
ABSOLUTE = f"{NO_ZERO}, and a sensor whose zero is elsewhere for ballast or a force"


class Search:
    """A diagnosis under way: the study, and what was seen of the candidates."""

    def __init__(self, campaign: Campaign, posed: Posed, say: Callable[[str, float], None]) -> None:
        self.campaign, self.posed, self.study, self.say = campaign, posed, posed.study, say
        self.notes: list[str] = []
        self.alone: Left | None = None  # of a calibration to the decays, where there are seas, too
        self.begun = np.asarray(self.study.space.start)  # coordinates where the search begins: of a calibration to the decays
        self.linear = False  # whether seas are those without the second order that their records have
        self.base = self.study.index([*posed.base, *posed.nuisances])
        self.scores: list[Score] = []
        self.rejected: dict[str, Rejected] = {}
        self.found: dict[str, Found] = {}
        # independent observations, for BIC: a quarter of the degrees of freedom, as most bands hold noise only
        self.count = max(2.0, float(self.study.dof[self.study.used].sum()) / 4)

    def active(self, chosen: Sequence[Candidate]) -> list[int]:
        """Directions that are free with some effects in the model."""
        return list(dict.fromkeys([*self.base, *self.study.index([label for one in chosen for label in one.labels])]))

    def prior(self, chosen: Sequence[Candidate]) -> Prior:
        """What is nearly known, mass properties or draught, is not where it is what is looked for."""
        width = self.posed.prior.width.copy()
        for one in chosen:
            width[self.study.index(one.amplitudes)] = WIDE
        return Prior(self.posed.prior.mean, width)

    @cached_property
    def start(self) -> Place:
        """Coefficients and releases of an ordinary calibration to the decays, which finds them from far away."""
        study = self.study
        x = np.asarray(study.space.start).copy()
        if study.decays is None:
            return Place(x, np.zeros((0, 0)))
        own = np.asarray(first_guess(study.decay_records, study.decays.data)).copy()
        if study.fitted_decays.any():
            plain = prepare(self.campaign)
            run(plain, near=True)
            for label, value in zip(plain.problem.space.labels, np.asarray(plain.unknowns.shared)):
                x[study.labels.index(label)] = value
            rows = [r.id for r in study.decay_records]
            mine, theirs = np.asarray(study.decays.data.unit), np.asarray(plain.problem.data.unit)
            for k, (record, values) in enumerate(zip(plain.records, np.asarray(plain.unknowns.own))):
                i = rows.index(record.id)
                own[i] = (values.reshape(3, -1) * theirs[k] / mine[i]).ravel()
        return Place(x, own)

    def declared(self) -> State:
        """The declared model, fitted."""
        self.say("calibrating the declared model", 0.03)
        place = self.start
        self.anchor(place.x)
        if self.study.decays is not None and self.study.seas:
            self.alone = Left.of(self.study, self.study.residual(place))
        if self.study.seas:
            self.expect(place)
        self.say("declared model: slopes", 0.08)
        state = self.refit(self.study.look(place, self.base), (), "declared model", 0.1)
        if not self.study.linear_seas:
            return state
        study = self.study
        self.take_linear_seas()
        name = "declared model in waves of first order"
        reached = self.fit(self.study.look(state.look.place, self.base), (), ITERATIONS, 0, name, 0.12)
        first = self.state((), reached)
        better = float((state.likelihood - first.likelihood)[self.study.used].sum())
        if better < LEAST_TOGETHER:
            self.study, self.linear = study, False
            return state
        self.notes.append(
            "waves act as of first order: what theory binds to them at second order is in the records, but with it the motions "
            f"are followed worse (by {better:.0f} in -2 ln L)"
        )
        return self.refit(self.study.look(first.look.place, self.base), (), name, 0.14)

    def anchor(self, x: np.ndarray) -> None:
        """The search begins at these coordinates; in waves coefficients are known from there: what the declared model lacks
        would else move them to where they stand for it, linear damping for radiation, and slow motion is damped away."""
        self.begun = x
        if not self.study.seas:
            return
        stated = {one.label for one in self.study.space.free if math.isfinite(one.prior_deviation)}
        mine = self.study.index([name for name in self.posed.base if name not in stated])
        mean = self.posed.prior.mean.copy()
        mean[mine] = self.study.steps(x)[mine]
        self.posed = self.posed._replace(prior=Prior(mean, self.posed.prior.width))

    def expect(self, place: Place) -> None:
        """What is seen in waves weighed from now on by what unknown forces leave of it, as they seem from a place."""
        self.study = replace(self.study, expected=expected(self.study, place))

    def take_linear_seas(self) -> None:
        """Seas without the second order that their records have, from now on."""
        self.study, self.linear = replace(self.study, seas=self.study.linear_seas), True

    def refit(self, look: Look, chosen: Sequence[Candidate], name: str, fraction: float) -> State:
        """All directions of a look, until nothing is gained."""
        return self.state(chosen, self.fit(look, chosen, LAST, LOOKS, name, fraction))

    def fit(self, look: Look, chosen: Sequence[Candidate], iterations: int, looks: int, name: str, fraction: float) -> Reached:
        def report(i: int, cost: float) -> None:
            self.say(f"{name}: iteration {i}, -2 ln L {cost:.0f}", fraction)

        prior = self.prior(chosen)
        return fit(self.study, look, self.study.used, prior, iterations=iterations, looks=looks, tolerance=1.0, say=report)

    def state(self, chosen: Sequence[Candidate], reached: Reached) -> State:
        """What a fit has reached; the held-out decays' own unknowns are fitted to them, the parameters as they are."""
        study, look = self.study, reached.look
        if study.decays is not None and not study.fitted_decays.all():
            alone = fit(study, look.along(()), ~study.used, self.prior(chosen), iterations=4, tolerance=0.5).look
            look = replace(alone, active=look.active, slopes=look.slopes)
        residual, settled, taken = study.residual(look.place, "all"), reached.settled, reached.iterations
        return State(tuple(chosen), look, residual, settled, taken, likelihoods(study, residual), Left.of(study, residual))

    def score(self, state: State, number: int, fraction: float) -> list[Scored]:
        """Every candidate that is not in the model, at its null, the fitted directions projected out; the best first."""
        self.say(f"round {number}: scoring", fraction)
        self.scores = [one for one in self.scores if one.round != number]  # of a fit that was bettered on the way
        there = {label for one in state.chosen for label in one.labels}
        others = [one for one in self.posed.candidates if not set(one.labels) <= there]
        best: dict[str, Scored] = {}
        grids = {one.name: one.grid or ({},) for one in others}
        for g in count():
            if not (todo := [one for one in others if g < len(grids[one.name])]):
                break
            place = self.shaped(state.look.place, {k: v for one in todo for k, v in grids[one.name][g].items()})
            columns = dict.fromkeys(i for one in todo for i in self.study.index(one.amplitudes) if i not in state.look.active)
            seen = self.study.look(place, list(columns))
            for one in todo:
                self.say(f"round {number}: scoring {one.name}", fraction)
                mine = [i for i in self.study.index(one.amplitudes) if i not in state.look.active]
                look = replace(state.look.beside(seen.along(mine)), place=self.shaped(state.look.place, grids[one.name][g]))
                found = predict(self.study, look, self.prior([*state.chosen, one]))
                if one.places is not None and g < len(one.grid):
                    found_at = one.places(self.study, state.residual, seen.along(mine[:1]).slopes[:, 0])
                    grids[one.name] += tuple({**one.grid[g], **shape} for shape in found_at)
                if self.wrong_sign(one, look, found):
                    found = found._replace(gain=0 * found.gain)
                if one.name not in best or found.fitted > best[one.name].predicted.fitted:
                    best[one.name] = Scored(one, found, look)
        ranked = sorted(best.values(), key=lambda item: -item.predicted.fitted)
        for one, found, _ in ranked:
            self.scores.append(Score(number, one.effect, one.dof, found.fitted, len(one.amplitudes), found.held, None, None))
        return ranked

    def shaped(self, place: Place, values: Mapping[str, float]) -> Place:
        """A place with some parameters as given."""
        x = place.x.copy()
        for label, value in values.items():
            i = self.study.labels.index(label)
            x[i] = self.study.space.free[i].transform.inverse(value)
        return Place(x, place.own)

    def wrong_sign(self, one: Candidate, look: Look, found: Predicted) -> bool:
        """Whether what physics wants above zero goes below it, and clearly so."""
        for label in one.positive:
            i = look.active.index(self.study.names.index(label))
            if found.step[i] < 0 and (len(one.amplitudes) == 1 or found.step[i] < -2 * found.deviation[i]):
                return True
        return False

    def judge(self, before: State, after: State, one: Candidate, last: bool = False) -> Verdict:
        """Whether an effect is believed: by the tests held out; where there are none by the fitted ones, and at `last` by their
        blocks left out in turn."""
        study, prior = self.study, self.prior(after.chosen)
        grounds = Grounds(study, ~study.used, before.left, after.left, True)
        if study.used.all():
            grounds = grounds._replace(asked=study.used, unseen=False)
            if last and self.blocks is not None:
                without, with_it = (self.blocks.left(state, self.prior(state.chosen)) for state in (before, after))
                grounds = Grounds(self.blocks.study, np.ones(len(without.error), bool), without, with_it, True)
        return judge(study, before, after, one, prior, self.count, grounds)

    @cached_property
    def blocks(self) -> Blocks | None:
        """The fitted tests in blocks; None where none can be cut."""
        try:
            return Blocks(self.study, self.campaign.records)
        except ValueError:
            return None

    def grow(self, state: State, number: int) -> tuple[State, State | None]:
        """The state, fitted better where that was found on the way, and the best effect let in; None where none survives."""
        done = 0.15 + 0.8 * (number - 1) / ROUNDS
        enough = 2 * math.log(self.count)
        ranked = self.score(state, number, done)
        some = [item for item in ranked if item.predicted.fitted > enough]
        for item in ranked:
            weak = item.predicted.fitted <= enough
            self.refuse(item.candidate, f"{'explains too little' if weak else 'others explain more'} at first order")
        known = [item for item in ranked if item.candidate.begin]  # worth a trial whatever they are at first order
        some = [item for item in some if not item.candidate.begin]
        state, after = self.best(state, [*known, *some[:SHORTLIST]], number, done)
        if after is None and (others := self.by_motion(some[SHORTLIST:], enough)):
            state, after = self.best(state, others, number, done + 0.1)
        return state, after

    def by_motion(self, rest: Sequence[Scored], enough: float) -> list[Scored]:
        """What explains the most of one motion, among those that do not explain the most of all."""
        found: dict[str, Scored] = {}
        for channel in dict.fromkeys(one.channel for one in self.study.series) if rest else ():
            mine = self.study.used & np.array([one.channel == channel for one in self.study.series])
            gains = [float(item.predicted.gain[mine].sum()) for item in rest]
            if max(gains) > enough:
                best = rest[int(np.argmax(gains))]
                found[best.candidate.name] = best
        return list(found.values())

    def best(self, state: State, short: Sequence[Scored], number: int, done: float) -> tuple[State, State | None]:
        """The same of a shortlist."""
        tried: list[Tried] = []
        for item in short:
            highest = max((one.worth for one in tried if not one.verdict.refused), default=0.0)
            if item.predicted.fitted < FAR * highest and not item.candidate.begin:
                self.refuse(item.candidate, "explains far less than others")
            else:
                tried.append(self.attempt(state, item, number, done + 0.02 * (len(tried) + 1)))
        for one in tried:
            self.refuse(one.candidate, one.verdict.refused)
        good = in_order([one for one in tried if not one.verdict.refused])
        for best in good:
            new, chosen = best.candidate, best.state.chosen
            name = f"round {number}: {new.name} it is"
            # what is only nearly known was bent by what the model lacked
            effects = {label for one in chosen for label in one.labels}
            bent = [nuisance for nuisance in self.posed.nuisances if nuisance not in effects]
            places = [best.state.look.place, self.renewed(best.state.look.place, bent)]
            if self.study.seas:  # ... and so were coefficients
                places.append(self.renewed(places[-1], self.posed.base))
            every = [self.refit(self.study.look(place, self.active(chosen)), chosen, name, done + 0.15) for place in places]
            after = self.likeliest(*every)
            state = self.challenged(state, after, new, done + 0.16)
            self.say(f"{name}: blocks left out in turn" if self.study.used.all() else name, done + 0.17)
            verdict = self.judge(state, after, new, last=True)
            self.refuse(new, verdict.refused)
            if verdict.refused:
                continue
            rest = [one for one in good if one is not best]
            near = tuple(one.candidate.name for one in rest if one.like(best))
            self.found[new.name] = Found(best.score, state, after, verdict, near)
            for one in rest:
                self.refuse(one.candidate, f"{new.name} explains more")
            self.rejected.pop(new.name, None)
            return state, after
        return state, None

    def likeliest(self, *states: State) -> State:
        """The one that follows the fitted tests best."""
        return min(states, key=lambda state: float(state.likelihood[self.study.used].sum()))

    def challenged(self, without: State, after: State, one: Candidate, fraction: float) -> State:
        """A model without an effect; where that is better by far, fitted from where it is with it: any effect may help a fit
        over what held it up, and is not to be believed for that."""
        place = self.renewed(after.look.place, one.labels)
        other = self.refit(self.study.look(place, without.look.active), without.chosen, f"without {one.name}", fraction)
        gain = float((without.likelihood - other.likelihood)[self.study.used].sum())
        return other if gain > LEAST_TOGETHER else without

    def renewed(self, place: Place, names: Sequence[str]) -> Place:
        """A place where some directions are as they were where the search began."""
        at = np.abs(self.study.directions[self.study.index(names)]).sum(axis=0) > 0
        return replace(place, x=np.where(at, self.begun, place.x))

    def pruned(self, state: State) -> State:
        """The model without what later effects have made needless: every effect but the last is tried to be taken out."""
        for one in state.chosen[:-1]:
            rest = tuple(other for other in state.chosen if other is not one)
            look = self.study.look(self.renewed(state.look.place, one.labels), self.active(rest))
            without = self.refit(look, rest, f"without {one.name}", 0.97)
            verdict = self.judge(without, state, one, last=True)
            if verdict.refused:
                self.refuse(one, f"with what was found after it, {verdict.refused}")
                state = without
            else:
                self.found[one.name] = self.found[one.name]._replace(verdict=verdict)
        return state

    def refuse(self, one: Candidate, why: str) -> None:
        """Keep why a candidate is not in the model; "": nothing to keep."""
        if why:
            self.rejected[one.name] = Rejected(one.effect, one.dof, why)

    def attempt(self, state: State, scored: Scored, number: int, fraction: float) -> Tried:
        """A candidate refitted, everything else free: its shape too, once it is off its null."""
        one = scored.candidate
        chosen = (*state.chosen, one)
        name = f"round {number}: {one.name}"
        reached = self.fit(scored.look, chosen, ITERATIONS, 0, name, fraction)
        if one.shapes:
            look = self.study.look(reached.look.place, self.active(chosen))
            reached = self.fit(look, chosen, ITERATIONS, 0, name, fraction)
        after = self.state(chosen, reached)
        if one.begin:
            place = self.shaped(self.renewed(state.look.place, self.posed.base), one.begin)
            other = self.refit(self.study.look(place, self.active(chosen)), chosen, f"{name}, as computed", fraction)
            after = self.likeliest(after, other)
        verdict = self.judge(state, after, one)
        gains = state.likelihood - after.likelihood
        fitted, held = float(gains[self.study.used].sum()), float(gains[~self.study.used].sum())
        for i, score in enumerate(self.scores):
            if score.round == number and (score.effect, score.degree_of_freedom) == (one.effect, one.dof):
                held_out = verdict.held if verdict.unseen else None
                self.scores[i] = replace(score, refitted=fitted, refitted_holdout=held_out, verdict=verdict)
        worth = fitted + max(held, -1e3) - len(one.labels) * math.log(self.count)
        return Tried(one, scored.predicted.fitted, after, verdict, worth)


def diagnose(
    model: Model,
    campaign: Campaign,
    *,
    candidates: Sequence[Candidate] = (),
    progress: Callable[[Progress], None] | None = None,
    options: Options | None = None,
    kept: Path | None = None,
) -> Diagnosis:
    """What a model of a campaign (that declared: `campaign.model`) lacks: found, added, judged by the tests marked `holdout`.

    `candidates` of one's own take part beside the catalogue's. `kept` is a file that has what was reached by round; where it is
    there, of the same campaign, the search goes on from it. Raises InputError where a campaign has nothing to diagnose,
    and KeyboardInterrupt where it is stopped, what was found until then as its `partial`.
    """
    begun, campaign = clock.monotonic(), campaign.with_model(model)

    def say(stage: str, fraction: float) -> None:
        if progress is not None:
            progress(Progress(stage, 0, math.nan, fraction, "-2 ln L"))

    states: list[State] = []

    def reach(state: State) -> None:
        states.append(state)
        if kept is not None:
            keep(kept, search, states)

    say("reading the records", 0.0)

    def begun_with(campaign: Campaign) -> tuple[Search, tuple[str, ...]]:
        how, notes = options_for(campaign) if options is None else (options, ())
        search = Search(campaign, pose(campaign, how, candidates), say)
        states.extend([] if kept is None else resumed(kept, search))
        return search, notes

    search, notes = begun_with(campaign)
    wrong = {} if states else reversed_channels(campaign, search)
    if wrong:
        search, notes = begun_with(campaign := turned(campaign, list(wrong)))
        notes = (in_words(list(wrong)), *notes)
    if states:
        say(f"going on from what was reached before: round {len(states)}", 0.15)
    else:
        reach(search.declared())

    def concluded() -> Diagnosis:
        lost = [] if search.alone is None else given_up(search.study, search.alone, states[-1].left)
        unknown = [] if campaign.manifest.zero is not None else [ABSOLUTE]
        every, seconds = (*notes, *search.notes, *lost, *unknown), clock.monotonic() - begun
        return conclude(campaign, search, states[0], states[-1], every, seconds, tuple(wrong.values()))

    try:
        for again in range(2 * ROUNDS):
            states[-1], after = search.grow(fitted := states[-1], len(states))
            if after is not None:
                reach(after)
            if len(states) > ROUNDS or (after is None and (states[-1] is fitted or again >= ROUNDS)):
                break
        states.append(search.pruned(states[-1]))
    except KeyboardInterrupt as stopped:
        stopped.partial = concluded()  # type: ignore[attr-defined]
        raise
    return concluded()
