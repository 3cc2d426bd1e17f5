"""Schema of the platform file `platform.yaml`: checked, plain values in SI, headings in degrees."""

from collections.abc import Iterator
from importlib import resources
from os import PathLike
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from jaxhydro.environment import STANDARD_GRAVITY
from jaxhydro.errors import InputError, Problem, shown, suggest
from jaxhydro.input_schema import Consistent, Number, Positive, Schema, Text, Vector, read_yaml, validate
from jaxhydro.platform.body import Inertia, Member, Part, RigidBody
from jaxhydro.platform.catenary_schema import Catenary
from jaxhydro.platform.coefficients_schema import Coefficients
from jaxhydro.platform.computed_tables_schema import Drift, Excitation, Hydrostatics, Radiation
from jaxhydro.platform.current_schema import SteadyCurrent
from jaxhydro.platform.guided_mass_schema import GuidedMass, twice_named
from jaxhydro.platform.heading_coverage import OtherWaves, other_waves
from jaxhydro.platform.liquid_column_damper_schema import LiquidColumnDamper
from jaxhydro.platform.matrix_schema import AddedMass, LinearDamping, QuadraticDamping, Stiffness
from jaxhydro.platform.mooring_schema import LinearSprings, NoMooring, StiffnessMatrix
from jaxhydro.platform.shared_coefficients import owners, sharing_faults
from jaxhydro.platform.tension_table_schema import TensionTableMooring
from jaxhydro.platform.tuned_mass_damper_schema import TunedMassDamper

__all__ = ["Coefficients", "Inertia", "Member", "Part", "Platform", "RigidBody", "builtin_platforms", "load_platform"]

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
