"""Residuals of tests in waves: energies in bands, spectra, or motions.

The windows of a file are one continuous run, in the sea of its own wave record. The run starts at rest with the file, so its
motions have no unknowns of their own. Only the model's parameters are fitted.
"""

import math
from typing import Literal

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from calibration.campaign.records import Record
from calibration.campaign.runs import Run
from calibration.parameters.space import ParameterSpace
from calibration.residuals.abstract_residual import AbstractGroupedResidual
from calibration.residuals.band_energies import BandEnergies, energies_of, joined_bands
from calibration.residuals.measured_seas import peak_period
from calibration.residuals.moving_channels import moving_channels
from calibration.residuals.run_seas import Seas
from calibration.residuals.run_segments import run_segments, samples_after_transient, simulate_segments
from calibration.residuals.wave_options import Options
from jaxhydro.analysis.sea_statistics import bands_of
from jaxhydro.dynamics.integrate import integrate
from jaxhydro.dynamics.irregular_simulation import farthest
from jaxhydro.dynamics.model import Model, State
from jaxhydro.dynamics.observe import observe
from jaxhydro.dynamics.statics import equilibrium
from jaxhydro.environment import DOFS
from jaxhydro.exported_programs import exported_jit
from jaxhydro.waves.sea_state import SeaState
from jaxhydro.waves.support_sea import SupportSea

Objective = Literal["bands", "spectrum", "motion", "both", "blocks"]
OF_ENERGY = ("bands", "spectrum", "both")
# m, for a hull of the size of VolturnUS-S: that a motion may go beyond that of the baseline in one prepared sea
SEA_MARGIN = 30.0


class TestMotion(eqx.Module):
    """One motion of one test.

    Attributes:
        measured: Samples on the run's clock (m, rad), (n,).
        energies: Energies in bands; None where it has none.
        begin: Index of the first sample on the run's clock.
        dof: Number of the motion.
        test: Name of the test.
        weight: Weight of the squares of its residuals.
        names: Names of the bands, each as often as it has cells.
    """

    measured: Float[Array, " n"]
    energies: BandEnergies | None
    begin: int = eqx.field(static=True)
    dof: int = eqx.field(static=True)
    test: str = eqx.field(static=True)
    weight: float = eqx.field(static=True)
    names: tuple[str, ...] = eqx.field(static=True)


class SeaRun(eqx.Module):
    """One file of a test in waves, or a stretch of it.

    A stretch begins in the state in which the model of the set-up leaves the stretch before. A test's transient forgets it.

    Attributes:
        sea: Sea on the clock of the time integration.
        times: Times of the measured samples (s), (t,).
        step: Time step (s).
        pieces: Motions of the tests in it.
        start: Initial state; None: at rest.
        state: Sea state, where the model depends on it; else None.
        steps: Number of time steps.
    """

    sea: SupportSea
    times: Float[Array, " t"]
    step: Float[Array, ""]
    pieces: tuple[TestMotion, ...]
    start: State | None
    state: SeaState | None
    steps: int = eqx.field(static=True)


class SeaProblem(AbstractGroupedResidual):
    """Residuals of tests in waves. `from_rest`: motions count from the static equilibrium."""

    model: Model
    space: ParameterSpace = eqx.field(static=True)
    tail: Float[Array, " g"] | None  # of every group, where residuals cease to count by their squares
    runs: tuple[SeaRun, ...]
    rest: Float[Array, "6"] | None  # None where free parameters move the equilibrium
    points: Float[Array, "3 p"]  # m, the hull's extremities
    from_rest: bool = eqx.field(static=True)
    objective: Objective = eqx.field(static=True)

    def motions(self, x: Float[Array, " p"]) -> tuple[tuple[Float[Array, "t 6"], Float[Array, "t 6"]], ...]:
        """Position of the reference point and readings of the sensors (m, rad), run by run at its times."""
        model = self.space.model(self.model, x)
        rest = equilibrium(model) if self.rest is None else self.rest
        at_rest = State(rest, jnp.zeros(6), model.rest().memory)

        def motion(run: SeaRun) -> tuple[Float[Array, "t 6"], Float[Array, "t 6"]]:
            run_model = model if run.state is None else model.in_sea(run.state)
            start = at_rest if run.start is None else run.start
            grid = integrate(run_model, run.sea, start, run.times[0], run.step, run.steps, "ab4")
            readings = observe(model, grid, run.times, rest if self.from_rest else None, in_waves=True)
            return grid.at(run.times)[0], readings

        return tuple(map(motion, self.runs))

    @property
    def observations(self) -> int:
        """Number of observations: one for every band, and one for every motion.

        The squares of a motion's residual are relative to the motion's variance.
        """
        pieces = [piece for run in self.runs for piece in run.pieces]
        return sum(self.in_bands) * sum(len(piece.names) for piece in pieces) + self.in_bands.count(False)

    @property
    def in_bands(self) -> tuple[bool, ...]:
        """Whether each group of residuals is of energies in bands."""
        pieces = [piece for run in self.runs for piece in run.pieces]
        motions = [piece for piece in pieces if self.sample_by_sample(piece)]
        energies = self.objective in OF_ENERGY and any(piece.energies is not None for piece in pieces)
        return (*([True] if energies else []), *[False] * len(motions))

    def sample_by_sample(self, piece: TestMotion) -> bool:
        """Whether a motion itself is fitted; in regular waves, which have no bands, it always is."""
        return self.objective not in ("bands", "spectrum") or piece.energies is None

    def residuals(self, x: Float[Array, " p"]) -> tuple[Float[Array, " _"], ...]:
        """Residuals in groups: one of energies, and one for each motion.

        Energies: ln(simulated / measured) by test, motion and band or cell of a band. Motions: simulated less measured, each
        about its mean, over the measured standard deviation and the root of the number of samples.

        Args:
            x: Coordinates of the parameters, (p,).
        """
        return self.residuals_and_reach(x)[0]

    def residuals_and_reach(self, x: Float[Array, " p"]) -> tuple[tuple[Float[Array, " _"], ...], Bool[Array, ""]]:
        """`residuals`, and whether the hull stays in the box of every sea, beyond which the flow is wrong.

        Args:
            x: Coordinates of the parameters, (p,).
        """
        energies, motions = [], []
        run_motions = self.motions(x)
        far = [
            farthest(position, self.points, run.sea) - run.sea.half
            for (position, _), run in zip(run_motions, self.runs, strict=True)
        ]
        for run, (_, readings) in zip(self.runs, run_motions, strict=True):
            for piece in run.pieces:
                simulated = readings[piece.begin : piece.begin + piece.measured.shape[0], piece.dof]
                if self.objective in OF_ENERGY and piece.energies is not None:
                    off = jnp.log(piece.energies.of(simulated) / piece.energies.measured)
                    energies.append(math.sqrt(piece.weight) * off)
                if self.sample_by_sample(piece):
                    off = simulated - simulated.mean() - (piece.measured - piece.measured.mean())
                    motions.append(off * math.sqrt(piece.weight / off.size) / jnp.std(piece.measured))
        return (*([jnp.concatenate(energies)] if energies else []), *motions), (jnp.stack(far) <= 0).all()


@exported_jit
def residuals_and_reach(problem: SeaProblem, x: Float[Array, " p"]) -> tuple[tuple[Float[Array, " _"], ...], Bool[Array, ""]]:
    """`SeaProblem.residuals_and_reach`, compiled."""
    return problem.residuals_and_reach(x)


def set_up_waves(
    model: Model,
    made: Seas,
    space: ParameterSpace,
    options: Options,
    *,
    from_rest: bool,
    scale: float,
    step: float,
    objective: Objective = "bands",
) -> SeaProblem:
    """Set up the residuals of a model against the tests in waves marked `fit`.

    Args:
        model: The model.
        made: Runs and their seas.
        space: The free parameters.
        options: Options of the waves.
        from_rest: Whether motions count from the static equilibrium.
        scale: Scale of the campaign, for stated periods.
        step: Largest time step (s).
        objective: The objective.
    """
    sea_runs = []
    for run, sea in made:
        parts = run_segments(run, run.records, model, options.low, options.cutoff)
        fitted = [[record for record in part.records if record.use == "fit"] for part in parts]
        last = max((i for i, records in enumerate(fitted) if records), default=-1)
        if len(parts) == 1 and last == 0:  # no further than what is fitted
            parts = (parts[0]._replace(end=max(int(run.samples(record)[-1]) for record in fitted[0])),)
        margin = SEA_MARGIN * float(model.size)
        for (part, taken, start), records in zip(
            simulate_segments(model, run, parts[: last + 1], sea.sea, step, margin), fitted
        ):
            if records:
                pieces = tuple(piece for r in records for piece in _pieces(run, r, scale, part.begin, objective == "spectrum"))
                times = jnp.asarray(run.time[part.begin : part.end + 1])
                assert isinstance(taken.sea, SupportSea)  # `seas_of` refuses others
                # arrays, so that another state is not compiled anew
                state = None if part.state is None else jax.tree.map(jnp.asarray, part.state)
                sea_runs.append(SeaRun(taken.sea, times, jnp.asarray(taken.step), pieces, start, state, taken.steps))
    points, rest = jnp.asarray(model.hull.extremities()), None if space.moves_equilibrium else equilibrium(model)
    return SeaProblem(model, space, None, tuple(sea_runs), rest, points, from_rest, objective)


def _pieces(run: Run, record: Record, scale: float, begin: int, cut: bool) -> list[TestMotion]:
    """Large motions of a test after its transient, on the run's even clock.

    Args:
        run: The run.
        record: Record of the test.
        scale: Scale of the campaign, for stated periods.
        begin: Sample of the run's clock that samples are counted from.
        cut: Whether bands are cut into cells.
    """
    indices, whole = run.samples(record), samples_after_transient(run, record)
    values = {dof: np.interp(whole, indices, record.values[dof]) for dof in DOFS if dof in record.values}
    period = peak_period(run, record, scale)
    pieces = []
    for dof in moving_channels(values):
        limits = bands_of(dof, period) if record.kind == "irregular" else {}
        made = [(name, energies_of(values[dof], run.step, *limit, cut)) for name, limit in limits.items()]
        names = tuple(name for name, band in made for _ in band.measured)
        energies = joined_bands([band for _, band in made]) if made else None
        first, stated = int(whole[0]) - begin, record.test.weight
        pieces.append(TestMotion(jnp.asarray(values[dof]), energies, first, DOFS.index(dof), record.id, stated, names))
    return pieces
