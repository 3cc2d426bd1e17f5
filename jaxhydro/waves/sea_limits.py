"""Limits of wave theory that a sea comes near: breaking, and shallow water."""

import math

import jax.numpy as jnp

from jaxhydro.environment import Environment
from jaxhydro.remarks import Remark
from jaxhydro.waves.dispersion import wavenumber

MICHE = 0.142  # height over length times tanh kd, at which a wave breaks
MAX_HEIGHT_PER_DEPTH = 0.6  # Hs over depth, from which waves break by depth
MAX_URSELL = 40.0  # H L² / d³, from which second-order Stokes theory is not valid


def sea_limits(height: float, period: float, environment: Environment, order: int, waves: float | None = None) -> list[Remark]:
    """Remarks on a sea, or on a regular wave, that comes near the limits of wave theory.

    - Depth: Hs / d above 0.6; of a regular wave H / d above 0.78.
    - Steepness: the expected highest wave, Hs sqrt(ln N / 2), of the peak period breaks, H / L > 0.142 tanh kd.
    - Shallow water: the Ursell number H L² / d³ is above 40. Second order is then wrong, and linear theory with it. Stream
      functions are not.

    Args:
        height: Significant wave height of a sea, or height of a regular wave (m).
        period: Peak period, or period (s).
        environment: Water depth and gravity.
        order: 1 or 2; more for a stream function.
        waves: Number of waves N in the sea; None: a regular wave.

    Returns:
        The remarks, most important first.

    References:
        Thornton and Guza (1982), Journal of Geophysical Research 87, 9499-9508, on Hs over depth; McCowan (1894), on 0.78;
        Miche (1944), on steepness; Longuet-Higgins (1952), Journal of Marine Research 11, 245-266, on the highest wave;
        Hedges (1995), Proc. ICE Water, Maritime and Energy 112, 111-114, on the Ursell number.
    """
    return [remark for limit in LIMITS if (remark := limit(height, period, environment, order, waves)) is not None]


def breaking_by_depth(height: float, period: float, environment: Environment, order: int, waves: float | None) -> Remark | None:
    """Remark on waves that are too high for the depth; arguments of `sea_limits`."""
    depth = float(environment.depth)
    quantity, limit = ("height", 0.78) if waves is None else ("significant height", MAX_HEIGHT_PER_DEPTH)
    if height <= limit * depth:
        return None
    text = f"the {quantity}, {height:.3g} m, is {height / depth:.2g} of the depth: waves break by depth above {limit:g}"
    return Remark(text, warning=True)


def breaking_by_steepness(
    height: float, period: float, environment: Environment, order: int, waves: float | None
) -> Remark | None:
    """Remark on an irregular sea whose highest wave would break; arguments of `sea_limits`."""
    if waves is None:
        return None
    length = _length(period, environment)
    highest = height * math.sqrt(0.5 * math.log(max(waves, 2.0)))
    steepest = MICHE * length * math.tanh(2 * math.pi * float(environment.depth) / length)
    if highest <= steepest:
        return None
    text = f"the highest of {waves:.0f} waves, about {highest:.3g} m, would break: at {period:.3g} s {steepest:.3g} m stand"
    return Remark(f"{text} (Miche). The model has no breaking")


def shallow_water(height: float, period: float, environment: Environment, order: int, waves: float | None) -> Remark | None:
    """Remark on waves too long for the depth, for first and second order; arguments of `sea_limits`."""
    ursell = height * _length(period, environment) ** 2 / float(environment.depth) ** 3
    if ursell <= MAX_URSELL or order > 2:
        return None
    worst = "bound waves of second order are too high" if order == 2 else "linear theory is not valid"
    return Remark(f"the Ursell number is {ursell:.3g}: above {MAX_URSELL:g} (Hedges 1995) {worst}", warning=order == 2)


def _length(period: float, environment: Environment) -> float:
    """Wavelength (m) by linear dispersion."""
    depth, gravity = jnp.asarray(environment.depth), jnp.asarray(environment.gravity)
    return 2 * math.pi / float(wavenumber(jnp.asarray(2 * math.pi / period), depth, gravity))


LIMITS = (breaking_by_depth, breaking_by_steepness, shallow_water)
"""Limits that seas are compared with, most important first."""
