"""Plausible sizes of candidate effects: by physics, or as campaign.yaml states them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from calibration.campaign.stated_sizes import STATED_SIZES, StatedSize, is_about, read_stated_size
from calibration.discovery.effects.candidates import Candidate, with_effects
from calibration.discovery.effects.catalogue_builder import NoticeableScales
from calibration.discovery.effects.reference_sizes import Case, Seas
from calibration.discovery.effects.size_ranges import Reach, reach_of
from jaxhydro.dynamics.model import Model
from jaxhydro.errors import InputError, Problem, shown, suggest
from jaxhydro.parameters import Parameter
from jaxhydro.units import parse_unit

OWN_EFFECT_WIDTH = 30.0  # of a user's own effect, in noticeable sizes
OWN_EFFECT = f"engineering judgement: an effect of one's own has up to {OWN_EFFECT_WIDTH:g} of the sizes stated as noticeable."
STATED = "stated in campaign.yaml, plausible.{}."


@dataclass(frozen=True)
class PlausibleSize:
    """Range of the values that a parameter of an effect can plausibly have.

    The neutral value is in it. Unless another value is `expected`, the distance from there to the further end is about two
    standard deviations of a Gaussian prior.

    Attributes:
        lower: Lowest value, in the SI unit of the label.
        upper: Highest value.
        source: Where the range comes from, in a sentence.
        stated: Whether the manifest states it.
        expected: Value that is expected where the effect is there; None: the neutral value.
        deviation: Standard deviation of the prior about it; None: by the range.
    """

    lower: float
    upper: float
    source: str
    stated: bool = False
    expected: float | None = None
    deviation: float | None = None

    def __contains__(self, value: float) -> bool:
        """Whether a value lies within the range."""
        return self.lower <= value <= self.upper


def plausible_sizes(
    model: Model,
    candidates: Sequence[Candidate],
    scales: Mapping[str, NoticeableScales],
    wave: Seas | None,
    stated: Mapping[str, str | float],
    source: str = "campaign.yaml",
) -> dict[str, PlausibleSize]:
    """Plausible sizes of all amplitudes of candidate effects.

    Args:
        model: The model, with or without the candidates.
        candidates: Candidate effects.
        scales: Noticeable sizes by motion.
        wave: The waves of the tests; None without tests in waves.
        stated: The manifest's `plausible`. Keys about effects that are no candidates are ignored.
        source: Name of the manifest, for messages.

    Returns:
        Ranges by label.

    Raises:
        InputError: A stated key fits no parameter of its effect, or has another unit or is a share where there is no whole.
        KeyError: No rule is about a label.
    """
    case, parameters, reaches = Case(model, scales, wave), {}, {}
    whole = with_effects(model, [label for candidate in candidates if candidate.load is None for label in candidate.amplitudes])
    for candidate in candidates:
        about = candidate.load or whole
        for label in candidate.amplitudes:
            parameters[label] = about.about(label)
            if candidate.load is not None:  # one's own effect may begin anywhere
                parameters[label] = parameters[label]._replace(neutral=float(candidate.load.values[label]))
            reaches[label] = _reach(case, candidate, label, parameters[label])
    sizes = {label: _size(parameters[label].neutral, reach) for label, reach in reaches.items()}
    problems: list[Problem] = []
    for key in sorted(stated, key=_closeness):
        outcome = _stated(key, stated[key], parameters, reaches)
        problems += [outcome] if isinstance(outcome, Problem) else []
        sizes |= outcome if isinstance(outcome, dict) else {}
    if problems:
        raise InputError(source, problems)
    return sizes


def _size(neutral: float, reach: Reach) -> PlausibleSize:
    expected = None if reach.deviation is None else neutral + reach.expected
    return PlausibleSize(neutral + reach.below, neutral + reach.above, reach.source, False, expected, reach.deviation)


def _reach(case: Case, candidate: Candidate, label: str, parameter: Parameter) -> Reach:
    if candidate.load is not None:
        size = OWN_EFFECT_WIDTH * candidate.sizes[label]
        lowest = 0.0 if label in candidate.positive else min(parameter.lower - parameter.neutral, 0.0)
        return Reach(max(-size, lowest), size, None, OWN_EFFECT)
    if (reach := reach_of(case, label)) is None:
        raise KeyError(f"no plausible size of {label}: add a rule to size_ranges.RANGES")
    return reach


def _closeness(key: str) -> tuple[bool, int, bool]:
    """Order in which keys of `plausible` are read: the closest to a label comes last."""
    return key not in STATED_SIZES, key.count("."), "*" not in key


def _stated(
    key: str, value: str | float, parameters: Mapping[str, Parameter], reaches: Mapping[str, Reach]
) -> dict[str, PlausibleSize] | Problem:
    """Ranges that one key states, or the problem with it."""
    labels, where, size = [label for label in parameters if is_about(key, label)], f"plausible.{key}", read_stated_size(value)
    if not labels:
        mine = [label for label in parameters if label.split(".")[0] == key.split(".")[0]]
        if key in STATED_SIZES or not mine:
            return {}
        return Problem(where, f"a parameter of this effect ({', '.join(mine)})", repr(key), suggest(key, mine))
    half_widths = {label: half for label in labels for half in _half_width(size, parameters[label], reaches[label])}
    if not half_widths:
        units = dict.fromkeys(parameters[label].unit for label in labels)
        shares = ["%"] if any(reaches[label].whole is not None for label in labels) else []
        return Problem(where, f"a quantity in {' or '.join([*units, *shares])}", shown(value))
    return {
        label: PlausibleSize(
            parameters[label].neutral - (half if reaches[label].below < 0 else 0.0),
            parameters[label].neutral + (half if reaches[label].above > 0 else 0.0),
            STATED.format(key),
            True,
        )
        for label, half in half_widths.items()
    }


def _half_width(size: StatedSize, parameter: Parameter, reach: Reach) -> Iterator[float]:
    """Distance (SI) from the neutral value that a stated size gives a parameter.

    Yields nothing where the size is in another unit, or is a share and there is no whole.
    """
    if size.share:
        yield from () if reach.whole is None else (size.value * reach.whole,)
    elif size.unit is None or size.unit.powers == parse_unit(parameter.unit).powers:
        yield size.value
