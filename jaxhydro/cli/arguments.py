"""Arguments and options of the commands."""

from pathlib import Path
from typing import Annotated, Any

import typer

from jaxhydro.cli.option_choices import Amplitudes, Diffraction, Fitted, Law, Loss, MotionFormat, Objective, Spectrum, Stretch
from jaxhydro.cli.sea_options import MAX_ORDER, ORDER, SEED, TIME_COLUMN, WAVE_COLUMN
from jaxhydro.dynamics.requested_sea import TRANSIENT
from jaxhydro.waves.wave_bands import CUTOFF, LOW

SEVERAL = "Irregular waves of several headings"
SEA, RECORD, HOW = "Irregular waves from a spectrum", "Irregular waves from a record", "How waves act"
OTHER = "Regular waves and free decays"


MULTISTART = "multistart"


def _search_method(value: str) -> str:
    """Check a global search by its name."""
    if value == MULTISTART:
        return value
    baselines = "; population searches (ga, de, cma-es) are baselines: python -m benchmarks.validate --only global_search"
    raise typer.BadParameter(f"{MULTISTART} expected, found {value!r}{baselines if value in ('ga', 'de', 'cma-es') else ''}")


def _option(name: str, panel: str, text: str, default: str | bool = False, **more: Any) -> Any:
    return typer.Option(name, help=text, rich_help_panel=panel, show_default=default, **more)


OUT = "Folder for the results; made where absent."
Out = Annotated[Path | None, typer.Option("--out", help=OUT, show_default="a new one, named after the input and the command")]
Campaign = Annotated[
    Path, typer.Argument(help="A campaign's folder, its campaign.yaml, or volturnus-s-decays, which is embedded.")
]
Figures = Annotated[bool, typer.Option(help="Draw figures.")]
Hs = Annotated[float | None, _option("--hs", SEA, "Significant wave height, m: 4 times the root of the spectrum's area.")]
Tp = Annotated[float | None, _option("--tp", SEA, "Peak period, s.")]
Gamma = Annotated[
    float | None, _option("--gamma", SEA, "Peak enhancement of JONSWAP, 1 to 7.", "IEC 61400-3-1, by Tp / sqrt(Hs)")
]
Kind = Annotated[Spectrum | None, _option("--spectrum", SEA, "white: even from --low to --cutoff, without --tp.", "jonswap")]
Seed = Annotated[int | None, _option("--seed", SEA, "Of the random phases: one seed, one sea.", str(SEED), min=0)]
Height = Annotated[
    Amplitudes | None,
    _option("--amplitudes", SEA, "Of components: as the spectrum says, or random about it, as in nature.", "deterministic"),
]
Sea = Annotated[
    list[str] | None,
    _option(
        "--sea",
        SEVERAL,
        "A wave system, in place of --hs, --tp and --heading; once each for wind sea and swell. Keys: hs, tp, gamma, heading, "
        "spreading, spectrum.",
        metavar="'hs=2 tp=14 heading=30'",
    ),
]
Spreading = Annotated[
    float | None,
    _option("--spreading", SEVERAL, "Short-crested: exponent s of cos^2s of half the angle, with --hs.", "long-crested"),
]
SeaFile = Annotated[
    Path | None,
    _option(
        "--sea-file",
        SEVERAL,
        "Spectrum: CSV or NetCDF with efth (m2/Hz/deg) over freq (Hz) and dir (deg, from), or NDBC's text, SWAN, WW3.",
    ),
]
SeaTime = Annotated[
    str | None, _option("--sea-time", SEVERAL, "Time (UTC) of --sea-file's spectrum, as 2019-02-06T00:40.", "its only one")
]
Bearing = Annotated[
    float | None, _option("--x-bearing", SEVERAL, "Compass bearing of the platform's x axis, deg, with --sea-file.", "0")
]
Wave = Annotated[
    Path | None, _option("--wave", RECORD, "File with a measured elevation: evenly sampled, s and m at full scale.")
]
WaveColumn = Annotated[str | None, _option("--wave-column", RECORD, "Its column: a header, or a number from 0.", WAVE_COLUMN)]
WaveUnit = Annotated[str | None, _option("--wave-unit", RECORD, "Its unit: m, cm, mm, ft.", "m")]
TimeColumn = Annotated[str | None, _option("--wave-time-column", RECORD, "The column of times.", TIME_COLUMN)]
Gauge = Annotated[
    tuple[float, float] | None,
    _option("--wave-position", RECORD, "Where it was measured, m from the reference position.", "0 0", metavar="X Y"),
]
SecondColumn = Annotated[
    str | None,
    _option("--second-wave-column", RECORD, "Column of a second gauge, in line with the first: tells reflected waves.", "none"),
]
SecondGauge = Annotated[
    tuple[float, float] | None,
    _option("--second-wave-position", RECORD, "Where the second gauge was, m.", "none", metavar="X Y"),
]
Low = Annotated[
    float | None,
    _option("--low", HOW, "Lowest first-order frequency, Hz; found from the sea if it is outside 0.03 to 0.3 Hz.", f"{LOW:g}"),
]
Cutoff = Annotated[
    float | None,
    _option("--cutoff", HOW, "Highest frequency, Hz; found likewise. In high seas take less: a note says so.", f"{CUTOFF:g}"),
]
Order = Annotated[
    int | None,
    _option(
        "--order",
        HOW,
        "2: with the waves that they bind (Sharma and Dean; in regular waves Stokes). In regular waves 3 or more: stream "
        "function of so many Fourier components.",
        f"{ORDER}; 1 in a sea of several headings, with two gauges and in regular waves",
        min=1,
        max=MAX_ORDER,
    ),
]
Stretching = Annotated[
    Stretch | None,
    _option("--stretching", HOW, "Flow above still water; none: wetted up to still water only.", "vertical"),
]
Diffracting = Annotated[
    Diffraction | None,
    _option(
        "--diffraction",
        HOW,
        "Columns: maccamy_fuchs takes the place of 1 + Ca, ramp does in short waves only, none: 1 + Ca.",
        "the platform file's, or maccamy_fuchs",
    ),
]
Transient = Annotated[
    float | None,
    _option("--transient", HOW, "Left out of statistics and spectra, s.", f"{TRANSIENT:g}, at most a quarter of it all"),
]
Elements = Annotated[
    int | None,
    _option("--elements", HOW, "Load elements along every pontoon.", "the platform file's, or by length", min=1, max=1000),
]
Heading = Annotated[float, _option("--heading", HOW, "Where the waves run to, deg from x towards y.", True)]
Release = Annotated[
    list[str] | None, _option("--release", OTHER, "Offset from rest at the start, m or deg, as surge=5; once per motion.")
]
WaveHeight = Annotated[float | None, _option("--wave-height", OTHER, "Regular waves: height crest to trough, m.")]
WavePeriod = Annotated[float | None, _option("--wave-period", OTHER, "Regular waves: period, s.")]
Duration = Annotated[
    float | None, typer.Option(help="Simulated time, s.", show_default="600, 3600 in a sea, or all of a record")
]
Dt = Annotated[float, typer.Option("--dt", help="Time between the samples that are written, s.")]
MotionFormats = Annotated[
    list[MotionFormat] | None,
    typer.Option(
        "--format",
        help="File of the motion beside motion.csv: motion.nc (CF conventions) or motion.outb (OpenFAST). May be repeated.",
    ),
]
Calibrated = Annotated[
    Path | None,
    typer.Option(
        "--calibration",
        help="A calibration.json or diagnosis.json, or its folder. Its values, effects and strip conventions are used. For its "
        "own campaign, its wave options are used, too.",
    ),
]
Step = Annotated[float | None, typer.Option(help="Largest internal time step, s.", show_default="0.25 in a sea, else chosen")]
Tests = Annotated[
    Fitted | None,
    typer.Option(
        help="What to fit: free decays, tests in waves, or all together, static offsets and stated periods too.",
        show_default="decays where there are any",
    ),
]
Aim = Annotated[
    Objective,
    typer.Option(
        help="In waves, fit energy in bands, spectra in them, motion, energy and motion, or motion in blocks that start anew."
    ),
]
Robust = Annotated[Loss, typer.Option(help="With --tests all: cauchy lets outliers hardly count.")]
OverSea = Annotated[
    Law,
    typer.Option(
        help="In waves, drag as a power of the sea state (damping, too) or of the motion, or slow motion apart; "
        "choose: what held-out seas prefer. With --tests waves."
    ),
]
GlobalSearch = Annotated[
    str | None,
    typer.Option(
        help="multistart: search the decays' coefficients within their bounds first. Not with --start.",
        metavar="multistart",
        parser=_search_method,
        autocompletion=lambda: [MULTISTART],
    ),
]
SearchSeed = Annotated[int, typer.Option(help="Of the search.", min=0)]
SearchSeconds = Annotated[float, typer.Option(help="CPU time of the search, s.", min=1.0)]
Begin = Annotated[
    Path | None, typer.Option(help="A calibration.json or diagnosis.json, or its folder, whose coefficients are begun from.")
]
Finished = Annotated[
    Path,
    typer.Option("--calibration", help="The calibration.json of this campaign's decays, or its folder.", show_default=False),
]
Profiled = Annotated[
    list[str] | None,
    typer.Option("--profile", help="Follow the likelihood of a coefficient, as column.Cd_t, or 'column.*'.", metavar="LABEL"),
]
Resamplings = Annotated[
    int | None,
    typer.Option("--bootstrap", help="Resamplings: of the residuals in blocks, of tests with `repeat_of`.", metavar="N"),
]
Nuts = Annotated[bool, typer.Option("--nuts", help="Draw from the posterior (pip install 'jaxhydro\\[nuts]').")]
Level = Annotated[float, typer.Option("--level", help="Probability of the intervals.")]
DrawSeed = Annotated[int, typer.Option("--seed", help="Of the bootstrap and of NUTS.", min=0)]
Workers = Annotated[
    int | None, typer.Option(help="Processes, one core each; GPUs are shared.", show_default="as cores and memory hold", min=1)
]
Batch = Annotated[
    int | None,
    typer.Option(
        help="Runs that each takes at a time: on a GPU at once, else one after the other. Results on CPUs do not depend on it.",
        show_default="1; on a GPU what its memory holds",
        min=1,
    ),
]
Scheduler = Annotated[
    str | None, typer.Option(help="Address of a dask.distributed scheduler, whose workers run the sweep.", metavar="ADDRESS")
]
