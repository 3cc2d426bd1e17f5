"""Preparation of a sweep: its files read, its model built, its seas checked."""

import json
from dataclasses import replace
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from jaxhydro.calibrated_model import calibration_file
from jaxhydro.dynamics.rest_remarks import wave_remarks
from jaxhydro.dynamics.statics import stable_modes
from jaxhydro.errors import InputError, Problem
from jaxhydro.input_schema import read_yaml
from jaxhydro.platform.schema import builtin_platforms, builtin_text, load_platform
from jaxhydro.remarks import Remark
from jaxhydro.sweep.batch import Setup, pace_of_platform, setup_of
from jaxhydro.sweep.cases import plan_of
from jaxhydro.sweep.resources import supports_of
from jaxhydro.sweep.sea_states import named
from jaxhydro.sweep.store_layout import Inputs
from jaxhydro.sweep.sweep_remarks import impossible, near_limits, notes, outside, shares_in_band
from jaxhydro.sweep.sweep_schema import Sweep


class PreparedSweep(NamedTuple):
    """Sweep that can be stored and run.

    Attributes:
        inputs: Plan, platform file and calibration file as text.
        setup: Model and options that all runs share.
        source: Name of the sweep file.
        platform: The platform as asked for.
        calibration: The calibration as asked for, or None.
        shares: Fraction of each case's spectrum within the band, (case,).
        notes: Notes on the sweep.
        remarks: Remarks on the tables of the platform.
    """

    inputs: Inputs
    setup: Setup
    source: str
    platform: str
    calibration: str | None
    shares: Float[np.ndarray, " c"]
    notes: list[str]
    remarks: tuple[Remark, ...] = ()

    @property
    def about(self) -> dict[str, Any]:
        """First entries of sweep.json."""
        about: dict[str, Any] = {"sweep": self.source, "platform": Path(self.platform).stem}
        notes = [remark.text for remark in sorted(self.remarks, key=lambda remark: not remark.warning)] + self.notes
        if (used := self.setup.calibrated) is None:
            return about | {"notes": notes}
        reference = {} if used.reference is None else {"sea_state_reference": used.reference._asdict()}
        strips = {} if used.strips is None else {"strips": used.strips.model_dump()}
        about["calibration"] = {"file": self.calibration, "values": used.values} | reference | strips
        return about | {"notes": notes + used.warnings}


def prepared(sweep: Sweep, source: str) -> PreparedSweep:
    """Read the files that a sweep names, and build its model.

    All mistakes except those of single seas show here.

    Args:
        sweep: Checked contents of a sweep file.
        source: Name of the sweep in errors.

    Raises:
        InputError: A file has mistakes, or no sea state is possible.
        EquilibriumError: The platform has no stable equilibrium.
    """
    try:
        pace = pace_of_platform(sweep.platform)
    except InputError as error:
        raise InputError(f"{source}: platform: {error.source}", error.problems) from None
    plan, remarks_in_words = plan_of(sweep, source, pace)
    calibration = None if sweep.calibration is None else calibration_file(sweep.calibration)
    try:
        setup = setup_of(plan, sweep.platform, calibration)
    except InputError as error:
        key = "calibration" if error.source == str(calibration) else "platform"
        raise InputError(f"{source}: {key}: {error.source}", error.problems) from None
    stable_modes(setup.model)
    # as chosen for this platform: workers need not choose again
    setup = setup._replace(plan=(plan := replace(plan, step=setup.limit)))
    failing = impossible(setup)
    if all(case.state in failing for case in plan.cases):
        state, reason = next(iter(failing.items()))
        raise InputError(source, [Problem("scatter", "a sea state that can be", f"none: {named(state)}: {reason}")])
    supports_of(setup, source)
    shares = shares_in_band(plan)
    remarks_in_words += notes(plan, setup.model, shares, failing)
    remarks = (
        *setup.model.remarks,
        *wave_remarks(setup.model),
        *outside(plan, setup.model, failing),
        *near_limits(plan, setup.model.environment, failing),
    )
    text = None if calibration is None else calibration.read_text(encoding="utf-8-sig")
    inputs = Inputs(plan, _platform_text(sweep.platform), text)
    return PreparedSweep(inputs, setup, source, sweep.platform, sweep.calibration, shares, remarks_in_words, remarks)


def _platform_text(asked: str) -> str:
    name = asked.lower()
    if name in builtin_platforms() and not Path(asked).is_file():
        return builtin_text(name)
    platform, data = load_platform(asked), read_yaml(asked)
    # a store is elsewhere, and has to find the files; JSON is YAML
    beside = {key: data[key] | {"file": file} for key, file in platform.files().items()}
    if not beside:
        return Path(asked).read_text(encoding="utf-8-sig")
    # a comment for each file, so that another file of the same name is another platform
    contents = [
        f"# {entry['file']}: sha256 {sha256(Path(entry['file']).read_bytes()).hexdigest()}" for entry in beside.values()
    ]
    return "\n".join([json.dumps(data | beside, indent=1), *contents, ""])
