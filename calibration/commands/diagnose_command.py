"""Command `diagnose`: from a campaign to result files and tables."""

from dataclasses import replace
from pathlib import Path

from calibration.campaign.grouped_findings import group_findings
from calibration.campaign.manifest_sections import IN_WAVES
from calibration.commands.loaded_campaign import load
from calibration.discovery.checkpoint import CHECKPOINT_FILE
from calibration.discovery.diagnosis import Diagnosis, Outcome
from calibration.report import diagnosis_tables as tables
from calibration.report import diagnosis_words as words
from calibration.report import tables as calibrations
from calibration.report.effect_alternatives import effect_in_three_lines
from calibration.residuals.measured_seas import Diverged
from calibration.results.diagnosis_file import DiagnosisFile, read_diagnosis
from calibration.results.result_folder import DIAGNOSIS_FILE
from calibration.results.write_calibration import NotFinite
from calibration.results.write_diagnosis import write_diagnosis
from jaxhydro.cli.console import complain, progress, say, table


def diagnose_campaign(path: Path, out: Path, figures: bool = True) -> bool:
    """Diagnose a campaign, write and print the result.

    If the user stops the search, the result covers the effects found so far. A search that was stopped or killed goes on from
    the last effect that it had let in.

    Args:
        path: Folder or manifest of the campaign.
        out: Folder of the results.
        figures: Whether figures are written.

    Returns:
        False where a fit did not converge. The result is then marked so, or there is none.

    Raises:
        InputError: The campaign cannot be read.
        KeyboardInterrupt: The user stopped the search before anything was reached.
    """
    from calibration.discovery.diagnose import diagnose

    stopped = False
    campaign = load(path, out, lambda c: calibrations.count_tests(c, ("decay", *IN_WAVES)))
    try:
        with progress() as show:
            result = diagnose(campaign.model, campaign, progress=show, checkpoint=out / CHECKPOINT_FILE)
    except Diverged as error:
        complain(f"{error}; nothing was written")
        return False
    except KeyboardInterrupt as stop:
        partial, stopped = getattr(stop, "partial", None), True
        if not isinstance(partial, Diagnosis):
            if (out / CHECKPOINT_FILE).exists():
                raise KeyboardInterrupt(f"stopped; the same command goes on from what was reached, which is in {out}") from None
            raise
        result = mark_unfinished(partial)
    try:
        write_diagnosis(result, out, figures)
    except NotFinite as error:
        complain(f"not converged: {error}; nothing was written")
        return False
    if not stopped:
        (out / CHECKPOINT_FILE).unlink(missing_ok=True)
    saved = read_diagnosis(out / DIAGNOSIS_FILE)
    warned = {str(finding) for finding in group_findings(campaign.findings)}
    show_diagnosis(saved, [note for note in saved.notes if note not in warned])
    say(f"Results are in {out}; `jaxhydro report {out}` makes a page of them")
    if stopped:
        complain("stopped before it was done: the results are marked so, and the same command goes on from what was reached")
    elif not saved.converged:
        complain("not converged: the results are marked so")
    return saved.converged


def mark_unfinished(partial: Diagnosis) -> Diagnosis:
    """Mark a diagnosis that the user stopped as not complete and not converged.

    Only a whole search can find that nothing is missing. The verdict of a stopped one is then "unexplained".
    """
    verdict = Outcome.UNEXPLAINED if partial.verdict == Outcome.NOTHING_MISSING else partial.verdict
    fitted, notes = replace(partial.augmented, converged=False), (words.STOPPED, *partial.notes)
    return replace(partial, augmented=fitted, notes=notes, verdict=verdict, complete=False)


def show_diagnosis(saved: DiagnosisFile, notes: list[str]) -> None:
    """Print a diagnosis: tables, notes, and then the verdict with its effects.

    Args:
        saved: The diagnosis as it was written.
        notes: Notes to print.
    """
    if (rows := tables.anatomy(saved))[1]:
        table("What the fitted baseline leaves over", *rows, left=4)
    table("Coefficients, fitted before and after", *tables.coefficients(saved))
    if (rows := tables.nearly_known(saved))[1]:
        table(tables.VARIED, *rows)
    if (rows := tables.rejected(saved))[1]:
        table("Tried and rejected", *rows, left=2)
    table("Errors over the motion's standard deviation, before and after", *tables.errors(saved), left=3)
    if (rows := tables.bands(saved))[1]:
        table("Errors of energy in bands", *rows, left=4)
    if (rows := tables.predictions(saved))[1]:
        table("Bands in which 95 % of the samples of held-out tests are expected", *rows, left=3)
    if (rows := tables.effects(saved))[1]:
        table("What was found", *rows, left=2)
    for note in notes:
        say(f"Note: {note}")
    say(f"\n{words.verdict_sentence(saved)}", "bold")
    for effect in saved.missing.effects:
        for line in effect_in_three_lines(saved, effect):
            say(line)
    say(words.describe_unexplained(saved))
    for force in saved.missing.unexplained.forces:
        say(force.words)
    if saved.next_test:
        say(f"Next test: {saved.next_test}")
