"""What `jaxhydro` and `calibration` offer by name: explicit arguments, and names that hide no module."""

import ast
import importlib
import inspect
import pkgutil
from pathlib import Path
from types import ModuleType

import pytest

import calibration
import jaxhydro

SHADOWED = {("jaxhydro.waves", "components")}  # a function with the name of its module, which is imported by either name


@pytest.mark.parametrize("package", [jaxhydro, calibration], ids=lambda package: package.__name__)
def test_arguments_are_explicit(package: ModuleType) -> None:
    """So that an editor completes them and a type checker knows them."""
    functions = {name: member for name in package.__all__ if inspect.isfunction(member := getattr(package, name))}
    assert len(functions) > 10
    for name, function in functions.items():
        kinds = {parameter.kind for parameter in inspect.signature(function).parameters.values()}
        assert inspect.Parameter.VAR_KEYWORD not in kinds, name


@pytest.mark.parametrize("package", [jaxhydro, calibration], ids=lambda package: package.__name__)
def test_no_function_hides_a_module(package: ModuleType) -> None:
    folders = [package.__name__]
    folders += [
        module_info.name for module_info in pkgutil.walk_packages(package.__path__, f"{package.__name__}.") if module_info.ispkg
    ]
    hidden = set()
    for folder in folders:
        module = importlib.import_module(folder)
        for module_info in pkgutil.iter_modules(module.__path__):
            if not isinstance(getattr(module, module_info.name, module), ModuleType):
                hidden.add((folder, module_info.name))
    assert hidden <= SHADOWED


def test_names_of_calibration_are_imported_from_where_type_checkers_find_them() -> None:
    """They are listed twice: for type checkers, and for the import of each when it is asked for."""
    tree = ast.parse(Path(calibration.__file__).read_text(encoding="utf-8"))
    imports = [
        node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and str(node.module).startswith("calibration.")
    ]
    assert {alias.name: node.module for node in imports for alias in node.names} == calibration._MODULES
    assert sorted(calibration._MODULES) == sorted(calibration.__all__)
    assert set(calibration.__all__) <= set(dir(calibration))
    with pytest.raises(AttributeError, match="'calibration' has no attribute 'nothing'"):
        calibration.nothing  # noqa: B018
