"""The order of the house: who imports whom, what stays at the edge, and that every load says where it comes from."""

import ast
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

from jaxhydro.loads import LOADS

ROOT = Path(__file__).resolve().parents[1]

LAYERS = (  # a module imports from layers below its own
    ("jaxhydro.environment", "jaxhydro.rotations", "jaxhydro.waves.bessel", "jaxhydro.waves.excitation", "jaxhydro.remarks",
      "jaxhydro.choices"),
    ("jaxhydro.scales", "jaxhydro.hull.coefficient_labels"),
    ("jaxhydro.hull.waterplane",),
    ("jaxhydro.waves.transfer", "jaxhydro.dynamics.solve6", "jaxhydro.hull.strips", "jaxhydro.integrators.runge_kutta", "jaxhydro.waves.continuation"),
    ("jaxhydro.hull.ends", "jaxhydro.integrators.adams_bashforth"),
    ("jaxhydro.waves.dispersion", "jaxhydro.waves.flow", "jaxhydro.waves.diffraction"),
    ("jaxhydro.hull.hull", "jaxhydro.waves.components", "jaxhydro.waves.spectra", "jaxhydro.waves.supports"),
    ("jaxhydro.waves.sea", "jaxhydro.waves.second_order", "jaxhydro.waves.sea_state", "jaxhydro.waves.envelope"),
    ("jaxhydro.waves.irregular", "jaxhydro.waves.support_sea"),
    ("jaxhydro.waves.preparation",),
    ("jaxhydro.waves.irregular_sea",),
    ("jaxhydro.waves",),
    ("jaxhydro.loads.base",),
    ("jaxhydro.loads.*",),
    ("jaxhydro.loads",),
    ("jaxhydro.dynamics.model",),
    ("jaxhydro.dynamics.integrate", "jaxhydro.dynamics.statics", "jaxhydro.dynamics.response", "jaxhydro.dynamics.table_ranges"),
    ("jaxhydro.dynamics.observe", "jaxhydro.dynamics.simulate"),
    # files in, files out: the edge
    ("jaxhydro.schema_description", "jaxhydro.analysis.spectral", "jaxhydro.start", "jaxhydro.interrupts", "jaxhydro.fingerprint"),
    ("jaxhydro.errors",),
    ("jaxhydro.platform.body", "jaxhydro.platform.guided_mass_schema", "jaxhydro.files"),
    ("jaxhydro.interop.radiation_coefficients", "jaxhydro.interop.wamit_tables"),
    ("jaxhydro.interop.wamit_radiation", "jaxhydro.interop.capytaine_radiation", "jaxhydro.interop.retardation"),
    ("jaxhydro.interop.wamit_drift", "jaxhydro.interop.wamit_excitation", "jaxhydro.interop.wamit_hydrostatics"),
    ("jaxhydro.interop.capytaine_waves",),
    ("jaxhydro.interop", "jaxhydro.platform.shared_coefficients"),
    ("jaxhydro.platform.schema", "jaxhydro.platform.drag_laws", "jaxhydro.platform.table_checks"),
    ("jaxhydro.platform.computed_hydrostatics",),
    ("jaxhydro.platform.computed_loads",),
    ("jaxhydro.platform.build", "jaxhydro.plots.style"),
    ("jaxhydro.platform.convergence",),
    ("jaxhydro",),
    ("jaxhydro.analysis.sea_statistics",),
    ("jaxhydro.plots.seas",),
    ("jaxhydro.cli.simulation_files", "jaxhydro.cli.console", "jaxhydro.cli.options"),
    ("jaxhydro.cli.sea_options",),
    ("jaxhydro.cli.simulate_command", "jaxhydro.cli.arguments"),
    ("jaxhydro.cli.sea_command",),
    ("jaxhydro.sweep.sweep_schema", "jaxhydro.sweep.lifetime", "jaxhydro.sweep.run_statistics", "jaxhydro.sweep.at_once"),
    ("jaxhydro.sweep.sweep_file", "jaxhydro.sweep.cases", "jaxhydro.sweep.sweep_figures"),
    ("jaxhydro.sweep.batch",),
    ("jaxhydro.sweep.sweep_remarks", "jaxhydro.sweep.store", "jaxhydro.sweep.resources", "jaxhydro.sweep.sensitivity"),
    ("jaxhydro.sweep.worker", "jaxhydro.sweep.write_sweep"),
    ("jaxhydro.sweep.local", "jaxhydro.sweep.cluster"),
    ("jaxhydro.sweep.run_sweep",),
    ("jaxhydro.sweep",),
    ("jaxhydro.cli.sweep_command",),
    ("jaxhydro.cli.app",),
    ("jaxhydro.__main__",),
)
SHARED_BY_LOADS = {  # what a load may import from another load's file, and the helpers that are no load
    "matrix": "*",
    "strip_inertia": {"spread"},
    "end_inertia": {"spread_ends"},
    "drag": "*",
    "per_dof": "*",
}
NUMERICS = [name for layer in LAYERS[:16] for name in layer]
EDGE = {  # third-party or built-in, and the only modules that may use it
    "matplotlib": {"jaxhydro.plots.style", "jaxhydro.sweep.sweep_figures"}
    | {f"calibration.{name}" for name in ("plot", "seas_plot", "sea_laws_plot", "uncertainty_plot")}
    | {f"calibration.discovery.{name}" for name in ("plots", "search_plots")},
    "PIL": {"jaxhydro.plots.style"},
    "ruamel": {"jaxhydro.errors"},
    "yaml": set(),
    "pandas": {f"calibration.{name}" for name in ("delimited", "matlab", "readers", "records", "signals", "spreadsheet")},
    "xarray": {f"jaxhydro.sweep.{name}" for name in ("outputs", "run", "store")}
    | {"jaxhydro.cli.simulation_files", "jaxhydro.interop.capytaine_radiation"}
    | {f"calibration.{name}" for name in ("folder", "outputs", "readers", "seas_outputs")},
    "typer": {"jaxhydro.cli.app", "jaxhydro.cli.options", "jaxhydro.cli.arguments"},
    "rich": {"jaxhydro.cli.console"},
    "filelock": {"jaxhydro.sweep.store"},
}
STANDARD = set(sys.stdlib_module_names) - {"csv", "io", "json", "logging", "os", "pathlib", "random", "sys", "warnings"}
ARRAYS = {"jax", "jaxtyping", "equinox", "diffrax", "optimistix", "lineax", "numpy"}


@cache
def modules() -> dict[str, ast.Module]:
    """Every module of the two packages, by name, as a syntax tree."""
    found = {}
    for package in ("jaxhydro", "calibration"):
        for path in (ROOT / package).rglob("*.py"):
            name = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
            found[name] = ast.parse(path.read_text(encoding="utf-8"))
    return found


def imports(name: str) -> list[tuple[str, str]]:
    """(module, name in it or "") of all imports of a module, those inside functions too."""
    found = []
    for node in ast.walk(modules()[name]):
        if isinstance(node, ast.Import):
            found += [(alias.name, "") for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{name}: imports are absolute"
            for alias in node.names:
                whole = f"{node.module}.{alias.name}"
                found.append((whole, "") if whole in modules() else (node.module or "", alias.name))
    return found


def layer(name: str) -> int:
    """Its place in LAYERS."""
    for pattern in (name, name.rsplit(".", 1)[0] + ".*"):
        for i, names in enumerate(LAYERS):
            if pattern in names:
                return i
    raise AssertionError(f"{name} has no place in LAYERS of {Path(__file__).name}: say which layer it belongs to")


@pytest.mark.parametrize("name", sorted(name for name in modules() if name.startswith("jaxhydro")))
def test_a_module_imports_only_what_is_below_it(name: str) -> None:
    """architecture.md, "Who may import whom"."""
    for module, what in imports(name):
        if module.split(".")[0] != "jaxhydro":
            continue
        if name.startswith("jaxhydro.loads.") and module.startswith("jaxhydro.loads."):
            short = module.rsplit(".", 1)[1]
            allowed = SHARED_BY_LOADS.get(short, set())
            assert short == "base" or allowed == "*" or what in allowed, f"{name} imports {what} of the load {module}"
        elif (module, what) != ("jaxhydro", ""):  # `import jaxhydro` for its version, in functions of the edge
            assert layer(module) < layer(name), f"{name} imports {module}, which is not below it"


def test_the_shared_helpers_of_loads_are_no_loads() -> None:
    """A load never imports another load's class: the exceptions above are functions, constants, or no load at all."""
    classes = {load.__name__ for load in LOADS.values()}
    for name in modules():
        if name.startswith("jaxhydro.loads."):
            assert not classes & {what for module, what in imports(name) if module.startswith("jaxhydro.loads.")}


def test_sweeps_are_known_to_the_edge_only() -> None:
    """So what evidence is made of (benchmarks/evidence/common.fingerprint) does not depend on them."""
    left_out = ("jaxhydro.sweep", "jaxhydro.cli.sea_command", "calibration.report.sweep_page")
    for name in modules():
        if not name.startswith((*left_out, "jaxhydro.cli.app", "calibration.report.write_report")):
            known = {module for module, _ in imports(name) if module.startswith(left_out)}
            assert not known, f"{name} imports {known}"


def test_the_simulator_does_not_know_calibration() -> None:
    """architecture.md: jaxhydro never imports calibration, the command line aside."""
    simulator = [name for name in modules() if name.startswith("jaxhydro")]
    users = {name for name in simulator if any(module.startswith("calibration") for module, _ in imports(name))}
    assert users <= {"jaxhydro.cli.app", "jaxhydro.cli.simulate_command"}


def test_calibration_uses_public_names_and_not_the_command_line() -> None:
    """architecture.md: calibration imports only jaxhydro's public names."""
    edge = ("jaxhydro.cli.app", "jaxhydro.cli.simulate_command", "jaxhydro.cli.options")
    for name in modules():
        if name.startswith("calibration"):
            for module, what in imports(name):
                assert module not in edge, f"{name} imports {module}"
                assert not (module.startswith("jaxhydro") and what.startswith("_")), f"{name} imports {module}.{what}"


@pytest.mark.parametrize("package", sorted(EDGE))
def test_figures_files_and_tables_stay_at_the_edge(package: str) -> None:
    """architecture.md: YAML, CSV, matplotlib and progress bars live at the edge."""
    users = {name for name in modules() if any(m.split(".")[0] == package for m, _ in imports(name))}
    assert users <= EDGE[package]


@pytest.mark.parametrize("name", sorted(name for name in modules() if name.startswith("jaxhydro")))
def test_numerics_are_pure(name: str) -> None:
    """Numerics import arrays and solvers only; nothing prints; float64 is switched on at the edge."""
    if any(name == known or (known.endswith(".*") and name.startswith(known[:-1])) for known in NUMERICS):
        roots = {module.split(".")[0] for module, _ in imports(name)}
        assert roots <= STANDARD | ARRAYS | {"jaxhydro"}, f"{name} imports {sorted(roots - STANDARD - ARRAYS)}"
    called = {ast.unparse(node.func) for node in ast.walk(modules()[name]) if isinstance(node, ast.Call)}
    assert "print" not in called
    assert name == "jaxhydro.start" or not any(function.endswith("config.update") for function in called)


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


@pytest.mark.parametrize("name", LOADS)
def test_a_load_names_its_source(name: str) -> None:
    """architecture.md: a source named in its docstring, and in `source` for people."""
    load = LOADS[name]
    assert load.source.strip()
    assert load.__doc__ and load.source.split()[0] in load.__doc__
    assert load.__module__ == f"jaxhydro.loads.{'hydrostatics' if name == 'buoyancy' else name}"
