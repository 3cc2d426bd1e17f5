"""Residuals of decays: model less measured, with Jacobian products.

A record's residual is model less measured at the recorded times, channel by channel. Its unknowns are the model's parameters,
shared by all records, and its own: initial position, initial rate and sensor offset of every measured channel. Least squares
only needs the products J^T J, J^T r and r^T r, so a record of thousands of samples becomes one small matrix per channel,
and the optimiser sees its square root: as many rows as there are unknowns and one.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, Protocol

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from calibration.campaign.records import Record
from calibration.parameters.space import ParameterSpace
from calibration.residuals.ladder import padded_size
from jaxhydro.dynamics.integrate import integrate
from jaxhydro.dynamics.model import Model, State
from jaxhydro.dynamics.observe import observe
from jaxhydro.dynamics.statics import characteristic_length, equilibrium
from jaxhydro.environment import DOFS
from jaxhydro.waves.sea import StillWater


class DecayData(eqx.Module):
    """Decay records in arrays of one shape: record first, then channel or sample. SI units."""

    time: Float[Array, "r t"]  # s; beyond the last sample the last one again
    measured: Float[Array, "r c t"]
    present: Float[Array, "r c t"]  # 1 where there is a sample, 0 where not
    step: Float[Array, " r"]
    count: Int[Array, " r"]  # steps
    unit: Float[Array, "r c"]  # m, rad: what a coordinate of 1 stands for in position and offset
    pace: Float[Array, " r"]  # rad/s: ... times this in rate
    capacity: int = eqx.field(static=True)
    dofs: tuple[int, ...] = eqx.field(static=True)


class Unknowns(NamedTuple):
    """Coordinates of all unknowns of a fit.

    Attributes:
        shared: (p,) coordinates of the parameters.
        own: (r, 3c) position, rate and offset by record and channel.
    """

    shared: Float[Array, " p"]
    own: Float[Array, "r 3*c"]


def gather_decays(records: Sequence[Record], model: Model, step: float, exact: bool = False) -> DecayData:
    """Records as arrays, of sizes that records of nearly the same length share. `step` (s) is the largest time step.

    `exact`: as many samples as the longest record has, for Fourier lines that are this record's.
    """
    channels = [dof for dof in DOFS if any(dof in record.values for record in records)]
    longest = max(len(record.time) for record in records)
    longest = longest if exact else padded_size(longest)
    shape = (len(records), len(channels), longest)
    measured, present, time = np.zeros(shape), np.zeros(shape), np.zeros((shape[0], longest))
    count, size, unit, pace = [], [], np.ones(shape[:2]), []
    length = characteristic_length(model)
    for i, record in enumerate(records):
        n = len(record.time)
        time[i] = np.pad(record.time, (0, longest - n), mode="edge")
        for j, channel in enumerate(channels):
            if channel in record.values:
                measured[i, j, :n], present[i, j, :n] = record.values[channel], 1.0
        duration = record.time[-1] - record.time[0]
        count.append(int(np.ceil(duration / step)))
        size.append(duration / count[-1])
        main = record.degree_of_freedom or channels[0]
        spread = float(np.std(record.values[main]))
        metres = spread * length if DOFS.index(main) > 2 else spread
        unit[i] = [metres / length if DOFS.index(channel) > 2 else metres for channel in channels]
        pace.append(2 * np.pi / max(dominant_period(record), 4 * step))
    capacity = padded_size(max(count))
    arrays = (time, measured, present, size, count, unit, pace)
    names = ("time", "measured", "present", "step", "count", "unit", "pace")
    fields: dict[str, Any] = dict(zip(names, map(jnp.asarray, arrays), strict=True))
    return DecayData(**fields, capacity=capacity, dofs=tuple(DOFS.index(channel) for channel in channels))


def dominant_period(record: Record) -> float:
    """Period (s) of a decay's own oscillation, from the crossings of its mean level."""
    motion = record.values[record.degree_of_freedom or next(iter(record.values))]
    tail = motion[len(motion) // 2 :]
    level = motion - tail.mean()
    quiet = 0.05 * np.abs(level).max()
    sign = np.sign(np.where(np.abs(level) > quiet, level, 0.0))
    clear = np.flatnonzero(sign)
    flips = clear[1:][np.diff(sign[clear]) != 0]
    if len(flips) < 2:
        return float(record.time[-1] - record.time[0])
    return float(2 * np.diff(record.time[flips]).mean())


def first_guess(records: Sequence[Record], data: DecayData) -> Float[Array, "r 3*c"]:
    """Position and rate at every record's start, from a quadratic through its first eighth of a period; no offset."""
    own = np.zeros((len(records), 3, len(data.dofs)))
    for i, record in enumerate(records):
        early = record.time - record.time[0] <= 0.125 * 2 * np.pi / float(data.pace[i])
        early[: min(8, len(early))] = True
        t = record.time[early] - record.time[0]
        for j, dof in enumerate(data.dofs):
            values = record.values.get(DOFS[dof])
            if values is None:
                continue
            _, rate, position = np.polyfit(t, values[early], 2)
            own[i, 0, j] = position / float(data.unit[i, j])
            own[i, 1, j] = rate / float(data.unit[i, j] * data.pace[i])
    return jnp.asarray(own.reshape(len(records), -1))


def shortened(record: DecayData, until: Float[Array, ""]) -> DecayData:
    """One record of `DecayData` that is simulated no further than `until` (s)."""
    needed = jnp.ceil((until - record.time[0]) / record.step - 1e-9).astype(int)
    return eqx.tree_at(lambda d: d.count, record, jnp.minimum(record.count, jnp.maximum(needed, 1)))


class DecayProblem(eqx.Module):
    """Decay records against a model with free parameters.

    Attributes:
        model: The model at the start of the fit.
        data: The records.
        space: The free parameters.
        from_rest: Whether measured motion counts from the static equilibrium; else from the reference position.
        rest: (6,) static equilibrium (m, rad); None where free parameters move it.
        tail: (r, c) residual beyond which `cauchy_residual` is used (m, rad); None: squares everywhere.
    """

    model: Model
    data: DecayData
    space: ParameterSpace = eqx.field(static=True)
    from_rest: bool = eqx.field(static=True)
    rest: Float[Array, "6"] | None  # None where free parameters move the equilibrium
    tail: Float[Array, "r c"] | None = None

    def motion(self, x: Float[Array, " p"], own: Float[Array, " o"], record: DecayData) -> Float[Array, "c t"]:
        """What the sensors of one record should have read: the model's motion, and the sensors' offset."""
        model = self.space.model(self.model, x)
        rest = equilibrium(model) if self.rest is None else self.rest
        position, rate, offset = own.reshape(3, -1) * record.unit
        dofs = jnp.array(record.dofs)
        base = rest if self.from_rest else jnp.zeros(6)
        # what is not measured starts at rest
        q = rest.at[dofs].set(base[dofs] + position)
        rates = jnp.zeros(6).at[dofs].set(rate * record.pace)
        state = State(q, model.body_velocity(q, rates), model.rest().memory)
        grid = integrate(model, StillWater(), state, record.time[0], record.step, record.capacity, count=record.count)
        if not model.senses:  # three motions cost less than six
            return (grid.at(record.time, record.dofs)[0] - base[dofs] + offset).T
        return (observe(model, grid, record.time, base, in_waves=False)[:, dofs] + offset).T

    def products(self, unknowns: Unknowns, until: Float[Array, " r"]) -> Float[Array, "r c k k"]:
        """For every record and channel [J r]^T [J r] over the samples up to `until` (s), k the unknowns and one."""

        def of_record(inputs):
            own, record, until, tail = inputs
            both = jnp.concatenate([unknowns.shared, own])
            split = len(unknowns.shared)

            record = shortened(record, until)

            def residual(z):
                r = (self.motion(z[:split], z[split:], record) - record.measured) * (record.time <= until)
                r = cauchy_residual(r * record.present, None if tail is None else tail[:, None])
                return r, r

            slope, r = jax.jacfwd(residual, has_aux=True)(both)
            full = jnp.concatenate([slope, r[..., None]], axis=-1)
            return jnp.einsum("ctk,ctl->ckl", full, full)

        return jax.lax.map(of_record, (unknowns.own, self.data, until, self.tail))


def cauchy_residual(r: Float[Array, "..."], tail: Float[Array, "..."] | None) -> Float[Array, "..."]:
    """The residual whose square is Cauchy's loss c^2 ln(1 + (r/c)^2), c the `tail`; r itself without one.

    Holland and Welsch 1977, Communications in Statistics A6, 813-827, table 1.
    """
    if tail is None:
        return r
    square = (r / tail) ** 2
    small = square < 1e-6  # the series there: log1p(u) / u is 0 / 0 at rest
    safe = jnp.where(small, 1.0, square)
    return r * jnp.where(small, 1 - 0.25 * square, jnp.sqrt(jnp.log1p(safe) / safe))


def square_root(products: Float[Array, "... k k"]) -> Float[Array, "... k k"]:
    """The symmetric square root of a positive semi-definite matrix: unique, and continuous where a Cholesky factor is not."""
    values, vectors = jnp.linalg.eigh(products)
    return (vectors * jnp.sqrt(jnp.maximum(values, 0.0))[..., None, :]) @ jnp.swapaxes(vectors, -1, -2)


@jax.custom_jvp
def condensed_decays(
    unknowns: Unknowns, problem: DecayProblem, weight: Float[Array, "r c"], until: Float[Array, " r"]
) -> tuple[Float[Array, "r k"], Float[Array, "r c k k"]]:
    """A residual vector with the norm, the gradient and the Gauss-Newton matrix of the weighted residuals of all records.

    `weight` multiplies the squares. It is the last column of the square root of sum_c w_c [J r]^T [J r], record by record,
    and its Jacobian the other columns. Also returns the [J r]^T [J r], which are not differentiated.
    """
    roots, products = _roots(unknowns, problem, weight, until)
    return roots[..., -1], products


@eqx.filter_jit  # traced once, not by the value and by the derivative of every program that has them
def _roots(unknowns, problem, weight, until):
    products = problem.products(unknowns, until)
    return square_root(jnp.einsum("rckl,rc->rkl", products, weight)), products


@condensed_decays.defjvp
def _condensed_jvp(primals, tangents):
    roots, products = _roots(*primals)
    d_shared, d_own = tangents[0]
    p = d_shared.shape[0]
    d = roots[..., :p] @ d_shared + jnp.einsum("rkl,rl->rk", roots[..., p:-1], d_own)
    return (roots[..., -1], products), (d, jnp.zeros_like(products))


def group_products(
    residuals: Callable[[Float[Array, " p"]], tuple[Float[Array, " _"], ...]],
    x: Float[Array, " p"],
    tails: Float[Array, " g"] | None,
) -> Float[Array, "g k k"]:
    """[J r]^T [J r] of every group of residuals, k the parameters and one; `cauchy_residual` beyond the `tails`."""

    def both(x):
        groups = residuals(x)
        each = [None] * len(groups) if tails is None else tails
        found = tuple(cauchy_residual(r, tail) for r, tail in zip(groups, each, strict=True))
        return found, found

    slopes, found = jax.jacfwd(both, has_aux=True)(x)
    full = [jnp.concatenate([slope, r[:, None]], axis=1) for slope, r in zip(slopes, found, strict=True)]
    return jnp.stack([one.T @ one for one in full])


class ResidualGroups(Protocol):
    """Residuals of the parameters alone, in groups."""

    def products(self, x: Float[Array, " p"]) -> Float[Array, "g k k"]:
        """[J r]^T [J r] of every group, k the parameters and one."""
        ...


@jax.custom_jvp
def condensed_groups(
    x: Float[Array, " p"], source: ResidualGroups, weight: Float[Array, " g"]
) -> tuple[Float[Array, " k"], Float[Array, "g k k"]]:
    """`condensed_decays` of residuals that have no unknowns of their own; `weight` multiplies the squares of a group."""
    products = source.products(x)
    return square_root(jnp.einsum("gkl,g->kl", products, weight))[:, -1], products


@condensed_groups.defjvp
def _condensed_groups_jvp(primals, tangents):
    x, source, weight = primals
    products = source.products(x)
    root = square_root(jnp.einsum("gkl,g->kl", products, weight))
    return (root[:, -1], products), (root[:, :-1] @ tangents[0], jnp.zeros_like(products))
