"""Fixed-step time integration with output at any times."""

from collections.abc import Callable
from functools import partial
from typing import Any, Literal, TypeAlias, get_args

import equinox as eqx
import jax
import jax.numpy as jnp
from jax.flatten_util import ravel_pytree
from jaxtyping import Array, Float, Int

from jaxhydro.choices import check
from jaxhydro.dynamics.model import Model, State
from jaxhydro.integrators import adams_bashforth, mixed_precision, runge_kutta
from jaxhydro.integrators.adams_bashforth_coefficients import START_STEPS
from jaxhydro.integrators.mixed_precision import Precision
from jaxhydro.waves.integration_clock import Clock
from jaxhydro.waves.sea import AbstractSea

Method = Literal["tsit5", "rk4", "ab4", "diffrax"]
RUNGE_KUTTA: dict[str, Callable[[], runge_kutta.Scheme]] = {"rk4": lambda: runge_kutta.RK4, "tsit5": runge_kutta.tsit5}
Adjoint = Literal["forward", "reverse"]
Kernel = Literal["off", "gpu", "interpreted"]
EXTRA_STEPS = 2  # steps, so that differences at the last one are central
MOTION_SIZE = 12  # entries of the state before the loads' memories: position and velocity
Motion: TypeAlias = tuple[Float[Array, "n 6"], Float[Array, "n 6"]]


class Grid(eqx.Module):
    """Motion at the ends of all steps: positions, rates and accelerations."""

    start: Float[Array, ""]
    step: Float[Array, ""]
    count: Int[Array, ""]
    position: Float[Array, "n 6"]
    rate: Float[Array, "n 6"]
    acceleration: Float[Array, "n 6"]

    def at(
        self, times: Float[Array, " t"], dofs: slice | tuple[int, ...] = slice(None)
    ) -> tuple[Float[Array, "t d"], Float[Array, "t d"], Float[Array, "t d"]]:
        """Position, rate and acceleration at any times, by quintic Hermite interpolation.

        The error in position is of sixth order in the step. Times outside the grid are clipped to it.

        Args:
            times: Times (s), (t,).
            dofs: Degrees of freedom that are returned.
        """
        steps = (times - self.start) / self.step
        index = jnp.clip(jnp.floor(steps).astype(int), 0, self.count - 1)
        s = (steps - index)[:, None]
        s = jnp.where(s < 0, 0.0, jnp.where(s > 1, 1.0, s))  # jnp.clip has half the slope where a time is a step's
        h = self.step
        position, rate, acceleration = (x[:, dofs] for x in (self.position, self.rate, self.acceleration))
        x0, x1 = position[index], position[index + 1]
        v0, v1 = h * rate[index], h * rate[index + 1]
        a0, a1 = 0.5 * h * h * acceleration[index], 0.5 * h * h * acceleration[index + 1]
        # x = x0 + v0 s + a0 s^2 + s^3 (c3 + c4 s + c5 s^2), fixed by the far end
        gap, slope, bend = x1 - x0 - v0 - a0, v1 - v0 - 2 * a0, 2 * (a1 - a0)
        c3 = 10 * gap - 4 * slope + 0.5 * bend
        c4 = -15 * gap + 7 * slope - bend
        c5 = 6 * gap - 3 * slope + 0.5 * bend
        x = x0 + s * (v0 + s * (a0 + s * (c3 + s * (c4 + s * c5))))
        v = (v0 + s * (2 * a0 + s * (3 * c3 + s * (4 * c4 + s * 5 * c5)))) / h
        a = (2 * a0 + s * (6 * c3 + s * (12 * c4 + s * 20 * c5))) / h**2
        return x, v, a


def rate_of(unravel: Callable[[Array], State], precision: Precision = "double") -> runge_kutta.Rate:
    """The equation of motion of states in one array."""

    @eqx.filter_jit  # traced once, not by every stage and derivative
    def rate(driver: tuple[Model, AbstractSea], time: Float[Array, ""], y: Float[Array, " s"]) -> tuple[Array, ...]:
        return tuple(leaf.reshape(-1) for leaf in jax.tree.leaves(driver[0].rate(time, unravel(y), driver[1])))

    return rate if precision == "double" else mixed_precision.in_float32(rate)


def _by_loop(
    method: Method, model: Model, sea: AbstractSea, state: State, start, step, count, capacity, adjoint, precision
) -> Motion:
    """A scheme as one of this package's own loops: positions and body velocities at the ends of the steps."""
    y, unravel = ravel_pytree(state)
    loop = adams_bashforth if method == "ab4" else runge_kutta
    options: dict[str, Any] = {} if method == "ab4" else {"scheme": RUNGE_KUTTA[method]()}
    run: Any = loop.forward if adjoint == "forward" else loop.backward
    if adjoint == "forward":
        options["shown"] = MOTION_SIZE
    path = run((model, sea), y, start, step, count, rate=rate_of(unravel, precision), capacity=capacity, **options)
    return path[:, :6], path[:, 6:MOTION_SIZE]


def _by_kernel(
    kernel: Kernel, model: Model, sea: AbstractSea, state: State, start, step, count, capacity, adjoint, precision
) -> Motion:
    """Adams-Bashforth in one GPU kernel, to the end of the array."""
    from jaxhydro.integrators import kernel_loop  # imports Pallas, which takes a while

    y, unravel = ravel_pytree(state)
    options: dict[str, Any] = {"capacity": capacity, "shown": MOTION_SIZE, "interpret": kernel == "interpreted"}
    path = kernel_loop.march((model, sea), y, start, step, rate=rate_of(unravel, precision), **options)
    return path[:, :6], path[:, 6:MOTION_SIZE]


def _by_diffrax(model: Model, sea: AbstractSea, state: State, start, step, count, capacity, adjoint, precision) -> Motion:
    """diffrax's Tsitouras 5(4) on the same grid.

    `StepTo`, not `ConstantStepSize`, whose reverse gradients are wrong with output on the step grid (diffrax 0.7.2).
    """
    import diffrax

    grid = start + step * jnp.arange(capacity + 1.0)
    solution = diffrax.diffeqsolve(
        diffrax.ODETerm(lambda t, y, args: args[0].rate(t, y, args[1])),
        diffrax.Tsit5(),
        t0=grid[0],
        t1=grid[-1],
        dt0=None,
        y0=state,
        args=(model, sea),
        stepsize_controller=diffrax.StepTo(ts=grid),
        saveat=diffrax.SaveAt(ts=grid),
        adjoint=diffrax.ForwardMode() if adjoint == "forward" else diffrax.RecursiveCheckpointAdjoint(),
        max_steps=capacity + 1,
    )
    return solution.ys.position, solution.ys.velocity


def integrate(
    model: Model,
    sea: AbstractSea,
    state: State,
    start: Float[Array, ""],
    step: Float[Array, ""],
    capacity: int,
    method: Method = "tsit5",
    adjoint: Adjoint = "forward",
    count: Int[Array, ""] | None = None,
    kernel: Kernel = "off",
    precision: Precision = "double",
) -> Grid:
    """Integrate the motion over `capacity` steps of `step` (s).

    Simulations of different lengths share one compilation by sharing a capacity: `count` says how many of its steps are
    taken. That holds with `adjoint` "forward" only, and not for "diffrax", which takes all steps.

    With `kernel` "gpu" the time loop is one kernel (`kernel_loop`), without derivatives; with "interpreted" the same on any
    device, slowly, for tests. Both are for "ab4" only, and take all steps. With `precision` "mixed" the loads and
    the motion that they read are in float32 (`mixed_precision`), but not by "diffrax".

    Raises:
        UnknownName: Another method, adjoint, kernel or precision.
        ValueError: A kernel with another method than "ab4", or with `adjoint` "reverse"; "mixed" with "diffrax".
        KernelError: A load does what a kernel cannot do.
    """
    check(method=(method, get_args(Method)), adjoint=(adjoint, get_args(Adjoint)), kernel=(kernel, get_args(Kernel)))
    check(precision=(precision, get_args(Precision)))
    if kernel != "off" and (method, adjoint) != ("ab4", "forward"):
        raise ValueError(f"the kernel is for method 'ab4' with adjoint 'forward', found {method!r} with {adjoint!r}")
    if precision == "mixed" and method == "diffrax":
        raise ValueError("precision 'mixed' is for the loops of this package, not for method 'diffrax'")
    count = jnp.asarray(capacity) if count is None else count
    run = _by_diffrax if method == "diffrax" else partial(_by_loop, method)
    run = run if kernel == "off" else partial(_by_kernel, kernel)
    position, velocity = run(model, sea, state, start, step, count + EXTRA_STEPS, capacity + EXTRA_STEPS, adjoint, precision)
    return grid_of(model, position, velocity, start, step, count)


def grid_of(model: Model, position: Array, velocity: Array, start: Array, step: Array, count: Array) -> Grid:
    """Motion at the ends of all steps, from positions and body velocities there (n, 6)."""
    rate = jax.vmap(model.position_rate)(position, velocity)
    return Grid(start, step, count, position, rate, differences(rate, step))


@eqx.filter_jit
def states(model: Model, sea: AbstractSea, state: State, start: Float[Array, ""], step: Float[Array, ""], count: int) -> State:
    """States, memories included, after 0, 1 ... `count` steps of four-step Adams-Bashforth, stacked."""
    y, unravel = ravel_pytree(state)
    path = adams_bashforth.forward(
        (model, sea), y, start, step, jnp.asarray(count), rate=rate_of(unravel), capacity=count, shown=y.shape[0]
    )
    return jax.vmap(unravel)(path)


def clock(method: Method, start: float, step: float, count: int) -> Clock:
    """Times at which an integration over `count` steps asks for the sea.

    Args:
        method: Integration scheme.
        start: First time (s).
        step: Time step (s).
        count: Number of steps.
    """
    check(method=(method, get_args(Method)))
    if method == "ab4":
        return Clock(start, step, count + EXTRA_STEPS, (0.0,), START_STEPS)
    if method == "diffrax":
        import diffrax

        nodes = (0.0, *map(float, diffrax.Tsit5.tableau.c))
    else:
        nodes = RUNGE_KUTTA[method]().nodes
    return Clock(start, step, count + EXTRA_STEPS + 1, tuple(sorted({node for node in nodes if node < 1.0})))


def differences(values: Float[Array, "n 6"], step: Float[Array, ""]) -> Float[Array, "n 6"]:
    """Time derivative on an even grid by five-point differences, of fourth order up to the ends.

    With fewer points it is `gradient`.

    References:
        Abramowitz and Stegun (1964), table 25.2, m = 5.
    """
    if values.shape[0] < 5:
        return jnp.asarray(jnp.gradient(values, axis=0)) / step
    inside = (values[:-4] - 8 * values[1:-3] + 8 * values[3:-1] - values[4:]) / 12
    first = jnp.array([[-25.0, 48.0, -36.0, 16.0, -3.0], [-3.0, -10.0, 18.0, -6.0, 1.0]]) / 12
    begin, end = first @ values[:5], -(first @ values[-1:-6:-1])[::-1]
    return jnp.concatenate([begin, inside, end]) / step
