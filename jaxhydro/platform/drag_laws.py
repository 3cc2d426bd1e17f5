"""Drag laws of a model by coefficient label, and their replacement."""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, TypeAlias

import jax.numpy as jnp
import numpy as np

from jaxhydro.dynamics.model import Model
from jaxhydro.hull.hull import Hull
from jaxhydro.loads import AbstractLoad, EndDrag, HighPassDrag, KeuleganCarpenterDrag, StripDrag, SuctionSideDrag
from jaxhydro.loads.drag import lines_of
from jaxhydro.loads.sea_state_law import SeaStateLaw
from jaxhydro.parameters import strongly_typed
from jaxhydro.platform.body import ConstantDrag, HighPass, HighPassAtEnds, KeuleganCarpenter, SuctionSide

DragLaw: TypeAlias = ConstantDrag | HighPass | HighPassAtEnds | KeuleganCarpenter | SuctionSide


def parameter_label(label: str, name: str) -> str:
    """Label of a law's parameter: column.drag_exponent_t for `exponent` and column.Cd_t."""
    return label.replace(".Cd_", f".drag_{name}_")


def coefficient_label(label: str) -> str | None:
    """Label of the coefficient of a law's parameter; None for other labels."""
    group, _, symbol = label.rpartition(".")
    parts = symbol.split("_")
    return f"{group}.Cd_{parts[-1]}" if group and parts[0] == "drag" and parts[-1] in ("t", "z") else None


def drag_laws_of(model: Model) -> dict[str, DragLaw]:
    """Drag laws of a model by coefficient label, plain drag left out; values are not checked."""
    found: dict[str, DragLaw] = {}
    for load in model.loads:
        inner = load.load if isinstance(load, SeaStateLaw) else load

        def value(label: str, name: str, load: AbstractLoad = load) -> float:
            return float(load.values[parameter_label(label, name)])

        for label in (label for label in inner.values if ".Cd_" in label):
            if isinstance(inner, HighPassDrag):
                suction = value(label, "suction") if parameter_label(label, "suction") in load.values else None
                found[label] = HighPassAtEnds.model_construct(
                    law="high_pass", cutoff=value(label, "cutoff"), low_share=value(label, "low_share"), suction=suction
                )
            elif isinstance(inner, KeuleganCarpenterDrag):
                line = inner.lines.index(lines_of(model.hull, [label])[0])
                constants: dict[str, Any] = {"reference": float(inner.reference[line]), "window": float(inner.window[line])}
                found[label] = KeuleganCarpenter.model_construct(
                    law="keulegan_carpenter", exponent=value(label, "exponent"), **constants
                )
            elif isinstance(inner, SuctionSideDrag):
                found[label] = SuctionSide.model_construct(law="suction_side", suction=value(label, "suction"))
    return found


def plain_drag(model: Model) -> list[str]:
    """Labels of the coefficients of plain Morison drag, which may be given another law."""
    return [label for load in model.loads if type(load) in (StripDrag, EndDrag) for label in load.values]


def with_drag_laws(model: Model, laws: Mapping[str, DragLaw]) -> Model:
    """Model with other laws in place of plain drag, on the lines of the given coefficients.

    Raises:
        ValueError: A coefficient is not one of plain drag.
    """
    laws = {label: law for label, law in laws.items() if not isinstance(law, ConstantDrag)}
    if not laws:
        return model
    known = plain_drag(model)
    if lost := [label for label in laws if label not in known]:
        raise ValueError(f"{lost[0]}: expected a coefficient of plain Morison drag ({', '.join(known) or 'there is none'})")
    values, loads = model.values, []
    taken: dict[type, set[str]] = {
        # of a strip's direction no side is that of suction
        StripDrag: {label for label, law in laws.items() if not isinstance(law, SuctionSide)},
        EndDrag: set(laws),
    }
    for load in model.loads:
        if type(load) in taken:
            left = {label: value for label, value in load.values.items() if label not in taken[type(load)]}
            load = replace(load, values=left)
        loads.append(load)
    # without a coefficient there is no drag
    loads = [load for load in loads if load.values or type(load) not in taken]
    coupled = next((load.coupled for load in model.loads if isinstance(load, StripDrag)), True)
    return replace(model, loads=tuple(map(strongly_typed, (*loads, *_loads(laws, values, model.hull, coupled)))))


def surface_number(hull: Hull, label: str, height: float) -> float:
    """Keulegan-Carpenter number 2 pi a/D = pi H/D of motion with the water surface.

    H is the wave height (m), D the mean size (m) across the flow on the lines of a coefficient.
    """
    n = hull.strips.size.shape[1]
    extent = np.concatenate([np.asarray(hull.strips.size)[::-1].reshape(2 * n), 2 * np.asarray(hull.ends.radius)])
    return math.pi * height / float(extent[list(lines_of(hull, [label]))].mean())


def _loads(laws: Mapping[str, DragLaw], coefficients: Mapping, hull: Hull, coupled: bool) -> list[AbstractLoad]:
    """A load for every kind of law, on the lines of all coefficients that it is given for."""

    def values(some: Mapping[str, DragLaw]) -> dict:
        found = {label: coefficients[label] for label in some}
        for label, law in some.items():
            for name, value in law.model_dump(exclude={"law", "reference", "window"}, exclude_none=True).items():
                found[parameter_label(label, name)] = jnp.asarray(value)
        return found

    loads: list[AbstractLoad] = []
    if high := {label: law for label, law in laws.items() if isinstance(law, HighPass)}:
        loads.append(HighPassDrag.of(hull, values(high), coupled))
    if powers := {label: law for label, law in laws.items() if isinstance(law, KeuleganCarpenter)}:
        reference = {label: law.reference for label, law in powers.items()}
        window = {label: law.window for label, law in powers.items()}
        loads.append(KeuleganCarpenterDrag.of(hull, values(powers), reference, window, coupled))
    if sides := {label: law for label, law in laws.items() if isinstance(law, SuctionSide)}:
        loads.append(SuctionSideDrag(values(sides)))
    return loads
