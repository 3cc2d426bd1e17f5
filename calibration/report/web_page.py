"""Parts of the HTML pages: frame, boxes, tables, figures.

Tables fit the screen: columns wrap, and on a narrow screen a table with more than two columns shows each row as a block.
"""

import base64
import re
from collections.abc import Container, Iterable, Sequence
from html import escape
from pathlib import Path
from string import Template

from calibration.results.calibration_file import Figure
from calibration.results.result_folder import FIGURES_FOLDER, GENERATOR

_PNG = b"\x89PNG\r\n\x1a\n"
NARROW_COLUMNS = 2  # columns that fit on a narrow screen
SHORT_CELL = 20  # characters of a cell that stay on one line
UNCONVERGED = "The fit did not converge: what follows is where it stopped, not {}."


def framed(title: str, by: str, body: Iterable[str], version: str) -> str:
    """A whole page around its parts, which are HTML."""
    return _PAGE.substitute(
        generator=f'{GENERATOR} {escape(version)}">',
        title=escape(title),
        by=escape(by),
        body="\n".join(filter(None, body)),
    )


def result_box(text: str) -> str:
    """The result of a page in one sentence, in a box."""
    return f'<p class="verdict">{_spans(text)}</p>'


def warning_box(text: str) -> str:
    """What a reader must know before anything else, in a red box."""
    return f'<p class="warning">{_spans(text)}</p>'


def _spans(text: str) -> str:
    """Escaped text whose spans of numbers, such as 0.4-1.7 %, stay on one line."""
    return re.sub(r"(?<![\w.-])[\d.]+(-[\d.]+)? %", r"<span class=short>\g<0></span>", escape(text))


def listed(texts: Iterable[str]) -> str:
    """A list of points."""
    return f"<ul>{''.join(f'<li>{escape(text)}</li>' for text in texts)}</ul>"


def folded(title: str, content: str) -> str:
    """Content that the reader unfolds."""
    return f"<details><summary>{escape(title)}</summary>{content}</details>"


def images(stated: Iterable[Figure], folder: Path) -> dict[str, str]:
    """Figures by name in their stated order, then others that are there; only PNG files of the folder itself are taken."""
    there = {path.name: path for path in sorted((folder / FIGURES_FOLDER).glob("*.png")) if path.is_file()}
    captions = {Path(figure.file).name: figure.caption for figure in stated}
    names = [name for name in captions if name in there] + [name for name in there if name not in captions]
    parts = {}
    for name in names:
        if part := embedded(there[name], captions.get(name) or name):
            parts[name] = part
    return parts


def embedded(path: Path, caption: str) -> str:
    """A PNG file as a figure of the page; nothing where it is none."""
    content = path.read_bytes()
    if not content.startswith(_PNG):
        return ""
    data, caption = base64.b64encode(content).decode("ascii"), escape(caption)
    return f'<figure><img alt="{caption}" src="data:image/png;base64,{data}"><figcaption>{caption}</figcaption></figure>'


def figures(parts: Iterable[str]) -> str:
    """Figures in two columns; nothing where there are none."""
    together = "".join(parts)
    return f"<div class=figures>{together}</div>" if together else ""


def table(
    heads: Sequence[str], rows: Sequence[Sequence[str]], first: int = 1, last: int = 99, muted: Container[int] = ()
) -> str:
    """A table.

    Args:
        heads: Headings of the columns.
        rows: Texts of the cells.
        first: First column that holds numbers, from 0.
        last: Column after the last one that holds numbers.
        muted: Indices of rows that are shown in grey.

    Returns:
        HTML.
    """
    numbers = range(first, min(last, len(heads)))
    head = "".join(f"<th{_right(i in numbers)}>{escape(name)}</th>" for i, name in enumerate(heads))
    body = ""
    for k, row in enumerate(rows):
        cells = "".join(_cell(heads[i], text, i in numbers) for i, text in enumerate(row))
        body += f"<tr{' class=muted' if k in muted else ''}>{cells}</tr>"
    many = " class=many" if len(heads) > NARROW_COLUMNS else ""
    return f"<div class=scroll><table{many}><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>"


def _cell(head: str, text: str, number: bool) -> str:
    label = f' data-label="{escape(head)}"' if head else ""
    short = len(text) <= SHORT_CELL
    kind = _right(number) or (" class=short" if short else "")
    return f"<td{kind}{label}>{escape(text) if short else breakable(text)}</td>"


def _right(number: bool) -> str:
    return " class=number" if number else ""


def breakable(text: str) -> str:
    """Escaped text that may break inside long labels: after a dot, an underscore or a slash within a word."""
    return re.sub(r"(?<=[A-Za-z])([._/])(?=[A-Za-z])", r"\1<wbr>", escape(text))


_PAGE = Template("""\
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
$generator
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>$title</title>
<style>
body { font: 15px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; color: #22262c; background: #fff;
  max-width: 62rem; margin: 2rem auto; padding: 0 1.2rem; overflow-wrap: anywhere; }
h1 { font-size: 1.5rem; margin: 0 0 .2rem; } h2 { font-size: 1.1rem; margin: 2rem 0 .5rem; }
.by, .muted td, figcaption { color: #6a717b; }
.by { margin: 0 0 1.2rem; }
.warning { background: #fbe9e7; border-left: 4px solid #d1495b; padding: .6rem .9rem; font-weight: 600; }
.verdict { background: #eef3f8; border-left: 4px solid #4f7cac; padding: .6rem .9rem; font-size: 1.1rem; }
.size { font-size: 1.05rem; margin: .2rem 0 .4rem; } h3 { font-size: 1rem; margin: 1.3rem 0 .2rem; }
.scroll { overflow-x: auto; margin-bottom: .8rem; }
table { border-collapse: collapse; font-size: .92rem; overflow-wrap: break-word; }
th, td { text-align: left; padding: .2rem .9rem .2rem 0; border-bottom: 1px solid #e4e6ea; vertical-align: top; }
th { border-bottom: 1px solid #9aa1ab; font-weight: 600; vertical-align: bottom; }
th:last-child, td:last-child { padding-right: 0; }
.number { text-align: right; font-variant-numeric: tabular-nums; } td.number, .short { white-space: nowrap; }
details { margin: .6rem 0; } summary { cursor: pointer; color: #3c6591; }
.figures { columns: 2; column-gap: 2rem; }
figure { margin: 0 0 1.6rem; break-inside: avoid; } img { width: 100%; height: auto; }
figcaption { font-size: .85rem; line-height: 1.35; }
@media (max-width: 62rem) { table { font-size: .86rem; } th, td { padding-right: .5rem; } }
@media (max-width: 45rem) {
  .figures { columns: 1; }
  /* a row of a table with many columns becomes a block: its first cell on top, then name and value of each column */
  .many, .many tbody, .many tr { display: block; overflow-wrap: anywhere; }
  .many thead { display: none; }
  .many tr { border-bottom: 1px solid #9aa1ab; padding: .4rem 0; }
  .many td { border: 0; padding: .05rem 0; display: inline-block; max-width: 100%; margin-right: 1.1em; }
  .many td:empty { display: none; }
  .many td:first-child { display: block; font-weight: 600; }
  .many td { white-space: normal; text-align: left; }
  .many td + td::before { content: attr(data-label); color: #6a717b; margin-right: .5em; }
}
@media print { body { margin: 0; max-width: none; font-size: 10pt; } }
</style>
</head>
<body>
<h1>$title</h1>
<p class="by">$by</p>
$body
</body>
</html>
""")
