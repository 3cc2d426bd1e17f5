"""Schema of the added-mass and drag coefficients of members, and of their drag laws."""

from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag

from jaxhydro.input_schema import NonNegative, Positive, Schema, Text
from jaxhydro.loads.drag.velocity_filters import MAX_CUTOFF, MAX_SLOW_SHARE

Share = Annotated[float, Field(strict=True, ge=0, le=1)]
Coefficient = Annotated[
    Annotated[NonNegative, Tag("number")] | Annotated[Text, Tag("group")],
    Discriminator(lambda value: "group" if isinstance(value, str) else "number"),
]


class ConstantDrag(Schema):
    """Drag with the same coefficient for all motion (`jaxhydro.loads.drag.ConstantLaw`)."""

    law: Literal["constant"] = "constant"


class HighPass(Schema):
    """Drag with `low_share` times the coefficient for slow motion (`jaxhydro.loads.drag.HighPassLaw`).

    The cut-off frequency is in Hz; 0: none.
    """

    law: Literal["high_pass"]
    cutoff: Annotated[float, Field(strict=True, ge=0, le=MAX_CUTOFF)]
    low_share: Annotated[float, Field(strict=True, ge=0, le=MAX_SLOW_SHARE)]


class HighPassAtEnds(HighPass):
    """`HighPass` for pontoons' vertical direction and columns' ends, there with a share of `SuctionSide`."""

    suction: Share | None = None


class KeuleganCarpenter(Schema):
    """Drag by a power of the Keulegan-Carpenter number (`jaxhydro.loads.drag.KeuleganCarpenterLaw`).

    The coefficient is as declared at the number `reference`. `window` (s) is the time over which the amplitude is taken.
    """

    law: Literal["keulegan_carpenter"]
    exponent: Annotated[float, Field(strict=True, ge=-1, le=1)]
    reference: Positive
    window: Positive = 60.0


class SuctionSide(Schema):
    """Drag at columns' ends where the flow leaves them (`jaxhydro.loads.drag.SuctionSideLaw`)."""

    law: Literal["suction_side"]
    suction: Share = 1.0


COEFFICIENTS = ("Ca_t", "Ca_z", "Cd_t", "Cd_z")


class Coefficients(Schema):
    """Added mass and drag of a group of members.

    t is transverse, z vertical of a pontoon or axial at a column's end. A coefficient is a number, or the name of another
    group whose coefficient it is.
    """

    Ca_t: Coefficient = 0.0
    Ca_z: Coefficient = 0.0
    Cd_t: Coefficient = 0.0
    Cd_z: Coefficient = 0.0
    drag_t: ConstantDrag | HighPass | KeuleganCarpenter = Field(
        default=ConstantDrag(),
        discriminator="law",
        description="a mapping with `law`: constant, high_pass or keulegan_carpenter",
    )
    drag_z: ConstantDrag | HighPassAtEnds | KeuleganCarpenter | SuctionSide = Field(
        default=ConstantDrag(),
        discriminator="law",
        description="a mapping with `law`: constant, high_pass, keulegan_carpenter or suction_side",
    )

    def numbers(self) -> dict[str, float]:
        """The group's own coefficients by name."""
        return {name: value for name in COEFFICIENTS if not isinstance(value := getattr(self, name), str)}

    def shared(self) -> dict[str, str]:
        """The groups whose coefficients it shares, by the coefficient's name."""
        return {name: value for name in COEFFICIENTS if isinstance(value := getattr(self, name), str)}
