"""What is shipped: one version, declared dependencies, types."""

import ast
import re
import sys
import tomllib
import zipfile
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest
from ruamel.yaml import YAML

import jaxhydro

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
OWN = {"jaxhydro", "calibration"}


def normal(name: str) -> str:
    """A distribution's name as registries compare it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def declared() -> set[str]:
    """All required distributions but those of development and documentation; `distributed` of `dask[distributed]`, too."""
    extras = [
        requirement
        for name, requirements in PROJECT["optional-dependencies"].items()
        if name not in ("dev", "docs")
        for requirement in requirements
    ]
    parts = [re.match(r"([\w.-]+)(?:\[(.*)\])?", requirement).groups("") for requirement in (*PROJECT["dependencies"], *extras)]
    return {normal(name) for name, options in parts for name in (name, *options.split(","))}


def imported() -> dict[str, str]:
    """Modules of others that the packages import, each with a file that does."""
    file_of = {}
    for path in (path for package in OWN for path in (ROOT / package).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            file_of |= {name.split(".")[0]: str(path.relative_to(ROOT)) for name in names}
    return {name: path for name, path in file_of.items() if name not in sys.stdlib_module_names and name not in OWN}


def test_every_import_is_a_declared_dependency() -> None:
    """Not one that another dependency happens to bring along. jaxlib is a part of jax."""
    distributions, named = packages_distributions(), declared()
    missing = {
        module: path
        for module, path in imported().items()
        if module != "jaxlib" and not named & {normal(distribution) for distribution in distributions.get(module, [module])}
    }
    assert not missing


def test_the_version_is_the_same_everywhere() -> None:
    assert "version" in PROJECT["dynamic"]
    cited = YAML(typ="safe").load(ROOT / "CITATION.cff")
    released = re.findall(r"^## \[(\d[\w.]*)\] - (\d{4}-\d\d-\d\d)$", (ROOT / "CHANGELOG.md").read_text("utf-8"), re.MULTILINE)
    assert released[0] == (jaxhydro.__version__, cited["date-released"])
    assert cited["version"] == jaxhydro.__version__ and cited["license"] == PROJECT["license"]


def test_a_wheel_has_all_that_is_needed(tmp_path: Path) -> None:
    builder = pytest.importorskip("hatchling.builders.wheel", reason="hatchling is of the dev extra")
    made = next(builder.WheelBuilder(str(ROOT)).build(directory=str(tmp_path), versions=["standard"]))
    assert Path(made).name == f"jaxhydro-{jaxhydro.__version__}-py3-none-any.whl"
    held = set(zipfile.ZipFile(made).namelist())
    for package in OWN:
        files = {path for path in (ROOT / package).rglob("*") if path.is_file() and "__pycache__" not in path.parts}
        assert {path.relative_to(ROOT).as_posix() for path in files} <= held
        assert f"{package}/py.typed" in held
    assert not [name for name in held if not name.startswith(("jaxhydro", "calibration"))]
