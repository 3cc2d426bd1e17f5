"""Checks of coefficients that groups of members share."""

from collections.abc import Iterator, Mapping

from jaxhydro.errors import Problem, shown, suggest
from jaxhydro.platform.body import COEFFICIENTS, Coefficients


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
                told |= {(one, name) for one in path}
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
                found = f"one that nothing uses, as no member is of the group {group}"
                yield Problem(f"coefficients.{group}.{name}", "a coefficient that another group shares", found)
        for kind in "tz":
            if f"drag_{kind}" in groups[group].model_fields_set and (group, f"Cd_{kind}") not in used:
                expected, found = "a law of a coefficient that another group shares", "one that nothing uses"
                yield Problem(f"coefficients.{group}.drag_{kind}", expected, found)


def _path(groups: Mapping[str, Coefficients], group: str, name: str) -> list[str]:
    """Groups that name one another from `group` on, up to one that names none, or to one that was met before."""
    path = [group]
    while (row := groups.get(path[-1])) is not None and name in row.shared():
        path.append(row.shared()[name])
        if path[-1] in path[:-1]:
            break
    return path


def _fault(groups: Mapping[str, Coefficients], group: str, name: str, owner: str, path: list[str]) -> Problem | None:
    where, others = f"coefficients.{group}.{name}", [one for one in groups if one != group]
    known = [one for one in others if name in groups[one].numbers() and name in groups[one].model_fields_set]
    expected = f"a number >= 0, or a group with a number for {name} ({', '.join(known) or 'there is none'})"
    if owner not in groups:
        return Problem(where, expected, shown(owner), _number_in_quotes(owner) or suggest(owner, known))
    if path[-1] == group:
        return Problem(where, expected, shown(owner), f"{' -> '.join(path)}: none of them has a number.")
    if len(path) > 2:
        end = path[-1] if path[-1] in known else ""
        return Problem(where, expected, shown(owner), f"{owner} shares it itself." + (f" Name {end} here." if end else ""))
    if owner not in known:
        return Problem(where, expected, f"{shown(owner)}, which has no {name}")
    return None


def _number_in_quotes(text: str) -> str:
    try:
        float(text)
    except ValueError:
        return ""
    return "Write the number without quotes, as 12.5 or 1.0e6."
