"""Model of sweep.json: lifetime statistics and failed runs of a sweep."""

from pydantic import Field

from jaxhydro.input_schema import Number
from jaxhydro.result_model import ReferenceSeaState, ResultModel


class RunCounts(ResultModel):
    """Number of all runs, of finished runs and of failed runs."""

    total: int
    done: int
    failed: int


class LifetimeStatistics(ResultModel):
    """Lifetime statistics of a channel, in its unit. See `jaxhydro.sweep.lifetime.Lifetime`."""

    unit: str
    mean: Number | None = None
    standard_deviation: Number | None = None
    standard_deviation_spread: Number | None = None
    maximum: Number | None = None
    maximum_of_seed: Number | None = None
    maximum_spread: Number | None = None
    minimum: Number | None = None
    minimum_of_seed: Number | None = None
    minimum_spread: Number | None = None
    damage_equivalent_range: dict[str, Number | None] = Field(default_factory=dict)


class Failure(ResultModel):
    """Runs of one sea state that failed for one reason.

    Attributes:
        hs: Significant wave height (m).
        tp: Peak period (s).
        gamma: Peak enhancement (-), or None.
        spreading: As in `State`, and so are the fields of the swell.
        swell_hs: Significant wave height of the swell (m).
        swell_tp: Peak period of the swell (s).
        swell_gamma: Peak enhancement of the swell (-).
        swell_heading: Direction that the swell travels to (deg).
        swell_spreading: Exponent s of the swell (-).
        headings: Headings (deg) of these runs.
        seeds: Seeds of these runs.
        runs: Number of runs.
        reason: Why they failed.
    """

    hs: Number
    tp: Number
    gamma: Number | None = None
    spreading: Number | None = None
    swell_hs: Number | None = None
    swell_tp: Number | None = None
    swell_gamma: Number | None = None
    swell_heading: Number | None = None
    swell_spreading: Number | None = None
    headings: list[Number]
    seeds: list[int]
    runs: int
    reason: str


class Heading(ResultModel):
    """Direction that waves run to (deg), and its probability."""

    heading: Number
    probability: Number


class SweepOptions(ResultModel):
    """Options that all runs share (s, Hz)."""

    duration: Number
    start: Number
    time_step: Number
    step: Number
    spectrum: str
    amplitudes: str
    low: Number
    cutoff: Number
    order: int
    stretching: str
    diffraction: str
    equivalent_frequency: Number


class UsedCalibration(ResultModel):
    """File of a calibration, the values used of it, and its conventions of strip loads where they differ."""

    file: str
    values: dict[str, Number]
    sea_state_reference: ReferenceSeaState | None = None
    strips: dict[str, str | bool] | None = None


class SweepResults(ResultModel):
    """Content of sweep.json.

    Attributes:
        sweep: The sweep file.
        platform: Name of the platform.
        calibration: The calibration that was used.
        notes: Notes, as sentences.
        source: Program and version.
        fingerprint: Hash of the inputs.
        runs: Number of runs.
        sea_states: Number of sea states.
        cases: Number of sea states with a heading.
        headings: Headings.
        seeds: Seeds.
        options: Options that all runs share.
        probability_without_runs: Probability of the cases without a run that is done.
        lifetime: Lifetime statistics, by channel.
        failures: Failed runs, by sea state and reason.
    """

    sweep: str
    platform: str
    calibration: UsedCalibration | None = None
    notes: list[str] = Field(default_factory=list)
    source: str
    fingerprint: str = ""
    runs: RunCounts
    sea_states: int
    cases: int
    headings: list[Heading]
    seeds: list[int]
    options: SweepOptions
    probability_without_runs: Number = 0.0
    lifetime: dict[str, LifetimeStatistics]
    failures: list[Failure] = Field(default_factory=list)
