"""Progress of a calibration, and its interruption by the user."""

from collections.abc import Callable
from dataclasses import dataclass

from calibration.fitting.fit import Fit
from calibration.result import Calibration
from jaxhydro.interrupts import stopping


@dataclass(frozen=True)
class Progress:
    """Progress of a calibration.

    Attributes:
        stage: Name of the current stage.
        iteration: Number of iterations so far.
        objective: Value of the objective.
        fraction: Estimated fraction done, 0 to 1.
        name: Name of the objective.
    """

    stage: str
    iteration: int
    objective: float
    fraction: float
    name: str = "J"


class Interrupted(KeyboardInterrupt):
    """Interruption of a calibration by the user (Ctrl-C).

    Attributes:
        partial: Result that was reached; None if there is none.
    """

    def __init__(self, partial: Calibration | None):
        super().__init__("stopped; nothing was written")
        self.partial = partial


def finished(fit: Fit, run: Callable[[], None], finish: Callable[[], Calibration]) -> Calibration:
    """Run a fit and return its result.

    Raises:
        Interrupted: If the user stops the fit; it holds what was reached.
    """
    try:
        run()
    except KeyboardInterrupt:
        stopping()
        fit.converged = False
        raise Interrupted(finish() if fit.iterations else None) from None
    return finish()
