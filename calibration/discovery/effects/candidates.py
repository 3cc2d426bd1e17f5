"""Effects that may be missing, as loads: what a candidate is, and how a model is given one, at its null."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import jax.numpy as jnp

from calibration.discovery.effects.mode_splitting import StartingValuesFinder
from calibration.discovery.effects.oscillator_start import ShapeFinder
from calibration.discovery.effects.phase_shift_start import PhasePerUnit
from jaxhydro.dynamics.model import Model
from jaxhydro.environment import DOFS
from jaxhydro.loads import (
    AbstractLoad,
    ChangingDrag,
    ComputedExcitation,
    ComputedRadiation,
    CoulombFriction,
    CoupledDamping,
    CoveredEnds,
    CubicDamping,
    Current,
    DriftTransfer,
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


@dataclass(frozen=True)
class Candidate:
    """An effect that may be missing. `amplitudes` are the labels that are null where it is not; `shapes` those that mean
    nothing then, freed with it, and tried at the values of `grid` first, then at those that `places` finds in a look
    and slopes along the first amplitude, of each of the grid; `positive`, amplitudes that physics wants above zero;
    `begin`, values that another program has, where a refit begins, too: far from the null what was fitted without the
    effect may stand in its way; `begins`, the same, of coefficients too, as the records themselves say; `turns`, by which phase
    a unit of its one amplitude turns waves, where it does nothing else. `telling`: the test that would tell it from others.
    One's own law comes with its `load` at null and, by label, `sizes` of its amplitudes that are noticeable."""

    effect: str
    dof: str | None
    amplitudes: tuple[str, ...]
    shapes: tuple[str, ...] = ()
    grid: tuple[Mapping[str, float], ...] = ()
    shape_finder: ShapeFinder | None = None
    positive: tuple[str, ...] = ()
    starting_values: Mapping[str, float] = field(default_factory=dict)
    starting_values_finder: StartingValuesFinder | None = None
    phase_per_unit: PhasePerUnit | None = None
    telling: str = ""
    source: str = ""
    load: AbstractLoad | None = None
    sizes: Mapping[str, float] = field(default_factory=dict)

    @property
    def labels(self) -> tuple[str, ...]:
        """All its parameters."""
        return (*self.amplitudes, *self.shapes)

    @property
    def choices(self) -> tuple[str, ...]:
        """What the grid tells apart and no fit moves: one of a few."""
        return tuple(dict.fromkeys(label for at in self.grid for label in at if label not in self.shapes))

    @property
    def name(self) -> str:
        """As it is listed: the effect, and its motion where it has one."""
        return self.effect if self.dof is None else f"{self.effect} ({self.dof})"


def with_drag(model: Model) -> Model:
    """The model with `ChangingDrag` in place of plain drag; itself where it has none."""
    plain = [load for load in model.loads if type(load) in (StripDrag, EndDrag)]
    if not plain or any(isinstance(load, ChangingDrag) for load in model.loads):
        return model
    coupled = all(load.coupled for load in plain if isinstance(load, StripDrag))
    values = {label: value for load in plain for label, value in load.values.items()}
    kept = tuple(load for load in model.loads if type(load) not in (StripDrag, EndDrag))
    return replace(model, loads=(*kept, ChangingDrag.of(values, coupled)))


def _dofs(labels: Iterable[str], effect: str) -> list[str]:
    found = {label.split(".")[1] for label in labels if label.startswith(f"{effect}.")}
    return [dof for dof in DOFS if dof in found]


PER_MOTION_LOADS: dict[str, Callable[[Sequence[str]], AbstractLoad]] = {
    "coulomb_friction": CoulombFriction.null,
    "hysteresis": Hysteresis.null,
    "mooring_nonlinearity": MooringNonlinearity.null,
    "nonlinear_hydrostatics": NonlinearHydrostatics.null,
    "cubic_damping": CubicDamping.null,
    "radiation_memory": RadiationMemory.null,
    "hidden_oscillator": HiddenOscillator.null,
    "static_offset": StaticForce.null,
    "wave_drift": WaveDrift.null,
    "wave_drift_damping": WaveDriftDamping.null,
}
WHOLE_PLATFORM_LOADS: dict[str, Callable[[], AbstractLoad]] = {
    "umbilical": Umbilical.null,
    "current": Current.null,
    "sensor_reference": SensorReference.null,
    "sensor_lag": SensorLag.null,
    "wave_gauge_position": WaveGaugePosition.null,
    "wave_reflection": WaveReflection.null,
    "covered_ends": CoveredEnds.null,
}
DRAG_EFFECTS = ("amplitude_dependent_drag", "sea_state_dependent_drag")


class TableEffect(NamedTuple):
    """What a platform file may declare as a candidate: its load, whether it acts in waves only, and what would tell it."""

    load: type[AbstractLoad]
    in_waves: bool
    telling: str


TABLE_EFFECTS = {
    "computed_excitation": TableEffect(
        ComputedExcitation, True, "the platform held in regular waves of three periods, its forces measured"
    ),
    "drift_transfer": TableEffect(DriftTransfer, True, "the same irregular sea at another height: drift goes as Hs^2"),
    "computed_radiation": TableEffect(
        ComputedRadiation, False, "forced oscillation at three periods, or a decay in each motion from a small amplitude"
    ),
}


def requested_table_labels(model: Model) -> set[str]:
    """Labels of what the platform declares to be looked for: its load is there, at its null."""
    labels = (f"{effect}.share" for effect in TABLE_EFFECTS)
    return {label for label in labels if label in model.values and float(model.values[label]) == 0}


def with_effects(model: Model, labels: Iterable[str]) -> Model:
    """The model with the loads, at null, that own those labels that it has not. Raises KeyError for what no effect has."""
    labels = [label for label in labels if label not in model.values]
    effects = dict.fromkeys(label.split(".")[0] for label in labels)
    for effect in effects:
        mine = [label for label in labels if label.startswith(f"{effect}.")]
        if effect in PER_MOTION_LOADS:
            model = model.with_load(PER_MOTION_LOADS[effect](_dofs(mine, effect)))
        elif effect in WHOLE_PLATFORM_LOADS:
            model = model.with_load(WHOLE_PLATFORM_LOADS[effect]())
        elif effect == "mass_properties":
            model = model.with_load(MassError.null(model.body.mass, model.body.centre))
        elif effect == "coupled_damping":
            model = model.with_load(CoupledDamping.null([label.split(".")[1] for label in mine]))
        elif effect == "quadratic_damping":
            model = model.with_load(QuadraticDamping({label: jnp.zeros(()) for label in mine}))
        elif effect == "wave_excitation":
            model = model.with_load(WaveExcitation.null([label.split(".", 1)[1] for label in mine]))
        elif effect in DRAG_EFFECTS:
            model = with_drag(model)
        else:
            raise KeyError(f"no effect {effect!r}")
    return model


def with_candidates(model: Model, candidates: Sequence[Candidate], nuisances: Sequence[str] = ()) -> Model:
    """The model with every candidate at its null."""
    for one in candidates:
        if one.load is not None:
            model = model.with_load(one.load)
    labels = [label for one in candidates for label in one.labels]
    return with_effects(model, [*labels, *nuisances])
