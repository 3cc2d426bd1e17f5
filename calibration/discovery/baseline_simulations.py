"""Simulations of all records without candidates, for points at which every candidate is neutral.

Neutral candidates change nothing, but their loads are computed and differentiated. Without them a linearisation takes less than
half the time.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from calibration.discovery.linearisations import Linearisation, Point, SeaSelection
from calibration.discovery.record_simulations import LinearisationJob, RecordSimulations
from calibration.parameters.space import ParameterSpace
from jaxhydro.dynamics.model import Model


@dataclass(frozen=True)
class BaselineSimulations:
    """Simulations with the model without candidates.

    Attributes:
        simulations: The simulations.
        parameters: Which parameters of the study the model has (p,).
        directions: Numbers of the study's directions that move nothing else.
        neutral: Coordinates of all parameters at which candidates are neutral (p,).
    """

    simulations: RecordSimulations
    parameters: np.ndarray
    directions: tuple[int, ...]
    neutral: np.ndarray

    @classmethod
    def of(cls, whole: RecordSimulations, model: Model, space: ParameterSpace) -> "BaselineSimulations":
        """Simulations without candidates.

        Args:
            whole: Simulations with all candidates.
            model: The model without candidates.
            space: All parameters.
        """
        present = model.values
        parameters = np.array([label in present for label in space.labels])
        smaller = ParameterSpace(tuple(free for free, has in zip(space.free, parameters, strict=True) if has))
        directions = np.flatnonzero(~whole.directions[:, ~parameters].any(axis=1))
        decays, width = whole.decays, len(directions)
        if decays is not None:
            decays = replace(decays, problem=replace(decays.problem, model=model, space=smaller), width=width)
        simulations = replace(
            whole,
            decays=decays,
            seas=tuple(replace(sea, model=model, space=smaller) for sea in whole.seas),
            directions=whole.directions[np.ix_(directions, parameters)],
            width=width,
        )
        return cls(simulations, parameters, tuple(directions.tolist()), np.asarray(space.start))

    def serves(self, point: Point, active: Sequence[int] = ()) -> bool:
        """Whether all candidates are neutral at a point, and none of the directions moves one."""
        others = ~self.parameters
        return set(active) <= set(self.directions) and np.array_equal(point.x[others], self.neutral[others])

    def compile_decays(self, x: np.ndarray) -> None:
        """Compile the programs of the decays, if there are any. See `DecaySimulations.compile`."""
        if (decays := self.simulations.decays) is not None:
            decays.compile(x[self.parameters])

    def motions(self, point: Point, seas: SeaSelection) -> list[np.ndarray | None]:
        """See `RecordSimulations.motions`."""
        return self.simulations.motions(self._restricted(point), seas)

    def residual(self, point: Point, seas: SeaSelection) -> np.ndarray:
        """See `RecordSimulations.residual`."""
        return self.simulations.residual(self._restricted(point), seas)

    def linearise(self, jobs: Sequence[LinearisationJob], seas: SeaSelection) -> list[Linearisation]:
        """See `RecordSimulations.linearise`."""
        mine = [(self._restricted(point), [self.directions.index(i) for i in active]) for point, active in jobs]
        linearisations = self.simulations.linearise(mine, seas, None)
        return [
            replace(linearisation, point=point, active=tuple(active))
            for linearisation, (point, active) in zip(linearisations, jobs, strict=True)
        ]

    def _restricted(self, point: Point) -> Point:
        return Point(point.x[self.parameters], point.own)
