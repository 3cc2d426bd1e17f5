"""Remarks on seas near the limits of wave theory: numbers worked out by hand from the deep- and shallow-water limits."""

from types import SimpleNamespace

import pytest

from jaxhydro.cli.sea_command import _limits
from jaxhydro.environment import Environment
from jaxhydro.input_schema import validate
from jaxhydro.sweep.cases import plan_of
from jaxhydro.sweep.sweep_remarks import near_limits
from jaxhydro.sweep.sweep_schema import Sweep
from jaxhydro.waves.directional_spectrum import WaveSystem
from jaxhydro.waves.sea_limits import sea_limits

DEEP, SHALLOW = Environment(1025.0, 2000.0, 9.81), Environment(1025.0, 10.0, 9.81)


def texts(*args, **options) -> str:
    return " ".join(remark.text for remark in sea_limits(*args, **options))


def test_an_ordinary_sea_has_no_remark() -> None:
    assert sea_limits(8.0, 12.0, DEEP, 2, 300.0) == []
    assert sea_limits(2.0, 8.0, DEEP, 1) == []


def test_the_highest_wave_breaks_by_its_steepness() -> None:
    """L = g T² / 2 pi = 156.1 m at 10 s: 22.2 m stand. Of 360 waves the highest is 1.716 Hs: from Hs = 12.9 m on."""
    assert sea_limits(12.8, 10.0, DEEP, 2, 360.0) == []
    assert "the highest of 360 waves, about 22.3 m, would break: at 10 s 22.2 m stand" in texts(13.0, 10.0, DEEP, 2, 360.0)


@pytest.mark.parametrize(("height", "waves", "limit"), [(6.1, 100.0, 0.6), (7.9, None, 0.78)])
def test_waves_break_by_depth(height: float, waves: float | None, limit: float) -> None:
    assert f"waves break by depth above {limit:g}" in texts(height, 6.0, SHALLOW, 1, waves)
    assert "break by depth" not in texts(height - 0.2, 6.0, SHALLOW, 1, waves)


def test_second_order_is_wrong_in_shallow_water() -> None:
    """Long waves of length sqrt(g d) T = 198 m at 20 s, 3 % less by dispersion: H L² / d³ = 40 at H = 1.08 m."""
    (second,) = sea_limits(1.3, 20.0, SHALLOW, 2, 100.0)
    (first,) = sea_limits(1.3, 20.0, SHALLOW, 1, 100.0)
    assert second.warning and "bound waves of second order are too high" in second.text
    assert not first.warning and "linear theory" in first.text
    assert sea_limits(0.9, 20.0, SHALLOW, 2, 100.0) == []


def test_a_stream_function_is_not_limited_by_the_ursell_number() -> None:
    assert sea_limits(1.3, 20.0, SHALLOW, 5) == []


def test_a_sweep_and_a_low_swell_are_told() -> None:
    """Of a sweep the steepest sea state; beside a higher wind sea the swell that is too long for the depth."""
    rows = [{"hs": 6.5, "tp": 9.0}, {"hs": 2.0, "tp": 6.0}, {"hs": 6.2, "tp": 12.0}]
    plan, _ = plan_of(validate(Sweep, {"platform": "oc3-hywind", "scatter": rows, "order": 1}, "sweep"), "sweep")
    warning_by_text = {remark.text: remark.warning for remark in near_limits(plan, SHALLOW, {})}
    depth, highest, ursell = warning_by_text
    assert "Hs 6.5 m, Tp 9 s: the significant height, 6.5 m, is 0.65 of the depth" in depth and "in 2 of 3 sea states" in depth
    assert (
        "would break" in highest and "the Ursell number is" in ursell and list(warning_by_text.values()) == [True, False, False]
    )
    about = {"significant_wave_height": 3.2, "peak_period": 6.0}
    systems = (WaveSystem(3.0, 6.0), WaveSystem(1.2, 20.0))
    (remark,) = (
        entry for entry in _limits(SimpleNamespace(environment=SHALLOW), about, 600.0, 1, systems) if "Ursell" in entry.text
    )
    assert remark.text.startswith("of the system of Tp 20 s the Ursell number is")
