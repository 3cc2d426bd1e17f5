"""Command `check`: content of a campaign, and how records and model fit together. Nothing is fitted."""

import shlex
from pathlib import Path

from calibration.campaign.load_campaign import load_campaign
from calibration.parameters.space import match_free_labels
from calibration.plots.check_figures import figures
from calibration.report import check_tables
from calibration.report.tables import findings
from jaxhydro.cli.console import say, table
from jaxhydro.dynamics.statics import natural_modes
from jaxhydro.files import staged
from jaxhydro.plots.style import save, style


def check_campaign(path: Path, out: Path | None) -> None:
    """Read a campaign and print what it holds; draw its hull and records.

    Args:
        path: The campaign's folder, or its campaign.yaml.
        out: Folder of the figures; None: none are drawn.

    Raises:
        InputError: If the campaign cannot be read, or frees what its platform does not have.
    """
    campaign = load_campaign(path)
    wish = campaign.manifest.calibrate
    match_free_labels(campaign.model, (), wish.free, wish.fixed, str(campaign.folder / "campaign.yaml"))
    compared = check_tables.compare_periods(campaign.records, natural_modes(campaign.model))
    scaled = "" if campaign.manifest.scale == 1 else ", at the scale of platform.yaml"
    table(f"{campaign.manifest.name}{scaled}", *check_tables.tests(campaign), left=5)
    if compared:
        table(f"Natural periods{scaled}", *check_tables.periods(compared))
    if campaign.findings:
        table("Warnings", *findings(campaign.findings), left=4)
    if out is not None:
        with style(), staged(out) as temporary:
            for name, figure in figures(campaign):
                save(figure, temporary / name)
        drawn = "The hull and every record are" if campaign.platform.members else "Every record is"
        say(f"{drawn} drawn in {out}")
    doubts = list(check_tables.doubts(campaign, compared))
    say(check_tables.verdict(campaign, doubts))
    if doubts:
        say(f"To look again: jaxhydro check {shlex.quote(str(path))}")
    if any(record.use == "fit" for record in campaign.records):
        say(f"To fit it: jaxhydro calibrate {shlex.quote(str(path))} --out fit")
    else:
        say("Nothing to fit: mark tests `use: fit` in campaign.yaml")
