"""Schema of the platform file `platform.yaml`: checked, plain values in SI, headings in degrees."""

from collections.abc import Iterator
from importlib import resources
from os import PathLike
from pathlib import Path
from typing import Annotated, ClassVar, Generic, Literal, Self, TypeVar

import numpy as np
from jaxtyping import Float
from pydantic import AfterValidator, Discriminator, Field, RootModel, Tag, model_validator

from jaxhydro.environment import STANDARD_GRAVITY
from jaxhydro.errors import (
    Consistent,
    Count,
    Faults,
    Flag,
    InputError,
    NonNegative,
    Number,
    Positive,
    Problem,
    Schema,
    Text,
    Vector,
    read_yaml,
    shown,
    suggest,
    validate,
)
from jaxhydro.interop.wamit_tables import By
from jaxhydro.platform.body import Coefficients, Inertia, Member, Part, RigidBody
from jaxhydro.platform.catenary_schema import Catenary
from jaxhydro.platform.current_schema import SteadyCurrent
from jaxhydro.platform.guided_mass_schema import GuidedMass, twice_named
from jaxhydro.platform.liquid_column_damper_schema import LiquidColumnDamper
from jaxhydro.platform.other_waves import OtherWaves, other_waves
from jaxhydro.platform.shared_coefficients import owners, sharing_faults
from jaxhydro.platform.tension_table_schema import TensionTableMooring
from jaxhydro.platform.tuned_mass_damper_schema import TunedMassDamper

__all__ = ["Coefficients", "Inertia", "Member", "Part", "Platform", "RigidBody", "builtin_platforms", "load_platform"]

Matrix6 = Float[np.ndarray, "6 6"]
Exponent = Annotated[float, Field(strict=True, ge=-3, le=3)]


class Rotor(Schema):
    """Thrust (N) of a rotor at its hub (m), and its slope over the wind speed (N s/m).

    The wind is steady and along x.
    """

    hub: Vector
    thrust: Number = 0.0
    damping: Number = 0.0


class Water(Schema):
    """Density (kg/m³), depth (m), gravity (m/s²), and a steady current."""

    density: Positive
    depth: Positive
    gravity: Positive = STANDARD_GRAVITY
    current: SteadyCurrent | None = None


def _key(letter: str, diagonal: bool = False) -> AfterValidator:
    keys = [f"{letter}{i}{j}" for i in range(1, 7) for j in range(1, 7) if i == j or not diagonal]

    def check(key: str) -> str:
        if key not in keys:
            kind = "diagonal entries" if diagonal else "entries"
            raise Faults(Problem("", f"a key among the {kind} {keys[0]} to {keys[-1]}", shown(key)))
        return key

    return AfterValidator(check)


Key = TypeVar("Key", bound=str)


class Entries(RootModel[dict[Key, Number]], Generic[Key], frozen=True):
    """Entries of a 6 x 6 matrix by name, such as B15 in row 1 and column 5; the others are 0."""

    root: dict[Key, Number] = {}
    dissipative: ClassVar[bool] = False

    @model_validator(mode="after")
    def _takes_energy(self) -> Self:
        negative = [key for key, value in self.root.items() if self.dissipative and key[1] == key[2] and value < 0.0]
        if negative:
            raise Faults(*(Problem(key, "a number >= 0", shown(self.root[key])) for key in negative))
        return self

    def matrix(self) -> Matrix6:
        """The matrix, (6, 6); where only one of ij and ji is given, the other is equal."""
        matrix = np.zeros((6, 6))
        named = {(int(key[1]) - 1, int(key[2]) - 1): value for key, value in self.root.items()}
        for (i, j), value in named.items():
            matrix[i, j] = value
            matrix[j, i] = named.get((j, i), value)
        return matrix


class Damping(Entries[Key], Generic[Key], frozen=True):
    """Entries of a damping matrix, not negative on the diagonal."""

    dissipative: ClassVar[bool] = True


LinearDamping = Damping[Annotated[str, _key("B")]]  # N s/m, N s, N m s/rad
QuadraticDamping = Damping[Annotated[str, _key("B", diagonal=True)]]  # N s2/m2, N m s2/rad2
AddedMass = Entries[Annotated[str, _key("A")]]  # kg, kg m, kg m2
Stiffness = Entries[Annotated[str, _key("C")]]  # N/m, N/rad, N m/rad


class NoMooring(Schema):
    """No mooring."""

    kind: Literal["none"] = "none"


class Line(Schema):
    """Straight massless spring from anchor to fairlead (m).

    It has a stiffness (N/m) and the pretension (N) at the reference position; or the axial stiffness EA (N) and the
    unstretched length (m).
    """

    anchor: Vector
    fairlead: Vector
    stiffness: Positive | None = None
    pretension: NonNegative | None = None
    axial_stiffness: Positive | None = None
    unstretched_length: Positive | None = None

    def spring(self, length_at_rest: float | None = None) -> tuple[float, float]:
        """Stiffness (N/m) and unstretched length (m).

        The pretension holds at `length_at_rest` (m); default: the distance from anchor to fairlead at the reference
        position.
        """
        if self.axial_stiffness is not None and self.unstretched_length is not None:
            return self.axial_stiffness / self.unstretched_length, self.unstretched_length
        assert self.stiffness is not None and self.pretension is not None
        if length_at_rest is None:
            length_at_rest = float(np.linalg.norm(np.subtract(self.anchor, self.fairlead)))
        return self.stiffness, length_at_rest - self.pretension / self.stiffness

    def slack(self) -> tuple[float, float] | None:
        """Distance from anchor to fairlead and unstretched length (m) of a slack line, or None.

        The distance is that at the reference position.
        """
        distance, unstretched = float(np.linalg.norm(np.subtract(self.anchor, self.fairlead))), self.spring()[1]
        return (distance, unstretched) if unstretched > distance * (1 + 1e-9) else None

    @model_validator(mode="after")
    def _one_spring(self) -> Self:
        if self.anchor == self.fairlead:
            raise Faults(Problem("fairlead", "a point that is not the anchor", shown(self.fairlead)))
        pairs = (("stiffness", "pretension"), ("axial_stiffness", "unstretched_length"))
        stated = [[key for key in pair if getattr(self, key) is not None] for pair in pairs]
        either = "either stiffness and pretension, or axial_stiffness and unstretched_length"
        if all(stated):
            raise Faults(Problem("", either, ", ".join(stated[0] + stated[1])))
        if not any(stated):
            raise Faults(Problem("", either, "neither"))
        for pair, got in zip(pairs, stated):
            if len(got) == 1:
                lacking = pair[1 - pair.index(got[0])]
                raise Faults(Problem(lacking, f"a number, since {got[0]} is given", "nothing"))
        return self


class LinearSprings(Schema):
    """Mooring of straight elastic lines."""

    kind: Literal["linear_springs"]
    lines: Annotated[tuple[Line, ...], Field(min_length=1)]

    def slackness(self) -> str:
        """Warning of lines that are slack at the reference position; "" where none is."""
        slack = [(i, *lengths) for i, line in enumerate(self.lines, 1) if (lengths := line.slack()) is not None]
        if not slack:
            return ""
        shown = [f"line {i}: {distance:.4g} m to its anchor, {length:.4g} m unstretched" for i, distance, length in slack[:6]]
        shown += [f"and {len(slack) - 6} more"] if len(slack) > 6 else []
        every = len(slack) == len(self.lines)
        counted = f"{len(slack)} of {len(self.lines)} lines are" if len(slack) > 1 else "one line is"
        subject = "every line is" if every else counted
        return (
            f"mooring.lines: {subject} slack at the reference position ({'; '.join(shown)})"
            + (", so nothing holds the platform there. " if every else ", and pulls nothing there. ")
            + "Lines here are straight, weightless springs. For a catenary take kind: catenary. Or take kind: "
            "stiffness_matrix with its stiffness and preload (its pull) at the reference position."
        )


Row = tuple[Number, Number, Number, Number, Number, Number]
Square = Annotated[
    Annotated[Stiffness, Tag("entries")] | Annotated[tuple[Row, Row, Row, Row, Row, Row], Tag("rows")],
    Discriminator(lambda value: "entries" if isinstance(value, dict | Entries) else "rows"),
]


class StiffnessMatrix(Schema):
    """Mooring about the reference position: force on the platform = preload - stiffness @ motion."""

    kind: Literal["stiffness_matrix"]
    stiffness: Square = Field(description="6 rows of 6 numbers, or entries C11 to C66")
    preload: Row = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)

    def matrix(self) -> Matrix6:
        """The stiffness, N/m, N/rad, N m/rad."""
        return self.stiffness.matrix() if isinstance(self.stiffness, Entries) else np.array(self.stiffness)


Body = Annotated[Count | Text, Field(description="a body's name, or in files of WAMIT and Nemoh its number from 1")]


class FromFile(Schema):
    """Results of another program in a `file` beside the platform file.

    `format` is that of WAMIT, Capytaine or Nemoh, `body` which of several bodies. WAMIT's files have the unit of length
    `length` (ULEN, m); `by` says what their first column is.
    """

    endings: ClassVar[dict[str, str]]  # of files, and the format that each means
    wamit_only: ClassVar[tuple[str, ...]] = ("length", "by")

    file: Text
    format: Literal["wamit", "capytaine", "nemoh"] | None = None
    length: Positive | None = None
    body: Body | None = None

    @property
    def kind(self) -> str | None:
        """The format; by default that of the file's ending."""
        return self.format or self.endings.get(Path(self.file).suffix.lower())

    @model_validator(mode="after")
    def _of_a_kind(self) -> Self:
        if not self.file:
            return self
        if self.kind is None:
            ending = f"none of {', '.join(self.endings)}"
            raise Faults(Problem("format", f"wamit, capytaine or nemoh, as the file's ending is {ending}", "nothing"))
        program = {"capytaine": "Capytaine", "nemoh": "Nemoh"}.get(self.kind)
        if program is not None:
            for key in self.wamit_only:
                if key in self.model_fields_set and (value := getattr(self, key)) is not None:
                    reason = "coefficients have dimensions" if key == "length" else "files say it"
                    raise Faults(Problem(key, f"no {key}, as {program}'s {reason}", shown(value)))
        if self.body is not None and isinstance(self.body, int) == (self.kind == "capytaine"):
            names = f"a number, as {program or 'WAMIT'}'s files have no names"
            expected = "a body's name in quotes" if self.kind == "capytaine" else names
            raise Faults(Problem("body", expected, shown(self.body)))
        return self


class Hydrostatics(FromFile):
    """Hydrostatics in place of those of members and mass (m³, N/m, N m/rad).

    `_buoyancy` values are without the weight. Values that are not given come from the `file`, where there is one. `weight`:
    whether C44 and C55 of a .hst file include it. `linear`: these values alone restore; the members displace nothing.
    """

    endings = {".hst": "wamit", ".out": "wamit", ".nc": "capytaine", ".dat": "nemoh"}
    wamit_only = ("length", "weight")

    file: Literal[""] | Text = ""
    displaced_volume: Positive | None = None
    C33: NonNegative | None = None
    C44: Number | None = None
    C55: Number | None = None
    C44_buoyancy: Number | None = None
    C55_buoyancy: Number | None = None
    weight: Literal["included", "excluded"] | None = None
    linear: Flag = False

    @model_validator(mode="after")
    def _said_once(self) -> Self:
        twice = [key for key in ("C44", "C55") if None not in (getattr(self, key), getattr(self, f"{key}_buoyancy"))]
        if twice:
            raise Faults(*(Problem(key, f"either {key} or {key}_buoyancy", "both") for key in twice))
        alone = [key for key in ("format", "length", "body", "weight") if getattr(self, key) is not None and not self.file]
        if alone:
            raise Faults(*(Problem(key, "a `file` with it", "none") for key in alone))
        wanted = [("C33",), ("C44", "C44_buoyancy"), ("C55", "C55_buoyancy")]
        if self.linear and not self.file and (lacking := [keys[0] for keys in wanted if not any(map(self._given, keys))]):
            raise Faults(*(Problem(key, "a value, as the hydrostatics are `linear`", "none") for key in lacking))
        if self.kind == "nemoh" and self.body is not None:
            raise Faults(Problem("body", "no body, as KH_0.dat, KH_1.dat ... are of one body each", shown(self.body)))
        if self.weight is not None and Path(self.file).suffix.lower() == ".out":
            raise Faults(Problem("weight", "no weight, as an .out file says where its centre of mass is", shown(self.weight)))
        return self

    def _given(self, key: str) -> bool:
        return getattr(self, key) is not None


class Radiation(FromFile):
    """Radiation damping from another program: WAMIT's `.1`, Capytaine's `.nc` or Nemoh's `.tec`.

    A state space of at most `order` states follows it to `tolerance`. `added_mass`: that of the members at infinite frequency,
    or the file's in its place. `use`: part of the model, or a candidate of `diagnose`.
    """

    endings = {".1": "wamit", ".nc": "capytaine", ".tec": "nemoh"}

    by: By = "period"
    added_mass: Literal["members", "file"] = "members"
    tolerance: Annotated[float, Field(strict=True, gt=0, lt=1)] = 0.01
    order: Annotated[int, Field(strict=True, ge=2, le=200)] = 40
    use: Literal["load", "candidate"] = "load"


class Drift(Schema):
    """Difference-frequency second-order forces from another program: WAMIT's `.12d`.

    They are for waves of a `heading` (deg), or of all headings of the file where none is given; of all pairs of frequencies
    or by Newman's approximation. The file has the unit
    of length `length` (ULEN, m); `by` says what its first two columns are. `use`: part of the model, or a candidate of
    `diagnose`.
    """

    file: Text
    length: Positive = 1.0
    by: By = "period"
    body: Count | None = None
    heading: Number | None = None
    approximation: Literal["full", "newman"] = "full"
    use: Literal["load", "candidate"] = "load"


class Excitation(FromFile):
    """First-order wave forces from another program, in place of the strips'.

    The file is WAMIT's `.3`, Capytaine's `.nc` or Nemoh's `.tec`. It is for waves of a `heading` (deg), or of all headings
    of the file where none is given. `use`: part of the model, or a candidate of `diagnose`. `second_order`: whether the
    strips' own second-order forces go with their first-order force, as in a file of drift, or stay
    (`DiffractionCorrection`).
    """

    endings = {".3": "wamit", ".nc": "capytaine", ".tec": "nemoh"}

    by: By = "period"
    heading: Number | None = None
    second_order: Literal["file", "strips"] = "file"
    use: Literal["load", "candidate"] = "load"


FILE_KEYS = ("hydrostatics", "radiation", "excitation", "drift")  # keys that may name a file


class ReferenceSea(Schema):
    """Sea state (m, s) in which coefficients are as declared."""

    significant_height: Positive
    peak_period: Positive


class Exponents(Schema):
    """Exponents of significant height and peak period, each over the reference's, in a coefficient."""

    significant_height: Exponent | None = None
    peak_period: Exponent | None = None


class SeaStateLaws(Schema):
    """Sea-state laws of coefficients by label, such as column.Cd_t (`loads.SeaStateLaw`)."""

    reference: ReferenceSea
    exponents: dict[Text, Exponents]


class Platform(Consistent):
    """Checked contents of a platform file.

    `wetting`, `drag_speed`, `diffraction`, `directions`, `waves_at`, `centripetal` and `second_order_forces` choose between
    forms of the strip loads: see `Model` and the loads.
    """

    name: Text
    water: Water
    rigid_body: RigidBody
    guided_masses: tuple[GuidedMass, ...] = ()
    tuned_mass_dampers: tuple[TunedMassDamper, ...] = ()
    liquid_column_dampers: tuple[LiquidColumnDamper, ...] = ()
    rotor: Rotor | None = None
    members: tuple[Member, ...] = ()
    coefficients: dict[Text, Coefficients] = {}
    linear_damping: LinearDamping = LinearDamping()
    quadratic_damping: QuadraticDamping = QuadraticDamping()
    added_mass: AddedMass = AddedMass()
    stiffness: Stiffness = Stiffness()
    mooring: NoMooring | LinearSprings | Catenary | TensionTableMooring | StiffnessMatrix = Field(
        default=NoMooring(),
        discriminator="kind",
        description="a mapping with `kind`: none, linear_springs, catenary, tension_table or stiffness_matrix",
    )
    hydrostatics: Hydrostatics = Hydrostatics()
    radiation: Radiation | None = None
    excitation: Excitation | None = None
    drift: Drift | None = None
    wetting: Literal["mean", "instantaneous"] = "instantaneous"
    diffraction: Literal["maccamy_fuchs", "ramp", "none"] = "maccamy_fuchs"
    directions: Literal["body", "earth"] = "body"
    waves_at: Literal["displaced", "mean"] = "displaced"
    centripetal: bool = True
    second_order_forces: Literal["none", "slender_body"] = "none"
    drag_speed: Literal["vector", "component"] = "vector"
    sea_state_laws: SeaStateLaws | None = None

    def files(self) -> dict[str, str]:
        """Paths of the files that the platform file names, by key."""
        return {key: section.file for key in FILE_KEYS if (section := getattr(self, key)) is not None and section.file}

    def of_other_waves(self, heading: float) -> OtherWaves | None:
        """A table that was computed for other wave headings than this one (deg), or None.

        Headings between those of a file are interpolated. A file that cannot be read is left for where it is loaded.
        """
        kinds = {"excitation": (self.excitation and self.excitation.kind) or "", "drift": "wamit drift"}
        tables = ((key, section, kind) for key, kind in kinds.items() if (section := getattr(self, key)) is not None)
        return next((mismatch for table in tables if (mismatch := other_waves(*table, heading)) is not None), None)

    def _faults(self) -> Iterator[Problem]:
        bed = -self.water.depth
        for i, member in enumerate(self.members):
            for end in ("rA", "rB"):
                if (z := getattr(member, end)[2]) < bed:
                    yield Problem(f"members[{i}].{end}", f"a point above the sea bed, z = {bed:g} m", f"z = {z:g} m")
        if isinstance(self.mooring, Catenary):
            yield from self.mooring.water_faults(self.water.density, self.water.depth, self.water.gravity)
        if self.excitation is not None and self.excitation.second_order == "strips":
            if not self.members:
                yield Problem("excitation.second_order", "`file`, as the platform has no members", "strips")
            if self.drift is not None:
                expected = "no table of drift beside `second_order: strips`, or `second_order: file`"
                yield Problem("excitation.second_order", expected, "strips and a key `drift`")
        yield from twice_named("guided_masses", self.guided_masses)
        yield from twice_named("tuned_mass_dampers", self.tuned_mass_dampers)
        yield from twice_named("liquid_column_dampers", self.liquid_column_dampers)
        groups = {member.group for member in self.members}
        yield from sharing_faults(self.coefficients, groups)
        missing = sorted(groups - set(self.coefficients))
        unused = [g for g in self.coefficients if g not in groups | owners(self.coefficients)]
        for group in missing:
            i = next(i for i, member in enumerate(self.members) if member.group == group)
            names, hint = ", ".join(self.coefficients) or "none", suggest(group, self.coefficients)
            yield Problem(f"members[{i}].group", f"a group of `coefficients` ({names})", shown(group), hint)
        for group in unused:
            if suggest(group, missing) or len(missing) == len(unused) == 1:
                continue  # one group under two names has been told above
            names, hint = ", ".join(sorted(groups)) or "none", suggest(group, groups)
            yield Problem(f"coefficients.{group}", f"a group that members belong to ({names})", shown(group), hint)


def builtin_platforms() -> tuple[str, ...]:
    """Names of the built-in platforms."""
    folder = resources.files("jaxhydro") / "platforms"
    return tuple(sorted(entry.name.removesuffix(".yaml") for entry in folder.iterdir() if entry.name.endswith(".yaml")))


def builtin_text(name: str) -> str:
    """Text of a built-in platform's file."""
    return (resources.files("jaxhydro") / "platforms" / f"{name}.yaml").read_text(encoding="utf-8")


def load_platform(path_or_name: str | PathLike[str]) -> Platform:
    """Checked contents of a platform file, or of a built-in platform.

    Args:
        path_or_name: Path of a YAML file, or name of a built-in platform.

    Returns:
        The platform description; paths in it are resolved relative to the file.

    Raises:
        InputError: The file has mistakes; all of them are listed.
    """
    name, names = str(path_or_name), builtin_platforms()
    is_path = not isinstance(path_or_name, str) or "/" in name or name.endswith((".yaml", ".yml"))
    if not is_path and name.lower() in names:
        with resources.as_file(resources.files("jaxhydro") / "platforms" / f"{name.lower()}.yaml") as path:
            return validate(Platform, read_yaml(path, "platform"), f"{name} (built in)")
    if not is_path and not Path(name).exists():
        expected = f"a YAML file or a built-in platform ({', '.join(names)})"
        raise InputError(name, [Problem("", expected, shown(name), suggest(name, names))])
    platform = validate(Platform, read_yaml(path_or_name, "platform"), name)
    folder = Path(path_or_name).absolute().parent
    beside = {
        key: getattr(platform, key).model_copy(update={"file": str(folder / getattr(platform, key).file)})
        for key in platform.files()
    }
    return platform.model_copy(update=beside) if beside else platform
