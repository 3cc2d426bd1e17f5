"""Members of a platform file, each copied to its headings."""

import math

import numpy as np

from jaxhydro.errors import InputError, Problem
from jaxhydro.hull.member import Member
from jaxhydro.platform.schema import Platform


def check_wetting(members: list[Member], platform: Platform) -> None:
    """Raise InputError for pontoons that still water cuts and whose waterplane is not modelled.

    Modelled are level members, and inclined ones that are cut through their sides (`waterplane`).
    """
    names = [member.name for member in platform.members for _ in member.heading]
    where = {name: i for i, name in reversed(list(enumerate(member.name for member in platform.members)))}
    problems = [
        Problem(
            f"members[{where[name]}]",
            "a member flatter than 45 deg to be level, or clear of still water, or cut by it between its ends",
            f"{name!r}, of whose height {member.submerged:.0%} is under it",
            "Make what floats of level or upright members, side by side; let a brace end well above still water.",
        )
        for name, member in zip(names, members, strict=True)
        if member.pierced and not (member.floats or member.fills)
    ]
    if problems:
        raise InputError(platform.name, list(dict.fromkeys(problems)))


def members_of(platform: Platform) -> list[Member]:
    """Members of the platform, each copied to its headings."""
    members = []
    for member in platform.members:
        stations, sizes = member.profile()
        for copy, heading in enumerate(member.heading):
            c, s = math.cos(math.radians(heading)), math.sin(math.radians(heading))
            turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
            members.append(
                Member(
                    name=member.name if len(member.heading) == 1 else f"{member.name}_{copy + 1}",
                    group=member.group,
                    circular=member.shape == "circ",
                    a=turn @ np.array(member.rA),
                    b=turn @ np.array(member.rB),
                    stations=stations,
                    sizes=sizes,
                    # the width of an upright box lies along its heading
                    twist=math.radians(member.gamma) + (math.radians(heading) if member.rA[:2] == member.rB[:2] else 0.0),
                    elements=member.elements,
                    maccamy_fuchs=member.maccamy_fuchs,
                    points=member.points,
                    shared=platform.coefficients[member.group].shared(),
                )
            )
    return members
