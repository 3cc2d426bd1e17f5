"""Every notebook runs from its first cell to its last, on a short sea."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[2] / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
LONG = ("03_sea_state_dependent_damping",)  # several calibrations in waves: minutes, short as they are
SHORT = {"MPLBACKEND": "Agg", "JAXHYDRO_NOTEBOOK_DURATION": "720"}  # s


def cells(path: Path, kind: str) -> list[str]:
    return ["".join(cell["source"]) for cell in json.loads(path.read_text("utf-8"))["cells"] if cell["cell_type"] == kind]


def test_notebooks_are_numbered() -> None:
    assert NOTEBOOKS and all(path.stem[:2].isdigit() and path.stem[2] == "_" for path in NOTEBOOKS)


@pytest.mark.parametrize(
    "path",
    [pytest.param(path, marks=pytest.mark.validate if path.stem in LONG else pytest.mark.slow) for path in NOTEBOOKS],
    ids=lambda path: path.stem,
)
def test_a_notebook_runs(path: Path, tmp_path: Path) -> None:
    """Its code in one plain process, as it stands."""
    script = tmp_path / f"{path.stem}.py"
    script.write_text("\n".join(cells(path, "code")), encoding="utf-8")
    done = subprocess.run([sys.executable, str(script)], cwd=tmp_path, capture_output=True, text=True, env=os.environ | SHORT)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip()


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_read(path: Path) -> None:
    """It begins with a heading, ends in words, and its outputs are small; so a page shows it without running it."""
    notebook = json.loads(path.read_text("utf-8"))
    assert notebook["nbformat"] == 4 and cells(path, "markdown")[0].startswith("# ")
    assert notebook["cells"][-1]["cell_type"] == "markdown"
    assert path.stat().st_size < 300_000
