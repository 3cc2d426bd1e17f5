"""Drag laws of a model by coefficient label, and their replacement."""

import math
from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any, TypeAlias

import numpy as np

from jaxhydro.dynamics.model import Model
from jaxhydro.hull.hull import Hull
from jaxhydro.loads import AbstractLoad
from jaxhydro.loads.drag import (
    DRAG_LAWS,
    AbstractDragLaw,
    ConstantLaw,
    HighPassLaw,
    KeuleganCarpenterLaw,
    MorisonDrag,
    SuctionSideLaw,
)
from jaxhydro.loads.drag.abstract_law import LAW_LABEL
from jaxhydro.loads.drag.drag_flow import lines_of
from jaxhydro.loads.sea_state_law import EXPONENT_BASES, SeaStateLaw, exponent_label
from jaxhydro.parameters import METADATA_KEY, strongly_typed
from jaxhydro.platform.coefficients_schema import ConstantDrag, HighPass, HighPassAtEnds, KeuleganCarpenter, SuctionSide

DragLaw: TypeAlias = ConstantDrag | HighPass | HighPassAtEnds | KeuleganCarpenter | SuctionSide
Key: TypeAlias = tuple[str, str]
"""Group of members, and kind of its drag coefficient: t or z."""
_LAW_PARAMETERS = [
    field.name
    for law in DRAG_LAWS.values()
    for field in fields(law)
    if METADATA_KEY in field.metadata and field.metadata[METADATA_KEY].label == LAW_LABEL
]


def drag_of(load: AbstractLoad) -> MorisonDrag | None:
    """Drag that a load is, or whose coefficients it lets depend on the sea state; None for other loads."""
    inner = load.load if isinstance(load, SeaStateLaw) else load
    return inner if isinstance(inner, MorisonDrag) else None


def drag_laws_of(model: Model) -> dict[str, DragLaw]:
    """Drag laws of a model by coefficient label, plain drag left out; values are not checked."""
    by_label: dict[str, DragLaw] = {}
    for load in model.loads:
        if (drag := drag_of(load)) is not None:
            laws = {label: _declared(drag.law, key, model.hull) for label, key in _coefficients(drag).items()}
            by_label |= {label: law for label, law in laws.items() if law is not None}
    return by_label


def _declared(law: AbstractDragLaw, key: Key, hull: Hull) -> DragLaw | None:
    """A coefficient's law as a platform file declares it; None for plain drag."""
    if isinstance(law, HighPassLaw):
        suction = law.law.suction.get(key) if isinstance(law.law, SuctionSideLaw) else None
        return HighPassAtEnds.model_construct(
            law="high_pass",
            cutoff=float(law.cutoff[key]),
            low_share=float(law.low_share[key]),
            suction=None if suction is None else float(suction),
        )
    if isinstance(law, KeuleganCarpenterLaw):
        line = law.lines.index(lines_of(hull, [key])[0])
        return KeuleganCarpenter.model_construct(
            law="keulegan_carpenter",
            exponent=float(law.exponent[key]),
            reference=float(law.reference[line]),
            window=float(law.window[line]),
        )
    if isinstance(law, SuctionSideLaw):
        return SuctionSide.model_construct(law="suction_side", suction=float(law.suction[key]))
    return None


def drag_law_labels(model: Model, name: str) -> dict[str, str]:
    """Labels of a parameter of a drag law, by label of the drag coefficient.

    A coefficient without such a law has the label that the parameter would have.

    Args:
        model: The model.
        name: Name of the parameter, such as exponent.
    """
    drags = [drag for load in model.loads if (drag := drag_of(load)) is not None]
    keys = {label: key for drag in drags for label, key in _coefficients(drag).items()}
    return {label: LAW_LABEL.format(key=key, name=name) for label, key in keys.items()}


def law_labels(model: Model) -> dict[str, str]:
    """Coefficients by label of what a law adds to them, or would add.

    Laws are powers of the sea state for every parameter, and drag laws for every drag coefficient.
    """
    labels = {exponent_label(label, over): label for label in model.values for over in EXPONENT_BASES}
    for name in _LAW_PARAMETERS:
        labels |= {label: coefficient for coefficient, label in drag_law_labels(model, name).items()}
    return labels


def plain_drag(model: Model) -> list[str]:
    """Labels of the coefficients of plain Morison drag, which may be given another law."""
    return [label for load in model.loads for label in _plain(load)]


def with_drag_laws(model: Model, laws: Mapping[str, DragLaw]) -> Model:
    """Model with other laws in place of plain drag, on the lines of the given coefficients.

    Raises:
        ValueError: A coefficient is not one of plain drag.
    """
    laws = {label: law for label, law in laws.items() if not isinstance(law, ConstantDrag)}
    if not laws:
        return model
    plain = plain_drag(model)
    if lost := [label for label in laws if label not in plain]:
        raise ValueError(f"{lost[0]}: expected a coefficient of plain Morison drag ({', '.join(plain) or 'there is none'})")
    loads: list[AbstractLoad] = []
    for load in model.loads:
        taken = {key: laws[label] for label, key in _plain(load).items() if label in laws}
        if not taken:
            loads.append(load)
            continue
        drag = drag_of(load)
        assert drag is not None
        if remaining := {key: value for key, value in drag.Cd.items() if key not in taken}:
            rest = replace(drag, Cd=remaining)
            loads.append(replace(load, load=rest) if isinstance(load, SeaStateLaw) else rest)
        for kind in (HighPass, KeuleganCarpenter, SuctionSide):
            if mine := {key: law for key, law in taken.items() if isinstance(law, kind)}:
                law = _law_of(mine, model.hull, drag.coupled)
                loads.append(MorisonDrag({key: drag.Cd[key] for key in mine}, law, drag.coupled))
    return replace(model, loads=tuple(map(strongly_typed, loads)))


def surface_number(hull: Hull, label: str, height: float) -> float:
    """Keulegan-Carpenter number 2 pi a/D = pi H/D of motion with the water surface.

    H is the wave height (m), D the mean size (m) across the flow on the lines of a coefficient.
    """
    n = hull.strips.size.shape[1]
    key = next(key for key in (*hull.elements.owners("Cd"), *hull.ends.owners("Cd")) if f"{key[0]}.Cd_{key[1]}" == label)
    extent = np.concatenate([np.asarray(hull.strips.size)[::-1].reshape(2 * n), 2 * np.asarray(hull.ends.radius)])
    return math.pi * height / float(extent[list(lines_of(hull, [key]))].mean())


def _coefficients(drag: MorisonDrag) -> dict[str, Key]:
    """Keys of drag coefficients by label."""
    return {f"{group}.Cd_{kind}": (group, kind) for group, kind in drag.Cd}


def _plain(load: AbstractLoad) -> dict[str, Key]:
    """Keys, by label, of a load's coefficients of plain drag that do not depend on the sea state."""
    drag = drag_of(load)
    if drag is None or not isinstance(drag.law, ConstantLaw):
        return {}
    changing = {label for label, _ in load.exponents} if isinstance(load, SeaStateLaw) else set[str]()
    return {label: key for label, key in _coefficients(drag).items() if label not in changing}


def _law_of(laws: Mapping[Key, DragLaw], hull: Hull, coupled: bool) -> AbstractDragLaw:
    """The law of some drag coefficients, from the laws of the platform file, all of one kind."""
    numbers: dict[str, dict[Key, Any]] = {}
    for key, law in laws.items():
        for name, value in law.model_dump(exclude={"law"}, exclude_none=True).items():
            numbers.setdefault(name, {})[key] = value
    suction = numbers.pop("suction", None)
    inner = ConstantLaw() if suction is None else SuctionSideLaw(suction)
    if "low_share" in numbers:
        return HighPassLaw.of(hull, law=inner, **numbers)
    return KeuleganCarpenterLaw.of(hull, coupled=coupled, **numbers) if "exponent" in numbers else inner
