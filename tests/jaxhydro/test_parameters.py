"""Parameters as fields: labels, meanings and changed values, of numbers, mappings and effects within effects."""

import equinox as eqx
import jax
import jax.numpy as jnp
import pytest

import jaxhydro as jh
from jaxhydro.choices import UnknownName
from jaxhydro.loads import Umbilical
from jaxhydro.parameters import AbstractEffect, Parameter, parameter, parameters
from jaxhydro.sensors import SensorLag
from jaxhydro.water import Current

FAMILIES = ("loads", "water", "sensors")


class LooseBolt(AbstractEffect):
    """A single number and one by name."""

    play: jax.Array = parameter("m", "play of the bolt", 0.0, 2.0, 0.5)
    stiffness: dict = parameters(lambda bolt, key: Parameter("N/m", f"stiffness of {key}", bolt.least))
    least: float = eqx.field(static=True, default=0.0)


class Wrapped(AbstractEffect):
    """An effect within an effect, with a label of its own form."""

    inner: LooseBolt
    factor: dict = parameters(lambda effect, key: Parameter("-", f"factor of {key[0]}"), "{key[0]}.{name}_{key[1]}")
    label_prefix = "unused"


BOLT = LooseBolt(stiffness={"head": 3, "nut": 4.0})
WRAPPED = Wrapped(BOLT, {("head", "t"): 1.0})


def test_labels_and_values() -> None:
    """By the class's name, the key and the field; float64, strongly typed; those of an inner effect first."""
    own = {"loose_bolt.play": 0.5, "loose_bolt.head.stiffness": 3.0, "loose_bolt.nut.stiffness": 4.0}
    assert {label: float(value) for label, value in BOLT.values.items()} == own
    assert all(value.dtype == jnp.float64 and not value.weak_type for value in BOLT.values.values())
    assert list(WRAPPED.values) == [*own, "head.factor_t"]
    assert list(WRAPPED.keys.values()) == [None, "head", "nut", ("head", "t")]


def test_what_is_known_of_a_parameter() -> None:
    """Of the effect itself, too, and of an inner one; what there is none of is told with the nearest."""
    assert BOLT.about("loose_bolt.play") == Parameter("m", "play of the bolt", 0.0, 2.0, 0.5)
    assert WRAPPED.about("loose_bolt.nut.stiffness") == Parameter("N/m", "stiffness of nut", 0.0)
    assert LooseBolt(stiffness={"nut": 1.0}, least=-1.0).about("loose_bolt.nut.stiffness").lower == -1.0
    assert WRAPPED.about("head.factor_t").meaning == "factor of head"
    with pytest.raises(UnknownName, match=r"no parameter 'loose_bolt.pla'; .* Did you mean 'loose_bolt.play'\?"):
        WRAPPED.about("loose_bolt.pla")


def test_changed_values() -> None:
    """Some of a mapping, of an inner effect, under a derivative; labels of others are ignored, and change nothing."""
    new = WRAPPED.at_values({"loose_bolt.head.stiffness": 7, "head.factor_t": 2.0, "another.x": 1.0})
    assert (float(new.inner.stiffness["head"]), float(new.inner.stiffness["nut"])) == (7.0, 4.0)
    assert float(new.factor["head", "t"]) == 2.0 and float(WRAPPED.factor["head", "t"]) == 1.0
    assert BOLT.at_values({"another.x": 1.0}) is BOLT

    def total(value):
        return sum(WRAPPED.at_values({"loose_bolt.play": value, "loose_bolt.nut.stiffness": 3 * value}).values.values())

    assert float(jax.jit(jax.grad(total))(2.0)) == 4.0
    assert jax.tree.structure(jax.vmap(lambda x: WRAPPED.at_values({"loose_bolt.play": x}))(jnp.ones(3))) == (
        jax.tree.structure(WRAPPED)
    )


def test_a_model_takes_a_member_of_any_family_and_nothing_else() -> None:
    """Each comes to its own; what belongs to none of them is refused."""
    model = jh.load_model("volturnus-s")
    for effect, name in ((Umbilical(), "loads"), (Current(), "water"), (SensorLag(), "sensors")):
        changed = model.with_effect(effect)
        assert [len(getattr(changed, family)) - len(getattr(model, family)) for family in FAMILIES] == [
            family == name for family in FAMILIES
        ]
        assert set(changed.values) == {*model.values, *effect.values}
    with pytest.raises(TypeError, match="expected a load, a water effect or a sensor effect, found LooseBolt"):
        model.with_effect(BOLT)
