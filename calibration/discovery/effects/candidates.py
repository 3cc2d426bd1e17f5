"""Candidate effects as loads at their neutral values."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from calibration.discovery.effects.mode_splitting import StartingValuesFinder
from calibration.discovery.effects.oscillator_start import ShapeFinder
from calibration.discovery.effects.phase_shift_start import PhasePerUnit
from jaxhydro.dynamics.model import Model
from jaxhydro.environment import DOFS
from jaxhydro.loads import (
    AbstractLoad,
    ComputedAddedMass,
    ComputedExcitation,
    ComputedRadiation,
    CoulombFriction,
    CoupledAddedMass,
    CoupledDamping,
    CoupledStiffness,
    CoveredEnds,
    CubicDamping,
    DiffractionCorrection,
    DriftTransfer,
    HiddenOscillator,
    Hysteresis,
    LinearDamping,
    MassError,
    MooringNonlinearity,
    MorisonDrag,
    NonlinearHydrostatics,
    QuadraticDamping,
    RadiationMemory,
    SlenderBodyForces,
    StaticForce,
    Stiffness,
    Umbilical,
    WaveDrift,
    WaveDriftDamping,
    WaveExcitation,
)
from jaxhydro.loads.drag import ConstantLaw, SlowMotionLaw, SpeedPowerLaw
from jaxhydro.loads.sea_state_law import SeaStateLaw
from jaxhydro.parameters import AbstractEffect, strongly_typed
from jaxhydro.sensors import SensorLag, SensorReference
from jaxhydro.water import Current, WaveGaugePosition, WaveReflection


@dataclass(frozen=True)
class Candidate:
    """An effect that a model may lack.

    A user's own candidate has a `load` at its neutral value, and `sizes`.

    Attributes:
        effect: Name of the effect.
        dof: The motion that it acts in, or None.
        amplitudes: Labels of parameters that are neutral where the effect is absent.
        shapes: Labels of parameters without meaning at the neutral value; they are freed with the effect.
        grid: Values of shapes or discrete choices that are tried.
        shape_limits: Smallest and largest plausible value of shapes by label. Values of the grid beyond them only give slopes.
        shape_finder: Finds further shapes to try, from a linearisation and the slopes along the first amplitude.
        positive: Amplitudes that physics requires to be positive.
        starting_values_finder: Finds values where a fit begins too, of coefficients as well, from the decays.
        phase_per_unit: Phase that a unit of the only amplitude shifts waves by, where the effect does nothing else.
        telling: The test that would tell the effect from others.
        source: Reference of its law.
        load: A user's own load at its neutral value.
        sizes: Noticeable sizes of the amplitudes of that load, by label.
    """

    effect: str
    dof: str | None
    amplitudes: tuple[str, ...]
    shapes: tuple[str, ...] = ()
    grid: tuple[Mapping[str, float], ...] = ()
    shape_limits: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    shape_finder: ShapeFinder | None = None
    positive: tuple[str, ...] = ()
    starting_values_finder: StartingValuesFinder | None = None
    phase_per_unit: PhasePerUnit | None = None
    telling: str = ""
    source: str = ""
    load: AbstractEffect | None = None
    sizes: Mapping[str, float] = field(default_factory=dict)

    @property
    def labels(self) -> tuple[str, ...]:
        """Labels of all parameters."""
        return (*self.amplitudes, *self.shapes)

    @property
    def has_variants(self) -> bool:
        """Whether it is tried at several values of its shapes."""
        return len(self.grid) > 1 or self.shape_finder is not None

    @property
    def choices(self) -> tuple[str, ...]:
        """Labels of discrete choices, which no fit moves."""
        return tuple(dict.fromkeys(label for values in self.grid for label in values if label not in self.shapes))

    def is_plausible_at(self, values: Mapping[str, float]) -> bool:
        """Whether shapes are within their limits at some values."""
        return all(low <= values.get(label, low) <= high for label, (low, high) in self.shape_limits.items())

    @property
    def name(self) -> str:
        """Name of the effect, with its motion where it has one."""
        return self.effect if self.dof is None else f"{self.effect} ({self.dof})"


def with_drag(model: Model) -> Model:
    """The model with drag coefficients by speed, and apart for slow motion, in place of plain drag."""

    def changed(load: AbstractLoad) -> AbstractLoad:
        if isinstance(load, SeaStateLaw):
            return replace(load, load=changed(load.load))
        if not isinstance(load, MorisonDrag) or not isinstance(load.law, ConstantLaw):
            return load
        return strongly_typed(replace(load, law=SlowMotionLaw(law=SpeedPowerLaw.neutral(load.Cd))))

    return replace(model, loads=tuple(map(changed, model.loads)))


def _diagonal(symbol: str) -> dict[str, float]:
    return {f"{symbol}{i}{i}": 0.0 for i in range(1, 7)}


def _pairs(symbol: str) -> dict[str, float]:
    return {f"{symbol}{i}{j}": 0.0 for i in range(1, 7) for j in range(i + 1, 7)}


def _wave_excitation(model: Model) -> AbstractEffect:
    keys = (*model.hull.elements.owners("Cp"), *model.hull.ends.owners("Cp"))
    return WaveExcitation(dict.fromkeys(keys, 1.0))


OPTIONAL_EFFECTS: tuple[Callable[[Model], AbstractEffect], ...] = (
    lambda model: CoulombFriction.neutral(DOFS),
    lambda model: Hysteresis.neutral(DOFS),
    lambda model: MooringNonlinearity.neutral(DOFS),
    lambda model: NonlinearHydrostatics.neutral(),
    lambda model: CubicDamping.neutral(DOFS),
    lambda model: RadiationMemory.neutral(DOFS),
    lambda model: HiddenOscillator.neutral(DOFS),
    lambda model: StaticForce.neutral(DOFS),
    lambda model: WaveDrift.neutral(DOFS),
    lambda model: WaveDriftDamping.neutral(DOFS),
    lambda model: LinearDamping(_diagonal("B")),
    lambda model: QuadraticDamping(_diagonal("B")),
    lambda model: Stiffness(_diagonal("C")),
    lambda model: CoupledDamping(_pairs("B")),
    lambda model: CoupledStiffness(_pairs("C")),
    lambda model: CoupledAddedMass(_pairs("A")),
    lambda model: MassError(model.body.mass, model.body.centre),
    lambda model: Umbilical(),
    lambda model: Current(),
    lambda model: SensorReference(),
    lambda model: SensorLag(),
    lambda model: WaveGaugePosition(),
    lambda model: WaveReflection(),
    lambda model: CoveredEnds(),
    _wave_excitation,
    lambda model: SlenderBodyForces(),
)
"""Effects that a model may lack, at neutral values, with every parameter that they can have."""


class TableEffect(NamedTuple):
    """An effect that a platform file may declare as a candidate.

    Attributes:
        load: Its load.
        in_waves: Whether it acts in waves only.
        telling: The test that would tell it from others.
    """

    load: type[AbstractLoad]
    in_waves: bool
    telling: str


TABLE_EFFECTS = {
    "computed_excitation": TableEffect(
        ComputedExcitation, True, "the platform held in regular waves of three periods, its forces measured"
    ),
    "diffraction_correction": TableEffect(
        DiffractionCorrection, True, "the platform held in regular waves of three periods, its forces measured"
    ),
    "drift_transfer": TableEffect(DriftTransfer, True, "the same irregular sea at another height: drift goes as Hs^2"),
    "computed_radiation": TableEffect(
        ComputedRadiation, False, "forced oscillation at three periods, or a decay in each motion from a small amplitude"
    ),
    "computed_added_mass": TableEffect(ComputedAddedMass, False, "forced oscillation at a short period, its forces measured"),
}


def requested_table_labels(model: Model) -> set[str]:
    """Labels of effects that the platform file requests as candidates, at their neutral value."""
    labels = (f"{effect}.share" for effect in TABLE_EFFECTS)
    return {label for label in labels if label in model.values and float(model.values[label]) == 0}


def with_effects(model: Model, labels: Iterable[str]) -> Model:
    """Add loads at neutral values, so that the model has parameters with these labels.

    Raises:
        KeyError: If no effect has such a label.
    """
    present = model.values
    missing = [label for label in dict.fromkeys(labels) if label not in present]
    if not missing:
        return model
    drag = with_drag(model)
    if rest := set(missing) & set(drag.values):
        model, missing = drag, [label for label in missing if label not in rest]
    for make in OPTIONAL_EFFECTS if missing else ():
        effect = make(model)
        keys = {key for label, key in effect.keys.items() if label in missing}
        if keys:
            added = effect.restricted(keys)
            model, gone = model.with_effect(added), set(added.values)
            missing = [label for label in missing if label not in gone]
    if missing:
        raise KeyError(f"no effect with the parameter {missing[0]!r}")
    return model


def with_candidates(model: Model, candidates: Sequence[Candidate], nuisances: Sequence[str] = ()) -> Model:
    """The model with every candidate at its neutral value."""
    for candidate in candidates:
        if candidate.load is not None:
            model = model.with_effect(candidate.load)
    labels = [label for candidate in candidates for label in candidate.labels]
    return with_effects(model, [*labels, *nuisances])
