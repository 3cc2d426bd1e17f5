"""What stays at the edge, and that every load says where it comes from. Who may import whom: [tool.importlinter]."""

import ast
import subprocess
import sys
from collections import defaultdict
from functools import cache
from pathlib import Path

import pytest

from benchmarks import architecture_page
from jaxhydro.loads import LOADS
from jaxhydro.loads.drag import DRAG_LAWS
from jaxhydro.sensors import SENSOR_EFFECTS
from jaxhydro.water import WATER_EFFECTS

ROOT = Path(__file__).resolve().parents[2]
FAMILIES = {"loads": LOADS, "loads.drag": DRAG_LAWS, "water": WATER_EFFECTS, "sensors": SENSOR_EFFECTS}

SHARED_BY_LOADS = {  # what a load may import from another load's file, and the helpers that are no load
    "catenary_profile": "*",
    "catenary_tension": "*",
    "matrix": "*",
    "coefficients": "*",
    "abstract_law": "*",
    "abstract_excitation": "*",
    "abstract_lines": "*",
    "constant_law": "*",
    "drag_flow": "*",
    "per_dof": "*",
    "instant": "*",
    "forces_at_rest": "*",
    "slender_flow": "*",
    "slow_displacement": "*",
}
EDGE = {  # third-party or built-in, and the only folders or modules that may use it
    "matplotlib": {"jaxhydro.plots", "jaxhydro.sweep.sweep_figures", "calibration.plots"},
    "PIL": {"jaxhydro.plots"},
    "ruamel": {"jaxhydro.input_schema", "jaxhydro.interop.yaml_text"},
    "yaml": set(),
    "pandas": {
        *("jaxhydro.display", "calibration.display"),
        *("jaxhydro.interop", "calibration.campaign.series", "calibration.campaign.signals"),
        *("calibration.new_campaign.column_guesses", "calibration.new_campaign.draft_of_files"),
    },
    "xarray": {
        *("jaxhydro.interop", "jaxhydro.sweep", "jaxhydro.display", "jaxhydro.cli.simulation_files"),
        *("calibration.results", "calibration.report.recorded_motion", "calibration.report.simulation_page"),
    },
    "arviz": {"calibration.display"},
    "typer": {"jaxhydro.cli"},
    "rich": {"jaxhydro.cli.console"},
    "filelock": {"jaxhydro.sweep.store"},
    "jinja2": {"calibration.report.web_page", "jaxhydro.interop.openfast.export_text"},
}
NUMERICS = ("waves", "hull", "loads", "water", "sensors", "integrators", "dynamics")
NOT_PURE = {
    "jaxhydro.dynamics.sea_of_record",  # tells what is wrong with a record
    "jaxhydro.dynamics.sea_of_request",  # tells what is wrong with a sea that was asked for
    "jaxhydro.waves.stream_function",  # asks raschii for coefficients
}
STANDARD = set(sys.stdlib_module_names) - {"csv", "io", "json", "logging", "os", "pathlib", "random", "sys", "warnings"}
ARRAYS = {"jax", "jaxtyping", "equinox", "diffrax", "optimistix", "lineax", "numpy"}


@cache
def modules() -> dict[str, ast.Module]:
    """Every module of the two packages, by name, as a syntax tree."""
    trees = {}
    for package in ("jaxhydro", "calibration"):
        for path in (ROOT / package).rglob("*.py"):
            name = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
            trees[name] = ast.parse(path.read_text(encoding="utf-8"))
    return trees


@cache
def imports(name: str) -> tuple[tuple[str, str], ...]:
    """(module, name in it or "") of all imports of a module, those inside functions too, but those for annotations alone."""
    blocks = [node for node in ast.walk(modules()[name]) if isinstance(node, ast.If)]
    annotations = {id(part) for node in blocks if ast.unparse(node.test) == "TYPE_CHECKING" for part in ast.walk(node)}
    imported = []
    for node in (node for node in ast.walk(modules()[name]) if id(node) not in annotations):
        if isinstance(node, ast.Import):
            imported += [(alias.name, "") for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{name}: imports are absolute"
            for alias in node.names:
                whole = f"{node.module}.{alias.name}"
                imported.append((whole, "") if whole in modules() else (node.module or "", alias.name))
    return tuple(imported)


def inside(name: str, folders: set[str]) -> bool:
    """Whether a module is one of, or lies in one of, the named."""
    return any(name == folder or name.startswith(f"{folder}.") for folder in folders)


def test_who_may_import_whom() -> None:
    """The contracts in pyproject.toml: layers, no cycles, who imports calibration and who the command line."""
    run = subprocess.run(
        [str(Path(sys.executable).parent / "lint-imports"), "--no-cache"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stdout


def test_the_tree_in_the_documentation_is_that_of_the_packages() -> None:
    """Renewed by `python -m benchmarks.architecture_page`."""
    text = architecture_page.PAGE.read_text(encoding="utf-8")
    assert text == architecture_page.page(text)


def test_no_two_files_of_a_package_have_one_name() -> None:
    """A name says which file is meant."""
    files = defaultdict(list)
    for name in modules():
        if (ROOT / Path(*name.split("."))).with_suffix(".py").exists():
            files[name.split(".")[0], name.rsplit(".", 1)[1]].append(name)
    assert not {key: names for key, names in files.items() if len(names) > 1}


def test_a_load_shares_helpers_with_others_only() -> None:
    """Loads import base.py, and of each other no more than `SHARED_BY_LOADS`."""
    for name in modules():
        for module, what in imports(name):
            if name.startswith("jaxhydro.loads.") and name != "jaxhydro.loads.drag" and module.startswith("jaxhydro.loads."):
                short = module.rsplit(".", 1)[1]
                allowed = SHARED_BY_LOADS.get(short, set())
                assert short == "base" or allowed == "*" or what in allowed, f"{name} imports {what} of the load {module}"


def test_the_shared_helpers_of_loads_are_no_loads() -> None:
    """A load never imports another load's class: the exceptions above are functions, constants, or no load at all."""
    classes = {load.__name__ for load in LOADS.values()}
    for name in modules():
        if name.startswith("jaxhydro.loads.") and name != "jaxhydro.loads.drag":
            assert not classes & {what for module, what in imports(name) if module.startswith("jaxhydro.loads.")}


def test_sweeps_are_known_to_the_edge_only() -> None:
    """So what evidence is made of (benchmarks/evidence/common.fingerprint) does not depend on them."""
    left_out = {"jaxhydro.sweep", "calibration.report.sweep_page"}
    for name in modules():
        if not inside(name, left_out | {"jaxhydro.cli", "calibration.report", "calibration.results.schema"}):
            edge_imports = {module for module, _ in imports(name) if inside(module, left_out)}
            assert not edge_imports, f"{name} imports {edge_imports}"


def test_calibration_uses_public_names_and_not_the_command_line() -> None:
    """Of the command line it has the console alone: what its own commands print with."""
    for name in modules():
        if name.startswith("calibration"):
            for module, what in imports(name):
                assert module == "jaxhydro.cli.console" or not inside(module, {"jaxhydro.cli"}), f"{name} imports {module}"
                assert not (module.startswith("jaxhydro") and what.startswith("_")), f"{name} imports {module}.{what}"


@pytest.mark.parametrize("package", sorted(EDGE))
def test_figures_files_and_tables_stay_at_the_edge(package: str) -> None:
    """YAML, tables, matplotlib and progress bars live at the edge."""
    users = {name for name in modules() if any(m.split(".")[0] == package for m, _ in imports(name))}
    assert not [name for name in users if not inside(name, EDGE[package])]


@pytest.mark.parametrize("name", sorted(name for name in modules() if name.startswith("jaxhydro")))
def test_numerics_are_pure(name: str) -> None:
    """Numerics import arrays and solvers only; nothing prints; float64 is switched on at the edge."""
    if inside(name, {f"jaxhydro.{folder}" for folder in NUMERICS}) and name not in NOT_PURE:
        roots = {module.split(".")[0] for module, _ in imports(name)}
        assert roots <= STANDARD | ARRAYS | {"jaxhydro"}, f"{name} imports {sorted(roots - STANDARD - ARRAYS)}"
    called = {ast.unparse(node.func) for node in ast.walk(modules()[name]) if isinstance(node, ast.Call)}
    assert "print" not in called
    assert name == "jaxhydro.jax_settings" or not any(function.endswith("config.update") for function in called)


def test_matplotlib_has_no_global_state_in_the_packages() -> None:
    """pyplot keeps figures alive; artists are made from Figure."""
    assert not [name for name in modules() if any(m == "matplotlib.pyplot" for m, _ in imports(name))]


def test_import_brings_in_nothing_of_the_edge() -> None:
    """Figures, tables and the command line cost their import only where they are used."""
    edge = ["matplotlib", "pandas", "xarray", "h5py", "scipy", "rich", "typer", "PIL", "zarr", "rainflow", "psutil"]
    heavy = [*edge, "diffrax", "distributed", "calibration"]
    code = f"import jaxhydro, sys; print(*[m for m in {heavy!r} if m in sys.modules])"
    run = subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT, capture_output=True, text=True)
    assert run.stdout.split() == []


@pytest.mark.parametrize("family, name", [(family, name) for family in FAMILIES for name in FAMILIES[family]])
def test_an_effect_names_its_source(family: str, name: str) -> None:
    """A source named in its docstring, and in `source` for people."""
    effect = FAMILIES[family][name]
    assert effect.source.strip()
    assert effect.__doc__ and effect.source.split()[0] in effect.__doc__
    moved = {"buoyancy": "hydrostatics", "morison_drag": "drag.morison_drag", "catenary_lines": "catenary.catenary_lines"}
    file = moved.get(name, name)
    assert effect.__module__ == f"jaxhydro.{family}.{file}" or family == "loads.drag"
