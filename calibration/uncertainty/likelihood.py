"""Likelihood of a finished fit, with coloured errors, and Laplace intervals."""

from __future__ import annotations

from dataclasses import dataclass

import jax.numpy as jnp
import numpy as np
import scipy  # its parts are imported when they are used: that takes a second

from calibration.fitting.fit import Fit
from calibration.identifiability.information import WEAK_PRIOR_ROUNDING, pseudo_inverse
from calibration.identifiability.residual_spectra import NoiseColour, Periodogram
from calibration.parameters.space import FreeParameter
from calibration.residuals.abstract_residual import Unknowns
from jaxhydro.errors import InputError, suggest
from jaxhydro.errors import Problem as Wrong

DEFAULT_LEVEL = 0.95
WHITE_NOISE = NoiseColour(1.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True, eq=False)
class Likelihood:
    """Likelihood of a finished fit: sum of squares Q = sum w |r|^2 + the prior's, about its lowest point.

    Rows of matrices are the shared coordinates, then every record's own; n in all.

    Attributes:
        fit: The finished fit.
        slope: (r, c, t, k) derivatives of the residuals at the lowest point (m, rad).
        residual: (r, c, t) residuals at the lowest point (m, rad).
        information: (n, n) J^T W J of the records alone.
        scatter: (n, n) covariance of J^T W e.
        prior: What the prior adds to the diagonals of `information` and of `scatter`, (n,) each.
        covariance: (n, n) sandwich H^-1 S H^-1 with coloured errors (White 1982, theorem 3.2).
        white: (n, n) the same, with every sample counted as independent.
        colour: Colour of the errors, by released and measured motion.
        spectra: Periodogram of the residuals, by record and channel.
    """

    fit: Fit
    slope: np.ndarray
    residual: np.ndarray
    information: np.ndarray
    scatter: np.ndarray
    prior: tuple[np.ndarray, np.ndarray]
    covariance: np.ndarray
    white: np.ndarray
    colour: dict[tuple[str, str], NoiseColour]
    spectra: dict[tuple[int, int], Periodogram]

    @property
    def labels(self) -> tuple[str, ...]:
        return self.fit.decays.problem.space.labels

    @property
    def estimate(self) -> np.ndarray:
        """Coordinates (n,) of all unknowns."""
        return coordinates(self.fit.unknowns)

    @property
    def hessian(self) -> np.ndarray:
        return self.information + np.diag(self.prior[0])

    def index(self, label: str) -> int:
        """Index of a parameter among the free parameters.

        Args:
            label: Label of the parameter.

        Raises:
            InputError: There is no such parameter; the message lists them.
        """
        if label not in self.labels:
            expected = f"a free parameter of this fit ({', '.join(self.labels)})"
            hint = self.fit.decays.problem.model.shared_hint(label) or suggest(label, self.labels)
            raise InputError("uncertainty", [Wrong("parameter", expected, repr(label), hint)])
        return self.labels.index(label)

    def free(self, label: str) -> FreeParameter:
        """Transform and bounds of a free parameter.

        Args:
            label: Label of the parameter.
        """
        return self.fit.decays.problem.space.free[self.index(label)]

    def value(self, label: str, coordinate: float) -> float:
        """Value of a parameter (its own unit) at an unbounded coordinate.

        Args:
            label: Label of the parameter.
            coordinate: The coordinate.
        """
        return float(self.free(label).transform.forward(jnp.asarray(coordinate)))

    def interval(self, label: str, level: float = DEFAULT_LEVEL, white: bool = False) -> tuple[float, float]:
        """Laplace interval of a parameter, in its own unit.

        It is x +- z sd in the unbounded coordinate, mapped to values, and so never outside the bounds.

        Args:
            label: Label of the parameter.
            level: Probability of the interval.
            white: Whether every sample is taken as independent.

        Returns:
            Lower and upper end.
        """
        i, z = self.index(label), float(scipy.stats.norm.ppf(0.5 + 0.5 * level))
        reach = z * self.deviation(white)[i]
        low, high = sorted(self.value(label, self.estimate[i] + sign * reach) for sign in (-1, 1))
        return low, high

    def deviation(self, white: bool = False) -> np.ndarray:
        """Standard deviations of the shared coordinates, (p,).

        Args:
            white: Whether every sample is taken as independent.
        """
        return np.sqrt(np.diag(self.white if white else self.covariance)[: len(self.labels)])

    def excess(self) -> dict[str, float]:
        """Ratio of each standard deviation to that with every sample taken as independent."""
        ratio = self.deviation() / self.deviation(white=True)
        return {label: float(x) for label, x in zip(self.labels, ratio, strict=True)}

    def stretch(self, label: str) -> tuple[float, np.ndarray]:
        """Correction of a parameter's likelihood drop for coloured errors, and the direction of its profile.

        A drop of Q over nu is a chi-square of one degree of freedom.

        nu = d^T S d / d^T H d along d = H^-1 e_i, which is [H^-1 S H^-1]_ii / [H^-1]_ii, with one parameter of interest. The
        parameter's own prior is left out where the manifest states none.

        Args:
            label: Label of the parameter.

        Returns:
            nu (-), and how all unknowns move with a unit step of the parameter, (n,).

        References:
            Kent 1982, Biometrika 69, 19-27, section 3.
        """
        i = self.index(label)
        move = pseudo_inverse(self.hessian, WEAK_PRIOR_ROUNDING)[:, i]
        counted = np.ones(len(move))
        counted[i] = np.isfinite(self.free(label).prior_deviation)
        bread, meat = (
            move @ matrix @ move + counted @ (move**2 * more)
            for matrix, more in zip((self.information, self.scatter), self.prior, strict=True)
        )
        least = 1e-9 * self.prior[0][i] * move[i] ** 2
        ratio = meat / bread if bread > least else np.trace(self.scatter) / np.trace(self.information)
        return float(ratio), move / move[i]

    def scale(self) -> float:
        """Factor n / tr(H^-1 S) by which Q is -2 log likelihood on the average over all directions."""
        meat = self.scatter + np.diag(self.prior[1])
        return float(len(meat) / np.trace(pseudo_inverse(self.hessian, WEAK_PRIOR_ROUNDING) @ meat))


def coordinates(unknowns: Unknowns) -> np.ndarray:
    """All coordinates (n,): shared, then every record's own."""
    return np.concatenate([np.asarray(unknowns.shared), np.asarray(unknowns.own).ravel()])
