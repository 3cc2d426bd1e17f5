"""Findings on the platform file, and on waves outside its hydrodynamic tables."""

import math
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from calibration.campaign.finding import Finding
from calibration.campaign.manifest_sections import IN_WAVES, WAVE
from calibration.campaign.records import Record
from jaxhydro.analysis.spectral import power_spectrum
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.table_ranges import TableRange, table_ranges
from jaxhydro.platform.schema import builtin_platforms, builtin_text


class PlatformFinding(Finding):
    """A finding on the platform file, which no test has."""

    @property
    def place(self) -> str:
        return self.file


def platform_findings(model: Model, file: str) -> tuple[Finding, ...]:
    """The remarks on the files that a platform was read from, warnings first."""
    told = sorted(model.remarks, key=lambda remark: not remark.warning)
    return tuple(PlatformFinding("warning", file, "", "", None, remark.text) for remark in told)


def built_in_findings(source: str, file: str) -> tuple[Finding, ...]:
    """Warning where a platform file is still the built-in one that `init` copied.

    Args:
        source: Argument of `load_platform`: a path or a built-in name.
        file: The platform file's name in the manifest.
    """
    path = Path(source)
    if not path.is_file():
        return ()
    text = path.read_text(encoding="utf-8-sig")
    name = next((name for name in builtin_platforms() if builtin_text(name) == text), None)
    message = f"still the built-in platform {name}: put your platform in. Until then, results are of that hull"
    return () if name is None else (PlatformFinding("warning", file, "", "", None, message),)


def check_tables(records: Sequence[Record], model: Model, band: tuple[float, float]) -> tuple[Finding, ...]:
    """Findings on tests in waves that are outside a table of the model.

    Tables that a diagnosis may let in are included. An irregular sea with more than 1 % of its energy outside is warned of. A
    regular wave outside is an error; a warning where the table is a candidate's.

    Args:
        records: Records of the campaign.
        model: Model of the platform file.
        band: Lowest and highest frequency (Hz) of the first-order waves.
    """
    ranges, acting = table_ranges(model, candidates=True), table_ranges(model)
    return tuple(
        finding
        for record in records
        if ranges and record.kind in IN_WAVES and record.wave is not None and record.use != "ignore"
        for finding in _record_findings(record, ranges, acting, band)
    )


def _record_findings(
    record: Record, ranges: tuple[TableRange, ...], acting: tuple[TableRange, ...], limits: tuple[float, float]
) -> Iterator[Finding]:
    assert record.wave is not None
    compared = record.time >= record.time[0] + record.transient
    time = np.linspace(record.time[compared][0], record.time[-1], int(compared.sum()))
    spectrum = power_spectrum(time, np.interp(time, record.time, record.wave))
    band = (spectrum.frequency >= limits[0]) & (spectrum.frequency <= limits[1])
    if not band.any() or not spectrum.density[band].sum() > 0:
        return
    omega, density = 2 * math.pi * spectrum.frequency[band], spectrum.density[band]
    for table in ranges:
        if record.kind == "regular":
            peak = float(omega[np.argmax(density)])
            if table.outside(np.array([peak]))[0]:
                expected = f"a wave within the {table.key} table, which has {table.words}"
                message = f"a regular wave of {2 * math.pi / peak:.4g} s ({peak:.4g} rad/s, full scale)"
                if table in acting:
                    yield Finding("error", record.file, record.id, WAVE, None, message, expected)
                else:
                    outside = f"{message} is outside the {table.key} table, a candidate, which has {table.words}"
                    yield Finding("warning", record.file, record.id, WAVE, None, outside)
        elif (remark := table.remark(table.share_outside(omega, density))) is not None and remark.warning:
            yield Finding("warning", record.file, record.id, WAVE, None, remark.text)
