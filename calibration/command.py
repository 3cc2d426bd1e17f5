"""The calibrate command: from a campaign's folder to files and tables."""

from pathlib import Path

from calibration import tables
from calibration.campaign import Campaign, load_campaign
from calibration.fit import Interrupted, calibrate
from calibration.outputs import MOTION, NotFinite, write_calibration
from calibration.result import Calibration
from jaxhydro.console import complain, progress, say, table
from jaxhydro.problems import InputError, Problem


def load(path: Path, out: Path) -> Campaign:
    """The campaign, its warnings printed. Raises InputError, also where results would replace its own data."""
    campaign = load_campaign(path)
    for test in campaign.manifest.tests:
        if (campaign.folder / test.file).resolve() == (out / MOTION).resolve():
            found = f"{str(out)!r}, where {MOTION} is the data of test {test.id}"
            raise InputError("--out", [Problem("", "another folder", found)])
    say(f"{campaign.manifest.name}: {tables.counted(campaign)}")
    if campaign.findings:
        table("Warnings", *tables.findings(campaign.findings), left=4, stderr=True)
    return campaign


def run(campaign: Campaign, out: Path, figures: bool = True) -> Calibration | None:
    """Calibrate, write and print the result; of a fit that the user stops, what was reached; None if that is no number.

    Raises InputError, and Interrupted where nothing was reached.
    """
    try:
        with progress() as show:
            result = calibrate(campaign, progress=show)
    except Interrupted as stopped:
        if stopped.partial is None:
            raise
        result = tables.unfinished(stopped.partial)
    try:
        write_calibration(result, out, figures)
    except NotFinite as error:
        complain(f"not converged: {error}; nothing was written")
        return None
    table("Parameters", *tables.parameters(result))
    table("Errors, before and after", *tables.errors(result), left=3)
    warned = {str(finding) for finding in campaign.findings}
    for note in result.notes:
        if note not in warned:
            say(f"Note: {note}")
    say(tables.outcome(result))
    say(f"Results are in {out}")
    if not result.converged:
        complain("not converged: the results are marked so")
    return result
