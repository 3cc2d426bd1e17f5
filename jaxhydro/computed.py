"""The computed radiation that a platform file names, made into a load."""

from functools import lru_cache
from pathlib import Path

from jaxhydro.interop.capytaine import read_capytaine
from jaxhydro.interop.wamit import read_wamit
from jaxhydro.loads import ComputedRadiation
from jaxhydro.problems import InputError, Problem
from jaxhydro.retardation import Realisation, realise

POOR = 0.25  # misfit from which on a state space is none of the coefficients


def computed_radiation(
    file: Path, kind: str, density: float, length: float, order: int, tolerance: float, share: float
) -> ComputedRadiation:
    """The load of a file: `share` of its radiation, by a state space of at most `order` states that is to meet `tolerance`.
    Raises InputError where the file is wrong, or no such state space comes near it."""
    stamp = file.stat().st_mtime_ns if file.is_file() else 0
    space = _realised(file, stamp, kind, density, length, order, tolerance)
    return ComputedRadiation.of(space.rates, space.drive, space.output, share)


@lru_cache(maxsize=8)
def _realised(file: Path, stamp: int, kind: str, density: float, length: float, order: int, tolerance: float) -> Realisation:
    coefficients = read_wamit(file, density, length) if kind == "wamit" else read_capytaine(file)
    try:
        space = realise(coefficients, tolerance, order)
    except ValueError as error:
        expected = "radiation damping that takes energy, and that a state space can follow"
        raise InputError(str(file), [Problem("", expected, str(error))]) from None
    if space.misfit > POOR:
        found = f"a misfit of {100 * space.misfit:.0f} % with {space.order}"
        raise InputError(str(file), [Problem("radiation.order", "enough states to follow the coefficients", found)])
    return space
