"""Command `calibrate`: from a campaign to result files and tables."""

import shlex
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from calibration.campaign.grouped_findings import group_findings
from calibration.campaign.load_campaign import Campaign
from calibration.campaign.manifest_sections import IN_WAVES
from calibration.commands.loaded_campaign import load, print_calibrated_values
from calibration.fitting.decay_calibration import calibrate
from calibration.fitting.joint_fit import calibrate_jointly
from calibration.fitting.law_choice import SeaLaws, choose_law
from calibration.fitting.law_parameters import LAWS
from calibration.fitting.progress import Interrupted
from calibration.fitting.sea_fit import calibrate_in_waves
from calibration.fitting.weighted_residuals import Loss
from calibration.global_search.multistart import MultiStart
from calibration.global_search.run_search import SearchInterrupted, search
from calibration.global_search.task import Budget
from calibration.report import tables
from calibration.report.sea_state_law_tables import laws_table, sentence, states_table
from calibration.report.summary import calibration_sentence, summary_of
from calibration.residuals.measured_seas import Diverged
from calibration.residuals.seas import Objective
from calibration.residuals.wave_options import non_default_options, options_of
from calibration.result import Calibration
from calibration.results.applied_calibration import apply_calibration
from calibration.results.calibration_file import CalibrationFile, read_saved
from calibration.results.result_folder import RESULT_FILE
from calibration.results.write_calibration import NotFinite, write_calibration
from calibration.results.write_laws import write_laws
from jaxhydro.cli.console import complain, progress, say, table
from jaxhydro.errors import InputError, Problem, shown
from jaxhydro.platform.drag_laws import law_labels

SEARCH_METHODS = (MultiStart.name,)
SEARCH_SECONDS = 60.0  # CPU time of a search
SEARCH_ENDINGS = {
    "settled": "ended of its own",
    "reached": "ended of its own",
    "budget": "cut off by --search-seconds",
    "interrupted": "stopped by the user",
}


def load_fitted(path: Path, out: Path, tests: str | None = None) -> tuple[Campaign, str]:
    """Load a campaign for a calibration, and choose the kind of tests to fit.

    Args:
        path: Folder or manifest of the campaign.
        out: Folder of the results.
        tests: "decays", "waves" or "all"; None: the decays, or the tests in waves where no decay is to be fitted.

    Returns:
        The campaign, and the kind of tests.

    Raises:
        InputError: The campaign cannot be read, or results would replace its own data.
    """

    def kind(campaign: Campaign) -> str:
        kinds = {test.kind for test in campaign.manifest.tests if test.use == "fit"}
        return tests or ("waves" if "decay" not in kinds and kinds & set(IN_WAVES) else "decays")

    used = {"decays": ("decay",), "waves": IN_WAVES, "all": ("decay", *IN_WAVES, "static")}
    loaded = load(path, out, counted=lambda campaign: tables.count_tests(campaign, used[kind(campaign)]))
    return loaded, kind(loaded)


def run(
    campaign: Campaign,
    out: Path,
    figures: bool = True,
    *,
    tests: str = "decays",
    objective: Objective = "bands",
    law: str = "constant",
    loss: Loss = "squares",
    truth: Mapping[str, float] | None = None,
    start: Path | None = None,
    method: str | None = None,
    seed: int = 0,
    seconds: float = SEARCH_SECONDS,
) -> Calibration | None:
    """Calibrate a campaign, write and print the result.

    Args:
        campaign: The campaign.
        out: Folder of the results.
        figures: Whether figures are written.
        tests: Fitted tests: "decays", those in "waves", or "all" kinds.
        objective: Objective of tests in waves.
        law: How coefficients depend on the sea state: a `Law`, or "choose". For tests in waves alone.
        loss: Loss of all kinds of tests together.
        truth: True coefficients of a synthetic campaign. The result is compared with them, and a report page is made.
        start: Calibration whose values the fit begins from.
        method: Global search of the decays' coefficients whose result the fit begins from, "multistart"; None: no search.
        seed: Seed of the search.
        seconds: CPU time of the search (s).

    Returns:
        The calibration. After an interruption by the user, it is what was reached. None where values are not finite.

    Raises:
        InputError: Arguments do not fit together.
        Interrupted: The user stopped the fit before anything was reached.
        SearchInterrupted: The user stopped the search before anything was reached.
    """
    if law != "constant" and tests != "waves":
        raise InputError("--law", [Problem("", f"--tests waves beside {law.replace('_', '-')}", f"--tests {tests}")])
    if loss != "squares" and tests != "all":
        raise InputError("--loss", [Problem("", f"--tests all beside {loss}", f"--tests {tests}")])
    if objective != "bands" and tests == "decays":
        expected = "--tests waves or all beside it: decays are fitted to their motion"
        raise InputError("--objective", [Problem("", expected, "--tests decays")])
    if method not in (None, *SEARCH_METHODS):
        raise InputError("--method", [Problem("", " or ".join(SEARCH_METHODS), shown(method))])
    if method is None and (seed, seconds) != (0, SEARCH_SECONDS):
        raise InputError("--method", [Problem("", "a search beside --search-seed and --search-seconds", "none")])
    if law == "choose" and objective != "bands":
        raise InputError("--objective", [Problem("", "bands, by which laws are chosen", objective)])
    if method is not None and tests == "waves":
        raise InputError("--method", [Problem("", "--tests decays or all, since decays are searched with", f"--tests {tests}")])
    if method is not None and start is not None:
        raise InputError("--method", [Problem("", "no --start beside it", f"--start {start}")])
    laws: SeaLaws | None = None
    begin: dict[str, Any] = {}
    if start is not None:
        model = campaign.model
        used = apply_calibration(start, model, campaign.platform.name)
        # what a law adds is begun from in waves only; effects found are not declared
        labels = [k for k in used.values if k in model.values or (tests == "waves" and k in law_labels(model))]
        begin = {"start": {k: used.values[k] for k in labels}}
        print_calibrated_values(used._replace(values=begin["start"]), start, campaign)
        if used.strips is not None:
            complain(f"warning: values are begun from, strips stay as the platform file has them: {start} has {used.strips}")
        if (
            tests != "decays"
            and used.seas is not None
            and (changes := non_default_options(used.seas, (), options_of(campaign)))
        ):
            complain(f"warning: waves are taken as the campaign states; for {start} they were otherwise: {changes}")
    words: tuple[str, ...] = ()
    if method is not None:
        values, description = _run_search(campaign, seed, seconds)
        begin, words = {"begin": values}, (f"begun from a search: {description}",)
    try:
        with progress() as show:
            if law == "choose":
                laws = choose_law(campaign, progress=show, **begin)
                result = laws.chosen.calibration if laws.finished else tables.mark_unfinished(laws.chosen.calibration)
            elif tests == "all":
                result = calibrate_jointly(campaign, progress=show, objective=objective, loss=loss, **begin)
            elif tests == "waves":
                over, drag = LAWS[law]
                result = calibrate_in_waves(campaign, progress=show, objective=objective, over=over, drag=drag, **begin)
            else:
                result = calibrate(campaign, progress=show, **begin)
    except Diverged as error:
        complain(f"{error}; nothing was written")
        return None
    except Interrupted as stopped:
        if stopped.partial is None:
            raise
        result = tables.mark_unfinished(stopped.partial)
    result = replace(result, notes=(*words, *result.notes))
    try:
        write_calibration(result, out, figures, truth)
        if laws is not None:
            write_laws(laws, out, figures)
    except NotFinite as error:
        complain(f"not converged: {error}; nothing was written")
        return None
    saved = read_saved(out / RESULT_FILE)
    _print_results(saved)
    if laws is not None:
        table("Laws over the sea state: error of ln(energy) in bands, root mean square", *laws_table(laws), left=1)
        table("Coefficients of one sea alone | by the chosen law", *states_table(laws), left=1)
        say(sentence(laws))
    warned = {str(finding) for finding in group_findings(campaign.findings)}
    for note in result.notes:
        if note not in warned:
            say(f"Note: {note}")
    say(tables.outcome_sentence(saved))
    if truth is not None:
        table("Against the true coefficients", *tables.comparison_with_truth(saved))
        say(tables.agreement_with_truth(saved))
    say(f"Results are in {out}; `jaxhydro report {out}` makes a page of them" if truth is None else f"Open {_report(out)}")
    if tests == "decays" and any(not parameter.identifiable for parameter in saved.baseline.parameters.values()):
        command = (
            f"jaxhydro uncertainty {shlex.quote(str(campaign.folder))} --calibration {shlex.quote(str(out))} --profile '*'"
        )
        say(f"Intervals of what is not determined: {command}")
    if not result.converged:
        complain("not converged: the results are marked so")
    say(calibration_sentence(summary_of(saved)), "bold")
    return result


def _report(out: Path) -> Path:
    """Write the report page of the results in a folder."""
    from calibration.report.write_report import write_report  # with the pages of sweeps, which take long to import

    return write_report(out)


def _print_results(saved: CalibrationFile) -> None:
    """Print the tables of a written calibration."""
    heads, rows = tables.parameters(saved)
    table("Parameters", (heads[0], *heads[2:]), [(row[0], *row[2:]) for row in rows])
    heads, rows = tables.errors(saved)
    table("Errors: RMSE over the motion's standard deviation, before and after", heads, rows, left=5)
    if (damping := tables.linear_quadratic(saved))[1]:
        table(tables.CLASSICAL, *damping)
        if warning := tables.damping_outside(saved):
            complain(f"warning: {warning[0].lower()}{warning[1:]}")
    if (energies := tables.bands(saved))[1]:
        table("Errors of energy in bands", *energies, left=4)


def _run_search(campaign: Campaign, seed: int, seconds: float) -> tuple[dict[str, float], str]:
    """Run a global search and print what it took.

    Returns:
        Values at its end, or those that were reached when the user stopped it; and what it took, in words.
    """
    try:
        with progress() as show:
            result = search(campaign, seed=seed, budget=Budget(seconds), progress=show)
    except ValueError as error:
        raise InputError("--method", [Problem("", "a search that can be run", str(error))]) from None
    except SearchInterrupted as stopped:
        if stopped.partial is None:
            raise
        result = stopped.partial
    spent = f"{result.simulations:.0f} simulations, {result.seconds:.0f} s CPU"
    words = f"{result.method}, seed {seed}, J {result.objective:.4g}, {spent}; {SEARCH_ENDINGS[result.ended]}"
    say(f"Search: {words}")
    return result.values, words
