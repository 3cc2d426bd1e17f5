"""Catalogue of candidate effects: parameters, noticeable sizes, tests that would tell."""

import math
from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np

from calibration.discovery.effects.candidates import TABLE_EFFECTS, Candidate, requested_table_labels
from calibration.discovery.effects.catalogue_builder import CatalogueBuilder, NoticeableScales
from calibration.discovery.effects.catalogue_of_motions import add_motion_effects
from calibration.discovery.effects.nearly_known import CENTRE_ALONG, CENTRE_UP, INERTIA, MASS, displaced_length
from calibration.discovery.effects.reflection_start import ZERO_DELAY_GRID, reflection_delays
from calibration.parameters.space import FreeParameter
from jaxhydro.dynamics.model import Model
from jaxhydro.environment import DOFS, STANDARD_GRAVITY
from jaxhydro.loads import (
    CoupledAddedMass,
    CoupledDamping,
    CoupledStiffness,
    MassError,
    SlenderBodyForces,
    Umbilical,
    WaveExcitation,
)
from jaxhydro.loads.drag import ConstantLaw, SlowMotionLaw
from jaxhydro.platform.drag_laws import drag_of
from jaxhydro.sensors import SensorLag, SensorReference
from jaxhydro.water import Current, WaveGaugePosition, WaveReflection
from jaxhydro.water.wave_reflection import COEFFICIENT, DEFAULT_DELAY, DELAY, MAX_DELAY, SEEN
from jaxhydro.waves.dispersion import wavenumber

REFERENCE_LENGTH = 27.0  # m, of a platform of 20 000 t
SLOW_MOTION_CUTOFFS = (0.03, 0.015, 0.06)  # Hz: motion is slow below; tried in turn
# peak periods. Waves travel half a wavelength in one, at their group velocity: no beach is within that distance of the platform
MIN_REFLECTION_DELAY = 2.0
NOTICEABLE_SHARE = 0.1  # noticeable fraction of computed radiation or drift
TERMS = ("linear_damping.", "quadratic_damping.", "stiffness.", "added_mass.")  # that are candidates where they are zero


def catalogue(
    model: Model,
    scales: Mapping[str, NoticeableScales],
    waves: bool,
    wave_variance: float,
    step: float = 0.0,
    peak_period: float = 0.0,
) -> tuple[list[Candidate], dict[str, FreeParameter], dict[str, float]]:
    """Candidate effects for a model and the motions that were tested.

    Coordinates are values less neutral values, so that programs compiled for one campaign serve all of a platform.

    Args:
        model: The model.
        scales: Noticeable sizes by motion.
        waves: Whether there are tests in waves.
        wave_variance: Largest variance of the wave elevation (m²).
        step: Time step of simulations in waves (s), which limits the periods of candidates.
        peak_period: Peak period of the waves (s), which limits the delay of reflected ones.

    Returns:
        The candidates, their parameters by label, and noticeable sizes by label.
    """
    # by octaves' tenths: programs compiled for one campaign serve others
    builder = CatalogueBuilder(2.0 ** (round(10 * math.log2(displaced_length(model) / REFERENCE_LENGTH)) / 10))
    for dof in DOFS:
        if dof in scales:
            add_motion_effects(builder, dof, scales, wave_variance if waves else None, step)
    _of_tables(builder, model, waves)
    _of_the_whole(builder, scales)
    _of_mass(builder, model, scales)
    _of_strips(builder, model, waves)
    if waves:
        _of_gauges(builder)
        _of_the_basin(builder, peak_period)
    return builder.candidates, builder.free, builder.noticeable


def _of_tables(builder: CatalogueBuilder, model: Model, waves: bool) -> None:
    """Add effects that the platform file requests."""
    looked_for = requested_table_labels(model)
    tables = {k: table for k, table in TABLE_EFFECTS.items() if f"{k}.share" in looked_for and (waves or not table.in_waves)}
    for effect, table in tables.items():
        share = builder.add_linear(f"{effect}.share", NOTICEABLE_SHARE)
        builder.add(effect, None, [share], passive=True, telling=table.telling, source=table.load.source)
    if len(tables) > 1:  # what one program has computed belongs together: one table alone may not be better than none
        shares = [f"{effect}.share" for effect in tables]
        telling, sources = next(iter(tables.values())).telling, "; ".join(table.load.source for table in tables.values())
        builder.add("potential_flow", None, shares, passive=True, telling=telling, source=sources)


def _of_the_whole(builder: CatalogueBuilder, scales: Mapping[str, NoticeableScales]) -> None:
    """Add effects that act in several motions."""
    if "surge" in scales:
        s = scales["surge"]
        stiff = s.force / s.amplitude
        builder.add(
            "umbilical",
            None,
            [
                builder.add_linear("umbilical.stiffness", stiff),
                builder.add_linear("umbilical.pull", s.force),
                builder.add_linear("umbilical.mass", 0.1 * s.force / STANDARD_GRAVITY),
            ],
            shapes=(builder.add_linear("umbilical.height", 5.0 * builder.length, 12.0 * builder.length),),
            positive=("umbilical.stiffness",),
            telling="the same decays with the cable taken off",
            source=Umbilical.source,
        )
        builder.add(
            "current",
            None,
            [builder.add_linear("current.x", 0.03 * builder.time)],
            telling="decays from both sides, and a look at the basin's circulation",
            source=Current.source,
        )
    for pair, along, turning in (("15", "surge", "pitch"), ("24", "sway", "roll")):
        if {along, turning} <= set(scales):
            _of_a_pair(builder, pair, scales[along], turning, scales[turning])
    if {"surge", "pitch"} <= set(scales) or {"sway", "roll"} <= set(scales):
        builder.add(
            "sensor_reference",
            None,
            [builder.add_linear(f"sensor_reference.{axis}", 0.5 * builder.length) for axis in "zx"],
            telling="an inclining test, the tracked point's place measured on the model",
            source=SensorReference.source,
        )


def _of_a_pair(builder: CatalogueBuilder, pair: str, s: NoticeableScales, turning: str, turned: NoticeableScales) -> None:
    """Add terms of the equation of motion that couple a translation and a rotation."""
    acceleration = turned.rate**2 / turned.amplitude
    for effect, label, size, source in (
        ("coupled_damping", f"B{pair}", s.force / turned.rate, CoupledDamping.source),
        ("coupled_stiffness", f"C{pair}", s.force / turned.amplitude, CoupledStiffness.source),
        ("coupled_added_mass", f"A{pair}", s.force / acceleration, CoupledAddedMass.source),
    ):
        label, telling = f"{effect}.{label}", f"forced {turning}, with the horizontal force measured"
        builder.add(effect, None, [builder.add_linear(label, size)], telling=telling, source=source)


def _of_mass(builder: CatalogueBuilder, model: Model, scales: Mapping[str, NoticeableScales]) -> None:
    """Add errors of weighed mass properties."""
    mass = float(model.body.mass)
    turning = np.asarray(model.body.inertia)
    labels = [builder.add_linear("mass_properties.mass", MASS * mass)]
    for dof, name, scale in (("roll", "inertia_roll", turning[0, 0]), ("pitch", "inertia_pitch", turning[1, 1])):
        if dof in scales:
            labels.append(builder.add_linear(f"mass_properties.{name}", INERTIA * float(scale)))
    if {"pitch", "roll"} & set(scales):
        labels.append(builder.add_linear("mass_properties.centre_z", CENTRE_UP * displaced_length(model)))
    if "pitch" in scales:
        labels.append(builder.add_linear("mass_properties.centre_x", CENTRE_ALONG * displaced_length(model)))
    builder.add("mass_properties", None, labels, telling="weigh the model and swing it in air", source=MassError.source)


def _of_strips(builder: CatalogueBuilder, model: Model, waves: bool) -> None:
    """Add other laws of drag and of wave excitation."""
    drags = [drag for load in model.loads if (drag := drag_of(load)) is not None]
    if groups := sorted(
        {key[0] for morison in drags if isinstance(morison.law, ConstantLaw | SlowMotionLaw) for key in morison.Cd}
    ):
        builder.add(
            "amplitude_dependent_drag",
            None,
            [builder.add_linear(f"amplitude_dependent_drag.{group}.exponent", 0.1) for group in groups],
            telling="decays at three amplitudes, the largest several times the smallest",
            source="Graham 1980",
        )
        builder.add(
            "sea_state_dependent_drag",
            None,
            [builder.add_linear("sea_state_dependent_drag.low_share", 0.1, 1.0)],
            shapes=(
                builder.add_shape(
                    cutoff := "sea_state_dependent_drag.cutoff", *(f / builder.time for f in (0.03, 0.005, 0.08))
                ),
            ),
            grid=tuple({cutoff: frequency / builder.time} for frequency in SLOW_MOTION_CUTOFFS),
            telling="a decay in surge in still water against one in waves",
            source="OpenFAST HydroDyn, pull request 2895",
        )
    if waves and model.hull.elements.labels:
        builder.add(
            "slender_body_forces",
            None,
            [builder.add_linear("slender_body_forces.share", NOTICEABLE_SHARE)],
            passive=True,
            telling="the same irregular sea at another height: slow forces go as Hs^2",
            source=SlenderBodyForces.source,
        )
    pressed = sorted(label.replace(".Ca_", ".Cp_") for label in model.values if ".Ca_" in label)
    if waves and pressed:
        builder.add(
            "wave_excitation",
            None,
            [builder.add_linear(f"wave_excitation.{label}", 0.05, 1.0) for label in pressed],
            telling="the platform held in regular waves of three periods, its forces measured",
            source=WaveExcitation.source,
        )


def _of_gauges(builder: CatalogueBuilder) -> None:
    """Add delays of the sensors and a wrong position of the wave gauge."""
    builder.add(
        "sensor_lag",
        None,
        [builder.add_linear("sensor_lag.delay", 0.05 * builder.time)],
        phase_per_unit=lambda omega, water: -omega,
        telling="tap the wave gauge and the tracker at once",
        source=SensorLag.source,
    )
    builder.add(
        "wave_gauge_position",
        None,
        [builder.add_linear("wave_gauge_position.distance", builder.length)],
        phase_per_unit=lambda omega, water: np.asarray(wavenumber(omega, water.depth, water.gravity)),
        telling="regular waves of three periods with a second gauge",
        source=WaveGaugePosition.source,
    )


def _of_the_basin(builder: CatalogueBuilder, peak_period: float) -> None:
    """Add reflected waves; the gauge may have measured them or not."""
    least = MIN_REFLECTION_DELAY * peak_period
    builder.add_linear(SEEN, 1.0)
    builder.add(
        "wave_reflection",
        None,
        [builder.add_linear(COEFFICIENT, 0.02)],
        shapes=(builder.add_linear(DELAY, MAX_DELAY / 3, DEFAULT_DELAY),),
        grid=ZERO_DELAY_GRID,
        shape_limits={DELAY: (least, MAX_DELAY)},
        shape_finder=partial(reflection_delays, least=least),
        telling="a few regular waves that stop: what comes after them, at a row of gauges",
        source=WaveReflection.source,
    )


def zero_terms(baseline: Model, labels: Sequence[str]) -> set[str]:
    """Labels of terms of the equation of motion that are zero in the baseline and not fitted."""
    values = {label: float(value) for label, value in baseline.values.items() if label.startswith(TERMS)}
    return {label for label, value in values.items() if value == 0} - set(labels)
