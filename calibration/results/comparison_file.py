"""Model of comparison.json: errors in waves by test, motion and band."""

from pydantic import Field

from calibration.results.calibration_file import TestErrors
from calibration.results.result_folder import Figure
from calibration.results.sea_options_section import SeaOptions
from calibration.results.strip_conventions import StripConventions
from jaxhydro.input_schema import Number
from jaxhydro.result_model import ResultModel


class Pair(ResultModel):
    """A quantity of the measured and of the simulated record."""

    measured: Number
    simulated: Number


class Moments(ResultModel):
    """Mean and standard deviation of a record."""

    mean: Number
    standard_deviation: Number


class ChannelStatistics(ResultModel):
    """Statistics of the wave or of a motion, in `unit` (m or deg).

    Attributes:
        unit: m or deg.
        moving: Whether it is the wave, or a motion that is large beside the others of its unit.
        measured: Statistics of the measured record.
        simulated: Statistics of the simulated record.
    """

    unit: str
    moving: bool = True
    measured: Moments
    simulated: Moments


class BandEnergies(Pair):
    """Integrals of the spectra (m² or deg²) over a band (Hz)."""

    band: tuple[Number, Number]


class SeaTestResults(ResultModel):
    """Results of a test in waves.

    Attributes:
        kind: Kind of the waves.
        file: Path of the data file.
        start: Start of the comparison on the file's time axis (s, full scale).
        end: End of the comparison (s).
        peak_period: Peak period, or period of regular waves (s).
        stated_height: Stated significant height, or height of regular waves (m).
        heading: Direction that the waves run to (deg).
        statistics: Statistics by channel, the wave first.
        significant_wave_height: Significant wave height (m); None for regular waves.
        wave_height: Height of regular waves (m); None for irregular waves.
        bands: Energies in bands of irregular waves, by channel and band.
        amplitude: Amplitudes at the period of regular waves, by channel.
    """

    kind: str
    file: str
    start: Number
    end: Number
    peak_period: Number
    stated_height: Number | None = None
    heading: Number
    statistics: dict[str, ChannelStatistics]
    significant_wave_height: Pair | None = None
    wave_height: Pair | None = None
    bands: dict[str, dict[str, BandEnergies]] = Field(default_factory=dict)
    amplitude: dict[str, Pair] = Field(default_factory=dict)


class SimulatedSea(ResultModel):
    """Sea of one data file.

    Attributes:
        file: Path of the data file.
        tests: Tests that are windows of it.
        duration: Duration (s).
        components: Number of first-order components.
        gauge: Position of the wave gauge (m).
        heading: Direction that the waves run to (deg).
        mismatch: RMS of the simulated less the measured elevation, over that of the measured elevation.
        rounds: Number of iterations that separated the second order.
        variance_in_band: Fraction of the variance of the measured elevation within the first-order band.
    """

    file: str
    tests: list[str]
    duration: Number
    components: int
    gauge: tuple[Number, ...]
    heading: Number
    mismatch: Number
    rounds: int
    variance_in_band: Number


class SimulatedOptions(SeaOptions):
    """Options of the waves, time step (s), and how spectra are estimated."""

    step: Number
    spectra: str


class UsedCoefficients(ResultModel):
    """Coefficients of the simulation.

    Attributes:
        source: Where they come from.
        values: Calibrated values, by label.
        not_identifiable: Labels that the calibration's records did not determine.
        left_out: Labels of calibrated values that are not used.
        strips: Conventions of strip loads, where they are the calibration's.
    """

    source: str
    values: dict[str, Number]
    not_identifiable: list[str]
    left_out: list[str]
    strips: StripConventions | None = None


class ComparisonFile(ResultModel):
    """Content of comparison.json.

    Attributes:
        campaign: Name of the campaign.
        platform: Name of the platform.
        calibration: File of the calibration that was used.
        jaxhydro: Version of jaxhydro.
        options: Options of the simulation.
        coefficients: Coefficients of the simulation.
        seas: Seas, one of each data file.
        error: Errors by test, as in calibration.json.
        tests: Results by test.
        warnings: Warnings, as sentences.
        figures: Figures.
    """

    campaign: str
    platform: str
    calibration: str | None = None
    jaxhydro: str
    options: SimulatedOptions
    coefficients: UsedCoefficients
    seas: list[SimulatedSea]
    error: dict[str, TestErrors]
    tests: dict[str, SeaTestResults]
    warnings: list[str] = Field(default_factory=list)
    figures: list[Figure] = Field(default_factory=list)
