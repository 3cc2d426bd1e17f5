"""Making of the benchmark's campaigns: those of one seed together, each complete or not there."""

import hashlib
import json
import shutil
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.discovery.answer_file import read_json
from benchmarks.discovery.cases import Case, cases
from benchmarks.tank import BATCH, Spec, make_campaigns
from jaxhydro.errors import InputError, Problem
from jaxhydro.input_schema import Schema, validate

TANK_SOURCES = [
    Path(__file__).resolve().parents[1] / name
    for name in ("tank.py", "tank_effects.py", "reference_model.py", "reference_waves.py")
]
INDEX_FILE = "benchmark.json"


class Index(Schema):
    """Content of benchmark.json.

    Attributes:
        tank: Hash of the sources that the campaigns were made with.
        halves: Half (`set`, `report`) by name of the campaign's folder.
    """

    tank: str
    halves: dict[str, str]


def tank_version() -> str:
    """Hash of the tank's sources."""
    return hashlib.sha256(b"".join(path.read_bytes() for path in TANK_SOURCES)).hexdigest()[:12]


def make_in_folders(folders: Mapping[Case, Path], names: Mapping[Case, str]) -> Iterator[dict[Case, dict[str, Any]]]:
    """Make campaigns, a batch of one seed at a time; folders appear when they are complete.

    Args:
        folders: Folders by case.
        names: Names in the manifests by case; campaign-SEED for the others.

    Yields:
        True values by case of a batch.
    """
    for seed in sorted({case.seed for case in folders}):
        of_seed = [case for case in folders if case.seed == seed]
        for batch in (of_seed[start : start + BATCH] for start in range(0, len(of_seed), BATCH)):
            parts = {case: folders[case].with_name(f"{folders[case].name}.part") for case in batch}
            for part in parts.values():
                shutil.rmtree(part, ignore_errors=True)
            specs = [Spec(parts[case], case.effects, case.strength, seed, name=names.get(case, "")) for case in batch]
            truths = dict(zip(batch, make_campaigns(specs), strict=True))
            for case, part in parts.items():
                shutil.rmtree(folders[case], ignore_errors=True)
                part.rename(folders[case])
            yield truths


def make_benchmark(folder: Path, chosen: Sequence[Case]) -> Iterator[int]:
    """Make campaigns without answers; those that are there stay.

    Args:
        folder: The benchmark's folder.
        some: The cases.

    Yields:
        Number of campaigns that are there, after every batch.

    Raises:
        InputError: The folder has campaigns of another version of the tank.
    """
    folder.mkdir(parents=True, exist_ok=True)
    if (folder / INDEX_FILE).exists():
        read_index(folder)
    else:
        write_index(folder)
    folders = {case: folder / case.public_name for case in chosen}
    missing = {case: path for case, path in folders.items() if not path.exists()}
    yield len(folders) - len(missing)
    for _ in make_in_folders(missing, {case: case.public_name for case in missing}):
        write_index(folder)
        yield sum(path.exists() for path in folders.values())


def cases_in(folder: Path) -> list[Case]:
    """Cases whose campaigns are in a folder."""
    return [case for case in cases() if (folder / case.public_name).is_dir()]


def write_index(folder: Path) -> None:
    """Write benchmark.json."""
    halves = dict(sorted((case.public_name, case.half) for case in cases_in(folder)))
    (folder / INDEX_FILE).write_text(json.dumps({"tank": tank_version(), "halves": halves}, indent=1) + "\n")


def read_index(folder: Path) -> Index:
    """Read benchmark.json. Raises InputError where the campaigns are of another version of the tank."""
    path = folder / INDEX_FILE
    index = validate(Index, read_json(path, "the index of a folder that `python -m benchmarks.discovery make` made"), str(path))
    if index.tank != tank_version():
        hint = "Make the campaigns anew in another folder, or use the version that made these."
        raise InputError(str(path), [Problem("tank", f"{tank_version()}, of this version", index.tank, hint)])
    return index


def write_truth(folder: Path, path: Path) -> None:
    """Write what is missing in each campaign of a folder, as JSON apart from the campaigns."""
    truth = {
        case.public_name: {"effects": case.effects, "strength": case.strength, "seed": case.seed, "half": case.half}
        for case in cases_in(folder)
    }
    path.write_text(json.dumps(truth, indent=1) + "\n")
