"""Public hulls and decks, converted and compared with published values.

    python -m benchmarks.public_hulls FOLDER [--only HULL ...] [--again]

FOLDER holds copies of public repositories, each under its own name, at any commit that has the files:

- FOLDER/RAFT: WISDEM/RAFT (tests/test_data, designs)
- FOLDER/IEA-15-240-RWT: IEAWindSystems/IEA-15-240-RWT (OpenFAST)
- FOLDER/IEA-22-280-RWT: IEAWindSystems/IEA-22-280-RWT (OpenFAST)
- FOLDER/FAST: old-NWTC/FAST (CertTest), the decks of FAST 8

Nothing of them is kept here. Raw results go to benchmarks/results-public-hulls.json after every hull; hulls that are in it are
not run again without `--again`. The text, benchmarks/results-public-hulls.md, is made from the raw results alone. A hull whose
source is absent is named and left out. Statics of RAFT's designs are those of `benchmarks.raft_designs`.

Hulls, published values and reasons: `benchmarks.public_hulls_cases`.
"""

import argparse
import json
import math
import re
import shutil
import tempfile
import time
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from benchmarks.public_hulls_cases import CASES, Case
from benchmarks.public_hulls_motions import motions
from benchmarks.public_hulls_text import text
from jaxhydro.dynamics.statics import EquilibriumError
from jaxhydro.errors import InputError, Problem

RAW, TEXT = (Path(__file__).with_name(f"results-public-hulls.{ending}") for ending in ("json", "md"))
RAFT_RESULTS = Path(__file__).with_name("raft") / "converted.json"  # of benchmarks.raft_designs
ITERATIONS = 20  # of a period with the added mass of its own frequency
DOFS = ("surge", "sway", "heave", "roll", "pitch", "yaw")


def with_edits(source: Path, edits: Mapping[str, Mapping[str, str]], folder: Path) -> Path:
    """Copy of a deck with values of keys changed.

    Args:
        source: The deck's main file.
        edits: Values by key, by file relative to the main file's folder. A key that a file lacks is added to its end.
        folder: Where the copy is made.

    Returns:
        The copy's main file.
    """
    if not edits:
        return source
    copy = folder / "deck"
    shutil.copytree(source.parent, copy)
    for name, values in edits.items():
        content = (copy / name).read_text(encoding="utf-8", errors="replace")
        for key, value in values.items():
            content, count = re.subn(rf"(?m)^\s*\S+(\s+{re.escape(key)}\s)", rf"{value}\1", content)
            content += "" if count else f"\n{value}  {key}  - added\n"
        (copy / name).write_text(content, encoding="utf-8")
    return copy / source.name


def missing(folder: Path, case: Case) -> str | None:
    """Name of the first file of a hull's source that is not in the folder, or None."""
    return next((name for name in (case.source, *case.needs) if not (folder / name).is_file()), None)


class Hull(NamedTuple):
    """A converted hull.

    Attributes:
        model: Its model.
        volume: Displaced volume (m3) that the source states, or None.
        radiation: Added mass by frequency, or None.
        read: What became of the source's items.
    """

    model: Any
    volume: float | None
    radiation: Any
    read: dict[str, Any]


def built(folder: Path, case: Case) -> Hull:
    """Convert a hull and build it by way of its platform file."""
    from ruamel.yaml import YAML

    import jaxhydro as jh
    from jaxhydro.interop.converters import convert_file
    from jaxhydro.interop.wamit_radiation import read_wamit

    with tempfile.TemporaryDirectory() as temporary:
        out = Path(temporary)
        conversion = convert_file(with_edits(folder / case.source, case.edits, out))
        for name, path in conversion.files.items():
            shutil.copyfile(path, out / name)
        YAML().dump(conversion.platform, out / "platform.yaml")
        model = jh.build(jh.load_platform(out / "platform.yaml"))
        stated, table = conversion.platform.get("hydrostatics", {}), conversion.platform.get("radiation")
        density = float(model.environment.density)
        radiation = table and read_wamit(out / table["file"], density, table.get("length", 1.0))
    items = dict(Counter(item.treatment.value for item in conversion.items))
    warnings = [item.meaning for item in conversion.items if item.warning]
    return Hull(model, stated.get("displaced_volume"), radiation, {"items": items, "warnings": warnings})


def natural_periods(mass: np.ndarray, stiffness: np.ndarray, radiation: Any) -> dict[str, float]:
    """Undamped natural periods (s) by the motion that has most of a mode's strain energy.

    Args:
        mass: Mass with added mass (kg, kg m, kg m2), (6, 6); with radiation that of infinite frequency.
        stiffness: Stiffness (N/m, N, N m), (6, 6).
        radiation: Added mass by frequency, which each mode takes at its own frequency, or None.
    """

    def modes(mass: np.ndarray) -> dict[str, float]:
        square, vectors = np.linalg.eig(np.linalg.solve(mass, stiffness))
        periods: dict[str, float] = {}
        for i in np.argsort(square.real):
            vector = vectors[:, i].real
            dof = DOFS[int(np.argmax(np.abs(vector * (stiffness @ vector))))]
            if square[i].real > 1e-10 * square.real.max() and dof not in periods:
                periods[dof] = 2 * math.pi / math.sqrt(square[i].real)
        return periods

    periods = modes(mass)
    if radiation is None:
        return periods
    omega, added = radiation.omega, radiation.added_mass
    if radiation.zero is not None:
        omega, added = np.array([0.0, *omega]), np.array([radiation.zero, *added])
    own = {}
    for dof, period in periods.items():
        for _ in range(ITERATIONS):
            at = [[np.interp(2 * math.pi / period, omega, added[:, i, j]) for j in range(6)] for i in range(6)]
            period = modes(mass + np.array(at) - radiation.infinite).get(dof, period)
        own[dof] = period
    return own


def stored(case: Case) -> tuple[dict[str, Any], dict[str, Any]] | None:
    """What was read and the statics of a RAFT design, as `benchmarks.raft_designs` has worked them out, or None."""
    results = json.loads(RAFT_RESULTS.read_text("utf-8"))
    if (design := results.get(case.source.removeprefix("RAFT/"))) is None:
        return None
    own, items = design["converted"], design["items"]
    rest = own.get("rest")
    periods = own["periods" if rest is None else "periods_at_rest"]
    periods = {dof: period for dof, period in periods.items() if math.isfinite(period)}
    read = {"items": dict(Counter(item["treatment"] for item in items)), "warnings": []}
    values = {"mass": own["M_struc"][0][0], "volume": own["volume"], "rest": rest, "tensions": [], "pull": None}
    return read, values | {"periods": periods, "periods_infinite": periods}


def statics(hull: Hull) -> dict[str, Any]:
    """Mass, volume, position at rest, natural periods and lines of a hull."""
    import jaxhydro as jh
    from jaxhydro.dynamics.static_forces import line_states
    from jaxhydro.dynamics.statics import linearised

    model = hull.model
    buoyancy = next(load for load in model.loads if isinstance(load, jh.loads.Buoyancy))
    weight = model.environment.density * model.environment.gravity
    rest = jh.equilibrium(model)
    mass, stiffness = (np.asarray(matrix) for matrix in linearised(model, rest))
    lines = line_states(model, rest)
    return {
        "mass": float(model.body.mass),
        "volume": hull.volume or float(buoyancy.upright(weight)["displaced_volume"]),
        "rest": np.asarray(rest).tolist(),
        "periods": natural_periods(mass, stiffness, hull.radiation),
        "periods_infinite": natural_periods(mass, stiffness, None),
        "tensions": [line.tension for line in lines],
        "pull": sum(line.tension * math.sin(line.angle) for line in lines),
        "mass_matrix": mass.tolist(),
        "stiffness": stiffness.tolist(),
    }


def save(results: Mapping[str, Any]) -> None:
    """Write the raw results, in the order of the hulls."""
    RAW.write_text(json.dumps({key: results[key] for key in CASES if key in results}, indent=1) + "\n", encoding="utf-8")


def main(arguments: list[str] | None = None) -> None:
    """Work out the hulls whose sources are there and that have no results yet; write raw results and text."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="copies of public repositories, each under its own name")
    parser.add_argument("--only", nargs="+", metavar="HULL", choices=list(CASES), default=list(CASES), help="these hulls alone")
    parser.add_argument("--statics", action="store_true", help="neither decays nor seas")
    parser.add_argument("--again", action="store_true", help="run hulls that have results, too")
    given = parser.parse_args(arguments)
    if not given.folder.is_dir():
        hint = "Name the folder that holds copies of RAFT, IEA-15-240-RWT, IEA-22-280-RWT and FAST."
        raise SystemExit(str(InputError(str(given.folder), [Problem("", "a folder", "none", hint)])))
    results = json.loads(RAW.read_text("utf-8")) if RAW.exists() else {}
    models: dict[str, Hull] = {}
    for part in ("statics",) if given.statics else ("statics", "motions"):
        for name in given.only:
            if part in results.get(name, {}) and not given.again:
                continue
            case = CASES[name]
            if part == "statics" and (known := stored(case)):
                results[name] = results.get(name, {}) | known[0] | {part: known[1]}
                continue
            if absent := missing(given.folder, case):
                print(f"{name}, {part}: left out, {given.folder / absent} is not there", flush=True)
                continue
            begin = time.monotonic()
            if name not in models:
                models[name] = built(given.folder, case)
                results[name] = results.get(name, {}) | models[name].read
            hull = models[name]
            try:
                results[name][part] = statics(hull) if part == "statics" else motions(hull.model, hull.radiation, case)
            except (EquilibriumError, ValueError) as error:
                print(f"{name}, {part}: {error}", flush=True)
                results[name] |= {"fault": f"{part}: {error}"}
                save(results)
                continue
            results[name].pop("fault", None)
            print(f"{name}, {part}: {time.monotonic() - begin:.0f} s", flush=True)
            save(results)
    save(results)
    TEXT.write_text(text(results), encoding="utf-8")
    print(TEXT)


if __name__ == "__main__":
    main()
