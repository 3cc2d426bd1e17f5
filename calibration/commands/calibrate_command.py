"""Commands `calibrate`, and `simulate` in the measured waves of a campaign."""

import shlex
import time as clock
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from calibration.campaign.grouped_findings import group_findings
from calibration.campaign.load_campaign import Campaign, load_campaign
from calibration.campaign.manifest import IN_WAVES
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
    """The campaign, its warnings printed. Raises InputError, also where results would replace its own data."""
    campaign = load_campaign(path)
    for test in campaign.manifest.tests:
        if (campaign.folder / test.file).resolve() == (out / MOTION_FILE).resolve():
            found = f"{str(out)!r}, where {MOTION_FILE} is the data of test {test.id}"
            raise InputError("--out", [Problem("", "another folder", found)])
    say(f"{campaign.manifest.name}: {counted(campaign)}")
    if (band := band_sentence(campaign.manifest, campaign.model, campaign.records)) is not None:
        say(f"{band[0].upper()}{band[1:]}")
    if campaign.findings:
        table("Warnings", *tables.findings(campaign.findings), left=4, stderr=True)
    return campaign


def load_fitted(path: Path, out: Path, tests: str | None = None) -> tuple[Campaign, str]:
    """`load` for a calibration, and to which tests it is: as asked for ("decays", "waves", "all"), else to the decays, or where
    there is none to fit, to the tests in waves."""

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
    """Calibrate, write and print the result; of a fit that the user stops, what was reached; None if that is no number.

    `tests`: to "decays", to those in "waves" or to "all" kinds; in waves by `objective`. `law`, of tests in waves alone: how
    coefficients depend on the sea state, a `Law` or "choose". `loss` is that of all kinds together. `start` is a calibration
    whose values are begun from; `method` a global search of the decays' coefficients that finds them, from a `seed` and in so
    many CPU `seconds`. `truth` are a synthetic campaign's true coefficients: they are compared with, and a report page is
    made. Raises InputError, and Interrupted where nothing was reached.
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
        declared = campaign.model
        used = apply_calibration(start, declared, campaign.platform.name)
        # what a law adds is begun from in waves only; effects found are not declared
        known = [k for k in used.values if k in declared.values or (tests == "waves" and k in law_labels(declared))]
        begin = {"start": {k: used.values[k] for k in known}}
        _calibrated_values(used._replace(values=begin["start"]), start, campaign)
        if used.strips is not None:
            complain(f"warning: values are begun from, strips stay as the platform file has them: {start} has {used.strips}")
        if tests != "decays" and used.seas is not None and (said := non_default_options(used.seas, (), options_of(campaign))):
            complain(f"warning: waves are taken as the campaign states; for {start} they were otherwise: {said}")
    words: tuple[str, ...] = ()
    if method is not None:
        values, said = _run_search(campaign, seed, seconds)
        begin, words = {"begin": values}, (f"begun from a search: {said}",)
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
    if tests == "decays" and any(not one.identifiable for one in saved.baseline.parameters.values()):
        said = f"jaxhydro uncertainty {shlex.quote(str(campaign.folder))} --calibration {shlex.quote(str(out))} --profile '*'"
        say(f"Intervals of what is not determined: {said}")
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
        if said := tables.damping_outside(saved):
            complain(f"warning: {said[0].lower()}{said[1:]}")
    if (energies := tables.bands(saved))[1]:
        table("Errors of energy in bands", *energies, left=4)


def _run_search(campaign: Campaign, seed: int, seconds: float) -> tuple[dict[str, float], str]:
    """Where a global search ends, and what it took; stopped by the user, where it has got to."""
    try:
        with progress() as show:
            found = search(campaign, seed=seed, budget=Budget(seconds), progress=show)
    except ValueError as error:
        raise InputError("--method", [Problem("", "a search that can be run", str(error))]) from None
    except SearchInterrupted as stopped:
        if stopped.partial is None:
            raise
        found = stopped.partial
    spent = f"{found.simulations:.0f} simulations, {found.seconds:.0f} s CPU"
    words = f"{found.method}, seed {seed}, J {found.objective:.4g}, {spent}; {SEARCH_ENDINGS[found.ended]}"
    say(f"Search: {words}")
    return found.values, words


def simulate_campaign(
    campaign: Path,
    out: Path,
    *,
    calibration: Path | None,
    asked: Mapping[str, Any] | None = None,
    figures: bool = True,
) -> bool:
    """Simulate a campaign's tests in their measured waves, compare, write and print; False where a motion grows without bound.

    `asked` are fields of `Options`; others are those of a diagnosis of this campaign, but for how waves are bound and act where
    the order is asked for. Raises InputError, EquilibriumError.
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
    if seas is not None and (said := non_default_options(options, asked)):
        say(f"Seas as they were when these were found: {said}")
    stable_modes(model)
    try:
        found = compare(loaded, model, options, lambda line: say(line, stderr=True))
    except Diverged as error:
        complain(f"{error}; nothing was written")
        return False
    content = document(
        found,
        options,
        campaign=loaded.manifest.name,
        platform=loaded.platform.name,
        calibration=None if calibration is None else str(calibration),
        applied=used,
    )
    written = write_comparison(found, content, out, figures)
    for note in written.warnings:
        complain(f"warning: {note}")
    table("Waves", *sea_tables.seas_table(written), left=3)
    table("Motions", *sea_tables.motions_table(written), left=2)
    say(f"Spectra: {written.options.spectra}")
    table("Energy in bands", *sea_tables.bands_table(written), left=3)
    say(f"Results are in {out}, after {clock.monotonic() - begun:.0f} s")
    return True


def _calibrated_values(used: AppliedCalibration, source: Path, campaign: Campaign) -> None:
    """Which calibrated values are used, and what is to be said of them."""
    if used.campaign != campaign.manifest.name:
        complain(f"warning: {source} is a calibration of {used.campaign!r}, used for {campaign.manifest.name!r}")
    say(f"Calibrated values used: {', '.join(used.values)}")
    if used.not_used:
        say(f"Not used, the campaign has its own: {', '.join(used.not_used)}")
    if used.undetermined:
        complain(f"warning: the records of that calibration did not determine {', '.join(used.undetermined)}: they say little")
