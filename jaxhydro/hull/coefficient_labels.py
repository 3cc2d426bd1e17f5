"""Labels of member coefficients, such as column.Cd_t, and coefficients that groups share."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

OF_ADDED_MASS = ("Ca", "Cp")  # symbols of what goes with Ca; all others go with Cd


class Share(NamedTuple):
    """Coefficient, such as Ca_t, that a group takes from the group `owner`."""

    group: str
    name: str
    owner: str


Shares = tuple[Share, ...]


def shares_of(groups: Iterable[tuple[str, Mapping[str, str]]]) -> Shares:
    """Shared coefficients, from each group's mapping of a coefficient's name to its owner."""
    return tuple(dict.fromkeys(Share(group, name, owner) for group, row in groups for name, owner in row.items()))


def coefficient_of(symbol: str, kind: str) -> str:
    """The coefficient that a parameter `symbol` (Cp, drag_exponent) of a `kind` (t, z) goes with."""
    return f"{'Ca' if symbol in OF_ADDED_MASS else 'Cd'}_{kind}"


def owners(rows: Iterable[tuple[str, str]], symbol: str, shares: Shares) -> list[tuple[str, str]]:
    """Groups that own a parameter, with its kind, for each group and kind.

    Args:
        rows: Groups and kinds (t, z).
        symbol: Symbol of the parameter (Ca, Cd, Cp, drag_exponent).
        shares: Coefficients that groups share.
    """
    owner = {(share.group, share.name): share.owner for share in shares}
    return [(owner.get((group, coefficient_of(symbol, kind)), group), kind) for group, kind in rows]
