"""Schema of hydrostatics, radiation, drift and excitation from the files of other programs."""

from pathlib import Path
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator

from jaxhydro.errors import Faults, Problem, shown
from jaxhydro.input_schema import Count, Flag, NonNegative, Number, Positive, Schema, Text
from jaxhydro.interop.wamit_tables import By

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
