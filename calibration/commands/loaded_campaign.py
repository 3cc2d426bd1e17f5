"""Loading of a campaign for a command: prints its tests, warnings and calibrated values."""

from collections.abc import Callable
from pathlib import Path

from calibration.campaign.load_campaign import Campaign, load_campaign
from calibration.campaign.wave_band import band_sentence
from calibration.report import tables
from calibration.results.applied_calibration import AppliedCalibration
from calibration.results.result_folder import MOTION_FILE
from jaxhydro.cli.console import complain, say, table
from jaxhydro.errors import InputError, Problem


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


def print_calibrated_values(used: AppliedCalibration, source: Path, campaign: Campaign) -> None:
    """Print which calibrated values are used, and warn where they say little."""
    if used.campaign != campaign.manifest.name:
        complain(f"warning: {source} is a calibration of {used.campaign!r}, used for {campaign.manifest.name!r}")
    say(f"Calibrated values used: {', '.join(used.values)}")
    if used.not_used:
        say(f"Not used, the campaign has its own: {', '.join(used.not_used)}")
    if used.undetermined:
        complain(f"warning: the records of that calibration did not determine {', '.join(used.undetermined)}: they say little")
