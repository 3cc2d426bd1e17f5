"""Support wavenumbers in place of all wave components, which make a sea cheap at displaced positions.

Over the box that a platform can occupy, exp(-ikx) with its profile over depth is a function of k of low numerical rank. So
the field of every wavenumber is a combination, with weights w_r(k), of the fields of R of them. N components then collapse,
once per sea, to R whose amplitudes are functions of time: sum over n of w_r(k_n) a_n exp(i omega_n t).
"""

import math
from functools import lru_cache
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.waves.wave_errors import ShortWavesError

SPACING_POWER = 0.75  # supports are Chebyshev points in k^POWER: denser where profiles change most
TOLERANCE = 1e-5  # of a free wave's largest value, that its field may be missed by in the box
BOUND_TOLERANCE_FACTOR = 30.0  # times as much for bound waves shorter than all free ones
RIDGE = 1e-10  # of the largest singular value: keeps weights small without losing accuracy
MAX_SUPPORTS = 96
QR_BLOCKS = (16, 4)  # blocks of rows of a least-squares matrix, and of what they leave; it has a multiple of 32 rows


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
        q, r = _tall_qr(basis, QR_BLOCKS)
        u, s, vt = np.linalg.svd(r)
        table = (vt.T * (s / (s**2 + (RIDGE * s[0]) ** 2))) @ (u.T @ (q.T @ wanted))
        error = np.abs(basis @ table - wanted).max(axis=0)
        if (error <= allowed)[inside].all():
            return Supports(k, table.T.copy(), spacing, float(error[inside & (grid <= free)].max()))
        count += 4
    raise ShortWavesError(_too_short(highest, box))


def _tall_qr(matrix: np.ndarray, blocks: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray]:
    """QR factors of a tall matrix, by blocks of rows.

    LAPACK would share out each column of the whole matrix between threads, which takes a hundred times as long.
    """
    if not blocks:
        return np.linalg.qr(matrix)
    columns = matrix.shape[1]
    q, r = np.linalg.qr(matrix.reshape(blocks[0], -1, columns))
    joined, last = _tall_qr(r.reshape(-1, columns), blocks[1:])
    return (q @ joined.reshape(blocks[0], -1, columns)).reshape(-1, columns), last


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
