"""Irregular sea that a `RequestedSea` describes."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np

from jaxhydro.dynamics.irregular_simulation import MAX_PAIRS, too_many_pairs
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.requested_sea import RequestedSea
from jaxhydro.dynamics.sea_of_record import NOTED_SHARE, add_shares, from_record, impossible
from jaxhydro.dynamics.table_ranges import heading_fault, outside_tables
from jaxhydro.errors import InputError, Problem
from jaxhydro.quick_jit import on_device
from jaxhydro.remarks import Remark
from jaxhydro.waves.components import Components
from jaxhydro.waves.directional_spectrum import (
    directional_components,
)
from jaxhydro.waves.irregular import spectrum_components
from jaxhydro.waves.irregular_sea import IrregularSea
from jaxhydro.waves.spectra import SPECTRA, peak_enhancement, white_noise
from jaxhydro.waves.spreading import circular_moments
from jaxhydro.waves.wave_errors import BreakingError

MIN_SHARE = 0.05  # share, below which it is a mistake


def share_within(elevation: np.ndarray, step: float, low: float, high: float) -> float:
    """Fraction of a record's variance between two frequencies.

    Args:
        elevation: Elevation (m), (t,).
        step: Sampling interval (s).
        low: Lower frequency (Hz).
        high: Upper frequency (Hz).
    """
    power = np.abs(np.fft.rfft(elevation - elevation.mean())) ** 2
    frequency = np.fft.rfftfreq(len(elevation), step)
    return float(power[(frequency >= low) & (frequency <= high)].sum() / max(power.sum(), 1e-300))


class BuiltSea(NamedTuple):
    """Irregular sea built from a request.

    Attributes:
        sea: The sea.
        about: Description that is written with the results.
        target: Spectrum asked for, from Hz to m²/Hz; None for a record.
        notes: Notes on the sea.
    """

    sea: IrregularSea
    about: dict[str, Any]
    target: Callable[[np.ndarray], np.ndarray] | None
    notes: list[str]


def build_sea(model: Model, asked: RequestedSea, duration: float) -> BuiltSea:
    """Build the sea that is requested.

    Args:
        model: The platform.
        asked: The request.
        duration: Duration of the simulation (s).

    Raises:
        InputError: The sea is impossible; the option or the record is named.
    """
    notes: list[str] = []
    low, cutoff = asked.band(float(model.pace))
    if asked.record is not None:
        waves, about = from_record(model, asked, asked.record, notes)
        target = None
    else:
        waves, about, target = _from_spectrum(model, asked, duration, notes)
    energy = 0.5 * float((np.asarray(waves.amplitude) ** 2).sum())
    about |= {
        "lowest_frequency": low,
        "cutoff": cutoff,
        "components": int(waves.omega.size),
        "repeat_period": round(float(waves.period), 6),
        "significant_wave_height_of_components": 4 * math.sqrt(energy),
        "heading": asked.heading,
        "order": asked.order,
        "stretching": asked.stretching,
        "diffraction": "none" if model.cylinders is None else model.conventions.diffraction,
    }
    usual = usual_cutoff(4 * math.sqrt(energy), float(model.environment.gravity))
    if asked.order == 2 and cutoff > usual:
        notes.append(
            f"in a sea this high second order is usually cut off at sqrt(2 g / Hs), --cutoff {usual:.2g} (Stansberg). "
            "Beyond, short waves bind more than they have"
        )
    if model.cylinders is None and model.conventions.diffraction != "none":
        notes.append("no member of this platform diffracts waves: 1 + Ca everywhere")
    if not asked.long_crested:
        _check_directional(model, asked, waves)
    sea = IrregularSea(waves, model.environment, 1 if asked.order == 1 else 2, asked.stretching)  # type: ignore[arg-type]
    if asked.record is not None:
        add_shares(sea, asked.record, about, notes)
    return BuiltSea(sea, about, target, notes)


def _check_directional(model: Model, asked: RequestedSea, waves: Components) -> None:
    """Raise InputError for a sea of several headings that cannot be simulated."""
    if asked.order == 2 and waves.omega.size**2 > MAX_PAIRS:
        expected = "1 in a sea of several headings"
        raise InputError("--order", [Problem("", expected, f"2 ({too_many_pairs(waves.omega.size)})")])
    if (fault := heading_fault(model, np.asarray(waves.heading))) is not None:
        raise InputError("platform", [Problem("", *fault)])


def outside(model: Model, sea: IrregularSea, about: dict[str, Any]) -> list[Remark]:
    """Remarks on energy outside the model's tables; `about` gets it too."""
    shares = outside_tables(model, sea.components)
    about |= {f"share_outside_{table.key}": share for table, share in shares.items()}
    return [remark for table, share in shares.items() if (remark := table.remark(share)) is not None]


def usual_cutoff(height: float, gravity: float) -> float:
    """Usual cutoff frequency (Hz) of second-order seas, sqrt(2 g / Hs) / 2 pi.

    Args:
        height: Significant wave height Hs (m).
        gravity: Acceleration of gravity g (m/s²).

    References:
        C. T. Stansberg (1998), Non-Gaussian extremes in numerically generated second-order random waves on deep water,
            ISOPE.
    """
    return math.sqrt(2 * gravity / height) / (2 * math.pi)


def _from_spectrum(
    model: Model, asked: RequestedSea, duration: float, notes: list[str]
) -> tuple[Components, dict[str, Any], Callable[[np.ndarray], np.ndarray]]:
    hs, tp, gamma = asked.hs or 0.0, asked.tp or 0.0, asked.gamma
    if asked.spectrum == "jonswap" and gamma is None and not asked.measured:
        gamma = float(peak_enhancement(hs, tp))
    low, cutoff = asked.band(float(model.pace))
    band = (2 * math.pi * low * (1 - 1e-9), 2 * math.pi * cutoff * (1 + 1e-9))

    directional = asked.directional

    def spectrum(omega):
        if directional is not None:
            return directional.density(omega)
        if asked.spectrum == "white":
            return white_noise(omega, hs, *band)
        return SPECTRA[asked.spectrum](omega, hs, tp, gamma)

    try:
        drawn: Any = {"low": low, "cutoff": cutoff, "seed": asked.seed, "amplitudes": asked.amplitudes}
        if directional is None:
            heading = math.radians(asked.heading)
            waves = spectrum_components(spectrum, duration, model.environment, heading=heading, **drawn)
        else:
            waves = directional_components(directional, duration, model.environment, **drawn)
    except BreakingError as error:
        option = "--hs" if directional is None else "--sea" if asked.measured is None else "--sea-file"
        raise InputError(option, [Problem("", "a sea that does not break", f"one too steep ({error})")]) from None
    except ValueError as error:
        raise impossible("--cutoff", error) from None
    density = np.asarray(spectrum(on_device(waves.omega)))  # as within `spectrum_components`, for one program less
    share = float(density.sum()) * 2 * math.pi / float(waves.period) / (hs**2 / 16)
    if share < MIN_SHARE:
        expected = f"a band, here {low:g} to {cutoff:g} Hz, with waves in it"
        raise InputError("--cutoff", [Problem("", expected, f"one with {share:.1%} of the spectrum")])
    if share < NOTED_SHARE:
        notes.append(f"{share:.1%} of the spectrum lies from {low:g} to {cutoff:g} Hz: see --low and --cutoff")
    about = {
        "spectrum": asked.spectrum,
        "significant_wave_height": hs,
        "peak_period": asked.tp,
        "peak_enhancement": gamma,
        "seed": asked.seed,
        "amplitudes": asked.amplitudes,
    }
    if not asked.long_crested:
        moments = circular_moments(np.asarray(waves.heading), np.asarray(waves.amplitude) ** 2)
        about |= {"mean_heading": math.degrees(moments.mean), "directional_width": math.degrees(moments.width)}
    if asked.measured is not None:
        about |= {"directional_spectrum": asked.measured.source, "x_bearing": asked.measured.x_bearing}
        about |= {"sea_time": asked.measured.time} if asked.measured.time else {}
    elif len(asked.systems) > 1 or not asked.long_crested:
        about["systems"] = "; ".join(system.words for system in asked.systems)
    return waves, about, lambda f: 2 * math.pi * np.asarray(spectrum(2 * math.pi * jnp.asarray(f)))
