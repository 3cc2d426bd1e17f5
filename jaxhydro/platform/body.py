"""Schema of the body in a platform file: mass and members, in SI, headings in degrees."""

from collections.abc import Iterator
from typing import Annotated, Any, Literal, Self

import numpy as np
from jaxtyping import Float
from pydantic import BeforeValidator, Discriminator, Field, Tag, model_validator

from jaxhydro.errors import Faults, Problem, shown
from jaxhydro.input_schema import Consistent, Count, Flag, NonNegative, Number, Positive, Schema, Text, Vector

STEP_LENGTH = 1e-6  # of a member's length, over which a step in its size is made
Matrix3 = Float[np.ndarray, "3 3"]


class Inertia(Schema):
    """Inertia about the centre of mass (kg m²).

    Ixy, Ixz and Iyz are entries of the matrix [[Ixx, Ixy, Ixz], [Ixy, Iyy, Iyz], [Ixz, Iyz, Izz]]. So Ixy = -integral of x y
    dm, as OpenFAST and WAMIT print mass matrices. No sign is changed in reading.
    """

    Ixx: NonNegative
    Iyy: NonNegative
    Izz: NonNegative
    Ixy: Number = 0.0
    Ixz: Number = 0.0
    Iyz: Number = 0.0

    def matrix(self) -> Matrix3:
        """Symmetric inertia matrix (kg m²), (3, 3)."""
        rows = [[self.Ixx, self.Ixy, self.Ixz], [self.Ixy, self.Iyy, self.Iyz], [self.Ixz, self.Iyz, self.Izz]]
        return np.array(rows, dtype=float)


class Part(Schema):
    """Rigid part: mass (kg), centre of mass (m) and inertia about it.

    The centre is from the reference point. Without inertia the part is a point.
    """

    name: Text
    mass: Positive
    centre_of_mass: Vector
    inertia: Inertia = Inertia(Ixx=0.0, Iyy=0.0, Izz=0.0)


class RigidBody(Schema):
    """Mass, centre of mass and inertia of everything that moves with the hull, or of its parts."""

    mass: Positive | None = None
    centre_of_mass: Vector | None = None
    inertia: Inertia | None = None
    parts: Annotated[tuple[Part, ...], Field(min_length=1)] | None = None

    def combined(self) -> tuple[float, Float[np.ndarray, "3"], Matrix3]:
        """Mass (kg), centre of mass (m) and inertia about it (kg m²) of all parts, by Steiner's theorem."""
        if self.parts is None:
            assert self.mass is not None and self.centre_of_mass is not None and self.inertia is not None
            return self.mass, np.array(self.centre_of_mass), self.inertia.matrix()
        masses = np.array([part.mass for part in self.parts])
        centres = np.array([part.centre_of_mass for part in self.parts])
        centre = masses @ centres / masses.sum()
        arms = centres - centre
        steiner = np.einsum("p,pi,pi->", masses, arms, arms) * np.eye(3) - np.einsum("p,pi,pj->ij", masses, arms, arms)
        inertia = np.sum([part.inertia.matrix() for part in self.parts], axis=0)
        return float(masses.sum()), centre, inertia + steiner

    @model_validator(mode="after")
    def _one_way_and_physical(self) -> Self:
        stated = [key for key in ("mass", "centre_of_mass", "inertia") if getattr(self, key) is not None]
        if self.parts is not None and stated:
            raise Faults(Problem(stated[0], "either parts or mass, centre_of_mass and inertia", "both"))
        if self.parts is None and not stated:
            raise Faults(Problem("", "mass, centre_of_mass and inertia, or parts", "neither"))
        if self.parts is None and len(stated) < 3:
            expected = {"mass": "a number > 0", "centre_of_mass": "a list of 3 numbers", "inertia": "Ixx, Iyy and Izz"}
            raise Faults(*(Problem(key, expected[key], "nothing") for key in expected if key not in stated))
        where = "parts" if self.parts else "inertia"
        with np.errstate(over="ignore", invalid="ignore"):
            inertia = self.combined()[2]
        if not np.isfinite(inertia).all():
            raise Faults(Problem(where, "an inertia matrix of finite numbers", "numbers too large"))
        low, mid, high = np.linalg.eigvalsh(inertia)
        moments = f"principal moments {low:.4g}, {mid:.4g} and {high:.4g} kg m2"
        if low <= 0.0:
            raise Faults(Problem(where, "a positive definite inertia matrix", moments))
        if high > 1.01 * (low + mid):
            raise Faults(Problem(where, "principal moments of which none exceeds the sum of the other two", moments))
        return self


def _as_list(value: Any) -> Any:
    return value if isinstance(value, list | tuple) else [value]


def _sizes(value: Any) -> str:
    if not isinstance(value, list | tuple):
        return "one"
    return "pairs" if value and isinstance(value[0], list | tuple) else "row"


Pair = tuple[Positive, Positive]
Sizes = Annotated[
    Annotated[Positive, Tag("one")]
    | Annotated[tuple[Positive, ...], Field(min_length=1), Tag("row")]
    | Annotated[tuple[Pair, ...], Tag("pairs")],
    Discriminator(_sizes),
]
_SHAPES = {"circular": "circ", "rectangular": "rect"}  # RAFT reads the first letter only
Shape = Annotated[
    Literal["circ", "rect"], BeforeValidator(lambda value: _SHAPES.get(value, value) if type(value) is str else value)
]


class Member(Consistent):
    """Cylinder or box from rA to rB (m), with RAFT's names.

    d is its diameter or [width, height] (m), or one of these at each of `stations`; a station named twice is a step in size.
    heading (deg) turns copies about z; gamma (deg) twists a box about its axis. There are `elements` load elements of
    `points` Gauss points each. maccamy_fuchs None: by the member's position.
    """

    name: Text
    group: Text = ""
    shape: Shape
    d: Sizes
    stations: Annotated[tuple[Number, ...], Field(min_length=2)] | None = None
    rA: Vector
    rB: Vector
    heading: Annotated[tuple[Number, ...], Field(min_length=1), BeforeValidator(_as_list)] = (0.0,)
    gamma: Number = 0.0
    elements: Count | None = None
    points: Count = 2
    maccamy_fuchs: Flag | None = None

    @model_validator(mode="before")
    @classmethod
    def _group_is_name(cls, data: Any) -> Any:
        if isinstance(data, dict) and "group" not in data and isinstance(data.get("name"), str):
            return {**data, "group": data["name"]}
        return data

    def _faults(self) -> Iterator[Problem]:
        if self.rA == self.rB:
            yield Problem("rB", "an end B that is not end A", shown(self.rB))
        if self.shape == "rect" and self.maccamy_fuchs:
            yield Problem("maccamy_fuchs", "false for a rectangular member", "true", "The law is for circular ones.")
        if self.elements is None and "points" in self.model_fields_set:
            yield Problem("points", "`elements` with it", "none", "Without, strips are chosen by length.")
        if self.stations is not None:
            apart = np.diff(self.stations)
            steps = apart == 0
            if (apart < 0).any() or steps[0] or steps[-1] or (steps[1:] & steps[:-1]).any():
                hint = "A step in d is one station twice, between the ends." if steps.any() and not steps.all() else ""
                yield Problem("stations", "numbers in ascending order", shown(self.stations), hint)
        kind = _sizes(self.d)
        constant = "one" if self.shape == "circ" else "row"
        if kind == constant and (self.shape == "circ" or len(np.atleast_1d(self.d)) == 2):
            return
        size = "a diameter" if self.shape == "circ" else "[width, height]"
        if kind != ("row" if self.shape == "circ" else "pairs"):
            yield Problem("d", f"{size}, or a list of these with `stations`", shown(self.d))
        elif self.stations is None:
            yield Problem("d", f"{size}, or `stations` with this list", shown(self.d))
        elif np.shape(self.d)[0] != len(self.stations):
            yield Problem("d", f"{len(self.stations)} sizes, one for each station", f"{np.shape(self.d)[0]}")

    def profile(self) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, "n 2"]]:
        """Stations from 0 at end A to 1 at end B, and width and height (m) there."""
        sizes = np.array(self.d, dtype=float)
        if self.shape == "circ":
            sizes = np.stack([sizes, sizes], axis=-1)
        if sizes.ndim == 1 or self.stations is None:
            return np.array([0.0, 1.0]), np.stack([sizes, sizes])
        stations = np.array(self.stations)
        fractions = (stations - stations[0]) / (stations[-1] - stations[0])
        steps = np.flatnonzero(np.diff(stations) == 0)
        fractions[steps] -= 0.5 * STEP_LENGTH
        fractions[steps + 1] += 0.5 * STEP_LENGTH
        return fractions, sizes
