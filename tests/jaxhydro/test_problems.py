"""Bad input of any kind is told as an InputError, in readable lines, and nothing else ever comes out."""

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import jaxhydro
from jaxhydro.errors import InputError, Problem, suggest
from jaxhydro.input_schema import read_yaml, validate
from jaxhydro.platform.schema import Platform, builtin_platforms, load_platform

# --- files that are no mapping at all

UNREADABLE: list[tuple[bytes, str]] = [
    (b"", "expected a mapping of keys to values, found an empty file"),
    (b"# nothing\n", "found an empty file"),
    (b"- 1\n", "expected a mapping of keys to values, found [1]"),
    (b"just text", "found 'just text'"),
    (b"name: a\nwater: [1\n", "line 3, column 1: expected valid YAML"),
    (b"name: a\n  water: 3\n", "line 2, column 8: expected valid YAML"),
    (b"name: a\nname: b\n", 'line 2, column 1: expected each key once, found duplicate key "name"'),
    (b"water: {depth: 1, depth: 2}\n", 'line 1, column 19: expected each key once, found duplicate key "depth"'),
    (b"name: a\n\twater: 3\n", "line 2, column 1: expected valid YAML"),
    (b"name: a\nwater: \xff\n", "line 2: expected text in UTF-8, found the byte 0xff"),
    (b"name: a\nwater: \x01\n", "line 2: expected text, found the control character 0x01"),
    (b"name: *other\n", "line 1, column 7: expected valid YAML"),
    (b"name: !!python/object:os.system {}\n", "line 1, column 7: expected valid YAML"),
    (b"name: a\n---\nname: b\n", "line 2, column 1: expected valid YAML"),
    (b"name: 2020-13-45\n", "expected valid YAML, found a value that cannot be read"),
    (b"[" * 3000, "expected valid YAML, found lists or mappings nested too deeply"),
    (b"name: &name [*name]\n", "name: expected text"),
    (b"water: {density: .inf, depth: .nan}\n", "water.density: expected a finite number > 0, found inf"),
    (b"{1: 2, 1.5: 3, null: 4}\n", "1: expected a known key"),
    (b"coefficients: {1: {}}\n", "coefficients.1: expected a key that is text, found 1"),
    (b'"k\\ney": 1\n', "k ey: expected a known key"),
    (b"name: a\ntests: []\n", "expected a platform file (members, rigid_body), found a campaign file"),
    (b"platform: a\nscatter: []\n", "found a sweep file"),
]


@pytest.mark.parametrize(("content", "words"), UNREADABLE, ids=range(len(UNREADABLE)))
def test_unreadable_files_are_told_with_their_line(tmp_path: Path, content: bytes, words: str) -> None:
    file = tmp_path / "platform.yaml"
    file.write_bytes(content)
    with pytest.raises(InputError) as caught:
        load_platform(file)
    assert str(caught.value).startswith(str(file))
    assert words in str(caught.value)


def test_missing_files_folders_and_names(tmp_path: Path) -> None:
    for path, words in (
        (tmp_path, "expected a YAML file, found a folder"),
        (tmp_path / "none.yaml", "expected a YAML file, found no such file"),
        (str(tmp_path / "none"), "expected a YAML file, found no such file"),
        ("a\0.yaml", "expected a readable YAML file"),
        ("volturnus", "volturnus-s, volturnus-s-focal), found 'volturnus'. Did you mean 'volturnus-s'?"),
    ):
        with pytest.raises(InputError) as caught:
            load_platform(path)
        assert words in str(caught.value)


def test_problems_as_text() -> None:
    problem = Problem("a[1].b", "a number", "'x'", "Try 1.")
    assert str(problem) == "a[1].b: expected a number, found 'x'. Try 1."
    assert str(InputError("f.yaml", [problem])) == "f.yaml: a[1].b: expected a number, found 'x'. Try 1."
    assert suggest("Haeding", ["heading", "name"]) == "Did you mean 'heading'?"
    assert suggest("xyz", ["heading", "name"]) == ""


def test_documents_to_change_are_good() -> None:
    for name, data in DOCUMENTS.items():
        assert validate(Platform, data, name).members


# --- anything at all

SCALARS = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(10**20), 10**400),
    st.floats(),
    st.text(max_size=8),
    st.sampled_from(["circ", "rect", "none", "stiffness_matrix", "linear_springs", "parts", "column", "1e6"]),
    st.dates(),
    st.binary(max_size=3),
)
ANY = st.recursive(
    SCALARS,
    lambda inner: st.lists(inner, max_size=6) | st.dictionaries(st.text(max_size=4) | st.integers(), inner, max_size=4),
    max_leaves=8,
)


def places(data: Any) -> list[tuple[Any, Any]]:
    """Every container and key in a document."""
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    return [pair for key, value in items for pair in ((data, key), *places(value))]


def delete(data: Any, key: Any, _: Any) -> None:
    del data[key]


def replace(data: Any, key: Any, value: Any) -> None:
    data[key] = value


def rename(data: Any, key: Any, value: Any) -> None:
    if isinstance(data, dict):
        data[str(key)[1:] + str(value)[:1]] = data.pop(key)
    else:
        data.append(value)


def swap(data: Any, key: Any, value: Any) -> None:
    data[key] = [data[key], value] if isinstance(data, dict) else {"x": data[key]}


CHANGES: list[Callable[[Any, Any, Any], None]] = [delete, replace, rename, swap]
CHANGE = st.tuples(st.sampled_from(CHANGES), st.integers(0, 10**6), ANY)


FILES = {name: Path(jaxhydro.__file__).parent / "platforms" / f"{name}.yaml" for name in builtin_platforms()}
DOCUMENTS = {name: read_yaml(file) for name, file in FILES.items()}
PARTS = [{"name": name, "mass": 1e7, "centre_of_mass": [0, 0, -9], "inertia": {"Ixx": 3, "Iyy": 3, "Izz": 3}} for name in "ab"]
DOCUMENTS["parts"] = {
    **DOCUMENTS["volturnus-s"],
    "rigid_body": {"parts": PARTS},
    "mooring": {"kind": "stiffness_matrix", "stiffness": np.eye(6).tolist()},
    "members": [
        {"name": "a", "shape": "rect", "d": [[1.0, 2.0]] * 3, "stations": [0, 1, 2], "rA": [0, 0, -9], "rB": [0, 0, 1]},
        {"name": "b", "shape": "circ", "d": [1.0, 2.0], "stations": [0, 1], "rA": [0, 5, -9], "rB": [1, 5, -9]},
    ],
    "coefficients": {"a": {"Ca_t": 1.0}, "b": {}},
}
GOOD = FILES["volturnus-s-focal"].read_text(encoding="utf-8")


@pytest.mark.slow
@settings(max_examples=400, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.sampled_from(sorted(DOCUMENTS)), st.lists(CHANGE, min_size=1, max_size=3))
def test_no_change_of_a_good_file_does_anything_but_load_or_tell(name: str, changes: list[Any]) -> None:
    data = copy.deepcopy(DOCUMENTS[name])
    for change, where, value in changes:
        if all_places := places(data):
            change(*all_places[where % len(all_places)], value)
    try:
        platform = validate(Platform, data, "platform.yaml")
    except InputError as error:
        assert error.problems
        assert all("\n" not in str(problem) for problem in error.problems)
        assert all(problem.expected and problem.found for problem in error.problems)
    else:
        platform.rigid_body.combined()
        assert all(np.isfinite(member.profile()[1]).all() for member in platform.members)


@pytest.mark.slow
@settings(max_examples=200, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.integers(0, len(GOOD)), st.integers(0, 30), st.text("{}[]:,-&*!|>%@`\"'#?\n\t \x00.0aé~<", max_size=5))
def test_no_text_does_anything_but_load_or_tell(tmp_path_factory: Any, start: int, cut: int, text: str) -> None:
    file = tmp_path_factory.getbasetemp() / "fuzz.yaml"
    file.write_text(GOOD[:start] + text + GOOD[start + cut :], encoding="utf-8")
    try:
        load_platform(file)
    except InputError as error:
        assert error.problems
