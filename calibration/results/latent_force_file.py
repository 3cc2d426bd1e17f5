"""The part of diagnosis.json on what no effect explains: latent forces and their laws."""

from pydantic import Field

from jaxhydro.input_schema import Number
from jaxhydro.result_model import ResultModel


class ForceRelation(ResultModel):
    """Relation of a latent force to a motion or the wave.

    Attributes:
        coherence: Coherence.
        phase: Phase by which the force leads (rad).
        correlation: Correlation.
    """

    coherence: Number | None = None
    phase: Number | None = None
    correlation: Number | None = None


class ForceTerm(ResultModel):
    """A term of a force law: its expression in x, v and eta, and its coefficient (SI)."""

    term: str
    coefficient: Number | None = None
    unit: str = ""


class ForceLaw(ResultModel):
    """A law of few terms for a latent force.

    Attributes:
        terms: The terms; empty where no law explains enough.
        share: Fraction of the force's mean square that it explains in the data named by `share_of`.
        share_of: Data that `share` refers to.
        share_fitted: The same fraction in the fitted tests.
        v0: Velocity scale of tanh(v / v0) (m/s, rad/s).
        omega: Circular frequency of the lagged velocity (rad/s).
    """

    terms: list[ForceTerm] = Field(default_factory=list)
    share: Number | None = None
    share_of: str = ""
    share_fitted: Number | None = None
    v0: Number | None = None
    omega: Number | None = None


class SavedLatentForce(ResultModel):
    """Force in one motion that would make the model follow the records; SI.

    Dictionaries are by kind of test.

    Attributes:
        degree_of_freedom: The motion.
        unit: N or N m.
        rms: Root mean square.
        bands: Fractions of the mean square in the mean and in frequency bands.
        follows: Relations to motions and waves.
        grows_as_power_of: Exponents of its growth, by what it grows with.
        law: A law of few terms.
        words: Description.
    """

    degree_of_freedom: str
    unit: str = ""
    rms: dict[str, Number | None] = Field(default_factory=dict)
    bands: dict[str, dict[str, Number | None]] = Field(default_factory=dict)
    follows: dict[str, dict[str, ForceRelation]] = Field(default_factory=dict)
    grows_as_power_of: dict[str, Number | None] = Field(default_factory=dict)
    law: ForceLaw | None = None
    words: str


class Unexplained(ResultModel):
    """Error that the model with the effects found leaves.

    Attributes:
        share: Its fraction of the squared error.
        signature: Description.
        forces: Forces that would explain it.
    """

    share: Number
    signature: str
    forces: list[SavedLatentForce] = Field(default_factory=list)
