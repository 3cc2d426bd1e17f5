"""Coefficients that groups share: one parameter in place of two, everywhere; each mistake in one line."""

import copy
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from ruamel.yaml import YAML
from test_loads import BEAM, BODY, COLUMN, HIGH_PASS, KEULEGAN_CARPENTER, LEG, PONTOON, SPRINGS, build, data_of, sample, wrench

import jaxhydro as jh
from calibration import calibrate, load_campaign
from calibration.decay_analysis.model_damping import model_damping
from calibration.discovery.effects.candidates import with_effects
from calibration.discovery.effects.catalogue import catalogue
from calibration.discovery.effects.catalogue_builder import NoticeableScales
from calibration.parameters.space import match_free_labels
from jaxhydro.errors import InputError
from jaxhydro.input_schema import validate
from jaxhydro.loads import WaveExcitation
from jaxhydro.loads.sea_state_law import SeaStateLaw
from jaxhydro.platform.schema import Platform
from jaxhydro.waves.sea_state import SeaState

OWN = {"Ca_t": 0.9, "Ca_z": 0.6, "Cd_t": 1.1, "Cd_z": 2.3}
DIFFERENT = {"Ca_t": 0.9, "Ca_z": 1.2, "Cd_t": 1.1, "Cd_z": 5.0}  # as the leg has them
SHARED = {"Ca_t": "column", "Ca_z": 1.2, "Cd_t": "column", "Cd_z": 5.0}
FLAT = {"Ca_t": 0.4, "Ca_z": 1.7, "Cd_t": 0.8, "Cd_z": 4.0}
MEMBERS = (COLUMN, LEG, PONTOON, BEAM)
SEA = jh.regular_wave(3.0, 9.0, jh.Environment(1025.0, 200.0, 9.81), heading=0.4, phase=0.3)
LABELS = {f"{group}.{name}" for group in ("column", "leg", "pontoon", "beam") for name in OWN}


def platforms(column: dict = {}, **changes: Any) -> tuple[jh.Model, jh.Model]:  # noqa: B006
    """Every coefficient written out, and the leg's and the beam's shared with the column's and the pontoon's."""
    rows = {"column": OWN | column, "pontoon": FLAT}
    twice = rows | {"leg": DIFFERENT | column, "beam": FLAT}
    once = rows | {"leg": SHARED, "beam": dict.fromkeys(FLAT, "pontoon")}
    return tuple(build(*MEMBERS, coefficients=groups, mooring=SPRINGS, **changes) for groups in (twice, once))  # type: ignore[return-value]


def moored(rows: dict) -> dict:
    """Two columns side by side that float in balance."""
    members = ({**COLUMN, "rA": [0, 12, -20], "rB": [0, 12, 15]}, {**LEG, "d": 10.0, "rA": [0, -12, -20], "rB": [0, -12, 15]})
    stiffness = {"C11": 8.5e4, "C22": 8.5e4, "C44": 2e9, "C55": 2e9, "C66": 1e8}
    return data_of(*members) | {
        "rigid_body": {**BODY, "mass": 2 * 1025.0 * np.pi * 25 * 20},
        "coefficients": rows,
        "mooring": {"kind": "stiffness_matrix", "stiffness": stiffness},
    }


def same(first: jh.Model, second: jh.Model, sea: Any = SEA) -> None:
    for position, velocity in zip(*sample(5), strict=True):
        for actual, expected in zip(wrench(second, position, velocity, sea), wrench(first, position, velocity, sea)):
            assert_allclose(actual, expected, rtol=1e-14, atol=1e-14 * float(jnp.abs(expected).max()))


@pytest.mark.slow
@pytest.mark.parametrize("directions", ["body", "earth"])
def test_as_the_same_numbers_twice(directions: str) -> None:
    """The parameter is there once, under the label of the group that has the number; forces and added mass are the same."""
    twice, once = platforms(directions=directions)
    assert set(twice.values) >= LABELS
    shared_labels = {"leg.Ca_t", "leg.Cd_t", *(label for label in LABELS if label.startswith("beam."))}
    assert set(once.values) == set(twice.values) - shared_labels
    same(twice, once)
    changed = {"column.Cd_t": 3.0, "pontoon.Ca_z": 0.3, "leg.Cd_z": 1.0}
    copied = {"leg.Cd_t": 3.0, "beam.Ca_z": 0.3}
    same(twice.with_values(changed | copied), once.with_values(changed))


@pytest.mark.slow
def test_gradients_add() -> None:
    twice, once = platforms()
    (position, *_), (velocity, *_) = sample(6)

    def slopes(model: jh.Model) -> dict[str, jax.Array]:
        def numbers(values: dict[str, jax.Array]) -> jax.Array:
            return jnp.concatenate([x.ravel() for x in wrench(model.with_values(values), position, velocity, SEA)])

        return jax.jit(jax.jacfwd(numbers))(model.values)

    apart, together = slopes(twice), slopes(once)
    for owner, sharer, names in (("column", "leg", ("Ca_t", "Cd_t")), ("pontoon", "beam", OWN)):
        for name in names:
            expected = apart[f"{owner}.{name}"] + apart[f"{sharer}.{name}"]
            assert float(jnp.abs(apart[f"{sharer}.{name}"]).max()) > 0
            assert_allclose(together[f"{owner}.{name}"], expected, rtol=1e-12, atol=1e-12 * float(jnp.abs(expected).max()))


@pytest.mark.slow
@pytest.mark.parametrize(
    "law",
    [HIGH_PASS, KEULEGAN_CARPENTER, {"law": "constant"}],
    ids=lambda law: law["law"],
)
def test_a_law_of_drag_goes_with_its_coefficient(law: dict) -> None:
    """Memories included: a decay is the same."""
    models = [
        jh.build(Platform.model_validate(moored({"column": OWN | {"drag_t": law}, "leg": leg})))
        for leg in (DIFFERENT | {"drag_t": law}, SHARED)
    ]
    assert not any(label.startswith("leg.drag_") for label in models[1].values)
    times = np.arange(0.0, 40.0, 1.0)
    motions = [jh.free_decay(model, {"surge": 8.0, "pitch": 0.05}, times, step=0.5).position for model in models]
    assert_allclose(*motions, rtol=0, atol=1e-11)


def test_the_end_of_a_column_with_the_suction_side_of_another() -> None:
    side = {"law": "suction_side", "suction": 0.6}
    twice = build(COLUMN, LEG, coefficients={"column": OWN | {"drag_z": side}, "leg": OWN | {"drag_z": side}})
    once = build(COLUMN, LEG, coefficients={"column": OWN | {"drag_z": side}, "leg": dict.fromkeys(OWN, "column")})
    assert "column.drag_suction_z" in once.values and "leg.drag_suction_z" not in once.values
    same(twice, once)


def test_laws_over_the_sea_state() -> None:
    """An exponent of the shared coefficient is of all who share it, and one of another's label is told."""
    reference = {"significant_height": 4.0, "peak_period": 10.0}
    power = {"significant_height": -0.5}
    laws = {"reference": reference, "exponents": {"column.Cd_t": power}}
    twice_stated = laws | {"exponents": {"column.Cd_t": power, "leg.Cd_t": power}}
    twice, once = (
        build(COLUMN, LEG, coefficients={"column": OWN, "leg": leg}, sea_state_laws=law)
        for leg, law in ((DIFFERENT, twice_stated), (SHARED, laws))
    )
    assert "column.Cd_t.Hs_exponent" in once.values and "leg.Cd_t.Hs_exponent" not in once.values
    same(twice.in_sea(SeaState(8.0, 10.0)), once.in_sea(SeaState(8.0, 10.0)))
    with pytest.raises(InputError, match=r"leg\.Cd_t.*It is shared: column\.Cd_t\."):
        build(COLUMN, LEG, coefficients={"column": OWN, "leg": SHARED}, sea_state_laws=twice_stated)


def test_an_exponent_of_what_columns_and_pontoons_share() -> None:
    """Cd_z of a group with both is the coefficient of strips and of ends: its exponent counts in both."""
    laws = {"reference": {"significant_height": 4.0, "peak_period": 10.0}, "exponents": {"pontoon.Cd_z": {"peak_period": 1.0}}}
    rows = {"column": OWN | {"Cd_z": "pontoon"}, "pontoon": FLAT}
    model = build(COLUMN, PONTOON, coefficients=rows, sea_state_laws=laws)
    assert sum(isinstance(load, SeaStateLaw) for load in model.loads) == 1
    plain = build(COLUMN, PONTOON, coefficients=rows)
    same(plain.with_values({"pontoon.Cd_z": 2 * FLAT["Cd_z"]}), model.in_sea(SeaState(4.0, 20.0)))


EFFECTS = {
    "amplitude_dependent_drag": (["column", "leg", "pontoon", "beam"], ["column", "leg", "pontoon"], "exponent"),
    "wave_excitation": (["column", "leg", "pontoon", "beam"], ["column", "pontoon"], "Cp_t"),
}


@pytest.mark.parametrize("effect", EFFECTS)
def test_effects_of_a_diagnosis_go_with_their_coefficients(effect: str) -> None:
    """Other drag with speed, other pressure of waves. Groups share what goes with a coefficient that they share."""
    apart, together, name = EFFECTS[effect]
    twice, once = platforms()
    factor = {"column": 0.7, "leg": 0.7, "pontoon": 1.3, "beam": 1.3}
    if effect == "amplitude_dependent_drag":
        factor = {group: value - 1 for group, value in factor.items()}
    models = []
    for model, groups in ((twice, apart), (once, together)):
        values = {f"{effect}.{group}.{name}": factor[group] for group in groups}
        models.append(with_effects(model, values).with_values(values))
    same(*models)


def test_the_catalogue_asks_for_what_is_there() -> None:
    """Pressure of waves by every Ca of the model: none of a coefficient that is another's."""
    _, once = platforms()
    scales = {dof: NoticeableScales(1.0, 0.5, 1e5, 1e7) for dof in ("surge", "heave", "pitch")}
    candidate = next(entry for entry in catalogue(once, scales, True, 1.0)[0] if entry.effect == "wave_excitation")
    pressed = {label.removeprefix("wave_excitation.") for label in candidate.labels}
    assert pressed == {"column.Cp_t", "column.Cp_z", "leg.Cp_z", "pontoon.Cp_t", "pontoon.Cp_z"}
    assert isinstance(with_effects(once, candidate.labels).loads[-1], WaveExcitation)


@pytest.mark.slow
def test_damping_of_the_members() -> None:
    """Per coefficient, a shared one's is the sum."""
    twice, once = (model_damping(model, "surge", jnp.zeros(6)).per_coefficient for model in platforms())
    assert once["column.Cd_t"] == pytest.approx(twice["column.Cd_t"] + twice["leg.Cd_t"], rel=1e-12)
    assert "leg.Cd_t" not in once


def test_what_it_means_names_all_groups() -> None:
    _, model = platforms(column={"drag_t": HIGH_PASS})
    assert model.about("column.Cd_t").meaning.endswith("shared by leg")
    assert model.about("column.drag_cutoff_t").meaning.endswith("shared by leg")
    assert "shared" not in model.about("column.Cd_z").meaning and "shared" not in model.about("leg.Cd_z").meaning


def test_a_group_without_members_may_hold_what_others_share() -> None:
    transverse = {"Ca_t": 0.9, "Cd_t": 1.1}
    axial = {"Ca_z": 0.6, "Cd_z": 2.3}
    rows = {
        "all": transverse,
        "column": axial | dict.fromkeys(transverse, "all"),
        "leg": axial | dict.fromkeys(transverse, "all"),
    }
    model = build(COLUMN, LEG, coefficients=rows)
    assert {label for label in model.values if label.endswith("_t")} == {"all.Ca_t", "all.Cd_t"}
    same(build(COLUMN, LEG, coefficients={"column": OWN, "leg": OWN}), model)


# --- a campaign

TRUE = {"column.Ca_t": 1.3, "column.Cd_t": 2.0}


@pytest.mark.slow
def test_a_calibration_frees_the_shared_one(tmp_path: Path) -> None:
    """Two decays made with other values: the shared coefficients are found back, each a parameter of the fit once."""
    document = moored({"column": OWN, "leg": SHARED})
    model = jh.build(Platform.model_validate(document)).with_values(TRUE)
    times = np.arange(0.0, 200.0, 1.0)
    tests = []
    for name, offset in (("large", 14.0), ("small", 5.0)):
        motion = jh.free_decay(model, {"surge": offset}, times, step=0.25)
        np.savetxt(
            tmp_path / f"{name}.csv",
            np.stack([times, motion["surge"]], -1),
            fmt="%.9g",
            delimiter=",",
            header="t,surge",
            comments="",
        )
        tests.append({"id": name, "kind": "decay", "degree_of_freedom": "surge", "file": f"{name}.csv"})
    manifest = {
        "name": "two columns",
        "platform": "platform.yaml",
        "channels": {"time": {"column": "t", "unit": "s"}, "surge": {"column": "surge", "unit": "m"}},
        "tests": tests,
        "calibrate": {"free": ["*.C?_t"]},
    }
    for name, data in (("platform", document), ("campaign", manifest)):
        with (tmp_path / f"{name}.yaml").open("w") as file:
            YAML().dump(data, file)
    campaign = load_campaign(tmp_path)
    result = calibrate(campaign)
    assert set(result.parameters) == set(TRUE)
    for label, value in TRUE.items():
        assert result.parameters[label].value == pytest.approx(value, rel=2e-3)
    assert float(result.model.values["column.Cd_t"]) == result.parameters["column.Cd_t"].value


def test_free_asked_for_by_another_label_is_told() -> None:
    """As are bounds and priors of it."""
    _, model = platforms()
    for key in ("free", "fixed"):
        with pytest.raises(InputError, match=rf"calibrate\.{key}: .*found leg\.Cd_t\. It is shared: column\.Cd_t\."):
            match_free_labels(model, ["surge"], **{key: ["leg.Cd_t"]})


# --- mistakes


def broken(**groups: Any) -> list[str]:
    data = data_of(COLUMN, LEG, PONTOON)
    data["coefficients"] = copy.deepcopy({"column": OWN, "leg": SHARED, "pontoon": FLAT} | groups)
    with pytest.raises(InputError) as caught:
        validate(Platform, data, "platform.yaml")
    return [str(problem) for problem in caught.value.problems]


BROKEN = [
    (
        {"leg": SHARED | {"Ca_t": "colum"}},
        "coefficients.leg.Ca_t: expected a number >= 0, or a group with a number for Ca_t (column, pontoon), found 'colum'. "
        "Did you mean 'column'?",
    ),
    ({"leg": SHARED | {"Ca_t": "0.9"}}, "found '0.9'. Write the number without quotes"),
    ({"leg": SHARED | {"Ca_t": ""}}, "coefficients.leg.Ca_t: expected text that is not empty"),
    ({"leg": SHARED | {"Ca_t": -1.0}}, "coefficients.leg.Ca_t: expected a number >= 0, found -1.0"),
    ({"leg": SHARED | {"Ca_t": ["column"]}}, "coefficients.leg.Ca_t: expected a number >= 0"),
    ({"leg": SHARED | {"Ca_t": "leg"}}, "found 'leg'. leg -> leg: none of them has a number."),
    ({"column": OWN | {"Ca_t": "leg"}}, "found 'leg'. column -> leg -> column: none of them has a number."),
    (
        {"pontoon": FLAT | {"Ca_t": "leg"}},
        "coefficients.pontoon.Ca_t: expected a number >= 0, or a group with a number for "
        "Ca_t (column), found 'leg'. leg shares it itself. Name column here.",
    ),
    (
        {"column": {"Cd_t": 1.1}},
        "coefficients.leg.Ca_t: expected a number >= 0, or a group with a number for Ca_t (pontoon), "
        "found 'column', which has no Ca_t",
    ),
    (
        {"leg": SHARED | {"drag_t": HIGH_PASS}},
        "coefficients.leg.drag_t: expected no law beside a shared Cd_t, found one. The law of column.Cd_t goes with it.",
    ),
    ({"leg": SHARED | {"drag_t": {"law": "constant"}}}, "coefficients.leg.drag_t: expected no law beside a shared Cd_t"),
    (
        {"leg": SHARED | {"Ca_t": "all"}, "all": {"Ca_t": 1.0, "Ca_z": 2.0}},
        "coefficients.all.Ca_z: expected a coefficient that "
        "another group shares, found one that nothing uses, as no member is of the group all",
    ),
    (
        {"leg": SHARED | {"Cd_t": "all"}, "all": {"Cd_t": 1.0, "drag_z": HIGH_PASS}},
        "coefficients.all.drag_z: expected a law of a coefficient that another group shares",
    ),
    ({"al": {"Ca_t": 1.0}}, "coefficients.al: expected a group that members belong to"),
]


@pytest.mark.parametrize(("groups", "words"), BROKEN, ids=range(len(BROKEN)))
def test_one_mistake_is_one_line(groups: dict, words: str) -> None:
    (message,) = broken(**groups)
    assert words in message


def test_longer_chains_and_circles() -> None:
    """Each chain is told where it begins, a circle once."""
    chain = broken(column=OWN, leg=OWN | {"Ca_t": "pontoon"}, pontoon=FLAT | {"Ca_t": "all"}, all={"Ca_t": "column"})
    assert len(chain) == 2 and all("Name column here." in message for message in chain)
    circle = broken(column=OWN | {"Ca_t": "leg"}, leg=OWN | {"Ca_t": "pontoon"}, pontoon=FLAT | {"Ca_t": "column"})
    assert len(circle) == 1 and "column -> leg -> pontoon -> column" in circle[0]
    into = broken(column=OWN | {"Ca_t": "leg"}, leg=OWN | {"Ca_t": "column"}, pontoon=FLAT | {"Ca_t": "leg"})
    assert len(into) == 2 and "pontoon" in into[1]


def test_a_label_of_what_is_shared_is_pointed_to_its_owner() -> None:
    """As is no other unknown label."""
    model = build(COLUMN, LEG, coefficients={"column": OWN, "leg": SHARED})
    with pytest.raises(KeyError, match=r"no parameter 'leg\.Cd_t'.*It is shared: column\.Cd_t\."):
        model.with_values({"leg.Cd_t": 1.0})
    with pytest.raises(KeyError) as error:
        model.about("leg.Cd_q")
    assert "shared" not in str(error.value)
