"""Levenberg-Marquardt optimiser with limited steps, on cost, gradient and Gauss-Newton matrix."""

import math
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import optimistix as optx
from jaxtyping import Array, Bool, PyTree

from calibration.fitting.normal_equations import clipped
from calibration.residuals.abstract_residual import Unknowns
from jaxhydro.exported_programs import exported_jit
from jaxhydro.interrupts import stop_if_asked

LONGEST_STEP = 0.7  # coordinates are logarithms and relative motions: 1 changes a coefficient by a factor of e
MAX_ITERATIONS = 60  # iterations at most
DEFAULT_TRUST = 100.0  # for residuals relative to the motion
MAX_REFUSED_STEPS = 8  # refused steps in a row after which there is nowhere to go

# returns optimistix's `FunctionInfo.EvalGradHessian`, with an `ArrowMatrix`, and anything else that goes with it
Objective = Callable[[Unknowns, PyTree], tuple[Any, PyTree]]


class EliminatedDescent(optx.AbstractDescent[Unknowns, optx.FunctionInfo.EvalGradHessian, Any]):
    """Damped Newton step of limited length, with each record's own unknowns eliminated.

    Attributes:
        longest: Largest magnitude of a component of the step.
    """

    longest: float = LONGEST_STEP

    def init(self, y: Unknowns, f_info_struct: Any) -> Any:
        return jax.tree.map(lambda leaf: jnp.zeros(leaf.shape, leaf.dtype), f_info_struct)

    def query(self, y: Unknowns, f_info: Any, state: Any) -> Any:
        return f_info

    def step(self, step_size: Any, state: Any) -> tuple[Unknowns, Any]:
        newton = state.hessian.solve(state.grad, 1 / step_size)
        return clipped(jax.tree.map(jnp.negative, newton), self.longest), optx.RESULTS.successful


# The damping relaxes whenever three quarters of the promised decrease come true: optimistix's own cutoff of 99 % needs twice
# the iterations on decays.
SEARCH: optx.AbstractSearch = optx.ClassicalTrustRegion(high_cutoff=0.75, low_cutoff=0.01, high_constant=2.5, low_constant=0.25)
DESCENT = EliminatedDescent()


class _Point(NamedTuple):
    """The last accepted point."""

    unknowns: Unknowns
    info: Any  # `FunctionInfo.EvalGradHessian`
    aux: PyTree


class _State(NamedTuple):
    point: _Point
    trial: Unknowns
    search: PyTree
    first: Bool[Array, ""]


class DescentState(NamedTuple):
    """State of a descent after an iteration.

    Attributes:
        unknowns: The unknowns.
        aux: What the objective returned beside its equations.
        settled: Whether the descent ended here, before the limit of iterations.
    """

    unknowns: Unknowns
    aux: PyTree
    settled: bool


@exported_jit
def _evaluate(objective: Objective, unknowns: Unknowns, args: PyTree) -> tuple[Any, PyTree]:
    """Evaluate the objective. `_begin` and `_step` share this function, so that JAX traces it once."""
    return objective(unknowns, args)


@exported_jit
def _begin(objective: Objective, unknowns: Unknowns, args: PyTree, trust: Array) -> _State:
    shapes = eqx.filter_eval_shape(_evaluate, objective, unknowns, args)
    info, aux = jax.tree.map(lambda leaf: jnp.zeros(leaf.shape, leaf.dtype), shapes)
    search = eqx.tree_at(lambda s: s.step_size, SEARCH.init(unknowns, info), trust)
    return _State(_Point(unknowns, info, aux), unknowns, search, jnp.array(True))


@exported_jit
def _step(objective: Objective, args: PyTree, state: _State) -> tuple[_State, Bool[Array, ""]]:
    point, trial, search, first = state
    candidate = _Point(trial, *_evaluate(objective, trial, args))
    size, accepted, _, search = SEARCH.step(first, point.unknowns, trial, point.info, candidate.info, search)
    point = jax.tree.map(lambda new, old: jnp.where(accepted, new, old), candidate, point)
    step, _ = DESCENT.step(size, DESCENT.query(point.unknowns, point.info, None))
    return _State(point, jax.tree.map(jnp.add, point.unknowns, step), search, jnp.array(False)), accepted


def descend(
    objective: Objective, unknowns: Unknowns, args: PyTree, tolerance: float, trust: float = DEFAULT_TRUST
) -> Iterator[DescentState]:
    """Levenberg-Marquardt iterations on an objective.

    The descent ends in one of these cases:

    - An accepted step gains less than `tolerance` of the sum of squares.
    - `MAX_REFUSED_STEPS` steps in a row are refused.
    - `MAX_ITERATIONS` iterations are done.

    One compilation serves all calls with arguments of the same shapes.

    Args:
        objective: Cost, gradient and Gauss-Newton matrix at unknowns, such as `normal_equations`.
        unknowns: Where it begins.
        args: Second argument of the objective.
        tolerance: Smallest relative gain that is worth a further iteration.
        trust: Inverse of the damping at first.

    Yields:
        The state after every iteration.
    """
    state = _begin(objective, unknowns, args, jnp.asarray(trust))
    last, refused = math.inf, 0
    for _ in range(MAX_ITERATIONS):
        stop_if_asked()
        state, accepted = _step(objective, args, state)
        cost, taken = float(state.point.info.f), bool(accepted)
        refused = 0 if taken else refused + 1
        settled = (taken and last - cost < tolerance * cost) or refused >= MAX_REFUSED_STEPS
        last = cost
        yield DescentState(state.point.unknowns, state.point.aux, settled and math.isfinite(cost))
        if settled:
            return
