"""Loads of the mooring of a platform file, and remarks on its lines."""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.loads import AbstractLines, AbstractLoad, MooringLines, Stiffness
from jaxhydro.platform.catenary_build import catenary_lines, catenary_remarks
from jaxhydro.platform.catenary_schema import Catenary
from jaxhydro.platform.matrix_schema import entries_of
from jaxhydro.platform.mooring_schema import LinearSprings, StiffnessMatrix
from jaxhydro.platform.schema import Platform
from jaxhydro.platform.tension_table_build import tension_table_lines
from jaxhydro.platform.tension_table_schema import TensionTableMooring
from jaxhydro.quick_jit import on_device, quick_jit
from jaxhydro.remarks import Remark, as_warnings


def mooring_remarks(platform: Platform) -> tuple[Remark, ...]:
    """Warnings of mooring lines that are slack or stretched by much at rest."""
    if isinstance(platform.mooring, Catenary):
        return as_warnings(catenary_remarks(platform.mooring, platform.water, platform.name))
    if isinstance(platform.mooring, TensionTableMooring):
        return as_warnings(platform.mooring.remarks())
    slack = platform.mooring.slackness() if isinstance(platform.mooring, LinearSprings) else ""
    return as_warnings([slack] if slack else [])


def mooring_loads(platform: Platform) -> list[AbstractLoad]:
    """Loads of the mooring: its lines, or a stiffness matrix; none without a mooring."""
    mooring = platform.mooring
    if isinstance(mooring, StiffnessMatrix):
        return [Stiffness(entries_of("C", mooring.matrix()), on_device(np.asarray(mooring.preload, float)), "mooring")]
    if isinstance(mooring, Catenary):
        return [catenary_lines(mooring, platform.water)]
    if isinstance(mooring, TensionTableMooring):
        return [tension_table_lines(mooring)]
    if not isinstance(mooring, LinearSprings):
        return []
    springs = {f"line{i + 1}": line.spring() for i, line in enumerate(mooring.lines)}
    stiffness, unstretched = ({name: spring[k] for name, spring in springs.items()} for k in (0, 1))
    anchor = on_device(np.array([line.anchor for line in mooring.lines], float).T)
    fairlead = on_device(np.array([line.fairlead for line in mooring.lines], float).T)
    return [MooringLines(anchor, fairlead, stiffness, unstretched)]


def line_pull(load: AbstractLoad) -> float:
    """Vertical force (N) of lines at the reference position."""
    assert isinstance(load, AbstractLines)
    tension, towards = (np.asarray(x) for x in _pull(load))
    return float((tension * towards[2]).sum())


@quick_jit
def _pull(load: AbstractLines) -> tuple[Float[Array, " l"], Float[Array, "3 l"]]:
    return load.tension(jnp.zeros(6), jnp.eye(3))
