"""Results in one sentence, and what is said once: from values to words, without a fit."""

from dataclasses import replace
from typing import Any

import pytest

from calibration.campaign.finding import Finding
from calibration.campaign.grouped_findings import group_findings
from calibration.formatting import counted, percent_span, readable_unit
from calibration.report import tables
from calibration.report.summary import CalibrationSummary, calibration_sentence, summary_of
from calibration.report.sweep_page import SweepSummary, sweep_sentence
from calibration.results.calibration_file import CalibrationFile
from calibration.results.uncertainty_file import IntervalSummary, interval_sentence


def error(relative: float, scored: bool = True) -> dict[str, Any]:
    return {"rmse": relative, "unit": "m", "relative": relative, "in_objective": scored}


def coefficient(value: float = 1.0, sd: float | None = 0.1, **changes: Any) -> dict[str, Any]:
    return {"value": value, "standard_deviation": sd, "unit": "-", "start": 1.0, "identifiable": sd is not None} | changes


def saved(
    tests: dict[str, tuple[str, str, dict[str, Any]]],
    parameters: dict[str, dict[str, Any]],
    converged: bool = True,
    **changes: Any,
) -> CalibrationFile:
    """A calibration.json: tests by id as (kind, use, error)."""
    return CalibrationFile.model_validate(
        {
            "campaign": "basin",
            "jaxhydro": "0",
            **changes,
            "baseline": {
                "parameters": parameters,
                "error": {id: {"use": use, **row} for id, (_, use, row) in tests.items()},
                "objective": {"fit": 1.0},
                "converged": converged,
            },
            "tests": {id: {"use": use, "kind": kind} for id, (kind, use, _) in tests.items()},
        }
    )


def said(content: CalibrationFile) -> str:
    return calibration_sentence(summary_of(content))


SURE = {"a": coefficient(), "b": coefficient()}
LOW, HIGH = {"surge": error(0.004), "pitch": error(0.3, scored=False)}, {"heave": error(0.0171)}


def test_decays_that_are_followed_and_coefficients_that_are_determined() -> None:
    """Motions that do not count in the fit are left aside."""
    fitted = {"s": ("decay", "fit", LOW), "h": ("decay", "fit", HIGH)}
    assert said(saved(fitted, SURE)) == "2 decays followed to 0.4-1.7 %; all 2 coefficients determined."
    held = fitted | {"p": ("decay", "holdout", {"pitch": error(0.021)}), "x": ("decay", "ignore", {"pitch": error(9.0)})}
    assert said(saved(held, {"a": coefficient()})) == (
        "2 decays followed to 0.4-1.7 %; 1 held-out decay followed to 2.1 %; a determined."
    )


def test_coefficients_that_are_not_determined_are_named_while_they_are_few() -> None:
    tests = {"s": ("decay", "fit", LOW)}
    parameters = SURE | {"c": coefficient(sd=None), "d": coefficient(sd=None, at_bound=True)}
    expected = "1 decay followed to 0.40 %; 2 of 4 coefficients determined; not determined: c; at a bound: d."
    assert said(saved(tests, parameters)) == expected
    assert said(saved(tests, {"c": coefficient(sd=None)})) == "1 decay followed to 0.40 %; c not determined."
    assert said(saved(tests, {"c": coefficient(at_bound=True)})).endswith("; c is at a bound.")
    many = SURE | {name: coefficient(sd=None) for name in "cdef"}
    assert said(saved(tests, many)).endswith("2 of 6 coefficients determined; not determined: 4 coefficients.")


def test_what_went_wrong_comes_first() -> None:
    """A fit that leaves a record behind is not called unconverged as well."""
    bad = {"s": ("decay", "fit", LOW), "h": ("decay", "fit", {"heave": error(0.73)})}
    start = "The model does not follow h: RMSE 73 % of the motion. 2 decays followed"
    assert said(saved(bad, SURE, converged=False)).startswith(start)
    assert said(saved(bad, SURE)).startswith(start)  # by a robust loss, which converges all the same
    good = {"s": ("decay", "fit", LOW)}
    assert said(saved(good, SURE, converged=False)).startswith("The fit did not converge. 1 decay followed")
    lost = {f"s-{i}": ("decay", "fit", {"surge": error(0.6)}) for i in range(5)}
    assert said(saved(lost, SURE)) == "The model does not follow 5 decays: RMSE up to 60 % of the motion."


def test_waves_are_told_by_their_bands() -> None:
    """Of both signs; of regular waves the motion."""
    bands = {"surge": {"low_frequency": -0.12, "wave_frequency": 0.02}, "heave": {"wave_frequency": -0.05}}
    tests = {"sea": ("irregular", "fit", {"surge": error(0.9), "bands": bands}), "wave": ("regular", "fit", HIGH)}
    assert said(saved(tests, SURE)) == (
        "1 test in irregular waves: low-frequency energy off by 12 % and wave-frequency energy off by 2.0-5.0 %. "
        "1 test in regular waves followed to 1.7 %. All 2 coefficients determined."
    )
    far = {"sea": ("irregular", "fit", {"bands": {"surge": {"low_frequency": 1.4}}})}
    start = "The model does not follow sea: the low-frequency surge energy is off by 140 %. 1 test in irregular"
    assert said(saved(far, SURE)).startswith(start)
    farther = {"other": ("irregular", "fit", {"bands": {"heave": {"wave_frequency": 3.0}}})}
    start = "The model does not follow sea and other: the wave-frequency heave energy of other is off by 300 %."
    assert said(saved(far | farther, SURE)).startswith(start)


def test_a_fit_to_offsets_alone_has_no_tests() -> None:
    assert said(saved({}, SURE)) == "All 2 coefficients determined."
    nothing = CalibrationSummary(True, {}, {}, (), (), (), ())
    assert calibration_sentence(nothing) == "No coefficient fitted."


def test_intervals_in_one_sentence() -> None:
    all_known = IntervalSummary(True, "95 %", {"a": 0.1, "b": 0.0003}, ())
    assert interval_sentence(all_known) == "All 2 coefficients known to 0.03-10 % (95 % intervals), the least well a."
    partly_known = IntervalSummary(False, "90 %", {"a": 0.1}, ("c", "d"))
    assert interval_sentence(partly_known) == (
        "The fit did not converge. 1 of 3 coefficients known to 10 % (90 % intervals); not determined: c and d."
    )
    wide = IntervalSummary(True, "95 %", {"a": 0.002, "b": 35.5, "c": 1.9}, ())
    assert interval_sentence(wide) == (
        "1 of 3 coefficients known to 0.20 % (95 % intervals); intervals wider than twice the value: b and c."
    )
    assert interval_sentence(IntervalSummary(True, "95 %", {}, ("a",))).startswith("None of 1 coefficient has a 95 % interval")


def test_a_sweep_in_one_sentence() -> None:
    extremes = {"surge": (-2.11, 12.34, "m"), "pitch": (-1.0, 4.2, "deg")}
    expected = "All 48 runs done. Extremes over the life: surge -2.11 to 12.3 m and pitch -1.00 to 4.20 deg."
    assert sweep_sentence(SweepSummary(48, 48, extremes)) == expected
    assert sweep_sentence(SweepSummary(48, 46, {})) == "46 of 48 runs done."
    assert sweep_sentence(SweepSummary(1, 1, {})) == "1 run done."


# --- findings


def finding(test: str, message: str = "no zero", channel: str = "pitch") -> Finding:
    return Finding("warning", f"{test}.csv", test, channel, None, message)


def test_equal_warnings_are_said_once() -> None:
    """Of one channel, over tests; others as before."""
    several = [finding(f"t-{i}") for i in range(9)] + [finding("t-1", "a gap"), finding("t-1", channel="surge")]
    many, gap, surge = group_findings(several)
    assert str(many) == f"9 tests ({', '.join(f't-{i}' for i in range(8))} and t-8), channel pitch: no zero"
    assert str(gap) == str(several[9]) == "t-1.csv, test t-1, channel pitch: a gap" and str(surge) == str(several[10])
    heads, rows = tables.findings(several)
    assert heads == ("Test", "File", "Channel", "Warning")
    assert rows == [
        ("9 tests", "9 files", "pitch", "no zero"),
        ("t-1", "t-1.csv", "pitch", "a gap"),
        ("t-1", "t-1.csv", "surge", "no zero"),
    ]
    (two,) = group_findings([finding("a"), finding("b"), finding("b")])
    assert str(two) == "tests a and b, channel pitch: no zero"


def test_warnings_that_differ_by_numbers_alone_are_one() -> None:
    """With the spans of these; not where they are of an instant, nor where the digits are part of a name."""
    drift_values = (("a", -0.149), ("b", -0.0885), ("c", -0.108))
    drifts = [finding(id, f"its mean drifts by {x:.3g} m over 100 s") for id, x in drift_values]
    (group,) = group_findings(drifts)
    assert group.message == "its mean drifts by -0.149 to -0.0885 m over 100 s" and group.tests == ("a", "b", "c")
    spikes = [replace(finding(id, f"a spike at {t} s"), time=float(t)) for id, t in (("a", 10), ("b", 20), ("c", 20))]
    assert [(group.message, group.tests) for group in group_findings(spikes)] == [
        ("a spike at 10 s", ("a",)),
        ("a spike at 20 s", ("b", "c")),
    ]
    shared = [finding(id, f"the fitted test surge-{n} has samples of it") for id, n in (("a", 1), ("b", 2))]
    assert len(group_findings(shared)) == 2
    tiny = [finding(id, f"written to {x} s, 12.5 in all") for id, x in (("a", "1e-05"), ("b", "0.01"))]
    assert group_findings(tiny)[0].message == "written to 1e-05 to 0.01 s, 12.5 in all"


# --- classical damping


def test_damping_far_outside_its_interval_is_named() -> None:
    def decay(p: float, q: float) -> dict[str, Any]:
        terms = {
            name: {"measured": 1.0, "half_width": 0.1, "simulated": simulated}
            for name, simulated in (("linear", p), ("quadratic", q))
        }
        about = {"use": "fit", "kind": "decay", "file": "a.csv"}
        return about | {"linear_quadratic": {"period": 10.0, "unit": "rad", **terms}}

    content = saved({}, SURE).model_dump(mode="json", exclude_none=True)
    near = content | {"tests": {"a": decay(1.14, 0.86)}}
    assert tables.damping_outside(CalibrationFile.model_validate(near)) == ""
    far = content | {"tests": {"a": decay(1.16, 0.8), "b": decay(1.0, 2.0)}}
    sentence = tables.damping_outside(CalibrationFile.model_validate(far))
    assert (
        sentence.startswith("Far outside the measured interval: p and q of a and q of b.") and "jaxhydro diagnose" in sentence
    )
    ends = "The damping of a and b is far outside the measured interval."
    assert calibration_sentence(summary_of(CalibrationFile.model_validate(far))).endswith(ends)


# --- the truth


def test_calibrated_values_beside_true_ones() -> None:
    truth = {"a": 1.05, "b": 1.3, "c": 2.0, "d": 3.0, "e": 0.0}
    parameters = SURE | {"c": coefficient(sd=None), "e": coefficient(0.01, 0.02)}
    content = saved({}, parameters, truth=truth)
    _, rows = tables.comparison_with_truth(content)
    assert [row[0] for row in rows] == list(truth) and rows[0][4:] == ("-4.8 %", "-0.5 sd")
    assert rows[2][2:] == ("(1.00) not determined", "", "–", "–") and rows[3][2] == "not calibrated" and rows[4][4] == "–"
    assert tables.agreement_with_truth(content) == (
        "2 of 5 coefficients lie within 2 standard deviations of the true values; the farthest is 3.0 away."
    )


# --- numbers and units


@pytest.mark.parametrize(
    ("ratios", "text"),
    [
        ([0.004, 0.017], "0.4-1.7 %"),
        ([0.0004, 0.017], "0.04-1.7 %"),
        ([0.017, 0.01701], "1.7 %"),
        ([0.0], "0 %"),
        ([0.02, 1.4], "2-140 %"),
        ([5.0, 3e7], "more than 10000 %"),
    ],
)
def test_spans_of_ratios(ratios: list[float], text: str) -> None:
    assert percent_span(ratios) == text


def test_units_and_counts_as_people_read_them() -> None:
    assert [readable_unit(u) for u in ("N s2/m2", "N m s2/rad2", "kg m2", "N/m5", "N s/m", "-", "m")] == [
        "N s²/m²",
        "N m s²/rad²",
        "kg m²",
        "N/m⁵",
        "N s/m",
        "",
        "m",
    ]
    assert counted(1, "test") == "1 test" and counted(0, "test") == "0 tests" and counted(9, "test") == "9 tests"
