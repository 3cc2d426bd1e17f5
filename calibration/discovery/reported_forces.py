"""Forces that the model lacks, as a diagnosis reports them."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class ForceCoherence:
    """Relation of a latent force to another quantity.

    Attributes:
        coherence: Fraction of the force's mean square that is a linear response to the quantity.
        phase: Phase (rad) by which the force leads.
        correlation: Correlation at the same instant.
    """

    coherence: float
    phase: float
    correlation: float


@dataclass(frozen=True, eq=False)
class LawTerm:
    """A term of a force law in x (m, rad), v (m/s, rad/s) and eta (m).

    Attributes:
        name: The term.
        coefficient: Its coefficient (SI).
        unit: Unit of the coefficient.
        kind: Its number in the library of terms.
    """

    name: str
    coefficient: float
    unit: str
    kind: int


@dataclass(frozen=True, eq=False)
class Law:
    """A law of few terms for a latent force.

    Attributes:
        terms: The terms; empty where no law explains enough of the data that were not fitted.
        share: Fraction of the force's mean square explained in the data named by `checked`.
        fitted: The same in the fitted tests.
        checked: Which data `share` refers to, in words.
        v0: Velocity scale of tanh(v / v0) (m/s, rad/s).
        pace: Circular frequency omega of lagged velocity (rad/s).
    """

    terms: tuple[LawTerm, ...]
    share: float
    fitted: float
    checked: str
    v0: float = 1.0
    pace: float = 1.0


@dataclass(frozen=True, eq=False)
class ForceExcerpt:
    """Part of a latent force, to be plotted.

    Attributes:
        test: Name of the test.
        time: Times of the record (s).
        force: The force (N, N m).
        law: The force by its law (N, N m); empty: no law.
        beside: Quantity that is plotted beside it: `velocity` or `wave`.
        values: Values of that quantity.
    """

    test: str
    time: np.ndarray
    force: np.ndarray
    law: np.ndarray
    beside: str
    values: np.ndarray


@dataclass(frozen=True, eq=False)
class LatentForce:
    """Force that the model lacks in one motion.

    Dictionaries are by kind of test: `decay`, `waves`.

    Attributes:
        motion: The motion.
        unit: N or N m.
        rms: Root mean square.
        shares: Fractions of the mean square in the mean and in frequency bands.
        coherence: Relation to motions and waves.
        growth: Exponents of its growth, by the quantity that it grows with.
        law: A law of few terms.
        words: Description in words.
        shown: Part of it, to be plotted.
        relative: Residual over the motion's standard deviation in the plotted test.
    """

    motion: str
    unit: str
    rms: dict[str, float]
    shares: dict[str, dict[str, float]]
    coherence: dict[str, dict[str, ForceCoherence]]
    growth: dict[str, float]
    law: Law
    words: str
    shown: ForceExcerpt
    relative: float = 0.0
