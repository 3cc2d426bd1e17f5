"""Simulation of a run test by test, with the coefficients of each test's sea state."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np

from calibration.campaign.records import Record
from calibration.campaign.runs import Run
from jaxhydro.analysis.spectral import power_spectrum
from jaxhydro.dynamics.irregular_simulation import IrregularSimulation, simulate_irregular
from jaxhydro.dynamics.model import Model, State
from jaxhydro.dynamics.statics import equilibrium
from jaxhydro.waves.irregular_sea import IrregularSea
from jaxhydro.waves.sea_state import SeaState, peak_period


class RunSegment(NamedTuple):
    """Part of a run's clock with one sea state.

    Attributes:
        records: Tests in the segment.
        begin: First sample of the run's clock, included.
        end: Last sample, included.
        state: Sea state; None where the model does not depend on it.
    """

    records: tuple[Record, ...]
    begin: int
    end: int
    state: SeaState | None


class SimulatedSegment(NamedTuple):
    """A simulated segment of a run.

    Attributes:
        segment: The segment.
        simulation: Its motion.
        start: State in which it began; None: at rest.
    """

    segment: RunSegment
    simulation: IrregularSimulation
    start: State | None


def samples_after_transient(run: Run, record: Record) -> np.ndarray:
    """Indices into the run's clock of a test's samples after its transient."""
    indices = run.samples(record)
    whole = np.arange(indices[0], indices[-1] + 1)
    return whole[run.time[whole] >= record.time[0] + record.transient - 0.5 * run.step]


def sea_state(run: Run, record: Record, low: float, cutoff: float) -> SeaState:
    """Measured sea state of a test after its transient.

    Args:
        run: The run.
        record: Record of the test.
        low: Lowest frequency of the waves (Hz).
        cutoff: Highest frequency of the waves (Hz).

    Returns:
        Significant height (m) and peak period (s).
    """
    whole = samples_after_transient(run, record)
    spectrum = power_spectrum(run.time[whole], run.wave[whole])
    inside = (spectrum.frequency >= low) & (spectrum.frequency <= cutoff)
    frequency, density = spectrum.frequency[inside], spectrum.density[inside]
    variance = float(density.sum() * (spectrum.frequency[1] - spectrum.frequency[0]))
    return SeaState(4 * variance**0.5, peak_period(frequency, density))


def run_segments(run: Run, records: Sequence[Record], model: Model, low: float, cutoff: float) -> tuple[RunSegment, ...]:
    """Cut a run into segments of one sea state, one for each test.

    A segment reaches from its test's first sample (the first one: from the run's) to that of the next test at least. Where
    the model does not depend on the sea state, there is one segment for all.

    Args:
        run: The run.
        records: Records of the tests.
        model: The model.
        low: Lowest frequency of the waves (Hz).
        cutoff: Highest frequency of the waves (Hz).

    Returns:
        The segments, in order of time.
    """
    records = sorted(records, key=lambda record: record.time[0])
    ends = [(int(indices[0]), int(indices[-1])) for indices in map(run.samples, records)]
    if model.in_sea(SeaState(1.0, 1.0)) is model:
        return (RunSegment(tuple(records), 0, max(end for _, end in ends), None),)
    begins = [0, *(begin for begin, _ in ends[1:])]
    nexts = [*begins[1:], 0]
    return tuple(
        RunSegment((record,), begin, max(end, after), sea_state(run, record, low, cutoff))
        for record, begin, (_, end), after in zip(records, begins, ends, nexts, strict=True)
    )


def simulate_segments(
    model: Model, run: Run, parts: Sequence[RunSegment], sea: IrregularSea, step: float, margin: float = 0.0
) -> Iterator[SimulatedSegment]:
    """Simulate a run segment by segment, starting at rest.

    Each segment begins where the one before it ended; memories of loads begin anew.

    Args:
        model: The model.
        run: The run.
        parts: Segments of the run.
        sea: Sea of the whole run.
        step: Largest time step (s), as of `in_irregular`.
        margin: Margin of the prepared sea (m), as of `simulate_irregular`.

    Yields:
        The segments with their motions.
    """
    rest = State(equilibrium(model), jnp.zeros(6), model.rest().memory)
    start = None
    for i, part in enumerate(parts):
        segment_model = model if part.state is None else model.in_sea(part.state)
        times = jnp.asarray(run.time[part.begin : part.end + 1])
        simulation = simulate_irregular(segment_model, sea, rest if start is None else start, times, step, margin=margin)
        yield SimulatedSegment(part, simulation, start)
        if i + 1 < len(parts):
            after = parts[i + 1].begin - part.begin
            position, rate = simulation.response.position[after], simulation.response.rate[after]
            start = State(position, model.body_velocity(position, rate), rest.memory)
