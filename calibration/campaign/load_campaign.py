"""Loading of a campaign: manifest, platform, records and findings."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import jax.numpy as jnp

from calibration.campaign.checks import check_records
from calibration.campaign.finding import Finding
from calibration.campaign.manifest import Manifest, platform_source, read_manifest
from calibration.campaign.manifest_sections import IN_WAVES
from calibration.campaign.record_plausibility import CampaignFinding, check_plausible, restoring_findings
from calibration.campaign.records import Record, records_of
from calibration.campaign.series import read_series
from calibration.campaign.table_findings import built_in_findings, check_tables, platform_findings
from calibration.campaign.wave_band import wave_band
from calibration.formatting import listed
from jaxhydro.choices import unknown
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.rest_remarks import unrestored_motions
from jaxhydro.dynamics.statics import EquilibriumError, stable_modes
from jaxhydro.errors import InputError, Problem
from jaxhydro.files import campaign_file
from jaxhydro.platform.build import build
from jaxhydro.platform.schema import Platform, load_platform

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False)
class Campaign:
    """A campaign that was read and checked.

    Attributes:
        manifest: Content of campaign.yaml.
        folder: Folder of the campaign.
        platform: Content of the platform file.
        records: Measured motions of all tests, in SI at full scale.
        findings: Warnings about the data.
        model_override: A model in place of the platform file's; None for the latter.
    """

    manifest: Manifest
    folder: Path
    platform: Platform
    records: tuple[Record, ...]
    findings: tuple[Finding, ...]
    model_override: Model | None = None

    @cached_property
    def model(self) -> Model:
        """Model of the platform file, from which calibrations begin.

        Raises:
            InputError: The platform is impossible.
        """
        return build(self.platform) if self.model_override is None else self.model_override

    def with_model(self, model: Model) -> Campaign:
        """This campaign with a model in place of the platform file's, to be calibrated and diagnosed.

        Args:
            model: The model, which may have loads that no platform file has.
        """
        return replace(self, model_override=model)

    def used(self, use: str) -> tuple[Record, ...]:
        """Records of the tests of one use.

        Args:
            use: fit, holdout or ignore.
        """
        return tuple(record for record in self.records if record.use == use)

    def record(self, id: str) -> Record:
        """Record of a test.

        Args:
            id: Name of the test.

        Raises:
            UnknownName: There is no such test.
        """
        records = {record.id: record for record in self.records}
        if id not in records:
            raise unknown("test", id, records)
        return records[id]

    def __repr__(self) -> str:
        """Tests by kind, use and released motion."""
        from calibration.display.summaries import campaign_summary

        return campaign_summary(self)

    def _repr_html_(self) -> str:
        from calibration.display.data_frames import campaign_html

        return campaign_html(self)

    def to_dataframe(self) -> pd.DataFrame:
        """Tests, at full scale.

        Returns:
            Columns `kind`, `use`, `released` (motion of a decay), `duration_s`, `step_s`, `samples` and `file`; index `test`.
        """
        from calibration.display.data_frames import tests_frame

        return tests_frame(self)

    def plot(self, tests: Collection[str] | None = None) -> list[Axes]:
        """Plot the records: the released motion of a decay, else the wave and the motions that move.

        Args:
            tests: Names of the tests to show; None: all.

        Returns:
            Axes, one for each motion shown (m, deg); `axes[0].figure` is the figure.

        Raises:
            UnknownName: There is no such test.
            ValueError: There is no test to show.
        """
        from calibration.display.axes import campaign_axes

        return campaign_axes(self, tests)


def _of_other_waves(manifest: Manifest, platform: Platform) -> Iterator[Problem]:
    """Tests in waves of another heading than the platform's tables are of."""
    for i, test in enumerate(manifest.tests):
        if test.kind not in IN_WAVES or test.use == "ignore":
            continue
        stated = {f"systems[{j}].heading": system.heading for j, system in enumerate(test.sea.systems)}
        for key, heading in (stated or {"heading": test.sea.heading}).items():
            if (computed := platform.of_other_waves(heading)) is not None:
                expected = f"{computed.words} deg, the {computed.key} of {manifest.platform}"
                yield Problem(f"tests[{i}].sea.{key}", expected, f"{heading:g} deg")


def _missing_restoring(model: Model) -> str:
    """Which restoring of roll and pitch a platform without members leaves out, or ""."""
    bare = unrestored_motions(model, jnp.zeros(6))
    left_out = [bare[dof] for dof in ("roll", "pitch") if dof in bare]
    verb = "are" if len(left_out) > 1 else "is"
    return f"Without members, `hydrostatics` states what restores: {listed(left_out)} {verb} left out." if left_out else ""


def load_campaign(path: str | PathLike[str]) -> Campaign:
    """Load and check a campaign.

    A faulty test marked `ignore` is left out with a warning, unless it is the zero test.

    Args:
        path: Folder of the campaign, its campaign.yaml, or the name of an embedded one: "volturnus-s-decays".

    Returns:
        The campaign, with warnings about its data.

    Raises:
        InputError: If anything is wrong. The manifest's mistakes come first, then those of the platform and the data files
            together, then the records' errors.
    """
    manifest, folder = read_manifest(path)
    source = str(campaign_file(path))
    problems: list[Problem] = []
    of_platform: InputError | None = None
    try:
        platform = load_platform(platform_source(manifest, folder))
    except InputError as error:
        of_platform = error
    else:
        problems += _of_other_waves(manifest, platform)
    try:
        series = read_series(manifest, folder)
    except InputError as error:
        problems += error.problems
    if of_platform is not None and not problems and Path(platform_source(manifest, folder)).is_file():
        raise of_platform
    if of_platform is not None:
        name = manifest.platform
        problems += [Problem(f"{name}: {p.where}".rstrip(": "), p.expected, p.found, p.hint) for p in of_platform.problems]
    if problems:
        raise InputError(source, problems)
    findings = check_records(manifest, folder, series)
    spared = {test.id for test in manifest.tests if test.use == "ignore"} - {manifest.zero and manifest.zero.test}
    errors = [finding for finding in findings if finding.severity == "error"]
    if grave := [finding.problem for finding in errors if finding.test not in spared]:
        raise InputError(source, grave)
    faulty = {finding.test for finding in errors}
    findings = tuple(replace(f, severity="warning", message=f"left out: {f.message}") if f in errors else f for f in findings)
    records = tuple(record for record in records_of(manifest, series) if record.id not in faulty)
    campaign = Campaign(manifest, folder, platform, records, findings)
    model = campaign.model
    try:
        stable_modes(model)
        doubtful = check_plausible(records, model, manifest.zero is not None, manifest.scale)
    except EquilibriumError as error:
        expected, hint = "a platform that floats at rest", _missing_restoring(model)
        raise InputError(source, [Problem(manifest.platform, expected, str(error), hint)]) from None
    band = wave_band(manifest, model, records)
    doubtful = (*restoring_findings(records, model), *doubtful)
    copied = built_in_findings(platform_source(manifest, folder), manifest.platform)
    doubtful = (*copied, *platform_findings(model, manifest.platform), *check_tables(records, model, band), *doubtful)
    if grave := [finding.problem for finding in doubtful if finding.severity == "error"]:
        raise InputError(source, [*(finding.problem for finding in doubtful if isinstance(finding, CampaignFinding)), *grave])
    return replace(campaign, findings=(*findings, *doubtful))
