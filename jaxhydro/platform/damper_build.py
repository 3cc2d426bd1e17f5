"""Tuned mass and liquid column dampers from the platform file."""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from jaxhydro.loads import AbstractLoad, LiquidColumnDampers, TunedMassDampers
from jaxhydro.platform.schema import Platform
from jaxhydro.remarks import Remark


def damper_loads(platform: Platform) -> list[AbstractLoad]:
    """Loads of the dampers of a platform file.

    Args:
        platform: Checked contents of the platform file.
    """
    loads: list[AbstractLoad] = []
    if masses := platform.tuned_mass_dampers:
        mass = {damper.name: damper.mass for damper in masses}
        period, ratio = ({damper.name: damper.tuning()[k] for damper in masses} for k in (0, 1))
        points, lines = _rows([damper.point for damper in masses]), _rows([damper.line() for damper in masses])
        loads.append(TunedMassDampers(tuple(mass), points, lines, mass, period, ratio, platform.water.gravity))
    if tubes := platform.liquid_column_dampers:
        area, loss = {damper.name: damper.area for damper in tubes}, {damper.name: damper.head_loss for damper in tubes}
        points, lines = _rows([damper.point for damper in tubes]), _rows([damper.line() for damper in tubes])
        sizes = _rows([(damper.width, damper.column, damper.density) for damper in tubes])
        loads.append(LiquidColumnDampers(tuple(area), points, lines, sizes, area, loss))
    return loads


def damper_mass(platform: Platform) -> float:
    """Mass (kg) of the dampers, which the platform carries beside its rigid body."""
    return sum(damper.mass for damper in platform.tuned_mass_dampers) + sum(
        damper.mass() for damper in platform.liquid_column_dampers
    )


def damper_remarks(platform: Platform) -> tuple[Remark, ...]:
    """Remark on the natural periods of a hull with dampers, and on the dampers' own."""
    periods = [(damper.name, damper.tuning()[0]) for damper in platform.tuned_mass_dampers]
    periods += [(damper.name, damper.period(platform.water.gravity)) for damper in platform.liquid_column_dampers]
    if not periods:
        return ()
    listed = ", ".join(f"{name} {period:.4g} s" for name, period in periods)
    return (Remark(f"natural periods are those of the hull with its dampers held; the dampers' own, the hull held: {listed}"),)


def _rows(rows: list) -> Float[Array, "k 3"]:
    return jnp.asarray(np.array(rows, float))
