"""The paper's four cases simulated on its hull in irregular seas."""

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from benchmarks.evidence.common import TRUE

PLATFORM = "volturnus-s-focal"
SEEDS = 10
DURATION, TRANSIENT, LOW, CUTOFF = 9000.0, 500.0, 0.03, 0.3  # s, s, Hz, Hz
HIGHEST = 0.35  # Hz, of the spectra that are kept
SEAS = {"moderate": (3.1, 8.96), "severe": (8.1, 12.8)}  # Hs (m), Tp (s)
COLUMNS = [(dof, band) for dof in ("surge", "heave", "pitch") for band in ("low_frequency", "wave_frequency")]


class Case(NamedTuple):
    """What a case of the paper is here."""

    order: int
    stretching: str
    wetting: str
    diffraction: str
    elements: int  # of each pontoon, a point at the middle of each


CASES = {
    "1": Case(1, "none", "mean", "none", 1),
    "2": Case(2, "none", "mean", "none", 1),
    "3": Case(2, "vertical", "instantaneous", "maccamy_fuchs", 1),
    "4": Case(2, "vertical", "instantaneous", "maccamy_fuchs", 3),
}


def rounded(platform: Any, case: Case) -> Any:
    """The platform file of a case."""
    from jaxhydro.platform.convergence import with_elements

    options = {"wetting": case.wetting, "diffraction": case.diffraction}
    return with_elements(platform, "pontoon", case.elements, 1).model_copy(update=options)


@cache
def model_of(name: str) -> Any:
    """The model of a case."""
    from jaxhydro import build, load_platform

    model = build(rounded(load_platform(PLATFORM), CASES[name]))
    off = {label: value for label, value in TRUE.items() if float(model.values[label]) != value}
    assert not off, f"not the paper's Table 1: {off}"
    return model


def sea_of(name: str, seed: int, environment: Any, order: int, stretching: Any, gamma: float | None = None) -> Any:
    """A seed's sea; one seed has the same waves in all cases."""
    from jaxhydro import IrregularSea, jonswap, spectrum_components

    height, period = SEAS[name]

    def spectrum(omega: Any) -> Any:
        return jonswap(omega, height, period, gamma)

    waves = spectrum_components(spectrum, DURATION, environment, low=LOW, cutoff=CUTOFF, seed=seed)
    return IrregularSea(waves, environment, order, stretching)


def times() -> np.ndarray:
    """When motions are wanted (s)."""
    return np.arange(0.0, DURATION, 0.5)


def spectra(position: np.ndarray) -> dict[str, Any]:
    """Spectra (m2/Hz, deg2/Hz) after the transient, by motion."""
    from jaxhydro.analysis.spectral import power_spectrum

    after = times() >= TRANSIENT
    unit = {"surge": (0, 1.0), "heave": (2, 1.0), "pitch": (4, 180 / np.pi)}
    return {dof: power_spectrum(times()[after], position[after, i] * factor) for dof, (i, factor) in unit.items()}


def integrals(position: np.ndarray, sea: str) -> list[float]:
    """Band integrals (m2, deg2) in the order of COLUMNS, and mean surge (m)."""
    from jaxhydro.analysis.motion_bands import bands
    from jaxhydro.analysis.spectral import band_integral

    densities, period = spectra(position), SEAS[sea][1]
    after = times() >= TRANSIENT
    energies = [band_integral(densities[dof], *bands(dof, period)[band]) for dof, band in COLUMNS]
    return [*energies, float(position[after, 0].mean())]


def of_seed(sea: str, seed: int) -> dict[str, Any]:
    """Band integrals and spectra of all cases in one seed's sea, and the spectra of its elevation."""
    from jaxhydro import simulate
    from jaxhydro.analysis.spectral import power_spectrum

    result: dict[str, Any] = {"integrals": {}, "spectra": {}}
    for name, case in CASES.items():
        waves = sea_of(sea, seed, model_of(name).environment, case.order, case.stretching)
        position = np.asarray(simulate(model_of(name), times(), waves).position)
        result["integrals"][name] = integrals(position, sea)
        for dof, spectrum in spectra(position).items():
            shown = spectrum.frequency <= HIGHEST
            result["frequency"] = spectrum.frequency[shown].tolist()
            result["spectra"][f"{dof} {name}"] = spectrum.density[shown].tolist()
        if name in ("1", "2"):
            wanted = times()  # 0.5 s: sums of frequencies reach 0.6 Hz
            spectrum = power_spectrum(wanted, waves.gauge(wanted))
            result["elevation frequency"] = spectrum.frequency.tolist()
            result[f"elevation {name}"] = spectrum.density.tolist()
    return result
