"""Wave components, spectra, seas of first and second order, and the flow that they make."""

from jaxhydro.waves.components import Components, PlaneWaves, components
from jaxhydro.waves.diffraction import maccamy_fuchs
from jaxhydro.waves.dispersion import wavenumber
from jaxhydro.waves.flow import Cylinders, EndFlow, Flow, StripFlow
from jaxhydro.waves.integration_clock import Clock
from jaxhydro.waves.irregular import spectrum_components
from jaxhydro.waves.irregular_sea import IrregularSea
from jaxhydro.waves.pair_sums import elevation_spectrum
from jaxhydro.waves.recorded_waves import record_components, separated_record
from jaxhydro.waves.regular_waves import regular_wave
from jaxhydro.waves.sea import AbstractSea, StillWater, Stretching
from jaxhydro.waves.second_order import bound_waves
from jaxhydro.waves.spectra import jonswap, pierson_moskowitz, tabulated, white_noise
from jaxhydro.waves.support_sea import SupportSea
from jaxhydro.waves.two_gauges import incident_and_reflected
from jaxhydro.waves.wave_sea import WaveSea

__all__ = [
    "AbstractSea",
    "Clock",
    "Components",
    "Cylinders",
    "EndFlow",
    "Flow",
    "IrregularSea",
    "PlaneWaves",
    "StillWater",
    "Stretching",
    "StripFlow",
    "SupportSea",
    "WaveSea",
    "bound_waves",
    "components",
    "elevation_spectrum",
    "incident_and_reflected",
    "jonswap",
    "maccamy_fuchs",
    "pierson_moskowitz",
    "record_components",
    "regular_wave",
    "separated_record",
    "spectrum_components",
    "tabulated",
    "wavenumber",
    "white_noise",
]
