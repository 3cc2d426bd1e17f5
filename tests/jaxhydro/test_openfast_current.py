"""The steady current of an OpenFAST deck: OpenFAST's formula (Current.f90) written out beside the platform file's profile."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from jaxhydro.errors import InputError
from jaxhydro.input_schema import validate
from jaxhydro.interop.conversion import Treatment
from jaxhydro.interop.openfast.deck_current import read_current
from jaxhydro.interop.openfast.open_file import read_keyed_file
from jaxhydro.interop.openfast_deck import read_openfast_deck
from jaxhydro.platform.current_schema import SteadyCurrent

DECK, DEPTH = Path(__file__).resolve().parents[1] / "fixtures" / "openfast_deck", 180.0
KEYS = ("CurrMod", "CurrSSV0", "CurrSSDir", "CurrNSRef", "CurrNSV0", "CurrNSDir", "CurrDIV", "CurrDIDir")


def converted(folder: Path, *values: object):
    path = folder / "seastate.dat"
    rows = [f"{value}   {key}   - of the test" for key, value in zip(("WaveDir", *KEYS), (25, *values))]
    path.write_text("\n".join(["--- SeaState ---", "Made for a test", *rows]) + "\n")
    current, items = read_current(read_keyed_file(path, "a file"), DEPTH)
    return current, [(item.treatment, item.meaning) for item in items]


def openfast(z, ss, ss_dir, ref, ns, ns_dir, di, di_dir):
    """`Calc_Current`: x and y components (m/s) at heights (m)."""
    sub, near = ss * ((z + DEPTH) / DEPTH) ** (1 / 7), np.maximum(ns * (z + ref) / ref, 0.0)
    parts = ((sub, ss_dir), (near, ns_dir), (di + 0.0 * z, di_dir))
    return np.array([sum(v * f(np.radians(d)) for v, d in parts) for f in (np.cos, np.sin)])


@pytest.mark.parametrize(
    ("values", "treatment", "within"),
    [
        ((1, 0.8, 40.0, 20, 0, 0, 0, 0), Treatment.TAKEN, 2e-3),
        ((1, 0, 0, 20, 0, 0, 0.5, -70.0), Treatment.TAKEN, 1e-12),
        ((1, 0, 0, 30, 0.6, 10.0, 0, 0), Treatment.TAKEN, 1e-6),
        ((1, 0, 0, 30, 0.6, 10.0, 0.5, 120.0), Treatment.TAKEN, 2e-6),
        ((1, 0, 0, 400, 0.6, 10.0, 0.5, 120.0), Treatment.TAKEN, 2e-6),
        ((1, 0.8, 40.0, 30, 0.6, -60.0, 0.2, 180.0), Treatment.APPROXIMATED, 0.06),
    ],
)
def test_the_profile_is_openfast_s(tmp_path, values, treatment, within) -> None:
    """At all depths within what is said; the power law is steep at the bed alone, so most of the depth is closer."""
    current, ((actual, meaning),) = converted(tmp_path, *values)
    assert actual is treatment
    heights, velocity = validate(SteadyCurrent, current, "current").profile(DEPTH)
    z = np.linspace(-DEPTH, 0.0, 2001)
    off = np.abs([np.interp(z, heights, row) for row in velocity] - openfast(z, *values[1:]))
    assert off[:, z > -0.95 * DEPTH].max() < within
    if treatment is Treatment.APPROXIMATED:
        bound = float(meaning.partition("within ")[2].partition(" m/s")[0])
        assert np.hypot(*off).max() <= 1.06 * bound < 0.2


def test_default_and_what_is_left_out(tmp_path) -> None:
    """DEFAULT is the waves' direction. No current, a user's routine, no speeds."""
    assert converted(tmp_path, 1, 0.8, '"DEFAULT"', 20, 0, 0, 0, 0)[0] == {"speed": 0.8, "heading": 25.0, "exponent": 1 / 7}
    assert converted(tmp_path, 0, 0.8, 0, 20, 0, 0, 0, 0) == ({}, [])
    for values, words in (((2, 0, 0, 20, 0, 0, 0, 0), "user's routine"), ((1, 0, 0, 20, 0, 0, 0, 0), "there is no current")):
        current, ((treatment, meaning),) = converted(tmp_path, *values)
        assert current == {} and treatment is Treatment.LEFT_OUT and words in meaning


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ((1, -0.8, 0, 20, 0, 0, 0, 0), "CurrSSV0: expected a speed >= 0, in m/s, found -0.8"),
        ((1, 0, 0, 0, 0.5, 0, 0, 0), "CurrNSRef: expected a depth > 0, in m, found 0"),
        ((1, 0.8, "east", 20, 0, 0, 0, 0), "CurrSSDir: expected a number, found 'east'"),
    ],
)
def test_wrong_numbers_are_told_by_line_and_key(tmp_path, values, words) -> None:
    with pytest.raises(InputError) as error:
        converted(tmp_path, *values)
    assert words in str(error.value) and "seastate.dat" in str(error.value) and "line " in str(error.value)


def test_a_deck_s_platform_has_the_current(tmp_path) -> None:
    folder = tmp_path / "deck"
    shutil.copytree(DECK, folder)
    text = (folder / "seastate.dat").read_text()
    row = next(line for line in text.splitlines() if "CurrMod" in line)
    (folder / "seastate.dat").write_text(text.replace(row, f'{row}\n 0.7   CurrSSV0   - m/s\n "DEFAULT"   CurrSSDir   - deg'))
    deck = read_openfast_deck(folder / "main.fst")
    assert deck.platform["water"]["current"] == {"speed": 0.7, "heading": 30.0, "exponent": 1 / 7}
    (item,) = [entry for entry in deck.items if "CurrMod" in entry.source]
    assert item.treatment is Treatment.TAKEN and "`water.current`" in item.meaning
