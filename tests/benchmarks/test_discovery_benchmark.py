"""The public benchmark: its campaigns give nothing away, its halves are balanced, answers are scored as documented."""

import json
from collections import Counter
from pathlib import Path

import pytest
from fake_diagnosis import fake_diagnosis

from benchmarks import tank
from benchmarks.discovery import make_campaigns
from benchmarks.discovery.__main__ import main
from benchmarks.discovery.answer_file import ClaimedEffect
from benchmarks.discovery.cases import EFFECTS, HALVES, OUTSIDE, PAIRS, Case, cases
from benchmarks.discovery.run_diagnose import answer_of, diagnose_all, write_answers
from calibration.results.write_diagnosis import document

SHORT = {"surge": 12.0, "heave": 8.0, "pitch": 10.0, "sea": 12.0}  # s


def test_halves_are_stable_and_balanced():
    """By kind and strength they differ by one case at most, by strength not at all."""
    all_cases = list(cases())
    assert len(all_cases) == len(set(all_cases)) == 244
    halves = {half: [case for case in all_cases if case.half == half] for half in HALVES}
    assert not set(halves["set"]) & set(halves["report"]) and sum(map(len, halves.values())) == len(all_cases)
    kinds, strengths, kinds_and_strengths = (
        {half: Counter(map(key, half_cases)) for half, half_cases in halves.items()}
        for key in (
            lambda case: case.effect,
            lambda case: (case.effect in EFFECTS, case.strength),
            lambda case: (case.effect, case.strength),
        )
    )
    assert all(abs(kinds["set"][kind] - kinds["report"][kind]) <= 1 for kind in (*EFFECTS, *OUTSIDE, *PAIRS, ""))
    assert [strengths[half][True, strength] for half in HALVES for strength in (1, 2, 3)] == [27] * 6
    assert [kinds[half][""] for half in HALVES] == [20, 20]
    assert all(
        abs(kinds_and_strengths["set"][key] - kinds_and_strengths["report"][key]) <= 1
        for key in kinds_and_strengths["set"]
        if key[0]
    )
    names = ("umbilical-2-1", "umbilical-2-2", "wave_reflection-3-1", "current+wave_drift-2-1", "cogging-1-1", "nothing-40")
    assert [Case.of(name).half for name in names] == ["report", "set", "report", "set", "set", "set"]  # for ever


def test_names_are_stable_numbers():
    assert len({case.public_name for case in cases()}) == 244
    assert Case.of("umbilical-2-1").public_name == "campaign-385911"
    assert all(Case.of(case.name) == case for case in cases())


@pytest.mark.slow
def test_campaigns_are_made_without_answers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys):
    """In folders whose files do not say what is missing; what is there is not made again."""
    monkeypatch.setattr(tank, "DURATIONS", SHORT)
    folder, truth = tmp_path / "campaigns", tmp_path / "truth.json"
    main(["make", str(folder), "--cases", "umbilical-2-1", "--truth", str(truth)])
    case = Case.of("umbilical-2-1")
    (campaign,) = (path for path in folder.iterdir() if path.is_dir())
    assert campaign.name == case.public_name
    assert json.loads(truth.read_text()) == {
        campaign.name: {"effects": ["umbilical"], "strength": 2, "seed": 1, "half": case.half}
    }
    assert f"name: {campaign.name}\n" in (campaign / "campaign.yaml").read_text()
    words = [word for name in (*EFFECTS, *OUTSIDE, "campaign-1\n", "truth", "seed") for word in (name, name.replace("_", " "))]
    for path in folder.rglob("*"):
        assert path.is_dir() or not any(word in path.read_text() for word in words if word != "current"), path
        assert "truth" not in path.name
    before = (campaign / "campaign.yaml").stat().st_mtime_ns
    main(["make", str(folder), "--cases", "umbilical-2-1"])
    assert (campaign / "campaign.yaml").stat().st_mtime_ns == before
    monkeypatch.setattr(make_campaigns, "tank_version", lambda: "another")
    capsys.readouterr()
    with pytest.raises(SystemExit) as stopped:
        main(["make", str(folder)])
    assert stopped.value.code == 2 and "benchmark.json: tank: expected another" in capsys.readouterr().err


def claim(effect, motion=None, probability=None, alike=()):
    """An effect as a file of answers has it."""
    return {"effect": effect, "motion": motion, "probability": probability, "indistinguishable_from": list(alike)}


def answer(*effects, verdict="found", errors=None, minutes=None, considered=()):
    """An answer as a file of answers has it."""
    error = None if errors is None else dict(zip(("baseline", "final"), errors, strict=True))
    return {
        "verdict": verdict,
        "effects": list(effects),
        "considered": list(considered),
        "held_out_error": error,
        "minutes": minutes,
    }


NOTHING = answer(verdict="nothing_missing", errors=(0.1, 0.1), minutes=1.0)
ANSWERS = {
    "nothing-1": NOTHING,
    "nothing-2": answer(verdict="unexplained"),
    "nothing-3": answer(claim("current", probability=0.95)),
    "coulomb_friction-1-1": answer(verdict="nothing_missing", considered=[claim("coulomb_friction", "surge", 0.2)]),
    "coulomb_friction-2-1": answer(claim("coulomb_friction", "surge", 0.99), errors=(0.4, 0.15), minutes=3.0),
    "coulomb_friction-2-2": answer(claim("coulomb_friction", "pitch", 0.9)),  # another motion: another effect
    "hysteresis-2-1": answer(claim("coulomb_friction", None, 1.0, ["hysteresis"])),
    "current-3-1": answer(claim("umbilical"), claim("current")),
    "current+wave_drift-2-1": answer(claim("wave_drift", "surge"), claim("current")),
    "end_stop-2-1": answer(verdict="unexplained"),
    "cogging-2-1": answer(claim("hysteresis"), errors=(0.4, 0.3)),
}


@pytest.fixture
def benchmark(tmp_path: Path) -> Path:
    """A benchmark's folder with empty campaigns, one of them without an answer, and a file of answers beside it."""
    folder = tmp_path / "campaigns"
    for name in (*ANSWERS, "umbilical-2-1"):
        (folder / Case.of(name).public_name).mkdir(parents=True)
    make_campaigns.write_index(folder)
    campaigns = {Case.of(name).public_name: answer for name, answer in ANSWERS.items()}
    (tmp_path / "mine.json").write_text(json.dumps({"method": "mine", "campaigns": campaigns}))
    return folder


def scored(benchmark: Path, *options: str) -> dict:
    """The score of the answers."""
    main(["score", str(benchmark), str(benchmark.parent / "mine.json"), *options])
    return json.loads((benchmark.parent / "mine.score.json").read_text())


def test_answers_are_scored(benchmark: Path, capsys):
    result = scored(benchmark)
    counts = {
        key: {name: (cell["count"], cell["of"]) for name, cell in row.items() if isinstance(cell, dict)}
        for key, row in result["table"].items()
    }
    assert counts["answered"] == {"all": (11, 12)}
    assert counts["named_first"] == {"weak": (0, 1), "middle": (1, 4), "strong": (0, 1), "all": (1, 6)}  # no answer is wrong
    assert counts["named_or_in_set"] == {"weak": (0, 1), "middle": (2, 4), "strong": (1, 1), "all": (3, 6)}
    assert counts["right_where_named"] == {"middle": (2, 3), "strong": (1, 1), "all": (3, 4)}
    assert counts["called_another"]["middle"] == (1, 4) and counts["not_seen"]["weak"] == (1, 1)
    assert counts["both_of_two"] == {"middle": (1, 1)} and counts["false_alarms"] == {"all": (2, 3)}
    assert counts["outside_unexplained"]["middle"] == (1, 2) and counts["outside_answered"]["middle"] == (2, 2)
    assert counts["probability_0.9_1"] == {"all": (1, 4)} and counts["probability_0.1_0.3"] == {"all": (1, 1)}
    assert "probability_0.3_0.5" not in counts
    assert result["table"]["held_out_ratio"] == {
        "measure": "held-out error over that with nothing missing (median)",
        "middle": pytest.approx(2.25),  # 0.15 and 0.3 over 0.1
    }
    assert result["table"]["minutes_median"]["all"] == 2.0 and result["table"]["minutes_largest"]["all"] == 3.0
    assert result["outcomes"][Case.of("hysteresis-2-1").public_name] == "in the set"
    assert result["reliability"][-1] == {"from": 0.9, "to": 1.0, "mean": pytest.approx(0.96), "there": 1, "of": 4}
    output = capsys.readouterr().out
    assert "| missing effect named first | 0 of 1 | 1 of 4 | 0 of 1 | 1 of 6 |" in output


def test_a_part_is_scored(benchmark: Path):
    """A half, and only what is answered."""
    assert scored(benchmark, "--answered-only")["table"]["named_first"]["all"] == {"count": 1, "of": 5}
    halves = [scored(benchmark, "--half", half) for half in HALVES]
    assert sum(half_score["campaigns"] for half_score in halves) == 12 and all(half_score["half"] for half_score in halves)
    for half, half_score in zip(HALVES, halves, strict=True):
        assert set(half_score["outcomes"]) == {
            case.public_name for case in map(Case.of, (*ANSWERS, "umbilical-2-1")) if case.half == half
        }


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"method": "", "campaigns": {}}, "method: expected"),
        ({"method": "m", "campaigns": {"campaign-1": NOTHING}}, "campaigns.campaign-1: expected the name of a campaign folder"),
        ({"method": "m", "campaigns": {}}, "campaigns: expected answers"),
        ({"method": "m", "campaigns": {"x": answer(verdict="found")}}, "effects: expected one effect or more"),
        ({"method": "m", "campaigns": {"x": answer(claim("a"), verdict="nothing_missing")}}, "effects: expected none"),
        ({"method": "m", "campaigns": {"x": answer(claim("a", "up"))}}, "motion: expected"),
        ({"method": "m", "campaigns": {"x": answer(claim("a", None, 95.0))}}, "probability: expected"),
    ],
)
def test_mistakes_in_answers_are_told(benchmark: Path, capsys, change: dict, message: str):
    (benchmark.parent / "mine.json").write_text(json.dumps(change))
    with pytest.raises(SystemExit) as stopped:
        scored(benchmark)
    errors = capsys.readouterr().err
    assert stopped.value.code == 2 and "mine.json" in errors and message in errors, errors


def test_a_diagnosis_is_an_answer(benchmark: Path):
    """With its effects, errors and time, and with probabilities where it states them."""
    saved = document(fake_diagnosis()).model_dump(mode="json")
    saved["missing"]["rejected"][0]["probability"] = 0.01
    answer = answer_of(saved)
    assert answer.verdict == "found" and answer.minutes == 321.0 / 60
    assert answer.effects == [
        ClaimedEffect(effect="coulomb_friction", motion="surge", probability=0.97, indistinguishable_from=["hysteresis"])
    ]
    assert {claim.effect: claim.probability for claim in answer.considered} == {"current": 0.01, "hysteresis": 0.02}
    assert answer.held_out_error.final < answer.held_out_error.baseline
    write_answers(benchmark.parent / "mine.json", {Case.of("hysteresis-2-1").public_name: answer})
    assert scored(benchmark, "--answered-only")["table"]["named_or_in_set"]["all"] == {"count": 1, "of": 1}


@pytest.mark.slow
def test_complete_diagnoses_are_not_run_again(tmp_path: Path):
    """A command that fails is told, with its last message; what an earlier run completed is taken."""
    done = tmp_path / "results" / "done"
    done.mkdir(parents=True)
    (done / "diagnosis.json").write_text(json.dumps(document(fake_diagnosis()).model_dump(mode="json")))
    outcomes = dict(diagnose_all(tmp_path / "no-campaigns", ["done", "absent"], tmp_path / "results", 1))
    assert outcomes["done"].effects[0].effect == "coulomb_friction"
    assert outcomes["absent"].startswith("exit status 2: ") and "absent" in outcomes["absent"]
