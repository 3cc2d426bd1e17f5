"""Submerged shape of a hull's strips, ends and faces at an instant."""

import math
from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.hull.hull import Hull, Wetted


class StripShape(NamedTuple):
    """Submerged part of each strip.

    Attributes:
        volume: Displaced volume (m³), (n,).
        facing: Area (m²) normal to the flow along each of the two directions, (2, n).
    """

    volume: Float[Array, " n"]
    facing: Float[Array, "2 n"]


class EndShape(NamedTuple):
    """Areas and added-mass volumes of member ends and of the faces of tapered strips.

    A face belongs to the wet part of its strip. An end is weighted by `EndFlow.wet`. The end of a member that lies at the
    surface has the area of the wet section beside it.

    A face of a strip over which the section A = pi r² grows by dA has the area dA, against the axis. Its volume is r dA.
    Over a step that makes 2/3 pi (R³ - r³), the difference of two half spheres.

    Attributes:
        area: Area (m²) on which pressure acts, (m,).
        facing: Area (m²) normal to the flow along the axis, (m,).
        volume: Volume (m³) to which added mass refers, (m,).

    References:
        OpenFAST HydroDyn, Morison module (tapered members); RAFT, raft_member.py, getHydroConstants.
    """

    area: Float[Array, " m"]
    facing: Float[Array, " m"]
    volume: Float[Array, " m"]

    @classmethod
    def of(cls, hull: Hull, wetted: Wetted, covered: Float[Array, " n"], extent: Float[Array, "2 n"]) -> "EndShape":
        """Shape of a hull's ends and faces at an instant.

        Args:
            hull: The hull.
            wetted: Submerged part of each load element.
            covered: Wet length of each strip (m), (n,).
            extent: Size of each strip along its two directions (m), (2, n).
        """
        ends, strips, area = hull.ends, hull.strips, hull.ends.area
        if ends.afloat:
            index, beside, part = (jnp.array(column) for column in zip(*ends.afloat, strict=True))
            area = area.at[index].set(area[index] / part * wetted.length[beside] / hull.elements.length[beside])
        without_faces = cls(area, ends.facing, ends.volume)
        if not ends.strip:
            return without_faces
        face_strip = jnp.array(ends.strip, dtype=int)
        shape, (width, height), (wider, higher) = strips.shape[face_strip], extent[:, face_strip], strips.taper[:, face_strip]
        grown = shape * (wider * height + higher * width) * covered[face_strip]
        faces = slice(len(ends.label) - len(ends.strip), None)
        facing = jnp.where(ends.radius[faces] > 0, jnp.abs(grown), 0.0)
        radius = jnp.sqrt(shape * width * height / math.pi)
        of_faces = (-ends.outward[faces] * grown, facing, radius * facing)
        return cls(*(values.at[faces].set(face) for values, face in zip(without_faces, of_faces, strict=True)))


class Lines(NamedTuple):
    """Distances and centripetal accelerations of strips, ends and faces.

    Attributes:
        away: Distance (m) from the start of the load element, (l,).
        inward: Centripetal acceleration (m/s²) along the line, (l,).
    """

    away: Float[Array, " l"]
    inward: Float[Array, " l"]
