"""Sweeps with swell beside wind sea, spreading and headings by sea state."""

import numpy as np
import pytest
import xarray as xr
from fake_sweep import SWEEP, written

from jaxhydro.dynamics.requested_sea import RequestedSea
from jaxhydro.dynamics.sea_of_request import build_sea
from jaxhydro.errors import InputError
from jaxhydro.input_schema import validate
from jaxhydro.sweep import batch
from jaxhydro.sweep.batch import run_outcomes, sea_of, setup_of
from jaxhydro.sweep.cases import Plan, plan_of
from jaxhydro.sweep.sea_states import State, named
from jaxhydro.sweep.sweep_file import load_sweep
from jaxhydro.sweep.sweep_remarks import shares_in_band
from jaxhydro.sweep.sweep_schema import Sweep
from jaxhydro.sweep.write_sweep import _failures
from jaxhydro.waves.directional_spectrum import WaveSystem

ROWS = [
    {"hs": 1.5, "tp": 8.0, "probability": 1, "heading": 0.0, "spreading": 8.0},
    {"hs": 1.0, "tp": 8.0, "probability": 3, "heading": 20.0, "swell_hs": 2.0, "swell_tp": 12.0, "swell_heading": -40.0},
    {"hs": 1.0, "tp": 8.0, "probability": 0, "heading": 30.0, "swell_hs": 2.0, "swell_tp": 12.0, "swell_gamma": 3.0},
]
TABLE = """Hs,Tp,probability,heading (deg),spreading,swell_hs (m),swell_tp,swell_heading,swell_gamma
1.5,8,1,0,8,,,,
1,8,3,20,,2,12,-40,
1,8,0,30,,2,12,,3
"""


def sweep(**changes) -> Sweep:
    return validate(Sweep, SWEEP | {"scatter": ROWS} | changes, "sweep")


def test_a_row_is_a_wind_sea_and_a_swell_with_headings_of_their_own() -> None:
    made, notes = plan_of(sweep(), "sweep")
    assert Plan.from_json(made.to_json()) == made and notes == ["1 case of probability 0 is left out"]
    first, second = made.cases
    assert (first.heading, first.spreading, first.probability, first.swell_hs) == (0.0, 8.0, 0.25, None)
    assert second.towards == {20.0, -40.0} and second.state.height == pytest.approx(5**0.5)
    assert (second.state.peak_period, first.state.peak_period) == (12.0, 8.0)
    assert named(second.state) == "Hs 1 m, Tp 8 s, swell Hs 2 m, Tp 12 s towards -40 deg"
    assert second.state.systems(20.0, "jonswap", 5.0) == (
        WaveSystem(1.0, 8.0, None, 20.0, 5.0),
        WaveSystem(2.0, 12.0, None, -40.0),
    )


def test_a_csv_table_has_the_same_sea_states(tmp_path) -> None:
    file = written(tmp_path, scatter="table.csv")
    (tmp_path / "table.csv").write_text(TABLE)
    assert [row.model_dump() for row in load_sweep(file).scatter] == [row.model_dump() for row in sweep().scatter]


@pytest.mark.parametrize(
    ("changes", "old", "new", "words"),
    [
        ({}, "1,8,3,20,,2,", "1,8,3,20,,,", "line 3, column swell_hs: expected a number > 0, for a swell with swell_tp"),
        ({}, "swell_tp", "swell_tp (h)", "found 'swell_tp (h)'. Hs in m, Tp in s"),
        ({}, "1.5,8,1,0,8", "1.5,8,1,0,-8", "line 2, column spreading: expected a number from 0 to 10000, found '-8'"),
        ({}, "1.5,8,1,0,8", "1.5,8,1,,8", "row 1, column heading: expected a heading, as others in the table have, found none"),
        ({"headings": [0, 30]}, "", "", "row 2, column heading: expected none, since the sweep has headings for all sea"),
        ({"order": 2}, "", "", "row 1, column spreading: expected order: 1 with it: second order is of long-crested seas"),
        ({"order": 2}, "1.5,8,1,0,8", "1.5,8,1,0,", "row 2, column swell_heading: expected order: 1"),
    ],
)
def test_a_wrong_table_is_told_by_its_row(tmp_path, changes, old, new, words) -> None:
    file = written(tmp_path, scatter="table.csv", **changes)
    (tmp_path / "table.csv").write_text(TABLE.replace(old, new) if old else TABLE)
    with pytest.raises(InputError) as error:
        load_sweep(file)
    assert words in str(error.value) and "table.csv" in str(error.value)


def test_a_list_is_told_by_its_keys() -> None:
    """Half a swell; spreading at second order. A swell along the wind sea is long-crested, also at second order."""
    with pytest.raises(InputError, match=r"scatter\[0\]\.swell_tp: expected a number > 0, for a swell with swell_hs"):
        sweep(scatter=[{"hs": 1, "tp": 5, "swell_hs": 1}])
    with pytest.raises(InputError, match=r"scatter\[0\]\.spreading: expected order: 1 with it"):
        sweep(scatter=[ROWS[0]], order=2)
    made = sweep(scatter=[ROWS[2] | {"probability": 1}], order=2)
    assert len(plan_of(made, "sweep")[0].cases) == 1


def test_runs_are_those_of_simulate_and_go_on_whether_long_crested_or_not(tmp_path, monkeypatch) -> None:
    """The sea is that of `simulate --sea`. Only long-crested ones are simulated at once."""
    made = load_sweep(
        written(tmp_path, scatter=[*ROWS[:2], {"hs": 2.0, "tp": 9.0, "probability": 1, "heading": 0.0}], seeds=[3])
    )
    plan, _ = plan_of(made, "sweep")
    setup = setup_of(plan, tmp_path / "buoy.yaml", None)
    how = {"seed": 3, "amplitudes": "deterministic", "low": plan.low, "cutoff": plan.cutoff, "order": 1}
    systems = (WaveSystem(1.0, 8.0, None, 20.0), WaveSystem(2.0, 12.0, None, -40.0))
    requested = RequestedSea.of_systems(systems, **how, stretching="vertical", transient=None)
    expected, sea = build_sea(setup.model, requested, plan.duration), sea_of(setup, plan.run(1))
    for name in ("amplitude", "phase", "heading"):
        assert (np.asarray(getattr(sea.components, name)) == np.asarray(getattr(expected.sea.components, name))).all()
    assert shares_in_band(plan)[1] == pytest.approx(float(0.5 * (sea.components.amplitude**2).sum()) / (5.0 / 16), rel=1e-9)
    together = []
    monkeypatch.setattr(batch, "run_outcome", lambda setup, run: f"alone {run.number}")
    monkeypatch.setattr(batch, "simulate_in_halves", lambda model, seas, *_, **__: together.extend(seas) or [None] * len(seas))
    assert run_outcomes(setup, [plan.run(i) for i in range(3)]) == ["alone 0", "alone 1", "alone 2"]
    assert [sea.long_crested for sea in together] == [True]


def test_failures_keep_the_swell() -> None:
    states = {"hs": [1.0, 2.0], "tp": [8.0, 9.0], "gamma": [np.nan, 2.0], "heading": [0.0, 0.0]}
    states |= {"swell_hs": [2.0, np.nan], "swell_tp": [12.0, np.nan]}
    data = xr.Dataset({name: ("case", values) for name, values in states.items()})
    data["seed"], data["status"] = ("seed", [0]), (("case", "seed"), [[2], [2]])
    data["reason"] = (("case", "seed"), [["a"], ["b"]])
    first, second = _failures(data)
    assert State.of(first) == State(1.0, 8.0, swell_hs=2.0, swell_tp=12.0) and State.of(second) == State(2.0, 9.0, 2.0)
    assert "swell_hs" not in second.model_dump(exclude_unset=True)
