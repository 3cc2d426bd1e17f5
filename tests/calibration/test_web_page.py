"""Pages fit the screen: free text wraps, and in a browser no page or table is wider than its window."""

import html
import json
import re
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from fake_calibration import small
from fake_diagnosis import fake_diagnosis
from test_uncertainty_page import CONTENT

from calibration.report.web_page import PAGES, breakable
from calibration.report.write_report import write_report
from calibration.results.write_calibration import write_calibration
from calibration.results.write_diagnosis import write_diagnosis

LONG = "a static offset (a force, or a sensor's zero) in roll; wrong mass properties; radiation memory in roll"
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
MEASURE = """<body style="margin:0"><iframe id=f style="border:0;width:%dpx;height:900px" src="%s"></iframe><pre id=o></pre>
<script>document.getElementById('f').onload = e => {
const d = e.target.contentDocument, root = d.documentElement;
d.querySelectorAll('details').forEach(x => x.open = true);
const wide = [...d.querySelectorAll('table')].filter(x => x.offsetWidth > x.parentElement.clientWidth + 1);
document.getElementById('o').textContent = 'RESULT' + JSON.stringify({client: root.clientWidth, scroll: root.scrollWidth,
  wide: wide.map(x => x.rows[0].innerText)}) + 'END'; }</script>"""


def macro(name: str, *given: Any, **options: Any) -> str:
    """HTML of a macro of the pages."""
    return getattr(PAGES.get_template("macros.html.jinja").module, name)(*given, **options)


def table(heads: list[str], rows: list[list[str]], *numbers: int, muted: Sequence[int] = ()) -> str:
    return macro("table", (heads, rows), *numbers, muted=muted)


def test_only_numbers_and_short_cells_stay_on_one_line() -> None:
    """Free text in any column wraps."""
    text = table(["Effect", "Size", "Why not"], [[LONG, "1.5 ± 0.1", LONG], ["short", "2", "x" * 20]], 1, 2)
    assert re.findall(r"<td([^>]*)>", text) == [
        ' data-label="Effect"',
        ' class=number data-label="Size"',
        ' data-label="Why not"',
        ' class=short data-label="Effect"',
        ' class=number data-label="Size"',
        ' class=short data-label="Why not"',
    ]
    rules = re.findall(
        r"([^{}]*)\{[^{}]*white-space: nowrap[^{}]*\}",
        PAGES.get_template("base.html.jinja").render(title="a", by="b", version="0"),
    )
    assert [selector.strip() for rule in rules for selector in rule.split(",")] == ["td.number", ".short"]


def test_a_table_of_many_columns_is_made_for_a_narrow_screen() -> None:
    """There each cell needs the heading of its column. One of two columns stays a table. Grey rows are as asked."""
    two, three = table(["A", "B"], [["a", "b"]]), table(["A", "B", "C"], [["a", "b", "c"], ["d", "e", "f"]], muted=[1])
    assert "class=many" not in two and "<table class=many>" in three and three.count("<tr class=muted>") == 1
    assert '"A&#34;<"' not in table(['A"<'], [["a"]]) and 'data-label="A&#34;&lt;"' in table(['A"<'], [["a"]])


def test_spans_of_numbers_stay_on_one_line() -> None:
    assert macro("result", "2 to 0.4-1.7 %; a <b>") == (
        '<p class="verdict">2 to <span class=short>0.4-1.7 %</span>; a &lt;b&gt;</p>'
    )


def test_long_labels_may_break_and_numbers_may_not() -> None:
    assert "<wbr>" not in table(["A"], [["linear_damping.B11"]]) and "<wbr>" in table(["A"], [["mass_properties.inertia_roll"]])
    assert breakable("coulomb_friction.surge <b>") == "coulomb_<wbr>friction.<wbr>surge &lt;b&gt;"
    assert breakable("0.95 to 1.5, 3_4") == "0.95 to 1.5, 3_4"


@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium here")
@pytest.mark.parametrize("width", [360, 800, 1400])
def test_pages_fit_the_window_of_a_browser(width: int, tmp_path: Path) -> None:
    """In a frame, since a browser's own window has a least width."""
    write_calibration(small(), tmp_path / "calibration", truth={"column.Ca_t": 1.5, "nothing.like_it": 2.0})
    write_diagnosis(fake_diagnosis(), tmp_path / "diagnosis")
    (tmp_path / "uncertainty").mkdir()
    (tmp_path / "uncertainty" / "uncertainty.json").write_text(json.dumps(CONTENT))
    write_diagnosis(replace(fake_diagnosis(), verdict="unexplained", effects=()), tmp_path / "unexplained", figures=False)
    content = json.loads((tmp_path / "unexplained" / "diagnosis.json").read_text())
    content["missing"]["unexplained"]["forces"] = [{"degree_of_freedom": "roll", "words": 5 * LONG}]
    (tmp_path / "unexplained" / "diagnosis.json").write_text(json.dumps(content))
    for name in ("calibration", "diagnosis", "unexplained", "uncertainty"):
        frame = tmp_path / f"{name}.html"
        frame.write_text(MEASURE % (width, write_report(tmp_path / name).as_uri()))
        options = ["--headless", "--no-sandbox", "--disable-gpu", "--allow-file-access-from-files", "--hide-scrollbars"]
        options += ["--virtual-time-budget=4000", "--window-size=1500,1000", f"--user-data-dir={tmp_path / 'profile'}"]
        command = [str(CHROMIUM), *options, "--dump-dom", frame.as_uri()]
        seen = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False).stdout
        found = re.search(r"RESULT(\{.*?\})END</pre>", seen, re.S)
        assert found, seen[-500:]
        result = json.loads(html.unescape(found[1]))
        assert result["client"] == width and result["scroll"] <= width and result["wide"] == [], (name, result)
