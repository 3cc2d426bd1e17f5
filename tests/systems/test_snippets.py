"""The Python of README and docs runs: the blocks of a page, one after the other, shorter where they take minutes."""

import ast
import re
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = ("README.md", *(f"docs/guide/{name}.md" for name in ("python", "own-effect", "waves", "uncertainty", "sweeps")))
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
SHORTER = {"seconds=60": "simulations=600"}  # seconds would depend on how busy the machine is
# what stands for the reader's own, or takes a whole job: of such blocks the imports are tried
NOT_RUN = ("likely", "my-campaign", "sweep.yaml", "SLURMCluster", "diagnose(campaign.model, campaign)\n")


def blocks(page: str) -> list[str]:
    return BLOCK.findall((ROOT / page).read_text("utf-8"))


def test_every_page_with_python_is_run() -> None:
    pages = (ROOT / "docs").rglob("*.md")
    pages_with_python = {
        str(path.relative_to(ROOT)) for path in (*pages, *ROOT.glob("*.md")) if BLOCK.search(path.read_text("utf-8"))
    }
    assert pages_with_python <= {*PAGES, "docs/quickstart.md"}
    (quick,) = blocks("docs/quickstart.md")
    lines = [re.sub(r"\s*#.*", "", line) for line in blocks("README.md")[0].splitlines()]
    assert {re.sub(r"\s*#.*", "", line) for line in quick.splitlines()} <= set(lines)


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES)
def test_the_python_of_a_page_runs(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In a folder with the package and the measured records beside it; what blocks write stays there."""
    project = tmp_path / "project"
    project.mkdir()
    (project / "jaxhydro").symlink_to(ROOT / "jaxhydro")
    (tmp_path / "shared").symlink_to(ROOT.parent / "shared")
    monkeypatch.chdir(project)
    names: dict[str, Any] = {"__name__": "snippet"}
    for block in blocks(page):
        for long, short in SHORTER.items():
            block = block.replace(long, short)
        tree = ast.parse(block)
        if any(text in block for text in NOT_RUN):
            wanted = [statement for statement in tree.body if isinstance(statement, ast.Import | ast.ImportFrom)]
            tree = ast.Module([statement for statement in wanted if "dask" not in ast.unparse(statement)], [])
        elif "../shared" in block and not (tmp_path / "shared").exists():
            continue  # the measured records are no part of the project
        exec(compile(tree, page, "exec"), names)
