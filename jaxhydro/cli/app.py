"""Command-line application: its commands, and how mistakes and stops end them."""

import gc
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from jaxhydro.cli import campaign_commands, help_texts, model_commands
from jaxhydro.cli.console import complain, say, warnings_told
from jaxhydro.cli.exit_status import BAD_INPUT, STOPPED
from jaxhydro.errors import InputError
from jaxhydro.interrupts import asked_to_stop, ended_by_signals

STOPPED_MESSAGE = "stopped; nothing was written"
GARBAGE_THRESHOLDS = 100_000, 20, 100  # tracing makes millions of objects that last; Python would search them again and again


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
    help=help_texts.HELP,
    epilog=help_texts.EPILOG,
    no_args_is_help=True,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def main() -> None:
    """Run the command line."""
    gc.set_threshold(*GARBAGE_THRESHOLDS)
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


app.command(epilog=help_texts.EXAMPLES)(model_commands.simulate)
app.command(epilog=help_texts.STATICS)(model_commands.statics)
app.command(epilog=help_texts.STARTING)(campaign_commands.init)
app.command(epilog=help_texts.CONVERTING)(model_commands.convert)
app.command(epilog=help_texts.EXPORTING)(model_commands.export)
app.command()(campaign_commands.check)
app.command(epilog=help_texts.FITTING)(campaign_commands.calibrate)
app.command(epilog=help_texts.DIAGNOSING)(campaign_commands.diagnose)
app.command(epilog=help_texts.QUANTIFYING)(campaign_commands.uncertainty)
app.command()(campaign_commands.report)
app.command()(campaign_commands.demo)
app.command(epilog=help_texts.SWEEPING)(model_commands.sweep)
app.command()(model_commands.schema)
app.command()(model_commands.platforms)
