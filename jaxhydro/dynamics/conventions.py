"""Conventions of a strip model: wetting, diffraction, axes of strips, position of the waves."""

from dataclasses import dataclass, fields, replace
from typing import Any, Literal, get_args, get_type_hints

from jaxhydro.choices import check, unknown


@dataclass(frozen=True)
class Conventions:
    """Which form of the strip model is used; a platform file has a key for most of them.

    The default of `diffraction` replaces Ca in the wave excitation altogether. That is the theory, for a Ca tuned to the
    added mass. The step from 1 + Ca to 2 that it makes cannot be determined by a calibration in still water.

    Attributes:
        wetting: Which part of the members is loaded. "instantaneous": up to the water surface at the displaced strip.
            "mean": the part under still water at the upright reference position, in the flow at that depth.
        diffraction: Wave diffraction by the members that diffract. "maccamy_fuchs"; "ramp", the same but with coefficients
            tuned away from Ca = 1 kept in long waves (`diffraction.long_waves`); "none".
        directions: Axes of strips, ends, added mass and radiation. "body": of the displaced body. "earth": of the undisplaced
            one, as in OpenFAST.
        waves_at: Where the waves are evaluated horizontally. "displaced": where the platform is. "mean": at the reference
            position, as in OpenFAST with WaveDisp = 0 and ExctnDisp = 0.
        centripetal: Whether strips and ends feel the centripetal part of their acceleration. False is for programs whose
            added mass takes accelerations alone.
        lag: As in `Cylinders`.
        bound: As in `Cylinders`.

    Raises:
        UnknownName: A word is none of a convention's, or a flag is no bool.
    """

    wetting: Literal["instantaneous", "mean"] = "instantaneous"
    diffraction: Literal["maccamy_fuchs", "ramp", "none"] = "maccamy_fuchs"
    directions: Literal["body", "earth"] = "body"
    waves_at: Literal["displaced", "mean"] = "displaced"
    centripetal: bool = True
    lag: bool = True
    bound: bool = True

    def __post_init__(self) -> None:
        """Raise UnknownName for a value that is not allowed."""
        check(**{field.name: (getattr(self, field.name), allowed_values(field.name)) for field in fields(self)})

    def changed(self, **changes: Any) -> "Conventions":
        """These conventions with some changed.

        Args:
            **changes: New values by name.

        Raises:
            UnknownName: There is no such convention, or it has no such value.
        """
        names = [field.name for field in fields(self)]
        for name in changes:
            if name not in names:
                raise unknown("convention", name, names)
        return replace(self, **changes)


def allowed_values(convention: str) -> tuple[str | bool, ...]:
    """Allowed values of a convention, the default first."""
    return get_args(get_type_hints(Conventions)[convention]) or (True, False)
