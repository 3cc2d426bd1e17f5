"""What a diagnosis keeps on disk: plain data that does nothing, of the same inputs and program alone, as good as one run."""

import dataclasses
import json
import math
import os
import pickle
import warnings
import zipfile
from types import SimpleNamespace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from test_discovery import campaign_of

from calibration.campaign.load_campaign import load_campaign
from calibration.discovery import checkpoint
from calibration.discovery.acceptance import Verdict
from calibration.discovery.checkpoint import load_checkpoint, save_checkpoint
from calibration.discovery.diagnose import diagnose
from calibration.discovery.diagnosis import Rejected, Score
from calibration.discovery.effects.candidates import Candidate
from calibration.discovery.fit_state import FitState, ResidualSummary
from calibration.discovery.linearisations import Linearisation, Point
from calibration.discovery.refusal import ComparedData, Refusal, RefusalKind
from calibration.discovery.search import AcceptedEffect, ListedVariant, Search
from calibration.discovery.study_set_up import set_up_study
from calibration.residuals.wave_options import Options
from calibration.results.write_diagnosis import write_diagnosis
from jaxhydro import fingerprint as fingerprints
from jaxhydro.errors import CheckpointWarning
from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.parameters import parameter


class Killed(Exception):
    """In place of a process that is killed."""


def fresh(campaign):
    return Search.of(campaign, set_up_study(campaign, Options()), lambda *_: None)


def state_of(search, chosen, seed):
    """A state of random numbers where a fit's would be."""
    study, random = search.fits.study, np.random.default_rng(seed)
    rows, series, active = len(study.row_series), len(study.series), search.fits.active(chosen)
    point = Point(random.normal(size=len(study.start)), random.normal(size=study.own_width.shape))
    own = random.normal(size=(study.spans[-1].stop, study.own_width.shape[1]))
    linearisation = Linearisation(point, tuple(active), random.normal(size=rows), random.normal(size=(rows, len(active))), own)
    summary = ResidualSummary(*random.normal(size=(2, series, 3)), random.normal(size=series))
    residual, likelihood = random.normal(size=rows), random.normal(size=series)
    return FitState(chosen, linearisation, residual, bool(seed % 2), 7 + seed, likelihood, summary)


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """A campaign, a search of it that found one effect and refused another, and the file that has what was reached."""
    folder = tmp_path_factory.mktemp("campaign")
    campaign = campaign_of(folder, lambda x, v: -500.0 * x**3)
    search = fresh(campaign)
    first, second = search.fits.setup.candidates[:2]
    state, before = state_of(search, (first,), 1), state_of(search, (), 2)
    search.fits.anchor(state.linearisation.point.x)
    verdict = Verdict(31.0, 0.4, True, 12.5, math.inf, 1.5, None)
    refused = Refusal(RefusalKind.HELD_OUT_ERROR, (-0.02,), compared=ComparedData.HELD_OUT)
    search.record.accepted = {
        first.name: AcceptedEffect(50.5, before, state, verdict, (second.name,), math.nan, np.arange(2.0))
    }
    search.record.scores = [Score(1, first.effect, first.dof, 50.5, 1, 12.0, 49.0, 0.4, verdict)]
    search.record.rejected = {second.name: Rejected(second.effect, second.dof, refused, None)}
    search.record.shortlist = [ListedVariant(first.name, {label: 0.1 for label in first.amplitudes})]
    search.record.notes = ["a note"]
    save_checkpoint(folder / "kept", search, [state], 12.0)
    return SimpleNamespace(folder=folder, campaign=campaign, search=search, state=state, path=folder / "kept")


def reasons(path, campaign):
    """States that are gone on from, and what is told."""
    messages = []
    return load_checkpoint(path, fresh(campaign), messages.append), messages


def same(first, second):
    """Whether two values of plain data are the same to the last bit."""
    if dataclasses.is_dataclass(first):
        names = [field.name for field in dataclasses.fields(first)]
        return type(first) is type(second) and all(same(getattr(first, name), getattr(second, name)) for name in names)
    if isinstance(first, np.ndarray):
        return first.dtype == second.dtype and first.shape == second.shape and first.tobytes() == second.tobytes()
    if isinstance(first, dict):
        return first.keys() == second.keys() and all(same(first[name], second[name]) for name in first)
    if isinstance(first, tuple):
        return type(first) is type(second) and len(first) == len(second) and all(map(same, first, second))
    return type(first) is type(second) and (first == second or (first != first and second != second))


def plain(value):
    """A value with candidates by their names: those of another search are other objects."""
    if isinstance(value, Candidate):
        return value.name
    if dataclasses.is_dataclass(value):
        return {field.name: plain(getattr(value, field.name)) for field in dataclasses.fields(value)}
    if isinstance(value, dict):
        return {name: plain(item) for name, item in value.items()}
    return tuple(map(plain, value)) if isinstance(value, tuple | list) else value


def test_what_was_reached_is_read_back_to_the_last_bit(written):
    fresh_search, messages = fresh(written.campaign), []
    (state,) = load_checkpoint(written.path, fresh_search, messages.append)
    assert not messages and same(plain(state), plain(written.state))
    assert fresh_search.record.earlier == 12.0 and same(fresh_search.fits.begun, written.search.fits.begun)
    for name in ("accepted", "scores", "rejected", "notes", "shortlist"):
        assert same(plain(getattr(fresh_search.record, name)), plain(getattr(written.search.record, name))), name


def test_nothing_is_told_where_nothing_was_kept(written, tmp_path):
    assert reasons(tmp_path / "none", written.campaign) == ([], [])


class Malicious:
    """A pickle of it makes a file wherever it is read."""

    def __init__(self, victim):
        self.victim = victim

    def __reduce__(self):
        return os.mkdir, (str(self.victim),)


def pickled(path, victim):
    path.write_bytes(pickle.dumps(Malicious(victim)))


def pickled_array(path, victim):
    with path.open("wb") as file:
        np.save(file, np.array([Malicious(victim)], dtype=object), allow_pickle=True)


def pickled_about(path, victim):
    with path.open("wb") as file:
        np.savez(file, allow_pickle=True, about=np.array([Malicious(victim)], dtype=object))


def pickled_inside(path, victim):
    """Everything as it should be, but for one array."""
    with np.load(path, allow_pickle=False) as stored:
        arrays = {name: stored[name] for name in stored.files}
    with path.open("wb") as file:
        np.savez(file, allow_pickle=True, **arrays | {"0": np.array([Malicious(victim)], dtype=object)})


@pytest.mark.parametrize("attack", [pickled, pickled_array, pickled_about, pickled_inside])
def test_a_folder_from_somebody_else_executes_nothing(written, tmp_path, attack):
    path, victim = tmp_path / "kept", tmp_path / "victim"
    path.write_bytes(written.path.read_bytes())
    attack(path, victim)
    states, messages = reasons(path, written.campaign)
    assert not victim.exists() and states == []
    assert len(messages) == 1 and "cannot be read" in messages[0] and "\n" not in messages[0]


def changed(path, **how):
    """The file with something else in its document or its arrays."""
    with np.load(path, allow_pickle=False) as stored:
        arrays = {name: stored[name] for name in stored.files}
    about = json.loads(arrays.pop("about").tobytes())
    about["reached"] |= how.pop("reached", {})
    about |= how.pop("about", {})
    arrays |= how.pop("arrays", {})
    for name in how.pop("without", ()):
        del arrays[name]
    with path.open("wb") as file:
        np.savez(file, about=np.frombuffer(json.dumps(about).encode(), np.uint8), **arrays)


DAMAGE = {
    "cut off": lambda path: path.write_bytes(path.read_bytes()[:1000]),
    "nothing": lambda path: path.write_bytes(b""),
    "text": lambda path: path.write_text("not this"),
    "a byte": lambda path: path.write_bytes(
        (original := path.read_bytes())[:2000] + bytes([original[2000] ^ 1]) + original[2001:]
    ),
    "another zip": lambda path: zipfile.ZipFile(path, "w").writestr("a", "b"),
    "no document": lambda path: np.savez(path.open("wb"), a=np.zeros(3)),
    "an array less": lambda path: changed(path, without=["0"]),
    "another shape": lambda path: changed(path, arrays={"0": np.zeros(1)}),
    "another type": lambda path: changed(path, arrays={"0": np.zeros(3, int)}),
    "a word for a number": lambda path: changed(path, reached={"seconds": "long"}),
    "a key more": lambda path: changed(path, reached={"order": "third"}),
    "a key less": lambda path: changed(path, about={"reached": {}}),
    "no states": lambda path: changed(path, reached={"states": []}),
    "a list for a document": lambda path: changed(path, about={"reached": []}),
}


@pytest.mark.parametrize("how", DAMAGE)
def test_a_damaged_file_is_left_alone(written, tmp_path, how):
    path = tmp_path / "kept"
    path.write_bytes(written.path.read_bytes())
    DAMAGE[how](path)
    states, messages = reasons(path, written.campaign)
    assert states == [] and len(messages) == 1 and "cannot be read" in messages[0] and "starts anew" in messages[0]


def test_an_effect_that_there_is_none_of_is_left_alone(written, tmp_path):
    path = tmp_path / "kept"
    path.write_bytes(written.path.read_bytes())
    with np.load(path, allow_pickle=False) as stored:
        (state,) = json.loads(stored["about"].tobytes())["reached"]["states"]
    changed(path, reached={"states": [state | {"chosen": ["nothing (surge)"]}]})
    assert reasons(path, written.campaign)[0] == []


def test_another_program_starts_anew(written, monkeypatch):
    """Any source file of either package, any version, Python, and the precision."""
    monkeypatch.setattr(fingerprints, "sources", lambda: "of a load that was changed")
    states, messages = reasons(written.path, written.campaign)
    assert states == [] and "an earlier run was of other source code; the diagnosis starts anew" in messages[0]


@pytest.mark.parametrize("name", ["jax", "numpy", "scipy", "optimistix", "diffrax", "equinox"])
def test_another_version_starts_anew(written, monkeypatch, name):
    version_of = fingerprints.version
    monkeypatch.setattr(fingerprints, "version", lambda package: "99.0" if package == name else version_of(package))
    states, messages = reasons(written.path, written.campaign)
    assert states == [] and f"of other {name} ({version_of(name)}, now 99.0)" in messages[0]


def copied(written, tmp_path, name="", change=lambda text: text):
    for file in ("campaign.yaml", "platform.yaml", *(f"roll-{i}.csv" for i in range(3))):
        text = (written.folder / file).read_text()
        (tmp_path / file).write_text(change(text) if file == name else text)
    return load_campaign(tmp_path)


CHANGES = {
    "nothing": ("", lambda text: text),
    "a sample": ("roll-2.csv", lambda text: text.replace("\n", "\n", 1)[:-9] + "0.000001\n"),
    "an inertia": ("platform.yaml", lambda text: text.replace("115.7", "115.8")),
    "what is not free": ("platform.yaml", lambda text: text.replace("994.0", "994.5")),
    "noise": ("campaign.yaml", lambda text: text.replace("0.0002", "0.0003")),
    "a use": ("campaign.yaml", lambda text: text.replace("holdout", "fit")),
}


@pytest.mark.parametrize("how", CHANGES)
def test_other_inputs_start_anew(written, tmp_path, how):
    """The same files in another place go on."""
    campaign = copied(written, tmp_path, *CHANGES[how])
    states, messages = reasons(written.path, campaign)
    assert (
        (len(states) == 1, messages) == (True, []) if how == "nothing" else (states == [] and "of other inputs" in messages[0])
    )


def test_other_options_and_another_model_start_anew(written):
    """A model of one's own, too: its numbers are not in any file."""
    search = Search.of(written.campaign, set_up_study(written.campaign, Options(stretching="none")), lambda *_: None)
    assert load_checkpoint(written.path, search) == []
    model = written.campaign.model
    for label in ("linear_damping.B44", "hydrostatics.C44"):
        if label in model.values:
            own = written.campaign.with_model(model.with_values({label: 1.01 * model.values[label]}))
            assert load_checkpoint(written.path, fresh(own)) == []


class Sine(AbstractLoad):
    """A torque of one's own."""

    strength: jax.Array = parameter("N m", "strength of a torque that repeats")
    steepness: float = 10.0

    def act(self, now, memory):
        torque = -self.strength * jnp.sin(self.steepness * now.position[3])
        return Action(force=jnp.zeros(6).at[3].set(torque))


def test_the_fingerprint_knows_loads_of_ones_own(tmp_path, monkeypatch):
    """Their numbers and fields, and their source: it is in none of the packages."""
    sine = Sine(0.0)
    reference = fingerprints.fingerprint(sine)
    assert fingerprints.fingerprint(Sine(0.0)) == reference
    assert fingerprints.fingerprint(Sine(1.0)) != reference
    assert fingerprints.fingerprint(Sine(0.0, 11.0)) != reference
    monkeypatch.syspath_prepend(tmp_path)
    text = "import equinox as eqx\nclass Own(eqx.Module):\n    def force(self, x):\n        return 2 * x\n"
    prints = []
    for number, source in enumerate((text, text.replace("2 * x", "3 * x"), text)):
        (tmp_path / f"own_load_{number}.py").write_text(source)
        module = __import__(f"own_load_{number}")
        prints.append(_of(module.Own(), tmp_path))
    assert prints[0] != prints[1] and prints[0] == prints[2]


def _of(value, folder):
    """Content of the files that its classes are written in."""
    own = {}
    list(fingerprints._content(value, own, ()))
    assert all(str(folder) in file for file in own) and len(own) == 1
    return [open(file).read() for file in own]


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (1, 1.0),
        (1, True),
        ("1", 1),
        (None, "None"),
        ([1, [2]], [[1], 2]),
        ({"a": 1}, {"a": 2}),
        ({"a": 1}, {"b": 1}),
        (np.zeros(3), np.zeros((3, 1))),
        (np.zeros(3), np.zeros(3, np.float32)),
        (0.0, -0.0),
        (("ab", "c"), ("a", "bc")),
        (lambda x: 2 * x, lambda x: 3 * x),
        (np.nan, 0.0),
        ([], ()),
        (jnp.zeros(2), jnp.ones(2)),
    ],
)
def test_what_differs_has_another_fingerprint(first, second):
    assert fingerprints.fingerprint(first) != fingerprints.fingerprint(second)
    assert fingerprints.fingerprint(first) == fingerprints.fingerprint(first)


def test_the_fingerprint_is_of_files_not_of_where_they_are(tmp_path):
    for name, text in (("a", "1"), ("b", "1"), ("c", "2")):
        (tmp_path / name).write_text(text)
    first, same, different, none = (fingerprints.fingerprint(tmp_path / name) for name in "abcd")
    assert first == same and len({first, different, none}) == 3


def test_sources_are_all_files_of_both_packages(tmp_path, monkeypatch):
    """A load's, too, not only the diagnosis's."""
    for package in ("jaxhydro/loads", "calibration/fitting"):
        (tmp_path / package).mkdir(parents=True)
    (tmp_path / "jaxhydro/loads/drag.py").write_text("1")
    (tmp_path / "calibration/fitting/decay_fit.py").write_text("1")

    def spec(name):
        return SimpleNamespace(submodule_search_locations=[str(tmp_path / name)])

    monkeypatch.setattr(fingerprints, "find_spec", spec)
    seen = {fingerprints.sources.__wrapped__()}
    for name in ("jaxhydro/loads/drag.py", "calibration/fitting/decay_fit.py"):
        (tmp_path / name).write_text("2")
        seen.add(fingerprints.sources.__wrapped__())
    (tmp_path / "calibration/another.py").write_text("")
    assert len(seen | {fingerprints.sources.__wrapped__()}) == 4


def told_in(campaign, path, stop_at="", **how):
    """A diagnosis, the stages that it went through, and what it warned of; killed at a stage."""
    seen = []

    def progress(now):
        seen.append(now.stage)
        if stop_at and now.stage.startswith(stop_at):
            raise Killed

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            diagnosis = diagnose(campaign.model, campaign, progress=progress, checkpoint=path, **how)
        except Killed:
            diagnosis = None
    return diagnosis, seen, [str(warning.message) for warning in caught if issubclass(warning.category, CheckpointWarning)]


@pytest.mark.slow
def test_a_diagnosis_that_was_killed_ends_as_one_run_does(tmp_path):
    """All files that it writes are the same, the time that it took aside."""
    campaign = campaign_of(tmp_path, lambda x, v: -500.0 * x**3)
    whole, _, messages = told_in(campaign, None)
    path = tmp_path / "kept"
    assert not messages and told_in(campaign, path, "round 2")[0] is None
    resumed, seen, messages = told_in(campaign, path)
    assert not messages and not any(stage.startswith(("fitting the baseline", "round 1")) for stage in seen)
    written = []
    for name, diagnosis in (("whole", whole), ("resumed", resumed)):
        write_diagnosis(dataclasses.replace(diagnosis, seconds=0.0), tmp_path / name, figures=False)
        written.append({path.name: path.read_bytes() for path in sorted((tmp_path / name).iterdir())})
    assert written[0].keys() == written[1].keys()
    for name in written[0]:
        if name.endswith((".json", ".csv", ".yaml")):
            assert written[0][name] == written[1][name], name


@pytest.mark.slow
def test_a_diagnosis_says_in_one_line_that_it_starts_anew(tmp_path, monkeypatch):
    campaign, path = campaign_of(tmp_path, lambda x, v: 0.0), tmp_path / "kept"
    assert told_in(campaign, path, "round 1")[0] is None and path.exists()
    monkeypatch.setattr(fingerprints, "sources", lambda: "of a load that was changed")
    _, seen, messages = told_in(campaign, path, "round 1")
    assert any(stage.startswith("fitting the baseline") for stage in seen)
    assert len(messages) == 1 and "other source code; the diagnosis starts anew" in messages[0] and "\n" not in messages[0]
    assert told_in(campaign, path, "round 1")[2] == []  # which was kept anew


WORDS = (
    "import pickle",
    "from pickle",
    "cloudpickle",
    "joblib",
    "shelve",
    "marshal",
    "dill",
    "read_pickle",
    "allow_pickle=True",
)


def test_the_packages_read_and_write_no_pickles():
    """Neither in their own words nor by NumPy's: `allow_pickle` is False wherever it is."""
    for package in ("jaxhydro", "calibration"):
        root = checkpoint.Path(__import__(package).__file__).parent
        for file in root.rglob("*.py"):
            text = file.read_text(encoding="utf-8")
            for word in WORDS:
                assert word not in text, f"{file}: {word}"
            for line in text.splitlines():
                assert "np.load(" not in line or "allow_pickle=False" in line, f"{file}: {line}"
