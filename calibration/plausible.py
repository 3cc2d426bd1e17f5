"""Are records of the size and pace of the platform? With a wrong unit or scale they are not, which no fit should find out."""

from collections.abc import Iterator, Sequence

import numpy as np

from calibration.checks import Finding, Severity
from calibration.manifest import IN_WAVES
from calibration.records import Record
from calibration.residuals import characteristic_length
from calibration.signals import dominant_period, peak_frequency, wave_height
from jaxhydro.environment import DOFS
from jaxhydro.model import Model
from jaxhydro.plot import for_people, unit_of
from jaxhydro.statics import equilibrium, natural_modes

ODD, WRONG = 3.0, 20.0  # natural periods, measured against the model's: a second is 1000 milliseconds, a minute 60
HEAVE = (0.5, 3.0)  # motions that are odd or wrong: of the radius of gyration
LEVEL = (3.0, 6.0)  # ... in surge and sway, where moorings may be slack
TURNED = (np.radians(60.0), np.radians(180.0))
SMALL = 1e-3  # of the radius of gyration, or rad: what nobody would release a platform from
OFF = 0.02  # of the radius of gyration, or rad: where a platform is at rest
STEEP = (1 / 7, 1.0)  # height over length: beyond 1/7 no wave stands (Michell 1893, Phil. Mag. 36)
FULL, WHAT = "(full scale)", "a unit, or the scale?"
NOISY = 0.5  # of a motion's deviation


def check_plausible(records: Sequence[Record], model: Model, zeroed: bool) -> tuple[Finding, ...]:
    """Findings on the records that are used, at full scale, against the declared model. `zeroed`: a zero was taken off them."""
    used = [record for record in records if record.use != "ignore"]
    decays = [record for record in used if record.kind == "decay"]
    length, gravity = characteristic_length(model), float(model.environment.gravity)
    periods: dict[str, float] = {}
    found: list[Finding] = []
    if decays:
        rest = equilibrium(model)
        modes = natural_modes(model, rest)
        periods = {dof: modes.of(dof) for dof in DOFS if np.isfinite(modes.of(dof))}
        found += [] if zeroed else _at_rest(decays, dict(zip(DOFS, map(float, rest))), length)
    return (*found, *(one for record in used for one in _of(record, length, gravity, periods)))


def _at_rest(decays: Sequence[Record], rest: dict[str, float], length: float) -> Iterator[Finding]:
    """Where nobody took a zero: do decays end where the platform floats?"""
    for name in DOFS:
        there = [float(np.mean(one.values[name][len(one.time) // 2 :])) for one in decays if name in one.values]
        limit = OFF * (1.0 if name in DOFS[3:] else length)
        if there and abs(where := float(np.median(there)) - rest[name]) > limit:
            message = (
                f"decays end {_in_words(name, where)} from where the declared platform floats: `zero` would say where still "
                "water is, without it that is taken for ballast or a force"
            )
            yield Finding("warning", decays[0].file, decays[0].id, name, None, message)


def _of(record: Record, length: float, gravity: float, periods: dict[str, float]) -> Iterator[Finding]:
    def found(limits: tuple[float, float], ratio: float, channel: str, message: str, expected: str) -> Iterator[Finding]:
        if ratio > limits[0]:
            severity: Severity = "error" if ratio > limits[1] else "warning"
            yield Finding(severity, record.file, record.id, channel, None, message, expected)

    if record.kind == "decay" and record.degree_of_freedom in periods:
        name, own = record.degree_of_freedom, periods[record.degree_of_freedom]
        period = dominant_period(record.time, record.values[name])
        if period is not None:
            message = f"a period of {period:.3g} s {FULL}, the declared model's is {own:.3g} s: a unit of time, or the scale?"
            yield from found((ODD, WRONG), max(period / own, own / period), name, message, f"a period of about {own:.3g} s")
    for name, values in record.values.items():
        size = float(np.percentile(np.abs(values - np.median(values)), 99))
        turns = name in DOFS[3:]
        if name == record.degree_of_freedom and size < SMALL * (1.0 if turns else length):
            yield Finding("warning", record.file, record.id, name, None, f"moves by {_in_words(name, size)} only: {WHAT}")
        if turns:
            message = f"an angle of {_in_words(name, size)}: degrees or radians?"
            yield from found(TURNED, size, name, message, "an angle that a platform may have")
        else:
            message = f"a motion of {size:.3g} m {FULL}, and the platform's radius of gyration is {length:.3g} m: {WHAT}"
            limits = HEAVE if name == "heave" else LEVEL
            yield from found(limits, size / length, name, message, "a motion that a platform may have")
    if record.noise_declared and record.degree_of_freedom is not None:
        name = record.degree_of_freedom
        spread, noise = float(np.std(record.values[name])), record.noise[name]
        message = f"noise is stated as {_in_words(name, noise)}, where the motion's own deviation is {_in_words(name, spread)}"
        yield from found((NOISY, np.inf), noise / spread, name, message, "")
    if record.wave is not None and record.kind in IN_WAVES:
        step = float(np.median(np.diff(record.time)))
        height = wave_height(record.wave, record.kind == "irregular")
        wavelength = gravity / (2 * np.pi * peak_frequency(record.wave, step) ** 2)
        message = f"waves {height:.3g} m high and {wavelength:.3g} m long {FULL}: {WHAT}"
        yield from found(STEEP, height / wavelength, "wave", message, "waves that do not break, less than 1/7 as high as long")


def _in_words(dof: str, value: float) -> str:
    return f"{float(for_people(dof, value)):.3g} {unit_of(dof)}"
