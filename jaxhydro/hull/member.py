"""Member of the hull: its axis, directions and sizes, and its cuts into load elements."""

import math
from collections.abc import Mapping
from itertools import pairwise
from typing import NamedTuple

import numpy as np

COLUMN_SLOPE = math.cos(math.radians(45.0))
VERTICAL_COSINE = math.cos(math.radians(10.0))  # of an axis that counts as vertical
COLUMN_SPACING = (
    2.5  # m times the size of the hull, of the strips of a column under still water, if the platform file does not say
)
PONTOON_SPACING = 5.0  # the same of a pontoon
PARTLY_WET = 0.05  # of the height of a pontoon: less, under or above still water, does not matter
MIN_FLOATING_ELEMENTS = 8  # load elements at least along a member that lies at the surface
WHOLE_NUMBER_TOLERANCE = 0.05  # of a strip, that a hull may ask for beyond a whole number


class Member(NamedTuple):
    """Straight member of the hull.

    Attributes:
        name: Name of the member.
        group: Group whose coefficients it uses.
        circular: Whether its section is a circle or a rectangle.
        a: Start (m), (3,).
        b: End (m), (3,).
        stations: Fractions (0 to 1) of the length, (n,).
        sizes: Size (m) along directions 1 and 2 at the stations, (n, 2): a diameter twice, or width and height.
        twist: Rotation (rad) of the directions about the axis.
        elements: Number of load elements, or None.
        maccamy_fuchs: Whether it diffracts waves; None: where it is vertical, circular and pierces the surface.
        points: Strips of each of `elements`.
        shared: Group whose coefficient is used in place of its own group's, by coefficient such as Ca_t.
    """

    name: str
    group: str
    circular: bool
    a: np.ndarray
    b: np.ndarray
    stations: np.ndarray
    sizes: np.ndarray
    twist: float = 0.0
    elements: int | None = None
    maccamy_fuchs: bool | None = None  # None: where it is vertical, circular and pierces the surface
    points: int = 2  # strips of each of `elements`; 1: lumped at its middle
    shared: Mapping[str, str] = {}

    @property
    def axis(self) -> np.ndarray:
        """Unit vector from the lower to the upper end of members that fill from below, from a to b of others."""
        return -self._along if self.fills and self._along[2] < 0 else self._along

    @property
    def _along(self) -> np.ndarray:
        return (self.b - self.a) / np.linalg.norm(self.b - self.a)

    @property
    def column(self) -> bool:
        return abs(self.b[2] - self.a[2]) > COLUMN_SLOPE * float(np.linalg.norm(self.b - self.a))

    @property
    def directions(self) -> tuple[np.ndarray, np.ndarray]:
        """Unit vectors across the axis: horizontal and upward for a pontoon, x and y for a column."""
        return self._across(self.axis)

    def _across(self, axis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        if abs(axis[2]) > 1.0 - 1e-9:
            first = np.array([1.0, 0.0, 0.0])
        else:
            first = np.cross([0.0, 0.0, 1.0], axis)
            first /= np.linalg.norm(first)
        second = np.cross(axis, first)
        c, s = math.cos(self.twist), math.sin(self.twist)
        return c * first + s * second, c * second - s * first

    @property
    def gauge(self) -> np.ndarray:
        """Point (m) where the surface elevation is looked up.

        It is on the axis at still water if the member `fills`, else its middle.
        """
        if self.fills:
            return self.a + (self.b - self.a) * (-self.a[2] / (self.b[2] - self.a[2]))
        return 0.5 * (self.a + self.b)

    def size(self, fraction: np.ndarray) -> np.ndarray:
        """Size along both directions (m) at fractions of the length, (n, 2)."""
        return np.stack([np.interp(fraction, self.stations, self.sizes[:, i]) for i in range(2)], axis=-1)

    @property
    def diffracts(self) -> bool:
        """Whether it diffracts waves as MacCamy and Fuchs have it."""
        if self.maccamy_fuchs is not None:
            return self.maccamy_fuchs
        low, high = sorted((self.a[2], self.b[2]))
        return self.circular and self.axis[2] > VERTICAL_COSINE and low < 0 <= high

    def kinks(self) -> list[float]:
        """Fractions of the length, strictly inside, at which the taper changes."""
        slope = np.diff(self.sizes, axis=0) / np.diff(self.stations)[:, None]
        bend = np.abs(np.diff(slope, axis=0)).max(axis=1)
        return [
            float(station)
            for station, change in zip(self.stations[1:-1], bend, strict=True)
            if change > 1e-9 * self.sizes.max()
        ]

    @property
    def submerged(self) -> float:
        """Fraction (-) of its height that is below still water at the reference position."""
        heights = np.concatenate(self._edges())
        low, high = float(heights.min()), float(heights.max())
        return min(1.0, max(0.0, -low / (high - low)))

    def _edges(self) -> tuple[np.ndarray, np.ndarray]:
        """Lowest and highest z (m) of the faces at a and b."""
        first, second = (abs(float(direction[2])) for direction in self._across(self._along))
        edges = []
        for end, size in ((self.a, self.sizes[0]), (self.b, self.sizes[-1])):
            half = 0.5 * math.hypot(first, second) * size[0] if self.circular else 0.5 * (first * size[0] + second * size[1])
            edges.append(np.array([end[2] - half, end[2] + half]))
        return edges[0], edges[1]

    @property
    def pierced(self) -> bool:
        """Whether still water cuts it lengthwise, as a pontoon that is partly wet."""
        return not self.column and PARTLY_WET < self.submerged < 1 - PARTLY_WET

    @property
    def upward(self) -> int | None:
        """Index of the near-vertical direction of a member wet by its local depth, else None."""
        steep = [abs(float(direction[2])) > VERTICAL_COSINE for direction in self._across(self._along)]
        if abs(float(self._along[2])) > math.sqrt(1 - VERTICAL_COSINE**2) or not (any(steep) or self.circular):
            return None
        return 0 if steep[0] else 1

    @property
    def fills(self) -> bool:
        """Whether it fills from its lower end: a column, or an inclined pontoon cut by still water."""
        if self.column:
            return True
        low, high = sorted(self._edges(), key=lambda edge: edge[0])
        return self.pierced and self.upward is None and low[1] <= 0.0 <= high[0]

    @property
    def floats(self) -> bool:
        """Whether it lies at the surface: see `waterplane`."""
        return self.pierced and self.upward is not None

    def area(self, size: np.ndarray) -> np.ndarray:
        return size[..., 0] * size[..., 1] * (math.pi / 4 if self.circular else 1.0)

    def elements_and_orders(self, size: float = 1.0) -> list[tuple[float, float, int]]:
        """Load elements as fractions of the length from a to b, with the number of strips of each.

        As many as the platform file says, `points` strips each, cut at `kinks` too; else one between stations, with as many
        as its length asks for in a hull of a `size` (`scales.size_of`).
        """
        length = float(np.linalg.norm(self.b - self.a))
        if self.floats:
            fractions = np.linspace(0.0, 1.0, max(self.elements or 0, MIN_FLOATING_ELEMENTS) + 1)
            far = [kink for kink in self.kinks() if np.abs(fractions - kink).min() > 1e-9]
            return [(lo, hi, self.points) for lo, hi in pairwise(np.sort([*fractions, *far]))]
        if self.elements is not None:
            fractions = np.linspace(0.0, 1.0, self.elements + 1)
            far = [kink for kink in self.kinks() if np.abs(fractions - kink).min() > 1e-9]
            return [(lo, hi, self.points) for lo, hi in pairwise(np.sort([*fractions, *far]))]
        elements = []
        for lo, hi in pairwise(self.stations):
            low, high = sorted((self.a + (self.b - self.a) * fraction)[2] for fraction in (lo, hi))
            under = min(1.0, max(0.0, -low) / max(high - low, 1e-9 * length)) if self.fills else 1.0
            spacing = size * (COLUMN_SPACING if self.column else PONTOON_SPACING)
            count = math.ceil(under * (hi - lo) * length / spacing - WHOLE_NUMBER_TOLERANCE)
            elements.append((float(lo), float(hi), max(2, min(count, 20))))
        return elements
