"""Coefficients that depend on the sea state by power laws."""

import math
from collections.abc import Mapping
from typing import Any, ClassVar

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.choices import check, unknown
from jaxhydro.loads.base import AbstractLoad, Action
from jaxhydro.loads.instant import Instant
from jaxhydro.parameters import Parameter, parameters
from jaxhydro.waves.sea_state import SeaState

EXPONENT_BASES = {"significant_height": "Hs", "peak_period": "Tp"}
MAX_EXPONENT = 3.0  # of an exponent, either way
LABEL = "{key[0]}.{key[1]}_exponent"


class SeaStateLaw(AbstractLoad):
    """A load whose coefficients are power laws of the sea state.

    c = c0 (Hs/Hs0)^a (Tp/Tp0)^b in place of coefficients c0 of a load, in the sea state that it is in.

    Drag coefficients are commonly laid out against the Keulegan-Carpenter number, itself proportional to Hs in a given
    basin. So they are powers of the sea state's scale (Sarpkaya and Isaacson 1981, Mechanics of Wave Forces on Offshore
    Structures, chapter 3). The exponents are empirical. In still water, and in a sea that is not known, c = c0: that is the
    value in the `reference` sea state. All exponents 0 give the load itself.
    """

    load: AbstractLoad
    reference: SeaState = eqx.field(static=True)
    logs: dict[str, Float[Array, ""]]  # Hs, Tp -> ln(Hs/Hs0), ln(Tp/Tp0)
    exponents: Mapping[tuple[str, str], Float[Array, ""] | float] = parameters(lambda law, key: law.about_exponent(*key), LABEL)
    source: ClassVar[str] = "Sarpkaya and Isaacson 1981, chapter 3 (dependence on KC); the power law is empirical"

    @classmethod
    def of(cls, load: AbstractLoad, exponents: Mapping[tuple[str, str], Any], reference: SeaState) -> "SeaStateLaw":
        """Load with exponents for some of its coefficients.

        Args:
            load: The load.
            exponents: Exponents by a coefficient's label, and Hs or Tp.
            reference: Sea state in which coefficients are as declared.
        """
        return cls(load, reference, {symbol: jnp.zeros(()) for symbol in EXPONENT_BASES.values()}, exponents)

    def rest(self) -> Any:
        return self.load.rest()

    def settled(self, displacement: Float[Array, "6"]) -> Any:
        return self.load.settled(displacement)

    def about_exponent(self, base: str, symbol: str) -> Parameter:
        """Unit, meaning and bounds of the exponent of a coefficient in Hs or Tp."""
        height, period = self.reference
        scale = f"{height:.3g} m" if symbol == "Hs" else f"{period:.3g} s"
        return Parameter("-", f"exponent of {base} in {symbol}/{scale}", -MAX_EXPONENT, MAX_EXPONENT)

    def in_sea(self, state: SeaState) -> "SeaStateLaw":
        logs = [jnp.log(now / then) for now, then in zip(state, self.reference, strict=True)]
        return eqx.tree_at(lambda law: law.logs, self, dict(zip(EXPONENT_BASES.values(), logs, strict=True)))

    def present(self) -> dict[str, Float[Array, ""]]:
        """Coefficients of the load in the present sea state."""
        values = self.load.values
        for (base, symbol), exponent in self.exponents.items():
            values[base] = values[base] * jnp.exp(exponent * self.logs[symbol])
        return values

    def act(self, now: Instant, memory: Any) -> Action:
        return self.load.at_values(self.present()).act(now, memory)


def exponent_label(label: str, over: str) -> str:
    """Label of a coefficient's exponent over "significant_height" or "peak_period"."""
    check(over=(over, EXPONENT_BASES))
    return LABEL.format(key=(label, EXPONENT_BASES[over]))


def exponents_of(loads: tuple[AbstractLoad, ...]) -> set[str]:
    """Labels of the exponents of all laws among loads."""
    return {LABEL.format(key=key) for load in loads if isinstance(load, SeaStateLaw) for key in load.exponents}


def coefficients(loads: tuple[AbstractLoad, ...]) -> dict[str, Float[Array, ""]]:
    """Parameters of loads by label, in the present sea state."""
    return {k: v for load in loads for k, v in (load.present() if isinstance(load, SeaStateLaw) else load.values).items()}


def reference_of(loads: tuple[AbstractLoad, ...]) -> SeaState | None:
    """Reference sea state of the laws among loads, or None."""
    return next((load.reference for load in loads if isinstance(load, SeaStateLaw)), None)


def with_exponents(
    loads: tuple[AbstractLoad, ...], exponents: Mapping[tuple[str, str], Any], reference: SeaState
) -> tuple[AbstractLoad, ...]:
    """Loads with sea-state laws for the coefficients that have exponents.

    A law's own exponents are kept while its reference is the same. Several loads may share a coefficient.

    Args:
        loads: Loads of a model.
        exponents: Exponents by the label of a coefficient, and "significant_height" or "peak_period".
        reference: Sea state in which coefficients are as declared.

    Raises:
        UnknownName: No load has the coefficient of an exponent (a KeyError).
        ValueError: A law has another reference, or the reference is not above 0.
    """
    unused, changed = set(exponents), []
    if not all(math.isfinite(x) and x > 0 for x in reference):
        raise ValueError(f"reference: expected a significant height and a peak period above 0, found {reference}")
    for load in loads:
        keys = [key for key in exponents if key[0] in load.values]
        unused -= set(keys)
        mine = {(label, EXPONENT_BASES[over]): exponents[label, over] for label, over in keys}
        if not mine:
            changed.append(load)
        elif not isinstance(load, SeaStateLaw):
            changed.append(SeaStateLaw.of(load, mine, reference))
        elif load.reference != reference:
            raise ValueError(f"expected the reference {load.reference} of the law that is there, found {reference}")
        else:
            changed.append(SeaStateLaw.of(load.load, {**load.exponents, **mine}, reference))
    if unused:
        lost = next(label for label, over in exponents if (label, over) in unused)
        raise unknown("coefficient", lost, [label for load in loads for label in load.values])
    return tuple(changed)
