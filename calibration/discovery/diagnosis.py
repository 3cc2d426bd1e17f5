"""Result of a diagnosis: outcome, rejected effects, scores, residuals and predictions."""

from collections.abc import Collection
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from calibration.discovery.acceptance import Verdict
from calibration.discovery.refusal import Refusal
from calibration.discovery.reported_effects import Effect
from calibration.discovery.reported_forces import LatentForce
from calibration.residuals.wave_options import Options
from calibration.result import Calibration

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes


class Outcome(StrEnum):
    """Outcome of a diagnosis.

    Attributes:
        FOUND: The baseline lacks effects, which are named.
        NOTHING_MISSING: The records show nothing that the baseline lacks.
        UNEXPLAINED: The baseline lacks something that no effect explains; effects, if any, are all in doubt.
    """

    FOUND = "found"
    NOTHING_MISSING = "nothing_missing"
    UNEXPLAINED = "unexplained"


class DetectionLimit(NamedTuple):
    """Size from which an effect that is not named would have been. See `calibration.discovery.selection.detection_limits`.

    Sizes are distances from the neutral value (SI).

    Attributes:
        label: Label of the amplitude.
        smallest: The limit at the shape of the effect that the records tell best; infinite where no size would be named.
        largest: The limit at the shape that they tell least.
        plausible: Largest plausible size.
        told: Fraction of what the effect does to the records that nothing else in the model can follow (0 to 1), at `smallest`.
        unit: Unit of the sizes.
    """

    label: str
    smallest: float
    largest: float
    plausible: float
    told: float
    unit: str


@dataclass(frozen=True, eq=False)
class Rejected:
    """An effect that was tried and is not in the model.

    Attributes:
        effect: Its name in the catalogue.
        degree_of_freedom: The motion it acts in, or None.
        reason: Why it was rejected.
        taken_out: The verdict that removed it from the model, where it was in it.
        limits: Detection limits of its amplitudes; none where they were not computed.
    """

    effect: str
    degree_of_freedom: str | None
    reason: Refusal
    taken_out: Verdict | None = None
    limits: tuple[DetectionLimit, ...] = ()


@dataclass(frozen=True, eq=False)
class Score:
    """Score of a candidate in one round.

    Attributes:
        round: Number of the round.
        effect: Its name in the catalogue.
        degree_of_freedom: The motion it acts in, or None.
        gain: First-order decrease of -2 ln L of the fitted tests.
        size: Number of amplitudes.
        holdout: Decrease of -2 ln L of the held-out tests by the same step.
        refitted: Decrease of -2 ln L after a refit; None: not refitted.
        refitted_holdout: Fraction of the held-out squared error removed by the refit, or None.
        verdict: Outcome of the acceptance tests, or None.
    """

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
class MotionResidual:
    """Residual of one motion of one test.

    Attributes:
        test: Name of the test.
        use: Use of the test (fit, holdout).
        channel: The motion.
        rms: Root mean square of the residual (m, rad).
        noise: Sensor noise (m, rad).
        relative: Residual over the motion's standard deviation.
        bands: Frequency bands: lower and upper edge (Hz), rms over noise.
        words: The residual in words.
    """

    test: str
    use: str
    channel: str
    rms: float
    noise: float
    relative: float
    bands: tuple[tuple[float, float, float], ...]
    words: str


@dataclass(frozen=True, eq=False)
class Prediction:
    """Predicted motion of a held-out test, with a band that 95 % of the samples are expected in.

    Attributes:
        test: Name of the test.
        channel: The motion.
        half_width: Half the width of the band at every sample (m, rad; t,).
        inside: Fraction of the samples that lie in the band.
        parameter_error: Standard deviation of the motion due to that of the parameters, root mean square (m, rad).
        model_error: Standard deviation of noise and of what the model leaves, from the fitted tests (m, rad).
    """

    test: str
    channel: str
    half_width: np.ndarray
    inside: float
    parameter_error: float
    model_error: float


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """Result of a diagnosis: the baseline, the effects that it lacks, and the model with them.

    Attributes:
        campaign: Name of the campaign.
        verdict: Outcome of the diagnosis.
        baseline: Fit of the baseline.
        augmented: Fit of the model with the effects found.
        effects: The effects found.
        rejected: Effects that were tried and rejected.
        scores: Scores of all candidates in all rounds.
        anatomy_before: Residuals of the baseline, by motion and test.
        anatomy_after: Residuals of the augmented model, by motion and test.
        unexplained_share: Fraction of the error's energy above the noise floor that is left.
        signature: Description of the remaining residual, in words.
        next_test: The test to do next, in words.
        notes: Notes and doubts, in words.
        seconds: Computing time (s).
        latent: Missing forces by motion, where something is unexplained.
        seas: How waves are reconstructed and act.
        complete: False where the search was stopped before its end.
        predictions: Predicted motions of the held-out tests.
    """

    campaign: str
    verdict: Outcome
    baseline: Calibration
    augmented: Calibration
    effects: tuple[Effect, ...]
    rejected: tuple[Rejected, ...]
    scores: tuple[Score, ...]
    anatomy_before: tuple[MotionResidual, ...]
    anatomy_after: tuple[MotionResidual, ...]
    unexplained_share: float
    signature: str
    next_test: str
    notes: tuple[str, ...]
    seconds: float
    latent: tuple[LatentForce, ...] = ()
    seas: Options | None = None
    complete: bool = True
    predictions: tuple[Prediction, ...] = ()

    def __repr__(self) -> str:
        """The verdict in a sentence, the effects with their sizes, and what is left."""
        from calibration.display.summaries import diagnosis_summary

        return diagnosis_summary(self)

    def _repr_html_(self) -> str:
        from calibration.display.data_frames import diagnosis_html

        return diagnosis_html(self)

    def to_xarray(self) -> "xr.Dataset":
        """Measured motions of all tests (m, deg), and simulated ones without and with the effects.

        The data are those of simulated.nc.

        Returns:
            Variables `measured`, `simulated` (with the effects), `before` (without) by test, channel and time; NaN where there
            is none. `half_width`, where tests were held out, is that of the band of 95 %.
        """
        from calibration.results.diagnosis_motions import motions, paired

        return motions(self, paired(self))

    def to_dataframe(self) -> "pd.DataFrame":
        """Effects found, a row for each of their parameters, in SI units.

        Returns:
            Columns `effect`, `motion`, `value`, `standard_deviation`, `unit`, `lower` and `upper` (plausible range),
            `probability`, `delta_bic`, `holdout_gain`, `explained` and `in_doubt`; index `parameter`.
        """
        from calibration.display.data_frames import effects_frame

        return effects_frame(self)

    def plot(self, tests: Collection[str] | None = None) -> "list[Axes]":
        """Plot measured motions, and simulated ones without and with the effects; held-out tests first.

        Args:
            tests: Names of the tests to show; None: all.

        Returns:
            Axes, one for each motion that counts in the objective; `axes[0].figure` is the figure.

        Raises:
            UnknownName: There is no such test.
            ValueError: There is no test to show.
        """
        from calibration.display.axes import diagnosis_axes

        return diagnosis_axes(self, tests)
