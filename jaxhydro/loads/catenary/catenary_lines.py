"""Mooring lines as elastic catenaries that may rest on the seabed."""

from collections.abc import Mapping
from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.loads.abstract_lines import AbstractLines
from jaxhydro.loads.catenary.catenary_profile import Segments, length_on_seabed
from jaxhydro.loads.catenary.catenary_tension import end_tension
from jaxhydro.parameters import Parameter, parameter, parameters

LEAST_SPAN = 1e-6  # m: horizontal distance below which the direction to the anchor is none
LEAST_HEIGHT = 1e-6  # height of the fairlead over the seabed, over the line's length
LEAST_WEIGHT = 1e-12  # weight of a line without weight, over its axial stiffness


class CatenaryLines(AbstractLines):
    """Elastic mooring lines with weight, from fairleads to anchors, in static balance at every instant.

    A line consists of segments of one or several types. Where the anchor is on the seabed, the line may rest there, with
    friction. Line inertia, drag and bending are left out. The balance of each line is that of
    `end_tension` (Jonkman 2007, NREL/TP-500-41958, section 2.6; Irvine 1981, Cable Structures).

    Labels:

    - `mooring.chain.axial_stiffness` (N) and `mooring.chain.submerged_weight` (N/m), of a line type named chain;
    - `mooring.line1.unstretched_length` (m), or `mooring.line1.segment2.unstretched_length` where a line has several
      segments, counted from the anchor;
    - `mooring.line1.anchor_shift` (m);
    - `mooring.seabed_friction` (-).
    """

    types: tuple[tuple[str, ...], ...] = eqx.field(static=True)  # of the segments of each line, from the anchor
    grounded: tuple[bool, ...] = eqx.field(static=True)  # whether the anchor of each line is on the seabed
    axial_stiffness: Mapping[str, Float[Array, ""] | float] = parameters(
        lambda load, name: Parameter("N", f"axial stiffness EA of {name}", 0.0)
    )
    submerged_weight: Mapping[str, Float[Array, ""] | float] = parameters(
        lambda load, name: Parameter("N/m", f"weight in water of {name} per unstretched length", 0.0)
    )
    unstretched_length: Mapping[str, Float[Array, ""] | float] = parameters(
        lambda load, name: Parameter("m", f"unstretched length of {name.replace('.', ', ')}", 0.0)
    )
    anchor_shift: Mapping[str, Float[Array, ""] | float] = parameters(
        lambda load, name: Parameter("m", f"shift of the anchor of {name} away from the platform", -50.0, 50.0)
    )
    seabed_friction: Float[Array, ""] = parameter("-", "friction coefficient of lines on the seabed", 0.0, 3.0)
    source: ClassVar[str] = "Jonkman 2007, NREL/TP-500-41958, section 2.6; Irvine 1981"

    def tension(
        self, position: Float[Array, "6"], matrix: Float[Array, "3 3"]
    ) -> tuple[Float[Array, " l"], Float[Array, "3 l"]]:
        """Tension and unit vectors of the pull, as `AbstractLines.tension`; NaN where no balance was found."""
        pull = self.pull(position, matrix)
        square = (pull**2).sum(axis=0)
        size = jnp.sqrt(jnp.where(square > 0, square, 1.0))
        return jnp.where(square > 0, size, 0.0), pull / size

    def on_seabed(self, vertical: Float[Array, " l"]) -> Float[Array, " l"]:
        """Unstretched length of each line that rests on the seabed (m), (l,).

        Args:
            vertical: Vertical tension at the fairleads (N), (l,).
        """
        return length_on_seabed(vertical, self.segments())

    def segments(self) -> Segments:
        """The lines as the equations read them, from the fairlead down.

        Numbers of 0 are replaced by small ones.
        """
        most = max(map(len, self.types))
        rows = []
        for i, kinds in enumerate(self.types):
            names = segment_names(i, len(kinds))
            row = [
                (self.unstretched_length[name], self.submerged_weight[kind], self.axial_stiffness[kind])
                for name, kind in zip(names, kinds)
            ][::-1]
            rows.append(row + [(jnp.zeros(()), *row[-1][1:])] * (most - len(row)))
        length, weight, stiffness = (
            jnp.stack([jnp.stack([segment[k] for segment in row]) for row in rows], axis=1) for k in range(3)
        )
        total = length.sum(axis=0)
        length = jnp.where(total > 0, length, 1.0)
        stiffness = jnp.where(stiffness > 0, stiffness, 1.0)
        weight = jnp.maximum(weight, LEAST_WEIGHT * stiffness / length.sum(axis=0))
        friction = jnp.broadcast_to(self.seabed_friction, total.shape)
        return Segments(length, weight, stiffness, friction, jnp.array(self.grounded))

    def pull(self, position: Float[Array, "6"], matrix: Float[Array, "3 3"]) -> Float[Array, "3 l"]:
        """Force of each line at its fairlead (N), body axes, (3, l)."""
        segments = self.segments()
        radial = (self.anchor - self.fairlead)[:2]
        shift = jnp.stack([self.anchor_shift[f"line{i + 1}"] for i in range(len(self.types))])
        anchor = self.anchor.at[:2].add(shift * radial / jnp.sqrt((radial**2).sum(axis=0) + LEAST_SPAN**2))
        away = anchor - position[:3, None] - (matrix[:, :, None] * self.fairlead[None, :, :]).sum(axis=1)
        span = jnp.sqrt(away[0] ** 2 + away[1] ** 2 + LEAST_SPAN**2)
        height = jnp.where(segments.grounded, jnp.maximum(-away[2], LEAST_HEIGHT * segments.length.sum(axis=0)), -away[2])
        horizontal, vertical = end_tension(span, height, segments)
        pull = jnp.concatenate([horizontal * away[:2] / span, -vertical[None]])
        return (matrix[:, :, None] * jnp.where(self._present(), pull, 0.0)[:, None, :]).sum(axis=0)

    def _present(self) -> Any:
        """Whether each line has a length, and each of its segments an axial stiffness."""
        present = []
        for i, kinds in enumerate(self.types):
            length = sum(self.unstretched_length[name] for name in segment_names(i, len(kinds)))
            stiff = jnp.stack([self.axial_stiffness[kind] for kind in kinds]).min()
            present.append((length > 0) & (stiff > 0))
        return jnp.stack(present)


def segment_names(line: int, count: int) -> list[str]:
    """Names of the segments of a line, from the anchor, in labels of parameters.

    Args:
        line: Number of the line, from 0.
        count: Number of its segments.
    """
    return [f"line{line + 1}"] if count == 1 else [f"line{line + 1}.segment{k + 1}" for k in range(count)]
