"""Pages in a real browser: no page or table is wider than its window, no script fails, and all of it can be read.

Chromium is the machine's own, driven by playwright; without either the tests are skipped.
"""

import json
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from fake_calibration import small
from fake_diagnosis import fake_diagnosis
from fake_simulation import hull, written_comparison, written_sea, written_waves
from fake_sweep import RESULTS
from test_uncertainty_page import CONTENT
from test_web_page import LONG

from calibration.report.write_report import write_report
from calibration.results.write_calibration import write_calibration
from calibration.results.write_diagnosis import write_diagnosis

playwright = pytest.importorskip("playwright.sync_api", reason="playwright is of the dev extra")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
pytestmark = [pytest.mark.slow, pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")]

OPTIONS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]  # WebGL without a graphics card
WIDTHS = (360, 800, 1400)
MIN_CONTRAST = 4.5  # of text, WCAG 2.1, 1.4.3
PAGES = ("calibration", "diagnosis", "unexplained", "uncertainty", "sea", "waves", "campaign", "sweep")
MEASURE = """least => {
  const root = document.documentElement, visible = x => x.offsetParent !== null;
  document.querySelectorAll("details").forEach(x => { x.open = true; });
  const channels = colour => colour.match(/[\\d.]+/g).map(Number);
  const level = ([r, g, b]) => [r, g, b].map(c => c / 255).map(c => c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
    .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const behind = x => {
    for (let one = x; one; one = one.parentElement) {
      const colour = channels(getComputedStyle(one).backgroundColor);
      if (colour.length < 4 || colour[3] > 0) return colour;
    }
    return [255, 255, 255];
  };
  const contrast = x => {
    const [a, b] = [level(channels(getComputedStyle(x).color)), level(behind(x))];
    return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
  };
  const texts = [...document.querySelectorAll("h1, h2, h3, p, td, th, li, a, figcaption, summary, label, span, button")];
  const frames = [...document.querySelectorAll("table, figure, .motion, select")].filter(visible);
  return {
    client: root.clientWidth, scroll: root.scrollWidth,
    wide: frames.filter(x => x.offsetWidth > x.parentElement.clientWidth + 1).map(x => x.innerText.slice(0, 80)),
    pale: texts.filter(x => visible(x) && x.innerText.trim() && contrast(x) < least).map(x => x.innerText.slice(0, 80)),
    unnamed: [...document.querySelectorAll("img:not([alt]), img[alt='']")].length,
    unlabelled: [...document.querySelectorAll("[role=img]:not([aria-label])")].length,
    broken: [...document.querySelectorAll("nav a")].filter(x => !document.querySelector(x.getAttribute("href"))).length,
  };
}"""


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """A page of every kind."""
    root = tmp_path_factory.mktemp("pages")
    write_calibration(small(), root / "calibration", truth={"column.Ca_t": 1.5, "nothing.like_it": 2.0})
    write_diagnosis(fake_diagnosis(), root / "diagnosis")
    write_diagnosis(replace(fake_diagnosis(), verdict="unexplained", effects=()), root / "unexplained", figures=False)
    content = json.loads((root / "unexplained" / "diagnosis.json").read_text())
    content["missing"]["unexplained"]["forces"] = [{"degree_of_freedom": "roll", "words": 5 * LONG}]
    (root / "unexplained" / "diagnosis.json").write_text(json.dumps(content))
    for name, text in (("uncertainty", CONTENT), ("sweep", RESULTS)):
        (root / name).mkdir()
        (root / name / f"{name}.json").write_text(json.dumps(text))
    written_sea(root / "sea", figures=True)
    written_waves(root / "waves")
    written_comparison(root / "campaign")
    return {name: write_report(root / name) for name in PAGES}


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """A browser without a window."""
    with playwright.sync_playwright() as started:
        opened = started.chromium.launch(executable_path=CHROMIUM, args=OPTIONS)
        yield opened
        opened.close()


def opened(browser: Any, page: Path, width: int) -> tuple[Any, list[str]]:
    """A page in a window of so many pixels, drawn, and the list of its scripts' errors."""
    tab, errors = browser.new_page(viewport={"width": width, "height": 900}), []
    tab.on("pageerror", lambda error: errors.append(str(error)))
    tab.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)
    tab.on("request", lambda request: errors.append(request.url) if request.url.startswith("http") else None)
    tab.goto(page.as_uri())
    if tab.locator("#motion-view").count():
        tab.wait_for_function("document.documentElement.dataset.motion === 'drawn'", timeout=120_000)
    return tab, errors


@pytest.mark.parametrize("name", PAGES)
def test_pages_fit_their_window_and_can_be_read(browser: Any, pages: dict[str, Path], name: str) -> None:
    """No request to the network, no error of a script, no pale text, no figure without words; every link leads somewhere."""
    for width in WIDTHS:
        tab, errors = opened(browser, pages[name], width)
        result = tab.evaluate(MEASURE, MIN_CONTRAST)
        tab.close()
        assert result.pop("client") == width and result.pop("scroll") <= width, (name, width)
        assert result == {"wide": [], "pale": [], "unnamed": 0, "unlabelled": 0, "broken": 0} and not errors, (
            name,
            width,
            errors,
        )


def test_the_platform_moves_and_series_are_chosen(browser: Any, pages: dict[str, Path]) -> None:
    """The slider, the play button and the choice of a test change what is drawn."""
    pytest.importorskip("plotly", reason="plotly.js is a part of it")
    tab, errors = opened(browser, pages["campaign"], 1200)
    lowest = "() => Math.min(...document.getElementById('motion-hull').data[0].z)"
    first = tab.evaluate(lowest)
    tab.evaluate(
        "() => { const s = document.getElementById('motion-frame'); s.value = 10; s.dispatchEvent(new Event('input')); }"
    )
    tab.wait_for_function(f"({lowest})() !== {first}")
    assert tab.evaluate("document.getElementById('motion-hull').data[0].x.length") == 32 * len(hull().elements.length)
    tab.click("#motion-play")
    tab.wait_for_function("Number(document.getElementById('motion-frame').value) > 12")
    assert tab.inner_text("#motion-play") == "Pause"
    tab.click("#motion-play")
    samples = "document.getElementById('motion-series').data[2].y.filter(y => y !== null).length"
    before = tab.evaluate(samples)
    tab.select_option("#motion-test", "1")
    tab.wait_for_function(f"{samples} < {before}")
    tab.close()
    assert not errors
