"""What a diagnosis returns, as values."""

from dataclasses import dataclass

import numpy as np

from calibration.campaign.strip_conventions import StripConventions
from calibration.discovery.acceptance import Verdict
from calibration.residuals.measured_seas import Options
from calibration.result import Calibration, Estimate

# what an effect is in doubt for beside others that explain more
SECOND_ORDER = "second_order"  # where the waves' own second order was left out
HELD_OUT_ERROR = "held_out_error"  # where all that was found makes the held-out error larger, or its motion's part of it


@dataclass(frozen=True, eq=False)
class Evidence:
    """Why an effect is believed: `score`, by how much -2 ln L of the fitted tests falls at first order when it is let in, what
    the fitted parameters can do instead projected out; `delta_bic` after the refit (above 0 speaks for it); `holdout_gain`, the
    share of the held-out tests' squared error that it takes away where it acts most (1: all of it); `clear`, the parameter over
    its standard deviation."""

    score: float
    delta_bic: float
    holdout_gain: float
    clear: float


@dataclass(frozen=True, eq=False)
class Effect:
    """An effect that was found: its name as in the contract, motion, parameters, evidence, the share of what was unexplained in
    the fitted tests that it explains, the effects that the records cannot tell from it, and the test that would; `in_doubt` is
    an effect that explains more beside it and is refused, so that this one may stand for what neither has; or
    `SECOND_ORDER` or `HELD_OUT_ERROR`."""

    effect: str
    degree_of_freedom: str | None
    meaning: str
    source: str
    parameters: dict[str, Estimate]
    evidence: Evidence
    share: float
    indistinguishable: tuple[str, ...]
    telling_test: str | None
    in_doubt: str | None = None


@dataclass(frozen=True, eq=False)
class Rejected:
    """An effect that was tried and is not in the model, and why; `taken_out`, the verdict that took it out of the model."""

    effect: str
    degree_of_freedom: str | None
    reason: str
    taken_out: Verdict | None = None


@dataclass(frozen=True, eq=False)
class Score:
    """A candidate at its null, in one round: `gain` of -2 ln L at first order, degrees of freedom it takes, and what the
    held-out tests would gain by the same step; `refitted` gains where it was tried (None: it was not), and by what it was
    judged then."""

    round: int
    effect: str
    degree_of_freedom: str | None
    gain: float
    size: int
    holdout: float
    refitted: float | None
    refitted_holdout: float | None
    verdict: Verdict | None = None


@dataclass(frozen=True, eq=False)
class Finding:
    """What is left of one motion of one test: `rms` (m, rad) of the residual, `noise` (m, rad), `relative` to the
    motion's standard deviation, and the bands: (low, high in Hz, rms over noise)."""

    test: str
    use: str
    channel: str
    rms: float
    noise: float
    relative: float
    bands: tuple[tuple[float, float, float], ...]
    words: str


@dataclass(frozen=True, eq=False)
class Followed:
    """How a latent force goes with something: `coherence`, the share of its mean square that follows it linearly; `phase` (rad)
    by which the force is ahead of it; `correlation` at the same instant."""

    coherence: float
    phase: float
    correlation: float


@dataclass(frozen=True, eq=False)
class LawTerm:
    """A term of a law, in x (m, rad), v (m/s, rad/s) and eta (m), its coefficient (SI), and its number in the library."""

    name: str
    coefficient: float
    unit: str
    kind: int


@dataclass(frozen=True, eq=False)
class Law:
    """A law of few terms for a latent force; none where it does not explain enough of what was not fitted. `share`, of the
    force's mean square in what `checked` names, `fitted` in the fitted tests; `v0` (m/s, rad/s) that of tanh(v/v0), `pace`
    (rad/s) the omega of lagged velocity."""

    terms: tuple[LawTerm, ...]
    share: float
    fitted: float
    checked: str
    v0: float = 1.0
    pace: float = 1.0


@dataclass(frozen=True, eq=False)
class Shown:
    """A stretch of a latent force (N, N m) at times of the record (s), its law (empty: none), and the velocity or wave `beside`
    it."""

    test: str
    time: np.ndarray
    force: np.ndarray
    law: np.ndarray
    beside: str
    values: np.ndarray


@dataclass(frozen=True, eq=False)
class LatentForce:
    """The force that the model lacks in one motion, by kind of test (decay, waves): rms (`unit`), shares of its mean square in
    the mean and in bands, how it goes with other things, and how it grows (`growth`, powers by what it grows with). `relative`
    is the residual over the motion's standard deviation in the test that is shown."""

    motion: str
    unit: str
    rms: dict[str, float]
    shares: dict[str, dict[str, float]]
    coherence: dict[str, dict[str, Followed]]
    growth: dict[str, float]
    law: Law
    words: str
    shown: Shown
    relative: float = 0.0


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """A campaign's model as declared and fitted (`baseline`), what it lacks, and the model with that (`augmented`).

    `verdict` is "found", "nothing_missing" or "unexplained", which may have effects: all in doubt. `anatomy_before` and
    `anatomy_after` are the residuals of both, motion by motion; `unexplained_share`, of the error's energy above the floor
    that is left at the end, `signature` what is known of it in words; `next_test` what to measure next. `latent`, where the
    verdict is "unexplained", are the forces that would make the model follow the records. `strips` is how strips are taken,
    where the platform file does not say so, and `seas` how waves are made and act: both are part of what was found. `complete`
    is False where the search was stopped before its end.
    """

    campaign: str
    verdict: str
    baseline: Calibration
    augmented: Calibration
    effects: tuple[Effect, ...]
    rejected: tuple[Rejected, ...]
    scores: tuple[Score, ...]
    anatomy_before: tuple[Finding, ...]
    anatomy_after: tuple[Finding, ...]
    unexplained_share: float
    signature: str
    next_test: str
    notes: tuple[str, ...]
    seconds: float
    latent: tuple[LatentForce, ...] = ()
    strips: StripConventions | None = None
    seas: Options | None = None
    complete: bool = True
