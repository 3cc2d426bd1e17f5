"""`jaxhydro simulate`: files and tables."""

import math
from pathlib import Path
from typing import Any, NamedTuple

import jax
import numpy as np
from jaxtyping import Array, Float

import jaxhydro
from jaxhydro.cli.console import complain, say, table
from jaxhydro.cli.model_messages import print_remarks, print_rest
from jaxhydro.cli.simulation_files import Motion, write_motion
from jaxhydro.dynamics.model import Model
from jaxhydro.dynamics.rest_remarks import wave_remarks
from jaxhydro.dynamics.simulate import free_decay
from jaxhydro.dynamics.table_ranges import regular_fault
from jaxhydro.dynamics.time_steps import default_step
from jaxhydro.environment import DOFS
from jaxhydro.errors import InputError, Problem
from jaxhydro.quick_jit import on_device
from jaxhydro.rotations import rotation
from jaxhydro.units import for_people, unit_of
from jaxhydro.waves.regular_waves import regular_wave, series_remarks
from jaxhydro.waves.sea import Stretching, elevation_at_origin
from jaxhydro.waves.sea_limits import sea_limits
from jaxhydro.waves.wave_errors import NoWaveError, StretchingError
from jaxhydro.waves.wave_sea import WaveSea

RAMP_PERIODS = 5  # wave periods over which waves grow from rest, no more than a quarter of the duration
STEPS_PER_WAVE = 32
RESOLVED_HARMONICS = 3  # that have so many steps each; higher ones are small
BED_TOLERANCE = 1e-6  # of the depth: what is below the bed by less touches it


class Job(NamedTuple):
    """Inputs that every simulation has.

    Attributes:
        platform: Name of the platform.
        out: Folder of the results.
        duration: Simulated time (s).
        dt: Time between samples (s).
        offset: Offset from rest at the start by motion (m, rad).
        step: Largest step (s); None: chosen.
        figures: Whether figures are drawn.
        calibration: File of the calibration.
        formats: Further formats of the motion.
    """

    platform: str
    out: Path
    duration: float
    dt: float
    offset: dict[str, float]
    step: float | None
    figures: bool = True
    calibration: str | None = None
    formats: tuple[str, ...] = ()

    @property
    def inputs(self) -> dict[str, float | str | None]:
        """Attributes of simulated.nc: releases (m, deg) and calibration."""
        released = {f"release_{dof}": float(for_people(dof, value)) for dof, value in self.offset.items()}
        return {**released, "calibration": self.calibration}

    @property
    def times(self) -> np.ndarray:
        """Times of the samples that are written, from 0 (s)."""
        return self.dt * np.arange(math.floor(self.duration / self.dt * (1 + 1e-12)) + 1)


def finite(times: np.ndarray, position: np.ndarray) -> bool:
    """Whether a motion is finite; if it is not, print the time from which on."""
    if np.isfinite(position).all():
        return True
    first = times[np.argmin(np.isfinite(position).all(axis=1))]
    complain(f"the motion grows beyond all bounds at {first:.4g} s; nothing was written. Try a smaller --step.")
    return False


def told_of_bed(model: Model, times: np.ndarray, position: np.ndarray) -> None:
    """Print a warning where a motion takes the hull through the sea bed.

    The bed does not hold the hull, and there is no water below it.
    """
    points = on_device(model.hull.extremities())
    if not points.size:
        return
    lowest = position[:, 2] + np.asarray(_lowest(on_device(position), points))
    below = -float(model.environment.depth) - lowest
    if (below > BED_TOLERANCE * float(model.environment.depth)).any():
        first, most = times[np.argmax(below > 0)], below.max()
        where = f"the hull goes {most:.3g} m through the sea bed, first at {first:.4g} s"
        complain(f"warning: {where}: nothing holds it there, and the water's motion is that at the bed")


@jax.jit
def _lowest(position: Float[Array, "t 6"], points: Float[Array, "3 p"]) -> Float[Array, " t"]:
    return jax.lax.map(lambda q: (rotation(q[3:])[2] @ points).min(), position)


def run(
    model: Model,
    job: Job,
    wave: tuple[float, float] | None,
    heading: float,
    stretching: Stretching = "vertical",
    order: int = 1,
) -> bool:
    """Simulate, write and print; False where the motion grows beyond all bounds.

    Args:
        model: The model.
        job: Inputs of the simulation.
        wave: Height (m) and period (s) of regular waves; None: a free decay.
        heading: Direction that the waves travel to (deg).
        stretching: Flow above still water.
        order: Order of `regular_wave`.

    Raises:
        InputError: The wave cannot be.
        EquilibriumError: The platform does not rest.
    """
    sea, ramp, step = None, 0.0, job.step
    print_remarks(model.remarks)
    if wave is not None:
        if (fault := regular_fault(model, wave[1])) is not None:
            raise InputError("--wave-period", [Problem("", *fault)])
        print_remarks([*wave_remarks(model), *sea_limits(*wave, model.environment, order=order)])
        ramp = min(RAMP_PERIODS * wave[1], 0.25 * job.duration)
        sea = _sea(model, wave, heading, ramp, stretching, order)
        print_remarks(series_remarks(sea, order))
        shortest = wave[1] / min(order, RESOLVED_HARMONICS)
        step = min(default_step(model), shortest / STEPS_PER_WAVE) if step is None else step
    print_rest(model, job.platform, DOFS if wave is not None else list(job.offset))
    times = job.times
    position = np.asarray(free_decay(model, job.offset, times, sea=sea, step=step).position)
    if not finite(times, position):
        return False
    told_of_bed(model, times, position)
    elevation = None if sea is None else elevation_at_origin(sea, times)
    motion = Motion.of(times, position, elevation)
    inputs = job.inputs
    if wave is not None:
        inputs |= {"wave_height": wave[0], "wave_period": wave[1], "heading": heading, "ramp": ramp}
        inputs |= {"order": float(order)} if order > 1 else {}
    source = f"jaxhydro {jaxhydro.__version__}"
    write_motion(motion, job.out, job.platform, source, None, job.figures, model.hull, inputs, job.formats)
    _print_motion(motion, wave, ramp)
    say(f"Results are in {job.out}")
    return True


def _sea(model: Model, wave: tuple[float, float], heading: float, ramp: float, stretching: Stretching, order: int) -> WaveSea:
    how: dict[str, Any] = {"heading": math.radians(heading), "ramp": ramp, "stretching": stretching, "order": order}
    try:
        return regular_wave(*wave, model.environment, **how)
    except ImportError as error:
        raise InputError("--order", [Problem("", "1 or 2, or raschii installed", f"{order} ({error})")]) from None
    except StretchingError:
        raise InputError("--stretching", [Problem("", "vertical or none from order 3 on", f"{stretching}")]) from None
    except NoWaveError as error:
        raise InputError("--wave-height", [Problem("", "a wave that can be", f"none ({error})")]) from None
    except ValueError as error:
        expected = "a wave that does not break"
        raise InputError("--wave-height", [Problem("", expected, f"one too steep ({error})")]) from None


def _print_motion(motion: Motion, wave: tuple[float, float] | None, ramp: float) -> None:
    values = motion.values
    heads = ["Motion", "Mean", "Standard deviation", "Minimum", "Maximum"]
    columns = [values.mean(axis=0), values.std(axis=0), values.min(axis=0), values.max(axis=0)]
    if wave is not None:
        heads += [f"Amplitude at {wave[1]:g} s", "per m of wave amplitude"]
        amplitude = motion.amplitude(wave[1])
        columns += [amplitude, amplitude / (0.5 * wave[0])]
        say(f"Waves grow over the first {ramp:g} s; amplitudes are those of the last half")
    rows = []
    for i, dof in enumerate(DOFS):
        numbers = (f"{column[i]:.4g}" if abs(column[i]) > 1e-9 else "0" for column in columns)
        rows.append((f"{dof} ({unit_of(dof)})", *numbers))
    table("Motion", heads, rows)
