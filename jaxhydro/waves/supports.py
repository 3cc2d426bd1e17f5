"""Support wavenumbers in place of all wave components, which make a sea cheap at displaced positions.

Over the box that a platform can occupy, exp(-ikx) with its profile over depth is a function of k of low numerical rank. So
the field of every wavenumber is a combination, with weights w_r(k), of the fields of R of them. N components then collapse,
once per sea, to R whose amplitudes are functions of time: sum over n of w_r(k_n) a_n exp(i omega_n t).
"""

import math
from functools import lru_cache, partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax.custom_derivatives import SymbolicZero
from jaxtyping import Array, Float

from jaxhydro.waves.wave_errors import ShortWavesError

SPACING_POWER = 0.75  # supports are Chebyshev points in k^POWER: denser where profiles change most
TOLERANCE = 1e-5  # of a free wave's largest value, that its field may be missed by in the box
BOUND_TOLERANCE_FACTOR = 30.0  # times as much for bound waves shorter than all free ones
RIDGE = 1e-10  # of the largest singular value: keeps weights small without losing accuracy
MAX_SUPPORTS = 96


class Box(NamedTuple):
    """Region in which a wave field is needed, about a middle.

    Attributes:
        half: Half length along the waves (m).
        low: Lowest level (m); the highest is 0.
        depth: Water depth (m).
    """

    half: float
    low: float
    depth: float

    @classmethod
    def of(cls, points: Float[np.ndarray, "3 p"], heading: float, depth: float, excursion: float) -> "tuple[float, Box]":
        """Middle (m) along the waves, and box about it, of a hull that may move.

        The box is rounded up by fractions of the excursion, so that similar hulls and headings share one.

        Args:
            points: Extremities of the hull (m), (3, p).
            heading: Direction that the waves travel to (rad).
            depth: Water depth (m).
            excursion: Distance (m) by which the hull may move.
        """
        along = np.array([math.cos(heading), math.sin(heading)]) @ points[:2]
        half = 0.5 * np.ptp(along) + excursion
        wide, deep = 0.25 * excursion, 0.1 * excursion
        low = max(-depth, float(points[2].min()) - 0.3 * excursion)
        middle = float(0.5 * (along.max() + along.min()))
        return middle, cls(wide * math.ceil(half / wide - 1e-9), deep * math.floor(low / deep + 1e-9), depth)


class Supports(NamedTuple):
    """Support wavenumbers, their weights and their error.

    Attributes:
        wavenumber: Support wavenumbers (rad/m), (r,).
        table: Weights w_r(k) on an even grid of sqrt(k) from 0, (g, r).
        spacing: Spacing of that grid (sqrt(rad/m)).
        error: Largest error (-) for free waves.
    """

    wavenumber: np.ndarray  # (r,)
    table: np.ndarray  # (g, r)
    spacing: float
    error: float


@lru_cache(maxsize=64)
def supports(box: Box, free: float, bound: float = 0.0, tolerance: float = TOLERANCE) -> Supports:
    """Fewest support wavenumbers in a box for free and bound waves.

    Weights are the least-squares solution over a grid on the box. They are for cosh k(z+h) / cosh kh and sinh k(z+h) / sinh
    kh, times cos kx and sin kx. Bound waves shorter than all free ones are low; their tolerance is `BOUND_TOLERANCE_FACTOR`
    times larger.

    Args:
        box: Region in which the field is needed.
        free: Largest wavenumber of free waves (rad/m).
        bound: Largest wavenumber of bound waves (rad/m).
        tolerance: Error allowed, over a free wave's largest value.

    Returns:
        Wavenumbers and weights.

    Raises:
        ShortWavesError: More than `MAX_SUPPORTS` supports would be needed: a box of many wavelengths.
    """
    highest = max(free, bound)
    count = math.ceil((0.5 * highest * box.half + 8) / 4) * 4
    if count > MAX_SUPPORTS:  # before arrays that would fill the memory
        raise ShortWavesError(_too_short(highest, box))
    spacing = 0.05 / (box.half * math.sqrt(highest))
    grid = (spacing * np.arange(math.ceil(math.sqrt(highest) / spacing) + 3)) ** 2
    points = max(24, math.ceil(1.5 * highest * box.half / math.pi) + 12)
    x = box.half * np.sin(0.5 * np.pi * (np.arange(points) + 0.5) / points)  # denser at the edge
    z = box.low * (0.5 - 0.5 * np.cos(np.pi * (np.arange(8) + 0.5) / 8)) ** 2  # denser at the surface
    wanted = _fields(grid, x, z, box.depth)
    allowed = np.where(grid <= free, tolerance, BOUND_TOLERANCE_FACTOR * tolerance)
    inside = grid <= highest
    while count <= MAX_SUPPORTS:
        chebyshev = np.cos(np.pi * (np.arange(count) + 0.5) / count)[::-1]
        k = highest * (0.5 * (1 + chebyshev)) ** (1 / SPACING_POWER)
        basis = _fields(k, x, z, box.depth)
        u, s, vt = np.linalg.svd(basis, full_matrices=False)
        table = (vt.T * (s / (s**2 + (RIDGE * s[0]) ** 2))) @ (u.T @ wanted)
        error = np.abs(basis @ table - wanted).max(axis=0)
        if (error <= allowed)[inside].all():
            return Supports(k, table.T.copy(), spacing, float(error[inside & (grid <= free)].max()))
        count += 4
    raise ShortWavesError(_too_short(highest, box))


def _too_short(highest: float, box: Box) -> str:
    return (
        f"waves down to {2 * math.pi / highest:.3g} m in a box of {2 * box.half:.3g} m need more than {MAX_SUPPORTS} "
        f"support wavenumbers: cut the sea off at a lower frequency"
    )


def _fields(k: np.ndarray, x: np.ndarray, z: np.ndarray, depth: float) -> np.ndarray:
    """Real and imaginary parts of both profiles times exp(-ikx) at all points, (4 n, k).

    x and -x have the same weights.
    """
    phase = k[None] * x[:, None]
    down, up = np.exp(k * z[:, None]), np.exp(-k * (z[:, None] + 2 * depth))
    cosh = (down + up) / (1 + np.exp(-2 * k * depth))
    kd = np.maximum(k * depth, 1e-9)
    sinh = np.where(k * depth > 1e-6, (down - up) / -np.expm1(-2 * kd), 1 + z[:, None] / depth)
    waves = (np.cos(phase), np.sin(phase))
    return np.concatenate([(wave[:, None] * profile[None]).reshape(-1, k.size) for wave in waves for profile in (cosh, sinh)])


def weights(table: Float[Array, "g r"], spacing: float, k: Float[Array, " n"]) -> Float[Array, "n r"]:
    """Weights w_r(k) (-), (n, r), by cubic interpolation of the table in sqrt(k)."""
    steps = jnp.sqrt(jnp.maximum(k, 1e-20)) / spacing
    base = jnp.clip(jnp.floor(steps).astype(int) - 1, 0, table.shape[0] - 4)
    t = (steps - base)[:, None]  # of the cubic through 0, 1, 2, 3
    near = [
        -(t - 1) * (t - 2) * (t - 3) / 6,
        t * (t - 2) * (t - 3) / 2,
        -t * (t - 1) * (t - 3) / 2,
        t * (t - 1) * (t - 2) / 6,
    ]
    return near[0] * table[base] + sum(factor * table[base + i] for i, factor in enumerate(near[1:], 1))


def cosine_sine(x: Float[Array, "..."]) -> tuple[Float[Array, "..."], Float[Array, "..."]]:
    """cos x and sin x to 1e-11 for |x| up to about 1000, in vectorisable arithmetic.

    Reduction to |r| <= pi/2 by half turns, which only change both signs, and Taylor's series (Abramowitz and Stegun 1964,
    4.3.65 and 4.3.66).
    """
    half = jnp.round(x * (1 / math.pi))
    r = (x - half * math.pi) - half * 1.2246467991473532e-16  # pi less its float64
    sign = 1 - 2 * (half - 2 * jnp.floor(0.5 * half))
    square = r * r
    return sign * _taylor(square, 16), (sign * r) * _taylor(square, 15)


def _taylor(square: Float[Array, "..."], last: int) -> Float[Array, "..."]:
    """Series of cos x up to x^last; where `last` is odd, series of sin x / x.

    It is evaluated by Horner's rule, without division.

    Args:
        square: x².
        last: Highest power of x, in sin x where it is odd.
    """
    terms = [(-1) ** (power // 2) / math.factorial(power) for power in range(last, -1, -2)]
    total = jnp.full_like(square, terms[0])
    for term in terms[1:]:
        total = total * square + term
    return total


@jax.custom_jvp
def field(
    even: Float[Array, "p 2*r"],
    odd: Float[Array, "q 2*r"],
    k: Float[Array, " r"],
    x: Float[Array, " n"],
    z: Float[Array, " n"],
    fade: Float[Array, " r"],
) -> tuple[Float[Array, "p n"], Float[Array, "q n"]]:
    """Sums over supports at points, Re sum c_r P(k_r, z) exp(-i k_r x).

    P is cosh k(z+h) / cosh kh for `even`, sinh k(z+h) / sinh kh for `odd`. Amplitudes are real parts, then imaginary ones;
    `fade` is exp(-2kh). Derivatives by x and z are worked out once for all directions asked for.
    """
    cosh, sinh = _terms(k, x, z, fade)
    return even @ cosh, odd @ sinh


def _terms(k, x, z, fade) -> tuple[Float[Array, "2*r n"], Float[Array, "2*r n"]]:
    cosine, sine = cosine_sine(k[:, None] * x)
    down = jnp.exp(k[:, None] * z)
    # barriers: else XLA works them out anew for every product that reads them
    cosine, sine, down = jax.lax.optimization_barrier((cosine, sine, down))
    fade = fade[:, None]
    up = fade / down
    cosh, sinh = (down + up) * (1 / (1 + fade)), (down - up) * (1 / (1 - fade))
    return jnp.concatenate([cosh * cosine, cosh * sine]), jnp.concatenate([sinh * cosine, sinh * sine])


@partial(field.defjvp, symbolic_zeros=True)
def _field_jvp(primals, tangents):
    even, odd, k, x, z, fade = primals
    d_even, d_odd, _, d_x, d_z, _ = tangents
    cosh, sinh = jax.lax.optimization_barrier(_terms(k, x, z, fade))
    p, q, k, tanh = len(even), len(odd), jnp.concatenate([k, k]), jnp.tile((1 - fade) / (1 + fade), 2)
    # d/dz of cosh/cosh kh is k tanh kh times sinh/sinh kh, and the other way round
    with_cosh = jnp.concatenate([even, support_slope(even, k), odd * (k / tanh)]) @ cosh
    with_sinh = jnp.concatenate([odd, support_slope(odd, k), even * (k * tanh)]) @ sinh
    with_cosh, with_sinh = jax.lax.optimization_barrier((with_cosh, with_sinh))
    d_along = with_cosh[p : 2 * p] * _zeros(d_x) + with_sinh[2 * q :] * _zeros(d_z)
    d_up = with_sinh[q : 2 * q] * _zeros(d_x) + with_cosh[2 * p :] * _zeros(d_z)
    if not isinstance(d_even, SymbolicZero):
        d_along = d_along + d_even @ cosh
    if not isinstance(d_odd, SymbolicZero):
        d_up = d_up + d_odd @ sinh
    return (with_cosh[:p], with_sinh[:q]), (d_along, d_up)


def support_slope(amplitude: Float[Array, "p 2*r"], k: Float[Array, " 2*r"]) -> Float[Array, "p 2*r"]:
    """Amplitudes of the derivative by x: d/dx cos kx = -k sin kx."""
    real, imaginary = jnp.split(amplitude, 2, axis=-1)
    return jnp.concatenate([imaginary, -real], axis=-1) * k


def _zeros(tangent):
    """A tangent as an array."""
    return jnp.zeros(tangent.shape, tangent.dtype) if isinstance(tangent, SymbolicZero) else tangent


@jax.custom_jvp
def surface(amplitude: Float[Array, " 2*r"], k: Float[Array, " r"], x: Float[Array, " n"]) -> Float[Array, " n"]:
    """Re sum c_r exp(-i k_r x): `field` at z = 0, for one quantity."""
    return amplitude @ jnp.concatenate(cosine_sine(k[:, None] * x))


@partial(surface.defjvp, symbolic_zeros=True)
def _surface_jvp(primals, tangents):
    amplitude, k, x = primals
    d_amplitude, _, d_x = tangents
    terms = jax.lax.optimization_barrier(jnp.concatenate(cosine_sine(k[:, None] * x)))
    sums = jnp.stack([amplitude, support_slope(amplitude, jnp.concatenate([k, k]))]) @ terms
    tangent = sums[1] * _zeros(d_x)
    return sums[0], tangent if isinstance(d_amplitude, SymbolicZero) else tangent + d_amplitude @ terms
