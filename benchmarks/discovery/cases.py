"""Cases of the discovery benchmark: which effect is missing, how strong, which seed, and which half."""

import hashlib
from collections.abc import Iterator
from typing import NamedTuple

EFFECTS = (
    "umbilical",
    "coulomb_friction",
    "hysteresis",
    "mooring_nonlinearity",
    "radiation_memory",
    "current",
    "amplitude_dependent_drag",
    "sea_state_dependent_drag",
    "wave_drift",
    "wave_drift_damping",
    "hidden_oscillator",
    "nonlinear_hydrostatics",
    "coupled_damping",
    "mass_properties",
    "sensor_reference",
    "sensor_lag",
    "wave_gauge_position",
    "wave_reflection",
)
OUTSIDE = ("stiffness_drift", "end_stop", "cogging")  # laws that the catalogue of effects does not have
PAIRS = (
    "umbilical+sea_state_dependent_drag",
    "current+wave_drift",
    "coulomb_friction+nonlinear_hydrostatics",
    "radiation_memory+sensor_lag",
    "hidden_oscillator+mooring_nonlinearity",
)
MOTION_OF = {  # the motion that an effect acts in; the others act in several, or in none of their own
    "coulomb_friction": "surge",
    "hysteresis": "surge",
    "mooring_nonlinearity": "surge",
    "radiation_memory": "surge",
    "wave_drift_damping": "surge",
    "hidden_oscillator": "pitch",
    "nonlinear_hydrostatics": "heave",
}
NOTHING_MISSING_SEEDS = 40
STRENGTHS = {1: "weak", 2: "middle", 3: "strong"}
HALVES = ("set", "report")  # to set thresholds by, and to report


class Case(NamedTuple):
    """A campaign of the benchmark.

    Attributes:
        effect: The missing effect, two as "one+other", or "" where nothing is missing.
        strength: 1 weak, 2 middle, 3 strong.
        seed: Seed of coefficients, waves, releases and noise.
    """

    effect: str
    strength: int
    seed: int

    @property
    def effects(self) -> list[str]:
        """The missing effects."""
        return self.effect.split("+") if self.effect else []

    @property
    def name(self) -> str:
        """Name that says what is missing."""
        return f"{self.effect}-{self.strength}-{self.seed}" if self.effect else f"nothing-{self.seed}"

    @property
    def public_name(self) -> str:
        """Name of the campaign's folder: a number that is stable and does not give the effect away."""
        return f"campaign-{int(hashlib.sha256(self.name.encode()).hexdigest(), 16) % 1_000_000:06d}"

    @property
    def half(self) -> str:
        """Half of the cases that this one is in: `set` or `report`.

        Kinds and seeds alternate, so that the halves differ by at most one case in every kind and strength.
        """
        kinds = next((group for group in (EFFECTS, OUTSIDE, PAIRS) if self.effect in group), ("",))
        return HALVES[(kinds.index(self.effect) + self.strength + self.seed) % 2]

    @classmethod
    def of(cls, name: str) -> "Case":
        """The case of a name. See `name`."""
        parts = name.split("-")
        return cls("", 2, int(parts[1])) if parts[0] == "nothing" else cls(parts[0], int(parts[1]), int(parts[2]))


def cases() -> Iterator[Case]:
    """All cases, in an order of which any first few are a fair sample.

    The middle strength comes first, with pairs of effects and laws from outside the catalogue. Cases with nothing missing are
    spread between the others. Laws from outside at other strengths, for which there is no goal, come last.
    """
    nothing_missing = iter([Case("", 2, seed) for seed in range(1, NOTHING_MISSING_SEEDS + 1)])
    remaining = ((3, 1), (1, 1), (3, 2), (1, 2), (3, 3), (1, 3))
    for strength, seed in ((2, 1), (2, 2), (2, 3), *remaining):
        for i, effect in enumerate((*EFFECTS, *(OUTSIDE + PAIRS if strength == 2 else ()))):
            if i % 5 == 0 and (case := next(nothing_missing, None)) is not None:
                yield case
            yield Case(effect, strength, seed)
    for strength, seed in remaining:
        yield from (Case(effect, strength, seed) for effect in OUTSIDE)
