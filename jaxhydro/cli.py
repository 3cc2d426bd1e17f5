"""The command line. What is heavy is imported by the command that needs it."""

import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperGroup

from jaxhydro import options
from jaxhydro.console import complain, say, table
from jaxhydro.problems import InputError, Problem, shown, suggest

if TYPE_CHECKING:
    from jaxhydro.model import Model

BAD_INPUT, NOT_CONVERGED, STOPPED = 2, 3, 130
DEMO = "volturnus-s-decays"
TRUTH = {  # what the records of the demo were made with: Table 1 of the paper this package started from
    "column.Ca_t": 1.50, "column.Ca_z": 0.12, "column.Cd_t": 2.09, "column.Cd_z": 2.23,
    "pontoon.Ca_t": 0.11, "pontoon.Ca_z": 1.87, "pontoon.Cd_t": 1.84, "pontoon.Cd_z": 4.96,
    "linear_damping.B11": 4.4e4, "linear_damping.B33": 1.6e5, "linear_damping.B55": 3.63e8,
}  # fmt: skip
HELP = (
    "Motions of floating-wind platforms in waves, and the coefficients that make them follow a basin test.\n\n"
    "A platform is one YAML file: hull members, mass, mooring, starting coefficients. A campaign is a folder: that "
    "file, a campaign.yaml that says what was measured in which columns, and one data file per test."
)
EPILOG = "\n\n".join((
    "[bold]Examples[/bold]",
    "jaxhydro demo --out demo",
    "jaxhydro simulate volturnus-s --release surge=5 --release pitch=3 --out decay",
    "jaxhydro calibrate my-campaign --out results",
    "[bold]Formats[/bold]",
    "docs/formats.md describes every key of platform and campaign files, and of the results. The demo's own files are the "
    "example to copy: `jaxhydro demo` prints where they are.",
    "Exit status: 0 done; 2 the input is wrong; 3 not converged, with what was reached written and marked so.",
))  # fmt: skip


class Guarded(TyperGroup):
    """Bad input is answered with a message and exit status 2, never with a traceback."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command."""
        try:
            return super().invoke(ctx)
        except InputError as error:
            complain(str(error))
            raise typer.Exit(BAD_INPUT) from None
        except KeyboardInterrupt:
            complain("stopped; nothing was written")
            raise typer.Exit(STOPPED) from None
        except RuntimeError as error:
            from jaxhydro.statics import EquilibriumError

            if not isinstance(error, EquilibriumError):
                raise
            complain(str(error))
            raise typer.Exit(BAD_INPUT) from None


app = typer.Typer(
    cls=Guarded, help=HELP, epilog=EPILOG, no_args_is_help=True, add_completion=False, rich_markup_mode="rich",
    pretty_exceptions_enable=False, context_settings={"help_option_names": ["-h", "--help"]},
)  # fmt: skip
Out = Annotated[Path, typer.Option("--out", help="Folder for the results; made where absent.", show_default=False)]


def main() -> None:
    """The entry point."""
    app()


def _version(wanted: bool) -> None:
    if wanted:
        import jaxhydro

        say(f"jaxhydro {jaxhydro.__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    pass


@app.command()
def simulate(
    platform: Annotated[str, typer.Argument(help="A platform file, or a built-in name (see `jaxhydro platforms`).")],
    out: Out,
    duration: Annotated[float, typer.Option(help="Simulated time, s.")] = 600.0,
    dt: Annotated[float, typer.Option("--dt", help="Time between the samples that are written, s.")] = 0.1,
    release: Annotated[
        list[str] | None, typer.Option(help="Offset from rest at the start, m or deg, as surge=5; once per motion.")
    ] = None,
    wave_height: Annotated[float | None, typer.Option(help="Regular waves: height crest to trough, m.")] = None,
    wave_period: Annotated[float | None, typer.Option(help="Regular waves: period, s.")] = None,
    heading: Annotated[float, typer.Option(help="Where the waves run to, deg from x towards y.")] = 0.0,
    calibration: Annotated[Path | None, typer.Option(help="A calibration.json whose values are to be used.")] = None,
    step: Annotated[float | None, typer.Option(help="Largest internal time step, s.", show_default="chosen")] = None,
) -> None:
    """Free decay from an offset, and regular waves: motion.csv, simulated.nc and a figure."""
    offset = options.releases(release or [])
    duration = options.positive(duration, "--duration")
    dt = options.interval(dt, "--dt", duration)
    step = None if step is None else options.interval(step, "--step", duration)
    wave = options.regular(wave_height, wave_period)
    if wave is None and not offset:
        raise options.wrong("--release", "nothing moves: give --release, or --wave-height and --wave-period")
    if not math.isfinite(heading):
        raise options.wrong("--heading", f"a finite number expected, found {heading:g}")
    out = options.results_folder(out, "calibration.json", "a calibration")
    _start()
    from jaxhydro.command import run

    if not run(_model(platform, calibration), platform, out, duration, dt, offset, wave, heading, step):
        raise typer.Exit(NOT_CONVERGED)


@app.command()
def calibrate(
    campaign: Annotated[Path, typer.Argument(help="A campaign's folder, or its campaign.yaml.")],
    out: Out,
    figures: Annotated[bool, typer.Option(help="Draw figures.")] = True,
) -> None:
    """Fit a platform's coefficients to the tests marked `fit`: calibration.json, simulated.nc, figures."""
    _calibrate(campaign, out, figures)


@app.command()
def report(folder: Annotated[Path, typer.Argument(help="A folder that `jaxhydro calibrate` wrote.")]) -> None:
    """Make one self-contained HTML page, report.html, of what is in a result folder."""
    from calibration.report import write_report

    say(f"{write_report(folder)}")


@app.command()
def demo(out: Out = Path("jaxhydro-demo")) -> None:
    """Calibrate to the nine embedded decays of VolturnUS-S, compare with the true coefficients, make a page."""
    from importlib import resources

    folder = Path(str(resources.files("jaxhydro") / "campaigns" / DEMO))
    say(f"The campaign is in {folder}")
    _calibrate(folder, out, True, TRUTH)


@app.command()
def platforms() -> None:
    """List the built-in platforms."""
    _start()
    from jaxhydro.command import particulars
    from jaxhydro.platform_schema import builtin_platforms

    heads = ("Name", "Platform", "Mass (t)", "Volume (m³)", "Surge (s)", "Heave (s)", "Pitch (s)")
    table("Built-in platforms and their natural periods", heads, [particulars(name) for name in builtin_platforms()], 2)


def _calibrate(campaign: Path, out: Path, figures: bool, truth: dict[str, float] | None = None) -> None:
    """Calibrate; where the truth is known, compare with it and make the report page."""
    out = options.results_folder(out, "motion.csv", "a simulation")
    _start()
    from calibration import command

    result = command.run(command.load(campaign, out), out, figures)
    if result is not None and truth is not None:
        from calibration.report import write_report
        from calibration.tables import against

        table("Against the true coefficients", *against(result, truth))
        say(f"Open {write_report(out)}")
    if result is None or not result.converged:
        raise typer.Exit(NOT_CONVERGED)


def _start() -> None:
    """Set JAX up: double precision, and a compilation cache that lasts, unless its folder cannot be written."""
    import jax

    jax.config.update("jax_enable_x64", True)
    home = os.environ.get("XDG_CACHE_HOME") or Path("~/.cache")
    try:
        default = Path(home).expanduser() / "jaxhydro" / "xla"
        folder = Path(os.environ.get("JAX_COMPILATION_CACHE_DIR") or default)
        folder.mkdir(parents=True, exist_ok=True)
    except (OSError, RuntimeError):
        return
    if os.access(folder, os.W_OK):
        jax.config.update("jax_compilation_cache_dir", str(folder))
        jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
        jax.config.update("jax_persistent_cache_min_entry_size_bytes", -1)


def _model(platform: str, calibration: Path | None) -> "Model":
    from jaxhydro.platform import load_model

    model = load_model(platform)
    if calibration is None:
        return model
    from calibration.saved import read_saved
    from jaxhydro.platform_schema import load_platform

    saved, known = read_saved(calibration), model.values
    values = saved.values()
    if unknown := [label for label in values if label not in known]:
        expected = f"parameters of {platform} ({', '.join(sorted(known)) or 'it has none'})"
        hint = suggest(unknown[0], known)
        raise InputError(str(calibration), [Problem("baseline.parameters", expected, ", ".join(map(shown, unknown)), hint)])
    name = load_platform(platform).name
    if saved.platform and saved.platform != name:
        complain(f"warning: {calibration} is a calibration of {saved.platform!r}, and its values are used for {name!r}")
    say(f"Calibrated values used: {', '.join(values)}")
    if vague := [label for label, one in saved.baseline.parameters.items() if not one.identifiable]:
        complain(f"warning: among them the records did not determine {', '.join(vague)}")
    return model.with_values(values)
