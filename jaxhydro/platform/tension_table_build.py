"""Ropes with tabulated tension from the platform file."""

import numpy as np
from jaxtyping import Float

from jaxhydro.loads.tension_table_lines import TensionTable, TensionTableLines
from jaxhydro.platform.tension_table_schema import TensionTableMooring
from jaxhydro.quick_jit import on_device


def tension_table(stretch: Float[np.ndarray, " n"], tension: Float[np.ndarray, " n"], interpolation: str) -> TensionTable:
    """Table of entries, straight or monotone between them; beyond the last as steep as there.

    Args:
        stretch: Stretch (m) or strain (-), rising from 0.
        tension: Tension (N), from 0.
        interpolation: `linear`, or `pchip` for a monotone cubic with a continuous slope.

    References:
        Fritsch and Butland (1984), SIAM J. Sci. Stat. Comput. 5, 300-304, as in SciPy's PchipInterpolator.
    """
    stretch, tension = np.asarray(stretch, float), np.asarray(tension, float)
    if interpolation == "pchip" and len(stretch) > 2:
        from scipy.interpolate import PchipInterpolator  # what takes long to import is imported where it is used

        curve = PchipInterpolator(stretch, tension)
        inner, slope = curve.c, float(curve(stretch[-1], 1))
    else:
        slopes = np.diff(tension) / np.diff(stretch)
        inner, slope = np.stack([0 * slopes, 0 * slopes, slopes, tension[:-1]]), slopes[-1]
    beyond = np.array([[0.0], [0.0], [slope], [tension[-1]]])
    return TensionTable(on_device(stretch), on_device(np.concatenate([inner, beyond], axis=1)))


def tension_table_lines(mooring: TensionTableMooring) -> TensionTableLines:
    """Load of the ropes of a platform file; copies of a line by heading follow each other.

    Args:
        mooring: Checked contents of the platform file.
    """
    names = list(mooring.ropes)
    ends = [(line, *copy) for line in mooring.lines for copy in line.copies()]
    ropes = mooring.ropes.values()
    return TensionTableLines(
        on_device(np.stack([anchor for _, anchor, _ in ends], axis=1)),
        on_device(np.stack([fairlead for _, _, fairlead in ends], axis=1)),
        tuple(tension_table(rope.entries(), np.array(rope.tension, float), rope.interpolation) for rope in ropes),
        tuple(rope.over_strain for rope in ropes),
        tuple(names.index(line.rope) for line, _, _ in ends),
        {f"rope{i}": line.unstretched_length for i, (line, _, _) in enumerate(ends, 1)},
        {f"rope{i}": 1.0 for i in range(1, len(ends) + 1)},
    )
