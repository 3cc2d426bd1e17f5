"""The effects that are looked for: which load has them, which parameters, how large they may be expected, what would tell."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np

from calibration.parameters import Free
from calibration.transforms import LogInterval, Scaled
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
)
from jaxhydro.model import Model

PERIODS = (8.0, 16.0, 32.0, 64.0)  # s: of hidden oscillators, tried in turn
RATES = (0.25, 0.4, 0.6, 0.9)  # rad/s: of radiation memory
SHARE = 0.1  # of computed radiation or drift that is noticeable
SHARP = 0.1  # of the rate's amplitude: where dry friction is resolved as a damper
YIELDS = (0.2, 0.5, 1.5, 4.0)  # of their default: displacements at which hysteresis yields


@dataclass(frozen=True)
class Candidate:
    """An effect that may be missing. `amplitudes` are the labels that are null where it is not; `shapes` those that mean
    nothing then, freed with it, and tried at the values of `grid` first; `positive`, amplitudes that physics wants above
    zero; `begin`, values that another program has, where a refit begins, too: far from the null what was fitted without
    the effect may stand in its way. `telling`: the test that would tell it from others. One's own law comes with its
    `load` at null and, by label, `sizes` of its amplitudes that are noticeable."""

    effect: str
    dof: str | None
    amplitudes: tuple[str, ...]
    shapes: tuple[str, ...] = ()
    grid: tuple[Mapping[str, float], ...] = ()
    positive: tuple[str, ...] = ()
    begin: Mapping[str, float] = field(default_factory=dict)
    telling: str = ""
    source: str = ""
    load: AbstractLoad | None = None
    sizes: Mapping[str, float] = field(default_factory=dict)

    @property
    def labels(self) -> tuple[str, ...]:
        """All its parameters."""
        return (*self.amplitudes, *self.shapes)

    @property
    def name(self) -> str:
        """As it is listed: the effect, and its motion where it has one."""
        return self.effect if self.dof is None else f"{self.effect} ({self.dof})"


@dataclass(frozen=True)
class Scales:
    """What is noticeable in one motion: displacement (m, rad), rate, force (N, N m), and moving mass (kg, kg m2)."""

    amplitude: float
    rate: float
    force: float
    mass: float


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


BY_DOF: dict[str, Callable[[Sequence[str]], AbstractLoad]] = {
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
WHOLE: dict[str, Callable[[], AbstractLoad]] = {
    "umbilical": Umbilical.null,
    "current": Current.null,
    "sensor_reference": SensorReference.null,
    "sensor_lag": SensorLag.null,
    "wave_gauge_position": WaveGaugePosition.null,
    "covered_ends": CoveredEnds.null,
}
DRAG = ("amplitude_dependent_drag", "sea_state_dependent_drag")


class Computed(NamedTuple):
    """What a platform file may declare as a candidate: its load, whether it acts in waves only, and what would tell it."""

    load: type[AbstractLoad]
    in_waves: bool
    telling: str


COMPUTED = {
    "computed_excitation": Computed(
        ComputedExcitation, True, "the platform held in regular waves of three periods, its forces measured"
    ),
    "drift_transfer": Computed(DriftTransfer, True, "the same irregular sea at another height: drift goes as Hs^2"),
    "computed_radiation": Computed(
        ComputedRadiation, False, "forced oscillation at three periods, or a decay in each motion from a small amplitude"
    ),
}


def sought(model: Model) -> set[str]:
    """Labels of what the platform declares to be looked for: its load is there, at its null."""
    labels = (f"{effect}.share" for effect in COMPUTED)
    return {label for label in labels if label in model.values and float(model.values[label]) == 0}


def with_effects(model: Model, labels: Iterable[str]) -> Model:
    """The model with the loads, at null, that own those labels that it has not. Raises KeyError for what no effect has."""
    labels = [label for label in labels if label not in model.values]
    effects = dict.fromkeys(label.split(".")[0] for label in labels)
    for effect in effects:
        mine = [label for label in labels if label.startswith(f"{effect}.")]
        if effect in BY_DOF:
            model = model.with_load(BY_DOF[effect](_dofs(mine, effect)))
        elif effect in WHOLE:
            model = model.with_load(WHOLE[effect]())
        elif effect == "mass_properties":
            model = model.with_load(MassError.null(model.body.mass, model.body.centre))
        elif effect == "coupled_damping":
            model = model.with_load(CoupledDamping.null([label.split(".")[1] for label in mine]))
        elif effect == "quadratic_damping":
            model = model.with_load(QuadraticDamping({label: jnp.zeros(()) for label in mine}))
        elif effect == "wave_excitation":
            model = model.with_load(WaveExcitation.null([label.split(".", 1)[1] for label in mine]))
        elif effect in DRAG:
            model = with_drag(model)
        else:
            raise KeyError(f"no effect {effect!r}")
    return model


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


def catalogue(
    model: Model, scales: Mapping[str, Scales], waves: bool, wave_variance: float
) -> tuple[list[Candidate], dict[str, Free], dict[str, float]]:
    """Candidates for the motions that `scales` has, their parameters, and what is noticeable of each of these.

    Coordinates are values less null, so that programs compiled for one campaign serve all of a platform.
    """
    units: dict[str, float] = {}
    dofs = [dof for dof in DOFS if dof in scales]
    free: dict[str, Free] = {}
    found: list[Candidate] = []

    def linear(label: str, scale: float, null: float = 0.0) -> str:
        free[label] = Free(label, null, Scaled(null, 1.0), 0.0, math.inf)
        units[label] = float(scale)
        return label

    def shape(label: str, start: float, lower: float, upper: float) -> str:
        transform = LogInterval(lower, upper)
        free[label] = Free(label, start, transform, transform.inverse(start), 0.7)
        return label

    def add(effect: str, dof: str | None, amplitudes: Sequence[str], **more: Any) -> None:
        positive = more.pop("positive", tuple(amplitudes) if more.pop("passive", False) else ())
        found.append(Candidate(effect, dof, tuple(amplitudes), positive=tuple(positive), **more))

    long = [dof for dof in dofs if dof in ("surge", "sway")]
    for dof in dofs:
        s, i, of = scales[dof], DOFS.index(dof) + 1, f".{dof}."
        add(
            "coulomb_friction",
            dof,
            [linear(f"coulomb_friction{of}force", s.force)],
            # sharp beside the motion, and yet resolved by the time step; rounded, so that it compiles for many campaigns
            shapes=(shape(f"coulomb_friction{of}speed", 2.0 ** round(math.log2(SHARP * s.rate)), 1e-6, 1.0),),
            passive=True,
            telling=f"a slow static pull-out and return in {dof}: friction leaves the platform off zero",
            source=CoulombFriction.source,
        )
        add(
            "quadratic_damping",
            dof,
            [linear(f"quadratic_damping.B{i}{i}", s.force / s.rate**2)],
            passive=True,
            telling=f"decays in {dof} from twice the amplitude",
            source=QuadraticDamping.source,
        )
        add(
            "cubic_damping",
            dof,
            [linear(f"cubic_damping{of}coefficient", s.force / s.rate**3)],
            passive=True,
            telling=f"decays in {dof} from twice the amplitude",
            source=CubicDamping.source,
        )
        add(
            "radiation_memory",
            dof,
            [linear(f"radiation_memory{of}strength", s.force / s.rate)],
            shapes=(shape(f"radiation_memory{of}frequency", 0.6, 0.03, 4.0),),
            grid=tuple({f"radiation_memory{of}frequency": rate} for rate in RATES),
            passive=True,
            telling=f"forced oscillation in {dof} at three periods",
            source=RadiationMemory.source,
        )
        add(
            "hidden_oscillator",
            dof,
            [linear(f"hidden_oscillator{of}mass", 0.02 * s.mass)],
            shapes=(
                shape(f"hidden_oscillator{of}period", 16.0, 2.0, 200.0),
                shape(f"hidden_oscillator{of}damping_ratio", 0.03, 0.002, 0.5),
            ),
            grid=tuple({f"hidden_oscillator{of}period": period} for period in PERIODS),
            passive=True,
            telling=f"a longer decay in {dof}, and a hammer test of what may be loose in the hull",
            source=HiddenOscillator.source,
        )
        add(
            "static_offset",
            dof,
            [linear(f"static_offset{of}force", s.force)],
            telling="the same test with the platform moored, and its zero taken before and after",
            source=StaticForce.source,
        )
        if dof in (*long, "pitch", "roll"):
            default = 0.5 if DOFS.index(dof) < 3 else 0.01
            add(
                "hysteresis",
                dof,
                [linear(f"hysteresis{of}force", s.force)],
                shapes=(shape(f"hysteresis{of}yield_displacement", default, 0.02 * default, 20 * default),),
                grid=tuple({f"hysteresis{of}yield_displacement": share * default} for share in YIELDS),
                passive=True,
                telling=f"slow static cycles in {dof} at two amplitudes: the loop's area tells",
                source=Hysteresis.source,
            )
        if dof in long:
            names = {"odd_quadratic": 2, "even_quadratic": 2, "cubic": 3}
            add(
                "mooring_nonlinearity",
                dof,
                [linear(f"mooring_nonlinearity{of}{name}", s.force / s.amplitude**power) for name, power in names.items()],
                telling=f"static offsets in {dof} to both sides, up to the largest excursion",
                source=MooringNonlinearity.source,
            )
        if dof in ("heave", "roll", "pitch"):
            labels = [linear(f"nonlinear_hydrostatics{of}cubic", s.force / s.amplitude**3)]
            if dof == "heave":
                labels.append(linear(f"nonlinear_hydrostatics{of}even_quadratic", s.force / s.amplitude**2))
                if "pitch" in scales:
                    labels.append(linear(f"nonlinear_hydrostatics{of}pitch_squared", s.force / scales["pitch"].amplitude ** 2))
            else:
                labels.append(linear(f"nonlinear_hydrostatics{of}quintic", s.force / s.amplitude**5))
            add(
                "nonlinear_hydrostatics",
                dof,
                labels,
                telling=f"an inclining or static {dof} test to the largest angle or draught",
                source=NonlinearHydrostatics.source,
            )
        if waves:
            ways = ("envelope", "quadrature", "frequency_weighted")
            add(
                "wave_drift",
                dof,
                [linear(f"wave_drift{of}{way}", s.force / wave_variance) for way in ways],
                telling="the same irregular sea at another height: drift goes as Hs^2",
                source=WaveDrift.source,
            )
            add(
                "wave_drift_damping",
                dof,
                [linear(f"wave_drift_damping{of}coefficient", s.force / s.rate / wave_variance)],
                passive=True,
                telling=f"a {dof} decay in regular waves of two heights",
                source=WaveDriftDamping.source,
            )
    looked_for = sought(model)
    tables = {k: one for k, one in COMPUTED.items() if f"{k}.share" in looked_for and (waves or not one.in_waves)}
    for effect, one in tables.items():
        share, alone = linear(f"{effect}.share", SHARE), len(tables) == 1
        begin = {share: 1.0} if alone else {}
        add(effect, None, [share], passive=True, begin=begin, telling=one.telling, source=one.load.source)
    if len(tables) > 1:  # what one program has computed belongs together: one table alone may not be better than none
        shares = {f"{effect}.share": 1.0 for effect in tables}
        telling, sources = next(iter(tables.values())).telling, "; ".join(one.load.source for one in tables.values())
        add("potential_flow", None, list(shares), passive=True, begin=shares, telling=telling, source=sources)
    if "surge" in scales:
        s = scales["surge"]
        stiff = s.force / s.amplitude
        add(
            "umbilical",
            None,
            [
                linear("umbilical.stiffness", stiff),
                linear("umbilical.pull", s.force),
                linear("umbilical.mass", 0.1 * s.force / 9.81),
            ],
            shapes=(linear("umbilical.height", 5.0, 12.0),),
            positive=("umbilical.stiffness",),
            telling="the same decays with the cable taken off",
            source=Umbilical.source,
        )
        add(
            "current",
            None,
            [linear("current.x", 0.03)],
            telling="decays from both sides, and a look at the basin's circulation",
            source=Current.source,
        )
        if "pitch" in scales:
            add(
                "coupled_damping",
                None,
                [linear("coupled_damping.B15", s.force / scales["pitch"].rate)],
                telling="forced pitch, with the surge force measured",
                source=CoupledDamping.source,
            )
    if {"surge", "pitch"} <= set(scales) or {"sway", "roll"} <= set(scales):
        add(
            "sensor_reference",
            None,
            [linear("sensor_reference.z", 0.5), linear("sensor_reference.x", 0.5)],
            telling="an inclining test, the tracked point's place measured on the model",
            source=SensorReference.source,
        )
    mass = float(model.body.mass)
    turning = np.asarray(model.body.inertia)
    labels = [linear("mass_properties.mass", 0.005 * mass)]
    for dof, name, scale in (("roll", "inertia_roll", turning[0, 0]), ("pitch", "inertia_pitch", turning[1, 1])):
        if dof in scales:
            labels.append(linear(f"mass_properties.{name}", 0.01 * float(scale)))
    if {"pitch", "roll"} & set(scales):
        labels.append(linear("mass_properties.centre_z", 0.1))
    if "pitch" in scales:
        labels.append(linear("mass_properties.centre_x", 0.02))
    add("mass_properties", None, labels, telling="weigh the model and swing it in air", source=MassError.source)
    groups = sorted({label.rsplit(".", 1)[0] for label in model.values if ".Cd_" in label})
    if groups and any(type(load) in (StripDrag, EndDrag, ChangingDrag) for load in model.loads):
        add(
            "amplitude_dependent_drag",
            None,
            [linear(f"amplitude_dependent_drag.{group}.exponent", 0.1) for group in groups],
            telling="decays at three amplitudes, the largest several times the smallest",
            source="Graham 1980",
        )
        add(
            "sea_state_dependent_drag",
            None,
            [linear("sea_state_dependent_drag.low_share", 0.1, 1.0)],
            telling="a decay in surge in still water against one in waves",
            source="OpenFAST HydroDyn, pull request 2895",
        )
    pressed = sorted(label.replace(".Ca_", ".Cp_") for label in model.values if ".Ca_" in label)
    if waves and pressed:
        add(
            "wave_excitation",
            None,
            [linear(f"wave_excitation.{one}", 0.05, 1.0) for one in pressed],
            telling="the platform held in regular waves of three periods, its forces measured",
            source=WaveExcitation.source,
        )
    if waves:
        add(
            "sensor_lag",
            None,
            [linear("sensor_lag.delay", 0.05)],
            telling="tap the wave gauge and the tracker at once",
            source=SensorLag.source,
        )
        add(
            "wave_gauge_position",
            None,
            [linear("wave_gauge_position.distance", 1.0)],
            telling="regular waves of three periods with a second gauge",
            source=WaveGaugePosition.source,
        )
    return found, free, units


def with_candidates(model: Model, candidates: Sequence[Candidate], nuisances: Sequence[str] = ()) -> Model:
    """The model with every candidate at its null."""
    for one in candidates:
        if one.load is not None:
            model = model.with_load(one.load)
    labels = [label for one in candidates for label in one.labels]
    return with_effects(model, [*labels, *nuisances])
