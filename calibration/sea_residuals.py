"""Tests in measured waves against the model, as residuals with their Jacobian: energies in bands, or motions.

The windows of a file are one continuous run that starts at rest with it, in the sea of its own wave record, so its motions have
no unknowns of their own: what is fitted is the model's parameters.
"""

import math
from typing import Literal

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from calibration.parameters import ParameterSpace
from calibration.records import Record
from calibration.residuals import square_root
from calibration.runs import Run
from calibration.seas import Options, moving_channels, peak_period, sea_of, window
from calibration.seas_results import bands_of
from jaxhydro.analysis import band_weights
from jaxhydro.environment import DOFS
from jaxhydro.integrate import integrate
from jaxhydro.model import Model, State
from jaxhydro.simulate import farthest, in_irregular
from jaxhydro.statics import equilibrium
from jaxhydro.waves.irregular_sea import SupportSea

Objective = Literal["bands", "motion", "both"]
MARGIN = 30.0  # m that a motion may go beyond that of the declared model before its sea has to be prepared anew


class Energy(eqx.Module):
    """The integral of a spectrum over one band: `analysis.BandWeights`, and what was measured (m2, rad2)."""

    starts: Int[Array, " g"]
    window: Float[Array, " s"]
    weight: Float[Array, " f"]
    measured: Float[Array, ""]
    first: int = eqx.field(static=True)

    def of(self, x: Float[Array, " n"]) -> Float[Array, ""]:
        """The integral (m2, rad2) of a motion's spectrum."""
        parts = x[self.starts[:, None] + jnp.arange(self.window.shape[0])]
        lines = jnp.fft.rfft((parts - parts.mean(axis=1, keepdims=True)) * self.window)
        inside = lines[:, self.first : self.first + self.weight.shape[0]]
        return ((inside.real**2 + inside.imag**2) @ self.weight).mean()


class Piece(eqx.Module):
    """One motion of one test: its samples on the run's clock from `begin` on, and its energies in bands."""

    measured: Float[Array, " n"]
    energies: tuple[Energy, ...]
    begin: int = eqx.field(static=True)
    dof: int = eqx.field(static=True)
    test: str = eqx.field(static=True)
    names: tuple[str, ...] = eqx.field(static=True)  # of the bands


class SeaRun(eqx.Module):
    """One file: its sea on the clock of the time integration, and what was measured at `times` (s)."""

    sea: SupportSea
    times: Float[Array, " t"]
    step: Float[Array, ""]
    pieces: tuple[Piece, ...]
    steps: int = eqx.field(static=True)


class SeaProblem(eqx.Module):
    """A calibration's fixed part in waves. `from_rest`: motions count from the static equilibrium."""

    model: Model
    runs: tuple[SeaRun, ...]
    rest: Float[Array, "6"] | None  # None where free parameters move the equilibrium
    points: Float[Array, "3 p"]  # m, the hull's extremities
    space: ParameterSpace = eqx.field(static=True)
    from_rest: bool = eqx.field(static=True)
    objective: Objective = eqx.field(static=True)

    def motions(self, x: Float[Array, " p"]) -> tuple[tuple[Float[Array, "t 6"], ...], Float[Array, "6"]]:
        """Position in every run at its times, and the position that was measured as zero (m, rad)."""
        model = self.space.model(self.model, x)
        rest = equilibrium(model) if self.rest is None else self.rest
        state = State(rest, jnp.zeros(6), model.rest().memory)
        positions = tuple(
            integrate(model, run.sea, state, run.times[0], run.step, run.steps, "ab4").at(run.times)[0] for run in self.runs
        )
        return positions, rest if self.from_rest else jnp.zeros(6)

    def inside(self, x: Float[Array, " p"]) -> Bool[Array, ""]:
        """Whether the hull stays in the box that every sea was prepared for, outside which its flow is wrong."""
        positions, _ = self.motions(x)
        far = [farthest(one, self.points, run.sea) - run.sea.half for one, run in zip(positions, self.runs, strict=True)]
        return (jnp.stack(far) <= 0).all()

    @property
    def observations(self) -> int:
        """How many there are: one for every band, and one for every motion, whose residual's square is relative to its own."""
        pieces = [piece for run in self.runs for piece in run.pieces]
        return sum(self.in_bands) * sum(len(piece.energies) for piece in pieces) + self.in_bands.count(False)

    @property
    def in_bands(self) -> tuple[bool, ...]:
        """Of every group of residuals, whether it is of energies in bands."""
        pieces = [piece for run in self.runs for piece in run.pieces]
        motions = [piece for piece in pieces if self.objective != "bands" or not piece.energies]
        energies = self.objective != "motion" and any(piece.energies for piece in pieces)
        return (*([True] if energies else []), *[False] * len(motions))

    def residuals(self, x: Float[Array, " p"]) -> tuple[Float[Array, " _"], ...]:
        """In one group ln(simulated / measured energy) by test, motion and band; in others, motion by motion, simulated less
        measured over the measured standard deviation and the root of the number of samples, each about its mean."""
        energies, motions = [], []
        positions, base = self.motions(x)
        for run, position in zip(self.runs, positions, strict=True):
            for piece in run.pieces:
                there = position[piece.begin : piece.begin + piece.measured.shape[0], piece.dof] - base[piece.dof]
                if self.objective != "motion":  # regular waves have none
                    energies += [jnp.log(one.of(there) / one.measured) for one in piece.energies]
                if self.objective != "bands" or not piece.energies:
                    off = there - there.mean() - (piece.measured - piece.measured.mean())
                    motions.append(off / (jnp.std(piece.measured) * math.sqrt(off.size)))
        return (*([jnp.stack(energies)] if energies else []), *motions)

    def products(self, x: Float[Array, " p"]) -> Float[Array, "g k k"]:
        """[J r]^T [J r] of every group, k the parameters and one."""

        def both(x):
            found = self.residuals(x)
            return found, found

        slopes, residuals = jax.jacfwd(both, has_aux=True)(x)
        full = [jnp.concatenate([slope, r[:, None]], axis=1) for slope, r in zip(slopes, residuals, strict=True)]
        return jnp.stack([one.T @ one for one in full])


@jax.custom_jvp
def condensed_in_waves(x: Float[Array, " p"], problem: SeaProblem) -> tuple[Float[Array, " k"], Float[Array, "g k k"]]:
    """`residuals.condensed` of tests in waves: a residual with the norm, gradient and Gauss-Newton matrix of all."""
    products = problem.products(x)
    return square_root(products.sum(axis=0))[:, -1], products


@condensed_in_waves.defjvp
def _condensed_jvp(primals, tangents):
    products = primals[1].products(primals[0])
    root = square_root(products.sum(axis=0))
    return (root[:, -1], products), (root[:, :-1] @ tangents[0], jnp.zeros_like(products))


def pose_in_waves(
    model: Model,
    found: tuple[Run, ...],
    space: ParameterSpace,
    options: Options,
    *,
    from_rest: bool,
    scale: float,
    step: float,
    objective: Objective = "bands",
) -> SeaProblem:
    """The fixed part of a calibration of `model` to the tests marked `fit` of runs; `step` (s) is the largest time step."""
    rest = equilibrium(model)
    made = []
    for run in found:
        fitted = [record for record in run.records if record.use == "fit"]
        if not fitted:
            continue
        sea = sea_of(run, model.environment, options)
        last = max(int(run.samples(record)[-1]) for record in fitted)
        times = jnp.asarray(run.time[: last + 1])
        state = State(rest, jnp.zeros(6), model.rest().memory)
        taken = in_irregular(model, sea.sea, state, times, step, margin=MARGIN)
        pieces = tuple(piece for record in fitted for piece in _pieces(run, record, scale))
        made.append(SeaRun(taken.sea, times, jnp.asarray(taken.step), pieces, taken.steps))
    points = jnp.asarray(model.hull.extremities())
    return SeaProblem(model, tuple(made), None if space.moves_equilibrium else rest, points, space, from_rest, objective)


def _pieces(run: Run, record: Record, scale: float) -> list[Piece]:
    """The motions of a test that are worth fitting, after its transient, on the run's even clock."""
    at, whole = run.samples(record), window(run, record)
    values = {dof: np.interp(whole, at, record.values[dof]) for dof in DOFS if dof in record.values}
    period = peak_period(run, record, scale)
    pieces = []
    for dof in moving_channels(values):
        limits = bands_of(dof, period) if record.kind == "irregular" else {}
        energies = []
        for low, high in limits.values():
            made = band_weights(len(whole), run.step, low, high)
            starts, taper, weight = (jnp.asarray(x) for x in (made.starts, made.window, made.weight))
            energies.append(Energy(starts, taper, weight, jnp.asarray(made.integral(values[dof])), made.first))
        measured, begin = jnp.asarray(values[dof]), int(whole[0])
        pieces.append(Piece(measured, tuple(energies), begin, DOFS.index(dof), record.id, tuple(limits)))
    return pieces
