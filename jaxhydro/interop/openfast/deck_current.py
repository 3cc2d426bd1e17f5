"""The steady current of a deck as `water.current` of the platform file.

References:
    OpenFAST v5.0.0 (2895884), SeaState, `Calc_Current` in Current.f90: the sum of a sub-surface current, CurrSSV0
    ((z + h) / h)^(1/7), a near-surface one, CurrNSV0 (z + CurrNSRef) / CurrNSRef where that is positive, and one that is the
    same at all depths, CurrDIV. Each has its own direction.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.openfast.keyed_file import KeyedFile

KEYS = "CurrMod, CurrSSV0, CurrSSDir, CurrNSRef, CurrNSV0, CurrNSDir, CurrDIV, CurrDIDir"
OFF, STANDARD = 0, 1
EXPONENT = 1 / 7  # of the sub-surface current
LEVELS = 25  # heights at which a sum with the power law is stated, closer towards the bed, where it is steep


@dataclass(frozen=True)
class DeckCurrent:
    """The three currents of a deck.

    Attributes:
        sub: Speed at still water (m/s) and direction (deg) of the sub-surface current.
        near: The same of the near-surface current.
        uniform: The same of the current that is alike at all depths.
        reference: Depth down to which the near-surface current reaches (m).
    """

    sub: tuple[float, float]
    near: tuple[float, float]
    uniform: tuple[float, float]
    reference: float

    def at(self, z: np.ndarray, depth: float) -> np.ndarray:
        """Velocity along x and y.

        Args:
            z: Heights over still water (m), (k,).
            depth: Depth of the water (m).

        Returns:
            Velocity (m/s), (2, k).
        """
        shapes = (
            (self.sub, np.clip((z + depth) / depth, 0.0, None) ** EXPONENT),
            (self.near, np.clip((z + self.reference) / self.reference, 0.0, None)),
            (self.uniform, np.ones_like(z)),
        )
        return sum(
            (
                speed * share * np.array([[math.cos(math.radians(towards))], [math.sin(math.radians(towards))]])
                for (speed, towards), share in shapes
            ),
            np.zeros((2, len(z))),
        )


def _read(file: KeyedFile) -> DeckCurrent:
    """The current of a deck. Raises InputError for a negative speed or reference depth."""

    def speed(key: str) -> float:
        value = file.number(key, 0.0)
        if value < 0.0:
            raise file.wrong(file.line_of(key), "a speed >= 0, in m/s", f"{value:g}", key=key)
        return value

    heading = file.number("CurrSSDir", 0.0, standard=file.number("WaveDir", 0.0))
    near = speed("CurrNSV0")
    reference = file.number("CurrNSRef") if near else 1.0
    if reference <= 0.0:
        raise file.wrong(file.line_of("CurrNSRef"), "a depth > 0, in m", f"{reference:g}", key="CurrNSRef")
    uniform = (speed("CurrDIV"), file.number("CurrDIDir", 0.0))
    return DeckCurrent((speed("CurrSSV0"), heading), (near, file.number("CurrNSDir", 0.0)), uniform, reference)


def read_current(file: KeyedFile, depth: float) -> tuple[dict[str, Any], list[ConvertedItem]]:
    """`current` of the platform file from a SeaState file, or HydroDyn's of older decks.

    Args:
        file: The file.
        depth: Water depth below still water (m).

    Returns:
        The contents of `current`, empty where there is none, and what became of it.

    Raises:
        InputError: A number is missing or out of range; file and line are named.
    """
    mode = file.whole("CurrMod", OFF)
    if mode == OFF:
        return {}, []

    def item(treatment: Treatment, meaning: str) -> list[ConvertedItem]:
        return [ConvertedItem(f"{file.name}: {KEYS if mode == STANDARD else 'CurrMod'}", treatment, meaning)]

    if mode != STANDARD:
        return {}, item(Treatment.LEFT_OUT, "The current of a user's routine is not known: state `water.current`.")
    currents = _read(file)
    stated = [part for part in (currents.sub, currents.near, currents.uniform) if part[0]]
    if not stated:
        return {}, item(Treatment.LEFT_OUT, "All of its speeds are 0: there is no current.")
    if len(stated) == 1 and not currents.near[0]:
        speed, heading = stated[0]
        current = {"speed": speed, "heading": heading} | ({"exponent": EXPONENT} if currents.sub[0] else {})
        return current, item(Treatment.TAKEN, "`water.current`, the same law.")
    heights = _heights(currents, depth)
    velocity = currents.at(heights, depth)
    levels = [_level(z, *both) for z, both in zip(heights, velocity.T)]
    layered: dict[str, Any] = {"levels": levels}
    if not currents.sub[0]:
        return layered, item(Treatment.TAKEN, "`water.current` by levels, linear between them as here.")
    fine = np.linspace(-depth, 0.0, 4001)
    between = np.stack([np.interp(fine, heights[::-1], row[::-1]) for row in velocity])
    missed = float(np.hypot(*(between - currents.at(fine, depth))).max())
    text = f"`water.current` by {len(levels)} levels of the sum of its parts, within {missed:.2g} m/s of it at all depths."
    return layered, item(Treatment.APPROXIMATED, text)


def _heights(currents: DeckCurrent, depth: float) -> np.ndarray:
    """Heights (m) of levels from still water down.

    They lie where the near-surface current ends, and along the power law.
    """
    ends = {0.0, max(-currents.reference, -depth)} if currents.near[0] else {0.0}
    power = depth * (np.linspace(0.0, 1.0, LEVELS) ** 3 - 1.0) if currents.sub[0] else np.zeros(0)
    return np.unique(np.round([*ends, *power], 3))[::-1]


def _level(z: float, x: float, y: float) -> dict[str, float]:
    speed = math.hypot(x, y)
    level = {"z": float(z) + 0.0, "speed": round(speed, 6)}
    return level | ({"heading": heading} if speed and (heading := round(math.degrees(math.atan2(y, x)), 4)) else {})
