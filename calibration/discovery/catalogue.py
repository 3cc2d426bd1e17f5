"""The effects that are looked for: which load has them, which parameters, how large they may be expected, what would tell."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from calibration.discovery.candidates import COMPUTED, Candidate, sought
from calibration.discovery.returning import AT_ONCE, delays
from calibration.parameters import Free
from calibration.transforms import LogInterval, Scaled
from jaxhydro.environment import DOFS, STANDARD_GRAVITY
from jaxhydro.loads import (
    ChangingDrag,
    CoulombFriction,
    CoupledDamping,
    CubicDamping,
    Current,
    EndDrag,
    HiddenOscillator,
    Hysteresis,
    MassError,
    MooringNonlinearity,
    NonlinearHydrostatics,
    QuadraticDamping,
    RadiationMemory,
    SensorLag,
    SensorReference,
    StaticForce,
    StripDrag,
    Umbilical,
    WaveDrift,
    WaveDriftDamping,
    WaveExcitation,
    WaveGaugePosition,
    WaveReflection,
)
from jaxhydro.loads.wave_reflection import COEFFICIENT, DELAY, LATER, LATEST, SEEN
from jaxhydro.model import Model

CUTOFFS = (0.03, 0.015, 0.06)  # Hz: below which motion is slow, tried in turn
PERIODS = (8.0, 16.0, 32.0, 64.0)  # s: of hidden oscillators, tried in turn
RATES = (0.25, 0.4, 0.6, 0.9)  # rad/s: of radiation memory
SHARE = 0.1  # of computed radiation or drift that is noticeable
LONG = ("surge", "sway")
SHARP = 0.1  # of the rate's amplitude: where dry friction is resolved as a damper
YIELDS = (0.2, 0.5, 1.5, 4.0)  # of their default: displacements at which hysteresis yields


@dataclass(frozen=True)
class Scales:
    """What is noticeable in one motion: displacement (m, rad), rate, force (N, N m), and moving mass (kg, kg m2)."""

    amplitude: float
    rate: float
    force: float
    mass: float


def scales_of(
    mass: np.ndarray, stiffness: np.ndarray, spread: Mapping[str, float], fraction: float = 0.02
) -> dict[str, Scales]:
    """What is noticeable by motion, from the linear model's matrices and the largest standard deviation measured."""
    found = {}
    for dof, size in spread.items():
        i = DOFS.index(dof)
        m, c = float(mass[i, i]), float(stiffness[i, i])
        omega = math.sqrt(c / m) if c > 0 else 0.1
        amplitude = math.sqrt(2) * size
        found[dof] = Scales(amplitude, omega * amplitude, fraction * max(c, m * omega**2) * amplitude, m)
    return found


@dataclass(frozen=True)
class _Listed:
    """What is listed so far: candidates, their parameters, and what is noticeable of each of these."""

    found: list[Candidate] = field(default_factory=list)
    free: dict[str, Free] = field(default_factory=dict)
    units: dict[str, float] = field(default_factory=dict)

    def linear(self, label: str, scale: float, null: float = 0.0) -> str:
        self.free[label] = Free(label, null, Scaled(null, 1.0), 0.0, math.inf)
        self.units[label] = float(scale)
        return label

    def shape(self, label: str, start: float, lower: float, upper: float) -> str:
        transform = LogInterval(lower, upper)
        self.free[label] = Free(label, start, transform, transform.inverse(start), 0.7)
        return label

    def add(self, effect: str, dof: str | None, amplitudes: Sequence[str], **more: Any) -> None:
        positive = more.pop("positive", tuple(amplitudes) if more.pop("passive", False) else ())
        self.found.append(Candidate(effect, dof, tuple(amplitudes), positive=tuple(positive), **more))


def catalogue(
    model: Model, scales: Mapping[str, Scales], waves: bool, wave_variance: float
) -> tuple[list[Candidate], dict[str, Free], dict[str, float]]:
    """Candidates for the motions that `scales` has, their parameters, and what is noticeable of each of these.

    Coordinates are values less null, so that programs compiled for one campaign serve all of a platform.
    """
    known = _Listed()
    for dof in DOFS:
        if dof in scales:
            _of_motion(known, dof, scales, wave_variance if waves else None)
    _of_tables(known, model, waves)
    _of_the_whole(known, scales)
    _of_mass(known, model, scales)
    _of_strips(known, model, waves)
    if waves:
        _of_gauges(known)
        _of_the_basin(known)
    return known.found, known.free, known.units


def _of_motion(known: _Listed, dof: str, scales: Mapping[str, Scales], wave_variance: float | None) -> None:
    """One motion's own; `wave_variance` (m2) is None where there are no waves."""
    s, i, of = scales[dof], DOFS.index(dof) + 1, f".{dof}."
    known.add(
        "coulomb_friction",
        dof,
        [known.linear(f"coulomb_friction{of}force", s.force)],
        # sharp beside the motion, and yet resolved by the time step; rounded, so that it compiles for many campaigns
        shapes=(known.shape(f"coulomb_friction{of}speed", 2.0 ** round(math.log2(SHARP * s.rate)), 1e-6, 1.0),),
        passive=True,
        telling=f"a slow static pull-out and return in {dof}: friction leaves the platform off zero",
        source=CoulombFriction.source,
    )
    known.add(
        "quadratic_damping",
        dof,
        [known.linear(f"quadratic_damping.B{i}{i}", s.force / s.rate**2)],
        passive=True,
        telling=f"decays in {dof} from twice the amplitude",
        source=QuadraticDamping.source,
    )
    known.add(
        "cubic_damping",
        dof,
        [known.linear(f"cubic_damping{of}coefficient", s.force / s.rate**3)],
        passive=True,
        telling=f"decays in {dof} from twice the amplitude",
        source=CubicDamping.source,
    )
    known.add(
        "radiation_memory",
        dof,
        [known.linear(f"radiation_memory{of}strength", s.force / s.rate)],
        shapes=(known.shape(f"radiation_memory{of}frequency", 0.6, 0.03, 4.0),),
        grid=tuple({f"radiation_memory{of}frequency": rate} for rate in RATES),
        passive=True,
        telling=f"forced oscillation in {dof} at three periods",
        source=RadiationMemory.source,
    )
    known.add(
        "hidden_oscillator",
        dof,
        [known.linear(f"hidden_oscillator{of}mass", 0.02 * s.mass)],
        shapes=(
            known.shape(f"hidden_oscillator{of}period", 16.0, 2.0, 200.0),
            known.shape(f"hidden_oscillator{of}damping_ratio", 0.03, 0.002, 0.5),
        ),
        grid=tuple({f"hidden_oscillator{of}period": period} for period in PERIODS),
        passive=True,
        telling=f"a longer decay in {dof}, and a hammer test of what may be loose in the hull",
        source=HiddenOscillator.source,
    )
    known.add(
        "static_offset",
        dof,
        [known.linear(f"static_offset{of}force", s.force)],
        telling="the same test with the platform moored, and its zero taken before and after",
        source=StaticForce.source,
    )
    if dof in (*LONG, "pitch", "roll"):
        default = 0.5 if DOFS.index(dof) < 3 else 0.01
        known.add(
            "hysteresis",
            dof,
            [known.linear(f"hysteresis{of}force", s.force)],
            shapes=(known.shape(f"hysteresis{of}yield_displacement", default, 0.02 * default, 20 * default),),
            grid=tuple({f"hysteresis{of}yield_displacement": share * default} for share in YIELDS),
            passive=True,
            telling=f"slow static cycles in {dof} at two amplitudes: the loop's area tells",
            source=Hysteresis.source,
        )
    if dof in LONG:
        names = {"odd_quadratic": 2, "even_quadratic": 2, "cubic": 3}
        known.add(
            "mooring_nonlinearity",
            dof,
            [known.linear(f"mooring_nonlinearity{of}{name}", s.force / s.amplitude**power) for name, power in names.items()],
            telling=f"static offsets in {dof} to both sides, up to the largest excursion",
            source=MooringNonlinearity.source,
        )
    if dof in ("heave", "roll", "pitch"):
        labels = [known.linear(f"nonlinear_hydrostatics{of}cubic", s.force / s.amplitude**3)]
        if dof == "heave":
            labels.append(known.linear(f"nonlinear_hydrostatics{of}even_quadratic", s.force / s.amplitude**2))
            if "pitch" in scales:
                tilt = scales["pitch"].amplitude
                labels.append(known.linear(f"nonlinear_hydrostatics{of}pitch_squared", s.force / tilt**2))
        else:
            labels.append(known.linear(f"nonlinear_hydrostatics{of}quintic", s.force / s.amplitude**5))
        known.add(
            "nonlinear_hydrostatics",
            dof,
            labels,
            telling=f"an inclining or static {dof} test to the largest angle or draught",
            source=NonlinearHydrostatics.source,
        )
    if wave_variance is not None:
        ways = ("envelope", "quadrature", "frequency_weighted")
        known.add(
            "wave_drift",
            dof,
            [known.linear(f"wave_drift{of}{way}", s.force / wave_variance) for way in ways],
            telling="the same irregular sea at another height: drift goes as Hs^2",
            source=WaveDrift.source,
        )
        known.add(
            "wave_drift_damping",
            dof,
            [known.linear(f"wave_drift_damping{of}coefficient", s.force / s.rate / wave_variance)],
            passive=True,
            telling=f"a {dof} decay in regular waves of two heights",
            source=WaveDriftDamping.source,
        )


def _of_tables(known: _Listed, model: Model, waves: bool) -> None:
    """Those that the platform file names."""
    looked_for = sought(model)
    tables = {k: one for k, one in COMPUTED.items() if f"{k}.share" in looked_for and (waves or not one.in_waves)}
    for effect, one in tables.items():
        share, alone = known.linear(f"{effect}.share", SHARE), len(tables) == 1
        begin = {share: 1.0} if alone else {}
        known.add(effect, None, [share], passive=True, begin=begin, telling=one.telling, source=one.load.source)
    if len(tables) > 1:  # what one program has computed belongs together: one table alone may not be better than none
        shares = {f"{effect}.share": 1.0 for effect in tables}
        telling, sources = next(iter(tables.values())).telling, "; ".join(one.load.source for one in tables.values())
        known.add("potential_flow", None, list(shares), passive=True, begin=shares, telling=telling, source=sources)


def _of_the_whole(known: _Listed, scales: Mapping[str, Scales]) -> None:
    """Those of several motions at once."""
    if "surge" in scales:
        s = scales["surge"]
        stiff = s.force / s.amplitude
        known.add(
            "umbilical",
            None,
            [
                known.linear("umbilical.stiffness", stiff),
                known.linear("umbilical.pull", s.force),
                known.linear("umbilical.mass", 0.1 * s.force / STANDARD_GRAVITY),
            ],
            shapes=(known.linear("umbilical.height", 5.0, 12.0),),
            positive=("umbilical.stiffness",),
            telling="the same decays with the cable taken off",
            source=Umbilical.source,
        )
        known.add(
            "current",
            None,
            [known.linear("current.x", 0.03)],
            telling="decays from both sides, and a look at the basin's circulation",
            source=Current.source,
        )
        if "pitch" in scales:
            known.add(
                "coupled_damping",
                None,
                [known.linear("coupled_damping.B15", s.force / scales["pitch"].rate)],
                telling="forced pitch, with the surge force measured",
                source=CoupledDamping.source,
            )
    if {"surge", "pitch"} <= set(scales) or {"sway", "roll"} <= set(scales):
        known.add(
            "sensor_reference",
            None,
            [known.linear("sensor_reference.z", 0.5), known.linear("sensor_reference.x", 0.5)],
            telling="an inclining test, the tracked point's place measured on the model",
            source=SensorReference.source,
        )


def _of_mass(known: _Listed, model: Model, scales: Mapping[str, Scales]) -> None:
    """What was weighed wrongly."""
    mass = float(model.body.mass)
    turning = np.asarray(model.body.inertia)
    labels = [known.linear("mass_properties.mass", 0.005 * mass)]
    for dof, name, scale in (("roll", "inertia_roll", turning[0, 0]), ("pitch", "inertia_pitch", turning[1, 1])):
        if dof in scales:
            labels.append(known.linear(f"mass_properties.{name}", 0.01 * float(scale)))
    if {"pitch", "roll"} & set(scales):
        labels.append(known.linear("mass_properties.centre_z", 0.1))
    if "pitch" in scales:
        labels.append(known.linear("mass_properties.centre_x", 0.02))
    known.add("mass_properties", None, labels, telling="weigh the model and swing it in air", source=MassError.source)


def _of_strips(known: _Listed, model: Model, waves: bool) -> None:
    """Other drag than by one coefficient, other excitation than by added mass."""
    groups = sorted({label.rsplit(".", 1)[0] for label in model.values if ".Cd_" in label})
    if groups and any(type(load) in (StripDrag, EndDrag, ChangingDrag) for load in model.loads):
        known.add(
            "amplitude_dependent_drag",
            None,
            [known.linear(f"amplitude_dependent_drag.{group}.exponent", 0.1) for group in groups],
            telling="decays at three amplitudes, the largest several times the smallest",
            source="Graham 1980",
        )
        known.add(
            "sea_state_dependent_drag",
            None,
            [known.linear("sea_state_dependent_drag.low_share", 0.1, 1.0)],
            shapes=(known.shape(cutoff := "sea_state_dependent_drag.cutoff", 0.03, 0.005, 0.08),),
            grid=tuple({cutoff: frequency} for frequency in CUTOFFS),
            telling="a decay in surge in still water against one in waves",
            source="OpenFAST HydroDyn, pull request 2895",
        )
    pressed = sorted(label.replace(".Ca_", ".Cp_") for label in model.values if ".Ca_" in label)
    if waves and pressed:
        known.add(
            "wave_excitation",
            None,
            [known.linear(f"wave_excitation.{one}", 0.05, 1.0) for one in pressed],
            telling="the platform held in regular waves of three periods, its forces measured",
            source=WaveExcitation.source,
        )


def _of_gauges(known: _Listed) -> None:
    """What was measured at another time or place."""
    known.add(
        "sensor_lag",
        None,
        [known.linear("sensor_lag.delay", 0.05)],
        telling="tap the wave gauge and the tracker at once",
        source=SensorLag.source,
    )
    known.add(
        "wave_gauge_position",
        None,
        [known.linear("wave_gauge_position.distance", 1.0)],
        telling="regular waves of three periods with a second gauge",
        source=WaveGaugePosition.source,
    )


def _of_the_basin(known: _Listed) -> None:
    """What is in the water that was not sent: the gauge saw it, too, or did not."""
    known.linear(SEEN, 1.0)
    known.add(
        "wave_reflection",
        None,
        [known.linear(COEFFICIENT, 0.02)],
        shapes=(known.linear(DELAY, LATEST / 3, LATER),),
        grid=AT_ONCE,
        places=delays,
        telling="a few regular waves that stop: what comes after them, at a row of gauges",
        source=WaveReflection.source,
    )
