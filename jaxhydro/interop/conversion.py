"""Result of reading another program's model: a platform file, and what became of each source item."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Any


class Treatment(StrEnum):
    """What became of an item of the source."""

    TAKEN = "taken"
    APPROXIMATED = "approximated"
    LEFT_OUT = "left out"
    TO_FILL_IN = "to be filled in"


@dataclass(frozen=True)
class ConvertedItem:
    """One item of the source.

    Attributes:
        source: File and key, such as `HydroDyn.dat: Simple hydrodynamic coefficients`. Of what is to be filled in: the
            platform file's key.
        treatment: What became of it.
        meaning: In a sentence: what it is in the platform file, what was assumed, or why it was left out.
        warning: Whether the platform is wrong without it, so that it has to be looked at.
    """

    source: str
    treatment: Treatment
    meaning: str
    warning: bool = False


@dataclass(frozen=True)
class Conversion:
    """A platform read from another program's files.

    Attributes:
        platform: Contents of `platform.yaml`, as plain dictionaries, lists, numbers and words.
        items: What became of each item of the source.
        files: Files that `platform.yaml` refers to: name beside it -> file to copy.
        whole: Whether `platform` is a whole platform file. Else it is its sections `water` and `mooring` alone.
    """

    platform: dict[str, Any]
    items: tuple[ConvertedItem, ...]
    files: Mapping[str, Path] = field(default_factory=dict)
    whole: bool = True
