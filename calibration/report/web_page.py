"""Pages from templates: figures as part of the page, and text that breaks where it may.

Tables fit the screen: columns wrap, and on a narrow screen a table with more than two columns shows each row as a block.
"""

import base64
import platform
import re
from collections.abc import Iterable, Sequence
from datetime import date
from pathlib import Path
from typing import Any, NamedTuple

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup, escape

import jaxhydro
from calibration.formatting import counted, number
from calibration.notes import NoteKind
from calibration.results.result_folder import FIGURES_FOLDER, Figure
from calibration.vocabulary import Rows

_PNG = b"\x89PNG\r\n\x1a\n"


class Image(NamedTuple):
    """A PNG file (base64), with its caption."""

    caption: str
    data: str


def spans(text: str) -> Markup:
    """Escaped text whose spans of numbers, such as 0.4-1.7 %, stay on one line."""
    return Markup(re.sub(r"(?<![\w.-])[\d.]+(-[\d.]+)? %", r"<span class=short>\g<0></span>", str(escape(text))))


def breakable(text: str) -> Markup:
    """Escaped text that may break inside long labels: after a dot, an underscore or a slash within a word."""
    return Markup(re.sub(r"(?<=[A-Za-z])([._/])(?=[A-Za-z])", r"\1<wbr>", str(escape(text))))


def with_code(text: str) -> Markup:
    """Escaped text in which what stands between backticks is shown as code."""
    return Markup(re.sub(r"`([^`]+)`", r"<code>\1</code>", str(escape(text))))


PAGES = Environment(
    loader=PackageLoader("calibration.report"), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
)
PAGES.filters.update(spans=spans, breakable=breakable, counted=counted, number=number, with_code=with_code)


def render(template: str, **content: Any) -> str:
    """Text of a page; whatever comes from files is escaped.

    Args:
        template: Name of the template, such as `calibration`.
        **content: What the template shows: of every page `title`, `by`, `version`, `date` and `inputs`.
    """
    return with_contents(PAGES.get_template(f"{template}.html.jinja").render(**content))


def with_contents(page: str) -> str:
    """A page with its table of contents before the first heading of the second level."""
    titles = re.findall(r"<h2>(.*?)</h2>", page)
    if len(titles) < 2:
        return page
    count = iter(range(1, len(titles) + 1))
    page = re.sub(r"<h2>", lambda _: f'<h2 id="part-{next(count)}">', page)
    links = "\n".join(f'<li><a href="#part-{n}">{title}</a></li>' for n, title in enumerate(titles, 1))
    first = page.index("<h2 ")
    return f'{page[:first]}<nav aria-label="Contents"><ul>\n{links}\n</ul></nav>\n{page[first:]}'


NOTE_TITLES = {NoteKind.RECORDS: "Records", NoteKind.FIT: "Fit", NoteKind.PARAMETERS: "Parameters"}


def notes_by_kind(notes: Sequence[str], about: Sequence[NoteKind]) -> list[tuple[str, list[str]]]:
    """Notes under the title of their kind, each once; without a title where the kinds are not known.

    Args:
        notes: Notes, as sentences.
        about: Kind of each note.
    """
    if len(about) != len(notes):
        return [("", list(notes))] if notes else []
    groups = [
        (title, [note for note, note_kind in zip(notes, about, strict=True) if note_kind == kind])
        for kind, title in NOTE_TITLES.items()
    ]
    return [(title, list(dict.fromkeys(group))) for title, group in groups if group]


def written_on(path: Path) -> str:
    """Day on which a file was written, such as 28 November 2026."""
    return _in_words(date.fromtimestamp(path.stat().st_mtime))


def inputs_table(version: str, **inputs: str | None) -> Rows:
    """Inputs of a result, and the versions that made it and its page.

    Args:
        version: Version of jaxhydro that wrote the result.
        **inputs: Names and values of inputs; None and empty values are left out.
    """
    rows = [(name.replace("_", " ").capitalize(), value) for name, value in inputs.items() if value]
    now = f"jaxhydro {jaxhydro.__version__}, Python {platform.python_version()}"
    return ("Input", "Value"), [*rows, ("Results by", f"jaxhydro {version}"), ("Page by", f"{now}, {_in_words(date.today())}")]


def _in_words(day: date) -> str:
    return f"{day.day} {day:%B %Y}"


def images(stated: Iterable[Figure], folder: Path) -> dict[str, Image]:
    """Figures by name in their stated order, then other figures in the folder.

    Only PNG files of the folder itself are taken.

    Args:
        stated: Figures with their captions.
        folder: The result folder.
    """
    files = {path.name: path for path in sorted((folder / FIGURES_FOLDER).glob("*.png")) if path.is_file()}
    captions = {Path(figure.file).name: figure.caption for figure in stated}
    names = [name for name in captions if name in files] + [name for name in files if name not in captions]
    return embedded({files[name]: captions.get(name) or name for name in names})


def embedded(captions: dict[Path, str]) -> dict[str, Image]:
    """PNG files with their captions as images of a page, by name; other files are left out."""
    contents = {path: path.read_bytes() for path in captions if path.is_file()}
    return {
        path.name: Image(captions[path], base64.b64encode(content).decode("ascii"))
        for path, content in contents.items()
        if content.startswith(_PNG)
    }
