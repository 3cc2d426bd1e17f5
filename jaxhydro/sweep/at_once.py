"""Simulation of one platform in several seas at once by one vectorised program, for GPUs."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Complex, Float

from jaxhydro.dynamics.integrate import Kernel, clock, integrate
from jaxhydro.dynamics.irregular_simulation import excursion_of, farthest
from jaxhydro.dynamics.model import Model, State
from jaxhydro.dynamics.statics import EquilibriumError, equilibrium
from jaxhydro.dynamics.time_steps import steps_in
from jaxhydro.integrators.mixed_precision import Precision
from jaxhydro.waves.irregular_sea import IrregularSea
from jaxhydro.waves.pair_sums import elevation_spectrum
from jaxhydro.waves.sea_state import state_of
from jaxhydro.waves.shared_preparation import Preparation


class SeaMotion(NamedTuple):
    """Motion in one sea.

    Attributes:
        position: Positions (m, rad), (t, 6).
        bound: `elevation_spectrum` of the sea (m), (b,); None at first order.
    """

    position: Float[np.ndarray, "t 6"]
    bound: Complex[np.ndarray, " b"] | None


def simulate_in_halves(
    model: Model,
    seas: list[IrregularSea],
    times: Float[np.ndarray, " t"],
    limit: float,
    kernel: Kernel = "off",
    precision: Precision = "double",
) -> list[SeaMotion | None]:
    """`simulate_together`, with half as many seas at once where memory runs out."""
    if not seas:
        return []
    try:
        return simulate_together(model, seas, times, limit, kernel, precision)
    except jax.errors.JaxRuntimeError:
        half = len(seas) // 2
        if not half:
            return [None]
        halves = (seas[:half], seas[half:])
        return [motion for part in halves for motion in simulate_in_halves(model, part, times, limit, kernel, precision)]


def simulate_together(
    model: Model,
    seas: Sequence[IrregularSea],
    times: Float[np.ndarray, " t"],
    limit: float,
    kernel: Kernel = "off",
    precision: Precision = "double",
) -> list[SeaMotion | None]:
    """Simulate seas that differ in amplitudes, phases and heading only, at once per heading.

    Args:
        model: The platform.
        seas: The seas.
        times: Output times (s), (t,).
        limit: Largest time step (s).
        kernel: Whether the time loop is one GPU kernel, as in `integrate`.
        precision: As in `integrate`.

    Returns:
        One motion per sea. None where the platform leaves the box that its sea was prepared for, or has no equilibrium.
    """
    motions: list[SeaMotion | None] = [None] * len(seas)
    alike: dict[Any, list[tuple[int, Any]]] = {}
    for i, sea in enumerate(seas):
        waves = sea.components
        model_in_sea = model.in_sea(state_of(waves))
        try:
            start = State(equilibrium(model_in_sea), jnp.zeros(6), model_in_sea.settled(jnp.zeros(6)))
        except EquilibriumError:
            continue
        case = (model_in_sea, start, waves.amplitude, waves.phase)
        shape = tuple(x.shape for x in jax.tree.leaves(eqx.filter(case, eqx.is_array)))
        alike.setdefault((float(waves.heading[0]), jax.tree.structure(case), shape), []).append((i, case))
    points, output_times = jnp.asarray(model.hull.extremities()), jnp.asarray(times)
    for same in alike.values():
        shared, step, steps = shared_preparation(model, seas[same[0][0]], times, limit)
        padded = [case for _, case in same] + [same[-1][1]] * (power_of_two(len(same)) - len(same))
        cases, axes = _stacked(padded)
        sizes = (jnp.asarray(step), steps, kernel, precision)
        position, reached, bound = _vectorised(cases, axes, len(padded), shared, points, output_times, *sizes)
        spectra = [None] * len(padded) if bound is None else np.asarray(bound)
        for (i, _), moved, far, spectrum in zip(same, np.asarray(position), np.asarray(reached), spectra):
            if not far > shared.half:
                motions[i] = SeaMotion(moved, spectrum)
    return motions


def power_of_two(count: int) -> int:
    """Smallest power of two from `count` on: seas are filled up to it, so that few programs are compiled."""
    return 1 << (count - 1).bit_length()


def shared_preparation(
    model: Model, sea: IrregularSea, times: Float[np.ndarray, " t"], limit: float
) -> tuple[Preparation, float, int]:
    """Preparation that all seas like this one share, with size (s) and number of the time steps."""
    step, steps = steps_in(sea, float(times[-1] - times[0]), limit)
    instants = clock("ab4", float(times[0]), step, steps)
    hull, computed = (model.hull.extremities(), model.cylinders), {"transfer": model.transfer, "exciting": model.excitation}
    return sea.preparation(*hull, instants, excursion_of(model), **computed), step, steps  # type: ignore[arg-type]


def _stacked(each: Sequence[Any]) -> tuple[Any, Any]:
    """Trees of one structure stacked in one, and the axes to vectorise over.

    Leaves that all trees share are not stacked.
    """
    leaves, tree = zip(*(jax.tree.flatten(case) for case in each))
    alike = [all(x is column[0] for x in column) or not eqx.is_array(column[0]) for column in zip(*leaves)]
    stacked = [c[0] if same else np.stack([np.asarray(x) for x in c]) for same, c in zip(alike, zip(*leaves))]
    return jax.tree.unflatten(tree[0], stacked), jax.tree.unflatten(tree[0], [None if same else 0 for same in alike])


@eqx.filter_jit
def _vectorised(cases, axes, count, shared, points, times, step, steps, kernel, precision):
    like = shared.like

    def simulated(case):
        model, start, amplitude, phase = case
        waves = eqx.tree_at(lambda w: (w.amplitude, w.phase), like.components, (amplitude, phase))
        sea = shared.of(waves)
        grid = integrate(model, sea, start, times[0], step, steps, "ab4", kernel=kernel, precision=precision)
        position = grid.at(times)[0]
        pairs = like.kinds, like.highest_difference
        bound = elevation_spectrum(waves, like.environment, jnp.zeros(2), *pairs) if like.order == 2 else None
        return position, farthest(position, points, model.through(sea)), bound

    return eqx.filter_vmap(simulated, in_axes=(axes,), axis_size=count)(cases)
