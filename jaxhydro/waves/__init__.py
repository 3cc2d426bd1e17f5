"""Seas and the flow that they make."""

from jaxhydro.waves.dispersion import wavenumber
from jaxhydro.waves.flow import EndFlow, Flow, StripFlow
from jaxhydro.waves.sea import AbstractSea, AirySea, StillWater, regular_wave

__all__ = ["AbstractSea", "AirySea", "EndFlow", "Flow", "StillWater", "StripFlow", "regular_wave", "wavenumber"]
