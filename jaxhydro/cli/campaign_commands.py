"""Commands on a campaign: folder, check, calibration, diagnosis, uncertainty and report page.

Each command imports what it needs.
"""

import math
from pathlib import Path
from typing import Annotated, Any

import typer

from jaxhydro.cli import arguments, option_choices, options
from jaxhydro.cli.console import say
from jaxhydro.cli.exit_status import NOT_CONVERGED
from jaxhydro.files import campaign_file

MAX_SCALE = 1e5  # that a campaign takes
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
        str | None,
        typer.Option(help="Froude length scale of the records: 70, or 1:70, for a model at 1:70.", show_default="1"),
    ] = None,
) -> None:
    """Make a campaign folder: platform.yaml, a commented campaign.yaml, and your data files.

    Columns, units, kinds of tests and released motions are guessed from the data files. Each guess is marked CHECK in
    campaign.yaml. Without data files, campaign.yaml is an example to edit.
    """
    froude = None if scale is None else _length_scale(scale)
    from calibration.commands.init_command import init_campaign

    init_campaign(folder, platform, froude, files or [])


def _length_scale(text: str) -> float:
    """Froude length scale of an option: 70 of "70" or "1:70"."""
    try:
        scale = float(text.removeprefix("1:"))
    except ValueError:
        scale = math.nan
    if not 1 <= scale <= MAX_SCALE:
        expected = f"full-scale length over model length, 1 to {MAX_SCALE:g}: 70 or 1:70"
        raise options.wrong("--scale", f"{expected} expected; found {text}")
    return scale


def check(
    campaign: arguments.Campaign,
    out: Annotated[Path | None, typer.Option("--out", help="Folder for figures of the hull and of every record.")] = None,
) -> None:
    """Read a campaign and show its tests, natural periods beside the model's, and warnings.

    Nothing is fitted.
    """
    campaign_file(campaign)
    drawn = None if out is None else options.check_folder(out)
    from calibration.commands.check_command import check_campaign

    check_campaign(campaign, drawn)


def calibrate(
    campaign: arguments.Campaign,
    out: arguments.Out = None,
    figures: arguments.Figures = True,
    tests: arguments.Tests = None,
    objective: arguments.Aim = option_choices.Objective.bands,
    law: arguments.OverSea = option_choices.Law.constant,
    loss: arguments.Robust = option_choices.Loss.squares,
    method: arguments.GlobalSearch = None,
    search_seed: arguments.SearchSeed = 0,
    search_seconds: arguments.SearchSeconds = 60.0,
    start: arguments.Begin = None,
) -> None:
    """Fit a platform's coefficients to the tests marked `fit`: calibration.json, simulated.nc, figures.

    The free decays are fitted where there are any, else the tests in irregular and regular waves. With `--tests all` both are
    fitted together, with static offsets and the natural periods that campaign.yaml states.
    """
    kind = None if tests is None else tests.value
    how: dict[str, Any] = {"objective": objective.value, "law": law.value.replace("-", "_"), "loss": loss.value, "start": start}
    how |= {"method": method, "seed": search_seed, "seconds": search_seconds}
    _calibrate(campaign, out, figures, None, kind, **how)


def diagnose(
    campaign: arguments.Campaign,
    out: arguments.Out = None,
    figures: arguments.Figures = True,
) -> None:
    """Fit a platform's coefficients, then find the effects that the model lacks.

    Each effect is found with its name, its size and the evidence.

    The model is first fitted to the tests marked `fit`: this is the baseline. All effects that could be missing are then
    compared, alone and together. Each effect of the most probable set is taken out in turn. It stays only where the tests
    marked `holdout` ask for it; where there are none, blocks of the fitted ones are left out in turn. Nothing in the campaign
    has to name an effect. The answer may be that nothing is missing, or that something is and none of the known effects
    explains it.
    """
    campaign_file(campaign)
    out = options.results_folder(out, "diagnosis.json", campaign)
    from calibration.commands.diagnose_command import diagnose_campaign

    if not diagnose_campaign(campaign, out, figures):
        raise typer.Exit(NOT_CONVERGED)


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
    """Uncertainty of the coefficients that a calibration of free decays found, as intervals.

    The residual of a fit is mostly the model's own error. It lasts from sample to sample: it is coloured. Intervals of the
    fit's covariance allow for this. On request also profiles of the likelihood, a bootstrap, and draws from the posterior.
    """
    campaign_file(campaign)
    out = options.results_folder(out, "uncertainty.json", campaign)
    from calibration.commands.uncertainty_command import quantify

    how: dict[str, Any] = {"draws": bootstrap, "nuts": nuts, "level": level, "seed": seed, "figures": figures}
    if not quantify(campaign, calibration, out, profiles=profiles or (), **how):
        raise typer.Exit(NOT_CONVERGED)


def report(
    folder: Annotated[
        Path,
        typer.Argument(help="A folder that `jaxhydro simulate`, `calibrate`, `diagnose`, `uncertainty` or `sweep` wrote."),
    ],
) -> None:
    """Make one self-contained HTML page, report.html, of a result folder."""
    options.check_results(folder)
    from calibration.report.write_report import write_report

    say(f"{write_report(folder)}")


def demo(out: Annotated[Path, typer.Option("--out", help=arguments.OUT)] = Path("jaxhydro-demo")) -> None:
    """Calibrate to the nine embedded decays of VolturnUS-S and compare with the true coefficients.

    A report page is made, too.
    """
    from importlib import resources

    folder = Path(str(resources.files("jaxhydro") / "campaigns" / DEMO))
    say(f"The campaign is in {folder}")
    _calibrate(folder, out, True, TRUTH)


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
