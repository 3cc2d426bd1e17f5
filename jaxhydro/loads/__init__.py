"""All loads, and the registry `LOADS` by name.

A new effect is one file in this folder and one line in `LOADS`. Drag laws are in `drag`, with a registry of their own.
"""

from jaxhydro.loads.abstract_lines import AbstractLines
from jaxhydro.loads.added_mass import AddedMass
from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.catenary.catenary_lines import CatenaryLines
from jaxhydro.loads.computed_added_mass import ComputedAddedMass
from jaxhydro.loads.computed_excitation import ComputedExcitation
from jaxhydro.loads.computed_radiation import ComputedRadiation
from jaxhydro.loads.coulomb_friction import CoulombFriction
from jaxhydro.loads.coupled_added_mass import CoupledAddedMass
from jaxhydro.loads.coupled_damping import CoupledDamping
from jaxhydro.loads.coupled_stiffness import CoupledStiffness
from jaxhydro.loads.covered_ends import CoveredEnds
from jaxhydro.loads.cubic_damping import CubicDamping
from jaxhydro.loads.diffraction_correction import DiffractionCorrection
from jaxhydro.loads.drag.morison_drag import MorisonDrag
from jaxhydro.loads.drift_transfer import DriftTransfer
from jaxhydro.loads.end_inertia import EndInertia
from jaxhydro.loads.guided_masses import GuidedMasses
from jaxhydro.loads.hidden_oscillator import HiddenOscillator
from jaxhydro.loads.hydrostatic_coupling import HydrostaticCoupling
from jaxhydro.loads.hydrostatics import Buoyancy
from jaxhydro.loads.hysteresis import Hysteresis
from jaxhydro.loads.instant import Instant
from jaxhydro.loads.linear_damping import LinearDamping
from jaxhydro.loads.liquid_column_dampers import LiquidColumnDampers
from jaxhydro.loads.mass_error import MassError
from jaxhydro.loads.mooring_lines import MooringLines
from jaxhydro.loads.mooring_nonlinearity import MooringNonlinearity
from jaxhydro.loads.nonlinear_hydrostatics import NonlinearHydrostatics
from jaxhydro.loads.quadratic_damping import QuadraticDamping
from jaxhydro.loads.radiation_memory import RadiationMemory
from jaxhydro.loads.rotor_thrust import RotorThrust
from jaxhydro.loads.slender_body_forces import SlenderBodyForces
from jaxhydro.loads.static_force import StaticForce
from jaxhydro.loads.stiffness import Stiffness
from jaxhydro.loads.strip_inertia import StripInertia
from jaxhydro.loads.tension_table_lines import TensionTableLines
from jaxhydro.loads.tuned_mass_dampers import TunedMassDampers
from jaxhydro.loads.umbilical import Umbilical
from jaxhydro.loads.wave_drift import WaveDrift
from jaxhydro.loads.wave_drift_damping import WaveDriftDamping
from jaxhydro.loads.wave_excitation import WaveExcitation
from jaxhydro.loads.weight import Weight
from jaxhydro.parameters import Parameter

LOADS: dict[str, type[AbstractLoad]] = {
    "weight": Weight,
    "buoyancy": Buoyancy,
    "hydrostatic_coupling": HydrostaticCoupling,
    "mooring_lines": MooringLines,
    "catenary_lines": CatenaryLines,
    "tension_table_lines": TensionTableLines,
    "stiffness": Stiffness,
    "linear_damping": LinearDamping,
    "quadratic_damping": QuadraticDamping,
    "added_mass": AddedMass,
    "guided_masses": GuidedMasses,
    "tuned_mass_dampers": TunedMassDampers,
    "liquid_column_dampers": LiquidColumnDampers,
    "rotor_thrust": RotorThrust,
    "strip_inertia": StripInertia,
    "end_inertia": EndInertia,
    "morison_drag": MorisonDrag,
    "umbilical": Umbilical,
    "coulomb_friction": CoulombFriction,
    "hysteresis": Hysteresis,
    "mooring_nonlinearity": MooringNonlinearity,
    "radiation_memory": RadiationMemory,
    "computed_radiation": ComputedRadiation,
    "computed_added_mass": ComputedAddedMass,
    "hidden_oscillator": HiddenOscillator,
    "nonlinear_hydrostatics": NonlinearHydrostatics,
    "cubic_damping": CubicDamping,
    "mass_error": MassError,
    "static_force": StaticForce,
    "computed_excitation": ComputedExcitation,
    "diffraction_correction": DiffractionCorrection,
    "wave_drift": WaveDrift,
    "drift_transfer": DriftTransfer,
    "wave_drift_damping": WaveDriftDamping,
    "coupled_added_mass": CoupledAddedMass,
    "coupled_damping": CoupledDamping,
    "coupled_stiffness": CoupledStiffness,
    "covered_ends": CoveredEnds,
    "wave_excitation": WaveExcitation,
    "slender_body_forces": SlenderBodyForces,
}

__all__ = [
    "LOADS",
    "AbstractLines",
    "AbstractLoad",
    "Action",
    "Instant",
    "Parameter",
    *(load.__name__ for load in LOADS.values()),
]
