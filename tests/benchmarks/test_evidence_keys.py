"""Keys of the evidence's results: they cover the modules that run, not those that make the page's text."""

import ast
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import NamedTuple

import pytest

from benchmarks import validate
from benchmarks.evidence import common, numerical_tank

FOLDER = Path(common.__file__).parent
MODULES = {path.name: ast.parse(path.read_text("utf-8")) for path in sorted(FOLDER.glob("*.py"))}
KEYS: dict[str, Callable[[], str]] = {name: module.key for name, module in validate.MODULES.items()}
KEYS["numerical_tank, truth"] = lambda: numerical_tank.truth_key({"surge": {"envelope": 1.0}})
WITHOUT_RUNS = {"seeds", "coverage", "starts", "global_search", "diagnoses", "lacking"}  # keys of data and of a tank alone
MAX_WORDS = 12  # of a string that is not text of the page


class Inputs(NamedTuple):
    """What a key is made of.

    Attributes:
        modules: Names of the modules in benchmarks/evidence.
        strings: Strings beside files.
    """

    modules: set[str]
    strings: list[str]


@pytest.fixture
def inputs(monkeypatch: pytest.MonkeyPatch) -> Callable[[str], Inputs]:
    """Inputs of a key; files are not read."""
    paths: list[Path] = []
    updates: list[bytes] = []

    class Recorder:
        def update(self, data: bytes) -> None:
            updates.append(data)

        def hexdigest(self) -> str:
            return "0" * 64

    def read_bytes(path: Path) -> bytes:
        paths.append(path)
        return b""

    def of_key(name: str) -> Inputs:
        paths.clear()
        updates.clear()
        with monkeypatch.context() as patch:
            patch.setattr(Path, "read_bytes", read_bytes)
            patch.setattr(common, "hashlib", SimpleNamespace(sha256=Recorder))
            KEYS[name]()
        files = {path.name.encode() + b"\0\0" for path in paths}
        strings = [data.rstrip(b"\0").decode() for data in updates if data not in files]
        return Inputs({path.name for path in paths if path.parent == FOLDER}, strings)

    return of_key


def imported(name: str) -> Iterator[tuple[str, str]]:
    """Modules of benchmarks.evidence that a module imports from, and the names."""
    for node in ast.walk(MODULES[name]):
        if isinstance(node, ast.ImportFrom) and node.module == "benchmarks.evidence":
            yield from ((f"{alias.name}.py", "") for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("benchmarks.evidence."):
            yield from (((node.module or "").rsplit(".", 1)[1] + ".py", alias.name) for alias in node.names)


def makes_page(name: str) -> bool:
    """Whether a module makes text, tables or figures of the page, or sections of these."""
    named = name.removesuffix(".py").endswith(("_text", "_words", "_figure", "_figures", "_published"))
    return named or bool({("common.py", "Section"), ("common.py", "table")} & set(imported(name)))


def strings_of(name: str) -> Iterator[str]:
    """Strings of a module without its docstrings; values in an f-string are blank."""
    nodes = list(ast.walk(MODULES[name]))
    documented = [node for node in nodes if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef)]
    docstrings = {id(node.body[0].value) for node in documented if isinstance(node.body[0], ast.Expr)}
    for node in nodes:
        if isinstance(node, ast.JoinedStr):
            yield "".join(str(part.value) if isinstance(part, ast.Constant) else " " for part in node.values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docstrings:
            yield node.value


def is_page_text(text: str) -> bool:
    """Whether a string is a long sentence or a row of a Markdown table."""
    return len(re.findall(r"[^\W\d_]{2,}", text)) > MAX_WORDS or bool(re.search(r"^\s*\|.*\|\s*$", text, re.MULTILINE))


def test_page_text_is_recognised() -> None:
    """The pattern finds what the next tests are to keep out of the modules that run."""
    long = " ".join(["word"] * 13)
    assert is_page_text(long) and is_page_text("| a | b |\n| :-- | --: |") and not is_page_text("a heave decay, 3 m | 2")
    assert all(
        any(map(is_page_text, strings_of(name))) for name in ("periods_text.py", "openfast_waves_text.py", "study_text.py")
    )


@pytest.mark.parametrize("name", KEYS)
def test_a_key_does_not_depend_on_text(name: str, inputs: Callable[[str], Inputs]) -> None:
    """No module that makes the page is hashed, nor is a sentence; the section's module that runs is."""
    modules, strings = inputs(name)
    assert not [module for module in modules if makes_page(module)]
    assert not [text for text in strings if is_page_text(text)]
    section = name.split(",")[0]
    assert section in WITHOUT_RUNS or f"{section}_runs.py" in modules


@pytest.mark.parametrize("name", validate.SECTIONS)
def test_a_title_is_not_in_a_key(name: str, inputs: Callable[[str], Inputs], monkeypatch: pytest.MonkeyPatch) -> None:
    """A heading can be reworded."""
    before = inputs(name)
    monkeypatch.setattr(validate.MODULES[name], "TITLE", "Other words", raising=False)
    assert inputs(name) == before


def test_modules_that_run_have_no_page_text(inputs: Callable[[str], Inputs]) -> None:
    """Neither long sentences nor tables, nor anything of a module that makes the page."""
    hashed = set().union(*(inputs(name).modules for name in KEYS))
    runs = hashed | {name for name in MODULES if name.endswith("_runs.py")}
    assert len(hashed) > len(validate.SECTIONS)
    for name in sorted(runs):
        assert not [text for text in strings_of(name) if is_page_text(text)], name
        assert not [module for module, _ in imported(name) if makes_page(module)], name
