"""Checkpoint of a diagnosis, written after every round so that a stopped run can resume.

The file is a .npz of arrays and one JSON document. It is data only: a file from someone else may be wrong but cannot run code.
"""

import io
import json
import types
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from enum import Enum
from pathlib import Path
from typing import Any, Union, get_args, get_origin, get_type_hints

import numpy as np

from calibration.campaign.manifest import platform_source
from calibration.discovery.diagnosis import DetectionLimit, Rejected, Score
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.fit_state import FitState, ResidualSummary
from calibration.discovery.search import AcceptedEffect, ListedVariant, Search
from jaxhydro import fingerprint as fingerprints
from jaxhydro.files import staged

CHECKPOINT_FILE = ".diagnosis-under-way"
DOCUMENT_KEY = "about"  # the JSON document in the file; arrays are numbered


@dataclass(frozen=True)
class Checkpoint:
    """State of a search after some rounds.

    Attributes:
        expected: Expected size of residual rows (n,), or None.
        states: Fits after every round.
        accepted: Evidence of accepted effects by name.
        scores: Scores of candidates.
        rejected: Rejected effects by name.
        notes: Notes of the search.
        shortlist: Candidates that later rounds are about.
        limits: Detection limits of candidates by name.
        alone: Residual of a fit to decays alone, or None.
        begun: Parameter coordinates where the search began (p,).
        seconds: Computing time (s).
    """

    expected: np.ndarray | None
    states: tuple[FitState, ...]
    accepted: dict[str, AcceptedEffect]
    scores: tuple[Score, ...]
    rejected: dict[str, Rejected]
    notes: tuple[str, ...]
    shortlist: tuple[ListedVariant, ...]
    limits: dict[str, tuple[DetectionLimit, ...]]
    alone: ResidualSummary | None
    begun: np.ndarray
    seconds: float

    def every_state(self) -> Iterator[FitState]:
        """All fits in the checkpoint."""
        yield from self.states
        for effect in self.accepted.values():
            yield from (effect.before, effect.after)


def save_checkpoint(path: Path, search: Search, states: list[FitState], seconds: float) -> None:
    """Write a checkpoint file atomically.

    Args:
        path: The file.
        search: The search.
        states: Fits after every round.
        seconds: Computing time so far (s).

    Raises:
        InputError: If the file cannot be written.
    """
    reached = Checkpoint(
        search.fits.study.expected,
        tuple(states),
        search.record.accepted,
        tuple(search.record.scores),
        search.record.rejected,
        tuple(search.record.notes),
        tuple(search.record.shortlist),
        search.record.limits,
        search.record.alone,
        np.asarray(search.fits.begun),
        seconds,
    )
    arrays: list[np.ndarray] = []
    about = {
        "fingerprint": fingerprint(search),
        "computed_with": fingerprints.computed_with(),
        "reached": _packed(reached, arrays),
    }
    content = io.BytesIO()
    text = np.frombuffer(json.dumps(about).encode(), np.uint8)
    np.savez(content, allow_pickle=False, **{DOCUMENT_KEY: text}, **{str(i): array for i, array in enumerate(arrays)})
    with staged(path.parent) as temporary:
        (temporary / path.name).write_bytes(content.getvalue())


def load_checkpoint(path: Path, search: Search, tell: Callable[[str], None] = lambda text: None) -> list[FitState]:
    """Restore a search from a checkpoint file of the same diagnosis.

    Args:
        path: The file.
        search: The search; it is set to the state in the checkpoint.
        tell: Called with the reason in words where a checkpoint cannot be used.

    Returns:
        Fits after every round; empty where there is no usable checkpoint.
    """
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as file:
            about = json.loads(file[DOCUMENT_KEY].tobytes())
            if about["fingerprint"] != fingerprint(search):
                tell(f"{path}: {_other(about['computed_with'])}; the diagnosis starts anew")
                return []
            arrays = {name: file[name] for name in file.files if name != DOCUMENT_KEY}
        candidates = {candidate.name: candidate for candidate in search.fits.setup.candidates}
        reached: Checkpoint = _rebuilt(Checkpoint, about["reached"], arrays, candidates)
        _check(reached, search)
    except FileNotFoundError:
        return []
    except Exception as error:  # each way to damage a file has its own
        message = " ".join(str(error).split())[:100]
        tell(
            f"{path}: what an earlier run reached cannot be read ({type(error).__name__}: {message}); the diagnosis starts anew"
        )
        return []
    search.fits.study = replace(search.fits.study, expected=reached.expected)
    search.record.accepted, search.record.scores, search.record.rejected = (
        reached.accepted,
        list(reached.scores),
        reached.rejected,
    )
    search.record.notes, search.record.shortlist = list(reached.notes), list(reached.shortlist)
    search.record.alone, search.record.earlier = reached.alone, reached.seconds
    search.record.limits = reached.limits
    search.fits.anchor(reached.begun)
    return list(reached.states)


def fingerprint(search: Search) -> str:
    """Hash of all inputs of a diagnosis: program, campaign and files, platform, candidates, options."""
    setup, campaign = search.fits.setup, search.fits.campaign
    manifest, folder = campaign.manifest, campaign.folder
    files = [folder / test.file for test in manifest.tests]
    files += [Path(platform_source(manifest, folder)), *map(Path, campaign.platform.files().values())]
    model = (campaign.platform, campaign.model_override, setup.baseline)
    study = (setup.study.names, setup.study.options, setup.motions, setup.candidates)
    return fingerprints.fingerprint(manifest, campaign.records, files, model, study)


def _other(before: Any) -> str:
    """Difference between the checkpoint's program and this one, in words."""
    now = fingerprints.computed_with()
    before = before if isinstance(before, Mapping) else {}
    changed = [name for name, value in now.items() if before.get(name) != value]
    made = [name if name == "source code" else f"{name} ({before.get(name)}, now {now[name]})" for name in changed]
    return f"an earlier run was of other {', '.join(made) or 'inputs'}"


def _check(reached: Checkpoint, search: Search) -> None:
    """Check array sizes against the search; raises ValueError."""
    study = search.fits.study
    rows, series, free = len(study.row_series), len(study.series), len(study.start)
    if not reached.states:
        raise ValueError("no states")
    asked: list[tuple[np.ndarray, tuple[int, ...]]] = [(reached.begun, (free,))]
    asked += [] if reached.expected is None else [(reached.expected, (rows,))]
    for state in reached.every_state():
        linearisation, summary = state.linearisation, state.summary
        if not all(0 <= i < len(study.names) for i in linearisation.active):
            raise ValueError("a direction that there is none of")
        asked += [
            (linearisation.residual, (rows,)),
            (state.residual, (rows,)),
            (linearisation.slopes, (rows, len(linearisation.active))),
        ]
        asked += [(linearisation.point.x, (free,)), (linearisation.point.own, study.own_width.shape)]
        asked += [(linearisation.own, (study.spans[-1].stop if study.spans else 0, study.own_width.shape[1]))]
        asked += [(state.likelihood, (series,)), (summary.likelihood, (series,))]
        asked += [(values, (series, 3)) for values in (summary.squares, summary.parts)]
    for array, shape in asked:
        if array.shape != shape or array.dtype != float:
            raise ValueError(f"an array of {array.dtype} {array.shape}, not of floats {shape}")


def _parts(kind: Any) -> tuple[str, ...] | None:
    """Field names of a dataclass or named tuple; None for other types."""
    if is_dataclass(kind):
        return tuple(field.name for field in fields(kind))
    return getattr(kind, "_fields", None)


def _packed(value: Any, arrays: list[np.ndarray]) -> Any:
    """A value as JSON: arrays by number, candidates by name (a user's own load may not be serialisable)."""
    if isinstance(value, Candidate):
        return value.name
    if isinstance(value, np.ndarray):
        number = next((i for i, array in enumerate(arrays) if array is value), len(arrays))
        if number == len(arrays):
            arrays.append(value)
        return number
    if (names := _parts(type(value))) is not None:
        return {name: _packed(getattr(value, name), arrays) for name in names}
    if isinstance(value, Mapping):
        return {name: _packed(item, arrays) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return [_packed(item, arrays) for item in value]
    return value.item() if isinstance(value, np.generic) else value


def _rebuilt(kind: Any, value: Any, arrays: Mapping[str, np.ndarray], candidates: Mapping[str, Candidate]) -> Any:
    """Inverse of `_packed` for a given type; raises ValueError, KeyError or TypeError on a mismatch."""

    def inner(kind: Any, value: Any) -> Any:
        return _rebuilt(kind, value, arrays, candidates)

    origin, args = get_origin(kind), get_args(kind)
    if origin in (Union, types.UnionType):  # all are a kind or None
        return None if value is None else inner(next(arg for arg in args if arg is not type(None)), value)
    if kind is Candidate:
        return candidates[value]
    if kind is np.ndarray:
        return arrays[str(value)]
    if (names := _parts(kind)) is not None:
        if set(value) != set(names):
            raise ValueError(f"{kind.__name__} of {', '.join(value)}")
        hints = get_type_hints(kind)
        return kind(**{name: inner(hints[name], value[name]) for name in names})
    if isinstance(kind, type) and issubclass(kind, Enum):
        return kind(value)
    if origin is tuple and isinstance(value, list):
        return tuple(inner(args[0], item) for item in value)
    if origin is dict and isinstance(value, dict):
        return {name: inner(args[1], item) for name, item in value.items()}
    if kind is float and type(value) in (int, float):
        return float(value)
    if type(value) is not kind:
        raise ValueError(f"{value!r:.40}, not of {kind}")
    return value
