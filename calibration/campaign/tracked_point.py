"""Transfer of motions from a tracked point of the hull to the reference point."""

from collections.abc import Collection, Iterator, Mapping

import numpy as np
import scipy  # its parts are imported when they are used: that takes a second

from jaxhydro.environment import DOFS
from jaxhydro.errors import Problem

Point = tuple[float, float, float]
LEVERS = {  # translation -> the angles that move it, each with the coordinate of the point that is its lever
    "surge": {"pitch": 2, "yaw": 1},
    "sway": {"roll": 2, "yaw": 0},
    "heave": {"pitch": 0, "roll": 1},
}


def missing_angles(point: Point, channels: Collection[str]) -> Iterator[Problem]:
    """A problem for every angle that is needed to move the recorded translations and has no channel."""
    needed: dict[str, list[str]] = {}
    for motion, angles in LEVERS.items():
        for angle, axis in angles.items():
            if motion in channels and point[axis] != 0 and angle not in channels:
                needed.setdefault(angle, []).append(f"{motion}, since {'xyz'[axis]} is {point[axis]:g} m")
    for angle, why in needed.items():
        yield Problem("tracked_point", f"a channel {angle}, which moves the point in {' and in '.join(why)}", "none")


def move_to_reference(values: Mapping[str, np.ndarray], point: Point) -> dict[str, np.ndarray]:
    """Motions of the reference point, from those of a tracked point.

    y = p + R o - o. Here y is the recorded motion, and p that of the reference point. The point in body axes is o, and R the
    rotation by roll, pitch and yaw. Angles are those of any point. An angle that is not recorded is zero.

    Args:
        values: Recorded motion by name, all of one length (m, rad).
        point: The tracked point in body axes from the reference point, m.

    Returns:
        The same names with surge, sway and heave of the reference point.

    References:
        Fossen 2011, Handbook of Marine Craft Hydrodynamics and Motion Control, section 2.2.
    """
    none = np.zeros(len(next(iter(values.values()))))
    yaw, pitch, roll = (values.get(name, none) for name in ("yaw", "pitch", "roll"))
    rotation = scipy.spatial.transform.Rotation.from_euler("ZYX", np.stack([yaw, pitch, roll], axis=1))
    turned = rotation.apply(point) - np.asarray(point)
    return {name: motion - turned[:, DOFS.index(name)] if name in LEVERS else motion for name, motion in values.items()}


def noise_moved_to_reference(noise: Mapping[str, float], point: Point) -> dict[str, float]:
    """Standard deviations of the noise (m, rad) after `move_to_reference`.

    Noise of the angles adds to that of the translations by their levers.
    """
    moved = dict(noise)
    for motion, angles in LEVERS.items():
        if motion in noise:
            parts = [noise[motion], *(point[axis] * noise.get(angle, 0.0) for angle, axis in angles.items())]
            moved[motion] = float(np.linalg.norm(parts))
    return moved
