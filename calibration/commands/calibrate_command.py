"""Commands `calibrate`, and `simulate` in the measured waves of a campaign."""

import shlex
import time as clock
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from calibration.campaign.grouped_findings import group_findings
from calibration.campaign.load_campaign import Campaign, load_campaign
from calibration.campaign.manifest_sections import IN_WAVES
from calibration.campaign.wave_band import band_sentence
from calibration.fitting.decay_fit import calibrate
from calibration.fitting.joint_fit import calibrate_jointly
from calibration.fitting.law_choice import SeaLaws, choose_law
from calibration.fitting.law_parameters import LAWS
from calibration.fitting.progress import Interrupted
from calibration.fitting.sea_fit import calibrate_in_waves
from calibration.fitting.weighted_residuals import Loss
from calibration.global_search.run_search import SearchInterrupted, search
from calibration.global_search.task import Budget
from calibration.report import sea_tables, tables
from calibration.report.sea_state_law_tables import laws_table, sentence, states_table
from calibration.report.summary import calibration_sentence, summary_of
from calibration.report.write_report import write_report
from calibration.residuals.measured_seas import Diverged, compare
from calibration.residuals.seas import Objective
from calibration.residuals.wave_options import Options, non_default_options, options_of
from calibration.result import Calibration
from calibration.results.applied_calibration import AppliedCalibration, apply_calibration
from calibration.results.calibration_file import CalibrationFile, read_saved
from calibration.results.result_folder import MOTION_FILE, RESULT_FILE
from calibration.results.write_calibration import NotFinite, write_calibration
from calibration.results.write_comparison import document, write_comparison
from calibration.results.write_laws import write_laws
from jaxhydro.cli.console import complain, progress, say, table
from jaxhydro.dynamics.statics import stable_modes
from jaxhydro.errors import InputError, Problem
from jaxhydro.platform.drag_laws import law_labels

SEARCH_SECONDS = 60.0  # CPU time of a search
SEARCH_ENDINGS = {
    "settled": "ended of its own",
    "reached": "ended of its own",
    "budget": "cut off by --search-seconds",
    "interrupted": "stopped by the user",
}


def load(path: Path, out: Path, counted: Callable[[Campaign], str] = tables.count_tests) -> Campaign:
    """Load a campaign and print its tests and warnings.

    Args:
        path: Folder or manifest of the campaign.
        out: Folder of the results.
        counted: Makes the text on its tests that is printed.

    Raises:
        InputError: The campaign cannot be read, or results would replace its own data.
    """
    campaign = load_campaign(path)
    for test in campaign.manifest.tests:
        if (campaign.folder / test.file).resolve() == (out / MOTION_FILE).resolve():
            actual = f"{str(out)!r}, where {MOTION_FILE} is the data of test {test.id}"
            raise InputError("--out", [Problem("", "another folder", actual)])
    say(f"{campaign.manifest.name}: {counted(campaign)}")
    if (band := band_sentence(campaign.manifest, campaign.model, campaign.records)) is not None:
        say(f"{band[0].upper()}{band[1:]}")
    if campaign.findings:
        table("Warnings", *tables.findings(campaign.findings), left=4, stderr=True)
    return campaign


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
        method: Global search of the decays' coefficients, whose result the fit begins from.
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
        _calibrated_values(used._replace(values=begin["start"]), start, campaign)
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
    say(f"Results are in {out}; `jaxhydro report {out}` makes a page of them" if truth is None else f"Open {write_report(out)}")
    if tests == "decays" and any(not parameter.identifiable for parameter in saved.baseline.parameters.values()):
        command = (
            f"jaxhydro uncertainty {shlex.quote(str(campaign.folder))} --calibration {shlex.quote(str(out))} --profile '*'"
        )
        say(f"Intervals of what is not determined: {command}")
    if not result.converged:
        complain("not converged: the results are marked so")
    say(calibration_sentence(summary_of(saved)), "bold")
    return result


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


def simulate_campaign(
    campaign: Path,
    out: Path,
    *,
    calibration: Path | None,
    asked: Mapping[str, Any] | None = None,
    figures: bool = True,
) -> bool:
    """Simulate a campaign's tests in their measured waves, compare, write and print.

    Args:
        campaign: Folder or manifest of the campaign.
        out: Folder of the results.
        calibration: Calibration whose values are used; None: those of the platform file.
        asked: Fields of `Options`. Other fields are those of a diagnosis of this campaign, where the calibration is one. If the
            order is asked for, how waves are bound and act is the default.
        figures: Whether figures are written.

    Returns:
        False where a motion grows without bound.

    Raises:
        InputError: The campaign or the calibration cannot be used.
        EquilibriumError: The platform does not float at rest.
    """
    begun = clock.monotonic()
    loaded = load(campaign, out, sea_tables.counted)
    model, used = loaded.model, None
    if calibration is not None:
        used = apply_calibration(calibration, model, loaded.platform.name)
        model = used.model
        _calibrated_values(used, calibration, loaded)
        if used.strips is not None:
            say(f"Strips as they were when these were found: {used.strips}")
    asked = asked or {}
    seas = used.seas if used is not None and used.campaign == loaded.manifest.name else None
    if seas is not None and "order" in asked:  # with all of theory's second order, then
        seas = replace(seas, **{name: getattr(Options(), name) for name in ("kinds", "highest_difference", "acting")})
    options = replace(seas or options_of(loaded), **asked)
    if not options.cutoff > options.low:
        expected = f"a number above {options.low:g} Hz, where first-order waves begin"
        raise InputError("--cutoff", [Problem("", expected, f"{options.cutoff:g}")])
    if seas is not None and (changes := non_default_options(options, asked)):
        say(f"Seas as they were when these were found: {changes}")
    stable_modes(model)
    try:
        comparison = compare(loaded, model, options, lambda line: say(line, stderr=True))
    except Diverged as error:
        complain(f"{error}; nothing was written")
        return False
    content = document(
        comparison,
        options,
        campaign=loaded.manifest.name,
        platform=loaded.platform.name,
        calibration=None if calibration is None else str(calibration),
        applied=used,
    )
    written = write_comparison(comparison, content, out, figures)
    for note in written.warnings:
        complain(f"warning: {note}")
    table("Waves", *sea_tables.seas_table(written), left=3)
    table("Motions", *sea_tables.motions_table(written), left=2)
    say(f"Spectra: {written.options.spectra}")
    table("Energy in bands", *sea_tables.bands_table(written), left=3)
    say(f"Results are in {out}, after {clock.monotonic() - begun:.0f} s")
    return True


def _calibrated_values(used: AppliedCalibration, source: Path, campaign: Campaign) -> None:
    """Print which calibrated values are used, and warn where they say little."""
    if used.campaign != campaign.manifest.name:
        complain(f"warning: {source} is a calibration of {used.campaign!r}, used for {campaign.manifest.name!r}")
    say(f"Calibrated values used: {', '.join(used.values)}")
    if used.not_used:
        say(f"Not used, the campaign has its own: {', '.join(used.not_used)}")
    if used.undetermined:
        complain(f"warning: the records of that calibration did not determine {', '.join(used.undetermined)}: they say little")
