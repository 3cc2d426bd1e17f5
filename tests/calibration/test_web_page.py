"""Parts of pages: free text wraps, contents, notes by kind, inputs and versions."""

import re
from collections.abc import Sequence
from typing import Any

from calibration.notes import Note, NoteKind, kind_of
from calibration.report.web_page import PAGES, breakable, inputs_table, notes_by_kind, with_contents

LONG = "a static offset (a force, or a sensor's zero) in roll; wrong mass properties; radiation memory in roll"


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


def test_the_contents_name_every_section_before_the_first() -> None:
    page = with_contents("<p>a</p>\n<h2>B &amp; c</h2><p>d</p>\n<h2>E</h2>")
    links = re.findall(r'<a href="#(.*?)">(.*?)</a>', page)
    assert links == [("part-1", "B &amp; c"), ("part-2", "E")]
    assert page.index("<p>a</p>") < page.index("<nav") < page.index('<h2 id="part-1">B') < page.index('<h2 id="part-2">E')
    assert "<nav" not in with_contents("<h2>alone</h2>")


def test_notes_are_grouped_by_kind_and_told_once() -> None:
    about = [NoteKind.PARAMETERS, NoteKind.RECORDS, NoteKind.RECORDS]
    assert notes_by_kind(["p", "r", "r"], about) == [("Records", ["r"]), ("Parameters", ["p"])]
    assert notes_by_kind(["a", "b"], []) == [("", ["a", "b"])] and notes_by_kind([], []) == []
    assert kind_of(Note(Note("a", NoteKind.RECORDS), NoteKind.FIT)) == NoteKind.RECORDS and kind_of("a") == NoteKind.FIT


def test_inputs_end_with_the_versions() -> None:
    heads, rows = inputs_table("0.0.1", campaign="basin", calibration=None, platform="")
    assert heads == ("Input", "Value") and rows[0] == ("Campaign", "basin")
    assert rows[1] == ("Results by", "jaxhydro 0.0.1") and rows[2][0] == "Page by" and len(rows) == 3
