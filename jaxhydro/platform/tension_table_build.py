"""Ropes with tabulated tension from the platform file."""

import jax.numpy as jnp
import numpy as np

from jaxhydro.loads.tension_table_lines import TensionTable, TensionTableLines
from jaxhydro.platform.tension_table_schema import TensionTableMooring


def tension_table_lines(mooring: TensionTableMooring) -> TensionTableLines:
    """Load of the ropes of a platform file; copies of a line by heading follow each other.

    Args:
        mooring: Checked contents of the platform file.
    """
    names = list(mooring.ropes)
    ends = [(line, *copy) for line in mooring.lines for copy in line.copies()]
    ropes = mooring.ropes.values()
    return TensionTableLines(
        jnp.asarray(np.stack([anchor for _, anchor, _ in ends], axis=1)),
        jnp.asarray(np.stack([fairlead for _, _, fairlead in ends], axis=1)),
        tuple(TensionTable.of(rope.entries(), np.array(rope.tension, float), rope.interpolation) for rope in ropes),
        tuple(rope.over_strain for rope in ropes),
        tuple(names.index(line.rope) for line, _, _ in ends),
        {f"rope{i}": line.unstretched_length for i, (line, _, _) in enumerate(ends, 1)},
        {f"rope{i}": 1.0 for i in range(1, len(ends) + 1)},
    )
