"""Command-line application; each command imports what it needs."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from jaxhydro.cli import arguments, options, sea_options
from jaxhydro.cli.console import complain, say, table, warnings_told
from jaxhydro.errors import InputError, Problem, suggest
from jaxhydro.files import campaign_file
from jaxhydro.interrupts import asked_to_stop, ended_by_signals

if TYPE_CHECKING:
    from jaxhydro.dynamics.model import Model

BAD_INPUT, NOT_CONVERGED, STOPPED = 2, 3, 130
MAX_SCALE = 1e5  # that a campaign takes
STOPPED_MESSAGE = "stopped; nothing was written"
DEMO = "volturnus-s-decays"
TRUTH = {  # what the records of the demo were made with: Table 1 of the paper this package started from
    "column.Ca_t": 1.50,
    "column.Ca_z": 0.12,
    "column.Cd_t": 2.09,
    "column.Cd_z": 2.23,
    "pontoon.Ca_t": 0.11,
    "pontoon.Ca_z": 1.87,
    "pontoon.Cd_t": 1.84,
    "pontoon.Cd_z": 4.96,
    "linear_damping.B11": 4.4e4,
    "linear_damping.B33": 1.6e5,
    "linear_damping.B55": 3.63e8,
}


PlatformArgument = Annotated[
    str,
    typer.Argument(
        help="A platform file, or a built-in name (see `jaxhydro platforms`).", autocompletion=options.platforms_like
    ),
]


class Guarded(TyperGroup):
    """Bad input is answered with a message and exit status 2, never with a traceback."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command."""
        try:
            with ended_by_signals(), warnings_told():
                return super().invoke(ctx)
        except InputError as error:
            complain(str(error))
            raise typer.Exit(BAD_INPUT) from None
        except KeyboardInterrupt as stopped:
            complain(str(stopped) or STOPPED_MESSAGE)
            raise typer.Exit(STOPPED) from None
        except ImportError:
            if not asked_to_stop():  # in the middle of an import, which took it for a failure
                raise
            complain(STOPPED_MESSAGE)
            raise typer.Exit(STOPPED) from None
        except RuntimeError as error:
            from jaxhydro.dynamics.statics import EquilibriumError
            from jaxhydro.jax_settings import Float64Error

            if not isinstance(error, EquilibriumError | Float64Error):
                raise
            complain(str(error))
            raise typer.Exit(BAD_INPUT) from None


app = typer.Typer(
    cls=Guarded,
    help=arguments.HELP,
    epilog=arguments.EPILOG,
    no_args_is_help=True,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def main() -> None:
    """The entry point."""
    app(prog_name="jaxhydro")  # also of `python -m jaxhydro`


def _version(wanted: bool) -> None:
    if wanted:
        import jaxhydro

        say(f"jaxhydro {jaxhydro.__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")] = False,
) -> None:
    pass


@app.command(epilog=arguments.EXAMPLES)
def simulate(
    ctx: typer.Context,
    platform: Annotated[
        str,
        typer.Argument(
            help="A platform file, a built-in name (see `jaxhydro platforms`), or a campaign's folder.",
            autocompletion=options.platforms_like,
        ),
    ],
    out: arguments.Out = None,
    hs: arguments.Hs = None,
    tp: arguments.Tp = None,
    gamma: arguments.Gamma = None,
    spectrum: arguments.Kind = None,
    seed: arguments.Seed = None,
    amplitudes: arguments.Height = None,
    sea: arguments.Sea = None,
    spreading: arguments.Spreading = None,
    sea_file: arguments.SeaFile = None,
    x_bearing: arguments.Bearing = None,
    wave: arguments.Wave = None,
    wave_column: arguments.WaveColumn = None,
    wave_unit: arguments.WaveUnit = None,
    wave_time_column: arguments.TimeColumn = None,
    wave_position: arguments.Gauge = None,
    low: arguments.Low = None,
    cutoff: arguments.Cutoff = None,
    order: arguments.Order = None,
    stretching: arguments.Stretching = None,
    diffraction: arguments.Diffracting = None,
    elements: arguments.Elements = None,
    heading: arguments.Heading = sea_options.DEFAULTS["--heading"],
    transient: arguments.Transient = None,
    wave_height: arguments.WaveHeight = None,
    wave_period: arguments.WavePeriod = None,
    release: arguments.Release = None,
    duration: arguments.Duration = None,
    dt: arguments.Dt = sea_options.DEFAULTS["--dt"],
    calibration: arguments.Calibrated = None,
    step: arguments.Step = None,
    figures: arguments.Figures = True,
    formats: arguments.MotionFormats = None,
) -> None:
    """Motions in irregular waves, regular waves and free decays: series, statistics and figures.

    With a campaign, its tests in regular and irregular waves, in the waves that were measured; only --order, --stretching,
    --diffraction, --cutoff, --calibration and --no-figures go with one.
    """
    given = sea_options.by_option(ctx.params)
    if sea_options.is_campaign(platform):
        campaign_file(platform)
        if formats:
            raise options.wrong("--format", "it goes with a platform; of a campaign all motions are in simulated.nc")
        return _simulate_campaign(Path(platform), out, calibration, sea_options.of_campaign(given), figures)
    options.check_platform(platform)
    offset, regular = options.releases(release or []), options.regular(wave_height, wave_period)
    asked = sea_options.asked(given, options.finite(heading, "--heading"))
    if asked is not None and regular is not None:
        raise options.wrong("--wave-height", "regular waves or an irregular sea, not both")
    if asked is None and regular is None and not offset:
        ways = "--release, --hs and --tp, --sea, --wave, or --wave-height and --wave-period"
        raise options.wrong("--release", f"nothing moves: give {ways}")
    if asked is not None and wave is not None:
        from jaxhydro.interop.data_files import read_table

        asked = sea_options.with_record(asked, wave, read_table(wave), given)
    duration = sea_options.duration(duration, asked)
    dt = options.interval(dt, "--dt", duration)
    step = None if step is None else options.interval(step, "--step", duration)
    out = options.results_folder(out, "motion.csv", platform)
    from jaxhydro.cli import sea_command
    from jaxhydro.cli import simulate_command as command

    one = None if asked is None else asked.heading if asked.long_crested else None  # several are checked with the sea
    model = _model(platform, calibration, diffraction, elements, heading if regular is not None else one)
    job = command.Job(platform, out, duration, dt, offset, step, figures, None if calibration is None else str(calibration))
    job = job._replace(formats=tuple(one.value for one in formats or ()))
    stretch = sea_options.stretching(given)
    of_regular = (regular, heading, stretch, order or 1)
    if not (command.run(model, job, *of_regular) if asked is None else sea_command.run(model, job, asked)):
        raise typer.Exit(NOT_CONVERGED)


@app.command(epilog=arguments.STATICS)
def statics(
    platform: PlatformArgument,
    force: Annotated[
        list[str] | None,
        typer.Option(help="Steady force at the reference point, N or N m, as surge=1.5e6. May be repeated."),
    ] = None,
    offset: Annotated[
        list[str] | None,
        typer.Option(help="Offset from rest up to which restoring forces are printed, m or deg, as surge=20. May be repeated."),
    ] = None,
    calibration: arguments.Calibrated = None,
) -> None:
    """Rest position, natural periods, forces by load, tensions of mooring lines, stiffness. Nothing is written."""
    options.check_platform(platform)
    forces = options.by_motion(force or [], "--force", "its force expected, as surge=1.5e6")
    offsets = options.releases(offset or [], "--offset")
    from jaxhydro.cli.statics_command import print_statics

    print_statics(platform, forces, offsets, calibration)


@app.command(epilog=arguments.STARTING)
def init(
    folder: Annotated[Path, typer.Argument(help="The campaign's folder: a new or an empty one.", metavar="FOLDER")],
    files: Annotated[
        list[Path] | None, typer.Argument(help="Data files, one per test; they are copied.", metavar="DATA_FILE")
    ] = None,
    platform: Annotated[
        str,
        typer.Option(
            help="A built-in name (see `jaxhydro platforms`), or a platform file.", autocompletion=options.platforms_like
        ),
    ] = "volturnus-s",
    scale: Annotated[
        float | None, typer.Option(help="Froude length scale of the records: 70 for a model at 1:70.", show_default="1")
    ] = None,
) -> None:
    """Make a campaign folder to calibrate to: platform.yaml, a commented campaign.yaml, and your data files.

    Columns, units, kinds of tests and released motions are guessed from the data files. Each guess is marked CHECK in
    campaign.yaml. Without data files, campaign.yaml is an example to edit.
    """
    if scale is not None and not 1 <= scale <= MAX_SCALE:
        expected = f"full-scale length over model length, 1 to {MAX_SCALE:g}: 70 for 1:70"
        raise options.wrong("--scale", f"{expected} expected; found {scale:g}")
    from calibration.commands.init_command import init_campaign

    init_campaign(folder, platform, scale, files or [])


@app.command(epilog=arguments.CONVERTING)
def convert(
    source: Annotated[Path, typer.Argument(help="OpenFAST's main file (.fst) or a RAFT design (.yaml).", metavar="SOURCE")],
    out: Annotated[Path, typer.Option("--out", help="A new or an empty folder.")],
) -> None:
    """Make platform.yaml of another program's model, with a page that says what became of each item of it.

    Of an OpenFAST deck: mass (ElastoDyn), members, coefficients, ballast and potential flow (HydroDyn), moorings (MoorDyn),
    water. Of a RAFT design: members, masses of shell and ballast, turbine, moorings, water.
    """
    from jaxhydro.cli.convert_command import convert_model

    convert_model(source, out)


@app.command(epilog=arguments.EXPORTING)
def export(
    platform: PlatformArgument,
    out: Annotated[Path, typer.Option("--out", help="A new or an empty folder.")],
    calibration: arguments.Calibrated = None,
    deck: Annotated[
        arguments.DeckFormat, typer.Option("--format", help="Program that the model is written for.")
    ] = arguments.DeckFormat.openfast,
) -> None:
    """Write a platform, tuned by a calibration, as another program's model, with a page of what became of each item.

    For OpenFAST 5: main.fst, and files of ElastoDyn, HydroDyn, SeaState (still water) and, for catenaries, MoorDyn. For RAFT:
    design.yaml. For MoorDyn 2: lines.txt, the catenary lines alone.
    """
    options.check_platform(platform)
    from jaxhydro.cli.export_command import export_model

    export_model(platform, out, deck, calibration)


@app.command()
def check(
    campaign: arguments.Campaign,
    out: Annotated[Path | None, typer.Option("--out", help="Folder for figures of the hull and of every record.")] = None,
) -> None:
    """Read a campaign and show what it holds: tests, natural periods beside the model's, warnings. Nothing is fitted."""
    campaign_file(campaign)
    drawn = None if out is None else options.check_folder(out)
    from calibration.commands.check_command import check_campaign

    check_campaign(campaign, drawn)


@app.command(epilog=arguments.FITTING)
def calibrate(
    campaign: arguments.Campaign,
    out: arguments.Out = None,
    figures: arguments.Figures = True,
    tests: arguments.Tests = None,
    objective: arguments.Aim = arguments.Objective.bands,
    law: arguments.OverSea = arguments.Law.constant,
    loss: arguments.Robust = arguments.Loss.squares,
    method: arguments.GlobalSearch = None,
    search_seed: arguments.SearchSeed = 0,
    search_seconds: arguments.SearchSeconds = 60.0,
    start: arguments.Begin = None,
) -> None:
    """Fit a platform's coefficients to the tests marked `fit`: calibration.json, simulated.nc, figures.

    To the free decays where there are any, else to the tests in irregular and regular waves; with `--tests all` to both
    together, to static offsets and to natural periods that the manifest states.
    """
    kind = None if tests is None else tests.value
    how: dict[str, Any] = {"objective": objective.value, "law": law.value.replace("-", "_"), "loss": loss.value, "start": start}
    how |= {"method": method, "seed": search_seed, "seconds": search_seconds}
    _calibrate(campaign, out, figures, None, kind, **how)


@app.command(epilog=arguments.DIAGNOSING)
def diagnose(
    campaign: arguments.Campaign,
    out: arguments.Out = None,
    figures: arguments.Figures = True,
) -> None:
    """Fit a platform's coefficients, then find what the model lacks: an effect with its name, its size and the evidence.

    The declared model is fitted to the tests marked `fit`. All effects that could be missing are then compared, alone and
    together. Each effect of the most probable set is taken out in turn. It stays only where the tests marked `holdout` ask for
    it; where there are none, blocks of the fitted ones are left out in turn. Nothing in the campaign has to name an effect. The
    answer may be that nothing is missing, or that something is and none of the known effects explains it.
    """
    campaign_file(campaign)
    out = options.results_folder(out, "diagnosis.json", campaign)
    from calibration.commands.diagnose_command import diagnose_campaign

    if not diagnose_campaign(campaign, out, figures):
        raise typer.Exit(NOT_CONVERGED)


@app.command(epilog=arguments.QUANTIFYING)
def uncertainty(
    campaign: arguments.Campaign,
    calibration: arguments.Finished,
    out: arguments.Out = None,
    profiles: arguments.Profiled = None,
    bootstrap: arguments.Resamplings = None,
    nuts: arguments.Nuts = False,
    level: arguments.Level = 0.95,
    seed: arguments.DrawSeed = 0,
    figures: arguments.Figures = True,
) -> None:
    """How well a calibration of free decays knows its coefficients: intervals with errors taken as they are.

    What is left of a fit is mostly the model's own error, and lasts from sample to sample: it is coloured. Intervals of the
    fit's covariance allow for it; on request also profiles of the likelihood, a bootstrap, and draws from the posterior.
    """
    campaign_file(campaign)
    out = options.results_folder(out, "uncertainty.json", campaign)
    from calibration.commands.uncertainty_command import quantify

    how: dict[str, Any] = {"draws": bootstrap, "nuts": nuts, "level": level, "seed": seed, "figures": figures}
    if not quantify(campaign, calibration, out, profiles=profiles or (), **how):
        raise typer.Exit(NOT_CONVERGED)


@app.command()
def report(
    folder: Annotated[
        Path,
        typer.Argument(help="A folder that `jaxhydro simulate`, `calibrate`, `diagnose`, `uncertainty` or `sweep` wrote."),
    ],
) -> None:
    """Make one self-contained HTML page, report.html, of what is in a result folder."""
    options.check_results(folder)
    from calibration.report.write_report import write_report

    say(f"{write_report(folder)}")


@app.command()
def demo(out: Annotated[Path, typer.Option("--out", help=arguments.OUT)] = Path("jaxhydro-demo")) -> None:
    """Calibrate to the nine embedded decays of VolturnUS-S, compare with the true coefficients, make a page."""
    from importlib import resources

    folder = Path(str(resources.files("jaxhydro") / "campaigns" / DEMO))
    say(f"The campaign is in {folder}")
    _calibrate(folder, out, True, TRUTH)


@app.command(epilog=arguments.SWEEPING)
def sweep(
    file: Annotated[Path, typer.Argument(help="A sweep file.", metavar="SWEEP")],
    out: arguments.Out = None,
    workers: arguments.Workers = None,
    batch: arguments.Batch = None,
    scheduler: arguments.Scheduler = None,
    restart: Annotated[bool, typer.Option("--restart", help="Forget the runs that are in the folder.")] = False,
    retry_failed: Annotated[bool, typer.Option("--retry-failed", help="Do runs that failed again.")] = False,
) -> None:
    """All sea states of a scatter table, with all headings and all seeds: results.zarr, lifetime statistics, figures.

    Stopped or killed, the same command goes on where it was.
    """
    out = options.results_folder(out, "sweep.json", file)
    from jaxhydro.cli import sweep_command as command

    try:
        if not command.sweep(file, out, workers, batch, restart, retry_failed, scheduler):
            raise typer.Exit(NOT_CONVERGED)
    except command.Stopped as error:
        complain(str(error))
        raise typer.Exit(STOPPED) from None


@app.command()
def schema(
    file: Annotated[str, typer.Argument(help="campaign or platform.", show_default=False)],
) -> None:
    """Print the JSON Schema of campaign.yaml or platform.yaml: editors complete keys by it and mark mistakes."""
    import json

    from calibration.campaign.manifest import Manifest
    from jaxhydro.platform.schema import Platform

    kinds: dict[str, type[Manifest | Platform]] = {"campaign": Manifest, "platform": Platform}
    if file not in kinds:
        raise InputError("schema", [Problem("", " or ".join(kinds), repr(file), suggest(file, kinds))])
    typer.echo(json.dumps(kinds[file].model_json_schema(), indent=2, ensure_ascii=False))


@app.command()
def platforms() -> None:
    """List the built-in platforms."""
    from jaxhydro.cli.platform_list import HEADS, particulars
    from jaxhydro.platform.schema import builtin_platforms

    table("Built-in platforms", HEADS, [particulars(name) for name in builtin_platforms()], 2)
    say("Copy one to edit: jaxhydro init FOLDER --platform NAME")
    say("Release one from 1 m of heave: jaxhydro simulate NAME --release heave=1")


def _calibrate(
    campaign: Path, out: Path | None, figures: bool, truth: dict[str, float] | None = None, tests: str | None = None, **how: Any
) -> None:
    """Calibrate; where the truth is known, compare with it and make the report page."""
    campaign_file(campaign)
    out = options.results_folder(out, "calibration.json", campaign)
    from calibration.commands import calibrate_command as command

    loaded, kind = command.load_fitted(campaign, out, tests)
    result = command.run(loaded, out, figures, tests=kind, truth=truth, **how)
    if result is None or not result.converged:
        raise typer.Exit(NOT_CONVERGED)


def _simulate_campaign(
    campaign: Path, out: Path | None, calibration: Path | None, asked: dict[str, Any], figures: bool
) -> None:
    out = options.results_folder(out, "comparison.json", campaign)
    from calibration.commands.calibrate_command import simulate_campaign

    if not simulate_campaign(campaign, out, calibration=calibration, asked=asked, figures=figures):
        raise typer.Exit(NOT_CONVERGED)


def _model(
    platform: str, calibration: Path | None, diffraction: str | None, elements: int | None, heading: float | None = None
) -> "Model":
    """The model of a platform, for waves of a heading (deg)."""
    from jaxhydro.cli.simulate_command import calibrated
    from jaxhydro.platform.build import model_of
    from jaxhydro.platform.schema import load_platform

    declared = load_platform(platform)
    if heading is not None and (other := declared.of_other_waves(heading)) is not None:
        raise options.wrong("--heading", f"{other.words} ({other.key} of the platform file) expected; found {heading:g}")
    model = model_of(declared, diffraction, elements)
    return model if calibration is None else calibrated(model, platform, declared.name, calibration)
