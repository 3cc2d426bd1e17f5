"""Motions that are large beside others of their unit, which tables and fits count."""

from collections.abc import Mapping

import numpy as np

from jaxhydro.environment import DOFS

MOVING_SHARE = 0.2  # of the largest motion of its unit: what moves less is in the files, and neither in tables nor fitted


def moving_channels(motions: Mapping[str, np.ndarray]) -> list[str]:
    """Motions that are large beside others of their unit.

    Args:
        motions: Records (m, rad) by degree of freedom.
    """
    return moving({name: float(np.std(values)) for name, values in motions.items()})


def moving(size: Mapping[str, float]) -> list[str]:
    """Motions whose standard deviation is large beside those of the same unit.

    Args:
        size: Standard deviations (m, rad) by degree of freedom.
    """
    angle = {name: DOFS.index(name) > 2 for name in size}
    largest = {kind: max((size[n] for n in size if angle[n] == kind), default=0.0) for kind in (False, True)}
    return [name for name in size if size[name] >= MOVING_SHARE * largest[angle[name]]]
