"""Figures of `jaxhydro check`: the hull, and every record as it was read."""

from collections.abc import Iterator

import numpy as np
from matplotlib.figure import Figure

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.records import Record
from jaxhydro.files import safe_name
from jaxhydro.platform.members_build import members_of
from jaxhydro.plots.hull_drawing import hull_figure
from jaxhydro.plots.seas import record_figure
from jaxhydro.plots.style import MEASURED
from jaxhydro.units import unit_of


def figures(campaign: Campaign) -> Iterator[tuple[str, Figure]]:
    """File name and figure, one after the other. Call within `plots.style.style()`."""
    members = members_of(campaign.platform)
    if members:
        yield "hull.png", hull_figure(members, campaign.platform.name)
    for record in campaign.records:
        yield f"record-{safe_name(record.id)}.png", _record(record, campaign.manifest.scale)


def _record(record: Record, scale: float) -> Figure:
    shown = {name: np.degrees(x) if unit_of(name) == "deg" else x for name, x in record.values.items()}
    if record.wave is not None:
        shown = {"wave": record.wave, **shown}
    scaled = "" if scale == 1 else f", times {scale:g} by Froude"
    title, start = f"Test {record.id} of {record.file}{scaled}", float(record.time[0]) + record.transient
    return record_figure(record.time, shown, start, title, MEASURED)
