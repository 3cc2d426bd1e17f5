"""Spectra, energy in bands, transfer functions and statistics of records."""

from jaxhydro.analysis.motion_bands import bands
from jaxhydro.analysis.record_statistics import Exceedance, Statistics, exceedance, statistics
from jaxhydro.analysis.spectral import PowerSpectrum, band_integral, band_pass, power_spectrum
from jaxhydro.analysis.transfer_functions import TransferFunction, transfer_function

__all__ = [
    "Exceedance",
    "PowerSpectrum",
    "Statistics",
    "TransferFunction",
    "band_integral",
    "band_pass",
    "bands",
    "exceedance",
    "power_spectrum",
    "statistics",
    "transfer_function",
]
