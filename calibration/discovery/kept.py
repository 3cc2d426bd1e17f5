"""What a diagnosis has reached, kept on disk from round to round, so that one that was killed goes on."""

import hashlib
import pickle
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from calibration.discovery.judgement import State
from jaxhydro.files import staged

if TYPE_CHECKING:
    from calibration.discovery.search import Search

FILE = ".diagnosis-under-way"


def keep(path: Path, search: "Search", states: list[State], seconds: float) -> None:
    """Write what was reached, and what it took (s), whole or not at all. Raises InputError where it cannot be written."""
    content = {
        "of": fingerprint(search),
        "order": search.order,
        "declared_in_second_order": None if (second := search.declared_in_second_order) is None else named(second),
        "expected": search.study.expected,
        "states": [named(state) for state in states],
        "found": {
            name: one._replace(before=named(one.before), after=named(one.after)) for name, one in search.found.items()
        },
        "scores": search.scores,
        "rejected": search.rejected,
        "notes": search.notes,
        "alone": search.alone,
        "begun": search.begun,
        "seconds": seconds,
    }  # fmt: skip
    with staged(path.parent) as temporary:
        (temporary / path.name).write_bytes(pickle.dumps(content))


def resumed(path: Path, search: "Search") -> list[State]:
    """The states that an earlier run of the same diagnosis reached, the search as it was then; none where there was none."""
    try:
        content: dict[str, Any] = pickle.loads(path.read_bytes())
    except (OSError, pickle.UnpicklingError, AttributeError, EOFError, ImportError, TypeError, ValueError):
        return []
    if not isinstance(content, dict) or content.get("of") != fingerprint(search):
        return []
    if content["order"] not in ("second", *search.study.other_seas):
        return []
    by_name = {one.name: one for one in search.posed.candidates}

    def whole(state: State) -> State:
        return replace(state, chosen=tuple(by_name[str(name)] for name in state.chosen))

    search.study = replace(search.study, expected=content["expected"])
    search.take_seas(content["order"])
    if (second := content["declared_in_second_order"]) is not None:
        search.declared_in_second_order = whole(second)
    found = {name: one._replace(before=whole(one.before), after=whole(one.after)) for name, one in content["found"].items()}
    search.found, search.scores, search.rejected = found, content["scores"], content["rejected"]
    search.notes, search.alone, search.earlier = content["notes"], content["alone"], content["seconds"]
    search.anchor(content["begun"])
    return [whole(state) for state in content["states"]]


def named(state: State) -> State:
    """A state with its effects' names in their place: a load of one's own may not be written."""
    return replace(state, chosen=tuple(one.name for one in state.chosen))  # type: ignore[misc]


def fingerprint(search: "Search") -> str:
    """Of all that a diagnosis depends on: records, platform, candidates, and this program's version and sources."""
    study, campaign = search.posed.study, search.campaign
    digest = hashlib.sha256()
    for text in (version("jaxhydro"), repr(campaign.manifest), repr(campaign.platform), repr(campaign.own), repr(study.names)):
        digest.update(text.encode())
    for source in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(source.read_bytes())
    arrays = [study.directions, study.floor, study.dof, np.asarray(study.space.start)]
    arrays += [] if study.decays is None else [np.asarray(study.decays.data.measured)]
    for sea in study.seas:
        some = np.asarray(sea.sea.series[:: max(1, len(sea.sea.series) // 50)])
        arrays += [np.asarray(sea.measured), np.round(some / np.abs(some).max(), 6)]  # other cores round otherwise
    for one in arrays:
        digest.update(np.ascontiguousarray(one).tobytes())
    return digest.hexdigest()
