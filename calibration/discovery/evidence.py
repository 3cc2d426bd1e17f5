"""Records against a model that may have more than was declared: products of residuals and their Jacobians, band by band.

The Jacobian is taken along a few directions of a long list of parameters. Which directions is data, so that one compiled
program scores every candidate effect and refits any few of them.
"""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from calibration.parameters import ParameterSpace
from calibration.residuals import Data, Problem
from jaxhydro.integrate import integrate
from jaxhydro.model import Model, State
from jaxhydro.statics import equilibrium
from jaxhydro.waves.irregular_sea import SupportSea


class Frame(NamedTuple):
    """Coordinates x = origin + basis z of all parameters, z the few along which one looks."""

    origin: Float[Array, " p"]
    basis: Float[Array, "p q"]


def banded(
    slopes: Float[Array, "c t k"], residual: Float[Array, "c t"], member: Float[Array, "b f"]
) -> Float[Array, "c b k+1 k+1"]:
    """[J r]^T [J r] of every motion in every band: their sums over samples, split by Parseval's theorem."""
    full = jnp.concatenate([slopes, residual[..., None]], axis=-1)
    lines = jnp.fft.rfft(full, axis=1)[:, : member.shape[1]]
    twice = jnp.full(member.shape[1], 2.0).at[0].set(1.0) / full.shape[1]
    weight = member * twice
    real = jnp.einsum("bf,cfk,cfl->cbkl", weight, lines.real, lines.real)
    return real + jnp.einsum("bf,cfk,cfl->cbkl", weight, lines.imag, lines.imag)


class Decays(eqx.Module):
    """Decay records: `problem` with the parameters' whole space, and the bands of every record."""

    problem: Problem
    member: Float[Array, "r b f"]

    def residual(
        self, frame: Frame, z: Float[Array, " q"], own: Float[Array, " o"], record: Data, until: Float[Array, ""]
    ) -> Float[Array, "c t"]:
        """Simulated less measured up to a time (s)."""
        x = frame.origin + frame.basis @ z
        return (self.problem.motion(x, own, record) - record.measured) * record.present * (record.time <= until)

    def products(self, frame: Frame, own: Float[Array, "r o"], until: Float[Array, " r"]) -> Float[Array, "r c b k k"]:
        """By record, motion and band; of the directions, the record's own unknowns and the residual."""
        q = frame.basis.shape[1]

        def of_record(inputs):
            own, record, member, until = inputs

            def residual(both):
                r = self.residual(frame, both[:q], both[q:], record, until)
                return r, r

            slope, r = jax.jacfwd(residual, has_aux=True)(jnp.concatenate([jnp.zeros(q), own]))
            return banded(slope, r, member)

        return jax.lax.map(of_record, (own, self.problem.data, self.member, until))


class SeaRecord(eqx.Module):
    """One run in waves: its sea, and the tests in it, each from sample `begins` on for `length` samples of the run's clock."""

    model: Model
    sea: SupportSea
    times: Float[Array, " t"]
    step: Float[Array, ""]
    measured: Float[Array, "w c n"]
    member: Float[Array, "w b f"]
    rest: Float[Array, "6"] | None
    space: ParameterSpace = eqx.field(static=True)
    from_rest: bool = eqx.field(static=True)
    steps: int = eqx.field(static=True)
    begins: tuple[int, ...] = eqx.field(static=True)
    dofs: tuple[int, ...] = eqx.field(static=True)
    tests: tuple[str, ...] = eqx.field(static=True)

    def motion(self, x: Float[Array, " p"]) -> tuple[Float[Array, "t 6"], Float[Array, "6"]]:
        """What sensors read, and what they read at rest in the reference position."""
        model = self.space.model(self.model, x)
        rest = equilibrium(model)
        start = State(rest, jnp.zeros(6), model.rest().memory)
        grid = integrate(model, self.sea, start, self.times[0], self.step, self.steps, "ab4")
        late = model.clock_lag()
        position = grid.at(self.times if late is None else self.times - late)[0]
        base = model.seen(rest) if self.from_rest else jnp.zeros(6)
        return model.seen(position) - base, position

    def residual(self, x: Float[Array, " p"]) -> tuple[Float[Array, "w c n"], Float[Array, "t 6"]]:
        """Simulated less measured, test by test."""
        motion, position = self.motion(x)
        n = self.measured.shape[-1]
        windows = jnp.stack([motion[begin : begin + n, list(self.dofs)].T for begin in self.begins])
        return windows - self.measured, position

    def products(self, frame: Frame) -> tuple[Float[Array, "w c b k k"], Float[Array, "t 6"]]:
        """By test, motion and band; of the directions and the residual. And the position (m, rad)."""

        def residual(z):
            r, position = self.residual(frame.origin + frame.basis @ z)
            return r, (r, position)

        q = frame.basis.shape[1]
        slope, (r, position) = jax.jacfwd(residual, has_aux=True)(jnp.zeros(q))
        parts = [banded(*one) for one in zip(slope, r, self.member)]
        return jnp.stack(parts), position


@eqx.filter_jit
def decay_products(decays: Decays, frame: Frame, own: Any, until: Any) -> Any:
    return decays.products(frame, own, until)


@eqx.filter_jit
def sea_products(record: SeaRecord, frame: Frame) -> Any:
    return record.products(frame)


@eqx.filter_jit
def sea_residual(record: SeaRecord, x: Any) -> Any:
    return record.residual(x)


@eqx.filter_jit
def decay_residuals(decays: Decays, frame: Frame, own: Any, until: Any) -> Any:
    """(r, c, t)."""

    def one(inputs):
        own, record, until = inputs
        return decays.residual(frame, jnp.zeros(frame.basis.shape[1]), own, record, until)

    return jax.lax.map(one, (own, decays.problem.data, until))
