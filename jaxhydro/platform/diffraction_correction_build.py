"""Correction of the strips' first-order wave force by a table.

The strips' own force at rest is computed and subtracted.
"""

import dataclasses
from collections.abc import Mapping
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Complex, Float

from jaxhydro.dynamics.model import Model
from jaxhydro.loads import ComputedExcitation, CoveredEnds, DiffractionCorrection, EndInertia, StripInertia
from jaxhydro.loads.diffraction_correction import Key
from jaxhydro.loads.forces_at_rest import COVERED, ForcesAtRest
from jaxhydro.quick_jit import on_device, quick_jit
from jaxhydro.waves.components import PlaneWaves, components
from jaxhydro.waves.excitation import AnyExcitation, DirectionalExcitation, Excitation
from jaxhydro.waves.wave_sea import WaveSea

MIN_FREQUENCIES = 240  # between which forces of strips, whose phase turns with frequency, are linear within 0.1 %


def with_diffraction_correction(model: Model) -> Model:
    """The model with a `DiffractionCorrection` in place of its `ComputedExcitation`.

    Args:
        model: A model with strips and a computed excitation.
    """
    loads = tuple(_correction(model, load) if isinstance(load, ComputedExcitation) else load for load in model.loads)
    return dataclasses.replace(model, loads=loads)


def _correction(model: Model, table: ComputedExcitation) -> DiffractionCorrection:
    """The correction that a table makes of a model's strips."""
    keys: list[Key] = [("strips", *key) for load in model.loads if isinstance(load, StripInertia) for key in load.Ca]
    keys += [("ends", *key) for load in model.loads if isinstance(load, EndInertia) for key in load.Ca]
    keys.append(("covered_ends", *COVERED))
    whole = table.excitation
    low, high = float(whole.omega[0]), float(whole.omega[-1])
    omega = np.unique(np.concatenate([np.asarray(whole.omega), np.linspace(low, high, MIN_FREQUENCIES)]))
    rows = _rows(model, whole, omega, tuple(keys))
    return DiffractionCorrection(rows, table.share, table.corner, tuple(keys))


def _rows(model: Model, whole: AnyExcitation, omega: Float[np.ndarray, " n"], keys: tuple[Key, ...]) -> AnyExcitation:
    """Table less the strips' force without added mass, then that of each coefficient."""
    if isinstance(whole, DirectionalExcitation):
        headings = np.asarray(whole.by_heading.heading)
        tables = [_of_one_heading(model, whole.towards(float(heading)), float(heading), omega, keys) for heading in headings]
        return DirectionalExcitation.of(headings, tables)
    return _of_one_heading(model, whole, 0.0, omega, keys)


_table_at = quick_jit(Excitation.at)


def _of_one_heading(
    model: Model, table: Excitation, heading: float, omega: Float[np.ndarray, " n"], keys: tuple[Key, ...]
) -> Excitation:
    base, each = strip_forces(model, omega, heading, keys)
    correction = np.asarray(_table_at(table, on_device(omega))) - base
    return Excitation.of(omega, np.concatenate([correction, *each]))


def strip_forces(
    model: Model, omega: Float[np.ndarray, " n"], heading: float, keys: tuple[Key, ...]
) -> tuple[Complex[np.ndarray, "6 n"], Complex[np.ndarray, "c 6 n"]]:
    """First-order wave force on the strips and ends of a platform at rest, per metre of wave.

    Args:
        model: The model.
        omega: Angular frequencies (rad/s), (n,).
        heading: Direction that the waves travel to (rad).
        keys: The coefficients.

    Returns:
        Force where all are 0 (N/m, N, earth axes), (6, n), and what each coefficient adds per unit, (c, 6, n).
    """
    at_rest = model.with_conventions(wetting="mean", waves_at="mean")
    loads = tuple(load for load in model.loads if isinstance(load, StripInertia | EndInertia))
    at_rest = dataclasses.replace(at_rest, loads=(*loads, CoveredEnds()), water=(), sensors=())
    ones = on_device(np.ones(len(omega)))
    waves = components(ones, on_device(omega), model.environment, heading=heading * ones, phase=0.0)
    parts = [np.asarray(part) for part in _forces(at_rest, PlaneWaves.free(waves, model.environment), keys)]
    base, each = (real + 1j * imaginary for real, imaginary in (parts[:2], parts[2:]))
    return base.T, np.moveaxis(each, 0, 2)


@quick_jit
def _forces(model: Model, waves: PlaneWaves, keys: tuple[Key, ...]) -> tuple[Array, ...]:
    """Force where all coefficients are 0, and the force that each coefficient adds.

    Returns:
        Real and imaginary part of the first, (n, 6), then of the second, (n, c, 6).
    """

    def force(coefficients: Float[Array, " c"], wave: PlaneWaves) -> Float[Array, "6"]:
        values: dict[str, dict[tuple[str, str], Any]] = {part: {} for part in ForcesAtRest._fields}
        for (part, group, kind), value in zip(keys, coefficients):
            values[part][group, kind] = value
        loads = tuple(_with_coefficients(load, values) for load in model.loads)
        sea = WaveSea(jax.tree.map(lambda x: x[..., None], wave), model.environment, stretching="none")
        return dataclasses.replace(model, loads=loads).force_at_rest(jnp.zeros(6), sea)

    def turned(wave: PlaneWaves, turn: complex) -> PlaneWaves:
        return PlaneWaves(wave.omega, wave.vector, wave.elevation * turn, wave.potential * turn)

    def forces_of(omega, vector, elevation, potential):
        wave, none = PlaneWaves(omega, vector, elevation, potential), jnp.zeros(len(keys))
        real, imaginary = (
            (force(none, component), jax.jacfwd(force)(none, component).T) for component in (wave, turned(wave, -1j))
        )
        return real[0], imaginary[0], real[1], imaginary[1]

    return jax.vmap(forces_of, (0, 1, 0, 0))(waves.omega, waves.vector, waves.elevation, waves.potential)


def _with_coefficients(load: Any, values: Mapping[str, Mapping[tuple[str, str], Any]]) -> Any:
    if isinstance(load, CoveredEnds):
        return CoveredEnds(values["covered_ends"][COVERED])
    return dataclasses.replace(load, Ca=values["strips" if isinstance(load, StripInertia) else "ends"])
