"""Findings on the platform file, and on waves outside its hydrodynamic tables."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from calibration.campaign.checks import Finding
from calibration.campaign.manifest import IN_WAVES, WAVE
from calibration.campaign.records import Record
from jaxhydro.analysis.spectral import power_spectrum
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.table_ranges import TableRange, table_ranges


class PlatformFinding(Finding):
    """A finding on the platform file, which no test has."""

    @property
    def place(self) -> str:
        return self.file


def platform_findings(model: Model, file: str) -> tuple[Finding, ...]:
    """The remarks on the files that a platform was read from, warnings first."""
    told = sorted(model.remarks, key=lambda remark: not remark.warning)
    return tuple(PlatformFinding("warning", file, "", "", None, remark.text) for remark in told)


def check_tables(records: Sequence[Record], model: Model, band: tuple[float, float]) -> tuple[Finding, ...]:
    """Findings on tests in waves that are outside a table of the model, one that a diagnosis may let in included.

    `band` (Hz) has the first-order waves.

    An irregular sea with more than 1 % of its energy outside is warned of. A regular wave outside is an error; a warning where
    the table is a candidate's.
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
    kept = record.time >= record.time[0] + record.transient
    time = np.linspace(record.time[kept][0], record.time[-1], int(kept.sum()))
    spectrum = power_spectrum(time, np.interp(time, record.time, record.wave))
    band = (spectrum.frequency >= limits[0]) & (spectrum.frequency <= limits[1])
    if not band.any() or not spectrum.density[band].sum() > 0:
        return
    omega, density = 2 * math.pi * spectrum.frequency[band], spectrum.density[band]
    for one in ranges:
        if record.kind == "regular":
            peak = float(omega[np.argmax(density)])
            if one.outside(np.array([peak]))[0]:
                expected = f"a wave within the {one.key} table, which has {one.words}"
                message = f"a regular wave of {2 * math.pi / peak:.4g} s ({peak:.4g} rad/s, full scale)"
                if one in acting:
                    yield Finding("error", record.file, record.id, WAVE, None, message, expected)
                else:
                    outside = f"{message} is outside the {one.key} table, a candidate, which has {one.words}"
                    yield Finding("warning", record.file, record.id, WAVE, None, outside)
        elif (remark := one.remark(one.share_outside(omega, density))) is not None and remark.warning:
            yield Finding("warning", record.file, record.id, WAVE, None, remark.text)
