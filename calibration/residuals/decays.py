"""Residuals of decays: model less measured, with Jacobian products.

A record's residual is model less measured at the recorded times, channel by channel. The model's parameters are unknowns that
all records share. A record's own unknowns are initial position, initial rate and sensor offset of every measured channel.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float, Int

from calibration.campaign.records import Record
from calibration.parameters.space import ParameterSpace
from calibration.residuals.abstract_residual import AbstractResidual, Unknowns, cauchy_residual
from calibration.residuals.padded_sizes import padded_size
from jaxhydro.dynamics.integrate import integrate
from jaxhydro.dynamics.model import Model, State
from jaxhydro.dynamics.observe import changes_readings, observe
from jaxhydro.dynamics.statics import characteristic_length, equilibrium
from jaxhydro.environment import DOFS
from jaxhydro.quick_jit import on_device
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
    until: Float[Array, " r"]  # s: what is later is not fitted
    capacity: int = eqx.field(static=True)
    dofs: tuple[int, ...] = eqx.field(static=True)


def gather_decays(records: Sequence[Record], model: Model, step: float, exact: bool = False) -> DecayData:
    """Records as arrays, of sizes that records of nearly the same length share.

    Args:
        records: The records.
        model: The model, for its characteristic length.
        step: Largest time step (s).
        exact: Whether arrays have as many samples as the longest record, for Fourier lines that are this record's.
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
        pace.append(2 * np.pi / max(crossing_period(record), 4 * step))
    capacity = padded_size(max(count))
    arrays: tuple[Any, ...] = (time, measured, present, size, count, unit, pace, time[:, -1])
    names = ("time", "measured", "present", "step", "count", "unit", "pace", "until")
    fields: dict[str, Any] = dict(zip(names, map(on_device, arrays), strict=True))
    return DecayData(**fields, capacity=capacity, dofs=tuple(DOFS.index(channel) for channel in channels))


def padded(data: DecayData, samples: int, steps: int) -> DecayData:
    """The same records in arrays of more samples, with room for more steps; results have rows of zeros for them."""
    more = ((0, 0), (0, samples - data.time.shape[1]))
    measured, present = (np.pad(np.asarray(part), ((0, 0), *more)) for part in (data.measured, data.present))
    time = np.pad(np.asarray(data.time), more, mode="edge")
    return replace(data, time=on_device(time), measured=on_device(measured), present=on_device(present), capacity=steps)


def crossing_period(record: Record) -> float:
    """Period (s) of a decay, from its crossings of the mean of its second half."""
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
    """First guess of each record's own unknowns: initial position and rate, and no offset.

    Position and rate are those of a quadratic through the first eighth of a period.
    """
    guess = np.zeros((len(records), 3, len(data.dofs)))
    unit, pace = np.asarray(data.unit), np.asarray(data.pace)
    for i, record in enumerate(records):
        early = record.time - record.time[0] <= 0.125 * 2 * np.pi / pace[i]
        early[: min(8, len(early))] = True
        t = record.time[early] - record.time[0]
        for j, dof in enumerate(data.dofs):
            values = record.values.get(DOFS[dof])
            if values is None:
                continue
            _, rate, position = np.polyfit(t, values[early], 2)
            guess[i, 0, j] = position / unit[i, j]
            guess[i, 1, j] = rate / (unit[i, j] * pace[i])
    return on_device(guess.reshape(len(records), -1))


def shortened(record: DecayData) -> DecayData:
    """One record of `DecayData` that is simulated no further than its `until`."""
    needed = jnp.ceil((record.until - record.time[0]) / record.step - 1e-9).astype(int)
    return eqx.tree_at(lambda d: d.count, record, jnp.minimum(record.count, jnp.maximum(needed, 1)))


class DecayProblem(AbstractResidual):
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
    space: ParameterSpace = eqx.field(static=True)
    data: DecayData
    from_rest: bool = eqx.field(static=True)
    rest: Float[Array, "6"] | None
    tail: Float[Array, "r c"] | None = None

    def up_to(self, until: Float[Array | np.ndarray, " r"]) -> "DecayProblem":
        """The same problem with samples up to `until` only, (r,) in s."""
        return eqx.tree_at(lambda problem: problem.data.until, self, jnp.asarray(until))

    def motion(self, x: Float[Array, " p"], own: Float[Array, " o"], record: DecayData) -> Float[Array, "c t"]:
        """Simulated readings of one record's sensors (m, rad): motion of the model plus sensor offsets."""
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
        if not changes_readings(model):  # three motions cost less than six
            return (grid.at(record.time, record.dofs)[0] - base[dofs] + offset).T
        return (observe(model, grid, record.time, base, in_waves=False)[:, dofs] + offset).T

    def residual(self, x: Float[Array, " p"], own: Float[Array, " o"], record: DecayData) -> Float[Array, "c t"]:
        """Simulated less measured motion of one record (m, rad), up to its `until`.

        It is zero where there is no sample.
        """
        return (self.motion(x, own, record) - record.measured) * (record.time <= record.until) * record.present

    def slopes(
        self,
        x: Float[Array, " p"],
        own: Float[Array, " o"],
        record: DecayData,
        basis: Float[Array, "p q"] | None = None,
        tail: Float[Array, " c"] | None = None,
    ) -> tuple[Float[Array, "c t"], Float[Array, "c t k"]]:
        """Residual of one record, and its slopes along directions of the parameters and of its own unknowns.

        Args:
            x: Coordinates of the parameters.
            own: Coordinates of the record's own unknowns.
            record: The record.
            basis: Directions, in columns; None for one parameter each.
            tail: Residuals beyond which `cauchy_residual` is used (m, rad).
        """
        q = len(x) if basis is None else basis.shape[1]

        def residual(z):
            r = self.residual(x + (z[:q] if basis is None else basis @ z[:q]), z[q:], record)
            r = cauchy_residual(r, None if tail is None else tail[:, None])
            return r, r

        slope, r = jax.jacfwd(residual, has_aux=True)(jnp.concatenate([jnp.zeros(q), own]))
        return r, slope

    def products(self, unknowns: Unknowns) -> Float[Array, "r c k k"]:
        """Products [J r]^T [J r] by record and channel."""

        def of_record(inputs):
            own, record, tail = inputs
            r, slope = self.slopes(unknowns.shared, own, shortened(record), tail=tail)
            full = jnp.concatenate([slope, r[..., None]], axis=-1)
            return jnp.einsum("ctk,ctl->ckl", full, full)

        return jax.lax.map(of_record, (unknowns.own, self.data, self.tail))
