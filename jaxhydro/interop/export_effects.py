"""Effects of a platform that another program has no counterpart for, with their values."""

from collections.abc import Iterator

import numpy as np

from jaxhydro.interop.conversion import ConvertedItem, Treatment
from jaxhydro.interop.export_source import ExportSource
from jaxhydro.loads import AbstractLoad
from jaxhydro.loads.sea_state_law import SeaStateLaw
from jaxhydro.parameters import AbstractEffect


def plain_load(load: AbstractLoad) -> AbstractLoad:
    """A load without its law over the sea state."""
    return load.load if isinstance(load, SeaStateLaw) else load


def effects_left_out(
    source: ExportSource, written: tuple[type[AbstractEffect], ...], target: str = "The deck"
) -> Iterator[ConvertedItem]:
    """Loads, water effects and sensor effects that are not written, and exponents of sea-state laws.

    Effects at their neutral values are not told.

    Args:
        source: The platform.
        written: Classes of the effects that are written.
        target: What is written, at the beginning of a sentence.
    """
    model = source.model
    for load in model.loads:
        if isinstance(load, SeaStateLaw):
            told = told_values(load, [label for label in load.values if label not in load.load.values])
            text = f"{target} has the coefficients of the reference sea; exponents are left out: {told}."
            yield ConvertedItem("sea_state_laws", Treatment.LEFT_OUT, text)
    for effect in (*map(plain_load, model.loads), *model.water, *model.sensors):
        if isinstance(effect, written):
            continue
        moved = [label for label, value in effect.values.items() if np.any(np.asarray(value) != effect.about(label).neutral)]
        if moved or not effect.values:
            told = told_values(effect, moved) or "no parameters"
            text = f"{target} has no counterpart of {type(effect).__name__}: {told}."
            yield ConvertedItem(effect.prefix, Treatment.LEFT_OUT, text)


def told_values(effect: AbstractEffect, labels: list[str]) -> str:
    """Values of parameters with their units, in one line.

    Args:
        effect: The effect.
        labels: Labels of its parameters.
    """
    return ", ".join(f"{label} = {float(effect.values[label]):.4g} {effect.about(label).unit}" for label in labels)
