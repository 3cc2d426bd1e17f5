"""Candidate effects that act in one motion."""

import math
from collections.abc import Mapping
from functools import partial

from calibration.discovery.effects.catalogue_builder import CatalogueBuilder, NoticeableScales
from calibration.discovery.effects.mode_splitting import oscillator_starts
from calibration.discovery.effects.oscillator_start import NEUTRAL_DAMPING_RATIO, oscillator_period_finder
from jaxhydro.environment import DOFS
from jaxhydro.loads import (
    CoulombFriction,
    CubicDamping,
    HiddenOscillator,
    Hysteresis,
    LinearDamping,
    MooringNonlinearity,
    NonlinearHydrostatics,
    QuadraticDamping,
    RadiationMemory,
    StaticForce,
    Stiffness,
    WaveDrift,
    WaveDriftDamping,
)

# of the shortest and the longest natural period: hidden oscillators have periods in between
MIN_NATURAL_PERIOD_RATIO, MAX_NATURAL_PERIOD_RATIO = 0.4, 1.5
MIN_OSCILLATOR_PERIOD, MAX_OSCILLATOR_PERIOD = 0.7, 250.0  # s, of periods that are tried; fits go from 0.8 times to twice them
MIN_STEPS_PER_PERIOD = 20  # fourth-order Adams-Bashforth is unstable below 15
MEMORY_RATES = (0.25, 0.4, 0.6, 0.9)  # rad/s, of radiation memory
HORIZONTAL_MOTIONS = ("surge", "sway")
FRICTION_SPEED_SHARE = 0.1  # of the velocity's amplitude: below this speed friction acts as a damper
YIELD_FACTORS = (0.2, 0.5, 1.5, 4.0)  # times the default yield displacement of hysteresis


def add_motion_effects(
    builder: CatalogueBuilder, dof: str, scales: Mapping[str, NoticeableScales], wave_variance: float | None, step: float
) -> None:
    """Add the candidate effects of one motion to a catalogue.

    Args:
        builder: The catalogue.
        dof: The motion.
        scales: Noticeable sizes by motion.
        wave_variance: Largest variance of the wave elevation (m²); None: no tests in waves.
        step: Time step of simulations in waves (s).
    """
    s, i, infix = scales[dof], DOFS.index(dof) + 1, f".{dof}."
    builder.add(
        "coulomb_friction",
        dof,
        [builder.add_linear(f"coulomb_friction{infix}force", s.force)],
        # sharp beside the motion, and yet resolved by the time step; rounded, so that it compiles for many campaigns
        shapes=(
            builder.add_shape(
                f"coulomb_friction{infix}speed", 2.0 ** round(math.log2(FRICTION_SPEED_SHARE * s.rate)), 1e-6, 1.0
            ),
        ),
        passive=True,
        telling=f"a slow static pull-out and return in {dof}: friction leaves the platform off zero",
        source=CoulombFriction.source,
    )
    builder.add(
        "linear_damping",
        dof,
        [builder.add_linear(f"linear_damping.B{i}{i}", s.force / s.rate)],
        passive=True,
        telling=f"decays in {dof} from half the amplitude",
        source=LinearDamping.source,
    )
    builder.add(
        "stiffness",
        dof,
        [builder.add_linear(f"stiffness.C{i}{i}", s.force / s.amplitude)],
        telling=f"static offsets in {dof} to both sides, with the force measured",
        source=Stiffness.source,
    )
    builder.add(
        "quadratic_damping",
        dof,
        [builder.add_linear(f"quadratic_damping.B{i}{i}", s.force / s.rate**2)],
        passive=True,
        telling=f"decays in {dof} from twice the amplitude",
        source=QuadraticDamping.source,
    )
    builder.add(
        "cubic_damping",
        dof,
        [builder.add_linear(f"cubic_damping{infix}coefficient", s.force / s.rate**3)],
        passive=True,
        telling=f"decays in {dof} from twice the amplitude",
        source=CubicDamping.source,
    )
    builder.add(
        "radiation_memory",
        dof,
        [builder.add_linear(f"radiation_memory{infix}strength", s.force / s.rate)],
        shapes=(builder.add_shape(f"radiation_memory{infix}frequency", *(rate / builder.time for rate in (0.6, 0.03, 4.0))),),
        grid=tuple({f"radiation_memory{infix}frequency": rate / builder.time} for rate in MEMORY_RATES),
        passive=True,
        telling=f"forced oscillation in {dof} at three periods",
        source=RadiationMemory.source,
    )
    natural = [scale.period for scale in scales.values()]
    shortest = max(MIN_NATURAL_PERIOD_RATIO * min(natural), MIN_STEPS_PER_PERIOD * step, MIN_OSCILLATOR_PERIOD)
    longest = max(min(MAX_NATURAL_PERIOD_RATIO * max(natural), MAX_OSCILLATOR_PERIOD), shortest)
    builder.add(
        "hidden_oscillator",
        dof,
        [builder.add_linear(f"hidden_oscillator{infix}mass", 0.02 * s.mass)],
        shapes=(
            builder.add_shape(
                f"hidden_oscillator{infix}period", min(max(s.period, shortest), longest), 0.8 * shortest, 2 * longest
            ),
            builder.add_shape(f"hidden_oscillator{infix}damping_ratio", NEUTRAL_DAMPING_RATIO, 0.002, 0.5),
        ),
        grid=({f"hidden_oscillator{infix}period": shortest},),
        shape_finder=oscillator_period_finder(dof, shortest, longest),
        starting_values_finder=partial(oscillator_starts, dof),
        passive=True,
        telling=f"a longer decay in {dof}, and a hammer test of what may be loose in the hull",
        source=HiddenOscillator.source,
    )
    builder.add(
        "static_offset",
        dof,
        [builder.add_linear(f"static_offset{infix}force", s.force)],
        telling="the same test with the platform moored, and its zero taken before and after",
        source=StaticForce.source,
    )
    if dof in (*HORIZONTAL_MOTIONS, "pitch", "roll"):
        default = 0.5 * builder.length if DOFS.index(dof) < 3 else 0.01
        builder.add(
            "hysteresis",
            dof,
            [builder.add_linear(f"hysteresis{infix}force", s.force)],
            shapes=(builder.add_shape(f"hysteresis{infix}yield_displacement", default, 0.02 * default, 20 * default),),
            grid=tuple({f"hysteresis{infix}yield_displacement": share * default} for share in YIELD_FACTORS),
            passive=True,
            telling=f"slow static cycles in {dof} at two amplitudes: the loop's area tells",
            source=Hysteresis.source,
        )
    if dof in HORIZONTAL_MOTIONS:
        names = {"odd_quadratic": 2, "even_quadratic": 2, "cubic": 3}
        builder.add(
            "mooring_nonlinearity",
            dof,
            [
                builder.add_linear(f"mooring_nonlinearity{infix}{name}", s.force / s.amplitude**power)
                for name, power in names.items()
            ],
            telling=f"static offsets in {dof} to both sides, up to the largest excursion",
            source=MooringNonlinearity.source,
        )
    if dof in ("heave", "roll", "pitch"):
        labels = [builder.add_linear(f"nonlinear_hydrostatics{infix}cubic", s.force / s.amplitude**3)]
        if dof == "heave":
            labels.append(builder.add_linear(f"nonlinear_hydrostatics{infix}even_quadratic", s.force / s.amplitude**2))
            if "pitch" in scales:
                tilt = scales["pitch"].amplitude
                labels.append(builder.add_linear(f"nonlinear_hydrostatics{infix}pitch_squared", s.force / tilt**2))
        else:
            labels.append(builder.add_linear(f"nonlinear_hydrostatics{infix}quintic", s.force / s.amplitude**5))
        builder.add(
            "nonlinear_hydrostatics",
            dof,
            labels,
            telling=f"an inclining or static {dof} test to the largest angle or draught",
            source=NonlinearHydrostatics.source,
        )
    if wave_variance is not None:
        ways = ("envelope", "quadrature", "frequency_weighted")
        builder.add(
            "wave_drift",
            dof,
            [builder.add_linear(f"wave_drift{infix}{way}", s.force / wave_variance) for way in ways],
            telling="the same irregular sea at another height: drift goes as Hs^2",
            source=WaveDrift.source,
        )
        steady = builder.add_linear(f"wave_drift_damping{infix}steady", 1.0, 1.0)
        builder.add(
            "wave_drift_damping",
            dof,
            [builder.add_linear(f"wave_drift_damping{infix}coefficient", s.force / s.rate / wave_variance)],
            grid=({steady: 1.0}, {steady: 0.0}),
            passive=True,
            telling=f"a {dof} decay in regular waves of two heights",
            source=WaveDriftDamping.source,
        )
