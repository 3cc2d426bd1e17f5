"""Checks of coefficients that groups of members share."""

from collections.abc import Iterator, Mapping

from jaxhydro.errors import Problem, shown, suggest
from jaxhydro.platform.coefficients_schema import COEFFICIENTS, Coefficients


def owners(groups: Mapping[str, Coefficients]) -> set[str]:
    """Groups whose coefficients others share."""
    return {owner for row in groups.values() for owner in row.shared().values()}


def sharing_faults(groups: Mapping[str, Coefficients], with_members: set[str]) -> Iterator[Problem]:
    """Mistakes in shared coefficients; `with_members` are the groups that have members."""
    told: set[tuple[str, str]] = set()  # coefficients that name each other in a circle
    for group, row in groups.items():
        for name, owner in row.shared().items():
            if (group, name) in told:
                continue
            path = _path(groups, group, name)
            if path[-1] == group and len(path) > 1:
                told |= {(link, name) for link in path}
            if (fault := _fault(groups, group, name, owner, path)) is not None:
                yield fault
        for kind in "tz":
            if (owner := row.shared().get(f"Cd_{kind}", "")) and f"drag_{kind}" in row.model_fields_set:
                yield Problem(
                    f"coefficients.{group}.drag_{kind}",
                    f"no law beside a shared Cd_{kind}",
                    "one",
                    f"The law of {owner}.Cd_{kind} goes with it.",
                )
    used = {(owner, name) for row in groups.values() for name, owner in row.shared().items()}
    for group in owners(groups) & groups.keys() - with_members:
        for name in COEFFICIENTS:
            if name in groups[group].model_fields_set and (group, name) not in used:
                actual = f"one that nothing uses, as no member is of the group {group}"
                yield Problem(f"coefficients.{group}.{name}", "a coefficient that another group shares", actual)
        for kind in "tz":
            if f"drag_{kind}" in groups[group].model_fields_set and (group, f"Cd_{kind}") not in used:
                expected, actual = "a law of a coefficient that another group shares", "one that nothing uses"
                yield Problem(f"coefficients.{group}.drag_{kind}", expected, actual)


def _path(groups: Mapping[str, Coefficients], group: str, name: str) -> list[str]:
    """Groups that name one another, from `group` on.

    The last one names none, or was met before.
    """
    path = [group]
    while (row := groups.get(path[-1])) is not None and name in row.shared():
        path.append(row.shared()[name])
        if path[-1] in path[:-1]:
            break
    return path


def _fault(groups: Mapping[str, Coefficients], group: str, name: str, owner: str, path: list[str]) -> Problem | None:
    where, others = f"coefficients.{group}.{name}", [other for other in groups if other != group]
    candidates = [other for other in others if name in groups[other].numbers() and name in groups[other].model_fields_set]
    expected = f"a number >= 0, or a group with a number for {name} ({', '.join(candidates) or 'there is none'})"
    if owner not in groups:
        return Problem(where, expected, shown(owner), _number_in_quotes(owner) or suggest(owner, candidates))
    if path[-1] == group:
        return Problem(where, expected, shown(owner), f"{' -> '.join(path)}: none of them has a number.")
    if len(path) > 2:
        end = path[-1] if path[-1] in candidates else ""
        return Problem(where, expected, shown(owner), f"{owner} shares it itself." + (f" Name {end} here." if end else ""))
    if owner not in candidates:
        return Problem(where, expected, f"{shown(owner)}, which has no {name}")
    return None


def _number_in_quotes(text: str) -> str:
    try:
        float(text)
    except ValueError:
        return ""
    return "Write the number without quotes, as 12.5 or 1.0e6."
