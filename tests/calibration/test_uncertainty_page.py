"""The page that is made of uncertainty.json, and what is told of a file that is none."""

import json
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from matplotlib.figure import Figure
from test_cli import cache, run  # noqa: F401
from test_outputs import Page, follows

from calibration.report.write_report import write_report
from calibration.results import write_uncertainty as uncertainty_outputs
from calibration.results.result_folder import DIAGNOSIS_FILE, UNCERTAINTY_FILE
from calibration.results.uncertainty_file import UncertaintyFile
from calibration.results.write_uncertainty import write_uncertainty
from jaxhydro.errors import InputError

MASS = {
    "value": 18.4088,
    "unit": "kg m2",
    "meaning": "added mass in roll",
    "identifiable": True,
    "at_bound": False,
    "laplace": [18.1517, 18.6695],
    "white": [18.3999, 18.4176],
    "white_too_small_by": 29.2109,
    "profile": [None, 18.6676],
    "blocks": [18.2909, 18.5125],
}
DAMPING = {
    "value": 0.76541,
    "unit": "N m s/rad",
    "meaning": "linear damping in roll",
    "identifiable": False,
    "at_bound": False,
    "laplace": [0.027306, 36.393],
    "white": [0.17589, 3.6609],
    "white_too_small_by": None,
    "blocks": [0.30247, 3.7146],
}
CONTENT: dict[str, Any] = {
    "campaign": "a roll decay",
    "platform": "a tanker",
    "jaxhydro": "0.1.0",
    "calibration": "results/calibration.json",
    "level": 0.9,
    "seed": 0,
    "converged": True,
    "parameters": {"added_mass.A44": MASS, "linear_damping.B44": DAMPING},
    "profiles": {},
    "bootstrap": {"blocks": {"asked": 200, "draws": 198, "unsettled": 39, "groups": {"roll-1": 2.54}}},
    "nuts": None,
    "notes": ["the records do not determine linear_damping.B44"],
    "figures": [],
}
PARAMETERS = CONTENT["parameters"]


def alone(parameter: dict[str, Any]) -> dict[str, Any]:
    """A parameter without intervals of other ways."""
    return {key: value for key, value in parameter.items() if key not in ("profile", "blocks")}


def page_of(folder: Path, **changes: Any) -> Page:
    (folder / UNCERTAINTY_FILE).write_text(json.dumps(CONTENT | changes), encoding="utf-8")
    return Page(write_report(folder).read_text(encoding="utf-8"))


def words(page: Page) -> str:
    return " ".join(page.text.split())


def test_the_content_follows_the_schema() -> None:
    follows(CONTENT, "UncertaintyFile")
    assert UncertaintyFile.model_validate(CONTENT).model_dump(mode="json", exclude_unset=True) == CONTENT


def test_the_page_tells_it_in_order_and_needs_nothing_else(tmp_path: Path) -> None:
    (tmp_path / "figures").mkdir()
    Figure(figsize=(1, 1)).savefig(tmp_path / "figures" / "draws-blocks.png")
    page = page_of(tmp_path, figures=[{"file": "figures/draws-blocks.png", "caption": "draws of two"}])
    passages = (
        "a roll decay",
        "Uncertainty by jaxhydro 0.1.0",
        "1 of 2 coefficients known to 1.4 % (90 % intervals)",
        "not determined: linear_damping.B44.",
        "Parameters",
        "90 % interval",
        "added mass in roll",
        "29 times",
        "linear damping in roll; not determined",
        "their width over that of intervals for white errors",
        "90 % intervals in other ways",
        "drawn anew in blocks and fitted again, 198 times",
        "Laplace",
        "What the intervals mean",
        "What a 90 % interval means",
        "about 90 in 100",
        "does not mean that the model is right",
        "the records do not determine",
        "Figures",
        "draws of two",
        "Inputs and versions",
        "Campaign",
        "a roll decay",
        "Platform",
        "a tanker",
        "results/calibration.json, 2 parameters fitted",
        "jaxhydro 0.1.0",
    )
    places, at = [], 0
    for text in passages:
        at = words(page).find(text, at)
        places.append(at)
    assert -1 not in places, list(zip(passages, places))
    assert "did not converge" not in page.text and "NUTS" not in page.text and "Bootstrap, repeats" not in page.text
    assert len(page.links) == 1 and page.links[0].startswith("data:image/png;base64,")
    assert not {"script", "link", "iframe", "object"} & set(page.tags)


def test_the_tables_have_each_interval_in_its_place(tmp_path: Path) -> None:
    """A side that is open is told; a way that was not gone for a parameter leaves its cell empty, others leave no column."""
    page_of(tmp_path)
    html = (tmp_path / "report.html").read_text(encoding="utf-8").replace("<wbr>", "")
    cells = [re.findall(r"<td[^>]*>([^<]*)</td>", row) for row in re.findall(r"<tr[^>]*>(.*?)</tr>", html)]
    assert ["added_mass.A44", "added mass in roll", "18.41", "18.15 to 18.67", "kg m²", "29 times"] in cells
    assert ["added_mass.A44", "18.15 to 18.67", "at most 18.7", "18.29 to 18.51"] in cells
    assert ["linear_damping.B44", "0.0273 to 36.4", "", "0.302 to 3.71"] in cells
    muted = re.findall(r"<tr class=muted>(.*?)</tr>", html)
    assert len(muted) == 1 and "linear_damping.B44" in muted[0] and "N m s/rad" in muted[0] and ">–</td>" in muted[0]
    assert html.count("<th") == 6 + 4 + 2 + 3  # three of them are thead


def test_intervals_of_laplace_alone_make_a_page(tmp_path: Path) -> None:
    bound = {"added_mass.A44": alone(MASS) | {"at_bound": True, "laplace": [None, None]}}
    page = page_of(tmp_path, parameters=bound, notes=[], bootstrap={}, platform="")
    assert "in other ways" not in page.text and "Notes" not in page.text and "Figures" not in page.text
    assert "at its bound" in page.text and "not bounded" in page.text
    assert "1 parameter fitted to" in words(page) and "Platform" not in page.text


def test_draws_of_repeats_and_from_the_posterior_are_told(tmp_path: Path) -> None:
    parameter = alone(MASS) | {"repeats": [18.2, 18.6], "nuts": [18.1, 18.7]}
    nuts = {"chains": 4, "draws": 350, "divergences": 0, "r_hat": {}, "effective": {}}
    repeats = {"repeats": {"asked": 60, "draws": 60, "unsettled": 0, "groups": {"a": ["b"]}}}
    page = page_of(tmp_path, parameters={"added_mass.A44": parameter}, bootstrap=repeats, nuts=nuts)
    text = words(page)
    assert "those that repeat each other and fitted again, 60 times" in text and "4 chains of 350" in text
    assert "18.10 to 18.70" in text and "18.20 to 18.60" in text
    assert "Bootstrap, blocks" not in text and "Profile" not in text


def test_what_did_not_converge_says_so_on_top(tmp_path: Path) -> None:
    text = words(page_of(tmp_path, converged=False))
    assert -1 < text.find("did not converge") < text.find("in 100")
    assert "not intervals of a calibration" in text


def test_the_page_escapes_what_comes_from_files(tmp_path: Path) -> None:
    evil = '<script>alert("1")</script>&amp; $title {level}'
    parameters = {evil: MASS | {"unit": evil, "meaning": evil}}
    page = page_of(tmp_path, campaign=evil, platform=evil, calibration=evil, jaxhydro=evil, parameters=parameters, notes=[evil])
    assert "script" not in page.tags and page.text.count(evil) == 12


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ("{", "line 1, column 2: expected valid JSON"),
        ("[]", "expected a mapping of keys to values, found list"),
        (CONTENT | {"level": 95}, "level: expected a number > 0 and < 1, found 95"),
        (CONTENT | {"converged": None}, "converged: expected true or false"),
        ({key: CONTENT[key] for key in CONTENT if key != "calibration"}, "calibration: expected text, found nothing"),
        (CONTENT | {"parameters": {"a.b": MASS | {"laplace": [1.0]}}}, "parameters.a.b.laplace"),
        (CONTENT | {"parameters": {"a.b": MASS | {"laplace": [1.0, "2"]}}}, "parameters.a.b.laplace[1]: expected a number"),
        (CONTENT | {"parameters": {"a.b": MASS | {"profile": 3}}}, "parameters.a.b.profile: expected"),
        (CONTENT | {"bootstrap": {"blocks": {"asked": 3}}}, "bootstrap.blocks.draws: expected a whole number"),
    ],
)
def test_a_broken_file_is_told(tmp_path: Path, content: Any, expected: str) -> None:
    """Which file, which key, what was expected and what was found; no page is made."""
    (tmp_path / UNCERTAINTY_FILE).write_text(content if isinstance(content, str) else json.dumps(content))
    with pytest.raises(InputError) as caught:
        write_report(tmp_path)
    assert expected in str(caught.value) and str(tmp_path / UNCERTAINTY_FILE) in str(caught.value)
    assert [path.name for path in tmp_path.iterdir()] == [UNCERTAINTY_FILE]


def test_the_command_makes_the_page_and_a_new_result_takes_it_away(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    result: Any = SimpleNamespace()
    monkeypatch.setattr(uncertainty_outputs, "document", lambda _: UncertaintyFile.model_validate(CONTENT))
    write_uncertainty(result, tmp_path / "out", figures=False)
    assert "report.html" in run("report", tmp_path / "out") and (tmp_path / "out" / "report.html").exists()
    (tmp_path / "out" / "notes.txt").write_text("keep")
    write_uncertainty(result, tmp_path / "out", figures=False)
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["notes.txt", UNCERTAINTY_FILE]
    assert f"{DIAGNOSIS_FILE}, {UNCERTAINTY_FILE}, comparison.json, motion.csv or sweep.json" in run(
        "report", tmp_path, status=2
    )
