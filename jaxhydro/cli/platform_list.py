"""`jaxhydro platforms`: what the built-in platforms are."""

import numpy as np

from jaxhydro.platform.body import Member
from jaxhydro.platform.schema import load_platform

HEADS = ("Name", "Platform", "Mass (t)", "Draught (m)", "Water depth (m)")


def particulars(name: str) -> tuple[str, ...]:
    """A built-in platform: name, title, mass (t), draught (m) and water depth (m)."""
    platform = load_platform(name)
    mass, _, _ = platform.rigid_body.combined()
    draught = -min(map(lowest_point, platform.members))
    return name, platform.name, f"{mass / 1e3:.5g}", f"{draught:.3g}", f"{platform.water.depth:g}"


def lowest_point(member: Member) -> float:
    """Height (m) of the lowest point of a member above still water."""
    ends, (_, sizes) = np.array([member.rA, member.rB]), member.profile()
    along = ends[1] - ends[0]
    level = np.hypot(along[0], along[1]) / np.linalg.norm(along)  # 1 for a horizontal member, 0 for a vertical one
    return float((ends[:, 2] - 0.5 * level * sizes[[0, -1], 1]).min())
