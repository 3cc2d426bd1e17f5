"""The site of the documentation: built without warnings, links that lead somewhere, all commands and public names."""

import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

import calibration
import jaxhydro
from jaxhydro.cli.app import app

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
MARKDOWN = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
MADE = ("contributing.md", "changelog.md", "reference/commands.md")  # by a build, for the site only
PAGES = ("index", "quickstart", "guide/calibrate", "formats", "theory", "verified", "validation", "speed", "faq", "glossary")


class Page(HTMLParser):
    """Links and anchors of a page."""

    def __init__(self, text: str):
        super().__init__()
        self.links: list[str] = []
        self.anchors = {""}
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        named = dict(attrs)
        self.anchors |= {value for key in ("id", "name") if (value := named.get(key))}
        self.links += [link for key in ("href", "src") if (link := named.get(key))]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The site, as `make docs` builds it: warnings are errors."""
    out = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html", str(DOCS), str(out)]
    built = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert built.returncode == 0, built.stderr
    return out


@pytest.mark.slow
def test_the_site_is_whole(site: Path) -> None:
    """All pages of docs/ and all notebooks are there, and links and images lead to what is there."""
    pages = {path: Page(path.read_text("utf-8")) for path in site.rglob("*.html") if "_static" not in path.parts}
    names = {path.relative_to(site).with_suffix("").as_posix() for path in pages}
    written = {path.relative_to(DOCS).with_suffix("").as_posix() for path in DOCS.rglob("*.md")}
    notebooks = {f"tutorials/{path.stem}" for path in (ROOT / "notebooks").glob("*.ipynb")}
    assert {*PAGES, *written, *notebooks, "contributing", "changelog"} <= names
    broken = []
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if not (parts.scheme or parts.netloc):
                target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
                anchors = pages[target].anchors if target in pages else {"", parts.fragment}
                if not target.is_file() or unquote(parts.fragment) not in anchors:
                    broken.append(f"{path.relative_to(site)}: {link}")
    assert not broken


@pytest.mark.slow
def test_the_site_shows_what_it_should(site: Path) -> None:
    """Formulas are formulas, notebooks have figures, every command and every public name is described."""
    theory = (site / "theory.html").read_text("utf-8")
    assert (
        theory.count('class="math') > 150 and "```" not in theory and "$" not in re.sub("(?s)<script.*?</script>", "", theory)
    )
    assert "<img" in (site / "tutorials/01_calibrate_from_decays.html").read_text("utf-8")
    commands = Page((site / "reference/commands.html").read_text("utf-8")).anchors
    assert {
        f"jaxhydro-{command.name or command.callback.__name__}" for command in app.registered_commands if command.callback
    } <= commands
    for package in (jaxhydro, calibration):
        names = Page((site / f"reference/python/{package.__name__}.html").read_text("utf-8")).anchors
        assert {f"{package.__name__}.{name}" for name in package.__all__} <= names


def test_links_of_the_markdown_files_lead_to_files() -> None:
    """So that they work on GitHub, too, where nothing is made."""
    broken = []
    for path in (*MARKDOWN, *DOCS.rglob("*.md")):
        if path.is_relative_to(DOCS) and path.relative_to(DOCS).as_posix() in MADE:
            continue
        text = re.sub(r"(?s)```.*?```|`[^`\n]*`", "", path.read_text("utf-8"))
        links = re.findall(r"\]\(([^)\s#]+)[^)]*\)|<img src=\"([^\"]+)", text)
        for link in (first or second for first, second in links):
            if not urlsplit(link).scheme and not (path.parent / link).exists():
                broken.append(f"{path.relative_to(ROOT)}: {link}")
    assert not broken
