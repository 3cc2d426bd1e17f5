"""Whether an effect is believed: what it gains in the fitted tests, and in what was not fitted."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.eliminated_least_squares import minus_two_log_likelihood, predict_gain
from calibration.discovery.linearisations import RELATIVE_FLOOR, Linearisation, Prior
from calibration.discovery.study import Study
from calibration.formatting import percent
from calibration.identifiability.information import inverse

# thresholds, set by what they do on campaigns with nothing missing
MIN_BIC_GAIN = 6.0  # strong, by Kass and Raftery 1995
MIN_LIKELIHOOD_GAIN = 30.0  # with what -2 ln L of what was not fitted falls by; BIC alone where there is nothing of that kind
MIN_HELD_OUT_SHARE = 0.15  # share of the held-out error above the floor, squared
MIN_HELD_OUT_GAIN = 10.0  # by which -2 ln L of what was not fitted falls: very strong, by Kass and Raftery 1995
MIN_SIGNIFICANCE = 3.0  # standard deviations
MIN_MOTION_SHARE = 0.015  # of a motion: what takes less away from its error ...
MIN_FLOOR_MULTIPLE = 3.0  # ... and less than that many times the floor, is no business of engineers, nor sure of its name
NEGLIGIBLE = (
    f"no error falls by {100 * MIN_MOTION_SHARE:.1f} % of the motion, nor by {MIN_FLOOR_MULTIPLE:.0f} times what can be seen"
)
FITTED, HELD_OUT, BLOCKS = "fitted tests", "held-out tests", "blocks left out in turn"
MAX_DECAY_RESIDUAL, MAX_RESIDUAL_RATIO = (
    0.1,
    3.0,
)  # of a decay's motion, and of what is left alone: what a joint fit may leave of it


class ResidualSummary(NamedTuple):
    """What is above the floor, by series and region (s, 3; see `Study.by_region`): sums over degrees of freedom of squares over
    the floor's, and root mean squares (m, rad); -2 ln L by series (s,)."""

    squares: np.ndarray
    parts: np.ndarray
    likelihood: np.ndarray

    @classmethod
    def of(cls, study: Study, residual: np.ndarray) -> "ResidualSummary":
        """From rows of a residual."""
        above = study.dof * np.maximum(study.mean_squares(residual) - 1, 0.0)
        samples = np.array([one.samples for one in study.series])
        squares = study.by_region(study.pooled * np.maximum(study.levels(residual) - 1, 0.0))
        parts = np.sqrt(study.by_region(above * study.floor**2) / samples[:, None])
        return cls(squares, parts, minus_two_log_likelihood(study, residual))

    @property
    def error(self) -> np.ndarray:
        """Root mean squares by series (s,; m, rad)."""
        return np.sqrt((self.parts**2).sum(axis=1))


@dataclass(frozen=True)
class FitState:
    """Effects in the model and the fit with them: its look, the residual of all tests, and by series (s,) -2 ln L and what is
    left."""

    chosen: tuple[Candidate, ...]
    look: Linearisation
    residual: np.ndarray
    settled: bool
    iterations: int
    likelihood: np.ndarray
    left: ResidualSummary


class HeldOutComparison(NamedTuple):
    """What an effect is judged by: what is left of the `asked` series (s,) of a study without it and with it; whether the fits
    had not seen them."""

    study: Study
    compared: np.ndarray
    before: ResidualSummary
    after: ResidualSummary
    unseen: bool

    def error_reduction(self) -> tuple[float, bool]:
        """Share of the squared error above the floor that is gone in the motion and region where it is most (a geometric mean
        over tests), and whether there is anything to tell. An effect acts in a motion and in some frequencies: what goes on as
        before elsewhere does not speak against it, and what becomes worse is in `net`."""
        dof = self.study.by_region(self.study.pooled)
        before, after = self.before.squares, self.after.squares
        some = self.compared[:, None] & (np.maximum(before, after) > 0.2 * dof) & (dof > 0)
        if not some.any():
            return 0.0, self.unseen
        ratio = np.log(np.where(some, after + 0.1 * dof, 1.0) / np.where(some, before + 0.1 * dof, 1.0))
        weight = np.array([one.weight for one in self.study.series])
        found = []
        for channel in dict.fromkeys(one.channel for one in self.study.series):
            mine = some & np.array([[one.channel == channel] for one in self.study.series])
            found += [float(weight[m] @ r[m] / weight[m].sum()) for m, r in zip(mine.T, ratio.T) if m.any()]
        return 1 - math.exp(min(found)), True

    @property
    def likelihood_gain(self) -> float:
        """By how much -2 ln L of all that is asked falls."""
        return float((self.before.likelihood - self.after.likelihood)[self.compared].sum())

    def relevance(self) -> float:
        """By how much the error of a motion in a region falls at most, over what matters. Of what a decay is not about, the
        floor alone is a measure."""
        study = self.study
        samples = np.array([[one.samples] for one in study.series])
        squares = study.by_region(study.dof * study.floor**2) / samples
        noise = study.by_region(study.dof) * np.array([[one.noise**2] for one in study.series]) / samples
        of_floor = np.array([[RELATIVE_FLOOR[one.kind]] for one in study.series])
        decay = np.array([[one.kind == "decay"] for one in study.series])
        spread, seen = np.array([[(one.spread, one.floor_rms)] for one in study.series]).transpose(2, 0, 1)
        motion = np.where(decay, spread, np.sqrt(np.maximum(squares - noise, 0.0)) / of_floor)
        asked = np.where(study.main[:, None], MIN_MOTION_SHARE * motion, math.inf)
        least = np.minimum(asked, MIN_FLOOR_MULTIPLE * np.where(decay, seen, np.sqrt(squares)))
        fallen = (self.before.parts - self.after.parts)[self.compared]
        return float((fallen / np.maximum(least[self.compared], 1e-300)).max(initial=0.0))


class Verdict(NamedTuple):
    """What a refit says of an effect: BIC, share of the squared error that goes, whether that is of what was not fitted, by how
    much -2 ln L of all that falls, how clear the effect is, how much it matters, and why it is refused ("" where it is not)."""

    bic: float
    held: float
    unseen: bool
    net: float
    clear: float
    matters: float
    refused: str

    @property
    def worth(self) -> float:
        """What it gains in fitted and held-out tests together."""
        return self.bic + self.net


def assess_effect(
    study: Study, before: FitState, after: FitState, one: Candidate, prior: Prior, count: float, grounds: HeldOutComparison
) -> Verdict:
    """Whether an effect is believed; `count` are independent observations, for BIC."""
    bic = float((before.likelihood - after.likelihood)[study.used].sum()) - len(one.labels) * math.log(count)
    held, told = grounds.error_reduction()
    net, clear, matters = grounds.likelihood_gain, significance(study, one, after, prior), grounds.relevance()
    values = {label: study.value(label, after.look.place.x) for label in one.positive}
    wrong = [label for label, value in values.items() if value < 0 and is_significant(study, label, one, after, prior)]
    refused = f"{wrong[0]} comes out as {values[wrong[0]]:.3g}, which physics does not allow" if wrong else ""
    where = FITTED if not grounds.unseen else HELD_OUT if grounds.study is study else BLOCKS
    refused = refused or reason_to_reject(bic, held if told else None, net, clear, matters, where)
    if refused in ("", NEGLIGIBLE):  # which is said where nothing else speaks against it
        refused = worsened_motion(study, one.dof, before.left, after.left) or refused
    return Verdict(bic, held, grounds.unseen, net, clear, matters, refused)


def reason_to_reject(bic: float, held: float | None, net: float, clear: float, matters: float, where: str) -> str:
    """Why numbers are not enough to believe an effect, `held` and `net` of what is `where` (None: nothing to tell); else ""."""
    apart = held is not None and where == HELD_OUT
    if bic < (least := MIN_BIC_GAIN if apart else MIN_LIKELIHOOD_GAIN):
        asked = f"{least:.0f} are asked" if apart else f"{least:.0f} are asked where nothing held out can tell"
        return f"it gains too little in the fitted tests (BIC {bic:+.0f}, {asked})"
    if held is not None and held < MIN_HELD_OUT_SHARE:
        change = f"falls by {100 * held:.0f} % only" if held >= 0 else f"grows by {-100 * held:.0f} %"
        return f"the squared error of the {where} {change}"
    if held is not None and net < MIN_HELD_OUT_GAIN:
        return f"all in all the {where} do not gain by it (-2 ln L {-net:+.0f})"
    if apart and bic + net < MIN_LIKELIHOOD_GAIN:
        return f"it gains too little in fitted and held-out tests together (BIC {bic:+.0f}, -2 ln L {-net:+.0f})"
    if clear < MIN_SIGNIFICANCE:
        return f"its parameters are no more than {clear:.1f} standard deviations from none"
    if matters < 1:
        return NEGLIGIBLE
    return ""


def worsened_motion(study: Study, dof: str | None, before: ResidualSummary, after: ResidualSummary) -> str:
    """Why an effect is refused for J of the motion that it acts in (None: of all), in all tests or the held-out ones; "" where
    it is not. Likelihoods weigh little what is slow, as unknown forces could do it (`Study.expected`); engineers ask for it."""
    mine = study.main & np.array([one.channel == (dof or one.channel) and one.spread > 0 for one in study.series])
    spread = np.array([one.spread if one.spread > 0 else 1.0 for one in study.series])
    for some, where in ((mine, "all tests"), (mine & ~study.used, f"the {HELD_OUT}")):
        was, now = (float((left.error / spread)[some].sum()) for left in (before, after))
        if now > was + MIN_MOTION_SHARE:
            what, its = ("what moves is", "J") if dof is None else (f"{dof} is", "J of it")
            return f"{what} followed worse with it ({its} in {where}: {was:.3f} without it, {now:.3f} with it)"
    return ""


def abandoned_decays(study: Study, alone: ResidualSummary, now: ResidualSummary) -> list[str]:
    """In words, the decays that a fit to them `alone` follows and one to seas, too, does not."""
    said = []
    for i, one in enumerate(study.series):
        if one.kind == "decay" and study.used[i] and study.main[i] and one.spread > 0:
            before, after = float(alone.error[i]) / one.spread, float(now.error[i]) / one.spread
            if after > max(MAX_DECAY_RESIDUAL, MAX_RESIDUAL_RATIO * before):
                said.append(
                    f"fitted together with the seas, the decay {one.test} is given up: {percent(after)} of its motion is left, "
                    f"{percent(before)} where decays are fitted alone. The model cannot follow both, and what is said of "
                    f"{one.channel} is in doubt"
                )
    return said


def is_significant(study: Study, label: str, one: Candidate, state: FitState, prior: Prior) -> bool:
    """Whether a parameter is what it is beyond doubt: the only one of an effect always, of several by two deviations."""
    i = study.names.index(label)
    variance = predict_gain(study, state.look, prior).covariance[state.look.active.index(i), state.look.active.index(i)]
    return len(one.amplitudes) == 1 or abs(float(study.steps(state.look.place.x)[i])) > 2 * math.sqrt(variance)


def significance(study: Study, one: Candidate, state: FitState, prior: Prior) -> float:
    """The effect's parameters over their standard deviations: of several together, as one normal variable would be."""
    look = state.look
    columns = [look.active.index(i) for i in study.index(one.amplitudes)]
    covariance = predict_gain(study, look, prior).covariance[np.ix_(columns, columns)]
    steps = study.steps(look.place.x)[study.index(one.amplitudes)]
    wald = float(steps @ inverse(covariance) @ steps)
    return math.sqrt(max(wald - len(columns) + 1, 0.0))
