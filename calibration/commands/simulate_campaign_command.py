"""Command `simulate` in the measured waves of a campaign."""

import time as clock
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from calibration.commands.loaded_campaign import load, print_calibrated_values
from calibration.report import sea_tables
from calibration.residuals.measured_seas import Diverged, compare
from calibration.residuals.wave_options import Options, non_default_options, options_of
from calibration.results.applied_calibration import apply_calibration
from calibration.results.write_comparison import document, write_comparison
from jaxhydro.cli.console import complain, say, table
from jaxhydro.dynamics.statics import stable_modes
from jaxhydro.errors import InputError, Problem


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
        print_calibrated_values(used, calibration, loaded)
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
