"""The golden set: commands give the numbers that are kept, so that code can be moved without moving a result."""

import pytest
from golden.commands import CASES, compare, differences


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_numbers_are_those_kept(name: str) -> None:
    needs = CASES[name].needs
    if needs is not None and not needs.exists():
        pytest.skip(f"{needs} is not there")
    lines = compare(name)
    assert not lines, "\n".join(lines[:40])


def test_differences_are_told() -> None:
    expected = {"a": 1.0, "b": 2, "c": True, "d": "surge", "e": None, "f": 3.0}
    actual = {"a": 1.0 + 1e-12, "b": 2.001, "c": False, "d": "heave", "e": 0.0}
    lines = differences(expected, actual, 1e-9)
    assert [line.partition(":")[0] for line in lines] == ["b", "c", "d", "e", "f"]
    assert not differences(expected, expected | {"new": 1.0}, 1e-9)
