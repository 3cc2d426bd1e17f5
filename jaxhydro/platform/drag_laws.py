"""Drag laws of a model by coefficient label, and their replacement."""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, TypeAlias

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
        for key in getattr(inner, "Cd", ()):
            label = f"{key[0]}.Cd_{key[1]}"
            if isinstance(inner, HighPassDrag):
                suction = float(inner.drag_suction[key]) if key in inner.drag_suction else None
                cutoff, low_share = float(inner.drag_cutoff[key]), float(inner.drag_low_share[key])
                numbers: dict[str, Any] = {"cutoff": cutoff, "low_share": low_share, "suction": suction}
                found[label] = HighPassAtEnds.model_construct(law="high_pass", **numbers)
            elif isinstance(inner, KeuleganCarpenterDrag):
                line = inner.lines.index(lines_of(model.hull, [key])[0])
                numbers = {"reference": float(inner.reference[line]), "window": float(inner.window[line])}
                exponent = float(inner.drag_exponent[key])
                found[label] = KeuleganCarpenter.model_construct(law="keulegan_carpenter", exponent=exponent, **numbers)
            elif isinstance(inner, SuctionSideDrag):
                found[label] = SuctionSide.model_construct(law="suction_side", suction=float(inner.drag_suction[key]))
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
    keys = {label: key for load in model.loads for label, key in load.keys.items()}
    taken = {keys[label]: law for label, law in laws.items()}
    plain: dict[type, set] = {
        # of a strip's direction no side is that of suction
        StripDrag: {key for key, law in taken.items() if not isinstance(law, SuctionSide)},
        EndDrag: set(taken),
    }
    loads: list[AbstractLoad] = []
    coefficients: dict[Any, Any] = {}
    for load in model.loads:
        if isinstance(load, StripDrag | EndDrag):
            coefficients |= {key: value for key, value in load.Cd.items() if key in taken}
            left = {key: value for key, value in load.Cd.items() if key not in plain[type(load)]}
            if not left:  # without a coefficient there is no drag
                continue
            load = replace(load, Cd=left)
        loads.append(load)
    coupled = next((load.coupled for load in model.loads if isinstance(load, StripDrag)), True)
    return replace(model, loads=tuple(map(strongly_typed, (*loads, *_loads(taken, coefficients, model.hull, coupled)))))


def surface_number(hull: Hull, label: str, height: float) -> float:
    """Keulegan-Carpenter number 2 pi a/D = pi H/D of motion with the water surface.

    H is the wave height (m), D the mean size (m) across the flow on the lines of a coefficient.
    """
    n = hull.strips.size.shape[1]
    key = next(key for key in (*hull.elements.owners("Cd"), *hull.ends.owners("Cd")) if f"{key[0]}.Cd_{key[1]}" == label)
    extent = np.concatenate([np.asarray(hull.strips.size)[::-1].reshape(2 * n), 2 * np.asarray(hull.ends.radius)])
    return math.pi * height / float(extent[list(lines_of(hull, [key]))].mean())


def _loads(laws: Mapping[Any, DragLaw], coefficients: Mapping, hull: Hull, coupled: bool) -> list[AbstractLoad]:
    """A load for every kind of law, on the lines of all coefficients that it is given for."""

    def of(kind: type) -> tuple[dict, dict[str, dict]]:
        """Drag coefficients with a kind of law, and the numbers of the law by name."""
        some = {key: law for key, law in laws.items() if isinstance(law, kind)}
        numbers: dict[str, dict] = {}
        for key, law in some.items():
            for name, value in law.model_dump(exclude={"law"}, exclude_none=True).items():
                numbers.setdefault(name, {})[key] = value
        return {key: coefficients[key] for key in some}, numbers

    loads: list[AbstractLoad] = []
    (high, by_name), (powers, constants), (sides, shares) = map(of, (HighPass, KeuleganCarpenter, SuctionSide))
    if high:
        loads.append(HighPassDrag.of(hull, high, coupled=coupled, **{f"drag_{name}": x for name, x in by_name.items()}))
    if powers:
        exponent = constants.pop("exponent")
        loads.append(KeuleganCarpenterDrag.of(hull, powers, drag_exponent=exponent, coupled=coupled, **constants))
    if sides:
        loads.append(SuctionSideDrag(sides, shares["suction"]))
    return loads
