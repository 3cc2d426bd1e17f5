"""How the measured waves of a campaign are reconstructed and act."""

import dataclasses
from collections.abc import Collection
from dataclasses import dataclass
from typing import Literal, get_args

from calibration.campaign.load_campaign import Campaign
from calibration.campaign.wave_band import wave_band
from jaxhydro.choices import check
from jaxhydro.dynamics.conventions import allowed_values
from jaxhydro.waves.irregular_sea import Acting
from jaxhydro.waves.sea import Stretching
from jaxhydro.waves.second_order import KINDS, Kind


@dataclass(frozen=True)
class Options:
    """How waves are made and act.

    Below the default band a sea has next to no first-order waves; what a gauge reads there is bound, or the basin's own. Above
    it waves are shorter than 17 m, and the second order of a record need not converge.

    Attributes:
        order: Order of the waves.
        stretching: Flow above still water.
        diffraction: Diffraction by columns; None: as the platform says.
        low: Lowest frequency of the first order (Hz, full scale).
        cutoff: Highest frequency of the first order (Hz, full scale).
        kinds: Pairs of components that bind waves at second order.
        highest_difference: Highest difference frequency of bound waves (Hz, full scale); None: all.
        acting: Where bound waves act, as in `IrregularSea`.
    """

    order: Literal[1, 2] = 2
    stretching: Stretching = "vertical"
    diffraction: Literal["maccamy_fuchs", "ramp", "none"] | None = None
    low: float = 0.03
    cutoff: float = 0.3
    kinds: tuple[Kind, ...] = KINDS
    highest_difference: float | None = None
    acting: Acting = "everywhere"

    def __post_init__(self) -> None:
        """Raises UnknownName for another order, stretching, diffraction, kind or place of action."""
        check(order=(self.order, (1, 2)), stretching=(self.stretching, get_args(Stretching)))
        check(diffraction=(self.diffraction, (*allowed_values("diffraction"), None)), acting=(self.acting, get_args(Acting)))
        for kind in self.kinds:
            check(kinds=(kind, KINDS))


def options_of(campaign: Campaign) -> Options:
    """Default options of a campaign's seas: its band of frequencies, and waves as its `records` state."""
    manifest, stated = campaign.manifest, campaign.manifest.records
    low, cutoff = wave_band(manifest, campaign.model, campaign.records)
    highest = None if stated.highest_difference is None else stated.highest_difference / manifest.scale**0.5
    return Options(
        order=stated.order, low=low, cutoff=cutoff, kinds=stated.kinds, highest_difference=highest, acting=stated.acting
    )


def non_default_options(options: Options, asked: Collection[str] = (), usual: Options = Options()) -> str:
    """Options of seas that differ from the `usual` ones, in words, except those in `asked`."""
    words = []
    of_second = {
        "kinds": f"bound waves at {' and '.join(f'{kind}s' for kind in options.kinds)} of frequencies only",
        "highest_difference": f"differences up to {options.highest_difference or 0:.3g} Hz",
        "acting": f"bound waves act {options.acting}",
    }
    for name in (field.name for field in dataclasses.fields(options) if field.name not in asked):
        if (value := getattr(options, name)) != getattr(usual, name) and (options.order == 2 or name not in of_second):
            words.append(of_second.get(name, f"{name}: {value:.3g} Hz" if isinstance(value, float) else f"{name}: {value}"))
    return ", ".join(words)
