"""Whether an effect is believed: what it gains in the fitted tests, and in what was not fitted."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from calibration.discovery.catalogue import Candidate
from calibration.discovery.linear import predict
from calibration.discovery.study import Look, Prior, Study
from calibration.formatting import percent

# thresholds, set by what they do on campaigns with nothing missing
LEAST_BIC = 30.0
LEAST_GAIN = 0.15  # share of the held-out error above the floor, squared
LEAST_CLEAR = 3.0  # standard deviations
LEAST_MATTER = 0.015  # of a motion: what takes less away from its error ...
LEAST_SEEN = 3.0  # ... and less than that many times the floor, is no business of engineers, nor sure of its name
LOST, TIMES = 0.1, 3.0  # of a decay's motion, and of what is left alone: what a joint fit may leave of it


class Left(NamedTuple):
    """What is above the floor: sums over degrees of freedom of squares over the floor's by what is told apart (s, b; see
    `Study.told`), and root mean squares by series (s,; m, rad)."""

    squares: np.ndarray
    error: np.ndarray

    @classmethod
    def of(cls, study: Study, residual: np.ndarray) -> "Left":
        """From rows of a residual."""
        above = study.dof * np.maximum(study.mean_squares(residual) - 1, 0.0)
        samples = np.array([one.samples for one in study.series])
        squares = study.in_cells(study.pooled * np.maximum(study.levels(residual) - 1, 0.0))
        return cls(squares, np.sqrt((above * study.floor**2).sum(axis=1) / samples))


@dataclass(frozen=True)
class State:
    """Effects in the model and the fit with them: its look, the residual of all tests, and by series (s,) -2 ln L and what is
    left."""

    chosen: tuple[Candidate, ...]
    look: Look
    residual: np.ndarray
    settled: bool
    iterations: int
    likelihood: np.ndarray
    left: Left


class Grounds(NamedTuple):
    """What an effect is judged by: what is left of the `asked` series (s,) of a study without it and with it; whether the fits
    had not seen them."""

    study: Study
    asked: np.ndarray
    before: Left
    after: Left
    unseen: bool

    def gain(self) -> tuple[float, bool]:
        """Mean share (geometric) of the squared error above the floor that is gone, over the motions that have any, and in
        waves over frequencies: a resonance that goes on as before does not hide what is mended elsewhere. And whether there is
        anything to tell."""
        dof = self.study.told
        before, after = self.before.squares, self.after.squares
        some = self.asked[:, None] & (np.maximum(before, after) > 0.2 * dof) & (dof > 0)
        if not some.any():
            return 0.0, self.unseen
        ratio = np.log((after[some] + 0.1 * dof[some]) / (before[some] + 0.1 * dof[some]))
        share = dof / np.maximum((dof * some).sum(axis=1, keepdims=True), 1e-300)
        weight = (np.array([[one.weight] for one in self.study.series]) * share)[some]
        return float(1 - math.exp(float((weight * ratio).sum() / weight.sum()))), True

    def matters(self) -> float:
        """By how much a motion's error falls at most, over what matters. Of what a decay is not about the floor alone is a
        measure."""
        share = np.where(self.study.main, LEAST_MATTER, math.inf)
        least = np.array([min(m * one.spread, LEAST_SEEN * one.least) for m, one in zip(share, self.study.series)])
        return float(((self.before.error - self.after.error) / least)[self.asked].max(initial=0.0))


class Verdict(NamedTuple):
    """What a refit says of an effect: BIC, share of the squared error that goes, whether that is of what was not fitted, how
    clear it is, and why it is refused ("" where it is not)."""

    bic: float
    held: float
    unseen: bool
    clear: float
    refused: str


def judge(study: Study, before: State, after: State, one: Candidate, prior: Prior, count: float, grounds: Grounds) -> Verdict:
    """Whether an effect is believed; `count` are independent observations, for BIC."""
    bic = float((before.likelihood - after.likelihood)[study.used].sum()) - len(one.labels) * math.log(count)
    held, told = grounds.gain()
    clear = clearness(study, one, after, prior)
    values = {label: study.value(label, after.look.place.x) for label in one.positive if len(one.amplitudes) == 1}
    wrong = [label for label, value in values.items() if value < 0]
    refused = ""
    if wrong:
        refused = f"{wrong[0]} comes out as {values[wrong[0]]:.3g}, which physics does not allow"
    elif bic < LEAST_BIC:
        refused = f"it gains too little in the fitted tests (BIC {bic:+.0f})"
    elif told and held < LEAST_GAIN:
        where = "fitted tests"
        if grounds.unseen:
            where = "held-out tests" if grounds.study is study else "blocks left out in turn"
        refused = f"the squared error of the {where} changes by {-100 * held:+.0f} % only"
    elif clear < LEAST_CLEAR:
        refused = f"its parameters are no more than {clear:.1f} standard deviations from none"
    elif grounds.matters() < 1:
        refused = f"no error falls by {100 * LEAST_MATTER:.1f} % of the motion, nor by {LEAST_SEEN:.0f} times what can be seen"
    return Verdict(bic, held, grounds.unseen, clear, refused)


def given_up(study: Study, alone: Left, now: Left) -> list[str]:
    """In words, the decays that a fit to them `alone` follows and one to seas, too, does not."""
    said = []
    for i, one in enumerate(study.series):
        if one.kind == "decay" and study.used[i] and study.main[i] and one.spread > 0:
            before, after = float(alone.error[i]) / one.spread, float(now.error[i]) / one.spread
            if after > max(LOST, TIMES * before):
                said.append(
                    f"fitted together with the seas, the decay {one.test} is given up: {percent(after)} of its motion is left, "
                    f"{percent(before)} where decays are fitted alone. The model cannot follow both, and what is said of "
                    f"{one.channel} is in doubt"
                )
    return said


def clearness(study: Study, one: Candidate, state: State, prior: Prior) -> float:
    """The effect's parameters over their standard deviations: of several together, as one normal variable would be."""
    look = state.look
    columns = [look.active.index(i) for i in study.index(one.amplitudes)]
    covariance = predict(study, look, prior).covariance[np.ix_(columns, columns)]
    steps = study.steps(look.place.x)[study.index(one.amplitudes)]
    wald = float(steps @ np.linalg.pinv(covariance, hermitian=True) @ steps)
    return math.sqrt(max(wald - len(columns) + 1, 0.0))
