"""Tables for narrow terminals, and answers to paths that do not exist."""

from pathlib import Path

import pytest
from fake_calibration import DEMO, small
from test_cli import RUNNER, run, small_campaign

import jaxhydro as jh
from calibration.report import tables
from calibration.results.calibration_file import read_saved
from calibration.results.write_calibration import write_calibration
from jaxhydro.cli import app as cli
from jaxhydro.cli import console
from jaxhydro.cli.campaign_commands import TRUTH
from jaxhydro.cli.console import column_widths, table
from jaxhydro.errors import suggest_path
from jaxhydro.platform.schema import builtin_platforms

NAMES = list(builtin_platforms())


def printed(width: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], *what, left: int = 1) -> str:
    monkeypatch.setattr(console, "WIDTH", width)
    table("A table", *what, left=left)
    return capsys.readouterr().out


def test_columns_are_narrowed_between_words() -> None:
    columns = [["Name", "surge-decay-1"], ["Remark", "a long remark about it"], ["Value", "1.25"]]
    assert column_widths(columns, 100) == [13, 22, 5]
    assert column_widths(columns, 30) == [13, 12, 5]
    assert column_widths(columns, 10) == [5, 5, 5]  # some words are more than half the room
    assert column_widths([["Name"]], 10) == [4]


def test_platforms_keep_their_names_at_80_columns(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(console, "WIDTH", 80)
    lines = RUNNER.invoke(cli.app, ["platforms"]).output.splitlines()
    assert all(len(line) <= 80 for line in lines)
    rows = [line.split()[0] for line in lines if line.strip()]
    assert all(name in rows for name in NAMES)


def test_labels_are_whole_in_a_table_that_does_not_fit(tmp_path: Path, monkeypatch, capsys) -> None:
    saved = read_saved(write_calibration(small(), tmp_path, figures=False, truth=TRUTH))
    for what in (tables.parameters(saved), tables.comparison_with_truth(saved)):
        text = printed(80, monkeypatch, capsys, *what)
        assert max(map(len, text.splitlines())) <= 80
        assert set(saved.baseline.parameters) <= {line.split()[0] for line in text.splitlines() if line.split()}
    heads, rows = ("Label", *(f"Column{i}" for i in range(8))), [("linear_damping.B33", *["-1.2345e+06"] * 8)]
    text = printed(60, monkeypatch, capsys, heads, rows)
    assert text.splitlines()[-2].split() == list(rows[0])  # wider than the terminal, which wraps it


def test_what_fits_is_as_wide_as_before(monkeypatch, capsys) -> None:
    text = printed(80, monkeypatch, capsys, ("Motion", "Position"), [("surge (m)", "1.25")])
    assert " Motion      Position \n" in text and " surge (m)       1.25 \n" in text


# --- paths that do not exist


@pytest.fixture
def working_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    small_campaign(tmp_path / "my-campaign")
    (tmp_path / "results").mkdir()
    (tmp_path / "empty").mkdir()
    (tmp_path / "almost").mkdir()
    (tmp_path / "almost" / "campaing.yml").write_text("name: a")
    (tmp_path / "sweep.yaml").write_text("platform: volturnus-s")
    return tmp_path


CAMPAIGN = "expected a campaign's folder, or its campaign.yaml, found"
ON_CAMPAIGNS = (["calibrate"], ["diagnose"], ["uncertainty", "--calibration", "results"])
MISSING = [
    *(
        (command, name, f"{name}: {CAMPAIGN} {words}")
        for command in ON_CAMPAIGNS
        for name, words in (
            ("nowhere", "no such folder"),
            ("my-campain", "no such folder. Did you mean 'my-campaign'?"),
            ("my-campain/campaign.yaml", "no such file. Did you mean 'my-campaign/campaign.yaml'?"),
            ("empty", "a folder without campaign.yaml. `jaxhydro init NEW_FOLDER DATA_FILES` makes one."),
            ("almost", "a folder without campaign.yaml. Did you mean 'almost/campaing.yml'?"),
        )
    ),
    (["simulate"], "empty", f"empty: {CAMPAIGN} a folder without campaign.yaml. `jaxhydro init"),
    (
        ["simulate"],
        "nowhere",
        f"nowhere: expected a platform file, a built-in platform ({', '.join(NAMES)}), or a "
        "campaign's folder, found no such file or folder",
    ),
    (["simulate"], "my-campain", "found no such file or folder. Did you mean 'my-campaign'?"),
    (["simulate"], "volturnus", "found no such file or folder. Did you mean 'volturnus-s'?"),
    (["simulate"], "my-campaign/platfrm.yaml", "found no such file. Did you mean 'my-campaign/platform.yaml'?"),
    (["sweep"], "nowhere.yaml", "nowhere.yaml: expected a YAML file, found no such file"),
    (["sweep"], "sweeep.yaml", "found no such file. Did you mean 'sweep.yaml'?"),
    (
        ["report"],
        "nowhere",
        "nowhere: expected a folder that `jaxhydro simulate`, `calibrate`, `diagnose`, `uncertainty` or `sweep` wrote, "
        "found no such folder",
    ),
    (["report"], "result", "found no such folder. Did you mean 'results'?"),
]


@pytest.mark.parametrize(("command", "name", "words"), MISSING, ids=[f"{c[0]} {n}" for c, n, _ in MISSING])
def test_a_missing_path_is_told_as_what_it_is(working_folder: Path, command: list[str], name: str, words: str) -> None:
    """A folder as a folder and a file as a file, with a name that is near."""
    first, *arguments = command
    if first == "simulate" and name != "empty":
        arguments = [*arguments, "--release", "surge=1"]
    out = [] if first == "report" else ["--out", "o"]
    text = run(first, name, *arguments, *out, status=2)
    assert words in text
    assert not text.endswith("?") or "Did you mean" in words
    assert not (working_folder / "o").exists()


def test_a_missing_calibration_is_told(working_folder: Path) -> None:
    expected = "expected a calibration.json, as `jaxhydro calibrate` writes it, found"
    for name, words in (
        ("result", f"result: {expected} no such folder. Did you mean 'results'?"),
        ("results", f"results/calibration.json: {expected} no such file"),
    ):
        options = ["--release", "surge=1", "--calibration", name, "--out", "o"]
        assert words in run("simulate", DEMO / "platform.yaml", *options, status=2)


def test_paths_that_are_near(working_folder: Path) -> None:
    assert suggest_path("my-campain/heave1.csv") == ""  # the folder is near, and has no such file
    assert suggest_path("my-campain/heave-1.csv") == "Did you mean 'my-campaign/heave-1.csv'?"
    assert suggest_path(working_folder / "swep.yaml") == f"Did you mean '{working_folder / 'sweep.yaml'}'?"
    assert suggest_path("quite/another/thing") == "" and suggest_path("a\0b") == ""
    with pytest.raises(jh.InputError, match="expected a YAML file"):
        jh.load_platform("nowhere.yaml")


# --- completion


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("jaxhydro plat", ["platforms"]),
        ("jaxhydro calibrate --me", ["--method"]),
        ("jaxhydro calibrate --law ch", ["choose"]),
        ("jaxhydro calibrate --method mul", ["multistart"]),
        ("jaxhydro simulate vol", ["volturnus-s", "volturnus-s-focal"]),
        ("jaxhydro simulate my-camp", []),  # then the shell completes names of files
    ],
)
def test_shells_complete_what_is_typed(line: str, words: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    assert "--install-completion" in run("--help")
    monkeypatch.setenv("_JAXHYDRO_COMPLETE", "complete_bash")
    monkeypatch.setenv("COMP_WORDS", line)
    monkeypatch.setenv("COMP_CWORD", str(len(line.split()) - 1))
    assert RUNNER.invoke(cli.app, [], prog_name="jaxhydro").output.split() == words


@pytest.mark.parametrize("word", ["ga", "de", "cma-es", "multi"])
def test_searches_that_are_baselines_are_refused(word: str, tmp_path: Path) -> None:
    message = " ".join(
        run("calibrate", tmp_path, "--out", tmp_path / "o", "--method", word, status=2).replace("│", " ").split()
    )
    assert f"multistart expected, found '{word}'" in message and ("benchmarks.validate" in message) is (word != "multi")


def test_the_demo_says_where_it_writes() -> None:
    assert "[default: jaxhydro-demo]" in run("demo", "--help")
