"""Help texts and options of the command line."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from jaxhydro.cli.sea_options import MAX_ORDER, ORDER, SEED, TIME_COLUMN, WAVE_COLUMN
from jaxhydro.dynamics.requested_sea import TRANSIENT
from jaxhydro.waves.wave_bands import CUTOFF, LOW

SEVERAL = "Irregular waves of several headings"
SEA, RECORD, HOW = "Irregular waves from a spectrum", "Irregular waves from a record", "How waves act"
OTHER = "Regular waves and free decays"
HELP = (
    "Motions of floating-wind platforms in waves, and the coefficients that make them follow a basin test.\n\n"
    "A platform is one YAML file: hull members, mass, mooring, starting coefficients. A campaign is a folder: that "
    "file, a campaign.yaml that says what was measured in which columns, and one data file per test."
)
EPILOG = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro demo --out demo",
        "jaxhydro simulate volturnus-s --hs 3.1 --tp 8.96 --out sea",
        "jaxhydro simulate volturnus-s --release surge=5 --release pitch=3 --out decay",
        "jaxhydro sweep sweep.yaml --out life",
        "jaxhydro convert deck/main.fst --out my-platform",
        "jaxhydro init my-campaign decays/*.csv --scale 70",
        "jaxhydro calibrate my-campaign --out results",
        "jaxhydro uncertainty my-campaign --calibration results/calibration.json --out uncertainty",
        "jaxhydro diagnose my-campaign --out diagnosis",
        "[bold]Formats[/bold]",
        "docs/formats.md describes every key of platform and campaign files, and of the results. `jaxhydro init` makes a "
        "campaign to fill in; `jaxhydro demo` prints where a complete one is.",
        "Exit status: 0 done; 2 the input is wrong; 3 not converged, or runs of a sweep failed, with what "
        "was reached written and "
        "marked so, or a motion that grew beyond all bounds, with nothing written; 130 stopped.",
    )
)
EXAMPLES = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro simulate volturnus-s --hs 3.1 --tp 8.96 --duration 3600 --out sea",
        "jaxhydro simulate volturnus-s --hs 3.1 --tp 8.96 --spreading 10 --out short-crested",
        "jaxhydro simulate volturnus-s --sea 'hs=2 tp=14 heading=30' --sea 'hs=1.5 tp=7 heading=-40 spreading=8' --out two",
        "jaxhydro simulate volturnus-s --wave tank.csv --wave-column probe1 --wave-position -100 0 --out tank",
        "jaxhydro simulate volturnus-s --wave-height 4 --wave-period 10 --out wave",
        "jaxhydro simulate volturnus-s --release surge=5 --release pitch=3 --out decay",
        "jaxhydro simulate volturnus-s --release surge=5 --format netcdf --format outb --out files",
        "jaxhydro simulate my-campaign --calibration results/calibration.json --out seas",
    )
)

CONVERTING = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro convert deck/main.fst --out my-platform",
        "jaxhydro simulate my-platform/platform.yaml --release heave=1",
        "[bold]What it writes[/bold]",
        "platform.yaml, copies of the tables that it names, and conversion.md: what was taken, approximated and left out. "
        "A folder that is not empty is refused. Exit status: 0 done; 2 the input is wrong, and nothing was written.",
    )
)
EXPORTING = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro export my-campaign/platform.yaml --out deck --calibration my-campaign-calibration",
        "jaxhydro export volturnus-s --out deck",
        "jaxhydro export volturnus-s --out raft --format raft",
        "jaxhydro export my-platform/platform.yaml --out lines --format moordyn",
        "[bold]What it writes[/bold]",
        "openfast: main.fst and the files that it names. raft: design.yaml. moordyn: lines.txt, of a platform with catenary "
        "lines. Beside them export.md: what was taken, approximated and left out. "
        "A folder that is not empty is refused. Exit status: 0 done; 2 the input is wrong, and nothing was written.",
    )
)
STATICS = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro statics volturnus-s",
        "jaxhydro statics my-platform/platform.yaml --offset surge=20 --offset sway=10",
        "jaxhydro statics my-platform/platform.yaml --force surge=1.5e6 --force pitch=1.5e8",
        "Forces act at the reference point, along the earth's axes: a thrust at a height also has a moment.",
    )
)
STARTING = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro init my-campaign",
        "jaxhydro init my-campaign decays/*.csv --scale 70",
        "jaxhydro init my-campaign roll.xlsx --platform my-platform.yaml",
        "[bold]What it writes[/bold]",
        "campaign.yaml, platform.yaml and copies of the data files (docs/formats.md). A folder that is not empty is refused. "
        "Exit status: 0 done; 2 the input is wrong, and nothing was written.",
    )
)

FITTING = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro calibrate my-campaign --out results",
        "jaxhydro calibrate my-campaign --tests waves --start results/calibration.json --out tuned",
        "jaxhydro calibrate my-campaign --tests waves --law choose --out laws",
        "jaxhydro calibrate my-campaign --tests all --out joint",
        "jaxhydro report results",
        "[bold]What it writes[/bold]",
        "calibration.json (docs/formats.md), simulated.nc, figures. Exit status: 0 done; 2 the input is wrong; 3 not "
        "converged or "
        "stopped, or a record is not followed, with what was reached written and marked so; 130 stopped, nothing was written.",
    )
)

DIAGNOSING = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro diagnose my-campaign --out diagnosis",
        "jaxhydro report diagnosis",
        "jaxhydro simulate my-campaign --calibration diagnosis/diagnosis.json --out seas",
        "[bold]What makes a good campaign[/bold]",
        "Tests of one kind from small and large amplitudes: effects differ by how they grow. At least one test of every kind "
        "marked `use: holdout`: without one blocks of the fitted tests are left out in turn. Decays say nothing of "
        "what acts in "
        "waves only.",
        "[bold]What it writes[/bold]",
        "diagnosis.json (docs/formats.md), simulated.nc, figures. `jaxhydro report` makes one page of them to hand on. "
        "Exit status: 0 done; 2 the input is wrong; 3 not converged or stopped, with what was reached written and marked so; "
        "130 stopped, and the same command goes on.",
    )
)

QUANTIFYING = "\n\n".join(
    (
        "[bold]Examples[/bold]",
        "jaxhydro uncertainty my-campaign --calibration results/calibration.json --out uncertainty",
        "jaxhydro uncertainty my-campaign --calibration results --out uncertainty --profile column.Cd_t --bootstrap 200",
        "jaxhydro uncertainty my-campaign --calibration results --out uncertainty --profile '*' --nuts",
        "jaxhydro report uncertainty",
        "[bold]What it writes[/bold]",
        "uncertainty.json (docs/formats.md), figures. `jaxhydro report` makes one page of them to hand on. "
        "Exit status: 0 done; 2 the input is wrong; 3 not converged, with what was reached written and marked so; 130 stopped, "
        "nothing was written.",
    )
)

SWEEPING = "\n\n".join(
    (
        "[bold]A sweep file[/bold]",
        "platform: volturnus-s",
        "scatter: scatter.csv           # columns Hs,Tp,probability",
        "headings: [0, 30]              # deg",
        "seeds: 6",
        "All keys, and what it writes: docs/guide/sweeps.md.",
        "Exit status: 0 done; 2 the input is wrong; 3 runs failed, each with its reason in sweep.json; 130 stopped.",
    )
)


MULTISTART = "multistart"


class DeckFormat(StrEnum):
    """Program that a model is written for."""

    openfast = "openfast"
    raft = "raft"
    moordyn = "moordyn"


class MotionFormat(StrEnum):
    """Further file of a simulated motion."""

    netcdf = "netcdf"
    outb = "outb"


class Spectrum(StrEnum):
    """Spectra by name."""

    jonswap = "jonswap"
    pierson_moskowitz = "pierson-moskowitz"
    white = "white"


class Amplitudes(StrEnum):
    """See `spectrum_components`."""

    deterministic = "deterministic"
    rayleigh = "rayleigh"


class Fitted(StrEnum):
    """Which tests are fitted."""

    decays = "decays"
    waves = "waves"
    all = "all"


class Objective(StrEnum):
    """See `calibration.calibrate_in_waves`."""

    bands = "bands"
    spectrum = "spectrum"
    motion = "motion"
    both = "both"
    blocks = "blocks"


class Loss(StrEnum):
    """See `calibration.calibrate_jointly`."""

    squares = "squares"
    cauchy = "cauchy"


class Law(StrEnum):
    """How coefficients depend on the sea state: see `calibration.choose_law`."""

    constant = "constant"
    significant_height = "significant-height"
    peak_period = "peak-period"
    both = "both"
    keulegan_carpenter = "keulegan-carpenter"
    high_pass = "high-pass"
    choose = "choose"


class Diffraction(StrEnum):
    """See `Model`."""

    maccamy_fuchs = "maccamy_fuchs"
    ramp = "ramp"
    none = "none"


class Stretch(StrEnum):
    """See `WaveSea`."""

    none = "none"
    vertical = "vertical"
    wheeler = "wheeler"
    extrapolation = "extrapolation"


def _search_method(value: str) -> str:
    """Check a global search by its name."""
    if value == MULTISTART:
        return value
    baselines = "; population searches (ga, de, cma-es) are baselines: python -m benchmarks.validate --only global_search"
    raise typer.BadParameter(f"{MULTISTART} expected, found {value!r}{baselines if value in ('ga', 'de', 'cma-es') else ''}")


def _option(name: str, panel: str, text: str, default: str | bool = False, **more: Any) -> Any:
    return typer.Option(name, help=text, rich_help_panel=panel, show_default=default, **more)


OUT = "Folder for the results; made where absent."
Out = Annotated[Path | None, typer.Option("--out", help=OUT, show_default="a new one, such as my-campaign-calibration")]
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
        "--sea-file", SEVERAL, "Directional spectrum: CSV or NetCDF with efth (m2/Hz/deg) over freq (Hz) and dir (deg, from)."
    ),
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
        f"{ORDER}; 1 in a sea of several headings and in regular waves",
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
        help="A calibration.json or diagnosis.json, or its folder, whose values, effects and strips are used; of its own "
        "campaign seas, too.",
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
