"""By what an effect is believed: what counts in every band, and gains in what was not fitted."""

import json
import math
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.testing import assert_allclose

from calibration.campaign.records import Record
from calibration.discovery import acceptance as acceptance
from calibration.discovery.acceptance import (
    MIN_MOTION_SHARE,
    HeldOutComparison,
    Verdict,
    assess_effect,
    reason_to_reject,
    worsened_motion,
    worsening,
)
from calibration.discovery.broyden_fit import fit
from calibration.discovery.checkpoint import _packed, _rebuilt
from calibration.discovery.diagnosis import MotionResidual, Rejected, Score
from calibration.discovery.diagnosis_conclusion import unexplained_motions
from calibration.discovery.doubts import (
    doubted_effects,
    moving_release_notes,
    outdone_effects,
    unexplained_note,
    worsened_motions,
)
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.eliminated_least_squares import minus_two_log_likelihood, symmetric_inverse
from calibration.discovery.fit_state import ResidualSummary
from calibration.discovery.frequency_bands import FourierRows, band_powers, cut_into_bands
from calibration.discovery.held_out_blocks import BLOCKS_PER_TEST, split_record
from calibration.discovery.linearisations import Linearisation, MotionSeries, Prior
from calibration.discovery.measured_series import gather_sea
from calibration.discovery.refusal import ComparedData, Refusal, RefusalKind
from calibration.discovery.reported_effects import HELD_OUT_ERROR, WAVE_ORDER
from calibration.discovery.search import AcceptedEffect, Search, SearchRecord
from calibration.discovery.selection import joint_search
from calibration.discovery.selection.joint_search import JointSearch
from calibration.discovery.selection.verification import Verification
from calibration.discovery.study import Study
from calibration.results.refusal_sentences import describe_refusal

CUT = cut_into_bands(400.0, 0.1, 4000, 14, 1.0)
TIME = 0.1 * np.arange(4000)

LITTLE = Refusal(RefusalKind.LITTLE_BIC_GAIN, (5.0, 6.0))
WORSE = Refusal(RefusalKind.WORSE_MOTION, (0.4, 0.5), "surge")


def test_powers_of_white_noise_are_its_variance_in_every_band():
    """And a sine's are all in the band that has it: n / 2 times its square."""
    white = np.mean([band_powers(CUT, np.random.default_rng(k).normal(0, 0.3, 4000)) for k in range(60)], axis=0)
    assert_allclose(white[CUT.lines > 0], 0.09, rtol=0.35)
    sine = band_powers(CUT, np.sin(2 * np.pi * 0.2 * TIME))
    band = int(np.flatnonzero((CUT.low <= 0.2) & (CUT.high > 0.2))[0])
    assert sine.argmax() == band
    assert_allclose(2 * CUT.lines[band] * sine[band], 2000.0, rtol=1e-6)


def series(channel: str, floor: float, noise: float = 0.01, spread: float = 1.0, use: str = "holdout") -> MotionSeries:
    return MotionSeries("t", "decay", use, channel, noise, spread, 2 * CUT.lines, CUT.low, CUT.high, 4000, np.full(14, floor))


def study_of(*all_series: MotionSeries) -> Study:
    """Of decays in surge."""
    records = (SimpleNamespace(id="t", degree_of_freedom="surge"),)
    cuts = (FourierRows.of([CUT] * len(all_series), 4000),)
    return Study(None, None, (), np.zeros((0, 0)), 8, None, (), all_series, records, np.zeros((0, 0)), cuts, None)  # type: ignore[arg-type]


def left(squares, error) -> ResidualSummary:
    """All in the first region; squares by degree of freedom."""
    squares_by_region = 2 * CUT.lines.sum() * np.array(squares, float)[:, None] * [1, 0, 0]
    return ResidualSummary(squares_by_region, np.array(error)[:, None] * [1, 0, 0], squares_by_region.sum(axis=1))


def test_a_quiet_sensor_does_not_make_a_motion_count_more():
    """A series' least is its floor over all bands, and its weight is by that, up to a point."""
    assert_allclose(series("surge", 0.01).floor_rms, 0.01)
    share = CUT.lines.sum() * 2 / 4000  # of the samples' degrees of freedom that is looked at
    assert_allclose(series("surge", 0.1).floor_rms, np.sqrt(0.01**2 + share * (0.1**2 - 0.01**2)))
    assert series("surge", 0.5, noise=1e-6).weight == pytest.approx(1 / (0.5 * np.sqrt(share)))
    assert series("surge", 1e-6, noise=1e-6).weight == 50.0


def test_a_test_is_about_what_moves_in_it():
    """A decay about its own motion; a sea about what moves beside others of its unit, not about sway in head waves, whose
    error may be all of it and says nothing of the model. So `unexplained_motions` is left of surge alone."""
    of_decay = [series(channel, 0.01) for channel in ("surge", "heave", "sway")]
    sizes = {"surge": 1.0, "sway": 0.1, "pitch": 0.02, "roll": 0.003, "heave": 0.3}
    of_sea = [replace(series(name, 0.01, spread=size, use="fit"), test="sea", kind="irregular") for name, size in sizes.items()]
    study = study_of(*of_decay, *of_sea)
    assert list(study.main) == [True, False, False, True, False, True, False, True]

    def left_of(channel: str) -> list[MotionResidual]:
        return [MotionResidual("sea", "fit", channel, 0.1, 0.001, 0.9, (), "")]

    under_way = SimpleNamespace(study=study)
    assert unexplained_motions(under_way, left_of("surge")) and unexplained_motions(under_way, left_of("heave"))  # type: ignore[arg-type]
    assert not unexplained_motions(under_way, [*left_of("sway"), *left_of("roll")])  # type: ignore[arg-type]
    worst = replace(left_of("heave")[0], relative=0.95)
    assert unexplained_motions(under_way, [*left_of("surge"), worst])[0] is worst  # type: ignore[arg-type]
    assert unexplained_note([Candidate("hidden_oscillator", "heave", ())], [worst]).startswith(
        "with a hidden oscillator in heave in the model, 95 % of heave is left in sea. Something else acts instead, or as well"
    )


def test_what_barely_moves_in_a_sea_weighs_nothing():
    """Sway in head waves has no degrees of freedom: damping that takes a model's own sway away would cost surge nothing."""
    rows = np.stack([np.sin(TIME), 0.05 * np.sin(0.3 * TIME), 0.02 * np.sin(TIME)])  # surge, sway, pitch
    sea = SimpleNamespace(measured=rows[None], times=TIME, dofs=(0, 1, 4), slow=0.03)
    noise = {"surge": 0.01, "sway": 0.01, "pitch": 1e-4}
    record = Record("sea", "irregular", "fit", None, TIME, {}, None, None, noise, True, 0.0, SimpleNamespace(), "sea.csv")
    all_series, cut = gather_sea(sea, [record], 0.5)  # type: ignore[arg-type]
    assert [series.channel for series in all_series] == ["surge", "sway", "pitch"]
    assert [bool(series.dof.any()) for series in all_series] == [True, False, True]
    study = Study(None, None, (), np.zeros((0, 0)), 8, None, (), tuple(all_series), (), np.zeros((0, 0)), (cut,), None)  # type: ignore[arg-type]
    errors = [cut(np.stack([0 * TIME, size * np.sin(0.3 * TIME), 0 * TIME])) for size in (0.0, 3.0)]
    assert len({float(minus_two_log_likelihood(study, error).sum()) for error in errors}) == 1
    assert list(study.main) == [True, False, True]


def errors(**motions: float) -> Any:
    """Of a model that leaves so much of motions in the held-out tests."""
    return SimpleNamespace(
        objective=lambda use, channel=None: sum(motions.values()) or None if channel is None else motions.get(channel)
    )


def test_what_something_refused_outdoes_is_in_doubt():
    """By the last round alone, and only where that let nothing in."""

    def verdict(bic: float, refused: Refusal | None) -> Verdict:
        return Verdict(bic, 0.9, True, -100.0, 30.0, 5.0, refused)

    verdicts = {"drag": verdict(335.0, LITTLE), "memory": verdict(20.0, LITTLE)}
    assert outdone_effects({"lag": 158.0, "umbilical": 1300.0}, verdicts) == {"lag": "drag"}
    assert outdone_effects({"lag": 158.0, "current": 60.0}, verdicts | {"current": verdict(40.0, None)}) == {}
    assert outdone_effects({"lag": 400.0}, verdicts) == {} == outdone_effects({"lag": 400.0}, {})
    assert outdone_effects({"mass": np.nan}, verdicts) == {}  # told though no error shows it


def test_what_was_taken_out_of_the_model_counts_among_what_was_refused():
    friction, drag = Candidate("coulomb_friction", "surge", ()), Candidate("amplitude_dependent_drag", None, ())
    memory = Candidate("radiation_memory", "pitch", ())
    good, small = Verdict(63.0, 0.6, True, 132.0, 4.0, 2.0, None), Verdict(8.0, 0.2, True, -6.0, 4.0, 2.0, LITTLE)

    def score(number: int, candidate: Candidate, verdict: Verdict | None) -> Score:
        return Score(number, candidate.effect, candidate.dof, 1.0, 1, 1.0, None, None, verdict)

    scores = [score(1, drag, good), score(2, friction, good), score(3, memory, small)]
    rejected = {memory.name: Rejected("radiation_memory", "pitch", LITTLE)}
    accepted: Any = {friction.name: SimpleNamespace(verdict=good)}
    fits: Any = SimpleNamespace(study=SimpleNamespace(order_hint=""))
    search = Search(fits, SearchRecord(scores, rejected, accepted=accepted))
    state: Any = SimpleNamespace(chosen=(friction,))
    assert doubted_effects(search, state, errors(), errors()) == {}  # type: ignore[arg-type]
    taken_out = small._replace(bic=350.0, refused=LITTLE)
    rejected[drag.name] = Rejected(drag.effect, None, LITTLE, taken_out)
    assert doubted_effects(search, state, errors(), errors()) == {friction.name: drag.name}  # type: ignore[arg-type]


def test_what_is_in_doubt_for_what_was_not_fitted():
    """Everything where the held-out error is larger with it, or what acts in the motion that has it."""
    good = Verdict(63.0, 0.6, True, 132.0, 4.0, 2.0, None)
    drift, friction = Candidate("wave_drift", "pitch", ()), Candidate("coulomb_friction", "surge", ())
    accepted: Any = {candidate.name: SimpleNamespace(verdict=good) for candidate in (drift, friction)}
    fits: Any = SimpleNamespace(study=SimpleNamespace(order_hint=""))
    search = Search(fits, SearchRecord(accepted=accepted))
    state: Any = SimpleNamespace(chosen=(drift, friction))
    assert doubted_effects(search, state, errors(surge=0.3, pitch=0.1), errors(surge=0.31, pitch=0.1)) == {}  # type: ignore[arg-type]
    worse, better = errors(surge=0.38, pitch=0.1), errors(surge=0.1, pitch=0.13)
    doubts = {drift.name: HELD_OUT_ERROR, friction.name: HELD_OUT_ERROR}
    assert doubted_effects(search, state, errors(surge=0.3, pitch=0.1), worse) == doubts  # type: ignore[arg-type]
    of_motion = doubted_effects(search, state, errors(surge=0.3, pitch=0.1), better)  # type: ignore[arg-type]
    assert of_motion == {drift.name: HELD_OUT_ERROR}
    fits.study.order_hint = "records have no second order"
    assert doubted_effects(search, state, errors(), errors()) == {drift.name: WAVE_ORDER}  # type: ignore[arg-type]


def test_a_decay_that_begins_in_motion_is_told_where_that_matters():
    """To what has a memory, which is at rest at the first sample whatever was before."""
    study = SimpleNamespace(
        decays=SimpleNamespace(data=SimpleNamespace(dofs=(0, 4))),
        decay_records=[SimpleNamespace(id=name, degree_of_freedom="pitch") for name in ("late", "released")],
    )
    own = np.zeros((2, 3, 2))
    own[:, 0, 1], own[:, 1, 1], own[:, 1, 0] = 1.0, [0.5, 0.05], 9.0  # positions, rates over them; surge drifts
    point = SimpleNamespace(own=own.reshape(2, -1))
    swings, rubs = Candidate("hidden_oscillator", "pitch", ()), Candidate("coulomb_friction", "pitch", ())

    def told(*chosen: Candidate) -> list[str]:
        return moving_release_notes(
            SimpleNamespace(study=study), SimpleNamespace(chosen=chosen, linearisation=SimpleNamespace(point=point))
        )  # type: ignore[arg-type]

    assert told(rubs) == []
    (note,) = told(rubs, swings)
    assert note.startswith("late begins in motion. A hidden oscillator in pitch has a memory")


def test_no_step_is_taken_to_where_a_test_diverges_that_is_not_fitted(monkeypatch):
    """What is left out in turn diverges for a parameter that the rest would have: the fit stays short of it, and finite."""
    study = study_of(series("surge", 0.01, use="fit"), replace(series("surge", 0.01), test="u"))
    (rows,) = study.cuts
    sine = np.sin(2 * np.pi * 0.2 * TIME)

    def residual(x: float) -> np.ndarray:
        return rows(np.stack([(1.0 - x) * sine, sine if x < 0.5 else 1e120 * sine]))

    moving = SimpleNamespace(
        x=np.zeros(1), own=np.zeros((0, 0)), moved=lambda directions, step, own: SimpleNamespace(x=step, own=own, moved=None)
    )
    study = replace(study, directions=np.eye(1), decay_records=(), own_width=np.zeros((0, 0)))
    linearisation = Linearisation(moving, (0,), residual(0.0), -rows(np.stack([sine, 0 * sine]))[:, None], np.zeros((0, 0)))  # type: ignore[arg-type]
    monkeypatch.setattr(Study, "residual", lambda self, point: residual(float(point.x[0])))
    monkeypatch.setattr(Study, "logarithmic", np.array([False]))
    monkeypatch.setattr(Study, "limits", np.array([[-np.inf, np.inf]]))
    monkeypatch.setattr(Study, "steps", lambda self, x: np.asarray(x))
    monkeypatch.setattr(Study, "spans", ())
    fitted = fit(study, linearisation, np.array([True, False]), Prior(np.zeros(1), np.full(1, 30.0)), iterations=1)
    assert np.isfinite(fitted.linearisation.residual).all() and fitted.linearisation.point is moving


def test_what_is_left_is_a_root_mean_square():
    """Of a residual that is a sine of 0.2 m: 0.2 / sqrt(2), less what the floor hides."""
    study = study_of(series("surge", 1e-4))
    (rows,) = study.cuts
    summary = ResidualSummary.of(study, rows(0.2 * np.sin(2 * np.pi * 0.2 * TIME)[None]))
    assert_allclose(summary.error, 0.2 / np.sqrt(2), rtol=1e-4)
    assert ResidualSummary.of(study, rows(0.5e-4 * np.ones((1, 4000)) / np.sqrt(4000))).squares.max() == 0.0


def test_gain_is_of_what_is_asked():
    """The held-out motion's error halves, the other's is as it was: a gain of three quarters of its square."""
    study = study_of(series("surge", 0.01), series("surge", 0.01, use="fit"))
    before, after = left([400, 400], [0.2, 0.2]), left([100, 400], [0.1, 0.2])
    grounds = HeldOutComparison(study, np.array([True, False]), before, after, True)
    gain, measured = grounds.error_reduction()
    assert measured
    assert gain == pytest.approx(0.75, abs=1e-3)
    assert grounds.likelihood_gain == pytest.approx(300 * 2 * CUT.lines.sum())
    assert HeldOutComparison(study, np.array([False, True]), before, after, True).error_reduction()[0] == pytest.approx(0.0)
    nothing = left([0, 0], [0, 0])
    assert HeldOutComparison(study, np.array([True, True]), nothing, nothing, True).error_reduction() == (0.0, True)
    assert HeldOutComparison(study, np.array([True, True]), nothing, nothing, False).error_reduction() == (0.0, False)


@pytest.mark.parametrize(("refused", "reason"), [(None, WORSE), (Refusal(RefusalKind.NEGLIGIBLE), WORSE), (LITTLE, LITTLE)])
def test_that_an_effect_hardly_matters_is_said_where_nothing_else_speaks_against_it(refused, reason, monkeypatch):
    assessed = {"reason_to_reject": refused, "worsened_motion": WORSE, "significance": 9.0, "dispersion_of": 1.0}
    for name, value in assessed.items():
        monkeypatch.setattr(acceptance, name, lambda *_, value=value: value)
    study = SimpleNamespace(used=np.array([True]))
    state = SimpleNamespace(likelihood=np.zeros(1), summary=None, linearisation=SimpleNamespace(point=SimpleNamespace(x=None)))
    grounds = SimpleNamespace(
        error_reduction=lambda: (0.5, True), likelihood_gain=20.0, relevance=lambda: 0.5, unseen=True, study=study
    )
    assert assess_effect(study, state, state, Candidate("a", None, ("a",)), None, 100.0, grounds).refused == reason


def test_an_effect_with_which_its_own_motion_is_followed_worse_is_refused():
    """By J of it, of all tests and of those held out, and by what matters; other motions are no matter of it. One of no single
    motion by J of all."""
    of_sea = replace(series("heave", 0.01), test="sea", kind="irregular")
    study = study_of(series("surge", 0.01, spread=2.0), of_sea, series("surge", 0.01, use="fit"))

    def refused(dof: str | None, *after: float) -> str:
        refusal = worsened_motion(study, dof, left([1, 1, 1], [0.8, 0.1, 0.1]), left([1, 1, 1], after))
        return describe_refusal(refusal) if refusal else ""

    assert refused("surge", 0.5, 0.9, 0.1) == "" == refused("surge", 0.82, 0.1, 0.1) == refused("pitch", 2.0, 2.0, 2.0)
    message = "surge is followed worse with it (J of it in {}: {} without it, {} with it)"
    assert refused("surge", 0.6, 0.1, 0.22) == message.format("all tests", "0.500", "0.520")
    assert refused("surge", 0.84, 0.1, 0.01) == message.format("the held-out tests", "0.400", "0.420")
    assert refused("surge", 0.6, 0.1, 0.21) == "" and refused("heave", 0.1, 0.12, 0.1)
    assert refused(None, 0.2, 0.3, 0.1) == "" != refused(None, 0.6, 0.32, 0.1)
    assert refused(None, 0.9, 0.1, 0.01).startswith("what moves is followed worse with it (J in the held-out tests: 0.500")


def test_what_is_followed_worse_is_counted_in_what_matters():
    """By a share of the motion or the floor, the larger; a motion that its test is not about is left out."""
    study = study_of(series("surge", 0.01, spread=2.0), series("surge", 0.1, noise=0.1), series("surge", 0.01))
    worse_by = worsening(study, left([1, 1, 1], [0.2, 0.2, 0.2]), left([1, 1, 1], [0.26, 0.3, 0.1]))
    assert_allclose(worse_by, [0.06 / (MIN_MOTION_SHARE * 2.0), 1.0, -0.1 / MIN_MOTION_SHARE])
    quiet = SimpleNamespace(series=study.series, main=np.array([False, True, True]))
    assert worsening(quiet, left([1, 1, 1], [0, 0, 0]), left([1, 1, 1], [9, 0, 0]))[0] == 0


def test_what_is_followed_worse_at_the_end_is_told():
    study = study_of(series("surge", 0.01), series("surge", 0.01), series("surge", 0.01))
    (note,) = worsened_motions(study, left([1, 1, 1], [0.2, 0.2, 0.2]), left([1, 1, 1], [0.1, 0.3, 0.201]))
    assert note.startswith("surge of ") and "30 % of the motion is left, 20 % before" in note


@pytest.mark.parametrize(("worse", "refused"), [(0.5, "drift"), (0.1, None)])
def test_an_effect_that_makes_a_test_worse_than_declared_is_refused(worse, refused):
    """The one without which that test is followed best, and only where it is the reason."""
    study = study_of(series("surge", 0.01), series("surge", 0.01))
    verdict = Verdict(50.0, 0.5, True, 50.0, 9.0, 9.0, None)

    def state(*error: float) -> SimpleNamespace:
        return SimpleNamespace(summary=left([1, 1], error))

    accepted = {
        name: AcceptedEffect(1.0, before, None, verdict, (), 1.0, np.zeros(2))
        for name, before in {"memory": state(0.9, worse), "drift": state(0.9, 0.1)}.items()
    }
    fits: Any = SimpleNamespace(study=study)
    joint: Any = None
    record = SearchRecord(accepted=accepted)
    Verification(Search(fits, record), joint).refuse_worsening(state(0.9, 0.1), state(0.1, worse))
    assert [name for name, effect in record.accepted.items() if effect.verdict.refused] == ([refused] if refused else [])
    if refused:
        reason = describe_refusal(record.accepted["drift"].verdict.refused)
        left_over = "50.0 % of the motion is left with it, 10.0 % in the baseline"
        assert reason == f"surge of t is followed worse with it ({left_over})"


@pytest.mark.parametrize(
    ("refused", "passes", "remaining"),
    [
        ([set()], ["abc"], "abc"),
        ([{"a"}, set()], ["abc", "bc"], "bc"),
        ([{"a", "b"}, set(), set()], ["abc", "b", "bc"], "bc"),  # b is no longer in doubt, and all are tried at the end
        ([{"a", "b"}, {"b"}, set()], ["abc", "b", "c"], "c"),
        ([{"a", "b"}, set(), {"c"}, set()], ["abc", "b", "bc", "b"], "b"),
        ([{"a", "b", "c"}, {"b", "c"}, {"c"}], ["abc", "bc", "c"], ""),
    ],
)
def test_effects_in_doubt_are_tried_again_and_all_at_the_end(refused, passes, remaining):
    """After an effect has gone only those that were refused beside it are tried; then all, from a fit to convergence."""
    passes_run: list[str] = []

    class Effect(NamedTuple):
        name: str
        effect: str = "memory"
        dof: str | None = None

    @dataclass(frozen=True)
    class State:
        chosen: tuple[Effect, ...]

    def state(names: str) -> Any:
        return State(tuple(Effect(name) for name in names))

    def verdict(effect: Effect, refused: bool) -> Verdict:
        reason = Refusal(RefusalKind.IMPROBABLE, (0.1,)) if refused else None
        return Verdict(float(ord(effect.name)), 0.5, True, 50.0, 9.0, 9.0, reason)

    class Scripted(Verification):
        def without_unsupported(self, baseline, reached):
            return reached

        def refuse_worsening(self, baseline, reached):
            assert {effect.after.chosen for effect in self.record.accepted.values()} == {reached.chosen}

        def refit_all(self, reached):
            return reached

        def reject_others(self, reached):
            pass

        def evidence(self, baseline, reached, effects):
            passes_run.append("".join(effect.name for effect in effects))
            now = refused[len(passes_run) - 1]
            accepted = {}
            for effect in effects:
                without = State(tuple(other_effect for other_effect in reached.chosen if other_effect != effect))
                accepted[effect.name] = AcceptedEffect(
                    1.0, without, reached, verdict(effect, effect.name in now), (), 1.0, np.zeros(2)
                )
            return accepted

    nothing: Any = None
    record = SearchRecord()
    reached = Scripted(Search(nothing, record), nothing).run(state(""), state("abc"))
    assert "".join(sorted(effect.name for effect in reached.chosen)) == remaining
    assert passes_run == passes and set(record.rejected) == set("abc") - set(remaining)


@pytest.mark.parametrize(
    ("selected", "remaining", "required"),
    [
        (["a", "ab", "ab"], "ab", ["", "", ""]),  # the set stays
        (["ab", "ac", "ab"], "ab", ["", "", ""]),  # two sets in turn: what two of three have
        (["ab", "abc", "bd", "abe", "abf", "abg"], "ab", ["", "", "", "ab", "ab", "ab"]),  # the last round: what most have
        (["a", "ab", "bc", "abd", "abd"], "abd", ["", "", "", "ab", "ab"]),  # beside what stays the set stays
        (["l", "bl", "ab", "abd", "abd"], "abd", ["", "", "", "b", "ab"]),  # the laboratory alone, at first, does not count
        (["a", ""], "a", ["", ""]),  # nothing at all: verification decides
    ],
)
def test_where_sets_alternate_the_effects_that_most_of_them_have_are_kept(monkeypatch, selected, remaining, required):
    class Effect(NamedTuple):
        name: str

        @property
        def effect(self) -> str:
            return "sensor_lag" if self.name == "l" else self.name

    @dataclass(frozen=True)
    class State:
        chosen: tuple[Effect, ...]

    names, rounds, required_sets = "abcdefgl", iter(selected), []

    def subset(chosen: str) -> Any:
        return SimpleNamespace(variants=tuple(names.index(name) for name in chosen), evidence=float(len(chosen)))

    class Scripted(JointSearch):
        def __init__(self) -> None:
            self.fits: Any = SimpleNamespace(refit_from=lambda state, *_: state)
            self.columns = SimpleNamespace(variants=[Effect(name) for name in names])
            fitted = {fitted_subset.variants: fitted_subset for fitted_subset in map(subset, [*selected, *names])}
            self.selector = SimpleNamespace(fitted=fitted, subset=lambda variants: subset("".join(names[i] for i in variants)))

        def with_split_modes(self, baseline):
            return None

        def select(self, state, number, required):
            required_sets.append("".join(sorted(required)))
            return subset(next(rounds))

        def as_predicted(self, state, subset_fit):
            return False

    def fit_subset(fits, state, columns, subset_fit, *_):
        return State(tuple(Effect(names[i]) for i in subset_fit.variants))

    monkeypatch.setattr(joint_search, "fit_subset", fit_subset)
    states: Any = [State(())]
    state = Scripted().run(states, states.append)
    assert "".join(effect.name for effect in state.chosen) == remaining and next(rounds, None) is None
    assert required_sets == required


def test_gain_in_waves_is_where_an_effect_acts():
    """Slow motion of one test halves, waves are as before: a gain of three quarters, of what is slow; none where another test
    becomes worse by as much."""
    sea_series = replace(series("surge", 0.01), kind="irregular", slow=0.3)
    study = study_of(sea_series, sea_series)
    dof = study.by_region(study.pooled)
    assert (dof[0, 1:] > 4).all()
    before = 400 * dof
    for factor, expected in ((0.25, 0.75), (4.0, 0.0)):
        after = before * [[1, 0.25, 1], [1, factor, 1]]
        two = (ResidualSummary(squares, np.sqrt(squares), squares.sum(axis=1)) for squares in (before, after))
        assert HeldOutComparison(study, np.array([True, True]), *two, True).error_reduction()[0] == pytest.approx(
            expected, abs=2e-3
        )


@pytest.mark.parametrize(("channel", "least"), [("surge", MIN_MOTION_SHARE), ("pitch", 0.3)])
def test_what_matters_of_a_decay(channel, least):
    """Its own motion: a share of it; of another the floor alone is a measure, here 0.1."""
    study = study_of(series(channel, 0.1, noise=0.1))
    for share, matters in ((0.99, False), (1.01, True)):
        after = 0.5 - share * least
        grounds = HeldOutComparison(study, np.array([True]), left([1], [0.5]), left([1], [after]), True)
        assert (grounds.relevance() >= 1) == matters


def test_what_matters_in_a_fitted_test_alone_matters():
    """A small release shows friction, and a large one that is held out hardly does."""
    study = study_of(series("surge", 0.1, use="fit"), series("surge", 0.1))
    before, after = left([1, 1], [0.5, 0.5]), left([0, 1], [0.5 - 1.01 * MIN_MOTION_SHARE, 0.5])
    assert HeldOutComparison(study, np.array([False, True]), before, after, True).relevance() >= 1
    assert HeldOutComparison(study, np.array([False, True]), before, before, True).relevance() == 0.0


@pytest.mark.parametrize(
    ("numbers", "where", "reason_words"),
    [
        ({"bic": 9, "net": 60}, ComparedData.HELD_OUT, ""),
        (
            {"bic": 9, "net": 60},
            ComparedData.FITTED,
            "too little in the fitted tests (BIC +9, 30 are asked where nothing held out can tell)",
        ),
        (
            {"bic": 9, "net": 60},
            ComparedData.BLOCKS,
            "too little in the fitted tests (BIC +9, 30 are asked where nothing held out can tell)",
        ),
        ({"bic": 5, "net": 60}, ComparedData.HELD_OUT, "too little in the fitted tests (BIC +5, 6 are asked)"),
        ({"bic": 9, "net": 15}, ComparedData.HELD_OUT, "in fitted and held-out tests together (BIC +9, -2 ln L -15)"),
        ({"bic": 43, "net": -197}, ComparedData.HELD_OUT, "do not gain by it (-2 ln L +197)"),
        ({"bic": 43, "net": -197, "held": 0.0}, ComparedData.HELD_OUT, "squared error of the held-out tests falls by 0 % only"),
        ({"bic": 43, "held": -1.42}, ComparedData.HELD_OUT, "squared error of the held-out tests grows by 142 %"),
        ({"bic": 43, "held": 0.1}, ComparedData.BLOCKS, "squared error of the blocks left out in turn falls by 10 % only"),
        ({"bic": 43, "clear": 2.0}, ComparedData.HELD_OUT, "2.0 standard deviations from none"),
        ({"bic": 43, "matters": 0.9}, ComparedData.HELD_OUT, "no error falls by"),
    ],
)
def test_what_an_effect_has_to_reach(numbers, where, reason_words):
    """Little in the fitted tests is enough where tests that were not fitted agree; much is not where they do not."""
    reason = reason_to_reject(**{"held": 0.7, "net": 100.0, "clear": 6.0, "matters": 2.0, **numbers}, where=where)
    assert reason_words in describe_refusal(reason) if reason and reason_words else reason is None and not reason_words


def test_blocks_are_consecutive_and_whole():
    """No sample twice, none lost, each beginning where the one before it ends."""
    whole = Record("d", "decay", "fit", "surge", TIME, {"surge": np.sin(TIME)}, None, None, {}, True, 0.0, None, "d.csv")
    cut = split_record(whole)
    assert len(cut) == BLOCKS_PER_TEST
    assert len({block.id for block in cut}) == BLOCKS_PER_TEST
    assert_allclose(np.concatenate([block.time for block in cut]), TIME)
    assert_allclose(np.concatenate([block.values["surge"] for block in cut]), np.sin(TIME))


def test_a_parameter_that_is_very_clear_counts_beside_one_that_is_not(monkeypatch) -> None:
    """Variances of any ratio: the clear one is not taken for rounding of the other."""
    candidate = SimpleNamespace(amplitudes=("a", "b"))
    for variances in ((1.0, 1.0), (1.0, 1e-12), (1.0, 1e-20), (1e-20, 1.0)):
        covariance, steps = np.diag(variances), 5 * np.sqrt(variances)
        study = SimpleNamespace(index=lambda names: [0, 1], steps=lambda x, steps=steps: steps)
        monkeypatch.setattr(acceptance, "parameter_covariance", lambda *_, c=covariance: c)
        state = SimpleNamespace(linearisation=SimpleNamespace(active=(0, 1), point=SimpleNamespace(x=None)))
        assert acceptance.significance(study, candidate, state, None) == pytest.approx(math.sqrt(2 * 25 - 1))


def test_there_is_one_pseudo_inverse() -> None:
    """Of equations, of covariances and of what is eliminated, with the same numbers as each had by itself."""
    root = np.random.default_rng(0).normal(size=(9, 6)) * np.logspace(-6, 6, 6)
    for matrix in (root.T @ root, np.pad(root.T @ root, (0, 1)), np.zeros((2, 2))):
        scale = np.outer(*2 * [1 / np.sqrt(np.maximum(np.diag(matrix), 1e-300))])
        np.testing.assert_array_equal(
            symmetric_inverse(matrix), np.linalg.pinv(matrix * scale, rcond=1e-12, hermitian=True) * scale
        )


def test_every_reason_has_a_sentence_of_its_own():
    """And is kept as JSON: a checkpoint has it."""
    sentences = {describe_refusal(Refusal(kind, (1.0, 2.0), "drag")) for kind in RefusalKind}
    assert len(sentences) == len(RefusalKind) and all(sentences)
    for kind in RefusalKind:
        refusal = Refusal(kind, (1.0, 2.0), "drag", ComparedData.BLOCKS)
        assert _rebuilt(Refusal, json.loads(json.dumps(_packed(refusal, []))), {}, {}) == refusal
