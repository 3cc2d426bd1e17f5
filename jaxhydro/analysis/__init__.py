"""Spectra, energy in bands, transfer functions and statistics of records."""

from jaxhydro.analysis.spectral import (
    Exceedance,
    PowerSpectrum,
    Statistics,
    TransferFunction,
    band_integral,
    band_pass,
    bands,
    exceedance,
    power_spectrum,
    statistics,
    transfer_function,
)

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
