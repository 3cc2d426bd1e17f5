"""Commands on a platform: simulations, statics, sweeps and platform files; each imports what it needs."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from jaxhydro.cli import arguments, option_choices, options, sea_options
from jaxhydro.cli.console import complain, say, table
from jaxhydro.cli.exit_status import NOT_CONVERGED, STOPPED
from jaxhydro.errors import InputError, Problem, suggest
from jaxhydro.files import campaign_file

if TYPE_CHECKING:
    from jaxhydro.dynamics.model import Model

PlatformArgument = Annotated[
    str,
    typer.Argument(
        help="A platform file, a built-in name (see `jaxhydro platforms`), or a campaign's folder, for its platform.",
        autocompletion=options.platforms_like,
    ),
]


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
    sea_time: arguments.SeaTime = None,
    x_bearing: arguments.Bearing = None,
    wave: arguments.Wave = None,
    wave_column: arguments.WaveColumn = None,
    wave_unit: arguments.WaveUnit = None,
    wave_time_column: arguments.TimeColumn = None,
    wave_position: arguments.Gauge = None,
    second_wave_column: arguments.SecondColumn = None,
    second_wave_position: arguments.SecondGauge = None,
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

    With a campaign, its tests in regular and irregular waves are simulated, in the waves that were measured. Only --order,
    --stretching, --diffraction, --cutoff, --calibration and --no-figures go with a campaign.
    """
    cli_options = sea_options.by_option(ctx.params)
    if options.is_campaign(platform):
        campaign_file(platform)
        if formats:
            raise options.wrong("--format", "it goes with a platform; of a campaign all motions are in simulated.nc")
        return _simulate_campaign(Path(platform), out, calibration, sea_options.of_campaign(cli_options), figures)
    options.check_platform(platform, or_campaign=True)
    offset, regular = options.releases(release or []), options.regular(wave_height, wave_period)
    asked = sea_options.asked(cli_options, options.finite(heading, "--heading"))
    if asked is not None and regular is not None:
        raise options.wrong("--wave-height", "regular waves or an irregular sea, not both")
    if asked is None and regular is None and not offset:
        ways = "--release, --hs and --tp, --sea, --wave, or --wave-height and --wave-period"
        raise options.wrong("--release", f"nothing moves: give {ways}")
    if asked is not None and wave is not None:
        from jaxhydro.interop.data_files import read_table

        asked = sea_options.with_record(asked, wave, read_table(wave), cli_options)
    duration = sea_options.duration(duration, asked)
    dt = options.interval(dt, "--dt", duration)
    step = None if step is None else options.interval(step, "--step", duration)
    out = options.results_folder(out, "motion.csv", platform)
    from jaxhydro.cli import sea_command, simulate_command

    sea_heading = None if asked is None else asked.heading if asked.long_crested else None  # several are checked with the sea
    model = _model(platform, calibration, diffraction, elements, heading if regular is not None else sea_heading)
    values, written = None if calibration is None else str(calibration), tuple(format.value for format in formats or ())
    job = simulate_command.Job(platform, out, duration, dt, offset, step, figures, values, written)
    of_regular = (regular, heading, sea_options.stretching(cli_options), order or 1)
    if not (simulate_command.run(model, job, *of_regular) if asked is None else sea_command.run(model, job, asked)):
        raise typer.Exit(NOT_CONVERGED)


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
    """Print rest position, natural periods, forces by load, stiffness, and tensions of mooring lines where there are any.

    Nothing is written.
    """
    platform = options.platform_of(platform)
    forces = options.by_motion(force or [], "--force", "its force expected, as surge=1.5e6")
    offsets = options.releases(offset or [], "--offset")
    from jaxhydro.cli.statics_command import print_statics

    print_statics(platform, forces, offsets, calibration)


def convert(
    source: Annotated[
        Path,
        typer.Argument(
            help=(
                "OpenFAST's main file (.fst), a RAFT design (.yaml), results of WAMIT, HAMS, Nemoh or Capytaine (a folder), "
                "or mooring lines: a MoorDyn file (.dat, .txt) or a MoorPy system (.yaml)."
            ),
            metavar="SOURCE",
        ),
    ],
    out: Annotated[Path, typer.Option("--out", help="A new or an empty folder.")],
    mooring: Annotated[
        Path | None,
        typer.Option("--mooring", help="MoorDyn file or MoorPy system with the mooring lines, where SOURCE has none."),
    ] = None,
) -> None:
    """Make platform.yaml of another program's model, with a page that says what became of each item of it.

    Of an OpenFAST deck: mass (ElastoDyn), members, coefficients, ballast and potential flow (HydroDyn), moorings (MoorDyn),
    water. Of a RAFT design: members, masses of shell and ballast, turbine, moorings, water. Of panel programs: tables, water,
    and the mass where it is known; what has to be filled in by hand is marked. Of mooring lines alone: mooring.yaml, with the
    section `mooring` to paste.
    """
    from jaxhydro.cli.convert_command import convert_model

    convert_model(source, out, mooring)


def export(
    platform: PlatformArgument,
    out: Annotated[Path, typer.Option("--out", help="A new or an empty folder.")],
    calibration: arguments.Calibrated = None,
    deck: Annotated[
        option_choices.DeckFormat, typer.Option("--format", help="Program that the model is written for.")
    ] = option_choices.DeckFormat.openfast,
) -> None:
    """Write a platform as another program's model, with a page of what became of each item.

    With --calibration the platform has the calibrated values.

    For OpenFAST 5: main.fst, and files of ElastoDyn, HydroDyn, SeaState (still water) and, for catenaries, MoorDyn. For RAFT:
    design.yaml. For MoorDyn 2: lines.txt, the catenary lines alone.
    """
    platform = options.platform_of(platform)
    from jaxhydro.cli.export_command import export_model

    export_model(platform, out, deck, calibration)


def sweep(
    file: Annotated[Path, typer.Argument(help="A sweep file.", metavar="SWEEP")],
    out: arguments.Out = None,
    workers: arguments.Workers = None,
    batch: arguments.Batch = None,
    scheduler: arguments.Scheduler = None,
    restart: Annotated[bool, typer.Option("--restart", help="Forget the runs that are in the folder.")] = False,
    retry_failed: Annotated[bool, typer.Option("--retry-failed", help="Do runs that failed again.")] = False,
) -> None:
    """Simulate all sea states of a scatter table with all headings and all seeds.

    Results are results.zarr, lifetime statistics and figures. Stopped or killed, the same command goes on where it was.
    """
    out = options.results_folder(out, "sweep.json", file)
    from jaxhydro.cli import sweep_command as command

    try:
        if not command.sweep(file, out, workers, batch, restart, retry_failed, scheduler):
            raise typer.Exit(NOT_CONVERGED)
    except command.Stopped as error:
        complain(str(error))
        raise typer.Exit(STOPPED) from None


def schema(
    file: Annotated[str, typer.Argument(help="campaign or platform.", show_default=False)],
) -> None:
    """Print the JSON Schema of campaign.yaml or platform.yaml.

    Editors complete keys by it and mark mistakes.
    """
    import json

    from calibration.campaign.manifest import Manifest
    from jaxhydro.platform.schema import Platform

    kinds: dict[str, type[Manifest | Platform]] = {"campaign": Manifest, "platform": Platform}
    if file not in kinds:
        raise InputError("schema", [Problem("", " or ".join(kinds), repr(file), suggest(file, kinds))])
    typer.echo(json.dumps(kinds[file].model_json_schema(), indent=2, ensure_ascii=False))


def platforms() -> None:
    """List the built-in platforms."""
    from jaxhydro.cli.platform_list import HEADS, particulars
    from jaxhydro.platform.schema import builtin_platforms

    table("Built-in platforms", HEADS, [particulars(name) for name in builtin_platforms()], 2)
    say("Copy one to edit: jaxhydro init FOLDER --platform NAME")
    say("Release one from 1 m of heave: jaxhydro simulate NAME --release heave=1")


def _simulate_campaign(
    campaign: Path, out: Path | None, calibration: Path | None, asked: dict[str, Any], figures: bool
) -> None:
    out = options.results_folder(out, "comparison.json", campaign)
    from calibration.commands.simulate_campaign_command import simulate_campaign

    if not simulate_campaign(campaign, out, calibration=calibration, asked=asked, figures=figures):
        raise typer.Exit(NOT_CONVERGED)


def _model(
    platform: str, calibration: Path | None, diffraction: str | None, elements: int | None, heading: float | None = None
) -> "Model":
    """The model of a platform, for waves of a heading (deg)."""
    from jaxhydro.cli.model_messages import calibrated
    from jaxhydro.platform.build import model_of
    from jaxhydro.platform.schema import load_platform

    contents = load_platform(platform)
    if heading is not None and (tables := contents.of_other_waves(heading)) is not None:
        raise options.wrong("--heading", f"{tables.words} ({tables.key} of the platform file) expected; found {heading:g}")
    model = model_of(contents, diffraction, elements)
    return model if calibration is None else calibrated(model, platform, contents.name, calibration)
