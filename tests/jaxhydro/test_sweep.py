"""What a sweep file may say and what it means; statistics over a life. No simulation."""

import json
import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from fake_sweep import SWEEP, written

import jaxhydro as jh
from calibration.report.write_report import write_report
from jaxhydro.dynamics.time_steps import largest_step
from jaxhydro.errors import InputError
from jaxhydro.input_schema import validate
from jaxhydro.sweep.batch import Setup, prepared_for, sea_of
from jaxhydro.sweep.cases import Plan, plan_of
from jaxhydro.sweep.lifetime import exceedance, lifetime, weighted
from jaxhydro.sweep.resources import bytes_of_run, chosen, supports_of
from jaxhydro.sweep.run_statistics import equivalent_ranges, frequencies, run_results
from jaxhydro.sweep.sweep_figures import exceedance_figure, scatter_figure
from jaxhydro.sweep.sweep_file import load_sweep
from jaxhydro.sweep.sweep_remarks import impossible, notes, shares_in_band
from jaxhydro.sweep.sweep_schema import Sweep


def plan(**changes) -> Plan:
    return plan_of(validate(Sweep, SWEEP | changes, "sweep"), "sweep")[0]


# --- cases


def test_cases_are_states_by_headings_by_seeds_in_order() -> None:
    made = plan(
        scatter=[{"hs": 1, "tp": 5, "probability": 1}, {"hs": 2, "tp": 8, "probability": 3, "gamma": 2}],
        seeds=[4, 7],
        headings=[{"heading": 0, "probability": 1}, {"heading": 30, "probability": 3}],
    )
    assert [case.probability for case in made.cases] == [1 / 16, 3 / 16, 3 / 16, 9 / 16]
    assert [(case.hs, case.gamma, case.heading) for case in made.cases] == [(1, None, 0), (1, None, 30), (2, 2, 0), (2, 2, 30)]
    assert len(made) == 8
    run = made.run(5)
    assert (run.row, run.column, run.case, run.seed) == (2, 1, made.cases[2], 7)
    assert Plan.from_json(made.to_json()) == made
    assert made.start == 0.25 * made.duration


def test_a_grid_is_all_heights_with_all_periods_and_what_never_happens_is_left_out() -> None:
    made, remarks = plan_of(
        validate(Sweep, SWEEP | {"scatter": {"hs": [1, 2], "tp": [5, 6, 7], "probability": [[1, 0, 1], [2, 2, 0]]}}, "sweep"),
        "s",
    )
    assert remarks == ["2 cases of probability 0 are left out"]
    states = [(case.hs, case.tp, case.probability) for case in made.cases]
    assert states == [(1, 5, 1 / 6), (1, 7, 1 / 6), (2, 5, 1 / 3), (2, 6, 1 / 3)]


def test_what_is_in_a_table_twice_is_run_once() -> None:
    rows = [{"hs": hs, "tp": 8, "probability": share} for hs, share in ((1, 1), (2, 3), (1, 2), (2, 0), (1, 4))]
    made, remarks = plan_of(validate(Sweep, SWEEP | {"scatter": rows}, "sweep"), "s")
    assert [(case.hs, case.probability) for case in made.cases] == [(1, 0.7), (2, 0.3)]
    (note,) = remarks
    assert note == "Hs 1 m, Tp 8 s and 1 more are in the table more than once: run once, and its probabilities add up"


def test_a_table_is_read_from_a_file_beside_the_sweep(tmp_path) -> None:
    file = written(tmp_path, scatter="table.csv")
    (tmp_path / "table.csv").write_text("Tp, Hs, Probability, gamma\n7, 1.5, 0.6,\n\n9, 3, 0.4, 2.5\n")
    sweep = load_sweep(file)
    assert [(row.hs, row.tp, row.probability, row.gamma) for row in sweep.scatter] == [(1.5, 7, 0.6, None), (3, 9, 0.4, 2.5)]
    assert Path(sweep.platform) == tmp_path / "buoy.yaml"
    (tmp_path / "table.csv").write_text("Tp; Hs; Probability; gamma\n7; 1,5; 0,6;\n9; 3; 0,4; 2,5\n")  # as spreadsheets do
    assert load_sweep(file).scatter == sweep.scatter
    (tmp_path / "table.csv").write_text("Tp [s],Hs (m),Probability (%),gamma\n7,1.5,0.6,\n9,3,0.4,2.5\n")
    assert load_sweep(file).scatter == sweep.scatter
    (tmp_path / "table.csv").write_text("\ufeffsep=;\n# North Sea\nTp;Hs;Probability;gamma\n7;1,5;0,6;\n9;3;0,4;2,5\n")
    assert load_sweep(file).scatter == sweep.scatter
    (tmp_path / "table.csv").write_text("Tp,Hs,Probability,gamma,\r\n7,1.5,0.6,,\r\n9,3,0.4,2.5,\r\n", encoding="utf-16")
    assert load_sweep(file).scatter == sweep.scatter


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ("Hs,Tp\n1,2\n", "line 1: expected a column probability, found Hs, Tp"),
        ("Hs,Tp,probabilty\n1,2,3\n", "found 'probabilty'. Did you mean 'probability'?"),
        ("Hs,Tp,probability\n1,2,3\n1,x,-1\n", "line 3, column Tp: expected a number > 0, found 'x'"),
        ("Hs;Tp;probability\n1,5;8,5;1.234\n", "line 2, column probability: expected a number with a decimal comma"),
        ("Hs;Tp;probability\n1.5;8,5;x\n", "line 2, column Hs: expected a number with a decimal comma, as others"),
        ("Hs (ft),Tp,probability\n1,2,3\n", "found 'Hs (ft)'. Hs in m, Tp in s"),
        ("Hs,Tp (min),probability (%)\n1,2,3\n", "found 'Tp (min)'. Hs in m, Tp in s"),
        ("# hours\nHs,Tp,probability\n1,2,x\n", "line 3, column probability: expected a number >= 0"),
        ("Hs,Tp,probability\n1,2\n", "line 2: expected 3 cells, found 2"),
        ("Hs,Tp,probability\n", "expected one row or more under the header, found none"),
        ("", "found an empty file"),
    ],
)
def test_a_wrong_table_is_told_by_its_row(tmp_path, table, words) -> None:
    file = written(tmp_path, scatter="table.csv")
    (tmp_path / "table.csv").write_text(table)
    with pytest.raises(InputError) as error:
        load_sweep(file)
    assert words in str(error.value) and "table.csv" in str(error.value)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"scatter": None}, "scatter: expected a CSV file, a list of sea states (hs, tp, probability), or a grid"),
        ({"scatter": []}, "scatter: expected"),
        ({"scatter": [{"hs": -1, "tp": 5}]}, "scatter[0].hs: expected a number > 0, found -1"),
        ({"scatter": {"hs": [1], "tp": [5], "probability": [[1, 2]]}}, "scatter.probability[0]: expected 1 numbers"),
        ({"scatter": [{"hs": 1, "tp": 5, "probability": 0}]}, "scatter: expected a probability above 0, found none"),
        ({"headings": [{"heading": 0, "probability": 0}]}, "headings: expected a probability above 0, found none"),
        (
            {"scatter": [{"hs": 1, "tp": 5, "probability": 2}, {"hs": 1, "tp": 6}]},
            "scatter[1]: expected a probability, as others in the list have, found none",
        ),
        (
            {"headings": [0, {"heading": 30, "probability": 0.5}]},
            "headings[0]: expected a probability, as others in the list have, found none",
        ),
        ({"fatigue": {"exponents": [3, 4, 3]}}, "fatigue.exponents: expected each one once, found 3.0 twice"),
        ({"scatter": "none.csv"}, "none.csv', and there is none"),
        ({"seed": 3}, "found 'seed'. Did you mean 'seeds'?"),
        ({"seeds": [1, 1]}, "seeds: expected each one once, found 1 twice"),
        ({"headings": [0, 360]}, "headings: expected each one once, found 0 deg twice"),
        ({"seeds": 0}, "seeds: expected a number of seeds, 1 to 100000"),
        ({"headings": 30}, "headings: expected a list"),
        ({"cutoff": 0.02}, "cutoff: expected a number above low, 0.03 Hz, found 0.02"),
        ({"transient": 150}, "transient: expected less than the duration, 150 s, found 150"),
        ({"duration": 40}, "duration: expected 100 samples or more after the transient of 10 s, found 60"),
        ({"motions": ["surge", "drift"]}, "motions[1]: expected one of surge, sway"),
        ({"fatigue": {"exponents": [0.5]}}, "fatigue.exponents[0]: expected a number >= 1"),
        ({"order": 3}, "order: expected one of 1, 2, found 3"),
    ],
)
def test_a_wrong_sweep_is_told_by_its_key(tmp_path, changes, words) -> None:
    with pytest.raises(InputError) as error:
        plan_of(load_sweep(written(tmp_path, **changes)), "sweep")
    assert words in str(error.value)


def test_a_table_in_another_encoding_is_told(tmp_path) -> None:
    file = written(tmp_path, scatter="table.csv")
    (tmp_path / "table.csv").write_text("# Größe\nHs,Tp,probability\n1,2,3\n", encoding="latin-1")
    with pytest.raises(InputError, match=r"expected a CSV file in UTF-8, found .*table\.csv', which is in another encoding"):
        load_sweep(file)


def test_what_differs_between_plans_is_named() -> None:
    assert list(plan().differences(plan(duration=200.0))) == [("duration", "150.0", "200.0"), ("start", "37.5", "50.0")]
    assert list(plan().differences(plan())) == []


def test_cases_that_differ_are_named_by_their_key() -> None:
    """A probability by the case whose share of the life moved against those of the others."""
    rows = [{"hs": hs, "tp": 7, "probability": share} for hs, share in ((1, 4), (2, 3), (3, 2), (4, 1))]

    def apart(**changes) -> tuple[str, str, str]:
        (difference,) = plan(scatter=rows, headings=[0, 30]).differences(
            plan(**({"scatter": rows, "headings": [0, 30]} | changes))
        )
        return difference

    assert apart(scatter=rows[:3]) == ("scatter", "4 sea states", "3")
    before, now = (f"heading {heading} deg, with 50.0000% of the life" for heading in (30, 40))
    assert apart(headings=[0, 40]) == ("headings", before, now)
    weighed = [{"heading": 0, "probability": 1}, {"heading": 30, "probability": 3}]
    assert apart(headings=weighed) == ("headings", before, "heading 30 deg, with 75.0000% of the life")
    changed_rows = [*rows[:2], rows[2] | {"gamma": 3}, rows[3]]
    before, now = (f"Hs 3 m, Tp 7 s{gamma}, with 20.0000% of the life" for gamma in ("", ", gamma 3"))
    assert apart(scatter=changed_rows) == ("scatter", before, now)
    changed_rows = [*rows[:2], rows[2] | {"probability": 12}, rows[3]]
    assert apart(scatter=changed_rows) == ("scatter", before, "Hs 3 m, Tp 7 s, with 60.0000% of the life")


# --- notes


def test_the_share_of_a_spectrum_in_the_band_is_that_of_its_seas() -> None:
    """By the components of a sea, and in closed form for Pierson and Moskowitz: m0 below f goes with exp(-5/4 (fp / f)^4)."""
    seas = [{"hs": 0.5, "tp": 3}, {"hs": 3, "tp": 9, "gamma": 2}, {"hs": 3, "tp": 9, "gamma": 5}]
    made = plan(scatter=seas, headings=[0, 90], cutoff=0.3, duration=3600.0)
    shares = shares_in_band(made)
    assert shares.shape == (6,) and (shares[::2] == shares[1::2]).all()
    for case, share in zip(made.cases[::2], shares[::2]):
        waves = jh.spectrum_components(
            lambda w, case=case: jh.jonswap(w, case.hs, case.tp, case.gamma),
            3600.0,
            jh.Environment(),
            low=0.03,
            cutoff=0.3,
            seed=0,
        )
        assert float((waves.amplitude**2 / 2).sum()) == pytest.approx(share * case.hs**2 / 16)
    smooth = plan(scatter=[{"hs": 0.5, "tp": 3}, {"hs": 3, "tp": 9}], spectrum="pierson_moskowitz", cutoff=0.3, duration=3600.0)
    below = [math.exp(-1.25 / (f * tp) ** 4) for tp in (3, 9) for f in (0.03, 0.3)]
    assert shares_in_band(smooth) == pytest.approx([below[1] - below[0], below[3] - below[2]], rel=5e-3)


def noted(made: Plan, model) -> list[str]:
    """What is noted of a sweep's seas; where some cannot be, that first."""
    setup = Setup(made, model, np.arange(0.0, made.duration, 0.5), 0.25, None)
    return list(notes(made, model, shares_in_band(made), impossible(setup)))


def test_what_simulate_notes_of_a_sea_is_noted_of_a_sweep() -> None:
    model = jh.load_model("volturnus-s")
    quiet = [{"hs": 2, "tp": 8}, {"hs": 3, "tp": 9}]
    usual = {"cutoff": 0.3, "order": 2, "duration": 600.0}
    assert noted(plan(scatter=quiet, **usual), model) == []
    made = plan(scatter=[*quiet, {"hs": 0.5, "tp": 3}, {"hs": 9, "tp": 14}], headings=[0, 90], **usual)
    cut, high = noted(made, model)
    assert cut.startswith("in 1 of 4 sea states less than 95% of the spectrum lies from 0.03 to 0.3 Hz")
    assert "least in Hs 0.5 m, Tp 3 s, 12.6% or Hs 0.177 m" in cut
    assert "in 1 of 4 sea states below 0.3 Hz, at 0.24 Hz in Hs 9 m, Tp 14 s" in high
    (named,) = noted(plan(scatter=[{"hs": 0.5, "tp": 3, "gamma": 2}], **usual), model)
    assert named.startswith("in the only sea state less than") and "least in Hs 0.5 m, Tp 3 s, gamma 2, " in named
    assert not noted(plan(scatter=[{"hs": 9, "tp": 14}], **usual | {"order": 1}), model)
    bare = SimpleNamespace(
        cylinders=None, conventions=jh.Conventions(diffraction="ramp"), environment=model.environment, pace=1.0
    )
    (note,) = noted(plan(scatter=quiet, **usual), bare)
    assert note == "no member of this platform diffracts waves: 1 + Ca everywhere"


def test_sea_states_that_cannot_be_are_told_before_they_run() -> None:
    """Once each, whatever their headings and seeds; nothing else is noted of them."""
    rows = [{"hs": 2, "tp": 8, "probability": 90}, {"hs": 30, "tp": 9, "probability": 4}, {"hs": 1, "tp": 1, "probability": 6}]
    (note,) = noted(plan(scatter=rows, headings=[0, 40], cutoff=0.3), jh.load_model("volturnus-s"))
    assert note.startswith(
        "2 of 3 sea states, 10.00% of the life, cannot be, and the runs fail. They are Hs 30 m, Tp 9 s (expect"
    )
    assert "break above" in note and note.endswith(" and 1 more")


@pytest.mark.parametrize(("order", "cutoff"), [(1, 0.3), (2, 0.3), (1, 0.55)])
def test_supports_are_counted_as_a_sea_has_them(order, cutoff) -> None:
    """Of the heading along which the hull is longest; and a run's memory goes by them."""
    model, made = jh.load_model("volturnus-s"), plan(order=order, cutoff=cutoff, headings=[0, 50])
    setup = Setup(made, model, np.arange(0.0, made.duration, 0.5), largest_step(model, cutoff), None)
    seas = [prepared_for(model, sea_of(setup, made.run(8 * row)), setup.times, setup.limit)[0] for row in (0, 1)]
    assert supports_of(setup) == max(sea.wavenumber.size for sea in seas)
    size = max(sea.series.nbytes for sea in seas)
    assert 2.4 * size < bytes_of_run(setup) < 5 * size


def test_gpus_are_shared_by_workers(monkeypatch) -> None:
    """Whatever CUDA calls them; a share of the memory holds a power of two of runs, no worker starts without work."""
    setup = Setup(plan(), jh.load_model("volturnus-s"), np.arange(0.0, 150.0, 0.5), 0.25, None)
    size = bytes_of_run(setup)
    memory = {"bytes_limit": 100 * size}
    gpus = [SimpleNamespace(platform="gpu", memory_stats=lambda: memory)] * 2
    monkeypatch.setattr("jax.local_devices", lambda: gpus)
    monkeypatch.setattr("os.sched_getaffinity", lambda _: range(16), raising=False)
    monkeypatch.delenv("CUDA_VISIBLE_DEVICES", raising=False)
    how = chosen(setup, 1000, None, None)
    assert (how.workers, how.batch, how.devices) == (8, 8, tuple("01010101"))  # 0.6 of 100 runs' memory, by four
    monkeypatch.setenv("CUDA_VISIBLE_DEVICES", "3,5")
    assert chosen(setup, 1000, 3, None)[:3] == (3, 16, ("3", "5", "3"))
    assert chosen(setup, 5, None, None)[:3] == (5, 1, ("3", "5", "3", "5", "3"))
    assert chosen(setup, 1000, None, 300)[:3] == (4, 300, ("3", "5", "3", "5"))


@pytest.mark.parametrize(("order", "cutoff"), [(1, 1.2), (2, 0.7), (2, 50.0)])
def test_waves_too_short_for_the_hull_are_refused(order, cutoff) -> None:
    model = jh.load_model("volturnus-s")
    setup = Setup(plan(order=order, cutoff=cutoff), model, np.arange(0.0, 150.0, 0.5), 0.01, None)
    with pytest.raises(InputError, match=rf"cutoff: expected about 0\.[68]\d? Hz or less at order {order}.* found {cutoff:g} "):
        supports_of(setup)


# --- statistics


def test_ranges_are_those_of_even_cycles_and_of_the_standards_example() -> None:
    time = np.arange(0.0, 100.0, 0.05)
    values = 3.0 * np.sin(2 * math.pi * time / 5)
    np.testing.assert_allclose(equivalent_ranges(values, (3.0, 5.0), 20.0), 6.0, rtol=2e-2)
    # ASTM E1049-85, figure 6: ranges 3, 4, 6, 8, 9 with 0.5, 1.5, 0.5, 1, 0.5 cycles
    example = np.array([-2.0, 1, -3, 5, -1, 3, -4, 4, -2])
    damage = 0.5 * 3**4 + 1.5 * 4**4 + 0.5 * 6**4 + 8**4 + 0.5 * 9**4
    assert equivalent_ranges(example, (4.0,), 10.0)[0] == pytest.approx((damage / 10) ** 0.25)
    assert equivalent_ranges(np.ones(50), (3.0,), 10.0)[0] == 0


def test_what_is_kept_of_records_leaves_the_transient_out() -> None:
    time = np.arange(0.0, 400.0, 0.5)
    values = np.where(time < 100, 50.0, 2 * np.sin(2 * math.pi * time / 10))
    summary = run_results(time, 100.0, {"wave": values, "line1": 1e6 * values}, 9.0, (3.0,), 1.0)
    assert summary.statistics[0, 1] == pytest.approx(math.sqrt(2), rel=1e-3)
    assert summary.statistics[1, 1] == pytest.approx(1e6 * math.sqrt(2), rel=1e-3)
    assert summary.density.shape == (2, len(frequencies(time[time >= 100])))
    assert (
        summary.bands[0, 1] == pytest.approx(2.0, rel=0.02)
        and np.isnan(summary.bands[0, 0])
        and np.isnan(summary.bands[1]).all()
    )
    assert summary.ranges[0, 0] == pytest.approx(4.0 * 0.1 ** (1 / 3), rel=0.02)


def test_a_life_is_its_runs_weighed_by_their_probability() -> None:
    rng = np.random.default_rng(0)
    p, deviation, most = np.array([0.5, 0.3, 0.2]), rng.uniform(1, 2, (3, 4)), rng.uniform(3, 9, (3, 4))
    ranges = rng.uniform(1, 2, (3, 4, 2))
    life = lifetime(p, deviation, deviation, -most, most, ranges, np.array([3.0, 10.0]))
    assert life.mean == pytest.approx(p @ deviation.mean(axis=1))
    assert life.standard_deviation == pytest.approx(math.sqrt(p @ (deviation**2).mean(axis=1)))
    assert life.ranges[1] == pytest.approx((p @ (ranges[..., 1] ** 10).mean(axis=1)) ** 0.1)
    assert (life.maximum, life.minimum) == (most.max(), -most.max())
    assert life.maximum_of_seed == pytest.approx(most.max(axis=0).mean())
    assert life.maximum_spread == pytest.approx(most.max(axis=0).std(ddof=1))
    by_seed = np.sqrt(p @ deviation**2)
    assert life.standard_deviation_spread == pytest.approx(by_seed.std(ddof=1))


def test_failed_runs_are_left_out_of_a_life() -> None:
    values = np.array([[1.0, 3.0], [np.nan, 5.0], [np.nan, np.nan]])
    assert weighted(np.array([0.5, 0.25, 0.25]), values) == pytest.approx((0.5 * 2 + 0.25 * 5) / 0.75)
    life = lifetime(np.array([0.5, 0.25, 0.25]), values, values, values, values, values[..., None], np.array([3.0]))
    assert life.maximum == 5 and life.minimum == 1 and math.isfinite(life.ranges[0])
    nothing = lifetime(np.ones(1), *(np.full((1, 2), np.nan),) * 4, np.full((1, 2, 1), np.nan), np.array([3.0]))
    assert all(np.isnan(value).all() for value in nothing)


def test_exceedance_goes_by_probability() -> None:
    x, p = exceedance(np.array([0.5, 0.3, 0.2]), np.array([2.0, 5.0, 1.0]))
    assert x.tolist() == [1, 2, 5] and p == pytest.approx([1.0, 0.8, 0.3])


def test_the_scatter_diagram_has_a_mark_per_sea_state() -> None:
    """Headings of one sea state are one mark, coloured by the weighted mean square of what is known."""
    hs, tp = np.array([1.0, 1.0, 2.0]), np.array([5.0, 5.0, 8.0])
    figure = scatter_figure(hs, tp, np.array([0.2, 0.6, 0.2]), np.array([1.0, 2.0, np.nan]), "surge", "t")
    marks = figure.axes[0].collections
    assert sorted(np.concatenate([mark.get_array() for mark in marks if mark.get_array() is not None]).data) == pytest.approx(
        [math.sqrt((0.2 * 1 + 0.6 * 4) / 0.8)]
    )
    assert len(marks) == 2 and {text.get_text() for text in figure.axes[0].texts} == {"80 %", "20 %"}
    figure = scatter_figure(hs[2:], tp[2:], np.array([1.0]), np.array([1.0]), "surge", "t")
    assert [text.get_text() for text in figure.axes[0].texts] == ["100 %"]


def test_the_exceedance_figure_has_a_line_per_seed_and_one_of_all_on_both_sides() -> None:
    values = np.array([[1.0, 2.0], [3.0, np.nan]])
    figure = exceedance_figure(["surge (m)"], [-2 * values], [values], np.array([0.9, 0.1]), 100.0, "t")
    lines = figure.axes[0].lines
    assert len(lines) == 6 and lines[-1].get_xdata()[-1] == 3.0 and lines[2].get_xdata()[-1] == -6.0
    assert lines[2].get_ydata() == pytest.approx(lines[-1].get_ydata())  # as rare on both sides


def test_a_sweep_makes_a_page(tmp_path: Path) -> None:
    """Statistics over the life with their units, and what failed, escaped; no figure that is not there."""
    life = {"unit": "deg", "mean": 0.5, "standard_deviation": 1.25, "damage_equivalent_range": {"3": 2.5}}
    failure = {"hs": 14.0, "tp": 9.0, "headings": [30.0], "seeds": [0, 4], "runs": 2, "reason": "a wave <b>breaks</b>"}
    options = {
        "duration": 3600.0,
        "start": 500.0,
        "time_step": 0.5,
        "step": 0.25,
        "spectrum": "jonswap",
        "low": 0.03,
        "cutoff": 0.3,
        "amplitudes": "rayleigh",
        "order": 2,
        "stretching": "vertical",
        "diffraction": "maccamy_fuchs",
        "equivalent_frequency": 0.1,
    }
    content = {
        "sweep": "s.yaml",
        "platform": "volturnus-s",
        "source": "jaxhydro 0.1.0",
        "sea_states": 2,
        "cases": 3,
        "seeds": [0, 4],
        "headings": [{"heading": 0.0, "probability": 0.75}, {"heading": 30.0, "probability": 0.25}],
        "options": options,
        "runs": {"total": 6, "done": 4, "failed": 2},
        "lifetime": {"pitch": life},
        "failures": [failure],
        "notes": ["one & all"],
        "calibration": {
            "file": "c.json",
            "values": {"column.Cd_t": 1.25},
            "sea_state_reference": {"significant_height": 2.0, "peak_period": 8.0},
        },
    }
    (tmp_path / "sweep.json").write_text(json.dumps(content))
    page = write_report(tmp_path).read_text()
    assert ">pitch (deg)</td>" in page and ">1.250</td>" in page and "Equivalent range, m = 3" in page
    assert "0 deg (75 %), 30 deg (25 %)" in page and "3600 s, of which the first 500 s are left out" in page
    assert "<li>one &amp; all</li>" in page and "c.json: column.Cd_t = 1.250; exponents count from Hs 2.00 m" in page
    assert 'content="jaxhydro 0.1.0"' in page and "and what follows is of the rest" in page
    assert "Hs 14 m, Tp 9 s, heading 30 deg, 2 seeds: a wave &lt;b&gt;breaks&lt;/b&gt;" in page
    assert "2 of 6 runs failed" in page and "<img" not in page
    (tmp_path / "sweep.json").write_text(json.dumps(content | {"runs": {"total": 6, "done": 0, "failed": 6}}))
    assert "Over the life" not in write_report(tmp_path).read_text()
    (tmp_path / "sweep.json").write_text(json.dumps(content | {"runs": {"total": 6}}))
    with pytest.raises(InputError, match=r"runs\.done"):
        write_report(tmp_path)
