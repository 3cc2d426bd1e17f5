"""Ranges of the sizes that effects can have in a basin, by label, with their sources."""

from collections.abc import Callable
from fnmatch import fnmatchcase
from typing import NamedTuple

from calibration.discovery.effects import reference_sizes as ref
from calibration.discovery.effects.reference_sizes import Case
from jaxhydro.loads.matrix import row_and_column


class Reach(NamedTuple):
    """How far a size may be from its neutral value.

    Attributes:
        below: Distance downwards, 0 or less, in the SI unit of the size.
        above: Distance upwards, 0 or more.
        whole: Size that 100 % stands for in campaign.yaml, or None.
        source: Reference, or the judgement behind it, in a sentence.
        expected: Distance that the size is expected at where the effect is there; 0: near its neutral value.
        deviation: Standard deviation about it; None: half the further end.
    """

    below: float
    above: float
    whole: float | None
    source: str
    expected: float = 0.0
    deviation: float | None = None


Rule = Callable[[Case, str], Reach]
Quantity = Callable[[Case, str], float]


def _share(below: float, above: float, whole: Quantity, source: str) -> Rule:
    """Shares of a reference quantity."""
    return lambda case, label: Reach(below * whole(case, label), above * whole(case, label), whole(case, label), source)


def _entry(share: float, whole: Quantity, source: str) -> Rule:
    """Share of a reference quantity for an entry of a matrix.

    On the diagonal the size goes upwards only, elsewhere either way.
    """

    def rule(case: Case, label: str) -> Reach:
        i, j = row_and_column(label)
        size = whole(case, label)
        return Reach(0.0 if i == j else -share * size, share * size, size, source)

    return rule


def _table(deviation: float) -> Rule:
    """The share of a computed table, which is expected whole."""
    return lambda case, label: Reach(0.0, 1.3, 1.0, SHARE_OF_TABLE, 1.0, deviation)


def _froude(size: float, power: float, source: str) -> Rule:
    """Distance either way that grows with a power of the platform's length.

    Args:
        size: Distance for a platform of 20 000 t (SI).
        power: Power of the length: 1 for lengths, 1/2 for times.
        source: Source of the range.
    """
    return lambda case, label: Reach(-size * case.size**power, size * case.size**power, None, source)


def _hull(axis: int, source: str) -> Rule:
    """Coordinate within the hull, or a little beyond.

    A point at the keel or on a mast is then not at the end of the range.
    """

    def rule(case: Case, label: str) -> Reach:
        low, high = case.hull_extent(axis)
        beyond = BEYOND_HULL * (high - low)
        return Reach(low - beyond, high + beyond, None, source)

    return rule


JUDGEMENT = "engineering judgement: "
ROBERTSON = "Robertson et al. 2020, Ocean Engineering 195, 106605"
MASS = "IMO MSC.1/Circ.1195, 2.2.3: ballasted within 1 %; twice that, as published masses of one FOCAL hull differ by 1.2 %."
INERTIA = "IMO MSC.1/Circ.1200, 4.3.3: radius of gyration or natural period within 2 %, so moment of inertia within 4 to 5 %."
CENTRE = (
    f"{JUDGEMENT}7 mm at 1:70, as two published centres of one as-built FOCAL hull differ by 0.73 m. {ROBERTSON}, find "
    "responses most sensitive to it and to mooring stiffness."
)
TRIM = "IMO MSC.1/Circ.1195, 2.2.3: trim within 0.2 degrees, which is 0.1 m where the metacentre is 29 m above the centre."
BEYOND_HULL = 0.1  # of the hull's extent
HULL = JUDGEMENT + "what is tracked is fixed to the hull, or to a mast that is a tenth of its extent long at most."
DAMPING = (
    JUDGEMENT + "hulls with bilge keels or heave plates stay below a fifth of critical damping, counted at the largest speed."
)
SMALL_DAMPING = JUDGEMENT + "linear damping of moored floaters is a few per cent of critical, a tenth at most."
COUPLING = JUDGEMENT + "a tenth of the geometric mean of both motions, as for a motion alone."
FRICTION = JUDGEMENT + "more than a tenth of the largest restoring force would leave the model visibly off its rest position."
HYSTERESIS = JUDGEMENT + "lines and cables lose less than a sixth of the largest restoring force to their loop."
OFFSET = JUDGEMENT + "half the largest excursion, 1 % of the length or 1 degree would have been seen when records were zeroed."
MOORING = JUDGEMENT + "a declared stiffness is off by half at the largest excursion at most, a catenary's or taut line's alike."
HYDROSTATICS = (
    "Barrass and Derrett, Ship Stability for Masters and Mates. With BM = 2 GM the cubic term of a wall-sided hull is below "
    "0.3 of the linear one up to 30 degrees."
)
DRIFT = "Maruo 1960 in Faltinsen 1990, chapter 5: waves all sent back drift by rho g/2 times width and squared amplitude."
ARANHA = (
    "Aranha 1994, Journal of Fluid Mechanics 275, 147-155: (4 omega D + omega^2 dD/domega)/g, with the D of waves all sent "
    "back, growing as omega^2."
)
OSCILLATOR = JUDGEMENT + "tuned dampers, anti-roll tanks and flexible towers are a few per cent of what moves, a tenth at most."
UMBILICAL = (
    JUDGEMENT + "a slack cable bundle has a fifth of the mooring's stiffness and pull at most, or it would be called a line."
)
RADIATION = (
    JUDGEMENT + "tables of a semisubmersible (FOCAL campaign 4) reach 0.44 in surge and 0.13 in heave of moving mass times "
    "(g/L)^(1/2)."
)
ROLL_RADIATION = JUDGEMENT + "roll and pitch radiate less than heave: a fifth of moving mass times (g/L)^(1/2) at most."
GRAHAM = "Graham 1980, Journal of Fluid Mechanics 97, 331-346: -1/3 at sharp edges, 0 at square ones; twice that either way."
SHARE_OF_TABLE = (
    JUDGEMENT
    + "none of a program's forces, or all of them. Basins agree with programs within 10 % in excitation and added mass, "
    "20 % in radiation and 30 % in drift (one standard deviation)."
)
SHARE_OF_THEORY = (
    JUDGEMENT + "none of the theory's forces, or all of them, within 15 % (one standard deviation) as members shade each other."
)
PRESSURE = JUDGEMENT + "shading and diffraction change the Froude-Krylov force of slender members by 40 % at most."

RANGES: dict[str, Rule] = {
    "mass_properties.mass": _share(-0.02, 0.02, ref.body_mass, MASS),
    "mass_properties.inertia_*": _share(-0.05, 0.05, ref.body_inertia, INERTIA),
    "mass_properties.centre_z": _froude(0.5, 1, CENTRE),
    "mass_properties.centre_x": _froude(0.1, 1, TRIM),
    "sensor_reference.x": _hull(0, HULL),
    "sensor_reference.z": _hull(2, HULL),
    "sensor_lag.delay": _froude(1.25, 0.5, JUDGEMENT + "0.15 s at 1:70: filters, and a few frames of a camera or of a logger."),
    "wave_gauge_position.distance": _froude(
        8.0,
        1,
        JUDGEMENT + "0.12 m at 1:70: a gauge is placed by tape, abeam of where the model was to lie before it drifted off.",
    ),
    "wave_reflection.coefficient": _share(
        -0.1,
        0.1,
        ref.unity,
        JUDGEMENT + "beaches of basins send back 5 to 10 % of the height (Goda and Suzuki 1976 measure it).",
    ),
    "current.*": _froude(0.4, 0.5, JUDGEMENT + "5 cm/s at 1:70: what circulation and the waves' return flow leave in a basin."),
    "umbilical.stiffness": _share(0.0, 0.2, ref.surge_stiffness, UMBILICAL),
    "umbilical.pull": _share(-0.2, 0.2, ref.surge_force, UMBILICAL),
    "umbilical.mass": _share(0.0, 0.01, ref.body_mass, JUDGEMENT + "a metre or two of cable: 0.6 kg on a model of 60 kg."),
    "coulomb_friction.*": _share(0.0, 0.1, ref.restoring_force, FRICTION),
    "hysteresis.*": _share(0.0, 0.15, ref.restoring_force, HYSTERESIS),
    "static_offset.*": _share(-0.5, 0.5, ref.offset_force, OFFSET),
    "linear_damping.*": _entry(0.1, ref.entry_damping, SMALL_DAMPING),
    "coupled_damping.*": _entry(0.1, ref.entry_damping, SMALL_DAMPING),
    "coupled_stiffness.*": _entry(0.1, ref.entry_stiffness, COUPLING),
    "coupled_added_mass.*": _entry(0.1, ref.entry_mass, COUPLING),
    "quadratic_damping.*": _entry(0.2, ref.quadratic_damping, DAMPING),
    "cubic_damping.*": _share(0.0, 0.2, ref.cubic_damping, DAMPING),
    "radiation_memory.roll.*": _share(0.0, 0.2, ref.radiation_damping, ROLL_RADIATION),
    "radiation_memory.pitch.*": _share(0.0, 0.2, ref.radiation_damping, ROLL_RADIATION),
    "radiation_memory.*": _share(0.0, 0.5, ref.radiation_damping, RADIATION),
    "hidden_oscillator.*": _share(0.0, 0.1, ref.moving_mass, OSCILLATOR),
    "stiffness.*": _share(
        -0.1, 0.1, ref.entry_stiffness, f"{JUDGEMENT}a tenth; {ROBERTSON} find responses most sensitive to mooring stiffness."
    ),
    "added_mass.*": _share(-0.1, 0.1, ref.entry_mass, JUDGEMENT + "added mass beyond the strips' own, a tenth of what moves."),
    "mooring_nonlinearity.*": _share(-0.5, 0.5, ref.equal_polynomial, MOORING),
    "nonlinear_hydrostatics.*": _share(-0.3, 0.3, ref.equal_polynomial, HYDROSTATICS),
    "wave_drift.*": _share(-1.0, 1.0, ref.total_reflection, DRIFT),
    "wave_drift_damping.*": _share(0.0, 1.5, ref.aranha_damping, ARANHA),
    "amplitude_dependent_drag.*": _froude(0.67, 0, GRAHAM),
    "sea_state_dependent_drag.*": _share(
        -1.0, 0.0, ref.unity, "OpenFAST HydroDyn, pull request 2895: drag on slow motion is scaled between none and all of it."
    ),
    "wave_excitation.*": _share(-0.4, 0.4, ref.unity, PRESSURE),
    "slender_body_forces.share": lambda case, label: Reach(0.0, 1.3, 1.0, SHARE_OF_THEORY, 1.0, 0.15),
    "computed_excitation.share": _table(0.1),
    "computed_radiation.share": _table(0.2),
    "computed_added_mass.share": _table(0.1),
    "diffraction_correction.share": _table(0.1),
    "drift_transfer.share": _table(0.3),
}
"""Rules by pattern of labels; the first that fits counts."""


def reach_of(case: Case, label: str) -> Reach | None:
    """Plausible distance of a size from its neutral value; None for a label that no rule is about."""
    return next((rule(case, label) for pattern, rule in RANGES.items() if fnmatchcase(label, pattern)), None)
