"""Schema of a RAFT design file: site, platform, turbine and mooring, with RAFT's defaults.

Keys, shapes and defaults are those of RAFT at e6cb69e: raft_fowt.py, FOWT.__init__; raft_rotor.py, Rotor.__init__. Other keys
are allowed, and reported as left out.
"""

from collections.abc import Iterator
from typing import Annotated, Any, Literal

import numpy as np
from jaxtyping import Float
from pydantic import BeforeValidator, Field

from jaxhydro.errors import Problem, shown
from jaxhydro.input_schema import Consistent, NonNegative, Number, Positive, Schema, Text, Vector
from jaxhydro.interop.raft_member import OPEN, Name, RaftMember, Row


def _one_or_more(value: Any) -> Any:
    return [value] if isinstance(value, dict) else value


Members = Annotated[tuple[RaftMember, ...], BeforeValidator(_one_or_more)]


class Site(Schema):
    """Depth (m), density (kg/m³) and gravity (m/s²)."""

    model_config = OPEN

    water_depth: Positive
    rho_water: Positive = 1025.0
    g: Positive = 9.81


class Effect(Schema):
    """Point mass with inertia about itself (Jxx, Jyy, Jzz, Jxy, Jxz, Jyz), or a constant load."""

    model_config = OPEN

    type: Literal["point_inertia", "mean_load"]
    location: Vector = (0.0, 0.0, 0.0)
    mass: NonNegative = 0.0
    moments_of_inertia: tuple[Number, Number, Number, Number, Number, Number] = (0.0,) * 6
    load: tuple[Number, Number, Number, Number, Number, Number] = (0.0,) * 6


class RaftPlatform(Schema):
    """Members, and what is added to them."""

    model_config = OPEN

    members: Annotated[tuple[RaftMember, ...], Field(min_length=1)]
    potModMaster: Literal[0, 1, 2, 3] = 0
    potSecOrder: Literal[0, 1, 2] = 0
    yaw_stiffness: NonNegative = 0.0
    additional_effects: tuple[Effect, ...] = ()
    hydroPath: Text | None = None


class Turbine(Consistent):
    """Rotors with nacelles, on towers. A list has an entry for each rotor."""

    model_config = OPEN

    nrotors: Annotated[int, Field(strict=True, ge=1)] = 1
    mRNA: Row
    IxRNA: Row
    IrRNA: Row
    xCG_RNA: Row
    overhang: Row
    shaft_tilt: Row
    shaft_toe: Row = 0.0
    hHub: Row | None = None
    rRNA: tuple[Vector, ...] | None = None
    tower: Members = ()
    nacelle: Members = ()

    def per_rotor(self, key: str) -> Float[np.ndarray, " r"]:
        """A value for each rotor."""
        return np.broadcast_to(np.array(getattr(self, key), float), (self.nrotors,))

    def _faults(self) -> Iterator[Problem]:
        n = self.nrotors
        for key in ("mRNA", "IxRNA", "IrRNA", "xCG_RNA", "overhang", "shaft_tilt", "shaft_toe", "hHub", "rRNA"):
            value = getattr(self, key)
            if isinstance(value, tuple) and len(value) != n:
                yield Problem(key, f"an entry for each of {n} rotors", f"{len(value)} entries")
        for key in ("mRNA", "IxRNA", "IrRNA"):
            if (np.array(getattr(self, key)) < 0).any():
                yield Problem(key, "numbers >= 0", shown(getattr(self, key)))
        if self.rRNA is None and (self.hHub is None or n > 1):
            key = "hHub" if n == 1 else "rRNA"
            yield Problem(key, "the height of the hub" if n == 1 else "a position for each rotor", "nothing")


class RaftDesign(Schema):
    """A whole design; its mooring is read by `raft_mooring`."""

    model_config = OPEN

    name: Name | None = None
    site: Site
    platform: RaftPlatform
    turbine: Turbine | None = None
    mooring: dict[str, Any] | None = None
