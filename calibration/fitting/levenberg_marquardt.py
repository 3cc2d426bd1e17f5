"""Levenberg-Marquardt optimiser with limited steps, on optimistix."""

import math
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import lineax as lx
import optimistix as optx
from jaxtyping import PyTree

from jaxhydro.interrupts import stop_if_asked


class ClippedDescent(optx.AbstractDescent):
    """A descent whose step is shortened, not bent, to at most `longest` in its largest component.

    Coordinates are logarithms and relative motions: a step of 1 changes a coefficient by a factor of e.
    """

    descent: optx.AbstractDescent
    longest: float

    def init(self, y: PyTree, f_info_struct: Any) -> Any:
        return self.descent.init(y, f_info_struct)

    def query(self, y: PyTree, f_info: Any, state: Any) -> Any:
        return self.descent.query(y, f_info, state)

    def step(self, step_size: Any, state: Any) -> tuple[PyTree, optx.RESULTS]:
        diff, result = self.descent.step(step_size, state)
        largest = jnp.max(jnp.stack([jnp.max(jnp.abs(leaf), initial=0.0) for leaf in jax.tree.leaves(diff)]))
        scale = jnp.minimum(1.0, self.longest / jnp.maximum(largest, 1e-300))
        return jax.tree.map(lambda leaf: scale * leaf, diff), result


class ClippedLevenbergMarquardt(optx.AbstractGaussNewton):
    """Levenberg-Marquardt of clipped steps, its damping relaxed whenever three quarters of the promised decrease come true.

    optimistix's own asks for 99 % and needs twice the iterations on decays.
    """

    rtol: float
    atol: float
    norm: Any
    descent: ClippedDescent
    search: optx.AbstractSearch
    verbose: Any

    def __init__(self, rtol: float, atol: float, longest: float = 0.7):
        self.rtol, self.atol, self.norm = rtol, atol, optx.max_norm
        self.descent = ClippedDescent(optx.DampedNewtonDescent(linear_solver=lx.QR()), longest)
        self.search = _TrustRegion()
        self.verbose = _silent


def _silent(**_: Any) -> None:
    return None


class _TrustRegion(optx.ClassicalTrustRegion):
    """optimistix's trust region, its cutoffs chosen for residuals relative to the motion."""

    high_cutoff: float = 0.75
    low_cutoff: float = 0.01
    high_constant: float = 2.5
    low_constant: float = 0.25


MAX_ITERATIONS = 60  # iterations at most
DEFAULT_TRUST = 100.0  # for residuals relative to the motion
MAX_REFUSED_STEPS = 8  # refused steps in a row after which there is nowhere to go
SOLVER = ClippedLevenbergMarquardt(rtol=1e-8, atol=1e-8)  # `descend` ends by its own tolerance


class DescentState(NamedTuple):
    """Where a descent is after an iteration: the unknowns, what the objective returned beside its residuals there, and whether
    it ended there of its own."""

    unknowns: PyTree
    aux: PyTree
    settled: bool


@eqx.filter_jit
def _begin(objective: Callable, unknowns: PyTree, args: PyTree):
    f_struct, aux_struct = jax.eval_shape(lambda: objective(unknowns, args))
    return SOLVER.init(objective, unknowns, args, {}, f_struct, aux_struct, frozenset())


@eqx.filter_jit
def _step(objective: Callable, unknowns: PyTree, args: PyTree, state: Any):
    return SOLVER.step(objective, unknowns, args, {}, state, frozenset())


def descend(
    objective: Callable, unknowns: PyTree, args: PyTree, tolerance: float, trust: float = DEFAULT_TRUST
) -> Iterator[DescentState]:
    """Levenberg-Marquardt on the residuals that `objective(unknowns, args)` returns first, iteration by iteration. Its damping
    begins as 1 / `trust`.

    It is done where an accepted step gains less than `tolerance` of the sum of squares, where steps are refused however short
    they are, or after `MAX_ITERATIONS` iterations. One compilation serves all calls with arguments of the same shapes.
    """
    state = _begin(objective, unknowns, args)
    state = eqx.tree_at(lambda s: s.search_state.step_size, state, jnp.asarray(trust))
    last, refused, accepted = math.inf, 0, 0
    for _ in range(MAX_ITERATIONS):
        stop_if_asked()
        unknowns, state, _ = _step(objective, unknowns, args, state)
        cost = float(sum(jnp.sum(x**2) for x in jax.tree.leaves(state.f_info.residual)))
        taken = int(state.num_accepted_steps) > accepted
        accepted = int(state.num_accepted_steps)
        refused = 0 if taken else refused + 1
        settled = (taken and last - cost < tolerance * cost) or refused >= MAX_REFUSED_STEPS
        last = cost
        yield DescentState(unknowns, state.aux, settled and math.isfinite(cost))
        if settled:
            return
