"""How models, motions and natural modes are shown, and taken on to xarray, pandas and matplotlib."""

from pathlib import Path

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose

import jaxhydro as jh
from jaxhydro.dynamics.natural_modes import Modes
from jaxhydro.hull.outline import element_outlines
from jaxhydro.platform.members_build import members_of
from jaxhydro.plots.hull_drawing import POINTS, outline
from jaxhydro.waves.components import components

TIMES = np.arange(0.0, 20.0, 0.5)


@pytest.fixture(scope="module")
def model() -> jh.Model:
    return jh.load_model("volturnus-s")


@pytest.fixture
def response() -> jh.Response:
    """A surge of 2 m and a pitch of 3 degrees."""
    position = np.zeros((len(TIMES), 6))
    position[:, 0], position[:, 4] = 2 * np.cos(TIMES), np.radians(3) * np.sin(TIMES)
    return jh.Response(jnp.asarray(TIMES), jnp.asarray(position), jnp.zeros_like(position), jnp.zeros_like(position))


def test_a_model_in_a_few_lines(model: jh.Model) -> None:
    lines = repr(model).splitlines()
    assert lines[0] == "Model of a floating platform: 20093 t in water of 1025 kg/m³, 200 m deep"
    assert "59 strips in column, pontoon" in lines[2] and "MorisonDrag (4)" in lines[3]
    assert len(lines) == 5 and all(len(line) < 160 for line in lines)


def test_what_is_not_as_usual_is_in_a_models_text(model: jh.Model) -> None:
    changed = model.with_conventions(wetting="mean").with_effect(jh.WATER_EFFECTS["current"]())
    assert "conventions: wetting mean" in repr(changed)
    assert "water effects: Current" in repr(changed)


def test_a_motion_in_a_few_lines(response: jh.Response) -> None:
    lines = repr(response).splitlines()
    assert lines[0] == "Response: 0 to 19.5 s in 40 samples, step 0.5 s"
    assert [line.split()[0] for line in lines[1:]] == list(jh.DOFS)
    assert lines[1].split()[1:] == ["-1.99", "to", "2", "m"]
    assert lines[2].split()[1:] == ["0", "to", "0", "m"]
    assert lines[5].split()[1:] == ["-3", "to", "2.99", "deg"]


def test_seas_in_a_few_lines() -> None:
    water = jh.Environment(1025.0, 200.0)
    waves = components(jnp.array([0.3, 0.4]), 2 * jnp.pi * jnp.array([0.1, 0.11]), water)
    assert repr(waves) == "Components: 2 wave components, 0.1 to 0.11 Hz: Hs 1.41 m, heading 0 deg"
    text = repr(jh.IrregularSea(waves, water, 2, ramp=50.0))
    assert text.startswith("IrregularSea of order 2 in water 200 m deep, stretching vertical, grown from rest over 50 s\n")
    first = jax.tree.map(lambda x: x[:1], waves)
    assert repr(first) == "Components: one wave component of 0.3 m, 10 s, heading 0 deg"
    shown: list[str] = []
    jax.jit(lambda w: shown.append(repr(w)))(waves)
    assert "f64[2]" in shown[0] and "\n" not in shown[0].split("(")[0]


def test_uneven_and_single_samples_have_a_text() -> None:
    def of(times: list[float]) -> str:
        zero = jnp.zeros((len(times), 6))
        return repr(jh.Response(jnp.array(times), zero, zero, zero)).splitlines()[0]

    assert of([0.0, 1.0, 3.0]) == "Response: 0 to 3 s in 3 samples, steps 1 to 2 s"
    assert of([5.0]) == "Response: 1 sample"
    assert of([]) == "Response: 0 samples"


def test_what_holds_no_numbers_shows_its_shapes(model: jh.Model, response: jh.Response) -> None:
    """While JAX traces, for shapes alone, for several motions in one, and for parts of a tree: as other modules."""
    seen = []
    jax.jit(lambda x: seen.append(repr(x)) or x.position)(response)
    assert "position=f64[40,6]" in seen[0]
    several = jax.tree.map(lambda x: jnp.stack([x, x]), response)
    assert "position=f64[2,40,6]" in repr(several)
    for tree in (response, model):
        for emptied in (eqx.filter_eval_shape(lambda x: x, tree), eqx.filter(tree, False), jax.tree.map(jnp.shape, tree)):
            assert repr(emptied).startswith(f"{type(tree).__name__}(") and emptied._repr_html_() is None
    with pytest.raises(ValueError, match="expected one motion"):
        several.to_dataframe()


def test_modes_show_their_periods(model: jh.Model) -> None:
    modes = Modes(np.array([138.3, 26.4]), np.eye(6)[[0, 4]], ("heave",), ("surge", "pitch"))
    assert repr(modes).splitlines() == [
        "Modes: 2 natural periods",
        "  surge   138.30 s",
        "  pitch    26.40 s",
        "  unstable in heave",
    ]
    frame = modes.to_dataframe()
    assert list(frame.columns) == ["motion", "period_s", *jh.DOFS]
    assert frame["period_s"].tolist() == [138.3, 26.4] and frame["pitch"].tolist() == [0.0, 1.0]
    assert len(Modes(np.zeros(0), np.zeros((0, 6)), (), ()).to_dataframe()) == 0
    assert "<td>138.3</td>" in modes._repr_html_() and "unstable in heave" in modes._repr_html_()


def test_a_motion_as_a_data_set(response: jh.Response, tmp_path: Path) -> None:
    """A variable for each motion with its unit, in m and degrees as in files; it goes to NetCDF and back."""
    data = response.to_xarray()
    assert list(data.data_vars) == list(jh.DOFS) and data["time"].attrs["units"] == "s"
    assert data.attrs["Conventions"].startswith("CF-")
    assert {name: variable.attrs["units"] for name, variable in data.items()} == {dof: "m" for dof in jh.DOFS[:3]} | {
        dof: "degree" for dof in jh.DOFS[3:]
    }
    assert {variable.attrs["standard_name"] for variable in data.values()} == {f"platform_{dof}" for dof in jh.DOFS}
    assert_allclose(data["pitch"], 3 * np.sin(TIMES), atol=1e-12)
    data.to_netcdf(tmp_path / "motion.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "motion.nc", engine="h5netcdf", decode_times=False) as read:
        xr.testing.assert_identical(read.load(), data)


def test_a_data_set_says_in_which_sea_which_platform_moved(response: jh.Response, model: jh.Model) -> None:
    sea = jh.regular_wave(2.0, 9.0, model.environment)
    data = response.to_xarray(platform="buoy", sea=sea)
    assert data.attrs["platform"] == "buoy" and data.attrs["title"] == "Motion of buoy"
    assert data["wave"].attrs["units"] == "m"
    assert_allclose(data["wave"], np.cos(2 * np.pi * TIMES / 9.0), atol=1e-9)
    assert "wave" not in response.to_xarray(sea=jh.StillWater())


def test_a_motion_as_a_data_frame(response: jh.Response) -> None:
    frame = response.to_dataframe()
    assert list(frame.columns) == ["surge_m", "sway_m", "heave_m", "roll_deg", "pitch_deg", "yaw_deg"]
    assert frame.index.name == "time_s"
    assert_allclose(frame["surge_m"], 2 * np.cos(TIMES))
    assert_allclose(frame["pitch_deg"], 3 * np.sin(TIMES), atol=1e-12)


def test_tables_in_notebooks(model: jh.Model, response: jh.Response) -> None:
    table = model._repr_html_()
    assert "<td>column.Cd_t</td>" in table and table.count("<tr>") == len(model.values)
    assert "<td>pitch</td>" in response._repr_html_() and "<td>deg</td>" in response._repr_html_()
    assert "<td>-0</td>" not in response._repr_html_()


def test_text_in_tables_is_escaped() -> None:
    import pandas as pd

    from jaxhydro.display.data_frames import html

    made = html("<b>one</b>\ntwo", pd.DataFrame({"a": ["<script>"]}))
    assert "&lt;b&gt;one&lt;/b&gt;<br>two" in made and "<script>" not in made


def test_axes_of_a_motion(response: jh.Response) -> None:
    """What moves alone, in degrees; no figure is kept open."""
    axes = response.plot()
    assert [ax.get_ylabel() for ax in axes] == ["Surge (m)", "Pitch (deg)"]
    assert_allclose(axes[1].lines[0].get_ydata(), 3 * np.sin(TIMES), atol=1e-12)
    assert axes[0].figure is axes[1].figure and axes[-1].get_xlabel() == "Time (s)"


def test_axes_of_a_hull(model: jh.Model) -> None:
    side, above = model.plot()
    assert (side.get_ylabel(), above.get_ylabel()) == ("z (m)", "y (m)")
    assert len(side.patches) == len(above.patches) == model.hull.elements.length.size


def test_elements_are_where_the_members_are(model: jh.Model) -> None:
    """VolturnUS-S: 7 members of one element each, of the same surface."""
    members = members_of(jh.load_platform("volturnus-s"))
    for drawn, member in zip(element_outlines(model.hull, POINTS), members, strict=True):
        whole = outline(member).reshape(-1, 3)
        assert_allclose(np.sort(drawn.reshape(-1, 3).min(axis=0)), np.sort(whole.min(axis=0)), atol=1e-9)
        assert_allclose(drawn.reshape(-1, 3).max(axis=0), whole.max(axis=0), atol=1e-9)


def test_a_body_without_members_has_no_hull_to_draw(model: jh.Model) -> None:
    from jaxhydro.hull.hull import Hull

    bare = eqx.tree_at(lambda m: m.hull, model, Hull.of([]))
    assert "hull: no members" in repr(bare)
    with pytest.raises(ValueError, match="no members"):
        bare.plot()


def test_a_decay_may_be_pushed_and_in_waves(model: jh.Model) -> None:
    """What `simulate` takes, by name: the same motion."""
    times, sea = np.arange(0.0, 10.0, 1.0), jh.regular_wave(2.0, 8.0, model.environment)
    options = {"rate": {"surge": 0.5}, "step": 0.5, "method": "rk4"}
    pushed = jh.free_decay(model, {"surge": 1.0}, times, sea=sea, **options)
    same = jh.simulate(model, times, sea, position={"surge": 1.0}, **options)
    assert_allclose(pushed.position, same.position, atol=1e-12)
