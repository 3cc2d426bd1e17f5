"""Covariance and identifiability of a finished fit to decays."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from calibration.formatting import listed
from calibration.identifiability.directions import Identifiability, identifiability_at
from calibration.identifiability.standard_deviations import Spread, correlated_samples
from calibration.result import TestFit
from jaxhydro.environment import DOFS

if TYPE_CHECKING:
    from calibration.fitting.decay_fit import DecayFit


def residual_statistics(fit: DecayFit, tests: Sequence[TestFit]) -> tuple[np.ndarray, np.ndarray]:
    """Variance of the residuals and how many of their samples count as one, by record and channel of a finished fit."""
    data, products = fit.problem.data, fit.products
    assert products is not None, "nothing has been minimised yet"
    samples = np.maximum(np.asarray(data.present).sum(axis=-1), 1)
    inflation = np.ones(samples.shape)
    for i, test in enumerate(tests[: len(fit.records)]):
        for series in test.series:
            inflation[i, data.dofs.index(DOFS.index(series.channel))] = correlated_samples(series.simulated - series.measured)
    own = (products.shape[-1] - 1) / len(data.dofs)
    return products[..., -1, -1] / np.maximum(samples - own, 1), inflation


def identifiability_of(fit: DecayFit, tests: Sequence[TestFit]) -> Identifiability:
    """Identifiability of the parameters of a finished fit to decays.

    Args:
        fit: The finished fit.
        tests: Measured and simulated series of the fit's records, as `series_of` returns them.

    Returns:
        Which parameters, and which combinations of them, the records determine.
    """
    return uncertainty_of(fit, tests)[1]


def uncertainty_of(fit: DecayFit, tests: Sequence[TestFit]) -> tuple[Spread, Identifiability]:
    """`identifiability_of`, and the covariance of all unknowns that it rests on."""
    assert fit.products is not None, "nothing has been minimised yet"
    parts = (fit.products, fit.weight, *residual_statistics(fit, tests))
    released = [str(record.degree_of_freedom) for record in fit.records]
    counts = [(dof, released.count(dof)) for dof in dict.fromkeys(released)]
    source = listed([f"{n} {dof} decay{'' if n == 1 else 's'}" for dof, n in counts])
    x, ridge, width = np.asarray(fit.unknowns.shared), np.asarray(fit.ridge), 1 / np.asarray(fit.prior[1])
    return identifiability_at(fit.problem.space, fit.problem.model, x, parts, ridge, width, source)
