"""Correction of the strips' first-order force by a table: its force at rest, small waves, and what strips keep."""

import dataclasses
from pathlib import Path

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from one_program import one_program

import jaxhydro as jh
from jaxhydro.dynamics.model import Model
from jaxhydro.errors import InputError
from jaxhydro.loads import ComputedAddedMass, ComputedExcitation, CoveredEnds, DiffractionCorrection, EndInertia, StripInertia
from jaxhydro.platform.diffraction_correction_build import with_diffraction_correction
from jaxhydro.waves.excitation import DirectionalExcitation, Excitation

WATER = jh.Environment(1025.0, 200.0, 9.81)
OMEGA = np.linspace(0.3, 1.6, 14)


def table(seed: int = 5) -> Excitation:
    rng = np.random.default_rng(seed)
    scale = np.array([2e6, 2e6, 1e6, 2e7, 2e7, 2e7])[:, None]
    return Excitation.of(OMEGA, scale * (rng.normal(0, 1, (6, 14)) + 1j * rng.normal(0, 1, (6, 14))))


def corrected(share: float = 1.0, excitation=None, **conventions) -> Model:
    model = jh.load_model("volturnus-s").with_conventions(**conventions)
    load = ComputedExcitation(excitation or table(), jnp.asarray(share))
    return with_diffraction_correction(model.with_effect(load))


def waves(omega: float, heading: float = 0.0, amplitude: float = 1.0, phase: float = 0.4, **options) -> jh.WaveSea:
    return jh.regular_wave(2 * amplitude, 2 * np.pi / omega, WATER, heading=heading, phase=phase, **options)


forces = one_program(Excitation.at)


@eqx.filter_jit
def force(model: Model, sea: jh.WaveSea) -> jnp.ndarray:
    return model.force_at_rest(jnp.zeros(6), sea) - model.force_at_rest(jnp.zeros(6))


@pytest.mark.slow
@pytest.mark.parametrize("diffraction", ["maccamy_fuchs", "ramp", "none"])
def test_the_first_order_force_is_that_of_the_table(diffraction: str) -> None:
    """On the upright hull in mean wetting, whatever the added-mass coefficients are; drag left out."""
    model = corrected(diffraction=diffraction, wetting="mean")
    first_order_loads = (StripInertia, EndInertia, DiffractionCorrection)
    loads = (*(load for load in model.loads if isinstance(load, first_order_loads)), CoveredEnds())
    model = dataclasses.replace(model, loads=loads)
    for values in ({}, {"column.Ca_t": 0.3, "column.Ca_z": 1.4, "pontoon.Ca_z": 0.2, "covered_ends.share": 0.7}):
        changed = model.with_values(values)
        for omega in (0.35, 0.6, 1.3):
            sea = waves(omega)
            expected = (np.asarray(forces(table(), np.array([omega])))[:, 0] * np.exp(0.4j)).real
            acting_force = force(changed, changed.through(sea))
            assert_allclose(acting_force, expected, atol=2e-3 * np.abs(expected).max() + 1e3)


@pytest.mark.slow
def test_no_share_leaves_the_strips_alone() -> None:
    model, sea = jh.load_model("volturnus-s"), waves(0.6)
    without = corrected(0.0)
    assert_allclose(force(without, without.through(sea)), force(model, sea), rtol=1e-12, atol=1e-6)


@pytest.mark.slow
def test_second_order_forces_stay() -> None:
    """What the surface does to the wet length is that of the strips: the correction is linear in the waves."""
    model, plain = corrected(), jh.load_model("volturnus-s")
    corrections = [
        force(model, model.through(waves(0.6, amplitude=a))) - force(plain, waves(0.6, amplitude=a)) for a in (0.5, 2.0)
    ]
    assert_allclose(4 * corrections[0], corrections[1], rtol=1e-9)


def test_several_headings() -> None:
    """A table of several headings has the strips of each taken off."""
    rng = np.random.default_rng(1)
    headings = np.radians([-60.0, -20.0, 20.0, 60.0])
    by_heading = DirectionalExcitation.of(headings, [table(int(seed)) for seed in rng.integers(0, 99, 4)])
    model = corrected(1.0, by_heading, wetting="mean")
    first_order_loads = (StripInertia, EndInertia, DiffractionCorrection)
    model = dataclasses.replace(model, loads=tuple(load for load in model.loads if isinstance(load, first_order_loads)))
    sea = waves(0.6, heading=float(headings[2]))
    expected = (np.asarray(forces(by_heading.towards(float(headings[2])), np.array([0.6])))[:, 0] * np.exp(0.4j)).real
    assert_allclose(force(model, model.through(sea)), expected, atol=2e-3 * np.abs(expected).max() + 1e3)


@pytest.mark.slow
def test_in_small_waves_it_moves_as_with_the_table() -> None:
    """An irregular sea of 0.01 m moves both models alike, a prepared sea of first order."""
    model = jh.load_model("volturnus-s")
    whole = model.with_effect(ComputedExcitation(table(), jnp.asarray(1.0)))
    around = with_diffraction_correction(whole)
    spectrum = jh.spectrum_components(lambda w: jh.jonswap(w, 0.01, 9.0), 600.0, WATER, low=0.06, cutoff=0.2, seed=3)
    sea, times = jh.IrregularSea(spectrum, WATER), np.arange(0.0, 600.0, 1.0)
    motions = [jh.simulate(variant, times, sea) for variant in (whole, around)]
    for dof in ("surge", "heave", "pitch"):
        a, b = (np.asarray(response[dof])[len(response[dof]) // 3 :] for response in motions)
        assert np.std(a - b) < 0.01 * np.std(a), dof


def test_platform_file(tmp_path: Path) -> None:
    """The key makes the load; a table of drift beside it is refused."""
    text = jh.platform.schema.builtin_text("volturnus-s")
    rows = [f"{2 * np.pi / w:.6f} 0.0 {i} 1.0 0.0 1.0 0.0" for w in OMEGA for i in range(1, 7)]
    (tmp_path / "hull.3").write_text("\n".join(rows) + "\n")
    line = "excitation: {file: hull.3, second_order: strips"
    (tmp_path / "platform.yaml").write_text(f"{text}\n{line}}}\n")
    model = jh.load_model(str(tmp_path / "platform.yaml"))
    assert float(model.values["diffraction_correction.share"]) == 1.0
    (tmp_path / "platform.yaml").write_text(f"{text}\n{line}, use: candidate}}\n")
    assert float(jh.load_model(str(tmp_path / "platform.yaml")).values["diffraction_correction.share"]) == 0.0
    (tmp_path / "platform.yaml").write_text(f"{text}\n{line}}}\ndrift: {{file: hull.12d}}\n")
    with pytest.raises(InputError, match="no table of drift"):
        jh.load_model(str(tmp_path / "platform.yaml"))


def test_added_mass_of_a_table_keeps_what_wetting_does() -> None:
    """Without a table of excitation, a table's added mass replaces that of the strips at rest; the surface adds theirs."""
    table_mass = np.diag([1e7, 1e7, 2e7, 1e10, 1e10, 2e10])
    plain = jh.load_model("volturnus-s")
    whole = plain.with_effect(ComputedAddedMass(jnp.asarray(table_mass), jnp.asarray(1.0)))

    @eqx.filter_jit
    def added(model: Model, heave: float) -> jnp.ndarray:
        state = jh.State(jnp.zeros(6).at[2].set(heave), jnp.zeros(6), model.rest().memory)
        total = model.sum_of_loads(model.instant(jnp.zeros(()), state, jh.StillWater()), state.memory)
        return total.added_mass + model.hull.moments @ total.masses

    assert_allclose(added(whole, 0.0), table_mass, atol=1e-9 * table_mass.max())
    change = added(plain, -1.5) - added(plain, 0.0)
    assert float(change[0, 0]) > 1e5
    assert_allclose(added(whole, -1.5) - table_mass, change, atol=1e-9 * table_mass.max())
